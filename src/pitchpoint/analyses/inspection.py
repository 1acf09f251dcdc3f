"""What the drawing of a cylindrical gear asks for: span, balls, backlash by tolerances, classes, mass."""

from dataclasses import astuple, dataclass
from math import hypot, nan, sqrt
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.teeth import drawing_of
from pitchpoint.cases.built import Built
from pitchpoint.core.doubts import Doubt
from pitchpoint.gears.cylindrical.drawing_dimensions import (
    Backlash,
    Toothing,
    backlash,
    backlash_limits,
)
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances
from pitchpoint.gears.cylindrical.table import CylindricalGears, Inspection
from pitchpoint.gears.mesh_bodies import disc
from pitchpoint.results.store import dataset

__all__ = ["inspection_of", "inspection_part"]

NOTE = (
    "Backlash is that of tooth thickness and centre distance; deviations of pitch, runout, misalignment, "
    "bearing clearance and temperature come on top. Dimensions are those of involutes, without modifications."
)

CASES = ("nominal", "least", "mean", "largest")
LIMITS = ("nominal", "upper", "lower")

OUTWARDS = (0.5, 0.6, 0.7, 0.8)
"""Parts of the active flank at which a ball is tried until it stands out of its space."""

TOLERANCES = ("f_pT", "F_pT", "f_HαT", "f_fαT", "f_HβT", "f_fβT", "F_αT", "F_βT")
"""Symbols of `FlankTolerances`, in its order."""


@dataclass(frozen=True)
class _Measured:
    """A gear, the part of its flanks that can be measured, and with what.

    Attributes:
        name: of the gear.
        toothing: without allowances.
        usable: roll lengths at which involute and tip begin and end [m].
        tip: radius without sign [m].
        width: of the face [m].
        span: teeth under a span.
        ball: diameter of the balls [m].
        allowances: of the tooth thickness for each of `LIMITS` [m].
    """

    name: str
    toothing: Toothing
    usable: tuple[float, float]
    tip: float
    width: float
    span: int
    ball: float
    allowances: tuple[float, ...]

    @property
    def no_span(self) -> str:
        """Why no span can be measured; empty where one can."""
        gear = self.toothing
        if gear.side < 0.0:
            return "a span is that of external teeth"
        if gear.span_face(self.span) > self.width:
            return f"a span over {self.span} teeth is wider than its face"
        if not self._on_flank(gear.span_roll(self.span)):
            return f"a span over {self.span} teeth does not touch its involutes"
        return ""

    @property
    def no_ball(self) -> str:
        """Why balls measure nothing; empty where they do."""
        gear, balls = self.toothing, f"balls of {1e3 * self.ball:.4g} mm"
        if not self._on_flank(gear.ball_roll(self.ball)):
            return f"{balls} do not touch its involutes"
        if gear.side * (gear.ball_reach(self.ball) - self.tip) <= 0.0:
            return f"{balls} do not stand out of its spaces"
        return ""

    @property
    def told(self) -> list[str]:
        """Sentences on what cannot be measured."""
        return [f"{self.name}: {why}." for why in (self.no_span, self.no_ball) if why]

    def _on_flank(self, roll: float) -> bool:
        return self.usable[0] <= roll <= self.usable[1]

    def values(self) -> dict[str, Any]:
        """Dimensions by name; NaN where they cannot be measured."""
        gear, base = self.toothing, self.toothing.base_radius
        span, ball = (nan if why else 1.0 for why in (self.no_span, self.no_ball))
        thinned = [gear.thinned(one) for one in self.allowances]
        return {
            "normal_thickness": [one.normal_thickness for one in thinned],
            "span_teeth": span * self.span,
            "span_measurement": [span * one.span(self.span) for one in thinned],
            "span_diameter": span * 2.0 * hypot(base, gear.span_roll(self.span)),
            "ball_diameter": self.ball,
            "over_balls": [ball * one.over_balls(self.ball) for one in thinned],
            "ball_contact_diameter": ball * 2.0 * hypot(base, gear.ball_roll(self.ball)),
        }


def inspection_of(built: Built, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Dataset of the part."""
    return inspection_part(built)


def inspection_part(built: Built) -> xr.Dataset:
    """Dimensions, tolerances and backlash of a cylindrical pair, nominal and at the limits of its case.

    Args:
        built: the case.
    """
    table = built.case.gears
    assert isinstance(table, CylindricalGears)
    inspection = table.inspection or Inspection()
    pair = [_measured(number, built, table, inspection) for number in (0, 1)]
    dimensions = [one.values() for one in pair]
    plays = _plays(pair, table, inspection, float(built.dimensions["centre_distance"]))
    over = {0: ("gear",), 1: ("gear", "limit")}
    jams = [
        Doubt(
            f"The least backlash by tolerances is {1e6 * one.normal:.3g} um: the teeth can jam.",
            brief=f"Least backlash by tolerances {1e6 * one.normal:.3g} um: teeth can jam.",
        )
        for one in plays[1:2]
        if one.normal < 0.0
    ]
    return dataset(
        {
            **{
                name: (over[np.ndim(value)], [one[name] for one in dimensions])
                for name, value in dimensions[0].items()
            },
            "backlash_on_circle": (("case",), [one.circumferential for one in plays]),
            "backlash_along_normal": (("case",), [one.normal for one in plays]),
            "backlash_angle": (("gear", "case"), np.transpose([one.angular for one in plays])),
            **_discs(built),
            **_tolerances(table, pair),
        },
        {
            "gear": [one.name for one in pair],
            "limit": [*LIMITS[: len(pair[0].allowances)]],
            "case": [*CASES[: len(plays)]],
            **({"tolerance": [*TOLERANCES]} if table.tolerance_class else {}),
        },
        title="inspection",
        warnings=jams,
        note=NOTE,
        unmeasured=[sentence for one in pair for sentence in one.told],
        asked=int(table.inspection is not None),
        iso_class=[*(table.tolerance_class or ())],
    )


def _measured(number: int, built: Built, table: CylindricalGears, asked: Inspection) -> _Measured:
    mesh: Any = built.design.mesh
    drawn, angles = drawing_of(built), (float(mesh.pressure_angle), float(mesh.helix_angle))
    teeth, shift, infeed = (
        float(np.asarray(both)[number]) for both in (mesh.teeth, mesh.profile_shift, mesh.infeed)
    )
    # Allowances of a drawing count from teeth without any, whatever those that are computed have.
    infeed = infeed if table.thickness_allowances is None else 0.0
    gear = Toothing(teeth, float(mesh.module), *angles, shift + infeed)
    tip = float(drawn["tip_radius"][number])
    form, active, end = (
        _roll(gear, float(drawn[name][number]))
        for name in ("form_radius", "active_root_radius", "tip_radius")
    )
    span_teeth, balls = asked.span_teeth, asked.ball_diameter
    limits = table.thickness_allowances or ()
    return _Measured(
        name=f"gear {number + 1}",
        toothing=gear,
        usable=(min(form, end), max(form, end)),
        tip=tip,
        width=float(mesh.face_width),
        span=int(span_teeth[number]) if span_teeth else gear.usual_span((active + end) / 2.0),
        ball=balls[number] if balls else _usual_ball(gear, tip, active, end),
        allowances=(0.0, *(limit[number] for limit in limits)),
    )


def _usual_ball(gear: Toothing, tip: float, active: float, end: float) -> float:
    """Diameter of a ball that touches near the middle of the active flank, further out if it sinks in [m]."""
    every = [gear.usual_ball(active + part * (end - active)) for part in OUTWARDS]
    return next(
        (ball for ball in every if gear.side * (gear.ball_reach(ball) - tip) > 0.0), every[0]
    )


def _roll(gear: Toothing, radius: float) -> float:
    """Roll length at a radius [m]."""
    return sqrt(max(radius**2 - gear.base_radius**2, 0.0))


def _plays(
    pair: list[_Measured], table: CylindricalGears, asked: Inspection, distance: float
) -> list[Backlash]:
    """Backlash of the nominal gears, and least, mean and largest one where tolerances are given."""
    gears, deviation = [gear.toothing for gear in pair], asked.deviation(distance)
    nominal, allowed = backlash(gears[0], gears[1], distance), table.thickness_allowances
    if allowed is None and deviation is None:
        return [nominal]
    upper, lower = allowed or ((0.0, 0.0), (0.0, 0.0))
    limits = backlash_limits(
        gears[0], gears[1], distance, upper=upper, lower=lower, deviation=deviation or 0.0
    )
    return [nominal, *limits]


def _discs(built: Built) -> dict[str, Any]:
    """Mass and moment of inertia of both gears as discs, as a vibration takes them."""
    mesh: Any = built.design.mesh
    drawn, discs = drawing_of(built), []
    teeth, rims = np.asarray(mesh.teeth), np.asarray(mesh.rim_ratio)
    for number, solid in enumerate(built.design.solids):
        ring = float(teeth[number]) < 0.0
        root, rim = float(drawn["root_radius"][number]), float(rims[number])
        discs.append(
            disc(
                density=float(solid.density),
                width=float(mesh.face_width),
                outer=float(drawn["reference_radius"][number]),
                inner=root * rim if ring else root / rim,
            )
        )
    mass, inertia = zip(*discs, strict=True)
    return {"disc_mass": (("gear",), mass), "disc_inertia": (("gear",), inertia)}


def _tolerances(table: CylindricalGears, pair: list[_Measured]) -> dict[str, Any]:
    """Limits of the flanks of both gears by their classes; nothing without them."""
    if table.tolerance_class is None:
        return {}
    tolerances = [
        astuple(
            flank_tolerances(
                tolerance_class=int(number),
                diameter=2.0 * abs(gear.toothing.reference_radius),
                module=gear.toothing.module,
                face_width=gear.width,
            )
        )
        for number, gear in zip(table.tolerance_class, pair, strict=True)
    ]
    return {"flank_tolerance": (("gear", "tolerance"), tolerances)}
