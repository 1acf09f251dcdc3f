"""What all pairs of involute gears on parallel axes have in common, wherever on the face they touch."""

import dataclasses
from functools import cached_property
from typing import ClassVar, Final, Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.modifications import Relief
from pitchpoint.contact.surface import FlankEnds, Spot, Surfaces
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.core.roots import find_root, hypot
from pitchpoint.gears.contact_lines import (
    InvoluteMesh,
    PathOfContact,
    PitchPoint,
    line_of_action,
    pitch_point,
)
from pitchpoint.gears.coordinates import AXIAL, Coordinate
from pitchpoint.gears.cylindrical import MEMBERS
from pitchpoint.gears.involute import (
    InvoluteGear,
    base_helix,
    inverse_involute,
    involute,
    transverse_angle,
)
from pitchpoint.gears.layers import DrawnPath, drawn_gear, layers
from pitchpoint.gears.mesh_bodies import (
    completed,
    drawing,
    independent,
    main_dimensions,
    plain_inertia,
)
from pitchpoint.gears.pairs import flanks_in_turn, planet_gears, spots_on_turning
from pitchpoint.gears.tooth_section import ToothSection, tooth_sections

__all__ = ["InvolutePair", "LineOfAction", "zero_backlash_centre_distance"]

TOUCHING: Final = 1e-12
"""Tip alteration that is none but for rounding [modules]."""


def zero_backlash_centre_distance(
    *,
    teeth: Float[Array, "2"],
    module: Float[Array, ""],
    pressure_angle: Float[Array, ""],
    helix_angle: Float[Array, ""],
    profile_shift: Float[Array, "2"],
) -> Float[Array, ""]:
    """Centre distance at which the flanks touch on both sides [m].

    NaN where none exists (the sum of x so low that there is always backlash) and where the working
    pressure angle would be above 65 degrees.

    Args:
        teeth: numbers of teeth z1, z2; z2 negative for a ring.
        module: normal module [m].
        pressure_angle: normal pressure angle of the basic rack [rad].
        helix_angle: [rad].
        profile_shift: coefficients x1, x2.

    Source: ISO 21771:2007, inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) (x1 + x2)/(z1 + z2).
    """
    total = jnp.sum(teeth)
    transverse = transverse_angle(pressure_angle, helix_angle)
    value = involute(transverse) + 2.0 * jnp.tan(pressure_angle) * jnp.sum(profile_shift) / total
    working = inverse_involute(value)
    reference = jnp.abs(total) * module / (2.0 * jnp.cos(helix_angle))
    distance = reference * jnp.cos(transverse) / jnp.cos(working)
    return jnp.where((value > 0.0) & (value < 1.0), distance, jnp.nan)


class LineOfAction(PathOfContact):
    """Lengths on the line of action of a pair, and what they follow from.

    Source: ISO 21771:2007, line of action with the points A to E on it.
    """

    mesh: "InvolutePair"

    @cached_property
    def gears(self) -> tuple[InvoluteGear, InvoluteGear]:
        """Both gears for themselves."""
        return self.mesh.gears

    @property
    def pinion(self) -> InvoluteGear:
        """Gear 1."""
        return self.gears[0]

    @property
    def base_radius(self) -> Float[Array, ""]:
        """That of gear 1 [m]."""
        return self.base_radii[0]

    @cached_property
    def transverse_pressure_angle(self) -> Float[Array, ""]:
        """Pressure angle in the transverse section alpha_t [rad]."""
        return transverse_angle(self.mesh.pressure_angle, self.mesh.helix_angle)

    @cached_property
    def slope(self) -> Float[Array, ""]:
        """Cosine of the helix angle on the base cylinders."""
        return jnp.cos(self.mesh.base_helix_angle)

    @cached_property
    def base_radii(self) -> Float[Array, "2"]:
        """Base radii r_b1, r_b2 [m]."""
        reference = self.mesh.teeth * self.mesh.module / (2.0 * jnp.cos(self.mesh.helix_angle))
        return reference * jnp.cos(self.transverse_pressure_angle)

    @cached_property
    def distance(self) -> Float[Array, ""]:
        """Centre distance with the sign that the sum of the radii has [m]."""
        return -self.mesh.centre_distance if self.mesh.internal else self.mesh.centre_distance

    @cached_property
    def working_radii(self) -> Float[Array, "2"]:
        """Radii of the pitch circles in operation r_w1, r_w2 [m]."""
        return self.distance * self.mesh.teeth / jnp.sum(self.mesh.teeth)

    @cached_property
    def cosine(self) -> Float[Array, ""]:
        """Cosine of the working pressure angle: cos(alpha_wt) = (r_b1 + r_b2)/a."""
        return jnp.sum(self.base_radii) / self.distance

    @cached_property
    def sine(self) -> Float[Array, ""]:
        """Sine of the working pressure angle."""
        return jnp.sin(jnp.arccos(self.cosine))

    @cached_property
    def tangent_length(self) -> Float[Array, ""]:
        """Length N1 N2 between the base circles [m]; negative if gear 2 is a ring."""
        return self.distance * self.sine

    @cached_property
    def limits(self) -> Float[Array, "2"]:
        """Positions of A and E from N1 [m]: tip circle or form circle of an undercut, the nearer one."""
        pinion, wheel = self.gears
        start = self.tangent_length - wheel.side * wheel.tip_roll_length
        end = pinion.tip_roll_length
        if pinion.undercut:
            start = jnp.maximum(start, pinion.form_roll_length)
        if wheel.undercut:
            end = jnp.minimum(end, self.tangent_length - wheel.form_roll_length)
        return jnp.stack([start, end])

    @cached_property
    def pitch_position(self) -> Float[Array, ""]:
        """Position of the pitch point C from N1 [m]."""
        return self.working_radii[0] * self.sine


class InvolutePair(InvoluteMesh):
    """Two gears on fixed parallel axes. Coordinates: rotation of gear 1 and of gear 2.

    Gear 2 may be a ring: then its number of teeth and its radii are negative, as in ISO 21771, and
    all formulas hold as they stand. Lengths along the line of action are transverse and counted from
    N1, the point where it touches the base circle of gear 1. A is the end of the path of contact
    near N1, where gear 2 has its tip; E the other end.

    Attributes:
        chosen: of the class; fields that are chosen one by one unless they follow, see `independent`.
        teeth: numbers of teeth z1, z2; z2 negative for a ring.
        module: normal module [m].
        pressure_angle: normal pressure angle of the basic rack [rad].
        helix_angle: on the reference cylinders, without its hand [rad].
        profile_shift: coefficients x1, x2.
        tip_alteration: coefficients k1, k2; negative shortens the tips (ISO 21771).
        addendum, dedendum, fillet_radius: of the basic racks, in normal modules, one for each gear.
        least_tip: tip thickness in the normal section, in modules, that shortened tips keep.
        face_width: common to both [m].
        centre_distance: in operation, positive [m].
        rim_ratio: root radius over bore radius (outer over root radius of a ring), for each gear.
        follows: static; whether centre distance (without backlash) and tip alterations (rack's tip
            clearance) follow from the other dimensions.
        shortened: for each gear whether its tip is shortened to `least_tip`; static.
        undercut: for each gear whether the rack undercuts its flanks; static.
        crossing: for each gear where the undercut crosses the involute, see `InvoluteGear`.
        helical: False if the helix angle is zero; static.
        internal: True if gear 2 is a ring; static.
        lanes: static count of pairs held, at least the contact ratio rounded up.
        slices: static count of slices of each contact line; even, or one.
        surfaces: how all flanks of both gears differ from involutes.
        infeed: x_E - x, the profile shifts by which both gears are cut beyond x; negative for teeth that are
            thinner than nominal ones and have the same tips.
        cutter_teeth, cutter_shift: z_0 and x_0 of the pinion cutter of a ring, whose tip corners have the
            fillet radius of gear 2; None without one.
    """

    chosen: ClassVar[tuple[str, ...]] = (
        "module",
        "pressure_angle",
        "helix_angle",
        "profile_shift",
        "tip_alteration",
        "addendum",
        "dedendum",
        "fillet_radius",
        "face_width",
        "centre_distance",
        "rim_ratio",
    )

    teeth: Float[Arrays, "2"]
    module: Float[Arrays, ""]
    pressure_angle: Float[Arrays, ""]
    helix_angle: Float[Arrays, ""]
    profile_shift: Float[Arrays, "2"]
    tip_alteration: Float[Arrays, "2"]
    addendum: Float[Arrays, "2"]
    dedendum: Float[Arrays, "2"]
    fillet_radius: Float[Arrays, "2"]
    least_tip: Float[Arrays, ""]
    face_width: Float[Arrays, ""]
    centre_distance: Float[Arrays, ""]
    rim_ratio: Float[Arrays, "2"]
    right_flank: Bool[Arrays, ""]
    follows: tuple[bool, bool] = eqx.field(static=True)
    shortened: tuple[bool, bool] = eqx.field(static=True)
    undercut: tuple[bool, bool] = eqx.field(static=True)
    crossing: Float[Arrays, "2"]
    helical: bool = eqx.field(static=True)
    internal: bool = eqx.field(static=True)
    lanes: int = eqx.field(static=True)
    slices: int = eqx.field(static=True)
    surfaces: Surfaces = ((), ())
    infeed: Float[Arrays, "2"] = eqx.field(default_factory=lambda: np.zeros(2))
    cutter_teeth: Float[Arrays, ""] | None = None
    cutter_shift: Float[Arrays, ""] | None = None

    def completed(self) -> Self:
        """The pair with centre distance and tip alterations as they follow from the rest."""
        pair, (distance_follows, tips_follow) = self, self.follows
        if distance_follows:
            pair = dataclasses.replace(pair, centre_distance=self.zero_backlash_centre_distance)
        if tips_follow:
            change = pair.clearance_keeping_tip_alteration
            pair = dataclasses.replace(pair, tip_alteration=jnp.stack([change, change]))
            pair = dataclasses.replace(pair, tip_alteration=pair._shortened_tips())
        return dataclasses.replace(pair, surfaces=pair._fitted_surfaces())

    def _fitted_surfaces(self) -> Surfaces:
        """Surfaces on the flanks as they end now."""
        if not any(self.surfaces):
            return self.surfaces
        ends, arcs = self.active_flanks, 2.0 * jnp.abs(self.base_radii)
        pinion, wheel = (
            tuple(
                surface.fitted(FlankEnds(ends[k, 0], ends[k, 1], arcs[k], self.face_width))
                for surface in of_gear
            )
            for k, of_gear in enumerate(self.surfaces)
        )
        return pinion, wheel

    @property
    def gears(self) -> tuple[InvoluteGear, InvoluteGear]:
        """Both gears for themselves."""
        return self._gear(0), self._gear(1)

    @property
    def line(self) -> LineOfAction:
        """Lengths on the line of action, for one question."""
        return LineOfAction(self)

    @property
    def transverse_pressure_angle(self) -> Float[Array, ""]:
        """Pressure angle in the transverse section alpha_t [rad]."""
        return self.line.transverse_pressure_angle

    @property
    def base_helix_angle(self) -> Float[Array, ""]:
        """Helix angle on the base cylinders beta_b [rad]."""
        return base_helix(self.pressure_angle, self.helix_angle)

    @property
    def base_radii(self) -> Float[Array, "2"]:
        """Base radii r_b1, r_b2 [m]."""
        return self.line.base_radii

    @property
    def tip_radii(self) -> Float[Array, "2"]:
        """Tip radii r_a1, r_a2 [m]."""
        return jnp.stack([gear.tip_radius for gear in self.gears])

    @property
    def zero_backlash_centre_distance(self) -> Float[Array, ""]:
        """Centre distance without backlash for teeth of these shifts [m], whatever the one in operation."""
        return zero_backlash_centre_distance(
            teeth=self.teeth,
            module=self.module,
            pressure_angle=self.pressure_angle,
            helix_angle=self.helix_angle,
            profile_shift=self.profile_shift,
        )

    @property
    def clearance_keeping_tip_alteration(self) -> Float[Array, ""]:
        """Tip alteration coefficient k that keeps the rack's tip clearance; never lengthens (ISO 21771)."""
        reference = jnp.sum(self.teeth) * self.module / (2.0 * jnp.cos(self.helix_angle))
        change = (self.line.distance - reference) / self.module - jnp.sum(self.profile_shift)
        # Where flanks touch at the reference centre distance, derivatives are those towards backlash: the
        # other side of this kink has no gears, and a minimum takes the mean of both.
        return jnp.where(change < -TOUCHING, change, 0.0)

    @property
    def backlash(self) -> Float[Array, ""]:
        """Circumferential backlash on the pitch circles j_wt [m]."""
        return self.section_backlash

    @property
    def section_backlash(self) -> Float[Array, ""]:
        """That of one transverse section [m]: the pitch less both tooth thicknesses."""
        radii = jnp.abs(self.working_radii)
        halves = [gear.half_thickness_angle(r) for gear, r in zip(self.gears, radii, strict=True)]
        return 2.0 * jnp.sum(radii * (jnp.pi / jnp.abs(self.teeth) / 2.0 - jnp.stack(halves)))

    @property
    def normal_backlash(self) -> Float[Array, ""]:
        """Backlash along the normal of the flanks j_bn = j_wt cos(alpha_wt) cos(beta_b) [m] (ISO 21771)."""
        return self.backlash * jnp.cos(self.working_pressure_angle) * jnp.cos(self.base_helix_angle)

    @property
    def working_radii(self) -> Float[Array, "2"]:
        """Radii of the pitch circles in operation r_w1, r_w2 [m]."""
        return self.line.working_radii

    @property
    def working_pressure_angle(self) -> Float[Array, ""]:
        """Transverse pressure angle in operation [rad]: cos(alpha_wt) = (r_b1 + r_b2)/a."""
        return jnp.arccos(self.line.cosine)

    @property
    def base_pitch(self) -> Float[Array, ""]:
        """Transverse base pitch p_bt, the pitch on the line of action [m]."""
        return self.line.base_pitch

    @property
    def tangent_length(self) -> Float[Array, ""]:
        """Length N1 N2 between the base circles [m]; negative if gear 2 is a ring."""
        return self.line.tangent_length

    @property
    def limits(self) -> Float[Array, "2"]:
        """Positions of A and E from N1 [m]: tip circle or form circle of an undercut, the nearer one."""
        return self.line.limits

    @property
    def pitch_position(self) -> Float[Array, ""]:
        """Position of the pitch point C from N1 [m]."""
        return self.line.pitch_position

    @property
    def points(self) -> Float[Array, "5"]:
        """Positions of A, B, C, D, E from N1 [m]; B and D one base pitch from the far end (1 < eps < 2)."""
        return self.line.points

    @property
    def transverse_contact_ratio(self) -> Float[Array, ""]:
        """Transverse contact ratio eps_alpha."""
        return self.line.transverse_contact_ratio

    @property
    def overlap_ratio(self) -> Float[Array, ""]:
        """Overlap ratio eps_beta = b sin(beta)/(pi m_n)."""
        return self.line.overlap_ratio

    def specific_sliding(self, position: Float[Array, "*b"]) -> Float[Array, "*b 2"]:
        """Sliding speed over own rolling speed of each gear at positions from N1 [m] (ISO 21771).

        Zero at the pitch point, negative below the pitch circle of each gear.
        """
        rolling = jnp.stack(
            [
                position / self.teeth[0],
                (self.tangent_length - position) / self.teeth[1],
            ],
            axis=-1,
        )
        return jnp.asarray(1.0 - rolling[..., ::-1] / rolling)

    @property
    def relation(self) -> Float[Arrays, "2"]:
        """Teeth pass the pitch point together: z1 q1 + z2 q2 = 0, the teeth of a ring counted negative."""
        return self._side * self.teeth

    @property
    def pitch(self) -> Float[Numbers, ""]:
        """Angle of gear 1 of one base pitch [rad]."""
        return 2.0 * jnp.pi / self.teeth[0]

    @property
    def passing(self) -> Float[Arrays, "2"]:
        """Pairs run from A to E as gear 1 turns on."""
        return self._side * np.array([1.0, 0.0])

    @property
    def active_flanks(self) -> Float[Array, "2 2"]:
        """Roll lengths of both gears at the start of the active profile and at the tip, positive [m]."""
        tips = jnp.stack([gear.tip_roll_length for gear in self.gears])
        return jnp.stack([jnp.abs(self._innermost), tips], axis=1)

    @property
    def coordinates(self) -> tuple[Coordinate, Coordinate]:
        """Both gears: the origin on the axis of gear 1, x towards the pitch point, z as `width`."""
        places = jnp.zeros((2, 3)).at[1, 0].set(self.line.distance)
        pinion, wheel = (
            Coordinate(name, place, jnp.asarray(AXIAL), member)
            for member, (name, place) in enumerate(zip(MEMBERS, places, strict=True))
        )
        return pinion, wheel

    def events(self) -> Float[Array, " event"]:
        """Phases of entry, exit and pitch point.

        Of helical teeth also those at which a contact line stops growing and begins to shrink, and
        at which the pitch line enters and leaves it; of spur teeth those at which a relief begins.
        """
        line = self.line
        positions = line.bounds(helical=self.helical)
        if not self.helical:
            positions += self._relief_paths(line)
        return jnp.sort(jnp.mod(jnp.stack(positions), 1.0))

    def _relief_paths(self, line: LineOfAction) -> list[Array]:
        """Positions on the path at which a relief of either gear begins [base pitches]."""
        rolls = [
            [
                jnp.sqrt(2.0 * jnp.abs(base) * surface.start)
                for surface in of_gear
                if isinstance(surface, Relief)
            ]
            for base, of_gear in zip(line.base_radii, self.surfaces, strict=True)
        ]
        sense = -1.0 if self.internal else 1.0
        positions = [*rolls[0], *(line.tangent_length - sense * roll for roll in rolls[1])]
        return [(position - line.limits[0]) / line.base_pitch for position in positions]

    def contacts_at(
        self,
        path: Float[Arrays, "pair slice *b"],
        *,
        active: Bool[Arrays, "pair 1 *b"],
        width: Float[Arrays, "..."],
        weight: Float[Arrays, "..."],
        tilt: Float[Array, ""],
        across: Float[Array, "2"],
    ) -> Contacts:
        """Contacts at places on the plane of action.

        Args:
            path: from A along the line of action [base pitches].
            active: True where the pair is in mesh.
            width: place across the face, from its middle [m].
            weight: see `Contacts`.
            tilt: angle between the normal of the flanks and the transverse section [rad].
            across: curvature of both flanks at right angles to the profile [1/m].
        """
        line, side, lanes = self.line, self._side, jnp.shape(path)
        active = jnp.broadcast_to(active, lanes)
        position = jnp.where(active, line.limits[0] + path * line.base_pitch, line.pitch_position)
        rolling = jnp.stack([position, line.tangent_length - position])
        none, width = jnp.zeros_like(position), jnp.broadcast_to(width, lanes)
        pinion_roll, wheel_roll = side * rolling[0], -side * rolling[1]
        slope, base = jnp.cos(tilt), line.base_radii
        arms = side * base * slope
        bent = across.reshape(2, *(1 for _ in lanes))
        return Contacts(
            active=active,
            path=jnp.asarray(path),
            width=width,
            weight=jnp.broadcast_to(weight, lanes),
            curvature=jnp.stack([slope / rolling, bent + jnp.zeros_like(rolling)], axis=1),
            surface=jnp.stack([jnp.stack([pinion_roll, none]), jnp.stack([none, wheel_roll])]),
            normal=jnp.stack([jnp.broadcast_to(arm, lanes) for arm in arms]),
            gap=none,
            flank=jnp.stack([rolling[k] ** 2 / (2.0 * jnp.abs(base[k])) for k in (0, 1)]),
            **self._frame(line, position, width, tilt),
            shape=self.shape,
        )

    def tooth_angles(self, phase: Float[Array, "*b"]) -> Float[Array, "2 *b"]:
        """Angle about its axis of the middle of a tooth of each gear whose flanks touch [rad].

        In the middle of the face, counter-clockwise from the direction in which the pitch point lies from the
        axis of gear 1, and from that in which it lies from the axis of gear 2.

        Args:
            phase: of the mesh [periods].

        From the involutes that begin where the line of action unwinds from the base circles.
        """
        line = self.line
        path = line.limits[0] + (phase - line.overlap_ratio / 2.0) * line.base_pitch
        rolled = path / line.base_radii[0], (line.tangent_length - path) / line.base_radii[1]
        return self._side * jnp.stack(
            [
                roll - self.working_pressure_angle - gear.side * gear.half_thickness_angle(base)
                for roll, gear, base in zip(rolled, self.gears, line.base_radii, strict=True)
            ]
        )

    def spots(self, contacts: Contacts, phase: Float[Arrays, "..."]) -> tuple[Spot, Spot]:
        """Angles are those of the line of action, against which both gears turn; teeth follow each other."""
        senses = -self._side, self._side * jnp.sign(self.teeth[1])
        return spots_on_turning(contacts, phase, jnp.abs(self.teeth), senses)

    def _layers(self) -> dict[str, Float[Array, "..."]]:
        """The transverse section at the middle of the face, gear 2 above gear 1, a ring below.

        A contact line reaches that section half of the overlap ratio after it entered.
        """
        line, side, gears = self.line, self._side, self.gears
        base_radius = line.base_radii[0]
        path = DrawnPath(
            origin=base_radius * jnp.stack([side * line.sine, line.cosine]),
            along=jnp.stack([-side * line.cosine, line.sine]),
            limits=line.limits,
            points=self.points,
            ends=jnp.stack([jnp.zeros(()), line.tangent_length]),
            base_pitch=line.base_pitch,
            behind=line.overlap_ratio / 2.0,
        )
        bodies = [
            drawn_gear(
                gear,
                place=jnp.stack([jnp.zeros(()), member * line.distance]),
                contact=path.at(line.limits[0]),
                side=side,
                earlier=(1.0, -1.0)[member] * side * 2.0 * jnp.pi / gear.teeth * path.behind,
                working_radius=line.working_radii[member],
            )
            for member, gear in enumerate(gears)
        ]
        z1, z2 = self.teeth
        none = jnp.zeros(())
        rolling = [[none, 1.0 / z1], [line.tangent_length / z2, -1.0 / z2]]
        return layers(bodies, path) | {"rolling": jnp.array(rolling)}

    def _frame(
        self, line: LineOfAction, position: Array, width: Array, tilt: Array
    ) -> dict[str, Float[Array, "3 pair slice *b"]]:
        """Points on the plane of action and the directions there, the same at all of them."""
        cosine, sine, side, none = line.cosine, line.sine, self._side, jnp.zeros(())
        start = line.base_radii[0] * jnp.stack([cosine, -side * sine])
        along = jnp.stack([sine, side * cosine])

        def everywhere(parts: list[Array]) -> Array:
            return jnp.stack([jnp.broadcast_to(part, position.shape) for part in parts])

        return {
            "point": jnp.stack([start[k] + position * along[k] for k in (0, 1)] + [width]),
            "direction": everywhere([*(jnp.cos(tilt) * along), jnp.sin(tilt)]),
            "tangent": everywhere([-cosine, side * sine, none]),
        }

    @property
    def _innermost(self) -> Float[Array, "2"]:
        """Roll lengths at which the path of contact ends nearest to the root of each gear [m]."""
        start, end = self.limits
        return jnp.stack([start, self.tangent_length - end])

    def _shortened_tips(self) -> Float[Array, "2"]:
        """Tip alterations at which the tips that are to be shortened are as thick as asked."""
        cuts = [
            self._shortening(gear) if short else 0.0
            for gear, short in zip(self.gears, self.shortened, strict=True)
        ]
        return self.tip_alteration - jnp.stack(cuts)

    def _shortening(self, gear: InvoluteGear) -> Float[Array, ""]:
        """Modules by which a tip is cut back to the least thickness in the normal section."""

        def missing(cut: Float[Array, ""]) -> Float[Array, ""]:
            shorter = dataclasses.replace(gear, tip_alteration=gear.tip_alteration - cut)
            return shorter.tip_thickness / gear.module - self.least_tip

        most = (jnp.abs(gear.tip_radius) - jnp.abs(gear.base_radius)) / gear.module
        return find_root(missing, 0.2 * most, most)[0]

    def _gear(self, index: int) -> InvoluteGear:
        is_ring = self.internal and index == 1
        return InvoluteGear(
            teeth=self.teeth[index],
            module=self.module,
            pressure_angle=self.pressure_angle,
            helix_angle=self.helix_angle,
            profile_shift=self.profile_shift[index] + self.infeed[index],
            tip_alteration=self.tip_alteration[index] - self.infeed[index],
            addendum=self.addendum[index],
            dedendum=self.dedendum[index],
            fillet_radius=self.fillet_radius[index],
            undercut=self.undercut[index],
            crossing=self.crossing[index],
            internal=is_ring,
            cutter_teeth=self.cutter_teeth if is_ring else None,
            cutter_shift=self.cutter_shift if is_ring else None,
        )


@main_dimensions.register
def _main_dimensions(pair: InvolutePair) -> dict[str, Float[Array, "..."]]:
    """Contact ratios, centre distance, and for each gear its shortening, tip and undercut limit."""
    gears = pair.gears
    return {
        "module": pair.module,
        "transverse_contact_ratio": pair.transverse_contact_ratio,
        "overlap_ratio": pair.overlap_ratio,
        "centre_distance": pair.centre_distance,
        "circumferential_backlash": pair.backlash,
        "normal_backlash": pair.normal_backlash,
        "tip_alteration": pair.tip_alteration,
        "tip_thickness": jnp.stack([gear.tip_thickness for gear in gears]),
        "undercut_limit": jnp.stack([gear.undercut_limit for gear in gears]),
    }


@drawing.register
def _drawing(pair: InvolutePair) -> dict[str, Float[Array, "..."]]:
    """Layers of the picture, circles, points of the path; radii without sign [m]."""
    gears = pair.gears
    radii = {
        "base_radius": pair.base_radii,
        "tip_radius": pair.tip_radii,
        "root_radius": jnp.stack([gear.root_radius for gear in gears]),
        "reference_radius": jnp.stack([gear.reference_radius for gear in gears]),
        "working_radius": pair.working_radii,
        "form_radius": hypot(pair.base_radii, jnp.stack([gear.form_roll_length for gear in gears])),
        "active_root_radius": hypot(pair.base_radii, pair._innermost),
    }
    return {
        **pair._layers(),
        "points": pair.points,
        "teeth": pair.teeth,
        **{name: jnp.abs(values) for name, values in radii.items()},
        "working_pressure_angle": pair.working_pressure_angle,
        "tangent_length": pair.tangent_length,
        "base_pitch": pair.base_pitch,
        "base_helix_angle": pair.base_helix_angle,
        "face_width": pair.face_width,
        "contact_ratio": pair.contact_ratio,
        "specific_sliding_A": pair.specific_sliding(pair.limits[0]),
        "specific_sliding_E": pair.specific_sliding(pair.limits[1]),
        **main_dimensions(pair),
    }


@independent.register
def _independent(pair: InvolutePair) -> tuple[str, ...]:
    """Fields of `chosen` that follow from no others here."""
    follows = dict(zip(("centre_distance", "tip_alteration"), pair.follows, strict=True))
    return tuple(name for name in pair.chosen if not follows.get(name))


@line_of_action.register
def _line_of_action(pair: InvolutePair) -> Float[Array, "2"]:
    """Base radii with the sense in which the gears close along the transverse line of action."""
    return pair._side * pair.base_radii


@pitch_point.register
def _pitch_point(pair: InvolutePair, driver: Float[Arrays, "2"]) -> PitchPoint:
    """Values at the pitch point C."""
    line = pair.line
    speed = jnp.sum(driver * jnp.abs(line.working_radii))
    pinion_roll, wheel_roll = line.pitch_position, line.tangent_length - line.pitch_position
    return PitchPoint(
        width=pair.face_width,
        line_length=pair.face_width / line.slope,
        radius=pinion_roll * wheel_roll / line.tangent_length / line.slope,
        sum_speed=2.0 * speed * line.sine,
        pitch_line_speed=speed,
    )


@tooth_sections.register
def _tooth_sections(pair: InvolutePair) -> tuple[ToothSection, ToothSection]:
    """Teeth of both gears in the normal section."""
    pinion, wheel = pair.gears
    return pinion.section(pair.rim_ratio[0]), wheel.section(pair.rim_ratio[1])


@plain_inertia.register
def _plain_inertia(pair: InvolutePair, density: Float[Array, "2"]) -> Float[Array, "2"]:
    """Moments of inertia of discs as wide as the face, from bore to reference circle [kg m2].

    A ring reaches from its reference circle outwards.
    """
    outer = jnp.stack([gear.reference_radius for gear in pair.gears])
    root = jnp.abs(jnp.stack([gear.root_radius for gear in pair.gears]))
    ring = jnp.asarray([False, pair.internal])
    bore = jnp.where(ring, root * pair.rim_ratio, root / pair.rim_ratio)
    return jnp.pi / 2.0 * density * pair.face_width * jnp.abs(outer**4 - bore**4)


completed.register(InvolutePair, lambda pair: pair.completed())
flanks_in_turn.register(InvolutePair, lambda pair: jnp.abs(pair.teeth))


@planet_gears.register
def _planet_gears(pair: InvolutePair) -> InvolutePair:
    return pair
