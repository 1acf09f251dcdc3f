"""Pairs with clearances that share a load: conditions of equilibrium, other solvers, derivatives, laws."""

import itertools
from functools import partial
from typing import ClassVar

import equinox as eqx
import numpy as np
import pytest
from bare_contacts import line_contacts
from scipy.optimize import nnls

from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.pairs import ACTION, WAVE, touching, way_of_pairs
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading import equilibrium as module
from pitchpoint.loading.compliance import Compliance
from pitchpoint.loading.equilibrium import equilibrium, touching_approach
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.sharing import demand_sharing, sharing_applies

LANES, STATES = 40, 60


def coupled(compliance, gap, arm, active, load):
    """Equilibrium of lanes that a body alone couples."""
    return equilibrium(jnp.zeros(()), compliance, gap=gap, arm=arm, active=active, load=load)


solve = jax.jit(coupled)


def solved(*given):
    return jax.tree.map(np.asarray, solve(*map(jnp.asarray, given)))


def full(rng, lanes):
    root = rng.normal(size=(lanes, lanes))
    return root @ root.T / lanes + np.diag(10.0 ** rng.uniform(-3.0, 1.0, lanes))


def ring_like(rng, lanes):
    """Neighbours move each other, and all move alike."""
    place = np.linspace(0.0, 1.0, lanes)
    near = np.exp(-np.abs(place[:, None] - place) / 10.0 ** rng.uniform(-2.0, 0.5))
    far, teeth = 10.0 ** rng.uniform(-2.0, 2.0), 10.0 ** rng.uniform(-1.0, 1.0, lanes)
    return 10.0 ** rng.uniform(-1.0, 2.0) * near + far + np.diag(teeth)


def nearly_singular(rng, lanes):
    """A smooth body that yields far more than the teeth: exchanges alone do not end."""
    place = np.linspace(0.0, 1.0, lanes)
    width = 10.0 ** rng.uniform(-2.0, 0.0)
    body = 10.0 ** rng.uniform(-1.0, 2.0) * np.exp(-(((place[:, None] - place) / width) ** 2))
    return body + np.diag(10.0 ** rng.uniform(-3.0, -1.0, lanes))


def problems(kind, lanes=LANES, states=STATES):
    rng = np.random.default_rng(3)
    compliance = np.stack([kind(rng, lanes) for _ in range(states)], axis=-1)
    gap = rng.uniform(0.0, 1.0, (lanes, 1, states)) * 10.0 ** rng.uniform(-2.0, 3.0, states)
    arm = rng.uniform(0.5, 2.0, (lanes, 1, states))
    active = rng.uniform(size=(lanes, 1, states)) < 0.9
    return compliance, gap, arm, active, 10.0 ** rng.uniform(-2.0, 2.0, states)


@pytest.mark.parametrize("kind", [full, ring_like, nearly_singular])
def test_conditions_of_equilibrium(kind):
    compliance, gap, arm, active, load = problems(kind)
    found = solved(compliance, gap, arm, active, load)
    force, a = found.force[:, 0], arm[:, 0]
    slack = np.einsum("ijb,jb->ib", compliance, force) + gap[:, 0] - a * found.approach
    scale = np.max(a * found.approach, axis=0)
    carries, free = found.loaded[:, 0], active[:, 0] & ~found.loaded[:, 0]
    assert np.all(found.residual < 1e-12)
    assert np.all(force[carries] > 0.0)
    assert np.all(force[~carries] == 0.0)
    assert not np.any(carries & ~active[:, 0])
    assert np.abs(slack / scale)[carries].max() < 1e-12
    assert (slack / scale)[free].min() > -1e-10
    np.testing.assert_allclose((a * force).sum(axis=0), load, rtol=1e-12)
    np.testing.assert_allclose(found.share.sum(axis=(0, 1)), 1.0, rtol=1e-14)
    assert 1.0 < carries.sum(axis=0).mean() < 0.9 * LANES
    if kind is nearly_singular:
        assert found.iterations > 10, "no problem asks for the search step by step"


def by_enumeration(compliance, gap, arm, load):
    """The only set of lanes whose forces push and leave no other overlapping."""
    answers = []
    lanes = range(len(arm))
    for chosen in itertools.chain.from_iterable(
        itertools.combinations(lanes, count) for count in range(1, len(arm) + 1)
    ):
        c, a, g = compliance[np.ix_(chosen, chosen)], arm[[*chosen]], gap[[*chosen]]
        matrix = np.block([[c, -a[:, None]], [a[None], np.zeros((1, 1))]])
        *part, approach = np.linalg.solve(matrix, [*-g, load])
        force = np.zeros(len(arm))
        force[[*chosen]] = part
        slack = compliance @ force + gap - arm * approach
        if force.min() >= 0.0 and slack.min() > -1e-9:
            answers.append((force, approach))
    return answers


def test_same_as_trying_all_sets_of_lanes():
    compliance, gap, arm, _, load = problems(ring_like, lanes=6, states=20)
    found = solved(compliance, gap, arm, np.ones(arm.shape, bool), load)
    for at in range(20):
        given = compliance[..., at], gap[:, 0, at], arm[:, 0, at], load[at]
        [(force, approach)] = by_enumeration(*given)
        np.testing.assert_allclose(found.force[:, 0, at], force, rtol=1e-9, atol=1e-12)
        assert found.approach[at] == pytest.approx(approach, rel=1e-10)


def test_same_as_least_squares_with_forces_that_push():
    """Energy f C f/2 + g f as squares, the load as a row of great weight."""
    compliance, gap, arm, active, load = problems(ring_like)
    found = solved(compliance, gap, arm, active, load)
    for at in range(0, STATES, 12):
        some = active[:, 0, at]
        root = np.linalg.cholesky(compliance[..., at][np.ix_(some, some)])
        a, g = arm[some, 0, at], gap[some, 0, at]
        weight = 1e4 * np.abs(root).max()
        rows = np.concatenate([root.T, weight * a[None]])
        force, _ = nnls(rows, np.append(-np.linalg.solve(root, g), weight * load[at]))
        np.testing.assert_allclose(found.force[some, 0, at], force, rtol=1e-4, atol=1e-5 * load[at])


LOADS = 40  # of one compiled program


def springs(load, gap=(0.0, 2.0, 4.5, 7.5), stiffness=1.0, arm=1.0, series=0.0, active=True):
    """Four equal springs that begin to carry one after the other, and one in series with all."""
    load = np.asarray(load, float)
    compliance = np.broadcast_to((np.eye(4) / stiffness + series)[..., None], (4, 4, LOADS))
    gap = np.broadcast_to(np.reshape(np.asarray(gap, float), (4, 1, 1)), (4, 1, LOADS))
    allowed = np.broadcast_to(np.reshape(active, (-1, 1, 1)), gap.shape)
    loads = np.resize(load, LOADS)
    found = solved(compliance, gap, np.full(gap.shape, arm), allowed, loads)
    return jax.tree.map(lambda x: x[..., : load.size] if x.ndim else x, found)


@pytest.mark.parametrize("series", [0.0, 0.7])
def test_springs_with_clearances_come_to_carry_one_after_the_other(series):
    """T = sum of the springs that touch; a spring in series only adds to the approach."""
    approach = np.linspace(0.01, 12.0, LOADS)
    load = sum(np.maximum(approach - gap, 0.0) for gap in (0.0, 2.0, 4.5, 7.5))
    found = springs(load, series=series)
    np.testing.assert_allclose(found.approach, approach + series * load, rtol=1e-12)
    loaded = found.loaded.sum(axis=(0, 1))
    np.testing.assert_array_equal(loaded, 1 + sum(approach > gap for gap in (2.0, 4.5, 7.5)))
    np.testing.assert_allclose(found.stiffness, 1.0 / (1.0 / loaded + series), rtol=1e-12)
    secant = load / found.approach
    assert np.all(np.diff(found.approach) > 0.0)
    assert np.all(np.diff(secant) > -1e-14)
    assert secant[-1] > 1.2 * secant[0]


def test_no_load_gives_the_first_pairs_that_touch():
    found = springs([0.0, 1e-15, 1e-12], gap=(3.0, 1.0, 1.0, 2.0), arm=2.0)
    np.testing.assert_array_equal(found.loaded.sum(axis=(0, 1)), 2)
    np.testing.assert_allclose(found.share[:, 0].T, [[0.0, 0.5, 0.5, 0.0]] * 3, atol=1e-12)
    np.testing.assert_array_equal(found.force[..., 0], 0.0)
    np.testing.assert_allclose(found.approach, 0.5, rtol=1e-11)
    np.testing.assert_allclose(found.stiffness, 8.0)
    no_gap = springs([0.0], gap=(0.0,) * 4)
    np.testing.assert_allclose(no_gap.share, 0.25)
    np.testing.assert_array_equal(no_gap.approach, 0.0)


def test_rounding_does_not_choose_among_flanks_that_touch():
    exact = springs([0.0], gap=(3.0, 1.0, 1.0, 2.0), arm=2.0)
    noisy = springs([0.0], gap=(3.0, 1.0 + 1e-12, 1.0, 2.0), arm=2.0)
    for name in ("share", "stiffness", "loaded"):
        np.testing.assert_array_equal(getattr(noisy, name), getattr(exact, name))


def test_gaps_count_from_anywhere_and_units_are_free():
    base = springs([0.3, 5.0, 30.0])
    shifted = springs([0.3, 5.0, 30.0], gap=np.array([0.0, 2.0, 4.5, 7.5]) - 3.0)
    np.testing.assert_allclose(shifted.force, base.force, rtol=1e-12)
    np.testing.assert_allclose(shifted.approach, base.approach - 3.0, rtol=1e-12)
    small = springs(
        np.array([0.3, 5.0, 30.0]) * 1e-3, gap=np.array([0.0, 2.0, 4.5, 7.5]) * 1e-9, stiffness=1e6
    )
    np.testing.assert_allclose(small.share, base.share, rtol=1e-9, atol=1e-15)


def test_masked_lanes_never_carry_and_states_do_not_mix():
    masked = springs([0.5, 40.0], gap=(-5.0, 2.0, 4.5, 7.5), active=[False, True, True, True])
    np.testing.assert_array_equal(masked.force[0], 0.0)
    approach = (40.0 + 2.0 + 4.5 + 7.5) / 3.0
    found = masked.force[1:, 0, 1]
    np.testing.assert_allclose(found, approach - np.array([2.0, 4.5, 7.5]), rtol=1e-13)
    np.testing.assert_allclose(masked.force[:, 0, 0], [0.0, 0.5, 0.0, 0.0], rtol=1e-13)


def test_what_has_no_equilibrium_is_not_a_number(monkeypatch):
    nothing = springs([1.0], active=False)
    assert np.isnan(nothing.approach).all()
    assert np.isnan(nothing.force).all()
    assert np.isnan(springs([-1.0]).force).all()
    monkeypatch.setattr(module, "MOST", 0)
    given = problems(ring_like)
    found = jax.jit(lambda *anew: coupled(*anew))(*given)
    assert found.iterations == 0
    missed = np.asarray(found.residual) > 1e-10
    assert missed.any()
    np.testing.assert_array_equal(np.isnan(found.approach), missed)
    np.testing.assert_array_equal(np.isnan(found.force[0, 0]), missed)


def test_derivatives_equal_differences():
    compliance, gap, arm, active, load = problems(ring_like, lanes=12, states=4)
    rng = np.random.default_rng(5)
    root = rng.normal(size=compliance.shape) * 0.05
    along = (root + np.swapaxes(root, 0, 1), *(rng.normal(size=x.shape) for x in (gap, arm, load)))
    weight = rng.normal(size=gap.shape)

    @jax.jit
    def figure(step):
        c, g, a, t = (
            x + step * dx for x, dx in zip((compliance, gap, arm, load), along, strict=True)
        )
        found = coupled(c, g, a, active, t)
        parts = (jnp.sum(weight * found.force, axis=(0, 1)), found.approach, found.stiffness)
        return jnp.stack([*parts, jnp.sum(weight * found.share, axis=(0, 1))])

    forward = np.asarray(jax.jit(jax.jacfwd(figure))(0.0))
    reverse = np.asarray(jax.jit(jax.jacrev(figure))(0.0))
    step = 1e-6
    difference = np.asarray(figure(step) - figure(-step)) / (2.0 * step)
    np.testing.assert_allclose(forward, difference, rtol=2e-6, atol=1e-8)
    np.testing.assert_allclose(reverse, forward, rtol=1e-9, atol=1e-12)


def test_derivatives_do_not_ask_which_value_is_the_largest_or_the_least(monkeypatch):
    """They ask by an equality, and are 0/0 where a compiler rounds its two sides differently."""
    compliance, gap, arm, active, load = problems(ring_like, lanes=6, states=2)

    @jax.custom_jvp
    def lost(value):
        return value

    lost.defjvp(lambda at, along: (at[0], jnp.nan * along[0]))

    def turned(by):
        first = touching_approach(by * gap, jnp.asarray(arm), jnp.asarray(active))
        return jnp.sum(coupled(compliance, by * gap, arm, active, load).approach + first)

    expected = float(jax.jit(jax.grad(turned))(1.0))
    for name in ("max", "min"):
        chosen = getattr(jnp, name)
        monkeypatch.setattr(jnp, name, lambda x, chosen=chosen, **over: lost(chosen(x, **over)))
    found = jax.jit(jax.grad(lambda by: turned(by)))(1.0)
    assert float(found) == pytest.approx(expected, rel=1e-12)


def test_stiffness_is_the_slope_of_the_load():
    compliance, gap, arm, active, load = problems(ring_like)
    found = solved(compliance, gap, arm, active, load)
    _, slope = jax.jvp(
        lambda t: solve(compliance, gap, arm, active, t).approach, (load,), (load**0,)
    )
    np.testing.assert_allclose(found.stiffness * slope, 1.0, rtol=1e-10)


# ------------------------------------------------------------------ models of load sharing


def contacts(path, gap=0.0, active=True):
    path = np.asarray(path, float).reshape(-1, 1, 1)
    none = np.zeros(path.shape)
    return line_contacts(
        active=np.broadcast_to(np.asarray(active), path.shape),
        path=np.asarray(path),
        width=none,
        weight=none + 0.01,
        curvature=none + np.ones((2, 2, 1, 1, 1)),
        surface=none + np.ones((2, 3, 1, 1, 1)),
        normal=np.stack([none, none, none - 0.02]),
        gap=none + gap,
        flank=np.stack([none, none]),
    )


LOADED = np.array([0.0, 0.0, 1.0])


def mesh(separate):
    """As much of a mesh as the models look at."""
    return _Looked(separate)


class _Looked(Mesh):
    separate: bool = eqx.field(static=True)
    contact_ratio: ClassVar[jax.Array] = jnp.asarray(1.5)
    shape: ClassVar[str] = "line"
    surfaces = ((), ())
    body = other_flanks = events = relation = pitch = passing = None
    coordinates = rigid_contacts = spots = None


way_of_pairs.register(_Looked, lambda looked: WAVE if looked.separate else ACTION)
touching.register(_Looked, lambda looked: not looked.separate)
tooth_sections.register(_Looked, lambda _: ())


@partial(jax.jit, static_argnames="separate")
def by_stiffness(contacts, yields, *, separate):
    share = LOAD_SHARING["from_stiffness"].function(contacts, mesh(separate), yields)
    return share[:, 0, 0]


def test_shares_by_stiffness_with_and_without_clearances():
    stiffness = jnp.asarray([1e9, 2e9, 3e9, 4e9]).reshape(4, 1, 1)
    yields = Compliance(stiffness, None, jnp.asarray([0.5]), LOADED)
    touching = contacts([0.0, 0.01, 0.02, 0.03])
    plain = by_stiffness(touching, yields, separate=False)
    np.testing.assert_array_equal(plain, np.array([1e9, 2e9, 3e9, 4e9]) / 1e10)
    found = by_stiffness(touching, yields, separate=True)
    np.testing.assert_allclose(found, plain, rtol=1e-12)
    apart = contacts([0.0, 0.01, 0.02, 0.03], gap=np.reshape([0.0, 1e-6, 0.0, 1.0], (4, 1, 1)))
    share = by_stiffness(apart, yields, separate=True)
    np.testing.assert_allclose(share, [0.25, 0.0, 0.75, 0.0], atol=1e-12)
    heavy = Compliance(stiffness, None, jnp.asarray([0.02 * 1e7 * 6.0 * 1e-5]), LOADED)
    force = np.array([1.0, 2.0, 3.0]) * 1e7
    approach = (6e2 + force[1] * 1e-6) / force.sum()
    force = force * (approach - np.array([0.0, 1e-6, 0.0]))
    share = by_stiffness(apart, heavy, separate=True)
    np.testing.assert_allclose(share, [*force / force.sum(), 0.0], rtol=1e-12)


def test_a_body_that_couples_pairs_evens_out_their_loads():
    """Two of three pairs that sit on one soft body carry less than the one beside it."""
    body = np.zeros((3, 3, 1))
    body[:2, :2] = 1e-7
    yields = Compliance(jnp.full((3, 1, 1), 1e9), jnp.asarray(body), jnp.asarray([2.0]), LOADED)
    share = by_stiffness(contacts([0.0] * 3), yields, separate=False)
    # 1/k = 1e-7: the two move by (1e-7 + 2e-7) f, the third by 1e-7 f.
    np.testing.assert_allclose(share, [0.2, 0.2, 0.6], rtol=1e-12)


@pytest.mark.parametrize(("name", "end"), [("xu_2021_cosine", 22.5), ("zhao_2022_cosine", 36.0)])
def test_cosine_laws_of_strain_wave_gears(name, end):
    degrees = np.concatenate([np.arange(-45.0, 50.0, 3.6), np.arange(-43.0, 52.0, 3.6)])
    some = contacts(degrees / 360.0, active=(degrees != degrees[8]).reshape(-1, 1, 1))
    share = np.asarray(LOAD_SHARING[name].function(some, mesh(True), None))[:, 0, 0]
    assert share.sum() == pytest.approx(1.0, rel=1e-14)
    expected = np.where(np.abs(degrees) < end, np.cos(np.pi / 2.0 * degrees / end), 0.0)
    expected[8] = 0.0
    np.testing.assert_allclose(share, expected / expected.sum(), rtol=1e-12, atol=1e-15)
    assert share.min() >= 0.0


def test_models_say_where_they_hold():
    cosines = {"xu_2021_cosine", "zhao_2022_cosine"}
    separate, touching = (
        {m for m in LOAD_SHARING if sharing_applies(LOAD_SHARING[m], mesh(s))}
        for s in (True, False)
    )
    assert separate == {"from_stiffness", *cosines}
    assert touching == set(LOAD_SHARING) - cosines
    with pytest.raises(InputError, match=r"'equal' holds where all rigid flanks .* gap; choose"):
        demand_sharing(LOAD_SHARING["equal"], mesh(True))
    with pytest.raises(InputError, match=r"strain-wave gears, and these are not; choose one of"):
        demand_sharing(LOAD_SHARING["xu_2021_cosine"], mesh(False))


# ------------------------------------------------------------------ without a body


@jax.jit
def both_ways(teeth, gap, arm, active, load):
    """Equilibrium of springs side by side, by their order and as a matrix that couples nothing."""
    given = {"gap": gap, "arm": arm, "active": active, "load": load}
    none = jnp.zeros((gap.shape[0] * gap.shape[1],) * 2 + gap.shape[2:])
    return equilibrium(teeth, None, **given), equilibrium(teeth, none, **given)


@pytest.mark.parametrize("load", [0.0, 0.3, 40.0])
def test_springs_side_by_side_are_a_matrix_that_couples_nothing(load):
    rng = np.random.default_rng(3)
    lanes = (5, 4, 30)
    teeth, arm = (jnp.asarray(rng.uniform(0.5, 2.0, lanes)) for _ in range(2))
    gap = jnp.asarray(rng.normal(size=lanes) * 3.0)
    active = jnp.asarray(rng.uniform(size=lanes) > 0.2)
    loads = load * jnp.asarray(rng.uniform(0.2, 1.0, 30))
    alone, coupled_ = jax.tree.map(np.asarray, both_ways(teeth, gap, arm, active, loads))
    np.testing.assert_array_equal(alone.loaded, coupled_.loaded)
    for name in ("force", "share", "approach", "stiffness"):
        one, other = getattr(alone, name), getattr(coupled_, name)
        np.testing.assert_allclose(one, other, rtol=1e-10, atol=1e-12 * np.abs(other).max())
    assert alone.residual.max() < 1e-12
    assert alone.loaded.sum() >= {0.0: 30, 0.3: 33, 40.0: 60}[load]


def test_slices_of_helical_teeth_need_no_matrix():
    """288 lanes as a matrix would take a factorisation each; their order takes a sort."""
    lanes = (24, 12, 8)
    given = (jnp.ones(lanes), jnp.zeros(lanes), jnp.ones(lanes), jnp.ones(lanes, bool), jnp.ones(8))
    text = jax.jit(lambda t, g, a, on, f: equilibrium(t, None, gap=g, arm=a, active=on, load=f))
    assert "cholesky" not in text.lower(*given).as_text()
