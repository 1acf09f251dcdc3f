"""Torus-involute pairs: published geometry, misalignment by positions alone, compliance and refusals."""

import dataclasses
from functools import partial

import equinox as eqx
import numpy as np
import pytest
from flank_curves import TorusFlanks
from pydantic import ValidationError
from scipy.optimize import minimize_scalar

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.ellipse import hertz_1881
from pitchpoint.errors import InputError
from pitchpoint.gears.families import built_gears
from pitchpoint.gears.mesh_bodies import main_dimensions
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.gears.pairs import largest_inclination
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.loading.compliance import slice_stiffness
from pitchpoint.loading.mesh_stiffness import mesh_stiffness
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import wind_up
from pitchpoint.materials import solids

STEEL = solids.find("steel").build()
TABLE = {
    "family": "torus",
    "teeth": [40, 49],
    "module": "2.5 mm",
    "face_width": ["15 mm", "20 mm"],
    "torus_radius": ["35 mm", "55 mm"],
}


def built(**values):
    return built_gears(TorusGears.model_validate(TABLE | values), 6)


def pair(**values):
    return built(**values)[0]


@eqx.filter_jit
def figures(mesh):
    return main_dimensions(mesh) | {"limits": mesh.limits, "base_pitch": mesh.base_pitch}


contacts_of = eqx.filter_jit(lambda mesh, phase: mesh.contacts(phase))


def test_published_geometry():
    """Base radii 46.9846 and 57.5562 mm, line of action 38.0497 mm, contact ratio 1.7323, R_y 281.42 mm."""
    mesh = pair()
    found = figures(mesh)
    np.testing.assert_allclose(1e3 * mesh.base_radii, [46.9846, 57.5562], rtol=1e-5)
    assert 1e3 * float(mesh.tangent_length) == pytest.approx(38.0497, rel=1e-5)
    assert 1e3 * float(found["base_pitch"]) == pytest.approx(7.38033, rel=1e-5)
    np.testing.assert_allclose(1e3 * found["limits"], [10.639, 23.424], rtol=1e-4)
    assert float(found["transverse_contact_ratio"]) == pytest.approx(1.7323, rel=1e-4)
    assert 1e3 * float(found["transverse_radius"]) == pytest.approx(281.42, rel=1e-4)


def test_offsets_of_the_tori_say_the_same_as_radii_alone():
    one, other = pair(), pair(torus_offset=["15 mm", "116.25 mm"])
    assert one.faces[1].radius == other.faces[1].radius == -0.055
    np.testing.assert_allclose(one.profile_shift, other.profile_shift, atol=1e-14)
    shifted = pair(torus_offset=["15.5 mm", "115.75 mm"])
    np.testing.assert_allclose(shifted.middle_shift, [0.2, -0.2], rtol=1e-12)


@pytest.mark.parametrize(
    ("given", "place", "approach"),
    [
        ({"inclination": "10 mrad"}, -2.80e-3, 14.02e-6),
        ({"inclination": "-10 mrad"}, 2.80e-3, 14.02e-6),
        ({"axial_offset": "1 mm"}, -1.75e-3, 8.55e-6),
    ],
)
def test_misalignment_moves_the_contact_as_published(given, place, approach):
    found = figures(pair(**given))
    assert float(found["contact_place"]) == pytest.approx(place, rel=2e-3)
    assert float(found["misalignment_approach"]) == pytest.approx(approach, rel=2e-3)


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"inclination": "8 mrad", "axial_offset": "-0.6 mm"},
        {
            "inclination": "-5 mrad",
            "torus_radius": ["60 mm", "40 mm"],
            "torus_offset": ["110 mm", "21.25 mm"],
        },
    ],
    ids=["aligned", "both", "concave pinion"],
)
def test_flanks_are_nearest_where_positions_say(given):
    """Involutes of both gears as thick as each section makes them, one leaning and moved along its axis."""
    mesh = pair(**given)
    curves = TorusFlanks(mesh)
    section = TorusFlanks(dataclasses.replace(mesh, profile_shift=mesh.middle_shift)).section(
        0.8, 1
    )
    offset, lean = float(mesh.axial_offset), float(mesh.inclination)

    def apart(place):
        first = section.height(0, np.array([place]))[0]
        second = section.height(1, np.array([place - offset]))[0]
        return second - first + lean * place

    assert curves.ratio == pytest.approx(float(mesh.contact_ratio), rel=1e-12)
    found = minimize_scalar(apart, bounds=(-6e-3, 6e-3), method="bounded", options={"xatol": 1e-9})
    told = figures(mesh)
    assert float(told["contact_place"]) == pytest.approx(found.x, abs=1e-6)
    assert float(told["misalignment_approach"]) == pytest.approx(-found.fun, abs=1e-12)
    step = 2e-4
    bend = (apart(found.x + step) - 2.0 * found.fun + apart(found.x - step)) / step**2
    assert float(told["transverse_radius"]) * bend == pytest.approx(1.0, rel=1e-3)


def bends(points, place, step=2e-4):
    """Principal curvatures of a surface from positions alone, by its two fundamental forms."""
    r, z = (place[k] + step * np.array([-1.0, 0.0, 1.0]) for k in (0, 1))
    at = np.asarray(points(r[:, None] + 0.0 * z, z + 0.0 * r[:, None]))
    first = [(at[:, 2, 1] - at[:, 0, 1]) / (2 * step), (at[:, 1, 2] - at[:, 1, 0]) / (2 * step)]
    cross = (at[:, 2, 2] - at[:, 2, 0] - at[:, 0, 2] + at[:, 0, 0]) / (4 * step**2)
    second = [
        [(at[:, 2, 1] - 2 * at[:, 1, 1] + at[:, 0, 1]) / step**2, cross],
        [cross, (at[:, 1, 2] - 2 * at[:, 1, 1] + at[:, 1, 0]) / step**2],
    ]
    normal = np.cross(*first)
    normal /= np.linalg.norm(normal)
    metric = np.array([[a @ b for b in first] for a in first])
    shape = np.linalg.solve(metric, np.array([[b @ normal for b in row] for row in second]))
    outwards = np.sign(normal[0])
    return np.sort(-outwards * np.linalg.eigvals(shape).real)


def flank_points(mesh, member, radius, across):
    """Points of the flank of one tooth whose axis is y, by the profile shift at each place across."""
    shift = mesh.middle_shift[member] + mesh.faces[member].shift(across) / mesh.module
    gear = dataclasses.replace(mesh.gears[member], profile_shift=jnp.zeros(()))
    lean = 2.0 * shift * jnp.tan(mesh.pressure_angle) / mesh.teeth[member]
    angle = gear.half_thickness_angle(jnp.asarray(radius)) + lean
    points = radius * jnp.sin(angle), radius * jnp.cos(angle), jnp.asarray(across)
    return jnp.stack(jnp.broadcast_arrays(*points))


@pytest.mark.parametrize("place", [0.0, 3e-3])
def test_principal_curvatures_are_those_of_the_flanks_as_surfaces(place):
    """Their fundamental forms by positions alone; off the middle the directions turn a little."""
    mesh = pair()
    radii = np.hypot(np.asarray(mesh.base_radii), [17e-3, 21e-3])
    for member in (0, 1):
        points = jax.jit(partial(flank_points, mesh, member))
        found = bends(points, (radii[member], place))
        asked = sorted([1.0 / (17e-3, 21e-3)[member], float(mesh.faces[member].curvature(place))])
        np.testing.assert_allclose(found, asked, rtol=1e-3 if place == 0.0 else 1e-2)


def test_points_of_the_flank_lie_on_the_tooth_of_their_section():
    mesh = pair()
    radius, across = 50e-3, np.array([0.0, 6e-3])
    x, y, z = np.asarray(flank_points(mesh, 0, radius, across))
    np.testing.assert_allclose(np.hypot(x, y), radius, rtol=1e-14)
    np.testing.assert_array_equal(z, across)
    drop = 35e-3 - np.sqrt(35e-3**2 - across**2)
    thickness = np.pi * 2.5e-3 / 2.0 - 2.0 * drop * np.tan(np.radians(20.0))
    np.testing.assert_allclose(2.0 * radius * np.arctan2(x, y), thickness, rtol=1e-12)


def test_contacts_lie_where_misalignment_puts_them():
    mesh = pair(inclination="8 mrad")
    found = contacts_of(mesh, jnp.linspace(0.1, 0.9, 5))
    assert found.shape == "ellipse"
    np.testing.assert_allclose(found.width, float(mesh.place), rtol=1e-14)
    np.testing.assert_allclose(np.sum(np.asarray(found.direction) ** 2, axis=0), 1.0, rtol=1e-14)
    # The normal leans as the flank of gear 1 does there.
    lean = np.asarray(found.direction)[2] / np.hypot(*np.asarray(found.direction)[:2])
    np.testing.assert_allclose(lean, float(mesh.faces[0].slope(mesh.place)), rtol=1e-12)
    np.testing.assert_allclose(
        found.relative_curvature[1], 1.0 / float(mesh.transverse_radius), rtol=1e-12
    )


def test_backlash_is_what_misalignment_leaves():
    straight = figures(pair(centre_distance="111.4 mm"))
    leaning = figures(pair(centre_distance="111.4 mm", inclination="6 mrad"))
    taken = straight["normal_backlash"] - leaning["normal_backlash"]
    assert float(taken) == pytest.approx(2.0 * float(leaning["misalignment_approach"]), rel=1e-9)


def test_both_flanks_pressing_are_told():
    assert built()[1] == ()
    told = built(inclination="10 mrad")[1]
    assert told[0].startswith("Misalignment takes 28 um more than the backlash")


@pytest.mark.whole
def test_yielding_is_that_of_both_teeth_and_of_an_ellipse():
    mesh, load = pair(), 500.0
    contacts = contacts_of(mesh, jnp.asarray([0.85]))
    terms = terms_of("beam_foundation_weber")

    @partial(jax.jit, static_argnums=1)
    def stiffness(mesh, scale):
        wide = dataclasses.replace(mesh, widths=mesh.widths * scale)
        torque = load * mesh.base_radii[1]
        return slice_stiffness(wide, mesh_ends(mesh)[1], contacts, (STEEL, STEEL), terms, torque)

    one, double = (float(stiffness(mesh, scale)[0, 0, 0]) for scale in (1.0, 2.0))
    pressed = hertz_1881(
        load=jnp.asarray(load),
        radius=contacts.radius[0, 0, 0],
        transverse_radius=mesh.transverse_radius,
        modulus=STEEL.plane_strain_modulus,
    )
    # Twice the faces halve what the teeth yield, and leave the contact alone.
    teeth = 2.0 * (1.0 / one - 1.0 / double)
    assert 1.0 / one - teeth == pytest.approx(float(pressed.approach) / load, rel=1e-9)


@pytest.mark.whole
def test_mesh_stiffness_is_the_slope_of_the_wind_up_over_the_load():
    """Of teeth in series with an ellipse, whose approach grows with the load to the power 2/3."""
    mesh, load, radius = pair(), 100.0, float(pair().base_radii[1])
    terms = terms_of("beam_foundation_weber")

    @eqx.filter_jit
    def both(mesh, load):
        found = mesh_stiffness(mesh, mesh_ends(mesh)[1], (STEEL, STEEL), terms, load)
        at = found.phase.ravel()
        return found, wind_up(mesh, mesh_ends(mesh)[1], (STEEL, STEEL), terms, load, at)

    found, turned = both(mesh, jnp.asarray(load))
    np.testing.assert_allclose(turned.stiffness, found.total.ravel() * radius**2, rtol=1e-12)
    step = 1e-3
    ends = [both(mesh, jnp.asarray(load + sign * step))[0].approach for sign in (-1.0, 1.0)]
    slope = 2.0 * step / (ends[1] - ends[0])
    np.testing.assert_allclose(found.total * radius**2, slope, rtol=1e-8)
    assert np.all(found.total * found.approach * radius**2 > 1.2 * load)


@pytest.mark.whole
def test_derivatives_of_what_misalignment_does():
    mesh = pair(inclination="5 mrad", axial_offset="0.3 mm")

    @jax.jit
    def told(radius):
        radii = mesh.torus_radii.at[0].set(radius)
        other = dataclasses.replace(mesh, torus_radii=radii).completed()
        return jnp.stack([other.place, other.misalignment_approach, other.contact_ratio])

    step = 1e-7
    slope = (told(0.035 + step) - told(0.035 - step)) / (2.0 * step)
    np.testing.assert_allclose(jax.jit(jax.jacfwd(told))(0.035), slope, rtol=1e-6)


def test_what_follows_is_taken_along():
    """Derivatives by the shift in the middle are those of pairs built anew: distance and tips follow."""
    mesh, step = pair(inclination="5 mrad"), 1e-4

    @jax.jit
    def told(shift):
        moved = dataclasses.replace(mesh, middle_shift=mesh.middle_shift.at[0].set(shift))
        return jnp.stack([moved.completed().contact_ratio, moved.completed().centre_distance])

    ends = [pair(inclination="5 mrad", profile_shift=[sign * step, 0.0]) for sign in (-1, 1)]
    values = [np.array([float(one.contact_ratio), float(one.centre_distance)]) for one in ends]
    slope = (values[1] - values[0]) / (2.0 * step)
    np.testing.assert_allclose(jax.jit(jax.jacfwd(told))(0.0), slope, rtol=1e-5)


def test_the_largest_inclination_counts_from_where_the_contact_lies():
    """Of gears that an axial offset moves along each other an ellipse reaches one end before the other."""
    mesh = pair(axial_offset="3 mm")
    free = np.asarray(largest_inclination(mesh, jnp.array([1e-4, 1e-3, 1.7e-3, 1.8e-3, 4e-3])))
    assert np.all(np.diff(free[:3]) < 0.0)
    assert np.all(free[:3] > 0.0)
    np.testing.assert_array_equal(free[3:], 0.0)
    most = [f"{sign * 1e3 * free[1]} mrad" for sign in (-1, 1)]
    rooms = [float(pair(axial_offset="3 mm", inclination=one).contact_room) for one in most]
    assert min(rooms) == pytest.approx(1e-3, rel=1e-6)


def test_teeth_pointed_at_the_ends_of_the_wider_face_are_refused():
    with pytest.raises(
        InputError, match="the teeth of gear 2 are pointed at the ends of its face of 50 mm"
    ):
        pair(face_width=["15 mm", "50 mm"])


@pytest.mark.parametrize(
    ("values", "told"),
    [
        (
            {"torus_offset": ["15 mm", "6.25 mm"]},
            "torus_offset: both gears are convex: the centres of both tori lie within the reference circles",
        ),
        (
            {"torus_offset": ["85 mm", "116.25 mm"]},
            "torus_offset: both gears are concave: the centres of both tori lie beyond the reference circles",
        ),
        (
            {"torus_radius": ["55 mm", "35 mm"]},
            "torus_radius: the torus radius of the convex gear is 55 mm",
        ),
        (
            {"face_width": ["40 mm", "20 mm"]},
            "face_width: the face of gear 1 is 40 mm wide; allowed is less",
        ),
        (
            {"torus_offset": ["15 mm", "116.25 mm"], "profile_shift": [0.1, 0.0]},
            "profile_shift: radius and offset of the torus of gear 1 make a profile shift of 0 ",
        ),
        (
            {"torus_offset": ["25 mm", "116.25 mm"]},
            "torus_offset: radius and offset of the torus of gear 1",
        ),
    ],
)
def test_tables_that_make_no_pair_are_refused(values, told):
    with pytest.raises(ValidationError, match="Value error") as error:
        pair(**values)
    assert told in str(error.value)


def test_a_contact_off_the_faces_is_refused():
    with pytest.raises(
        InputError, match="moves the contact off the faces, 15 and 20 mm wide"
    ) as error:
        pair(inclination="50 mrad")
    assert error.value.key == "inclination"


def test_teeth_that_cannot_be_made_at_the_ends_are_refused():
    with pytest.raises(InputError, match="at the ends of the face, ") as error:
        pair(teeth=[12, 60], torus_radius=["11.5 mm", "14 mm"], face_width=["11 mm", "11 mm"])
    assert error.value.key == "face_width"
