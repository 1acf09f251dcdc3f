"""All rows of the torus case in steady motion, at six conditions: minutes without optimised programs."""

import numpy as np
from torus_in_print import read

from pitchpoint.cases.library import find_case
from pitchpoint.core.status import Code
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.published.liu_xiong_torus import steady
from pitchpoint.results.target_rows import counts
from pitchpoint.runs.run import compare_case


def test_rows_of_the_corrected_motion_miss_where_flanks_would_pull_and_where_they_ring():
    found = compare_case(find_case("liu_xiong_torus")[0], "physical")[2]
    assert {kind: dict(each) for kind, each in counts(found).items()} == {
        "reference": {"pass": 143, "miss": 4}
    }
    missed = {row.quantity: row.reason for row in found if row.verdict == "miss"}
    assert missed.keys() == {
        "#1 torus, steady state, largest transmission error",
        "#2 torus, steady state, largest transmission error",
        "#5 torus, steady state, part of the time in which flanks pull",
        "#5 standard, steady state, part of the time in which flanks pull",
    }
    assert all(len(reason) > 40 for reason in missed.values())


def test_a_motion_that_a_grid_does_not_resolve_is_no_number(monkeypatch):
    monkeypatch.setattr(steady, "_grid", lambda *_: PeriodGrid(16, 20))
    found = read("steady_slow", "physical").isel(law=0)
    for pair in ("torus", "standard"):
        assert np.all(found[f"{pair}_steady_status"] == Code.UNRESOLVED)
        for name in ("steady_efficiency", "steady_energy_left", "steady_error"):
            assert np.all(np.isnan(found[f"{pair}_{name}"]))
