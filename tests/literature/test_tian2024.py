"""Tian, Wang, Jiang (2024): printed numbers within what the print supports, statements that hold or do not.

Excluded: the 98.03 % quoted from another reference, whose model and conditions are not given.
"""

import dataclasses

import bank
import numpy as np
import pytest
import xarray as xr

from pitchpoint._jax import jnp
from pitchpoint.analyses.comparison import compare
from pitchpoint.cases.document import leaves
from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.loading.loading_registry import LoadSharing
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.tian2024.pair_on_path import readings
from pitchpoint.results.target_rows import counts
from pitchpoint.runs.jobs import jobs


@pytest.fixture(scope="module")
def rows():
    return bank.rows("tian2024")


def computed(changes):
    """Comparison of the case with some inputs changed."""
    name, tree = find_case("tian2024")
    variant = Variant(tree, name, "as_published", changes)
    targets = variant.built({}).case.targets
    needed = {target.reads for target in targets}
    parts = {
        job.name: job.compute(job.pieces[0]) for job in jobs(variant, {}) if job.name in needed
    }
    return compare(targets, parts)


MISSED = {
    "double contact: force by Method I above that without friction": "behind the pitch point",
    "efficiency by Method II not above that by Method I at any position": "around the pitch point",
    "input torque by Method II not below that by Method I at any position": "around the pitch point",
    "Method I, a lower contact ratio lowers the ripple by more than 0.005 N m": "middle of double",
    "Method II, a lower contact ratio lowers the ripple by more than 0.005 N m": "middle of double",
    "case 3, Method I, relative drop of ripple": "truncated",
    "case 3, Method II, relative drop of ripple": "truncated",
}
"""Statements of the paper that its model contradicts, and words of the cause."""


def test_rows_that_miss_are_those_with_a_known_cause(rows):
    missed = {row.quantity: row for row in rows if row.verdict == "miss"}
    assert missed.keys() == MISSED.keys()
    for quantity, words in MISSED.items():
        assert missed[quantity].expected_miss
        assert words in missed[quantity].reason
    assert all(row.reason for row in rows if row.verdict == "excluded")


def test_rows_are_counted_for_each_kind(rows):
    assert {kind: dict(found) for kind, found in counts(rows).items()} == {
        "predicted": {"pass": 4, "miss": 2},
        "definition": {"pass": 4},
        "calibrated": {"pass": 23},
        "trend": {"pass": 11, "miss": 5},
        "fitted": {"pass": 4},
        "excluded": {"excluded": 1},
    }


@pytest.mark.parametrize(
    "changes",
    [
        {"roughness.ra": "0.808 um"},
        {"lubricant.viscosity_40": "101.764 mm2/s", "lubricant.viscosity_100": "15.656 mm2/s"},
    ],
    ids=["Ra 1 % higher", "viscosity 3 % higher"],
)
def test_a_small_change_of_the_inputs_makes_rows_miss(changes):
    missed = {row.quantity for row in computed(changes) if row.verdict == "miss"}
    assert missed - MISSED.keys()


def of_case_1(**other):
    """Courses and numbers of case 1, with other models."""
    variant = Variant(*reversed(find_case("tian2024")), "as_published")
    study = variant.built({}).case.studies["case_1"]
    built = variant.built(dict(leaves(study.change)))
    models = tuple(dataclasses.replace(one, **other) for one in built.models)
    point = ReadingPoint(
        built.case.gears, built.design, built.operation, built.case.formulas, models
    )
    return readings(point), variant.built({}).case.targets


def rows_of_case_1(**other):
    found, targets = of_case_1(**other)
    numbers = {name: [[value]] for name, value in found.items() if isinstance(value, float)}
    data = xr.Dataset({name: (("law", "point"), value) for name, value in numbers.items()})
    those = [one for one in targets if one.study == "case_1" and one.variable in numbers]
    return {row.quantity: row.verdict for row in compare(those, {"study_case_1": data})}


def another_share(contacts, mesh, yielding=None):
    """0.33 - 0.67 - 1 - 0.67 - 0.33 in place of eq. 11."""
    double = mesh.contact_ratio - 1.0
    from_end = jnp.minimum(contacts.path, mesh.contact_ratio - contacts.path)
    share = jnp.where(from_end <= double, 0.33 + 0.34 * from_end / double, 1.0)
    share = jnp.where(contacts.active, share, 0.0)
    return share / jnp.sum(share, axis=(0, 1), keepdims=True)


def test_other_shares_of_two_pairs_miss_the_rows_of_eq_11():
    eq_11 = {name for name in rows_of_case_1() if name.startswith("eq. 11")}
    assert len(eq_11) == 3
    assert {name for name, verdict in rows_of_case_1().items() if verdict == "miss"} == {
        "double contact: force by Method I above that without friction"
    }
    other = LoadSharing("other", "other shares", another_share)
    found = rows_of_case_1(sharing=other)
    assert {name for name in eq_11 if found[name] == "miss"} == eq_11


def test_courses_of_a_pair_follow_the_equations():
    """Eqs. 1, 3, 11 and 18 from the shares and coefficients of the pairs alone, by plain numbers."""
    found, _ = of_case_1()
    place, radii = found["pair_path"], 9e-3 * np.array([3.0, 6.0]) * np.cos(np.radians(20.0))
    pitch = 2.0 * np.pi * radii[0] / 18.0
    tip = np.sqrt(57e-3**2 - radii[1] ** 2)
    length = 81e-3 * np.sin(np.radians(20.0))
    for method in ("average", "varying"):
        own, other = (found[f"pair_{name}_{method}"] for name in ("friction", "other_friction"))
        share, double = found["pair_share"], np.isfinite(other)
        beside = np.where(place < 0.7, place + 1.0, place - 1.0)
        turned = []
        for gear in (0, 1):
            total = np.ones_like(place)
            for where, mu, part in (
                (place, own, share),
                (beside, np.nan_to_num(other), 1.0 - share),
            ):
                from_n1 = length - tip + where * pitch
                arm = from_n1 if gear == 0 else length - from_n1
                past_pitch_point = np.sign(from_n1 - length / 3.0)
                total = total + past_pitch_point * part * mu * arm / radii[gear]
            turned.append(total)
        efficiency = turned[1] / turned[0]
        np.testing.assert_allclose(found[f"pair_efficiency_{method}"], efficiency, atol=2e-6)
        np.testing.assert_allclose(found[f"pair_force_{method}"], share / turned[1], atol=2e-6)
        assert np.all(double == (share < 1.0))
        torque = 159.0 / 2.0 / efficiency
        np.testing.assert_allclose(found[f"pair_input_torque_{method}"], torque, atol=2e-4)


def test_a_reading_of_the_paper_is_not_in_the_library():
    from pitchpoint.lubrication.lubrication_registry import LAWS

    assert not [law.name for law in LAWS if "tian" in law.name]


def test_rows_carry_units_of_the_print(rows):
    units = {row.unit for row in rows}
    assert units == {"1", "%", "N m"}
    assert all(dataclasses.asdict(row)["where"] for row in rows)
