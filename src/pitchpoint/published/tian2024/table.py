"""The table [formulas] of the case: places of one pair of teeth, whose courses its figures show."""

from typing import Annotated, Literal

from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import Table

__all__ = ["PairOnPath"]

PLACES = Quantity("dimensionless", 2, 1000, whole=True)


class PairOnPath(Table):
    """Courses of one pair of teeth along the path of contact, eqs. 1 to 18."""

    form: Literal["pair on path"] = "pair on path"
    """Equations that take these inputs: those of one pair of teeth by Tian et al."""
    places: Annotated[float, PLACES] = 41
    """Places in each part of the path between its ends, single contact and pitch point."""
