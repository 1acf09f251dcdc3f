"""What the suite may cost, counted for each file on whichever worker it ran.

Programs are the first measure: JAX asks for the same number of them on every machine, and each costs
a trace, a lowering and a compilation. A test that exceeds a budget should share a program with
another (the same static structure, padded lanes, a fixture of the session) before a budget is raised
here. Seconds are of the processor. They differ threefold between a quiet machine and a shared one, so
they are told and fail nothing.
"""

import os
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

PROGRAMS = 12000
"""Programs of the whole suite that JAX is asked for, found in the cache on disk or not."""

PROGRAMS_OF_A_FILE = 480

SECONDS = 2400.0
"""Processor time of the whole suite with an empty cache on a quiet machine [s]."""

SECONDS_OF_A_FILE = 250.0

EVENT = "/jax/core/compile/backend_compile_duration"
"""Told by JAX for each program that the process does not hold yet."""

SLOWEST_FIRST = (
    "battery/test_families.py",
    "cli/test_commands.py",
    "properties/test_gradients.py",
    "analytic/test_strain_wave_geometry.py",
    "analytic/test_strain_wave_loads.py",
    "properties/test_strain_wave_gradients.py",
    "analytic/test_dynamics.py",
    "literature/test_xu2021.py",
    "battery/test_strain_wave.py",
    "cli/test_strain_wave_runs.py",
    "unit/test_report.py",
    "cli/test_stiffness_and_vibration.py",
    "literature/test_zhao2022.py",
    "literature/test_liu_xiong_torus.py",
    "analytic/test_motion.py",
    "cli/test_joint_runs.py",
    "literature/test_atanasiu2011.py",
    "properties/test_random_cases.py",
    "cli/test_bad_input.py",
)
"""Files that start before all others, so that no worker is left alone with one of them at the end."""


@dataclass(frozen=True)
class Spent:
    """Programs and processor time [s]."""

    programs: int = 0
    seconds: float = 0.0

    def __add__(self, other: "Spent") -> "Spent":
        return Spent(self.programs + other.programs, self.seconds + other.seconds)

    def __sub__(self, other: "Spent") -> "Spent":
        return Spent(self.programs - other.programs, self.seconds - other.seconds)


class Meter:
    """What this process and the processes that it waited for have spent."""

    def __init__(self) -> None:
        self._told: Counter[str] = Counter()

    def listen(self, event: str, _: float, **__: object) -> None:
        """Take a duration told by JAX."""
        self._told[event] += 1

    def read(self) -> Spent:
        """Spent since the start."""
        return Spent(self._told[EVENT], sum(os.times()[:4]))


def order(file: str) -> int:
    """Place of a file in the order of the slowest; all others come behind."""
    name = file.removeprefix("tests/")
    return SLOWEST_FIRST.index(name) if name in SLOWEST_FIRST else len(SLOWEST_FIRST)


def exceeded(spent: Mapping[str, Spent]) -> list[str]:
    """A sentence for each budget of programs that the files have exceeded."""
    return [
        f"{name} asks for {own.programs} programs, {most.programs} are its budget"
        for name, own, most in _judged(spent)
        if own.programs > most.programs
    ]


def slow(spent: Mapping[str, Spent]) -> list[str]:
    """A sentence for each file that takes longer than a quiet machine should need."""
    return [
        f"{name} takes {own.seconds:.0f} s of the processor, a quiet machine needs {most.seconds:.0f} s"
        for name, own, most in _judged(spent)
        if own.seconds > most.seconds
    ]


def _judged(spent: Mapping[str, Spent]) -> Iterable[tuple[str, Spent, Spent]]:
    """The suite and each file: its name, what it spent, and its budget."""
    yield "the suite", sum(spent.values(), Spent()), Spent(PROGRAMS, SECONDS)
    for file, own in sorted(spent.items()):
        yield file, own, Spent(PROGRAMS_OF_A_FILE, SECONDS_OF_A_FILE)
