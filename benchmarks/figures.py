"""The table of figures over commits, `figures.csv`: one row a commit, one column a figure.

The recorded figure is the last one of its column: what was not measured of a commit is left empty.
"""

import csv
import subprocess
from collections.abc import Mapping
from datetime import date
from pathlib import Path

TABLE = Path(__file__).with_name("figures.csv")
GROWTH = 1.1
"""How many times its recorded figure one may be."""

Row = dict[str, str]


def rows(table: Path = TABLE) -> list[Row]:
    """Rows as they were recorded, the oldest first."""
    if not table.exists():
        return []
    with table.open(newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def recorded(table: Path = TABLE) -> dict[str, float]:
    """The last figure of each column."""
    last = {key: value for row in rows(table) for key, value in row.items() if value}
    return {key: float(value) for key, value in last.items() if key not in ("date", "commit")}


def record(figures: Mapping[str, float], table: Path = TABLE) -> None:
    """Put figures into the row of today's commit, which is added if it is not the last one."""
    asked = ["git", "describe", "--always", "--dirty", "--abbrev=10"]
    commit = subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()
    own: Row = {"date": date.today().isoformat(), "commit": commit}
    kept = rows(table)
    if kept and kept[-1]["commit"] == commit:
        own = kept.pop() | own
    kept.append(own | {key: f"{value:.4g}" for key, value in figures.items()})
    columns = dict.fromkeys(key for row in kept for key in row)
    with table.open("w", newline="", encoding="utf-8") as lines:
        writer = csv.DictWriter(lines, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(kept)


def grown(figures: Mapping[str, float], table: Path = TABLE) -> list[str]:
    """Names of figures that are more than a tenth above what was recorded."""
    before = recorded(table)
    return [key for key, value in figures.items() if value > GROWTH * before.get(key, value)]
