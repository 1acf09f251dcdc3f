"""What a publication brings to the cases that name it as their source."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from pitchpoint.efficiency.quasi_static import Design, Operation
from pitchpoint.input.tables import Table
from pitchpoint.lubrication.friction_coefficient import FrictionLaw
from pitchpoint.results.variable import Variable

__all__ = ["Publication", "Reading"]

Reading = Callable[[Table, Design, Operation], dict[str, float]]
"""What its formulas give for gears, as they are given and as they are built, at one operating point."""


@dataclass(frozen=True)
class Publication:
    """Formulas that only the cases of a publication need.

    Attributes:
        name: key of its bibliography entry, which a case gives as its `source`.
        laws: of friction, as its tables rest on them; any case may name them, no spread counts them.
        readings: each gives values by the name of their variable.
        variables: of the readings.
    """

    name: str
    laws: tuple[FrictionLaw, ...] = ()
    readings: tuple[Reading, ...] = ()
    variables: Mapping[str, Variable] = field(default_factory=dict)

    def read(self, gears: Table, design: Design, operation: Operation) -> dict[str, float]:
        """Values of all readings.

        Args:
            gears: as the case gives them.
            design: as it is built.
            operation: one operating point.
        """
        found = [reading(gears, design, operation) for reading in self.readings]
        return {name: value for one in found for name, value in one.items()}
