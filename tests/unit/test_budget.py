"""The budget of the suite counts what is compiled, and says which file is beyond it."""

from collections import defaultdict
from types import SimpleNamespace

import budget
import pytest
from budget import PROGRAMS, PROGRAMS_OF_A_FILE, SECONDS_OF_A_FILE, Meter, Spent, exceeded, slow

from pitchpoint._jax import jax


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


def test_a_suite_within_its_budget_is_silent():
    most = Spent(PROGRAMS_OF_A_FILE, SECONDS_OF_A_FILE)
    for told in (exceeded, slow):
        assert told({"tests/a.py": most, "tests/b.py": Spent()}) == []


def test_a_file_beyond_its_budget_is_named():
    spent = {"tests/a.py": Spent(PROGRAMS_OF_A_FILE + 1, SECONDS_OF_A_FILE + 1.0)}
    (told,), (late,) = exceeded(spent), slow(spent)
    assert told.startswith(f"tests/a.py asks for {PROGRAMS_OF_A_FILE + 1} programs")
    assert late.startswith("tests/a.py takes")


def test_many_files_within_their_own_budgets_may_exceed_that_of_the_suite():
    each = Spent(PROGRAMS_OF_A_FILE, 1.0)
    (told,) = exceeded({f"tests/{n}.py": each for n in range(PROGRAMS // PROGRAMS_OF_A_FILE + 1)})
    assert told.startswith("the suite asks for ")


@pytest.mark.parametrize(
    ("programs", "status"),
    [
        (PROGRAMS_OF_A_FILE, pytest.ExitCode.OK),
        (PROGRAMS_OF_A_FILE + 1, pytest.ExitCode.TESTS_FAILED),
    ],
)
def test_a_run_beyond_its_budget_of_programs_fails(request, monkeypatch, programs, status):
    plugin = request.config.pluginmanager.getplugin(
        str(request.config.rootpath / "tests/conftest.py")
    )
    monkeypatch.setattr(plugin, "SPENT", {"tests/a.py": Spent(programs, 1e6)})
    session = SimpleNamespace(config=SimpleNamespace(), exitstatus=pytest.ExitCode.OK)
    plugin.pytest_sessionfinish(session)
    assert session.exitstatus is status


def test_workers_hand_in_what_each_file_spent(request, monkeypatch):
    plugin = request.config.pluginmanager.getplugin(
        str(request.config.rootpath / "tests/conftest.py")
    )
    monkeypatch.setattr(plugin, "SPENT", defaultdict(Spent, {"tests/a.py": Spent(2, 1.0)}))
    worker = SimpleNamespace(config=SimpleNamespace(workeroutput={}), exitstatus=0)
    plugin.pytest_sessionfinish(worker)
    plugin.pytest_testnodedown(worker.config)
    assert dict(plugin.SPENT) == {"tests/a.py": Spent(4, 2.0)}


@pytest.mark.parametrize("file", budget.SLOWEST_FIRST)
def test_files_that_start_first_exist(file, request):
    assert (request.config.rootpath / "tests" / file).is_file()
    assert budget.order(f"tests/{file}") < budget.order("tests/any/test_other.py")
