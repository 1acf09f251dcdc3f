"""Looks at reports of examples and published cases: `python tests/long/every_report.py FOLDER [NAME ...]`.

Pages of many designs are among them: "a study", "tolerances" and "a sizing".

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

from pitchpoint.cases.library import case_names
from pitchpoint.results.store import write_text
from pitchpoint.runs.case import Case
from pitchpoint.runs.run import open_outcomes, run_case
from pitchpoint.runs.study import study
from pitchpoint.sizing.sizing import size
from pitchpoint.views.report import write_report
from pitchpoint.views.sizing_report import render_sizing
from pitchpoint.views.study_report import write_study_folder

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDIES = {
    "a study": {
        "over": {
            "operation.torque": ("20 N m", "90 N m"),
            "gears.face_width": ("12 mm", "24 mm"),
            "gears.profile_shift.1": (0.0, 1.9),
        },
        "how": "sobol",
    },
    "tolerances": {"tolerances": "normal"},
}
WINDOWS = ((1280, "light"), (1280, "dark"), (500, "light"))


def cases() -> dict[str, str]:
    """Examples by name of their file, and published cases."""
    files = sorted(EXAMPLES.glob("*.toml"))
    return {file.stem: str(file) for file in files} | {name: name for name in case_names()}


def report(case: str, folder: Path) -> Path:
    """The report of a result that is kept, computed before where it is not finished."""
    kept = open_outcomes(folder) if (folder / "run.json").exists() else {}
    if not kept or not all(one.manifest["finished"] for one in kept.values()):
        kept = run_case(case, folder=folder)
    write_report(kept, folder / "report.html")
    return folder / "report.html"


def page_of_designs(name: str, folder: Path) -> Path:
    """The page of a study or of a sizing, in its folder."""
    path = folder / "report.html"
    if name == "a sizing":
        sizing = size("60 N m", 60.0, "30 rpm", "5000 h")
        if not folder.exists():
            sizing.write(folder)
        write_text(path, render_sizing(sizing, folder=folder))
        return path
    case, asked = Case(EXAMPLES / "pair_23_61.toml"), STUDIES[name]
    if "tolerances" in asked:
        case = case.set({"gears.inspection": {"thickness_field": "cd25", "iso_class": 6}})
    write_study_folder(study(case, n=256, units="shown", folder=folder, **asked), case, folder)
    return path


def faults_of_designs(page: Browser, path: Path, pictures: Path) -> Iterator[str]:
    """What is wrong with the page of many designs on screens; pictures of each."""
    pictures.mkdir(exist_ok=True)
    for width, scheme in ((1200, "light"), (1200, "dark"), (420, "light")):
        for fault in faults_on_screen(page, path, width, scheme):
            yield f"{width} px, {scheme}: {fault}"
        page.picture(pictures / f"{width}_{scheme}.png", 0, whole(page))


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
        for name in names or [*known, *STUDIES, "a sizing"]:
            print(name, flush=True)
            if name in (*STUDIES, "a sizing"):
                path = page_of_designs(name, folder / name.replace(" ", "_"))
                for fault in faults_of_designs(page, path, folder / f"{path.parent.name}.seen"):
                    count += 1
                    print(f"  {fault}", flush=True)
                continue
            path = report(known.get(name, name), folder / name)
            of_the_screen = faults_of_the_screen(open_outcomes(folder / name))
            for fault in chain(of_the_screen, faults(page, path, folder / f"{name}.seen")):
                count += 1
                print(f"  {fault}", flush=True)
    print(f"{count} faults")
    return int(count > 0)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
