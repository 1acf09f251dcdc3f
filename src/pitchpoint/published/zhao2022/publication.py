"""What Zhao et al. (2022) print beside what the library computes, as quantities of a result."""

from pitchpoint.published import conjugate
from pitchpoint.published.publication import Publication
from pitchpoint.published.zhao2022 import printed
from pitchpoint.results.variable import Variable, angle, length, torque

__all__ = ["PUBLICATION"]

_VARIABLES = {
    "largest_tangential_load": Variable(
        "largest tangential load per face width and length of the ring",
        "q_t",
        "Pa",
        "MPa",
        "pressure",
    ),
    "largest_tooth_force": Variable("largest tooth force", "F_0", "N", "N", "force"),
    "printed_least_tooth_force": Variable(
        "least tooth force, formula as printed", "F_min", "N", "N", "force"
    ),
    "recovered_torque": torque("torque that the tooth forces carry", "T"),
    "printed_recovered_torque": torque(
        "torque that the tooth forces carry, formula as printed", "T"
    ),
    "tangent_angle": angle("flank angle of the common tangent", "θ_B"),
    "tip_land": length("thickness of the flexspline's tooth at its tip", "s_a"),
    "flank_length": length("arc length of the flexspline's flank", "s"),
    "printed_sliding_distance": length("sliding distance at the tip, formula as printed", "s_k"),
    "printed_closure_residual": length("gap of the common tangent, formula as printed", "Δy"),
    "tooth_offset": angle("turn of the outermost tooth by the oval ring", "u"),
    "largest_tooth_offset": angle("largest turn of a tooth by the oval ring", "u"),
    "involute_tip_radius": length("tip radius of the flexspline", "r_a"),
    "involute_root_radius": length("root radius of the flexspline", "r_f"),
    "involute_pitch_thickness": length("tooth thickness on the reference circle", "s"),
}

PUBLICATION = Publication(
    name="zhao_2022",
    readings=(printed.readings, conjugate.readings),
    variables={**_VARIABLES, **conjugate.VARIABLES},
)
