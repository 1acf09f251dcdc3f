"""Looks at reports of examples and published cases: `python tests/long/every_report.py FOLDER [NAME ...]`.

Results are kept in FOLDER, one folder a case; what is there is not computed again, an interrupted run goes
on. Each report is written anew, opened 1280 px wide, light and dark, and 500 px wide, and printed. What is
cut, empty, overlapping, too high or too large is told; pictures and the PDF are left in FOLDER/NAME.seen.
So is what is wrong with the first screen of the terminal.
"""

import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from browser import Browser, browser
from screens import faults_of_the_screen
from seen import faults_on_paper, faults_on_screen, pages, whole

from pitchpoint.cases.library import names
from pitchpoint.runs.run import open_result, run
from pitchpoint.views.report import write_report

EXAMPLES = Path(__file__).parents[2] / "examples"
WINDOWS = ((1280, "light"), (1280, "dark"), (500, "light"))


def cases() -> dict[str, str]:
    """Examples by name of their file, and published cases."""
    files = sorted(EXAMPLES.glob("*.toml"))
    return {file.stem: str(file) for file in files} | {name: name for name in names()}


def report(case: str, folder: Path) -> Path:
    """The report of a result that is kept, computed before where it is not finished."""
    kept = open_result(folder) if (folder / "run.json").exists() else {}
    if not kept or not all(one.manifest["finished"] for one in kept.values()):
        kept = run(case, folder=folder)
    write_report(kept, folder / "report.html")
    return folder / "report.html"


def faults(page: Browser, path: Path, pictures: Path) -> Iterator[str]:
    """What is wrong with a report on screens and on paper; pictures of each."""
    pictures.mkdir(exist_ok=True)
    for width, scheme in WINDOWS:
        for fault in faults_on_screen(page, path, width, scheme):
            yield f"{width} px, {scheme}: {fault}"
        page.picture(pictures / f"{width}_{scheme}.png", 0, whole(page))
        if width == 1280:
            size = f"{whole(page)} px, {path.stat().st_size} bytes"
            printed = page.printed()
            (pictures / f"{scheme}.pdf").write_bytes(printed)
            yield from (f"{scheme}, {fault}" for fault in faults_on_paper(page))
            print(f"  {size}, {pages(printed)} pages", flush=True)


def main(folder: Path, names: list[str]) -> int:
    """Status 0 if nothing is wrong with the reports of some cases, or of all."""
    known = cases()
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    with browser() as page:
        for name in names or known:
            print(name, flush=True)
            path = report(known.get(name, name), folder / name)
            of_the_screen = faults_of_the_screen(open_result(folder / name))
            for fault in chain(of_the_screen, faults(page, path, folder / f"{name}.seen")):
                count += 1
                print(f"  {fault}", flush=True)
    print(f"{count} faults")
    return int(count > 0)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
