"""Wind-up of strain-wave gears, hysteresis by friction of the teeth, kinematic error by deviations."""

import dataclasses
from unittest.mock import Mock

import equinox as eqx
import numpy as np
import pytest
from bare_contacts import line_contacts

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.contact.surface import Spot, Waves
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.gear_body import GearBody
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.gears.pairs import of_pairs
from pitchpoint.gears.strain_wave.design import build_strain_wave
from pitchpoint.gears.strain_wave.drive import places
from pitchpoint.loading import wind_up as module
from pitchpoint.loading.balance import force_balance
from pitchpoint.loading.compliance import Compliance
from pitchpoint.loading.equilibrium import touching_approach
from pitchpoint.loading.mesh_kinematic_error import added_gap, kinematic_error
from pitchpoint.loading.mesh_stiffness import mesh_stiffness
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import hysteresis, wind_up
from pitchpoint.materials.solids import Solid

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
TERMS = terms_of("beam_weber")
LOADS = np.geomspace(1e-3, 200.0, 12)
PHASES = np.array([0.0, 0.3, 0.8])
ARM = 0.02


def contacts(path, gap=0.0, slip=0.0):
    """Pairs along the first axis; rotations of wave generator, flexspline and circular spline."""
    path = np.asarray(path)
    none = np.zeros(path.shape)
    surface = np.zeros((2, 3, *path.shape))
    surface[0, 2] = slip
    return line_contacts(
        active=np.ones(path.shape, bool),
        path=path,
        width=none,
        weight=none + 0.01,
        curvature=np.ones((2, 2, *path.shape)),
        surface=surface,
        normal=np.stack([none, none, none - ARM]),
        gap=none + gap,
        flank=np.stack([none, none]),
    )


LOADED = jnp.asarray([0.0, 0.0, 1.0])

# ------------------------------------------------------------------ springs one after the other

GAPS = np.array([0.0, 1e-6, 4e-6, 0.0, 1e-6, 4e-6]).reshape(6, 1, 1)
SLIPS = np.array([1e-3, 2e-3, 3e-3, 1e-3, 2e-3, -3e-3]).reshape(6, 1, 1)
SPRING = 1e9 * 0.01


@pytest.fixture
def springs(monkeypatch):
    """Three equal pairs at each end of the axis, the second and the third of them with a clearance."""

    def compliance(mesh, loaded, contacts, solids, terms, load, body):
        return Compliance(jnp.full(contacts.path.shape, 1e9), None, load, loaded)

    at = contacts(np.zeros((6, 1, 1)), GAPS + ARM * 3e-5, SLIPS)
    pressed = jnp.asarray([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]).reshape(6, 1, 1)
    zones = jnp.repeat(jnp.eye(2), 3, axis=1).reshape(2, 6, 1, 1)
    monkeypatch.setattr(module, "compliance", compliance)
    monkeypatch.setattr(module, "on_edge", lambda mesh, contacts: at.gap == jnp.max(at.gap))
    return Mock(
        spec=Mesh,
        contacts=lambda phase: at,
        body=Mock(
            spec=GearBody,
            inner_load=lambda contacts: zones * pressed,
            in_series=lambda solids, loaded: {},
        ),
    )


def test_springs_that_come_to_carry_one_after_the_other(springs):
    turned = np.linspace(0.0, 1.013e-3, 41)
    force = SPRING * np.maximum(ARM * turned - GAPS, 0.0)
    load = (ARM * force).sum(axis=(0, 1))
    solve = eqx.filter_jit(lambda *at: wind_up(springs, LOADED, (STEEL, STEEL), TERMS, *at))
    found = solve(jnp.asarray(load), jnp.zeros(1))
    np.testing.assert_allclose(found.wind_up, turned, rtol=1e-10, atol=1e-15)
    np.testing.assert_allclose(found.touch, 3e-5, rtol=1e-12)
    np.testing.assert_allclose(found.force, force, rtol=1e-9, atol=1e-9)
    carry = np.maximum((force > 0.0).sum(axis=(0, 1)), 2)
    np.testing.assert_array_equal(found.loaded_pairs, carry)
    np.testing.assert_allclose(found.stiffness, carry * SPRING * ARM**2, rtol=1e-10)
    inward = force[:, 0] * np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])[:, None]
    np.testing.assert_allclose(
        found.edge_load, force[[2, 5]].sum(axis=(0, 1)), rtol=1e-9, atol=1e-9
    )
    expected = [inward[:3].sum(axis=0), inward[3:].sum(axis=0)]
    np.testing.assert_allclose(found.inner_load, expected, rtol=1e-9, atol=1e-9)
    loop = hysteresis(found, 0.1)
    held = 0.1 * (force * np.abs(SLIPS)).sum(axis=(0, 1))
    np.testing.assert_allclose(loop.loading, load + held, rtol=1e-10)
    np.testing.assert_allclose(loop.unloading, load - held, rtol=1e-10)


# ------------------------------------------------------------------ a drive


@eqx.filter_jit
def _wind_up(mesh, load, phase):
    return wind_up(mesh, mesh_ends(mesh)[1], (STEEL, STEEL), TERMS, load, phase)


def wound_up(mesh, loads):
    """Of any loads at all phases, by one compiled program."""
    load, phase = np.meshgrid(np.resize(loads, LOADS.size), PHASES, indexing="ij")
    found = _wind_up(mesh, load, phase)
    return jax.tree.map(lambda x: np.asarray(x)[..., : len(loads), :] if x.ndim else x, found)


@pytest.fixture(scope="module")
def drive():
    return build_strain_wave(teeth=(100, 102), module=0.5e-3, face_width=10e-3)


@pytest.fixture(scope="module")
def found(drive):
    return wound_up(drive, LOADS)


@pytest.fixture(scope="module")
def at(drive):
    contacts = eqx.filter_jit(lambda mesh, phase: mesh.contacts(phase))(drive, PHASES)
    return jax.tree.map(np.asarray, contacts)


def test_wind_up_stiffness_and_pairs_grow_with_the_torque(found):
    assert np.all(found.residual < 1e-12)
    assert np.all(np.diff(found.wind_up, axis=0) > 0.0)
    secant = found.load / found.wind_up
    assert np.all(np.diff(secant, axis=0) > 0.0)
    assert np.all(np.diff(found.loaded_pairs, axis=0) >= 0)
    assert np.all(found.loaded_pairs[0] >= 2)
    assert np.all(found.loaded_pairs[-1] >= found.loaded_pairs[0] + 6)
    assert np.all(found.stiffness > 0.999 * secant)


def test_torque_is_carried_alike_at_both_ends_of_the_axis(found, drive, at):
    arm = np.abs(np.asarray(contact_velocity(at.normal, mesh_ends(drive)[1])))
    torque = (found.force * arm[:, :, None]).sum(axis=(0, 1))
    np.testing.assert_allclose(torque, found.load, rtol=1e-11)
    np.testing.assert_allclose(found.inner_load[0], found.inner_load[1], rtol=1e-9)
    assert np.all(found.inner_load[0] > 0.0)


def test_stiffness_is_the_slope_of_the_torque(drive):
    """With the springs as they change with the load, where the same pairs carry on both sides."""
    loads = np.array([0.3, 3.0, 30.0])
    here, more, less = (wound_up(drive, loads * (1.0 + e)) for e in (0.0, 1e-6, -1e-6))
    same = more.loaded_pairs == less.loaded_pairs
    slope = 2e-6 * here.load / (more.wind_up - less.wind_up)
    assert same.sum() > 5
    np.testing.assert_allclose(here.stiffness[same], slope[same], rtol=1e-6)


def test_without_torque_the_first_pairs_touch(drive, found, at):
    zero = wound_up(drive, [0.0])
    np.testing.assert_allclose(zero.wind_up, 0.0, atol=1e-17)  # rounding of the touch
    np.testing.assert_array_equal(zero.force, 0.0)
    assert np.all(zero.stiffness > 0.5 * found.stiffness[0])
    assert np.all(zero.stiffness <= found.stiffness[0])
    play = at.gap / np.abs(contact_velocity(at.normal, np.asarray(mesh_ends(drive)[1])))
    first = play <= zero.touch[0] + 1e-7 * play[at.active].max()
    pairs = np.asarray(of_pairs(drive, (first & at.active).any(axis=1) * 1.0)) > 0.0
    np.testing.assert_array_equal(zero.loaded_pairs[0], pairs.sum(axis=0))
    least = np.where(at.active, play, np.inf).min(axis=(0, 1))
    np.testing.assert_allclose(zero.touch[0], least, rtol=1e-9, atol=1e-17)  # of two programs


def test_branches_are_in_balance_with_friction(found, drive, at):
    """Turning the loaded member alone with its torque of the branch asks for the forces without friction."""
    mu, force = 0.08, found.force[..., 0]
    at = jax.tree.map(lambda x: x[..., :1], at)
    side = float(np.sign(np.sum(contact_velocity(at.normal, mesh_ends(drive)[1]) * force[..., :1])))
    loop = hysteresis(found, mu)

    @jax.jit
    def force_of(load, sense):
        share = force / force.sum(axis=(0, 1))
        given = {
            "motion": sense * side * mesh_ends(drive)[1],
            "loaded": mesh_ends(drive)[1],
            "load": load,
        }
        return force_balance(at, share, **given, friction=lambda x: jnp.full_like(x, mu)).force

    for sense, branch in ((1.0, loop.loading), (-1.0, loop.unloading)):
        np.testing.assert_allclose(
            force_of(branch[:, 0], sense), force.sum(axis=(0, 1)), rtol=1e-10
        )
    assert np.all(loop.unloading > 0.0)
    assert np.all(loop.loading > 1.01 * loop.unloading)


SPUR = build_cylindrical_pair(
    teeth=(20, 30), module=2e-3, pressure_angle=np.deg2rad(20.0), face_width=0.02
)


@eqx.filter_jit
def of_pair(mesh, load):
    loaded = mesh_ends(mesh)[1]
    stiffness = mesh_stiffness(mesh, loaded, (STEEL, STEEL), TERMS, load)
    at = stiffness.phase.ravel()
    found = wind_up(mesh, loaded, (STEEL, STEEL), TERMS, load, at)
    other = mesh.other_flanks.contacts(at)
    arm = jnp.abs(contact_velocity(other.normal, loaded))
    return stiffness, found, touching_approach(other.gap, arm, other.active)


@pytest.mark.whole
def test_the_mesh_stiffness_of_a_spur_pair_is_the_slope_of_its_wind_up():
    """Springs pass through the load at its wind-up, and along its slope, of Weber's contact."""
    stiffness, found, _ = jax.tree.map(np.asarray, of_pair(SPUR, jnp.asarray(80.0)))
    radius = float(SPUR.base_radii[1])
    total, at_rest = stiffness.total.ravel(), found.wind_up * radius
    np.testing.assert_allclose(stiffness.approach.ravel(), found.wind_up, rtol=1e-12)
    np.testing.assert_allclose(found.stiffness, total * radius**2, rtol=1e-12)
    error = stiffness.error.reshape(-1, total.size)
    force = stiffness.along_action.reshape(error.shape) * (at_rest - error)
    np.testing.assert_allclose(force.sum(axis=0), 80.0 / radius, rtol=1e-12)
    np.testing.assert_allclose(force, found.force.sum(axis=1), atol=1e-12 * 80.0 / radius)
    # The contact of the teeth stiffens with the load, so the slope is steeper than load over wind-up.
    assert np.all(total * at_rest > 1.03 * 80.0 / radius)


def test_between_its_flanks_a_pair_has_its_backlash():
    wide = dataclasses.replace(
        SPUR, centre_distance=SPUR.centre_distance * 1.002, follows=(False, True)
    )
    _, found, free = jax.tree.map(np.asarray, of_pair(wide, jnp.asarray(0.0)))
    play = float(wide.backlash / wide.working_radii[1])
    assert play > 1e-4
    np.testing.assert_allclose(found.touch + free, play, rtol=1e-12)
    np.testing.assert_array_equal(found.wind_up, 0.0)


# ------------------------------------------------------------------ kinematic error

TEETH = jnp.asarray([20.0, 22.0])
PAIRS = 8
TURNS = 10  # of the wave generator: after ten all teeth meet as at first
SAMPLES = TURNS * 22 * 4
PHASE = np.arange(SAMPLES) / SAMPLES * TURNS * 22
NONE = Waves(*jnp.zeros((3, 1)))
CLEARANCES = np.array([4e-7, 0.0, 1e-6, 3e-6] * 2).reshape(PAIRS, 1, 1)


def two_zones(gap=0.0):
    """Four pairs at each end of the axis, equal springs, without clearances by default."""
    number = np.arange(PAIRS).reshape(-1, 1, 1) % (PAIRS // 2) - 2.0
    return contacts((number + np.mod(PHASE, 1.0)) / 20.0, gap)


def one(order, amplitude=1e-8, phase=0.4):
    return Waves(*(jnp.asarray([float(value)]) for value in (order, amplitude, phase)))


def spots(at):
    """Contacts on both members, all of which stand upright."""
    return tuple(
        Spot(flank, at.width, angle, jnp.zeros(angle.shape, int), jnp.ones(angle.shape))
        for flank, angle in zip(at.flank, places(at, PHASE, TEETH), strict=True)
    )


def errors(deviations, load, gap=0.0):
    return _errors(deviations, load, np.broadcast_to(gap, (PAIRS, 1, 1)))


@jax.jit
def _errors(deviations, load, gap):
    at = two_zones(gap)
    added = added_gap(tuple((one,) for one in deviations), spots(at))
    yields = Compliance(jnp.full(at.path.shape, 1e9), None, jnp.full(SAMPLES, load), LOADED)
    return kinematic_error(at, yields, added)


def lines(values):
    """Amplitudes against order per turn of the wave generator."""
    return 2.0 * np.abs(np.fft.rfft(np.asarray(values))) / SAMPLES


def order_of_the_largest(values):
    return np.argmax(lines(values)) / TURNS


@pytest.mark.parametrize("order", [1, 2, 3, 4, 7])
@pytest.mark.parametrize("member", [0, 1])
def test_orders_of_deviations_in_the_kinematic_error(member, order):
    """Odd ones cancel over two zones; k of the circular spline stays k, of the other is k z2/z1."""
    both = (one(order), NONE) if member == 0 else (NONE, one(order))
    found = errors(both, 50.0)
    if order % 2:
        assert np.abs(found.elastic_mean).max() < 1e-12 * 1e-8 / ARM
        return
    assert order_of_the_largest(found.elastic_mean) == order * (22.0 / 20.0 if member == 0 else 1.0)
    # Pairs spread over the wave average it, as the mean of four pitches does.
    pitch = 2.0 * np.pi / 20.0 * (1.0 if member == 0 else 20.0 / 22.0)
    mean = np.sin(2.0 * order * pitch) / (2.0 * order * pitch)
    size = lines(found.elastic_mean).max() / (1e-8 / ARM)
    assert size == pytest.approx(mean, rel=0.02)


def test_under_load_small_deviations_add_up_to_their_elastic_mean():
    found = errors((one(2), one(4)), 50.0)
    size = np.abs(found.elastic_mean).max()
    np.testing.assert_allclose(found.under_load, found.elastic_mean, atol=1e-9 * size)
    np.testing.assert_allclose(found.wind_up, 50.0 / (PAIRS * SPRING * ARM**2), rtol=1e-12)
    # With clearances the springs share more load as before, not the load itself.
    clear = errors((one(2), one(4)), 50.0, CLEARANCES)
    np.testing.assert_allclose(clear.elastic_mean, found.elastic_mean, atol=1e-9 * size)
    np.testing.assert_allclose(clear.under_load, clear.elastic_mean, atol=1e-9 * size)


def test_without_load_the_pair_that_stands_out_leads():
    """Teeth do not yield then: the rotation is that at which the first flank touches."""
    both = one(2, 1e-6), one(3, 1e-6)
    added = np.asarray(added_gap(tuple((one,) for one in both), spots(two_zones())))
    found = errors(both, 0.0)
    leads = added.min(axis=(0, 1)) / ARM
    np.testing.assert_allclose(found.under_load, leads, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found.geometric, leads, rtol=1e-9, atol=1e-15)
    np.testing.assert_array_equal(errors(both, 50.0).geometric, found.geometric)


def test_pairs_with_a_clearance_lead_only_if_they_stand_out_further():
    """Rigid teeth: the least of clearance and deviation together, less the least clearance, over the arm."""
    both = one(2, 1e-6), one(3, 1e-6)
    gap = CLEARANCES
    added = np.asarray(added_gap(tuple((one,) for one in both), spots(two_zones())))
    leads = (gap + added).min(axis=(0, 1)) / ARM
    found = errors(both, 0.0, gap)
    np.testing.assert_allclose(found.geometric, leads, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(found.under_load, leads, rtol=1e-9, atol=1e-12)
    assert np.abs(leads - errors(both, 0.0).geometric).max() > 0.1 * np.ptp(leads)


@eqx.filter_jit
def leaning(drive, at):
    """How far the pairs lean, and how they press the ring along its circumference."""
    return drive.spots(at, PHASES)[0].leaning, drive.body.ring_loads(at).tangential


def test_roundings_lean_to_the_radius(drive, at):
    """There the displacement of a tooth along the circumference moves the flanks apart by less."""
    part, across = leaning(drive, at)
    part, across = np.asarray(part), np.abs(across)
    active = np.asarray(at.active)
    assert part[active].max() == 1.0
    np.testing.assert_array_equal(part[~active], 0.0)
    np.testing.assert_allclose(part[active] / across[active], 1.0 / across[active].max())
    # The arm of the flexspline says the same, but for the place of the contact along the radius.
    arm = np.abs(contact_velocity(at.normal, jnp.asarray([0.0, 1.0, 0.0])))
    touching = active & (np.asarray(at.gap) < 2e-6)
    np.testing.assert_allclose(part[touching], arm[touching] / arm[touching].max(), atol=0.03)


def test_teeth_keep_their_places_while_the_wave_passes():
    """Around both members places are whole pitches, at any phase."""
    at = places(two_zones(), PHASE, TEETH)
    for member, teeth in enumerate((20.0, 22.0)):
        pitches = np.asarray(at[member]) / (2.0 * np.pi / teeth)
        np.testing.assert_allclose(pitches, np.round(pitches), atol=1e-9)
