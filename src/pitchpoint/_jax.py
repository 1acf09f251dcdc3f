"""The one place that configures JAX: a scope of double precision and a private, persistent compilation cache.

What else a process does with JAX keeps its precision: results come from within the scope.
"""

import os
import platform
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

# From 128 rows on the library behind a factorisation divides it among threads that spin while they wait:
# 24 of 144 rows take 3 ms of one thread and up to 850 ms of two on a busy machine. It reads this once.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

FEW_CORES = 4
"""Cores up to which compiled programs run on one of them."""

# Factorisations of a batch (LU and others in jaxlib 0.10.2, `ParallelBatchMap`) hand parts of it to the
# pool of threads on which they run themselves, and wait. As many of them at once as the pool has
# threads wait for each other without end: a program with eight batches of `jnp.linalg.solve` hangs on
# two threads within seconds, every time; on one they take the parts themselves. Two would bring
# nothing to a later run on two busy cores, three each: tian2024 took 7.8 to 12 s of CPU on one thread
# and 8.2 to 9.4 s on two, examples/strain_wave.toml 10.0 to 11.0 s and 9.5 to 10.3 s, and in wall time
# they could not be told apart.
# The pool is made with the first array and asks this variable for its size.
_ALLOWED = getattr(os, "sched_getaffinity", lambda _: range(os.cpu_count() or 1))(0)
if len(_ALLOWED) <= FEW_CORES:
    os.environ.setdefault("NPROC", "1")

# A loop whose pass touches fewer bytes than this becomes one machine function. Larger ones call a kernel
# for every few operations (so do all of more than 1 kB without this): of a motion of some coordinates
# these calls are three quarters of the time. XLA reads the variable once, with the first array.
LOOP_BYTES = 262_144

_FLAGS = os.environ.get("XLA_FLAGS", "")
if "xla_backend_extra_options" not in _FLAGS:
    _LOOPS = f"--xla_backend_extra_options=xla_cpu_small_while_loop_byte_threshold={LOOP_BYTES}"
    os.environ["XLA_FLAGS"] = f"{_LOOPS} {_FLAGS}".strip()

import jax  # noqa: E402
import jax.numpy as jnp  # noqa: E402
import numpy as np  # noqa: E402
from jax.typing import ArrayLike, DTypeLike  # noqa: E402

try:
    from jax.extend.core import get_opaque_trace_state
except ImportError:  # JAX 0.6
    from jax.core import get_opaque_trace_state

try:
    from jax import enable_x64
except ImportError:  # JAX 0.6
    from jax.experimental import enable_x64  # type: ignore[attr-defined,no-redef]

from pitchpoint.core.kept import base_folder, prepared_folder  # noqa: E402
from pitchpoint.errors import PitchpointError  # noqa: E402

__all__ = [
    "array",
    "cache_folder",
    "demand_double",
    "double_precision",
    "jax",
    "jnp",
    "kept_folder",
]


@contextmanager
def double_precision() -> Iterator[None]:
    """Double precision for what this thread does within `with`, or within a function under this decorator.

    The precision of JAX is that of the host again afterwards. `run`, `study` and whatever else takes a case
    are within it by themselves; functions of arrays, such as `cycle`, are called within it, or after
    `jax.config.update("jax_enable_x64", True)`.

    Example:
        >>> import jax.numpy as jnp
        >>> with double_precision():
        ...     print(jnp.zeros(1).dtype)
        float64
    """
    with enable_x64(True):
        yield


def demand_double() -> None:
    """PitchpointError in single precision, in which balances are lost in rounding."""
    if not jax.config.jax_enable_x64:  # type: ignore[attr-defined]
        raise PitchpointError(
            "functions of arrays compute in double precision, and JAX is in single: call them within "
            '`with pitchpoint.double_precision():`, or after jax.config.update("jax_enable_x64", True)'
        )


def cache_folder() -> Path:
    """Folder of compiled programs: under the user's cache, one for each kind of machine.

    Raises:
        RuntimeError: the user has no home.
    """
    return base_folder() / f"xla-{platform.machine()}-{jax.__version__}"


FEW_NUMBERS = 16
MOST_KEPT = 10_000
"""Arrays of few numbers that are kept, some 500 bytes each."""

_ARRAYS: dict[tuple[bool, str, tuple[int, ...], bytes], jax.Array] = {}
_UNTRACED = get_opaque_trace_state()


def array(value: ArrayLike | Sequence[float], dtype: DTypeLike | None = None) -> jax.Array:
    """Value as an array; unlike `jnp.asarray` it compiles no program for plain numbers.

    The same few numbers give the same array, for each that is put on the device takes 20 to 40 us. While JAX
    traces they are constants of what is traced.
    """
    if isinstance(value, jax.Array):
        return value if dtype is None else jnp.asarray(value, dtype)
    numbers = np.asarray(value, dtype)
    if get_opaque_trace_state() != _UNTRACED:
        return jnp.asarray(numbers, dtype)
    if numbers.size > FEW_NUMBERS:
        return jnp.asarray(numbers, numbers.dtype)  # without its type a program is compiled
    double: bool = jax.config.jax_enable_x64  # type: ignore[attr-defined]
    key = double, numbers.dtype.char, numbers.shape, numbers.tobytes()
    if key not in _ARRAYS:
        if len(_ARRAYS) >= MOST_KEPT:
            _ARRAYS.clear()
        # A copy, since the device may share the memory of whoever asks.
        _ARRAYS[key] = jnp.asarray(numbers.copy(), numbers.dtype)
    return _ARRAYS[key]


def kept_folder() -> Path | None:
    """Folder of compiled programs that is in use; None where nothing is kept."""
    return _KEPT


def _keeps_programs() -> bool:
    """True where the host has a folder for the compiled programs of JAX, which stays as it is."""
    return jax.config.jax_compilation_cache_dir is not None  # type: ignore[attr-defined]


def _enable_cache() -> Path | None:
    """The folder, if only the user can write to it; for JAX too where it has none."""
    try:
        folder = prepared_folder(cache_folder())
    except RuntimeError:
        return None
    if folder is None:
        return None
    if _keeps_programs():
        return folder
    jax.config.update("jax_compilation_cache_dir", str(folder))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)
    return folder


_KEPT = _enable_cache()
