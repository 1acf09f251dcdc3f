"""Tian, Wang, Jiang (2024): every printed number within what the print supports.

Excluded: the 98.03 % quoted from another reference, whose model and conditions are not given, and
figures 4, 5, 9, 10, 11 and 12, which carry no numbers in the text.
"""

import dataclasses

import bank
import pytest

from pitchpoint.analyses.comparison import compare
from pitchpoint.cases.library import find
from pitchpoint.cases.variant import Variant
from pitchpoint.results.target_rows import counts
from pitchpoint.runs.jobs import jobs


@pytest.fixture(scope="module")
def rows():
    return bank.rows("tian2024")


def computed(changes):
    """Comparison of the case with some inputs changed."""
    name, tree = find("tian2024")
    variant = Variant(tree, name, "as_published", changes)
    targets = variant.built({}).case.targets
    needed = {f"study_{target.study}" for target in targets}
    parts = {
        job.name: job.compute(job.pieces[0]) for job in jobs(variant, {}) if job.name in needed
    }
    return compare(targets, parts)


def test_every_row_passes_or_is_excluded_with_a_reason(rows):
    missed = [row for row in rows if row.verdict == "miss"]
    assert not missed
    assert all(row.reason for row in rows if row.verdict == "excluded")


def test_rows_are_counted_for_each_kind(rows):
    assert {kind: dict(found) for kind, found in counts(rows).items()} == {
        "predicted": {"pass": 13},
        "definition": {"pass": 3},
        "calibrated": {"pass": 14},
        "fitted": {"pass": 4},
        "excluded": {"excluded": 1},
    }


@pytest.mark.parametrize(
    "changes",
    [
        {"roughness.ra": "0.808 um"},
        {"lubricant.viscosity_40": "101.764 mm2/s", "lubricant.viscosity_100": "15.656 mm2/s"},
    ],
    ids=["Ra 1 % higher", "viscosity 3 % higher"],
)
def test_a_small_change_of_the_inputs_makes_rows_miss(changes):
    assert [row.quantity for row in computed(changes) if row.verdict == "miss"]


def test_a_reading_of_the_paper_is_not_in_the_library():
    from pitchpoint.lubrication.registry import LAWS

    assert not [law.name for law in LAWS if "tian" in law.name]


def test_rows_carry_units_of_the_print(rows):
    units = {row.unit for row in rows}
    assert units == {"1", "%", "N m"}
    assert all(dataclasses.asdict(row)["where"] for row in rows)
