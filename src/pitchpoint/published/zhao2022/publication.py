"""What Zhao et al. (2022) print beside what the library computes, as quantities of a result."""

from dataclasses import replace

from pitchpoint.published.conjugate_variables import OF_CONJUGATES
from pitchpoint.published.publication import Beside, Curves, Publication
from pitchpoint.results.variable import (
    Variable,
    angle,
    deviation,
    dimensionless,
    force,
    length,
    percent,
    pressure,
    temperature,
    temperature_rise,
    torque,
)

__all__ = ["BRANCHES", "PUBLICATION"]

BRANCHES = ("deep", "outer")

_VARIABLES = {
    "largest_tangential_load": pressure(
        "largest tangential load per face width and length of the ring", "q_t"
    ),
    "largest_tooth_force": force("largest tooth force", "F_0"),
    "printed_least_tooth_force": force("least tooth force, formula as printed", "F_min"),
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


def _plain(long_name: str, symbol: str) -> Variable:
    return dimensionless(long_name, symbol)


_WEAR = {
    "wear_rate": Variable(
        long_name="depth per pressure, sliding and cycle",
        symbol="κ",
        unit="1/Pa",
        shown="1/Pa",
        kind="pressure-viscosity coefficient",
    ),
    "wear_depth": length("largest wear depth of the flexspline's flank", "h"),
    "wear_depth_without_offset": length("the same without the turn of the teeth", "h"),
    "wear_depth_change": deviation("its change with twice the points", "Δh"),
    "wear_from_offset": deviation("part of the depth that comes from the turn of the teeth", "Δh"),
    "depth_growth": _plain("wear depth at the tip, 6.28e9 over 2.56e9 cycles", "h/h"),
    "wear_pressure_new": pressure("contact pressure at the tip of new flanks", "p"),
    "wear_long_step": length("sliding step at the tip after 2e10 cycles", "s"),
    "severe_depth": length("wear depth at which wear is severe", "h"),
    "severe_wear_cycles": _plain("cycles until severe wear", "N"),
    "severe_pressure": pressure("contact pressure at the tip when wear becomes severe", "p"),
    "severe_pressure_ratio": _plain(
        "contact pressure at the tip when wear becomes severe over that of new flanks", "p/p"
    ),
    "onset_over_involute": _plain("cycles until severe wear over those of involute teeth", "N/N"),
    "depth_over_involute": _plain(
        "largest wear depth over that of involute teeth at the same point", "h/h"
    ),
    "pressure_over_involute": _plain(
        "largest contact pressure over that of involute teeth at the same point", "p/p"
    ),
    "step_over_involute": _plain(
        "largest sliding step over that of involute teeth at the same point", "s/s"
    ),
    "tip_flash": temperature_rise("flash temperature at the tip, at most", "ΔT"),
    "contact_temperature": temperature("contact temperature at the tip, bulk and flash", "T_s"),
    "adsorbed_film_defect": _plain("fractional film defect", "ψ"),
    "film_defect_ratio": _plain("fractional film defect over that of the reference", "ψ/ψ"),
    "wear_regression_ratio": _plain("wear coefficient over that of the reference, eq. 29", "K/K"),
    "asperity_regression": percent("part of the load on asperities by eq. 9", "L_a"),
    "tip_asperity_share": percent("the same, held at all of the load", "L_a"),
    "asperity_share_ratio": _plain("part of the load on asperities over the reference", "L_a/L_a"),
    "asperity_regression_status": _plain("status of eq. 9", ""),
    "wear_march_status": _plain("status of the march of wear", ""),
    "lubricated_over_dry": _plain("wear depth lubricated over dry", "h/h"),
    "dry_coefficient": _plain("wear coefficient of dry flanks", "K"),
    "dry_depth": length("largest wear depth of dry flanks", "h"),
    "dry_orders": _plain("powers of ten between dry and lubricated depth", ""),
}
"""Numbers of the wear."""

_OF_COEFFICIENT = (
    *("wear_regression_ratio", "film_defect_ratio", "asperity_share_ratio"),
    *("asperity_regression", "tip_asperity_share", "adsorbed_film_defect"),
    *("contact_temperature", "dry_coefficient", "lubricated_over_dry", "dry_depth"),
)
"""What moves the coefficient."""

_STATES = {"new": "new", "early": "2.56e9 cycles", "late": "6.28e9 cycles"}
"""Flanks of section 4.4 by the end of a name."""

_AT_TIP = {
    "tip_depth": length("wear depth at the tip", "h"),
    "tip_pressure": pressure("contact pressure at the tip", "p"),
    "tip_step": deviation("sliding step at the tip", "s"),
}

_ALONG = {
    "flank_way": {
        "flank_depth": deviation("wear depth along the flank", "h"),
        "flank_pressure": pressure("contact pressure along the flank", "p"),
        "flank_step": deviation("sliding step along the flank", "s"),
    },
    "flexspline_radius": {
        "flank_profile": length("half thickness of the tooth over the radius", "x")
    },
}

_LOADS = {
    "tangential_load": pressure("tangential load per face width and length of the ring", "q_t"),
    "radial_load": pressure("radial load per face width and length of the ring", "q_r"),
}
"""Loads of new flanks along the way from the tip, eq. 13."""

_DRY = "dry_flank_depth"

_BESIDE_INVOLUTE = {
    "involute_flank_depth": deviation("wear depth of involute teeth after 6.28e9 cycles", "h"),
    "involute_tip_pressure": pressure("contact pressure at the tip of involute teeth", "p"),
    "involute_tip_step": deviation("sliding step at the tip of involute teeth", "s"),
    "involute_tip_depth": length("wear depth at the tip of involute teeth", "h"),
}
"""Courses of involute teeth under the same load, over the places and cycles of the double arc."""

_OVER_CYCLES = {
    "wear_course": length("largest wear depth", "h"),
    "wear_course_without_offset": length("largest wear depth without the turn of the teeth", "h"),
    "wear_offset_error": deviation("part of the depth that comes from the turn of the teeth", "Δh"),
}

_UNTIL_SEVERE = {
    "severe_tip_pressure": pressure("contact pressure at the tip until severe wear", "p"),
    "severe_tip_step": deviation("sliding step at the tip until severe wear", "s"),
    "severe_tip_depth": length("wear depth at the tip until severe wear", "h"),
}

_PLACES = {
    "flank_way": length("way from the tip along the flank", "s"),
    "flexspline_radius": length("radius of the flexspline", "r"),
    "wear_cycles": _plain("cycles", "N"),
    "severe_course": _plain("cycles until severe wear", "N"),
}

_DIMENSIONS = {
    **{name: "flank_point" for name in ("flank_way", "flexspline_radius", *_LOADS, _DRY)},
    **{
        f"{name}_{state}": "flank_point"
        for courses in _ALONG.values()
        for name in courses
        for state in _STATES
    },
    **{name: "wear_time" for name in ("wear_cycles", *_OVER_CYCLES)},
    **{
        name: "conjugate_point"
        for name in (
            "conjugate_way",
            *(f"conjugate_course_{branch}" for branch in BRANCHES),
        )
    },
    "involute_flank_depth": "flank_point",
    **{
        name: "severe_time"
        for name in ("severe_course", *_UNTIL_SEVERE, *_BESIDE_INVOLUTE)
        if name != "involute_flank_depth"
    },
}


def _states(name: str) -> tuple[str, ...]:
    return tuple(f"{name}_{state}" for state in _STATES)


def _of_states(numbers: dict[str, Variable]) -> dict[str, Variable]:
    return {
        f"{name}_{state}": replace(variable, long_name=f"{variable.long_name}, {words}")
        for name, variable in numbers.items()
        for state, words in _STATES.items()
    }


_SHAPES = ("double arc", "involute")

_CURVES = (
    Curves(
        "loads of new flanks, q_t and q_r",
        "flank_way",
        tuple(_LOADS),
        ("tangential", "radial"),
        shows="Figure 6",
    ),
    *(
        Curves(
            f"{_UNTIL_SEVERE[f'severe_tip_{name}'].long_name}, both shapes",
            "severe_course",
            (f"severe_tip_{name}", f"involute_tip_{name}"),
            _SHAPES,
            shows=figure,
        )
        for name, figure in (("pressure", "Figure 9"), ("step", "Figure 10"), ("depth", ""))
    ),
    *(
        Curves(
            f"{course.long_name}, after cycles",
            along,
            _states(name),
            shows={"flank_profile": "Figure 11"}.get(name, ""),
        )
        for along, courses in _ALONG.items()
        for name, course in courses.items()
    ),
    Curves(
        "wear depth after 6.28e9 cycles, both shapes",
        "flank_way",
        ("flank_depth_late", "involute_flank_depth"),
        _SHAPES,
        shows="Figure 12",
    ),
    Curves(
        "wear depth over the radius after 6.28e9 cycles",
        "flexspline_radius",
        ("flank_depth_late", _DRY),
        ("mixed lubrication", "dry"),
        decades=True,
        shows="Figure 13",
    ),
    Curves(
        "largest wear depth over the cycles",
        "wear_cycles",
        ("wear_course", "wear_course_without_offset"),
        ("with the turn of the teeth", "without it"),
        shows="Figures 14 and 15",
    ),
    Curves(
        _OVER_CYCLES["wear_offset_error"].long_name,
        "wear_cycles",
        ("wear_offset_error",),
        ("with less without",),
        shows="Figure 16",
    ),
)

_FAMILIES = (
    *(
        Curves(course.long_name, "wear_cycles", (name,), shows=figure, studies=studies)
        for (name, course), figure, studies in zip(
            _OVER_CYCLES.items(),
            ("Figure 14", "Figure 15", "Figure 16"),
            (("torque", "feedback"), ("torque",), ("torque",)),
            strict=True,
        )
    ),
    *(
        Curves(
            "wear depth after 6.28e9 cycles",
            "flank_way",
            ("flank_depth_late",),
            shows=figure,
            studies=(study,),
        )
        for study, figure in (
            ("module", "Figure 17"),
            ("face_width", "Figure 19"),
            ("hardness", "Figure 20"),
        )
    ),
)

_STRIPS = Beside(
    columns=tuple(_STATES.values()),
    rows={variable.long_name: _states(name) for name, variable in _AT_TIP.items()},
    note=(
        "Wear by the discrete model of the paper: prescribed load with its largest force at the tip, strips "
        "one pitch step long, a coefficient that stays as it is while the load changes. Double-arc and "
        "involute teeth have the same torque, speed, hardness, coefficient and length of the worn part of "
        "the flank; the involute is that of Table 1, the arcs are assumed. Everything is uniform along the "
        "face. A point stands for a pitch: with twice the points strips are half as long and the pressure is "
        "twice as high, and the depth changes as stated. Dry flanks wear in the shape of the reference, "
        "deeper by its film, which would be more than the tooth has, and know nothing of the oil. With the "
        "module grow all of the teeth, the length of the worn part of the flank, the deflection and the "
        "depth at which wear is severe; rim, face width, torque and the steps of the angle stay. With the "
        "face width nothing else changes, and so the depth falls as one over it but for the change of the "
        "flank. Stresses of the ring, Figure 18, are taken from another publication and follow from no "
        "equation of this one."
    ),
    calibrated=(
        "Calibrated are the wear coefficient (for 0.0557 mm), the length of the flank (for a step of 0.021 "
        "mm), the depth at which wear is severe (for 4e10 cycles) and the heat of adsorption (for three "
        "powers of ten to dry wear). The area of new strips, by which the pressure follows the worn slope, "
        "was chosen in view of the ratio of depths over the torque. The double-arc profile is not published: "
        "its arcs were chosen after others, shown beside them, had missed the cycles until severe wear. So "
        "the agreement of the default arcs shows that the printed numbers are consistent with one simple "
        "model; it does not validate the model. With the other arcs the ratios over the torque and the share "
        "of the turn of the teeth still come out, the order of double-arc and involute teeth does not."
    ),
    curves=_CURVES,
    families=_FAMILIES,
)

_MIXED = Beside(
    columns=("value",),
    rows={_WEAR[name].long_name: (name,) for name in _OF_COEFFICIENT},
    note=(
        "What carries the wear coefficient from its reference to this contact: eq. 29 its K by modulus, oil "
        "and roughness, eq. 10 the film defect by sliding speed and temperature, eq. 9 the load on "
        "asperities. The load in them is that of the reference whatever the torque, unless the case says "
        "otherwise. Dry flanks have the K of the reference."
    ),
    solves={
        "load on asperities by eq. 9": ("asperity_regression_status",),
        "march of wear": ("wear_march_status",),
    },
)

_ON_BRANCHES = {
    "conjugate_depth": length("largest wear depth by the conjugate kinematics", "h"),
    "conjugate_angle": angle("angle from the long axis where it is largest", "p"),
    "conjugate_way": length("way from the tip where it is largest", "s"),
}

_CONJUGATE = {
    f"{name}_{branch}": replace(variable, long_name=f"{variable.long_name}, {branch} branch")
    for name, variable in {
        **_ON_BRANCHES,
        "conjugate_course": length("wear depth along the flank by the conjugate kinematics", "h"),
    }.items()
    for branch in BRANCHES
}

_TOUCHING = Beside(
    columns=tuple(f"{branch} branch" for branch in BRANCHES),
    rows={
        variable.long_name: tuple(f"{name}_{branch}" for branch in BRANCHES)
        for name, variable in _ON_BRANCHES.items()
    },
    note=(
        "Wear where the flank touches its envelope: line load times sliding over rolling of the conjugate "
        "kinematics, with tooth forces by the cosine of the paper as it closes the torque, on points whose "
        "relative radius is positive within 36 degrees. The specific wear rate is assumed, so that only the "
        "shape and the comparison of teeth mean anything; flanks stay as they are, and neither a load on "
        "asperities nor a film defect is counted beside the rate. Double-arc teeth wear where the convex arc "
        "ends and not at the tip; involute teeth touch near the long axis alone and hardly slide there. A "
        "positive radius is not yet contact: on the other arcs nothing of the outer branch touches (see "
        "their clearance). [wear] in a case file marches with loads from stiffness instead."
    ),
    curves=(
        Curves(
            "wear depth along the flank by the conjugate kinematics",
            "conjugate_way",
            tuple(f"conjugate_course_{branch}" for branch in BRANCHES),
        ),
    ),
)

PUBLICATION = Publication(
    name="zhao_2022",
    readings=(
        "pitchpoint.published.zhao2022.printed:readings",
        "pitchpoint.published.conjugate:readings",
        "pitchpoint.published.zhao2022.flexspline_wear:readings",
        "pitchpoint.published.zhao2022.conjugate_wear:readings",
    ),
    variables={
        **_VARIABLES,
        **OF_CONJUGATES,
        **_WEAR,
        **_PLACES,
        **_LOADS,
        _DRY: deviation("wear depth of dry flanks after 6.28e9 cycles", "h"),
        **_CONJUGATE,
        "conjugate_way": length("way from the tip along the flank", "s"),
        **_OVER_CYCLES,
        **_UNTIL_SEVERE,
        **_BESIDE_INVOLUTE,
        **_of_states(_AT_TIP),
        **_of_states(
            {name: variable for courses in _ALONG.values() for name, variable in courses.items()}
        ),
    },
    beside=(_STRIPS, _MIXED, _TOUCHING),
    courses=_DIMENSIONS,
    answers=(
        *("wear_depth", "severe_wear_cycles", "lubricated_over_dry"),
        *("onset_over_involute", "conjugate_depth_outer"),
    ),
    sections=("drive", "wear"),
)
