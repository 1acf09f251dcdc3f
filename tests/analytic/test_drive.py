"""Two meshes on one shaft: torques, losses, loads on its bearings, stiffness at the output."""

import dataclasses
from functools import cache

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.drive import chained, drive_cycle
from pitchpoint.efficiency.drive_summary import mean_friction_of_drive
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS
from pitchpoint.efficiency.mesh_link import MeshLink
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle, extremes
from pitchpoint.efficiency.running_torque import torques_at_rest_of_drive
from pitchpoint.efficiency.summary import mean_friction
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.reactions import Bearing
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

CONSTANT = next(law for law in LAWS if law.name == "constant")
STEEL = solids.find("steel").build()
OIL = lubricants.find("pao-vg-220").build()
RATIO = (61 / 23) * (70 / 19)
POINT = Operation(*map(jnp.asarray, (300.0, 150.0, 330.0)))


def design(teeth, module, **options):
    pair = build_cylindrical_pair(
        teeth=teeth, module=module, pressure_angle=np.deg2rad(20.0), face_width=0.02, **options
    )
    return Design(pair, (STEEL, STEEL), OIL, Roughness.from_composite_rq(0.4e-6))


@cache
def stage_1():
    return MeshLink(design((23, 61), 2e-3), (0, 1))


@cache
def stage_2():
    """Gear 2 turns clockwise, and so does gear 3 on its shaft: it pushes with its right flanks."""
    made = design((19, 70), 3e-3, right_flank=True)
    return MeshLink(made, (1, 2), place=jnp.asarray(0.06))


def models(mu, sharing="equal", compliance="beam_hertz"):
    own = {"constant": {"coefficient": jnp.asarray(mu)}}
    terms = terms_of(compliance)
    rolling = ROLLING_RESISTANCE["none"]
    return Models((CONSTANT,), jnp.asarray(0), own, LOAD_SHARING[sharing], rolling, terms)


@eqx.filter_jit
def answers(drive, point, mu):
    laws = [models(mu)] * len(drive.links)
    found = drive_cycle(drive, point, laws, nodes=4, few=None)
    lost = [jnp.squeeze(one.loss) for one in found.states]
    return {
        "input": jnp.squeeze(found.input_torque),
        "lost": sum(one[(..., *[None] * k)] for k, one in enumerate(lost)),
        "out": jnp.squeeze(found.states[-1].output_power)[(..., *[None] * (len(lost) - 1))],
        "mean_input": found.mean_input_torque,
        "losses": found.mean_losses,
        "efficiency": found.mean_efficiency,
        "ripple": found.ripple,
        "locked": found.locked,
        "code": found.status.code,
        "force": [jnp.squeeze(one.balance.force) for one in found.states],
        "drag": jnp.squeeze(found.states[0].balance.drag),
    }


def solved(drive, mu, point=POINT):
    return jax.tree.map(np.asarray, answers(drive, point, jnp.asarray(mu)))


@cache
def both():
    return chained([stage_1(), stage_2()])


def test_without_losses_the_torque_is_that_of_the_ratio():
    found = solved(both(), 0.0)
    np.testing.assert_allclose(found["input"], 300.0 / RATIO, rtol=1e-12)
    assert float(found["efficiency"]) == pytest.approx(1.0, rel=1e-12)
    assert float(found["ripple"]) < 1e-12
    np.testing.assert_allclose(both().ratios, [1.0, 23 / 61, 1.0 / RATIO], rtol=1e-14)


def test_torque_route_equals_loss_route_at_every_meeting_of_phases():
    found = solved(both(), 0.06)
    put_in = found["input"] * 150.0
    assert found["input"].shape == (12, 12)
    rounding = 1e-14 * put_in.max()
    np.testing.assert_allclose(put_in - found["out"], found["lost"], rtol=1e-10, atol=rounding)
    assert not found["locked"]
    assert found["code"] == 0
    each = np.ptp(found["input"], axis=0).max(), np.ptp(found["input"], axis=1).max()
    assert found["ripple"] > max(each), "both stages have a part in the ripple"
    power = 300.0 * 150.0 / RATIO
    assert float(found["efficiency"]) == pytest.approx(power / (power + found["losses"].sum()))


@eqx.filter_jit
def alone(design, point, mu):
    found = cycle(design, point, models(mu), nodes=4)
    return found.mean_input_torque, found.mean_efficiency, found.ripple


def test_one_stage_is_a_mesh_cycle():
    found = solved(chained([stage_1()]), 0.06)
    torque, efficiency, _ = alone(stage_1().design, POINT, jnp.asarray(0.06))
    assert float(found["mean_input"]) == pytest.approx(float(torque), rel=1e-13)
    assert float(found["efficiency"]) == pytest.approx(float(efficiency), rel=1e-13)


def test_with_a_constant_coefficient_efficiencies_multiply():
    """Losses are in proportion to the load then, whatever the phase of the other stage."""
    found = solved(both(), 0.06)
    _, first, _ = alone(stage_1().design, POINT, jnp.asarray(0.06))
    slow = dataclasses.replace(POINT, speed=POINT.speed * 23 / 61)
    _, second, _ = alone(stage_2().design, slow, jnp.asarray(0.06))
    assert float(found["efficiency"]) == pytest.approx(float(first * second), rel=1e-12)


def bearing(shaft, place, other, **options):
    seat = Bearing(shaft, jnp.asarray(place), jnp.asarray(other), **options)
    return Drag(
        np.eye(3)[shaft],
        bearing=BEARING_LOSS["palmgren_1959"],
        mean_diameter=0.05,
        factors={"f0": 0.0, "f1": 1e-3},
        seat=seat,
    )


@pytest.mark.parametrize("turn", [0.0, np.pi / 2.0, np.pi])
def test_bearings_of_the_middle_shaft_bear_both_meshes(turn):
    """Torque of the bearings over f1 d_m is the sum of their loads, which follow by hand."""
    places = -0.03, 0.1
    second = dataclasses.replace(stage_2(), turn=jnp.asarray(turn))
    drag = [bearing(1, *places), bearing(1, *places[::-1], thrust=False)]
    found = solved(chained([stage_1(), second], drag), 0.0)
    angle = np.deg2rad(20.0)
    # On gear 2 the force pushes on; gear 3 is pushed back, by its right flank.
    own = found["force"][0][..., None] * [np.sin(angle), np.cos(angle)]
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    other = -turned @ [np.sin(angle), -np.cos(angle)]
    beside = found["force"][1][:, None, None] * other
    span = places[1] - places[0]
    parts = [
        own * (places[1] - 0.0) / span + beside * (places[1] - 0.06) / span,
        own * (0.0 - places[0]) / span + beside * (0.06 - places[0]) / span,
    ]
    loads = sum(np.linalg.norm(part, axis=-1) for part in parts)
    np.testing.assert_allclose(np.abs(found["drag"][1]), 1e-3 * 0.05 * loads, rtol=1e-11)


def test_the_output_drives_backwards():
    back = both().driven_backwards()
    assert back.ends == ((2, 1), (1, 0))
    point = Operation(*map(jnp.asarray, (300.0 / RATIO, 150.0 / RATIO, 330.0)))
    smooth = solved(back, 0.0, point)
    np.testing.assert_allclose(smooth["input"], 300.0, rtol=1e-12)
    rough = solved(back, 0.06, point)
    assert 0.95 < float(rough["efficiency"]) < float(smooth["efficiency"])


def seal(shaft, torque):
    return Drag(np.eye(3)[shaft], seal_torque=torque)


def test_seals_of_all_shafts_are_what_starts_a_drive_without_friction():
    drive = chained([stage_1(), stage_2()], [seal(0, 0.1), seal(1, 0.2), seal(2, 0.5)])
    idle = Operation(*map(jnp.asarray, (0.0, 1e-3, 330.0)))
    laws = [models(0.0)] * 2
    first = 0.1 + 0.2 * 23 / 61 + 0.5 / RATIO
    assert float(torques_at_rest_of_drive(drive, idle, laws)[1]) == pytest.approx(first, rel=1e-12)
    back = torques_at_rest_of_drive(drive.driven_backwards(), idle, laws)[1]
    assert float(back) == pytest.approx(first * RATIO, rel=1e-12)


def test_stages_that_do_not_follow_each_other():
    with pytest.raises(
        InputError, match="stage 2 is driven by shaft 3, and the stage before it loads"
    ):
        chained([stage_1(), dataclasses.replace(stage_2(), shafts=(2, 3))])
    wrong = MeshLink(design((19, 70), 3e-3), (1, 2))
    with pytest.raises(
        InputError, match="stage 2 turns its first shaft against the stage before it"
    ):
        chained([stage_1(), wrong])
    with pytest.raises(InputError, match="stage 2 has 2 bodies that move, and shafts"):
        chained([stage_1(), dataclasses.replace(stage_2(), shafts=(1,))])
    with pytest.raises(InputError, match="at least one stage"):
        chained([])
    with pytest.raises(InputError, match="1 models were given for 2 stages"):
        drive_cycle(both(), POINT, [models(0.0)])
    with pytest.raises(InputError, match="between shafts that no stage of the drive has in common"):
        chained([stage_1(), stage_2()], [Drag([1.0, 0.0, -1.0], seal_torque=0.1)])


@pytest.mark.whole
def test_a_loss_between_two_shafts_of_a_stage_is_overcome_by_that_stage():
    """Torque times the difference of speeds; the shafts of an external pair turn against each other."""
    braked = chained([stage_1(), stage_2()], [Drag([0.0, 1.0, -1.0], seal_torque=0.1)])
    found, free = solved(braked, 0.0), solved(both(), 0.0)
    lost = 0.1 * 150.0 * (23 / 61 + 1.0 / RATIO)
    np.testing.assert_allclose(found["losses"], [0.0, lost], rtol=1e-12, atol=1e-12)
    own = dataclasses.replace(stage_2().design, drag=(Drag([1.0, -1.0], seal_torque=0.1),))
    same = solved(chained([stage_1(), dataclasses.replace(stage_2(), design=own)]), 0.0)
    np.testing.assert_allclose(same["input"], found["input"], rtol=1e-14)
    assert np.all(found["input"] > free["input"])


XU = next(law for law in LAWS if law.name == "xu_2007")
BEARINGS = [bearing(1, -0.03, 0.1), bearing(1, 0.1, -0.03), bearing(2, 0.03, 0.15)]


@eqx.filter_jit
def every_figure(drive, few):
    """Of three stages under a law that asks for the load; extremes of all meetings, phase by phase."""
    points = jax.tree.map(lambda value: value * jnp.asarray([1.0, 0.95]), POINT)
    laws = [dataclasses.replace(models(0.0), friction=(XU,), parameters={})] * 3
    found = drive_cycle(drive, points, laws, nodes=4, few=few)
    low, high = found.extremes(found.input_torque)
    if few is None:
        low = high = found.input_torque.reshape(2, *[one.size for one in found.weights[::-1]])
        for _ in range(3):
            low = extremes(low, 4, smooth=True)[0]
            high = extremes(high, 4, smooth=True)[1]
    force = [found.mean(mean_friction(one), k) for k, one in enumerate(found.states)]
    return {
        "means": [found.mean_input_torque, found.mean_efficiency, *found.mean_losses, *force],
        "friction": mean_friction_of_drive(found),
        "pressed": [found.mean(load, k) for k, on in enumerate(found.pressed) for load in on],
        "ends": [low, high],
        "error": found.meeting_error,
        "count": sum(one.input_torque.size for one in found.states),
    }


@pytest.mark.whole
@pytest.mark.parametrize("drag", [[], BEARINGS], ids=["alone", "bearings"])
def test_few_loads_stand_for_all_meetings_of_three_stages(drag):
    drag = [dataclasses.replace(one, between=jnp.append(one.between, 0.0)) for one in drag]
    third = MeshLink(design((17, 55), 4e-3), (2, 3), place=jnp.asarray(0.12), turn=jnp.asarray(1.0))
    drive = chained([stage_1(), stage_2(), third], drag)
    few, every = (jax.tree.map(np.asarray, every_figure(drive, few)) for few in (5, None))
    assert few["count"] < every["count"] / (2 if drag else 6)
    for name in ("means", "friction", "pressed"):
        np.testing.assert_allclose(few[name], every[name], rtol=1e-8, atol=1e-12, err_msg=name)
    np.testing.assert_allclose(few["ends"], every["ends"], rtol=1e-5)
    lost, all_lost = (np.sum(one["means"][2:5], axis=0) for one in (few, every))
    assert np.all(np.abs(lost / all_lost - 1.0) <= few["error"])
    assert np.all((few["error"] > 0.0) & (few["error"] < 1e-6))
    assert not every["error"].any()
