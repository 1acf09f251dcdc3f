"""Compiled programs: how many a process keeps, and on how many threads their factorisations run."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

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


THREADS = """
import ctypes
from pitchpoint._jax import jnp

jnp.linalg.cholesky(jnp.eye(3)).block_until_ready()
maps = {line.split()[-1] for line in open("/proc/self/maps") if "scipy.libs" in line}
library = ctypes.CDLL(next(path for path in maps if "openblas" in path))
print(library.scipy_openblas_get_num_threads())
"""


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="asks Linux for its libraries")
def test_factorisations_run_on_one_thread():
    environment = {name: value for name, value in os.environ.items() if "OPENBLAS" not in name}
    done = subprocess.run(
        [sys.executable, "-c", THREADS], env=environment, capture_output=True, text=True, check=True
    )
    assert int(done.stdout) == 1
