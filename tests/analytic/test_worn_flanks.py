"""Worn teeth and surfaces: what contacts feel of them, and their pressure."""

from dataclasses import replace
from typing import Any

import equinox as eqx
import numpy as np
import pytest
from worn_pairs import CELLS, EXAMPLES, begun, discs, pair, turn

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.surface import Spot, missing
from pitchpoint.contact.worn import WIDEST, Worn, WornAt, averaged
from pitchpoint.gears.mesh_bodies import main_dimensions
from pitchpoint.runs.run import load_case
from pitchpoint.wear.worn_teeth import backlash_growth, half_teeth, tips_of

# ---- worn teeth


def test_tips_lose_what_the_flank_loses_over_the_cosine_of_its_angle():
    built = pair("equal")
    start, cells = begun(built)
    mesh, tips = built.design.mesh, tips_of(built.design.mesh, cells, start)
    arc = np.asarray(main_dimensions(mesh)["tip_thickness"])
    radius, base = np.asarray(mesh.tip_radii), np.asarray(mesh.base_radii)
    half = arc / (2.0 * radius)
    assert tips.width == pytest.approx(2.0 * radius * np.sin(half), rel=1e-6)
    assert tips.taken == pytest.approx(1.0 / np.cos(np.arccos(base / radius) - half), rel=1e-6)
    flank = np.asarray(start.places)
    outermost = flank > (1.0 - 1e-9) * np.nanmax(flank, axis=(1, 2), keepdims=True)
    depth = np.zeros(cells.shape)
    depth[:, cells.count :][outermost] = 1e-5
    assert tips.left(depth) == pytest.approx(tips.width - 1e-5 * tips.taken, rel=1e-12)
    # Neither cells beside the tip nor places below it count.
    assert tips.left(1e-5 - depth) == pytest.approx(tips.width, rel=1e-12)


def test_cells_lie_on_the_involutes_of_the_teeth():
    built = pair("equal")
    _, cells = begun(built)
    mesh, found = built.design.mesh, half_teeth(built.design.mesh, cells)
    base = np.asarray(mesh.base_radii)[:, None]
    radius = np.sqrt(base**2 + 2.0 * base * np.asarray(cells.middles[0]))
    tips, arc = np.asarray(mesh.tip_radii), np.asarray(main_dimensions(mesh)["tip_thickness"])
    pressure = np.arccos(base / np.hstack([tips[:, None], radius]))
    involute = np.tan(pressure) - pressure
    half = (arc / (2.0 * tips))[:, None] + involute[:, :1] - involute[:, 1:]
    assert found.half == pytest.approx(radius * np.sin(half), rel=1e-6)
    rise = radius * np.cos(half)
    assert found.height == pytest.approx(rise - rise.min(axis=1, keepdims=True), abs=1e-8)
    assert found.angle == pytest.approx(pressure[:, 1:] - half, abs=1e-6)


def test_even_wear_of_both_flanks_adds_both_depths_to_the_backlash():
    built = pair("equal")
    start, cells = begun(built)
    depth = np.full(cells.shape, 1e-5)
    grown = backlash_growth(built.design.mesh, cells, start, depth)
    assert grown == pytest.approx(2e-5, rel=1e-9)
    depth[1] = 0.0
    # A pair that is not worn there touches first.
    flank = np.asarray(start.places)[0]
    depth[0, cells.count :][flank < np.nanmedian(flank)] = 0.0
    less = backlash_growth(built.design.mesh, cells, start, depth)
    assert 0.0 < less <= 1e-5 * (1.0 + 1e-9)


# ---- worn flanks


@eqx.filter_jit
def heights(worn: Worn, at: Spot) -> jax.Array:
    return missing((worn,), at)


@eqx.filter_jit
def bends(worn: Worn, at: Spot) -> jax.Array:
    return worn.bent(at)


def spot(flank: np.ndarray, across: np.ndarray) -> Spot:
    none = np.zeros(flank.shape)
    return Spot(*map(array, (flank, across, none, none.astype(int), none)))


def test_smoothed_depths_keep_their_volume_and_stay_positive():
    depth = np.zeros((30, 12))
    depth[8:20, 4:9] = np.random.default_rng(3).random((12, 5))
    surface = Worn(array(depth), array([1.0, 4.0]), array([-2.0, 2.0]), array([0.1, 0.1]))
    s, y = np.meshgrid(np.linspace(1.0, 4.0, 1201), np.linspace(-2.0, 2.0, 961), indexing="ij")
    height = np.asarray(heights(surface, spot(s, y)))
    assert height.min() >= 0.0
    volume = np.trapezoid(np.trapezoid(height, y[0], axis=1), s[:, 0])
    assert volume == pytest.approx(depth.sum() * (3.0 / 30) * (4.0 / 12), rel=1e-4)


def test_contacts_feel_the_second_difference_over_their_width():
    span, ends = np.array([0.03, 0.2]), (array([0.0, 1.0]), array([-1.0, 1.0]))
    rough = Worn(array(np.random.default_rng(4).random((20, 8))), *ends, array(span))
    rng = np.random.default_rng(5)
    s, y = rng.uniform(0.12, 0.88, 40), rng.uniform(-0.6, 0.6, 40)
    moved = [(s + k * span[0], y) for k in (-1.0, 1.0)], [(s, y + k * span[1]) for k in (-1.0, 1.0)]
    here = np.asarray(heights(rough, spot(s, y)))
    expected = [
        (sum(np.asarray(heights(rough, spot(*one))) for one in both) - 2.0 * here) / step**2
        for both, step in zip(moved, span, strict=True)
    ]
    assert np.asarray(bends(rough, spot(s, y))) == pytest.approx(np.array(expected), rel=1e-9)
    # Of a parabola its curvature, up to where a contact reaches beyond the middles of the last cells.
    middle = (np.arange(20)[:, None] + 0.5) / 20
    even = Worn(array(np.repeat(3.0 * middle**2, 8, axis=1)), *ends, array(span))
    found = np.asarray(bends(even, spot(s, y)))
    assert found[0] == pytest.approx(6.0, rel=1e-9)
    assert found[1] == pytest.approx(0.0, abs=1e-12)
    over = np.asarray(bends(even, spot(np.array([1.0 + span[0]]), np.array([0.0]))))
    assert over[0] == pytest.approx(0.0, abs=1e-9)


def test_places_that_stay_feel_the_same_of_a_worn_flank():
    """From before the first cell to behind the last one, where flanks go straight on."""
    depth, span = np.random.default_rng(6).random((12, 1)), array([0.05, 1.0])
    worn = Worn(array(depth), array([0.0, 1.0]), array([-1.0, 1.0]), span)
    places = np.linspace(-0.1, 1.1, 60)
    at = spot(places, np.zeros(60))

    @eqx.filter_jit
    def both(worn: Worn, at: Spot) -> tuple[jax.Array, jax.Array]:
        stays = WornAt.of(worn, at)
        return stays.missing(at), stays.bent(at)

    height, bend = map(np.asarray, both(worn, at))
    assert height == pytest.approx(np.asarray(heights(worn, at)), rel=1e-12)
    assert bend == pytest.approx(np.asarray(bends(worn, at)), rel=1e-12, abs=1e-10)


@pytest.mark.whole
@pytest.mark.parametrize("name", ["torus", "helical_few_teeth_plastic"])
def test_other_families_keep_their_volume(name):
    sharing = {"models.load_sharing": "from_stiffness"}
    built = load_case(str(EXAMPLES / f"{name}.toml"), settings=sharing)
    found, cells = turn(built)
    assert np.asarray(cells.volumes(array(found.depth))) == pytest.approx(found.volume, rel=1e-12)
    assert cells.strips > 1
    assert np.all(found.depth >= 0.0)
    middle = found.depth[:, :, cells.strips // 2]
    assert np.all(np.count_nonzero(middle, axis=1) > 0.8 * CELLS)


# ---- pressure on worn flanks

FLANK, MODULUS, CURVATURE = 2e-3, 2.3e11, 70.0
SCAR = 0.25e-3  # m: standard deviation of a scar in the middle of the flank


def pressed_lines(
    depths: np.ndarray, places: np.ndarray, line_load: float
) -> tuple[np.ndarray, np.ndarray]:
    """Half-widths by the curvature that contacts feel, and where these are no half spaces."""
    radius, wide = felt_over(array(depths), array(places), array(line_load))
    half = np.sqrt(8.0 * line_load * np.asarray(radius) / (np.pi * MODULUS))
    return half[0, 0], np.asarray(wide)[0, 0]


@eqx.filter_jit
def felt_over(depths: jax.Array, places: jax.Array, line_load: jax.Array) -> Any:
    contacts = discs()[0].mesh.contacts(jnp.zeros(places.size))
    lanes = contacts.active.shape
    given = replace(
        contacts,
        flank=jnp.broadcast_to(places, (2, *lanes)),
        curvature=jnp.zeros((2, 2, *lanes)).at[:, 0].set(CURVATURE / 2.0),
        felt=jnp.full(lanes, CURVATURE),
    )
    ends = array([0.0, FLANK]), array([-1.0, 1.0]), array([1e-4, 1.0])
    worn = Worn(depths[:, None], *ends), Worn(0.0 * depths[:, None], *ends)
    found, wide = averaged(given, worn, line_load, array(MODULUS))
    return found.radius, wide


def scar(place: np.ndarray) -> np.ndarray:
    return np.exp(-0.5 * ((place - FLANK / 2.0) / SCAR) ** 2)


def in_cells(cells: int) -> np.ndarray:
    """Means of the scar over the cells."""
    return scar((np.arange(8 * cells) + 0.5) * FLANK / (8 * cells)).reshape(cells, 8).mean(axis=1)


def half_space_solve(
    depth: float, place: float, half: float, line_load: float
) -> tuple[float, float]:
    """Largest pressure and half-width on the worn profile itself, leaned until it lies about its normal."""
    nodes = 301
    x = np.linspace(-2.5, 2.5, nodes) * half
    step = x[1] - x[0]
    gap = 0.5 * CURVATURE * x**2 + depth * scar(place + x)
    angle = (np.arange(400) + 0.5) * np.pi / 400
    s = place + half * np.cos(angle)
    gap -= x * np.mean(-depth * scar(s) * (s - FLANK / 2.0) / SCAR**2)
    away = np.subtract.outer(x, x)
    sides = [away + side * step / 2.0 for side in (1.0, -1.0)]
    log = [one * (np.log(np.abs(one)) - 1.0) for one in sides]
    soft = -4.0 / (np.pi * MODULUS) * (log[0] - log[1])
    held = np.abs(x) < half
    for _ in range(200):
        at = np.flatnonzero(held)
        matrix = np.zeros((at.size + 1, at.size + 1))
        matrix[:-1, :-1], matrix[:-1, -1], matrix[-1, :-1] = soft[np.ix_(at, at)], -1.0, step
        found = np.linalg.solve(matrix, np.append(-gap[at], line_load))
        pressure = np.zeros(nodes)
        pressure[at] = found[:-1]
        overlap = gap + soft @ pressure - found[-1] < -1e-15
        after_ = (held & (pressure > 0.0)) | (~held & overlap)
        if np.array_equal(after_, held):
            return float(pressure.max()), 0.5 * step * np.count_nonzero(held)
        held = after_
    raise AssertionError("the active set did not settle")


@pytest.mark.parametrize(("hollow", "within"), [(0.4, 0.08), (0.8, 0.16)])
def test_worn_flanks_have_the_pressure_of_a_half_space_solve(hollow, within):
    """Half-widths are exact, pressures nearly, from the bottom of a scar to its edge."""
    places = FLANK / 2.0 + SCAR * np.array([0.0, 0.7, 1.2, 2.0])
    depth = hollow * CURVATURE * SCAR**2
    for line_load in (2e4, 1e5, 4e5):
        half, wide = pressed_lines(depth * in_cells(80), places, line_load)
        assert not wide.any()
        for place, b in zip(places, half, strict=True):
            pressure, width = half_space_solve(depth, place, b, line_load)
            assert 2.0 * line_load / (np.pi * b) == pytest.approx(pressure, rel=within)
            assert b == pytest.approx(width, rel=0.025)


def test_contacts_over_two_cells_wide_do_not_ask_how_many_there_are():
    depth, places = 0.4 * CURVATURE * SCAR**2, FLANK / 2.0 + SCAR * np.array([0.0, 0.7, 1.2, 2.0])
    half = [pressed_lines(depth * in_cells(n), places, 4e5)[0] for n in (20, 40, 80)]
    assert half[0] == pytest.approx(half[2], rel=0.02)
    assert half[1] == pytest.approx(half[2], rel=0.005)


def test_noise_of_single_cells_neither_sharpens_nor_flattens_contacts():
    noise = 2e-8 * np.random.default_rng(7).standard_normal(80)
    places, line_load = np.linspace(0.4, 0.6, 40) * FLANK, 2e5
    new, _ = pressed_lines(np.zeros(80), places, line_load)
    half, _ = pressed_lines(1e-6 + noise, places, line_load)
    raw = np.abs(np.diff(noise, n=2)).max() / (FLANK / 80) ** 2
    assert raw > 0.5 * CURVATURE
    assert np.abs(half / new - 1.0).max() < 0.03


def test_flanks_that_conform_are_no_half_spaces():
    """A scar that is hollower than the flanks are round carries beyond its edges or not at all."""
    places = np.array([FLANK / 2.0])
    away = np.linspace(-1.0, 1.0, 40)
    depths = 1.2 * CURVATURE * (FLANK / 2.0) ** 2 * (1.0 - away**2)
    half, wide = pressed_lines(depths, places, 1e6)
    assert wide.all()
    assert half == pytest.approx(min(WIDEST / (CURVATURE / 2.0), FLANK), rel=1e-6)


def test_contacts_that_are_no_half_spaces_as_new_grow_no_wider():
    """Wider than the flank as new: a hollow leaves them so, a hump narrows them, and neither ends a march."""
    places, as_new = np.array([FLANK / 2.0]), 1.25 * FLANK
    line_load = np.pi * MODULUS * as_new**2 * CURVATURE / 8.0
    away = np.linspace(-1.0, 1.0, 40)
    hollow = 0.2 * CURVATURE * (FLANK / 2.0) ** 2 * (1.0 - away**2)
    for depths, narrowed in ((np.zeros(40), 0.0), (hollow, 0.0), (hollow.max() - hollow, 1.0)):
        half, wide = pressed_lines(depths, places, line_load)
        assert not wide.any()
        assert (half[0] < 0.999 * as_new) == bool(narrowed)
        assert half[0] <= as_new * (1.0 + 1e-9)


def bisected(depth: np.ndarray, place: float, line_load: float) -> float:
    """Half-width in balance, by sums over second differences of the cells, by a parabola of its variance."""
    length = FLANK / depth.size
    middles = (np.arange(depth.size) + 0.5) * length
    bend = np.pad(np.diff(depth, n=2), 1) / length**2
    s = (np.arange(4000) + 0.5) / 2000.0 - 1.0

    def lacks(half: float) -> bool:
        at = place + np.sqrt(1.25) * max(half, 2.0 * length) * s
        felt = CURVATURE + np.mean(1.5 * (1.0 - s**2) * np.interp(at, middles, bend))
        return bool(np.pi * MODULUS * half**2 * felt < 8.0 * line_load)

    low, high = 1e-4 * FLANK, FLANK
    for _ in range(50):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if lacks(middle) else (low, middle)
    return float(low)


def test_half_widths_on_random_worn_flanks_are_those_that_bisection_finds():
    """Smooth and rough scars, narrow and wide contacts, beyond the cells, flanks that nearly conform."""
    rng = np.random.default_rng(8)
    x, waves = (np.arange(40) + 0.5) / 40, np.arange(1, 7)
    tested = 0
    for size in (0.1, 0.3, 1.0, 2.0, 6.0, 6.0):
        shape = np.cos(np.pi * waves * x[:, None] + rng.uniform(0.0, 6.0, 6)) / waves**2
        depth = size * CURVATURE * (FLANK / 8) ** 2 * shape @ rng.standard_normal(6)
        depth += 1e-8 * rng.standard_normal(40) - depth.min()
        places = rng.uniform(-0.02, 1.02, 12) * FLANK
        for line_load in (1e3, 3e4, 6e5):
            half, wide = pressed_lines(depth, places, line_load)
            expected = [bisected(depth, place, line_load) for place in places[~wide]]
            assert half[~wide] == pytest.approx(np.array(expected), rel=1e-5)
            tested += len(expected)
    assert tested > 150
