"""Printed numbers against computed ones."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import xarray as xr

from pitchpoint import units
from pitchpoint.cases.quantities import shown
from pitchpoint.cases.reductions import PLAIN, REDUCTIONS
from pitchpoint.cases.schema import Target
from pitchpoint.errors import InputError
from pitchpoint.registry import nearest
from pitchpoint.results.variables import VARIABLES

__all__ = ["Row", "compare", "counts"]


OF_VIBRATION = ("mean_transmission_error", "transmission_error_range", "largest_dynamic_factor")
"""Variables whose numbers count only where the vibration is a steady one."""


@dataclass(frozen=True)
class Row:
    """One printed number, in the unit of the print, and what was computed for it.

    `bound` says whether the number is to be exceeded (">") or not reached ("<") instead of met.
    """

    quantity: str
    where: str
    printed: float
    computed: float | None
    unit: str
    tolerance: float
    kind: str
    verdict: str
    reason: str
    bound: str = ""

    @property
    def deviation(self) -> float | None:
        """Computed minus printed."""
        return None if self.computed is None else self.computed - self.printed

    def as_json(self) -> dict[str, Any]:
        """The row for machines."""
        return asdict(self)


def compare(
    targets: Sequence[Target], results: Mapping[str, xr.Dataset], name: str = ""
) -> list[Row]:
    """A row for every target.

    Args:
        targets: of the case.
        results: datasets by name of the part.
        name: of the file, for messages.

    Raises:
        InputError: a target that names no study, variable or law of the results.
    """
    rows = []
    for position, target in enumerate(targets):
        try:
            rows.append(_row(target, results))
        except InputError as error:
            key = ".".join(filter(None, (f"targets.{position}", error.key or "unit")))
            raise error.at(file=name, key=key) from None
    return rows


def counts(rows: Sequence[Row]) -> dict[str, Counter[str]]:
    """Verdicts counted for each kind of target, never summed over kinds."""
    kinds: dict[str, Counter[str]] = {}
    for row in rows:
        kinds.setdefault(row.kind, Counter())[row.verdict] += 1
    return kinds


def _row(target: Target, results: Mapping[str, xr.Dataset]) -> Row:
    computed = None if target.kind == "excluded" else _computed(target, results)
    return Row(
        quantity=target.quantity,
        where=target.where,
        printed=target.printed,
        computed=computed,
        unit=target.unit,
        tolerance=target.tolerance,
        kind=target.kind,
        verdict=_verdict(target, computed),
        reason=target.reason,
        bound={"above": "> ", "below": "< "}.get(target.expect, ""),
    )


def _verdict(target: Target, computed: float | None) -> str:
    if computed is None:
        return "excluded"
    beyond = {"above": computed - target.printed, "below": target.printed - computed}
    if target.expect in beyond:
        return "pass" if beyond[target.expect] > 0.0 else "miss"
    return "pass" if abs(computed - target.printed) <= target.tolerance else "miss"


def _computed(target: Target, results: Mapping[str, xr.Dataset]) -> float:
    part = f"study_{target.study}"
    if part not in results:
        raise InputError(f"there is no study '{target.study}'", key="study")
    data = results[part]
    if target.variable not in data:
        raise InputError(
            f"there is no quantity '{target.variable}'{nearest(target.variable, _names(data))}",
            key="variable",
        )
    values = data[target.variable].transpose("law", "point").values
    wanted = [int(position) for position in target.law]
    needed = 2 if target.reduce == "max_difference" else 1
    if max(wanted, default=-1) >= len(values) or len(wanted) < needed:
        raise InputError(
            f"{shown(wanted)} does not fit; this study has {len(values)} friction laws, counted "
            f"from 0, and {target.reduce} takes {needed}",
            key="law",
        )
    if target.variable in OF_VIBRATION and data["vibration_status"].values[wanted].any():
        return float(
            "nan"
        )  # a balance that is not reached, or that pulls on teeth, meets no target
    number = REDUCTIONS[target.reduce](values[wanted])
    variable = VARIABLES[target.variable]
    kind = "dimensionless" if target.reduce in PLAIN else variable.kind
    return float(units.convert(number, target.unit, kind)) if target.unit != "1" else number


def _names(data: xr.Dataset) -> dict[str, None]:
    return dict.fromkeys(str(name) for name in data.data_vars)
