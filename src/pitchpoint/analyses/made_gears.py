"""Figures of designs whose gears are drawn as they are made: kinematic error, backlash at the output."""

from collections.abc import Collection, Iterator, Sequence
from typing import Any

import numpy as np

from pitchpoint.analyses.analysis import silent
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.gears.cylindrical.table import CylindricalGears

__all__ = ["made_figures", "unfollowed"]

_DEVIATIONS = "gears.deviations."
_MISALIGNMENT = "gears.misalignment"


def made_figures(points: Sequence[Ready], laws: int, keys: Collection[str]) -> dict[str, Any]:
    """Figures [law, point] beside those of the cycle, the same under every friction law.

    The kinematic error takes longer than all else, so that it is only there where deviations change.

    Args:
        points: designs of one case.
        laws: of friction.
        keys: of the case that the designs change.
    """
    figures = {}
    if any(_DEVIATIONS in key for key in keys) and not points[0].trains:
        figures["kinematic_error_range"] = [_error_range(point) for point in points]
    if points[0].numbers and all(map(_cylindrical, points[0].meshes)):
        figures["output_backlash"] = [_output_backlash(point) for point in points]
    return {name: (("law", "point"), np.array([values] * laws)) for name, values in figures.items()}


def unfollowed(built: Ready, keys: Collection[str]) -> list[str]:
    """Sentences on figures that do not follow what the designs of a study change.

    Args:
        built: the case.
        keys: of it that the designs change.
    """
    tables = [""] if not built.numbers else [f"stages.{number}." for number in built.numbers]
    sentences = []
    for table, stage in zip(tables, built.stages if built.numbers else (built,), strict=True):
        mesh, key = stage.meshes[0], f"{table}{_MISALIGNMENT}"
        if key not in keys or not mesh.case.gears.rated or mesh.rated.table.shaft is not None:
            continue
        stated = mesh.rated.table.face_load_factor is not None
        sentences.append(
            f"Stresses and safeties do not follow {key}: K_Hβ is {'as given' if stated else '1'}. With "
            f"bearing_span, pinion_offset and pinion_shaft_diameter in [{table}strength]"
            f"{' in its place' if stated else ''} it follows by method C."
        )
    return sentences


def _cylindrical(mesh: Built) -> bool:
    return isinstance(mesh.case.gears, CylindricalGears)


def _error_range(point: Ready) -> float:
    """Kinematic error at the output, peak to peak under load: ends of all meshes meet [rad]."""
    return float(np.dot(point.steps, [*_ranges(point)]))


def _ranges(point: Ready) -> Iterator[float]:
    from pitchpoint.analyses.kinematic_error import (  # few studies ask for it
        CURVES,
        deviation_error,
    )

    for mesh in point.meshes:
        if any(mesh.deviations):
            of_curves = deviation_error(mesh, silent)["kinematic_error_range"].sel(cause="both")
            yield float(of_curves.values[CURVES.index("under load")])
        else:
            yield 0.0


def _output_backlash(point: Ready) -> float:
    """Turn of the output in the backlash of all meshes, see `analyses.reflected` [rad]."""
    plays = []
    for mesh in point.meshes:
        gears: Any = mesh.case.gears
        teeth = np.array(gears.teeth)
        distance, backlash = (
            float(mesh.dimensions[name]) for name in ("centre_distance", "circumferential_backlash")
        )
        loaded = int(mesh.nominal["loaded"].argmax())
        plays.append(backlash / (distance * abs(teeth[loaded] / teeth.sum())))
    return float(np.dot(point.steps, plays))
