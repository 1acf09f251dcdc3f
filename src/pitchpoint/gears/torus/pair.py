"""Torus-involute pair: a convex and a concave gear that touch in points, and these contacts."""

import dataclasses
from typing import ClassVar, Self

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair
from pitchpoint.gears.mesh_bodies import main_dimensions, plain_inertia
from pitchpoint.gears.pairs import largest_inclination, since_entry
from pitchpoint.gears.tooth_section import ToothSection, tooth_sections
from pitchpoint.gears.torus.face import TorusFace, nearest_across_face

__all__ = ["TorusPair"]


class TorusPair(InvolutePair):
    """Two gears whose flanks touch in points, since their profile shifts vary across the face.

    Every transverse section is that of a spur pair, see `InvolutePair`; dimensions are those of the section
    in which the flanks touch. Without misalignment that is the middle of the face. Teeth bend over their
    whole face, each over its own width.

    Attributes:
        torus_radii: of the arcs of both pitch surfaces, see `TorusFace.radius` [m].
        widths: of both faces [m]; the narrower one counts as `face_width`.
        middle_shift: profile shift coefficients in the middle planes.
        axial_offset: of the middle plane of gear 2 from that of gear 1, along z [m].
        inclination: of the axes across the line of centres, counted along the line of action: angle by which
            the flanks that touch part towards positive z, and the other flanks close [rad]. Arms and
            forces take both axes as that of gear 1: the axial load of gear 2 is along it, and along its own
            axis differs by the inclination times the normal force.

    Source: Liu and Xiong (`liu_xiong_2017`), section 2.
    """

    shape: ClassVar[Shape] = "ellipse"
    chosen: ClassVar[tuple[str, ...]] = (
        *(name for name in InvolutePair.chosen if name != "profile_shift"),
        "torus_radii",
        "middle_shift",
        "axial_offset",
        "inclination",
    )

    torus_radii: Float[Array, "2"] = eqx.field(kw_only=True)
    widths: Float[Array, "2"] = eqx.field(kw_only=True)
    middle_shift: Float[Array, "2"] = eqx.field(kw_only=True)
    axial_offset: Float[Array, ""] = eqx.field(kw_only=True)
    inclination: Float[Array, ""] = eqx.field(kw_only=True)

    def completed(self) -> Self:
        """The pair with what follows in the middle of the face, and its shifts where the flanks touch."""
        middle = dataclasses.replace(self, profile_shift=self.middle_shift)
        completed_middle = super(TorusPair, middle).completed()
        return dataclasses.replace(completed_middle, profile_shift=completed_middle.contact_shift)

    @property
    def faces(self) -> tuple[TorusFace, TorusFace]:
        """Faces of both gears, one convex and one concave."""
        pinion_face, wheel_face = (
            TorusFace(radius, self.pressure_angle) for radius in self.torus_radii
        )
        return pinion_face, wheel_face

    @property
    def contact_shift(self) -> Float[Array, "2"]:
        """Profile shift coefficients in the transverse section in which the flanks touch."""
        place = self.place
        contact_places = jnp.stack([place, place - self.axial_offset])
        added_shift = jnp.stack(
            [face.shift(at) for face, at in zip(self.faces, contact_places, strict=True)]
        )
        return self.middle_shift + added_shift / self.module

    @property
    def place(self) -> Float[Array, ""]:
        """Where across the face the flanks touch, from the middle plane of gear 1 [m]."""
        return self._least(self.inclination)[0]

    @property
    def misalignment_approach(self) -> Float[Array, ""]:
        """How far the flanks come towards each other by misalignment, along the line of action [m]."""
        return -self._least(self.inclination)[1]

    @property
    def contact_room(self) -> Float[Array, ""]:
        """From the contact to the nearest end of a face [m]; negative where it has left one."""
        ends = self.widths / 2.0
        contact_places = jnp.abs(jnp.stack([self.place, self.place - self.axial_offset]))
        return jnp.min(ends - contact_places)

    @property
    def transverse_radius(self) -> Float[Array, ""]:
        """Relative radius of curvature across the profile R_y [m].

        Source: sum of the curvatures of both flanks; 1/R_y = sin(alpha) (1/R_1 - 1/R_2) in the middle.
        """
        return 1.0 / jnp.sum(self._bends)

    @property
    def backlash(self) -> Float[Array, ""]:
        """Circumferential backlash on the pitch circles [m]: that in the middle less what misalignment takes.

        Both flanks come nearer to each other by misalignment, each where it touches; below zero both press.
        """
        middle = dataclasses.replace(self, profile_shift=self.middle_shift).section_backlash
        apart = self._least(self.inclination)[1] + self._least(-self.inclination)[1]
        return middle + apart / jnp.cos(self.working_pressure_angle)

    @property
    def other_flanks(self) -> Self:
        """The same gears on their other flanks, which lean the other way and lie back by the backlash."""
        opposite = dataclasses.replace(super().other_flanks, inclination=-self.inclination)
        return opposite.completed()

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """The one contact of each pair in mesh; phase 0 is the entry of a pair at A [base pitches]."""
        entered = since_entry(phase, self.lanes)
        return self.contacts_at(
            entered,
            active=entered <= self.line.contact_ratio,
            width=self.place,
            weight=jnp.ones(()),
            tilt=jnp.arctan(self.faces[0].slope(self.place)),
            across=self._bends,
        )

    @property
    def _bends(self) -> Float[Array, "2"]:
        """Curvature of both flanks across the profile where they touch [1/m]."""
        contact_places = (self.place, self.place - self.axial_offset)
        return jnp.stack(
            [face.curvature(at) for face, at in zip(self.faces, contact_places, strict=True)]
        )

    def _least(self, inclination: Float[Array, ""]) -> tuple[Float[Array, ""], Float[Array, ""]]:
        return nearest_across_face(
            *self.faces, axial_offset=self.axial_offset, inclination=inclination
        )


@main_dimensions.register
def _main_dimensions(pair: TorusPair) -> dict[str, Float[Array, "..."]]:
    """Those of a spur pair in the section of the contacts, and where these lie."""
    return {
        **main_dimensions.dispatch(InvolutePair)(pair),
        "transverse_radius": pair.transverse_radius,
        "contact_place": pair.place,
        "contact_room": pair.contact_room,
        "misalignment_approach": pair.misalignment_approach,
    }


@largest_inclination.register
def _largest_inclination(pair: TorusPair, semi_axis: Float[Array, "..."]) -> Float[Array, "..."]:
    """Inclination up to which, in either sense, a contact reaches no end of a face [rad]; zero if none.

    Args:
        semi_axis: of the contact across the rolling direction [m].

    From the place at which flanks touch, where their slopes across the face and the inclination cancel.
    """
    low = jnp.maximum(-pair.widths[0] / 2.0, pair.axial_offset - pair.widths[1] / 2.0)
    high = jnp.minimum(pair.widths[0] / 2.0, pair.axial_offset + pair.widths[1] / 2.0)
    ends = jnp.stack([low + semi_axis, high - semi_axis])
    leaning = pair.faces[0].slope(ends) + pair.faces[1].slope(ends - pair.axial_offset)
    return jnp.maximum(jnp.minimum(-leaning[0], leaning[1]), 0.0)


@tooth_sections.register
def _tooth_sections(pair: TorusPair) -> tuple[ToothSection, ToothSection]:
    """Teeth of both gears, each with the face over which it bends."""
    pinion, wheel = tooth_sections.dispatch(InvolutePair)(pair)
    return (
        dataclasses.replace(pinion, width=pair.widths[0]),
        dataclasses.replace(wheel, width=pair.widths[1]),
    )


@plain_inertia.register
def _plain_inertia(pair: TorusPair, density: Float[Array, "2"]) -> Float[Array, "2"]:
    """Moments of inertia of discs as wide as the face of each gear [kg m2]."""
    return plain_inertia.dispatch(InvolutePair)(pair, density) * pair.widths / pair.face_width
