"""A strain wave gear written down in the contact type, to show that the type carries one.

A sketch, no model of a drive: the flexspline's flank is one circular arc, the load a cosine. Its
teeth are carried by an inextensible ring with the radial displacement w0 cos 2p, p being the angle of
a tooth from the wave generator's long axis.
"""

from types import SimpleNamespace
from typing import ClassVar

import equinox as eqx
import numpy as np
import pytest
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, along, total
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle, state
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.balance import balance
from pitchpoint.loading.sharing import LoadSharing
from pitchpoint.lubrication.friction_coefficient import LAWS
from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE
from pitchpoint.materials import Roughness, lubricants, solids

STEEL = solids.find("steel").build()

# Rotations: wave generator, flexspline, circular spline.
BODIES = ("wave generator", "flexspline", "circular spline")
ZONE = np.deg2rad(36.0)


def dot(a, b):
    return jnp.real(jnp.conj(a) * b)


class StrainWave(Mesh):
    """Teeth near both ends of the wave generator's long axis; one of three members is fixed."""

    teeth: Float[Array, "2"]
    ring_radius: Float[Array, ""]
    wave: Float[Array, ""]
    arc_radius: Float[Array, ""]
    arc_centre: Float[Array, "2"]
    face_width: Float[Array, ""]
    motion_of: Float[Array, "3"]
    driver_of: Float[Array, "3"]
    loaded_of: Float[Array, "3"]
    pairs: int = eqx.field(static=True)
    arc: ClassVar = (np.deg2rad(10.5), np.deg2rad(26.1))  # where the flank begins and ends

    @property
    def contact_ratio(self):
        return jnp.asarray(float(self.pairs))

    @property
    def motion(self):
        return self.motion_of

    @property
    def driver(self):
        return self.driver_of

    @property
    def loaded(self):
        return self.loaded_of

    @property
    def tooth_angle(self):
        return 2.0 * jnp.pi / self.teeth[0]

    @property
    def period(self):
        return self.tooth_angle / jnp.abs(self.motion_of[1] - self.motion_of[0])

    @property
    def reference(self):
        return None

    def events(self):
        return jnp.zeros(1)

    def numbers(self, phase):
        """Tooth pitches since the entry into the zone, and the zone: [pair slice *b]."""
        index = jnp.arange(self.pairs).reshape(-1, *([1] * (jnp.ndim(phase) + 1)))
        half = self.pairs // 2
        return index % half + jnp.mod(phase, 1.0), index // half

    def angles(self, phase):
        """Angle of each tooth from the long axis: as many in both zones, entering together."""
        path, zone = self.numbers(phase)
        return (path - self.pairs / 4.0) * self.tooth_angle + jnp.pi * zone

    def tooth(self, angle, turned):
        """Arc centre and tilt of a tooth with its root at the polar angle `turned`, p = `angle`."""
        radial = self.ring_radius + self.wave * jnp.cos(2.0 * angle)
        along = turned - self.wave / 2.0 * jnp.sin(2.0 * angle) / self.ring_radius
        tilt = along - 2.0 * self.wave * jnp.sin(2.0 * angle) / self.ring_radius
        root = radial * jnp.exp(1j * along)
        # Tooth axis outwards along its tilt, across it against the sense of rotation.
        centre = self.arc_centre[1] - 1j * self.arc_centre[0]
        return root + centre * jnp.exp(1j * tilt), tilt

    def on_nominal_motion(self, angle):
        """The same, seen from the circular spline, which the tooth passes groove by groove."""
        return self.tooth(angle, angle * (1.0 - self.teeth[0] / self.teeth[1]))

    def rates(self, angle):
        """Derivatives along p: arc centre's velocity and acceleration, tilt rate."""
        one = jnp.ones_like(angle)
        (centre, tilt), (velocity, turn) = jax.jvp(self.on_nominal_motion, (angle,), (one,))
        _, (acceleration, _) = jax.jvp(
            lambda p: jax.jvp(self.on_nominal_motion, (p,), (one,))[1], (angle,), (one,)
        )
        return centre, tilt, velocity, acceleration, turn

    def raw_contacts(self, phase):
        """Contacts before the elastic part is taken out of the normal arms."""
        p = self.angles(phase)
        centre, tilt, velocity, acceleration, turn = self.rates(p)
        # Envelope: the arc touches where its normal is across the velocity of its centre; beyond its
        # ends it is the end that carries, and the normal arms do not close on the nominal motion.
        across = -1j * jnp.exp(1j * tilt)
        free = 1j * velocity / jnp.abs(velocity)
        free = free * jnp.sign(dot(free, across))
        rise = jnp.angle(free / across)
        held = jnp.clip(rise, *self.arc)
        normal, tangent = across * jnp.exp(1j * held), 1j * across * jnp.exp(1j * held)
        point = centre + self.arc_radius * normal
        # Material velocities: the wave generator shifts p back at a resting root, the flexspline
        # turns root and p together, the circular spline turns as a whole.
        by_angle = self.velocity_of(point, p, (0.0, 1.0))
        by_root = self.velocity_of(point, p, (1.0, 0.0))
        relative = jnp.stack([-by_angle, by_angle + by_root, -1j * point])
        # Rolling: the arc length that the touching point moves along the flexspline's flank.
        bend = jnp.imag(acceleration / velocity)
        rolls = rise == held
        roll = jnp.where(rolls, self.arc_radius * (bend - turn), 0.0)
        first = jnp.stack([roll, -roll, jnp.zeros_like(roll)])
        speed = jnp.abs(velocity)
        path_bend = dot(normal, 1j * velocity) / speed * bend / speed
        mated = jnp.where(rolls, -1.0 / (self.arc_radius - 1.0 / path_bend), 0.0)
        none = jnp.zeros_like(p)
        return Contacts(
            active=jnp.ones(p.shape, bool),
            path=self.numbers(phase)[0],
            width=none,
            weight=none + self.face_width,
            curvature=jnp.stack(
                [jnp.stack([none + 1.0 / self.arc_radius, none]), jnp.stack([mated, none])]
            ),
            surface=jnp.stack([first, first - dot(tangent, relative)]),
            normal=dot(normal, relative),
            gap=none,
            flank=jnp.stack([self.arc_radius * held] * 2),
            shape="line",
        )

    def velocity_of(self, point, p, direction):
        """Velocity of the tooth's material at `point` for a change of (root angle, p)."""
        turned = p * (1.0 - self.teeth[0] / self.teeth[1])
        root, angle = (jnp.full_like(p, rate) for rate in direction)
        (centre, _), (shift, turn) = jax.jvp(
            lambda t, a: self.tooth(a, t), (turned, p), (root, angle)
        )
        return shift + 1j * turn * (point - centre)

    def contacts(self, phase):
        raw = self.raw_contacts(phase)
        # Only within the arms that a common rotation of all bodies leaves at rest.
        inner = self.motion - jnp.mean(self.motion)
        elastic = jnp.stack([along(raw.normal, self.motion) * k for k in inner / (inner @ inner)])
        return eqx.tree_at(lambda c: c.normal, raw, raw.normal - elastic)


def cosine_share(contacts, contact_ratio, stiffness=None):
    """Load over each zone as a half wave."""
    middle = contact_ratio / 4.0
    load = jnp.cos(0.5 * jnp.pi * (contacts.path - middle) / middle) + 0.05
    return load / total(load)


SHARING = LoadSharing("cosine", "a half wave over each zone", cosine_share, ())


def rates_with(fixed, driver, teeth):
    """Rates of all three with one at rest and one turning once: z2 q_C = z1 q_F + (z2 - z1) q_W.

    The driver turns the way in which it presses the flanks together that the sketch has.
    """
    z1, z2 = teeth
    law = np.array([z2 - z1, z1, -z2], float)
    free = 3 - fixed - driver
    motion = np.zeros(3)
    motion[driver] = -np.sign(law[driver])
    motion[free] = -law[driver] * motion[driver] / law[free]
    return motion, free


def drive(fixed, driver, teeth=(200, 202), module=0.3e-3):
    motion, loaded = rates_with(fixed, driver, teeth)
    one = np.eye(3)
    rim = 0.35e-3
    foot = 0.75 * module
    return StrainWave(
        teeth=jnp.asarray(teeth, float),
        ring_radius=jnp.asarray(module * teeth[0] / 2.0 - rim - foot),
        wave=jnp.asarray(module),
        arc_radius=jnp.asarray(2.0 * module),
        arc_centre=jnp.asarray([-1.294 * module, rim + foot - 0.33 * module]),
        face_width=jnp.asarray(10e-3),
        motion_of=jnp.asarray(motion),
        driver_of=jnp.asarray(one[driver]),
        loaded_of=jnp.asarray(one[loaded]),
        pairs=2 * int(2.0 * ZONE / (2.0 * np.pi / teeth[0])),
    )


@eqx.filter_jit
def answers(mesh, phase):
    contacts = mesh.contacts(phase)
    share = cosine_share(contacts, mesh.contact_ratio)
    given = {"motion": mesh.motion, "loaded": mesh.loaded, "load": jnp.full(phase.shape, 20.0)}
    return {
        "raw": mesh.raw_contacts(phase),
        "contacts": contacts,
        "share": share,
        "turn": mesh.rates(mesh.angles(phase))[4],
        "smooth": balance(contacts, share, **given, friction=jnp.zeros_like),
        "rough": balance(
            contacts,
            share,
            **given,
            friction=lambda load: 0.05 * (1.0 + load) ** -0.1,
            rolling=lambda load: 0.02 * load**0.5,
        ),
    }


@eqx.filter_jit
def through_the_chain(design, operation, models):
    found = cycle(design, operation, models, nodes=4)
    return {
        "torque": found.state.balance.torque,
        "loss": found.state.loss,
        "efficiency": found.state.efficiency,
        "residual": found.residual,
    }, state(design, operation, jnp.asarray(0.3), models).loss


CHOICES = [
    (fixed, driver, teeth)
    for teeth in ((200, 202), (100, 102))
    for fixed in range(3)
    for driver in range(3)
    if driver != fixed and (teeth[0] == 200 or driver == 0)
]


@pytest.fixture(
    scope="module",
    params=CHOICES,
    ids=[f"{c[2][0]}, {BODIES[c[0]]} fixed, {BODIES[c[1]]} drives" for c in CHOICES],
)
def case(request):
    fixed, driver, teeth = request.param
    mesh = drive(fixed, driver, teeth, 0.3e-3 if teeth[0] == 200 else 0.6e-3)
    found = jax.tree.map(np.asarray, answers(mesh, jnp.asarray([0.0, 0.13, 0.5, 0.77])))
    motion, loaded = np.asarray(mesh.motion), np.asarray(mesh.loaded)
    return SimpleNamespace(**found, mesh=mesh, motion=motion, loaded=loaded)


def rolling_teeth(case):
    return np.abs(case.contacts.surface[0, 1]) > 0.0


def speeds_of(case):
    return [np.asarray(along(arms, case.motion)) for arms in case.contacts.surface]


def test_many_pairs_lie_on_the_pair_axis(case):
    assert case.contacts.active.shape == (case.mesh.pairs, 1, 4)
    assert 40 <= case.mesh.pairs <= 80
    np.testing.assert_allclose(case.share.sum(axis=(0, 1)), 1.0, rtol=1e-14)


def test_turning_everything_together_moves_no_contact(case):
    size = np.abs(case.raw.normal).max()
    for arms in (case.raw.normal, case.contacts.normal, case.contacts.slip_arm):
        assert np.abs(arms.sum(axis=0)).max() < 1e-13 * size


def test_enveloped_teeth_close_by_themselves_and_the_others_after_projection(case):
    size = along(np.abs(case.raw.normal), np.abs(case.motion))
    raw = np.abs(along(case.raw.normal, case.motion)) / size
    rolls = rolling_teeth(case)
    assert 0.05 < rolls.mean() < 0.95, "the sketch needs both kinds of teeth"
    assert raw[rolls].max() < 1e-12
    assert raw[~rolls].max() > 1e-4
    assert (np.abs(along(case.contacts.normal, case.motion)) / size).max() < 1e-13


def test_curvature_of_the_enveloped_flank_follows_from_the_speeds(case):
    """1/R = (kappa1 v_s - tilt rate)/v2 for a tooth whose mate is the envelope of its flank."""
    rolls = rolling_teeth(case)
    first, second = (speed / (case.motion[1] - case.motion[0]) for speed in speeds_of(case))
    expected = ((first - second) / float(case.mesh.arc_radius) - case.turn) / -second
    found = case.contacts.relative_curvature[0]
    np.testing.assert_allclose(found[rolls], expected[rolls], rtol=1e-8)
    assert np.all(found[rolls] > 0.0)


def test_virtual_work_gives_the_torque_of_the_wave_generator(case):
    """Without friction the three torques are in the ratio (z2 - z1) : z1 : -z2, whichever is fixed."""
    z1, z2 = np.asarray(case.mesh.teeth)
    torque = case.smooth.torque
    np.testing.assert_allclose(np.abs(case.loaded @ torque), 20.0, rtol=1e-12)
    ratio = np.array([[(z1 - z2) / z2], [-z1 / z2], [1.0]])
    np.testing.assert_allclose(torque / torque[2], np.broadcast_to(ratio, (3, 4)), 1e-9)


def test_torque_route_equals_loss_route(case):
    found, (first, second) = case.rough, speeds_of(case)
    slip, roll = np.abs(first - second), np.abs(first + second)
    lost = np.sum(found.load * found.friction * slip + found.rolling * roll, axis=(0, 1))
    power, turnover = case.motion @ found.torque, np.abs(case.motion) @ np.abs(found.torque)
    assert not found.locked.any()
    assert np.all(found.residual < 1e-12)
    assert np.all(lost > 1e-4 * turnover)
    assert np.all(np.abs(power - lost) <= 1e-12 * lost + 1e-15 * turnover)
    np.testing.assert_allclose(found.torque.sum(axis=0), 0.0, atol=1e-12 * 20.0)


def test_the_whole_chain_runs_on_it(case):
    design = Design(
        case.mesh,
        (STEEL, STEEL),
        lubricants.find("pao-vg-220").build(),
        Roughness.from_composite_rq(0.4e-6),
    )
    law = next(law for law in LAWS if law.name == "constant")
    models = Models((law,), jnp.asarray(0), {}, SHARING, ROLLING_RESISTANCE["wu_cheng_1991"])
    operation = Operation(*map(jnp.asarray, (20.0, 100.0, 320.0)))
    found, alone = jax.tree.map(np.asarray, through_the_chain(design, operation, models))
    np.testing.assert_allclose(case.motion @ found["torque"] * 100.0, found["loss"], rtol=1e-10)
    assert found["residual"] < 1e-12
    assert np.all((found["efficiency"] > 0.0) & (found["efficiency"] < 1.0))
    assert np.isfinite(alone)
