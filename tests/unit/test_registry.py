"""Names out of lists: an unknown one gets the nearest known ones, however it is spelled."""

import re
from pathlib import Path

import pytest

import pitchpoint
from pitchpoint.cases.library import case_names, case_path
from pitchpoint.errors import InputError
from pitchpoint.lubrication.lubrication_registry import LAWS
from pitchpoint.materials import lubricants, solids
from pitchpoint.registry import (
    Registry,
    code_at,
    known_as,
    letters,
    nearest,
    similar_names,
    unknown_name,
)
from pitchpoint.runs.catalogue import entries

KNOWN = ["steel", "pom"]
KINDS = ("friction", "load_sharing", "film_thickness", "lubricant", "material", "wear_law")


def test_one_sentence_ends_every_refusal_of_a_name():
    error = unknown_name("stel", KNOWN, what="a material")
    assert str(error) == f'"stel" is not a material in the catalogue{nearest("stel", KNOWN)}'
    assert str(error).endswith("; did you mean steel?")
    assert error.allowed == ("pom", "steel")


def test_all_names_are_listed_where_none_is_near():
    error = unknown_name("xyz", KNOWN, what="a material")
    assert str(error) == '"xyz" is not a material in the catalogue; known are pom, steel'


@pytest.mark.parametrize(
    ("given", "find", "meant"),
    [
        ("PAO VG 150", lubricants.find, "pao-vg-150"),
        ("75w90a", lubricants.find, "75W90-A"),
        ("Steel", solids.find, "steel"),
        ("PA 66", solids.find, "PA66"),
        ("Xu-2007", Registry("friction law", *LAWS).__getitem__, "xu_2007"),
        ("ISO/TR 14179-2", Registry("friction law", *LAWS).__getitem__, "iso_tr_14179_2"),
    ],
)
def test_case_spaces_and_hyphens_do_not_hide_a_name(given, find, meant):
    assert find(given).name == meant


@pytest.mark.parametrize(
    ("given", "find", "meant"),
    [
        ("pom", solids.find, "POM-H"),
        ("pao-vg-1500", lubricants.find, "pao-vg-150 or pao-vg-100 or pao-vg-680"),
        ("Tian 2024", case_path, "tian2024"),
    ],
)
def test_another_name_is_offered_not_taken(given, find, meant):
    with pytest.raises(InputError, match=rf"; did you mean {meant.split(' or ')[0]}( or |\?$)"):
        find(given)


def test_a_name_that_may_mean_two_means_none():
    assert known_as("a b", ["a-b", "a_b"]) is None
    assert known_as("a-b", ["a-b", "a_b"]) == "a-b"
    assert known_as("--", ["a", "-"]) is None


def test_no_two_names_of_the_library_differ_by_signs_alone():
    for rows in ({row["name"] for row in entries() if row["kind"] == kind} for kind in KINDS):
        assert len({letters(name) for name in rows}) == len(rows)


def test_a_name_that_differs_in_spelling_alone_is_offered_alone():
    assert similar_names("TIAN_2024", case_names()) == ["tian2024"]
    assert len(similar_names("pao-vg-15", lubricants.catalogue())) == 3


def test_an_empty_list_says_so():
    assert nearest("xyz", []) == "; there are none"


def test_a_long_name_is_cut():
    assert len(str(unknown_name("x" * 200_000, KNOWN, what="a material"))) < 150


def test_code_that_is_loaded_when_it_is_chosen_is_where_it_is_said_to_be():
    texts = [path.read_text("utf-8") for path in Path(pitchpoint.__file__).parent.rglob("*.py")]
    places = {place for text in texts for place in re.findall(r'"(pitchpoint[.\w]+:\w+)"', text)}
    assert len(places) > 100
    for place in places:
        assert code_at(place) is not None, place
