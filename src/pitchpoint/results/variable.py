"""What a quantity of a result is: its names, its unit, and how it is shown."""

import re
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
    "dimensionless",
    "energy",
    "force",
    "frequency",
    "length",
    "mass",
    "moment_of_inertia",
    "oil_viscosity",
    "percent",
    "power",
    "pressure",
    "rotational_speed",
    "speed",
    "stiffness",
    "temperature",
    "temperature_rise",
    "time",
    "torque",
    "torsional_stiffness",
]

_BASE = "(m|kg|s|K|N|Pa|W|J|rad)[2-4]?"
_SI = re.compile(f"(1|{_BASE}( {_BASE})*)(/{_BASE})?")

End = Literal["driver", "loaded"]
"""One of the two members whose motion a drive passes on."""


@dataclass(frozen=True, kw_only=True)
class Variable:
    """A quantity of a result: long name, symbol, SI unit, and unit and kind for display.

    Attributes:
        end: whose motion it counts in, None where it has nothing to do with one.
        travel: the quantity where that member travels.

    Raises:
        ValueError: the unit is not in SI, is not that of the kind, or is shown in one of another kind: a
            mistake of who registers it, which would be met only where a result is shown.
    """

    long_name: str
    symbol: str
    unit: str
    shown: str = ""
    kind: str = "dimensionless"
    end: End | None = None
    travel: "Variable | None" = None

    def __post_init__(self) -> None:
        if self.kind == "dimensionless":
            fits = bool(_SI.fullmatch(self.unit)) and (self.unit == "1" or not self.shown)
        else:
            fits = self.unit == units.si_unit(self.kind) and self.usual in units.units_of(self.kind)
        if not fits:
            raise ValueError(
                f"{self.long_name}: a quantity of kind {self.kind!r} has no unit {self.unit!r} shown in"
                f" {self.usual!r}"
            )

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


def _of_kind(long_name: str, symbol: str, kind: str, shown: str) -> Variable:
    return Variable(
        long_name=long_name, symbol=symbol, unit=units.si_unit(kind), shown=shown, kind=kind
    )


def dimensionless(long_name: str, symbol: str = "") -> Variable:
    """A number without a unit."""
    return Variable(long_name=long_name, symbol=symbol, unit="1")


def percent(long_name: str, symbol: str) -> Variable:
    """A share, shown in percent."""
    return Variable(long_name=long_name, symbol=symbol, unit="1", shown="%")


def angle(long_name: str, symbol: str, shown: str = "deg") -> Variable:
    """An angle [rad]."""
    return _of_kind(long_name, symbol, "angle", shown)


def deviation(long_name: str, symbol: str, shown: str = "um") -> Variable:
    """A small length [m]."""
    return _of_kind(long_name, symbol, "length", shown)


def energy(long_name: str, symbol: str, shown: str = "J") -> Variable:
    """An energy or a work [J]."""
    return _of_kind(long_name, symbol, "energy", shown)


def force(long_name: str, symbol: str, shown: str = "N") -> Variable:
    """A force [N]."""
    return _of_kind(long_name, symbol, "force", shown)


def frequency(long_name: str, symbol: str, shown: str = "Hz") -> Variable:
    """A frequency [1/s]."""
    return _of_kind(long_name, symbol, "frequency", shown)


def length(long_name: str, symbol: str, shown: str = "mm") -> Variable:
    """A length [m]."""
    return _of_kind(long_name, symbol, "length", shown)


def mass(long_name: str, symbol: str, shown: str = "kg") -> Variable:
    """A mass [kg]."""
    return _of_kind(long_name, symbol, "mass", shown)


def moment_of_inertia(long_name: str, symbol: str, shown: str = "kg cm2") -> Variable:
    """A moment of inertia [kg m2]."""
    return _of_kind(long_name, symbol, "moment of inertia", shown)


def power(long_name: str, symbol: str, shown: str = "W") -> Variable:
    """A power [W]."""
    return _of_kind(long_name, symbol, "power", shown)


def pressure(long_name: str, symbol: str, shown: str = "MPa") -> Variable:
    """A pressure [Pa]."""
    return _of_kind(long_name, symbol, "pressure", shown)


def rotational_speed(long_name: str, symbol: str, shown: str = "rpm") -> Variable:
    """A rotational speed [rad/s]."""
    return _of_kind(long_name, symbol, "rotational speed", shown)


def speed(long_name: str, symbol: str, shown: str = "m/s") -> Variable:
    """A speed [m/s]."""
    return _of_kind(long_name, symbol, "velocity", shown)


def stiffness(long_name: str, symbol: str, shown: str = "N/um") -> Variable:
    """A stiffness along a line [N/m]."""
    return _of_kind(long_name, symbol, "stiffness", shown)


def temperature(long_name: str, symbol: str, shown: str = "degC") -> Variable:
    """A temperature [K]."""
    return _of_kind(long_name, symbol, "temperature", shown)


def temperature_rise(long_name: str, symbol: str, shown: str = "K") -> Variable:
    """A difference of temperatures [K]."""
    return _of_kind(long_name, symbol, "temperature difference", shown)


def time(long_name: str, symbol: str, shown: str = "s") -> Variable:
    """A time [s]."""
    return _of_kind(long_name, symbol, "time", shown)


def torque(long_name: str, symbol: str, shown: str = "N m") -> Variable:
    """A torque [N m]."""
    return _of_kind(long_name, symbol, "torque", shown)


def torsional_stiffness(long_name: str, symbol: str, shown: str = "kN m/rad") -> Variable:
    """A stiffness against rotation [N m/rad]."""
    return _of_kind(long_name, symbol, "torsional stiffness", shown)


def oil_viscosity(long_name: str, symbol: str, shown: str = "mPa s") -> Variable:
    """A dynamic viscosity [Pa s]."""
    return _of_kind(long_name, symbol, "dynamic viscosity", shown)
