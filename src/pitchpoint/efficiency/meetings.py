"""Phases of links one behind the other, by the few loads that a link carries through all of them."""

from functools import cache

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["FEW", "Meetings", "among_few", "few_between", "meetings", "unmet"]

FEW = 5
"""Loads that stand for all that a link carries while phases of the links behind it meet."""

Each = Float[Array, "*#b"]
Ends = Float[Array, "*#b its_phase"]
States = Float[Array, "*#b its_load its_behind its_node"]


class Meetings(eqx.Module):
    """Loads that a link carries while the phases of all links behind it meet.

    The links behind act on a link by the torque that they ask for, and where bearings of a common shaft
    feel the teeth of two links by the forces on these. What a link does is smooth in its load, which
    varies little: a polynomial through few loads gives it, and so every mean is a sum over them. Forces on
    bearings go with the phase of the link behind, which is kept where they are felt.

    Attributes:
        load: that the link carries [N m or N]; along the last axis with the phase of the link behind where
            it is kept, along the one before from the lowest to the highest.
        weight: of each in means; they sum to one.
        coarse: the same with every second load alone, to tell how far a mean is off.
        part: of every state of the link behind in the weight of every load.
        between: of few states of the link behind in what else it asks for under every load; None where no
            phase is kept.

    From a polynomial through few loads.
    """

    load: Float[Array, "*b load behind"]
    weight: Float[Array, "*#b load behind"]
    coarse: Float[Array, "*#b load behind"]
    part: Float[Array, "*#b load its_load its_behind its_node"]
    between: Float[Array, "*#b load its_load its_behind its_node"] | None = None

    @property
    def kept(self) -> bool:
        """True if the loads go with the phase of the link behind."""
        return self.between is not None

    def summed(
        self, values: Float[Array, "... its_load its_behind its_node"]
    ) -> Float[Array, "... load behind"]:
        """Sum of values of the link behind, each with its part in the loads of this one.

        Args:
            values: of the states of the link behind, with their weights in them.
        """
        sums = _summed(self.part, values)
        return sums if self.kept else jnp.sum(sums, axis=-1, keepdims=True)

    def following(self, values: Float[Array, "... its_load its_behind its_node"]) -> Array:
        """Values of the link behind under the loads of this one, where its phase is kept."""
        assert self.between is not None
        return _summed(self.between, values)


def _summed(part: Array, values: Array) -> Array:
    return jnp.sum(part * values[..., None, :, :, :], axis=(-3, -2))


def unmet(load: Each) -> Meetings:
    """The one load of a link with none behind it.

    Args:
        load: that it carries [N m or N].
    """
    once = jnp.ones((1, 1))
    return Meetings(load[..., None, None], once, once, once[..., None, None])


def meetings(
    torque: States,
    often: States,
    ends: tuple[Ends, Ends],
    *,
    kept: bool = False,
    few: int | None = FEW,
) -> Meetings:
    """Loads of a link from the states of the one behind it.

    Args:
        torque: that the link behind asks for [N m or N].
        often: weight of each of its states; they sum to one.
        ends: lowest and highest torque that it asks for, at each of its phases where these are kept, else
            along an axis of length one.
        kept: True to keep the phase of the link behind.
        few: odd number of loads that stand for all others; None for all of them.
    """
    count = torque.shape[-3] * torque.shape[-2]
    if few is None or (kept and count == 1):
        every = jnp.eye(count).reshape(count, *torque.shape[-3:-1], 1)
        load = torque.reshape(*torque.shape[:-3], count, torque.shape[-1])
        weight = _summed(every, often)
        return Meetings(load, weight, weight, every, every)
    low, high = (end[..., None, None, :] for end in ends)
    fine = among_few(torque, low, high, few)
    coarse = jnp.zeros_like(fine).at[::2].set(among_few(torque, low, high, few // 2 + 1))
    part, coarse_part = (jnp.moveaxis(shares, 0, -4) for shares in (fine, coarse))
    weight, rough = (_summed(shares, often) for shares in (part, coarse_part))
    if not kept:
        weight, rough = (jnp.sum(weights, axis=-1, keepdims=True) for weights in (weight, rough))
    load = jnp.swapaxes(few_between(*ends, few), -1, -2)
    return Meetings(load, weight, rough, part, _through_three(torque, load) if kept else None)


def _through_three(torque: States, load: Float[Array, "*b few its_node"]) -> Array:
    """Parts of three states with the lowest, a middle and the highest torque, see `Meetings.between`.

    From Lagrange's polynomial; without a state near the middle it is a straight line.
    """
    flat = torque.reshape(*torque.shape[:-3], -1, torque.shape[-1])
    lowest, highest = (end(flat, axis=-2, keepdims=True) for end in (jnp.argmin, jnp.argmax))
    a, c = (jnp.take_along_axis(flat, at, axis=-2) for at in (lowest, highest))
    middle = jnp.argmin(jnp.abs(flat - (a + c) / 2.0), axis=-2, keepdims=True)
    b = jnp.take_along_axis(flat, middle, axis=-2)
    span, beside = c - a, (b - a) * (c - b)
    wide, near = span > 0.0, beside > 0.1 * span**2
    of_middle = jnp.where(near, (load - a) * (c - load) / jnp.where(near, beside, 1.0), 0.0)
    rise = load - a - of_middle * (b - a)
    of_highest = jnp.where(wide, rise / jnp.where(wide, span, 1.0), 0.0)
    of_each = (1.0 - of_highest - of_middle, lowest), (of_middle, middle), (of_highest, highest)
    numbers = jnp.arange(flat.shape[-2])[:, None]
    parts = [part[..., None, :] * (numbers == at)[..., None, :, :] for part, at in of_each]
    return sum(parts[1:], parts[0]).reshape(*load.shape[:-1], *torque.shape[-3:])


@cache
def _places(count: int) -> np.ndarray:
    """Places of the few on [-1, 1]: both ends and between them; every second of five is one of three."""
    return -np.cos(np.pi * np.arange(count) / (count - 1))


def few_between(low: Each, high: Each, count: int = FEW) -> Float[Array, "*b few"]:
    """Few values from the lowest to the highest, both among them.

    Args:
        low: the lowest.
        high: the highest.
        count: of the few, at least two.

    From Chebyshev's points, both ends among them.
    """
    return ((low + high)[..., None] + (high - low)[..., None] * _places(count)) / 2.0


def among_few(values: Each, low: Each, high: Each, count: int = FEW) -> Float[Array, "few *b"]:
    """Weights of few values in a polynomial through them.

    Args:
        values: at which it is read.
        low: lowest of the few, see `few_between`.
        high: the highest.
        count: of the few.

    From Lagrange's polynomials through Chebyshev's points.
    """
    half = (high - low) / 2.0
    place = (values - (low + high) / 2.0) / jnp.where(half > 0.0, half, 1.0)
    powers = jnp.stack([place**power for power in range(count)])
    return jnp.tensordot(np.linalg.inv(np.vander(_places(count), increasing=True)).T, powers, 1)
