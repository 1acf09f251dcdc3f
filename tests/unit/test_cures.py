"""A refusal of gears holds changes of the case after which they run; defaults leave tips and fillets room."""

import copy
import tomllib
from math import radians
from typing import Any

import numpy as np
import pytest
from sound import PAIR

from pitchpoint.cases.document import resolve
from pitchpoint.cases.validation import validate
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import CollectedInputError, Complaints, InputError
from pitchpoint.gears.cylindrical.checks import _measure
from pitchpoint.gears.involute import usual_depths, usual_ring_fillet

COMMON = {"module": "2 mm", "face_width": "20 mm"}
CASE = {key: value for key, value in tomllib.loads(PAIR).items() if key != "gears"}


def pair(**gears: Any) -> Variant:
    tree = copy.deepcopy(CASE) | {"gears": COMMON | gears}
    return Variant(tree, "pair.toml", "default", {})


# Each with the keys of its cures.
REFUSED: list[tuple[dict[str, Any], list[set[str]]]] = [
    ({"teeth": [18, 36], "dedendum": [1.05, 1.25]}, [{"addendum"}]),
    ({"teeth": [18, 36], "addendum": 0.4}, [{"addendum"}]),
    ({"teeth": [18, 36], "centre_distance": "53 mm"}, [{"profile_shift"}, {"centre_distance"}]),
]
SLOW: list[tuple[dict[str, Any], list[set[str]]]] = [
    (
        {"teeth": [8, 20], "pressure_angle": "14.5 deg", "centre_distance": "28 mm"},
        [{"profile_shift", "centre_distance"}, {"pressure_angle"}],
    ),
    ({"teeth": [7, 30]}, [{"profile_shift"}, {"pressure_angle"}]),
    ({"teeth": [9, 9]}, [{"profile_shift"}, {"pressure_angle"}]),
    (
        {"teeth": [6, 60], "helix_angle": "15 deg", "face_width": "6 mm"},
        [{"profile_shift"}, {"pressure_angle"}],
    ),
    ({"teeth": [22, -61], "centre_distance": "39 mm"}, [{"addendum"}, {"fillet_radius"}]),
    ({"teeth": [18, -48]}, [{"addendum"}, {"profile_shift"}]),
    ({"teeth": [16, -30], "profile_shift": [0.0, -0.29]}, [{"addendum"}, {"fillet_radius"}]),
    ({"teeth": [17, -51]}, [{"addendum"}, {"fillet_radius"}]),
    (
        {"teeth": [86, -90], "profile_shift": [0.39, -0.49], "addendum": [1.0, 0.8]},
        [{"addendum"}, {"profile_shift"}],
    ),
    (
        {"teeth": [40, -60], "profile_shift": [0.3, -0.3], "addendum": [1.2, 0.8]}
        | {"dedendum": 1.25, "fillet_radius": 0.3},
        [{"addendum"}, {"profile_shift"}],
    ),
    ({"teeth": [12, 61], "profile_shift": [1.5, 0.0]}, [{"profile_shift"}]),
    (
        {"teeth": [20, 40], "addendum": [1.6223, 0.6475]},
        [{"least_tip_thickness"}, {"profile_shift"}],
    ),
    (
        {"teeth": [20, -50], "addendum": [1.0, 0.8], "centre_distance": "30.6 mm"},
        [{"profile_shift"}, {"centre_distance"}],
    ),
    ({"teeth": [18, 36], "centre_distance": "60 mm"}, [{"centre_distance"}]),
    ({"teeth": [30, 60], "addendum": 1.2, "dedendum": 1.1}, [{"dedendum"}, {"addendum"}]),
    (
        {"teeth": [40, 80], "addendum": [1.2, 1.0], "dedendum": 1.1},
        [{"dedendum"}, {"addendum"}],
    ),
    ({"teeth": [14, -24]}, [{"addendum"}]),
    (
        {"teeth": [30, -60], "fillet_radius": [0.38, 0.5], "addendum": [1.0, 0.8]},
        [{"fillet_radius"}],
    ),
    ({"teeth": [14, 14], "pressure_angle": "14.5 deg"}, [{"profile_shift"}, {"pressure_angle"}]),
    # No key alone is enough.
    (
        {"teeth": [9, 11], "addendum": [1.48, 1.2]},
        [{"profile_shift", "least_tip_thickness"}],
    ),
    ({"teeth": [40, -65], "centre_distance": "41 mm"}, [{"profile_shift", "centre_distance"}]),
    ({"teeth": [18, -40], "profile_shift": [0.334, 0.463]}, [{"profile_shift"}]),
    ({"teeth": [28, -31]}, [{"profile_shift"}]),
    (
        {"teeth": [9, 33], "addendum": [0.806, 1.211], "dedendum": [1.005, 0.859]},
        [{"addendum", "dedendum", "pressure_angle"}],
    ),
]


def test_what_is_wrong_with_both_gears_is_told_as_it_was_given() -> None:
    """It was told of a change that had been tried of gear 1 alone, and none of both was tried."""
    error = refusal(pair(teeth=[21, 35], fillet_radius=0.4722, pressure_angle="28 deg"), {})
    assert "the fillet radius of gear 1 is 0.4722 modules" in error.message
    assert error.cures == ({"gears.fillet_radius": [0.2, 0.2]},)


@pytest.mark.whole
def test_the_last_of_several_sentences_has_the_change_that_mends_all() -> None:
    variant = pair(teeth=[22, 35], addendum=[1.971, 0.999])
    error = refusal(variant, {})
    assert isinstance(error, CollectedInputError)
    assert [one.key for one in error.errors] == ["gears.addendum", "gears.dedendum"]
    (cure,) = error.errors[-1].cures
    assert [*cure] == ["gears.addendum"]
    variant.built(cure)


def refusal(variant: Variant, settings: dict[str, Any]) -> InputError:
    with pytest.raises(InputError) as caught:
        variant.built(settings)
    return caught.value


@pytest.mark.parametrize(
    ("gears", "keys"), [*REFUSED, *(pytest.param(*one, marks=pytest.mark.whole) for one in SLOW)]
)
def test_followed_advice_ends_in_a_case_that_runs(
    gears: dict[str, Any], keys: list[set[str]]
) -> None:
    variant = pair(**gears)
    error = refusal(variant, {})
    assert [{*cure} for cure in error.cures] == [{f"gears.{key}" for key in one} for one in keys]
    for cure in error.cures:
        built = variant.built(cure)
        assert float(built.dimensions["transverse_contact_ratio"]) > 0.5
        for key, value in cure.items():
            shown = f'"{value}"' if isinstance(value, str) else f"{np.ravel(value)[0]:g}"
            assert f"{key.removeprefix('gears.')} = " in error.message
            assert shown in error.message


def test_a_change_one_step_smaller_does_not_run() -> None:
    variant = pair(teeth=[18, 36], dedendum=[1.05, 1.25])
    (cure,) = refusal(variant, {}).cures
    first, second = cure["gears.addendum"]
    told = variant.built({"gears.addendum": [first, second + 0.002]}).warnings
    assert any("enters the fillet of gear 1" in text for text in told)


def test_cures_are_told_with_the_place_of_their_table() -> None:
    error = InputError("is wrong", key="addendum")
    error.cures = ({"addendum": 1.0},)
    wrong = Complaints("drive.toml")
    wrong.under("stages.2.gears").add(error)
    assert wrong.error.cures == ({"stages.2.gears.addendum": 1.0},)
    assert CollectedInputError([error, error]).cures == ()


def test_a_centre_distance_gives_the_profile_shifts() -> None:
    """A ring's sum of -0.3212, by ISO 21771: half for each, or what the shift by value leaves."""
    ring = {"teeth": [20, -50], "addendum": [1.0, 0.8], "centre_distance": "30.6 mm"}
    word = "from centre distance"
    for given, first in ((word, -0.1606), ([0.1, word], 0.1), ([word, -0.3], -0.0212)):
        tree = CASE | {"gears": COMMON | ring | {"profile_shift": given}}
        gears = validate(resolve(tree, name="x.toml", variant="default")).gears
        assert gears.profile_shift == pytest.approx((first, -0.3212 - first), abs=5e-5)
    built = pair(**ring, profile_shift=word).built({})
    assert abs(float(built.dimensions["normal_backlash"])) < 1e-12


@pytest.mark.parametrize(
    ("gears", "told"),
    [
        ({}, "given without a centre_distance"),
        (
            {"centre_distance": "50 mm"},
            "must be larger than that of the base circles, 50.743402 mm",
        ),
        ({"centre_distance": "65 mm"}, "sum to 8.202, with 4.101 of gear 1; allowed is -2 to 3"),
    ],
)
def test_a_centre_distance_that_gives_none_is_refused(gears: dict[str, Any], told: str) -> None:
    variant = pair(teeth=[18, 36], profile_shift="from centre distance", **gears)
    assert told in refusal(variant, {}).message


def test_allowances_of_the_thickness_decide_on_a_smaller_centre_distance() -> None:
    """0.1 mm less centre distance takes 2 tan 20 times as much backlash, 73 um of thickness."""

    def inspected(each: int) -> Variant:
        limits = {"upper_thickness_allowance": f"-{each} um", "lower_thickness_allowance": "-60 um"}
        return pair(teeth=[18, 36], centre_distance="53.9 mm", inspection=limits)

    told = inspected(40).built({}).warnings
    assert any("their allowances leave a backlash of 7.25" in text for text in told)
    assert "and their allowances leave -30.3 um" in refusal(inspected(20), {}).message


def test_stages_are_told_their_advice_under_their_own_keys() -> None:
    sound = COMMON | {"teeth": [18, 36]}
    stages = {"1": {"gears": sound}, "2": {"gears": sound | {"dedendum": [1.05, 1.25]}}}
    drive = Variant(copy.deepcopy(CASE) | {"stages": stages}, "drive.toml", "default", {})
    (cure,) = refusal(drive, {}).cures
    assert {*cure} == {"stages.2.gears.addendum"}


def test_usual_dedenda_leave_the_tips_a_quarter_of_a_module() -> None:
    angle = radians(20.0)
    assert usual_depths((1.0, 1.0), None, None, angle) == ((1.25, 1.25), (0.38, 0.38))
    assert usual_depths((1.25, 0.75), None, None, angle)[0] == (1.0, 1.5)
    assert usual_depths((1.0, 0.75), None, None, angle, ring=True)[0] == (1.25, 1.25)
    assert usual_depths((1.25, 0.75), (1.25, 1.0), None, angle)[0] == (1.25, 1.0)


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_the_usual_fillet_of_a_ring_fills_its_root_where_there_is_no_more_room(
    helix: float,
) -> None:
    """0.2 in a wide root, none in a pointed one, between them what the check of the built ring allows."""
    ring = {"teeth": -40, "pressure_angle": radians(25.0), "helix_angle": radians(helix)}
    assert usual_ring_fillet(**ring, profile_shift=0.0, dedendum=1.25) == 0.2
    assert usual_ring_fillet(**ring, profile_shift=-1.5, dedendum=1.25) == 0.0
    narrow = usual_ring_fillet(**ring, profile_shift=-0.6, dedendum=1.25)
    gears = {"teeth": [20, -40], "pressure_angle": "25 deg", "helix_angle": f"{helix} deg"}
    built = pair(**gears, profile_shift=[0.3, -0.6], addendum=[1.0, 0.75]).built({})
    assert float(built.design.mesh.fillet_radius[1]) == narrow
    assert 0.05 < narrow < 0.19
    assert narrow == pytest.approx(
        _measure(built.design.mesh)[1][1].largest_fillet_radius, rel=1e-9
    )
