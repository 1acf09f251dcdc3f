"""Sobol' indices against a closed form."""

import numpy as np
from scipy.stats import qmc

from pitchpoint.runs.sensitivity import indices_of


def ishigami(x, a=7.0, b=0.1):
    """Sobol and Levitan (1999)."""
    return np.sin(x[0]) + a * np.sin(x[1]) ** 2 + b * x[2] ** 4 * np.sin(x[0])


def test_indices_of_a_closed_form():
    """Ishigami's function: parts of the variance a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2."""
    a, b = 7.0, 0.1
    alone = [0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2, a**2 / 8.0, 0.0]
    shared = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)  # of the first and the third
    whole = sum(alone) + shared
    both = qmc.scale(qmc.Sobol(6, rng=1).random(2**14), -np.pi, np.pi).T
    first, second = both[:3], both[3:]
    swapped = [np.where((np.arange(3) == key)[:, None], second, first) for key in range(3)]
    found = indices_of(np.stack([ishigami(one) for one in (first, second, *swapped)])[None])
    np.testing.assert_allclose(found["first_order"][0], np.array(alone) / whole, atol=0.02)
    total = (np.array(alone) + np.array([shared, 0.0, shared])) / whole
    np.testing.assert_allclose(found["total_order"][0], total, atol=0.02)
    assert np.all(found["first_order_low"] <= found["first_order"])
    assert np.all(found["first_order"] <= found["first_order_high"])


def test_what_does_not_vary_has_no_indices():
    found = indices_of(np.ones((1, 4, 16)))
    assert np.isnan(found["total_order"]).all()
