"""Runs killed before any of their file operations go on, and end with the same bytes."""

import json
import subprocess
import sys

import pytest

# A run without gears: parts of a few numbers, one of them in pieces. Each child of it is killed before
# its n-th operation on a file, the run is repeated in the same folder, and what it leaves is compared.
SCRIPT = """
import json, os, signal, sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis
from pitchpoint.cases.record import Record
from pitchpoint.cases.variant import Variant
from pitchpoint.results.store import dataset, load
from pitchpoint.runs import run as running
from pitchpoint.runs.jobs import Job

root = Path(sys.argv[1])
TOUCHES = {"open", "os.chmod", "os.listdir", "os.mkdir", "os.remove", "os.rename", "os.scandir"}


def compute(built, piece, told):
    rows = np.arange(3.0) + piece["number"]
    values = {"mean_loss": (("point",), np.sin(rows)), "locked": (("point",), rows > 4.0)}
    return dataset(values, {}, warnings=[f"piece {piece['number']}"])


def job(name, *numbers):
    pieces = [{"number": number} for number in numbers]
    analysis = Analysis(
        name=name,
        title=name,
        compute=compute,
        pieces=lambda built: pieces,
        joined=lambda built, parts: xr.concat(parts, "point", combine_attrs="override"),
    )
    return Job(analysis, BUILT)


BUILT = SimpleNamespace(case=SimpleNamespace(source=""))
JOBS = [job("teeth", 0), job("study_sweep", 1, 2, 3)]
Variant.built = lambda self, changes: BUILT
TOLD = {"title": "A pair", "implausible": [], "warnings": [], "inputs": [], "source": "", "own": ""}
running._manifest = lambda *_: dict(TOLD)
running._lacking = lambda built: {}
running.resolved_inputs.input_rows = lambda *_: []
running._of_design = lambda variant, built: []
running._rows = lambda *_: []
variant = Variant({}, "pair.toml", "default")


def whole_run(folder):
    with running._own_folder(folder, Record(case="tian2024", variants=["default"]), False):
        running.run_variant(
            variant, JOBS, folder=folder / "default", studies={}, progress=running.Progress()
        )


def killed_before(count, folder):
    # Exit status of a child, or minus the signal that ended it.
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    left = count

    def touched(event, arguments):
        nonlocal left
        if event in TOUCHES and str(folder) in str(arguments[0]):
            left -= 1
            if left == 0:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(touched)
    try:
        whole_run(folder)
        os._exit(0)
    except BaseException as error:
        print(repr(error), file=sys.stderr)
        os._exit(1)


def content(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.*")}


whole_run(root / "whole")
expected, count, ended = content(root / "whole"), 0, -signal.SIGKILL
while ended == -signal.SIGKILL:
    count += 1
    folder = root / f"killed {count}"
    ended = killed_before(count, folder)
    for path in folder.rglob("[!.]*.nc"):
        load(path)
    whole_run(folder)
    assert content(folder) == expected, count
print(json.dumps({"operations": count - 1, "ended": ended, "files": sorted(expected)}))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="has no fork")
def test_a_run_killed_anywhere_goes_on_bit_for_bit(tmp_path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path)], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["ended"] == 0
    assert told["operations"] > 40
    assert told["files"] == [
        "default/case.toml",
        "default/manifest.json",
        "default/study_sweep.nc",
        "default/teeth.nc",
        "run.json",
    ]
