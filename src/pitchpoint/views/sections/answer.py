"""The answer: operating point, main figures by friction law, and how far the laws disagree."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import (
    CONTACT,
    REACTIONS,
    bearing_loads_by_name,
    efficiency_coverage,
    laws_hold,
    main_figures,
    of_contact,
    point_by_valid_laws,
    why_not,
)
from pitchpoint.cases.built_drive import MEETINGS, TRAIN_PERIOD
from pitchpoint.cases.resolved_inputs import OIL
from pitchpoint.results.by_stage import of_stage, stages_of
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import Curve, law_title, laws
from pitchpoint.views.inputs import input_number, input_words, set_for_run
from pitchpoint.views.point import (
    by_members,
    driver_speed_ratio,
    of_stage_by_bodies,
    operating_point,
    way_in_a_turn,
)
from pitchpoint.views.screen import cell, efficiency_of, head, screen_value
from pitchpoint.views.section import (
    Block,
    Drawn,
    Heading,
    KeyFigure,
    Page,
    Printed,
    Section,
    figures_by_members,
    key_figure,
    key_figures,
    made_of,
    stages_together,
    variant_warnings,
)
from pitchpoint.views.sections.back_driving import (
    ROUGHEST,
    back_driving,
    back_driving_figure,
    jamming,
    locks_from,
    margin_figure,
)
from pitchpoint.views.sections.beside import loss_split
from pitchpoint.views.sections.spread import spread, spread_sentence

__all__ = [
    "ANSWER",
    "bearing_rows",
    "extrapolated_operation",
    "operation_summary",
    "operation_words",
    "sharing_words",
    "teeth_rows",
]

AVERAGES = {
    "base_pitch": "Averages run over one {pitch}, after which the state repeats.",
    MEETINGS: "Averages run over all meetings of the phases of the stages.",
    TRAIN_PERIOD: "Averages run over the motion in which all meshes come together again.",
    "path": "Averages run over the path of one pair, so double contact counts twice, as published.",
}


def _blocks(page: Page) -> Iterator[Block]:
    variants = [_variant(page, name, outcome) for name, outcome in page.outcomes.items()]
    values = {
        "variants": variants,
        "warnings": (warnings := variant_warnings(page.outcomes, "warnings", of_stage_by_bodies)),
        "first_doubt": show.first_clauses(next(iter(warnings), ""), _SUMMED_UP),
        "several": page.several,
        "designs": page.designs,
        "sums": _sums(page),
        "curves": list(_sums_of_curves(page)),
    }
    yield Drawn("answer.html.jinja", values)
    headings = set()
    for section in page.sections:
        for block in made_of(page.outcomes.values(), partial(section.closing, page)):
            if not isinstance(block, Heading):
                yield block
            elif block.words not in headings:  # sections of unlike meshes close alike
                headings.add(block.words)
                yield block


_SUMS = ("mean_efficiency", "mean_loss", "mean_input_torque", "torque_ripple")


def _sums(page: Page) -> list[str]:
    """Heads of the table of all curves: long names with units."""
    return [show.axis_title(name, _first_operation(page)) for name in _summed(page)]


def _summed(page: Page) -> tuple[str, ...]:
    return CONTACT if of_contact(_first_operation(page) or ()) else _SUMS


def _first_operation(page: Page) -> Any:
    there = page.having("operation").values()
    return next((outcome.parts["operation"] for outcome in there), None)


def _sums_of_curves(page: Page) -> Iterator[tuple[Curve, list[str]]]:
    """Curve and main figures of every law in every variant."""
    for variant, outcome in page.having("operation").items():
        data = outcome.parts["operation"]
        for position, law in enumerate(laws(data)):
            values = {name: float(data[name].values[position, 0]) for name in _summed(page)}
            cells = [show.quantity(n, v, with_unit=False, of=data) for n, v in values.items()]
            yield page.curves[variant, law], cells


def _ratio(outcome: Outcome) -> str:
    """Speed of the driver over that of the loaded member in words; empty where one of them travels."""
    ratio = driver_speed_ratio(outcome)
    driver, loaded = (show.with_article(outcome.manifest[end]) for end in ("driver", "loaded"))
    return (
        ""
        if np.isnan(ratio)
        else f"{show.number_text(ratio, 6)}, speed of {driver} over that of {loaded}"
    )


def _travel(outcome: Outcome) -> str:
    """Way of a loaded member that travels in a turn of the driver, in words; empty where it turns."""
    distance = way_in_a_turn(outcome)
    driver, loaded = (show.with_article(outcome.manifest[end]) for end in ("driver", "loaded"))
    return f"{distance} of {loaded} in a turn of {driver}" if distance else ""


def _variant(page: Page, name: str, outcome: Outcome) -> dict[str, Any]:
    """What the top of the page says about one variant."""
    manifest, parts = outcome.manifest, outcome.parts
    single = of_contact(parts.get("operation", ()))
    figures = figures_by_members(outcome, stages_together(key_figures(page.sections, outcome)))
    return {
        "name": name,
        "oil": manifest["oil"],
        "oil_note": _oil_note(outcome),
        "sharing": sharing_words(outcome),
        "tiles": [_tile(figure) for figure in figures],
        "facts": [
            (figure.name, figure.words) for figure in figures if len(figure.detail) > _IN_A_TILE
        ],
        "averaging": "" if single else _averaging(outcome),
        "operation": operation_words(outcome),
        "ratio": "" if single else _ratio(outcome),
        "travel": "" if single else _travel(outcome),
        "laws": manifest["laws"],
        "finished": manifest["finished"],
        "settings": set_for_run(manifest),
        "spread": spread(outcome),
        "instead": _instead(outcome) if "operation" in parts else [],
        "answers": [
            _answer(page, outcome, law, position, page.curves[name, law])
            for position, law in _holding_first(parts)
        ]
        if "operation" in parts
        else [],
    }


def _tile(figure: KeyFigure) -> KeyFigure:
    """A key figure with as much beside its value as a tile has room for."""
    return replace(figure, detail=show.whole_clauses(figure.detail.lstrip(",; "), _IN_A_TILE))


_IN_A_TILE = 68
"""Characters beside a value; what is longer stands in the list below the tiles."""

_SUMMED_UP = 100
"""Characters of the first doubt, the others are unfolded with it."""


def _holding_first(parts: Mapping[str, xr.Dataset]) -> list[tuple[int, str]]:
    """Positions and names of the laws of the case, those that are out of their range at the end."""
    holds = laws_hold(parts)
    return sorted(enumerate(laws(parts["operation"])), key=lambda one: not holds[one[0]])


def _instead(outcome: Outcome) -> list[dict[str, str]]:
    """Main figures by laws of the library, where they hold and none of the case does."""
    data = point_by_valid_laws(outcome.parts)
    if data is not outcome.parts.get("laws"):
        return []
    return [
        {
            "title": law_title(outcome, law),
            "covers": efficiency_coverage(data),
            **{
                name: show.quantity(name, float(data[name].values[k, 0]))
                for name in ("mean_efficiency", "mean_loss", "mean_friction")
            },
        }
        for k, law in enumerate(laws(data))
    ]


def sharing_words(outcome: Outcome) -> str:
    """How the load is shared; in a drive whose stages differ, that of each; empty for one contact alone."""
    if of_contact(outcome.parts.get("operation", ())):
        return ""
    models = outcome.manifest["models"]
    laws = ((model["effect"].partition(", "), model["title"]) for model in models)
    named = [(place, title) for (effect, _, place), title in laws if effect == "load sharing"]
    return "; ".join(f"{place}: {title}" if place else title for place, title in named)


def _averaging(outcome: Outcome) -> str:
    averaging = str(outcome.manifest["averaging"])
    return AVERAGES.get(averaging, averaging).format(pitch=outcome.manifest["pitch"])


def _oil_note(outcome: Outcome) -> str:
    """Viscosities of the oil as resolved, with their status."""
    status = {
        row["key"]: row["status"] for row in outcome.manifest["inputs"] if row["table"] == OIL
    }
    return "; ".join(
        show.pretty(
            f"{input_words(outcome, OIL, nu)} ({status[nu]}) at {input_words(outcome, OIL, at)}"
        )
        for nu, at in (("nu_1", "T_1"), ("nu_2", "T_2"))
        if nu in status
    )


def operation_words(outcome: Outcome) -> str:
    """The operating point in words."""
    speed, torque, force, temperature = (
        show.pretty(input_words(outcome, "operation", key))
        for key in ("speed", "torque", "force", "temperature")
    )
    driver, loaded = outcome.manifest["driver"], outcome.manifest["loaded"]
    return f"{driver} drives at {speed}, {loaded} carries {torque or force}, oil at {temperature}"


def _answer(page: Page, outcome: Outcome, law: str, position: int, curve: Curve) -> dict[str, Any]:
    """Main figures of one law at the operating point, in words."""
    data = outcome.parts["operation"]

    def value(name: str) -> float:
        return float(data[name].values[position, 0])

    defined = bool(np.isfinite(value("mean_efficiency")))
    return {
        "curve": curve,
        "title": law_title(outcome, law),
        "outside": law in why_not(outcome.parts),
        "defined": defined,
        "efficiency": show.quantity("mean_efficiency", value("mean_efficiency")),
        "range": _range(data, "efficiency", value),
        "loss": show.quantity("mean_loss", value("mean_loss")),
        "torque": show.quantity("mean_input_torque", value("mean_input_torque"), of=data),
        "input": show.described("mean_input_torque", data).long_name,
        "rippling": "force ripple"
        if show.described("torque_ripple", data).unit == "N"
        else "torque ripple",
        "torque_range": _range(data, "input_torque", value),
        "ripple": show.quantity("torque_ripple", value("torque_ripple"), of=data),
        "covers": efficiency_coverage(data),
        "locked": bool(data["locked"].values[position, 0]),
        "jamming": jamming(data, position),
        "back": back_driving(outcome, law),
        "contact": [
            (VARIABLES[name].long_name, show.quantity(name, value(name), of=data))
            for name in (CONTACT if of_contact(data) else ())
        ],
        "borne": list(_borne(outcome, position)),
        "drag": _drag(data, position),
        "bearings": _bearings(outcome, position),
        "more": [
            row
            for section in page.sections
            for row in made_of([outcome], partial(section.card, outcome, law))
        ],
    }


def _range(data: xr.Dataset, name: str, value: Callable[[str], float]) -> str:
    ends = f"min_{name}", f"max_{name}"
    return show.span(*ends, [value(end) for end in ends], data)


def _drag(data: xr.Dataset, law: int) -> str:
    """Loss in and beside the teeth in words; empty where there is none beside."""
    split = loss_split(data, law)
    if split is None or not split[1] > 0.0:
        return ""
    teeth, beside = (show.quantity("mean_loss", value) for value in split)
    return f"{teeth} in the teeth, {beside} beside them"


def _bearings(outcome: Outcome, law: int) -> list[tuple[str, str]]:
    """What the teeth put on the shafts, and each bearing beside them bears: names and words."""
    data = outcome.parts["operation"]
    rows = [*_reactions(outcome, law)]
    if "bearing_load" in data:
        loads = zip(data["place"].values, data["bearing_load"].values[law, 0], strict=True)
        rows += [
            (f"load on {place}".replace("_", " "), show.quantity("bearing_load", load))
            for place, load in loads
            if load > 0.0
        ]
    return [*rows, *_lives(data, law)]


def _lives(data: xr.Dataset, law: int) -> list[tuple[str, str]]:
    """Lives of bearings by their ratings: names and words."""
    if "bearing_life" not in data:
        return []
    lives = zip(data["place"].values, data["bearing_life"].values[law, 0], strict=True)
    return [*_static_safeties(data, law)] + [
        (
            f"life of {place}".replace("_", " "),
            "without load" if np.isinf(life) else show.quantity("bearing_life", life),
        )
        for place, life in lives
        if not np.isnan(life)
    ]


def _static_safeties(data: xr.Dataset, law: int) -> Iterator[tuple[str, str]]:
    """Static safeties of bearings that have that rating and bear something: names and words."""
    if "static_bearing_safety" in data:
        safeties = data["static_bearing_safety"].values[law, 0]
        for place, safety in zip(data["place"].values, safeties, strict=True):
            if np.isfinite(safety):
                yield f"static safety of {place}".replace("_", " "), show.number_text(float(safety))


_ACROSS = {
    ("shaft", "radial"): "radial load on the shaft of the {}",
    ("shaft", "axial"): "axial load on the shaft of the {}",
    ("guides", "radial"): "load on the guides of the {}, across its travel",
    ("guides", "axial"): "load on the guides of the {}, along the face",
}


def _reactions(outcome: Outcome, law: int) -> Iterator[tuple[str, str]]:
    """Loads of the teeth on the shafts of both members, or on the guides of one that travels."""
    data, manifest = outcome.parts["operation"], outcome.manifest
    if of_contact(data):
        return  # a rig has bearings of its own
    guided = [manifest[end] for end in manifest.get("travels", ())]
    for name in (name for name in ("radial", "axial") if f"{name}_reaction_1" in data):
        both = [abs(float(data[f"{name}_reaction_{gear}"].values[law, 0])) for gear in (1, 2)]
        loads = [show.quantity(f"{name}_reaction_1", value) for value in both]
        if any(both) and not guided:
            yield f"{name} load on the shafts", " and ".join(dict.fromkeys(loads))
        elif any(both):
            for body, value, words in zip(manifest["members"], both, loads, strict=True):
                held = "guides" if body in guided else "shaft"
                if value > 0.0:  # guides take nothing along the travel
                    yield _ACROSS[held, name].format(body), words


_LOCKS = "self-locking from a friction coefficient of"


def _screen(outcome: Outcome) -> Iterator[Printed]:
    yield Printed(line=_oil(outcome))
    if "operation" in outcome.parts:
        yield operation_summary(outcome)
        yield extrapolated_operation(outcome)
        yield Printed(rows=teeth_rows(outcome))
        yield Printed(rows=bearing_rows(outcome))


def _oil(outcome: Outcome) -> str:
    manifest = outcome.manifest
    single = of_contact(outcome.parts.get("operation", ()))
    averages = "" if single else f" Averages over: {manifest['averaging']}."
    return f"Oil: {manifest['oil']}.{averages}"


def operation_summary(outcome: Outcome) -> Printed:
    """The operating point by the laws that hold there, and under it how far these disagree."""
    data = point_by_valid_laws(outcome.parts)
    title = ""
    if data is outcome.parts.get("laws"):
        title = "Laws of the library, which hold here; those of the case are out of their range"
    elif not any(laws_hold(outcome.parts)):
        title = "No friction law holds here: extrapolations"
    return Printed(title, _rows(outcome, data), spread_sentence(outcome))


def extrapolated_operation(outcome: Outcome) -> Printed:
    """The operating point by the laws of the case that are out of their range, where others hold."""
    data, holds = outcome.parts["operation"], laws_hold(outcome.parts)
    if all(holds) or point_by_valid_laws(outcome.parts) is data:
        return Printed()
    outside = data.isel(law=[k for k, so in enumerate(holds) if not so])
    return Printed("Out of their range here: extrapolations", _rows(outcome, outside))


def _rows(outcome: Outcome, data: xr.Dataset) -> list[dict[str, str]]:
    """Main figures by law."""
    return [
        {
            "friction law": str(law),
            **{head(name, data): cell(data, name, position) for name in main_figures(data)},
            **_of_power(outcome, data, position),
        }
        for position, law in enumerate(data["law"].values)
    ]


def _of_power(outcome: Outcome, data: xr.Dataset, position: int) -> dict[str, str]:
    """Cells on the power that goes through, for the law at a position; none where nothing does."""
    back = outcome.parts.get("back_driving")
    if back is None:
        return {}
    return {
        **efficiency_of(data),
        _LOCKS: _locks(data, position),
        **_backwards(back, str(data["law"].values[position])),
    }


def _backwards(back: xr.Dataset, law: str) -> dict[str, str]:
    """Cells on back-driving, which is known by the laws of the case."""
    if law not in laws(back):
        return {}
    position = laws(back).index(law)
    locked = bool(back["locked"].values[position, 0])
    return {
        "back-driving": "locked" if locked else cell(back, "mean_efficiency", position),
        f"back-driving, {_LOCKS}": _locks(back, position),
        **_margin(back, position),
    }


def _margin(back: xr.Dataset, position: int) -> dict[str, str]:
    """Cell on how far friction is from locking the drive backwards, see `margin_figure`."""
    name, limit = "self_locking_margin", float(back["jamming_coefficient"].values[position, 0])
    known = name in back and limit <= ROUGHEST
    return {"margin of self-locking": cell(back, name, position)} if known else {}


def _locks(data: xr.Dataset, position: int) -> str:
    limit = float(data["jamming_coefficient"].values[position, 0])
    coefficient = cell(data, "jamming_coefficient", position)
    return locks_from(limit, coefficient) if np.isfinite(limit) else coefficient


def teeth_rows(outcome: Outcome) -> list[dict[str, str]]:
    """What flanks bear at the operating point by law; none where nothing is known of it."""
    rows = [
        {"friction law": law} | {words: figure for words, figure in _borne(outcome, k)}
        for k, law in enumerate(laws(outcome.parts["operation"]))
    ]
    return rows if len(rows[0]) > 1 else []


def _borne(outcome: Outcome, law: int) -> Iterator[tuple[str, str]]:
    """Largest Hertz pressure over the mesh cycle, and the part of the load on edges where there are any."""
    cycle, torsion = (outcome.parts.get(name) for name in ("cycle", "torsion"))
    if cycle is not None:
        pressures = _pressures(cycle, law)
        most = max(pressures, key=lambda stage: pressures[stage])
        pressure = show.quantity("pressure", pressures[most])
        place = by_members(outcome, f" at {most}") if most else ""
        yield VARIABLES["pressure"].long_name, f"{pressure}{place}"
        yield from _ellipse(cycle, law)
    if torsion is not None and "edge_share" in torsion:
        at = operating_point(outcome).torque
        share = float(np.interp(at, torsion["torque"], torsion["edge_share"]))
        yield VARIABLES["edge_share"].long_name, show.quantity("edge_share", share)


def _pressures(cycle: xr.Dataset, law: int) -> dict[str, float]:
    """Largest pressure of each stage by its name under the law in a place, or its last one [Pa]."""
    of_stages = {f"stage {label}": of_stage(cycle, label) for label in stages_of(cycle)} or {
        "": cycle
    }
    return {
        stage: float(data["pressure"].values[min(law, data.sizes["law"] - 1)].max())
        for stage, data in of_stages.items()
    }


def _ellipse(cycle: xr.Dataset, law: int) -> Iterator[tuple[str, str]]:
    """The largest ellipse of contact, and how far it is from leaving the face; none for lines."""
    if "contact_room" not in cycle or stages_of(cycle):
        return
    axes = (
        float(cycle[f"semi_axis_{direction}"].values[law].max())
        for direction in ("across", "along")
    )
    lengths = [show.quantity("semi_axis_across", axis) for axis in axes]
    room, inclination = (
        show.quantity(name, float(cycle[name].values[law].min()))
        for name in ("contact_room", "largest_inclination")
    )
    yield "semi-axes of the contact, across and along", " and ".join(lengths)
    yield "room to the end of the face", room
    yield "largest inclination", inclination


def bearing_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Load on the bearings by law, those that are nothing anywhere left out."""
    data = outcome.parts["operation"]
    rows = [
        {"friction law": str(law)}
        | {
            head(name): cell(data, name, k)
            for name in REACTIONS
            if name in data and np.any(data[name])
        }
        | {
            f"{head('bearing_load')} {place.replace('_', ' ')}": screen_value(
                "bearing_load", float(load)
            )
            for place, load in bearing_loads_by_name(data, k)
        }
        | dict(_lives(data, k))
        for k, law in enumerate(data["law"].values)
    ]
    return rows if len(rows[0]) > 1 else []


def _key_figures(outcome: Outcome) -> Iterator[KeyFigure]:
    """Figures of the operating point under the first law that holds there."""
    if "operation" not in outcome.parts:
        return
    data = point_by_valid_laws(outcome.parts)

    def figure(order: float, name: str, variable: str, detail: str = "") -> KeyFigure:
        value = show.quantity(variable, float(data[variable].values[0, 0]), of=data)
        return KeyFigure(order, name, value, detail)

    if of_contact(data):
        for place, name in enumerate(CONTACT):
            order = 10.0 if name in _OF_FILM else 34.0 if name in _GIVEN_BY_SPEEDS else 33.0
            yield figure(order + 0.1 * place, VARIABLES[name].long_name, name)
        return
    yield from _efficiencies(figure, outcome, data)
    without = [f"without the {lacks}"] if (lacks := _lacks(data)) else []
    yield figure(20.0, "Input", "mean_input_torque", _clauses(*without, _ripple(data)))
    yield figure(25.0, "Loss", "mean_loss", _clauses(*without, _drag(data, 0)))
    yield from _shortest_life(outcome.parts["operation"])
    if "latent_power" in data:
        yield figure(77.0, "Latent power", "latent_power", _times_input(outcome, data))
    law = str(data["law"].values[0])
    if law in laws(outcome.parts["operation"]):
        position = laws(outcome.parts["operation"]).index(law)
        for place, (name, value) in enumerate(_borne(outcome, position)):
            named = _BRIEFLY.get(name, name).capitalize()
            yield key_figure(78.0 + 0.1 * place, named, value, " at stage")
        if "back_driving" in outcome.parts:
            yield back_driving_figure(outcome, law)
            yield from margin_figure(outcome, law)


_OF_FILM = ("film_thickness", "lambda_ratio", "pressure")
_GIVEN_BY_SPEEDS = ("entrainment", "sliding_velocity")
"""Figures of a test rig that stand before films which are solved, and behind all others."""

_BRIEFLY = {
    VARIABLES["pressure"].long_name: "Hertz pressure",
    VARIABLES["edge_share"].long_name: "load on edges",
    "semi-axes of the contact, across and along": "contact ellipse",
    "room to the end of the face": "room to the end",
}
"""Names of key figures where a column of names is narrow."""


def _efficiencies(
    figure: Callable[[float, str, str, str], KeyFigure], outcome: Outcome, data: xr.Dataset
) -> Iterator[KeyFigure]:
    """The efficiency; where a drive lacks a part that loses, that first, and below it what is known.

    That of a drive of several meshes without any losses beside its teeth is named as theirs.
    """
    if lacks := _lacks(data):
        yield KeyFigure(10.0, "Efficiency", "not known", f"lacks the {lacks}, see [losses]")
    alone = outcome.manifest.get("stages") and efficiency_coverage(data).startswith("teeth alone")
    title = "Efficiency of teeth" if alone else "Efficiency"
    place, name = (26.0, "Efficiency without it") if lacks else (10.0, title)
    yield figure(place, name, "mean_efficiency", _certainty(outcome, data))


def _certainty(outcome: Outcome, data: xr.Dataset) -> str:
    """What the efficiency is of, and how far the laws that apply disagree."""
    scope = efficiency_coverage(data).partition(":")[0]
    apart = spread(outcome)
    others = [*_by_other_laws(outcome, data)]
    if not any(laws_hold(outcome.parts)) and data is outcome.parts["operation"]:
        clauses = [scope, "no fitted law is in its range here"]
    elif apart and apart["points"]:
        clauses = [f"{apart['text']} by the laws in their range", scope]
    else:
        over = _range(data, "efficiency", lambda name: float(data[name].values[0, 0]))
        clauses = [scope, f"over the cycle {over}"]
    if not outcome.manifest.get("stages"):  # the line above has the law
        return _clauses(*others, *clauses)
    law = f"by {data['law'].values[0]}"
    return _clauses(*others, clauses.pop(), law, *clauses)


def _shortest_life(data: xr.Dataset) -> Iterator[KeyFigure]:
    """The shortest life of the rated bearings under the first law; nothing where none is rated."""
    if "bearing_life" not in data or np.isnan(lives := data["bearing_life"].values[0, 0]).all():
        return
    at = int(np.nanargmin(lives))
    if np.isinf(lives[at]):
        return  # none bears anything
    place = str(data["place"].values[at]).replace("_", " ")
    load = show.quantity("bearing_load", float(data["equivalent_bearing_load"].values[0, 0, at]))
    life = show.quantity("bearing_life", float(lives[at]))
    yield KeyFigure(43.0, "Life of bearings", life, f"L10 of {place} by ISO 281 under {load}")


def _times_input(outcome: Outcome, data: xr.Dataset) -> str:
    """Power that rolls through the meshes of sets, all together, as so many times that of the input."""
    rolls, torque = (float(data[n].values[0, 0]) for n in ("latent_power", "mean_input_torque"))
    power = torque * input_number(outcome, "operation", "speed")
    return (
        f"all meshes, {show.number_text(rolls / power, 3)} times the input"
        if power > 0.0
        else "all meshes"
    )


def _lacks(data: xr.Dataset) -> str:
    """What of the drive loses and is not in its numbers; empty where nothing is known to be left out."""
    return str(data["mean_efficiency"].attrs.get("lacks", ""))


def _clauses(*words: str) -> str:
    return "; ".join(filter(None, words))


def _by_other_laws(outcome: Outcome, data: xr.Dataset) -> Iterator[str]:
    """Efficiency under each further law of the case, and whether it is out of its range."""
    operation, outside = outcome.parts["operation"], why_not(outcome.parts)
    efficiencies = zip(laws(operation), operation["mean_efficiency"].values[:, 0], strict=True)
    for law, value in sorted(efficiencies, key=lambda pair: pair[0] in outside):
        if law != laws(data)[0]:
            of_case = "" if any(laws_hold(outcome.parts)) else " of the case"
            outside_here = law in outside and data is not operation
            apart = f"{of_case} out of its range" if outside_here else ""
            yield f"{show.quantity('mean_efficiency', float(value))} by {law}{apart}"


def _ripple(data: xr.Dataset) -> str:
    """What varies of the torque or force at the driver."""
    if "torque_ripple" not in data:
        return ""
    ripple = show.quantity("torque_ripple", float(data["torque_ripple"].values[0, 0]), of=data)
    return f"in the mean, {ripple} peak to peak"


ANSWER = Section(
    name="answer",
    title="The answer",
    short="Answer",
    order=0.0,
    lacks=lambda page: None,
    blocks=_blocks,
    answer=_key_figures,
    screen=_screen,
)
