"""Pair of external involute spur gears: geometry by ISO 21771 names, and its travelling contacts."""

import dataclasses
from typing import Self

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.errors import InputError
from pitchpoint.gears.checks import check_cylindrical
from pitchpoint.gears.involute import InvoluteGear, inverse_involute, involute
from pitchpoint.gears.mesh import Mesh, Reference

__all__ = ["CylindricalPair", "zero_backlash_centre_distance"]

# Beyond this the pair is unloaded anyway; it only bounds the padding of the pair axis.
_LANES_FOR_RATIO_BELOW = (2.0, 3.0, 4.0, 6.0, 9.0)


def zero_backlash_centre_distance(
    *,
    teeth: Float[Array, "2"],
    module: Float[Array, ""],
    pressure_angle: Float[Array, ""],
    profile_shift: Float[Array, "2"],
) -> Float[Array, ""]:
    """Centre distance at which the flanks touch on both sides [m].

    NaN where none exists (the sum of x so low that there is always backlash) and where the working
    pressure angle would be above 65 degrees.

    Args:
        teeth: numbers of teeth z1, z2.
        module: [m].
        pressure_angle: of the basic rack [rad].
        profile_shift: coefficients x1, x2.

    Source: ISO 21771:2007, inv(alpha_w) = inv(alpha) + 2 tan(alpha) (x1 + x2)/(z1 + z2).
    """
    total = jnp.sum(teeth)
    value = (
        involute(pressure_angle) + 2.0 * jnp.tan(pressure_angle) * jnp.sum(profile_shift) / total
    )
    working = inverse_involute(value)
    distance = total * module / 2.0 * jnp.cos(pressure_angle) / jnp.cos(working)
    return jnp.where((value > 0.0) & (value < 1.0), distance, jnp.nan)


class CylindricalPair(Mesh):
    """Two external spur gears on fixed axes. Coordinates: rotation of gear 1 and of gear 2.

    Lengths along the line of action are counted from N1, the point where it touches the base circle
    of gear 1. A is the end of the path of contact near N1, where gear 2 has its tip; E the other end.

    Attributes:
        teeth: numbers of teeth z1, z2.
        module: [m].
        pressure_angle: of the basic rack [rad].
        profile_shift: coefficients x1, x2.
        tip_alteration: coefficients k1, k2; negative shortens the tips (ISO 21771).
        addendum, dedendum, fillet_radius: of the basic racks, in modules, one for each gear.
        face_width: common to both [m].
        centre_distance: in operation [m].
        wheel_drives: True if gear 2 drives and gear 1 carries the load; the same flanks touch.
        right_flank: False while gear 1 pushes with its left flanks (seen with the tip up), turning
            counter-clockwise when it drives; True for the other ones.
        follows: static; whether centre distance (without backlash) and tip alterations (rack's tip
            clearance) follow from the other dimensions.
        undercut: for each gear whether the rack undercuts its flanks; static.
        crossing: for each gear where the undercut crosses the involute, see `InvoluteGear`.
        lanes: static count of pairs held, at least the contact ratio rounded up.
    """

    teeth: Float[Array, "2"]
    module: Float[Array, ""]
    pressure_angle: Float[Array, ""]
    profile_shift: Float[Array, "2"]
    tip_alteration: Float[Array, "2"]
    addendum: Float[Array, "2"]
    dedendum: Float[Array, "2"]
    fillet_radius: Float[Array, "2"]
    face_width: Float[Array, ""]
    centre_distance: Float[Array, ""]
    wheel_drives: Bool[Array, ""]
    right_flank: Bool[Array, ""]
    follows: tuple[bool, bool] = eqx.field(static=True)
    undercut: tuple[bool, bool] = eqx.field(static=True)
    crossing: Float[Array, "2"]
    lanes: int = eqx.field(static=True)

    def completed(self) -> Self:
        """The pair with centre distance and tip alterations as they follow from the rest."""
        pair, (distance_follows, tips_follow) = self, self.follows
        rack = {"teeth": self.teeth, "module": self.module, "profile_shift": self.profile_shift}
        if distance_follows:
            distance = zero_backlash_centre_distance(**rack, pressure_angle=self.pressure_angle)
            pair = dataclasses.replace(pair, centre_distance=distance)
        if tips_follow:
            change = clearance_keeping_tip_alteration(**rack, centre_distance=pair.centre_distance)
            pair = dataclasses.replace(pair, tip_alteration=jnp.stack([change, change]))
        return pair

    @property
    def gears(self) -> tuple[InvoluteGear, InvoluteGear]:
        """Both gears for themselves."""
        return self._gear(0), self._gear(1)

    @property
    def base_radii(self) -> Float[Array, "2"]:
        """Base radii r_b1, r_b2 [m]."""
        return self.teeth * self.module * jnp.cos(self.pressure_angle) / 2.0

    @property
    def tip_radii(self) -> Float[Array, "2"]:
        """Tip radii r_a1, r_a2 [m]."""
        return jnp.stack([gear.tip_radius for gear in self.gears])

    @property
    def zero_backlash_centre_distance(self) -> Float[Array, ""]:
        """Centre distance without backlash for these teeth [m], whatever the one in operation."""
        return zero_backlash_centre_distance(
            teeth=self.teeth,
            module=self.module,
            pressure_angle=self.pressure_angle,
            profile_shift=self.profile_shift,
        )

    @property
    def working_radii(self) -> Float[Array, "2"]:
        """Radii of the pitch circles in operation r_w1, r_w2 [m]."""
        return self.centre_distance * self.teeth / jnp.sum(self.teeth)

    @property
    def working_pressure_angle(self) -> Float[Array, ""]:
        """Pressure angle in operation [rad]: cos(alpha_w) = (r_b1 + r_b2)/a."""
        return jnp.arccos(jnp.sum(self.base_radii) / self.centre_distance)

    @property
    def base_pitch(self) -> Float[Array, ""]:
        """Pitch on the line of action p_b = pi m cos(alpha) [m]."""
        return jnp.pi * self.module * jnp.cos(self.pressure_angle)

    @property
    def tangent_length(self) -> Float[Array, ""]:
        """Length N1 N2 between the base circles [m]."""
        return self.centre_distance * jnp.sin(self.working_pressure_angle)

    @property
    def limits(self) -> Float[Array, "2"]:
        """Positions of A and E from N1 [m]: tip circle or form circle of an undercut, the nearer one."""
        reach = jnp.sqrt(self.tip_radii**2 - self.base_radii**2)
        start, end = self.tangent_length - reach[1], reach[0]
        first, second = self.gears
        if first.undercut:
            start = jnp.maximum(start, first.form_roll_length)
        if second.undercut:
            end = jnp.minimum(end, self.tangent_length - second.form_roll_length)
        return jnp.stack([start, end])

    @property
    def pitch_position(self) -> Float[Array, ""]:
        """Position of the pitch point C from N1 [m]."""
        return self.working_radii[0] * jnp.sin(self.working_pressure_angle)

    @property
    def points(self) -> Float[Array, "5"]:
        """Positions of A, B, C, D, E from N1 [m]; B and D one base pitch from the far end (1 < eps < 2)."""
        start, end = self.limits
        return jnp.stack(
            [start, end - self.base_pitch, self.pitch_position, start + self.base_pitch, end]
        )

    @property
    def contact_ratio(self) -> Float[Array, ""]:
        """Transverse contact ratio eps_alpha."""
        start, end = self.limits
        return jnp.asarray((end - start) / self.base_pitch)

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
    def motion(self) -> Float[Array, "2"]:
        """Rates of both gears for one radian of the driver."""
        ratio = self.teeth[0] / self.teeth[1]
        gear_1_drives = jnp.stack([jnp.ones_like(ratio), -ratio])
        return self._side * jnp.where(self.wheel_drives, -1.0 / ratio, 1.0) * gear_1_drives

    @property
    def driver(self) -> Float[Array, "2"]:
        """Gear 1, or gear 2 if the wheel drives."""
        return jnp.where(self.wheel_drives, jnp.array([0.0, 1.0]), jnp.array([1.0, 0.0]))

    @property
    def loaded(self) -> Float[Array, "2"]:
        """The driven gear."""
        return 1.0 - self.driver

    @property
    def period(self) -> Float[Array, ""]:
        """Driver angle of one base pitch [rad]."""
        return 2.0 * jnp.pi / jnp.sum(self.driver * self.teeth)

    @property
    def reference(self) -> Reference:
        """Values at the pitch point C."""
        angle = self.working_pressure_angle
        speed = jnp.sum(self.driver * self.working_radii)
        first, second = self.pitch_position, self.tangent_length - self.pitch_position
        return Reference(
            width=self.face_width,
            radius=first * second / self.tangent_length,
            sum_speed=2.0 * speed * jnp.sin(angle),
            pitch_line_speed=speed,
        )

    def events(self) -> Float[Array, "3"]:
        """Phases of entry, exit and pitch point."""
        start = self.limits[0]
        pitch = (self.pitch_position - start) / self.base_pitch
        zero = jnp.zeros_like(pitch)
        return jnp.sort(jnp.mod(jnp.stack([zero, self.contact_ratio, pitch]), 1.0))

    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of all pairs in mesh; phase 0 is the entry of a pair at A [base pitches]."""
        number = jnp.arange(float(self.lanes)).reshape(-1, *([1] * (jnp.ndim(phase) + 1)))
        path = jnp.mod(phase, 1.0) + number
        active = path <= self.contact_ratio
        position = jnp.where(active, self.limits[0] + path * self.base_pitch, self.pitch_position)
        rolling = jnp.stack([position, self.tangent_length - position])
        none, lanes = jnp.zeros_like(position), jnp.shape(position)
        first, second = self._side * rolling[0], -self._side * rolling[1]
        arms = self._side * self.base_radii
        return Contacts(
            active=active,
            path=path,
            width=none,
            weight=jnp.broadcast_to(self.face_width, lanes),
            curvature=jnp.stack([1.0 / rolling, jnp.zeros_like(rolling)], axis=1),
            surface=jnp.stack([jnp.stack([first, none]), jnp.stack([none, second])]),
            normal=jnp.stack([jnp.broadcast_to(arm, lanes) for arm in arms]),
            gap=none,
            flank=jnp.stack([rolling[k] ** 2 / (2.0 * self.base_radii[k]) for k in (0, 1)]),
            shape="line",
        )

    @property
    def _side(self) -> Float[Array, ""]:
        return jnp.where(self.right_flank, -1.0, 1.0)

    def _gear(self, index: int) -> InvoluteGear:
        return InvoluteGear(
            teeth=self.teeth[index],
            module=self.module,
            pressure_angle=self.pressure_angle,
            profile_shift=self.profile_shift[index],
            tip_alteration=self.tip_alteration[index],
            addendum=self.addendum[index],
            dedendum=self.dedendum[index],
            fillet_radius=self.fillet_radius[index],
            undercut=self.undercut[index],
            crossing=self.crossing[index],
        )


def lanes_for(contact_ratio: float) -> int:
    """Static count of pairs to hold for a contact ratio: few values, so that few programs are compiled."""
    for limit in _LANES_FOR_RATIO_BELOW:
        if contact_ratio < limit:
            return int(limit)
    message = f"contact ratio {contact_ratio:.3g} is out of reach of external spur gears"
    raise InputError(message, key="gears", value=contact_ratio)


def clearance_keeping_tip_alteration(
    *,
    teeth: Float[Array, "2"],
    module: Float[Array, ""],
    profile_shift: Float[Array, "2"],
    centre_distance: Float[Array, ""],
) -> Float[Array, ""]:
    """Tip alteration coefficient k that keeps the rack's tip clearance; never lengthens (ISO 21771)."""
    reference = jnp.sum(teeth) * module / 2.0
    change = (centre_distance - reference) / module - jnp.sum(profile_shift)
    return jnp.minimum(change, 0.0)


def build_cylindrical_pair(
    *,
    teeth: tuple[int, int],
    module: float,
    pressure_angle: float,
    face_width: float,
    profile_shift: tuple[float, float] = (0.0, 0.0),
    addendum: tuple[float, float] = (1.0, 1.0),
    dedendum: tuple[float, float] | None = None,
    fillet_radius: tuple[float, float] = (0.38, 0.38),
    tip_alteration: tuple[float, float] | None = None,
    centre_distance: float | None = None,
    driver: int = 1,
    right_flank: bool = False,
) -> CylindricalPair:
    """Pair from what an engineer knows; the rest by ISO 21771.

    Args:
        teeth: z1, z2.
        module, face_width, centre_distance: [m]; without backlash if no centre distance is given.
        pressure_angle: of the basic rack [rad].
        profile_shift: x1, x2.
        addendum, dedendum, fillet_radius: of the basic racks in modules; dedendum defaults to
            addendum + 0.25.
        tip_alteration: k1, k2; keeps the rack's tip clearance by default.
        driver: 1 or 2, the gear that drives.
        right_flank: True if the right flanks of both gears touch.

    Raises:
        InputError: the flanks cannot meet at all; `check_cylindrical` says what else is wrong.
    """
    pair = CylindricalPair(
        teeth=_array(teeth),
        module=_array(module),
        pressure_angle=_array(pressure_angle),
        profile_shift=_array(profile_shift),
        tip_alteration=_array(tip_alteration or (0.0, 0.0)),
        addendum=_array(addendum),
        dedendum=_array(dedendum or (addendum[0] + 0.25, addendum[1] + 0.25)),
        fillet_radius=_array(fillet_radius),
        face_width=_array(face_width),
        centre_distance=_array(centre_distance or 0.0),
        wheel_drives=jnp.asarray(driver == 2),
        right_flank=jnp.asarray(right_flank),
        follows=(centre_distance is None, tip_alteration is None),
        undercut=(False, False),
        crossing=jnp.full(2, jnp.asarray(pressure_angle, dtype=jnp.float64)),
        lanes=2,
    )
    pair, limit = _complete(pair)
    first, second = (bool(one) for one in pair.profile_shift < limit)
    if first or second:
        pair = _with_crossings(dataclasses.replace(pair, undercut=(first, second)))
    ratio = float(_contact_ratio(pair))
    if not 0.0 < ratio < _LANES_FOR_RATIO_BELOW[-1]:
        check_cylindrical(pair)  # says why, in gear words
    return dataclasses.replace(pair, lanes=lanes_for(ratio))


@eqx.filter_jit
def _contact_ratio(pair: CylindricalPair) -> Float[Array, ""]:
    return pair.contact_ratio


@eqx.filter_jit
def _complete(pair: CylindricalPair) -> tuple[CylindricalPair, Float[Array, "2"]]:
    """Pair with the dimensions that follow from the others, and the undercut limits of both gears."""
    pair = pair.completed()
    return pair, jnp.stack([gear.undercut_limit for gear in pair.gears])


@eqx.filter_jit
def _with_crossings(pair: CylindricalPair) -> CylindricalPair:
    found = [gear.crossing_angle() if gear.undercut else gear.crossing for gear in pair.gears]
    return dataclasses.replace(pair, crossing=jnp.stack(found))


def _array(value: object) -> jax.Array:
    return jnp.asarray(value, dtype=jnp.float64)
