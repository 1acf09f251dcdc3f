"""Torques on the bodies of a gear train whose meshes lose a known part of their power."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import inf, nan

import numpy as np
from jaxtyping import Float

from pitchpoint.drive.kinematics import HOUSING, Ends, Link, body_rates
from pitchpoint.errors import InputError

__all__ = ["TrainTorques", "train_torques"]

SINGULAR = 1e12
"""Condition number from which on the torques of a train hang on rounding: it is about to lock."""

Row = dict[str, float]


@dataclass(frozen=True)
class TrainTorques:
    """Rates and external torques of the bodies of a train in uniform motion.

    Attributes:
        rates: counter-clockwise, from the housing [rad/s or m/s].
        torques: that act from outside on each body, housing and carriers among them [N m or N]; they sum to
            zero, and are zero on bodies that are free; not numbers where friction locks the train.
        shares: of these in each mesh.
        losses: power lost in each mesh [W].
        driving: for each mesh the body that drives the other one, seen from the carrier of their axes; empty
            where the train is locked.
        loaded: body that takes the power.

    Source: Müller (1982), see `train_torques`.
    """

    rates: Mapping[str, float]
    torques: Mapping[str, float]
    shares: tuple[Row, ...]
    losses: tuple[float, ...]
    driving: tuple[str, ...]
    loaded: str

    @property
    def locked(self) -> bool:
        """True where friction holds the train, whatever turns it."""
        return not self.driving

    @property
    def output_power(self) -> float:
        """Power that the loaded body gives away [W]."""
        return -self.torques[self.loaded] * self.rates[self.loaded]

    @property
    def efficiency(self) -> float:
        """Power at the loaded body over the same with all losses; not a number where the train is locked.

        With one body that is turned that is power out over power in. From the balance of power: what is lost
        in the meshes comes in and does not go out.
        """
        power_out = self.output_power
        return power_out / (power_out + sum(self.losses)) if power_out else nan


def train_torques(
    links: Sequence[Link], ends: Ends, load: float, efficiencies: Sequence[float]
) -> TrainTorques:
    """Torques on all bodies of a train, each mesh with an efficiency of its own.

    Which body of a mesh drives follows from the torques, and they from that: every choice is tried, and
    holds if all meshes are driven as was assumed. None holds where friction locks the train.

    Args:
        links: meshes of the drive.
        ends: who is turned, held and loaded; one body must be loaded.
        load: torque or force that the loaded body carries against its motion, not negative [N m or N].
        efficiencies: of each mesh, seen from the carrier of its axes, above 0 and at most 1.

    Raises:
        InputError: see `body_rates`; numbers out of range, a train without a loaded body.

    Example:
        >>> from pitchpoint.drive.kinematics import Ends, Link
        >>> from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
        >>> given = {"module": 1e-3, "pressure_angle": 0.349, "face_width": 1e-2}
        >>> sun = build_cylindrical_pair(teeth=(24, 30), **given)
        >>> ring = build_cylindrical_pair(teeth=(30, -84), **given)
        >>> links = [
        ...     Link(sun, ("sun", "planet"), "carrier"),
        ...     Link(ring, ("planet", "ring"), "carrier"),
        ... ]
        >>> ends = Ends({"sun": 100.0}, held=("ring",), loaded="carrier")
        >>> found = train_torques(links, ends, load=45.0, efficiencies=(0.99, 0.995))
        >>> round(found.efficiency, 7), round(found.torques["sun"], 4)
        (0.9883722, 10.1176)

    From the equilibrium of every body: Müller, Epicyclic Drive Trains (1982), with unknown forces in the
    meshes in place of his formulas for sets with one carrier.
    """
    _check(links, ends, load, efficiencies)
    rates = body_rates(links, ends)
    unknown = [body for body in rates if body not in {HOUSING, *ends.held, *ends.turned}]
    if len(links) != len(unknown):
        raise InputError(
            f"{len(links)} meshes settle the motion of {len(unknown)} bodies that are free; one of them "
            "repeats what the others do, and nothing says how they share the load"
        )
    against = -float(np.sign(rates[ends.loaded])) * load
    carried = np.array([against if body == ends.loaded else 0.0 for body in unknown])
    relations = [link.relation for link in links]
    for choice in product((0, 1), repeat=len(links)):
        driving = [link.bodies[number] for link, number in zip(links, choice, strict=True)]
        rows = [_row(*each) for each in zip(links, relations, driving, efficiencies, strict=True)]
        forces = _forces(np.array([[row.get(b, 0.0) for row in rows] for b in unknown]), carried)
        if forces is None:
            continue
        powers = [
            force * row[body] * (rates[body] - rates[link.carrier])
            for force, row, body, link in zip(forces, rows, driving, links, strict=True)
        ]
        if min(powers) >= 0.0:
            shares = [
                {body: force * arm for body, arm in row.items()}
                for force, row in zip(forces, rows, strict=True)
            ]
            torques = {body: sum(share.get(body, 0.0) for share in shares) for body in rates}
            losses = [(1.0 - e) * power for e, power in zip(efficiencies, powers, strict=True)]
            return TrainTorques(
                rates, torques, tuple(shares), tuple(losses), tuple(driving), ends.loaded
            )
    nothing = dict.fromkeys(rates, nan)
    each = (nothing,) * len(links)
    return TrainTorques(rates, nothing, each, (nan,) * len(links), (), ends.loaded)


def _check(links: Sequence[Link], ends: Ends, load: float, efficiencies: Sequence[float]) -> None:
    if not ends.loaded:
        raise InputError("no body takes the power; name the loaded one")
    if len(efficiencies) != len(links):
        raise InputError(f"{len(efficiencies)} efficiencies were given for {len(links)} meshes")
    for efficiency in efficiencies:
        if not 0.0 < efficiency <= 1.0:
            raise InputError(
                f"the efficiency of a mesh is {efficiency:g}; it must be above 0 and at most 1"
            )
    if not 0.0 <= load < inf:
        raise InputError(f"the load is {load:g}; it must be a number that is not negative")
    for link in links:
        if len(link.bodies) != 2:
            raise InputError(
                f"the mesh of {', '.join(link.bodies)} has {len(link.bodies)} bodies; one efficiency "
                "tells the torques of two"
            )


def _row(link: Link, relation: Row, driving: str, efficiency: float) -> Row:
    """Torques on the bodies of a mesh for a unit force in it; its carrier bears what is left of their sum."""
    row = {body: relation[body] * (1.0 if body == driving else efficiency) for body in link.bodies}
    return {**row, link.carrier: row.get(link.carrier, 0.0) - sum(row.values())}


def _forces(
    arms: Float[np.ndarray, "body mesh"], carried: Float[np.ndarray, " body"]
) -> list[float] | None:
    """Forces that hold all bodies in equilibrium; None where no force does."""
    sizes = np.max(np.abs(arms), axis=0)
    if np.linalg.cond(arms / sizes) > SINGULAR:
        return None
    found: list[float] = (np.linalg.solve(arms / sizes, carried) / sizes).tolist()
    return found
