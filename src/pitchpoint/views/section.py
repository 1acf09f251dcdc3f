"""The contract of a section of the report and the screen: what it shows, what it lacks, its words."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import zip_longest
from math import isfinite, nan
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from pitchpoint.core.programs import surroundings
from pitchpoint.registry import Deferred, code_at, enumerated
from pitchpoint.results.by_stage import Label, of_stage, stages_of
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views.figures import Curves, Panel, curves
from pitchpoint.views.point import by_bodies, by_members

if TYPE_CHECKING:
    import xarray as xr
    from markupsafe import Markup

__all__ = [
    "OF_MESHES",
    "Animation",
    "Block",
    "Drawn",
    "Folded",
    "Heading",
    "KeyFigure",
    "Page",
    "Paragraph",
    "Printed",
    "Section",
    "SectionTable",
    "Variants",
    "blocks_by_variant",
    "by_mesh",
    "figures_by_members",
    "key_figure",
    "key_figures",
    "made_of",
    "naming",
    "of_meshes",
    "of_part",
    "of_published",
    "of_rows",
    "of_source",
    "of_trains",
    "page_words",
    "panels",
    "reason",
    "stages_together",
    "tabbed",
    "transposed_table",
    "variant_warnings",
    "without_rows",
    "without_trains",
]

Made = TypeVar("Made")


@dataclass(frozen=True)
class Heading:
    """A heading inside a section."""

    words: "str | Markup"
    block: ClassVar[str] = "heading"


@dataclass(frozen=True)
class Paragraph:
    """A paragraph; `kind` is empty, "note" or "warning"."""

    words: "str | Markup"
    kind: str = ""
    block: ClassVar[str] = "paragraph"


@dataclass(frozen=True)
class SectionTable:
    """A table: names in the first columns, one of them unless `names` says how many, numbers in the others.

    Its caption is the heading above it unless it has one of its own. A wide one keeps its numbers whole and
    scrolls sideways under its first column. A caption that repeats the heading is for ears alone.
    """

    head: Sequence[str]
    rows: Iterable[Sequence[str]]
    compact: bool = False
    caption: str = ""
    wide: bool = False
    repeats: bool = False
    names: int = 1
    block: ClassVar[str] = "table"


_ACROSS = 4
"""Columns of numbers that stand on a narrow screen; a table of more is wide."""


def transposed_table(
    heads: Sequence[str], columns: Sequence[Sequence[str]], first: str = ""
) -> SectionTable:
    """A table of a few things with many figures each, which stand under each other: it is then narrow.

    Args:
        heads: names of the figures.
        columns: for each thing its name, then its figures.
        first: head of the names.

    Example:
        >>> table = transposed_table(["z", "m"], [["gear 1", "20", "2 mm"], ["gear 2", "40", "2 mm"]])
        >>> table.head, table.rows
        (['', 'gear 1', 'gear 2'], [('z', '20', '40'), ('m', '2 mm', '2 mm')])
    """
    names, *figures = zip(*columns, strict=True)
    rows = [(head, *cells) for head, cells in zip(heads, figures, strict=True)]
    wide = len(names) > _ACROSS
    return SectionTable([first, *names], rows, compact=not wide, wide=wide)


@dataclass(frozen=True)
class Drawn:
    """What a template of its own draws: a picture, say.

    Attributes:
        template: in `templates/sections`.
        values: by the names that it knows.
        panels: of the figures in it.
    """

    template: str
    values: Mapping[str, Any]
    panels: Sequence[Panel] = ()
    block: ClassVar[str] = "drawn"


@dataclass(frozen=True)
class Variants:
    """Blocks of every variant by its title: the page shows one variant at a time, print shows all."""

    each: Mapping[str, "Sequence[Block]"]
    block: ClassVar[str] = "variants"


@dataclass(frozen=True)
class Animation:
    """A drawing that moves by itself, for a page that has nothing else to say of the teeth.

    Attributes:
        kind: of the drawing: its macros in `drawings.html.jinja`, and the function of the page that moves it.
        picture: what the macros draw.
        words: what its slider counts.
        span, step: length of that slider and of a step on it.
        period: what the slider counts in one mesh cycle.
        acting: what changes with the load, as JSON has it; None where nothing does.
        title: stands above it where there are several.
    """

    kind: str
    picture: Mapping[str, Any]
    words: str
    span: float
    step: float
    period: float = 1.0
    acting: Any = None
    title: str = ""


@dataclass(frozen=True)
class Folded:
    """Blocks without figures that a reader opens."""

    words: str
    inside: "Sequence[Block]"
    block: ClassVar[str] = "folded"


Block = Heading | Paragraph | SectionTable | Panel | Drawn | Variants | Folded


@dataclass(frozen=True)
class Printed:
    """What the screen shows: a title, a table by columns, a line under it; each may be left out."""

    title: str = ""
    rows: Sequence[Mapping[str, str]] = ()
    line: str = ""


_GOES_ON = (
    "at",
    "by",
    "of",
    "in",
    "on",
    "over",
    "with",
    "without",
    "to",
    "from",
    "for",
    "that",
    "as",
)
"""Words with which the sentence of a value goes on; before others it has a comma."""

OF_MESHES = 100.0
"""Order behind which figures stand that each mesh of a drive has beside those of the whole."""

_ELSE = 60.0
"""Order from which on a figure is what else a joint has, see `KeyFigure`."""


@dataclass(frozen=True)
class KeyFigure:
    """A figure that answers what was asked, at the top of the report and on the first screen.

    Attributes:
        order: place among the others, the least first: efficiency 10, what a case asks for beside it 30 to
            39, what limits it 40, what else a joint has 60 and more.
        name: what it is, in a few words.
        value: number with its unit, or a word where there is none.
        detail: what goes with it, the most telling clause first; a narrow screen shows the first ones.
        beside: the value where that of other variants stands in the next column, with what it cannot do
            without; the value alone where it is empty.
        rank: of several stages only that with the least one is shown; all of them where it is not finite.
        asked_by: keys of a case file that ask for it, by the beginnings of their parts: "gears.deviations".
    """

    order: float
    name: str
    value: str
    detail: str = ""
    beside: str = ""
    rank: float = nan
    asked_by: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """Value and what goes with it."""
        opening = self.detail.partition(" ")[0]
        if not opening or opening[0] in ",;":
            return f"{self.value}{self.detail}"
        goes_on = opening in _GOES_ON or opening.startswith("(")
        return f"{self.value}{' ' if goes_on else ', '}{self.detail}"

    def of(self, stage: str) -> "KeyFigure":
        """That of a stage; what limits a drive keeps its place, the rest comes behind that of the whole."""
        late = OF_MESHES if self.order >= _ELSE else 0.0
        return replace(self, name=f"{self.name}, {stage}", order=self.order + late)


def key_figure(order: float, name: str, words: str, until: str) -> KeyFigure:
    """A key figure of words that begin with its value, which ends where others follow.

    Example:
        >>> key_figure(70.0, "stiffness", "40.2 kN m/rad at the operating point", " at the").value
        '40.2 kN m/rad'
        >>> key_figure(70.0, "stiffness", "nothing is carried", " at the").value
        'nothing is carried'
    """
    value = words.partition(until)[0]
    return KeyFigure(order, name, value, words.removeprefix(value).strip())


@dataclass(frozen=True)
class Page:
    """What sections look at.

    Attributes:
        outcomes: results by variant, at least one.
        curves: by variant and friction law.
        sections: those that are shown, in order.
        designs: True if the outcomes are those of several cases, compared.
    """

    outcomes: Mapping[str, Outcome]
    curves: Curves
    sections: "Sequence[Section]" = ()
    designs: bool = False

    @property
    def several(self) -> bool:
        """True if there are several variants."""
        return len(self.outcomes) > 1

    @property
    def first(self) -> Mapping[str, Any]:
        """Record of the first variant."""
        return next(iter(self.outcomes.values())).manifest

    @property
    def title(self) -> str:
        """What the page is called: designs, the title of the case, or without one what its gears are."""
        if self.designs:
            return " · ".join(self.outcomes)
        titled = self.first["title"] != self.first["case"]
        return str((not titled and self.first.get("designation")) or self.first["title"])

    @property
    def cases(self) -> str:
        """Name of the case, or names of those that are compared."""
        every = (str(outcome.manifest["case"]) for outcome in self.outcomes.values())
        return ", ".join(dict.fromkeys(every)) if self.designs else str(self.first["case"])

    @property
    def version(self) -> str:
        """Versions of the package that computed the parts; one, unless an old result was completed."""
        parts = (data for outcome in self.outcomes.values() for data in outcome.parts.values())
        return ", ".join(dict.fromkeys(str(data.attrs["version"]) for data in parts))

    def having(self, *parts: str) -> dict[str, Outcome]:
        """Outcomes that have all of some parts; "teeth.points" is a part that holds an array of that name."""
        return {
            name: outcome
            for name, outcome in self.outcomes.items()
            if all(_has(outcome, part) for part in parts)
        }

    def by_mesh(self, *parts: str) -> "Page":
        """The page of what has some parts, of drives each mesh by itself under its name, with its curves."""
        meshes = by_mesh(self.having(*parts), *parts)
        has_curves = all(self.outcomes.get(name) is outcome for name, outcome in meshes.items())
        return replace(self, outcomes=meshes, curves=self.curves if has_curves else curves(meshes))

    def meshes(self, *parts: str) -> "dict[str, Page]":
        """By name of a mesh the page of those variants that have some parts of it; no name of a lone mesh."""
        by_label: dict[str, dict[str, Outcome]] = {}
        for variant, outcome in self.having(*parts).items():
            for label, mesh in _meshes(outcome, *parts).items():
                by_label.setdefault(label, {})[variant] = mesh
        return {
            label: replace(
                self, outcomes=of_variants, curves=curves(of_variants) if label else self.curves
            )
            for label, of_variants in by_label.items()
        }

    def each(self, part: str) -> Iterator[tuple[int, str, Outcome]]:
        """Position, title and outcome of every variant that has a part; no title where there is one.

        Of a part of the meshes of a drive that of every stage.
        """
        there = self.having(part)
        for position, (name, outcome) in enumerate(self.outcomes.items()):
            for k, (stage, mesh) in enumerate(of_meshes(outcome, part) if name in there else ()):
                titles = [name if self.several else "", _with_bodies(stage, outcome)]
                yield position + k * len(self.outcomes), ", ".join(filter(None, titles)), mesh


def _with_bodies(stage: str, outcome: Outcome) -> str:
    """Title of a stage with its bodies, where it is a mesh of a train."""
    stages = outcome.manifest.get("stages", ())
    numbered = (
        record for record in stages if isinstance(record["number"], int)
    )  # labels have their bodies
    bodies_of = {f"stage {record['number']}": record["bodies"] for record in numbered}
    return ": ".join(filter(None, (stage, bodies_of.get(stage, ""))))


def _bodies(stage: str, page: Page) -> str:
    """Bodies of a stage whose label does not have them, where all outcomes of a page name them alike."""
    bodies = {str(outcome.manifest.get("bodies", "")) for outcome in page.outcomes.values()}
    return bodies.pop() if len(bodies) == 1 and stage.removeprefix("stage ").isdigit() else ""


def of_meshes(outcome: Outcome, *parts: str) -> list[tuple[str, Outcome]]:
    """The outcome without a title, or that of every stage where a drive has some parts of each of its meshes.

    Args:
        outcome: of a mesh or a drive.
        parts: see `Page.having`.
    """
    names = {part.partition(".")[0] for part in parts} & {*outcome.parts}
    labels = dict.fromkeys(label for name in names for label in stages_of(outcome.parts[name]))
    of_stages = {name: data for name, data in outcome.parts.items() if stages_of(data)}
    of_all = {name: data for name, data in outcome.parts.items() if name not in of_stages}
    return [
        (
            f"stage {label}",
            replace(
                outcome,
                parts=of_all | _of_stage(of_stages, label),
                manifest=_manifest_of(outcome.manifest, label),
            ),
        )
        for label in labels
    ] or [("", outcome)]


def _of_stage(parts: Mapping[str, "xr.Dataset"], number: Label) -> dict[str, "xr.Dataset"]:
    return {name: of_stage(d, number) for name, d in parts.items() if number in stages_of(d)}


def by_mesh(outcomes: Mapping[str, Outcome], *parts: str) -> dict[str, Outcome]:
    """Outcomes as they are, and for that of a drive one of each mesh by itself, under its name.

    Args:
        outcomes: by variant, that have the parts.
        parts: see `Page.having`; of the meshes of a drive those that have them.
    """
    meshes = {}
    for variant, outcome in outcomes.items():
        for label, mesh in _meshes(outcome, *parts).items():
            design = variant if len(outcomes) > 1 or not label else ""
            meshes[", ".join(filter(None, [design, label]))] = mesh
    return meshes


def _meshes(outcome: Outcome, *parts: str) -> dict[str, Outcome]:
    """The meshes of a drive that have some parts, each by itself under its name; without one of one mesh."""
    of_a_drive = [name for name, data in outcome.parts.items() if not stages_of(data)]
    meshes = {}
    for stage, mesh in of_meshes(outcome, *parts):
        of_mesh = {name: data for name, data in mesh.parts.items() if name not in of_a_drive}
        alone = replace(mesh, parts=of_mesh) if stage else mesh
        if all(_has(alone, part) for part in parts):
            meshes[stage] = alone
    return meshes


def _manifest_of(manifest: Mapping[str, Any], number: Label) -> dict[str, Any]:
    """Record of a drive as that of one of its meshes: its motion and operating point, its own inputs."""
    record = next(one for one in manifest["stages"] if one["number"] == number)
    load = "force" if "loaded" in record["travels"] else "torque"
    point = {"speed": record["speed"], load: record["load"]}
    inside = (
        f"{str(number).partition(' ')[0]}."  # rows of a set stand for its meshes, but for its gears
    )
    rows = []
    for row in manifest["inputs"]:
        table, _, key = row["key"].removeprefix(inside).partition(".")
        of_set = table == "gears" and not isinstance(number, int)
        if row["table"] == "stages" and row["key"].startswith(inside) and not of_set:
            rows.append({**row, "table": table, "key": key})
        elif row["table"] == "operation" and row["key"] in point:
            rows.append({**row, "value": point[row["key"]]})
        elif row["table"] != "gears":
            rows.append(row)
    return {**manifest, **record, "inputs": rows}


def blocks_by_variant(
    page: Page, part: str, show: Callable[[int, Outcome], Iterator[Block]]
) -> Iterator[Block]:
    """Blocks of every variant that has a part, see `tabbed`."""
    return tabbed(
        (title, _by_bodies(show(position, outcome), outcome))
        for position, title, outcome in page.each(part)
    )


def _by_bodies(blocks: Iterable[Block], outcome: Outcome) -> Iterator[Block]:
    """Blocks of a mesh of a train, whose sentences say "the ring", not "gear 2"."""
    for block in blocks:
        if isinstance(block, Paragraph) and type(block.words) is str:  # no markup
            yield replace(block, words=by_bodies(outcome, block.words))
        elif isinstance(block, Panel):
            figures = [
                replace(figure, note=by_bodies(outcome, figure.note)) for figure in block.figures
            ]
            yield replace(block, figures=figures)
        else:
            yield block


def tabbed(groups: Iterable[tuple[str, Iterable[Block]]]) -> Iterator[Block]:
    """Blocks by title of their variant, one variant at a time; one alone stands under its title, if any."""
    tabs = {title: tuple(naming(title.partition(": ")[0], blocks)) for title, blocks in groups}
    if len(tabs) > 1:
        yield Variants(tabs)
        return
    for title, blocks in tabs.items():
        yield from [Heading(title)] if title else []
        yield from blocks


def _told_apart(blocks: Iterable[Block], ending: str) -> Iterator[Block]:
    """Blocks whose figures have names with an ending, so that a page may have the like of them."""
    for block in blocks:
        if isinstance(block, Variants):
            apart = {name: [*_told_apart(them, ending)] for name, them in block.each.items()}
            yield Variants(apart)
            continue
        if not isinstance(block, Panel):
            yield block
            continue
        choices = [
            replace(
                one, changes={f"{name}{ending}": change for name, change in one.changes.items()}
            )
            for one in block.choices
        ]
        figures = [replace(one, name=f"{one.name}{ending}") for one in block.figures]
        yield replace(block, figures=figures, choices=choices)


def naming(variant: str, blocks: "Iterable[Any]") -> Iterator[Any]:
    """Blocks whose figures name a variant at the end of their titles; as they are without a variant."""
    for block in blocks:
        if variant and isinstance(block, Variants):
            yield Variants({name: [*naming(variant, them)] for name, them in block.each.items()})
        elif variant and isinstance(block, Panel):
            figures = [
                replace(figure, title=f"{figure.title} · {variant}") for figure in block.figures
            ]
            yield replace(block, figures=figures)
        else:
            yield block


def panels(blocks: Iterable[Block]) -> Iterator[Panel]:
    """Panels among some blocks, and those in what templates draw."""
    for block in blocks:
        if isinstance(block, Panel):
            yield block
        elif isinstance(block, Drawn):
            yield from block.panels
        elif isinstance(block, Variants):
            for inside in block.each.values():
                yield from panels(inside)


def _has(outcome: Outcome, part: str) -> bool:
    name, _, variable = part.partition(".")
    return name in outcome.parts and (not variable or variable in outcome.parts[name])


Words = str | Callable[[Page], str]


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """One section of the report, and what its results add to the answer at the top and to the screen.

    Attributes:
        name: anchor in the page.
        title: heading, or a function of the page that gives it.
        short: title in the line of contents, likewise.
        order: place among the sections; that of the answer is 0, of the sources 1000.
        parts: of a result that it shows, see `Page.having`.
        blocks: what stands in it, in order.
        lacks: None, or why it is left out, in one sentence; empty where nobody asked for it. By default a
            part is lacking, for the reason that its analysis gave.
        answer: main figures of one variant.
        card: the same for one friction law, by name.
        closing: blocks at the end of the answer.
        screen: what the command line prints of one variant.
        sums_up: tables of the gears and sentences on what is assumed, for the page that sums up one outcome.
        main_figure: name of the figure that may stand on that page; empty without one.
        of_a_mesh: True if it looks at one mesh of each outcome: of a drive there is one for each, in turn.
        folded: True for one that a reader opens.
        picture: identity of its drawing that stands beside the answer; empty without one.
        moving: that drawing of one outcome which has its parts, by the name that it gets in a page.
    """

    name: str
    title: Words
    short: Words
    order: float
    parts: tuple[str, ...] = ()
    blocks: Deferred[Callable[[Page], Iterable[Block]]] = Deferred()
    lacks: Callable[[Page], str | None] | None = None
    answer: Callable[[Outcome], Iterable[KeyFigure]] = lambda outcome: ()
    card: Callable[[Outcome, str], Iterable[tuple[str, str]]] = lambda outcome, law: ()
    closing: Callable[[Page], Iterable[Block]] = lambda page: ()
    screen: Callable[[Outcome], Iterable[Printed]] = lambda outcome: ()
    sums_up: Callable[[Outcome], Iterable[SectionTable | Paragraph]] = lambda outcome: ()
    main_figure: str = ""
    of_a_mesh: bool = False
    folded: bool = False
    picture: str = ""
    moving: Callable[[Outcome, str], Animation] | None = None

    def lacking(self, page: Page) -> str | None:
        """None if the section is shown, else why not."""
        if (lacks := self.lacks) is not None:
            (why,) = made_of(page.outcomes.values(), lambda: [lacks(page)], lambda told: [told])
            return why
        return None if page.having(*self.parts) else reason(page, *self.parts)

    def shows(self, page: Page) -> list[Block]:
        """What stands in it, or what results of another build lack for it."""
        return made_of(
            page.outcomes.values(),
            lambda: map(_settled, self._blocks(page)),
            lambda told: [Paragraph(told, "warning")],
        )

    def _blocks(self, page: Page) -> Iterable[Block]:
        """What stands in it; of a section of a mesh that of each mesh, whose figures have names apart."""
        if not self.of_a_mesh:
            return self.blocks(page)
        pages = (page.meshes(*self.parts) or {"": page}).items()
        return tabbed(
            (
                ": ".join(filter(None, (label, _bodies(label, mesh_page)))),
                _told_apart(
                    _by_bodies(self.blocks(mesh_page), next(iter(mesh_page.outcomes.values()))),
                    f"_mesh{k}" if k else "",
                ),
            )
            for k, (label, mesh_page) in enumerate(pages)
        )

    def answers(self, outcome: Outcome) -> Iterator[KeyFigure]:
        """Main figures of one variant, those of each stage by its name; of some that of one stage alone."""
        worst: dict[str, tuple[str, KeyFigure]] = {}
        for stage, mesh in of_meshes(outcome, *self.parts):
            for figure in made_of([outcome], partial(self.answer, mesh)):
                if not (stage and isfinite(figure.rank)):
                    yield figure.of(stage) if stage else figure
                elif figure.name not in worst or figure.rank < worst[figure.name][1].rank:
                    worst[figure.name] = stage, figure
        for stage, figure in worst.values():
            yield replace(figure, detail=f"at {stage}; {figure.detail}")

    def prints(self, outcome: Outcome) -> Iterator[Printed]:
        """What the command line prints of one variant, that of each stage under its name."""
        for stage, mesh in of_meshes(outcome, *self.parts):
            screen = partial(self.screen, mesh)
            for printed in made_of([outcome], screen, lambda told: [Printed(line=told)]):
                titles = [stage.capitalize(), printed.title]
                titled = replace(printed, title=": ".join(filter(None, titles)))
                yield _printed_by_members(outcome, titled if stage else printed)


def _printed_by_members(outcome: Outcome, printed: Printed) -> Printed:
    """What is printed with the meshes of a planetary set by their members, see `by_members`."""

    def cell(head: str, text: str) -> tuple[str, str]:
        mesh = by_members(outcome, f"stage {text.partition(':')[0]}") if head == "stage" else ""
        return (
            (head, by_members(outcome, text)) if mesh in ("", f"stage {text}") else ("mesh", mesh)
        )

    return Printed(
        by_members(outcome, printed.title),
        [dict(cell(*entry) for entry in row.items()) for row in printed.rows],
        by_members(outcome, printed.line),
    )


def made_of(
    outcomes: Iterable[Outcome],
    make: Callable[[], Iterable[Made]],
    instead: Callable[[str], Iterable[Made]] = lambda told: (),
) -> list[Made]:
    """What is made of some outcomes; where one of another build lacks something for it, what stands instead.

    Args:
        outcomes: that it is made of.
        make: looks at them.
        instead: by a sentence that says what is lacking, and how the result is made anew.

    Raises:
        KeyError: all outcomes are of this build, which keeps all that it looks at.
    """
    try:
        return [*make()]
    except KeyError as error:
        here = surroundings()["code"]
        older = (
            outcome.manifest
            for outcome in outcomes
            if outcome.manifest["surroundings"].get("code") != here
        )
        for manifest in older:
            return [*instead(_lacking(manifest, error))]
        raise


def _lacking(manifest: Mapping[str, Any], error: KeyError) -> str:
    """What a result of another build lacks, in a sentence with the command that makes it anew."""
    name = next(iter(re.findall(r"'(\w+)'", str(error))), "")
    variable = VARIABLES.get(name)
    words = f"{variable.long_name} ({name})" if variable else name or str(error)
    return (
        f"This result was kept by another build of Pitchpoint and lacks: {words}. "
        f"Make it anew: `pitchpoint run FOLDER/{manifest['variant']}/manifest.json`, FOLDER being its folder."
    )


def _settled(block: Block) -> Block:
    """A block that reads no result any more."""
    if isinstance(block, SectionTable):
        return replace(block, rows=[*block.rows])
    if isinstance(block, Folded):
        return replace(block, inside=[*map(_settled, block.inside)])
    if isinstance(block, Variants):
        return Variants({name: [*map(_settled, them)] for name, them in block.each.items()})
    return block


def variant_warnings(
    outcomes: Mapping[str, Outcome],
    kind: str,
    told: Callable[[Outcome, str], str] = lambda _, text: text,
) -> dict[str, list[str]]:
    """Sentences on what fails or is doubtful, each once with its variants, the worst of each variant first.

    Args:
        outcomes: by variant.
        kind: "implausible" or "warnings".
        told: how a sentence of an outcome is told, where not as it is; those that are told alike are one.
    """
    variants: dict[str, list[str]] = {}
    for row in zip_longest(*(outcome.manifest[kind] for outcome in outcomes.values())):
        for (variant, outcome), text in zip(outcomes.items(), row, strict=True):
            if text is not None:
                variants.setdefault(told(outcome, text), []).append(variant)
    return variants


def key_figures(sections: "Iterable[Section]", outcome: Outcome) -> list[KeyFigure]:
    """What sections answer of an outcome, in the order of the figures; what its case asks for comes first."""
    figures = (figure for section in sections for figure in section.answers(outcome))
    keys = [
        f".{row['table']}.{row['key']}"
        for row in outcome.manifest["inputs"]
        if row["status"] == "given"
    ]
    return sorted((_as_asked(figure, keys) for figure in figures), key=lambda figure: figure.order)


_ASKED = 43.0
"""Order from which on that stands which a case asks for by a key of its own, behind what limits the drive."""


def _as_asked(figure: KeyFigure, keys: Sequence[str]) -> KeyFigure:
    """A figure at the place of what a case asks for, if a key does."""
    is_asked = any(f".{part}" in key for key in keys for part in figure.asked_by)
    order = _ASKED + 1e-3 * figure.order
    return replace(figure, order=order) if is_asked and figure.order > order else figure


def figures_by_members(outcome: Outcome, figures: Iterable[KeyFigure]) -> list[KeyFigure]:
    """Key figures whose names and details name members, see `by_members`."""
    return [
        replace(
            figure,
            name=by_members(outcome, figure.name),
            detail=by_members(outcome, figure.detail),
            beside=by_members(outcome, figure.beside),
        )
        for figure in figures
    ]


def stages_together(figures: "Iterable[KeyFigure]") -> list[KeyFigure]:
    """Key figures of which those that are the same for several stages are one.

    Example:
        >>> from pitchpoint.views.section import KeyFigure
        >>> alone = KeyFigure(60.0, "Backlash", "0 µm")
        >>> [one.name for one in stages_together(alone.of(f"stage {k}") for k in (1, 2, 3))]
        ['Backlash, stages 1, 2 and 3']
    """
    alike: dict[tuple[str, str, str], list[KeyFigure]] = {}
    for figure in figures:
        name = figure.name.partition(", stage ")[0]
        alike.setdefault((name, figure.value, figure.detail), []).append(figure)
    return [_of_stages(name, those) for (name, *_), those in alike.items()]


def _of_stages(name: str, figures: Sequence[KeyFigure]) -> KeyFigure:
    """One key figure in place of those that are the same for some stages."""
    stages = [figure.name.removeprefix(f"{name}, stage ") for figure in figures]
    if len(stages) < 2:
        return figures[0]
    few = len(stages) < 4 and all(stage.isdigit() for stage in stages)
    label = f"stages {enumerated(stages)}" if few else f"{len(stages)} meshes alike"
    return replace(figures[0], name=f"{name}, {label}")


def of_part(part: str, place: str) -> Callable[..., Any]:
    """What a section says of an outcome that has a part, loaded for such alone; nothing of the others.

    Args:
        part: of a result.
        place: of the function, see `registry.code_at`.
    """
    return _of_some(lambda outcome: part in outcome.parts, place)


def of_trains(place: str) -> Callable[..., Any]:
    """What a section says of an outcome with sets whose meshes turn together, likewise; see `of_part`."""
    return _of_some(_has_trains, place)


def of_source(place: str) -> Callable[..., Any]:
    """What a section says of an outcome whose case is from a publication, likewise; see `of_part`."""
    return _of_some(lambda outcome: bool(outcome.manifest.get("source")), place)


def of_published(place: str) -> Callable[[Page], str | None]:
    """What a page whose case is from a publication lacks; others lack it, and nothing is said of it."""
    return lambda page: code_at(place)(page) if page.first.get("source") else ""


def of_rows(place: str) -> Callable[[Page], Iterable[Block]]:
    """Blocks of a page with printed numbers, loaded for such alone."""
    return lambda page: () if without_rows(page) is not None else code_at(place)(page)


def without_rows(page: Page) -> str | None:
    """None where computed numbers stand beside printed ones; others lack them in silence."""
    return None if any(outcome.rows for outcome in page.outcomes.values()) else ""


def _of_some(there: Callable[[Outcome], bool], place: str) -> Callable[..., Any]:
    def told(outcome: Outcome, *law: str) -> Any:
        return code_at(place)(outcome, *law) if there(outcome) else ()

    return told


def _has_trains(outcome: Outcome) -> bool:
    return bool(outcome.manifest.get("trains"))


def without_trains(page: Page) -> str | None:
    """None where an outcome has such a set; nobody asks for the motion of others."""
    return None if any(map(_has_trains, page.outcomes.values())) else ""


def reason(page: Page, *parts: str) -> str:
    """Why no outcome has some parts, as their analyses told; empty where nobody asked for them."""
    reasons = (
        outcome.manifest.get("lacks", {}).get(part.partition(".")[0], "")
        for outcome in page.outcomes.values()
        for part in parts
    )
    return next(filter(None, reasons), "")


def page_words(words: Words, page: Page) -> str:
    """Words, or what the function gives for the page."""
    return words if isinstance(words, str) else words(page)
