"""Compliance of the body under a tooth: the tooth tilts and sinks as its root yields."""

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.doubts import GUESSED, Doubt, in_percent
from pitchpoint.gears.tooth_section import ToothSection

__all__ = [
    "HALF_ANGLE_RANGE",
    "RIM_RATIO_RANGE",
    "foundation_compliance",
    "foundation_warnings",
    "sainsot_2004",
]

RIM_RATIO_RANGE = (1.4, 7.0)
"""Root radius over bore radius for which the polynomial was fitted."""

HALF_ANGLE_RANGE = (0.01, 0.12)
"""Half the tooth's angle at the root circle [rad] for which the polynomial was fitted."""

FELT = 0.03
"""Relative difference from the compliance at the limit of its range from which on it is told.

The body gives about a third of the compliance of a pair of teeth: the stiffness feels a third of it, 1 %.
"""

_POLYNOMIAL = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)


def sainsot_2004(
    *,
    load_angle: Float[Array, "*b"],
    arm_ratio: Float[Array, "*b"],
    rim_ratio: Float[Array, ""],
    root_half_angle: Float[Array, ""],
) -> Float[Array, "*b"]:
    """Compliance of the body under a tooth, times Young's modulus and per length of tooth.

    q E = cos^2(alpha) (L u^2/S^2 + M u/S + P (1 + Q tan^2(alpha))).

    Args:
        load_angle: alpha, between the load and the perpendicular to the tooth's axis [rad].
        arm_ratio: u/S, distance from the root circle to where the line of the load crosses the
            tooth's axis, over the tooth's width at the root circle.
        rim_ratio: h, root radius over bore radius, fitted for 1.4 to 7.
        root_half_angle: theta, half the tooth's angle at the root circle [rad], fitted for 0.01
            to 0.12.

    Source: Sainsot, Velex and Duverger (2004).
    """
    bending, coupling, sinking, shear = _factors(rim_ratio, root_half_angle)
    tilted = bending * arm_ratio**2 + coupling * arm_ratio
    sunk = sinking * (1.0 + shear * jnp.tan(load_angle) ** 2)
    return jnp.asarray(jnp.cos(load_angle) ** 2 * (tilted + sunk))


def foundation_compliance(section: ToothSection) -> Float[Array, " node"]:
    """Compliance of the body under a tooth loaded at the nodes, times E and per length of tooth.

    The arm of the load is counted from the line through both ends of the tooth on the root circle,
    where the beam on top of it is clamped as well; the width is the arc between these ends.

    The polynomial holds the twist of the body between root circle and a clamped bore, which grows
    with the square of their ratio ((1 + nu)/(2 pi) h^2 in a plane ring). So `rim_ratio` says where
    the torque enters the body and matters a lot. All pairs in mesh share that twist; pairs summed as
    springs side by side count it for each of them.

    Args:
        section: the tooth; zero for a ring or a rack, see `foundation_warnings`.

    Source: Sainsot, Velex and Duverger (2004), see `sainsot_2004`.
    """
    half_thickness, height = section.flank
    if section.stiff:
        return jnp.zeros_like(height)
    clamped = height[0] - jnp.sum(section.step)
    arm = height - half_thickness * jnp.tan(section.load_angle) - clamped
    width = 2.0 * section.root_half_angle * section.root_radius
    return sainsot_2004(
        load_angle=section.load_angle,
        arm_ratio=arm / width,
        rim_ratio=section.rim_ratio,
        root_half_angle=section.root_half_angle,
    )


def foundation_warnings(section: ToothSection) -> tuple[str, ...]:
    """Sentences on what the foundation's compliance does not cover for this tooth; none if it does."""
    if section.stiff:
        return (
            Doubt(
                f"{section.stiff} under the teeth counts as rigid; its compliance has no formula here",
                moves=GUESSED,
                brief=f"{section.stiff} counts as rigid under the teeth",
            ),
        )
    named = (
        ("root radius over bore radius", "", float(section.rim_ratio), RIM_RATIO_RANGE),
        (
            "half angle of the tooth at its root",
            " rad",
            float(section.root_half_angle),
            HALF_ANGLE_RANGE,
        ),
    )
    outside = [entry for entry in named if not entry[3][0] <= entry[2] <= entry[3][1]]
    if not outside or (beyond := _beyond_fit(section)) < FELT:
        return ()
    return tuple(
        Doubt(
            f"the {name} is {value:.3g}{unit}, beyond the {low:g} to {high:g} of the formula for the "
            f"compliance under the tooth, which differs by {in_percent(beyond)} from that at the limit",
            moves=beyond,
            brief=f"stiffness under the tooth beyond its fit, {in_percent(beyond)}",
        )
        for name, unit, value, (low, high) in outside
    )


def _beyond_fit(section: ToothSection) -> float:
    """How far the formula, loaded in the middle of the flank, is from its value at the limits of its range.

    In plain NumPy: a sentence is no reason to compile.
    """
    half_thickness, height, angle = (
        float(np.asarray(values)[values.shape[-1] // 2])
        for values in (*np.asarray(section.flank), section.load_angle)
    )
    ratio, half_angle = float(section.rim_ratio), float(section.root_half_angle)
    clamped = np.asarray(section.flank)[1, 0] - np.sum(np.asarray(section.step))
    width = 2.0 * half_angle * float(section.root_radius)
    arm = (height - half_thickness * np.tan(angle) - clamped) / width

    def compliance(ratio: float, half_angle: float) -> float:
        terms = (half_angle**-2, ratio**2, ratio / half_angle, 1.0 / half_angle, ratio, 1.0)
        bending, coupling, sinking, shear = _POLYNOMIAL @ np.array(terms)
        return float(
            bending * arm**2 + coupling * arm + sinking * (1.0 + shear * np.tan(angle) ** 2)
        )

    limited = np.clip(ratio, *RIM_RATIO_RANGE), np.clip(half_angle, *HALF_ANGLE_RANGE)
    return abs(compliance(ratio, half_angle) / compliance(*map(float, limited)) - 1.0)


def _factors(rim_ratio: Float[Array, ""], half_angle: Float[Array, ""]) -> Float[Array, "4"]:
    """Factors L, M, P and Q of the polynomial."""
    inverse = 1.0 / half_angle
    terms = [inverse**2, rim_ratio**2, rim_ratio * inverse, inverse, rim_ratio]
    return jnp.asarray(_POLYNOMIAL) @ jnp.stack([*terms, jnp.ones_like(inverse)])
