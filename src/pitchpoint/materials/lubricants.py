"""Lubricating oils and greases: density, viscosity and pressure-viscosity coefficient against temperature."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from typing import Any

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.data import Datum, check_positive, read_data, read_datum
from pitchpoint.materials.pressure_viscosity import gold_2001
from pitchpoint.materials.viscosity import astm_d341, dynamic_viscosity
from pitchpoint.registry import known_as, unknown_name

__all__ = [
    "FreeVolume",
    "GreaseRecord",
    "Lubricant",
    "LubricantRecord",
    "base_oils",
    "catalogue",
    "constant_alpha",
    "demand_plausible_cold",
    "find",
    "known_cold",
    "of_base",
    "without_free_volume",
]

ZERO_CELSIUS = 273.15
DENSITY_TEMPERATURE = ZERO_CELSIUS + 15.0
"""Temperature at which the density of an oil is stated [K]."""
COLD = ZERO_CELSIUS - 40.0
"""Temperature at which the viscosity of an oil for the cold is stated [K]."""
ROOM = ZERO_CELSIUS + 25.0
"""Temperature of a room [K]."""
ASTRAY = 5.0
"""Factor by which the viscosity at -40 degC may be off the line through those at 40 and 100 degC.

Thin polyalphaolefins lie at half of it, oils thickened with polymers at twice it (both recalled), and 5 % in
the viscosity at 100 degC move the line there by 1.5.
"""


class FreeVolume(eqx.Module):
    """What the viscosity of an oil under pressure follows from: volume that is occupied, and volume.

    Args:
        free_volume_factor: Doolittle's B, shape (...) [1].
        occupied_volume: R0, part of the volume at ambient pressure and `volume_temperature`, shape (...) [1].
        occupied_expansion: of the occupied volume with temperature, below zero, shape (...) [1/K].
        volume_temperature: to which the constants belong, shape (...) [K].
        modulus_rise: of the bulk modulus with pressure, K' of Tait's equation, shape (...) [1].
        modulus_cold: bulk modulus at ambient pressure, extrapolated to absolute zero, shape (...) [Pa].
        modulus_slope: relative fall of the bulk modulus per kelvin, shape (...) [1/K].
        expansion: of the volume with temperature, shape (...) [1/K].

    Source: Bair (2019).
    """

    free_volume_factor: Float[Array, "..."] = eqx.field(converter=float64_array)
    occupied_volume: Float[Array, "..."] = eqx.field(converter=float64_array)
    occupied_expansion: Float[Array, "..."] = eqx.field(converter=float64_array)
    volume_temperature: Float[Array, "..."] = eqx.field(converter=float64_array)
    modulus_rise: Float[Array, "..."] = eqx.field(converter=float64_array)
    modulus_cold: Float[Array, "..."] = eqx.field(converter=float64_array)
    modulus_slope: Float[Array, "..."] = eqx.field(converter=float64_array)
    expansion: Float[Array, "..."] = eqx.field(converter=float64_array)

    def parameters(self, T: ArrayLike) -> dict[str, Float[Array, "..."]]:
        """Those of `doolittle_1951` and `tait_1888` for an oil whose inlet is at T [K], shapes (...) [SI]."""
        rise = jnp.asarray(T) - self.volume_temperature
        grown = 1.0 + self.expansion * rise
        return {
            "occupied_volume": self.occupied_volume
            * (1.0 + self.occupied_expansion * rise)
            / grown,
            "bulk_modulus": self.modulus_cold * jnp.exp(-self.modulus_slope * jnp.asarray(T)),
            "modulus_rise": self.modulus_rise,
            "modulus_slope": self.modulus_slope,
            "expansion": self.expansion / grown,
        }

    def pressure_viscosity(self, T: ArrayLike) -> Float[Array, "..."]:
        """Slope of ln eta over the pressure at ambient pressure and T [K], shape (...) [1/Pa]."""
        at = self.parameters(T)
        occupied = at["occupied_volume"]
        return self.free_volume_factor * occupied / (1.0 - occupied) ** 2 / at["bulk_modulus"]


class Lubricant(eqx.Module):
    """An oil, ready for a computation: array leaves only, so another oil does not recompile.

    For a grease it is the base oil.

    Args:
        nu_1: kinematic viscosity at T_1, shape (...) [m2/s].
        nu_2: kinematic viscosity at T_2, shape (...) [m2/s].
        T_1: lower of the two temperatures, shape (...) [K].
        T_2: higher of the two temperatures, shape (...) [K].
        density_15: density at 15 degC, shape (...) [kg/m3].
        density_slope: fall of the density per kelvin, shape (...) [kg/m3/K].
        gold_s: constant of the pressure-viscosity law, shape (...) [1/GPa at 1 mm2/s].
        gold_t: exponent of the pressure-viscosity law, shape (...) [1].
        lubricant_factor: lubricant factor X_L of mean friction laws, shape (...) [1].
        conductivity: of heat, shape (...) [W/m/K].
        T_min: lowest temperature the values are meant for, shape (...) [K].
        T_max: highest temperature the values are meant for, shape (...) [K].
        nu_0: kinematic viscosity at -40 degC, shape (...) [m2/s]; None for an oil of which it is not known.
        free_volume: takes the place of Gold's law; None for an oil of which it is not known.

    Source: ASTM D341 for the viscosity, Gold et al. (2001) for the coefficient, see its methods.
    """

    nu_1: Float[Array, "..."]
    nu_2: Float[Array, "..."]
    T_1: Float[Array, "..."]
    T_2: Float[Array, "..."]
    density_15: Float[Array, "..."]
    density_slope: Float[Array, "..."]
    gold_s: Float[Array, "..."]
    gold_t: Float[Array, "..."]
    lubricant_factor: Float[Array, "..."]
    conductivity: Float[Array, "..."]
    T_min: Float[Array, "..."]
    T_max: Float[Array, "..."]
    nu_0: Float[Array, "..."] | None
    free_volume: FreeVolume | None

    def __init__(
        self,
        *,
        nu_1: ArrayLike,
        nu_2: ArrayLike,
        T_1: ArrayLike,
        T_2: ArrayLike,
        density_15: ArrayLike,
        density_slope: ArrayLike,
        gold_s: ArrayLike,
        gold_t: ArrayLike,
        lubricant_factor: ArrayLike,
        conductivity: ArrayLike,
        T_min: ArrayLike,
        T_max: ArrayLike,
        nu_0: ArrayLike | None = None,
        free_volume: FreeVolume | None = None,
    ) -> None:
        self.nu_1, self.nu_2 = float64_array(nu_1), float64_array(nu_2)
        self.T_1, self.T_2 = float64_array(T_1), float64_array(T_2)
        self.density_15, self.density_slope = (
            float64_array(density_15),
            float64_array(density_slope),
        )
        self.gold_s, self.gold_t = float64_array(gold_s), float64_array(gold_t)
        self.lubricant_factor = float64_array(lubricant_factor)
        self.conductivity = float64_array(conductivity)
        self.T_min, self.T_max = float64_array(T_min), float64_array(T_max)
        self.nu_0 = None if nu_0 is None else float64_array(nu_0)
        self.free_volume = free_volume

    def kinematic_viscosity(self, T: ArrayLike) -> Float[Array, "..."]:
        """Kinematic viscosity at T [K] by ASTM D341, shape (...) [m2/s].

        The line goes through nu_1 and nu_2; below T_1 through nu_1 and nu_0, where that is known.
        """
        usual = astm_d341(T=T, nu_1=self.nu_1, T_1=self.T_1, nu_2=self.nu_2, T_2=self.T_2)
        if self.nu_0 is None:
            return usual
        cold = astm_d341(T=T, nu_1=self.nu_0, T_1=COLD, nu_2=self.nu_1, T_2=self.T_1)
        return jnp.where(jnp.asarray(T) < self.T_1, cold, usual)

    def density(self, T: ArrayLike) -> Float[Array, "..."]:
        """Density at T [K], linear from the value at 15 degC, shape (...) [kg/m3]."""
        return self.density_15 - self.density_slope * (jnp.asarray(T) - DENSITY_TEMPERATURE)

    def viscosity(self, T: ArrayLike) -> Float[Array, "..."]:
        """Dynamic viscosity at T [K] and ambient pressure, shape (...) [Pa s]."""
        return dynamic_viscosity(nu=self.kinematic_viscosity(T), rho=self.density(T))

    def viscosity_slope(self, T: ArrayLike) -> Float[Array, "..."]:
        """Relative fall of the dynamic viscosity per kelvin at T [K], -d ln eta/dT, shape (...) [1/K].

        From the law of viscosity and density against temperature, by differentiation. At the temperature
        where the line for the cold meets the other one it is that of the warm side.
        """
        at = float64_array(T)
        eta, fall = jax.jvp(self.viscosity, (at,), (-jnp.ones_like(at),))
        relative: Float[Array, "..."] = fall / eta
        return relative

    def pressure_viscosity(self, T: ArrayLike) -> Float[Array, "..."]:
        """Pressure-viscosity coefficient at T [K], shape (...) [1/Pa].

        Source: Gold et al. (2001), where the free volume is not known.
        """
        if self.free_volume is not None:
            return self.free_volume.pressure_viscosity(T)
        return gold_2001(nu=self.kinematic_viscosity(T), s=self.gold_s, t=self.gold_t)

    def in_range(self, T: ArrayLike) -> Bool[Array, "..."]:
        """Whether T [K] is a temperature the values are meant for, shape (...)."""
        temperature = jnp.asarray(T)
        return (temperature >= self.T_min) & (temperature <= self.T_max)


def constant_alpha(alpha: float) -> tuple[float, float]:
    """Return the s and t with which Gold's law gives one coefficient at every temperature.

    Args:
        alpha: pressure-viscosity coefficient [1/Pa].

    Returns:
        s [1/GPa at 1 mm2/s] and t = 0.

    Source: Gold et al. (2001), see `gold_2001`.
    """
    return alpha * 1e9, 0.0


_T_40 = Datum(value=ZERO_CELSIUS + 40.0)
_T_100 = Datum(value=ZERO_CELSIUS + 100.0)
_T_LOWEST = Datum(value=ZERO_CELSIUS, status="assumed")
_T_HIGHEST = Datum(value=ZERO_CELSIUS + 120.0, status="assumed")
_CONDUCTIVITY = Datum(
    value=0.14, status="assumed", note="of the 0.12 to 0.17 of oils, recalled and unconfirmed"
)


@dataclass(frozen=True, kw_only=True)
class LubricantRecord:
    """An oil with its name and the origin of each value; `build()` gives the bare numbers.

    Args:
        name: name in the catalogue, or one of the user's.
        title: what it is, in words.
        base: class of base oil: "mineral", "pao", "ester", "pag", or another word.
        nu_1: kinematic viscosity at T_1 [m2/s].
        nu_2: kinematic viscosity at T_2 [m2/s], below nu_1.
        T_1: lower temperature [K], 40 degC unless given.
        T_2: higher temperature [K], 100 degC unless given.
        density_15: density at 15 degC [kg/m3].
        density_slope: fall of the density per kelvin [kg/m3/K].
        gold_s: constant of the pressure-viscosity law [1/GPa at 1 mm2/s].
        gold_t: exponent of the pressure-viscosity law [1]; `constant_alpha` gives both.
        lubricant_factor: lubricant factor X_L of mean friction laws [1].
        conductivity: of heat [W/m/K], a round value unless given.
        T_min: lowest temperature the values are meant for [K], 0 degC unless given.
        T_max: highest temperature the values are meant for [K], 120 degC unless given. The two
            defaults are a choice: D341 goes through two points 60 K apart and is taken 40 K
            below and 20 K above them.
        nu_0: kinematic viscosity at -40 degC [m2/s], above nu_1, where it is known; extrapolated from nu_1
            and nu_2 alone it comes out twice too high for thin polyalphaolefins.
        free_volume: values of a `FreeVolume` by name, where they are known; none otherwise.

    Raises:
        InputError: a value is out of its physical range.

    Example:
        >>> from pitchpoint.materials import lubricants
        >>> oil = lubricants.find("pao-vg-220").build()
        >>> round(float(oil.kinematic_viscosity(353.15)) * 1e6, 1)
        45.1
    """

    name: str
    title: str = ""
    base: str = ""
    nu_1: Datum
    nu_2: Datum
    density_15: Datum
    density_slope: Datum
    gold_s: Datum
    gold_t: Datum
    lubricant_factor: Datum
    T_1: Datum = _T_40
    T_2: Datum = _T_100
    T_min: Datum = _T_LOWEST
    T_max: Datum = _T_HIGHEST
    conductivity: Datum = _CONDUCTIVITY
    nu_0: Datum | None = None
    free_volume: Mapping[str, Datum] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        free = {"density_slope", "gold_t", "occupied_expansion"}  # these may be zero or negative
        check_positive(self.name, [item for item in self.data().items() if item[0] not in free])
        _check_order(self)

    @property
    def note(self) -> str:
        """What is assumed of it, in a sentence; empty for an oil."""
        return ""

    @property
    def bend(self) -> str:
        """What the viscosity at -40 degC changes at room temperature; empty where it is not known."""
        if self.nu_0 is None:
            return ""
        with_it, without = (_viscosity(oil, ROOM) for oil in (self, replace(self, nu_0=None)))
        return (
            "below 40 degC the viscosity follows the line to this one: at 25 degC it is "
            f"{with_it * 1e6:.4g} mm2/s, {100.0 * (with_it / without - 1.0):+.1f} % against the line through "
            "those at 40 and 100 degC"
        )

    def data(self) -> dict[str, Datum]:
        """Return the values by name, each with its status and source."""
        # The volume takes the place of Gold's law.
        gold = {"gold_s", "gold_t"} if self.free_volume else set()
        plain = {key: datum for key, datum in self._plain().items() if key not in gold}
        return {**plain, **self.free_volume}

    def _plain(self) -> dict[str, Datum]:
        every = {field.name: getattr(self, field.name) for field in fields(self)}
        return {key: value for key, value in every.items() if isinstance(value, Datum)}

    def build(self) -> Lubricant:
        """Return the numbers alone, for a computation."""
        values = {key: datum.value for key, datum in self._plain().items()}
        volume = {key: float64_array(datum.value) for key, datum in self.free_volume.items()}
        return Lubricant(**values, free_volume=FreeVolume(**volume) if volume else None)

    def with_values(self, **values: float) -> LubricantRecord:
        """Return a copy with some values [SI] replaced by the user's own.

        Raises:
            InputError: there is no value of that name.
        """
        for key in values.keys() - {*self._plain(), "nu_0"}:
            raise InputError(f'"{key}" is not a property of an oil', allowed=self._plain())
        data: dict[str, Any] = {key: Datum(value=value) for key, value in values.items()}
        return replace(self, **without_free_volume(data), **data)

    def thickened(self, *, thickener: str = "", consistency: str = "") -> GreaseRecord:
        """Return the grease that has this oil as its base oil.

        Args:
            thickener: in words.
            consistency: NLGI number, as the maker writes it.
        """
        return GreaseRecord(
            name=self.name,
            title=self.title,
            base=self.base,
            thickener=thickener,
            consistency=consistency,
            free_volume=self.free_volume,
            **self._plain(),
        )


PENETRATION = {
    "000": (445, 475),
    "00": (400, 430),
    "0": (355, 385),
    "1": (310, 340),
    "2": (265, 295),
    "3": (220, 250),
    "4": (175, 205),
    "5": (130, 160),
    "6": (85, 115),
}
"""Worked penetration by NLGI number, in tenths of a millimetre (ASTM D217)."""


@dataclass(frozen=True, kw_only=True)
class GreaseRecord(LubricantRecord):
    """A grease; its values are those of its base oil.

    Args:
        thickener: in words; changes nothing in a computation.
        consistency: NLGI number, as the maker writes it; changes nothing in a computation.
    """

    thickener: str = ""
    consistency: str = ""

    @property
    def note(self) -> str:
        """What is assumed of a grease."""
        penetration = PENETRATION.get(self.consistency)
        worked = (
            f" (worked penetration {penetration[0]} to {penetration[1]} tenths of a millimetre)"
            if penetration
            else ""
        )
        graded = f" NLGI {self.consistency}{worked} is recorded." if self.consistency else ""
        return (
            f"{self.name} is taken as its base oil: film, friction and bearing loss follow the "
            "viscosity of that oil, contacts are fully supplied, and the thickener does nothing, nor does "
            f"it stiffen the grease in the cold.{graded}"
        )


def _check_order(record: LubricantRecord) -> None:
    thick, thin = (f"{1e6 * nu.value:.6g} mm2/s" for nu in (record.nu_1, record.nu_2))
    checks = {
        "nu_1": (
            record.nu_1.value > record.nu_2.value,
            f"must be above nu_2, since oils thin with heat; {thick} was given with {thin}",
        ),
        "nu_2": (record.nu_2.value >= 2e-6, "must be 2 mm2/s or more, where D341 holds as used"),
        "T_1": (record.T_1.value < record.T_2.value, "must be below T_2"),
        "T_min": (record.T_min.value < record.T_max.value, "must be below T_max"),
        "gold_t": (math.isfinite(record.gold_t.value), "must be a finite number"),
        "density_slope": (_lightest(record) > 0.0, "makes the density negative at T_max"),
        "nu_0": (
            record.nu_0 is None or record.nu_0.value > record.nu_1.value,
            "must be above nu_1, the viscosity at a higher temperature",
        ),
    }
    for key, (passed, message) in checks.items():
        if not passed:
            raise InputError(message, key=f"{record.name}.{key}")


def demand_plausible_cold(record: LubricantRecord) -> None:
    """InputError if the viscosity of an oil at -40 degC does not go with its other two, see `ASTRAY`.

    Source: ASTM D341, the line through both other viscosities.
    """
    if record.nu_0 is None:
        return
    cold, line = record.nu_0.value, _viscosity(replace(record, nu_0=None), COLD)
    if not line / ASTRAY <= cold <= line * ASTRAY:
        raise InputError(
            f"{cold * 1e6:.4g} mm2/s at -40 degC does not go with the other two viscosities, whose line "
            f"leads to {line * 1e6:.3g} mm2/s there: no oil is off it by more than a factor of {ASTRAY:g}",
            key=f"{record.name}.nu_0",
        )


def _viscosity(record: LubricantRecord, temperature: float) -> float:
    return float(_kinematic_viscosity(record.build(), float64_array(temperature)))


@program
def _kinematic_viscosity(oil: Lubricant, temperature: Float[Array, ""]) -> Float[Array, ""]:
    return oil.kinematic_viscosity(temperature)


def _lightest(record: LubricantRecord) -> float:
    fall = record.density_slope.value * (record.T_max.value - DENSITY_TEMPERATURE)
    return record.density_15.value - fall


_SCALES = {"nu_1": ("nu_40_mm2_s", 1e-6), "nu_2": ("nu_100_mm2_s", 1e-6)}
_PLAIN = {
    "density_15": "density_15_kg_m3",
    "density_slope": "density_slope_kg_m3_K",
    "gold_s": "gold_s",
    "gold_t": "gold_t",
    "lubricant_factor": "lubricant_factor",
}


@lru_cache(maxsize=1)
def _records() -> dict[str, LubricantRecord]:
    data = read_data("lubricants.toml")
    return {name: _record(name, entry, data["base"]) for name, entry in data["oil"].items()}


def _record(name: str, entry: dict[str, Any], bases: dict[str, Any]) -> LubricantRecord:
    base = bases[entry["base"]]
    values = {key: read_datum(entry[column], scale=k) for key, (column, k) in _SCALES.items()}
    plain = {key: read_datum(entry.get(col, base[col])) for key, col in _PLAIN.items()}
    if "nu_minus_40_mm2_s" in entry:
        plain |= known_cold(read_datum(entry["nu_minus_40_mm2_s"], scale=1e-6))
    volume = {key: read_datum(value) for key, value in entry.get("free_volume", {}).items()}
    properties = {"base": entry["base"], "free_volume": volume, **values, **plain}
    oil = LubricantRecord(name=name, title=entry["title"], **properties)
    words = {key: str(entry[key]) for key in ("thickener", "consistency") if key in entry}
    return oil.thickened(**words) if words else oil


def known_cold(viscosity: Datum) -> dict[str, Datum]:
    """Values of an oil whose viscosity at -40 degC is known, down to which it then is meant.

    Args:
        viscosity: kinematic one at -40 degC [m2/s].
    """
    lowest = Datum(value=COLD, status="assumed", note="down to where its viscosity is known")
    return {"nu_0": viscosity, "T_min": lowest}


def without_free_volume(given: Mapping[str, Datum]) -> dict[str, Any]:
    """What a pressure-viscosity coefficient by value does away with: the volume it would follow from."""
    return {"free_volume": {}} if "gold_s" in given else {}


def of_base(name: str, base: str, *, nu_1: float, nu_2: float, title: str = "") -> LubricantRecord:
    """Return an oil from its viscosities alone; the rest is usual for its class of base oil.

    Args:
        name: a name of one's own.
        base: class of base oil, one of `base_oils()`.
        nu_1: kinematic viscosity at 40 degC [m2/s].
        nu_2: kinematic viscosity at 100 degC [m2/s].
        title: what it is, in words.

    Raises:
        InputError: an unknown base oil, or an impossible viscosity.

    Example:
        >>> oil = of_base("base oil", "pao", nu_1=60e-6, nu_2=9e-6)
        >>> oil.thickened(thickener="lithium soap", consistency="2").consistency
        '2'
    """
    if base not in base_oils():
        raise unknown_name(base, base_oils(), what="a base oil")
    viscosities = {"nu_1": Datum(value=nu_1), "nu_2": Datum(value=nu_2)}
    data: dict[str, Any] = {**viscosities, **base_oils()[base]}
    return LubricantRecord(name=name, title=title or name, base=base, **data)


def base_oils() -> dict[str, dict[str, Datum]]:
    """Return the values shared by a class of base oil, by class and property [SI]."""
    bases = read_data("lubricants.toml")["base"]
    return {
        name: {key: read_datum(base[column]) for key, column in _PLAIN.items()}
        for name, base in bases.items()
    }


def catalogue() -> dict[str, LubricantRecord]:
    """Return the oils of the catalogue by name."""
    return dict(_records())


def find(name: str) -> LubricantRecord:
    """Return one oil of the catalogue.

    Raises:
        InputError: there is no oil of this name; the message has the nearest ones.
    """
    listed_name = known_as(name, _records())
    if listed_name is None:
        raise unknown_name(name, _records(), what="a lubricant")
    return _records()[listed_name]
