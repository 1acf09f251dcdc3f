"""A case out of a document: its form, and the meshes for which a planetary set stands."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from pitchpoint.cases.complaints import complaint_of
from pitchpoint.cases.document import STAGES, Document
from pitchpoint.cases.drive_schema import NO_VIBRATION, DriveCase, form_of, is_planetary
from pitchpoint.cases.schema import CaseFile
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.planetary import PlanetaryGears
from pitchpoint.input.quantities import shown
from pitchpoint.input.tables import DECIDING, forms
from pitchpoint.materials.material_tables import OF_SET, DriveMaterials, Materials, of_set

__all__ = ["Whole", "in_form", "planetary_of", "validate", "validated", "with_meshes"]


def validate(document: Document) -> CaseFile | DriveCase:
    """Case out of a document.

    Raises:
        InputError: what is wrong, with file, key, value and what is allowed; a
            `CollectedInputError` of several things.
    """
    document = with_meshes(document)
    if STAGES not in document.tree:
        return validated(CaseFile, document)
    of_set = is_planetary(document.tree)
    for key, why in (_OF_SETS if of_set else _OF_ONE_MESH).items():
        if key in document.tree:
            table = document.tree[key]
            why = why if isinstance(table, Mapping) else f"{shown(table)} {why}"
            if key == "gears" and isinstance(table, Mapping) and table:
                why += f": write stages.1.gears.{next(iter(table))} for those of the first one"
            raise InputError(why, file=document.name, key=key)
    return validated(DriveCase, document)


_OF_SETS = {
    "dynamics": NO_VIBRATION,
}
_OF_EACH_MESH = ("film", "wear", "worn")
"""Tables of a planetary set that each of its meshes has."""

_OF_ONE_MESH = {
    "gears": "was given with [[stages]], each of which has gears of its own",
    "dynamics": "vibration is that of a mesh; give a stage the table, [stages.dynamics] under its [[stages]]",
    "film": "films are those of a mesh; give a stage the table, film = { ... } under its [[stages]]",
    "wear": "wear is that of a mesh; give a stage the table, wear = { ... } under its [[stages]]",
    "worn": "worn flanks are those of a mesh; give a stage the table, worn = { ... } under its [[stages]]",
}


def planetary_of(document: Document) -> PlanetaryGears:
    """Table [gears] of a planetary set out of a document; InputError as from `validate`."""
    gears = document.tree["gears"]
    try:
        return PlanetaryGears.model_validate(gears)
    except ValidationError as error:
        wrong = Complaints(document.name)
        wrong.under("gears").add(
            complaint_of(error, Document(document.name, gears), PlanetaryGears)
        )
        raise wrong.error from None


class _Followed(dict[str, Any]):
    """A table that follows from another one."""


def with_meshes(document: Document) -> Document:
    """The same with the stages and the train for which a planetary set stands; any other as it is.

    Raises:
        InputError: what is wrong with the set, or stages given beside it.
    """
    tree = document.tree
    if not is_planetary(tree) or isinstance(tree.get("train"), _Followed):
        return document
    for key in (STAGES, "train"):
        if key in tree:
            raise InputError(
                'was given with gears of the family "planetary", which have their own; leave one of them out',
                file=document.name,
                key=key,
            )
    gears = planetary_of(document)
    _demand_one_for_all(document)
    of_each = {key: tree[key] for key in _OF_EACH_MESH if key in tree}
    meshes = _with_materials(gears.meshes(), document)
    stages = {str(number): {**mesh, **of_each} for number, mesh in enumerate(meshes, 1)}
    return replace(document, tree={**tree, STAGES: stages, "train": _Followed(gears.train())})


_OF_MEMBERS = {"film": ("heights",), "wear": ("coefficient", "engagements", "hardness", "rate")}
"""Keys of those tables with a value for each of the two gears of a mesh."""


def _demand_one_for_all(document: Document) -> None:
    """InputError for values of two gears, of which a planetary set has three or more kinds."""
    for table, keys in _OF_MEMBERS.items():
        stated = document.tree.get(table)
        held = stated if isinstance(stated, Mapping) else {}
        for key in keys:
            value = held.get(key)
            unlike = isinstance(value, list) and any(element != value[0] for element in value)
            if unlike or isinstance(value, Mapping):
                raise InputError(
                    "is one value for sun, planets and rings of a planetary set; for different ones write "
                    "its meshes as [[stages]]",
                    file=document.name,
                    key=f"{table}.{key}",
                )


def _is_sound(materials: Mapping[str, Any]) -> bool:
    """True unless the validation of the case will refuse a table of materials."""
    try:
        DriveMaterials.model_validate(materials)
    except ValidationError:
        return False
    return True


def _with_materials(meshes: list[dict[str, Any]], document: Document) -> list[dict[str, Any]]:
    """Meshes of a set with the materials that its gears have; as they are where none has its own.

    Raises:
        InputError: gears that the set does not have, materials of gears 1 and 2 beside those of its own.
    """
    materials = document.tree.get("materials", {})
    if not isinstance(materials, Mapping) or not of_set(materials) or not _is_sound(materials):
        return meshes
    of_gears = of_set(materials)
    bodies = {body.replace(" ", "_") for mesh in meshes for body in mesh["bodies"]}
    for key in materials:
        if key in of_gears - bodies or key in Materials.model_fields:
            every = ", ".join(gear for gear in OF_SET if gear in bodies)
            message = f"the gears of this set are {every}; leave it out"
            raise InputError(message, file=document.name, key=f"materials.{key}")
    return [
        {
            **mesh,
            "materials": {
                f"gear_{number}": materials.get(body.replace(" ", "_"), "steel")
                for number, body in enumerate(mesh["bodies"], 1)
            },
        }
        for mesh in meshes
    ]


Whole = TypeVar("Whole", CaseFile, DriveCase)


def validated(model: type[Whole], document: Document) -> Whole:
    """Case of one mesh or of several out of a document; InputError as from `validate`."""
    try:
        return model.model_validate(in_form(document))
    except ValidationError as error:
        raise complaint_of(error, document, model) from None


def in_form(document: Document) -> dict[str, Any]:
    """Tables as they are meant where a setting or a study changes the form of one.

    The values of the former form do not belong to the new one: those that it does not have are left out.
    """
    tree = document.tree
    for key, mark in document.provenance.items():
        *above, decided = key.split(".")
        if decided in DECIDING and mark.status == "set":
            tree = _without_former(tree, above, document)
    return tree


def _without_former(tree: dict[str, Any], above: list[str], document: Document) -> dict[str, Any]:
    """Copy in which one table has lost the keys that its form does not have, unless they were set too."""
    model: type[BaseModel] = form_of(tree)
    copied = table = dict(tree)
    for part in above:
        if part.isdecimal() and isinstance(table.get(part), dict):
            table[part] = table = dict(table[part])
            continue
        info, inner = model.model_fields.get(part), table.get(part)
        meant = forms(info.annotation, inner) if info is not None else []
        if not meant or not isinstance(inner, dict):
            return tree  # what is wrong there is told by the schema
        model, table[part] = meant[0], dict(inner)
        table = table[part]
    for key in [*table]:
        mark = document.provenance.get(".".join((*above, key)))
        if key not in model.model_fields and (mark is None or mark.status != "set"):
            del table[key]
    return copied
