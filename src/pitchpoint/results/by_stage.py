"""Datasets of the meshes of a drive as one with a dimension `stage`, and back."""

import json
from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.doubts import doubts_of, in_stage, stored
from pitchpoint.status import Code

__all__ = ["by_stage", "of_stage", "stages_of"]

STAGE = "stage"
"""Dimension of the meshes of a drive."""

_OF_STAGES = "of_stages"
"""Attribute with sizes, labels and attributes that each stage has of its own, as JSON."""

_EMPTY = {"f": np.nan, "i": np.nan, "u": np.nan, "c": np.nan, "b": False, "U": "", "O": ""}
"""What stands by kind of values where another stage has more of them."""


def by_stage(each: Mapping[int, xr.Dataset]) -> xr.Dataset:
    """Datasets of stages as one.

    Args:
        each: by number of the stage, of the same kind.

    Labels of a dimension are those of all stages in the order in which they come up; what a stage has less
    is not a number, no text or false.
    """
    labels = _labels(list(each.values()))
    filled = [_filled(data, labels) for data in each.values()]
    whole = xr.concat(
        filled, xr.Variable(STAGE, [*each]), data_vars="all", coords="minimal", combine_attrs="drop"
    )
    described = {name: v.attrs for data in each.values() for name, v in data.variables.items()}
    for name, attributes in described.items():
        whole.variables[name].attrs = attributes
    sentences = [
        in_stage(number, text) for number, data in each.items() for text in doubts_of(data.attrs)
    ]
    apart = {str(number): _of_its_own(data) for number, data in each.items()}
    common = next(iter(each.values())).attrs
    return whole.assign_attrs(
        title=common["title"],
        version=common["version"],
        solve=json.dumps(_worst([json.loads(data.attrs["solve"]) for data in each.values()])),
        **stored(sentences),
        **{_OF_STAGES: json.dumps(apart)},
    )


def stages_of(data: xr.Dataset) -> tuple[int, ...]:
    """Numbers of the stages that a dataset is made of; none where it is of a mesh or of a drive."""
    return tuple(int(number) for number in json.loads(data.attrs.get(_OF_STAGES, "{}")))


def of_stage(data: xr.Dataset, number: int) -> xr.Dataset:
    """Dataset of one stage as it was.

    Args:
        data: as `by_stage` made it.
        number: of the stage.
    """
    apart = json.loads(data.attrs[_OF_STAGES])[str(number)]
    there: xr.Dataset = data.sel({STAGE: number}, drop=True)[apart["names"]]
    for dim, size in apart["sizes"].items():
        there = there.isel({dim: slice(size)})
    for dim, labels in apart["labels"].items():
        there = there.sel({dim: labels})
    for name, attributes in apart["variables"].items():
        there.variables[name].attrs = attributes
    there.attrs = apart["attributes"]
    return there


def _of_its_own(data: xr.Dataset) -> dict[str, Any]:
    """What a stage has of its own: names, sizes, labels, attributes."""
    return {
        "names": [str(name) for name in data.data_vars],
        "sizes": {dim: size for dim, size in data.sizes.items() if dim not in data.coords},
        "labels": {dim: data[dim].values.tolist() for dim in data.sizes if dim in data.coords},
        "variables": {name: dict(values.attrs) for name, values in data.variables.items()},
        "attributes": dict(data.attrs),
    }


def _labels(each: Sequence[xr.Dataset]) -> dict[Hashable, Any]:
    """Labels of each dimension in all datasets; a number of them where they have none."""
    found: dict[Hashable, Any] = {}
    for data in each:
        for dim, size in data.sizes.items():
            if dim in data.coords:
                found[dim] = [*dict.fromkeys([*found.get(dim, []), *data[dim].values.tolist()])]
            else:
                found[dim] = max(found.get(dim, 0), size)
    return found


def _filled(data: xr.Dataset, labels: Mapping[Hashable, Any]) -> xr.Dataset:
    """The dataset with all labels, and as long as the others."""
    counted = [dim for dim in data.sizes if dim not in data.coords]
    numbered = data.assign_coords({dim: range(data.sizes[dim]) for dim in counted})
    every = {dim: range(labels[dim]) if dim in counted else labels[dim] for dim in data.sizes}
    empty = {name: _EMPTY[values.dtype.kind] for name, values in data.data_vars.items()}
    return numbered.reindex(every, fill_value=empty).drop_vars(counted)


def _worst(solves: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    """What became of the solves of all stages: that which ended worst."""
    return max(solves, key=lambda one: (one["code"] != Code.SOLVED, one["residual"] or 0.0))
