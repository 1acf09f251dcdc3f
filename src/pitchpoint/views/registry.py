"""All sections of the report and the screen."""

from pitchpoint.registry import Registry
from pitchpoint.views.section import Section
from pitchpoint.views.sections.answer import ANSWER
from pitchpoint.views.sections.arc import ARC
from pitchpoint.views.sections.beside import BESIDE
from pitchpoint.views.sections.compared import COMPARED
from pitchpoint.views.sections.cycle import CYCLE
from pitchpoint.views.sections.designs import DESIGNS
from pitchpoint.views.sections.drive import DRIVE
from pitchpoint.views.sections.film import FILM
from pitchpoint.views.sections.film_squeeze import FILM_SQUEEZE
from pitchpoint.views.sections.finite_film import FINITE_FILM
from pitchpoint.views.sections.formulas import FORMULAS
from pitchpoint.views.sections.four_quadrants import FOUR_QUADRANTS
from pitchpoint.views.sections.inputs import INPUTS
from pitchpoint.views.sections.inspection import INSPECTION
from pitchpoint.views.sections.issues import ISSUES
from pitchpoint.views.sections.joint import JOINT
from pitchpoint.views.sections.kinematic_error import KINEMATIC_ERROR
from pitchpoint.views.sections.load_limits import LOAD_LIMITS
from pitchpoint.views.sections.loss_map import LOSS_MAP
from pitchpoint.views.sections.models import MODELS
from pitchpoint.views.sections.motion import MOTION
from pitchpoint.views.sections.path import PATH
from pitchpoint.views.sections.sources import SOURCES
from pitchpoint.views.sections.stages import STAGES
from pitchpoint.views.sections.stiffness import STIFFNESS
from pitchpoint.views.sections.strength import STRENGTH
from pitchpoint.views.sections.studies import STUDIES
from pitchpoint.views.sections.teeth import TEETH
from pitchpoint.views.sections.torsion import TORSION
from pitchpoint.views.sections.vibration import VIBRATION
from pitchpoint.views.sections.wear import WEAR

__all__ = ["SECTIONS", "in_order", "register_section"]

SECTIONS: Registry[Section] = Registry(
    "section",
    DESIGNS,
    ANSWER,
    INPUTS,
    STAGES,
    TEETH,
    INSPECTION,
    LOAD_LIMITS,
    PATH,
    STRENGTH,
    DRIVE,
    ARC,
    CYCLE,
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
