"""Balances of mesh cycles whose friction comes from solved films, and what became of their turns."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import array, jax
from pitchpoint.core.status import Code, Status
from pitchpoint.efficiency.quasi_static import Cycle, Design, Engagement, Models, Operation
from pitchpoint.efficiency.rows import balance_in_rows
from pitchpoint.efficiency.solved import solved_cycle
from pitchpoint.errors import ConvergenceError
from pitchpoint.loading.balance import Balance

__all__ = ["InTurns", "balance_under", "first_turn", "in_turns"]

FIRST = 0.03
"""Coefficient of every contact before its film is known."""

KEPT = 8
"""Points that are kept: parts of a case ask for the same ones."""


@dataclass(frozen=True)
class InTurns:
    """Forces of a mesh cycle and the films that agree with them.

    Attributes:
        balance: at the nodes; NaN where the turns did not end well.
        status: of the turns.
        lost: why they did not end well, in one sentence without its stop; empty where they did.
        warnings: what to be wary of about the films, in sentences.
    """

    balance: Balance
    status: Status
    lost: str
    warnings: tuple[str, ...]


def in_turns(
    design: Design,
    operation: Operation,
    models: Models,
    known: Engagement,
    progress: Callable[[int], None] | None = None,
) -> InTurns:
    """Balance at the nodes of a cycle under a friction law that solves films.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: one operating point.
        models: laws; the one that acts has `films`.
        known: contacts and shares with their nodes.
        progress: told the number of films that are solved, of all turns.
    """
    inputs = design, operation, models, known.nodes
    for before, solution in _LAST:
        if all(value is earlier for value, earlier in zip(inputs, before, strict=True)):
            return solution
    solution = _solved(design, operation, models, known, progress)
    _LAST.append((inputs, solution))
    return solution


def balance_under(
    design: Design,
    operation: Operation,
    known: Engagement,
    models: Models,
    progress: Callable[[int], None] | None = None,
) -> tuple[Balance, tuple[str, ...]]:
    """Forces at the nodes, and what to be wary of about films that were solved for them.

    Arguments as in `in_turns`, under any friction law.

    Raises:
        ConvergenceError: films and forces did not agree.
    """
    if models.law.films is None:
        return balance_in_rows(design, operation, known, models), ()
    solution = in_turns(design, operation, models, known, progress)
    if solution.lost:
        raise ConvergenceError(f"{models.law.title}: {solution.lost}")
    return solution.balance, solution.warnings


_LAST: deque[tuple[tuple[object, ...], InTurns]] = deque(maxlen=KEPT)


def first_turn(
    design: Design, operation: Operation, models: Models, known: Engagement
) -> NDArray[np.float64]:
    """Friction of the films under the forces of a small friction.

    Arguments as in `in_turns`.

    Returns:
        Coefficients [pair, slice, node], and the rolling resistance on each surface [N/m] unless the case
        has a model of its own; along a first axis.

    Raises:
        ConvergenceError: a film was not solved.
    """
    begin, engagement, solver = _begin(design, operation, models, known)
    cycle, _ = solved_cycle(design, operation, begin, solver, engaged=engagement, most=1)
    friction = np.asarray(cycle.state.balance.friction)
    return friction[None] if begin.held_rolling is None else np.stack([friction, _rolling(cycle)])


def _rolling(cycle: Cycle) -> NDArray[np.float64]:
    """Rolling resistance of each slice on each surface per length [N/m]."""
    rolling, weight = (
        np.asarray(v) for v in (cycle.state.balance.rolling, cycle.state.contacts.weight)
    )
    per_length: NDArray[np.float64] = np.divide(
        rolling, weight, np.zeros_like(rolling), where=rolling != 0.0
    )
    return per_length


def _begin(
    design: Design,
    operation: Operation,
    models: Models,
    engagement: Engagement,
    progress: Callable[[int], None] | None = None,
) -> tuple[Models, Engagement, Any]:
    from pitchpoint.lubrication.ehl.traction import FilmTraction

    films = models.law.films
    assert films is not None
    has_rolling = models.rolling.name != "none"
    conditions = films, design.lubricant, operation.temperature
    solver = FilmTraction(*conditions, rolling=not has_rolling, progress=progress)
    friction, none = (array(np.full(engagement.share.shape, value)) for value in (FIRST, 0.0))
    begin = models.holding(friction, None if has_rolling else none)
    return begin, replace(engagement, body=None), solver


def _solved(
    design: Design,
    operation: Operation,
    models: Models,
    known: Engagement,
    progress: Callable[[int], None] | None,
) -> InTurns:
    begin, engagement, solver = _begin(design, operation, models, known, progress)
    try:
        cycle, status = solved_cycle(design, operation, begin, solver, engaged=engagement)
    except ConvergenceError as error:
        cycle, _ = solved_cycle(design, operation, begin, solver, engaged=engagement, most=0)
        return InTurns(_withheld(cycle.state.balance), _lost(Code.FILM_LOST), str(error), ())
    code = Code(int(status.code))
    balance: Balance = jax.device_get(cycle.state.balance)
    if code not in (Code.SOLVED, Code.LOCKED):
        return InTurns(_withheld(balance), status, _why(status), ())
    return InTurns(balance, status, "", solver.warnings)


def _lost(code: Code) -> Status:
    return Status(array(int(code)), array(np.nan), array(0))


def _why(status: Status) -> str:
    return (
        f"films and forces did not agree after {int(status.iterations)} turns: the coefficients still "
        f"changed by {float(status.residual):.2g} of the largest one"
    )


def _withheld(balance: Balance) -> Balance:
    """The same without its numbers."""
    blank: Balance = jax.tree.map(
        lambda leaf: np.full(leaf.shape, np.nan) if leaf.dtype.kind == "f" else np.asarray(leaf),
        jax.device_get(balance),
    )
    return blank
