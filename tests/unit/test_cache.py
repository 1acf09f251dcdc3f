"""The folder of compiled programs, whose files are run as they are."""

import logging
import os
from pathlib import Path

import pytest

from pitchpoint import _jax, kept


@pytest.fixture
def enabled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> tuple[Path, list[str]]:
    """Cache folder in a cache of one's own, and what is set when it is enabled."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    told: dict[str, object] = {}
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
    assert kept.private(folder)
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
