"""Tables for people and machines: what can be chosen by name, and the main figures of a result."""

from collections.abc import Iterator
from dataclasses import fields
from math import inf
from typing import Any

import numpy as np

from pitchpoint import units
from pitchpoint.analyses.figures import (
    CONTACT,
    REACTIONS,
    VIBRATION,
    WIND_UP,
    bearing_loads,
    covers,
    error_ranges,
    main_figures,
    of_contact,
    out_of_range,
)
from pitchpoint.analyses.registry import ANALYSES
from pitchpoint.cases.laws import CASE_LAWS, FRICTION, limits_words
from pitchpoint.cases.schema import quantity_at
from pitchpoint.dynamics.contact_law import CONTACT_LAWS
from pitchpoint.efficiency.bearing_loss import BEARING_LOSS
from pitchpoint.efficiency.tooth_temperature import TOOTH_TEMPERATURE
from pitchpoint.gears.strain_wave.wave_generator import WAVE_SHAPES
from pitchpoint.loading.sharing import LOAD_SHARING
from pitchpoint.loading.tooth_compliance import TOOTH_COMPLIANCE
from pitchpoint.lubrication.applicability import asks_for_pitch_point
from pitchpoint.lubrication.conditions import Law, shape_of
from pitchpoint.lubrication.film_thickness import FILM_THICKNESS
from pitchpoint.lubrication.friction_coefficient import FrictionLaw
from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials._leaves import Datum
from pitchpoint.results.variables import VARIABLES, variable_of
from pitchpoint.runs.run import Outcome

__all__ = [
    "entries",
    "figures",
    "kinematic_error_table",
    "summary_table",
    "sweep_tables",
    "vibration_table",
    "wind_up_table",
]


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
    rows += [
        _entry("film_thickness", law, f"{_shape(law)}, {law.place} film")
        for law in FILM_THICKNESS.values()
    ]
    rows += [
        _entry(kind, model, "")
        for kind, registry in (
            ("tooth_compliance", TOOTH_COMPLIANCE),
            ("tooth_contact", CONTACT_LAWS),
            ("tooth_temperature", TOOTH_TEMPERATURE),
            ("bearing", BEARING_LOSS),
            ("wave_shape", WAVE_SHAPES),
        )
        for model in registry.values()
    ]
    rows += [_record("lubricant", oil, _oil_range(oil)) for oil in lubricants.catalogue().values()]
    return rows + [_record("material", solid, "") for solid in solids.catalogue().values()]


_LOCKS = "locks from μ"


def summary_table(outcome: Outcome) -> tuple[list[dict[str, str]], tuple[str, ...], str]:
    """Rows, columns and a note: the operating point by law, and how far the laws disagree."""
    data = outcome.parts["operation"]
    rows = [
        {
            "friction law": str(law),
            **{_head(name): _cell(data, name, position) for name in main_figures(data)},
            **_of_power(outcome, position),
        }
        for position, law in enumerate(data["law"].values)
    ]
    return rows, tuple(rows[0]), spread_sentence(outcome)


def _of_power(outcome: Outcome, position: int) -> dict[str, str]:
    """Cells on the power that goes through, for the law at a position; none where nothing does."""
    data, back = outcome.parts["operation"], outcome.parts.get("back_driving")
    if back is None:
        return {}
    locked = bool(back["locked"].values[position, 0])
    return {
        "η of": covers(data),
        _LOCKS: _cell(data, "jamming_coefficient", position),
        "back-driving": "locked" if locked else _cell(back, "mean_efficiency", position),
        f"back-driving {_LOCKS}": _cell(back, "jamming_coefficient", position),
    }


def figures(outcome: Outcome) -> dict[str, Any]:
    """Main figures of one variant in SI, by law; None where a quantity is undefined."""
    manifest, every = outcome.manifest, ANALYSES.values()
    shown = [analysis.shown(outcome.parts) for analysis in every]
    units_of = {
        name: variable_of(outcome.parts.get(analysis.name, {}), name).unit
        for analysis in every
        for name in analysis.main
    }
    return {
        "title": manifest["title"],
        "units": units_of,
        **{key: value for one in shown for key, value in one.items()},
        "warnings": manifest["warnings"],
        "rows": manifest["rows"],
    }


def spread_sentence(outcome: Outcome) -> str:
    """How far the friction laws that apply disagree about the mean efficiency, and which do not apply."""
    return " ".join([_within(outcome), *_apart(outcome)])


def _within(outcome: Outcome) -> str:
    data = outcome.parts["laws"]
    values = data["mean_efficiency"].values[:, 0]
    if np.isnan(values).any():
        return "No power is transmitted: the efficiency is undefined."
    if not len(values):
        return "No fitted friction law of the library is in its range here."
    if len(values) == 1:
        only = str(data["law"].values[0])
        return f"One fitted friction law of the library applies, {only}; it gives {100 * values[0]:.2f} %."
    low, high = int(values.argmin()), int(values.argmax())
    names = [str(name) for name in data["law"].values]
    span = f"{100 * values[low]:.2f} % ({names[low]}) to {100 * values[high]:.2f} % ({names[high]})"
    if outcome.manifest.get("plastic"):
        return (
            "No friction law of the library was fitted to plastic teeth; those for steel on steel would "
            f"give {span}."
        )
    return (
        f"The friction laws that apply give {span}: the model counts for "
        f"{100 * (values[high] - values[low]):.2f} percentage points."
    )


def _apart(outcome: Outcome) -> Iterator[str]:
    """A sentence for each law that is out of its range."""
    for one in out_of_range(outcome.parts["laws"]):
        value = one["mean_efficiency"]
        gives = "" if value is None else f" (it would give {100 * value:.2f} %)"
        yield f"Out of its range is {one['law']}{gives}: {'; '.join(one['reasons'])}."


def _head(name: str) -> str:
    variable = VARIABLES[name]
    unit = f" [{variable.display}]" if variable.display != "1" else ""
    return f"{variable.symbol}{unit}"


def _cell(data: Any, name: str, position: int) -> str:
    return _shown(name, float(data[name].values[position, 0]))


def _shown(name: str, value: float) -> str:
    variable = VARIABLES[name]
    if np.isnan(value):
        return "undefined"
    if np.isinf(value):
        return "none"
    if variable.display == "1":
        return f"{value:.4f}"
    return f"{units.convert(value, variable.display, variable.kind):.5g}"


def vibration_table(outcome: Outcome) -> tuple[list[dict[str, str]], tuple[str, ...]]:
    """Rows and columns: stiffness and transmission error for every torque, none without vibration."""
    data = outcome.parts.get("vibration")
    if data is None:
        return [], ()
    rows = [
        {_head("torque"): f"{torque:.5g}"}
        | {_head(name): _shown(name, float(data[name].values[k])) for name in VIBRATION}
        for k, torque in enumerate(data["torque"].values)
    ]
    return rows, tuple(rows[0])


def bearing_table(outcome: Outcome) -> tuple[list[dict[str, str]], tuple[str, ...]]:
    """Rows and columns: load on the bearings by law, those that are nothing anywhere left out."""
    data = outcome.parts["operation"]
    rows = [
        {"friction law": str(law)}
        | {_head(name): _cell(data, name, k) for name in REACTIONS if np.any(data[name])}
        | {
            f"{_head('bearing_load')} {place}": _shown("bearing_load", float(load))
            for place, load in bearing_loads(data, k)
        }
        for k, law in enumerate(data["law"].values)
    ]
    return (rows, tuple(rows[0])) if len(rows[0]) > 1 else ([], ())


def wind_up_table(outcome: Outcome) -> tuple[list[dict[str, str]], tuple[str, ...]]:
    """Rows and columns: wind-up, transmission error and stiffness at some torques; none without them."""
    data = outcome.parts.get("torsion")
    if data is None:
        return [], ()
    torques = data["torque"].values
    rows = [
        {_head("torque"): f"{torques[k]:.5g}"}
        | {_head(name): _shown(name, float(data[name].values[k])) for name in WIND_UP}
        | {"K is that of": str(data["torsional_stiffness"].attrs.get("covers", ""))}
        for k in range(torques.size // 4, torques.size, torques.size // 4)
    ]
    return rows, tuple(rows[0])


def kinematic_error_table(outcome: Outcome) -> tuple[list[dict[str, str]], tuple[str, ...]]:
    """Rows and columns: kinematic error, peak to peak, by the deviations of each member and of both."""
    name = "kinematic_error_range"
    rows = [
        {f"kinematic error {_head(name)}": curve}
        | {cause: _shown(name, float(v)) for cause, v in zip(causes, values, strict=True)}
        for curve, causes, values in error_ranges(outcome.parts.get("kinematic_error"))
    ]
    return rows, tuple(rows[0]) if rows else ()


SWEPT = ("mean_efficiency", "torque_ripple", "mean_stiffness", "transmission_error_range")


def sweep_tables(outcome: Outcome) -> list[tuple[str, list[dict[str, str]]]]:
    """Title and rows of every sweep of the command line: point by point, each friction law by name."""
    return [
        (
            str(data.attrs["title"]),
            [
                _swept(data, law, point)
                for point in range(data.sizes["point"])
                for law in range(data.sizes["law"])
            ],
        )
        for name, data in outcome.parts.items()
        if name.startswith("study_sweep_") and "axis" in data
    ]


def _swept(data: Any, law: int, point: int) -> dict[str, str]:
    key = data.attrs["sweep_key"]
    place = {key: _place(data["axis"].values[point], key)}
    names = CONTACT if of_contact(data) else SWEPT
    shown = {_head(n): _shown(n, float(data[n].values[law, point])) for n in names if n in data}
    return {**place, "friction law": str(data["law"].values[law]), **shown}


def _place(value: float, key: str) -> str:
    """Place on the axis of a sweep as case files write it."""
    quantity = quantity_at(key)
    return f"{value:.6g}" if quantity is None else quantity.show(float(value))


def _entry(kind: str, model: Any, limits: str) -> dict[str, str]:
    name, title, note = str(model.name), str(model.title), str(model.note)
    sources = ", ".join(model.sources)
    return dict(kind=kind, name=name, title=title, range=limits, sources=sources, note=note)


def _record(kind: str, record: Any, limits: str) -> dict[str, str]:
    return dict(
        kind=kind,
        name=record.name,
        title=record.title,
        range=limits,
        sources=_sources(record),
        note="",
    )


def _sources(record: Any) -> str:
    values = [getattr(record, one.name) for one in fields(record)]
    found = [value.source for value in values if isinstance(value, Datum) and value.source]
    return ", ".join(dict.fromkeys(found))


_SHAPES = {"line": "line contacts", "ellipse": "elliptic contacts", None: "any shape of contact"}


def _shape(law: Law) -> str:
    return _SHAPES[shape_of(law)]


def _friction_range(law: FrictionLaw) -> str:
    limits = [
        f"{name.replace('_', ' ')} {limits_words(name, ends)}" for name, ends in law.ranges.items()
    ]
    limits += ["gears with a pitch point"] if asks_for_pitch_point(law) else []
    limits += ["film at least Rq"] if law.full_film else []
    limits += [f"coefficient at most {law.largest:g}"] if law.largest < inf else []
    place = "each contact" if law.local else "whole mesh"
    own = "; only for its case" if law in CASE_LAWS else ""
    return "; ".join([place + own, _shape(law), *limits])


def _ratio_range(limits: tuple[float, float]) -> str:
    low, high = limits
    return f"{low:g} < contact ratio < {high:g}" if high < float("inf") else "any contact ratio"


def _oil_range(oil: lubricants.LubricantRecord) -> str:
    low, high = (units.convert(t.value, "degC", "temperature") for t in (oil.T_min, oil.T_max))
    return f"{low:g} to {high:g} degC"
