"""Designs built in batches: the numbers of one by one, a status of each, derivatives through building."""

import dataclasses
from math import radians

import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.checks import check_cylindrical
from pitchpoint.gears.cylindrical.design import (
    build_cylindrical_pair,
    build_cylindrical_pairs,
    designed_pair,
)
from pitchpoint.gears.strain_wave.design import (
    INTERFERENCE,
    build_strain_wave,
    build_strain_waves,
    designed_strain_wave,
)
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS

RACK = {"module": 2e-3, "pressure_angle": radians(20.0), "face_width": 18e-3, "least_tip": 0.3}
TEETH = np.array([[23, 61], [10, 61], [18, 36], [18, 36], [10, 40], [20, -70], [23, 61], [18, 36]])
SHIFTS = np.array(
    [
        [0.4, -0.2],
        [0.1, 0.0],
        [-3.0, 0.0],
        [0.0, 0.0],
        [0.6, 0.0],
        [0.0, 0.0],
        [0.0, 0.0],
        [0.2, 0.1],
    ]
)
HELIX = np.radians([0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 10.0])
BAD = 2


def one_by_one(number):
    return build_cylindrical_pair(
        teeth=tuple(map(int, TEETH[number])),
        profile_shift=tuple(SHIFTS[number]),
        helix_angle=float(HELIX[number]),
        addendum=(1.0, 0.8),
        fillet_radius=(0.25, 0.25),
        **RACK,
    )


@pytest.fixture(scope="module")
def designs():
    return build_cylindrical_pairs(
        teeth=TEETH,
        profile_shift=SHIFTS,
        helix_angle=HELIX,
        addendum=(1.0, 0.8),
        fillet_radius=(0.25, 0.25),
        **RACK,
    )


def static(pair):
    return pair.helical, pair.internal, pair.undercut, pair.shortened, pair.follows, pair.slices


@pytest.mark.parametrize("number", [n for n in range(len(TEETH)) if n != BAD])
def test_a_pair_of_a_batch_is_that_built_alone(designs, number):
    alone, found = one_by_one(number), designs[number]
    assert static(found) == static(alone)
    assert found.lanes >= alone.lanes
    for ours, theirs in zip(jax.tree.leaves(found), jax.tree.leaves(alone), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-300)
    assert designs.check(number) == check_cylindrical(alone)


def test_the_batch_holds_every_kind_of_pair(designs):
    kinds = {static(group.mesh) for group in designs.groups}
    assert {kind[:2] for kind in kinds} == {(False, False), (True, False), (False, True)}
    assert {kind[2][0] for kind in kinds} == {kind[3][0] for kind in kinds} == {True, False}
    numbers = np.concatenate([group.numbers for group in designs.groups])
    assert sorted(numbers) == list(range(len(designs))) == list(range(len(TEETH)))


def test_a_bad_design_says_why_and_harms_no_other(designs):
    assert designs.good.tolist() == [number != BAD for number in range(len(TEETH))]
    assert int(designs.status.code[BAD]) == Code.NO_DESIGN
    assert "no gears that can run" in designs.status.sentence
    with pytest.raises(InputError) as alone:
        check_cylindrical(one_by_one(BAD))
    assert designs.sentence(BAD) == str(alone.value)
    assert designs.sentence(0) == ""


def test_numbers_of_designs_that_do_not_agree_are_told():
    with pytest.raises(InputError, match="2 of module, 3 of profile_shift"):
        build_cylindrical_pairs(
            teeth=(18, 36),
            module=np.full(2, 2e-3),
            profile_shift=np.zeros((3, 2)),
            pressure_angle=radians(20.0),
            face_width=18e-3,
        )


@program
def _figures(pair, shift, angle):
    """Contact ratio, centre distance, base and tip radii, with their derivatives through building."""

    def figures(at):
        changed = dataclasses.replace(pair, profile_shift=at[:2], pressure_angle=at[2])
        found, _ = designed_pair(changed)
        lengths = jnp.stack([found.centre_distance, *found.base_radii, *found.tip_radii])
        return jnp.concatenate([found.contact_ratio[None], lengths / found.module])

    at = jnp.concatenate([shift, angle[None]])
    return figures(at), jax.jacfwd(figures)(at)


@pytest.mark.whole
@pytest.mark.parametrize("number", [0, 1, 4])
def test_derivatives_through_building_agree_with_differences(designs, number):
    pair, step = designs[number], 1e-6
    shift, angle = pair.profile_shift, pair.pressure_angle
    _, slopes = _figures(pair, shift, angle)
    for place, move in enumerate(np.eye(3) * step):
        beyond, _ = _figures(pair, shift + move[:2], angle + move[2])
        before, _ = _figures(pair, shift - move[:2], angle - move[2])
        differences = (beyond - before) / (2.0 * step)
        np.testing.assert_allclose(slopes[:, place], differences, rtol=1e-6, atol=1e-7)
    assert np.all(np.abs(slopes[0]) > 1e-3)


WAVE = {"module": 0.5e-3, "face_width": 0.01, "form": DOUBLE_ARCS["flat"], "clearance": 0.35}
DEFLECTIONS = [1.01, 1.0, 3.0, 1.01]
SPLINES = [(100, 102), (101, 103), (100, 102), (100, 102)]
SHAPES = ["cosine", "cosine", "cosine", "four_forces"]


@pytest.fixture(scope="module")
def waves():
    return build_strain_waves(teeth=SPLINES, deflection=DEFLECTIONS, shape=SHAPES, **WAVE)


@pytest.fixture(scope="module")
def wave():
    return build_strain_wave(teeth=SPLINES[0], deflection=DEFLECTIONS[0], **WAVE)


def test_a_strain_wave_gear_of_a_batch_is_that_built_alone(waves, wave):
    found = waves[0]
    assert (found.odd, found.conjugate) == (wave.odd, wave.conjugate)
    assert found.lanes >= wave.lanes
    for ours, theirs in zip(jax.tree.leaves(found), jax.tree.leaves(wave), strict=True):
        finite = np.asarray(theirs, dtype=float)[np.isfinite(theirs)]
        scale = np.max(np.abs(finite), initial=0.0)
        np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-12 * scale)


def test_a_bad_strain_wave_gear_says_why_and_harms_no_other(waves):
    assert waves.good.tolist() == [True, True, False, True]
    assert waves.sentence(2).startswith("deflection: the wave generator deflects the flexspline")
    with pytest.raises(InputError, match="more than its teeth are deep"):
        waves[2]
    assert np.isinf(waves.status.residual[2])
    assert np.all(waves.status.residual[waves.good] < INTERFERENCE)
    numbers = [group.numbers.tolist() for group in waves.groups]
    assert sorted(numbers) == [[0, 3], [1]]


@program
def _clearances(drive, deflection):
    """Clearances beside the long axis and the least one, over the module, and their derivatives."""

    def clearances(at):
        line = dataclasses.replace(drive.line, deflection=at * drive.module)
        found, _ = designed_strain_wave(dataclasses.replace(drive, line=line))
        return (
            found.nearest(jnp.deg2rad(jnp.array([-25.0, -20.0, -14.0, -9.0]))).clearance
            / found.module
        )

    return jax.jvp(clearances, (deflection,), (jnp.ones(()),))


@pytest.mark.whole
def test_derivatives_of_clearances_by_the_deflection_agree_with_differences(wave):
    at, step = wave.line.deflection / wave.module, 1e-5
    _, slopes = _clearances(wave, at)
    beyond, _ = _clearances(wave, at + step)
    before, _ = _clearances(wave, at - step)
    assert np.min(np.abs(slopes)) > 1e-3
    np.testing.assert_allclose(slopes, (beyond - before) / (2.0 * step), rtol=1e-5)


@pytest.mark.whole
def test_a_drive_that_overlaps_has_a_status_in_a_trace(wave):
    larger = dataclasses.replace(wave, conjugate=False, groove=_lowered(wave.groove, 0.01e-3))
    code = {name: int(_status(drive).code) for name, drive in (("good", wave), ("bad", larger))}
    assert code == {"good": Code.SOLVED, "bad": Code.NO_DESIGN}


def _lowered(groove, by):
    """The groove with flanks that stand in the way."""
    return dataclasses.replace(groove, half_width=groove.half_width - by)


@program
def _status(drive):
    return designed_strain_wave(drive)[1]
