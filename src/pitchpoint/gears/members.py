"""Bodies by name or number, for every gear family."""

from collections.abc import Sequence

from pitchpoint.errors import InputError

__all__ = ["number_of"]


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
    known: Sequence[str | int] = names if isinstance(member, str) else range(len(names))
    if member not in known:
        raise InputError(f"{member!r} is no member of this drive; use one of {', '.join(names)}")
    return known.index(member)
