"""What Tian et al. (2024) draw beside what the library computes, as quantities of a result.

Its laws of friction stand in `friction`, and any case may name them.
"""

from dataclasses import replace

from pitchpoint.published.publication import Beside, Curves, Publication, Read, ReadingPoint
from pitchpoint.published.tian2024.table import PairOnPath
from pitchpoint.results.variable import Variable, dimensionless, percent, torque

__all__ = ["PUBLICATION"]

_METHODS = {"average": "average friction coefficient", "varying": "time-varying one"}

_ENDS = {
    "entry": "at entry",
    "double": "at the end of the first double contact",
    "single": "at the start of single contact",
    "exit": "at exit",
}


def _plain(long_name: str, symbol: str) -> Variable:
    return dimensionless(long_name, symbol)


_COURSES = {
    "force": _plain("force of the pair over the whole one without friction", "β"),
    "friction": _plain("friction coefficient of the pair", "μ"),
    "other_friction": _plain("friction coefficient of the other pair in mesh", "μ"),
    "efficiency": percent("efficiency where the pair is", "η"),
    "input_torque": torque("input torque where the pair is", "T_in"),
}

_TABLE_3 = {
    "hohn": "Höhn",
    "diez_ibarbia": "Diez-Ibarbia et al.",
    "average": "Method I",
    "varying": "Method II",
}


def _of_methods(name: str) -> tuple[str, ...]:
    return tuple(f"{name}_{method}" for method in _METHODS)


_NUMBERS = {
    f"load_share_{end}": _plain(f"share of the load {words}", "λ") for end, words in _ENDS.items()
} | {
    f"force_{end}_{method}": _plain(f"{_COURSES['force'].long_name} {place}, {words}", "β")
    for end, place in _ENDS.items()
    for method, words in _METHODS.items()
}

_STATEMENTS = {
    "force_excess_average": _plain(
        "least force of the pair in double contact, average coefficient less none", "Δβ"
    ),
    "force_excess_varying": _plain(
        "least force of the pair in double contact, time-varying coefficient less average", "Δβ"
    ),
    "friction_excess": _plain(
        "least coefficient in double contact, time-varying less average", "Δμ"
    ),
    **{
        f"efficiency_step_{method}": percent(
            f"least efficiency of single contact less largest of double contact, {words}", "Δη"
        )
        for method, words in _METHODS.items()
    },
}

_ALONG = {
    "pair_share": _plain("force of the pair over the whole one, without friction", "β"),
    **{
        f"pair_{name}_{method}": replace(variable, long_name=f"{variable.long_name}, {words}")
        for name, variable in _COURSES.items()
        for method, words in _METHODS.items()
    },
}

_COMPARED = {
    f"compared_{method}": percent(f"instantaneous efficiency, {words}", "η")
    for method, words in _TABLE_3.items()
}

_ON_PATH = Beside(
    columns=("without friction", *_METHODS.values()),
    rows={
        f"force {place} over that without friction": (
            f"load_share_{end}",
            *_of_methods(f"force_{end}"),
        )
        for end, place in _ENDS.items()
    },
    note=(
        "One pair of teeth from its entry into mesh to its exit, over the base pitches since it entered. "
        "Without friction its force is the share of the load of eq. 11, with it that of the balance of "
        "torques, eq. 16, over the force at the base circle of the driven gear. The other pair is the one "
        "that shares the load in double contact."
    ),
    curves=(
        Curves(
            "friction coefficients of the pair and of the other one",
            "pair_path",
            (*_of_methods("pair_friction"), *_of_methods("pair_other_friction")),
            (
                *(f"{method}, this pair" for method in _METHODS.values()),
                *(f"{method}, other pair" for method in _METHODS.values()),
            ),
            shows="Figure 4",
        ),
        Curves(
            "force of the pair over the whole one without friction",
            "pair_path",
            (*_of_methods("pair_force"), "pair_share"),
            (*_METHODS.values(), "without friction"),
            shows="Figure 5",
        ),
        Curves(
            "efficiency",
            "pair_path",
            _of_methods("pair_efficiency"),
            tuple(_METHODS.values()),
            shows="Figures 6 and 8",
        ),
        Curves(
            "input torque",
            "pair_path",
            _of_methods("pair_input_torque"),
            tuple(_METHODS.values()),
            shows="Figures 7 and 8",
        ),
    ),
)

_BY_METHOD = Beside(
    columns=tuple(_TABLE_3.values()),
    rows={
        "mean efficiency, Table 3 and Figure 12a": tuple(f"table_3_{method}" for method in _TABLE_3)
    },
    note=(
        "The methods that Table 3 compares: Höhn's has one coefficient of the whole load and the loss "
        "factor, so one efficiency for the whole path; that of Diez-Ibarbia et al. is Method I without its "
        "factor 2. The fifth one, by Wang et al., is in another publication."
    ),
    calibrated=(
        "The conditions of Table 3 are not printed. The viscosity was chosen for the mean of Method I, "
        "and both readings of the compared methods with their numbers in view."
    ),
    curves=(
        Curves(
            "efficiency by the methods of Table 3",
            "pair_path",
            tuple(_COMPARED),
            shows="Figure 12b",
        ),
    ),
)


def _on_path(point: ReadingPoint) -> Read:
    """Courses of a pair; the code is imported when a case asks for them."""
    if not isinstance(point.formulas, PairOnPath):
        return {}
    from pitchpoint.published.tian2024.pair_on_path import readings

    return readings(point)


PUBLICATION = Publication(
    name="tian_2024",
    readings=(_on_path,),
    variables={
        "pair_path": _plain("base pitches since the pair entered", "B_1K_1/p_b"),
        **_NUMBERS,
        **_STATEMENTS,
        **_ALONG,
        **{
            f"table_3_{method}": percent(f"mean efficiency, {words}", "η")
            for method, words in _TABLE_3.items()
        },
        **_COMPARED,
    },
    beside=(_ON_PATH, _BY_METHOD),
    courses=dict.fromkeys(("pair_path", *_ALONG, *_COMPARED), "path_place"),
    sections=("path", "cycle", "studies"),
)
