"""The page of a study: its answer, its designs to be brushed, a front, and which inputs matter."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from pathlib import Path
from shlex import quote
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float, Int

from pitchpoint._jax import double_precision
from pitchpoint.cases.handed_over import write_case_copy
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.record import CASE
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.results.rounding import ROUNDING
from pitchpoint.results.store import write_text
from pitchpoint.runs.case import Case
from pitchpoint.runs.rank_correlation import FEWEST_RANKED, main_effect, rank_correlations
from pitchpoint.runs.sensitivity import indices_of_study
from pitchpoint.runs.tolerances import with_tolerances
from pitchpoint.sizing.front import non_dominated
from pitchpoint.views import show
from pitchpoint.views.designs_page import (
    Better,
    DesignColumn,
    DesignsPage,
    InfluenceBar,
    Influences,
    render_designs,
)
from pitchpoint.views.many_designs import SHOWN
from pitchpoint.views.section import Block, Paragraph, SectionTable

__all__ = [
    "MOST_DRAWN",
    "demand_study_folder",
    "render_study",
    "spread_evenly",
    "write_study_folder",
]

MOST_DRAWN = 5000
"""Designs that a page draws, beside those on the fronts."""

MOST_NUMBERS = 400_000
"""Numbers that a page holds, which keeps it within 3 MB."""

TOGETHER_READ = 65_536
"""Designs that are read together."""

_BETTER: Mapping[str, Better] = {
    "circumferential_backlash": "less",
    "transmission_error_range": "less",
    "mean_efficiency": "more",
    "mean_loss": "less",
    "torque_ripple": "less",
    "min_lambda_ratio": "more",
    "largest_contact_stress": "less",
    "largest_root_stress": "less",
    "least_flank_safety": "more",
    "least_root_safety": "more",
}
"""What is good of the figures that are told first."""

_AIMS = 6
"""Figures of which each two have their front among all designs worked out."""

_MOST_OF_FRONT = 300
"""Designs that are drawn of a front."""

_AXES = 8
"""Axes that are shown before somebody chooses."""

_OF_SOLUTIONS = ("residual", "nearest_friction", "nearest_jamming_coefficient")
"""Figures that tell how a solution was found."""

_PERCENTILES = (0.01, 0.1, 0.5, 0.9, 0.99)

_MOST_REASONS = 8

_ON_FRONT = 12
"""Designs of a front that the table without a script has."""


def spread_evenly(count: int, most: int) -> Int[np.ndarray, " _"]:
    """Numbers of at most so many of some designs, spread evenly over their order without chance.

    They go in steps of the golden section, so that they meet all values of a grid whose values come again in
    even steps.

    Args:
        count: of designs.
        most: of those that are taken.

    Example:
        >>> spread_evenly(4, 9).tolist(), len(spread_evenly(1_000_000, 5000))
        ([0, 1, 2, 3], 5000)
    """
    if count <= most:
        return np.arange(count)
    return np.unique(np.floor(np.modf(np.arange(most) * _GOLDEN)[0] * count).astype(int))


_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


@dataclass(frozen=True)
class _Designs:
    """Designs of a study by their number, read from wherever they are."""

    study: xr.Dataset

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Dimensions along which designs lie."""
        sizes = self.study["reason"].sizes
        return {str(name): size for name, size in sizes.items() if name != "law"}

    @cached_property
    def count(self) -> int:
        return int(np.prod([*self.sizes.values()]))

    @cached_property
    def layout(self) -> dict[str, Any]:
        return dict(json.loads(self.study.attrs["layout"]))

    @cached_property
    def laws(self) -> list[str]:
        return [str(law) for law in self.study["law"].values]

    @cached_property
    def figures(self) -> list[str]:
        """Names of what has a number for every design, those that are told first in front."""
        dims = {*self.sizes}
        names = [
            str(name)
            for name, data in self.study.data_vars.items()
            if data.dtype.kind == "f"
            and {*map(str, data.dims)} - {"law"} == dims
            and name not in _OF_SOLUTIONS
        ]
        rank = {name: place for place, name in enumerate(SHOWN)}
        return sorted(names, key=lambda name: rank.get(name, len(rank)))

    def read(self, name: str, law: int, numbers: Int[np.ndarray, " _"]) -> np.ndarray:
        """Values of some designs."""
        if name in self.sizes:
            places = np.unravel_index(numbers, [*self.sizes.values()])
            return np.asarray(self.study[name].values)[places[[*self.sizes].index(name)]]
        data = self.study[name].reset_coords(drop=True)
        data = data.isel(law=law) if "law" in data.dims else data
        if len(self.sizes) == 1:
            return np.asarray(data.isel({next(iter(self.sizes)): numbers}).values)
        places = np.unravel_index(numbers, [*self.sizes.values()])
        at = {
            key: xr.DataArray(place, dims="row")
            for key, place in zip(self.sizes, places, strict=True)
        }
        return np.asarray(data.isel(at).values)

    def blocks(self) -> Iterator[Int[np.ndarray, " _"]]:
        """Numbers of all designs, some thousands at a time."""
        for first in range(0, self.count, TOGETHER_READ):
            yield np.arange(first, min(first + TOGETHER_READ, self.count))

    def column(self, name: str, law: int) -> Float[np.ndarray, " design"]:
        """Values of all designs."""
        return np.concatenate([self.read(name, law, block) for block in self.blocks()])

    def title(self, name: str) -> str:
        """Words of a quantity with its unit."""
        unit = self.unit(name)
        return f"{self.words(name)} [{unit}]" if unit else self.words(name)

    def words(self, name: str) -> str:
        is_key = name in self.layout["keys"]
        return name if is_key else str(self.study[name].attrs.get("long_name", name))

    def unit(self, name: str) -> str:
        return show.display_unit(str(self.study[name].attrs.get("units", "1")))


def render_study(study: xr.Dataset, *, case_file: Path | None = None) -> str:
    """The page of a study as text.

    Args:
        study: as `pitchpoint.study` gives it, best with units = "shown"; values on disk are read some
            thousands at a time, and one figure of all designs is in memory at once.
        case_file: of the case that its designs are changes of, for the command that computes one of them.
    """
    return render_designs(_Summed(_Designs(study), case_file).page)


_HEAD = "The case of a study: its designs are this case with some keys set."
"""First line of the case in a folder of a study, which tells it from a case that somebody wrote."""


def demand_study_folder(folder: Path, case: str) -> None:
    """InputError for a folder whose case file is that of the study itself, or not one that a study wrote.

    Args:
        folder: of the pieces of the study.
        case: file or name of the case that is studied.
    """
    path = folder / CASE
    if not path.is_file():
        return
    with path.open("rb") as file:
        written = file.read(len(_HEAD) + 2) == f"# {_HEAD}".encode()
    if not written or (Path(case).is_file() and path.samefile(case)):
        raise InputError(
            f"{shown(str(folder))} holds a {CASE} that the study would replace; give a folder without one",
            key="folder",
        )


@double_precision()
def write_study_folder(study: xr.Dataset, case: Case, folder: Path) -> None:
    """Write the page of a study into its folder, and the case that its designs are changes of.

    Args:
        study: in the units in which it is shown.
        case: that was studied; its tolerances are set as the study had them.
        folder: of its pieces.

    Raises:
        OSError: the disk is full, say.
    """
    variant, tolerances = case.held[0], str(study.attrs["tolerances"])
    if tolerances:
        variant, _ = with_tolerances(variant, tolerances)
    document = variant.document()
    tree = {key: table for key, table in document.tree.items() if key != "study"}
    write_case_copy(replace(document, tree=tree), folder, head=_HEAD)
    write_text(folder / "report.html", render_study(study, case_file=folder / CASE))


@dataclass(frozen=True)
class _Summed:
    """A study summed up for its page."""

    designs: _Designs
    case_file: Path | None
    _by_law: dict[str, int] = field(default_factory=dict)

    @cached_property
    def spans(self) -> dict[tuple[str, int], dict[str, Any]]:
        """By main figure and law what all designs reach; none of what does not vary."""
        return dict(self._spans())

    def _spans(self) -> Iterator[tuple[tuple[str, int], dict[str, Any]]]:
        for name in filter(_BETTER.get, self.designs.figures):
            for law in range(self._laws_of(name)):
                values = self.designs.column(name, law)
                there = np.flatnonzero(np.isfinite(values))
                if _varies(values[there]):
                    finite = values[there]
                    ends = {"less": there[finite.argmin()], "more": there[finite.argmax()]}
                    quantiles = np.quantile(finite, [0.0, *_PERCENTILES, 1.0])
                    yield (name, law), {"quantiles": quantiles, "ends": ends}

    def _laws_of(self, name: str) -> int:
        """How many laws have a value of their own; one where all have the same."""
        if name not in self._by_law:
            self._by_law[name] = len(self.designs.laws) if self._differs(name) else 1
        return self._by_law[name]

    def _differs(self, name: str) -> bool:
        """True for a figure that is another one under another law."""
        if "law" not in self.designs.study[name].dims or len(self.designs.laws) < 2:
            return False
        return any(
            not np.allclose(self.designs.read(name, law, block), first, 1e-9, 0.0, equal_nan=True)
            for block in self.designs.blocks()
            for first in [self.designs.read(name, 0, block)]
            for law in range(1, len(self.designs.laws))
        )

    @cached_property
    def main(self) -> list[str]:
        """Names of the figures that are told first and vary under some law."""
        return [*dict.fromkeys(name for name, _ in self.spans)]

    @cached_property
    def keys(self) -> list[str]:
        return [str(key) for key in self.designs.layout["keys"]]

    @cached_property
    def with_figures(self) -> Bool[np.ndarray, " design"]:
        """True for designs that have figures under some law."""
        name = next(iter(self.main), next(iter(self.designs.figures), None))
        if name is None:
            return np.ones(self.designs.count, bool)
        there = np.zeros(self.designs.count, bool)
        for law in range(self._laws_of(name)):
            there |= np.isfinite(self.designs.column(name, law))
        return there

    @cached_property
    def even(self) -> Int[np.ndarray, " _"]:
        """Numbers of the designs that stand for all that have figures."""
        numbers = np.flatnonzero(self.with_figures)
        return np.asarray(numbers[spread_evenly(len(numbers), self.most_even)])

    @cached_property
    def most(self) -> int:
        """Designs that a page has room for."""
        columns = len(self.keys) * 3 + len(self.designs.figures) * len(self.designs.laws)
        return MOST_NUMBERS // columns

    @property
    def most_even(self) -> int:
        """Designs of the even choice."""
        return min(MOST_DRAWN, self.most // 2)

    @cached_property
    def fronts(self) -> dict[tuple[str, str, int], Int[np.ndarray, " _"]]:
        """Numbers of the designs on the front of each two of the main figures by law, from end to end."""
        few = self.main[:_AIMS]
        costs: dict[tuple[str, str, int], tuple[np.ndarray, np.ndarray]] = {}
        for block in self.designs.blocks():
            for law in range(len(self.designs.laws)):
                values = {name: self._cost(name, law, block) for name in few}
                for pair in combinations(few, 2):
                    before = costs.get((*pair, law), (np.zeros(0, int), np.zeros((0, 2))))
                    now = np.stack([values[name] for name in pair], axis=1)
                    there = np.isfinite(now).all(axis=1)
                    every = np.concatenate([before[1], now[there]])
                    on = non_dominated(every)
                    numbers = np.concatenate([before[0], block[there]])
                    costs[*pair, law] = numbers[on], every[on]
        return {key: numbers[np.argsort(every[:, 0])] for key, (numbers, every) in costs.items()}

    def _cost(self, name: str, law: int, block: Int[np.ndarray, " _"]) -> np.ndarray:
        values = self.designs.read(name, law if self._laws_of(name) > 1 else 0, block)
        return -values if _BETTER[name] == "more" else values

    @cached_property
    def drawn(self) -> Int[np.ndarray, " _"]:
        """Numbers of the designs that are drawn: an even choice, the best ones, and fronts."""
        ends = [number for span in self.spans.values() for number in span["ends"].values()]
        return np.unique(np.concatenate([self.even, ends, *self.fronts_drawn.values()]).astype(int))

    @cached_property
    def most_of_front(self) -> int:
        """Designs that are drawn of a front, so that all fronts have no more than the even choice leaves."""
        left = (self.most - self.most_even) // max(1, len(self.fronts))
        return min(_MOST_OF_FRONT, max(2, left))

    @cached_property
    def fronts_drawn(self) -> dict[tuple[str, str, int], Int[np.ndarray, " _"]]:
        """Of each front the designs that are drawn, its ends among them."""
        return {key: self._thinned(numbers) for key, numbers in self.fronts.items()}

    def _thinned(self, front: Int[np.ndarray, " _"]) -> Int[np.ndarray, " _"]:
        if len(front) <= self.most_of_front:
            return front
        return np.asarray(front[np.linspace(0, len(front) - 1, self.most_of_front).astype(int)])

    @cached_property
    def aims(self) -> tuple[str, str]:
        """Two columns whose front is shown first: the main figures that are most at odds."""
        of_first_law = {
            pair[:2]: len(numbers) for pair, numbers in self.fronts.items() if not pair[2]
        }
        if of_first_law:
            return max(of_first_law, key=lambda pair: of_first_law[pair])
        numbers = [*self.columns][len(self.keys) :] or self.keys
        return numbers[0], numbers[min(1, len(numbers) - 1)]

    @cached_property
    def numeric_keys(self) -> list[str]:
        return [key for key in self.keys if self.designs.study[key].dtype.kind in "fiu"]

    @cached_property
    def page(self) -> DesignsPage:
        axes = [*dict.fromkeys([*self.keys[: _AXES - 2], *self.columns])][:_AXES]
        attributes = self.designs.study.attrs
        tolerances, case = bool(attributes.get("tolerances")), attributes.get("case", "a case")
        effects, bars, words = self._influence()
        counted = _several(self.designs.count, "design")
        return DesignsPage(
            title=f"{counted} of {case}{' within its tolerances' * tolerances}",
            summary=self._summary(),
            answer=[*self._answer(tolerances=tolerances)],
            columns=[*self.columns.values()],
            labels=self.drawn.tolist(),
            drawn=self._drawn_words(),
            axes=axes,
            colour=next(iter(self.main), axes[-1]),
            aims=self.aims,
            front=[self._front()],
            front_words=self._front_words(),
            opening=self._opening(),
            opening_words=[Paragraph(self._opening_words())],
            laws=[FRICTION[law].title if law in FRICTION else law for law in self.designs.laws],
            influences=bars,
            influence_words=words,
            effects=effects,
        )

    @cached_property
    def columns(self) -> dict[str, DesignColumn]:
        """Quantities of the designs that are drawn, by name: inputs, then figures that vary."""
        return {column.name: column for column in self._columns()}

    def _columns(self) -> Iterator[DesignColumn]:
        for key in self.keys:
            values = self.designs.read(key, 0, self.drawn)
            attributes = self.designs.study[key].attrs
            levels: list[str] = []
            if values.dtype.kind not in "fiu":
                names, values = np.unique(values.astype(str), return_inverse=True)
                levels = names.tolist()
            yield DesignColumn(
                name=key,
                words=key,
                unit=self.designs.unit(key),
                values=np.asarray(values, float)[None],
                levels=levels,
                is_input=True,
                unit_written=str(attributes.get("units", "")),
            )
        for name in self.designs.figures:
            rows = [self.designs.read(name, law, self.drawn) for law in range(self._laws_of(name))]
            if any(map(_varies, rows)):
                yield DesignColumn(
                    name=name,
                    words=self.designs.words(name),
                    unit=self.designs.unit(name),
                    values=np.stack(rows),
                    better=_BETTER.get(name, ""),
                )

    def _summary(self) -> str:
        reasons: dict[str, int] = json.loads(self.designs.study.attrs["reasons"])
        without = sum(reasons.values())
        over = f"{_several(self.designs.count, 'design')} over {_several(len(self.keys), 'key')}"
        computed = f"{over}, {self.designs.count - without} of them with figures"
        if not self.main:
            return f"{computed}."
        name, law = next(iter(self.spans))
        unit, words = self.designs.unit(name), self.designs.words(name)
        if self._laws_of(name) > 1:
            words = f"{words} by {self.designs.laws[law]}"
        if self.designs.study.attrs.get("tolerances"):
            _, low, *_, high, _ = self.spans[name, law]["quantiles"]
            ends = f"{show.number_text(float(low), 5)} to {show.number_text(float(high), 5)} {unit}".rstrip()
            return f"{computed}; {words}: {ends} of 98 in 100."
        value, _, place = self._best(name, law)
        with_unit = f"{value} {unit}".rstrip()
        return f"{computed}; the {_BEST[_BETTER[name]]} {words} is {with_unit}, of design {place}."

    def _best(self, name: str, law: int) -> tuple[str, float, int]:
        """Best value of a figure in words and as a number, and the design that has it."""
        span = self.spans[name, law]
        sense = _BETTER[name]
        value = float(span["quantiles"][0 if sense == "less" else -1])
        return show.number_text(value, 5), value, int(span["ends"][sense])

    def _answer(self, *, tolerances: bool) -> Iterator[Block]:
        attributes = self.designs.study.attrs
        for warning in json.loads(str(attributes.get("warnings", "[]"))):
            yield Paragraph(show.sentence(show.pretty(str(warning))), "warning")
        several = len(self.designs.laws) > 1
        if tolerances:
            head = ["figure", *(["friction law"] if several else [])]
            ends = ["least", *(f"{100.0 * share:g} %" for share in _PERCENTILES), "largest"]
            rows = [
                [
                    self.designs.title(name),
                    *([self._law_words(name, law)] if several else []),
                    *cells,
                ]
                for (name, law), span in self.spans.items()
                if name in self.main
                for cells in [[show.number_text(float(value), 5) for value in span["quantiles"]]]
            ]
            caption = "Figures that so many of 100 designs lie below"
            yield SectionTable([*head, *ends], rows, caption=caption, names=len(head), wide=True)
        else:
            yield from self._best_table(several=several)
        yield SectionTable(["key", "from", "to"], [*self._ranges()], True, "Keys that were varied")
        yield from self._without()

    def _law_words(self, name: str, law: int) -> str:
        return self.designs.laws[law] if self._laws_of(name) > 1 else "all"

    def _best_table(self, *, several: bool) -> Iterator[Block]:
        rows = [
            [
                self.designs.title(name),
                *([self._law_words(name, law)] if several else []),
                _BEST[_BETTER[name]],
                value,
                str(number),
                *(self._cell(key, number) for key in self.keys),
            ]
            for name, law in self.spans
            if name in self.main
            for value, _, number in [self._best(name, law)]
        ]
        head = ["figure", *(["friction law"] if several else []), "best is", "value", "design"]
        keys = map(self.designs.title, self.keys)
        if rows:
            caption = "The best design by each figure, with its inputs"
            yield SectionTable(
                [*head, *keys], rows, caption=caption, wide=True, names=len(head) - 2
            )

    def _cell(self, name: str, number: int, law: int = 0) -> str:
        """What a table has of a design."""
        law = law if name not in self.keys and self._laws_of(name) > 1 else 0
        value = self.designs.read(name, law, np.array([number]))[0]
        return (
            show.number_text(float(value), 5)
            if np.asarray(value).dtype.kind in "fiu"
            else str(value)
        )

    def _ranges(self) -> Iterator[list[str]]:
        for key in self.keys:
            if key in self.numeric_keys:
                parts = [self.designs.read(key, 0, block) for block in self.designs.blocks()]
                low, high = min(p.min() for p in parts), max(p.max() for p in parts)
                yield [
                    self.designs.title(key),
                    *(show.number_text(float(end), 5) for end in (low, high)),
                ]
            else:
                names = np.unique(self.designs.study[key].values.astype(str))
                yield [self.designs.title(key), ", ".join(names.tolist()), ""]

    def _without(self) -> Iterator[Block]:
        reasons: dict[str, int] = json.loads(self.designs.study.attrs["reasons"])
        if reasons:
            rows = [
                [str(count), show.pretty(why)] for why, count in [*reasons.items()][:_MOST_REASONS]
            ]
            caption = (
                f"{sum(reasons.values())} designs without figures, by the first reason of each kind"
            )
            yield SectionTable(["designs", "why"], rows, caption=caption, names=2)

    def _drawn_words(self) -> str:
        every, drawn = int(self.with_figures.sum()), len(self.drawn)
        if drawn == every:
            return f"All {every} designs with figures are drawn."
        return (
            f"{drawn} of {every} designs with figures are drawn: spread evenly without chance, and those "
            "that are the best by a figure or on the front of two main figures. Counts below are of those "
            "drawn; the tables of the answer are of all."
        )

    def _front_words(self) -> str:
        few = [self.designs.words(name) for name in self.main[:_AIMS]]
        words = "The front has the designs that no other one beats in both results"
        if len(self.drawn) == int(self.with_figures.sum()) or len(few) < 2:
            return f"{words}."
        words += f": of each two of {', '.join(few)} among all designs, else among those drawn."
        most = self.most_of_front
        if max(map(len, self.fronts.values())) <= most:
            return words
        return (
            f"{words} Of a front with more than {most} designs, {most} are drawn, evenly from end to end; "
            "designs next to it may then stand on it."
        )

    def _front(self) -> SectionTable:
        """The front that is shown first, under the first law."""
        order = self.fronts.get((*self.aims, 0), np.zeros(0, int))
        few = order[:: max(1, -(-len(order) // _ON_FRONT))]
        names = [*self.aims, *self.keys]
        rows = [[str(number), *(self._cell(name, number) for name in names)] for number in few]
        head = ["design", *map(self.designs.title, names)]
        return SectionTable(head, rows, caption="Designs on the front", wide=True)

    def _opening(self) -> dict[str, Any]:
        at = 0
        if self.main:
            at = int(np.searchsorted(self.drawn, self._best(*next(iter(self.spans)))[2]))
        if self.case_file is not None:
            return {"command": f"pitchpoint run {quote(str(self.case_file))}", "at": at}
        tolerances = self.designs.study.attrs.get("tolerances")
        return {"at": at} if tolerances else {"call": "case.set", "at": at}

    def _opening_words(self) -> str:
        if self.case_file is not None:
            return (
                f"Every design is the case `{self.case_file}` with its inputs set; this command computes it "
                "with all its parts and its report."
            )
        if self.designs.study.attrs.get("tolerances"):
            return (
                "Designs are changes of the gears of the case, with its tip circles and profile shifts; "
                "`pitchpoint study` writes that case beside its page."
            )
        return "Every design is the case of the study with its inputs set, which `pitchpoint.run` computes."

    def _influence(self) -> tuple[list[dict[str, Any]], list[Influences], list[Block]]:
        """Main effects for the script, bars, and what they are."""
        how = self.designs.layout["how"]
        if how == "saltelli" and self.main:
            bars, words = self._sobol()
        elif how == "zip" and len(self.keys) > 1:
            words = "Values of the keys go together in this study: no figure can be put down to one of them."
            return [], [], [Paragraph(words)]
        else:
            bars, words = self._ranked()
        effects = self._effects() if len(self.even) >= FEWEST_RANKED else []
        return effects, bars, [Paragraph(words)]

    def _sobol(self) -> tuple[list[Influences], str]:
        figures = [
            name
            for name in self.main
            if all(self._as_many(name, law) for law in range(self._laws_of(name)))
        ]
        indices = indices_of_study(self.designs.study, figures)
        bars = [
            Influences(
                self._figure_title(figure, law),
                [
                    _index(indices.sel(figure=figure, law=law, key=key), key, name, words)
                    for key in self.keys
                    for name, words in (("first_order", "alone"), ("total_order", "with others"))
                ],
                0.0,
            )
            for figure in figures
            for law in self.designs.laws[: self._laws_of(figure)]
        ]
        used, asked = indices.attrs["designs"], indices.attrs["asked"]
        return bars, (
            "Sobol' indices: the part of the variance of a figure that a key has alone, and with others, "
            f"from {used} of {asked} designs of each sample. In brackets, and as a dark line, bounds in "
            "which 95 of 100 resampled indices lie."
        )

    def _as_many(self, name: str, law: int) -> bool:
        """True for a figure that all designs with figures have."""
        there = np.isfinite(self.designs.column(name, law))
        return bool(np.array_equal(there, self.with_figures))

    def _figure_title(self, figure: str, law: str) -> str:
        words = self.designs.words(figure)
        return words if self._laws_of(figure) < 2 else f"{words}, {law}"

    def _ranked(self) -> tuple[list[Influences], str]:
        if len(self.even) < FEWEST_RANKED or not self.numeric_keys or not self.main:
            return (
                [],
                f"Fewer than {FEWEST_RANKED} designs with figures tell nothing of single inputs.",
            )
        inputs = np.stack([self._of_even(key) for key in self.numeric_keys])
        bars = []
        for name in self.main:
            for law in range(self._laws_of(name)):
                ranked = rank_correlations(inputs, self._of_even(name, law)[None])[0]
                rows = [
                    InfluenceBar(key, 0.0 if np.isnan(r) else float(r), _signed(float(r)))
                    for key, r in zip(self.numeric_keys, ranked, strict=True)
                ]
                title = self._figure_title(name, self.designs.laws[law])
                bars.append(Influences(title, rows, -1.0))
        chance = 1.96 / np.sqrt(len(self.even) - 1.0)
        return bars, (
            "Spearman's rank correlation: 1 where a figure rises with a key throughout, −1 where it falls, "
            "near 0 where it hardly hangs on it, or rises and falls again. Of "
            f"{len(self.even)} designs those within ±{show.number_text(float(chance), 2)} may be "
            "chance. Parts of "
            'the variance, Sobol\' indices, need `how = "saltelli"`.'
        )

    def _of_even(self, name: str, law: int = 0) -> Float[np.ndarray, " design"]:
        """Values of the designs that stand for all, of names their places among the levels."""
        rows = self.columns[name].values
        return np.asarray(rows[min(law, len(rows) - 1)][np.searchsorted(self.drawn, self.even)])

    def _effects(self) -> list[dict[str, Any]]:
        return [
            {
                name: {
                    key: _rows_of(self._of_even(key), result)
                    for key in self.keys
                    if np.isfinite(result).any()
                }
                for name in self.main
                for result in [self._of_even(name, law)]
            }
            for law in range(len(self.designs.laws))
        ]


def _varies(values: np.ndarray) -> bool:
    """True for values that differ by more than rounding."""
    finite = values[np.isfinite(values)]
    size = float(np.abs(finite).max(initial=0.0))
    return finite.size > 0 and float(np.ptp(finite)) > max(ROUNDING * size, show.NOISE)


def _several(count: int, words: str) -> str:
    return f"{count} {words}{'s' * (count != 1)}"


_BEST = {"less": "lowest", "more": "highest"}


def _rows_of(values: np.ndarray, result: np.ndarray) -> list[list[float]]:
    effect = main_effect(values, result)
    every = np.stack([effect.place, effect.median, effect.low, effect.high], axis=1)
    return [[float(f"{value:.6g}") for value in row] for row in every]


def _signed(value: float) -> str:
    return "does not vary" if np.isnan(value) else show.signed(value, 2)


def _index(index: xr.Dataset, key: str, name: str, words: str) -> InfluenceBar:
    value, low, high = (float(index[f"{name}{end}"]) for end in ("", "_low", "_high"))
    label = f"{key}, {words}"
    if np.isnan(value):
        return InfluenceBar(label, 0.0, "does not vary")
    clipped = [min(max(part, 0.0), 1.0) for part in (value, low, high)]
    return InfluenceBar(label, clipped[0], f"{value:.2f} ({low:.2f}, {high:.2f})", *clipped[1:])
