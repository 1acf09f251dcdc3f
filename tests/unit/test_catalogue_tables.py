"""Tables of the command line from datasets."""

import numpy as np

from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Outcome
from pitchpoint.views.section_registry import SECTIONS


def test_a_sweep_shows_every_law_by_name():
    values = np.array([[0.97, 0.98], [0.95, 0.96]])
    data = dataset(
        {
            "mean_efficiency": (("law", "point"), values),
            "axis": (("point",), np.array([10.0, 50.0])),
        },
        {"law": ["xu_2007", "constant"]},
        title="Sweep of operation.torque",
        sweep_key="operation.torque",
    )
    parts = {"study_sweep_torque": data, "study_other": data}
    (printed,) = SECTIONS["studies"].screen(Outcome({}, parts))
    assert printed.title == "Sweep of operation.torque"
    told = [[*row.values()] for row in printed.rows]
    assert [one[:2] for one in told] == [
        ["10 N m", "xu_2007"],
        ["10 N m", "constant"],
        ["50 N m", "xu_2007"],
        ["50 N m", "constant"],
    ]
    assert [float(one[2]) for one in told] == [97.0, 95.0, 98.0, 96.0]
