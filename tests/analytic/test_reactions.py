"""Loads on bearings by the teeth: equilibrium of forces and moments, and what they cost."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.reactions import Bearing, radial_and_axial, unit_forces

PHASE = jnp.linspace(0.03, 0.97, 11)
PLACES = (-0.03, 0.05)


def pair(helix=0.0, teeth=(23, 61), **options):
    return build_cylindrical_pair(
        teeth=teeth,
        module=2e-3,
        pressure_angle=np.deg2rad(20.0),
        helix_angle=np.deg2rad(helix),
        face_width=0.02,
        slices=6,
        **options,
    )


@eqx.filter_jit
def answers(mesh, load):
    """Loads on two bearings of each gear and forces on it, as vectors, for equal shares of a load."""
    contacts = mesh.contacts(PHASE)
    share = jnp.where(contacts.active, contacts.weight, 0.0)
    arm = jnp.sum(share * jnp.abs(contacts.normal[1]), axis=(0, 1))
    force = load / arm * share
    pairs = []
    for coordinate, body in enumerate(mesh.coordinates):
        first, second = (
            Bearing(coordinate, jnp.asarray(place), jnp.asarray(other), thrust)
            for place, other, thrust in ((*PLACES, True), (*PLACES[::-1], False))
        )
        held = [jnp.sum(b.unit_loads(mesh, contacts) * force, (1, 2)) for b in (first, second)]
        acting = unit_forces(body, contacts) * force
        lever = contacts.point - body.place.reshape(3, 1, 1, 1)
        moment = jnp.sum(jnp.cross(lever, acting, axis=0), (1, 2))
        sizes = [b.load(mesh, contacts, force) for b in (first, second)]
        alone = Bearing(coordinate).load(mesh, contacts, force)
        pairs.append((jnp.stack(held), jnp.sum(acting, (1, 2)), moment, jnp.stack(sizes), alone))
    return pairs, radial_and_axial(mesh, contacts, force), force


MESHES = {
    "spur": pair(),
    "helical": pair(20.0),
    "helical, right flank": pair(20.0, right_flank=True),
    "ring": pair(teeth=(20, -60), profile_shift=(0.3, 0.2), fillet_radius=(0.38, 0.2)),
}


@pytest.mark.parametrize("name", MESHES)
def test_bearings_hold_the_forces_and_moments_of_the_teeth(name):
    mesh = MESHES[name]
    gears, (radial, axial), force = jax.tree.map(np.asarray, answers(mesh, 200.0))
    whole = force.sum(axis=(0, 1))
    for member, (held, acting, moment, sizes, alone) in enumerate(gears):
        np.testing.assert_allclose(held.sum(axis=0), acting, atol=1e-12 * whole.max())
        levers = np.array([[0.0, 0.0, place] for place in PLACES])
        turned = np.cross(levers[:, :, None], held, axis=1).sum(axis=0)
        # About the axis itself the torque of the drive holds the gear, and no bearing.
        np.testing.assert_allclose(turned[:2], moment[:2], atol=1e-12 * whole.max())
        np.testing.assert_allclose(sizes, np.linalg.norm(held, axis=1), rtol=1e-12)
        np.testing.assert_allclose(alone, np.linalg.norm(acting, axis=0), rtol=1e-12)
        np.testing.assert_allclose(alone, whole, rtol=1e-12)
        np.testing.assert_allclose(np.hypot(radial[member], axial[member]), whole, rtol=1e-12)
    np.testing.assert_allclose(np.abs(gears[1][2][2]), 200.0, rtol=1e-12)


def test_axial_force_of_helical_gears_in_closed_form():
    mesh = MESHES["helical"]
    radial, axial = np.asarray(answers(mesh, 200.0)[1])
    tangential = 200.0 / float(mesh.working_radii[1])
    helix = np.arctan(
        float(mesh.working_radii[1] / mesh.base_radii[1] * jnp.tan(mesh.base_helix_angle))
    )
    # Axial force by the helix angle at the pitch circle, radial one by the transverse pressure angle.
    np.testing.assert_allclose(np.abs(axial[1]), tangential * np.tan(helix), rtol=1e-12)
    across = tangential / np.cos(float(mesh.working_pressure_angle))
    np.testing.assert_allclose(radial, across, rtol=1e-12)
    np.testing.assert_allclose(axial[0], -axial[1], rtol=1e-12)
    assert np.all(axial[1] > 0.0)
    spur = np.asarray(answers(MESHES["spur"], 200.0)[1])
    assert np.all(spur[1] == 0.0)


TREE = {
    "gears": {
        "family": "cylindrical",
        "teeth": [23, 61],
        "module": "2 mm",
        "pressure_angle": "20 deg",
        "face_width": "20 mm",
    },
    "lubricant": {"name": "pao-vg-220"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "200 N m", "speed": "1000 rpm", "temperature": "60 degC"},
}
BEARING = {
    "between": ["gear 2", "housing"],
    "bearing": "palmgren_1959",
    "mean_diameter": "50 mm",
    "f0": 2.0,
    "f1": 1e-3,
}


def built(changes=None, **losses):
    return Variant({**TREE, "losses": losses}, "x.toml", "default").built(changes or {})


def test_drag_grows_with_the_load_as_the_bearing_model_says():
    """At 200 N m it exceeds that at 1 N m by f1 d_m times what the teeth add to the load."""
    case = built(wheel=BEARING, pinion={**BEARING, "between": ["gear 1", "housing"]})
    found = summarise(
        [
            (case.design, dataclasses.replace(case.operation, load=jnp.asarray(load)))
            for load in (200.0, 1.0)
        ],
        case.models[0],
    )
    more = found["bearing_load"][0] - found["bearing_load"][1]
    np.testing.assert_allclose(found["bearing_load"][:, 0], found["radial_reaction_2"], rtol=1e-12)
    speed = 1000.0 * 2.0 * np.pi / 60.0
    power = 1e-3 * 0.05 * (more[0] * 23 / 61 + more[1]) * speed
    assert np.diff(found["mean_drag_loss"][::-1])[0] == pytest.approx(power, rel=1e-10)
    assert more[0] == pytest.approx(199.0 / float(case.design.mesh.base_radii[1]), rel=0.01)
    assert np.all(found["axial_reaction_1"] == 0.0)


def test_two_bearings_of_one_shaft_take_their_parts():
    first, second = ({**BEARING, "position": place} for place in ("-30 mm", "50 mm"))
    case = built(left=first, right=second)
    found = summarise([(case.design, case.operation)], case.models[0])
    whole = found["radial_reaction_2"][0]
    np.testing.assert_allclose(found["bearing_load"][0], [5 / 8 * whole, 3 / 8 * whole], rtol=1e-12)
    seats = [
        drag.seat for drag in built(left=first, right={**second, "locating": True}).design.drag
    ]
    assert [seat.thrust for seat in seats] == [False, True]
    assert [drag.seat.thrust for drag in case.design.drag] == [True, False]


@pytest.mark.parametrize(
    ("losses", "words"),
    [
        (
            {"a": BEARING, "b": BEARING},
            "losses.a.position: is missing; the load of two bearings on gear 2",
        ),
        (
            {"a": {**BEARING, "position": "1 mm"}, "b": {**BEARING, "position": "1 mm"}},
            "losses.a.position: 1 mm is where the other bearing of gear 2 sits too; two bearings need a span",
        ),
        (
            {"a": {**BEARING, "position": "1 mm"}, "b": BEARING},
            "losses.b.position: is missing; a has one",
        ),
        (
            {"a": {**BEARING, "position": "1 mm"}},
            "losses.a.position: was given for the only bearing of gear 2, which takes all load",
        ),
        (
            {k: {**BEARING, "position": f"{k} mm", "locating": True} for k in "12"},
            "losses.1.locating: is true for both bearings of gear 2; one is locating",
        ),
        (
            {"a": {**BEARING, "position": "0 mm", "locating": 1}},
            "losses.a.locating: 1 was given; allowed are true and false",
        ),
        (
            {k: {**BEARING, "position": f"{k} mm"} for k in "123"},
            "losses.1.between: 3 bearings hold gear 2; the loads of more than two do not follow",
        ),
    ],
)
def test_bearings_whose_load_does_not_follow(losses, words):
    with pytest.raises(InputError) as caught:
        built(**losses)
    assert str(caught.value).startswith(f"x.toml: {words}")
