"""Modified and deviating cylindrical flanks from case files: keys, classes, kinematic error, refusals."""

import copy
import json
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sound import PAIR

from pitchpoint._jax import jax, jnp
from pitchpoint.analyses.caveats import AtWork, face_warning, faces_warning
from pitchpoint.analyses.kinematic_error import FEW_PAIRS, kinematic_error_part
from pitchpoint.analyses.summaries import profiles, summaries
from pitchpoint.analyses.vibration import (
    _excited,
    _grid,
    _stiffness,
    stiffness_part,
    vibrating_of,
)
from pitchpoint.cases.built import Built
from pitchpoint.cases.resolved_inputs import resolved
from pitchpoint.cases.variant import Variant
from pitchpoint.contact.deviations import ToothDeviations
from pitchpoint.core.status import Code, Status
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances, gear_at_its_limits, out_of_scope
from pitchpoint.gears.pairs import touching
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import wound_up
from pitchpoint.runs.jobs import jobs
from pitchpoint.views.inputs import printed_input_rows

TREE = tomllib.loads(PAIR)


def pair(**settings: Any) -> Variant:
    changes = {key.replace("__", "."): value for key, value in settings.items()}
    return Variant(copy.deepcopy(TREE), "pair.toml", "default", changes)


# ------------------------------------------------------------------ classes of ISO 1328-1


@pytest.mark.parametrize(
    ("tolerance_class", "size", "in_um"),
    [
        # Class 5 before rounding: 6.3, 19.8, 5.3, 6.65, 6.417, 7.165.
        (5, (0.1, 3e-3, 30e-3), (6.5, 20.0, 5.5, 6.5, 6.5, 7.0)),
        (6, (0.1, 3e-3, 30e-3), (9.0, 28.0, 7.5, 9.5, 9.0, 10.0)),
        (1, (0.1, 3e-3, 30e-3), (1.6, 5.0, 1.3, 1.7, 1.6, 1.8)),
        (11, (0.1, 3e-3, 30e-3), (50.0, 158.0, 42.0, 53.0, 51.0, 57.0)),
    ],
)
def test_limits_of_a_class_by_hand(
    tolerance_class: int, size: tuple[float, float, float], in_um: tuple[float, ...]
) -> None:
    names = dict(zip(("diameter", "module", "face_width"), size, strict=True))
    found = flank_tolerances(tolerance_class=tolerance_class, **names)
    assert [1e6 * value for value in vars(found).values()][:6] == pytest.approx(in_um, rel=1e-12)


@pytest.mark.parametrize("teeth", [17, 61, 120])
def test_a_gear_drawn_at_random_reaches_its_limits(teeth: int) -> None:
    size = {"diameter": 2e-3 * teeth, "module": 2e-3, "face_width": 20e-3}
    limits = flank_tolerances(tolerance_class=7, **size)
    found = gear_at_its_limits(limits, teeth, (1, 0))
    steps = np.diff(found.pitch, append=found.pitch[:1])
    assert np.ptp(found.pitch) == pytest.approx(limits.total_pitch, rel=1e-9)
    assert np.abs(steps).max() == pytest.approx(limits.single_pitch, rel=1e-9)
    # Most of the range is an eccentricity.
    assert 2.0 * np.abs(np.fft.rfft(found.pitch))[1] / teeth > 0.3 * limits.total_pitch
    for name in ("profile_slope", "profile_form", "helix_slope", "helix_form"):
        assert np.abs(getattr(found, name)).max() == pytest.approx(getattr(limits, name))
    again, other = (gear_at_its_limits(limits, teeth, (seed, 0)) for seed in (1, 2))
    np.testing.assert_array_equal(again.pitch, found.pitch)
    assert not np.allclose(other.pitch, found.pitch)


def test_few_teeth_of_an_eccentric_gear_stay_within_both_limits() -> None:
    limits = flank_tolerances(tolerance_class=5, diameter=0.012, module=2e-3, face_width=0.02)
    found = gear_at_its_limits(limits, 6, (3, 1)).pitch
    largest = np.abs(np.diff(found, append=found[:1])).max()
    assert largest == pytest.approx(limits.single_pitch)
    assert np.ptp(found) <= limits.total_pitch


def test_what_the_standard_leaves_out_is_told() -> None:
    sound = {"teeth": 20, "diameter": 0.04, "module": 2e-3, "face_width": 0.02, "helix_angle": 0.0}
    assert [*out_of_scope(**sound)] == []
    (told,) = out_of_scope(**{**sound, "module": 0.4e-3})
    assert told == "the normal module, 0.4 mm, is outside 0.5 to 70 mm"
    built = pair(gears__deviations__iso_class=5, gears__face_width="3 mm").built({})
    assert (
        "ISO 1328-1 does not hold for gear 1: the face width, 3 mm, is outside 4 to 1200 mm."
        in (built.warnings)
    )


# ------------------------------------------------------------------ keys

RELIEVED = {"gears__modifications__tip_relief": ["20 um", "15 um"]}


def test_modifications_are_read_and_shown_with_what_follows() -> None:
    one = pair(**RELIEVED, gears__modifications__end_relief="4 um", gears__misalignment="-3 um")
    built = one.built({})
    inputs = resolved(built, one.document())
    rows = {row["key"]: row for row in printed_input_rows({"inputs": inputs})}
    mesh = built.design.mesh
    length = (float(mesh.contact_ratio) - 1.0) * float(mesh.base_pitch)
    assert rows["modifications.tip_relief"]["value"] == "20 um / 15 um"
    assert rows["modifications.tip_relief_length"]["value"] == f"{1e3 * length:.6g} mm"
    assert rows["modifications.tip_relief_length"]["status"] == "derived"
    assert rows["modifications.end_relief_length"]["value"] == "2 mm"
    assert "modifications.root_relief" not in rows
    assert "modifications.root_relief_length" not in rows
    assert rows["misalignment"]["value"] == "-3 um"
    kinds = [[type(one).__name__ for one in own] for own in mesh.surfaces]
    assert kinds == [["Relief", "EndRelief", "LeadSlope"], ["Relief", "EndRelief"]]
    assert mesh.slices == 12


def test_sharing_of_modified_flanks_is_that_of_their_stiffness() -> None:
    shares = [each.built({}).case.models.load_sharing for each in (pair(), pair(**RELIEVED))]
    assert shares == ["equal", "from_stiffness"]
    misaligned = pair(gears__misalignment="3 um").built({})
    assert misaligned.case.models.load_sharing == "from_stiffness"
    assert misaligned.design.mesh.slices == 12
    assert pair(**RELIEVED).built({}).design.mesh.slices == 1  # nothing changes across the face


def test_a_sweep_over_the_relief_keeps_its_program() -> None:
    designs = [
        pair().built({"gears.modifications.tip_relief": amount}).design
        for amount in ("0 um", "20 um", ["5 um", "9 um"])
    ]
    assert len({jax.tree.structure(one) for one in designs}) == 1


def test_parts_of_modified_and_deviating_pairs() -> None:
    plain = [job.name for job in jobs(pair(), {})]
    modified = [job.name for job in jobs(pair(**RELIEVED), {})]
    deviating = [job.name for job in jobs(pair(gears__deviations__iso_class=6), {})]
    assert [name for name in modified if name not in plain] == ["torsion", "stiffness"]
    assert [name for name in deviating if name not in modified] == ["kinematic_error"]


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        (
            {"gears__modifications__tip_relief": "2 mm"},
            "modifications.tip_relief: 2000 um is more than a tooth allows; allowed is half a module, "
            "1000 um",
        ),
        (
            {"gears__modifications__crowning": "12 mm"},
            'modifications.crowning: "12 mm" is out of range; allowed is 0 um to 10000 um',
        ),
        (
            {**RELIEVED, "gears__modifications__tip_relief_length": ["3 mm", "30 mm"]},
            "modifications.tip_relief_length: the tip relief of gear 2 is 30 mm long; its active flank",
        ),
        (
            {"gears__modifications__root_relief_length": "3 mm"},
            "modifications.root_relief_length: was given without root_relief",
        ),
        (
            {
                "gears__modifications__end_relief": "5 um",
                "gears__modifications__end_relief_length": "11 mm",
            },
            "modifications.end_relief_length: the end relief of gear 1 takes 11 mm at each end; allowed is "
            "half the face width, 10 mm",
        ),
        (
            {"gears__modifications__crowning": "5 um", "models__slices": 2},
            "modifications.crowning: changes across the face, and 2 slices do not show that",
        ),
        (
            {"gears__modifications__relief_shape": "round"},
            'modifications.relief_shape: "round" is not allowed; use',
        ),
        ({"gears__modifications__relief": "5 um"}, "modifications.relief: is not a known key"),
        ({"gears__misalignment": "-1.5 mm"}, "misalignment: 1500 um is more than a tooth allows"),
        (
            {"gears__deviations__iso_class": 12},
            "deviations.iso_class: 12 is out of range; allowed is 1 to 11",
        ),
        ({"gears__deviations__iso_class": 0}, "deviations.iso_class: 0 is out of range"),
        (
            {"gears__deviations__iso_class": [5, 5.5]},
            "deviations.iso_class: 5.5 is not a whole number",
        ),
        ({"gears__deviations__seed": 1.5}, "deviations.seed: 1.5 is not a whole number"),
        (
            {"gears__deviations__gear_1": [{"order": 12, "amplitude": "1 um"}]},
            "deviations.gear_1.0.order: 12 waves around gear 1 look like fewer of them at its 23 teeth",
        ),
        (
            {"gears__deviations__gear_2": [{"order": 1, "amplitude": "2 mm"}]},
            "deviations.gear_2: the deviations of gear 2 add up to 2000 um; allowed is half a module",
        ),
    ],
    ids=lambda given: str(given)[:40],
)
def test_what_cannot_be_gets_one_sentence(settings: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError) as caught:
        pair(**settings).built({})
    assert str(caught.value).startswith(f"pair.toml: gears.{told}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["equal", "sanchez_2017", "single"])
def test_sharings_of_touching_flanks_are_refused(name: str) -> None:
    with pytest.raises(InputError, match="holds where all rigid flanks in mesh touch") as caught:
        pair(**RELIEVED, models__load_sharing=name).built({})
    assert caught.value.key == "models.load_sharing"


def run_with(carrying: int) -> dict[str, np.ndarray]:
    active = np.ones((1, 2, 12), bool)
    load = np.zeros(active.shape)
    load[0, 0, :carrying] = 1.0
    return {"active": active, "load": load, "weight": np.ones(1)}


def of_face(built: Built, run: Mapping[str, np.ndarray]) -> list[str]:
    return face_warning(AtWork(built, built.laws, [run]))


def test_part_of_the_face_without_load_is_told_and_nearly_all_of_it_refused() -> None:
    built = pair(gears__modifications__crowning="5 um").built({})
    (told,) = of_face(built, run_with(9))
    assert told.startswith("Of the contact lines that carry, 25 % get no load at 50 N m")
    assert of_face(built, run_with(12)) == []
    assert of_face(built, run_with(0)) == []  # nothing is loaded at all
    with pytest.raises(InputError, match="at 50 N m only 2 of 12 slices of a contact line get"):
        of_face(built, run_with(2))
    assert of_face(pair().built({}), run_with(2)) == []


def test_points_of_a_study_that_carry_on_part_of_the_face_are_told() -> None:
    crowned, plain = (
        pair(**given).built({}) for given in ({"gears__modifications__crowning": "5 um"}, {})
    )
    points, slices = [crowned, crowned, crowned, plain], np.full(4, 12)
    nearly, partly = faces_warning(points, np.array([[2.0, 9.0, np.nan, 2.0]]), slices)
    assert nearly.startswith("At 1 of 4 points fewer than 3 slices of a contact line get load")
    assert partly.startswith("At 1 of 4 points a part of the contact lines that carry, up to 25 %")
    assert faces_warning(points, np.array([[12.0, 12.0, 12.0, 2.0]]), slices) == []
    assert faces_warning([crowned], np.array([[2.0]]), slices[:1]) == []  # the mesh cycle says it


@pytest.mark.whole
def test_a_study_over_misalignment_tells_of_faces_that_carry_in_part() -> None:
    sizes = ("1 um", "80 um")
    points = [
        pair(gears__misalignment=size, models__load_sharing="from_stiffness").built({})
        for size in sizes
    ]
    data = summaries(points, points[0].models[:1], {}, title="study")
    (told,) = (one for one in json.loads(data.attrs["warnings"]) if "contact lines" in one)
    assert told.startswith("At 1 of 2 points a part of the contact lines that carry")
    assert not {"slices", "carrying_slices"} & set(data)
    carrying = of_face(points[1], profiles(points[1], points[1].models[:1])[0])
    assert carrying[0].split("carry, ")[1].split(" %")[0] in told


@pytest.mark.whole
def test_stiffness_of_modified_flanks_is_that_of_the_springs_that_carry() -> None:
    """Crowned and relieved: static transmission error and stiffness are those of the wind-up."""
    given = {"gears__modifications__crowning": "8 um", "models__tooth_compliance": "beam_hertz"}
    built = pair(**RELIEVED, **given).built({})
    data, mesh = stiffness_part(built), built.design.mesh
    contacts, load = mesh.contacts(jnp.asarray(data["phase"].values)), jnp.asarray(50.0)
    terms = terms_of("beam_hertz")
    found = wound_up(mesh, built.design.loaded, built.design.solids, terms, load, contacts, None)
    arm = abs(float(mesh.base_radii[1]))
    error = np.asarray(found.wind_up + found.touch) * arm
    np.testing.assert_allclose(data["static_transmission_error"], error, rtol=1e-9)
    stiffness = np.asarray(found.stiffness) / arm**2
    np.testing.assert_allclose(data["mesh_stiffness"], stiffness, rtol=1e-9)
    sum_of_pairs = data["pair_stiffness"].sum("pair")
    np.testing.assert_allclose(sum_of_pairs, stiffness, rtol=1e-9)


@pytest.mark.whole
def test_vibration_has_the_springs_that_carry() -> None:
    """A face that carries on a third of its width vibrates on that third, in equilibrium at rest."""
    example = Path(__file__).parents[2] / "examples" / "spur_modified.toml"
    changes = {
        "gears.misalignment": "60 um",
        "operation.torque": "40 N m",
        "dynamics.damping_ratio": 0.1,
    }
    built = Variant(tomllib.loads(example.read_text("utf-8")), "spur", "default", changes).built({})
    still = stiffness_part(built)
    given = built.design, built.operation, built.terms, vibrating_of(built)
    stiffness, moved, _ = _excited(*given)
    assert float(stiffness.mean) == pytest.approx(float(still["mean_stiffness"]), rel=1e-6)
    assert float(stiffness.mean) == pytest.approx(9.12e7, rel=1e-2)
    whole = np.asarray(stiffness.total)
    springs, arm, gap = map(np.asarray, (stiffness.single, stiffness.arm, stiffness.error))
    error = (float(moved.load[0]) + np.sum(springs * arm * gap, axis=0)) / whole
    wide = np.asarray(still["weight"]) > 1e-9  # events that coincide lie either side by rounding
    at_rest = np.asarray(still["static_transmission_error"])
    np.testing.assert_allclose(error.ravel()[wide], at_rest[wide], rtol=1e-9)
    solve = json.loads(still.attrs["solve"])
    assert solve["sentence"] == "a solution was found"
    assert 0.0 <= solve["residual"] < 1e-10
    lost = replace(stiffness, single=jnp.full(stiffness.single.shape, jnp.nan))
    with pytest.raises(ConvergenceError, match="no equilibrium of the teeth was found at 1 of 2"):
        _grid([(part, moved) for part in (stiffness, lost)], ())


def test_a_lost_equilibrium_gives_no_stiffness_as_a_number(monkeypatch: pytest.MonkeyPatch) -> None:
    built = pair(**RELIEVED, dynamics__damping_ratio=0.1).built({})
    values, status = jax.device_get(_stiffness(built.design, built.operation, built.terms))
    assert status is not None
    code = np.array(status.code)
    code.flat[:2] = Code.NOT_CONVERGED
    lost = Status(*map(jnp.asarray, (code, status.residual, status.iterations)))
    monkeypatch.setattr("pitchpoint.analyses.vibration._stiffness", lambda *_: (values, lost))
    data = stiffness_part(built)
    (told,) = (one for one in json.loads(data.attrs["warnings"]) if "Mesh stiffness" in one)
    assert told.startswith("Mesh stiffness: at 2 of ")
    assert told.endswith("points of the mesh cycle the iteration ended without a solution.")
    assert json.loads(data.attrs["solve"])["code"] == Code.NOT_CONVERGED


# ------------------------------------------------------------------ kinematic error

ECCENTRICITY = 10e-6


def error_of(variant: Variant) -> Any:
    built = variant.built({})
    return built.design.mesh, kinematic_error_part(built, built.deviations, lambda done: None)


def test_an_eccentric_gear_makes_order_one() -> None:
    """Rigid teeth: the driven gear lies back by e cos(turn)/r_b2, whatever pairs are in mesh."""
    wave = [{"order": 1, "amplitude": "10 um", "phase": "30 deg"}]
    mesh, data = error_of(pair(gears__deviations__gear_1=wave))
    size = ECCENTRICITY / abs(float(mesh.base_radii[1]))
    lines = data["kinematic_error_spectrum"].values
    np.testing.assert_allclose(lines[:, 0, 1], size, rtol=1e-9)
    rest = np.delete(lines[:, 0], 1, axis=1)
    assert rest.max() < 1e-9 * size
    assert not np.any(lines[:, 1])
    assert data.sizes["state"] == 61 * FEW_PAIRS
    assert data.attrs["turn"] == "one turn of gear 2"
    turned = data["turn_angle"].values * 61.0 / 23.0
    shown = data["kinematic_error"].values
    # As gear 1 turns on, the line of action passes its teeth in the other sense.
    following = size * np.cos(np.pi / 6.0 - turned)
    np.testing.assert_allclose(shown, np.stack([following] * 3), atol=1e-9 * size)


def test_an_eccentric_gear_that_is_driven_by_its_wheel() -> None:
    """Gear 1 carries the load and turns the other way: the line of action passes its teeth forwards."""
    wave = [{"order": 1, "amplitude": "10 um", "phase": "30 deg"}]
    mesh, data = error_of(pair(gears__deviations__gear_1=wave, operation__driver="gear 2"))
    turned = data["turn_angle"].values * 61.0 / 23.0
    following = ECCENTRICITY / float(mesh.base_radii[0]) * np.cos(np.pi / 6.0 + turned)
    np.testing.assert_allclose(
        data["kinematic_error"].values[0], following, atol=1e-9 * np.abs(following).max()
    )


def test_pitch_deviations_of_rigid_teeth_are_those_of_the_tooth_in_contact() -> None:
    variant = pair(gears__deviations__iso_class=[6, 6])
    built = variant.built({})
    _, (second,) = built.deviations
    assert isinstance(second, ToothDeviations)
    none = jnp.zeros_like(second.pitch)
    pitch = replace(second, profile_slope=none, lead_slope=none, profile_form=none, lead_form=none)
    data = kinematic_error_part(built, ((), (pitch,)), lambda done: None)
    rigid = data["kinematic_error"].values[0].reshape(61, FEW_PAIRS) * abs(
        float(built.design.mesh.base_radii[1])
    )
    ratio = float(built.design.mesh.contact_ratio)
    alone = np.arange(FEW_PAIRS) / FEW_PAIRS > ratio - 1.0
    single = rigid[:, alone]
    np.testing.assert_allclose(
        single, np.repeat(single[:, :1], single.shape[1], axis=1), atol=1e-15
    )
    table = np.asarray(pitch.pitch)
    orders = [np.roll(table[::sense], shift) for sense in (1, -1) for shift in range(61)]
    assert min(np.abs(single[:, 0] - one).max() for one in orders) < 1e-15
    # Two in contact: the one that stands out further leads.
    before = np.roll(single[:, 0], 1)
    two = np.minimum(single[:, 0], before)[:, None] * np.ones((~alone).sum())
    np.testing.assert_allclose(rigid[:, ~alone], two, atol=1e-15)


def test_a_class_enters_the_motion_and_not_the_cycle() -> None:
    deviating, plain = (
        pair(**each).built({}) for each in ({"gears__deviations__iso_class": 6}, {})
    )
    assert deviating.design.mesh.surfaces == plain.design.mesh.surfaces == ((), ())
    assert touching(deviating.design.mesh)
    assert (deviating.design.mesh.slices, plain.design.mesh.slices) == (12, 1)
    again = pair(gears__deviations__iso_class=6).built({}).deviations
    for one, other in zip(
        jax.tree.leaves(again), jax.tree.leaves(deviating.deviations), strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_over_the_path_stands_what_the_highest_load_makes_of_the_face() -> None:
    """Straight teeth in slices touch at one place of the path, and differently over the face."""
    from types import SimpleNamespace

    import xarray as xr

    from pitchpoint.views.sections.path import points_along_path

    load = np.array([[[1.0, 3.0, 2.0]], [[0.0, 4.0, 9.0]]])
    lanes = ("node", "pair", "slice")
    data = xr.Dataset(
        {
            "phase": ("node", np.array([0.2, 0.6])),
            "active": (lanes, np.ones((2, 1, 3), bool)),
            "path": (lanes, np.broadcast_to(np.array([0.2, 0.6]).reshape(2, 1, 1), (2, 1, 3))),
            "load": (("law", *lanes), load[None]),
            "pressure": (("law", *lanes), 10.0 * load[None]),
        }
    )
    fact: Any = SimpleNamespace(
        helical=False, contact_ratio=1.6, transverse_ratio=1.6, overlap_ratio=0.0
    )
    place, pressure = points_along_path(data, "pressure", 0, fact)
    shown = np.isfinite(pressure)
    np.testing.assert_allclose(place[shown], [0.2, 0.6])
    np.testing.assert_allclose(pressure[shown], [30.0, 90.0])


def test_no_undercut_limit_is_told_of_a_ring() -> None:
    one = pair(gears__teeth=[20, -70], gears__profile_shift=[0.3, 0.1], gears__addendum=[1.0, 0.8])
    rows = {
        row["key"]: row
        for row in printed_input_rows({"inputs": resolved(one.built({}), one.document())})
    }
    assert rows["gear 1, undercut limit"]["value"] == "-0.16981"
    assert not [
        key for key in rows if key.endswith("undercut limit") and not key.startswith("gear 1")
    ]
