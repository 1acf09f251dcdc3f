"""Motion with the friction of the teeth in it: steady, against speed, and from a start, as datasets."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint import units
from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.main_figures import CAMPBELL, OF_COURSE
from pitchpoint.analyses.vibration import MOST_RATIO, ORDERS, status_sentences, vibrating_of
from pitchpoint.cases.built import Built
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import fast_program, program
from pitchpoint.core.status import Code, solve_summary
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.modes import Modes, along_action, mean_stiffness, modes
from pitchpoint.dynamics.moving_bodies import Body, Support, bearing_forces, motor, radial_bearings
from pitchpoint.dynamics.passage import passage, tabulated
from pitchpoint.dynamics.right_hand_side import MovingMesh
from pitchpoint.dynamics.steady_motion import Motion, film, periodic_motion
from pitchpoint.dynamics.system import modal_damping, reduced_mass
from pitchpoint.dynamics.transient import Transient, transient
from pitchpoint.dynamics.vibration_tables import MotionTable
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import FilmThickness
from pitchpoint.results.store import dataset

__all__ = [
    "against_speed_part",
    "joined",
    "motion_part",
    "moving_of",
    "next_speeds",
    "quasi_static",
    "start_up_part",
]

CREEP = 1e-3
"""Sliding at which friction is three quarters of itself, over the fastest one: its share of the loss is
the square."""

BESIDE = Doubt(
    "Motion with friction is that of the teeth alone: it leaves out the losses of [losses].",
    brief="Motion with friction is that of the teeth alone, without [losses].",
)

SLOWEST = 0.01
"""Speed over that of the operating point below which a start asks the friction law at this one."""

RETREAT = 0.01
"""Speed backwards over that of the operating point that is worth a word: gears swing at first."""

FEW = 4
"""Speeds of a piece, so that little is lost when a run is stopped."""

ACCOUNT = ("friction", "rolling", "damping")
"""Energies of a period that are lost; what bodies drag is the slope of a motor, and comes off its work."""


# ---- what moves


@lru_cache(maxsize=2)
def moving_of(built: Built) -> tuple[MovingMesh, Modes]:
    """Mesh and bodies of a case that asks for their motion, and their modes.

    Losses beside the teeth are left out. The damping along the line of action is that which gives the
    bodies on the mean mesh stiffness the damping ratio of the case, unless it has one by value.

    Args:
        built: the case.

    Raises:
        InputError: the table of the pair's stiffness cannot be.
    """
    motion, design = _asked(built), replace(built.design, drag=())
    curve = None
    if motion.pair_stiffness:
        curve = tabulated(motion.pair_path, motion.pair_stiffness)
    pair_passage = passage(design, built.operation, built.terms, curve)
    vibrating = vibrating_of(built)
    inertia = np.array(vibrating.inertia, float)
    if motion.prescribed_speed:
        inertia[_ends(built)[0]] = np.inf
    moving = MovingMesh(
        design=design,
        operation=built.operation,
        models=built.models[0],
        bodies=tuple(_bodies(built, inertia)),
        knots=array([0.0]),
        phase=array(0.0),
        creep=array(1.0),
        relaxation=array(0.0),
        passage=pair_passage,
        law=CONTACT_LAWS[built.case.models.tooth_contact],
        backlash=vibrating.backlash,
        error=ErrorOrders(
            vibrating.error, array([*map(float, vibrating.orders)]), vibrating.error_phase
        ),
    )
    damping, fastest = _mean(moving, vibrating.damping_ratio)
    if motion.mesh_damping is not None:
        damping = array(motion.mesh_damping)
    ready = replace(moving, mesh_damping=damping, creep=CREEP * fastest)
    return ready, jax.device_get(_modes(ready))


def _ends(built: Built) -> tuple[int, int]:
    """Numbers of the driver and of the loaded body."""
    return int(built.nominal["driver"].argmax()), int(built.nominal["loaded"].argmax())


def _asked(built: Built) -> MotionTable:
    assert built.case.dynamics is not None
    assert built.case.dynamics.motion is not None
    return built.case.dynamics.motion


@program
def _mean(moving: MovingMesh, ratio: Array) -> tuple[Array, Array]:
    """Damping along the line of action, and the fastest sliding for a unit speed."""
    assert moving.passage is not None
    mesh = moving.design.mesh
    stiffness, line = mean_stiffness(moving), line_of_action(mesh)
    mass = reduced_mass(jnp.stack([body.inertia for body in moving.bodies]), line)
    spring = along_action(stiffness, line)
    damping = modal_damping(mass[None, None], spring[None, None], ratio)[0, 0]
    contacts, _ = jax.vmap(moving.passage.at)(moving.passage.edges[:-1])
    sliding = jax.vmap(lambda one: contact_velocity(one.slip_arm, moving.design.motion))(contacts)
    fastest = jnp.max(jnp.where(contacts.active, jnp.abs(sliding), 0.0))
    return damping, fastest


@program
def _modes(moving: MovingMesh) -> Modes:
    return modes(moving)


def _bodies(built: Built, inertia: np.ndarray) -> Iterator[Body]:
    """Driver and loaded body with their torques, each on its bearings."""
    motion, nominal = _asked(built), built.nominal
    driver, loaded = _ends(built)
    for number, (moment, rate) in enumerate(zip(inertia, nominal["motion"], strict=True)):
        body = Body(array(moment))
        if number == loaded:
            body = Body(array(moment), array([-np.sign(rate) * built.case.operation.load]))
        if number == driver and motion.stall_torque is not None:
            assert motion.no_load_speed is not None
            body = motor(
                stall_torque=float(np.sign(rate)) * motion.stall_torque,
                no_load_speed=motion.no_load_speed,
                inertia=float(moment),
            )
        yield replace(body, support=_support(built, number))


def _support(built: Built, number: int) -> Support | None:
    """Bearings that yield along the line of action and across it, in the plane of the gears."""
    motion = _asked(built)
    if motion.bearing_stiffness is None or motion.mass is None:
        return None
    assert built.case.dynamics is not None
    stiffness, mass = motion.bearing_stiffness[number], motion.mass[number]
    damping = 2.0 * built.case.dynamics.damping_ratio * np.sqrt(stiffness * mass)
    if motion.bearing_damping is not None:
        damping = motion.bearing_damping[number]
    return replace(radial_bearings(mass, stiffness, float(damping)), ways=array(_ways(built)))


def _ways(built: Built) -> np.ndarray:
    """Unit vectors along the line of action and across it."""
    contacts = jax.device_get(_contacts(built.design))
    (pair, piece) = np.argwhere(contacts.active)[0]
    normal = contacts.direction[:2, pair, piece]
    x, y = normal / np.linalg.norm(normal)
    return np.array([[x, y, 0.0], [-y, x, 0.0]])


@program
def _contacts(design: Any) -> Any:
    return design.mesh.contacts(jnp.asarray(0.0))


def _grid(built: Built, own: Modes, slowest: float, key: str) -> PeriodGrid:
    """Grid for the highest natural frequency over the mesh frequency, and for the errors.

    Twice as fine as for a vibration: friction turns where a pair passes the pitch point.
    """
    assert built.case.dynamics is not None
    mesh_frequency = slowest / float(built.nominal["period"])
    ratio = float(own.frequency[-1]) / mesh_frequency
    if not ratio <= MOST_RATIO:
        raise InputError(
            f"the highest natural frequency is {ratio:.3g} times the mesh frequency, and a motion is "
            f"resolved up to {MOST_RATIO:g} times",
            key=key,
        )
    orders = [float(error.order) for error in built.case.dynamics.profile_error]
    return PeriodGrid.resolving(2.0 * max(ratio, *orders, 0.0))


# ---- steady motion


@fast_program
def _steady(
    moving: MovingMesh,
    speed: Float[Array, ""],
    start: Float[Array, " state"],
    law: FilmThickness,
    grid: PeriodGrid,
    cycles: int,
) -> dict[str, Array]:
    """Everything that is kept of a steady motion, by name."""
    scaled = replace(moving, creep=moving.creep * speed)
    motion = periodic_motion(scaled, speed, grid, cycles, start)
    figures = {"mean_input_torque": motion.power_in / speed}
    return {**_courses(scaled, motion, law), **_figures(scaled, motion, cycles), **figures}


def _courses(moving: MovingMesh, found: Motion, law: FilmThickness) -> dict[str, Array]:
    """Courses over the period: nodes in the last axis."""
    act = found.found
    force = jnp.maximum(act.force, 0.0)
    pressed = jnp.sum(force, axis=1)
    drawn = jnp.sum(act.friction * force, axis=1)
    lost = jnp.sum(act.lost, axis=1)
    thickness = jnp.nanmin(film(moving, found, law), axis=1)
    size = len(moving.design.mesh.coordinates)
    courses = {
        "turned": found.turned,
        "time": found.time,
        "transmission_error": found.transmission_error,
        "relative_speed": found.rate[:size] / found.mean(found.rate[:size])[:, None, None],
        "load": jnp.sum(act.force, axis=1),
        "friction": drawn / jnp.where(pressed > 0.0, pressed, jnp.nan),
        "friction_force": jnp.sum(act.drawn, axis=1),
        "pair_loss": lost,
        "film_thickness": thickness,
        "lambda_ratio": thickness / moving.design.roughness.composite_rq,
        "efficiency": found.instantaneous_efficiency,
        "bearing_force": found.bearing[size:],
    }
    nodes = found.turned.size
    return {name: values.reshape(*values.shape[:-2], nodes) for name, values in courses.items()}


def _figures(moving: MovingMesh, found: Motion, cycles: int) -> dict[str, Array]:
    """Figures of the whole period."""
    size = len(moving.design.mesh.coordinates)
    error, energy = found.transmission_error, found.energy
    force = jnp.sum(found.found.force, axis=(0, 1))
    # Together, so that the polynomials between the nodes are compiled once.
    low, high = found.grid.extremes(jnp.stack([error, force]))
    pairs = found.bearing[size:].reshape(-1, 2, *error.shape)
    bearing = jnp.sqrt(jnp.sum(pairs**2, axis=1))
    orders = range(ORDERS[-1] * cycles + 1)
    figures = {
        "mean_efficiency": found.efficiency,
        "mean_transmission_error": found.mean(error),
        "transmission_error_rms": found.rms(error),
        "transmission_error_range": high[0] - low[0],
        "largest_mesh_force": high[1],
        # Where teeth part a polynomial swings below the nothing that its nodes have.
        "smallest_mesh_force": jnp.where(jnp.min(force) < 0.0, low[1], jnp.maximum(low[1], 0.0)),
        "largest_bearing_force": jnp.max(bearing) if bearing.size else jnp.asarray(jnp.nan),
        "largest_multiplier": jnp.max(jnp.abs(found.multipliers)),
        "energy_closure": energy.closure,
        "vibration_status": found.status.code,
        "spectrum": found.spectrum(error, orders),
        "bearing_spectrum": found.spectrum(found.bearing[size:], orders).T,
        "state": found.state,
    }
    parts = {f"work_{name}": getattr(energy, name)[-1] for name in ACCOUNT}
    # Over a whole period, the hand-over at its end included, springs keep nothing of their energy.
    brought = {
        "mesh": -energy.pressed,
        "error": energy.error,
        "put_in": energy.put_in - energy.drag,
    }
    return figures | parts | {f"work_{name}": work[-1] for name, work in brought.items()}


def _order(built: Built) -> tuple[str, np.ndarray]:
    """Orders of the mesh frequency of a period that may hold several mesh cycles, from the mean on."""
    cycles = int(_asked(built).cycles)
    return "order", np.arange(ORDERS[-1] * cycles + 1) / cycles


def quasi_static(built: Built, speeds: Sequence[float] | np.ndarray) -> np.ndarray:
    """Mean efficiency of the teeth without vibration, pairs sharing as they yield, at driver speeds."""
    design = replace(built.design, drag=())
    models = replace(built.models[0], sharing=LOAD_SHARING["from_stiffness"])
    points = [(design, replace(built.operation, speed=array(speed))) for speed in speeds]
    figures = summarise(points, models)
    return np.where(figures["locked"], np.nan, figures["mean_efficiency"])


def motion_part(built: Built, *_piece: object) -> xr.Dataset:
    """Steady motion at the operating point."""
    moving, natural_modes = moving_of(built)
    motion, speed = _asked(built), built.case.operation.speed
    grid, cycles = _grid(built, natural_modes, speed, "operation.speed"), int(motion.cycles)
    start = jnp.full(2 * moving.mass.shape[0], jnp.nan)
    inputs = moving, array(speed), start, built.film, grid, cycles
    figures = jax.device_get(_steady(*inputs))
    figures.pop("state")
    data = {name: (_dims(name, values), values) for name, values in figures.items()}
    code = Code(int(figures["vibration_status"]))
    still = quasi_static(built, [speed])[0]
    return dataset(
        {
            **data,
            **_of_modes(natural_modes),
            "mesh_frequency": ((), speed / float(built.nominal["period"])),
            "quasi_static_efficiency": ((), still),
            "efficiency_difference": ((), still - float(figures["mean_efficiency"])),
            "mesh_damping": ((), float(moving.mesh_damping)),
        },
        {**_labels(built), **_mode_names(built, natural_modes), "order": _order(built)},
        title="motion with friction",
        travels=built.travels,
        warnings=[
            *_told(built, np.array([code]), "Motion with friction: {sentence}."),
            *_motor_words(built, float(figures["mean_input_torque"])),
        ],
        sentence=code.sentence,
        solve=solve_summary(np.array(int(code)), np.asarray(figures["energy_closure"])),
        law=built.laws[0].title,
        contact=CONTACT_LAWS[built.case.models.tooth_contact].title,
        film_law=built.case.models.film_thickness,
    )


def _labels(built: Built) -> dict[str, Any]:
    """Bodies that move, and their bearings where these yield."""
    names = [body.body for body in built.bodies]
    ways = [f"{name}, {direction}" for name in names for direction in WAYS]
    yields = _asked(built).bearing_stiffness is not None
    return {"body": names} | ({"bearing": ways} if yields else {})


WAYS = ("along the line of action", "across it")


def _of_modes(own: Modes) -> dict[str, Any]:
    """Natural frequencies and damping ratios of what vibrates."""
    vibrates = own.frequency > 0.0
    return {
        "natural_frequency": (("mode",), own.frequency[vibrates]),
        "modal_damping_ratio": (("mode",), own.damping[vibrates]),
    }


def _mode_names(built: Built, own: Modes) -> dict[str, list[str]]:
    """What yields in every mode that vibrates: where most of its elastic energy is."""
    places = ["teeth"]
    places += [
        f"bearings of {body.body} {direction}"
        for body in built.bodies
        for direction in (WAYS[0], ACROSS)
    ]
    return {"mode": [_mode_name(places, shares) for shares in own.share[own.frequency > 0.0]]}


def _mode_name(places: Sequence[str], share: np.ndarray) -> str:
    most = np.argsort(-share)[:2]
    parts = [f"{places[k]} {share[k]:.0%}" for k in most if share[k] >= WORTH]
    return " and ".join(parts).replace("%", " %") if len(parts) > 1 else places[most[0]]


ACROSS = "across the line of action"

WORTH = 0.2
"""Share of the elastic energy of a mode that is worth a word."""

_LANES = ("load", "friction", "friction_force", "pair_loss", "film_thickness", "lambda_ratio")
_BODY = {
    "relative_speed": ("body", "node"),
    "bearing_force": ("bearing", "node"),
    "spectrum": ("order",),
    "bearing_spectrum": ("bearing", "order"),
}


def _dims(name: str, values: np.ndarray) -> tuple[str, ...]:
    if name in _LANES:
        return "pair", "node"
    return _BODY.get(name, ("node",)[: np.ndim(values)])


def _told(built: Built, codes: np.ndarray, sentence: str) -> list[str]:
    """What a motion leaves out, and what became of it."""
    return [*status_sentences(codes, sentence), *([BESIDE] if built.case.losses else [])]


def _motor_words(built: Built, needed: float) -> list[str]:
    """What the motor of a case gives at the operating speed, beside what the mesh asks for."""
    motion, speed = _asked(built), built.case.operation.speed
    if motion.stall_torque is None or not np.isfinite(needed):
        return []
    assert motion.no_load_speed is not None
    offer = motion.stall_torque * (1.0 - speed / motion.no_load_speed)
    return [
        Doubt(
            f"Motion with friction: the motor gives {offer:.4g} N m at the operating speed and the mesh asks "
            f"for {needed:.4g} N m; a constant torque beside it holds the mean speed.",
            brief=f"Motion: the motor gives {offer:.4g} N m, the mesh asks for {needed:.4g} N m.",
        )
    ]


# ---- against speed


def next_speeds(built: Built, last: xr.Dataset, progress: Any) -> xr.Dataset | None:
    """Motions at the speeds after those of the last piece, each begun from its neighbour; None at the end."""
    done, course = int(last.attrs["done"]), _course_of_speeds(built)
    if done >= course[1].size:
        return None
    return _piece(built, done, last["state"].values, progress)


def against_speed_part(built: Built, _: object, progress: Any) -> xr.Dataset:
    """Motions at the first speeds of a march through them."""
    return _piece(built, 0, None, progress)


def _course_of_speeds(built: Built) -> tuple[np.ndarray, np.ndarray]:
    """Directions and speeds in turn: rising, and falling where flanks may part."""
    assert built.case.dynamics is not None
    sweep = built.case.dynamics.speeds
    assert sweep is not None
    rising = np.linspace(sweep.start, sweep.stop, int(sweep.count))
    both = not CONTACT_LAWS[built.case.models.tooth_contact].linear
    speeds = [rising, rising[::-1]] if both else [rising]
    return np.repeat(np.arange(len(speeds)), rising.size), np.concatenate(speeds)


KEPT = (
    "mean_efficiency",
    *OF_COURSE,
    "largest_multiplier",
    "vibration_status",
    "spectrum",
)
"""Figures against speed."""


def _piece(built: Built, done: int, state: np.ndarray | None, progress: Any) -> xr.Dataset:
    """Motions at a few speeds from one of them on."""
    moving, natural_modes = moving_of(built)
    _, speeds = _course_of_speeds(built)
    slowest, cycles = float(speeds.min()), int(_asked(built).cycles)
    grid = _grid(built, natural_modes, slowest, "dynamics.speeds.start")
    if state is None:
        state = np.full(2 * moving.mass.shape[0], np.nan)
    rows = []
    taken = range(done, min(done + FEW, speeds.size))
    for count, number in enumerate(taken, 1):
        inputs = moving, array(speeds[number]), array(state), built.film, grid, cycles
        figures = jax.device_get(_steady(*inputs))
        state = figures["state"]
        rows.append({name: figures[name] for name in KEPT})
        progress(count)
    data = {name: np.stack([row[name] for row in rows]) for name in KEPT}
    return dataset(
        {
            **{name: (("step", "order")[: values.ndim], values) for name, values in data.items()},
            "speed": (("step",), speeds[taken.start : taken.stop]),
            "state": (("coordinate",), state),
            **_of_modes(natural_modes),
        },
        {**_mode_names(built, natural_modes), "order": _order(built)},
        travels=built.travels,
        done=taken.stop,
        warnings=[],
    )


def joined(built: Built, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Figures [direction, speed] of all pieces, with the efficiency without vibration beside them."""
    directions, speeds = _course_of_speeds(built)
    count = np.count_nonzero(directions == 0)
    rising = speeds[:count]

    def both(name: str) -> np.ndarray:
        every = np.concatenate([part[name].values for part in parts])
        ways = [every[:count], every[count:][::-1]]
        return np.stack(ways[: directions[-1] + 1])

    dims = ("direction", "speed", "order")
    data = {name: both(name) for name in KEPT}
    codes, piece = data["vibration_status"], parts[0]
    critical = _critical(built, piece, rising)
    return dataset(
        {
            **{name: (dims[: values.ndim], values) for name, values in data.items()},
            "quasi_static_efficiency": (("speed",), quasi_static(built, rising)),
            **{name: (("mode",), piece[name].values) for name in OF_MODES},
            **{name: (("crossing",), values) for name, values in critical.items()},
        },
        {
            "direction": ["rising", "falling"][: directions[-1] + 1],
            "speed": ("speed", rising),
            "order": ("order", piece["order"].values),
            "mode": piece["mode"].values,
        },
        title="motion with friction against speed",
        travels=built.travels,
        warnings=[
            *_told(built, codes, "Motion with friction against speed: at {points} {sentence}."),
            *_coarse(rising, critical, piece, data["spectrum"]),
        ],
        sentences=[code.sentence for code in Code],
        solve=solve_summary(codes.astype(int)),
        law=built.laws[0].title,
    )


OF_MODES = ("natural_frequency", "modal_damping_ratio")

EXCITED = 0.1
"""Amplitude over the largest one of all orders from which the peaks of an order count."""


def _critical(built: Built, own: xr.Dataset, speeds: np.ndarray) -> dict[str, np.ndarray]:
    """Crossings of orders and natural frequencies between the speeds, by speed.

    At half power a peak is 2 xi n_c wide.
    """
    natural, ratio = (own[name].values for name in OF_MODES)
    orders = np.arange(1, CAMPBELL + 1)
    mode, order = (
        numbers.ravel() for numbers in np.meshgrid(range(natural.size), orders, indexing="ij")
    )
    speed = natural[mode] * float(built.nominal["period"]) / order
    inside = np.flatnonzero((speed >= speeds[0]) & (speed <= speeds[-1]))
    by_speed = inside[np.argsort(speed[inside])]
    crossings = {
        "critical_speed": speed,
        "critical_order": order.astype(float),
        "critical_mode": mode.astype(float),
        "half_power_width": 2.0 * ratio[mode] * speed,
    }
    return {name: values[by_speed] for name, values in crossings.items()}


def _coarse(
    speeds: np.ndarray, critical: dict[str, np.ndarray], own: xr.Dataset, spectrum: np.ndarray
) -> list[str]:
    """A sentence where peaks of excited orders may lie between the speeds."""
    amplitude = np.max(np.nan_to_num(spectrum), axis=(0, 1))
    heights = np.interp(critical["critical_order"], own["order"].values, amplitude)
    width = np.where(
        heights >= EXCITED * np.max(amplitude[1:]), critical["half_power_width"], np.inf
    )
    apart = float(np.max(np.diff(speeds), initial=0.0))
    if not width.size or not apart > width.min():
        return []
    peak = int(np.argmin(width))
    step, at, wide = (
        float(units.convert(value, "rpm", "rotational speed"))
        for value in (apart, critical["critical_speed"][peak], width[peak])
    )
    mode = own["mode"].values[int(critical["critical_mode"][peak])]
    return [
        Doubt(
            f"Motion with friction against speed: the speeds are {step:.4g} rpm apart, and the peak at "
            f"{at:.4g} rpm (order {critical['critical_order'][peak]:g}, {mode}) is {wide:.3g} rpm wide at "
            "half power, so that it may lie between them.",
            brief=f"Speeds {step:.4g} rpm apart may miss the peak at {at:.4g} rpm.",
        )
    ]


# ---- from a start


def start_up_part(built: Built, *_piece: object) -> xr.Dataset:
    """Motion from a start under a constant torque or that of a motor, the load rising."""
    start_up = _asked(built).start_up
    assert start_up is not None
    moving, _ = moving_of(built)
    times = np.linspace(0.0, start_up.duration, int(start_up.count))
    ready, rate = _started(built, moving)
    moved = transient(ready, times, rate=rate)
    lost = np.sum(np.asarray(moved.found.lost), axis=(0, 1))
    motion = jax.device_get(moved)
    size, rates = len(built.bodies), motion.rate
    line = np.asarray(line_of_action(ready.design.mesh))
    act, energy = motion.found, motion.energy
    code = _code_of_start(moving, motion)
    held = np.asarray(bearing_forces(ready.bodies, array(motion.place), array(rates)))[size:]
    pressed = np.sum(act.force, axis=1)
    borne = np.sqrt(np.sum(held.reshape(-1, 2, times.size) ** 2, axis=1))
    return dataset(
        {
            "time": (("time",), times),
            **_speeds(built, rates[:size]),
            "transmission_error": (("time",), line @ motion.place[:size]),
            "load": (("pair", "time"), pressed),
            "largest_mesh_force": ((), np.max(np.sum(pressed, axis=0))),
            "largest_bearing_force": ((), np.max(borne) if borne.size else np.nan),
            "friction_force": (("pair", "time"), np.sum(act.drawn, axis=1)),
            "loss": (("time",), lost),
            "bearing_force": (("bearing", "time"), held),
            **{f"work_{name}": (("time",), getattr(energy, name)) for name in ACCOUNT},
            "work_put_in": (("time",), energy.put_in - energy.drag),
            "kinetic_energy": (("time",), energy.kinetic),
            "energy_closure": ((), energy.closure),
            "vibration_status": ((), int(code)),
        },
        _labels(built),
        title="start",
        travels=built.travels,
        warnings=[
            *_told(built, np.array([code]), "Start: {sentence}."),
            *_backwards(built, rates[:size]),
        ],
        sentence=code.sentence,
        solve=solve_summary(np.array(int(code)), np.asarray(energy.closure)),
        law=built.laws[0].title,
    )


def _code_of_start(moving: MovingMesh, found: Transient) -> Code:
    """How a start ended; a linear contact that pulls is none that gears have."""
    code = Code(int(found.status.code))
    pulls = moving.law.linear and np.any(found.found.force < 0.0)
    return Code.SEPARATES if code.ok and pulls else code


def _backwards(built: Built, rates: np.ndarray) -> list[str]:
    """A sentence where the load drives what should drive."""
    driver, loaded = _ends(built)
    motion = built.nominal["motion"]
    if not np.any(rates[driver] * motion[driver] < -RETREAT * built.case.operation.speed):
        return []
    needed = built.case.operation.load * abs(motion[loaded])
    unit = "N" if "driver" in built.travels else "N m"
    return [
        Doubt(
            f"Start: the load turns the driver, {built.driver}, backwards; it asks for {needed:.4g} {unit} "
            "there without friction, and at rest nothing sticks.",
            brief=f"The load turns the driver back: {needed:.4g} {unit} hold it.",
        )
    ]


def _speeds(built: Built, rates: np.ndarray) -> dict[str, Any]:
    """Speeds of the bodies, without sign; over those of the operating point where some of them travel."""
    nominal = built.nominal["motion"][:, None]
    if built.travels:
        speed = built.case.operation.speed
        return {"relative_speed": (("body", "time"), rates / nominal / speed)}
    return {"body_speed": (("body", "time"), rates * np.sign(nominal))}


def _started(built: Built, moving: MovingMesh) -> tuple[MovingMesh, np.ndarray]:
    """What moves under the torques of the start, and the rates of all coordinates there."""
    start_up = _asked(built).start_up
    assert start_up is not None
    nominal = built.nominal
    driver, loaded = _ends(built)
    bodies = list(moving.bodies)
    if start_up.torque is not None:
        torque = array([float(np.sign(nominal["motion"][driver])) * start_up.torque])
        bodies[driver] = replace(bodies[driver], torque=torque)
    knots = array([0.0])
    if start_up.rise > 0.0:
        knots = array([0.0, start_up.rise])
        load = float(bodies[loaded].torque[0])
        bodies[loaded] = replace(bodies[loaded], torque=array([0.0, load]))
    speed = built.case.operation.speed
    ready = replace(
        moving,
        bodies=tuple(bodies),
        knots=knots,
        creep=moving.creep * speed,
        slowest=array(SLOWEST * speed),
    )
    still = np.zeros(moving.mass.shape[0] - len(bodies))
    return ready, np.concatenate([start_up.speed * nominal["motion"], still])
