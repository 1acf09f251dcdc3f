"""References as one line of text."""

from pitchpoint.citations import available, cite


def test_every_part_of_a_reference_ends_with_one_point() -> None:
    for key in available():
        assert ".." not in cite(key), key
    assert "3rd ed. S. H. Burbank" in cite("palmgren_1959")
