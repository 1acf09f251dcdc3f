"""What goes on the drawing of each gear: span, balls, limits of backlash, tolerances, mass."""

import json
from collections.abc import Iterator, Sequence
from math import floor, log10

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.point import named_members
from pitchpoint.views.screen import head, screen_value

__all__ = ["INSPECTION", "backlash_rows", "measured_rows"]

_SIDES = {"nominal": "", "upper": ", thickest teeth", "lower": ", thinnest teeth"}

_BACKLASH = {
    "backlash_on_circle": "on the pitch circles in operation j_wt",
    "backlash_along_normal": "along the normal of the flanks j_bn",
}

_USUAL = (
    "Unless given, span and balls touch nearest to the middle of the active flank, balls rounded up to two "
    "digits. Mass and inertia are those of discs from bore to reference circle, of a ring from there "
    "outwards; without bore_diameter a bore is 0.3 of the root circle, a ring ends at 1.2 of it."
)

Row = tuple[str, ...]


def measured_rows(data: xr.Dataset) -> list[Row]:
    """Names of the dimensions of a drawing, each with its values for both gears."""
    return [
        *_limits(data, "normal_thickness", "tooth thickness, normal section s_n"),
        _row("teeth under the span k", [_count(v) for v in data["span_teeth"].values]),
        *_limits(data, "span_measurement", "span W_k"),
        _measured("the span touches on d", "span_diameter", data),
        _measured("measuring balls D_M", "ball_diameter", data),
        *_limits(data, "over_balls", "over balls, in a ring between them, M_d"),
        _measured("the balls touch on d", "ball_contact_diameter", data),
        _weighed("mass m", "disc_mass", data),
        _weighed("moment of inertia J", "disc_inertia", data),
    ]


def backlash_rows(data: xr.Dataset) -> list[Row]:
    """Names of each kind of backlash with its values for every case."""
    return [
        *(
            _row(f"{title} [{show.unit_of(name)}]", _each(name, data))
            for name, title in _BACKLASH.items()
        ),
        *(
            _row(
                f"turn of {gear}, the other one held [{show.unit_of('backlash_angle')}]",
                _each("backlash_angle", data.sel(gear=gear)),
            )
            for gear in data["gear"].values
        ),
    ]


def _weighed(title: str, name: str, data: xr.Dataset) -> Row:
    unit, cells = show.quantities(name, data[name].values.tolist())
    return _row(f"{title} [{unit}]", cells)


def _limits(data: xr.Dataset, name: str, title: str) -> Iterator[Row]:
    """A row for the nominal value and one for each limit."""
    for side in data["limit"].values:
        yield _measured(f"{title}{_SIDES[str(side)]}", name, data.sel(limit=side))


def _measured(title: str, name: str, data: xr.Dataset) -> Row:
    """Row of a length of a drawing."""
    return _row(
        show.bracketed(title, show.described(name)), _to_a_micrometre(name, data[name].values)
    )


def _to_a_micrometre(name: str, values: np.ndarray) -> list[str]:
    """Lengths in their unit to a micrometre or finer; a dash where there is none."""
    variable = show.described(name)
    decimals = max(0, -floor(log10(variable.displayed(1e-6))))
    return [f"{v:.{decimals}f}" if np.isfinite(v) else "–" for v in variable.displayed(values)]


def _row(title: str, cells: Sequence[str]) -> Row:
    return (title, *cells)


def _each(name: str, data: xr.Dataset) -> list[str]:
    return [show.quantity(name, float(v), with_unit=False) for v in data[name].values]


def _count(value: float) -> str:
    return f"{value:.0f}" if np.isfinite(value) else "–"


_DEVIATIONS = {
    "f_pT": "single pitch",
    "F_pT": "cumulative pitch, total",
    "f_HαT": "profile slope",
    "f_fαT": "profile form",
    "f_HβT": "helix slope",
    "f_fβT": "helix form",
    "F_αT": "profile, total",
    "F_βT": "helix, total",
}
"""What tolerances of ISO 1328-1 are of."""


def _tolerance_rows(data: xr.Dataset) -> list[Row]:
    tolerance = show.described("flank_tolerance")
    return [
        _row(
            show.bracketed(f"{_DEVIATIONS[name]} {name}", tolerance),
            [show.number_text(tolerance.displayed(v)) for v in values],
        )
        for name, values in zip(
            data["tolerance"].values, data["flank_tolerance"].values.T, strict=True
        )
    ]


def _blocks(page: section.Page) -> Iterator[section.Block]:
    yield from section.blocks_by_variant(page, "inspection", _of_variant)


def _of_members(outcome: Outcome) -> xr.Dataset:
    """Inspection of the gears of a mesh, those of a train by the bodies that they are."""
    data = outcome.parts["inspection"]
    has_bodies = bool(outcome.manifest.get("bodies"))
    return data.assign_coords(gear=named_members(outcome)) if has_bodies else data


def _of_variant(_: int, outcome: Outcome) -> Iterator[section.Block]:
    data = _of_members(outcome)
    gears = [str(name) for name in data["gear"].values]
    yield section.Paragraph(data.attrs["note"])
    yield section.SectionTable(
        ["backlash", *map(str, data["case"].values)], backlash_rows(data), compact=True
    )
    yield section.SectionTable(["dimension", *gears], measured_rows(data), compact=True)
    if "flank_tolerance" in data:
        classes = [f"{value:.0f}" for value in json.loads(data.attrs["iso_class"])]
        titles = [f"{gear}, class {of}" for gear, of in zip(gears, classes, strict=True)]
        yield section.SectionTable(
            ["tolerance by ISO 1328-1", *titles], _tolerance_rows(data), compact=True
        )
    if data.sizes["case"] == 1:
        yield section.Paragraph(
            "Without tolerances: a table [gears.inspection] with thickness allowances and a deviation of the "
            "centre distance gives the least, mean and largest backlash.",
            "note",
        )
    untold = (text[:1].upper() + text[1:] for text in json.loads(data.attrs["unmeasured"]))
    yield section.Paragraph(" ".join([_USUAL, *untold]), "note")


def _answer(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Backlash, its limits where tolerances are given."""
    data = _of_members(outcome) if "inspection" in outcome.parts else None
    if data is None:
        return
    several = data.sizes["case"] > 1
    ends = data.sel(case=["least", "largest"]) if several else data
    on_circle, *_ = backlash_rows(ends)
    turns = [
        f"{' to '.join(_each('backlash_angle', ends.sel(gear=gear)))} "
        f"{show.unit_of('backlash_angle')} at {gear}"
        for gear in data["gear"].values
    ]
    yield section.KeyFigure(
        60.0,
        "Backlash by tolerances" if several else "Backlash",
        f"{' to '.join(on_circle[1:])} {show.unit_of('backlash_on_circle')}",
        f"{_of_allowances(data)}on the pitch circles; {', '.join(turns)}",
        # Of a mesh of a train that at the output is what was asked.
        asked_by=() if outcome.manifest.get("bodies") else ("gears.inspection",),
    )


def _of_allowances(data: xr.Dataset) -> str:
    """Where a backlash is not by tolerances, that it is as drawn; of none that nothing was given for it."""
    if data.sizes["case"] > 1:
        return ""
    none = bool((abs(data["backlash_on_circle"]) < 1e-12).all())
    return "nominal, no allowance is given; " if none else "nominal, "


def _printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What is asked for alone: the screen is short."""
    data = _of_members(outcome) if "inspection" in outcome.parts else None
    if data is None or not data.attrs["asked"]:
        return
    yield section.Printed(rows=[_on_screen(data, str(gear)) for gear in data["gear"].values])


def _on_screen(data: xr.Dataset, gear: str) -> dict[str, str]:
    of_gear = data.sel(gear=gear)
    row = {"inspection": gear, head("span_teeth"): _count(float(of_gear["span_teeth"]))}
    for name in ("span_measurement", "ball_diameter", "over_balls"):
        values = np.sort(np.atleast_1d(of_gear[name].values)[-2:])
        row[head(name)] = " to ".join(dict.fromkeys(_to_a_micrometre(name, values)))
    plays = of_gear["backlash_angle"].values
    ends = plays if plays.size == 1 else plays[[1, -1]]
    words = [screen_value("backlash_angle", float(v)) for v in ends]
    return row | {head("backlash_angle"): " to ".join(words)}


INSPECTION = section.Section(
    name="inspection",
    title="Inspection: backlash, span, balls, tolerances",
    short="Inspection",
    order=105.0,
    parts=("inspection",),
    blocks=_blocks,
    answer=_answer,
    screen=_printed,
)
