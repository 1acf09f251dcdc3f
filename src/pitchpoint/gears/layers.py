"""Layers of a picture of teeth: bodies with a tooth that repeats, lines and marks that stay, contacts."""

from collections.abc import Mapping, Sequence
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.roots import hypot
from pitchpoint.gears.involute import InvoluteGear

__all__ = ["LAYERS", "LEVELS", "RIM", "DrawnBody", "DrawnPath", "drawn_gear", "labels", "layers"]

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
    "rolling": ("body", "power"),
}
"""Dimensions of the arrays of `layers`, and of the rolling speeds of both flanks along the line of action.

Those are polynomials of the position on it, by rising powers and up to a common factor.
"""


def labels(members: Sequence[str], ends: Sequence[str]) -> dict[str, list[Any]]:
    """Labels along the dimensions of a drawing with a path of contact.

    Args:
        members: bodies, in the order of the layers.
        ends: names of the marks behind A to E, see `DrawnPath.ends`.
    """
    return {
        "gear": [1, 2],
        "xy": ["x", "y"],
        "point": [*"ABCDE"],
        "body": [*members],
        "level": [*LEVELS],
        "line": ["action", "path"],
        "mark": [*"ABCDE", *ends],
    }


RIM = 0.8
"""Thickness of the rim of a ring or rack as drawn, whose outside is not known, over its tooth height."""


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


def drawn_gear(
    gear: InvoluteGear,
    *,
    place: Float[Array, "2"],
    contact: Float[Array, "2"],
    side: Float[Array, ""],
    earlier: Float[Array, ""],
    working_radius: Float[Array, ""],
) -> DrawnBody:
    """An involute gear, one tooth of which goes through a contact.

    Args:
        gear: its dimensions.
        place: of its centre [m].
        contact: on the flank of that tooth [m].
        side: on which its axis lies of the contact: 1 if clockwise, -1 if counter-clockwise.
        earlier: rotation in which it gets there from where it is at phase zero [rad].
        working_radius: of the pitch circle in operation [m].
    """
    x, y = contact - place
    half = gear.side * gear.half_thickness_angle(hypot(x, y))
    tip, root = jnp.abs(gear.tip_radius), jnp.abs(gear.root_radius)
    rim = root + RIM * jnp.abs(root - tip) if gear.internal else jnp.zeros(())
    count = jnp.abs(gear.teeth)
    return DrawnBody(
        tooth=gear.outline(),
        place=place,
        turned=jnp.arctan2(-x, y) - side * half - earlier,
        levels=jnp.stack([tip, jnp.abs(working_radius), jnp.abs(gear.base_radius), root, rim]),
        count=count,
        pitch=2.0 * jnp.pi / count,
        travel=jnp.zeros(2),
    )


class DrawnPath(eqx.Module):
    """A straight path of contact in the picture.

    Attributes:
        origin: place from which positions on the line of action are counted [m].
        along: direction of growing positions.
        limits: positions of its ends A and E [m].
        points: positions of A to E [m].
        ends: positions at which the line touches base circles [m].
        base_pitch: way of a contact in one period [m].
        behind: periods from the entry of a pair until it touches in the section drawn.
    """

    origin: Float[Array, "2"]
    along: Float[Array, "2"]
    limits: Float[Array, "2"]
    points: Float[Array, "5"]
    ends: Float[Array, " end"]
    base_pitch: Float[Array, ""]
    behind: Float[Array, ""]

    def at(self, position: Float[Array, ""]) -> Float[Array, "2"]:
        """Place of a position [m]."""
        return self.origin + position * self.along


def layers(bodies: Sequence[DrawnBody], path: DrawnPath) -> dict[str, Float[Array, "..."]]:
    """Arrays of a picture by name, with the dimensions of `LAYERS`.

    Names of bodies and marks are the labels along `body` and `mark` that the family gives; lines are the
    line of action and the path of contact. Points that lie beyond the path are not numbers.

    Args:
        bodies: in the order of those labels.
        path: of contact.
    """
    both = jnp.concatenate([path.ends, path.limits])
    action = jnp.stack([path.at(jnp.min(both)), path.at(jnp.max(both))])
    start, end = path.limits
    edge = 1e-9 * path.base_pitch
    inside = (path.points >= start - edge) & (path.points <= end + edge)
    points = jnp.where(inside, path.points, jnp.nan)

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
        "layer_line": jnp.stack([action, jnp.stack([path.at(start), path.at(end)])]),
        "layer_mark": jnp.stack([path.at(place) for place in (*points, *path.ends)]),
        "contact_start": path.at(start - path.behind * path.base_pitch),
        "contact_step": path.base_pitch * path.along,
    }
