"""Studies in pieces: any range of designs alone, a store of whole files, one dataset over them."""

import copy
import errno
import hashlib
import json
import logging
import sys
from collections.abc import Generator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import pitchpoint as pp
from pitchpoint import cli
from pitchpoint.analyses.design_batch import CaseDesigns
from pitchpoint.errors import InputError, PitchpointError
from pitchpoint.results import store
from pitchpoint.results.netcdf import encode
from pitchpoint.results.pieces import ALONG, StudyPieces, joined_pieces, summary_of
from pitchpoint.runs import workers
from pitchpoint.runs.described import StudyDescription, piece_elsewhere
from pitchpoint.runs.layouts import layout_of
from pitchpoint.runs.run import Progress

TORQUE, WIDTH = "operation.torque", "gears.face_width"
PAIR = pp.Case(
    gears={"teeth": [20, 40], "module": "2 mm", "face_width": "20 mm"},
    lubricant={"name": "pao-vg-150"},
    roughness={"ra": "0.4 um"},
    operation={"torque": "60 N m", "speed": "1200 rpm", "temperature": "50 degC"},
)
VARIANT = PAIR.held[0].computed
RANGES = {TORQUE: [5.0, 45.0], WIDTH: ["10 mm", "30 mm"]}
LISTS = {TORQUE: [5.0, 6.0, 7.0, 8.0], WIDTH: ["10 mm", "20 mm", "25 mm", "30 mm"]}


def test_a_number_is_the_same_however_it_is_written() -> None:
    """Marks of studies hang on SI numbers, those of the case and those of the designs."""

    def mark(torque: str, low: str) -> str:
        variant = PAIR.set({TORQUE: torque}).held[0].computed
        over = {WIDTH: {"start": low, "stop": "30 mm", "distribution": "normal"}}
        return StudyDescription(variant, over, "sobol", 16, 3, 16).mark

    assert mark("60 N m", "10 mm") == mark("60.0 N m", "0.01 m") == mark("60000 N mm", "10.0 mm")
    assert len({mark("60 N m", "10 mm"), mark("61 N m", "10 mm"), mark("60 N m", "11 mm")}) == 3


def test_the_table_of_a_study_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    from pitchpoint.runs import study as runs

    case = PAIR.set({"study": {"over": {TORQUE: ["5 N m", "6 N m"]}}})
    read: list[Any] = []
    validated = runs.validate
    monkeypatch.setattr(runs, "validate", lambda case: read.append(case) or validated(case))
    assert runs.table_of_study(case) is runs.table_of_study(case.set({})) and len(read) == 1


@pytest.mark.parametrize(
    ("over", "how", "n"),
    [
        (LISTS, "grid", None),
        (LISTS, "zip", None),
        (RANGES, "latin_hypercube", 16),
        (RANGES, "sobol", 16),
        (RANGES, "saltelli", 16),
    ],
)
def test_any_range_of_designs_is_made_without_the_others(
    over: dict[str, Any], how: str, n: int | None
) -> None:
    layout = layout_of(VARIANT, over, how, n, 3)
    every = layout.changes(0, layout.count)
    assert len({str(design) for design in every}) == layout.count or how == "saltelli"
    ends = [0, 1, 3, layout.count]
    parts = [layout.changes(first, stop) for first, stop in pairwise(ends)]
    assert [design for part in parts for design in part] == every


def test_whole_numbers_are_drawn_alike_from_end_to_end() -> None:
    for how in ("latin_hypercube", "sobol"):
        drawn = layout_of(VARIANT, {"gears.teeth.1": [20, 23]}, how, 4096, 3).columns(0, 4096)
        values, counts = np.unique(
            [float(value) for value in drawn["gears.teeth.1"]], return_counts=True
        )
        assert values.tolist() == [20.0, 21.0, 22.0, 23.0]
        np.testing.assert_allclose(counts, 1024, atol=2)


@pytest.mark.parametrize("how", ["grid", "zip"])
def test_values_that_are_given_take_no_number_of_designs(how: str) -> None:
    with pytest.raises(
        InputError, match=r"^n: 8 was given, and a (grid|zip) has as many designs as its val"
    ):
        layout_of(VARIANT, LISTS, how, 8, 3)


def test_what_draws_the_designs_is_in_the_mark(monkeypatch: pytest.MonkeyPatch) -> None:
    first = StudyDescription(VARIANT, RANGES, "sobol", 4, 0, 4).mark
    monkeypatch.setattr("pitchpoint.runs.described.version", lambda package: "another")
    assert StudyDescription(VARIANT, RANGES, "sobol", 4, 0, 4).mark != first
    theirs = piece_elsewhere(
        StudyDescription(VARIANT, RANGES, "sobol", 4, 0, 4).packed, first, 0, 4
    )
    on_a_grid = StudyDescription(VARIANT, LISTS, "grid", None, 0, 4).mark
    monkeypatch.undo()
    assert isinstance(theirs, dict)
    here = StudyDescription(VARIANT, RANGES, "sobol", 4, 0, 4).decisive
    assert workers._other(theirs, here).startswith(
        "a worker has what gives other numbers than here: scipy another"
    )
    # A grid is what its values make, whatever version SciPy has.
    assert StudyDescription(VARIANT, LISTS, "grid", None, 0, 4).mark == on_a_grid


def test_what_is_logged_of_lost_connections_does_not_stand_before_the_sentence() -> None:
    pytest.importorskip("distributed")
    logs = [logging.getLogger(name) for name in ("distributed", "distributed.client")]
    before = [log.level for log in logs]
    with workers._quiet():
        assert not any(log.isEnabledFor(logging.ERROR) for log in logs)
    assert [log.level for log in logs] == before


class Failed:
    """What a worker made of a piece: an error."""

    def __init__(self, failure: BaseException) -> None:
        self.failure = failure

    def exception(self) -> BaseException:
        return self.failure

    def result(self) -> bytes:
        raise self.failure


@pytest.mark.parametrize(
    ("failure", "kind", "told"),
    [
        (
            OSError(errno.ENOSPC, "No space left"),
            PitchpointError,
            "a worker that computed designs 4 to 7 failed: ",
        ),
        (ZeroDivisionError("by zero"), ZeroDivisionError, "by zero"),
        (TypeError("unsupported operand"), TypeError, "unsupported operand"),
        (
            TypeError("piece_elsewhere() takes 3"),
            InputError,
            "scheduler: a worker has no pitchpoint, or ano",
        ),
        (
            ModuleNotFoundError("No module named 'pitchpoint'"),
            InputError,
            "scheduler: a worker has no pit",
        ),
    ],
)
def test_what_a_worker_fails_at_is_told_as_its_own(
    failure: BaseException, kind: type[BaseException], told: str
) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(kind) as caught:
        workers._image(Failed(failure), (4, 8), {})  # type: ignore[arg-type]
    assert type(caught.value) is kind and str(caught.value).startswith(told)


@pytest.mark.parametrize(("over", "how", "n"), [(LISTS, "grid", None), (RANGES, "sobol", 1 << 20)])
def test_a_description_is_less_than_a_kilobyte(
    over: dict[str, Any], how: str, n: int | None
) -> None:
    study = StudyDescription(VARIANT, over, how, n, 3, 4096)
    assert len(study.packed) + len(study.mark) < 1000
    again = StudyDescription.read(study.packed)
    assert again.mark == study.mark
    assert again.layout.changes(5, 9) == study.layout.changes(5, 9)


def _piece(first: int, stop: int, *, figures: bool = True) -> xr.Dataset:
    """A piece of which design 2 has no figures."""
    number = np.arange(first, stop)
    reason = np.where(number == 2, "too thin", "" if figures else [f"no {n}.5 mm" for n in number])
    made: dict[str, Any] = {"reason": (("law", ALONG), reason[None])}
    if figures:
        loss = np.where(number == 2, np.nan, number + 0.5)
        made |= {
            "mean_loss": (("law", ALONG), loss[None], {"units": "W"}),
            "locked": (("law", ALONG), (number == 0)[None]),
            "iterations": (
                ("law", ALONG),
                number[None] if first else np.where(loss > 0, 3.0, np.nan)[None],
            ),
            "bearing_load": (("law", ALONG, "place"), number[None, :, None] + np.array([0.1, 0.2])),
        }
    attributes = {"solve": '{"residual": 1e-9, "iterations": 4}'} if figures else {}
    keys = {ALONG: number, TORQUE: (ALONG, number * 10.0)}
    return xr.Dataset(made, {"law": ["xu_2007"], **keys}, {"fingerprint": "mark", **attributes})


@pytest.fixture(params=["memory", "folder"])
def pieces(request: pytest.FixtureRequest, tmp_path: Path) -> StudyPieces:
    folder = tmp_path if request.param == "folder" else None
    made = StudyPieces(folder, "designs", "mark", 12, 4)
    for number in (2, 0, 1):  # in whatever order
        made.keep(number, _piece(*made.range(number), figures=number < 2))
    return made


def _codes(piece: xr.Dataset) -> np.ndarray:
    return np.zeros(piece.sizes[ALONG], int)


def test_pieces_are_read_as_one_dataset(pieces: StudyPieces) -> None:
    assert pieces.missing() == []
    summary = summary_of(pieces, _codes)
    assert summary.reasons == {"no 8.5 mm": 4, "too thin": 1}
    assert summary.dtypes["locked"].kind == "b"
    data = joined_pieces(pieces, summary, {ALONG: 12}, lambda part: part)
    expected = np.where(np.arange(12) < 8, np.arange(12) + 0.5, np.nan)
    expected[2] = np.nan
    np.testing.assert_array_equal(data.mean_loss.values[0], expected)
    np.testing.assert_array_equal(data.mean_loss[0, [7, 1, 5]], expected[[7, 1, 5]])
    assert data.bearing_load[0, 5, 1].item() == 5.2
    np.testing.assert_array_equal(data.bearing_load[0, 3:6, 0], [3.1, 4.1, 5.1])
    assert data[TORQUE][11].item() == 110.0
    assert data.mean_loss.attrs == {"units": "W"}


def test_designs_of_a_grid_have_a_dimension_for_each_key(pieces: StudyPieces) -> None:
    data = joined_pieces(pieces, summary_of(pieces, _codes), {"a": 3, "b": 4}, lambda part: part)
    flat = np.arange(12.0) + 0.5
    flat[[2, *range(8, 12)]] = np.nan
    np.testing.assert_array_equal(data.mean_loss.values[0], flat.reshape(3, 4))
    picked = data.mean_loss.isel(law=0, a=[1, 0], b=slice(1, 3))
    np.testing.assert_array_equal(picked, flat.reshape(3, 4)[[1, 0], 1:3])
    assert data.mean_loss.isel(law=0, a=1, b=3).item() == 7.5


@pytest.mark.parametrize("harm", ["gone", "cut", "of another study"])
def test_a_piece_that_is_not_whole_is_missing(harm: str, tmp_path: Path) -> None:
    pieces = StudyPieces(tmp_path, "designs", "mark", 8, 4)
    for number in (0, 1):
        pieces.keep(number, _piece(*pieces.range(number)))
    path = pieces.path(1)
    assert path is not None
    if harm == "gone":
        path.unlink()
    elif harm == "cut":
        path.write_bytes(path.read_bytes()[:-100])
    else:
        pieces.keep(1, _piece(4, 8).assign_attrs(fingerprint="another"))
    assert pieces.missing() == [1]


def _computed(self: CaseDesigns, progress: Any = None) -> xr.Dataset:
    """Figures that take no time."""
    torque = np.array([float(str(change[TORQUE]).split()[0]) for change in self.changes])
    values = {
        "mean_loss": (("law", "point"), np.sin(torque)[None], {"units": "W", "long_name": "loss"}),
        "residual": (("law", "point"), np.zeros((1, len(torque)))),
        "iterations": (("law", "point"), np.ones((1, len(torque)), int)),
        "locked": (("law", "point"), np.zeros((1, len(torque)), bool)),
        "reason": (("law", "point"), np.full((1, len(torque)), "")),
    }
    solve = {"solve": '{"residual": 0.0, "iterations": 1}'}
    return xr.Dataset(values, {"law": ["xu_2007"]}, solve)


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CaseDesigns, "compute", _computed)


class Interrupted(Progress):
    """Interrupts after some pieces, and notes what it hears."""

    def __init__(self, after: int) -> None:
        self.left, self.heard = after, list[str]()

    def points(self, done: int, doing: str = "") -> None:
        self.heard.append(f"{done} {doing}")
        if done % 4 == 0 and done:
            self.left -= 1
            if self.left == 0:
                raise KeyboardInterrupt


def _digests(folder: Path) -> dict[str, str]:
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.glob("*.nc")
    }


def _study(folder: Path, **more: Any) -> xr.Dataset:
    return pp.study(PAIR, {TORQUE: (5.0, 45.0)}, "sobol", n=16, folder=folder, piece=4, **more)


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("after", [1, 3])
def test_an_interrupted_study_goes_on_to_the_same_bits(after: int, tmp_path: Path) -> None:
    whole, resumed = tmp_path / "whole", tmp_path / "resumed"
    found = _study(whole)
    assert len(_digests(whole)) == 4
    with pytest.raises(KeyboardInterrupt):
        _study(resumed, progress=Interrupted(after))
    assert len(_digests(resumed)) == after
    heard = Interrupted(0)
    again = _study(resumed, progress=heard)
    assert _digests(resumed) == _digests(whole)
    assert heard.heard[-1].startswith("16 of 16, ") and heard.heard[-1].endswith("0 s left")
    xr.testing.assert_identical(again.load(), found.load())


@pytest.mark.usefixtures("quick")
def test_pieces_of_workers_are_those_of_this_process(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def backwards(
        study: StudyDescription, pieces: StudyPieces, missing: list[int], *_: Any
    ) -> Generator[tuple[int, bytes], None, None]:
        for number in reversed(missing):
            made = piece_elsewhere(study.packed, study.mark, *pieces.range(number))
            assert isinstance(made, bytes)
            yield number, made

    monkeypatch.setattr("pitchpoint.runs.study.pieces_of_workers", backwards)
    _study(tmp_path / "here")
    _study(tmp_path / "there", workers=2)
    assert _digests(tmp_path / "there") == _digests(tmp_path / "here")


@pytest.mark.usefixtures("quick")
def test_a_worker_of_another_version_is_told() -> None:
    study = StudyDescription(VARIANT, RANGES, "sobol", 4, 0, 4)
    theirs = piece_elsewhere(study.packed, "another", 0, 4)
    assert isinstance(theirs, dict)
    here = study.decisive
    told = workers._other({**theirs, "jax": "0.1"}, here)
    assert told.startswith("a worker has what gives other numbers than here: jax 0.1 for ")
    assert workers._other(theirs, here) == "a worker does not have the files that the case names"


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"scheduler": "tcp://127.0.0.1:1"}, '"tcp://127.0.0.1:1": Connection refused; `dask sch'),
        ({"scheduler": "here"}, 'no scheduler at "here": Invalid url scheme'),
        (
            {"scheduler": "tcp://127.0.0.1:1", "workers": 2},
            "workers: goes with workers of this mac",
        ),
        ({"workers": 0}, "workers: 0 was given where a whole number from 1 on belongs"),
        ({"piece": 0}, "piece: 0 was given where a whole number from 1 on belongs"),
        ({"n": 1 << 20}, "folder: 1048576 designs need a folder to be kept in; 100000 at most"),
        (
            {"workers": 2, "friction": lambda film_thickness: film_thickness},
            "functions of this pro",
        ),
    ],
)
@pytest.mark.usefixtures("quick")
def test_workers_that_cannot_be_had(more: dict[str, Any], told: str) -> None:
    if "scheduler" in more:
        pytest.importorskip("distributed")
    with pytest.raises(InputError) as caught:
        pp.study(PAIR, {TORQUE: (5.0, 45.0)}, "sobol", **({"n": 16} | more))
    assert told in str(caught.value)


def test_a_copied_error_shares_nothing_though_a_package_pickles_tracebacks() -> None:
    """`dask` brings one whose copies of exceptions hold the very dictionary of the first one."""
    support = pytest.importorskip("tblib.pickling_support")
    support.install(InputError)
    error = InputError("is missing", key="module")
    assert error.at(key="gears.module").key == "gears.module"
    assert error.key == "module"
    assert copy.copy(error).message == "is missing"


def test_a_piece_is_its_file_bit_for_bit(tmp_path: Path) -> None:
    made = [StudyPieces(tmp_path / name, "designs", "mark", 4, 4) for name in ("dataset", "bytes")]
    made[0].keep(0, _piece(0, 4))
    made[1].keep(0, encode(_piece(0, 4)))
    first, second = (pieces.path(0) for pieces in made)
    assert first is not None and second is not None and first.read_bytes() == second.read_bytes()


def test_a_file_of_a_piece_is_held_in_memory_where_there_is_no_folder() -> None:
    pieces = StudyPieces(None, "designs", "mark", 4, 4)
    pieces.keep(0, encode(_piece(0, 4)))
    assert pieces.missing() == []
    xr.testing.assert_identical(pieces.read(0), _piece(0, 4))


def _command(*given: str) -> int:
    with pytest.MonkeyPatch.context() as patched, pytest.raises(SystemExit) as ended:
        patched.setattr(sys, "argv", ["pitchpoint", "study", *given])
        cli.main()
    return int(ended.value.code or 0)


DRAWN = ("--over", "torque=5 N m:45 N m", "--how", "sobol", "-n", "16", "--piece", "4")


@pytest.fixture
def case(tmp_path: Path) -> str:
    PAIR.to_toml(tmp_path / "pair.toml")
    return str(tmp_path / "pair.toml")


@pytest.mark.usefixtures("quick")
def test_the_command_computes_the_study_of_python(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _command(case, *DRAWN, "-o", str(tmp_path / "out")) == 0
    told = capsys.readouterr().out
    assert "16 designs\n" in told and f"every design: {tmp_path / 'out'}" in told
    assert len(_digests(tmp_path / "out")) == 4
    assert {path.name for path in (tmp_path / "out").iterdir()} >= {"report.html", "case.toml"}
    assert f"report: {tmp_path / 'out' / 'report.html'}" in told
    assert _command(case, *DRAWN, "-o", str(tmp_path / "out"), "--json") == 0
    found = json.loads(capsys.readouterr().out)
    loss = np.sin(_study(tmp_path / "python")[TORQUE].values)
    ends = found["figures"]["mean_loss"]["by_law"]["xu_2007"]
    assert [ends["least"], ends["largest"]] == pytest.approx([loss.min(), loss.max()])
    assert (found["designs"], found["reasons"]) == (16, {})


@pytest.mark.usefixtures("quick")
def test_values_of_a_grid_are_ranges_and_lists(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    over = ("--over", "torque=5 N m:45 N m:3", "--over", 'gears.face_width=["9 mm", "10 mm"]')
    assert _command(case, *over, "-o", str(tmp_path / "out"), "--json") == 0
    assert json.loads(capsys.readouterr().out)["designs"] == 6
    (piece,) = (tmp_path / "out").glob("*.nc")
    with xr.open_dataset(piece, engine="h5netcdf") as kept:
        np.testing.assert_allclose(kept[TORQUE], [5.0, 5.0, 25.0, 25.0, 45.0, 45.0])
        np.testing.assert_allclose(kept[WIDTH], [0.009, 0.01] * 3)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (("--over", "torque"), '--over: "torque" is not KEY=VALUES, such as --over operation.tor'),
        (("--over", "torque=[5]", "--over", "torque=[6]"), '--over: "torque" was given twice'),
        (("--over", "torque=5:6:0"), "is not KEY=START:STOP:COUNT with a count of 1 to 100000"),
        ((), 'table [study] of the case or by option: --over operation.torque="20 N m:90 N m:8"'),
        ((*DRAWN, "--scheduler", "tcp://127.0.0.1:1"), "Connection refused; `dask scheduler` star"),
        ((*DRAWN, "--workers", "0"), "workers: 0 was given where a whole number from 1 on belongs"),
    ],
)
def test_a_command_that_cannot_be_is_one_sentence(
    given: tuple[str, ...],
    told: str,
    case: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if "--scheduler" in given:
        pytest.importorskip("distributed")
    assert _command(case, *given, "-o", str(tmp_path / "out")) == 2
    assert told in capsys.readouterr().err


@pytest.mark.usefixtures("quick")
def test_a_full_disk_is_one_sentence_and_leaves_whole_pieces(
    case: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    whole, kept = store._renamed, list[Path]()

    def renamed(path: Path, content: bytes, *, lasting: bool) -> None:
        if len(kept) == 2:
            raise OSError(errno.ENOSPC, "No space left on device")
        whole(path, content, lasting=lasting)
        kept.append(path)

    monkeypatch.setattr(store, "_renamed", renamed)
    assert _command(case, *DRAWN, "-o", str(tmp_path / "out")) != 0
    assert "No space left on device; what was finished before is kept" in capsys.readouterr().err
    assert {path.name for path in kept} == {*_digests(tmp_path / "out")}


@pytest.mark.whole
def test_workers_of_this_machine_compute_the_same_bits(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    over = {TORQUE: (5.0, 45.0), "gears.profile_shift.1": (0.0, 2.5)}  # some have pointed tips
    for name, count in (("here", None), ("there", 2)):
        found = pp.study(PAIR, over, "sobol", n=16, folder=tmp_path / name, piece=4, workers=count)
    assert 0 < np.isnan(found["mean_loss"].values[0]).sum() < 16
    assert _digests(tmp_path / "there") == _digests(tmp_path / "here")


PLAN = {"how": "sobol", "n": 16, "piece": 4, "over": {"operation.torque": ["5 N m", "45 N m"]}}


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("spelling", ["dotted", "tables"])
def test_a_table_of_the_case_is_the_study(spelling: str, tmp_path: Path) -> None:
    over = {"operation": {"torque": ["5 N m", "45 N m"]}} if spelling == "tables" else PLAN["over"]
    stated = PAIR.set({"study": {**PLAN, "over": over, "folder": "table"}})
    stated.to_toml(tmp_path / "stated.toml")
    pp.study(tmp_path / "stated.toml")
    called = dict(n=16, piece=4, folder=tmp_path / "call")
    pp.study(tmp_path / "stated.toml", {TORQUE: ["5 N m", "45 N m"]}, "sobol", **called)
    assert _digests(tmp_path / "table") == _digests(tmp_path / "call")
    assert _command(str(tmp_path / "stated.toml"), "-o", str(tmp_path / "command")) == 0
    assert _digests(tmp_path / "command") == _digests(tmp_path / "call")
    assert _command(str(tmp_path / "stated.toml"), "-n", "8", "-o", str(tmp_path / "few")) == 0
    assert len(_digests(tmp_path / "few")) == 2


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"n": 15}, "n: 15 designs were asked for; a Sobol' sequence is even with a power of two"),
        ({"over": {}}, "study.over: a study needs the values of one key at least"),
        ({"over": {"operation.torqe": [5, 6]}}, "operation.torqe: there is no such key; did you"),
        ({"over": {TORQUE: "5 N m"}}, 'operation.torque: "5 N m" was given where a list of values'),
        ({"workers": 2, "scheduler": "tcp://a:1"}, "study.workers: goes with workers of this mach"),
        (
            {"over": {TORQUE: {"start": 5, "stop": 6, "distribution": "gauss"}}},
            'operation.torque: "gauss" is no distribution; use one of "uniform", "normal"',
        ),
        (
            {"over": {TORQUE: {"start": 5, "stop": 6, "step": 2}}},
            'operation.torque: "step" is no key of a range; did you mean stop?',
        ),
        ({"tolerances": "normal"}, "tolerances: none are given; say thickness_field = "),
    ],
)
def test_a_table_that_cannot_be_is_one_sentence(
    change: dict[str, Any], told: str, tmp_path: Path
) -> None:
    from pitchpoint.runs.check import check_case

    path = tmp_path / "wrong.toml"
    path.write_text(PAIR.set({"study": {**PLAN, **change}}).to_toml())
    for asked in (pp.study, lambda case: check_case(str(case))):
        with pytest.raises(InputError) as caught:
            asked(path)
        assert told in str(caught.value) and "wrong.toml" in str(caught.value)


def test_normal_values_have_their_ends_at_three_standard_deviations() -> None:
    normal = {TORQUE: {"start": "5 N m", "stop": "45 N m", "distribution": "normal"}}
    layout = layout_of(VARIANT, normal, "sobol", 4096, 3)
    drawn = np.array([float(str(text).split()[0]) for text in layout.columns(0, 4096)[TORQUE]])
    assert drawn.min() >= 5.0 and drawn.max() <= 45.0
    assert drawn.mean() == pytest.approx(25.0, abs=0.02)
    # A standard normal distribution cut off at 3 has the variance 1 - 6 pdf(3)/(2 cdf(3) - 1).
    assert drawn.std() == pytest.approx(40.0 / 6.0 * 0.98658, rel=2e-3)


@pytest.mark.usefixtures("quick")
def test_every_design_is_a_row_of_a_file(case: str, tmp_path: Path) -> None:
    import csv

    rows = tmp_path / "rows.csv"
    over = ("--over", "torque=5 N m:45 N m:3", "--over", 'gears.face_width=["9 mm", "10 mm"]')
    assert _command(case, *over, "-o", str(tmp_path / "out"), "--csv", str(rows)) == 0
    with rows.open() as file:
        read = [*csv.DictReader(file)]
    assert [row["design"] for row in read] == ["0", "1", "2", "3", "4", "5"]
    torque = [float(row["operation.torque [N m]"]) for row in read]
    assert torque == [5.0, 5.0, 25.0, 25.0, 45.0, 45.0]
    width = [float(row["gears.face_width [mm]"]) for row in read]
    assert width == pytest.approx([9.0, 10.0] * 3)
    assert [float(row["mean_loss [W]"]) for row in read] == pytest.approx(np.sin(torque))


@pytest.mark.usefixtures("quick")
def test_the_screen_has_sobol_indices(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("pitchpoint.views.many_designs.FIGURES", ("mean_loss",))
    drawn = ("--over", "torque=5 N m:45 N m", "--over", "gears.face_width=9 mm:10 mm")
    asked = (case, *drawn, "--how", "saltelli", "-n", "64", "-o", str(tmp_path / "out"))
    assert _command(*asked) == 0
    told = capsys.readouterr().out
    assert all(text in told for text in ("256 designs", "64 of 64 designs", "0.00 to 0.00"))
    assert _command(*asked, "--json") == 0
    indices = json.loads(capsys.readouterr().out)["sobol_indices"]["mean_loss"]["xu_2007"]
    assert indices[TORQUE]["total_order"] == pytest.approx(1.0, abs=0.2)
    assert indices[WIDTH]["total_order"] == 0.0


def test_a_study_of_python_has_its_page_where_it_is_asked_for(tmp_path: Path, quick: None) -> None:
    pp.write_report(_study(tmp_path / "many"), tmp_path / "page.html")
    assert "16 designs over 1 key," in (tmp_path / "page.html").read_text("utf-8")
    assert not (tmp_path / "many" / "report.html").exists()
