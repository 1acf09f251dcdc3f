"""Variables of the readings of `conjugate`, which several publications have."""

from pitchpoint.results.variable import angle, deviation, dimensionless, length, speed

__all__ = ["OF_CONJUGATES"]

OF_CONJUGATES = {
    "phase_rate": dimensionless("speed of the wave over the teeth over that of the driver", "φ'/ω"),
    "deep_angle_first": angle("least angle of the deep conjugate branch", "p"),
    "deep_angle_last": angle("largest angle of the deep conjugate branch", "p"),
    "deep_radius_root": length("relative radius on the deep branch at the root", "R", shown="m"),
    "deep_radius_tip": length("relative radius on the deep branch at the tip", "R", shown="m"),
    "deep_entrainment_root": speed("entrainment on the deep branch at the root", "u"),
    "deep_entrainment_tip": speed("entrainment on the deep branch at the tip", "u"),
    "outer_angle_first": angle("least angle of the outer conjugate branch", "p"),
    "outer_angle_last": angle("largest angle of the outer conjugate branch", "p"),
    "outer_radius_least": length("least relative radius on the outer branch, with its sign", "R"),
    "outer_radius_largest": length(
        "largest relative radius on the outer branch, with its sign", "R"
    ),
    "outer_clearance_least": deviation("least clearance on the outer branch", "g"),
    "clearance_between": deviation("largest clearance between pairs that touch", "g"),
}
"""What its readings give."""
