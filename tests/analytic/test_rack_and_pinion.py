"""Rack and pinion: closed forms, the limit of a wheel with more and more teeth, what cannot run."""

import dataclasses

import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.families import built_gears
from pitchpoint.gears.mesh_bodies import main_dimensions
from pitchpoint.gears.nominal_motion import mesh_ends, nominal_motion, nominal_period
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.tooth_compliance import beam_compliance, terms_of
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness
from pitchpoint.runs.run import Outcome
from pitchpoint.views.point import way_in_a_turn

MODULE, ANGLE = 3e-3, np.deg2rad(20.0)
STEEL = solids.find("steel").build()
OIL = lubricants.find("pao-vg-220").build()
CONSTANT = next(law for law in LAWS if law.name == "constant")


def table(**values):
    given = {"family": "rack_and_pinion", "teeth": 20, "module": "3 mm", "face_width": "25 mm"}
    return RackAndPinionGears.model_validate(given | values)


def built(**values):
    return built_gears(table(**values), 6)


def rack(**values):
    return built(**values)[0]


def test_a_rack_goes_by_the_pitch_circle_in_a_turn():
    """20 teeth of module 3 mm: 60 pi mm, whatever the sign; where nothing travels there is no way."""
    manifest = {"members": ["pinion", "rack"], "driver": "pinion", "loaded": "rack"}
    manifest |= {"motion": [1.0, -0.03], "travels": ["loaded"]}
    assert way_in_a_turn(Outcome(manifest)) == "188.5 mm"
    assert way_in_a_turn(Outcome({**manifest, "travels": []})) == ""


@program
def dimensions(mesh):
    driver, loaded = mesh_ends(mesh)
    motion = nominal_motion(mesh, driver, loaded)
    return {
        **main_dimensions(mesh),
        "motion": motion,
        "period": nominal_period(mesh, motion),
        "contact_ratio": mesh.contact_ratio,
        "reference": pitch_point(mesh, driver),
    }


def test_dimensions_are_those_of_the_closed_forms():
    """Path from the rack's tip line to the pinion's tip circle, r_b = r cos(alpha), p_b = pi m cos(alpha)."""
    found = jax.device_get(dimensions(rack()))
    radius, base, tip = 0.03, 0.03 * np.cos(ANGLE), 0.033
    path = np.sqrt(tip**2 - base**2) - radius * np.sin(ANGLE) + MODULE / np.sin(ANGLE)
    ratio = path / (np.pi * MODULE * np.cos(ANGLE))
    assert found["transverse_contact_ratio"] == pytest.approx(ratio, rel=1e-13)
    assert found["contact_ratio"] == found["transverse_contact_ratio"]
    np.testing.assert_allclose(found["motion"], [1.0, radius], rtol=1e-15)
    assert found["period"] == pytest.approx(2.0 * np.pi / 20.0, rel=1e-15)
    assert found["reference"].radius == pytest.approx(radius * np.sin(ANGLE), rel=1e-14)
    assert abs(found["circumferential_backlash"]) < 1e-15


def test_a_larger_distance_gives_backlash_and_no_other_pressure_angle():
    found = jax.device_get(dimensions(rack(profile_shift=0.2, mounting_distance="30.7 mm")))
    away = 30.7e-3 - (30e-3 + 0.2 * MODULE)
    play = 2.0 * away * np.tan(ANGLE)
    assert found["circumferential_backlash"] == pytest.approx(play, rel=1e-12)
    assert found["normal_backlash"] == pytest.approx(play * np.cos(ANGLE), rel=1e-12)


def test_a_helical_rack_moves_by_the_transverse_pitch():
    found = jax.device_get(dimensions(rack(helix_angle="15 deg", face_width="30 mm")))
    transverse = MODULE / np.cos(np.deg2rad(15.0))
    assert found["motion"][1] == pytest.approx(10.0 * transverse, rel=1e-14)
    overlap = 0.03 * np.sin(np.deg2rad(15.0)) / (np.pi * MODULE)
    assert found["overlap_ratio"] == pytest.approx(overlap, rel=1e-14)


def design(mesh):
    return Design(mesh, (STEEL, STEEL), OIL, Roughness.from_composite_rq(0.4e-6))


def figures(mesh, load, sharing):
    models = Models(
        friction=(CONSTANT,),
        choice=jnp.asarray(0),
        parameters={"constant": {"coefficient": jnp.asarray(0.08)}},
        sharing=LOAD_SHARING[sharing],
        rolling=ROLLING_RESISTANCE["none"],
        compliance=terms_of("beam_hertz"),
    )
    point = Operation(*map(jnp.asarray, (load, 30.0, 330.0)))
    found = summarise([(design(mesh), point)], models)
    return np.array([found[name][0] for name in ("mean_efficiency", "mean_input_torque")])


@pytest.mark.whole
@pytest.mark.parametrize("sharing", ["sanchez_2017", "from_stiffness"])
def test_it_is_the_limit_of_a_wheel_with_more_and_more_teeth(sharing):
    """Errors fall with the number of teeth: two wheels and their extrapolation."""
    force = 2000.0

    def wheel(teeth):
        pair = build_cylindrical_pair(
            teeth=(20, teeth), module=MODULE, pressure_angle=ANGLE, face_width=0.025
        )
        return figures(pair, force * MODULE * teeth / 2.0, sharing)

    few, many = wheel(2000), wheel(4000)
    expected = 2.0 * many - few
    found = figures(rack(), force, sharing)
    np.testing.assert_allclose(found, many, rtol=1e-4)
    np.testing.assert_allclose(found, expected, rtol=2e-7)


@program
def yielding(mesh):
    section = tooth_sections(mesh)[1]
    return beam_compliance(section, STEEL.poisson), section.load_angle, section.flank


def test_a_tooth_of_the_rack_yields_as_that_of_a_wheel_with_very_many():
    pair = build_cylindrical_pair(
        teeth=(20, 20_000), module=MODULE, pressure_angle=ANGLE, face_width=0.025
    )
    own, wheel = (jax.device_get(yielding(mesh)) for mesh in (rack(), pair))
    for at in (0, -1):  # the nodes between lie elsewhere
        np.testing.assert_allclose(own[0][at], wheel[0][at], rtol=2e-3)
        np.testing.assert_allclose(own[1][at], wheel[1][at], rtol=2e-3)
        np.testing.assert_allclose(own[2][0, at], wheel[2][0, at], rtol=2e-3)


@program
def starts(mesh):
    """Place of A on the line of action, of the form circle, and of the tips of the rack [m]."""
    line = mesh.line
    tips = line.at_depth(mesh.distance - mesh.rack.tip)
    return line.limits[0], mesh.pinion.form_roll_length, tips


def test_an_undercut_pinion_loses_the_path_below_its_form_circle():
    mesh, told = built(teeth=12)
    whole = rack(teeth=12, profile_shift=0.4)
    assert any("undercut" in sentence for sentence in told)
    assert mesh.pinion.undercut and not whole.pinion.undercut
    start, form, tips = map(float, starts(mesh))
    assert start == pytest.approx(form, rel=1e-12)
    assert start > tips


BAD = {
    "mounting_distance": ({"mounting_distance": "29.9 mm"}, "flanks overlap"),
    "bore_diameter": ({"bore_diameter": "60 mm"}, "smaller than its root circle"),
    "profile_shift": ({"profile_shift": 2.0, "addendum": [1.4, 1.0]}, "point of its teeth"),
    "dedendum": ({"dedendum": [1.25, 0.9]}, "runs into the root"),
    "addendum": ({"addendum": [0.3, 0.3]}, "contact ratio"),
    "fillet_radius": ({"dedendum": [1.4, 1.4], "fillet_radius": 0.6}, "fillet"),
}


@pytest.mark.parametrize("key", BAD)
def test_what_cannot_run_is_refused_in_one_sentence(key):
    given, words = BAD[key]
    with pytest.raises(InputError, match=words) as caught:
        rack(**given)
    assert caught.value.key == key


def test_a_rack_far_away_loses_its_contact():
    for distance in ("33 mm", "80 mm", "610 mm"):
        with pytest.raises(InputError, match="reach too little into each other") as caught:
            rack(mounting_distance=distance)
        assert caught.value.key == "mounting_distance"


def test_a_rack_without_a_tip_blames_what_can_be_changed():
    with pytest.raises(InputError, match="no tip left at the dedendum") as caught:
        rack(pressure_angle="45 deg")
    assert caught.value.key == "dedendum"


def test_both_senses_and_both_flanks_give_the_same_efficiency():
    mesh = rack()
    other = dataclasses.replace(mesh, right_flank=~mesh.right_flank)
    one, mirrored = (figures(each, 2000.0, "sanchez_2017") for each in (mesh, other))
    np.testing.assert_allclose(mirrored, one, rtol=1e-13)
