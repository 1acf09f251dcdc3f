"""What wear leaves of the teeth: how wide their tips are, and how much the backlash grows."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.efficiency.quasi_static import contacts_at
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.tooth_section import chebyshev_nodes
from pitchpoint.programs import program
from pitchpoint.wear.history import Cells, Start

__all__ = ["STEEPEST", "Tips", "backlash_growth", "tips_of"]

STEEPEST = np.deg2rad(60.0)
"""Angle between flank and axis of the tooth beyond which a tip is rounded."""

Values = NDArray[np.float64]


class Tips(NamedTuple):
    """Thickness of the teeth of both members at their tips.

    It is that at the outermost place of the flank that is reached, where the tooth is thinnest, in the
    normal section; a rounding beyond it does not count. One flank wears, the other stays as it is.

    Attributes:
        width: of flanks as new [m].
        taken: off it by a unit of depth there, one over the cosine of the angle of the flank [1].
        cell: that holds this place.
    """

    width: Float[np.ndarray, "2"]
    taken: Float[np.ndarray, "2"]
    cell: tuple[int, int]

    def left(self, depth: Values) -> Values:
        """Thickness at the tip where most is gone from it across the face, of each member [m].

        Args:
            depth: worn off [member, cell, strip] [m].
        """
        gone = [depth[k, cell].max() for k, cell in enumerate(self.cell)]
        return np.asarray(self.width - self.taken * np.array(gone))


def tips_of(mesh: Mesh, cells: Cells) -> Tips:
    """Tips of the teeth of a mesh that has any, see `Mesh.toothed`.

    Args:
        mesh: with flanks as new.
        cells: on both flanks.
    """
    width, taken, held = [], [], []
    for (half, angle, reach), ends in zip(
        jax.device_get(_tips(mesh)), np.asarray(cells.flank), strict=True
    ):
        part = 0.5 * (chebyshev_nodes(half.size) + 1.0)
        places = (reach[0] + (reach[1] - reach[0]) * part) ** 2
        cell = (places - ends[0]) / (ends[1] - ends[0]) * cells.count
        # Midpoints of phases do not lie at the very end of a flank.
        reached = (cell >= -1.0) & (cell <= cells.count + 1.0) & (angle < STEEPEST)
        at = int(np.flatnonzero(reached)[-1])
        width.append(2.0 * half[at])
        taken.append(1.0 / np.cos(angle[at]))
        held.append(int(np.clip(cell[at], 0, cells.count - 1)))
    return Tips(np.array(width), np.array(taken), (held[0], held[1]))


@program
def _tips(mesh: Mesh) -> list[tuple[Array, Array, Array]]:
    """Half thickness and angle along the flanks of both members, and the ends of these."""
    return [(one.flank[0], one.load_angle, one.reach) for one in mesh.sections]


def backlash_growth(mesh: Mesh, cells: Cells, start: Start, depth: Values) -> float:
    """Normal backlash that wear of the flanks in use adds, where it adds most in the mesh cycle [m].

    In each position the pair with the smallest gap touches first: what it has lost of both flanks is the
    growth there.

    Args:
        mesh: with flanks as new.
        cells: on both flanks.
        start: of the mesh.
        depth: worn off [member, cell, strip] [m].
    """
    worn = mesh.worn(cells.surfaces(array(depth)))
    before, after = (_least_gap(one, start) for one in (_unworn(mesh, cells), worn))
    return float(np.max(after - before))


def _unworn(mesh: Mesh, cells: Cells) -> Mesh:
    """The same mesh with surfaces that nothing is gone from: its contacts are those of a worn one."""
    none = jnp.zeros((2, cells.count, cells.strips))
    return mesh.worn(cells.surfaces(none))


def _least_gap(mesh: Mesh, start: Start) -> Float[np.ndarray, " node"]:
    contacts = contacts_at(mesh, start.phase)
    gap, active = jax.device_get((contacts.gap, contacts.active))
    open_gap = np.where(active, np.broadcast_to(gap, active.shape), np.inf)
    found: Values = open_gap.min(axis=(0, 1))
    return found
