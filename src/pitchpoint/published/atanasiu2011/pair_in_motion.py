"""What Atanasiu et al. (2011) draw while a pair of teeth is in mesh: Figs. 4 to 7."""

from dataclasses import replace

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.dynamics.excitation import Excitation
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.pair_vibration import (
    excited,
    frequency_ratio,
    nominal_force,
    steady,
    transmission_figures,
)
from pitchpoint.dynamics.system import System
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.loading.mesh_stiffness import MeshStiffness, mesh_stiffness
from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.publication import ReadingPoint

__all__ = ["PROCEDURES", "readings"]

PROCEDURES = ("integrated", "middle")
"""Both ways to the stiffness of a contact line, text after eq. 20."""

TOGETHER = 3
"""Pairs of teeth that figures tell apart, I to III."""

_EVERY = 3
"""Nodes of an element of the grid of which one is kept, beside its ends."""

_MOST_RATIO = 1000.0
"""Natural over mesh frequency up to which a period is resolved."""

Course = Float[np.ndarray, " place"]
Excited = tuple[MeshStiffness, System, Excitation]


def readings(point: ReadingPoint) -> dict[str, float | Course]:
    """Courses from the entry of a pair into mesh to its exit, over meshing time in base pitches.

    They are those of the line stiffness that the case chooses; numbers are those of both.

    Args:
        point: a cylindrical pair with [dynamics].

    Raises:
        InputError: without [dynamics], or a pair too slow to be resolved.
    """
    formulas = point.formulas
    assert isinstance(formulas, PairInMotion)
    parts = _parts(point, formulas)
    grid = _grid(parts)
    stacked = jax.tree.map(lambda *leaves: jnp.stack(leaves), *parts)
    vibrations = jax.device_get(_moved(stacked, grid))
    drawn = 2 * int(point.models[0].compliance.middle)
    courses = {name: values[drawn] for name, values in vibrations.items()}
    read = _courses(courses | {"other_error": vibrations["error"][drawn + 1]})
    for number, name in enumerate(PROCEDURES):
        at_first, at_second = (
            {k: v[2 * number + k2] for k, v in vibrations.items()} for k2 in (0, 1)
        )
        read |= {f"{label}_{name}": float(at_first[key]) for label, key in _NUMBERS.items()}
        read[f"other_error_range_{name}"] = float(at_second["transmission_error_range"])
        read[f"pair_status_{name}"] = float(
            max(figures["vibration_status"] for figures in (at_first, at_second))
        )
    return read | {
        f"line_stiffness_difference_{name}": _difference(point, common=name == "common")
        for name in ("common", "separate")
    }


def _difference(point: ReadingPoint, *, common: bool) -> float:
    """Largest difference of the stiffness by both procedures, over the mean."""
    terms = replace(point.models[0].compliance, common=array(common))
    pair = point.design.mesh, point.design.loaded, point.design.solids
    line, middle = (
        jax.device_get(
            _stiffness(*pair, replace(terms, middle=array(of_middle)), point.operation.load)
        )
        for of_middle in (False, True)
    )
    return float(np.max(np.abs(middle.total - line.total)) / line.mean)


_NUMBERS = {
    "pair_mean_stiffness": "mean_stiffness",
    "pair_stiffness_variation": "stiffness_variation",
    "pair_mean_error": "mean_transmission_error",
    "pair_error_range": "transmission_error_range",
    "pair_largest_factor": "largest_dynamic_factor",
}


def _parts(point: ReadingPoint, formulas: PairInMotion) -> list[Excited]:
    """Springs and masses for both line stiffnesses, each at both torques."""
    mesh = point.design.mesh
    assert isinstance(mesh, CylindricalPair)
    if point.vibrating is None:
        sentence = "a pair in motion vibrates; give its damping ratio in [dynamics]"
        raise InputError(sentence, key="dynamics")
    vibrating, terms = point.vibrating(), point.models[0].compliance
    input_teeth, output_teeth = np.abs(np.asarray(mesh.teeth))
    return [
        _excited(
            point.design,
            replace(point.operation, load=array(torque * output_teeth / input_teeth)),
            replace(terms, middle=array(name == "middle")),
            vibrating,
        )
        for name in PROCEDURES
        for torque in formulas.input_torques
    ]


_excited = program(excited)
_stiffness = program(mesh_stiffness)
_ratio = program(frequency_ratio)


def _grid(parts: list[Excited]) -> PeriodGrid:
    ratio = max(float(_ratio(stiffness, moved)) for stiffness, moved, _ in parts)
    if not ratio <= _MOST_RATIO:
        sentence = (
            f"the natural frequency is {ratio:.3g} times the mesh frequency; courses of a pair in motion "
            f"are resolved up to {_MOST_RATIO:g} times"
        )
        raise InputError(sentence, key="operation.speed")
    return PeriodGrid.resolving(ratio)


@program
def _moved(parts: Excited, grid: PeriodGrid) -> dict[str, Float[Array, "..."]]:
    """Steady vibration of each part: figures, and courses at kept nodes of one period."""
    nodes = np.append(np.arange(0, grid.nodes - 1, _EVERY), grid.nodes - 1)

    def one(stiffness: MeshStiffness, moved: System, driven: Excitation) -> dict[str, Array]:
        response = steady(moved, driven, grid)
        nominal = nominal_force(stiffness, moved)
        # Along the line of action a spring counts with the square of its arm.
        springs = response.course.stiffness * response.course.arm[0] ** 2

        def of(values: Float[Array, "*b element node"]) -> Float[Array, "*b kept"]:
            return values[..., nodes].reshape(*values.shape[:-2], -1)

        factor = of(response.dynamic_factor(nominal))
        count = jnp.arange(factor.shape[0])[:, None]
        return {
            **transmission_figures(stiffness, moved, response),
            "entered": of(response.course.phase) + count,
            "stiffness": of(springs),
            "total_stiffness": of(jnp.sum(springs, axis=0)),
            "factor": factor,
            "load": factor * nominal,
            "error": of(response.transmission_error),
        }

    figures: dict[str, Array] = eqx.filter_vmap(one)(*parts)
    return figures


def _courses(figures: dict[str, np.ndarray]) -> dict[str, float | Course]:
    """Courses over the time since the pair entered, of one torque."""
    entered = figures["entered"]
    every = {
        "pair_time": entered.ravel(),
        **{
            f"pair_{name}": np.tile(figures[name], len(entered))
            for name in ("total_stiffness", "error", "other_error")
        },
    }
    period = entered.shape[1]
    for name in ("stiffness", "factor", "load"):
        course = figures[name].ravel()
        for number in range(TOGETHER):
            later = np.full_like(course, np.nan)
            late = number * period
            later[late:] = course[: max(len(course) - late, 0)]
            every[f"pair_{name}_{number + 1}"] = later
    return {name: _cut(values, figures["stiffness"]) for name, values in every.items()}


def _cut(values: Course, stiffness: np.ndarray) -> Float[np.ndarray, " kept"]:
    """Values until the pair leaves the mesh."""
    (carries,) = np.nonzero(stiffness.ravel() > 0.0)
    return values[: carries[-1] + 1]
