"""Elliptic contacts of two solids: semi-axes, pressure, approach, and the shear below the surface."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.elliptic_integrals import carlson_rd, complete_integrals
from pitchpoint.core.factored import Numbers
from pitchpoint.core.roots import find_root

__all__ = [
    "Ellipse",
    "hamrock_brewe_1983",
    "hertz_1881",
    "largest_shear",
]

Each = Float[Numbers, "*#b"]

_DEEPEST = 3.0
"""The largest shear lies less than so many of the shorter semi-axis below the surface."""


class Ellipse(eqx.Module):
    """An elliptic contact under its load.

    Attributes:
        along: semi-axis in the rolling direction [m].
        across: semi-axis at right angles to it [m].
        pressure: largest one, in the middle [Pa].
        approach: of points of the two solids far from the contact [m].
        stiffness: load over approach for a small change of load, dF/d(approach) = 3 F/(2 approach) [N/m].

    Source: Hertz (1881).
    """

    along: Float[Array, "*b"]
    across: Float[Array, "*b"]
    pressure: Float[Array, "*b"]
    approach: Float[Array, "*b"]
    stiffness: Float[Array, "*b"]


def hertz_1881(*, load: Each, radius: Each, transverse_radius: Each, modulus: Each) -> Ellipse:
    """Elliptic contact by the theory of Hertz, with elliptic integrals; either axis may be the longer one.

    Args:
        load: normal load F [N], not negative.
        radius: relative radius in the rolling direction R_x [m], positive.
        transverse_radius: relative radius across it R_y [m], positive.
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members.

    a^3 = 6 k^2 E F R/(pi E') with k = a/b, a across the rolling direction, 1/R = 1/R_x + 1/R_y;
    approach 3 K F/(pi a E'). Exact for smooth, elastic half spaces: semi-axes small against the radii.

    Source: Johnson, Contact Mechanics (1985), eqs. 4.26 to 4.28 (there E* = E'/2).

    Example: a steel ball of 19 mm on a disc.

        >>> ball = hertz_1881(load=30.0, radius=9.5e-3, transverse_radius=9.5e-3, modulus=226.4e9)
        >>> round(float(ball.pressure) / 1e6), round(float(ball.approach) * 1e6, 2)
        (938, 1.61)
    """
    ratio = _ratio_of_axes(jnp.asarray(transverse_radius / radius))
    first_kind, cosine, sine = complete_integrals(ratio**-2)
    second_kind = cosine + sine / ratio**2
    return _ellipse(load, radius, transverse_radius, modulus, (ratio, first_kind, second_kind))


def hamrock_brewe_1983(
    *, load: Each, radius: Each, transverse_radius: Each, modulus: Each
) -> Ellipse:
    """Elliptic contact with the integrals as powers of R_y/R_x, near Hertz.

    Args:
        load: normal load F [N], not negative.
        radius: relative radius in the rolling direction R_x [m], positive.
        transverse_radius: relative radius across it R_y [m], positive.
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members.

    Valid for 0.01 <= R_y/R_x <= 100: pressure and semi-axes within 3 % of Hertz there, the approach within
    5 %, all exact for a circle. Source: Hamrock and Brewe (1983), eqs. 1-8.

    Example: a steel ball of 19 mm on a disc.

        >>> ball = {"load": 30.0, "radius": 9.5e-3, "modulus": 226.4e9}
        >>> round(float(hamrock_brewe_1983(transverse_radius=9.5e-3, **ball).pressure) / 1e6)
        938
    """
    slender = jnp.maximum(transverse_radius / radius, radius / transverse_radius)
    power = slender ** (2.0 / jnp.pi)
    lying = jnp.asarray(transverse_radius) >= radius
    ratio = jnp.where(lying, power, 1.0 / power)
    second_kind = 1.0 + (jnp.pi / 2.0 - 1.0) / slender
    first_kind = jnp.pi / 2.0 + (jnp.pi / 2.0 - 1.0) * jnp.log(slender)
    # Both are fitted for the shorter axis as unit; those of an ellipse that lies the other way follow.
    turned = jnp.where(lying, 1.0, power)
    return _ellipse(
        load, radius, transverse_radius, modulus, (ratio, first_kind / turned, second_kind * turned)
    )


def _ellipse(
    load: Each, radius: Each, transverse_radius: Each, modulus: Each, of: tuple[Array, Array, Array]
) -> Ellipse:
    """The contact from the ratio of its axes a/b and the complete integrals K and E, m = 1 - b^2/a^2."""
    ratio, first_kind, second_kind = of
    combined = 1.0 / (1.0 / radius + 1.0 / transverse_radius)
    carries = jnp.asarray(load) > 0.0
    pressed = jnp.where(carries, load, 1.0)
    across = jnp.cbrt(6.0 * ratio**2 * second_kind * pressed * combined / (jnp.pi * modulus))
    approach = 3.0 * first_kind * pressed / (jnp.pi * across * modulus)
    fields = (
        across / ratio,
        across,
        1.5 * pressed * ratio / (jnp.pi * across**2),
        approach,
        1.5 * pressed / approach,
    )
    return Ellipse(*(jnp.where(carries, field, 0.0) for field in fields))


def _ratio_of_axes(radii: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Semi-axis across over that along for a ratio R_y/R_x."""

    def missing(ratio: Float[Array, "*b"]) -> Float[Array, "*b"]:
        _, cosine, sine = complete_integrals(ratio**-2)
        return jnp.log(ratio**2 * cosine / (sine * radii))

    ratio_of_axes, _ = find_root(missing, radii ** (2.0 / jnp.pi), 2.0 * jnp.maximum(radii, 1.0))
    return ratio_of_axes


def largest_shear(contact: Ellipse, poisson: Each) -> tuple[Float[Array, "*b"], Float[Array, "*b"]]:
    """Largest shear stress below an elliptic contact [Pa] and its depth [m], on the normal in the middle.

    Args:
        contact: under its load.
        poisson: Poisson's ratio of the solid in which it is asked for.

    Half the difference of the principal stresses. Source: Johnson, Contact Mechanics (1985), eq. 3.69
    and table 4.1.

    Example: a ball.

        >>> from pitchpoint.contact.ellipse import hertz_1881
        >>> ball = hertz_1881(load=30.0, radius=9.5e-3, transverse_radius=9.5e-3, modulus=226.4e9)
        >>> stress, depth = largest_shear(ball, 0.3)
        >>> round(float(stress / ball.pressure), 3), round(float(depth / ball.across), 2)
        (0.31, 0.48)
    """
    carries = contact.across > 0.0
    short = jnp.where(carries, jnp.minimum(contact.along, contact.across), 1.0)
    squeeze = short / jnp.where(carries, jnp.maximum(contact.along, contact.across), 1.0)

    def slope(depth: Float[Array, "*b"]) -> Float[Array, "*b"]:
        derivative: Float[Array, "*b"] = jax.jvp(
            lambda at: _shear_below(at, squeeze, poisson), (depth,), (jnp.ones_like(depth),)
        )[1]
        return -derivative

    depth, _ = find_root(slope, jnp.full_like(short, 0.6), _DEEPEST)
    stress = contact.pressure * _shear_below(depth, squeeze, poisson)
    return stress, jnp.where(carries, depth * short, 0.0)


def _shear_below(depth: Array, squeeze: Array, poisson: Each) -> Array:
    """Largest shear over the largest pressure; depth in the shorter semi-axis, which is b below."""
    normal, _, short = _principal_stresses(depth * squeeze, squeeze, poisson)
    return (short - normal) / 2.0


def _principal_stresses(depth: Array, squeeze: Array, poisson: Each) -> tuple[Array, Array, Array]:
    """Stresses over the largest pressure: along the normal, the longer and the shorter axis.

    Johnson's terms divided by e^2, whose poles for a circle are taken out.

    Args:
        depth: z/a.
        squeeze: b/a, at most one.
        poisson: Poisson's ratio.
    """
    stretched, out = 1.0 / squeeze**2, 1.0 / (1.0 + depth**2)
    towards = jnp.sqrt((squeeze**2 + depth**2) * out)
    part = out / (1.0 + towards)
    sine_part, cosine_part = _incomplete(depth, squeeze)
    sine_term, cosine_term = depth * sine_part, depth * stretched * cosine_part
    long = -part / 2.0 + sine_term + poisson * (stretched * (part - 1.0) + cosine_term)
    ending = (part + 2.0 * stretched * depth**2 * out) / (2.0 * towards)
    short = -ending + cosine_term + poisson * (-part + sine_term)
    return -squeeze * out / towards, 2.0 * squeeze * long, 2.0 * squeeze * short


def _incomplete(depth: Array, squeeze: Array) -> tuple[Array, Array]:
    """Integrals of sin^2/D and cos^2/D from 0 to phi with cot(phi) = z/a, D^2 = 1 - (1 - b^2/a^2) sin^2."""
    sine = 1.0 / (1.0 + depth**2)
    cosine = depth**2 * sine
    square = cosine + squeeze**2 * sine
    unit, scale = jnp.ones_like(sine), sine * jnp.sqrt(sine) / 3.0
    of_sine = scale * carlson_rd(cosine, square, unit)
    of_cosine = squeeze**2 * scale * carlson_rd(cosine, unit, square)
    return of_sine, of_cosine + depth * sine / jnp.sqrt(square)
