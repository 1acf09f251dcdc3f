"""Height maps in finite contacts: what cells see of them, and what they do to films."""

from typing import Any

import numpy as np
import pytest

from pitchpoint._jax import array, jax
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.layout import laid_out
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, solve_patch
from pitchpoint.lubrication.ehl.patch.solve import solve
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.materials.fluid import Fluid

MODULUS = 2.26e11
OIL = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="newtonian")
ENDS = np.array([-1e-3, 1e-3])
MEANS = jax.jit(HeightMap.over)


def ball(**more: Any) -> PatchContact:
    given = {"load": 30.0, "radius": 0.01, "transverse_radius": 0.02, "modulus": MODULUS}
    speeds = {"speed_a": 1.9, "speed_b": 2.1, "across": (0.3, 0.5)}
    return elliptic_contact(**{**given, **speeds, "fluid": OIL, **more})


def wave(length: float = 1.6e-4, high: float = 5e-8, **more: Any) -> HeightMap:
    """Waves along x that change a little along y, and no images of themselves."""
    x, y = np.linspace(-1e-3, 1e-3, 401), np.linspace(-1e-3, 1e-3, 41)
    form = np.cos(2.0 * np.pi * x / length + 0.4) * (1.0 + 200.0 * y[:, None])
    return HeightMap(**{"x": x, "y": y, "heights": high * form, **more})


def solved(contact: PatchContact) -> PatchFilms:
    found = solve_patch(contact, nodes=33, cells=32)
    assert found.solved, found.ended
    return found


def test_cells_take_the_mean_over_their_area():
    random = np.random.default_rng(1)
    x, y = np.sort(random.random(9)), np.sort(random.random(7))
    one = HeightMap(x=x, y=y, heights=random.standard_normal((7, 9)))
    edges = np.linspace(-0.3, 1.4, 6), np.linspace(-0.2, 1.3, 5)
    fine = [np.linspace(at[0], at[-1], 800 * (at.size - 1) + 1) for at in edges]
    middles = [0.5 * (at[1:] + at[:-1]) for at in fine]
    rows = np.stack([np.interp(middles[0], x, row) for row in np.asarray(one.heights)])
    points = np.stack([np.interp(middles[1], y, column) for column in rows.T], axis=1)
    means = points.reshape(4, 800, 5, 800).mean(axis=(1, 3))
    assert np.allclose(MEANS(one, *map(array, edges)), means, atol=1e-4)


def test_a_periodic_map_is_the_same_as_many_beside_each_other():
    random = np.random.default_rng(2)
    cell = random.standard_normal((4, 5))
    once = np.pad(cell, ((0, 1), (0, 1)), mode="wrap")
    many = np.pad(np.tile(cell, (5, 5)), ((0, 1), (0, 1)), mode="wrap")
    repeats = HeightMap(x=np.arange(6.0), y=np.arange(5.0), heights=once, periodic=True)
    tiled = HeightMap(x=np.arange(26.0) - 10.0, y=np.arange(21.0) - 8.0, heights=many)
    edges = array(np.linspace(-7.3, 11.9, 12)), array(np.linspace(-6.1, 9.7, 8))
    assert np.allclose(MEANS(repeats, *edges), MEANS(tiled, *edges), atol=1e-12)


def test_a_map_of_a_parabola_is_another_radius():
    slim, x = ball(radius=0.008, across=(0.0, 0.0)), laid_out(ball(), 32)
    layout = laid_out(slim, 32)
    x = np.linspace(layout.inlet, layout.outlet, 65)
    step = 2.0 * (x[1] - x[0])
    x = np.concatenate(([x[0] - 0.5 * step], x, [x[-1] + 0.5 * step]))
    curved = -(x**2) * (1.0 / 0.016 - 1.0 / 0.02) * np.ones((2, 1))
    flat = ball(across=(0.0, 0.0), heights=HeightMap(x=x, y=ENDS, heights=curved))
    one, two = (solve(contact, 33, 32, None, layout)[2] for contact in (slim, flat))
    assert np.allclose(one.pressure, two.pressure, atol=1e-6)


@pytest.mark.whole
@pytest.mark.parametrize("turn", [(-1, 1), (1, -1)])
@pytest.mark.parametrize("swapped", [False, True])
def test_turned_contacts_with_turned_maps_have_turned_films(turn: tuple[int, int], swapped: bool):
    film = solved(ball(heights=wave())).film
    speeds = [(turn[0] * 1.9, turn[0] * 2.1), (turn[1] * 0.3, turn[1] * 0.5)]
    heights = wave().turned(False, turn[0] < 0, turn[1] < 0)
    axes = {"radius": 0.01, "transverse_radius": 0.02}
    if swapped:
        speeds, heights = speeds[::-1], heights.turned(True, False, False)
        axes = {"radius": 0.02, "transverse_radius": 0.01}
    given = {"speed_a": speeds[0][0], "speed_b": speeds[0][1], "across": speeds[1]}
    other = solved(ball(heights=heights, **axes, **given)).film
    gap = other.gap.T if swapped else other.gap
    assert np.allclose(gap[:: turn[1], :: turn[0]], film.gap, rtol=1e-9)


@pytest.mark.whole
def test_pressure_stands_on_waves_and_flattens_them():
    smooth, wavy = (solved(ball(heights=maps)).film for maps in ((), wave()))
    inside = smooth.pressure > 0.4 * smooth.hertz_pressure
    high = 5e-8 * np.cos(2.0 * np.pi * wavy.x / 1.6e-4 + 0.4) * (1.0 + 200.0 * wavy.y[:, None])
    pressed, opened = ((getattr(wavy, k) - getattr(smooth, k))[inside] for k in ("pressure", "gap"))
    assert np.corrcoef(pressed, high[inside])[0, 1] > 0.8
    assert np.std(opened) < 0.6 * np.std(high[inside])
    assert np.allclose(wavy.heights[:, 1:-1], high[:, 1:-1], atol=0.3 * 5e-8)
    assert np.all(np.abs(smooth.heights) < 1e-15)
    outside = (smooth.pressure == 0.0) & (np.abs(wavy.x) > 2.0 * wavy.half_width)
    assert np.corrcoef((wavy.gap - smooth.gap)[outside], -high[outside])[0, 1] > 0.95


@pytest.mark.whole
def test_a_film_may_take_a_map_of_each_surface():
    x = np.linspace(-1e-3, 1e-3, 11)
    halves = tuple(wave(high=2.5e-8, member=None) for _ in range(2))
    one, two = solved(ball(heights=wave())).film, solved(ball(heights=halves)).film
    assert np.allclose(one.gap, two.gap, rtol=1e-9)
    level = HeightMap(x=x, y=ENDS, heights=np.full((2, 11), 3e-6))
    assert np.allclose(
        solved(ball(heights=level)).film.pressure, solved(ball()).film.pressure, atol=1.0
    )


@pytest.mark.whole
def test_waves_that_a_grid_does_not_show_are_told():
    told = solved(ball(heights=wave(length=3e-5))).warnings
    assert any("waves shorter than about four cells are lost" in one for one in told)
    assert not any("lost" in one for one in solved(ball(heights=wave(length=4e-4))).warnings)
    high = solved(
        ball(heights=wave(length=4e-4, high=1e-6), texture=Rough(rq=1e-6, modulus=MODULUS))
    )
    assert any("the contact is one of single summits" in one for one in high.warnings)


X = np.linspace(-1e-3, 1e-3, 101)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"heights": np.zeros((2, 5))}, r"heights of the shape \(2, 5\) on 2 places y and 101"),
        ({"heights": np.full((2, 101), np.nan)}, "a height map with 202 heights that are no"),
        ({"x": X[::-1]}, "places x of a height map have to rise"),
        ({"x": 0.05 * X}, "the contact reaches from -"),
        ({"y": 0.05 * ENDS}, "along y: the contact reaches from"),
        (
            {"x": ENDS, "heights": np.array([[0.0, 1e-7]] * 2)},
            "a height map with steps of 2 mm along x",
        ),
        ({"heights": np.outer([1, 1], X), "periodic": True}, "a periodic height map ends 2e.06 nm"),
        ({"heights": np.outer([1, 1], 0.05 * X)}, "let the bodies touch at the edge of"),
        ({"member": 2}, "a height map of member 2"),
        ({"member": 0}, "heights that move with member 0 have no steady film"),
    ],
)
def test_maps_that_say_nothing_of_the_contact_are_refused(given: dict[str, Any], told: str):
    usual = {"x": X, "y": ENDS, "heights": np.zeros((2, 101))}
    with pytest.raises(InputError, match=told):
        solve_patch(ball(heights=HeightMap(**{**usual, **given})), nodes=33, cells=32)


def test_a_map_of_a_surface_with_several_speeds_cannot_move():
    given = {"load": 100.0, "length": 2e-3, "radius": 0.01, "modulus": MODULUS, "fluid": OIL}
    leans = {"places": ENDS, "speed_a": np.array([1.0, 2.0]), "speed_b": 1.0}
    with pytest.raises(InputError, match="a height map moves as a whole"):
        solve_patch(finite_line(**given, **leans, heights=wave(member=0)))
