"""Asperities and the flow between them: integrals by another quadrature, limits, slopes, tables."""

from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.asperities import (
    gaussian_moment,
    greenwood_tripp_1970,
    greenwood_williamson_1966,
    greenwood_williamson_1966_exponential,
    hu_1994,
)
from pitchpoint.lubrication.flow_factors import (
    mean_gap,
    patir_cheng_1978,
    patir_cheng_1979_shear,
)

PATTERNS = [1.0 / 9.0, 1.0 / 6.0, 0.25, 1.0 / 3.0, 1.0, 2.0, 3.0, 6.0, 9.0]
EVERYWHERE = jnp.concatenate(
    [jnp.linspace(-60.0, 60.0, 481), jnp.array([0.0, 0.5, 0.75, 1.0, 5.0])]
)


def integral(order, ratio):
    """Moment of Gaussian heights in the variable whose square is the height above the gap."""

    def of(x):
        return 2.0 * x ** (2.0 * order + 1.0) * norm.pdf(ratio + x * x)

    peak = np.sqrt(max(-ratio, 0.0))
    ends = pairwise((max(peak - 3.0, 0.0), peak, peak + 4.0))
    parts = [quad(of, low, high, epsabs=0.0, epsrel=1e-12) for low, high in ends]
    return sum(part for part, _ in parts)


@partial(jax.jit, static_argnums=1)
def moment_and_slope(ratio, order):
    return jax.value_and_grad(gaussian_moment)(ratio, order)


mean_gap_of = jax.jit(mean_gap)
flow_of = jax.jit(patir_cheng_1978, static_argnames="pattern")
shear_of = jax.jit(patir_cheng_1979_shear, static_argnames=("share", "patterns"))


@pytest.mark.parametrize("order", [-0.5, 0.5, 1.5, 2.5])
@pytest.mark.parametrize("ratio", [-20.0, -12.1, -11.9, -3.0, -0.4, 0.0, 0.7, 2.0, 4.0, 8.0, 20.0])
def test_moments_of_gaussian_heights(order, ratio):
    found = float(moment_and_slope(ratio, order)[0])
    assert found == pytest.approx(integral(order, ratio), rel=1e-9)


@pytest.mark.parametrize("order", [-0.5, 0.5, 1.5, 2.5])
@pytest.mark.parametrize("ratio", [-15.0, -1.0, 0.0, 0.5, 3.0])
def test_slope_of_a_moment_against_differences(order, ratio):
    slope = float(moment_and_slope(ratio, order)[1])
    ahead, behind = (float(moment_and_slope(ratio + step, order)[0]) for step in (1e-5, -1e-5))
    assert slope == pytest.approx((ahead - behind) / 2e-5, rel=1e-6)


def test_asperities_in_full_contact_bear_as_their_mean_height():
    assert float(moment_and_slope(-200.0, 2.5)[0]) == pytest.approx(200.0**2.5, rel=1e-4)


def test_the_usual_fit_is_as_near_as_it_says():
    for ratio, low, high in (
        (0.0, -0.11, 0.0),
        (1.0, -0.11, 0.0),
        (2.0, -0.11, 0.0),
        (3.0, -0.75, -0.7),
    ):
        off = float(hu_1994(ratio=ratio)) / float(moment_and_slope(ratio, 2.5)[0]) - 1.0
        assert low <= off <= high
    assert float(hu_1994(ratio=5.0)) == 0.0


def test_pressure_after_greenwood_and_tripp_by_quadrature():
    found = float(greenwood_tripp_1970(gap=-0.2e-6, roughness_rq=0.4e-6, modulus=226.4e9))
    stiff = 16.0 * np.sqrt(2.0) * np.pi / 15.0 * 0.05**2 * np.sqrt(0.01) * 113.2e9
    assert found == pytest.approx(stiff * integral(2.5, -0.5), rel=1e-9)
    rougher = greenwood_tripp_1970(
        gap=-0.2e-6, roughness_rq=0.4e-6, modulus=226.4e9, eta_beta_sigma=0.1, sigma_over_beta=0.04
    )
    assert float(rougher) == pytest.approx(8.0 * found, rel=1e-12)


def test_pressure_after_greenwood_and_williamson_by_quadrature():
    summits = {"deviation": 0.3e-6, "radius": 20e-6, "density": 4e9, "modulus": 226.4e9}

    def pressure(heights):
        force = 4.0 / 3.0 * 113.2e9 * np.sqrt(20e-6)
        return 4e9 * quad(lambda z: force * z**1.5 * heights(z + 0.45e-6), 0.0, 3e-6)[0]

    gaussian = pressure(lambda z: norm.pdf(z / 0.3e-6) / 0.3e-6)
    found = greenwood_williamson_1966(gap=0.45e-6, **summits)
    assert float(found) == pytest.approx(gaussian, rel=1e-7)
    exponential = pressure(lambda z: np.exp(-z / 0.3e-6) / 0.3e-6)
    found = greenwood_williamson_1966_exponential(gap=0.45e-6, **summits)
    assert float(found) == pytest.approx(
        exponential, rel=2e-3
    )  # heights above 10 deviations are cut


LAWS = {
    "Greenwood-Tripp": lambda u: greenwood_tripp_1970(
        gap=u * 1e-6, roughness_rq=1e-6, modulus=2e11
    ),
    "fit": lambda u: hu_1994(ratio=u),
    "mean gap": lambda u: mean_gap(gap=u * 1e-6, roughness_rq=1e-6),
    **{
        f"flow {one:.2g}": lambda u, one=one: patir_cheng_1978(ratio=u, pattern=one)
        for one in PATTERNS
    },
    **{
        f"shear {one:.2g}": lambda u, one=one: patir_cheng_1979_shear(
            ratio=u, share=0.8, patterns=(one, 1.0)
        )
        for one in PATTERNS
    },
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_values_and_slopes_are_finite_everywhere(law):
    found, slope = jax.jit(jax.vmap(jax.value_and_grad(law)))(EVERYWHERE)
    assert np.isfinite(found).all() and np.isfinite(slope).all()


def test_mean_gap_of_gaussian_heights():
    for ratio in (-4.0, -1.0, 0.0, 0.7, 5.0):
        expected = quad(lambda z, u=ratio: (z + u) * norm.pdf(z), -ratio, -ratio + 12.0)[0]
        found = float(mean_gap_of(gap=ratio * 0.3e-6, roughness_rq=0.3e-6))
        assert found == pytest.approx(0.3e-6 * expected, rel=1e-8)
    gaps = np.asarray(mean_gap_of(gap=jnp.linspace(-20e-6, 6e-6, 99), roughness_rq=1e-6))
    assert (gaps > 0.0).all() and (np.diff(gaps) > 0.0).all()
    assert float(mean_gap_of(gap=2e-6, roughness_rq=0.0)) == 2e-6


@pytest.mark.parametrize(
    ("pattern", "ratio", "expected"),
    [
        (1.0, 0.5, 1.0 - 0.9 * np.exp(-0.28)),
        (1.0, 3.0, 1.0 - 0.9 * np.exp(-1.68)),
        (1.0 / 9.0, 3.0, 1.0 - 1.48 * np.exp(-1.26)),
        (9.0, 4.0, 1.0 + 0.87 * 4.0**-1.5),
    ],
)
def test_pressure_flow_factor_as_tabulated(pattern, ratio, expected):
    assert float(flow_of(ratio=ratio, pattern=pattern)) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_flow_is_that_of_smooth_surfaces_in_a_wide_gap_and_positive_in_any(pattern):
    factor = np.asarray(flow_of(ratio=jnp.linspace(-8.0, 12.0, 401), pattern=pattern))
    assert (factor > 0.0).all()
    assert factor[-1] == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize(
    ("pattern", "sign"), [(1.0 / 9.0, 1.0), (0.25, 1.0), (1.0, 1.0), (6.0, -1.0)]
)
def test_roughness_hinders_across_the_flow_and_helps_along_it(pattern, sign):
    factor = np.asarray(flow_of(ratio=jnp.linspace(-8.0, 12.0, 401), pattern=pattern))
    assert (sign * np.diff(factor) >= -1e-15).all()


def test_shear_flow_factor_as_tabulated():
    def of(ratio, **given):
        return float(shear_of(ratio=ratio, **given))

    assert of(2.0, share=1.0) == pytest.approx(1.899 * 2.0**0.98 * np.exp(-1.84 + 0.2), rel=1e-12)
    assert of(8.0, share=1.0) == pytest.approx(1.126 * np.exp(-2.0), rel=1e-12)
    assert of(2.0, share=0.5) == 0.0
    assert of(2.0, share=0.0) == -of(2.0, share=1.0)
    assert of(-1.0, share=1.0) == 0.0


@pytest.mark.parametrize("pattern", [1.0 / 9.0, 1.0 / 6.0, 1.0 / 3.0, 1.0, 3.0, 6.0, 9.0])
def test_both_branches_of_the_shear_flow_factor_meet(pattern):
    """A wrong constant of the table would show: each row has its own."""
    near, far = (
        float(shear_of(ratio=ratio, share=1.0, patterns=(pattern, 1.0)))
        for ratio in (5.0, 5.0 + 1e-12)
    )
    assert near == pytest.approx(far, rel=2e-3)
    low, high = (
        float(shear_of(ratio=ratio, share=1.0, patterns=(pattern, 1.0)))
        for ratio in (0.5 - 1e-9, 0.5 + 1e-9)
    )
    assert low == pytest.approx(high, rel=1e-7)
