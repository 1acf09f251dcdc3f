"""Energy, torques, lives and heat over the duty cycle of a case, of its loss map of the output."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import array, double_precision
from pitchpoint.analyses.bearing_life import rated_bearings
from pitchpoint.analyses.four_quadrants import (
    both_signs,
    output_speed_ratio,
    quadrant_axes,
    table_of,
)
from pitchpoint.analyses.strength import rating_inputs
from pitchpoint.analyses.tooth_life import load_classes, tooth_life
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.built_duty import DutyInputs, duty_inputs
from pitchpoint.core.doubts import doubts_of, fails, stored
from pitchpoint.duty_cycle.duty_dataset import Heating, duty_dataset
from pitchpoint.duty_cycle.energy import demand_inside, mean_load
from pitchpoint.duty_cycle.history import LoadHistory
from pitchpoint.duty_cycle.life import BALL, RatedBearing
from pitchpoint.duty_cycle.recorded_lives import recorded_lives
from pitchpoint.duty_cycle.thermal_network import RunawayError
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest
from pitchpoint.units import degrees_celsius

__all__ = ["demand_in_map", "duty_of_map", "rated_lives"]


def duty_of_map(built: Ready, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The duty cycle of a case under the friction law that it names, or all of them.

    Args:
        built: the case.
        parts: the loss map of the output, and those that have lives, see `recorded_lives`.
    """
    data, *others = parts
    duty = _asked(built)
    rated = bool(load_classes(duty.history).way.size) and bool(rating_inputs(built))
    speed = float(built.operation.speed) * built.output_rate
    compute = partial(
        duty_dataset,
        table_of(data),
        duty.history,
        law=duty.law,
        motor=duty.motor,
        lives={**rated_lives(built, duty.history), **duty.lives},
        recorded=recorded_lives(others, float(built.operation.load), abs(speed)),
        teeth=partial(tooth_life, built) if rated else None,
        travels="loaded" in built.travels,
    )
    try:
        return _told_first(compute, duty.heating)
    except InputError as error:
        raise _of_duty(error) from None


def _told_first(compute: Callable[..., xr.Dataset], heating: Heating | None) -> xr.Dataset:
    """The cycle as heat lets it be, with what is too hot before all else."""
    try:
        cycle = compute(heating=heating)
    except RunawayError as error:
        sentence = f"{error}; the duty cycle is that at the temperatures of its file."
        brief = f"The duty cycle heats {error.body} without end."
        return compute(runaway=error.body, warnings=[fails(sentence, brief)])
    limits = {} if heating is None else heating.limits
    return cycle.assign_attrs(stored([*_too_hot(cycle, limits), *doubts_of(cycle.attrs)]))


def _too_hot(data: xr.Dataset, limits: Mapping[str, float]) -> Iterator[str]:
    """Sentences on bodies that get hotter than they bear."""
    for body, most in limits.items():
        hottest = float(data["body_temperature"].sel(body=body).max())
        if hottest > most:
            reached, bears = (
                f"{float(degrees_celsius(np.asarray(temperature))):.4g}"
                for temperature in (hottest, most)
            )
            yield fails(
                f"{body} gets {reached} degC hot in the duty cycle, and bears {bears} degC.",
                f"{body} gets {reached} degC hot, and bears {bears} degC.",
            )


@double_precision()
def rated_lives(built: Ready, history: LoadHistory) -> dict[str, RatedBearing]:
    """Bearings with a dynamic load rating under the first friction law; a table of lives overrides them.

    Args:
        built: the case.
        history: of the output, whose mean load the loads on bearings are computed at; nothing where it bears
            nothing, or friction locks the drive.
    """
    load = mean_load(history, BALL)
    if not built.rates_bearings or not load > 0.0:
        return {}
    kind: Any = built
    point = replace(built.operation, load=array(load))
    figures = kind.figures_of([(built.design, point)], built.models[0])
    if bool(figures["locked"][0]):
        return {}
    (of_bearings,) = rated_bearings(built, figures["bearing_load"][:1], load)
    return of_bearings


def demand_in_map(built: Ready) -> None:
    """InputError for a duty cycle that the loss map of a case will not hold, before that is computed.

    Args:
        built: the case.
    """
    duty, (loads, speeds, degrees) = _asked(built), quadrant_axes(built)
    if duty.law and duty.law not in built.law_names:
        sentence = (
            f"{shown(duty.law)} is no friction law of this case{nearest(duty.law, built.law_names)}"
        )
        raise InputError(sentence, key="duty.law")
    empty = LossTable(
        torques=both_signs(loads).tolist(),
        speeds=(speeds * output_speed_ratio(built)).tolist(),
        temperatures=degrees_celsius(degrees).tolist(),
        loss_torques={},
        speed_ratio=output_speed_ratio(built),
    )
    if "loaded" in built.travels:
        empty = empty._replace(units=("N", "m/s", "N m"))
    try:  # temperatures that follow from the losses are not known yet
        demand_inside(empty, duty.history, warm=duty.heating is None)
    except InputError as error:
        raise _of_duty(error) from None


def _of_duty(error: InputError) -> InputError:
    """The same with the key of the case: that of the motor, or the file whose load cannot be."""
    of_motor = str(error.key).startswith("motor.")
    return InputError(error.message, key=f"duty.{error.key}" if of_motor else "duty.file")


def _asked(built: Ready) -> DutyInputs:
    table = built.case.duty
    if table is None:
        raise InputError("the case has no [duty]")
    return duty_inputs(table, float(built.operation.temperature), travels="loaded" in built.travels)
