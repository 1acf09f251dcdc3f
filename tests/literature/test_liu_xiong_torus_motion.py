"""Liu and Xiong: the motion beside another solver, and what its formulas refuse."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from torus_in_print import NAME, TREE, driven, read

from pitchpoint._jax import jax
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.published.liu_xiong_torus import printed
from pitchpoint.published.liu_xiong_torus.printed_motion import torus_motion

# ------------------------------------------------------------------ the motion


def by_hand(drive, time):
    """Transmission error from scipy, with the right-hand side written out in plain NumPy."""
    rb, m, inertia = (np.asarray(v) for v in (drive.base_radii, drive.mass, drive.inertia))
    speed, pitch, entry, length = (
        float(v) for v in (drive.speed, drive.base_pitch, drive.entry, drive.tangent)
    )
    k_b, zeta, amplitude = (float(v) for v in (drive.bearing, drive.bearing_damping, drive.error))
    e, eta, s = (float(v) for v in (drive.modulus, drive.viscosity, drive.roughness))
    powers, period = np.asarray(drive.coefficients), pitch / (speed * rb[0])
    w, torque, c = speed * 40.0 / (2.0 * np.pi), float(drive.torque), float(drive.radius_factor)

    def rate(t, y, older):
        cycle = t / period - np.floor(t / period + 1e-12)
        q, v, normal, across, turn_p, turn_g = y[:6], y[6:], 0.0, 0.0, 0.0, 0.0
        stretch = q[4] - q[5] + q[0] - q[1] - amplitude * np.cos(w * t)
        faster = v[4] - v[5] + v[0] - v[1] + amplitude * w * np.sin(w * t)
        for entered in [cycle] + [cycle + 1.0] * older:
            place = entry + entered * pitch
            roll = entered * pitch / rb[0]
            k = sum(a * roll ** (n + 1) for n, a in enumerate(powers))
            force = k * stretch + 2.0 * 0.005 * np.sqrt(k * float(drive.joint_mass)) * faster
            v_p, v_g = speed * place, speed * rb[0] / rb[1] * (length - place)
            v_e, radius = (v_p + v_g) / 2.0, c * place
            sr = abs(v_p - v_g) / v_e
            p_h = 1e-9 * np.sqrt(max(force, 1e-9) * e / (2.0 * np.pi * radius))
            h = sr * p_h * np.log10(1e3 * eta)
            f = -8.916465 - 0.354068 * h + 2.812084 * np.exp(-h) + 0.620305 * np.exp(1e6 * s)
            mu = np.exp(f) * p_h**1.03303 * sr**1.036077 * v_e**-0.100601
            mu *= (1e3 * eta) ** 0.752755 * radius**-0.390958
            friction = mu * max(force, 0.0) * np.sign(v_p - v_g)
            normal, across = normal + force, across + friction
            turn_p, turn_g = turn_p + place * friction, turn_g + (length - place) * friction
        mass = np.array([*m, *m])
        held = k_b * q[:4] + 2.0 * zeta * np.sqrt(k_b * mass) * v[:4]
        pushed = (np.array([-normal, normal, across, across]) - held) / mass
        turned = np.array(
            [
                rb[0] * (torque * rb[0] / rb[1] - rb[0] * normal + turn_p) / inertia[0],
                rb[1] * (-torque + rb[1] * normal + turn_g) / inertia[1],
            ]
        )
        return np.concatenate([v, pushed, turned])

    single, state, found = 0.7323403540461437, np.zeros(12), []
    for cycle in range(4):
        for start, stop in ((0.0, single), (single, 1.0)):
            ends = (cycle + start) * period, min(cycle + stop, 3.23) * period
            if ends[1] <= ends[0]:
                continue
            inner = time[(time > ends[0]) & (time < ends[1])]
            given = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-14, "args": (start == 0.0,)}
            solved = solve_ivp(rate, ends, state, t_eval=np.append(inner, ends[1]), **given)
            state = solved.y[:, -1]
            found.append(solved.y[:, :-1])
    q = np.concatenate(found, axis=1)
    return q[4] - q[5] + q[0] - q[1]


@pytest.mark.whole
def test_motion_is_that_of_another_solver():
    drive, turn = driven("heavy", 2, "torus")
    moved = jax.device_get(torus_motion(drive, turn))
    inside = np.arange(moved.time.size) % 1500 % 7 == 3  # none of them at a hand-over
    other = by_hand(drive, moved.time[inside])
    assert np.ptp(other) > 50e-6
    np.testing.assert_allclose(other, moved.error[inside], atol=2e-10)


def test_work_of_all_forces_is_the_kinetic_energy():
    """Friction with its printed signs among them: the energy that it creates is in the motion."""
    drive, turn = driven("heavy", 2, "torus")
    moved = jax.device_get(torus_motion(drive, turn))
    step = np.diff(moved.time)

    def summed(power):
        return np.concatenate([[0.0], np.cumsum(step * (power[1:] + power[:-1]) / 2.0)])

    rate, rb = moved.rate.T, np.asarray(drive.base_radii)
    mass = np.asarray([*drive.mass] * 2)[:, None]
    k_b, zeta = float(drive.bearing), float(drive.bearing_damping)
    turning = rate[4:] / rb[:, None]
    arms = np.stack([moved.pairs.place, float(drive.tangent) - moved.pairs.place])
    driving = np.sum(
        moved.friction * (turning[0][:, None] * arms[0] + turning[1][:, None] * arms[1]), 1
    )
    driving += np.sum(moved.friction, axis=1) * (rate[2] + rate[3])
    normal = np.sum(moved.force, axis=1) * (rate[4] - rate[5] + rate[0] - rate[1])
    outer = float(drive.input_torque) * turning[0] - float(drive.torque) * turning[1]
    braking = np.sum(2.0 * zeta * np.sqrt(k_b * mass) * rate[:4] ** 2, axis=0)
    stored = sum(k_b * summed(one)[-1] ** 2 / 2.0 for one in rate[:4])
    inertia = np.asarray(drive.inertia)[:, None]
    kinetic = np.sum(mass * rate[:4] ** 2, axis=0) + np.sum(inertia * turning**2, axis=0)
    work = summed(outer - normal + driving - braking)[-1]
    scale = summed(np.abs(normal))[-1]
    assert scale > 10.0 * abs(summed(driving)[-1]) > 1e-4 * scale
    assert kinetic[-1] / 2.0 + stored == pytest.approx(work, abs=2e-5 * scale)


def test_courses_of_a_mesh_cycle_are_those_of_the_motion():
    """Means of the last whole cycle against sums over the instants that the solver kept."""
    data = read("heavy").isel(point=1)
    for pair in ("torus", "standard"):
        drive, turn = driven("heavy", 1, pair)
        moved = jax.device_get(torus_motion(drive, turn))
        last = (moved.time >= 2.0 * float(drive.period)) & (moved.time <= 3.0 * float(drive.period))
        weight = np.where(last, moved.weight, 0.0)
        inside = np.repeat(np.arange(moved.time.size // 1500), 1500)
        whole = [np.all(last[inside == piece]) for piece in range(inside[-1] + 1)]
        weight = np.where(np.array(whole)[inside], moved.weight, 0.0)
        assert weight.sum() == pytest.approx(1.0)
        for k in (0, 1):
            force = np.nan_to_num(data[f"{pair}_force_{k}"])
            assert force.mean() == pytest.approx(weight @ moved.force[:, k], rel=5e-3)
            friction = np.nan_to_num(data[f"{pair}_friction_{k}"])
            expected = weight @ moved.friction[:, k]
            assert friction.mean() == pytest.approx(expected, abs=5e-3 * np.ptp(friction))
        both = data[f"{pair}_force_both"]
        np.testing.assert_allclose(
            both, sum(np.nan_to_num(data[f"{pair}_force_{k}"]) for k in (0, 1)), atol=1e-9
        )
        gone = data["cycle_part"] > 0.7324
        assert np.isnan(data[f"{pair}_force_0"][gone]).all()
        assert np.isfinite(data[f"{pair}_force_0"][~gone]).all()
        pulls = np.nan_to_num(data[f"{pair}_force_1"], nan=-1.0) <= 0.0
        np.testing.assert_array_equal(np.isnan(data[f"{pair}_film_course_1"]), pulls)


def test_friction_by_the_printed_signs_does_not_dissipate():
    found = read("heavy").isel(law=0)
    for pair in ("torus", "standard"):
        power, heat = (
            found[f"{pair}_{name}"].values for name in ("friction_power", "friction_heat")
        )
        assert np.all(heat > 0.0)
        assert np.all(power > -heat)
        put_in = 245.0 * 40.0 / 49.0 * found["axis"].values
        np.testing.assert_allclose(found[f"{pair}_energy_imbalance"], (power + heat) / put_in)


def test_film_of_the_paper_follows_from_its_effective_radius_alone():
    """With the radius of the profiles in place of c rho_1 the torus pair has the thinner film."""
    published = read("heavy").isel(law=0)
    assert np.all(published["printed_film_ratio"] > 1.3)
    assert np.all(published["film_ratio"] < 0.88)
    smaller = read("heavy", **{"formulas.radius_factor": 0.55}).isel(law=0)
    assert np.all(smaller["printed_film_ratio"] < 1.0)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"formulas.torus_roll": ["1 deg", "2 deg", "3 deg", "4 deg", "5 deg"]}, "20 stiffnesses"),
        ({"source": "xu_2021"}, "equations of one paper"),
        ({"formulas.bearing_stiffness": "0 N/um"}, "out of range"),
    ],
)
def test_what_cannot_be_formulas_is_refused(change, told):
    with pytest.raises(InputError, match=told):
        Variant(TREE, NAME, "as_published").built(change)


def test_a_negative_stiffness_is_refused():
    springs = [f"{value} N/um" for value in np.linspace(400.0, 1.0, 20) ** 3 / 1e6]
    with pytest.raises(InputError, match="needs a positive stiffness") as told:
        read("validation", **{"formulas.torus_stiffness": springs})
    assert told.value.key == "formulas.torus_stiffness"


def test_few_places_of_the_library_on_the_path_are_refused():
    beyond = [f"{roll} deg" for roll in (3, 6, 9, *range(20, 37))]
    with pytest.raises(InputError, match="3 of these roll angles lie on the path") as told:
        read("validation", **{"formulas.stiffness": "library", "formulas.torus_roll": beyond})
    assert told.value.key == "formulas.torus_roll"


def test_a_motion_that_is_not_found_is_told(monkeypatch):
    monkeypatch.setattr(printed, "motion_figures", lambda *_: {"largest_error": np.array(np.inf)})
    with pytest.raises(ConvergenceError, match="motion of the torus pair"):
        read("validation")


def test_other_contact_ratios_are_refused():
    with pytest.raises(
        InputError, match=r"one pair of teeth in turn with two; the contact ratio is 2\."
    ):
        read("validation", **{"gears.addendum": 1.3, "gears.dedendum": 1.5})
