"""Worn flanks: how deep material is gone, as a surface that contacts feel."""

from dataclasses import replace
from itertools import product
from typing import ClassVar, Self

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Lanes, Spot, Surface, Surfaces, with_surfaces
from pitchpoint.factored import Arrays

__all__ = ["FLATTEST", "Worn", "WornAt", "new_and_worn", "with_worn"]

FLATTEST = 0.1
"""Part of their relative curvature as new that contacts keep at least: flatter flanks conform."""


class Worn(Surface):
    """Depth of wear on all flanks of a member that carry, smoothed over two cells to either side.

    Cubic B-splines on an even grid whose coefficients are the mean depths of the cells: they keep the volume
    but for the half cells at the ends, never fall below zero, and have curvatures without jumps. From the
    middle of the last cell on the depth stays what it is there.

    A contact bridges what is narrower than itself: it feels the second difference over its half-width, not
    the curvature at one point, and so hardly how many cells there are.

    Attributes:
        depth: mean depth of each cell along the flank and across the face [m].
        flank: arc lengths at which the grid begins and ends [m].
        across: places across the face at which it begins and ends [m].
        span: half-widths of the contacts along the flank and across it [m].

    Source: de Boor, A Practical Guide to Splines (2001), chapter 12, the Schoenberg approximation.
    """

    both: ClassVar[bool] = False

    depth: Float[Array, "cell strip"]
    flank: Float[Array, "2"]
    across: Float[Array, "2"]
    span: Float[Array, "2"]

    def missing(self, spot: Spot) -> Lanes:
        """Depth at each place."""
        return self._depth_at(spot.flank, spot.across, straight=False)

    def bent(self, spot: Spot) -> Float[Array, "2 *#b"]:
        """Second differences of the depth over the span of a contact; flanks go straight on at their ends."""
        flank, across = spot.flank, spot.across
        along = self._depth_at(_beside(flank, self.span[0]), across, straight=True)
        if self.depth.shape[1] == 1:
            return jnp.stack([_second(along, self.span[0]), jnp.zeros_like(flank)])
        aside = self._depth_at(flank, _beside(across, self.span[1]), straight=True)
        return jnp.stack([_second(along, self.span[0]), _second(aside, self.span[1])])

    def _depth_at(self, flank: Lanes, across: Lanes, *, straight: bool) -> Lanes:
        """Depth at places; beyond the middles of the last cells as there, or straight on."""
        along = _weights(flank, self.flank, self.depth.shape[0], straight)
        aside = _weights(across, self.across, self.depth.shape[1], straight)
        return sum(
            (one * other * self.depth[k, j] for (k, one), (j, other) in product(along, aside)),
            jnp.zeros(jnp.broadcast_shapes(flank.shape, across.shape)),
        )


class WornAt(Surface):
    """Depth of wear that is the same across the face, at places that stay: each feels a sum over the cells.

    Many states of the flanks then cost two products of a matrix each, and no search for cells.

    Attributes:
        depth: mean depth of each cell along the flank [m].
        height: part of each cell in the depth at every place.
        bend: the same of the second difference along the flank [1/m2].
    """

    both: ClassVar[bool] = False

    depth: Float[Array, " cell"]
    height: Float[Array, "*b cell"]
    bend: Float[Array, "*b cell"]

    @classmethod
    def of(cls, worn: Worn, spot: Spot) -> Self:
        """A worn flank at places.

        Args:
            worn: with one strip across the face.
            spot: the places.
        """
        given, span = (worn.flank, worn.depth.shape[0]), worn.span[0]
        height = _parts(spot.flank[None], (1.0,), *given, straight=False)
        bend = _parts(_beside(spot.flank, span), (-2.0, 1.0, 1.0), *given, straight=True) / span**2
        return cls(worn.depth[:, 0], height, bend)

    def at(self, depth: Float[Array, " cell"]) -> Self:
        """The same with other depths.

        Args:
            depth: of each cell [m].
        """
        return replace(self, depth=depth)

    def missing(self, spot: Spot) -> Lanes:
        """Depth at each of the places."""
        return self.height @ self.depth

    def bent(self, spot: Spot) -> Float[Array, "2 *#b"]:
        """Second differences there, as `Worn` has them."""
        along = self.bend @ self.depth
        return jnp.stack([along, jnp.zeros_like(along)])


def _beside(place: Lanes, span: Array) -> Lanes:
    """Places at, before and behind a contact, on an axis in front."""
    return jnp.stack([place, place - span, place + span])


def _second(values: Lanes, span: Array) -> Lanes:
    """Second difference of values there."""
    return (values[1] + values[2] - 2.0 * values[0]) / span**2


def new_and_worn(surfaces: Surfaces) -> tuple[Surfaces, Surfaces]:
    """Surfaces of both members as made, and what wear has added."""
    first, second = surfaces
    worn = _worn(first), _worn(second)
    return (_made(first), _made(second)), worn


def _made(surfaces: tuple[Surface, ...]) -> tuple[Surface, ...]:
    return tuple(one for one in surfaces if not isinstance(one, Worn))


def _worn(surfaces: tuple[Surface, ...]) -> tuple[Surface, ...]:
    return tuple(one for one in surfaces if isinstance(one, Worn))


def with_worn(
    contacts: Contacts, worn: Surfaces, spots: tuple[Spot, Spot]
) -> tuple[Contacts, Bool[Arrays, "pair slice *b"]]:
    """Contacts of worn flanks, and where they would have become flatter than they are taken for.

    Args:
        contacts: of flanks as new.
        worn: what wear has added to both members.
        spots: where the contacts lie on them.

    They stay on the normals of flanks as new, and keep a part of their relative curvatures.
    """
    found = with_surfaces(contacts, worn, spots)
    own, least = 1.0 / found.radius, FLATTEST / contacts.radius
    kept, flat = replace(found, felt=jnp.maximum(own, least)), own < least
    if contacts.shape == "line":
        return kept, flat
    lacks = FLATTEST * contacts.relative_curvature[1] - found.relative_curvature[1]
    across = found.curvature.at[0, 1].add(jnp.maximum(lacks, 0.0))
    return replace(kept, curvature=across), flat | (lacks > 0.0)


def _weights(
    place: Lanes, ends: Float[Array, "2"], cells: int, straight: bool
) -> list[tuple[Array, Lanes]]:
    """Cells that count at a place, and their weights, which sum to one."""
    if cells == 1:
        return [(jnp.zeros(jnp.shape(place), int), jnp.ones(jnp.shape(place)))]
    anywhere = (place - ends[0]) / (ends[1] - ends[0]) * cells - 0.5
    at = jnp.clip(anywhere, 0.0, cells - 1.0)
    first = jax.lax.stop_gradient(jnp.clip(jnp.floor(at), 0.0, cells - 2.0))
    t = at - first
    before, after = (1.0 - t) ** 3 / 6.0, t**3 / 6.0
    low, high = first == 0.0, first == cells - 2.0
    number = first.astype(int)
    beyond = anywhere - at if straight else jnp.zeros_like(at)
    # Cells that would lie beyond an end go straight on from the last two: no curvature comes from there.
    here = (4.0 - 6.0 * t**2 + 3.0 * t**3) / 6.0 - jnp.where(high, after, 0.0) - beyond
    later = (1.0 + 3.0 * t + 3.0 * t**2 - 3.0 * t**3) / 6.0 - jnp.where(low, before, 0.0) + beyond
    return [
        (jnp.maximum(number - 1, 0), jnp.where(low, 2.0, 1.0) * before),
        (number, here),
        (number + 1, later),
        (jnp.minimum(number + 2, cells - 1), jnp.where(high, 2.0, 1.0) * after),
    ]


def _parts(
    places: Float[Arrays, "place *b"],
    times: tuple[float, ...],
    ends: Float[Array, "2"],
    cells: int,
    *,
    straight: bool,
) -> Float[Array, "*b cell"]:
    """Weights of all cells, four at least, in a sum over places: those of `_weights` in a row."""
    anywhere = (places - ends[0]) / (ends[1] - ends[0]) * cells - 0.5
    at = jnp.clip(anywhere, 0.0, cells - 1.0)
    beyond = anywhere - at if straight else jnp.zeros_like(at)
    low, before = _spline(at + 1.0), jnp.minimum(beyond, 0.0)
    high, behind = _spline(at - cells), jnp.maximum(beyond, 0.0)
    cell = jnp.arange(float(cells))
    found = sum(n * _spline(one[..., None] - cell) for n, one in zip(times, at, strict=True))
    # What would lie beyond an end goes straight on from the last two cells.
    first, last = (2.0 * low - before, before - low), (-high - behind, 2.0 * high + behind)
    for number, part in zip((0, 1, cells - 2, cells - 1), (*first, *last), strict=True):
        whole = jnp.tensordot(jnp.asarray(times), part, 1)
        found = found + jnp.where(cell == number, whole[..., None], 0.0)
    return jnp.asarray(found)


def _spline(distance: Arrays) -> Arrays:
    """The cubic B-spline, by the distance from its middle in cells."""
    away = jnp.abs(distance)
    return (jnp.maximum(2.0 - away, 0.0) ** 3 - 4.0 * jnp.maximum(1.0 - away, 0.0) ** 3) / 6.0
