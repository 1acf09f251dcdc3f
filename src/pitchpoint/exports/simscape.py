"""A drive for Simscape and Simulink: matrices in a MAT file, and a script that looks them up."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import NearestNDInterpolator

from pitchpoint.errors import visible
from pitchpoint.exports.evaluator import comment_text
from pitchpoint.exports.simulators import HandedOver, Simulated, heading, nothing_lost
from pitchpoint.results.store import write_bytes, write_text

__all__ = ["filled_from_nearest", "write_simscape"]

BESIDE = (
    "A lookup of loss_torque over torque, log_speed and temperature, linear, is the loss map itself. Gear "
    "blocks take the efficiency alone, which says nothing of a drive without load or at rest. Where friction "
    "locks the drive the matrices have the nearest values, and locked is 1. Ripple and kinematic error are "
    "not in it."
)

_SCRIPT = """joint = load(fullfile(fileparts(mfilename('fullpath')), 'joint.mat'));
axes_of_map = {joint.torque, joint.log_speed, joint.temperature};
axes_of_map(cellfun(@numel, axes_of_map) < 2) = [];
table = griddedInterpolant(axes_of_map, squeeze(joint.loss_torque), 'linear', 'nearest');
% Torque of the driver at a torque and speed of the output, with their signs, in motion:
%   along = sign(w) * T;
%   lost = table(along, log(max(abs(w), joint.speed(1))), degC);
%   driver = sign(w) * (along + lost) * joint.speed_ratio;
"""


def write_simscape(given: Simulated, folder: Path) -> HandedOver:
    """Write the map as a MAT file of version 5, and a script for MATLAB that makes a lookup of it.

    Args:
        given: the joint.
        folder: of the files.
    """
    from scipy.io import savemat

    lost = nothing_lost(BESIDE)
    image = io.BytesIO()
    savemat(image, _content(given), long_field_names=True, do_compression=True, oned_as="column")
    write_bytes(folder / "joint.mat", image.getvalue())
    what = "Loss map of a drive in joint.mat, as a lookup for MATLAB; this script was not run by its makers."
    head = "\n".join(
        f"% {line}"
        for paragraph in (*heading(given, what), *lost)
        for line in paragraph.splitlines()
    )
    write_text(folder / "load_joint.m", f"{head}\n{_SCRIPT}")
    return HandedOver([folder / "joint.mat", folder / "load_joint.m"], lost)


def filled_from_nearest(values: np.ndarray) -> np.ndarray:
    """Values with those that are not known taken from the nearest place, by number of nodes.

    Example:
        >>> import numpy as np
        >>> filled_from_nearest(np.array([[1.0, np.nan], [3.0, 4.0]])).tolist()
        [[1.0, 1.0], [3.0, 4.0]]
    """
    finite = np.isfinite(values)
    if finite.all() or not finite.any():
        return values
    near = NearestNDInterpolator(np.argwhere(finite), values[finite])
    complete: np.ndarray = np.where(
        finite,
        values,
        near(np.indices(values.shape).reshape(values.ndim, -1).T).reshape(values.shape),
    )
    return complete


def _content(given: Simulated) -> dict[str, Any]:
    joint, table = given.joint, given.joint.table
    axes = (np.asarray(axis) for axis in (table.torques, table.speeds[1:], table.temperatures))
    torque, speed, degree = np.meshgrid(*axes, indexing="ij")
    point = table.at_many(torque, speed, degree, joint.law)
    holding = [
        [table.at_rest(t, d, joint.law)[:2] for d in table.temperatures] for t in table.torques
    ]
    return {
        "torque": np.array(table.torques),
        "speed": np.array(table.speeds[1:]),
        "log_speed": np.log(table.speeds[1:]),
        "temperature": np.array(table.temperatures),
        "loss_torque": filled_from_nearest(np.asarray(point.loss) / speed),
        "loss_power": filled_from_nearest(np.asarray(point.loss)),
        "efficiency": filled_from_nearest(np.asarray(point.efficiency)),
        "locked": np.asarray(point.locked).astype(float),
        "lowest_holding_torque": np.array(holding)[..., 0],
        "highest_holding_torque": np.array(holding)[..., 1],
        "ratio": joint.ratio,
        "speed_ratio": table.speed_ratio,
        "armature": joint.armature,
        "stiffness": np.nan if joint.wind_up is None else joint.wind_up.at_load,
        "limits": {"torque": joint.torque_limit, **joint.limits},
        "units": {name: comment_text(unit) for name, unit in joint.units.items()},
        "title": visible(joint.title),
        "law": joint.law,
        "version": joint.version,
        "digest": joint.digest,
    }
