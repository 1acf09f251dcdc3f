"""Film thickness of EHL contacts by published regressions.

Laws of one shape of contact ask for the same conditions. What stands here of each is its formula in groups
without units; the decorator makes a law of it.
"""

import inspect
from collections.abc import Callable

from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Numbers
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

FilmLaw = Callable[..., Each]
LineFormula = Callable[[Each, Each, Each], Each]
EllipseFormula = Callable[[Each, Each, Each, Each], tuple[Each, Each]]

_LINE_ARGUMENTS = """\
Args:
    line_load: w [N/m].
    entrainment: mean surface speed u [m/s].
    viscosity: eta0 [Pa s].
    pressure_viscosity: alpha [1/Pa].
    radius: R [m].
    modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E."""

_LINE_EXAMPLE = (
    "line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,"
)

_ELLIPSE_ARGUMENTS = """\
Args:
    load: normal load F [N].
    entrainment: mean surface speed u along R_x [m/s].
    viscosity: eta0 [Pa s].
    pressure_viscosity: alpha [1/Pa].
    radius: R_x [m].
    transverse_radius: R_y [m].
    modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E."""

_ELLIPSE_EXAMPLE = (
    "load=30.0, entrainment=1.0, viscosity=0.05, pressure_viscosity=2e-8, radius=9.5e-3,\n"
    "    ...     transverse_radius=9.5e-3,"
)


def _of_lines(micrometres: float) -> Callable[[LineFormula], FilmLaw]:
    """Law of line contacts by h/R of the groups W, U, G; the number is the film of the example."""

    def law_of(formula: LineFormula) -> FilmLaw:
        def law(
            *,
            line_load: Each,
            entrainment: Each,
            viscosity: Each,
            pressure_viscosity: Each,
            radius: Each,
            modulus: Each,
        ) -> Each:
            return radius * formula(
                *line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
            )

        return _described(law, formula, _LINE_ARGUMENTS, _LINE_EXAMPLE, micrometres)

    return law_of


def _of_ellipses(
    micrometres: float,
) -> Callable[[EllipseFormula], FilmLaw]:
    """Law of elliptic contacts by two factors of h/R_x, of W, U, G and k; the number is as above."""

    def law_of(formula: EllipseFormula) -> FilmLaw:
        def law(
            *,
            load: Each,
            entrainment: Each,
            viscosity: Each,
            pressure_viscosity: Each,
            radius: Each,
            transverse_radius: Each,
            modulus: Each,
        ) -> Each:
            relative_film, side = formula(
                load / (modulus * radius**2),
                viscosity * entrainment / (modulus * radius),
                pressure_viscosity * modulus,
                (transverse_radius / radius) ** (2.0 / jnp.pi),
            )
            return radius * relative_film * side

        return _described(law, formula, _ELLIPSE_ARGUMENTS, _ELLIPSE_EXAMPLE, micrometres)

    return law_of


def _described(
    law: FilmLaw, formula: Callable[..., object], arguments: str, example: str, micrometres: float
) -> FilmLaw:
    """The law under the name of its formula, with the arguments and the example of all of its shape."""
    law.__name__ = law.__qualname__ = formula.__name__
    summary, _, source = inspect.cleandoc(formula.__doc__ or "").partition("\n\n")
    law.__doc__ = f"""{summary}

{arguments}

{source}

Example:
    >>> film = {law.__name__}(
    ...     {example}
    ...     modulus=226.4e9,
    ... )
    >>> round(float(film) * 1e6, 3)
    {micrometres}
"""
    return law


@_of_lines(0.986)
def dowson_higginson_1959(load: Each, speed: Each, material: Each) -> Each:
    """Minimum film of a line contact [m]: h/R = 1.6 G^0.6 U^0.7 W^-0.13.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Dowson and Higginson (1959).
    """
    return _product(1.6, (load, speed, material), (-0.13, 0.7, 0.6))


@_of_lines(0.986)
def dowson_1968(load: Each, speed: Each, material: Each) -> Each:
    """Minimum film of a line contact [m]: h/R = 2.65 G^0.54 U^0.7 W^-0.13.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Dowson (1968).
    """
    return _product(2.65, (load, speed, material), (-0.13, 0.7, 0.54))


@_of_lines(1.254)
def dowson_toyoda_1979(load: Each, speed: Each, material: Each) -> Each:
    """Central film of a line contact [m]: h/R = 3.06 G^0.56 U^0.69 W^-0.10.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Dowson and Toyoda (1979).
    """
    return _product(3.06, (load, speed, material), (-0.1, 0.69, 0.56))


@_of_lines(0.908)
def pan_hamrock_1989(load: Each, speed: Each, material: Each) -> Each:
    """Minimum film of a line contact [m]: h/R = 1.714 G^0.568 U^0.694 W^-0.128.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Pan and Hamrock (1989), in Hamrock's
    Fundamentals of fluid film lubrication equation 18.72.
    """
    return _product(1.714, (load, speed, material), (-0.128, 0.694, 0.568))


@_of_lines(1.039)
def pan_hamrock_1989_central(load: Each, speed: Each, material: Each) -> Each:
    """Central film of a line contact [m]: h/R = 2.922 G^0.470 U^0.692 W^-0.166.

    W = w/(E' R), U = eta0 u/(E' R), G = alpha E'. Source: Pan and Hamrock (1989), in Hamrock's
    Fundamentals of fluid film lubrication equation 18.74.
    """
    return _product(2.922, (load, speed, material), (-0.166, 0.692, 0.47))


@_of_lines(1.253)
def moes_1992(load: Each, speed: Each, material: Each) -> Each:
    """Central film of a line contact [m] in every regime, rigid to elastic and isoviscous to piezoviscous.

    With us = 2 u, U2 = eta0 us/(E' R), M = w/(E' R) U2^-1/2 and L = alpha E' U2^1/4, the film h/R U2^-1/2
    blends four limits: rigid-isoviscous 3/M, elastic-isoviscous 2.621 M^-1/5, rigid-piezoviscous
    1.287 L^2/3 and elastic-piezoviscous 1.311 M^-1/8 L^3/4. The oil is incompressible and follows Barus.
    Source: Moes (1992).
    """
    film = (load > 0.0) & (speed > 0.0)
    log_load, log_speed, log_material = (
        jnp.log(jnp.where(film & (group > 0.0), group, _LEAST)) for group in (load, speed, material)
    )
    pace = log_speed + jnp.log(2.0)
    heavy, stiffening = log_load - 0.5 * pace, log_material + 0.25 * pace
    return jnp.where(film, jnp.exp(_moes_line(heavy, stiffening) + 0.5 * pace), 0.0)


@_of_ellipses(0.165)
def hamrock_dowson_1977(
    load: Each, speed: Each, material: Each, slenderness: Each
) -> tuple[Each, Each]:
    """Minimum film of an elliptic contact [m]: h/R = 3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k)).

    W = F/(E' R_x^2), k = (R_y/R_x)^(2/pi), fitted from 1 (a ball) to 8. Source: Hamrock and Dowson (1977).
    """
    side = 1.0 - jnp.exp(-0.68 * slenderness)
    return _product(3.63, (load, speed, material), (-0.073, 0.68, 0.49)), side


@_of_ellipses(0.289)
def hamrock_dowson_1977_central(
    load: Each, speed: Each, material: Each, slenderness: Each
) -> tuple[Each, Each]:
    """Central film of an elliptic contact [m]: h/R = 2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 exp(-0.73 k)).

    W = F/(E' R_x^2), k = (R_y/R_x)^(2/pi), fitted from 1 (a ball) to 8. Source: Hamrock and Dowson (1977).
    """
    side = 1.0 - 0.61 * jnp.exp(-0.73 * slenderness)
    return _product(2.69, (load, speed, material), (-0.067, 0.67, 0.53)), side


def _moes_line(heavy: Each, stiffening: Each) -> Each:
    """Logarithm of h/R U2^-1/2 of a line contact from those of M and L."""
    rigid, elastic = jnp.log(3.0) - heavy, jnp.log(2.621) - heavy / 5.0
    rigid_piezo = jnp.log(1.287) + 2.0 / 3.0 * stiffening
    elastic_piezo = jnp.log(1.311) - heavy / 8.0 + 0.75 * stiffening
    blend = (7.0 + 8.0 * jnp.exp(-2.0 * jnp.exp(elastic - rigid))) / 5.0
    isoviscous = 3.0 / 7.0 * jnp.logaddexp(7.0 / 3.0 * rigid, 7.0 / 3.0 * elastic)
    piezoviscous = -2.0 / 7.0 * jnp.logaddexp(-3.5 * rigid_piezo, -3.5 * elastic_piezo)
    return jnp.logaddexp(blend * isoviscous, blend * piezoviscous) / blend


def _product(
    factor: float, groups: tuple[Each, Each, Each], exponents: tuple[float, float, float]
) -> Each:
    """Factor * W^a U^b G^c; zero without load, where the regressions say nothing, and at standstill."""
    film = (groups[0] > 0.0) & (groups[1] > 0.0)
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    logs = [jnp.log(jnp.where(film, group, 1.0)) for group in groups]
    total = sum(power * log for power, log in zip(exponents, logs, strict=True))
    return jnp.where(film, factor * jnp.exp(total), 0.0)
