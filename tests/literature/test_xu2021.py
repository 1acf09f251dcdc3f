"""Xu et al. (2021): load, curvature, speed and viscosity, as printed beside the corrected forms.

The paper prints one number on them, the transmission ratio: the others are compared with an
independent calculation of the same formulas, rows of the kind "reference". What it prints of films are
thresholds, which inputs that it does not give are calibrated to, and trends. Here films are solved on a
coarse grid at few speeds; `pitchpoint compare xu2021` takes all.
"""

import re
from functools import cache
from importlib import resources
from unittest.mock import Mock

import numpy as np
import pytest
import xarray as xr
from xu2021_in_print import OIL, VARIANTS, case, curvature, speed

from pitchpoint.analyses.comparison import compare
from pitchpoint.analyses.studies import readings_of
from pitchpoint.cases.document import leaves
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.fields import LineFilm
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch.fields import PatchFilm
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.materials.fluid import Fluid
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.xu2021 import readings as of_case
from pitchpoint.published.xu2021 import zone
from pitchpoint.published.xu2021.printed import (
    pressure_viscosity,
    printed_count,
    printed_viscosity,
    relative_radius,
    viscosity,
)
from pitchpoint.published.xu2021.zone_films import (
    ToothFilms,
    _across,
    _late_gain,
    _peaks,
    load_over_film_step,
)
from pitchpoint.results.target_rows import counts
from pitchpoint.runs.run import compare_case

FILE = resources.files("pitchpoint.published") / "xu2021" / "case.toml"
OF_FILMS = ("films", "zone_speed", "zone_temperature")


def points(study, **changes):
    """The case at every point of a study."""
    given = case().studies[study]
    own = {**dict(leaves(given.change)), **changes}
    values = [None] if given.sweep is None else given.sweep.values
    swept = [{} if value is None else {given.sweep.key: value} for value in values]
    return [VARIANTS["as_published"].built({**own, **one}) for one in swept]


def readings(studies, **changes):
    return {
        f"study_{name}": xr.Dataset(readings_of(points(name, **changes), 1)) for name in studies
    }


def missed(study, **changes):
    """Rows of a study that miss, those on the balance of the drive left out."""
    every = [one for one in case().targets if one.study == study]
    read = [one for one in every if one.variable != "mean_efficiency"]
    found = compare(read, readings([study], **changes))
    return {row.quantity for row in found if row.verdict == "miss"}


# ------------------------------------------------------------------ the comparison


@pytest.fixture
def without_films(tmp_path):
    """The shipped file without its films, which take a minute."""
    tables = re.split(r"(?m)^(?=\[)", FILE.read_text("utf-8"))
    kept = [
        table
        for table in tables
        if not table.startswith("[variants.as_published.studies.")
        and not any(f'study = "{study}"' in table for study in OF_FILMS)
    ]
    assert len(tables) - len(kept) == 4 + len(
        [one for one in case().targets if one.study in OF_FILMS]
    )
    path = tmp_path / "xu2021.toml"
    path.write_text("".join(kept), "utf-8")
    return str(path)


@pytest.mark.whole
def test_no_row_misses(without_films):
    rows = compare_case(without_films)[2]
    assert [(row.quantity, row.computed) for row in rows if row.verdict == "miss"] == []
    assert {kind: dict(found) for kind, found in counts(rows).items()} == {
        "definition": {"pass": 1},
        "reference": {"pass": 30},
    }


@pytest.mark.whole
def test_only_the_speeds_of_the_paper_miss_in_the_physical_variant():
    targets = case("physical").targets
    studies = {one.study for one in targets if one.study}
    found = counts(compare(targets, readings(studies)))
    assert {kind: dict(each) for kind, each in found.items()} == {
        "reference": {"pass": 6},
        "predicted": {"miss": 2},
        "excluded": {"excluded": 1},
    }


@pytest.mark.parametrize("variant", [*VARIANTS])
def test_reference_values_are_never_called_those_of_the_paper(variant):
    for target in case(variant).targets:
        if target.kind in ("reference", "excluded"):
            assert target.where == "reference calculation"
        else:
            assert target.where.startswith(("Table", "section"))


def test_the_number_that_is_left_out_has_its_reason():
    assert not [target for target in case().targets if target.kind == "excluded"]
    (left_out,) = [one for one in case("physical").targets if one.kind == "excluded"]
    assert "no base circles" in left_out.reason


def test_no_printed_number_on_films_is_forgotten():
    told = {target.printed for target in case().targets if target.kind == "calibrated"}
    assert told == {300.0, 2500.0, 80.0, 60.0, 30.0}


def test_what_section_3_calls_a_course_is_read_from_each_place_to_the_next():
    rows = [one for one in case().targets if one.kind == "trend" and one.printed == 0.0]
    assert len(rows) == 28
    assert {one.reduce for one in rows} == {"least_rise", "largest_rise"}


def test_rows_that_miss_say_why():
    told = [one for one in case().targets if one.missed]
    assert len(told) == 20
    assert not any(one.reason for one in told)
    assert all(len(one.missed) > 40 for one in told)


# ------------------------------------------------------------------ films

FEW = {
    "formulas.nodes": 33,
    "formulas.course_nodes": 33,
    "formulas.speeds": ["50 rpm", "100 rpm", "500 rpm", "3000 rpm"],
    "formulas.temperatures": ["20 degC", "50 degC", "80 degC"],
}


def read(study, **changes):
    """Readings of the first point of a study."""
    return xr.Dataset(readings_of(points(study, **changes)[:1], 1))


@cache
def films():
    """Films at few speeds and temperatures, on a coarse grid."""
    return read("films", **FEW)


def teeth(**changes):
    """Contacts of the zone at 20 degC and 3000 rpm."""
    built = points("films", **changes)[0]
    return ToothFilms.of(
        ReadingPoint(built.case.gears, built.design, built.operation, built.case.formulas)
    )


@pytest.mark.whole
def test_all_films_of_the_points_are_found():
    for name in ("films_status_a", "films_status_b"):
        assert not np.any(films()[name])
    assert films()["film_ratio_a"].shape == (1, 4)
    assert films()["warm_asperity_share_b"].shape == (1, 3)
    for name in ("film_stiffness_b", "printed_film_stiffness_a", "map_pressure_b", "map_film_a"):
        assert np.all(np.isfinite(films()[name]))


@pytest.mark.whole
def test_maps_are_the_fields_that_the_cuts_pass_through():
    found = films()
    rows, columns = found.sizes["film_map_y_place"], found.sizes["film_map_x_place"]
    for name in ("pressure", "film"):
        over = found[f"map_{name}_a"].values[0].reshape(rows, columns)
        across = found[f"cut_{name}_a"].values[0]
        middle = 0.5 * (over[rows // 2 - 1] + over[rows // 2])
        x, cut = found["film_map_x"].values[0], found["film_cut"].values[0]
        np.testing.assert_allclose(middle, np.interp(x, cut, across), rtol=0.03, atol=2e5)


@pytest.mark.whole
def test_courses_of_films_are_those_of_the_figures():
    targets = [
        one
        for one in case().targets
        if one.study == "films" and one.kind == "trend" and not one.missed
    ]
    # On a coarse grid the stiffness by the separation is a number of the grid.
    others = ("film_stiffness", "warm_film_stiffness", "late_film_gain", "late_share_gain")
    kept = [one for one in targets if one.variable[:-2] not in others]
    rows = compare(kept, {"study_films": films()})
    assert len(rows) == 19
    assert [(row.quantity, row.computed) for row in rows if row.verdict != "pass"] == []


@pytest.mark.whole
def test_a_film_that_is_the_same_at_every_speed_makes_rows_miss(monkeypatch):
    """By eq. 3 of a wave generator that always turns at 3000 rpm."""
    monkeypatch.setattr(ToothFilms, "_rolling", lambda self, angle, _: self.entrainment(angle))
    frozen = read("films", **FEW)
    rows = [
        one
        for one in case().targets
        if one.study == "films" and "speed" in one.quantity and "printed" not in one.quantity
    ]
    assert len(rows) == 10
    assert {row.verdict for row in compare(rows, {"study_films": frozen})} == {"miss"}


@pytest.mark.whole
def test_films_of_teeth_follow_the_exponents_of_their_solver():
    """At A: torque, oil and module against contacts of numbers that are changed one by one."""
    base = teeth()
    axis, speed, warm = np.zeros(1), np.array([base.zone.wave_speed]), np.array([293.15])
    oil = {
        "viscosity": float(viscosity(temperature=293.15, **base.oil)),
        "pressure_viscosity": float(pressure_viscosity(temperature=293.15, **base.oil)),
    }
    given = {
        "line_load": float(base.zone.load(axis)[0]) / base.face_width,
        "radius": float(base.zone.radius(axis)[0]),
        "speed": float(base.zone.speed(axis)[0]),
        **oil,
    }
    up, down = (_film_of({k: v * f for k, v in given.items()}, given, base) for f in (1.01, 0.99))
    slopes = dict(zip(given, np.log(up / down) / np.log(1.01 / 0.99), strict=True))
    assert slopes["speed"] == pytest.approx(slopes["viscosity"], abs=0.05)
    assert 0.4 < slopes["speed"] < 0.8
    assert -0.5 < slopes["line_load"] < -0.05

    def film(**changes):
        other = teeth(**changes)
        found = other.lines(axis, speed, warm).film.mean_film[0]
        moved = {
            "line_load": float(other.zone.load(axis)[0]) / other.face_width,
            "radius": float(other.zone.radius(axis)[0]),
            "speed": float(other.zone.speed(axis)[0]),
            "viscosity": float(viscosity(temperature=293.15, **other.oil)),
            "pressure_viscosity": float(pressure_viscosity(temperature=293.15, **other.oil)),
        }
        change = sum(slopes[key] * np.log(moved[key] / given[key]) for key in given)
        return np.log(found / base.lines(axis, speed, warm).film.mean_film[0]), change, moved

    for changes, key, factor in (
        ({"operation.torque": "390 N m"}, "line_load", 0.975),
        ({"lubricant.viscosity_40": "46.6 mm2/s"}, "viscosity", None),
        ({"gears.module": "0.49 mm"}, "radius", 0.98),
        ({"lubricant.pressure_viscosity": "22.5 1/GPa"}, "pressure_viscosity", None),
    ):
        computed, expected, moved = film(**changes)
        assert abs(computed) > 2e-3, key
        assert computed == pytest.approx(expected, rel=0.03, abs=2e-5), key
        assert factor is None or moved[key] / given[key] == pytest.approx(factor, rel=1e-9)


def _film_of(each, given, base):
    """Mean films with one number changed after the other, of contacts that are made by hand."""
    rows = [{**given, key: each[key]} for key in given]
    columns = {key: np.array([row[key] for row in rows]) for key in given}
    speed = columns.pop("speed")
    oil = {key: columns.pop(key) for key in ("viscosity", "pressure_viscosity")}
    contact = LineContact(
        **columns,
        modulus=base.modulus,
        speed_a=speed,
        speed_b=speed,
        fluid=Fluid(**oil, temperature=293.15, shear_law="newtonian"),
        texture=base.texture,
    )
    return solve_lines(contact).film.mean_film


@pytest.mark.whole
def test_closed_load_makes_thicker_films():
    axis, speed, warm = np.zeros(1), np.array([314.159]), np.array([293.15])
    printed_load, closed = (
        teeth(**{"formulas.load": load}).lines(axis, speed, warm).film.mean_film[0]
        for load in ("printed", "closed")
    )
    assert closed > 1.1 * printed_load


@pytest.mark.whole
def test_every_tooth_with_a_contact_has_a_film():
    found = read("zone_speed")
    assert not np.any(found["teeth_status"])
    assert float(found["teeth_with_films"][0, 0]) == 8.0
    solved = np.isfinite(found["tooth_film_ratio"].values[0])
    assert solved.tolist() == [True] * 8 + [False] * 5
    angle = found["tooth_angle"].values[0]
    assert np.all((curvature(angle)[0] < curvature(angle)[1]) == solved)


def test_stiffness_by_eq_16_is_that_of_a_film_that_sinks():
    """Films of a parabola that sinks by 2 nm under 3 N more."""
    x = np.linspace(-4.0, 1.5, 129)
    gap, pressure = (1e-6 + 1e-7 * x**2)[None], np.maximum(1.0 - x**2, 0.0)[None]
    films, more = (
        Mock(spec=Films, film=Mock(spec=LineFilm, x=x[None], pressure=pressure, gap=one))
        for one in (gap, gap - 2e-9)
    )
    found = load_over_film_step(films, more, np.array([3.0]))
    np.testing.assert_allclose(found, 3.0 / 2e-9, rtol=1e-6)


def test_peaks_are_counted_that_stand_out():
    x = np.linspace(-2.0, 1.2, 129)
    hump = np.sqrt(np.maximum(1.0 - x**2, 0.0))
    spike = 0.8 * np.exp(-(((x - 0.85) / 0.03) ** 2))
    ripple = 2e-4 * np.sin(200.0 * x)
    assert [_peaks(one) for one in (hump, hump + ripple, hump + spike)] == [1, 1, 2]


def test_late_gain_compares_the_last_two_steps():
    speeds = np.array([1.0, 2.0, 4.0, 5.0])
    assert _late_gain(speeds, np.array([0.0, 9.0, 11.0, 11.5])) == pytest.approx(0.5)
    assert _late_gain(speeds, 3.0 * speeds) == pytest.approx(1.0)
    assert np.isnan(_late_gain(speeds[:2], speeds[:2]))


def test_numbers_across_are_those_of_a_film_made_by_hand():
    x = np.linspace(-6e-3, 3e-3, 901)
    tapered = 1e-6 * (1.0 - 0.1 * x / 2e-3)
    pressure = np.maximum(1.0 - ((x + 1e-3) / 1e-3) ** 2, 0.0)
    film = Mock(spec=PatchFilm, x=x, half_width=2e-3, pressure=pressure[None], gap=tapered[None])
    assert _across(film, 0) == pytest.approx(
        {"peak_place": -0.5, "pressure_peaks": 1.0, "entry_film": 1.1 / 0.9, "film_spread": 0.1}
    )

    failed = Mock(spec=PatchFilm, x=x, half_width=2e-3, pressure=np.nan * film.pressure)
    failed.gap = np.nan * film.gap
    assert all(np.isnan(one) for one in _across(failed, 0).values())


def test_a_place_without_contact_is_refused():
    with pytest.raises(InputError, match=r"eqs\. 1 to 5 give no contact") as told:
        teeth().patch(np.deg2rad(15.0), 314.0, 293.15, 33)
    assert told.value.key == "formulas.angles"


def test_entrainment_is_that_of_eq_3_times_its_factor():
    contacts = teeth(**{"formulas.entrainment_factor": [0.5, 2.0]})
    angle = np.deg2rad([0.0, 3.5, 7.0, 12.0])
    expected = np.array([0.5, 1.0, 2.0, 2.0]) * contacts.zone.speed(angle)
    np.testing.assert_allclose(contacts.entrainment(angle), expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("map_angle", ["10 deg", "5 deg"], "the angles have to rise"),
        ("map_distance", [0.0, 0.1, 0.2], "3 distances were given for 2 angles"),
        ("angles", ["7 deg", "7 deg"], "B lies further from the long axis than A"),
        ("temperatures", ["30 degC", "20 degC"], "the temperatures have to rise"),
        ("course_nodes", 100, "33, 65, 129 or 257"),
    ],
)
def test_what_the_table_does_not_take(key, value, words):
    with pytest.raises(InputError, match=words) as told:
        points("films", **{f"formulas.{key}": value})
    assert told.value.key.startswith(f"formulas.{key}")


def test_double_arc_teeth_have_no_films_of_base_circles():
    built = points("double_arc")[0]
    with pytest.raises(InputError, match="involute") as told:
        zone.zone_of(
            ReadingPoint(built.case.gears, built.design, built.operation, built.case.formulas)
        )
    assert told.value.key == "gears.tooth.form"


def test_oil_of_the_case_is_that_of_table_2():
    found = teeth().oil
    assert found["viscosity_0"] == pytest.approx(0.04, rel=2e-5)
    assert found["alpha"] == pytest.approx(2.2e-8, rel=1e-9)
    thicker = teeth(**{"lubricant.viscosity_40": "100 mm2/s"}).oil
    assert thicker["viscosity_0"] == pytest.approx(0.04 * 100.0 / 45.644, rel=0.01)


def test_oil_of_the_films_is_that_of_eq_12():
    pressure = np.array([0.0, 1e8, 5e8])
    found = np.asarray(teeth().fluid(333.0).viscosity_at(pressure, 0.0))
    # The law of the library has 1/(5.1e-9 1/Pa) rounded to 196 MPa.
    expected = viscosity(temperature=333.0, pressure=pressure, **OIL)
    np.testing.assert_allclose(found, expected, rtol=2.5e-3)


def test_misprinted_oil_is_as_much_thicker_at_any_pressure():
    factor = teeth().misprint
    for at in ({"temperature": 293.0}, {"temperature": 353.0, "pressure": 3e8}):
        ratio = printed_viscosity(**at, **OIL) / viscosity(**at, **OIL)
        assert ratio == pytest.approx(factor, rel=1e-4)


def test_map_of_the_mesh_point_acts_on_curvature():
    low = read("rated", **{"formulas.map_distance": [-1.2, 0.9]})
    assert float(low["printed_radius_root"][0, 0]) < 1.44
    assert np.all(np.diff(low["zone_added_speed"].values[0]) > 0.0)


def test_zone_of_the_case_is_that_of_eqs_1_to_6():
    contacts = teeth().zone
    angle = np.deg2rad([0.0, 5.0, 10.0])
    np.testing.assert_allclose(contacts.load(angle), 940.5053 * np.cos(4.0 * angle), rtol=1e-6)
    first, second = curvature(angle)
    np.testing.assert_allclose(contacts.radius(angle), relative_radius(first=first, second=second))
    np.testing.assert_allclose(contacts.speed(angle), speed(angle, 1))
    closed = teeth(**{"formulas.load": "closed"}).zone
    assert closed.largest_load == pytest.approx(262.05, abs=0.01)


@pytest.mark.parametrize(
    ("key", "value", "names"),
    [
        ("gears.tooth.pressure_angle", "20.1 deg", {"base radius", "tooth force, eq. 6 as"}),
        (
            "gears.wave_generator.deflection",
            1.15,
            {"relative radius at 10", "in deep mesh, largest"},
        ),
        ("operation.speed", "2500 rpm", {"eq. 3, largest, parts opposed", "entrainment in deep"}),
        ("operation.torque", "401 N m", {"largest tooth force, N = 12, two zones", "torque from"}),
        ("gears.teeth", [180, 182], {"transmission ratio", "base radius", "speed of the wave"}),
        ("gears.fixed", "flexspline", {"speed of the wave"}),
        ("gears.module", "0.55 mm", {"relative radius in deep mesh, largest", "base radius"}),
    ],
)
def test_other_inputs_miss_what_rests_on_them(key, value, names):
    found = missed("rated", **{key: value})
    assert all(any(name in one for one in found) for name in names)
    assert not found & {"equivalent modulus, eq. 11", "viscosity at 313 K, eq. 12 corrected"}


def test_twenty_teeth_on_each_side_miss_the_closed_loads(monkeypatch):
    monkeypatch.setattr(zone, "loaded_count", printed_count)
    monkeypatch.setattr(of_case, "loaded_count", printed_count)
    found = missed("rated")
    assert {"largest tooth force, N = 12, one zone", "largest tooth force, N = 12, two zones"} <= (
        found
    )


def test_oil_of_another_temperature_misses_its_viscosity():
    assert "viscosity at 313 K, eq. 12 corrected" in missed(
        "rated", **{"operation.temperature": "314 K"}
    )
