"""What a drive of several meshes is at its ends: backlash at the output, masses, reflected inertia."""

import json
from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.registry import enumerated
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.sections.bodies import INERTIA

__all__ = ["reflected_blocks", "reflected_facts", "reflected_printed"]

_ASSUMED = (
    "Cylindrical gears are discs from bore to reference circle, rings from there outwards; shafts, "
    "couplings, motor and load are not in it. What is held has a mass and no part in the inertia."
)

Row = tuple[str, ...]


def reflected_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "reflected", _of_variant)


def _of_variant(_: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["reflected"]
    if "output_backlash" in data:
        unit = show.unit_of("output_backlash")
        backlash = zip(data["case"].values, data["output_backlash"].values, strict=True)
        plays = [(str(case), _cell("output_backlash", float(value))) for case, value in backlash]
        heads, cells = zip(*(plays if _by_tolerances(data) else plays[:1]), strict=True)
        row = (f"turn of the output, the input held [{unit}]", *cells)
        yield section.SectionTable(["backlash", *heads], [row], compact=True)
    yield section.SectionTable(_heads(data), _rows(data), compact=True)
    yield section.Paragraph(" ".join([_ASSUMED, *_of_planets(data), *_of_backlash(data)]), "note")


def _by_tolerances(data: xr.Dataset) -> bool:
    """True where a tolerance makes the backlash at the output differ."""
    _, least, _, largest = data["output_backlash"].values
    return bool(largest > least)


def _carriers(data: xr.Dataset) -> str:
    return " and ".join(
        show.with_article(carrier) for carrier in json.loads(data.attrs["carriers"])
    )


def _of_planets(data: xr.Dataset) -> Iterator[str]:
    """What is not known of a train."""
    if _carriers(data):
        yield (
            f"Not in it: {_carriers(data)}, of which nothing says what it weighs. All planets play alike."
        )


def _of_backlash(data: xr.Dataset) -> Iterator[str]:
    """Stages without tolerances, or without a backlash by their teeth."""
    unknown = json.loads(data.attrs["without_backlash"])
    if unknown:
        listed = enumerated(unknown)
        yield (
            f"No backlash at the output: that of stage {listed} does not follow from the thickness of teeth; "
            "what plays without load stands under torsion."
        )
    numbers = json.loads(data.attrs["without_tolerances"])
    if numbers and "output_backlash" in data:
        listed = enumerated(numbers)
        yield (
            f"Stage{'s' if len(numbers) > 1 else ''} {listed} without tolerances in [gears.inspection]: the "
            "nominal backlash counts."
        )


def reflected_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Backlash at the output and inertia at the ends, which a joint is driven with."""
    data = outcome.parts["reflected"]
    if "output_backlash" in data:
        nominal, least, _, largest = (float(v) for v in data["output_backlash"].values)
        ends = [least, largest] if _by_tolerances(data) else [nominal]
        value = " to ".join(_cell("output_backlash", end) for end in ends)
        unit = show.unit_of("output_backlash")
        behind = _NONE_ALLOWED if max(map(abs, ends)) < _NO_PLAY else 59.0
        yield section.KeyFigure(
            _OF_SETS if outcome.manifest.get("trains") else behind,
            "Backlash at the output",
            f"{value} {unit}",
            _whence(data, nominal),
            "" if _by_tolerances(data) else f"{value} {unit} nominal",
            asked_by=("gears.inspection",),
        )
    inertias = zip(data["end"].values, data["reflected_inertia"].values, strict=True)
    inertias_known = [
        (str(end), show.quantity("reflected_inertia", float(value)))
        for end, value in inertias
        if np.isfinite(value)
    ]
    for (end, value), *others in [inertias_known] if inertias_known else []:
        further = "".join(f"{inertia} at the {name}; " for name, inertia in others)
        mass = show.quantity("drive_mass", float(data["drive_mass"]))
        without = f", without {_carriers(data)}" if _carriers(data) else ""
        detail = f"{further}gears {mass}{without}"
        yield section.KeyFigure(75.0, f"Inertia at the {end}", value, detail, asked_by=INERTIA)
    if '"from_stiffness" do' in outcome.manifest["lacks"].get("torsion", ""):
        how = 'load_sharing = "from_stiffness" has it'
        yield section.KeyFigure(79.5, "Torsional stiffness", "not asked", how)


_NO_PLAY = 1e-9
"""Backlash below which no allowance can have been given [rad]."""
_OF_SETS = 45.0
"""Place of that of planetary sets among key figures: with their diameter."""
_NONE_ALLOWED = 79.7
"""Place of such a backlash among key figures: behind what is computed."""


def _whence(data: xr.Dataset, nominal: float) -> str:
    """By what the backlash at the output is, and which stages have no tolerances in it."""
    if not _by_tolerances(data):
        return _of_nominal(nominal)
    numbers = json.loads(data.attrs["without_tolerances"])
    if not numbers:
        return "by tolerances, the input held"
    several = "stages" if len(numbers) > 1 else "stage"
    return f"without play of {several} {enumerated(numbers)}: no tolerances there"


def _of_nominal(backlash: float) -> str:
    """What goes with a backlash without tolerances."""
    none = abs(backlash) < _NO_PLAY
    return "nominal: no allowance is given" if none else "nominal, the input held"


def reflected_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    data = outcome.parts["reflected"]
    yield section.Printed(rows=[dict(zip(_heads(data), row, strict=True)) for row in _rows(data)])


def _columns(data: xr.Dataset) -> list[tuple[str, list[str]]]:
    """Heads and cells of the columns of inertia, the drive last; each in a unit without powers of ten."""
    ends = [f"at the {end}" for end in data["end"].values]
    titles = ["inertia J", *ends]
    parts = [data["body_inertia"].values, *data["reflected_part"].values]
    drives = [None, *data["reflected_inertia"].values.tolist()]
    columns = []
    for title, part, drive in zip(titles, parts, drives, strict=True):
        unit, cells = show.quantities(
            "body_inertia", [*part.tolist(), *([] if drive is None else [drive])]
        )
        shown_cells = [cell if cell != "undefined" else "–" for cell in cells]
        columns.append(
            (f"{title} [{unit}]", shown_cells if drive is not None else [*shown_cells, ""])
        )
    return columns


def _heads(data: xr.Dataset) -> list[str]:
    return ["body", f"mass m [{show.unit_of('body_mass')}]", *(head for head, _ in _columns(data))]


def _rows(data: xr.Dataset) -> list[Row]:
    without = f", without {_carriers(data)}" if _carriers(data) else ""
    bodies = [*map(str, data["body"].values), f"drive{without}"]
    masses = [*data["body_mass"].values.tolist(), float(data["drive_mass"])]
    shown_masses = [_cell("body_mass", mass) for mass in masses]
    return [*zip(bodies, shown_masses, *(cells for _, cells in _columns(data)), strict=True)]


def _cell(name: str, value: float) -> str:
    return show.quantity(name, value, with_unit=False) if np.isfinite(value) else "–"
