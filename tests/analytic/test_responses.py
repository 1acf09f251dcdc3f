"""Friction that a law, held numbers or a solver give; conditions from rates of the coordinates."""

import dataclasses
import math

import equinox as eqx
import numpy as np
import pytest
from budget import EVENT

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.core.status import Code, Status, status_summary
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle
from pitchpoint.efficiency.solved import solved_cycle
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.conditions import evaluate
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

LAW = {law.name: law for law in LAWS}
STEEL = solids.find("steel").build()
PAIR = build_cylindrical_pair(
    teeth=(23, 61), module=2e-3, pressure_angle=np.deg2rad(20.0), face_width=0.02
)
DESIGN = Design(
    PAIR,
    (STEEL, STEEL),
    lubricants.find("pao-vg-220").build(),
    Roughness.from_composite_rq(0.4e-6),
)
POINT = Operation(*map(jnp.asarray, (200.0, 150.0, 330.0)))


def models(law):
    parameters = {"constant": {"coefficient": jnp.asarray(0.05)}} if law == "constant" else {}
    sharing, rolling = LOAD_SHARING["equal"], ROLLING_RESISTANCE["none"]
    return Models((LAW[law],), jnp.asarray(0), parameters, sharing, rolling)


def slow_xu(*, pressure, slide_roll_ratio, entrainment, viscosity, radius, roughness_rq):
    """Xu's regression in plain Python, one contact after the other."""
    given = pressure, slide_roll_ratio, entrainment, viscosity, radius, roughness_rq
    return np.array([one_xu(*map(float, row)) for row in zip(*given, strict=True)])


def one_xu(pressure, slip, entrainment, viscosity, radius, roughness):
    giga, centipoise = pressure / 1e9, viscosity * 1e3
    if slip == 0.0:
        return 0.0
    heaviness = slip * giga * math.log10(centipoise)
    f = -8.916465 - 0.354068 * heaviness + 2.812084 * math.exp(-heaviness)
    f += 0.620305 * math.exp(roughness * 1e6)
    powers = giga**1.03303 * slip**1.036077 * entrainment**-0.100601
    return math.exp(f) * powers * centipoise**0.752755 * radius**-0.390958


@eqx.filter_jit
def by_law(law):
    return cycle(DESIGN, POINT, law)


def test_a_solver_in_plain_python_gives_what_the_formula_gives():
    found, status = solved_cycle(DESIGN, POINT, models("constant"), slow_xu)
    known = by_law(models("xu_2007"))
    assert Code(int(status.code)).ok
    assert 2 <= int(status.iterations) <= 12
    assert float(status.residual) <= 1e-6
    for name in ("mean_loss", "mean_input_torque", "mean_efficiency"):
        assert float(getattr(found, name)) == pytest.approx(float(getattr(known, name)), rel=1e-8)
    friction, expected = (np.asarray(one.state.balance.friction) for one in (found, known))
    assert expected.max() > 0.005
    np.testing.assert_allclose(friction, expected, rtol=2e-6, atol=1e-9)


def test_held_coefficients_are_compiled_once():
    programs = []
    jax.monitoring.register_event_duration_secs_listener(
        lambda event, *_, **__: programs.append(event) if event == EVENT else None
    )
    turns = []

    def wandering(*, pressure):
        turns.append(len(programs))
        return np.full(pressure.shape, 0.03 + 0.01 * (len(turns) % 3))

    _, status = solved_cycle(DESIGN, POINT, models("constant"), wandering, most=10)
    assert Code(int(status.code)) is Code.NOT_CONVERGED
    assert status_summary(status)["sentence"] == "the iteration ended without a solution"
    assert len(turns) == int(status.iterations) == 10
    assert turns[1] == turns[-1], f"a turn has compiled something: {turns}"


def test_a_solver_asks_for_conditions_of_these_contacts():
    with pytest.raises(InputError, match="'depth', which is no condition"):
        solved_cycle(DESIGN, POINT, models("constant"), lambda *, depth: depth)
    with pytest.raises(InputError, match="holds for elliptic contacts"):
        solved_cycle(DESIGN, POINT, models("constant"), lambda *, transverse_radius: 0.0)


def test_a_solver_that_locks_the_mesh_is_no_solution():
    found, status = solved_cycle(DESIGN, POINT, models("constant"), lambda *, pressure: 50.0)
    assert Code(int(status.code)) is Code.LOCKED
    assert np.isnan(float(found.mean_efficiency))


@pytest.mark.parametrize("answer", [-0.1, np.nan, [0.1, 0.2, 0.3]])
def test_what_are_no_coefficients(answer):
    with pytest.raises(InputError, match="one coefficient for each of 96 contacts, finite and not"):
        solved_cycle(DESIGN, POINT, models("constant"), lambda *, pressure: answer)


@eqx.filter_jit
def vibrating(phase, shaking, speed):
    """Conditions at a rate of gear 2 that is not the nominal one, and xu_2007 there."""
    contacts = PAIR.contacts(phase)
    load = jnp.where(contacts.active, 3000.0, 0.0)
    point = dataclasses.replace(POINT, speed=speed)
    rates = DESIGN.motion[:, None] * speed + jnp.stack([jnp.zeros_like(shaking), shaking])
    given = {"load": load, "nominal_load": jnp.asarray(3000.0)}
    at = DESIGN.conditions(contacts, point, **given, rates=rates)
    slip = contact_velocity(contacts.slip_arm, rates)
    return (
        at.sliding * 1.0,
        jnp.abs(slip),
        at.speed_a,
        evaluate(LAW["xu_2007"], at),
        contacts.active,
    )


def test_a_vibration_asks_the_same_laws_with_its_own_rates():
    phase, still = jnp.linspace(0.03, 0.97, 9), jnp.zeros(9)
    sliding, slip, _, usual, active = vibrating(phase, still, jnp.asarray(300.0))
    np.testing.assert_allclose(sliding, slip, rtol=1e-13, atol=1e-14)
    # Twice the speed is a vibration that adds the nominal rate once more, for laws of one contact.
    faster = DESIGN.motion[1] * 150.0 + still
    _, _, own, _, _ = vibrating(phase, faster, jnp.asarray(150.0))
    _, _, expected, _, _ = vibrating(phase, still, jnp.asarray(150.0))
    np.testing.assert_allclose(own, expected, rtol=1e-13)  # gear 1 turns as before
    shaken = vibrating(phase, 40.0 * jnp.sin(phase * 6.0), jnp.asarray(300.0))
    np.testing.assert_allclose(shaken[0], shaken[1], rtol=1e-12, atol=1e-13)
    touching = np.asarray(active)
    changed = np.asarray(shaken[3])[touching] / np.asarray(usual)[touching] - 1.0
    assert np.abs(changed).max() > 0.05


def test_a_status_says_the_worst_of_many():
    codes = jnp.array([Code.SOLVED, Code.LOCKED])
    told = status_summary(Status(codes, jnp.array([1e-14, 0.1]), jnp.array([3, 60])))
    assert told["code"] == Code.LOCKED
    assert told["residual"] == 1e-14
    assert told["iterations"] == 60
    assert told["sentence"].startswith("1 of 2: a solution was found; 1 of 2: friction locks")
