"""What every gear family answers."""

import abc
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import inf
from typing import Any, ClassVar, Literal, Self, cast

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jnp
from pitchpoint.brief import brief
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.contact.surface import Spot, Surface, Surfaces, with_surfaces
from pitchpoint.contact.worn import new_and_worn, with_worn
from pitchpoint.factored import Arrays
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.gear_body import GearBody
from pitchpoint.gears.tooth_section import ToothSection

__all__ = ["PATHS", "Mesh", "Reference", "Way"]


Path = Literal["action", "wave", "turn"]


@dataclass(frozen=True)
class Way:
    """Words of the way of a pair through the mesh, which `Contacts.path` counts.

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


PATHS: Mapping[Path, Way] = {
    "action": Way(
        "position on the path of contact from A, in base pitches",
        "x/p_b",
        "place on the path from A [base pitches]",
        1.0,
        "base pitch",
        title="Along the path of contact",
        sliding="Flank of {} over flank of {}; zero at the pitch point C.",
    ),
    "wave": Way(
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
    ),
    "turn": Way("turns of the driver", "θ/2π", "angle of the driver [°]", 360.0, "period"),
}
"""The ways of pairs that families have."""


class Reference(eqx.Module):
    """Pitch-point values for laws that describe a whole mesh.

    Attributes:
        width: face width [m].
        line_length: length of a contact line across the whole face [m]: longer than the face on
            helical teeth.
        radius: relative radius of curvature at the pitch point [m].
        sum_speed: sum of the surface speeds there for a unit rate of the driver [m/rad or 1].
        pitch_line_speed: speed of the pitch circles for a unit rate of the driver [m/rad or 1].
    """

    width: Float[Array, ""]
    line_length: Float[Array, ""]
    radius: Float[Array, ""]
    sum_speed: Float[Array, ""]
    pitch_line_speed: Float[Array, ""]


class Mesh(eqx.Module):
    """A gear family: contacts that travel, and the coordinates of the bodies that carry them.

    One period of `phase` is one engagement: the state of the mesh repeats with it. Coordinates are
    rotations counter-clockwise [rad], or translations [m] where a family has them.

    Attributes:
        pitch_point: of the class; True if it has a `reference`.
        shape: of the class; that of all its contacts.
        toothed: of the class; True if `sections` holds teeth that yield.
        along_action: of the class; True if it has a `line_of_action`.
        counts: of the class; what `Contacts.path` counts, a key of `PATHS`.
        goes_round: of the class; True if every flank of a member takes its turn, see `flanks_in_turn`.
    """

    pitch_point: ClassVar[bool] = False
    shape: ClassVar[Shape] = "line"
    toothed: ClassVar[bool] = False
    along_action: ClassVar[bool] = False
    counts: ClassVar[Path] = "turn"
    goes_round: ClassVar[bool] = True

    def __repr__(self) -> str:
        return brief(self)

    @property
    def overlap_ratio(self) -> Float[Array, ""]:
        """Part of the contact ratio that contact lines inclined to the axes add."""
        return jnp.zeros(())

    @property
    def line_of_action(self) -> Float[Array, " dof"]:
        """Closing along the line of action for a unit rate of each coordinate [m/rad or 1].

        Transmission error is measured along it, by families that say so, see `along_action`.
        """
        raise self._without("line of action")

    @property
    def sections(self) -> tuple[ToothSection, ToothSection]:
        """Teeth of the two members as they yield, of families that say so, see `toothed`."""
        raise self._without("teeth that yield")

    @property
    def surfaces(self) -> Surfaces:
        """How all flanks of each member differ from those of `rigid_contacts`."""
        return (), ()

    @property
    def touching(self) -> bool:
        """True if all rigid flanks in mesh touch; else pairs have a gap, and load makes them carry."""
        return not any(self.surfaces)

    @property
    def onward(self) -> Float[Array, ""]:
        """Sense in which the phase runs while the drive turns on: one, or minus one."""
        return jnp.ones(())

    def in_pairs(self, values: np.ndarray, axis: int, *, like_first: bool = False) -> np.ndarray:
        """Values by pairs that the mesh holds, and the places at which each may touch.

        Empty places let meshes of several tooth numbers share their programs, and a family may give a pair
        a second one; the slices are then its places.

        Args:
            values: with places and slices on two neighbouring axes.
            axis: of the places.
            like_first: True if a place that a pair does not have gets the value of its first, else zero.
        """
        return values

    def of_pairs(self, places: Float[Arrays, "place *#b"]) -> Float[Array, "pair *#b"]:
        """Sums over the places at which each pair may touch: its only one, unless a family has more.

        Args:
            places: a value for each place.
        """
        return jnp.asarray(places)

    def on_edge(self, contacts: Contacts) -> Bool[Array, "pair slice *b"]:
        """True for contacts at an end of a flank or on the rounding of a tip, of families that watch for it.

        Args:
            contacts: of the mesh.
        """
        return jnp.zeros(contacts.active.shape, bool)

    @property
    def largest_radius(self) -> Float[Array, ""]:
        """Relative radius of curvature at which conformal contacts are cut [m]; infinite where none is."""
        return array(inf)

    @property
    def body(self) -> GearBody:
        """What lies under and behind the teeth."""
        return GearBody()

    @property
    def contact_room(self) -> Float[Array, ""]:
        """From elliptic contacts to the nearest end of a face [m]; infinite where no face ends."""
        return array(inf)

    def largest_inclination(self, semi_axis: Float[Array, "..."]) -> Float[Array, "..."]:
        """Inclination of the axes at which elliptic contacts reach an end of a face [rad]; infinite without.

        Args:
            semi_axis: of the contact across the rolling direction [m].
        """
        return jnp.full_like(semi_axis, inf)

    @property
    def other_flanks(self) -> Self:
        """The same mesh where its other flanks carry; gaps are counted from the same position."""
        return self

    @property
    @abc.abstractmethod
    def flanks_in_turn(self) -> Float[Array, "2"]:
        """Flanks of each member among which the engagements of one period go round.

        A flank takes part, in the mean, in one period over their number. Of families that say so, see
        `goes_round`.
        """

    def worn(self, wear: tuple[Surface, Surface]) -> Self:
        """The same drive with worn flanks.

        Args:
            wear: of both members, beside the surfaces that they have.
        """
        first, second = ((*own, one) for own, one in zip(self.surfaces, wear, strict=True))
        made: Any = self  # a field of every family, a property here
        return cast(Self, replace(made, surfaces=(first, second)))

    @abc.abstractmethod
    def spots(self, contacts: Contacts, phase: Float[Arrays, "..."]) -> tuple[Spot, Spot]:
        """Where contacts lie on both members.

        Args:
            contacts: of the mesh.
            phase: at which they were taken, counted on beyond one period [periods].
        """

    def inertia(self, density: Float[Array, "2"]) -> Float[Array, " dof"]:
        """Moments of inertia of plain bodies about their axes [kg m2], masses of those that travel [kg].

        Not a number where the gears say nothing of one.

        Args:
            density: of both members [kg/m3].
        """
        return jnp.full(len(self.coordinates), jnp.nan)

    @property
    @abc.abstractmethod
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The bodies and their axes, in the order of `motion`."""

    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts at any phase [periods], with the surfaces that the flanks have."""
        rigid = self.rigid_contacts(phase)
        if not any(self.surfaces):
            return rigid
        spots = self.spots(rigid, phase)
        made, worn = new_and_worn(self.surfaces)
        new = with_surfaces(rigid, made, spots)
        return with_worn(new, worn, spots)[0] if any(worn) else new

    @abc.abstractmethod
    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of rigid flanks as designed, at any phase [periods]."""

    @abc.abstractmethod
    def events(self) -> Float[Array, " event"]:
        """Sorted phases in [0, 1) at which a pair enters, leaves or passes pure rolling (static count)."""

    @property
    @abc.abstractmethod
    def contact_ratio(self) -> Float[Array, ""]:
        """Mean number of pairs in contact."""

    @property
    @abc.abstractmethod
    def relation(self) -> Float[Array, " dof"]:
        """Factors of the rates of the coordinates, whose sum is zero in every motion that flanks allow."""

    @property
    @abc.abstractmethod
    def motion(self) -> Float[Array, " dof"]:
        """Nominal rate of each coordinate for a unit rate of the driver."""

    @property
    @abc.abstractmethod
    def driver(self) -> Float[Array, " dof"]:
        """One for the coordinate that drives, zero elsewhere."""

    @property
    @abc.abstractmethod
    def loaded(self) -> Float[Array, " dof"]:
        """One for the coordinate whose load is prescribed, zero elsewhere."""

    @abc.abstractmethod
    def driven_by(self, member: str | int) -> Self:
        """The same drive with another member driving, in the sense that presses the same flanks.

        A fixed member stays fixed; the remaining one carries the load.

        Args:
            member: name of a body, or number of its coordinate.

        Raises:
            InputError: it cannot drive.
        """

    @property
    @abc.abstractmethod
    def period(self) -> Float[Array, ""]:
        """Motion of the driver in one period [rad or m]."""

    @property
    def reference(self) -> Reference:
        """Values at the pitch point, that laws for a whole mesh ask for, see `pitch_point`."""
        raise self._without("pitch point")

    def _without(self, what: str) -> TypeError:
        return TypeError(f"{type(self).__name__} has no {what}")
