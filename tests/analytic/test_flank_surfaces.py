"""Modified flanks against closed forms: heights, curvatures, shares, transmission error, pressure, loss."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest
from bare_contacts import line_contacts
from sound import pair

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.deviations import ToothDeviations
from pitchpoint.contact.hertz import line_pressure
from pitchpoint.contact.modifications import Crowning, EndRelief, LeadSlope, Relief
from pitchpoint.contact.surface import Spot, with_surfaces
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle
from pitchpoint.gears.cylindrical.modified import Modifications, modified
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.loading.compliance import compliance
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import wind_up
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants
from pitchpoint.materials.solids import Solid
from pitchpoint.materials.surfaces import Roughness

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
TERMS = terms_of("beam_foundation_hertz")
SPUR = pair((23, 61), module=2e-3)
ARM = abs(float(SPUR.base_radii[1]))
WIDTH = float(SPUR.face_width)
RELIEF = 20e-6
PHASES = np.linspace(1e-6, 1.0 - 1e-6, 61)
LOADS = np.linspace(10.0, 800.0, 40)
SLICES = 12


def relieved(amount=RELIEF, **more):
    return modified(SPUR, Modifications(tip_relief=(amount, amount), **more), SLICES)


# ------------------------------------------------------------------ heights and curvatures

BASE, WHOLE = 0.02, 0.03  # base radius and face width [m]
ROLL = np.array([0.004, 0.006, 0.008, 0.010]).reshape(-1, 1, 1)
ACROSS = np.array([-0.014, -0.002, 0.005, 0.0149]).reshape(-1, 1, 1)
START, END = 0.005, 0.011  # roll lengths [m]


def number(value):
    return jnp.asarray(float(value))


def arc(roll):
    return number(roll**2 / (2.0 * BASE))


@eqx.filter_jit
def _differing(surfaces, flank, across):
    none, lanes = jnp.zeros_like(flank), flank.shape
    flat = line_contacts(
        active=jnp.ones(lanes, bool),
        path=none,
        width=across,
        weight=none + 1.0,
        curvature=jnp.zeros((2, 2, *lanes)),
        surface=jnp.zeros((2, 2, *lanes)),
        normal=jnp.ones((2, *lanes)),
        gap=none,
        flank=jnp.stack([flank, flank]),
    )
    spot = Spot(flank, across, none, jnp.zeros(lanes, int), none + 1.0)
    found = with_surfaces(flat, (surfaces, ()), (spot, spot))
    return found.gap, found.curvature[0], found.curvature[1]


def differing(surface, roll=ROLL):
    flank = np.asarray(roll) ** 2 / (2.0 * BASE)
    return tuple(map(np.asarray, _differing((surface,), flank, np.asarray(ACROSS))))


@pytest.mark.parametrize("power", [1, 2])
def test_relief_grows_over_the_roll_length(power):
    """h = C u^n with u over the roll length L = sqrt(2 r_b s); h'' along the arc by the chain rule."""
    gap, (along_flank, across), other = differing(
        Relief(number(1e-5), number(END - START), arc(START), arc(END), power)
    )
    up, span = np.maximum((ROLL - START) / (END - START), 0.0), END - START
    np.testing.assert_allclose(gap, 1e-5 * up**power, rtol=1e-13)
    rate = BASE / ROLL  # dL/ds
    first = power * np.where(up > 0.0, up, 0.0) ** (power - 1) * (up > 0.0) / span
    second = power * (power - 1) * (up > 0.0) / span**2
    expected = 1e-5 * (second * rate**2 - first * rate**2 / ROLL)
    np.testing.assert_allclose(along_flank, expected, rtol=1e-11)
    assert not np.any(across)
    assert not np.any(other)


def test_relief_of_a_root_runs_the_other_way():
    gap, *_ = differing(Relief(number(1e-5), number(END - START), arc(END), arc(START)))
    np.testing.assert_allclose(gap, 1e-5 * (END - ROLL) / (END - START), rtol=1e-13)


def test_crowning_is_a_parabola():
    gap, (along_flank, across), _ = differing(Crowning(number(8e-6), number(WHOLE)))
    np.testing.assert_allclose(gap, 8e-6 * (2.0 * ACROSS / WHOLE) ** 2, rtol=1e-13)
    np.testing.assert_allclose(across, 8.0 * 8e-6 / WHOLE**2, rtol=1e-13)
    assert not np.any(along_flank)


def test_ends_and_slopes_of_the_lead():
    gap, (_, across), _ = differing(EndRelief(number(9e-6), number(3e-3), number(WHOLE), 2))
    inside = np.maximum(np.abs(ACROSS) - 0.012, 0.0)
    np.testing.assert_allclose(gap, 9e-6 * (inside / 3e-3) ** 2, rtol=1e-12)
    np.testing.assert_allclose(
        across, np.where(inside > 0.0, 2.0, 0.0) * 9e-6 / 3e-3**2, rtol=1e-12
    )
    gap, curvature, _ = differing(LeadSlope(number(6e-6), number(WHOLE)))
    np.testing.assert_allclose(gap, 6e-6 * ACROSS / WHOLE, rtol=1e-13)
    assert not np.any(curvature)


def test_deviations_of_a_tooth_add_up():
    table = [jnp.asarray([value, 9.0]) for value in (1e-6, 2e-6, 3e-6, 4e-6, 5e-6)]
    gap, *_ = differing(ToothDeviations(*table, arc(START), arc(END), number(WHOLE)))
    up, over = (ROLL - START) / (END - START), ACROSS / WHOLE
    expected = 1e-6 + 2e-6 * (up - 0.5) + 3e-6 * over
    expected += 2e-6 * np.cos(2.0 * np.pi * up) + 2.5e-6 * np.cos(2.0 * np.pi * over)
    np.testing.assert_allclose(gap, expected, rtol=1e-12)


def test_relief_begins_where_the_drawing_says():
    """At the tip circle C_a; nothing below the length from there; for a ring too, whose tip is inside."""
    ring = pair((20, -70), module=2e-3, addendum=(1.0, 0.8))
    for given in (SPUR, ring):
        length = 0.3 * float(given.base_pitch)
        own = Modifications(tip_relief=(RELIEF, RELIEF), tip_relief_length=(length, length))
        mesh = modified(given, own, SLICES)
        for gear, (surface,), base in zip(
            given.gears, mesh.surfaces, given.base_radii, strict=True
        ):
            tip = float(gear.tip_roll_length)
            rolls = tip + np.array([0.0, -0.5, -1.0]) * length * gear.side
            none = np.zeros(3)
            spot = Spot(rolls**2 / (2.0 * abs(float(base))), none, none, none.astype(int), none)
            np.testing.assert_allclose(
                surface.missing(spot), RELIEF * np.array([1.0, 0.5, 0.0]), atol=1e-18
            )


# ------------------------------------------------------------------ springs with gaps


@eqx.filter_jit
def gaps_at(mesh, phases):
    return mesh.contacts(phases).gap[:, 0]


@eqx.filter_jit
def events_of(mesh):
    return mesh.events()


@eqx.filter_jit
def wound(mesh, loads, phases):
    found = wind_up(mesh, mesh_ends(mesh)[1], (STEEL, STEEL), TERMS, loads[:, None], phases[None])
    contacts = mesh.contacts(phases)
    yields = compliance(mesh, mesh_ends(mesh)[1], contacts, (STEEL, STEEL), TERMS, jnp.ones(()))
    springs = 1.0 / yields.of_teeth(contacts)
    return found, contacts, springs


def solved(mesh, loads=LOADS, phases=PHASES):
    return jax.device_get(wound(mesh, jnp.asarray(loads), jnp.asarray(phases)))


@pytest.fixture(scope="module")
def long_relief():
    return solved(relieved())


@pytest.fixture(scope="module")
def plain():
    return solved(SPUR)


def test_gaps_of_a_pair_at_its_entry_and_exit():
    """Straight from A, where the tip of gear 2 meets, down to nothing at B, and up from D to E."""
    mesh = relieved()
    gap = np.asarray(gaps_at(mesh, jnp.asarray(PHASES)))
    ratio = float(SPUR.contact_ratio)
    path = PHASES + np.arange(gap.shape[0])[:, None]
    overlap = ratio - 1.0
    by_hand = RELIEF * np.maximum(np.maximum(overlap - path, path - 1.0) / overlap, 0.0)
    on = path <= ratio
    np.testing.assert_allclose(gap[on], by_hand[on], atol=1e-17)


def test_two_pairs_share_a_load_by_their_springs_and_gaps(long_relief):
    """k1 (x - g1) + k2 (x - g2) = F: by hand, in double contact with both loaded or one alone."""
    found, contacts, springs = long_relief
    gap, k = contacts.gap[:2, 0], np.where(contacts.active[:2, 0], springs[:2, 0], 0.0)
    force = LOADS[:, None] / ARM
    both = (force + (k * gap).sum(axis=0)) / k.sum(axis=0)
    first = (k * (both[:, None] - gap[None])).transpose(1, 0, 2)
    alone = np.any(np.where(k[:, None] > 0.0, first, 0.0) < 0.0, axis=0)
    two = (k > 0.0).all(axis=0)
    assert (two & alone).any()
    assert (two & ~alone).any()
    share = np.where(k[:, None] > 0.0, first, 0.0) / force
    led = np.where(gap == gap.min(axis=0), 1.0, 0.0)[:, None] * np.ones_like(share)
    expected = np.where(two & alone, led, share)
    np.testing.assert_allclose(found.share[:2, 0], expected, atol=1e-10)


def peak_to_peak(found):
    return np.ptp(found.wind_up + found.touch, axis=1) * ARM


def test_transmission_error_is_least_at_the_load_for_which_the_relief_is_made(long_relief, plain):
    """Where the deflection of a single pair equals the long relief (Harris): k C r_b2 in torque."""
    with_relief, without = peak_to_peak(long_relief[0]), peak_to_peak(plain[0])
    alone = plain[0].loaded_pairs[0] == 1
    stiffness = plain[0].stiffness[0, alone].mean() / ARM**2
    designed = stiffness * RELIEF * ARM
    least = LOADS[np.argmin(with_relief)]
    assert least == pytest.approx(designed, rel=0.12)
    assert with_relief.min() < 0.2 * without[np.argmin(with_relief)]
    # Below and above it grows again; without load it is the relief left at the hand-over.
    falls = np.diff(with_relief) < 0.0
    assert np.all(falls[LOADS[1:] < 0.9 * least])
    assert not np.any(falls[LOADS[:-1] > 1.1 * least])
    assert np.all(np.diff(without) > 0.0)


def test_twenty_micrometres_move_the_shares(long_relief, plain):
    entry = long_relief[0].share[0, 0, :, 0], plain[0].share[0, 0, :, 0]
    assert np.all(entry[0] < entry[1] - 0.05)
    assert entry[0][0] == 0.0
    assert np.all(np.diff(entry[0]) >= 0.0)  # the heavier the load, the more of the relief closes


def test_slices_of_spur_flanks_without_modification_change_nothing(plain):
    whole, _, _ = plain
    sliced, *_ = solved(dataclasses.replace(SPUR, slices=SLICES))
    for name in ("wind_up", "stiffness", "slip_torque"):
        np.testing.assert_allclose(getattr(sliced, name), getattr(whole, name), rtol=1e-12)
    np.testing.assert_allclose(sliced.share.sum(axis=1), whole.share.sum(axis=1), atol=1e-12)


def test_pressure_over_the_face_under_misalignment():
    """Thin slices: the line load falls straight over the face, w = F/b - k' f x/b, pressure as its root."""
    slope, load = 25e-6, 400.0
    mesh = modified(SPUR, Modifications(misalignment=slope), SLICES)
    middle = np.array([float(SPUR.contact_ratio) / 2.0])  # where a pair is alone
    found, contacts, springs = solved(mesh, np.array([load]), np.resize(middle, PHASES.size))
    (pair_in,) = np.flatnonzero(contacts.active[:, 0, 0])
    force, x = found.force[pair_in, :, 0, 0], contacts.width[pair_in, :, 0]
    k = springs[pair_in, :, 0] / (WIDTH / SLICES)
    np.testing.assert_allclose(k, k[0], rtol=1e-12)
    by_hand = load / ARM / WIDTH - k[0] * slope * x / WIDTH
    np.testing.assert_allclose(force / (WIDTH / SLICES), by_hand, rtol=1e-9)
    assert by_hand.max() > 1.3 * by_hand.mean()
    given = {"radius": contacts.radius[pair_in, :, 0], "modulus": 2.0 * 206e9 / 2.0 / 0.91}
    pressure = np.asarray(line_pressure(line_load=force / (WIDTH / SLICES), **given))
    np.testing.assert_allclose(
        pressure / pressure.mean(), np.sqrt(by_hand) / np.sqrt(by_hand).mean()
    )


def test_zero_is_there_too_so_that_a_sweep_keeps_its_program():
    zero, some = relieved(0.0), relieved()
    assert jax.tree.structure(zero) == jax.tree.structure(some)
    leaves = jax.tree.leaves(zero), jax.tree.leaves(some)
    assert [np.shape(one) for one in leaves[0]] == [np.shape(one) for one in leaves[1]]
    found, *_ = solved(zero)
    np.testing.assert_allclose(found.share, solved(SPUR)[0].share, atol=1e-12)


def test_events_know_where_a_relief_begins():
    """Long reliefs of both gears begin at B and D; the phase of both is that of the last hand-over."""
    events, plainly = np.asarray(events_of(relieved())), np.asarray(events_of(SPUR))
    assert events.size == plainly.size + 2
    assert np.sum(np.abs(events - (float(SPUR.contact_ratio) - 1.0)) < 1e-12) >= 2
    short = relieved(tip_relief_length=(2e-3, 2e-3))
    gap, before = (np.asarray(gaps_at(short, events_of(short) + by)) for by in (1e-9, -1e-9))
    assert np.sum((gap > 0.0) != (before > 0.0)) >= 2


# ------------------------------------------------------------------ derivative of the loss

LOSSY = Models(
    (next(law for law in LAWS if law.name == "constant"),),
    jnp.asarray(0),
    {"constant": {"coefficient": jnp.asarray(0.05)}},
    LOAD_SHARING["from_stiffness"],
    ROLLING_RESISTANCE["none"],
    TERMS,
)


@eqx.filter_jit
def _loss(amount, more, mesh):
    def of(amount):
        first, second = mesh.surfaces
        surfaces = tuple((dataclasses.replace(own[0], amount=amount),) for own in (first, second))
        design = Design(
            dataclasses.replace(mesh, surfaces=surfaces),
            (STEEL, STEEL),
            lubricants.find("pao-vg-220").build(),
            Roughness.from_composite_rq(0.8e-6),
        )
        at = Operation(jnp.asarray(400.0), jnp.asarray(150.0), jnp.asarray(333.15))
        found = cycle(design, at, LOSSY)
        return found.mean(found.state.loss)

    return jax.jvp(of, (amount,), (more,))


def test_derivative_of_the_mean_loss_by_the_relief():
    """All pairs carry at this load for these reliefs, so that the loss is smooth."""
    mesh, step = relieved(), 1e-8
    losses = {
        shift: float(_loss(jnp.asarray(5e-6 + shift * step), jnp.ones(()), mesh)[0])
        for shift in (-2, -1, 1, 2)
    }
    by_differences = (8.0 * (losses[1] - losses[-1]) - (losses[2] - losses[-2])) / (12.0 * step)
    loss, slope = _loss(jnp.asarray(5e-6), jnp.ones(()), mesh)
    assert float(slope) == pytest.approx(by_differences, rel=1e-6)
    assert abs(float(slope)) * 5e-6 > 1e-3 * float(loss)


def test_surfaces_follow_the_flanks_when_other_dimensions_change():
    """A derivative by another dimension sees reliefs at the new ends, over the new face."""
    own = Modifications(
        tip_relief=(RELIEF, RELIEF),
        tip_relief_length=(2e-3, 2e-3),
        root_relief=(RELIEF, 0.0),
        root_relief_length=(1e-3, 1e-3),
        crowning=(5e-6, 0.0),
    )
    mesh = modified(pair((23, 61), module=2e-3, profile_shift=(0.4, -0.2)), own, SLICES)
    shifts = jnp.asarray([0.41, -0.2])
    changed = dataclasses.replace(
        mesh, profile_shift=shifts, face_width=mesh.face_width * 1.1
    ).completed()
    again = modified(
        dataclasses.replace(mesh, profile_shift=shifts, surfaces=((), ())).completed(), own, SLICES
    )
    wide = dataclasses.replace(again, face_width=mesh.face_width * 1.1).completed()
    for found, expected in zip(
        jax.tree.leaves(changed.surfaces), jax.tree.leaves(wide.surfaces), strict=True
    ):
        np.testing.assert_allclose(found, expected, rtol=1e-10)
    before, after = (jax.tree.leaves(one.surfaces) for one in (mesh, changed))
    moved = sum(float(a) != float(b) for a, b in zip(before, after, strict=True))
    assert moved >= 6  # places of reliefs, and both widths
