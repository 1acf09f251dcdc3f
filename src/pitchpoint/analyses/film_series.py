"""Films as springs in series with all else that yields in a drive."""

from collections.abc import Mapping

import numpy as np

from pitchpoint.analyses.analysis import Unasked
from pitchpoint.analyses.film_contacts import cycle_engagement
from pitchpoint.analyses.lacking import rigid
from pitchpoint.analyses.torsion import wound_ups
from pitchpoint.cases.built import Built
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError

__all__ = ["check_series", "series_figures"]


def check_series(built: Built) -> None:
    """InputError if films are asked to count in the torsional stiffness of gears that have none."""
    assert built.case.film is not None
    if not built.case.film.in_series:
        return
    if not built.transmits or built.travels:
        raise InputError("is for gears whose output turns under a torque", key="film.in_series")
    if not built.case.operation.load > 0.0:
        raise InputError(
            "films are springs under a load, and nothing is carried at the operating point",
            key="film.in_series",
        )
    why = rigid(built)
    if why is not None and not isinstance(why, Unasked):
        raise InputError(why, key="film.in_series")


def series_figures(
    built: Built, states: Mapping[str, np.ndarray], found: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Torsional stiffness of the loaded member at the operating point, of films, without and with them.

    A contact under the force F whose film yields by dh for dF adds dh F/T to the rotation under the torque T
    (virtual work), with forces in proportion to the torque. Films are those at the speed of the operating
    point: at rest there are none. What films take is withheld if that of a loaded contact is missing.

    Args:
        built: the case.
        states: what its contacts carry [phase, ...].
        found: their films, with `film_stiffness` and `film_status`.
    """
    torque = float(built.case.operation.load)
    loaded = states["loaded"]
    force = np.where(loaded, states["load"], 0.0)
    solved = found["film_status"] == int(Code.SOLVED)
    missing = bool(np.any(loaded & ~solved)) or not loaded.any()
    with np.errstate(divide="ignore", invalid="ignore"):
        yields = np.where(loaded, force**2 / found["film_stiffness"], 0.0)
    compliance = np.sum(yields, axis=(-2, -1)) / torque**2
    (wound,), _ = wound_ups(built, cycle_engagement(built), np.array([torque]))
    dry, weight = np.asarray(wound.stiffness), states["weight"]
    complete = np.nan if missing else 1.0
    return {
        "film_torsional_stiffness": np.asarray(complete / (compliance @ weight)),
        "stiffness_without_films": np.asarray(1.0 / (1.0 / dry @ weight)),
        "stiffness_with_films": np.asarray(complete / ((1.0 / dry + compliance) @ weight)),
    }
