"""The case of Zhao et al. (2022), built and read."""

from functools import cache

import numpy as np
import xarray as xr

from pitchpoint.analyses.studies import readings_of
from pitchpoint.cases.document import leaves
from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant

NAME, TREE = find_case("zhao2022")
VARIANTS = {name: Variant(TREE, NAME, name) for name in ("as_published", "physical")}
STEP = np.deg2rad(1.8)


@cache
def case(variant="as_published"):
    return VARIANTS[variant].built({}).case


def built(study, variant="as_published", **changes):
    own = dict(leaves(case(variant).studies[study].change))
    return VARIANTS[variant].built({**own, **changes})


def readings(studies, variant="as_published", **changes):
    points = {name: [built(name, variant, **changes)] for name in studies}
    return {f"study_{name}": xr.Dataset(readings_of(each, 1)) for name, each in points.items()}
