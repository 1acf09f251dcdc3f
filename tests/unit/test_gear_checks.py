"""A bad pair of gears is told in gear words: which gear, which value, what is allowed."""

import dataclasses
import math
import re

import pytest

from pitchpoint._jax import jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.checks import check_cylindrical
from pitchpoint.gears.cylindrical import CylindricalPair, build_cylindrical_pair, lanes_for


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


def test_undercut_tells_limit_and_lost_contact_ratio():
    pair = build((12, 120))
    (text,) = check_cylindrical(pair)
    assert "gear 1 are undercut" in text
    assert "profile shift 0 is below the limit 0.2981" in text  # 0.99998 - 6 sin(20 deg)^2
    assert "path of contact ends at its form circle" in text
    nominal = float(dataclasses.replace(pair, undercut=(False, False)).contact_ratio)
    lost = float(re.search(r"takes (\S+) of the contact ratio", text)[1])
    assert lost == pytest.approx(nominal - float(pair.contact_ratio), abs=0.005)


def test_slight_undercut_of_both_costs_nothing():
    texts = check_cylindrical(build((17, 17)))
    assert [text[:23] for text in texts] == ["The flanks of gear 1 ar", "The flanks of gear 2 ar"]
    assert all("limit 0.005657" in text and "no contact ratio is lost" in text for text in texts)


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


def test_centre_distance_below_base_radii():
    error = refusal(centre_distance=70e-3)
    base_sum = 1.5 * 54 * math.cos(math.radians(20))
    assert error.key == "gears.centre_distance"
    assert "centre distance 70 mm of gear 1 and gear 2" in error.message
    assert f"base radii, {base_sum:.8g} mm" in error.message
    assert "no working pressure angle" in error.message


@pytest.mark.parametrize("distance", [76.5e-3, 80.5e-3, 80.99e-3])
def test_overlapping_flanks(distance):
    error = refusal(centre_distance=distance)
    assert error.key == "gears.centre_distance"
    assert "gear 1 and gear 2 overlap" in error.message
    assert f"{1e3 * distance:.8g} mm; these teeth need at least 81 mm" in error.message


def test_the_allowed_centre_distance_is_accepted_as_printed():
    shifted = {"profile_shift": (0.31, 0.17)}
    error = refusal(centre_distance=82e-3, **shifted)
    allowed = re.search(r"at least (\S+) mm", error.message)[1]
    assert check_cylindrical(build(centre_distance=float(allowed) / 1e3, **shifted)) == []


def test_no_distance_without_backlash():
    error = refusal((12, 12), profile_shift=(-0.6, -0.6))
    assert error.key == "gears.profile_shift"
    assert "gear 1 and gear 2 sum to -1.2, which must be above -0.4914" in error.message


def test_working_pressure_angle_out_of_reach():
    error = refusal((12, 12), profile_shift=(20.0, 20.0))
    assert error.key == "gears.profile_shift"
    assert "sum to 40; the working pressure angle would be above 65 degrees" in error.message


REFUSED = [
    (
        {"dedendum": (1.25, 0.3)},
        "gears.dedendum",
        "dedendum of gear 2 is 0.3 modules and must be larger than its fillet radius, 0.38",
    ),
    (
        {"dedendum": (2.3, 1.25)},
        "gears.dedendum",
        "rack that cuts gear 1 has no tip left at the dedendum 2.3 modules; it may be 2.158",
    ),
    (
        {"fillet_radius": (0.38, 0.6)},  # ISO 53 allows 0.4719 at this dedendum
        "gears.fillet_radius",
        "fillet radius of gear 2 is 0.6 modules, but the tip of its rack has room for 0.4719",
    ),
    (
        {"addendum": (-1.3, 1.0), "dedendum": (1.25, 1.25)},
        "gears.addendum",
        "tip circle of gear 1 (46.2 mm) lies inside its root circle (46.5 mm)",
    ),
    (
        {"addendum": (1.0, -1.15), "dedendum": (1.25, 1.25), "teeth": (60, 36)},
        "gears.addendum",
        "tip circle of gear 2 (101.1 mm) lies inside its base circle (101.4868 mm)",
    ),
    (
        {"profile_shift": (-1.8, 1.8), "teeth": (5, 60), "addendum": (3.0, 1.0)}
        | {"dedendum": (1.25, 1.25)},
        "gears.dedendum",
        "root circle of gear 1 has the diameter -3.3 mm; it must be positive",
    ),
    (
        {"profile_shift": (0.8, -0.8), "teeth": (10, 60)},
        "gears.addendum",
        "tip circle of gear 1 (40.8 mm) lies beyond the point of the teeth, where the flanks "
        "cross; it may be 40.485721 mm at most",
    ),
    (
        {"profile_shift": (-1.0, 0.0), "teeth": (8, 60)},
        "gears.profile_shift",
        "no involute is left on gear 1: its form circle (24.023686 mm) must lie inside its tip "
        "circle (22.928903 mm)",
    ),
    (
        {"dedendum": (1.25, 0.95), "fillet_radius": (0.38, 0.1), "teeth": (30, 60)},
        "gears.dedendum",
        "tip of gear 1 runs into the root of gear 2: the tip clearance is -0.05 modules",
    ),
    (
        {"dedendum": (1.05, 1.25)},
        "gears.addendum",
        "the tip of gear 2 meets the fillet of gear 1: on the line of action, counted from the "
        "base circle of gear 1, it reaches down to 1.7400571 mm, but the involute begins at "
        "2.217697 mm; a shorter addendum of gear 2 or a larger dedendum of gear 1 parts them",
    ),
    (
        {"addendum": (0.4, 0.4), "dedendum": (1.25, 1.25)},
        "gears.addendum",
        "contact ratio of gear 1 and gear 2 is 0.7152 and must be at least 1; longer addenda",
    ),
    (
        {"centre_distance": 90e-3},  # the tips do not even meet
        "gears.addendum",
        "contact ratio of gear 1 and gear 2 is -0.6835 and must be at least 1",
    ),
    (
        {"profile_shift": (-0.5, 0.0), "teeth": (6, 36)},
        "gears.profile_shift",
        "is 0.3133 and must be at least 1; undercut takes 1.44 away; longer addenda",
    ),
    (
        {"addendum": (7.0, 7.0), "fillet_radius": (0.1, 0.1)}
        | {"teeth": (3000, 3000), "degrees": 5.0},
        "gears.addendum",
        "and must be below 9; shorter addenda lower it",
    ),
]


@pytest.mark.parametrize(("changes", "key", "told"), REFUSED, ids=[told for *_, told in REFUSED])
def test_refused(changes, key, told):
    error = refusal(**changes)
    assert told in error.message
    assert error.key == key
    assert math.isfinite(error.value)


def test_a_tip_as_large_as_the_pointed_one_is_accepted():
    changes = {"teeth": (10, 60), "profile_shift": (0.8, -0.8)}
    shorter = (40.485721 - 1e-6 - 40.8) / 2.0 / 3.0
    (text,) = check_cylindrical(build(**changes, tip_alteration=(shorter, 0.0)))
    thickness = float(re.search(r"gear 1 are (\S+) modules thick at the tip", text)[1])
    assert 0.0 <= thickness < 1e-5


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


@pytest.mark.parametrize("ratio", [math.nan, 9.0])
def test_no_lanes_for_an_impossible_contact_ratio(ratio):
    with pytest.raises(InputError, match="out of reach"):
        lanes_for(ratio)
