"""A mesh cycle whose friction comes from a solver: a loop around coefficients that are held."""

from collections.abc import Callable
from typing import Any

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.factored import product_array
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, Status
from pitchpoint.efficiency.quasi_static import Cycle, Design, Engagement, Models, Operation, cycle
from pitchpoint.errors import InputError
from pitchpoint.lubrication.conditions import Conditions, demand_shape, law_arguments

__all__ = ["TOLERANCE", "Solver", "solved_cycle"]

TOLERANCE = 1e-6
"""Change of the coefficients between two turns, over the largest of them, at which they are found."""

Solver = Callable[..., np.ndarray]
"""Friction coefficients of contacts from conditions at them by name, all of them [contact].

Where rolling resistance is asked for it follows, on each surface [N/m of a line, N of an ellipse]; both are
then of shape (2, contact).
"""


def solved_cycle(
    design: Design,
    operation: Operation,
    models: Models,
    solver: Solver,
    *,
    engaged: Engagement | None = None,
    tolerance: float = TOLERANCE,
    most: int = 50,
) -> tuple[Cycle, Status]:
    """Mesh cycle under a friction law that is no formula, such as a solver of the film.

    The balance of forces and the solver take turns: the balance with the coefficients held, the solver
    at the conditions that follow, until they agree. Every turn runs the same program.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: one operating point.
        models: laws; the friction law among them gives the first coefficients. With `held_rolling`, the
            first rolling resistance, the solver is asked for that too.
        solver: plain Python, however slow. Its arguments are conditions by name, see
            `lubrication.conditions.UNITS`, as NumPy arrays over the contacts that carry [contact]; its
            result is what `Solver` says.
        engaged: contacts and shares, where they are known already.
        tolerance: largest change of a coefficient between two turns, over the largest coefficient; so of
            rolling resistances.
        most: turns.

    Returns:
        The cycle with the last coefficients, and what became of the loop: its turns, and the change in
        the last of them. Near the coefficient that locks the mesh the turns may not converge; where a
        balance is not found the loop ends with the code of that.

    Raises:
        InputError: the solver asks for what is no condition, or is none at these contacts; it returns
            what are no coefficients.

    Source: Tian et al. (2024), eq. 17: force and coefficient in turns until they agree.
    """
    wanted, _ = law_arguments(solver)
    demand_shape(solver, design.mesh.shape)
    mesh_cycle, at = _turn(design, operation, models, engaged, tuple(wanted))
    held, change, turns = _first(mesh_cycle, models), np.inf, 0
    balanced = int(at.pop("code"))
    while balanced == Code.SOLVED and tolerance < change and turns < most:
        held, before = _asked(solver, at, held), held
        models_held = models.holding(*map(array, held))
        mesh_cycle, at = _turn(design, operation, models_held, engaged, tuple(wanted))
        balanced, change, turns = int(at.pop("code")), _change(held, before), turns + 1
    if balanced == Code.SOLVED and change > tolerance:
        balanced = int(Code.NOT_CONVERGED)
    return mesh_cycle, Status(array(balanced), array(change), array(turns))


def _first(mesh_cycle: Cycle, models: Models) -> np.ndarray:
    """Coefficients, and rolling resistances where they are asked for, before the first turn [what, ...]."""
    coefficients = np.asarray(mesh_cycle.state.balance.friction)
    if models.held_rolling is None:
        return coefficients[None]
    return np.stack([coefficients, np.broadcast_to(models.held_rolling, coefficients.shape)])


def _change(held: np.ndarray, before: np.ndarray) -> float:
    """Largest change of coefficients or of rolling over the largest of each; zero where none is left."""
    largest, changed = (
        np.max(np.abs(values).reshape(len(held), -1), axis=-1) for values in (held, held - before)
    )
    return float(np.max(changed / np.where(largest > 0.0, largest, 1.0)))


def _asked(solver: Solver, at: dict[str, np.ndarray], before: np.ndarray) -> np.ndarray:
    """Coefficients and rolling resistances at the contacts that carry, if any; elsewhere as before."""
    carries = at.pop("carries")
    if not carries.any():
        return before
    values = {name: np.broadcast_to(value, carries.shape)[carries] for name, value in at.items()}
    answer = np.asarray(solver(**values), dtype=float)
    _demand(solver, answer, len(before), int(carries.sum()))
    held = before.copy()
    held[:, carries] = answer
    return held


def _demand(solver: Solver, answer: np.ndarray, asked: int, contacts: int) -> None:
    """InputError unless an answer is one coefficient of each contact, with so many things asked for."""
    shapes = ((), (contacts,)) if asked == 1 else ((asked, contacts),)
    fits = answer.shape in shapes and np.all(np.isfinite(answer))
    if not fits or np.any(np.atleast_2d(answer)[0] < 0.0):
        rolling = ", and its rolling resistance" if asked > 1 else ""
        raise InputError(
            f"the friction solver {getattr(solver, '__name__', 'given')} must return one coefficient for "
            f"each of {contacts} contacts, finite and not negative{rolling}"
        )


def _turn(
    design: Design,
    operation: Operation,
    models: Models,
    engaged: Engagement | None,
    wanted: tuple[str, ...],
) -> tuple[Cycle, dict[str, np.ndarray]]:
    """Cycle and the conditions in it that a solver asks for."""
    mesh_cycle, at = _cycle(design, operation, models, engaged, wanted)
    conditions: Any = jax.device_get(at)
    return mesh_cycle, conditions


@program
def _cycle(
    design: Design,
    operation: Operation,
    models: Models,
    engaged: Engagement | None,
    wanted: tuple[str, ...],
) -> tuple[Cycle, dict[str, Array]]:
    mesh_cycle = cycle(design, operation, models, engaged=engaged)
    at: Conditions = mesh_cycle.state.conditions
    carries = mesh_cycle.state.contacts.active & (mesh_cycle.state.balance.load > 0.0)
    conditions = {name: product_array(getattr(at, name)) for name in wanted}
    code = jnp.max(mesh_cycle.state.balance.status.code)
    return mesh_cycle, {"carries": carries, "code": code, **conditions}
