"""Curvatures that contacts see over their width, where those of the flanks jump from point to point."""

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.roots import find_root
from pitchpoint.gears.strain_wave.flexspline_tooth import unit_circle_place
from pitchpoint.gears.strain_wave.groove import Groove
from pitchpoint.gears.strain_wave.tooth_motion import ToothMotion

__all__ = ["FLATTENED", "LEVELS", "curvature_in_contact"]

FLATTENED = 1e-4
"""Growth of the gap up to the edge of a contact, in modules: 4 w/(pi E') of steel teeth of 0.3 mm under
5 N/mm, as the heaviest contacts of the shipped sets carry at 4.7 N m. A contact of other loads differs from
it beside joints alone, and there by a logarithm: with the 18 N/mm at 47 N m the largest force on a tooth is
2 to 9 % less there, stiffness and loss differ by 0.2 %."""

LEVELS = (0.25, 1.0, 2.25)
"""Of that growth, over which widths are averaged: a contact hardly feels what lies at its very edge."""

_ROUGH = 1e-2

Each = Float[Array, "*b"]
Sides = Float[Array, "side level *b"]


def curvature_in_contact(
    motion: ToothMotion,
    groove: Groove,
    along: Each,
    angle: Each,
    module: Float[Array, ""],
    largest: Float[Array, ""],
) -> Each:
    """Relative curvature of flexspline and circular spline over the width of their contacts [1/m].

    Up to the edge of a contact by Hertz, at its half-width b, the gap of the unloaded flanks grows by
    4 w/(pi E') = b^2/(2 R). The reach of such a growth to both sides of the nearest point gives b, hence
    the relative curvature. Where nothing jumps it is that at the point; where the flank or the groove has a
    joint it goes over from one to the other. Against elastic half-planes with a joint of curvatures 1 to 50
    the approach is within 3 %, and by the curvature at the point up to 37 % too large.

    Args:
        motion: of the flexspline teeth.
        groove: of the circular spline.
        along: arc length of the nearest points on the flexspline's flanks [m].
        angle: of the teeth from the long axis [rad].
        module: [m].
        largest: radius that counts as flat [m].

    Source: Johnson, Contact Mechanics (1985), eq. 4.43; the mean over levels is an estimate.
    """
    levels = jnp.asarray(LEVELS).reshape(-1, *(1,) * along.ndim)
    grown = FLATTENED * module * levels
    reach = _reach(motion, groove, along, angle, grown, jnp.sqrt(2.0 * grown * largest))
    half_width = jnp.mean((reach[0] + reach[1]) / jnp.sqrt(levels), axis=0) / 2.0
    return 2.0 * FLATTENED * module / half_width**2


def _reach(
    motion: ToothMotion,
    groove: Groove,
    along: Each,
    angle: Each,
    grown: Float[Array, "level *#b"],
    widest: Float[Array, "level *#b"],
) -> Sides:
    """Way along the flank to its root and its tip on which the gap grows so far [m]."""
    flank, (foot, axis) = motion.flank, motion.foot(angle)
    turned, upright = unit_circle_place(axis), jnp.cos(axis - flank.angle(along))
    side = jnp.asarray([-1.0, 1.0]).reshape(2, *(1,) * grown.ndim)

    def play(reach: Array) -> Array:
        place = foot + turned * flank.place(along + side * reach)
        return groove.width_and_slope(jnp.real(place))[0] - jnp.imag(place)

    least = play(jnp.zeros_like(grown))

    def missing(reach: Sides) -> Sides:
        # Small, so that the rounding of places does not keep the search going.
        return _ROUGH * (upright * (play(reach) - least) / grown - 1.0)

    most = jnp.stack([jnp.minimum(widest, end) for end in (along, flank.length - along)])
    reaches, _ = find_root(missing, most / 4.0, jax.lax.stop_gradient(most))
    return jnp.clip(reaches, 0.0, most)
