"""Compiled programs: how many a process keeps."""

import numpy as np

from pitchpoint import _jax
from pitchpoint._jax import bound_programs, jax, jnp


def test_many_programs_are_unloaded_together(monkeypatch):
    @jax.jit
    def double(x):
        return 2.0 * x

    def fill(programs):
        for size in range(1, programs + 1):
            double(np.zeros(size))

    bound_programs()
    kept = _jax._LOADED["programs"]
    fill(4)
    assert _jax._LOADED["programs"] >= kept + 4
    bound_programs()
    assert double._cache_size() == 4
    monkeypatch.setattr(_jax, "MOST_PROGRAMS", _jax._LOADED["programs"] - 1)
    bound_programs()
    assert double._cache_size() == 0
    assert _jax._LOADED["programs"] == 0
    assert float(double(jnp.asarray(3.0))) == 6.0
