"""Worn flanks: how deep material is gone, as a surface that contacts feel."""

import math
from dataclasses import replace
from itertools import product
from typing import ClassVar, Self

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Lanes, Spot, Surface, Surfaces, with_surfaces
from pitchpoint.core.factored import Arrays

__all__ = [
    "BRIDGED",
    "FLATTEST",
    "WIDEST",
    "Worn",
    "WornAt",
    "averaged",
    "new_and_worn",
    "with_worn",
]

FLATTEST = 0.1
"""Part of their relative curvature as new that contacts keep at least: flatter flanks conform."""

WIDEST = 0.3
"""Half-width of a line contact over the radius of the sharper flank, up to which both are half spaces."""

BRIDGED = 2.0
"""Cells to either side over which curvatures are averaged at least: what is narrower is noise of the grid."""

_REACH = math.sqrt(1.25)  # half-widths: a parabola of that width has the variance of the semicircle
_STEPS = 12  # towards a half-width at the most: three or four, seven where flanks nearly conform
_SETTLED = 1e-3  # of the load: two steps more leave the fourth power of it
_INSIDE = 1.0 - 1e-9  # of the bracket of its square: steps that have settled on an end of it stay


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

    def mean_bend(self, flank: Lanes, across: Lanes) -> "_MeanBend":
        """What averages the second derivative along the flank over contacts of any width.

        Args:
            flank: arc lengths of their middles [m].
            across: their places across the face [m].
        """
        (count, strips), (start, end) = self.depth.shape, self.flank
        length = (end - start) / count
        if strips == 1:  # the same everywhere across
            across = jnp.zeros((1,) * jnp.ndim(across))
        aside = _weights(across, self.across, strips, straight=False)
        depth = sum(
            (weight[..., None] * self.depth.T[j] for j, weight in aside),
            jnp.zeros((*jnp.shape(across), count)),
        )
        return _MeanBend(_pieces(depth), (flank - start) / length - 0.5, length)

    def _depth_at(self, flank: Lanes, across: Lanes, *, straight: bool) -> Lanes:
        """Depth at places; beyond the middles of the last cells as there, or straight on."""
        along = _weights(flank, self.flank, self.depth.shape[0], straight)
        aside = _weights(across, self.across, self.depth.shape[1], straight)
        return sum(
            (
                along_flank * across_face * self.depth[k, j]
                for (k, along_flank), (j, across_face) in product(along, aside)
            ),
            jnp.zeros(jnp.broadcast_shapes(flank.shape, across.shape)),
        )


class _MeanBend(eqx.Module):
    """Second derivative of a worn flank around contacts, from its depth and the area under it.

    Attributes:
        pieces: polynomials of the depth, see `_pieces`.
        middle: of each contact, in cells from the middle of the first one.
        length: of a cell [m].
    """

    pieces: Float[Array, "*#b piece 5"]
    middle: Float[Array, "*b"]
    length: Float[Array, ""]

    def over(self, half_width: Lanes) -> Lanes:
        """Average over contacts that wide [1/m], see `averaged`."""
        reach = _REACH * jnp.maximum(half_width / self.length, BRIDGED)
        ends = jnp.stack([self.middle - reach, self.middle + reach])
        last_piece = self.pieces.shape[-2] - 1
        piece = jnp.clip(jnp.floor(jax.lax.stop_gradient(ends)) + 1.0, 0.0, last_piece)
        t = ends - jnp.maximum(piece - 1.0, 0.0)
        rows = jnp.take_along_axis(
            self.pieces[None], piece.astype(int)[..., None, None], axis=-2, mode="clip"
        )
        area, depth, slope, bend, third = jnp.moveaxis(rows[..., 0, :], -1, 0)
        height = depth + t * (slope + t * (bend / 2.0 + t * third / 6.0))
        below = area + t * (depth + t * (slope / 2.0 + t * (bend / 6.0 + t * third / 24.0)))
        apart = height[0] + height[1] - (below[1] - below[0]) / reach
        return jnp.asarray(1.5 * apart / (reach * self.length) ** 2)


def _pieces(depth: Float[Array, "*b cell"]) -> Float[Array, "*b piece 5"]:
    """The spline between the middles of the cells, and straight on before and behind them, in cells.

    Area since the first middle, depth and its derivatives up to the third at the origin of each piece: the
    middle with which it begins; of that before the first middle, the one with which it ends.
    """
    rim = [(0, 0)] * (depth.ndim - 1)
    bend = jnp.pad(jnp.diff(depth, n=2, axis=-1), [*rim, (1, 1)])
    third = jnp.pad(jnp.diff(bend, axis=-1), [*rim, (1, 1)])
    height, slope = depth + bend / 6.0, jnp.asarray(jnp.gradient(depth, axis=-1))
    height, slope, bend = (
        jnp.concatenate([coefficient[..., :1], coefficient], axis=-1)
        for coefficient in (height, slope, bend)
    )
    inner = (height + slope / 2.0 + bend / 6.0 + third / 24.0)[..., 1:-1]
    area = jnp.pad(jnp.cumsum(inner, axis=-1), [*rim, (2, 0)])
    return jnp.stack([area, height, slope, bend, third], axis=-1)


def averaged(
    contacts: Contacts,
    worn: tuple[Worn, Worn],
    line_load: Float[Arrays, "..."],
    modulus: Float[Arrays, ""],
) -> tuple[Contacts, Bool[Array, "pair slice *b"]]:
    """Line contacts of worn flanks as they feel them over their width, and where they are no half spaces.

    Args:
        contacts: of flanks as new.
        worn: what is gone from both members.
        line_load: w, of a shape that broadcasts over the contacts [N/m].
        modulus: E' [Pa].

    Returns:
        Contacts whose relative curvature k has the half-width b that the worn profile g has under this load,
        and True where b would grow beyond `WIDEST` of the radius of the sharper flank as new, or the length
        of a flank that wears: b stays there, or at that of flanks as new where they are wider already. Where
        no half-width is found, the curvature is nan.

    A pressure that falls to zero at both ends of a contact has w = E'/4 int s g'(s) / sqrt(b^2 - s^2) ds. By
    parts this is Hertz's w = pi E' b^2 k / 8 with the mean of g'' by the weight 2/(pi b^2) sqrt(b^2 - s^2) as
    k, for any profile that one stretch touches. In its place stands the parabola 3/(4 B) (1 - s^2/B^2) with
    B = sqrt(5/4) b, of the same variance, whose mean needs the depth at its ends and the area between them
    alone: b is 0.5 % off at the most on scars 0.4 and 0.8 times as hollow as flanks are round. The largest
    pressure is taken as Hertz's, 4/pi of the mean: on these scars 7 and 15 % off at the most.
    The contact stays on the normal of flanks as new.

    Source: Johnson, Contact Mechanics (1985), section 2.7, inverse of the integral equation, and eq. 4.43.
    """
    new = 1.0 / contacts.radius
    lanes = contacts.active.shape
    target = jnp.broadcast_to(8.0 * line_load / (jnp.pi * modulus), lanes)
    loaded = contacts.active & (target > 0.0)
    target = jnp.where(loaded, target, 1.0)
    sharper = jnp.maximum(contacts.curvature[0, 0], contacts.curvature[1, 0])
    flank = jnp.min(jnp.stack([member.flank[1] - member.flank[0] for member in worn]))
    half_space = jnp.minimum(WIDEST / jnp.where(loaded, sharper, 1.0), flank)
    as_new = jnp.sqrt(target / jnp.where(loaded, new, 1.0))
    widest = jnp.maximum(half_space, as_new)
    bends = [
        member.mean_bend(jnp.broadcast_to(place, lanes), contacts.width)
        for member, place in zip(worn, contacts.flank, strict=True)
    ]
    least = BRIDGED * jnp.minimum(bends[0].length, bends[1].length)
    balance = _Balance(new, (bends[0], bends[1]), target)
    stay = jax.lax.stop_gradient
    half, wide = _half_width(stay(balance), stay(least), stay(jnp.broadcast_to(widest, lanes)))
    # One step of Newton at the root has its derivatives.
    lack, slope = jax.jvp(balance.lack, (half,), (jnp.ones_like(half),))
    steep = jnp.maximum(stay(slope), 1e-3 * stay(target) / half)
    polished = half - jnp.where(wide, 0.0, lack / steep)
    settled = wide | (jnp.abs(lack) < _SETTLED * target)
    felt = jnp.where(loaded, jnp.where(settled, target / polished**2, jnp.nan), new)
    return replace(contacts, felt=felt), loaded & wide & (as_new < half_space)


class _Balance(eqx.Module):
    """Load of line contacts by their half-width b.

    Attributes:
        new: relative curvature of flanks as new [1/m].
        bends: what wear adds to it on both.
        target: b^2 times the curvature over b, under the load [m].
    """

    new: Lanes
    bends: tuple[_MeanBend, _MeanBend]
    target: Lanes

    def curvature(self, half: Lanes) -> Lanes:
        """Relative curvature over that width [1/m]."""
        return self.new + self.bends[0].over(half) + self.bends[1].over(half)

    def lack(self, half: Lanes) -> Lanes:
        """What they would carry beyond their load."""
        return half**2 * self.curvature(half) - self.target


def _half_width(balance: _Balance, least: Array, widest: Lanes) -> tuple[Lanes, Bool[Array, "*b"]]:
    """Half-widths in balance, and where they would pass the widest: they stay there.

    Newton's steps on the logarithm of the load over that of the half-width, from the half-width of flanks as
    new; halves of the bracket, by logarithm, in place of those that leave it. Up to the least half-width the
    curvature is the same, and the root is known.
    """
    target, low = balance.target, jnp.full_like(widest, least)
    wide, narrow = balance.lack(widest) < 0.0, balance.lack(low) >= 0.0

    def nearer(state: tuple[Array, ...]) -> tuple[Array, ...]:
        step, _, low, high, half = state
        curvature, rise = jax.jvp(balance.curvature, (half,), (half,))
        square, steep = half**2, curvature + rise / 2.0
        lack = square * curvature - target
        short, away = lack < 0.0, jnp.abs(lack) > _SETTLED * target
        low, high = jnp.where(short, half, low), jnp.where(short, high, half)
        # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
        newton = square - lack / jnp.where(steep > 0.0, steep, 1.0)
        inside = (steep > 0.0) & (newton > _INSIDE * low**2) & (_INSIDE * newton < high**2)
        half = jnp.sqrt(jnp.where(inside, newton, low * high))
        return step + 1, jnp.any(away & ~(narrow | wide)), low, high, half

    start = jnp.clip(jnp.sqrt(target / balance.new), low, widest)
    begun: tuple[Array, ...] = jnp.array(0), jnp.array(True), low, widest, start
    half = jax.lax.while_loop(lambda state: (state[0] < _STEPS) & state[1], nearer, begun)[-1]
    small = jnp.sqrt(target / jnp.where(narrow, balance.curvature(low), 1.0))
    return jnp.where(narrow, small, jnp.where(wide, widest, half)), wide


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
        axis, span = (worn.flank, worn.depth.shape[0]), worn.span[0]
        height = _parts(spot.flank[None], (1.0,), *axis, straight=False)
        bend = _parts(_beside(spot.flank, span), (-2.0, 1.0, 1.0), *axis, straight=True) / span**2
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
    a, b = surfaces
    worn = _worn(a), _worn(b)
    return (_made(a), _made(b)), worn


def _made(surfaces: tuple[Surface, ...]) -> tuple[Surface, ...]:
    return tuple(surface for surface in surfaces if not isinstance(surface, Worn))


def _worn(surfaces: tuple[Surface, ...]) -> tuple[Surface, ...]:
    return tuple(surface for surface in surfaces if isinstance(surface, Worn))


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
    worn_contacts = with_surfaces(contacts, worn, spots)
    curvature, least = 1.0 / worn_contacts.radius, FLATTEST / contacts.radius
    limited, flat = replace(worn_contacts, felt=jnp.maximum(curvature, least)), curvature < least
    if contacts.shape == "line":
        return limited, flat
    lacks = FLATTEST * contacts.relative_curvature[1] - worn_contacts.relative_curvature[1]
    across = worn_contacts.curvature.at[0, 1].add(jnp.maximum(lacks, 0.0))
    return replace(limited, curvature=across), flat | (lacks > 0.0)


def _weights(
    place: Lanes, ends: Float[Array, "2"], cells: int, straight: bool
) -> list[tuple[Array, Lanes]]:
    """Cells that count at a place, and their weights, which sum to one."""
    if cells == 1:
        return [(jnp.zeros(jnp.shape(place), int), jnp.ones(jnp.shape(place)))]
    anywhere = (place - ends[0]) / (ends[1] - ends[0]) * cells - 0.5
    at = jnp.clip(anywhere, 0.0, cells - 1.0)
    lower = jax.lax.stop_gradient(jnp.clip(jnp.floor(at), 0.0, cells - 2.0))
    t = at - lower
    before, after = (1.0 - t) ** 3 / 6.0, t**3 / 6.0
    low, high = lower == 0.0, lower == cells - 2.0
    number = lower.astype(int)
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
    weights = sum(n * _spline(place[..., None] - cell) for n, place in zip(times, at, strict=True))
    # What would lie beyond an end goes straight on from the last two cells.
    at_start, at_end = (2.0 * low - before, before - low), (-high - behind, 2.0 * high + behind)
    for number, part in zip((0, 1, cells - 2, cells - 1), (*at_start, *at_end), strict=True):
        summed = jnp.tensordot(jnp.asarray(times), part, 1)
        weights = weights + jnp.where(cell == number, summed[..., None], 0.0)
    return jnp.asarray(weights)


def _spline(distance: Arrays) -> Arrays:
    """The cubic B-spline, by the distance from its middle in cells."""
    away = jnp.abs(distance)
    return (jnp.maximum(2.0 - away, 0.0) ** 3 - 4.0 * jnp.maximum(1.0 - away, 0.0) ** 3) / 6.0
