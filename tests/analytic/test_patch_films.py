"""Films of contacts of finite length: against lines, regressions, conservation laws and each other."""

import re
from functools import cache
from math import exp, log
from typing import Any

import equinox as eqx
import jax
import numpy as np
import pytest
from scipy.constants import pi

from pitchpoint._jax import array, jnp
from pitchpoint.contact.dry_contact import dry_contact
from pitchpoint.contact.end_profiles import crowned
from pitchpoint.contact.gaps import elliptic_gap
from pitchpoint.contact.half_space import half_space
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.ehl_registry import COARSE
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.fields import PatchFilm, patch_film
from pitchpoint.lubrication.ehl.patch.grid_error import OPENS, REMAINS
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.layout import laid_out, problem_on
from pitchpoint.lubrication.ehl.patch.newton import jacobian_product, linearised
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, film_near, solve_patch
from pitchpoint.lubrication.ehl.patch.response import polished_patch
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.film_thickness import hamrock_dowson_1977_central
from pitchpoint.materials.fluid import Fluid

MODULUS = 2.26e11
ENDS = np.array([-1e-3, 1e-3])
OIL = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="newtonian")


def line(
    pressure: float = 1e9,
    speed: float = 1.0,
    radius: float = 0.01,
    slender: float = 20.0,
    crown: float = 5e-6,
    sliding: float = 0.2,
    **more: Any,
) -> PatchContact:
    """A crowned line of so many half-widths, with the pressure that it has without crown."""
    size = abs(radius)
    load = 2.0 * pi * (pressure / MODULUS) ** 2 * MODULUS * size
    length = slender * size * np.sqrt(8.0 * load / (pi * MODULUS * size))
    given = {"load": load * length, "length": length, "radius": radius, "modulus": MODULUS}
    given |= {"speed_a": speed * (1.0 - 0.5 * sliding), "speed_b": speed * (1.0 + 0.5 * sliding)}
    profile = crowned(width=length, radius=length**2 / (8.0 * crown)) if crown else ()
    return finite_line(**{"fluid": OIL, "profile": profile, **given, **more})


def ball(speed: tuple[float, float] = (2.0, 0.0), radius: float = 0.01, ratio: float = 1.0, **more):
    along, across = speed
    given = {"load": 30.0, "radius": radius, "transverse_radius": ratio * radius}
    given |= {"modulus": MODULUS, "fluid": OIL, "speed_a": 0.95 * along, "speed_b": 1.05 * along}
    return elliptic_contact(**{**given, "across": (0.95 * across, 1.05 * across), **more})


@cache
def crowned_line() -> PatchFilms:
    return coarse(line())


def coarse(contact: PatchContact) -> PatchFilms:
    found = solve_patch(contact, nodes=65, cells=64)
    assert found.solved, found.ended
    return found


@pytest.mark.whole
def test_the_middle_of_a_long_line_is_an_infinite_line():
    contact = line(slender=56.5, crown=5e-6, sliding=0.0)
    found = solve_patch(contact).film
    row = found.pressure.shape[0] // 2
    load = float(np.sum(found.pressure[row]) * (found.x[1] - found.x[0]))
    given = {"line_load": load, "radius": 0.01, "modulus": MODULUS, "fluid": OIL}
    infinite = solve_lines(LineContact(**given, speed_a=1.0, speed_b=1.0), nodes=257).film
    assert found.central_film == pytest.approx(float(infinite.central_film), rel=0.01)
    assert found.gap[row].min() == pytest.approx(float(infinite.minimum_film), rel=0.05)
    assert found.pressure[row].max() == pytest.approx(float(infinite.largest_pressure), rel=0.03)


@pytest.mark.whole
def test_a_slow_line_whose_crown_leaves_nearly_sharp_ends_is_solved_from_anywhere():
    """65 nodes do not show how so thin a film begins and ends; one of twice the speed leads to it too."""
    oil = Fluid(viscosity=0.025, pressure_viscosity=2e-8, shear_law="newtonian")
    given = {"radius": 0.046, "slender": 28.5, "crown": 9e-7, "sliding": 0.0, "fluid": oil}
    slow, faster = (line(0.52e9, speed, **given) for speed in (0.026, 0.052))
    found = coarse(slow)
    area = np.diff(found.layout.bodies(65, 64, 64, "half_space").edges) * found.layout.length
    spacing = found.film.x[1] - found.film.x[0]
    carried = float(area @ np.sum(found.film.pressure, axis=1)) * spacing
    assert carried == pytest.approx(float(slow.load), rel=1e-6)
    assert any("with bounds on what flows" in text for text in found.warnings)
    row = found.film.pressure.shape[0] // 2
    rolling = {
        "radius": 0.046,
        "modulus": MODULUS,
        "fluid": oil,
        "speed_a": 0.026,
        "speed_b": 0.026,
    }
    load = float(np.sum(found.film.pressure[row]) * spacing)
    infinite = solve_lines(LineContact(line_load=load, **rolling), nodes=257).film
    assert found.film.central_film == pytest.approx(float(infinite.central_film), rel=0.1)
    assert any("the grid is coarse" in told for told in found.warnings)
    other = solve_patch(slow, nodes=65, cells=64, start=coarse(faster))
    assert np.allclose(other.film.gap, found.film.gap, rtol=1e-6)


def test_a_ball_has_the_film_of_hamrock_and_dowson():
    found = coarse(ball())
    law = hamrock_dowson_1977_central(
        load=30.0,
        entrainment=2.0,
        viscosity=0.04,
        pressure_viscosity=2.2e-8,
        radius=0.01,
        transverse_radius=0.01,
        modulus=MODULUS,
    )
    assert found.film.central_film == pytest.approx(float(law), rel=0.05)


@pytest.mark.whole
def test_errors_by_the_grid_are_estimated_from_half_as_many_cells():
    fine, half = coarse(ball()), solve_patch(ball(), nodes=33, cells=32)
    films = [
        [getattr(one.film, name) for name in ("central_film", "mean_film", "minimum_film")]
        for one in (fine, half)
    ]
    central, mean, least = np.abs(np.diff(np.log(films), axis=0)[0])
    ridges = [[np.interp(0.0, one.film.x, row) for row in one.film.gap] for one in (fine, half)]
    of_rows = np.log(np.interp(half.film.y, fine.film.y, ridges[0]) / ridges[1])
    central = max(central, mean, np.sqrt(np.mean(of_rows[8:24] ** 2)))
    errors = np.expm1(REMAINS * [central, least])
    gap, row, node = fine.film.gap, *np.argwhere(fine.film.gap == fine.film.minimum_film)[0]
    along, across = gap[row, [node - 1, node + 1]], gap[[row - 1, row + 1], node]
    opening = max(along.mean(), across.mean()) / gap[row, node] - 1.0
    errors[1] = max(errors[1], OPENS * opening)
    assert (fine.ended.grid, fine.ended.grid_minimum) == pytest.approx(errors, rel=1e-3)
    assert fine.ended.grid_minimum > COARSE
    (told,) = (one for one in fine.warnings if one.kind == "grid")
    nodes, cells = map(
        int, re.findall(r"(\d+) nodes and (\d+) cells should bring that below 3 %", told)[0]
    )
    named = solve_patch(ball(), nodes=nodes, cells=cells)
    assert named.solved and not any(one.kind == "grid" for one in named.warnings)
    assert np.isnan([half.ended.grid, half.ended.grid_minimum]).all()
    assert any(one.kind == "unknown grid" for one in half.warnings)


@pytest.mark.whole
def test_a_constriction_between_cells_tells_an_error_that_half_as_many_cells_do_not():
    """Film to the sides of an ellipse, M 65: half as many cells change it 3-fold, twice as many 2.7-fold."""
    oil = Fluid(viscosity=0.0149, pressure_viscosity=2e-8)
    wide = ball((0.311, 0.0), 0.272, 11.2, load=21.2e3, fluid=oil)
    found, fine = coarse(wide), solve_patch(wide, nodes=129, cells=128)
    for name, error in ("central_film", "grid"), ("minimum_film", "grid_minimum"):
        off = abs(getattr(fine.film, name) / getattr(found.film, name) - 1.0)
        assert getattr(found.ended, error) / 3.0 < off < getattr(found.ended, error)
    assert fine.film.minimum_film > 2.0 * found.film.minimum_film


@pytest.mark.whole
@pytest.mark.parametrize(("crown", "sharp"), [(0.0, True), (5e-6, True), (4e-5, False)])
def test_a_smallest_film_at_a_sharp_end_is_told_to_be_a_number_of_the_grid(crown, sharp):
    """An arc of 5 um ends at .65 of Hertz's pressure; one of 40 um comes to nothing before the line ends."""
    found = coarse(line(crown=crown))
    assert any(one.kind == "sharp end" for one in found.warnings) == sharp
    end = 0.5 * float(line(crown=crown).length)
    near = end - abs(found.film.minimum_place[1]) < 0.2 * found.layout.half_width
    assert near == sharp


def moderate_ball(load: float, viscosity: float, ratio: float = 1.0) -> PatchContact:
    """A ball or barrel that rolls, by its load M and viscosity L, with Rx/Ry of `ratio`."""
    speed = (viscosity / (2.2e-8 * MODULUS)) ** 4
    own = 0.5 * speed * MODULUS * 0.01 / 0.04
    return elliptic_contact(
        load=load * speed**0.75 * MODULUS * 0.01**2,
        radius=0.01,
        transverse_radius=0.01 / ratio,
        modulus=MODULUS,
        speed_a=own,
        speed_b=own,
        fluid=OIL,
    )


def nijenbanning_1994(load: float, viscosity: float, ratio: float) -> float:
    """Central film over U^1/2 of Nijenbanning, Venner and Moes (1994), for Rx/Ry of `ratio`."""
    shape = 1.0 + 0.006 * log(ratio) + 0.63 * ratio ** (4 / 7)
    rigid = 145.0 * (1.0 + 0.796 * ratio ** (14 / 15)) ** (-15 / 7) / (ratio * load**2)
    elastic = 3.18 * shape ** (-14 / 25) * ratio ** (-1 / 15) * load ** (-2 / 15)
    rigid_stiffening = 1.29 * (1.0 + 0.691 * ratio) ** (-2 / 3) * viscosity ** (2 / 3)
    stiffening = (
        1.48 * shape ** (-7 / 20) * ratio ** (-1 / 24) * load ** (-1 / 12) * viscosity**0.75
    )
    unloaded = 1.8 / ratio
    s = 1.5 * (1.0 + exp(-1.2 * elastic / stiffening))
    constant = rigid**1.5 + (elastic**-4 + unloaded**-4) ** (-3 / 8)
    return (constant ** (2 * s / 3) + (rigid_stiffening**-8 + stiffening**-8) ** (-s / 8)) ** (
        1 / s
    )


@pytest.mark.whole
@pytest.mark.parametrize(
    ("load", "viscosity", "ratio"),
    [(20.0, 10.0, 1.0), (100.0, 10.0, 1.0), (100.0, 5.0, 1.0), (30.0, 8.0, 0.2), (30.0, 8.0, 3.0)],
)
def test_ellipses_have_the_film_of_nijenbanning_venner_and_moes(load, viscosity, ratio):
    """By their load M and viscosity L; with an oil that cannot be compressed films are 10 to 20 % thicker."""
    found = coarse(moderate_ball(load, viscosity, ratio))
    speed = (viscosity / (2.2e-8 * MODULUS)) ** 4  # U of the sum of both speeds
    film = float(found.film.central_film) / (0.01 * speed**0.5)
    assert film == pytest.approx(nijenbanning_1994(load, viscosity, ratio), rel=0.08)


@pytest.mark.whole
def test_the_thinnest_film_converges_with_more_than_second_order():
    """Film of a ball on grids that halve; the film in the middle follows with the second order from 65 on."""
    contact = moderate_ball(20.0, 5.0)
    films = [
        solve_patch(contact, nodes=nodes, cells=nodes - 1).film.minimum_film
        for nodes in (33, 65, 129)
    ]
    coarse_change, fine_change = abs(np.diff(films))
    assert np.log2(coarse_change / fine_change) > 2.0


def test_load_and_energy_are_in_balance():
    contact = line()
    film = crowned_line().film
    widths = np.diff(np.asarray(film.x))[0]
    assert crowned_line().ended.load < 1e-9
    powers = [2.0 * film.rolling[0] * 1.0, film.pumping_power]
    assert powers[0] == pytest.approx(powers[1], rel=1e-8)
    assert film.shear_force[0] > 0.0
    sheared = np.sum(film.shear_x * _widths(film)[:, None]) * widths
    assert film.shear_force[0] == pytest.approx(sheared, rel=1e-6)
    assert np.sum(film.pressure * _widths(film)[:, None]) * widths == pytest.approx(
        float(contact.load), rel=1e-6
    )


def _widths(film: PatchFilm) -> np.ndarray:
    """Widths of the rows, from their middles and the end of the line."""
    edge, widths = -0.5 * float(line().length), []
    for middle in np.asarray(film.y):
        widths.append(2.0 * (middle - edge))
        edge += widths[-1]
    return np.array(widths)


@pytest.mark.whole
def test_thinner_and_thinner_films_end_in_the_dry_contact():
    apart = [_from_dry(coarse(ball((speed, 0.0))).film) for speed in (2.0, 0.3, 0.06)]
    assert apart[1] < 0.5 * apart[0]
    assert apart[2] < 0.5 * apart[1]
    assert apart[2] < 0.05


def _from_dry(film: PatchFilm) -> float:
    """Pressure that is not where it is in a dry contact, over the load."""
    bodies = half_space(np.asarray(film.x), _edges(np.asarray(film.y)))
    dry = dry_contact(bodies, np.asarray(elliptic_gap(bodies, 0.01, 0.01)), MODULUS, load=30.0)
    off = np.abs(np.asarray(film.pressure) - np.asarray(dry.pressure))
    return float(bodies.load(off)) / 30.0


def _edges(middles: np.ndarray) -> np.ndarray:
    half = 0.5 * (middles[1] - middles[0])
    return np.append(middles - half, middles[-1] + half)


@pytest.mark.whole
def test_entrainment_along_the_other_axis_turns_the_film():
    along, across = (
        coarse(ball((2.0, 0.0), ratio=3.0)),
        coarse(ball((0.0, 2.0), radius=0.03, ratio=1.0 / 3.0)),
    )
    assert np.allclose(along.film.gap, across.film.gap.T, rtol=1e-9)
    assert np.allclose(along.film.x, across.film.y)
    assert along.film.rolling[0] == pytest.approx(across.film.rolling[1])
    assert along.film.shear_force[0] == pytest.approx(across.film.shear_force[1])


@pytest.mark.whole
def test_reversed_entrainment_mirrors_the_film():
    ahead, back = coarse(ball((2.0, 0.0))).film, coarse(ball((-2.0, 0.0))).film
    assert np.allclose(ahead.gap, back.gap[:, ::-1], rtol=1e-9)
    assert np.allclose(ahead.x, -back.x[::-1])
    assert ahead.rolling[0] == pytest.approx(-back.rolling[0])
    assert ahead.shear_force[0] == pytest.approx(-back.shear_force[0])


@pytest.mark.whole
def test_oblique_entrainment_of_a_ball_turns_its_film():
    straight = coarse(ball((2.0, 0.0))).film
    speed = 2.0 * np.cos(0.6), 2.0 * np.sin(0.6)
    oblique = coarse(ball(speed)).film
    # Across this grid oil is carried on other cells than along it: .3 % apart on 129 x 128.
    assert oblique.central_film == pytest.approx(float(straight.central_film), rel=0.035)
    assert np.arctan2(*oblique.shear_force[::-1]) == pytest.approx(0.6, abs=1e-6)
    assert np.hypot(*oblique.rolling) == pytest.approx(float(straight.rolling[0]), rel=0.1)


@pytest.mark.whole
def test_asperities_carry_more_the_slower_the_surfaces_are():
    rough = Rough(rq=0.3e-6, modulus=MODULUS)
    films = [coarse(line(speed=speed, texture=rough)).film for speed in (3.0, 0.3, 0.03)]
    shares = [float(film.asperity_share) for film in films]
    assert shares[0] < shares[1] < shares[2]
    waves = np.linspace(-1.0, 1.0, 41) * 1e-3
    heights = 3e-7 * np.cos(np.pi * waves / 1e-4) * np.ones((2, 1))
    wavy = HeightMap(x=waves, y=np.array([-1.0, 1.0]), heights=heights)
    films.append(coarse(line(speed=3.0, texture=rough, heights=wavy)).film)
    assert films[-1].asperity_share > shares[0]
    for film in films:
        traction = np.sum(film.traction_x * _widths(film)[:, None]) * np.diff(film.x)[0]
        force = film.shear_force[0] + film.boundary_force[0]
        assert traction == pytest.approx(float(force), rel=1e-10)
        rubbed = film.boundary_force[0] / (0.1 * float(line().load))
        assert rubbed == pytest.approx(float(film.asperity_share), rel=1e-9)


@pytest.mark.whole
def test_derivatives_of_the_balances_are_those_of_differences():
    contact = line(texture=Rough(rq=0.3e-6, modulus=MODULUS))
    found = coarse(contact)
    problem = problem_on(contact, found.layout, 65, 64, 64)
    random = np.random.default_rng(3)
    # Where no cell changes between full and empty, and no pressure of the oil between the signs.
    pressure = array(found.pressure * (1.0 + 0.01 * random.random(found.pressure.shape)))
    level, change = array(found.level * 1.01), random.standard_normal(63 * 64 + 1) * 1e-3
    field = np.pad(change[:-1].reshape(64, 63), ((0, 0), (1, 1))) * (found.pressure > 0.05)
    change[:-1] = field[:, 1:-1].ravel()

    def rest(step: float) -> np.ndarray:
        at = jax.jit(linearised)(
            problem, pressure + step * field, level + step * change[-1], array(0.0)
        )
        return np.append(np.asarray(at.rest), at.load), np.asarray(at.full), np.asarray(at.scale)

    at = jax.jit(linearised)(problem, pressure, level, array(0.0))
    exact = np.asarray(jacobian_product(at, array(change)))
    step = 1e-5
    (more, full, scale), (less, other, scaled) = rest(step), rest(-step)
    kept = np.append((full == other).ravel(), True)
    weights = [np.append(np.where(full, one, 1.0).ravel(), 1.0) for one in (scale, scaled)]
    middle = np.append(np.where(full, np.asarray(at.scale), 1.0).ravel(), 1.0)
    # The scale is no part of the derivatives.
    differences = (more * weights[0] - less * weights[1]) / (2.0 * step * middle)
    assert np.max(np.abs(differences - exact)[kept]) < 1e-5 * np.max(np.abs(exact))


def changed(by: Any) -> PatchContact:
    """A crowned line with waves and with another load, speed, viscosity, crown and height of the waves, by
    parts of these."""
    where = lambda one: (  # noqa: E731
        one.load,
        one.speed_a,
        one.speed_b,
        one.fluid.viscosity,
        one.profile[0].amount,
        one.heights[0].heights,
    )
    factors = [1.0 + by[k] for k in (0, 1, 1, 2, 3, 4)]
    values = tuple(f * one for f, one in zip(factors, where(wavy_line()), strict=True))
    return eqx.tree_at(where, wavy_line(), values)


def wavy_line() -> PatchContact:
    places = np.linspace(-1e-3, 1e-3, 101)
    heights = 2e-8 * np.cos(np.pi * places / 1e-4) * np.ones((2, 1))
    return line(heights=HeightMap(x=places, y=np.array([-1.0, 1.0]), heights=heights))


def figures(film: Any) -> Any:
    return jnp.stack([film.mean_film, film.minimum_film, film.shear_force[0], film.rolling[0]])


POLISHED = jax.jit(polished_patch)


def solved_again(found: PatchFilms, by: np.ndarray) -> np.ndarray:
    """Figures of a contact nearby on the same grid, by steps from the solution until they stay."""
    contact, (rows, nodes) = changed(by), found.pressure.shape
    problem = problem_on(contact, found.layout, nodes, rows, rows)
    solution = array(found.pressure), array(found.level)
    for _ in range(4):
        solution = POLISHED(problem, *solution)
    film = FILM(
        contact, jax.tree.map(array, found.layout), problem, *solution, found.held, found.response
    )
    return np.asarray(figures(film))


FILM = jax.jit(patch_film)


@pytest.mark.whole
def test_derivatives_of_films_are_those_of_differences():
    found = coarse(wavy_line())
    exact = jax.jit(jax.jacfwd(lambda by: figures(film_near(changed(by), found))))(jnp.zeros(5))
    step = 1e-4 * np.eye(5)
    ends = [[solved_again(found, sign * one) for one in step] for sign in (1.0, -1.0)]
    differences = (np.array(ends[0]) - np.array(ends[1])).T / 2e-4
    assert np.allclose(
        exact, differences, rtol=1e-5, atol=1e-6 * np.abs(differences).max(axis=1)[:, None]
    )


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ({"load": 0.0}, "a load of 0 N"),
        ({"load": float("nan")}, "a load of nan N"),
        ({"radius": -0.01}, "a relative radius of curvature of -0.01 m"),
        ({"length": 0.0}, "a length of the contact line of 0 m"),
        ({"fluid": Fluid(viscosity=0.0, pressure_viscosity=2e-8)}, "a viscosity of 0 Pa s"),
        ({"speed_a": np.array([-5.0, 3.0]), "places": ENDS}, "draw oil in from one side at some"),
        ({"speed_a": np.ones(3), "places": ENDS}, "speed a has the shape"),
        ({"relief": np.zeros(2), "places": ENDS[::-1]}, "places along the line have to rise"),
        ({"texture": Rough(rq=1e-7, modulus=MODULUS, pattern=3.0)}, "a pattern of roughness of 3"),
    ],
)
def test_nonsense_is_refused_in_one_sentence(more: dict[str, Any], told: str):
    with pytest.raises(InputError, match=told):
        solve_patch(line(**more))


def test_grids_that_there_are_not_are_refused():
    with pytest.raises(InputError, match="100 nodes: their number is a power of two"):
        solve_patch(line(), nodes=100)
    with pytest.raises(InputError, match="48 cells"):
        solve_patch(line(), cells=48)


@pytest.mark.whole
def test_smooth_surfaces_that_stand_still_have_no_film():
    found = solve_patch(line(speed=0.0), nodes=65, cells=64)
    assert found.ended.code == Code.NO_FILM
    assert np.isnan(found.film.central_film)
    assert "no film" in found.warnings[0]


@pytest.mark.whole
def test_a_line_that_leans_is_the_mirror_of_one_that_leans_the_other_way():
    leans = line(places=ENDS, relief=np.array([0.0, 2e-6]), crown=0.0)
    other = line(places=ENDS, relief=np.array([2e-6, 0.0]), crown=0.0)
    layout, mirrored = laid_out(leans, 64), laid_out(other, 64)
    assert layout.first == pytest.approx(-mirrored.last)
    one, two = (coarse(each).film for each in (leans, other))
    assert np.allclose(one.pressure, two.pressure[::-1], atol=1e-6 * one.hertz_pressure)
    assert one.near_ends[0, 1] == pytest.approx(two.near_ends[1, 1], rel=1e-6)


@pytest.mark.whole
@pytest.mark.parametrize("turn", [(1, -1), (-1, 1), (-1, -1)])
@pytest.mark.parametrize("swapped", [False, True])
def test_turned_ellipses_have_turned_films(turn: tuple[int, int], swapped: bool):
    given = {"speed_a": 1.0, "speed_b": 1.4, "across": (0.5, 0.3)}
    film = solve_patch(ball(ratio=2.0, **given), nodes=33, cells=32).film
    along, across = ((turn[0] * 1.0, turn[0] * 1.4), (turn[1] * 0.5, turn[1] * 0.3))
    if swapped:
        along, across = across, along
    axes = {"radius": 0.02, "ratio": 0.5} if swapped else {"ratio": 2.0}
    speeds = {"speed_a": along[0], "speed_b": along[1], "across": across}
    other = solve_patch(ball(**axes, **speeds), nodes=33, cells=32).film
    order = [1, 0] if swapped else [0, 1]
    back = lambda field: (field.T if swapped else field)[:: turn[1], :: turn[0]]  # noqa: E731
    assert np.allclose(back(other.gap), film.gap, rtol=1e-9)
    shears = np.stack([other.shear_x, other.shear_y])[order]
    assert np.allclose(turn[0] * back(shears[0]), film.shear_x, atol=1e-6 * 1e6)
    assert np.allclose(turn[1] * back(shears[1]), film.shear_y, atol=1e-6 * 1e6)
    for name in ("minimum_place", "shear_force", "rolling"):
        turned = np.asarray(getattr(other, name))[order] * turn
        assert np.allclose(turned, getattr(film, name), rtol=1e-6), name


@pytest.mark.whole
def test_free_ends_take_pressure_from_the_ends():
    flush = [coarse(line(crown=0.0, ends=ends)).film for ends in ("half_space", "mirrored")]
    assert np.all(flush[1].near_ends[:, 0] < 0.8 * flush[0].near_ends[:, 0])


@pytest.mark.whole
def test_a_middle_that_does_not_touch_has_no_film():
    lifted = line(places=ENDS, relief=np.array([0.0, 40e-6]), crown=0.0, slender=40.0, speed=3.0)
    lifted = eqx.tree_at(lambda one: one.load, lifted, 0.05 * lifted.load)
    film = coarse(lifted).film
    assert film.y[-1] < 0.0
    assert np.isnan(film.central_film)


@cache
def wide_contact(load: float = 1.0, approach: float = 0.0) -> PatchFilms:
    """A light contact of rough flanks that nearly fit, such as those in the zone of a strain wave gear."""
    given = {"load": 940.0 * load, "length": 0.012, "radius": 1.5, "modulus": MODULUS, "fluid": OIL}
    texture = Rough(rq=0.5e-6, modulus=MODULUS)
    contact = finite_line(**given, speed_a=0.3, speed_b=0.3, texture=texture, approach=approach)
    return coarse(contact)


@pytest.mark.whole
def test_stiffness_and_damping_are_those_of_contacts_that_are_solved_again():
    film = wide_contact().film
    less, more = (wide_contact(load=part).film.separation for part in (0.98, 1.02))
    assert float(film.stiffness) == pytest.approx(0.04 * 940.0 / float(less - more), rel=0.01)
    leaving, closing = (wide_contact(approach=v).film.separation for v in (-2e-6, 2e-6))
    by_approach = float(closing - leaving) / 4e-6
    assert float(film.damping) == pytest.approx(float(film.stiffness) * by_approach, rel=1e-3)


@pytest.mark.whole
def test_shear_below_a_crowned_line_is_between_those_of_lines_and_balls():
    found, depth = crowned_line(), np.linspace(0.5, 1.1, 13) * float(crowned_line().film.half_width)
    shear = np.asarray(found.stresses(depth, 0.3).largest_shear())
    most = np.unravel_index(np.argmax(shear), shear.shape)
    assert 0.295 < shear[most] / float(found.film.largest_pressure) < 0.32
    assert depth[most[0]] == pytest.approx(0.786 * float(found.film.half_width), rel=0.08)


@pytest.mark.whole
def test_oil_that_begins_nearby_starves_a_patch_as_it_starves_a_line():
    inlet = 1.6 * float(crowned_line().film.half_width)
    starved = solve_patch(line(inlet=inlet), nodes=129, cells=64)
    film = starved.film
    row = film.pressure.shape[0] // 2
    load = float(np.sum(film.pressure[row]) * (film.x[1] - film.x[0]))
    given = {"line_load": load, "radius": 0.01, "modulus": MODULUS, "fluid": OIL}
    alone, flooded = (
        solve_lines(LineContact(**given, speed_a=1.0, speed_b=1.0, **more), nodes=257).film
        for more in ({"inlet": inlet}, {})
    )
    assert float(alone.central_film) < 0.95 * float(flooded.central_film)
    assert float(film.central_film) == pytest.approx(float(alone.central_film), rel=0.02)
    assert any("the contact is starved" in told for told in starved.warnings)
    assert not any("starved" in told for told in crowned_line().warnings)


@pytest.mark.whole
def test_a_patch_begins_no_nearer_than_its_grid():
    found = coarse(line(inlet=1e-5))
    assert -found.layout.inlet == pytest.approx(1.5 * found.layout.length)
    assert any("at the nearest" in told for told in found.warnings)
