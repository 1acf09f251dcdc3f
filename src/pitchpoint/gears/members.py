"""Body of each coordinate by name, for every gear family; one that also approaches stands twice."""

__all__ = ["BALL_ON_DISC", "CYLINDRICAL", "STRAIN_WAVE"]

BALL_ON_DISC = ("disc", "ball", "ball")

CYLINDRICAL = ("gear 1", "gear 2")
STRAIN_WAVE = ("wave generator", "flexspline", "circular spline")
