"""How the bodies of a drive move: meshes as relations between their rates, and who is turned or held."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Float

from pitchpoint._jax import jax
from pitchpoint.core.brief import brief
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh, coordinates_of

__all__ = ["HOUSING", "Ends", "Link", "body_rates"]

HOUSING = "housing"
"""The body that stands still."""

NO_RATE = 1e-10
"""Rate over the largest of the drive below which a body stands still: elimination leaves some 1e-15, while
a real train steps its speed down by less than a million."""


class Link(eqx.Module):
    """A mesh between bodies of a drive; equal copies of it, as of planets, are one.

    Attributes:
        mesh: any gear family.
        bodies: of the drive, one for each coordinate of the mesh; static.
        carrier: body on which the axes of the mesh sit, as that of planets; its rate counts from the
            housing, those of the mesh count from it; static.
        planet_gear: which gear of the planets it is that meshes, of those that they have; static.
    """

    mesh: Mesh
    bodies: tuple[str, ...] = eqx.field(static=True)
    carrier: str = eqx.field(static=True, default=HOUSING)
    planet_gear: int = eqx.field(static=True, default=1)

    def __repr__(self) -> str:
        return brief(self)

    def __check_init__(self) -> None:
        coordinates = coordinates_of(self.mesh)
        names = [coordinate.body for coordinate in coordinates]
        if len(self.bodies) != len(names):
            raise InputError(
                f"this mesh moves {len(names)} bodies ({', '.join(names)}), and {len(self.bodies)} of the "
                f"drive were named: {', '.join(self.bodies)}"
            )
        moving = [body for body in (*self.bodies, self.carrier) if body != HOUSING]
        twice = sorted({body for body in moving if moving.count(body) > 1})
        if twice:
            raise InputError(
                f"{twice[0]} meshes with itself or carries its own axis; each gear of a mesh is a body of "
                "its own, and so is the carrier of their axes"
            )
        if self.carrier != HOUSING and not all(one.turns for one in coordinates):
            raise InputError(
                f"a rack travels in the housing, and the {self.carrier} would carry it round"
            )

    @property
    def gears(self) -> tuple[tuple[str, float, int], ...]:
        """Both gears of a cylindrical pair: body, teeth, and which gear of the planets meshes."""
        pair: Any = self.mesh
        first, second = zip(self.bodies, np.abs(pair.teeth).tolist(), strict=True)
        return (*first, self.planet_gear), (*second, self.planet_gear)

    @property
    def relation(self) -> dict[str, float]:
        """Factors of the rates of bodies, whose sum is zero in every motion.

        Turning all bodies of a mesh with their carrier neither closes flanks nor slides them, so the factor
        of a carrier is minus the sum of the others.
        """
        mesh = jax.device_get(self.mesh)
        factors = np.asarray(mesh.relation, float).tolist()
        row = {self.carrier: -sum(factors)}
        for body, factor in zip(self.bodies, factors, strict=True):
            row[body] = row.get(body, 0.0) + factor
        return row


@dataclass(frozen=True)
class Ends:
    """What is done to the bodies of a drive from outside.

    Attributes:
        turned: rates of the bodies that are turned, by name [rad/s or m/s].
        held: bodies that do not move, beside the housing.
        loaded: body that takes the power; empty where none is named.
    """

    turned: Mapping[str, float]
    held: Sequence[str] = ()
    loaded: str = ""


def body_rates(links: Sequence[Link], ends: Ends) -> dict[str, float]:
    """Rate of every body of a drive, counter-clockwise about its axis, seen from the housing.

    Args:
        links: meshes of the drive, in any order.
        ends: who is turned, held and loaded.

    Returns:
        Rates by name [rad/s or m/s], in the unit of those given.

    Raises:
        InputError: a body that is not there; a train that cannot move, whose motion is not settled, or in
            which nothing of it comes to the loaded body.

    From Willis' relation of each mesh, solved together: Müller, Epicyclic Drive Trains (1982).
    """
    bodies = _bodies(links)
    _check_ends(ends, bodies)
    fixed = {HOUSING: 0.0, **dict.fromkeys(ends.held, 0.0), **ends.turned}
    matrix = _matrix(links, bodies)
    free = [number for number, body in enumerate(bodies) if body not in fixed]
    given = np.array([fixed.get(body, 0.0) for body in bodies])
    rates = given.copy()
    left, right = matrix[:, free], -matrix @ given
    if free:
        solved, _, rank, _ = np.linalg.lstsq(left, right, rcond=NO_RATE)
        # A second pass takes off what the first one leaves by rounding.
        rates[free] = solved + np.linalg.lstsq(left, right - left @ solved, rcond=NO_RATE)[0]
        if rank < len(free):
            raise InputError(_unsettled(left, [bodies[number] for number in free], fixed))
    largest = np.max(np.abs(rates))
    if np.max(np.abs(matrix @ rates), initial=0.0) > NO_RATE * largest:
        raise InputError(
            f"this train cannot move: its meshes allow no motion with {_words(ends)}; hold or turn one "
            "body less"
        )
    found = dict(zip(bodies, rates.tolist(), strict=True))
    if ends.loaded and abs(found[ends.loaded]) <= NO_RATE * largest:
        raise InputError(
            f"nothing comes from {', '.join(ends.turned)} to {ends.loaded}, which stands still with "
            f"{_words(ends)}"
        )
    return found


def _bodies(links: Sequence[Link]) -> list[str]:
    """Names of all bodies, in the order in which meshes name them; the housing last."""
    named = [body for link in links for body in (*link.bodies, link.carrier)]
    return [*(body for body in dict.fromkeys(named) if body != HOUSING), HOUSING]


def _check_ends(ends: Ends, bodies: Sequence[str]) -> None:
    for body in (*ends.turned, *ends.held, *filter(None, [ends.loaded])):
        if body not in bodies:
            raise InputError(
                f"no mesh of the drive has the body {body}, nor axes that it carries; there are "
                f"{', '.join(bodies)}"
            )
    still = {HOUSING, *ends.held}
    for body in ends.turned:
        if body in still:
            raise InputError(f"{body} cannot be turned and held at once")
    if ends.loaded in still:
        raise InputError(f"{ends.loaded} is held and takes no power")
    if ends.loaded in ends.turned:
        raise InputError(
            f"{ends.loaded} is turned, and would take its own power; name another output"
        )


def _matrix(links: Sequence[Link], bodies: Sequence[str]) -> Float[np.ndarray, "link body"]:
    """Factors of all relations, each with one as its largest."""
    rows = [[link.relation.get(body, 0.0) for body in bodies] for link in links]
    return np.array([[factor / max(map(abs, row)) for factor in row] for row in rows])


def _unsettled(
    left: Float[np.ndarray, "link free"], free: Sequence[str], fixed: Mapping[str, float]
) -> str:
    """Why a motion is not settled: bodies that can still move, and what would settle it."""
    _, sizes, directions = np.linalg.svd(left)
    rank = int(np.sum(sizes > NO_RATE * np.max(sizes, initial=1.0)))
    loose = np.max(np.abs(directions[rank:]), axis=0) > NO_RATE
    names = [body for body, moves in zip(free, loose, strict=True) if moves]
    ways = len(free) - rank
    which = "one of them" if ways == 1 else f"{ways} of them"
    known = ", ".join(body for body in fixed if body != HOUSING)
    return f"the motion is not settled by {known}: {', '.join(names)} can still move; hold or turn {which}"


def _words(ends: Ends) -> str:
    turned = f"{', '.join(ends.turned)} turned" if ends.turned else "nothing turned"
    return f"{turned} and {', '.join(ends.held)} held" if ends.held else turned
