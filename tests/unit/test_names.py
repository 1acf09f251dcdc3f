"""Names say what they hold, and stand for one thing: what was reached is kept, see `tests/names.py`."""

import names

GENERIC_SHARE = 0.03
"""Of all assignments."""


def test_few_names_are_generic():
    assert names.generic_share(names.assigned()) <= GENERIC_SHARE


def test_no_name_of_a_class_stands_twice():
    assert not names.repeated_classes()


def test_no_name_of_a_function_stands_twice_without_a_reason():
    assert names.repeated_functions() == names.EXCUSED.keys()


def test_names_of_functions_say_what_they_give():
    assert not names.SAYS_NOTHING & names.public_functions().keys()


def test_no_stem_of_a_file_stands_more_than_twice():
    assert not names.repeated_stems()


def test_no_excuse_of_a_file_is_idle():
    for pattern in names.EXCUSED_FILES:
        assert len([*names.SOURCE.glob(pattern)]) > 1, pattern
