"""Line contacts of one oil between steel bodies, and their film by Moes."""

import numpy as np

from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.materials.fluid import Fluid

MODULUS = 2.26e11
OIL = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8, "shear_law": "newtonian"}
SIMPLE = {"viscosity_law": "barus_1893", "density_law": "incompressible"}


def contact(pressure=1e9, speed=1.0, radius=0.01, *, slide=0.0, **others):
    """Steel on steel with the oil of the references, by Hertz's pressure and mean speed."""
    pressure, speed, radius = map(np.asarray, (pressure, speed, radius))
    line_load = 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * radius
    given = {
        "line_load": line_load,
        "radius": radius,
        "modulus": MODULUS,
        "speed_a": speed * (1.0 + slide / 2.0),
        "speed_b": speed * (1.0 - slide / 2.0),
        "fluid": Fluid(**OIL),
    }
    return LineContact(**(given | others))


def of_moes(M, L, speed=1.0, radius=0.01, viscosity=0.04):
    """Contact of given load and material parameters of Moes, and its oil."""
    U = 2.0 * viscosity * speed / (MODULUS * radius)
    load = np.asarray(M) * np.sqrt(U) * MODULUS * radius
    alpha = np.asarray(L) / (U**0.25 * MODULUS)
    fluid = Fluid(viscosity=viscosity, pressure_viscosity=alpha, **SIMPLE)
    return contact(speed=speed, radius=radius, fluid=fluid, line_load=load)
