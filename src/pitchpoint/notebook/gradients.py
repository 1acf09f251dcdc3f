"""Derivatives of the main figures by the keys of a case file."""

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import equinox as eqx
import numpy as np
from pydantic import BaseModel

from pitchpoint import units
from pitchpoint._jax import double_precision, jax
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.document import leaves
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.gradients import Inputs, figure_gradient
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.notebook.differences import (
    MADE,
    OTHER_FORM,
    STILL,
    CaseNumber,
    Differences,
    by_differences,
    continuous,
    numbers_of_file,
    setting_of,
)
from pitchpoint.registry import nearest
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.case import Case, CaseLike, as_case
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import FrictionChoice, with_user_law

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["gradients"]

FIGURES = {
    "mean_loss": "mean_loss",
    "mean_efficiency": "mean_efficiency",
    "mean_input_torque": "mean_input_torque",
    "torque_ripple": "ripple",
}
"""Names of figures in results, and those of the cycle."""

_TABLES = ("gears", "materials", "lubricant", "roughness", "operation", "losses")
_BESIDE = ("strength", "dynamics")

Leaves = list[np.ndarray]


@double_precision()
def gradients(
    case: CaseLike,
    of: str = "mean_loss",
    by: str | Sequence[str] = (),
    *,
    law: str | None = None,
    variant: str | None = None,
    friction: FrictionChoice | None = None,
) -> "pd.DataFrame":
    """Derivatives of a figure by every number of a case file on which it depends.

    Args:
        case: a `Case`, or what makes one.
        of: "mean_loss", or any figure of a `study`: "least_flank_safety", "largest_root_stress".
        by: key or keys by which to differentiate, all by default; one of both gears alone is
            "gears.profile_shift.1", and "gears.profile_shift" has a row for each of them.
        law: friction law of the case that acts, the first one by default.
        variant: of the case, the first one by default.
        friction: laws of one's own, see `run`.

    Returns:
        By key `value` and its SI `unit`, and `derivative` by it in SI; `attrs` has `of`, its `value` and
        its `unit`, and in `without` why other keys have no row. What follows from a number, such as a
        dedendum from an addendum or the modulus of plastic from the temperature, is taken along.

    Raises:
        InputError: no such figure or law, or no derivative by a key of `by`.
        ConvergenceError: friction locks the mesh.

    Of losses, efficiency, input torque and ripple of one mesh by automatic differentiation of the cycle in
    reverse; what a key does to the design, which is closed forms and built on the host, by central
    differences. Of other figures, and of drives of several meshes by the numbers that their file states, by
    differences of designs with two steps, which agree. A key has no row where any change makes gears of
    another form, such as the helix angle of a spur pair, and where a figure has a kink.
    """
    demand_arguments(of=of, by=by, law=law, variant=variant, friction=friction)
    chosen = as_case(case) if variant is None else Case(case, variant=variant)
    base = chosen.held[0] if friction is None else with_user_law(chosen.held[0], friction)
    built = base.built({})
    names = [chosen.key(name) for name in ([by] if isinstance(by, str) else by or ())]
    if built.numbers or of not in FIGURES:
        return _by_designs(base, built, of, names, law)
    (mesh,) = built.meshes
    models = _under(mesh, law)
    numbers = _asked([*_numbers(mesh, _TABLES)], names)
    value, slopes = figure_gradient(mesh.design, mesh.operation, models, FIGURES[of])
    flat = [np.asarray(leaf) for leaf in jax.tree.leaves(slopes)]
    without: dict[str, str] = {}
    derivatives = dict(_rows(base, mesh, numbers, flat, without))
    return _frame(numbers, Differences(value, VARIABLES[of].unit, derivatives, without), of, names)


def _by_designs(
    base: Variant, built: Ready, of: str, names: Sequence[str], law: str | None
) -> "pd.DataFrame":
    """The same of figures that have no derivatives of their own."""
    every = numbers_of_file(base)
    if not built.numbers:
        tables = [name for name in _BESIDE if getattr(built.case, name) is not None]
        every = _numbers(built.meshes[0], (*_TABLES, *tables))
    numbers = _asked([one for one in every if not any(part in one.key for part in MADE)], names)
    return _frame(numbers, by_differences(base, of, numbers, law), of, names)


def _frame(
    numbers: Sequence[CaseNumber], derived: Differences, of: str, names: Sequence[str]
) -> "pd.DataFrame":
    """The table; InputError where a key that is asked for has no derivative."""
    import pandas as pd

    for key, why in derived.without.items() if names else ():
        if why != STILL:
            raise InputError(why, key=key)
    rows = {
        one.key: {
            "value": one.value,
            "unit": units.si_unit(one.quantity.kind) or "1",
            "derivative": derived.by_key[one.key],
        }
        for one in numbers
        if one.key in derived.by_key
    }
    made = pd.DataFrame.from_dict(rows, orient="index").rename_axis("key")
    made.attrs.update(of=of, value=derived.value, unit=derived.unit, without={**derived.without})
    return made


def _under(built: Built, law: str | None) -> Models:
    named = dict(zip(built.law_names, built.models, strict=True))
    if law is not None and law not in named:
        raise InputError(f"{shown(law)} is no friction law of the case{nearest(law, named)}")
    return named[law] if law is not None else built.models[0]


def _asked(numbers: Sequence[CaseNumber], keys: Sequence[str]) -> list[CaseNumber]:
    """Numbers of a case, those of some keys; InputError for a key without one."""
    every = {one.key: one for one in numbers}
    members = {key: [one for one in every if one in (key, f"{key}.1", f"{key}.2")] for key in keys}
    missing = [key for key, there in members.items() if not there]
    if missing:
        told = f"is no number of the case that varies{nearest(missing[0], every)}"
        raise InputError(told, key=missing[0])
    return [every[key] for key in dict.fromkeys(chain(*members.values())) or every]


def _rows(
    base: Variant,
    built: Built,
    numbers: Sequence[CaseNumber],
    slopes: Leaves,
    without: dict[str, str],
) -> Iterator[tuple[str, float]]:
    """Key and derivative of every number that moves the design; sentences on the others."""
    here = _numbers_of(built)
    for one in numbers:
        moved = _moved(base, here, one)
        if moved is None:
            without[one.key] = OTHER_FORM
        elif not any(np.any(part) for part in moved):
            without[one.key] = STILL
        else:
            pairs = zip(slopes, moved, strict=True)
            yield one.key, float(sum(np.sum(slope * step) for slope, step in pairs))


def _numbers(built: Built, tables: Sequence[str]) -> Iterator[CaseNumber]:
    """Numbers of some tables of a case, usual ones too, those of two gears apart."""
    for table in tables:
        held = getattr(built.case, table)
        plain = (
            held.model_dump()
            if isinstance(held, BaseModel)
            else {name: one.model_dump() for name, one in held.items()}
        )
        for key, value in leaves({table: plain}):
            quantity = continuous(key)
            if quantity is not None and isinstance(value, float):
                yield CaseNumber(key, value, quantity, setting_of(key))
            elif quantity is not None and isinstance(value, tuple):
                for k, one in enumerate(value):
                    setting = setting_of(key, value, k)
                    yield CaseNumber(f"{key}.{k + 1}", one, quantity, setting)


def _moved(base: Variant, here: Inputs, number: CaseNumber) -> Leaves | None:
    """Derivatives of the numbers of the design by a key; one-sided at the end of its range."""
    step = number.step
    ways = (number.setting(number.value + way * step) for way in (1.0, -1.0))
    above, below = (_built_at(base, here, setting) for setting in ways)
    if above is None and below is None:
        return None
    own = _leaves(here)
    first, last = (own if below is None else below), (own if above is None else above)
    width = step * ((above is not None) + (below is not None))
    return [np.asarray((b - a) / width) for a, b in zip(first, last, strict=True)]


def _built_at(base: Variant, here: Inputs, setting: tuple[str, Any]) -> Leaves | None:
    """Numbers of the design with a key changed; None where it cannot be built, or is of another form."""
    try:
        (built,) = base.built(dict([setting])).meshes
    except InputError:
        return None
    found = _numbers_of(built)
    alike = bool(jax.tree.structure(found) == jax.tree.structure(here))  # type: ignore[operator]
    leaves, own = _leaves(found), _leaves(here)
    same = alike and [one.shape for one in leaves] == [one.shape for one in own]
    return leaves if same else None


def _numbers_of(built: Built) -> Inputs:
    """Continuous numbers of the design and the operating point, and the form that they are of."""
    numbers: Inputs = eqx.filter((built.design, built.operation), eqx.is_inexact_array)
    return numbers


def _leaves(numbers: Inputs) -> Leaves:
    """Numbers alone; what is not known stays where it is."""
    return [np.nan_to_num(np.asarray(leaf), nan=0.0) for leaf in jax.tree.leaves(numbers)]
