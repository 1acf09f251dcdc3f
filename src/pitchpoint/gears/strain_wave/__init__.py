"""Strain wave gears: a flexspline that a wave generator presses into a circular spline."""

MEMBERS = ("wave generator", "flexspline", "circular spline")
