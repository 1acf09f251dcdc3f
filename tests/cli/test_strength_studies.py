"""Strength over studies and drives: extremes, and how long teeth last."""

import tomllib
from typing import Any

import numpy as np
import pytest
from rated_case import EXAMPLES, PAIR, RATED, SPEED, computed, strength_of

import pitchpoint as pp
from pitchpoint.analyses.main_figures import RATING
from pitchpoint.analyses.strength import ratings_of
from pitchpoint.analyses.tooth_life import tooth_life
from pitchpoint.cases.variant import Variant
from pitchpoint.duty_cycle.history import load_steps
from pitchpoint.notebook.tables import summary_frame
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import Progress, run_variant
from pitchpoint.views.sections.studies import swept_rows

# ---- extremes, of a run and of studies

WIDTH = "gears.face_width"


def swept(text: str, *widths: str, key: str = WIDTH) -> Any:
    """A sweep of a case, by itself."""
    extra = {"x": pp.Study(sweep=pp.Sweep(key=key, values=widths))}
    variant = Variant(tomllib.loads(text), "pair.toml", "default", {})
    work = [job for job in jobs(variant, extra) if job.name == "study_x"]
    outcome = run_variant(variant, work, folder=None, studies=extra, progress=Progress())
    return outcome.parts["study_x"]


@pytest.mark.whole
def test_a_study_has_the_strength_of_each_run() -> None:
    widths = ["12 mm", "20 mm"]
    found = pp.study(tomllib.loads(PAIR + RATED), {WIDTH: [*widths, "-1 mm"]})
    by_sweep = swept(PAIR + RATED, *widths)
    for at, width in enumerate(widths):
        outcome = computed(PAIR + RATED, None, "strength", **{WIDTH: width})
        data, rows = outcome.parts["strength"], summary_frame(outcome)
        each = (
            data["contact_stress"].values.max(),
            data["root_stress"].values.max(),
            data["flank_safety"].values.min(),
            data["root_safety"].values.min(),
        )
        for name, expected in zip(RATING, each, strict=True):
            assert float(data[name]) == expected
            np.testing.assert_allclose(found[name].values[:, at], expected, rtol=1e-12)
            np.testing.assert_allclose(by_sweep[name].values[:, at], expected, rtol=1e-12)
            shown = expected / (1e6 if name.endswith("stress") else 1.0)
            assert rows.loc[name, "frictionless"] == pytest.approx(shown, rel=1e-12)
    assert all(np.isnan(found[name].values[:, 2]).all() for name in RATING)


@pytest.mark.whole
def test_a_sweep_shows_safeties_that_vary_or_else_stresses() -> None:
    def columns(text: str, *values: str, key: str = WIDTH) -> list[str]:
        heads = swept_rows(swept(text, *values, key=key))[0]
        return [head for head in heads if "safety" in head or "stress" in head]

    safeties = columns(PAIR + RATED, "12 mm", "20 mm")
    assert all("safety" in head for head in safeties) and len(safeties) == 2
    idle, loaded = swept_rows(
        swept(PAIR + RATED, "0 N m", "50 N m", key="operation.torque").isel(law=[0])
    )
    assert [idle[head] for head in safeties] == ["∞", "∞"]
    assert all(float(loaded[head]) > 1.0 for head in safeties)
    assert columns(PAIR + RATED, "50 degC", "70 degC", key="operation.temperature") == []
    plain = PAIR.replace("case-hardened-mq", "steel")
    stresses = columns(plain, "12 mm", "20 mm")
    assert len(stresses) == 2 and all("stress" in head for head in stresses)


def test_without_limits_there_are_stresses_and_no_safeties() -> None:
    found = pp.study(tomllib.loads(PAIR.replace("case-hardened-mq", "steel")), {WIDTH: ["20 mm"]})
    for name in RATING[:2]:
        assert (found[name].values > 1e7).all()
    for name in RATING[2:]:
        assert np.isnan(found[name].values).all()
    one = PAIR.replace('gear_2 = "case-hardened-mq"', 'gear_2 = "steel"')
    assert float(computed(one, None, "strength").parts["strength"]["least_root_safety"]) > 1.0


@pytest.mark.whole
def test_a_drive_has_the_extremes_of_its_rated_stages() -> None:
    def built(name: str) -> Any:
        text = (EXAMPLES / f"{name}.toml").read_text("utf-8")
        return Variant(tomllib.loads(text), f"{name}.toml", "default", {}).built({})

    data = strength_of(EXAMPLES / "two_stage.toml")
    found = ratings_of([built("two_stage")], 2)
    for name, of in (
        ("largest_contact_stress", "contact_stress"),
        ("largest_root_stress", "root_stress"),
    ):
        dims, values = found[name]
        assert (dims, values.shape) == (("law", "point"), (2, 1))
        expected = data[of].values.max()
        assert float(data[name]) == expected
        np.testing.assert_allclose(values, expected, rtol=1e-12)
    assert [*ratings_of([built("spur_and_strain_wave")], 1)] == [*RATING]
    assert ratings_of([built("torus")], 1) == {}


@pytest.mark.parametrize(("load", "roots"), [(240.0, False), (560.0, True)])
def test_teeth_last_as_long_as_the_life_at_which_their_safety_is_one(
    load: float, roots: bool
) -> None:
    text = (PAIR + RATED).replace('"50 N m"', f'"{load} N m"')
    output = SPEED * 23.0 / 61.0
    two = (load_steps([7.0, 3.0], [load, load], [output, -output], 333.15), 1.0)
    back = (load_steps([1.0], [-load], output, 333.15), -1.0)
    with pp.double_precision():
        built = Variant(tomllib.loads(text), "pair.toml", "default").built({})
        for history, side in (two, back):
            damage = tooth_life(built, history)
            working = damage["flank_life" if side > 0.0 else "back_flank_life"]
            other = damage["back_flank_life" if side > 0.0 else "flank_life"]
            assert np.isinf(other).all() and np.isfinite(working).all()
            assert np.isfinite(damage["root_life"]).any() == roots
            for name, lives in (("flank", working), ("root", damage["root_life"])):
                for gear, life in enumerate(lives.values[0]):
                    if np.isinf(life):
                        continue
                    rated = text.replace("[strength]", f'[strength]\nlife = "{float(life)!r} s"')
                    (job,) = [
                        job
                        for job in jobs(Variant(tomllib.loads(rated), "pair.toml", "default"), {})
                        if job.name == "strength"
                    ]
                    safety = job.compute(job.pieces[0])[f"{name}_safety"].values[gear]
                    assert safety == pytest.approx(1.0, rel=1e-9)


def test_a_root_of_plastic_lasts_as_long_as_its_safety_is_one_at_the_temperature_of_the_cycle() -> (
    None
):
    text = PAIR.replace('gear_2 = "case-hardened-mq"', 'gear_2 = "POM-H"')
    text = text.replace('"50 N m"', '"80 N m"')

    def built(degrees: float, more: str = "") -> Variant:
        warm = text.replace('"60 degC"', f'"{degrees} degC"')
        return Variant(tomllib.loads(warm + more), "pair.toml", "default")

    with pp.double_precision():
        case = built(60.0).built({})
        output = float(case.operation.speed) * case.output_rate
        lives = {}
        for degrees in (60.0, 70.0):  # the same case, whose cycle is warmer
            history = load_steps([1.0], [80.0], [output], degrees + 273.15)
            found = tooth_life(case, history)
            assert np.isnan(found["flank_life"].values).tolist() == [[False, True]]
            lives[degrees] = float(found["root_life"][0, 1])
            (job,) = [
                one
                for one in jobs(built(degrees, f'[strength]\nlife = "{lives[degrees]!r} s"\n'), {})
                if one.name == "strength"
            ]
            safety = job.compute(job.pieces[0])["root_safety"].values[1]
            assert safety == pytest.approx(1.0, rel=1e-9)
        both = load_steps([1.0, 1.0], [80.0, 80.0], [output, -output], [333.15, 343.15])
        damage = 0.5 / lives[60.0] + 0.5 / lives[70.0]
        assert float(tooth_life(case, both)["root_life"][0, 1]) == pytest.approx(1.0 / damage)
