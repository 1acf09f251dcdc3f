"""Films of a mesh cycle from a case file: balance, resume, withheld numbers, report, refusals."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bank
import numpy as np
import pytest
import xarray as xr
from sound import PAIR
from stopped import stopped_and_gone_on

from pitchpoint.analyses import film as solved
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.film_contacts import contact_states, film_model_of, patch_grid_of
from pitchpoint.analyses.film_cycle import _of_pieces, _of_summits
from pitchpoint.analyses.solved_films import FILM
from pitchpoint.cases.built import Built
from pitchpoint.cases.film_choices import film_model
from pitchpoint.cases.variant import Variant
from pitchpoint.core.doubts import Doubt, stored
from pitchpoint.core.status import Code
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.materials.lubricants import find
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views.report import report_page
from pitchpoint.views.section_registry import FILM as SECTION
from pitchpoint.views.sections.film import film_answer

CASE = f"""{PAIR}
[models]
friction = [{{ name = "constant", coefficient = 0.05 }}, "iso_tr_14179_2"]
[film]
solver = "line"
phases = 9
nodes = 33
"""
BALL = str(Path(__file__).parents[2] / "examples" / "ball_on_disc_film.toml")
TORUS = str(Path(__file__).parents[2] / "examples" / "torus.toml")
PHASES = ("film_loss", "minimum_film", "profile_pressure")


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    """Nothing but films."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", {"film": FILM})
        yield


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("film") / "film.toml"
    path.write_text(CASE, "utf-8")
    return str(path)


@pytest.fixture(scope="module")
def outcome(case: str) -> Outcome:
    return bank.outcomes(case)["default"]


def test_every_loaded_contact_has_a_film(outcome: Outcome) -> None:
    data = outcome.parts["film"]
    loaded = data["load"].values > 0.0
    assert int(data["loaded_contacts"]) == int(data["solved_contacts"]) == loaded.sum() > 0
    assert np.array_equal(np.isfinite(data["minimum_film"].values), loaded)
    assert (data["film_status"].values[loaded] == Code.SOLVED).all()
    assert data.sizes["phase"] >= 9


def test_a_film_carries_the_load_of_the_balance(outcome: Outcome) -> None:
    """The integral of the pressure over a profile is the load per length of the contact line."""
    data, width = outcome.parts["film"], 20e-3
    pressure, place = data["profile_pressure"].values, data["profile_place"].values
    carried = np.trapezoid(pressure, place, axis=-1)
    load = data["load"].values.sum(axis=-1)[:, data["shown_pair"].values]
    pressed = np.isfinite(carried)
    assert pressed.any()
    face = load[pressed] / carried[pressed]
    assert face == pytest.approx(np.full(face.size, face[0]), rel=0.02)
    assert 0.5 * width < face[0] < 2.0 * width


def test_the_film_of_one_contact_is_that_of_the_solver_alone(outcome: Outcome, case: str) -> None:
    data, built = outcome.parts["film"], load_case(case)
    states = contact_states(built)
    at = np.unravel_index(np.argmax(states["line_load"]), states["line_load"].shape)
    contacts = FilmModel(nodes=33).contacts(
        **{
            name: states[name][at].reshape(1)
            for name in ("line_load", "radius", "speed_a", "speed_b")
        },
        modulus=float(built.design.modulus),
        oil=built.design.lubricant,
        temperature=float(built.operation.temperature),
        roughness_rq=float(built.design.roughness.composite_rq),
    )
    film = solve_lines(contacts, nodes=33).film
    assert float(data["minimum_film"].values[at]) == pytest.approx(float(film.minimum_film[0]))
    force = abs(float(film.shear_force[0] + film.boundary_force[0]))
    coefficient = force / float(states["line_load"][at])
    assert float(data["film_friction"].values[at]) == pytest.approx(coefficient)


def test_friction_by_law_is_that_of_the_operating_point(outcome: Outcome, case: str) -> None:
    data, built = outcome.parts["film"], load_case(case)
    for k, models in enumerate(built.models):
        found = summarise([(built.design, built.operation)], models)
        for own, name in (("law_efficiency", "mean_efficiency"), ("mean_law_loss", "mean_loss")):
            assert float(data[own].values[k]) == pytest.approx(float(found[name][0]), rel=1e-5)


def test_energy_is_lost_by_sliding_and_rolling(outcome: Outcome) -> None:
    data = outcome.parts["film"]
    lost = (data["film_sliding_loss"] + data["film_rolling_loss"]).sum(("pair", "slice"))
    assert data["film_loss"].values == pytest.approx(lost.values)
    mean = float(data["film_loss"].values @ data["weight"].values)
    assert float(data["mean_film_loss"]) == pytest.approx(mean)
    assert (data["film_sliding_loss"].values[data["load"].values > 0.0] >= 0.0).all()
    parts = float(data["mean_film_sliding_loss"]) + float(data["mean_film_rolling_loss"])
    assert float(data["mean_film_loss"]) == pytest.approx(parts)


@pytest.mark.whole
def test_a_film_that_is_not_found_withholds_the_loss(
    case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lost(built: Any, given: Any, *others: Any) -> Any:
        first = np.arange(len(given["line_load"])) == 0
        return honest(built, {n: np.where(first, np.nan, one) for n, one in given.items()}, *others)

    honest = solved._films
    monkeypatch.setattr(solved, "_films", lost)
    outcome = running.run_case(case)["default"]
    data = outcome.parts["film"]
    missing = int(data["loaded_contacts"]) - int(data["solved_contacts"])
    assert missing > 0
    for name in ("mean_film_loss", "film_efficiency", "mean_film_friction"):
        assert np.isnan(float(data[name]))
    assert np.isfinite(float(data["smallest_film"]))
    told = " ".join(json.loads(data.attrs["warnings"]))
    assert f"{missing} of {int(data['loaded_contacts'])} loaded contacts have no film" in told
    assert "loss and efficiency are withheld" in report_page({"default": outcome})


@pytest.mark.whole
def test_a_run_that_was_stopped_goes_on_with_what_it_has(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, outcome: Outcome
) -> None:
    def run() -> Any:
        return running.run_case(case, folder=tmp_path)["default"].parts["film"]

    again, begins = stopped_and_gone_on(FILM, run, monkeypatch)
    assert begins == [0, 6, 6]
    for name in PHASES:
        assert np.array_equal(again[name], outcome.parts["film"][name], equal_nan=True)


def test_report_screen_and_json_have_the_films(outcome: Outcome) -> None:
    page = report_page({"default": outcome})
    for words in (
        '<section id="film"',
        'type="range" data-menu="profile0_film"',
        "Film over composite Rq, and lubrication regimes",
        "The films are isothermal",
        "Dowson-Higginson",
    ):
        assert words in page
    (first, second) = SECTION.screen(outcome)
    assert first.title == "Films"
    assert [row["friction by"] for row in second.rows] == ["films", "constant", "iso_tr_14179_2"]
    told = figures_by_law(outcome)["film"]
    assert set(told["film_laws"]) == set(outcome.parts["film"]["film_law"].values)
    assert told["friction_laws"]["constant"]["mean_law_friction"] == pytest.approx(0.05)


def test_keys_that_are_left_out_stand_as_the_model_has_them() -> None:
    assert film_model(FilmTable(solver="line"), (), None) == FilmModel()
    given = FilmTable(solver="line", nodes=65, asperities="none", inlet="2 mm")
    assert film_model(given, (), 3e-3) == FilmModel(nodes=65, asperities="none", inlet=2e-3)


def test_nodes_that_are_left_open_are_twice_as_many_beyond_a_load_parameter_of_100() -> None:
    def at(speed: float, text: str = CASE.replace("nodes = 33\n", "")) -> Built:
        variant = Variant(tomllib.loads(text), "film.toml", "default")
        return variant.built({"operation.speed": f"{speed} rad/s"})

    built = at(100.0)
    design, lanes = built.design, contact_states(built)
    oil = FilmModel().fluid(design.lubricant, float(built.operation.temperature))
    load, radius, a, b = (
        lanes[name][lanes["loaded"]] for name in ("line_load", "radius", "speed_a", "speed_b")
    )
    stiff = float(design.modulus) * radius
    parameter = np.max(load / np.sqrt(float(oil.viscosity) * (a + b) * stiff))
    # Friction is constant, so forces stay, and the parameter falls by the root of the speed.
    bound = 100.0 * (parameter / 100.0) ** 2
    assert [film_model_of(at(part * bound)).nodes for part in (0.99, 1.01)] == [257, 129]
    assert film_model_of(at(0.5 * bound, CASE)).nodes == 33
    patch = CASE.replace('solver = "line"', 'solver = "finite_line"')
    grids = [
        patch_grid_of(at(part * bound, patch.replace("nodes = 33\n", ""))) for part in (0.99, 1.01)
    ]
    assert grids == [(129, 128), (65, 64)] and patch_grid_of(at(0.5 * bound, patch)) == (33, 32)


def test_ellipses_beyond_a_load_parameter_of_100_have_twice_as_many_nodes() -> None:
    """That of a line with the pressure of Hertz's ball, p^3 = 6 F (E'/2)^2/(pi^3 R^2)."""
    built = load_case(BALL)
    design, lanes, radius = built.design, contact_states(built), 9.525e-3
    oil = FilmModel().fluid(design.lubricant, float(built.operation.temperature))
    modulus, speeds = float(design.modulus), float(np.max(lanes["speed_a"] + lanes["speed_b"]))
    pressure = (6.0 * 20.0 * (0.5 * modulus) ** 2 / (np.pi**3 * radius**2)) ** (1.0 / 3.0)
    stiff = modulus * radius / (float(oil.viscosity) * speeds)
    parameter = 2.0 * np.pi * (pressure / modulus) ** 2 * np.sqrt(stiff)
    bound = 120.0 * (parameter / 100.0) ** 2
    grids = [
        patch_grid_of(load_case(BALL, settings={"operation.speed": f"{part * bound} rpm"}))
        for part in (0.99, 1.01)
    ]
    assert grids == [(129, 128), (65, 64)]


@pytest.mark.whole
def test_smooth_flanks_have_no_film_ratio(case: str) -> None:
    outcome = running.run_case(case, settings={"roughness.ra": "0 um", "film.phases": 3})["default"]
    assert np.isinf(outcome.parts["film"]["smallest_lambda"])
    assert float(outcome.parts["film"]["largest_asperity_share"]) == 0.0
    assert figures_by_law(outcome)["film"]["smallest_lambda"] is None
    assert "lubrication regimes" not in report_page({"default": outcome})


@pytest.mark.whole
def test_assumed_constants_behind_the_load_on_asperities_are_told(case: str) -> None:
    rough = {"roughness.ra": "1.2 um", "film.phases": 3}
    outcome = running.run_case(case, settings=rough)["default"]
    data = outcome.parts["film"]
    assert float(data["largest_asperity_share"]) > 0.05
    part = float(data["mean_boundary_part"] / data["mean_film_friction"])
    words = f"he load on asperities, and {100.0 * part:.0f} % of the friction, rest on assumed "
    assert f"t{words}eta_beta_sigma 0.05 and sigma_over_beta 0.01" in film_answer(outcome)
    assert f"T{words}eta_beta_sigma 0.05 and" in next(SECTION.screen(outcome)).line
    page = report_page({"default": outcome}).replace("\u00a0", " ")
    assert f"T{words}eta_beta_sigma 0.05 and" in page
    one = running.run_case(case, settings={**rough, "film.eta_beta_sigma": 0.06})["default"]
    assert "rest on assumed sigma_over_beta 0.01;" in film_answer(one)
    both = {**rough, "film.eta_beta_sigma": 0.05, "film.sigma_over_beta": 0.01}
    assert "assumed" not in film_answer(running.run_case(case, settings=both)["default"])


@pytest.mark.whole
def test_what_sets_of_summits_differ_in_stands_beside_the_load_on_asperities(case: str) -> None:
    rough = {"roughness.ra": "0.5 um", "film.phases": 3}
    data = running.run_case(case, settings=rough)["default"].parts["film"]
    textbooks, follows = data["summits_share"].values
    assert textbooks == float(data["largest_asperity_share"]) < follows / 2.0
    assert any("where asperities carry most" in one for one in json.loads(data.attrs["warnings"]))
    chosen = {**rough, "film.summits": "masjedi_khonsari_2012"}
    stiff = running.run_case(case, settings=chosen)["default"]
    shares = stiff.parts["film"]["summits_share"].values
    assert shares[1] == float(stiff.parts["film"]["largest_asperity_share"]) >= follows
    there = data["asperity_share"].argmax(...)
    assert float(stiff.parts["film"]["asperity_share"][there]) == pytest.approx(follows, rel=1e-6)
    assert f"({100.0 * shares[0]:.4g} % by textbooks, " in film_answer(stiff)
    measured = running.run_case(case, settings={**rough, "film.eta_beta_sigma": 0.06})["default"]
    assert "summits_share" not in measured.parts["film"]


def test_sets_of_summits_that_differ_much_are_told() -> None:
    spread = {"summits_share": np.array([0.02, 0.4]), "summits_friction": np.array([0.03, 0.06])}
    (told,) = _of_summits(spread)
    assert "2 % of the load and friction is 0.03 with the constants of textbooks" in told
    assert "both sets are assumed" in told
    assert not list(_of_summits({**spread, "summits_share": np.array([0.3, 0.5])}))
    assert not list(_of_summits({**spread, "summits_share": np.array([0.001, 0.04])}))
    assert not list(_of_summits({}))


@pytest.mark.whole
def test_a_largest_pressure_below_that_of_hertz_is_explained(case: str, outcome: Outcome) -> None:
    rough = {"roughness.ra": "3 um", "film.phases": 3, "operation.torque": "20 N m"}
    one = running.run_case(case, settings=rough)["default"]
    data = one.parts["film"]
    lacks = 1.0 - float(data["largest_film_pressure"]) / float(data["pressure"].max())
    told = (
        f"The largest pressure is {100.0 * lacks:.0f} % below Hertz's: rough flanks spread the load"
    )
    assert lacks > 0.05 and told in next(SECTION.screen(one)).line
    assert "rough flanks spread the load beyond the dry contact" in report_page({"default": one})
    assert float(outcome.parts["film"]["largest_asperity_share"]) > 0.0
    assert "below Hertz's" not in next(SECTION.screen(outcome)).line


def test_without_load_there_is_no_film(case: str) -> None:
    data = running.run_case(case, settings={"operation.torque": "0 N m"})["default"].parts["film"]
    assert int(data["loaded_contacts"]) == 0
    assert np.isnan(float(data["mean_film_loss"]))
    assert Code.UNLOADED.sentence in data.attrs["solve"]


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"film.nodes": 100}, "one more than a power of two"),
        ({"film.nodes": 17}, "allowed is 33 to 1025"),
        ({"film.solver": "point"}, "use 'line'"),
        ({"film.viscosity_law": "barrus"}, "did you mean barus_1893"),
        ({"film.boundary_friction": -0.1}, "allowed is 0 to 2"),
        ({"film.sigma_over_beta": -1.0}, "allowed is above 0 to 10"),
        ({"film.summits": "textbook"}, "did you mean textbooks"),
        (
            {"film.summits": "textbooks", "film.eta_beta_sigma": 0.1, "film.sigma_over_beta": 0.01},
            "leave out it or one of them",
        ),
        ({"film.limiting_stress": "2 MPa"}, "is no parameter of ree_eyring_1955"),
        ({"film.mcewen_exponent": 4.0}, "is no parameter of roelands_1966; it has none"),
        ({"film.asperities": "none", "film.pattern": 2.0}, "was given without asperities"),
    ],
)
def test_what_films_cannot_be_is_told(case: str, settings: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as caught:
        load_case(case, settings=settings)
    assert str(caught.value.key).startswith("film.")
    assert words in str(caught.value)


def test_ellipses_have_no_line_solver() -> None:
    with pytest.raises(InputError, match="ellipses have no line solver") as caught:
        load_case(TORUS, settings={"film.solver": "line"})
    assert caught.value.key == "film.solver"


def test_a_temperature_in_degrees_is_told_to_be_taken_in_kelvin() -> None:
    given = {"line_load": 1e5, "radius": 0.01, "modulus": 226e9, "speed_a": 2.0, "speed_b": 1.0}
    given |= {"oil": find("pao-vg-100").build(), "roughness_rq": 0.0}
    with pytest.raises(InputError, match=r"an oil at -213\.1 degC, .*; temperatures are in kelvin"):
        FilmModel().contacts(temperature=60.0, **given)
    with pytest.raises(InputError, match=r"degC$"):
        FilmModel().contacts(temperature=600.0, **given)


def piece(pressure: float, *told: Doubt) -> xr.Dataset:
    return xr.Dataset({"film_pressure": ("point", [pressure] * 3)}, attrs=stored(told))


def test_of_warnings_of_a_kind_the_worst_one_is_told() -> None:
    few, many = (Doubt(f"the grid is off by {one} %", "grid", one) for one in (4, 27))
    short = Doubt("oil begins 1.1 half-widths before", "inlet", 10.0)
    told = _of_pieces([piece(9e8, few), piece(5e8, many, short), piece(7e8, few)])
    assert told == [
        "Films, phases 4 to 6 of 9, and less at others: the grid is off by 27 %.",
        "Films, phases 4 to 6 of 9: oil begins 1.1 half-widths before.",
    ]


def test_doubts_are_worse_where_films_are() -> None:
    """Each of several contacts alone, and the worst of them among all."""
    oil = find("pao-vg-100").build()
    given = {"radius": 0.01, "modulus": 226e9, "speed_a": 2.0, "speed_b": 1.0, "oil": oil}
    line_load = np.array([3e4, 3e5, 1e5])
    model = FilmModel(nodes=33, inlet=3e-4)

    def told(some: np.ndarray) -> dict[str, Doubt]:
        made = model.contacts(line_load=some, temperature=353.15, roughness_rq=0.0, **given)
        return {one.kind: one for one in solve_lines(made, nodes=33, size=5e-4).warnings}

    each, whole = [told(np.array([one])) for one in line_load], told(line_load)
    assert {"pressure", "inlet", "wide against the size of a tooth"} <= whole.keys()
    for kind, one in whole.items():
        assert one.extent == pytest.approx(
            max(alone[kind].extent for alone in each if kind in alone)
        )
    assert str(whole["inlet"]).startswith("oil begins")


@pytest.mark.whole
def test_heat_that_isothermal_films_leave_out_is_told(outcome: Outcome, case: str) -> None:
    """The estimate beside the film that is solved with its heat; nothing where it is small."""
    (mild,) = (text for text in warnings_of(outcome) if "isothermal" in text)
    assert float(mild.partition("up to about ")[2].partition(" K")[0]) < 10.0
    harder = {"operation.torque": "250 N m", "operation.speed": "3000 rpm"}
    hard = running.run_case(case, settings=harder)["default"]
    (cold,) = (text for text in warnings_of(hard) if "isothermal" in text)
    estimated = float(cold.partition("up to about ")[2].partition(" K")[0])
    warm = running.run_case(case, settings={**harder, "film.thermal": "mean_film"})["default"]
    assert not any("isothermal" in text for text in warnings_of(warm))
    film, flash = (float(warm.parts["film"][f"largest_{one}_rise"]) for one in ("film", "flash"))
    assert 10.0 < film < estimated < 1.5 * film
    assert 0.3 * film < flash < 1.1 * film
    rise, surfaces = (
        warm.parts["film"][name].values for name in ("profile_rise", "profile_surface_rise_1")
    )
    assert np.nanmax(rise) <= film * (1.0 + 1e-12)
    assert np.nanmax(surfaces) <= flash * (1.0 + 1e-12)
    assert "Temperatures above the inlet" in report_page({"default": warm})
    assert "Temperatures above the inlet" not in report_page({"default": hard})
    assert "warmer than their inlet" in film_answer(warm)
    assert "warmer than their inlet" not in film_answer(hard)


def test_the_thinnest_film_is_named_and_dry_contacts_are_marked(
    outcome: Outcome, case: str
) -> None:
    data, page = outcome.parts["film"], report_page({"default": outcome})
    phase, pair, _ = np.unravel_index(np.nanargmin(data["minimum_film"].values), data["load"].shape)
    number = ("I", "II", "III")[int(pair)]
    at = f"{float(data['phase'][phase]) % 1.0:.3f}, pair {number}"
    assert f"The thinnest film is at phase {at}: " in page
    assert "±b of the dry contact" in page
    modulus, shown = float(load_case(case).design.modulus), data["shown_pair"].values
    hertz, radius = (data[name].values[:, shown, 0] for name in ("pressure", "radius"))
    expected = np.where(np.isfinite(hertz), 4.0 * hertz * radius / modulus, np.nan)
    assert np.isfinite(expected).any()
    np.testing.assert_allclose(data["profile_half_width"].values, expected, rtol=1e-9)


def warnings_of(outcome: Outcome) -> list[str]:
    return json.loads(outcome.parts["film"].attrs["warnings"])


@pytest.mark.whole
def test_films_in_series_yield_as_films_of_more_load_do(case: str) -> None:
    """Virtual work: the torque times the rotation by films is the sum of forces times what films give way."""
    outcome = running.run_case(case, settings={"film.in_series": True})["default"]
    data, built = outcome.parts["film"], load_case(case)
    torque, part = 50.0, 0.01
    states = contact_states(built)

    def film(times: float) -> np.ndarray:
        some = {**states, "line_load": times * states["line_load"]}
        films, _, back = solved.films_of_lines(built, some, lambda *_: None)
        return np.where(back < 0, 0.0, np.asarray(films.film.mean_film)[back])

    turned = np.sum(states["load"] * (film(1.0 - part) - film(1.0 + part)), axis=(1, 2)) / torque
    stiffness = 2.0 * part * torque / float(turned @ states["weight"])
    assert float(data["film_torsional_stiffness"]) == pytest.approx(stiffness, rel=0.05)
    dry, films, both = (
        float(data[name])
        for name in (
            "stiffness_without_films",
            "film_torsional_stiffness",
            "stiffness_with_films",
        )
    )
    assert 1.0 / both == pytest.approx(1.0 / dry + 1.0 / films, rel=1e-9)
    assert 0.8 < both / dry < 1.0
    assert "less)" in film_answer(outcome)


@pytest.mark.whole
def test_films_in_series_need_a_torque(case: str) -> None:
    settings = {"film.in_series": True, "operation.torque": "0 N m"}
    with pytest.raises(InputError, match="nothing is carried") as told:
        running.run_case(case, settings=settings)
    assert told.value.key == "film.in_series"
