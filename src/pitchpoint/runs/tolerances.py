"""Tolerances of a case as ranges of its keys, from which a study draws gears as they are made."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.runs.case import case_value

__all__ = ["with_tolerances"]

_KEY = "tolerances"


def with_tolerances(variant: Variant, distribution: str) -> tuple[Variant, dict[str, Any]]:
    """A case whose gears are drawn within their tolerances, and ranges of what is drawn by key.

    What would follow from a drawn value stays that of the nominal gears: profile shifts, tip circles.

    Args:
        variant: a cylindrical pair, or stages of such pairs, with limits in `[gears.inspection]`.
        distribution: "uniform" or "normal", whose limits are three standard deviations from their middle;
            the number from which deviations of teeth are drawn is uniform by either.

    Raises:
        InputError: other gears, or ones without tolerances.
    """
    pairs = [*_pairs(variant)]
    if not any(gears.limits_by_key for _, gears, _ in pairs):
        raise InputError(
            'none are given; say thickness_field = "cd25", centre_distance_field = "js7" or iso_class = 6 in '
            f"[{pairs[0][0]}.inspection]",
            file=variant.name,
            key=_KEY,
        )
    settings: dict[str, Any] = {}
    ranges: dict[str, Any] = {}
    for table, gears, pair in pairs:
        limits = gears.limits_by_key
        if gears.backlash is not None and limits:
            raise InputError(
                f"the backlash by value, {table}.backlash, thins the teeth for every centre distance anew; "
                f"give thickness_field or allowances in [{table}.inspection] in its place",
                file=variant.name,
                key=_KEY,
            )
        for key, value in _held(gears, pair).items():
            settings[f"{table}.{key}"] = case_value(f"{table}.{key}", value)
        for key, (low, high) in limits.items():
            of_key = "uniform" if key.endswith("seed") else distribution
            ranges[f"{table}.{key}"] = {"start": low, "stop": high, "distribution": of_key}
    return replace(variant, settings={**variant.settings, **settings}), ranges


def _pairs(variant: Variant) -> Iterator[tuple[str, CylindricalGears, Any]]:
    """Place of each table of gears, the table and its pair; InputError for other gears."""
    built = variant.built({})
    for place, mesh in enumerate(built.meshes):
        table = f"stages.{built.numbers[place]}.gears" if built.numbers else "gears"
        gears = mesh.case.gears
        if built.trains or not isinstance(gears, CylindricalGears):
            raise InputError(
                "are drawn of cylindrical pairs, alone or as stages in a row, with inspection tables; of "
                "sets of planets and other gears give the ranges of their keys as over",
                file=variant.name,
                key=_KEY,
            )
        yield table, gears, mesh.design.mesh


def _held(table: CylindricalGears, pair: Any) -> dict[str, Any]:
    """Values by key of the gears that stay those of the nominal ones; none of gears without tolerances."""
    limits = table.limits_by_key
    if not limits:
        return {}
    tips = np.asarray(pair.tip_alteration).tolist()
    held: dict[str, Any] = {"profile_shift": [*table.profile_shift], "tip_alteration": tips}
    if "thickness_allowance.1" in limits:  # each gear has its own, where the case has none
        held["thickness_allowance"] = [0.0, 0.0]
    if table.least_tip_thickness:
        held["least_tip_thickness"] = 0.0
    if table.inspection is not None and table.inspection.iso_class is not None:
        held["deviations.iso_class"] = [*table.inspection.iso_class]
        held["deviations.share_of_tolerance"] = [1.0, 1.0]
    return held
