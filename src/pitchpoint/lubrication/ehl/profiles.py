"""What is wrong with profiles across line contacts, and whether a grid shows them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np
from jaxtyping import Array, Float

from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.line import LineContact, length_of
from pitchpoint.lubrication.ehl.line_grid import grid
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.roughness import SHOWN, check_cover, check_map

__all__ = ["check_profiles"]

MOST: Final = 1025
"""Nodes of the finest grid that is offered."""

SAMPLES: Final = 64
"""Places in a cell of which its mean height is taken."""


def check_profiles(contact: LineContact, nodes: int) -> None:
    """InputError for heights that are no profile of lines at rest, or that no grid of so many nodes shows.

    Args:
        contact: contacts; their profiles are looked at where the widest of them is, whose cells are largest.
        nodes: across a contact.
    """
    if not contact.heights:
        return
    widths = [np.ravel(extent) for extent in _widths(replace(contact, heights=()))]
    half_width, length = (float(extent[np.nanargmax(widths[0])]) for extent in widths)
    ends = -half_width, half_width
    for profile in contact.heights:
        _check_profile(profile)
        check_cover(profile, "x", np.asarray(profile.x), ends)
        rough = partial(_rq_shown, profile, half_width, length)
        seen, rq = rough(nodes)
        if not _enough(seen, rq):
            finer = (number for number in _finer(nodes) if _enough(*rough(number)))
            remedy = next((f"take {number} nodes" for number in finer), _REMEDY)
            raise InputError(
                f"{nodes} nodes show Rq = {1e9 * seen:.3g} nm of a profile with {1e9 * rq:.3g} nm: waves "
                f"shorter than about four cells are lost; {remedy}",
                key="heights",
            )


_REMEDY = f"no grid up to {MOST} nodes shows them: smooth the profile, and take them as roughness"


def _finer(nodes: int) -> Iterator[int]:
    """Numbers of nodes of finer grids."""
    while (nodes := 2 * nodes - 1) <= MOST:
        yield nodes


def _check_profile(profile: HeightMap) -> None:
    """InputError for heights that differ along a line, or that move."""
    check_map(profile)
    heights = np.asarray(profile.heights)
    if np.any(heights != heights[0]):
        raise InputError(
            "heights that differ along the line: lines without ends take a profile along the surface speeds, "
            "and patches take maps",
            key="heights",
        )
    if profile.member is not None:
        raise InputError(
            f"heights that move with member {profile.member} have no steady film: those of no member stay "
            "where they are",
            key="heights",
        )


def _enough(seen: float, rq: float) -> bool:
    return seen >= SHOWN * rq


def _rq_shown(
    height_map: HeightMap, half_width: float, length: float, nodes: int
) -> tuple[float, float]:
    """Rq of what the cells of a contact see of a profile, and of the profile there [m]."""
    at = grid(nodes)
    inside = np.flatnonzero(length * np.abs(at.x) <= half_width)
    edges = length * (at.x[0] + np.append(0.0, np.cumsum(at.widths)))[inside[0] : inside[-1] + 2]
    places = edges[:-1, None] + np.diff(edges)[:, None] * (np.arange(SAMPLES) + 0.5) / SAMPLES
    x, profile = np.asarray(height_map.x), np.asarray(height_map.heights)[0]
    heights = np.interp(places, x, profile, period=np.ptp(x) if height_map.periodic else None)
    share = np.diff(edges) / (edges[-1] - edges[0])
    seen = np.mean(heights, axis=-1)
    mean = share @ seen
    variance = share @ np.mean((heights - mean) ** 2, axis=-1)
    return float(np.sqrt(share @ (seen - mean) ** 2)), float(np.sqrt(variance))


@program
def _widths(contact: LineContact) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """Half-widths and units of length of contacts [m]."""
    return contact.half_width, length_of(contact)
