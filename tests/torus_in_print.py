"""The case of Liu and Xiong at its points."""

from functools import cache

import numpy as np
import pytest
import xarray as xr

from pitchpoint.analyses.studies import readings_of
from pitchpoint.cases.document import leaves
from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.published.liu_xiong_torus import printed
from pitchpoint.published.liu_xiong_torus.printed_motion import torus_motion

NAME, TREE = find_case("liu_xiong_torus")


@cache
def case(variant="as_published"):
    return Variant(TREE, NAME, variant).built({}).case


def points(study, variant="as_published", **changes):
    """The case at every point of a study."""
    given, chosen = case(variant).studies[study], Variant(TREE, NAME, variant)
    own = {**dict(leaves(given.change)), **changes}
    values = [None] if given.sweep is None else given.sweep.values
    swept = [{} if value is None else {given.sweep.key: value} for value in values]
    return [chosen.built({**own, **one}) for one in swept]


def read(study, variant="as_published", **changes):
    """Readings at the points of a study, with its axis."""
    found = points(study, variant, **changes)
    data = xr.Dataset(readings_of(found, 1))
    sweep = case(variant).studies[study].sweep
    if sweep is None:
        return data
    kind = sweep.key.removeprefix("operation.")
    axis = [float(getattr(one.operation, {"torque": "load"}.get(kind, kind))) for one in found]
    told = {"sweep_key": sweep.key, "axis_unit": "1"}
    told["axis_kind"] = {"speed": "rotational speed", "torque": "torque"}[kind]
    return data.assign(axis=("point", np.array(axis))).assign_attrs(told)


def driven(study, position, pair):
    """Drive and pieces of a point, as the readings have them."""
    built = points(study)[position]
    found = {}

    def kept(drive, turn):
        found[float(drive.pointed)] = drive, turn
        return torus_motion(drive, turn)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(printed, "torus_motion", kept)
        readings_of([built], 1)
    return found[float(pair == "torus")]
