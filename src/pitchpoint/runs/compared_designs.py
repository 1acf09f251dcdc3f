"""Designs beside each other: results of several cases under one name each, and where they differ."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.document import variants
from pitchpoint.cases.library import as_text, case_names, find_case
from pitchpoint.cases.record import MANIFEST, is_record, is_result
from pitchpoint.errors import InputError, shorten, visible
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest
from pitchpoint.results.by_stage import STAGE
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import variable_of
from pitchpoint.runs.run import Outcome, Progress, open_outcomes, run_case
from pitchpoint.units import si_unit

__all__ = [
    "DESIGNS",
    "MainFigure",
    "Wanted",
    "as_json",
    "design_names",
    "designs",
    "differing_inputs",
    "folder_of",
    "main_results",
    "resolved_reference",
    "shared_laws",
]

DESIGNS = "designs"
"""Folder of the results of a comparison, beside its report."""


@dataclass(frozen=True)
class Wanted:
    """One reference of a comparison: a case or the folder of a result, and which variant of it.

    Attributes:
        case: a shipped case, a file, or the folder of a result.
        variant: its name; None for all of them.
    """

    case: str
    variant: str | None = None

    @property
    def computed(self) -> bool:
        """True for the folder of a result, which is read as it is."""
        return is_result(self.case)

    @property
    def parts(self) -> tuple[str, ...]:
        """Names from the root down that may stand for it."""
        if self.case in case_names():
            return (self.case,)
        path = Path(os.path.abspath(self.case))
        return path.parts[1:] if self.computed else path.with_suffix("").parts[1:]


def resolved_reference(reference: str) -> Wanted:
    """What a reference means: `case`, `case@variant` where no file has that name, or the folder of a variant.

    Example:
        >>> resolved_reference("pair.toml@physical")
        Wanted(case='pair.toml', variant='physical')
    """
    folder = Path(reference)
    if os.path.isfile(folder / MANIFEST) and is_result(str(folder.parent)):
        return Wanted(str(folder.parent), folder.name)
    case, at, variant = reference.rpartition("@")
    if not at or os.path.exists(reference):
        return Wanted(reference)
    return Wanted(case, variant)


def designs(
    references: Sequence[str],
    *,
    folder: Path | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> dict[str, Outcome]:
    """Results of several designs by name; those that are not there yet are computed.

    Args:
        references: cases and folders of results, each alone or with `@variant`.
        folder: where results go that have to be computed, a folder for each case; None to keep none.
        overwrite: True to replace results of another case there.
        progress: told about parts and points.

    Raises:
        InputError: anything wrong with a reference or its case; a design that is named twice.
    """
    every = [design for reference in references for design in _each(resolved_reference(reference))]
    for design in every:
        if every.count(design) > 1:
            raise InputError(f"{shown(_told(design))} was named twice; name each design once")
    titles = design_names(list(dict.fromkeys(design.case for design in every)))
    outcomes = {
        case: _results(
            case,
            [str(design.variant) for design in every if design.case == case],
            None if folder is None else folder / _file_name(title),
            overwrite=overwrite,
            progress=progress,
        )
        for case, title in titles.items()
    }
    alone = {case for case in titles if sum(design.case == case for design in every) == 1}
    with_variant = {design.case for design in map(resolved_reference, references) if design.variant}
    return {
        titles[design.case]
        + ("" if design.case in alone - with_variant else f"@{design.variant}"): outcomes[
            design.case
        ][str(design.variant)]
        for design in every
    }


def folder_of(references: Sequence[str], root: Path) -> Path:
    """Folder of a comparison under that of all results, named after its designs."""
    every = [resolved_reference(reference) for reference in references]
    titles = design_names(list(dict.fromkeys(design.case for design in every)))
    labels = [
        titles[design.case] + (f"@{design.variant}" if design.variant else "") for design in every
    ]
    return root / _file_name("-".join(labels))


def _told(one: Wanted) -> str:
    return f"{one.case}@{one.variant}"


def _each(one: Wanted) -> Iterator[Wanted]:
    """The variants that a reference means, each by name."""
    variants = _variants(one)
    if one.variant is not None and one.variant not in variants:
        message = (
            f"{shown(one.variant)} is not a variant of this case{nearest(one.variant, variants)}"
        )
        raise InputError(message, file=visible(as_text(one.case)))
    yield from (replace(one, variant=name) for name in variants if one.variant in (None, name))


def _variants(one: Wanted) -> list[str]:
    if one.computed:
        return [*open_outcomes(one.case)]
    if is_record(one.case):
        message = f"is the record of a result; name its folder, without {MANIFEST}"
        raise InputError(message, file=visible(as_text(one.case)))
    return variants(find_case(one.case)[1])


def _results(
    case: str,
    chosen: Sequence[str],
    folder: Path | None,
    *,
    overwrite: bool,
    progress: Progress | None,
) -> Mapping[str, Outcome]:
    """Results of some variants of one case, by variant."""
    if Wanted(case).computed:
        return open_outcomes(case)
    return run_case(case, folder=folder, only=chosen, overwrite=overwrite, progress=progress)


def design_names(cases: Sequence[str]) -> dict[str, str]:
    """Names by case, each as short as it tells it from the others.

    Args:
        cases: references, each once.
    """
    ways = {case: Wanted(case).parts for case in cases}
    for count in range(1, max(map(len, ways.values()), default=0) + 1):
        titles = {case: shorten(as_text("/".join(path[-count:]))) for case, path in ways.items()}
        if len(set(titles.values())) == len(titles):
            return titles
    return {case: shorten(as_text(case)) for case in cases}


def _file_name(title: str) -> str:
    return title.replace(os.sep, "-").replace("/", "-")


@dataclass(frozen=True)
class MainFigure:
    """A main figure of several designs, under one friction law or whatever law each of them has.

    Attributes:
        part: of the results.
        name: of the variable.
        law: that all designs share; empty where the figure has none, or each takes its first.
        place: of one of several values: a gear, say; empty where there is one.
        variable: its words and units.
        values: by design [SI]; none of a design that does not have it.
    """

    part: str
    name: str
    law: str
    place: str
    variable: Variable
    values: Mapping[str, float]

    @property
    def title(self) -> str:
        """What it is, with its place."""
        words = f"{_EXTREMES.get(self.name, '')} {self.variable.long_name}".strip()
        back = ", back-driving" if self.part == "back_driving" else ""
        return f"{words}{back}, {self.place}" if self.place else f"{words}{back}"


_EXTREMES = {"pressure": "", "film_thickness": "smallest", "lambda_ratio": "smallest"}
"""What is shown of the mesh cycle: its largest pressure, and where films are thinnest."""

_OF_GEARS = {
    "contact_stress": "largest",
    "root_stress": "largest",
    "flank_safety": "least",
    "root_safety": "least",
}
"""What is shown of both gears of a stage."""

_MORE = {
    "operation": (
        "contact_ratio",
        "circumferential_backlash",
        "mean_drag_loss",
        "stage_loss",
        "stage_efficiency",
    ),
    "cycle": tuple(_EXTREMES),
    "load_limits": ("goodman_safety", "limit_margin", "bearing_life"),
    "stiffness": ("mean_stiffness", "stiffness_variation"),
    "torsion": ("slope_stiffness", "catalogue_lost_motion", "hysteresis_loss"),
    "back_driving": ("mean_efficiency",),
}
"""Figures beside the main ones of an analysis."""

_FEW = 4
"""Most values of a figure along one axis that are shown one by one."""

_LABELLED = (STAGE, "case")
"""Axes whose label is told of a single value too: of a rated stage, of the backlash without tolerances."""

Keys = tuple[str, str, str, str, Variable]


def main_results(outcomes: Mapping[str, Outcome]) -> list[MainFigure]:
    """Main figures of some designs; those that one design alone has stand there for it alone.

    What is zero in all of them is left out.

    Args:
        outcomes: by design.
    """
    shared = shared_laws(outcomes)
    by_key: dict[Keys, dict[str, float]] = {}
    for design, outcome in outcomes.items():
        for key, value in _of_design(outcome, shared):
            by_key.setdefault(key, {})[design] = value
    order = {name: position for position, name in enumerate(ANALYSES)}
    every = [MainFigure(*key, values) for key, values in by_key.items() if any(values.values())]
    return sorted(every, key=lambda one: (one.part != "operation", order[one.part]))


def shared_laws(outcomes: Mapping[str, Outcome]) -> list[str]:
    """Friction laws that all designs have, in the order of the first one."""
    of_designs = [
        [law["name"] for law in outcome.manifest["laws"]] for outcome in outcomes.values()
    ]
    return [law for law in of_designs[0] if all(law in laws for laws in of_designs)]


def _of_design(outcome: Outcome, shared: Sequence[str]) -> Iterator[tuple[Keys, float]]:
    for name, analysis in ANALYSES.items():
        data = outcome.parts.get(name)
        if data is None:
            continue
        twice = _EXTREMES if name == "operation" else ()
        for variable in dict.fromkeys((*analysis.main, *_MORE.get(name, ()))):
            if variable in data and variable not in twice and data[variable].dtype.kind in "fiu":
                yield from _of_variable(outcome, name, variable, shared)
        if name == "bodies" and "body_mass" in data:
            mass = float(data["body_mass"].sum(skipna=False))
            if np.isfinite(mass):
                yield ("reflected", "drive_mass", "", "", variable_of(data, "drive_mass")), mass


_ALIKE = {"bodies": "reflected"}
"""Parts that have figures of the same names for other gears, and with which of them these stand."""


def _of_variable(
    outcome: Outcome, part: str, name: str, shared: Sequence[str]
) -> Iterator[tuple[Keys, float]]:
    data = outcome.parts[part]
    alike = ANALYSES[_ALIKE[part]].main if part in _ALIKE else ()
    described = variable_of(data, name)
    for law, array in _by_law(data[name], shared):
        reduced = _extreme(data, array) if part == "cycle" else _there(outcome, array)
        for place, value in _places(reduced):
            if np.isfinite(value):
                yield (_ALIKE[part] if name in alike else part, name, law, place, described), value


def _by_law(array: xr.DataArray, shared: Sequence[str]) -> Iterator[tuple[str, xr.DataArray]]:
    """Values under each law that all designs share, or under the first one without its name."""
    if "law" not in array.dims:
        yield "", array
        return
    every = [str(law) for law in array["law"].values]
    there = [law for law in shared if law in every]
    yield from ((law, array[{"law": every.index(law)}]) for law in there)
    if not there and every:
        yield "", array[{"law": 0}]


def _extreme(data: xr.Dataset, array: xr.DataArray) -> xr.DataArray:
    """Largest value over the mesh cycle, or the smallest one of a film, where pairs carry."""
    touching = array.where(data["load"] > 0.0)
    return touching.max() if _EXTREMES[str(array.name)] == "" else touching.min()


def _there(outcome: Outcome, array: xr.DataArray) -> xr.DataArray:
    """Values over torque, speed and temperature at the operating point, if it lies among them."""
    inputs = outcome.manifest["inputs"]
    point = {row["key"]: row["value"] for row in inputs if row["table"] == "operation"}
    for axis in ("torque", "speed", "temperature"):
        if axis not in array.dims or axis not in array.coords:
            continue
        at, ends = point.get(axis, np.nan), array[axis].values
        if not ends.min() * (1 - 1e-9) <= at <= ends.max() * (1 + 1e-9):
            return array
        array = (
            array.interp({axis: np.clip(at, ends.min(), ends.max())}) if ends.size > 1 else array
        )
    return array


def _places(array: xr.DataArray) -> Iterator[tuple[str, float]]:
    """Values by place; none where there are too many to be told one by one."""
    single = [dim for dim, size in array.sizes.items() if size == 1 and dim not in _LABELLED]
    left = array.squeeze(single, drop=True)
    if left.dims == (STAGE, "gear"):
        yield from _of_stages(left)
    elif left.dims[1:] == ("cause",):
        yield from _along(left.sel(cause="both"))
    elif left.ndim == 2 and max(left.shape) <= _FEW:
        for label, row in zip(left[left.dims[0]].values, left, strict=True):
            yield from (
                (f"{label}, {place}", of) for place, of in _places(row.drop_vars(left.dims[0]))
            )
    elif left.ndim == 0:
        yield "", float(left)
    elif left.ndim == 1 and left.size <= _FEW and left.dims[0] in left.coords:
        yield from _along(left)


def _of_stages(array: xr.DataArray) -> Iterator[tuple[str, float]]:
    """The value of the weaker gear of each stage; not a number where one of both has none."""
    extreme = _OF_GEARS.get(str(array.name))
    if extreme is not None:
        of = array.max if extreme == "largest" else array.min
        yield from (
            (f"{extreme} of {stage}", number) for stage, number in _along(of("gear", skipna=False))
        )


def _along(array: xr.DataArray) -> Iterator[tuple[str, float]]:
    """Values along the only axis, by their labels."""
    dim = str(array.dims[0])
    for place, value in zip(array[dim].values, array.values, strict=True):
        label = str(place).replace("_", " ")
        yield f"{dim} {label}" if label.isdigit() or dim == STAGE else label, float(value)


def differing_inputs(outcomes: Mapping[str, Outcome]) -> list[dict[str, Any]]:
    """Inputs that are not the same in all designs: table, key, unit, and SI values by design.

    A design that has no such input has None.
    """
    rows: dict[tuple[str, str], dict[str, Mapping[str, Any]]] = {}
    for design, outcome in outcomes.items():
        for row in outcome.manifest["inputs"]:
            rows.setdefault((row["table"], row["key"]), {})[design] = row
    return [
        {
            "table": table,
            "key": key,
            "unit": _unit(by_design.values()),
            "values": {
                name: by_design[name]["value"] if name in by_design else None for name in outcomes
            },
        }
        for (table, key), by_design in rows.items()
        if len(by_design) < len(outcomes) or _several(row["value"] for row in by_design.values())
    ]


def _several(values: Iterable[Any]) -> bool:
    reference, *others = values
    return any(value != reference for value in others)


def _unit(rows: Iterable[Mapping[str, Any]]) -> str:
    """SI unit of an input; empty for texts and tables."""
    kinds = [row["kind"] for row in rows if isinstance(row["kind"], str) and row["kind"]]
    return si_unit(kinds[0]) if kinds else ""


def as_json(outcomes: Mapping[str, Outcome]) -> dict[str, Any]:
    """A comparison as JSON has it: what cannot be, inputs that differ, main results, in SI by design."""
    results = [
        {"result": figure.title, "part": figure.part, "variable": figure.name, "law": figure.law}
        | {"place": figure.place, "unit": figure.variable.unit, "values": dict(figure.values)}
        for figure in main_results(outcomes)
    ]
    failing = {name: figure.manifest["implausible"] for name, figure in outcomes.items()}
    return {"implausible": failing, "inputs": differing_inputs(outcomes), "results": results}
