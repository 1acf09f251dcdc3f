"""A case file whose friction is that of solved films, from the command line to its report."""

import json
import sys
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from sound import PAIR

from pitchpoint.analyses.solved_films import FILM
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.resolved_inputs import resolved
from pitchpoint.cases.variant import Variant
from pitchpoint.cli import main
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.traction import EHL_LINE
from pitchpoint.results.store import load

FILE = f"""{PAIR}
[models]
friction = ["ehl_line", "xu_2007"]
"""


@pytest.fixture
def coarse(monkeypatch):
    films = FilmModel(nodes=33)
    monkeypatch.setitem(FRICTION._entries, "ehl_line", replace(EHL_LINE, films=films))


@pytest.mark.whole
@pytest.mark.usefixtures("coarse")
def test_a_run_tells_turns_and_what_is_left_out(tmp_path, capsys, monkeypatch):
    file, out = tmp_path / "pair.toml", tmp_path / "out"
    file.write_text(FILE, "utf-8")
    sweep = "operation.speed=1000 rpm:2000 rpm:2"
    command = ["pitchpoint", "run", str(file), "-o", str(out), "--full", "--sweep", sweep]
    monkeypatch.setattr(sys, "argv", command)
    with pytest.raises(SystemExit) as stop:
        main()
    assert not stop.value.code
    said = " ".join(capsys.readouterr().out.split())
    assert "films and forces agree after" in said
    page = " ".join((out / "report.html").read_text("utf-8").split())
    assert "agree after" in page
    assert "at very many operating points" in page
    point = load(out / "default" / "operation.nc")
    assert (point["turns"].values.ravel() > 0).tolist() == [True, False]
    assert json.loads(point.attrs["solve"])["code"] == 0
    (swept,) = (load(path) for path in (out / "default").glob("study_*.nc"))
    lost = 1.0 - swept["mean_efficiency"].values
    at = 1.0 - point["mean_efficiency"].values
    assert (lost[:, 0] > at[:, 0]).all() and (at[:, 0] > lost[:, 1]).all()
    assert np.isfinite(lost).all()
    assert lost[0] != pytest.approx(lost[1], rel=1e-3)


def refused(file, capsys, monkeypatch, *more):
    """What a run that ends at once says."""
    command = ["pitchpoint", "run", str(file), "-o", str(file.parent / "out"), *more]
    monkeypatch.setattr(sys, "argv", command)
    with pytest.raises(SystemExit) as stop:
        main()
    assert stop.value.code == 2
    return " ".join(capsys.readouterr().err.split())


@pytest.mark.whole
@pytest.mark.parametrize(
    ("law", "told"),
    [
        ("xu_2007", 'no law of the case is that of them; name "ehl_line" in models.friction'),
        ("ehl_line", "at film.boundary_friction = 0.05: film.solver: is missing"),
    ],
)
def test_choices_of_films_are_swept_where_a_table_and_a_law_solve_them(
    law, told, tmp_path, capsys, monkeypatch
):
    file = tmp_path / "pair.toml"
    file.write_text(f'{PAIR}\n[models]\nfriction = "{law}"\n', "utf-8")
    sweep = "film.boundary_friction=0.05:0.15:2"
    assert told in refused(file, capsys, monkeypatch, "--sweep", sweep)


def film_rows(text):
    """Value and status of the inputs of films, by key."""
    variant = Variant(tomllib.loads(text), "pair.toml", "default")
    rows = resolved(variant.built({}), variant.document())
    return {row["key"]: (row["value"], row["status"]) for row in rows if row["table"] == "film"}


def test_what_decides_about_films_is_among_the_inputs():
    by_law = film_rows(FILE)
    assert by_law["inlet"] == (0.002, "default")
    assert by_law["boundary_friction"] == (0.1, "default")
    assert by_law["eyring_stress"] == (5e6, "default")
    assert by_law["thermal"] == ("isothermal", "default")
    assert {status for _, status in by_law.values()} == {"default"}
    given = 'solver = "line"\nnodes = 65\nasperities = "none"\nshear_law = "newtonian"'
    smooth = film_rows(f"{FILE}\n[film]\n{given}\n")
    assert smooth["nodes"] == (65.0, "given")
    assert smooth["shear_law"] == ("newtonian", "given")
    assert smooth["viscosity_law"] == ("roelands_1966", "default")
    assert not {"eyring_stress", "pattern", "boundary_friction"} & smooth.keys()
    hybrid = 'solver = "line"\nviscosity_law = "bair_2015"\npaluch_share = 0.2'
    printed = film_rows(f"{FILE}\n[film]\n{hybrid}\n")
    assert printed["paluch_share"] == (0.2, "given")
    assert printed["mcewen_exponent"] == (3.0, "default")
    warm = film_rows(f'{FILE}\n[film]\nsolver = "line"\nthermal = "mean_film"\n')
    assert warm.keys() - by_law.keys() == {"solver", "phases", "in_series"}
    assert film_rows(PAIR) == {}


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("named", ["none", "wu_cheng_1991"])
def test_a_rolling_resistance_that_is_not_of_the_films_is_told(named):
    settings = {
        "film.solver": "line",
        "film.nodes": "33",
        "film.phases": "3",
        "models.friction": "ehl_line",
        "models.rolling_resistance": named,
    }
    variant = Variant(tomllib.loads(PAIR), "pair.toml", "default")
    case = variant.built(settings)
    data = FILM.joined(case, [FILM.compute(case, one, lambda _: None) for one in FILM.pieces(case)])
    told = data.attrs["other_rolling"]
    assert ("takes rolling resistance from" in told) == (named != "none")
    off = abs(float(data["mean_law_loss"][0]) / float(data["mean_film_loss"]) - 1.0)
    assert (off < 1e-5) == (named == "none")
