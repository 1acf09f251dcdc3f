"""Which analysis there is for which family, asked of a sample of each."""

from pitchpoint.analyses.registry import ANALYSES
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.runs.run import load_case

__all__ = ["matrix", "page"]

_PAGE = """# Families and analyses

What is computed for a case of each family that holds every table which analyses ask for: yes, or why not.
Printed by `pitchpoint models --matrix` from the registries of families and analyses.

"""


def matrix() -> list[dict[str, str]]:
    """A row for each analysis: its name and title, and for each family yes, or why it is not there."""
    samples = [load_case(str(sample_of(table))) for table in TABLES]
    return [
        {"analysis": analysis.name, "title": analysis.title}
        | {sample.case.gears.family: analysis.lacks(sample) or "yes" for sample in samples}
        for analysis in ANALYSES.values()
    ]


def page() -> str:
    """The matrix as a page of the documentation."""
    rows = matrix()
    _, *columns = rows[0]
    cells = [columns, ["---"] * len(columns), *([row[name] for name in columns] for row in rows)]
    return _PAGE + "".join(f"| {' | '.join(row)} |\n" for row in cells)
