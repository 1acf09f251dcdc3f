"""Names out of lists: an unknown one gets the nearest known ones, however it is spelled."""

import pytest

from pitchpoint.cases.library import names, path_of
from pitchpoint.errors import InputError
from pitchpoint.lubrication.friction_coefficient import LAWS
from pitchpoint.materials import lubricants, solids
from pitchpoint.registry import Registry, alike, nearest, unknown_name

KNOWN = ["steel", "pom"]


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
        ("pom", solids.find, "POM-H"),
        ("PA 66", solids.find, "PA66"),
        ("Xu-2007", Registry("friction law", *LAWS).__getitem__, "xu_2007"),
        ("ISO/TR 14179-2", Registry("friction law", *LAWS).__getitem__, "iso_tr_14179_2"),
        ("Tian 2024", path_of, "tian2024"),
    ],
)
def test_case_spaces_and_hyphens_do_not_hide_a_name(given, find, meant):
    with pytest.raises(InputError, match=rf"; did you mean {meant}\?$"):
        find(given)


def test_a_name_that_differs_in_spelling_alone_is_offered_alone():
    assert alike("TIAN_2024", names()) == ["tian2024"]
    assert len(alike("pao-vg-15", lubricants.catalogue())) == 3


def test_an_empty_list_says_so():
    assert nearest("xyz", []) == "; there are none"


def test_a_long_name_is_cut():
    assert len(str(unknown_name("x" * 200_000, KNOWN, what="a material"))) < 150
