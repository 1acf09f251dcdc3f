"""A case file whose friction is that of solved films, from the command line to its report."""

import json
import sys
from dataclasses import replace

import numpy as np
import pytest
from sound import PAIR

from pitchpoint.cases.laws import FRICTION
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


@pytest.mark.usefixtures("coarse")
def test_a_run_tells_turns_and_what_is_left_out(tmp_path, capsys, monkeypatch):
    file, out = tmp_path / "pair.toml", tmp_path / "out"
    file.write_text(FILE, "utf-8")
    sweep = "operation.speed=1000 rpm:2000 rpm:2"
    command = ["pitchpoint", "run", str(file), "-o", str(out), "--sweep", sweep]
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
