"""One involute gear, external or internal, spur or helical: circles, thickness, outline (ISO 21771)."""

import dataclasses
import math
from functools import cache
from typing import Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.roots import find_root, hypot
from pitchpoint.gears.pinion_cutter import PinionCutting
from pitchpoint.gears.tooth_section import RING_RIM, ToothSection, chebyshev_nodes

__all__ = [
    "FILLET_STATIONS",
    "InvoluteGear",
    "base_helix",
    "gauss",
    "inverse_involute",
    "involute",
    "transverse_angle",
    "usual_dedenda",
    "usual_depths",
    "usual_fillet",
    "usual_ring_fillet",
]

FILLET_STATIONS = 16
"""Gauss nodes along a fillet."""

# ISO 53, profile A: 0.38 modules, what a clearance of 0.25 has room for at 20 degrees, 0.25/(1 - sin 20 deg).
_AVAILABLE_FILLET = 0.38
_RING_FILLET = 0.2  # fits the narrow spaces of most rings
_USUAL_CLEARANCE = 0.25


def usual_fillet(dedendum: float, angle: float) -> float:
    """Corner rounding of a basic rack where none is given, in modules: 0.38, or all its tip has room for.

    Args:
        dedendum: of the rack's gear, in modules.
        angle: normal pressure angle [rad].

    Source: ISO 53:1998, profile A.
    """
    largest = (math.pi / 4 - dedendum * math.tan(angle)) * math.cos(angle) / (1.0 - math.sin(angle))
    return min(_AVAILABLE_FILLET, max(largest, 0.0))


def usual_ring_fillet(
    *,
    teeth: float,
    profile_shift: float,
    dedendum: float,
    pressure_angle: float,
    helix_angle: float,
    cutter: tuple[float, float] | None = None,
) -> float:
    """Fillet radius of a ring where none is given, in modules: 0.2, or all that its root has room for.

    With a pinion cutter it is the radius of the corners of its tip.

    Args:
        teeth: number of teeth, with or without the sign of a ring.
        profile_shift, dedendum: of the ring, in modules.
        pressure_angle, helix_angle: normal one, and that of the reference cylinder [rad].
        cutter: its teeth z_0 and profile shift x_0; None without one.

    Source: ISO 21771:2007, half angle of a space; an arc that touches involute and root circle, or involute
        and tip circle of a cutter, has its centre on a parallel involute.

    Example:
        >>> from math import radians
        >>> ring = {"teeth": 40, "profile_shift": -0.6, "dedendum": 1.25, "helix_angle": 0.0}
        >>> round(usual_ring_fillet(**ring, pressure_angle=radians(25.0)), 4)
        0.1049
    """
    from scipy.optimize import brentq

    reference = abs(teeth) / (2.0 * math.cos(helix_angle))
    transverse = math.atan(math.tan(pressure_angle) / math.cos(helix_angle))
    base, tip = reference * math.cos(transverse), reference + dedendum - profile_shift
    slope, unwound = 2.0 * math.tan(pressure_angle), math.tan(transverse) - transverse
    space = (math.pi / 2.0 - slope * profile_shift) / abs(teeth) + unwound
    if cutter is not None:
        cutter_teeth, shift = cutter
        value = unwound - slope * (profile_shift + shift) / (abs(teeth) - cutter_teeth)
        if value <= 0.0:
            return _RING_FILLET  # refused: it fits at no distance between the axes
        working = brentq(lambda angle: math.tan(angle) - angle - value, 0.0, 1.57)
        tip -= base * (1.0 - cutter_teeth / abs(teeth)) / math.cos(working)
        base *= cutter_teeth / abs(teeth)
        space = (math.pi / 2.0 + slope * shift) / cutter_teeth + unwound

    def land(rounding: float) -> float:
        """Angle from the middle of the space to the centre of the arc."""
        angle = math.acos(min(base / (tip - rounding), 1.0))
        return space - rounding / base - (math.tan(angle) - angle)

    most = min(_RING_FILLET, tip - base)
    if most <= 0.0 or land(0.0) <= 0.0:
        return 0.0
    if land(most) >= 0.0:
        return most
    return float(brentq(land, 0.0, most, xtol=1e-12))


def usual_dedenda(addendum: np.ndarray, *, ring: bool = False) -> np.ndarray:
    """Dedenda of both basic racks where none are given, in modules: 0.25 more than the addendum of the mate.

    The tip of a ring reaches deeper into its pinion than that of a rack: the pinion's dedendum is also at
    least 0.25 more than its own addendum.

    Args:
        addendum: of both racks, shape (..., 2), in modules.
        ring: True if gear 2 is a ring.

    Source: ISO 53:1998, profile A, tip clearance.

    Example:
        >>> import numpy as np
        >>> usual_dedenda(np.array([1.25, 0.75])).tolist()
        [1.0, 1.5]
        >>> usual_dedenda(np.array([1.0, 0.75]), ring=True).tolist()
        [1.25, 1.25]
    """
    mates = addendum[..., ::-1]
    if ring:
        mates = np.stack([addendum.max(axis=-1), addendum[..., 0]], axis=-1)
    return mates + _USUAL_CLEARANCE


def usual_depths(
    addendum: tuple[float, float],
    dedendum: tuple[float, float] | None,
    fillet: tuple[float, float] | None,
    angle: float,
    *,
    ring: bool = False,
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Dedenda and fillet radii of two basic racks in modules, the usual ones where none are given.

    Args:
        addendum: of both racks, in modules.
        dedendum, fillet: as given; None where left open.
        angle: normal pressure angle [rad].
        ring: True if gear 2 is a ring, whose fillet is not that of a rack.

    Source: ISO 53:1998, profile A.
    """
    usual_of_pinion, usual_of_wheel = usual_dedenda(np.array(addendum), ring=ring).tolist()
    depth = dedendum or (usual_of_pinion, usual_of_wheel)
    return depth, fillet or (usual_fillet(depth[0], angle), usual_fillet(depth[1], angle))


def involute(angle: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Involute function inv(alpha) = tan(alpha) - alpha [rad].

    Source: ISO 21771:2007, involute function.
    """
    return jnp.tan(angle) - angle


def inverse_involute(value: Float[Array, ""]) -> Float[Array, ""]:
    """Angle [rad] whose involute function is `value`, for value > 0.

    Source: ISO 21771:2007, involute function, inverted by Newton's method.
    """
    guess = jnp.arctan(value + jnp.minimum(jnp.cbrt(3.0 * value), 1.5))
    return find_root(lambda angle: involute(angle) / value - 1.0, guess, jnp.pi / 2.0)[0]


def transverse_angle(
    pressure_angle: Float[Array, ""], helix_angle: Float[Array, ""]
) -> Float[Array, ""]:
    """Pressure angle in the transverse section alpha_t [rad] from the normal one and the helix angle.

    Source: ISO 21771:2007, tan(alpha_t) = tan(alpha_n)/cos(beta).
    """
    return jnp.arctan(jnp.tan(pressure_angle) / jnp.cos(helix_angle))


def base_helix(pressure_angle: Float[Array, ""], helix_angle: Float[Array, ""]) -> Float[Array, ""]:
    """Helix angle on the base cylinder beta_b [rad] from the normal pressure angle and the helix angle.

    Source: ISO 21771:2007, sin(beta_b) = sin(beta) cos(alpha_n).
    """
    return jnp.arcsin(jnp.sin(helix_angle) * jnp.cos(pressure_angle))


class InvoluteGear(eqx.Module):
    """One cylindrical gear: an external one cut by a basic rack, or a ring with internal teeth.

    Circles and outline are those of the transverse section. A ring has a negative number of teeth
    and negative radii (ISO 21771); its fillet is that of a pinion cutter, or without one a circular arc that
    touches flank and root circle, since no rack cuts it.

    Attributes:
        teeth: number of teeth z, negative for a ring.
        module: normal module m_n [m].
        pressure_angle: normal pressure angle alpha_n of the basic rack [rad].
        helix_angle: beta on the reference cylinder, without its hand [rad].
        profile_shift: coefficient x.
        tip_alteration: coefficient k; negative shortens the tip (ISO 21771).
        addendum, dedendum, fillet_radius: of the basic rack, in normal modules (h_aP*, h_fP*, rho_fP*); the
            radius is that of the arc of a ring, or of the tip corners of its cutter rho_a0*.
        undercut: True if the rack undercuts the flank; static, so that sound gears compile to little.
        crossing: normal angle of the fillet point where an undercut crosses the involute [rad], as
            `crossing_angle` finds it; any value without undercut.
        internal: True for a ring; static.
        cutter_teeth, cutter_shift: z_0 and x_0 of the pinion cutter of a ring; None without one.
    """

    teeth: Float[Array, ""]
    module: Float[Array, ""]
    pressure_angle: Float[Array, ""]
    helix_angle: Float[Array, ""]
    profile_shift: Float[Array, ""]
    tip_alteration: Float[Array, ""]
    addendum: Float[Array, ""]
    dedendum: Float[Array, ""]
    fillet_radius: Float[Array, ""]
    undercut: bool = eqx.field(static=True)
    crossing: Float[Array, ""]
    internal: bool = eqx.field(static=True)
    cutter_teeth: Float[Array, ""] | None = None
    cutter_shift: Float[Array, ""] | None = None

    @property
    def side(self) -> float:
        """1 for an external gear, -1 for a ring."""
        return -1.0 if self.internal else 1.0

    @property
    def transverse_pressure_angle(self) -> Float[Array, ""]:
        """Pressure angle in the transverse section alpha_t [rad]."""
        return transverse_angle(self.pressure_angle, self.helix_angle)

    @property
    def base_helix_angle(self) -> Float[Array, ""]:
        """Helix angle on the base cylinder beta_b [rad]."""
        return base_helix(self.pressure_angle, self.helix_angle)

    @property
    def reference_radius(self) -> Float[Array, ""]:
        """Radius of the reference circle r = z m_n / (2 cos beta) [m]."""
        return self.teeth * self.module / (2.0 * jnp.cos(self.helix_angle))

    @property
    def base_radius(self) -> Float[Array, ""]:
        """Radius of the base circle [m]."""
        return self.reference_radius * jnp.cos(self.transverse_pressure_angle)

    @property
    def tip_radius(self) -> Float[Array, ""]:
        """Radius of the tip circle [m]: r + m (h_aP* + x + k)."""
        return self.reference_radius + self.module * (
            self.addendum + self.profile_shift + self.tip_alteration
        )

    @property
    def root_radius(self) -> Float[Array, ""]:
        """Radius of the root circle [m]: r - m (h_fP* - x)."""
        return self.reference_radius - self.module * (self.dedendum - self.profile_shift)

    @property
    def undercut_limit(self) -> Float[Array, ""]:
        """Smallest profile shift without undercut: the straight rack flank ends on the base tangent."""
        straight = self.dedendum - self.fillet_radius * (1.0 - jnp.sin(self.pressure_angle))
        sine = jnp.sin(self.transverse_pressure_angle)
        return straight - self.teeth * sine**2 / (2.0 * jnp.cos(self.helix_angle))

    @property
    def form_roll_length(self) -> Float[Array, ""]:
        """Involute length at the form circle, where fillet and involute meet [m].

        Without undercut the rack's straight flank ends there; with undercut fillet and involute cross;
        in a ring the arc of the fillet touches the involute there, or the cutter's flank ends.
        """
        if self.cutting is not None:
            return self.cutting.form_roll_length
        if self.internal:
            rounding = self.fillet_radius * self.module
            centre = jnp.abs(self.root_radius) - rounding
            return rounding + jnp.sqrt(centre**2 - self.base_radius**2)
        if not self.undercut:
            margin = self.profile_shift - self.undercut_limit
            return margin * self.module / jnp.sin(self.transverse_pressure_angle)
        radius = self._point(self._fillet_end)[0]
        return jnp.sqrt(jnp.maximum(radius**2 - self.base_radius**2, 1e-30))

    @property
    def tip_roll_length(self) -> Float[Array, ""]:
        """Involute length at the tip circle [m]."""
        return jnp.sqrt(self.tip_radius**2 - self.base_radius**2)

    @property
    def pitch_half_angle(self) -> Float[Array, ""]:
        """Half the angle of one tooth and one space [rad]."""
        return jnp.pi / jnp.abs(self.teeth)

    def half_thickness_angle(self, radius: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Half the tooth's angle [rad] at a radius [m] on the involute; negative beyond the pointed tip.

        Args:
            radius: with or without the sign of a ring's radii.
        """
        cosine = jnp.clip(jnp.abs(self.base_radius / radius), 0.0, 1.0)
        at_reference = jnp.pi / 2.0 + 2.0 * self.profile_shift * jnp.tan(self.pressure_angle)
        angle = self.transverse_pressure_angle
        return self.side * (
            at_reference / self.teeth + involute(angle) - involute(jnp.arccos(cosine))
        )

    @property
    def tip_thickness(self) -> Float[Array, ""]:
        """Tooth thickness on the tip circle in the normal section s_an [m]; negative beyond the point."""
        transverse = 2.0 * jnp.abs(self.tip_radius) * self.half_thickness_angle(self.tip_radius)
        tangent = jnp.tan(self.helix_angle) * self.tip_radius / self.reference_radius
        return transverse / jnp.sqrt(1.0 + tangent**2)

    @property
    def virtual_spur_gear(self) -> Self:
        """Spur gear with the teeth of the normal section: z_n = z/(cos^2 beta_b cos beta).

        Its base circle makes curvatures those of the flank lines' normal section; where a rack
        undercuts the helical gear, it undercuts this one.

        Source: ISO 21771:2007, virtual number of teeth.
        """
        scale = 1.0 / (jnp.cos(self.base_helix_angle) ** 2 * jnp.cos(self.helix_angle))
        number = self.teeth * scale
        gear = dataclasses.replace(self, teeth=number, helix_angle=jnp.zeros_like(number))
        if self.cutter_teeth is not None:
            gear = dataclasses.replace(gear, cutter_teeth=self.cutter_teeth * scale)
        if self.undercut:
            gear = dataclasses.replace(gear, crossing=gear.crossing_angle())
        return gear

    def section(self, rim_ratio: Float[Array, ""]) -> ToothSection:
        """Tooth in the normal section, as a beam on its body.

        It is that of the virtual spur gear, with the real tooth's height over the reference circle.

        Args:
            rim_ratio: root radius over bore radius.
        """
        normal = self.virtual_spur_gear
        unit, weight = gauss(FILLET_STATIONS)
        points, slopes = jax.jvp(normal._fillet_place, (unit,), (jnp.ones_like(unit),))
        ends = jnp.stack([normal.form_roll_length, normal.tip_roll_length])
        span = (ends[1] - ends[0]) / 2.0
        length = ends[0] + span * (jnp.asarray(chebyshev_nodes()) + 1.0)
        reach = jnp.stack([self.form_roll_length, self.tip_roll_length])
        flank, slope = jax.jvp(normal._flank_place, (length,), (jnp.ones_like(length),))
        start = normal._fillet(jnp.zeros(1))
        return ToothSection(
            fillet=points,
            step=slopes[1] * weight,
            flank=flank,
            slope=slope[1] * span,
            load_angle=normal._load_angle(length),
            reach=reach / jnp.sqrt(2.0 * jnp.abs(self.base_radius)),
            root_radius=jnp.abs(normal.root_radius),
            root_half_angle=start[1, 0],
            rim_ratio=rim_ratio,
            stiff=RING_RIM if self.internal else "",
        )

    def outline(self, count: int = 24) -> Float[Array, "point 2"]:
        """One tooth with half a space on each side, tooth axis along y, origin at the gear's centre [m].

        Args:
            count: points on each fillet, involute and arc.
        """
        unit = jnp.linspace(0.0, 1.0, count)
        fillet = self._fillet(unit)
        lengths = self.form_roll_length + (self.tip_roll_length - self.form_roll_length) * unit
        flank_radius = hypot(self.base_radius, lengths)
        flank = jnp.stack([flank_radius, self.half_thickness_angle(flank_radius)])
        tip = jnp.stack([jnp.full(count, jnp.abs(self.tip_radius)), flank[1, -1] * (1.0 - unit)])
        half = self.pitch_half_angle
        base = jnp.stack(
            [jnp.full(count, jnp.abs(self.root_radius)), half + (fillet[1, 0] - half) * unit]
        )
        side = jnp.concatenate([base, fillet, flank, tip], axis=1)
        tooth = jnp.concatenate([side * jnp.array([[1.0], [-1.0]]), jnp.flip(side, axis=1)], axis=1)
        return jnp.stack([tooth[0] * jnp.sin(tooth[1]), tooth[0] * jnp.cos(tooth[1])], axis=-1)

    def _flank_place(self, length: Float[Array, " point"]) -> Float[Array, "2 point"]:
        """Half thickness and height of the involute at roll lengths [m]."""
        radius = hypot(self.base_radius, length)
        return self._place(jnp.stack([radius, self.half_thickness_angle(radius)]))

    def _fillet_place(self, unit: Float[Array, " point"]) -> Float[Array, "2 point"]:
        """Half thickness and height of the fillet [m], from the root at 0 to the involute at 1."""
        return self._place(self._fillet(unit))

    def _place(self, polar: Float[Array, "2 point"]) -> Float[Array, "2 point"]:
        radius, angle = polar
        return jnp.stack([radius * jnp.sin(angle), self.side * radius * jnp.cos(angle)])

    def _load_angle(self, length: Float[Array, " point"]) -> Float[Array, " point"]:
        """Angle between the flank's normal and the perpendicular to the tooth's axis [rad]."""
        base = jnp.abs(self.base_radius)
        half = self.half_thickness_angle(hypot(base, length))
        return jnp.arctan(length / base) - self.side * half

    def _fillet(self, unit: Float[Array, " point"]) -> Float[Array, "2 point"]:
        """Radius and angle from the tooth axis along the fillet, from the root at 0 to the involute at 1."""
        if self.internal:
            return self._ring_fillet(unit)
        angle = jnp.pi / 2.0 + (self._fillet_end - jnp.pi / 2.0) * unit
        radius, from_space = self._point(angle)
        return jnp.stack([radius, self.pitch_half_angle - from_space])

    def _ring_fillet(self, unit: Float[Array, " point"]) -> Float[Array, "2 point"]:
        """Arc between root circle and involute of a ring, or what its cutter leaves, see `_fillet`."""
        if self.cutting is not None:
            return self.cutting.fillet(unit)
        rounding = self.fillet_radius * self.module
        tangent, centre = self._ring_fillet_angles
        distance = jnp.abs(self.root_radius) - rounding
        # Seen from its centre the arc runs from the radial direction to the normal of the flank.
        turn = centre + (tangent + jnp.pi / 2.0 - centre) * unit
        along = distance * jnp.cos(centre) + rounding * jnp.cos(turn)
        across = distance * jnp.sin(centre) + rounding * jnp.sin(turn)
        return jnp.stack([hypot(along, across), self.pitch_half_angle - jnp.arctan2(across, along)])

    @property
    def _ring_fillet_angles(self) -> tuple[Float[Array, ""], Float[Array, ""]]:
        """Angles from the space's axis to the form circle's base tangent point and to the arc's centre."""
        base, form = jnp.abs(self.base_radius), self.form_roll_length
        radius = hypot(base, form)
        space = self.pitch_half_angle - self.half_thickness_angle(radius)
        tangent = space - jnp.arctan(form / base)
        return tangent, tangent + jnp.arctan((form - self.fillet_radius * self.module) / base)

    def ring_tangent(self, angle: float | Float[Array, ""]) -> Float[Array, "3"]:
        """Where the tangent to the fillet of a ring makes an angle with the middle of the tooth.

        Args:
            angle: between that of the flank and a right angle [rad].

        Returns:
            Distance from the middle of the tooth, along it from the axis of the ring, and radius [m].
        """
        if self.cutting is not None:
            return self.cutting.tangent(angle)
        rounding = self.fillet_radius * self.module
        distance = jnp.abs(self.root_radius) - rounding
        centre = self.pitch_half_angle - self._ring_fillet_angles[1]
        across = distance * jnp.sin(centre) - rounding * jnp.cos(angle)
        along = distance * jnp.cos(centre) + rounding * jnp.sin(angle)
        return jnp.stack([across, along, rounding])

    @property
    def cutting(self) -> PinionCutting | None:
        """The pinion cutter of a ring where it has cut to the root circle; None without one.

        Not a number where the flanks of both fit at no distance between their axes.

        Source: ISO 21771:2007, inv(alpha_w0) = inv(alpha_t) + 2 tan(alpha_n) (x + x_0)/(z + z_0).
        """
        if self.cutter_teeth is None or self.cutter_shift is None:
            return None
        transverse, slope = self.transverse_pressure_angle, 2.0 * jnp.tan(self.pressure_angle)
        together = slope * (self.profile_shift + self.cutter_shift)
        value = involute(transverse) + together / (self.teeth + self.cutter_teeth)
        working = inverse_involute(jnp.where(value > 0.0, value, jnp.nan))
        base = self.cutter_teeth / jnp.abs(self.teeth) * jnp.abs(self.base_radius)
        distance = (jnp.abs(self.base_radius) - base) / jnp.cos(working)
        thickness = (jnp.pi / 2.0 + slope * self.cutter_shift) / self.cutter_teeth
        return PinionCutting(
            base_radius=base,
            tip_radius=jnp.abs(self.root_radius) - distance,
            rounding=self.fillet_radius * self.module,
            base_half_angle=thickness + involute(transverse),
            working_pressure_angle=working,
            distance=distance,
            ratio=self.cutter_teeth / jnp.abs(self.teeth),
            half_pitch=self.pitch_half_angle,
        )

    @property
    def root_land_angle(self) -> Float[Array, ""]:
        """Half the angle of the root circle between two fillets [rad]; negative if they do not fit."""
        if self.cutting is not None:
            return self.cutting.root_land_angle
        return self.pitch_half_angle - self._fillet(jnp.zeros(1))[1, 0]

    def _point(self, angle: Float[Array, "*b"]) -> tuple[Float[Array, "*b"], Float[Array, "*b"]]:
        """Fillet point cut by the point of the rack's corner whose normal makes `angle` with the pitch line.

        The angle is that of the normal section, where the corner is an arc; the transverse section
        stretches the rack along the pitch line by 1/cos(beta).

        Returns:
            Radius, and angle from the space axis.
        """
        stretch = 1.0 / jnp.cos(self.helix_angle)
        rounding = self.fillet_radius * self.module
        depth = (self.dedendum - self.profile_shift - self.fillet_radius) * self.module
        corner = stretch * (
            jnp.pi * self.module / 4.0
            - (self.dedendum - self.fillet_radius) * self.module * jnp.tan(self.pressure_angle)
            - rounding / jnp.cos(self.pressure_angle)
        )
        cosine, sine = jnp.cos(angle), jnp.sin(angle)
        below = depth + rounding * sine
        x = below * cosine / (sine * stretch)  # the normal passes through the pitch point
        centre = x - stretch * rounding * cosine
        y = self.reference_radius - below
        return hypot(x, y), jnp.arctan2(x, y) - (centre - corner) / self.reference_radius

    def crossing_angle(self) -> Float[Array, ""]:
        """Normal angle of the fillet point where an undercut crosses the involute [rad]."""
        # Clustered at the rack angle: a slight undercut crosses close to it.
        span = jnp.pi / 2.0 - self.pressure_angle
        scan = self.pressure_angle + span * jnp.linspace(0, 1, 200) ** 3
        first_crossed = jnp.argmax(self._removed(scan[1:]) > 0.0)
        guess = (scan[first_crossed] + scan[first_crossed + 1]) / 2.0 - self.pressure_angle
        beyond, _ = find_root(lambda x: self._removed(self.pressure_angle + x), guess, span)
        return self.pressure_angle + beyond

    @property
    def _fillet_end(self) -> Float[Array, ""]:
        """Normal angle of the fillet point where the involute begins.

        One Newton step from the stored crossing, so that it follows the dimensions to first order
        and gradients see them.
        """
        if not self.undercut:
            return self.pressure_angle
        stored = jax.lax.stop_gradient(self.crossing)
        value, slope = jax.jvp(self._removed, (stored,), (jnp.ones_like(stored),))
        return jnp.asarray(stored - value / jax.lax.stop_gradient(slope))

    def _removed(self, angle: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Angle by which the fillet point lies inside the tooth that the involute bounds [rad]."""
        radius, from_space = self._point(angle)
        radius = jnp.maximum(radius, self.base_radius * (1.0 + 1e-15))
        return from_space - (self.pitch_half_angle - self.half_thickness_angle(radius))


@cache
def gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre nodes and weights on [0, 1].

    Source: Abramowitz and Stegun (1964), eq. 25.4.30, Gauss' formula on any interval.
    """
    x, weight = np.polynomial.legendre.leggauss(count)
    return (x + 1.0) / 2.0, weight / 2.0
