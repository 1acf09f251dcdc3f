"""What Atanasiu et al. (2011) print beside what the library computes, as quantities of a result."""

from dataclasses import replace

from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.publication import Beside, Curves, Publication, Read, ReadingPoint
from pitchpoint.results.variable import deviation, dimensionless, force, mass, percent, stiffness

__all__ = ["PUBLICATION"]

_VARIABLES = {
    "printed_undercut_limit_1": dimensionless(
        "smallest profile shift of gear 1, formula as printed", "x_min1"
    ),
    "printed_equivalent_mass": mass("equivalent mass, formula as printed", "m_e", shown="g"),
}

_PROCEDURES = {
    "integrated": "integrated along the contact line",
    "middle": "from the middle of the line",
}

_NUMBERS = {
    "pair_mean_stiffness": stiffness("mean stiffness of the mesh", "k_m"),
    "pair_stiffness_variation": percent("variation of stiffness over its mean", "Δk/k_m"),
    "pair_mean_error": deviation("mean transmission error at the first torque", "δ_a"),
    "pair_error_range": deviation(
        "variation of the transmission error at the first torque", "Δδ_a"
    ),
    "other_error_range": deviation(
        "variation of the transmission error at the second torque", "Δδ_b"
    ),
    "pair_largest_factor": dimensionless("largest dynamic factor of a pair of teeth", "c_d"),
    "pair_status": dimensionless("status of the vibration"),
}


def _of_procedures(name: str) -> tuple[str, ...]:
    return tuple(f"{name}_{procedure}" for procedure in _PROCEDURES)


_IN_TURN = {
    "stiffness": stiffness("stiffness of a pair of teeth", "k_i"),
    "factor": dimensionless("dynamic factor of a pair of teeth", "c_d"),
    "load": force("dynamic load of a pair of teeth", "F_d"),
}
"""Courses of the pair itself and of the two that follow it."""

_TEETH = ("I", "II", "III")

_COURSES = {
    **{
        f"pair_{name}_{number}": replace(
            variable, long_name=f"{variable.long_name}, pair {numeral}"
        )
        for name, variable in _IN_TURN.items()
        for number, numeral in enumerate(_TEETH, 1)
    },
    "pair_total_stiffness": stiffness("stiffness of the mesh", "k_t"),
    "pair_error": deviation("dynamic transmission error at the first torque", "δ_a"),
    "pair_other_error": deviation("dynamic transmission error at the second torque", "δ_b"),
}


def _teeth(name: str) -> tuple[str, ...]:
    return tuple(f"pair_{name}_{number}" for number in range(1, len(_TEETH) + 1))


_PAIRS = tuple(f"pair {numeral}" for numeral in _TEETH)

_MOTION = Beside(
    columns=tuple(_PROCEDURES.values()),
    rows={
        variable.long_name: _of_procedures(name)
        for name, variable in _NUMBERS.items()
        if name != "pair_status"
    },
    note=(
        "One pair of teeth from its entry into mesh to its exit, over the time in base pitches, with the "
        "pairs II and III that follow it. Both procedures for the stiffness of a contact line stand beside "
        "each other; the curves are those of its middle, which the figures of the paper show. The paper "
        "gives no numbers of its figures. At 1800 rpm the mesh is a hundredfold slower than its natural "
        "frequency: the transmission error is the static one, with a small vibration after each change of "
        "the stiffness."
    ),
    curves=(
        Curves(
            "stiffness of pairs of teeth and of the mesh",
            "pair_time",
            (*_teeth("stiffness"), "pair_total_stiffness"),
            (*_PAIRS, "mesh"),
            shows="Figure 4",
        ),
        Curves("dynamic factors", "pair_time", _teeth("factor"), _PAIRS, shows="Figure 5"),
        Curves(
            "dynamic transmission error at both torques",
            "pair_time",
            ("pair_error", "pair_other_error"),
            ("first torque", "second torque"),
            shows="Figures 6 and 7",
        ),
    ),
    over_studies=(
        Curves("stiffness of the mesh", "pair_time", ("pair_total_stiffness",), shows="Figure 4"),
        Curves(
            "stiffness of one pair of teeth", "pair_time", ("pair_stiffness_1",), shows="Figure 4"
        ),
        Curves(
            "dynamic factor of one pair of teeth", "pair_time", ("pair_factor_1",), shows="Figure 5"
        ),
        Curves("dynamic load of one pair of teeth", "pair_time", ("pair_load_1",)),
        Curves(
            "dynamic transmission error at the first torque, 0.42 N m in print",
            "pair_time",
            ("pair_error",),
            shows="Figures 6 and 7",
        ),
        Curves(
            "dynamic transmission error at the second torque, 0.3 N m in print",
            "pair_time",
            ("pair_other_error",),
            shows="Figures 6 and 7",
        ),
    ),
    solves={"vibration": _of_procedures("pair_status")},
)


def _in_motion(point: ReadingPoint) -> Read:
    """Courses of a pair; the code is imported when a case asks for them."""
    if not isinstance(point.formulas, PairInMotion):
        return {}
    from pitchpoint.published.atanasiu2011.pair_in_motion import readings

    return readings(point)


PUBLICATION = Publication(
    name="atanasiu_2011",
    readings=("pitchpoint.published.atanasiu2011.printed:readings", _in_motion),
    variables={
        **_VARIABLES,
        "pair_time": dimensionless("time since the pair entered over the meshing time", "t/t_z"),
        **{
            f"line_stiffness_difference_{name}": percent(
                f"largest difference of the stiffness by both procedures over its mean, {words}",
                "Δk_t/k_m",
            )
            for name, words in {"common": "one modulus", "separate": "separate moduli"}.items()
        },
        **{
            f"{name}_{procedure}": replace(variable, long_name=f"{variable.long_name}, {words}")
            for name, variable in _NUMBERS.items()
            for procedure, words in _PROCEDURES.items()
        },
        **_COURSES,
    },
    beside=(_MOTION,),
    courses=dict.fromkeys(("pair_time", *_COURSES), "mesh_place"),
    answers=(
        *("pair_mean_stiffness_middle", "pair_stiffness_variation_middle"),
        *("pair_mean_error_middle", "pair_error_range_middle", "pair_largest_factor_middle"),
    ),
    sections=("stiffness", "vibration", "studies"),
)
