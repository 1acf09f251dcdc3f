"""The folder of compiled programs, whose files are run as they are, and arrays of plain numbers."""

import logging
import math
import os
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from pitchpoint import _jax
from pitchpoint.core import kept


@pytest.fixture
def enabled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> tuple[Path, list[str]]:
    """Cache folder in a cache of one's own, and what is set when it is enabled."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    told: dict[str, object] = {}
    monkeypatch.setattr(_jax, "_keeps_programs", lambda: False)
    monkeypatch.setattr(_jax.jax.config, "update", told.__setitem__)
    caplog.set_level(logging.WARNING)
    return _jax.cache_folder(), told


FOLDER = "jax_compilation_cache_dir"


def test_a_folder_of_ones_own_is_used(enabled, caplog: pytest.LogCaptureFixture) -> None:
    folder, told = enabled
    _jax._enable_cache()
    assert told[FOLDER] == str(folder)
    assert folder.stat().st_mode & 0o777 == 0o700
    assert not caplog.records


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="folders have no owners here")
@pytest.mark.parametrize("mode", [0o770, 0o702, 0o777, 0o1777], ids=oct)
def test_a_folder_that_others_write_to_is_not_used(
    enabled, mode: int, caplog: pytest.LogCaptureFixture
) -> None:
    folder, told = enabled
    folder.mkdir(parents=True)
    folder.chmod(mode)
    _jax._enable_cache()
    assert not told
    (record,) = caplog.records
    assert str(folder) in record.getMessage()


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="folders have no owners here")
def test_nor_one_that_belongs_to_another_or_can_be_replaced(
    enabled, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, told = enabled
    folder.mkdir(mode=0o700, parents=True)
    folder.parent.chmod(0o777)
    _jax._enable_cache()
    folder.parent.chmod(0o1777)  # as /tmp: others cannot rename what is not theirs
    assert kept.is_private(folder)
    monkeypatch.setattr(os, "geteuid", lambda: folder.stat().st_uid + 1)
    _jax._enable_cache()
    assert not told


def test_no_home_is_no_cache(enabled, monkeypatch: pytest.MonkeyPatch) -> None:
    _, told = enabled

    def home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(Path, "home", home)
    _jax._enable_cache()
    assert not told


PLAIN = [0.0, -0.0, 1.0, 1, 0, True, False, 1e-300, np.float64(1.0), math.nan, -math.nan, math.inf]


@pytest.mark.parametrize("dtype", [None, float, int, bool], ids=str)
def test_a_plain_number_is_the_array_that_it_ever_was(dtype: type | None) -> None:
    for value in [one for one in PLAIN if dtype is not int or math.isfinite(one)]:
        array = _jax.array(value, dtype)
        expected = jax.numpy.asarray(np.asarray(value, dtype))
        assert array.dtype == expected.dtype
        assert array.weak_type == expected.weak_type
        assert np.asarray(array).tobytes() == np.asarray(expected).tobytes()
        assert _jax.array(value, dtype) is array


def test_while_jax_traces_a_plain_number_is_a_constant_of_what_is_traced() -> None:
    _jax.array(3.0)

    def tripled(x: jax.Array) -> jax.Array:
        return _jax.array(3.0) * x

    assert not jax.make_jaxpr(tripled)(1.0).consts
    assert float(jax.grad(jax.jit(tripled))(2.0)) == 3.0
    assert jax.vmap(tripled)(np.ones(2)).tolist() == [3.0, 3.0]
    assert isinstance(_jax.array(3.0), jax.Array)


@pytest.mark.parametrize("value", [[1.0, 2.0], (1, 2), np.eye(2), np.eye(2, dtype=np.float32), []])
def test_so_are_a_few_numbers(value: Any) -> None:
    array = _jax.array(value)
    assert array.dtype == np.asarray(value).dtype
    assert array.tolist() == np.asarray(value).tolist()
    assert _jax.array(value) is array


@pytest.mark.parametrize("size", [_jax.FEW_NUMBERS, 64 * _jax.FEW_NUMBERS])
def test_changed_numbers_are_another_array(size: int) -> None:
    numbers = np.arange(float(size))
    before = _jax.array(numbers)
    if size <= _jax.FEW_NUMBERS:
        numbers += 1.0
        assert before.tolist() == [*range(size)]
        assert _jax.array(numbers).tolist() == [*range(1, size + 1)]
    else:
        assert _jax.array(numbers) is not before


def test_no_program_is_compiled_for_numbers() -> None:
    compiled: list[str] = []
    jax.monitoring.register_event_duration_secs_listener(
        lambda event, *_, **__: compiled.append(event) if "backend_compile" in event else None
    )
    for shape in ((), (7,), (3, 1, 5), (257,)):
        _jax.array(np.full(shape, 0.123)).block_until_ready()
    assert not compiled


def test_arrays_that_are_kept_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_jax, "MOST_KEPT", 3)
    monkeypatch.setattr(_jax, "_ARRAYS", {})
    assert [float(_jax.array(value)) for value in (5.0, 6.0, 7.0, 8.0, 5.0)] == [5, 6, 7, 8, 5]
    assert len(_jax._ARRAYS) <= 3


def test_an_array_is_itself() -> None:
    weak = jax.numpy.asarray(2.0)
    assert _jax.array(weak) is weak
    assert _jax.array(weak, float).weak_type is False
