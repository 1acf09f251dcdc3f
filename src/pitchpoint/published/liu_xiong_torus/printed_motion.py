"""The motion in six coordinates as Liu and Xiong print it, from rest, by diffrax."""

from functools import partial
from typing import Literal

import diffrax
import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.ellipse import hamrock_brewe_1983
from pitchpoint.contact.hertz import line_pressure
from pitchpoint.core.programs import fast_program
from pitchpoint.lubrication.friction_coefficient import xu_2007

__all__ = [
    "Pairs",
    "Piece",
    "TorusCourse",
    "TorusDrive",
    "friction_forces",
    "pairs",
    "torus_motion",
]

UNIT = 1e-6
"""Length in which places and speeds are integrated [m, m/s]."""

TOLERANCE = 1e-8
"""Largest estimated error of a step, of itself and of a micrometre."""

MOST_STEPS = 20_000
"""Steps between two hand-overs after which the motion is given up."""

SAMPLES = 1500
"""Instants between two hand-overs at which the motion is kept, ends included."""

_LEAST_FORCE = 1e-9

State = Float[Array, "12"]


class TorusDrive(eqx.Module):
    """Gears, oil, bearings and excitation at one operating point.

    Attributes:
        base_radii, mass, inertia: of both gears [m, kg, kg m2].
        tangent: length of the line of action N_p N_g [m].
        entry: place B_g where a pair enters, from N_p [m].
        base_pitch: lambda [m].
        coefficients: of the pair stiffness, powers 1 to 4 of the roll angle of the pinion [N/m].
        pointed: 1 if the flanks touch in points, else 0.
        radius_factor: c of R' = c rho_1 where they do.
        bearing: stiffness K_B, on both ways of both gears [N/m].
        bearing_damping, mesh_damping: damping ratios.
        error: amplitude of the static transmission error [m].
        speed: of the pinion [rad/s].
        torque: on the gear [N m].
        teeth: of the pinion.
        modulus, viscosity, roughness: E' [Pa], eta_0 [Pa s], composite Rq [m].
        transverse_radius, face_width: R_y of the ellipse and the face that the line has [m].
        radii: static; "printed" for R' = c rho_1 and pressures without a face width, "hertz" for the relative
            radii of the flanks and the pressures of ellipse and line.
    """

    base_radii: Float[Array, "2"]
    mass: Float[Array, "2"]
    inertia: Float[Array, "2"]
    tangent: Float[Array, ""]
    entry: Float[Array, ""]
    base_pitch: Float[Array, ""]
    coefficients: Float[Array, "4"]
    pointed: Float[Array, ""]
    radius_factor: Float[Array, ""]
    bearing: Float[Array, ""]
    bearing_damping: Float[Array, ""]
    mesh_damping: Float[Array, ""]
    error: Float[Array, ""]
    speed: Float[Array, ""]
    torque: Float[Array, ""]
    teeth: Float[Array, ""]
    modulus: Float[Array, ""]
    viscosity: Float[Array, ""]
    roughness: Float[Array, ""]
    transverse_radius: Float[Array, ""]
    face_width: Float[Array, ""]
    radii: Literal["printed", "hertz"] = eqx.field(static=True, default="printed")

    @property
    def period(self) -> Float[Array, ""]:
        """Duration of a mesh cycle t_c, eq. 1 [s]."""
        return self.base_pitch / (self.speed * self.base_radii[0])

    @property
    def input_torque(self) -> Float[Array, ""]:
        """T_p in balance with T_g without friction [N m]."""
        return self.torque * self.base_radii[0] / self.base_radii[1]

    @property
    def error_rate(self) -> Float[Array, ""]:
        """Rate w of the static transmission error as printed after eq. 11, w_p Z_p/(2 pi), read as rad/s."""
        return self.speed * self.teeth / (2.0 * jnp.pi)

    @property
    def joint_mass(self) -> Float[Array, ""]:
        """I_e of eq. 9 [kg]."""
        pinion, gear = self.inertia
        both = pinion * self.base_radii[1] ** 2 + gear * self.base_radii[0] ** 2
        return jnp.asarray(pinion * gear / both)


class Pairs(eqx.Module):
    """Both pairs of teeth at an instant, the older one first.

    Attributes:
        place: on the line of action from N_p [m].
        stiffness: k_i; zero out of contact [N/m].
        active: True in contact, by the geometry.
        sliding: v_p - v_g by the nominal speeds [m/s].
        entrainment: mean of v_p and v_g [m/s].
        radius: effective radius R' [m].
    """

    place: Float[Array, "*b 2"]
    stiffness: Float[Array, "*b 2"]
    active: Bool[Array, "*b 2"]
    sliding: Float[Array, "*b 2"]
    entrainment: Float[Array, "*b 2"]
    radius: Float[Array, "*b 2"]


def pairs(drive: TorusDrive, cycle: Float[Array, ""], older: Bool[Array, ""]) -> Pairs:
    """Both pairs of teeth.

    Args:
        drive: that moves.
        cycle: part of the mesh cycle that has gone, mod(t, t_c)/t_c.
        older: True while pair 0 is in contact.

    Source: Liu and Xiong, eqs. 5, 7 and 8.
    """
    entered = cycle + jnp.array([1.0, 0.0])
    place = drive.entry + entered * drive.base_pitch
    gear_radius = drive.tangent - place
    powers = (entered * drive.base_pitch / drive.base_radii[0])[:, None] ** jnp.arange(1, 5)
    active = jnp.stack([older, jnp.ones_like(older)])
    pinion_speed = drive.speed * place
    gear_speed = drive.speed * drive.base_radii[0] / drive.base_radii[1] * gear_radius
    profile = place * gear_radius / drive.tangent
    longer = drive.pointed if drive.radii == "printed" else jnp.zeros(())
    return Pairs(
        place=place,
        stiffness=jnp.where(active, powers @ drive.coefficients, 0.0),
        active=active,
        sliding=pinion_speed - gear_speed,
        entrainment=(pinion_speed + gear_speed) / 2.0,
        radius=jnp.where(longer > 0.0, drive.radius_factor * place, profile),
    )


def normal_forces(
    drive: TorusDrive, time: Float[Array, ""], state: State, found: Pairs
) -> Float[Array, "2"]:
    """Normal forces of both pairs, eqs. 9 to 11; they pull where the flanks would part [N]."""
    swing = drive.error_rate * time
    stretch = UNIT * _error(state[:6]) - drive.error * jnp.cos(swing)
    faster = UNIT * _error(state[6:]) + drive.error * drive.error_rate * jnp.sin(swing)
    damping = 2.0 * drive.mesh_damping * jnp.sqrt(found.stiffness * drive.joint_mass)
    return found.stiffness * stretch + damping * faster


def _error(values: Float[Array, "6"]) -> Float[Array, ""]:
    """Dynamic transmission error, eq. 12, of x_p, x_g, y_p, y_g, r_bp theta_p and r_bg theta_g."""
    return values[4] - values[5] + values[0] - values[1]


def friction_forces(drive: TorusDrive, force: Float[Array, "2"], found: Pairs) -> Float[Array, "2"]:
    """Friction of both pairs with the sign of the nominal sliding, none where they pull [N].

    Source: Liu and Xiong, eqs. 6, 13 and 21.
    """
    pushing = force > 0.0
    pressed = jnp.where(pushing, force, _LEAST_FORCE)
    coefficient = xu_2007(
        pressure=_pressure(drive, pressed, found),
        slide_roll_ratio=jnp.abs(found.sliding) / found.entrainment,
        entrainment=found.entrainment,
        viscosity=drive.viscosity,
        radius=found.radius,
        roughness_rq=drive.roughness,
    )
    return jnp.where(pushing, coefficient * pressed, 0.0) * jnp.sign(found.sliding)


def _pressure(drive: TorusDrive, force: Float[Array, "2"], contacts: Pairs) -> Float[Array, "2"]:
    """Pressure of both pairs [Pa]: that of eq. 21 without a face width, or of Hertz's ellipse and line."""
    both = {"radius": contacts.radius, "modulus": drive.modulus}
    if drive.radii == "printed":
        return line_pressure(line_load=force, **both)
    points = hamrock_brewe_1983(load=force, transverse_radius=drive.transverse_radius, **both)
    lines = line_pressure(line_load=force / drive.face_width, **both)
    return jnp.where(drive.pointed > 0.0, points.pressure, lines)


class TorusCourse(eqx.Module):
    """The motion at the instants that are kept.

    Attributes:
        time: [s].
        weight: of each instant in an integral over time [mesh cycles].
        error: dynamic transmission error [m].
        rate: speeds of the coordinates, those of rotation times the base radius [m/s].
        force, friction: of both pairs, the latter with its sign [N].
        pairs: both pairs of teeth.
    """

    time: Float[Array, "*b"]
    weight: Float[Array, "*b"]
    error: Float[Array, "*b"]
    rate: Float[Array, "*b 6"]
    force: Float[Array, "*b 2"]
    friction: Float[Array, "*b 2"]
    pairs: Pairs


class Piece(eqx.Module):
    """What lies between two hand-overs, or several in turn.

    Attributes:
        gone: mesh cycles before its own.
        start, stop: its ends in its cycle.
        older: True where pair 0 is in contact.
    """

    gone: Float[Array, "*b"]
    start: Float[Array, "*b"]
    stop: Float[Array, "*b"]
    older: Bool[Array, "*b"]

    def at(self, part: Array) -> Array:
        """Cycle that has gone after a part of the piece."""
        return self.start + part * (self.stop - self.start)


@fast_program
def torus_motion(drive: TorusDrive, pieces: Piece) -> TorusCourse:
    """Motion from rest under the full torques.

    Args:
        drive: that moves.
        pieces: between neighbouring hand-overs, in turn.

    Source: Liu and Xiong, eqs. 15 to 20, the sign of the contact forces in eq. 16 such that action equals
    reaction; Prince and Dormand (1981), their method of order eight, as diffrax has it.
    """
    _, motion = jax.lax.scan(partial(_travel, drive), jnp.zeros(12), pieces)
    flat: TorusCourse = jax.tree.map(lambda value: value.reshape(-1, *value.shape[2:]), motion)
    return flat


def _travel(drive: TorusDrive, start: State, piece: Piece) -> tuple[State, TorusCourse]:
    """State at the end of a piece, and the motion on the way."""
    parts = jnp.linspace(0.0, 1.0, SAMPLES)
    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(partial(_rate, drive, piece)),
        diffrax.Dopri8(),
        t0=0.0,
        t1=1.0,
        dt0=None,
        y0=start,
        saveat=diffrax.SaveAt(ts=parts),
        stepsize_controller=diffrax.PIDController(rtol=TOLERANCE, atol=TOLERANCE),
        adjoint=diffrax.ForwardMode(),
        max_steps=MOST_STEPS,
        throw=False,
    )
    assert solution.ys is not None
    motion = jax.vmap(partial(_kept, drive, piece))(parts, solution.ys)
    return solution.ys[-1], motion


def _rate(drive: TorusDrive, piece: Piece, part: Array, state: State, _: None) -> State:
    """Derivative of the state by the part of the piece."""
    cycle = piece.at(part)
    contacts = pairs(drive, cycle, piece.older)
    time = (piece.gone + cycle) * drive.period
    force = normal_forces(drive, time, state, contacts)
    friction = friction_forces(drive, force, contacts)
    faster = _acceleration(drive, UNIT * state, force, friction, contacts) / UNIT
    duration = (piece.stop - piece.start) * drive.period
    return duration * jnp.concatenate([state[6:], faster])


def _acceleration(
    drive: TorusDrive,
    state: State,
    force: Float[Array, "2"],
    friction: Float[Array, "2"],
    contacts: Pairs,
) -> Float[Array, "6"]:
    """Of all coordinates, eqs. 15 to 20 [m/s2]."""
    normal, across = jnp.sum(force), jnp.sum(friction)
    mass = jnp.concatenate([drive.mass, drive.mass])
    held = drive.bearing * state[:4]
    held += 2.0 * drive.bearing_damping * jnp.sqrt(drive.bearing * mass) * state[6:10]
    pushed = jnp.stack([-normal, normal, across, across])
    arms = jnp.stack([contacts.place, drive.tangent - contacts.place])
    outer = jnp.stack([drive.input_torque, -drive.torque])
    torque = outer + jnp.array([-1.0, 1.0]) * drive.base_radii * normal + arms @ friction
    turned = drive.base_radii * torque / drive.inertia
    return jnp.concatenate([(pushed - held) / mass, turned])


def _kept(drive: TorusDrive, piece: Piece, part: Array, state: State) -> TorusCourse:
    """What is kept of an instant; it weighs as in the trapezoidal rule."""
    cycle = piece.at(part)
    contacts = pairs(drive, cycle, piece.older)
    time = (piece.gone + cycle) * drive.period
    force = normal_forces(drive, time, state, contacts)
    inside = jnp.where((part > 0.0) & (part < 1.0), 1.0, 0.5)
    return TorusCourse(
        time=time,
        weight=inside * (piece.stop - piece.start) / (SAMPLES - 1),
        error=UNIT * _error(state[:6]),
        rate=UNIT * state[6:],
        force=force,
        friction=friction_forces(drive, force, contacts),
        pairs=contacts,
    )
