"""Life of the rolling bearings of a drive by their dynamic load ratings: ISO 281."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf, nan, sqrt
from typing import Any

import numpy as np
from jaxtyping import Float

from pitchpoint._jax import array
from pitchpoint.analyses.strength import mesh_load_of
from pitchpoint.analyses.train_period import over_period
from pitchpoint.cases.built_drive import Ready
from pitchpoint.duty_cycle.history import load_steps
from pitchpoint.duty_cycle.life import BALL, RatedBearing
from pitchpoint.efficiency.drag_tables import Loss

__all__ = ["bearing_limits", "bearing_lives", "rated_bearings"]

Vector = tuple[float, float, float]


def bearing_lives(
    built: Ready, loads: Float[np.ndarray, "law place"]
) -> tuple[Float[np.ndarray, "law place"], Float[np.ndarray, "law place"]]:
    """Lives of bearings at the operating point [s], and the loads that give them [N].

    Args:
        built: the drive.
        loads: on the bearing of each place at the operating point, by friction law [N].

    Returns:
        NaN of places without a rating; lives are infinite where a bearing bears nothing.
    """
    speed = float(built.operation.speed) * built.output_rate
    load = built.case.operation.load
    there = load_steps(1.0, load, speed, float(built.operation.temperature))
    rated = rated_bearings(built, loads, load)

    def of_places(value: Callable[[RatedBearing], float]) -> Float[np.ndarray, "law place"]:
        names = built.places
        return np.array([[value(row[n]) if n in row else nan for n in names] for row in rated])

    return of_places(lambda bearing: bearing.life(there)), of_places(
        lambda bearing: float(bearing.load(load, speed))
    )


def bearing_limits(
    built: Ready, loads: Float[np.ndarray, "law place"]
) -> dict[str, Float[np.ndarray, "law place"]]:
    """Static safety of bearings, and torques of the output that they bear over that of operation [1].

    Args:
        built: the drive, under a load.
        loads: on the bearing of each place at the operating point, by friction law [N].

    Returns:
        By name `static_bearing_safety` C_0/P_0, `static_torque_margin` up to a safety of 1, where a bearing
        has a static load rating, and `life_torque_margin` up to the life of [strength], where it asks for
        one; NaN of places that have none, infinite where a bearing bears nothing.

    Source: ISO 76:2006, S_0 = C_0/P_0 with X_0 = Y_0 = 1; ISO 281:2007.
    """
    torque = float(built.case.operation.load)
    speed = float(built.operation.speed) * built.output_rate
    each = rated_bearings(built, loads if torque > 0.0 else loads[:0], torque)
    found = {
        name: np.array([[of(row[n]) if n in row else nan for n in built.places] for row in each])
        for name, of in _limiting(built, torque, speed).items()
    }
    return {name: values for name, values in found.items() if not np.isnan(values).all()}


def _limiting(
    built: Ready, torque: float, speed: float
) -> dict[str, Callable[[RatedBearing], float]]:
    """By name what limits a bearing, see `bearing_limits`; a life where the case asks for one."""

    def margin(bearing: RatedBearing, load: float) -> float:
        return bearing.torque_under(load, speed) / torque

    figures: dict[str, Callable[[RatedBearing], float]] = {
        "static_bearing_safety": lambda one: float(one.static_rating / one.load(torque, speed)),
        "static_torque_margin": lambda one: margin(one, one.static_rating),
    }
    table = built.case.strength
    life = None if table is None else table.life
    if life is not None:
        figures["life_torque_margin"] = lambda one: margin(one, one.load_for(life, speed))
    return figures


def rated_bearings(
    built: Ready, loads: Float[np.ndarray, "law place"], load: float
) -> list[dict[str, RatedBearing]]:
    """Bearings that have a dynamic load rating, by the name of their place, under each friction law.

    Args:
        built: the drive.
        loads: on the bearing of each place at the speed of the operating point [N], in the order of
            `built.places`, by friction law.
        load: torque or force of the output under which these are [N m or N].

    The load of the teeth is taken to grow with that of the output, and so are losses: take them under a load
    like those that a life is asked for.
    """
    output = float(built.operation.speed) * built.output_rate
    levels = built.with_losses if output > 0.0 else ()
    on_planets = [_on_planet(level, load * output) for level in levels if len(loads)]
    return [_under_law(built, levels, on_planets, row, load) for row in loads]


def _under_law(
    built: Ready,
    levels: Sequence[Any],
    on_planets: Sequence[np.ndarray],
    loads: Float[np.ndarray, " place"],
    load: float,
) -> dict[str, RatedBearing]:
    """Bearings under one friction law; see `_on_planet` for the force on a planet of each level."""
    places = iter(zip(built.places, _beyond_rounding(loads), strict=True))
    output = float(built.operation.speed) * built.output_rate
    rated: dict[str, RatedBearing] = {}
    for level, on_planet in zip(levels, on_planets, strict=True):
        rates = dict(zip(level.case.bodies, level.motion, strict=True))
        step = float(level.operation.speed) / output
        for loss in level.case.losses.values():
            name, borne = next(places)
            if loss.dynamic_load_rating is None:
                continue
            rate_a, rate_b = (rates.get(body, 0.0) * step for body in loss.between)
            pull = _pull(level, loss)
            outward, along, axial = _of_teeth(level, loss, borne - loss.preload, pull, on_planet)
            per = load if load > 0.0 else inf
            rated[name] = RatedBearing(
                loss.dynamic_load_rating,
                abs(rate_a - rate_b),
                (outward / per, along / per, axial / per),
                pull / output**2,
                loss.preload,
                loss.life_exponent or BALL,
                level.planets if _in_planets(level, loss) else 1,
                loss.static_load_rating or nan,
            )
    return rated


def _beyond_rounding(loads: Float[np.ndarray, " place"]) -> list[float]:
    """Loads without those that are nothing beside the others, as of planets that cancel around a carrier."""
    remaining: list[float] = np.where(
        loads > ROUNDING * loads.max(initial=0.0), loads, 0.0
    ).tolist()
    return remaining


ROUNDING = 1e-9
"""Load of a bearing over the largest one below which it bears nothing."""


def _in_planets(level: Any, loss: Loss) -> bool:
    """True for a bearing of a planet in its carrier."""
    return not {*loss.between}.isdisjoint(level.planet_bodies)


def _pull(level: Any, loss: Loss) -> float:
    """Centrifugal force on a bearing at the operating point [N]."""
    if not _in_planets(level, loss):
        return 0.0
    (carrier,) = {*loss.between} - {*level.design.planets}
    speed = float(level.design.rates[carrier]) * float(level.operation.speed)
    return float(level.design.pull) * speed**2


def _of_teeth(level: Any, loss: Loss, borne: float, pull: float, on_planet: np.ndarray) -> Vector:
    """Force of the teeth on a bearing: outwards, along its circle, along its axis [N].

    Args:
        level: drive or stage.
        loss: the place.
        borne: all that it bears but its preload, of several planets the mean.
        pull: centrifugal force.
        on_planet: force of the teeth on a planet in equilibrium, see `_on_planet`.

    On planets it has the direction that it has in equilibrium, and the size that makes up what is borne.
    """
    if not _in_planets(level, loss):
        return 0.0, borne, 0.0
    size = float(on_planet @ on_planet)
    if size == 0.0:
        return 0.0, 0.0, 0.0
    inwards = -float(on_planet[0]) * pull
    part = (inwards + sqrt(max(inwards**2 + size * (borne**2 - pull**2), 0.0))) / size
    radial, tangential, axial = (mesh_load_of(level) * part * on_planet).tolist()
    return radial, tangential, axial


def _on_planet(level: Any, power: float) -> Float[np.ndarray, " 3"]:
    """Mean force of the teeth on a planet over the period, by the first friction law [N].

    Args:
        level: drive or stage; zero where none of its planets has a rated bearing.
        power: through it without losses behind it [W].
    """
    rated = [loss for loss in level.case.losses.values() if loss.dynamic_load_rating is not None]
    load = power / (float(level.operation.speed) * level.output_rate)
    if not any(_in_planets(level, loss) for loss in rated) or load <= 0.0:
        return np.zeros(3)
    point = replace(level.operation, load=array(load))
    return np.asarray(over_period(level, point, level.models[0])["on_planet"])
