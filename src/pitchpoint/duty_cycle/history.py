"""Torque, speed and temperature of an output over time."""

import io
import re
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pitchpoint import units
from pitchpoint.core.plain_files import content
from pitchpoint.duty_cycle.duty_table import LARGEST
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "ICE_POINT",
    "LoadHistory",
    "demand_kelvins",
    "history_of_table",
    "load_history",
    "load_steps",
    "read_history",
]

Floats = NDArray[np.float64]

_COLDEST, _HOTTEST = 150.0, 600.0
"""Temperatures of an oil that are plausible [K]; below lies what was meant in degC."""

ICE_POINT = 273.15
"""0 degC [K], which large arrays take off without the conversion of units."""


class LoadHistory(NamedTuple):
    """Load of an output, sample by sample.

    Attributes:
        time: of the samples, ascending, shape (n,) [s].
        duration: for which a sample counts, shape (n,) [s].
        torque: of the output on its load, positive along positive speeds, shape (n,) [N m or N].
        speed: of the output, shape (n,) [rad/s or m/s].
        temperature: of the oil, shape (n,) [K].
    """

    time: Floats
    duration: Floats
    torque: Floats
    speed: Floats
    temperature: Floats

    @property
    def power(self) -> Floats:
        """Of the output on its load, shape (n,) [W]."""
        return self.torque * self.speed

    @property
    def acceleration(self) -> Floats:
        """Of the output, by differences of second order between the samples, shape (n,) [rad/s2 or m/s2].

        Zero where the history has but one sample.
        """
        return np.gradient(self.speed, self.time) if self.time.size > 1 else 0.0 * self.speed

    def at_temperature(self, temperature: Floats) -> Self:
        """The same at other temperatures of the oil.

        Args:
            temperature: shape (n,) [K].
        """
        return self._replace(temperature=temperature)


def load_history(
    time: ArrayLike, torque: ArrayLike, speed: ArrayLike, temperature: ArrayLike
) -> LoadHistory:
    """A history of samples between which load and speed run straight.

    Args:
        time: ascending, at least two, shape (n,) [s].
        torque: of the output on its load, positive along positive speeds, shape (n,) or () [N m or N].
        speed: of the output, shape (n,) or () [rad/s or m/s].
        temperature: of the oil, shape (n,) or () [K].

    Returns:
        The history; a sample counts for half of the time to both neighbours (trapezoidal rule).

    Raises:
        InputError: what is not an array of numbers, of another length, time that does not ascend.

    From the trapezoidal rule.

    Example:
        >>> load_history([0.0, 1.0, 4.0], [5.0, 5.0, 0.0], 2.0, 313.15).duration.tolist()
        [0.5, 2.0, 1.5]
    """
    instants = _numbers("time", time)
    if instants.ndim != 1 or instants.size < 2:
        raise InputError("a load over time has at least two samples", key="time")
    steps = np.diff(instants)
    if not (steps > 0.0).all():
        at = int(np.argmin(steps > 0.0))
        raise InputError(
            f"sample {at + 2} is at {instants[at + 1]:.6g} s and the one before at {instants[at]:.6g} s; "
            "time ascends from sample to sample",
            key="time",
        )
    padded = np.concatenate([[0.0], steps, [0.0]])
    return LoadHistory(
        instants,
        0.5 * (padded[1:] + padded[:-1]),
        _samples("torque", torque, instants.size),
        _samples("speed", speed, instants.size),
        _temperatures(temperature, instants.size),
    )


def load_steps(
    duration: ArrayLike, torque: ArrayLike, speed: ArrayLike, temperature: ArrayLike
) -> LoadHistory:
    """A history of steps, in each of which load and speed stay as they are.

    Args:
        duration: of each step, not negative, shape (n,) [s].
        torque, speed, temperature: as `load_history` has them.

    Returns:
        The history; the time of a step is its middle.

    Raises:
        InputError: as `load_history`; a negative duration, or none above zero.

    Example:
        >>> load_steps([1.0, 3.0], [5.0, 0.0], 2.0, 313.15).time.tolist()
        [0.5, 2.5]
    """
    lasting = np.atleast_1d(_numbers("duration", duration))
    if (lasting < 0.0).any():
        at = int(np.argmax(lasting < 0.0))
        raise InputError(
            f"sample {at + 1} lasts {lasting[at]:.6g} s; durations are not negative", key="duration"
        )
    if not lasting.sum() > 0.0:
        raise InputError("every sample lasts 0 s; one at least is above", key="duration")
    return LoadHistory(
        np.cumsum(lasting) - 0.5 * lasting,
        lasting,
        _samples("torque", torque, lasting.size),
        _samples("speed", speed, lasting.size),
        _temperatures(temperature, lasting.size),
    )


def history_of_table(
    table: "Mapping[str, ArrayLike] | pd.DataFrame", temperature: float, *, travels: bool = False
) -> LoadHistory:
    """The history in a table with units in its heads, `torque [N m]`.

    Args:
        table: columns by head: `time` or `duration`, `torque`, `speed`, and `temperature` where it is not
            always the same. A head without unit is in SI.
        temperature: of the oil where no column has it [K].
        travels: the output travels, so that its load is a force and its speed a linear one.

    Raises:
        InputError: a column is missing or unknown, a unit is not of its kind, and as `load_history`.
    """
    columns = _columns(table, travels)
    timed = [name for name in ("time", "duration") if name in columns]
    if len(timed) != 1:
        raise InputError(
            "a duty cycle has a column for either time [s] or duration [s], and "
            + ("has none" if not timed else "has both")
        )
    for name in ("torque", "speed"):
        if name not in columns:
            raise InputError(
                f"a duty cycle has a column for the {name} of the output, and has none; its heads are "
                + ", ".join(map(str, table)),
                key=name,
            )
    make: Callable[..., LoadHistory] = load_history if timed == ["time"] else load_steps
    degrees = columns.get("temperature", np.array(temperature))
    return make(columns[timed[0]], columns["torque"], columns["speed"], degrees)


def read_history(path: Path, temperature: float, *, travels: bool = False) -> LoadHistory:
    """The history in a file of comma separated values, with heads as in `history_of_table`.

    Args:
        path: of the file; its first line has the heads, each with its unit unless all of the column is 0.
            Semicolons and tabs part columns too, and then commas are decimal ones where there is no
            point.
        temperature: where no column has it [K].
        travels: as there.

    Raises:
        InputError: there is no such file, it is no table of numbers, and as `history_of_table`.
    """
    text = content(path, LARGEST).decode("utf-8-sig", "replace")
    if not text.strip():
        heads = "time [s], torque [N m], speed [rpm]"
        raise InputError(f"is empty; its first line has heads, such as {heads}", file=str(path))
    try:
        table = _table_of(text)
        _demand_units(table, travels)
        return history_of_table(table, temperature, travels=travels)
    except InputError as error:
        raise error.at(file=str(path)) from None
    except ValueError as error:
        why = _parting(str(error).splitlines()[0])
        raise InputError(f"is no table of comma separated values: {why}", file=str(path)) from None


def _table_of(text: str) -> "pd.DataFrame":
    """The table that a file has in its text; ValueError where it is none."""
    import pandas as pd

    heads = text.partition("\n")[0]
    apart = max(",;\t", key=heads.count)
    comma = apart != "," and "." not in text
    with warnings.catch_warnings():
        warnings.simplefilter("error", pd.errors.ParserWarning)
        try:
            return pd.read_csv(
                io.StringIO(text),
                sep=apart,
                skipinitialspace=True,
                decimal="," if comma else ".",
                index_col=False,  # or longer lines have their first value as a name
            )
        except pd.errors.ParserWarning:
            count = heads.count(apart) + 1
            raise InputError(f"has lines of more values than heads, {count}") from None


def _parting(why: str) -> str:
    """What a reader of tables complains of, in words of ours where it is the usual."""
    counts = re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", why)
    if counts is None:
        return why
    heads, line, values = counts.groups()
    return f"line {line} has {values} values, and there are {heads} heads"


def _demand_units(table: "pd.DataFrame", travels: bool) -> None:
    """InputError for a column of a file without a unit; a file does not say whether it is in rpm or rad/s."""
    usual = {"time": "s", "duration": "s", "torque": "N m", "speed": "rpm", "temperature": "degC"}
    usual |= {"torque": "N", "speed": "m/s"} if travels else {}
    for head in map(str, table):
        name, unit = _name_and_unit(head)
        nothing = name != "temperature" and (table[head] == 0).all()
        if name in usual and not unit and not nothing:
            raise InputError(
                f"{head!r} has no unit; write it in brackets, such as {name} [{usual[name]}]",
                key=name,
            )


def _columns(table: "Mapping[str, ArrayLike] | pd.DataFrame", travels: bool) -> dict[str, Floats]:
    """Columns by name, in SI."""
    kinds = _kinds(travels)
    columns: dict[str, Floats] = {}
    for head in map(str, table):
        name, unit = _name_and_unit(head)
        if name not in kinds:
            raise InputError(
                f"{head!r} is no column of a duty cycle; those are {', '.join(kinds)}, "
                "each with its unit in brackets"
            )
        if name in columns:
            raise InputError(f"there are two columns for {name}", key=name)
        values = _numbers(name, table[head])
        columns[name] = _in_si(values, unit, kinds[name], head)
    return columns


def _name_and_unit(head: str) -> tuple[str, str]:
    """Of a column, by its head, "Torque [N m]"; no unit is an empty one."""
    name, _, unit = head.partition("[")
    return name.strip().lower(), unit.rstrip().removesuffix("]").strip()


def _kinds(travels: bool) -> dict[str, str]:
    load, speed = ("force", "speed") if travels else ("torque", "rotational speed")
    return {
        "time": "time",
        "duration": "time",
        "torque": load,
        "speed": speed,
        "temperature": "temperature",
    }


def _in_si(values: Floats, unit: str, kind: str, head: str) -> Floats:
    """Values in SI; 0 and 1 of the unit say what it is, for every unit is a line."""
    if not unit:
        return values
    try:
        zero, step = (units.parse(f"{number} {unit}", kind) for number in (0, 1))
    except InputError:
        allowed = ", ".join(units.units_of(kind))
        raise InputError(
            f"{unit!r} in {head!r} is no unit of {units.noun(kind)}; units: {allowed}"
        ) from None
    return zero + values * (step - zero)


def _numbers(name: str, values: Any) -> Floats:
    try:
        numbers = np.asarray(values, float)
    except (TypeError, ValueError):
        raise InputError(f"is not made of numbers alone{_first_text(values)}", key=name) from None
    if not np.isfinite(numbers).all():
        at = int(np.argmin(np.isfinite(np.ravel(numbers))))
        value = np.ravel(numbers)[at]
        what = "nan or empty" if np.isnan(value) else str(value)
        raise InputError(f"sample {at + 1} is {what}, no finite number", key=name)
    return numbers


def _first_text(values: Any) -> str:
    """Which sample is no number, in words; empty where that is not clear."""
    for at, value in enumerate(np.ravel(np.asarray(values, object)).tolist(), 1):
        try:
            float(value)
        except (TypeError, ValueError):
            return f": sample {at} is {shown(value)}"
    return ""


def _samples(name: str, values: ArrayLike, count: int) -> Floats:
    numbers = _numbers(name, values)
    if numbers.shape not in ((), (count,)):
        raise InputError(f"has {numbers.size} samples where time has {count}", key=name)
    return np.broadcast_to(numbers, (count,)).astype(float)


def _temperatures(values: ArrayLike, count: int) -> Floats:
    degrees = _samples("temperature", values, count)
    for degree in (degrees.min(), degrees.max()):
        demand_kelvins(float(degree), "temperature", "an oil")
    return degrees


def demand_kelvins(degree: float, key: str, body: str) -> None:
    """InputError for what is no plausible temperature of a body, as numbers meant in degC are none.

    Args:
        degree: temperature [K].
        key: where it was given.
        body: whose it is.
    """
    if not _COLDEST <= degree <= _HOTTEST:
        meant = "; plain numbers are in K" if degree < _COLDEST else ""
        raise InputError(
            f"{degree:.6g} K, which are {degree - ICE_POINT:.6g} degC, is no temperature of {body}{meant}",
            key=key,
        )
