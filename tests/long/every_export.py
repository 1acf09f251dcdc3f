"""Exports the joint of every example, published case and family.

    python tests/long/every_export.py FOLDER [NAME ...]

Results with a small loss map in four quadrants, and with all else that a joint has, are kept in FOLDER, one
folder a case, of its first variant; what is there is not computed again. Each is handed over to every
simulator, as an evaluator and as tables. An error is told, more than two seconds, and a program that is
compiled; status 1 if there is any. Seconds of each export stand behind its name.
"""

import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import jax.monitoring

from pitchpoint._jax import double_precision
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases import library
from pitchpoint.errors import PitchpointError
from pitchpoint.exports.files import EVALUATOR, export
from pitchpoint.exports.simulators import TARGETS, Asked, hand_over
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.input.tables import tag
from pitchpoint.runs.case import selected_variants
from pitchpoint.runs.run import Outcome, load_case, open_outcomes, run_case

EXAMPLES = Path(__file__).parents[2] / "examples"
MOST_SECONDS = 2.0
COMPILED = "/jax/core/compile/backend_compile_duration"
ASKED = {"loss_map.quadrants": 4, "loss_map.count": 5}
PARTS = [
    "cycle",
    "train_period",
    "operation",
    "inspection",
    "load_limits",
    "bodies",
    "reflected",
    "torsion",
    "kinematic_error",
    "four_quadrants",
]
FORMATS = (EVALUATOR, "csv", "mat")


def cases() -> dict[str, str]:
    """Examples by name of their file, published cases, and the sample of each family."""
    files = sorted(EXAMPLES.glob("*.toml"))
    samples = {f"sample of {tag(table)}": str(sample_of(table)) for table in TABLES}
    published = {name: name for name in library.case_names()}
    return {file.stem: str(file) for file in files} | published | samples


def computed(case: str, folder: Path) -> dict[str, Outcome]:
    """The result of a case with its map and what else a joint has; of a folder where it is there."""
    if not (folder / "run.json").exists():
        built = load_case(case, settings=ASKED)
        parts = [name for name in PARTS if ANALYSES[name].why_not(built) is None]
        first = selected_variants(case, [], ASKED)[0].variant
        run_case(case, folder=folder, only=[first], settings=ASKED, analyses=parts)
    return open_outcomes(folder)


def exporters(outcomes: dict[str, Outcome], folder: Path) -> dict[str, Callable[[], object]]:
    """What writes each export, by its name."""
    targets = {name: partial(hand_over, outcomes, folder, [name], Asked()) for name in TARGETS}
    return targets | {name: partial(export, outcomes, folder / name, [name]) for name in FORMATS}


def faults(case: str, folder: Path, seconds: dict[str, float]) -> Iterator[str]:
    """What is wrong with the exports of a case; nothing of a test rig, which drives nothing."""
    if not load_case(case).transmits:
        return
    for name, write in exporters(computed(case, folder), folder / "export").items():
        before, begin = len(PROGRAMS), time.perf_counter()
        try:
            write()
        except PitchpointError as error:
            yield f"{name}: {error}"
        seconds[name], count = time.perf_counter() - begin, len(PROGRAMS) - before
        if seconds[name] > MOST_SECONDS:
            yield f"{name}: took {seconds[name]:.1f} s"
        if count:
            yield f"{name}: compiled {count} programs"


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
        taken: dict[str, float] = {}
        try:
            found = [*faults(known[name], folder / name, taken)]
        except PitchpointError as error:
            found = [str(error)]
        wrong += len(found)
        paces = ", ".join(f"{target} {seconds:.2f}" for target, seconds in taken.items())
        print(f"{name}: {'; '.join(found) or 'fine'} ({paces})", flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
