"""The one place that configures JAX: double precision and a private, persistent compilation cache."""

import os
import platform
from collections.abc import Sequence
from pathlib import Path

FEW_CORES = 4
"""Cores up to which compiled programs run on one of them."""

# Factorisations of a batch wait for other threads of the pool that runs them, and several at once
# then wait for each other without end where the pool is small (jaxlib 0.10). A pool of one runs them
# in place. It is made with the first array and asks this variable for its size.
_ALLOWED = getattr(os, "sched_getaffinity", lambda _: range(os.cpu_count() or 1))(0)
if len(_ALLOWED) <= FEW_CORES:
    os.environ.setdefault("NPROC", "1")

import jax  # noqa: E402
import jax.numpy as jnp  # noqa: E402
import numpy as np  # noqa: E402
from jax.typing import ArrayLike, DTypeLike  # noqa: E402

__all__ = ["array", "cache_folder", "jax", "jnp"]


def cache_folder() -> Path:
    """Folder of compiled programs: under the user's cache, one for each kind of machine."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "pitchpoint" / f"xla-{platform.machine()}-{jax.__version__}"


def array(value: ArrayLike | Sequence[float], dtype: DTypeLike | None = None) -> jax.Array:
    """Value as an array; unlike `jnp.asarray` it compiles no program for a plain number."""
    return jnp.asarray(value if isinstance(value, jax.Array) else np.asarray(value, dtype), dtype)


def _enable_cache() -> None:
    folder = cache_folder()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return  # a read-only home costs compile time, nothing else
    jax.config.update("jax_compilation_cache_dir", str(folder))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


jax.config.update("jax_enable_x64", True)
_enable_cache()
