"""What is wrong with height maps of a contact, and what its grid does not show of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pitchpoint.core.doubts import Doubt
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.layout import (
    FEWEST,
    Ends,
    Layout,
    dry_extents,
    lowered_on,
    problem_on,
    without_oil,
)

__all__ = [
    "SHOWN",
    "check_cover",
    "check_map",
    "check_maps",
    "check_maps_on",
    "check_standing",
    "unseen",
]

COARSEST: Final = 4
"""Steps of a map over the width of a contact, at least, along an axis on which heights change."""

SAME: Final = 1e-9
"""Part by which speeds along a line may differ that are one but for rounding."""

SHOWN: Final = 0.85
"""Part of the Rq of a map that a grid has to show: of waves as long as four cells .9 are left."""


def check_maps(contact: PatchContact) -> None:
    """InputError for heights that no surface has, and for maps that cannot move as a whole."""
    for height_map in contact.heights:
        check_map(height_map)
        if height_map.member is not None and _uneven(_speed(contact, height_map.member)):
            raise InputError(
                "a height map moves as a whole: the surface that takes it along needs one speed along the "
                "contact line",
                key="heights",
            )


def check_map(one: HeightMap) -> None:
    """InputError for a map with heights or places that no surface has."""
    for key, values in (("heights", one.heights), ("x", one.x), ("y", one.y)):
        wrong = int(np.sum(~np.isfinite(np.asarray(values))))
        if wrong:
            what = "height" if key == "heights" else f"place {key}"
            raise InputError(
                f"a height map with {wrong} {what}{'s' * (wrong > 1)} that are no finite number",
                key=key,
            )
    for key, places in (("x", one.x), ("y", one.y)):
        if not np.all(np.diff(np.asarray(places)) > 0.0):
            raise InputError(f"places {key} of a height map have to rise", key=key)
    _check_period(one)


def _uneven(speed: NDArray[np.float64]) -> bool:
    return bool(np.ptp(speed) > SAME * np.max(np.abs(speed)))


def _check_period(height_map: HeightMap) -> None:
    heights = np.asarray(height_map.heights)
    begins, ends = (heights[:, 0], heights[0]), (heights[:, -1], heights[-1])
    off = max(float(np.max(np.abs(a - b))) for a, b in zip(begins, ends, strict=True))
    if height_map.periodic and off > 1e-6 * np.ptp(heights):
        raise InputError(
            f"a periodic height map ends {1e9 * off:.3g} nm from the heights with which it begins: its last "
            "row and column are the first ones of the next period",
            key="heights",
        )


def check_standing(contact: PatchContact) -> None:
    """InputError for maps on surfaces that move, which have no steady film."""
    for height_map in contact.heights:
        if height_map.member is None:
            continue
        across = (contact.across_a, contact.across_b)[height_map.member]
        if np.any(np.asarray(_speed(contact, height_map.member))) or float(across):
            raise InputError(
                f"heights that move with member {height_map.member} have no steady film: `march_patches` "
                "moves them, and a map of no member stays where it is",
                key="heights",
            )


def _speed(contact: PatchContact, member: int) -> NDArray[np.float64]:
    return np.asarray((contact.speed_a, contact.speed_b)[member])


def check_maps_on(contact: PatchContact, layout: Layout, cells: int) -> None:
    """InputError for maps that leave parts of the contact out, that are coarse, or that outgrow its grid.

    Args:
        contact: one, with its maps where they are.
        layout: of its grid.
        cells: across it.
    """
    if not contact.heights:
        return
    for height_map in contact.heights:
        for axis, places, ends in zip(
            "xy", (height_map.x, height_map.y), dry_extents(contact, layout), strict=True
        ):
            check_cover(height_map, axis, np.asarray(places), ends)
    _check_reach(contact, layout, cells)


def check_cover(one: HeightMap, axis: str, places: NDArray[np.float64], ends: Ends) -> None:
    """InputError for a map that leaves a part of a contact out, or that is coarse along an axis.

    Args:
        one: the map.
        axis: x or y.
        places: of the map along it [m].
        ends: of the contact along it [m].
    """
    low, high = ends
    if not one.periodic and (places[0] > low or places[-1] < high):
        raise InputError(
            f"a height map from {_mm(places[0])} to {_mm(places[-1])} mm along {axis}: the contact reaches "
            f"from {_mm(low)} to {_mm(high)} mm, and the map has to cover it",
            key=axis,
        )
    changes = np.ptp(np.asarray(one.heights), axis=1 if axis == "x" else 0).max() > 0.0
    inside = (places[1:] > low) & (places[:-1] < high) | one.periodic
    step = float(np.max(np.diff(places)[inside]))
    if changes and step > (high - low) / COARSEST:
        raise InputError(
            f"a height map with steps of {_mm(step)} mm along {axis}: the contact is {_mm(high - low)} mm "
            f"long there, and takes at least {COARSEST} of them",
            key=axis,
        )


def _mm(place: float) -> str:
    return f"{1e3 * place:.4g}"


def _check_reach(contact: PatchContact, layout: Layout, cells: int) -> None:
    """InputError where heights let dry bodies touch at the edge of the grid."""
    problem = problem_on(contact, layout, FEWEST, FEWEST - 1, cells)
    dry = without_oil(problem.bodies, problem.apart, 1.0 / problem.yielding, problem.load)
    held = np.asarray(dry.pressure) > 0.0
    half = np.inf if contact.length is None else 0.5 * float(contact.length)
    inside = np.array([layout.first > -half, layout.last < half])
    if np.any(held[:, [0, -1]]) or np.any(held[[0, -1]][inside]):
        raise InputError(
            f"heights over {1e6 * _range(contact, layout, cells):.4g} um let the bodies touch at the edge of "
            "the grid, which lies around the contact of their mean planes: take form and long waves as "
            "radius, relief or profile, or a larger load",
            key="heights",
        )


def _range(contact: PatchContact, layout: Layout, cells: int) -> float:
    bodies = layout.bodies(FEWEST, FEWEST - 1, cells, contact.ends)
    return float(np.ptp(np.asarray(lowered_on(contact.heights, layout, bodies))))


def unseen(contact: PatchContact, layout: Layout, nodes: int, cells: int) -> Iterator[Doubt]:
    """Sentences on what the grid does not show of maps, and on contacts that are summits alone."""
    patch = dry_extents(contact, layout)
    for height_map in contact.heights:
        seen = _seen(height_map, layout, patch, (nodes, cells), contact.ends)
        rq = _rq(height_map, patch)
        if seen < SHOWN * rq:
            yield Doubt(
                f"the grid shows Rq = {1e9 * seen:.3g} nm of a height map with {1e9 * rq:.3g} nm: waves "
                "shorter than about four cells are lost; take more nodes, or take them as asperities",
                "unseen",
                1.0 - seen / rq,
                moves=1.0 - seen / rq,
                brief=f"the grid shows Rq {1e9 * seen:.3g} nm of {1e9 * rq:.3g} nm: take more nodes",
            )
    if contact.heights:
        high, flat = _range(contact, layout, cells), layout.half_width**2 / (2.0 * layout.radius)
        if high > flat:
            yield Doubt(
                f"heights over {1e6 * high:.3g} um are larger than the {1e6 * flat:.3g} um by which the load "
                "flattens the bodies: the contact is one of single summits, on a grid made for all of it",
                "summits",
                high / flat,
                brief=f"heights over {1e6 * high:.3g} um: a contact of single summits",
            )


def _rq(height_map: HeightMap, patch: tuple[Ends, Ends]) -> float:
    """Rq of a map at its own places on the contact, or of a whole period [m]."""
    heights = np.asarray(height_map.heights)
    x, y = (np.asarray(places) for places in (height_map.x, height_map.y))
    if not height_map.periodic:
        along, across = (_on(places, ends) for places, ends in zip((x, y), patch, strict=True))
        heights = heights[np.ix_(across, along)]
    return float(np.std(heights))


def _on(places: NDArray[np.float64], ends: Ends) -> NDArray[np.bool_]:
    """Places on the contact, with those just beyond it."""
    low = places[places <= ends[0]][-1:]
    high = places[places >= ends[1]][:1]
    inside: NDArray[np.bool_] = (places >= low) & (places <= high)
    return inside


def _seen(
    height_map: HeightMap,
    layout: Layout,
    patch: tuple[Ends, Ends],
    grid: tuple[int, int],
    ends: str,
) -> float:
    """Rq of what the cells of the contact see of a map [m]."""
    bodies = layout.bodies(*grid, grid[1], ends)
    places = (layout.length * np.asarray(positions) for positions in (bodies.x, bodies.y))
    along, across = (
        (at >= low) & (at <= high) for at, (low, high) in zip(places, patch, strict=True)
    )
    return float(
        np.std(np.asarray(lowered_on((height_map,), layout, bodies))[np.ix_(across, along)])
    )
