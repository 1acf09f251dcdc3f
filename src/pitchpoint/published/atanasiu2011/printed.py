"""Formulas as Atanasiu et al. (2011) print them where the print is wrong; the library has the right ones."""

from collections.abc import Sequence
from math import cos, sin, sqrt, tan

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax
from pitchpoint.core.programs import program
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.gears.rated_pair import bare_pair
from pitchpoint.published.publication import ReadingPoint

__all__ = ["equivalent_mass", "readings", "undercut_limit"]


def undercut_limit(
    *,
    teeth: float,
    pressure_angle: float,
    helix_angle: float,
    dedendum: float,
    fillet_radius: float,
) -> float:
    """Smallest profile shift without undercut by eq. 2 as printed.

    The root in eq. 2b must divide: A is then the sine of the normal pressure angle, and the tangent
    point of the rack's corner has its true height.

    Args:
        teeth: z.
        pressure_angle: transverse pressure angle alpha_t [rad].
        helix_angle: [rad].
        dedendum, fillet_radius: h_oa* and rho_on* of the tool, in normal modules.
    """
    sine = sin(pressure_angle)
    a = sine * sqrt(sine**2 + (cos(pressure_angle) / cos(helix_angle)) ** 2)
    return dedendum - fillet_radius * (1.0 - a) - teeth * sine**2 / (2.0 * cos(helix_angle))


def equivalent_mass(*, inertia: Sequence[float], base_radius: Sequence[float]) -> float:
    """Equivalent mass by eq. 13 as printed, with the base radii at the wrong inertias [kg].

    Args:
        inertia: J1, J2 [kg m2].
        base_radius: r_b1, r_b2 [m].
    """
    (j_1, j_2), (r_1, r_2) = inertia, base_radius
    return j_1 * j_2 / (j_1 * r_1**2 + j_2 * r_2**2)


def readings(point: ReadingPoint) -> dict[str, float]:
    """Both formulas for a case, under the names of result variables."""
    gears, design = point.gears, point.design
    mesh = design.mesh
    assert isinstance(gears, CylindricalGears)
    assert isinstance(mesh, CylindricalPair)
    angle = float(np.arctan(tan(gears.pressure_angle) / cos(gears.helix_angle)))
    densities = [float(solid.density) for solid in design.solids]
    inertia, action = jax.device_get(_inertia_and_arms(bare_pair(mesh), array(densities)))
    return {
        "printed_undercut_limit_1": undercut_limit(
            teeth=gears.teeth[0],
            pressure_angle=angle,
            helix_angle=gears.helix_angle,
            dedendum=float(np.asarray(mesh.dedendum)[0]),
            fillet_radius=float(np.asarray(mesh.fillet_radius)[0]),
        ),
        "printed_equivalent_mass": equivalent_mass(
            inertia=[float(value) for value in inertia],
            base_radius=[abs(float(value)) for value in action],
        ),
    }


@program
def _inertia_and_arms(mesh: CylindricalPair, density: Float[Array, "2"]) -> tuple[Array, Array]:
    return plain_inertia(mesh, density), line_of_action(mesh)
