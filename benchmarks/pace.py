"""What a later run costs: processor time over that of the import of jax and xarray, modules, memory.

    .venv/bin/python benchmarks/pace.py --check

Each run of the command line has an empty cache of its own, is run once to fill it, and then in turn with the
import, so that a drift of the machine meets both alike; the least of each counts. `--check` fails where a
ratio or a number of modules is more than a tenth above the last one in `figures.csv`, and for a ratio only
where that is seen in every one of some tries: processor time is never less than the work needs, and often
more. `--record` puts the figures into the row of this commit. First runs are told and not checked.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import figures

ROOT = Path(__file__).parent.parent
RUNS = {
    "tian2024": "tian2024",
    "pair": str(ROOT / "examples" / "pair_23_61.toml"),
    "strain_wave": str(ROOT / "examples" / "strain_wave.toml"),
}
TURNS, TRIES = 3, 4

IMPORT = "import jax, xarray"
COMMAND = """
import atexit, sys
sys.modules["dask"] = None
def count():
    own = sum(name.partition(".")[0] == "pitchpoint" for name in sys.modules)
    print("modules", own, len(sys.modules), file=sys.stderr)
atexit.register(count)
del sys.argv[0]
exec(open(sys.argv[0]).read())
"""
"""The script of the command line, with the modules that it ends with on the error stream.

Dask is hidden as an installation without the extra has it: xarray loads it, with 237 modules and .3 s of the
processor, into every run of an environment where it is installed, as that of the tests is.
"""


class Spent(NamedTuple):
    """Processor time [s], largest memory [MB], and modules at the end: of the package, and all."""

    seconds: float
    memory: float
    own: int
    modules: int


def spent(cache: Path, program: str, *arguments: str) -> Spent:
    """What a Python process took."""
    command = [sys.executable, "-c", program, *arguments]
    environment = os.environ | {"XDG_CACHE_HOME": str(cache)}
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ) as process:
        told = process.stderr.read() if process.stderr else ""
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(arguments)} stops:\n{told}")
    counts = [line.split()[1:] for line in told.splitlines() if line.startswith("modules ")]
    own, modules = map(int, counts[-1] if counts else (0, 0))
    return Spent(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, own, modules)


class Run:
    """A run of the command line with a cache and a folder of its own."""

    def __init__(self, folder: Path, name: str) -> None:
        self.name, self.folder, self.count = name, folder, 0
        self.first = self.once().seconds

    def once(self) -> Spent:
        """One run, in a folder without results."""
        self.count += 1
        script = str(Path(sys.executable).with_name("pitchpoint"))
        arguments = ["run", RUNS[self.name], "-o", str(self.folder / str(self.count))]
        return spent(self.folder / "cache", COMMAND, script, *arguments)

    def measured(self) -> dict[str, float]:
        """Figures of later runs, with the least of some in turn with the import."""
        later, imports = [], []
        for _ in range(TURNS):
            imports.append(spent(self.folder, IMPORT).seconds)
            later.append(self.once())
        least = min(later)
        return {
            f"{self.name}.ratio": least.seconds / min(imports),
            f"{self.name}.own_modules": least.own,
            f"{self.name}.modules": least.modules,
            f"{self.name}.memory": least.memory,
            f"{self.name}.seconds": least.seconds,
            f"{self.name}.first_seconds": self.first,
        }


CHECKED = ("ratio", "own_modules", "modules")


def too_much(found: dict[str, float]) -> list[str]:
    """Figures that are checked and have grown."""
    return [key for key in figures.grown(found) if key.partition(".")[2] in CHECKED]


@contextmanager
def started(name: str) -> Iterator[Run]:
    """A run whose programs are kept by now."""
    with tempfile.TemporaryDirectory() as folder:
        yield Run(Path(folder), name)


def measured(name: str, check: bool) -> dict[str, float]:
    """Figures of a run, the least of some tries as long as they have grown."""
    with started(name) as run:
        found = run.measured()
        for _ in range(TRIES - 1):
            if not check or not too_much(found):
                break
            again = run.measured()
            found = {key: min(value, again[key]) for key, value in found.items()}
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--check", action="store_true", help="fail where a figure has grown")
    parser.add_argument("--record", action="store_true", help="put the figures into the table")
    parser.add_argument("names", nargs="*", help=f"of {', '.join(RUNS)}; all if none is named")
    asked = parser.parse_args()
    begun, found, before = time.perf_counter(), {}, figures.recorded()
    for name in asked.names or RUNS:
        own = measured(name, asked.check)
        for key, value in own.items():
            last = f"recorded {before[key]:.4g}" if key in before else ""
            print(f"{key:28}{value:10.4g}  {last}", flush=True)
        found |= own
    print(f"in {time.perf_counter() - begun:.0f} s")
    if asked.record:
        figures.record(found)
    grown = too_much(found) if asked.check else []
    for key in grown:
        print(f"{key} is {found[key]:.4g}, more than a tenth above {before[key]:.4g}")
    return len(grown)


if __name__ == "__main__":
    sys.exit(main())
