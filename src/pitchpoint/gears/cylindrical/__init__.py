"""Involute gears on parallel axes, spur or helical, outside or inside a ring."""

MEMBERS = ("gear 1", "gear 2")
