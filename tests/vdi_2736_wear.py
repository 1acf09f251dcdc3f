"""Mean wear of a plastic gear over its whole flank, after VDI 2736 Part 2.

The work that slides between the flanks in one turn is 2 pi T H_V; k_w times it is the volume that all
teeth lose. The depth is that volume over the flanks in use, so that it is the mean of the local depth.

Equations 19 and 20 were taken from one public program (tkuhn39 2026), whose tests hold them against
the report of a commercial program; the guideline itself was not at hand.
"""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers

__all__ = ["flank_length", "mean_wear_depth"]

Each = Float[Numbers, "*#b"]


def flank_length(
    *, tip_diameter: Each, root_diameter: Each, base_diameter: Each
) -> Float[Array, "..."]:
    """Length of the involute that takes part, from the lowest to the highest point of contact [m].

    Args:
        tip_diameter: d_Na, of the highest point of contact, shape (...) [m].
        root_diameter: d_Nf, of the lowest point of contact, shape (...) [m].
        base_diameter: d_b, shape (...) [m].

    Returns:
        l_Fl, broadcast shape of the arguments [m].

    Source: VDI 2736 Part 2 (2014), equation 20; it is the arc length of an involute.

    Example:
        >>> length = flank_length(tip_diameter=53.8e-3, root_diameter=51.2e-3, base_diameter=48.9e-3)
        >>> round(float(length) * 1e3, 3)
        1.396
    """
    squares = jnp.asarray(tip_diameter) ** 2 - jnp.asarray(root_diameter) ** 2
    return squares / (4.0 * jnp.asarray(base_diameter))


def mean_wear_depth(
    *,
    torque: Each,
    turns: Each,
    loss_factor: Each,
    rate: Each,
    face_width: Each,
    teeth: Each,
    flank_length: Each,
) -> Float[Array, "..."]:
    """Mean depth that the flanks of a gear have lost, 2 pi T N H_V k_w / (b z l_Fl) [m].

    Args:
        torque: T on this gear, shape (...) [N m].
        turns: N of this gear, in each of which every tooth is loaded once, shape (...) [1].
        loss_factor: H_V of the pair by equation 8, which is `mesh_efficiency`, shape (...) [1].
        rate: k_w of this gear, shape (...) [1/Pa].
        face_width: b, common to both gears, shape (...) [m].
        teeth: z of this gear, shape (...) [1].
        flank_length: l_Fl of this gear, shape (...) [m].

    Returns:
        W_m, broadcast shape of the arguments [m].

    Validity:
        External pairs that wear little against their module; load, sharing and flank are those of new gears.

    Source: VDI 2736 Part 2 (2014), equation 19.

    Example:
        >>> depth = mean_wear_depth(torque=8.0, turns=1.324e7, loss_factor=0.0626, rate=1e-15,
        ...     face_width=15e-3, teeth=52, flank_length=1.330e-3)
        >>> round(float(depth) * 1e6, 1)
        40.2
    """
    volume = 2.0 * jnp.pi * jnp.asarray(torque) * turns * loss_factor * rate
    return volume / (jnp.asarray(face_width) * teeth * flank_length)
