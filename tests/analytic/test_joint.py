"""Torsional vibration of a joint against closed forms: two inertias, transfer function, friction, energy."""

import numpy as np
import pytest

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.joint_course import MotorRun, fading, joint_motion, steady_joint_vibration
from pitchpoint.dynamics.joint_vibration import Joint, Sliding, joint_response
from pitchpoint.loading.wind_up_curve import WindUpCurve

STIFFNESS, RATIO, TORQUE, LOAD, MOTOR = 4e4, 100.0, 60.0, 1.2, 0.7
ERROR = 1e-4

linear = program(joint_response)
torque_and_slope = jax.jit(lambda curve, at: (curve.torque_at(at), curve.slope_at(at)))
slope_of_energy = jax.jit(jax.vmap(jax.grad(lambda curve, at: curve.energy_at(at), 1), (None, 0)))


@program
def own(joint):
    order = jnp.asarray(2.0)
    return joint.natural_frequency, joint.damping_ratio, joint.critical_speed(order), joint.wind_up


def straight(play=0.0):
    """A spring of three points, of which all curves here have as many."""
    points = jnp.array([0.0, 1e-3, 3e-3])
    return WindUpCurve(points, STIFFNESS * points, jnp.full(3, STIFFNESS), jnp.asarray(play))


def stiffening(play=0.0):
    points = jnp.array([0.0, 1e-3, 3e-3])
    return WindUpCurve(
        points, jnp.array([0.0, 25.0, 105.0]), jnp.array([2e4, 3e4, 4.5e4]), jnp.asarray(play)
    )


def joint(
    curve=None, *, motor=np.inf, damping=12.0, held=0.0, rate=0.0, load=LOAD, torque=TORQUE
) -> Joint:
    sliding = Sliding(array([held]), array([rate]))
    given = map(array, (torque, motor, load, damping, RATIO))
    return Joint(straight() if curve is None else curve, *given, sliding)


def matrix_solution(order, speed, motor, damping):
    """Motor and load by the two equations of motion as a matrix, error and its virtual work on the right."""
    frequency, lag = order * speed, ERROR
    spring = STIFFNESS + 1j * frequency * damping
    moved = np.array([[1.0, -1.0], [-1.0, 1.0]]) * spring - frequency**2 * np.diag([motor, LOAD])
    torque = np.array([spring * lag + 1j * order * RATIO * TORQUE * lag, -spring * lag])
    if np.isinf(motor):
        return 0.0, torque[1] / moved[1, 1]
    return np.linalg.solve(moved, torque)


# ---- frequencies


@pytest.mark.parametrize("motor", [np.inf, MOTOR, 7.0])
def test_the_natural_frequency_is_that_of_two_inertias(motor: float) -> None:
    frequency, ratio, critical, _ = own(joint(motor=motor))
    squared = STIFFNESS * (1.0 / motor + 1.0 / LOAD)
    assert frequency == pytest.approx(np.sqrt(squared) / (2.0 * np.pi), rel=1e-14)
    reduced = 1.0 / (1.0 / motor + 1.0 / LOAD)
    assert ratio == pytest.approx(12.0 / (2.0 * np.sqrt(STIFFNESS * reduced)), rel=1e-14)
    assert 2.0 * critical == pytest.approx(np.sqrt(squared), rel=1e-14)


def test_the_makers_example_of_a_critical_speed() -> None:
    """A system of 15 Hz meets two waves in a turn of the input at 450 r/min: CSF-3 manual, chapter 8."""
    load = STIFFNESS / (2.0 * np.pi * 15.0) ** 2
    frequency, _, critical, _ = own(joint(load=load))
    assert frequency == pytest.approx(15.0, rel=1e-14)
    assert critical * 30.0 / np.pi == pytest.approx(450.0, rel=1e-14)


# ---- transfer function


@pytest.mark.parametrize("motor", [np.inf, MOTOR])
@pytest.mark.parametrize("times", [0.3, 0.999, 1.0, 1.7, 20.0])
def test_the_response_is_the_solution_of_the_equations_of_motion(motor, times) -> None:
    made = joint(motor=motor)
    order, speed = 2.0, times * float(own(made)[2])
    found = linear(made, *map(array, (order, ERROR, speed)))
    driver, output = matrix_solution(order, speed, motor, 12.0)
    assert abs(found.motor - driver) <= 1e-12 * abs(output)
    assert abs(found.output - output) <= 1e-12 * abs(output)
    behind = driver - output - ERROR
    assert abs(found.wind_up - behind) <= 1e-12 * abs(output)


def test_slow_errors_go_to_the_output_and_fast_ones_into_the_spring() -> None:
    made = joint()
    slow, fast = (linear(made, *map(array, (2.0, ERROR, speed))) for speed in (0.01, 1e5))
    assert abs(slow.output) == pytest.approx(ERROR, rel=1e-6)
    assert abs(fast.wind_up) == pytest.approx(ERROR, rel=1e-3)


def test_without_damping_a_resonance_has_no_bound() -> None:
    made = joint(damping=0.0, load=1.0)
    frequency = np.sqrt(STIFFNESS)  # a whole number, so that both terms cancel
    found = linear(made, *map(array, (2.0, ERROR, frequency / 2.0)))
    assert np.isinf(found.wind_up)
    assert np.isfinite(linear(made, *map(array, (2.0, ERROR, frequency))).wind_up)


# ---- friction


def test_friction_at_rest_takes_four_over_pi_of_its_torque_at_resonance() -> None:
    """c X + 4 h/pi is what the inertia pushes with, X the amplitude of the rate."""
    made, held = joint(held=0.2), 0.2
    speed = own(made)[2]
    frequency = 2.0 * float(speed)
    found = linear(made, *map(array, (2.0, ERROR, speed)))
    pushed = LOAD * frequency**2 * ERROR
    rate = (pushed - 4.0 * held / np.pi) / 12.0
    assert abs(found.wind_up) * frequency == pytest.approx(rate, rel=1e-11)
    assert not found.sticks


def test_friction_beyond_the_push_holds_the_drive_together() -> None:
    pushed = LOAD * 100.0**2 * ERROR
    for held, sticks in ((np.pi / 4.0 * pushed * 0.999, False), (np.pi / 4.0 * pushed, True)):
        found = linear(joint(held=held), *map(array, (2.0, ERROR, 50.0)))
        assert bool(found.sticks) is sticks
    assert found.wind_up == 0.0
    assert abs(found.output) == pytest.approx(ERROR, rel=1e-12)  # the load follows the error


def test_flanks_that_slide_on_do_not_damp() -> None:
    """A part damps as its describing function says where the vibration turns it back, else not at all."""
    speed = own(joint())[2]
    plain = linear(joint(), *map(array, (2.0, ERROR, speed)))
    most = float(abs(plain.wind_up) * plain.frequency / speed)  # rate for a unit rate of the driver
    on = linear(joint(held=0.2, rate=1.01 * most), *map(array, (2.0, ERROR, speed)))
    assert on.wind_up == plain.wind_up
    rate = 0.5 * most
    back = linear(joint(held=0.2, rate=rate), *map(array, (2.0, ERROR, speed)))
    swing = float(abs(back.wind_up) * back.frequency)
    share = rate * float(speed) / swing
    expected = 4.0 * 0.2 / np.pi * np.sqrt(1.0 - share**2) / swing
    assert back.friction == pytest.approx(expected, rel=1e-10)
    assert abs(back.wind_up) < abs(plain.wind_up)


# ---- the curve


@pytest.mark.parametrize("play", [0.0, 4e-4])
def test_energy_is_the_integral_of_the_torque(play: float) -> None:
    curve = stiffening(play)
    at = np.array([-5e-3, -2e-3, -1e-4, 1.5e-4, 7e-4, 1.1e-3, 2.9e-3, 6e-3])
    np.testing.assert_allclose(
        slope_of_energy(curve, at), torque_and_slope(curve, at)[0], atol=1e-11
    )
    knots = np.asarray(curve.wind_up) + play / 2.0
    np.testing.assert_allclose(torque_and_slope(curve, knots)[0], curve.torque, atol=1e-12)
    beyond = torque_and_slope(curve, knots + 1e-12)[1]
    np.testing.assert_allclose(beyond, curve.stiffness, rtol=1e-6)


# ---- in time

TIMES = np.linspace(0.0, 0.2, 41)
NONE = ErrorOrders(array([0.0]), array([2.0]), array([0.0]))
WAVE = ErrorOrders(array([ERROR]), array([2.0]), array([0.3]))


@pytest.mark.whole
@pytest.mark.parametrize("motor", [np.inf, MOTOR])
def test_a_free_vibration_without_damping_is_a_cosine(motor: float) -> None:
    made = joint(motor=motor, damping=0.0)
    frequency, _, _, rest = own(made)
    start = array([0.0, 0.0, float(rest) + 2e-4, 0.0])
    found = joint_motion(made, NONE, MotorRun.steady(50.0), array(TIMES), start)
    expected = float(rest) + 2e-4 * np.cos(2.0 * np.pi * float(frequency) * TIMES)
    np.testing.assert_allclose(found.wind_up, expected, atol=1e-8 * 2e-4)
    assert found.closure < 1e-8
    assert int(found.status.code) == Code.SOLVED


@pytest.mark.whole
@pytest.mark.parametrize(
    "made",
    [
        joint(stiffening(4e-4)),
        joint(stiffening(4e-4), motor=MOTOR, held=0.5),
        joint(stiffening(), motor=MOTOR, held=0.5, rate=0.003, torque=2.0),
    ],
    ids=["play", "friction at rest", "sliding, flanks change sides"],
)
def test_the_energy_closes_while_the_motor_speeds_up(made: Joint) -> None:
    rest = float(own(made)[3])
    even = MotorRun(array(40.0), array(120.0 if np.isinf(made.motor) else 40.0), array(0.1))
    found = joint_motion(made, WAVE, even, array(TIMES), array([0.0, 0.0, rest + 1e-3, 0.0]))
    assert found.closure < 1e-8
    assert int(found.status.code) == Code.SOLVED
    assert (np.diff(found.damping) >= 0.0).all()
    assert (np.diff(found.friction) >= -1e-12).all()
    assert float(found.damping[-1]) > 0.0


@pytest.mark.whole
def test_a_motor_that_speeds_up_takes_the_load_along() -> None:
    """An even gain of speed needs the torque J a of the load on top, once the vibration has faded."""
    made = joint(damping=400.0)
    gain = 200.0 / RATIO / 0.2
    even = MotorRun(array(40.0), array(240.0), array(0.2))
    start = array([0.0, 0.0, float(own(made)[3]), 0.0])
    found = joint_motion(made, NONE, even, array(TIMES), start)
    assert found.torque[-1] == pytest.approx(TORQUE + LOAD * gain, rel=1e-4)
    assert found.output_rate[-1] == pytest.approx(240.0 / RATIO, rel=1e-2)


@pytest.mark.whole
@pytest.mark.parametrize("times", [0.7, 1.0, 1.4])
def test_small_errors_vibrate_on_the_tangent(times: float) -> None:
    made = joint(stiffening(4e-4))
    order, error, speed = map(array, (2.0, 1e-7, times * float(own(made)[2])))
    whole = steady_joint_vibration(made, order, error, speed, array(fading(made, order, speed)))
    tangent = linear(made, order, error, speed)
    assert int(whole.status.code) == Code.SOLVED
    for name in ("torque", "wind_up", "output"):
        expected = float(abs(getattr(tangent, name)))
        assert getattr(whole, name) == pytest.approx(expected, rel=2e-4)


@pytest.mark.whole
def test_a_free_motor_vibrates_as_the_tangent_says() -> None:
    """From its steady state on, over some periods: the error works on the motor by its slope."""
    made, small = joint(motor=MOTOR), 1e-7
    speed = 0.8 * own(made)[2]
    found = linear(made, *map(array, (2.0, small, speed)))
    angle = float(found.frequency) * TIMES
    swing = {
        name: np.real(complex(getattr(found, name)) * np.exp(1j * angle))
        for name in ("motor", "wind_up")
    }
    rates = {
        name: float(np.real(1j * found.frequency * complex(getattr(found, name)))) for name in swing
    }
    rest = float(own(made)[3])
    # The wind-up of the state counts with the error, whose rate is zero at its crest.
    start = [swing["motor"][0], rates["motor"], rest + swing["wind_up"][0] + small]
    wave = ErrorOrders(array([small]), array([2.0]), array([0.0]))
    there = joint_motion(
        made, wave, MotorRun.steady(speed), array(TIMES), array([*start, rates["wind_up"]])
    )
    size = np.ptp(swing["wind_up"])
    np.testing.assert_allclose(there.wind_up - rest, swing["wind_up"], atol=1e-4 * size)
    np.testing.assert_allclose(there.motor, swing["motor"], atol=1e-3 * np.ptp(swing["motor"]))


@pytest.mark.whole
def test_friction_at_rest_in_time_is_about_its_first_harmonic() -> None:
    made = joint(held=0.1)
    order, error, speed = map(array, (2.0, ERROR, float(own(made)[2])))
    whole = steady_joint_vibration(made, order, error, speed, array(fading(made, order, speed)))
    tangent, free = (linear(one, order, error, speed) for one in (made, joint()))
    swing, lost = (float(abs(one.wind_up)) for one in (tangent, free))
    assert whole.wind_up == pytest.approx(swing, abs=0.05 * (lost - swing))
