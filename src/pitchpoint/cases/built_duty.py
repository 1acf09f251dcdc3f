"""The duty cycle of a case as it is computed: its file read, its motor, lives and resistances built."""

import os
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from pitchpoint.duty_cycle.duty_dataset import Heating
from pitchpoint.duty_cycle.duty_table import DutyTable, HeatTable, MotorTable, ResistanceTable
from pitchpoint.duty_cycle.history import LoadHistory, read_history
from pitchpoint.duty_cycle.life import RatedLife
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.duty_cycle.thermal_network import ThermalNetwork
from pitchpoint.errors import InputError, shorten, visible

__all__ = ["DutyInputs", "duty_inputs"]


class DutyInputs(NamedTuple):
    """What a table [duty] asks for.

    Attributes:
        history: load of the output over time.
        motor: by value; None without one.
        lives: of bearings and wave generators by name.
        heating: resistances that give the temperatures; None where the file has them.
        law: of friction by name; empty where the case leaves it open.
    """

    history: LoadHistory
    motor: Motor | None
    lives: dict[str, RatedLife]
    heating: Heating | None
    law: str


def duty_inputs(table: DutyTable, temperature: float, *, travels: bool) -> DutyInputs:
    """A duty cycle ready to be computed.

    Args:
        table: as validated.
        temperature: of the oil where the file has none [K].
        travels: the output travels.

    Raises:
        InputError: a file that holds no load over time, bodies without resistances, with the key.
    """
    if travels and table.lives:
        message = "are those over turns of an output, and this one travels; leave the table out"
        raise InputError(message, key="duty.lives")
    lives = {name: RatedLife(**life.model_dump()) for name, life in table.lives.items()}
    return DutyInputs(
        _history(table.file, temperature, travels),
        None if table.motor is None else _motor(table.motor),
        lives,
        None if table.heat is None else _heating(table.heat),
        table.law,
    )


def _history(file: str, temperature: float, travels: bool) -> LoadHistory:
    try:
        held = os.stat(file)
        stamp = held.st_size, held.st_mtime_ns
    except (OSError, ValueError):
        stamp = 0, 0
    try:
        return _read(file, temperature, travels, stamp)
    except InputError as error:
        name = visible(shorten(os.path.basename(file)))
        where = f"{error.key}: " if error.key else ""
        raise InputError(f'"{name}": {where}{error.message}', key="duty.file") from None


@lru_cache(maxsize=4)
def _read(file: str, temperature: float, travels: bool, _: tuple[int, int]) -> LoadHistory:
    """The load in a file, read anew where its size or time of change is another."""
    return read_history(Path(file), temperature, travels=travels)


def _motor(table: MotorTable) -> Motor:
    return Motor(**table.model_dump(exclude_none=True))


def _heating(table: HeatTable) -> Heating:
    try:
        network = ThermalNetwork(
            {name: body.heat_capacity for name, body in table.bodies.items()},
            _between(table.resistances.values()),
            table.ambient,
        )
        limits = {
            name: body.largest_temperature
            for name, body in table.bodies.items()
            if body.largest_temperature is not None
        }
        return Heating(network, table.gears, table.motor, limits)
    except InputError as error:
        key = "bodies" if error.key in ("capacities", "limits") else error.key
        raise InputError(error.message, key=f"duty.heat.{key}") from None


def _between(tables: Iterable[ResistanceTable]) -> dict[tuple[str, str], float]:
    """Resistances by the two names that they join; those side by side as what they are together [K/W]."""
    conductances: dict[tuple[str, str], float] = {}
    for table in tables:
        body, neighbour = sorted(table.between)
        conductances[body, neighbour] = (
            conductances.get((body, neighbour), 0.0) + 1.0 / table.resistance
        )
    return {names: 1.0 / conductance for names, conductance in conductances.items()}
