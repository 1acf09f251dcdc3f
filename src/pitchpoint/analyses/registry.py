"""All analyses, in the order in which their parts are worth having."""

from pitchpoint.analyses.along_action import (
    MOTION,
    MOTIONS,
    RESONANCE,
    START_UP,
    STIFFNESS,
    VIBRATIONS,
)
from pitchpoint.analyses.analysis import Analysis, Several
from pitchpoint.analyses.cycle import CYCLE
from pitchpoint.analyses.films import FILM, FILM_SQUEEZE, FINITE_FILM
from pitchpoint.analyses.four_quadrants import FOUR_QUADRANTS
from pitchpoint.analyses.inspection import INSPECTION
from pitchpoint.analyses.joint import JOINT
from pitchpoint.analyses.kinematic_error import KINEMATIC_ERROR
from pitchpoint.analyses.load_limits import LOAD_LIMITS
from pitchpoint.analyses.loss_map import LOSS_MAP
from pitchpoint.analyses.operation import BACK_DRIVING, LAWS_THERE, OPERATION
from pitchpoint.analyses.running import RUNNING
from pitchpoint.analyses.strength import STRENGTH
from pitchpoint.analyses.studies import STUDIES
from pitchpoint.analyses.teeth import TEETH
from pitchpoint.analyses.torsion import TORSION
from pitchpoint.analyses.wear import WEAR
from pitchpoint.registry import Registry
from pitchpoint.results.variables import VARIABLES

__all__ = ["ANALYSES", "register"]

ANALYSES: Registry[Analysis | Several] = Registry(
    "analysis",
    TEETH,
    INSPECTION,
    LOAD_LIMITS,
    CYCLE,
    OPERATION,
    LAWS_THERE,
    STRENGTH,
    FILM,
    FINITE_FILM,
    FILM_SQUEEZE,
    WEAR,
    TORSION,
    KINEMATIC_ERROR,
    JOINT,
    STIFFNESS,
    VIBRATIONS,
    RESONANCE,
    MOTION,
    MOTIONS,
    START_UP,
    STUDIES,
    RUNNING,
    LOSS_MAP,
    BACK_DRIVING,
    FOUR_QUADRANTS,
)


def register(analysis: Analysis | Several) -> None:
    """Add an analysis of one's own, with its variables, to all that are computed from now on."""
    ANALYSES.add(analysis)
    VARIABLES.update(analysis.variables)
