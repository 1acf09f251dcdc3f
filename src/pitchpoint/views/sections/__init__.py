"""Sections of the report and the screen, each in its file."""
