"""What Xu et al. (2021) print beside what the library computes, as quantities of a result."""

from dataclasses import replace

from pitchpoint.published.conjugate_variables import OF_CONJUGATES
from pitchpoint.published.publication import Beside, Curves, Point, Publication, Read
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.results.variable import (
    Variable,
    angle,
    deviation,
    length,
    percent,
    pressure,
    speed,
    stiffness,
    torque,
)

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


def _plain(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "1")


def _turning(long_name: str) -> Variable:
    return Variable(long_name, "n", "rad/s", "rpm", "rotational speed")


_COURSES = {
    "film_speed": {
        "film_ratio": _plain("mean film over roughness", "λ"),
        "asperity_share": percent("part of the load on asperities", "W"),
        "film_stiffness": stiffness("stiffness of the film", "k_oil"),
    },
    "film_place": {
        "ridge_pressure": pressure("pressure along the face, highest across", "p"),
        "ridge_film": deviation("film along the face, on the contact line", "h"),
    },
    "film_cut": {
        "cut_pressure": pressure("pressure across the contact, middle of the face", "p"),
        "cut_film": deviation("film across the contact, middle of the face", "h"),
    },
}
"""Courses of a point, by what they run over."""

_AXES = {
    "film_speed": _turning("speed of the wave generator"),
    "film_place": _plain("place along the face, over its width", "y/b"),
    "film_cut": _plain("place across the contact, over the half-width", "x/b"),
}

_OF_POINT = {
    "speed_of_one": _turning("speed at which the film is as thick as the roughness"),
    "slow_share": percent("part of the load on asperities at 100 rpm", "W"),
    "film_ratio_rise": _plain("least change of the film ratio to the next speed", "Δλ"),
    "asperity_share_rise": percent(
        "largest change of the part on asperities to the next speed", "ΔW"
    ),
    "film_stiffness_ratio": _plain(
        "stiffness of the film at the highest speed over that at 500 rpm", "k/k"
    ),
    "rated_film_ratio": _plain("mean film over roughness at the operating point", "λ"),
    "rated_asperity_share": percent("part of the load on asperities at the operating point", "W"),
    "rated_film_stiffness": stiffness("stiffness of the film at the operating point", "k_oil"),
    "misprinted_film_ratio": _plain("the film ratio of the oil by eq. 12 as printed", "λ"),
    "end_pressure": _plain(
        "pressure a quarter of a half-width from the ends over that in the middle", "p/p"
    ),
    "end_film": _plain("film there over that in the middle", "h/h"),
}
"""Numbers of a point."""

_NAMES = ("a", "b")


def _pair(name: str) -> tuple[str, ...]:
    return tuple(f"{name}_{point}" for point in _NAMES)


def _of_points(numbers: dict[str, Variable]) -> dict[str, Variable]:
    return {
        f"{name}_{point}": replace(one, long_name=f"{one.long_name}, point {point.upper()}")
        for name, one in numbers.items()
        for point in _NAMES
    }


_CURVES = tuple(
    Curves(one.long_name, along, _pair(name))
    for along, courses in _COURSES.items()
    for name, one in courses.items()
)

_FILMS = Beside(
    columns=("point A", "point B"),
    rows={one.long_name: _pair(name) for name, one in _OF_POINT.items()},
    note=(
        "Films of one tooth at the root (A) and at the tip (B) of the zone, solved on the whole contact "
        "line, with load and radius as eqs. 2 and 6 give them as printed. Entrainment at both points is "
        "calibrated: the paper does not give it, and no motion of the teeth that was tried leads to both of "
        "its speeds. Radii of a metre make contacts as wide as the flank, which half spaces do not hold for."
    ),
    curves=_CURVES,
    solves={"films": _pair("films_status")},
)


def _films(point: Point) -> Read:
    """Films of the zone; the solver is imported when a case asks for them."""
    if not isinstance(point.formulas, ZoneFilms):
        return {}
    from pitchpoint.published.xu2021.films import films_at

    return films_at(point)


PUBLICATION = Publication(
    name="xu_2021",
    readings=(
        "pitchpoint.published.xu2021.printed:readings",
        "pitchpoint.published.conjugate:readings",
        _films,
    ),
    variables={
        **_VARIABLES,
        **OF_CONJUGATES,
        **_AXES,
        **_of_points(_OF_POINT),
        **_of_points({"films_status": _plain("status of the films", "")}),
        **_of_points({k: v for courses in _COURSES.values() for k, v in courses.items()}),
    },
    beside=(_FILMS,),
    courses={
        name: f"{along}_place"
        for along, courses in _COURSES.items()
        for name in (along, *(one for course in courses for one in _pair(course)))
    },
)
