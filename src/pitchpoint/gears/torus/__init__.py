"""Torus-involute pairs: a convex and a concave gear that touch in points and bear misalignment."""

MEMBERS = ("gear 1", "gear 2")
