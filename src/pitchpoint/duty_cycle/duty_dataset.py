"""A duty cycle as a dataset: courses, energies, means, life and temperatures."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from pitchpoint.duty_cycle.actuator import actuator_map
from pitchpoint.duty_cycle.energy import (
    DriverCourse,
    at_the_edge,
    demand_inside,
    driver_course,
    duty_energies,
    mean_load,
)
from pitchpoint.duty_cycle.first_failure import first_failure
from pitchpoint.duty_cycle.history import LoadHistory, demand_kelvins
from pitchpoint.duty_cycle.life import BALL, ROLLER, RatedBearing, RatedLife, system_life
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.duty_cycle.recorded_lives import RecordedLives
from pitchpoint.duty_cycle.thermal_network import ThermalNetwork
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.results.store import dataset
from pitchpoint.results.variable import End

__all__ = ["Heating", "duty_dataset"]

Floats = NDArray[np.float64]

QUADRANTS = ("I", "II", "III", "IV", "rest")
"""Quadrants of speed and torque of the output; the driver drives in I and III, the load in II and IV."""


@dataclass(frozen=True)
class Heating:
    """Where losses go as heat.

    Attributes:
        network: of bodies and resistances.
        gears: body that the loss of the drive heats and whose temperature is that of the oil.
        motor: body that the loss of the motor heats and whose temperature is that of its winding; that of
            the gears where empty.
        limits: largest temperatures that bodies bear, by name [K].

    Raises:
        InputError: the network has no such body, or a limit is no temperature.
    """

    network: ThermalNetwork
    gears: str
    motor: str = ""
    limits: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        limited = (("limits", body) for body in self.limits)
        for name, body in (("gears", self.gears), ("motor", self.winding), *limited):
            if body not in self.network.capacities:
                bodies = ", ".join(self.network.bodies)
                raise InputError(f"the network has no body {body!r}, but {bodies}", key=name)
        for body, most in self.limits.items():
            demand_kelvins(most, "limits", body)

    @property
    def winding(self) -> str:
        """Body of the motor's winding."""
        return self.motor or self.gears

    def _into(self, driver: DriverCourse) -> Floats:
        """Heat into each body, shape (n, b) [W]."""
        heat = np.zeros((driver.loss.size, len(self.network.bodies)))
        heat[:, self.place(self.gears)] += driver.loss
        heat[:, self.place(self.winding)] += driver.motor_loss
        return heat

    def place(self, body: str) -> int:
        """Where arrays have a body."""
        return self.network.bodies.index(body)

    def periodic(
        self, table: LossTable, history: LoadHistory, law: str, motor: Motor | None
    ) -> Floats:
        """Temperatures of the bodies in a cycle that repeats, in the middle of each sample, shape (n, b) [K].

        Args:
            table: loss map, with whose nearest temperatures it goes on beyond its own on the way.
            history: of the output; its temperatures do not count.
            law: of friction.
            motor: of the drive, or None.

        Raises:
            ConvergenceError: losses grow faster with the temperature than heat leaves.
        """

        def heat(degrees: Floats) -> Floats:
            warm = history.at_temperature(degrees[:, self.place(self.gears)])
            winding = degrees[:, self.place(self.winding)]
            return self._into(
                driver_course(
                    table, warm, law=law, motor=motor, winding_temperature=winding, inside=False
                )
            )

        return self.network.periodic_with(history.duration, heat)


def duty_dataset(
    table: LossTable,
    history: LoadHistory,
    *,
    law: str = "",
    motor: Motor | None = None,
    lives: Mapping[str, RatedLife | RatedBearing] | None = None,
    recorded: RecordedLives | None = None,
    heating: Heating | None = None,
    teeth: Callable[[LoadHistory], xr.Dataset] | None = None,
    runaway: str = "",
    travels: bool = False,
    **attributes: Any,
) -> xr.Dataset:
    """Energies, means, life and temperatures of a drive over a cycle that repeats.

    Args:
        table: loss map of the drive.
        history: of its output.
        law: of friction; the first one of the map by default, beside which energies under all of them stand.
        motor: of the drive, none by default.
        lives: of bearings by name.
        recorded: lives that the result of the drive has; those of `lives` with their names come before them.
        heating: resistances that give the temperatures; those of the history by default.
        teeth: damage and life of the teeth over a history, see `tooth_life`; not known by default.
        runaway: body that gets ever hotter, where somebody found that; it fails first.
        travels: the output travels.
        attributes: of the dataset beside, with `warnings` that come before its own.

    Temperatures that follow from `heating`, or that a runaway leaves to the history, may lie beyond the map:
    losses are those of its edge then, and a warning says so.

    Returns:
        Courses over `time`, energies and means as single numbers, energies over `quadrant` and `law`, lives
        over `bearing` and `worn`, temperatures over `time` and `body`, electrical power over `map_torque` and
        `map_speed`; the part that fails first, see `first_failure`. The attribute `mean_temperature` is that
        of the oil over time [K], at which the actuator is.

    Raises:
        InputError: samples beyond the map or the limits of the motor, or where friction locks the drive.
        ConvergenceError: there is no periodic temperature.
    """
    laws = [law] if law else [*table.loss_torques]
    demand_inside(table, history, warm=heating is None and not runaway)
    warm = _warmed(table, history, laws[0], motor, heating)
    driver = _course_of(table, warm, laws[0], motor)
    parts = [
        _heated(warm, heating),
        _lives(warm.history, (recorded.bearings if recorded else {}) | dict(lives or {})),
        _wear(warm.history, recorded),
        _teeth(warm.history, teeth),
        _of_actuator(table, warm, laws[0], motor),
        _by_law(table, history, laws, motor, heating, driver),
    ]
    extra = xr.merge(parts, combine_attrs="no_conflicts")
    extra = extra.assign_attrs({"runaway": runaway} if runaway else {})
    failing = first_failure(extra, None if heating is None else heating.limits)
    ends: tuple[End, ...] = ("loaded",) if travels else ()
    numbers = duty_energies(warm.history, driver)
    if warnings := [*attributes.pop("warnings", []), *at_the_edge(table, warm.history)]:
        attributes["warnings"] = warnings
    numbers |= {
        "mean_torque_of_balls": mean_load(warm.history, BALL),
        "mean_torque_of_rollers": mean_load(warm.history, ROLLER),
        "shortest_life": failing.life,
    }
    return dataset(
        {
            "output_torque": (("time",), history.torque),
            "output_speed": (("time",), history.speed),
            "temperature": (("time",), warm.history.temperature),
            "input_torque": (("time",), driver.torque),
            "input_speed": (("time",), driver.speed),
            "loss": (("time",), driver.loss),
            "motor_loss": (("time",), driver.motor_loss),
            "electrical_power": (("time",), driver.power + driver.motor_loss),
            **{name: ((), value) for name, value in numbers.items()},
            **_by_quadrant(warm.history, driver),
            **{
                str(name): (tuple(map(str, variable.dims)), variable.values)
                for name, variable in extra.items()
            },
        },
        {"time": history.time, "quadrant": [*QUADRANTS]}
        | {str(name): variable.values for name, variable in extra.coords.items()},
        travels=ends,
        title="duty cycle",
        members=str(extra.attrs.get("members", "[]")),
        law=laws[0],
        chosen_law=int(bool(law)),
        motor=int(motor is not None),
        mean_temperature=_mean(warm.history.temperature, warm.history),
        first_to_fail=failing.part,
        parts_compared=failing.compared,
        left_out=", ".join(failing.left_out),
        **attributes,
    )


class _Warm(NamedTuple):
    """A history at its temperatures; those of the bodies (n, b) and of the winding (n,) [K], if computed."""

    history: LoadHistory
    bodies: Floats | None
    winding: Floats | None


def _warmed(
    table: LossTable, history: LoadHistory, law: str, motor: Motor | None, heating: Heating | None
) -> _Warm:
    if heating is None:
        return _Warm(history, None, None)
    bodies = heating.periodic(table, history, law, motor)
    warm = history.at_temperature(bodies[:, heating.place(heating.gears)])
    return _Warm(warm, bodies, bodies[:, heating.place(heating.winding)])


def _course_of(table: LossTable, warm: _Warm, law: str, motor: Motor | None) -> DriverCourse:
    """Of loads that lie in the map, which oil may leave."""
    return driver_course(
        table, warm.history, law=law, motor=motor, winding_temperature=warm.winding, inside=False
    )


def _heated(warm: _Warm, heating: Heating | None) -> xr.Dataset:
    if heating is None or warm.bodies is None:
        return xr.Dataset()
    names = [*heating.network.bodies]
    return xr.Dataset({"body_temperature": (("time", "body"), warm.bodies)}, {"body": names})


def _lives(history: LoadHistory, lives: Mapping[str, RatedLife | RatedBearing]) -> xr.Dataset:
    """Of bearings and wave generators, each and together."""
    if not lives:
        return xr.Dataset()
    life_by_part = {name: rated.life(history) for name, rated in lives.items()}
    every = [life_by_part[name] for name, rated in lives.items() for _ in range(rated.count)]
    data = {
        "bearing_life": (("bearing",), [*life_by_part.values()]),
        "system_life": ((), system_life(every)),
    }
    return xr.Dataset(data, {"bearing": [*life_by_part]})


def _wear(history: LoadHistory, recorded: RecordedLives | None) -> xr.Dataset:
    """Life of worn flanks, NaN where their march ended before a limit, and depth of one cycle.

    That is NaN where flanks are at a limit as new.
    """
    if recorded is None:
        return xr.Dataset()
    unworn = {"unworn": json.dumps([*recorded.left_out])}
    if not recorded.worn:
        return xr.Dataset(attrs=unworn)
    times = {name: flank.until_as_deep(history) for name, flank in recorded.worn.items()}
    total = float(history.duration.sum())
    worn = recorded.worn.items()
    depths = [flank.depth * total / (times[name] or np.nan) for name, flank in worn]
    lives = [times[name] if flank.limited else np.nan for name, flank in worn]
    data = {"wear_life": (("worn",), lives), "cycle_wear": (("worn",), depths)}
    return xr.Dataset(data, {"worn": [*times]}, unworn)


def _teeth(history: LoadHistory, teeth: Callable[[LoadHistory], xr.Dataset] | None) -> xr.Dataset:
    if teeth is None:
        return xr.Dataset()
    rated = teeth(history)
    attributes = {
        name: value for name, value in rated.attrs.items() if name in ("unrated", "members")
    }
    return rated.drop_attrs().assign_attrs(attributes)


def _of_actuator(table: LossTable, warm: _Warm, law: str, motor: Motor | None) -> xr.Dataset:
    """Electrical power and efficiency over the map, at the mean temperatures of the cycle."""
    if motor is None:
        return xr.Dataset()
    oil = _mean(warm.history.temperature, warm.history)
    hot = oil if warm.winding is None else _mean(warm.winding, warm.history)
    actuator = actuator_map(table, motor, law=law, temperature=oil, winding=hot)
    axes = ("map_torque", "map_speed")
    data = {
        "map_electrical_power": (axes, actuator.power),
        "map_actuator_efficiency": (axes, actuator.efficiency),
    }
    return xr.Dataset(data, dict(zip(axes, (actuator.torque, actuator.speed), strict=True)))


def _mean(values: Floats, history: LoadHistory) -> float:
    """Over time."""
    return float(np.average(values, weights=history.duration))


def _by_law(
    table: LossTable,
    history: LoadHistory,
    laws: Sequence[str],
    motor: Motor | None,
    heating: Heating | None,
    first: DriverCourse,
) -> xr.Dataset:
    """Energies under each law; NaN where friction locks the drive by it, or nothing settles."""
    if len(laws) == 1:
        return xr.Dataset()
    rows = [_sums(history, first)]
    for law in laws[1:]:
        try:
            warm = _warmed(table, history, law, motor, heating)
            rows.append(_sums(history, _course_of(table, warm, law, motor)))
        except (InputError, ConvergenceError):
            rows.append((np.nan, np.nan))
    lost, drawn = zip(*rows, strict=True)
    data = {"law_lost_energy": (("law",), [*lost]), "law_input_energy": (("law",), [*drawn])}
    return xr.Dataset(data, {"law": [*laws]})


def _sums(history: LoadHistory, driver: DriverCourse) -> tuple[float, float]:
    """Energy that is lost, and that the driver gives [J]."""
    drawn = np.maximum(driver.power, 0.0)
    return float(history.duration @ driver.loss), float(history.duration @ drawn)


def _by_quadrant(history: LoadHistory, driver: DriverCourse) -> dict[str, Any]:
    """Time and energies by quadrant of the output."""
    speed, torque = history.speed, history.torque
    inside = [
        (speed > 0.0) & (torque >= 0.0),
        (speed < 0.0) & (torque > 0.0),
        (speed < 0.0) & (torque <= 0.0),
        (speed > 0.0) & (torque < 0.0),
        speed == 0.0,
    ]
    rows = {
        "quadrant_time": np.ones_like(speed),
        "quadrant_output_energy": history.power,
        "quadrant_input_energy": driver.power,
        "quadrant_lost_energy": driver.loss,
    }
    return {
        name: (("quadrant",), [float(history.duration[at] @ power[at]) for at in inside])
        for name, power in rows.items()
    }
