"""Film, inlet heating and asperities as a case file names them, and what results say about them."""

import json
import tomllib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from sound import PAIR, quick_first

from pitchpoint.analyses.cycle import CYCLE
from pitchpoint.cases.resolved_inputs import resolved
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS, INLET_HEATING, FrictionLaw
from pitchpoint.views.inputs import printed_input_rows

TREE = tomllib.loads(PAIR)
STEEL = {"young": "206 GPa", "poisson": 0.3}


def variant(**changes: dict[str, Any]) -> Variant:
    """The shortest pair with its tables changed."""
    tree = {key: {**TREE.get(key, {}), **changes.get(key, {})} for key in {**TREE, **changes}}
    return Variant(tree, "pair.toml", "default")


def cycle(**changes: dict[str, Any]) -> xr.Dataset:
    built = variant(**changes).built({})
    return CYCLE.compute(built, None, lambda _: None)


def loaded(data: xr.Dataset, name: str) -> np.ndarray:
    """Values of a variable where contacts carry."""
    return data[name].values[data["load"].values > 0.0]


@pytest.fixture(scope="module")
def isothermal() -> xr.Dataset:
    return cycle(models={"rolling_resistance": "wu_cheng_1991"})


LINES = [name for name, law in FILM_THICKNESS.items() if law.shape == "line"]


@pytest.mark.parametrize("name", quick_first(LINES))
def test_every_film_law_of_lines_can_be_chosen(name: str, isothermal: xr.Dataset) -> None:
    data = cycle(models={"film_thickness": name, "rolling_resistance": "wu_cheng_1991"})
    ratio = loaded(data, "film_thickness") / loaded(isothermal, "film_thickness")
    assert (ratio > 0.7).all() and (ratio < 1.6).all()
    assert data.attrs["film_law"] == name


@pytest.mark.parametrize("name", quick_first(one for one in INLET_HEATING if one != "none"))
def test_heat_in_the_inlet_thins_the_film_and_lowers_the_resistance(
    name: str, isothermal: xr.Dataset
) -> None:
    data = cycle(models={"inlet_heating": name, "rolling_resistance": "wu_cheng_1991"})
    for quantity in ("film_thickness", "rolling_loss"):
        ratio = loaded(data, quantity) / loaded(isothermal, quantity)
        assert (ratio > 0.5).all() and (ratio < 1.0).all(), quantity


def test_an_oil_that_conducts_better_leaves_more_film() -> None:
    thin, thick = (
        loaded(
            cycle(models={"inlet_heating": "wilson_sheu_1983"}, lubricant={"conductivity": value}),
            "film_thickness",
        )
        for value in ("0.12 W/m/K", "0.17 W/(m K)")
    )
    assert (thick > thin).all()


def test_a_film_law_that_is_out_of_its_range_says_so() -> None:
    data = cycle(models={"film_thickness": "pan_hamrock_1989"}, operation={"speed": "20 rpm"})
    told = json.loads(data.attrs["warnings"])
    assert (
        "pan_hamrock_1989: its film is an extrapolation throughout; the speed parameter leaves the range of "
        "the law, 1e-12 to 5.05e-11."
    ) in told


def test_asperities_carry_more_of_the_load_at_low_speed() -> None:
    models = {"asperity_load": "masjedi_khonsari_2012"}
    roughness = {"ra": "0.1 um"}
    slow, fast = (
        cycle(models=models, roughness=roughness, operation={"speed": speed})
        for speed in ("100 rpm", "1500 rpm")
    )
    assert (loaded(slow, "asperity_load_ratio") >= loaded(fast, "asperity_load_ratio")).all()
    assert 0.0 < loaded(slow, "asperity_load_ratio").max() <= 1.0
    crawling = cycle(models=models, operation={"speed": "1 rpm"})
    told = " ".join(json.loads(crawling.attrs["warnings"]))
    assert "its asperity load is cut at 100 % throughout; the law gives more." in told


def test_what_a_law_asks_of_a_material_is_told_with_its_key() -> None:
    models = {"asperity_load": "masjedi_khonsari_2012"}
    with pytest.raises(InputError) as error:
        variant(models=models, materials={"gear_1": STEEL}).built({})
    assert str(error.value) == (
        "pair.toml: materials.gear_1: 'masjedi_khonsari_2012' asks for the hardness of both gears, and that "
        "of gear 1 is not known; give its material by value, with its hardness"
    )
    hard = {**STEEL, "hardness": "7 GPa"}
    given = variant(models=models, materials={"gear_1": hard})
    built = given.built({})
    assert float(built.design.solids[0].hardness) == 7e9
    rows = {row["key"]: row["value"] for row in resolved(built, given.document())}
    assert rows["gear_1.hardness"] == 7e9


def test_a_hardness_on_a_scale_is_a_pressure_and_says_so() -> None:
    given = variant(materials={"gear_1": {**STEEL, "hardness": "200 HB"}})
    built = given.built({})
    assert float(built.design.solids[0].hardness) == pytest.approx(1.96133e9, rel=1e-15)
    rows = [one for one in resolved(built, given.document()) if one["key"] == "gear_1.hardness"]
    assert rows[0]["note"] == (
        "given as 200 HB; a Brinell number is kgf/mm2 over its own indentation, used as it is"
    )
    shown = {one["key"]: one["value"] for one in printed_input_rows({"inputs": rows})}
    assert shown["gear_1.hardness"] == "1.96133 GPa"


@pytest.mark.whole
def test_a_law_of_ones_own_that_cannot_be_is_doubted() -> None:
    def told(coefficient: float) -> str:
        own = FrictionLaw("own", "own", lambda *, pressure: coefficient + 0.0 * pressure)
        data = CYCLE.compute(replace(variant(), own=(own,)).built({}), None, lambda _: None)
        return " ".join(json.loads(data.attrs["warnings"]))

    assert "own: its friction coefficient falls to -0.05: such friction drives the gears" in told(
        -0.05
    )
    assert "its friction coefficient falls" not in told(0.05)


@pytest.mark.whole
def test_a_law_of_ones_own_has_the_film_that_the_result_shows() -> None:
    """With the heat in the inlet; temperature and place are those of the case and of its contacts."""

    def law(*, lambda_ratio: Any, temperature: Any, face_position: Any) -> Any:
        return 0.02 + 0.08 / (1.0 + lambda_ratio) * (temperature / 333.15) + 0.0 * face_position

    own = FrictionLaw("own", "own", law)
    heated = variant(models={"inlet_heating": "murch_wilson_1975"})
    data = CYCLE.compute(replace(heated, own=(own,)).built({}), None, lambda _: None)
    temperature = 273.15 + float(TREE["operation"]["temperature"].split()[0])
    expected = 0.02 + 0.08 / (1.0 + loaded(data, "lambda_ratio")) * (temperature / 333.15)
    np.testing.assert_allclose(loaded(data, "friction"), expected, rtol=1e-9)
