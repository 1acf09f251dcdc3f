"""Mesh stiffness and vibration, along the line of action; imported in full when asked for."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, Progress, Unasked
from pitchpoint.analyses.figures import VIBRATION, by_torque
from pitchpoint.analyses.torsion import rigid
from pitchpoint.cases.build import Built

__all__ = ["RESONANCE", "STIFFNESS", "VIBRATIONS"]


def _stiffness(built: Built, _: Piece, __: Progress) -> xr.Dataset:
    from pitchpoint.analyses.vibration import stiffness_part

    return stiffness_part(built)


def _vibration(built: Built, _: Piece, __: Progress) -> xr.Dataset:
    from pitchpoint.analyses.vibration import vibration_part

    return vibration_part(built)


def _resonance(built: Built, _: Piece, __: Progress) -> xr.Dataset:
    from pitchpoint.analyses.vibration import resonance_part

    return resonance_part(built)


def _no_line(built: Built) -> str | None:
    if built.design.mesh.along_action:
        return None
    return "these gears have no line of action, along which stiffness and vibration are computed"


def _no_stiffness(built: Built) -> str | None:
    return _no_line(built) or rigid(built)


def _still(built: Built) -> str | None:
    return _no_line(built) or (
        Unasked("the case has no [dynamics]") if built.case.dynamics is None else None
    )


def _one_speed(built: Built) -> str | None:
    asked = built.case.dynamics
    alone = asked is not None and asked.speeds is None
    return _still(built) or (Unasked("[dynamics] gives no speeds") if alone else None)


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    return {"vibration": by_torque(parts.get("vibration"), VIBRATION)}


STIFFNESS = Analysis(
    name="stiffness", title="mesh stiffness", lacks=_no_stiffness, compute=_stiffness
)
VIBRATIONS = Analysis(
    name="vibration",
    title="vibration",
    lacks=_still,
    compute=_vibration,
    main=VIBRATION,
    figures=_figures,
)
RESONANCE = Analysis(
    name="resonance", title="vibration against speed", lacks=_one_speed, compute=_resonance
)
