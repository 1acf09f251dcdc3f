"""The oil of a case as it is used: of the catalogue or by value, with what is assumed of it."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from pitchpoint.cases.document import Document
from pitchpoint.cases.solids import datum
from pitchpoint.core.doubts import Doubt
from pitchpoint.errors import InputError
from pitchpoint.input.kinds import TEMPERATURE
from pitchpoint.materials import lubricants
from pitchpoint.materials.data import Datum
from pitchpoint.materials.material_tables import Oil

__all__ = ["built_oil", "check_temperature", "half_of_a_line", "lubricant_of", "oil_doubts"]


@lru_cache(maxsize=64)
def built_oil(record: lubricants.LubricantRecord) -> lubricants.Lubricant:
    """The oil of a record, the same object for the same record."""
    return record.build()


def lubricant_of(oil: Oil, document: Document) -> lubricants.LubricantRecord:
    """Record of the oil, or of the base oil of the grease, that a case has.

    Raises:
        InputError: values that no oil has, with their key.
    """
    record = _oil(oil, document)
    if not (oil.thickener or oil.consistency):
        return record
    return record.thickened(thickener=oil.thickener, consistency=oil.consistency)


def _oil(oil: Oil, document: Document) -> lubricants.LubricantRecord:
    values = {
        "nu_1": oil.viscosity_40,
        "nu_2": oil.viscosity_100,
        "nu_0": oil.viscosity_minus_40,
        "density_15": oil.density,
        "density_slope": oil.density_slope,
        "lubricant_factor": oil.lubricant_factor,
        "conductivity": oil.conductivity,
        "T_min": oil.temperature_min,
        "T_max": oil.temperature_max,
    }
    if oil.pressure_viscosity is not None:
        values["gold_s"], values["gold_t"] = lubricants.constant_alpha(oil.pressure_viscosity)
    overridden = {
        key: datum(value, f"lubricant.{_OIL_KEYS[key]}", document)
        for key, value in values.items()
        if value is not None
    }
    try:
        record = _of_values(oil, overridden)
        if overridden:
            lubricants.demand_plausible_cold(record)
        return record
    except InputError as error:
        key = _OIL_KEYS.get((error.key or "").rsplit(".", 1)[-1], "")
        message = error.message
        for name, word in _OIL_KEYS.items():
            message = message.replace(name, word)
        where = f"lubricant.{key}".rstrip(".")
        raise InputError(message, file=document.name, key=where) from None


def _of_values(oil: Oil, given: Mapping[str, Datum]) -> lubricants.LubricantRecord:
    """An oil by value, or one of the catalogue with some values of the case file."""
    cold = lubricants.known_cold(given["nu_0"]) if "nu_0" in given else {}
    if oil.name is not None:
        following = {**cold, **lubricants.without_free_volume(given)}
        return _with_own(lubricants.find(oil.name), given, following)
    assert oil.base is not None
    data: dict[str, Any] = {**lubricants.base_oils()[oil.base], **cold, **given}
    return lubricants.LubricantRecord(
        name="oil by value", title=f"{oil.base} oil by value", base=oil.base, **data
    )


def _with_own(
    oil: lubricants.LubricantRecord, given: Mapping[str, Datum], following: Mapping[str, Any]
) -> lubricants.LubricantRecord:
    """An oil of the catalogue with values of the case file, which say so, and what follows from them."""
    if not given:
        return oil
    beside = f"of the case file; the other values are those of {oil.name} in the catalogue"
    values: dict[str, Any] = {
        key: replace(value, note="; ".join(filter(None, [value.note, beside])))
        for key, value in given.items()
    }
    replaced = ", ".join(dict.fromkeys(_OIL_KEYS[key] for key in given))
    title = f"{oil.title or oil.name} with {replaced} of the case file"
    return replace(oil, title=title, **{**following, **values})


def oil_doubts(oil: lubricants.LubricantRecord) -> list[str]:
    """What is assumed of it."""
    return (
        [Doubt(oil.note, brief=f"Grease ({oil.name}) as its base oil: the thickener does nothing.")]
        if oil.note
        else []
    )


def half_of_a_line(oil: Oil) -> list[str]:
    """One of two viscosities given beside the other one of the catalogue."""
    stated = [oil.viscosity_40 is not None, oil.viscosity_100 is not None]
    if oil.name is None or all(stated) or not any(stated):
        return []
    key, partner = (
        ("viscosity_40", "viscosity_100") if stated[0] else ("viscosity_100", "viscosity_40")
    )
    return [
        Doubt(
            f"The oil has the {key} of the case file and the {partner} of {oil.name}: together they make the "
            "line of viscosity over temperature; give both.",
            brief=f"The oil has the {partner} of {oil.name}; give it too.",
        )
    ]


_OIL_KEYS = {
    "nu_1": "viscosity_40",
    "nu_2": "viscosity_100",
    "nu_0": "viscosity_minus_40",
    "density_15": "density",
    "density_slope": "density_slope",
    "gold_s": "pressure_viscosity",
    "gold_t": "pressure_viscosity",
    "lubricant_factor": "lubricant_factor",
    "conductivity": "conductivity",
    "T_min": "temperature_min",
    "T_max": "temperature_max",
}


def check_temperature(temperature: float, oil: lubricants.LubricantRecord, key: str) -> None:
    """InputError for a temperature [K] outside the range of an oil, with the key that has it."""
    low, high = oil.T_min.value, oil.T_max.value
    if not low <= temperature <= high:
        allowed = replace(TEMPERATURE, low=low, high=high).allowed
        raise InputError(
            f"{TEMPERATURE.show(temperature)} is outside the range of {oil.name}; {allowed}",
            key=key,
            value=temperature,
        )
