"""Gradients against differences, and properties that hold for any load, friction and unit."""

import dataclasses
from unittest.mock import Mock

import equinox as eqx
import numpy as np
import pytest
from bare_contacts import line_contacts
from hypothesis import example, given, settings
from hypothesis import strategies as st
from jax.flatten_util import ravel_pytree
from sound import pair

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.gradients import (
    input_torque_gradient,
    mean_loss_gradient,
    ripple_gradient,
)
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle, state
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import completed
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()

LAW = {law.name: law for law in LAWS}
PHASE = jnp.asarray(0.37)


def number(value):
    """A strongly typed scalar: one that is not would be compiled anew when it is moved."""
    return jnp.asarray(value, dtype=float)


def design_of(mesh):
    return Design(
        mesh,
        (STEEL, STEEL),
        lubricants.find("pao-vg-220").build(),
        Roughness(ra_1=0.4e-6, ra_2=0.5e-6, rq_1=0.3e-6, rq_2=0.4e-6),
    )


@pytest.fixture(scope="module")
def design():
    return design_of(pair((18, 36)))


def operation(load=120.0, speed=150.0):
    return Operation(*map(number, (load, speed, 330.0)))


def models(choice=0, mu=0.06, laws=("xu_2007", "iso_tr_14179_2", "constant"), rolling="none"):
    return Models(
        tuple(LAW[name] for name in laws),
        jnp.asarray(choice),
        {"constant": {"coefficient": jnp.asarray(mu)}},
        LOAD_SHARING["sanchez_2017"],
        ROLLING_RESISTANCE[rolling],
    )


def figures(inputs, chosen):
    """Mean loss, ripple, and input torque at one phase."""
    design, point = inputs
    design = dataclasses.replace(design, mesh=completed(design.mesh))
    found = cycle(design, point, chosen)
    torque = state(design, point, PHASE, chosen).input_torque
    return jnp.stack([found.mean_loss, found.ripple, torque])


@eqx.filter_jit
def figures_of_many(many, inputs, chosen):
    """Figures [row, figure] with the rows [row, number] in place of the continuous inputs."""
    shape = ravel_pytree(floats(inputs))[1]
    return jax.vmap(lambda row: figures(eqx.combine(shape(row), inputs), chosen))(many)


def floats(inputs):
    return eqx.filter(inputs, eqx.is_inexact_array)


def gradients(inputs, chosen):
    """Derivatives [figure, number] of the figures, as the library has them."""
    found = (
        mean_loss_gradient(*inputs, chosen),
        ripple_gradient(*inputs, chosen),
        input_torque_gradient(*inputs, chosen, PHASE),
    )
    return np.stack([ravel_pytree(one)[0] for one in found])


def moved(numbers):
    """Rows for central differences of order four in each number, [number, 4] flattened, and steps."""
    steps = 2e-4 * np.where(numbers == 0.0, 1.0, np.abs(numbers))
    moves = np.array([-2.0, -1.0, 1.0, 2.0])
    rows = numbers + np.eye(numbers.size)[:, None] * (moves[:, None] * steps)
    return rows.reshape(-1, numbers.size), steps


def differences(values, steps):
    by_move = values.reshape(steps.size, 4, -1)
    return np.einsum("m,nmf->fn", [1.0, -8.0, 8.0, -1.0], by_move) / (12.0 * steps)


CASES = {
    "18/36": lambda: pair((18, 36)),
    "undercut 10/41": lambda: pair((10, 41)),
}


def check_gradients(inputs, choice):
    chosen = models(choice)
    numbers = np.asarray(ravel_pytree(floats(inputs))[0])
    rows, steps = moved(numbers)
    found = gradients(inputs, chosen)
    assert found.shape == (3, numbers.size), "a continuous input has no derivative"
    values = np.asarray(figures_of_many(jnp.asarray(np.vstack([rows, numbers])), inputs, chosen))
    loss, _, torque = values[-1]
    expected = differences(values[:-1], steps)
    # The ripple is a difference of torques, and rounded like them.
    rounding = 1e-12 * np.array([[loss], [torque], [torque]]) / steps
    np.testing.assert_array_less(
        np.abs(found - expected), 1e-6 * np.abs(expected) + rounding, err_msg=str(names(inputs))
    )
    # Oil and roughness do not enter constant friction, nor does the module the ripple under it.
    most = 8 if choice == 2 else 12
    assert np.all(np.sum(np.abs(found) > 0.0, axis=1) >= most), "most inputs must matter"


def names(inputs):
    """Names of the continuous inputs in the order of their numbers."""
    leaves = jax.tree_util.tree_leaves_with_path(floats(inputs))
    return [
        f"{jax.tree_util.keystr(path)}[{index}]"
        for path, leaf in leaves
        for index in range(jnp.size(leaf))
    ]


@pytest.mark.whole
@pytest.mark.parametrize("choice", [0, 1, 2], ids=["xu", "iso", "constant"])
@pytest.mark.parametrize("name", ["18/36", "undercut 10/41"])
def test_gradients_equal_differences(name, choice):
    check_gradients((design_of(CASES[name]()), operation()), choice)


@pytest.mark.parametrize("figure", [mean_loss_gradient, ripple_gradient])
def test_programs_of_gradients_hold_no_callback(design, figure):
    """A program with a callback is compiled anew by every process."""
    moving, still = eqx.partition((design, operation()), eqx.is_inexact_array)

    def gradient(moving):
        return figure(*eqx.combine(moving, still), models())

    text = jax.jit(gradient).lower(moving).as_text()
    assert "stablehlo.while" in text, "the balance is not in it"
    assert "callback" not in text


def shifted(design, shift):
    """Profile shift from one gear to the other, which moves the path past the pitch point."""
    mesh = dataclasses.replace(design.mesh, profile_shift=jnp.stack([shift, -shift]))
    return dataclasses.replace(design, mesh=mesh)


@eqx.filter_jit
def pitch_from_single_contact(design, shift):
    """Distance of the pitch point from the zone of single contact [base pitches]."""
    mesh = shifted(design, shift).mesh
    return (mesh.limits[1] - mesh.pitch_position) / mesh.base_pitch - 1.0


def ripple_slope(design, shift, chosen):
    """Ripple's derivative along the shift, by the library and by a difference."""
    found = ripple_gradient(shifted(design, number(shift)), operation(), chosen)
    first, second = found[0].mesh.profile_shift
    step = 1e-5
    ahead, behind = (float(ripple(design, number(shift + s), chosen)) for s in (step, -step))
    return float(first - second), (ahead - behind) / (2.0 * step)


@eqx.filter_jit
def ripple(design, shift, chosen):
    return cycle(shifted(design, shift), operation(), chosen).ripple


@pytest.mark.whole
def test_ripple_has_a_slope_on_each_side_of_an_event(design):
    chosen = models(2)
    low, high = 0.0, 0.6
    for _ in range(50):
        middle = (low + high) / 2.0
        inside = float(pitch_from_single_contact(design, jnp.asarray(middle))) < 0.0
        low, high = (middle, high) if inside else (low, middle)
    assert 0.01 < low < 0.59, "the pitch point never leaves single contact"
    slopes = []
    for side in (-1.0, 1.0):
        slope, expected = ripple_slope(design, low + side * 2e-4, chosen)
        assert slope == pytest.approx(expected, rel=1e-5, abs=1e-6)
        slopes.append(slope)
    assert abs(slopes[1] - slopes[0]) > 0.01 * max(map(abs, slopes)), "there is no event between"


def contacts_on(path, active):
    lanes = path.shape
    return line_contacts(
        active=active,
        path=path,
        width=jnp.zeros(lanes),
        weight=jnp.full(lanes, 0.02),
        curvature=jnp.ones((2, 2, *lanes)),
        surface=jnp.ones((2, 2, *lanes)),
        normal=jnp.ones((2, *lanes)),
        gap=jnp.zeros(lanes),
        flank=jnp.zeros((2, *lanes)),
    )


@eqx.filter_jit
def shares(sharing, ratio, phase, lanes):
    path = (phase + jnp.arange(float(lanes)))[:, None]
    mesh = Mock(spec=Mesh, contact_ratio=ratio)
    return sharing.function(contacts_on(path, path <= ratio), mesh, None), path <= ratio


def check_shares(name, ratio, phase, lanes):
    share, active = shares(LOAD_SHARING[name], jnp.asarray(ratio), jnp.asarray(phase), lanes)
    assert np.all(np.asarray(share) >= 0.0)
    assert np.all(np.asarray(share)[~np.asarray(active)] == 0.0)
    assert float(np.sum(share)) == pytest.approx(1.0, abs=1e-12)


PHASES = st.floats(0.0, 1.0, exclude_max=True)


@settings(max_examples=40, deadline=None)
@given(ratio=st.floats(1.001, 1.999), phase=PHASES)
def test_shares_of_sanchez_sum_to_one(ratio, phase):
    check_shares("sanchez_2017", ratio, phase, 2)


@pytest.mark.parametrize("ratio", [1.25, 1.5, 1.6111])
@pytest.mark.parametrize("event", ["entry", "exit"])
def test_shares_of_sanchez_sum_to_one_on_the_events(ratio, event):
    check_shares("sanchez_2017", ratio, 0.0 if event == "entry" else ratio - 1.0, 2)


@settings(max_examples=40, deadline=None)
@given(ratio=st.floats(1.0, 3.9), phase=PHASES, name=st.sampled_from(["equal", "single"]))
@example(ratio=2.0, phase=0.5, name="single")
@example(ratio=3.0, phase=0.0, name="equal")
def test_shares_of_the_other_models_sum_to_one(ratio, phase, name):
    check_shares(name, ratio, phase, 4)


@eqx.filter_jit
def energy(design, operation, phase, chosen):
    found = state(design, operation, phase, chosen)
    return found.sliding_loss, found.rolling_loss, found.efficiency, found.input_torque


@settings(max_examples=50, deadline=None)
@example(mu=0.0, load=1e-3, speed=355.0, phase=0.4, choice=0)
@given(
    mu=st.floats(0.0, 0.5),
    load=st.floats(1e-3, 1e4),
    speed=st.floats(1e-3, 1e4),
    phase=PHASES,
    choice=st.integers(0, 2),
)
def test_friction_never_feeds_energy(design, mu, load, speed, phase, choice):
    found = energy(
        design,
        operation(load, speed),
        jnp.asarray(phase),
        models(choice, mu, rolling="wu_cheng_1991"),
    )
    sliding, rolling, efficiency, torque = map(np.asarray, found)
    assert np.all(sliding >= 0.0)
    assert np.all(rolling >= 0.0)
    assert efficiency <= 1.0 + 1e-12
    assert torque >= load / 2.0 * (1.0 - 1e-12)


@eqx.filter_jit
def results(design, operation, chosen):
    found = cycle(design, operation, chosen, nodes=12)
    at = found.state.conditions
    return {
        "mean_loss": found.mean_loss,
        "ripple": found.ripple,
        "mean_input_torque": found.mean_input_torque,
        "force": found.state.balance.force,
        "load": found.state.balance.load,
        "pressure": at.pressure,
        "half_width": at.half_width,
        "sliding": at.sliding,
        "entrainment": at.entrainment,
        "radius": at.radius,
        "line_load": at.line_load,
        "flank": found.state.contacts.flank,
        "mean_efficiency": found.mean_efficiency,
        "phase": found.phase,
    }


SCALE = st.floats(-2.0, 2.0)


@settings(max_examples=20, deadline=None)
@given(length=SCALE, mass=SCALE, time=SCALE)
def test_units_of_length_mass_and_time_scale_every_result(design, length, mass, time):
    L, M, T = (10.0**power for power in (length, mass, time))
    force, stress, power = M * L / T**2, M / (L * T**2), M * L**2 / T**3
    mesh, chosen = design.mesh, models(2)
    mesh = dataclasses.replace(
        mesh,
        module=mesh.module * L,
        face_width=mesh.face_width * L,
        centre_distance=mesh.centre_distance * L,
    )
    solids = tuple(
        dataclasses.replace(solid, young=solid.young * stress) for solid in design.solids
    )
    scaled = dataclasses.replace(design, mesh=mesh, solids=solids)
    here = results(design, operation(), chosen)
    there = results(scaled, operation(120.0 * force * L, 150.0 / T), chosen)
    dimension = {
        "mean_loss": power,
        "ripple": force * L,
        "mean_input_torque": force * L,
        "force": force,
        "load": force,
        "pressure": stress,
        "half_width": L,
        "sliding": L / T,
        "entrainment": L / T,
        "radius": L,
        "line_load": force / L,
        "flank": L,
        "mean_efficiency": 1.0,
        "phase": 1.0,
    }
    assert here.keys() == dimension.keys()
    for name, unit in dimension.items():
        expected = np.asarray(here[name]) * unit
        np.testing.assert_allclose(
            there[name], expected, rtol=1e-9, atol=1e-11 * np.abs(expected).max(), err_msg=name
        )


@pytest.mark.whole
def test_a_dimension_takes_along_what_follows_from_it():
    """As if the pair were built anew: without backlash the module moves the centre distance."""
    point, step = operation(), 1e-6

    def loss(module):
        mesh = build_cylindrical_pair(
            teeth=(21, 55),
            module=module,
            pressure_angle=np.deg2rad(20.0),
            face_width=0.014,
            profile_shift=(0.35, -0.1),
        )
        inputs = (design_of(mesh), point)
        numbers = ravel_pytree(floats(inputs))[0]
        # As many rows as where gradients are checked, so that one program serves both.
        rows = jnp.broadcast_to(numbers, (4 * numbers.size + 1, numbers.size))
        return inputs, float(figures_of_many(rows, inputs, models(1))[0, 0])

    slope = (loss(3e-3 + step)[1] - loss(3e-3 - step)[1]) / (2.0 * step)
    by_design, _ = mean_loss_gradient(*loss(3e-3)[0], models(1))
    assert float(by_design.mesh.module) == pytest.approx(slope, rel=1e-6)
    assert float(by_design.mesh.centre_distance) == 0.0
