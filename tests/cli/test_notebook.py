"""The README's pair at a Python prompt: results, datasets, figures, studies of many designs, derivatives."""

import dataclasses
import math
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go
import pytest
import scipy.optimize
import xarray as xr
from xarray.plot.utils import label_from_attrs

import pitchpoint as pp
from pitchpoint._jax import jax, jnp
from pitchpoint.notebook.differences import OTHER_FORM, STILL, derivative_of
from pitchpoint.results.labelled import in_units
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Progress, with_user_law

SHIFT, TORQUE, WARM = "gears.profile_shift.1", "operation.torque", "operation.temperature"
PAIR = pp.Case(
    {
        "title": "First <stage> of a robot joint",
        "gears": {
            "teeth": [23, 61],
            "module": "2 mm",
            "face_width": "18 mm",
            "profile_shift": [0.4, -0.2],
        },
        "lubricant": {"name": "pao-vg-150"},
        "roughness": {"ra": "0.4 um"},
        "operation": {"torque": "60 N m", "speed": "1200 rpm", "temperature": "50 degC"},
        "models": {"friction": ["iso_tr_14179_2", "xu_2007"], "load_sharing": "sanchez_2017"},
        "loss_map": {"count": 3},
    }
)


@pytest.fixture(scope="module")
def result() -> pp.Result:
    return pp.run(PAIR)


# ---- results


def test_a_result_is_still_its_outcomes_by_variant(result: pp.Result) -> None:
    assert [*result] == ["default"]
    assert "efficiency" in result["default"].parts["cycle"]


def test_a_result_says_in_few_lines_what_it_is(result: pp.Result) -> None:
    told = repr(result).splitlines()
    assert told[0] == "Result('First <stage> of a robot joint')"
    assert told[1].startswith("  default: mean efficiency 99.63 % (iso_tr_14179_2), 98.67 % (xu_")
    assert len(told) == 3


def test_in_a_notebook_nothing_of_a_case_is_markup(result: pp.Result) -> None:
    page = result._repr_html_()
    HTMLParser().feed(page)
    assert "First &lt;stage&gt; of a robot joint" in page
    assert "<stage>" not in page
    assert "98.67<" in page  # four digits, and long names whole
    assert "largest contact stress of the flanks" in page
    assert "mean radial load of the teeth on the bearings of gear 1" in page


def test_the_summary_is_in_units_that_are_shown(result: pp.Result) -> None:
    summary, data = result.summary(), result["default"].parts["operation"]
    assert summary.unit["mean_efficiency"] == "%"
    assert summary.xu_2007["mean_efficiency"] == pytest.approx(
        100.0 * float(data.mean_efficiency.sel(law="xu_2007")[0])
    )
    assert summary.name["mean_loss"] == "mean power loss"


def test_inputs_have_their_value_in_si_and_as_shown(result: pp.Result) -> None:
    row = result.inputs.loc["operation.speed"]
    assert row.value == pytest.approx(1200.0 * math.pi / 30.0)
    assert (row.unit, row.shown, row.status) == ("rad/s", "1200 rpm", "given")
    assert result.inputs.status["gears.pressure_angle"] == "default"


def test_a_part_has_coordinates_and_no_numbers_off_contact(result: pp.Result) -> None:
    data, kept = result.dataset("cycle"), result["default"].parts["cycle"]
    assert set(data.dims) == {"law", "phase", "pair", "slice"} == set(data.coords)
    active = kept.active.values
    assert not active.all()
    for name in ("pressure", "load", "sliding_velocity"):
        np.testing.assert_array_equal(np.isnan(data[name].values[1]), ~active)
        assert data[name].dims == ("law", "phase", "pair", "slice")
    carried = data["load"].sum(["pair", "slice"])
    np.testing.assert_allclose(carried, data.contact_force, rtol=1e-12)
    lost = (data["loss"] * data["weight"]).sum("phase")
    np.testing.assert_allclose(
        lost, result["default"].parts["operation"].mean_loss[:, 0], rtol=1e-9
    )


def test_units_by_choice(result: pp.Result) -> None:
    si, shown = (result.dataset("loss_map", units=one) for one in ("si", "shown"))
    assert (si.temperature.units, shown.temperature.units) == ("K", "degC")
    np.testing.assert_allclose(shown.temperature, si.temperature - 273.15)
    assert (si.speed.units, shown.speed.units) == ("rad/s", "rpm")
    np.testing.assert_allclose(shown.mean_efficiency, 100.0 * si.mean_efficiency)
    assert shown.mean_efficiency.long_name == "mean efficiency"
    with pytest.raises(pp.InputError, match='"SI" was given as units; use "si", "shown", or'):
        result.dataset("cycle", units="SI")


def test_units_by_kind(result: pp.Result) -> None:
    joint = {"torque": "N cm", "rotational_speed": "rad/s"}
    usual, chosen = result.summary(), result.summary(units=joint)
    assert (usual.unit["mean_input_torque"], chosen.unit["mean_input_torque"]) == (
        "N\u00a0m",
        "N cm",
    )
    np.testing.assert_allclose(
        chosen.xu_2007["mean_input_torque"], 100.0 * usual.xu_2007["mean_input_torque"]
    )
    si, map_ = (result.dataset("loss_map", units=one) for one in ("si", joint))
    assert (map_.torque.units, map_.speed.units, map_.temperature.units) == (
        "N cm",
        "rad/s",
        "degC",
    )
    np.testing.assert_allclose(map_.torque, 100.0 * si.torque)
    assert result.dataset("loss_map", units="torque=N cm").torque.units == "N cm"
    assert (
        result.to_dataframe("operation", units=joint).attrs["units"]["mean_input_torque"] == "N cm"
    )
    assert result.plot_in(joint).cycle.input_torque().layout.yaxis.title.text.endswith("[N cm]")
    assert result.plot.cycle.input_torque().layout.yaxis.title.text.endswith("[N\u00a0m]")
    with pytest.raises(pp.InputError, match='"N cmm" is not a unit of a torque'):
        result.dataset("cycle", units={"torque": "N cmm"})


def test_a_case_may_ask_for_units(result: pp.Result) -> None:
    asked = pp.Case(PAIR).set({"output.units": {"torque": "N cm"}})
    given = asked.held[0].document().tree
    assert given["output"] == {"units": {"torque": "N cm"}}
    grid = pp.study(asked, {TORQUE: [20.0, 60.0]}, units="shown")
    assert grid[TORQUE].units == "N cm"
    np.testing.assert_allclose(grid[TORQUE], [2000.0, 6000.0])
    assert pp.study(PAIR, {TORQUE: [20.0, 60.0]}, units="torque=mN m")[TORQUE].units == "mN m"


def test_what_is_shown_in_its_si_unit_stays_as_it_is() -> None:
    kept = dataset({"film_damping": (("x",), np.ones(2))}, {"x": [0.0, 1.0]})
    xr.testing.assert_identical(in_units(kept, "shown"), kept)


def test_the_axis_of_a_sweep_is_in_the_unit_of_its_key() -> None:
    told = {"sweep_key": "operation.speed", "axis_kind": "rotational speed", "axis_unit": "rpm"}
    swept = xr.Dataset({"axis": (("point",), np.pi / 30.0 * np.array([500.0, 3000.0]))}, attrs=told)
    shown = in_units(swept, "shown")["axis"]
    np.testing.assert_allclose(shown, [500.0, 3000.0])
    assert shown.attrs["units"] == "rpm"


def test_a_part_as_a_frame(result: pp.Result) -> None:
    frame = result.to_dataframe("operation", units="shown")
    assert [*frame.index] == ["iso_tr_14179_2", "xu_2007"]
    assert frame.attrs["units"]["mean_loss"] == "W"


def test_a_part_that_there_is_not(result: pp.Result) -> None:
    with pytest.raises(pp.InputError, match='the result has no part "cycles"; did you mean cycle'):
        result.dataset("cycles")
    with pytest.raises(pp.InputError, match='"physical" is not a variant of this result'):
        result.dataset("cycle", variant="physical")


def test_every_figure_of_the_report_is_one_of_plotly(result: pp.Result) -> None:
    assert dir(result.plot) == sorted(["teeth", "path", "cycle", "map"])
    for section in dir(result.plot):
        for name in dir(getattr(result.plot, section)):
            assert isinstance(getattr(getattr(result.plot, section), name)(), go.Figure)
    assert dir(result.plot.cycle) == ["against", "efficiency", "friction", "input_torque"]


@pytest.mark.parametrize(("units", "unit"), [("si", "1"), ("shown", "%")])
def test_axes_of_other_plotters_get_names_and_units(
    result: pp.Result, units: str, unit: str
) -> None:
    """What xarray writes beside the axes of its plots by matplotlib."""
    cycle = result.dataset("cycle", units=units)
    assert label_from_attrs(cycle.efficiency) == f"instantaneous efficiency [{unit}]"
    for name, variable in cycle.variables.items():
        assert variable.dtype.kind in "OUT" or {"long_name", "units"} <= {*variable.attrs}, name


def test_a_figure_stands_by_itself(result: pp.Result) -> None:
    figure = result.plot.cycle()
    assert figure.layout.title.text == "Instantaneous efficiency over the mesh cycle"
    assert figure.layout.showlegend
    assert len({trace.name for trace in figure.data}) == 2
    menu = result.plot.map("mean_loss").layout.updatemenus[0]
    assert len(menu.buttons) == 6
    with pytest.raises(AttributeError, match='no figures of "cycel"; did you mean cycle'):
        _ = result.plot.cycel
    with pytest.raises(pp.InputError, match='there is no figure "loss"'):
        result.plot.cycle("loss")


def test_what_is_saved_is_opened_again(result: pp.Result, tmp_path: Path) -> None:
    result.save(tmp_path / "out")
    again = pp.open_result(tmp_path / "out")
    assert repr(again) == repr(result)
    for part in result.parts:
        xr.testing.assert_identical(again["default"].parts[part], result["default"].parts[part])
    assert again.gradients(by=[SHIFT]).equals(result.gradients(by=[SHIFT]))
    case = pp.Case(tmp_path / "out" / "default" / "case.toml")
    assert case.tables["gears"] == pp.Case(PAIR).tables["gears"]
    (tmp_path / "out" / "run.json").write_text('{"case": "another", "variants": ["default"]}')
    with pytest.raises(pp.InputError, match="holds results of another case, another"):
        result.save(tmp_path / "out")


# ---- lists


def test_lists() -> None:
    assert pp.cases().title["tian2024"].startswith("Tian, Wang, Jiang")
    assert pp.models().loc[("friction", "xu_2007")].sources
    assert pp.cite(PAIR, bibtex=True)["xu_2007"].startswith("@")


def test_sources_of_a_result(result: pp.Result) -> None:
    assert [*pp.cite(result).index] == [*pp.cite(PAIR).index]


# ---- laws of one's own


def in_numpy(*, slide_roll_ratio: Any) -> Any:
    return 0.05 * np.tanh(slide_roll_ratio)


def in_math(*, slide_roll_ratio: Any) -> Any:
    return 0.05 * math.tanh(slide_roll_ratio)


def in_python(*, sliding: Any, rough: float = 0.1) -> Any:
    return rough if sliding > 0.0 else 0.0


def test_a_lambda_has_a_name_in_results() -> None:
    (own,) = with_user_law(
        PAIR.held[0], lambda *, slide_roll_ratio: 0.05 + 0.0 * slide_roll_ratio
    ).own
    assert not isinstance(own, str) and own.title == "own_law, the user's own"
    assert own.name == "own_law"


def linear(*, slide_roll_ratio: Any, slope: float = 0.1) -> Any:
    return slope * slide_roll_ratio


def test_laws_of_ones_own_stand_beside_those_by_name_in_their_order() -> None:
    case = pp.Case(PAIR).set({"models.friction": [{"name": "constant", "coefficient": 0.03}]})
    beside = with_user_law(case.held[0], ["Xu 2007", linear, "iso_tr_14179_2"]).built({})
    assert beside.law_names == ["xu_2007", "linear", "iso_tr_14179_2"]
    assert [choice.name for choice in beside.case.models.friction] == ["xu_2007", "iso_tr_14179_2"]
    assert with_user_law(case.held[0], linear).built({}).law_names == ["linear"]
    assert with_user_law(case.held[0], ["xu_2007"]).own == ()


def test_laws_that_cannot_stand_beside_each_other_are_told() -> None:
    with pytest.raises(pp.InputError, match="did you mean xu_2007"):
        pp.run(PAIR, friction=[linear, "xu_2006"])
    with pytest.raises(pp.InputError, match="friction: two laws are named linear, and results go"):
        pp.run(PAIR, friction=[linear, linear])
    with pytest.raises(pp.InputError, match=r"friction: .* a list of such and of names"):
        pp.run(PAIR, friction=[linear, 0.05])  # type: ignore[list-item]


@pytest.mark.parametrize("law", [in_numpy, in_math, in_python])
def test_a_law_in_numpy_is_told_of_jax(law: Callable[..., Any]) -> None:
    with pytest.raises(pp.InputError) as caught:
        pp.run(PAIR, friction=law)
    assert str(caught.value) == (
        f"the friction law {law.__name__} works on plain numbers; write it with jax.numpy in place of "
        "numpy and math, and jnp.where in place of if"
    )


# ---- studies


def test_a_grid_has_a_dimension_for_each_key() -> None:
    over = {SHIFT: [0.2, 0.4], "torque": ["5 N m", 60.0], WARM: [310.0, "50 degC", 330.0]}
    found = pp.study(PAIR, over)
    assert dict(found.sizes) == {"law": 2, SHIFT: 2, TORQUE: 2, WARM: 3}
    assert found[TORQUE].attrs == {"units": "N m", "long_name": TORQUE}
    np.testing.assert_allclose(found[WARM], [310.0, 323.15, 330.0])
    one = pp.study(PAIR.set({SHIFT: 0.2, TORQUE: 60.0}), {WARM: [330.0]})
    here = found.mean_loss.sel({SHIFT: 0.2, TORQUE: 60.0, WARM: 330.0})
    np.testing.assert_allclose(here, one.mean_loss[:, 0], rtol=1e-12)
    assert not found.reason.values.any()


def test_a_study_agrees_with_the_run(result: pp.Result) -> None:
    found = pp.study(PAIR, {TORQUE: [60.0]}, units="shown")
    assert found.mean_efficiency.units == "%"
    summary = result.summary().loc["mean_efficiency"]
    assert float(found.mean_efficiency.sel(law="xu_2007")[0]) == pytest.approx(summary.xu_2007)


def test_a_study_has_the_film_ratio_and_says_which_laws_hold(result: pp.Result) -> None:
    """At the point of the run they are those of its cycle and of its laws in range."""
    found = pp.study(PAIR, {TORQUE: [60.0, 600.0]})
    cycle, laws = result.cycle, result.laws
    thinnest = cycle.lambda_ratio.where(cycle["load"] > 0.0).min(("phase", "pair", "slice")).values
    np.testing.assert_allclose(found.min_lambda_ratio[:, 0], thinnest, rtol=1e-4)
    outside = laws.attrs["outside_law"]
    assert [why != "" for why in found.out_of_range.values[:, 0]] == [
        law in outside for law in found.law.values
    ]
    held = found.mean_efficiency.where(found.out_of_range == "")
    np.testing.assert_array_equal(found.lowest_efficiency_in_range[0], held.min("law"))
    np.testing.assert_array_equal(found.highest_efficiency_in_range[1], held.max("law"))
    counted = (found.out_of_range.sel(law="xu_2007") != "").values.sum()
    assert counted and f"xu_2007: out of its range at {counted} of 2 points" in found.warnings


def test_a_design_that_cannot_be_says_why_and_stops_no_other() -> None:
    shifts = [0.2, -0.8, 9.0, 0.4]
    found = pp.study(PAIR, {SHIFT: shifts, TORQUE: [5.0, 6.0, 7.0, 8.0]}, "zip")
    assert [*np.isnan(found.mean_loss.values[0])] == [False, True, True, False]
    assert found[SHIFT].dims == ("design",)
    _, undercut, beyond, _ = found.reason.values[0]
    assert undercut.startswith("gears.addendum: the tip of gear 2 runs into the undercut")
    assert beyond == "gears.profile_shift: 9.0 is out of range; allowed is -2 to 3"
    assert found.locked.dtype == bool
    with pytest.raises(
        pp.InputError, match=r"none of 1 designs can be computed; the first one: gea"
    ):
        pp.study(PAIR, {SHIFT: [9.0]})


@pytest.mark.whole
def test_one_that_spoils_all_together_is_computed_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    from pitchpoint.analyses import design_batch

    whole = design_batch.summaries

    def summaries(points: Any, *given: Any, **more: Any) -> xr.Dataset:
        if any(float(point.operation.load) == 6.0 for point in points):
            raise pp.ConvergenceError("no balance")
        return whole(points, *given, **more)

    monkeypatch.setattr(design_batch, "summaries", summaries)
    found = pp.study(PAIR, {TORQUE: [5.0, 6.0, 7.0]})
    assert [*found.reason.values[1]] == ["", "no balance", ""]
    assert [*np.isnan(found.mean_loss.values[1])] == [False, True, False]


def test_a_latin_hypercube_fills_its_ranges_evenly() -> None:
    over = {SHIFT: (0.0, 0.6), TORQUE: ("5 N m", "45 N m"), "gears.teeth.1": (20, 26)}
    found, again = (pp.study(PAIR, over, "latin_hypercube", n=8, seed=3) for _ in range(2))
    xr.testing.assert_identical(found, again)
    strata = np.sort(np.floor((found[TORQUE].values - 5.0) / 5.0))
    np.testing.assert_array_equal(strata, np.arange(8))
    assert {*found["gears.teeth.1"].values} <= {*range(20, 27)}


def test_designs_of_a_sobol_sequence_fill_their_ranges() -> None:
    found = pp.study(PAIR, {TORQUE: (5.0, 45.0)}, "sobol", n=16, seed=2)
    strata = np.sort(np.floor((found[TORQUE].values - 5.0) / 2.5))
    np.testing.assert_array_equal(strata, np.arange(16.0))


def test_the_loss_of_a_pair_hangs_on_its_torque_where_its_speed_hardly_changes() -> None:
    over = {TORQUE: ("5 N m", "45 N m"), "operation.speed": ("1000 rpm", "1001 rpm")}
    indices = pp.sobol_indices(PAIR, over, 16, figures=["mean_loss"])
    found = indices.sel(figure="mean_loss", law="xu_2007")["total_order"]
    assert found.sel(key=TORQUE).item() == pytest.approx(1.0, abs=0.1)
    assert found.sel(key="operation.speed").item() < 1e-4
    assert (indices.attrs["designs"], indices.attrs["asked"]) == (16, 16)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"n": 12}, "12 designs were asked for; a Sobol' sequence is even with a power of two"),
        (
            {"figures": ["mean_los"]},
            '"mean_los" is no figure of this study; did you mean mean_loss',
        ),
        ({"over": {TORQUE: [20.0, 30.0, 40.0]}}, "where the lowest and the highest number belong"),
        ({"over": {TORQUE: 20.0}}, "was given where a list of values belongs"),
        ({"over": {}}, "a study needs the values of one key at least"),
    ],
)
def test_indices_that_cannot_be(given: dict[str, Any], told: str) -> None:
    with pytest.raises(pp.InputError) as caught:
        pp.sobol_indices(PAIR, **({"over": {TORQUE: (5.0, 45.0)}, "n": 16} | given))
    assert told in str(caught.value)


class Heard(Progress):
    def __init__(self) -> None:
        self.reused: list[bool] = []

    def part(self, variant: str, title: str, reused: bool) -> None:
        self.reused.append(reused)


def test_a_study_goes_on_from_its_folder(tmp_path: Path) -> None:
    heard = Heard()
    first, second = (
        pp.study(PAIR, {TORQUE: [5.0, 6.0]}, folder=tmp_path, progress=heard) for _ in range(2)
    )
    xr.testing.assert_identical(first, second)
    pp.study(PAIR, {TORQUE: [5.0, 7.0]}, folder=tmp_path, progress=heard)
    assert heard.reused == [False, True, False]
    assert len(list(tmp_path.glob("designs_*.nc"))) == 2


@pytest.mark.parametrize(
    ("over", "how", "told"),
    [
        ({}, "grid", "a study needs the values of one key at least"),
        ({"torqe": [1.0]}, "grid", "torqe: there is no such key; did you mean torque"),
        ({TORQUE: ["5 N"]}, "grid", f'case: {TORQUE}: "5 N" is a force, but a torque is needed'),
        ({TORQUE: 5.0}, "grid", r'"5.0 N m" was given where a list of values belongs'),
        ({"models.averaging": ["path"]}, "grid", "models.averaging: cannot be studied; keys of ge"),
        ({"gears.profile_shift": [0.1]}, "grid", "different values for gear 1 and gear 2"),
        ({TORQUE: [1.0], WARM: [1.0, 2.0]}, "zip", "given were 1 of operation.torque, 2 of opera"),
        (
            {TORQUE: [1.0, 2.0]},
            "latin_hypercube",
            "n: a Latin hypercube needs the number of designs",
        ),
        (
            {TORQUE: [1.0, 2.0]},
            "sobol",
            "no number of designs was given; a Sobol' sequence is even with",
        ),
        (
            {TORQUE: [1.0, 2.0]},
            "halton",
            '"halton" is no way to lay out a study; use one of "grid"',
        ),
    ],
)
def test_a_study_that_cannot_be(over: dict[str, Any], how: Any, told: str) -> None:
    with pytest.raises(pp.InputError) as caught:
        pp.study(PAIR, over, how)
    assert told in str(caught.value)


# ---- derivatives


def test_gradients_by_keys_are_those_of_rebuilt_cases(result: pp.Result) -> None:
    """Against central differences of whole cases, every key of the table: dimensions that follow too."""
    table = result.gradients("mean_loss", law="xu_2007")
    assert {SHIFT, "gears.addendum.1", "roughness.ra.2", TORQUE, WARM} <= {*table.index}
    step = {key: 1e-4 * abs(value) for key, value in table.value.items()}
    ways = [(key, way) for key in table.index for way in (1.0, -1.0)]
    over = {
        key: [value + (way * step[key] if key == moved else 0.0) for moved, way in ways]
        for key, value in table.value.items()
    }
    loss = pp.study(PAIR, over, "zip").mean_loss.sel(law="xu_2007").values
    slopes = (loss[::2] - loss[1::2]) / (2.0 * np.array([*step.values()]))
    np.testing.assert_allclose(table.derivative, slopes, rtol=2e-5)


@pytest.mark.whole
def test_a_key_that_makes_other_gears_has_no_derivative() -> None:
    """Lines of a spur pair are straight: nothing is known of the first inclination of them."""
    helix = "gears.helix_angle"
    pair = PAIR.set({"models.load_sharing": "from_stiffness"})
    with pytest.raises(pp.InputError, match=f"{helix}: has no derivative here"):
        pp.gradients(pair, by=[helix])
    assert helix not in pp.gradients(pair).index


def test_units_and_value_stand_beside_the_gradients(result: pp.Result) -> None:
    table = result.gradients("mean_loss", ["torque", SHIFT])
    assert [*table.index] == [TORQUE, SHIFT]
    assert [*table.unit] == ["N m", "1"]
    loss = result.summary().iso_tr_14179_2["mean_loss"]
    value = pytest.approx(loss)
    assert table.attrs == {"of": "mean_loss", "unit": "W", "value": value, "without": {}}
    both = result.gradients(by="profile_shift")
    assert [*both.index] == [SHIFT, SHIFT.replace(".1", ".2")]
    assert both.loc[SHIFT].equals(table.loc[SHIFT])
    with pytest.raises(pp.InputError, match=r"gears.teeth: is no number of the case that varies"):
        result.gradients(by=["teeth"])
    with pytest.raises(pp.InputError, match='"mean_los" has no derivatives here; did you mean'):
        result.gradients("mean_los")


def test_what_is_not_known_of_a_material_spoils_no_derivative(result: pp.Result) -> None:
    """Nor does a key that moves nothing else have one."""
    steel = {"young": 206e9, "poisson": 0.3, "density": 7850.0}  # without hardness
    table = pp.gradients(
        PAIR.set({"materials.gear_2": steel}), by=["torque", "materials.gear_2.young"]
    )
    assert [*table.index] == [TORQUE, "materials.gear_2.young"]
    before = result.gradients(by=["torque"])
    np.testing.assert_allclose(table.derivative[TORQUE], before.derivative[TORQUE], rtol=1e-3)


RATED = {"materials.gear_1": "case-hardened-mq", "materials.gear_2": "case-hardened-mq"}


@pytest.mark.whole
def test_safeties_have_derivatives_by_differences_of_designs() -> None:
    """By powers of the load: S_F falls as 1/K_A, S_H as its root; a stress does not follow the oil."""
    rated = PAIR.set(RATED | {"strength.application_factor": 2.0, "strength.dynamic_factor": 1.1})
    keys = ["strength.application_factor", TORQUE]
    for of, power in (("least_root_safety", 1.0), ("least_flank_safety", 0.5)):
        table = pp.gradients(rated, of, keys)
        slopes = table.derivative * table.value / table.attrs["value"]
        np.testing.assert_allclose(slopes, -power, rtol=1e-6)
    assert {*pp.gradients(rated, "largest_root_stress", [WARM]).attrs["without"]} == {WARM}


@pytest.mark.whole
def test_drives_of_several_meshes_have_derivatives_by_what_their_file_states() -> None:
    """The loss of stages in a row is about proportional to the torque; the helix has no number there."""
    gears = {key: PAIR.tables["gears"][key] for key in ("teeth", "module", "face_width")}
    tables = {key: table for key, table in PAIR.tables.items() if key not in ("gears", "targets")}
    row = pp.Case({**tables, "stages": {"1": {"gears": gears}, "2": {"gears": gears}}})
    table = pp.gradients(row, "mean_input_torque", "torque")
    by_torque = table.derivative[TORQUE] * table.value[TORQUE] / table.attrs["value"]
    assert by_torque == pytest.approx(1.0, abs=0.01)
    with pytest.raises(pp.InputError, match="is no number of the case that varies"):
        pp.gradients(row, by=["stages.1.gears.helix_angle"])


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ([0.9, 0.95, 1.05, 1.1], 1.0),
        ([1.0, 1.0, 1.05, 1.1], "has no derivative here: 1 above it and 0 below"),
        ([np.nan, np.nan, 1.05, 1.1], 1.0),
        ([0.9, 0.95, np.nan, np.nan], 1.0),
        ([np.nan] * 4, OTHER_FORM),
        ([np.nan, np.nan, 1.07, 1.1], "has no derivative here: differences over two steps give 1"),
        ([1.0, 1.0, 1.0, 1.0 + 1e-12], STILL),
    ],
)
def test_a_derivative_is_only_where_differences_agree(row: list[float], told: float | str) -> None:
    found = derivative_of(np.array(row), 1.0, 0.1)
    if isinstance(told, str):
        assert str(found).startswith(told)
    else:
        assert found == pytest.approx(told, rel=1e-9)


@pytest.mark.whole
def test_an_optimiser_of_scipy_finds_the_best_profile_shift() -> None:
    def loss(shift: np.ndarray) -> tuple[float, float]:
        table = pp.gradients(PAIR.set({SHIFT: shift[0]}), "mean_loss", [SHIFT], law="xu_2007")
        return table.attrs["value"], table.derivative[SHIFT]

    found = scipy.optimize.minimize(loss, [0.1], jac=True, bounds=[(-0.2, 0.8)])
    shifts = np.linspace(-0.2, 0.8, 11)
    beside = pp.study(PAIR, {SHIFT: shifts}).mean_loss.sel(law="xu_2007")
    assert found.success
    assert found.fun <= float(beside.min())
    assert abs(found.x[0] - shifts[np.argmin(beside.values)]) < 0.1


@pytest.mark.whole
def test_designs_are_vectorised_by_jax() -> None:
    case = pp.load_case(PAIR)
    models = case.models[1]

    def loss(shift: jax.Array) -> jax.Array:
        mesh = dataclasses.replace(case.design.mesh, profile_shift=shift).completed()
        design = dataclasses.replace(case.design, mesh=mesh)
        return pp.cycle(design, case.operation, models).mean_loss

    shifts = jnp.asarray([[0.2, -0.2], [0.4, -0.2], [0.5, -0.2]])
    beside = pp.study(PAIR, {SHIFT: [0.2, 0.4, 0.5]}).mean_loss.sel(law="xu_2007")
    np.testing.assert_allclose(jax.jit(jax.vmap(loss))(shifts), beside, rtol=1e-8)
