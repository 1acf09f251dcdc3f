"""Contacts of finite length with oil between them: lines with ends, and ellipses."""

from __future__ import annotations

from typing import Final

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.gaps import missing_along
from pitchpoint.contact.surface import Surface
from pitchpoint.core.factored import Arrays
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line import FLOODED
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.texture import Texture
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.fluid import Fluid

__all__ = ["PatchContact", "elliptic_contact", "finite_line"]

STILL: Final = (0.0, 0.0)

Heights = HeightMap | tuple[HeightMap, ...]


class PatchContact(eqx.Module):
    """One contact between two bodies with oil between them, along x and across it, along y.

    The gap of the bodies where they just touch is x^2/(2 R(y)) + y^2/(2 Ry) + relief(y), less by what the
    height maps stand out of their mean planes.

    Attributes:
        load: normal one F [N].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members.
        places: along y at which radius, relief and speeds are given, rising, shape (k,) [m].
        radius: relative radius of curvature R along x, shape (k,) [m].
        relief: by which the bodies lie apart, shape (k,) [m].
        bend: 1/Ry, relative curvature along y [1/m].
        profile: surfaces that are missing along y, such as those of `contact.end_profiles`.
        length: of the contact line, whose middle is at y = 0 [m]; None where an ellipse ends by itself.
        speed_a: surface speed of member 0 along x relative to the contact, shape (k,) [m/s].
        speed_b: of member 1.
        across_a: surface speed of member 0 along y [m/s].
        across_b: of member 1.
        approach: speed at which the bodies approach each other [m/s].
        inlet: distance from the middle of the contact, along the entrainment, at which oil begins [m].
        fluid: the oil.
        texture: of the surfaces, below what the height maps show; None for smooth ones.
        heights: maps of what stands out of the surfaces, or of both together.
        conduction: of heat, for the temperature of film and surfaces; None for isothermal films.
        ends: of the bodies in `contact.half_space.ENDS`; static.

    From the parabolas that touch both bodies where they meet.
    """

    load: Float[Arrays, ""]
    modulus: Float[Arrays, ""]
    places: Float[Arrays, " k"]
    radius: Float[Arrays, " k"]
    relief: Float[Arrays, " k"]
    bend: Float[Arrays, ""]
    length: Float[Arrays, ""] | None
    speed_a: Float[Arrays, " k"]
    speed_b: Float[Arrays, " k"]
    across_a: Float[Arrays, ""]
    across_b: Float[Arrays, ""]
    approach: Float[Arrays, ""]
    inlet: Float[Arrays, ""]
    fluid: Fluid
    texture: Texture | None
    profile: tuple[Surface, ...]
    heights: tuple[HeightMap, ...]
    conduction: Conduction | None
    ends: str = eqx.field(static=True)

    def along(self, values: Float[Arrays, " k"], y: Float[Arrays, " y"]) -> Float[Array, " y"]:
        """Values that are given at the places, at others; even beyond the first and the last."""
        return jnp.interp(y, self.places, values)

    def gap(self, x: Float[Arrays, " x"], y: Float[Arrays, " y"]) -> Float[Array, "y x"]:
        """Gap of the bodies where their mean planes just touch, shape (y, x) [m]."""
        apart = self.along(self.relief, y) + missing_along(self.profile, y) + 0.5 * self.bend * y**2
        return jnp.asarray(x) ** 2 / (2.0 * self.along(self.radius, y)[:, None]) + apart[:, None]

    def entrainment(self, y: Float[Arrays, " y"]) -> Float[Array, " y"]:
        """Mean of the surface speeds along x, shape (y,) [m/s]."""
        return 0.5 * self.along(self.speed_a + self.speed_b, y)


def finite_line(
    *,
    load: ArrayLike,
    length: ArrayLike,
    radius: ArrayLike,
    modulus: ArrayLike,
    speed_a: ArrayLike,
    speed_b: ArrayLike,
    fluid: Fluid,
    places: ArrayLike | None = None,
    relief: ArrayLike = 0.0,
    profile: tuple[Surface, ...] = (),
    approach: ArrayLike = 0.0,
    inlet: ArrayLike = FLOODED,
    texture: Texture | None = None,
    heights: Heights = (),
    conduction: Conduction | None = None,
    ends: str = "half_space",
) -> PatchContact:
    """A line contact of finite length, such as that of a tooth along its face.

    Args:
        load: normal one [N].
        length: of the contact line, whose middle is at y = 0 [m].
        radius: relative radius of curvature, one or one at each of the places [m].
        modulus: E' [Pa].
        speed_a: surface speed of member 0 relative to the contact, one or one at each place [m/s].
        speed_b: of member 1.
        fluid: the oil.
        places: along the line at which arrays are given, rising [m]; needed with arrays.
        relief: by which the bodies lie apart besides, one or one at each place [m]: crowning, misalignment.
        profile: surfaces missing along the line, such as those of `contact.end_profiles`.
        approach: speed at which the bodies approach each other [m/s].
        inlet: distance from the middle of the contact, along the entrainment, at which oil begins [m]; fully
            flooded unless given.
        texture: of the surfaces; None for smooth ones.
        heights: map of what stands out of the surfaces, or one for each; with a texture, that is below them.
        conduction: of heat, for the temperature of film and surfaces; the film is isothermal unless given.
        ends: "half_space", or "mirrored" for bodies that both end with the line.

    Raises:
        InputError: arrays without places, or of another shape.
    """
    at = float64_array(jnp.zeros(1) if places is None else places)
    along_line = {"radius": radius, "relief": relief, "speed_a": speed_a, "speed_b": speed_b}
    return PatchContact(
        load=float64_array(load),
        modulus=float64_array(modulus),
        places=at,
        **{name: _at(at, name, value) for name, value in along_line.items()},
        bend=float64_array(0.0),
        length=float64_array(length),
        across_a=float64_array(0.0),
        across_b=float64_array(0.0),
        approach=float64_array(approach),
        inlet=float64_array(inlet),
        fluid=fluid,
        texture=texture,
        profile=profile,
        heights=_maps(heights),
        conduction=conduction,
        ends=ends,
    )


def elliptic_contact(
    *,
    load: ArrayLike,
    radius: ArrayLike,
    transverse_radius: ArrayLike,
    modulus: ArrayLike,
    speed_a: ArrayLike,
    speed_b: ArrayLike,
    fluid: Fluid,
    across: tuple[ArrayLike, ArrayLike] = STILL,
    approach: ArrayLike = 0.0,
    inlet: ArrayLike = FLOODED,
    texture: Texture | None = None,
    heights: Heights = (),
    conduction: Conduction | None = None,
) -> PatchContact:
    """A contact of two bodies that touch in a point without load, and in an ellipse under it.

    Args:
        load: normal one [N].
        radius: relative radius of curvature along x [m].
        transverse_radius: relative radius of curvature along y [m].
        modulus: E' [Pa].
        speed_a: surface speed of member 0 along x relative to the contact [m/s].
        speed_b: of member 1.
        fluid: the oil.
        across: surface speeds of both members along y [m/s].
        approach: speed at which the bodies approach each other [m/s].
        inlet: distance from the middle of the contact, along the entrainment, at which oil begins [m]; fully
            flooded unless given.
        texture: of the surfaces; None for smooth ones.
        heights: map of what stands out of the surfaces, or one for each; with a texture, that is below them.
        conduction: of heat, for the temperature of film and surfaces; the film is isothermal unless given.
    """
    unit = jnp.ones(1)
    return PatchContact(
        load=float64_array(load),
        modulus=float64_array(modulus),
        places=jnp.zeros(1),
        radius=float64_array(radius) * unit,
        relief=0.0 * unit,
        speed_a=float64_array(speed_a) * unit,
        speed_b=float64_array(speed_b) * unit,
        bend=1.0 / float64_array(transverse_radius),
        length=None,
        across_a=float64_array(across[0]),
        across_b=float64_array(across[1]),
        approach=float64_array(approach),
        inlet=float64_array(inlet),
        fluid=fluid,
        texture=texture,
        profile=(),
        heights=_maps(heights),
        conduction=conduction,
        ends="half_space",
    )


def _maps(heights: Heights) -> tuple[HeightMap, ...]:
    maps = (heights,) if isinstance(heights, HeightMap) else tuple(heights)
    if not all(isinstance(height_map, HeightMap) for height_map in maps):
        raise InputError("heights are a HeightMap, or several", key="heights")
    return maps


def _at(places: Array, name: str, value: ArrayLike) -> Array:
    """A value at every place."""
    quantity = float64_array(value)
    if quantity.ndim and quantity.shape != places.shape:
        raise InputError(
            f"{name.replace('_', ' ')} has the shape {quantity.shape}, and places along the line have "
            f"{places.shape}: they have to be equal",
            key=name,
        )
    return jnp.broadcast_to(quantity, places.shape)
