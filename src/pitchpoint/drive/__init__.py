"""Drives: bodies, the meshes that link them, and how they move."""
