"""The first screen of an optimiser: the aim as given and at best, keys, limits and what they cost."""

import shlex
from collections.abc import Iterator
from typing import Any

from pitchpoint.cases.record import CASE
from pitchpoint.errors import shorten
from pitchpoint.registry import enumerated
from pitchpoint.results.store import without_nan
from pitchpoint.runs.optimise import Optimum
from pitchpoint.runs.optimum_search import AT_LIMIT
from pitchpoint.runs.optimum_task import DESIGNS_FILE, ResultLimit, VariedKey
from pitchpoint.runs.sought_figures import SoughtFigure
from pitchpoint.views.columns import lines_of
from pitchpoint.views.first_screen import Line, lines_within, wrapped

__all__ = ["optimum_as_json", "optimum_screen"]

_COLUMNS = ("", "as given", "best", "limit")
_MOST_DOUBTS, _MOST_REASONS = 3, 2
PART = 0.01
"""Of a bound or a range by which a limit moves where its cost is told."""


def optimum_screen(optimum: Optimum, width: int) -> list[Line]:
    """Lines of the screen.

    Args:
        optimum: of a case.
        width: of the screen [characters].
    """
    head = [Line(text, "title") for text in wrapped(_answer(optimum), width)]
    if optimum.interrupted:
        told = "The search was ended by hand: this is the best design so far, and no optimum."
        head += [Line(text, "doubt") for text in wrapped(told, width)]
    rows = [*_key_rows(optimum), *_figure_rows(optimum)]
    table = [Line(text, "figure") for text in lines_of(rows, _COLUMNS, width)]
    doubts = [
        Line(text, "doubt")
        for warning in optimum.warnings[:_MOST_DOUBTS]
        for text in lines_within(f"! {warning}", width, 2)
    ]
    foot = [Line(text, "note") for told in _foot(optimum) for text in lines_within(told, width, 3)]
    return [*head, *table, *doubts, *foot]


def optimum_as_json(optimum: Optimum) -> dict[str, Any]:
    """The same in SI."""
    plain = {
        "case": optimum.title,
        "aim": optimum.aim.name,
        "unit": optimum.aim.quantity.unit,
        "largest": optimum.largest,
        "law": optimum.law,
        "as_given": dict(optimum.start),
        "best": dict(optimum.best),
        "ranges": {one.key: [one.low, one.high] for one in optimum.varied},
        "lists": {key: [*values] for key, values in optimum.listed.items()},
        "limits": [
            {
                "limit": limit.text,
                "bound": limit.bound,
                "active": optimum.active(limit),
                "cost_of_its_bound": _cost(optimum, number),
            }
            for number, limit in enumerate(optimum.limits)
        ],
        "derivatives": {"automatic": [*optimum.derived]},
        "designs": optimum.designs,
        "refused": optimum.refused,
        "reasons": dict(optimum.reasons),
        "interrupted": optimum.interrupted,
        "warnings": [*optimum.warnings],
        "folder": None if optimum.folder is None else str(optimum.folder),
    }
    return dict(without_nan(plain))


def _cost(optimum: Optimum, number: int) -> float | None:
    """Change of the aim to the worse for the whole bound of a limit [SI]."""
    return None if optimum.multipliers is None else float(optimum.multipliers.constraints[number])


def _answer(optimum: Optimum) -> str:
    which = "Largest" if optimum.largest else "Least"
    aim = optimum.aim
    start = float(optimum.start[aim.name])
    told = f"{which} {aim.quantity.long_name}: {aim.told(optimum.value)}"
    if start != start:
        return told
    change = f" ({100.0 * (optimum.value / start - 1.0):+.3g} %)" if start else ""
    missed = [limit.text for limit in optimum.limits if not optimum.kept_as_given(limit)]
    outside = f", outside of {enumerated(missed)}" if missed else ""
    return f"{told}, as given {aim.told(start)}{outside}{change}"


def _key_rows(optimum: Optimum) -> Iterator[dict[str, str]]:
    for number, varied in enumerate(optimum.varied):
        quantity = varied.axis.quantity
        assert quantity is not None
        given = optimum.start[varied.key]
        yield {
            "": varied.key,
            "as given": "-" if given is None else quantity.show(given),
            "best": quantity.show(float(optimum.best[varied.key])),
            "limit": _range_words(optimum, varied, number),
        }
    for key, values in optimum.listed.items():
        start, best = (
            f"{value:g}" if isinstance(value, float) else "-" if value is None else str(value)
            for value in (optimum.start[key], optimum.best[key])
        )
        yield {"": key, "as given": start, "best": best, "limit": f"{len(values)} values tried"}


def _range_words(optimum: Optimum, varied: VariedKey, number: int) -> str:
    quantity = varied.axis.quantity
    assert quantity is not None
    unit = "" if quantity.unit == "1" else f" {quantity.unit}"
    low = quantity.show(varied.low).removesuffix(unit)
    words = f"{low} to {quantity.show(varied.high)}"
    share = optimum.share(varied)
    if AT_LIMIT < share < 1.0 - AT_LIMIT:
        return words
    cost = None if optimum.multipliers is None else float(optimum.multipliers.ends[number])
    end, way = ("least", "lower") if share < 0.5 else ("largest", "higher")
    return f"{words}, at its {end}{_saved(optimum, cost, f'of that range {way}')}"


def _figure_rows(optimum: Optimum) -> Iterator[dict[str, str]]:
    figures: dict[str, SoughtFigure] = {optimum.aim.name: optimum.aim}
    figures |= {limit.figure.name: limit.figure for limit in optimum.limits}
    for name, figure in figures.items():
        limits = [
            _limit_words(optimum, limit, number)
            for number, limit in enumerate(optimum.limits)
            if limit.figure.name == name
        ]
        aim = [("largest" if optimum.largest else "least") + " wanted"] * (name == optimum.aim.name)
        start = float(optimum.start[name])
        yield {
            "": name,
            "as given": "-" if start != start else figure.told(start),
            "best": figure.told(float(optimum.best[name])),
            "limit": "; ".join([*aim, *limits]),
        }


def _limit_words(optimum: Optimum, limit: ResultLimit, number: int) -> str:
    words = f"{limit.way} {limit.figure.told(limit.bound)}"
    if not optimum.active(limit):
        return words
    if limit.way == "=":
        return words
    way = "less" if limit.way == ">=" else "more"
    return f"{words}, active{_saved(optimum, _cost(optimum, number), way)}"


def _saved(optimum: Optimum, cost: float | None, of: str) -> str:
    """What moving an active limit by a hundredth changes of the aim; nothing where that is not known."""
    if not cost:
        return ""
    here, quantity = optimum.value, optimum.aim.quantity
    change = quantity.displayed(here + PART * cost) - quantity.displayed(here)
    gain = "gains" if optimum.largest else "saves"
    return f": {100.0 * PART:g} % {of} {gain} {abs(change):.3g}{optimum.aim.unit}"


def _foot(optimum: Optimum) -> Iterator[str]:
    reasons = [
        f"{count}: {shorten(why.partition(';')[0], 120)}"
        for why, count in [*optimum.reasons.items()][:_MOST_REASONS]
    ]
    without = f", {optimum.refused} without figures ({'; '.join(reasons)})" if reasons else ""
    yield f"{optimum.designs} designs computed{without}; the best is as a run of its case has it."
    if optimum.varied:
        by_differences = "differences" + (" for the others" if optimum.derived else "")
        automatic = (
            f"automatic differentiation of {enumerated(optimum.derived)}, "
            if optimum.derived
            else ""
        )
        yield f"SLSQP from several designs; derivatives by {automatic}{by_differences}."
    if optimum.folder is not None:
        if (optimum.folder / CASE).is_file():  # there is none under a law of one's own
            yield f"Case: pitchpoint run {shlex.quote(str(optimum.folder / CASE))}"
        yield f"Every design: {optimum.folder / DESIGNS_FILE}"
    else:
        yield "-o FOLDER writes the design as a case file."
