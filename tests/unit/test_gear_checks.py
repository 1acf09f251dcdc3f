"""A bad pair of gears is told in gear words: which gear, which value, what is allowed."""

import dataclasses
import math
import re

import pytest

from pitchpoint._jax import jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import lanes_for_contact_ratio
from pitchpoint.gears.cylindrical.checks import check_cylindrical
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.pair import CylindricalPair


def build(teeth=(18, 36), degrees=20.0, **changes) -> CylindricalPair:
    common = {"module": 3e-3, "face_width": 20e-3, "pressure_angle": math.radians(degrees)}
    return build_cylindrical_pair(teeth=teeth, **(common | changes))


def refusal(teeth=(18, 36), degrees=20.0, **changes) -> InputError:
    with pytest.raises(InputError) as caught:
        check_cylindrical(build(teeth, degrees, **changes))
    return caught.value


CLEAN = [
    ((18, 36), {}),
    ((23, 61), {}),
    ((40, 3000), {}),  # nearly a rack: the tip reaches the form circle but for rounding
    ((12, 120), {"profile_shift": (0.5, 0.0)}),
    ((18, 36), {"centre_distance": 81.2e-3}),
    ((18, 36), {"centre_distance": 80.9999e-3}),  # rounded on a drawing
    ((18, 36), {"module": 0.3e-3}),
]


@pytest.mark.parametrize(("teeth", "changes"), CLEAN)
def test_sound_pairs_pass_in_silence(teeth, changes):
    assert check_cylindrical(build(teeth, **changes)) == []


BETA = math.radians(20.0)
RING = {"profile_shift": (0.3, -0.3), "addendum": (1.0, 0.8), "dedendum": (1.25, 1.25)} | {
    "fillet_radius": (0.38, 0.25)
}
FEW = {"module": 1.5e-3, "helix_angle": BETA, "face_width": 16e-3, "least_tip": 0.25} | {
    "profile_shift": (0.74, 0.05)
}
RING_CLEAN = [
    ((20, -60), {}),
    ((20, -60), {"helix_angle": BETA}),
    ((20, -60), {"centre_distance": 59.9e-3}),  # a ring has backlash at a smaller distance
    ((20, -60), {"centre_distance": 60.0001e-3}),  # rounded on a drawing
    ((50, -90), {}),
]


@pytest.mark.parametrize(("teeth", "changes"), RING_CLEAN)
def test_sound_rings_pass_in_silence(teeth, changes):
    assert check_cylindrical(build(teeth, **(RING | changes))) == []


def test_undercut_tells_limit_and_lost_contact_ratio():
    pair = build((12, 120))
    (text,) = check_cylindrical(pair)
    assert text.startswith("The undercut of gear 1 loses ")
    assert "profile shift 0 is below the limit 0.2981" in text  # 0.99998 - 6 sin(20 deg)^2
    assert "path of contact ends at its form circle" in text
    nominal = float(dataclasses.replace(pair, undercut=(False, False)).contact_ratio)
    lost = float(re.search(r"loses (\S+) of its contact ratio", text)[1])
    assert lost == pytest.approx(nominal - float(pair.contact_ratio), abs=0.005)


def test_slight_undercut_of_both_costs_nothing():
    texts = check_cylindrical(build((17, 17)))
    assert [text[:22] for text in texts] == ["The undercut of gear 1", "The undercut of gear 2"]
    assert all("limit 0.005657" in text and "loses no contact ratio" in text for text in texts)


LONG = {"profile_shift": (0.4, -0.2), "addendum": (1.4, 1.4), "fillet_radius": (0.2, 0.2)}


def test_thin_tip():
    pair = build((23, 61), **LONG)
    (text,) = check_cylindrical(pair)
    assert text.startswith("The teeth of gear 1 are 0.0249 modules thick at the tip; at least 0.2")
    assert float(pair.gears[0].tip_thickness) == pytest.approx(0.0249 * 3e-3, rel=2e-3)


@pytest.mark.parametrize(("dedendum", "gear", "mate"), [((1.25, 1.05), 1, 2), ((1.05, 1.25), 2, 1)])
def test_small_tip_clearance(dedendum, gear, mate):
    changes = {"dedendum": dedendum, "fillet_radius": (0.05, 0.05)}
    (text,) = check_cylindrical(build((30, 60), **changes))
    assert text == (
        f"The tip of gear {gear} clears the root of gear {mate} by 0.05 modules; "
        "at least 0.1 modules are usual."
    )


def test_overlap_ratio_alone_keeps_the_teeth_in_contact():
    (text,) = check_cylindrical(build((4, 51), **FEW))
    assert text == (
        "The transverse contact ratio of gear 1 and gear 2 is 0.888; it is the overlap ratio, "
        "1.16, that keeps the teeth in contact."
    )


def test_helical_gears_are_measured_in_normal_modules():
    text, _ = check_cylindrical(build((4, 51), **(FEW | {"least_tip": 0.1})))
    assert text == (
        "The teeth of gear 1 are 0.1 normal modules thick at the tip; "
        "at least 0.2 normal modules are usual."
    )


def test_a_tip_that_enters_a_fillet_by_little_runs_with_a_warning():
    (text,) = check_cylindrical(build((20, -60), **(RING | {"addendum": (1.0, 1.0)})))
    assert text == (
        "The tip of gear 2 enters the fillet of gear 1 by 0.0042 modules, which these figures leave "
        "out; a smaller fillet radius of gear 1 or a shorter addendum of gear 2 keeps it out."
    )


def test_a_tip_stays_within_the_base_circle_of_its_mate():
    """It would enter the fillet by 0.0038 modules only."""
    shallow = {"dedendum": (1.35, 1.25), "fillet_radius": (0.1, 0.2)}
    error = refusal((22, -58), profile_shift=(0.086, -0.074), addendum=(0.9, 1.16), **shallow)
    assert "reaches 0.22142839 mm" in error.message
    assert "beyond the point in which the line of action touches" in error.message


NREL = {"teeth": (18, 36), "module": 21e-3, "profile_shift": (0.389, 0.504)}


def test_a_printed_centre_distance_runs_where_it_is_too_small_by_what_is_rounded():
    (text,) = check_cylindrical(build(**NREL, centre_distance=0.584))
    assert "without backlash is 584.00229 mm, 2.29 um away, taken for what is rounded" in text


def test_allowances_that_leave_backlash_let_nominal_flanks_overlap():
    pair = build(**NREL, centre_distance=0.5838)
    (text,) = check_cylindrical(pair, least_backlash=1e-5)
    assert "their allowances leave a backlash of 10 um" in text
    with pytest.raises(InputError, match=r"overlap at .* and their allowances leave -10 um"):
        check_cylindrical(pair, least_backlash=-1e-5)


def test_an_overlap_tells_the_shifts_that_the_centre_distance_asks_for():
    """ISO 21771: x1 + x2 = (z1 + z2)/(2 tan 20) (inv alpha_w - inv 20), cos alpha_w = 30 cos 20/30.6."""
    changes = {"module": 2e-3, "addendum": (1.0, 0.8), "dedendum": (1.25, 1.25)}
    error = refusal((20, -50), centre_distance=30.6e-3, fillet_radius=(0.38, 0.2), **changes)
    assert "asks for profile shifts that sum to -0.3212 instead of 0" in error.message


def test_pinion_that_goes_into_its_ring_along_the_axis_only():
    (text,) = check_cylindrical(build((52, -60), **(RING | {"profile_shift": (0.3, -0.37)})))
    assert text == (
        "Gear 1 must be put into gear 2 along its axis: moved in radially, the tips overlap by "
        "up to 0.151 modules."
    )


def test_centre_distance_below_base_radii():
    error = refusal(centre_distance=70e-3)
    base_sum = 1.5 * 54 * math.cos(math.radians(20))
    assert error.key == "centre_distance"
    assert "centre distance 70 mm of gear 1 and gear 2" in error.message
    assert f"base radii, {base_sum:.8g} mm" in error.message
    assert "no working pressure angle" in error.message


@pytest.mark.parametrize("distance", [76.5e-3, 80.5e-3, 80.99e-3])
def test_overlapping_flanks(distance):
    error = refusal(centre_distance=distance)
    assert error.key == "centre_distance"
    assert "gear 1 and gear 2 overlap" in error.message
    assert f"{1e3 * distance:.8g} mm; these teeth need at least 81 mm" in error.message


def test_the_allowed_centre_distance_is_accepted_as_printed():
    shifted = {"profile_shift": (0.31, 0.17)}
    error = refusal(centre_distance=82e-3, **shifted)
    allowed = re.search(r"at least (\S+) mm", error.message)[1]
    assert check_cylindrical(build(centre_distance=float(allowed) / 1e3, **shifted)) == []


@pytest.mark.parametrize("distance", [60.01e-3, 61e-3])
def test_overlapping_flanks_of_a_ring(distance):
    error = refusal((20, -60), **RING, centre_distance=distance)
    assert error.key == "centre_distance"
    assert f"{1e3 * distance:.8g} mm; these teeth allow at most 60 mm" in error.message


def test_centre_distance_below_the_base_radii_of_a_ring():
    error = refusal((20, -60), **RING, centre_distance=55e-3)
    difference = 1.5 * 40 * math.cos(math.radians(20))
    assert f"than the difference of their base radii, {difference:.8g} mm" in error.message


def test_no_distance_without_backlash():
    error = refusal((12, 12), profile_shift=(-0.6, -0.6))
    assert error.key == "profile_shift"
    assert "gear 1 and gear 2 sum to -1.2, which must be above -0.4914" in error.message


def test_working_pressure_angle_out_of_reach():
    error = refusal((12, 12), profile_shift=(20.0, 20.0))
    assert error.key == "profile_shift"
    assert "sum to 40; the working pressure angle would be above 65 degrees" in error.message


REFUSED = [
    (
        {"dedendum": (1.25, 0.3)},
        "dedendum",
        "dedendum of gear 2 is 0.3 modules and must be larger than its fillet radius, 0.38",
    ),
    (
        {"dedendum": (2.3, 1.25)},
        "dedendum",
        "rack that cuts gear 1 has no tip left at the dedendum 2.3 modules; it may be 2.158",
    ),
    (
        {"fillet_radius": (0.38, 0.6)},  # ISO 53 allows 0.4719 at this dedendum
        "fillet_radius",
        "fillet radius of gear 2 is 0.6 modules, but the tip of its rack has room for 0.4719",
    ),
    (
        {"addendum": (-1.3, 1.0), "dedendum": (1.25, 1.25)},
        "addendum",
        "tip circle of gear 1 (46.2 mm) lies inside its root circle (46.5 mm)",
    ),
    (
        {"addendum": (1.0, -1.15), "dedendum": (1.25, 1.25), "teeth": (60, 36)},
        "addendum",
        "tip circle of gear 2 (101.1 mm) lies inside its base circle (101.4868 mm)",
    ),
    (
        {"profile_shift": (-1.8, 1.8), "teeth": (5, 60), "addendum": (3.0, 1.0)}
        | {"dedendum": (1.25, 1.25)},
        "dedendum",
        "root circle of gear 1 has the diameter -3.3 mm; it must be positive",
    ),
    (
        {"profile_shift": (0.8, -0.8), "teeth": (10, 60)},
        "addendum",
        "tip circle of gear 1 (40.8 mm) lies beyond the point of the teeth, where the flanks "
        "cross; it may be 40.485721 mm at most",
    ),
    (
        {"profile_shift": (-1.0, 0.0), "teeth": (8, 60)},
        "profile_shift",
        "no involute is left on gear 1: its form circle (24.023686 mm) must lie inside its tip "
        "circle (22.928903 mm)",
    ),
    (
        {"dedendum": (1.25, 0.95), "fillet_radius": (0.38, 0.1), "teeth": (30, 60)},
        "dedendum",
        "tip of gear 1 runs into the root of gear 2: the tip clearance is -0.05 modules",
    ),
    (
        {"dedendum": (1.05, 1.25)},
        "addendum",
        "the tip of gear 2 runs into the fillet of gear 1: they overlap by 0.0418 modules; a "
        "shorter addendum of gear 2 or a smaller fillet radius of gear 1 parts them",
    ),
    (
        {"addendum": (0.4, 0.4), "dedendum": (1.25, 1.25)},
        "addendum",
        "contact ratio of gear 1 and gear 2 is 0.7152 and must be at least 1; longer addenda",
    ),
    (
        {"centre_distance": 90e-3},  # the tips do not even meet
        "addendum",
        "contact ratio of gear 1 and gear 2 is -0.6835 and must be at least 1",
    ),
    (
        {"profile_shift": (-0.5, 0.0), "teeth": (6, 36)},
        "profile_shift",
        "is 0.3133 and must be at least 1; undercut takes 1.44 away; a larger profile shift of "
        "gear 1, a larger pressure angle or more teeth take less",
    ),
    (
        {"addendum": (7.0, 7.0), "fillet_radius": (0.1, 0.1)}
        | {"teeth": (3000, 3000), "degrees": 5.0},
        "addendum",
        "and must be below 24; shorter addenda lower it",
    ),
]


REFUSED_RINGS = [
    (
        {"teeth": (60, -60)},
        "teeth",
        "the ring, gear 2, has 60 teeth and must have more than gear 1, which has 60",
    ),
    (
        {"profile_shift": (2.0, 0.1)},  # 20 inv(20 deg)/tan(20 deg)
        "profile_shift",
        "sum to 2.1, which must be below 0.819: above it the flanks overlap at any centre distance",
    ),
    (
        {"profile_shift": (0.0, -70.0)},
        "profile_shift",
        "sum to -70; the working pressure angle would be above 65 degrees",
    ),
    (
        {"profile_shift": (0.3, -0.5), "fillet_radius": (0.38, 0.38)},
        "fillet_radius",
        "radius of gear 2 is 0.38 modules, but the root of its spaces has room for 0.3623 modules",
    ),
    (
        {"dedendum": (1.25, 2.3)},
        "dedendum",
        "flanks of gear 2 cross in the space between its teeth at the dedendum 2.3 modules; it may "
        "be 1.73 modules at most",
    ),
    (
        {"addendum": (1.0, -1.3)},
        "addendum",
        "tip circle of gear 2 (189.6 mm) lies outside its root circle (189.3 mm)",
    ),
    (
        {"addendum": (1.0, 2.2)},
        "addendum",
        "tip circle of gear 2 (168.6 mm) lies inside its base circle (169.14467 mm), where there "
        "is no involute",
    ),
    (
        {"teeth": (20, -200), "profile_shift": (0.0, -2.0), "addendum": (1.0, 3.2)},
        "addendum",
        "lies beyond the point of the teeth, where the flanks cross; it may be",
    ),
    (
        {"teeth": (18, -48), "profile_shift": (0.0, 0.0), "addendum": (1.0, 1.0)},
        "addendum",
        "tip of gear 2 runs into the fillet of gear 1: they overlap by 0.0208 modules",
    ),
    (
        {"teeth": (40, -60), "addendum": (1.2, 0.8), "fillet_radius": (0.3, 0.3)},
        "addendum",
        "tip of gear 1 runs into the fillet of gear 2: they overlap by 0.0206 modules; a shorter "
        "addendum of gear 1 or a smaller fillet radius of gear 2 parts them",
    ),
    (
        {"addendum": (1.29, 0.8)},
        "dedendum",
        "tip of gear 1 runs into the root of gear 2: the tip clearance is -0.04 modules",
    ),
    (
        {"teeth": (86, -90), "profile_shift": (0.39, -0.49)},
        "addendum",
        "tips of gear 1 and gear 2 run into each other where their tip circles cross: they overlap "
        "by 0.104 modules",
    ),
    (
        {"teeth": (16, -30), "profile_shift": (0.0, -0.29), "addendum": (1.0, 1.0)},
        "addendum",
        "tip of gear 2 runs into the undercut fillet of gear 1: they overlap by 0.00867 modules",
    ),
    (
        {"addendum": (0.3, 0.2)},
        "addendum",
        "contact ratio of gear 1 and gear 2 is 0.4051 and must be at least 1; longer addenda, more "
        "teeth, a smaller pressure angle or a larger centre distance raise it",
    ),
]
REFUSED_HELICAL = [
    (
        {"least_tip": 0.0},
        "addendum",
        "tip circle of gear 1 (11.434564 mm) lies beyond the point of the teeth",
    ),
    (
        {"face_width": 1e-3},
        "addendum",
        "total contact ratio of gear 1 and gear 2 is 0.9605 and must be at least 1; a wider face, ",
    ),
    (
        {"addendum": (0.1, 0.1), "dedendum": (1.25, 1.25)},
        "addendum",
        "transverse contact ratio of gear 1 and gear 2 is -0.08671 and must be positive; longer",
    ),
    (
        {"face_width": 0.5},
        "face_width",
        "must be below 24; shorter addenda or a narrower face lower it",
    ),
    (
        {"fillet_radius": (0.5, 0.3)},
        "fillet_radius",
        "0.5 normal modules, but the tip of its rack has room for 0.4719 normal modules",
    ),
    (
        {"teeth": (12, 12), "profile_shift": (-0.6, -0.6)},
        "profile_shift",
        "sum to -1.2, which must be above -0.5866",  # 12 inv(alpha_t)/tan(20 deg)
    ),
]
REFUSED += [({"teeth": (20, -60)} | RING | changes, *told) for changes, *told in REFUSED_RINGS]
REFUSED += [({"teeth": (4, 51)} | FEW | changes, *told) for changes, *told in REFUSED_HELICAL]


@pytest.mark.parametrize(("changes", "key", "told"), REFUSED, ids=[told for *_, told in REFUSED])
def test_refused(changes, key, told):
    error = refusal(**changes)
    assert told in error.message
    assert error.key == key
    assert math.isfinite(error.value)


ALLOWED = [
    ("dedendum", "it may be", {"dedendum": (1.25, 2.3), "fillet_radius": (0.38, 0.0)}, 1.25),
    ("fillet_radius", "room for", {"fillet_radius": (0.38, 0.6)}, 0.38),
]


@pytest.mark.parametrize(("entry", "before", "changes", "first"), ALLOWED)
def test_what_a_ring_allows_is_what_it_says(entry, before, changes, first):
    allowed = float(
        re.search(before + r" (\S+) modules", refusal((20, -60), **(RING | changes)).message)[1]
    )
    for value, accepted in ((0.999 * allowed, True), (1.001 * allowed, False)):
        pair = build((20, -60), **(RING | changes | {entry: (first, value)}))
        assert (float(pair.gears[1].root_land_angle) > 0.0) == accepted


def test_a_ring_tip_as_small_as_the_pointed_one_is_accepted():
    changes = {"profile_shift": (0.0, -2.0), "addendum": (1.0, 3.2)}
    message = refusal((20, -200), **(RING | changes)).message
    tip, pointed = (
        float(x) for x in re.search(r"2 \((\S+) mm\).* (\S+) mm at least", message).groups()
    )
    for diameter, sign in ((pointed + 1e-3, 1.0), (pointed - 1e-3, -1.0)):
        shorter = (tip - diameter) / 2.0 / 3.0
        pair = build((20, -200), **(RING | changes), tip_alteration=(0.0, shorter))
        assert 0.0 < sign * float(pair.gears[1].tip_thickness) < 1e-5


def test_a_tip_as_large_as_the_pointed_one_is_accepted():
    changes = {"teeth": (10, 60), "profile_shift": (0.8, -0.8)}
    shorter = (40.485721 - 1e-6 - 40.8) / 2.0 / 3.0
    (text,) = check_cylindrical(build(**changes, tip_alteration=(shorter, 0.0)))
    thickness = float(re.search(r"gear 1 are (\S+) modules thick at the tip", text)[1])
    assert 0.0 <= thickness < 1e-5


CUT = {"teeth": (20, -60), "profile_shift": (0.0, 0.0), "addendum": (1.0, 0.8), "cutter_shift": 0.0}
CUT |= {"fillet_radius": (0.38, 0.2)}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"cutter_teeth": 55.0}, "takes off the tips of gear 2 where their tip circles cross"),
        ({"cutter_teeth": 12.0}, "beyond the end of the involute of its cutter with 12 teeth"),
        ({"cutter_teeth": 20.0, "cutter_shift": 1.0}, "sum to 1; with 20 teeth of the cutter"),
        (
            {"cutter_teeth": 20.0, "fillet_radius": (0.38, 0.5)},
            "the tip of its cutter has room for",
        ),
    ],
)
def test_cutters_that_spoil_their_ring_are_refused(changes, words):
    error = refusal(**(CUT | changes))
    assert words in str(error)


def test_a_cutter_that_leaves_the_ring_whole_is_accepted():
    assert check_cylindrical(build(**(CUT | {"cutter_teeth": 20.0}))) == []
    (told,) = check_cylindrical(build(**(CUT | {"cutter_teeth": 48.0})))
    assert "takes off its tips while it is fed in radially" in told


def test_the_allowed_fillet_radius_is_accepted():
    largest = (math.pi / 4 - 1.25 * math.tan(math.radians(20))) / math.tan(math.radians(35))
    assert check_cylindrical(build(fillet_radius=(largest, 0.38))) == []


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"dedendum": (math.nan, 1.25)}, "the dedendum of gear 1 is nan and must be a finite"),
        ({"profile_shift": (0.0, math.nan)}, "the profile shift of gear 2 is nan"),
        ({"module": math.inf}, "the module of the pair is inf"),
        ({"centre_distance": math.nan}, "is nan and must be a finite number"),
        ({"pressure_angle": math.nan}, "is nan and must be a finite number"),
    ],
)
def test_no_silent_nan(changes, told):
    assert told in refusal(**changes).message


def test_nan_put_in_after_the_build():
    pair = dataclasses.replace(build(), tip_alteration=jnp.array([0.0, math.nan]))
    with pytest.raises(InputError, match="is nan and must be a finite number"):
        check_cylindrical(pair)


@pytest.mark.parametrize("distance", [70e-3, 90e-3])
def test_the_build_itself_refuses_flanks_that_cannot_meet(distance):
    with pytest.raises(InputError, match="gear 1 and gear 2"):
        build(centre_distance=distance)


@pytest.mark.parametrize("ratio", [math.nan, 24.0])
def test_no_lanes_for_an_impossible_contact_ratio(ratio):
    with pytest.raises(InputError, match="out of reach"):
        lanes_for_contact_ratio(ratio)
