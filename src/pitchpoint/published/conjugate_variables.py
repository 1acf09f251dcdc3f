"""Variables of the readings of `conjugate`, which several publications have."""

from pitchpoint.results.variable import Variable, angle, deviation, length, speed

__all__ = ["OF_CONJUGATES"]

OF_CONJUGATES = {
    "phase_rate": Variable("speed of the wave over the teeth over that of the driver", "φ'/ω", "1"),
    "deep_angle_first": angle("least angle of the deep conjugate branch", "p"),
    "deep_angle_last": angle("largest angle of the deep conjugate branch", "p"),
    "deep_radius_root": Variable(
        "relative radius on the deep branch at the root", "R", "m", "m", "length"
    ),
    "deep_radius_tip": Variable(
        "relative radius on the deep branch at the tip", "R", "m", "m", "length"
    ),
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
