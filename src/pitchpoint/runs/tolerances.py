"""Tolerances of a case as ranges of its keys, from which a study draws gears as they are made."""

from dataclasses import replace
from typing import Any

import numpy as np

from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.runs.case import written

__all__ = ["with_tolerances"]

_KEY = "tolerances"


def with_tolerances(variant: Variant, distribution: str) -> tuple[Variant, dict[str, Any]]:
    """A case whose gears are drawn within their tolerances, and ranges of what is drawn by key.

    What would follow from a drawn value stays that of the nominal gears: profile shifts, tip circles.

    Args:
        variant: a cylindrical pair with limits in `[gears.inspection]`.
        distribution: "uniform" or "normal", whose limits are three standard deviations from their middle.

    Raises:
        InputError: other gears, or ones without tolerances.
    """
    built = variant.built({})
    table = None if built.numbers else built.meshes[0].case.gears
    if not isinstance(table, CylindricalGears):
        raise InputError(
            "are drawn of one cylindrical pair alone, with [gears.inspection]; of other drives give the "
            "ranges of their keys as over",
            file=variant.name,
            key=_KEY,
        )
    limits = table.limits_by_key
    if not limits:
        raise InputError(
            'none are given; say thickness_field = "cd25", centre_distance_field = "js7" or iso_class = 6 in '
            "[gears.inspection]",
            file=variant.name,
            key=_KEY,
        )
    if table.backlash is not None:
        raise InputError(
            "the backlash by value, gears.backlash, thins the teeth for every centre distance anew; give "
            "thickness_field or allowances in [gears.inspection] in its place",
            file=variant.name,
            key=_KEY,
        )
    mesh: Any = built.meshes[0].design.mesh
    fixed: dict[str, Any] = {
        "gears.profile_shift": [*table.profile_shift],
        "gears.tip_alteration": np.asarray(mesh.tip_alteration).tolist(),
    }
    if "thickness_allowance.1" in limits:  # each gear has its own, where the case has none
        fixed["gears.thickness_allowance"] = [0.0, 0.0]
    if table.least_tip_thickness:
        fixed["gears.least_tip_thickness"] = 0.0
    settings = {key: written(key, value) for key, value in fixed.items()}
    ranges = {
        f"gears.{key}": {"start": low, "stop": high, "distribution": distribution}
        for key, (low, high) in limits.items()
    }
    return replace(variant, settings={**variant.settings, **settings}), ranges
