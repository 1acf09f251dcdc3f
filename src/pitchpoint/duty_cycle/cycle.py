"""A duty cycle as a dataset: courses, energies, means, life and temperatures."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from pitchpoint.duty_cycle.energy import DriverCourse, driver_course, energies, mean_load
from pitchpoint.duty_cycle.first_failure import first_failure
from pitchpoint.duty_cycle.heat import ThermalNetwork
from pitchpoint.duty_cycle.history import LoadHistory, demand_kelvins
from pitchpoint.duty_cycle.life import BALL, ROLLER, RatedBearing, RatedLife, system_life
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError
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
                known = ", ".join(self.network.bodies)
                raise InputError(f"the network has no body {body!r}, but {known}", key=name)
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
    heating: Heating | None = None,
    teeth: xr.Dataset | None = None,
    travels: bool = False,
    **attributes: Any,
) -> xr.Dataset:
    """Energies, means, life and temperatures of a drive over a cycle that repeats.

    Args:
        table: loss map of the drive.
        history: of its output.
        law: of friction, the first one of the map by default.
        motor: of the drive, none by default.
        lives: of bearings by name.
        heating: resistances that give the temperatures; those of the history by default.
        teeth: damage and life of the teeth over this history, see `tooth_life`; not known by default.
        travels: the output travels.
        attributes: of the dataset beside.

    Returns:
        Courses over `time`, energies and means as single numbers, energies over `quadrant`, lives over
        `bearing`, temperatures over `time` and `body`; the part that fails first, see `first_failure`.

    Raises:
        InputError: samples beyond the map or the limits of the motor, or where friction locks the drive.
        ConvergenceError: there is no periodic temperature.
    """
    winding: Floats | None = None
    extra: dict[str, tuple[tuple[str, ...], Any]] = {}
    ends: tuple[End, ...] = ("loaded",) if travels else ()
    coordinates: dict[str, Any] = {"time": history.time, "quadrant": [*QUADRANTS]}
    if heating is not None:
        degrees = heating.periodic(table, history, law, motor)
        history = history.at_temperature(degrees[:, heating.place(heating.gears)])
        winding = degrees[:, heating.place(heating.winding)]
        extra["body_temperature"] = (("time", "body"), degrees)
        coordinates["body"] = [*heating.network.bodies]
    driver = driver_course(table, history, law=law, motor=motor, winding_temperature=winding)
    if lives:
        each = {name: rated.life(history) for name, rated in lives.items()}
        extra["bearing_life"] = (("bearing",), [*each.values()])
        every = [each[name] for name, rated in lives.items() for _ in range(rated.count)]
        extra["system_life"] = ((), system_life(every))
        coordinates["bearing"] = [*each]
    if teeth is not None:
        extra |= {str(name): (("mesh", "gear"), teeth[name].values) for name in teeth}
        coordinates |= {name: teeth[name].values for name in ("mesh", "gear")}
    numbers = energies(history, driver)
    numbers["mean_torque_of_balls"] = mean_load(history, BALL)
    numbers["mean_torque_of_rollers"] = mean_load(history, ROLLER)
    failing = first_failure(
        xr.Dataset(extra, coordinates, {} if teeth is None else teeth.attrs),
        None if heating is None else heating.limits,
    )
    numbers["shortest_life"] = failing.life
    return dataset(
        {
            "output_torque": (("time",), history.torque),
            "output_speed": (("time",), history.speed),
            "temperature": (("time",), history.temperature),
            "input_torque": (("time",), driver.torque),
            "input_speed": (("time",), driver.speed),
            "loss": (("time",), driver.loss),
            "motor_loss": (("time",), driver.motor_loss),
            **{name: ((), value) for name, value in numbers.items()},
            **_by_quadrant(history, driver),
            **extra,
        },
        coordinates,
        travels=ends,
        title="duty cycle",
        law=law or next(iter(table.loss_torques)),
        first_to_fail=failing.part,
        parts_compared=failing.compared,
        left_out=", ".join(failing.left_out),
        **attributes,
    )


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
