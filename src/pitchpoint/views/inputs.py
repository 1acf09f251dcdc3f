"""Inputs of a result in words: what the record holds in SI, in the units in which people read it."""

from collections.abc import Mapping
from typing import Any

from pitchpoint import units
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.record import OUTPUT
from pitchpoint.cases.resolved_inputs import DIMENSIONS, OIL, SOLIDS, STUDIES
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity
from pitchpoint.results.chosen_units import Choice, unit_choice, unit_in_use
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views.show import handy

__all__ = [
    "FOLLOWING",
    "input_number",
    "input_value",
    "input_words",
    "printed_input_rows",
    "quantity_text",
    "recorded_units",
    "set_for_run",
]

_TABLES = {
    DIMENSIONS: "gears as computed",
    SOLIDS: "materials as resolved",
    OIL: "oil as resolved",
}

FOLLOWING = tuple(_TABLES.values())
"""Titles of the tables of what follows from the inputs."""

_APART = (STUDIES, "loss_map", OUTPUT)
"""Tables that say what is computed and how it is shown, not from what: the results show that themselves."""

_LABELS = {
    "young": "Young's modulus",
    "poisson": "Poisson's ratio",
    "nu_0": "kinematic viscosity at -40 degC",
    "nu_1": "kinematic viscosity at the lower temperature",
    "nu_2": "kinematic viscosity at the upper temperature",
    "T_1": "lower temperature",
    "T_2": "upper temperature",
    "density_15": "density at 15 degC",
    "density_slope": "fall of density",
    "gold_s": "Gold's s",
    "gold_t": "Gold's t",
    "lubricant_factor": "lubricant factor X_L",
    "conductivity": "thermal conductivity",
    "T_min": "lowest temperature",
    "T_max": "highest temperature",
    "free_volume_factor": "Doolittle's B",
    "occupied_volume": "part of the volume that molecules occupy",
    "occupied_expansion": "expansion of the occupied volume",
    "volume_temperature": "temperature of the constants of volume",
    "modulus_rise": "rise of the bulk modulus with pressure",
    "modulus_cold": "bulk modulus, extrapolated to absolute zero",
    "modulus_slope": "fall of the bulk modulus with temperature",
    "expansion": "thermal expansion",
    "tip_thickness": "tip thickness in the normal section",
}

_UNITS = {
    "angle": "deg",
    "hardness": "GPa",
    "kinematic viscosity": "mm2/s",
    "length": "mm",
    "pressure": "GPa",
    "rotational speed": "rpm",
    "temperature": "degC",
}
"""In which values are shown that have no unit of their own, where it is not the SI unit."""

_ROUNDING = 1e-14  # lengths in metres, ratios: what differences of dimensions leave

Row = Mapping[str, Any]


def printed_input_rows(manifest: Mapping[str, Any]) -> list[dict[str, str]]:
    """Table, key, value, status, where and note of the inputs, as people read them."""
    return [
        {
            "table": _TABLES.get(row["table"], row["table"]),
            "key": _label(row),
            "value": _words(row),
            **{name: row[name] for name in ("status", "where", "note")},
        }
        for row in manifest["inputs"]
        if row["table"] not in _APART and not _empty(row)
    ]


def set_for_run(manifest: Mapping[str, Any]) -> dict[str, str]:
    """What was set for this run, in words by dotted key."""
    return {
        _path(row): _words(row)
        for row in manifest["inputs"]
        if row["status"] == "set" and row["table"] != OUTPUT
    }


def recorded_units(outcomes: Mapping[str, Outcome]) -> Choice:
    """Units by kind of quantity in which the first of some results asks to be shown."""
    choices = next((input_value(outcome, OUTPUT, "units") for outcome in outcomes.values()), None)
    return unit_choice(choices or {})


def input_value(outcome: Outcome, table: str, key: str) -> Any:
    """Value of an input in SI, or text; None if there is none."""
    row = _row(outcome, table, key)
    return None if row is None else row["value"]


def input_number(outcome: Outcome, table: str, key: str) -> float:
    """Value of an input that is one number, in SI.

    Raises:
        InputError: it is not in the record, or no number.
    """
    value = input_value(outcome, table, key)
    if not isinstance(value, float):
        raise InputError("the record of the result holds no number", key=f"{table}.{key}")
    return value


def input_words(outcome: Outcome, table: str, key: str) -> str:
    """Value of an input in words; empty if there is none."""
    row = _row(outcome, table, key)
    return "" if row is None else _words(row)


def _row(outcome: Outcome, table: str, key: str) -> Row | None:
    rows = outcome.manifest["inputs"]
    return next((row for row in rows if row["table"] == table and row["key"] == key), None)


def _path(row: Row) -> str:
    return f"{row['table']}.{row['key']}"


def _label(row: Row) -> str:
    key = str(row["key"])
    if row["table"] not in _TABLES:
        return key
    *gear, name = key.split(".")
    label = _LABELS.get(name, name.replace("_", " "))
    return ", ".join((*(part.replace("_", " ") for part in gear), label))


def _empty(row: Row) -> bool:
    """True for a table without values, and for a list without numbers."""
    return row["value"] == {} or bool(row["value"] == [] and row["kind"])


def _words(row: Row) -> str:
    value = row["value"]
    if not isinstance(value, list):
        return _one(value, row)
    if value and all(isinstance(entry, float) for entry in value):
        shown = _several(value, row)
        alike = not _path(row).endswith("gears.profile_shift") and len(set(shown)) == 1
        return " / ".join(shown[:1] if alike else shown)
    return ", ".join(_item(entry, row) for entry in value) or "none"


def _several(values: list[float], row: Row) -> list[str]:
    """Numbers of a row; in one smaller unit where one of them would need a power of ten."""
    kind = row["kind"]
    usual = _unit(row["table"], row["key"], kind) if kind and isinstance(kind, str) else ""
    shown, unit = (
        handy([units.convert(number, usual, kind) for number in values], usual)
        if usual
        else ([], "")
    )
    if unit == usual:
        return [_one(number, row) for number in values]
    return [f"{number:.6g} {unit}" for number in shown]


def _item(value: Any, row: Row) -> str:
    """One of a list of names and tables."""
    if not isinstance(value, dict):
        return _one(value, row)
    shown = {name: _one(one, row, name) for name, one in value.items()}
    if not _path(row).endswith("models.friction"):
        return " ".join(f"{name} {one}" for name, one in shown.items())
    law = shown.pop("name", "")
    constants = ", ".join(f"{name} {one}" for name, one in shown.items())
    return f"{law} ({constants})" if constants else law


def _one(value: Any, row: Row, name: str = "") -> str:
    """A value of a row; of a list of tables that at a name."""
    kind = row["kind"].get(name, "") if isinstance(row["kind"], dict) else row["kind"]
    if not kind or not isinstance(value, float):
        return "undefined" if value is None else _word(value)
    follows = row["table"] == DIMENSIONS or row.get("status") == "derived"
    if follows and abs(value) < _ROUNDING:
        value = 0.0
    return _shown(value, kind, _unit(row["table"], f"{row['key']}.{name}".removesuffix("."), kind))


def _word(value: Any) -> str:
    """A value without a unit as a case file has it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def quantity_text(value: float, quantity: Quantity) -> str:
    """A value at a key with its unit [SI in]."""
    return _shown(value, quantity.kind, unit_in_use(quantity.kind, quantity.unit))


def _shown(value: float, kind: str, unit: str) -> str:
    if unit in ("", "1"):
        return f"{value:.6g}"
    return f"{units.convert(value, unit, kind):.6g} {unit}"


def _unit(table: str, key: str, kind: str) -> str:
    """Unit in which the value at a key is shown, one of its kind."""
    own_unit = _own_unit(table, key)
    usual = own_unit if own_unit in units.units_of(kind) else _UNITS.get(kind, units.si_unit(kind))
    return unit_in_use(kind, usual)


def _own_unit(table: str, key: str) -> str:
    """Unit that the schema or the list of variables names for a key; empty where neither does."""
    if table == DIMENSIONS:
        name = key.rsplit(".", 1)[-1]  # behind the stage that it is of
        variable = VARIABLES.get(name) or VARIABLES.get(f"{name}_1")
        return "" if variable is None else variable.usual
    try:
        quantity = quantity_at(f"{table}.{key}")
    except InputError:  # no key of a case file
        return ""
    return "" if quantity is None else quantity.unit
