"""How far the kinematics of the envelope are from eqs. 1 to 3, and what films they would make."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from pitchpoint._jax import jnp
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.flexspline_tooth import InvoluteFlank
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.lubrication.film_thickness import moes_1992
from pitchpoint.published.conjugate import readings as of_envelope
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.xu2021.printed import ZONE_END, oil_of, pressure_viscosity, viscosity
from pitchpoint.published.xu2021.readings import modulus_of
from pitchpoint.published.xu2021.zone import zone_of

__all__ = ["readings"]

_PARTS = 1e-6, 1e3
"""Parts of the operating speed between which that of a film as thick as the roughness is looked for."""


def readings(point: ReadingPoint) -> dict[str, float]:
    """Where flanks touch their envelope, and for involute teeth films there over what the paper says of them.

    Films are those of Moes' law under the load that closes the torque, fully flooded and isothermal: an upper
    bound. At such radii the contact is as wide as the flank, and no half space holds.
    """
    reading, mesh = of_envelope(point), point.design.mesh
    assert isinstance(mesh, StrainWave)
    if not isinstance(mesh.flank, InvoluteFlank):
        return reading
    zone, axis = zone_of(point), np.zeros(1)
    for end in ("root", "tip"):
        ratio = _ratio(point, reading[f"deep_radius_{end}"], reading[f"deep_entrainment_{end}"])
        reading[f"conjugate_film_ratio_{end}"] = ratio(1.0)
        reading[f"conjugate_speed_of_one_{end}"] = zone.wave_speed * _part_of_one(ratio)
    return reading | {
        "axis_speed": float(zone.speed(axis)[0]),
        "zone_end_speed": float(zone.speed(np.full(1, ZONE_END))[0]),
    }


def _ratio(point: ReadingPoint, radius: float, speed: float) -> Callable[[float], float]:
    """Film over roughness at parts of the operating speed."""
    gears, design, at = point.gears, point.design, float(point.operation.temperature)
    assert isinstance(gears, StrainWaveGears)
    oil, load = oil_of(design.lubricant), zone_of(point).closed_load
    rough = float(design.roughness.composite_rq)
    conditions = {
        "line_load": load / gears.face_width,
        "viscosity": viscosity(temperature=at, **oil),
        "pressure_viscosity": pressure_viscosity(temperature=at, **oil),
        "radius": radius,
        "modulus": modulus_of(design),
    }
    held = {name: jnp.asarray(value) for name, value in conditions.items()}

    def ratio(part: float) -> float:
        return float(moes_1992(entrainment=jnp.asarray(speed * part), **held)) / rough

    return ratio


def _part_of_one(ratio: Callable[[float], float]) -> float:
    """Part of the operating speed at which the film is as thick as the roughness; NaN where none is."""
    low, high = (float(np.log(limit)) for limit in _PARTS)

    def beyond(part: float) -> float:
        return float(np.log(ratio(float(np.exp(part)))))

    if not beyond(low) < 0.0 < beyond(high):
        return float("nan")
    return float(np.exp(brentq(beyond, low, high)))
