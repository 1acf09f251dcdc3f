"""Friction laws as Tian et al. (2024) read them."""

from pitchpoint.published.publication import Publication
from pitchpoint.published.tian2024 import friction

__all__ = ["PUBLICATION"]

PUBLICATION = Publication(name="tian_2024", laws=friction.LAWS)
