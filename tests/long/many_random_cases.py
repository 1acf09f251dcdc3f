"""Random cases by the thousand, beside the suite: `pytest tests/long/many_random_cases.py`."""

from properties.test_random_cases import explore


def test_many_random_cases() -> None:
    explore(2000)
