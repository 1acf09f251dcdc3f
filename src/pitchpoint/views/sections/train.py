"""How the bodies of a planetary set or another train move: picture, speeds, mesh frequencies, hunting."""

from collections.abc import Iterator, Mapping
from math import gcd, pi
from typing import Any

import xarray as xr

from pitchpoint.gears.cylindrical.design import RING_RIM_RATIO
from pitchpoint.results.variable import length
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.inputs import input_value
from pitchpoint.views.sections.planet_sharing import sharing_facts
from pitchpoint.views.train_picture import train_pictures

__all__ = ["train_blocks", "train_facts", "train_printed"]

Record = Mapping[str, Any]

BODIES = ["body", "speed [rpm]", "against the carrier [rpm]", "turns for one of the input"]
MESHES = [
    "mesh",
    "frequency [Hz]",
    "teeth",
    "common divisor",
    "same two teeth again after",
]

_NOTE = (
    "Speeds are positive as the input turns; mesh frequencies and turns until two teeth meet again are those "
    "against the carrier. Teeth whose "
    "numbers have no common divisor meet all teeth of their mate (hunting)."
)


def train_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    for variant, outcome in page.outcomes.items():
        for number, train in enumerate(outcome.manifest.get("trains", ())):
            titles = [
                variant if page.several else "",
                f"stage {train['stage']}" if train["stage"] else "",
            ]
            if any(titles):
                yield section.Heading(", ".join(filter(None, titles)))
            if "teeth" in outcome.parts:
                planes = train_pictures(outcome, train)
                values = {"planes": planes, "name": f"train{number}", "words": _words(train)}
                yield section.Drawn("train.html.jinja", {"t": values})
            yield section.SectionTable(BODIES, _bodies(train), compact=True, caption="Speeds")
            yield section.SectionTable(
                MESHES, _meshes(train), compact=True, caption="Meshes", wide=True
            )
            yield section.Paragraph(_NOTE, "note")


def train_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Load on a planet, diameter around the gears of the largest set, centre distance of its planets."""
    yield from sharing_facts(outcome)
    teeth = {label: mesh.parts["teeth"] for label, mesh in section.of_meshes(outcome, "teeth")}
    sets = [
        (*_around(outcome, train, teeth), train["stage"])
        for train in outcome.manifest.get("trains", ())
        if all("root_radius" in teeth.get(f"stage {mesh['label']}", ()) for mesh in train["meshes"])
    ]
    if not sets:
        return
    across, whence, apart, stage = max(sets)
    of_stage = f"stage {stage}; " if len(sets) > 1 else ""
    detail = f"{of_stage}{whence}; axes {_length(apart)} apart"
    yield section.KeyFigure(44.0, "Outer diameter", _length(across), detail)


def _around(
    outcome: Outcome, train: Record, teeth: Mapping[str, xr.Dataset]
) -> tuple[float, str, float]:
    """Diameter around the gears of a set [m], up to where it counts, centre distance of its planets [m]."""
    reached: list[tuple[float, str, float]] = []
    for mesh in train["meshes"]:
        of_mesh = teeth[f"stage {mesh['label']}"]
        for at, body in enumerate(mesh["bodies"]):
            apart = float(of_mesh["centre_distance"])
            root, tip = (float(of_mesh[f"{end}_radius"].values[at]) for end in ("root", "tip"))
            if float(of_mesh["teeth"].values[at]) < 0.0:
                bores = input_value(outcome, "stages", f"{mesh['label']}.gears.bore_diameter")
                outside = bores[at] if bores else 2.0 * RING_RIM_RATIO * root
                rim = f"{'' if bores else 'assumed '}rim {_length(0.5 * outside - root)}"
                reached.append((outside, rim, apart))
            elif body in train["planets"]:
                reached.append((2.0 * (apart + tip), "around the planets", apart))
    return max(reached)


def _length(metres: float) -> str:
    variable = length("", "")
    return f"{show.number_text(float(variable.displayed(metres)))} {show.display_unit(variable.display)}"


def train_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    for train in outcome.manifest.get("trains", ()):
        of_stage = f"Stage {train['stage']}: " if train["stage"] else ""
        yield section.Printed(line=f"{of_stage}{_words(train)}.")
        yield section.Printed(rows=[dict(zip(BODIES, row, strict=True)) for row in _bodies(train)])
        yield section.Printed(rows=[dict(zip(MESHES, row, strict=True)) for row in _meshes(train)])
    if outcome.manifest.get("trains"):
        yield section.Printed(line=_NOTE)


def _words(train: Record) -> str:
    """Ends and ratio of a set in words."""
    turned, loaded, *held = train["ends"]
    rate = train["rates"][loaded] / train["rates"][turned]
    sense = "the same way" if rate > 0.0 else "the other way"
    stands = f", {' and '.join(held)} held" if held else ""
    return (
        f"{turned} drives, {loaded} turns {sense}{stands}: ratio {show.number_text(1.0 / rate, 6)}"
    )


def _carrier(train: Record) -> float:
    """Rate of the carrier for one of the input; zero where there is none."""
    carriers = [mesh["carrier"] for mesh in train["meshes"] if mesh["carrier"] in train["rates"]]
    return float(train["rates"][carriers[0]]) if carriers else 0.0


def _bodies(train: Record) -> list[tuple[str, ...]]:
    minute, carrier = 30.0 * train["speed"] / pi, _carrier(train)
    sense = train["rates"][train["ends"][0]]
    return [
        (
            body,
            *(
                show.number_text(sense * body_rate * minute, 5)
                for body_rate in (rate, rate - carrier)
            ),
            show.number_text(sense * rate, 5),
        )
        for body, rate in train["rates"].items()
    ]


def _meshes(train: Record) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    for mesh in train["meshes"]:
        teeth_1, teeth_2 = (round(teeth) for teeth in mesh["teeth"])
        against = train["rates"][mesh["bodies"][0]] - train["rates"].get(mesh["carrier"], 0.0)
        divisor = gcd(teeth_1, teeth_2)
        turns = teeth_2 // divisor
        rows.append(
            (
                " and ".join(mesh["bodies"]),
                show.number_text(abs(against) * teeth_1 * train["speed"] / (2.0 * pi), 5),
                f"{teeth_1} and {teeth_2}",
                "none, hunting" if divisor == 1 else str(divisor),
                f"{turns} turn{'s' * (turns != 1)} of the {mesh['bodies'][0]}",
            )
        )
    return rows
