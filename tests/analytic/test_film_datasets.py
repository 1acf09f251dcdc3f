"""Solved films as datasets: named, with units, saved and back as a start."""

import dataclasses
import json

import jax
import numpy as np
import pytest
import xarray as xr
from sound import OnDemand

from pitchpoint.core.doubts import Doubt
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.solve import _begin, solve_lines
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials.fluid import Fluid
from pitchpoint.results.film_datasets import film_dataset, films_of_dataset
from pitchpoint.results.store import load, save

STEEL = Conductor(conductivity=46.0, heat_capacity=3.64e6)
OIL = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8, "viscosity_slope": 0.04}


def contact(line_load, **others):
    given = {
        "line_load": np.asarray(line_load),
        "radius": 0.01,
        "modulus": 2.26e11,
        "speed_a": 5.25,
        "speed_b": 4.75,
        "fluid": Fluid(**OIL, shear_law="ree_eyring_1955"),
    }
    return LineContact(**(given | others))


def warm(line_load):
    return contact(line_load, conduction=Conduction(a=STEEL, b=STEEL, oil_conductivity=0.14))


@pytest.fixture(scope="module")
def solved():
    """Films by what is special about them."""
    of = {
        "warm": lambda: solve_lines(warm([[2e5, 3e5, 0.0]]), nodes=33),
        "isothermal": lambda: solve_lines(contact(2e5), nodes=33),
        "without profiles": lambda: solve_lines(contact([2e5, 3e5]), nodes=33, profiles=False),
    }
    return OnDemand(lambda kind: of[kind]())


@pytest.mark.parametrize(
    "kind", ["isothermal", "without profiles", pytest.param("warm", marks=pytest.mark.whole)]
)
def test_films_come_back_from_a_file_as_they_were(solved, kind, tmp_path):
    films = solved[kind]
    data = film_dataset(films)
    save(data, tmp_path / "films.nc")
    found = load(tmp_path / "films.nc")
    assert found.identical(data)
    again = films_of_dataset(found)
    assert (again.nodes, again.warnings) == (films.nodes, films.warnings)
    for one, other in zip(leaves(again), leaves(films), strict=True):
        np.testing.assert_array_equal(one, other)


def leaves(films):
    return jax.tree.leaves((films.film, films.ended, films.domain))


@pytest.mark.whole
def test_every_number_of_films_is_in_their_dataset(solved):
    """Fields that are added to films later have to be named and described."""
    for films in (solved["warm"], solved["isothermal"], solved["without profiles"]):
        data = film_dataset(films)
        assert len(data.variables) == len(leaves(films))
        for variable in data.variables.values():
            assert variable.attrs["units"] and variable.attrs["long_name"]


@pytest.mark.whole
def test_axes_have_names_and_places_are_a_coordinate(solved):
    warm, alone = film_dataset(solved["warm"]), film_dataset(solved["isothermal"])
    assert warm["pressure"].dims == ("contact_1", "contact_2", "node")
    assert "x" in warm.coords and warm["x"].attrs["units"] == "m"
    assert alone["central_film"].dims == () and alone["pressure"].dims == ("node",)
    named = film_dataset(solved["warm"], dims=("speed", "load"))
    assert named["stiffness"].dims == ("speed", "load")
    assert named["stiffness"].attrs["units"] == "N/m2"
    with pytest.raises(InputError, match="1 names for the 2 axes of the contacts"):
        film_dataset(solved["warm"], dims=("load",))


@pytest.mark.whole
def test_statuses_have_their_sentences_and_warnings_are_kept(solved):
    told = film_dataset(solved["warm"])
    sentences = json.loads(told["ended_code"].attrs["sentences"])
    assert sentences["0"] == "a solution was found"
    assert sentences[str(int(told["ended_code"][0, 2]))] == "no load presses the bodies together"
    films = dataclasses.replace(solved["warm"], warnings=(Doubt("one"), Doubt("two")))
    assert json.loads(film_dataset(films).attrs["warnings"]) == ["one", "two"]


@pytest.mark.whole
def test_saved_films_are_a_start(solved, tmp_path):
    save(film_dataset(solved["warm"]), tmp_path / "films.nc")
    start = films_of_dataset(load(tmp_path / "films.nc"))
    case = warm([[2.1e5, 3.1e5, 0.0]])
    onward, afresh = solve_lines(case, nodes=33, start=start), solve_lines(case, nodes=33)
    one, other = onward.film.central_film[0, :2], afresh.film.central_film[0, :2]
    np.testing.assert_allclose(one, other, rtol=1e-7)
    assert (onward.ended.iterations < afresh.ended.iterations)[0, :2].all()


def test_other_datasets_are_no_films(solved):
    with pytest.raises(InputError, match="a dataset without 'x' is none of solved films"):
        films_of_dataset(xr.Dataset({"pressure": 1.0}))
    with pytest.raises(
        InputError, match="a start of type Dataset is no films; `films_of_dataset` mak"
    ):
        _begin(film_dataset(solved["isothermal"]), 2, 33)
    with pytest.raises(InputError, match="on 0 nodes are no start for 2 contacts on 33 nodes"):
        solve_lines(contact([2e5, 3e5]), nodes=33, start=solved["without profiles"])
