"""Formulas as Xu et al. (2021) print them, beside what their derivation asks for."""

from functools import partial
from math import log, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pitchpoint.efficiency.quasi_static import Design, Operation
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.flexspline_tooth import InvoluteFlank
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.published.publication import Point

__all__ = [
    "assumed_radius",
    "curvature_radii",
    "density",
    "effective_modulus",
    "largest_force",
    "loaded_count",
    "mesh_point_speed",
    "printed_count",
    "printed_density",
    "printed_viscosity",
    "readings",
    "relative_radius",
    "roelands_exponents",
    "tooth_forces",
    "viscosity",
]

Array = NDArray[np.float64]

ZONE_END = pi / 8.0
"""Angle at which the cosine of eq. 5 reaches zero [rad]."""

MAP_SPAN = 0.9
"""Distance of the mesh point from the pitch circle at both ends of the zone, below it on the long
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


def tooth_forces(*, largest: float, teeth: float, count: int) -> Array:
    """Forces of all teeth of one zone by eq. 5, shape (tooth) [N].

    Args:
        largest: F0 [N].
        teeth, count: z and N.
    """
    return largest * _cosines(teeth, count)


def _cosines(teeth: float, count: int) -> Array:
    return np.asarray(np.cos(np.arange(-count, count + 1) * 8.0 * pi / teeth))


def assumed_radius(*, angle: ArrayLike, pitch_radius: float, module: float) -> Array:
    """Distance R1 of the mesh point from the axis of the flexspline, a linear map [m].

    From 0.9 modules below the pitch circle on the long axis to 0.9 above at the end of the zone.
    The paper gives no map: this one is assumed.

    Args:
        angle: from the long axis, shape (...) [rad].
        pitch_radius: of the flexspline [m].
        module: [m].
    """
    place = 2.0 * np.asarray(angle) / ZONE_END - 1.0
    return np.asarray(pitch_radius + MAP_SPAN * module * place)


def curvature_radii(
    *, distance: ArrayLike, radial: ArrayLike, base_radius: tuple[float, float]
) -> tuple[Array, Array]:
    """Radii of curvature at the mesh point on flexspline and circular spline, eq. 1 [m].

    Args:
        distance: R1, shape (...) [m].
        radial: deformation w that makes the polar radius rho_k = R1 + w, shape (...) [m].
        base_radius: r_b1, r_b2 [m].
    """
    first, second = base_radius
    polar = np.asarray(distance) + np.asarray(radial)
    radii = np.square(distance) - first**2, polar**2 - second**2
    return np.asarray(np.sqrt(radii[0])), np.asarray(np.sqrt(radii[1]))


def relative_radius(*, first: ArrayLike, second: ArrayLike) -> Array:
    """Relative radius of curvature, eq. 2 [m].

    Args:
        first, second: radii of curvature of flexspline and circular spline, shape (...) [m]. The
            result is infinite where they agree and negative where the flexspline's is the larger.
    """
    one, two = np.asarray(first), np.asarray(second)
    return np.asarray(one * two / (two - one))


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


OIL = {"viscosity_0": 0.04, "alpha": 2.2e-8, "beta": 0.0476, "temperature_0": 313.0}
"""Table 2, without the density."""


def readings(point: Point) -> dict[str, float]:
    """What the formulas give for a case, under the names of result variables.

    Those with base circles are left out for teeth that have none.
    """
    gears, design, operation = point.gears, point.design, point.operation
    mesh = design.mesh
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(mesh, StrainWave)
    return {
        "tooth_ratio": gears.teeth[0] / (gears.teeth[1] - gears.teeth[0]),
        **_of_base_circles(gears, mesh, operation),
        **_of_oil(float(operation.temperature)),
        "effective_modulus": effective_modulus(
            young=_both(design, "young"), poisson=_both(design, "poisson")
        ),
        "composite_roughness": float(design.roughness.composite_rq),
    }


def _both(design: Design, name: str) -> tuple[float, float]:
    first, second = design.solids
    return float(getattr(first, name)), float(getattr(second, name))


def _of_oil(temperature: float) -> dict[str, float]:
    return {
        "viscosity": float(viscosity(temperature=temperature, **OIL)),
        "printed_viscosity": float(printed_viscosity(temperature=temperature, **OIL)),
    }


def _of_base_circles(
    gears: StrainWaveGears, mesh: StrainWave, operation: Operation
) -> dict[str, float]:
    if not isinstance(mesh.flank, InvoluteFlank):
        return {}
    radii = _base_radii(mesh.flank, gears.teeth)
    deflection = float(mesh.line.deflection)
    return {
        "base_radius_flexspline": radii[0],
        "base_radius_circular_spline": radii[1],
        **_loads(gears, radii, float(operation.load)),
        **_curvatures(gears, radii, deflection),
        **_speeds(gears, radii, deflection, float(operation.speed)),
    }


def _base_radii(flank: InvoluteFlank, teeth: tuple[float, float]) -> tuple[float, float]:
    first = float(flank.base_radius)
    return first, first * teeth[1] / teeth[0]


def _loads(gears: StrainWaveGears, radii: tuple[float, float], torque: float) -> dict[str, float]:
    teeth = gears.teeth[1]
    force = partial(largest_force, torque=torque, base_radius=radii[1], teeth=teeth)
    too_many, loaded = printed_count(teeth=teeth), loaded_count(teeth=teeth)
    printed = force(count=too_many)
    largest = force(count=loaded, zones=2)
    forces = tooth_forces(largest=largest, teeth=teeth, count=loaded)
    return {
        "printed_largest_tooth_force": printed,
        "printed_least_tooth_force": float(
            tooth_forces(largest=printed, teeth=teeth, count=too_many).min()
        ),
        "one_zone_tooth_force": force(count=loaded),
        "largest_tooth_force": largest,
        "recovered_torque": 2.0 * radii[1] * float(forces.sum()),
    }


def _distances(gears: StrainWaveGears) -> tuple[Array, Array]:
    angle = np.linspace(0.0, ZONE_END, 226)
    pitch = gears.module * gears.teeth[0] / 2.0
    return angle, assumed_radius(angle=angle, pitch_radius=pitch, module=gears.module)


def _curvatures(
    gears: StrainWaveGears, radii: tuple[float, float], deflection: float
) -> dict[str, float]:
    angle, distance = _distances(gears)
    first, second = curvature_radii(
        distance=distance,
        radial=deflection * np.cos(2.0 * angle),
        base_radius=radii,
    )
    radius = relative_radius(first=first, second=second)
    return {
        "printed_radius_root": float(radius[0]),
        "printed_radius_10": float(np.interp(np.deg2rad(10.0), angle, radius)),
        "printed_radius_end": float(radius[-1]),
        "conformal_angle": float(np.interp(0.0, first - second, angle)),
    }


def _speeds(
    gears: StrainWaveGears, radii: tuple[float, float], deflection: float, wave_speed: float
) -> dict[str, float]:
    angle, distance = _distances(gears)
    opposed, added = (
        mesh_point_speed(
            angle=angle,
            distance=distance,
            base_radius=radii[0],
            deflection=deflection,
            teeth=gears.teeth,
            wave_speed=wave_speed,
            sense=sense,
        )
        for sense in (-1, 1)
    )
    return {
        "least_opposed_speed": float(np.abs(opposed).min()),
        "largest_opposed_speed": float(opposed.max()),
        "least_added_speed": float(added.min()),
        "largest_added_speed": float(added.max()),
    }
