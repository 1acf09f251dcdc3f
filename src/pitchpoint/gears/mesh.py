"""What every gear family answers."""

import abc
from math import inf
from typing import ClassVar, Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.gears.flexible_ring import FlexibleRing, RingLoads
from pitchpoint.gears.tooth_section import ToothSection

__all__ = ["Mesh", "Reference", "StandardPair"]


class Reference(eqx.Module):
    """Pitch-point values for laws that describe a whole mesh.

    Attributes:
        width: face width [m].
        line_length: length of a contact line across the whole face [m]: longer than the face on
            helical teeth.
        radius: relative radius of curvature at the pitch point [m].
        sum_speed: sum of the surface speeds there per radian of the driver [m/rad].
        pitch_line_speed: speed of the pitch circles per radian of the driver [m/rad].
    """

    width: Float[Array, ""]
    line_length: Float[Array, ""]
    radius: Float[Array, ""]
    sum_speed: Float[Array, ""]
    pitch_line_speed: Float[Array, ""]


class StandardPair(eqx.Module):
    """What the standards for cylindrical gears ask about a pair.

    Attributes:
        virtual_teeth: z_n of the normal sections, in magnitude.
        profile_shift: coefficients.
        dedendum: of the basic racks, in normal modules.
        pressure_angle: normal one of the basic racks [rad].
        helix_angle: [rad].
        transverse_contact_ratio: eps_alpha.
        face_width: [m].
        reference_arm: radius on which the load of the driven coordinate acts at the reference circle [m].
        internal: True if one is a ring; static.
    """

    virtual_teeth: Float[Array, "2"]
    profile_shift: Float[Array, "2"]
    dedendum: Float[Array, "2"]
    pressure_angle: Float[Array, ""]
    helix_angle: Float[Array, ""]
    transverse_contact_ratio: Float[Array, ""]
    face_width: Float[Array, ""]
    reference_arm: Float[Array, ""]
    internal: bool = eqx.field(static=True)


class Mesh(eqx.Module):
    """A gear family: contacts that travel, and the coordinates of the bodies that carry them.

    One period of `phase` is one engagement: the state of the mesh repeats with it. Coordinates are
    rotations counter-clockwise [rad], or translations [m] where a family has them.

    Attributes:
        pitch_point: of the class; True if `reference` is not None.
    """

    pitch_point: ClassVar[bool] = False

    def completed(self) -> Self:
        """The same mesh with dimensions that follow from others computed from them again.

        Derivatives with respect to one dimension then see what follows from it.
        """
        return self

    @property
    def overlap_ratio(self) -> Float[Array, ""]:
        """Part of the contact ratio that contact lines inclined to the axes add."""
        return jnp.zeros(())

    @property
    def line_of_action(self) -> Float[Array, " dof"] | None:
        """Closing along the line of action for a unit rate of each coordinate [m/rad].

        Transmission error is measured along it. None where there is no such line.
        """
        return None

    @property
    def toothed(self) -> bool:
        """True if the members have teeth that yield: `sections` holds them."""
        return False

    @property
    def sections(self) -> tuple[ToothSection, ToothSection] | None:
        """Teeth of the two members as they yield, or None where there are no teeth."""
        return None

    @property
    def clearances(self) -> bool:
        """True if rigid teeth do not all touch: pairs have a gap, and `path` is an angle [turns].

        The angle is counted from the long axis of a wave generator. Such pairs come to carry only
        as others yield.
        """
        return False

    @property
    def filled(self) -> np.ndarray | None:
        """Numbers of the places for pairs that hold one, or None where all do.

        Empty places let meshes of several tooth numbers share their programs.
        """
        return None

    @property
    def largest_radius(self) -> Float[Array, ""]:
        """Relative radius of curvature at which conformal contacts are cut [m]; infinite where none is."""
        return jnp.asarray(inf)

    @property
    def ring(self) -> FlexibleRing | None:
        """Thin ring that carries the teeth of member 0, or None where bodies are solid."""
        return None

    def ring_loads(self, contacts: Contacts) -> RingLoads | None:
        """How a unit normal force at each contact acts on the ring, or None without one."""
        return None

    def places(
        self, contacts: Contacts, phase: Float[Array, "*b"]
    ) -> Float[Array, "member pair slice *b"] | None:
        """Angles around each member at which its teeth touch [rad]; None where nothing asks for them.

        Args:
            contacts: of the mesh.
            phase: at which they were taken, counted on beyond one period [periods].
        """
        return None

    def support(self, contacts: Contacts) -> Float[Array, "bearing pair slice *b"] | None:
        """Radial load on each bearing of the mesh for a unit normal force at each contact, or None.

        Rows are not negative; losses beside the teeth name the row of the bearing that they stand for.
        """
        return None

    @property
    def standard(self) -> StandardPair | None:
        """What standards ask about a pair of cylindrical gears, or None: they then do not apply."""
        return None

    def inertia(self, density: Float[Array, "2"]) -> Float[Array, " dof"] | None:
        """Moment of inertia of plain bodies about their axes [kg m2], or None where that says nothing.

        Args:
            density: of both members [kg/m3].
        """
        return None

    def dimensions(self) -> dict[str, Float[Array, "..."]]:
        """Main dimensions by name, one value or one for each member; for results and tables."""
        return {}

    def drawing(self) -> dict[str, Float[Array, "..."]]:
        """What a drawing of the teeth to scale needs; empty where there is none."""
        return {}

    @abc.abstractmethod
    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts at any phase [periods]."""

    @abc.abstractmethod
    def events(self) -> Float[Array, " event"]:
        """Sorted phases in [0, 1) at which a pair enters, leaves or passes pure rolling (static count)."""

    @property
    @abc.abstractmethod
    def contact_ratio(self) -> Float[Array, ""]:
        """Mean number of pairs in contact."""

    @property
    @abc.abstractmethod
    def motion(self) -> Float[Array, " dof"]:
        """Nominal rate of each coordinate per radian of the driver."""

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
        """Driver angle of one period [rad]."""

    @property
    @abc.abstractmethod
    def reference(self) -> Reference | None:
        """Pitch-point values, or None: laws for a whole mesh then do not apply."""
