"""Programs are traced once: kept on disk under all that decides them, and found again."""

import os
import subprocess
import sys
from functools import partial, wraps
from pathlib import Path

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pitchpoint.core import programs
from pitchpoint.core.programs import Program, program
from pitchpoint.lubrication.friction_coefficient import xu_2007
from pitchpoint.lubrication.lubrication_registry import LAWS
from pitchpoint.materials.lubricants import Lubricant


class Bodies(eqx.Module):
    mass: jax.Array
    label: str = eqx.field(static=True)


Bodies.__module__ = (
    "pitchpoint.core.programs"  # as a class of the package, which a later process finds
)
programs.Bodies = Bodies

TRACED: list[str] = []


def moved(bodies: Bodies, *, by: float, twice: bool = False) -> dict:
    TRACED.append(bodies.label)
    force = bodies.mass * by * (2.0 if twice else 1.0)
    return {"force": force, "of": (Bodies(force, bodies.label), None, [bodies.label])}


moved.__module__ = "pitchpoint.core.programs"
programs.moved = moved


def told_by_the_host(bodies: Bodies) -> Bodies:
    TRACED.append(bodies.label)
    mass = jax.pure_callback(lambda x: 2.0 * x, bodies.mass, bodies.mass)
    return Bodies(mass, bodies.label)


told_by_the_host.__module__ = "pitchpoint.core.programs"
programs.told_by_the_host = told_by_the_host


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """A folder of its own for programs, and a program whose memory is empty each time it is asked."""
    monkeypatch.setattr(programs, "kept_folder", lambda: tmp_path)
    TRACED.clear()
    return lambda **how: Program(moved, programs.QUICK)(Bodies(jnp.arange(3.0), "a"), **how)


def test_results_are_those_of_the_function_put_together_again(kept):
    for _ in range(2):
        found = kept(by=2.0)
        np.testing.assert_array_equal(found["force"], [0.0, 2.0, 4.0])
        inner, nothing, labels = found["of"]
        assert isinstance(inner, Bodies)
        assert (inner.label, nothing, labels) == ("a", None, ["a"])
    assert TRACED == ["a"]


def test_what_has_no_portable_form_is_traced_once_in_a_process(kept, tmp_path):
    one = Program(told_by_the_host, programs.QUICK)
    for mass in (2.0, 3.0):  # arrays of plain numbers, whose type is weak
        found = one(Bodies(jnp.asarray(mass), "a"))
        assert float(found.mass) == 2.0 * mass
        assert found.label == "a"
    assert TRACED == ["a"]
    assert not (tmp_path / "programs").exists()


def test_what_is_static_decides(kept, tmp_path):
    kept(by=2.0)
    assert kept(by=2.0, twice=True)["force"][1] == 4.0
    assert kept(by=3.0)["force"][1] == 3.0
    assert len(list((tmp_path / "programs").iterdir())) == len(TRACED) == 3


def test_code_that_counts_is_that_of_the_function_and_of_its_arguments(kept, monkeypatch):
    asked: list[list[str]] = []

    def digest_of_reach(modules: list[str]) -> str:
        asked.append(modules)
        return str(len(asked))

    monkeypatch.setattr(programs._sources(), "digest_of_reach", digest_of_reach)
    one = Program(moved, programs.QUICK)
    given = {"name": "pitchpoint.units:torque", "law": xu_2007, "of": [Lubricant]}
    paths = {one._path(((Bodies(jnp.arange(3.0), "a"),), given)) for _ in range(2)}
    others = ["pitchpoint.lubrication.friction_coefficient", "pitchpoint.materials.lubricants"]
    assert asked == [["pitchpoint.core.programs", *others]] * 2
    assert len(paths) == 2


@pytest.mark.parametrize("damage", [b"", b"\0" * 4096, None], ids=["empty", "zeros", "cut"])
def test_a_damaged_program_is_traced_again(kept, tmp_path, damage):
    kept(by=2.0)
    (path,) = (tmp_path / "programs").iterdir()
    path.write_bytes(path.read_bytes()[:-7] if damage is None else damage)
    assert kept(by=2.0)["force"][2] == 4.0
    assert kept(by=2.0)["force"][2] == 4.0
    assert TRACED == ["a", "a"]


def test_programs_that_were_asked_for_longest_ago_make_room(kept, tmp_path, monkeypatch):
    monkeypatch.setattr(programs, "MOST_KEPT", 2)
    for by in (1.0, 2.0, 1.0, 3.0):
        kept(by=by)
    assert len(list((tmp_path / "programs").iterdir())) == 2
    assert len(TRACED) == 3
    kept(by=1.0)
    assert len(TRACED) == 3
    kept(by=2.0)
    assert len(TRACED) == 4


def test_without_a_folder_nothing_is_kept(kept, monkeypatch):
    monkeypatch.setattr(programs, "kept_folder", lambda: None)
    assert kept(by=2.0)["force"][2] == 4.0
    assert TRACED == ["a"]


def test_a_law_of_ones_own_has_no_name():
    def own(*, pressure):
        return pressure

    @wraps(xu_2007)
    def larger(**at):
        return 1.2 * xu_2007(**at)

    for nameless in (own, partial(own), larger, lambda: None, object()):
        with pytest.raises(programs._NamelessError):
            programs._text(nameless)
    assert len({str(programs._text(law)) for law in LAWS}) == len(LAWS)


def test_derivatives_go_through_a_program():
    squared = program(lambda x: x**2)
    assert jax.grad(squared)(3.0) == 6.0
    np.testing.assert_array_equal(jax.vmap(squared)(jnp.arange(3.0)), [0.0, 1.0, 4.0])


def test_numbers_that_were_plain_compile_nothing_more(kept):
    """JAX tells them from others, as of another type; the program does not."""
    doubled = Program(moved, programs.QUICK)
    doubled(Bodies(jnp.asarray(np.float64(3.0)), "a"), by=2.0)
    before = programs._LOADED["programs"]
    plain = jnp.asarray(3.0)
    assert plain.weak_type
    found = doubled(Bodies(plain, "a"), by=2.0)
    assert float(found["force"]) == 6.0
    assert programs._LOADED["programs"] == before


def test_forgetting_gives_memory_back(kept):
    one = Program(moved, programs.QUICK)
    one(Bodies(jnp.arange(3.0), "b"), by=1.0)
    assert one.ready
    programs.forget()
    assert not one.ready


def test_many_programs_are_unloaded_together(monkeypatch):
    @jax.jit
    def double(x):
        return 2.0 * x

    def fill(count):
        for size in range(1, count + 1):
            double(np.zeros(size))

    programs.bound_programs()
    kept = programs._LOADED["programs"]
    fill(4)
    assert programs._LOADED["programs"] >= kept + 4
    programs.bound_programs()
    assert double._cache_size() == 4
    monkeypatch.setattr(programs, "MOST_PROGRAMS", programs._LOADED["programs"] - 1)
    programs.bound_programs()
    assert double._cache_size() == 0
    assert programs._LOADED["programs"] == 0
    assert float(double(jnp.asarray(3.0))) == 6.0


@pytest.mark.parametrize(
    ("free", "left", "memory", "held"),
    [
        (0, 700, (1400, 1600, 1400, 1600), [True, False, True, False]),
        (
            200,
            700,
            (1400, 1600, 1400, 1800),
            [True, True, True, False],
        ),  # what is free is enough once
        # where nothing is given back, each further share is worth a try, and no run less
        (0, 9999, (1600, 1600, 1700, 1800, 1800), [False, True, True, False, True]),
    ],
)
def test_memory_is_bounded_from_the_start_of_the_process(
    kept, monkeypatch, free, left, memory, held
):
    program, found = Program(moved, programs.QUICK), []

    class Heap:
        taken = 500

        def malloc_trim(self, _):
            self.taken = self.taken - free if program.ready else min(self.taken, left)

    heap = Heap()
    for name, value in (("MOST_MEMORY", 1000), ("WORTH_GIVING", 150), ("_AT_START", 500)):
        monkeypatch.setattr(programs, name, value)
    monkeypatch.setattr(programs, "_memory", lambda: heap.taken)
    monkeypatch.setattr(programs, "CDLL", lambda _: heap)
    programs.forget()
    for heap.taken in memory:
        program(Bodies(jnp.arange(3.0), "b"), by=1.0)
        programs.bound_programs()
        found.append(bool(program.ready))
    assert found == held


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="asks Linux for its memory")
def test_memory_that_is_given_back_counts_no_more(monkeypatch):
    before = programs._memory()
    assert before > 10_000_000
    numbers = np.ones(20_000_000)
    assert programs._memory() - before > 0.9 * numbers.nbytes
    del numbers
    programs.forget()
    assert programs._memory() - before < 100_000_000


def test_types_that_count_as_arrays_are_told_by_their_class(kept):
    twice = Program(moved, programs.QUICK)
    for mass in (jnp.ones(2), np.ones(2)):
        twice(Bodies(mass, "b"), by=1.0)
    twice(Bodies(np.float64(2.0), "b"), by=1.0)
    twice(Bodies(2.0, "b"), by=1.0)  # a number is static
    assert len(twice.ready) == 3
    with_weights = jax.jit(lambda mass: twice(Bodies(mass, "b"), by=1.0)["force"])
    assert with_weights(np.ones(2)).tolist() == [1.0, 1.0]
    assert len(twice.ready) == 3


def test_flags_of_the_compiler_are_heeded(monkeypatch):
    monkeypatch.setenv("XLA_FLAGS", "--xla_backend_optimization_level=3 --xla_dump_to=nowhere")
    others = {"xla_llvm_disable_expensive_passes": True, "xla_cpu_use_fusion_emitters": False}
    assert programs._options(0) == others
    monkeypatch.setenv("XLA_FLAGS", "")
    assert programs._options(1) == {**others, "xla_backend_optimization_level": 1}
    looping = programs.looping_program(moved)
    assert looping.options == programs.LOOPING


THREADS = """
import ctypes
from pitchpoint._jax import jnp

jnp.linalg.cholesky(jnp.eye(3)).block_until_ready()
maps = {line.split()[-1] for line in open("/proc/self/maps") if "scipy.libs" in line}
library = ctypes.CDLL(next(path for path in maps if "openblas" in path))
print(library.scipy_openblas_get_num_threads())
"""


def test_options_that_the_compiler_does_not_have_are_left_out(monkeypatch):
    """Versions of JAX take options away; what they only made quicker must run all the same."""
    monkeypatch.setattr(programs, "_REFUSED", set())
    lowered = jax.jit(jnp.sin).lower(1.0)
    compiled = programs._compiled(lowered, programs.QUICK | {"xla_taken_away": True})
    assert float(compiled(0.5)) == pytest.approx(np.sin(0.5), rel=1e-7)
    assert "xla_taken_away" in programs._REFUSED
    with pytest.raises(jax.errors.JaxRuntimeError, match="level"):
        programs._compiled(lowered, {"xla_backend_optimization_level": "high"})


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="asks Linux for its libraries")
def test_factorisations_run_on_one_thread():
    environment = {name: value for name, value in os.environ.items() if "OPENBLAS" not in name}
    done = subprocess.run(
        [sys.executable, "-c", THREADS], env=environment, capture_output=True, text=True, check=True
    )
    assert int(done.stdout) == 1


def test_a_program_that_integrates_may_be_kept():
    """It calls nothing in Python: JAX keeps no program that does."""

    def integrated(start):
        return diffrax.diffeqsolve(
            diffrax.ODETerm(lambda _, state, __: -state),
            diffrax.Dopri8(),
            t0=0.0,
            t1=1.0,
            dt0=0.1,
            y0=start,
            saveat=diffrax.SaveAt(ts=jnp.linspace(0.0, 1.0, 3)),
            stepsize_controller=diffrax.PIDController(rtol=1e-6, atol=1e-6),
            adjoint=diffrax.ForwardMode(),
            throw=False,
        ).ys

    assert "callback" not in str(jax.make_jaxpr(integrated)(jnp.ones(2)))
