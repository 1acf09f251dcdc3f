"""Tian et al. (2024): its laws of friction stand in `friction`, and any case may name them."""

from pitchpoint.published.publication import Publication

__all__ = ["PUBLICATION"]

PUBLICATION = Publication(name="tian_2024")
