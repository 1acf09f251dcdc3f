"""One battery of checks that every gear family passes."""

import dataclasses
from collections.abc import Callable, Mapping
from functools import cache, partial
from itertools import pairwise
from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import along, total
from pitchpoint.efficiency.bearing_loss import BEARING_LOSS
from pitchpoint.efficiency.drag import Drag, at_rest, resistance
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state
from pitchpoint.efficiency.running_torque import starting_torque
from pitchpoint.gears.ball_on_disc.mesh import BallOnDisc
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.gears.strain_wave.design import DOUBLE_ARCS, build_strain_wave
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.loading.sharing import LOAD_SHARING
from pitchpoint.lubrication.friction_coefficient import LAWS
from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE
from pitchpoint.materials import Roughness, lubricants, solids

STEEL = solids.find("steel").build()

LAW = {law.name: law for law in LAWS}
LOCAL = ("constant", "xu_2007")
WHOLE_MESH = (*LOCAL, "iso_tr_14179_2")


def spur(teeth, module=3e-3, **options):
    return build_cylindrical_pair(
        teeth=teeth, module=module, pressure_angle=np.deg2rad(20.0), face_width=0.02, **options
    )


def helical(teeth, helix, module=3e-3, **options):
    return spur(teeth, module, helix_angle=np.deg2rad(helix), slices=6, **options)


def strain_wave(teeth=(200, 202), form=DOUBLE_ARCS["flat"], **options):
    return build_strain_wave(
        teeth=teeth, module=0.3e-3, face_width=0.01, rim_thickness=0.7e-3, form=form, **options
    )


RING = {"fillet_radius": (0.38, 0.2), "profile_shift": (0.3, 0.2)}


FAMILIES: Mapping[str, Callable[[], Mesh]] = {
    "twin disc": lambda: TwinDisc(*map(jnp.asarray, ([0.02, 0.035], 0.008, 0.8))),
    "twin disc, faster follower": lambda: TwinDisc(*map(jnp.asarray, ([0.03, 0.02], 0.01, 1.3))),
    "ball on disc": lambda: BallOnDisc(*map(jnp.asarray, ([0.0095, 0.0095], 0.04, 0.35))),
    "barrel on disc, faster barrel": lambda: BallOnDisc(
        *map(jnp.asarray, ([0.01, 0.03], 0.035, -0.2))
    ),
    "18/36": lambda: spur((18, 36)),
    "18/36, right flank": lambda: spur((18, 36), right_flank=True),
    "18/36, wheel drives": lambda: spur((18, 36), driver=2),
    "18/36, wheel drives, right flank": lambda: spur((18, 36), driver=2, right_flank=True),
    "36/18, speed-increasing": lambda: spur((36, 18)),
    "23/61, shifted": lambda: spur((23, 61), 2e-3, profile_shift=(0.4, -0.2)),
    "23/61, high teeth": lambda: spur(
        (23, 61), 2e-3, profile_shift=(0.4, -0.2), addendum=(1.4, 1.4)
    ),
    "17/17": lambda: spur((17, 17)),
    "12/120": lambda: spur((12, 120), 1e-3, profile_shift=(0.5, 0.0)),
    "20/60, pitch point in double contact": lambda: spur((20, 60), profile_shift=(0.8, -0.8)),
    "helical 20/30": lambda: helical((20, 30), 15.0),
    # Its tips count as given, so that it is alike for the compiler.
    "helical 4/51, eps_alpha below one": lambda: dataclasses.replace(
        helical((4, 51), 20.0, 1.5e-3, profile_shift=(0.74, 0.05), least_tip=0.25),
        shortened=(False, False),
    ),
    "helical 20/30, narrow, wheel drives, right flank": lambda: helical(
        (20, 30), 8.0, driver=2, right_flank=True
    ),
    "ring 20/-60": lambda: spur((20, -60), **RING),
    "ring 20/-60, wheel drives": lambda: spur((20, -60), driver=2, **RING),
    "helical ring 18/-71, right flank": lambda: helical(
        (18, -71), 25.0, 1e-3, right_flank=True, **RING
    ),
    # Alike for the compiler; involute teeth and odd numbers are in test_strain_wave.py.
    "strain wave 200/202": strain_wave,
    "strain wave 200/202, flexspline fixed": lambda: strain_wave(
        form=DOUBLE_ARCS["liu"], fixed="flexspline"
    ),
    "strain wave 200/202, wave generator fixed": lambda: strain_wave(
        fixed="wave generator", driver="flexspline"
    ),
    "strain wave 200/202, back-driving": lambda: strain_wave(driver="flexspline"),
    "strain wave 200/204": lambda: strain_wave((200, 204)),
}


@eqx.filter_jit
def contacts_of(mesh, phase):
    return mesh.contacts(phase)


@eqx.filter_jit
def each_alone(mesh, phase):
    return jax.lax.map(mesh.contacts, phase)


@eqx.filter_jit
def vectorised(mesh, phase):
    return jax.vmap(mesh.contacts)(phase)


@eqx.filter_jit
def properties(mesh):
    return {
        "events": mesh.events(),
        "motion": mesh.motion,
        "driver": mesh.driver,
        "loaded": mesh.loaded,
        "period": mesh.period,
        "contact_ratio": mesh.contact_ratio,
    }


@eqx.filter_jit
def frame(mesh, contacts):
    """Coordinates, and the velocity of the contacts' points with each of them."""
    bodies = mesh.coordinates
    return bodies, jnp.stack([body.velocity(contacts.point) for body in bodies])


def state_at(design, operation, phase, models):
    found = state(design, operation, phase, models)
    return found, {
        "torque": found.balance.torque,
        "force": found.balance.force,
        "loss": found.loss,
        "input_power": found.input_power,
        "output_power": found.output_power,
        "residual": found.balance.residual,
        "locked": found.balance.locked,
        "iterations": found.balance.iterations,
        "rolling_loss": total(found.rolling_loss),
        "sliding_losses": found.sliding_loss,
    }


@eqx.filter_jit
def rolling_state(design, operation, phase, models):
    return state_at(design, operation, phase, models)[1]


@eqx.filter_jit
def states_alone(design, operation, phase, models):
    return jax.lax.map(lambda at: state(design, operation, at, models).balance.torque, phase)


def floats(tree):
    return eqx.filter(tree, eqx.is_inexact_array)


@eqx.filter_jit
def gradient_of_state(design, operation, phase, models):
    """Sums over all lanes of contacts and state, their derivatives, and the states."""

    def whole(both):
        found, told = state_at(both[0], both[1], phase, models)
        at = found.conditions
        kept = (found.balance.torque, found.balance.load, found.balance.friction)
        lanes = (at.pressure, at.slide_roll_ratio, at.entrainment, at.sliding, at.radius)
        lost = (found.sliding_loss, found.rolling_loss)
        sums = [jnp.sum(leaf) for leaf in (*kept, *lanes, *lost)]
        return sum(sums + [jnp.sum(leaf) for leaf in jax.tree.leaves(floats(found.contacts))]), told

    (value, told), gradient = eqx.filter_value_and_grad(whole, has_aux=True)((design, operation))
    return value, gradient, told


def models_for(mesh, law="constant", rolling="none"):
    names = LOCAL if mesh.reference is None else WHOLE_MESH
    return Models(
        friction=tuple(LAW[name] for name in names),
        choice=jnp.asarray(names.index(law)),
        parameters={"constant": {"coefficient": jnp.asarray(0.07)}},
        sharing=LOAD_SHARING[sharing_for(mesh)],
        rolling=ROLLING_RESISTANCE[rolling],
    )


def sharing_for(mesh):
    if isinstance(mesh, StrainWave):
        return "zhao_2022_cosine"
    spur_pair = isinstance(mesh, CylindricalPair) and mesh.lanes == 2 and not mesh.helical
    return "sanchez_2017" if spur_pair else "equal"


def xu_alone(mesh):
    return dataclasses.replace(models_for(mesh), friction=(LAW["xu_2007"],))


def operation_for(mesh, load=None):
    load = usual_load(mesh) if load is None else load
    speed = 150.0 / max(1.0, float(jnp.max(jnp.abs(mesh.motion))))  # of the fastest member
    return Operation(*map(jnp.asarray, (load, speed, 330.0)))


def usual_load(mesh):
    if isinstance(mesh, StrainWave):
        return 0.2 if mesh.loaded[0] else 20.0  # a wave generator carries a hundredth
    return 100.0 if isinstance(mesh, CylindricalPair) else 400.0


def design_for(mesh):
    return Design(
        mesh,
        (STEEL, STEEL),
        lubricants.find("pao-vg-220").build(),
        Roughness.from_composite_rq(0.4e-6),
    )


INSIDE = (np.arange(26) + 0.4) / 26.0
"""As many phases everywhere, so that one program serves."""


@pytest.fixture(scope="module", params=FAMILIES, ids=list(FAMILIES))
def family(request):
    """A mesh with its answers on a grid that crosses all events, and close beside each of them.

    On an event itself rounding decides which side it is: there only finite values are asked for.
    """
    mesh = FAMILIES[request.param]()
    told = SimpleNamespace(**{k: np.asarray(v) for k, v in properties(mesh).items()})
    events = np.resize(told.events, 3)
    phase = np.concatenate(
        [(np.arange(20) + 0.4) / 20.0, np.mod(np.append(events - 1e-7, events + 1e-7), 1.0)]
    )
    everywhere = jnp.asarray(np.concatenate([phase, events]))
    found = jax.tree.map(np.asarray, contacts_of(mesh, jnp.asarray(phase)))
    seen = {"mesh": mesh, "told": told, "phase": phase, "everywhere": everywhere, "at": found}
    return SimpleNamespace(**seen, differentiated=cache(partial(differentiated, mesh, everywhere)))


def differentiated(mesh, everywhere, law="xu_2007", load=None):
    """Sums, gradient and states of one law on the grid and on the events themselves."""
    given = (design_for(mesh), operation_for(mesh, load), everywhere)
    return jax.device_get(gradient_of_state(*given, models_for(mesh, law)))


def states(family, law, rolling):
    """States on the grid; the events come last where they are differentiated as well."""
    if rolling == "none":
        found = family.differentiated(law)[2]
        grid = slice(family.phase.size)
        return {key: v[..., grid] if v.ndim else v for key, v in found.items()}
    given = (design_for(family.mesh), operation_for(family.mesh), jnp.asarray(family.phase))
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
    first, second = (np.asarray(along(arms, motion)) for arms in family.at.surface)
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
        moves = body.turns  # a load that presses bodies together slides on none
        np.testing.assert_allclose(at.slip_arm[k], slip if moves else 0.0, atol=1e-12 * size)


def dot(rates, arms):
    """Sum of rates times arms over the coordinates, which are the arms' first axis."""
    return np.tensordot(rates, arms, axes=1)


def laws(family):
    return LOCAL if family.mesh.reference is None else WHOLE_MESH


def check_energy(found):
    """Power that the external torques put in is the power lost, and no friction gives any back."""
    assert np.all(found["residual"] < 1e-12)
    assert not np.any(found["locked"])
    assert np.all(found["sliding_losses"] >= 0.0)
    assert np.all(found["loss"] >= 0.0)


@pytest.mark.parametrize("rolling", ["none", "wu_cheng_1991"])
def test_torque_route_equals_loss_route(family, rolling):
    if rolling != "none" and family.at.shape != "line":
        # Its film and load parameters are per length of a line: it is not defined for an ellipse.
        pytest.skip("the formula is for line contacts")
    operation = operation_for(family.mesh)
    for law in laws(family):
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
    mesh = FAMILIES[request.param]()

    def design(kind):
        drag = Drag(mesh.driver * jnp.sign(mesh.driver @ mesh.motion), **LOSSES[kind])
        return dataclasses.replace(design_for(mesh), drag=(drag,))

    shape = (2, 3)
    points = Operation(*(jnp.full(shape, value) for value in (0.0, 100.0, 330.0)))
    contacts = contacts_of(mesh, jnp.asarray(INSIDE))
    return SimpleNamespace(mesh=mesh, design=design, points=points, contacts=contacts)


@pytest.mark.parametrize("kind", LOSSES)
def test_every_kind_of_loss_alone_brakes_the_driver(braked, kind):
    drags = braked.design(kind).drag
    given = braked.mesh, braked.contacts
    for resting, each in ((False, drags), (True, at_rest(drags))):
        torque = resistance(
            each, *given, speed=braked.points.speed[..., None], kinematic_viscosity=1e-4
        )(jnp.zeros(braked.contacts.weight.shape))
        driven = dot(np.asarray(braked.mesh.driver * braked.mesh.motion), np.asarray(torque))
        assert driven.shape == (2, 3, 1)
        acts = kind in ("bearing", "seal", "breakaway" if resting else "churning")
        assert np.all(driven > 0.0) if acts else np.all(driven == 0.0)


@pytest.mark.parametrize("kind", LOSSES)
def test_every_kind_of_loss_alone_has_a_starting_torque(braked, kind):
    models = models_for(braked.mesh)
    found = eqx.filter_eval_shape(starting_torque, braked.design(kind), braked.points, models)
    assert found.shape == (2, 3)


# Flanks as curves in the fixed frame, in complex numbers, built from gear data alone.


def transverse(mesh):
    """Transverse module and pressure angle, cosine of the base helix angle."""
    helix, angle = float(mesh.helix_angle), float(mesh.pressure_angle)
    across = np.arctan(np.tan(angle) / np.cos(helix))
    on_base = np.arctan(np.tan(helix) * np.cos(across))
    return float(mesh.module) / np.cos(helix), across, np.cos(on_base)


def tip_reach(mesh, index):
    """Length of the base tangent up to the tip circle; negative on a ring."""
    z, m, x = float(mesh.teeth[index]), float(mesh.module), float(mesh.profile_shift[index])
    module, angle, _ = transverse(mesh)
    tip = module * z / 2 + m * (float(mesh.addendum[index]) + x + float(mesh.tip_alteration[index]))
    return np.sign(z) * np.sqrt(tip**2 - (z * module * np.cos(angle) / 2.0) ** 2)


class Flanks:
    """Involutes of both gears in a transverse section, about the point where they should touch.

    A ring has its centre on the other side, negative radii and a negative roll.
    """

    def __init__(self, mesh, path):
        teeth = np.asarray(mesh.teeth)
        module, angle, _ = transverse(mesh)
        self.base = teeth * module * np.cos(angle) / 2.0
        side = -1.0 if teeth[1] < 0 else 1.0
        self.centres = np.array([0.0, side * float(mesh.centre_distance)])
        self.angle = -np.arccos(self.base.sum() / self.centres[1])
        tangent = -self.centres[1] * np.sin(self.angle)
        start = tangent - tip_reach(mesh, 1)
        self.length = start + path * 2.0 * np.pi * self.base[0] / teeth[0]
        self.hand = -1.0 if bool(mesh.right_flank) else 1.0
        # Both gears turn from phase 0 by their tooth numbers, not by where they should touch.
        first = self.angle + start / self.base[0] + 2.0 * np.pi * path / teeth[0]
        second = self.angle + (tangent - start) / self.base[1] - 2.0 * np.pi * path / teeth[1]
        self.turned = (first, second)
        # Steps stay far from the cusps, where the involutes start on their base circles.
        rolls = np.abs([self.length, tangent - self.length])
        self.size = np.min(rolls * np.minimum(1.0, rolls / np.abs(self.base)))

    @property
    def touch(self):
        return np.exp(1j * self.angle) * (self.base[0] + 1j * self.length)

    def _point(self, member, roll):
        string = self.base[member] * np.exp(1j * (self.turned[member] - roll)) * (1 + 1j * roll)
        return string if member == 0 else self.centres[1] - string

    def height(self, member, across):
        """Position along the line of action of the flank's point that lies `across` from it."""
        roll = np.full_like(across, self.turned[member] - self.angle)
        for _ in range(30):
            local = (self._point(member, roll) - self.touch) / np.exp(1j * self.angle)
            turn = np.exp(1j * (self.turned[member] - roll - self.angle)).real
            slope = self.base[member] * roll * turn * (1.0 if member == 0 else -1.0)
            roll = roll - (local.real - across) / slope
        return ((self._point(member, roll) - self.touch) / np.exp(1j * self.angle)).imag

    def velocity(self, member):
        """Closing and sliding velocity at the touching point for a unit rotation of one gear."""
        turned = 1j * (self.touch - self.centres[member])
        local = turned / np.exp(1j * self.angle) * self.hand * (1.0 if member == 0 else -1.0)
        return local.imag, -local.real


STEPS = np.arange(-4, 5)
# Central differences of order eight for the second derivative.
SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])


def second_derivative(heights, step):
    return SECOND @ heights / step**2


def circle(radius, across):
    """Depth of a circle below its tangent."""
    return across**2 / (radius + np.sqrt(radius**2 - across**2))


BY_POSITIONS = "checked by positions alone in test_strain_wave.py"


def test_curvature_is_the_second_derivative_of_the_gap(family):
    if isinstance(family.mesh, StrainWave):
        pytest.skip(BY_POSITIONS)
    if isinstance(family.mesh, CylindricalPair):
        check_involute_curvature(family)
        return
    first, second = principal_radii(family.mesh)
    step = 0.02 * min(*first, *second)
    across = STEPS * step
    for direction in (0, 1):
        each = [circle(r[direction], across) for r in (first, second)]
        expected = [second_derivative(depth, step) for depth in each]
        for found, one in zip(family.at.curvature[:, direction], expected, strict=True):
            np.testing.assert_allclose(found, np.full(found.shape, one), 1e-8, 1e-12)
        gap = second_derivative(sum(each), step)
        np.testing.assert_allclose(family.at.relative_curvature[direction], gap, 1e-8, 1e-12)


def principal_radii(mesh):
    """Radii of both bodies along and across the rolling direction; a very large one for a plane."""
    flat = 1e30
    if isinstance(mesh, TwinDisc):
        return tuple((float(r), flat) for r in mesh.radii)
    return (flat, flat), tuple(map(float, mesh.radius))


def active_lanes(family):
    for index in zip(*np.nonzero(family.at.active), strict=True):
        yield index, family.at.path[index]


def check_involute_curvature(family):
    count = 0
    slope = transverse(family.mesh)[2]
    for index, path in active_lanes(family):
        flanks = Flanks(family.mesh, path)
        step = 0.02 * flanks.size
        first, second = (flanks.height(member, STEPS * step) for member in (0, 1))
        scale = abs(flanks.centres[1])
        assert abs((second - first)[4]) < 1e-14 * scale, "the flanks do not touch"
        assert np.all((second - first)[[0, 1, 2, 3, 5, 6, 7, 8]] > 0.0), "the flanks overlap"
        # Across the line of contact a gap in the transverse section is smaller by the cosine.
        members = [-second_derivative(first, step), second_derivative(second, step)]
        members = [slope * one for one in members]
        rounding = 10.0 * 1e-16 * scale / step**2
        np.testing.assert_allclose(
            family.at.curvature[:, 0, *index], members, rtol=1e-8, atol=rounding
        )
        np.testing.assert_allclose(
            family.at.relative_curvature[0, *index], sum(members), rtol=1e-8, atol=rounding
        )
        count += 1
    assert count > len(family.phase) * 0.99
    assert np.all(family.at.curvature[:, 1] == 0.0)


def test_arms_are_the_velocities_of_the_turning_flanks(family):
    if isinstance(family.mesh, StrainWave):
        pytest.skip(BY_POSITIONS)
    if isinstance(family.mesh, CylindricalPair):
        slope = transverse(family.mesh)[2]
        for index, path in active_lanes(family):
            flanks = Flanks(family.mesh, path)
            closing, sliding = np.transpose([flanks.velocity(member) for member in (0, 1)])
            np.testing.assert_allclose(family.at.normal[:, *index], slope * closing, rtol=1e-12)
            np.testing.assert_allclose(family.at.slip_arm[:, *index], sliding, 1e-12, 1e-17)
        return
    turning = np.moveaxis(family.at.surface[:, :2], (0, 1), (-2, -1))
    if isinstance(family.mesh, TwinDisc):
        # Discs side by side: equal senses of rotation move the touching surfaces apart.
        arms = np.diag(np.asarray(family.mesh.radii) * [1.0, -1.0])
    else:
        arms = np.diag([float(family.mesh.track_radius), float(family.mesh.radius[0])])
    np.testing.assert_allclose(turning, np.broadcast_to(arms, turning.shape), rtol=1e-15)
    np.testing.assert_array_equal(family.at.normal[:2], 0.0)


def test_contact_moves_along_each_flank_as_it_rolls(family):
    if isinstance(family.mesh, StrainWave):
        pytest.skip(BY_POSITIONS)
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


def test_contact_lines_are_straight_in_the_plane_of_action(family):
    if not isinstance(family.mesh, CylindricalPair):
        # Discs touch at one fixed place: there is no plane through which contact lines travel.
        pytest.skip("no plane of action")
    mesh, at = family.mesh, family.at
    module, angle, slope = transverse(mesh)
    pair = np.arange(float(mesh.lanes))[:, None, None]
    behind = (at.width + float(mesh.face_width) / 2.0) * np.tan(np.arccos(slope))
    expected = family.phase + pair - mesh.helical * behind / (np.pi * module * np.cos(angle))
    np.testing.assert_allclose(at.path[at.active], expected[at.active], rtol=1e-10, atol=1e-10)
    ratio = float(mesh.transverse_contact_ratio)
    assert np.all((at.path[at.active] > -1e-8) & (at.path[at.active] < ratio + 1e-8))


def leaves_of(found):
    return {
        field.name: np.asarray(getattr(found, field.name))
        for field in dataclasses.fields(found)
        if field.name != "shape"
    }


ROUNDING = 1e-10
"""Nearest points of flanks that are almost parallel are less certain than places on an involute."""


@pytest.mark.parametrize("turns", [-1.0, 1.0, 6.0])
def test_one_period_later_all_is_the_same(family, turns):
    here = leaves_of(contacts_of(family.mesh, jnp.asarray(INSIDE)))
    there = leaves_of(contacts_of(family.mesh, jnp.asarray(INSIDE + turns)))
    for name, values in here.items():
        rtol = ROUNDING if not family.mesh.touching else 1e-12
        np.testing.assert_allclose(there[name], values, rtol=rtol, atol=1e-15, err_msg=name)


def test_pairs_move_up_by_one_where_a_period_ends(family):
    near = 1e-9
    end, start = (
        leaves_of(contacts_of(family.mesh, jnp.full(INSIDE.shape, at))) for at in (1.0 - near, near)
    )
    pairs = end["active"].shape[0]
    now, then = successors(family.mesh, pairs)
    both = end["active"][now] & start["active"][then]
    assert both.any()
    for name in ("path", "curvature", "surface", "normal", "flank", "gap", "weight", "width"):
        if pairs == 1 and name in ("path", "flank"):
            continue  # a rig counts turns anew
        before, after = (
            values.reshape(-1, *end["active"].shape)[:, part][:, both]
            for values, part in ((end[name], now), (start[name], then))
        )
        np.testing.assert_allclose(before, after, rtol=1e-6, atol=1e-9, err_msg=name)


def successors(mesh, pairs):
    """Lanes of one period, and those that hold the same pairs in the next."""
    lane = np.arange(pairs)
    if pairs == 1:
        return lane, lane  # a rig keeps its only contact
    if not isinstance(mesh, StrainWave):
        return lane[:-1], lane[1:]
    # Each end of the long axis has its own teeth; with an odd number they are half a pitch apart.
    first, second = np.split(lane, 2)
    if mesh.teeth[0] % 2:
        return np.append(first[:-1], second), np.append(first[1:], second)
    return np.append(first[:-1], second[:-1]), np.append(first[1:], second[1:])


def test_batch_equals_loop(family):
    phase = jnp.asarray(family.phase)
    alone, mapped = each_alone(family.mesh, phase), vectorised(family.mesh, phase)
    square = contacts_of(family.mesh, phase.reshape(2, 13))
    close = (
        {"rtol": ROUNDING, "atol": 1e-15}
        if not family.mesh.touching
        else {"rtol": 1e-14, "atol": 1e-17}
    )
    # Places across the face are counted from its middle and rounded like its half; places in the frame
    # of the mesh, of which one component vanishes at the pitch point, like the whole radius.
    rounded = {name: 2e-15 * np.abs(getattr(family.at, name)).max() for name in ("width", "point")}
    for name, values in leaves_of(family.at).items():
        near = close | {"atol": max(close["atol"], rounded.get(name, 0.0)), "err_msg": name}
        for other in (alone, mapped):
            found = np.moveaxis(getattr(other, name), 0, -1)
            np.testing.assert_allclose(found, values, **near)
        shaped = values.reshape(*values.shape[:-1], 2, 13)
        np.testing.assert_allclose(np.asarray(getattr(square, name)), shaped, **near)


def test_states_together_equal_states_alone(family):
    mesh, phase = family.mesh, jnp.asarray(family.phase)
    together = states(family, "xu_2007", "none")["torque"]
    alone = states_alone(design_for(mesh), operation_for(mesh), phase, xu_alone(mesh))
    np.testing.assert_allclose(np.transpose(alone), together, rtol=1e-11, atol=1e-14)


def test_every_lane_is_finite(family):
    for leaf in leaves_of(family.at).values():
        assert np.all(np.isfinite(leaf))


@pytest.mark.parametrize("load", [0.0, None], ids=["no load", "loaded"])
def test_every_lane_and_state_is_finite_with_its_gradient(family, load):
    """On the events too, where rounding decides on which side they are."""
    for law in laws(family):
        value, gradient, _ = family.differentiated(law, load)
        assert np.isfinite(value)
        for path, leaf in jax.tree_util.tree_leaves_with_path(floats(gradient)):
            assert np.all(np.isfinite(leaf)), (law, jax.tree_util.keystr(path))


def test_rigid_flanks_touch_where_they_are_active(family):
    assert np.all(family.at.gap >= 0.0)
    touching = family.at.gap[family.at.active]
    if not family.mesh.touching:
        # Only some of the pairs that reach into each other touch, to the table of the groove.
        least = np.where(family.at.active, family.at.gap, np.inf).min(axis=(0, 1))
        assert np.all(least < 1e-10)
        assert touching.max() > 1e-6
    else:
        assert np.all(touching == 0.0)


def test_number_of_pairs_changes_at_events_only(family):
    if not family.mesh.touching:
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
    if not family.mesh.touching:
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
        name: float(properties(FAMILIES[name]())["contact_ratio"])
        for name in ("18/36", "23/61, high teeth")
    }
    assert 1.0 < told["18/36"] < 2.0 < told["23/61, high teeth"] < 3.0
    mesh = FAMILIES["20/60, pitch point in double contact"]()
    base_pitch = np.pi * 3e-3 * np.cos(np.deg2rad(20.0))
    phase = (mesh.pitch_position - mesh.limits[0]) / base_pitch
    assert int(contacts_of(mesh, jnp.full(INSIDE.shape, phase)).active[..., 0].sum()) == 2
