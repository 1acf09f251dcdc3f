"""Pages of the reference that come from the schema and the registries: `python docs/generate.py FOLDER`."""

import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

import pitchpoint
from pitchpoint.analyses.registry import ANALYSES
from pitchpoint.cases.document import MARKS, STATUSES
from pitchpoint.cases.loss_sets import SET, SET_TOLD
from pitchpoint.cases.schema import Case, DriveCase, StageTable, quantity_of, usual_words
from pitchpoint.input.tables import alternatives, sentences
from pitchpoint.published.registry import PUBLICATIONS
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.catalogue import entries

__all__ = ["PAGES", "keys_page", "models_page", "variables_page", "write"]

Row = Sequence[str]


def keys_page() -> str:
    """Every key of a case file, by table."""
    intro = (
        'Every table of a case file and its keys. A quantity is written with its unit (`"2 mm"`), in that of '
        "the column or any other of its kind. `pitchpoint show FILE` lists what a file leaves open."
    )
    parts = [_page_head("Keys of a case file", intro)]
    for path, model in _tables("", Case):
        if path.startswith("losses"):
            parts += _section("`[losses]`", LOSSES, [(f"`{SET}`", SET_TOLD, "a name", "", "")])
        parts += _of_table(_titled(path), model)
    parts += _of_table("A file of several stages", DriveCase)
    parts += _of_table("`[[stages]]`", StageTable)
    rows = [("`value`", "The value itself.", "as without marks", "", "needed")]
    kinds = {"status": ", ".join(f'`"{one}"`' for one in STATUSES)}
    rows += [(f"`{key}`", told, kinds.get(key, "text"), "", "") for key, told in MARKS.items()]
    parts += _section("A value with marks", OF_MARKS, rows)
    return "\n".join(parts)


LOSSES = "Losses beside the teeth, each a table under a name of one's own, or those of a named set."
OF_MARKS = (
    "In place of any value may stand a table with the value and how it was come by, "
    '`module = { value = "2 mm", status = "printed", where = "Table 1" }`. Tables under '
    "`[variants.NAME]` say what differs in a variant, by the same keys."
)


def _of_table(title: str, model: type[BaseModel]) -> list[str]:
    told = sentences(model)
    rows = [_key_row(name, info, told.get(name, "")) for name, info in model.model_fields.items()]
    return _section(title, _words(model.__doc__), rows)


def _section(title: str, words: str, rows: Sequence[Row]) -> list[str]:
    head = ("key", "what it is", "value", "allowed", "unless given")
    return [f"## {title}\n\n{words}\n", _table(head, rows)]


def variables_page() -> str:
    """Every variable that a result may hold."""
    every = (*ANALYSES.values(), *PUBLICATIONS.values())
    own = {name: one for each in every for name, one in each.variables.items()}
    rows = [
        (f"`{name}`", one.long_name, one.symbol, one.unit, one.usual, _SIDES.get(one.end, ""))
        for name, one in sorted({**VARIABLES, **own}.items())
    ]
    intro = (
        "Names in the datasets of a result, in SI. `shown in` is the unit in which screen and report show "
        "them, unless `--units` or `[output]` of the case chose another. `side` says which side of the drive "
        "a torque, speed, angle or stiffness counts at: none is reduced to the other one."
    )
    head = ("name", "what it is", "symbol", "unit", "shown in", "side")
    return _page_head("Variables of a result", intro) + "\n" + _table(head, rows)


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


def api_page() -> str:
    """Every public name, from its docstring."""
    intro = "What `import pitchpoint as pp` has. Names are loaded when they are first asked for."
    parts = [_page_head("Python", intro)]
    for name in sorted(pitchpoint._LAZY, key=str.lower):
        what = getattr(pitchpoint, name)
        kind = "class" if isinstance(what, type) else "function"
        options = "\n   :members:" if kind == "class" else ""
        directive = f".. auto{kind}:: {what.__module__}.{name}{options}"
        parts.append(f"## pp.{name}\n\n```{{eval-rst}}\n{directive}\n```\n")
    return "\n".join(parts)


PAGES = {
    "keys.md": keys_page,
    "variables.md": variables_page,
    "models.md": models_page,
    "api.md": api_page,
}


def write(folder: Path) -> None:
    """Write all pages into a folder, those that have not changed left alone."""
    folder.mkdir(exist_ok=True)
    for name, page in PAGES.items():
        path, text = folder / name, page()
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
    quantity = quantity_of(info)
    allowed = quantity.allowed.removeprefix("allowed is ") if quantity else ""
    return f"`{name}`", sentence, _kind(info), allowed, _default(info)


def _kind(info: FieldInfo) -> str:
    """What a value is, in words."""
    quantity = quantity_of(info)
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
