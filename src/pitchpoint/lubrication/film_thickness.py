"""Film thickness of EHL contacts by published regressions."""

from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.lubrication.groups import line_groups

__all__ = [
    "dowson_1968",
    "dowson_higginson_1959",
    "dowson_toyoda_1979",
    "hamrock_dowson_1977",
    "hamrock_dowson_1977_central",
    "moes_1992",
    "pan_hamrock_1989",
    "pan_hamrock_1989_central",
]

Each = Float[Numbers, "*#b"]

_LEAST = 1e-30  # below any group of a contact, with logarithms and powers that are finite


def dowson_higginson_1959(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Minimum film of a line contact [m]: h/R = 1.6 G^0.6 U^0.7 W^-0.13.

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed u [m/s].
        viscosity: eta0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Dowson and Higginson (1959).

    Example:
        >>> film = dowson_higginson_1959(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        0.986
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    return radius * _product(1.6, groups, (-0.13, 0.7, 0.6))


def dowson_1968(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Minimum film of a line contact [m]: h/R = 2.65 G^0.54 U^0.7 W^-0.13.

    Arguments are those of `dowson_higginson_1959`.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Dowson (1968).

    Example:
        >>> film = dowson_1968(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        0.986
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    return radius * _product(2.65, groups, (-0.13, 0.7, 0.54))


def dowson_toyoda_1979(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Central film of a line contact [m]: h/R = 3.06 G^0.56 U^0.69 W^-0.10.

    Arguments are those of `dowson_higginson_1959`.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Dowson and Toyoda (1979).

    Example:
        >>> film = dowson_toyoda_1979(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        1.254
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    return radius * _product(3.06, groups, (-0.1, 0.69, 0.56))


def pan_hamrock_1989(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Minimum film of a line contact [m]: h/R = 1.714 G^0.568 U^0.694 W^-0.128.

    Arguments are those of `dowson_higginson_1959`.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Pan and Hamrock (1989), in Hamrock's
    Fundamentals of fluid film lubrication equation 18.72.

    Example:
        >>> film = pan_hamrock_1989(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        0.908
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    return radius * _product(1.714, groups, (-0.128, 0.694, 0.568))


def pan_hamrock_1989_central(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Central film of a line contact [m]: h/R = 2.922 G^0.470 U^0.692 W^-0.166.

    Arguments are those of `dowson_higginson_1959`.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Pan and Hamrock (1989), in Hamrock's
    Fundamentals of fluid film lubrication equation 18.74.

    Example:
        >>> film = pan_hamrock_1989_central(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        1.039
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    return radius * _product(2.922, groups, (-0.166, 0.692, 0.47))


def moes_1992(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Central film of a line contact [m] in every regime, rigid to elastic and isoviscous to piezoviscous.

    Arguments are those of `dowson_higginson_1959`.

    With us = 2 u, U2 = eta0 us/(E' R), M = w/(E' R) U2^-1/2 and L = alpha E' U2^1/4, the film h/R U2^-1/2
    blends four limits: rigid-isoviscous 3/M, elastic-isoviscous 2.621 M^-1/5, rigid-piezoviscous
    1.287 L^2/3 and elastic-piezoviscous 1.311 M^-1/8 L^3/4. The oil is incompressible and follows Barus.
    Source: Moes (1992).

    Example:
        >>> film = moes_1992(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        1.253
    """
    groups = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    film = (groups[0] > 0.0) & (groups[1] > 0.0)
    load, speed, material = (
        jnp.log(jnp.where(film & (group > 0.0), group, _LEAST)) for group in groups
    )
    pace = speed + jnp.log(2.0)
    heavy, stiffening = load - 0.5 * pace, material + 0.25 * pace
    relative_film = jnp.exp(_moes_line(heavy, stiffening) + 0.5 * pace)
    return jnp.where(film, radius * relative_film, 0.0)


def hamrock_dowson_1977(
    *,
    load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    transverse_radius: Each,
    modulus: Each,
) -> Each:
    """Minimum film of an elliptic contact [m]: h/R = 3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k)).

    Args:
        load: normal load F [N].
        entrainment: mean surface speed u along R_x [m/s].
        viscosity: eta0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R_x [m].
        transverse_radius: R_y [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    W = F/(E' R_x^2), fitted for k from 1 (a ball) to 8. Source: Hamrock and Dowson (1977), but for k, the
    (R_y/R_x)^(2/pi) of Hamrock and Brewe (1983): their own 1.03 (R_y/R_x)^0.64 gives a ball 2 % more film.

    Example:
        >>> film = hamrock_dowson_1977(
        ...     load=30.0, entrainment=1.0, viscosity=0.05, pressure_viscosity=2e-8, radius=9.5e-3,
        ...     transverse_radius=9.5e-3, modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        0.165
    """
    groups = _ellipse_groups(load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    side = 1.0 - jnp.exp(-0.68 * _slender(radius, transverse_radius))
    return radius * _product(3.63, groups, (-0.073, 0.68, 0.49)) * side


def hamrock_dowson_1977_central(
    *,
    load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    transverse_radius: Each,
    modulus: Each,
) -> Each:
    """Central film of an elliptic contact [m]: h/R = 2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 exp(-0.73 k)).

    Arguments are those of `hamrock_dowson_1977`.

    W = F/(E' R_x^2), fitted for k from 1 (a ball) to 8, see `hamrock_dowson_1977`. Source: Hamrock and Dowson
    (1977); with their own k the film of a ball is 1 % thicker.

    Example:
        >>> film = hamrock_dowson_1977_central(
        ...     load=30.0, entrainment=1.0, viscosity=0.05, pressure_viscosity=2e-8, radius=9.5e-3,
        ...     transverse_radius=9.5e-3, modulus=226.4e9,
        ... )
        >>> round(float(film) * 1e6, 3)
        0.289
    """
    groups = _ellipse_groups(load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    side = 1.0 - 0.61 * jnp.exp(-0.73 * _slender(radius, transverse_radius))
    return radius * _product(2.69, groups, (-0.067, 0.67, 0.53)) * side


def _moes_line(heavy: Each, stiffening: Each) -> Each:
    """Logarithm of h/R U2^-1/2 of a line contact from those of M and L."""
    rigid, elastic = jnp.log(3.0) - heavy, jnp.log(2.621) - heavy / 5.0
    rigid_piezo = jnp.log(1.287) + 2.0 / 3.0 * stiffening
    elastic_piezo = jnp.log(1.311) - heavy / 8.0 + 0.75 * stiffening
    blend = (7.0 + 8.0 * jnp.exp(-2.0 * jnp.exp(elastic - rigid))) / 5.0
    isoviscous = 3.0 / 7.0 * jnp.logaddexp(7.0 / 3.0 * rigid, 7.0 / 3.0 * elastic)
    piezoviscous = -2.0 / 7.0 * jnp.logaddexp(-3.5 * rigid_piezo, -3.5 * elastic_piezo)
    return jnp.logaddexp(blend * isoviscous, blend * piezoviscous) / blend


def _slender(radius: Each, transverse_radius: Each) -> Each:
    """Semi-axis across over that along, as Hamrock and Dowson take it."""
    return (transverse_radius / radius) ** (2.0 / jnp.pi)


def _ellipse_groups(
    load: Each, entrainment: Each, viscosity: Each, alpha: Each, radius: Each, modulus: Each
) -> tuple[Each, Each, Each]:
    """Load, speed and material parameters W, U, G of an ellipse."""
    return (
        load / (modulus * radius**2),
        viscosity * entrainment / (modulus * radius),
        alpha * modulus,
    )


def _product(
    factor: float, groups: tuple[Each, Each, Each], exponents: tuple[float, float, float]
) -> Each:
    """Factor * W^a U^b G^c; zero without load, where the regressions say nothing, and at standstill."""
    load, speed, material = groups
    film = (load > 0.0) & (speed > 0.0)
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    logs = [jnp.log(jnp.where(film, group, 1.0)) for group in (load, speed, material)]
    total = sum(power * log for power, log in zip(exponents, logs, strict=True))
    return jnp.where(film, factor * jnp.exp(total), 0.0)
