"""A pair of cylindrical gears from its table in a case file."""

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from math import nan
from typing import Any

import numpy as np

from pitchpoint._jax import array, jax
from pitchpoint.contact.surface import Surfaces
from pitchpoint.errors import CollectedInputError, InputError
from pitchpoint.gears.cylindrical import MEMBERS
from pitchpoint.gears.cylindrical.checks import (
    UnsoundPairError,
    check_cylindrical,
    check_cylindrical_pairs,
    runs_well,
)
from pitchpoint.gears.cylindrical.design import (
    build_cylindrical_pair,
    cylindrical_pairs_apart,
    with_bores,
)
from pitchpoint.gears.cylindrical.drawing_dimensions import backlash_limits
from pitchpoint.gears.cylindrical.iso_286 import symmetrical_deviation
from pitchpoint.gears.cylindrical.modified import (
    Modifications,
    class_deviations,
    class_warnings,
    modified,
)
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.family import Family, Followed, Made, waves
from pitchpoint.gears.involute import usual_depths, usual_ring_fillet
from pitchpoint.gears.layers import LAYERS, labels

__all__ = ["FAMILY"]

USUAL_TIP = 0.25
"""Tip thickness of helical teeth that is kept where none is given, in normal modules."""


def _cylindrical(gears: CylindricalGears, slices: int) -> Made:
    try:
        pair = build_cylindrical_pair(**_given(gears), slices=slices)
        pair = with_bores(pair, gears.bore_diameter)
        _check_field(pair, gears)
        warnings = check_cylindrical(pair, least_backlash=_least_backlash(gears, pair))
    except (UnsoundPairError, CollectedInputError) as error:
        raise _with_cures(error, gears) from None
    return _made(pair, gears, slices, warnings)


def _with_cures(error: InputError, gears: CylindricalGears) -> InputError:
    """A refusal with changes of the table after which it runs, behind the last of several sentences."""
    from pitchpoint.gears.cylindrical.cures import cures, error_with_cures  # few gears are refused

    values = _given(gears)
    values["least_tip_thickness"] = values["least_tip"]
    every = error.errors if isinstance(error, CollectedInputError) else (error,)
    remedies = [
        remedy
        for refusal in every
        if isinstance(refusal, UnsoundPairError)
        for remedy in refusal.remedies
    ]
    changes = cures(gears, remedies, values, _running)
    last_refusal = copy(every[-1])
    last_refusal.message, last_refusal.cures = (
        error_with_cures(last_refusal.message, changes),
        changes,
    )
    return last_refusal if len(every) == 1 else CollectedInputError([*every[:-1], last_refusal])


def _running(gears: CylindricalGears) -> CylindricalPair | None:
    """The pair if it runs well."""
    try:
        pair = build_cylindrical_pair(**_given(gears), slices=1)
    except InputError:
        return None
    return pair if runs_well(pair, least_backlash=_least_backlash(gears, pair)) else None


def _least_backlash(gears: CylindricalGears, pair: CylindricalPair) -> float:
    """Least backlash along the normal by allowances and deviations [m]; NaN without allowances."""
    allowed, inspection = gears.thickness_allowances, gears.inspection
    if allowed is None or inspection is None:
        return nan
    distance = float(pair.centre_distance)
    try:
        deviation = inspection.deviation(distance) or 0.0
    except InputError:
        deviation = 0.0  # told by _check_field
    upper, lower = allowed
    least, *_ = backlash_limits(
        *gears.toothings, distance, upper=upper, lower=lower, deviation=deviation
    )
    return least.normal


def _cylindrical_together(
    tables: Sequence[CylindricalGears], slices: int
) -> list[Made | InputError]:
    """The same for many tables; those that leave other values open are built apart from each other."""
    outcomes: dict[int, Made | InputError] = {}
    groups: dict[frozenset[str], list[int]] = {}
    table_values = [_given(gears) for gears in tables]
    for number, values in enumerate(table_values):
        groups.setdefault(frozenset(key for key in values if values[key] is None), []).append(
            number
        )
    for left, numbers in groups.items():
        columns = {
            key: np.array([table_values[n][key] for n in numbers])
            for key in table_values[0].keys() - left
        }
        for group, pairs in cylindrical_pairs_apart(**columns, slices=slices):
            least = [
                nan if pair is None else _least_backlash(tables[numbers[number]], pair)
                for number, pair in zip(group.numbers, pairs, strict=True)
            ]
            warnings = check_cylindrical_pairs(group.mesh, least)
            built = zip(group.numbers, pairs, warnings, strict=True)
            for number, pair, words in built:
                at = numbers[number]
                outcomes[at] = _made_or_error(pair, tables[at], slices, words)
    return [outcomes[number] for number in range(len(tables))]


def _made_or_error(
    pair: CylindricalPair | None,
    gears: CylindricalGears,
    slices: int,
    told: list[str] | InputError,
) -> Made | InputError:
    if pair is None:
        assert isinstance(told, InputError)
        return told
    try:
        if any(pair.shortened) or any(getattr(gears, key) is not None for key in _COMPUTED):
            pair = jax.tree.map(array, pair)
        pair = with_bores(pair, gears.bore_diameter)
        _check_field(pair, gears)
        return told if isinstance(told, InputError) else _made(pair, gears, slices, told)
    except InputError as error:
        return error


_COMPUTED = ("bore_diameter", "modifications", "misalignment", "deviations", "tolerance_class")
"""Keys that ask dimensions of a pair before it is computed: as arrays of JAX, not of NumPy."""


def _made(pair: CylindricalPair, gears: CylindricalGears, slices: int, told: list[str]) -> Made:
    """A pair that can run with its flanks and all that is to be said of it."""
    every = (*told, *_shortened(pair, gears), *_beyond_iso_1328(pair, gears))
    return _with_flanks(pair, gears, slices), every


def _with_flanks(pair: CylindricalPair, gears: CylindricalGears, slices: int) -> CylindricalPair:
    """The pair with the modifications of its flanks; deviations of the lead need slices too."""
    modifications = _modifications(gears)
    if modifications is not None:
        return modified(pair, modifications, slices)
    by_class = gears.deviations is not None and gears.deviations.iso_class is not None
    return replace(pair, slices=slices) if by_class else pair


def _modifications(gears: CylindricalGears) -> Modifications | None:
    table, slope = gears.modifications, gears.misalignment
    if table is None or not table.amounts:
        return None if slope is None else Modifications(misalignment=slope)
    amounts = {
        key: getattr(table, key) for key in type(table).model_fields if key != "relief_shape"
    }
    power = 2 if table.relief_shape == "parabolic" else 1
    return Modifications(**amounts, relief_power=power, misalignment=slope)


def _check_field(pair: CylindricalPair, gears: CylindricalGears) -> None:
    """InputError for a tolerance field that is not known for the centre distance."""
    field = None if gears.inspection is None else gears.inspection.centre_distance_field
    if field is None:
        return
    try:
        symmetrical_deviation(field, float(pair.centre_distance))
    except InputError as error:
        raise error.at(key="inspection.centre_distance_field") from None


def _beyond_iso_1328(pair: CylindricalPair, gears: CylindricalGears) -> tuple[str, ...]:
    return class_warnings(pair) if gears.tolerance_class is not None else ()


def _gear_deviations(gears: CylindricalGears, pair: CylindricalPair) -> Surfaces:
    deviations = gears.deviations
    if deviations is None:
        return (), ()
    pinion_waves, wheel_waves = waves(deviations.gear_1), waves(deviations.gear_2)
    if deviations.iso_class is None:
        return pinion_waves, wheel_waves
    shares = deviations.share_of_tolerance
    drawn = class_deviations(
        pair,
        deviations.iso_class,
        int(deviations.seed),
        shares=shares or (1.0, 1.0),
        # Shares are of gears drawn with the misalignment that their helix slopes make: not twice.
        helix=shares is None or gears.misalignment is None,
    )
    return (*pinion_waves, *drawn[0]), (*wheel_waves, *drawn[1])


def _least_tip(gears: CylindricalGears) -> float:
    """Tip thickness that is kept, in modules: helical teeth are few more often, and then pointed."""
    if gears.least_tip_thickness is not None:
        return gears.least_tip_thickness
    return USUAL_TIP if gears.helix_angle > 0.0 else 0.0


def _shortened(pair: CylindricalPair, gears: CylindricalGears) -> list[str]:
    """What was taken off tips that nobody asked to shorten."""
    if gears.least_tip_thickness is not None:
        return []
    full = float(pair.clearance_keeping_tip_alteration) if any(pair.shortened) else 0.0
    return [
        f"The tip of gear {number} would be thinner than {USUAL_TIP:g} modules and is shortened by "
        f"{full - float(pair.tip_alteration[number - 1]):.3g} modules; least_tip_thickness sets the limit."
        for number, short in enumerate(pair.shortened, 1)
        if short
    ]


def _given(gears: CylindricalGears) -> dict[str, Any]:
    """Arguments of `build_cylindrical_pair` by name."""
    ring = gears.teeth[1] < 0
    dedendum, fillet = usual_depths(
        gears.addendum, gears.dedendum, gears.fillet_radius, gears.pressure_angle, ring=ring
    )
    if ring and gears.fillet_radius is None:
        fillet = fillet[0], _ring_fillet(gears, dedendum[1])
    return {
        "teeth": (int(gears.teeth[0]), int(gears.teeth[1])),
        "module": gears.module,
        "pressure_angle": gears.pressure_angle,
        "helix_angle": gears.helix_angle,
        "face_width": gears.face_width,
        "profile_shift": gears.profile_shift,
        "addendum": gears.addendum,
        "dedendum": dedendum,
        "fillet_radius": fillet,
        "tip_alteration": gears.tip_alteration,
        "least_tip": _least_tip(gears),
        "centre_distance": gears.centre_distance,
        "infeed": gears.infeed,
        "cutter_teeth": gears.cutter_teeth,
        "cutter_shift": None if gears.cutter_teeth is None else gears.cutter_profile_shift,
        "right_flank": gears.flank == "right",
    }


def _ring_fillet(gears: CylindricalGears, dedendum: float) -> float:
    return usual_ring_fillet(
        teeth=gears.teeth[1],
        profile_shift=gears.profile_shift[1] + gears.infeed[1],
        dedendum=dedendum,
        pressure_angle=gears.pressure_angle,
        helix_angle=gears.helix_angle,
        cutter=None
        if gears.cutter_teeth is None
        else (gears.cutter_teeth, gears.cutter_profile_shift),
    )


_FOLLOWING = {
    "dedendum": "dedendum",
    "fillet_radius": "fillet_radius",
    "tip_alteration": "tip_alteration",
    "centre_distance": "centre_distance",
    "least_tip_thickness": "least_tip",
}


def _of_pair(gears: CylindricalGears, pair: CylindricalPair) -> dict[str, Any]:
    followed = {key: getattr(pair, name) for key, name in _FOLLOWING.items()}
    if any(gears.infeed):
        cut = tuple(map(sum, zip(gears.profile_shift, gears.infeed, strict=True)))
        why = (
            "alike for the backlash" if gears.thickness_allowance is None else "by their allowance"
        )
        note = f"teeth thinned {why}, with the tips of nominal ones"
        followed["generating_shift"] = Followed(cut, "derived", note)
    modifications = _modifications(gears)
    if modifications is not None:
        lengths = modifications.completed(pair)
        followed |= {f"modifications.{key}": getattr(lengths, key) for key in _LENGTHS}
    return followed


_LENGTHS = ("tip_relief_length", "root_relief_length", "end_relief_length")


FAMILY = Family(
    _cylindrical,
    _of_pair,
    _gear_deviations,
    drawing={**LAYERS, "points": ("point",)},
    coordinates=labels(MEMBERS, ("N1", "N2")),
    together=_cylindrical_together,
)
