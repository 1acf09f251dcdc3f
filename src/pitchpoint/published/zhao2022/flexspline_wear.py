"""Wear of the flexspline's flank as Zhao et al. (2022) calculate it, eqs. 10 to 33.

A discrete model, not the right physics: the force of a tooth is prescribed by a cosine over the zone, and
the step between two points of the flank stands for the sliding. What is calibrated in it is data of the case;
how oil, roughness, speed and temperature move the coefficient stands in `coefficient`.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import acos, log10, pi, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import jnp
from pitchpoint.core.status import Code
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.flexspline_tooth import (
    DoubleArcFlank,
    FlexsplineFlank,
    InvoluteFlank,
)
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.published.publication import Read, ReadingPoint
from pitchpoint.published.zhao2022.coefficient import MixedLubrication, mixed_lubrication
from pitchpoint.published.zhao2022.printed import (
    ENGAGED_HEIGHT,
    HALF_ZONE,
    deflection_offset,
    largest_tangential_load,
)
from pitchpoint.published.zhao2022.table import FlankWear

__all__ = ["LATER", "March", "Strips", "march", "march_cycles", "march_to_severe_wear", "readings"]

Array = NDArray[np.float64]

LATER = {"early": 2.56e9, "late": 6.28e9}
"""Cycles after which section 4.4 shows worn profiles."""

LONG = 2e10
"""Cycles after which section 4.3 tells the step of the tip."""

BLOCKS = 100
"""Blocks of cycles of a march; four times as many change no depth by more than 0.1 %."""

SEVERE_BLOCKS = 400
"""Blocks of the cycles until severe wear, as long as the rate of wear of new flanks."""

PLACES = 39
"""Places from the first point to the last at which courses are kept: 20 points and their middles."""

_PATIENCE = 3
"""So many times the cycles that new flanks would need for a depth are tried."""


@dataclass(frozen=True)
class Strips:
    """Strips of a flank about its points, from the tip on, and what loads them.

    Attributes:
        angle: flank angle of the new flank, from the axis of the tooth to the tangent, shape (point) [rad].
        place: new flank, across the tooth and outwards from its neutral line, shape (2, point) [m].
        force: tangential, eq. 19 with its largest value at the tip, shape (point) [N].
        load: q_t behind it, per face width and length of the ring, shape (point) [Pa].
        turn: of the tooth where the point is in mesh, eq. 27; the tip enters first, shape (point) [rad].
        step: between two points [m].
        face_width: [m].
        tip_land: s_ag [m].
        area: that carries the force of a point, as the table of the case has it.
    """

    angle: Array
    place: Array
    force: Array
    load: Array
    turn: Array
    step: float
    face_width: float
    tip_land: float
    area: str = "strip"

    def without_offset(self) -> "Strips":
        """The same without the turn of the teeth."""
        return replace(self, turn=np.zeros_like(self.turn))

    def worn(self, depth: Array) -> tuple[Array, Array, Array]:
        """Flank angle [rad], pressure [Pa] and step [m] of a flank worn to depths, shape (point) each.

        Depth is carried on the normals of the new flank. Where it grows towards the tip the flank leans over;
        points keep their height, so that their step grows with it. On strips of the worn flank the area
        grows as the normal force does, and the pressure stays; on those of the new flank it rises.
        """
        angle = self.angle - np.arctan(np.gradient(depth, self.step))
        step = self.step * np.cos(self.angle) / np.cos(angle)
        carrying = {"strip": step, "new strip": self.step, "cumulative": np.cumsum(step)}
        area = self.face_width * carrying[self.area]
        # Eqs. 20, 21 and 28: alpha there is the slope, and both signs of the offset are averaged.
        shift = self.face_width * self.turn * self.tip_land / (2.0 * area)
        return angle, self.force / np.cos(angle) / area / (1.0 - shift**2), step


@dataclass(frozen=True)
class March:
    """A wear march at the ends of its blocks.

    Attributes:
        cycles: shape (time) [1].
        depth, pressure, step: of each point, shape (time, point) [m, Pa, m].
    """

    cycles: Array
    depth: Array
    pressure: Array
    step: Array

    def cycles_to(self, depth: float) -> float:
        """Cycles until the deepest point is so deep; NaN where the march ended before."""
        deepest = np.max(self.depth, axis=1)
        return float(np.interp(depth, deepest, self.cycles, right=np.nan))

    def at(self, cycles: float, name: str) -> Array:
        """One of the fields at so many cycles, shape (point); NaN beyond the end."""
        values, end = getattr(self, name), float(self.cycles[-1])
        place = min(cycles, end) if cycles <= end * (1.0 + 1e-12) else np.inf
        return np.array(
            [np.interp(place, self.cycles, course, right=np.nan) for course in values.T]
        )


def march(
    strips: Strips, *, rate: float, block: float, blocks: int, limit: float = np.inf
) -> March:
    """Depth block by block, eqs. 11 and 12, with the flank renewed after each, eqs. 32 and 33.

    It ends before its last block where the depth passes the limit, or where the flank would lie flat.

    Args:
        strips: of the new flank.
        rate: kappa = K psi L_a / (100 H) of dh = kappa p s dN [1/Pa].
        block: cycles of a block.
        blocks: their number.
        limit: of the depth [m].
    """
    depth, history = np.zeros_like(strips.angle), []
    for done in range(blocks + 1):
        angle, pressure, step = strips.worn(depth)
        if not np.all(np.abs(angle) < pi / 2.0):
            break
        history.append((done * block, depth, pressure, step))
        if np.max(depth) > limit:
            break
        depth = depth + rate * pressure * step * block
    cycles, *fields = (np.array(column) for column in zip(*history, strict=True))
    return March(cycles, *fields)


def march_cycles(strips: Strips, *, rate: float, cycles: float) -> March:
    """March over a number of cycles in `BLOCKS` blocks."""
    return march(strips, rate=rate, block=cycles / BLOCKS, blocks=BLOCKS)


def march_to_severe_wear(strips: Strips, *, rate: float, limit: float) -> March:
    """March until the deepest point passes a limit [m], where the stage of severe wear begins."""
    _, pressure, step = strips.worn(np.zeros_like(strips.angle))
    fastest = float(np.max(rate * pressure * step))
    if not fastest > 0.0:  # without load nothing wears, and no depth is ever reached
        return march(strips, rate=rate, block=1.0, blocks=1)
    block = limit / fastest / SEVERE_BLOCKS
    return march(strips, rate=rate, block=block, blocks=_PATIENCE * SEVERE_BLOCKS, limit=limit)


# ------------------------------------------------------------------ flanks

Places = NDArray[np.complex128]

_Curve = Callable[[Array], tuple[Array, Places]]


def _double_arc(flank: DoubleArcFlank) -> _Curve:
    """Flank angle and place by the way from the tip, eqs. 1 to 4 with the signs that close them."""
    convex, concave = float(flank.convex_radius), float(flank.concave_radius)
    theta_a, theta_b = float(flank.tip_angle), float(flank.tangent_angle)
    upper, lower = complex(flank.convex_centre), complex(flank.concave_centre)
    arc, straight = convex * (theta_a - theta_b), float(flank.tangent_length)

    def curve(from_tip: Array) -> tuple[Array, Places]:
        line = from_tip - arc
        at_root = theta_b + np.maximum(line - straight, 0.0) / concave
        angle = np.where(line < 0.0, theta_a - from_tip / convex, at_root)
        along = -np.exp(-1j * theta_b) * np.minimum(line, straight)
        tangent = upper + 1j * convex * np.exp(-1j * theta_b) + along
        on_convex = upper + 1j * convex * np.exp(-1j * angle)
        on_concave = lower - 1j * concave * np.exp(-1j * angle)
        below = np.where(line < straight, tangent, on_concave)
        return angle, np.where(line < 0.0, on_convex, below)

    return curve


def _involute(flank: InvoluteFlank) -> _Curve:
    """Flank angle and place by the way from the tip."""
    base, neutral = float(flank.base_radius), float(flank.neutral_radius)
    half = float(flank.half_angle_at(flank.base_radius))
    tip = tan(acos(base / float(flank.tip_radius)))

    def curve(from_tip: Array) -> tuple[Array, Places]:
        roll = np.sqrt(tip**2 - 2.0 * from_tip / base)
        angle = roll - half
        return angle, base * np.exp(-1j * angle) * (1.0 + 1j * roll) - neutral

    return curve


def counterpart(flank: DoubleArcFlank, gears: StrainWaveGears) -> InvoluteFlank:
    """Involute flank of Table 1 with the module, teeth, rim and edges of another."""
    module, teeth = gears.module, gears.teeth[0]
    shift, addendum, dedendum = 3.32, 1.0, 1.35
    half_rim = float(flank.pitch_height - flank.dedendum)
    dimensions = {
        "teeth": teeth,
        "module": module,
        "pressure_angle": pi / 9.0,
        "profile_shift": shift,
        "addendum": addendum,
        "dedendum": dedendum,
        "neutral_radius": module * (teeth / 2.0 + shift - dedendum) - half_rim,
    }
    edges = {name: getattr(flank, name) for name in ("tip_rounding", "tip_relief", "relief_length")}
    return InvoluteFlank(
        **{name: jnp.asarray(value) for name, value in dimensions.items()}, **edges
    )


def strips_of(
    point: ReadingPoint, flank: FlexsplineFlank, neutral: float, *, finer: int = 1
) -> Strips:
    """Strips of a flank on a neutral line of a radius [m], at the torque of a point with its table.

    With `finer` there are so many times the points; each carries the force of a pitch all the same.
    """
    gears, table, mesh = point.gears, point.formulas, point.design.mesh
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(table, FlankWear)
    assert isinstance(mesh, StrainWave)
    count, module = finer * int(table.points), gears.module
    assert isinstance(flank, DoubleArcFlank | InvoluteFlank)
    curve = _double_arc(flank) if isinstance(flank, DoubleArcFlank) else _involute(flank)
    step, middle = table.flank_length * module / count, np.arange(count, dtype=np.float64) + 0.5
    angle, place = curve(step * middle)
    diameter = module * (gears.teeth[0] - ENGAGED_HEIGHT)
    largest = largest_tangential_load(
        torque=float(point.operation.load),
        half_zone=HALF_ZONE,
        diameter=diameter,
        face_width=gears.face_width,
    )
    load = largest * np.cos(pi / 2.0 * middle / count)
    pitch = 2.0 * pi / gears.teeth[0]
    strips = Strips(
        angle=angle,
        place=np.stack([place.imag, place.real]),
        force=gears.face_width * diameter / 2.0 * load * pitch,
        load=load,
        turn=deflection_offset(
            angle=HALF_ZONE * (1.0 - middle / count),
            radius=neutral,
            deflection=float(mesh.line.deflection),
        ),
        step=step,
        face_width=gears.face_width,
        tip_land=float(flank.tip_land),
        area=table.area,
    )
    return strips if table.offset == "mean" else strips.without_offset()


# ------------------------------------------------------------------ readings


def readings(point: ReadingPoint) -> Read:
    """Wear of the flank with all that the paper tells and draws of it, for a case with its table."""
    table, gears, mesh = point.formulas, point.gears, point.design.mesh
    if not isinstance(table, FlankWear):
        return {}
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(mesh, StrainWave)
    neutral = float(mesh.line.radius)
    strips = strips_of(point, mesh.flank, neutral)
    mixed = mixed_lubrication(
        point, tip_angle=float(strips.angle[0]), tip_force=float(strips.force[0])
    )
    rate = mixed.coefficient / table.hardness
    reading: dict[str, Any] = {"wear_rate": rate}
    wear = march_cycles(strips, rate=rate, cycles=table.cycles)
    reading |= _depths(wear, strips, rate, table)
    finer = strips_of(point, mesh.flank, neutral, finer=2)
    twice = march_cycles(finer, rate=rate, cycles=table.cycles).at(table.cycles, "depth")
    reading["wear_depth_change"] = float(np.max(twice)) - reading["wear_depth"]
    reading |= _stages(strips, rate, _limit(strips, table, gears.module))
    reading |= _flank_courses(strips, rate, neutral)
    reading |= _dry(strips, reading, mixed, table)
    reading |= mixed.readings
    reading["contact_temperature"] = float(point.operation.temperature) + reading["tip_flash"]
    reading["depth_growth"] = reading["tip_depth_late"] / reading["tip_depth_early"]
    if isinstance(mesh.flank, DoubleArcFlank):
        reading |= _beside_involute(reading, wear, point, rate)
    return reading


def _limit(strips: Strips, table: FlankWear, module: float) -> float:
    """Depth at which wear is severe [m]."""
    return min(strips.tip_land, table.severe_depth * module)


def _depths(with_offset: March, strips: Strips, rate: float, table: FlankWear) -> dict[str, Any]:
    """Depth with and without the offset over the cycles."""
    cycles = np.linspace(0.0, table.cycles, BLOCKS + 1)
    both = with_offset, march_cycles(strips.without_offset(), rate=rate, cycles=table.cycles)
    course = [_over(cycles, wear.cycles, wear.depth.max(axis=1)) for wear in both]
    return {
        "wear_depth": float(course[0][-1]),
        "wear_depth_without_offset": float(course[1][-1]),
        "wear_from_offset": float(course[0][-1] - course[1][-1]),
        "wear_pressure_new": float(both[0].pressure[0, 0]),
        "wear_cycles": cycles,
        "wear_course": course[0],
        "wear_course_without_offset": course[1],
        "wear_offset_error": course[0] - course[1],
        "wear_march_status": float(Code.SOLVED if np.isfinite(course[0][-1]) else Code.LIES_FLAT),
    }


def _over(places: Array, nodes: Array, values: Array) -> Array:
    """Values at places; NaN beyond those that are known."""
    end = nodes[-1] * (1.0 + 1e-12)
    return np.where(places <= end, np.interp(places, nodes, values), np.nan)


def _stages(strips: Strips, rate: float, limit: float) -> dict[str, Any]:
    """Tip of the flank until wear is severe."""
    wear = march_to_severe_wear(strips, rate=rate, limit=limit)
    end = wear.cycles_to(limit)
    cycles = np.linspace(0.0, wear.cycles[-1] if np.isnan(end) else end, BLOCKS + 1)
    return {
        "severe_depth": limit,
        "severe_wear_cycles": end,
        "severe_pressure": (pressure := float(wear.at(end, "pressure")[0])),
        "severe_pressure_ratio": pressure / float(wear.pressure[0, 0]),
        "wear_long_step": float(wear.at(LONG, "step")[0]),
        "severe_course": cycles,
        "severe_tip_pressure": _over(cycles, wear.cycles, wear.pressure[:, 0]),
        "severe_tip_step": _over(cycles, wear.cycles, wear.step[:, 0]),
        "severe_tip_depth": _over(cycles, wear.cycles, wear.depth[:, 0]),
    }


def _dry(
    strips: Strips, reading: dict[str, Any], mixed: MixedLubrication, table: FlankWear
) -> dict[str, Any]:
    """Depths of dry flanks: those of the reference, deeper by ψ L_a / 100 of the reference.

    A march with the dry coefficient itself would end within a thousandth of the cycles.
    """
    deeper, rate = mixed.dry / mixed.reference, mixed.reference / table.hardness
    late, all_cycles = (
        deeper * march_cycles(strips, rate=rate, cycles=cycles).at(cycles, "depth")
        for cycles in (LATER["late"], table.cycles)
    )
    depth = float(np.max(all_cycles))
    over_dry = reading["wear_depth"] / depth
    return {
        "dry_depth": depth,
        "dry_flank_depth": _spread(late),
        "lubricated_over_dry": over_dry,
        "dry_orders": -log10(over_dry) if over_dry > 0.0 else np.nan,
    }


def _flank_courses(strips: Strips, rate: float, neutral: float) -> dict[str, Any]:
    """Fields of the flank when it is new and after the cycles of section 4.4."""
    count = strips.angle.size
    from_tip, radius = (
        strips.step * (np.arange(count, dtype=np.float64) + 0.5),
        neutral + strips.place[1],
    )
    reading: dict[str, Any] = {
        "flank_way": _spread(from_tip),
        "flexspline_radius": _spread(radius),
        "tangential_load": _spread(strips.load),
        "radial_load": _spread(strips.load * np.tan(strips.angle)),
    }
    for name, cycles in {"new": 0.0, **LATER}.items():
        wear = march_cycles(strips, rate=rate, cycles=cycles)
        held = wear.cycles[-1] >= cycles * (1.0 - 1e-12)
        depth, pressure, step = (
            field[-1] if held else np.full(count, np.nan)
            for field in (wear.depth, wear.pressure, wear.step)
        )
        reading |= {
            f"flank_pressure_{name}": _spread(pressure),
            f"flank_step_{name}": _spread(step),
            f"flank_depth_{name}": _spread(depth),
            f"flank_profile_{name}": _spread(_profile(strips, depth)),
            f"tip_pressure_{name}": float(pressure[0]),
            f"tip_step_{name}": float(step[0]),
            f"tip_depth_{name}": float(depth[0]),
        }
    return reading


def _spread(values: Array) -> Array:
    """Values at points as a course, whatever their number."""
    return np.interp(np.linspace(0.0, values.size - 1.0, PLACES), np.arange(values.size), values)


def _profile(strips: Strips, depth: Array) -> Array:
    """Half thickness of the worn tooth at the heights of the new points; NaN above what is left [m]."""
    across, height = strips.place - depth * np.stack([np.cos(strips.angle), np.sin(strips.angle)])
    new = strips.place[1]
    return np.where(new <= height[0], np.interp(new, height[::-1], across[::-1]), np.nan)


def _beside_involute(
    reading: dict[str, Any], ours: March, point: ReadingPoint, rate: float
) -> dict[str, Any]:
    """Double arc beside the involute flank of Table 1 with the same coefficient, eqs. 11 to 33."""
    mesh, gears, table = point.design.mesh, point.gears, point.formulas
    assert isinstance(mesh, StrainWave)
    assert isinstance(mesh.flank, DoubleArcFlank)
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(table, FlankWear)
    flank = counterpart(mesh.flank, gears)
    involute = strips_of(point, flank, float(flank.neutral_radius))
    limit = _limit(involute, table, gears.module)
    until_severe = march_to_severe_wear(involute, rate=rate, limit=limit)
    theirs = march_cycles(involute, rate=rate, cycles=table.cycles)
    ratios = {
        name: float(np.max(ours.at(table.cycles, name) / theirs.at(table.cycles, name)))
        for name in ("pressure", "step", "depth")
    }
    late = march_cycles(involute, rate=rate, cycles=LATER["late"]).at(LATER["late"], "depth")
    return {
        "onset_over_involute": reading["severe_wear_cycles"] / until_severe.cycles_to(limit),
        **{f"{name}_over_involute": ratio for name, ratio in ratios.items()},
        "involute_flank_depth": _spread(late),
        **{
            f"involute_tip_{name}": _over(
                reading["severe_course"], until_severe.cycles, getattr(until_severe, name)[:, 0]
            )
            for name in ("pressure", "step", "depth")
        },
    }
