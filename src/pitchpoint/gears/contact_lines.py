"""Contact lines of involute flanks in the plane of action: how they lie on the face, cut into slices."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.errors import InputError

__all__ = ["LARGEST_CONTACT_RATIO", "SLICES", "contact_lines", "lanes_for"]

# Few values, so that few programs are compiled for many pairs.
_LANES_FOR_RATIO_BELOW = (2.0, 3.0, 4.0, 6.0, 9.0, 14.0, 24.0)

LARGEST_CONTACT_RATIO = _LANES_FOR_RATIO_BELOW[-1]
"""Contact ratio above which no lanes are held."""

SLICES = 12
"""Slices of each contact line of helical gears, an even number: midpoints, so errors fall with its square."""

# Share of the face width that a contact line has at least while it is in mesh: a length of zero has
# no load per length.
_SHORTEST = 1e-9


def contact_lines(
    entered: Float[Array, "pair 1 *b"],
    *,
    transverse_ratio: Float[Array, ""],
    overlap_ratio: Float[Array, ""] | None,
    pitch_path: Float[Array, ""],
    slices: int,
) -> tuple[Float[Array, "pair slice *b"], Float[Array, "pair slice *b"]]:
    """Middles of the slices of each contact line, and the share of the face that each slice takes.

    Both are parts of the face width, counted from the end that enters first. Half of the slices
    lie on each side of the pitch line, so that sliding changes its sense in no slice.

    Args:
        entered: base pitches since the pair entered.
        transverse_ratio: transverse contact ratio.
        overlap_ratio: None for straight teeth, whose lines take the whole face.
        pitch_path: position of the pitch point from A [base pitches].
        slices: of each line; even, or one.
    """
    if overlap_ratio is None:
        whole = jnp.zeros_like(entered)
        return _sliced(whole, whole + 1.0, slices)
    low = jnp.clip((entered - transverse_ratio) / overlap_ratio, 0.0, 1.0)
    high = jnp.clip(entered / overlap_ratio, 0.0, 1.0)
    if slices == 1:
        return (low + high) / 2.0, jnp.maximum(high - low, _SHORTEST)
    pitch_line = jnp.clip((entered - pitch_path) / overlap_ratio, low, high)
    parts = [_sliced(*ends, slices // 2) for ends in ((low, pitch_line), (pitch_line, high))]
    middles, shares = zip(*parts, strict=True)
    return jnp.concatenate(middles, axis=1), jnp.concatenate(shares, axis=1)


def _sliced(
    low: Float[Array, "pair 1 *b"], high: Float[Array, "pair 1 *b"], count: int
) -> tuple[Float[Array, "pair slice *b"], Float[Array, "pair slice *b"]]:
    """Middles and lengths of equal slices between two ends."""
    share = jnp.maximum(high - low, _SHORTEST) / count
    middle = (jnp.arange(count) + 0.5).reshape(-1, *([1] * (low.ndim - 2)))
    return low + middle * share, jnp.broadcast_to(share, (low.shape[0], count, *low.shape[2:]))


def lanes_for(contact_ratio: float, *, helical: bool = False) -> int:
    """Static count of pairs to hold for a contact ratio: few values, so that few programs are compiled."""
    for limit in _LANES_FOR_RATIO_BELOW:
        if contact_ratio < limit:
            return max(int(limit), 3) if helical else int(limit)
    message = f"contact ratio {contact_ratio:.3g} is out of reach of cylindrical gears"
    raise InputError(message, value=contact_ratio)
