"""The report: one HTML file that opens from disk and says what was computed, with what, and from whom."""

import base64
import gzip
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import xarray as xr

from pitchpoint._jax import double_precision
from pitchpoint.core.kept import base_folder, prepared_folder, read_kept, write_kept
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.published.publication_registry import publication_of
from pitchpoint.results.chosen_units import UnitsByKind, shown_in, unit_choice
from pitchpoint.results.store import write_text
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import Panel, curves
from pitchpoint.views.inputs import recorded_units
from pitchpoint.views.one_page import one_page
from pitchpoint.views.section import (
    Block,
    Drawn,
    Folded,
    Heading,
    Page,
    Section,
    SectionTable,
    Variants,
    page_words,
    panels,
    variant_warnings,
)
from pitchpoint.views.section_registry import in_order

if TYPE_CHECKING:
    import jinja2
    import markupsafe

    from pitchpoint.sizing.sizing import Sizing

__all__ = ["environment", "packed", "packed_plotly", "page_of", "report_page", "write_report"]


@double_precision()
def write_report(
    outcomes: "Mapping[str, Outcome] | xr.Dataset | Sizing",
    path: str | Path,
    *,
    designs: bool = False,
    units: UnitsByKind | None = None,
) -> None:
    """Write the report; a reader never sees half of it.

    Args:
        outcomes: by variant, as `run` and `open_result` give them; or a study, as `study` gives it, best with
            units = "shown"; or a sizing, as `size` gives it.
        path: of the HTML file.
        designs: True if the outcomes are those of several cases, by design, which are compared.
        units: by kind of quantity, {"angle": "arcmin"} or "angle=arcmin"; those of the first case by
            default. A study and a sizing have theirs.

    Raises:
        InputError: no outcomes, study or sizing; units that there are not.
    """
    demand_arguments(path=path)
    if isinstance(outcomes, xr.Dataset):
        from pitchpoint.views.study_report import render_study

        return write_text(Path(path), render_study(outcomes))
    if isinstance(outcomes, Mapping) and outcomes:
        of_case = cast("Mapping[str, Outcome]", outcomes)
        return write_text(Path(path), report_page(of_case, designs=designs, units=units))
    from pitchpoint.sizing.sizing import Sizing
    from pitchpoint.views.sizing_report import render_sizing

    if isinstance(outcomes, Sizing):
        return write_text(Path(path), render_sizing(outcomes))
    told = "a report is of what `run`, `open_result`, `study` or `size` gives"
    raise InputError(f"{shown(outcomes)} was given; {told}")


_OF_ALL = ("answer", "formulas", "compared", "models", "sources")
"""Sections that are open whatever a publication is about."""


def report_page(
    outcomes: Mapping[str, Outcome], *, designs: bool = False, units: UnitsByKind | None = None
) -> str:
    """The report as text.

    Args:
        outcomes: by variant, at least one; parts that were not finished are left out.
        designs: True if the outcomes are those of several cases, by design, which are compared.
        units: by kind of quantity; those of the first case by default.
    """
    with shown_in(recorded_units(outcomes) if units is None else unit_choice(units)):
        return _rendered(outcomes, designs=designs)


def _rendered(outcomes: Mapping[str, Outcome], *, designs: bool) -> str:
    bare = Page(outcomes, curves(outcomes), designs=designs)
    lacking = {section: section.lacking(bare) for section in in_order()}
    page = replace(bare, sections=[one for one, why in lacking.items() if why is None])
    sections = [_made(section, page) for section in page.sections]
    shown = list(panels(block for one in sections for block in one["blocks"]))
    figures = [figure for panel in shown for figure in panel.figures if figure.drawn]
    return _as_printed(
        environment()
        .get_template("report.html.jinja")
        .render(
            title=page.title,
            summary="" if designs else page.first["summary"],
            cases=page.cases,
            designs=designs,
            variants=[*outcomes],
            implausible=variant_warnings(outcomes, "implausible"),
            cited=any(one.manifest["sources"] for one in outcomes.values()),
            sections=sections,
            absent=_absent(bare, lacking),
            version=page.version,
            pictured=None if designs else next((one for one in page.sections if one.picture), None),
            glimpse=None if designs else next(iter(figures), None),
            p=one_page(page, shown),
            data=packed(_shared(_payload(shown))),
            plotly=packed_plotly(),
        )
    )


def page_of(template: str, sections: Sequence[Mapping[str, Any]], **words: str) -> str:
    """A page of blocks that is no report of a case, as text.

    Args:
        template: name of its template.
        sections: each with `name`, `title` and `blocks`.
        words: what else the template shows.
    """
    shown = list(panels(block for section in sections for block in section["blocks"]))
    values = {"data": packed(_shared(_payload(shown))), "plotly": packed_plotly()}
    page = environment().get_template(template).render(sections=sections, **values, **words)
    return _as_printed(page)


def _made(section: Section, page: Page) -> dict[str, Any]:
    """What the template shows of a section."""
    title, short = page_words(section.title, page), page_words(section.short, page)
    beside = _aside(section, page)
    return {
        "name": section.name,
        "title": title,
        "short": short,
        "folded": section.folded or beside,
        "beside": beside,
        "blocks": _captioned(section.shows(page), title),
    }


def _aside(section: Section, page: Page) -> bool:
    """True for what the publication of a case is not about."""
    publication = publication_of(str(page.first.get("source", "")))
    about = publication.sections if publication else ()
    return bool(about) and section.name not in (*about, *_OF_ALL)


def _captioned(blocks: Iterable[Block], title: str) -> list[Block]:
    """Blocks whose tables have the heading above them as caption."""
    done: list[Block] = []
    for block in blocks:
        if isinstance(block, Heading):
            title = str(block.words)
        elif isinstance(block, SectionTable) and not block.caption:
            block = replace(block, caption=title, repeats=True)
        elif isinstance(block, Variants):
            captioned = {
                name: _captioned(them, f"{title}, {name}") for name, them in block.each.items()
            }
            block = Variants(captioned)
        elif isinstance(block, Folded):
            block = replace(block, inside=_captioned(block.inside, title))
        done.append(block)
    return done


def _absent(page: Page, lacking: Mapping[Section, str | None]) -> list[tuple[list[str], str]]:
    """Titles of sections that are left out, by the reason."""
    reasons: dict[str, list[str]] = {}
    for section, why in lacking.items():
        if why:
            reasons.setdefault(why, []).append(page_words(section.short, page))
    return [(names, why) for why, names in reasons.items()]


def _drawn(block: Drawn) -> "markupsafe.Markup":
    from markupsafe import Markup

    return Markup(environment().get_template(f"sections/{block.template}").render(block.values))


@cache
def packed_plotly() -> str:
    """plotly.js in the plane, compressed: most of a page; kept, since packing it takes half a second."""
    folder = _kept_pages()
    path = None if folder is None else folder / f"plotly-plane-{version('plotly')}"
    packed = None if path is None else read_kept(path)
    if packed is None:
        from plotly.offline import get_plotlyjs

        text = _as_text(_in_the_plane(get_plotlyjs()))
        if path is not None:
            write_kept(path, text.encode())
        return text
    return packed.decode()


_WORKER = re.compile(r"(?<=\.exports=')(?:[^'\\]|\\.){100000,}(?=')")
"""The program of a worker that draws maps of the earth, as text."""

_SHADER = re.compile(r"(?<=[=(,:\[]`)[^`\\$]*void main\(\) ?\{[^`\\$]*(?=`)")
"""The program of a graphics card, as text."""


def _in_the_plane(plotly: str) -> str:
    """plotly.js without what draws maps of the earth and bodies in space, which no figure of a page is."""
    return _SHADER.sub("", _WORKER.sub("", plotly))


def _as_text(content: str) -> str:
    """Content compressed, five characters for four bytes, none of which HTML reads as anything else."""
    return base64.b85encode(gzip.compress(content.encode(), mtime=0)).decode().translate(_PLAIN)


def _as_printed(html: str) -> str:
    """A page whose numbers and units are those of a book, and stand on one line but for values of tiles."""
    head, main, tail = html.partition("<main>")
    shown, end, scripts = tail.partition("</main>")
    shown = _SHOWN.sub(lambda text: _number_as_printed(text.group()), shown)
    return "".join((head, main, shown, end, scripts))


def _number_as_printed(text: str) -> str:
    for pattern, instead in _PRINTED:
        text = pattern.sub(instead, text)
    return text


_SHOWN = re.compile(r"(?<!<strong)>[^<>]*\d[^<>]+<")
_UNIT = r"[%°µ]|(?:[kmMG]?(?:N|Pa|W|g|J|Hz|K)|[mkc]?m|m?s|rpm|arcmin|arcsec)(?![a-zA-Z_-])"
_PRINTED = (
    (re.compile(r"(?<=[\s(>])-(?=\d)"), "\u2212"),
    (re.compile(r"(?<=\d)e-0*(?=\d)"), "e\u2212"),
    (re.compile(r"(?<=\d)e\+0*(?=\d)"), "e"),
    (re.compile(r"(?<=\d)[ \u00a0](?:deg\b|°(?![CF]))"), "°"),
    (re.compile(r"(?<=\d)[ \u00a0]degC\b"), "\u00a0°C"),
    (re.compile(r"(?<=\d)[ \u00a0]N/um\b"), "\u00a0N/µm"),
    (re.compile(r"(?<=\d) x (?=\d)"), "\u00a0×\u00a0"),
    (re.compile(r"(>|(?<![^\s(>])[^\s<>=\"]{1,7}) = (?=[\u2212-]?\d)"), "\\1\u00a0=\u00a0"),
    (re.compile(r"((?:[\dKgN][ \u00a0]|/)[kcm]?m)2(?!\w)"), r"\1²"),
    (re.compile(rf"(?<=\d) (?={_UNIT})"), "\u00a0"),
    (re.compile(r"((?<=\d\u00a0N)|(?<=\d\u00a0kN)) (?=m(?![a-zA-Z]))"), "\u00a0"),
)
"""Minus, powers of ten, degrees, products, squares; symbols, numbers and units that stay on one line."""

_DIGEST = re.compile(
    r"(?<![0-9a-f])(?=[0-9a-f]{64})[0-9a-f]{16}|(?<=[0-9a-f]{16})[0-9a-f]{16}(?=[0-9a-f])"
)
"""Sixteen digits of a digest, behind which it may break."""

_IN_UNIT = re.compile(r"(?<=[Ng]) (?=[cm]?m(?![a-z]))")
"""A space within the unit of a torque, a stiffness against rotation or an inertia."""

_PLAIN = str.maketrans("<>&", ".:,")


@cache
def _kept_pages() -> Path | None:
    """Folder of what pages are made of; None where the user has none that is private."""
    try:
        return prepared_folder(base_folder() / "pages")
    except RuntimeError:
        return None


@cache
def environment() -> "jinja2.Environment":
    """Templates of pages, with what they ask for."""
    import jinja2

    compiled = _kept_pages()
    jinja = jinja2.Environment(
        bytecode_cache=None if compiled is None else jinja2.FileSystemBytecodeCache(str(compiled)),
        loader=jinja2.PackageLoader("pitchpoint.views"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    jinja.filters["marked"] = _marked
    jinja.filters["typeset"] = _typeset
    jinja.filters["sentence"] = show.sentence
    jinja.filters["breakable"] = _breakable
    jinja.globals["drawn"] = _drawn
    return jinja


def _typeset(words: str) -> "markupsafe.Markup":
    """Words, escaped, with the indices of symbols set low and units as printed."""
    from markupsafe import Markup, escape

    return Markup(show.subscripts(show.pretty(str(escape(words)))))


def _breakable(words: str, *, symbols: bool = True) -> "markupsafe.Markup":
    """Words, escaped, that break after an underscore of a name and within a digest, and within no unit.

    Args:
        words: with symbols whose indices are set low, unless they are names alone, as of files.
        symbols: False for such names.
    """
    from markupsafe import Markup, escape

    text = _IN_UNIT.sub("\u00a0", str(escape(words)))
    text = show.subscripts(text) if symbols else text
    return Markup(_DIGEST.sub(r"\g<0><wbr>", text.replace("_", "_<wbr>")))


def _marked(words: str) -> "markupsafe.Markup":
    """Words, escaped, with `code` set as code, units as printed and indices of symbols set low."""
    from markupsafe import Markup

    if isinstance(words, Markup):
        return words
    parts = words.split("`")
    if len(parts) % 2 == 0:
        return _typeset(words)
    code = Markup("<code>{}</code>")
    return Markup("").join(code.format(p) if k % 2 else _typeset(p) for k, p in enumerate(parts))


def _payload(each: Sequence[Panel]) -> dict[str, Any]:
    """Figures and menus for the script."""
    return {
        "figures": {
            figure.name: {"data": figure.data, "layout": figure.layout}
            for panel in each
            for figure in panel.figures
            if figure.drawn
        },
        "menus": {
            panel.figures[0].name: [choice.changes for choice in panel.choices]
            for panel in each
            if panel.choices
        },
    }


def packed(content: Mapping[str, Any]) -> str:
    """Content of a page for its script, compressed: `opened` in figures.js reads it."""
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return _as_text(text)


_LONG = 8
"""Length from which on a list of numbers stands apart."""


def _shared(content: Mapping[str, Any]) -> dict[str, Any]:
    """Content whose long lists of numbers stand once in front, by their steps; `held` in page.js reads them.

    Courses at many points of studies share their places, and compress to a quarter by steps.
    """
    lists: dict[tuple[int | None, ...], int] = {}

    def placed(part: Any) -> Any:
        if isinstance(part, Mapping):
            return {key: placed(value) for key, value in part.items()}
        if not isinstance(part, list):
            return part
        steps = _steps(part) if len(part) >= _LONG else None
        if steps is None:
            return [placed(value) for value in part]
        return {"list": lists.setdefault(steps, len(lists))}

    shown = placed(content)
    return {"lists": [*lists], **shown}


def _steps(values: list[Any]) -> tuple[int | None, ...] | None:
    """Decimals of numbers, then the step to each in units of the last decimal; None if this is not exact."""
    if not all(value is None or isinstance(value, int | float) for value in values):
        return None
    numbers = np.array([value for value in values if value is not None], dtype=float)
    for decimals in range(_DECIMALS):
        scaled = np.round(numbers * 10.0**decimals)
        if np.array_equal(scaled / 10.0**decimals, numbers) and np.all(np.abs(scaled) < 2**53):
            steps = iter(np.diff(scaled, prepend=0.0).astype(int).tolist())
            return (decimals, *(None if value is None else next(steps) for value in values))
    return None


_DECIMALS = 16
