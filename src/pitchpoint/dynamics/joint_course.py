"""Course of a joint in time, with the whole curve of its wind-up, by diffrax."""

from dataclasses import replace
from typing import Any

import diffrax
import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import looping_program, program
from pitchpoint.core.status import Code, Status
from pitchpoint.dynamics.energy import relative_closure
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.joint_vibration import Joint, joint_response

__all__ = [
    "JointCourse",
    "MotorRun",
    "SteadyVibration",
    "fading",
    "joint_motion",
    "steady_joint_vibration",
]

CLOSED = 1e-8
"""Largest part of the energy that may be left over."""

REPEATS = 1e-5
"""Change of the wind-up from one period to the next, over its amplitude, below which it is steady."""

FADED = 1e-7
"""Part of a free vibration that is left when a steady one is looked at."""

MOST_PERIODS = 2000.0
"""Periods of a wave after which a vibration is looked at in any case."""

TOLERANCE = 1e-11
"""Largest estimated error of a step, of states of order one."""

# The integrator asks for a bound: 131 steps for each of `MOST_PERIODS` periods.
MOST_STEPS = 2**18

POINTS = 256
"""Times in the last period of a steady vibration."""

CREEP = 1e-3
"""Rate of the wind-up, over its scale, at which 76 % of the friction of a flank acts."""

TURN = 2.0 * np.pi
"""Rotation of the driver in which an error repeats [rad]."""

# Work put in, lost to damping, and lost to friction: they stand behind the motion in the state.
_WORKS = 3

One = Float[Arrays, ""]
Times = Float[Array, "*time"]


class MotorRun(eqx.Module):
    """How the motor runs: at a rate that rises or falls evenly, then stays.

    A motor of finite inertia starts at the first rate and has the torque that balances the load.

    Attributes:
        start, stop: rate of the driver [rad/s].
        duration: of the change between them [s]; positive.
    """

    start: One
    stop: One
    duration: One

    @classmethod
    def steady(cls, speed: float | Array) -> "MotorRun":
        """One speed throughout [rad/s]."""
        return cls(jnp.asarray(speed), jnp.asarray(speed), jnp.ones(()))

    def rate(self, time: Array) -> Array:
        """Rate of the driver [rad/s]."""
        part = jnp.clip(time / self.duration, 0.0, 1.0)
        return self.start + (self.stop - self.start) * part

    def turned(self, time: Array) -> Array:
        """Rotation of the driver [rad]."""
        changing = jnp.clip(time, 0.0, self.duration)
        gained = (self.stop - self.start) * changing * (changing / self.duration / 2.0)
        return self.start * time + gained + (self.stop - self.start) * (time - changing)

    def gain(self, time: Array) -> Array:
        """Derivative of the rate [rad/s2]."""
        return jnp.where(time < self.duration, (self.stop - self.start) / self.duration, 0.0)


class JointCourse(eqx.Module):
    """Motion of a joint over time.

    Attributes:
        time: an axis of it, or none for one moment [s].
        motor: rotation of the driver over the ratio, beyond that of the even motion [rad].
        wind_up: from the middle of the play [rad].
        torque: of the drive on the load [N m].
        output_rate: rate of the load [rad/s].
        kinetic: energy of motor and load; of a motor that holds its speed none [J].
        elastic: energy of the drive [J].
        put_in: work of the motor since the start less that of the load's torque [J].
        damping, friction: lost since the start [J].
        status: solved where the end was reached and the energy closes.
    """

    time: Times
    motor: Times
    wind_up: Times
    torque: Times
    output_rate: Times
    kinetic: Times
    elastic: Times
    put_in: Times
    damping: Times
    friction: Times
    status: Status

    @property
    def closure(self) -> Float[Array, ""]:
        """Most that is ever left of the energy, relative to the largest part; zero where nothing moves."""
        stored = self.kinetic + self.elastic
        parts = jnp.stack([stored - stored[0], self.put_in, self.damping, self.friction])
        left = parts[1] - parts[0] - parts[2] - parts[3]
        return relative_closure(left, parts)


class SteadyVibration(eqx.Module):
    """Steady vibration by one wave of the error, with the whole curve of the wind-up.

    Attributes:
        torque: half of the range of the drive's torque over the last period [N m].
        wind_up: the same of the wind-up [rad].
        output: the same of the rotation of the load beyond the even one [rad].
        smallest: torque of the drive in that period [N m].
        status: solved where the last two periods are alike and the energy closes; residual is their
            difference over the amplitude.
    """

    torque: Float[Array, ""]
    wind_up: Float[Array, ""]
    output: Float[Array, ""]
    smallest: Float[Array, ""]
    status: Status


@program
def joint_motion(
    joint: Joint,
    excitation: ErrorOrders,
    drive: MotorRun,
    times: Float[Arrays, " time"],
    start: Float[Arrays, "4"],
) -> JointCourse:
    """Motion of a joint from a start.

    Args:
        joint: what moves.
        excitation: error of its drive, by how much its output lags [rad], over the turns of the driver.
        drive: how the motor runs.
        times: at which the motion is kept, rising; the first one is the start [s].
        start: rotation of the motor beyond the even one and its rate, wind-up with the error and its rate
            [rad, rad/s], the first two at the output and zero for a motor that holds its speed.

    Returns:
        NaN where the integration did not get to.

    Source: Prince and Dormand (1981), their method of order eight, as diffrax has it.
    """
    motion = _Motion(
        joint, excitation, drive, _length(joint, excitation, drive, jnp.asarray(start))
    )
    begin = jnp.concatenate([jnp.asarray(start), jnp.zeros(_WORKS)]) / motion.units

    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(motion.scaled),
        diffrax.Dopri8(),
        t0=times[0],
        t1=times[-1],
        dt0=None,
        y0=begin,
        saveat=diffrax.SaveAt(ts=jnp.asarray(times)),
        stepsize_controller=diffrax.PIDController(rtol=1e-13, atol=TOLERANCE),
        adjoint=diffrax.ForwardMode(),
        max_steps=MOST_STEPS,
        throw=False,
    )
    assert solution.ys is not None
    reached = solution.result == diffrax.RESULTS.successful
    states = jnp.where(jnp.isfinite(solution.ys), solution.ys, jnp.nan) * motion.units
    described = jax.vmap(motion.described)(jnp.asarray(times), states)
    return _judged(described, reached, solution.stats["num_steps"])


def _judged(motion: JointCourse, reached: Bool[Array, ""], steps: Int[Array, ""]) -> JointCourse:
    """The course with what became of it: the energy has to close."""
    closes = reached & (motion.closure <= CLOSED)
    code = jnp.where(closes, int(Code.SOLVED), int(Code.NOT_CONVERGED))
    return replace(motion, status=Status(code, motion.closure, steps))


def _length(joint: Joint, excitation: ErrorOrders, drive: MotorRun, start: Array) -> Array:
    """Scale of the vibration [rad]: error, start, and what the torque that speeds up the load winds up."""
    gain = jnp.abs(drive.stop - drive.start) / drive.duration / joint.ratio
    parts = [
        jnp.sum(jnp.abs(excitation.amplitude)),
        jnp.abs(start[0]) + jnp.abs(start[2] - joint.wind_up),
        joint.load * gain / joint.stiffness,
    ]
    length = sum(parts, jnp.zeros(()))
    return jnp.where(length > 0.0, length, 1.0)


class _Motion(eqx.Module):
    """Equations of motion of the state: motor, wind-up with the error, the rates of both, and works."""

    joint: Joint
    excitation: ErrorOrders
    drive: MotorRun
    length: Array

    @property
    def frequency(self) -> Array:
        return 2.0 * jnp.pi * self.joint.natural_frequency

    @property
    def units(self) -> Array:
        """What of each part of the state is of order one."""
        joint, length = self.joint, self.length
        swing = jnp.stack([length, length * self.frequency])
        work = joint.stiffness * length * (length + joint.wind_up)
        return jnp.concatenate([swing, swing, jnp.full(_WORKS, work)])

    def scaled(self, time: Any, state: Any, _: Any) -> Array:
        """Derivative of the state without dimensions."""
        return self._change(jnp.asarray(time), state * self.units) / self.units

    def _change(self, time: Array, state: Array) -> Array:
        joint, there = self.joint, self._at(time, state)
        even = self.drive.gain(time) / joint.ratio
        lack = joint.torque - there.torque * (1.0 - there.slope)
        faster = jnp.where(self.held, even, lack / joint.motor)
        load = (there.torque - joint.torque) / joint.load
        moved = jnp.stack([state[1], faster - even, state[3], faster - load])
        return jnp.concatenate([moved, self._powers(there)])

    @property
    def held(self) -> Array:
        """True for a motor that holds its speed."""
        return jnp.isinf(self.joint.motor)

    def _powers(self, there: "_JointState") -> Array:
        """Net power of motor and load, and those lost to damping and friction [W]."""
        driving = jnp.where(self.held, there.torque * (1.0 - there.slope), self.joint.torque)
        put_in = driving * there.motor_rate - self.joint.torque * there.output_rate
        lost = self.joint.damping * there.rate**2
        return jnp.stack([put_in, lost, there.friction * there.rate])

    def _at(self, time: Array, state: Array) -> "_JointState":
        joint, drive = self.joint, self.drive
        motor_rate = drive.rate(time) / joint.ratio + state[1]
        turns = (drive.turned(time) + joint.ratio * state[0]) / TURN
        error, slope = self.excitation.at(turns), joint.ratio / TURN * self.excitation.slope(turns)
        wind_up, rate = state[2] - error, state[3] - slope * motor_rate
        friction = self._friction(rate, drive.rate(time))
        torque = joint.curve.torque_at(wind_up) + joint.damping * rate + friction
        return _JointState(
            wind_up, rate, torque, friction, slope, motor_rate, motor_rate - state[3]
        )

    def _friction(self, rate: Array, driver: Array) -> Array:
        """Friction of the flanks beyond that at an even motion [N m]."""
        sliding, creep = self.joint.sliding, CREEP * self.length * self.frequency
        even_rate = sliding.rate * driver
        share = jnp.tanh((even_rate + rate) / creep) - jnp.tanh(even_rate / creep)
        return jnp.sum(sliding.held * share)

    def described(self, time: Array, state: Array) -> JointCourse:
        """What is kept of a state."""
        there, joint = self._at(time, state), self.joint
        of_motor = jnp.where(self.held, 0.0, joint.motor) * there.motor_rate**2
        return JointCourse(
            time=time,
            motor=state[0],
            wind_up=there.wind_up,
            torque=there.torque,
            output_rate=there.output_rate,
            kinetic=(of_motor + joint.load * there.output_rate**2) / 2.0,
            elastic=joint.curve.energy_at(there.wind_up),
            put_in=state[4],
            damping=state[5],
            friction=state[6],
            status=Status(jnp.asarray(0), jnp.zeros(()), jnp.asarray(0)),
        )


class _JointState(eqx.Module):
    """Wind-up and its rate, torque with friction, slope of the error, rates of motor and load."""

    wind_up: Array
    rate: Array
    torque: Array
    friction: Array
    slope: Array
    motor_rate: Array
    output_rate: Array


@looping_program
def steady_joint_vibration(
    joint: Joint, order: One, amplitude: One, speed: One, periods: Float[Arrays, ""]
) -> SteadyVibration:
    """Steady vibration by one wave of the error, from the linear one on.

    Args:
        joint: what vibrates; its motor holds its speed.
        order: waves in a turn of the driver.
        amplitude: of the error [rad].
        speed: rate of the driver [rad/s].
        periods: of the wave until it is looked at, see `fading`.
    """
    linear = joint_response(joint, order, amplitude, speed)
    period = 2.0 * jnp.pi / linear.frequency
    frequency = linear.frequency
    place, rate = jnp.real(linear.wind_up), jnp.real(1j * frequency * linear.wind_up)
    start = jnp.stack([jnp.zeros(()), jnp.zeros(()), joint.wind_up + place + amplitude, rate])
    sampled = period * (periods + jnp.linspace(0.0, 2.0, 2 * POINTS + 1))
    wave = ErrorOrders(*(jnp.reshape(value, 1) for value in (amplitude, order, jnp.zeros(()))))
    times = jnp.concatenate([jnp.zeros(1), sampled])
    motion = joint_motion(joint, wave, MotorRun.steady(speed), times, start)
    return _settled(joint, wave, motion, speed)


def _settled(joint: Joint, wave: ErrorOrders, motion: JointCourse, speed: One) -> SteadyVibration:
    before, after = motion.wind_up[1 : POINTS + 2], motion.wind_up[POINTS + 1 :]
    swing = jnp.ptp(after) / 2.0
    changed = jnp.max(jnp.abs(after - before)) / jnp.where(swing > 0.0, swing, 1.0)
    error = wave.at(jnp.asarray(speed) / TURN * motion.time[POINTS + 1 :])
    torque = motion.torque[POINTS + 1 :]
    alike = jnp.where(changed <= REPEATS, int(Code.SOLVED), int(Code.NOT_SETTLED))
    code = jnp.where(motion.status.code == int(Code.SOLVED), alike, motion.status.code)
    return SteadyVibration(
        torque=jnp.ptp(torque) / 2.0,
        wind_up=swing,
        output=jnp.ptp(after + error) / 2.0,
        smallest=jnp.min(torque),
        status=Status(code, changed, motion.status.iterations),
    )


def fading(joint: Joint, order: One, speed: One) -> float:
    """Whole periods of a wave after which a free vibration has faded, see `FADED`, or the most of them.

    Args:
        joint: what vibrates.
        order: waves in a turn of the driver.
        speed: rate of the driver [rad/s].

    From the decay of a free vibration by its damping.
    """
    damping, motor, load = map(float, (joint.damping, joint.motor, joint.load))
    decay = damping * (1.0 / motor + 1.0 / load) / 2.0
    needed = -np.log(FADED) / decay if decay > 0.0 else np.inf
    waves = needed * float(order) * float(speed) / (2.0 * np.pi)
    return float(np.ceil(min(waves, MOST_PERIODS)))
