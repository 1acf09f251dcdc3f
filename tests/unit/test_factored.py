"""Products that keep their factors are the arrays that they stand for."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pitchpoint.core.factored import (
    Factored,
    factored_product,
    log,
    product_array,
    scaled,
    square_root,
)
from pitchpoint.lubrication.conditions import law_arguments
from pitchpoint.lubrication.lubrication_registry import LAWS

ROW = jnp.asarray([[0.5, 2.0, 3.0]])
COLUMN = jnp.asarray([[0.1], [7.0]])
BOTH = factored_product(ROW, COLUMN, 4.0)
PLAIN = np.asarray(ROW) * np.asarray(COLUMN) * 4.0


def test_it_is_an_array_to_whoever_asks():
    assert BOTH.shape == PLAIN.shape
    assert BOTH.dtype == PLAIN.dtype
    np.testing.assert_allclose(np.asarray(BOTH), PLAIN, rtol=1e-15)
    np.testing.assert_allclose(jnp.sqrt(BOTH), np.sqrt(PLAIN), rtol=1e-15)
    np.testing.assert_allclose(BOTH.sum(), PLAIN.sum(), rtol=1e-15)
    np.testing.assert_array_equal(BOTH > 5.0, PLAIN > 5.0)
    np.testing.assert_array_equal(BOTH[0, 1] == BOTH, np.isclose(PLAIN, PLAIN[0, 1]))
    assert len(BOTH) == 2
    np.testing.assert_allclose(
        factored_product(-2.0, -ROW * 3.0) ** 0.5, (6.0 * np.asarray(ROW)) ** 0.5
    )
    np.testing.assert_allclose(1.0 - BOTH + PLAIN, 1.0, rtol=1e-14)


def test_products_quotients_and_powers_keep_the_factors():
    for found, plain in (
        (BOTH * PLAIN, PLAIN**2),
        (2.0 * BOTH / ROW, 2.0 * PLAIN / np.asarray(ROW)),
        (1.0 / BOTH, 1.0 / PLAIN),
        (BOTH / BOTH, np.ones_like(PLAIN)),
        ((BOTH / 1e9) ** 0.1, (PLAIN / 1e9) ** 0.1),
        (abs(scaled(BOTH, -3.0)), 3.0 * PLAIN),
        (square_root(BOTH), np.sqrt(PLAIN)),
    ):
        assert isinstance(found, Factored)
        np.testing.assert_allclose(product_array(found), plain, rtol=1e-14)
    assert {jnp.shape(one) for one in (BOTH * ROW).merged} == {(), (1, 3), (2, 1)}


def test_logarithms_are_held_where_nothing_is():
    np.testing.assert_allclose(log(BOTH, 1e-12), np.log(PLAIN), rtol=1e-14)
    for zero in (factored_product(0.0 * ROW, COLUMN), 0.0 * PLAIN):
        np.testing.assert_array_equal(log(zero, 1e-12), np.full(PLAIN.shape, np.log(1e-12)))
    slope = jax.grad(lambda x: jnp.sum(log(factored_product(x, COLUMN), 1e-12)))(0.0 * ROW)
    np.testing.assert_array_equal(slope, 0.0)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_laws_take_products_as_they_take_arrays(law):
    wanted, _ = law_arguments(law.function)
    given = {name: law.check[0][name] for name in wanted}
    if not given:
        return
    parted = {
        name: factored_product(ROW / 2.0, COLUMN, 3.0, value) for name, value in given.items()
    }
    plain = {name: product_array(value) for name, value in parted.items()}
    np.testing.assert_allclose(law.function(**parted), law.function(**plain), rtol=1e-13)
