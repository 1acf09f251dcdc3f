"""The table [formulas] of the case: what the equations of the paper take beside gears, oil and roughness."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import Table

__all__ = ["TorusFormulas"]

STIFFNESS = Quantity("stiffness", 0.0, 1e13, "N/um", open_low=True)
ROLL = Quantity("angle", 0.0, 1.0, "deg", open_low=True)
RATIO = Quantity("dimensionless", 0.0, 1.0)
AMPLITUDE = Quantity("length", 0.0, 1e-3, "um")
ROUGHNESS = Quantity("length", 0.0, 1e-5, "um")
CYCLES = Quantity("dimensionless", 1.0, 20.0)
FACTOR = Quantity("dimensionless", 0.0, 100.0, open_low=True)

_LEAST = 5
"""Places that a polynomial of degree 4 takes."""

Rolls = Annotated[tuple[Annotated[float, ROLL], ...], Field(min_length=_LEAST, max_length=100)]
Springs = Annotated[
    tuple[Annotated[float, STIFFNESS], ...], Field(min_length=_LEAST, max_length=100)
]


class TorusFormulas(Table):
    """Inputs of the motion in six coordinates, eqs. 1 to 20."""

    form: Literal["motion"] = "motion"
    """Equations that take these inputs: the motion of a torus pair by Liu and Xiong."""
    bearing_stiffness: Annotated[float, STIFFNESS]
    """Bearing stiffness K_B of each gear on both ways."""
    bearing_damping: Annotated[float, RATIO]
    """Damping ratio of the bearings of each gear on both ways."""
    mesh_damping: Annotated[float, RATIO]
    """Damping ratio ξ_m of the mesh, eq. 9."""
    error: Annotated[float, AMPLITUDE]
    """Amplitude e_s of the static transmission error."""
    mesh_cycles: Annotated[float, CYCLES]
    """Mesh cycles from rest on, over which the tables take means and extremes."""
    radius_factor: Annotated[float, FACTOR]
    """Factor c of R' = c ρ_1, the effective radius of the torus pair."""
    roughness: Annotated[float, ROUGHNESS]
    """Composite Rq S of eq. 22."""
    radius: Literal["printed", "hertz"] = "printed"
    """Radii of pressure, film and rolling: R' = c ρ_1 as printed, or those of Hertz's contact."""
    stiffness: Literal["table", "library"] = "table"
    """Stiffness on which both pairs run: the values of this table, or the secant of the library."""
    torus_roll: Rolls
    """Roll angles of the pinion at which the stiffness of the torus pair is given."""
    torus_stiffness: Springs
    """Stiffness of a pair of teeth of the torus pair at these roll angles."""
    standard_roll: Rolls
    """Roll angles of the pinion at which the stiffness of the standard pair is given."""
    standard_stiffness: Springs
    """Stiffness of a pair of teeth of the standard pair at these roll angles."""
    standard_scale: Annotated[float, FACTOR]
    """Factor on the stiffness of the standard pair."""
    steady_pinion: Literal["driven", "held"] | None = None
    """Asks for steady motion by the corrected equations, of a pinion driven or held at speed."""

    @model_validator(mode="after")
    def _paired(self) -> "TorusFormulas":
        for name in ("torus", "standard"):
            rolls, springs = getattr(self, f"{name}_roll"), getattr(self, f"{name}_stiffness")
            if len(rolls) != len(springs) or any(
                later <= earlier for earlier, later in pairwise(rolls)
            ):
                raise InputError(
                    f"{len(springs)} stiffnesses were given for {len(rolls)} roll angles; give one for "
                    "each angle, in growing order",
                    key=f"{name}_stiffness",
                )
        return self
