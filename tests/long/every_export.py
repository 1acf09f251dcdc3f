"""Exports the joint of every example and family: `python tests/long/every_export.py FOLDER [NAME ...]`.

Results with the loss map in four quadrants are kept in FOLDER, one folder a case; what is there is not
computed again. Each is handed over to every simulator. An error is told, more than two seconds, and a program
that is compiled; status 1 if there is any.
"""

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import jax.monitoring

from pitchpoint._jax import double_precision
from pitchpoint.errors import PitchpointError
from pitchpoint.exports.simulators import TARGETS, Asked, hand_over
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.input.tables import tag
from pitchpoint.runs.run import load_case, open_result, run

EXAMPLES = Path(__file__).parents[2] / "examples"
MOST_SECONDS = 2.0
COMPILED = "/jax/core/compile/backend_compile_duration"
ASKED = {"loss_map.quadrants": 4}


def cases() -> dict[str, str]:
    """Examples by name of their file, and the sample of each family."""
    files = sorted(EXAMPLES.glob("*.toml"))
    samples = {f"sample of {tag(table)}": str(sample_of(table)) for table in TABLES}
    return {file.stem: str(file) for file in files} | samples


def faults(case: str, folder: Path) -> Iterator[str]:
    """What is wrong with the exports of a case; nothing of a test rig, which drives nothing."""
    if not load_case(case).transmits:
        return
    if not (folder / "run.json").exists():
        run(case, folder=folder, settings=ASKED, analyses=["operation", "four_quadrants"])
    outcomes = open_result(folder)
    for target in TARGETS:
        before, begin = len(PROGRAMS), time.perf_counter()
        try:
            hand_over(outcomes, folder / "export", [target], Asked())
        except PitchpointError as error:
            yield f"{target}: {error}"
        seconds, count = time.perf_counter() - begin, len(PROGRAMS) - before
        if seconds > MOST_SECONDS:
            yield f"{target}: took {seconds:.1f} s"
        if count:
            yield f"{target}: compiled {count} programs"


PROGRAMS: list[float] = []
"""Seconds of each program that was compiled."""


def listen(event: str, seconds: float, **_: object) -> None:
    """Keeps account of compilations."""
    if event == COMPILED:
        PROGRAMS.append(seconds)


@double_precision()
def main(folder: Path, names: list[str]) -> int:
    """Status 0 if all exports of some cases, or of all, are there in time."""
    jax.monitoring.register_event_duration_secs_listener(listen)
    known, wrong = cases(), 0
    for name in names or known:
        try:
            found = [*faults(known[name], folder / name)]
        except PitchpointError as error:
            found = [str(error)]
        wrong += len(found)
        print(f"{name}: {'; '.join(found) or 'fine'}", flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
