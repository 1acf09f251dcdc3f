"""Stiffness of the mesh and the vibration it excites, as datasets of a case."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import equinox as eqx
import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.cases.built import Built
from pitchpoint.core.doubts import WITHHELD, Doubt
from pitchpoint.core.programs import program
from pitchpoint.core.status import DIRECT, Code, Status, solve_summary, status_summary
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.excitation import Excitation
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.pair_vibration import (
    Vibrating,
    excited,
    frequency_ratio,
    nominal_force,
    steady,
    transmission_figures,
)
from pitchpoint.dynamics.response import Response
from pitchpoint.dynamics.sweep import speed_sweep
from pitchpoint.dynamics.system import System
from pitchpoint.efficiency.quasi_static import Design, Operation
from pitchpoint.efficiency.summary import of_stacks, stacks
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.gears.rated_pair import bare_pair
from pitchpoint.loading.iso_6336_stiffness import estimate
from pitchpoint.loading.loading_registry import TOOTH_COMPLIANCE
from pitchpoint.loading.mesh_stiffness import MeshStiffness, mesh_stiffness
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.results.store import dataset

__all__ = [
    "figures_of",
    "resonance_part",
    "status_sentences",
    "stiffness_part",
    "vibrating_of",
    "vibration_part",
]

ORDERS = tuple(range(41))
"""Orders of the mesh frequency in spectra."""

MOST_RATIO = 1000.0
"""Natural over mesh frequency beyond which a period holds too many vibrations to be worth them."""

_AT_SPEED = "Vibration against speed: at {points} {sentence}."

_AT_PHASE = "Mesh stiffness: at {points} of the mesh cycle {sentence}."

TOGETHER = 4
"""Vibrations solved together: one compiled program serves any number of them."""

Input = tuple[Design, Operation, Vibrating]


def vibrating_of(built: Built) -> Vibrating:
    """Inertia, damping and profile error of a case; discs of the gears' materials by default."""
    dynamics, mesh = built.case.dynamics, built.design.mesh
    assert dynamics is not None
    if dynamics.inertia is None:
        densities = [float(solid.density) for solid in built.design.solids]
        inertia = _inertia(bare_pair(mesh), array(densities))
    else:
        inertia = array(dynamics.inertia)
    errors = dynamics.profile_error
    return Vibrating(
        inertia=inertia,
        damping_ratio=array(dynamics.damping_ratio),
        error=array([error.amplitude for error in errors]),
        error_phase=array([error.phase for error in errors]),
        backlash=array(np.inf if dynamics.backlash is None else dynamics.backlash),
        orders=tuple(int(error.order) for error in errors),
    )


_inertia = program(plain_inertia)


def teeth_may_part(built: Built) -> bool:
    """True if the case lets teeth part."""
    return not CONTACT_LAWS[built.case.models.tooth_contact].linear


def stiffness_part(built: Built, *_piece: object) -> xr.Dataset:
    """Stiffness of each pair and of the mesh over one period, with the estimate of ISO 6336.

    Where flanks have gaps only the springs that carry count.
    """
    stiffness, status = jax.device_get(_stiffness(built.design, built.operation, built.terms))
    lanes = ("pair", "node")
    data = {
        name: (lanes if np.ndim(values) == 2 else ("node",)[: np.ndim(values)], values)
        for name, values in stiffness.items()
    }
    standard, remarks = estimate(
        built.design.mesh, built.design.loaded, built.design.solids, built.operation.load
    )
    data |= {name: ((), value) for name, value in standard.items()}
    lost = [] if status is None else status_sentences(status.code, _AT_PHASE)
    return dataset(
        data,
        {},
        title="mesh stiffness",
        warnings=[*remarks, *lost],
        solve=DIRECT if status is None else status_summary(status),
        model=TOOTH_COMPLIANCE[built.case.models.tooth_compliance].title,
    )


@program
def _stiffness(
    design: Design, operation: Operation, terms: Terms
) -> tuple[dict[str, Array], Status | None]:
    """Values by name, and what became of the equilibrium behind them, if any."""
    mesh, load = design.mesh, operation.load
    stiffness = mesh_stiffness(mesh, design.loaded, design.solids, terms, load)
    contacts = mesh.contacts(stiffness.phase)
    length = jnp.sum(jnp.where(contacts.active, contacts.weight, 0.0), axis=1)
    entered = stiffness.phase + jnp.arange(stiffness.single.shape[0])[:, None, None]
    single, total = stiffness.along_action, stiffness.total
    error = stiffness.approach * jnp.abs(line_of_action(mesh) @ design.loaded)
    mean = jnp.sum(total * stiffness.weight)
    lanes = {"entered": entered, "pair_stiffness": single, "line_length": length}
    of_mesh = {
        "mean_stiffness": mean,
        "stiffness_variation": (jnp.max(total) - jnp.min(total)) / mean,
    }
    nodal = {"phase": stiffness.phase, "weight": stiffness.weight, "mesh_stiffness": total}
    nodal["static_transmission_error"] = error
    flat = {name: values.reshape(values.shape[0], -1) for name, values in lanes.items()}
    values = flat | {name: values.ravel() for name, values in nodal.items()} | of_mesh
    return values, None if stiffness.state is None else stiffness.state.status


def vibration_part(built: Built, *_piece: object) -> xr.Dataset:
    """Steady vibration at the operating speed for every torque of the case."""
    inputs = [(built.design, point, vibrating_of(built)) for point in _loads(built)]
    figures = _solved(inputs, built, _course)
    dims = {"dynamic_factor": ("torque", "pair", "node"), "spectrum": ("torque", "order")}
    nodal = ("transmission_error", "static_transmission_error", "mesh_dynamic_factor")
    data: dict[str, Any] = {"phase": (("node",), figures.pop("phase")[0])}
    for name, values in figures.items():
        axes = ("torque", "node") if name in nodal else ("torque",)
        data[name] = (dims.get(name, axes), values)
    statuses = [Code(int(code)) for code in figures["vibration_status"]]
    return dataset(
        data,
        {"torque": ("torque", _torques(built)), "order": ("order", np.array(ORDERS))},
        title="vibration",
        travels=built.travels,
        warnings=[*_warnings(built, statuses), *_moduli(built)],
        status=[status.sentence for status in statuses],
        solve=solve_summary(figures["vibration_status"].astype(int)),
        contact=CONTACT_LAWS[built.case.models.tooth_contact].title,
    )


def _course(stiffness: MeshStiffness, moved: System, found: Response) -> dict[str, Array]:
    factor = found.dynamic_factor(nominal_force(stiffness, moved))
    return {
        **transmission_figures(stiffness, moved, found),
        "phase": found.course.phase.ravel(),
        "transmission_error": found.transmission_error.ravel(),
        "static_transmission_error": found.static_transmission_error.ravel(),
        "dynamic_factor": factor.reshape(factor.shape[0], -1),
        "mesh_dynamic_factor": jnp.sum(factor, axis=0).ravel(),
        "spectrum": found.spectrum(found.transmission_error, ORDERS),
    }


def resonance_part(built: Built, *_piece: object) -> xr.Dataset:
    """Vibration against speed, speeds rising and falling, for every torque of the case."""
    assert built.case.dynamics is not None
    sweep = built.case.dynamics.speeds
    assert sweep is not None
    speeds = np.linspace(sweep.start, sweep.stop, int(sweep.count))
    slowest = replace(built.operation, speed=jnp.asarray(speeds[0]))
    points = [replace(slowest, load=load.load) for load in _loads(built)]
    vibrating = vibrating_of(built)
    parts = [
        (*_excited(built.design, point, built.terms, vibrating), vibrating.backlash)
        for point in points
    ]
    grid = _grid(parts, vibrating.orders, "dynamics.speeds.start")
    periods = built.design.period / jnp.asarray(speeds)
    runs = [
        [jax.device_get(_sweep(*part, order, grid, teeth_may_part(built))) for part in parts]
        for order in (periods, periods[::-1])
    ]
    dims = ("direction", "torque", "speed")
    data = {name: (dims, _by_speed(runs, name)) for name in runs[0][0]}
    return dataset(
        data,
        {"direction": ["rising", "falling"], "torque": _torques(built), "speed": speeds},
        title="vibration against speed",
        travels=built.travels,
        warnings=[*status_sentences(data["vibration_status"][1], _AT_SPEED), *_moduli(built)],
        sentences=[code.sentence for code in Code],
        solve=solve_summary(data["vibration_status"][1].astype(int)),
    )


def _by_speed(runs: Sequence[Sequence[dict[str, np.ndarray]]], name: str) -> np.ndarray:
    """Values [direction, torque, speed], the speeds of both directions in rising order."""
    rising, falling = (np.stack([point[name] for point in run]) for run in runs)
    return np.stack([rising, falling[:, ::-1]])


@program
def _sweep(
    stiffness: MeshStiffness,
    moved: System,
    driven: Excitation,
    backlash: Array,
    periods: Float[Array, " speed"],
    grid: PeriodGrid,
    parting: bool,
) -> dict[str, Array]:
    def figures(one: Response) -> dict[str, Array]:
        factors = one.dynamic_factor(nominal_force(stiffness, moved))
        return {
            "transmission_error_range": one.peak_to_peak(one.transmission_error),
            "largest_dynamic_factor": jnp.max(one.extremes(factors)[1]),
            "vibration_status": one.status.code,
        }

    def alone(period: Float[Array, ""]) -> dict[str, Array]:
        return figures(steady(replace(moved, period=period), driven, grid))

    by_speed: dict[str, Array]
    if parting:
        by_speed = eqx.filter_vmap(figures)(
            speed_sweep(moved, driven, periods, grid, backlash=backlash)
        )
    else:
        # A few at a time: the slowest speed needs a fine grid, and all would not fit into memory.
        by_speed = jax.lax.map(alone, periods, batch_size=4)
    return by_speed


def figures_of(points: Sequence[Built]) -> dict[str, np.ndarray]:
    """Figures of stiffness and vibration of many points of equal static structure."""
    inputs = [(point.design, point.operation, vibrating_of(point)) for point in points]
    return _solved(inputs, points[0], transmission_figures)


Reading = Callable[[MeshStiffness, System, Response], dict[str, Array]]
Excited = tuple[MeshStiffness, System, Excitation, Array]


def _solved(inputs: Sequence[Input], built: Built, reading: Reading) -> dict[str, np.ndarray]:
    """What is read from the steady vibration of every input, solved in chunks of one size."""
    terms = built.terms
    parts = [
        (*_excited(design, point, terms, vibrating), vibrating.backlash)
        for design, point, vibrating in inputs
    ]
    grid = _grid(parts, inputs[0][2].orders)
    parting = teeth_may_part(built)
    return of_stacks(
        (_read(part, grid, parting, reading), used) for part, used in stacks(parts, TOGETHER)
    )


@program
def _read(parts: Excited, grid: PeriodGrid, parting: bool, reading: Reading) -> dict[str, Array]:
    def one(
        stiffness: MeshStiffness, moved: System, driven: Excitation, backlash: Array
    ) -> dict[str, Array]:
        response = steady(moved, driven, grid, separating=parting, backlash=backlash)
        return reading(stiffness, moved, response)

    readings: dict[str, Array] = eqx.filter_vmap(one)(*parts)
    return readings


_excited = program(excited)
_ratio = program(frequency_ratio)


def _loads(built: Built) -> list[Operation]:
    return [replace(built.operation, load=jnp.asarray(load)) for load in _torques(built)]


def _torques(built: Built) -> list[float]:
    assert built.case.dynamics is not None
    dynamics = built.case.dynamics
    return list(dynamics.torques or dynamics.forces or (built.case.operation.load,))


def _grid(
    parts: Sequence[Excited], orders: Sequence[int], key: str = "operation.speed"
) -> PeriodGrid:
    """Grid for the highest of natural frequencies and profile errors, over their mesh frequency."""
    ratios = [float(_ratio(stiffness, moved)) for stiffness, moved, *_ in parts]
    lost = sum(np.isnan(stiffness.single).any() for stiffness, *_ in parts)
    if lost:
        raise ConvergenceError(
            f"no equilibrium of the teeth was found at {lost} of {len(parts)} points of the vibration, and "
            "without one there are no springs to vibrate on"
        )
    ratio = max(ratios)
    if not ratio <= MOST_RATIO:
        raise InputError(
            f"the natural frequency is {ratio:.3g} times the mesh frequency, and a vibration is resolved "
            f"up to {MOST_RATIO:g} times; so slow a mesh moves as the static transmission error says, "
            'which a run without [dynamics] and with load_sharing = "from_stiffness" gives',
            key=key,
        )
    return PeriodGrid.resolving(max(ratio, *orders, 0.0))


def _moduli(built: Built) -> list[str]:
    """Where moduli that depend on the operating point are used beside it."""
    dynamics = built.case.dynamics
    if built.case.models.tooth_temperature == "isothermal" or dynamics is None:
        return []
    if dynamics.speeds is None and set(_torques(built)) <= {built.case.operation.load}:
        return []
    return [
        Doubt(
            "The moduli are those at the operating point, for all torques and speeds of the vibration; a "
            "study or sweep warms the teeth at each of its points.",
            brief="The vibration has the moduli of the operating point at all torques.",
        )
    ]


def status_sentences(
    codes: np.ndarray, told: str = "Vibration at {points}: {sentence}."
) -> list[str]:
    """What the points of a study say whose vibration is not a steady one that is reached."""
    title = told.partition(":")[0].removesuffix(" at {points}")
    return [
        Doubt(
            told.format(
                points=f"{np.sum(codes == code)} of {codes.size} points", sentence=code.sentence
            ),
            moves=float(np.mean(codes == code)),
            brief=f"{title}: no sound result at {np.sum(codes == code)} of {codes.size} points.",
        )
        for code in Code
        if not code.ok and np.any(codes == code)
    ]


def _warnings(built: Built, statuses: Sequence[Code]) -> list[str]:
    return [
        Doubt(
            f"Vibration at {built.carried.show(float(f'{torque:.4g}'))}: {status.sentence}.",
            moves=WITHHELD,
            brief=f"Vibration: no sound result at {built.carried.show(float(f'{torque:.4g}'))}.",
        )
        for torque, status in zip(_torques(built), statuses, strict=True)
        if not status.ok
    ]
