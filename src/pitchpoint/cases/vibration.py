"""Stiffness of the mesh and the vibration it excites, as datasets of a case."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import equinox as eqx
import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.build import Built, laws_of
from pitchpoint.dynamics.contact_law import CONTACT_LAWS
from pitchpoint.dynamics.grid import Grid
from pitchpoint.dynamics.response import Status
from pitchpoint.dynamics.steady_state import steady_state
from pitchpoint.dynamics.sweep import speed_sweep
from pitchpoint.dynamics.vibration import (
    Vibrating,
    excitation,
    frequency_ratio,
    system,
    transmission_figures,
    vibration,
)
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.efficiency.summary import in_chunks
from pitchpoint.loading.iso_6336_stiffness import estimate
from pitchpoint.loading.mesh_stiffness import mesh_stiffness
from pitchpoint.results.store import dataset

__all__ = ["figures_of", "resonance_part", "stiffness_part", "vibrating_of", "vibration_part"]

ORDERS = tuple(range(41))
"""Orders of the mesh frequency in spectra."""


def vibrating_of(built: Built) -> Vibrating:
    """Inertia, damping and profile error of a case; discs of the gears' materials by default."""
    asked, mesh = built.case.dynamics, built.design.mesh
    assert asked is not None
    if asked.inertia is None:
        inertia = mesh.inertia(jnp.stack([solid.density for solid in built.design.solids]))
        assert inertia is not None
    else:
        inertia = jnp.asarray(asked.inertia)
    errors = asked.profile_error
    return Vibrating(
        inertia=inertia,
        damping_ratio=jnp.asarray(asked.damping_ratio),
        error=jnp.asarray([error.amplitude for error in errors]),
        error_phase=jnp.asarray([error.phase for error in errors]),
        orders=tuple(int(error.order) for error in errors),
    )


def separating(built: Built) -> bool:
    """True if the case lets teeth part."""
    return not CONTACT_LAWS[built.case.models.tooth_contact].linear


def stiffness_part(built: Built) -> xr.Dataset:
    """Stiffness of each pair and of the mesh over one period, with the estimate of ISO 6336."""
    models, _ = laws_of(built)
    found = jax.device_get(_stiffness(built.design, built.operation, models))
    lanes = ("pair", "node")
    data = {
        name: (lanes if np.ndim(values) == 2 else ("node",)[: np.ndim(values)], values)
        for name, values in found.items()
    }
    standard, warnings = estimate(built.design.mesh, built.design.solids, built.operation.load)
    data |= {name: ((), value) for name, value in standard.items()}
    return dataset(
        data, {}, title="mesh stiffness", warnings=warnings, model=models.compliance.title
    )


@eqx.filter_jit
def _stiffness(design: Design, operation: Operation, models: Models) -> dict[str, Array]:
    mesh, load = design.mesh, operation.load
    found = mesh_stiffness(mesh, design.solids, models.compliance, load)
    contacts = mesh.contacts(found.phase)
    length = jnp.sum(jnp.where(contacts.active, contacts.weight, 0.0), axis=1)
    entered = found.phase + jnp.arange(found.single.shape[0])[:, None, None]
    total = found.total
    action = mesh.line_of_action
    assert action is not None
    lanes = {"entered": entered, "pair_stiffness": found.along_action, "line_length": length}
    mean = {
        "mean_stiffness": found.mean,
        "stiffness_variation": (jnp.max(total) - jnp.min(total)) / found.mean,
    }
    nodal = {"phase": found.phase, "weight": found.weight, "mesh_stiffness": total}
    nodal["static_transmission_error"] = load / jnp.abs(action @ mesh.loaded) / total
    flat = {name: values.reshape(values.shape[0], -1) for name, values in lanes.items()}
    return flat | {name: values.ravel() for name, values in nodal.items()} | mean


def vibration_part(built: Built) -> xr.Dataset:
    """Steady vibration at the operating speed for every torque of the case."""
    points = _loads(built)
    models, vibrating = laws_of(built)[0], vibrating_of(built)
    grid = _grid([(built.design, point) for point in points], models, vibrating)
    parts = [
        jax.device_get(_course(built.design, point, models, vibrating, grid, separating(built)))
        for point in points
    ]
    dims = {"dynamic_factor": ("torque", "pair", "node"), "spectrum": ("torque", "order")}
    nodal = ("transmission_error", "static_transmission_error")
    data: dict[str, Any] = {"phase": (("node",), parts[0]["phase"])}
    for name in parts[0]:
        if name != "phase":
            own = ("torque", "node") if name in nodal else ("torque",)
            data[name] = (dims.get(name, own), np.stack([part[name] for part in parts]))
    told = [Status(int(part["vibration_status"])) for part in parts]
    return dataset(
        data,
        {"torque": ("torque", _torques(built)), "order": ("order", np.array(ORDERS))},
        title="vibration",
        warnings=_warnings(built, told),
        status=[status.sentence for status in told],
        contact=CONTACT_LAWS[built.case.models.tooth_contact].title,
    )


@eqx.filter_jit
def _course(
    design: Design,
    operation: Operation,
    models: Models,
    vibrating: Vibrating,
    grid: Grid,
    parting: bool,
) -> dict[str, Array]:
    stiffness, moved, found = vibration(
        design, operation, models, vibrating, grid, separating=parting
    )
    figures = transmission_figures(stiffness, moved, found)
    factor = found.dynamic_factor(moved.load[0] / jnp.max(jnp.abs(stiffness.arm)))
    return {
        **figures,
        "phase": found.course.phase.ravel(),
        "transmission_error": found.transmission_error.ravel(),
        "static_transmission_error": found.static_transmission_error.ravel(),
        "dynamic_factor": factor.reshape(factor.shape[0], -1),
        "spectrum": found.spectrum(found.transmission_error, ORDERS),
    }


def resonance_part(built: Built) -> xr.Dataset:
    """Vibration against speed, speeds rising and falling, for every torque of the case."""
    assert built.case.dynamics is not None
    asked = built.case.dynamics.speeds
    assert asked is not None
    speeds = np.linspace(asked.start, asked.stop, int(asked.count))
    models, vibrating = laws_of(built)[0], vibrating_of(built)
    points = [replace(point, speed=jnp.asarray(speeds[0])) for point in _loads(built)]
    grid = _grid([(built.design, point) for point in points], models, vibrating)
    runs = [
        [
            jax.device_get(
                _sweep(built.design, point, models, vibrating, order, grid, separating(built))
            )
            for point in points
        ]
        for order in (jnp.asarray(speeds), jnp.asarray(speeds[::-1]))
    ]
    dims = ("direction", "torque", "speed")
    data = {name: (dims, _by_speed(runs, name)) for name in runs[0][0]}
    return dataset(
        data,
        {"direction": ["rising", "falling"], "torque": _torques(built), "speed": speeds},
        title="vibration against speed",
        warnings=[],
        sentences=[status.sentence for status in Status],
    )


def _by_speed(runs: Sequence[Sequence[dict[str, np.ndarray]]], name: str) -> np.ndarray:
    """Values [direction, torque, speed], the speeds of both directions in rising order."""
    rising, falling = (np.stack([point[name] for point in run]) for run in runs)
    return np.stack([rising, falling[:, ::-1]])


@eqx.filter_jit
def _sweep(
    design: Design,
    operation: Operation,
    models: Models,
    vibrating: Vibrating,
    speeds: Float[Array, " speed"],
    grid: Grid,
    parting: bool,
) -> dict[str, Array]:
    stiffness = mesh_stiffness(design.mesh, design.solids, models.compliance, operation.load)
    moved = system(design.mesh, vibrating, stiffness.mean, operation)
    excited, periods = excitation(stiffness, vibrating), design.mesh.period / speeds
    if parting:
        found = speed_sweep(moved, excited, periods, grid)
    else:
        at = eqx.filter_vmap(
            lambda period: steady_state(replace(moved, period=period), excited, grid)
        )
        found = at(periods)
    nominal = moved.load[0] / jnp.max(jnp.abs(stiffness.arm))

    def figures(one: Any) -> dict[str, Array]:
        error = one.transmission_error
        return {
            "transmission_error_range": one.peak_to_peak(error),
            "largest_dynamic_factor": jnp.max(one.extremes(one.dynamic_factor(nominal))[1]),
            "vibration_status": one.status,
        }

    result: dict[str, Array] = eqx.filter_vmap(figures)(found)
    return result


def figures_of(points: Sequence[Built]) -> dict[str, np.ndarray]:
    """Figures of stiffness and vibration of many points of equal static structure."""
    models = laws_of(points[0])[0]
    parting = separating(points[0])
    inputs = [(point.design, point.operation, vibrating_of(point)) for point in points]
    ratios = in_chunks(_ratios, inputs, models)["frequency_ratio"]
    grid = Grid.resolving(float(np.nanmax(ratios)))
    return in_chunks(partial(_figures, grid=grid, parting=parting), inputs, models)


@eqx.filter_jit
def _ratios(inputs: tuple[Design, Operation, Vibrating], models: Models) -> dict[str, Array]:
    ratio = eqx.filter_vmap(lambda d, o, v: frequency_ratio(d, o, models, v))(*inputs)
    return {"frequency_ratio": ratio}


@eqx.filter_jit
def _figures(
    inputs: tuple[Design, Operation, Vibrating], models: Models, grid: Grid, parting: bool
) -> dict[str, Array]:
    def each(design: Design, operation: Operation, vibrating: Vibrating) -> dict[str, Array]:
        return transmission_figures(
            *vibration(design, operation, models, vibrating, grid, separating=parting)
        )

    figures: dict[str, Array] = eqx.filter_vmap(each)(*inputs)
    return figures


def _loads(built: Built) -> list[Operation]:
    return [replace(built.operation, load=jnp.asarray(load)) for load in _torques(built)]


def _torques(built: Built) -> list[float]:
    assert built.case.dynamics is not None
    return list(built.case.dynamics.torques or (built.case.operation.torque,))


def _grid(points: Sequence[tuple[Design, Operation]], models: Models, vibrating: Vibrating) -> Grid:
    return Grid.resolving(
        max(float(_ratio(design, point, models, vibrating)) for design, point in points)
    )


_ratio = eqx.filter_jit(frequency_ratio)


def _warnings(built: Built, statuses: Sequence[Status]) -> list[str]:
    return [
        f"Vibration at {torque:.4g} N m: {status.sentence}."
        for torque, status in zip(_torques(built), statuses, strict=True)
        if not status.ok
    ]
