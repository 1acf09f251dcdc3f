"""Steady motions of several speeds in one program, which compiles for most of a minute.

`pytest tests/long/steady_motions_at_once.py`
"""

import numpy as np
import pytest
from analytic.test_motion_branches import GRID, RISING, found_at, vibrating

from pitchpoint.dynamics.steady_motion import steady_motions


def alike(found, expected, size):
    return np.max(np.abs(np.asarray(found) - np.asarray(expected))) <= size * np.ptp(expected)


def test_motions_found_at_once_are_those_found_one_by_one():
    speeds = (RISING[0], RISING[1])
    every = steady_motions(vibrating(), speeds, GRID)
    for number, speed in enumerate(speeds):
        alone = found_at(vibrating(), speed)
        assert int(every.status.code[number]) == int(alone.status.code)
        for name in ("transmission_error", "time", "load_power"):
            assert alike(getattr(every, name)[number], getattr(alone, name), 1e-10), name
        assert alike(every.found.force[number], alone.found.force, 1e-10)


@pytest.mark.parametrize("way", [1, -1], ids=["rising", "falling"])
def test_a_branch_that_is_followed_is_that_of_each_begun_from_the_one_before(way):
    speeds, state = RISING[::way], np.full(4, np.nan)
    every = steady_motions(vibrating(), speeds, GRID, follow=True)
    for number, speed in enumerate(speeds):
        alone = found_at(vibrating(), speed, state)
        state = alone.state
        assert int(every.status.code[number]) == int(alone.status.code)
        assert alike(every.transmission_error[number], alone.transmission_error, 1e-7)
