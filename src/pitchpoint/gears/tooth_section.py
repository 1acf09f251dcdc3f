"""One tooth cut across its flank lines: the shape that yields under load."""

from functools import cache, singledispatch
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

__all__ = ["FLANK_NODES", "RING_RIM", "ToothSection", "chebyshev_nodes", "tooth_sections"]

RING_RIM = "a ring's rim"
"""What carries the teeth of a ring."""

FLANK_NODES = 24
"""Chebyshev nodes along the flank; compliances are analytic there and converge like a power series."""


class ToothSection(eqx.Module):
    """Half of a symmetric tooth, from the root circle over the fillet and the flank to the tip.

    Heights run along the axis of the tooth from root to tip; their origin is of no account. All
    lengths are in the section normal to the flank lines, but `reach`, which says where on the flank
    of the contact type (`Contacts.flank`) the nodes lie.

    Attributes:
        fillet: half thickness and height at stations along the fillet [m].
        step: height that each of these stations stands for in an integral [m].
        flank: half thickness and height [m] at the Chebyshev nodes from the form circle to the tip.
        slope: derivative of the height along the flank with respect to the nodes' place in [-1, 1] [m].
        load_angle: angle between the normal of the flank and the perpendicular to the tooth's axis
            at the nodes [rad]; a positive one presses the tooth against its body.
        reach: square root of the flank's arc length at the first and the last node [m^0.5]; linear
            between them in the nodes' place.
        root_radius: of the body that carries the tooth [m].
        root_half_angle: half the angle that the tooth takes on the root circle [rad].
        rim_ratio: root radius over bore radius.
        stiff: what carries the tooth, in words, where no formula says how that yields; empty for a disc;
            static.
        width: of the face over which a contact in a point bends the tooth [m]; None where contacts are
            lines, each part of which bends its own slice.
    """

    fillet: Float[Array, "2 station"]
    step: Float[Array, " station"]
    flank: Float[Array, "2 node"]
    slope: Float[Array, " node"]
    load_angle: Float[Array, " node"]
    reach: Float[Array, "2"]
    root_radius: Float[Array, ""]
    root_half_angle: Float[Array, ""]
    rim_ratio: Float[Array, ""]
    stiff: str = eqx.field(static=True)
    width: Float[Array, ""] | None = None


@cache
def chebyshev_nodes(count: int = FLANK_NODES) -> np.ndarray:
    """Chebyshev points of the second kind, from -1 to 1.

    From the extremes of a Chebyshev polynomial, -cos(pi k/n).
    """
    return -np.cos(np.pi * np.arange(count) / (count - 1))


@singledispatch
def tooth_sections(mesh: Any) -> tuple[ToothSection, ToothSection]:
    """Teeth of the two members of a mesh as they yield.

    Raises:
        TypeError: its bodies have no teeth, see `has`.
    """
    raise TypeError(f"{type(mesh).__name__} has no teeth that yield")
