"""What is doubtful: ranked by what it moves, told once, and only of what was computed."""

import pickle
from copy import copy
from typing import Any

import numpy as np
import pytest
import xarray as xr

from pitchpoint.cases.built import TEETH_ALONE
from pitchpoint.core.doubts import (
    FELT,
    LEFT_OUT,
    Doubt,
    doubts_of,
    fails,
    in_stage,
    ranked_doubts,
    reworded,
    stored,
    worst_of_kinds,
)
from pitchpoint.loading.iso_6336_stiffness import range_warnings
from pitchpoint.runs.run import Outcome


def warned(*sentences: str) -> list[str]:
    return ranked_doubts(sentences)["warnings"]


def test_what_moves_most_stands_first_and_trifles_are_silent() -> None:
    small, large = Doubt("off by 2 %.", moves=0.02), Doubt("off by 40 %.", moves=0.4)
    trifle = Doubt("off by 0.9 %.", moves=0.9 * FELT)
    assert warned(small, "seals are left out.", trifle, large) == [
        "off by 40 %.",
        "seals are left out.",
        "off by 2 %.",
    ]
    assert 0.02 < LEFT_OUT < 0.4


@pytest.mark.parametrize(
    ("sentences", "words"),
    [
        (["Tips of gear 1 are thin.", "Tips of gear 2 are thin."], "gear 1 (gear 2 alike) are"),
        ([in_stage(n, "Tips are thin.") for n in (1, 2, 3)], "Stages 1, 2 and 3: tips are thin."),
        (["Tips are thin.", Doubt("Tips are thin.", moves=0.5)], "Tips are thin."),
        ([in_stage(n, f"Gear {k} is hot.") for n in (1, 2) for k in (1, 2)], "Stages 1 and 2: "),
    ],
)
def test_sentences_that_differ_by_their_place_alone_are_one(
    sentences: list[str], words: str
) -> None:
    (told,) = warned(*sentences)
    assert words in told


def test_other_numbers_or_several_gears_are_other_sentences() -> None:
    apart_ones = ["gear 1 has 3 um.", "gear 2 has 4 um.", "gear 1 meets gear 2.", "gear 2 turns."]
    assert warned(*apart_ones) == apart_ones


def test_stages_that_fail_alike_fail_once_and_are_not_doubtful_beside() -> None:
    told = ranked_doubts([*(in_stage(n, fails("teeth melt.")) for n in (1, 2)), "teeth melt."])
    assert told == {"implausible": ["Fails: stages 1 and 2: teeth melt."], "warnings": []}


def test_datasets_hold_what_doubts_are_worth() -> None:
    doubts = [Doubt("off.", "grid", 0.3, moves=0.3, about=("film",)), Doubt("plain.")]
    for one, again in zip(doubts, doubts_of(stored(doubts)), strict=True):
        for name in ("kind", "extent", "moves", "about"):
            assert getattr(again, name) == getattr(one, name) == getattr(copy(one), name)
    assert doubts_of({"warnings": '["of an old file."]'}) == ["of an old file."]
    assert reworded(doubts[0], "Films: {}".format).moves == doubts[0].moves


def test_of_a_kind_the_worst_one_stays() -> None:
    kinds = [Doubt("a", "grid", 1.0), Doubt("b", "grid", 3.0), Doubt("c", "inlet", 2.0), "d"]
    assert worst_of_kinds(kinds) == ["b", "c", "d"]


def test_sentences_are_told_of_parts_that_are_there() -> None:
    outcome, other = (Outcome({}) for _ in range(2))
    outcome.parts["strength"] = xr.Dataset({"root_safety": ((), 1.5)})
    other.parts["operation"] = xr.Dataset({"mean_efficiency": ("law", np.array([0.99]))})
    for each, told in ((outcome, ["Tips are thin."]), (other, [TEETH_ALONE, "Tips are thin."])):
        each.tell([TEETH_ALONE, "Tips are thin."])
        assert each.manifest["warnings"] == told


def test_a_manifest_is_made_when_it_is_asked_for_with_what_was_noted_before() -> None:
    asked: list[str] = []
    outcome = Outcome(lambda: asked.append("once") or {"title": "pair", "warnings": [], "rows": []})
    outcome.tell(["Tips are thin."])
    assert not asked
    copied = pickle.loads(pickle.dumps(outcome))
    outcome.note(title="two pairs")
    assert (copied.manifest["title"], outcome.manifest["title"]) == ("pair", "two pairs")
    assert copied.manifest["warnings"] == outcome.manifest["warnings"] == ["Tips are thin."]
    assert asked == ["once"]


def test_few_teeth_matter_by_how_far_the_formula_goes() -> None:
    given: dict[str, Any] = {"profile_shift": (0.0, 0.0), "helix_angle": 0.0, "contact_ratio": 1.5}
    (near,) = range_warnings(virtual_teeth=(18.0, 60.0), **given)
    (far,) = range_warnings(virtual_teeth=(6.0, 60.0), **given)
    assert near.moves < FELT < far.moves < LEFT_OUT  # an estimate beside the answer
