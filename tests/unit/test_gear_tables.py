"""Tables of the gear families: how keys are found, what is left open, and what a change of form does."""

import copy
import tomllib
from typing import Any

import numpy as np
import pytest

from pitchpoint.cases.build import laws_of
from pitchpoint.cases.document import resolve
from pitchpoint.cases.inputs import resolved
from pitchpoint.cases.schema import Case, quantity_at, validate
from pitchpoint.cases.studies import Variant, jobs
from pitchpoint.errors import InputError
from pitchpoint.gears.strain_wave_design import DOUBLE_ARCS

DRIVE = tomllib.loads("""
[gears]
family = "strain_wave"
teeth = [200, 202]
module = "0.3 mm"
face_width = "10 mm"
[lubricant]
name = "pao-vg-100"
[roughness]
ra = "0.4 um"
[operation]
torque = "67 N m"
speed = "2000 rpm"
temperature = "40 degC"
""")
PAIR = {**DRIVE, "gears": {"teeth": [23, 61], "module": "2 mm", "face_width": "20 mm"}}


def drive(**settings: Any) -> Variant:
    changes = {key.replace("__", "."): value for key, value in settings.items()}
    return Variant(copy.deepcopy(DRIVE), "drive.toml", "default", changes)


def case(tree: dict[str, Any], settings: dict[str, Any] | None = None) -> Case:
    return validate(resolve(tree, name="x.toml", variant="default", settings=settings))


def test_what_is_left_open_is_as_usual_for_the_family() -> None:
    wave, pair = case(DRIVE), case(PAIR)
    assert pair.gears.family == "cylindrical"
    assert (pair.operation.driver, wave.operation.driver) == ("gear 1", "wave generator")
    assert (pair.models.load_sharing, wave.models.load_sharing) == ("equal", "from_stiffness")
    names = [one.models.friction[0].name for one in (pair, wave)]
    assert names == ["iso_tr_14179_2", "constant"]
    given = case({**DRIVE, "models": {"load_sharing": "xu_2021_cosine"}})
    assert given.models.load_sharing == "xu_2021_cosine"


def test_the_driver_is_never_the_fixed_member() -> None:
    held = case(DRIVE, {"gears.fixed": "wave generator"})
    assert held.operation.driver == "flexspline"
    with pytest.raises(InputError, match="is fixed and cannot drive; use wave generator or circ"):
        case(DRIVE, {"gears.fixed": "flexspline", "operation.driver": "flexspline"})


@pytest.mark.parametrize(
    ("key", "kind"),
    [
        ("gears.module", "length"),
        ("gears.teeth.1", "dimensionless"),
        ("gears.wave_generator.deflection", "dimensionless"),
        ("gears.tooth.convex_radius", "dimensionless"),
        ("gears.tooth.pressure_angle", "angle"),
        ("gears.flexspline.rim_thickness", "length"),
        ("losses.bearing.preload", "force"),
    ],
)
def test_keys_of_every_family_are_found(key: str, kind: str) -> None:
    found = quantity_at(key)
    assert found is not None
    assert found.kind == kind


def test_with_a_case_the_keys_are_those_of_its_family() -> None:
    for tree, wrong, known in [
        (DRIVE, "gears.helix_angle", "backlash"),
        (PAIR, "gears.backlash", "flank"),
        (DRIVE, "gears.tooth.pressure_angle", "convex_radius"),
    ]:
        with pytest.raises(InputError, match=f"there is no such key.*{known}"):
            quantity_at(wrong, tree)
    least = quantity_at("gears.teeth.2", DRIVE)
    assert least is not None
    assert least.low == 30


def test_values_of_the_set_stand_where_none_is_given() -> None:
    built = drive(gears__tooth__set="flat", gears__tooth__convex_radius=1.98).built({})
    rows = {row["key"]: row for row in resolved(built, drive().document())}
    assert rows["tooth.convex_radius"]["value"] == "1.98"
    assert rows["tooth.concave_radius"]["value"] == f"{DOUBLE_ARCS['flat'].concave_radius:g}"
    assert rows["tooth.concave_radius"]["status"] == "derived"
    assert rows["flexspline.rim_thickness"]["value"] == "0.6 mm"
    assert rows["speed ratio"]["value"] == "100"


def test_another_form_leaves_the_values_of_the_former() -> None:
    tree = copy.deepcopy(DRIVE)
    tree["gears"]["tooth"] = {"set": "flat", "convex_radius": 2.05, "dedendum": 0.8}
    change = {"gears.tooth.form": "involute", "gears.tooth.profile_shift": 3.32}
    tooth = case(tree, change).gears.tooth
    assert (tooth.form, tooth.profile_shift, tooth.dedendum) == ("involute", 3.32, 0.8)
    with pytest.raises(InputError, match=r"gears\.tooth\.convex_offset: is not a known key"):
        case(tree, {**change, "gears.tooth.convex_offset": 1.3})
    assert tree["gears"]["tooth"]["set"] == "flat"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"models.friction": "iso_tr_14179_2"}, "models.friction: 'iso_tr_14179_2' is a law for a"),
        ({"models.load_sharing": "equal"}, "models.load_sharing: 'equal' holds where all flanks"),
        ({"models.tooth_temperature": "vdi_2736_2"}, "models.tooth_temperature: 'vdi_2736_2' asks"),
        ({"dynamics.damping_ratio": 0.1}, "dynamics: vibration is computed along a line of action"),
        ({"gears.teeth": [200, 203]}, "gears.teeth: 200 and 203 teeth were given"),
        ({"gears.wave_generator.deflection": 2.0}, "gears.wave_generator.deflection: the wave"),
        ({"gears.tooth.set": "liu", "gears.tooth.convex_radius": 4.0}, "gears.tooth: the arcs of"),
        ({"operation.temperature": "150 degC"}, "operation.temperature: 150 degC is outside"),
    ],
    ids=lambda given: str(given)[:40],
)
def test_what_a_drive_cannot_have(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as caught:
        drive().built(changes)
    assert str(caught.value).startswith(f"drive.toml: {words}")


def test_only_laws_that_hold_are_compiled_in() -> None:
    models, _ = laws_of(drive().built({}))
    assert {law.name for law in models.friction} == {"constant", "frictionless", "xu_2007"}


def test_losses_stand_between_bodies() -> None:
    loss = {"between": ["flexspline", "wave generator"], "bearing": "palmgren_1959"}
    loss |= {"mean_diameter": "45 mm", "f0": 2.0, "f1": 0.001}
    seal = {"between": ["housing", "circular spline"], "seal_torque": "0.1 N m"}
    tree = {**DRIVE, "losses": {"bearing": loss, "seal": seal}}
    bearing, other = Variant(tree, "x.toml", "default").built({}).design.drag
    np.testing.assert_array_equal(bearing.between, [-1.0, 1.0, 0.0])
    np.testing.assert_array_equal(other.between, [0.0, 0.0, -1.0])
    assert (bearing.support, other.support) == (0, None)
    assert float(other.seal_torque) == 0.1


def test_a_grease_says_what_is_assumed_of_it() -> None:
    built = drive(lubricant__thickener="lithium soap").built({})
    assert any("is taken as its base oil" in text for text in built.warnings)


def test_backwards_the_loaded_member_carries_the_same_power() -> None:
    from pitchpoint.cases.studies import _backwards

    one = drive()
    built = one.built({})
    back = _backwards(one, built)
    assert (back.case.operation.driver, back.loaded) == ("flexspline", "wave generator")
    assert back.case.operation.torque == pytest.approx(0.67)
    assert back.case.operation.speed == pytest.approx(built.case.operation.speed / 100.0)


def test_the_parts_of_a_drive() -> None:
    names = [job.name for job in jobs(drive(), {})]
    assert names == ["teeth", "cycle", "operation", "laws", "torsion", "loss_map", "back_driving"]


def test_sweeps_of_a_drive_are_looked_at_before_they_run() -> None:
    from pitchpoint.cases.schema import Study, Sweep

    for key, start, stop in [
        ("gears.wave_generator.deflection", 0.98, 1.02),
        ("gears.flexspline.rim_thickness", "0.5 mm", "0.7 mm"),
        ("gears.teeth.1", 198, 200),
    ]:
        study = Study(sweep=Sweep(key=key, start=start, stop=stop, count=2))
        assert "study_s" in [job.name for job in jobs(drive(), {"s": study})]
    alone = Study(sweep=Sweep(key="gears.tooth.convex_radius", start=1.35, stop=1.37, count=2))
    with pytest.raises(InputError, match="or name the set that gives what is left out"):
        list(jobs(drive(), {"s": alone}))
    named = drive(gears__tooth__set="liu")
    assert "study_s" in [job.name for job in jobs(named, {"s": alone})]
