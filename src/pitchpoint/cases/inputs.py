"""The inputs of a case as resolved, in the units in which people read them, with their status."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from pydantic import BaseModel

from pitchpoint import units
from pitchpoint.cases.build import Built
from pitchpoint.cases.document import Document, leaves
from pitchpoint.cases.schema import FrictionChoice, quantity_at
from pitchpoint.cases.solids import SolidInUse
from pitchpoint.results.variables import VARIABLES

__all__ = ["resolved"]

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
)

_APART = ("gears", "losses")
"""Tables whose inner tables have a row for each value."""

_SOLID = {"young": "Young's modulus", "poisson": "Poisson's ratio", "density": "density"}

_OIL = {
    "nu_1": ("kinematic viscosity at the lower temperature", "mm2/s", "kinematic viscosity"),
    "nu_2": ("kinematic viscosity at the upper temperature", "mm2/s", "kinematic viscosity"),
    "T_1": ("lower temperature", "degC", "temperature"),
    "T_2": ("upper temperature", "degC", "temperature"),
    "density_15": ("density at 15 degC", "kg/m3", "density"),
    "density_slope": ("fall of density", "kg/m3/K", "density slope"),
    "gold_s": ("Gold's s", "1", "dimensionless"),
    "gold_t": ("Gold's t", "1", "dimensionless"),
    "lubricant_factor": ("lubricant factor X_L", "1", "dimensionless"),
    "T_min": ("lowest temperature", "degC", "temperature"),
    "T_max": ("highest temperature", "degC", "temperature"),
}


def resolved(built: Built, document: Document) -> list[dict[str, str]]:
    """Rows of table, key, value, status, place and note for every input.

    Args:
        built: the case.
        document: it came from; keys that it does not hold are defaults.
    """
    rows = [row for table in _TABLES for row in _rows(built, document, table)]
    rows += _geometry(built)
    rows += [row for gear, used in enumerate(built.solids, 1) for row in _solid(gear, used)]
    return rows + [
        {
            "table": "oil as resolved",
            "key": label,
            "value": _shown(built.lubricant.data()[name].value, unit, kind),
            "status": built.lubricant.data()[name].status,
            "where": built.lubricant.data()[name].source,
            "note": built.lubricant.data()[name].note,
        }
        for name, (label, unit, kind) in _OIL.items()
    ]


_ROUNDING = 1e-14  # lengths in metres, ratios: what differences of dimensions leave
_GEOMETRY = (
    "transverse_contact_ratio",
    "overlap_ratio",
    "circumferential_backlash",
    "normal_backlash",
    "tip_thickness",
    "undercut_limit",
    "speed_ratio",
    "deflection",
    "neutral_radius",
    "engagement_depth",
)


def _geometry(built: Built) -> list[dict[str, str]]:
    """What follows from the gears and is asked for first."""
    found = built.dimensions
    return [
        {
            "table": "gears as computed",
            "key": name.replace("_", " ") + (" in the normal section" if "tip" in name else ""),
            "value": " / ".join(dict.fromkeys(_dimension(name, float(v)) for v in np.ravel(value))),
            "status": "derived",
            "where": "",
            "note": "",
        }
        for name in _GEOMETRY
        if (value := found.get(name)) is not None
    ]


def _dimension(name: str, value: float) -> str:
    value = 0.0 if abs(value) < _ROUNDING else value
    variable = VARIABLES.get(name) or VARIABLES[f"{name}_1"]
    return _shown(value, variable.display, variable.kind)


def _solid(gear: int, used: SolidInUse) -> list[dict[str, str]]:
    """Values of a material at the temperature at which they are used."""
    values = {"young": ("GPa", "pressure"), "poisson": ("1", "dimensionless")}
    values["density"] = ("kg/m3", "density")
    rows = []
    for name, (unit, kind) in values.items():
        origin = used.record.data()[name]
        number = float(getattr(used.solid, name))
        rows.append(
            {
                "table": "materials as resolved",
                "key": f"gear {gear}, {_SOLID[name]}",
                "value": _shown(number, unit, kind),
                "status": origin.status,
                "where": origin.source,
                "note": (used.told if name == "young" else "") or origin.note,
            }
        )
    return rows


def _rows(built: Built, document: Document, table: str) -> list[dict[str, str]]:
    rows = []
    given = dict(leaves({table: document.tree.get(table, {})}))
    following = built.following if table == "gears" else {}
    for key, left in _leaves(getattr(built.case, table), table in _APART):
        value = _value(following.get(key) if left is None else left, f"{table}.{key}")
        if value is None:
            continue
        mark = document.provenance.get(f"{table}.{key}")
        followed = "derived" if left is None else "default"
        status = "given" if any(_inside(path, f"{table}.{key}") for path in given) else followed
        rows.append(
            {
                "table": table,
                "key": key,
                "value": value,
                "status": mark.status if mark else status,
                "where": mark.where if mark else "",
                "note": mark.note if mark else "",
            }
        )
    return rows


def _leaves(table: Any, apart: bool) -> Iterator[tuple[str, Any]]:
    """Keys and values of a table; of inner tables too, if they are to stand apart."""
    if table is None:
        return
    inner = (
        table.items() if isinstance(table, dict) else ((k, getattr(table, k)) for k in _keys(table))
    )
    for key, value in inner:
        if apart and isinstance(value, BaseModel):
            yield from ((f"{key}.{name}", one) for name, one in _leaves(value, apart))
        else:
            yield key, value


def _keys(table: BaseModel) -> list[str]:
    return [*type(table).model_fields]


def _inside(path: str, key: str) -> bool:
    return path == key or path.startswith(f"{key}.")


def _value(value: Any, key: str) -> str | None:
    """Value in words; None for what is left open."""
    if value is None:
        return None
    quantity = quantity_at(key)
    if quantity is not None:
        each = [float(number) for number in np.ravel(value)]
        shown = [quantity.show(number) for number in each]
        alike = key != "gears.profile_shift" and len(set(shown)) == 1
        return " / ".join(shown[:1] if alike else shown) or None
    if isinstance(value, BaseModel):
        return ", ".join(_part(key, *item) for item in value.model_dump().items())
    if isinstance(value, tuple):
        return ", ".join(_choice(item, key) for item in value) or "none"
    return str(value)


def _part(table: str, name: str, item: Any) -> str:
    quantity = quantity_at(f"{table}.{name}")
    return f"{name} {quantity.show(item) if quantity else item}"


def _choice(item: Any, table: str) -> str:
    if isinstance(item, str):
        return item
    if not isinstance(item, FrictionChoice):
        return " ".join(_part(table, *each) for each in item.model_dump().items())
    own = ", ".join(f"{key} {value:g}" for key, value in item.parameters.items())
    return f"{item.name} ({own})" if own else str(item.name)


def _shown(value: float, unit: str, kind: str) -> str:
    if kind == "dimensionless":
        return f"{value:.6g}"
    return f"{units.convert(value, unit, kind):.6g} {unit}"
