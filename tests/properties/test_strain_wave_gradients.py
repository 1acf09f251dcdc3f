"""Derivatives of a strain wave gear's efficiency and stiffness against differences.

A drive is only piecewise smooth in its dimensions: a pair comes to carry, a contact passes over a
joint of the flank or of the groove, into the next cell of the groove's table, or from root to tip.
Figures or their slopes then jump, if only by some 1e-5 of themselves, and a derivative is that of
the piece at hand. Of the drive below no such place lies within a change of 4e-5 of any dimension,
and differences stay within 2e-5. Where this file fails after a change of the model, look first
whether a place of that kind has come in between: the derivatives at both ends of a step then differ.
"""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle
from pitchpoint.gears.strain_wave.design import build_strain_wave
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.wind_up import wind_up
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
OIL = lubricants.find("pao-vg-220").build()
LAW = {law.name: law for law in LAWS}
FRICTION = ("constant", "xu_2007")
INPUTS = ("deflection", "convex_radius", "concave_offset", "viscosity")
FIGURES = ("efficiency", "stiffness", "wind_up", "stiffness_later", "wind_up_later")
OPERATION = Operation(*map(jnp.asarray, (20.0, 100.0, 320.0)))

STEP = 1e-5
ROUNDING = 2e-7
"""What differences over `STEP` leave of the rounding of figures: gaps are the small differences of
places far from the axis."""


def models(choice):
    return Models(
        tuple(LAW[name] for name in FRICTION),
        choice,
        {"constant": {"coefficient": jnp.asarray(0.07)}},
        LOAD_SHARING["from_stiffness"],
        ROLLING_RESISTANCE["none"],
    )


def design(values, mesh):
    """The drive with other dimensions, its groove swept anew, and other oil."""
    flank = dataclasses.replace(mesh.flank, convex_radius=values[1], concave_offset=values[2])
    line = dataclasses.replace(mesh.line, deflection=values[0])
    drive = dataclasses.replace(mesh, line=line, flank=flank).completed()
    oil = dataclasses.replace(OIL, nu_1=OIL.nu_1 * values[3], nu_2=OIL.nu_2 * values[3])
    return Design(drive, (STEEL, STEEL), oil, Roughness.from_composite_rq(0.4e-6))


@eqx.filter_jit
def figures_and_rates(values, direction, mesh, choice):
    """Logarithms of the figures and their derivatives along a direction: the one program here."""

    def figures(values):
        given, laws = design(values, mesh), models(choice)
        run = cycle(given, OPERATION, laws, nodes=3)
        load = jnp.full_like(run.phase, OPERATION.load)
        at = wind_up(
            given.mesh,
            given.loaded,
            given.solids,
            laws.compliance,
            load,
            run.phase,
            run.state.contacts,
        )
        (first, later, _), (near, far, _) = at.stiffness, at.wind_up
        return jnp.log(jnp.stack([run.mean_efficiency, first, near, later, far]))

    return jax.jvp(figures, (values,), (direction,))


@eqx.filter_jit
def nearest_and_rates(deflection, mesh, angle):
    """Nearest points in the groove as it is, with their derivatives by the deflection."""

    def nearest(deflection):
        line = dataclasses.replace(mesh.line, deflection=deflection)
        return dataclasses.replace(mesh, line=line).nearest(angle)

    return jax.jvp(nearest, (deflection,), (jnp.ones(()),))


@pytest.fixture(scope="module")
def mesh():
    return build_strain_wave(
        teeth=(100, 102),
        module=0.5e-3,
        face_width=0.01,
        form=DOUBLE_ARCS["flat"],
        walls="two modules",  # the rim of the drive that was looked through for such places
        deflection=1.0122,
        clearance=0.35,
    )


@pytest.fixture(scope="module")
def look(mesh):
    """Figures and their derivatives by the logarithm of one input, at a change of that logarithm."""
    flank = mesh.flank
    middle = (mesh.line.deflection, flank.convex_radius, flank.concave_offset, 1.0)
    middle = np.array(list(map(float, middle)))

    def at(name, law, change=0.0):
        one = np.array(INPUTS) == name
        values = middle * np.exp(change * one)
        given = (jnp.asarray(values), jnp.asarray(values * one), mesh)
        return map(np.asarray, figures_and_rates(*given, jnp.asarray(FRICTION.index(law))))

    return at


def differences(look, name, law, step):
    """Central differences of order four."""
    rows = [next(look(name, law, count * step)) for count in (-2, -1, 1, 2)]
    return np.array([1.0, -8.0, 8.0, -1.0]) @ np.array(rows) / (12.0 * step)


@pytest.mark.whole
@pytest.mark.parametrize("law", FRICTION)
@pytest.mark.parametrize("name", INPUTS[:3])
def test_derivatives_by_dimensions_equal_differences(look, name, law):
    _, found = look(name, law)
    assert np.min(np.abs(found)) > 1e3 * ROUNDING, "the input must matter"
    np.testing.assert_allclose(differences(look, name, law, STEP), found, rtol=1e-7, atol=ROUNDING)


@pytest.mark.whole
def test_derivatives_carry_from_a_dimension_to_the_next(look):
    """Where the rounding of the tip begins a fifth of them were off by any amount, as its place was that of
    a piece chosen by an order of equal numbers."""
    step = 1e-6
    looks = [look("convex_radius", "constant", count * step) for count in range(13)]
    figures, rates = map(np.array, zip(*looks, strict=True))
    risen = (rates[1:] + rates[:-1]) / 2.0 * step
    np.testing.assert_allclose(np.diff(figures, axis=0), risen, rtol=0.0, atol=1e-11)


@pytest.mark.whole
def test_derivative_by_viscosity_equals_differences(look):
    """Oil moves no flank, so nothing jumps and the step may be long."""
    found, *others = differences(look, "viscosity", "xu_2007", 1e-3)
    _, expected = look("viscosity", "xu_2007")
    assert abs(expected[0]) > 1e-3
    np.testing.assert_allclose(found, expected[0], rtol=1e-8)
    assert np.all(expected[1:] == 0.0)
    assert np.max(np.abs(others)) < 1e-11


@pytest.mark.whole
def test_viscosity_does_not_matter_to_dry_friction(look):
    (figures, rates), (others, _) = (
        look("viscosity", "constant"),
        look("viscosity", "constant", 0.1),
    )
    assert np.all(rates == 0.0)
    np.testing.assert_array_equal(figures, others)


def test_a_point_held_where_the_mate_ends_moves_with_the_deflection(mesh):
    """With its rounding; a plain flank leaves the mate with its end."""
    mesh = dataclasses.replace(mesh, edges_carry=True)
    w0, angle = mesh.line.deflection, jnp.deg2rad(jnp.asarray([41.9, 41.95, 42.0, 42.05]))
    found, rates = nearest_and_rates(w0, mesh, angle)
    held = jnp.abs(jnp.real(found.at.place) - mesh.groove.low) < 1e-4 * mesh.module
    assert np.all(held), "the point would be past the tip of the mate"
    low, high = (nearest_and_rates(w0 * factor, mesh, angle)[0] for factor in (1 - 1e-6, 1 + 1e-6))
    np.testing.assert_allclose((high.along - low.along) / (2e-6 * w0), rates.along, rtol=1e-6)


def test_sliding_reverses_at_the_event(mesh):
    angle = mesh.reversal + jnp.deg2rad(jnp.asarray([-0.01, 0.0, 0.01, 0.02]))
    before, at, after, _ = nearest_and_rates(mesh.line.deflection, mesh, angle)[0].at.sliding
    assert before > 0.0 > after
    assert abs(at) < 1e-3 * before
