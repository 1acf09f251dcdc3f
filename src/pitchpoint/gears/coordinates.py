"""Coordinates of a drive: the ways in which its bodies move, in the frame of the mesh; bodies by name."""

from collections.abc import Sequence

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.errors import InputError

__all__ = ["AXIAL", "Coordinate", "number_of"]

AXIAL = (0.0, 0.0, 1.0)
"""Direction of the axes of gears on parallel axes: rotations are counter-clockwise about it."""


class Coordinate(eqx.Module):
    """One body that turns about an axis, or travels along one.

    Attributes:
        body: name; static.
        place: point of the axis in the middle of the face [m].
        axis: unit vector; rotations are counter-clockwise about it.
        member: whose flanks the body carries, 0 or 1; None if it carries none; static.
        turns: False for a translation along the axis; static.
        rigid: False for a body that is bent as it turns: its flanks do not move like those of a rigid
            one; static.
    """

    body: str = eqx.field(static=True)
    place: Float[Array, "3"]
    axis: Float[Array, "3"]
    member: int | None = eqx.field(static=True)
    turns: bool = eqx.field(static=True, default=True)
    rigid: bool = eqx.field(static=True, default=True)

    def velocity(self, point: Float[Array, "3 *#b"]) -> Float[Array, "3 *#b"]:
        """Velocity of a point of the body for a unit rate of the coordinate [m/rad or 1].

        Args:
            point: in the frame of the mesh [m].
        """
        axis, place = (v.reshape(3, *(1 for _ in point.shape[1:])) for v in (self.axis, self.place))
        if not self.turns:
            return jnp.broadcast_to(axis, point.shape)
        return jnp.cross(axis, point - place, axis=0)


def number_of(member: str | int, names: tuple[str, ...]) -> int:
    """Number of a body, by itself or by name.

    Args:
        member: number or name.
        names: of the bodies of a family, in order.

    Raises:
        InputError: there is no such body.

    Example:
        >>> number_of("gear 2", ("gear 1", "gear 2"))
        1
    """
    choices: Sequence[str | int] = names if isinstance(member, str) else range(len(names))
    if member not in choices:
        raise InputError(f"{member!r} is no member of this drive; use one of {', '.join(names)}")
    return choices.index(member)
