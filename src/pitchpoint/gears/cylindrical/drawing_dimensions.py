"""What stands on the drawing of a cylindrical gear: span and dimension over balls; backlash of a pair."""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import acos, asin, atan, ceil, cos, floor, inf, log10, nan, pi, sin, tan

from pitchpoint.errors import InputError

__all__ = [
    "Backlash",
    "Toothing",
    "allowance_for",
    "backlash",
    "backlash_limits",
    "distance_without_backlash",
    "profile_shift_sum",
]


@dataclass(frozen=True)
class Toothing:
    """One involute gear as it is measured, in plain numbers.

    Attributes:
        teeth: number z, negative for a ring, whose radii are negative too (ISO 21771).
        module: normal module m_n [m].
        pressure_angle: normal pressure angle alpha_n of the basic rack [rad].
        helix_angle: beta on the reference cylinder, without its hand [rad].
        profile_shift: coefficient x.

    Example:
        >>> from math import radians
        >>> gear = Toothing(24, 3e-3, radians(20.0), 0.0, 0.4)
        >>> round(1e3 * gear.span(4), 4)
        32.8266
    """

    teeth: float
    module: float
    pressure_angle: float
    helix_angle: float
    profile_shift: float

    @property
    def side(self) -> float:
        """1 for an external gear, -1 for a ring."""
        return 1.0 if self.teeth > 0 else -1.0

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """Pressure angle in the transverse section alpha_t [rad]."""
        return atan(tan(self.pressure_angle) / cos(self.helix_angle))

    @cached_property
    def base_helix_angle(self) -> float:
        """Helix angle on the base cylinder beta_b [rad]."""
        return asin(sin(self.helix_angle) * cos(self.pressure_angle))

    @property
    def reference_radius(self) -> float:
        """Radius of the reference circle r = z m_n/(2 cos beta) [m]."""
        return self.teeth * self.module / (2.0 * cos(self.helix_angle))

    @property
    def base_radius(self) -> float:
        """Radius of the base circle [m]."""
        return self.reference_radius * cos(self.transverse_pressure_angle)

    @property
    def normal_thickness(self) -> float:
        """Tooth thickness on the reference cylinder in the normal section s_n [m]."""
        return self.module * (pi / 2.0 + 2.0 * self.profile_shift * tan(self.pressure_angle))

    def thinned(self, allowance: float) -> "Toothing":
        """The gear with teeth whose thickness s_n differs by an allowance [m], thinner if it is negative.

        A flank that the same rack cuts deeper is the same involute, so it counts as a profile shift.
        """
        return replace(self, profile_shift=self.profile_shift + self.infeed(allowance))

    def infeed(self, allowance: float) -> float:
        """Profile shift x_E - x that changes the thickness s_n by an allowance [m]."""
        return allowance / (2.0 * self.module * tan(self.pressure_angle))

    def half_thickness_angle(self, radius: float) -> float:
        """Half the tooth's angle at a radius [m] on the involute [rad]."""
        flank = acos(abs(self.base_radius / radius))
        thicker = scalar_involute(self.transverse_pressure_angle) - scalar_involute(flank)
        return self.normal_thickness / (self.module * abs(self.teeth)) + self.side * thicker

    def span(self, count: float) -> float:
        """Span measurement W_k over so many teeth of an external gear [m].

        Source: ISO 21771:2007, base tangent length
        W_k = m_n cos(alpha_n) (pi (k - 1/2) + z inv(alpha_t)) + 2 x m_n sin(alpha_n).
        """
        teeth = pi * (count - 0.5) + self.teeth * scalar_involute(self.transverse_pressure_angle)
        shift = 2.0 * self.profile_shift * self.module * sin(self.pressure_angle)
        return self.module * cos(self.pressure_angle) * teeth + shift

    def span_roll(self, count: float) -> float:
        """Roll length at which the plates of a span touch, both flanks alike [m]."""
        return self.span(count) * cos(self.base_helix_angle) / 2.0

    def span_face(self, count: float) -> float:
        """Face width that a span bridges on a helical gear W_k sin(beta_b) [m]."""
        return self.span(count) * sin(self.base_helix_angle)

    def usual_span(self, roll: float) -> int:
        """Number of teeth whose span touches nearest to a roll length [m], two at least."""
        single_roll = self.span_roll(1.0)
        return max(2, 1 + round((roll - single_roll) / (self.span_roll(2.0) - single_roll)))

    def ball_angle(self, diameter: float) -> float:
        """Pressure angle at the centre of a ball in a tooth space [rad]; NaN where none lies.

        Args:
            diameter: of the ball, or of a pin between spur teeth [m].

        Source: ISO 21771:2007, with the sign that the number of teeth has
        inv(alpha_Kt) = inv(alpha_t) - (pi - s_n/m_n)/z + D/(z m_n cos(alpha_n)).
        """
        space = pi - self.normal_thickness / self.module
        ball = diameter / (self.module * cos(self.pressure_angle))
        return scalar_inverse_involute(
            scalar_involute(self.transverse_pressure_angle) + (ball - space) / self.teeth
        )

    def ball_roll(self, diameter: float) -> float:
        """Roll length at which a ball touches both flanks [m], see `ball_angle`."""
        centre = abs(self.base_radius) * tan(self.ball_angle(diameter))
        return centre - self.side * diameter / 2.0 * cos(self.base_helix_angle)

    def ball_reach(self, diameter: float) -> float:
        """Radius up to which a ball stands out, or into a ring [m], see `ball_angle`."""
        return self._ball_centre(diameter) + self.side * diameter / 2.0

    def over_balls(self, diameter: float) -> float:
        """Dimension over two balls, between them in a ring [m], see `ball_angle`.

        They lie in opposite spaces; with an odd number of teeth in those that are nearly opposite.
        """
        apart = cos(pi / (2.0 * self.teeth)) if self.teeth % 2 else 1.0
        return 2.0 * self._ball_centre(diameter) * apart + self.side * diameter

    def usual_ball(self, roll: float) -> float:
        """Diameter of a ball that touches near a roll length [m], rounded up to two digits [m].

        Exact but for the rounding with spur teeth; that of the virtual spur gear with helical ones.
        """
        slope = cos(self.base_helix_angle)
        number = self.teeth / (slope**2 * cos(self.helix_angle))
        return _rounded_up(replace(self, teeth=number, helix_angle=0.0)._touching(roll / slope))

    def _touching(self, roll: float) -> float:
        """Diameter of a pin that touches spur teeth at a roll length [m]."""
        radius = abs(self.base_radius)
        space = (pi - self.normal_thickness / self.module) / abs(self.teeth)
        angle = roll / radius + self.side * space - scalar_involute(self.pressure_angle)
        return 2.0 * self.side * (radius * tan(angle) - roll)

    def _ball_centre(self, diameter: float) -> float:
        return abs(self.base_radius) / cos(self.ball_angle(diameter))


@dataclass(frozen=True)
class Backlash:
    """Play of a pair whose gears turn about fixed axes, one of them held.

    Attributes:
        circumferential: on the pitch circles in operation j_wt [m].
        normal: along the normal of the flanks j_bn [m].
        angular: turn of each gear while the other one is held [rad].

    Source: ISO 21771:2007, circumferential, normal and angular backlash.
    """

    circumferential: float
    normal: float
    angular: tuple[float, float]


def backlash(first: Toothing, second: Toothing, centre_distance: float) -> Backlash:
    """Backlash of two gears at a centre distance [m], negative where their teeth do not fit.

    Args:
        first, second: gears of the same rack; the second may be a ring.
        centre_distance: positive [m].

    Source: ISO 21771:2007, j_bn = j_wt cos(alpha_wt) cos(beta_b); the pitch less both tooth thicknesses.

    Example:
        >>> from math import radians
        >>> from pitchpoint.gears.cylindrical.drawing_dimensions import Toothing
        >>> gear = Toothing(20, 1e-3, radians(20.0), 0.0, 0.0)
        >>> play = backlash(gear.thinned(-30e-6), gear.thinned(-40e-6), 0.02)
        >>> round(1e6 * play.circumferential, 3), round(1e6 * play.normal, 3)
        (70.0, 65.778)
    """
    gears, number = (first, second), abs(first.teeth + second.teeth)
    radii = [centre_distance * abs(gear.teeth) / number for gear in gears]
    free = [
        2.0 * radius * (pi / (2.0 * abs(gear.teeth)) - gear.half_thickness_angle(radius))
        for gear, radius in zip(gears, radii, strict=True)
    ]
    slope = abs(first.base_radius) / radii[0] * cos(first.base_helix_angle)
    play = sum(free)
    return Backlash(play, play * slope, (play / radii[0], play / radii[1]))


def backlash_limits(
    first: Toothing,
    second: Toothing,
    centre_distance: float,
    *,
    upper: tuple[float, float],
    lower: tuple[float, float],
    deviation: float,
) -> tuple[Backlash, Backlash, Backlash]:
    """Least, mean and largest backlash by tooth thickness and centre distance.

    Args:
        first, second: gears without allowances.
        centre_distance: nominal, positive [m].
        upper, lower: allowances of the normal tooth thickness of both gears A_sne, A_sni [m].
        deviation: by which the centre distance may be larger or smaller [m].

    Source: allowances of DIN 3967:1978, each with both ends of the centre distance, see `backlash`.
    """
    middle = ((upper[0] + lower[0]) / 2.0, (upper[1] + lower[1]) / 2.0)

    def at(allowances: tuple[float, float], distance: float) -> Backlash:
        return backlash(first.thinned(allowances[0]), second.thinned(allowances[1]), distance)

    ends = [
        at(allowances, centre_distance + sign * deviation)
        for allowances, sign in product((upper, lower), (-1.0, 1.0))
    ]
    ends.sort(key=lambda one: one.normal)
    return ends[0], at(middle, centre_distance), ends[-1]


def allowance_for(
    first: Toothing, second: Toothing, centre_distance: float, circumferential: float
) -> float:
    """Allowance of the normal thickness, alike for both gears, that leaves a backlash [m].

    Args:
        first, second: gears of the same rack without allowances; the second may be a ring.
        centre_distance: positive [m].
        circumferential: backlash j_wt that is wanted [m].

    Source: ISO 21771:2007, with s_n = m_n (pi/2 + 2 x tan(alpha_n)) on both gears j_wt falls by
    4 a/(m_n |z1 + z2|) of what both thicknesses grow by.

    Example:
        >>> from math import radians
        >>> from pitchpoint.gears.cylindrical.drawing_dimensions import Toothing
        >>> gear = Toothing(20, 1e-3, radians(20.0), 0.0, 0.0)
        >>> round(1e6 * allowance_for(gear, gear, 0.02, 70e-6), 3)
        -35.0
    """
    missing = circumferential - backlash(first, second, centre_distance).circumferential
    return -missing * first.module * abs(first.teeth + second.teeth) / (4.0 * centre_distance)


def distance_without_backlash(first: Toothing, second: Toothing) -> float:
    """Centre distance that leaves two gears of the same rack no backlash [m]; NaN where none does.

    Source: ISO 21771:2007, see `profile_shift_sum`.

    Example:
        >>> from math import radians
        >>> from pitchpoint.gears.cylindrical.drawing_dimensions import Toothing
        >>> gear = Toothing(20, 1e-3, radians(20.0), 0.0, 0.0)
        >>> round(distance_without_backlash(gear, gear), 9)
        0.02
    """
    shifts = 2.0 * tan(first.pressure_angle) * (first.profile_shift + second.profile_shift)
    value = scalar_involute(first.transverse_pressure_angle) + shifts / (first.teeth + second.teeth)
    return abs(first.base_radius + second.base_radius) / cos(scalar_inverse_involute(value))


def profile_shift_sum(
    *,
    teeth: tuple[float, float],
    module: float,
    pressure_angle: float,
    helix_angle: float,
    centre_distance: float,
) -> float:
    """Sum x1 + x2 of the profile shifts that leave no backlash at a centre distance.

    Args:
        teeth: z1, z2; z2 negative for a ring.
        module: normal module [m].
        pressure_angle, helix_angle: normal one, and that of the reference cylinders [rad].
        centre_distance: positive [m].

    Raises:
        InputError: a centre distance below the sum of the base radii.

    Source: ISO 21771:2007, inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) (x1 + x2)/(z1 + z2).

    Example:
        >>> from math import radians
        >>> common = {"module": 2e-3, "pressure_angle": radians(20.0), "helix_angle": 0.0}
        >>> round(profile_shift_sum(teeth=(20, -50), centre_distance=30.6e-3, **common), 4)
        -0.3212
    """
    total = teeth[0] + teeth[1]
    transverse = atan(tan(pressure_angle) / cos(helix_angle))
    least = abs(total) * module / (2.0 * cos(helix_angle)) * cos(transverse)
    if centre_distance <= least:
        raise InputError(
            f"the centre distance {1e3 * centre_distance:.8g} mm must be larger than that of the base "
            f"circles, {1e3 * least:.8g} mm",
            key="centre_distance",
        )
    working = acos(least / centre_distance)
    return (
        (scalar_involute(working) - scalar_involute(transverse))
        * total
        / (2.0 * tan(pressure_angle))
    )


def scalar_involute(angle: float) -> float:
    """Involute function inv(alpha) = tan(alpha) - alpha [rad].

    Source: ISO 21771:2007, involute function.
    """
    return tan(angle) - angle


def scalar_inverse_involute(value: float) -> float:
    """Angle whose involute function has a value [rad]; NaN where there is none below 86 degrees.

    Source: ISO 21771:2007, involute function, inverted by Newton's method.
    """
    largest_angle = 1.5
    if not 0.0 < value <= scalar_involute(largest_angle):
        return 0.0 if value == 0.0 else nan
    angle, before = min((3.0 * value) ** (1.0 / 3.0), largest_angle), inf
    while angle < before:  # Newton's steps from above only fall, as the curve bends upwards
        before, angle = angle, angle - (scalar_involute(angle) - value) / tan(angle) ** 2
    return before


def _rounded_up(value: float) -> float:
    """To two digits."""
    scale = 10.0 ** (1 - floor(log10(value)))
    return ceil(value * scale * (1.0 - 1e-12)) / scale
