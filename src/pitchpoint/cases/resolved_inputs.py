"""The inputs of a case as resolved: numbers in SI with kind, status and place; views make words of them."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np
from pydantic import BaseModel

from pitchpoint._jax import array
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import BuiltDrive, Ready
from pitchpoint.cases.document import STAGES, Document, Provenance, leaves
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.laws import FrictionChoice
from pitchpoint.cases.loss_sets import SET, marks_of
from pitchpoint.cases.record import OUTPUT
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.study_tables import Study
from pitchpoint.cases.validation import with_meshes
from pitchpoint.core.plain_files import digest_of
from pitchpoint.duty_cycle.duty_table import LARGEST
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.family import Followed
from pitchpoint.gears.gears_table import SmallerOfTwo
from pitchpoint.gears.mesh import has
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL
from pitchpoint.lubrication.ehl.film_tables import MEMBERS
from pitchpoint.results.variables import VARIABLES
from pitchpoint.units import hardness_scale

__all__ = [
    "DIMENSIONS",
    "OIL",
    "SOLIDS",
    "STUDIES",
    "Row",
    "following_rows",
    "input_rows",
    "resolved",
]

DIMENSIONS, SOLIDS, OIL, STUDIES = "dimensions", "solids", "oil", "studies"
"""Tables of rows on what follows from the gears, on materials and oil as they are used, and on studies."""

_TABLES = (
    "gears",
    "materials",
    "lubricant",
    "roughness",
    "operation",
    "models",
    "housing",
    "losses",
    "dynamics",
    "film",
    "wear",
    "worn",
    "strength",
    "loss_map",
    "duty",
    OUTPUT,
    "formulas",
)

_DIMENSIONS = (
    "transverse_contact_ratio",
    "overlap_ratio",
    "circumferential_backlash",
    "normal_backlash",
    "tip_thickness",
    "undercut_limit",
    "transverse_radius",
    "contact_place",
    "contact_room",
    "misalignment_approach",
    "speed_ratio",
    "deflection",
    "neutral_radius",
    "engagement_depth",
)
"""What follows from the gears and is asked for first."""

_SOLID = {"young": "pressure", "poisson": "dimensionless", "density": "density"}
_FLANK = {"hardness": "hardness"}
_CONDUCTS = {"conductivity": "thermal conductivity", "specific_heat": "specific heat"}

_OIL = {
    "nu_0": "kinematic viscosity",
    "nu_1": "kinematic viscosity",
    "nu_2": "kinematic viscosity",
    "T_1": "temperature",
    "T_2": "temperature",
    "density_15": "density",
    "density_slope": "density slope",
    "gold_s": "dimensionless",
    "gold_t": "dimensionless",
    "lubricant_factor": "dimensionless",
    "conductivity": "thermal conductivity",
    "T_min": "temperature",
    "T_max": "temperature",
    "free_volume_factor": "dimensionless",
    "occupied_volume": "dimensionless",
    "occupied_expansion": "temperature coefficient",
    "volume_temperature": "temperature",
    "modulus_rise": "dimensionless",
    "modulus_cold": "pressure",
    "modulus_slope": "temperature coefficient",
    "expansion": "temperature coefficient",
}

Row = dict[str, Any]

_DEFAULT = Provenance("default")


def resolved(
    built: Ready, document: Document, studies: Mapping[str, Study] | None = None
) -> list[Row]:
    """Rows for every input: those of `input_rows`, then those of `following_rows`."""
    return [*input_rows(built, document, studies), *following_rows(built)]


def input_rows(
    built: Ready, document: Document, studies: Mapping[str, Study] | None = None
) -> list[Row]:
    """Rows of table, key, value, kind, status, where and note for every key of the tables of a case.

    Values are SI numbers, texts, or lists of them or of tables; `kind` is that of the numbers, of a list
    of tables by their keys. Rows with `given` are those that the case file holds, and enough to make the
    case again; the others are defaults and what followed.

    Args:
        built: the case.
        document: it came from.
        studies: beside those of the case.
    """
    every = {**built.case.studies, **(studies or {})}
    study_rows = (
        _of_drive(cast(BuiltDrive, built), document)
        if built.numbers
        else _of_mesh(built.meshes[0], document)
    )
    return [
        *study_rows,
        *(row for name, study in every.items() for row in _of_study(name, study, document)),
    ]


def _of_mesh(built: Built, document: Document) -> Iterator[Row]:
    following = {"gears": built.following, "film": _of_films(built)}
    for table in _TABLES:
        yield from _rows(built.case, document, table, following.get(table))
    if built.case.film is None:
        for key, source in following["film"].items():
            yield _row("film", key, source.value, _kind(f"film.{key}", source.value), _mark(source))
    yield from _digests(built)


def _digests(built: Built) -> Iterator[Row]:
    """What tells the content of files with heights and with worn flanks from any other."""
    if built.case.worn is not None:
        yield _digest("worn", "digest", digest_of(built.case.worn.file))
    yield from _digest_of_duty(built)
    heights = None if built.case.film is None else built.case.film.heights
    for name in MEMBERS:
        height_table = getattr(heights, name, None)
        if height_table is not None:
            yield _digest("film", f"heights.{name}.digest", digest_of(height_table.file))


def _digest_of_duty(built: Ready) -> Iterator[Row]:
    """What tells a load over time in a file from any other."""
    if built.case.duty is not None:
        yield _digest("duty", "digest", digest_of(built.case.duty.file, LARGEST))


def _digest(table: str, key: str, digest: str) -> Row:
    return _row(
        table, key, digest, "", Provenance("derived", note="SHA-256 of what the file holds")
    )


def _of_films(built: Ready) -> dict[str, Followed]:
    """Choices by which films are solved, as they are where the case leaves them open."""
    if built.film_model is None:
        return {}
    from pitchpoint.cases.film_choices import CHOICE_NOTES, film_choices

    every = film_choices(built.film_model, built.case.film)
    return {
        key: Followed(value, "default", CHOICE_NOTES.get(key, "")) for key, value in every.items()
    }


def _mark(found: Followed) -> Provenance:
    return Provenance(found.status, note=found.note)


def _of_drive(built: BuiltDrive, document: Document) -> Iterator[Row]:
    """Rows of the stages, then those of the tables that they share."""
    short = built.case.gears is not None  # for which the stages stand
    document = with_meshes(document)
    for number, stage, inside in zip(built.numbers, built.stages, built.documents, strict=True):
        stage_tree = document.tree[STAGES][str(number)]
        following = {"gears": stage.following, "film": _of_films(stage)}
        for table in ("gears", *(key for key in _OF_STAGE if key in stage_tree)):
            for row in _rows(stage.case, inside, table, following.get(table)):
                holds = not short and _holds(stage_tree, table, row["key"])
                follows = {"status": "derived"} if short and row["status"] == "given" else {}
                yield _in_stage({**row, **follows}, number, given=holds)
        for mesh in stage.meshes:
            yield from (_in_stage(row, number, given=False) for row in _digests(mesh))
        for key in ("bodies", "driver", "place", "turn"):
            if key in stage_tree and not short:
                path, value = f"{number}.{key}", getattr(built.case.stages[str(number)], key)
                mark = document.provenance.get(f"{STAGES}.{path}", Provenance())
                yield _row(STAGES, path, value, _kind(f"{STAGES}.{path}", value), mark, given=True)
    for table in _TABLES if short else ("train", *_TABLES):
        if table == "models":
            yield from _models(built, document)
        elif hasattr(built.case, table):
            yield from (row for row in _rows(built.case, document, table) if row["value"] != "")
    yield from _digest_of_duty(built)


def _models(built: BuiltDrive, document: Document) -> Iterator[Row]:
    """Rows of the models, once where no stage has its own."""
    of_drive = {row["key"]: row for row in _rows(built.case, document, "models") if row["given"]}
    of_stages = [
        {row["key"]: row for row in _rows(one.case, inside, "models")}
        for one, inside in zip(built.stages, built.documents, strict=True)
    ]
    trees = [document.tree[STAGES][str(number)] for number in built.numbers]
    for key in of_stages[0]:
        rows, stated = (
            [one[key] for one in of_stages],
            [_holds(tree, "models", key) for tree in trees],
        )
        if not any(stated) and all(row["value"] == rows[0]["value"] for row in rows):
            yield rows[0]
            continue
        yield from (of_drive[key] for _ in range(key in of_drive))
        for number, row, in_stage in zip(built.numbers, rows, stated, strict=True):
            yield _in_stage(row, number, given=in_stage)


_OF_STAGE = (
    "materials",
    "lubricant",
    "roughness",
    "losses",
    "strength",
    "film",
    "wear",
    "worn",
    "dynamics",
)
"""Tables that a stage may have of its own, beside gears and models."""


def _holds(tree: Mapping[str, Any], table: str, key: str) -> bool:
    """True if a stage has a value of its own at a key of a table."""
    stated = dict(leaves({table: tree.get(table, {})}))
    path = f"{table}.{key}"
    return any(leaf == path or leaf.startswith(f"{path}.") for leaf in stated)


def _in_stage(row: Row, number: int, *, given: bool) -> Row:
    """Row of a stage; which flanks touch follows from the stages before it where it is left open."""
    status = "derived" if row["key"] == "flank" and not given else row["status"]
    changed = {"table": STAGES, "key": f"{number}.{row['table']}.{row['key']}"}
    return {**row, **changed, "given": given, "status": status}


def following_rows(built: Ready) -> Iterator[Row]:
    """Rows of what follows from gears, materials and oil; of a drive by stage."""
    one_oil = all(mesh.lubricant == built.meshes[0].lubricant for mesh in built.meshes)
    for label, mesh in zip(built.mesh_labels, built.meshes, strict=True):
        rows = [
            *_dimensions(mesh),
            *_inertia(mesh),
            *(row for gear in (1, 2) for row in _of_solid(mesh, gear)),
        ]
        rows += [] if one_oil else _of_oil(mesh)
        of_stage = f"stage {label}." if label else ""
        yield from ({**row, "key": f"{of_stage}{row['key']}"} for row in rows)
    if one_oil:
        yield from _of_oil(built.meshes[0])


def _of_oil(built: Built) -> Iterator[Row]:
    data = built.lubricant.data()
    for name, kind in _OIL.items():
        datum = data.get(name)
        if datum is None:
            continue
        bend = built.lubricant.bend if name == "nu_0" else ""
        mark = Provenance(datum.status, datum.source, "; ".join(filter(None, [datum.note, bend])))
        yield _row(OIL, name, datum.value, kind, mark)


def _row(
    table: str, key: str, value: Any, kind: Any, mark: Provenance, *, given: bool = False
) -> Row:
    return {
        "table": table,
        "key": key,
        "value": _plain(value),
        "kind": kind,
        "status": mark.status,
        "where": mark.where,
        "note": mark.note,
        "given": given,
    }


def _rows(
    case: CaseFile | DriveCase,
    document: Document,
    table: str,
    following: Mapping[str, Any] | None = None,
) -> Iterator[Row]:
    """Rows of a table of the case file; `following` are values of what it leaves open."""
    stated = dict(leaves({table: document.tree[table]})) if table in document.tree else {}
    ends = ((path, at) for path in stated for at, sign in enumerate(f"{path}.") if sign == ".")
    held = {path[:end] for path, end in ends}  # with the tables above each value
    derived = following or {}
    usual = marks_of(document.tree.get(table)) if table == "losses" else {}
    for key, left in _leaves(getattr(case, table)):
        followed = _followed(derived.get(key)) if left is None else None
        path, value = f"{table}.{key}", left if followed is None else followed.value
        if value is None:
            continue
        value = _plain(value)
        if path in held:
            mark = document.provenance.get(path, Provenance())
            mark = _scaled(mark, path, document, stated.get(path))
            yield _row(table, key, value, _kind(path, value), mark, given=True)
        else:
            mark = usual.get(key, _DEFAULT if followed is None else _mark(followed))
            yield _row(table, key, value, _kind(path, value), mark)
    for path, value in stated.items():
        key = path[len(table) + 1 :]
        if value == {} or (usual and key == SET):
            mark = document.provenance.get(path, Provenance())
            yield _row(table, key, value, "", mark, given=True)


def _scaled(mark: Provenance, path: str, document: Document, given: Any) -> Provenance:
    """The mark of a value, with the scale of a hardness, and that of which two it is the smaller."""
    usual = quantity_at(path)  # is kept; that of the very family takes longer
    if not isinstance(given, list) and (usual is None or usual.kind != "hardness"):
        return mark
    quantity = quantity_at(path, document.tree)
    if isinstance(quantity, SmallerOfTwo) and isinstance(given, list):
        remark = f"the smaller of {given[0]} and {given[1]}, as wide as which both bodies count"
        return replace(mark, note="; ".join(filter(None, [mark.note, remark])))
    scale = hardness_scale(given) if quantity is not None and quantity.kind == "hardness" else ""
    if not scale:
        return mark
    remark = (
        f"given as {given}; a {scale} number is kgf/mm2 over its own indentation, used as it is"
    )
    return replace(mark, note="; ".join(filter(None, [mark.note, remark])))


def _followed(found: Any) -> Followed:
    """A value that a table leaves open, with how it was come by."""
    return found if isinstance(found, Followed) else Followed(found, "derived", "")


def _leaves(table: Any) -> Iterator[tuple[str, Any]]:
    """Dotted keys and values of a table and of the tables in it; None for what is left open."""
    for key, value in dict(table or {}).items():
        if isinstance(value, BaseModel) or _are_tables(value):
            yield from ((f"{key}.{name}", leaf) for name, leaf in _leaves(value))
        else:
            yield key, value


def _are_tables(value: Any) -> bool:
    """True for tables by names of the user's own, be there none."""
    return isinstance(value, dict) and all(isinstance(table, BaseModel) for table in value.values())


def _of_study(name: str, study: Study, document: Document) -> Iterator[Row]:
    """Rows of a study: its title, its changes, its sweep."""
    for key, setting in leaves({name: study.model_dump(exclude_unset=True)}):
        path = f"{STUDIES}.{key}"
        subject = _subject(key.removeprefix(f"{name}."), study) or path
        value, mark = _in_si(subject, setting), document.provenance.get(path, Provenance())
        yield _row(STUDIES, key, value, _kind(subject, value), mark, given=True)


def _subject(key: str, study: Study) -> str:
    """Key of the case whose value stands at a key of a study; empty if none does."""
    if key.startswith("change."):
        return key.removeprefix("change.")
    if study.sweep is not None and key in ("sweep.start", "sweep.stop", "sweep.values"):
        return study.sweep.key
    return ""


def _in_si(key: str, value: Any) -> Any:
    """A value as a case file has it, with its quantities as SI numbers."""
    if isinstance(value, Mapping):
        return {name: _in_si(f"{key}.{name}", item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_in_si(key, item) for item in value]
    quantity = quantity_at(key)
    return value if quantity is None else quantity.si(value)


def _kind(key: str, value: Any) -> str | dict[str, str]:
    """Kind of the numbers at a key; by key of the tables where it holds a list of them; none of a text."""
    if isinstance(value, str):
        return ""
    tables = (
        [table for table in value if isinstance(table, dict)] if isinstance(value, list) else []
    )
    if tables:
        inner = {name: quantity_at(f"{key}.{name}") for table in tables for name in table}
        return {name: quantity.kind for name, quantity in inner.items() if quantity is not None}
    quantity = quantity_at(key)
    return "" if quantity is None else quantity.kind


def _plain(value: Any) -> Any:
    """A value as JSON has it."""
    if isinstance(value, str | bool | dict):  # first what most of them are
        return value
    if isinstance(value, float | int):
        return float(value)
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    if isinstance(value, FrictionChoice):
        return {"name": value.name, **value.parameters}
    return value.model_dump() if isinstance(value, BaseModel) else np.asarray(value, float).tolist()


def _dimensions(built: Built) -> Iterator[Row]:
    dimensions, mark = built.dimensions, Provenance("derived")
    for name in _DIMENSIONS:
        if name in dimensions:
            variable = VARIABLES.get(name) or VARIABLES[f"{name}_1"]
            if name == "undercut_limit" and getattr(built.design.mesh, "internal", False):
                # No rack cuts a ring.
                limit = np.asarray(dimensions[name]).tolist()[0]
                yield _row(DIMENSIONS, f"gear_1.{name}", limit, variable.kind, mark)
                continue
            yield _row(DIMENSIONS, name, dimensions[name], variable.kind, mark)
    cut = built.following.get("generating_shift")
    if cut is not None:
        yield _row(DIMENSIONS, "generating_shift", cut.value, "dimensionless", _mark(cut))


def _inertia(built: Built) -> Iterator[Row]:
    """Moments of inertia that a vibration takes where the case gives none; those that travel have a mass."""
    mesh, dynamics = built.design.mesh, built.case.dynamics
    if dynamics is None or dynamics.inertia is not None or not has(mesh, line_of_action):
        return
    density = array([float(solid.density) for solid in built.design.solids])
    every = np.asarray(plain_inertia(mesh, density)).tolist()
    turning = [value for value, body in zip(every, built.bodies, strict=True) if body.turns]
    mark = Provenance("derived", note="discs of the material from bore to reference circle")
    yield _row("dynamics", "inertia", turning, "moment of inertia", mark)


def _of_solid(built: Built, gear: int) -> Iterator[Row]:
    """Values of a material at the temperature at which they are used."""
    used = built.solids[gear - 1]
    warm = built.film_model is not None and built.film_model.thermal != ISOTHERMAL
    properties = _SOLID | (_FLANK if built.asperities else {}) | (_CONDUCTS if warm else {})
    for name, kind in properties.items():
        datum = used.record.data()[name]
        note = (used.told if name == "young" else "") or datum.note
        mark = Provenance(datum.status, datum.source, note)
        value = datum.value if name in _CONDUCTS else getattr(used.solid, name)
        yield _row(SOLIDS, f"gear_{gear}.{name}", value, kind, mark)
