"""What a quantity of a result is: its names, its unit, and how it is shown."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, overload

from pitchpoint import units
from pitchpoint.results.chosen_units import unit_in_use

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = [
    "End",
    "Variable",
    "angle",
    "deviation",
    "energy",
    "force",
    "length",
    "percent",
    "power",
    "pressure",
    "speed",
    "stiffness",
    "temperature_rise",
    "torque",
    "torsional_stiffness",
]

End = Literal["driver", "loaded"]
"""One of the two members whose motion a drive passes on."""


@dataclass(frozen=True)
class Variable:
    """A quantity of a result: long name, symbol, SI unit, and unit and kind for display.

    Attributes:
        end: whose motion it counts in, None where it has nothing to do with one.
        travel: the quantity where that member travels.
    """

    long_name: str
    symbol: str
    unit: str
    shown: str = ""
    kind: str = "dimensionless"
    end: End | None = None
    travel: "Variable | None" = None

    @property
    def usual(self) -> str:
        """Unit in which tables and figures show it where none is chosen."""
        return self.shown or self.unit

    @property
    def display(self) -> str:
        """Unit in which tables and figures show it, see `chosen_units`."""
        return unit_in_use(self.kind, self.usual)

    @overload
    def displayed(self, value: float) -> float: ...
    @overload
    def displayed(self, value: "NDArray[np.floating[Any]]") -> "NDArray[Any]": ...
    def displayed(self, value: "float | NDArray[np.floating[Any]]") -> "float | NDArray[Any]":
        """A value in the unit in which it is shown [SI in]."""
        return units.convert(value, self.display, self.kind)

    def where(self, travels: Collection[End]) -> "Variable":
        """The quantity in a drive some of whose members travel."""
        return self.travel if self.travel is not None and self.end in travels else self


def percent(long_name: str, symbol: str) -> Variable:
    """A share, shown in percent."""
    return Variable(long_name, symbol, "1", "%")


def torque(long_name: str, symbol: str) -> Variable:
    """A torque [N m]."""
    return Variable(long_name, symbol, "N m", "N m", "torque")


def stiffness(long_name: str, symbol: str) -> Variable:
    """A stiffness along a line [N/m], shown in N/um."""
    return Variable(long_name, symbol, "N/m", "N/um", "stiffness")


def torsional_stiffness(long_name: str, symbol: str) -> Variable:
    """A stiffness against rotation [N m/rad], shown in kN m/rad."""
    return Variable(long_name, symbol, "N m/rad", "kN m/rad", "torsional stiffness")


def temperature_rise(long_name: str, symbol: str) -> Variable:
    """A difference of temperatures [K]."""
    return Variable(long_name, symbol, "K", "K", "temperature difference")


def pressure(long_name: str, symbol: str) -> Variable:
    """A pressure [Pa], shown in MPa."""
    return Variable(long_name, symbol, "Pa", "MPa", "pressure")


def deviation(long_name: str, symbol: str) -> Variable:
    """A small length [m], shown in um."""
    return Variable(long_name, symbol, "m", "um", "length")


def length(long_name: str, symbol: str) -> Variable:
    """A length [m], shown in mm."""
    return Variable(long_name, symbol, "m", "mm", "length")


def energy(long_name: str, symbol: str) -> Variable:
    """An energy or a work [J]."""
    return Variable(long_name, symbol, "J", "J", "energy")


def power(long_name: str, symbol: str) -> Variable:
    """A power [W]."""
    return Variable(long_name, symbol, "W", "W", "power")


def force(long_name: str, symbol: str) -> Variable:
    """A force [N]."""
    return Variable(long_name, symbol, "N", "N", "force")


def angle(long_name: str, symbol: str) -> Variable:
    """An angle [rad], shown in degrees."""
    return Variable(long_name, symbol, "rad", "deg", "angle")


def speed(long_name: str, symbol: str) -> Variable:
    """A speed [m/s]."""
    return Variable(long_name, symbol, "m/s", "m/s", "velocity")
