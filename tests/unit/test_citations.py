"""References as one line of text."""

from pitchpoint.citations import available, citation_text


def test_every_part_of_a_reference_ends_with_one_point() -> None:
    for key in available():
        assert ".." not in citation_text(key), key
    assert "3rd ed. S. H. Burbank" in citation_text("palmgren_1959")
