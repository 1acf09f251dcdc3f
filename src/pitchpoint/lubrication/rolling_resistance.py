"""Rolling resistance of lubricated contacts: the pressure of the inlet film works against both surfaces."""

from jaxtyping import Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.lubrication.groups import line_groups

__all__ = [
    "none",
    "wu_cheng_1991",
    "wu_cheng_1991_strips",
]

Each = Float[Numbers, "*#b"]

_OVER_STRIPS = 0.9923525509789987
"""Mean of (1 - y^2)^0.0126 from -1 to 1: sqrt(pi)/2 Gamma(1.0126)/Gamma(1.5126)."""


def none() -> Each:
    """No rolling resistance [N/m]."""
    return jnp.asarray(0.0)


def wu_cheng_1991(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Rolling resistance on each surface per length of a fully flooded line contact [N/m].

    F_r = 4.318 (G U)^0.658 W^0.0126 R / alpha, isothermal; U with the mean surface speed.

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed [m/s].
        viscosity: at the inlet [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    Valid where the film is thick and the contact not starved; a converged EHL solution differs by
    -5 to +22 % for Hertz pressures of 0.5 to 1.5 GPa. Source: Goksem and Hargreaves (1978), in the
    form used by Wu and Cheng (1991).

    Example:
        >>> resistance = wu_cheng_1991(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(resistance))
        136
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    load, speed, material = groups
    positive = (speed > 0.0) & (load > 0.0)
    exponent = 0.658 * _log(material * speed, positive) + 0.0126 * _log(load, positive)
    return jnp.where(positive, 4.318 * jnp.exp(exponent) * radius / pressure_viscosity, 0.0)


def wu_cheng_1991_strips(
    *,
    load: Each,
    semi_axis_across: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Rolling resistance on each surface of a fully flooded elliptic contact [N].

    Strips along the rolling direction, side by side over the width 2 a, roll as line contacts do, each under
    its part of Hertz's load: w(y) = 3 F/(4 a) (1 - y^2/a^2). The resistance hardly depends on that, so that
    it is the one per length times 0.992 of the width.

    Args:
        load: F [N].
        semi_axis_across: a, across the rolling direction [m].
        entrainment: mean surface speed [m/s].
        viscosity: at the inlet [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R_x [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    Valid where the ellipse is wide across the rolling direction, so that little oil leaves sideways: of a
    ball it is a rough upper bound. Source: see `wu_cheng_1991`; the sum over strips is a choice.

    Example:
        >>> resistance = wu_cheng_1991_strips(
        ...     load=500.0, semi_axis_across=2e-3, entrainment=5.0, viscosity=0.05,
        ...     pressure_viscosity=2e-8, radius=0.01, modulus=226.4e9,
        ... )
        >>> round(float(resistance), 3)
        0.544
    """
    width = 2.0 * semi_axis_across
    middle = 1.5 * load / jnp.where(width > 0.0, width, 1.0)
    per_length = wu_cheng_1991(
        line_load=middle,
        entrainment=entrainment,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
        radius=radius,
        modulus=modulus,
    )
    return _OVER_STRIPS * width * per_length


def _log(value: Each, positive: Bool[Arrays, "*#b"] | bool) -> Each:
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    return jnp.log(jnp.where(positive, value, 1.0))
