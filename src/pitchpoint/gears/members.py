"""Body of each coordinate by name, for every gear family; one that also approaches stands twice."""

from collections.abc import Sequence

from pitchpoint.errors import InputError

__all__ = ["BALL_ON_DISC", "CYLINDRICAL", "STRAIN_WAVE", "number_of"]

BALL_ON_DISC = ("disc", "ball", "ball")

CYLINDRICAL = ("gear 1", "gear 2")
STRAIN_WAVE = ("wave generator", "flexspline", "circular spline")


def number_of(member: str | int, names: tuple[str, ...]) -> int:
    """Number of a body, by itself or by name.

    Args:
        member: number or name.
        names: of the bodies of a family, in order.

    Raises:
        InputError: there is no such body.

    Example:
        >>> from pitchpoint.gears.members import CYLINDRICAL
        >>> number_of("gear 2", CYLINDRICAL)
        1
    """
    known: Sequence[str | int] = names if isinstance(member, str) else range(len(names))
    if member not in known:
        raise InputError(f"{member!r} is no member of this drive; use one of {', '.join(names)}")
    return known.index(member)
