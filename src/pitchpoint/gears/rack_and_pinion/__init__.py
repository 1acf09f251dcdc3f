"""A pinion that drives a rack, spur or helical: a rotation becomes a travel."""

MEMBERS = ("pinion", "rack")
