"""Names say what they hold, and stand for one thing: what was reached is kept, see `tests/names.py`."""

import names

GENERIC_SHARE = 0.03
"""Of all assignments."""

FUNCTIONS = 89
"""Public names of functions that stand for two or more things."""


def test_few_names_are_generic():
    assert names.generic_share(names.assigned()) <= GENERIC_SHARE


def test_no_further_name_stands_twice():
    assert not names.repeated_classes(), sorted(names.repeated_classes())
    assert len(names.repeated_functions()) <= FUNCTIONS, sorted(names.repeated_functions())
