"""Short words of what a prompt shows, and access to the parts of a result."""

import json

import numpy as np
import pytest
import xarray as xr
from sound import quick_first

import pitchpoint as pp
from pitchpoint.cases.library import case_names
from pitchpoint.core.doubts import Doubt
from pitchpoint.materials.lubricants import find
from pitchpoint.notebook.figures import Plots
from pitchpoint.results.labelled import flat_attributes
from pitchpoint.results.store import dataset

MOST = 1000


@pytest.fixture(scope="module")
def result() -> pp.Result:
    return pp.run("tian2024", only=["physical"], analyses=["operation", "cycle", "laws"])


def test_reprs_of_a_result_are_short(result):
    every = [
        result,
        result["physical"],
        result.plot,
        *(getattr(result.plot, n) for n in dir(result.plot)),
    ]
    for one in every:
        assert len(repr(one)) < MOST, type(one)
        assert repr(one).count("\n") < 12
    assert "'Tian" in repr(result["physical"]) and "parts cycle" in repr(result["physical"])


def test_a_result_without_figures_says_so(monkeypatch):
    monkeypatch.setattr("pitchpoint.notebook.figures._sections", lambda _: [])
    assert repr(Plots({})) == "Plots of no section: no part that was computed has figures"


@pytest.mark.parametrize("name", quick_first(case_names(), 2))
def test_reprs_of_a_case_are_short(name):
    built = pp.load_case(name)
    models = [model for mesh in built.meshes for model in mesh.models]
    meshes = [mesh.design.mesh for mesh in built.meshes]
    designs = [mesh.design for mesh in built.meshes]
    for one in [pp.Case(name), built, built.operation, built.design, *designs, *meshes, *models]:
        assert len(repr(one)) < MOST, type(one)
        assert type(one).__name__ in repr(one)


def test_reprs_of_arrays_and_laws_are_short():
    model = pp.FilmModel()
    oil = find("pao-vg-150").build()
    line = model.contacts(
        line_load=np.linspace(5e4, 4e5, 8),
        radius=0.01,
        modulus=226e9,
        speed_a=3.0,
        speed_b=2.0,
        oil=oil,
        temperature=333.0,
        roughness_rq=0.4e-6,
    )
    sweep = pp.Sweep(key="operation.torque", start="5 N m", stop="60 N m", count=12)
    for one in [model, line, sweep, pp.Study(sweep=sweep), oil]:
        assert len(repr(one)) < MOST, type(one)


def test_parts_are_attributes_and_keys(result, tmp_path):
    cycle = result.cycle
    xr.testing.assert_identical(cycle, result["cycle"])
    xr.testing.assert_identical(cycle, result.dataset("cycle"))
    assert {"cycle", "operation", "summary"} <= {*dir(result)}
    assert [*result] == ["physical"] and "cycle" not in result
    with pytest.raises(AttributeError, match="did you mean cycle"):
        _ = result.cycel
    with pytest.raises(KeyError, match="no part"):
        _ = result["vibration"]
    assert result.get("cycel") is None


def test_attributes_are_data(result, tmp_path):
    events = result.cycle.attrs["events"]
    assert isinstance(events, list) and all(isinstance(one, float) for one in events)
    kept = result["physical"].parts["cycle"].attrs["events"]  # as files have it
    assert events == json.loads(kept)
    result.cycle.to_netcdf(tmp_path / "cycle.nc", engine="h5netcdf")
    again = xr.load_dataset(tmp_path / "cycle.nc", engine="h5netcdf")
    assert [*again.attrs["events"]] == events
    assert result.attributes("cycle")["solve"]["sentence"] == "a solution was found"
    (outside,) = result.attributes("laws")["outside"]
    assert outside["law"] == "xu_2007"
    assert result.laws.attrs["outside_law"] == ["xu_2007"]
    assert result.laws.attrs["outside_reasons"] == ["; ".join(outside["reasons"])]
    assert result.cycle.attrs["solve_sentence"] == "a solution was found"


def test_no_attribute_is_a_text_of_json(result):
    for part in result.parts:
        for name, value in result.dataset(part).attrs.items():
            values = value if isinstance(value, list) else [value]
            assert all(isinstance(one, str | int | float) for one in values), (part, name)
            assert not any(str(one).startswith(('[{"', '{"', "[[", '["')) for one in values), name


def test_what_is_doubtful_is_flat():
    told = Doubt("the grid is coarse.", moves=0.05, about=("mean_loss", "mean_friction"))
    flat = flat_attributes(dataset({}, {}, warnings=[told], apart=[["a", 1.0], ["b", 2.0]]))
    assert flat["warnings"] == flat["doubts_brief"] == ["the grid is coarse."]
    assert (flat["doubts_moves"], flat["doubts_about"]) == ([0.05], ["mean_loss; mean_friction"])
    assert (flat["apart_1"], flat["apart_2"]) == (["a", "b"], [1.0, 2.0])


def test_a_run_of_chosen_analyses_gives_the_same_numbers(result):
    assert result.parts == ["cycle", "operation", "laws"]
    other = pp.run("tian2024", only=["physical"], analyses=["operation"])
    xr.testing.assert_equal(other.operation, result.operation)
    with pytest.raises(pp.InputError, match="did you mean cycle"):
        pp.run("tian2024", analyses=["cylce"])
    with pytest.raises(pp.InputError, match="list of names"):
        pp.run("tian2024", analyses="cycle")
