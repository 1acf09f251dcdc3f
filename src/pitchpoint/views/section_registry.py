"""All sections of the report and the screen; those of parts that few results have are loaded for them."""

from pitchpoint.analyses.main_figures import HOLDING
from pitchpoint.registry import Registry
from pitchpoint.views.section import (
    Section,
    of_part,
    of_published,
    of_rows,
    of_source,
    of_trains,
    without_rows,
    without_trains,
)
from pitchpoint.views.sections.answer import ANSWER
from pitchpoint.views.sections.arc import ARC
from pitchpoint.views.sections.beside import BESIDE
from pitchpoint.views.sections.cycle import CYCLE
from pitchpoint.views.sections.inputs import INPUTS
from pitchpoint.views.sections.inspection import INSPECTION
from pitchpoint.views.sections.issues import ISSUES
from pitchpoint.views.sections.loss_map import LOSS_MAP
from pitchpoint.views.sections.models import MODELS
from pitchpoint.views.sections.path import PATH
from pitchpoint.views.sections.sources import SOURCES
from pitchpoint.views.sections.stages import STAGES
from pitchpoint.views.sections.strength import STRENGTH
from pitchpoint.views.sections.studies import STUDIES
from pitchpoint.views.sections.teeth import TEETH
from pitchpoint.views.sections.vibration import VIBRATION
from pitchpoint.views.sections.wave_drive import DRIVE

__all__ = ["SECTIONS", "in_order", "register_section"]

DESIGNS = Section(
    name="designs",
    title="Designs beside each other",
    short="Designs",
    order=-1.0,
    lacks=lambda page: None if page.designs else "",
    blocks="pitchpoint.views.sections.designs:designs_blocks",
)
FORMULAS = Section(
    name="formulas",
    title="Formulas of the publication",
    short="Formulas",
    order=90.0,
    lacks=of_published("pitchpoint.views.sections.formulas:formulas_lack"),
    blocks="pitchpoint.views.sections.formulas:formulas_blocks",
    answer=of_source("pitchpoint.views.sections.formulas:formulas_answer"),
)
COMPARED = Section(
    name="compared",
    title="Printed against computed",
    short="Printed and computed",
    order=800.0,
    lacks=without_rows,
    blocks="pitchpoint.views.sections.compared:compared_blocks",
    closing=of_rows("pitchpoint.views.sections.compared:compared_closing"),
)
FILM = Section(
    name="film",
    title="Films solved",
    short="Films",
    order=230.0,
    parts=("film",),
    main_figure="films0_thickness",
    blocks="pitchpoint.views.sections.film:film_blocks",
    answer=of_part("film", "pitchpoint.views.sections.film:film_facts"),
    screen=of_part("film", "pitchpoint.views.sections.film:film_printed"),
)
FINITE_FILM = Section(
    name="finite_film",
    title="Films of finite contacts",
    short="Finite contacts",
    order=231.0,
    parts=("finite_film",),
    main_figure="finite0_thickness",
    blocks="pitchpoint.views.sections.finite_film:finite_film_blocks",
    answer=of_part("finite_film", "pitchpoint.views.sections.finite_film:finite_film_facts"),
    screen=of_part("finite_film", "pitchpoint.views.sections.finite_film:finite_film_printed"),
)
FILM_SQUEEZE = Section(
    name="film_squeeze",
    title="Squeeze of films over the engagement",
    short="Squeeze",
    order=232.0,
    parts=("film_squeeze",),
    blocks="pitchpoint.views.sections.film_squeeze:squeeze_blocks",
    answer=of_part("film_squeeze", "pitchpoint.views.sections.film_squeeze:squeeze_facts"),
    screen=of_part("film_squeeze", "pitchpoint.views.sections.film_squeeze:squeeze_printed"),
)
WEAR = Section(
    name="wear",
    title="Wear",
    short="Wear",
    order=234.0,
    parts=("wear",),
    main_figure="wear0_depth",
    blocks="pitchpoint.views.sections.wear:wear_blocks",
    answer=of_part("wear", "pitchpoint.views.sections.wear:wear_facts"),
    screen=of_part("wear", "pitchpoint.views.sections.wear:wear_printed"),
)
TORSION = Section(
    name="torsion",
    title="Torsion",
    short="Torsion",
    order=300.0,
    parts=("torsion",),
    main_figure="torsion0_load",
    blocks="pitchpoint.views.sections.torsion:torsion_blocks",
    answer=of_part("torsion", "pitchpoint.views.sections.torsion:torsion_facts"),
    screen=of_part("torsion", "pitchpoint.views.sections.torsion:torsion_printed"),
)
KINEMATIC_ERROR = Section(
    name="kinematic",
    title="Kinematic error",
    short="Kinematic error",
    order=310.0,
    parts=("kinematic_error",),
    main_figure="kinematic0_turn",
    blocks="pitchpoint.views.sections.kinematic_error:error_blocks",
    answer=of_part("kinematic_error", "pitchpoint.views.sections.kinematic_error:error_facts"),
    screen=of_part("kinematic_error", "pitchpoint.views.sections.kinematic_error:error_printed"),
)
JOINT = Section(
    name="joint",
    title="Torsional vibration of the joint",
    short="Joint",
    order=320.0,
    parts=("joint",),
    main_figure="joint0_torque",
    blocks="pitchpoint.views.sections.joint:joint_blocks",
    answer=of_part("joint", "pitchpoint.views.sections.joint:joint_facts"),
    screen=of_part("joint", "pitchpoint.views.sections.joint:joint_printed"),
)
STIFFNESS = Section(
    name="stiffness",
    title="Mesh stiffness",
    short="Mesh stiffness",
    order=400.0,
    parts=("stiffness",),
    main_figure="stiffness0_phase",
    blocks="pitchpoint.views.sections.stiffness:stiffness_blocks",
    answer=of_part("stiffness", "pitchpoint.views.sections.stiffness:stiffness_facts"),
)
LOAD_LIMITS = Section(
    name="load_limits",
    title="Load limits of flexspline and wave generator",
    short="Load limits",
    order=106.0,
    parts=("load_limits",),
    blocks="pitchpoint.views.sections.load_limits:limits_blocks",
    answer=of_part("load_limits", "pitchpoint.views.sections.load_limits:limits_facts"),
    screen=of_part("load_limits", "pitchpoint.views.sections.load_limits:limits_printed"),
)
BODIES = Section(
    name="bodies",
    title="Masses and moments of inertia",
    short="Masses",
    order=107.0,
    parts=("bodies",),
    blocks="pitchpoint.views.sections.bodies:bodies_blocks",
    answer=of_part("bodies", "pitchpoint.views.sections.bodies:bodies_facts"),
    screen=of_part("bodies", "pitchpoint.views.sections.bodies:bodies_printed"),
)
REFLECTED = Section(
    name="reflected",
    title="Backlash at the output, masses and reflected inertia",
    short="Inertia",
    order=108.0,
    parts=("reflected",),
    blocks="pitchpoint.views.sections.reflected:reflected_blocks",
    answer=of_part("reflected", "pitchpoint.views.sections.reflected:reflected_facts"),
    screen=of_part("reflected", "pitchpoint.views.sections.reflected:reflected_printed"),
)
PLANET_SHARING = Section(
    name="planet_sharing",
    title="Load of the planets",
    short="Planets",
    order=208.0,
    parts=("planet_sharing",),
    blocks="pitchpoint.views.sections.planet_sharing:sharing_blocks",
    screen=of_part("planet_sharing", "pitchpoint.views.sections.planet_sharing:sharing_printed"),
)
TRAIN = Section(
    name="train",
    title="Motion of the set",
    short="Motion of the set",
    order=40.0,
    blocks="pitchpoint.views.sections.train:train_blocks",
    lacks=without_trains,
    answer=of_trains("pitchpoint.views.sections.train:train_facts"),
    screen=of_trains("pitchpoint.views.sections.train:train_printed"),
)
TRAIN_PERIOD = Section(
    name="train_period",
    title="Over the period of the train",
    short="Over the period",
    order=205.0,
    parts=("train_period",),
    blocks="pitchpoint.views.sections.train_period:train_period_blocks",
    screen=of_part("train_period", "pitchpoint.views.sections.train_period:train_period_printed"),
    main_figure="train0_input_torque",
)
MOTION = Section(
    name="motion",
    title="Motion with friction",
    short="Motion",
    order=420.0,
    parts=("motion",),
    blocks="pitchpoint.views.sections.motion:motion_blocks",
    answer=of_part("motion", "pitchpoint.views.sections.motion:motion_facts"),
    screen=of_part("motion", "pitchpoint.views.sections.motion:motion_printed"),
)
FOUR_QUADRANTS = Section(
    name="quadrants",
    title="Loss map of the output",
    short="Four quadrants",
    order=710.0,
    parts=(f"four_quadrants.{HOLDING[0]}",),
    blocks="pitchpoint.views.sections.four_quadrants:quadrants_blocks",
    answer=of_part("four_quadrants", "pitchpoint.views.sections.four_quadrants:quadrants_facts"),
    screen=of_part("four_quadrants", "pitchpoint.views.sections.four_quadrants:quadrants_printed"),
)
DUTY = Section(
    name="duty",
    title="Duty cycle",
    short="Duty cycle",
    order=720.0,
    parts=("duty",),
    blocks="pitchpoint.views.sections.duty:duty_blocks",
    answer=of_part("duty", "pitchpoint.views.sections.duty:duty_facts"),
    screen=of_part("duty", "pitchpoint.views.sections.duty:duty_printed"),
)

SECTIONS: Registry[Section] = Registry(
    "section",
    DESIGNS,
    ANSWER,
    INPUTS,
    STAGES,
    TEETH,
    INSPECTION,
    LOAD_LIMITS,
    BODIES,
    REFLECTED,
    PATH,
    STRENGTH,
    DRIVE,
    ARC,
    CYCLE,
    TRAIN,
    TRAIN_PERIOD,
    PLANET_SHARING,
    FILM,
    FINITE_FILM,
    FILM_SQUEEZE,
    WEAR,
    TORSION,
    KINEMATIC_ERROR,
    JOINT,
    BESIDE,
    STIFFNESS,
    VIBRATION,
    MOTION,
    STUDIES,
    FORMULAS,
    LOSS_MAP,
    FOUR_QUADRANTS,
    DUTY,
    COMPARED,
    ISSUES,
    MODELS,
    SOURCES,
)


def register_section(section: Section) -> None:
    """Add a section of one's own to the report and the screen."""
    SECTIONS.add(section)


def in_order() -> list[Section]:
    """All sections in the order in which they are shown."""
    return sorted(SECTIONS.values(), key=lambda section: section.order)
