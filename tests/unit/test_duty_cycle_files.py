"""Duty cycles from tables and files: units in their heads, and what is no duty cycle."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from duty_map import WARM, table

from pitchpoint.duty_cycle.energy import driver_course
from pitchpoint.duty_cycle.history import history_of_table, load_history, load_steps, read_history
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.duty_cycle.thermal_network import ThermalNetwork
from pitchpoint.efficiency.loss_table import LOCKED
from pitchpoint.errors import InputError


def test_tables_and_files_have_units_in_their_heads(tmp_path: Path) -> None:
    rows = pd.DataFrame(
        {"time [ms]": [0, 500, 2000], "Torque [N m]": [1, 2, 3], "speed [rpm]": [0, 30, 60]}
    )
    warm = rows.assign(**{"temperature [degC]": [40.0, 40.0, 41.5]})
    of = history_of_table(warm, 300.0)
    np.testing.assert_allclose(of.time, [0.0, 0.5, 2.0])
    np.testing.assert_allclose(of.speed, [0.0, np.pi, 2.0 * np.pi])
    np.testing.assert_allclose(of.temperature, [313.15, 313.15, 314.65])
    for name, text in (
        ("plain.csv", warm.to_csv(index=False)),
        ("marked.csv", "\ufeff" + warm.to_csv(index=False)),
        ("comma.csv", warm.to_csv(index=False, sep=";", decimal=",")),
        ("tabs.csv", warm.to_csv(index=False, sep="\t")),
    ):
        path = tmp_path / name
        path.write_text(text, "utf-8")
        np.testing.assert_allclose(read_history(path, 300.0).temperature, of.temperature)
    assert (history_of_table(rows, 300.0).temperature == 300.0).all()


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ({"time": [0, 1], "torque": [1, 1]}, "speed: a duty cycle has a column"),
        ({"torque": [1, 1], "speed": [1, 1]}, "either time .s. or duration .s., and has none"),
        ({"time": [0, 1], "duration": [1, 1], "torque": 1, "speed": 1}, "and has both"),
        (
            {"time": [0, 1], "torque [lb]": [1, 1], "speed": [1, 1]},
            "'lb' in 'torque .lb.' is no unit",
        ),
        ({"time": [0, 1], "torque": [1, 1], "velocity": [1, 1]}, "'velocity' is no column"),
        (
            {"time": [0, 1], "torque": [1, 1], "Torque [N m]": [1, 1], "speed": 1},
            "two columns for torque",
        ),
        ({"time": [1, 0], "torque": [1, 1], "speed": [1, 1]}, "time ascends"),
        ({"time": [0, 0], "torque": [1, 1], "speed": [1, 1]}, "time ascends"),
        ({"time": [0], "torque": [1], "speed": [1]}, "at least two samples"),
        ({"time": [0, 1], "torque": [1, math.nan], "speed": [1, 1]}, "torque: sample 2 is nan"),
        (
            {"time": [0, 1], "torque": [1, 1], "speed": ["a", "b"]},
            'speed: .* numbers alone: sample 1 is "a"',
        ),
        (
            {"time": [0, 1], "torque": [1, 1, 1], "speed": [1, 1]},
            "torque: has 3 samples where time has 2",
        ),
        (
            {"time": [0, 1], "torque": 1, "speed": 1, "temperature": 40.0},
            "40 K, which are -233.15 degC, .* plain numbers are in K",
        ),
        ({"duration": [-1, 1], "torque": 1, "speed": 1}, "sample 1 lasts -1 s; durations"),
        (
            {"duration": [0, 0], "torque": 1, "speed": 1},
            "every sample lasts 0 s; one at least is above",
        ),
    ],
)
def test_what_is_no_duty_cycle_is_told(columns: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        history_of_table(columns, WARM)  # type: ignore[arg-type]


def test_an_empty_file_is_told_what_its_heads_are(tmp_path: Path) -> None:
    (tmp_path / "empty.csv").write_text(" \n")
    with pytest.raises(InputError, match=r"empty.csv: is empty; .* heads, such as time"):
        read_history(tmp_path / "empty.csv", WARM)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            "time [s],torque [N m],speed\n0,1,0\n1,1,3\n",
            r"speed: 'speed' has no unit; .* speed \[rpm\]",
        ),
        ("time [s],torque [N m],speed\n0,1,1\n1,1\n", "speed: 'speed' has no unit"),
        ("duration [s],torque [N m],speed []\n1,5,10\n", r"speed: 'speed \[\]' has no unit"),
        (
            "duration [s],torque [N m],speed [rpm]\n1,5,10,30\n2,6,20,40\n",
            "has lines of more values than heads, 3$",
        ),
        (
            "time [s],torque [N m],speed [rpm]\n0,1,1\n1,,1\n",
            "torque: sample 2 is nan or empty, no finite number",
        ),
        (
            "time [s],torque [N m],speed [rpm]\n0,1,1\n1,1,1,4\n",
            "line 3 has 4 values, and there are 3 heads$",
        ),
    ],
)
def test_a_file_without_units_or_with_ragged_lines_is_told(
    text: str, says: str, tmp_path: Path
) -> None:
    (tmp_path / "cycle.csv").write_text(text)
    with pytest.raises(InputError, match=f"cycle.csv: .*{says}"):
        read_history(tmp_path / "cycle.csv", WARM)


def test_a_column_of_zeros_needs_no_unit(tmp_path: Path) -> None:
    (tmp_path / "rest.csv").write_text("duration [s],torque [N m],speed\n2,5,0\n")
    assert read_history(tmp_path / "rest.csv", WARM).speed.tolist() == [0.0]


@pytest.mark.parametrize(
    ("torque", "speed", "degrees", "says"),
    [
        (
            60.03,
            1.0,
            WARM,
            r"torque: 2 of 2 samples .* 60.03 N m; the map has -50 to 50 N m; .* \"60.1 N m\"",
        ),
        (
            1.0,
            -11.0,
            WARM,
            r"speed: 2 of 2 samples .* 105.042 rpm; .* loss_map.speed = \"5260 rpm\"",
        ),
        (
            1.0,
            1.0,
            353.15,
            r"temperature: 2 of 2 samples .* 80 degC; .* = \[\"20 degC\", \"80 degC\"\]",
        ),
    ],
)
def test_loads_beyond_the_map_are_told(
    torque: float, speed: float, degrees: float, says: str
) -> None:
    with pytest.raises(InputError, match=says):
        driver_course(table(), load_history([0.0, 1.0], torque, speed, degrees))


def test_a_load_that_friction_locks_is_told() -> None:
    locked = table()._replace(
        loss_torques={"own": [[[LOCKED] * 2] * 3, *table().loss_torques["own"][1:]]}
    )
    with pytest.raises(
        InputError, match="at 1 of 2 samples, the first at 1 s, the load is to drive"
    ):
        driver_course(locked, load_history([0.0, 1.0], [10.0, -10.0], 1.0, WARM))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"resistance": 0.0}, "motor.resistance: 0.0 was given; it is above 0"),
        ({"resistance": float("inf")}, "motor.resistance: inf was given; it is finite"),
        ({"torque_constant": math.nan}, "motor.torque_constant"),
        ({"inertia": -1.0}, "motor.inertia: -1.0 was given; it is not negative"),
        ({"iron_exponent": 3.0}, "allowed is 1 to 2"),
    ],
)
def test_a_motor_without_its_constants_is_told(change: dict[str, float], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Motor(**{"torque_constant": 0.1, "resistance": 0.5, **change})


def test_a_motor_that_is_too_small_is_told() -> None:
    weak = Motor(torque_constant=0.1, resistance=0.5, largest_torque=0.5)
    with pytest.raises(
        InputError, match=r"asks the motor for 0.7 N m at 1 s, and 0.5 N m is the most"
    ):
        driver_course(table(), load_steps([2.0, 1.0], [30.0, 10.0], 1.0, WARM), motor=weak)


@pytest.mark.parametrize(
    ("capacities", "resistances", "says"),
    [
        ({}, {}, "needs one body"),
        ({"ambient": 1.0}, {}, '"ambient" is the air around'),
        ({"a": 0.0}, {("a", "ambient"): 1.0}, "0.0 was given for a"),
        ({"a": 1.0}, {("a", "b"): 1.0}, "between two of a, ambient"),
        ({"a": 1.0}, {("a", "a"): 1.0}, "between two of a, ambient"),
        ({"a": 1.0}, {("a", "ambient"): -1.0}, "-1.0 was given between a and ambient"),
        ({"a": 1.0, "b": 1.0}, {("a", "ambient"): 1.0}, "no way for the heat from b"),
    ],
)
def test_networks_without_a_way_out_are_told(
    capacities: dict[str, float], resistances: dict[tuple[str, str], float], says: str
) -> None:
    with pytest.raises(InputError, match=says):
        ThermalNetwork(capacities, resistances)
