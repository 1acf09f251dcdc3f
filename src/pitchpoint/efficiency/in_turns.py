"""Balances of mesh cycles whose friction comes from solved films, and what became of their turns."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import array, jax
from pitchpoint.efficiency.quasi_static import Cycle, Design, Engagement, Models, Operation
from pitchpoint.efficiency.rows import balance_in_rows
from pitchpoint.efficiency.solved import solved_cycle
from pitchpoint.errors import ConvergenceError
from pitchpoint.loading.balance import Balance
from pitchpoint.status import Code, Status

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
    asked = design, operation, models, known.nodes
    for before, found in _LAST:
        if all(one is other for one, other in zip(asked, before, strict=True)):
            return found
    found = _solved(design, operation, models, known, progress)
    _LAST.append((asked, found))
    return found


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
    found = in_turns(design, operation, models, known, progress)
    if found.lost:
        raise ConvergenceError(f"{models.law.title}: {found.lost}")
    return found.balance, found.warnings


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
    begin, known, solver = _begin(design, operation, models, known)
    cycle, _ = solved_cycle(design, operation, begin, solver, engaged=known, most=1)
    friction = np.asarray(cycle.state.balance.friction)
    return friction[None] if begin.held_rolling is None else np.stack([friction, _rolling(cycle)])


def _rolling(cycle: Cycle) -> NDArray[np.float64]:
    """Rolling resistance of each slice on each surface per length [N/m]."""
    whole, weight = (
        np.asarray(v) for v in (cycle.state.balance.rolling, cycle.state.contacts.weight)
    )
    found: NDArray[np.float64] = np.divide(whole, weight, np.zeros_like(whole), where=whole != 0.0)
    return found


def _begin(
    design: Design,
    operation: Operation,
    models: Models,
    known: Engagement,
    progress: Callable[[int], None] | None = None,
) -> tuple[Models, Engagement, Any]:
    from pitchpoint.lubrication.ehl.traction import FilmTraction

    films = models.law.films
    assert films is not None
    own = models.rolling.name != "none"
    given = films, design.lubricant, operation.temperature
    solver = FilmTraction(*given, rolling=not own, progress=progress)
    first, none = (array(np.full(known.share.shape, one)) for one in (FIRST, 0.0))
    begin = models.holding(first, None if own else none)
    return begin, replace(known, body=None), solver


def _solved(
    design: Design,
    operation: Operation,
    models: Models,
    known: Engagement,
    progress: Callable[[int], None] | None,
) -> InTurns:
    begin, known, solver = _begin(design, operation, models, known, progress)
    try:
        cycle, status = solved_cycle(design, operation, begin, solver, engaged=known)
    except ConvergenceError as error:
        cycle, _ = solved_cycle(design, operation, begin, solver, engaged=known, most=0)
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
    found: Balance = jax.tree.map(
        lambda leaf: np.full(leaf.shape, np.nan) if leaf.dtype.kind == "f" else np.asarray(leaf),
        jax.device_get(balance),
    )
    return found
