"""Torsional vibration of a joint with its drive, as a dataset of a case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import equinox as eqx
import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.analysis import Piece, PieceProgress, silent
from pitchpoint.analyses.bodies import bodies_of
from pitchpoint.analyses.kinematic_error import deviation_error
from pitchpoint.analyses.main_figures import numbers
from pitchpoint.analyses.torsion import engaged_at, kinematic_play, onset_friction, wound_ups
from pitchpoint.cases.built import Built
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, solve_summary
from pitchpoint.dynamics.joint_course import fading, steady_joint_vibration
from pitchpoint.dynamics.joint_vibration import Joint, Sliding, joint_response
from pitchpoint.dynamics.system import modal_damping, reduced_mass
from pitchpoint.errors import ConvergenceError
from pitchpoint.loading.wind_up_curve import WindUpCurve
from pitchpoint.results.store import dataset

__all__ = ["joint_figures", "joint_of", "joint_part"]

MOTORS = ("motor holds its speed", "motor runs free")

TORQUES = np.array([0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0])
"""Points of the curve of the wind-up, over the torque of the operating point."""

RATED = int(np.flatnonzero(TORQUES == 1.0)[0])
"""Number of the point that is the operating one."""

PARTS = 48
"""Parts in which the friction of the flanks is taken, by the rate that turns their sliding back."""

LEAST = 0.02
"""Part of the largest wave below which waves of the error are left out."""

MOST_WAVES = 5

SPEEDS = 200
"""Speeds of a driver that are looked at where a case gives none."""

ALONE = (
    "The teeth have no deviations: what excites the joint is the ripple alone that the teeth make as they "
    "come to carry, and a real drive vibrates more."
)

LEFT_OUT = (
    "Left out: control of the motor, torsion of shafts and links outside the drive, friction of bearings and "
    "seals, changes of the stiffness with the phase"
)


@dataclass(frozen=True)
class _Waves:
    """Waves of the error of a drive: their names, orders and amplitudes [rad]."""

    names: list[str]
    order: np.ndarray
    amplitude: np.ndarray

    @property
    def strongest(self) -> int:
        return int(np.argmax(self.amplitude))


@dataclass(frozen=True)
class _Torsion:
    """What a joint asks of its drive: curve, friction of the flanks, and the ripple of the teeth [rad]."""

    curve: WindUpCurve
    sliding: Sliding
    ripple: float


def joint_part(built: Built, progress: PieceProgress) -> xr.Dataset:
    """Natural frequencies, and the vibration by each wave of the drive's error over the driver's speed.

    Args:
        built: the case.
        progress: told the number of states of the kinematic error that are done.
    """
    torsion = _torsion(built)
    waves = _waves(built, torsion.ripple, progress)
    joints = [_joint(built, torsion, free) for free in (False, True)]
    stacked = jax.tree.map(lambda *values: np.stack(values), *joints)
    figures = jax.device_get(_own(stacked, array(waves.order)))
    speeds = _speeds(built, figures["critical_speed"], waves)
    amplitudes = jax.device_get(
        _against_speed(stacked, *map(array, (waves.order, waves.amplitude, speeds)))
    )
    names, courses = _courses(
        built, joints[0], waves, figures["critical_speed"][0, waves.strongest]
    )
    axes = ("motor", "excitation", "speed")
    over = {1: ("motor",), 2: ("motor", "excitation")}
    return dataset(
        {
            **{name: (over[values.ndim], values) for name, values in figures.items()},
            **{name: (axes, values) for name, values in amplitudes.items()},
            **{name: (("course",), values) for name, values in courses.items()},
            "wave_order": (("excitation",), waves.order),
            "wave_amplitude": (("excitation",), waves.amplitude),
            "kinematic_play": ((), float(torsion.curve.play)),
        },
        {
            "motor": [*MOTORS],
            "excitation": waves.names,
            "speed": speeds,
            "course": names,
        },
        title="torsional vibration",
        travels=built.travels,
        warnings=[
            *_light_motor(built),
            *_unloaded(built, amplitudes, speeds, waves),
            *_unsettled(names, courses),
        ],
        note=f"{'' if any(built.deviations) else f'{ALONE} '}{LEFT_OUT}.",
        strongest=waves.names[waves.strongest],
        solve=solve_summary(courses["course_status"].astype(int)),
    )


def _torsion(built: Built) -> _Torsion:
    """Curve of the wind-up, friction and ripple of the drive at the operating point."""
    engagement, rated = engaged_at(built), built.case.operation.load
    torques = TORQUES * (rated or 1.0)
    at_torques, body = wound_ups(built, engagement, torques)
    wound_up: Any = jax.tree.map(lambda *values: np.stack(values), *at_torques)
    at = RATED if rated else 0
    weight = np.asarray(engagement.weight)
    ripple = np.exp(-2j * np.pi * np.asarray(engagement.phase)) * weight
    ends = built.design.mesh, built.design.loaded
    play = np.asarray(kinematic_play(*ends, engagement.contacts, engagement.phase, body)) @ weight
    slope = 1.0 / ((1.0 / wound_up.stiffness) @ weight)
    turned, carried, slopes = map(
        array, _found(np.stack([wound_up.wind_up @ weight, torques, slope]))
    )
    curve = WindUpCurve(turned, carried, slopes, array(max(play, 0.0)))
    approach = (wound_up.wind_up + wound_up.touch)[at]
    sliding = _sliding(built, engagement, wound_up.force[at])
    return _Torsion(curve, sliding, float(2.0 * np.abs(approach @ ripple)))


def _found(points: np.ndarray) -> np.ndarray:
    """Points up to the first torque without equilibrium.

    Raises:
        ConvergenceError: that of the operating point has none.
    """
    lost = np.flatnonzero(~np.isfinite(points).all(axis=0))
    if lost.size and lost[0] <= RATED:
        raise ConvergenceError(
            "no equilibrium of the teeth was found up to the torque of the operating point, and without one "
            "there is no spring for the joint to vibrate on"
        )
    return points[:, : lost[0]] if lost.size else points


def _sliding(built: Built, known: Any, force: np.ndarray) -> Sliding:
    """Friction of all flanks at the operating point, gathered in parts of equal count by their rates."""
    design = built.design
    slip = jax.device_get(known.contacts).slip_arm
    ways: Any = jax.device_get((design.loaded, design.motion))
    loaded_slip, nominal = (np.asarray(contact_velocity(slip, direction)) for direction in ways)
    held = (force * np.abs(loaded_slip) * np.asarray(known.weight)).ravel()
    rate = np.abs(nominal / np.where(loaded_slip != 0.0, loaded_slip, np.inf)).ravel()
    order = np.argsort(np.where(held > 0.0, rate, np.inf))[: max(np.count_nonzero(held), 1)]
    groups = np.array_split(order, PARTS)
    sums = np.array([held[group].sum() for group in groups])
    means = np.array([_mean(rate[group], held[group]) for group in groups])
    friction = np.nan_to_num(np.nanmin([*onset_friction(built), np.inf]), posinf=0.0)
    return Sliding(array(friction * sums), array(means))


def _mean(values: np.ndarray, weight: np.ndarray) -> float:
    """Weighted mean; one of nothing, which counts nowhere."""
    return float(values @ weight / weight.sum()) if weight.sum() > 0.0 else 1.0


def _waves(built: Built, ripple: float, progress: PieceProgress) -> _Waves:
    """Waves of the error that are not small: those of deviations, and the ripple of the teeth."""
    every = [*_of_deviations(built, progress), _of_teeth(built, ripple)]
    every.sort(key=lambda wave: -wave[2])
    large = [wave for wave in every if wave[2] >= LEAST * every[0][2]][:MOST_WAVES]
    names, orders, amplitudes = zip(*large, strict=True)
    return _Waves([*names], np.array(orders), np.array(amplitudes))


def _of_teeth(built: Built, ripple: float) -> tuple[str, float, float]:
    """Name, order and amplitude of what the teeth make as they come to carry."""
    order = float(2.0 * np.pi / abs(built.nominal["period"]))
    return f"passing teeth, order {order:.4g}", order, ripple


def _of_deviations(built: Built, progress: PieceProgress) -> list[tuple[str, float, float]]:
    """The same of deviations of both members, at orders below half the number of teeth."""
    if not any(built.deviations):
        return []
    data = deviation_error(built, progress)
    spectrum = data["kinematic_error_spectrum"].sel(curve="under load").values
    turns = _turns(built)
    return [
        (f"{member}, order {order}", order * turns[position], float(spectrum[position, order]))
        for position, member in enumerate(data["member"].values)
        for order in range(1, spectrum.shape[1] // 2)
    ]


def _turns(built: Built) -> list[float]:
    """Turns of each member against what makes it carry, for one of the driver."""
    motion = built.nominal["motion"]
    against = [motion[k] for k, body in enumerate(built.bodies) if body.member is None]
    places = sorted(
        (body.member, k) for k, body in enumerate(built.bodies) if body.member is not None
    )
    return [abs(float(motion[k] - sum(against))) for _, k in places]


def _joint(built: Built, torsion: _Torsion, free: bool) -> Joint:
    """Motor, drive and load of a case; damping is that which gives the free joint its ratio."""
    dynamics = built.case.dynamics
    assert dynamics is not None
    assert dynamics.inertia is not None
    driver, load = dynamics.inertia
    ratio = abs(built.nominal["driver"] @ built.nominal["motion"]) / built.output_rate
    both = array([driver * ratio**2, load])
    curve_and_load = torsion.curve, array(built.case.operation.load)
    none, motor = array(0.0), both[0] if free else array(np.inf)
    joint = Joint(*curve_and_load, motor, both[1], none, array(ratio), torsion.sliding)
    return replace(joint, damping=_damping(joint, both, array(dynamics.damping_ratio)))


@program
def _damping(
    joint: Joint, inertias: Float[Array, "2"], ratio: Float[Array, ""]
) -> Float[Array, ""]:
    """Damping of the joint by its ratio [N m s]; stiffness is sought in a loop."""
    mass = reduced_mass(inertias, jnp.ones(2))
    return modal_damping(mass[None, None], joint.stiffness[None, None], ratio)[0, 0]


def _speeds(built: Built, critical: np.ndarray, waves: _Waves) -> np.ndarray:
    """Speeds of the driver, with all critical ones between them."""
    dynamics = built.case.dynamics
    assert dynamics is not None
    if dynamics.speeds is not None:
        speeds = np.linspace(
            dynamics.speeds.start, dynamics.speeds.stop, int(dynamics.speeds.count)
        )
    else:
        most = 1.5 * max(built.case.operation.speed, critical[:, waves.strongest].max())
        speeds = np.linspace(most / SPEEDS, most, SPEEDS)
    inside = critical[(critical >= speeds[0]) & (critical <= speeds[-1])]
    return np.union1d(speeds, inside)


@program
def _own(joints: Joint, order: Float[Array, " wave"]) -> dict[str, Array]:
    """Figures of each joint, and its critical speeds."""

    def of(joint: Joint) -> dict[str, Array]:
        return {
            "natural_frequency": joint.natural_frequency,
            "joint_damping_ratio": joint.damping_ratio,
            "reduced_inertia": joint.reduced,
            "tangent_torsional_stiffness": joint.stiffness,
            "critical_speed": joint.critical_speed(order),
        }

    figures: dict[str, Array] = eqx.filter_vmap(of)(joints)
    return figures


@program
def _against_speed(
    joints: Joint,
    order: Float[Array, " wave"],
    amplitude: Float[Array, " wave"],
    speed: Float[Array, " speed"],
) -> dict[str, Array]:
    """Amplitudes [motor, wave, speed] by the tangent of the curve."""

    def of(joint: Joint) -> dict[str, Array]:
        response = joint_response(joint, order[:, None], amplitude[:, None], speed[None])
        output = jnp.abs(response.output)
        critical = 2.0 * jnp.sqrt(joint.stiffness * joint.reduced)
        return {
            "output_amplitude": output,
            "output_speed_amplitude": response.frequency * output,
            "torque_amplitude": jnp.abs(response.torque),
            "flank_damping_ratio": response.friction / critical,
        }

    amplitudes: dict[str, Array] = eqx.filter_vmap(of)(joints)
    return amplitudes


NEAR = 10.0
"""Times by which a wave may be faster or slower than the natural frequency to be integrated in time."""


def _courses(
    built: Built, joint: Joint, waves: _Waves, critical: float
) -> tuple[list[str], dict[str, np.ndarray]]:
    """The strongest wave with the whole curve of the wind-up, in time, beside its tangent.

    At its critical speed, and at the operating one where the wave is not far from the natural frequency.
    """
    order, amplitude = (array(v[waves.strongest]) for v in (waves.order, waves.amplitude))
    speeds = {"operating speed": built.case.operation.speed, "critical speed": critical}
    near = {k: v for k, v in speeds.items() if 1.0 / NEAR < v / critical < NEAR}
    rows = [_course(joint, order, amplitude, array(speed)) for speed in near.values()]
    torque, smallest, codes, linear = np.transpose(rows)
    return [*near], {
        "course_speed": np.array([*near.values()]),
        "course_torque": torque,
        "course_smallest_torque": smallest,
        "course_status": codes,
        "linear_torque": linear,
    }


def _course(joint: Joint, order: Array, amplitude: Array, speed: Array) -> tuple[float, ...]:
    """Amplitude and smallest torque, status, and the amplitude by the tangent."""
    linear = float(_linear(joint, order, amplitude, speed))
    periods = array(fading(joint, order, speed))
    course = jax.device_get(steady_joint_vibration(joint, order, amplitude, speed, periods))
    code = int(course.status.code)
    torque, smallest = (
        float(v) if Code(code).ok else np.nan for v in (course.torque, course.smallest)
    )
    return torque, smallest, float(code), linear


@program
def _linear(joint: Joint, order: Array, amplitude: Array, speed: Array) -> Array:
    return jnp.abs(joint_response(joint, order, amplitude, speed).torque)


def _light_motor(built: Built) -> list[str]:
    """A motor that is lighter than the member of the drive that it turns, which its inertia includes."""
    assert built.case.dynamics is not None and built.case.dynamics.inertia is not None
    if built.family.bodies is None:
        return []
    turned, motor = int(np.argmax(built.nominal["driver"])), built.case.dynamics.inertia[0]
    inertia = float(bodies_of(built, {}, silent)["body_inertia"].values[turned])
    if not motor < inertia:
        return []
    name, both = built.driver, [f"{1e4 * moment:.3g} kg cm2" for moment in (motor, inertia)]
    return [
        Doubt(
            f"Torsional vibration: the motor's moment of inertia counts with the {name} that it turns, and "
            f"{both[0]} is less than that of the {name} alone, {both[1]} by its dimensions; the natural "
            "frequency on a motor that runs free is too high.",
            moves=1.0 - motor / inertia,
            brief=f"Motor's inertia, {both[0]}, is below that of the {name}.",
        )
    ]


def _unloaded(
    built: Built, found: Mapping[str, np.ndarray], speeds: np.ndarray, waves: _Waves
) -> list[str]:
    """Where the torque swings by more than the load, so that a tangent says little."""
    swing = found["torque_amplitude"].max(axis=(0, 1))
    beyond = speeds[swing > built.case.operation.load]
    if not beyond.size:
        return []
    return [
        Doubt(
            f"Torsional vibration: flanks change sides at {beyond.size} of {speeds.size} speeds; the torque "
            "swings by more than the load there, which amplitudes by the tangent of the wind-up leave out.",
            moves=beyond.size / speeds.size,
            brief=f"Joint vibration lifts teeth at {beyond.size} of {speeds.size} speeds.",
        )
    ]


def _unsettled(names: Sequence[str], courses: Mapping[str, np.ndarray]) -> list[str]:
    """Why the whole curve gives no steady vibration, where it does not."""
    return [
        Doubt(
            f"Torsional vibration with the whole curve of the wind-up, at the {name}: "
            f"{Code(int(code)).sentence}.",
            brief=f"Torsional vibration by the whole curve: none at the {name}.",
        )
        for name, code in zip(names, courses["course_status"], strict=True)
        if not Code(int(code)).ok
    ]


def joint_of(built: Built, _: Piece, progress: PieceProgress) -> xr.Dataset:
    """Dataset of the part."""
    return joint_part(built, progress)


def joint_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Entries of `--json`."""
    data = parts.get("joint")
    if data is None:
        return {"joint": {}}
    names: Sequence[str] = (
        "natural_frequency",
        "joint_damping_ratio",
        "tangent_torsional_stiffness",
    )
    by_motor = {
        str(motor): {name: float(data[name][k]) for name in names}
        | {
            "critical_speed": numbers(data["critical_speed"].values[k]),
            "largest_torque_amplitude": numbers(data["torque_amplitude"].values[k].max(axis=-1)),
        }
        for k, motor in enumerate(data["motor"].values)
    }
    waves = {name: numbers(data[name].values) for name in ("wave_order", "wave_amplitude")}
    return {"joint": by_motor | waves | {"excitation": data["excitation"].values.tolist()}}
