"""The motion in steady state by the corrected equations: friction against the sliding, energy balanced."""

from dataclasses import replace

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT
from pitchpoint.contact.contacts import total
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.modes import modes
from pitchpoint.dynamics.moving_bodies import Body, radial_bearings
from pitchpoint.dynamics.passage import passage, polynomial
from pitchpoint.dynamics.right_hand_side import MovingMesh, relaxation_time
from pitchpoint.dynamics.steady_motion import Motion, film, steady_motion
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import (
    FILM_THICKNESS,
    LAWS,
    ROLLING_RESISTANCE,
    FilmThickness,
)

__all__ = ["TorusSprings", "corrected", "steady_figures"]

LEAST, NODES = 16, 20
"""Elements of a mesh cycle, and nodes in each of them; more elements where the mesh is slow."""

INSTANTS = 600
"""Places of equal distance in a mesh cycle at which a course is kept."""

ORDERS = 160
"""Orders of the mesh frequency that are kept of a spectrum."""

CREEP = 1e-4
"""Sliding speed at which 76 % of the friction is reached [m/s]."""

_ELLIPSE = "hamrock_brewe_1983"
_ROLLING = {"ellipse": "wu_cheng_1991_strips", "line": "wu_cheng_1991"}
_FILM = {"ellipse": "hamrock_dowson_1977", "line": "dowson_higginson_1959"}

Each = Float[Array, ""]
Two = Float[Array, "2"]
Values = Float[np.ndarray, "..."]


class TorusSprings(eqx.Module):
    """What the bodies and their springs are; both gears are solid discs.

    Attributes:
        mass, inertia: of both gears [kg, kg m2].
        joint_mass: I_e of eq. 9 [kg].
        coefficients: of the stiffness of a pair of teeth, powers 1 to 4 of its path [N/m].
        mean: of the stiffness of the mesh [N/m].
        bearing: stiffness K_B of each gear [N/m].
        bearing_damping, mesh_damping: damping ratios.
        error: amplitude of the static transmission error, once in a mesh cycle [m].
        held: True if the speed of the pinion is held, else a constant torque drives it; static.
    """

    mass: Two
    inertia: Two
    joint_mass: Each
    coefficients: Float[Array, "4"]
    mean: Each
    bearing: Each
    bearing_damping: Each
    mesh_damping: Each
    error: Each
    held: bool = eqx.field(static=True)


def corrected(design: Design, operation: Operation, springs: TorusSprings) -> MovingMesh:
    """The gears as they move in six coordinates, with the pinion as driver.

    Contacts push and pull as in eq. 10. The stiffness of a pair follows its place, not time, and damping
    is in proportion to it. Ellipses are those of Hamrock and Brewe, whose closed form is within 1 % of Hertz
    and is quick enough for every step.

    Args:
        design: either pair.
        operation: torque on the gear, and temperature.
        springs: of the bodies.

    Source: Liu and Xiong, eqs. 9 to 22, with the signs of friction against the sliding and the error once in
    a mesh cycle.
    """
    models, design = _models(design), replace(design, elliptic=ELLIPTIC_CONTACT[_ELLIPSE])
    path_stiffness = polynomial([0.0, *np.asarray(springs.coefficients)])
    relaxed = relaxation_time(springs.mesh_damping, springs.joint_mass, springs.mean)
    return MovingMesh(
        design,
        operation,
        models,
        _bodies(operation, springs),
        knots=array([0.0]),
        phase=array(0.0),
        creep=array(CREEP),
        relaxation=relaxed,
        passage=passage(design, operation, models.compliance, path_stiffness),
        law=CONTACT_LAWS["linear"],
        error=ErrorOrders(springs.error[None], array([1.0]), array([0.0])),
    )


def _models(design: Design) -> Models:
    friction = tuple(law for law in LAWS if law.name == "xu_2007")
    rolling = ROLLING_RESISTANCE[_ROLLING[design.mesh.shape]]
    return Models(friction, array(0), {}, LOAD_SHARING["from_stiffness"], rolling)


def _bodies(operation: Operation, springs: TorusSprings) -> tuple[Body, Body]:
    stiffness = float(springs.bearing)
    damping = 2.0 * springs.bearing_damping * np.sqrt(springs.bearing * springs.mass)
    pinion_support, gear_support = (
        radial_bearings(mass, stiffness, brake)
        for mass, brake in zip(springs.mass.tolist(), damping.tolist(), strict=True)
    )
    pinion, gear = springs.inertia
    driver = Body(array(np.inf) if springs.held else pinion, support=pinion_support)
    return driver, Body(gear, operation.load[None], support=gear_support)


def steady_figures(
    design: Design, operation: Operation, springs: TorusSprings
) -> dict[str, Values]:
    """Numbers and courses of the motion in steady state by the end of their names.

    NaN where none is found, where it cannot be reached, and where the grid does not resolve it; the status
    says which. Where flanks pull the motion is that of linear contacts, of which the status tells too.

    Args:
        design: either pair.
        operation: one operating point.
        springs: of the bodies.
    """
    moving = corrected(design, operation, springs)
    speed = float(operation.speed)
    moved = steady_motion(moving, speed, _grid(moving, speed))
    law = FILM_THICKNESS[_FILM[design.mesh.shape]]
    figures = jax.device_get(_told(moving, moved, law))
    code = Code(int(moved.status.code))
    counts = code in (Code.SOLVED, Code.SEPARATES)
    shown = {
        name: value if counts else np.full_like(value, np.nan) for name, value in figures.items()
    }
    return {**shown, "steady_status": np.asarray(float(code))}


def _grid(moving: MovingMesh, speed: float) -> PeriodGrid:
    """Grid that resolves the highest natural frequency, and friction where it turns: twice as fine."""
    ratio = float(_highest(moving)) * float(moving.design.period) / speed
    return PeriodGrid(max(LEAST, PeriodGrid.resolving(2.0 * ratio).elements), NODES)


@program
def _highest(moving: MovingMesh) -> Each:
    """Highest natural frequency [Hz]."""
    return modes(moving).frequency[-1]


@program
def _told(moving: MovingMesh, moved: Motion, law: FilmThickness) -> dict[str, Array]:
    forces = moved.found
    error = forces.stretch[0, 0] + _parted(moving, forces.phase)
    friction = jnp.abs(total(forces.drawn))
    heat = forces.drawn * forces.slip
    put_in, now = moved.power_in, moved.instantaneous_efficiency
    films = jnp.nanmin(film(moving, moved, law), axis=1)
    pushed = forces.on_coordinates[2:].reshape(2, 2, *friction.shape)
    return {
        "steady_largest_error": jnp.max(error),
        "steady_least_error": jnp.min(error),
        "steady_friction": moved.mean(friction),
        "steady_efficiency": moved.efficiency,
        "steady_lowest_efficiency": jnp.min(now),
        "steady_highest_efficiency": jnp.max(now),
        "steady_friction_created": moved.mean(total(jnp.maximum(-heat, 0.0))) / put_in,
        "steady_energy_left": moved.energy.closure,
        "steady_reaction_left": jnp.max(jnp.abs(pushed[0] + pushed[1])) / jnp.max(forces.force),
        "steady_pulled": moved.mean(jnp.where(total(forces.force) < 0.0, 1.0, 0.0)),
        "steady_film": _film(moved, films),
        **_courses(moved, error, films),
    }


def _courses(
    moved: Motion, error: Float[Array, "element node"], films: Float[Array, "pair element node"]
) -> dict[str, Array]:
    """What goes over a mesh cycle, and orders of the mesh force; pair 0 is the older one."""
    forces = moved.found
    over_cycle = {
        "error": error,
        "gear_speed": jnp.abs(moved.rate[1]),
        "force_both": total(forces.force),
        "efficiency_course": moved.instantaneous_efficiency,
    }
    touches = jnp.any(forces.contacts.active, axis=1)
    carried = {"force": jnp.sum(forces.force, axis=1), "friction": jnp.sum(forces.drawn, axis=1)}
    shown = {name: jnp.where(touches, values, jnp.nan) for name, values in carried.items()}
    for name, values in {**shown, "film_course": films}.items():
        over_cycle |= {f"{name}_{pair}": values[lane] for pair, lane in _LANES.items()}
    places = jnp.arange(INSTANTS) / (INSTANTS - 1.0) * moved.bounds[-1]
    turned = moved.turned.ravel()
    courses = {
        f"steady_{name}": jnp.interp(places, turned, values.ravel())
        for name, values in over_cycle.items()
    }
    return {
        **courses,
        "steady_spectrum": moved.spectrum(over_cycle["force_both"], range(1, ORDERS + 1)),
    }


_LANES = {"0": 1, "1": 0}
"""Lane of the contacts by the number that the paper has for a pair."""


def _parted(moving: MovingMesh, phase: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Static transmission error [m]."""
    assert moving.error is not None
    return moving.error.at(phase)


def _film(moved: Motion, films: Float[Array, "pair element node"]) -> Float[Array, ""]:
    """Mean over time of the thinner film of both pairs of teeth, while they press [m]."""
    thinnest = jnp.nanmin(films, axis=0)
    presses = jnp.isfinite(thinnest)
    mean = moved.mean(jnp.where(presses, thinnest, 0.0))
    return mean / moved.mean(jnp.where(presses, 1.0, 0.0))
