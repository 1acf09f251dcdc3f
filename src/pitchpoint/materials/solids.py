"""Elastic solids: the materials of gear bodies, and the reduced modulus of two of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint.errors import InputError, unknown_name
from pitchpoint.materials._leaves import Datum, as_array, check_positive, read_data, read_datum

__all__ = ["Solid", "SolidRecord", "catalogue", "find", "reduced_modulus"]


class Solid(eqx.Module):
    """An isotropic linear-elastic solid, ready for a computation.

    Args:
        young: Young's modulus, shape (...) [Pa].
        poisson: Poisson's ratio, shape (...) [1].
        density: density, shape (...) [kg/m3].

    Example:
        >>> steel = Solid(young=206e9, poisson=0.3, density=7830.0)
    """

    young: Float[Array, "..."]
    poisson: Float[Array, "..."]
    density: Float[Array, "..."]

    def __init__(self, *, young: ArrayLike, poisson: ArrayLike, density: ArrayLike) -> None:
        self.young = as_array(young)
        self.poisson = as_array(poisson)
        self.density = as_array(density)

    @property
    def plane_strain_modulus(self) -> Float[Array, "..."]:
        """Young's modulus over one minus Poisson's ratio squared, shape (...) [Pa]."""
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
        >>> steel = find("steel").build()
        >>> round(float(reduced_modulus(steel, steel)) / 1e9, 1)
        226.4
    """
    return 2.0 / (1.0 / a.plane_strain_modulus + 1.0 / b.plane_strain_modulus)


@dataclass(frozen=True, kw_only=True)
class SolidRecord:
    """A solid with its name and the origin of each value; `build()` gives the bare numbers.

    Args:
        name: name in the catalogue.
        title: what it is, in words.
        young: Young's modulus [Pa].
        poisson: Poisson's ratio [1], between -1 and 0.5.
        density: density [kg/m3].

    Raises:
        InputError: a value is out of its physical range.
    """

    name: str
    title: str = ""
    young: Datum
    poisson: Datum
    density: Datum

    def __post_init__(self) -> None:
        check_positive(self.name, [("young", self.young), ("density", self.density)])
        if not -1.0 < self.poisson.value <= 0.5:
            raise InputError(
                f"{self.poisson.value} is not between -1 and 0.5", key=f"{self.name}.poisson"
            )

    def build(self) -> Solid:
        """Return the numbers alone, for a computation."""
        return Solid(young=self.young.value, poisson=self.poisson.value, density=self.density.value)


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
    )


def catalogue() -> dict[str, SolidRecord]:
    """Return the solids of the catalogue by name."""
    return dict(_records())


def find(name: str) -> SolidRecord:
    """Return one solid of the catalogue.

    Raises:
        InputError: there is no solid of this name; the message has the nearest ones.
    """
    if name not in _records():
        raise unknown_name(name, _records(), what="a material")
    return _records()[name]
