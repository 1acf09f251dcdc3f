"""The budget of the suite counts what is compiled, and says which file is beyond it."""

import math
from collections import defaultdict
from types import SimpleNamespace

import budget
import pytest
from budget import (
    GROWTH,
    PROGRAMS,
    SHARED,
    Meter,
    Spent,
    exceeded,
    most_of,
    record,
    recorded,
    slow,
)

from pitchpoint._jax import jax

FIGURES = {"tests/a.py": Spent(200, loops=30.0), "tests/b.py": Spent(3, loops=1.0)}


def test_a_new_program_is_counted_once():
    meter = Meter()
    jax.monitoring.register_event_duration_secs_listener(meter.listen)
    try:
        before = meter.read()
        twice = jax.jit(lambda x: 2.0 * x + len("a program of this test"))
        given = jax.device_put(1.5)
        twice(given), twice(given)
        spent = meter.read() - before
    finally:
        jax.monitoring.unregister_event_duration_listener(meter.listen)
    assert spent.programs == 1
    assert 0.0 < spent.seconds < 10.0
    assert spent.loops == pytest.approx(spent.seconds / meter.loop)


def test_loops_are_counted_by_what_a_loop_took_then():
    meter = Meter()
    meter.read()
    meter.loop = 1e-3
    loops = meter.read().loops
    budget.seconds_of_a_loop()
    meter.calibrate()
    assert meter.loop > 1e-3
    assert meter.read().loops > loops + 1.0  # of the loops before, by the old measure


def test_a_suite_within_its_budget_is_silent():
    assert most_of(2000) == int(GROWTH * 2000)
    assert most_of(3) == 3 + SHARED
    for file in FIGURES:
        most = FIGURES[file] + Spent(SHARED, 1e6)
        spent = FIGURES | {file: most}
        assert exceeded(spent, FIGURES) == slow(spent, FIGURES) == []


def test_a_file_beyond_its_figure_is_named():
    figures = FIGURES | {"tests/c.py": Spent(3000)}
    (told,) = exceeded(figures | {"tests/a.py": Spent(301)}, figures)
    assert told == "tests/a.py asks for 301 programs, 300 are its budget"


def test_a_file_without_a_figure_is_named_where_others_have_one():
    spent = {"tests/new.py": Spent(SHARED + 1)}
    (told,) = exceeded(spent, FIGURES)
    assert told.startswith(f"tests/new.py asks for {SHARED + 1} programs")
    assert exceeded(spent, {}) == []


def test_many_files_within_their_own_figures_may_exceed_that_of_the_suite():
    figures = {f"tests/{n}.py": Spent(PROGRAMS // 10) for n in range(11)}
    (told,) = exceeded(figures, figures)
    assert told.startswith("the suite asks for ")
    assert exceeded(figures, figures, math.inf) == []


def test_a_slow_suite_is_told():
    (told,) = slow({"tests/a.py": Spent(1, 1.0, 38.0)}, FIGURES)
    assert told == "the suite takes 38 loops, 38 are its budget"
    assert slow({"tests/new.py": Spent(1, 1.0, 34.0)}, FIGURES) == []


def test_figures_are_recorded_by_part_and_those_of_other_files_stay(tmp_path):
    table = tmp_path / "tests" / "budget.toml"
    table.parent.mkdir()
    for name in ("a", "b"):
        (table.parent / f"{name}.py").touch()
    gone = {"tests/gone.py": Spent(7, loops=1.0)}
    record("quick", FIGURES | gone, table)
    record("whole", {"tests/b.py": Spent(40, 1.0, 6.0)}, table)
    record("quick", {"tests/b.py": Spent(4, loops=2.0)}, table)
    assert recorded("quick", table=table) == FIGURES | {"tests/b.py": Spent(4, loops=2.0)}
    assert recorded("whole", table=table) == {"tests/b.py": Spent(40, loops=6.0)}
    assert recorded(*budget.PARTS, table=table)["tests/b.py"] == Spent(44, loops=8.0)


def test_files_that_take_longest_start_first():
    names = ["tests/b.py", "tests/new.py", "tests/a.py"]
    assert sorted(names, key=lambda file: budget.order(file, FIGURES)) == [
        "tests/a.py",
        "tests/b.py",
        "tests/new.py",
    ]


WHOLE_SUITE = pytest.Config.ArgsSource.TESTPATHS


@pytest.fixture
def plugin(request):
    return request.config.pluginmanager.getplugin(
        str(request.config.rootpath / "tests/conftest.py")
    )


def config(source=WHOLE_SUITE, **options):
    given = {"markexpr": "not whole", "record_budget": False, "hold_pace": False} | options
    return SimpleNamespace(option=SimpleNamespace(**given), args_source=source)


@pytest.mark.parametrize(
    ("spent", "options", "status"),
    [
        (Spent(PROGRAMS, 1e6, 1e6), {}, pytest.ExitCode.OK),
        (Spent(PROGRAMS + 1), {}, pytest.ExitCode.TESTS_FAILED),
        (Spent(PROGRAMS + 1), {"markexpr": "whole"}, pytest.ExitCode.OK),
        (Spent(PROGRAMS + 1), {"source": pytest.Config.ArgsSource.ARGS}, pytest.ExitCode.OK),
        (Spent(1, 1e6, 38.0), {"hold_pace": True}, pytest.ExitCode.TESTS_FAILED),
    ],
)
def test_a_run_beyond_its_budget_fails(plugin, monkeypatch, spent, options, status):
    figures = {"tests/a.py": Spent(PROGRAMS + 1, loops=30.0)}
    monkeypatch.setattr(budget, "recorded", lambda *_: figures)
    monkeypatch.setattr(plugin, "SPENT", {"tests/a.py": spent})
    session = SimpleNamespace(config=config(**options), exitstatus=pytest.ExitCode.OK)
    plugin.pytest_sessionfinish(session)
    assert session.exitstatus is status


def test_workers_hand_in_what_each_file_spent(plugin, monkeypatch):
    monkeypatch.setattr(plugin, "SPENT", defaultdict(Spent, {"tests/a.py": Spent(2, 1.0, 3.0)}))
    worker = SimpleNamespace(config=SimpleNamespace(workeroutput={}), exitstatus=0)
    plugin.pytest_sessionfinish(worker)
    plugin.pytest_testnodedown(worker.config)
    assert dict(plugin.SPENT) == {"tests/a.py": Spent(4, 2.0, 6.0)}
