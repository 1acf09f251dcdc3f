"""The report: one HTML file that opens from disk and says what was computed, with what, and from whom."""

import json
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from math import ceil, degrees, log10
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pitchpoint.analyses.caveats import jamming_words
from pitchpoint.analyses.figures import CONTACT, MAIN, of_contact
from pitchpoint.cases.comparison import Row, counts
from pitchpoint.cases.inputs import OIL
from pitchpoint.results.store import write_text
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.cycle import cycle_panel, cycle_pitch, loss_places, path_panel
from pitchpoint.views.design_chart import design_charts
from pitchpoint.views.drive import picture, wave_dimensions
from pitchpoint.views.facts import Facts, facts, has_path, has_wave, same_geometry, timed
from pitchpoint.views.figures import Curve, Curves, Panel, curves, law_title, laws
from pitchpoint.views.geometry import dimensions, drawing
from pitchpoint.views.inputs import input_rows, set_for_run, words
from pitchpoint.views.kinematic_error import kinematic_error_answer, kinematic_error_panels
from pitchpoint.views.maps import efficiency_panel, map_panel
from pitchpoint.views.plane_of_action import plane_of_action
from pitchpoint.views.running import bearing_answer, drag_answer, drag_panel, starting_answer
from pitchpoint.views.sliding import sliding_figure
from pitchpoint.views.stages import has_stages, stage_answer
from pitchpoint.views.stiffness import (
    outside_standard,
    pair_key,
    stiffness_answer,
    stiffness_panels,
    stiffness_table,
)
from pitchpoint.views.sweeps import study_panels, study_tables
from pitchpoint.views.torsion import torsion_answer, torsion_panels
from pitchpoint.views.vibration import (
    resonance_panels,
    vibration_answer,
    vibration_panels,
    vibration_tables,
)
from pitchpoint.views.wave import arc_panel, gap_panel, told_arcs, wave_losses, wave_sentence

if TYPE_CHECKING:
    import jinja2
    import markupsafe

__all__ = ["loss_sentence", "render", "write_report"]

STATUSES = {
    "printed": "stands in the source",
    "derived": "follows from printed values",
    "digitised": "read from a figure",
    "assumed": "not stated anywhere, chosen",
    "fitted": "tuned until a printed result was met",
    "corrected": "differs from the source, with a reason",
    "given": "stands in the case file or the catalogue",
    "set": "set for this run",
    "default": "not given, taken as usual",
}
AVERAGES = {
    "base_pitch": "Averages run over one {pitch}, after which the state repeats.",
    "path": "Averages run over the path of one pair, so double contact counts twice, as published.",
}
KINDS = {
    "predicted": "nothing was tuned to it",
    "calibrated": "a constant or a reading of the model was found with it",
    "fitted": "an input was tuned to it",
    "trend": "only a direction was printed",
    "reference": "a value of an independent calculation, not of the publication",
    "excluded": "not computed, for the reason given",
}
_ORDER = {"miss": 0, "excluded": 1, "pass": 2}
_SIDE_BY_SIDE = (
    *MAIN,
    "loss_factor",
    "contact_ratio",
    "mean_stiffness",
    "stiffness_variation",
    "mean_transmission_error",
    "transmission_error_range",
    "largest_dynamic_factor",
)


def write_report(outcomes: Mapping[str, Outcome], path: str | Path) -> None:
    """Write the report; a reader never sees half of it.

    Args:
        outcomes: by variant, as `run` and `open_result` give them.
        path: of the HTML file.
    """
    write_text(Path(path), render(outcomes))


def render(outcomes: Mapping[str, Outcome]) -> str:
    """The report as text.

    Args:
        outcomes: by variant, at least one; parts that were not finished are left out.
    """
    from markupsafe import Markup
    from plotly.offline import get_plotlyjs

    known = curves(outcomes)
    drawn = {name: one for name, one in outcomes.items() if has_path(one)}
    waves = {name: one for name, one in outcomes.items() if has_wave(one)}
    toothed = drawn | waves
    staged = {name: one for name, one in outcomes.items() if has_stages(one)}
    panels = {
        "path": path_panel(drawn, known) if drawn else Panel("", []),
        "arc": arc_panel(waves, known),
        "cycle": cycle_panel(toothed, known) if toothed else Panel("", []),
        "drag": drag_panel(outcomes, known),
        "map": map_panel(toothed | staged, known) if toothed | staged else Panel("", []),
        "efficiency": efficiency_panel(_lossy(toothed), known),
    }
    sweeps = study_panels(outcomes, known)
    charts = design_charts(outcomes)
    teeth = _teeth(drawn)
    drives = _drives(waves)
    moving = {
        "stiffness": stiffness_panels(outcomes),
        "vibration": vibration_panels(outcomes),
        "resonance": resonance_panels(outcomes),
        "torsion": torsion_panels(outcomes, known),
        "kinematic_error": kinematic_error_panels(outcomes),
    }
    first = next(iter(outcomes.values())).manifest
    return (
        _environment()
        .get_template("report.html.jinja")
        .render(
            first=first,
            variants=[_variant(name, one, known) for name, one in outcomes.items()],
            several=len(outcomes) > 1,
            inputs=_inputs(outcomes),
            statuses=STATUSES,
            teeth=teeth,
            drives=drives,
            panels=panels,
            moving=moving,
            stiffness_table=stiffness_table(outcomes),
            vibration_tables=vibration_tables(outcomes),
            charts=charts,
            sweeps=sweeps,
            study_warnings=_study_warnings(outcomes),
            tables=study_tables(outcomes, known),
            losses=_losses(toothed, known),
            point_notes=_point_notes(drawn),
            cycle_words=_cycle_words(toothed),
            pitch=cycle_pitch(toothed) if toothed else "",
            entry="enters at one end of the face" if _helical(drawn) else "is at A",
            rows=_rows(outcomes),
            kinds=KINDS,
            beside=_side_by_side(outcomes, known) if len(outcomes) > 1 else None,
            source_keys={s["key"] for one in outcomes.values() for s in one.manifest["sources"]},
            sources=_unique(
                source for one in outcomes.values() for source in one.manifest["sources"]
            ),
            models=_models(outcomes),
            parts=_parts(outcomes),
            version=_version(outcomes),
            data=Markup(
                _payload(
                    [
                        *(one["sliding"] for one in teeth),
                        *(one["gap"] for one in drives),
                        *panels.values(),
                        *(panel for each in moving.values() for panel in each),
                        *charts,
                        *sweeps,
                    ]
                )
            ),
            plotly=Markup(get_plotlyjs()),
        )
    )


def _lossy(outcomes: Mapping[str, Outcome]) -> dict[str, Outcome]:
    """Those that lose enough for lines of the efficiency to say more than the map does."""
    return {name: one for name, one in outcomes.items() if has_wave(one) or "running" in one.parts}


@cache
def _environment() -> "jinja2.Environment":
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("pitchpoint.views"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["marked"] = _marked
    return environment


def _marked(words: str) -> "markupsafe.Markup":
    """Words, escaped, with `code` set as code and units as printed."""
    from markupsafe import Markup, escape

    parts = [escape(part) for part in show.pretty(words).split("`")]
    if len(parts) % 2 == 0:
        return escape(show.pretty(words))
    code = Markup("<code>{}</code>")
    return Markup("").join(code.format(p) if k % 2 else p for k, p in enumerate(parts))


def _payload(panels: Iterable[Panel]) -> str:
    """Figures and menus for the script, with nothing in it that could end the script element."""
    each = list(panels)
    content = {
        "figures": {
            figure.name: {"data": figure.data, "layout": figure.layout}
            for panel in each
            for figure in panel.figures
            if figure.drawn
        },
        "menus": {
            panel.figures[0].name: [choice.changes for choice in panel.choices]
            for panel in each
            if panel.choices
        },
    }
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    for sign in "<>&\u2028\u2029":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return text


def _variant(name: str, outcome: Outcome, known: Curves) -> dict[str, Any]:
    """What the top of the page says about one variant."""
    manifest, parts = outcome.manifest, outcome.parts
    single = of_contact(parts.get("operation", ()))
    return {
        "name": name,
        "oil": manifest["oil"],
        "oil_note": _oil_note(outcome),
        "sharing": "" if single else manifest["models"][0]["title"],
        "averaging": "" if single else _averaging(outcome),
        "operation": _operation(outcome),
        "laws": manifest["laws"],
        "warnings": _warnings(outcome),
        "finished": manifest["finished"],
        "settings": set_for_run(manifest),
        "spread": _spread(outcome),
        "stiffness": stiffness_answer(outcome),
        "torsion": torsion_answer(outcome),
        "kinematic_error": kinematic_error_answer(outcome),
        "vibration": vibration_answer(outcome),
        "answers": [
            _answer(outcome, law, position, known[name, law])
            for position, law in enumerate(laws(parts["operation"]))
        ]
        if "operation" in parts
        else [],
    }


def _averaging(outcome: Outcome) -> str:
    told = str(outcome.manifest["averaging"])
    return AVERAGES.get(told, told).format(pitch=cycle_pitch({"": outcome}))


def _oil_note(outcome: Outcome) -> str:
    """Viscosities of the oil as resolved, with their status."""
    status = {
        row["key"]: row["status"] for row in outcome.manifest["inputs"] if row["table"] == OIL
    }
    return "; ".join(
        show.pretty(f"{words(outcome, OIL, nu)} ({status[nu]}) at {words(outcome, OIL, at)}")
        for nu, at in (("nu_1", "T_1"), ("nu_2", "T_2"))
        if nu in status
    )


def _operation(outcome: Outcome) -> str:
    """The operating point in words."""
    speed, torque, force, temperature = (
        show.pretty(words(outcome, "operation", key))
        for key in ("speed", "torque", "force", "temperature")
    )
    driver, loaded = outcome.manifest["driver"], outcome.manifest["loaded"]
    return f"{driver} drives at {speed}, {loaded} carries {torque or force}, oil at {temperature}"


def _answer(outcome: Outcome, law: str, position: int, curve: Curve) -> dict[str, Any]:
    """Main figures of one law at the operating point, in words."""
    data = outcome.parts["operation"]

    def value(name: str) -> float:
        return float(data[name].values[position, 0])

    defined = bool(np.isfinite(value("mean_efficiency")))
    return {
        "curve": curve,
        "title": law_title(outcome, law),
        "defined": defined,
        "efficiency": show.quantity("mean_efficiency", value("mean_efficiency")),
        "range": _range("efficiency", value),
        "loss": show.quantity("mean_loss", value("mean_loss")),
        "torque": show.quantity("mean_input_torque", value("mean_input_torque")),
        "torque_range": _range("input_torque", value),
        "ripple": show.quantity("torque_ripple", value("torque_ripple")),
        "covers": str(data["mean_efficiency"].attrs.get("covers", "")),
        "locked": bool(data["locked"].values[position, 0]),
        "jamming": _jamming(data, position),
        "back": _back_driving(outcome, law),
        "contact": [
            (VARIABLES[name].long_name, show.quantity(name, value(name)))
            for name in _at_contact(data)
        ],
        "drag": drag_answer(outcome, position),
        "bearings": [*stage_answer(outcome, position), *bearing_answer(outcome, position)],
        "starting": starting_answer(outcome, law),
    }


def _at_contact(data: Any) -> tuple[str, ...]:
    """Names of the figures of a test rig; none of a drive."""
    return CONTACT if of_contact(data) else ()


def _range(name: str, value: Callable[[str], float]) -> str:
    ends = f"min_{name}", f"max_{name}"
    return show.span(*ends, [value(end) for end in ends])


def _back_driving(outcome: Outcome, law: str) -> str:
    """Efficiency with the other gear driving, or that friction locks the mesh, and from when on it does."""
    data = outcome.parts.get("back_driving")
    if data is None or law not in laws(data):
        return "not computed"
    position = laws(data).index(law)
    if bool(data["locked"].values[position, 0]):
        ends = ("nearest_friction", "nearest_jamming_coefficient")
        acting, limit = (float(data[name].values[position, 0]) for name in ends)
        return f"self-locking: friction locks the mesh; {jamming_words(acting, limit)}"
    value = float(data["mean_efficiency"].values[position, 0])
    if not np.isfinite(value):
        return "undefined, no power"
    told = f"{show.quantity('mean_efficiency', value)}, friction does not lock the mesh"
    locks = _jamming(data, position)
    return f"{told} (it would from μ = {locks} on)" if locks else told


def _jamming(data: Any, position: int) -> str:
    """Friction coefficient at which the mesh locks; empty where none does."""
    if "jamming_coefficient" not in data:
        return ""
    limit = float(data["jamming_coefficient"].values[position, 0])
    return show.number(limit, 3) if np.isfinite(limit) else ""


def _spread(outcome: Outcome) -> dict[str, Any] | None:
    """How far the friction laws that apply disagree; None where that is not known."""
    data = outcome.parts.get("laws")
    if data is None:
        return None
    outside = [
        (law_title(outcome, str(one["law"])), _efficiency(one), "; ".join(one["reasons"]))
        for one in json.loads(data.attrs.get("outside", "[]"))
    ]
    if not data.sizes["law"]:
        text = "none of the library is in its range"
        return {"text": text, "rows": [], "points": "", "outside": outside} if outside else None
    locked = data["locked"].values[:, 0].astype(bool)
    values = data["mean_efficiency"].values[:, 0]
    known = values[np.isfinite(values) & ~locked]
    known = np.append(known, _chosen(outcome)) if known.size else known
    rows = [
        (law_title(outcome, law), *(_cell(data, name, k) for name in _SPREAD_SHOWN))
        for k, law in enumerate(laws(data))
    ]
    if not known.size:
        text = "all lock the mesh" if locked.all() else "undefined, no power"
        return {"text": text, "rows": rows, "points": "", "outside": outside}
    ends = [f"{100 * end:.2f}" for end in (known.min(), known.max())]
    text = f"{' to '.join(dict.fromkeys(ends))} %"
    if locked.any():
        names = [law_title(outcome, law) for law, so in zip(laws(data), locked, strict=True) if so]
        text += f"; locked by {', '.join(names)}"
    if outcome.manifest.get("plastic"):
        text += ", by laws for steel on steel; none was fitted to plastic teeth"
    points = f"{100 * np.ptp(known):.2f}" if known.size > 1 else ""
    return {"text": text, "rows": rows, "points": points, "outside": outside}


def _efficiency(entry: Mapping[str, Any]) -> str:
    value = entry["mean_efficiency"]
    return show.quantity("mean_efficiency", np.nan if value is None else float(value))


def _chosen(outcome: Outcome) -> np.ndarray:
    """Efficiencies by the laws of the case, those in their range under which the mesh moves."""
    data = outcome.parts["operation"]
    values = data["mean_efficiency"].values[:, 0]
    told = json.loads(outcome.parts["laws"].attrs.get("outside", "[]"))
    inside = ~np.isin(laws(data), [one["law"] for one in told])
    return np.asarray(
        values[np.isfinite(values) & inside & ~data["locked"].values[:, 0].astype(bool)]
    )


_SPREAD_SHOWN = ("mean_efficiency", "mean_loss", "mean_friction")


def _cell(data: Any, name: str, law: int) -> str:
    if name == "mean_efficiency" and bool(data["locked"].values[law, 0]):
        return "locks the mesh"
    return show.quantity(name, float(data[name].values[law, 0]))


def _warnings(outcome: Outcome) -> list[str]:
    """Sentences of the design and of the parts, each once.

    What the standard's estimate of the stiffness does not cover is told beside that estimate.
    """
    texts = list(outcome.manifest["warnings"])
    for name, data in outcome.parts.items():
        if name.startswith("study_"):
            continue  # told beside the studies
        found = [str(text) for text in json.loads(data.attrs.get("warnings", "[]"))]
        texts += [f"{data.attrs['title']}: {text}" for text in found if text not in texts]
    beside = outside_standard(outcome.parts["stiffness"]) if "stiffness" in outcome.parts else []
    return [text for text in dict.fromkeys(texts) if text not in _told_of_standard(beside)]


def _study_warnings(outcomes: Mapping[str, Outcome]) -> list[str]:
    """Sentences of the studies, each with its variant and title."""
    several = len(outcomes) > 1
    return [
        f"{f'{variant}, ' if several else ''}{data.attrs['title']}: {text}"
        for variant, outcome in outcomes.items()
        for name, data in outcome.parts.items()
        if name.startswith("study_")
        for text in json.loads(data.attrs.get("warnings", "[]"))
        if text not in outcome.manifest["warnings"]
    ]


def _told_of_standard(texts: list[str]) -> set[str]:
    return {*texts, *(f"mesh stiffness: {text}" for text in texts)}


def _inputs(outcomes: Mapping[str, Outcome]) -> list[dict[str, Any]]:
    """Inputs by table and key; one entry where the variants agree, one for each where they do not."""
    rows: dict[tuple[str, str], dict[str, dict[str, str]]] = {}
    for variant, outcome in outcomes.items():
        for row in input_rows(outcome.manifest):
            rows.setdefault((row["table"], row["key"]), {})[variant] = row
    tables: dict[str, list[dict[str, Any]]] = {}
    for (table, key), by_variant in rows.items():
        tables.setdefault(table, []).append(_input(show.pretty(key), by_variant, len(outcomes)))
    return [{"table": table, "rows": inside} for table, inside in tables.items()]


def _input(key: str, by_variant: Mapping[str, dict[str, str]], variants: int) -> dict[str, Any]:
    cells: dict[tuple[str, ...], list[str]] = {}
    for variant, row in by_variant.items():
        mark = (show.pretty(row["value"]), row["status"], row["where"], row["note"])
        cells.setdefault(mark, []).append(variant)
    differs = len(cells) > 1 or len(by_variant) < variants
    return {
        "key": key,
        "differs": differs,
        "cells": [
            {"variants": ", ".join(names) if differs else "", "value": mark[0], "status": mark[1]}
            | {"where": mark[2], "note": mark[3]}
            for mark, names in cells.items()
        ],
    }


def _teeth(outcomes: Mapping[str, Outcome]) -> list[dict[str, Any]]:
    """Drawings, one for variants that share their teeth."""
    return [
        {
            "variants": variants,
            "picture": drawing(outcome).picture(f"mesh{position}"),
            "plane": _plane(outcome),
            "sliding": Panel("", [sliding_figure(f"sliding{position}", outcome)]),
            "dimensions": dimensions(outcome),
            "fact": facts(outcome),
        }
        for position, (variants, outcome) in enumerate(_of_geometry(outcomes))
    ]


def _drives(outcomes: Mapping[str, Outcome]) -> list[dict[str, Any]]:
    """Drawings of drives whose teeth are carried by a wave, one for variants that share their teeth."""
    return [
        {
            "variants": variants,
            "picture": picture(outcome, f"drive{position}"),
            "gap": gap_panel(outcome, f"drive{position}"),
            "dimensions": wave_dimensions(outcome),
            "arcs": told_arcs(outcome),
        }
        for position, (variants, outcome) in enumerate(_of_geometry(outcomes))
    ]


def _of_geometry(outcomes: Mapping[str, Outcome]) -> list[tuple[str, Outcome]]:
    """Names of the variants that share their teeth, and one of them; no names if all do."""
    groups: list[tuple[list[str], Outcome]] = []
    for variant, outcome in outcomes.items():
        for names, other in groups:
            if same_geometry(other, outcome):
                names.append(variant)
                break
        else:
            groups.append(([variant], outcome))
    several = len(outcomes) > 1 and len(groups) > 1
    return [(", ".join(names) if several else "", outcome) for names, outcome in groups]


def _plane(outcome: Outcome) -> dict[str, Any]:
    """Plane of action, its lines in the colours of the pairs, lengths in words."""
    picture = plane_of_action(outcome.parts["teeth"]).picture()
    keys = [pair_key(lane) for lane in range(picture["lanes"] + 1)]
    told = {
        name: f"{show.number(picture[name], trailing=True)} mm"
        for name in ("mean", "least", "most")
    }
    return {**picture, "pairs": keys, "told": told}


def _losses(outcomes: Mapping[str, Outcome], known: Curves) -> list[tuple[Curve, str]]:
    """A sentence for each curve that says where in the mesh the loss is made."""
    result = []
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            for position, law in enumerate(laws(outcome.parts["cycle"])):
                result.append((known[variant, law], _loss_words(outcome, position)))
    return result


def _loss_words(outcome: Outcome, law: int) -> str:
    if has_wave(outcome):
        return wave_sentence(wave_losses(outcome, law))
    fact = facts(outcome)
    return loss_sentence(loss_places(outcome.parts["cycle"], law, fact), fact)


def loss_sentence(shares: Mapping[tuple[str, str], float], fact: Facts) -> str:
    """Where the loss is made, in words.

    Args:
        shares: by the two points between which it is made.
        fact: with the order of the points.
    """
    if not shares:
        return "There is no loss."
    told = ", ".join(f"{100 * share:.0f} % between {a} and {b}" for (a, b), share in shares.items())
    if "C" not in fact.points:
        return f"{told}. The pitch point lies outside the path."
    middle = fact.points["C"]
    before = sum(share for (_, end), share in shares.items() if fact.points[end] <= middle + 1e-9)
    approach, recess = (1.0 - before, before) if fact.backwards else (before, 1.0 - before)
    return (
        f"{told}: {100 * approach:.0f} % before the pitch point C (approach) and "
        f"{100 * recess:.0f} % after it (recess)."
    )


def _point_notes(outcomes: Mapping[str, Outcome]) -> list[str]:
    """What the letters mean for this contact ratio and driver."""
    if not outcomes:
        return []
    fact = facts(next(iter(outcomes.values())))
    notes = [_letters(fact)]
    if fact.helical:
        notes.append(
            f"Contact lines cross the face at an angle, so a pair is in contact for "
            f"{show.number(fact.contact_ratio)} base pitches, {show.number(fact.overlap_ratio)} longer "
            "than the path. Over the path from A stand values at the middle of the face, over the base "
            "pitches since the pair entered those of the whole contact line."
        )
    elif fact.transverse_ratio > 2.0:
        notes.append(
            "With a contact ratio above 2 there is no single contact, and D comes before B."
        )
    else:
        notes.append("Between B and D one pair carries the load, outside two share it.")
    cycles = [one.parts["cycle"] for one in outcomes.values() if "cycle" in one.parts]
    if not fact.helical and any(cycle.sizes["slice"] > 1 for cycle in cycles):
        notes.append("What differs over the face is shown where the load on it is highest.")
    if fact.backwards:
        notes.append("Gear 2 drives, so every pair runs from E to A, and the phase runs backwards.")
    return notes


def _helical(outcomes: Mapping[str, Outcome]) -> bool:
    return any(facts(outcome).helical for outcome in outcomes.values())


def _letters(fact: Facts) -> str:
    ends = (
        "A and E are the ends of the path of contact, A at the tip of gear 2; C is the pitch point"
    )
    return f"{ends}; B and D lie one base pitch from E and A." if "B" in fact.points else f"{ends}."


def _cycle_words(outcomes: Mapping[str, Outcome]) -> str:
    """Driver angle and time of one base pitch."""
    seen: dict[str, list[str]] = {}
    for variant, outcome in outcomes.items():
        fact = timed(outcome)
        angle, time = show.number(degrees(fact.period_angle)), show.number(1e3 * fact.period)
        seen.setdefault(f"{angle}° of the driver, {time} ms", []).append(variant)
    if len(seen) < 2:
        return next(iter(seen), "")
    return "; ".join(f"{words} ({', '.join(names)})" for words, names in seen.items())


def _rows(outcomes: Mapping[str, Outcome]) -> dict[str, Any] | None:
    """Printed against computed, misses first; None without targets."""
    by_variant = {name: outcome.rows for name, outcome in outcomes.items() if outcome.rows}
    every = [(name, row) for name, rows in by_variant.items() for row in rows]
    if not every:
        return None
    ordered = sorted(every, key=lambda pair: _ORDER.get(pair[1].verdict, 0))
    table = [{**_row(row), "variant": name} for name, row in ordered]
    return {
        "table": table,
        "counts": [
            {"kind": kind, "verdicts": dict(verdicts), "variant": name}
            for name, rows in by_variant.items()
            for kind, verdicts in counts(rows).items()
        ],
        "missed": [row for row in table if row["verdict"] == "miss"],
        "excluded": [row for row in table if row["verdict"] == "excluded"],
        "variants": [*by_variant],
        "others": [name for name in outcomes if name not in by_variant],
    }


def _row(row: Row) -> dict[str, str]:
    unit = show.unit(row.unit)
    computed, deviation, tolerance = "not computed", "", ""
    if row.computed is not None and row.deviation is not None:
        digits = _decimals(row.tolerance)
        computed = f"{row.computed:.{digits}f} {unit}".strip()
        deviation = show.signed(row.deviation, digits)
        tolerance = "" if row.bound else f"± {row.tolerance:g}"
    return {
        "quantity": show.pretty(row.quantity),
        "where": row.where,
        "printed": f"{row.bound}{row.printed:g} {unit}".strip(),
        "computed": computed,
        "deviation": deviation,
        "tolerance": tolerance,
        "kind": row.kind,
        "verdict": row.verdict,
        "reason": row.reason or ("no reason is known" if row.verdict == "miss" else ""),
    }


def _decimals(tolerance: float) -> int:
    """Decimals that show a deviation to a tenth of the tolerance or finer."""
    return max(ceil(-log10(tolerance)), 0) + 1 if tolerance > 0.0 else 4


def _side_by_side(outcomes: Mapping[str, Outcome], known: Curves) -> dict[str, Any]:
    """Main figures of all variants and laws in one table, with the spread of the laws."""
    columns = [
        (variant, outcome, position, law)
        for variant, outcome in outcomes.items()
        if "operation" in outcome.parts
        for position, law in enumerate(laws(outcome.parts["operation"]))
    ]
    lines = [
        (
            show.axis_title(name),
            [_told(one.parts["operation"], name, k) for _, one, k, _ in columns],
        )
        for name in _SIDE_BY_SIDE
        if any(name in one.parts["operation"] for _, one, *_ in columns)
    ]
    spread = [(_spread(one) or {"text": "not computed"})["text"] for _, one, *_ in columns]
    back = [_back_driving(one, law) for _, one, _, law in columns]
    return {
        "curves": [known[variant, law] for variant, _, _, law in columns],
        "lines": [
            *lines,
            ("mean efficiency by the friction laws that apply", spread),
            ("back-driving", back),
        ],
    }


def _told(data: Any, name: str, law: int) -> str:
    """A figure at the operating point; one of a vibration only if there is a steady state."""
    if name not in data:
        return "not computed"
    if name in _STEADY and "vibration_status" in data and data["vibration_status"].values[law, 0]:
        return "none"
    return show.quantity(name, float(data[name].values[law, 0]), with_unit=False)


_STEADY = ("mean_transmission_error", "transmission_error_range", "largest_dynamic_factor")


def _models(outcomes: Mapping[str, Outcome]) -> list[dict[str, str]]:
    """Laws and models of all variants, each with the variants that use it."""
    found: dict[str, dict[str, str]] = {}
    for variant, outcome in outcomes.items():
        manifest = outcome.manifest
        named = [("friction", law) for law in manifest["laws"]]
        named += [(model["effect"], model) for model in manifest["models"]]
        for effect, model in named:
            entry = found.setdefault(
                f"{effect} {model['name']}",
                {"effect": effect, "name": model["name"], "title": model["title"]}
                | {"note": model["note"], "variants": ""},
            )
            entry["variants"] += ", " * bool(entry["variants"]) + variant
    return list(found.values())


def _parts(outcomes: Mapping[str, Outcome]) -> list[dict[str, str]]:
    """Files of the result with the fingerprint of what they were computed from."""
    return [
        {
            "file": f"{variant}/{name}.nc",
            "title": str(data.attrs.get("title", name)),
            "fingerprint": str(data.attrs.get("fingerprint", "")),
        }
        for variant, outcome in outcomes.items()
        for name, data in outcome.parts.items()
    ]


def _version(outcomes: Mapping[str, Outcome]) -> str:
    """Versions of the package that computed the parts; one, unless an old result was completed."""
    found = (data.attrs["version"] for one in outcomes.values() for data in one.parts.values())
    return ", ".join(dict.fromkeys(str(version) for version in found))


def _unique(sources: Iterable[dict[str, str]]) -> list[dict[str, str]]:
    return list({source["key"]: source for source in sources}.values())
