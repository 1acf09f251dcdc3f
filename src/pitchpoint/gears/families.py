"""The gear families and test rigs of the library, one line each."""

from functools import lru_cache, reduce
from importlib import import_module, resources
from operator import or_
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import Field, Tag

from pitchpoint.gears.ball_on_disc.table import BallOnDiscRig
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.gears.table import GearsTable
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.input.tables import by, tag

if TYPE_CHECKING:
    from pitchpoint.gears.family import Family
    from pitchpoint.gears.mesh import Mesh

__all__ = ["TABLES", "Gears", "built_gears", "family_of", "sample_of"]

TABLES: tuple[type[GearsTable], ...] = (
    CylindricalGears,
    StrainWaveGears,
    RackAndPinionGears,
    TorusGears,
    BallOnDiscRig,
)
"""Tables of all families, the usual one first. `family.py` and `sample.toml` stand beside each."""

if TYPE_CHECKING:
    Gears = GearsTable
else:
    _TAGGED = (Annotated[table, Tag(tag(table))] for table in TABLES)
    Gears = Annotated[reduce(or_, _TAGGED), Field(discriminator=by("family", *TABLES))]


def family_of(table: type[GearsTable]) -> "Family":
    """The family whose table this is; only now are its gears imported."""
    found: Family = import_module(f"{_folder(table)}.family").FAMILY
    return found


def sample_of(table: type[GearsTable]) -> Path:
    """A case file of the family with every table that analyses ask for."""
    return Path(str(resources.files(_folder(table)))) / "sample.toml"


def _folder(table: type[GearsTable]) -> str:
    return table.__module__.rpartition(".")[0]


@lru_cache(maxsize=256)
def built_gears(gears: GearsTable, driver: str, slices: int) -> tuple["Mesh", tuple[str, ...]]:
    """Mesh and its warnings; a sweep that leaves the gears alone builds them once.

    Raises:
        InputError: gears that cannot run, with the key inside their table.
    """
    return family_of(type(gears)).build(gears, driver, slices)
