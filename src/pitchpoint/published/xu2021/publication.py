"""What Xu et al. (2021) print beside what the library computes, as quantities of a result."""

from pitchpoint.published import conjugate
from pitchpoint.published.publication import Publication
from pitchpoint.published.xu2021 import printed
from pitchpoint.results.variable import Variable, angle, deviation, length, speed, torque

__all__ = ["PUBLICATION"]

_VARIABLES = {
    "largest_tooth_force": Variable("largest tooth force", "F_0", "N", "N", "force"),
    "one_zone_tooth_force": Variable(
        "largest tooth force if one zone carried all", "F_0", "N", "N", "force"
    ),
    "printed_largest_tooth_force": Variable(
        "largest tooth force, formula as printed", "F_0", "N", "N", "force"
    ),
    "printed_least_tooth_force": Variable(
        "least tooth force, formula as printed", "F_min", "N", "N", "force"
    ),
    "recovered_torque": torque("torque that the tooth forces carry", "T"),
    "tooth_ratio": Variable("teeth of the flexspline over tooth difference", "i", "1"),
    "base_radius_flexspline": length("base radius of the flexspline", "r_b1"),
    "base_radius_circular_spline": length("base radius of the circular spline", "r_b2"),
    "printed_radius_root": Variable(
        "relative radius on the long axis, formula as printed", "R", "m", "m", "length"
    ),
    "printed_radius_10": Variable(
        "relative radius at 10 degrees, formula as printed", "R", "m", "m", "length"
    ),
    "printed_radius_end": Variable(
        "relative radius at the end of the zone, formula as printed", "R", "m", "m", "length"
    ),
    "conformal_angle": angle("angle at which the printed radii of curvature agree", "φ"),
    "least_opposed_speed": speed("least mesh point speed, tangential parts opposed", "u"),
    "largest_opposed_speed": speed("largest mesh point speed, tangential parts opposed", "u"),
    "least_added_speed": speed("least mesh point speed, tangential parts added", "u"),
    "largest_added_speed": speed("largest mesh point speed, tangential parts added", "u"),
    "viscosity": Variable(
        "viscosity without pressure by Roelands' law", "η", "Pa s", "mPa s", "dynamic viscosity"
    ),
    "printed_viscosity": Variable(
        "viscosity without pressure, formula as printed", "η", "Pa s", "mPa s", "dynamic viscosity"
    ),
    "effective_modulus": Variable("equivalent modulus", "E'", "Pa", "GPa", "pressure"),
    "composite_roughness": deviation("composite Rq", "σ"),
}

PUBLICATION = Publication(
    name="xu_2021",
    readings=(printed.readings, conjugate.readings),
    variables={**_VARIABLES, **conjugate.VARIABLES},
)
