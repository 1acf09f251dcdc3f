"""Why a part of a result does not exist for a case; asked of every case, so that nothing is computed here."""

from pitchpoint.analyses.analysis import Unasked, has_key
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import BuiltTrain, Ready
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import has
from pitchpoint.gears.pairs import touching
from pitchpoint.loading.loading_registry import LOAD_SHARING

__all__ = [
    "no_bodies",
    "no_deviations",
    "no_duty",
    "no_joint",
    "no_pins",
    "no_quadrants",
    "of_one_mesh",
    "rigid",
    "untransmitted",
    "without_films",
    "without_formula",
    "without_train",
]


def rigid(built: Ready) -> str | None:
    """Why nothing is computed of how teeth yield; of a drive that of the first stage where nothing is."""
    numbered_reasons = zip(built.mesh_numbers, map(_rigid, built.meshes), strict=True)
    sentences = (
        f"stage {number}: {why}" if number else why for number, why in numbered_reasons if why
    )
    return next(sentences, None)


def _rigid(built: Built) -> str | None:
    """The same of one mesh."""
    by_stiffness = LOAD_SHARING[built.case.models.load_sharing].by_stiffness
    dynamics, touches = built.case.dynamics, touching(built.design.mesh)
    if by_stiffness or dynamics is not None or not touches or any(built.deviations):
        return None
    if not built.transmits:
        return "nothing is transmitted by a test rig, so that nothing winds up"
    if LOAD_SHARING[built.case.gears.load_sharing].by_stiffness:
        return (
            f'load_sharing = "{built.case.models.load_sharing}" leaves out how teeth yield; '
            '"from_stiffness", the usual one of these gears, tells how far they wind up'
        )
    return Unasked(
        "nothing in the case asks how teeth yield, as gaps and deviations of flanks, [dynamics] and "
        'load_sharing = "from_stiffness" do'
    )


def untransmitted(built: Ready) -> str | None:
    """Why there is no part on the power that goes through."""
    return None if built.transmits else "nothing is transmitted by a test rig"


def without_formula(built: Ready) -> str | None:
    """Why there is no part on very many operating points, whose friction asks for formulas."""
    solved = [law.name for law in built.laws if law.films is not None]
    if not solved:
        return None
    return (
        f"it takes friction at very many operating points, and '{solved[0]}' solves the films of each; a "
        "case with formulas alone has it"
    )


def without_films(built: Ready) -> str | None:
    """Why films are not solved over a map."""
    why_not = without_formula(built)
    if why_not is None or not all(touching(mesh.design.mesh) for mesh in built.meshes):
        return why_not
    sentence = f"{why_not}, and one with a table [loss_map] has it from films at few of them"
    return sentence if built.case.loss_map is None else None


def no_bodies(built: Built) -> str | None:
    """Why there are no masses of bodies."""
    if built.family.bodies is not None:
        return None
    if not built.transmits:
        return Unasked("a test rig has bodies of any mass")
    if built.family.drawing:
        return Unasked("masses of cylindrical gears stand with the dimensions of their drawing")
    return "masses of these gears are not computed"


def of_one_mesh(built: Ready) -> str | None:
    """Why there are no sums over the meshes of a drive."""
    if built.numbers:
        return None
    return Unasked("backlash, masses and inertia of one mesh stand with its gears")


def without_train(built: Ready) -> str | None:
    """Why there is no period in which all meshes come together again."""
    return (
        None if built.trains else Unasked("its bodies do not turn together as those of a train do")
    )


def no_pins(built: Ready) -> str | None:
    """Why nothing is computed of how planets share a load; of a drive with sets each is asked."""
    if not built.trains:
        return Unasked("it has no planets")
    (train,) = built.trains.values()
    if not _out_of_place(train):
        return Unasked("pin_errors, pin_tolerance and the like of a planetary set ask for it")
    on_planets = [mesh for mesh in train.design.meshes if mesh.carrier != HOUSING]
    if train.case.operation.load == 0.0:
        return "planets share no load where there is none"
    if train.planets < 2 or len(on_planets) != 2:
        return "planets that share a load by their pins are several, each in two meshes"
    return None


def _out_of_place(built: BuiltTrain) -> bool:
    """True if pins of a set are said to be out of place."""
    train = built.case.train
    return train is not None and bool(train.pin_errors or train.by_tolerance)


def no_joint(built: Built) -> str | None:
    """Only where a case asks for it, and its gears have no vibration of another kind."""
    if not built.transmits:
        return Unasked("nothing is transmitted by a test rig")
    if has(built.design.mesh, line_of_action):
        return Unasked("the vibration of these gears is computed along their line of action")
    return Unasked("the case has no [dynamics]") if built.case.dynamics is None else None


def no_quadrants(built: Ready) -> str | None:
    """Why there is no map of the output."""
    loss_map = built.case.loss_map
    why_not = untransmitted(built)
    if why_not is None and (loss_map is None or loss_map.quadrants != 4):
        return Unasked("loss_map.quadrants = 4 asks for it")
    return why_not or without_films(built)


def no_duty(built: Ready) -> str | None:
    """Why there is no duty cycle; InputError for one that its map will not hold."""
    why_not = untransmitted(built)
    if why_not is None and built.case.duty is None:
        return Unasked("[duty] asks for it")
    why_not = why_not or no_quadrants(built)
    if why_not is None:
        from pitchpoint.analyses.duty import demand_in_map

        demand_in_map(built)
    return why_not


def no_deviations(built: Built) -> str | None:
    """Why the teeth make no kinematic error."""
    if any(built.deviations):
        return None
    if not built.transmits:
        return "a test rig has no teeth"
    if not has_key(built, "deviations"):
        return "deviations of the teeth of these gears are not among the keys of a case"
    return Unasked("the teeth have no deviations around their gears")
