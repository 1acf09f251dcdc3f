"""Temperature of surfaces that pass a strip of heat, and what of a body decides about it."""

from __future__ import annotations

from typing import Any

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.errors import InputError
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.solids import SolidRecord

__all__ = ["LEAST_PECLET", "Conductor", "moving_strip", "peclet_number", "shared_flash"]

Each = Float[Numbers, "*#b"]

LEAST_PECLET = 5.0
"""Peclet number below which heat that spreads along a surface counts too: left out, it makes the largest
temperature of a uniform strip 4 % too high here, 8 % at 2 and 14 % at 1 (by Jaeger's integral, 1942)."""


class Conductor(eqx.Module):
    """What of a body decides about the temperature of its surface.

    Args:
        conductivity: of heat, shape (...) [W/m/K].
        heat_capacity: density times specific heat, shape (...) [J/m3/K].

    Source: Jaeger (1942), a solid that a moving source heats.
    """

    conductivity: Float[Arrays, "..."]
    heat_capacity: Float[Arrays, "..."]

    def __init__(self, *, conductivity: ArrayLike, heat_capacity: ArrayLike) -> None:
        self.conductivity = float64_array(conductivity)
        self.heat_capacity = float64_array(heat_capacity)

    @classmethod
    def of(cls, solid: SolidRecord) -> Conductor:
        """That of a material, whose values say where they come from.

        Args:
            solid: of the catalogue, or by value.

        Raises:
            InputError: its conductivity or its specific heat is not known.

        Example:
            >>> from pitchpoint.materials import solids
            >>> round(float(Conductor.of(solids.find("steel")).effusivity))
            12942
        """
        for key in ("conductivity", "specific_heat"):
            if getattr(solid, key) is None:
                raise InputError(
                    f"the temperature of a surface of {solid.name} needs its {key.replace('_', ' ')}, "
                    "which is not known",
                    key=f"{solid.name}.{key}",
                )
        values: dict[str, Any] = {key: datum.value for key, datum in solid.data().items()}
        return cls(
            conductivity=values["conductivity"],
            heat_capacity=values["density"] * values["specific_heat"],
        )

    @property
    def effusivity(self) -> Float[Arrays, "..."]:
        """Root of conductivity times heat capacity [W s^0.5/m2/K]."""
        return jnp.sqrt(self.conductivity * self.heat_capacity)


def peclet_number(*, speed: Each, half_width: Each, body: Conductor) -> Each:
    """Peclet number |u| b rho c/(2 k) of a surface that passes a strip of heat [1].

    Args:
        speed: u, of the surface across the strip [m/s].
        half_width: b, of the strip [m].
        body: behind the surface.

    Source: Jaeger (1942), with thermal diffusivity k/(rho c).

    Example:
        >>> from pitchpoint.lubrication.flash_temperature import Conductor
        >>> steel = Conductor(conductivity=46.0, heat_capacity=3.64e6)
        >>> round(float(peclet_number(speed=1.0, half_width=1e-4, body=steel)), 2)
        3.96
    """
    return jnp.abs(speed) * half_width * body.heat_capacity / (2.0 * body.conductivity)


def shared_flash(
    *,
    heat: Each,
    half_width: Each,
    speed_a: Each,
    speed_b: Each,
    bodies: tuple[Conductor, Conductor],
) -> Float[Array, "*#b"]:
    """Largest rise of two surfaces that share the heat of a uniform strip so as to be equally warm [K].

    2 q (2 b/pi)^(1/2)/(e_a |u_a|^(1/2) + e_b |u_b|^(1/2)), at the end of the strip, with effusivities e.

    Args:
        heat: q, made per area of the strip [W/m2].
        half_width: b, of the strip [m].
        speed_a, speed_b: u, of the surfaces across the strip, one of them not zero [m/s].
        bodies: behind the surfaces.

    Source: Jaeger (1942), limit of large Peclet numbers; Johnson, Contact Mechanics (1985), section 12.3.

    Example:
        >>> from pitchpoint.lubrication.flash_temperature import Conductor
        >>> steel = Conductor(conductivity=46.0, heat_capacity=3.64e6)
        >>> rise = shared_flash(
        ...     heat=1e8, half_width=2e-4, speed_a=5.0, speed_b=3.0, bodies=(steel, steel)
        ... )
        >>> round(float(rise), 1)
        44.0
    """
    carried = [
        body.effusivity * jnp.sqrt(jnp.abs(speed))
        for body, speed in zip(bodies, (speed_a, speed_b), strict=True)
    ]
    return 2.0 * heat * jnp.sqrt(2.0 * half_width / jnp.pi) / (carried[0] + carried[1])


def moving_strip(
    x: Float[Arrays, " node"], edges: Float[Arrays, " edge"]
) -> Float[Array, "node cell"]:
    """Integrals of (x - x')^(-1/2) over the part of each cell that a surface has passed [m^0.5].

    Times the heat into the surface on each cell, over the root of pi k rho c |u|, it is the rise of its
    temperature, where heat spreads into the body alone and not along its surface.

    Args:
        x: places along the motion of the surface, shape (node,) [m].
        edges: of the cells, rising, shape (cell + 1,) [m].

    Source: Jaeger (1942), limit of large Peclet numbers; Johnson, Contact Mechanics (1985), section 12.3.
    """
    passed = jnp.sqrt(jnp.maximum(x[:, None] - edges, 0.0))
    return 2.0 * (passed[:, :-1] - passed[:, 1:])
