"""Estimates of what a flexspline and its wave generator bear: a ring bent to its wave, a twisted tube."""

import numpy as np
from jaxtyping import Float

__all__ = [
    "bearing_life",
    "curvature_change",
    "face_stress",
    "flexspline_torque",
    "goodman_safety",
    "of_other_size",
    "rated_life_torque",
    "torque_by_goodman",
    "tube_shear",
    "von_mises",
]

Values = Float[np.ndarray, "*#b"] | float


def curvature_change(
    angle: Float[np.ndarray, " place"],
    *,
    radius: float,
    deflection: float,
    weights: Float[np.ndarray, " term"],
) -> Float[np.ndarray, " place"]:
    """Change of the curvature of a ring that keeps its length [1/m], positive where it is bent more.

    Args:
        angle: from the long axis [rad].
        radius: of the neutral line [m].
        deflection: radial displacement on the long axis w0 [m].
        weights: amplitudes of cos 2p, cos 4p, ... of the displacement w over w0.

    Source: a thin ring, to first order in w, -(w + w'')/r^2; of w0 cos 2p it is 3 w0/r^2 on the long axis.

    Example:
        >>> import numpy as np
        >>> one = curvature_change(
        ...     np.zeros(1), radius=0.03, deflection=3e-4, weights=np.array([1.0])
        ... )
        >>> np.round(one, 9)
        array([1.])
    """
    waves = 2.0 * np.arange(1, len(weights) + 1)
    harmonics = weights * (waves**2 - 1.0) * np.cos(np.multiply.outer(angle, waves))
    return np.asarray(deflection / radius**2 * harmonics.sum(axis=-1))


def face_stress(*, young: float, thickness: Values, curvature: Values) -> Values:
    """Bending stress at the outer face of a thin ring E t/2 times the change of its curvature [Pa].

    That of a narrow ring: one that is wide against its thickness is stiffer by 1/(1 - nu^2), 10 % of steel.

    Args:
        young: modulus [Pa].
        thickness: of the ring [m].
        curvature: change of it [1/m].

    From Hooke's law half a thickness from the neutral line.

    Example:
        >>> face_stress(young=200e9, thickness=0.5e-3, curvature=1.0)
        50000000.0
    """
    return young * thickness / 2.0 * curvature


def tube_shear(*, torque: Values, radius: float, thickness: Values) -> Values:
    """Shear stress of a thin tube under torque T/(2 pi r^2 t) [Pa].

    Args:
        torque: [N m].
        radius: of its middle line [m].
        thickness: of its wall [m].

    Source: Bredt (1896).

    Example:
        >>> round(tube_shear(torque=100.0, radius=0.03, thickness=0.5e-3) / 1e6, 3)
        35.368
    """
    return torque / (2.0 * np.pi * radius**2 * thickness)


def von_mises(*, normal: Values, shear: Values) -> Values:
    """Equivalent stress of one normal and one shear stress, sqrt(sigma^2 + 3 tau^2) [Pa].

    Source: von Mises (1913).

    Example:
        >>> round(float(von_mises(normal=0.0, shear=15.0)), 2)
        25.98
    """
    return np.sqrt(np.square(normal) + 3.0 * np.square(shear))


def goodman_safety(
    *, alternating: Values, mean: Values, endurance_limit: float, tensile_strength: float
) -> Values:
    """Safety for endless life by the modified Goodman line, 1/(sigma_a/S_e + sigma_m/S_u).

    Args:
        alternating, mean: equivalent stresses [Pa].
        endurance_limit: of the finished part under fully reversed bending S_e [Pa].
        tensile_strength: S_u [Pa].

    Source: Goodman (1899), in the modified form that ends at S_e and S_u.

    Example:
        >>> strengths = {"endurance_limit": 40.0, "tensile_strength": 80.0}
        >>> round(goodman_safety(alternating=25.0, mean=25.98, **strengths), 2)
        1.05
    """
    return 1.0 / (alternating / endurance_limit + mean / tensile_strength)


def torque_by_goodman(
    *,
    alternating: Values,
    mean_bending: Values,
    shear_per_torque: Values,
    endurance_limit: float,
    tensile_strength: float,
    reversing: bool = False,
) -> Values:
    """Torque at which the safety of `goodman_safety` is one [N m]; zero where bending is too much.

    Args:
        alternating, mean_bending: normal stresses, whatever the torque [Pa].
        shear_per_torque: shear stress for a torque of 1 N m [Pa/(N m)].
        endurance_limit, tensile_strength: [Pa].
        reversing: True if the torque changes its sense, and shear alternates; steady by default.

    From `goodman_safety` and `von_mises`, solved for the shear stress.

    Example:
        >>> round(
        ...     float(
        ...         torque_by_goodman(
        ...             alternating=25.0,
        ...             mean_bending=0.0,
        ...             shear_per_torque=1.0,
        ...             endurance_limit=50.0,
        ...             tensile_strength=80.0,
        ...         )
        ...     ),
        ...     3,
        ... )
        23.094
    """
    ends = (endurance_limit, alternating), (tensile_strength, np.abs(mean_bending))
    (strength, beside), (used_strength, used) = ends if reversing else ends[::-1]
    left = np.maximum(strength * (1.0 - used / used_strength), 0.0)
    shear = np.sqrt(np.maximum(left**2 - np.square(beside), 0.0) / 3.0)
    return np.asarray(shear / shear_per_torque)


def flexspline_torque(load: float, loaded: str, teeth: tuple[float, float]) -> float:
    """Torque on a flexspline without losses [N m].

    Args:
        load: torque on the loaded member [N m].
        loaded: its name.
        teeth: numbers of teeth z1, z2 of flexspline and circular spline.

    Source: torques are as z1 : z2 : (z2 - z1) on flexspline, circular spline and wave generator.

    Example:
        >>> round(flexspline_torque(101.0, "circular spline", (200, 202)), 9)
        100.0
    """
    flexspline_teeth, spline_teeth = teeth
    of = {
        "flexspline": flexspline_teeth,
        "circular spline": spline_teeth,
        "wave generator": spline_teeth - flexspline_teeth,
    }
    return load * flexspline_teeth / of[loaded]


def of_other_size(torque: float, *, size: float, known: float) -> float:
    """Torque that goes with the cube of the size [N m].

    Args:
        torque: of the known drive [N m].
        size, known: pitch diameters of this drive and of that one [m].

    From stresses that stay as they are: forces go with the square of the size, their arms with the size.

    Example:
        >>> round(of_other_size(500.0, size=32.0, known=25.0))
        1049
    """
    return torque * (size / known) ** 3


def bearing_life(
    *, rated_life: float, rated_torque: float, rated_speed: float, torque: float, speed: float
) -> float:
    """Life of the bearing of a wave generator by a maker's rating, L (T_r/T)^3 n_r/n [s]; endless at rest.

    Args:
        rated_life: at rated torque and speed [s].
        rated_torque, torque: rated, and the cubic mean one of the flexspline [N m].
        rated_speed, speed: of the wave generator against the circular spline [rad/s].

    Source: Harmonic Drive AG, Engineering Data CSD-2A (2014), eq. 20.2.

    Example:
        >>> round(
        ...     bearing_life(
        ...         rated_life=7000.0, rated_torque=67.0, rated_speed=2000.0, torque=67.0, speed=1000.0
        ...     )
        ... )
        14000
    """
    if torque == 0.0 or speed == 0.0:
        return float("inf")
    return rated_life * (rated_torque / torque) ** 3 * rated_speed / speed


def rated_life_torque(*, rated_torque: float, rated_speed: float, speed: float) -> float:
    """Torque for the rated life at another speed, T_r (n_r/n)^(1/3) [N m]; endless at rest.

    Args:
        rated_torque: of the flexspline [N m].
        rated_speed, speed: of the wave generator against the circular spline [rad/s].

    Source: `bearing_life`, solved for its torque.

    Example:
        >>> from pitchpoint.gears.strain_wave.strength_estimates import rated_life_torque
        >>> round(rated_life_torque(rated_torque=67.0, rated_speed=2000.0, speed=250.0), 9)
        134.0
    """
    return rated_torque * (rated_speed / speed) ** (1.0 / 3.0) if speed > 0.0 else float("inf")
