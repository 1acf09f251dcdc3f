"""Standard tolerances of lengths by ISO 286-1, and the symmetrical fields js."""

from pitchpoint.errors import InputError

__all__ = ["FIELDS", "standard_tolerance", "symmetrical_deviation"]

_UP_TO = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
_IN_UM = {
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
}

FIELDS = tuple(f"js{grade}" for grade in _IN_UM)
"""Symmetrical tolerance fields that are known."""


def standard_tolerance(*, grade: int, size: float) -> float:
    """Standard tolerance IT of a length [m].

    Args:
        grade: 5 to 9.
        size: nominal, up to 500 mm [m].

    Raises:
        InputError: a longer one, or another grade.

    Source: ISO 286-1:2010, table 1. Its formula, 10, 16, 25 and 40 times i = 0.45 D^(1/3) + 0.001 D in um
    with the geometric mean D of a range in mm, gives these values before their rounding.

    Example:
        >>> round(1e6 * standard_tolerance(grade=7, size=0.1), 3)
        35.0
    """
    if grade not in _IN_UM:
        raise InputError(f"the grade IT{grade} is not known; known are IT5 to IT9")
    length = 1e3 * size * (1.0 - 1e-9)  # the end of a range belongs to it, whatever units leave
    tolerances = (um for most, um in zip(_UP_TO, _IN_UM[grade], strict=True) if length <= most)
    tolerance = next(tolerances, None)
    if tolerance is None:
        raise InputError(f"{1e3 * size:.6g} mm is longer than 500 mm, where its table ends here")
    return 1e-6 * tolerance


def symmetrical_deviation(field: str, size: float) -> float:
    """Deviation to either side by a field such as js7, half of its standard tolerance [m].

    Source: ISO 286-1:2010, fields js.
    """
    return standard_tolerance(grade=int(field.removeprefix("js")), size=size) / 2.0
