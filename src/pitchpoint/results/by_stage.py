"""Datasets of the meshes of a drive as one with a dimension `stage`, and back."""

import json
from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import doubts_of, in_stage, stored
from pitchpoint.core.status import Code

__all__ = [
    "OF_STAGES",
    "STAGE",
    "Label",
    "alike_labels",
    "as_label",
    "by_stage",
    "of_stage",
    "stages_of",
]

STAGE = "stage"
"""Dimension of the meshes of a drive."""

OF_STAGES = "of_stages"
"""Attribute with what each stage has of its own, as JSON: sizes, texts along dimensions, types and more."""

_COUNTED = "{}_number"
"""Dimension along which numbers differ between the stages, by the name of these."""

_EMPTY = {"b": False, "U": "", "O": ""}
"""What stands by kind of values where another stage has more of them; else not a number."""

Labels = Mapping[Hashable, Sequence[str]]

Label = int | str
"""Number of a stage; of a mesh that is one of several in it with its bodies, "1 (sun and planet)"."""


def as_label(text: str) -> Label:
    """The label of a stage from its text."""
    return int(text) if text.isdecimal() else text


def alike_labels(labels: Sequence[Label]) -> list[Any]:
    """Labels of stages as a coordinate: numbers, or texts where one of them is."""
    return [*labels] if all(isinstance(label, int) for label in labels) else [*map(str, labels)]


def by_stage(each: Mapping[Label, xr.Dataset]) -> xr.Dataset:
    """Datasets of stages as one.

    Args:
        each: by label of the stage, of the same kind; labels are texts where one of them is.

    Texts along a dimension are those of all stages in the order in which they come up. Numbers along a
    dimension, such as phases, are a coordinate of each stage along a dimension `NAME_number` unless all
    stages have the same ones. What a stage has less is not a number, no text or false.
    """
    stages = [*each.values()]
    labels, apart, own_texts = _texts(stages), _apart(stages), [_texts([stage]) for stage in stages]
    sizes = _sizes(stages, labels)
    names = dict.fromkeys(name for data in stages for name in data.variables if name not in labels)
    indices = [name for name in names if name in sizes and name not in apart]
    stacked = {
        name: _stacked([data.variables.get(name) for data in stages], sizes, labels, own_texts)
        for name in names
        if name not in indices
    }
    renamed = {dim: _COUNTED.format(dim) for dim in apart}
    joined = xr.Dataset(
        {
            name: ((STAGE, *(renamed.get(dim, dim) for dim in dims)), values, attributes)
            for name, (dims, values, attributes) in stacked.items()
        },
        {
            STAGE: alike_labels([*each]),
            **{dim: [*texts] for dim, texts in labels.items()},
            **{name: _longest(name, stages) for name in indices},
        },
    ).set_coords([name for name in stacked if any(name in data.coords for data in stages)])
    sentences = [
        in_stage(label, text) for label, data in each.items() for text in doubts_of(data.attrs)
    ]
    of_stages = {str(label): _of_its_own(data) for label, data in each.items()}
    return joined.assign_attrs(
        title=stages[0].attrs["title"],
        version=stages[0].attrs["version"],
        solve=json.dumps(_worst([json.loads(data.attrs["solve"]) for data in stages])),
        **stored(sentences),
        **{OF_STAGES: json.dumps(of_stages, default=lambda value: value.item())},
    )


def stages_of(data: xr.Dataset) -> tuple[Label, ...]:
    """Labels of the stages that a dataset is made of; none where it is of a mesh or of a drive."""
    return tuple(map(as_label, json.loads(data.attrs.get(OF_STAGES, "{}"))))


def of_stage(data: xr.Dataset, label: Label) -> xr.Dataset:
    """Dataset of one stage as it was.

    Args:
        data: as `by_stage` made it.
        label: of the stage.
    """
    every = json.loads(data.attrs[OF_STAGES])
    record, row = every[str(label)], [*every].index(str(label))
    labels = {dim: data[dim].values.tolist() for dim in record["texts"]}
    variables = {}
    for name, (dims, kind, attributes) in record["variables"].items():
        if name in record["texts"]:
            variables[name] = xr.Variable(dims, record["texts"][name], attributes)
            continue
        values = data.variables[name].values
        values = values[row] if data.variables[name].dims[:1] == (STAGE,) else values
        places = [_places(dim, record["sizes"][dim], record["texts"], labels) for dim in dims]
        there = values[np.ix_(*places)] if dims else values
        variables[name] = xr.Variable(dims, np.asarray(there).astype(kind), attributes)
    return xr.Dataset(variables, attrs=record["attributes"]).set_coords(record["coordinates"])


def _of_its_own(data: xr.Dataset) -> dict[str, Any]:
    """What a stage has of its own."""
    return {
        "sizes": dict(data.sizes),
        "texts": _texts([data]),
        "variables": {
            name: (
                values.dims,
                values.dtype.kind if values.dtype.kind in "UO" else str(values.dtype),
                values.attrs,
            )
            for name, values in data.variables.items()
        },
        "coordinates": [*data.coords],
        "attributes": data.attrs,
    }


def _texts(stages: Sequence[xr.Dataset]) -> dict[Hashable, list[str]]:
    """Texts along dimensions, of all stages."""
    texts: dict[Hashable, list[str]] = {}
    for data in stages:
        for dim in data.sizes:
            if dim in data.coords and data[dim].dtype.kind in "UO":
                texts[dim] = [*dict.fromkeys([*texts.get(dim, []), *map(str, data[dim].values)])]
    return texts


def _apart(stages: Sequence[xr.Dataset]) -> list[Hashable]:
    """Dimensions along which numbers of the stages differ."""
    dims = dict.fromkeys(dim for data in stages for dim in data.sizes)
    return [
        dim
        for dim in dims
        if len({_numbers(data, dim) for data in stages if dim in data.sizes}) > 1
    ]


def _numbers(data: xr.Dataset, dim: Hashable) -> tuple[float, ...]:
    """Numbers along a dimension; none where it has no coordinate, or texts."""
    plain = dim not in data.coords or data[dim].dtype.kind in "UO"
    return () if plain else tuple(data[dim].values.tolist())


def _longest(dim: Hashable, stages: Sequence[xr.Dataset]) -> xr.Variable:
    """The coordinate that all stages have which have its dimension."""
    return next(data.variables[dim] for data in stages if dim in data.variables)


def _sizes(stages: Sequence[xr.Dataset], labels: Labels) -> dict[Hashable, int]:
    """Length of each dimension with room for all stages."""
    dims = dict.fromkeys(dim for data in stages for dim in data.sizes)
    longest = {dim: max(data.sizes.get(dim, 0) for data in stages) for dim in dims}
    return longest | {dim: len(texts) for dim, texts in labels.items()}


def _stacked(
    each: Sequence[xr.Variable | None],
    sizes: Mapping[Hashable, int],
    labels: Labels,
    own_texts: Sequence[Labels],
) -> tuple[tuple[Hashable, ...], np.ndarray, dict[Any, Any]]:
    """Dimensions, values and attributes of a variable of all stages; a stage may not have it."""
    there = [variable for variable in each if variable is not None]
    dims, shape = there[0].dims, tuple(sizes[dim] for dim in there[0].dims)
    kinds = np.result_type(*(variable.dtype for variable in there))
    full = len(there) == len(each) and all(variable.shape == shape for variable in there)
    empty = _EMPTY.get(kinds.kind, np.nan)
    kinds = kinds if full or kinds.kind in _EMPTY else np.result_type(kinds, float)
    rows = np.full((len(each), *shape), empty if not full else kinds.type(), kinds)
    for number, (variable, texts) in enumerate(zip(each, own_texts, strict=True)):
        if variable is not None:
            places = [_places(dim, variable.sizes[dim], texts, labels) for dim in dims]
            rows[(np.array(number).reshape((1,) * len(dims)), *np.ix_(*places))] = variable.values
    return dims, rows, dict(there[0].attrs)


def _places(dim: Hashable, size: int, own: Labels, labels: Labels) -> list[int]:
    """Where entries of a stage along a dimension stand among those of all."""
    return [labels[dim].index(text) for text in own[dim]] if dim in own else [*range(size)]


def _worst(solves: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    """What became of the solves of all stages: that which ended worst."""
    return max(solves, key=lambda one: (one["code"] != Code.SOLVED, one["residual"] or 0.0))
