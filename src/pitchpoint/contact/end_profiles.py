"""Ends of rollers and faces by name: what is missing there along the normal."""

from math import inf, pi, tan

from pitchpoint._jax import array
from pitchpoint.contact.modifications import Crowning, EndRelief, LogRelief
from pitchpoint.contact.surface import Surface
from pitchpoint.errors import InputError

__all__ = [
    "chamfered",
    "crowned",
    "dub_off",
    "log_relieved",
    "straight",
]


def straight(*, width: float) -> tuple[Surface, ...]:
    """Nothing is missing: the pressure at the ends of half spaces has no bound.

    Args:
        width: of the face [m].
    """
    _positive(width=width)
    return ()


def crowned(*, width: float, radius: float) -> tuple[Surface, ...]:
    """An arc over the whole face: y^2/(2 r).

    Args:
        width: of the face [m].
        radius: r, of the crown along the face [m].

    Example: a crown of 10 m on a face of 20 mm.

        >>> import numpy as np
        >>> from pitchpoint.contact.gaps import missing_along
        >>> missing = missing_along(crowned(width=0.02, radius=10.0), np.array([0.0, 0.01]))
        >>> (missing * 1e6).round(6).tolist()
        [0.0, 5.0]

    From the parabola of the arc.
    """
    _positive(width=width, radius=radius)
    return (Crowning(array(width**2 / (8.0 * radius)), array(width)),)


def chamfered(*, width: float, length: float, angle: float) -> tuple[Surface, ...]:
    """A flat bevel at both ends: s tan(angle), s the distance from where it begins.

    Args:
        width: of the face [m].
        length: of each bevel along the face [m].
        angle: between bevel and face [rad].
    """
    _end(width, length)
    _positive(angle=angle)
    return (EndRelief(array(length * tan(angle)), array(length), array(width), 1),)


def dub_off(*, width: float, length: float, radius: float) -> tuple[Surface, ...]:
    """An arc at both ends, tangent to the face: s^2/(2 r), s the distance from where it begins.

    Args:
        width: of the face [m].
        length: of each arc along the face [m].
        radius: r, of the arc [m].

    From the parabola of the arc.
    """
    _end(width, length)
    _positive(radius=radius)
    return (EndRelief(array(length**2 / (2.0 * radius)), array(length), array(width), 2),)


def log_relieved(
    *, width: float, line_load: float, modulus: float, drop: float = inf
) -> tuple[Surface, ...]:
    """The logarithm that makes the pressure of a line contact even: A ln(1/(1 - (2 y/width)^2)).

    Args:
        width: of the face [m].
        line_load: normal load per length w for which the pressure is even [N/m].
        modulus: E' [Pa].
        drop: largest one, at the ends [m]; without a bound by itself.

    A = 2 w/(pi E'): then the gap follows the deflection of a half space by a line load that is even over the
    width. ISO/TS 16281 takes A = 0.00035 times the diameter for short rollers, which belongs to about 3 GPa
    of steel. Source: Lundberg (1939).

    Example: steel with 3 GPa on a diameter of 20 mm.

        >>> from math import pi
        >>> (relief,) = log_relieved(width=0.02, line_load=2 * pi * 3e9**2 * 0.01 / 226.4e9, modulus=226.4e9)
        >>> round(float(relief.amount) / 0.02, 5)
        0.00035
    """
    _positive(width=width, line_load=line_load, modulus=modulus, drop=drop)
    amount = 2.0 * line_load / (pi * modulus)
    return (LogRelief(array(amount), array(drop), array(width)),)


def _positive(**given: float) -> None:
    for key, value in given.items():
        if not value > 0.0:
            raise InputError(
                f"{key.replace('_', ' ')} of {value:.4g}: it must be positive", key=key
            )


def _end(width: float, length: float) -> None:
    _positive(width=width, length=length)
    if length > width / 2.0:
        raise InputError(
            f"ends of {length:.4g} m each do not fit on a face of {width:.4g} m", key="length"
        )
