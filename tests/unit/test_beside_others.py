"""A program in single precision beside the package, in a process of its own."""

import os
import subprocess
import sys

BESIDE = """
import os

os.environ["OPENBLAS_NUM_THREADS"], before = "2", set(os.environ)
import jax, jax.numpy as jnp, numpy as np
jax.config.update("jax_compilation_cache_dir", "")

@jax.jit
def step(x):
    return jnp.sin(x) * 2.0 + jnp.arange(3.0)

assert step(1.0).dtype == jnp.float32
import pitchpoint as pp

found = pp.run("tian2024", only=["physical"], analyses=["operation"])["physical"].parts["operation"]
found = found.mean_efficiency
assert found.dtype == np.float64
assert step(1.0).dtype == jnp.zeros(1).dtype == jnp.float32
assert step(found.values[0, 0]).dtype == jnp.float32
assert not jax.config.jax_enable_x64 and jax.config.jax_compilation_cache_dir == ""
assert os.environ["OPENBLAS_NUM_THREADS"] == "2"
assert set(os.environ) - before <= {"EQX_ON_ERROR", "NPROC", "XLA_FLAGS"}

case = pp.load_case("tian2024", "physical")
assert jax.tree.leaves(case.design)[0].dtype == np.float64
asked = case.design, case.operation, case.models[0]
try:
    pp.cycle(*asked)
except pp.PitchpointError as error:
    assert "double precision" in str(error)
else:
    raise AssertionError("single precision is not refused")
with pp.double_precision():
    alone = pp.cycle(*asked).mean_efficiency
print(float(alone), float(found[0, 0]))
"""


def test_a_program_in_single_precision_stays_so():
    """And the numbers of the package are the same in double precision, in its scope and by functions."""
    done = subprocess.run(
        [sys.executable, "-c", BESIDE],
        env={name: value for name, value in os.environ.items() if name != "JAX_ENABLE_X64"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    by_function, by_run = map(float, done.stdout.split()[-2:])
    assert abs(by_function - by_run) < 1e-12
