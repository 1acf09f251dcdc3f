"""Makes what several folders of tests share importable, and gives compiled programs back."""

from collections.abc import Iterator

import jax
import pytest


@pytest.fixture(autouse=True, scope="module")
def _compiled_programs_of_this_file_alone() -> Iterator[None]:
    """Programs of other files are not used again; kept, they exhaust the memory maps of a process."""
    yield
    jax.clear_caches()
