"""What yields behind teeth, rim and wall: closed forms, integrals of their own, the cube of the size."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import nnls, root

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.gears.on_balls import ball_force, separation_on_balls
from pitchpoint.gears.strain_wave.ball_bearing import Balls, on_balls
from pitchpoint.gears.strain_wave.design import build_strain_wave
from pitchpoint.gears.strain_wave.flexible_ring import RingLoads
from pitchpoint.gears.strain_wave.in_series import (
    STEEL_SHEAR_MODULUS,
    Behind,
    bolts_in_shear,
    disc_in_torsion,
    shaft_in_torsion,
)
from pitchpoint.gears.strain_wave.proportions import PROPORTIONS, rim_by_strain
from pitchpoint.loading.compliance import compliance
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import body_parts, wind_up, wound_up
from pitchpoint.materials.solids import Solid

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
SOLIDS = STEEL, STEEL
TERMS = terms_of("beam_foundation_hertz")
PHASES = np.array([0.0, 0.4, 0.7])
RIGID = {"cup_bottom": "rigid", "flange": "rigid", "wave_generator": "rigid"}
RIGID |= {"circular_spline": "rigid"}
PARTS = ("bottom of the cup", "flange joint", "wave generator's shaft", "circular spline")


def build(diameter=60e-3, teeth=100, **given):
    sizes = {"module": diameter / teeth, "face_width": diameter / 6.0, "walls": "two modules"}
    return build_strain_wave(teeth=(teeth, teeth + 2), **(sizes | given))


def at(drive, torque):
    """Wind-up at a torque, and its contacts."""
    contacts = _contacts(drive)
    body = _coupled(drive, contacts)
    return wound_up(
        drive, mesh_ends(drive)[1], SOLIDS, TERMS, jnp.asarray(torque), contacts, body
    ), contacts


_contacts = jax.jit(lambda drive: drive.contacts(jnp.asarray(PHASES)))
_coupled = jax.jit(lambda drive, contacts: drive.body.compliance(contacts, SOLIDS))


def in_series(drive):
    return {name: float(each) for name, each in _in_series(drive).items()}


_in_series = jax.jit(lambda drive: drive.body.in_series(SOLIDS, mesh_ends(drive)[1]))


# ------------------------------------------------------------------ closed forms


@pytest.mark.parametrize(("inner", "outer"), [(10e-3, 30e-3), (25e-3, 26e-3)])
def test_a_disc_twists_by_the_integral_of_its_shear(inner, outer):
    """Shear stress T/(2 pi r^2 t) turns a ring of the disc by stress/(G r) for each length of radius."""
    whole, _ = quad(lambda r: 1.0 / (2.0 * np.pi * r**3 * 0.5e-3), inner, outer)
    assert disc_in_torsion(0.5e-3, inner, outer) == pytest.approx(whole, rel=1e-12)


def test_a_thin_disc_is_a_tube_of_that_height():
    radius, thin = 20e-3, 1e-7
    tube = thin / (2.0 * np.pi * radius**3 * 1e-3)
    assert disc_in_torsion(1e-3, radius, radius + thin) == pytest.approx(tube, rel=1e-4)


def test_bolts_turn_by_their_shear():
    """A torque of 1 N m on 6 bolts of 4 mm on a circle of 30 mm."""
    each = 1.0 / 6 / 15e-3  # force of a bolt
    slip = each * 4e-3 / (STEEL_SHEAR_MODULUS * np.pi * 2e-3**2)
    assert bolts_in_shear(6, 4e-3, 30e-3) == pytest.approx(15e-3 / slip, rel=1e-12)


def test_a_shaft_turns_by_its_polar_moment():
    polar, _ = quad(lambda r: 2.0 * np.pi * r**3, 0.0, 5e-3)
    expected = STEEL_SHEAR_MODULUS * polar / 0.03
    assert shaft_in_torsion(10e-3, 0.03) == pytest.approx(expected, rel=1e-12)


def test_the_rim_by_strain_bends_by_that_strain():
    """Curvature of the outline r + w0 cos 2p at its crest by differences; faces lie t/2 beside it."""
    diameter, deflection = 60e-3, 1e-3
    thickness = rim_by_strain(diameter, deflection)
    radius, small = diameter / 2.0, 1e-3  # the curvature is linear in a small deflection
    angle = 1e-3 * np.arange(-1, 2)
    outline = (radius + small * deflection * np.cos(2.0 * angle)) * np.exp(1j * angle)
    speed = (outline[2] - outline[0]) / 2e-3
    turn = (outline[2] - 2.0 * outline[1] + outline[0]) / 1e-6
    curvature = (np.conj(speed) * turn).imag / abs(speed) ** 3
    strain = (curvature - 1.0 / radius) / small * thickness / 2.0
    assert strain == pytest.approx(PROPORTIONS.strain, rel=0.02)
    assert rim_by_strain(diameter, 1e-5) == PROPORTIONS.rim * diameter


# ------------------------------------------------------------------ parts of a drive


def test_nothing_yields_behind_the_teeth_unless_asked():
    assert set(in_series(build()).values()) == {0.0}
    assert set(in_series(build(behind=Behind(**RIGID))).values()) == {0.0}


@pytest.mark.parametrize(("key", "part"), [*zip(RIGID, PARTS, strict=True)])
def test_a_stiffness_by_value_adds_its_wind_up(key, part):
    """By the square of the torque of its member: 1/50^2 of the wave generator, (102/100)^2 of the spline."""
    given = {k: v for k, v in RIGID.items() if k != key} | {f"{key}_stiffness": 2e4}
    found = in_series(build(behind=Behind(**given)))
    factor = {"wave_generator": (2 / 100) ** 2, "circular_spline": (102 / 100) ** 2}.get(key, 1.0)
    expected = {name: factor / 2e4 if name == part else 0.0 for name in PARTS}
    assert found == pytest.approx(expected, rel=1e-12)


def test_parts_in_series_turn_with_the_driver():
    """Of a drive that is driven backwards the wave generator winds up by its own torque."""
    drive = build(behind=Behind())
    turned = drive.body.in_series(SOLIDS, mesh_ends(drive, "flexspline")[1])
    shaft = shaft_in_torsion(PROPORTIONS.shaft * 60e-3, PROPORTIONS.shaft_length * 60e-3)
    assert float(turned["wave generator's shaft"]) == pytest.approx(1.0 / shaft, rel=1e-12)


@pytest.mark.whole
@pytest.mark.parametrize(
    "given",
    [
        {"support_stiffness": 2e9},
        {"behind": Behind(), "bearing": Balls()},
        {"behind": Behind(), "bearing": Balls(play=8e-6)},
    ],
)
def test_parts_sum_up_to_the_wind_up(given):
    drive = build(**given)
    found, contacts = at(drive, 40.0)
    several = jax.tree.map(lambda x: np.asarray(x)[None], found)
    parts = {
        k: v[0]
        for k, v in body_parts(drive, mesh_ends(drive)[1], SOLIDS, contacts, several).items()
    }
    every = [found.of_teeth, found.of_gaps, *parts.values()]
    np.testing.assert_allclose(sum(every), found.wind_up, rtol=1e-9)
    assert min(float(np.min(part)) for part in every) >= 0.0
    assert float(parts["bearing of the wave generator"].mean()) > 0.0


@pytest.mark.whole
def test_the_whole_drive_goes_with_the_cube_of_its_size():
    """Sizes 17, 25 and 32 in proportion: contacts and balls of points included."""
    turned = {}
    for diameter in (43.2e-3, 63.5e-3, 81.3e-3):
        drive = build(diameter, bearing=Balls(), behind=Behind())
        found, _ = at(drive, 8.5e5 * diameter**3 * 0.3)
        turned[diameter] = np.asarray(found.wind_up)
        ratio = np.asarray(found.stiffness) / diameter**3
        np.testing.assert_allclose(turned[diameter], turned[43.2e-3], rtol=1e-7)
        turned.setdefault("stiffness", ratio)
        np.testing.assert_allclose(ratio, turned["stiffness"], rtol=1e-7)


@pytest.mark.whole
def test_derivatives_go_through_all_that_yields():
    """By thickness of the rim, bending of the race, stiffness of the balls, and the bottom of the cup."""
    drive = build(bearing=Balls(), behind=Behind())
    contacts = _contacts(drive)

    @jax.jit
    @jax.value_and_grad
    def turned(by):
        rim = replace(drive.rim, thickness=by[0] * drive.rim.thickness)
        balls = drive.bearing
        stiffness, bending = by[1] * balls.stiffness, by[2] * balls.bending
        balls = replace(balls, stiffness=stiffness, bending=bending)
        series = replace(drive.series, bottom=by[3] * drive.series.bottom)
        other = replace(drive, rim=rim, bearing=balls, series=series)
        given = SOLIDS, TERMS, jnp.full(3, 40.0), jnp.asarray(PHASES), contacts
        found = wind_up(other, mesh_ends(drive)[1], *given)
        return jnp.mean(found.wind_up)

    value, slopes = turned(jnp.ones(4))
    for k, slope in enumerate(slopes):
        step = 1e-4 * np.eye(4)[k]
        ends = [turned(jnp.asarray(1.0 + sign * step))[0] for sign in (1.0, -1.0)]
        assert float(slope) == pytest.approx(float(ends[0] - ends[1]) / 2e-4, rel=1e-5)
        assert abs(float(slope)) > 1e-3 * float(value)


@pytest.mark.whole
def test_a_thicker_circular_spline_is_stiffer():
    gone = [
        float(np.mean(at(build(behind=Behind(outside_diameter=d)), 40.0)[0].wind_up))
        for d in (70e-3, 90e-3)
    ]
    stiff = float(np.mean(at(build(behind=Behind(circular_spline="rigid")), 40.0)[0].wind_up))
    assert stiff < gone[1] < gone[0]


# ------------------------------------------------------------------ play and preload of the balls


def held(play, number=23):
    """A drive on such balls, its contacts, and how it lies on the balls."""
    drive = build(bearing=Balls(play=play, number=number))
    contacts = _contacts(drive)
    return drive, contacts, _coupled(drive, contacts)


def pushes(body, approach=None):
    """Forces of the balls, without load unless their approach is given [N]."""
    return np.asarray(_force(body.stiffness, body.approach if approach is None else approach))


_force = jax.jit(ball_force)


def test_without_play_the_teeth_stand_as_in_the_nominal_wave():
    _, contacts, body = held(0.0)
    np.testing.assert_array_equal(body.shift, 0.0)
    np.testing.assert_array_equal(separation_on_balls(contacts.gap, body), contacts.gap)


def test_teeth_sit_back_by_what_the_balls_push_less():
    """Seats of both by SciPy; the displacement of a lane for a force of a ball is the drive's own."""
    drive, _, body = held(8e-6)
    balls, point = np.asarray(body.balls), float(body.stiffness)
    wave = np.asarray(drive.line.radial(drive.bearing.angle))
    forces = []
    for play in (8e-6, 0.0):

        def balance(x, play=play):
            return 1e6 * (wave - play - balls @ (point * np.maximum(x, 0.0) ** 1.5)) - 1e6 * x

        seat = root(balance, np.asarray(body.approach), tol=1e-13)
        forces.append(point * np.maximum(seat.x, 0.0) ** 1.5)
    moved = np.einsum("ij...,j->i...", body.across, forces[0] - forces[1])
    np.testing.assert_allclose(body.shift, moved, atol=1e-12)
    assert 1e-6 < np.max(np.abs(body.shift)) < 8e-6


@pytest.mark.whole
@pytest.mark.parametrize("play", [8e-6, -2e-6])
def test_teeth_and_balls_are_one_equilibrium(play):
    """The same forces by non-negative least squares: no gap counts from a state that balls already made."""
    drive, contacts, body = held(play)
    torque, node = 20.0, 1
    found = wound_up(drive, mesh_ends(drive)[1], SOLIDS, TERMS, jnp.asarray(torque), contacts, body)
    own = _own(drive, contacts, torque)[:, node]
    nominal = held(0.0)[2]
    may = np.asarray(contacts.active)[:, 0, node]
    across = np.asarray(body.across)[..., node]
    gap = np.asarray(contacts.gap)[:, 0, node] - across @ pushes(nominal)
    arm = np.abs(np.asarray(contact_velocity(contacts.normal, mesh_ends(drive)[1])))[:, 0, node]
    turned = float(found.wind_up[node] + found.touch[node])
    push = np.asarray(drive.line.radial(drive.bearing.angle)) - play
    approach = np.asarray(found.balls)[:, node]
    force = pushes(body, approach)
    springs = np.where(force > 0.0, approach / np.where(force > 0.0, force, 1.0), 1e-9)
    upper = np.asarray(body.lanes)[..., node] + np.diag(own)
    lower = np.asarray(body.balls) + np.diag(springs)
    whole = np.block([[upper, across], [across.T, lower]])
    side = np.concatenate([gap - arm * turned, -push])
    take = np.concatenate([may, np.ones(force.size, bool)])
    factor = np.linalg.cholesky(1e6 * whole[np.ix_(take, take)])
    expected, _ = nnls(factor.T, np.linalg.solve(factor, -1e6 * side[take]))
    both = np.concatenate([np.asarray(found.force)[:, 0, node], force])[take]
    np.testing.assert_allclose(both, expected, atol=1e-7 * both.max())
    assert arm[may] @ expected[: may.sum()] == pytest.approx(torque, rel=1e-8)


def _own(drive, contacts, torque):
    """Compliance of each tooth by itself [m/N]."""
    return np.asarray(_teeth(drive, contacts, jnp.asarray(torque)))[:, 0]


_teeth = jax.jit(
    lambda drive, contacts, torque: compliance(
        drive, mesh_ends(drive)[1], contacts, SOLIDS, TERMS, torque
    ).of_teeth(contacts)
)


@pytest.mark.whole
@pytest.mark.parametrize("number", [23, 24])
def test_preloaded_balls_carry_without_torque_in_balance_with_the_wall(number):
    """What does not cancel around the ring moves it sideways, against the shear of the wall."""
    drive, _, body = held(-3e-6, number)
    force, angle = pushes(body), np.asarray(drive.bearing.angle)
    assert force.min() > 0.0
    around = 2.0 * np.pi * np.arange(512) / 512
    ones, none = np.ones(512), np.zeros(512)
    loads = RingLoads(*(jnp.asarray(x)[:, None] for x in (around, ones, none, none)))
    moved = _on_ring(drive, loads)
    along_ring = np.asarray(moved.across) @ force
    shear = STEEL.young / (2.0 + 2.0 * STEEL.poisson)
    wall = float(shear * drive.rim.wall_thickness / drive.rim.cup_length)
    step = 2.0 * np.pi / 512 * float(drive.rim.radius)
    held_by = wall * step * np.array([along_ring @ np.sin(around), -along_ring @ np.cos(around)])
    pushed = np.array([force @ np.cos(angle), force @ np.sin(angle)])
    np.testing.assert_allclose(pushed + held_by, 0.0, atol=1e-9 * force.sum())
    if number == 24:
        np.testing.assert_allclose(pushed, 0.0, atol=1e-9 * force.sum())


_on_ring = jax.jit(
    lambda drive, loads: on_balls(drive.bearing, drive.rim, drive.line, STEEL, loads)
)


def test_balls_with_much_play_hold_the_ring_near_the_long_axis_only():
    angle = 2.0 * np.pi * np.arange(23) / 23
    few, many = (pushes(held(play)[2]) > 0.0 for play in (40e-6, 0.0))
    assert few.sum() < many.sum()
    assert np.abs(np.cos(angle[few])).min() > np.cos(np.deg2rad(40.0))
    assert not many[np.abs(np.cos(angle)) < np.cos(np.deg2rad(70.0))].any()


@pytest.mark.whole
def test_the_first_slope_falls_with_the_play():
    slopes = [float(np.mean(at(held(play)[0], 1.0)[0].stiffness)) for play in (0.0, 5e-6, 15e-6)]
    assert slopes[0] > 1.2 * slopes[1] > 1.44 * slopes[2]


@pytest.mark.whole
@pytest.mark.parametrize("number", [23, 24])
def test_balls_stand_elsewhere_as_far_from_here_as_they_come(number):
    """Ends change places by half a pitch of an odd number, and an even one stands alike after a whole."""
    drive = build(bearing=Balls(number=number))
    pitch = 2.0 * np.pi / number
    same = pitch / 2.0 if number % 2 else pitch
    there = replace(drive, bearing=drive.body.elsewhere.bearing)
    turned = np.asarray(there.bearing.angle - drive.bearing.angle)
    np.testing.assert_allclose(turned, same / 2.0, rtol=1e-12)
    back = replace(there, bearing=there.bearing.elsewhere)
    here, away, again = (at(one, 20.0)[0] for one in (drive, there, back))
    np.testing.assert_allclose(again.wind_up, here.wind_up, rtol=1e-9)
    order = [1, 0] if number % 2 else [0, 1]
    np.testing.assert_allclose(again.inner_load, here.inner_load[np.array(order)], rtol=1e-6)
    assert np.abs(away.wind_up / here.wind_up - 1.0).max() > 1e-4
    assert build().body.elsewhere is None
