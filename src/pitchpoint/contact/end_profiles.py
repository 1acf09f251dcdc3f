"""Ends of rollers and faces by name: what is missing there along the normal."""

from collections.abc import Callable
from dataclasses import dataclass
from inspect import signature
from math import inf, pi, tan

from pitchpoint._jax import array
from pitchpoint.contact.modifications import Crowning, EndRelief, LogRelief
from pitchpoint.contact.surface import Surface
from pitchpoint.errors import InputError
from pitchpoint.registry import Registry

__all__ = [
    "END_PROFILES",
    "EndProfile",
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
        >>> found = missing_along(crowned(width=0.02, radius=10.0), np.array([0.0, 0.01]))
        >>> (found * 1e6).round(6).tolist()
        [0.0, 5.0]
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
        >>> (found,) = log_relieved(width=0.02, line_load=2 * pi * 3e9**2 * 0.01 / 226.4e9, modulus=226.4e9)
        >>> round(float(found.amount) / 0.02, 5)
        0.00035
    """
    _positive(width=width, line_load=line_load, modulus=modulus, drop=drop)
    amount = 2.0 * line_load / (pi * modulus)
    return (LogRelief(array(amount), array(drop), array(width)),)


@dataclass(frozen=True, eq=False)
class EndProfile:
    """A named shape of the ends of a contact line.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: surfaces from the width of the face and its own numbers.
        sources: keys of the bibliography.
    """

    name: str
    title: str
    function: Callable[..., tuple[Surface, ...]]
    sources: tuple[str, ...] = ()

    @property
    def parameters(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of its own numbers that have to be given, and of all that may be."""
        own = [
            one
            for one in signature(self.function).parameters.values()
            if one.name not in ("width", "modulus")
        ]
        needed = tuple(one.name for one in own if one.default is one.empty)
        return needed, tuple(one.name for one in own)

    def surfaces(self, *, width: float, modulus: float, **given: float) -> tuple[Surface, ...]:
        """Surfaces of a face.

        Args:
            width: of the face [m].
            modulus: E' of both bodies [Pa], for profiles that follow from a load.
            given: its own numbers [SI].

        Raises:
            InputError: ends that do not fit on the face, with the key of the number.
        """
        elastic = {"modulus": modulus} if "modulus" in signature(self.function).parameters else {}
        return self.function(width=width, **elastic, **given)


END_PROFILES = Registry(
    "end profile",
    EndProfile("straight", "no relief", straight),
    EndProfile("crowned", "an arc over the whole face", crowned),
    EndProfile("chamfered", "a flat bevel at both ends", chamfered),
    EndProfile("dub_off", "an arc at both ends, tangent to the face", dub_off),
    EndProfile(
        "log_relieved", "a logarithm for an even pressure", log_relieved, ("lundberg_1939",)
    ),
)
"""What contact lines may end with."""


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
