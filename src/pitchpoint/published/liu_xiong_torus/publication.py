"""What Liu and Xiong print beside what the library computes, as quantities of a result."""

from collections.abc import Iterator
from dataclasses import replace

from pitchpoint.published.publication import Beside, Curves, Publication
from pitchpoint.results.variable import (
    Variable,
    angle,
    deviation,
    dimensionless,
    force,
    frequency,
    length,
    percent,
    power,
    pressure,
    rotational_speed,
    stiffness,
)

__all__ = ["PAIRS", "PUBLICATION"]

PAIRS = ("torus", "standard")
"""Torus-involute pair and standard pair of the same dimensions."""


def _pressure(long_name: str) -> Variable:
    return pressure(long_name, "p_H", shown="GPa")


def _plain(long_name: str, symbol: str) -> Variable:
    return dimensionless(long_name, symbol)


def _tilt(long_name: str) -> Variable:
    return angle(long_name, "γ", shown="mrad")


_GEOMETRY = {
    "base_radius_pinion": length("base radius of the pinion", "r_bp"),
    "base_radius_gear": length("base radius of the gear", "r_bg"),
    "line_of_action": length("line of action between the base circles", "N_pN_g"),
    "single_contact_start": _plain(
        "part of a mesh cycle at which the older pair leaves", "t_Cp/t_c"
    ),
    "pitch_point_passed": _plain(
        "part of a mesh cycle at which a pair passes the pitch point", "t_p/t_c"
    ),
    "contact_roll": angle("roll of the pinion in contact", "φ"),
    "mesh_rate": frequency("mesh frequency", "1/t_c"),
    "static_force": force("normal force without friction", "F_n"),
    "quadratic_place": length("place of the contact across the face, parabola", "z"),
    "quadratic_approach": deviation("approach by misalignment, parabola", "δ"),
    "tilt_limit": _tilt("tilt at which the ellipse at the pitch point reaches the end of the face"),
    "tilt_limit_2_mm": _tilt("the same of an ellipse with a semi-axis of 2 mm"),
    "quadratic_tilt_limit": _tilt("the same of an ellipse with a semi-axis of 2 mm, parabola"),
}

_AT_PITCH = {
    "ellipse_across": length("semi-axis across, Hertz, pitch point", "a"),
    "ellipse_along": length("semi-axis along the profile, Hertz, pitch point", "b"),
    "ellipse_pressure": _pressure("pressure, Hertz, pitch point"),
    "regressed_across": length("semi-axis across, Hamrock and Brewe, pitch point", "a"),
    "regressed_along": length("semi-axis along the profile, Hamrock and Brewe, pitch point", "b"),
    "regressed_pressure": _pressure("pressure, Hamrock and Brewe, pitch point"),
    "line_pressure": _pressure("pressure of the standard pair, pitch point"),
    "printed_pressure": _pressure("pressure of the standard pair, formula without face width"),
    "torus_pitch_film": deviation("film of the torus pair, pitch point, R' by Hertz", "h_min"),
    "standard_pitch_film": deviation("film of the standard pair, pitch point", "h_min"),
    "film_ratio": _plain(
        "film of the torus pair over that of the standard pair, R' by Hertz", "h/h"
    ),
}

_BESIDE = {
    "error_ratio": _plain("largest transmission error, torus over standard pair", "ε/ε"),
    "friction_ratio": _plain("sliding friction, torus over standard pair, from rest", "F/F"),
    "printed_film_ratio": _plain(
        "film of the torus pair over that of the standard pair, from rest", "h/h"
    ),
    "torus_less_standard_friction": force("sliding friction, torus less standard pair", "ΔF"),
    "torus_less_standard_efficiency": percent("efficiency, torus less standard pair", "Δχ"),
    "torus_less_standard_sliding_efficiency": percent(
        "efficiency by sliding alone, torus less standard pair", "Δχ_f"
    ),
}


_OF_MOTION = {
    "largest_error": deviation("largest dynamic transmission error", "ε_d"),
    "least_error": deviation("least dynamic transmission error", "ε_d"),
    "sliding_friction": force("mean sliding friction of both pairs of teeth", "|ΣF_f|"),
    "printed_efficiency": percent("mean efficiency, eq. 23", "χ"),
    "film_0": deviation("mean least film, pair 0", "h_min"),
    "film_1": deviation("mean least film, pair 1", "h_min"),
    "film_parts": _plain("film of pair 0 over that of pair 1", "h/h"),
    "friction_power": power("mean power of friction by the printed signs", "P_f"),
    "friction_heat": power("mean loss by sliding", "P_v"),
    "energy_imbalance": percent("energy that the printed signs create, of the input", "ΔE/E"),
    "mean_force": force("mean normal force over whole mesh cycles", "F_n"),
    "mean_gear_speed": rotational_speed("mean speed of the gear", "ω_g", shown="rad/s"),
    "force_peak": frequency("frequency of the highest line of the normal force", "f"),
    "highest_line": force("highest line of the normal force", "F_n"),
}
"""Numbers of the motion by the printed equations, of one pair."""

_STEADY = {
    "steady_largest_error": deviation("largest dynamic transmission error", "ε_d"),
    "steady_least_error": deviation("least dynamic transmission error", "ε_d"),
    "steady_friction": force("mean sliding friction of both pairs of teeth", "|ΣF_f|"),
    "steady_efficiency": percent("mean efficiency", "η"),
    "steady_lowest_efficiency": percent("least efficiency, loss of the moment", "χ"),
    "steady_highest_efficiency": percent("largest efficiency, loss of the moment", "χ"),
    "steady_friction_created": percent("energy that friction creates, of the input", "ΔE/E"),
    "steady_energy_left": _plain("energy that is not accounted for, of the largest part", "ΔE/E"),
    "steady_reaction_left": _plain(
        "sum of the forces of the contacts on both gears, of the largest", "ΣF/F"
    ),
    "steady_pulled": percent("part of the time in which flanks pull", "t/t_c"),
    "steady_film": deviation("mean film, thinnest of both pairs of teeth", "h_min"),
}
"""Numbers of the motion in steady state by the corrected equations, of one pair."""

_PLACES = {
    "start_cycles": _plain("mesh cycles from the start on", "t/t_c"),
    "cycle_part": _plain("part of the last whole mesh cycle", "t/t_c"),
    "stiffness_roll": angle("roll of the pinion since the pair entered", "θ"),
    "steady_cycles": _plain("mesh cycles in steady state", "t/t_c"),
    "start_orders": _plain("order of the mesh frequency", "f t_c"),
    "steady_orders": _plain("order of the mesh frequency", "f t_c"),
}

_COURSES = {
    "error": deviation("dynamic transmission error", "ε_d"),
    "gear_speed": rotational_speed("speed of the gear", "ω_g", shown="rad/s"),
    "spectrum": force("amplitude of the normal force", "F_n"),
    "force_both": force("normal force of both pairs of teeth", "F_n"),
    **{f"force_{pair}": force(f"normal force of pair {pair}", "F_n") for pair in (0, 1)},
    **{f"friction_{pair}": force(f"sliding friction of pair {pair}", "F_f") for pair in (0, 1)},
    **{f"film_course_{pair}": deviation(f"least film of pair {pair}", "h_min") for pair in (0, 1)},
    "efficiency_course": percent("efficiency of the moment", "χ"),
}
"""Courses that the motion as published and that in steady state have, of one pair of gears."""

_PRINTED_COURSES = {
    "friction_both": force("sliding friction of both pairs of teeth", "ΣF_f"),
    **{f"stiffness_{pair}": stiffness(f"stiffness of pair {pair}", "k") for pair in (0, 1)},
    "stiffness_both": stiffness("stiffness of both pairs of teeth", "k"),
}
"""Courses of the motion as published alone."""

_STIFFNESS = {
    "given_stiffness": stiffness("stiffness of a pair of teeth, as given", "k"),
    "motion_stiffness": stiffness("stiffness of a pair of teeth on which the motion runs", "k"),
    "secant_stiffness": stiffness("stiffness of a pair of teeth, library, secant F_n/δ", "k"),
    "slope_stiffness": stiffness("stiffness of a pair of teeth, library, slope dF_n/dδ", "k"),
}
"""Courses over the path of a pair of teeth."""

_STATUS = {"steady_status": _plain("status of the solve", "")}

_STEADY_RATIOS = {
    "steady_friction_ratio": _plain(
        "sliding friction, torus over standard pair, steady state", "F/F"
    ),
    "steady_film_ratio": _plain(
        "film of the torus pair over that of the standard pair, steady state", "h/h"
    ),
}

_HIDDEN = ("film_parts", "mean_force", "mean_gear_speed", "force_peak", "highest_line")


_PATH_COLUMNS = {
    "torus": "given: Table 1, straight between its values",
    "standard": "given: derived, not in the paper",
}

_IN_ORDER = (
    ("force_both", "cycle_part", "Figure 7"),
    ("force_0", "cycle_part", ""),
    ("force_1", "cycle_part", ""),
    ("gear_speed", "start_cycles", "Figure 8"),
    ("spectrum", "start_orders", "Figure 9"),
    ("error", "start_cycles", "Figures 11 to 13"),
    ("friction_0", "cycle_part", "Figures 14a to 16a"),
    ("friction_1", "cycle_part", "Figures 14b to 16b"),
    ("efficiency_course", "cycle_part", "Figures 17 to 20"),
    ("film_course_0", "cycle_part", "Figures 21a to 23a"),
    ("film_course_1", "cycle_part", "Figures 21b to 23b"),
)
"""Courses of the motion as published, in the order of the paper."""

_DRAWN_AT = {
    **dict.fromkeys(("Figure 7", "Figure 8", "Figure 9", "Figure 10"), "at the validation"),
    "Figures 11 to 13": "conditions 1, 3 and 6",
    "Figures 14a to 16a": "conditions 1, 3 and 6",
    "Figures 14b to 16b": "conditions 1, 3 and 6",
    "Figures 17 to 20": "conditions 1 to 4",
    "Figures 21a to 23a": "conditions 1, 3 and 5",
    "Figures 21b to 23b": "conditions 1, 3 and 5",
}
"""Operating points of the figures of the paper."""


def _curves() -> Iterator[Curves]:
    """Courses over each other: stiffness, then both pairs from the start on, then in steady state."""
    yield from _of_the_path()
    yield _of_torus_pair("stiffness", "stiffness on which the motion runs", "Figure 5")
    for name, along, shows in _IN_ORDER:
        yield _of_both(name, along, "from rest", "", shows)
        if name == "spectrum":
            yield _of_torus_pair("friction", "sliding friction", "Figure 10")
    for name, along, _ in _IN_ORDER:
        place = "steady_orders" if along == "start_orders" else "steady_cycles"
        yield _of_both(name, place, "steady state", "steady_", "")


def _of_both(name: str, along: str, which: str, begin: str, shows: str) -> Curves:
    """A course of the torus pair over that of the standard pair."""
    names = tuple(f"{pair}_{begin}{name}" for pair in PAIRS)
    at = _DRAWN_AT.get(shows, "")
    return Curves(f"{_COURSES[name].long_name}, {which}", along, names, shows=shows, at=at)


def _of_torus_pair(name: str, title: str, shows: str) -> Curves:
    """A course of both pairs of teeth of the torus pair, and of both together."""
    names = tuple(f"torus_{name}_{which}" for which in ("0", "1", "both"))
    columns = ("pair 0", "pair 1", "both")
    return Curves(
        f"{title}, torus pair, from rest",
        "cycle_part",
        names,
        columns,
        shows=shows,
        at=_DRAWN_AT.get(shows, ""),
    )


def _of_the_path() -> Iterator[Curves]:
    """Stiffness of a pair of teeth as given, as the motion has it, and as the library has it."""
    for pair in PAIRS:
        names = tuple(f"{pair}_{name}" for name in _STIFFNESS)
        columns = (
            _PATH_COLUMNS[pair],
            "the motion runs on this polynomial",
            "library, secant F_n/δ",
            "library, slope dF_n/dδ",
        )
        shows = "Table 1" if pair == "torus" else ""
        title = f"stiffness of a pair of teeth, {pair} pair"
        yield Curves(title, "stiffness_roll", names, columns, shows=shows)


def _dimensions() -> dict[str, str]:
    """Dimension of every course, and of the places that it runs over."""
    drawn = {
        name: f"{curves.along}_place"
        for curves in _curves()
        for name in (curves.along, *curves.names)
    }
    beside = {f"standard_{name}": "cycle_part_place" for name in _PRINTED_COURSES}
    return {**drawn, **beside}


def _of(pair: str, numbers: dict[str, Variable], which: str) -> dict[str, Variable]:
    return {
        f"{pair}_{name}": replace(variable, long_name=f"{variable.long_name}, {pair} pair, {which}")
        for name, variable in numbers.items()
    }


def _every(numbers: dict[str, Variable], which: str) -> dict[str, Variable]:
    return {**_of("torus", numbers, which), **_of("standard", numbers, which)}


_SIDE_BY_SIDE = Beside(
    columns=("torus pair", "standard pair"),
    rows={
        **{
            f"{variable.long_name}, from rest": (f"torus_{name}", f"standard_{name}")
            for name, variable in _OF_MOTION.items()
            if name not in _HIDDEN
        },
        **{
            f"{variable.long_name}, steady state": (f"torus_{name}", f"standard_{name}")
            for name, variable in _STEADY.items()
        },
        "film at the pitch point, with the radii of Hertz": (
            "torus_pitch_film",
            "standard_pitch_film",
        ),
        "pressure at the pitch point, of the ellipse and of the line": (
            "ellipse_pressure",
            "line_pressure",
        ),
    },
    note=(
        "From rest: start by the printed equations with the fitted inputs, as published. What a pair of "
        "teeth carries is drawn over the last whole mesh cycle; pair 0 is the older one. The motion runs on "
        "the stiffness of Table 1; that of the library, secant and slope, is drawn over it and is not used, "
        "but in variant hertz, which has the library's secant and the radii of Hertz: there the torus radii "
        "act. As published the film of the torus pair takes the effective radius R' = c rho_1 of the pinion "
        "alone; the last rows have the films with the radii of Hertz. By the printed signs friction drives "
        "both gears behind the pitch point and brakes both before it: its power is 2 mu F v_e with the sign "
        "of the sliding, not the loss -mu F |v_s|, and what lies between the two is energy from nothing. In "
        "steady state: the corrected equations with the same springs, the error once in a mesh cycle, "
        "friction against the sliding, pressures and films by the radii of Hertz, and rolling per width; the "
        "stiffness follows the place of the pinion and not time, and the energy balances. A pinion held at "
        "speed, formulas.steady_pinion, is for slow drives: teeth that store much of the kinetic energy of "
        "the discs stop them under a constant torque."
    ),
    curves=tuple(_curves()),
    solves={"steady state": tuple(f"{pair}_steady_status" for pair in PAIRS)},
)

PUBLICATION = Publication(
    name="liu_xiong_2017",
    readings=("pitchpoint.published.liu_xiong_torus.printed:readings",),
    variables={
        **_GEOMETRY,
        **_AT_PITCH,
        **_BESIDE,
        **_every(_OF_MOTION, "from rest"),
        **_every({**_STEADY, **_STATUS}, "steady state"),
        **_every({**_COURSES, **_PRINTED_COURSES}, "from rest"),
        **_every(_STIFFNESS, "of the case"),
        **_every(
            {f"steady_{name}": variable for name, variable in _COURSES.items()}, "steady state"
        ),
        **_PLACES,
        **_STEADY_RATIOS,
    },
    beside=(_SIDE_BY_SIDE,),
    courses=_dimensions(),
    answers=(
        *("error_ratio", "friction_ratio", "torus_less_standard_efficiency"),
        *("printed_film_ratio", "film_ratio"),
    ),
    sections=("formulas",),
    stiffness=(
        "The motion of the publication does not run on this stiffness but on the values of its Table 1, "
        'and on those given for the standard pair, unless formulas.stiffness is "library". Both are drawn '
        "over each other among the formulas of the publication. The mesh stiffness here is the slope "
        "dF_n/dδ of the library at the torque of the case."
    ),
)
