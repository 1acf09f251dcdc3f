"""Compiles quickly, gives compiled programs back, and holds the suite to its budget of programs."""

import gc
import os
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

QUICKLY = (
    "--xla_backend_optimization_level=0",
    "--xla_llvm_disable_expensive_passes=true",
    "--xla_cpu_use_fusion_emitters=false",
)
"""Programs of tests run for milliseconds and compile for seconds; those of subprocesses too."""

_given = os.environ.get("XLA_FLAGS", "")
_more = [flag for flag in QUICKLY if flag.partition("=")[0] not in _given]
os.environ["XLA_FLAGS"] = " ".join([_given, *_more]).strip()  # read once, with the first array
# Nobody reads from which lines of Python an operation of a program came: finding out is a tenth of the work.
os.environ.setdefault("JAX_TRACEBACK_IN_LOCATIONS_LIMIT", "0")

import jax  # noqa: E402
import pytest  # noqa: E402
from budget import Meter, Spent, exceeded, order, slow  # noqa: E402
from shapes import install  # noqa: E402

install()  # before anything of the package is imported

from pitchpoint import programs  # noqa: E402

MOST_MAPS = 30_000
"""Memory maps of a process (Linux allows 65,530) beyond which compiled programs are given back."""

programs.MOST_PROGRAMS = 10**9  # here their maps are counted, and programs shared across a thousand

METER = Meter()
SPENT: dict[str, Spent] = defaultdict(Spent)


def pytest_configure() -> None:
    jax.monitoring.register_event_duration_secs_listener(METER.listen)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: order(item.location[0]))


def pytest_collection_finish() -> None:
    """What is there by now stays: looking through it for garbage took a tenth of the time."""
    gc.freeze()
    gc.set_threshold(100_000, 20, 20)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    before = METER.read()
    done = yield
    SPENT[item.location[0]] += METER.read() - before
    return done


@pytest.fixture(autouse=True, scope="module")
def _programs_within_the_memory_maps() -> Iterator[None]:
    """Files share what they compile until it could exhaust the memory maps of the process."""
    yield
    maps = Path("/proc/self/maps")
    if not maps.exists() or maps.read_bytes().count(b"\n") > MOST_MAPS:
        programs.forget()


# ---- the budget: workers hand in what each file spent, the controller judges the sum


def pytest_sessionfinish(session: pytest.Session) -> None:
    handed_in = getattr(session.config, "workeroutput", None)
    if handed_in is not None:
        handed_in["spent"] = {file: (own.programs, own.seconds) for file, own in SPENT.items()}
    elif exceeded(SPENT) and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    for file, own in getattr(node, "workeroutput", {}).get("spent", {}).items():
        SPENT[file] += Spent(*own)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    whole = sum(SPENT.values(), Spent())
    terminalreporter.write_line(
        f"{whole.programs} programs and {whole.seconds:.0f} s of the processor in {len(SPENT)} files"
    )
    for told in exceeded(SPENT):
        terminalreporter.write_line(f"over budget: {told}; see tests/budget.py", red=True)
    for told in slow(SPENT):
        terminalreporter.write_line(f"slow here: {told}", yellow=True)
