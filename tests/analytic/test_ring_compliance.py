"""A thin ring under tooth forces: closed forms, an independent sum of energies, limits."""

from dataclasses import replace

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing, RingLoads
from pitchpoint.gears.strain_wave.ring_compliance import WAVES, ring_compliance
from pitchpoint.materials.solids import Solid

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
SHEAR = 206e9 / 2.6
RADIUS, THICKNESS, WIDTH, CUP = 25e-3, 0.6e-3, 10e-3, 25e-3

_compliance = eqx.filter_jit(ring_compliance)


def ring(thickness=THICKNESS, wall=0.3e-3, support=np.inf):
    values = (RADIUS, thickness, WIDTH, wall, CUP, support)
    return FlexibleRing(*map(jnp.asarray, values))


def loads(angle, tangential, radial, height=0.0):
    lanes = np.broadcast_arrays(*np.atleast_1d(angle, tangential, radial, height))
    return RingLoads(*(jnp.asarray(lane, float)[:, None] for lane in lanes))


def compliance(ring, loads, waves=WAVES):
    return np.asarray(_compliance(ring, STEEL, loads, waves))


def section(thickness=THICKNESS):
    """EA and EI."""
    strip = 206e9 * WIDTH * thickness
    return strip, strip * thickness**2 / 12.0 / (1.0 - 0.3**2)


def cup_stiffness(wall=0.3e-3):
    return SHEAR * wall / CUP


TEETH = np.linspace(-0.7, 0.7, 20) + np.repeat([0.0, np.pi], 10)
MIXED = loads(TEETH, -np.cos(0.3 + TEETH**2), -np.sin(0.3 + TEETH**2), 1.1e-3 + 1e-4 * TEETH)


@pytest.mark.parametrize("height", [0.0, 1.5e-3])
@pytest.mark.parametrize("support", [0.0, 1e9, np.inf])
def test_equal_forces_all_around_twist_the_cup_as_a_thin_tube(height, support):
    angle = 2.0 * np.pi * np.arange(120) / 120
    found = compliance(ring(support=support), loads(angle, 1.0, 0.0, height))
    torque = 120 * (RADIUS + height)
    twist = found.sum(axis=1) / (RADIUS + height)
    tube = 2.0 * np.pi * RADIUS**3 * SHEAR * 0.3e-3 / CUP
    np.testing.assert_allclose(twist, torque / tube, rtol=1e-12)


def test_free_ring_under_two_opposite_radial_forces():
    """Diameters change by (pi/4 - 2/pi) P r^3/EI along the forces, (1/2 - 2/pi) P r^3/EI across."""
    thickness = 1e-3 * RADIUS
    quarters = np.pi / 2.0 * np.arange(4)
    found = compliance(ring(thickness, 1e-16, 0.0), loads(quarters, 0.0, 1.0))
    unit = RADIUS**3 / section(thickness)[1]
    moved = found[:, 0] + found[:, 2]
    assert (moved[0] + moved[2]) / unit == pytest.approx(np.pi / 4.0 - 2.0 / np.pi, rel=1e-5)
    assert (moved[1] + moved[3]) / unit == pytest.approx(0.5 - 2.0 / np.pi, rel=1e-5)


def test_soft_cup_lets_the_ring_move_as_a_rigid_body():
    """Translation against pi r k_v and rotation against 2 pi r^3 k_v; neither asks for the height."""
    wall = 1e-13
    angle, along, out, height = (np.asarray(x)[:, 0] for x in jax.tree.leaves(MIXED))
    found = compliance(ring(wall=wall, support=0.0), MIXED)
    direction = np.exp(1j * angle) * (out + 1j * along)
    moved = np.real(direction[:, None] * np.conj(direction))
    turned = along * (1.0 + height / RADIUS)
    rigid = moved + turned[:, None] * turned / 2.0
    unit = np.pi * RADIUS * cup_stiffness(wall)
    np.testing.assert_allclose(found * unit, rigid, atol=1e-6)


def by_energy(ring, loads, waves):
    """The same by minimising the energy, integrated numerically, over the same functions."""
    EA, EI = section(float(ring.thickness))
    number = np.arange(waves + 1.0)
    grid = 2.0 * np.pi * np.arange(4 * waves) / (4 * waves)

    def functions(phi, order):
        """Derivatives of cos(n phi), n >= 0, and sin(n phi), n >= 1."""
        turn = number**order * np.exp(1j * (number * phi[:, None] + order * np.pi / 2.0))
        return np.concatenate([turn.real, turn.imag[:, 1:]], axis=1)

    none = np.zeros_like(functions(grid, 0))
    w, v = ([functions(grid, order) for order in range(3)] for _ in range(2))
    strain = np.concatenate([w[0], v[1]], axis=1) / RADIUS
    bend = np.concatenate([w[2], -v[1]], axis=1) / RADIUS**2
    out, along = np.concatenate([w[0], none], axis=1), np.concatenate([none, v[0]], axis=1)
    springs = ((EA, strain), (EI, bend), (float(ring.support_stiffness), out))
    springs += ((cup_stiffness(float(ring.wall_thickness)), along),)
    step = RADIUS * 2.0 * np.pi / grid.size
    matrix = sum(stiffness * step * part.T @ part for stiffness, part in springs)
    angle, tangential, radial, height = (np.asarray(x)[:, :1] for x in jax.tree.leaves(loads))
    at = [functions(angle[:, 0], order) for order in range(2)]
    by_w = radial * at[0] - tangential * height / RADIUS * at[1]
    by_v = tangential * (1.0 + height / RADIUS) * at[0]
    work = np.concatenate([by_w, by_v], axis=1)
    return work @ np.linalg.solve(matrix, work.T)


@pytest.mark.parametrize("support", [0.0, 1e7, 1e10])
def test_agrees_with_the_least_energy_of_the_same_functions(support):
    of_ring = ring(support=support)
    found = compliance(of_ring, MIXED, 20)
    expected = by_energy(of_ring, MIXED, 20)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_ring_on_a_rigid_support_is_a_bar_held_by_the_cup():
    """v of a tangential force: cosh(k (pi - |phi|))/(2 r c k sinh(k pi)), k^2 = k_v/c."""
    angle = np.linspace(0.0, np.pi, 7)
    EA, EI = section()
    bar = EA / RADIUS**2 + EI / RADIUS**4
    decay = np.sqrt(cup_stiffness() / bar)
    shape = np.cosh(decay * (np.pi - angle)) / np.sinh(decay * np.pi)
    expected = shape / (2.0 * RADIUS * bar * decay)
    errors = {}
    for waves in (50, WAVES, 200):
        found = compliance(ring(), loads(angle, 1.0, 0.0), waves)[:, 0]
        errors[waves] = found / expected - 1.0
    assert np.abs(errors[WAVES][1:]).max() < 1e-4
    # Under the force itself the series converges like one over the number of waves.
    assert -0.02 < errors[WAVES][0] < -0.002
    assert errors[50][0] / errors[WAVES][0] == pytest.approx(2.0, rel=0.03)
    assert errors[WAVES][0] / errors[200][0] == pytest.approx(2.0, rel=0.03)


def test_radial_forces_do_not_move_a_rigid_support():
    found = compliance(ring(), loads(TEETH, 0.0, -1.0))
    np.testing.assert_array_equal(found, 0.0)


@pytest.mark.parametrize("support", [0.0, 1e9, np.inf])
def test_symmetric_and_positive_semidefinite(support):
    found = compliance(ring(support=support), MIXED)
    np.testing.assert_array_equal(found, found.T)
    values = np.linalg.eigvalsh(found)
    assert values.min() > -1e-14 * values.max()
    assert np.all(np.diag(found) > 0.0)


def test_stiff_support_tends_to_the_rigid_one():
    rigid = compliance(ring(), MIXED)
    apart = [np.abs(compliance(ring(support=s), MIXED) - rigid).max() for s in (1e15, 1e17)]
    assert apart[0] / apart[1] == pytest.approx(100.0, rel=0.01)
    assert apart[1] < 1e-5 * rigid.max()


@pytest.mark.parametrize(("support", "under", "beside"), [(1e10, 0.1, 0.012), (np.inf, 5e-3, 5e-4)])
def test_more_waves_only_add_compliance_near_the_force(support, under, beside):
    """The moment of a force above the neutral line converges slowest; a rigid support takes it."""
    of_ring = ring(support=support)
    found, longer = (compliance(of_ring, MIXED, waves) for waves in (WAVES, 10 * WAVES))
    assert np.linalg.eigvalsh(longer - found).min() > -1e-14 * longer.max()
    missing = np.abs(longer - found) / longer.max()
    assert np.diag(missing).max() < under
    assert missing[~np.eye(len(missing), dtype=bool)].max() < beside


def test_batches_and_derivatives():
    angle = MIXED.angle[..., None] + jnp.asarray([0.0, 0.4])
    batch = replace(MIXED, angle=angle)
    both = compliance(
        ring(), jax.tree.map(lambda x: jnp.broadcast_to(x.reshape(20, 1, -1), (20, 1, 2)), batch)
    )
    # A ring looks the same from everywhere.
    np.testing.assert_allclose(both[..., 0], both[..., 1], rtol=1e-9, atol=1e-12 * both.max())
    np.testing.assert_allclose(both[..., 0], compliance(ring(), MIXED), rtol=1e-12)

    @jax.jit
    def total(thickness, support):
        of_ring = replace(ring(), thickness=thickness, support_stiffness=support)
        return jnp.sum(ring_compliance(of_ring, STEEL, MIXED) ** 2)

    slope_of = jax.jit(jax.grad(total))
    for support in (jnp.asarray(jnp.inf), jnp.asarray(1e9)):
        slope = float(slope_of(jnp.asarray(THICKNESS), support))
        step = 1e-5 * THICKNESS
        moved = [
            float(total(jnp.asarray(THICKNESS + sign * step), support)) for sign in (1.0, -1.0)
        ]
        assert slope == pytest.approx((moved[0] - moved[1]) / (2.0 * step), rel=1e-6)
