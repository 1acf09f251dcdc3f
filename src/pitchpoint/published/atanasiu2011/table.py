"""The table [formulas] of the case: a pair in motion, whose courses its figures show."""

from typing import Annotated, Literal

from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import Table

__all__ = ["PairInMotion"]

TORQUE = Quantity("torque", 0.0, 1e6, "N m", open_low=True)


class PairInMotion(Table):
    """Stiffness, load and transmission error while a pair of teeth is in mesh, eqs. 7 to 22."""

    form: Literal["pair in motion"] = "pair in motion"
    """Equations that take these inputs: those of a pair in motion by Atanasiu et al."""
    input_torques: Annotated[tuple[float, float], Pair(TORQUE)]
    """Torques of gear 1 under which the transmission error is drawn, the one of all other courses first."""
