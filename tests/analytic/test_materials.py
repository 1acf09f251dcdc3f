"""Material laws against closed forms, and the catalogue against its own check values."""

import tomllib
from dataclasses import replace
from importlib import resources

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pitchpoint import citations
from pitchpoint.errors import InputError
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.data import Datum
from pitchpoint.materials.pressure_viscosity import gold_2001
from pitchpoint.materials.solids import ModulusPoint, Solid, SolidRecord, reduced_modulus
from pitchpoint.materials.surfaces import Roughness, composite_rq
from pitchpoint.materials.viscosity import astm_d341

DATA = resources.files("pitchpoint.materials").joinpath("catalogue", "lubricants.toml")
OILS = tomllib.loads(DATA.read_text(encoding="utf-8"))["oil"]
d341 = jax.jit(astm_d341)

CHECKED = [name for name, entry in OILS.items() if "nu_80_mm2_s" in entry]


def test_reduced_modulus_of_steel():
    steel = solids.find("steel").build()
    assert float(reduced_modulus(steel, steel)) == pytest.approx(206e9 / 0.91, rel=1e-15)
    assert float(reduced_modulus(steel, steel)) / 1e9 == pytest.approx(226.4, abs=0.05)


def test_reduced_modulus_against_a_much_stiffer_body_doubles():
    soft = Solid(young=3e9, poisson=0.4, density=1400.0)
    hard = Solid(young=3e20, poisson=0.3, density=7830.0)
    assert float(reduced_modulus(soft, hard)) == pytest.approx(2.0 * 3e9 / 0.84, rel=1e-9)


def test_steel_gives_the_elasticity_factor_of_iso_6336_2():
    steel = solids.find("steel").build()
    factor = jnp.sqrt(reduced_modulus(steel, steel) / 1e6 / (2.0 * jnp.pi))
    assert float(factor) == pytest.approx(189.8, abs=0.05)


STRAIGHT = SolidRecord(
    name="straight",
    young=Datum(value=3e9),
    poisson=Datum(value=0.4),
    density=Datum(value=1300.0),
    young_temperature=Datum(value=293.15),
    young_at=(
        ModulusPoint(temperature=273.15, young=Datum(value=3.2e9)),
        ModulusPoint(temperature=323.15, young=Datum(value=2.7e9)),
        ModulusPoint(temperature=373.15, young=Datum(value=0.7e9)),
    ),
)


def test_modulus_is_interpolated_between_its_temperatures():
    built = STRAIGHT.build(jnp.array([273.15, 293.15, 323.15, 348.15, 373.15]))
    np.testing.assert_allclose(built.young, [3.2e9, 3.0e9, 2.7e9, 1.7e9, 0.7e9], rtol=1e-14)
    assert float(built.poisson) == 0.4
    assert float(STRAIGHT.build().young) == 3e9


@pytest.mark.parametrize(
    ("temperature", "words"),
    [(400.15, "127 degC"), (272.15, "-1 degC"), (float("nan"), "nan degC")],
)
def test_modulus_outside_its_table_is_refused(temperature, words):
    with pytest.raises(InputError) as caught:
        STRAIGHT.build(temperature)
    assert str(caught.value) == (
        "the modulus of straight is known from 0 degC to 100 degC and is not extrapolated: "
        f"a temperature of {words} is not allowed"
    )
    with pytest.raises(InputError, match=words):
        STRAIGHT.build(np.array([300.0, temperature]))


def test_a_single_modulus_serves_at_every_temperature_and_says_so():
    peek = solids.find("PEEK")
    assert float(peek.build(393.15).young) == peek.young.value
    assert peek.young_range is None
    assert peek.modulus_known == "its modulus is known at 23 degC only"
    assert solids.find("steel").modulus_known.endswith(
        "at one temperature only, which is not stated"
    )
    assert STRAIGHT.modulus_known == "its modulus is known from 0 degC to 100 degC"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"young_at": STRAIGHT.young_at[:1]}, "young_at: a table of moduli needs two temperatures"),
        ({"young_at": STRAIGHT.young_at[::-1]}, "young_at: the temperatures must rise"),
        (
            {"young": Datum(value=2e9)},
            "young_at: the table must give the single modulus at 20 degC",
        ),
        ({"young_temperature": Datum(value=400.0)}, "the single modulus at 126.9 degC"),
        ({"conductivity": Datum(value=-0.2)}, "conductivity: -0.2 is not a positive number"),
        ({"poisson": Datum(value=0.6)}, "poisson: 0.6 is not between -1 and 0.5"),
    ],
)
def test_impossible_solid_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(STRAIGHT, **change)


@pytest.mark.parametrize("name", ["PA66", "PA66-3.54", "POM-H", "PBT", "PEEK"])
def test_plastics_of_the_catalogue_are_plastics(name):
    record = solids.find(name)
    assert 2e9 < record.young.value < 4.1e9
    assert 1e3 < record.density.value < 1.5e3
    assert record.conductivity is not None
    assert 0.15 < record.conductivity.value < 0.4
    assert record.young_temperature is not None
    at_room = record.build(record.young_temperature.value)
    assert float(at_room.young) == pytest.approx(record.young.value, rel=1e-12)
    softer = [point.young.value for point in record.young_at]
    assert softer == sorted(softer, reverse=True)


def test_d341_passes_through_its_two_points():
    nu = d341(T=jnp.array([313.15, 373.15]), nu_1=98.8e-6, T_1=313.15, nu_2=15.2e-6, T_2=373.15)
    np.testing.assert_allclose(nu, [98.8e-6, 15.2e-6], rtol=1e-12)


def test_d341_meets_a_hand_calculation():
    nu = d341(T=328.15, nu_1=98.8e-6, T_1=313.15, nu_2=15.2e-6, T_2=373.15)
    assert float(nu) * 1e6 == pytest.approx(54.79, abs=0.005)


def test_d341_is_straight_in_its_own_coordinates():
    T = jnp.geomspace(280.0, 390.0, 7)
    nu = d341(T=T, nu_1=98.8e-6, T_1=313.15, nu_2=15.2e-6, T_2=373.15)
    steps = jnp.diff(jnp.log10(jnp.log10(nu * 1e6 + 0.7)))
    np.testing.assert_allclose(steps, steps[0], rtol=1e-10)


@pytest.mark.parametrize("name", CHECKED)
def test_viscosity_of_the_catalogue_at_80_degc(name):
    nu = lubricants.find(name).build().kinematic_viscosity(353.15)
    assert float(nu) * 1e6 == pytest.approx(OILS[name]["nu_80_mm2_s"]["value"], rel=4e-4)


def test_all_check_values_of_the_catalogue_are_used():
    assert len(CHECKED) == 18


def test_density_falls_linearly_from_15_degc():
    oil = lubricants.find("mineral-vg-220").build()
    assert float(oil.density(288.15)) == 902.0
    assert float(oil.density(328.15)) == pytest.approx(902.0 * (1.0 - 5.8e-4 * 40.0), rel=1e-7)


def test_dynamic_viscosity_is_the_product():
    oil = lubricants.find("75W90-A").build()
    product = oil.kinematic_viscosity(328.15) * oil.density(328.15)
    assert float(oil.viscosity(328.15)) == pytest.approx(float(product), rel=1e-15)
    assert float(oil.viscosity(328.15)) == pytest.approx(46.0e-3, abs=0.1e-3)


def test_gold_at_one_mm2_s_is_its_constant():
    assert float(gold_2001(nu=1e-6, s=9.904, t=0.139)) == pytest.approx(9.904e-9, rel=1e-12)


def test_gold_meets_a_hand_calculation():
    # lg 100 = 2, so 100^0.139 = 10^0.278 = 1.89671
    assert float(gold_2001(nu=100e-6, s=9.904, t=0.139)) == pytest.approx(18.785e-9, rel=1e-4)


def test_constant_pressure_viscosity_does_not_change_with_temperature():
    s, t = lubricants.constant_alpha(22e-9)
    oil = lubricants.find("fva-3").with_values(gold_s=s, gold_t=t).build()
    np.testing.assert_allclose(oil.pressure_viscosity(jnp.array([300.0, 350.0])), 22e-9, rtol=1e-14)


def test_oil_of_a_base_has_its_viscosities_and_the_values_of_the_base():
    oil = lubricants.of_base("mine", "pao", nu_1=60e-6, nu_2=9e-6)
    built, like = oil.build(), lubricants.find("pao-vg-220").build()
    found = built.kinematic_viscosity(jnp.array([313.15, 373.15]))
    np.testing.assert_allclose(found, [60e-6, 9e-6], rtol=1e-12)
    assert float(built.density(300.0)) == float(like.density(300.0))
    assert float(built.gold_s) == float(like.gold_s)
    assert oil.note == ""
    with pytest.raises(InputError, match='"PAO" is not a base oil'):
        lubricants.of_base("mine", "PAO", nu_1=60e-6, nu_2=9e-6)
    with pytest.raises(InputError, match=r"mine\.nu_1: must be above nu_2"):
        lubricants.of_base("mine", "pao", nu_1=6e-6, nu_2=9e-6)


def test_grease_is_its_base_oil_in_a_computation():
    oil = lubricants.of_base("joint grease", "mineral", nu_1=60e-6, nu_2=8e-6)
    grease = oil.thickened(thickener="lithium soap", consistency="2")
    assert jax.tree.all(jax.tree.map(lambda a, b: a == b, grease.build(), oil.build()))
    assert (grease.thickener, grease.consistency) == ("lithium soap", "2")
    assert grease.data() == oil.data()
    assert "joint grease is taken as its base oil" in grease.note
    thinner = grease.with_values(nu_2=7e-6)
    assert isinstance(thinner, lubricants.GreaseRecord)
    assert float(thinner.build().nu_2) == 7e-6


@pytest.mark.parametrize("name", ["pao-4", "pao-6", "pao-8"])
def test_an_oil_for_the_cold_goes_through_its_three_viscosities(name):
    record = lubricants.find(name)
    oil = record.build()
    viscosity = eqx.filter_jit(oil.kinematic_viscosity)
    temperatures = np.concatenate(
        [[233.15, 313.15, 373.15, 313.15 - 1e-9, 313.15 + 1e-9], np.linspace(233.15, 393.15, 33)]
    )
    found, beside, course = np.split(np.asarray(viscosity(temperatures)), [3, 5])
    known = [float(value) for value in (oil.nu_0, oil.nu_1, oil.nu_2)]
    np.testing.assert_allclose(found, known, rtol=1e-12)
    assert float(oil.T_min) == pytest.approx(233.15, rel=1e-14)
    assert np.all(np.diff(course) < 0.0)
    assert float(beside[0]) == pytest.approx(float(beside[1]), rel=1e-9)
    alone = d341(T=233.15, nu_1=oil.nu_1, T_1=313.15, nu_2=oil.nu_2, T_2=373.15)
    assert 1.7 < float(alone) / known[0] < 2.3


def test_an_oil_for_the_cold_tells_what_changes_at_room_temperature():
    oil = lubricants.find("pao-4")
    line = d341(T=298.15, nu_1=19e-6, T_1=313.15, nu_2=4.1e-6, T_2=373.15)
    there = float(oil.build().kinematic_viscosity(298.15))
    assert f"at 25 degC it is {there * 1e6:.4g} mm2/s" in oil.bend
    assert f"{100.0 * (there / float(line) - 1.0):+.1f} % against the line" in oil.bend
    assert lubricants.find("fva-3").bend == ""


def test_a_viscosity_in_the_cold_goes_with_the_other_two():
    oil = lubricants.find("pao-4")
    line = float(d341(T=233.15, nu_1=oil.nu_1.value, T_1=313.15, nu_2=4.1e-6, T_2=373.15))
    for known in ("pao-4", "pao-6", "pao-8", "fva-3"):
        lubricants.demand_plausible_cold(lubricants.find(known))
    for factor in (0.21, 4.9):
        lubricants.demand_plausible_cold(oil.with_values(nu_0=factor * line))
    for factor in (0.19, 5.1):
        with pytest.raises(InputError, match=r"no oil is off it by more than a factor of 5"):
            lubricants.demand_plausible_cold(oil.with_values(nu_0=factor * line))


def test_a_grease_tells_its_consistency_and_what_is_left_out_in_the_cold():
    grease = lubricants.find("pao-6").thickened(thickener="lithium soap", consistency="2")
    assert grease.data() == lubricants.find("pao-6").data()
    assert "nor does it stiffen the grease in the cold" in grease.note
    assert "NLGI 2 (worked penetration 265 to 295 tenths of a millimetre)" in grease.note
    own = lubricants.find("pao-6").thickened(consistency="1-2").note
    assert own.endswith("NLGI 1-2 is recorded.")


def test_range_of_temperature():
    oil = lubricants.find("fva-3").build()
    inside = oil.in_range(jnp.array([273.0, 273.15, 393.15, 393.3]))
    assert inside.tolist() == [False, True, True, False]


def test_another_oil_does_not_compile_again():
    traces = []

    @eqx.filter_jit
    def viscosity(oil, T):
        traces.append(1)
        return oil.viscosity(T)

    for name in ("pao-vg-220", "fva-1", "75W90-A"):
        viscosity(lubricants.find(name).build(), jnp.asarray(330.0))
    assert len(traces) == 1


def test_gradient_of_viscosity_equals_finite_difference():
    oil = lubricants.find("pag-vg-320").build()
    step = 1e-3
    central = (oil.viscosity(330.0 + step) - oil.viscosity(330.0 - step)) / (2.0 * step)
    assert float(jax.grad(oil.viscosity)(330.0)) == pytest.approx(float(central), rel=1e-6)


def test_every_value_has_a_known_source_or_an_assumed_status():
    records = [*lubricants.catalogue().values(), *solids.catalogue().values()]
    data = [datum for record in records for datum in record.data().values()]
    assert len(data) > 200
    for datum in data:
        assert datum.source in {"", *citations.available()}
        assert datum.source or datum.status in {"assumed", "given"}


def test_unknown_oil_and_material_name_the_nearest():
    with pytest.raises(
        InputError, match=r'"pao-220" is not a lubricant .* did you mean pao-vg-220'
    ):
        lubricants.find("pao-220")
    with pytest.raises(InputError, match=r'"Stel" is not a material .* did you mean steel'):
        solids.find("Stel")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"nu_2": 100e-6},
            "fva-3.nu_1: must be above nu_2, since oils thin with heat; 95 mm2/s was given with 100 mm2/s",
        ),
        ({"nu_1": float("nan")}, "fva-3.nu_1: nan is not a positive number"),
        ({"density_15": -1.0}, "fva-3.density_15: -1.0 is not a positive number"),
        ({"density_slope": 10.0}, "fva-3.density_slope: makes the density negative at T_max"),
        ({"T_1": 400.0}, "fva-3.T_1: must be below T_2"),
        ({"nu_0": 50e-6}, "fva-3.nu_0: must be above nu_1, the viscosity at a higher temperature"),
        ({"colour": 1.0}, '"colour" is not a property of an oil'),
    ],
)
def test_impossible_oil_is_refused(values, message):
    with pytest.raises(InputError) as caught:
        lubricants.find("fva-3").with_values(**values)
    assert str(caught.value) == message


def test_composite_of_equal_flanks_is_root_two():
    flanks = Roughness.from_rq(0.5e-6)
    assert float(flanks.composite_rq) == pytest.approx(0.5e-6 * 2.0**0.5, rel=1e-15)


def test_rq_of_gaussian_heights():
    heights = np.random.default_rng(0).normal(size=1_000_000)
    ratio = heights.std() / np.abs(heights).mean()
    flanks = Roughness.from_ra(0.8e-6, 0.4e-6)
    assert float(flanks.rq_1) == pytest.approx(0.8e-6 * ratio, rel=3e-3)
    assert float(flanks.rq_1) == pytest.approx(0.8e-6 * 1.2533, rel=1e-4)
    assert float(flanks.mean_ra) == pytest.approx(0.6e-6, rel=1e-15)


def test_roughness_from_the_composite_gives_it_back():
    assert float(Roughness.from_composite_rq(1.1e-6).composite_rq) == pytest.approx(1.1e-6)


def test_composite_has_a_finite_gradient_where_both_flanks_are_smooth():
    slope = jax.grad(lambda rq: composite_rq(rq_1=rq, rq_2=rq))
    assert float(slope(0.0)) == 0.0
    assert float(slope(1e-6)) == pytest.approx(2.0**0.5)


def test_every_reference_can_be_cited():
    for key in citations.available():
        entry = citations.reference(key)
        assert entry.title in citations.citation_text(key)
        assert str(entry.year) in key
        assert citations.bibtex(key).count("{") == citations.bibtex(key).count("}")


def test_citation_of_an_article():
    assert citations.citation_text("xu_2007") == (
        "Xu, H., Kahraman, A., Anderson, N. E. and Maddock, D. G. (2007). Prediction of mechanical "
        "efficiency of parallel-axis gear pairs. Journal of Mechanical Design, 129(1), 58-68. "
        "doi:10.1115/1.2359478."
    )
    assert "@article{xu_2007," in citations.bibtex("xu_2007")
    assert "pages = {58--68}" in citations.bibtex("xu_2007")
    with pytest.raises(InputError, match="did you mean xu_2007"):
        citations.citation_text("xu2007")
