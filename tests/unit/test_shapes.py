"""Types and array shapes are checked in every room that computes, from its first import on."""

from importlib import import_module

import numpy as np
import pytest
import shapes
from jaxtyping import TypeCheckError

from pitchpoint._jax import jax, jnp
from pitchpoint.contact import hertz
from pitchpoint.contact.hertz import line_pressure
from pitchpoint.core.factored import factored_product
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing
from pitchpoint.lubrication.film_thickness import dowson_higginson_1959

STEEL = 2.26e11


def test_shapes_that_do_not_fit_each_other_are_refused():
    with pytest.raises(TypeCheckError, match="parameter 'radius'"):
        line_pressure(line_load=np.ones(3), radius=np.ones(2), modulus=STEEL)
    assert line_pressure(line_load=np.ones(3), radius=np.ones((2, 1)), modulus=STEEL).shape == (
        2,
        3,
    )


def test_shapes_are_checked_inside_a_program():
    wrong = jax.jit(lambda load: line_pressure(line_load=load, radius=np.ones(2), modulus=STEEL))
    with pytest.raises(TypeCheckError, match="parameter 'radius'"):
        wrong(jnp.ones(3))


def test_a_product_has_the_shape_that_it_stands_for():
    at = {"viscosity": 0.05, "pressure_viscosity": 2e-8, "radius": np.ones(2), "modulus": STEEL}
    wrong = factored_product(np.ones(3), np.ones((4, 1)))
    with pytest.raises(TypeCheckError, match="parameter 'radius'"):
        dowson_higginson_1959(line_load=1e5, entrainment=wrong, **at)


def test_fields_of_a_module_are_checked():
    with pytest.raises(TypeCheckError, match="parameter 'width'"):
        FlexibleRing(*map(jnp.asarray, (0.03, 1e-3, [0.01, 0.01], 1e-3, 0.03, 1e10)))


def test_results_are_checked(monkeypatch):
    monkeypatch.setattr(hertz, "square_root", lambda _: np.ones(2))
    with pytest.raises(TypeCheckError, match="return value"):
        hertz.line_pressure(line_load=np.ones(3), radius=0.01, modulus=STEEL)


@pytest.mark.parametrize("room", shapes.rooms())
def test_nothing_was_imported_before_the_checks(room):
    assert type(import_module(room).__loader__).__name__ == "_JaxtypingLoader"
