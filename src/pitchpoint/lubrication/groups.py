"""Groups without units by which regressions of films and of what goes with them are written."""

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike, NDArray

from pitchpoint.core.factored import Numbers

__all__ = ["line_groups", "load_parameter"]

Each = Float[Numbers, "*#b"]


def line_groups(
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> tuple[Each, Each, Each]:
    """Load, speed and material parameters of a line contact, W = w/(E' R), U = eta0 u/(E' R), G = alpha E'.

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed u [m/s].
        viscosity: eta0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    Source: Dowson and Higginson (1959).
    """
    return (
        line_load / (modulus * radius),
        viscosity * entrainment / (modulus * radius),
        pressure_viscosity * modulus,
    )


def load_parameter(
    line_load: ArrayLike,
    entrainment: ArrayLike,
    viscosity: ArrayLike,
    radius: ArrayLike,
    modulus: ArrayLike,
) -> NDArray[np.float64]:
    """Load parameter of lines, M = w/(E' R) (2 eta0 u/(E' R))^(-1/2), shape (b,): large where films are thin.

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed u, either way [m/s].
        viscosity: eta0 [Pa s].
        radius: R [m].
        modulus: E' [Pa].

    Source: Moes (1992).

    Example:
        >>> float(load_parameter(1e5, 1.0, 0.1, 0.01, 2e11).round(6))
        5.0
    """
    load, speed, oil, radii, moduli = map(
        np.asarray, (line_load, entrainment, viscosity, radius, modulus)
    )
    stiff = moduli * radii
    speeds = 2.0 * (oil * np.abs(speed) / stiff)
    return np.asarray(load / stiff / np.sqrt(np.maximum(speeds, 1e-30)))
