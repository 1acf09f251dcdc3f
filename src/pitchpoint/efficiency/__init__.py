"""Quasi-static mesh cycle: instantaneous efficiency, input torque, losses, and maps of them."""
