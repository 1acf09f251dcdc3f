"""Results by the names under which users see them: of many designs at once, or of a run of each."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float

from pitchpoint.analyses.analysis import Analysis
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.built_drive import Ready
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest, similar_names
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import VARIABLES, variable_of
from pitchpoint.runs.run import Outcome

__all__ = ["NO_FIGURES", "SoughtFigure", "value_in", "values_of_study"]

NO_FIGURES = ("residual", "iterations", "locked", "turns", "turns_change", "meeting_error")
"""What a study has beside results: how its solves ended."""

_EXTREMES = ("least_", "largest_")
"""What names of a study begin with that a run has of each gear."""

_WHICH = (
    "results are those of a study, mean_loss say, main figures of a run, and what its parts have, with the "
    "name of the part before it: torsion.slope_stiffness"
)

_MASS = {"reflected": "drive_mass", "bodies": "body_mass", "inspection": "disc_mass"}
"""Where the mass of all bodies stands, by part: their sum."""

_OF_RUN = {"output_backlash": "reflected"}
"""Parts of a run that have what many designs have at once, beside operation and strength."""

_AS_GIVEN = "nominal"
"""Case, of those between tolerances, of which many designs have figures."""


@dataclass(frozen=True)
class SoughtFigure:
    """A result that is one number for each design.

    Attributes:
        name: as it was asked for.
        variable: its name in a dataset.
        part: of a run that has it; empty where many designs have it at once.
        place: of one of several values, a gear or a stage; empty where there is one.
        quantity: its words and units.
    """

    name: str
    variable: str
    part: str
    place: str
    quantity: Variable

    @classmethod
    def named(cls, name: str, study: xr.Dataset, built: Ready) -> "SoughtFigure":
        """The result of a name: `mean_loss`, `disc_mass.1` of gear 1, `back_driving.mean_efficiency`.

        Args:
            name: of the result.
            study: figures of the case as many designs have them.
            built: the case.

        Raises:
            InputError: there is no such result, or the case lacks its part, with the reason.
        """
        words = [word.strip() for word in name.strip().split(".")]
        part = words.pop(0) if len(words) > 1 and words[0] in dict(ANALYSES) else ""
        variable, place = words[0], ".".join(words[1:])
        if not part:
            for at_once in (variable, *(f"{which}{variable}" for which in _EXTREMES if not place)):
                is_figure = at_once in study and at_once not in NO_FIGURES
                if is_figure and study[at_once].dtype.kind == "f":
                    return cls(name, at_once, "", place, variable_of(study, at_once))
        part, variable = _part_with(
            part, variable, built, [str(key) for key in study if key not in NO_FIGURES]
        )
        return cls(name, variable, part, place, VARIABLES[variable])

    @property
    def part_of_run(self) -> str:
        """Part of a run that has it; empty for operation and strength."""
        return self.part or _OF_RUN.get(self.variable, "")

    @property
    def unit(self) -> str:
        """Unit in which it is shown, as it stands behind a number."""
        return "" if self.quantity.display == "1" else f" {self.quantity.display}"

    def told(self, value: float) -> str:
        """A value in the unit in which it is shown."""
        return f"{self.quantity.displayed(value):.6g}{self.unit}"


def _part_with(part: str, variable: str, built: Ready, at_once: Sequence[str]) -> tuple[str, str]:
    """Part that has a variable, and the variable; InputError where there is none."""
    entries = {name: entry for name, entry in ANALYSES.items() if isinstance(entry, Analysis)}
    if variable == "drive_mass" and not part:
        holding = [*_MASS]
    elif part:
        holding = [part] if variable in VARIABLES and part in entries else []
    else:
        holding = [name for name, entry in entries.items() if variable in entry.main]
    reasons = {name: entries[name].why_not(built) for name in holding}
    there = [name for name, why in reasons.items() if why is None]
    if there:
        return there[0], _MASS[there[0]] if variable == "drive_mass" else variable
    if reasons:
        raise InputError(
            f"{shown(variable)} is no result of this case: {next(iter(reasons.values()))}"
        )
    every = [*at_once, *(figure for entry in entries.values() for figure in entry.main)]
    near = similar_names(variable, every)[:_NEAR]
    meant = f"did you mean {' or '.join(near)}?" if near else _WHICH
    raise InputError(f"{shown(variable)} is no result; {meant}")


def values_of_study(
    study: xr.Dataset, figure: SoughtFigure, law: str, count: int
) -> Float[np.ndarray, " design"]:
    """Values of a figure of many designs; not numbers of those that were refused.

    Args:
        study: figures over `law` and `point`.
        figure: one of them.
        law: of friction.
        count: number of designs.
    """
    if figure.variable not in study:
        return np.full(count, np.nan)
    values = study[figure.variable].sel(law=law).transpose("point", ...)
    return np.array([value_of(design, figure) for design in values])


def value_in(outcome: Outcome, figure: SoughtFigure, law: str) -> float:
    """The value of a figure in a run.

    Args:
        outcome: of the case.
        figure: of any of its parts.
        law: of friction.

    Raises:
        InputError: its part does not have it; it is several numbers, and no place says which.
    """
    parts: Mapping[str, xr.Dataset] = outcome.parts
    part = figure.part_of_run
    holding = [part] if part else ["operation", "strength", *parts]
    for name in holding:
        data = parts.get(name)
        if data is not None and figure.variable in data:
            values = data[figure.variable]
            if "law" in values.dims:
                values = values.sel(law=law)
            if "case" in values.dims and not figure.part:
                values = values.sel(case=_AS_GIVEN)
            return value_of(values, figure)
    data = parts.get(figure.part)
    if data is not None:
        numbers = [str(name) for name in data if data[name].dtype.kind == "f"]
        near = nearest(figure.variable, numbers)
        raise InputError(f"{figure.part} has no result {shown(figure.variable)}{near}")
    return float("nan")


def value_of(values: xr.DataArray, figure: SoughtFigure) -> float:
    """One number out of the values of a figure at one design."""
    left = values.squeeze([dim for dim, size in values.sizes.items() if size == 1], drop=True)
    if figure.name.startswith("drive_mass"):
        return float(left.sum(skipna=False))
    if figure.place and left.ndim == 1:
        places = dict(_places(left))
        if figure.place not in places:
            told = f"{figure.variable} has no value {shown(figure.place)}"
            raise InputError(f"{told}; it has {', '.join(places)}")
        return places[figure.place]
    if left.ndim or figure.place:
        several = (
            [f"{figure.variable}.{place}" for place, _ in _places(left)] if left.ndim == 1 else []
        )
        which = f"; name one: {', '.join(several[:_FEW])}" if 0 < len(several) <= _FEW else ""
        what = f"{left.size} values" if left.ndim else "one value, without places"
        raise InputError(f"{figure.variable} has {what} at each design{which}")
    return float(left)


_FEW, _NEAR = 8, 3


def _places(values: xr.DataArray) -> Iterator[tuple[str, float]]:
    """Values along the only dimension by number, and by label."""
    dim = str(values.dims[0])
    labels: Any = values[dim].values if dim in values.coords else range(1, values.size + 1)
    for number, (label, value) in enumerate(zip(labels, values.values, strict=True), 1):
        word = str(label).replace(" ", "_")
        yield (str(number) if word in (f"gear_{number}", str(number)) else word), float(value)
