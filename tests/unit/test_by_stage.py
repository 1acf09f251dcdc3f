"""Datasets of stages as one: texts united, numbers by position, and each of them back as it was."""

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import Doubt
from pitchpoint.results.by_stage import by_stage, of_stage, stages_of
from pitchpoint.results.netcdf import decode, encode
from pitchpoint.results.store import dataset


def stage(
    phases: list[float], cases: list[str], **more: tuple[tuple[str, ...], object]
) -> xr.Dataset:
    """Dataset with numbers and texts along dimensions, and times beside the moments."""
    count = len(phases)
    data = dataset(
        {
            "load": (
                ("phase", "case"),
                np.arange(count * len(cases), dtype=float).reshape(count, -1),
            ),
            "active": (("phase",), np.arange(count) % 2 == 0),
            "steps": (("moment",), np.arange(count + 1)),
            "depth": ((), 0.5),
            **more,
        },
        {
            "phase": ("phase", phases),
            "case": cases,
            "time": ("moment", np.linspace(0.0, 1.0, count + 1)),
        },
        title="of a mesh",
        warnings=[Doubt(f"{count} phases are few.", brief="few phases")],
        asked=count,
    )
    data["load"].attrs["units"] = "N"
    return data


def test_stages_come_back_as_they_were() -> None:
    each = {
        2: stage([0.1, 0.2, 0.4], ["nominal"]),
        1: stage([0.3, 0.9], ["nominal", "least"], name=(("case",), ["a", "b"])),
    }
    held = {number: decode(encode(data)) for number, data in each.items()}
    whole = decode(encode(by_stage(held)))
    assert stages_of(whole) == (2, 1)
    assert whole["load"].dims == ("stage", "phase_number", "case")
    assert whole["phase"].dims == ("stage", "phase_number")
    assert whole["load"].sel(stage=1, case="least").values.tolist()[:2] == [1.0, 3.0]
    assert np.isnan(whole["load"].sel(stage=2, case="least")).all()
    assert "Stage 1: 2 phases are few." in whole.attrs["warnings"]
    for number, data in each.items():
        there = of_stage(whole, number)
        assert there.drop_attrs().identical(data.drop_attrs())
        assert {name: v.dtype.kind for name, v in there.variables.items()} == {
            name: v.dtype.kind for name, v in data.variables.items()
        }
        assert there["load"].attrs["units"] == "N"
        assert there.attrs == data.attrs


def test_numbers_that_all_stages_have_stay_a_coordinate() -> None:
    whole = by_stage({1: stage([0.5], ["nominal"]), 2: stage([0.5], ["nominal"])})
    assert whole["phase"].dims == ("phase",)
    assert whole["load"].dims == ("stage", "phase", "case")
    assert whole["steps"].dtype.kind == "i"


def test_a_dimension_of_one_stage_alone_stays_its_own() -> None:
    more = stage([0.5], ["nominal"], share=(("order",), [0.2, 0.8])).assign_coords(order=[1.0, 2.0])
    whole = by_stage({1: stage([0.5], ["nominal"]), 2: more})
    assert whole["order"].values.tolist() == [1.0, 2.0]
    assert of_stage(whole, 2).drop_attrs().identical(more.drop_attrs())
    assert "share" not in of_stage(whole, 1)
