"""What Liu and Xiong draw and tabulate of a motion, Figs. 5 to 23 and Tables 4 to 7, and the energy."""

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.ellipse import hamrock_brewe_1983
from pitchpoint.core.programs import program
from pitchpoint.lubrication.film_thickness import dowson_higginson_1959, hamrock_dowson_1977
from pitchpoint.lubrication.rolling_resistance import wu_cheng_1991, wu_cheng_1991_strips
from pitchpoint.published.liu_xiong_torus.printed_motion import (
    TorusCourse,
    TorusDrive,
    friction_forces,
    pairs,
)

__all__ = ["CYCLE_COURSES", "TorusOil", "cycle_places", "motion_figures"]

BINS = 2**14
"""Instants of equal distance of which the spectrum is taken."""


class TorusOil(eqx.Module):
    """What film and rolling take beside the motion.

    Attributes:
        pressure_viscosity: alpha [1/Pa].
        whole: mesh cycles of the mean force and of its spectrum.
    """

    pressure_viscosity: Float[Array, ""]
    whole: Float[Array, ""]


LINES = 480
"""Lines that are kept of it, the first at one order over the whole mesh cycles."""

INSTANTS = 2400
"""Places of equal distance from the start on at which a course is kept."""

CYCLE = 600
"""Places of equal distance in a mesh cycle at which what pairs of teeth carry is kept."""

CYCLE_COURSES = (
    *(
        f"{name}_{pair}"
        for name in ("stiffness", "force", "friction")
        for pair in ("0", "1", "both")
    ),
    "film_course_0",
    "film_course_1",
    "efficiency_course",
)
"""Courses of the pairs of teeth over a mesh cycle; not a number where a pair is out of contact."""


def cycle_places() -> Float[Array, " place"]:
    """Parts of a mesh cycle at which these are kept, none of them at a hand-over."""
    return (jnp.arange(CYCLE) + 0.5) / CYCLE


@program
def motion_figures(
    drive: TorusDrive, moved: TorusCourse, oil: TorusOil
) -> dict[str, Float[Array, "..."]]:
    """Numbers and courses of a motion by the end of their names.

    Where flanks would pull, a pair has neither friction nor rolling, and no film to be counted.

    Args:
        drive: that moved.
        moved: from rest on.
        oil: and mesh cycles.
    """
    heat, put_in = _heat(moved), drive.input_torque * drive.speed
    friction = jnp.abs(jnp.sum(moved.friction, axis=1))
    film = _mean_films(drive, moved, oil)
    driven = _mean(moved, _friction_power(drive, moved))
    return {
        "largest_error": jnp.max(moved.error),
        "least_error": jnp.min(moved.error),
        "sliding_friction": _mean(moved, friction),
        "printed_efficiency": _mean(moved, _efficiency(drive, moved, oil)),
        "film_0": film[0],
        "film_1": film[1],
        "film_parts": film[0] / film[1],
        "friction_power": driven,
        "friction_heat": _mean(moved, heat),
        "energy_imbalance": (driven + _mean(moved, heat)) / put_in,
        "mean_gear_speed": _mean(moved, _gear_speed(drive, moved)),
        **_force(drive, moved, oil),
        **_courses(drive, moved),
        **_cycle_courses(drive, moved, oil),
    }


def _heat(moved: TorusCourse) -> Float[Array, " time"]:
    """Power lost to sliding by both pairs [W]."""
    return jnp.sum(jnp.abs(moved.friction * moved.pairs.sliding), axis=1)


def _presses(moved: TorusCourse) -> Bool[Array, "time 2"]:
    return moved.pairs.active & (moved.force > 0.0)


def _efficiency(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> Float[Array, " time"]:
    """Efficiency of each moment, eq. 23 with the sliding friction in its first term."""
    lost = _heat(moved) + jnp.sum(_rolling(drive, moved, oil), axis=1)
    return 1.0 - lost / (drive.input_torque * drive.speed)


def _cycle_courses(
    drive: TorusDrive, moved: TorusCourse, oil: TorusOil
) -> dict[str, Float[Array, " place"]]:
    """What both pairs carry over the last whole mesh cycle, by the names of `CYCLE_COURSES`."""
    cycle = _last_cycle(drive, moved, oil)
    contacts, touches = cycle.pairs, cycle.pairs.active
    film = jnp.where(_presses(cycle), _films(drive, cycle, oil), jnp.nan)
    courses = {"efficiency_course": _efficiency(drive, cycle, oil)}
    carried = {"stiffness": contacts.stiffness, "force": cycle.force, "friction": cycle.friction}
    for name, values in carried.items():
        courses[f"{name}_both"] = jnp.sum(values, axis=1)
    shown = {name: jnp.where(touches, values, jnp.nan) for name, values in carried.items()}
    for name, values in {**shown, "film_course": film}.items():
        courses |= {f"{name}_{pair}": values[:, pair] for pair in (0, 1)}
    return courses


def _last_cycle(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> TorusCourse:
    """The last whole mesh cycle, at places of equal distance."""
    part = cycle_places()
    time = (oil.whole - 1.0 + part) * drive.period

    def read(values: Float[Array, " time"]) -> Float[Array, " place"]:
        return jnp.interp(time, moved.time, values)

    def columns(values: Float[Array, "time column"]) -> Float[Array, "place column"]:
        return jax.vmap(read, 1, 1)(values)

    older = read(1.0 * moved.pairs.active[:, 0]) > 0.5
    contacts = jax.vmap(pairs, (None, 0, 0))(drive, part, older)
    force = jnp.where(contacts.active, columns(moved.force), 0.0)
    return TorusCourse(
        time=time,
        weight=jnp.full(CYCLE, 1.0 / CYCLE),
        error=read(moved.error),
        rate=columns(moved.rate),
        force=force,
        friction=jax.vmap(friction_forces, (None, 0, 0))(drive, force, contacts),
        pairs=contacts,
    )


def _courses(drive: TorusDrive, moved: TorusCourse) -> dict[str, Float[Array, " instant"]]:
    """Transmission error and speed of the gear from the start on [m, rad/s]."""
    times = jnp.arange(INSTANTS) / (INSTANTS - 1.0) * moved.time[-1]
    motion = {"error": moved.error, "gear_speed": _gear_speed(drive, moved)}
    return {name: jnp.interp(times, moved.time, values) for name, values in motion.items()}


def _gear_speed(drive: TorusDrive, moved: TorusCourse) -> Float[Array, " time"]:
    """Speed of the gear: that beside the nominal motion, and the nominal one [rad/s]."""
    return (moved.rate[:, 5] + drive.speed * drive.base_radii[0]) / drive.base_radii[1]


def _mean(moved: TorusCourse, values: Float[Array, " time"]) -> Float[Array, ""]:
    return jnp.sum(moved.weight * values) / jnp.sum(moved.weight)


def _rolling(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> Float[Array, "time 2"]:
    """Rolling power of both pairs: F_pr of eq. 24 times v_p + v_g [W].

    As published F_pr is taken as a force, with the group W = F/(E' R'^2); by Hertz's radii it is one per
    length, over the face or the ellipse. The radius is that of the profile on both pairs.
    """
    load, radius = jnp.where(_presses(moved), moved.force, 0.0), _profile(drive, moved)
    conditions = {**_oil(drive, moved, oil), "radius": radius}
    if drive.radii == "printed":
        force = wu_cheng_1991(line_load=load / radius, **conditions)
        return 2.0 * force * moved.pairs.entrainment
    ellipse = hamrock_brewe_1983(
        load=load, radius=radius, transverse_radius=drive.transverse_radius, modulus=drive.modulus
    )
    points = wu_cheng_1991_strips(load=load, semi_axis_across=ellipse.across, **conditions)
    width = drive.face_width
    lines = width * wu_cheng_1991(line_load=load / width, **conditions)
    force = jnp.where(drive.pointed > 0.0, points, lines)
    return 2.0 * force * moved.pairs.entrainment


def _profile(drive: TorusDrive, moved: TorusCourse) -> Float[Array, "time 2"]:
    """Relative radius of curvature of the profiles [m]."""
    place = moved.pairs.place
    return place * (drive.tangent - place) / drive.tangent


def _oil(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> dict[str, Float[Array, "..."]]:
    return {
        "entrainment": moved.pairs.entrainment,
        "viscosity": drive.viscosity,
        "pressure_viscosity": oil.pressure_viscosity,
        "modulus": drive.modulus,
    }


def _films(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> Float[Array, "time 2"]:
    """Least film of both pairs, eq. 25 or 26 [m]; of no meaning where they do not press.

    As published R' and W = F/(E' R'^2) are those printed, and kappa that of R_y over the radius of the
    profile; by Hertz's radii R_x and R_y are those of the flanks, and the line has the load over the face.
    """
    load, radius = jnp.where(_presses(moved), moved.force, 0.0), moved.pairs.radius
    conditions = {**_oil(drive, moved, oil), "radius": radius}
    slender = radius * drive.transverse_radius / _profile(drive, moved)
    width = radius if drive.radii == "printed" else drive.face_width
    points = hamrock_dowson_1977(load=load, transverse_radius=slender, **conditions)
    lines = dowson_higginson_1959(line_load=load / width, **conditions)
    return jnp.where(drive.pointed > 0.0, points, lines)


def _mean_films(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> Float[Array, "2"]:
    """Mean least film of both pairs while they press [m]."""
    presses = _presses(moved)
    weight = moved.weight[:, None] * presses
    film = jnp.where(presses, _films(drive, moved, oil), 0.0)
    return jnp.sum(weight * film, axis=0) / jnp.sum(weight, axis=0)


def _friction_power(drive: TorusDrive, moved: TorusCourse) -> Float[Array, " time"]:
    """Power of friction on both gears by the signs of eqs. 17 to 20 [W].

    Both gears are driven by +F_f through their arms: with the nominal speeds it is F_f (v_p + v_g).
    """
    place = moved.pairs.place
    turning = (moved.rate[:, 4:] + drive.speed * drive.base_radii[0]) / drive.base_radii
    passing = turning[:, :1] * place + turning[:, 1:] * (drive.tangent - place)
    shifting = moved.rate[:, 2:3] + moved.rate[:, 3:4]
    return jnp.sum(moved.friction * (passing + shifting), axis=1)


def _force(drive: TorusDrive, moved: TorusCourse, oil: TorusOil) -> dict[str, Float[Array, "..."]]:
    """Mean of the whole normal force over whole mesh cycles, its spectrum, and its highest line [N, Hz]."""
    force, end = jnp.sum(moved.force, axis=1), oil.whole * drive.period
    even = jnp.interp(jnp.arange(BINS) / BINS * end, moved.time, force)
    height = 2.0 / BINS * jnp.abs(jnp.fft.rfft(even)[1 : BINS // 2])
    rate = jnp.arange(1, BINS // 2) / oil.whole
    numbers = {
        "mean_force": jnp.mean(even),
        "force_peak": rate[jnp.argmax(height)] / drive.period,
        "highest_line": jnp.max(height),
    }
    return {**numbers, "spectrum": height[:LINES]}
