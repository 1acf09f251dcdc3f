"""A drive whose teeth are carried by a wave, drawn to scale: what the page needs to place every tooth.

The page gets one tooth, one space and the shape of the wave; it places the teeth on the deformed
neutral line for every angle of the wave generator. Corners are (across, outwards) in mm, across in
the sense of positive rotation, which the page shows counter-clockwise.
"""

import json
from collections.abc import Iterator
from math import degrees
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.variable import length
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.inputs import input_words
from pitchpoint.views.outlines import simplified
from pitchpoint.views.point import of_geometry, period_of
from pitchpoint.views.sections.passing import gap_panel
from pitchpoint.views.way import places_on_axis

__all__ = ["DRIVE", "loaded_arcs", "picture", "wave_dimensions"]

_LENGTH = length("", "")

_PARTS = ("teeth.wave_weights",)
_FINE = 1e-3
"""Largest distance that a corner of an outline may be moved by, in tooth heights."""

_PITCHES = 5.0
"""Width of the close-up in pitches of the flexspline."""


def picture(outcome: Outcome, name: str) -> dict[str, Any]:
    """Everything that the page draws of a drive, in mm and radians.

    Args:
        outcome: a result whose teeth are carried by a wave.
        name: of the drawing in the page.
    """
    teeth, members = outcome.parts["teeth"], outcome.manifest["members"]
    numbers, rates = _numbers(teeth), _rates(outcome)
    tooth, space = (1e3 * teeth[key].values for key in ("tooth", "space"))
    height = float(np.ptp(tooth[:, 1]))
    outside = float(space[:, 1].max()) + 2.5 * height
    radius = 1e3 * float(teeth["neutral_radius"])
    pitch = round(2.0 * np.pi * radius / numbers[0], 5)
    motion = {
        "teeth": numbers,
        "rates": [round(rate, 9) for rate in rates],
        "members": members,
        "radius": round(radius, 6),
        "deflection": round(1e3 * float(teeth["deflection"]), 6),
        "weights": [round(float(w), 7) for w in np.trim_zeros(teeth["wave_weights"].values, "b")],
        "rim": round(1e3 * float(teeth["rim_thickness"]), 5),
        "root": round(float(tooth[:, 1].min()), 5),
        "tooth": _corners(tooth, _FINE * height),
        "space": _corners(space, _FINE * height),
        "outside": round(outside, 4),
        "width": _PITCHES,
        "arcs": loaded_arcs(outcome),
    }
    middle = float(space[:, 1].min()) + 0.1 * height
    wide = _PITCHES * pitch
    return {
        "name": name,
        "motion_json": json.dumps(motion, separators=(",", ":")),
        "overview": [round(v, 3) for v in _around(1.02 * outside)],
        "window": [round(v, 4) for v in (-wide / 2.0, -middle - wide / 3.8, wide, wide / 1.9)],
        "loaded": bool(motion["arcs"]),
        "turns": members[int(np.argmax(np.abs(rates)))],
    }


def _numbers(teeth: xr.Dataset) -> list[int]:
    """Numbers of teeth of both splines."""
    return [round(float(number)) for number in teeth["teeth"].values]


def _rates(outcome: Outcome) -> list[float]:
    """Rates for a radian of the wave generator, or of the faster spline where that one is fixed."""
    rates = [float(rate) for rate in outcome.manifest["motion"]]
    most = abs(rates[0]) or max(abs(rate) for rate in rates)
    return [rate / most for rate in rates]


def _around(radius: float) -> tuple[float, float, float, float]:
    return -radius, -radius, 2.0 * radius, 2.0 * radius


def _corners(outline: np.ndarray, fine: float) -> list[list[float]]:
    return simplified(outline, fine).round(5).tolist()  # type: ignore[no-any-return]


def loaded_arcs(outcome: Outcome) -> list[list[float]]:
    """Angles from the long axis between which teeth carry under the first law [rad]; empty if unknown.

    Gaps of less than half a pitch are not told.
    """
    data = outcome.parts.get("cycle")
    if data is None:
        return []
    angle, load = np.radians(places_on_axis(data)), data["load"].values[0]
    order = np.argsort(angle.ravel(), kind="stable")
    angle, carries = angle.ravel()[order], load.ravel()[order] > 0.0
    loaded = angle[carries]
    if not loaded.size:
        return []
    half_pitch = np.pi / float(outcome.parts["teeth"]["teeth"].values[0])
    cuts = np.flatnonzero(np.diff(loaded) > half_pitch) + 1
    return [[round(float(arc[0]), 5), round(float(arc[-1]), 5)] for arc in np.split(loaded, cuts)]


def wave_dimensions(outcome: Outcome) -> list[tuple[str, ...]]:
    """Names of the main dimensions, each with the values of flexspline and circular spline or of both."""
    teeth, manifest = outcome.parts["teeth"], outcome.manifest

    def told(metres: float, digits: int = 6) -> str:
        return show.number_text(float(_LENGTH.displayed(metres)), digits)

    def titled(words: str) -> str:
        return show.bracketed(words, _LENGTH)

    deflection, neutral, rim, ring = (
        float(teeth[name])
        for name in ("deflection", "neutral_radius", "rim_thickness", "tip_height")
    )
    height = float(teeth["tooth"].values[:, 1].max())
    driver, loaded = manifest["driver"], manifest["loaded"]
    motion = dict(zip(manifest["members"], manifest["motion"], strict=True))
    rows: list[tuple[str, ...]] = [("number of teeth z", *map(str, _numbers(teeth)))]
    module, width = (
        show.pretty(input_words(outcome, "gears", key)) for key in ("module", "face_width")
    )
    rows += [("module m", module)] if module else []
    rows += [("face width b", width)] if width else []
    return [
        *rows,
        (
            f"speed ratio, {driver} to {loaded}",
            show.number_text(motion[driver] / motion[loaded], 6),
        ),
        ("fixed member", next(name for name in motion if name not in (driver, loaded))),
        (titled("deflection w_0"), told(deflection)),
        (titled("diameter of the undeformed neutral line"), told(2.0 * neutral)),
        (titled("rim thickness of the flexspline"), told(rim)),
        (
            titled("tip diameter, undeformed"),
            told(2.0 * (neutral + height)),
            told(2.0 * ring),
        ),
        (titled("tooth height above the neutral line"), told(height, 4)),
        (titled("depth to which the teeth reach into each other"), told(_depth(teeth), 4)),
    ]


def _sums_up(outcome: Outcome) -> Iterator[section.SectionTable]:
    """Main dimensions; what both splines share stands in both columns."""
    for name, mesh in section.by_mesh({"": outcome}, *_PARTS).items():
        rows = [row if len(row) == 3 else (*row, row[1]) for row in wave_dimensions(mesh)]
        title = ", ".join(filter(None, ["Gears", name]))
        yield section.SectionTable([title, "flexspline", "circular spline"], rows, caption=title)


def _depth(teeth: xr.Dataset) -> float:
    """From the tip of the circular spline's teeth to that of a flexspline tooth on the long axis [m]."""
    deepest, tip = teeth["passing"].values[..., 1].max(), teeth["space"].values[:, 1].min()
    return float(deepest - tip)


def _told_arcs(outcome: Outcome) -> str:
    """Angles between which teeth carry, in words; empty if unknown."""
    arcs = loaded_arcs(outcome)
    spans = [f"{degrees(a):.1f}° to {degrees(b):.1f}°".replace("-", "−") for a, b in arcs]
    return " and ".join(spans)


def _blocks(page: section.Page) -> Iterator[section.Block]:
    meshes = section.by_mesh(page.having(*_PARTS), *_PARTS)
    several = len({_told_arcs(one) for one in meshes.values()}) > 1
    for position, (variants, outcome) in enumerate(of_geometry(meshes)):
        of_loads = next(name for name, one in meshes.items() if one is outcome) if several else ""
        (gap,) = section.naming(variants or of_loads, [gap_panel(outcome, f"drive{position}")])
        values = {
            "variants": variants,
            "picture": picture(outcome, f"drive{position}"),
            "gap": gap,
            "dimensions": wave_dimensions(outcome),
            "arcs": _told_arcs(outcome),
            "of_loads": "" if variants else of_loads,
        }
        yield section.Drawn("drive.html.jinja", {"d": values}, [gap])


def _moving(outcome: Outcome, name: str) -> section.Animation:
    """Teeth over a turn of what turns fastest."""
    drawn = picture(outcome, name)
    motion = json.loads(drawn["motion_json"])
    still = {"motion_json": json.dumps({**motion, "arcs": []}), "loaded": True}
    driven_by = motion["rates"][motion["members"].index(outcome.manifest["driver"])]
    period = degrees(period_of(outcome).angle) / abs(driven_by)
    words = f"Angle, {drawn['turns']}"
    return section.Animation("drive", {**drawn, **still}, words, 360.0, 0.5, period, motion["arcs"])


DRIVE = section.Section(
    name="drive",
    title="Drive and path of the teeth",
    short="Drive",
    order=120.0,
    parts=_PARTS,
    lacks=lambda page: None if page.having(*_PARTS) else "",
    blocks=_blocks,
    picture="drive0-close",
    moving=_moving,
    sums_up=_sums_up,
)
