"""What Xu et al. (2021) print beside what the library computes, as quantities of a result."""

from dataclasses import replace

from pitchpoint.published.conjugate_variables import OF_CONJUGATES
from pitchpoint.published.publication import Beside, Curves, Maps, Publication, Read, ReadingPoint
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.results.variable import (
    Variable,
    angle,
    deviation,
    dimensionless,
    force,
    length,
    oil_viscosity,
    percent,
    pressure,
    rotational_speed,
    speed,
    stiffness,
    temperature,
    torque,
)

__all__ = ["PUBLICATION"]

_VARIABLES = {
    "largest_tooth_force": force("largest tooth force", "F_0"),
    "one_zone_tooth_force": force("largest tooth force if one zone carried all", "F_0"),
    "printed_largest_tooth_force": force("largest tooth force, formula as printed", "F_0"),
    "printed_least_tooth_force": force("least tooth force, formula as printed", "F_min"),
    "recovered_torque": torque("torque that the tooth forces carry", "T"),
    "tooth_ratio": dimensionless("teeth of the flexspline over tooth difference", "i"),
    "base_radius_flexspline": length("base radius of the flexspline", "r_b1"),
    "base_radius_circular_spline": length("base radius of the circular spline", "r_b2"),
    "printed_radius_root": length(
        "relative radius on the long axis, formula as printed", "R", shown="m"
    ),
    "printed_radius_10": length(
        "relative radius at 10 degrees, formula as printed", "R", shown="m"
    ),
    "printed_radius_end": length(
        "relative radius at the end of the zone, formula as printed", "R", shown="m"
    ),
    "conformal_angle": angle("angle at which the printed radii of curvature agree", "φ"),
    "least_opposed_speed": speed("least mesh point speed, tangential parts opposed", "u"),
    "largest_opposed_speed": speed("largest mesh point speed, tangential parts opposed", "u"),
    "least_added_speed": speed("least mesh point speed, tangential parts added", "u"),
    "largest_added_speed": speed("largest mesh point speed, tangential parts added", "u"),
    "viscosity": oil_viscosity("viscosity without pressure by Roelands' law", "η"),
    "printed_viscosity": oil_viscosity("viscosity without pressure, formula as printed", "η"),
    "effective_modulus": pressure("equivalent modulus", "E'", shown="GPa"),
    "composite_roughness": deviation("composite Rq", "σ"),
}


def _plain(long_name: str, symbol: str) -> Variable:
    return dimensionless(long_name, symbol)


def _turning(long_name: str) -> Variable:
    return rotational_speed(long_name, "n")


def _radius(long_name: str) -> Variable:
    return length(long_name, "R", shown="m")


_OF_ENVELOPE = {
    "axis_speed": speed("mesh point speed on the long axis, eq. 3", "u"),
    "zone_end_speed": speed("mesh point speed at the end of the zone", "u"),
    "conjugate_film_ratio_root": _plain("film of the envelope over roughness, root", "λ"),
    "conjugate_film_ratio_tip": _plain("film of the envelope over roughness, tip", "λ"),
    "conjugate_speed_of_one_root": _turning(
        "speed at which the film of the envelope is as thick as the roughness, root"
    ),
    "conjugate_speed_of_one_tip": _turning(
        "speed at which the film of the envelope is as thick as the roughness, tip"
    ),
}

_OF_FILM = {
    "film_ratio": _plain("mean film over roughness", "λ"),
    "asperity_share": percent("part of the load on asperities", "W"),
    "film_stiffness": stiffness("stiffness of the film, load over separation", "k"),
    "printed_film_stiffness": stiffness("stiffness of the film by eq. 16", "k_oil"),
}

_ZONE = {
    "zone_radius": _radius("relative radius over the zone, eq. 2"),
    "zone_added_speed": speed("mesh point speed over the zone, tangential parts added", "u"),
    "zone_opposed_speed": speed("mesh point speed over the zone, tangential parts opposed", "u"),
}

_LOADS = {
    "tooth_printed_load": force("load of the teeth, eq. 6 as printed", "F"),
    "tooth_closed_load": force("load of the teeth that closes the torque", "F"),
}

_COURSES = {
    "film_speed": _OF_FILM,
    "film_temperature": {f"warm_{name}": variable for name, variable in _OF_FILM.items()},
    "film_place": {
        "ridge_pressure": pressure("pressure along the face, highest across", "p"),
        "ridge_film": deviation("film along the face, on the contact line", "h"),
    },
    "film_cut": {
        "cut_pressure": pressure("pressure across the contact, middle of the face", "p"),
        "cut_film": deviation("film across the contact, middle of the face", "h"),
    },
    "film_map": {
        "map_pressure": pressure("pressure over the contact, row by row", "p"),
        "map_film": deviation("film over the contact, row by row", "h"),
    },
}
"""Courses of a point, by what they run over."""

_AXES = {
    "zone_angle": angle("angle from the long axis", "φ"),
    "counted_angle": angle("angle of a tooth from the long axis", "φ"),
    "tooth_angle": angle("angle of a tooth from the long axis", "φ"),
    "film_speed": _turning("speed of the wave generator"),
    "film_temperature": temperature("temperature of the oil", "T"),
    "film_place": _plain("place along the face, over its width", "y/b"),
    "film_cut": _plain("place across the contact, over the half-width", "x/a"),
    "film_map_x": _plain("place across the contact, over the half-width", "x/a"),
    "film_map_y": _plain("place along the face, over its width", "y/b"),
}

_TEETH = {
    "tooth_entrainment": speed("entrainment at the teeth, eq. 3 and its factor", "u"),
    "tooth_film_ratio": _plain("mean film over roughness at the teeth", "λ"),
    "tooth_asperity_share": percent("part of the load on asperities at the teeth", "W"),
    "tooth_film_stiffness": stiffness(
        "stiffness of the film, load over mean film, at the teeth", "k"
    ),
    "tooth_printed_stiffness": stiffness("stiffness of the film by eq. 16 at the teeth", "k_oil"),
}

_OF_TEETH = {
    "teeth_of_zone": _plain("teeth of a zone that eq. 5 loads", "2N + 1"),
    "teeth_with_films": _plain(
        "teeth from the long axis on for which eqs. 1 to 5 give a contact", "n"
    ),
    "mean_tooth_film_ratio": _plain("mean film over roughness, mean of these teeth", "λ"),
    "mean_tooth_asperity_share": percent(
        "part of the load on asperities, mean of these teeth", "W"
    ),
    "mean_tooth_film_stiffness": stiffness(
        "stiffness, load over mean film, mean of these teeth", "k"
    ),
    "mean_tooth_printed_stiffness": stiffness("stiffness by eq. 16, mean of these teeth", "k_oil"),
    "thick_film_stiffness": _plain(
        "stiffness by eq. 16 at the tooth with the thickest film, over the mean of these teeth",
        "k/k",
    ),
    "high_pressure_stiffness": _plain(
        "stiffness by eq. 16 at the tooth with the highest pressure, over the mean of these teeth",
        "k/k",
    ),
    "tooth_printed_stiffness_step": stiffness(
        "stiffness by eq. 16, largest change from a tooth to the next", "Δk_oil"
    ),
}

_OF_POINT = {
    "point_radius": _radius("relative radius, eq. 2"),
    "point_load": force("load, eqs. 5 and 6", "F"),
    "point_entrainment": speed("entrainment, eq. 3 and its factor", "u"),
    "half_width": length("half-width of the dry contact", "a"),
    "speed_of_one": _turning("speed at which the film is as thick as the roughness"),
    "temperature_of_one": temperature(
        "temperature at which the film is as thick as the roughness", "T"
    ),
    "slow_share": percent("part of the load on asperities at 100 rpm", "W"),
    "rated_film_ratio": _plain("mean film over roughness at the operating point", "λ"),
    "rated_asperity_share": percent("part of the load on asperities at the operating point", "W"),
    "rated_film_stiffness": stiffness("stiffness of the film at the operating point", "k"),
    "coarse_film_ratio": _plain("mean film over roughness there, on the grid of the courses", "λ"),
    "misprinted_speed_of_one": _turning("the same speed of the oil by eq. 12 as printed"),
    "end_pressure": _plain(
        "pressure a quarter of a half-width from the ends over that in the middle", "p/p"
    ),
    "end_film": _plain("film there over that in the middle", "h/h"),
    "peak_place": _plain("place of the highest pressure across, over the half-width", "x/a"),
    "pressure_peaks": _plain("peaks of the pressure across, middle of the face", "n"),
    "entry_film": _plain("film where the dry contact begins over that where it ends", "h/h"),
    "film_spread": _plain(
        "spread of the film within half the half-width, over that at x = 0", "Δh/h"
    ),
    "late_film_gain": _plain(
        "film that a turn adds in the last step of the speed, over that in the step before", "Δλ/Δλ"
    ),
    "late_share_gain": _plain(
        "load that a turn takes off asperities in the last step of the speed, over that in the step before",
        "ΔW/ΔW",
    ),
}
"""Numbers of a point."""

_NAMES = ("a", "b")


def _pair(name: str) -> tuple[str, ...]:
    return tuple(f"{name}_{point}" for point in _NAMES)


def _of_points(numbers: dict[str, Variable]) -> dict[str, Variable]:
    return {
        f"{name}_{point}": replace(
            variable, long_name=f"{variable.long_name}, point {point.upper()}"
        )
        for name, variable in numbers.items()
        for point in _NAMES
    }


def _curves(along: str, shows: str) -> tuple[Curves, ...]:
    return tuple(
        Curves(
            variable.long_name,
            along,
            _pair(name),
            shows="" if variable.kind == "stiffness" else shows,
        )
        for name, variable in _COURSES[along].items()
    )


_ZONE_BESIDE = Beside(
    columns=("as printed", "envelope"),
    rows={
        "relative radius on the long axis, and of the envelope at the root": (
            "printed_radius_root",
            "deep_radius_root",
        ),
        "relative radius at 10 degrees, and of the envelope at the tip": (
            "printed_radius_10",
            "deep_radius_tip",
        ),
        "mesh point speed on the long axis, and entrainment of the envelope at the root": (
            "axis_speed",
            "deep_entrainment_root",
        ),
        "mesh point speed at the end of the zone, and entrainment of the envelope at the tip": (
            "zone_end_speed",
            "deep_entrainment_tip",
        ),
    },
    note=(
        "Relative radius and mesh point speed by eqs. 1 to 3, beside those of the envelope that flanks of"
        " the case touch. The map of the mesh point is an input of the case and assumed. Where both radii"
        " of curvature of eq. 1 agree, eq. 2 changes its sign: beyond that angle it gives no contact. The"
        " curve leaves out radii beyond 20 m. Eq. 6 as printed counts teeth that would pull."
    ),
    curves=(
        Curves(
            "relative radius over the zone",
            "zone_angle",
            ("zone_radius",),
            ("eq. 2",),
            shows="Figure 5",
        ),
        Curves(
            "mesh point speed over the zone",
            "zone_angle",
            ("zone_added_speed", "zone_opposed_speed"),
            ("eq. 3, tangential parts added", "opposed"),
            shows="Figure 5",
        ),
        Curves(
            "load of the teeth",
            "counted_angle",
            tuple(_LOADS),
            ("eq. 6 as printed", "teeth of both zones that eq. 5 loads"),
            shows="Figure 6",
        ),
    ),
)

_ENVELOPE = Beside(
    columns=("root, point A", "tip, point B"),
    rows={
        "film of the envelope over roughness": (
            "conjugate_film_ratio_root",
            "conjugate_film_ratio_tip",
        ),
        "speed at which that film is as thick as the roughness": (
            "conjugate_speed_of_one_root",
            "conjugate_speed_of_one_tip",
        ),
    },
    note=(
        "Films that the envelope's radius and entrainment make by Moes' law, under the load that closes "
        "the torque, fully flooded and isothermal: an upper bound."
    ),
)

_FILMS = Beside(
    columns=("point A", "point B"),
    rows={variable.long_name: _pair(name) for name, variable in _OF_POINT.items()},
    note=(
        "Films of one tooth at the root (A) and at the tip (B) of the zone, solved on the whole contact "
        "line, with load and radius by eqs. 1 to 6 and the oil of the case. Stiffness stands by two "
        "definitions: the load over the separation that the film adds to the dry contact, which wavers "
        "with the grid, and by eq. 16 the load step over the fall of the mean film, on a line without "
        "ends. Half spaces hold where the half-width is small against the height of a tooth. "
        "The maps end two and a half half-widths ahead of the contact."
    ),
    calibrated=(
        "The factors on eq. 3, formulas.entrainment_factor, are set so that the film is as thick as the "
        "roughness at the speeds of section 3.2, and the density of summits, formulas.eta_beta_sigma, "
        "for the load on asperities in A."
    ),
    curves=(
        *_curves("film_place", "Figure 8"),
        *_curves("film_cut", "Figure 8"),
        *_curves("film_speed", "Figure 9"),
        *_curves("film_temperature", "Figure 10"),
    ),
    maps=tuple(
        Maps(
            f"{variable.long_name.removesuffix(', row by row')}, point {point.upper()}",
            ("film_map_x", "film_map_y"),
            f"{name}_{point}",
            shows="Figure 8",
        )
        for point in _NAMES
        for name, variable in _COURSES["film_map"].items()
    ),
    solves={"films": _pair("films_status")},
)

_TEETH_BESIDE = Beside(
    columns=("",),
    rows={variable.long_name: (name,) for name, variable in _OF_TEETH.items()},
    note=(
        "Every tooth from the long axis on, those on its other side being alike: films on lines without "
        "ends. The factor on eq. 3 lies between those of A and B. Teeth beyond the angle at which eq. 2 "
        "changes its sign have loads and no films. Stiffness can jump only where one tooth comes to carry "
        "alone."
    ),
    families=tuple(
        Curves(variable.long_name, "tooth_angle", (name,), shows=shows)
        for (name, variable), shows in zip(
            _TEETH.items(),
            ("", "", "", "Figure 11", "Figure 11"),
            strict=True,
        )
    ),
    solves={"films": ("teeth_status",)},
)


def _films(point: ReadingPoint) -> Read:
    """Films of the zone; the solver is imported when a case asks for them."""
    if not isinstance(point.formulas, ZoneFilms) or point.formulas.solves == "nothing":
        return {}
    from pitchpoint.published.xu2021.zone_films import films_at

    return films_at(point)


PUBLICATION = Publication(
    name="xu_2021",
    readings=(
        "pitchpoint.published.xu2021.readings:readings",
        "pitchpoint.published.xu2021.kinematics:readings",
        _films,
    ),
    variables={
        **_VARIABLES,
        **OF_CONJUGATES,
        **_OF_ENVELOPE,
        **_AXES,
        **_ZONE,
        **_LOADS,
        **_TEETH,
        **_OF_TEETH,
        "teeth_status": _plain("status of the films of the teeth", ""),
        **_of_points(_OF_POINT),
        **_of_points({"films_status": _plain("status of the films", "")}),
        **_of_points({k: v for courses in _COURSES.values() for k, v in courses.items()}),
    },
    beside=(_ZONE_BESIDE, _ENVELOPE, _FILMS, _TEETH_BESIDE),
    courses={
        **{along: f"{along}_place" for along in _AXES},
        **{
            name: f"{along}_place"
            for along, courses in _COURSES.items()
            for course in courses
            for name in _pair(course)
        },
        **dict.fromkeys(_ZONE, "zone_angle_place"),
        **dict.fromkeys(_LOADS, "counted_angle_place"),
        **dict.fromkeys(_TEETH, "tooth_angle_place"),
    },
    answers=(
        *("speed_of_one_a", "speed_of_one_b", "temperature_of_one_a", "temperature_of_one_b"),
        *("slow_share_a", "slow_share_b"),
    ),
    sections=("drive", "film"),
)
