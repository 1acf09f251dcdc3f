"""Rows of a record made by hand."""

from collections.abc import Mapping
from typing import Any

from pitchpoint.cases.keys import quantity_at


def entries(values: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Inputs of a record from values in SI by dotted key."""
    return [
        dict(zip(("table", "key"), path.split(".", 1), strict=True))
        | {"value": value, "kind": quantity.kind if (quantity := quantity_at(path)) else ""}
        | {"status": "given", "where": "", "note": "", "given": True}
        for path, value in values.items()
    ]
