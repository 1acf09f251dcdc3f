"""Results that tests read, each computed once: by whoever asks first, and kept for later runs of the suite.

They lie under the user's cache, by what decides about them: the text of the case, what is set, the analyses
that there are, the code. Who changes one takes a copy.
"""

import fcntl
import hashlib
import json
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.study_tables import Study
from pitchpoint.core import kept
from pitchpoint.core.programs import surroundings
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.runs.run import Outcome, compare_case, open_outcomes, run_case

MOST = 200
"""Results that are kept, those of earlier code among them."""


def outcomes(
    case: str | Path,
    *,
    settings: Mapping[str, Any] | None = None,
    studies: Mapping[str, Study] | None = None,
) -> dict[str, Outcome]:
    """Results by variant, as `run_case` gives them, of a shipped case or a file."""
    asked = [settings or {}, {name: repr(study) for name, study in (studies or {}).items()}]

    def compute(folder: Path) -> None:
        run_case(str(case), folder=folder, settings=settings, studies=studies)

    return open_outcomes(_folder([_text(case), [*ANALYSES], asked], compute))


def rows(case: str) -> list[TargetRow]:
    """Printed against computed of a published case."""

    def compute(folder: Path) -> None:
        folder.mkdir()
        found = [asdict(row) for row in compare_case(case)[2]]
        (folder / "rows.json").write_text(json.dumps(found), "utf-8")

    text = (_folder(["rows", case], compute) / "rows.json").read_text("utf-8")
    return [TargetRow(**row) for row in json.loads(text)]


def _text(case: str | Path) -> list[str]:
    """What decides about a case: of a shipped one the code does."""
    path = Path(case)
    return [path.name, path.read_text("utf-8") if path.is_file() else ""]


def _folder(asked: Any, compute: Callable[[Path], None]) -> Path:
    """Folder of a result, whole: another worker that computes it is waited for."""
    digest = hashlib.sha256(json.dumps([surroundings(), asked]).encode()).hexdigest()
    bank = kept.prepared_folder(kept.base_folder() / "bank")
    assert bank is not None
    place = bank / digest[:40]
    with _alone(bank / f"{digest[:40]}.lock"):
        if not (place / "done").exists():
            shutil.rmtree(place, ignore_errors=True)
            place.mkdir()
            compute(place / "out")
            (place / "done").touch()
            _make_room(bank)
        (place / "done").touch()  # was asked for last
    return place / "out"


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)  # given back as the file closes
        yield


def _make_room(bank: Path) -> None:
    by_use = sorted(bank.glob("*/done"), key=lambda done: done.stat().st_mtime_ns)
    for done in by_use[:-MOST]:
        shutil.rmtree(done.parent, ignore_errors=True)
