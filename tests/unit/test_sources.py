"""Formulas say where they come from: what was reached is kept, see `tests/sources.py`."""

import sources

PRINTED = 0.29
"""Of the public names of the rooms that compute, with a source in print."""

EITHER = 0.42
"""With that, or a derivation."""


def test_public_names_name_their_sources():
    printed, either = sources.shares()
    assert printed >= PRINTED, printed
    assert either >= EITHER, either
