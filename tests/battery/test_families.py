"""One battery of checks that every gear family passes."""

import dataclasses
from functools import cache, partial
from itertools import pairwise
from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest
from battery_families import (
    FAMILIES,
    INSIDE,
    LAW,
    LOCAL,
    contacts_of,
    design_for,
    differentiated,
    floats,
    laws_for,
    models_for,
    operation_for,
    properties,
    rolling_state,
)

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.efficiency.drag import Drag, at_rest, resistance
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS
from pitchpoint.efficiency.quasi_static import Operation, state
from pitchpoint.efficiency.running_torque import torques_at_rest
from pitchpoint.gears.pairs import ACTION, TURN, touching, way_of_pairs


@eqx.filter_jit
def each_alone(mesh, phase):
    return jax.lax.map(mesh.contacts, phase)


@eqx.filter_jit
def vectorised(mesh, phase):
    return jax.vmap(mesh.contacts)(phase)


@eqx.filter_jit
def frame(mesh, contacts):
    """Coordinates, and the velocity of the contacts' points with each of them."""
    bodies = mesh.coordinates
    return bodies, jnp.stack([body.velocity(contacts.point) for body in bodies])


@eqx.filter_jit
def states_alone(design, operation, phase, models):
    return jax.lax.map(lambda at: state(design, operation, at, models).balance.torque, phase)


def xu_alone(mesh):
    return dataclasses.replace(models_for(mesh), friction=(LAW["xu_2007"],))


FURTHER = (
    "23/61, high teeth",
    "17/17",
    "12/120",
    "ring 20/-60, wheel drives",
    "helical ring 18/-71, right flank",
    "helical rack",
    "strain wave 200/202, flexspline fixed",
    "strain wave 200/202, wave generator fixed",
    "strain wave 200/202, back-driving",
    "strain wave 200/204",
)
"""Of families that have others here; most are another structure to the compiler, some 10 s each."""


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(name, marks=[pytest.mark.whole] * (name in FURTHER), id=name)
        for name in FAMILIES
    ],
)
def family(request):
    """A mesh with its answers on a grid that crosses all events, and close beside each of them.

    On an event itself rounding decides which side it is: there only finite values are asked for.
    """
    made = FAMILIES[request.param]
    design = design_for(made)
    mesh = design.mesh
    told = SimpleNamespace(**{k: np.asarray(v) for k, v in properties(design).items()})
    events = np.resize(told.events, 3)
    phase = np.concatenate(
        [(np.arange(20) + 0.4) / 20.0, np.mod(np.append(events - 1e-7, events + 1e-7), 1.0)]
    )
    everywhere = jnp.asarray(np.concatenate([phase, events]))
    found = jax.tree.map(np.asarray, contacts_of(mesh, jnp.asarray(phase)))
    return SimpleNamespace(
        mesh=mesh,
        design=design,
        curves=made.curves,
        told=told,
        phase=phase,
        at=found,
        differentiated=cache(partial(differentiated, design, everywhere)),
    )


def states(family, law, rolling):
    """States on the grid; the events come last where they are differentiated as well."""
    if rolling == "none":
        found = family.differentiated(law)[2]
        grid = slice(family.phase.size)
        return {key: v[..., grid] if v.ndim else v for key, v in found.items()}
    given = (family.design, operation_for(family.design), jnp.asarray(family.phase))
    return jax.device_get(rolling_state(*given, models_for(family.mesh, law, rolling)))


def test_active_contacts_keep_touching_on_the_nominal_motion(family):
    closing = dot(family.told.motion, family.at.normal)
    size = dot(np.abs(family.told.motion), np.abs(family.at.normal)) + 1e-300
    assert family.at.active.any(axis=(0, 1)).all()
    assert np.max(np.abs(closing / np.maximum(size, 1e-6))[family.at.active]) < 1e-14


def test_contacts_have_the_shape_of_the_family(family):
    assert family.at.shape == family.mesh.shape


def test_sliding_is_the_difference_of_the_surface_speeds(family):
    motion = family.told.motion
    first, second = (np.asarray(contact_velocity(arms, motion)) for arms in family.at.surface)
    np.testing.assert_allclose(first, dot(motion, family.at.surface[0]), rtol=1e-14)
    slip, roll = dot(motion, family.at.slip_arm), dot(motion, family.at.roll_arm)
    # Coordinates may turn a hundred times as fast against each other as the contact sees.
    rounding = max(1e-16, 1e-15 * dot(np.abs(motion), np.abs(family.at.surface[0])).max())
    np.testing.assert_allclose(slip, first - second, rtol=1e-13, atol=rounding)
    np.testing.assert_allclose(roll, first + second, rtol=1e-13, atol=rounding)


def test_driver_moves_by_one_radian_and_load_is_on_another_coordinate(family):
    told = family.told
    assert abs(told.driver @ told.motion) == pytest.approx(1.0, rel=1e-15)
    assert told.driver @ told.loaded == 0.0
    assert np.sum(told.driver) == np.sum(told.loaded) == 1.0


def test_the_nominal_motion_keeps_the_relation_of_the_rates(family):
    factors, motion = np.asarray(family.mesh.relation), family.told.motion
    assert factors.shape == motion.shape
    assert np.any(factors)
    assert abs(factors @ motion) <= 1e-15 * np.abs(factors) @ np.abs(motion)


def test_arms_follow_from_places_and_directions_in_one_frame(family):
    at = family.at
    frames = np.stack([at.direction, at.tangent], axis=1)
    np.testing.assert_allclose(
        np.einsum("xk...,xl...->kl...", frames, frames),
        np.broadcast_to(np.eye(2).reshape(2, 2, 1, 1, 1), (2, 2, *at.active.shape)),
        atol=1e-14,
    )
    bodies, velocity = jax.tree.map(np.asarray, frame(family.mesh, at))
    assert {body.member for body in bodies} >= {0, 1}
    for k, body in enumerate(bodies):
        if body.member is None or not body.rigid:
            continue
        sense = 1.0 if body.member == 0 else -1.0
        closing, slip = (
            sense * np.einsum("x...,x...->...", velocity[k], vector)
            for vector in (at.direction, at.tangent)
        )
        size = np.linalg.norm(velocity[k], axis=0).max()
        if all(one.rigid for one in bodies):
            np.testing.assert_allclose(at.normal[k], closing, atol=1e-13 * size)
        np.testing.assert_allclose(at.slip_arm[k], slip, atol=1e-12 * size)


def dot(rates, arms):
    """Sum of rates times arms over the coordinates, which are the arms' first axis."""
    return np.tensordot(rates, arms, axes=1)


def check_energy(found):
    """Power that the external torques put in is the power lost, and no friction gives any back."""
    assert np.all(found["residual"] < 1e-12)
    assert not np.any(found["locked"])
    assert np.all(found["sliding_losses"] >= 0.0)
    assert np.all(found["loss"] >= 0.0)


ROLLING = {"line": "wu_cheng_1991", "ellipse": "wu_cheng_1991_strips"}


def test_torque_route_equals_loss_route(family):
    check_routes(family, LOCAL[:1])


@pytest.mark.whole
@pytest.mark.parametrize("rolls", [False, True], ids=["none", "rolling"])
def test_torque_route_equals_loss_route_by_every_law(family, rolls):
    check_routes(family, laws_for(family.mesh), ROLLING[family.at.shape] if rolls else "none")


def check_routes(family, laws, rolling="none"):
    operation = operation_for(family.design)
    for law in laws:
        found = states(family, law, rolling)
        check_energy(found)
        rates = family.told.motion * float(operation.speed)
        lost = dot(rates, found["torque"])
        turnover = dot(np.abs(rates), np.abs(found["torque"]))
        # At the pitch point nothing is lost: only rounding of the power that passes is left there.
        assert np.all(np.abs(lost - found["loss"]) <= 1e-12 * found["loss"] + 1e-14 * turnover), law
        between = found["input_power"] - found["output_power"]
        assert np.all(np.abs(between - found["loss"]) <= 1e-11 * turnover), law
        assert found["loss"].max() > 1e-4 * turnover.max()
        assert (found["rolling_loss"].max() > 0.0) == (rolling != "none")


LOSSES = {
    "bearing": {
        "bearing": BEARING_LOSS["palmgren_1959"],
        "mean_diameter": 0.04,
        "factors": {"f0": 2.0, "f1": 1e-3},
        "preload": 50.0,
    },
    "seal": {"seal_torque": 0.02},
    "churning": {"churning_torque": 0.03, "churning_speed": 100.0},
    "breakaway": {"breakaway_torque": 0.01},
}


@pytest.fixture(scope="module", params=["18/36", "strain wave 200/202"])
def braked(request):
    """A drive with a loss between its driver and the housing, at several speeds and temperatures."""
    own = design_for(FAMILIES[request.param])
    driver = own.driver * jnp.sign(own.driver @ own.motion)

    def design(kind):
        return dataclasses.replace(own, drag=(Drag(driver, **LOSSES[kind]),))

    shape = (2, 3)
    points = Operation(*(jnp.full(shape, value) for value in (0.0, 100.0, 330.0)))
    contacts = contacts_of(own.mesh, jnp.asarray(INSIDE))
    return SimpleNamespace(own=own, design=design, points=points, contacts=contacts)


@pytest.mark.parametrize("kind", LOSSES)
def test_every_kind_of_loss_alone_brakes_the_driver(braked, kind):
    drags = braked.design(kind).drag
    given = braked.own, braked.contacts
    for resting, each in ((False, drags), (True, at_rest(drags))):
        torque = resisted(each, *given, braked.points.speed[..., None])
        driven = dot(np.asarray(braked.own.driver * braked.own.motion), np.asarray(torque))
        assert driven.shape == (2, 3, 1)
        acts = kind in ("bearing", "seal", "breakaway" if resting else "churning")
        assert np.all(driven > 0.0) if acts else np.all(driven == 0.0)


@eqx.filter_jit
def resisted(drags, design, contacts, speed):
    """Torque of drags where the teeth carry nothing."""
    torque = resistance(
        drags,
        design.mesh,
        contacts,
        motion=design.motion,
        speed=speed,
        kinematic_viscosity=1e-4,
    )
    return torque(jnp.zeros(contacts.weight.shape))


@pytest.mark.parametrize("kind", LOSSES)
def test_every_kind_of_loss_alone_has_a_starting_torque(braked, kind):
    models = models_for(braked.own.mesh)
    (_, found) = eqx.filter_eval_shape(torques_at_rest, braked.design(kind), braked.points, models)
    assert found.shape == (2, 3)


STEPS = np.arange(-4, 5)


# Central differences of order eight for the second derivative.
SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])


def second_derivative(heights, step):
    return SECOND @ heights / step**2


@pytest.fixture(scope="module")
def curves(family):
    if family.curves is None:
        # Bent flanks are no curves of a rigid body, from which this road takes its contacts.
        pytest.skip(
            "its flanks are not here as curves; bent ones are looked at in test_strain_wave.py"
        )
    return family.curves(family.mesh)


def active_lanes(family):
    lanes = [*zip(*np.nonzero(family.at.active), strict=True)]
    assert len(lanes) >= len(family.phase), "there is a contact at every phase"
    yield from ((index, family.at.path[index]) for index in lanes)


@pytest.mark.parametrize("direction", [0, 1])
def test_curvature_is_the_second_derivative_of_the_gap(family, curves, direction):
    for index, path in active_lanes(family):
        section = curves.section(path, direction)
        step = 0.02 * section.size
        first, second = (section.height(member, STEPS * step) for member in (0, 1))
        gap = second - first
        assert abs(gap[4]) <= 1e-14 * section.scale, "the flanks do not touch"
        beside = np.delete(gap, 4)
        assert np.all(beside >= 0.0 if direction else beside > 0.0), "the flanks overlap"
        # Across the line of contact a gap in the transverse section is smaller by the cosine.
        members = [-second_derivative(first, step), second_derivative(second, step)]
        members = [curves.slope * one for one in members]
        rounding = max(1e-12, 10.0 * 1e-16 * section.scale / step**2)
        near = {"rtol": 1e-8, "atol": rounding}
        np.testing.assert_allclose(family.at.curvature[:, direction, *index], members, **near)
        relative = family.at.relative_curvature[direction, *index]
        np.testing.assert_allclose(relative, sum(members), **near)


def test_arms_are_the_velocities_of_the_moving_flanks(family, curves):
    for index, path in active_lanes(family):
        closing, sliding = np.transpose([curves.velocity(k, path) for k in (0, 1)])
        normal, slip = family.at.normal[:2, *index], family.at.slip_arm[:2, *index]
        np.testing.assert_allclose(normal, curves.slope * closing, rtol=1e-12, atol=1e-17)
        np.testing.assert_allclose(slip, sliding, 1e-12, 1e-17)
        # The contact itself stays, or moves along the normal: speeds are those of the bodies.
        surface = np.diag([sliding[0], -sliding[1]])
        np.testing.assert_allclose(family.at.surface[:, :2, *index], surface, 1e-12, 1e-17)


def test_contact_moves_along_each_flank_as_it_rolls(family):
    """Arc lengths against speeds, which takes no curves: every family of rigid flanks is asked."""
    if not touching(family.mesh):
        pytest.skip("lengths on bent flanks are those of chords, see test_strain_wave.py")
    step = 1e-5
    before, after = (
        jax.tree.map(np.asarray, contacts_of(family.mesh, jnp.asarray(INSIDE + move)))
        for move in (-step, step)
    )
    # Slices of a helical contact line move along it; at a fixed place of the face the path grows by
    # one in a period.
    passed = (after.path - before.path) / (2.0 * step)
    moves = np.abs(passed) > 1e-2
    rate = (after.flank - before.flank) / (2.0 * step) / np.where(moves, passed, 1.0)
    active = before.active & after.active & moves
    assert np.mean(active[before.active]) > 0.2
    for arms, moved in zip(
        contacts_of(family.mesh, jnp.asarray(INSIDE)).surface, rate, strict=True
    ):
        speed = dot(family.told.motion, arms)[active]
        np.testing.assert_allclose(
            np.abs(moved[active]), np.abs(speed * family.told.period), rtol=1e-8
        )
        signs = np.sign(moved[active] * speed)
        assert np.all(signs == signs[0]), "the sense changes on the way"


def test_flanks_bend_by_the_angle_that_their_normals_turn(family):
    """Curvatures against arc lengths, which takes no curves: of spur teeth and discs, in their one plane."""
    mesh, step = family.mesh, 1e-5
    at = jax.tree.map(np.asarray, contacts_of(mesh, jnp.asarray(INSIDE)))
    places = eqx.filter_eval_shape(lambda one: one.coordinates, mesh)
    upright = [not one.turns or axis[2] for one, axis in zip(places, family.told.axes, strict=True)]
    if not (touching(mesh) and all(upright)) or np.any(at.direction[2]):
        pytest.skip("normals turn in space, or flanks are bent")
    before, after = (
        jax.tree.map(np.asarray, contacts_of(mesh, jnp.asarray(INSIDE + move)))
        for move in (-step, step)
    )
    active = before.active & at.active & after.active
    turned = np.cross(before.direction, after.direction, axis=0)[2] / (2.0 * step)
    moved = (after.flank - before.flank) / (2.0 * step)
    rates = family.told.motion * family.told.period * family.told.onward
    for one, rate in zip(places, rates, strict=True):
        if one.turns or rate:  # not the way along which a load presses
            bent = at.curvature[one.member, 0] * moved[one.member]
            own = turned - rate * one.turns
            near = {"rtol": 1e-8, "atol": 1e-9 * np.abs(rate)}
            np.testing.assert_allclose(np.abs(bent[active]), np.abs(own[active]), **near)


def test_contact_lines_lie_where_the_path_has_got_to(family, curves):
    at = family.at
    pair = np.arange(float(at.active.shape[0]))[:, None, None]
    expected = np.broadcast_to(curves.path(family.phase, pair, at.width), at.path.shape)[at.active]
    np.testing.assert_allclose(at.path[at.active], expected, rtol=1e-10, atol=1e-10)
    assert np.all((expected > -1e-8) & (expected < curves.ratio + 1e-8))


def leaves_of(found):
    return {
        field.name: np.asarray(getattr(found, field.name))
        for field in dataclasses.fields(found)
        if field.name != "shape" and getattr(found, field.name) is not None
    }


ROUNDING = 1e-10
"""Nearest points of flanks that are almost parallel are less certain than places on an involute."""
FELT = 1e-9
"""A contact's width is where the gap has grown by 30 nm, a difference of places 30 mm from the axis."""


def nearness(name, usual):
    return max(usual, FELT) if name == "felt" else usual


@pytest.mark.parametrize("turns", [-1.0, 1.0, 6.0])
def test_one_period_later_all_is_the_same(family, turns):
    here = leaves_of(contacts_of(family.mesh, jnp.asarray(INSIDE)))
    there = leaves_of(contacts_of(family.mesh, jnp.asarray(INSIDE + turns)))
    for name, values in here.items():
        rtol = nearness(name, ROUNDING if not touching(family.mesh) else 1e-12)
        np.testing.assert_allclose(there[name], values, rtol=rtol, atol=1e-15, err_msg=name)


def test_pairs_go_on_where_a_period_ends(family):
    """Those of the end are among those of the next start, in other lanes; a rig counts turns anew."""
    near = 1e-9
    end, start = (
        leaves_of(contacts_of(family.mesh, jnp.asarray(0.0 * INSIDE + at)))
        for at in (1.0 - near, near)
    )
    counted = ("path", "flank") if way_of_pairs(family.mesh) is TURN else ()
    names = ("path", "curvature", "surface", "normal", "flank", "gap", "weight", "width")
    last, first = (np.argwhere(one["active"][..., 0]) for one in (end, start))
    distance = np.linalg.norm(points(end, last)[:, :, None] - points(start, first)[:, None], axis=0)
    then = [distance[number].argmin() for number in range(len(last))]
    if way_of_pairs(family.mesh) is ACTION:
        then = [int(np.flatnonzero((first == k + np.array([1, 0])).all(axis=1))[0]) for k in last]
    goes_on = distance[np.arange(len(last)), then] < 1e-7
    # At both ends of the window of a strain wave gear a tooth comes and goes without load.
    assert np.mean(goes_on) > 0.9
    assert len(set(then)) == len(then), "no lane holds two pairs"
    for k, other in zip(last[goes_on], first[then][goes_on], strict=True):
        for name in (name for name in names if name not in counted):
            before, after = end[name][..., *k, 0], start[name][..., *other, 0]
            np.testing.assert_allclose(before, after, rtol=1e-6, atol=1e-9, err_msg=name)


def points(found, active):
    """Points of the active lanes [xyz, lane] at the first phase."""
    return found["point"][:, active[:, 0], active[:, 1], 0]


@pytest.mark.whole
def test_batch_equals_loop(family):
    phase = jnp.asarray(family.phase)
    alone, mapped = each_alone(family.mesh, phase), vectorised(family.mesh, phase)
    square = contacts_of(family.mesh, phase.reshape(2, 13))
    close = (
        {"rtol": ROUNDING, "atol": 1e-15}
        if not touching(family.mesh)
        else {"rtol": 1e-14, "atol": 1e-17}
    )
    # Places across the face are counted from its middle and rounded like its half; places in the frame
    # of the mesh, of which one component vanishes at the pitch point, like the whole radius.
    rounded = {name: 2e-15 * np.abs(getattr(family.at, name)).max() for name in ("width", "point")}
    # Two places of a pair share its face in the ratio of small differences of its clearance.
    rounded["weight"] = 0.0 if touching(family.mesh) else 1e-10 * family.at.weight.max()
    for name, values in leaves_of(family.at).items():
        near = close | {"atol": max(close["atol"], rounded.get(name, 0.0)), "err_msg": name}
        near["rtol"] = nearness(name, close["rtol"])
        for other in (alone, mapped):
            found = np.moveaxis(getattr(other, name), 0, -1)
            np.testing.assert_allclose(found, values, **near)
        shaped = values.reshape(*values.shape[:-1], 2, 13)
        np.testing.assert_allclose(np.asarray(getattr(square, name)), shaped, **near)


@pytest.mark.whole
def test_states_together_equal_states_alone(family):
    design, phase = family.design, jnp.asarray(family.phase)
    together = states(family, "xu_2007", "none")["torque"]
    alone = states_alone(design, operation_for(design), phase, xu_alone(design.mesh))
    np.testing.assert_allclose(np.transpose(alone), together, rtol=1e-11, atol=1e-14)


def test_every_lane_is_finite(family):
    for leaf in leaves_of(family.at).values():
        assert np.all(np.isfinite(leaf))


@pytest.mark.parametrize("load", [0.0, None], ids=["no load", "loaded"])
def test_every_lane_and_state_is_finite_with_its_gradient(family, load):
    """On the events too, where rounding decides on which side they are."""
    for law in laws_for(family.mesh):
        value, gradient, _ = family.differentiated(law, load)
        assert np.isfinite(value)
        for path, leaf in jax.tree_util.tree_leaves_with_path(floats(gradient)):
            assert np.all(np.isfinite(leaf)), (law, jax.tree_util.keystr(path))


def test_rigid_flanks_touch_where_they_are_active(family):
    assert np.all(family.at.gap >= 0.0)
    gaps = family.at.gap[family.at.active]
    if not touching(family.mesh):
        # Only some of the pairs that reach into each other touch, to the table of the groove.
        least = np.where(family.at.active, family.at.gap, np.inf).min(axis=(0, 1))
        # Where relieved tips would touch there may be some nanometres between all pairs.
        assert np.all(least < 1e-8)
        assert np.median(least) < 1e-10
        assert gaps.max() > 1e-6
    else:
        assert np.all(gaps == 0.0)


def test_number_of_pairs_changes_at_events_only(family):
    if not touching(family.mesh):
        # Events are of rigid flanks; with gaps between them load decides, and no count is there to compare.
        pytest.skip("pairs come and go unloaded; the number that touches depends on the load")
    events = family.told.events
    assert events.shape == jax.eval_shape(type(family.mesh).events, family.mesh).shape
    assert np.all((events >= 0.0) & (events < 1.0))
    assert np.all(np.diff(events) >= 0.0)
    edges = np.unique(np.concatenate([[0.0], events, [1.0]]))
    counts = []
    for low, high in pairwise(edges):
        inside = low + (high - low) * np.linspace(1e-6, 1.0 - 1e-6, INSIDE.size)
        pairs = np.asarray(contacts_of(family.mesh, jnp.asarray(inside)).active).any(1).sum(0)
        assert np.all(pairs == pairs[0])
        counts.append(pairs[0] * (high - low))
    assert sum(counts) == pytest.approx(float(family.told.contact_ratio), rel=1e-12)


def test_sliding_changes_its_sense_at_events_only(family):
    if not touching(family.mesh):
        # No event is due there: one of many teeth bends the sums over them by little.
        pytest.skip("each tooth reverses its sliding near the long axis, one of many that carry")
    edges = np.unique(np.concatenate([[0.0], family.told.events, [1.0]]))
    for low, high in pairwise(edges):
        inside = low + (high - low) * np.linspace(1e-6, 1.0 - 1e-6, INSIDE.size)
        at = contacts_of(family.mesh, jnp.asarray(inside))
        slip = np.sign(dot(family.told.motion, at.slip_arm))
        slip = np.where(np.asarray(at.active), slip, 0.0)
        assert np.all(slip == slip[..., :1])


def test_the_pairs_are_what_their_names_say():
    told = {
        name: float(properties(design_for(FAMILIES[name]))["contact_ratio"])
        for name in ("18/36", "23/61, high teeth")
    }
    assert 1.0 < told["18/36"] < 2.0 < told["23/61, high teeth"] < 3.0
    mesh = FAMILIES["20/60, pitch point in double contact"].mesh()
    base_pitch = np.pi * 3e-3 * np.cos(np.deg2rad(20.0))
    phase = (mesh.pitch_position - mesh.limits[0]) / base_pitch
    assert int(contacts_of(mesh, jnp.asarray(0.0 * INSIDE + phase)).active[..., 0].sum()) == 2
