"""Loaded teeth of the shipped strain wave gears: no edge carries, nothing jumps, little ripple.

Clearances are those of positions alone, see `strain_wave_positions`.
"""

from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest
from loaded_strain_wave import WEBER, design, passing, wound, yielding
from sound import OnDemand, quick_first
from strain_wave_positions import drive

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.efficiency.quasi_static import Models, Operation, cycle, engagement
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.gears.pairs import of_pairs
from pitchpoint.gears.strain_wave.design import InvoluteForm, build_strain_wave
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE

CONSTANT = next(law for law in LAWS if law.name == "constant")
FRICTION = 0.1
MODELS = Models(
    (CONSTANT,),
    jnp.asarray(0),
    {"constant": {"coefficient": jnp.asarray(FRICTION)}},
    LOAD_SHARING["from_stiffness"],
    ROLLING_RESISTANCE["none"],
)
FORMS = {
    "liu": (DOUBLE_ARCS["liu"], 0.25),
    "flat": (DOUBLE_ARCS["flat"], 0.25),
    "involute": (InvoluteForm(3.32), 0.35),
}
LINEAR = terms_of("beam_hertz")
TORQUES = (4.7, 47.0, 94.0)
RATED = TORQUES[1]
NODES = (24, 48)
PHASES = 90
RIM = 0.7e-3


def build(form, **options):
    tooth, clearance = FORMS[form]
    options = {"clearance": clearance, "rim_thickness": RIM} | options
    return build_strain_wave(
        teeth=(200, 202), module=0.3e-3, face_width=0.01, form=tooth, **options
    )


def at_rated(mesh, nodes=NODES[0]):
    """What carries over one pitch."""
    return engagement(design(mesh), jnp.asarray(RATED), MODELS, nodes)


def passed(mesh, torque, like):
    """The same at another torque, and what the cycle with friction finds."""
    made, load = design(mesh), jnp.asarray(torque)
    engaged = engagement(made, load, MODELS, like.nodes, like)
    operation = Operation(load, *map(jnp.asarray, (200.0, 313.15)))
    return engaged, cycle(made, operation, MODELS, engaged=engaged)


def run(mesh, torque, like):
    """Path, forces and input torque over one pitch, and the efficiency with friction."""
    engaged, found = passed(mesh, torque, like)
    carried = wound(mesh, (engaged.contacts, engaged.body), torque)
    return SimpleNamespace(
        contacts=jax.tree.map(np.asarray, engaged.contacts),
        body=engaged.body,
        weight=np.asarray(engaged.weight),
        wound=jax.tree.map(np.asarray, carried),
        torque=np.asarray(found.state.input_torque),
        efficiency=float(found.mean_efficiency),
    )


@pytest.fixture(scope="module")
def drives():
    return OnDemand(build)


@pytest.fixture(scope="module")
def engaged(drives):
    return OnDemand(lambda key: at_rated(drives[key[0]], key[1]))


@pytest.fixture(scope="module")
def runs(drives, engaged):
    return OnDemand(lambda key: run(drives[key[0]], key[1], engaged[key[0], NODES[0]]))


@pytest.mark.whole
@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize("form", quick_first(FORMS))
def test_no_edge_carries_and_every_pair_closes_its_gap(drives, runs, form, torque):
    mesh, at, by = drives[form], runs[form, torque], drive(FORMS[form][0])
    space = by.groove(float(mesh.groove.low))
    force, contacts = at.wound.force[:, 0], at.contacts
    carries = force > 0.0
    angle, station = 2.0 * np.pi * contacts.path[:, 0], contacts.flank[0, :, 0]
    place = by.place(station, angle)
    # Neither end of the plain flank, nor the rounding of either tip.
    assert np.all(station[carries] > 0.0)
    assert np.all(station[carries] < by.outline.plain * (1.0 - 1e-6))
    assert np.all(place.real[carries] > space.low + by.made.rounding)
    np.testing.assert_array_equal(at.wound.edge_load, 0.0)
    # The normal of the flank by differences of its places, and the play along it.
    clearance = space.play(place) * np.cos(by.direction(station, angle, 2e-7))
    moved = np.asarray(yielding(mesh, at.contacts, at.body, jnp.asarray(torque), at.wound.force))
    arm = np.abs(contact_velocity(contacts.normal, np.asarray(mesh_ends(mesh)[1])))[:, 0]
    left = moved + clearance - arm * (at.wound.wind_up + at.wound.touch)
    assert np.max(np.abs(left[carries])) < 2e-8


@pytest.mark.whole
@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize("form", FORMS)
def test_input_torque_hardly_ripples(drives, engaged, runs, form, torque):
    """However many nodes look for it."""
    more = passed(drives[form], torque, engaged[form, NODES[1]])[1].state
    ripples = [ripple(runs[form, torque].torque), ripple(np.asarray(more.input_torque))]
    assert max(ripples) < 4e-3
    # Flat arcs at little torque touch at few places, and the peak of the torque is narrow.
    narrow = form == "flat" and torque == TORQUES[0]
    assert abs(ripples[1] - ripples[0]) < (1.2e-3 if narrow else 2e-4)


def ripple(torque):
    return np.ptp(torque) / torque.mean()


@pytest.mark.whole
@pytest.mark.parametrize("torque", TORQUES)
def test_loss_of_an_involute_drive_by_its_friction(runs, torque):
    lost = (1.0 - runs["involute", torque].efficiency) / FRICTION
    assert 0.25 < lost < 0.55


# A known miss: fewer pairs than are expected there. Strict, so that a change that mends it says so.
SHALLOW = pytest.mark.xfail(
    strict=True,
    reason="5.5: at one end of the wave two or three; 5.9 if contacts had no width, 6 from 6 N m on",
)


@pytest.mark.whole
@pytest.mark.parametrize(
    "torque", [pytest.param(6.7, id="of 67"), pytest.param(4.7, id="of 47", marks=SHALLOW)]
)
def test_pairs_of_an_involute_drive_at_a_tenth_of_a_rated_torque(runs, torque):
    """The drives of one size that are sold are rated at 47 N m or 67 N m."""
    at = runs["involute", torque]
    pairs = at.wound.loaded_pairs @ at.weight / at.weight.sum()
    assert 6.0 <= pairs <= 10.0


@pytest.mark.whole
@pytest.mark.parametrize("form", quick_first(FORMS))
def test_no_force_jumps_as_teeth_pass(drives, form):
    """Where contacts yield in proportion, the largest step of a force shrinks with that of the phase."""
    mesh, phases = drives[form], np.linspace(0.0, 1.0, 240, endpoint=False)
    force = forces(mesh, passing(mesh, phases), LINEAR, RATED)
    few, many = (largest_step(force[:, ::every]) for every in (4, 1))
    assert many < 0.27 * few


@pytest.fixture(scope="module")
def finely(drives):
    """Contacts every 0.02 degrees of the wave."""
    phases = np.linspace(0.0, 1.0, PHASES, endpoint=False)
    return OnDemand(lambda form: passing(drives[form], phases))


@pytest.mark.whole
@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize("form", quick_first(FORMS))
def test_forces_by_webers_law_hardly_step(drives, finely, form, torque):
    """In 0.02 degrees of the wave: a contact sees a joint of its flank from afar."""
    force = forces(drives[form], finely[form], WEBER, torque)[:, :PHASES]
    assert largest_step(force) < 0.05 * np.max(force)


def largest_step(force):
    """Of the force on any tooth."""
    return np.max(np.abs(np.diff(force, axis=1)))


def forces(mesh, parts, terms, torque):
    """Of each pair at all phases of the parts."""
    each = [np.asarray(in_pairs(mesh, wound(mesh, part, torque, terms).force)) for part in parts]
    return np.concatenate(each, axis=1)


@eqx.filter_jit
def in_pairs(mesh, force):
    return of_pairs(mesh, jnp.sum(force, axis=1))


@pytest.mark.whole
def test_edges_carry_where_that_is_asked_for():
    mesh = build("liu", edges_carry=True, tip_relief=0.0)
    found = run(mesh, RATED, at_rated(mesh)).wound
    part = found.edge_load / found.force.sum(axis=(0, 1))
    assert part.max() > 0.03
