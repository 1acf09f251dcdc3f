"""The table [formulas] of the case: two points of the meshing zone, whose films its figures show."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import Table

__all__ = ["ZoneFilms"]

FORCE = Quantity("force", 0.0, 1e6, "N", open_low=True)
RADIUS = Quantity("length", 1e-4, 100.0, "m")
SPEED = Quantity("velocity", 0.0, 100.0, "m/s", open_low=True)
TURNS = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
FACTOR = Quantity("dimensionless", 0.0, 10.0, open_low=True)
NODES = Quantity("dimensionless", 33, 257, whole=True)

_MOST = 100


class ZoneFilms(Table):
    """Contacts of one tooth at points A, at its root, and B, at its tip, eqs. 7 to 16."""

    form: Literal["films"] = "films"
    """Equations that take these inputs: the films of the meshing zone by Xu et al."""
    load: Annotated[float, FORCE]
    """Load of the tooth at both points."""
    radius: tuple[Annotated[float, RADIUS], Annotated[float, RADIUS]]
    """Relative radius of curvature R at the points A and B."""
    entrainment: tuple[Annotated[float, SPEED], Annotated[float, SPEED]]
    """Mean surface speed at A and B at the speed of the operating point."""
    speeds: Annotated[tuple[Annotated[float, TURNS], ...], Field(min_length=2, max_length=_MOST)]
    """Speeds of the wave generator at which films are solved, rising."""
    eta_beta_sigma: Annotated[float, FACTOR]
    """Summits per area times their radius times Rq."""
    sigma_over_beta: Annotated[float, FACTOR]
    """Rq over the radius of summits."""
    nodes: Annotated[float, NODES]
    """Nodes of the grid along the motion: 33, 65, 129 or 257; across the face one cell less."""

    @model_validator(mode="after")
    def _rising(self) -> "ZoneFilms":
        if any(later <= one for one, later in pairwise(self.speeds)):
            raise InputError("the speeds have to rise", key="speeds")
        return self

    @model_validator(mode="after")
    def _of_a_grid(self) -> "ZoneFilms":
        even = int(self.nodes) - 1
        if even & (even - 1):
            raise InputError(
                "their number is a power of two and one more: 33, 65, 129 or 257", key="nodes"
            )
        return self
