"""Films of line contacts: limits in closed form, converged references, balances, derivatives, statuses."""

import dataclasses

import numpy as np
import pytest
from line_contacts import MODULUS, SIMPLE, contact, of_moes
from scipy.signal import find_peaks
from sound import quick_first

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contact_registry import SUMMITS
from pitchpoint.lubrication.asperity_load import masjedi_khonsari_2012
from pitchpoint.lubrication.ehl.doubts import flooded_inlet
from pitchpoint.lubrication.ehl.line import LineContact, problem_of
from pitchpoint.lubrication.ehl.line_grid import grid
from pitchpoint.lubrication.ehl.newton import dry, step
from pitchpoint.lubrication.ehl.solve import line_films, solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.film_thickness import moes_1992
from pitchpoint.materials import lubricants
from pitchpoint.materials.fluid import Fluid

# ---- references and limits


def test_films_are_those_of_converged_references():
    """Richardson's extrapolation of grids of 551 and 1101 nodes, inlet of four half-widths."""
    case = contact(
        *map(np.array, ([0.3e9, 0.5e9, 1e9, 1e9], [0.1, 1.0, 0.1, 1.0], [0.1, 0.01, 0.01, 0.01]))
    )
    found = solve_lines(dataclasses.replace(case, inlet=4.0 * case.half_width), nodes=513)
    assert found.solved.all()
    np.testing.assert_allclose(
        found.film.central_film * 1e9, [164.67, 338.2, 55.25, 285.2], rtol=4e-3
    )
    np.testing.assert_allclose(
        found.film.minimum_film * 1e9, [135.55, 288.2, 48.64, 250.9], rtol=7e-3
    )
    np.testing.assert_allclose(found.film.rolling, [15.88, 37.27, 8.545, 44.83], rtol=2.5e-2)


@pytest.mark.whole
def test_incompressible_films_follow_moes():
    M, L = np.array([5.0, 10.0, 20.0, 50.0, 100.0, 200.0]), np.array([5.0, *5 * [10.0]])
    reference = np.array([4.126, 5.633, 5.262, 4.749, 4.367, 4.003])
    case = of_moes(M, L)
    found = solve_lines(case, nodes=513)
    law = moes_1992(
        line_load=case.line_load,
        entrainment=1.0,
        viscosity=0.04,
        pressure_viscosity=case.fluid.pressure_viscosity,
        radius=0.01,
        modulus=MODULUS,
    )
    assert found.solved.all()
    off = found.film.central_film / np.asarray(law) - 1.0
    assert (off > 0.0).all() and (off < 0.04).all()
    unit = 0.01 * np.sqrt(2.0 * 0.04 / (MODULUS * 0.01))
    # References have an inlet of four to six half-widths, which starves the first by 1 %.
    np.testing.assert_allclose(found.film.central_film / unit, reference, rtol=0.015)


@pytest.mark.whole
def test_rigid_bodies_with_a_thin_oil_have_the_film_of_martin():
    """h = 4.896 eta u R/w between rigid bodies with an oil that pressure does not thicken."""
    fluid = Fluid(viscosity=0.04, pressure_viscosity=1e-12, **SIMPLE)
    case = contact(line_load=1e4, modulus=1e16, speed=np.array([1.0, 3.0]), fluid=fluid)
    found = solve_lines(case)
    martin = 4.896 * 0.04 * np.array([1.0, 3.0]) * 0.01 / 1e4 * 0.01 / 0.01
    np.testing.assert_allclose(found.film.minimum_film, martin, rtol=5e-3)


@pytest.mark.whole
def test_soft_bodies_with_a_thin_oil_have_the_film_of_herrebrugh():
    """Central film 2.621 M^-0.2 in units of Moes, the elastic limit of isoviscous oil."""
    found = solve_lines(of_moes(np.array([20.0, 50.0]), 1e-3), nodes=257)
    unit = 0.01 * np.sqrt(2.0 * 0.04 / (MODULUS * 0.01))
    expected = 2.621 * np.array([20.0, 50.0]) ** -0.2
    np.testing.assert_allclose(found.film.central_film / unit, expected, rtol=0.045)


@pytest.mark.whole
def test_without_speed_and_roughness_pressure_is_that_of_hertz():
    case = contact(speed=0.0, texture=Rough(rq=1e-9, modulus=MODULUS))
    found = solve_lines(case, nodes=257)
    place = found.film.x / float(case.half_width)
    hertz = 1e9 * np.sqrt(np.clip(1.0 - place**2, 0.0, None))
    inside = np.abs(place) < 0.95
    assert found.film.asperity_share == pytest.approx(1.0, abs=1e-7)
    np.testing.assert_allclose(found.film.pressure[inside], hertz[inside], atol=1e6)


@pytest.mark.whole
def test_a_squeezed_film_is_that_between_rigid_bodies():
    """h = (3 pi sqrt(2) eta V R^1.5/w)^(2/3) of a cylinder that approaches a plane."""
    speed = np.array([1e-3, 1e-2])
    fluid = Fluid(viscosity=0.04, pressure_viscosity=1e-12, **SIMPLE)
    case = contact(line_load=1e4, modulus=1e15, speed=0.0, fluid=fluid, approach=speed)
    film = (3.0 * np.pi * np.sqrt(2.0) * 0.04 * speed * 0.01**1.5 / 1e4) ** (2.0 / 3.0)
    np.testing.assert_allclose(solve_lines(case).film.central_film, film, rtol=6e-3)


@pytest.mark.whole
def test_a_longer_inlet_changes_nothing_and_a_short_one_starves():
    case = contact([0.5e9, 1e9], [1.0, 1.0])
    full = solve_lines(case)
    long = solve_lines(dataclasses.replace(case, inlet=8.0 * case.half_width))
    short = solve_lines(dataclasses.replace(case, inlet=1.5 * case.half_width))
    np.testing.assert_allclose(long.film.central_film, full.film.central_film, rtol=5e-3)
    assert (short.film.central_film < 0.9 * full.film.central_film).all()
    assert {one.kind for one in (*full.warnings, *long.warnings)} <= {"grid"}
    (starved,) = (one for one in short.warnings if one.kind == "inlet")
    assert "starved" in starved and "1.5 half-widths" in starved


@pytest.mark.whole
@pytest.mark.parametrize("L", [5.0, 15.0])
def test_films_of_a_flooded_inlet_are_those_of_an_endless_one(L):
    case = of_moes(np.array([0.5, 1.0, 2.0, 5.0, 12.0, 40.0]), L)
    inlet = flooded_inlet(case)
    full = solve_lines(case)
    at, before = (
        solve_lines(dataclasses.replace(case, inlet=part * inlet * case.half_width))
        for part in (1.0, 0.5)
    )
    np.testing.assert_allclose(at.film.central_film, full.film.central_film, rtol=5e-3)
    assert np.mean(before.film.central_film / full.film.central_film) < 0.992
    assert not any("starved" in text for text in at.warnings)


@pytest.mark.whole
def test_films_converge_with_second_order():
    case = contact(*map(np.array, ([0.3e9, 0.8e9], [0.1, 0.5], [0.1, 0.01])))
    film, pump = (
        np.array([getattr(solve_lines(case, nodes=n).film, name) for n in (129, 257, 513)])
        for name in ("central_film", "rolling")
    )
    order = np.log2((film[0] - film[1]) / (film[1] - film[2]))
    assert (order > 1.7).all() and (order < 2.7).all()
    assert (np.abs(film[2] / film[1] - 1.0) < 2e-3).all()
    assert (np.abs(pump[2] / pump[1] - 1.0) < 1e-2).all()


# ---- balances


@pytest.mark.whole
def test_load_gap_and_energy_are_balanced():
    case = contact(np.array([0.4e9, 0.8e9]), np.array([0.5, 1.0]), slide=0.1)
    for texture in (None, Rough(rq=0.1e-6, modulus=MODULUS)):
        found = solve_lines(dataclasses.replace(case, texture=texture))
        assert (found.ended.load < 1e-10).all() and (found.ended.gap < 1e-10).all()
        speed = np.asarray(case.entrainment)
        np.testing.assert_allclose(
            found.film.pumping_power, 2.0 * speed * found.film.rolling, rtol=1e-8
        )
        power = found.film.traction_a * case.speed_a + found.film.traction_b * case.speed_b
        sheared = (found.film.shear_force + found.film.boundary_force) * (
            case.speed_b - case.speed_a
        )
        np.testing.assert_allclose(-power, sheared + found.film.pumping_power, rtol=1e-8)


@pytest.mark.whole
def test_the_flow_of_oil_is_the_same_through_every_face():
    case = contact(0.5e9)
    at = grid(129)
    problem = problem_of(case, at)
    film = solve_lines(case).film
    pressure, gap = film.pressure / problem.flow.pressure, film.gap / problem.flow.height
    mass, conductance = problem.flow.mass_and_conductance(pressure, gap, at)
    drawn = (2.0 * mass[2:] + 5.0 * mass[1:-1] - mass[:-2]) / 6.0
    flow = drawn - (conductance * np.diff(pressure))[1:]
    full = pressure[1:-1] > 1e-9
    np.testing.assert_allclose(flow[full], flow[full][0], rtol=1e-8)
    # Behind the film the same oil fills a part of the gap.
    carried = film.filled * film.film * problem.flow.density(pressure)
    end = film.filled < 1.0
    np.testing.assert_allclose(carried[end], carried[end][0], rtol=1e-12)


@pytest.mark.whole
def test_films_are_mirrored_when_surfaces_turn_round():
    one, other = (solve_lines(contact(0.6e9, sign * 1.0, slide=0.2)).film for sign in (1.0, -1.0))
    np.testing.assert_array_equal(one.pressure, other.pressure[::-1])
    np.testing.assert_array_equal(one.x, -other.x[::-1])
    assert one.minimum_place == -other.minimum_place
    assert one.rolling == -other.rolling and one.shear_force == -other.shear_force


def free_volume(pressure, ambient):
    """Viscosity of the gear oil at 80 degC, with the constants of the catalogue as the book writes them."""
    modulus = 7.232e9 * np.exp(-4.873e-3 * 353.15)
    volume = (1.0 - np.log1p(11.65 * pressure / modulus) / 11.65) * (1.0 + 7.187e-4 * 30.15)
    occupied, free = 0.6988 * (1.0 - 7.679e-4 * 30.15), 1.0 + 7.187e-4 * 30.15
    at_rest = occupied / (free - occupied)
    return ambient * np.exp(4.336 * (occupied / (volume - occupied) - at_rest))


@pytest.mark.whole
def test_traction_is_the_integral_of_the_printed_laws_over_the_film():
    """Doolittle, Tait and Carreau as the book writes them, at the pressure and gap of every node."""
    oil = lubricants.find("sae-80w-90").build()
    laws = {"viscosity_law": "doolittle_1951", "density_law": "tait_1888"}
    measured, usual = (
        Fluid.of(oil, 353.15, shear_law="carreau_1972", **chosen) for chosen in (laws, {})
    )
    given = np.array([0.5e9, 0.8e9, 1.1e9]), 3.0
    slide = np.array([0.02, 0.1, 0.3])
    films = solve_lines(contact(*given, slide=slide, fluid=measured))
    assert films.solved.all()
    film, other = films.film, solve_lines(contact(*given, slide=slide, fluid=usual)).film
    thinner = film.central_film / other.central_film
    assert (thinner > 0.9).all() and (thinner < 1.0).all()
    pressure, load = np.asarray(film.pressure), contact(*given).line_load
    drawn = free_volume(pressure, float(measured.viscosity)) * (slide * 3.0)[:, None] / film.film
    thinned = drawn * (1.0 + (drawn / 7e6) ** 2) ** ((0.45 - 1.0) / 2.0)
    stress = np.minimum(thinned, 2e6 + 0.08 * pressure) * film.filled
    expected = np.trapezoid(stress, film.x) / load
    assert np.asarray(film.friction) == pytest.approx(np.asarray(expected), rel=0.01)
    assert expected[0] < 0.1 * expected[-1]


def test_contacts_that_approach_leave_others_as_they_are():
    together = solve_lines(contact(0.6e9, approach=np.array([0.0, 1e-3, 0.0])), nodes=33)
    alone = solve_lines(contact(0.6e9), nodes=33)
    closing = solve_lines(contact(0.6e9, approach=1e-3), nodes=33)
    np.testing.assert_array_equal(together.film.pressure[[0, 2]], [alone.film.pressure] * 2)
    np.testing.assert_array_equal(together.film.pressure[1], closing.film.pressure)


def test_contacts_together_are_those_alone():
    pressure, speed = np.array([[0.4e9, 0.9e9, 0.7e9]]), np.array([[0.1], [2.0]])
    together = solve_lines(contact(pressure, speed))
    for i, j in ((0, 0), (1, 2)):
        alone = solve_lines(contact(pressure[0, j], speed[i, 0]))
        np.testing.assert_array_equal(together.film.pressure[i, j], alone.film.pressure)
        assert together.film.rolling[i, j] == alone.film.rolling


# ---- mixed lubrication


@pytest.mark.whole
def test_asperities_carry_less_of_the_load_the_faster_thicker_and_smoother_it_runs():
    share = lambda found: np.asarray(found.film.asperity_share)  # noqa: E731
    rough = Rough(rq=0.3e-6, modulus=MODULUS)
    speed = share(solve_lines(contact(0.5e9, np.geomspace(0.003, 3.0, 9), texture=rough)))
    oil = Fluid(viscosity=np.geomspace(0.005, 0.5, 9), pressure_viscosity=2e-8)
    thick = share(solve_lines(contact(0.5e9, 0.1, texture=rough, fluid=oil)))
    heights = Rough(rq=np.geomspace(0.02, 2.0, 9) * 1e-6, modulus=MODULUS)
    high = share(solve_lines(contact(0.5e9, 0.1, texture=heights)))
    assert (np.diff(speed) < 0.0).all() and speed[0] > 0.3 and speed[-1] < 0.01
    assert (np.diff(thick) < 0.0).all()
    assert (np.diff(high) > 0.0).all() and high[0] < 1e-4


def test_sets_of_summits_carry_as_they_say():
    """One follows a regression within 1.4, and textbooks have 4 to 24 times less than that."""
    # Smooth surfaces would have films of 0.02 to 0.7 of this Rq.
    speed, rq = np.geomspace(0.0045, 0.72, 6), 0.4e-6
    given = {
        "line_load": np.asarray(contact(1e9).line_load),
        "radius": 0.01,
        "modulus": MODULUS,
        "viscosity": 0.04,
        "pressure_viscosity": 2.2e-8,
    }
    smooth = moes_1992(**given, entrainment=speed) / rq
    assert smooth[0] == pytest.approx(0.02, rel=0.1) and smooth[-1] == pytest.approx(0.7, rel=0.1)
    law = masjedi_khonsari_2012(
        **given, entrainment=speed, roughness_rq=rq, hardness=0.03 * MODULUS
    )
    oil = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8)

    def share(one):
        constants = {"eta_beta_sigma": one.eta_beta_sigma, "sigma_over_beta": one.sigma_over_beta}
        rough = Rough(rq=rq, modulus=MODULUS, **constants)
        return solve_lines(
            contact(1e9, speed, texture=rough, fluid=oil), nodes=33
        ).film.asperity_share

    shares = {one.name: share(one) for one in SUMMITS.values()}
    follows = shares["masjedi_khonsari_2012"] / law
    less = law / shares["textbooks"]
    assert (follows > 1.0 / 1.4).all() and (follows < 1.4).all()
    assert (less > 4.0).all() and (less < 24.0).all()


@pytest.mark.whole
def test_ever_smoother_surfaces_become_smooth_ones():
    smooth = solve_lines(contact(0.5e9)).film
    rough = [
        solve_lines(contact(0.5e9, texture=Rough(rq=rq, modulus=MODULUS))).film
        for rq in (20e-9, 5e-9)
    ]
    off = [abs(film.central_film / smooth.central_film - 1.0) for film in rough]
    assert off[1] < off[0] < 1e-2 and off[1] < 1e-3


@pytest.mark.whole
def test_mean_planes_that_overlap_are_solved():
    soft = Rough(rq=0.8e-6, modulus=MODULUS)
    found = solve_lines(contact(1.2e9, 1e-3, texture=soft))
    assert found.solved and found.film.gap.min() < 0.0 < found.film.film.min()
    total = found.film.asperity_pressure + np.clip(found.film.pressure, 0.0, None)
    assert np.isfinite(total).all() and 0.05 < found.film.asperity_share < 1.0


# ---- stiffness, damping and what else follows


def slope(of, at):
    """Derivative by the logarithm of an argument, from differences of fourth order."""
    one, two = (of(at * (1.0 + k * 1e-3)) - of(at * (1.0 - k * 1e-3)) for k in (1, 2))
    return (8.0 * one - two) / 12e-3


@pytest.mark.parametrize("texture", quick_first([None, Rough(rq=0.3e-6, modulus=MODULUS)]))
def test_stiffness_is_that_of_contacts_with_more_load(texture):
    case = contact([0.3e9, 0.6e9, 1e9], [0.1, 1.0, -2.0], slide=0.1, texture=texture)
    film = solve_lines(case).film

    def mean(load):
        return solve_lines(dataclasses.replace(case, line_load=load)).film.mean_film

    differences = -case.line_load / slope(mean, case.line_load)
    np.testing.assert_allclose(film.stiffness, differences, rtol=1e-7)
    by_load = -case.line_load / (film.stiffness * film.mean_film)
    assert (by_load[1:] > -0.13).all() and (by_load[1:] < -0.1).all()


@pytest.mark.whole
def test_stiffness_comes_nearer_to_that_over_a_range_of_loads_with_more_nodes():
    """A spike passes nodes as the load grows, so that the stiffness of a film on a grid wavers."""
    part = np.linspace(0.94, 1.06, 9)
    case = contact(0.5e9)
    case = dataclasses.replace(case, line_load=case.line_load * part)
    fine = solve_lines(case, nodes=513).film
    smooth = -np.polyfit(np.log(part), np.log(fine.mean_film), 1)[0]
    off = [
        np.max(np.abs(case.line_load / (film.stiffness * film.mean_film) / smooth - 1.0))
        for film in (solve_lines(case).film, solve_lines(case, nodes=257).film)
    ]
    assert off[1] < 0.05 and off[0] < 0.09


@pytest.mark.whole
def test_damping_is_that_of_contacts_that_approach_faster():
    case = contact([0.3e9, 0.8e9], [0.1, 1.0], approach=np.array([2e-4, 1e-3]))
    film = solve_lines(case, nodes=33).film

    def mean(speed):
        return solve_lines(dataclasses.replace(case, approach=speed), nodes=33).film.mean_film

    differences = film.stiffness * slope(mean, case.approach) / case.approach
    np.testing.assert_allclose(film.damping, differences, rtol=1e-7)


@pytest.mark.whole
def test_stiffness_and_damping_between_rigid_bodies_are_known():
    """w = 4.9 eta u R/h drawn in, and 3 pi sqrt(2) eta V R^1.5/h^1.5 squeezed."""
    fluid = Fluid(viscosity=0.04, pressure_viscosity=1e-12, **SIMPLE)
    drawn = contact(line_load=1e4, modulus=1e16, speed=np.array([1.0, 3.0]), fluid=fluid)
    film = solve_lines(drawn).film
    np.testing.assert_allclose(film.stiffness * film.mean_film / 1e4, 1.0, rtol=3e-4)
    speed = np.array([1e-3, 1e-2])
    squeezed = contact(line_load=1e4, modulus=1e15, speed=0.0, fluid=fluid, approach=speed)
    film = solve_lines(squeezed).film
    np.testing.assert_allclose(film.stiffness * film.mean_film / 1e4, 1.5, rtol=1e-3)
    np.testing.assert_allclose(film.damping * speed / 1e4, 1.0, rtol=1e-3)


@pytest.mark.whole
def test_surfaces_that_stand_on_their_asperities_are_stiff_and_not_damped():
    rough = Rough(rq=0.4e-6, modulus=MODULUS)
    film = solve_lines(contact(0.6e9, texture=rough, speed_a=0.5, speed_b=-0.5)).film
    assert film.stiffness > 0.0 and np.isnan(film.damping)


@pytest.mark.whole
def test_the_spike_is_the_last_maximum_of_the_pressure():
    found = solve_lines(contact([0.6e9, 0.7e9], [1.0, -1.0]), nodes=257).film
    for k, sense in enumerate((1, -1)):
        x, pressure = sense * found.x[k][::sense], found.pressure[k][::sense]
        peaks, _ = find_peaks(pressure, prominence=1e-3 * pressure.max())
        last = peaks[-1]
        assert len(peaks) > 1
        assert abs(sense * found.spike_place[k] - x[last]) < x[last + 1] - x[last]
        assert 1.0 <= found.spike_pressure[k] / pressure[last] < 1.05
        assert 0.6 < sense * found.spike_place[k] / found.half_width[k] < 0.9


@pytest.mark.whole
def test_a_pressure_with_one_maximum_has_no_spike():
    """Soft bodies, and a light load that a spike far inside carries alone."""
    one = solve_lines(of_moes(np.array([20.0]), 1e-3), nodes=257).film
    other = solve_lines(contact([0.4e9]), nodes=257).film
    for film in (one, other):
        assert len(find_peaks(film.pressure[0], prominence=1e-3 * film.pressure.max())[0]) == 1
        assert np.isnan(film.spike_place).all() and np.isnan(film.spike_pressure).all()


def test_friction_is_the_shear_of_a_newtonian_oil_over_its_film():
    case = contact([0.3e9, 0.6e9], [0.1, 1.0], slide=0.01)
    film = solve_lines(case).film
    rate = np.abs(case.speed_b - case.speed_a)[:, None] / film.gap
    stress = film.filled * np.asarray(case.fluid.viscosity_at(film.pressure)) * rate
    drawn = np.trapezoid(stress, film.x, axis=-1)
    np.testing.assert_allclose(film.friction, drawn / case.line_load, rtol=1e-3)
    assert (film.film_ratio == np.inf).all()


@pytest.mark.whole
def test_oils_by_value_draw_as_oils_bear_unless_a_newtonian_one_is_asked_for():
    oil = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8}
    usual = solve_lines(contact(0.9e9, slide=0.2, fluid=Fluid(**oil)))
    newtonian = solve_lines(contact(0.9e9, slide=0.2))
    assert usual.film.friction < 0.1 < newtonian.film.friction
    assert {one.kind for one in usual.warnings} <= {"grid"}
    assert any("a Newtonian oil is sheared" in one for one in newtonian.warnings)
    np.testing.assert_allclose(usual.film.pressure, newtonian.film.pressure, rtol=1e-10)


# ---- derivatives


@pytest.mark.whole
@pytest.mark.parametrize("texture", [None, Rough(rq=0.2e-6, modulus=MODULUS)])
def test_the_matrix_is_that_of_differences(texture):
    """Balances of cells that are full: rows of the matrix times the scale of their defects."""
    at = grid(33)
    problem = problem_of(contact(0.6e9, texture=texture), at)

    def gain(given):
        pressure = jnp.zeros(33).at[1:-1].set(given[:-1])
        gap = problem.gap(pressure, given[-1], at)
        oil = pressure - problem.flow.asperity_pressure(gap)
        return problem.flow.balance(oil, gap, at)

    @jax.jit
    def compared():
        pressure, level = dry(problem, at)
        bump = 0.02 + 0.1 * jnp.exp(-((at.x[1:-1] + 0.5) ** 2))
        given = jnp.append(pressure[1:-1] + bump, level)
        balance, own = gain(given)
        scale = own + at.widths[1:-1]
        _, matrix = step(problem, jnp.zeros(33).at[1:-1].set(given[:-1]), level, at)
        moved = jax.vmap(lambda e: (gain(given + e)[0] - gain(given - e)[0]) / 2e-6)
        full = given[:-1] > -balance / scale
        return full, -moved(1e-6 * jnp.eye(32)).T / scale[:, None], matrix[:-1]

    full, differences, matrix = map(np.asarray, compared())
    largest = np.abs(matrix).max(axis=1, keepdims=True)
    assert full.sum() > 25
    np.testing.assert_allclose((differences / largest)[full], (matrix / largest)[full], atol=1e-6)


@pytest.mark.whole
def test_gradients_of_film_and_traction_are_those_of_differences():
    names = ("line_load", "speed", "viscosity", "radius", "rq", "alpha")

    def answers(logarithms, approach=0.0):
        line_load, speed, viscosity, radius, rq, alpha = jnp.exp(logarithms)
        fluid = Fluid(viscosity=viscosity, pressure_viscosity=alpha, shear_law="ree_eyring_1955")
        film = line_films(
            LineContact(
                line_load=line_load,
                radius=radius,
                modulus=MODULUS,
                speed_a=1.05 * speed,
                speed_b=0.95 * speed,
                approach=approach,
                fluid=fluid,
                texture=Rough(rq=rq, modulus=MODULUS),
            ),
            nodes=33,
        )
        forces = film.traction_a * 1e-3, film.asperity_share
        return jnp.stack([film.mean_film, *forces, film.stiffness, film.damping])

    at = jnp.log(jnp.array([2e5, 1.0, 0.04, 0.012, 0.2e-6, 2e-8]))
    compiled = jax.jit(answers)
    slopes = np.asarray(jax.jit(jax.jacfwd(answers))(at))
    for k in range(len(names)):
        e = 1e-4 * np.eye(len(names))[k]
        one, two = (compiled(at + n * e) - compiled(at - n * e) for n in (1.0, 2.0))
        difference = (8.0 * one - two) / 12e-4
        scale = np.abs(slopes).max(axis=1)
        np.testing.assert_allclose(slopes[:, k] / scale, difference / scale, atol=1e-6)
    film, _, _, stiffness, damping = compiled(at)
    # Surfaces that part: their film is that of a grid as long.
    one, two, three = (compiled(at, -k * 1e-5)[0] for k in (1.0, 2.0, 3.0))
    by_approach = (11.0 * film - 18.0 * one + 9.0 * two - 2.0 * three) / 6e-5
    np.testing.assert_allclose(damping, stiffness * by_approach, rtol=1e-6)


@pytest.mark.whole
def test_films_rise_with_the_speed_to_seven_tenths():
    film = solve_lines(contact(0.6e9, np.array([0.97, 1.03]))).film.central_film
    assert np.diff(np.log(film))[0] / np.log(1.03 / 0.97) == pytest.approx(0.7, abs=0.04)
