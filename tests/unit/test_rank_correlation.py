"""Which inputs matter, without Sobol' indices: rank correlations and main effects against closed forms."""

import numpy as np
import pytest

from pitchpoint.runs.rank_correlation import main_effect, rank_correlations


@pytest.mark.parametrize("slopes", [(1.0, 1.0), (3.0, -1.0), (1.0, 0.0)])
def test_ranks_of_normal_inputs_correlate_as_their_closed_form(slopes: tuple[float, float]) -> None:
    """Spearman's coefficient of two normal variables is 6/pi asin(r/2), with Pearson's r."""
    inputs = np.random.default_rng(1).normal(size=(2, 40_000))
    result = np.exp(0.3 * (np.array(slopes) @ inputs))  # ranks are those of the sum
    pearson = np.array(slopes) / np.hypot(*slopes)
    expected = 6.0 / np.pi * np.arcsin(pearson / 2.0)
    np.testing.assert_allclose(rank_correlations(inputs, result[None])[0], expected, atol=0.015)


def test_ties_have_their_mean_rank() -> None:
    """Ranks 1.5, 1.5, 3.5, 3.5, ... against 1, 2, 3, ...: 1 - 6 sum(d^2) / (n^3 - n) does not hold."""
    inputs = np.repeat(np.arange(6.0), 2)[None]
    result = np.arange(12.0)[None]
    ranks = 2.0 * inputs[0] + 1.5
    expected = np.corrcoef(ranks, result[0])[0, 1]
    assert rank_correlations(inputs, result)[0, 0] == pytest.approx(expected, rel=1e-12)


def test_what_does_not_vary_and_too_few_designs_have_none() -> None:
    inputs = np.stack([np.arange(12.0), np.ones(12)])
    result = np.stack([np.arange(12.0), np.where(np.arange(12) < 9, np.arange(12.0), np.nan)])
    ranked = rank_correlations(inputs, result)
    assert ranked[0, 0] == 1.0 and np.isnan(ranked[0, 1]) and np.isnan(ranked[1]).all()


def test_the_main_effect_of_a_sum_is_the_input_and_the_median_of_the_other() -> None:
    first, second = np.random.default_rng(2).uniform(size=(2, 48_000))
    effect = main_effect(first, first**2 + second)
    assert len(effect.place) == 12
    np.testing.assert_allclose(effect.place, (np.arange(12) + 0.5) / 12.0, atol=0.01)
    np.testing.assert_allclose(effect.median, effect.place**2 + 0.5, atol=0.03)
    np.testing.assert_allclose(effect.high - effect.low, 0.8, atol=0.04)


def test_few_values_of_an_input_are_groups_of_their_own() -> None:
    values = np.array([3.0, 1.0, 3.0, 1.0, 2.0])
    effect = main_effect(values, np.array([5.0, 1.0, 7.0, 3.0, np.nan]))
    assert effect.place.tolist() == [1.0, 3.0] and effect.median.tolist() == [2.0, 6.0]
