"""Flanks and grooves of strain wave gears, from positions alone."""

from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest
from loaded_strain_wave import passing as passing_teeth
from loaded_strain_wave import wound, yielding
from sound import OnDemand, quick_first
from strain_wave_forms import BY, FORMS, MODULE, build
from strain_wave_positions import drive, slope

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.gears.tooth_section import tooth_sections

LOW_RIDGE = 2e-8
"""Ridges of the play so low part no valleys for the library, which looks at few places [m]."""


@pytest.fixture(scope="module")
def drives():
    return OnDemand(lambda name: build(form=FORMS[name]))


@eqx.filter_jit
def of_groove(groove, height):
    return groove.width_and_slope(height), groove.made


# Flanks and grooves.
@pytest.fixture(scope="module", params=quick_first(FORMS))
def pair(request, drives):
    mesh, by = drives[request.param], BY[request.param]
    space = by.groove(float(mesh.groove.low))
    return SimpleNamespace(name=request.param, mesh=mesh, by=by, space=space)


@pytest.mark.whole
def test_groove_is_the_outermost_place_of_the_tooth(pair):
    """With ridges blended, tips relieved and rounded, and room at the bottom."""
    groove, space = pair.mesh.groove, pair.space
    (known, _), nodes = jax.tree.map(np.asarray, of_groove(groove, jnp.asarray(space.heights)))
    between = np.abs(np.asarray(known) - space.widths)
    inside = nodes[nodes < nodes[-1] - 1e-7][::7]
    found, slopes = map(np.asarray, of_groove(groove, jnp.asarray(inside))[0])
    error = np.abs(found - space.width(inside))
    ridge = space.on_ridge(inside)
    assert ridge.any() == (pair.name == "flat")
    assert np.max(error[~ridge]) < 1e-10
    assert np.max(error, initial=0.0, where=ridge) < 2e-10  # ridges are found by parabolas
    smooth = space.smooth(inside)
    assert smooth.mean() > 0.4
    rate = slope(space.width, inside[smooth], 2e-7)
    turned = np.abs(slopes[smooth] - rate) / (1.0 + rate**2)
    assert np.max(turned[~ridge[smooth]]) < 1e-6
    assert np.max(turned) < 1e-5
    # The table goes smoothly round edges, which a cell of it wide.
    assert between.max() < (1e-7 if pair.name == "involute" else 5e-9)
    assert np.median(between) < 1e-12


@pytest.mark.parametrize("shape", quick_first([None, "two_rollers", "elliptical"]))
def test_teeth_pass_the_whole_turn_without_interference(drives, pair, shape):
    """Every part of a tooth, at every phase, is in the space or inside the tips beside it."""
    mesh, by = pair.mesh, pair.by
    if shape:
        if pair.name == "involute":
            # No case that is shipped has involute teeth on these wave generators; without a shape they ran.
            pytest.skip("the double-arc pairs are those that are shipped")
        mesh = build(form=FORMS[pair.name], shape=shape)
        by = drive(FORMS[pair.name], weights=np.asarray(mesh.line.weights))
    heights, widths = np.asarray(mesh.groove.made), np.asarray(mesh.groove.half_width)
    station = np.append(np.linspace(0.0, 1.0, 400) * by.outline.length, by.outline.length)
    angle = np.deg2rad(np.arange(-90.0, 90.01, 0.1))[:, None]
    flank = by.place(station, angle)
    tooth = np.concatenate([flank, by.mirrored(station, angle)], axis=1)
    # The end of the rounding closes the outline with a straight tip land.
    last = tooth[:, [station.size - 1]]
    land = last + np.linspace(0.0, 1.0, 9) * (tooth[:, [-1]] - last)
    outline = np.concatenate([tooth, land], axis=1)
    pitch = 2.0 * np.pi / float(mesh.teeth[1])
    outline = outline * np.exp(-1j * pitch * np.round(np.angle(outline) / pitch))
    within = outline.real >= heights[0]
    room = np.interp(outline.real, heights, widths, right=-np.inf) - np.abs(outline.imag)
    deepest = outline.real > heights[-1]  # above it there is the ground of the space
    room = np.where(deepest, widths[-1] - np.abs(outline.imag), room)
    assert np.min(room[within]) > -3e-8
    assert heights[-1] - outline.real.max() > 0.15 * MODULE, "the bottom is clear"
    assert not within[np.abs(np.degrees(angle[:, 0])) > 88.0].any(), (
        "teeth are free at the short axis"
    )


def engaged(mesh, phases, torque):
    """Contacts at phases under a torque."""
    (part,) = passing_teeth(mesh, phases)
    contacts, carried = part[0], wound(mesh, part, torque)
    arm = np.abs(contact_velocity(np.asarray(contacts.normal), np.asarray(mesh_ends(mesh)[1])))[
        :, 0
    ]
    found = {
        "angle": 2.0 * np.pi * np.asarray(contacts.path[:, 0]),
        "active": contacts.active[:, 0],
        "gap": contacts.gap[:, 0],
        "force": carried.force[:, 0],
        "moved": yielding(mesh, *part, jnp.asarray(torque), carried.force),
        "reach": arm * np.asarray(carried.wind_up + carried.touch),
    }
    return SimpleNamespace(**{k: np.asarray(v)[:, : len(phases)] for k, v in found.items()})


@pytest.fixture(scope="module")
def loaded(pair):
    """At each place the clearance of its valley by positions: of two the first is nearer to the root."""
    mesh, by = pair.mesh, pair.by
    found = engaged(mesh, [0.0, 0.21, 0.43, 0.64, 0.86], 16.0)
    at, clear, rise = by.valleys(found.angle, pair.space)
    places = np.arange(found.angle.shape[0])
    found.first = np.isin(places, in_pairs(mesh, places[:, None], 0)[:, 0])[:, None]
    turned = np.isfinite(clear[1]) & (at[1] < at[0]) & (rise > LOW_RIDGE)
    own = found.first != turned
    found.clearance = np.where(own, clear[0], clear[1])
    found.along = np.where(own, at[0], at[1])
    found.rise = rise
    found.name = pair.name
    reach = by.place(by.outline.plain, found.angle).real
    found.inside = found.active & (reach > pair.space.low + by.made.rounding)
    return found


def test_gaps_are_those_of_the_positions(loaded):
    assert np.all(np.isinf(loaded.clearance[~loaded.active & loaded.first]))
    assert np.all(loaded.rise[~loaded.active & ~loaded.first] < LOW_RIDGE)
    assert loaded.inside.sum() > 0.7 * loaded.active.sum()
    second = loaded.inside & ~loaded.first
    assert second.any() == (loaded.name != "involute"), "pairs may touch at two places"
    found, expected = loaded.gap[loaded.inside], loaded.clearance[loaded.inside]
    np.testing.assert_allclose(found, np.maximum(expected, 0.0), rtol=1e-4, atol=1e-8)


def test_pairs_that_count_as_touching_touch_and_none_lies_inside(loaded):
    """Where relieved tips would touch there may be a few nanometres between all pairs."""
    nearest = np.where(loaded.active, loaded.gap, np.inf).min(axis=0)
    assert np.max(nearest) < (1e-12 if loaded.name == "flat" else 1e-8)
    touching = loaded.active & (loaded.gap < 1e-12)
    assert np.all((touching.sum(axis=0) >= 2) | (nearest > 1e-12))
    assert np.max(np.abs(loaded.clearance[touching])) < 1e-9
    assert np.min(loaded.clearance) > -1e-9


def test_all_teeth_that_touch_are_held(pair, loaded):
    mesh, angle = pair.mesh, np.deg2rad(np.arange(-90.0, 90.0, 0.25))
    near = pair.by.valleys(angle, pair.space)[1][0] < 1e-3 * float(mesh.module)
    assert loaded.angle.min() < angle[near].min()
    assert angle[near].max() < loaded.angle.max()
    assert np.degrees(angle[near].max()) < 50.0, "teeth have left"
    expected = 2.0 * np.pi * near.mean() / float(mesh.tooth_angle)
    assert float(mesh.pairs) == pytest.approx(expected, abs=0.5)
    assert mesh.groove.unsolved == 0


@pytest.mark.parametrize("name", quick_first(FORMS))
def test_tips_of_the_circular_spline_end_where_teeth_leave(name):
    """Or where the clearance ends them."""
    cutter, root = BY[name].cutter, BY[name].place(0.0, 0.0).real
    for clearance, angle in ((0.1, 50.0), (0.1, 40.0), (1.0, 50.0)):
        mesh = build(form=FORMS[name], clearance=clearance, disengagement=np.deg2rad(angle))
        leaves = cutter.place(cutter.outline.length, np.deg2rad(angle)).real
        clear = root + clearance * MODULE
        assert float(mesh.tip_height) == pytest.approx(max(leaves, clear), abs=1e-12)
        assert (leaves > clear) == (clearance < 0.5 or name == "involute")


@pytest.mark.parametrize("form", quick_first(FORMS))
def test_play_takes_no_pairs_away(drives, form):
    """It lies between all flanks alike and is taken up before the first of them touches."""
    without, found = drives[form], build(form=FORMS[form], backlash=20e-6)
    assert found.lanes == without.lanes
    # The play counts along the normal, so upright flanks have more of it than rounded tips.
    assert float(found.pairs) > 0.2 * float(without.pairs)


def test_load_closes_the_gap_of_every_pair_that_carries(loaded):
    """Tooth and ring yield by what the rigid motion moves a pair beyond its clearance."""
    carries = loaded.force > 0.0
    left = loaded.moved + loaded.clearance - loaded.reach
    assert np.all(loaded.force >= 0.0)
    assert np.all(carries.sum(axis=0) >= 6)
    assert np.any(loaded.clearance[carries] > 1e-8)
    assert np.max(np.abs(left[carries])) < 1e-8
    assert np.min(left[loaded.active & ~carries]) > -1e-8


@eqx.filter_jit
def sections_of(mesh):
    return [(jnp.stack(each.reach), *each.flank, each.slope) for each in tooth_sections(mesh)]


def test_tooth_sections_are_the_outlines(pair):
    """Half thickness, height and slope of the sections by which teeth yield."""
    mesh, by = pair.mesh, pair.by
    node = -np.cos(np.pi * np.arange(24) / 23.0)
    for index, section in enumerate(sections_of(mesh)):
        (low, high), half, height, rate_there = map(np.asarray, section)
        reach = (high + low + node * (high - low)) / 2.0
        place = by.outline.place if index == 0 else mate_outline(pair)
        expected = place(reach**2)
        tolerance = 1e-13 if index == 0 else 1e-7  # its arc length is that of chords
        np.testing.assert_allclose(half, expected.imag, atol=tolerance)
        np.testing.assert_allclose(height, expected.real, atol=tolerance)
        step = 1e-9 if index == 0 else 1e-7
        rate = (high - low) * reach * slope(lambda s, at=place: at(s).real, reach**2, step)
        error = np.abs(rate_there - rate)[1:-1]
        assert np.max(error) < (1e-5 if index == 0 else 5e-3) * np.max(np.abs(rate))
        assert np.all(half > 0.0)
        assert np.all(np.diff(height) > 0.0)


def mate_outline(pair):
    """Tooth of the circular spline by arc length from the deepest point of the groove."""
    heights, widths = pair.space.heights, pair.space.widths
    grown = np.hypot(np.diff(heights), np.diff(widths))
    depth = np.append(np.cumsum(grown[::-1])[::-1], 0.0)
    pitch = np.pi / float(pair.mesh.teeth[1])

    def place(at):
        height = np.interp(at, depth[::-1], heights[::-1])
        half = pitch * height - np.interp(height, heights, widths)
        return heights[-1] - height + 1j * half

    return place
