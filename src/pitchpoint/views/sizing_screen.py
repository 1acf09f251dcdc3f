"""The first screen of a sizing: the task, how many designs do it, the best of the front, what is doubtful."""

from collections.abc import Iterator, Mapping, Sequence
from math import isnan
from pathlib import Path
from typing import Any

from pitchpoint import units
from pitchpoint.cases.loss_sets import loss_sets
from pitchpoint.core.doubts import GUESSED, in_percent
from pitchpoint.input.kinds import TEMPERATURE
from pitchpoint.registry import enumerated
from pitchpoint.sizing.sizing import SizedDrive, Sizing, families_by_reason
from pitchpoint.sizing.strain_wave import LOSSES_OF_STRAIN_WAVES
from pitchpoint.sizing.task_table import Task
from pitchpoint.views import show
from pitchpoint.views.columns import lines_of
from pitchpoint.views.first_screen import Line, wrapped

__all__ = [
    "BEST_WORDS",
    "counted_words",
    "doubts_of_sizing",
    "gear_words",
    "sizing_as_json",
    "sizing_screen",
    "task_words",
]

BEST_WORDS = {
    "mass": "least mass",
    "loss": "least loss",
    "diameter": "least diameter",
    "backlash": "least backlash",
    "balanced": "balanced",
}
"""What a design is the best by, in words."""

_LEFT_OUT = "Shafts, bearings, seals, churned oil, housing, carriers and pins are in no figure"
_OF_TEETH = (
    f"Losses are of teeth by ISO/TR 14179-2; laws differ by {in_percent(GUESSED)} or so, and films "
    "thinner than the roughness may more than double them."
)
_OF_STRAIN_WAVES = (
    "Strain wave gears: a maker's rating, no backlash, teeth not rated; loss with bearing and "
    "grease"
)


MOST_LINES = 20
"""Of a screen; the teeth, which page and case files have too, are left out where there would be more."""


def sizing_screen(sizing: Sizing, width: int, written: Path | None = None) -> list[Line]:
    """Lines of the screen.

    Args:
        sizing: its designs.
        width: of the screen [characters].
        written: folder with the case files of the front; None where none were written.
    """
    head = [Line(text, "title") for text in wrapped(task_words(sizing.task), width)]
    counted = [Line(text, "figure") for text in wrapped(counted_words(sizing), width)]
    table = [Line(text, "figure") for text in lines_of(_rows(sizing), _COLUMNS, width)]
    teeth = [Line(text, "figure") for text in wrapped(_teeth(sizing), width)]
    doubts = [
        Line(text, "doubt") for one in doubts_of_sizing(sizing) for text in wrapped(one, width)
    ]
    foot = [Line(text, "note") for one in _foot(sizing, written) for text in wrapped(one, width)]
    every = [*head, *counted, *table, *teeth, *doubts, *foot]
    return every if len(every) <= MOST_LINES else [line for line in every if line not in teeth]


def sizing_as_json(sizing: Sizing) -> dict[str, Any]:
    """Designs in SI with their cases, the front, the best by each aim, and families that have none."""
    figures = sizing.table
    names = [name for name in figures.data_vars if name not in ("family", "on_front")]
    designs = {
        name: {
            "family": design.family,
            "on_front": name in sizing.front,
            **{str(key): float(getattr(design, str(key))) for key in names},
            "case": design.tree,
        }
        for name, design in sizing.designs.items()
    }
    return {
        "best": sizing.best,
        "front": list(sizing.front),
        "designs": designs,
        "without": dict(sizing.without),
    }


def task_words(task: Task) -> str:
    """What is asked, in a line."""
    speed, life = units.convert(task.speed, "rpm", "rotational speed"), task.life / 3600.0
    within = f"ratio {task.ratio:.6g} within {100.0 * task.ratio_tolerance:.3g} %"
    return f"Drives for {task.torque:.6g} N m at {speed:.6g} rpm for {life:.6g} h, {within}"


def counted_words(sizing: Sizing) -> str:
    """How many designs of how many families do it."""
    families = len({design.family for design in sizing.designs.values()})
    return (
        f"{len(sizing.designs)} designs do it, {len(sizing.front)} of them beaten by none in "
        f"{enumerated(sizing.task.aims)}; of {families} famil{'y' if families == 1 else 'ies'}, "
        f"{sum(sizing.tried.values())} sizes rated."
    )


_COLUMNS = (
    "",
    "design",
    "ratio",
    "mass kg",
    "loss %",
    "⌀ mm",
    "backlash '",
    "N·m/'",
    "S_H",
    "S_F",
)


def gear_words(design: SizedDrive) -> dict[str, str]:
    """Teeth, modules [mm], face widths [mm] and planets of a design, its stages parted by semicolons.

    A second mesh of the same planets stands behind a plus.
    """
    stages = [stage["gears"] for stage in design.tree.get("stages", [design.tree])]
    rows = [[gears, *([gears["second"]] if "second" in gears else [])] for gears in stages]
    return {
        "teeth": "; ".join(
            " + ".join("/".join(map(str, row["teeth"])) for row in meshes) for meshes in rows
        ),
        "module": _of_stages(stages, "module"),
        "face_width": _of_stages(stages, "face_width"),
        "planets": _of_stages(stages, "planets"),
    }


def _of_stages(stages: Sequence[Mapping[str, Any]], key: str) -> str:
    """Values of a key by stage, lengths in mm; empty where none has it."""
    texts = [str(gears.get(key, "–")) for gears in stages]
    if {*texts} == {"–"}:
        return ""
    return "; ".join(text.removesuffix(" mm") for text in texts)


def _rows(sizing: Sizing) -> list[dict[str, str]]:
    return [_row(BEST_WORDS[aim], sizing.designs[name]) for aim, name in sizing.best.items()]


def _teeth(sizing: Sizing) -> str:
    """Teeth of the designs that are shown, each once."""
    names = dict.fromkeys(sizing.best.values())
    teeth = (f"{name} {gear_words(sizing.designs[name])['teeth']}" for name in names)
    return f"Teeth: {', '.join(teeth)}."


def _row(first: str, design: SizedDrive) -> dict[str, str]:
    minutes = units.convert(design.backlash, "arcmin", "angle")
    values = (
        first,
        design.name,
        f"{design.ratio:.4g}",
        f"{design.mass:.3g}",
        f"{100.0 * design.loss:.3g}",
        f"{1e3 * design.diameter:.4g}",
        f"{minutes:.3g}",
        f"{units.convert(design.stiffness, 'N m/arcmin', 'torsional stiffness'):.3g}",
        *("-" if isnan(one) else f"{one:.3g}" for one in (design.flank_safety, design.root_safety)),
    )
    return dict(zip(_COLUMNS, values, strict=True))


def doubts_of_sizing(sizing: Sizing) -> Iterator[str]:
    """What the figures do not hold, and what is doubtful of them."""
    families = {design.family for design in sizing.designs.values()}
    task = sizing.task
    on_factors = f"K_A is {task.application_factor:.6g} and K_Hβ {task.face_load_factor:.6g}."
    of_teeth = f"{_OF_TEETH} " if families - {"strain wave"} else ""
    yield f"{of_teeth}{_LEFT_OUT}; {on_factors}"
    if families & {"strain wave", "planetary and strain wave"}:
        low, high = loss_sets()[LOSSES_OF_STRAIN_WAVES].fitted
        beyond = (
            f", fitted from {TEMPERATURE.show(low)} to {TEMPERATURE.show(high)}: "
            f"extrapolated to {TEMPERATURE.show(task.temperature)}"
        )
        yield show.pretty(f"{_OF_STRAIN_WAVES}{'' if low <= task.temperature <= high else beyond}.")


def _foot(sizing: Sizing, written: Path | None) -> Iterator[str]:
    without = [
        f"{families} ({words})" for words, families in families_by_reason(sizing.without).items()
    ]
    if without:
        yield f"Without a design: {'; '.join(without)}."
    balanced = sizing.best["balanced"]
    if written is None:
        yield f"-o FOLDER writes the {len(sizing.front)} as case files; --json has all designs."
    else:
        yield (
            f"Cases: {written}, {len(sizing.front)} files and report.html; pitchpoint run "
            f"{written / balanced}.toml"
        )
