"""The first screen of a sizing: the task, how many designs do it, the best of the front, what is doubtful."""

from collections.abc import Iterator
from math import isnan
from pathlib import Path
from typing import Any

from pitchpoint import units
from pitchpoint.doubts import GUESSED, in_percent
from pitchpoint.registry import enumerated
from pitchpoint.sizing.sizing import SizedDrive, Sizing, families_by_reason
from pitchpoint.sizing.table import Task
from pitchpoint.views.columns import lines_of
from pitchpoint.views.first_screen import Line, wrapped

__all__ = ["sizing_as_json", "sizing_screen"]

_WORDS = {
    "mass": "least mass",
    "loss": "least loss",
    "diameter": "least diameter",
    "backlash": "least backlash",
    "balanced": "balanced",
}

_LEFT_OUT = "Shafts, bearings, seals, churned oil, housings, carriers and pins are in no figure"
_OF_TEETH = (
    f"Losses are those of teeth by ISO/TR 14179-2; laws differ by {in_percent(GUESSED)} or so, and films "
    "thinner than the roughness may more than double them."
)
_OF_STRAIN_WAVES = (
    "Strain wave gears go by a maker's rating, with bearing and grease in their loss; they count as free of "
    "backlash, and their teeth are not rated."
)


def sizing_screen(sizing: Sizing, width: int, written: Path | None = None) -> list[Line]:
    """Lines of the screen.

    Args:
        sizing: its designs.
        width: of the screen [characters].
        written: folder with the case files of the front; None where none were written.
    """
    head = [Line(text, "title") for text in wrapped(_task(sizing.task), width)]
    counted = [Line(text, "figure") for text in wrapped(_counted(sizing), width)]
    table = [Line(text, "figure") for text in lines_of(_rows(sizing), _COLUMNS, width)]
    doubts = [Line(text, "doubt") for one in _doubts(sizing) for text in wrapped(one, width)]
    foot = [Line(text, "note") for one in _foot(sizing, written) for text in wrapped(one, width)]
    return [*head, *counted, *table, *doubts, *foot]


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


def _task(task: Task) -> str:
    speed, life = units.convert(task.speed, "rpm", "rotational speed"), task.life / 3600.0
    within = f"ratio {task.ratio:.6g} within {100.0 * task.ratio_tolerance:.3g} %"
    return f"Drives for {task.torque:.6g} N m at {speed:.6g} rpm for {life:.6g} h, {within}"


def _counted(sizing: Sizing) -> str:
    families = {design.family for design in sizing.designs.values()}
    told = enumerated(name for name in sizing.task.families if name in families)
    return (
        f"{len(sizing.designs)} designs do it, {len(sizing.front)} of them beaten by none in "
        f"{enumerated(sizing.task.aims)}; of {sum(sizing.tried.values())} sizes rated. Families: {told}."
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


def _rows(sizing: Sizing) -> list[dict[str, str]]:
    return [_row(_WORDS[aim], sizing.designs[name]) for aim, name in sizing.best.items()]


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


def _doubts(sizing: Sizing) -> Iterator[str]:
    families = {design.family for design in sizing.designs.values()}
    task = sizing.task
    on_factors = f"K_A is {task.application_factor:.6g} and K_Hβ {task.face_load_factor:.6g}."
    of_teeth = f"{_OF_TEETH} " if families - {"strain wave"} else ""
    yield f"{of_teeth}{_LEFT_OUT}; {on_factors}"
    if families & {"strain wave", "planetary and strain wave"}:
        yield _OF_STRAIN_WAVES


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
        yield f"Cases: {written}, {len(sizing.front)} files; pitchpoint run {written / balanced}.toml"
