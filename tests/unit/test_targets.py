"""How a target reads one number out of a part: places of the axis, slopes, and what is refused."""

import tomllib

import numpy as np
import pytest
from sound import PAIR

from pitchpoint.analyses.comparison import _Axis, compare, demand_parts
from pitchpoint.cases.document import Document
from pitchpoint.cases.library import case_names, find_case
from pitchpoint.cases.study_tables import Target
from pitchpoint.cases.validation import validate
from pitchpoint.errors import InputError
from pitchpoint.published.publication_registry import PUBLICATIONS
from pitchpoint.results.store import dataset
from pitchpoint.results.target_rows import TargetRow, verdict_sentence
from pitchpoint.runs.run import uncomputed_manifests

TORQUE = np.array([0.0, 10.0, 20.0, 40.0])
WIND_UP = np.array([0.0, 2e-4, 3e-4, 4e-4])
DEGREES = np.array([313.15, 293.15, 273.15])
EFFICIENCY = np.array([[0.8, 0.7, 0.5], [1.0, 1.0, 1.0]])
LAWS = {"law": ["constant", "frictionless"]}


def results():
    """Wind-up over torque, a study over temperatures given from the highest down, and a plain point."""
    torsion = {"wind_up": (("torque",), WIND_UP), "mean_friction": (("law",), [0.1, 0.0])}
    axes = {"speed": np.ones(2), "temperature": np.ones(2)}
    warm = {"mean_efficiency": (("law", "point"), EFFICIENCY), "axis": (("point",), DEGREES)}
    told = {"sweep_key": "operation.temperature", "axis_kind": "temperature", "axis_unit": "degC"}
    return {
        "torsion": dataset(torsion, {**LAWS, "torque": TORQUE}),
        "running": dataset({"no_load_torque": (tuple(axes), np.ones((2, 2)))}, axes),
        "study_warm": dataset(warm, LAWS, **told),
        "study_point": dataset({"mean_efficiency": (("law", "point"), EFFICIENCY[:, :1])}, LAWS),
    }


def target(**changes):
    plain = {"quantity": "q", "where": "w", "kind": "predicted", "printed": 1.0}
    return Target(**{**plain, **changes})


def read(**changes):
    return compare([target(**changes)], results())[0].computed


WOUND = {"part": "torsion", "variable": "wind_up"}
WARM = {"study": "warm", "variable": "mean_efficiency"}


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({**WOUND, "at": "15 N m", "unit": "mrad"}, 0.25),
        ({**WOUND, "at": "40 N m"}, 4e-4),
        ({**WOUND, "reduce": "last", "unit": "arcmin"}, np.degrees(4e-4) * 60.0),
        ({**WOUND, "at": ["5 N m", "15000 N mm"], "reduce": "gain"}, 1.5e-4),
        ({**WOUND, "at": ["0 N m", "20 N m"], "reduce": "inverse_slope"}, 20.0 / 3e-4),
        (
            {**WOUND, "at": ["20 N m", "40 N m"], "reduce": "inverse_slope", "unit": "kN m/rad"},
            200.0,
        ),
        ({**WOUND, "at": ["40 N m", "20 N m"], "reduce": "slope"}, 5e-6),
        ({**WOUND, "reduce": "slope"}, 1e-5),
        ({**WOUND, "law": [1], "at": "10 N m"}, 2e-4),
        ({**WARM, "at": "30 degC", "unit": "%"}, 75.0),
        ({**WARM, "at": ["283.15 K", "0 degC"], "reduce": "relative_drop"}, 1.0 - 0.5 / 0.6),
        ({**WARM, "at": "10 degC", "law": [1]}, 1.0),
        ({**WARM, "at": ["0 degC", "20 degC"], "law": [0, 1], "reduce": "max_difference"}, 0.5),
        ({**WARM, "law": [0, 1], "reduce": "least_excess"}, -0.5),
        ({**WARM, "law": [1, 0], "reduce": "least_excess"}, 0.2),
        ({**WOUND, "reduce": "least_rise"}, 1e-4),
        ({**WOUND, "at": ["40 N m", "20 N m"], "reduce": "largest_rise"}, -1e-4),
        ({**WOUND, "at": "15 N m", "less": 2e-4}, 0.5e-4),
        ({"study": "point", "variable": "mean_efficiency"}, 0.8),
    ],
)
def test_values_and_slopes(given, expected):
    assert read(**given) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("given", "key", "words"),
    [
        ({**WOUND}, "at", ("value takes one place",)),
        ({**WOUND, "at": ["9 N m", "9000 N mm"], "reduce": "slope"}, "at", ("two places",)),
        ({**WOUND, "at": "3 mm"}, "at", ("length", "torque")),
        ({**WOUND, "at": 3}, "at", ("no unit",)),
        ({**WOUND, "at": "1 N m", "reduce": "slope"}, "at", ("slope takes two places",)),
        (
            {"study": "point", "variable": "mean_efficiency", "reduce": "least_rise"},
            "at",
            ("least_rise takes two places",),
        ),
        ({**WOUND, "at": ["1 N m", "2 N m"]}, "at", ("value takes one place",)),
        ({**WOUND, "reduce": "slope", "unit": "N m/rad"}, "unit", ("N m/rad", "angle over torque")),
        ({**WOUND, "at": "1 N m", "law": [2]}, "law", ("[2]", "this part has 2 friction laws")),
        ({**WOUND, "variable": "loss"}, "variable", ("no quantity 'loss'",)),
        ({**WOUND, "part": "torsions"}, "part", ('no part "torsions"', "did you mean torsion?")),
        (
            {"part": "running", "variable": "no_load_torque"},
            "variable",
            ("over speed and temperature", "one axis"),
        ),
        (
            {"study": "point", "variable": "mean_efficiency", "reduce": "slope"},
            "reduce",
            ("needs an axis",),
        ),
        (
            {"study": "point", "variable": "mean_efficiency", "at": "1 N m"},
            "at",
            ("no axis of numbers",),
        ),
        ({"study": "warmer", "variable": "loss"}, "study", ('no study "warmer"',)),
    ],
)
def test_what_cannot_be_read_is_one_sentence(given, key, words):
    with pytest.raises(InputError) as caught:
        compare([target(**given)], results(), "case.toml")
    told = str(caught.value)
    assert told.startswith(f"case.toml: targets.0.{key}: ")
    assert "\n" not in told
    for word in words:
        assert word in told


def test_a_number_that_was_not_solved_for_is_no_known_miss():
    parts = results()
    parts["torsion"]["wind_up"] = np.nan * parts["torsion"]["wind_up"]
    known = target(**{**WOUND, "at": "15 N m"}, missed="the shaft is not in the model")
    (row,) = compare([known], parts)
    assert row.surprises
    assert row.reason.startswith("not computed")
    (solved,) = compare([known], results())
    assert (solved.verdict, solved.surprises) == ("miss", False)


@pytest.mark.parametrize(
    "given", [{"missed": "m", "kind": "excluded"}, {"missed": "m", "reason": "r"}]
)
def test_a_known_miss_is_computed_and_has_one_cause(given):
    with pytest.raises(ValueError, match=r"known miss has one|not missed"):
        target(**given)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({**WOUND, "at": "41 N m"}, ('"41 N m" lies outside', "torque", "0 N m to 40 N m")),
        ({**WARM, "at": "-1 degC"}, ("operation.temperature", "0 degC to 40 degC")),
    ],
)
def test_a_place_beyond_what_was_computed_makes_a_row_that_misses(given, words):
    """With a smaller torque by `--set` the part ends before it; what was computed is kept."""
    (row,) = compare([target(**given, reason="asked")], results(), "case.toml")
    assert np.isnan(row.computed)
    assert row.verdict == "miss"
    assert row.reason.startswith("not computed: ")
    for word in (*words, "asked"):
        assert word in row.reason


@pytest.mark.parametrize(
    ("given", "bound", "verdict"),
    [
        ({"expect": "below", "times": 2, "printed": 2e-4}, "< 2 x ", "pass"),
        ({"expect": "below", "times": 2, "printed": 1e-4}, "< 2 x ", "miss"),
        ({"expect": "above", "times": 0.5, "printed": 5e-4}, "> 0.5 x ", "pass"),
        ({"expect": "above", "printed": 5e-4}, "> ", "miss"),
        ({"tolerance": 3e-4, "printed": 1e-4}, "", "pass"),
    ],
)
def test_a_bound_is_shown_as_one(given, bound, verdict):
    (row,) = compare([target(**WOUND, at="20 N m", **given)], results())
    assert (row.bound, row.verdict) == (bound, verdict)


def test_no_shipped_case_passes_a_number_within_its_whole_size():
    """What may be off by its own size is a bound, and says which way."""
    for name in case_names():
        tree = find_case(name)[1]
        given = [*tree.get("targets", [])]
        for overlay in tree.get("variants", {}).values():
            given += overlay.get("targets", [])
        assert given
        wide = [t for t in given if t.get("tolerance", 0.0) >= 0.5 * abs(t["printed"]) > 0.0]
        assert not [t for t in wide if t.get("expect", "within") == "within"]


def course(*points):
    """A course of a publication over places of its own, at some points."""
    roll = np.array([np.radians([0.0, 1.0, 2.0])] * len(points))
    along = ("point", "stiffness_roll_place")
    values = {"stiffness_roll": (along, roll), "torus_secant_stiffness": (along, np.array(points))}
    return {"study_one": dataset(values, {})}


ON_COURSE = {"study": "one", "variable": "torus_secant_stiffness", "unit": "N/um"}


def test_a_course_of_a_publication_is_read_along_its_places():
    assert (
        PUBLICATIONS["liu_xiong_2017"].courses["torus_secant_stiffness"] == "stiffness_roll_place"
    )
    rising = course([1e8, 2e8, 4e8])
    rows = [
        compare([target(**ON_COURSE, **given)], rising)[0].computed
        for given in ({"at": "1.5 deg"}, {"reduce": "least_rise"}, {"reduce": "max"})
    ]
    np.testing.assert_allclose(rows, [300.0, 100.0, 400.0])
    (row,) = compare([target(**ON_COURSE, at="3 deg")], rising)
    assert row.verdict == "miss"
    assert "stiffness_roll runs from 0 deg to 2 deg" in row.reason
    with pytest.raises(InputError, match="over point and stiffness_roll_place"):
        compare([target(**ON_COURSE, at="1 deg")], course([1e8] * 3, [2e8] * 3))


@pytest.mark.parametrize(("at", "told"), [("1 deg", ""), ("1 N m", "torque"), (1.0, "no unit")])
def test_places_on_a_course_of_a_publication_are_those_of_its_kind(at, told):
    tree = {"targets": [{**ON_COURSE, "quantity": "q", "where": "w", "kind": "trend", "at": at}]}
    tree["targets"][0] |= {"printed": 1.0, "study": "plain"}
    document = Document("case.toml", {**tree, **REST, "source": "liu_xiong_2017"})
    if not told:
        assert validate(document).targets[0].at == ("1 deg",)
        return
    with pytest.raises(InputError, match=rf"targets\.0\.at: .*{told}"):
        validate(document)


def test_a_part_that_the_case_does_not_compute_is_told_before_it_runs():
    targets = [target(kind="excluded"), target(**WOUND)]
    demand_parts(targets, ["teeth", "torsion"], "case.toml")
    with pytest.raises(InputError, match=r'targets\.1\.part: .*no part "torsion"; known are teeth'):
        demand_parts(targets, ["teeth", "study_warm"], "case.toml")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"part": "torsion", "study": "warm"}, ("part: ", "reads one of them")),
        ({"at": True}, ("at: ", "true", "place of the axis")),
        ({"at": []}, ("at: ", "0 places")),
        ({"study": "plain", "at": "1 N m"}, ("at: ", '"plain" has no axis of numbers')),
        ({"study": "loaded", "at": "1 rpm"}, ("at: ", "rotational speed", "torque")),
        ({"reduce": "slop"}, ("reduce: ", "slope")),
        ({"times": 2}, ("times: ", "expect")),
    ],
)
def test_a_target_of_a_wrong_form(given, words):
    plain = {"quantity": "q", "where": "w", "kind": "predicted", "printed": 1.0}
    with pytest.raises(InputError) as caught:
        validate(Document("case.toml", {"targets": [{**plain, **given}], **REST}))
    for word in ("case.toml: targets.0", *words):
        assert word in str(caught.value)


def test_a_variant_is_measured_by_targets_of_its_own(tmp_path):
    """And only then, unless it is the reading of the paper."""
    path = tmp_path / "two.toml"
    path.write_text(f"{PAIR}[variants.own]\n[variants.plain]\n{WINDING.format('variants.own.')}")
    assert uncomputed_manifests(str(path), ["plain"])
    with pytest.raises(InputError, match=r'two\.toml: targets\.0\.part: .*no part "torsion"'):
        uncomputed_manifests(str(path), ["own"])
    path.write_text(f"{PAIR}[variants.as_published]\n[variants.plain]\n{WINDING.format('')}")
    assert uncomputed_manifests(str(path), ["plain"])
    with pytest.raises(InputError, match="no part"):
        uncomputed_manifests(str(path))


WINDING = """
[[{}targets]]
quantity = "wind-up"
where = "Table 1"
kind = "predicted"
printed = 1
part = "torsion"
variable = "wind_up"
"""

REST = tomllib.loads(PAIR) | {
    "studies": {
        "plain": {},
        "loaded": {"sweep": {"key": "operation.torque", "values": ["1 N m", "2 N m"]}},
    },
}


def row(kind, verdict, reason="", expected_miss=False):
    return TargetRow(
        "q", "w", 1.0, 1.0, "1", 0.1, kind, verdict, reason, expected_miss=expected_miss
    )


def test_a_number_surprises_that_is_missed_without_cause_or_met_in_spite_of_one():
    known = "the model has no cup"
    surprising = [row("trend", "miss", "a remark"), row("trend", "pass", known, True)]
    expected = [row("trend", "miss", known, True), row("trend", "pass", "a remark")]
    assert [one.surprises for one in surprising + expected] == [True, True, False, False]
    assert not row("excluded", "excluded", known).surprises
    assert verdict_sentence(surprising[1:]) == "1 printed number: 1 met in spite of its reason"


def test_numbers_of_an_independent_calculation_are_counted_apart():
    rows = [
        row("predicted", "pass"),
        row("trend", "miss", "the paper says so of another load", True),
        row("fitted", "miss"),
        row("excluded", "excluded", "is not printed"),
        row("definition", "pass"),
    ]
    of_the_publication = (
        "5 printed numbers: 2 met, 1 missed with a reason, 1 missed without a reason, 1 left out; "
        "1 of 1 predicted met"
    )
    assert verdict_sentence(rows) == of_the_publication
    beside = [row("reference", "pass"), row("reference", "miss")]
    assert (
        verdict_sentence(beside + rows)
        == f"{of_the_publication}; 2 of an independent calculation: 1 met, 1 missed without a reason"
    )
    found = [row("fitted", "pass"), row("calibrated", "pass"), row("predicted", "pass")]
    assert verdict_sentence(found) == "3 printed numbers: 3 met (2 fitted); 1 of 1 predicted met"
    assert verdict_sentence(beside[:1]) == "1 of an independent calculation: 1 met"
    assert verdict_sentence([]) == ""


def test_an_axis_that_begins_at_what_rounding_left_is_told_to_begin_at_zero():
    axis = _Axis("stiffness_roll", np.array([2.7e-10, 0.27]), "angle", "deg")
    with pytest.raises(InputError, match=r"runs from 0 ?\S* to 15\.4"):
        axis.at(["16 deg"])
