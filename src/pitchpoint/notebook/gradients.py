"""Derivatives of the main figures by the keys of a case file."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import equinox as eqx
import numpy as np
from pydantic import BaseModel

from pitchpoint import units
from pitchpoint._jax import double_precision, jax
from pitchpoint.cases.built import Built
from pitchpoint.cases.document import leaves
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.gradients import Inputs, figure_gradient
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.registry import nearest
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.case import Case, CaseLike, as_case, written
from pitchpoint.runs.run import FrictionChoice, own_law

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

STEP = 1e-4
"""Step of differences of the design against a value; relative, absolute for values below a thousandth."""

_TABLES = ("gears", "materials", "lubricant", "roughness", "operation", "losses")
_LEAST = 1e-3

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
    """Derivatives of a main figure by every number of a case file on which it depends.

    Args:
        case: a `Case`, or what makes one, of one mesh.
        of: "mean_loss", "mean_efficiency", "mean_input_torque" or "torque_ripple".
        by: key or keys by which to differentiate, all by default; one of both gears alone is
            "gears.profile_shift.1", and "gears.profile_shift" has a row for each of them.
        law: friction law of the case that acts, the first one by default.
        variant: of the case, the first one by default.
        friction: laws of one's own, see `run`.

    Returns:
        By key `value` and its SI `unit`, and `derivative` by it in SI; `attrs` has `of`, its `value` and
        its `unit`. What follows from a number, such as a dedendum from an addendum or the modulus of
        plastic from the temperature, is taken along.

    Raises:
        InputError: no such figure or law, a drive of several meshes, or no derivative by a key of `by`.
        ConvergenceError: friction locks the mesh.

    By automatic differentiation of the mesh cycle in reverse; what a key does to the design, which is
    closed forms and built on the host, by central differences. A key has no row where any change makes
    gears of another form, such as the helix angle of a spur pair.
    """
    chosen = as_case(case) if variant is None else Case(case, variant=variant)
    base = chosen.held[0] if friction is None else own_law(chosen.held[0], friction)
    built = _one_mesh(base)
    models = _under(built, law)
    if of not in FIGURES:
        raise InputError(f"{shown(of)} has no derivatives here{nearest(of, FIGURES)}")
    names = [by] if isinstance(by, str) else by
    numbers = _asked(built, [chosen.key(name) for name in names])
    value, slopes = figure_gradient(built.design, built.operation, models, FIGURES[of])
    flat = [np.asarray(leaf) for leaf in jax.tree.leaves(slopes)]
    rows = {
        key: {"value": number, "unit": units.si_unit(kind) or "1", "derivative": derivative}
        for key, number, kind, derivative in _rows(base, built, numbers, flat, bool(by))
    }
    return _frame(rows, {"of": of, "value": value, "unit": VARIABLES[of].unit})


def _frame(rows: Mapping[str, Mapping[str, Any]], told: Mapping[str, Any]) -> "pd.DataFrame":
    import pandas as pd

    made = pd.DataFrame.from_dict(dict(rows), orient="index").rename_axis("key")
    made.attrs.update(told)
    return made


def _one_mesh(base: Variant) -> Built:
    built = base.built({})
    if built.numbers:
        told = "derivatives are those of one mesh; a stage in a file of its own has them"
        raise InputError(told, file=base.name)
    (mesh,) = built.meshes
    return mesh


def _under(built: Built, law: str | None) -> Models:
    named = dict(zip(built.law_names, built.models, strict=True))
    if law is not None and law not in named:
        raise InputError(f"{shown(law)} is no friction law of the case{nearest(law, named)}")
    return named[law] if law is not None else built.models[0]


def _asked(built: Built, keys: Sequence[str]) -> "list[Number]":
    """Numbers of a case, those of some keys; InputError for a key without one."""
    every = {one[0]: one for one in _numbers(built)}
    members = {key: [one for one in every if one in (key, f"{key}.1", f"{key}.2")] for key in keys}
    missing = [key for key, there in members.items() if not there]
    if missing:
        told = f"is no number of the case that varies{nearest(missing[0], every)}"
        raise InputError(told, key=missing[0])
    return [every[key] for key in dict.fromkeys(chain(*members.values())) or every]


def _rows(
    base: Variant, built: Built, numbers: "Sequence[Number]", slopes: Leaves, asked: bool
) -> Iterator[tuple[str, float, str, float]]:
    """Key, value, kind and derivative of every number that moves the design; InputError if one cannot."""
    here = _numbers_of(built)
    for key, value, kind, setting in numbers:
        moved = _moved(base, here, setting, value)
        if moved is None and asked:
            told = "has no derivative here: any change of it makes gears of another form, or none"
            raise InputError(told, key=key)
        if moved is not None and any(np.any(one) for one in moved):
            pairs = zip(slopes, moved, strict=True)
            yield key, value, kind, float(sum(np.sum(slope * step) for slope, step in pairs))


Setting = Callable[[float], tuple[str, Any]]
Number = tuple[str, float, str, Setting]


def _numbers(built: Built) -> Iterator[Number]:
    """Key, value, kind and what sets it, of the numbers of a case, those of two gears apart."""
    for table in _TABLES:
        held = getattr(built.case, table)
        plain = (
            held.model_dump()
            if isinstance(held, BaseModel)
            else {name: one.model_dump() for name, one in held.items()}
        )
        for key, value in leaves({table: plain}):
            quantity = _continuous(key)
            if quantity is not None and isinstance(value, float):
                yield key, value, quantity.kind, _alone(key)
            elif quantity is not None and isinstance(value, tuple):
                for k, one in enumerate(value):
                    yield f"{key}.{k + 1}", one, quantity.kind, _in_list(key, value, k)


def _continuous(key: str) -> Quantity | None:
    """What the number at a key is; None for counts and where there is none."""
    try:
        quantity = quantity_at(key)
    except InputError:
        return None
    return None if quantity is None or quantity.whole else quantity


def _alone(key: str) -> Setting:
    return lambda value: (key, written(key, value))


def _in_list(key: str, values: tuple[float, ...], position: int) -> Setting:
    def setting(value: float) -> tuple[str, Any]:
        return key, written(key, [*values[:position], value, *values[position + 1 :]])

    return setting


def _moved(base: Variant, here: Inputs, setting: Setting, value: float) -> Leaves | None:
    """Derivatives of the numbers of the design by a key; one-sided at the end of its range."""
    step = STEP * (abs(value) if abs(value) > _LEAST * STEP else 1.0)
    above, below = (_built_at(base, here, setting(value + way * step)) for way in (1.0, -1.0))
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
