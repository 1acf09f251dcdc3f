"""Teeth and path of contact: the picture, the plane of action, specific sliding and main dimensions."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.variable import Variable, angle, deviation, dimensionless, length
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.figures import Panel, pair_key
from pitchpoint.views.inputs import input_words
from pitchpoint.views.path import StraightPath, contact_path
from pitchpoint.views.picture import picture_of
from pitchpoint.views.point import by_bodies, named_members, of_geometry
from pitchpoint.views.sections.plane_of_action import plane_of_action
from pitchpoint.views.sections.sliding import sliding_figure

__all__ = ["TEETH", "dimension_rows"]

_PARTS = ("teeth.layer_tooth",)

LENGTH, DEVIATION, ANGLE = length("", ""), deviation("", ""), angle("", "")
PLAIN = dimensionless("", "")


def _blocks(page: section.Page) -> Iterator[section.Block]:
    for position, (variants, outcome) in enumerate(
        of_geometry(section.by_mesh(page.having(*_PARTS), *_PARTS))
    ):
        panel = Panel("", [sliding_figure(f"sliding{position}", outcome)])
        (sliding,) = section.naming(variants, [panel])
        values = {
            "variants": _titled(variants, outcome),
            "picture": picture_of(outcome).svg(f"mesh{position}"),
            "plane": _plane(outcome),
            "sliding": sliding,
            "members": named_members(outcome),
            "dimensions": dimension_rows(outcome),
            "path": contact_path(outcome),
            "ring": _ring(outcome),
        }
        yield section.Drawn("teeth.html.jinja", {"t": values}, [sliding])


def _titled(variants: str, outcome: Outcome) -> str:
    """Names of what has these teeth, with the bodies where that is one mesh of a train."""
    bodies = str(outcome.manifest.get("bodies", ""))
    return (
        f"{variants}: {bodies}" if bodies and variants.endswith(tuple("0123456789")) else variants
    )


def _moving(outcome: Outcome, name: str) -> section.Animation:
    """Teeth in mesh over one period, in frames as close as those of the report."""
    return section.Animation("mesh", picture_of(outcome).svg(name), "Phase", 1.0, 1.0 / 48.0)


def _ring(outcome: Outcome) -> str:
    """The gear with internal teeth at the begin of a sentence; empty without one."""
    return by_bodies(outcome, "Gear 2") if _internal(outcome.parts["teeth"]) else ""


def _internal(teeth: xr.Dataset) -> bool:
    return bool((teeth["teeth"].values < 0.0).any())


def _plane(outcome: Outcome) -> dict[str, Any]:
    """Plane of action, its lines in the colours of the pairs, lengths in words."""
    picture = plane_of_action(outcome.parts["teeth"]).picture()
    keys = [pair_key(lane) for lane in range(picture["lanes"] + 1)]
    lengths = {name: _length(picture[name]) for name in ("mean", "least", "most")}
    lengths |= {name: _length(picture[name]) for name in ("width", "height")}
    return {**picture, "pairs": keys, "told": lengths}


def _length(millimetres: float) -> str:
    """A length of the picture in words [mm in]."""
    value = float(LENGTH.displayed(1e-3 * millimetres))
    return f"{show.number_text(value)} {show.display_unit(LENGTH.display)}"


def dimension_rows(outcome: Outcome) -> list[tuple[str, ...]]:
    """Names of the main dimensions, each with its values for both members or the one they share."""
    teeth, path = outcome.parts["teeth"], contact_path(outcome)
    rows = [
        *_numbers(teeth, {"teeth": ("number of teeth z", 1.0, 6, PLAIN)}),
        *_given(outcome, "module", "normal module m_n" if path.helical else "module m"),
        *(_given(outcome, "helix_angle", "helix angle β") if path.helical else []),
        *(_angle(teeth, "base_helix_angle", "base helix angle β_b") if path.helical else []),
        *_given(outcome, "profile_shift", "profile shift x"),
        *_undercut_limits(teeth),
        *_tip_alteration(teeth),
        *_numbers(teeth, _DIAMETERS),
        *_numbers(teeth, _THICKNESS[path.helical]),
        *_numbers(teeth, _LENGTHS),
        *_backlash(teeth),
        *_numbers(teeth, {"face_width": ("face width b", 1.0, 6, LENGTH)}),
        *_transverse(teeth, path),
        *_numbers(teeth, _POINTS),
    ]
    return rows + (_numbers(teeth, _OVERLAP) if path.helical else [])


_DETAILS = (
    "smallest x",
    "tip alteration",
    "base ",
    "form ",
    "active ",
    "specific ",
    "transverse base ",
)
"""How dimensions begin that a page which sums up leaves out."""


_MAIN = (
    "number of teeth",
    "module",
    "normal module",
    "helix angle",
    "profile shift",
    "centre distance",
    "face width",
)
_LEGIBLE = 2
"""Meshes with all their dimensions that one page holds in letters which can be read."""


def _sums_up(outcome: Outcome) -> Iterator[section.SectionTable]:
    """Dimensions that a drawing has, of many meshes the main ones; what both gears share stands twice."""
    meshes = section.by_mesh({"": outcome}, *_PARTS)
    for name, mesh in meshes.items():
        rows = [row for row in dimension_rows(mesh) if not row[0].startswith(_DETAILS)]
        if len(meshes) > _LEGIBLE:
            rows = [row for row in rows if row[0].startswith(_MAIN)]
        both = [row if len(row) == 3 else (row[0], row[1], row[1]) for row in rows]
        title = ", ".join(filter(None, ["Gears", name]))
        yield section.SectionTable([title, *named_members(mesh)[:2]], both, caption=title)


Dimension = tuple[str, float, int, Variable]
"""Title of a dimension, what its value is multiplied by, its digits, and what kind of quantity it is."""

_DIAMETERS = {
    "reference_radius": ("reference diameter d", 2.0, 6, LENGTH),
    "base_radius": ("base diameter d_b", 2.0, 6, LENGTH),
    "tip_radius": ("tip diameter d_a", 2.0, 6, LENGTH),
    "root_radius": ("root diameter d_f", 2.0, 6, LENGTH),
    "form_radius": ("form diameter d_Ff", 2.0, 6, LENGTH),
    "active_root_radius": ("active root diameter d_Nf", 2.0, 6, LENGTH),
    "working_radius": ("pitch diameter in operation d_w", 2.0, 6, LENGTH),
}
_THICKNESS = {
    False: {"tip_thickness": ("tooth thickness on the tip circle s_a", 1.0, 4, LENGTH)},
    True: {
        "tip_thickness": ("tooth thickness on the tip circle, normal section s_an", 1.0, 4, LENGTH)
    },
}
_LENGTHS = {
    "specific_sliding_A": ("specific sliding at A", 1.0, 4, PLAIN),
    "specific_sliding_E": ("specific sliding at E", 1.0, 4, PLAIN),
    "centre_distance": ("centre distance a", 1.0, 6, LENGTH),
    "mounting_distance": ("distance from the axis to the reference line a", 1.0, 6, LENGTH),
}
_POINTS = {
    "transverse_radius": ("relative radius across the profile R_y", 1.0, 5, LENGTH),
    "contact_place": (
        "place of the contacts across the face, from the middle of gear 1",
        1.0,
        4,
        LENGTH,
    ),
    "contact_room": ("from the contacts to the nearest end of a face", 1.0, 4, LENGTH),
    "misalignment_approach": ("approach of the flanks by misalignment", 1.0, 4, DEVIATION),
}
_OVERLAP = {
    "overlap_ratio": ("overlap ratio ε_β", 1.0, 4, PLAIN),
    "contact_ratio": ("total contact ratio ε_γ", 1.0, 4, PLAIN),
}

Row = tuple[str, ...]


def _numbers(teeth: xr.Dataset, named: Mapping[str, Dimension]) -> list[Row]:
    """Rows of the dimensions that there are."""
    return [
        (
            show.bracketed(title, kind),
            *(_number(float(kind.displayed(factor * v)), digits) for v in np.ravel(teeth[name])),
        )
        for name, (title, factor, digits, kind) in named.items()
        if name in teeth
    ]


def _number(value: float, digits: int) -> str:
    """A dimension; a dash for a member that does not have it."""
    return show.number_text(value, digits) if np.isfinite(value) else "–"


def _given(outcome: Outcome, key: str, title: str) -> list[Row]:
    """Row of an input as the case gives it."""
    entries = input_words(outcome, "gears", key).replace(" deg", "°").split(" / ")
    shown = [show.pretty(entry).replace("-", "−") for entry in entries if entry]
    return [(title, *shown)] if shown else []


def _angle(teeth: xr.Dataset, name: str, title: str) -> list[Row]:
    return _numbers(teeth, {name: (title, 1.0, 6, ANGLE)})


def _tip_alteration(teeth: xr.Dataset) -> list[Row]:
    if "tip_alteration" not in teeth or np.abs(teeth["tip_alteration"].values).max() <= 5e-7:
        return []
    return _numbers(teeth, {"tip_alteration": ("tip alteration k [modules]", 1.0, 4, PLAIN)})


def _backlash(teeth: xr.Dataset) -> list[Row]:
    return [
        (
            show.bracketed(title, show.described(name)),
            show.quantity(name, float(teeth[name]), with_unit=False),
        )
        for name, title in (
            ("circumferential_backlash", "nominal backlash on the pitch circles j_wt"),
            ("normal_backlash", "nominal backlash along the normal j_bn"),
        )
        if name in teeth
    ]


def _transverse(teeth: xr.Dataset, path: StraightPath) -> list[Row]:
    """What a helical pair has in its transverse section, a spur pair in its only one."""
    words, sign = ("transverse ", "t") if path.helical else ("", "")
    angle = f"{words}pressure angle in operation α_w{sign}"
    return [
        *_numbers(teeth, {"base_pitch": (f"{words}base pitch p_b{sign}", 1.0, 6, LENGTH)}),
        *_angle(teeth, "working_pressure_angle", angle),
        *_numbers(
            teeth, {"transverse_contact_ratio": ("transverse contact ratio ε_α", 1.0, 4, PLAIN)}
        ),
    ]


def _undercut_limits(teeth: xr.Dataset) -> list[Row]:
    """Smallest profile shifts without undercut; a ring is not cut by a rack."""
    if "undercut_limit" not in teeth:
        return []
    limits = [_number(float(value), 4) for value in teeth["undercut_limit"].values]
    if _internal(teeth):
        limits[1] = "not cut by a rack"
    return [("smallest x without undercut x_min", *limits)]


TEETH = section.Section(
    name="teeth",
    title="Teeth and path of contact",
    short="Teeth",
    order=100.0,
    parts=_PARTS,
    blocks=_blocks,
    picture="mesh0-close",
    moving=_moving,
    sums_up=_sums_up,
)
