"""How planets stand between their mates: phases of their meshes, and whether they fit in."""

from collections.abc import Sequence
from itertools import combinations
from math import floor, gcd, pi, sin
from typing import Any

import numpy as np
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jnp
from pitchpoint.core.programs import program
from pitchpoint.drive.kinematics import Link
from pitchpoint.errors import InputError
from pitchpoint.gears.pairs import planet_gears

__all__ = [
    "ROOM_BETWEEN_PLANETS",
    "check_neighbours",
    "clear_neighbours",
    "equal_angles",
    "fit_at_equal_angles",
    "nearest_places",
    "places_around",
    "planet_phases",
]

FITS = 1e-6
"""Part of a pitch by which a planet may miss a tooth space: that of rounding, not of play."""

ROOM_BETWEEN_PLANETS = 0.5
"""Least distance between tip circles of planets beside each other, of sets that are proposed [modules].

Our choice: the tip clearance of usual racks, .25 modules, for each of the two. It holds deviations of pins
and tips and lets oil through; a set that is given may have less, and is refused where planets touch.
"""

_USUAL_TIPS = 2.0
"""Tip diameter over that of the reference circle, addendum 1 and no profile shift [modules]."""

Body = tuple[str, int]
"""A body by name and number."""

Counts = Int[np.ndarray, "..."]
"""Numbers of teeth."""

Teeth = tuple[float, float]
"""Angle of the middle of a tooth against the carrier, and pitch with the sense of its turning [rad]."""


def equal_angles(count: int) -> Float[np.ndarray, " copy"]:
    """Angles of planets that stand all around, the first one at zero [rad]."""
    return 2.0 * pi * np.arange(count) / count


def places_around(meshes: Sequence[tuple[int, int]]) -> int:
    """Places around the carrier, in equal steps, at which a planet fits in; 0 where it fits anywhere.

    Args:
        meshes: teeth of the gear of the planets, and of its central mate, negative for a ring.

    Source: a planet that goes around by the part u of a turn, and turns so that it fits in one mesh, fits in
    another one if u (z_p2 z_1 - z_p1 z_2) is a multiple of the common divisor of z_p1 and z_p2.

    Example:
        >>> places_around([(30, 24), (30, -84)])  # sun and ring
        108
        >>> places_around([(36, 18), (36, -90), (34, -88)])  # a 3K set, which 4 planets do not fit
        54
    """
    steps = [
        abs(second * mate - first * other) // gcd(first, second)
        for (first, mate), (second, other) in combinations(meshes, 2)
    ]
    return gcd(*steps)


def fit_at_equal_angles(
    meshes: Sequence[tuple[Counts, Counts]], planets: int
) -> Bool[np.ndarray, "..."]:
    """True for numbers of teeth with which planets fit in at equal angles; the rule of `places_around`.

    Args:
        meshes: teeth of the gear of the planets, and of its central mate, negative for a ring; arrays of one
            shape, or that broadcast.
        planets: their number.

    From `places_around`, whose number the planets have to divide.

    Example:
        >>> import numpy as np
        >>> planet = np.array([30, 31])
        >>> fit_at_equal_angles([(planet, np.array(24)), (planet, -(24 + 2 * planet))], 4).tolist()
        [True, False]
    """
    fits = np.ones((), bool)
    for (first, mate), (second, other) in combinations(meshes, 2):
        step = planets * np.maximum(np.gcd(first, second), 1)
        fits = fits & ((second * mate - first * other) % step == 0)
    return fits


def clear_neighbours(
    meshes: Sequence[tuple[Counts | int, Counts | int]], planets: int
) -> Bool[np.ndarray, "..."]:
    """True for numbers of teeth with which planets at equal angles have room beside each other.

    Args:
        meshes: see `fit_at_equal_angles`, or plain numbers; without profile shift, addendum 1.
        planets: their number; one has no neighbour.

    From the distance of neighbours, 2 a sin(pi/N), against tip circle and `ROOM_BETWEEN_PLANETS`.

    Example:
        >>> [bool(clear_neighbours([(30, 24)], count)) for count in (1, 4, 5)]
        [True, True, False]
    """
    clear = np.ones((), bool)
    if planets == 1:
        return clear
    for planet, mate in meshes:
        apart = np.abs(planet + mate) * sin(pi / planets)
        clear = clear & (apart >= planet + _USUAL_TIPS + ROOM_BETWEEN_PLANETS)
    return np.asarray(clear)


def nearest_places(angles: Float[np.ndarray, " copy"], places: int) -> Float[np.ndarray, " copy"]:
    """Angles at which planets fit in beside the first one, nearest to others [rad].

    Args:
        angles: wanted ones [rad]; the first planet may stand anywhere, and stays where it is.
        places: see `places_around`; where it is 0 all angles do.

    Example:
        >>> import numpy as np
        >>> np.degrees(nearest_places(np.radians([10.0, 128.9, 251.1]), 109)).round(4)
        array([ 10.    , 128.8991, 251.1009])
    """
    if not places:
        return angles
    # Half a step goes up at every planet, so that opposite ones stay opposite where they can.
    steps = [floor(angle * places / (2.0 * pi) + 0.5 + FITS) for angle in angles - angles[0]]
    return np.asarray(angles[0] + np.array(steps) * (2.0 * pi / places))


def check_neighbours(
    links: Sequence[Link], planets: Sequence[str], angles: Float[np.ndarray, " copy"]
) -> None:
    """Raise InputError where planets that stand beside each other would touch.

    Args:
        links: see `planet_phases`.
        planets: bodies of which there are several.
        angles: at which they stand about the axis of their carrier [rad].

    From the distance of neighbours, 2 a sin(half the angle between them), against the tip circles.
    """
    if angles.size < 2:
        return
    around = np.sort(np.mod(angles, 2.0 * pi))
    closest = float(np.min(np.diff([*around, around[0] + 2.0 * pi])))
    for link in links:
        mesh = planet_gears(link.mesh)
        if mesh is None:
            continue
        number = next(k for k, body in enumerate(link.bodies) if body in planets)
        apart = 2.0 * float(mesh.centre_distance) * np.sin(closest / 2.0)
        tips = 2.0 * abs(float(np.asarray(_angles_and_tips(mesh)[1])[number]))
        if apart <= tips:
            raise InputError(
                f"the planets run into each other: {1e3 * apart:.5g} mm apart, and their tip circles measure "
                f"{1e3 * tips:.5g} mm"
            )


def planet_phases(
    links: Sequence[Link], planets: Sequence[str], angles: Float[np.ndarray, " copy"]
) -> list[Float[np.ndarray, " _"]]:
    """Phases of all meshes of planets, where the first planet enters its first mesh.

    Gears of a stepped planet have the middle of a tooth in one line.

    Args:
        links: pairs of involute gears, of which one is on a planet and the other one central; each has a body
            in common with those before it.
        planets: bodies of which there are several.
        angles: at which they stand about the axis of their carrier [rad].

    Returns:
        Phases of the copies of each mesh [periods].

    Raises:
        InputError: planets do not fit in at these angles; a mesh that is not of a planet and a central gear.

    From the positions of all teeth against the carrier: what one mesh tells of a body holds in the next.
    """
    settled: dict[Body, Teeth] = {}
    found = []
    for link in links:
        phases = [_fitted(link, planets, one, settled) for one in enumerate(angles.tolist())]
        found.append(np.array(phases) % 1.0)
    return found


def _fitted(
    link: Link, planets: Sequence[str], place: tuple[int, float], settled: dict[Body, Teeth]
) -> float:
    """Phase of the mesh of one planet, whose bodies stand as is settled; those that are not, are so by it."""
    copy, angle = place
    keys = [(body, copy if body in planets else 0) for body in link.bodies]
    every = dict(zip(keys, _teeth(link, planets, angle), strict=True))
    standing = [key for key in keys if key in settled]
    if settled and not standing:
        raise InputError(
            f"the mesh of {' and '.join(link.bodies)} has no body in common with those before it"
        )
    phase = missed = 0.0
    if standing:
        # A planet can be put in by any of its teeth; with a second gear of other teeth that counts.
        first = min(standing, key=lambda key: key[0] not in planets)
        (start, turn), (at, pitch) = every[first], settled[first]
        ways = round(2.0 * pi / abs(pitch)) if abs(abs(pitch) - abs(turn)) > FITS else 1
        phases = (at + np.arange(ways) * pitch - start) / turn
        apart = np.zeros(ways)
        for key in standing[1:] if first == standing[0] else standing[:1]:
            off = (every[key][0] + every[key][1] * phases - settled[key][0]) / settled[key][1]
            apart = np.abs(off - np.round(off))
        best = int(np.argmin(apart))
        phase, missed = float(phases[best]), float(apart[best])
        settled[first] = at + best * pitch, pitch
    if missed > FITS:
        (central,) = (body for body in link.bodies if body not in planets)
        raise InputError(
            f"the planets do not fit in at these angles: number {copy + 1} misses the teeth of the {central} "
            f"by {missed:.3g} of a pitch"
        )
    for key, (start, turn) in every.items():
        settled.setdefault(key, (start + turn * phase, turn))
    return phase


@program
def _angles_and_tips(mesh: Any) -> tuple[Float[Array, "2 2"], Float[Array, "2"]]:
    """Angles of teeth at the start and the end of a period [rad], and tip radii [m]; of involute teeth."""
    return mesh.tooth_angles(jnp.array([0.0, 1.0])), mesh.tip_radii


def _teeth(link: Link, planets: Sequence[str], angle: float) -> list[Teeth]:
    """Angle of a tooth of each body of a mesh at phase zero, and how far it turns in a period."""
    mesh = planet_gears(link.mesh)
    if mesh is None or sum(body in planets for body in link.bodies) != 1:
        raise InputError(
            f"the mesh of {' and '.join(link.bodies)} is not one of a planet and a central gear with "
            "involute teeth"
        )
    start, end = np.asarray(_angles_and_tips(mesh)[0]).T
    # A planet sees the pitch point towards the axis, unless its mate is a ring.
    seen = [angle + pi * (body in planets and not mesh.internal) for body in link.bodies]
    return [
        (float(at + view), float(to - at)) for at, to, view in zip(start, end, seen, strict=True)
    ]
