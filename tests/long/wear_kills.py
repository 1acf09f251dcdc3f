"""Marches of wear that are killed at random instants: the same command goes on, and ends with the same bits.

    .venv/bin/python tests/long/wear_kills.py [kills [seed]]

Two marches run in peace, the second with compiled programs, by which instants are drawn. Others of the same
case are killed (SIGKILL, with all their children) again and again: at instants uniform over start-up, march
and writes, then while a step is being written, then while the whole is. At last some are stopped by Ctrl-C.
Prints where the kills fell, and ends with an error if any byte of the results differs, or if Ctrl-C is not
answered by one sentence.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr

from pitchpoint.results.store import load

CASE = """
[gears]
teeth = [23, 61]
module = "2 mm"
face_width = "20 mm"
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
torque = "50 N m"
speed = "1500 rpm"
temperature = "60 degC"
[models]
load_sharing = "from_stiffness"
friction = { name = "constant", coefficient = 0.05 }
[wear]
law = "archard_1953"
cycles = 3e6
coefficient = 2e-7
hardness = "2 GPa"
cells = 80
phases = 60
tolerance = 1e-6
"""
WRITES = 10
INTERRUPTS = 5
POLL = 2e-4  # s
STEP = re.compile(r"wear\.[0-9]{4}\.nc")

Due = Callable[[Path], bool]


class Marches:
    """Runs of the case in processes of their own.

    Attributes:
        command: that runs the case, without its folder.
        environment: with a cache of its own.
    """

    def __init__(self, folder: Path) -> None:
        """Write the case."""
        case = folder / "wear.toml"
        case.write_text(CASE, "utf-8")
        self.command = [sys.executable, "-m", "pitchpoint", "run", str(case), "--output"]
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}

    def begun(self, folder: Path) -> "subprocess.Popen[str]":
        """A run that begins, or goes on, as the head of its own group of processes."""
        return subprocess.Popen(
            [*self.command, str(folder)],
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            # Shells let what runs behind ignore it.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )

    def whole(self, folder: Path) -> float:
        """Run to the end, and the time that took [s]."""
        began = time.monotonic()
        process = self.begun(folder)
        _, told = process.communicate()
        if process.returncode:
            sys.exit(f"a run that nobody stopped ended with {process.returncode}: {told}")
        return time.monotonic() - began

    def stopped(self, folder: Path, due: Due, how: int) -> tuple[bool, str]:
        """Run until a signal is due; True if it came before the end, and what was told."""
        process = self.begun(folder)
        while process.poll() is None:
            if due(folder / "default"):
                os.killpg(process.pid, how)
                break
            time.sleep(POLL)
        _, told = process.communicate()
        if process.returncode > 0 and how == signal.SIGKILL:
            sys.exit(f"a run ended with {process.returncode}: {told}")
        return process.returncode != 0, told


def after(seconds: float) -> Due:
    """Due at an instant from now."""
    instant = time.monotonic() + seconds
    return lambda _: time.monotonic() >= instant


def writing(start: str, wait: int = 0) -> Due:
    """Due while a file whose half-written name begins like this is on disk, for the so many-th of them."""
    seen: set[str] = set()

    def due(folder: Path) -> bool:
        seen.update(name for name in _names(folder) if name.startswith(start))
        return len(seen) > wait

    return due


def steps_of(number: int) -> Due:
    """Due once so many steps are on disk."""
    return lambda folder: _steps(folder) >= number


def _steps(folder: Path) -> int:
    return sum(bool(STEP.fullmatch(name)) for name in _names(folder))


def _names(folder: Path) -> list[str]:
    return os.listdir(folder) if folder.is_dir() else []


def place(folder: Path) -> str:
    """Where in a run it was stopped, from what it left."""
    names = _names(folder)
    steps = _steps(folder)
    if any(name.startswith(".wear.") for name in names):
        return "while a step was being written"
    if any(name.startswith(".wear-") for name in names):
        return "while the whole was being written"
    if "wear.nc" in names:
        return "while steps were being removed" if steps else "after the march"
    return "in the march" if steps else "before the first step"


def results(folder: Path) -> dict[str, bytes]:
    """Bytes of all datasets of a run."""
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.nc"))}


def differences(found: Path, expected: Path) -> list[str]:
    """Names of datasets that differ in any byte, or in anything that is read from them."""
    one, other = results(found), results(expected)
    wrong = [name for name in {*one, *other} if one.get(name) != other.get(name)]
    if not wrong:
        pair = load(found / "wear.nc"), load(expected / "wear.nc")
        xr.testing.assert_identical(*pair)
    return sorted(wrong)


def main(kills: int, seed: int) -> int:
    """Run, kill and compare; 1 where anything differs."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        marches = Marches(root)
        first = marches.whole(root / "first")
        time_taken = marches.whole(root / "peace")
        expected = root / "peace" / "default"
        count = load(expected / "wear.nc").sizes["step"] - 1
        print(
            f"undisturbed: {first:.1f} s, with compiled programs {time_taken:.1f} s, {count} steps"
        )
        wrong = differences(root / "first" / "default", expected)

        def at_random() -> Due:
            return after(float(rng.uniform(0.0, time_taken)))

        def in_a_step() -> Due:
            return writing(".wear.", int(rng.integers(1, 1 + count // 4)))

        def in_the_whole() -> Due:
            return writing(".wear-")

        rounds = [(kills, at_random), (WRITES, in_a_step), (WRITES, in_the_whole)]
        for wanted, drawn in rounds:
            where: Counter[str] = Counter()
            number = 0
            while where.total() < wanted:
                number += 1
                kept = root / f"{drawn.__name__}{number}"
                while where.total() < wanted:
                    cut, _ = marches.stopped(kept, drawn(), signal.SIGKILL)
                    if not cut:
                        break
                    where[place(kept / "default")] += 1
                marches.whole(kept)
                wrong += differences(kept / "default", expected)
            print(f"\n{where.total()} kills {drawn.__name__.replace('_', ' ')}, {number} marches")
            for what, times in where.most_common():
                print(f"    {times:4d}  {what}")
            sys.stdout.flush()

        kept, unheard = root / "interrupted", False
        for number in range(INTERRUPTS):
            due = steps_of(1 + number * (count - 2) // INTERRUPTS)
            cut, told = marches.stopped(kept, due, signal.SIGINT)
            sentence = told.strip().splitlines()[-1:]
            unheard |= not cut or "Traceback" in told
            print(f"Ctrl-C, {_steps(kept / 'default')} steps on disk: {' '.join(sentence)}")
        marches.whole(kept)
        wrong += differences(kept / "default", expected)
    print(f"\n{'other bits in ' + ', '.join(wrong) if wrong else 'the same bits everywhere'}")
    return int(bool(wrong or unheard))


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]] + [50, 1][len(sys.argv) - 1 :]
    sys.exit(main(*given))
