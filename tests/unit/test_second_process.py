"""What one process has compiled, no later one compiles again, though texts of the package have changed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from sound import PAIR

import pitchpoint

MATERIALS = """
[materials]
gear_1 = "steel"
gear_2 = "steel"
[models]
friction = "constant"
"""
GEARS = PAIR.replace("[23, 61]", "[18, 36]").replace("2 mm", "3 mm")
CASE = GEARS.replace("75W90-A", "pao-vg-220") + MATERIALS

# Runs a case, and tells how often a program was asked for, found and compiled.
SCRIPT = """
import sys
from collections import Counter

from pitchpoint._jax import jax
from pitchpoint.runs.run import run_case
from pitchpoint.cases.study_tables import Study, Sweep

told = Counter()
jax.monitoring.register_event_listener(lambda event, **_: told.update([event]))
run_case(sys.argv[1])
cache = "/jax/compilation_cache/"
first = [told[cache + name] for name in ("compile_requests_use_cache", "cache_hits", "cache_misses")]
other = {
    "gears.teeth": [23, 61],
    "gears.profile_shift": [0.3, -0.1],
    "operation.torque": "20 N m",
    "operation.speed": "900 rpm",
    "lubricant.name": "75W90-A",
}
sweep = Sweep(key="operation.temperature", start="50 degC", stop="70 degC", count=3)
run_case(sys.argv[1], settings=other, studies={"warm": Study(sweep=sweep)})
import pitchpoint
assert pitchpoint.__file__.startswith(sys.argv[1].rpartition("/")[0]), pitchpoint.__file__
print(*first, told[cache + "compile_requests_use_cache"] - first[0])
"""


def run_once(case: Path, home: Path) -> tuple[int, int, int, int]:
    """Programs that a process of its own asked for, found in the cache, and had to compile.

    Last comes how many more a second pair of other teeth, torque, speed and oil asked for, with a sweep.
    """
    environment = {
        **os.environ,
        "XDG_CACHE_HOME": str(home),
        "JAX_PLATFORMS": "cpu",
        "PYTHONPATH": str(case.parent),  # where a copy of the package lies
    }
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(case)],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    asked, found, missed, more = map(int, done.stdout.split()[-4:])
    return asked, found, missed, more


def programs(home: Path) -> set[str]:
    """Compiled programs on disk; the files beside them hold the time of last use."""
    kept = {
        path.name for path in home.rglob("xla-*/*") if path.is_file() and "-atime" not in path.name
    }
    return kept - traced(home).keys()


def traced(home: Path) -> dict[str, int]:
    """Programs as they are after tracing, on disk, each by the file that it was written to."""
    return {path.name: path.stat().st_ino for path in home.rglob("programs/*")}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[tuple]:
    folder = tmp_path_factory.mktemp("second_process")
    case, home = folder / "case.toml", folder / "cache"
    case.write_text(CASE, encoding="utf-8")
    package = folder / "pitchpoint"
    shutil.copytree(Path(pitchpoint.__file__).parent, package)
    found = []
    for _ in range(2):
        found.append((run_once(case, home), programs(home), traced(home)))
        for file in (
            "views/picture.py",
            "lubrication/friction_coefficient.py",
            "efficiency/summary.py",
        ):
            text = (package / file).read_text(encoding="utf-8")
            changed = text.replace('"""', '"""# Said otherwise.\n', 1) + "\n# A comment.\n"
            (package / file).write_text(changed, encoding="utf-8")
    return found


@pytest.mark.whole
def test_the_first_process_keeps_what_it_compiles(runs):
    (_, _, missed, _), kept, _ = runs[0]
    assert missed > 0
    assert len(kept) == missed


@pytest.mark.whole
def test_the_second_process_compiles_nothing(runs):
    (first, kept, _), (second, kept_after, _) = runs
    asked, found, missed, _ = second
    assert missed == 0
    assert found == asked == first[0] > 0
    assert kept_after == kept


@pytest.mark.whole
def test_the_second_process_traces_nothing_that_was_kept(runs):
    (_, _, before), (_, _, after) = runs
    assert len(before) > 5
    assert after == before


@pytest.mark.whole
def test_another_pair_and_a_sweep_ask_for_no_other_program(runs):
    assert [more for (*_, more), _, _ in runs] == [0, 0]
