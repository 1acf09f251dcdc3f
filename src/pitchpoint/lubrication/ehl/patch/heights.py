"""Heights of rough surfaces on a map, as the cells of a grid see them."""

from __future__ import annotations

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.errors import InputError
from pitchpoint.materials._leaves import float64_array

__all__ = ["HeightMap", "lowered"]

FEWEST = 2
"""Places of a map along each axis."""


class HeightMap(eqx.Module):
    """Heights of a surface above its mean plane, or of both together, over the patch of a contact.

    A height stands out of the material: by it the gap of the bodies is less (eq. 9 of Xu et al. 2021, whose
    mu is what the gap gains). Between its places a map is bilinear, beyond them even, or it repeats. Every
    cell of a grid takes the mean over its area, so that a coarse grid sees a smoother surface.

    Attributes:
        x: places along the contact, rising, shape (x,) [m].
        y: places across it, rising, shape (y,) [m].
        heights: shape (y, x) [m].
        member: 0 or 1, the body whose surface takes the map along; None for a map that stays where it is.
        periodic: whether the map repeats beyond its first and last places along both axes.
    """

    x: Float[Arrays, " x"]
    y: Float[Arrays, " y"]
    heights: Float[Arrays, "y x"]
    member: int | None = eqx.field(static=True)
    periodic: bool = eqx.field(static=True)

    def __init__(
        self,
        *,
        x: ArrayLike,
        y: ArrayLike,
        heights: ArrayLike,
        member: int | None = None,
        periodic: bool = False,
    ) -> None:
        """A map of heights.

        Args:
            x: places along the contact, rising, shape (x,) [m].
            y: places across it, rising, shape (y,) [m].
            heights: shape (y, x) [m].
            member: 0 or 1, the body whose surface takes the map along; None for one that stays.
            periodic: whether the map repeats, with its last places the first ones of the next period.

        Raises:
            InputError: heights of another shape than their places, or of a member that there is not.
        """
        self.x, self.y, self.heights = float64_array(x), float64_array(y), float64_array(heights)
        self.member, self.periodic = member, periodic
        shape = tuple(places.shape[0] if places.ndim == 1 else 0 for places in (self.y, self.x))
        if self.heights.shape != shape or min(shape) < FEWEST:
            raise InputError(
                f"heights of the shape {self.heights.shape} on {self.y.size} places y and {self.x.size} "
                "places x: a map has a row for each of at least two y and a column for each of two x",
                key="heights",
            )
        if member not in (None, 0, 1):
            raise InputError(
                f"a height map of member {member}: it is on member 0 or 1, or stays with None",
                key="member",
            )

    def over(self, x: Float[Arrays, " edge_x"], y: Float[Arrays, " edge_y"]) -> Array:
        """Mean height over each cell between edges, shape (edges of y - 1, edges of x - 1) [m]."""
        along, across = _means(self.x, x, self.periodic), _means(self.y, y, self.periodic)
        means: Array = across @ self.heights @ along.T
        return means

    def standing(self, along: ArrayLike = 0.0, across: ArrayLike = 0.0) -> HeightMap:
        """The map of no member, moved along and across [m]."""
        x, y = self.x + along, self.y + across
        return HeightMap(x=x, y=y, heights=self.heights, periodic=self.periodic)

    def turned(self, swapped: bool, along: bool, across: bool) -> HeightMap:
        """The map with x and y exchanged, then with x, y counted backwards."""
        x, y, heights = self.x, self.y, self.heights
        if swapped:
            x, y, heights = y, x, heights.T
        if along:
            x, heights = -x[::-1], heights[:, ::-1]
        if across:
            y, heights = -y[::-1], heights[::-1]
        member, periodic = self.member, self.periodic
        return HeightMap(x=x, y=y, heights=heights, member=member, periodic=periodic)


def lowered(
    maps: tuple[HeightMap, ...], x: Float[Arrays, " x"], edges: Float[Arrays, " edge"]
) -> Float[Array, "y x"]:
    """By how much less the gap is in each cell of a grid, shape (y, x) [m].

    Args:
        maps: of both surfaces, of as many as there are.
        x: middles of the cells, in uniform steps, shape (x,) [m].
        edges: of the rows, shape (y + 1,) [m].
    """
    x = jnp.asarray(x)
    half = 0.5 * (x[-1] - x[0]) / (x.shape[0] - 1)
    beside = jnp.append(x - half, x[-1] + half)
    return jnp.sum(
        jnp.stack([height_map.over(beside, jnp.asarray(edges)) for height_map in maps]), axis=0
    )


def _means(places: Array, edges: Array, periodic: bool) -> Array:
    """Matrix that takes linear values at places to means between edges, shape (edge - 1, place)."""
    upto = _repeated(places, edges) if periodic else _upto(places, edges)
    return jnp.diff(upto, axis=0) / jnp.diff(edges)[:, None]


def _upto(places: Array, ends: Array) -> Array:
    """Integral from the first place to each end by a value of one at every place, shape (end, place)."""
    steps = jnp.diff(places)
    part = jnp.clip((ends[:, None] - places[:-1]) / steps, 0.0, 1.0)
    rising = 0.5 * steps * part**2
    integral = jnp.pad(steps * part - rising, ((0, 0), (0, 1))) + jnp.pad(rising, ((0, 0), (1, 0)))
    before, behind = jnp.minimum(ends - places[0], 0.0), jnp.maximum(ends - places[-1], 0.0)
    return integral.at[:, 0].add(before).at[:, -1].add(behind)


def _repeated(places: Array, ends: Array) -> Array:
    """The same of a map that repeats."""
    period = places[-1] - places[0]
    times = jnp.floor((ends - places[0]) / period)
    return times[:, None] * _upto(places, places[-1:]) + _upto(places, ends - times * period)
