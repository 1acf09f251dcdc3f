"""Marches of wear that are killed at random instants: each goes on, and ends with the same bits.

    .venv/bin/python tests/long/killed_marches.py [kills [seed]]

One march runs in peace. Others of the same case are killed again and again, each time after a random part
of the time that the first one took, until there were as many kills as asked for. Ends with an error if any
byte of the depths differs.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

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
[wear]
law = "archard_1953"
cycles = 1e8
coefficient = 2e-7
hardness = "2 GPa"
phases = 48
tolerance = 1e-5
"""
RUN = """
import sys
from pitchpoint.analyses.registry import ANALYSES
from pitchpoint.analyses.wear import WEAR
from pitchpoint.runs.run import run
ANALYSES._entries = {"wear": WEAR}
print("begun", flush=True)
run(sys.argv[1], folder=sys.argv[2])
"""


def started(case: Path, folder: Path) -> "subprocess.Popen[bytes]":
    """A run in a process of its own, once it has imported what it needs."""
    command = [sys.executable, "-c", RUN, str(case), str(folder)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.readline()
    return process


def main(kills: int = 50, seed: int = 1) -> None:
    """Run, kill and compare."""
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case = folder / "wear.toml"
        case.write_text(CASE, "utf-8")
        began = time.monotonic()
        assert started(case, folder / "whole").wait() == 0
        whole = time.monotonic() - began
        killed, rounds, same = 0, 0, True
        expected = load(folder / "whole" / "default" / "wear.nc")["worn_depth"].values.tobytes()
        while killed < kills:
            rounds += 1
            kept = folder / f"killed{rounds}"
            ended = False
            while not ended and killed < kills:
                process = started(case, kept)
                try:
                    ended = process.wait(timeout=float(rng.uniform(0.0, 0.5)) * whole) == 0
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
                    killed += 1
            if not ended:
                assert started(case, kept).wait() == 0
            found = load(kept / "default" / "wear.nc")["worn_depth"].values.tobytes()
            same &= found == expected
    print(
        f"{killed} kills in {rounds} marches of {whole:.1f} s: {'the same bits' if same else 'other bits'}"
    )
    sys.exit(0 if same else 1)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
