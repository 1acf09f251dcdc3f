"""Formulas as Xu et al. (2021) print them, beside what their derivation asks for."""

from collections.abc import Sequence
from math import log, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pitchpoint.materials.lubricants import Lubricant

__all__ = [
    "TEMPERATURE_0",
    "ZONE_END",
    "curvature_radii",
    "density",
    "effective_modulus",
    "largest_force",
    "loaded_count",
    "mapped_radius",
    "mesh_point_speed",
    "oil_of",
    "pressure_viscosity",
    "printed_count",
    "printed_density",
    "printed_viscosity",
    "relative_radius",
    "roelands_exponents",
    "viscosity",
    "zone_tooth_forces",
]

Array = NDArray[np.float64]

ZONE_END = pi / 8.0
"""Angle at which the cosine of eq. 5 reaches zero [rad]."""

MAP_SPAN = 0.9
"""Usual distance of the mesh point from the pitch circle at both ends of the zone, below it on the long
axis and above it at the end [modules]; assumed, the paper gives none."""


def printed_count(*, teeth: float) -> int:
    """Teeth on each side of the largest load that eq. 6 sums over as printed, N = [z/10]."""
    return int(teeth // 10)


def loaded_count(*, teeth: float) -> int:
    """Teeth on each side of the largest load for which the cosine of eq. 5 is positive."""
    return int(np.ceil(teeth / 16.0)) - 1


def largest_force(
    *, torque: float, base_radius: float, teeth: float, count: int, zones: int = 1
) -> float:
    """Largest tooth force F0 by eq. 6 [N].

    Args:
        torque: of the output [N m]; the paper calls it T_in.
        base_radius: of the circular spline r_b2 [m].
        teeth: of the circular spline z.
        count: N, teeth on each side of the largest load.
        zones: that carry; eq. 6 has one, a wave generator with two lobes makes two.
    """
    return torque / (base_radius * zones * float(np.sum(_cosines(teeth, count))))


def zone_tooth_forces(*, largest: float, teeth: float, count: int) -> Array:
    """Forces of all teeth of one zone by eq. 5, shape (tooth) [N].

    Args:
        largest: F0 [N].
        teeth, count: z and N.
    """
    return largest * _cosines(teeth, count)


def _cosines(teeth: float, count: int) -> Array:
    return np.asarray(np.cos(np.arange(-count, count + 1) * 8.0 * pi / teeth))


def mapped_radius(
    *,
    angle: ArrayLike,
    map_angle: Sequence[float],
    map_distance: Sequence[float],
    pitch_radius: float,
    module: float,
) -> Array:
    """Distance R1 of the mesh point from the axis of the flexspline, by a map of straight lines [m].

    The paper gives none. The usual one goes from 0.9 modules below the pitch circle on the long axis to 0.9
    above at the end of the zone.

    Args:
        angle: from the long axis, shape (...) [rad].
        map_angle: angles of the map, rising [rad].
        map_distance: R1 there less the pitch radius [modules].
        pitch_radius: of the flexspline [m].
        module: [m].
    """
    return np.asarray(pitch_radius + module * np.interp(np.asarray(angle), map_angle, map_distance))


def curvature_radii(
    *, distance: ArrayLike, radial: ArrayLike, base_radius: tuple[float, float]
) -> tuple[Array, Array]:
    """Radii of curvature at the mesh point on flexspline and circular spline, eq. 1 [m].

    Args:
        distance: R1, shape (...) [m].
        radial: deformation w that makes the polar radius rho_k = R1 + w, shape (...) [m].
        base_radius: r_b1, r_b2 [m].

    Returns:
        R_k1 and R_k2; NaN where the mesh point lies within a base circle.
    """
    flexspline_base, circular_base = base_radius
    polar = np.asarray(distance) + np.asarray(radial)
    radii = np.square(distance) - flexspline_base**2, polar**2 - circular_base**2
    with np.errstate(invalid="ignore"):
        return np.asarray(np.sqrt(radii[0])), np.asarray(np.sqrt(radii[1]))


def relative_radius(*, first: ArrayLike, second: ArrayLike) -> Array:
    """Relative radius of curvature, eq. 2 [m].

    Args:
        first, second: radii of curvature of flexspline and circular spline, shape (...) [m]. The
            result is infinite where they agree and negative where the flexspline's is the larger.
    """
    on_flexspline, on_circular = np.asarray(first), np.asarray(second)
    return np.asarray(on_flexspline * on_circular / (on_circular - on_flexspline))


def mesh_point_speed(
    *,
    angle: ArrayLike,
    distance: ArrayLike,
    base_radius: float,
    deflection: float,
    teeth: tuple[float, float],
    wave_speed: float,
    sense: int,
) -> Array:
    """Component of the velocity of eq. 3 along the flank, taken for entrainment in the paper [m/s].

    Args:
        angle: from the long axis, shape (...) [rad].
        distance: R1, shape (...) [m].
        base_radius: r_b1: the flank makes the angle acos(r_b1/R1) with the radius [m].
        deflection: w0 of w = w0 cos 2 angle [m].
        teeth: z1, z2, the circular spline at rest.
        wave_speed: of the wave generator [rad/s].
        sense: 1 if carried and elastic tangential velocity add, -1 if they are opposed.
    """
    (z1, z2), phase = teeth, 2.0 * np.asarray(angle)
    turned = wave_speed * (z2 - z1) / z1
    passing = wave_speed + turned
    radial = deflection * np.cos(phase)
    carried = turned * (np.asarray(distance) + radial)
    across = carried + sense * passing * radial
    cosine = base_radius / np.asarray(distance)
    along = 2.0 * deflection * np.sin(phase) * passing
    return np.asarray(along * cosine + across * np.sqrt(1.0 - cosine**2))


def effective_modulus(*, young: tuple[float, float], poisson: tuple[float, float]) -> float:
    """Equivalent modulus E of eq. 11, 2/E = sum (1 - nu^2)/E_i [Pa].

    Args:
        young: of flexspline and circular spline [Pa].
        poisson: of both.
    """
    pairs = zip(young, poisson, strict=True)
    return 2.0 / sum((1.0 - nu**2) / modulus for modulus, nu in pairs)


def roelands_exponents(
    *, viscosity_0: float, alpha: float, beta: float, temperature_0: float
) -> tuple[float, float]:
    """Exponents z of pressure and s of temperature in eq. 12.

    Args:
        viscosity_0: eta_0 at temperature_0 and no pressure [Pa s].
        alpha: pressure-viscosity coefficient [1/Pa].
        beta: fall of ln eta with temperature at temperature_0 [1/K].
        temperature_0: [K].
    """
    height = log(viscosity_0) + 9.67
    return alpha / (5.1e-9 * height), beta * (temperature_0 - 138.0) / height


def viscosity(
    *,
    temperature: ArrayLike,
    pressure: ArrayLike = 0.0,
    viscosity_0: float,
    alpha: float,
    beta: float,
    temperature_0: float,
) -> Array:
    """Viscosity by Roelands' law, eq. 12 with the -1 inside the bracket [Pa s].

    Args:
        temperature: T_1, shape (...) [K].
        pressure: shape (...) [Pa].
        viscosity_0, alpha, beta, temperature_0: as for the exponents.
    """
    height = log(viscosity_0) + 9.67
    rise = _roelands(temperature, pressure, viscosity_0, alpha, beta, temperature_0)
    return np.asarray(viscosity_0 * np.exp(height * (rise - 1.0)))


def pressure_viscosity(
    *, temperature: ArrayLike, viscosity_0: float, alpha: float, beta: float, temperature_0: float
) -> Array:
    """Pressure-viscosity coefficient of eq. 12 at a temperature and no pressure [1/Pa].

    Args:
        temperature: T_1, shape (...) [K].
        viscosity_0, alpha, beta, temperature_0: as for the exponents.
    """
    _, s = roelands_exponents(
        viscosity_0=viscosity_0, alpha=alpha, beta=beta, temperature_0=temperature_0
    )
    warmth = (np.asarray(temperature) - 138.0) / (temperature_0 - 138.0)
    return np.asarray(alpha * warmth**-s)


def printed_viscosity(
    *,
    temperature: ArrayLike,
    pressure: ArrayLike = 0.0,
    viscosity_0: float,
    alpha: float,
    beta: float,
    temperature_0: float,
) -> Array:
    """Viscosity by eq. 12 as printed, the -1 outside the bracket [Pa s].

    Args:
        temperature, pressure, viscosity_0, alpha, beta, temperature_0: as for `viscosity`.
    """
    height = log(viscosity_0) + 9.67
    rise = _roelands(temperature, pressure, viscosity_0, alpha, beta, temperature_0)
    return np.asarray(viscosity_0 * np.exp(height * rise - 1.0))


def _roelands(
    temperature: ArrayLike,
    pressure: ArrayLike,
    viscosity_0: float,
    alpha: float,
    beta: float,
    temperature_0: float,
) -> Array:
    z, s = roelands_exponents(
        viscosity_0=viscosity_0, alpha=alpha, beta=beta, temperature_0=temperature_0
    )
    warmth = (np.asarray(temperature) - 138.0) / (temperature_0 - 138.0)
    return np.asarray((1.0 + 5.1e-9 * np.asarray(pressure)) ** z * warmth**-s)


def density(
    *, temperature: ArrayLike, pressure: ArrayLike = 0.0, density_0: float, temperature_0: float
) -> Array:
    """Density by eq. 13 with the thermal term in the bracket, as its unit asks for [kg/m3].

    Args:
        temperature: shape (...) [K].
        pressure: shape (...) [Pa].
        density_0: at temperature_0 and no pressure [kg/m3].
        temperature_0: [K].
    """
    warmer = np.asarray(temperature) - temperature_0
    return np.asarray(density_0 * (1.0 + _compression(pressure) - 0.7e-3 * warmer))


def printed_density(
    *, temperature: ArrayLike, pressure: ArrayLike = 0.0, density_0: float, temperature_0: float
) -> Array:
    """Density by eq. 13 as printed: oil a degree warmer is 0.7 g/m3 lighter [kg/m3].

    Args:
        temperature, pressure, density_0, temperature_0: as for `density`.
    """
    warmer = np.asarray(temperature) - temperature_0
    return np.asarray(density_0 * (1.0 + _compression(pressure)) - 0.7e-3 * warmer)


def _compression(pressure: ArrayLike) -> Array:
    p = np.asarray(pressure)
    return np.asarray(0.6e-9 * p / (1.0 + 1.7e-9 * p))


BETA = 0.0476
"""Fall of ln eta with temperature at that of Table 2 [1/K]."""

TEMPERATURE_0 = 313.0
"""Ambient temperature of Table 2 [K]."""


def oil_of(lubricant: Lubricant) -> dict[str, float]:
    """Arguments of `viscosity` for an oil: eta_0 and alpha are its own at the temperature of Table 2.

    Args:
        lubricant: of the case.
    """
    return {
        "viscosity_0": float(lubricant.viscosity(TEMPERATURE_0)),
        "alpha": float(lubricant.pressure_viscosity(TEMPERATURE_0)),
        "beta": BETA,
        "temperature_0": TEMPERATURE_0,
    }
