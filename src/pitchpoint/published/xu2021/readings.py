"""What the formulas of the paper give for a case, under the names of result variables."""

import numpy as np

from pitchpoint.efficiency.quasi_static import Design
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.flexspline_tooth import InvoluteFlank
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.published.publication import Read, ReadingPoint
from pitchpoint.published.xu2021.printed import (
    ZONE_END,
    effective_modulus,
    loaded_count,
    oil_of,
    printed_count,
    printed_viscosity,
    viscosity,
    zone_tooth_forces,
)
from pitchpoint.published.xu2021.zone import MeshingZone, zone_of

__all__ = ["readings"]

_PLACES = 226
"""Angles of the zone at which eqs. 1 to 3 are read."""

_FLAT = 20.0
"""Relative radius beyond which a curve leaves it out: it passes through infinity [m]."""


def readings(point: ReadingPoint) -> Read:
    """What the formulas give for a case; those with base circles are left out for teeth that have none."""
    gears, design, operation = point.gears, point.design, point.operation
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(design.mesh, StrainWave)
    oil, temperature = oil_of(design.lubricant), float(operation.temperature)
    return {
        "tooth_ratio": gears.teeth[0] / (gears.teeth[1] - gears.teeth[0]),
        "viscosity": float(viscosity(temperature=temperature, **oil)),
        "printed_viscosity": float(printed_viscosity(temperature=temperature, **oil)),
        "effective_modulus": modulus_of(design),
        "composite_roughness": float(design.roughness.composite_rq),
        **(_of_zone(point) if isinstance(design.mesh.flank, InvoluteFlank) else {}),
    }


def modulus_of(design: Design) -> float:
    """Equivalent modulus of eq. 11 [Pa]."""
    young, poisson = (
        tuple(float(getattr(solid, name)) for solid in design.solids)
        for name in ("young", "poisson")
    )
    return effective_modulus(young=(young[0], young[1]), poisson=(poisson[0], poisson[1]))


def _of_zone(point: ReadingPoint) -> Read:
    zone = zone_of(point)
    return {
        "base_radius_flexspline": zone.base_radius[0],
        "base_radius_circular_spline": zone.base_radius[1],
        **_loads(zone),
        **_courses(zone),
    }


def _loads(zone: MeshingZone) -> Read:
    """Eqs. 4 to 6, and Figure 6: teeth from that on the long axis on, as printed and closed."""
    teeth = zone.teeth[1]
    too_many, loaded = printed_count(teeth=teeth), loaded_count(teeth=teeth)
    printed = zone_tooth_forces(largest=zone.printed_load, teeth=teeth, count=too_many)
    closed = zone_tooth_forces(largest=zone.closed_load, teeth=teeth, count=loaded)
    return {
        "printed_largest_tooth_force": zone.printed_load,
        "printed_least_tooth_force": float(printed.min()),
        "one_zone_tooth_force": zone.one_zone_load,
        "largest_tooth_force": zone.closed_load,
        "recovered_torque": 2.0 * zone.base_radius[1] * float(closed.sum()),
        "counted_angle": 2.0 * np.pi / teeth * np.arange(too_many + 1),
        "tooth_printed_load": printed[too_many:],
        "tooth_closed_load": np.pad(
            closed[loaded:], (0, too_many - loaded), constant_values=np.nan
        ),
    }


def _courses(zone: MeshingZone) -> Read:
    """Figure 5, and what is read off it."""
    angle = np.linspace(0.0, ZONE_END, _PLACES)
    on_flexspline, on_circular = zone.curvature_radii(angle)
    radius = zone.radius(angle)
    opposed, added = zone.speed(angle, -1), zone.speed(angle, 1)
    return {
        "zone_angle": angle,
        "zone_radius": np.where(np.abs(radius) < _FLAT, radius, np.nan),
        "zone_added_speed": added,
        "zone_opposed_speed": opposed,
        "printed_radius_root": float(radius[0]),
        "printed_radius_10": float(np.interp(np.deg2rad(10.0), angle, radius)),
        "printed_radius_end": float(radius[-1]),
        "conformal_angle": _crossing(angle, on_flexspline - on_circular),
        "least_opposed_speed": float(np.abs(opposed).min()),
        "largest_opposed_speed": float(opposed.max()),
        "least_added_speed": float(added.min()),
        "largest_added_speed": float(added.max()),
    }


def _crossing(angle: np.ndarray, values: np.ndarray) -> float:
    """First angle at which values reach zero from below; NaN where they do not."""
    (rises,) = np.nonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    if not rises.size:
        return float("nan")
    low, high = rises[0], rises[0] + 1
    return float(np.interp(0.0, values[[low, high]], angle[[low, high]]))
