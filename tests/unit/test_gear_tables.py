"""Tables of the gear families: how keys are found, what is left open, and what a change of form does."""

import copy
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest
from sound import WAVE

from pitchpoint._jax import jax, jnp
from pitchpoint.analyses.caveats import proportions_counted, proportions_words
from pitchpoint.cases.document import resolve
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.resolved_inputs import resolved
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.validation import validate
from pitchpoint.cases.variant import Variant
from pitchpoint.contact.surface import Waves
from pitchpoint.efficiency.quasi_static import Design
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.gears.pairs import largest_radius
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.gears.strain_wave.design import check_strain_wave
from pitchpoint.gears.strain_wave.proportions import PROPORTIONS
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.input.quantities import SIValue
from pitchpoint.loading.reactions import InnerBearing
from pitchpoint.lubrication.applicability import why_inapplicable
from pitchpoint.lubrication.lubrication_registry import LAWS
from pitchpoint.runs.jobs import jobs
from pitchpoint.views.inputs import printed_input_rows

DRIVE = tomllib.loads(WAVE)
PAIR = {**DRIVE, "gears": {"teeth": [23, 61], "module": "2 mm", "face_width": "20 mm"}}


def drive(**settings: Any) -> Variant:
    changes = {key.replace("__", "."): value for key, value in settings.items()}
    return Variant(copy.deepcopy(DRIVE), "drive.toml", "default", changes)


def case(tree: dict[str, Any], settings: dict[str, Any] | None = None) -> CaseFile:
    return validate(resolve(tree, name="x.toml", variant="default", settings=settings))


def test_what_is_left_open_is_as_usual_for_the_family() -> None:
    wave, pair = case(DRIVE), case(PAIR)
    assert pair.gears.family == "cylindrical"
    assert (pair.operation.driver, wave.operation.driver) == ("gear 1", "wave generator")
    assert (pair.models.load_sharing, wave.models.load_sharing) == ("equal", "from_stiffness")
    names = [one.models.friction[0].name for one in (pair, wave)]
    assert names == ["iso_tr_14179_2", "constant"]
    assert {one.models.film_thickness for one in (pair, wave)} == {"dowson_higginson_1959"}
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
        (PAIR, "gears.fixed", "centre_distance"),
        (DRIVE, "gears.tooth.pressure_angle", "circular_spline"),
    ]:
        with pytest.raises(InputError, match=f"there is no such key.*{known}"):
            quantity_at(wrong, tree)
    least = quantity_at("gears.teeth.2", DRIVE)
    assert least is not None
    assert least.low == 30


def test_values_of_the_set_stand_where_none_is_given() -> None:
    built = drive(gears__tooth__set="flat", gears__tooth__convex_radius=1.98).built({})
    rows = {row["key"]: row for row in resolved(built, drive().document())}
    assert rows["tooth.convex_radius"]["value"] == 1.98
    assert rows["tooth.concave_radius"]["value"] == DOUBLE_ARCS["flat"].concave_radius
    assert rows["tooth.concave_radius"]["status"] == "derived"
    assert rows["flexspline.rim_thickness"]["value"] == pytest.approx(0.6e-3)
    assert rows["flexspline.rim_thickness"]["kind"] == "length"
    assert rows["speed_ratio"]["value"] == pytest.approx(100.0)


def test_what_lies_behind_the_teeth_stands_among_the_inputs_with_its_status() -> None:
    """Of 60 mm pitch diameter; what the case gives is given, what it leaves open is assumed and says how."""
    parts = {"gears.wave_generator.bearing": {"balls": 21}, "gears.yielding": {"bolts": 6}}
    parts["gears.yielding"] |= {"wave_generator": "rigid"}
    known = Variant(copy.deepcopy(DRIVE), "drive.toml", "default", parts)
    built = known.built({})
    rows = {row["key"]: row for row in resolved(built, known.document())}
    assumed = {
        "wave_generator.bearing.ball_diameter": (PROPORTIONS.ball * 60e-3, "0.078 of the pitch"),
        "wave_generator.bearing.race_thickness": (PROPORTIONS.race * 60e-3, "0.0125 of the pitch"),
        "flexspline.rim_thickness": (0.6e-3, "by the strain of its wave"),
        "flexspline.wall_thickness": (0.3e-3, "half of the rim"),
        "flexspline.cup_length": (30e-3, "half of the pitch diameter"),
        "yielding.bottom_thickness": (0.6e-3, "as thick as the rim"),
        "yielding.flange_diameter": (PROPORTIONS.flange * 60e-3, "of the pitch diameter"),
        "yielding.bolt_circle": (PROPORTIONS.bolt_circle * 60e-3, "of the pitch diameter"),
        "yielding.bolt_diameter": (PROPORTIONS.bolt * 60e-3, "of the pitch diameter"),
        "yielding.outside_diameter": (PROPORTIONS.outside * 60e-3, "of the pitch diameter"),
    }
    for key, (value, rule) in assumed.items():
        assert rows[key]["value"] == pytest.approx(value, rel=1e-12)
        assert rows[key]["status"] == "assumed"
        assert rule in rows[key]["note"]
        assert not rows[key]["given"]
    assert set(built.assumed) == set(assumed)
    for key, value in (("wave_generator.bearing.balls", 21), ("yielding.bolts", 6)):
        assert (rows[key]["value"], rows[key]["given"]) == (value, True)
    assert not [key for key in rows if "shaft" in key]  # of a rigid one nothing is asked


@pytest.mark.parametrize(
    ("walls", "words"),
    [("two modules", "follow from the module"), ("bending strain", "follow from the wave")],
)
def test_stiffness_says_what_of_it_is_assumed_and_what_changes_with_the_ratio(
    walls: str, words: str
) -> None:
    built = drive(gears__flexspline__walls=walls).built({})
    told = proportions_words([built, built])
    assert told.startswith("; assumed proportions: rim thickness, wall thickness, cup length; rim")
    assert told.count(words) == 1
    assert proportions_counted([built, built]).startswith("; 3 dimensions of its parts are assumed")
    given = {"rim_thickness": "0.6 mm", "wall_thickness": "0.3 mm", "cup_length": "30 mm"}
    assert proportions_words([drive(gears__flexspline=given).built({})]) == ""
    two = {key: given[key] for key in ("rim_thickness", "cup_length")}
    assert proportions_counted([drive(gears__flexspline=two).built({})]).startswith("; 1 dimension")
    pair = [Variant(PAIR, "pair.toml", "default").built({})]
    assert proportions_words(pair) == proportions_counted(pair) == ""


def test_another_form_leaves_the_values_of_the_former() -> None:
    tree = copy.deepcopy(DRIVE)
    tree["gears"]["tooth"] = {"set": "flat", "convex_radius": 2.05, "dedendum": 0.8}
    change = {"gears.tooth.form": "involute", "gears.tooth.profile_shift": 3.32}
    tooth = case(tree, change).gears.tooth
    assert (tooth.form, tooth.profile_shift, tooth.dedendum) == ("involute", 3.32, 0.8)
    with pytest.raises(InputError, match=r"gears\.tooth\.convex_offset: is not a known key"):
        case(tree, {**change, "gears.tooth.convex_offset": 1.3})
    assert tree["gears"]["tooth"]["set"] == "flat"


JOINT = {"inertia": ["0.6 kg cm2", "1 kg m2"]}
STILL = {"start": "0 rpm", "stop": "900 rpm"}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"models.friction": "iso_tr_14179_2"}, "models.friction: 'iso_tr_14179_2' is a law for a"),
        ({"models.load_sharing": "equal"}, "models.load_sharing: 'equal' holds where all rigid"),
        ({"models.tooth_temperature": "vdi_2736_2"}, "models.tooth_temperature: 'vdi_2736_2' asks"),
        (
            {"dynamics.damping_ratio": 0.1},
            "dynamics.inertia: is missing; a joint vibrates between two",
        ),
        (
            {"dynamics": {**JOINT, "backlash": "1 um"}},
            "dynamics.backlash: was given; it is for vib",
        ),
        (
            {"dynamics": {**JOINT, "damping_ratio": 0.0}},
            "dynamics.damping_ratio: 0.0 is out of range",
        ),
        ({"dynamics.inertia": ["-1 kg m2", "1 kg m2"]}, 'dynamics.inertia: "-1 kg m2" is out of'),
        (
            {"dynamics": {**JOINT, "speeds": STILL}},
            'dynamics.speeds.start: "0 rpm" is out of range',
        ),
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


def test_one_moment_of_inertia_counts_for_motor_and_load() -> None:
    def told(inertia: Any) -> list[str]:
        warnings = drive().built({"dynamics": {"inertia": inertia}}).warnings
        return [text for text in warnings if "same moment of inertia" in text]

    assert len(told("1 kg cm2")) == 1
    assert told(["1 kg cm2", "1 kg cm2"]) == []


def test_only_chosen_laws_are_compiled_in() -> None:
    (models,) = drive().built({}).models
    assert [law.name for law in models.friction] == ["constant"]
    chosen = ["xu_2007", {"name": "constant", "coefficient": 0.03}]
    built = Variant({**PAIR, "models": {"friction": chosen}}, "pair.toml", "default").built({})
    assert built.law_names == ["xu_2007", "constant"]
    assert {models.friction for models in built.models} == {tuple(built.laws)}
    assert float(built.models[1].parameters["constant"]["coefficient"]) == 0.03


def test_a_law_applies_or_says_why_not() -> None:
    wave, pair = drive().built({}), Variant(PAIR, "pair.toml", "default").built({})
    why_not = [why_inapplicable(law, wave.design.mesh) for law in LAWS if law.sources]
    assert why_not == [
        "'iso_tr_14179_2' is a law for a whole mesh, and these gears have no pitch point",
        None,
    ]
    assert not any(why_inapplicable(law, pair.design.mesh) for law in LAWS)


def test_losses_stand_between_bodies() -> None:
    loss = {"between": ["flexspline", "wave generator"], "bearing": "palmgren_1959"}
    loss |= {"mean_diameter": "45 mm", "f0": 2.0, "f1": 0.001}
    seal = {"between": ["housing", "circular spline"], "seal_torque": "0.1 N m"}
    tree = {**DRIVE, "losses": {"bearing": loss, "seal": seal}}
    bearing, other = Variant(tree, "x.toml", "default").built({}).design.drag
    np.testing.assert_array_equal(bearing.between, [-1.0, 1.0, 0.0])
    np.testing.assert_array_equal(other.between, [0.0, 0.0, -1.0])
    assert isinstance(bearing.seat, InnerBearing)
    assert other.seat is None
    assert float(other.seal_torque) == 0.1


def test_a_grease_says_what_is_assumed_of_it() -> None:
    built = drive(lubricant__thickener="lithium soap").built({})
    assert any("is taken as its base oil" in text for text in built.warnings)


def test_backwards_the_loaded_member_carries_the_same_power() -> None:
    built = drive().built({})
    back = built.backwards
    assert (back.case.operation.driver, back.loaded) == ("flexspline", "wave generator")
    assert back.case.operation.torque == pytest.approx(0.67)
    assert back.case.operation.speed == pytest.approx(built.case.operation.speed / 100.0)
    assert float(back.operation.load) == back.case.operation.torque
    demand_same(back.backwards.design, built.design)


def demand_same(one: Any, other: Any) -> None:
    """Trees that are alike for the compiler and hold equal numbers."""
    assert jax.tree.structure(one) == jax.tree.structure(other)
    for first, second in zip(jax.tree.leaves(one), jax.tree.leaves(other), strict=True):
        assert first.dtype == second.dtype
        np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize("fixed", ["circular spline", "flexspline", "wave generator"])
def test_a_drive_driven_by_another_member_is_the_one_that_the_file_would_give(fixed: str) -> None:
    one = drive(gears__fixed=fixed)
    usual = one.built({})
    first, other = usual.case.gears.drivers
    assert (usual.driver, usual.loaded) == (first, other)
    for driver in (first, other):
        asked = one.built({"operation.driver": driver}).design
        demand_same(usual.design.driven_by(driver), asked)
    demand_same(usual.design.backwards, asked)
    with pytest.raises(InputError, match=f"the {fixed} is fixed and cannot drive"):
        usual.design.driven_by(fixed)
    with pytest.raises(InputError, match=f'"{fixed}" is fixed'):
        one.built({"operation.driver": fixed})


@pytest.mark.parametrize(("teeth", "addendum"), [([23, 61], 1.0), ([20, -70], [1.0, 0.8])])
def test_a_pair_driven_by_its_wheel_is_the_one_that_the_file_would_give(
    teeth: list[int], addendum: float | list[float]
) -> None:
    short = {"gears.teeth": teeth, "gears.addendum": addendum}
    pair = Variant(PAIR, "pair.toml", "default", short)
    wheel, pinion = pair.built({"operation.driver": "gear 2"}).design, pair.built({}).design
    demand_same(pinion.backwards, wheel)
    demand_same(wheel.backwards, pinion)
    with pytest.raises(
        InputError, match="'ring' is no member of this drive; use one of gear 1, gear 2"
    ):
        mesh_ends(wheel.mesh, "ring")


def test_backwards_plastic_teeth_are_as_warm_as_that_point_makes_them() -> None:
    models = {"tooth_temperature": "vdi_2736_2", "friction": "xu_2007"}
    plastic = {"materials": {"gear_2": "POM-H"}, "models": models}
    pair = Variant({**PAIR, **plastic}, "pair.toml", "default", {"operation.torque": "2 N m"})
    built, point = pair.built({}), pair.built({}).case.operation
    step = 61 / 23
    asked = {"driver": "gear 2", "torque": point.torque / step, "speed": point.speed / step}
    si = {f"operation.{k}": v if k == "driver" else SIValue(v) for k, v in asked.items()}
    wheel, back = pair.built(si).solids[1], built.backwards.solids[1]
    assert back.temperature == pytest.approx(wheel.temperature, rel=1e-13)
    assert float(back.solid.young) == pytest.approx(float(wheel.solid.young), rel=1e-12)
    assert back.temperature != built.solids[1].temperature


def test_running_without_load_is_told_at_the_operating_point() -> None:
    from pitchpoint.analyses.running import running_axes

    for settings, sizes in [
        ({}, (9, 7)),  # speed and temperature are among the axes' own
        ({"operation.temperature": "50 degC"}, (9, 8)),
        ({"loss_map.temperatures": ["20 degC", "60 degC"], "loss_map.speed": "2100 rpm"}, (10, 3)),
        ({"loss_map.speed": "1000 rpm"}, (10, 7)),
    ]:
        built = Variant(PAIR, "pair.toml", "default", settings).built({})
        point, axes = built.case.operation, running_axes(built)
        assert tuple(axis.size for axis in axes) == sizes
        assert all((np.diff(axis) > 1e-6).all() for axis in axes)
        assert point.speed in axes[0]
        assert point.temperature in axes[1]


def test_what_a_loop_of_torque_cannot_show_is_said() -> None:
    from pitchpoint.analyses.torsion import _loopless, _lost

    built = Variant(PAIR, "pair.toml", "default", {"operation.torque": "0 N m"}).built({})
    (told,) = _loopless(built, np.zeros(1))
    assert "nothing is carried at the operating point" in told
    built = Variant(PAIR, "pair.toml", "default").built({})
    (told,) = _loopless(built, np.array([np.nan]))
    assert "friction locks the drive at the operating point" in told
    assert _loopless(built, np.array([0.05])) == []
    (told,) = _lost(built, np.array([0.0, np.nan, 1.0, np.nan]), np.array([0.0, 1.0, 2.0, 3.0]))
    assert "at 2 of 4 torques (1 N m to 3 N m)" in told
    assert _lost(built, np.zeros(2), np.ones(2)) == []


def test_balls_that_press_teeth_or_stand_elsewhere_are_told() -> None:
    from pitchpoint.analyses.torsion import _of_balls, _pressed

    assert _pressed(0.0) == []
    (told,) = _pressed(-np.deg2rad(0.25 / 60.0))
    assert "press the teeth onto both flanks of their spaces, by 0.25 arcmin" in told
    assert _of_balls({}, 1.0) == ""
    assert _of_balls({"wind_up_by_balls": 1e-5}, 0.0) == ""
    told = _of_balls({"wind_up_by_balls": -1.234e-5}, 1e-3)
    assert told.endswith("the wind-up at the operating point is 1.2 % smaller")
    assert _of_balls({"wind_up_by_balls": 1e-5}, 1e-3).endswith("1 % larger")


def test_conformal_contacts_that_carry_are_told() -> None:
    from pitchpoint.analyses.caveats import conformal_warning

    wave, pair = (one.built({}).design.mesh for one in (drive(), Variant(PAIR, "", "default")))
    assert float(largest_radius(wave)) == pytest.approx(2000 * 0.3e-3)
    assert largest_radius(pair) == np.inf
    run = {"load": np.array([0.0, 1.0, 2.0]), "radius": 2000 * 0.3e-3 * np.array([1.0, 1.0, 0.5])}
    (told,) = conformal_warning(wave, run)
    assert told.startswith("1 of 2 loaded contacts of the mesh cycle are conformal")
    assert conformal_warning(pair, run) == []


def test_a_groove_that_was_not_found_whole_is_told() -> None:
    mesh = drive().built({}).design.mesh
    assert check_strain_wave(mesh) == ()
    lost = replace(mesh, groove=replace(mesh.groove, unsolved=jnp.asarray(3.0)))
    (told,) = check_strain_wave(lost)
    assert "could not be found at 3 of 640 heights" in told


WAVES = [{"order": 1, "amplitude": "5 um", "phase": "30 deg"}, {"order": 100, "amplitude": "3 um"}]


def test_deviations_are_read_and_shown() -> None:
    one = drive(gears__deviations__flexspline=WAVES)
    built = one.built({})
    inputs = resolved(built, one.document())
    rows = {row["key"]: row for row in printed_input_rows({"inputs": inputs})}
    told = "order 1 amplitude 5 um phase 30 deg, order 100 amplitude 3 um phase 0 deg"
    assert rows["deviations.flexspline"]["value"] == told
    assert rows["deviations.flexspline"]["status"] == "set"
    assert rows["deviations.circular_spline"]["value"] == "none"
    (row,) = (row for row in inputs if row["key"] == "deviations.flexspline")
    assert row["kind"] == {"order": "dimensionless", "amplitude": "length", "phase": "angle"}
    assert row["value"][0] == pytest.approx(
        {"order": 1.0, "amplitude": 5e-6, "phase": radians(30.0)}
    )
    (first,), second = built.deviations
    assert isinstance(first, Waves)
    np.testing.assert_allclose(first.amplitude[:2], [5e-6, 3e-6])
    np.testing.assert_allclose(first.phase[:2], [np.pi / 6.0, 0.0])
    assert not np.any(first.amplitude[2:])  # places that are filled up to a step
    assert second == ()
    assert drive().built({}).deviations == ((), ())
    order = quantity_at("gears.deviations.flexspline.order")
    assert order is not None
    assert order.whole


def test_deviations_leave_the_mesh_and_ask_for_one_part_more() -> None:
    one, plain = drive(gears__deviations__circular_spline=WAVES), drive()
    with_waves, without = (jax.tree.flatten(each.built({}).design) for each in (one, plain))
    assert with_waves[1] == without[1]
    for here, there in zip(with_waves[0], without[0], strict=True):
        np.testing.assert_array_equal(here, there)
    names, usual = ([job.name for job in jobs(each, {})] for each in (one, plain))
    usual.insert(usual.index("torsion") + 1, "kinematic_error")
    assert names == usual
    assert one.document().tree != plain.document().tree  # so the fingerprint is another


def test_states_without_equilibrium_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    from pitchpoint.analyses import kinematic_error as part

    def pieces(mesh: Any, period: Any, deviations: Any, count: int) -> Iterator[np.ndarray]:
        for start in range(0, count, part.TEETH):
            found = np.zeros((3, part.TEETH * part.PHASES))
            found[2, 10 if start == 0 else -1] = np.nan  # the last one lies beyond the turn
            yield found

    monkeypatch.setattr(part, "_period", lambda *given: None)
    monkeypatch.setattr(part, "_pieces", pieces)
    built = drive(gears__deviations__flexspline=WAVES).built({})
    deviations = built.deviations
    assert deviations is not None
    done: list[int] = []
    data = part.kinematic_error_part(built, deviations, done.append)
    assert done == [64, 128, 192, 256, 320, 384, 400]
    told = "Kinematic error: no equilibrium was found in 6 of 400 states."
    assert told in data.attrs["warnings"]
    assert np.isnan(data["kinematic_error_range"].values[2]).tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("key", "waves", "words"),
    [
        (
            "flexspline",
            [{"order": 101}],
            "0.order: 101 waves around the flexspline look like fewer",
        ),
        ("circular_spline", [{"order": 2}, {"order": 102}], "1.order: 102 waves around the circ"),
        ("flexspline", [{"order": 0}], "0.order: 0 is out of range; allowed is 1 to 1000"),
        ("flexspline", [{"order": 1.5}], "0.order: 1.5 is not a whole number"),
        ("flexspline", [{"amplitude": "1 um"}], "0.order: is missing; write 2; allowed is 1 to"),
        ("flexspline", [{"order": 2, "waves": 3}], "0.waves: is not a known key"),
        ("circular_spline", [{"order": 2, "amplitude": "3 deg"}], "0.amplitude: "),
        ("circular_spline", {"order": 2}, "the table { order = 2 } was given where a list belongs"),
        (
            "flexspline",
            [{"order": 1, "amplitude": "0.1 mm"}, {"order": 2, "amplitude": "0.1 mm"}],
            "the deviations of the flexspline add up to 200 um; allowed is half a module, 150 um",
        ),
        ("wave_generator", [{"order": 2}], "is not a known key"),
    ],
    ids=lambda given: str(given)[:30],
)
def test_deviations_that_cannot_be(key: str, waves: Any, words: str) -> None:
    if isinstance(waves, list) and "is missing" not in words:
        waves = [{"amplitude": "1 um", **wave} for wave in waves]
    tree = {**DRIVE, "gears": {**DRIVE["gears"], "deviations": {key: waves}}}
    with pytest.raises(InputError) as caught:
        case(tree)
    told = str(caught.value)
    assert told.startswith(f"x.toml: gears.deviations.{key}")
    assert words in told
    assert "\n" not in told


def test_the_parts_of_a_drive() -> None:
    names = [job.name for job in jobs(drive(), {})]
    assert names[:4] == ["teeth", "load_limits", "bodies", "cycle"]
    assert names[4:] == ["operation", "laws", "torsion", "loss_map", "back_driving"]


def test_sweeps_of_a_drive_are_looked_at_before_they_run() -> None:
    from pitchpoint.cases.study_tables import Study, Sweep

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


@pytest.mark.parametrize(
    ("table", "gears", "designation"),
    [
        (CylindricalGears, {}, "Spur pair 23/61"),
        (CylindricalGears, {"helix_angle": "20 deg"}, "Helical pair 23/61"),
        (CylindricalGears, {"teeth": [20, -70]}, "Spur gear in a ring 20/70"),
        (RackAndPinionGears, {"teeth": 20}, "Rack and pinion, 20 teeth"),
        (StrainWaveGears, DRIVE["gears"], "Strain wave gear 200/202"),
    ],
)
def test_gears_are_named_by_their_kind_and_their_teeth(
    table: type[GearsTable], gears: dict[str, Any], designation: str
) -> None:
    family = {"family": table.model_fields["family"].default}
    assert table.model_validate({**PAIR["gears"], **family, **gears}).designation == designation


def test_who_cannot_drive_or_be_loaded_is_told() -> None:
    pair = Variant(PAIR, "pair.toml", "default", {}).built({}).design
    with pytest.raises(InputError, match="gear 1 cannot drive and be loaded at once"):
        pair.driven_by("gear 1", "gear 1")
    with pytest.raises(InputError, match="one coordinate cannot drive and be loaded at once"):
        replace(pair, driver=pair.loaded)
    with pytest.raises(InputError, match="given together"):
        Design(pair.mesh, pair.solids, pair.lubricant, pair.roughness, driver=pair.driver)
    driver, loaded = mesh_ends(pair.mesh, loaded="gear 1")
    assert (driver.tolist(), loaded.tolist()) == ([0.0, 1.0], [1.0, 0.0])


def test_bodies_with_motors_of_their_own_drive_as_they_do() -> None:
    discs = TwinDisc(jnp.array([0.02, 0.035]), jnp.asarray(0.008), jnp.asarray(0.8))
    rig = replace(Variant(PAIR, "pair.toml", "default", {}).built({}).design, mesh=discs)
    rig = replace(rig, **dict(zip(("driver", "loaded"), mesh_ends(discs), strict=True)))
    for ask in (lambda: rig.backwards, lambda: rig.driven_by(1), lambda: mesh_ends(discs, 1, 0)):
        with pytest.raises(InputError, match="motors of their own"):
            ask()
