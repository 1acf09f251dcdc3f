"""The duty cycle of a result, by the loss map that it holds."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr
from numpy.typing import ArrayLike

from pitchpoint._jax import double_precision
from pitchpoint.analyses.duty import rated_lives
from pitchpoint.analyses.tooth_life import tooth_life
from pitchpoint.duty_cycle.duty_dataset import Heating, duty_dataset
from pitchpoint.duty_cycle.energy import demand_inside
from pitchpoint.duty_cycle.history import (
    LoadHistory,
    history_of_table,
    load_history,
    read_history,
)
from pitchpoint.duty_cycle.life import RatedLife
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.duty_cycle.recorded_lives import recorded_lives
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError
from pitchpoint.notebook.result import Result
from pitchpoint.runs.joint_model import joint_model, map_of_output

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["duty"]


def duty(
    result: Result,
    time: "ArrayLike | Mapping[str, ArrayLike] | pd.DataFrame | str | Path",
    torque: ArrayLike | None = None,
    speed: ArrayLike | None = None,
    temperature: ArrayLike | None = None,
    *,
    variant: str | None = None,
    law: str = "",
    motor: Motor | None = None,
    lives: Mapping[str, RatedLife] | None = None,
    heating: Heating | None = None,
    teeth: bool = False,
) -> xr.Dataset:
    """What a drive takes, loses and bears over a duty cycle of its output, by its loss map.

    Args:
        result: of a case with `loss_map.quadrants = 4`.
        time: of the samples [s]; or a table or a file of comma separated values with all columns, whose heads
            have units: time or duration, torque, speed, and temperature where it changes.
        torque: of the output on its load, positive along positive speeds, shape (n,) or () [N m or N].
        speed: of the output, shape (n,) or () [rad/s or m/s].
        temperature: of the oil, that of the case by default, shape (n,) or () [K].
        variant: of the result, the first one by default.
        law: of friction; the first one of the map by default, with energies under all of them beside it.
        motor: by value; none by default.
        lives: of bearings and wave generators by name, as catalogues rate them, beside those of the result
            and those of bearings that have a `dynamic_load_rating` in [losses].
        heating: thermal resistances, from which the temperatures follow.
        teeth: with damage and life of the teeth by ISO 6336, see `tooth_life`.

    Returns:
        A dataset, see `duty_dataset`.

    Raises:
        InputError: the result has no map in four quadrants, the load is no history or lies beyond the map.
        ConvergenceError: the drive has no periodic temperature.

    Example:
        >>> import pitchpoint as pp
        >>> result = pp.run("drive.toml", settings={"loss_map.quadrants": 4})  # doctest: +SKIP
        >>> pp.duty(result, [0.0, 1.0, 3.0], [20.0, 60.0, -10.0], 2.0).lost_energy  # doctest: +SKIP
    """
    outcome = result.outcome(variant)
    data = map_of_output(outcome)
    joint = joint_model(outcome, law=law or None)
    travels = data["output_torque"].attrs["units"] == "N"
    usual = float(data.attrs["degree"]) if temperature is None else temperature
    if torque is None and speed is None:
        history = _of_columns(time, usual, travels)
    elif torque is None or speed is None:
        raise InputError(f"{'torque' if torque is None else 'speed'} of the output is missing")
    else:
        history = load_history(time, torque, speed, usual)  # type: ignore[arg-type]
    if heating is None and isinstance(time, str | Path):
        _demand_inside(joint.table, history, time)
    rated = "bearing_life" in outcome.parts.get("operation", ())
    (held,) = result.case(variant).held if teeth or rated else (None,)
    with double_precision():
        built = None if held is None else held.built({})
    return duty_dataset(
        joint.table,
        history,
        law=law,
        motor=motor,
        lives={**(rated_lives(built, history) if rated and built else {}), **(lives or {})},
        heating=heating,
        recorded=recorded_lives(outcome.parts.values(), joint.load, joint.speed),
        teeth=partial(tooth_life, built) if teeth and built else None,
        travels=travels,
        case=str(outcome.manifest["case"]),
        variant=str(outcome.manifest["variant"]),
        fingerprint=str(data.attrs["fingerprint"]),
    )


def _demand_inside(table: LossTable, history: LoadHistory, file: str | Path) -> None:
    """InputError with the name of a file whose loads lie beyond the map."""
    try:
        demand_inside(table, history)
    except InputError as error:
        raise error.at(file=str(file)) from None


def _of_columns(columns: Any, temperature: Any, travels: bool) -> LoadHistory:
    if isinstance(columns, str | Path):
        return read_history(Path(columns), temperature, travels=travels)
    if hasattr(columns, "keys"):
        return history_of_table(columns, temperature, travels=travels)
    raise InputError("torque and speed of the output are missing; or give a table with all columns")
