"""Programs that are traced and compiled once, and kept for later processes.

JAX keeps compiled code between processes, but traces and lowers Python anew in each of them, which takes
longer than the numbers themselves. A program of this module is kept as the portable form that tracing
gives it (`jax.export`), under a digest of all that decides it: the code that it reaches, the version of
JAX, the structure of the arguments. What has no such name (a law of the user's own) is traced as ever.
"""

import gc
import hashlib
import json
import logging
import os
import platform
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from ctypes import CDLL
from dataclasses import fields, is_dataclass
from functools import cache, partial, update_wrapper
from importlib import import_module
from importlib.metadata import version
from mmap import PAGESIZE
from pathlib import Path
from types import FunctionType
from typing import Any, Generic, ParamSpec, TypeVar
from weakref import WeakSet

import equinox as eqx
import numpy as np
from jax import export

from pitchpoint._jax import demand_double, jax, kept_folder
from pitchpoint.core.kept import read_kept, write_kept
from pitchpoint.core.reach import Sources

__all__ = [
    "Program",
    "bound_programs",
    "fast_program",
    "forget",
    "looping_program",
    "program",
    "surroundings",
]

P = ParamSpec("P")
R = TypeVar("R")

_LOG = logging.getLogger(__name__)
_TRACED = ("pitchpoint", "jax", "jaxlib", "equinox", "diffrax", "numpy")
"""Packages whose code is in a program or makes its numbers."""


def _options(level: int) -> dict[str, bool | int]:
    """Options of the compiler; what XLA_FLAGS name is left to them, as in tests."""
    options = {
        "xla_backend_optimization_level": level,
        "xla_llvm_disable_expensive_passes": True,
        "xla_cpu_use_fusion_emitters": False,
    }
    flags = os.environ.get("XLA_FLAGS", "")
    return {name: value for name, value in options.items() if f"--{name}=" not in flags}


# Level 1 compiles twice to three times as long as level 0 and runs twice as fast; level 2 brings no more. Of
# the 35 s that the programs of examples/strain_wave.toml compiled and the 24 s that they ran, three of 32
# programs had 12 s and 21 s.
QUICK = _options(0)
"""Options for programs whose numbers take milliseconds: they compile in a third of the time."""

LOOPING = _options(1)
"""Options for programs whose loops take about as long as their compilation."""


_REFUSED: set[str] = set()
"""Options that the compiler of this process does not have: they come and go with its versions."""

_UNKNOWN = re.compile(r"No such compile option: '(\w+)'")


def _compiled(lowered: jax.stages.Lowered, options: Mapping[str, Any]) -> jax.stages.Compiled:
    """The compiled function; options decide how long that takes, so one that is unknown is left out."""
    accepted = {name: value for name, value in options.items() if name not in _REFUSED}
    try:
        return lowered.compile(compiler_options=accepted)
    except jax.errors.JaxRuntimeError as error:
        unknown = _UNKNOWN.search(str(error))
        if unknown is None or unknown[1] in _REFUSED:
            raise
        _REFUSED.add(unknown[1])
    return _compiled(lowered, options)


_CUSTOM = [
    export.DisabledSafetyCheck.custom_call(f"lapack_d{name}_ffi")
    for name in ("potrf", "getrf", "trsm", "geev", "syevd", "gesdd", "geqrf", "orgqr")
]
"""Calls whose form may change with the next version of JAX: programs are kept for one version alone."""


class _NamelessError(Exception):
    """A value that has no name of its own outside this process."""


@cache
def _sources() -> Sources:
    folder = kept_folder()
    return Sources(Path(__file__).parents[1], None if folder is None else folder / "reach")


class Program(Generic[P, R]):
    """A compiled function: arrays among its arguments are traced, all else is static.

    Inside another program, or where derivatives are taken, it is traced as part of what surrounds it.

    Args:
        function: of arrays and modules; pure.
        options: of the compiler.
    """

    def __init__(self, function: Callable[P, R], options: Mapping[str, Any]) -> None:
        self.function = function
        self.options = dict(options)
        self.traced = eqx.filter_jit(function)
        self.ready: dict[Any, Callable[..., Any] | None] = {}
        update_wrapper(self, function)
        _MADE.add(self)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Results of the function; NumPy and JAX arrays count alike as arguments.

        Raises:
            PitchpointError: JAX is in single precision.
        """
        demand_double()
        leaves, structure = jax.tree.flatten((args, kwargs))
        kinds = [*map(type, leaves)]
        # To ask each leaf what it is takes three times as long.
        numeric = {kind: _of_arrays(kind) for kind in {*kinds}}
        if any(issubclass(kind, jax.core.Tracer) for kind in numeric):
            return self.traced(*args, **kwargs)
        pairs = [*zip(leaves, kinds, strict=True)]
        arrays = [leaf for leaf, kind in pairs if numeric[kind]]
        traits = (
            (leaf.shape, leaf.dtype) if numeric[kind] else (leaf, kind) for leaf, kind in pairs
        )
        key = structure, tuple(traits)
        if key not in self.ready:
            self.ready[key] = self._made(leaves, structure, arrays, (args, kwargs))
        compute = self.ready[key]
        results: R = self.traced(*args, **kwargs) if compute is None else compute(*arrays)
        return results

    def _made(
        self, leaves: list[Any], structure: Any, arrays: list[Any], given: Any
    ) -> Callable[..., Any] | None:
        """What computes for arguments of this structure, kept before or traced now; None without a name."""
        flat = _Flat(self.function, structure, leaves)
        traced = jax.jit(flat)
        try:
            path = self._path(given)
            stored = _read(path)
            if stored is None:
                stored = self._exported(flat, traced, arrays)
                outline, blob = stored
                write_kept(path, json.dumps(outline).encode() + b"\n" + blob)
                _make_room(path.parent)
            outline, blob = stored
            exported = export.deserialize(bytearray(blob))
        except _NamelessError:
            return None
        except Exception as error:  # what is wrong with the function itself shows when it is traced
            _LOG.info("%s is not kept: %s", self.function.__qualname__, error)
            # What has no portable form, as a call of the host from a library, was traced by now all the same:
            # for arrays of such types, which those of NumPy are.
            if flat.outline is None:
                return None
            return lambda *leaves: flat.rebuilt(traced(*map(np.asarray, leaves)))
        # A compiled function of these shapes, since JAX compiles one anew where numbers that were plain once
        # (of a "weak" type) stand in other places.
        shapes = [jax.ShapeDtypeStruct(leaf.shape, leaf.dtype) for leaf in arrays]
        call = _compiled(jax.jit(exported.call).lower(*shapes), self.options)
        return lambda *leaves: _rebuilt(outline, iter(call(*leaves)))

    def _path(self, given: Any) -> Path:
        """File of the program for such arguments."""
        folder = kept_folder()
        if folder is None:
            raise _NamelessError
        identity = json.dumps([_name(self.function), sorted(self.options.items()), _text(given)])
        # Texts among the arguments stand in quotes of their own: what matches are names from `_name`.
        code = _sources().digest_of_reach(
            sorted(set(re.findall(r'"(pitchpoint[.\w]*):', identity)))
        )
        digest = hashlib.sha256(json.dumps([_machine(), code, identity]).encode()).hexdigest()
        return folder / "programs" / digest[:40]

    def _exported(
        self, flat: "_Flat", traced: jax.stages.Wrapped, arrays: list[Any]
    ) -> tuple[Any, bytes]:
        """Outline of the results and the portable form of what computes their arrays."""
        shapes = [jax.ShapeDtypeStruct(leaf.shape, leaf.dtype) for leaf in arrays]
        portable = export.export(traced, disabled_checks=_CUSTOM)(*shapes)
        return flat.outline, bytes(portable.serialize())


_MADE: "WeakSet[Program[..., Any]]" = WeakSet()


MOST_PROGRAMS = 1000
"""Programs that a process keeps loaded: each takes some six memory maps, of which Linux allows a process
65,530."""

MOST_MEMORY = 1 << 30
"""Memory that a process takes on before its programs are given back [B]; a program takes some megabytes."""

WORTH_GIVING = MOST_MEMORY // 8
"""What it takes on beyond that before it gives them back anew [B]: others may hold the rest."""

_LOADED = Counter[str]()


def _count(event: str, duration_secs: float, **_: str | int) -> None:
    if event == "/jax/core/compile/backend_compile_duration":
        _LOADED["programs"] += 1


jax.monitoring.register_event_duration_secs_listener(_count)


def _memory() -> int:
    """What the process has of memory [B]; 0 where the system does not tell."""
    try:
        return int(Path("/proc/self/statm").read_bytes().split()[1]) * PAGESIZE
    except OSError:
        return 0


_AT_START = _memory()


def bound_programs() -> None:
    """Forget all programs once there are many, or much memory; what is needed again comes from disk.

    Memory is counted from the start of the process; where more than that stays after they were given back,
    they go again once an eighth of a GiB has come on top of what stays. Most of what compiling leaves is
    free, and glibc has it: programs go only if that is not enough.
    """
    most = _AT_START + max(MOST_MEMORY, _LOADED["left"] + WORTH_GIVING)
    if _memory() > most:
        _trim()
    if _LOADED["programs"] > MOST_PROGRAMS or _memory() > most:
        forget()


def _trim() -> None:
    """Give back what is free in memory, which glibc keeps to itself otherwise."""
    with suppress(AttributeError, OSError):
        CDLL(None).malloc_trim(0)


def forget() -> None:
    """Give back what programs hold in memory; what is on disk stays."""
    for program in _MADE:
        program.ready.clear()
    jax.clear_caches()
    gc.collect()
    _trim()
    _LOADED.clear()
    _LOADED["left"] = _memory() - _AT_START


def program(function: Callable[P, R]) -> Program[P, R]:
    """A program that compiles quickly, for figures that take milliseconds; a decorator."""
    return Program(function, QUICK)


def looping_program(function: Callable[P, R]) -> Program[P, R]:
    """A program that is compiled with some care, for long loops or many calls of one run; a decorator."""
    return Program(function, LOOPING)


def fast_program(function: Callable[P, R]) -> Program[P, R]:
    """A program that the compiler works hard on, for many states at once; a decorator."""
    return Program(function, {})


class _Flat:
    """The function of the arrays alone; remembers how its results are put together."""

    def __init__(self, function: Callable[..., Any], structure: Any, leaves: list[Any]) -> None:
        self.function, self.structure = function, structure
        self.static = [None if _is_array(leaf) else (leaf,) for leaf in leaves]
        self.outline: Any = None
        self.__name__ = self.__qualname__ = getattr(function, "__name__", "program")

    def __call__(self, *arrays: Any) -> list[Any]:
        remaining = iter(arrays)
        leaves = [next(remaining) if held is None else held[0] for held in self.static]
        args, kwargs = jax.tree.unflatten(self.structure, leaves)
        result_arrays: list[Any] = []
        self.outline = _outline(self.function(*args, **kwargs), result_arrays)
        return result_arrays

    def rebuilt(self, arrays: list[Any]) -> Any:
        """The result of the function from its arrays."""
        return _rebuilt(self.outline, iter(arrays))


def _is_array(leaf: Any) -> bool:
    return isinstance(leaf, jax.Array | np.ndarray | np.generic)


@cache
def _of_arrays(kind: type) -> bool:
    """As `_is_array` of what is not traced, which asks each array anew."""
    return issubclass(kind, jax.Array | np.ndarray | np.generic)


def _outline(value: Any, leaves: list[Any]) -> Any:
    """How a result is put together, as JSON; its arrays are added to `leaves`."""
    if _is_array(value):
        leaves.append(value)
        return "array"
    if value is None or isinstance(value, bool | int | float | str):
        return {"value": value}
    if isinstance(value, dict):
        return {"dict": {key: _outline(item, leaves) for key, item in value.items()}}
    if isinstance(value, eqx.Module):
        parts = {
            field.name: _outline(getattr(value, field.name), leaves) for field in fields(value)
        }
        return {"module": _name(type(value)), "parts": parts}
    if type(value) in (list, tuple):
        return {type(value).__name__: [_outline(item, leaves) for item in value]}
    raise _NamelessError


def _rebuilt(outline: Any, leaves: Iterator[Any]) -> Any:
    """A result from its outline and its arrays."""
    if outline == "array":
        return next(leaves)
    if "value" in outline:
        return outline["value"]
    if "dict" in outline:
        return {key: _rebuilt(item, leaves) for key, item in outline["dict"].items()}
    if "module" in outline:
        return _module(outline, leaves)
    kind, items = next(iter(outline.items()))
    parts = [_rebuilt(item, leaves) for item in items]
    return tuple(parts) if kind == "tuple" else parts


def _module(outline: Any, leaves: Iterator[Any]) -> Any:
    module, _, name = outline["module"].partition(":")
    instance = object.__new__(getattr(import_module(module), name))
    for key, part in outline["parts"].items():
        object.__setattr__(instance, key, _rebuilt(part, leaves))
    return instance


def surroundings() -> dict[str, str]:
    """What decides about every program beside its own arguments, and so about the last bits of results."""
    return {**_machine(), "code": _sources().digest[:16]}


def _machine() -> dict[str, str]:
    """Versions and devices that decide about numbers, whatever the code."""
    return {**_installed(), "XLA_FLAGS": os.environ.get("XLA_FLAGS", "")}


@cache
def _installed() -> dict[str, str]:
    device = jax.devices()[0]
    return {
        **{name: version(name) for name in _TRACED},
        "device": f"{platform.machine()} {device.platform} {device.device_kind}",
    }


def _text(value: Any) -> Any:
    """The structure of arguments as JSON: what tracing sees of them, without the numbers in arrays.

    Raises:
        _NamelessError: there is something that a later process could not recognise.
    """
    if _is_array(value):
        return [str(value.dtype), list(value.shape)]
    if value is None or isinstance(value, bool | int | float | str):
        return [type(value).__name__, repr(value)]
    if isinstance(value, Mapping):
        return [type(value).__name__, [[_text(key), _text(item)] for key, item in value.items()]]
    if isinstance(value, list | tuple):
        return [type(value).__name__, [_text(item) for item in value]]
    if isinstance(value, type | FunctionType):
        return _name(value)
    if isinstance(value, partial):
        return [_name(value.func), _text(value.args), _text(value.keywords)]
    if is_dataclass(value):
        return [_name(type(value)), [_text(getattr(value, field.name)) for field in fields(value)]]
    raise _NamelessError


def _name(thing: Any) -> str:
    """Name by which a later process finds a function or a class of the package."""
    module, name = str(thing.__module__), thing.__qualname__
    if not module.startswith("pitchpoint."):
        raise _NamelessError
    target: Any = sys.modules[module]
    for part in name.split("."):
        target = getattr(target, part, None)
    # A wrapper of the user's own may go by the name of what it wraps.
    if getattr(target, "function", target) is not thing:
        raise _NamelessError
    return f"{module}:{name}"


MOST_KEPT = 1000
"""Programs that are kept on disk, a tenth of a megabyte each."""


def _make_room(folder: Path) -> None:
    """Delete the programs that were asked for longest ago: those of earlier versions."""
    with suppress(OSError):
        if len(os.listdir(folder)) > MOST_KEPT:
            by_use = sorted(folder.iterdir(), key=lambda path: path.stat().st_mtime_ns)
            for path in by_use[: MOST_KEPT // 10 - MOST_KEPT]:  # a tenth more, to look seldom
                path.unlink(missing_ok=True)


def _read(path: Path) -> tuple[Any, bytes] | None:
    """Outline and portable form of a program that was kept; None if there is none, or it is damaged."""
    body = read_kept(path)
    if body is None:
        return None
    with suppress(OSError):
        os.utime(path)
    outline, _, blob = body.partition(b"\n")
    return json.loads(outline), blob
