"""Losses beside the teeth: Palmgren's torque by hand, the balance with drag, running and starting."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

from pitchpoint import citations
from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.bearing_loss import palmgren_1959
from pitchpoint.efficiency.breakaway import dry_and_viscous
from pitchpoint.efficiency.drag import Drag, at_rest
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS, BREAKAWAY
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state
from pitchpoint.efficiency.running_torque import no_load_torque, torques_at_rest
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.reactions import Bearing
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
OIL = lubricants.find("pao-vg-220").build()
PALMGREN = BEARING_LOSS["palmgren_1959"]
LAW = {law.name: law for law in LAWS}
CHOICES = ("constant", "iso_tr_14179_2")
FRICTION = tuple(LAW[name] for name in CHOICES)
PHASE = jnp.linspace(0.03, 0.97, 11)
RPM = 2.0 * np.pi / 60.0


def supported():
    return build_cylindrical_pair(
        teeth=(18, 36),
        module=3e-3,
        pressure_angle=np.deg2rad(20.0),
        face_width=26.7e-3,
    )


MESH = supported()
BASE = np.asarray(MESH.base_radii)


def bearing(row, between=None, *, f0=2.0, f1=1e-3, preload=50.0, **others):
    return Drag(
        between=np.eye(2)[row] if between is None else between,
        bearing=PALMGREN,
        mean_diameter=0.06,
        factors={"f0": f0, "f1": f1},
        preload=preload,
        seat=Bearing(row),
        **others,
    )


def design(*drag, mesh=MESH):
    return Design(mesh, (STEEL, STEEL), OIL, Roughness.from_composite_rq(0.8e-6), drag)


def usual(mesh=MESH, **others):
    """One set of places for every test, so that few programs are compiled."""
    return design(bearing(0, **others), bearing(1, f0=3.0, seal_torque=0.2), mesh=mesh)


def models(mu=0.06, law="constant", rolling="none"):
    own = {"constant": {"coefficient": jnp.asarray(mu)}}
    sharing, resistance = LOAD_SHARING["equal"], ROLLING_RESISTANCE[rolling]
    return Models(FRICTION, jnp.asarray(CHOICES.index(law)), own, sharing, resistance)


def local_models(mu=0.06):
    """One law alone: for a contact without pitch point, and quick to compile."""
    return dataclasses.replace(models(mu), friction=FRICTION[:1])


def operation(load=159.0, speed=157.0, temperature=328.15):
    return Operation(*map(jnp.asarray, (load, speed, temperature)))


@eqx.filter_jit
def answers(design, operation, models, quick=False):
    found = state(design, operation, PHASE, models, quick=quick)
    balance = found.balance
    return {
        "torque": balance.torque,
        "drag": balance.drag,
        "force": balance.force,
        "frictionless": balance.frictionless,
        "friction": balance.friction,
        "residual": balance.residual,
        "locked": balance.locked,
        "loss": found.loss,
        "drag_loss": found.drag_loss,
        "power_in": found.input_power,
        "power_out": found.output_power,
        "input_torque": found.input_torque,
        "efficiency": found.efficiency,
    }


def at(design, operation, models, quick=False):
    return jax.tree.map(np.asarray, answers(design, operation, models, quick))


def by_hand(nu, rpm, diameter, load, f0, f1):
    """Printed form and units: mm2/s, 1/min, mm, N; N mm."""
    product = nu * rpm
    viscous = 1e-7 * f0 * product ** (2 / 3) if product >= 2000.0 else 160e-7 * f0
    return viscous * diameter**3 + f1 * load * diameter


@pytest.mark.parametrize(
    ("nu", "rpm", "torque"),
    [(32.0, 1000.0, 50.1984), (32.0, 60.0, 29.0), (500.0, 0.0, 29.0), (500.0, 4.0, 28.9685)],
)
def test_palmgren_by_hand(nu, rpm, torque):
    found = 1e3 * palmgren_1959(
        speed=rpm * RPM,
        load=500.0,
        kinematic_viscosity=nu * 1e-6,
        mean_diameter=0.05,
        f0=2.0,
        f1=1e-3,
    )
    assert float(found) == pytest.approx(torque, rel=1e-5)
    assert float(found) == pytest.approx(by_hand(nu, rpm, 50.0, 500.0, 2.0, 1e-3), rel=1e-12)


def test_exponents_of_palmgren_and_the_step_where_its_branches_meet():
    given = dict(load=0.0, mean_diameter=0.05, f0=2.0, f1=1e-3)

    def viscous(rpm, nu=50e-6, **change):
        asked = {**given, **change}
        return float(palmgren_1959(speed=rpm * RPM, kinematic_viscosity=nu, **asked))

    assert np.log(viscous(800.0) / viscous(100.0)) / np.log(8.0) == pytest.approx(2 / 3, rel=1e-12)
    assert np.log(viscous(100.0, 4e-4) / viscous(100.0)) / np.log(8.0) == pytest.approx(2 / 3)
    assert viscous(800.0, mean_diameter=0.1) / viscous(800.0) == pytest.approx(8.0, rel=1e-12)
    assert viscous(-800.0) == viscous(800.0)
    step = viscous(39.999999) / viscous(40.000001)
    assert step == pytest.approx(160.0 / 2000.0 ** (2 / 3), rel=1e-7)
    assert step == pytest.approx(1.008, abs=1e-4)
    slope = jax.grad(lambda speed: palmgren_1959(speed=speed, kinematic_viscosity=50e-6, **given))
    assert float(slope(0.0)) == 0.0
    assert float(slope(100.0)) * 100.0 == pytest.approx(2 / 3 * viscous(100.0 / RPM), rel=1e-9)


def test_churning_follows_its_exponent_and_seals_do_not_care():
    drag = Drag(
        [1.0], seal_torque=0.1, churning_torque=0.3, churning_speed=100.0, churning_exponent=1.4
    )
    found = [
        float(drag.torque(speed=jnp.asarray(w), load=0.0, kinematic_viscosity=1e-4))
        for w in (0.0, 100.0, 200.0)
    ]
    np.testing.assert_allclose(found, [0.1, 0.4, 0.1 + 0.3 * 2.0**1.4], rtol=1e-14)


def test_registry_of_bearing_losses():
    assert [*BEARING_LOSS] == ["none", "palmgren_1959"]
    assert {key for model in BEARING_LOSS.values() for key in model.sources} <= {
        *citations.available()
    }
    with pytest.raises(InputError, match="did you mean palmgren_1959"):
        BEARING_LOSS["palmgren_1957"]
    with pytest.raises(InputError, match="'palmgren_1959' asks for f0, f1, got"):
        Drag([1.0, 0.0], bearing=PALMGREN, factors={"f0": 1.0})


@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize("load", [0.0, 0.5, 159.0])
@pytest.mark.parametrize("law", CHOICES)
def test_torque_route_equals_loss_route_with_drag(law, load, quick):
    found = at(usual(), operation(load), models(law=law), quick)
    lost = found["power_in"] - found["power_out"]
    np.testing.assert_allclose(lost, found["loss"], rtol=1e-12 * max(1.0, load))
    assert np.all(found["drag_loss"] > 0.0)
    assert np.all(found["loss"] > found["drag_loss"])
    assert np.all(found["residual"] < 1e-12)
    assert not found["locked"].any()


@pytest.mark.parametrize("load", [0.0, 159.0])
def test_teeth_carry_the_load_and_the_drag_of_the_driven_shaft(load):
    found = at(usual(), operation(load), models())
    np.testing.assert_allclose(np.abs(found["torque"][1]), load, atol=1e-12 * (load + 1.0))
    teeth = found["torque"] - found["drag"]
    np.testing.assert_allclose(teeth[1], load + np.abs(found["drag"][1]), rtol=1e-12)
    # The same teeth under that load and no drag are pressed alike, one phase at a time.
    plain = at(design(), operation(teeth[1]), models())
    np.testing.assert_allclose(plain["force"], found["force"], rtol=1e-12)
    np.testing.assert_allclose(plain["torque"], teeth, rtol=1e-12, atol=1e-12)


def test_drag_is_that_of_the_bearings_under_the_tooth_force():
    found = at(usual(), operation(), models())
    nu = 1e6 * float(OIL.kinematic_viscosity(328.15))
    for row, (rpm, f0, seal, sense) in enumerate(
        [(157.0 / RPM, 2.0, 0.0, 1.0), (78.5 / RPM, 3.0, 0.2, -1.0)]
    ):
        expected = [1e-3 * by_hand(nu, rpm, 60.0, 50.0 + f, f0, 1e-3) for f in found["force"]]
        np.testing.assert_allclose(found["drag"][row], sense * (np.asarray(expected) + seal), 1e-12)
    power = 157.0 * (found["drag"][0] - found["drag"][1] / 2.0)
    np.testing.assert_allclose(found["drag_loss"], power, rtol=1e-13)


@pytest.mark.parametrize("quick", [False, True])
def test_force_without_tooth_friction_in_closed_form(quick):
    drag = bearing(0, f0=0.0, f1=0.0), bearing(1, f0=0.0, f1=0.1, seal_torque=0.2)
    found = at(design(*drag), operation(40.0), models(mu=0.0), quick)
    idle = 0.2 + 0.1 * 50.0 * 0.06
    np.testing.assert_allclose(found["force"], (40.0 + idle) / (BASE[1] - 0.1 * 0.06), rtol=1e-12)
    np.testing.assert_allclose(found["frictionless"], (40.0 + idle) / BASE[1], rtol=1e-12)
    np.testing.assert_allclose(found["input_torque"], found["force"] * BASE[0], rtol=1e-12)


@pytest.mark.parametrize("quick", [False, True])
def test_a_bearing_that_takes_more_than_the_teeth_give_locks(quick):
    drag = bearing(0), bearing(1, f1=1.02 * BASE[1] / 0.06, seal_torque=0.2)
    found = at(design(*drag), operation(), models(mu=0.0), quick)
    assert found["locked"].all()
    for name in ("force", "torque", "drag", "loss", "efficiency"):
        assert np.isnan(found[name]).all()


def test_drag_that_takes_the_driven_shaft_along_relieves_the_teeth():
    # The same as between two shafts that turn the same way: the faster one drags the slower.
    def together(torque):
        between = [1.0, 1.0]
        return design(
            bearing(0, f0=0.0, f1=0.0), bearing(1, between, f0=0.0, f1=0.0, seal_torque=torque)
        )

    found = at(together(9.0), operation(159.0), models())
    np.testing.assert_allclose(found["torque"][1] - found["drag"][1], 150.0, rtol=1e-12)
    np.testing.assert_allclose(found["torque"][1], 159.0, rtol=1e-12)
    np.testing.assert_allclose(found["power_in"] - found["power_out"], found["loss"], rtol=1e-10)
    beyond = at(together(160.0), operation(159.0), models())
    assert np.isnan(beyond["force"]).all()
    assert not beyond["locked"].any()


def test_shafts_that_turn_together_do_not_brake_each_other():
    geared = [1.0, 2.0 * (1.0 + 1e-15)]  # at rest but for rounding
    drag = bearing(0, f0=0.0, f1=0.0), bearing(1, geared, seal_torque=7.0)
    found = at(design(*drag), operation(), models())
    assert np.all(found["drag"] == 0.0)


def test_twin_disc_with_a_braked_disc():
    disc = TwinDisc(jnp.asarray([0.02, 0.03]), jnp.asarray(0.008), jnp.asarray(0.8))
    braked = Drag([0.0, 1.0, 0.0], seal_torque=0.3, churning_torque=0.1, churning_speed=83.0)
    found = at(design(braked, mesh=disc), operation(600.0), local_models())
    rate = 157.0 * 0.8 * 2 / 3
    brake, friction = 0.3 + 0.1 * rate / 83.0, 0.06 * 600.0
    expected = np.broadcast_to([[friction * 0.02], [friction * 0.03 - brake], [600.0]], (3, 11))
    np.testing.assert_allclose(found["torque"], expected, rtol=1e-12)
    np.testing.assert_allclose(found["drag_loss"], brake * rate, rtol=1e-12)


def test_without_load_the_teeth_carry_the_drag_of_the_driven_shaft():
    found = at(usual(), operation(0.0), models())
    assert np.all(found["force"] > 0.0)
    assert np.all(np.isnan(found["efficiency"]))
    smooth = at(usual(), operation(0.0), models(mu=0.0))
    drag = smooth["drag"]
    np.testing.assert_allclose(smooth["input_torque"], drag[0] - drag[1] / 2.0, rtol=1e-12)
    assert np.all(found["input_torque"] - smooth["input_torque"] != 0.0)


def test_without_load_and_drag_of_the_driven_shaft_nothing_presses_the_teeth():
    drag = bearing(0), bearing(1, f0=0.0, f1=0.3, preload=0.0)
    found = at(design(*drag), operation(0.0), models())
    assert np.all(found["force"] == 0.0)
    assert np.all(found["friction"] == 0.0)
    np.testing.assert_allclose(found["input_torque"], found["drag"][0], rtol=1e-14)
    np.testing.assert_allclose(found["input_torque"] * 157.0, found["loss"], rtol=1e-14)
    assert np.all(found["loss"] > 0.0)
    assert not found["locked"].any()


def test_rolling_resistance_and_drag_together():
    found = at(usual(), operation(0.0), models(rolling="wu_cheng_1991"))
    lost = found["power_in"] - found["power_out"]
    np.testing.assert_allclose(lost, found["loss"], rtol=1e-12)
    assert np.all(found["residual"] < 1e-12)
    plain = at(usual(), operation(0.0), models())
    assert np.all(found["force"] > plain["force"])


@pytest.mark.whole
def test_derivatives_equal_differences():
    def torque(values, mesh):
        load, speed, f1, preload = values
        drag = bearing(0), bearing(1, f1=f1, preload=preload, seal_torque=0.2)
        point = Operation(load, speed, jnp.asarray(328.15))
        return state(design(*drag, mesh=mesh), point, jnp.asarray(0.8), law).input_torque

    law = dataclasses.replace(models(), friction=FRICTION[1:])
    values = jnp.asarray([12.0, 157.0, 0.02, 80.0])
    steps = jnp.concatenate([jnp.diag(values), -jnp.diag(values)]) * 1e-5
    found, slopes = eqx.filter_jit(jax.vmap(jax.value_and_grad(torque), (0, None)))(
        values + steps, MESH
    )
    central = (found[:4] - found[4:]) / (2e-5 * values)
    np.testing.assert_allclose((slopes[:4] + slopes[4:]).diagonal() / 2.0, central, rtol=1e-6)


def test_efficiency_rises_with_torque_and_falls_with_speed():
    loads, speeds = np.array([2.0, 10.0, 50.0, 250.0]), np.array([50.0, 150.0, 450.0])
    points = [(usual(), operation(load, speed)) for load in loads for speed in speeds]
    found = summarise(points, local_models())
    efficiency = found["mean_efficiency"].reshape(4, 3)
    assert np.all(np.diff(efficiency, axis=0) > 0.0)
    assert np.all(np.diff(efficiency, axis=1) < 0.0)
    part = (found["mean_drag_loss"] / found["mean_loss"]).reshape(4, 3)
    assert np.all((part > 0.0) & (part < 1.0))
    assert np.all(np.diff(part, axis=0) < 0.0)


def test_running_and_starting_torque_without_load():
    drag = bearing(0, breakaway_torque=0.4), bearing(1, f0=3.0, seal_torque=0.2)
    built, point = design(*drag), operation(speed=10.0)
    idle = dataclasses.replace(point, load=jnp.asarray(0.0))
    floor = [160e-10 * f0 * 60.0**3 + 1e-3 * 50.0 * 0.06 for f0 in (2.0, 3.0)]
    second = floor[1] + 0.2
    force = second / (BASE[1] - 1e-3 * 0.06)
    # The force presses both bearings; the torque of the teeth on gear 1 is half that on gear 2.
    first = floor[0] + 0.4 + 1e-3 * 0.06 * force
    smooth = local_models(0.0)
    assert float(torques_at_rest(built, idle, smooth)[1]) == pytest.approx(first + force * BASE[0])
    rough = float(torques_at_rest(built, idle, local_models())[1])
    assert rough > first + force * BASE[0]
    assert float(torques_at_rest(built, point, local_models())[1]) > rough + 159.0 / 2.0
    running = float(no_load_torque(built, point, smooth))
    nu = 1e6 * float(OIL.kinematic_viscosity(328.15))
    load_free = [
        1e-3 * by_hand(nu, n, 60.0, 50.0, f, 1e-3) for n, f in ((10 / RPM, 2), (5 / RPM, 3))
    ]
    force = (load_free[1] + 0.2) / (BASE[1] - 1e-3 * 0.06)
    assert running == pytest.approx(load_free[0] + 1e-3 * 0.06 * force + force * BASE[0], rel=1e-9)
    assert [place.resting for place in at_rest(drag)] == [True, True]


def test_back_driving_starts_against_the_breakaway_of_the_input():
    drag = bearing(0, f0=0.0, f1=0.0, breakaway_torque=0.4), bearing(1, f0=0.0, f1=0.0)
    idle = operation(0.0, 10.0)
    backwards = design(*drag).backwards
    smooth = float(torques_at_rest(backwards, idle, local_models(0.0))[1])
    assert smooth == pytest.approx(0.4 * 2.0, rel=1e-9)
    assert float(torques_at_rest(backwards, idle, local_models())[1]) > smooth


# ------------------------------------------------------------------ breakaway

HELD = BREAKAWAY["dry_and_viscous"]
FACTORS = {"dry": 15.0, "viscous": 5.0, "preload": 1.0}


def held(diameter=0.06, viscosity=100e-6, **factors):
    return float(
        dry_and_viscous(
            mean_diameter=diameter, kinematic_viscosity=viscosity, **{**FACTORS, **factors}
        )
    )


def test_breakaway_torque_by_hand():
    assert held() == pytest.approx((15.0 + 5.0) * 0.06**2, rel=1e-14)
    assert held(viscosity=800e-6) == pytest.approx((15.0 + 5.0 * 4.0) * 0.06**2, rel=1e-14)
    assert held(preload=2.5) == pytest.approx((37.5 + 5.0) * 0.06**2, rel=1e-14)


def test_breakaway_grows_with_the_square_of_the_size_and_a_power_of_the_viscosity():
    assert held(0.12) == pytest.approx(4.0 * held(), rel=1e-14)
    thin, thick = (held(viscosity=nu, dry=0.0) for nu in (20e-6, 3000e-6))
    assert np.log(thick / thin) / np.log(150.0) == pytest.approx(2.0 / 3.0, abs=1e-12)
    dry = {held(viscosity=nu, viscous=0.0) for nu in (20e-6, 3000e-6)}
    assert dry == {held(viscous=0.0)}


def test_a_model_of_breakaway_acts_at_rest_alone_and_as_its_torque_does():
    more = held(viscosity=float(OIL.kinematic_viscosity(328.15)))
    named = Drag([1.0, 0.0], mean_diameter=0.06, breakaway=HELD, breakaway_factors=FACTORS)
    point = {"speed": 3.0, "load": 0.0, "kinematic_viscosity": OIL.kinematic_viscosity(328.15)}
    assert float(named.torque(**point)) == 0.0
    assert float(at_rest([named])[0].torque(**point)) == pytest.approx(more, rel=1e-14)
    assert named.holds
    assert not Drag([1.0, 0.0], seal_torque=0.1).holds


def test_a_breakaway_model_asks_for_its_factors():
    with pytest.raises(InputError, match="'dry_and_viscous' asks for dry, viscous, preload"):
        Drag([1.0, 0.0], mean_diameter=0.06, breakaway=HELD, breakaway_factors={"dry": 1.0})


@pytest.mark.whole
def test_torque_without_load_grows_with_the_power_of_the_viscosity():
    """Where the lubricant alone brakes, down to the oil's lowest temperature."""
    degrees = jnp.linspace(float(OIL.T_min), 320.0, 9)
    points = Operation(jnp.zeros(9), jnp.full(9, 157.0), degrees)
    lubricant = {"f1": 0.0, "preload": 0.0}
    drag = bearing(0, **lubricant), bearing(1, **lubricant)
    torque = np.log(np.asarray(no_load_torque(design(*drag), points, local_models())))
    viscosity = np.log(np.asarray(OIL.kinematic_viscosity(degrees)))
    assert np.all(np.diff(torque) < 0.0)
    np.testing.assert_allclose(np.diff(torque) / np.diff(viscosity), 2.0 / 3.0, atol=1e-6)
