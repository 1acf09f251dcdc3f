"""Teeth and path of contact: the picture, the plane of action, specific sliding and main dimensions."""

from collections.abc import Iterator
from math import degrees
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import Panel, pair_key
from pitchpoint.views.inputs import words
from pitchpoint.views.path import PathOfContact, path_of
from pitchpoint.views.picture import picture_of
from pitchpoint.views.point import of_geometry
from pitchpoint.views.section import Block, Drawn, Moving, Page, Section
from pitchpoint.views.sections.plane_of_action import plane_of_action
from pitchpoint.views.sections.sliding import sliding_figure

__all__ = ["TEETH", "dimensions"]

_PARTS = ("teeth.layer_tooth",)


def _blocks(page: Page) -> Iterator[Block]:
    groups = of_geometry(page.having(*_PARTS), page.several)
    for position, (variants, outcome) in enumerate(groups):
        sliding = Panel("", [sliding_figure(f"sliding{position}", outcome)])
        values = {
            "variants": variants,
            "picture": picture_of(outcome).svg(f"mesh{position}"),
            "plane": _plane(outcome),
            "sliding": sliding,
            "members": outcome.manifest["members"],
            "dimensions": dimensions(outcome),
            "path": path_of(outcome),
            "internal": _internal(outcome.parts["teeth"]),
        }
        yield Drawn("teeth.html.jinja", {"t": values}, [sliding])


def _moving(outcome: Outcome, name: str) -> Moving:
    """Teeth in mesh over one period, in frames as close as those of the report."""
    return Moving("mesh", picture_of(outcome).svg(name), "Phase", 1.0, 1.0 / 48.0)


def _internal(teeth: xr.Dataset) -> bool:
    return bool((teeth["teeth"].values < 0.0).any())


def _plane(outcome: Outcome) -> dict[str, Any]:
    """Plane of action, its lines in the colours of the pairs, lengths in words."""
    picture = plane_of_action(outcome.parts["teeth"]).picture()
    keys = [pair_key(lane) for lane in range(picture["lanes"] + 1)]
    told = {
        name: f"{show.number(picture[name], trailing=True)} mm"
        for name in ("mean", "least", "most")
    }
    return {**picture, "pairs": keys, "told": told}


def dimensions(outcome: Outcome) -> list[tuple[str, ...]]:
    """Names of the main dimensions, each with its values for both members or the one they share."""
    teeth, path = outcome.parts["teeth"], path_of(outcome)
    rows = [
        *_numbers(teeth, {"teeth": ("number of teeth z", 1.0, 6)}),
        *_given(outcome, "module", "normal module m_n" if path.helical else "module m"),
        *(_given(outcome, "helix_angle", "helix angle β") if path.helical else []),
        *(_angle(teeth, "base_helix_angle", "base helix angle β_b [°]") if path.helical else []),
        *_given(outcome, "profile_shift", "profile shift x"),
        *_undercut_limits(teeth),
        *_tip_alteration(teeth),
        *_numbers(teeth, _DIAMETERS),
        *_numbers(teeth, _THICKNESS[path.helical]),
        *_numbers(teeth, _LENGTHS),
        *_backlash(teeth),
        *_numbers(teeth, {"face_width": ("face width b [mm]", 1e3, 6)}),
        *_transverse(teeth, path),
        *_numbers(teeth, _POINTS),
    ]
    return rows + (_numbers(teeth, _OVERLAP) if path.helical else [])


_DIAMETERS = {
    "reference_radius": ("reference diameter d [mm]", 2e3, 6),
    "base_radius": ("base diameter d_b [mm]", 2e3, 6),
    "tip_radius": ("tip diameter d_a [mm]", 2e3, 6),
    "root_radius": ("root diameter d_f [mm]", 2e3, 6),
    "form_radius": ("form diameter d_Ff [mm]", 2e3, 6),
    "active_root_radius": ("active root diameter d_Nf [mm]", 2e3, 6),
    "working_radius": ("pitch diameter in operation d_w [mm]", 2e3, 6),
}
_THICKNESS = {
    False: {"tip_thickness": ("tooth thickness on the tip circle s_a [mm]", 1e3, 4)},
    True: {
        "tip_thickness": ("tooth thickness on the tip circle, normal section s_an [mm]", 1e3, 4)
    },
}
_LENGTHS = {
    "specific_sliding_A": ("specific sliding at A", 1.0, 4),
    "specific_sliding_E": ("specific sliding at E", 1.0, 4),
    "centre_distance": ("centre distance a [mm]", 1e3, 6),
    "mounting_distance": ("distance from the axis to the reference line a [mm]", 1e3, 6),
}
_POINTS = {
    "transverse_radius": ("relative radius across the profile R_y [mm]", 1e3, 5),
    "contact_place": (
        "place of the contacts across the face, from the middle of gear 1 [mm]",
        1e3,
        4,
    ),
    "contact_room": ("from the contacts to the nearest end of a face [mm]", 1e3, 4),
    "misalignment_approach": ("approach of the flanks by misalignment [µm]", 1e6, 4),
}
_OVERLAP = {
    "overlap_ratio": ("overlap ratio ε_β", 1.0, 4),
    "contact_ratio": ("total contact ratio ε_γ", 1.0, 4),
}

Row = tuple[str, ...]


def _numbers(teeth: xr.Dataset, named: dict[str, tuple[str, float, int]]) -> list[Row]:
    """Rows of the dimensions that there are: title, factor and digits by name."""
    return [
        (title, *(_number(factor * float(v), digits) for v in np.ravel(teeth[name].values)))
        for name, (title, factor, digits) in named.items()
        if name in teeth
    ]


def _number(value: float, digits: int) -> str:
    """A dimension; a dash for a member that does not have it."""
    return show.number(value, digits) if np.isfinite(value) else "–"


def _given(outcome: Outcome, key: str, title: str) -> list[Row]:
    """Row of an input as the case gives it."""
    found = words(outcome, "gears", key).replace(" deg", "°").split(" / ")
    each = [show.pretty(one).replace("-", "−") for one in found if one]
    return [(title, *each)] if each else []


def _angle(teeth: xr.Dataset, name: str, title: str) -> list[Row]:
    return [(title, show.number(degrees(float(teeth[name])), 6))] if name in teeth else []


def _tip_alteration(teeth: xr.Dataset) -> list[Row]:
    if "tip_alteration" not in teeth or np.abs(teeth["tip_alteration"].values).max() <= 5e-7:
        return []
    return _numbers(teeth, {"tip_alteration": ("tip alteration k [modules]", 1.0, 4)})


def _backlash(teeth: xr.Dataset) -> list[Row]:
    return [
        (title, show.quantity(name, float(teeth[name]), with_unit=False))
        for name, title in (
            ("circumferential_backlash", "backlash on the pitch circles j_wt [µm]"),
            ("normal_backlash", "backlash along the normal j_bn [µm]"),
        )
        if name in teeth
    ]


def _transverse(teeth: xr.Dataset, path: PathOfContact) -> list[Row]:
    """What a helical pair has in its transverse section, a spur pair in its only one."""
    words, sign = ("transverse ", "t") if path.helical else ("", "")
    angle = f"{words}pressure angle in operation α_w{sign} [°]"
    return [
        *_numbers(teeth, {"base_pitch": (f"{words}base pitch p_b{sign} [mm]", 1e3, 6)}),
        *_angle(teeth, "working_pressure_angle", angle),
        *_numbers(teeth, {"transverse_contact_ratio": ("transverse contact ratio ε_α", 1.0, 4)}),
    ]


def _undercut_limits(teeth: xr.Dataset) -> list[Row]:
    """Smallest profile shifts without undercut; a ring is not cut by a rack."""
    if "undercut_limit" not in teeth:
        return []
    limits = [_number(float(value), 4) for value in teeth["undercut_limit"].values]
    if _internal(teeth):
        limits[1] = "not cut by a rack"
    return [("smallest x without undercut x_min", *limits)]


TEETH = Section(
    name="teeth",
    title="Teeth and path of contact",
    short="Teeth",
    order=100.0,
    parts=_PARTS,
    blocks=_blocks,
    picture="mesh0-close",
    moving=_moving,
)
