"""What a case asks of a gear family beside what every mesh answers."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from math import ceil
from typing import Any, Literal

import numpy as np

from pitchpoint._jax import array
from pitchpoint.contact.surface import Surfaces, Waves
from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import Deviation
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import MassInertia
from pitchpoint.materials.solids import Solid, SolidRecord

__all__ = ["Family", "Followed", "Made", "Records", "Solids", "Turning", "waves"]


@dataclass(frozen=True)
class Followed:
    """A value that the table leaves open, and how it was come by.

    Attributes:
        value: in SI.
        status: "derived" from the others, "assumed", or "default".
        note: the rule.
        varies: how it changes with the speed ratio of gears of one size, in words; empty if it does not.
    """

    value: Any
    status: Literal["derived", "assumed", "default"]
    note: str
    varies: str = ""


@dataclass(frozen=True)
class Turning:
    """Words of the turns over which deviations make a kinematic error.

    Attributes:
        whole: the turn over which both members are shown together; {} is the member with the most teeth.
        angle: what turns there.
        own: the turn of one member, {}, over which orders are counted.
        alone: that turn where the member was named before.
        note: how the errors of both members add up.
    """

    whole: str = "one turn of {}"
    angle: str = "angle of {}"
    own: str = "turn of {}"
    alone: str = "one turn of it"
    note: str = (
        "Other teeth meet in each turn of a gear, so that the errors of both add up differently in later "
        "turns; those of one gear alone, shown by order, stay as they are."
    )


Solids = Sequence[Solid]
Records = Sequence[SolidRecord]
Made = tuple[Mesh, tuple[str, ...]]
"""A mesh and what is to be said of it."""


@dataclass(frozen=True)
class Family:
    """What a case asks of a family beside what every mesh answers.

    Attributes:
        build: mesh and warnings from the table and the number of slices;
            InputError for gears that cannot run, with the key inside the table.
        following: values that the table leaves open, as the mesh has them, by key inside the table; those
            that follow by a rule to be told as `Followed`.
        deviations: of the teeth around both members, from the table and the mesh.
        turning: words of a turn around which they repeat themselves.
        drawing: dimensions of the arrays of a drawing.
        coordinates: labels along those dimensions.
        bodies: mass and moment of inertia of each member, from the table, the mesh and the densities of both
            materials, and a sentence on how they are made up; None where they stand elsewhere, or nowhere.
        envelope: diameter around the gears and their length, from the table and the mesh [m]; None where they
            follow from the teeth.
        of_materials: what is to be said of a mesh whose members are of these materials.
        together: as `build` for many tables at once, with the error in the place of gears that cannot run;
            None where they are built one by one.
    """

    build: Callable[[Any, int], Made]
    following: Callable[[Any, Any], dict[str, Any]] = lambda gears, mesh: {}
    deviations: Callable[[Any, Any], Surfaces] = lambda gears, mesh: ((), ())
    turning: Turning = Turning()
    drawing: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    coordinates: Mapping[str, Any] = field(default_factory=dict)
    bodies: Callable[[Any, Any, Sequence[float]], tuple[list[MassInertia], str]] | None = None
    envelope: Callable[[Any, Any], tuple[float, float]] | None = None
    of_materials: Callable[[Any, Solids, Records], tuple[str, ...]] = lambda *_: ()
    together: Callable[[Sequence[Any], int], list[Made | InputError]] | None = None


WAVES = 4
"""Waves of a member come in multiples of it, the last ones without height: few programs serve all."""


def waves(given: tuple[Deviation, ...]) -> tuple[Waves, ...]:
    """Waves of one member as arrays [wave], none where none are given."""
    if not given:
        return ()
    rows = np.zeros((len(fields(Waves)), ceil(len(given) / WAVES) * WAVES))
    for row, part in zip(rows, fields(Waves), strict=True):
        row[: len(given)] = [getattr(wave, part.name) for wave in given]
    return (Waves(*map(array, rows)),)
