"""The table [formulas] of the case: what eqs. 1 to 16 take beside gears, oil, roughness and operation."""

from itertools import pairwise
from math import pi
from typing import Annotated, Literal

from pydantic import Field, model_validator

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import Table

__all__ = ["ZoneFilms"]

ANGLE = Quantity("angle", 0.0, pi / 4.0, "deg")
DISTANCE = Quantity("dimensionless", -5.0, 10.0)
TURNS = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
TEMPERATURE = Quantity("temperature", 223.15, 473.15, "degC")
FACTOR = Quantity("dimensionless", 0.0, 100.0, open_low=True)
STEP = Quantity("dimensionless", 1e-4, 0.2)
NODES = Quantity("dimensionless", 33, 257, whole=True)

_MOST = 100


class ZoneFilms(Table):
    """Contacts of the meshing zone, and films at its points A, at the root, and B, at the tip of a tooth."""

    form: Literal["films"] = "films"
    """Equations that take these inputs: the films of the meshing zone by Xu et al."""
    solves: Literal["nothing", "points", "zone"] = "nothing"
    """Films that are solved: none, of A and B over speed and temperature, or of every tooth of the zone."""
    load: Literal["printed", "closed"] = "printed"
    """Largest load of a tooth: by eq. 6 as printed, or by the teeth of two zones that eq. 5 loads."""
    map_angle: Annotated[tuple[Annotated[float, ANGLE], ...], Field(min_length=2, max_length=_MOST)]
    """Angles from the long axis at which the mesh point is given, rising."""
    map_distance: Annotated[
        tuple[Annotated[float, DISTANCE], ...], Field(min_length=2, max_length=_MOST)
    ]
    """R1 there less the pitch radius of the flexspline, in modules; straight lines lie between."""
    tangential: Literal["added", "opposed"] = "added"
    """Sense in which carried and elastic tangential velocity go together in eq. 3."""
    angles: tuple[Annotated[float, ANGLE], Annotated[float, ANGLE]]
    """Angles from the long axis of the points A and B."""
    entrainment_factor: tuple[Annotated[float, FACTOR], Annotated[float, FACTOR]]
    """Entrainment over that of eq. 3 at A and B; geometric between them, and as there beyond them."""
    speeds: Annotated[tuple[Annotated[float, TURNS], ...], Field(min_length=2, max_length=_MOST)]
    """Speeds of the wave generator at which films of A and B are solved, rising."""
    temperatures: Annotated[
        tuple[Annotated[float, TEMPERATURE], ...], Field(min_length=2, max_length=_MOST)
    ]
    """Temperatures of the oil at which films of A and B are solved, rising."""
    eta_beta_sigma: Annotated[float, FACTOR]
    """Summits per area times their radius times Rq."""
    sigma_over_beta: Annotated[float, FACTOR]
    """Rq over the radius of summits."""
    load_step: Annotated[float, STEP] = 0.01
    """Part of the load by which it grows in eq. 16."""
    nodes: Annotated[float, NODES]
    """Nodes along the motion at the operating point: 33, 65, 129 or 257; one cell less across."""
    course_nodes: Annotated[float, NODES]
    """Nodes of the films over speed and temperature, in the same way."""

    @model_validator(mode="after")
    def _rising(self) -> "ZoneFilms":
        words = {"map_angle": "angles", "speeds": "speeds", "temperatures": "temperatures"}
        for key, what in words.items():
            if any(later <= earlier for earlier, later in pairwise(getattr(self, key))):
                raise InputError(f"the {what} have to rise", key=key)
        return self

    @model_validator(mode="after")
    def _mapped(self) -> "ZoneFilms":
        if len(self.map_angle) != len(self.map_distance):
            raise InputError(
                f"{len(self.map_distance)} distances were given for {len(self.map_angle)} angles; give one "
                "for each angle",
                key="map_distance",
            )
        return self

    @model_validator(mode="after")
    def _ordered(self) -> "ZoneFilms":
        if self.angles[1] <= self.angles[0]:
            raise InputError("B lies further from the long axis than A", key="angles")
        return self

    @model_validator(mode="after")
    def _of_a_grid(self) -> "ZoneFilms":
        for key in ("nodes", "course_nodes"):
            even = int(getattr(self, key)) - 1
            if even & (even - 1):
                raise InputError(
                    "their number is a power of two and one more: 33, 65, 129 or 257", key=key
                )
        return self
