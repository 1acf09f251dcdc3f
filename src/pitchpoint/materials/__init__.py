"""Materials of gears, their lubricants and their surfaces; catalogues are data files."""

from pitchpoint.materials.lubricants import Lubricant, LubricantRecord
from pitchpoint.materials.solids import Solid, SolidRecord, reduced_modulus
from pitchpoint.materials.surfaces import Roughness

__all__ = [
    "Lubricant",
    "LubricantRecord",
    "Roughness",
    "Solid",
    "SolidRecord",
    "reduced_modulus",
]
