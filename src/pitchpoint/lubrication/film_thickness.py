"""Film thickness of EHL contacts by published regressions."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Shape
from pitchpoint.factored import Numbers
from pitchpoint.registry import Registry

__all__ = [
    "FILM_THICKNESS",
    "FilmThickness",
    "dowson_higginson_1959",
    "hamrock_dowson_1977",
    "hamrock_dowson_1977_central",
]

Each = Float[Numbers, "*#b"]


@dataclass(frozen=True, eq=False)
class FilmThickness:
    """A named film law; `function` gives metres, `place` says minimum or central film.

    It holds for contacts of one `shape`.
    """

    name: str
    title: str
    function: Callable[..., Array]
    sources: tuple[str, ...]
    place: str
    shape: Shape = "line"
    note: str = ""

    @property
    def rivals(self) -> "Iterable[FilmThickness]":
        """Film laws of the library."""
        return FILM_THICKNESS.values()


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
    groups = _line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    return radius * _product(1.6, groups, (-0.13, 0.7, 0.6))


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

    W = F/(E' R_x^2), k = (R_y/R_x)^(2/pi), fitted from 1 (a ball) to 8. Source: Hamrock and Dowson (1977).

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

    Args:
        load: normal load F [N].
        entrainment: mean surface speed u along R_x [m/s].
        viscosity: eta0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R_x [m].
        transverse_radius: R_y [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    W = F/(E' R_x^2), k = (R_y/R_x)^(2/pi), fitted from 1 (a ball) to 8. Source: Hamrock and Dowson (1977).

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


def _line_groups(
    line_load: Each, entrainment: Each, viscosity: Each, alpha: Each, radius: Each, modulus: Each
) -> tuple[Each, Each, Each]:
    """Load, speed and material parameters W, U, G."""
    return (
        line_load / (modulus * radius),
        viscosity * entrainment / (modulus * radius),
        alpha * modulus,
    )


def _product(
    factor: float, groups: tuple[Each, Each, Each], exponents: tuple[float, float, float]
) -> Each:
    """Factor * W^a U^b G^c; zero without load, where the regressions say nothing, and at standstill."""
    load, speed, material = groups
    film = (load > 0.0) & (speed > 0.0)
    logs = [jnp.log(jnp.where(film, group, 1.0)) for group in (load, speed, material)]
    total = sum(power * log for power, log in zip(exponents, logs, strict=True))
    return jnp.where(film, factor * jnp.exp(total), 0.0)


FILM_THICKNESS = Registry(
    "film thickness law",
    FilmThickness(
        "dowson_higginson_1959",
        "Dowson-Higginson, line",
        dowson_higginson_1959,
        ("dowson_higginson_1959",),
        "minimum",
    ),
    FilmThickness(
        "hamrock_dowson_1977",
        "Hamrock-Dowson, ellipse",
        hamrock_dowson_1977,
        ("hamrock_dowson_1977",),
        "minimum",
        "ellipse",
        "Fitted to contacts as wide across the rolling direction as along it, or wider, up to a ratio of 8.",
    ),
    FilmThickness(
        "hamrock_dowson_1977_central",
        "Hamrock-Dowson, ellipse, central film",
        hamrock_dowson_1977_central,
        ("hamrock_dowson_1977",),
        "central",
        "ellipse",
        "Fitted to contacts as wide across the rolling direction as along it, or wider, up to a ratio of 8.",
    ),
)
