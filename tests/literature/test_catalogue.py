"""Strain-wave drives beside what the catalogues of their makers give.

Efficiencies: CSD-25-100 (and CSD-20-100) at rated torque, read off the curves by the author of a
public program; two constants of the set of losses that the case `csd25` names are fitted to all of them
together. Starting and back-driving torque: CSF-17-100 and CSF-25-50, to which a third one is fitted.
Stiffness: HFUC-32-100 beside the case `hfuc32`, nothing fitted.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import equinox as eqx
import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from pitchpoint._jax import jax, jnp
from pitchpoint.analyses.comparison import compare
from pitchpoint.cases.document import resolve
from pitchpoint.cases.library import find_case
from pitchpoint.cases.resolved_inputs import resolved
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.quasi_static import Operation, cycle, engagement
from pitchpoint.efficiency.running_torque import torques_at_rest
from pitchpoint.efficiency.summary import engaged
from pitchpoint.gears.strain_wave.ball_bearing import Balls
from pitchpoint.gears.strain_wave.design import build_strain_wave
from pitchpoint.gears.strain_wave.in_series import Behind
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS
from pitchpoint.input.quantities import SIValue
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import wind_up
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import load_case
from pitchpoint.units import parse

SPEEDS = np.array([500.0, 1000.0, 2000.0, 3500.0])  # rpm
DEGREES = np.arange(-10.0, 41.0, 5.0)
CATALOGUE = np.array(
    [
        [52, 57, 63, 68, 72, 74, 76, 78, 79, 80, 81],
        [42, 48, 54, 60, 65, 68, 71, 73, 75, 77, 78],
        [31, 37, 44, 50, 55, 60, 64, 67, 70, 72, 74],
        [24, 30, 36, 42, 47, 53, 57, 61, 64, 67, 69],
    ]
)
BAND = 2.0
"""Points of efficiency: what reading two curves to whole percents may come to."""

EXAMPLE = Path(__file__).parents[2] / "examples" / "strain_wave.toml"
RATED = 47.0
K1, K2, K3 = 6.7e4, 1.1e5, 1.2e5
"""Stiffness of HFUC-32-100 below 29 N m, from there to 108 N m, and beyond [N m/rad]."""

PHASES = np.array([0.0, 0.25, 0.5, 0.75])
LOADS = np.array([0.0, 14.5, 29.0, 60.0, 68.5, 108.0, 137.0])


@cache
def case():
    """The shipped case and its models."""
    built = load_case("csd25")
    return built, built.models[0]


def with_friction(models, coefficient):
    return replace(models, parameters={"constant": {"coefficient": jnp.asarray(coefficient)}})


@eqx.filter_jit
def _cycle(design, operation, models, engaged):
    found = cycle(design, operation, models, engaged=engaged)
    return found.mean_efficiency, found.locked


def efficiency(load=RATED, design=None, coefficient=0.1):
    """Mean efficiency [speed, temperature] and whether friction locks the drive."""
    built, models = case()
    design = design or built.design
    models = with_friction(models, coefficient)
    engaged = engagement(design, jnp.asarray(load), models, 8)
    speed, degree = np.meshgrid(SPEEDS * np.pi / 30.0, DEGREES + 273.15, indexing="ij")
    points = Operation(*(jnp.asarray(x) for x in (np.full(speed.shape, load), speed, degree)))
    return jax.device_get(_cycle(design, points, models, engaged))


@cache
def at_load(load=RATED):
    return efficiency(load)[0]


# ------------------------------------------------------------------ efficiency


@pytest.mark.whole
def test_all_44_efficiencies_of_the_catalogue():
    away = 100.0 * at_load() - CATALOGUE
    assert np.abs(away).max() < 1.09
    assert np.abs(away).mean() < 0.44
    assert np.abs(away.mean(axis=1)).max() < 0.6
    assert np.abs(away.mean(axis=0)).max() < 1.0


@pytest.mark.whole
def test_pairs_that_carry_make_all_the_losses():
    """The loss map leaves the others out."""
    built, models = case()
    whole = engagement(built.design, jnp.asarray(RATED), models, 8)
    few = whole.loaded()
    assert few.share.shape[0] < whole.share.shape[0] / 2
    np.testing.assert_allclose(few.share.sum(axis=0), 1.0, rtol=1e-14)
    points = Operation(*(jnp.full((2, 1), value) for value in (RATED, 200.0, 300.0)))
    found, fewer = (jax.device_get(_cycle(built.design, points, models, x)) for x in (whole, few))
    np.testing.assert_allclose(fewer[0], found[0], rtol=1e-14)


def test_constants_that_are_fitted_are_named():
    """Two to the efficiencies; the third, to starting torques, enters none of them.

    X_L of the oil is a fit of its source to losses of other gears.
    """
    document = resolve(dict(find_case("csd25")[1]), name="csd25", variant="default")
    assert not [mark for mark in document.provenance.values() if mark.status == "fitted"]
    rows = [row for row in resolved(case()[0], document) if row["status"] == "fitted"]
    place = "wave_generator_bearing"
    named = {f"{place}.{name}" for name in ("f0", "f1", "breakaway_dry")}
    assert {row["key"] for row in rows} == named | {"lubricant_factor"}
    assert not any(row["given"] for row in rows)
    (given,) = (row for row in resolved(case()[0], document) if row["key"] == "set")
    assert (given["value"], given["given"]) == ("strain_wave_component", True)


def test_rows_of_the_case_are_those_of_the_catalogue():
    rows = [row for row in find_case("csd25")[1]["targets"] if row["study"].startswith("rpm")]
    assert {row["kind"] for row in rows} == {"calibrated"}
    listed = {}
    for row in rows:
        speed, degree = (part.split()[0] for part in row["quantity"].split(", ")[1:])
        place = list(SPEEDS).index(float(speed)), list(DEGREES).index(float(degree))
        assert (row["study"], row["at"]) == (f"rpm_{speed}", f"{degree} degC")
        assert row["tolerance"] == BAND
        listed[place] = row["printed"]
    assert len(rows) == len(listed) == CATALOGUE.size
    assert all(CATALOGUE[place] == printed for place, printed in listed.items())


@pytest.mark.whole
def test_each_of_the_two_constants_is_needed_and_at_its_best():
    """A tenth more or less of either follows the catalogue worse."""
    built, _ = case()
    drag = built.design.drag[0]

    def squares(**by):
        factors = {name: value * by.get(name, 1.0) for name, value in drag.factors.items()}
        design = replace(built.design, drag=(replace(drag, factors=factors),))
        return np.sum((100.0 * efficiency(design=design)[0] - CATALOGUE) ** 2)

    least = squares()
    assert least < 20.0
    for name in ("f0", "f1"):
        assert all(squares(**{name: by}) > 1.2 * least for by in (0.9, 1.1))


@pytest.mark.whole
def test_a_higher_ratio_loses_less_torque():
    """Ratio 160, -10 and 40 degC, 2000 rpm: what grows with the deflection falls with the ratio."""
    tree = find_case("csd25")[1]
    changes = tree["studies"]["ratio_160"]["change"]
    higher = load_case("csd25", settings=changes).design
    found, printed = 100.0 * efficiency(design=higher)[0][2, [0, -1]], np.array([25.0, 70.0])
    assert np.abs(found - printed).max() < BAND
    design, drag = case()[0].design, higher.drag[0]
    same = replace(higher, drag=(replace(drag, factors=design.drag[0].factors),))
    constant = 100.0 * efficiency(design=same)[0][2, [0, -1]]
    assert np.all(found - constant > 1.5)


# ------------------------------------------------------------------ starting torques

FRICTION = 0.1
"""Coefficient on the teeth of the case `csd25`."""

STARTING = {(17, 100): (0.034, 3.3), (25, 50): (0.15, 9.0)}
"""Size and ratio; torque that starts the drive, and that back-drives it, by its maker [N m]."""


def of_size(size, ratio):
    """A drive that names the set, pitch diameter in tenths of an inch."""
    shipped = find_case("csd25")[1]
    tree = {key: shipped[key] for key in ("lubricant", "roughness", "models")}
    tree["gears"] = {"family": "strain_wave", "teeth": [2 * ratio, 2 * ratio + 2]}
    tree["gears"] |= {"module": SIValue(2.54e-3 * size / (2 * ratio))}
    tree["gears"] |= {"face_width": SIValue(0.4e-3 * size)}
    tree["operation"] = {"torque": "10 N m", "speed": "1 rpm", "temperature": "25 degC"}
    return Variant({**tree, "losses": {"set": "strain_wave_component"}}, "", "default").built({})


def from_rest(built):
    idle, models = replace(built.operation, load=jnp.asarray(0.0)), built.models[0]
    return float(
        torques_at_rest(built.design, idle, models, engaged(built.design, idle, models))[1]
    )


@pytest.mark.whole
@pytest.mark.parametrize(("size", "ratio"), STARTING)
def test_torques_that_start_a_drive_either_way(size, ratio):
    """One set of constants for both sizes and ratios."""
    built = of_size(size, ratio)
    forth, back = from_rest(built), from_rest(built.backwards)
    printed = STARTING[size, ratio]
    assert forth == pytest.approx(printed[0], rel=0.4)
    assert back == pytest.approx(printed[1], rel=0.4)
    assert 0.9 < back / (ratio * forth) < 1.3
    for one, torque in zip((built, built.backwards), printed, strict=True):
        spread = one.case.losses["wave_generator_bearing"].breakaway_spread
        ends = [
            from_rest(replace(one, design=replace(one.design, drag=(drag.held_times(factor),))))
            for drag in one.design.drag
            for factor in (1.0 / spread, spread)
        ]
        assert ends[0] < torque < ends[1]


def moments(built):
    """Torque that moves the drive without load from rest, over what its bearing is held by, by phase.

    By statics in space: the circular spline is held by the moment of the forces on its flanks, which is the
    torque from outside on the flexspline or on the wave generator; the bearing between these two feels the
    forces along the radius. Shares and places are those of the drive.
    """
    idle = replace(built.operation, load=jnp.asarray(0.0))
    known = jax.device_get(engaged(built.design, idle, built.models[0]))
    at, share, motion = known.contacts, known.share, np.asarray(built.design.motion)
    slip = np.tensordot(motion, at.surface[0] - at.surface[1], 1)
    pull = at.direction + FRICTION * np.sign(slip) * at.tangent
    arm = np.abs(np.sum(share * (at.point[0] * pull[1] - at.point[1] * pull[0]), axis=(0, 1)))
    radial = np.abs(at.point[0] * at.direction[0] + at.point[1] * at.direction[1])
    pressed = np.sum(share * radial / np.hypot(*at.point[:2]), axis=(0, 1))
    (drag,), turned = built.design.drag, abs(motion[0] - motion[1])
    rubbed = float(drag.factors["f1"] * drag.mean_diameter) * pressed * turned
    rubbed += FRICTION * np.sum(share * np.abs(slip), axis=(0, 1))
    return turned / (1.0 - rubbed / arm)


@pytest.mark.whole
@pytest.mark.parametrize(("size", "ratio", "told"), [(17, 100, 1.18), (25, 50, 1.14)])
def test_what_drives_backwards_stands_to_what_starts_as_virtual_work_has_it(size, ratio, told):
    """Power of the driver is that in the bearing, held at rest, and in the teeth that carry it."""
    built = of_size(size, ratio)
    (law,) = built.case.models.friction
    assert law.coefficient == FRICTION
    found = from_rest(built.backwards) / (ratio * from_rest(built))
    expected = moments(built.backwards).max() / (ratio * moments(built).max())
    assert found == pytest.approx(expected, rel=5e-3)
    assert found == pytest.approx(told, abs=5e-3)


@pytest.mark.whole
def test_the_shipped_example_has_the_efficiency_of_real_drives():
    built = load_case(str(EXAMPLE))
    point = built.case.operation
    values = (point.load, point.speed, point.temperature)
    points = Operation(*(jnp.full(SPEEDS.shape + DEGREES.shape, value) for value in values))
    known = engagement(built.design, built.operation.load, built.models[0], 8)
    found = jax.device_get(_cycle(built.design, points, built.models[0], known))[0]
    assert 0.64 < float(found[0, 0]) < 0.75
    assert built.covers == {}


@pytest.mark.whole
def test_efficiency_rises_with_temperature_and_torque_and_falls_with_speed():
    part, full = at_load(0.57 * RATED), at_load()
    assert np.all(np.diff(full, axis=1) > 0.0)
    assert np.all(np.diff(full, axis=0) < 0.0)
    assert np.all(full > part)
    assert np.all(part > at_load(0.1 * RATED))


@pytest.mark.whole
def test_part_load_lowers_the_efficiency_about_as_a_manual_says_of_another_size():
    """HFUC-20-80, 1000 rpm, 20 degC: 0.93 of it is left at 57 % of the torque."""
    ratio = (at_load(0.57 * RATED) / at_load())[1, 6]
    assert 0.85 < ratio < 0.95


# ------------------------------------------------------------------ self-locking


@pytest.mark.whole
@pytest.mark.parametrize("arcs", ["liu", "flat"])
@pytest.mark.parametrize("driver", ["wave generator", "flexspline"])
def test_tooth_friction_alone_does_not_lock_the_drive(arcs, driver):
    """At three times the friction of a lubricated flank."""
    built, _ = case()
    gears = built.case.gears
    mesh = build_strain_wave(
        teeth=(200, 202),
        module=gears.module,
        face_width=gears.face_width,
        form=DOUBLE_ARCS[arcs],
        rim_thickness=gears.flexspline.rim_thickness,
    )
    load = RATED if driver == "wave generator" else RATED / 100.0
    found, locked = efficiency(
        load, replace(built.design, mesh=mesh, drag=()).driven_by(driver), coefficient=0.3
    )
    assert not locked.any()
    assert np.all(found > 0.5)
    assert np.all(found < 0.97)


# ------------------------------------------------------------------ stiffness


@eqx.filter_jit
def _torsion(design, terms, load, phase):
    return wind_up(design.mesh, design.loaded, design.solids, terms, load, phase)


def drive(variant="rigid_bearing", scale=1.0):
    """The shipped case, or the same drive with every length scaled."""
    tree = find_case("hfuc32")[1]["gears"]
    lengths = {f"gears.{key}": tree[key]["value"] for key in ("module", "face_width")}
    rim = tree["flexspline"]
    lengths |= {f"gears.flexspline.{key}": length["value"] for key, length in rim.items()}
    scaled = {key: SIValue(scale * parse(length, "length")) for key, length in lengths.items()}
    return load_case("hfuc32", variant, scaled if scale != 1.0 else {})


def wound_up(design, scale=1.0, model="beam_foundation_weber"):
    load, phase = np.meshgrid(LOADS * scale**3, PHASES, indexing="ij")
    terms = terms_of(model)
    return jax.tree.map(np.asarray, _torsion(design, terms, load, phase))


@cache
def size_32(variant="rigid_bearing"):
    return wound_up(drive(variant).design)


def beside_the_catalogue(variant):
    wind_up = size_32(variant).wind_up.mean(axis=1)
    part = dataset({"wind_up": (("torque",), wind_up)}, {"torque": LOADS})
    return compare(drive(variant).case.targets, {"torsion": part})


@pytest.mark.whole
def test_stiffness_as_built_beside_the_catalogue():
    """Nothing is fitted: half of K1, 30 % of the others are allowed."""
    rows = beside_the_catalogue("as_built")
    assert [row.verdict for row in rows] == ["pass"] * 4
    allowed = [0.5, 0.3, 0.3, 0.3]
    for row, part in zip(rows, allowed, strict=True):
        assert row.tolerance <= part * row.printed * (1.0 + 1e-12)
    assert [row.printed for row in rows[:3]] == [1e-3 * k for k in (K1, K2, K3)]


@pytest.mark.whole
def test_stiffness_of_teeth_rim_and_wall_beside_the_catalogue():
    """What yields behind them, and the balls, is not in it."""
    rows = beside_the_catalogue("rigid_bearing")
    ratio = [row.computed / row.printed for row in rows]
    assert [row.verdict for row in rows] == ["miss", "pass", "pass", "miss"]
    assert [row.bound for row in rows] == 3 * ["< 2 x "] + ["> 0.5 x "]
    for row, found in zip(rows[:3], ratio, strict=False):
        assert float(row.reason.split(" times")[0]) == pytest.approx(found, rel=0.03)
        assert "K1" in row.reason or "missing: joints of the cup" in row.reason
    assert ratio[3] == pytest.approx(0.39, abs=0.01)


SOFTER = {50: (0.81, 0.71), 30: (0.36, 0.27)}
"""K1 and K2 of the size 32 by ratio, over those at 80 and more: CSF, tables 41 and 42, in a public copy."""


@pytest.mark.whole
@pytest.mark.parametrize("ratio", SOFTER)
def test_low_ratios_with_usual_walls_are_softer_as_in_the_catalogue(ratio):
    """Asked is the trend: within two tenths of the stiffness at 100."""
    found = np.array(built(ratio)) / np.array(built(100))
    np.testing.assert_allclose(found[:2], SOFTER[ratio], atol=0.2)
    assert found[2] < 0.85
    assert np.all(np.array(built(80)) > 0.9 * np.array(built(100)))


@cache
def built(ratio, diameter=81.3e-3):
    """Stiffness K1, K2, K3 of a drive in usual proportions."""
    teeth = 2 * ratio
    mesh = build_strain_wave(
        teeth=(teeth, teeth + 2),
        module=diameter / teeth,
        face_width=0.16 * diameter,
        walls="bending strain",
        bearing=Balls(),
        behind=Behind(),
    )
    design = replace(drive().design, mesh=mesh)
    ends = np.array([0.0, 29.0, 108.0, 137.0])
    wind_up = np.interp(ends, LOADS, wound_up(design).wind_up.mean(axis=1))
    return np.diff(ends) / np.diff(wind_up)


def test_example_of_the_manual():
    printed = 29.0 / K1 + (60.0 - 29.0) / K2
    assert np.degrees(printed) * 60.0 == pytest.approx(2.5, abs=0.05)


def test_balls_of_the_case_are_those_of_palmgren():
    bearing = drive("as_built").design.mesh.bearing
    assert bearing.angle.size == 23
    force, ball = 65.0, 6.34
    yields = 4.36e-7 * force ** (2.0 / 3.0) / ball ** (1.0 / 3.0)
    assert force / yields**1.5 == pytest.approx(float(bearing.stiffness), rel=1e-9)
    assert np.isinf(drive().design.mesh.rim.support_stiffness)


@pytest.mark.parametrize("conformity", [0.515, 0.53])
def test_a_ball_between_two_races_yields_as_hertz_says(conformity):
    """Point contact on both races, the ellipse found from its integrals."""
    load, ball, circle = 65.0, 6.35e-3, 69.5e-3
    modulus = 206e9 / (1.0 - 0.3**2)
    total = 0.0
    for race in ((circle - ball) / 2.0, -(circle + ball) / 2.0):
        along, across = 2.0 / ball + 1.0 / race, 2.0 / ball - 1.0 / (conformity * ball)
        wanted = (along - across) / (along + across)

        def excess(k, wanted=wanted):
            first, second = ellipk(1.0 - k**-2), ellipe(1.0 - k**-2)
            found = ((k**2 + 1.0) * second - 2.0 * first) / ((k**2 - 1.0) * second)
            return found - wanted

        k = brentq(excess, 1.001, 50.0)
        first, second = ellipk(1.0 - k**-2), ellipe(1.0 - k**-2)
        square = (load / (np.pi * k * modulus)) ** 2
        total += first * np.cbrt(4.5 * (along + across) / second * square)
    palmgren = 4.36e-4 * load ** (2.0 / 3.0) / (1e3 * ball) ** (1.0 / 3.0) * 1e-3
    assert 0.95 < total / palmgren < 1.15


@pytest.mark.whole
def test_pairs_and_stiffness_grow_with_the_torque():
    found = size_32()
    assert np.all(np.diff(found.loaded_pairs[1:], axis=0) >= 0)
    assert np.all(found.loaded_pairs[-1] > found.loaded_pairs[1] + 3)
    assert np.all(np.diff(found.stiffness[1:].mean(axis=1)) > 0.0)
    assert np.all(np.diff(found.load[1:] / found.wind_up[1:], axis=0) > 0.0)


@pytest.mark.whole
def test_stiffness_grows_with_the_cube_of_the_size():
    """Twice as large and eight times the torque: the same wind-up, contact linear."""
    small, large = (
        wound_up(drive(scale=scale).design, scale, "beam_foundation_hertz") for scale in (1.0, 2.0)
    )
    np.testing.assert_allclose(large.wind_up, small.wind_up, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(large.stiffness, 8.0 * small.stiffness, rtol=1e-9)
    np.testing.assert_array_equal(large.loaded_pairs, small.loaded_pairs)
