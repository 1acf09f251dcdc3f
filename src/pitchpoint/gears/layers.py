"""Layers of a picture of teeth: bodies with a tooth that repeats, lines and marks that stay, contacts."""

from collections.abc import Mapping, Sequence
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["LAYERS", "LEVELS", "DrawnBody", "layers"]

LEVELS = ("tip", "working", "base", "root", "rim")
"""Circles of a body that turns, and lines of one that travels; the body itself lies between root and rim."""

LAYERS: Mapping[str, tuple[str, ...]] = {
    "layer_tooth": ("body", "corner", "xy"),
    "layer_place": ("body", "xy"),
    "layer_turned": ("body",),
    "layer_level": ("body", "level"),
    "layer_count": ("body",),
    "layer_pitch": ("body",),
    "layer_travel": ("body", "xy"),
    "layer_line": ("line", "end", "xy"),
    "layer_mark": ("mark", "xy"),
    "contact_start": ("xy",),
    "contact_step": ("xy",),
}
"""Dimensions of the arrays of `layers`."""


class DrawnBody(eqx.Module):
    """A body with one of its teeth, which repeats along it, in a frame of its own.

    The axis of that tooth is y. The origin is the centre of a body that turns, and a point of the
    pitch line of one that travels. Views move it by the nominal motion of the coordinate of its name.

    Attributes:
        tooth: outline from root to root, the same number of corners for all bodies [m].
        place: of the origin in the picture at phase zero [m].
        turned: rotation of the frame there, counter-clockwise [rad].
        levels: distances from the origin at which `LEVELS` lie [m]; not a number for one that it does not
            have. A rim beyond the root is that of a ring.
        count: number of teeth.
        pitch: from tooth to tooth: angle [rad], or distance of a body that travels [m].
        travel: direction of a body that travels, for a positive rate; zero for one that turns.
    """

    tooth: Float[Array, "corner 2"]
    place: Float[Array, "2"]
    turned: Float[Array, ""]
    levels: Float[Array, "5"]
    count: Float[Array, ""]
    pitch: Float[Array, ""]
    travel: Float[Array, "2"]


def layers(
    bodies: Sequence[DrawnBody],
    *,
    lines: Float[Array, "line end 2"],
    marks: Float[Array, "mark 2"],
    start: Float[Array, "2"],
    step: Float[Array, "2"],
) -> dict[str, Float[Array, "..."]]:
    """Arrays of a picture by name, with the dimensions of `LAYERS`.

    Names of bodies, lines and marks are the labels along `body`, `line` and `mark` that the family gives.

    Args:
        bodies: in the order of those labels.
        lines: that stay: the line of action and the path of contact.
        marks: points with a letter; not a number where one is not there.
        start: place of the contact of a pair as it enters, at phase zero [m].
        step: its way in one period [m].
    """

    def stacked(name: str) -> Any:
        return jnp.stack([getattr(body, name) for body in bodies])

    return {
        "layer_tooth": stacked("tooth"),
        "layer_place": stacked("place"),
        "layer_turned": stacked("turned"),
        "layer_level": stacked("levels"),
        "layer_count": stacked("count"),
        "layer_pitch": stacked("pitch"),
        "layer_travel": stacked("travel"),
        "layer_line": lines,
        "layer_mark": marks,
        "contact_start": start,
        "contact_step": step,
    }
