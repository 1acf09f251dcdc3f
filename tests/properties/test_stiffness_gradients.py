"""Derivatives of mesh stiffness and transmission error with respect to a design, against differences."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest
from sound import pair, quick_first

from pitchpoint._jax import jax, jnp
from pitchpoint.core.status import Code
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.pair_vibration import Vibrating, excited, steady, transmission_figures
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants
from pitchpoint.materials.solids import Solid
from pitchpoint.materials.surfaces import Roughness

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
PA66 = Solid(young=3.54e9, poisson=0.35, density=1140.0)
NAMES = ("x1", "x2", "helix angle", "width")
FIGURES = ("mean_stiffness", "transmission_error_range", "static_transmission_error_range")
GRID = PeriodGrid(4)
STEP = 1e-4
"""Relative step of central differences of order four: their own error is of the order of 1e-14."""


CASES = {
    "4/51 with a shortened tip": (
        pair((4, 51), 20.0, 1.5e-3, 16e-3, profile_shift=(0.74, 0.05), least_tip=0.25),
        (STEEL, PA66),
        (5.355, 3500.0),
    ),
    "24/95 of steel": (
        pair((24, 95), 10.0, 14e-3, 0.36, profile_shift=(0.48, 0.6691)),
        (STEEL, STEEL),
        (1e5, 60.0),
    ),
}


def models():
    constant = next(law for law in LAWS if law.name == "constant")
    return Models(
        (constant,),
        jnp.asarray(0),
        {"constant": {"coefficient": jnp.asarray(0.05)}},
        LOAD_SHARING["equal"],
        ROLLING_RESISTANCE["none"],
    )


def with_numbers(mesh, numbers):
    """The pair with these dimensions, and with what follows from them."""
    x1, x2, helix, width = numbers
    changed = dataclasses.replace(
        mesh, profile_shift=jnp.stack([x1, x2]), helix_angle=helix, face_width=width
    )
    # What is static is made alike afterwards, so that one program serves both pairs from here on.
    alike = {"follows": (False, False), "shortened": (False, False)}
    return dataclasses.replace(changed.completed(), **alike)


@eqx.filter_jit
def moved_mesh(numbers, direction, mesh):
    """The pair and its derivative in a direction."""
    return eqx.filter_jvp(lambda at: with_numbers(mesh, at), (numbers,), (direction,))


@eqx.filter_jit
def moved_excitation(mesh, direction, solids, point, vibrating):
    """Stiffness, system and excitation, and their derivative."""
    oil, roughness = lubricants.find("pao-vg-220").build(), Roughness.from_composite_rq(0.8e-6)

    def of(at):
        return excited(Design(at, solids, oil, roughness), point, models().compliance, vibrating)

    return eqx.filter_jvp(of, (mesh,), (direction,))


@eqx.filter_jit
def moved_figures(parts, directions):
    """Figures, their derivative, and the status."""

    def of(stiffness, moved, driven):
        found = transmission_figures(stiffness, moved, steady(moved, driven, GRID))
        return jnp.stack([found[name] for name in FIGURES]), found["vibration_status"]

    (values, status), (slope, _) = eqx.filter_jvp(of, parts, directions)
    return values, slope, status


class Moving:
    """Figures of one pair, and their derivatives, at its dimensions and around them."""

    def __init__(self, mesh, solids, operation):
        density = jnp.stack([solid.density for solid in solids])
        none = jnp.zeros(0)
        self.vibrating = Vibrating(plain_inertia(mesh, density), jnp.asarray(0.16), none, none, ())
        self.mesh, self.solids = mesh, solids
        self.point = Operation(*map(jnp.asarray, (*operation, 330.0)))
        self.numbers = np.array(
            [*np.asarray(mesh.profile_shift), float(mesh.helix_angle), float(mesh.face_width)]
        )

    def at(self, numbers, direction):
        moved = moved_mesh(*map(jnp.asarray, (numbers, direction)), self.mesh)
        parts = moved_excitation(*moved, self.solids, self.point, self.vibrating)
        values, slope, status = jax.device_get(moved_figures(*parts))
        assert int(status) == Code.SOLVED
        return values, slope

    @property
    def slopes(self):
        """Derivatives [figure, number] as the library has them."""
        return np.stack([self.at(self.numbers, row)[1] for row in np.eye(4)], axis=1)

    @property
    def differences(self):
        """The same by central differences of order four, and the error that rounding leaves in them."""
        steps = STEP * np.abs(self.numbers)
        found = np.empty((len(FIGURES), 4))
        for k, step in enumerate(steps):
            rows = [
                self.at(self.numbers + move * step * np.eye(4)[k], np.zeros(4))[0]
                for move in (-2.0, -1.0, 1.0, 2.0)
            ]
            found[:, k] = np.array([1.0, -8.0, 8.0, -1.0]) @ rows / (12.0 * step)
        values = self.at(self.numbers, np.zeros(4))[0]
        return found, 3e-12 * np.abs(values)[:, None] / steps


@pytest.fixture(scope="module", params=quick_first(reversed(CASES)))
def moving(request):
    return Moving(*CASES[request.param])


def test_derivatives_equal_differences(moving):
    found, (expected, rounding) = moving.slopes, moving.differences
    off = np.abs(found - expected)
    assert np.all(off <= 1e-6 * np.abs(expected) + rounding), (NAMES, off / np.abs(expected))
    assert np.all(rounding < 1e-4 * np.max(np.abs(expected), axis=1)[:, None])


def test_derivatives_have_the_signs_that_gears_have(moving):
    """Wider faces are stiffer; a larger x1 shortens the path of these pairs."""
    slopes = moving.slopes
    assert slopes[0, 3] > 0.0
    assert slopes[0, 0] < 0.0
    assert np.all(slopes[1:, 0] > 0.0)
    assert np.all(np.abs(slopes) > 0.0), "a dimension has no derivative"


def test_what_follows_from_a_dimension_moves_with_it():
    """As if the pair were built anew: centre distance and shortened tips follow the profile shift."""
    mesh, solids, operation = CASES["4/51 with a shortened tip"]
    assert mesh.shortened == (True, False)
    here, step = Moving(mesh, solids, operation), 1e-4

    def anew(shift):
        """Mean stiffness of a pair built with this shift."""
        built = pair((4, 51), 20.0, 1.5e-3, 16e-3, profile_shift=(shift, 0.05), least_tip=0.25)
        one = Moving(built, solids, operation)
        return one.at(one.numbers, np.zeros(4))[0][0]

    expected = (anew(0.74 + step) - anew(0.74 - step)) / (2.0 * step)
    assert here.at(here.numbers, np.eye(4)[0])[1][0] == pytest.approx(expected, rel=1e-6)
