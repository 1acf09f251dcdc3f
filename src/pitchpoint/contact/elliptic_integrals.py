"""Elliptic integrals in Carlson's symmetric form, for arrays and with derivatives."""

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Numbers

__all__ = ["carlson_rd", "carlson_rf", "complete_integrals"]

Each = Float[Numbers, "*#b"]

_DOUBLINGS = 9
"""Each takes the arguments four times nearer to each other; the series that follows ends in rounding."""


def carlson_rf(x: Each, y: Each, z: Each) -> Float[Array, "*b"]:
    """R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z)).

    Args:
        x, y, z: not negative, at most one of them zero.

    Source: Carlson (1995), eqs. 1.1 and 2.1 to 2.6.

    Example:
        >>> round(float(carlson_rf(0.0, 1.0, 1.0)), 12)  # pi/2
        1.570796326795
    """
    arguments, _ = _approached(x, y, z)
    mean = sum(arguments) / 3.0
    dx, dy = (1.0 - argument / mean for argument in arguments[:2])
    dz = -(dx + dy)
    second, third = dx * dy - dz**2, dx * dy * dz
    series = 1.0 - second / 10.0 + third / 14.0 + second**2 / 24.0 - 3.0 * second * third / 44.0
    return series / jnp.sqrt(mean)


def carlson_rd(x: Each, y: Each, z: Each) -> Float[Array, "*b"]:
    """R_D(x, y, z) = 3/2 int_0^inf dt / (sqrt((t + x)(t + y)) (t + z)^(3/2)).

    Args:
        x, y: not negative, at most one of them zero.
        z: positive.

    Source: Carlson (1995), eqs. 1.3 and 2.28 to 2.35.

    Example:
        >>> round(float(carlson_rd(0.0, 2.0, 1.0)), 12)
        1.797210352103
    """
    arguments, passed = _approached(x, y, z)
    mean = (arguments[0] + arguments[1] + 3.0 * arguments[2]) / 5.0
    dx, dy = (1.0 - argument / mean for argument in arguments[:2])
    dz = -(dx + dy) / 3.0
    both = dx * dy
    second = both - 6.0 * dz**2
    third = (3.0 * both - 8.0 * dz**2) * dz
    fourth = 3.0 * (both - dz**2) * dz**2
    fifth = both * dz**3
    series = (
        1.0
        - 3.0 * second / 14.0
        + third / 6.0
        + 9.0 * second**2 / 88.0
        - 3.0 * fourth / 22.0
        - 9.0 * second * third / 52.0
        + 3.0 * fifth / 26.0
    )
    return 4.0**-_DOUBLINGS * series / (mean * jnp.sqrt(mean)) + 3.0 * passed


def complete_integrals(
    complement: Each,
) -> tuple[Float[Array, "*b"], Float[Array, "*b"], Float[Array, "*b"]]:
    """Complete integrals K = int 1/D, of cos^2/D and of sin^2/D from 0 to pi/2, D^2 = 1 - m sin^2.

    Their second and third sum to K, and E = K - m times the third.

    Args:
        complement: 1 - m, positive; greater than one for a negative m.

    Source: Carlson (1995), eqs. 4.5 to 4.7; NIST Handbook of Mathematical Functions (2010), 19.25(i).
    """
    none, unit = jnp.zeros_like(complement), jnp.ones_like(complement)
    first_kind = carlson_rf(none, complement, unit)
    sine = carlson_rd(none, complement, unit) / 3.0
    return first_kind, complement * carlson_rd(none, unit, complement) / 3.0, sine


_Three = tuple[Array, Array, Array]


def _approached(x: Each, y: Each, z: Each) -> tuple[_Three, Array]:
    """Arguments after all doublings, and what the doublings leave behind in R_D over 3."""
    x, y, z = jnp.broadcast_arrays(*(jnp.asarray(argument, float) for argument in (x, y, z)))

    def double(
        carry: tuple[_Three, Array, Array], _: None
    ) -> tuple[tuple[_Three, Array, Array], None]:
        (a, b, c), passed, power = carry
        roots = [_root(argument) for argument in (a, b, c)]
        shift = roots[0] * roots[1] + roots[1] * roots[2] + roots[2] * roots[0]
        passed = passed + power / (roots[2] * (c + shift))
        return (
            ((a + shift) / 4.0, (b + shift) / 4.0, (c + shift) / 4.0),
            passed,
            power / 4.0,
        ), None

    start = (x, y, z), jnp.zeros_like(x), jnp.asarray(1.0)
    (arguments, passed, _), _ = jax.lax.scan(double, start, None, _DOUBLINGS)
    return arguments, passed


def _root(square: Array) -> Array:
    """Square root; its infinite slope at zero is left out, where a constant zero stands."""
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    return jnp.where(square > 0.0, jnp.sqrt(jnp.where(square > 0.0, square, 1.0)), 0.0)
