"""Strength of cylindrical gear pairs: forces, flank pressure, root stress and safeties by the standards."""
