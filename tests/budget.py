"""What the suite may cost: figures that were recorded for each file, and a suite that holds them.

Programs are the first measure: JAX asks for the same number of them on every machine, and each costs
a trace, a lowering and a compilation. The suite fails that asks for more than `PROGRAMS`, and a file that
asks for far more than its figure in `budget.toml`; before that is recorded anew a test should share a
program with another (the same static structure, padded lanes, a result of the bank). Processor time is told
in loops of Python, which a slow or shared machine takes as much longer for; it fails a run only where that
is asked for, with `--hold-pace`.

`pytest --record-budget` records the files that it runs, each as if it ran alone; `-m whole` records the
other part. With an empty cache, so that the loops are those of a first run.
"""

import os
import time
import tomllib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

PROGRAMS = 3800
"""Programs of the quick part that JAX is asked for, found in the cache on disk or not."""

PARTS = ("quick", "whole")
"""Tests without the mark `whole`, and those with it."""

TABLE = Path(__file__).with_name("budget.toml")

GROWTH = 1.1
"""How far a figure of a file may be exceeded."""

NOISE = 1.25
"""How far loops may exceed those that were recorded: runs of the same tests took 34 to 42 in a second."""

SHARED = 100
"""Programs that fail no file, be they ever so many times its figure: the first of those that share a fixture
or an operation pays for all, and which one that is hangs on the order."""

EVENT = "/jax/core/compile/backend_compile_duration"
"""Told by JAX for each program that the process does not hold yet."""


@dataclass(frozen=True)
class Spent:
    """Programs, processor time [s], and the same in calibration loops."""

    programs: int = 0
    seconds: float = 0.0
    loops: float = 0.0

    def __add__(self, other: "Spent") -> "Spent":
        return Spent(
            self.programs + other.programs, self.seconds + other.seconds, self.loops + other.loops
        )

    def __sub__(self, other: "Spent") -> "Spent":
        return Spent(
            self.programs - other.programs, self.seconds - other.seconds, self.loops - other.loops
        )


class Meter:
    """What this process and the processes that it waited for have spent."""

    def __init__(self) -> None:
        self._told: Counter[str] = Counter()
        self._seconds = self._loops = 0.0
        self.loop = seconds_of_a_loop()

    def listen(self, event: str, _: float, **__: object) -> None:
        """Take a duration told by JAX."""
        self._told[event] += 1

    def read(self) -> Spent:
        """Spent since the start."""
        seconds = sum(os.times()[:4])
        self._loops += (seconds - self._seconds) / self.loop
        self._seconds = seconds
        return Spent(self._told[EVENT], seconds, self._loops)

    def calibrate(self) -> None:
        """Take the loop anew: a shared machine is not equally quick all the time."""
        self.read()
        self.loop = seconds_of_a_loop()


def seconds_of_a_loop() -> float:
    """Processor time of a loop of plain Python, as tracing is made of [s]."""
    start = time.process_time()
    names = {str(number): [number] for number in range(40_000)}
    assert sum(len(names[str(number)]) for number in range(40_000)) == len(names)
    return time.process_time() - start


def recorded(*parts: str, table: Path = TABLE) -> dict[str, Spent]:
    """Figures of the files of one part, quick or whole, or of both together."""
    figures: dict[str, Spent] = {}
    held = tomllib.loads(table.read_text("utf-8")) if table.exists() else {}
    for part in parts:
        for file, (programs, loops) in held.get(part, {}).items():
            name = f"tests/{file}"
            figures[name] = figures.get(name, Spent()) + Spent(programs, loops=loops)
    return figures


def record(part: str, spent: Mapping[str, Spent], table: Path = TABLE) -> None:
    """Put what files spent into the table; figures of other files that exist stay."""
    parts = {one: recorded(one, table=table) for one in PARTS}
    parts[part] |= spent
    root = table.parent.parent
    lines = [
        "# Programs, and loops of `tests/budget.py`, of each file; written by pytest --record-budget."
    ]
    for name, files in parts.items():
        lines += ["", f"[{name}]"]
        lines += [
            f'"{file.removeprefix("tests/")}" = [{own.programs}, {own.loops:.0f}]'
            for file, own in sorted(files.items())
            if (root / file).exists()
        ]
    table.write_text("\n".join(lines) + "\n", "utf-8")


def order(file: str, figures: Mapping[str, Spent]) -> float:
    """Place of a file among the others, the longest first: no worker is left alone with one at the end."""
    return -figures.get(file, Spent()).loops


def exceeded(
    spent: Mapping[str, Spent], figures: Mapping[str, Spent], most: float = PROGRAMS
) -> list[str]:
    """A sentence for each figure of programs that the files have exceeded; without figures for none."""
    budgets = {file: most_of(figures.get(file, Spent()).programs) for file in spent if figures}
    told = [
        f"{file} asks for {spent[file].programs} programs, {budgets[file]} are its budget"
        for file in sorted(budgets)
        if spent[file].programs > budgets[file]
    ]
    asked = sum(own.programs for own in spent.values())
    return told + [f"the suite asks for {asked} programs, {most} are its budget"] * (asked > most)


def most_of(figure: int) -> int:
    """Programs with which a file is still within its figure."""
    return max(int(GROWTH * figure), figure + SHARED)


def slow(spent: Mapping[str, Spent], figures: Mapping[str, Spent]) -> list[str]:
    """A sentence where the files took more loops than were recorded of them, together."""
    taken = sum(own.loops for own in spent.values())
    most = NOISE * sum(figures[file].loops for file in spent if file in figures)
    return [f"the suite takes {taken:.0f} loops, {most:.0f} are its budget"] * (taken > most > 0.0)
