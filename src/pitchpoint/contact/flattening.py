"""Approach of two solids in a line contact: how far they flatten each other under their load."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers

__all__ = ["line_compression", "yang_sun_1985"]

# A contact without load has no width; its logarithm, and the derivative of that, have to stay finite.
_LEAST_WIDTH_RATIO = 1e-9


def yang_sun_1985(
    *, young: Float[Numbers, "member *b"], poisson: Float[Numbers, "member *b"]
) -> Float[Array, "*b"]:
    """Compliance of a line contact that does not depend on the load [m2/N].

    q = (2/pi) sum (1 - nu^2)/E, so 4 (1 - nu^2)/(pi E) for two equal solids.

    Args:
        young: Young's modulus of each solid [Pa].
        poisson: Poisson's ratio of each solid.

    Returns:
        Approach over load per length. The contact of real solids yields by a logarithm more and
        depends on how thick they are, see `line_compression`.

    Source: Yang and Sun (1985) for equal solids, written as a sum over the two.

    Example:
        >>> import jax.numpy as jnp
        >>> steel = yang_sun_1985(young=jnp.full(2, 206e9), poisson=jnp.full(2, 0.3))
        >>> round(float(1e-9 / steel))
        178
    """
    return 2.0 / jnp.pi * jnp.sum((1.0 - poisson**2) / young, axis=0)


def line_compression(
    *,
    young: Float[Numbers, "*#b"],
    poisson: Float[Numbers, "*#b"],
    depth: Float[Numbers, "*#b"],
    half_width: Float[Numbers, "*#b"],
) -> Float[Array, "*b"]:
    """Compliance of one solid between a line contact and a point below it [m2/N].

    q = (2/pi) (1 - nu^2)/E (arsinh(s) - nu/(1 - nu) s (sqrt(1 + s^2) - s)) with s = t/a: the strain
    under Hertz's pressure, summed from the contact to the depth t. For t much larger than a this
    is Weber's (2/pi) (1 - nu^2)/E (ln(2 t/a) - nu/(2 (1 - nu))), which turns negative where the
    contact is wider than the solid is deep; the full sum stays positive. They agree within 1 % for
    t > 4 a.

    Args:
        young: Young's modulus [Pa].
        poisson: Poisson's ratio.
        depth: t, from the contact to the point that is taken as fixed [m]; for a tooth its axis.
        half_width: a of the contact under its load [m].

    Returns:
        Approach over load per length: a secant, since the half-width grows with the load.

    Source: Weber and Banaschek (1953); Johnson, Contact Mechanics (1985), eq. 5.57, both for t much
    larger than a.
    """
    # Without load the contact has no width, and the logarithm no limit.
    ratio = depth / jnp.maximum(half_width, _LEAST_WIDTH_RATIO * depth)
    slant = jnp.sqrt(1.0 + ratio**2)
    # The difference sqrt(1 + s^2) - s as a quotient: for a deep solid it would be rounding alone.
    lateral = poisson / (1.0 - poisson) * ratio / (slant + ratio)
    return 2.0 / jnp.pi * (1.0 - poisson**2) / young * (jnp.arcsinh(ratio) - lateral)
