"""Wear of the flanks over the life of a drive; the march is imported when a case asks for it."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Unasked
from pitchpoint.analyses.main_figures import numbers
from pitchpoint.cases.built import Built
from pitchpoint.gears.mesh import has
from pitchpoint.gears.pairs import flanks_in_turn

__all__ = ["WEAR"]

_MAIN = (
    "final_cycles",
    "final_cycles_error",
    "final_depth",
    "life_hours",
    "run_in_cycles",
    "severe_cycles",
    "pressure_change",
    "wear_steps",
)
_EACH = ("deepest_wear", "fastest_wear", "worn_volume", "wear_error")
_OF_TEETH = ("worn_tip_land", "backlash_growth", "backlash_growth_error")


def _unasked(built: Built) -> str | None:
    """Why a case has no wear: nobody asks for it, or a member has no end."""
    if not has(built.design.mesh, flanks_in_turn):
        return (
            "these gears name no number of flanks among which wear goes round, as a rack has none"
        )
    return Unasked("the case has no [wear]") if built.case.wear is None else None


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("wear")
    if data is None:
        return {"wear": {}}
    of_teeth = [name for name in _OF_TEETH if name in data]
    at_end = {name: numbers(data[name].values[-1]) for name in (*_EACH, *of_teeth)}
    return {"wear": {name: numbers(data[name].values) for name in _MAIN} | at_end}


WEAR = Analysis(
    name="wear",
    title="wear",
    of="mesh",
    under_load=True,
    lacks=_unasked,
    compute="pitchpoint.analyses.wear_course:wear_part",
    joined="pitchpoint.analyses.wear_course:joined",
    onward="pitchpoint.analyses.wear_course:further",
    main=_MAIN,
    figures=_figures,
)
