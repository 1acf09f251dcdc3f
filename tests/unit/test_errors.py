"""Errors say where and what in one sentence."""

import pickle

import pytest

from pitchpoint.errors import ConvergenceError, InputError, PitchpointError, unknown_name


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


def test_unknown_name_tells_the_nearest():
    error = unknown_name("stel", ["steel", "pom"], what="a material")
    assert str(error) == '"stel" is not a material in the catalogue; did you mean steel?'
    assert error.allowed == ("pom", "steel")


def test_unknown_name_lists_all_when_none_is_near():
    error = unknown_name("xyz", ["steel", "pom"], what="a material")
    assert str(error) == '"xyz" is not a material in the catalogue; it has pom, steel'
