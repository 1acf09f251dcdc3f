"""Dynamics of a mesh against closed forms, an independent integrator, and balances of energy."""

import equinox as eqx
import numpy as np
import pytest
from harmonic_balance import harmonic_balance
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from pitchpoint._jax import jax, jnp
from pitchpoint.core.status import Code
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.energy import vibration_energies
from pitchpoint.dynamics.excitation import Excitation
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.integration import by_steps
from pitchpoint.dynamics.series import by_series
from pitchpoint.dynamics.steady_state import separating_steady_state, steady_state
from pitchpoint.dynamics.sweep import speed_sweep
from pitchpoint.dynamics.system import (
    System,
    modal_damping,
    reduced_mass,
)
from pitchpoint.errors import InputError
from pitchpoint.gears.period import lobatto

NODES = 24
MASS, MEAN, LOAD = 2.2e-3, 1.14e7, 141.0
NATURAL = np.sqrt(MEAN / MASS)
SHORT, FINE = PeriodGrid(4), PeriodGrid(64)
HAND_OVER = 0.3

solve = eqx.filter_jit(steady_state)
separate = eqx.filter_jit(separating_steady_state)
sweep = eqx.filter_jit(speed_sweep)
balance = eqx.filter_jit(harmonic_balance)
peak_to_peak = eqx.filter_jit(lambda found: found.peak_to_peak(found.transmission_error))
sizes = eqx.filter_jit(jax.vmap(peak_to_peak))
together = eqx.filter_jit(jax.vmap(lambda s, e: steady_state(s, e, SHORT)))


def nothing(path):
    return 0.0 * path


def one(path):
    return 1.0 + 0.0 * path


def excitation(stiffness, error=nothing, arm=one, hand_over=HAND_OVER):
    """Two pairs, each a function of its path: it leaves where the next one has reached the hand-over.

    A segment without length stands between the others.
    """
    edges = np.array([0.0, hand_over, hand_over, 1.0])
    phase = edges[:-1, None] + np.diff(edges)[:, None] * lobatto(NODES)[0]
    path = np.stack([phase, phase + 1.0])
    carries = np.stack([np.ones_like(phase), 1.0 * (np.arange(3) == 0)[:, None] + 0.0 * phase])
    values = (carries * stiffness(path), np.atleast_3d(arm(path))[None], error(path))
    return Excitation(jnp.asarray(edges), *map(jnp.asarray, values))


def steps(low=0.7, hand_over=HAND_OVER):
    """Stiffness that jumps between one pair and two."""
    return excitation(lambda path: MEAN * low + 0.0 * path, hand_over=hand_over)


def rounded():
    """Pairs that come and go with jumps, stiffness and errors curved."""
    return excitation(
        lambda path: 0.75 * MEAN * (0.5 + path - 0.4 * path**2),
        lambda path: 1e-6 * np.cos(3.0 * path),
        lambda path: 1.0 + 0.05 * np.sin(2.0 * path),
    )


def smooth(depth=0.2, error=0.0, order=1):
    """One pair that carries always, periodic without jumps."""
    own = excitation(
        lambda path: MEAN * (1.0 + depth * np.cos(2.0 * np.pi * path)),
        lambda path: error * np.cos(2.0 * np.pi * order * path),
    )
    return eqx.tree_at(lambda e: e.stiffness, own, own.stiffness.at[1].set(0.0))


def system(ratio, xi=0.16, load=LOAD):
    """One coordinate with so many natural periods in a mesh period."""
    mass = jnp.array([[MASS]])
    damping = modal_damping(mass, jnp.array([[MEAN]]), xi)
    return System(mass, damping, jnp.array([load]), jnp.asarray(2.0 * np.pi * ratio / NATURAL))


def status(response):
    return Code(int(response.status.code))


def motion(response):
    """Displacement and velocity over the scale of their vibration, at the nodes."""
    both = np.stack([response.displacement[0], response.velocity[0] / NATURAL])
    return both / np.max(np.abs(both[0]))


def interpolated(excite, values):
    """Plain functions of phase for each pair, by NumPy."""
    edges = np.asarray(excite.edges)
    used = [k for k in range(edges.size - 1) if edges[k + 1] > edges[k]]
    place = 2.0 * lobatto(values.shape[-1])[0] - 1.0
    vander = np.linalg.inv(np.polynomial.legendre.legvander(place, values.shape[-1] - 1))
    modes = [vander @ np.asarray(values)[..., k, :].reshape(-1, place.size).T for k in used]
    bounds = [(edges[k], edges[k + 1]) for k in used]

    def read(segment, phase):
        low, high = bounds[segment]
        x = 2.0 * (phase - low) / (high - low) - 1.0
        return np.polynomial.legendre.legval(x, modes[segment]).reshape(values.shape[:-2])

    return read, bounds


def marched(sys, excite, state, law, periods=1, phases=()):
    """Motion by scipy with a plain right-hand side: states at phases of the last period, and its end."""
    stiffness, bounds = interpolated(excite, excite.stiffness)
    arm, error = (interpolated(excite, value)[0] for value in (excite.arm, excite.error))
    mass, damping, load = (np.asarray(v) for v in (sys.mass, sys.damping, sys.load))
    inverse, period, size = np.linalg.inv(mass), float(sys.period), load.size
    unit = np.concatenate([np.full(size, 1e-5), np.full(size, 1e-5 * NATURAL)])
    state, found = np.asarray(state, float), []

    for turn in range(periods):
        for segment, (low, high) in enumerate(bounds):

            def rate(phase, y, segment=segment):
                q, v = y[:size], y[size:]
                a = arm(segment, phase)
                force = stiffness(segment, phase) * law(q @ a - error(segment, phase))
                return period * np.concatenate([v, inverse @ (load - damping @ v - a @ force)])

            here = [p for p in phases if low <= p < high]
            done = solve_ivp(
                rate, (low, high), state, "DOP853", [*here, high], rtol=1e-10, atol=1e-12 * unit
            )
            state = done.y[:, -1]
            if turn == periods - 1:
                found.extend(done.y[:, :-1].T)
    return np.array(found), state


def start_of(response):
    return np.concatenate([response.displacement[:, 0, 0], response.velocity[:, 0, 0]])


def test_constant_stiffness_gives_the_static_deflection():
    response = solve(system(1.7), smooth(depth=0.0), SHORT)
    assert status(response) is Code.SOLVED
    np.testing.assert_allclose(response.transmission_error, LOAD / MEAN, rtol=1e-12)
    np.testing.assert_allclose(response.static_transmission_error, LOAD / MEAN, rtol=1e-14)
    np.testing.assert_allclose(response.dynamic_factor(LOAD)[0], 1.0, rtol=1e-12)
    np.testing.assert_allclose(response.velocity, 0.0, atol=1e-12 * NATURAL * LOAD / MEAN)


@eqx.filter_jit
def measures(response):
    error = response.transmission_error
    return response.spectrum(error, range(6)), response.peak_to_peak(error), response.rms(error)


@pytest.mark.parametrize("order", [1, 3])
def test_error_on_constant_stiffness_follows_the_transfer_function(order):
    size, ratio, xi = 2e-6, 2.3, 0.07
    response = solve(system(ratio, xi), smooth(0.0, size, order), SHORT)
    r = order / ratio
    gain = 1.0 / (1.0 - r**2 + 2j * xi * r)
    phase = 2.0 * np.pi * order * np.asarray(response.course.phase)
    exact = LOAD / MEAN + size * (gain * np.exp(1j * phase)).real
    np.testing.assert_allclose(response.transmission_error, exact, rtol=1e-10)
    amplitudes, swing, rms = measures(response)
    expected = np.where(np.arange(6) == order, size * abs(gain), 0.0)
    expected[0] = LOAD / MEAN
    np.testing.assert_allclose(amplitudes, expected, atol=1e-10 * size)
    np.testing.assert_allclose(swing, 2.0 * size * abs(gain), rtol=1e-9)
    np.testing.assert_allclose(rms, size * abs(gain) / np.sqrt(2.0), rtol=1e-9)


def meissner(sys, low):
    """Affine maps of state and one over both parts of the period, by matrix exponentials."""
    maps = []
    for stiffness, share in ((2.0 * low * MEAN, HAND_OVER), (low * MEAN, 1.0 - HAND_OVER)):
        rate = np.zeros((3, 3))
        rate[0, 1] = 1.0
        rate[1] = [-stiffness, -float(sys.damping[0, 0]), float(sys.load[0])]
        rate[1] /= MASS
        maps.append((rate, share * float(sys.period)))
    return maps


@pytest.mark.parametrize(
    ("ratio", "xi", "stable"),
    [
        (1.7, 0.05, True),
        (0.5, 0.01, False),
        (0.5, 0.12, True),
        (1.03, 0.002, False),
        (0.7, 0.0, True),
    ],
)
def test_floquet_multipliers_of_a_square_wave(ratio, xi, stable):
    sys = system(ratio, xi)
    response = solve(sys, steps(), SHORT)
    (first, a), (second, b) = meissner(sys, 0.7)
    exact = np.linalg.eigvals((expm(second * b) @ expm(first * a))[:2, :2])
    np.testing.assert_allclose(
        np.sort_complex(response.multipliers), np.sort_complex(exact), atol=1e-7
    )
    assert (np.max(np.abs(exact)) <= 1.0 + 1e-9) is np.bool_(stable)
    assert (status(response) is Code.UNSTABLE) is not stable


@pytest.mark.parametrize("ratio", [60.0, 200.0])
@pytest.mark.parametrize("xi", [0.16, 0.003])
def test_fast_vibration_of_a_square_wave_is_exact(ratio, xi):
    sys = system(ratio, xi)
    response = solve(sys, steps(), FINE)
    (first, a), (second, b) = meissner(sys, 0.7)
    whole = expm(second * b) @ expm(first * a)
    start = np.append(np.linalg.solve(np.eye(2) - whole[:2, :2], whole[:2, 2]), 1.0)
    phase, exact = np.asarray(response.course.phase), []
    after = expm(first * a) @ start
    for at in phase.ravel()[:: phase.shape[1] - 1]:
        time = at * float(sys.period)
        exact.append(expm(first * time) @ start if time <= a else expm(second * (time - a)) @ after)
    found = np.stack([response.displacement[0].ravel(), response.velocity[0].ravel()], axis=1)
    error = (found[:: phase.shape[1] - 1] - np.array(exact)[:, :2]) / [1.0, NATURAL]
    assert np.max(np.abs(error)) < 1e-9 * np.max(np.abs(found[:, 0]))
    assert vibration_energies(sys, response).closure < 1e-8


@pytest.mark.parametrize("ratio", [0.8, 4.0, 7.3])
def test_motion_and_energy_with_jumps_errors_and_arms(ratio):
    sys, excite = system(ratio, 0.05), rounded()
    response = solve(sys, excite, SHORT)
    phases = np.asarray(response.course.phase)[:, 5]
    states, end = marched(sys, excite, start_of(response), lambda s: s, phases=phases)
    scale = np.max(np.abs(response.displacement))
    np.testing.assert_allclose(
        response.displacement[0, :, 5][: len(states)], states[:, 0], atol=1e-8 * scale
    )
    np.testing.assert_allclose(end[0], start_of(response)[0], atol=1e-8 * scale)
    work = vibration_energies(sys, response)
    assert work.closure < 1e-8
    assert work.damping < 0.0
    assert all(abs(part) > 1e-4 * abs(work.damping) for part in (work.mesh, work.error, work.arm))


@pytest.mark.whole
def test_short_elements_resolve_a_fast_profile_error():
    base = rounded()
    excite = eqx.tree_at(
        lambda e: e.error,
        base,
        excitation(one, lambda path: 5e-6 * np.cos(48.0 * np.pi * path)).error,
    )
    sys = system(40.0, 0.16)
    assert vibration_energies(sys, solve(sys, excite, PeriodGrid(16))).closure < 1e-9


@pytest.mark.parametrize("excite", [rounded(), steps()], ids=["rounded", "steps"])
def test_steps_and_series_agree(excite):
    sys = system(7.3, 0.01)
    fast, slow = solve(sys, excite, SHORT), solve(sys, excite, SHORT, integrator=by_steps)
    assert status(fast) is status(slow)
    np.testing.assert_allclose(motion(fast), motion(slow), atol=1e-9)


def test_momentum_balances_over_a_period():
    response = solve(system(3.3, 0.05), rounded(), SHORT)
    pushed = jnp.sum(response.course.arm[0] * response.dynamic_factor(LOAD), axis=0)
    np.testing.assert_allclose(response.mean(pushed), 1.0, rtol=1e-10)


def test_smooth_stiffness_has_the_static_limit_and_a_jump_rings_for_ever():
    def distance(excite, ratio):
        response = solve(system(ratio), excite, FINE)
        away = response.transmission_error - response.static_transmission_error
        return float(jnp.max(jnp.abs(away))) * MEAN / LOAD

    slow, slower = (distance(smooth(), ratio) for ratio in (50.0, 150.0))
    assert slower < 0.005
    np.testing.assert_allclose(slow / slower, 3.0, rtol=0.03)
    ringing = [distance(steps(), ratio) for ratio in (25.0, 100.0)]
    assert min(ringing) > 0.2
    np.testing.assert_allclose(*ringing, rtol=1e-3)


@pytest.mark.whole
def test_harmonic_balance_agrees():
    sys, excite = system(7.3, 0.05), rounded()
    by_time = solve(sys, excite, FINE)
    by_orders = balance(sys, excite, 60, FINE)
    for measure in ("peak_to_peak", "rms", "mean"):
        exact, found = (getattr(r, measure)(r.transmission_error) for r in (by_time, by_orders))
        np.testing.assert_allclose(found, exact, rtol=1e-4)
    assert status(by_time) is Code.SOLVED
    assert status(by_orders) is Code.STABILITY_UNKNOWN
    orders = range(12)
    np.testing.assert_allclose(
        by_orders.spectrum(by_orders.transmission_error, orders),
        by_time.spectrum(by_time.transmission_error, orders),
        atol=1e-4 * float(by_time.rms(by_time.transmission_error)),
    )


def test_harmonics_of_a_jump_are_exact_for_any_order():
    response = solve(system(1.7), steps(), SHORT)
    orders = np.array([1, 17, 500, 1501])
    total = jnp.sum(response.course.stiffness, axis=0)
    exact = 0.7 * MEAN * 2.0 * np.abs(np.sin(np.pi * orders * HAND_OVER)) / (np.pi * orders)
    np.testing.assert_allclose(response.spectrum(total, orders), exact, atol=1e-13 * MEAN)


def test_load_scales_the_response():
    low, high = (solve(system(3.3, load=load), steps(), SHORT) for load in (0.30e3, 0.42e3))
    ratio = np.divide(*(peak_to_peak(response) for response in (high, low)))
    np.testing.assert_allclose(ratio, 1.4, rtol=1e-12)


def test_batch_equals_loop_and_a_bad_lane_disturbs_no_other():
    designs = [rounded(), steps(), smooth()]
    systems = [system(2.0, 0.05), system(np.nan), system(3.0, 0.1)]
    stacked = (jax.tree.map(lambda *x: jnp.stack(x), *lanes) for lanes in (systems, designs))
    batch = together(*stacked)
    assert int(batch.status.code[1]) == Code.NOT_FINITE
    assert bool(jnp.all(jnp.isnan(batch.displacement[1])))
    assert bool(jnp.all(jnp.isnan(batch.force[1])))
    for lane in (0, 2):
        alone = solve(systems[lane], designs[lane], SHORT)
        np.testing.assert_allclose(batch.displacement[lane], alone.displacement, rtol=1e-9)
        assert int(batch.status.code[lane]) == int(alone.status.code)


def peak(scale, integrator=by_series):
    excite = rounded()
    varied = eqx.tree_at(lambda e: e.stiffness, excite, excite.stiffness.at[1].multiply(scale))
    response = steady_state(system(2.0, 0.1), varied, SHORT, integrator=integrator)
    return response.peak_to_peak(response.transmission_error)


@pytest.mark.parametrize(
    "derivative",
    [
        pytest.param(jax.grad(peak), marks=pytest.mark.whole, id="reverse"),
        pytest.param(jax.jacfwd(peak), id="forward"),
        pytest.param(
            jax.grad(lambda scale: peak(scale, by_steps)), marks=pytest.mark.whole, id="steps"
        ),
    ],
)
def test_gradient_of_peak_to_peak(derivative):
    value, step = jax.jit(peak), 1e-3
    differences = [value(1.0 + k * step) - value(1.0 - k * step) for k in (1, 2)]
    exact = (8.0 * differences[0] - differences[1]) / (12.0 * step)
    np.testing.assert_allclose(jax.jit(derivative)(jnp.asarray(1.0)), exact, rtol=1e-7)


def test_status_says_what_the_linear_model_leaves_out():
    pulled = solve(system(1.2, 0.02), smooth(0.0, 3e-5), SHORT)
    assert status(pulled) is Code.SEPARATES
    assert "separate" in status(pulled).sentence
    assert not status(pulled).ok
    assert float(jnp.min(pulled.force)) < 0.0
    coarse = solve(system(120.0, 0.01), steps(), SHORT)
    assert status(coarse) is Code.UNRESOLVED
    undamped = solve(system(0.5, 0.0), smooth(depth=0.0), SHORT)
    assert not bool(jnp.isnan(undamped.displacement).any())


@pytest.mark.whole
def test_two_coordinates():
    """A second body on a bearing: coupled by arms that change, damping of both modes alike."""
    base = rounded()
    arm = jnp.concatenate([base.arm, -0.4 * base.arm**2])
    ground = jnp.full((1, 3, NODES), 3e6)
    excite = Excitation(
        base.edges,
        jnp.concatenate([base.stiffness, ground]),
        jnp.concatenate([arm, jnp.zeros((2, 1, 3, NODES)).at[1].set(1.0)], axis=1),
        jnp.concatenate([base.error, 0.0 * ground]),
    )
    mass = jnp.array([[MASS, 0.2 * MASS], [0.2 * MASS, 3.0 * MASS]])
    course = excite.on(SHORT)
    damping = modal_damping(
        mass,
        course.mean(jnp.einsum("apen,pen,bpen->aben", course.arm, course.stiffness, course.arm)),
        0.04,
    )
    sys = System(mass, damping, jnp.array([LOAD, 20.0]), jnp.asarray(2.0 * np.pi * 2.6 / NATURAL))
    response = solve(sys, excite, SHORT)
    assert status(response) in (Code.SOLVED, Code.SEPARATES)
    assert vibration_energies(sys, response).closure < 1e-8
    start = start_of(response)
    _, end = marched(sys, excite, start, lambda s: s)
    unit = np.array([1.0, 1.0, NATURAL, NATURAL]) * np.max(np.abs(start[:2]))
    np.testing.assert_allclose(end / unit, start / unit, atol=1e-8)
    balance_ = jnp.einsum("apen,pen->aen", response.course.arm, response.force)
    np.testing.assert_allclose(response.mean(balance_), sys.load, rtol=1e-8)
    by_orders = balance(sys, excite, 60, FINE)
    assert float(by_orders.rms(by_orders.displacement)[1]) == pytest.approx(
        float(response.rms(response.displacement)[1]), rel=1e-4
    )


def test_modal_damping_gives_each_mode_its_ratio():
    mass, stiffness = np.diag([2.0, 3.0]) + 0.5, np.array([[5.0, -1.0], [-1.0, 4.0]])
    damping = np.asarray(modal_damping(jnp.asarray(mass), jnp.asarray(stiffness), 0.1))
    inverse = np.linalg.inv(mass)
    rate = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -inverse @ damping]])
    values = np.linalg.eigvals(rate)
    np.testing.assert_allclose(-values.real / np.abs(values), 0.1, rtol=1e-10)


def test_mass_that_vibrates_along_a_contact():
    inertia, base = np.array([3e-6, 4e-4]), np.array([0.003, 0.042])
    expected = inertia[0] * inertia[1] / (inertia[0] * base[1] ** 2 + inertia[1] * base[0] ** 2)
    arm = np.array([base[0], -base[1]])
    np.testing.assert_allclose(reduced_mass(inertia, arm), expected, rtol=1e-14)


SPUR = steps(1.0 / 1.3)
UNIT = PeriodGrid(4, 16)
RATIOS = 1.0 / np.linspace(0.62, 1.1, 25)


def one_sided(stretch):
    return np.maximum(stretch, 0.0)


@pytest.fixture(scope="module")
def branches():
    sys = system(1.0, 0.02)
    periods = jnp.asarray(2.0 * np.pi * RATIOS / NATURAL)
    up = sweep(sys, SPUR, periods, UNIT)
    down = sweep(sys, SPUR, periods[::-1], UNIT)
    up, down = jax.device_get((up, down))
    return sys, periods, up, jax.tree.map(lambda x: x[::-1], down)


def test_sweeps_up_and_down_follow_different_branches(branches):
    sys, periods, up, down = branches
    size = [sizes(branch) for branch in (up, down)]
    both = (up.status.code == 0) & (down.status.code == 0)
    differ = np.flatnonzero(both & (size[1] > 1.5 * size[0]))
    assert differ.size >= 3
    same = np.flatnonzero(both & (np.abs(size[1] / size[0] - 1.0) < 1e-6))
    assert same.max() > differ.max()
    for branch in (up, down):
        at = jax.tree.map(lambda x: x[differ[1]], branch)
        own = eqx.tree_at(lambda s: s.period, sys, periods[differ[1]])
        start = start_of(at)
        _, end = marched(own, SPUR, start, one_sided, periods=3)
        np.testing.assert_allclose(end[0], start[0], rtol=1e-6)
        pushed = float(at.mean(jnp.sum(at.force, axis=0)))
        assert pushed == pytest.approx(LOAD, rel=2e-3)
        assert np.max(np.abs(at.multipliers)) < 1.0
    assert bool(jax.vmap(lambda r: r.separated)(down)[differ[1]])


@pytest.mark.whole
def test_a_motion_of_twice_the_period_is_not_returned():
    sys, excite = system(1.0 / 0.66, 0.03), steps(1.0 / 1.4, 0.4)
    before = separate(system(1.0 / 0.64, 0.03), excite, UNIT)
    assert status(before) is Code.SOLVED
    response = separate(sys, excite, UNIT, start=start_of(before))
    assert status(response) is Code.NOT_PERIODIC
    assert bool(jnp.all(jnp.isnan(response.displacement)))
    known = np.array([1.71294952, -0.17138109 * NATURAL]) * LOAD / MEAN  # after 200 periods
    _, settled = marched(sys, excite, known, one_sided, periods=2)
    _, once = marched(sys, excite, settled, one_sided)
    _, twice = marched(sys, excite, once, one_sided)
    assert abs(once[0] - settled[0]) > 0.5 * LOAD / MEAN
    np.testing.assert_allclose([twice[0], settled[0]], known[0], rtol=1e-6)


def test_teeth_that_do_not_part_move_as_in_the_linear_model():
    sys = system(2.5, 0.1)
    free, bound = separate(sys, SPUR, UNIT), solve(sys, SPUR, UNIT)
    assert status(free) is status(bound) is Code.SOLVED
    assert not bool(free.separated)
    np.testing.assert_allclose(motion(free), motion(bound), atol=1e-8)
    np.testing.assert_allclose(free.multipliers, bound.multipliers, atol=1e-6)


def test_back_flanks_meet_within_the_backlash():
    sys, excite = system(1.2, 0.05, load=5.0), smooth(0.0, 3e-5)
    backlash = 5e-6
    response = separate(sys, excite, UNIT, backlash=backlash)
    assert status(response) is Code.SOLVED
    assert float(jnp.min(response.force)) < -1.0

    def law(stretch):
        return np.maximum(stretch, 0.0) - np.maximum(-stretch - backlash, 0.0)

    start = start_of(response)
    _, end = marched(sys, excite, start, law)
    assert abs(end[0] - start[0]) < 1e-6 * np.max(np.abs(response.displacement))


def test_share_of_the_period_without_any_contact_is_the_length_of_its_elements():
    response = solve(system(2.5, 0.1), SPUR, UNIT)
    assert float(response.separated_share) == 0.0
    force = jnp.asarray(response.force).at[:, 1:3].set(0.0)
    apart = eqx.tree_at(lambda r: r.force, response, force)
    expected = float(jnp.sum(response.course.length[1:3]))
    assert 0.0 < expected < 1.0
    assert float(apart.separated_share) == pytest.approx(expected, rel=1e-12)
    lost = eqx.tree_at(lambda r: r.displacement, response, response.displacement * jnp.nan)
    assert np.isnan(lost.separated_share)


def test_names_of_contact_laws():
    assert list(CONTACT_LAWS) == ["linear", "separating"]
    with pytest.raises(InputError, match="did you mean separating"):
        CONTACT_LAWS["seperating"]
