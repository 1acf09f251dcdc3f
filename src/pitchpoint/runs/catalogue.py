"""Tables for people and machines: what can be chosen by name, and the main figures of a result."""

from dataclasses import fields
from math import inf
from typing import Any

from pitchpoint import units
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.loss_sets import loss_sets
from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT, SUMMITS
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS, BREAKAWAY, TOOTH_TEMPERATURE
from pitchpoint.gears.strain_wave.strain_wave_registry import WAVE_SHAPES
from pitchpoint.loading.loading_registry import LINE_STIFFNESS, LOAD_SHARING, TOOTH_COMPLIANCE
from pitchpoint.lubrication.applicability import Limited, asks_for_pitch_point, limits_words
from pitchpoint.lubrication.conditions import Law, shape_of
from pitchpoint.lubrication.ehl.ehl_registry import ASPERITIES
from pitchpoint.lubrication.lubrication_registry import (
    ASPERITY_LOAD,
    FILM_THICKNESS,
    INLET_HEATING,
    ROLLING_RESISTANCE,
    FilmThickness,
    FrictionLaw,
)
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.data import Datum
from pitchpoint.materials.materials_registry import DENSITY, SHEAR_STRESS, VISCOSITY
from pitchpoint.published.publication_registry import LAWS_OF_CASES
from pitchpoint.registry import unknown_name
from pitchpoint.results.variables import variable_of
from pitchpoint.runs.run import Outcome
from pitchpoint.wear.wear_registry import WEAR_LAWS

__all__ = ["entries", "figures_by_law", "matching"]


def matching(which: str) -> list[dict[str, str]]:
    """Entries of a kind, or those of a name.

    Raises:
        InputError: no kind and no law is called so.
    """
    rows = entries()
    of_kind = [row for row in rows if row["kind"] == which]
    named = [row for row in rows if row["name"] == which]
    if not of_kind and not named:
        allowed = {word for row in rows for word in (row["kind"], row["name"])}
        raise unknown_name(which, allowed, what="a kind or a name")
    return of_kind or named


def entries() -> list[dict[str, str]]:
    """Every law, oil and material that a case file may name."""
    rows = [_entry("friction", law, _friction_range(law)) for law in FRICTION.values()]
    rows += [
        _entry("load_sharing", model, _ratio_range(model.ratio_range))
        for model in LOAD_SHARING.values()
    ]
    rows += [
        _entry("rolling_resistance", model, _shape(model)) for model in ROLLING_RESISTANCE.values()
    ]
    rows += [_entry("elliptic_contact", entry, "") for entry in ELLIPTIC_CONTACT.values()]
    rows += [_entry("film_thickness", law, _film_range(law)) for law in FILM_THICKNESS.values()]
    rows += [
        _entry("asperity_load", law, "; ".join([_shape(law), *_limits(law)]))
        for law in ASPERITY_LOAD.values()
    ]
    rows += [_entry("wear_law", law, _shape(law)) for law in WEAR_LAWS.values()]
    rows += [
        _entry(kind, model, "")
        for kind, registry in (
            ("inlet_heating", INLET_HEATING),
            ("tooth_compliance", TOOTH_COMPLIANCE),
            ("line_stiffness", LINE_STIFFNESS),
            ("tooth_contact", CONTACT_LAWS),
            ("tooth_temperature", TOOTH_TEMPERATURE),
            ("bearing", BEARING_LOSS),
            ("breakaway", BREAKAWAY),
            ("wave_shape", WAVE_SHAPES),
        )
        for model in registry.values()
    ]
    rows += [
        _entry(kind, law, law.range)
        for kind, registry in (
            ("viscosity_law", VISCOSITY),
            ("density_law", DENSITY),
            ("shear_law", SHEAR_STRESS),
        )
        for law in registry.values()
    ]
    rows += [_entry("asperities", law, "") for law in ASPERITIES.values()]
    rows += [_entry("summits", constants, "") for constants in SUMMITS.values()]
    rows += [_entry("losses", entry, "") for entry in loss_sets().values()]
    rows += [_record("lubricant", oil, _oil_range(oil)) for oil in lubricants.catalogue().values()]
    return rows + [_record("material", solid, "") for solid in solids.catalogue().values()]


def figures_by_law(outcome: Outcome) -> dict[str, Any]:
    """Main figures of one variant in SI, by law; None where a quantity is undefined."""
    manifest, every = outcome.manifest, ANALYSES.values()
    shown = [analysis.shown(outcome.parts) for analysis in every]
    units_of = {
        name: variable_of(outcome.parts.get(analysis.name, {}), name).unit
        for analysis in every
        for name in analysis.main
    }
    return {
        "implausible": manifest["implausible"],
        "title": manifest["title"],
        "units": units_of,
        **{key: value for names in shown for key, value in names.items()},
        "warnings": manifest["warnings"],
        "rows": manifest["rows"],
    }


def _entry(kind: str, model: Any, limits: str) -> dict[str, str]:
    name, title, note = str(model.name), str(model.title), str(model.note)
    sources = ", ".join(model.sources)
    return dict(
        kind=kind, name=name, title=title, values="", range=limits, sources=sources, note=note
    )


_VALUES = {
    "young": ("Young's modulus", "pressure", "GPa"),
    "poisson": ("Poisson's ratio", "", ""),
    "density": ("density", "density", "kg/m3"),
    "contact_limit": ("largest Hertz pressure", "pressure", "MPa"),
    "hardness": ("hardness", "hardness", "GPa"),
    "sigma_hlim": ("sigma_Hlim", "pressure", "MPa"),
    "sigma_flim": ("sigma_Flim", "pressure", "MPa"),
    "tensile_strength": ("tensile strength", "pressure", "MPa"),
    "nu_1": ("kinematic viscosity at 40 degC", "kinematic viscosity", "mm2/s"),
    "nu_2": ("at 100 degC", "kinematic viscosity", "mm2/s"),
    "density_15": ("density at 15 degC", "density", "kg/m3"),
    "gold_s": ("pressure-viscosity by Gold's s", "", ""),
    "gold_t": ("Gold's t", "", ""),
    "lubricant_factor": ("X_L of mean friction laws", "", ""),
    "conductivity": ("thermal conductivity", "", "W/m/K"),
    "specific_heat": ("specific heat", "", "J/kg/K"),
}
"""Values of a material or an oil on its sheet: words, kind of the quantity, unit in which they are told."""


def _values_in_words(record: Any) -> str:
    """Values of a record with their units, and the status of those that nobody measured."""
    held = {name: getattr(record, name, None) for name in _VALUES}
    return "; ".join(
        _value_in_words(datum, *_VALUES[name])
        for name, datum in held.items()
        if isinstance(datum, Datum)
    )


def _value_in_words(datum: Datum, words: str, kind: str, unit: str) -> str:
    value = units.convert(datum.value, unit, kind) if kind else datum.value
    status = "" if datum.status in ("given", "printed") else f" ({datum.status})"
    return f"{words} {value:.5g} {unit}".rstrip() + status


def _record(kind: str, record: Any, limits: str) -> dict[str, str]:
    return dict(
        kind=kind,
        name=record.name,
        title=record.title,
        values=_values_in_words(record),
        range=limits,
        sources=_sources(record),
        note="",
    )


def _sources(record: Any) -> str:
    values = [getattr(record, field.name) for field in fields(record)]
    sources = [value.source for value in values if isinstance(value, Datum) and value.source]
    return ", ".join(dict.fromkeys(sources))


_SHAPES = {"line": "line contacts", "ellipse": "elliptic contacts", None: "any shape of contact"}


def _shape(law: Law) -> str:
    return _SHAPES[shape_of(law)]


def _friction_range(law: FrictionLaw) -> str:
    limits = _limits(law)
    limits += ["gears with a pitch point"] if asks_for_pitch_point(law) else []
    limits += ["film at least Rq"] if law.full_film else []
    limits += [f"coefficient at most {law.largest:g}"] if law.largest < inf else []
    place = "each contact" if law.local else "whole mesh"
    restriction = "; only for its case" if law.name in LAWS_OF_CASES else ""
    return "; ".join([place + restriction, _shape(law), *limits])


def _film_range(law: FilmThickness) -> str:
    return "; ".join([f"{_shape(law)}, {law.place} film", *_limits(law)])


def _limits(law: Limited) -> list[str]:
    return [
        f"{name.replace('_', ' ')} {limits_words(name, ends)}" for name, ends in law.ranges.items()
    ]


def _ratio_range(limits: tuple[float, float]) -> str:
    low, high = limits
    return f"{low:g} < contact ratio < {high:g}" if high < float("inf") else "any contact ratio"


def _oil_range(oil: lubricants.LubricantRecord) -> str:
    low, high = (units.convert(t.value, "degC", "temperature") for t in (oil.T_min, oil.T_max))
    return f"{low:g} to {high:g} degC"
