"""Case files as plain data: reading, variants, settings, and where each value comes from."""

import copy
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pitchpoint.errors import InputError
from pitchpoint.registry import nearest

__all__ = ["Document", "Provenance", "read", "setting", "strip"]

MAX_BYTES = 1_000_000
"""Largest case file that is read; real ones have a few kilobytes."""

STATUSES = (
    "printed",
    "derived",
    "digitised",
    "assumed",
    "fitted",
    "corrected",
    "given",
    "set",
    "default",
)

Tree = dict[str, Any]
_MARKS = {"status", "where", "note"}


@dataclass(frozen=True)
class Provenance:
    """How a value was come by: status, place in the publication, remark."""

    status: str = "given"
    where: str = ""
    note: str = ""


@dataclass(frozen=True)
class Document:
    """A case file with its variants resolved.

    Attributes:
        name: of the file or of the shipped case, for messages.
        tree: plain values by table and key.
        provenance: by dotted key, for values that carry a mark.
    """

    name: str
    tree: Tree
    provenance: Mapping[str, Provenance] = field(default_factory=dict)


def read(path: Path) -> Tree:
    """Tables of a TOML file, marks included.

    Raises:
        InputError: missing, too large, not text, not TOML.
    """
    if not path.is_file():
        raise InputError("there is no such case file", file=str(path))
    if path.stat().st_size > MAX_BYTES:
        size = path.stat().st_size / 1e6
        raise InputError(
            f"has {size:.0f} MB; a case file has at most {MAX_BYTES / 1e6:.0f} MB", file=path.name
        )
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise InputError("is not UTF-8 text, so it is no TOML file", file=path.name) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"is not a TOML file: {error}", file=path.name) from None
    except RecursionError:
        raise InputError("is nested too deeply for a case file", file=path.name) from None
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", file=path.name) from None


def variants(tree: Tree) -> list[str]:
    """Names of the variants that a case file defines; one nameless default if it has none."""
    given = tree.get("variants", {})
    return list(given) if isinstance(given, dict) and given else ["default"]


def resolve(
    tree: Tree, *, name: str, variant: str, settings: Mapping[str, Any] | None = None
) -> Document:
    """One variant of a case with settings applied, its marks separated from the values.

    Args:
        tree: as read.
        name: of the file, for messages.
        variant: one of `variants(tree)`.
        settings: values by dotted key that replace those of the file.

    Raises:
        InputError: unknown variant, or a mark that is not one.
    """
    known = variants(tree)
    if variant not in known:
        raise InputError(
            f"'{variant}' is not a variant of this case{nearest(variant, dict.fromkeys(known))}",
            file=name,
            key="variants",
        )
    base = {key: value for key, value in tree.items() if key != "variants"}
    overlay = tree.get("variants", {}).get(variant, {}) if variant != "default" else {}
    if not isinstance(overlay, dict):
        raise InputError("must be a table", file=name, key=f"variants.{variant}")
    merged = _merged(base, overlay)
    for key, value in (settings or {}).items():
        merged = setting(merged, key, {"value": value, "status": "set"}, name=name)
    provenance: dict[str, Provenance] = {}
    return Document(name, strip(merged, provenance, name=name), provenance)


def setting(tree: Tree, key: str, value: Any, *, name: str = "--set") -> Tree:
    """Copy of the tables with the value at a dotted key replaced; `a.b.1` is the value of gear 1."""
    result = copy.deepcopy(tree)
    *parents, last = key.split(".")
    node: Any = result
    for part in parents if not last.isdigit() else parents[:-1]:
        node = node.setdefault(part, {})
        if not isinstance(node, dict):
            raise InputError(f"'{part}' is a value, not a table", file=name, key=key)
    if last.isdigit() and parents:
        node[parents[-1]] = _of_gear(node.get(parents[-1], 0.0), int(last), value, key)
    else:
        node[last] = value
    return result


def strip(value: Any, provenance: dict[str, Provenance], *, name: str = "", key: str = "") -> Any:
    """Values without their marks, which go into `provenance` by dotted key."""
    if isinstance(value, dict):
        if "value" in value and set(value) <= _MARKS | {"value"}:
            provenance[key] = _provenance(value, name, key)
            return strip(value["value"], provenance, name=name, key=key)
        return {
            part: strip(item, provenance, name=name, key=f"{key}.{part}" if key else part)
            for part, item in value.items()
        }
    return value


def leaves(tree: Tree, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted key and value of everything that is not a table."""
    for key, value in tree.items():
        path = f"{prefix}{key}"
        if isinstance(value, dict):
            yield from leaves(value, f"{path}.")
        else:
            yield path, value


def _provenance(mark: Tree, name: str, key: str) -> Provenance:
    status = mark.get("status", "given")
    if status not in STATUSES:
        raise InputError(
            f"'{status}' is not a status; use one of {', '.join(STATUSES)}", file=name, key=key
        )
    return Provenance(str(status), str(mark.get("where", "")), str(mark.get("note", "")))


def _merged(base: Any, overlay: Any) -> Any:
    if not (isinstance(base, dict) and isinstance(overlay, dict)) or "value" in overlay:
        return overlay
    if "value" in base:
        return overlay
    keys = [*base, *(key for key in overlay if key not in base)]
    return {
        key: _merged(base[key], overlay[key])
        if key in base and key in overlay
        else overlay.get(key, base.get(key))
        for key in keys
    }


def _of_gear(pair: Any, gear: int, value: Any, key: str) -> Any:
    if isinstance(pair, dict):
        pair = pair.get("value", 0.0)
    if isinstance(value, dict):
        value = value["value"]
    if gear not in (1, 2):
        raise InputError("there are gear 1 and gear 2", key=key)
    both = list(pair) if isinstance(pair, list | tuple) and len(pair) == 2 else [pair, pair]
    both[gear - 1] = value
    return both
