"""Case files to begin with: one for each family, with every optional key as a remark."""

import inspect
import textwrap
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import resources
from typing import Any, Literal, get_args, get_origin

import tomlkit
from pydantic import BaseModel, BeforeValidator
from pydantic.fields import FieldInfo

from pitchpoint.cases.document import STAGES, Tree
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.loss_sets import SET
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.wishes import no_family
from pitchpoint.errors import InputError, shorten
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.gears.planetary import PLANETARY
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import alternatives, field_quantity, forms, key_sentences, tag
from pitchpoint.registry import known_as

__all__ = ["FAMILIES", "sample_tree", "table_lines", "template"]

_CYLINDRICAL = ("spur", "helical")
"""Kinds of cylindrical gears."""

_MORE: Mapping[str, Tree] = {
    "helical": {"gears": {"helix_angle": "15 deg"}},
    "strain_wave": {
        "gears": {"wave_generator": {"bearing": {}}, "yielding": {}},
        "losses": {"set": "strain_wave_component"},
    },
}
"""What a case to begin with has beside the sample of its family, such as all that loses and yields."""

_DRIVES = {"two_stages": "stages.toml", PLANETARY: "planetary.toml", "3K": "three_k.toml"}
"""Samples of drives of several meshes, by name."""

FAMILIES = (*(tag(table) for table in TABLES), *_CYLINDRICAL, *_DRIVES)
"""What a case file may begin with."""

_MEANT = ("gears", STAGES, "train", "materials", "lubricant", "roughness", "operation", "models")
"""Tables that stand in it; all others are remarks."""

_TASKED = ("strength",)
"""Tables that stand in it where they are asked for."""

_ARRANGING = ("gears", STAGES, "train")
"""Tables on how gears stand together, of which a case has the ones or the others."""

_TYPICAL: Mapping[str, Any] = {
    "planet_angles": ["0 deg", "120 deg", "240 deg"],
    "dedendum": 1.25,
    "cutter_teeth": 20,
    "cutter_profile_shift": 0.1,
    "tip_alteration": -0.05,
    "least_tip_thickness": 0.25,
    "pin_errors": ["20 um", "0 um", "0 um"],
    "pin_tolerance": "20 um",
    "thickness_tolerance": "20 um",
    "planet_runout": "20 um",
    "central_runout": "20 um",
    "pin_stiffness": "200 N/um",
    "upper_thickness_allowance": "-40 um",
    "lower_thickness_allowance": "-70 um",
    "thickness_field": "cd25",
    "centre_distance_deviation": "15 um",
    "iso_class": 7,
    "life": "10000 h",
}
"""Examples of keys for which that of their unit is none of gears."""

_LEFT_OUT = ("title", "summary", "source", "targets", "issues", "formulas", "studies")
_WIDTH = 100
_FEW = 9
"""Names that are listed in a remark."""


def template(family: str, changes: Tree | None = None, remarks: Sequence[str] = ()) -> str:
    """A case file that runs as it is, its optional keys as remarks with kind, range and usual value.

    Args:
        family: one of `FAMILIES`.
        changes: tables with values in the place of those of the sample.
        remarks: sentences at its head.

    Raises:
        InputError: there is no such family.
    """
    family_name = known_as(family, FAMILIES)
    if family_name is None and family.endswith(".toml"):
        raise InputError(
            f"'{shorten(family)}' is a file and no family of gears; write new spur -o FILE"
        )
    if family_name is None:
        raise InputError(f"'{shorten(family)}' is no family of gears{no_family(family, FAMILIES)}")
    model, sample = _sample(family_name)
    tree = _changed(sample, changes or {})
    remark_lines = (line for text in remarks for line in textwrap.wrap(text, _WIDTH - 2))
    lines = [
        f"# A case of Pitchpoint, {family_name.replace('_', ' ')}. It runs as it is: pitchpoint run FILE.",
        "# Keys behind a # are optional; what they say is the usual value, or an example of one.",
        "# pitchpoint check FILE tells all that is wrong, pitchpoint models every law, oil and material.",
        *(f"# {line}" for line in remark_lines),
        f"title = {_toml('My ' + family_name.replace('_', ' '))}",
        *(line for key in model.model_fields for line in _of_table(model, key, tree)),
        "",
        "# [variants.rough.roughness]  # a variant says what differs",
        '# ra = "0.8 um"',
    ]
    return "\n".join(lines) + "\n"


def sample_tree(family: str, changes: Tree) -> Tree:
    """Tables of a sample, with changes as `template` takes them."""
    return _changed(_sample(family)[1], changes)


def _changed(tree: Tree, changes: Tree) -> Tree:
    """Tables with other values in them; lists as a whole."""
    merged = dict(tree)
    for key, value in changes.items():
        before = tree.get(key)
        if isinstance(before, dict) and isinstance(value, dict):
            merged[key] = _changed(before, value)
        else:
            merged[key] = value
    return merged


def _sample(family: str) -> tuple[type[BaseModel], Tree]:
    """Sound tables of a family, from the sample beside it."""
    if family in _DRIVES:
        path = resources.files("pitchpoint.cases") / _DRIVES[family]
        return DriveCase, tomllib.loads(path.read_text("utf-8"))
    name = "cylindrical" if family in _CYLINDRICAL else family
    table = next(table for table in TABLES if tag(table) == name)
    tree = tomllib.loads(sample_of(table).read_text("utf-8"))
    tables = _MORE.get(family, {})
    tree["gears"] = {"family": name, **tree["gears"], **tables.get("gears", {})}
    return CaseFile, {**tree, **{key: table for key, table in tables.items() if key != "gears"}}


def _of_table(model: type[BaseModel], key: str, tree: Tree) -> Iterator[str]:
    """Lines of a table at the top of the file."""
    if key in _LEFT_OUT or (key in _ARRANGING and key not in tree):
        return
    info, stated = model.model_fields[key], tree.get(key)
    if key == STAGES:
        yield from _of_stages(tree[STAGES])
    elif get_origin(info.annotation) is dict:
        live = "" if SET in (stated or {}) else "# "
        yield ""
        yield from (
            f"{live}{line}" for line in tomlkit.dumps({key: stated or {}}).splitlines() if stated
        )
    else:
        meant = forms(info.annotation, stated)[0]
        meant_here = key in (*_MEANT, *_TASKED) and key in tree
        yield from table_lines(meant, key, stated or {}, live=meant_here)


def _of_stages(stages: Sequence[Tree]) -> Iterator[str]:
    yield from (
        "",
        "# From the input to the output; a stage may have materials and models of its own.",
    )
    for stage in stages:
        yield "[[stages]]"
        yield from (f"{key} = {_toml(value)}" for key, value in stage.items())


def table_lines(model: type[BaseModel], path: str, given: Tree, *, live: bool) -> Iterator[str]:
    """Lines of a table with all of its keys, then those of the tables in it.

    Args:
        model: of the table.
        path: its name in the file.
        given: values that stand in it.
        live: False for a table that is a remark as a whole.
    """
    yield ""
    yield from _remark(model)
    yield f"{'' if live else '# '}[{path}]"
    inner, descriptions = [], key_sentences(model)
    for key, info in model.model_fields.items():
        tables = _inner(info, given.get(key))
        if tables is not None:
            inner.append((key, tables))
        elif live and key in given:
            yield f"{key} = {_toml(given[key])}{_words(info, descriptions.get(key, ''))}"
        else:
            value = _TYPICAL.get(key, _example(info))
            yield f"# {key} = {_toml(value)}{_words(info, descriptions.get(key, ''))}"
    for key, table in inner:
        below = live and key in given and key != "deviations"
        yield from table_lines(table, f"{path}.{key}", given.get(key, {}), live=below)


def _inner(info: FieldInfo, given: Any) -> type[BaseModel] | None:
    """The table that stands at a key; None for values, and for what may be a name as well."""
    tables = alternatives(info.annotation)
    several = get_origin(info.annotation) in (tuple, dict)
    by_name = any(
        _known(mark) for option in get_args(info.annotation) for mark in _metadata(option)
    )
    if not tables or several or by_name:
        return None
    return forms(info.annotation, given)[0]


def _metadata(option: Any) -> tuple[Any, ...]:
    return tuple(getattr(option, "__metadata__", ()))


def _remark(model: type[BaseModel]) -> Iterator[str]:
    """What the table is, up to its attributes."""
    words = inspect.getdoc(model) or ""
    for part in words.partition("\nAttributes:")[0].strip().split("\n\n"):
        plain = " ".join(part.replace("`", "").split())
        yield from (f"# {line}" for line in textwrap.wrap(plain, _WIDTH - 2))


def _known(mark: Any) -> list[str]:
    """Names out of a registry that a key takes; none where it takes others."""
    function = getattr(mark, "func", None) if isinstance(mark, BeforeValidator) else None
    names: Callable[[], list[str]] | None = getattr(function, "known", None)
    return [] if names is None else list(names())


def _names(info: FieldInfo) -> list[str]:
    every = [
        *info.metadata,
        *(mark for opt in get_args(info.annotation) for mark in _metadata(opt)),
    ]
    return next(filter(None, map(_known, every)), [])


def _options(info: FieldInfo) -> tuple[Any, ...]:
    annotations = (info.annotation, *get_args(info.annotation))
    return next(
        (get_args(annotation) for annotation in annotations if get_origin(annotation) is Literal),
        (),
    )


def _example(info: FieldInfo) -> Any:
    """The usual value of a key, or one that it may have."""
    quantity, usual = field_quantity(info), info.default
    if info.is_required() and info.examples:
        return info.examples[0]
    if quantity is not None:
        value = _of_quantity(quantity, usual if not info.is_required() else None)
        listed = get_origin(info.annotation) is tuple and not _pair(info)
        return [value] if listed else value
    if info.examples:
        return info.examples[0]
    if isinstance(usual, str | bool) and (usual != "" or not _names(info)):
        return usual
    if usual and isinstance(usual, tuple) and all(isinstance(name, str) for name in usual):
        return [*usual]
    if choices := (_names(info) or _options(info)):
        return choices[0]
    tables = alternatives(info.annotation)
    if tables:
        table = next(iter(tables.values()))
        example = {
            key: _example(field) for key, field in table.model_fields.items() if field.is_required()
        }
        kind = get_origin(info.annotation)
        return [example] if kind is tuple else {"name": example} if kind is dict else example
    return False if bool in (info.annotation, *get_args(info.annotation)) else "text"


def _pair(info: FieldInfo) -> bool:
    every = [
        *info.metadata,
        *(mark for opt in get_args(info.annotation) for mark in _metadata(opt)),
    ]
    return any(isinstance(mark, Pair) for mark in every)


def _of_quantity(quantity: Quantity, usual: Any) -> Any:
    """The usual value in the unit in which it is shown, or one in its range."""
    if isinstance(usual, tuple) and usual and isinstance(usual[0], float):
        words = [value if isinstance(value, str) else quantity.show(value) for value in usual]
        numbers = [*map(_read, words)]
        return numbers[0] if len(set(map(str, numbers))) == 1 else numbers
    if isinstance(usual, float):
        return _read(quantity.show(usual))
    return _read(quantity.example.strip('"'))


def _read(text: str) -> str | float:
    """A number where the text is one."""
    try:
        number = float(text)
    except ValueError:
        return text
    return int(number) if number == round(number) and abs(number) < 1e9 else number


def _words(info: FieldInfo, sentence: str) -> str:
    """What a key is, and what it takes, as a remark behind it."""
    quantity, names = field_quantity(info), _names(info)
    if quantity is not None:
        allowed = quantity.allowed
    elif names:
        allowed = f"one of {', '.join(names)}" if len(names) <= _FEW else "see pitchpoint models"
    elif _options(info):
        allowed = f"one of {', '.join(map(str, _options(info)))}" if len(_options(info)) > 1 else ""
    else:
        allowed = ""
    words = "; ".join(filter(None, [sentence.rstrip("."), allowed]))
    return f"  # {words}" if words else ""


def _toml(value: Any) -> str:
    """A value as TOML has it, tables in braces."""
    if isinstance(value, Mapping):
        inner = ", ".join(
            f"{tomlkit.key(key).as_string()} = {_toml(inner_value)}"
            for key, inner_value in value.items()
        )
        return f"{{ {inner} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return str(tomlkit.item(value).as_string())
