"""Rack and pinion: an involute gear on straight flanks that travel."""

import dataclasses
from functools import cached_property

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Spot, Surfaces
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.core.roots import hypot
from pitchpoint.gears.contact_lines import (
    InvoluteMesh,
    PathOfContact,
    PitchPoint,
    line_of_action,
    pitch_point,
)
from pitchpoint.gears.coordinates import AXIAL, Coordinate
from pitchpoint.gears.involute import InvoluteGear
from pitchpoint.gears.layers import RIM, DrawnBody, DrawnPath, drawn_gear, layers
from pitchpoint.gears.mesh_bodies import drawing, main_dimensions, plain_inertia
from pitchpoint.gears.pairs import since_entry, spots_on_turning
from pitchpoint.gears.rack_and_pinion import MEMBERS
from pitchpoint.gears.rack_and_pinion.rack import Rack
from pitchpoint.gears.tooth_section import ToothSection, tooth_sections

__all__ = ["RackAndPinion"]


class RackLineOfAction(PathOfContact):
    """Lengths on the line of action of rack and pinion.

    Source: the line of action of ISO 21771:2007 as one of the gears becomes endlessly large.
    """

    mesh: "RackAndPinion"

    @property
    def pinion(self) -> InvoluteGear:
        """That of the mesh."""
        return self.mesh.pinion

    @cached_property
    def angle(self) -> Float[Array, ""]:
        """Transverse pressure angle of rack and pinion [rad]: it is that in operation, at any distance."""
        return self.pinion.transverse_pressure_angle

    @cached_property
    def base_radius(self) -> Float[Array, ""]:
        """Base radius of the pinion [m]."""
        return self.pinion.base_radius

    @cached_property
    def slope(self) -> Float[Array, ""]:
        """Cosine of the helix angle on the base cylinder."""
        return jnp.cos(self.pinion.base_helix_angle)

    @cached_property
    def limits(self) -> Float[Array, "2"]:
        """Positions of A and E from N1 [m]: A where the rack or an undercut ends, E on the pinion's tip."""
        pinion, mesh = self.pinion, self.mesh
        start = self.at_depth(mesh.distance - mesh.rack.tip)
        if pinion.undercut:
            start = jnp.maximum(start, pinion.form_roll_length)
        return jnp.stack([start, pinion.tip_roll_length])

    def at_depth(self, across: Float[Array, ""]) -> Float[Array, ""]:
        """Position from N1 of the point that lies so far from the pinion's axis, towards the rack [m]."""
        return (across - self.base_radius * jnp.cos(self.angle)) / jnp.sin(self.angle)

    @cached_property
    def pitch_position(self) -> Float[Array, ""]:
        """Position of the pitch point C from N1 [m]."""
        return self.base_radius * jnp.tan(self.angle)


class RackAndPinion(InvoluteMesh):
    """A pinion on a fixed axis and a rack that travels at right angles to it.

    Coordinates: rotation of the pinion, travel of the rack. Lengths along the line of action are
    transverse and counted from N1, where it touches the base circle of the pinion; A is the end of the
    path of contact near N1, where the rack has its tips, E the other end. The pitch circle is the reference
    circle at any distance of the rack.

    Attributes:
        pinion: the gear.
        rack: the straight flanks.
        face_width: common to both [m].
        distance: from the pinion's axis to the reference line of the rack [m].
        rim_ratio: root radius over bore radius of the pinion.
        moved_mass: of the rack and what it carries [kg]; NaN where it is not known.
        helical: False if the helix angle is zero; static.
        lanes: static count of pairs held, at least the contact ratio rounded up.
        slices: static count of slices of each contact line; even, or one.
        surfaces: how all flanks of both members differ from their design.
    """

    pinion: InvoluteGear
    rack: Rack
    face_width: Float[Array, ""]
    distance: Float[Array, ""]
    rim_ratio: Float[Array, ""]
    moved_mass: Float[Array, ""]
    right_flank: Bool[Array, ""]
    helical: bool = eqx.field(static=True)
    lanes: int = eqx.field(static=True)
    slices: int = eqx.field(static=True)
    surfaces: Surfaces = ((), ())

    @property
    def line(self) -> RackLineOfAction:
        """Lengths on the line of action, for one question."""
        return RackLineOfAction(self)

    @property
    def zero_backlash_distance(self) -> Float[Array, ""]:
        """Distance of the reference line at which the flanks touch on both sides, r + x m [m]."""
        return self.pinion.reference_radius + self.pinion.profile_shift * self.pinion.module

    @property
    def backlash(self) -> Float[Array, ""]:
        """Play of the rack along its travel j_wt = 2 (a - a_0) tan(alpha_t) [m]."""
        return 2.0 * (self.distance - self.zero_backlash_distance) * jnp.tan(self.line.angle)

    @property
    def normal_backlash(self) -> Float[Array, ""]:
        """Backlash along the normal of the flanks j_bn = j_wt cos(alpha_t) cos(beta_b) [m]."""
        return self.backlash * jnp.cos(self.line.angle) * self.line.slope

    @property
    def relation(self) -> Float[Array, "2"]:
        """The rack travels as far as the reference circle of the pinion turns."""
        return self._side * jnp.stack([self.pinion.reference_radius, -jnp.ones(())])

    @property
    def pitch(self) -> Float[Numbers, ""]:
        """Angle of the pinion over one pitch [rad]."""
        return 2.0 * jnp.pi / self.pinion.teeth

    @property
    def passing(self) -> Float[Array, "2"]:
        """Pairs run from A to E as the pinion turns on."""
        return self._side * jnp.array([1.0, 0.0])

    @property
    def coordinates(self) -> tuple[Coordinate, Coordinate]:
        """Pinion about z at the origin, x towards the rack; the rack along y on its reference line."""
        rack = jnp.zeros(3).at[0].set(self.distance)
        travel = jnp.array([0.0, 1.0, 0.0])
        return (
            Coordinate(MEMBERS[0], jnp.zeros(3), jnp.asarray(AXIAL), 0),
            Coordinate(MEMBERS[1], rack, travel, 1, turns=False),
        )

    def events(self) -> Float[Array, " event"]:
        """Phases of entry, exit and pitch point; of helical teeth also where lines grow and shrink."""
        bounds = self.line.bounds(helical=self.helical)
        return jnp.sort(jnp.mod(jnp.stack(bounds), 1.0))

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of all pairs in mesh; phase 0 is the entry of a pair at A [base pitches]."""
        line = self.line
        entered = since_entry(phase, self.lanes)
        across, share = line.lines(entered, helical=self.helical, slices=self.slices)
        lanes = jnp.shape(across)
        path = jnp.broadcast_to(entered - line.overlap_ratio * across * self.helical, lanes)
        active = jnp.broadcast_to(entered <= line.contact_ratio, lanes)
        position = jnp.where(active, line.limits[0] + path * line.base_pitch, line.pitch_position)
        width = jnp.broadcast_to(self.face_width * (across - 0.5), lanes)
        return Contacts(
            active=active,
            path=path,
            width=width,
            weight=jnp.broadcast_to(self.face_width * share / line.slope, lanes),
            gap=jnp.zeros(lanes),
            **self._at(line, position, width),
            shape="line",
        )

    def _at(
        self, line: RackLineOfAction, position: Float[Array, "pair slice *b"], width: Array
    ) -> dict[str, Array]:
        """Curvature, motion and place at positions on the line of action [m from N1]."""
        side, none = self._side, jnp.zeros_like(position)
        cosine, sine = jnp.cos(line.angle), jnp.sin(line.angle)
        start = line.base_radius * jnp.stack([cosine, -side * sine])
        along = jnp.stack([sine, side * cosine])
        point = jnp.stack([*(start[k] + position * along[k] for k in (0, 1)), width])

        def everywhere(*parts: Array) -> Array:
            return jnp.stack([none + part for part in parts])

        return {
            "curvature": everywhere(line.slope / position, none, none, none).reshape(
                2, 2, *none.shape
            ),
            "surface": everywhere(side * position, none, none, none + side * sine).reshape(
                2, 2, *none.shape
            ),
            "normal": everywhere(*(line_of_action(self) * line.slope)),
            "flank": jnp.stack(
                [
                    position**2 / (2.0 * line.base_radius),
                    self.rack.arc(self.distance - point[0], line.angle),
                ]
            ),
            "point": point,
            "direction": everywhere(*(line.slope * along), jnp.sin(self.pinion.base_helix_angle)),
            "tangent": everywhere(-cosine, side * sine, jnp.zeros(())),
        }

    def spots(self, contacts: Contacts, phase: Float[Arrays, "..."]) -> tuple[Spot, Spot]:
        """The line of action stands still; the pinion turns on against it, the rack travels past it."""
        teeth = jnp.stack([self.pinion.teeth] * 2)
        pinion_spot, rack_spot = spots_on_turning(contacts, phase, teeth, [-self._side] * 2)
        # A rack has no end here, and no angle: whatever repeats on it counts in turns of the pinion.
        number = since_entry(jnp.zeros_like(phase), self.lanes)
        passed = jnp.broadcast_to(self._side * (number - jnp.floor(phase)), rack_spot.tooth.shape)
        return pinion_spot, dataclasses.replace(rack_spot, tooth=passed.astype(int))

    def _layers(self, line: RackLineOfAction) -> dict[str, Float[Array, "..."]]:
        """The transverse section at the middle of the face, the rack above the pinion."""
        side, base = self._side, line.base_radius
        sine, cosine = jnp.sin(line.angle), jnp.cos(line.angle)
        path = DrawnPath(
            origin=base * jnp.stack([side * sine, cosine]),
            along=jnp.stack([-side * cosine, sine]),
            limits=line.limits,
            points=line.points,
            ends=jnp.zeros(1),
            base_pitch=line.base_pitch,
            behind=line.overlap_ratio / 2.0,
        )
        contact = path.at(line.limits[0])
        pinion = drawn_gear(
            self.pinion,
            place=jnp.zeros(2),
            contact=contact,
            side=side,
            earlier=side * 2.0 * jnp.pi / self.pinion.teeth * path.behind,
            working_radius=self.pinion.reference_radius,
        )
        none = jnp.zeros(())
        rolling = [[none, none + 1.0], [self.pinion.reference_radius * sine, none]]
        drawn = [pinion, self._drawn_rack(contact, path.behind)]
        return layers(drawn, path) | {"rolling": jnp.array(rolling)}

    def _drawn_rack(self, contact: Float[Array, "2"], behind: Float[Array, ""]) -> DrawnBody:
        """The rack, one tooth of which goes through a contact, its teeth downwards.

        Args:
            contact: on the flank of that tooth [m].
            behind: periods in which it gets there from where it is at phase zero.
        """
        rack, side, slope = self.rack, self._side, jnp.cos(self.pinion.helix_angle)
        pitch = jnp.pi * rack.module / slope
        half = rack.half_thickness(self.distance - contact[1]) / slope
        working, none = self.distance - self.pinion.reference_radius, jnp.asarray(jnp.nan)
        rim = rack.root - RIM * (rack.tip - rack.root)
        return DrawnBody(
            tooth=rack.outline(slope),
            place=jnp.stack([contact[0] - side * (half - pitch * behind), self.distance]),
            turned=jnp.asarray(jnp.pi),
            levels=jnp.stack([rack.tip, working, none, rack.root, rim]),
            count=self.pinion.teeth,
            pitch=pitch,
            travel=jnp.array([-1.0, 0.0]),
        )


@main_dimensions.register
def _main_dimensions(mesh: RackAndPinion) -> dict[str, Float[Array, "..."]]:
    """Contact ratios, distance and backlash, and of the pinion tip and undercut limit."""
    line, pinion = mesh.line, mesh.pinion
    return {
        "module": pinion.module,
        "transverse_contact_ratio": line.transverse_contact_ratio,
        "overlap_ratio": line.overlap_ratio,
        "mounting_distance": mesh.distance,
        "circumferential_backlash": mesh.backlash,
        "normal_backlash": mesh.normal_backlash,
        "tip_thickness_1": pinion.tip_thickness,
        "undercut_limit_1": pinion.undercut_limit,
    }


@drawing.register
def _drawing(mesh: RackAndPinion) -> dict[str, Float[Array, "..."]]:
    """Layers of the picture, circles of the pinion alone, points of the path [m]."""
    line, pinion = mesh.line, mesh.pinion
    radii = {
        "base_radius": pinion.base_radius,
        "tip_radius": pinion.tip_radius,
        "root_radius": pinion.root_radius,
        "reference_radius": pinion.reference_radius,
        "form_radius": hypot(pinion.base_radius, pinion.form_roll_length),
        "active_root_radius": hypot(pinion.base_radius, line.limits[0]),
    }
    tooth_values = {"tip_thickness": pinion.tip_thickness, "undercut_limit": pinion.undercut_limit}
    alone = {"teeth": pinion.teeth, **radii, **tooth_values}
    none = jnp.asarray(jnp.nan)
    named = main_dimensions(mesh)
    return {
        **mesh._layers(line),
        "points": line.points,
        **{name: jnp.stack([value, none]) for name, value in alone.items()},
        "working_pressure_angle": line.angle,
        "base_pitch": line.base_pitch,
        "base_helix_angle": pinion.base_helix_angle,
        "face_width": mesh.face_width,
        "contact_ratio": line.contact_ratio,
        **{name: value for name, value in named.items() if not name.endswith("_1")},
    }


@line_of_action.register
def _line_of_action(mesh: RackAndPinion) -> Float[Array, "2"]:
    """Base radius of the pinion and cos(alpha_t) of the rack, with the sense in which they close."""
    line = mesh.line
    return mesh._side * jnp.stack([line.base_radius, -jnp.cos(line.angle)])


@pitch_point.register
def _pitch_point(mesh: RackAndPinion, driver: Float[Arrays, "2"]) -> PitchPoint:
    """Values at the pitch point C, where the rack is straight."""
    line = mesh.line
    speed = driver @ jnp.stack([mesh.pinion.reference_radius, jnp.ones(())])
    return PitchPoint(
        width=mesh.face_width,
        line_length=mesh.face_width / line.slope,
        radius=line.pitch_position / line.slope,
        sum_speed=2.0 * speed * jnp.sin(line.angle),
        pitch_line_speed=speed,
    )


@tooth_sections.register
def _tooth_sections(mesh: RackAndPinion) -> tuple[ToothSection, ToothSection]:
    """Teeth of pinion and rack in the normal section."""
    return mesh.pinion.section(mesh.rim_ratio), mesh.rack.section(mesh.line.angle)


@plain_inertia.register
def _plain_inertia(mesh: RackAndPinion, density: Float[Array, "2"]) -> Float[Array, "2"]:
    """Moment of inertia of the pinion as a disc [kg m2], and the mass that the rack moves [kg]."""
    root = mesh.pinion.root_radius
    outer, bore = mesh.pinion.reference_radius, root / mesh.rim_ratio
    disc = jnp.pi / 2.0 * density[0] * mesh.face_width * (outer**4 - bore**4)
    return jnp.stack([disc, mesh.moved_mass])
