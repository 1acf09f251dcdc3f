"""Balances in rows are those of the cycle that is traced whole, and another law compiles them alone."""

import equinox as eqx
import numpy as np
import pytest

from pitchpoint.cases.built import Built
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency import profile as profiles
from pitchpoint.efficiency import rows, summary
from pitchpoint.efficiency.profile import profile
from pitchpoint.efficiency.quasi_static import cycle
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS

PAIR = {
    "gears": {"teeth": [23, 61], "module": "2 mm", "face_width": "20 mm"},
    "lubricant": {"name": "pao-vg-100"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "67 N m", "speed": "2000 rpm", "temperature": "40 degC"},
}
FILM = FILM_THICKNESS["dowson_higginson_1959"]


@pytest.fixture(scope="module")
def built() -> Built:
    return Variant(PAIR, "pair.toml", "default", {"models.friction": "xu_2007"}).built({})


def programs() -> list[int]:
    every = (rows.engagements, rows.row_balances, summary._summaries, profiles._profile)
    return [len(one.ready) for one in every]


def test_rows_hold_the_balance_of_the_whole_cycle(built: Built) -> None:
    whole = eqx.filter_jit(cycle)(built.design, built.operation, built.models[0], 48)
    found = profile(built.design, built.operation, built.models[0], FILM)
    np.testing.assert_allclose(found["phase"], whole.phase, rtol=1e-15)
    np.testing.assert_allclose(found["input_torque"], whole.state.input_torque, rtol=1e-13)
    friction = np.moveaxis(np.asarray(whole.state.balance.friction), -1, 0)
    np.testing.assert_allclose(found["friction"], friction, rtol=1e-11, atol=1e-15)


def test_another_law_compiles_its_balance_alone(
    built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rows.row_balances, "ready", {})  # another test may have asked for that law

    def figures(models: object) -> float:
        found = summary.summarise([(built.design, built.operation)], models)
        profile(built.design, built.operation, models, FILM)
        return float(found["mean_efficiency"][0])

    first, before = figures(built.models[0]), programs()
    other = Variant(PAIR, "pair.toml", "default").built({}).models[0]
    second, after = figures(other), programs()
    assert other.law.name == "iso_tr_14179_2"
    assert first != second
    assert np.subtract(after, before).tolist() == [0, 1, 0, 0]
