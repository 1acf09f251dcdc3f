"""The search alone, over functions whose optimum is known."""

import numpy as np
import pytest

from pitchpoint.runs.optimum_search import ConstrainedSearch, even_shares, multipliers_of


def search_of(function, *limits, equal=(), derive=None, keys=2):
    """A search of functions of shares [design, key] that gives what they say, and no derivatives."""

    def evaluate(shares):
        return np.stack([function(shares.T), *(limit(shares.T) for limit in limits)], axis=1)

    def no_slopes(point):
        return np.full((1 + len(limits), keys), np.nan)

    of_equal = np.array(equal or [False] * len(limits), bool)
    return ConstrainedSearch(evaluate, derive or no_slopes, of_equal)


def solved(search, keys=2, around=True):
    for start in search.starts(even_shares(16, keys), 3):
        search.improve(start)
    if around:
        search.look_around()
    return search.best


def bowl(x):
    return (x[0] - 0.9) ** 2 + 2.0 * (x[1] - 0.8) ** 2


def test_an_optimum_inside():
    point, columns = solved(search_of(bowl), around=False)
    np.testing.assert_allclose(point, [0.9, 0.8], atol=1e-5)
    assert columns[0] < 1e-9


def test_a_constraint_holds_the_optimum_and_has_its_multiplier():
    """Least distance from a line: x + y <= 1 at a Lagrange multiplier of 2 (0.9 - x)."""
    search = search_of(bowl, lambda x: 1.0 - x[0] - x[1])
    point, columns = solved(search, around=False)
    over = 0.7  # by which the free optimum is over; the steps are as 2 to 1
    np.testing.assert_allclose(point, [0.9 - over * 2 / 3, 0.8 - over / 3], atol=1e-4)
    found = multipliers_of(search.slopes(point), columns, point, search.equal)
    np.testing.assert_allclose(found.constraints, [2.0 * over * 2 / 3], rtol=1e-3)
    assert found.ends.tolist() == [0.0, 0.0] and found.unbalanced < 1e-3
    assert columns[1] >= 0.0


def test_an_equality_is_met_from_either_side():
    for way in (1.0, -1.0):
        search = search_of(bowl, lambda x, way=way: way * (x[0] + x[1] - 0.6), equal=[True])
        point, columns = solved(search)
        assert abs(columns[1]) <= 1e-6
        np.testing.assert_allclose(point, [0.9 - 1.1 * 2 / 3, 0.8 - 1.1 / 3], atol=1e-4)
        found = multipliers_of(search.slopes(point), columns, point, search.equal)
        np.testing.assert_allclose(found.constraints, [-way * 2.2 * 2 / 3], rtol=1e-3)


def test_ends_of_ranges_hold_and_cost():
    search = search_of(lambda x: 3.0 * x[0] - x[1])
    point, columns = solved(search)
    assert point.tolist() == [0.0, 1.0]
    found = multipliers_of(search.slopes(point), columns, point, search.equal)
    np.testing.assert_allclose(found.ends, [3.0, 1.0], rtol=1e-9)


def test_the_best_of_several_valleys():
    def two(x):
        return np.minimum(bowl(x), 4.0 * (x[0] - 0.1) ** 2 + 4.0 * (x[1] - 0.1) ** 2 - 0.1)

    np.testing.assert_allclose(solved(search_of(two))[0], [0.1, 0.1], atol=1e-4)


def test_designs_that_are_refused_are_gone_along():
    """No constraint says where they begin: the optimum is on their edge."""

    def refused(x):
        return np.where(x[0] + x[1] > 1.0, np.nan, bowl(x))

    point, columns = solved(search_of(refused))
    assert point.sum() <= 1.0
    np.testing.assert_allclose(point, [0.9 - 0.7 * 2 / 3, 0.8 - 0.7 / 3], atol=5e-3)
    assert columns[0] == pytest.approx(0.98 / 3, rel=1e-3)


def test_kinks_do_not_stop_it():
    point, _ = solved(search_of(lambda x: np.abs(x[0] - 0.3) + np.abs(x[1] + x[0] - 0.7)))
    np.testing.assert_allclose(point, [0.3, 0.4], atol=1e-3)


def test_all_refused_has_no_best():
    search = search_of(lambda x: np.full(x.shape[1], np.nan))
    assert search.starts(even_shares(8, 2), 3) == [] and search.best is None


def test_what_misses_least_is_best_where_nothing_keeps_a_limit():
    search = search_of(bowl, lambda x: x[0] + x[1] - 3.0)
    point, columns = solved(search)
    np.testing.assert_allclose(point, [1.0, 1.0], atol=1e-4)
    np.testing.assert_allclose(search.missed(columns[None]), [[1.0]], atol=1e-4)


def test_derivatives_that_are_given_take_the_place_of_differences():
    asked = []

    def derive(point):
        asked.append(point)
        return np.array([[2.0 * (point[0] - 0.9), 4.0 * (point[1] - 0.8)]])

    search = search_of(bowl, derive=derive)
    starts = search.starts(even_shares(16, 2), 1)
    before = len(search.columns)
    search.improve(starts[0])
    assert asked and len(search.columns) - before < 20  # one design at each point, none beside it
    np.testing.assert_allclose(search.best[0], [0.9, 0.8], atol=1e-5)


@pytest.mark.parametrize("share", [0.0, 1e-5, 0.5, 1.0])
def test_differences_stay_within_the_ranges(share):
    seen = []

    def cubic(x):
        seen.append(x)
        return x[0] ** 3 + x[1]

    slopes = search_of(cubic).slopes(np.array([share, 0.5]))
    assert all(np.all((x >= 0.0) & (x <= 1.0)) for x in seen)
    np.testing.assert_allclose(slopes, [[3.0 * share**2, 1.0]], atol=1e-6)
