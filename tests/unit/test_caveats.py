"""Sentences beside numbers: laws out of their range, what fails, what an efficiency covers."""

from dataclasses import replace
from math import inf
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from pitchpoint.analyses import caveats, four_quadrants
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.solids import SolidInUse, failures
from pitchpoint.core.doubts import fails, moves, ranked_doubts
from pitchpoint.efficiency.tooth_temperature import modulus_at
from pitchpoint.errors import InputError
from pitchpoint.lubrication.applicability import limits_words
from pitchpoint.materials import solids
from pitchpoint.materials.material_tables import RoughnessTable
from pitchpoint.materials.surfaces import roughness_of
from pitchpoint.runs.catalogue import entries

XU, ISO = FRICTION["xu_2007"], FRICTION["iso_tr_14179_2"]


def in_use(name: str, temperature: float = 300.0, **changes: Any) -> SolidInUse:
    record = replace(solids.find(name), **changes)
    return SolidInUse(record, solids.find(name).build(), temperature)


def case(rolling: str = "none", *gears: SolidInUse) -> Any:
    models = SimpleNamespace(rolling_resistance=rolling)
    return SimpleNamespace(case=SimpleNamespace(models=models), solids=gears)


def cycle(**changes: Any) -> dict[str, np.ndarray]:
    """Two nodes of one pair in range of both laws."""
    lanes = {"load": 100.0, "friction": 0.04, "lambda_ratio": 2.0, "pressure": 1e9}
    lanes |= {"sliding_loss": 3.0, "rolling_loss": 1.0}
    run = {
        name: np.full((2, 1, 1), changes.pop(name, value), float) for name, value in lanes.items()
    }
    asked = [f"outside {law.name} {name}" for law in (XU, ISO) for name in law.ranges]
    outside = {name: np.zeros(2, bool) for name in (*asked, "locked")}
    return {**run, **outside, "weight": np.array([0.25, 0.75]), **changes}


@pytest.mark.parametrize(
    ("law", "run", "words"),
    [
        (XU, {"locked": np.array([True, False])}, "its friction coefficient, 0.04, locks the mesh"),
        (XU, {"lambda_ratio": 0.4}, "the film is down to 0.4 of the composite roughness"),
        (
            XU,
            {"friction": 0.42},
            "friction up to 0.42 is an extrapolation; steel in oil has at most about 0.2",
        ),
        (
            ISO,
            {"friction": 0.28},
            "friction up to 0.28 is an extrapolation; steel in oil has at most about 0.2",
        ),
        (
            XU,
            {"outside xu_2007 viscosity": np.array([True, False])},
            "in 25 % of the mesh cycle; the viscosity leaves the range of the law, at least 1 mPa s",
        ),
        (
            ISO,
            {"outside iso_tr_14179_2 roughness_ra": np.array([True, True])},
            "an extrapolation throughout; the roughness ra leaves the range of the law, at least 0.01 um",
        ),
    ],
)
def test_a_law_out_of_its_range_says_why(law: Any, run: dict[str, Any], words: str) -> None:
    assert caveats.why_outside(case(), law, cycle()) == []
    (told,) = caveats.why_outside(case(), law, cycle(**run))
    assert words in told


def test_doubts_about_films_stand_with_their_table() -> None:
    run = cycle(**{"outside films": np.array(["the grid is coarse"])})
    for film, told in ((None, ["the grid is coarse"]), ("line", [])):
        built = case()
        built.case.film, built.laws = film, [XU]
        at = caveats.AtWork(built, [XU], [run])
        assert [*caveats.laws_left(at)] == [f"xu_2007: {text}." for text in told]


def at_boundary(run: dict[str, np.ndarray], law: Any, *gears: SolidInUse) -> list[str]:
    return caveats.boundary_warning(caveats.AtWork(case("none", *gears), [law], [run]))


def test_friction_of_a_thin_film_is_beside_that_of_boundary_lubrication() -> None:
    steel = in_use("case-hardened-mq")
    (told,) = at_boundary(cycle(lambda_ratio=0.25), ISO, steel, steel)
    # 0.1 of 1/1.25^2 of the load, over the 0.04 of the law.
    assert "0.25 of the composite roughness" in told and "up to 1.6 times" in told
    assert moves(told) == pytest.approx(0.6)
    thick = cycle(lambda_ratio=np.array([0.25, 0.5]).reshape(2, 1, 1))
    rough = cycle(lambda_ratio=0.25, friction=0.07)
    for run, law in ((thick, ISO), (rough, ISO), (cycle(lambda_ratio=0.25), XU)):
        assert not at_boundary(run, law, steel, steel)
    nylon = in_use("PA66")
    assert not at_boundary(cycle(lambda_ratio=0.25), ISO, steel, nylon)


def test_a_map_with_far_nodes_is_doubtful() -> None:
    two: Any = SimpleNamespace(laws=(ISO, XU))
    errors = {
        "interpolation_error": np.array([0.23, 0.04]),
        "mean_interpolation_error": np.array([0.03, 0.01]),
    }
    (told,) = four_quadrants._coarse(two, errors)
    assert "off by up to 23 %, 3 % in the mean" in told and ISO.title in told
    assert told.moves == pytest.approx(0.03)


def test_flanks_without_roughness_have_a_film_without_limit() -> None:
    assert caveats.why_outside(case(), XU, cycle(lambda_ratio=inf)) == []


def test_rolling_that_is_counted_twice_is_told_with_its_share() -> None:
    (told,) = caveats.why_outside(case("wu_cheng_1991"), ISO, cycle())
    assert "rolling counts twice, here with 25 % of the loss" in told
    assert caveats.why_outside(case("wu_cheng_1991"), XU, cycle()) == []


def test_limits_of_laws_are_listed() -> None:
    ranges = {row["name"]: row["range"] for row in entries()}
    assert ranges["xu_2007"] == (
        "each contact; any shape of contact; viscosity at least 1 mPa s; film at least Rq; coefficient "
        "at most 0.2"
    )
    assert limits_words("pressure", (1e9, 2e9)) == "1e+09 Pa to 2e+09 Pa"
    assert limits_words("slide_roll_ratio", (-inf, 2.0)) == "at most 2"


def test_why_a_mesh_is_locked() -> None:
    assert (
        caveats.jamming_words(0.31, 0.29)
        == "friction 0.31 reaches the 0.29 at which this mesh locks"
    )
    assert "grows with the force" in caveats.jamming_words(0.2, 0.29)


@pytest.mark.parametrize(
    ("name", "celsius", "words"),
    [
        ("PA66", 300.0, "PA66 melts at 260 degC"),
        ("PA66", 130.0, "PA66 does not bear more than 100 degC for long"),
        ("POM-H", 177.0, "POM-H melts at 177 degC"),
        ("PBT", 226.0, "PBT melts at 225 degC"),
        ("PEEK", 350.0, "PEEK melts at 343 degC"),
    ],
)
def test_a_plastic_that_is_too_hot_fails(name: str, celsius: float, words: str) -> None:
    hot, cold = in_use(name, celsius + 273.15), in_use(name)
    assert failures((cold, cold)) == []
    (told,) = failures((cold, hot))
    assert told == f"Fails: the teeth of gear 2 are at {celsius:g} degC; {words}."
    assert failures((replace(cold, flank=celsius + 273.15), cold)) != []
    if name != "POM-H":
        status = modulus_at(hot.record, celsius + 273.15).status
        assert words in status
        assert "too high" not in status


def test_beyond_its_table_a_molten_plastic_is_refused_as_such() -> None:
    with pytest.raises(InputError, match="is not allowed; POM-H melts at 177 degC"):
        solids.find("POM-H").build(500.0)


def test_what_cannot_be_is_told_apart_and_once() -> None:
    told = ["a tip is pointed.", fails("teeth melt."), "a tip is pointed.", "a root is thin."]
    assert ranked_doubts(told) == {
        "implausible": ["Fails: teeth melt."],
        "warnings": ["a tip is pointed.", "a root is thin."],
    }


def test_ra_and_rq_together_reach_the_laws_that_ask_for_them() -> None:
    both = roughness_of(
        RoughnessTable.model_validate({"ra": "0.4 um", "rq": ["0.55 um", "0.6 um"]})
    )
    assert float(both.mean_ra) == pytest.approx(0.4e-6)
    assert float(both.composite_rq) == pytest.approx(np.hypot(0.55e-6, 0.6e-6))


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({}, "no roughness was given; give ra, rq or both"),
        ({"rq": "1 um", "composite_rq": "1 um"}, "rq and composite_rq were given"),
        ({"ra": "0.5 um", "rq": "0.4 um"}, "Rq of gear 1, 0.4 um, is below its Ra, 0.5 um"),
    ],
)
def test_roughness_that_cannot_be_is_refused(table: dict[str, str], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        RoughnessTable.model_validate(table)
