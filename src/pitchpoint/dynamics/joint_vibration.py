"""Torsional vibration of a joint: motor, drive and load, excited by the error of the drive."""

import equinox as eqx
from jaxtyping import Array, Bool, Complex, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.core.roots import find_root
from pitchpoint.dynamics.system import reduced_mass
from pitchpoint.loading.wind_up_curve import WindUpCurve

__all__ = ["Joint", "JointResponse", "Sliding", "joint_response"]

Each = Float[Arrays, "*#b"]
One = Float[Arrays, ""]


class Sliding(eqx.Module):
    """Friction of flanks that the drive has sliding, and that a vibration makes slide back.

    Attributes:
        held: torque that the friction of each part holds at the output [N m].
        rate: of the wind-up at which the part would stand still, for a unit rate of the driver [1]; zero
            for a drive at rest, whose loop this friction is.
    """

    held: Float[Arrays, " part"]
    rate: Float[Arrays, " part"]

    @classmethod
    def none(cls) -> "Sliding":
        """No friction."""
        return cls(jnp.zeros(1), jnp.ones(1))

    def first_harmonic(self, rate: Each, driver: Each) -> Float[Array, "*b"]:
        """Amplitude of the friction torque in phase with a wind-up that swings [N m].

        Args:
            rate: amplitude of the rate of the wind-up [rad/s].
            driver: rate of the driver [rad/s].

        The describing function of Coulomb friction beside a steady sliding: (4/pi) h sqrt(1 - (r/X)^2) of
        a part that the vibration turns back, X > r, and none of one that slides on.
        """

        def of_part(total: Array, part: tuple[Array, Array]) -> tuple[Array, None]:
            held, part_rate = part
            back = jnp.abs(part_rate) * driver < rate
            share = jnp.where(back, part_rate * driver / jnp.where(back, rate, 1.0), 0.0)
            return total + jnp.where(back, held * jnp.sqrt(1.0 - share**2), 0.0), None

        start = jnp.zeros(jnp.broadcast_shapes(jnp.shape(rate), jnp.shape(driver)))
        parts = jnp.asarray(self.held), jnp.asarray(self.rate)
        total, _ = jax.lax.scan(of_part, start, parts)
        return 4.0 / jnp.pi * total


class Joint(eqx.Module):
    """Motor and load with a drive between them; everything is counted at the output.

    Attributes:
        curve: torque over wind-up.
        torque: constant, of the load, against the motion [N m].
        motor: moment of inertia at the driver times the square of the ratio; infinite for a motor that
            holds its speed [kg m2].
        load: moment of inertia at the output [kg m2].
        damping: torque over the rate of the wind-up [N m s/rad].
        ratio: rate of the driver over that of the output, without its sign.
        sliding: friction of the flanks.

    For the wind-up d = a - b - e of motor a and load b behind an error e of the drive:
    J1 a'' = T1 - T (1 - e_a), J2 b'' = T - T2 with the torque T = T(d) + c d' + friction and the slope e_a
    of the error over the rotation of the motor, by virtual work.
    """

    curve: WindUpCurve
    torque: One
    motor: One
    load: One
    damping: One
    ratio: One
    sliding: Sliding

    @property
    def reduced(self) -> Float[Array, ""]:
        """Moment of inertia that vibrates on the wind-up [kg m2]: that of the load on a held motor."""
        both = jnp.stack([jnp.asarray(self.motor), jnp.asarray(self.load)])
        return reduced_mass(both, jnp.ones(2))

    @property
    def wind_up(self) -> Float[Array, ""]:
        """Wind-up under the constant torque, from the middle of the play [rad]."""
        curve, loaded = self.curve, self.torque > 0.0
        torque = jnp.where(loaded, self.torque, curve.torque[-1])
        inside = jnp.interp(torque, curve.torque, curve.wind_up)
        beyond = jnp.maximum(torque - curve.torque[-1], 0.0) / curve.stiffness[-1]
        touch = jnp.maximum(jnp.asarray(curve.play), 0.0) / 2.0
        guess = touch + inside + beyond
        solution, _ = find_root(lambda at: curve.torque_at(at) / torque - 1.0, guess, 4.0 * guess)
        return jnp.where(loaded, solution, touch)

    @property
    def stiffness(self) -> Float[Array, ""]:
        """Slope of the torque over the wind-up under the constant torque [N m/rad]."""
        here = self.curve.slope_at(self.wind_up)
        return jnp.where(self.torque > 0.0, here, jnp.asarray(self.curve.stiffness)[0])

    @property
    def natural_frequency(self) -> Float[Array, ""]:
        """Of the wind-up for small vibrations, without damping [1/s].

        f = sqrt(K (1/J1 + 1/J2))/(2 pi); on a held motor that of makers, sqrt(K/J2)/(2 pi).
        Source: Harmonic Drive Systems, CSF-3 Series, manual, chapter 8.
        """
        return jnp.sqrt(self.stiffness / self.reduced) / (2.0 * jnp.pi)

    @property
    def damping_ratio(self) -> Float[Array, ""]:
        """Damping over the critical one, without friction of the flanks."""
        return self.damping / (2.0 * jnp.sqrt(self.stiffness * self.reduced))

    def critical_speed(self, order: Each) -> Float[Array, "*b"]:
        """Rate of the driver at which waves of an order meet the natural frequency [rad/s].

        Args:
            order: waves in a turn of the driver.
        """
        return 2.0 * jnp.pi * self.natural_frequency / order


class JointResponse(eqx.Module):
    """Steady vibration by one wave of the error, as complex amplitudes of exp(i omega t).

    Attributes:
        frequency: omega [rad/s].
        wind_up: beyond that of the constant torque [rad].
        torque: of the drive, likewise [N m].
        motor: rotation of the driver over the ratio, beyond the uniform one [rad].
        output: rotation of the load, beyond the uniform one [rad].
        friction: torque over rate of the wind-up that stands for the friction of the flanks [N m s/rad].
        sticks: True where that friction holds the drive together.

    From the equation of `joint_response`.
    """

    frequency: Float[Array, "*b"]
    wind_up: Complex[Array, "*b"]
    torque: Complex[Array, "*b"]
    motor: Complex[Array, "*b"]
    output: Complex[Array, "*b"]
    friction: Float[Array, "*b"]
    sticks: Bool[Array, "*b"]


def joint_response(joint: Joint, order: Each, amplitude: Each, speed: Each) -> JointResponse:
    """Steady vibration for small deviations from the constant torque, each wave of the error by itself.

    Args:
        joint: what vibrates.
        order: waves in a turn of the driver.
        amplitude: of the error [rad].
        speed: rate of the driver [rad/s].

    Returns:
        Infinite at resonance without damping.

    (K - J w^2 + i w (c + c_f)) D = J (w^2 + i n ratio T/J1) E of the reduced moment of inertia J; friction
    c_f by its first harmonic at this amplitude, found where both sides are equally large.

    From Newton's law on motor and load, linear about the constant torque.
    """
    order, amplitude, speed = jnp.broadcast_arrays(*map(jnp.asarray, (order, amplitude, speed)))
    frequency, inertia = order * speed, joint.reduced
    pushed = 1j * order * joint.ratio * joint.torque * amplitude
    yields = 1.0 / jnp.asarray(joint.motor)  # none of a motor that holds its speed
    moved = inertia * (frequency**2 * amplitude + pushed * yields)
    elastic = joint.stiffness - inertia * frequency**2
    rate, held = _rate(joint, elastic, jnp.abs(moved), frequency, speed)
    moves = rate > 0.0
    friction = jnp.where(moves, held / jnp.where(moves, rate, 1.0), 0.0)
    lost = 1j * frequency * (joint.damping + friction)
    swings = elastic + lost != 0.0
    wind_up = jnp.where(swings, moved / jnp.where(swings, elastic + lost, 1.0), jnp.inf)
    wind_up = jnp.where(moves, wind_up, 0.0)
    # What sticks transmits whatever keeps the load behind the error.
    torque = jnp.where(moves, (joint.stiffness + lost) * wind_up, moved)
    square = frequency**2
    return JointResponse(
        frequency=frequency,
        wind_up=wind_up,
        torque=torque,
        motor=(torque - pushed) * yields / square,
        output=-torque / (joint.load * square),
        friction=friction,
        sticks=~moves,
    )


def _rate(
    joint: Joint, elastic: Array, moved: Array, frequency: Array, speed: Array
) -> tuple[Array, Array]:
    """Amplitude of the rate of the wind-up, none where it sticks, and of the friction in phase with it."""
    free = jnp.abs(elastic / frequency + 1j * joint.damping)
    swings = free > 0.0
    most = moved / jnp.where(swings, free, 1.0)

    def residual(share: Array) -> Array:
        rate = share * most
        friction = joint.sliding.first_harmonic(rate, speed)
        both = jnp.abs(elastic * rate / frequency + 1j * (joint.damping * rate + friction))
        return both / jnp.where(moved > 0.0, moved, 1.0) - 1.0

    share, _ = find_root(residual, jnp.ones_like(most), 1.0)
    at_rest = jnp.where(jnp.asarray(joint.sliding.rate) == 0.0, joint.sliding.held, 0.0)
    moves = 4.0 / jnp.pi * jnp.sum(at_rest) < moved
    rate = jnp.where(moves, share * most, 0.0)
    return rate, joint.sliding.first_harmonic(rate, speed)
