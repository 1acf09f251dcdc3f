"""What wear leaves of the teeth: their shape, how wide their tips are, and how much the backlash grows."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Bool, Float
from numpy.polynomial.chebyshev import chebfit, chebval
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import contact_velocity
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import contacts_at
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import mesh_ends, nominal_motion
from pitchpoint.gears.tooth_section import chebyshev_nodes, tooth_sections
from pitchpoint.wear.history import Cells, Start

__all__ = ["STEEPEST", "HalfTeeth", "TipThickness", "backlash_growth", "half_teeth", "tips_of"]

STEEPEST = np.deg2rad(60.0)
"""Angle between flank and axis of the tooth beyond which a tip is rounded."""

SAME = 1e-6
"""Distance of places over the length of the flank below which they are one place."""

Values = NDArray[np.float64]


class TipThickness(NamedTuple):
    """Thickness of the teeth of both members at their tips.

    It is that at the outermost place of the flank that is reached, where the tooth is thinnest, in the
    normal section; a rounding beyond it does not count. One flank wears, the other stays as it is.

    Attributes:
        width: of flanks as new [m].
        taken: off it by a unit of depth there, one over the cosine of the angle of the flank [1].
        rows: which of the depths lie there: those of places on a flank that has any, else of a cell.
    """

    width: Float[np.ndarray, "2"]
    taken: Float[np.ndarray, "2"]
    rows: Bool[np.ndarray, "2 row strip"]

    def left(self, depth: Values) -> Values:
        """Thickness at the tip where most is gone from it across the face, of each member [m].

        Args:
            depth: worn off every cell and place [member, row, strip] [m].
        """
        gone = np.where(self.rows, depth, 0.0).max(axis=(1, 2))
        return np.asarray(self.width - self.taken * gone)


class HalfTeeth(NamedTuple):
    """Where the cells lie on the new teeth of both members, in the normal section.

    Attributes:
        half: thickness there from the axis of the tooth, at the middle of each cell [m].
        height: along the axis of the tooth from root to tip, from the lowest cell on [m].
        angle: between the flank and the axis of the tooth [rad].
    """

    half: Float[np.ndarray, "2 cell"]
    height: Float[np.ndarray, "2 cell"]
    angle: Float[np.ndarray, "2 cell"]


def half_teeth(mesh: Mesh, cells: Cells) -> HalfTeeth:
    """Half teeth of a mesh that has any, see `tooth_sections`.

    Args:
        mesh: with flanks as new.
        cells: on both flanks.
    """
    by_member = [
        _at_cells(nodes, middles)
        for nodes, middles in zip(
            jax.device_get(_tips(mesh)), np.asarray(cells.middles[0]), strict=True
        )
    ]
    half, height, angle = np.stack(by_member, axis=1)
    return HalfTeeth(half, height - height.min(axis=1, keepdims=True), angle)


def _at_cells(nodes: tuple[Values, ...], flank: Values) -> Values:
    """Half thickness, height and angle at arc lengths [m, m, rad]."""
    half, height, angle, reach = nodes
    place = (np.sqrt(np.maximum(flank, 0.0)) - reach[0]) / (reach[1] - reach[0])
    series = chebfit(chebyshev_nodes(half.size), np.stack([half, height, angle], 1), half.size - 1)
    return np.asarray(chebval(np.clip(2.0 * place - 1.0, -1.0, 1.0), series))


def tips_of(mesh: Mesh, cells: Cells, start: Start) -> TipThickness:
    """Tips of the teeth of a mesh that has any, see `tooth_sections`.

    Args:
        mesh: with flanks as new.
        cells: on both flanks.
        start: of the mesh.
    """
    width, taken, rows = [], [], np.zeros(cells.shape, bool)
    ends_of = zip(jax.device_get(_tips(mesh)), np.asarray(cells.flank), strict=True)
    for member, ((half, _, angle, reach), ends) in enumerate(ends_of):
        part = 0.5 * (chebyshev_nodes(half.size) + 1.0)
        places = (reach[0] + (reach[1] - reach[0]) * part) ** 2
        cell = (places - ends[0]) / (ends[1] - ends[0]) * cells.count
        # Midpoints of phases do not lie at the very end of a flank.
        reached = (cell >= -1.0) & (cell <= cells.count + 1.0) & (angle < STEEPEST)
        at = int(np.flatnonzero(reached)[-1])
        width.append(2.0 * half[at])
        taken.append(1.0 / np.cos(angle[at]))
        if start.places is None:
            rows[member, int(np.clip(cell[at], 0, cells.count - 1))] = True
        else:
            apart = np.abs(np.asarray(start.places[member]) - places[at])
            rows[member, cells.count :] = apart <= np.nanmin(apart) + SAME * abs(ends[1] - ends[0])
    return TipThickness(np.array(width), np.array(taken), rows)


@program
def _tips(mesh: Mesh) -> list[tuple[Array, Array, Array, Array]]:
    """Half thickness, height and angle along the flanks of both members, and the ends of these."""
    return [(*section.flank, section.load_angle, section.reach) for section in tooth_sections(mesh)]


def backlash_growth(
    mesh: Mesh, cells: Cells, start: Start, depth: Values, *, pitch_line: bool = False
) -> float:
    """Normal backlash that wear of the flanks in use adds, where it adds most in the mesh cycle [m].

    In each position the pair with the smallest gap touches first: what it has lost of both flanks is the
    growth there.

    Validity:
        Helical lines do not wear at their pitch line, beside which the nearest slice lies: where lines cross
        it in every position the growth is too large, and less with more slices. With `pitch_line` it is too
        small: lines touch first where they cross it.

    Args:
        mesh: with flanks as new.
        cells: on both flanks.
        start: of the mesh.
        depth: worn off every cell and place [member, row, strip] [m].
        pitch_line: nothing is gone from slices of lines with places between which the sliding turns.
    """
    if start.gap is None:
        worn = cells.worn(mesh, array(depth))
        before, after = (_least_gap(state, start) for state in (_unworn(mesh, cells), worn))
    else:
        gap = np.asarray(start.gap)
        gone = depth[:, cells.count :].sum(axis=0)
        if pitch_line:
            beside = _beside_pitch_line(mesh, start)
            gone[: len(beside)][beside] = 0.0
        before, after = (_least_at_places(state, start) for state in (gap, gap + gone))
        if pitch_line and gap.shape[1] > 1:
            nodes = start.contacts.active.shape[-1]
            before, after = before[:nodes], after[:nodes]
    return float(np.nanmax(after - before))


def _beside_pitch_line(mesh: Mesh, start: Start) -> Bool[np.ndarray, "place slice"]:
    """Places on slices beside which the sliding turns along a line, of all positions but where paths end."""
    # The sliding turns where it does, whoever drives.
    motion = nominal_motion(jax.device_get(mesh), *jax.device_get(mesh_ends(mesh)))
    slip = jax.device_get(contact_velocity(start.contacts.slip_arm, motion))
    turns = np.sign(slip[:, 1:]) != np.sign(slip[:, :-1])
    beside = np.zeros(slip.shape, dtype=bool)
    beside[:, 1:] |= turns
    beside[:, :-1] |= turns
    return beside.swapaxes(1, 2).reshape(-1, slip.shape[1])


def _least_at_places(gap: Values, start: Start) -> Values:
    """Smallest gap of all pairs in each position in which places are held."""
    pairs, slices, nodes = start.contacts.active.shape
    apart = [state.reshape(pairs, -1, slices) for state in np.split(gap, [pairs * nodes])]
    return np.concatenate([np.fmin.reduce(state, axis=(0, 2)) for state in apart])


def _unworn(mesh: Mesh, cells: Cells) -> Mesh:
    """The same mesh with surfaces that nothing is gone from: its contacts are those of a worn one."""
    return cells.worn(mesh, jnp.zeros(cells.shape))


def _least_gap(mesh: Mesh, start: Start) -> Float[np.ndarray, " node"]:
    contacts = contacts_at(mesh, start.phase)
    gap, active = jax.device_get((contacts.gap, contacts.active))
    open_gap = np.where(active, np.broadcast_to(gap, active.shape), np.inf)
    least_gap: Values = open_gap.min(axis=(0, 1))
    return least_gap
