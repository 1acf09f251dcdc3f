"""Temperatures of films: strips in closed form, balances of heat and energy, limits, trends, statuses."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0
from sound import quick_first

from pitchpoint._jax import jax, jnp
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL, THERMAL
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import line_films, solve_lines
from pitchpoint.lubrication.ehl.strips import WARM_ENOUGH, Spread
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.flash_temperature import Conductor, moving_strip, peclet_number
from pitchpoint.lubrication.inlet_heating import murch_wilson_1975
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.fluid import Fluid

MODULUS = 2.26e11
STEEL = Conductor.of(solids.find("steel"))
OIL = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8, "viscosity_slope": 0.04}
SLIDES = np.array([0.0, 0.01, 0.05, 0.1, 0.3, 0.6, 1.0, 1.5, 2.5])


def conduction(a=STEEL, b=STEEL, oil=0.14):
    return Conduction(a=a, b=b, oil_conductivity=oil)


def contact(pressure=1e9, speed=5.0, slide=0.0, **others):
    """Steel on steel by Hertz's pressure, mean speed and slide-roll ratio, with an oil that thins."""
    pressure, speed, slide = map(np.asarray, (pressure, speed, slide))
    given = {
        "line_load": 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * 0.01,
        "radius": 0.01,
        "modulus": MODULUS,
        "speed_a": speed * (1.0 + slide / 2.0),
        "speed_b": speed * (1.0 - slide / 2.0),
        "fluid": Fluid(**OIL, shear_law="ree_eyring_1955"),
        "conduction": conduction(),
    }
    return LineContact(**(given | others))


@pytest.fixture(scope="module")
def sliding():
    """Smooth contacts from rolling to surfaces that run against each other."""
    case = contact(slide=SLIDES)
    return case, solve_lines(case, nodes=65)


@pytest.fixture(scope="module")
def rough():
    """The same with asperities that carry a part of the load."""
    case = contact(slide=SLIDES, speed=0.5, texture=Rough(rq=0.5e-6, modulus=MODULUS))
    return case, solve_lines(case, nodes=33)


# ---- the moving strip


def strip_by_cells(density, places, cells=2000):
    """Rise at places by heat of a density on -1 to 1, but for the factor of body and speed."""
    edges = np.linspace(-1.0, 1.0, cells + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    return np.asarray(moving_strip(np.asarray(places), edges)) @ density(middles)


def test_a_uniform_strip_is_that_in_closed_form():
    places = np.array([-1.5, -1.0, -0.3, 0.4, 1.0, 2.0, 30.0])
    found = strip_by_cells(np.ones_like, places, cells=7)
    passed = np.sqrt(np.maximum(places + 1.0, 0.0)) - np.sqrt(np.maximum(places - 1.0, 0.0))
    np.testing.assert_allclose(found, 2.0 * passed, rtol=1e-13, atol=1e-15)


def test_the_largest_temperature_by_hertzian_heat_is_known():
    """Of sqrt(1 - s^2) it is 2.18831 at 0.652, 1.5 % below that of as much heat spread evenly."""
    places = np.linspace(-1.0, 1.0, 2001)
    found = strip_by_cells(lambda s: np.sqrt(1.0 - s**2), places)
    assert np.max(found) == pytest.approx(2.1883067, rel=1e-4)
    assert places[np.argmax(found)] == pytest.approx(0.6522, abs=2e-3)
    as_quadrature, _ = quad(
        lambda t: 2.0 * np.sqrt(max(1.0 - (0.6522 - t * t) ** 2, 0.0)), 0.0, np.sqrt(1.6522)
    )
    assert np.max(found) == pytest.approx(as_quadrature, rel=1e-4)


@pytest.mark.parametrize(("peclet", "too_warm"), [(5.0, 0.0413), (10.0, 0.0240), (20.0, 0.0138)])
def test_a_slow_strip_is_as_much_too_warm_as_the_warning_says(peclet, too_warm):
    """Against heat that spreads in both directions, by Jaeger's integral of K0."""

    def rise(place):
        spreads = lambda s: np.exp(peclet * (place - s)) * k0(peclet * abs(place - s))  # noqa: E731
        return quad(spreads, -1.0, 1.0, points=[min(place, 1.0)], limit=200)[0]

    largest = max(map(rise, np.linspace(0.6, 1.0, 41)))
    strip = strip_by_cells(np.ones_like, [1.0])[0] * np.sqrt(np.pi / (2.0 * peclet))
    assert strip / largest - 1.0 == pytest.approx(too_warm, abs=5e-4)


def test_the_peclet_number_is_that_of_the_surface():
    found = peclet_number(speed=-2.0, half_width=1e-4, body=STEEL)
    assert float(found) == pytest.approx(2.0 * 1e-4 * 7830.0 * 465.0 / (2.0 * 46.0), rel=1e-12)


# ---- across the film


def across_by_differences(film, heat, a, b, conductivity, cells=400):
    """Temperatures across a film, and the heat into the surface at a, by finite differences."""
    step = film / cells
    matrix = np.diag(-2.0 * np.ones(cells - 1))
    matrix += np.diag(np.ones(cells - 2), 1) + np.diag(np.ones(cells - 2), -1)
    load = np.full(cells - 1, -heat / film * step**2 / conductivity)
    load[0], load[-1] = load[0] - a, load[-1] - b
    inside = np.concatenate(([a], np.linalg.solve(matrix, load), [b]))
    into_a = conductivity * (inside[1] - inside[0]) / step + 0.5 * heat * step / film
    return inside, into_a


def test_the_mean_film_is_that_of_heat_made_evenly_across_it():
    film, heat, conductivity = 0.4e-6, 3e9, 0.14
    cold = jnp.zeros((1, 1))
    found = Spread(cold, cold, jnp.array([conductivity / film]))
    inside, into_a = across_by_differences(film, heat, 0.0, 0.0, conductivity)
    simpson = (
        inside[0] + inside[-1] + 4.0 * inside[1::2].sum() + 2.0 * inside[2:-1:2].sum()
    ) / 1200
    assert float(found.within[0] * heat) == pytest.approx(simpson, rel=1e-10)
    assert float(found.to_a[0, 0] * heat) == pytest.approx(into_a, rel=1e-10)


def test_the_warmer_surface_takes_less_of_the_heat():
    """One cell: the temperatures of the surfaces and the heat into them agree with each other."""
    film, heat, conductivity = 0.4e-6, 3e9, 0.14
    a, b = jnp.array([[2e-9]]), jnp.array([[5e-8]])
    found = Spread(a, b, jnp.array([conductivity / film]))
    into_a = float(found.to_a[0, 0]) * heat
    at_a, at_b = float(a[0, 0]) * into_a, float(b[0, 0]) * (heat - into_a)
    _, expected = across_by_differences(film, heat, at_a, at_b, conductivity)
    assert at_b > at_a and into_a > 0.5 * heat
    assert into_a == pytest.approx(expected, rel=1e-9)
    assert float(found.mean[0, 0]) * heat == pytest.approx(0.5 * (at_a + at_b), rel=1e-12)


# ---- whole contacts


@pytest.mark.whole
@pytest.mark.parametrize("texture", quick_first(["sliding", "rough"]))
def test_all_heat_that_is_made_goes_into_the_surfaces(texture, request):
    case, found = request.getfixturevalue(texture)
    film, slip = found.film, np.asarray(case.speed_b - case.speed_a)
    assert found.solved.all()
    made = (film.shear_force + film.boundary_force) * slip + film.pumping_power
    np.testing.assert_allclose(film.heat.power_a + film.heat.power_b, made, rtol=1e-10)
    np.testing.assert_allclose(film.heat.flux_a + film.heat.flux_b, film.heat.heat, rtol=1e-9)


@pytest.mark.parametrize("texture", quick_first(["sliding", "rough"]))
def test_energy_dissipated_is_traction_by_sliding_and_rolling(texture, request):
    case, found = request.getfixturevalue(texture)
    film = found.film
    work = -(film.traction_a * case.speed_a + film.traction_b * case.speed_b)
    heat = film.heat.power_a + film.heat.power_b
    np.testing.assert_allclose(work + film.heat.expansion_power, heat, rtol=1e-8)
    assert (film.heat.expansion_power < 0.05 * heat).all()


def test_residuals_are_small_and_turns_are_told(sliding):
    _, found = sliding
    assert (found.ended.temperature < WARM_ENOUGH).all()
    assert (found.ended.reynolds < 1e-8).all() and (found.ended.load < 1e-10).all()
    assert (found.ended.turns >= 2).all() and (found.ended.turns < 30).all()


def test_surfaces_are_as_warm_as_their_heat_makes_them(sliding):
    """Summed up anew in SI along the motion of each surface; in the last contact one runs against the other.

    Heat is on lines between the nodes here and constant on cells there, 1.5 % of the largest rise apart.
    """
    case, found = sliding
    heat = found.film.heat
    ahead, behind = np.asarray(case.speed_a), np.asarray(case.speed_b)
    a, b = (heat.flux_a, heat.surface_a, ahead), (heat.flux_b, heat.surface_b, behind)
    steps = np.linspace(0.0, 1.0, 20_001)
    for k, (flux, rise, speed) in ((6, a), (6, b), (8, b)):
        x = found.film.x[k]
        # A root as variable takes the singular end out of the integral.
        passed = x - (x[0] if speed[k] > 0.0 else x[-1])
        values = np.interp(x[:, None] - passed[:, None] * steps**2, x, flux[k])
        along = np.trapezoid(2.0 * values, steps, axis=1) * np.sqrt(np.abs(passed))
        expected = along / np.sqrt(np.pi * abs(speed[k])) / float(STEEL.effusivity)
        np.testing.assert_allclose(rise[k], expected, rtol=0, atol=0.015 * np.max(expected))


@pytest.mark.whole
def test_traction_rises_with_sliding_and_falls_with_heat(sliding):
    case, found = sliding
    cold = solve_lines(dataclasses.replace(case, conduction=None), nodes=65)
    warm, drawn = (np.abs(one.film.shear_force[:-1]) for one in (found, cold))
    assert np.argmax(warm) in (2, 3) and (np.diff(warm[3:]) < 0.0).all()
    assert (np.diff(drawn) > 0.0).all()
    assert (warm[1:] < drawn[1:]).all()


@pytest.mark.whole
def test_without_sliding_there_is_little_heat_and_no_traction():
    warm = solve_lines(contact(speed=np.array([0.01, 0.1])), nodes=65).film
    cold = solve_lines(contact(speed=np.array([0.01, 0.1]), conduction=None), nodes=65).film
    assert (warm.shear_force == 0.0).all() and (warm.heat.largest_film < 0.1).all()
    np.testing.assert_allclose(warm.central_film, cold.central_film, rtol=1e-3)
    assert cold.heat is None


@pytest.mark.whole
def test_rolling_films_become_thinner_as_by_murch_and_wilson():
    """Within a tenth of the film, for thermal loadings of 0.05 to 1."""
    speed = np.array([2.0, 5.0, 9.0])
    warm = solve_lines(contact(speed=speed), nodes=65).film.central_film
    cold = solve_lines(contact(speed=speed, conduction=None), nodes=65).film.central_film
    loading = OIL["viscosity_slope"] * OIL["viscosity"] * speed**2 / 0.14
    np.testing.assert_allclose(warm / cold, murch_wilson_1975(thermal_loading=loading), rtol=0.1)


@pytest.mark.whole
def test_oil_that_conducts_well_makes_surfaces_and_film_alike():
    poor = Conductor(conductivity=0.26, heat_capacity=1.9e6)
    given = conduction(b=poor, oil=1e6)
    found = solve_lines(contact(slide=np.array([0.2, 0.8]), conduction=given), nodes=65)
    heat = found.film.heat
    np.testing.assert_allclose(heat.surface_a, heat.surface_b, atol=1e-4 * np.max(heat.film))
    np.testing.assert_allclose(heat.film, heat.surface_a, atol=1e-4 * np.max(heat.film))
    # Plastic takes little of the heat, steel most of it.
    assert (heat.power_a > 5.0 * heat.power_b).all()


@pytest.mark.whole
def test_temperatures_are_mirrored_when_surfaces_turn_round():
    ahead = solve_lines(contact(slide=np.array([0.5])), nodes=65).film
    back = solve_lines(contact(speed=-5.0, slide=np.array([0.5])), nodes=65).film
    for name in ("film", "surface_a", "surface_b", "flux_a"):
        one, other = (getattr(film.heat, name)[0] for film in (ahead, back))
        np.testing.assert_allclose(one, other[::-1], rtol=1e-6, atol=1e-6 * np.max(one))
    assert back.heat.power_a[0] == pytest.approx(ahead.heat.power_a[0], rel=1e-8)


@pytest.mark.whole
def test_contacts_together_are_those_alone(sliding):
    _, together = sliding
    alone = solve_lines(contact(slide=SLIDES[4:5]), nodes=65).film
    np.testing.assert_allclose(alone.heat.film[0], together.film.heat.film[4], rtol=1e-9)


@pytest.mark.whole
def test_asperities_warm_the_surfaces(rough):
    case, found = rough
    without = dataclasses.replace(
        case, texture=Rough(rq=0.5e-6, modulus=MODULUS, boundary_friction=0.0)
    )
    smooth = solve_lines(without, nodes=33).film.heat
    assert (found.film.asperity_share > 0.02).all()
    assert (found.film.heat.largest_a[1:] > smooth.largest_a[1:]).all()


@pytest.mark.whole
def test_what_has_no_temperature_says_so_and_shows_no_numbers():
    squeezed = contact(speed=0.0, approach=np.array([1e-3]))
    found = solve_lines(squeezed, nodes=33)
    assert found.ended.code[0] == Code.NO_STEADY_HEAT
    assert np.isnan(found.film.heat.film).all() and np.isnan(found.film.central_film[0])


def test_a_surface_that_stands_still_takes_no_heat_and_is_told(sliding):
    found = solve_lines(contact(slide=np.array([2.0])), nodes=65)
    heat = found.film.heat
    assert abs(heat.power_b[0]) < 1e-3 * heat.power_a[0]
    (told,) = (one for one in found.warnings if one.kind == "strips")
    assert "a surface passes a contact 0.354 mm wide at 0 m/s, a Peclet number of 0" in told
    assert not any(one.kind == "strips" for one in sliding[1].warnings)


def test_an_oil_that_does_not_thin_is_told_where_it_is_warm():
    dull = Fluid(**(OIL | {"viscosity_slope": 0.0}), shear_law="ree_eyring_1955")
    found = solve_lines(contact(slide=np.array([0.1]), fluid=dull), nodes=65)
    assert [one for one in found.warnings if one.kind != "grid"] == [
        "the temperature of the film is solved for with an oil that does not thin as it warms: its "
        "`viscosity_slope` is 0 1/K"
    ]


def test_profiles_can_be_left_out():
    heat = solve_lines(contact(slide=SLIDES), nodes=65, profiles=False).film.heat
    assert heat.film.shape == (9, 0) and heat.largest_film.shape == (9,)


@pytest.mark.whole
def test_gradients_of_warm_films_are_those_of_differences():
    """To load, speeds, viscosity, thinning, and what conducts the heat; asperities carry a part."""

    def answers(logarithms):
        load, speed, slide, viscosity, slope, steel, oil = jnp.exp(logarithms)
        fluid = Fluid(
            viscosity=viscosity,
            pressure_viscosity=2.2e-8,
            viscosity_slope=slope,
            shear_law="ree_eyring_1955",
        )
        body = Conductor(conductivity=steel, heat_capacity=3.64e6)
        film = line_films(
            LineContact(
                line_load=load,
                radius=0.01,
                modulus=MODULUS,
                speed_a=speed + slide,
                speed_b=speed - slide,
                fluid=fluid,
                texture=Rough(rq=0.3e-6, modulus=MODULUS),
                conduction=conduction(body, STEEL, oil),
            ),
            nodes=33,
        )
        forces = film.traction_a, film.friction, film.heat.largest_film, film.heat.power_a
        return jnp.stack([film.mean_film, film.asperity_share, *forces])

    at = jnp.log(jnp.array([3e5, 3.0, 0.6, 0.04, 0.04, 46.0, 0.14]))
    compiled = jax.jit(answers)
    slopes = np.asarray(jax.jit(jax.jacfwd(answers))(at))
    scale = np.abs(slopes).max(axis=1)
    for k in range(at.size):
        e = 1e-3 * np.eye(at.size)[k]
        one, two = (compiled(at + n * e) - compiled(at - n * e) for n in (1.0, 2.0))
        difference = np.asarray(8.0 * one - two) / 12e-3
        np.testing.assert_allclose(slopes[:, k] / scale, difference / scale, atol=1e-6)


@pytest.mark.whole
def test_films_that_can_be_differentiated_are_those_solved(sliding):
    case, found = sliding
    film = jax.jit(lambda one: line_films(one, nodes=65))(some(case, slice(2, 5)))
    np.testing.assert_allclose(film.central_film, found.film.central_film[2:5], rtol=1e-6)
    np.testing.assert_allclose(film.heat.film, found.film.heat.film[2:5], rtol=1e-5, atol=1e-5)


def some(case, which):
    every = np.shape(case.speed_a)
    return jax.tree.map(lambda leaf: np.broadcast_to(leaf, every)[which], case)


# ---- choices


def test_films_are_isothermal_unless_heat_is_asked_for():
    given = {
        "line_load": 1e5,
        "radius": 0.01,
        "modulus": MODULUS,
        "speed_a": 1.0,
        "speed_b": 0.9,
        "oil": lubricants.find("pao-vg-220").build(),
        "temperature": 353.15,
        "roughness_rq": 0.0,
    }
    assert FilmModel().contacts(**given).conduction is None
    warm = FilmModel(thermal="mean_film", members=(STEEL, STEEL)).contacts(**given)
    assert float(warm.conduction.oil_conductivity) == 0.14
    with pytest.raises(
        InputError, match=r'thermal = "mean_film" needs the conductivity and the heat'
    ):
        FilmModel(thermal="mean_film").contacts(**given)
    with pytest.raises(
        InputError, match="'mean_fim' is not a known thermal effect of a film; did you"
    ):
        FilmModel(thermal="mean_fim").contacts(**given)
    assert next(iter(THERMAL)) == ISOTHERMAL


def test_bad_input_is_one_sentence():
    with pytest.raises(
        InputError, match="the temperature of a surface of steel-210 needs its conduct"
    ):
        Conductor.of(solids.find("steel-210"))
    cold = Conductor(conductivity=0.0, heat_capacity=3.6e6)
    with pytest.raises(
        InputError, match="a conductivity of member 1 of 0 W/m/K: it must be positive"
    ):
        solve_lines(contact(conduction=conduction(b=cold)), nodes=33)
    with pytest.raises(InputError, match="a conductivity of the oil of -1 W/m/K"):
        solve_lines(contact(conduction=conduction(oil=-1.0)), nodes=33)
