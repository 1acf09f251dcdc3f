"""What a case may choose by name of strain wave gears: double-arc teeth and shapes of wave generators."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import TYPE_CHECKING

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    import numpy as np

__all__ = ["ARCS", "DOUBLE_ARCS", "WAVE_SHAPES", "DoubleArcForm", "WaveShape"]


@dataclass(frozen=True)
class DoubleArcForm:
    """A double-arc tooth, all in modules; see `DoubleArcFlank`."""

    convex_radius: float
    convex_offset: float
    convex_shift: float
    concave_radius: float
    concave_offset: float
    concave_shift: float
    addendum: float = 0.55
    dedendum: float = 0.75


ARCS = tuple(field.name for field in fields(DoubleArcForm) if field.default is MISSING)
"""Dimensions of both arcs, which belong together."""

DOUBLE_ARCS = {
    "liu": DoubleArcForm(1.370, 0.664, 0.310, 1.570, 0.660, 0.268),
    "flat": DoubleArcForm(2.000, 1.294, 0.330, 2.200, 1.290, 0.300),
}
"""Double-arc teeth by name: a published design (Liu et al. 2025), and one with flatter flanks."""


@dataclass(frozen=True, eq=False)
class WaveShape:
    """One way in which a wave generator holds its flexspline.

    Attributes:
        name, title: by which it is picked, and what it says.
        harmonics: amplitudes of cos 2p, cos 4p, ... that sum to one, from the angle of the forces
            [rad] and the ratio w0/r; of no account to some.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    harmonics: Deferred[Callable[[float, float], np.ndarray]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""


WAVE_SHAPES = Registry(
    "shape of the wave generator",
    WaveShape(
        "cosine",
        "radial displacement w0 cos 2p",
        "pitchpoint.gears.strain_wave.wave_generator:cosine",
        ("zhao_2022",),
    ),
    WaveShape(
        "elliptical",
        "ellipse with half axes r + w0 and r - w0",
        "pitchpoint.gears.strain_wave.wave_generator:elliptical",
    ),
    WaveShape(
        "two_rollers",
        "ring under two opposite forces",
        "pitchpoint.gears.strain_wave.wave_generator:two_rollers",
        ("timoshenko_1955",),
    ),
    WaveShape(
        "four_forces",
        "ring under two pairs of forces beside the long axis",
        "pitchpoint.gears.strain_wave.wave_generator:four_forces",
        ("timoshenko_1955",),
        note="force_angle says where; 30 degrees where it is not given.",
    ),
)
