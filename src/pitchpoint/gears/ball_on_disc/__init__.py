"""A ball or barrel on the flat face of a disc, the usual rig for films and friction."""

MEMBERS = ("disc", "ball", "ball")
"""Body of each coordinate; the ball also approaches."""
