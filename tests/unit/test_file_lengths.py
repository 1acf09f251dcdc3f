"""Files of tests are parted by what they claim, so that a reader takes one in."""

from pathlib import Path

MOST = 600
"""Lines of a file."""


def test_no_file_of_tests_is_too_long():
    files = Path(__file__).parents[1].rglob("*.py")
    lines = {str(file): len(file.read_text("utf-8").splitlines()) for file in files}
    assert {file: count for file, count in lines.items() if count > MOST} == {}
