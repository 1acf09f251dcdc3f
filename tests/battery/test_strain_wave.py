"""What the battery asks of a strain wave gear alone: three rotations, clearances, a groove that is swept.

Positions alone say where flanks are and how they move; see `strain_wave_positions`.
"""

import dataclasses
from itertools import permutations
from types import SimpleNamespace
from unittest.mock import patch

import equinox as eqx
import numpy as np
import pytest
from sound import quick_first
from strain_wave_positions import drive

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.gears.strain_wave.design import InvoluteForm, build_strain_wave
from pitchpoint.gears.strain_wave.flexspline_tooth import DoubleArcFlank
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
CONSTANT = next(law for law in LAWS if law.name == "constant")
FORMS = {"double arc": DOUBLE_ARCS["flat"], "involute": InvoluteForm(3.32)}
SPEED = 100.0


def build(teeth=(200, 202), form=DOUBLE_ARCS["flat"], **options):
    options.setdefault("clearance", 0.35 if isinstance(form, InvoluteForm) else 0.25)
    return build_strain_wave(
        teeth=teeth, module=0.3e-3, face_width=0.01, rim_thickness=0.7e-3, form=form, **options
    )


PHASE = np.array([0.13, 0.42, 0.77])
MOVE = 1e-3


@eqx.filter_jit
def seen(mesh, phase):
    """Contacts with their arms after and before projection, of one search for the nearest points."""
    raw = mesh.raw_contacts(phase)
    with patch.object(type(mesh), "raw_contacts", lambda *_: raw):
        return mesh.contacts(phase), raw


@pytest.fixture(scope="module", params=quick_first(FORMS))
def passing(request):
    """Contacts of one zone, one row for each quantity, with the positions of their flanks."""
    form = FORMS[request.param]
    mesh = build(form=form)
    usual = design(mesh)
    phases = np.concatenate([PHASE - MOVE, PHASE, PHASE + MOVE])
    found, raw = jax.tree.map(np.asarray, seen(mesh, jnp.asarray(phases)))

    def zone(values, part=slice(3, 6)):
        picked = values[..., : mesh.lanes, 0, part]
        return picked.reshape(*picked.shape[:-2], -1)

    before, after = slice(0, 3), slice(6, 9)
    active = zone(found.active, before) & zone(found.active) & zone(found.active, after)
    by = drive(form)
    # The rounding of the mate's tips begins between two heights of the table.
    space = by.groove(float(mesh.groove.low))
    edge = float(mesh.tip_height + 1.1 * mesh.tips.rounding)
    height = by.place(found.flank[0], 2.0 * np.pi * found.path).real
    return SimpleNamespace(
        mesh=mesh,
        phases=phases,
        found=found,
        raw=raw,
        by=by,
        curvatures=by.curvatures(zone(found.flank[0]), 2.0 * np.pi * zone(found.path), space),
        active=active,
        above=height > edge,
        space=space,
        height=zone(height),
        inside=zone(height) > edge,
        angle=2.0 * np.pi * zone(found.path),
        along=zone(found.flank[0]),
        normal=zone(raw.normal),
        slip=zone(raw.slip_arm),
        surface=zone(found.surface),
        curvature=zone(found.curvature[:, 0]),
        gap=zone(found.gap),
        moved=zone(found.flank, after) - zone(found.flank, before),
        motion=np.asarray(usual.motion),
        period=float(usual.period),
    )


def test_arms_are_velocities_of_the_material_by_positions(passing):
    by, at = passing.by, passing
    smooth = at.active & by.smooth(at.along)
    assert smooth.sum() > 0.5 * at.active.sum()
    direction = np.exp(-1j * by.direction(at.along, at.angle, step=2e-7))
    expected = np.stack([by.velocity(at.along, at.angle, rates) for rates in np.eye(3)]) * direction
    size = np.abs(expected).max(axis=0)
    assert np.max(np.abs(at.normal - expected.imag)[:, smooth] / size[smooth]) < 1e-6
    assert np.max(np.abs(at.slip - expected.real)[:, smooth] / size[smooth]) < 1e-6


def test_a_rigid_circular_spline_turns_its_flanks_about_the_axis(passing):
    raw = passing.raw
    turned = np.stack([-raw.point[1], raw.point[0], np.zeros(raw.active.shape)])
    size = np.linalg.norm(turned, axis=0).max()
    closing = -np.einsum("x...,x...->...", turned, raw.direction)
    np.testing.assert_allclose(raw.normal[2], closing, atol=1e-12 * size)
    # Teeth of both zones press the flexspline inwards: their forces on it nearly cancel.
    pressed = np.where(raw.active, raw.direction, 0.0).sum(axis=(1, 2))
    assert np.abs(pressed).max() < 1e-9 * raw.active.sum()


def test_curvatures_are_second_derivatives_of_positions(passing):
    by, at = passing.by, passing
    own, mate, one = at.curvatures
    smooth = at.active & one & by.smooth(at.along, 2e-6) & at.inside
    smooth &= at.space.smooth(at.height, 1.3e-6)
    assert smooth.sum() >= 5, "hardly any tooth touches a smooth part of its mate"
    total = own[smooth] + mate[smooth]
    np.testing.assert_allclose(at.curvature[0, smooth], own[smooth], rtol=1e-6, atol=1e-2)
    error = np.abs(at.curvature.sum(axis=0)[smooth] - total)
    assert np.max(error / total) < 1e-3
    assert np.median(error / total) < 1e-4


def test_ridges_of_the_mate_are_as_round_as_they_are_made(passing):
    """Where parts of the groove meet that different phases sweep."""
    at = passing
    ridge = at.active & at.space.on_ridge(at.height)
    assert ridge.any() == isinstance(at.mesh.flank, DoubleArcFlank)
    bends = at.curvature[1, ridge]
    assert np.all(bends > 1.0 / at.by.made.ridge)
    assert np.all(bends < 0.5 / at.by.made.rounding)


def test_contact_of_touching_teeth_moves_along_both_flanks_as_it_rolls(passing):
    at, by = passing, passing.by
    one = at.curvatures[2]
    touching = at.active & at.inside & (at.gap < 1e-8)
    smooth = touching & one & by.smooth(at.along, np.abs(at.moved[0]) + 1e-6)
    smooth &= at.space.smooth(at.height, np.abs(at.moved[1]) + 1e-6)
    assert smooth.sum() >= 2
    speeds = np.tensordot(at.motion, at.surface, axes=(0, 1))
    ratio = at.moved[:, smooth] / speeds[:, smooth] / (2.0 * MOVE * at.period)
    for along_one, most, middle in zip(ratio, (9e-3, 0.3), (5e-5, 2e-3), strict=True):
        # Lengths on the groove are those of chords between its nodes.
        error = np.abs(along_one - np.sign(along_one[0]))
        assert error.max() < most  # beside a joint of the flank
        assert np.median(error) < middle


def test_turning_everything_together_moves_no_contact(passing):
    size = np.abs(passing.raw.normal).max()
    for arms in (passing.raw.normal, passing.found.normal, passing.found.slip_arm):
        assert np.abs(arms.sum(axis=0)).max() < 1e-13 * size


def test_teeth_that_touch_close_by_themselves_and_the_others_after_projection(passing):
    motion, active = passing.motion, passing.found.active
    size = np.asarray(contact_velocity(np.abs(passing.raw.normal), np.abs(motion)))[active]
    rigid = np.abs(contact_velocity(passing.raw.normal, motion))[active] / size
    touches = passing.found.gap[active] < 1e-12
    assert 2 <= touches.sum() < 0.9 * touches.size, "both kinds of teeth are needed"
    # Flanks whose curvature jumps where they touch have no one normal to the accuracy of a table.
    smooth = (passing.by.smooth(passing.found.flank[0]) & passing.above)[active]
    assert rigid[touches & smooth].max() < 1e-5
    assert np.median(rigid[touches & smooth]) < 1e-7
    assert rigid[~touches].max() > 1e-3
    projected = np.abs(contact_velocity(passing.found.normal, motion))[active] / size
    assert projected.max() < 1e-13


def test_places_beyond_the_pairs_stay_empty(passing):
    mesh, active = passing.mesh, passing.found.active
    places = np.arange(active.shape[0])
    held = in_pairs(mesh, places[:, None] + 1, 0)
    assert held.shape == (2 * int(mesh.held), 2)
    assert 2 * int(mesh.held) < 2 * mesh.lanes < active.shape[0]
    empty = np.setdiff1d(places, held[held > 0] - 1)
    assert not active[empty].any()
    assert active[held[:, 0] - 1].any()
    alike = in_pairs(mesh, passing.found.path, 0, like_first=True)
    np.testing.assert_array_equal(alike[:, 0], alike[:, 1])


@pytest.mark.parametrize("play", [1e-13, 1e-6])
def test_play_opens_every_pair_alike_from_the_first(passing, play):
    """Touching flanks too, whose clearance is rounding: cut off at zero, its sign would decide."""
    mesh, active = passing.mesh, passing.found.active
    wider = dataclasses.replace(mesh, backlash=array(play))
    opened = np.asarray(seen(wider, jnp.asarray(passing.phases))[0].gap) - passing.found.gap
    along, angle = passing.found.flank[0], 2.0 * np.pi * passing.found.path
    expected = play / 2.0 * np.cos(passing.by.direction(along, angle, step=2e-7))
    smooth = active & passing.by.smooth(along)
    assert np.any(smooth & (passing.found.gap == 0.0))
    np.testing.assert_allclose(opened[smooth], expected[smooth], rtol=1e-5, atol=1e-21)


def test_projection_leaves_the_law_of_the_drive(passing):
    """Arms in the ratio (z2 - z1) : z1 : -z2: what virtual work says of frictionless torques."""
    z1, z2 = np.asarray(passing.mesh.teeth)
    arms = passing.found.normal[:, passing.found.active]
    expected = np.array([z2 - z1, z1, -z2])[:, None] * (arms[2] / -z2)
    np.testing.assert_allclose(arms, expected, rtol=1e-9)


def design(mesh):
    return Design(
        mesh,
        (STEEL, STEEL),
        lubricants.find("pao-vg-220").build(),
        Roughness.from_composite_rq(0.4e-6),
    )


def models(coefficient):
    return Models(
        (CONSTANT,),
        jnp.asarray(0),
        {"constant": {"coefficient": jnp.asarray(coefficient)}},
        LOAD_SHARING["from_stiffness"],
        ROLLING_RESISTANCE["none"],
    )


@eqx.filter_jit
def through_the_chain(design, operation, models):
    found = cycle(design, operation, models, nodes=3)
    at = found.state
    return {
        "torque": at.balance.torque,
        "load": at.balance.load,
        "loss": at.loss,
        "input_torque": at.input_torque,
        "extremes": jnp.stack(found.extremes(at.input_torque)),
        "efficiency": at.efficiency,
        "mean_efficiency": found.mean_efficiency,
        "residual": found.residual,
        "locked": found.locked,
        "gap": at.contacts.gap,
        "active": at.contacts.active,
    }


DRIVES = {
    f"{fixed} fixed, {driver} drives": {"driver": driver, "loaded": loaded}
    for fixed, driver, loaded in permutations(MEMBERS)
} | {
    "involute": {"form": FORMS["involute"]},
    "odd number of teeth": {"teeth": (201, 203)},
    "four teeth more": {"teeth": (200, 204)},
}


@pytest.fixture(
    scope="module",
    params=[  # the last three are other structures to the compiler
        pytest.param(name, marks=[pytest.mark.whole] * ("fixed" not in name)) for name in DRIVES
    ],
)
def running(request):
    given = dict(DRIVES[request.param])
    ends = [given.pop(key) for key in ("driver", "loaded") if key in given]
    mesh = build(**given)
    drive = design(mesh).driven_by(*ends or MEMBERS[:2])
    carried = 0.2 if drive.loaded[0] else 20.0
    operation = Operation(*map(jnp.asarray, (carried, SPEED, 320.0)))
    smooth, rough = (
        SimpleNamespace(**jax.tree.map(np.asarray, through_the_chain(drive, operation, models(mu))))
        for mu in (0.0, 0.07)
    )
    motion, loaded = np.asarray(drive.motion), np.asarray(drive.loaded)
    return SimpleNamespace(
        mesh=mesh, smooth=smooth, rough=rough, carried=carried, motion=motion, loaded=loaded
    )


@pytest.mark.whole
def test_torques_follow_virtual_work_whichever_member_is_fixed(running):
    z1, z2 = np.asarray(running.mesh.teeth)
    torque = running.smooth.torque
    np.testing.assert_allclose(np.abs(running.loaded @ torque), running.carried, rtol=1e-12)
    expected = np.array([[z2 - z1], [z1], [-z2]]) * (torque[1] / z1)
    np.testing.assert_allclose(torque, expected, rtol=1e-9)


@pytest.mark.whole
def test_without_friction_nothing_is_lost(running):
    """Though teeth carry that had a clearance."""
    loaded = running.smooth.load > 0.0
    assert np.any(running.smooth.gap[loaded] > 1e-8)
    np.testing.assert_allclose(running.smooth.efficiency, 1.0, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(running.smooth.mean_efficiency, 1.0, rtol=0.0, atol=1e-12)
    assert np.all(running.smooth.loss == 0.0)


@pytest.mark.whole
def test_torque_route_equals_loss_route_with_loads_from_stiffness(running):
    found = running.rough
    power = running.motion @ found.torque * SPEED
    turnover = np.abs(running.motion) @ np.abs(found.torque) * SPEED
    assert np.all(found.loss > 1e-4 * turnover)
    assert np.all(np.abs(power - found.loss) <= 1e-12 * found.loss + 1e-15 * turnover)
    np.testing.assert_allclose(found.torque.sum(axis=0), 0.0, atol=1e-13 * turnover.max() / SPEED)
    assert found.residual < 1e-12
    assert np.all((found.efficiency > 0.0) & (found.efficiency < 1.0))


@pytest.mark.whole
def test_tooth_friction_alone_does_not_lock_the_drive(running):
    """Either way round: it takes a coefficient of more than a half."""
    assert not running.rough.locked
    assert running.rough.mean_efficiency > 0.5


@pytest.mark.whole
def test_extremes_are_those_of_the_nodes(running):
    """Pairs come and go between the events: a polynomial would run beyond what was computed."""
    torque = running.rough.input_torque
    np.testing.assert_array_equal(running.rough.extremes, [torque.min(), torque.max()])


@pytest.mark.whole
def test_many_pairs_carry_and_only_push(running):
    for found in (running.smooth, running.rough):
        carrying = found.load > 0.0
        assert np.all(found.load >= 0.0)
        assert not np.any(carrying & ~found.active)
        first, second = np.split(carrying.sum(axis=1), 2)
        assert np.all(first.sum(axis=0) >= 3)
        assert np.all(second.sum(axis=0) >= 3)
