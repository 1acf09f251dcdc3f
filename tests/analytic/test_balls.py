"""A ring on balls that only push: by SciPy's least energy, by closed forms, by a shell's own energy."""

from dataclasses import replace

import equinox as eqx
import numpy as np
import pytest
from scipy.optimize import brentq, minimize

from pitchpoint._jax import jax, jnp
from pitchpoint.core.status import Code
from pitchpoint.gears import on_balls
from pitchpoint.gears.on_balls import OnBalls, ball_force, ball_stiffness, seated
from pitchpoint.gears.strain_wave.ball_bearing import (
    Balls,
    ball_bearing,
    ball_stiffness_palmgren_1959,
)
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing, RingLoads
from pitchpoint.gears.strain_wave.ring_compliance import ring_modes
from pitchpoint.loading import equilibrium as loading
from pitchpoint.loading.equilibrium import equilibrium
from pitchpoint.materials.solids import Solid

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
POINT = ball_stiffness_palmgren_1959(5e-3)
RNG = np.random.default_rng(7)
LANES, COUNT = 5, 4

# Displacements of lanes and balls by a common body, stiffer within each than the balls are.
BODY = 1e-8 * (lambda root: root @ root.T)(RNG.normal(size=(LANES + COUNT, 12)))
OWN = 2e-9 * np.ones(LANES)
GAP = 1e-6 * np.array([0.0, 0.3, 1.0, 2.0, 4.0])
ARM = np.array([1.0, 0.9, 1.1, 0.8, 1.0])
PUSH = 1e-6 * np.array([4.0, -2.0, 1.0, 0.5])

_seated, _force, _stiffness = map(jax.jit, (seated, ball_force, ball_stiffness))


def body():
    lanes, across, balls = BODY[:LANES, :LANES], BODY[:LANES, LANES:], BODY[LANES:, LANES:]
    settled = _seated(jnp.asarray(balls), jnp.asarray(POINT), jnp.asarray(PUSH))
    start = jnp.asarray(np.asarray(settled)[:, None])
    parts = (lanes[..., None], across[..., None], balls, np.asarray(POINT))
    return OnBalls(*map(jnp.asarray, parts), settled, jnp.zeros((LANES, 1)), start)


@jax.jit
def _solved(held, load, own):
    def approach(at):
        found = equilibrium(
            own[:, None, None],
            held,
            gap=jnp.asarray(GAP)[:, None, None],
            arm=jnp.asarray(ARM)[:, None, None],
            active=jnp.ones((LANES, 1, 1), bool),
            load=at[None],
        )
        return found.approach[0], found

    return jax.jvp(approach, (load,), (jnp.ones(()),), has_aux=True)


def solved(load, own=OWN):
    return _solved(body(), jnp.asarray(load), jnp.asarray(own))


def by_energy(load):
    """Least complementary energy over forces that push; the multiplier of the load is the approach."""

    def energy(x):
        forces = x * 100.0
        bend = forces @ BODY @ forces / 2.0 + OWN @ forces[:LANES] ** 2 / 2.0
        points = 0.6 * (forces[LANES:] ** 5 / POINT**2) ** (1.0 / 3.0)
        return 1e4 * (bend + GAP_ @ forces[:LANES] - PUSH @ forces[LANES:] + points.sum())

    settled = np.asarray(body().approach)
    before = POINT * np.maximum(settled, 0.0) ** 1.5
    GAP_ = GAP - BODY[:LANES, LANES:] @ before  # gaps are counted from the seated body
    carries = {"type": "eq", "fun": lambda x: 100.0 * ARM @ x[:LANES] - load}
    start = np.full(LANES + COUNT, load / 100.0 / LANES)
    bounds = [(0.0, None)] * (LANES + COUNT)
    options = {"maxiter": 2000, "ftol": 1e-15}
    found = minimize(energy, start, bounds=bounds, constraints=carries, options=options)
    return 100.0 * found.x


# ------------------------------------------------------------------ one ball


def test_a_ball_pushes_by_hertz_and_never_pulls():
    approach = np.array([-1e-6, 0.0, 1e-6, 4e-6])
    force = np.asarray(_force(jnp.asarray(POINT), jnp.asarray(approach)))
    assert force[0] == force[1] == 0.0
    assert force[3] == pytest.approx(8.0 * force[2], rel=1e-12)
    slope = np.asarray(_stiffness(jnp.asarray(POINT), jnp.asarray(approach)))
    np.testing.assert_allclose(slope[2:], 1.5 * force[2:] / approach[2:], rtol=1e-12)
    assert slope[0] == slope[1] == 0.0
    gradient = jax.jit(jax.grad(ball_force, argnums=1))(jnp.asarray(POINT), jnp.zeros(()))
    assert float(gradient) == 0.0


def test_a_ball_against_one_spring_is_a_root():
    spring, push = 3e-8, 5e-6
    expected = brentq(lambda x: x + spring * POINT * x**1.5 - push, 0.0, push)
    found = _seated(jnp.full((1, 1), spring), jnp.asarray(POINT), jnp.full(1, push))
    assert float(found[0]) == pytest.approx(expected, rel=1e-12)


def test_balls_stay_off_where_a_body_would_have_to_be_pulled():
    held = body()
    force = np.asarray(_force(held.stiffness, held.approach))
    balance = PUSH - BODY[LANES:, LANES:] @ force
    np.testing.assert_allclose(held.approach, balance, atol=1e-15)
    assert (force == 0.0).any()
    assert (force > 0.0).any()


def test_balls_that_do_not_come_to_rest_have_no_seat(monkeypatch):
    monkeypatch.setattr(on_balls, "SEATING_STEPS", 1)
    given = BODY[LANES:, LANES:], POINT, PUSH
    assert np.isnan(seated(*map(jnp.asarray, given))).all()


# ------------------------------------------------------------------ with lanes that share a load


@pytest.mark.parametrize("load", [30.0, 300.0])
def test_lanes_and_balls_take_the_least_energy(load):
    _, _, found = solved(load)
    expected = by_energy(load)
    np.testing.assert_allclose(found.force[:, 0, 0], expected[:LANES], atol=2e-4 * load)
    force = POINT * np.maximum(found.balls[:, 0], 0.0) ** 1.5
    np.testing.assert_allclose(force, expected[LANES:], atol=2e-4 * load)


def test_every_gap_that_carries_is_closed_and_no_other_overlaps():
    moved, _, found = solved(200.0)
    held = body()
    force, approach = np.asarray(found.force[:, 0, 0]), np.asarray(found.balls[:, 0])
    settled = np.asarray(held.approach)
    more = POINT * (np.maximum(approach, 0.0) ** 1.5 - np.maximum(settled, 0.0) ** 1.5)
    both = BODY @ np.concatenate([force, more])
    slack = OWN * force + both[:LANES] + GAP - ARM * float(moved)
    assert np.abs(slack[force > 0.0]).max() < 1e-15
    assert slack.min() > -1e-15
    np.testing.assert_allclose(approach, settled - both[LANES:], atol=1e-15)
    assert float(ARM @ force) == pytest.approx(200.0, rel=1e-12)
    assert float(found.residual[0]) < 1e-12


def test_balls_that_go_on_moving_give_no_figures(monkeypatch):
    monkeypatch.setattr(loading, "PASSES", 1)
    given = {"gap": GAP, "arm": ARM, "active": np.ones(LANES, bool)}
    lanes = {name: jnp.asarray(values)[:, None, None] for name, values in given.items()}
    own = jnp.asarray(OWN)[:, None, None]
    found = eqx.filter_jit(equilibrium)(own, body(), **lanes, load=jnp.asarray([300.0]))
    for values in (found.force, found.share, found.approach, found.stiffness, found.balls):
        assert np.all(np.isnan(values))
    assert int(found.status.code[0]) == Code.NOT_CONVERGED


def test_a_body_without_a_seat_finds_no_equilibrium():
    held = body()
    lost = replace(held, approach=held.approach * np.nan, shift=held.shift * np.nan)
    _, _, found = _solved(lost, jnp.asarray(200.0), jnp.asarray(OWN))
    for values in (found.force, found.approach, found.stiffness, found.balls):
        assert np.all(np.isnan(values))
    assert int(found.status.code[0]) == Code.NOT_CONVERGED


def test_the_slope_is_that_of_balls_that_stiffen():
    step, load = 1e-3, 150.0
    ends = [float(solved(load + sign * step)[0]) for sign in (1.0, -1.0)]
    _, slope, _ = solved(load)
    assert float(slope) == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-6)


def test_derivatives_go_through_the_balls_and_their_seat():
    """By the stiffness of the balls, which moves the state without load too."""

    held, load, own = body(), jnp.asarray(150.0), jnp.asarray(OWN)

    @jax.jit
    @jax.value_and_grad
    def approach(stiffness):
        seat = seated(held.balls, stiffness, jnp.asarray(PUSH))
        return _solved(replace(held, stiffness=stiffness, approach=seat), load, own)[0]

    slope = float(approach(jnp.asarray(POINT))[1])
    step = 1e-4 * POINT
    ends = [float(approach(jnp.asarray(POINT + sign * step))[0]) for sign in (1.0, -1.0)]
    assert slope == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-5)
    assert slope < 0.0


def test_without_load_nothing_moves():
    moved, _, found = solved(0.0)
    assert float(moved) == pytest.approx(np.min(GAP / ARM), abs=1e-18)
    np.testing.assert_allclose(found.balls[:, 0], body().approach, rtol=1e-12)


def test_the_start_of_the_search_does_not_matter():
    moved, _, _ = solved(200.0)
    far = replace(body(), start=body().start + 5e-6)
    again, _, _ = _solved(far, jnp.asarray(200.0), jnp.asarray(OWN))
    assert float(again) == pytest.approx(float(moved), rel=1e-12)


# ------------------------------------------------------------------ the ring between


RADIUS, RIM, WIDTH, WALL, LENGTH = 25e-3, 0.6e-3, 10e-3, 0.3e-3, 25e-3


def ring(wall=WALL):
    return FlexibleRing(*map(jnp.asarray, (RADIUS, RIM, WIDTH, wall, LENGTH, jnp.inf)))


def radial(angle):
    none = np.zeros_like(angle)
    lanes = (angle, none, none + 1.0, none)
    return RingLoads(*(jnp.asarray(lane)[:, None] for lane in lanes))


def no_race(radius, waves):
    return jnp.zeros(waves + 1)


_modes = eqx.filter_jit(ring_modes)


def moves(of_ring, loads, race=no_race, waves=100):
    modes = np.asarray(_modes(of_ring, STEEL, loads, race, waves))
    return modes @ modes.T


def test_two_opposite_forces_bend_a_ring_of_thin_wall_as_in_a_handbook():
    """Roark: (pi/4 - 2/pi) P R^3/(EI) between the forces, for a ring that no wall holds."""
    found = moves(ring(wall=1e-7), radial(np.array([0.0, np.pi])))
    bend = 206e9 / (1.0 - 0.3**2) * WIDTH * RIM**3 / 12.0
    expected = (np.pi / 4.0 - 2.0 / np.pi) * RADIUS**3 / bend
    assert found.sum() == pytest.approx(expected, rel=2e-3)


def test_a_race_bends_beside_the_ring():
    """With the section of the rim it halves what two opposite forces bend."""
    bearing = ball_bearing(Balls(race_thickness=RIM), 2.0 * RADIUS, 2.0 * RADIUS - RIM, WIDTH)
    loads = radial(np.array([0.0, np.pi]))
    alone, both = (moves(ring(1e-7), loads, *race).sum() for race in ((), (bearing.race,)))
    assert both == pytest.approx(alone / 2.0, rel=1e-3)


@pytest.mark.parametrize("waves", [2, 3, 5])
def test_the_wall_bends_and_twists_without_stretching(waves):
    """Energy of the plate over the wall whose generators stay straight, integrated over its length."""
    n, plate = waves, 206e9 / (1.0 - 0.3**2) * WALL**3 / 12.0
    z, weight = np.polynomial.legendre.leggauss(8)
    z, weight = (z + 1.0) / 2.0 * LENGTH, weight / 2.0 * LENGTH
    # w = z/L cos n p, v = -z/(n L) sin n p: no hoop strain, and with u = -R/(n^2 L) cos n p no shear.
    around = (n**2 - 1.0) / RADIUS**2 * z / LENGTH
    twist = (n - 1.0 / n) / (RADIUS * LENGTH) * np.ones_like(z)
    energy = plate * (around**2 + 2.0 * (1.0 - 0.3) * twist**2) @ weight
    angle = 2.0 * np.pi * np.arange(64) / 64
    shape = np.cos(n * angle)
    stiffness = []
    for wall in (WALL, 1e-9):
        moved = moves(ring(wall), radial(angle), waves=20) @ (shape * 2.0 * np.pi * RADIUS / 64)
        stiffness.append(shape @ shape / (shape @ moved))
    assert stiffness[0] - stiffness[1] == pytest.approx(energy, rel=1e-6)


def test_symmetric_and_positive():
    found = moves(ring(), radial(np.linspace(0.1, 6.0, 23)))
    np.testing.assert_array_equal(found, found.T)
    assert np.linalg.eigvalsh(found).min() > -1e-12 * np.abs(found).max()
