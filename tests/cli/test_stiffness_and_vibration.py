"""Stiffness, vibration and warm plastic teeth as a user of case files meets them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import equinox as eqx
import numpy as np
import pytest
import xarray as xr
from sound import quick_first

from pitchpoint import cli
from pitchpoint.analyses.summaries import summaries
from pitchpoint.analyses.vibration import _excited, stiffness_part, vibrating_of, vibration_part
from pitchpoint.cases.built import Built
from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.core.doubts import BRIEF, as_doubt
from pitchpoint.dynamics.excitation import Excitation, ExcitationCourse
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.errors import InputError
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import (
    Outcome,
    Progress,
    load_case,
    open_outcomes,
    run_variant,
    uncomputed_manifests,
)
from pitchpoint.views.inputs import printed_input_rows
from pitchpoint.views.report import write_report

ASKED = ["models.load_sharing=from_stiffness", "dynamics.damping_ratio=0.1"]

ENGINEER = """
[gears]
teeth = [4, 51]
module = "1.5 mm"
helix_angle = "20 deg"
profile_shift = [0.74, 0.05]
face_width = "16 mm"
[materials]
gear_1 = "steel"
gear_2 = "PA66-3.54"
[lubricant]
name = "pao-vg-150"
[roughness]
ra = "0.4 um"
[operation]
torque = "5.355 N m"
speed = "1800 rpm"
temperature = "23 degC"
"""

SPUR = """
[gears]
teeth = [24, 36]
module = "3 mm"
face_width = "20 mm"
[lubricant]
name = "mineral-vg-220"
[roughness]
ra = "0.4 um"
[operation]
torque = "100 N m"
speed = "12400 rpm"
temperature = "60 degC"
[dynamics]
damping_ratio = 0.02
"""

Loaded = Callable[..., Built]


def parts_of(variant: Variant, folder: Path, *names: str) -> Outcome:
    """What `pitchpoint run` computes and keeps, of some parts only."""
    work = [job for job in jobs(variant, {}) if job.name in names]
    assert [job.name for job in work] == list(names)
    return run_variant(variant, work, folder=folder, studies={}, progress=Progress())


@pytest.fixture
def file(tmp_path: Path) -> Callable[[str], str]:
    def write(text: str) -> str:
        path = tmp_path / "pair.toml"
        path.write_text(text, "utf-8")
        return str(path)

    return write


# ------------------------------------------------------------------ a published pair with dynamics


class Run:
    """Tian's pair with load sharing from stiffness and with dynamics, computed once."""

    def __init__(self, folder: Path) -> None:
        name, tree = find_case("tian2024")
        variant = Variant(tree, name, "physical", cli._settings(ASKED))
        names = ("teeth", "cycle", "operation", "laws", "stiffness", "vibration")
        self.outcome = parts_of(variant, folder / "physical", *names)
        (folder / "run.json").write_text(json.dumps({"case": name, "variants": ["physical"]}))
        write_report({"physical": self.outcome}, folder / "report.html")
        self.report = (folder / "report.html").read_text("utf-8")
        self.kept = open_outcomes(folder)["physical"]

    def part(self, name: str) -> xr.Dataset:
        return self.kept.parts[name]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return Run(tmp_path_factory.mktemp("tian"))


def test_stiffness_and_vibration_are_on_disk_and_finished(run: Run) -> None:
    assert {"stiffness", "vibration"} <= set(run.kept.parts)
    assert run.kept.manifest["finished"]
    for name in ("stiffness", "vibration"):
        for values in run.part(name).values():
            assert np.all(np.isfinite(values)), values.name
    assert run.part("stiffness")["mean_stiffness"].attrs["units"] == "N/m"


def test_stiffness_of_the_published_pair_lies_beside_the_standard(run: Run) -> None:
    """18/36 teeth of steel; the bore of 0.3 root radii makes the model softer than ISO 6336."""
    found = run.part("stiffness")
    ratio = float(found["mean_stiffness"] / found["standard_stiffness"])
    assert 0.75 < ratio < 1.0
    assert float(found["mean_stiffness"]) == pytest.approx(
        float((found["mesh_stiffness"] * found["weight"]).sum()), rel=1e-12
    )
    of_pairs = found["pair_stiffness"].sum("pair").values
    np.testing.assert_allclose(of_pairs, found["mesh_stiffness"].values, rtol=1e-12)


def test_figures_of_the_whole_mesh_follow_from_those_of_its_pairs(run: Run) -> None:
    found = run.part("vibration").isel(torque=0)
    whole = found["mesh_dynamic_factor"]
    np.testing.assert_allclose(whole, found["dynamic_factor"].sum("pair"), rtol=1e-12)
    assert float(found["largest_mesh_dynamic_factor"]) == pytest.approx(
        float(whole.max()), rel=1e-2
    )
    assert float(found["separated_share"]) == 0.0
    # Parseval: a course without its mean is the sum of its orders.
    orders = found["spectrum"].sel(order=slice(1, None))
    rms = float(np.sqrt((orders**2).sum() / 2.0))
    assert float(found["transmission_error_rms"]) == pytest.approx(rms, rel=1e-2)
    at = run.part("operation")
    for name in ("transmission_error_rms", "separated_share", "largest_mesh_dynamic_factor"):
        assert name in at


def test_figures_at_the_pitch_point_by_hand(run: Run) -> None:
    """18/36 teeth, m = 3 mm, b = 26.7 mm at 20 deg and 1500 rpm against 159 N m, without backlash."""
    at, sine, cosine = run.part("operation").isel(law=0, point=0), np.sin(ANGLE), np.cos(ANGLE)
    point = load_case("tian2024", "physical").operation
    r1, r2 = 0.027, 0.054
    assert float(at["pitch_sum_speed"]) == pytest.approx(2.0 * float(point.speed) * r1 * sine, 1e-9)
    assert float(at["pitch_radius"]) == pytest.approx(r1 * r2 / (r1 + r2) * sine, rel=1e-9)
    line_load = float(point.load) / (r2 * cosine) / 26.7e-3
    assert float(at["pitch_line_load"]) == pytest.approx(line_load, rel=1e-9)
    assert abs(float(at["circumferential_backlash"])) < 1e-15
    assert float(at["largest_contact_force_ratio"]) > 1.0
    length = run.part("cycle")["contact_line_length"].isel(law=0)
    assert {round(1e4 * float(each)) for each in length} == {267, 534}


ANGLE = np.deg2rad(20.0)


def test_shares_of_the_published_pair_follow_its_stiffness(run: Run) -> None:
    share = run.part("cycle")["load_share"].isel(law=0).sum("slice")
    np.testing.assert_allclose(share.sum("pair"), 1.0, rtol=1e-12)
    both = (share > 0.0).all("pair").values
    assert both.any() and not both.all()
    # The straight lines of Sanchez et al. go down to 0.36; teeth on a yielding body share more evenly.
    assert 0.40 < float(share.values[both].min()) < 0.45


def test_vibration_of_the_published_pair_balances_its_load(run: Run) -> None:
    found = run.part("vibration")
    assert found.attrs["status"] == json.dumps(["a solution was found"])
    assert float(found["natural_frequency"][0]) > float(found["mesh_frequency"][0])
    # Two pairs where both carry: the mean of the sum is one, so a pair carries one or less on average.
    summed = found["dynamic_factor"].isel(torque=0).sum("pair")
    assert float(summed.min()) < 1.0 < float(summed.max())
    assert (
        0.0
        < float(found["static_transmission_error_range"][0])
        < 2.0 * float(found["transmission_error_range"][0])
    )


def test_report_has_the_sections(run: Run) -> None:
    for heading in ("Mesh stiffness", "Vibration"):
        assert f">{heading}<" in run.report
    assert "ISO 6336" in run.report
    models = {model["effect"]: model["name"] for model in run.kept.manifest["models"]}
    assert models["load sharing"] == "from_stiffness"
    assert models["tooth compliance"] == "beam_foundation_weber"
    assert models["tooth contact"] == "linear"


def test_what_was_set_is_said_to_be_set(run: Run) -> None:
    rows = {(row["table"], row["key"]): row for row in run.kept.manifest["inputs"]}
    assert rows["models", "load_sharing"]["status"] == "set"
    assert rows["dynamics", "damping_ratio"]["status"] == "set"


# ------------------------------------------------------------------ what an engineer knows


def test_pair_with_four_teeth_from_what_an_engineer_knows(file: Callable[[str], str]) -> None:
    built = load_case(file(ENGINEER))
    found = built.dimensions
    told = "The tip of gear 1 would be thinner than 0.25 modules and is shortened by 0.265 modules"
    assert any(told in text for text in built.warnings)
    assert float(found["transverse_contact_ratio"]) == pytest.approx(0.8880, abs=5e-5)
    assert float(found["overlap_ratio"]) == pytest.approx(1.1613, abs=5e-5)
    assert float(found["centre_distance"]) == pytest.approx(44.9971e-3, abs=5e-8)
    assert found["tip_alteration"] == pytest.approx([-0.3221, -0.0568], abs=5e-5)
    assert found["tip_thickness"][0] == pytest.approx(0.25 * 1.5e-3, rel=1e-9)
    assert found["undercut_limit"][0] == pytest.approx(0.7223, abs=5e-5)


def test_pair_with_four_teeth_is_pointed_without_a_least_tip(file: Callable[[str], str]) -> None:
    with pytest.raises(InputError, match="beyond the point of the teeth") as caught:
        load_case(file(ENGINEER), settings={"gears.least_tip_thickness": 0.0})
    assert caught.value.key is not None
    assert caught.value.key.startswith("gears.")


# ------------------------------------------------------------------ teeth that part


def vibration(path: str, folder: Path, **settings: Any) -> tuple[xr.Dataset, list[str]]:
    name, tree = find_case(path)
    changes = {key.replace("__", "."): value for key, value in settings.items()}
    outcome = parts_of(Variant(tree, name, "default", changes), folder, "vibration")
    return outcome.parts["vibration"], outcome.manifest["warnings"]


@pytest.mark.whole
def test_teeth_that_part_near_resonance(file: Callable[[str], str], tmp_path: Path) -> None:
    path = file(SPUR)
    linear, told = vibration(path, tmp_path)
    ratio = float(linear["mesh_frequency"][0] / linear["natural_frequency"][0])
    assert ratio == pytest.approx(0.9, abs=0.01)
    assert float(linear["dynamic_factor"].min()) < -0.5
    (sentence,) = (text for text in told if text.startswith("Vibration at 100 N m"))
    assert "a force is negative: the teeth would separate" in sentence

    separating, told = vibration(path, tmp_path, models__tooth_contact="separating")
    assert not [text for text in told if text.startswith("Vibration at")]
    assert float(separating["dynamic_factor"].min()) == 0.0
    assert float(separating["dynamic_factor"].max()) > 1.2
    # Teeth that may leave each other do not pull, and swing less.
    swings = [float(found["transmission_error_range"][0]) for found in (separating, linear)]
    assert 0.4 < swings[0] / swings[1] < 0.9

    unstable, told = vibration(path, tmp_path, operation__speed="13750 rpm")
    assert float(unstable["largest_multiplier"][0]) > 1.0
    assert any("Floquet multiplier is larger than one" in text for text in told)

    calm, told = vibration(path, tmp_path, operation__speed="4000 rpm")
    assert not [text for text in told if text.startswith("Vibration at")]
    assert float(calm["dynamic_factor"].min()) >= 0.0


@pytest.mark.parametrize("ratio", ["1.2", "0", "-0.1", "nan"])
def test_damping_ratios_that_are_none(ratio: str, file: Callable[[str], str]) -> None:
    with pytest.raises(InputError) as caught:
        load_case(file(SPUR), settings=cli._settings([f"dynamics.damping_ratio={ratio}"]))
    told = str(caught.value)
    assert told.startswith("pair.toml: dynamics.damping_ratio: ")
    assert "\n" not in told


# ------------------------------------------------------------------ warm plastic teeth

WARM = {
    "materials.gear_2": "POM-H",
    "models.friction": {"name": "constant", "coefficient": 0.2},
    "models.load_sharing": "from_stiffness",
}


@pytest.mark.whole
def test_warm_wheel_is_softer_and_says_so(file: Callable[[str], str]) -> None:
    path = file(ENGINEER)
    warming = WARM | {"models.tooth_temperature": "vdi_2736_2"}
    cold, warm = (load_case(path, settings=given) for given in (WARM, warming))
    young = [float(built.design.solids[1].young) for built in (cold, warm)]
    assert young[0] == pytest.approx(3.25e9, rel=1e-12)
    # Linear between 3.25 GPa at 23 degC and 0.7 GPa at 100 degC.
    rise = warm.solids[1].temperature - 296.15
    assert 5.0 < rise < 15.0
    assert young[1] == pytest.approx(3.25e9 - 2.55e9 / 77.0 * rise, rel=1e-9)
    assert float(warm.design.solids[0].young) == float(cold.design.solids[0].young)

    stiff = [float(stiffness_part(built)["mean_stiffness"]) for built in (cold, warm)]
    # Nearly in proportion to the modulus of the wheel, which yields most.
    assert 0.9 * (1.0 - young[1] / young[0]) < 1.0 - stiff[1] / stiff[0] < 1.0 - young[1] / young[0]

    (manifest,) = uncomputed_manifests(path, settings=warming)
    (sentence,) = (text for text in manifest["warnings"] if text.startswith("The teeth of gear 2"))
    assert f"{warm.solids[1].temperature - 273.15:.1f}".rstrip("0").rstrip(".") in sentence
    assert "POM-H: its modulus is known from -40 degC to 100 degC, interpolated" in sentence
    brief = as_doubt(sentence).brief
    assert brief.startswith("Gear 2 is warm: root at ") and len(brief) <= BRIEF
    notes = {row["key"]: row["note"] for row in printed_input_rows(manifest)}
    assert notes["gear 2, Young's modulus"] == sentence
    (manifest,) = uncomputed_manifests(path, settings=WARM)
    assert not any("The teeth of gear 2" in text for text in manifest["warnings"])

    told = summaries([warm], warm.models, {}, title="warm").attrs["warming"]
    assert json.loads(told)["sentence"] == "a solution was found"
    assert "warming" not in summaries([cold], cold.models, {}, title="cold").attrs


@pytest.mark.parametrize(
    ("settings", "temperature"),
    [
        ({"operation.temperature": "110 degC"}, "110 degC"),
        (
            {"operation.temperature": "95 degC", "models.tooth_temperature": "vdi_2736_2"},
            "103.9 degC",
        ),
    ],
    ids=["around the gears", "of the warm teeth"],
)
def test_temperature_outside_the_table_of_moduli(
    settings: dict[str, Any], temperature: str, file: Callable[[str], str]
) -> None:
    with pytest.raises(InputError) as caught:
        load_case(file(ENGINEER), settings=WARM | settings)
    told = str(caught.value)
    assert told.startswith(
        "pair.toml: materials.gear_2: the modulus of POM-H is known from -40 degC"
    )
    assert f"a temperature of {temperature} is not allowed" in told


@eqx.filter_jit
def course_on(driven: Excitation, grid: PeriodGrid) -> ExcitationCourse:
    return driven.on(grid)


@pytest.mark.parametrize("order", quick_first([40, 1, 13]))
def test_every_order_of_a_profile_error_is_resolved(order: int, file: Callable[[str], str]) -> None:
    """Between the events nothing else moves as fast: an error read too coarsely would alias."""
    given = [{"order": order, "amplitude": "2 um", "phase": "30 deg"}]
    # A contact that yields in proportion to its load pushes from where flanks touch: no gap is added.
    linear = {"models.tooth_compliance": "beam_foundation_hertz"}
    built = load_case(file(SPUR), settings={"dynamics.profile_error": given} | linear)
    _, _, driven = _excited(built.design, built.operation, built.terms, vibrating_of(built))
    course = course_on(driven, PeriodGrid.resolving(order))
    wanted = 2e-6 * np.cos(2.0 * np.pi * order * np.asarray(course.phase) + np.pi / 6.0)
    long = np.diff(np.asarray(course.bounds)) > 0.0
    np.testing.assert_allclose(np.asarray(course.error)[0][long], wanted[long], atol=2e-11)


def test_both_ways_to_say_a_tip_are_refused(file: Callable[[str], str]) -> None:
    both = {"gears.tip_alteration": -0.1, "gears.least_tip_thickness": 0.3}
    with pytest.raises(InputError, match="were both given"):
        load_case(file(ENGINEER), settings=both)


@pytest.mark.whole
def test_a_small_backlash_brings_the_back_flanks_into_contact(
    file: Callable[[str], str], tmp_path: Path
) -> None:
    near = {"operation.speed": "12400 rpm", "dynamics.damping_ratio": 0.02}
    parting = near | {"models.tooth_contact": "separating"}
    built = [
        load_case(file(SPUR), settings=parting | {"dynamics.backlash": value})
        for value in ("10 mm", "0 um")
    ]
    free, tight = (vibration_part(one) for one in built)
    assert float(free.dynamic_factor.min()) >= 0.0
    assert float(tight.dynamic_factor.min()) < 0.0, "back flanks push the other way"
