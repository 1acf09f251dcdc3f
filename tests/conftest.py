"""Compiles quickly, gives compiled programs back, and holds the suite to its budget."""

import gc
import os
import sys
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

if sys.dont_write_bytecode:  # or each of many processes would compile the package anew
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    caches = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    sys.pycache_prefix = os.environ["PYTHONPYCACHEPREFIX"] = str(caches / "pitchpoint-bytecode")

import budget  # noqa: E402
import jax  # noqa: E402
import pytest  # noqa: E402
from budget import Meter, Spent  # noqa: E402
from shapes import install  # noqa: E402

jax.config.update("jax_enable_x64", True)
install()  # before anything of the package is imported

from pitchpoint.core import programs  # noqa: E402

MOST_MAPS = 55_000
"""Memory maps (Linux allows 65,530) beyond which compiled programs are given back after a file."""

LAST_MAPS = 60_000
"""Those beyond which they are given back within a file, where tests that follow may still share them."""

OFTEN = 20
"""Programs after which maps are counted within a file."""

_counted_at = 0

# Here their maps are counted, and programs shared across a thousand.
programs.MOST_PROGRAMS = programs.MOST_MEMORY = 10**12

METER = Meter()
SPENT: dict[str, Spent] = defaultdict(Spent)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--record-budget", action="store_true", help="write tests/budget.toml anew")
    parser.addoption("--hold-pace", action="store_true", help="fail if the suite takes longer")


def pytest_configure(config: pytest.Config) -> None:
    jax.monitoring.register_event_duration_secs_listener(METER.listen)
    parts = config.option.keyword or any("::" in one for one in config.args)
    if config.option.record_budget and (parts or len(_parts(config)) > 1):
        raise pytest.UsageError("figures are recorded of all tests of a file that are in one part")


def _parts(config: pytest.Config) -> tuple[str, ...]:
    """Parts of the suite that run; with another choice of marks they are not told apart."""
    return {"not whole": ("quick",), "whole": ("whole",)}.get(config.option.markexpr, budget.PARTS)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    figures = budget.recorded(*_parts(config))
    items.sort(key=lambda item: budget.order(item.location[0], figures))


def pytest_collection_finish() -> None:
    """What is there by now stays: looking through it for garbage took a tenth of the time."""
    gc.freeze()
    gc.set_threshold(100_000, 20, 20)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    before = METER.read()
    done = yield
    spent = METER.read()
    SPENT[item.location[0]] += spent - before
    global _counted_at
    if spent.programs - _counted_at >= OFTEN:
        _counted_at = spent.programs
        if _more_maps_than(LAST_MAPS):
            programs.forget()
    return done


def _more_maps_than(most: int) -> bool:
    """True also where the memory maps of the process are not known."""
    maps = Path("/proc/self/maps")
    return not maps.exists() or maps.read_bytes().count(b"\n") > most


@pytest.fixture(autouse=True, scope="module")
def _programs_within_the_memory_maps(request: pytest.FixtureRequest) -> Iterator[None]:
    """Files share what they compile until it could exhaust the memory maps of the process."""
    yield
    METER.calibrate()
    if _more_maps_than(MOST_MAPS) or request.config.option.record_budget:
        programs.forget()


# ---- the budget: workers hand in what each file spent, the controller judges the sum


def pytest_sessionfinish(session: pytest.Session) -> None:
    handed_in = getattr(session.config, "workeroutput", None)
    if handed_in is not None:
        handed_in["spent"] = {
            file: (own.programs, own.seconds, own.loops) for file, own in SPENT.items()
        }
        return
    if session.exitstatus != pytest.ExitCode.OK:
        return
    if session.config.option.record_budget:
        budget.record(*_parts(session.config), SPENT)
    elif _beyond(session.config):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def _beyond(config: pytest.Config) -> list[str]:
    """A sentence for each figure that was exceeded, as far as this run is held to them: the quick part is.

    Single operations are shared with the files before: a file alone, or in another order, asks for more than
    is recorded of it.
    """
    whole_suite = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    if not whole_suite or _parts(config) != ("quick",):
        return []
    figures = budget.recorded("quick")
    paced = budget.slow(SPENT, figures) if config.option.hold_pace else []
    return budget.exceeded(SPENT, figures) + paced


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    for file, own in getattr(node, "workeroutput", {}).get("spent", {}).items():
        SPENT[file] += Spent(*own)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    whole = sum(SPENT.values(), Spent())
    terminalreporter.write_line(
        f"{whole.programs} programs and {whole.seconds:.0f} s of the processor,"
        f" {whole.loops:.0f} loops, in {len(SPENT)} files"
    )
    for told in _beyond(terminalreporter.config):
        terminalreporter.write_line(f"over budget: {told}; see tests/budget.py", red=True)
