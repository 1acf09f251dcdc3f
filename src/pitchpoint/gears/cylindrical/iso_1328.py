"""Flank tolerances of cylindrical gears by ISO 1328-1, and a gear at the limits of its class."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import floor, hypot, sqrt

import numpy as np
from jaxtyping import Float

__all__ = [
    "FlankTolerances",
    "ToothErrors",
    "flank_tolerances",
    "gear_at_its_limits",
    "out_of_scope",
]

Teeth = Float[np.ndarray, " tooth"]


@dataclass(frozen=True)
class FlankTolerances:
    """Limits of one class.

    Attributes:
        single_pitch: f_pT, of the largest single pitch deviation, along the reference circle [m].
        total_pitch: F_pT, of the range of the cumulative pitch deviation [m].
        profile_slope, profile_form: f_HαT, f_fαT, along the line of action [m].
        helix_slope, helix_form: f_HβT, f_fβT, along the line of action [m].
        profile_total, helix_total: F_αT, F_βT, of slope and form together [m].

    Source: ISO 1328-1:2013, tolerances of deviations of the flanks.
    """

    single_pitch: float
    total_pitch: float
    profile_slope: float
    profile_form: float
    helix_slope: float
    helix_form: float
    profile_total: float
    helix_total: float


@dataclass(frozen=True)
class ToothErrors:
    """Deviations of every tooth of one gear.

    Attributes:
        pitch: cumulative pitch deviation along the reference circle, of mean zero [m].
        profile_slope, profile_form, helix_slope, helix_form: of each flank, with sign [m].

    Source: ISO 1328-1:2013, deviations of pitch, profile and helix.
    """

    pitch: Teeth
    profile_slope: Teeth
    profile_form: Teeth
    helix_slope: Teeth
    helix_form: Teeth


def flank_tolerances(
    *, tolerance_class: int, diameter: float, module: float, face_width: float
) -> FlankTolerances:
    """Limits of deviations of one gear, rounded as the standard does.

    Args:
        tolerance_class: A, from 1 (finest) to 11.
        diameter: of the reference circle [m].
        module: normal module [m].
        face_width: [m].

    Source: ISO 1328-1:2013, eqs. 5 to 12, in mm and um; `out_of_scope` says where they do not hold.

    Example:
        >>> found = flank_tolerances(tolerance_class=6, diameter=0.1, module=3e-3, face_width=0.03)
        >>> [round(1e6 * limit, 1) for limit in (found.single_pitch, found.total_pitch)]
        [9.0, 28.0]
    """
    d, m, b = 1e3 * diameter, 1e3 * module, 1e3 * face_width
    step = sqrt(2.0) ** (tolerance_class - 5)
    in_um = (
        0.001 * d + 0.4 * m + 5.0,
        0.002 * d + 0.55 * sqrt(d) + 0.7 * m + 12.0,
        0.4 * m + 0.001 * d + 4.0,
        0.55 * m + 5.0,
        0.05 * sqrt(d) + 0.35 * sqrt(b) + 4.0,
        0.07 * sqrt(d) + 0.45 * sqrt(b) + 4.0,
    )
    totals = hypot(*in_um[2:4]), hypot(*in_um[4:])  # of what is not rounded yet
    return FlankTolerances(*(1e-6 * _rounded(step * limit) for limit in (*in_um, *totals)))


_TIE = 1e-9  # what lies half way is rounded up, whatever binary numbers make of it


def _rounded(micrometres: float) -> float:
    """To whole micrometres above 10, to halves above 5, else to tenths."""
    parts = 1 if micrometres > 10.0 else 2 if micrometres >= 5.0 else 10
    return floor(parts * micrometres + 0.5 + _TIE) / parts


def out_of_scope(
    *, teeth: float, diameter: float, module: float, face_width: float, helix_angle: float
) -> Iterator[str]:
    """What of a gear lies outside the ranges of the standard, in words; its formulas do not hold there.

    Args:
        teeth: z.
        diameter, module, face_width: [m].
        helix_angle: [rad].

    Source: ISO 1328-1:2013, clause 1.
    """
    ranges = {
        "number of teeth": (teeth, 5.0, 1000.0, ""),
        "reference diameter": (1e3 * diameter, 5.0, 15_000.0, " mm"),
        "normal module": (1e3 * module, 0.5, 70.0, " mm"),
        "face width": (1e3 * face_width, 4.0, 1200.0, " mm"),
        "helix angle": (float(np.degrees(helix_angle)), 0.0, 45.0, " deg"),
    }
    for name, (value, low, high, unit) in ranges.items():
        if not low * (1.0 - 1e-9) <= value <= high * (1.0 + 1e-9):
            yield f"the {name}, {value:.6g}{unit}, is outside {low:g} to {high:g}{unit}"


def gear_at_its_limits(
    tolerances: FlankTolerances, teeth: int, seed: tuple[int, int]
) -> ToothErrors:
    """A gear drawn at random that reaches the limits of its class.

    The cumulative pitch deviation is that of an eccentricity and scatter from tooth to tooth, in such parts
    that its range and the largest single pitch deviation are both at their limits; where an eccentricity
    alone has larger single deviations, as with few teeth, these are at their limit and the range within it.
    The largest slope and form of all teeth are at their limits.

    Args:
        tolerances: of its class.
        teeth: z.
        seed: of the drive and of the gear; the same seed gives the same gear.

    Source: ISO 1328-1:2013 for the limits; how deviations are drawn within them is a choice.
    """
    draw = np.random.default_rng(seed)
    around = 2.0 * np.pi * np.arange(teeth) / teeth + draw.uniform(0.0, 2.0 * np.pi)
    pitch = _pitch(tolerances, np.cos(around), draw.uniform(-1.0, 1.0, teeth))

    def scattered(limit: float) -> Teeth:
        values = draw.uniform(-1.0, 1.0, teeth)
        return np.asarray(limit * values / np.abs(values).max())

    return ToothErrors(
        pitch=pitch - pitch.mean(),
        profile_slope=scattered(tolerances.profile_slope),
        profile_form=scattered(tolerances.profile_form),
        helix_slope=scattered(tolerances.helix_slope),
        helix_form=scattered(tolerances.helix_form),
    )


def _pitch(tolerances: FlankTolerances, wave: Teeth, scatter: Teeth) -> Teeth:
    """Cumulative pitch deviation as a mixture at both limits of pitch."""
    from scipy.optimize import brentq

    wanted_ratio = tolerances.single_pitch / tolerances.total_pitch

    def mixed(part: float) -> Teeth:
        return np.asarray((1.0 - part) * wave + part * scatter)

    def excess(part: float) -> float:
        values = mixed(part)
        return float(_largest_step(values) / np.ptp(values) - wanted_ratio)

    ends = excess(0.0), excess(1.0)
    part = brentq(excess, 0.0, 1.0, xtol=1e-15) if ends[0] < 0.0 < ends[1] else float(ends[0] < 0.0)
    deviations = mixed(part)
    limits = (
        tolerances.total_pitch / np.ptp(deviations),
        tolerances.single_pitch / _largest_step(deviations),
    )
    return np.asarray(deviations * min(limits))


def _largest_step(values: Teeth) -> float:
    """From one tooth to the next, all around."""
    return float(np.abs(np.diff(values, append=values[:1])).max())
