"""The gear families and test rigs of the library, one line each."""

from collections.abc import Iterable, Mapping
from functools import reduce
from importlib import import_module, resources
from operator import or_
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, Tag

from pitchpoint.errors import InputError
from pitchpoint.gears.ball_on_disc.table import BallOnDiscRig
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.gears.planetary import PlanetaryGears
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.input.tables import Table, table_by_key, tag

if TYPE_CHECKING:
    from pitchpoint.gears.family import Family, Made

__all__ = [
    "TABLES",
    "Gears",
    "GearsOfStage",
    "build_together",
    "built_gears",
    "family_of",
    "sample_of",
]

TABLES: tuple[type[GearsTable], ...] = (
    CylindricalGears,
    StrainWaveGears,
    RackAndPinionGears,
    TorusGears,
    BallOnDiscRig,
)
"""Tables of all families, the usual one first. `family.py` and `sample.toml` stand beside each."""


def _by_family(*tables: type[Table]) -> Any:
    """Annotation of a table [gears] that is one of these, by its family."""
    tagged = (Annotated[table, Tag(tag(table))] for table in tables)
    return Annotated[reduce(or_, tagged), Field(discriminator=table_by_key("family", *tables))]


if TYPE_CHECKING:
    Gears = GearsTable
    GearsOfStage = GearsTable | PlanetaryGears
else:
    Gears = _by_family(*TABLES)
    GearsOfStage = _by_family(*TABLES, PlanetaryGears)


def family_of(table: type[GearsTable]) -> "Family":
    """The family whose table this is; only now are its gears imported."""
    family: Family = import_module(f"{_folder(table)}.family").FAMILY
    return family


def sample_of(table: type[GearsTable]) -> Path:
    """A case file of the family with every table that analyses ask for."""
    return Path(str(resources.files(_folder(table)))) / "sample.toml"


def _folder(table: type[GearsTable]) -> str:
    return table.__module__.rpartition(".")[0]


MOST_KEPT = 1024
"""Meshes that are kept: those of the designs that are computed together, and of stages."""

MANY = 16
"""Different gears from which on programs for many pay: they are others than that for one."""

_KEPT: "dict[tuple[GearsTable, int], Made | InputError]" = {}


def built_gears(gears: GearsTable, slices: int) -> "Made":
    """Mesh and its warnings; a sweep that leaves the gears alone builds them once.

    Raises:
        InputError: gears that cannot run, with the key inside their table.
    """
    key = gears, slices
    outcome = _KEPT.get(key)
    if outcome is None:
        outcome = family_of(type(gears)).build(gears, slices)
        _keep({key: outcome})
    if isinstance(outcome, InputError):
        raise outcome
    return outcome


def build_together(asked: "Iterable[tuple[GearsTable, int]]") -> None:
    """Build gears at once that `built_gears` is asked for next, as far as their family does so.

    Args:
        asked: tables with slices.
    """
    groups: dict[Any, list[GearsTable]] = {}
    for key in dict.fromkeys(asked):
        if key not in _KEPT:
            groups.setdefault((type(key[0]), *key[1:]), []).append(key[0])
    for (table, slices), gears in groups.items():
        together = family_of(table).together
        if together is not None and len(gears) > MANY:
            keys = ((gears_table, slices) for gears_table in gears)
            _keep(dict(zip(keys, together(gears, slices), strict=True)))


def _keep(made: "Mapping[tuple[GearsTable, int], Made | InputError]") -> None:
    _KEPT.update(made)
    for key in [*_KEPT][: max(len(_KEPT) - MOST_KEPT, 0)]:
        _KEPT.pop(key, None)
