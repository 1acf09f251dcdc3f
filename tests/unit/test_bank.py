"""The bank of results computes each of them once, whoever asks."""

import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import bank
import pytest
from sound import PAIR

from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.teeth import TEETH


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """Asks for something, and how often each was computed."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    counts = Counter()

    def ask(what, fails=False):
        def compute(folder):
            counts[what] += 1
            folder.mkdir()
            time.sleep(0.05)
            (folder / "half").write_text(what)
            if fails:
                raise RuntimeError
            (folder / "all").write_text(what)

        return bank._folder(what, compute)

    return ask, counts


def test_what_was_computed_is_read(asked):
    ask, counts = asked
    assert ask("a") == ask("a") != ask("b")
    assert (ask("a") / "all").read_text() == "a"
    assert counts == {"a": 1, "b": 1}


def test_who_asks_meanwhile_waits(asked):
    ask, counts = asked
    with ThreadPoolExecutor(4) as threads:
        folders = [*threads.map(ask, ["a"] * 4)]
    assert all((folder / "all").exists() for folder in folders)
    assert counts == {"a": 1}


def test_what_was_left_half_done_is_computed_again(asked):
    ask, counts = asked
    with pytest.raises(RuntimeError):
        ask("a", fails=True)
    assert (ask("a") / "all").exists()
    assert counts == {"a": 2}


def test_what_was_asked_for_longest_ago_makes_room(asked, monkeypatch):
    ask, counts = asked
    monkeypatch.setattr(bank, "MOST", 2)
    for what in ("a", "b", "a", "c"):
        ask(what)
        time.sleep(0.01)
    ask("a"), ask("b")
    assert counts == {"a": 1, "b": 2, "c": 1}


def test_changed_code_computes_anew(asked, monkeypatch):
    ask, counts = asked
    ask("a")
    monkeypatch.setattr(bank, "surroundings", lambda: {"code": "changed"})
    ask("a")
    assert counts == {"a": 2}


def test_a_result_is_that_of_its_text_settings_and_analyses(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(ANALYSES, "_entries", {"teeth": TEETH})
    case = tmp_path / "pair.toml"
    case.write_text(PAIR)
    data = bank.outcomes(case)["default"].parts["teeth"]
    assert bank.outcomes(case)["default"].parts["teeth"].identical(data)
    wider = bank.outcomes(case, settings={"gears.module": "3 mm"})["default"].parts["teeth"]
    case.write_text(PAIR.replace('"2 mm"', '"3 mm"'))
    assert bank.outcomes(case)["default"].parts["teeth"]["tip_radius"].equals(wider["tip_radius"])
    assert not wider["tip_radius"].equals(data["tip_radius"])
    monkeypatch.setattr(ANALYSES, "_entries", {})
    assert not bank.outcomes(case)["default"].parts
