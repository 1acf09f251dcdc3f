"""Which analysis there is for which family, asked of a sample of each."""

import tomllib
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pitchpoint.analyses.analysis import Analysis, Several
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.document import Document
from pitchpoint.cases.models import FILM_SOLVERS
from pitchpoint.cases.validation import with_meshes
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.gears.mesh import has
from pitchpoint.gears.pairs import flanks_in_turn
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.input.tables import tag
from pitchpoint.runs.run import load_case

__all__ = ["matrix", "matrix_page"]

_SEVERAL, _PLANETARY = (
    resources.files("pitchpoint.cases") / f"{name}.toml" for name in ("stages", "planetary")
)

_PAGE = """# Families and analyses

What is computed for a case of each family, for a drive of several stages, and for a planetary set, that holds
every table which analyses ask for, with every solver of films: ✓, or – with the number of the sentence below
that says why not.
`pitchpoint models --matrix` prints it with its sentences, from the registries of families and analyses.

"""


def matrix() -> list[dict[str, str]]:
    """A row for each analysis: its name and title, and for each family yes, or why it is not there."""
    samples = {tag(table): _asking(str(sample_of(table))) for table in TABLES}
    turning = [
        table for table in TABLES if samples[tag(table)][0].transmits and table.load == "torque"
    ]
    extras: list[Mapping[str, Any]] = [*map(_films, FILM_SOLVERS["line"]), _WEAR]
    drives = [_drive(sample_of(table), _sharing(*samples[tag(table)][:1])) for table in turning]
    deviating = {"gears.deviations.iso_class": 6}
    pins = {"gears.pin_tolerance": "20 um"}
    drives += [_drive(sample_of(turning[0]), extra) for extra in extras]
    samples["several stages"] = [*drives, _sets_in_a_row(pins)]
    samples["planetary"] = [*map(_set, (pins, *extras)), _train(deviating)]
    return [
        {"analysis": analysis.name, "title": analysis.title}
        | {name: _why_not(analysis, cases) for name, cases in samples.items()}
        for analysis in ANALYSES.values()
    ]


def _sharing(sample: Ready) -> dict[str, str]:
    """Settings by which teeth that no section says to yield stand in a drive of others that do."""
    (built,) = sample.meshes
    return {} if has(built.design.mesh, tooth_sections) else {"models.load_sharing": "equal"}


def _drive(sample: Path, settings: Mapping[str, Any] = MappingProxyType({})) -> Ready:
    """Two stages of which the second one has the gears of a sample, and tables by these settings."""
    tree, gears = (tomllib.loads(path.read_text("utf-8")) for path in (_SEVERAL, sample))
    tree["stages"][1] |= {key: gears[key] for key in ("gears", "dynamics") if key in gears}
    inside = {f"stages.2.{key}": value for key, value in settings.items()}
    return load_case(tree, settings=_OF_OUTPUT | inside)


def _set(settings: Mapping[str, Any]) -> Ready:
    """A planetary set in a file of its own."""
    return load_case(str(_PLANETARY), settings=_OF_OUTPUT | {**settings})


def _sets_in_a_row(settings: Mapping[str, Any]) -> Ready:
    """Two planetary sets one behind the other, the second one with tables by these settings."""
    tree = tomllib.loads(_PLANETARY.read_text("utf-8"))
    stages = [{key: tree.pop(key) for key in ("gears", "losses")}] * 2
    inside = {f"stages.2.{key}": value for key, value in settings.items()}
    return load_case({**tree, "stages": stages}, settings=inside)


def _train(settings: Mapping[str, Any]) -> Ready:
    """The meshes of a planetary set as stages of a train, the first of them with tables by these settings."""
    tree = tomllib.loads(_PLANETARY.read_text("utf-8"))
    document = with_meshes(Document("planetary.toml", tree))
    spelt = {key: table for key, table in document.tree.items() if key != "gears"}
    inside = {f"stages.1.{key}": value for key, value in settings.items()}
    return load_case(spelt, settings=_OF_OUTPUT | inside)


def _asking(sample: str) -> list[Ready]:
    """The sample, the same with every solver of films that its contacts have, with wear, with all maps."""
    (built,) = load_case(sample).meshes
    solvers = FILM_SOLVERS[built.design.mesh.shape]
    films = [load_case(sample, settings=_films(solver)) for solver in solvers]
    worn = [load_case(sample, settings=_WEAR)] if has(built.design.mesh, flanks_in_turn) else []
    maps = [load_case(sample, settings=_OF_OUTPUT)] if built.transmits else []
    return [built, *films, *worn, *maps]


_OF_OUTPUT = {
    "loss_map.quadrants": 4,
    "duty.file": str(resources.files("pitchpoint.cases") / "at_rest.csv"),
}


_WEAR = {"wear.law": "vdi_2736", "wear.cycles": 1e6, "wear.rate": "1e-9 mm3/(N m)"}
_WEAR |= {"wear.profile": "kept"}


def _films(solver: str) -> dict[str, str]:
    """Settings that ask a solver of films for all that it has."""
    return {"film.solver": solver} | ({} if solver == "line" else {"film.time": "squeeze"})


def _why_not(analysis: Analysis | Several, cases: Sequence[Ready]) -> str:
    """Yes if one of the cases has the analysis, else why the first one has not."""
    reasons = [analysis.why_not(case) for case in cases]
    return "yes" if None in reasons else str(reasons[0])


def matrix_page() -> str:
    """The matrix as a page of the documentation: marks, and below them each reason once."""
    rows = matrix()
    _, title, *columns = rows[0]
    reasons = [*dict.fromkeys(row[name] for row in rows for name in columns if row[name] != "yes")]
    marks = {text: f"–{str(n).translate(_RAISED)}" for n, text in enumerate(reasons, 1)}
    marks["yes"] = "✓"
    heads = ["", *(name.replace("_", " ") for name in columns)]
    cells = [[row[title], *(marks[row[name]] for name in columns)] for row in rows]
    lines = [heads, ["---", *(":---:" for _ in columns)], *cells]
    table = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    footnotes = "".join(f"{n}. {text[0].upper()}{text[1:]}.\n" for n, text in enumerate(reasons, 1))
    return f"{_PAGE}{table}\n{footnotes}"


_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
