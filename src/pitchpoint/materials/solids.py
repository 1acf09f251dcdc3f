"""Elastic solids: the materials of gear bodies, and the reduced modulus of two of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import equinox as eqx
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.errors import InputError
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.data import Datum, check_positive, read_data, read_datum
from pitchpoint.registry import known_as, unknown_name

__all__ = [
    "ModulusPoint",
    "Solid",
    "SolidRecord",
    "catalogue",
    "celsius",
    "find",
    "heat_failure",
    "reduced_modulus",
]

ZERO_CELSIUS = 273.15


class Solid(eqx.Module):
    """An isotropic linear-elastic solid, ready for a computation.

    Args:
        young: Young's modulus, shape (...) [Pa].
        poisson: Poisson's ratio, shape (...) [1].
        density: density, shape (...) [kg/m3].
        hardness: of the flanks, shape (...) [Pa], force over the area of an indentation, which a Vickers or
            Brinell number counts in kgf/mm2; not a number where it is not known.

    Source: Timoshenko and Goodier (1970), isotropic elasticity.

    Example:
        >>> steel = Solid(young=206e9, poisson=0.3, density=7830.0)
    """

    young: Float[Array, "..."]
    poisson: Float[Array, "..."]
    density: Float[Array, "..."]
    hardness: Float[Array, "..."]

    def __init__(
        self,
        *,
        young: ArrayLike,
        poisson: ArrayLike,
        density: ArrayLike,
        hardness: ArrayLike = np.nan,
    ) -> None:
        self.young = float64_array(young)
        self.poisson = float64_array(poisson)
        self.density = float64_array(density)
        self.hardness = float64_array(hardness)

    @property
    def plane_strain_modulus(self) -> Float[Array, "..."]:
        """Young's modulus over one minus Poisson's ratio squared, shape (...) [Pa].

        Source: Timoshenko and Goodier, Theory of Elasticity (1970), plane strain.
        """
        return self.young / (1.0 - self.poisson**2)


def reduced_modulus(a: Solid, b: Solid) -> Float[Array, "..."]:
    """Return the reduced modulus E' of two solids, 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.

    This is the convention of elastohydrodynamic lubrication; the contact modulus E* of Johnson
    (1985), equation 4.2b with 1/E* as the plain sum, is half of it.

    Args:
        a: first solid.
        b: second solid.

    Returns:
        E', broadcast shape of the two [Pa].

    Example:
        >>> from pitchpoint.materials import solids
        >>> steel = solids.find("steel").build()
        >>> round(float(reduced_modulus(steel, steel)) / 1e9, 1)
        226.4
    """
    return 2.0 / (1.0 / a.plane_strain_modulus + 1.0 / b.plane_strain_modulus)


@dataclass(frozen=True, kw_only=True)
class ModulusPoint:
    """One point of a table of modulus against temperature.

    Args:
        temperature: temperature [K].
        young: Young's modulus at it [Pa], with status and source.
    """

    temperature: float
    young: Datum


_WARMEST_ROOT, _COLDEST_ROOT = 120.0, 20.0  # degC, to which root strengths were fitted


@dataclass(frozen=True)
class RootStrength:
    """Nominal root stress that plastic teeth endure, a - b T^p + (c - d T^q)/N^r with T in degC [MPa].

    Args:
        terms: a, b, p, c, d, q, r.
        origin: status, source and note; its value says nothing.

    Source: VDI 2736 Part 2 (2014), as its public program has it.
    """

    terms: tuple[float, ...]
    origin: Datum

    def at(self, temperature: float) -> tuple[float, float, float]:
        """Its parts at the temperature of the teeth [K]: without cycles, over N^r [Pa], and r.

        Below 20 and above 120 degC as there. VDI 2736 Part 2 (2014), as its source has it.

        Example:
            >>> from pitchpoint.materials import solids
            >>> endless, of_cycles, power = solids.find("POM-H").root_strength.at(323.15)
            >>> round((endless + of_cycles / 1e6**power) / 1e6, 1)
            45.0
        """
        a, b, p, c, d, q, r = self.terms
        warm = min(max(temperature - ZERO_CELSIUS, _COLDEST_ROOT), _WARMEST_ROOT)
        return 1e6 * (a - b * warm**p), 1e6 * (c - d * warm**q), r


@dataclass(frozen=True, kw_only=True)
class SolidRecord:
    """A solid with its name and the origin of each value; `build()` gives the bare numbers.

    Args:
        name: name in the catalogue.
        title: what it is, in words.
        young: Young's modulus, the one that is used where no temperature is given [Pa].
        poisson: Poisson's ratio [1], between -1 and 0.5.
        density: density [kg/m3].
        young_temperature: temperature to which `young` belongs [K], if known.
        young_at: modulus against temperature, two points or more from cold to hot, or none.
        conductivity: thermal conductivity [W/m/K], if known.
        specific_heat: specific heat [J/kg/K], if known.
        melting: temperature at which it melts [K], of plastics.
        service_limit: temperature that it bears for long in air [K], of plastics.
        contact_limit: largest Hertz pressure that it bears, a few times only [Pa], if known.
        hardness: of its flanks, Vickers or Brinell [Pa], if known.
        sigma_hlim: contact stress that flanks of test gears endure [Pa], if known.
        sigma_flim: nominal root stress that test gears endure [Pa], if known.
        tensile_strength: of a bar without notch at room temperature [Pa], of plastics, if known.
        root_strength: nominal root stress that plastic teeth endure over temperature and cycles, if known.
        treatment: heat treatment to which these limits belong, as `strength.treatments` names it.

    Raises:
        InputError: a value is out of its physical range, or the table is not in order.

    Example:
        >>> from pitchpoint.materials import solids
        >>> solids.find("POM-H").modulus_known
        'its modulus is known from -40 degC to 100 degC'
        >>> solids.find("PEEK").modulus_known
        'its modulus is known at 23 degC only'
    """

    name: str
    title: str = ""
    young: Datum
    poisson: Datum
    density: Datum
    young_temperature: Datum | None = None
    young_at: tuple[ModulusPoint, ...] = ()
    conductivity: Datum | None = None
    specific_heat: Datum | None = None
    melting: Datum | None = None
    service_limit: Datum | None = None
    contact_limit: Datum | None = None
    hardness: Datum | None = None
    sigma_hlim: Datum | None = None
    sigma_flim: Datum | None = None
    tensile_strength: Datum | None = None
    root_strength: RootStrength | None = None
    treatment: str = ""

    def __post_init__(self) -> None:
        positive = [item for item in self.data().items() if item[0] != "poisson"]
        check_positive(self.name, positive)
        if not -1.0 < self.poisson.value <= 0.5:
            raise InputError(
                f"{self.poisson.value} is not between -1 and 0.5", key=f"{self.name}.poisson"
            )
        if self.young_at:
            _check_table(self)

    def data(self) -> dict[str, Datum]:
        """Return the values that are known, by name, each with its status and source."""
        every = {
            "young": self.young,
            "poisson": self.poisson,
            "density": self.density,
            "young_temperature": self.young_temperature,
            "conductivity": self.conductivity,
            "specific_heat": self.specific_heat,
            "melting": self.melting,
            "service_limit": self.service_limit,
            "contact_limit": self.contact_limit,
            "hardness": self.hardness,
            "sigma_hlim": self.sigma_hlim,
            "sigma_flim": self.sigma_flim,
            "tensile_strength": self.tensile_strength,
        }
        table = {f"young_at {celsius(p.temperature)}": p.young for p in self.young_at}
        return {key: datum for key, datum in every.items() if datum is not None} | table

    @property
    def young_range(self) -> tuple[float, float] | None:
        """Lowest and highest temperature of the table of moduli [K], None without a table."""
        if not self.young_at:
            return None
        return self.young_at[0].temperature, self.young_at[-1].temperature

    @property
    def modulus_known(self) -> str:
        """At which temperatures the modulus is known, in words."""
        if self.young_range is not None:
            low, high = map(celsius, self.young_range)
            return f"its modulus is known from {low} to {high}"
        if self.young_temperature is None:
            return "its modulus is known at one temperature only, which is not stated"
        return f"its modulus is known at {celsius(self.young_temperature.value)} only"

    def build(self, temperature: ArrayLike | None = None) -> Solid:
        """Return the numbers alone, for a computation.

        Args:
            temperature: of the solid, shape (...) [K]; values, not tracers. The modulus is
                interpolated linearly in the table; without a table, or without a temperature, it
                is the single value, and `modulus_known` says at which temperature that holds.

        Returns:
            Solid with a modulus of shape (...).

        Raises:
            InputError: a temperature is outside the table; nothing is extrapolated.

        Example:
            >>> from pitchpoint.materials import solids
            >>> round(float(solids.find("POM-H").build(333.15).young) / 1e9, 2)
            2.02
        """
        return Solid(
            young=self._young(temperature),
            poisson=self.poisson.value,
            density=self.density.value,
            hardness=np.nan if self.hardness is None else self.hardness.value,
        )

    def _young(self, temperature: ArrayLike | None) -> ArrayLike:
        if temperature is None or not self.young_at:
            return self.young.value
        _check_inside(self, temperature)
        places = [point.temperature for point in self.young_at]
        moduli = [point.young.value for point in self.young_at]
        return jnp.interp(float64_array(temperature), jnp.asarray(places), jnp.asarray(moduli))


def celsius(temperature: float) -> str:
    """Temperature [K] in words, to the tenth of a degree."""
    return f"{round(temperature - ZERO_CELSIUS, 1) + 0.0:g} degC"


def heat_failure(record: SolidRecord, temperature: float) -> str:
    """What the heat does to a material, in words; empty where it bears it or nothing is known.

    Args:
        record: of the material.
        temperature: of its hottest place [K].

    Example:
        >>> from pitchpoint.materials import solids
        >>> heat_failure(solids.find("PA66"), 600.0)
        'PA66 melts at 260 degC'
        >>> heat_failure(solids.find("PA66"), 350.0)
        ''
    """
    melts, bears = record.melting, record.service_limit
    if melts is not None and temperature >= melts.value:
        return f"{record.name} melts at {celsius(melts.value)}"
    if bears is not None and temperature > bears.value:
        return f"{record.name} does not bear more than {celsius(bears.value)} for long"
    return ""


def _check_inside(record: SolidRecord, temperature: ArrayLike) -> None:
    low, high = record.young_at[0].temperature, record.young_at[-1].temperature
    temperatures = np.asarray(temperature, dtype=float)
    outside = temperatures[~((temperatures >= low) & (temperatures <= high))]
    if outside.size:
        fails = heat_failure(record, float(outside[0]))
        raise InputError(
            f"the modulus of {record.name} is known from {celsius(low)} to {celsius(high)} and is "
            f"not extrapolated: a temperature of {celsius(float(outside[0]))} is not allowed"
            f"{'; ' * bool(fails)}{fails}",
            value=float(outside[0]),
        )


def _check_table(record: SolidRecord) -> None:
    points, key = record.young_at, f"{record.name}.young_at"
    if len(points) < 2:
        raise InputError("a table of moduli needs two temperatures or more", key=key)
    if not all(a.temperature < b.temperature for a, b in pairwise(points)):
        raise InputError("the temperatures must rise from one to the next", key=key)
    young = record.young_temperature
    if young is not None and not _on_table(record, young.value):
        raise InputError(
            f"the table must give the single modulus at {celsius(young.value)}", key=key
        )


def _on_table(record: SolidRecord, temperature: float) -> bool:
    places = [point.temperature for point in record.young_at]
    moduli = [point.young.value for point in record.young_at]
    young = np.interp(temperature, places, moduli, left=np.nan, right=np.nan)
    return bool(np.isclose(young, record.young.value, rtol=1e-9))


@lru_cache(maxsize=1)
def _records() -> dict[str, SolidRecord]:
    return {name: _record(name, entry) for name, entry in read_data("solids.toml").items()}


def _record(name: str, entry: dict[str, Any]) -> SolidRecord:
    return SolidRecord(
        name=name,
        title=entry["title"],
        young=read_datum(entry["young_GPa"], scale=1e9),
        poisson=read_datum(entry["poisson"]),
        density=read_datum(entry["density_kg_m3"]),
        young_temperature=_temperature(entry, "young_temperature_degC"),
        young_at=tuple(_point(row) for row in entry.get("young_at_GPa", ())),
        conductivity=_optional(entry, "conductivity_W_mK"),
        specific_heat=_optional(entry, "specific_heat_J_kgK"),
        melting=_temperature(entry, "melting_degC"),
        service_limit=_temperature(entry, "service_limit_degC"),
        contact_limit=_optional(entry, "contact_limit_GPa", 1e9),
        hardness=_optional(entry, "hardness_GPa", 1e9),
        sigma_hlim=_optional(entry, "sigma_hlim_MPa", 1e6),
        sigma_flim=_optional(entry, "sigma_flim_MPa", 1e6),
        tensile_strength=_optional(entry, "tensile_strength_MPa", 1e6),
        root_strength=_root_strength(entry.get("root_strength")),
        treatment=entry.get("treatment", ""),
    )


def _root_strength(entry: dict[str, Any] | None) -> RootStrength | None:
    if entry is None:
        return None
    datum_entry = {key: value for key, value in entry.items() if key != "terms"}
    return RootStrength(tuple(entry["terms"]), read_datum({"value": 1.0, **datum_entry}))


def _optional(entry: dict[str, Any], column: str, scale: float = 1.0) -> Datum | None:
    return read_datum(entry[column], scale=scale) if column in entry else None


def _temperature(entry: dict[str, Any], column: str) -> Datum | None:
    return _from_celsius(read_datum(entry[column])) if column in entry else None


def _point(row: dict[str, Any]) -> ModulusPoint:
    return ModulusPoint(
        temperature=float(row["temperature_degC"]) + ZERO_CELSIUS,
        young=read_datum(row, scale=1e9),
    )


def _from_celsius(datum: Datum) -> Datum:
    return replace(datum, value=datum.value + ZERO_CELSIUS)


def catalogue() -> dict[str, SolidRecord]:
    """Return the solids of the catalogue by name."""
    return dict(_records())


def find(name: str) -> SolidRecord:
    """Return one solid of the catalogue.

    Raises:
        InputError: there is no solid of this name; the message has the nearest ones.
    """
    listed_name = known_as(name, _records())
    if listed_name is None:
        raise unknown_name(name, _records(), what="a material")
    return _records()[listed_name]
