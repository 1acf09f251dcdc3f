"""Thermal effects of a film by name, and what conducts the heat of a contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Float

from pitchpoint.factored import Arrays
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials._leaves import as_array
from pitchpoint.registry import Registry

__all__ = ["ISOTHERMAL", "THERMAL", "Conduction", "ThermalEffect"]

ISOTHERMAL: Final = "isothermal"
"""Name of no heat: the film is as warm as its inlet everywhere."""


class Conduction(eqx.Module):
    """What conducts the heat of contacts `*b` whose film is as warm as its mean.

    Heat is made evenly over the film and leaves it across: each surface takes half of it, and what the film
    conducts from the warmer surface to the colder one. Friction of asperities is heat at the surfaces, half
    of it at each. A surface warms as it passes the contact (`moving_strip`); one that stands still takes no
    heat. Oil that flows takes none along, and compression makes none. Over a patch heat spreads into the
    bodies and not to the sides, as Peclet numbers are large.

    Args:
        a: body of member 0.
        b: body of member 1.
        oil_conductivity: k of the oil, shape (...) [W/m/K].
    """

    a: Conductor
    b: Conductor
    oil_conductivity: Float[Arrays, "..."]

    def __init__(self, *, a: Conductor, b: Conductor, oil_conductivity: ArrayLike) -> None:
        self.a, self.b, self.oil_conductivity = a, b, as_array(oil_conductivity)


@dataclass(frozen=True, eq=False)
class ThermalEffect:
    """A named thermal effect of the film.

    Attributes:
        name: by which it is chosen.
        title: name to show.
        sources: keys of the bibliography.
        note: what it takes for granted.
    """

    name: str
    title: str
    sources: tuple[str, ...]
    note: str


THERMAL = Registry(
    "thermal effect of a film",
    ThermalEffect(
        ISOTHERMAL,
        "isothermal film",
        (),
        "The film is as warm as its inlet: traction of a contact that slides much comes out too high.",
    ),
    ThermalEffect(
        "mean_film",
        "mean temperature of the film, flash temperature of both surfaces",
        ("jaeger_1942", "johnson_1985"),
        "Steady; viscosity, density and shear stress are those at the mean temperature across the film. The "
        "flowing oil takes no heat along, compression makes none. Peclet numbers of both surfaces are above "
        "about 5; a slower surface conducts heat along itself too.",
    ),
)
