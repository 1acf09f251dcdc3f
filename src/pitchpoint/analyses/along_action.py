"""Mesh stiffness, vibration and motion, along the line of action; imported in full when asked for."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Unasked
from pitchpoint.analyses.lacking import rigid
from pitchpoint.analyses.main_figures import (
    OF_CROSSING,
    OF_MOTION,
    OF_START,
    VIBRATION,
    by_torque,
    numbers,
)
from pitchpoint.cases.built import Built
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import has

__all__ = ["MOTION", "MOTIONS", "RESONANCE", "START_UP", "STIFFNESS", "VIBRATIONS"]


def _no_line(built: Built) -> str | None:
    if has(built.design.mesh, line_of_action):
        return None
    return "these gears have no line of action, along which stiffness and vibration are computed"


def _no_stiffness(built: Built) -> str | None:
    return _no_line(built) or rigid(built)


def _still(built: Built) -> str | None:
    return _no_line(built) or (
        Unasked("the case has no [dynamics]") if built.case.dynamics is None else None
    )


def _one_speed(built: Built) -> str | None:
    dynamics = built.case.dynamics
    alone = dynamics is not None and dynamics.speeds is None
    return _still(built) or (Unasked("[dynamics] gives no speeds") if alone else None)


def _unmoved(built: Built) -> str | None:
    dynamics = built.case.dynamics
    alone = dynamics is not None and dynamics.motion is None
    return _still(built) or (Unasked("the case has no [dynamics.motion]") if alone else None)


def _one_motion(built: Built) -> str | None:
    return _unmoved(built) or _one_speed(built)


def _no_start(built: Built) -> str | None:
    reason = _unmoved(built)
    if reason is not None:
        return reason
    dynamics = built.case.dynamics
    assert dynamics is not None
    assert dynamics.motion is not None
    return (
        Unasked("[dynamics.motion] has no start_up") if dynamics.motion.start_up is None else None
    )


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    return {"vibration": by_torque(parts.get("vibration"), VIBRATION)}


def _motion_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("motion")
    if data is None:
        return {"motion": {}}
    return {
        "motion": {name: numbers(data[name].values) for name in OF_MOTION}
        | {"status": str(data.attrs["sentence"])}
    }


def _critical_speeds(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("motion_against_speed")
    if data is None:
        return {"critical_speeds": []}
    columns = {name: data[name].values.tolist() for name in OF_CROSSING}
    modes = data["mode"].values[data["critical_mode"].values.astype(int)]
    rows = zip(*columns.values(), strict=True)
    return {
        "critical_speeds": [
            dict(zip(columns, row, strict=True)) | {"mode": str(mode)}
            for row, mode in zip(rows, modes, strict=True)
        ]
    }


def _start_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("start_up")
    if data is None:
        return {"start_up": {}}
    ends = {"time": float(data["time"][-1]), "status": str(data.attrs["sentence"])}
    return {"start_up": {name: numbers(data[name].values) for name in OF_START} | ends}


TOGETHER = "the meshes of a set vibrate together, which is not computed"
"""Why a train has no vibration."""

STIFFNESS = Analysis(
    name="stiffness",
    title="mesh stiffness",
    of="mesh",
    under_load=True,
    lacks=_no_stiffness,
    compute="pitchpoint.analyses.vibration:stiffness_part",
)
VIBRATIONS = Analysis(
    name="vibration",
    title="vibration",
    of="mesh",
    under_load=True,
    of_no_train=TOGETHER,
    lacks=_still,
    compute="pitchpoint.analyses.vibration:vibration_part",
    main=VIBRATION,
    figures=_figures,
)
RESONANCE = Analysis(
    name="resonance",
    title="vibration against speed",
    of="mesh",
    under_load=True,
    of_no_train=TOGETHER,
    lacks=_one_speed,
    compute="pitchpoint.analyses.vibration:resonance_part",
)
MOTION = Analysis(
    name="motion",
    title="motion with friction",
    of="mesh",
    under_load=True,
    of_no_train=TOGETHER,
    lacks=_unmoved,
    compute="pitchpoint.analyses.motion:motion_part",
    main=OF_MOTION,
    figures=_motion_figures,
)
MOTIONS = Analysis(
    name="motion_against_speed",
    title="motion with friction against speed",
    of="mesh",
    under_load=True,
    of_no_train=TOGETHER,
    lacks=_one_motion,
    compute="pitchpoint.analyses.motion:against_speed_part",
    onward="pitchpoint.analyses.motion:next_speeds",
    joined="pitchpoint.analyses.motion:joined",
    main=OF_CROSSING,
    figures=_critical_speeds,
)
START_UP = Analysis(
    name="start_up",
    title="start",
    of="mesh",
    under_load=True,
    of_no_train=TOGETHER,
    lacks=_no_start,
    compute="pitchpoint.analyses.motion:start_up_part",
    main=OF_START,
    figures=_start_figures,
)
