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
    """Inputs of the motion in six coordinates, eqs. 1 to 20.

    Attributes:
        form: "motion".
        bearing_stiffness, bearing_damping: K_B and damping ratio of each gear on both ways.
        mesh_damping: damping ratio xi_m of eq. 9.
        error: amplitude e_s of the static transmission error.
        mesh_cycles: from rest on, over which the tables take means and extremes.
        radius_factor: c of R' = c rho_1, the effective radius of the torus pair.
        roughness: composite Rq S of eq. 22.
        torus_roll, torus_stiffness: of a pair of teeth against the roll angle of the pinion.
        standard_roll, standard_stiffness: the same for the standard pair, at fewer places.
        standard_scale: by which the latter is multiplied.
        steady_pinion: asks for the motion in steady state by the corrected equations as well, of a pinion
            that a constant torque drives, or of one whose speed is held.
    """

    form: Literal["motion"] = "motion"
    bearing_stiffness: Annotated[float, STIFFNESS]
    bearing_damping: Annotated[float, RATIO]
    mesh_damping: Annotated[float, RATIO]
    error: Annotated[float, AMPLITUDE]
    mesh_cycles: Annotated[float, CYCLES]
    radius_factor: Annotated[float, FACTOR]
    roughness: Annotated[float, ROUGHNESS]
    torus_roll: Rolls
    torus_stiffness: Springs
    standard_roll: Rolls
    standard_stiffness: Springs
    standard_scale: Annotated[float, FACTOR]
    steady_pinion: Literal["driven", "held"] | None = None

    @model_validator(mode="after")
    def _paired(self) -> "TorusFormulas":
        for name in ("torus", "standard"):
            rolls, springs = getattr(self, f"{name}_roll"), getattr(self, f"{name}_stiffness")
            if len(rolls) != len(springs) or any(later <= one for one, later in pairwise(rolls)):
                raise InputError(
                    f"{len(springs)} stiffnesses were given for {len(rolls)} roll angles; give one for "
                    "each angle, in growing order",
                    key=f"{name}_stiffness",
                )
        return self
