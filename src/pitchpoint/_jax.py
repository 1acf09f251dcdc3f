"""The one place that configures JAX: double precision and a private, persistent compilation cache."""

import os
import platform
from collections import Counter
from pathlib import Path

# From 128 rows on the library behind a factorisation divides it among threads that spin while they wait:
# 24 of 144 rows take 3 ms of one thread and up to 850 ms of two on a busy machine. It reads this once.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

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

__all__ = ["bound_programs", "cache_folder", "jax", "jnp"]

MOST_PROGRAMS = 1000
"""Programs that a process keeps loaded: each takes half a megabyte and some six memory maps, of which
Linux allows a process 65,530."""

_LOADED = Counter[str]()


def cache_folder() -> Path:
    """Folder of compiled programs: under the user's cache, one for each kind of machine."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "pitchpoint" / f"xla-{platform.machine()}-{jax.__version__}"


def _enable_cache() -> None:
    folder = cache_folder()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return  # a read-only home costs compile time, nothing else
    jax.config.update("jax_compilation_cache_dir", str(folder))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


def _count(event: str, duration_secs: float, **_: str | int) -> None:
    if event == "/jax/core/compile/backend_compile_duration":
        _LOADED["programs"] += 1


def bound_programs() -> None:
    """Unload all programs once there are many; what is needed again comes from the folder of the cache."""
    if _LOADED["programs"] > MOST_PROGRAMS:
        jax.clear_caches()
        _LOADED.clear()


jax.monitoring.register_event_duration_secs_listener(_count)
jax.config.update("jax_enable_x64", True)
_enable_cache()
