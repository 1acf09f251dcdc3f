"""Quasi-static efficiency against closed forms: loss factor, identities, exponents, limits."""

from functools import partial

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Cycle, Design, Models, Operation, State, cycle, state
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.period import nodes
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.friction_coefficient import xu_2007
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE, FrictionLaw
from pitchpoint.lubrication.rolling_resistance import wu_cheng_1991
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()

LAW = {law.name: law for law in LAWS}
MODULUS = 206e9 / 0.91


def faint_xu(
    *, pressure, slide_roll_ratio, entrainment, viscosity, radius, roughness_rq, factor=1e-6
):
    """Xu's coefficient made so small that the contact force does not feel it."""
    return factor * xu_2007(
        pressure=pressure,
        slide_roll_ratio=slide_roll_ratio,
        entrainment=entrainment,
        viscosity=viscosity,
        radius=radius,
        roughness_rq=roughness_rq,
    )


FAINT = FrictionLaw("faint_xu", "", faint_xu, (), ({}, 0.0))
CHOICES = ("constant", "iso_tr_14179_2", "xu_2007", "faint_xu")
FRICTION = (*(LAW[name] for name in CHOICES[:3]), FAINT)


def models(law="constant", mu=0.05, sharing="equal", rolling="none"):
    return Models(
        FRICTION,
        jnp.asarray(CHOICES.index(law)),
        {"constant": {"coefficient": jnp.asarray(mu)}},
        LOAD_SHARING[sharing],
        ROLLING_RESISTANCE[rolling],
    )


def disc_models(mu, rolling="none"):
    return Models(
        (LAW["constant"],),
        jnp.asarray(0),
        {"constant": {"coefficient": jnp.asarray(mu)}},
        LOAD_SHARING["equal"],
        ROLLING_RESISTANCE[rolling],
    )


@pytest.fixture(scope="module")
def design():
    mesh = build_cylindrical_pair(
        teeth=(18, 36), module=3e-3, pressure_angle=np.deg2rad(20.0), face_width=26.7e-3
    )
    return built(mesh)


def built(mesh):
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (STEEL, STEEL), oil, Roughness.from_composite_rq(0.8e-6))


def operation(load=159.0, speed=157.0, temperature=328.15):
    return Operation(*map(jnp.asarray, (load, speed, temperature)))


@eqx.filter_jit
def over_cycle(design, operation, models):
    found = cycle(design, operation, models)
    low, high = found.extremes(found.state.input_torque)
    return {
        "mean_loss": found.mean_loss,
        "ripple": found.ripple,
        "efficiency": found.state.efficiency,
        "mean_efficiency": found.mean_efficiency,
        "loss": found.state.loss,
        "input_power": found.state.input_power,
        "output_power": found.state.output_power,
        "mean_input_torque": found.mean_input_torque,
        "low": low,
        "high": high,
        "residual": found.residual,
        "jamming": found.jamming,
        "efficiency_ends": found.extremes(found.state.efficiency),
    }


@eqx.filter_jit
def at_phase(design, operation, phase, models):
    found = state(design, operation, phase, models)
    return {
        "efficiency": found.efficiency,
        "input_torque": found.input_torque,
        "loss": found.loss,
        "sliding": found.sliding_loss,
        "rolling": found.rolling_loss,
        "torque": found.balance.torque,
        "friction": found.balance.friction,
        "conditions": found.conditions,
        "ratio": found.contact_force_ratio,
        "jamming": found.balance.jamming,
        "locked": found.balance.locked,
    }


def loss_factor(design):
    """H_V of the textbooks, from tip circles in modules."""
    z1, z2 = np.asarray(design.mesh.teeth)
    cosine, sine = np.cos(np.deg2rad(20.0)), np.sin(np.deg2rad(20.0))
    e1, e2 = (
        (np.sqrt((z / 2 + 1) ** 2 - (z / 2 * cosine) ** 2) - z / 2 * sine) / (np.pi * cosine)
        for z in (z1, z2)
    )
    u = z2 / z1
    return np.pi * (u + 1) / (z1 * u) * (1 - (e1 + e2) + e1**2 + e2**2)


@pytest.mark.parametrize(("sharing", "expected"), [("equal", 0.18065), ("sanchez_2017", 0.17153)])
def test_loss_factor_as_friction_vanishes(design, sharing, expected):
    mu = 1e-7
    found = over_cycle(design, operation(), models(mu=mu, sharing=sharing))
    # The factor counts power per base tangent, as the loss of one period over mu.
    factor = float(found["mean_loss"]) / (mu * 159.0 * 157.0 / 2.0)
    assert factor == pytest.approx(expected, abs=5.1e-6)
    if sharing == "equal":
        assert factor == pytest.approx(loss_factor(design), rel=1e-6)


def test_extremes_do_not_run_beyond_kinks():
    phase, weight = jax.jit(lambda: [each.ravel() for each in nodes(jnp.zeros(1), 8)])()
    values = np.maximum(np.asarray(phase) - 0.55, 0.0)
    unread = object.__new__(State)

    @partial(jax.jit, static_argnames="smooth")
    def extremes(values, smooth):
        return Cycle(phase, weight, unread, 8, smooth=smooth).extremes(values)

    assert extremes(values, True)[0] < -1e-3
    low, high = extremes(np.stack([values, -values]), False)
    np.testing.assert_array_equal(low, [0.0, -values.max()])
    np.testing.assert_array_equal(high, [values.max(), 0.0])


def test_loss_is_linear_in_friction_to_first_order(design):
    def loss(mu):
        return float(over_cycle(design, operation(), models(mu=mu))["mean_loss"])

    small = loss(1e-6) / 1e-6
    away = [abs(loss(mu) / mu / small - 1.0) for mu in (1e-3, 2e-3)]
    assert away[0] < 1e-3
    # What remains is of second order: it grows with mu itself.
    assert away[1] / away[0] == pytest.approx(2.0, rel=0.05)


@pytest.mark.parametrize("law", ["constant", "iso_tr_14179_2", "xu_2007"])
@pytest.mark.parametrize("sharing", ["equal", "sanchez_2017"])
def test_efficiency_from_torques_equals_efficiency_from_losses(design, law, sharing):
    found = over_cycle(design, operation(), models(law, sharing=sharing))
    by_loss = 1.0 - np.asarray(found["loss"] / found["input_power"])
    np.testing.assert_allclose(found["efficiency"], by_loss, rtol=1e-12)
    by_output = np.asarray(found["output_power"] / (found["output_power"] + found["loss"]))
    np.testing.assert_allclose(found["efficiency"], by_output, rtol=1e-12)
    assert float(found["residual"]) < 1e-12
    assert float(found["mean_efficiency"]) < 1.0


@pytest.mark.parametrize("law", ["constant", "iso_tr_14179_2", "xu_2007"])
def test_nothing_is_lost_at_the_pitch_point(design, law):
    mesh = design.mesh
    phase = (mesh.pitch_position - mesh.limits[0]) / mesh.base_pitch
    found = at_phase(design, operation(), phase, models(law))
    assert float(found["efficiency"]) == pytest.approx(1.0, abs=1e-12)
    assert float(found["input_torque"]) == pytest.approx(159.0 / 2.0, rel=1e-12)


def exponent(design, law, **given):
    slow, fast = (
        float(over_cycle(design, operation(speed=n), models(law, **given))["ripple"])
        for n in (100.0, 400.0)
    )
    return np.log(fast / slow) / np.log(4.0)


def test_ripple_falls_with_speed_as_xu_has_it(design):
    assert exponent(design, "faint_xu") == pytest.approx(-0.100601, abs=1e-6)
    # At real friction the contact force takes part, which is of the order of mu.
    assert exponent(design, "xu_2007") == pytest.approx(-0.1006, abs=0.01)


def test_ripple_falls_with_speed_as_iso_has_it(design):
    factor = design.lubricant.lubricant_factor
    faint = eqx.tree_at(lambda d: d.lubricant.lubricant_factor, design, factor * 1e-6)
    assert exponent(faint, "iso_tr_14179_2") == pytest.approx(-0.2, abs=1e-6)
    assert exponent(design, "iso_tr_14179_2") == pytest.approx(-0.2, abs=0.01)


def test_frictionless_input_torque_is_smooth(design):
    found = over_cycle(design, operation(), models(mu=0.0))
    assert float(found["ripple"]) < 1e-12 * 159.0
    assert float(found["mean_input_torque"]) == pytest.approx(159.0 / 2.0, rel=1e-13)
    assert float(found["mean_efficiency"]) == pytest.approx(1.0, rel=1e-14)


def test_input_torque_of_one_pair_with_constant_friction(design):
    """Single contact: T1/T2 = (r_b1 -+ mu s)/(r_b2 -+ mu (N1N2 - s)) before and after the pitch point."""
    mesh, mu = design.mesh, 0.08
    length, pitch = float(mesh.tangent_length), float(mesh.pitch_position)
    r1, r2 = np.asarray(mesh.base_radii)
    for side in (-1.0, 1.0):
        position = pitch + side * 0.05 * float(mesh.base_pitch)
        phase = jnp.asarray((position - mesh.limits[0]) / mesh.base_pitch)
        found = at_phase(design, operation(), phase, models(mu=mu))
        levers = r1 + side * mu * position, r2 + side * mu * (length - position)
        assert float(found["input_torque"]) == pytest.approx(159.0 * levers[0] / levers[1], 1e-12)
        assert float(found["ratio"]) == pytest.approx(r2 / levers[1], rel=1e-12)
        assert float(found["input_torque"]) > 159.0 * r1 / r2


def test_friction_locks_where_the_leverage_of_the_force_vanishes(design):
    """Single contact before the pitch point: r_b2 - mu (N1N2 - s) is zero; after it friction pushes on."""
    mesh = design.mesh
    position = float(mesh.pitch_position - 0.05 * mesh.base_pitch)
    phase = jnp.asarray((position - mesh.limits[0]) / mesh.base_pitch)
    limit = float(mesh.base_radii[1]) / float(mesh.tangent_length - position)
    for part in (0.5, 0.96, 0.999, 1.0 - 2e-4):
        found = at_phase(design, operation(), phase, models(mu=part * limit))
        assert float(found["jamming"]) == pytest.approx(limit, rel=1e-12)
        assert not bool(found["locked"])
        assert float(found["ratio"]) == pytest.approx(1.0 / (1.0 - part), rel=1e-8)
    for part in (1.0 + 1e-6, 1.5):
        found = at_phase(design, operation(), phase, models(mu=part * limit))
        assert bool(found["locked"])
        assert np.isnan(found["input_torque"])
    behind = at_phase(design, operation(), 2.0 * pitch_phase(mesh) - phase, models(mu=0.05))
    assert np.isposinf(behind["jamming"])


def pitch_phase(mesh):
    return (mesh.pitch_position - mesh.limits[0]) / mesh.base_pitch


def test_the_coefficient_that_locks_a_period_is_the_smallest_of_its_phases(design):
    """Equal shares of the pairs in contact, by hand: 1/mu = max of the mean of (N1N2 - s) sense over r_b2."""
    mesh = design.mesh
    phase = np.linspace(0.0, 1.0, 4001)[:-1]
    start, end = np.asarray(mesh.limits)
    lines = start + (phase + np.arange(2.0)[:, None]) * float(mesh.base_pitch)
    active = lines <= end
    arms = (float(mesh.tangent_length) - lines) * np.sign(float(mesh.pitch_position) - lines)
    hold = (arms * active).sum(axis=0) / active.sum(axis=0) / float(mesh.base_radii[1])
    found = over_cycle(design, operation(), models())
    assert float(found["jamming"]) == pytest.approx(1.0 / hold.max(), rel=1e-3)
    assert float(found["jamming"]) <= 1.0 / hold.max() * (1.0 + 1e-9)


def test_no_load_loses_nothing(design):
    for law in ("constant", "iso_tr_14179_2", "xu_2007"):
        found = over_cycle(design, operation(load=0.0), models(law))
        assert float(found["mean_loss"]) == float(found["ripple"]) == 0.0
        assert float(found["mean_input_torque"]) == 0.0
        assert np.isnan([found["mean_efficiency"], *found["efficiency_ends"]]).all()
        assert np.all(np.isnan(found["efficiency"]))


def test_rolling_resistance_takes_power_without_sliding_friction(design):
    found = at_phase(
        design, operation(), jnp.asarray([0.3, 0.7, 0.9]), models(mu=0.0, rolling="wu_cheng_1991")
    )
    at = found["conditions"]
    active = np.asarray(at.contacts.active)
    force = wu_cheng_1991(
        line_load=at.line_load,
        entrainment=at.entrainment,
        viscosity=at.viscosity,
        pressure_viscosity=at.pressure_viscosity,
        radius=at.radius,
        modulus=at.modulus,
    )
    by_hand = np.asarray(force * 26.7e-3 * (at.speed_a + at.speed_b))[active]
    np.testing.assert_allclose(np.asarray(found["rolling"])[active], by_hand, rtol=1e-12)
    lost = np.asarray(found["input_torque"]) * 157.0 - 159.0 * 157.0 / 2.0
    np.testing.assert_allclose(lost, found["loss"], rtol=1e-10)
    assert np.all(lost > 0.0)


@pytest.mark.parametrize("ratio", [0.7, 1.0, 1.4])
def test_twin_disc_closed_form(ratio):
    disc = TwinDisc(jnp.asarray([0.02, 0.03]), jnp.asarray(0.008), jnp.asarray(ratio))
    found = at_phase(built(disc), operation(600.0), jnp.asarray(0.2), disc_models(0.06))
    u0, u1 = 157.0 * 0.02, 157.0 * 0.02 * ratio
    assert float(found["loss"]) == pytest.approx(0.06 * 600.0 * abs(u0 - u1), rel=1e-13)
    side = np.sign(u0 - u1)
    drag = 0.06 * 600.0 * side
    np.testing.assert_allclose(found["torque"], [drag * 0.02, drag * 0.03, 600.0], rtol=1e-13)
    pressure = np.sqrt(600.0 / 0.008 * MODULUS / (2 * np.pi * 0.012))
    assert float(found["conditions"].pressure[0, 0]) == pytest.approx(pressure, rel=1e-13)


def test_twin_disc_in_pure_rolling():
    disc = TwinDisc(jnp.asarray([0.02, 0.03]), jnp.asarray(0.008), jnp.asarray(1.0))
    found = at_phase(
        built(disc), operation(600.0), jnp.asarray(0.2), disc_models(0.0, "wu_cheng_1991")
    )
    at = found["conditions"]
    per_length = wu_cheng_1991(
        line_load=jnp.asarray(600.0 / 0.008),
        entrainment=jnp.asarray(157.0 * 0.02),
        viscosity=at.viscosity,
        pressure_viscosity=at.pressure_viscosity,
        radius=jnp.asarray(0.012),
        modulus=jnp.asarray(MODULUS),
    )
    expected = float(per_length) * 0.008
    # It brakes both discs, which turn against each other.
    np.testing.assert_allclose(found["torque"], [expected * 0.02, -expected * 0.03, 600.0])
    assert float(found["loss"]) == pytest.approx(2.0 * expected * 157.0 * 0.02, rel=1e-12)


def test_operating_points_together_equal_one_by_one(design):
    loads = jnp.asarray([20.0, 159.0, 400.0])
    many = Operation(loads, jnp.full(3, 157.0), jnp.full(3, 328.15))
    together = over_cycle(design, many, models("xu_2007"))["mean_loss"]
    alone = [over_cycle(design, operation(float(v)), models("xu_2007"))["mean_loss"] for v in loads]
    np.testing.assert_allclose(together, jax.tree.map(float, alone), rtol=1e-10)
