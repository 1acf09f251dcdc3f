"""Runs every benchmark once, as it is or small, and tells what each took and found.

    .venv/bin/python benchmarks/every.py --small

A benchmark fails that stops, that does not agree with its rival, or that ends without its line of figures.
Rivals that need an environment of their own are left out. Programs that were compiled before are not used.
`--record` puts the figures of a whole run into the row of this commit in `figures.csv`.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import figures

FOLDER = Path(__file__).parent
NONE_OF_THEM = {"accelerator", "bench", "every", "figures", "pace"}


def run(path: Path, small: bool, cache: str) -> dict[str, float] | None:
    """Figures of one benchmark, after its last line and its seconds are printed; None if it failed."""
    before, command = os.times(), [sys.executable, str(path), *["--small"] * small]
    environment = os.environ | {"XDG_CACHE_HOME": cache}
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True)
    after = os.times()
    seconds = sum(after[2:4]) - sum(before[2:4])
    last = (done.stdout.splitlines() or [""])[-1]
    name, _, told = last.removeprefix("benchmark ").partition(" ")
    good = done.returncode == 0 and name == path.stem
    print(f"{seconds:6.1f} s  {last if good else f'{path.name} FAILS'}", flush=True)
    if not good:
        print(done.stdout)
        return None
    return {key: float(value) for key, _, value in (part.partition("=") for part in told.split())}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--small", action="store_true", help="once and little, as CI has it")
    parser.add_argument("--record", action="store_true", help="put the figures into the table")
    parser.add_argument("names", nargs="*", help="benchmarks; all of them if none is named")
    asked = parser.parse_args()
    paths = [path for path in sorted(FOLDER.glob("*.py")) if path.stem not in NONE_OF_THEM]
    names = asked.names or [path.stem for path in paths]
    begun, found = time.perf_counter(), {}
    with tempfile.TemporaryDirectory() as cache:
        for path in paths:
            if path.stem in names:
                found[path.stem] = run(path, asked.small, cache)
    failed = [name for name, own in found.items() if own is None]
    print(f"{len(found)} benchmarks in {time.perf_counter() - begun:.0f} s, {len(failed)} failed")
    if asked.record and not asked.small:
        figures.record(
            {
                f"{name}.{key}": value
                for name, own in found.items()
                for key, value in (own or {}).items()
            }
        )
    return len(failed)


if __name__ == "__main__":
    sys.exit(main())
