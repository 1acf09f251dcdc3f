"""Thermal effects of a film by name, and what conducts the heat of a contact."""

from __future__ import annotations

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Float

from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials._leaves import float64_array

__all__ = [
    "Conduction",
]


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

    Source: Jaeger (1942) for surfaces that pass, see `moving_strip`; across the film Fourier's law.
    """

    a: Conductor
    b: Conductor
    oil_conductivity: Float[Arrays, "..."]

    def __init__(self, *, a: Conductor, b: Conductor, oil_conductivity: ArrayLike) -> None:
        self.a, self.b, self.oil_conductivity = a, b, float64_array(oil_conductivity)
