"""Pairs on their way through a mesh: words of it, places where they touch, flanks that take turns, room.

Gears with a way of their own, second places, ends that are watched or flanks that take turns register it.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import singledispatch
from math import inf
from typing import Any

import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Spot
from pitchpoint.core.factored import Arrays

__all__ = [
    "ACTION",
    "TURN",
    "WAVE",
    "Way",
    "flanks_in_turn",
    "in_pairs",
    "largest_inclination",
    "largest_radius",
    "of_pairs",
    "on_edge",
    "planet_gears",
    "since_entry",
    "spots_on_turning",
    "touching",
    "way_of_pairs",
]


@dataclass(frozen=True)
class Way:
    """Words of the way of a pair through the mesh, which `Contacts.path` counts, see `way_of_pairs`.

    Attributes:
        long_name, symbol: of a place on it.
        axis: title of an axis of it.
        scale: of one in the unit of that axis.
        pitch: what a period of the phase is.
        against: why time runs against the phase, where it does; {} is the driver.
        title: of figures along it; empty where there is no way to show.
        told: what stands above them.
        origin: what lies at zero, where it has a name.
        sliding: whose speed over whose the sliding is; {} are the two members that touch.
        zones: number of zones of mesh that are alike, in which pairs stand one zone after the other.
    """

    long_name: str
    symbol: str
    axis: str
    scale: float
    pitch: str
    against: str = "{} drives"
    title: str = ""
    told: str = ""
    origin: str = ""
    sliding: str = "Flank of {} over flank of {}."
    zones: int = 1

    def attributes(self, members: Sequence[str]) -> dict[str, str | float]:
        """What a figure along it needs, for the places in a dataset.

        Args:
            members: names of the two that touch.
        """
        sliding = self.sliding.format(*members)
        return {**asdict(self), "sliding": sliding[:1].upper() + sliding[1:]}


ACTION = Way(
    "position on the path of contact from A, in base pitches",
    "x/p_b",
    "place on the path from A [base pitches]",
    1.0,
    "base pitch",
    title="Along the path of contact",
    sliding="Flank of {} over flank of {}; zero at the pitch point C.",
)
WAVE = Way(
    "angle from the long axis, in turns",
    "p/2π",
    "angle from the long axis p [°]",
    360.0,
    "tooth pitch",
    "teeth come from positive angles",
    title="Along the wave",
    told="One tooth on its way through the zone of mesh, over its angle from the end of the long axis "
    "that is nearest; the dotted line is the long axis. Values stand where the tooth carries, at one "
    "end of that axis.",
    origin="the long axis",
    sliding="{} over {}; teeth slide most far from the long axis.",
    zones=2,
)
TURN = Way("turns of the driver", "θ/2π", "angle of the driver [°]", 360.0, "period")


@singledispatch
def way_of_pairs(mesh: Any) -> Way:
    """Words of the way of pairs through a mesh, turns of the driver unless its gears say other ones."""
    return TURN


@singledispatch
def touching(mesh: Any) -> bool:
    """True if all rigid flanks in mesh touch; else pairs have a gap, and load makes them carry."""
    return not any(mesh.surfaces)


@singledispatch
def in_pairs(mesh: Any, values: np.ndarray, axis: int, *, like_first: bool = False) -> np.ndarray:
    """Values by pairs that a mesh holds, and the places at which each may touch.

    Empty places let meshes of several tooth numbers share their programs, and a family may give a pair
    a second one; the slices are then its places.

    Args:
        mesh: any family.
        values: with places and slices on two neighbouring axes.
        axis: of the places.
        like_first: True if a place that a pair does not have gets the value of its first, else zero.
    """
    return values


@singledispatch
def of_pairs(mesh: Any, places: Float[Arrays, "place *#b"]) -> Float[Array, "pair *#b"]:
    """Sums over the places at which each pair may touch: its only one, unless a family has more.

    Args:
        mesh: any family.
        places: a value for each place.
    """
    return jnp.asarray(places)


@singledispatch
def on_edge(mesh: Any, contacts: Contacts) -> Bool[Array, "pair slice *b"]:
    """True for contacts at an end of a flank or on the rounding of a tip, of families that watch for it.

    Args:
        mesh: any family.
        contacts: of the mesh.
    """
    return jnp.zeros(contacts.active.shape, bool)


@singledispatch
def largest_radius(mesh: Any) -> Float[Array, ""]:
    """Relative radius of curvature at which conformal contacts are cut [m]; infinite where none is."""
    return array(inf)


@singledispatch
def largest_inclination(mesh: Any, semi_axis: Float[Array, "..."]) -> Float[Array, "..."]:
    """Inclination of the axes at which elliptic contacts reach an end of a face [rad]; infinite without.

    Args:
        mesh: any family.
        semi_axis: of the contact across the rolling direction [m].
    """
    return jnp.full_like(semi_axis, inf)


@singledispatch
def flanks_in_turn(mesh: Any) -> Float[Array, "2"]:
    """Flanks of each member among which the engagements of one period go round.

    A flank takes part, in the mean, in one period over their number.

    Raises:
        TypeError: they do not go round, see `has`.
    """
    raise TypeError(f"engagements of {type(mesh).__name__} do not go round")


def since_entry(phase: Float[Arrays, "*b"], lanes: int) -> Float[Array, "pair 1 *b"]:
    """Periods since each pair entered, in the order in which pairs came; the first one enters at phase 0.

    Args:
        phase: of the mesh [periods].
        lanes: pairs that it holds.
    """
    number = jnp.arange(float(lanes)).reshape(-1, *([1] * (jnp.ndim(phase) + 1)))
    return jnp.asarray(jnp.mod(phase, 1.0) + number)


def spots_on_turning(
    contacts: Contacts,
    phase: Float[Arrays, "..."],
    teeth: Float[Arrays, "2"],
    senses: Sequence[Float[Arrays, ""] | float],
) -> tuple[Spot, Spot]:
    """Where contacts lie on members that both turn on by a tooth in a period; teeth follow each other.

    Args:
        contacts, phase: see `Mesh.spots`; the first pair enters at phase 0.
        teeth: of each member, positive.
        senses: against which each turns.
    """
    lanes = jnp.broadcast_shapes(contacts.path.shape, (1, 1, *jnp.shape(phase)))
    number = since_entry(jnp.zeros_like(phase), contacts.path.shape[0])
    entered = jnp.broadcast_to(jnp.floor(phase) - number, lanes)
    flank_spot, mate_spot = (
        Spot(
            flank=jnp.broadcast_to(contacts.flank[member], lanes),
            across=jnp.broadcast_to(contacts.width, lanes),
            angle=jnp.broadcast_to(sense * phase * 2.0 * jnp.pi / teeth[member], lanes),
            # A tooth that enters later lies behind those before it.
            tooth=jnp.mod(sense * entered, teeth[member]).astype(int),
            leaning=jnp.ones(lanes),
        )
        for member, sense in enumerate(senses)
    )
    return flank_spot, mate_spot


@singledispatch
def planet_gears(mesh: Any) -> Any:
    """Gears of a mesh of which either can be on a planet; None where they cannot.

    Args:
        mesh: any family.

    Returns:
        Their `teeth`, `module` [m], `helix_angle` [rad], `centre_distance` [m], `tip_radii` [m], whether they
        are `internal`, and `tooth_angles(phase)` [rad], see `InvolutePair`.

    Example:
        >>> from pitchpoint.gears.pairs import planet_gears
        >>> planet_gears("no gears") is None
        True
    """
    return None
