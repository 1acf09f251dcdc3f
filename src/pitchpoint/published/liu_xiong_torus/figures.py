"""What Liu and Xiong tabulate of a motion: Tables 4 to 7, section 4, and the balance of energy."""

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.lubrication.film_thickness import dowson_higginson_1959, hamrock_dowson_1977
from pitchpoint.lubrication.rolling_resistance import wu_cheng_1991
from pitchpoint.programs import program
from pitchpoint.published.liu_xiong_torus.motion import Course, Drive

__all__ = ["Oil", "figures"]

BINS = 2**14
"""Instants of equal distance of which the spectrum is taken."""


class Oil(eqx.Module):
    """What film and rolling take beside the motion.

    Attributes:
        pressure_viscosity: alpha [1/Pa].
        transverse_radius: relative radius R_y across the profile [m].
        whole: mesh cycles of the mean force and of its spectrum.
    """

    pressure_viscosity: Float[Array, ""]
    transverse_radius: Float[Array, ""]
    whole: Float[Array, ""]


LINES = 480
"""Lines that are kept of it, the first at one order over the whole mesh cycles."""

INSTANTS = 2400
"""Places of equal distance from the start on at which a course is kept."""


@program
def figures(drive: Drive, moved: Course, oil: Oil) -> dict[str, Float[Array, "..."]]:
    """Numbers and courses of a motion by the end of their names.

    Where flanks would pull, a pair has neither friction nor rolling, and no film to be counted.

    Args:
        drive: that moved.
        moved: from rest on.
        oil: and mesh cycles.
    """
    presses = moved.pairs.active & (moved.force > 0.0)
    heat = jnp.sum(jnp.abs(moved.friction * moved.pairs.sliding), axis=1)
    rolling = jnp.sum(_rolling(drive, moved, oil, presses), axis=1)
    put_in = drive.input_torque * drive.speed
    friction = jnp.abs(jnp.sum(moved.friction, axis=1))
    film = _films(drive, moved, oil, presses)
    driven = _mean(moved, _friction_power(drive, moved))
    return {
        "largest_error": jnp.max(moved.error),
        "least_error": jnp.min(moved.error),
        "sliding_friction": _mean(moved, friction),
        "printed_efficiency": _mean(moved, 1.0 - (heat + rolling) / put_in),
        "film_0": film[0],
        "film_1": film[1],
        "film_parts": film[0] / film[1],
        "friction_power": driven,
        "friction_heat": _mean(moved, heat),
        "energy_imbalance": (driven + _mean(moved, heat)) / put_in,
        **_force(drive, moved, oil),
        **_courses(drive, moved),
    }


def _courses(drive: Drive, moved: Course) -> dict[str, Float[Array, " instant"]]:
    """Transmission error and speed of the gear from the start on [m, rad/s]."""
    times = jnp.arange(INSTANTS) / (INSTANTS - 1.0) * moved.time[-1]
    turning = (moved.rate[:, 5] + drive.speed * drive.base_radii[0]) / drive.base_radii[1]
    kept = {"error": moved.error, "gear_speed": turning}
    return {name: jnp.interp(times, moved.time, values) for name, values in kept.items()}


def _mean(moved: Course, values: Float[Array, " time"]) -> Float[Array, ""]:
    return jnp.sum(moved.weight * values) / jnp.sum(moved.weight)


def _rolling(
    drive: Drive, moved: Course, oil: Oil, presses: Bool[Array, "time 2"]
) -> Float[Array, "time 2"]:
    """Rolling power of both pairs: F_pr of eq. 24 taken as a force, times v_p + v_g [W].

    W = F/(E' R'^2) is the printed group. R' is that of the profile on both pairs.
    """
    place = moved.pairs.place
    radius = place * (drive.tangent - place) / drive.tangent
    force = wu_cheng_1991(
        line_load=jnp.where(presses, moved.force, 0.0) / radius,
        entrainment=moved.pairs.entrainment,
        viscosity=drive.viscosity,
        pressure_viscosity=oil.pressure_viscosity,
        radius=radius,
        modulus=drive.modulus,
    )
    return 2.0 * force * moved.pairs.entrainment


def _films(
    drive: Drive, moved: Course, oil: Oil, presses: Bool[Array, "time 2"]
) -> Float[Array, "2"]:
    """Mean least film of both pairs while they press, eq. 25 or 26 [m].

    R' and W = F/(E' R'^2) are those printed, kappa is that of R_y over the radius of the profile.
    """
    place, radius = moved.pairs.place, moved.pairs.radius
    profile = place * (drive.tangent - place) / drive.tangent
    given = {
        "entrainment": moved.pairs.entrainment,
        "viscosity": drive.viscosity,
        "pressure_viscosity": oil.pressure_viscosity,
        "radius": radius,
        "modulus": drive.modulus,
    }
    load = jnp.where(presses, moved.force, 0.0)
    slender = radius * oil.transverse_radius / profile
    points = hamrock_dowson_1977(load=load, transverse_radius=slender, **given)
    lines = dowson_higginson_1959(line_load=load / radius, **given)
    film = jnp.where(drive.pointed > 0.0, points, lines)
    weight = moved.weight[:, None] * presses
    return jnp.sum(weight * film, axis=0) / jnp.sum(weight, axis=0)


def _friction_power(drive: Drive, moved: Course) -> Float[Array, " time"]:
    """Power of friction on both gears by the signs of eqs. 17 to 20 [W].

    Both gears are driven by +F_f through their arms: with the nominal speeds it is F_f (v_p + v_g).
    """
    place = moved.pairs.place
    turning = (moved.rate[:, 4:] + drive.speed * drive.base_radii[0]) / drive.base_radii
    passing = turning[:, :1] * place + turning[:, 1:] * (drive.tangent - place)
    shifting = moved.rate[:, 2:3] + moved.rate[:, 3:4]
    return jnp.sum(moved.friction * (passing + shifting), axis=1)


def _force(drive: Drive, moved: Course, oil: Oil) -> dict[str, Float[Array, "..."]]:
    """Mean of the whole normal force over whole mesh cycles, its spectrum and where it is highest [N, Hz].

    Of the spectrum only what lies below one and a half of the mesh frequency counts.
    """
    force, last = jnp.sum(moved.force, axis=1), oil.whole * drive.period
    even = jnp.interp(jnp.arange(BINS) / BINS * last, moved.time, force)
    height = 2.0 / BINS * jnp.abs(jnp.fft.rfft(even)[1 : BINS // 2])
    rate = jnp.arange(1, BINS // 2) / oil.whole
    peak = rate[jnp.argmax(jnp.where(rate < 1.5, height, 0.0))]
    found = {"mean_force": jnp.mean(even), "force_peak": peak / drive.period}
    return {**found, "spectrum": height[:LINES]}
