"""Gears drawn within their tolerances: percentiles of the backlash against sampling of its closed form."""

import numpy as np
import pytest

import pitchpoint as pp
from pitchpoint.cases.validation import validate
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.din_3967 import thickness_allowances
from pitchpoint.gears.cylindrical.inspection import Toothing, backlash
from pitchpoint.gears.cylindrical.iso_286 import symmetrical_deviation
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances
from pitchpoint.runs.layouts import layout_of
from pitchpoint.runs.tolerances import with_tolerances

PAIR = pp.Case(
    gears={
        "teeth": [20, 40],
        "module": "2 mm",
        "face_width": "20 mm",
        "inspection": {"thickness_field": ["cd25", "d26"], "centre_distance_field": "js7"},
    },
    lubricant={"name": "pao-vg-150"},
    roughness={"ra": "0.4 um"},
    operation={"torque": "60 N m", "speed": "1200 rpm", "temperature": "50 degC"},
)
KEYS = ["gears.thickness_allowance.1", "gears.thickness_allowance.2", "gears.centre_distance"]
PERCENTILES = (1.0, 10.0, 50.0, 90.0, 99.0)


def _sampled(distribution: str, count: int) -> np.ndarray:
    """Backlash of gears drawn one by one, from tolerances and formulas alone [m]."""
    rng = np.random.default_rng(5)
    common = 2e-3, np.pi / 9.0, 0.0, 0.0
    gears = Toothing(20, *common), Toothing(40, *common)
    upper, lower = np.transpose(
        [
            thickness_allowances(field="cd25", diameter=0.04),
            thickness_allowances(field="d26", diameter=0.08),
        ]
    )
    deviation = symmetrical_deviation("js7", 0.06)
    middle = np.array([*(upper + lower) / 2.0, 0.06])
    half = np.array([*(upper - lower) / 2.0, deviation])
    parts = rng.uniform(-1.0, 1.0, (count, 3))
    if distribution == "normal":
        every = rng.normal(0.0, 1.0 / 3.0, (2 * count, 3))
        parts = every[np.all(np.abs(every) <= 1.0, axis=1)][:count]
    return np.array(
        [
            backlash(gears[0].thinned(first), gears[1].thinned(second), distance).circumferential
            for first, second, distance in middle + half * parts
        ]
    )


@pytest.mark.whole
@pytest.mark.parametrize("distribution", ["uniform", "normal"])
def test_percentiles_of_the_backlash_are_those_of_direct_sampling(distribution: str) -> None:
    found = pp.study(PAIR, tolerances=distribution, n=256, seed=3)
    assert list(found.attrs["layout"]) and found.attrs["tolerances"] == distribution
    computed = found["circumferential_backlash"].values[0]
    direct = _sampled(distribution, 20_000)
    np.testing.assert_allclose(
        np.percentile(computed, PERCENTILES),
        np.percentile(direct, PERCENTILES),
        atol=0.02 * np.ptp(direct),
    )
    # Each by itself: nothing but what was drawn differs, so tips stay where nominal gears have them.
    gears = validate(PAIR.held[0].document()).gears.toothings
    drawn = np.array([found[key].values for key in KEYS]).T
    alone = [
        backlash(gears[0].thinned(first), gears[1].thinned(second), distance).circumferential
        for first, second, distance in drawn
    ]
    np.testing.assert_allclose(computed, alone, atol=1e-12)
    assert np.ptp(found["tip_alteration_1"].values) == 0.0


def test_a_class_draws_the_misalignment_of_both_helix_slopes() -> None:
    graded = PAIR.set({"gears.inspection.iso_class": [6, 7]})
    base, ranges = with_tolerances(graded.held[0], "normal")
    slopes = [
        flank_tolerances(
            tolerance_class=grade, diameter=diameter, module=2e-3, face_width=20e-3
        ).helix_slope
        for grade, diameter in ((6, 0.04), (7, 0.08))
    ]
    limit = ranges["gears.misalignment"]
    assert (limit["start"], limit["stop"]) == pytest.approx((-np.hypot(*slopes), np.hypot(*slopes)))
    layout = layout_of(base, ranges, "sobol", 16, 0)
    assert [*layout.axes] == [*KEYS, "gears.misalignment"]


def test_shifts_from_the_centre_distance_stay_those_of_the_nominal_one() -> None:
    asked = {"gears.centre_distance": "60.4 mm", "gears.profile_shift": "from centre distance"}
    base, _ = with_tolerances(PAIR.set(asked).held[0], "uniform")
    nominal = validate(base.document()).gears.profile_shift
    moved = validate(base.document(**{"gears.centre_distance": "60.41 mm"})).gears.profile_shift
    assert moved == nominal and nominal[0] > 0.0


def test_an_allowance_of_the_drawing_does_not_count_twice() -> None:
    from pitchpoint.analyses.inspection import inspection_part

    nominal = PAIR.held[0].built({}).meshes[0]
    thinned = PAIR.set({"gears.thickness_allowance": ["-50 um", "-80 um"]}).held[0].built({})
    parts = [inspection_part(built) for built in (nominal, thinned.meshes[0])]
    np.testing.assert_array_equal(*(part["normal_thickness"].values for part in parts))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            {"gears.inspection": {"centre_distance_field": "js7"}, "gears.backlash": "100 um"},
            "tolerances: the backlash by value, gears.backlash, thins the teeth for every centre",
        ),
        (
            {"gears.thickness_allowance": "-50 um", "gears.backlash": "100 um"},
            "gears.thickness_allowance: was given beside backlash",
        ),
        (
            {"gears.thickness_allowance": "-1.5 mm"},
            "gears.thickness_allowance: 1500 um is more than a tooth allows",
        ),
    ],
)
def test_tolerances_that_cannot_be_drawn(change: dict[str, object], told: str) -> None:
    tables = PAIR.tables
    if "gears.inspection" in change or "gears.backlash" in change:
        tables = {
            **tables,
            "gears": {**tables["gears"], "inspection": change.get("gears.inspection", {})},
        }
        change = {key: value for key, value in change.items() if key != "gears.inspection"}
    with pytest.raises(InputError) as caught:
        pp.study(pp.Case(tables).set(change), tolerances="normal", n=16)
    assert told in str(caught.value)
