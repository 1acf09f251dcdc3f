"""All analyses, in the order in which their parts are worth having; what computes a part is loaded for it."""

from pitchpoint.analyses.along_action import (
    MOTION,
    MOTIONS,
    RESONANCE,
    START_UP,
    STIFFNESS,
    VIBRATIONS,
)
from pitchpoint.analyses.analysis import Analysis, Several, of_gears_with
from pitchpoint.analyses.cycle import CYCLE
from pitchpoint.analyses.lacking import (
    no_bodies,
    no_deviations,
    no_duty,
    no_joint,
    no_pins,
    no_quadrants,
    of_one_mesh,
    rigid,
    without_train,
)
from pitchpoint.analyses.loss_map import LOSS_MAP
from pitchpoint.analyses.main_figures import WIND_UP, standstill_figures
from pitchpoint.analyses.operation import BACK_DRIVING, LAWS_THERE, OPERATION
from pitchpoint.analyses.running import RUNNING
from pitchpoint.analyses.solved_films import FILM, FILM_SQUEEZE, FINITE_FILM
from pitchpoint.analyses.strength import STRENGTH
from pitchpoint.analyses.studies import STUDIES
from pitchpoint.analyses.teeth import TEETH
from pitchpoint.analyses.wear import WEAR
from pitchpoint.registry import Registry
from pitchpoint.results.variables import VARIABLES

__all__ = ["ANALYSES", "register"]

INSPECTION = Analysis(
    name="inspection",
    title="inspection",
    of="mesh",
    lacks=of_gears_with(
        "inspection", "span, balls and backlash by tolerances are those of cylindrical gears"
    ),
    compute="pitchpoint.analyses.inspection:inspection_of",
    main=("backlash_angle", "span_measurement", "over_balls", "disc_mass", "disc_inertia"),
)
LOAD_LIMITS = Analysis(
    name="load_limits",
    title="load limits",
    of="mesh",
    under_load=True,
    lacks=of_gears_with("limits", "a flexspline is that of a strain wave gear"),
    compute="pitchpoint.analyses.load_limits:load_limits_of",
    main=("alternating_stress", "torsional_stress", "mean_stress", "flexspline_torque"),
)
BODIES = Analysis(
    name="bodies",
    title="bodies",
    of="mesh",
    lacks=no_bodies,
    compute="pitchpoint.analyses.bodies:bodies_of",
    main=("body_mass", "body_inertia", "reflected_inertia"),
)
REFLECTED = Analysis(
    name="reflected",
    title="backlash, mass and inertia at the ends",
    of="drive",
    lacks=of_one_mesh,
    compute="pitchpoint.analyses.reflected:reflected_of",
    main=("output_backlash", "drive_mass", "reflected_inertia"),
)
TRAIN_OVER_PERIOD = Analysis(
    name="train_period",
    title="period of the train",
    of="train",
    under_load=True,
    lacks=without_train,
    compute="pitchpoint.analyses.train_period:train_period_of",
)
PLANET_SHARING = Analysis(
    name="planet_sharing",
    title="sharing of planets",
    of="train",
    lacks=no_pins,
    compute="pitchpoint.analyses.planet_sharing:sharing_of",
    main=("planet_load_factor", "planet_share"),
)
TORSION = Analysis(
    name="torsion",
    title="torsion",
    of="drive",
    lacks=rigid,
    compute="pitchpoint.analyses.torsion:torsion_of",
    main=(*WIND_UP, "kinematic_play"),
    figures="pitchpoint.analyses.torsion:torsion_figures",
)
KINEMATIC_ERROR = Analysis(
    name="kinematic_error",
    title="kinematic error",
    of="mesh",
    under_load=True,
    lacks=no_deviations,
    compute="pitchpoint.analyses.kinematic_error:error_of",
    main=("kinematic_error_range",),
    figures="pitchpoint.analyses.kinematic_error:error_figures",
)
JOINT = Analysis(
    name="joint",
    title="torsional vibration",
    of="mesh",
    under_load=True,
    lacks=no_joint,
    compute="pitchpoint.analyses.joint:joint_of",
    main=("natural_frequency", "critical_speed", "torque_amplitude"),
    figures="pitchpoint.analyses.joint:joint_figures",
)
FOUR_QUADRANTS = Analysis(
    name="four_quadrants",
    title="loss map of the output",
    of="drive",
    lacks=no_quadrants,
    compute="pitchpoint.analyses.four_quadrants:quadrants_of",
    pieces="pitchpoint.analyses.four_quadrants:pieces",
    joined="pitchpoint.analyses.four_quadrants:joined_quadrants",
    figures=standstill_figures,
)
DUTY = Analysis(
    name="duty",
    title="duty cycle",
    of="drive",
    lacks=no_duty,
    reads=FOUR_QUADRANTS.name,
    beside=("bearing_life", "life_hours"),
    joined="pitchpoint.analyses.duty:duty_of_map",
    figures="pitchpoint.analyses.main_figures:duty_figures",
)

ANALYSES: Registry[Analysis | Several] = Registry(
    "analysis",
    TEETH,
    INSPECTION,
    LOAD_LIMITS,
    BODIES,
    REFLECTED,
    CYCLE,
    TRAIN_OVER_PERIOD,
    OPERATION,
    LAWS_THERE,
    STRENGTH,
    FILM,
    FINITE_FILM,
    FILM_SQUEEZE,
    WEAR,
    TORSION,
    PLANET_SHARING,
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
    DUTY,
)


def register(analysis: Analysis | Several) -> None:
    """Add an analysis of one's own, with its variables, to all that are computed from now on."""
    ANALYSES.add(analysis)
    VARIABLES.update(analysis.variables)
