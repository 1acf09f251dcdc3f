"""Bodies of each gear family by name, in the order of their coordinates."""

__all__ = ["CYLINDRICAL", "STRAIN_WAVE"]

CYLINDRICAL = ("gear 1", "gear 2")
STRAIN_WAVE = ("wave generator", "flexspline", "circular spline")
