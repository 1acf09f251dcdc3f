"""Figures and tables of the studies of a case."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint import units
from pitchpoint.analyses.main_figures import CONTACT, MAIN, RATING, coverage_sentences, of_contact
from pitchpoint.analyses.studies import is_study
from pitchpoint.cases.keys import quantity_at
from pitchpoint.core.doubts import doubts_of, ranked_doubts
from pitchpoint.registry import enumerated
from pitchpoint.results.chosen_units import unit_in_use
from pitchpoint.results.rounding import ROUNDING
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.figures import (
    Choice,
    Curve,
    Curves,
    Figure,
    Menu,
    Panel,
    Trace,
    display,
    laws,
    layout,
    line,
    plotly_text,
    short_axis,
)
from pitchpoint.views.inputs import quantity_text
from pitchpoint.views.lines import titled
from pitchpoint.views.screen import efficiency_of, head, screen_value
from pitchpoint.views.sections.design_chart import design_charts, is_design_chart

__all__ = [
    "STUDIES",
    "extrapolated_note",
    "is_swept",
    "marked",
    "study_panels",
    "swept_place",
    "swept_rows",
]

_SHOWN = ("mean_efficiency", "efficiency_fluctuation", "mean_input_torque", "torque_ripple")
_MOVING = ("mean_stiffness", "transmission_error_range", "largest_dynamic_factor")
"""Shown where a case has vibration, the same under every friction law."""
_TABLE = ("contact_ratio", *MAIN, "min_lambda_ratio")
_OF_LOSS = (
    *("mean_efficiency", "min_efficiency", "max_efficiency"),
    *("mean_loss", "torque_ripple", "mean_friction"),
)
"""What a mesh without loss has at its limit, whatever else it is."""

_PLACE = 2
"""Column of the place on the axis of a row, behind those with the names of its study and law."""

_WITHOUT = "Without friction the efficiency is 100 %, and the torque has no ripple."

_WIDE = 5
"""Columns from beyond which a table is a wide one."""

_MOST = 10
"""Columns of quantities that a page has room for; those beyond stand in a table of their own."""

_FEW = 3

_WORDS = {
    "operation.torque": "output torque",
    "operation.force": "normal force",
    "operation.speed": "driver speed",
    "operation.temperature": "oil temperature",
    "roughness.ra": "roughness Ra",
    "gears.addendum": "addendum of both basic racks [modules]",
    "gears.profile_shift": "profile shift x1",
}

Seen = list[tuple[Curve, xr.Dataset, int]]


def study_panels(outcomes: Mapping[str, Outcome], known: Curves) -> list[Panel]:
    """A panel for the sweeps of each kind: those that draw the same curves over the same key share it."""
    kinds: dict[Any, list[tuple[str, Seen]]] = {}
    for name, seen in _studies(outcomes, known):
        if "axis" in seen[0][1] and not _brief(seen):
            kinds.setdefault(_kind(seen), []).append((name, seen))
    return [_panel(group) for group in kinds.values()]


def _brief(seen: Seen) -> bool:
    """True for sweeps of so few points that their numbers say more than a line."""
    return all(data.sizes["point"] < _FEW for _, data, _ in seen)


def _kind(seen: Seen) -> tuple[Any, ...]:
    """What studies have in common that can share their figures."""
    data = seen[0][1]
    same_looks = tuple(curve.key for curve, *_ in seen)
    return same_looks, data.attrs["sweep_key"], *map(tuple, (_shown(seen), _axes(data)))


def _tables(page: section.Page) -> Iterator[section.Block]:
    """Tables for studies of a single point, and for sweeps of the same key with few of them."""
    alone: list[Seen] = []
    sweeps: dict[str, list[Seen]] = {}
    for _, seen in _studies(page.outcomes, page.curves):
        if "axis" not in seen[0][1]:
            alone.append(seen)
        elif _brief(seen):
            sweeps.setdefault(str(seen[0][1].attrs["sweep_key"]), []).append(seen)
    if alone:
        (heading, *others) = (str(seen[0][1].attrs["title"]) for seen in alone)
        yield from _split("Studies of one point" if others else heading, "", alone)
    for key, studies in sweeps.items():
        yield from _split(f"Few values: {_words_of(key)}", f"Swept: {key}.", studies)


def _split(title: str, note: str, studies: list[Seen]) -> Iterator[section.Block]:
    """Tables of studies, rows without any loss apart: all that tells of it is the same in them."""
    for lossless, suffix in ((False, ""), (True, ", without friction")):
        rows = [[row for row in seen if _lossless(*row[1:]) == lossless] for seen in studies]
        if these := [seen for seen in rows if seen]:
            remarks = " ".join(filter(None, (note, _WITHOUT if lossless else "")))
            yield section.Heading(f"{title}{suffix}")
            yield from _table(these, remarks, lossless=lossless, named=len(studies) > 1)


def _lossless(data: xr.Dataset, law: int) -> bool:
    """True where power goes through all points under a law and none is lost."""
    if "mean_loss" not in data:
        return False
    loss, efficiency = (data[name].values[law] for name in ("mean_loss", "mean_efficiency"))
    return bool(np.all((loss == 0.0) & (np.abs(efficiency - 1.0) < ROUNDING)))


def _table(
    studies: list[Seen], note: str, *, lossless: bool, named: bool
) -> Iterator[section.Block]:
    """Every point of studies of the same key under every law, without the columns that do not vary."""
    like = studies[0][0][1]
    every = [study_point for seen in studies for study_point in seen]
    columns = [*_columns(every)]
    if any("tip_thickness_1" in data for _, data, _ in every) and is_design_chart(like):
        columns.append("tip_thickness_1")
    if lossless:
        columns = [name for name in columns if name not in _OF_LOSS]
    swept = "axis" in like
    titles = (show.axis_title(name, like) for name in columns)
    heads = ["Study", "Friction law", _swept(like)[1] if swept else "", *titles]
    rows = [row for seen in studies for row in _rows(seen, columns)]
    note = " ".join(filter(None, (note, extrapolated_note(rows))))
    shown = [k for k in range(len(heads)) if (named or swept or k) and (swept or k != _PLACE)]
    constant = [
        k for k in shown if k != _PLACE and len(rows) > 1 and len({r[k] for r in rows}) == 1
    ]
    varying = [k for k in shown if k not in constant]
    if constant:
        values_words = ", ".join(f"{heads[k]} {rows[0][k]}" for k in constant)
        note = " ".join(filter(None, (note, f"The same in all rows: {values_words}.")))
    if note:
        yield section.Paragraph(note, "note")
    names = [k for k in varying if k <= _PLACE]
    numbers = np.array(varying[len(names) :], dtype=int)
    for part in np.array_split(numbers, max(-(-numbers.size // _MOST), 1)):
        of_part = [*names, *part]
        yield section.SectionTable(
            [heads[k] for k in of_part],
            [tuple(row[k] for k in of_part) for row in rows],
            wide=len(of_part) > _WIDE,
            names=sum(k < _PLACE for k in names),
        )


def _rows(seen: Seen, columns: list[str]) -> Iterator[tuple[str, ...]]:
    """Every point of a study under every law."""
    for curve, data, law in seen:
        for point in range(data.sizes["point"]):
            place = show.number_text(float(_swept(data)[0][point]), 6) if "axis" in data else ""
            cells = _cells(data, law, columns, point)
            yield str(data.attrs["title"]), curve.label, place, *cells


def _studies(outcomes: Mapping[str, Outcome], known: Curves) -> Iterator[tuple[str, Seen]]:
    names = dict.fromkeys(
        name for outcome in outcomes.values() for name in outcome.parts if is_study(name)
    )
    for name in names:
        yield (
            name,
            [
                (known[variant, law], outcome.parts[name], position)
                for variant, outcome in outcomes.items()
                if name in outcome.parts
                for position, law in enumerate(laws(outcome.parts[name]))
            ],
        )


def _columns(seen: Seen) -> list[str]:
    """Quantities of the table of a study of a single point."""
    further = ["mean_stiffness", "stiffness_variation", *_MOVING[1:]]
    if of_contact(seen[0][1]):
        return [*CONTACT]
    columns = [name for name in (*_TABLE, *further) if any(name in data for _, data, _ in seen)]
    return columns + _of_strength([data for _, data, _ in seen], vary=False)


def _cells(data: xr.Dataset, law: int, columns: list[str], point: int = 0) -> list[str]:
    values = {name: float(_valid(data, name)[law, point]) for name in columns}
    cells = {
        name: _endless(name, value) or show.quantity(name, value, with_unit=False, of=data)
        for name, value in values.items()
    }
    return [marked(name, words, data, law, point) for name, words in cells.items()]


def _endless(name: str, value: float) -> str:
    """What is shown of a safety without load; empty for all else."""
    return "∞" if name in RATING and value == np.inf else ""


def _valid(data: xr.Dataset, name: str) -> np.ndarray:
    """Values [law, point], those of a vibration only where there is a steady state."""
    if name not in data:
        return np.full(data["mean_loss"].shape, np.nan)
    values = data[name].values
    if name in _MOVING[1:] and "vibration_status" in data:
        return np.where(data["vibration_status"].values == 0, values, np.nan)
    return np.asarray(values)


def _axes(data: xr.Dataset) -> list[Any]:
    """What the figures may be drawn against, the first one at first."""
    return [_ratio, _swept] if _ratio_varies(data) and not is_design_chart(data) else [_swept]


def _shown(seen: Seen) -> list[str]:
    """Quantities that have a figure."""
    data = seen[0][1]
    further = _MOVING[2:] if is_design_chart(data) else _MOVING
    leading = CONTACT if of_contact(data) else _SHOWN
    shown = [*leading, *(name for name in further if any(name in study for _, study, _ in seen))]
    return shown + _of_strength([study for _, study, _ in seen], vary=True)


def _of_strength(every: Sequence[xr.Dataset], *, vary: bool) -> list[str]:
    """Least safeties, without them largest stresses, where there are some, or where they vary."""

    def told(name: str) -> bool:
        arrays = [study[name].values for study in every if name in study]
        finite = [values[~np.isnan(values)] for values in arrays]
        return any(
            not vary or not np.allclose(values, values.flat[0], rtol=ROUNDING, atol=0.0)
            for values in finite
            if values.size
        )

    safeties = [name for name in RATING[2:] if told(name)]
    return safeties or [name for name in RATING[:2] if told(name)]


def _panel(studies: list[tuple[str, Seen]]) -> Panel:
    """Figures of studies of one kind, with menus for the study and for what they are drawn against."""
    name, seen = studies[0]
    data, axes = seen[0][1], _axes(seen[0][1])
    figures = [_figure(f"{name}_{variable}", variable, seen, axes[0]) for variable in _shown(seen)]
    choices = [_choice(axis, figures, each) for _, each in studies for axis in axes]
    titles = [str(each[0][1].attrs["title"]) for _, each in studies]
    menus = [Menu("Study", titles)] if len(studies) > 1 else []
    menus += [Menu("Shown against", [axis(data)[1] for axis in axes])] if len(axes) > 1 else []
    return Panel(
        titles[0] if len(studies) == 1 else f"Against {_words_of(data.attrs['sweep_key'])}",
        figures,
        [curve for curve, *_ in seen],
        choices if menus else [],
        f"Swept: {data.attrs['sweep_key']}.",
        menus=menus,
    )


def _figure(name: str, variable: str, seen: Seen, axis: Any) -> Figure:
    like = seen[0][1]
    unit = show.unit_of(variable, like)
    return Figure(
        name,
        titled(variable, like),
        [_trace(curve, data, law, variable, axis, unit) for curve, data, law in seen],
        layout(plotly_text(axis(like)[1]), short_axis(variable, like)),
    )


def _trace(curve: Curve, data: xr.Dataset, law: int, variable: str, axis: Any, unit: str) -> Trace:
    values = display(variable, _valid(data, variable)[law], data)
    marks = {"mode": "lines+markers", "marker": {"size": 5, "color": curve.colour}}
    return line(curve, axis(data)[0], values, unit, **marks)


def _choice(axis: Any, figures: list[Figure], seen: Seen) -> Choice:
    title = axis(seen[0][1])[1]
    changes = {
        figure.name: _change(variable, axis, seen)
        for figure, variable in zip(figures, _shown(seen), strict=True)
    }
    return Choice(title, changes)


def _change(variable: str, axis: Any, seen: Seen) -> list[Any]:
    """What a choice changes in a figure: places and values of its curves, and the title of their axis."""
    traces = [_trace(curve, data, law, variable, axis, "") for curve, data, law in seen]
    return [
        {key: [trace[key] for trace in traces] for key in "xy"},
        {"xaxis.title.text": show.subscripts(plotly_text(axis(seen[0][1])[1]))},
    ]


def _swept(data: xr.Dataset) -> tuple[np.ndarray, str]:
    """Values of the swept key in its unit, and the title of their axis."""
    values = data["axis"].values
    key = str(data.attrs["sweep_key"])
    words = _words_of(key)
    if not np.isfinite(values).all():
        return np.arange(1.0, values.size + 1.0), f"{words} (number in the list)"
    unit, kind = str(data.attrs["axis_unit"]), str(data.attrs["axis_kind"])
    if kind:
        unit = unit_in_use(kind, unit)
        values = np.asarray(units.convert(values, unit, kind))
    return values, f"{words} [{show.display_unit(unit)}]" if show.display_unit(unit) else words


def _words_of(key: str) -> str:
    return _WORDS.get(key, key.replace("_", " ").replace(".", ", ", 1))


def _ratio(data: xr.Dataset) -> tuple[np.ndarray, str]:
    return data["contact_ratio"].values[0], "contact ratio"


def _ratio_varies(data: xr.Dataset) -> bool:
    return "contact_ratio" in data and bool(np.ptp(data["contact_ratio"].values) > 1e-6)


def _blocks(page: section.Page) -> Iterator[section.Block]:
    from markupsafe import Markup

    yield section.Paragraph(
        Markup(
            "Apart from what is named, every study stands at the operating point. How far the friction laws "
            'disagree is shown at the operating point, <a href="#answer">above</a>.'
        ),
        "note",
    )
    if alone := coverage_sentences([outcome.parts for outcome in page.outcomes.values()]):
        yield section.Paragraph(alone, "note")
    warnings = _warnings(page)
    if warnings:
        yield section.Drawn("study_warnings.html.jinja", {"study_warnings": warnings})
    for it in (*design_charts(page.outcomes), *study_panels(page.outcomes, page.curves)):
        yield section.Heading(it.title)
        yield section.Paragraph(it.note, "note")
        yield it
    yield from _tables(page)


def _warnings(page: section.Page) -> list[str]:
    """Sentences of the studies, each with all the variants and titles that it is about."""
    about: dict[str, dict[str, list[str]]] = {}
    for variant, outcome in page.outcomes.items():
        for title, sentence in _warns(outcome):
            about.setdefault(sentence, {}).setdefault(title, []).append(variant)
    return [f"{_about(titles, page.several)}: {sentences}" for sentences, titles in about.items()]


def _about(of_titles: dict[str, list[str]], several: bool) -> str:
    """Titles of studies behind the variants in which a sentence is about them."""
    by_variants: dict[str, list[str]] = {}
    for title, variants in of_titles.items():
        by_variants.setdefault(enumerated(variants) if several else "", []).append(title)
    return "; ".join(
        f"{f'{variants}, ' if variants else ''}{'; '.join(titles)}"
        for variants, titles in by_variants.items()
    )


def _warns(outcome: Outcome) -> list[tuple[str, str]]:
    """Titles of studies and their sentences."""
    return [
        (str(data.attrs["title"]), text)
        for name, data in outcome.parts.items()
        if is_study(name)
        for text in ranked_doubts(doubts_of(data.attrs))["warnings"]
        if text not in outcome.manifest["warnings"]
    ]


SWEPT = (
    *("mean_efficiency", "torque_ripple", "min_lambda_ratio"),
    *("mean_stiffness", "transmission_error_range"),
)


def _screen(outcome: Outcome) -> Iterator[section.Printed]:
    """Every sweep of the command line: point by point, each friction law by name."""
    for name, data in outcome.parts.items():
        if is_swept(name, data):
            rows = swept_rows(data)
            note = extrapolated_note(row.values() for row in rows)
            yield section.Printed(str(data.attrs["title"]), rows, note)


OUTSIDE = "†"
"""Behind an efficiency by a friction law that is out of its range there."""


def marked(name: str, words: str, data: xr.Dataset, law: int, point: int) -> str:
    """A number in words, an efficiency with a mark where it is extrapolated."""
    outside = "extrapolated" in data and bool(data["extrapolated"].values[law, point])
    return f"{words}{OUTSIDE}" if outside and name == "mean_efficiency" else words


def extrapolated_note(rows: Iterable[Iterable[str]]) -> str:
    """What the mark means; empty where it stands in no cell of some rows."""
    there = any(cell.endswith(OUTSIDE) for row in rows for cell in row)
    return f"{OUTSIDE} {OF_MARK}" if there else ""


OF_MARK = "The friction law is out of its range there: its figures are extrapolations."


def is_swept(name: str, data: xr.Dataset) -> bool:
    """True for a part that is a sweep of the command line."""
    return name.startswith("study_sweep_") and "axis" in data


def swept_place(data: xr.Dataset, point: int) -> dict[str, str]:
    """The key of a sweep with its value at a point, as case files write it."""
    key = str(data.attrs["sweep_key"])
    return {key: _place(data["axis"].values[point], key)}


def swept_rows(data: xr.Dataset) -> list[dict[str, str]]:
    """A sweep point by point, under each friction law; without loss nothing of it."""
    return [
        _swept_row(data, law, point)
        for point in range(data.sizes["point"])
        for law in range(data.sizes["law"])
    ]


def _swept_row(data: xr.Dataset, law: int, point: int) -> dict[str, str]:
    names = CONTACT if of_contact(data) else (*SWEPT, *_of_strength([data], vary=True))
    if idle := all(_lossless(data, law_number) for law_number in range(data.sizes["law"])):
        names = tuple(name for name in names if name not in _OF_LOSS)
    cells = {
        head(n, data): marked(
            n, _endless(n, value) or screen_value(n, value, data), data, law, point
        )
        for n, value in ((n, float(data[n].values[law, point])) for n in names if n in data)
    }
    efficiency = {} if idle else efficiency_of(data)
    return {
        **swept_place(data, point),
        "friction law": str(data["law"].values[law]),
        **cells,
        **efficiency,
    }


def _place(value: float, key: str) -> str:
    """Place on the axis of a sweep as case files write it."""
    quantity = quantity_at(key)
    return f"{value:.6g}" if quantity is None else quantity_text(float(value), quantity)


def _lacks(page: section.Page) -> str | None:
    there = any(is_study(name) for outcome in page.outcomes.values() for name in outcome.parts)
    return None if there else ""


STUDIES = section.Section(
    name="studies",
    title="Studies",
    short="Studies",
    order=600.0,
    lacks=_lacks,
    blocks=_blocks,
    screen=_screen,
)
