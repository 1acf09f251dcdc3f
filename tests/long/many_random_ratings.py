"""Random ratings by the thousand, beside the suite: `pytest tests/long/many_random_ratings.py`."""

from properties.test_random_ratings import explore


def test_many_random_ratings() -> None:
    explore(2000)
