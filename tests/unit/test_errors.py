"""Errors say where and what in one sentence."""

import pickle

import pytest

from pitchpoint.errors import ConvergenceError, InputError, PitchpointError, shorten, visible


@pytest.mark.parametrize(
    ("file", "key", "text"),
    [
        (None, None, "must be positive"),
        ("pair.toml", None, "pair.toml: must be positive"),
        (None, "gears.module", "gears.module: must be positive"),
        ("pair.toml", "gears.module", "pair.toml: gears.module: must be positive"),
    ],
)
def test_location_is_told_as_far_as_known(file, key, text):
    assert str(InputError("must be positive", file=file, key=key)) == text


def test_at_fills_in_location_on_a_copy():
    bare = InputError("must be positive", key="module", value=-1, allowed=["a", "b"])
    located = bare.at(file="pair.toml")
    assert str(located) == "pair.toml: module: must be positive"
    assert (located.value, located.allowed) == (-1, ("a", "b"))
    assert str(bare) == "module: must be positive"


def test_at_keeps_the_class():
    class SpecialError(InputError):
        pass

    assert type(SpecialError("x").at(key="k")) is SpecialError


def test_location_survives_pickling():
    error = pickle.loads(pickle.dumps(InputError("wrong", file="a.toml", key="b", value=3)))
    assert (str(error), error.value) == ("a.toml: b: wrong", 3)


def test_exit_codes_and_bases():
    assert (PitchpointError.exit_code, InputError.exit_code, ConvergenceError.exit_code) == (
        1,
        2,
        3,
    )
    assert issubclass(InputError, ValueError)
    assert issubclass(ConvergenceError, RuntimeError)


def test_location_takes_keywords_only():
    with pytest.raises(TypeError):
        InputError("wrong", "pair.toml")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Zahnräder, α = 20°", "Zahnräder, α = 20°"),
        ("\x1b]0;title\x07", "\\x1b]0;title\\x07"),
        ("\x1b]52;c;aGk=\x07\x9b2J", "\\x1b]52;c;aGk=\\x07\\x9b2J"),
        ("two\nlines\u202e", "two\\nlines\\u202e"),
    ],
)
def test_nothing_that_steers_a_terminal_is_shown(text, told):
    assert visible(text) == told


def test_a_long_text_is_cut():
    assert shorten("x" * 200_000) == "x" * 57 + "..."
    assert shorten("\x1b" * 59, 60) == ("\\x1b" * 15)[:57] + "..."
    assert shorten("x" * 60) == "x" * 60


def test_a_long_place_is_cut_wherever_it_comes_from():
    error = InputError("wrong", file="f" * 200_000, key="k" * 200_000)
    assert len(str(error)) < 500
    assert str(error).endswith("...: wrong")
