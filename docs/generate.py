"""Pages of the reference that come from the schema and the registries: `python docs/generate.py FOLDER`."""

import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

import pitchpoint
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.document import MARKS, STATUSES
from pitchpoint.cases.drive_schema import DriveCase, StageTable, TrainTable
from pitchpoint.cases.loss_sets import SET, SET_TOLD
from pitchpoint.cases.schema import CaseFile
from pitchpoint.gears.planetary import PlanetaryGears
from pitchpoint.input.tables import alternatives, field_quantity, key_sentences, usual_words
from pitchpoint.materials.material_tables import DriveMaterials
from pitchpoint.published.publication_registry import PUBLICATIONS
from pitchpoint.results.strength_variables import EXTREMES, STRENGTH
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.catalogue import entries
from pitchpoint.sizing.task_table import TASK_TABLE, Task

__all__ = ["keys_pages", "models_page", "pages", "variables_pages", "write"]

Row = Sequence[str]


def keys_pages() -> dict[str, str]:
    """Every key of a case file: a page for each table with those in it, and one that leads to them."""
    pages = {f"keys_{name}.md": "\n".join(parts) for name, parts in _keys_by_table().items()}
    intro = (
        "Every table of a case file has a page with its keys and the tables in it. A quantity is written "
        'with its unit (`"2 mm"`), in that of the column or any other of its kind. '
        "`pitchpoint show FILE` lists what a file leaves open."
    )
    rows = [(f"[{_title_of(text)}]({path})", _first_words(text)) for path, text in pages.items()]
    lines = [_page_head("Keys of a case file", intro), _table(("table", "what it is"), rows)]
    return {"keys.md": "\n".join([*lines, _toctree(pages)]), **pages}


def _keys_by_table() -> dict[str, list[str]]:
    """Text of each page."""
    pages: dict[str, list[str]] = {}
    for path, model in _tables("", CaseFile):
        parts = _of_table(_titled(path), model)
        if path.startswith("losses"):
            rows = [(f"`{SET}`", SET_TOLD, "a name", "", "")]
            parts = _section("`[losses]`", LOSSES, rows) + parts
        name = _page_of(path)
        pages[name] = pages[name] + parts if name in pages else [parts[0][1:], *parts[1:]]
    pages["file"] += _of_table("A file of several stages", DriveCase)
    pages["file"] += _of_table("`[[stages]]`", StageTable)
    pages["file"] += _of_table("`[train]`", TrainTable)
    pages["materials"] += _of_table("`[materials]` of planetary sets and stages", DriveMaterials)
    tables = _tables("gears (planetary)", PlanetaryGears)
    first, *others = (part for path, model in tables for part in _of_table(f"`[{path}]`", model))
    pages["gears_planetary"] = [first[1:], *others]
    title, table = _of_table(f"`[{TASK_TABLE}]` of a task", Task)
    return {**pages, "marks": _marks(), TASK_TABLE: [title[1:], table]}


def _marks() -> list[str]:
    rows = [("`value`", "The value itself.", "as without marks", "", "needed")]
    kinds = {"status": ", ".join(f'`"{one}"`' for one in STATUSES)}
    rows += [(f"`{key}`", told, kinds.get(key, "text"), "", "") for key, told in MARKS.items()]
    return [f"# A value with marks\n\n{OF_MARKS}\n", _table(KEYS, rows)]


def _page_of(path: str) -> str:
    """Name of the page of a table: its outermost one, or one of several forms of that."""
    first = re.match(r"\w*( \([\w ]+\))?", path)
    return re.sub(r"\W+", "_", first.group() if first else "").strip("_") or "file"


def _title_of(page: str) -> str:
    return page.partition("\n")[0].removeprefix("# ")


def _first_words(page: str) -> str:
    """First sentence under the title."""
    words = page.partition("\n\n")[2].partition("\n\n")[0].strip()
    return re.split(r"(?<=[.;]) (?=[A-Z`])", words)[0].rstrip(";.") + "."


def _toctree(pages: Iterable[str]) -> str:
    names = "\n".join(path.removesuffix(".md") for path in pages)
    return f"```{{toctree}}\n:hidden:\n{names}\n```\n"


KEYS = ("key", "what it is", "value", "allowed", "unless given")
LOSSES = "Losses beside the teeth, each a table under a name of one's own, or those of a named set."
OF_MARKS = (
    "In place of any value may stand a table with the value and how it was come by, "
    '`module = { value = "2 mm", status = "printed", where = "Table 1" }`. Tables under '
    "`[variants.NAME]` say what differs in a variant, by the same keys."
)


def _of_table(title: str, model: type[BaseModel]) -> list[str]:
    told = key_sentences(model)
    rows = [_key_row(name, info, told.get(name, "")) for name, info in model.model_fields.items()]
    return _section(title, _words(model.__doc__), rows)


def _section(title: str, words: str, rows: Sequence[Row]) -> list[str]:
    return [f"## {title}\n\n{words}\n", _table(KEYS, rows)]


def variables_pages() -> dict[str, str]:
    """Every variable that a result may hold: by kind of quantity, and a page for each publication's own."""
    own = {name: one for each in ANALYSES.values() for name, one in each.variables.items()}
    intro = (
        "Names in the datasets of a result, in SI, by kind of quantity. `shown in` is the unit in which "
        "screen and report show them, unless `--units` or `[output]` of the case chose another. `side` says "
        "which side of the drive a torque, speed, angle or stiffness counts at: none is reduced to the "
        "other one."
    )
    parts, pages, printed = [_page_head("Variables of a result", intro)], {}, set()
    for name, publication in PUBLICATIONS.items():
        words = "Those of its formulas, in SI, beside those of every [result](variables.md)."
        head = _page_head(f"Variables of {name}", words)
        pages[f"variables_{name}.md"] = f"{head}\n{_of_variables(publication.variables)}"
        printed |= {*publication.variables}
    shared = {name: one for name, one in {**VARIABLES, **own}.items() if name not in printed}
    for title, chosen in _by_kind(shared).items():
        parts += [f"## {title}\n", _of_variables(chosen)]
    parts += [f"## Of publications\n\n{_links(pages)}\n", _toctree(pages)]
    return {"variables.md": "\n".join(parts), **pages}


def _links(pages: Mapping[str, str]) -> str:
    return "\n".join(f"- [{_title_of(text)}]({path})" for path, text in pages.items())


STRENGTH_TITLE, OTHERS = "Strength of the teeth", "Other quantities"
KINDS: dict[str, tuple[str, ...]] = {
    "Shares, factors and other plain numbers": ("dimensionless",),
    "Lengths, films and deviations": ("length",),
    "Angles": ("angle",),
    "Forces and pressures": ("force", "pressure", "line load"),
    "Torques": ("torque",),
    "Powers and energies": ("power", "energy"),
    "Stiffness and damping": ("stiffness", "torsional stiffness", "viscous damping"),
    "Speeds, times and frequencies": ("velocity", "rotational speed", "time", "frequency"),
    "Temperatures": ("temperature", "temperature difference"),
}


def _by_kind(variables: Mapping[str, Variable]) -> dict[str, dict[str, Variable]]:
    """Variables under titles."""
    rated = {*STRENGTH, *EXTREMES}
    titles = {kind: title for title, kinds in KINDS.items() for kind in kinds}
    found: dict[str, dict[str, Variable]] = {
        title: {} for title in (*KINDS, OTHERS, STRENGTH_TITLE)
    }
    for name, one in variables.items():
        title = STRENGTH_TITLE if name in rated else titles.get(one.kind, OTHERS)
        found[title][name] = one
    return found


def _of_variables(variables: Mapping[str, Variable]) -> str:
    rows = [
        (f"`{name}`", one.long_name, one.symbol, one.unit, one.usual, _SIDES.get(one.end, ""))
        for name, one in sorted(variables.items())
    ]
    return _table(("name", "what it is", "symbol", "unit", "shown in", "side"), rows)


_SIDES = {"driver": "input", "loaded": "output"}


def models_page() -> str:
    """Every law, oil and material with its range and sources."""
    parts = [_page_head("Laws, oils and materials", "What a case file may choose by name.")]
    known = entries()
    for kind in dict.fromkeys(one["kind"] for one in known):
        rows = [
            (f"`{one['name']}`", one["title"], one["range"], _note(one))
            for one in known
            if one["kind"] == kind
        ]
        parts.append(f"## {kind.capitalize().replace('_', ' ')}\n")
        parts.append(_table(("name", "what it is", "range", "note (sources)"), rows))
    return "\n".join(parts)


def _note(entry: Mapping[str, str]) -> str:
    """Remark and sources."""
    return " ".join(filter(None, (entry["note"], entry["sources"] and f"({entry['sources']})")))


TASKS: dict[str, str] = {
    "Run a case and read its result": "Case run Result open_result load_case write_report models cite",
    "Size a drive": "size bench three_k_sets three_k_tables",
    "Vary a case": "study sobol_indices Study Sweep gradients optimise Optimum",
    "Follow a duty cycle": "duty Motor RatedLife ThermalNetwork Heating",
    "Hand a joint to a simulator": "JointModel MapRange fit_friction",
    "Describe gears": (
        "CylindricalPair build_cylindrical_pair build_cylindrical_pairs StrainWave build_strain_wave "
        "build_strain_waves BallOnDisc TwinDisc Contacts"
    ),
    "Compute a mesh from arrays": (
        "Design Operation Models FrictionLaw cycle state state_grid double_precision"
    ),
    "Differentiate a mesh": "mean_loss_gradient input_torque_gradient ripple_gradient",
    "Solve films of line contacts": (
        "FilmModel LineContact Fluid Rough Conduction Conductor solve_lines film_dataset films_of_dataset"
    ),
    "Solve films of ellipses and finite lines": (
        "finite_line elliptic_contact HeightMap solve_patch film_near march_patches patch_dataset "
        "march_dataset"
    ),
    "Catch errors": "PitchpointError InputError ConvergenceError",
}
"""Public names by what they are for; those that are not here come under a title of their own."""


def api_page() -> str:
    """Every public name by task, from its docstring."""
    intro = "What `import pitchpoint as pp` has. Names are loaded when they are first asked for."
    parts = [_page_head("Python", intro)]
    tasks = {title: names.split() for title, names in TASKS.items()}
    known = {name for names in tasks.values() for name in names}
    for title, names in {**tasks, "More": sorted({*pitchpoint._LAZY} - known)}.items():
        parts += [f"## {title}\n"] * bool(names) + [_documented(name) for name in names]
    return "\n".join(parts)


def _documented(name: str) -> str:
    what = getattr(pitchpoint, name)
    kind = "class" if isinstance(what, type) else "function"
    options = "\n   :members:" if kind == "class" else ""
    directive = f".. auto{kind}:: {what.__module__}.{name}{options}"
    return f"### pp.{name}\n\n```{{eval-rst}}\n{directive}\n```\n"


def pages() -> dict[str, str]:
    """Text of every page by the name of its file."""
    plain = {"models.md": models_page(), "api.md": api_page()}
    return {**keys_pages(), **variables_pages(), **plain}


def write(folder: Path) -> None:
    """Write all pages into a folder, those that have not changed left alone."""
    folder.mkdir(exist_ok=True)
    for name, text in pages().items():
        path = folder / name
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, "utf-8")


def _tables(path: str, model: type[BaseModel]) -> Iterator[tuple[str, type[BaseModel]]]:
    """Tables below a table, itself first, every form of each."""
    yield path, model
    for name, info in model.model_fields.items():
        below = f"{path}.{name}".strip(".")
        if get_origin(info.annotation) is dict:
            inner = alternatives(get_args(info.annotation)[1])
            below += ".NAME"
        elif get_origin(info.annotation) is tuple:
            inner = alternatives(get_args(info.annotation)[0])
        else:
            inner = alternatives(info.annotation)
        for form, each in inner.items():
            yield from _tables(f"{below} ({form})" if len(inner) > 1 else below, each)


def _titled(path: str) -> str:
    return f"`[{path}]`" if path else "The file itself"


def _key_row(name: str, info: FieldInfo, sentence: str) -> Row:
    quantity = field_quantity(info)
    allowed = quantity.allowed.removeprefix("allowed is ") if quantity else ""
    return f"`{name}`", sentence, _kind(info), allowed, _default(info)


def _kind(info: FieldInfo) -> str:
    """What a value is, in words."""
    quantity = field_quantity(info)
    if quantity is not None:
        return "number" if quantity.kind == "dimensionless" else quantity.kind
    every = [*_inside(info.annotation)]
    kinds = {dict: "table", tuple: "list", bool: "`true` or `false`", Any: "any value"}
    literals = [f'`"{one}"`' for one in every if isinstance(one, str)]
    literals += [f"`{one}`" for one in every if isinstance(one, int)]
    several = next((told for kind, told in kinds.items() if kind in every), "text")
    by_name = any(hasattr(getattr(one, "func", None), "known") for one in (*info.metadata, *every))
    if alternatives(info.annotation):
        table = "list of tables" if tuple in every else "table"
        return f"{table}, or a name" if by_name else table
    return "a name" if by_name else ", ".join(literals) or several


def _inside(annotation: Any) -> Iterator[Any]:
    """Types that an annotation is made of, what they are made of, and what is said of them."""
    yield get_origin(annotation) or annotation
    for one in get_args(annotation):
        yield from _inside(one)


def _default(info: FieldInfo) -> str:
    if info.is_required():
        return "needed"
    value = info.default if info.default_factory is None else None
    usual = usual_words(info).removeprefix("default ")
    if usual or not isinstance(value, str | int) or value == "":
        return usual
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _page_head(title: str, intro: str) -> str:
    return f"# {title}\n\n{intro}\n"


def _words(doc: str | None) -> str:
    return " ".join((doc or "").split("Attributes:")[0].split())


def _table(head: Row, rows: Sequence[Row]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    cells = ([cell.replace("|", "\\|").replace("\n", " ") for cell in line] for line in lines)
    return "\n".join(f"| {' | '.join(line)} |" for line in cells) + "\n"


if __name__ == "__main__":
    write(Path(sys.argv[1]))
