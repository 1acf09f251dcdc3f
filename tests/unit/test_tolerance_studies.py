"""Gears drawn within their tolerances: backlash, kinematic error and safety against direct sampling."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import pitchpoint as pp
from pitchpoint._jax import double_precision
from pitchpoint.cases.validation import validate
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.din_3967 import thickness_allowances
from pitchpoint.gears.cylindrical.drawing_dimensions import Toothing, backlash
from pitchpoint.gears.cylindrical.iso_286 import symmetrical_deviation
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances
from pitchpoint.runs.layouts import layout_of
from pitchpoint.runs.tolerances import with_tolerances
from pitchpoint.views.many_designs import figures_of_many

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
    drawn = ["misalignment", "share_of_tolerance.1", "share_of_tolerance.2", "seed"]
    drawn = [f"gears.{'' if key == 'misalignment' else 'deviations.'}{key}" for key in drawn]
    assert [*layout.axes] == [*KEYS, *drawn]
    assert layout.axes[drawn[-1]].distribution == "uniform"
    assert base.settings["gears.deviations.iso_class"] == [6, 7]


SHAFT = {
    "strength.bearing_span": "100 mm",
    "strength.pinion_offset": "10 mm",
    "strength.pinion_shaft_diameter": "30 mm",
    "materials.gear_1": "case-hardened-mq",
    "materials.gear_2": "case-hardened-mq",
}
GRADED = PAIR.set({"gears.inspection.iso_class": 6, **SHAFT})


@pytest.fixture(scope="module")
def graded() -> xr.Dataset:
    """A study of a pair whose deviations, misalignment, thickness and distance are drawn."""
    return pp.study(GRADED, tolerances="uniform", n=256, seed=3)


def _range_of_error(changes: dict[str, object], curve: str) -> float:
    from pitchpoint.analyses.kinematic_error import deviation_error

    with double_precision():
        built = GRADED.set(changes).held[0].built({}).meshes[0]
        ranges = deviation_error(built, lambda _: None)["kinematic_error_range"]
    return float(ranges.sel(curve=curve, cause="both"))


@pytest.mark.whole
def test_percentiles_of_the_kinematic_error_are_those_of_direct_sampling(
    graded: xr.Dataset,
) -> None:
    base, ranges = with_tolerances(GRADED.held[0], "uniform")
    rng = np.random.default_rng(8)
    direct = [
        _range_of_error(
            {
                **base.settings,
                **{key: rng.uniform(one["start"], one["stop"]) for key, one in ranges.items()},
                "gears.deviations.seed": int(rng.integers(1_000_000)),
            },
            "under load",
        )
        for _ in range(256)
    ]
    computed, spread = graded["kinematic_error_range"].values[0], np.std(direct)
    assert np.mean(computed) == pytest.approx(np.mean(direct), abs=0.2 * spread)
    np.testing.assert_allclose(
        np.percentile(computed, (10, 50, 90)),
        np.percentile(direct, (10, 50, 90)),
        atol=0.3 * spread,
    )


@pytest.mark.whole
def test_a_design_of_a_study_is_the_run_of_the_case_with_what_was_drawn(graded: xr.Dataset) -> None:
    base, _ = with_tolerances(GRADED.held[0], "uniform")
    for number in (3, 70):
        design = graded.isel(design=number)
        drawn = {key: float(design[key]) for key in json.loads(graded.attrs["layout"])["keys"]}
        drawn["gears.deviations.seed"] = int(drawn["gears.deviations.seed"])
        alone = pp.run(GRADED.set({**base.settings, **drawn}), analyses=["strength"])
        safety = alone.dataset("strength")["flank_safety"].values.min()
        assert float(design["least_flank_safety"][0]) == pytest.approx(safety, rel=1e-9)
        error = _range_of_error({**base.settings, **drawn}, "under load")
        assert float(design["kinematic_error_range"][0]) == pytest.approx(error, rel=1e-9)


@pytest.mark.whole
def test_errors_of_rigid_teeth_are_proportional_to_the_share_of_their_tolerance() -> None:
    deviations = {"gears.deviations.iso_class": 6, "gears.deviations.seed": 4}
    whole = _range_of_error(deviations, "geometry")
    for share in (0.0, 0.5, 1.0):
        part = {**deviations, "gears.deviations.share_of_tolerance": share}
        # Apart from rounding: clearances of nominal flanks in contact are zero.
        assert _range_of_error(part, "geometry") == pytest.approx(share * whole, abs=1e-9 * whole)


@pytest.mark.whole
def test_a_misalignment_stands_for_that_of_the_class_in_the_face_load_factor() -> None:
    limit = with_tolerances(GRADED.held[0], "uniform")[1]["gears.misalignment"]["stop"]

    def factor(misalignment: float | None) -> float:
        changes: dict[str, object] = {"operation.torque": "400 N m"}
        if misalignment is not None:
            changes["gears.misalignment"] = misalignment
        found = pp.run(GRADED.set(changes), analyses=["strength"]).dataset("strength")
        return float(found["face_load_factor"])

    of_class = factor(None)
    assert factor(limit) == pytest.approx(of_class, rel=1e-12)
    assert factor(-limit) == pytest.approx(of_class, rel=1e-12)
    # At this torque the whole face carries: K_Hbeta - 1 is linear in F_betax, running in taking 15 %.
    small, middle = factor(0.4 * limit), factor(0.7 * limit)
    assert of_class < 2.0 and small < middle
    assert of_class - middle == pytest.approx(middle - small, rel=1e-9)


@pytest.mark.whole
def test_stages_in_a_row_are_drawn_each_by_its_own_table() -> None:
    stage = {key: PAIR.tables["gears"][key] for key in ("teeth", "module", "face_width")}
    tables = {key: table for key, table in PAIR.tables.items() if key != "gears"}
    inspected = {"inspection": {"thickness_field": "cd25", "iso_class": 7}}
    stages = {"1": {"gears": stage}, "2": {"gears": {**stage, **inspected}}}
    row = pp.Case({**tables, "stages": stages})
    found = pp.study(row, tolerances="uniform", n=128)
    keys = json.loads(found.attrs["layout"])["keys"]
    assert keys[0] == "stages.2.gears.thickness_allowance.1" and len(keys) == 6
    allowances = [found[key].values for key in keys[:2]]
    gear = Toothing(20, 2e-3, np.pi / 9.0, 0.0, 0.0), Toothing(40, 2e-3, np.pi / 9.0, 0.0, 0.0)
    plays = [
        backlash(gear[0].thinned(first), gear[1].thinned(second), 0.06).angular[1]
        for first, second in zip(*allowances, strict=True)
    ]
    # The first stage has no backlash: the output turns by that of the second.
    np.testing.assert_allclose(found["output_backlash"].values[0], plays, atol=1e-12)
    assert np.isfinite(found["kinematic_error_range"].values).all()
    (told,) = json.loads(found.attrs["remarks"])
    assert told.startswith(
        "Stresses and safeties do not follow stages.2.gears.misalignment: K_Hβ is 1"
    )


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
            {"gears.deviations.share_of_tolerance": 0.5},
            "gears.deviations.share_of_tolerance: was given without iso_class, of whose limits",
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


def test_the_screen_has_the_percentiles_that_it_names_and_what_does_not_follow() -> None:
    values = np.random.default_rng(1).permutation(101)[None].astype(float)
    dims = ("law", "design")
    figures = {
        "circumferential_backlash": (dims, values, {"long_name": "backlash", "units": "um"}),
        "reason": (dims, np.full(values.shape, "")),
    }
    found = xr.Dataset(figures, {"law": ["xu_2007"]}, {"reasons": "{}", "tolerances": "uniform"})
    told, rows = figures_of_many(found.assign_attrs(remarks='["Safeties stay."]'), Path("x"))
    assert rows[0] | {"1 %": "1", "median": "50", "99 %": "99"} == rows[0]
    assert told == [
        "101 designs",
        "Safeties stay.",
        "every design: x",
        "report: x/report.html",
    ]
    doubtful = found.assign_attrs(warnings='["At 60 degC a.", "b.", "c.", "d.", "e."]')
    assert figures_of_many(doubtful, Path("x"))[0][1:5] == [
        "Doubtful: At 60 °C a.",
        "Doubtful: b.",
        "Doubtful: c.",
        "  and 2 more warnings, in the report",
    ]
    ends = figures_of_many(found.assign_attrs(tolerances=""), Path("x"))[1]
    assert ends == []  # without tolerances the backlash is no main figure


@pytest.mark.whole
def test_helix_slopes_that_make_the_misalignment_do_not_count_twice() -> None:
    def most(changes: dict[str, object]) -> list[float]:
        with double_precision():
            case = PAIR.set({"gears.deviations.iso_class": 6, **changes})
            deviations = case.held[0].built({}).meshes[0].deviations
        return [float(np.abs(of_gear[0].lead_slope).max()) for of_gear in deviations]

    misaligned, shared = (
        {"gears.misalignment": "5 um"},
        {"gears.deviations.share_of_tolerance": 0.5},
    )
    assert most(misaligned | shared) == [0.0, 0.0]
    assert most(shared) == pytest.approx([0.5 * limit for limit in most(misaligned)], rel=1e-12)
    assert min(most(misaligned)) > 1e-6
