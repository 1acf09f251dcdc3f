"""The search for a double-arc tooth: what it finds is better, allowed, and makes a drive."""

from dataclasses import replace
from math import asin, atan, atan2, cos, degrees, hypot, pi, sqrt

import numpy as np
import pytest
from strain_wave_positions import DoubleArc, Drive, Made

from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.strain_wave import double_arc_fit
from pitchpoint.gears.strain_wave.design import build_strain_wave
from pitchpoint.gears.strain_wave.double_arc_fit import fit_double_arc, merit_of
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.strain_wave_registry import ARCS, DOUBLE_ARCS, DoubleArcForm

TEETH = (100, 102)
START = DOUBLE_ARCS["liu"]
SHORT = {"teeth": TEETH, "freedom": 0.1, "generations": 2, "population": 2}


@pytest.fixture(scope="module")
def found():
    return fit_double_arc(**SHORT)


@pytest.mark.whole
def test_a_short_search_betters_its_start(found):
    assert found.start == merit_of(START, teeth=TEETH)
    assert found.merit.objective < found.start.objective - 0.1
    assert found.evaluations == 14 * 3


@pytest.mark.whole
def test_the_merit_told_is_that_of_the_tooth_told(found):
    assert merit_of(found.form, found.deflection, teeth=TEETH) == found.merit
    figures = found.merit
    objective = 10.0 * figures.spread - figures.flank_share - figures.touching_share
    assert figures.objective == pytest.approx(objective, abs=1e-14)


@pytest.mark.whole
def test_the_same_seed_finds_the_same_tooth_and_tells_its_progress(found):
    told = []
    again = fit_double_arc(**SHORT, progress=lambda count, best: told.append((count, best)))
    assert again == found
    assert told[-1] == (found.evaluations, found.merit.objective)


@pytest.mark.whole
def test_the_tooth_found_obeys_every_condition(found):
    """Read from the seven numbers alone."""
    form = found.form
    across = pi / 2 + form.concave_offset + form.convex_offset
    up = form.concave_shift + form.convex_shift
    radii = form.convex_radius + form.concave_radius
    straight = sqrt(hypot(across, up) ** 2 - radii**2)
    tangent = atan2(up, across) + atan(straight / radii)
    tip = asin((form.addendum + form.convex_shift) / form.convex_radius)
    root = asin((form.dedendum + form.concave_shift) / form.concave_radius)
    assert 8.0 < degrees(tangent) < 18.0
    assert tangent < tip
    assert tangent < root
    assert 2.0 * (form.convex_radius * cos(tip) - form.convex_offset) > 0.3
    for name in ARCS:
        assert abs(getattr(form, name) / getattr(START, name) - 1.0) <= 0.1 + 1e-12
    assert 0.9 <= found.deflection <= 1.1
    assert (form.addendum, form.dedendum) == (START.addendum, START.dedendum)


@pytest.mark.whole
def test_the_tooth_found_makes_a_drive_without_interference(found):
    """Every place of the flank on its way against the groove: outlines and positions alone."""
    module = 0.5e-3
    drive = build_strain_wave(
        teeth=TEETH,
        module=module,
        face_width=0.01,
        form=found.form,
        deflection=found.deflection,
        walls="two modules",  # as the search has them
    )
    made = Made() * module
    flank = DoubleArc(found.form, module, float(drive.rim.thickness), made)
    neutral, wave = float(drive.line.radius), found.deflection * module
    passing = Drive(flank, TEETH, neutral, wave, (1.0,), made)
    stations = np.linspace(0.0, 1.0, 400)[:, None] * flank.length
    angle = np.deg2rad(np.linspace(-40.0, 89.0, 200))
    places = passing.place(stations, angle)
    height, width = np.asarray(drive.groove.made), np.asarray(drive.groove.half_width)
    inside = places.real > height[0]
    play = np.interp(places.real, height, width) - places.imag
    assert np.min(play[inside]) > -1e-3 * module
    nearest = np.min(np.where(inside, play, np.inf), axis=0)
    zone = (angle > 0.0) & (angle < np.deg2rad(36.0))
    touching = np.mean(nearest[zone] < 1e-3 * module)
    assert touching == pytest.approx(found.merit.touching_share, abs=0.1)


@pytest.mark.whole
def test_another_clearance_and_rim_are_kept():
    given = {"clearance": 0.35, "rim": 1.5}
    found = fit_double_arc(**SHORT, **given)
    assert found.merit == merit_of(found.form, found.deflection, teeth=TEETH, **given)
    assert found.merit != merit_of(found.form, found.deflection, teeth=TEETH)


@pytest.mark.whole
def test_a_tooth_that_makes_no_drive_is_passed_over(found, monkeypatch):
    refused = [found.form]

    def build(*, form, **given):
        if not refused or form in refused:
            raise InputError("flexspline and circular spline interfere", key="form")
        return object.__new__(StrainWave)

    monkeypatch.setattr(double_arc_fit, "build_strain_wave", build)
    second = fit_double_arc(**SHORT)
    assert second.form != found.form
    assert found.merit.objective < second.merit.objective < 100.0
    refused.clear()
    with pytest.raises(ConvergenceError, match="no tooth that was found makes a drive"):
        fit_double_arc(**SHORT)


def test_bounds_of_negative_dimensions_are_kept():
    low, high = np.transpose(double_arc_fit._bounds(np.array([-0.2, 0.9, 1.0]), 0.25))
    np.testing.assert_allclose(low, [-0.25, 0.675, 0.9])
    np.testing.assert_allclose(high, [-0.15, 1.125, 1.15])


def test_a_tooth_that_is_not_allowed_is_told_so():
    steep = replace(START, convex_offset=START.convex_offset - 0.3)
    found = merit_of(steep, teeth=TEETH)
    assert not found.allowed
    assert (found.flank_share, found.touching_share, found.spread) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("change", "error", "sentence"),
    [
        ({"start": DoubleArcForm(1.0, -0.5, 0.3, 1.0, -0.5, 0.3)}, ConvergenceError, "tangent"),
        ({"start": replace(START, convex_shift=0.0)}, InputError, "convex_shift of the start is"),
        ({"freedom": 0.0}, InputError, "freedom"),
        ({"teeth": (100, 101)}, InputError, "teeth: 100 and 101 teeth were given"),
        ({"clearance": 2.0}, InputError, "clearance of 2 modules"),
    ],
)
def test_a_hopeless_search_ends_with_one_clear_sentence(change, error, sentence):
    with pytest.raises(error, match=sentence) as caught:
        fit_double_arc(**(SHORT | change))
    assert "\n" not in str(caught.value)
