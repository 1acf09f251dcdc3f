"""Span, dimension over balls and backlash of cylindrical gears, against prints and against drawn flanks."""

from itertools import pairwise
from math import acos, cos, degrees, hypot, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from scipy.optimize import brentq, minimize, minimize_scalar

from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.drawing_dimensions import (
    Toothing,
    backlash,
    backlash_limits,
    scalar_involute,
)
from pitchpoint.gears.cylindrical.iso_286 import standard_tolerance, symmetrical_deviation
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances
from pitchpoint.gears.mesh_bodies import disc

MM = 1e-3


def gear(teeth, module=1.0, helix=0.0, shift=0.0, angle=20.0):
    return Toothing(teeth, module * MM, radians(angle), radians(helix), shift)


# ---- as printed


@pytest.mark.parametrize(
    ("one", "count", "printed"),
    [
        # KHK, Gear Technical Reference: spur gear of table 5.10; the helical one is recalled from there
        (gear(24, 3.0, 0.0, 0.4), 4, 32.8266),
        (gear(24, 3.0, 25.0, 0.4), 5, 42.0085),
    ],
)
def test_spans_as_printed(one, count, printed) -> None:
    assert one.span(count) / MM == pytest.approx(printed, abs=6e-5)


def test_dimension_over_pins_as_printed() -> None:
    # KHK, Gear Technical Reference, recalled: z = 20, module 1, pins of 1.7 mm
    assert degrees(gear(20).ball_angle(1.7 * MM)) == pytest.approx(24.1350, abs=6e-5)
    assert gear(20).over_balls(1.7 * MM) / MM == pytest.approx(22.2941, abs=6e-5)


@pytest.mark.parametrize(
    ("teeth", "thickness", "span", "balls"),
    [(51, 1.719, 17.090, 53.846), (52, 1.800, 17.180, 55.064)],
)
def test_a_thickness_gives_both_dimensions_of_a_printed_record(
    teeth, thickness, span, balls
) -> None:
    # a record of the program STplus (pair 51/52 of plastic, module 1, balls of 1.75 mm), three decimals each
    plain = gear(teeth)
    one = plain.thinned(thickness * MM - plain.normal_thickness)
    rounding = 0.5e-3  # of the thickness, 2.5 times as much over balls
    assert one.span(6) / MM == pytest.approx(span, abs=2 * rounding)
    assert one.over_balls(1.75 * MM) / MM == pytest.approx(balls, abs=3.5 * rounding)


def test_the_backlash_of_that_record() -> None:
    # allowances -296 and -220 um, its centre distance +-15 um moves the backlash by 12 and 11 um
    pair = [gear(z).thinned(s * MM - gear(z).normal_thickness) for z, s in ((51, 1.719), (52, 1.8))]
    shift = pair[0].profile_shift + pair[1].profile_shift
    working = brentq(
        lambda a: (
            scalar_involute(a) - scalar_involute(radians(20)) - 2 * tan(radians(20)) * shift / 103
        ),
        0.1,
        1.0,
    )
    distance = 51.5 * MM * cos(radians(20)) / cos(working)
    thin = [one.thinned(s * MM) for one, s in zip(pair, (-0.296, -0.220), strict=True)]
    plays = [backlash(*thin, distance + d * MM) for d in (-0.015, 0.0, 0.015)]
    assert plays[1].circumferential / MM == pytest.approx(0.521, abs=1.5e-3)
    assert plays[1].normal / MM == pytest.approx(0.485, abs=1.5e-3)
    assert (plays[2].circumferential - plays[1].circumferential) / MM == pytest.approx(
        0.0115, abs=6e-4
    )


# ---- a second way: flanks as points in space, plates and balls laid against them


def flank(one: Toothing, roll, tooth: int = 0, sign: float = 1.0, along=0.0):
    """Point of the right (sign 1) or left flank of a tooth, whose axis points along y at z = 0."""
    base = abs(one.base_radius)
    radius = np.hypot(base, roll)
    angle = sign * np.array([one.half_thickness_angle(r) for r in np.ravel(radius)])
    twist = along * tan(one.helix_angle) / abs(one.reference_radius)
    turned = np.reshape(angle, np.shape(radius)) + 2.0 * pi * tooth / abs(one.teeth) + twist
    return np.stack([radius * np.sin(turned), radius * np.cos(turned), along + 0.0 * radius])


@pytest.mark.parametrize(
    ("one", "count"),
    [(gear(24, 3.0, 0.0, 0.4), 4), (gear(17, 2.0), 2), (gear(61, 1.0, 0.0, -0.3), 7)],
)
def test_a_span_is_the_distance_of_parallel_plates(one, count) -> None:
    middle = pi * (count - 1) / one.teeth  # of the teeth between the plates
    across = np.array([cos(middle), -sin(middle), 0.0])

    def reach(tooth, sign):
        found = minimize_scalar(
            lambda roll: -sign * across @ flank(one, roll, tooth, sign),
            bounds=(0.2 * one.span_roll(count), 2.0 * one.span_roll(count)),
            options={"xatol": 1e-12},
        )
        return -found.fun, found.x

    (right, at), (left, _) = reach(count - 1, 1.0), reach(0, -1.0)
    assert right + left == pytest.approx(one.span(count), rel=1e-9)
    assert at == pytest.approx(one.span_roll(count), rel=1e-4)


@pytest.mark.parametrize(
    ("one", "ball"),
    [
        (gear(20), 1.7),
        (gear(23, 2.0, 0.0, 0.4), 3.5),
        (gear(24, 3.0, 25.0, 0.4), 5.5),
        (gear(7, 1.0, 35.0, 0.5), 2.1),
        (gear(-60, 3.0), 5.0),
        (gear(-61, 3.0, 0.0, 0.2), 5.0),
        (gear(-80, 2.0, 20.0, -0.1), 3.4),
    ],
)
def test_balls_touch_the_flanks_on_both_sides(one, ball) -> None:
    """A ball on the axis of a tooth space, laid numerically against the flank beside it."""
    half, space = ball * MM / 2.0, pi / abs(one.teeth)
    guess = one.ball_roll(ball * MM)

    def nearest(radius):
        centre = radius * np.array([sin(space), cos(space), 0.0])
        away = lambda at: hypot(*(flank(one, at[0] * guess, along=at[1] * half) - centre))  # noqa: E731
        found = minimize(lambda at: away(at) / half, [0.9, 0.0], options={"gtol": 1e-10})
        return found.fun * half, found.x[0] * guess

    near = one.ball_reach(ball * MM) - one.side * half
    centre = brentq(
        lambda r: nearest(r)[0] - half, near - 0.3 * half, near + 0.3 * half, xtol=1e-12
    )
    opposite = 2.0 * pi / abs(one.teeth) * (abs(one.teeth) // 2)
    across = hypot(centre * (1.0 - cos(opposite)), centre * sin(opposite))
    assert across + one.side * 2.0 * half == pytest.approx(one.over_balls(ball * MM), abs=2e-10)
    assert nearest(centre)[1] == pytest.approx(guess, rel=2e-4)


@pytest.mark.parametrize("one", [gear(20), gear(23, 2.0, 0.0, 0.4), gear(-60, 3.0, 0.0, 0.2)])
def test_usual_tools_touch_where_asked(one) -> None:
    roll = sqrt(one.reference_radius**2 - one.base_radius**2)
    exact = one._touching(roll)
    assert one.ball_roll(exact) == pytest.approx(roll, rel=1e-12)
    assert exact <= one.usual_ball(roll) <= 1.1 * exact
    if one.side > 0.0:
        count = one.usual_span(roll)
        others = [abs(one.span_roll(k) - roll) for k in (count - 1, count, count + 1)]
        assert min(others) == others[1]


# ---- thickness and backlash


@pytest.mark.parametrize(
    "one", [gear(24, 3.0, 0.0, 0.4), gear(31, 2.0, 20.0, -0.1), gear(-60, 3.0)]
)
def test_an_allowance_is_one_of_the_thickness(one) -> None:
    thin = one.thinned(-50e-6)
    assert thin.normal_thickness - one.normal_thickness == pytest.approx(-50e-6)
    radius = abs(one.reference_radius)
    lost = 2.0 * radius * (thin.half_thickness_angle(radius) - one.half_thickness_angle(radius))
    assert lost * cos(one.helix_angle) == pytest.approx(-50e-6)
    if one.side > 0.0:
        lost = thin.span(4) - one.span(4)
        assert lost == pytest.approx(-50e-6 * cos(one.pressure_angle))


@pytest.mark.parametrize(
    ("first", "second", "more"),
    [
        (gear(20, 2.0), gear(61, 2.0), 30e-6),
        (gear(20, 2.0, 18.0), gear(61, 2.0, 18.0), 30e-6),
        (gear(20, 2.0), gear(-70, 2.0), -30e-6),
    ],
)
def test_backlash_by_centre_distance(first, second, more) -> None:
    """Of unshifted gears 2 a (inv(alpha_w) - inv(alpha_t)), by the difference of both circles of a ring."""
    nominal = abs(first.reference_radius + second.reference_radius)
    assert backlash(first, second, nominal).circumferential == pytest.approx(0.0, abs=1e-15)
    distance = nominal + more
    working = acos(abs(first.base_radius + second.base_radius) / distance)
    wider = scalar_involute(working) - scalar_involute(first.transverse_pressure_angle)
    signed = distance if second.side > 0.0 else -distance
    play = backlash(first, second, distance)
    assert play.circumferential == pytest.approx(2.0 * signed * wider, rel=1e-9)
    assert play.circumferential > 0.0
    assert play.normal == pytest.approx(
        play.circumferential * cos(working) * cos(first.base_helix_angle)
    )
    # turned through its angle each flank of a gear travels by the same way along the line of action
    ways = [
        angle * abs(g.base_radius) for angle, g in zip(play.angular, (first, second), strict=True)
    ]
    assert ways[0] == pytest.approx(ways[1])
    assert ways[0] * cos(first.base_helix_angle) == pytest.approx(play.normal)


@pytest.mark.parametrize(
    ("second", "distance"), [(gear(61, 2.0, 0.0, -0.1), 81.05), (gear(-70, 2.0, 0.0, -0.1), 49.95)]
)
def test_backlash_is_the_turn_until_drawn_flanks_meet(second, distance) -> None:
    """A tooth of gear 1 as points in a space of gear 2, which turns until the first of them touches."""
    first = gear(20, 2.0, 0.0, 0.1).thinned(-60e-6)
    rolls = np.linspace(2e-3, 12e-3, 20001)
    x, y, _ = flank(first, rolls)
    up = distance * MM - y if second.side > 0.0 else distance * MM + y
    radius, angle = np.hypot(x, up), np.arctan2(x, up)
    on = radius > 1.001 * abs(second.base_radius)
    space = pi / abs(second.teeth) - np.array([second.half_thickness_angle(r) for r in radius[on]])
    turn = 2.0 * (space - angle[on]).min()  # to either side
    play = backlash(first, second, distance * MM)
    assert play.angular[1] == pytest.approx(turn, rel=1e-5)
    assert turn > 0.0


@pytest.mark.parametrize("second", [gear(61, 2.0), gear(-70, 2.0)])
def test_limits_enclose_every_pair_within_tolerance(second) -> None:
    first, rng = gear(20, 2.0), np.random.default_rng(3)
    distance = abs(first.reference_radius + second.reference_radius)
    upper, lower, deviation = (-40e-6, -50e-6), (-70e-6, -90e-6), 15e-6
    limits = {"upper": upper, "lower": lower, "deviation": deviation}
    least, mean, most = backlash_limits(first, second, distance, **limits)
    found = [
        backlash(
            *(
                g.thinned(s)
                for g, s in zip((first, second), rng.uniform(lower, upper), strict=True)
            ),
            distance + rng.uniform(-deviation, deviation),
        ).normal
        for _ in range(200)
    ]
    assert least.normal <= min(found) < max(found) <= most.normal
    assert mean.normal == pytest.approx((least.normal + most.normal) / 2.0, rel=2e-3)
    # of the normal tooth thickness each allowance takes its cosine along the normal
    assert mean.normal == pytest.approx(125e-6 * cos(radians(20)), rel=2e-3)


# ---- tables


def test_standard_tolerances_follow_their_formula() -> None:
    """Multiples of i = 0.45 D^(1/3) + 0.001 D, D in mm, but for their rounding."""
    ends = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
    for low, high in pairwise(ends):
        mean = sqrt(low * high)
        unit = 0.45 * mean ** (1 / 3) + 0.001 * mean
        for grade, times in ((6, 10), (7, 16), (8, 25), (9, 40)):
            found = standard_tolerance(grade=grade, size=high * MM) * 1e6
            assert found == pytest.approx(times * unit, rel=0.06, abs=0.7)
    assert symmetrical_deviation("js7", 0.084) == pytest.approx(17.5e-6)
    assert symmetrical_deviation("js7", 0.080) == pytest.approx(15e-6)
    with pytest.raises(InputError, match="longer than 500 mm"):
        standard_tolerance(grade=7, size=0.501)


def test_total_tolerances_are_of_unrounded_parts() -> None:
    found = flank_tolerances(tolerance_class=6, diameter=0.120, module=3e-3, face_width=0.03)
    assert found.profile_total == pytest.approx(12e-6)
    assert found.single_pitch == pytest.approx(9e-6)
    assert found.total_pitch == pytest.approx(29e-6)
    # slope 9.12 and form 10.0 before they are rounded
    slope = (0.05 * sqrt(120) + 0.35 * sqrt(30) + 4) * sqrt(2)
    form = (0.07 * sqrt(120) + 0.45 * sqrt(30) + 4) * sqrt(2)
    assert found.helix_total == pytest.approx(round(hypot(slope, form)) * 1e-6)


def test_a_disc_is_two_cylinders() -> None:
    whole = disc(density=7850.0, width=0.02, outer=0.05, inner=0.0)
    core = disc(density=7850.0, width=0.02, outer=0.015, inner=0.0)
    ring = disc(density=7850.0, width=0.02, outer=0.05, inner=0.015)
    assert ring == pytest.approx([a - b for a, b in zip(whole, core, strict=True)])
