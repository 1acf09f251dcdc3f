"""What a case says of its wear: the law with its constants, and where the march ends."""

import inspect
from collections.abc import Mapping, Sequence
from math import inf

from jaxtyping import Array

from pitchpoint._jax import array
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import SolidInUse
from pitchpoint.contact.contacts import KINDS, TOUCH
from pitchpoint.core.doubts import Doubt
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.pairs import flanks_in_turn
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.lubrication.ehl.ehl_registry import SMOOTH
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.lubrication.lubrication_registry import ASPERITY_LOAD
from pitchpoint.wear.history import WearModel
from pitchpoint.wear.march import Limit
from pitchpoint.wear.wear_registry import WEAR_LAWS, WearLaw
from pitchpoint.wear.wear_tables import WearTable

__all__ = ["ASSUMED_COEFFICIENT", "check_wear", "limit_of", "wear_constant_doubts", "wear_model"]

ASSUMED_COEFFICIENT = 1e-5
"""Coefficient of Archard where none is given: known ones of dry metals are 1e-6 to 1e-4."""

_OWN = ("coefficient", "hardness", "rate")
_DEFECT = ("adsorption_heat", "molecule_diameter", "vibration_period")

Used = Sequence[SolidInUse]


def limit_of(table: WearTable, deepest: float) -> Limit:
    """Where the march of a case ends.

    Args:
        table: as validated.
        deepest: depth up to which the march holds [m].
    """
    depth = deepest if table.depth_limit is None else min(table.depth_limit, deepest)
    pressure = inf if table.pressure_limit is None else table.pressure_limit
    return Limit(table.cycles, depth, pressure)


def check_wear(case: CaseFile, mesh: Mesh, used: Used) -> None:
    """InputError for a wear that these gears or materials do not have.

    Args:
        case: whole.
        mesh: of its gears.
        used: solids of both.
    """
    table = case.wear
    if table is None:
        return
    if not has(mesh, flanks_in_turn):
        message = (
            "was given; these gears name no number of flanks among which wear goes round, as a rack has "
            "none; leave the table out"
        )
        raise InputError(message, key="wear")
    if case.worn is not None:
        raise InputError(
            "was given with [worn]: only flanks as new are worn; leave one out", key="wear"
        )
    if table.sensitivities and table.load_ratio == "film":
        raise InputError(
            'true was given with wear.load_ratio = "film"; no derivatives are taken through solved films, '
            "leave it out",
            key="wear.sensitivities",
        )
    law = WEAR_LAWS[table.law]
    if law.shape not in (None, mesh.shape):
        raise InputError(
            f"'{law.name}' holds for {KINDS[law.shape]}, and these gears touch {TOUCH[mesh.shape]}",
            key="wear.law",
        )
    wanted = inspect.signature(law.function).parameters
    _check_asked(table, law, wanted)
    _check_share(case, table, law, mesh, wanted)
    _check_teeth(table, mesh)
    _own(table, law, wanted, used)
    if table.profile == "updated" and has(mesh, tooth_sections) and not _feels(case):
        raise InputError(
            f"worn flanks share the load by their gaps, and '{case.models.load_sharing}' knows of none; "
            'set models.load_sharing = "from_stiffness", or wear.profile = "kept"',
            key="wear.profile",
        )


def _feels(case: CaseFile) -> bool:
    return case.models.load_sharing == "from_stiffness"


def _check_share(
    case: CaseFile, table: WearTable, law: WearLaw, mesh: Mesh, wanted: Mapping[str, object]
) -> None:
    """InputError for a load on asperities that a law does not get, or does not ask for."""
    films = table.load_ratio == "film"
    if "asperity_share" not in wanted:
        if films:
            raise InputError(
                f"'film' was given, and '{law.name}' does not ask for the load on asperities; leave it out",
                key="wear.load_ratio",
            )
        return
    if films and mesh.shape != "line":
        raise InputError(
            f"'film' is for {KINDS['line']}, and these gears touch {TOUCH[mesh.shape]}; use formula",
            key="wear.load_ratio",
        )
    if films and case.film is not None and case.film.asperities == SMOOTH:
        raise InputError(
            f"'{SMOOTH}' leaves no load on asperities, which wear.load_ratio takes from the film; leave it "
            "out, or name another law",
            key="film.asperities",
        )
    if not films and case.models.asperity_load == "none":
        models = ", ".join(name for name in ASPERITY_LOAD if name != "none")
        raise InputError(
            f"'{law.name}' asks for the load on asperities, which 'none' leaves out; choose {models}, or set "
            'wear.load_ratio = "film"',
            key="models.asperity_load",
        )


def _check_teeth(table: WearTable, mesh: Mesh) -> None:
    """InputError for a limit of teeth where there are none."""
    for key, what in (("tip_land_limit", "tip"), ("backlash_limit", "backlash")):
        if getattr(table, key) is not None and not has(mesh, tooth_sections):
            raise InputError(
                f"was given, and these bodies have no teeth with a {what}; leave it out",
                key=f"wear.{key}",
            )


def _check_asked(table: WearTable, law: WearLaw, wanted: Mapping[str, object]) -> None:
    """InputError for a constant that the law does not ask for."""
    groups = {name: (name,) for name in _OWN} | {"film_defect": _DEFECT}
    for group, keys in groups.items():
        for key in keys:
            if group not in wanted and getattr(table, key) is not None:
                raise InputError(
                    f"was given, and '{law.name}' does not ask for it; leave it out",
                    key=f"wear.{key}",
                )


def _own(
    table: WearTable, law: WearLaw, wanted: Mapping[str, object], used: Used
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Constants of the law that belong to each member."""
    constants: tuple[dict[str, Array], dict[str, Array]] = ({}, {})
    for name in _OWN:
        if name not in wanted:
            continue
        stated = getattr(table, name)
        for member, of_member in enumerate(constants):
            if stated is not None:
                of_member[name] = array(stated[member])
            elif (usual := _usual(name, used[member])) is not None:
                of_member[name] = array(usual)
            else:
                raise InputError(_missing(law, name, member), key=f"wear.{name}")
    return constants


def _usual(name: str, used: SolidInUse) -> float | None:
    """A constant that was left out, as far as one is known."""
    if name == "coefficient":
        return ASSUMED_COEFFICIENT
    hardness = used.record.hardness if name == "hardness" else None
    return None if hardness is None else hardness.value


def _missing(law: WearLaw, name: str, member: int) -> str:
    if name == "rate":
        return (
            f"is missing: '{law.name}' asks for the specific wear rate of both gears; give it, as "
            '["1e-6 mm3/(N m)", "0 1/Pa"]'
        )
    return (
        f"is missing: '{law.name}' asks for the hardness of both gears, and that of gear {member + 1} is "
        'not known; give both, as ["200 HV", "1.96 GPa"]'
    )


def wear_model(
    case: CaseFile, used: Used, roughness: tuple[float, float], films: FilmModel | None
) -> WearModel:
    """How flanks of a case wear.

    Args:
        case: with a table of wear that was checked.
        used: solids of both gears.
        roughness: mean Ra of both flanks [m].
        films: how films of the case are solved, for a load on asperities that is taken from them.
    """
    table = case.wear
    assert table is not None
    law = WEAR_LAWS[table.law]
    wanted = inspect.signature(law.function).parameters
    constants = _own(table, law, wanted, used)
    if "ra_1" in wanted:
        for of_member in constants:
            of_member.update(ra_1=array(roughness[0]), ra_2=array(roughness[1]))
    defect = None
    if "film_defect" in wanted:
        defects = {key: getattr(table, key) for key in _DEFECT}
        defect = {key: array(value) for key, value in defects.items() if value is not None}
    return WearModel(
        law=law.function,
        own=constants,
        asperities=ASPERITY_LOAD[case.models.asperity_load],
        defect=defect,
        bodies=_conductors(used) if defect is not None and _by_formula(case) else None,
        films=films if table.load_ratio == "film" else None,
        mates=array(table.engagements or (1.0, 1.0)),
    )


def _by_formula(case: CaseFile) -> bool:
    """True if the first friction law of a case is no solver of films."""
    return FRICTION[case.models.friction[0].name].films is None


def _conductors(used: Used) -> tuple[Conductor, Conductor] | None:
    """What conducts heat behind both flanks; None where that of a material is not known."""
    try:
        gear_1, gear_2 = (Conductor.of(solid.record) for solid in used)
    except InputError:
        return None
    return gear_1, gear_2


def wear_constant_doubts(case: CaseFile, model: WearModel) -> list[str]:
    """What to be wary of in the constants of a case.

    Args:
        case: with a table of wear.
        model: of it.
    """
    table = case.wear
    assert table is not None
    law = WEAR_LAWS[table.law]
    brief = f"Wear by '{law.name}': depths are as good as its constants."
    warnings: list[str] = [Doubt(f"Wear: {law.note}", brief=brief)]
    if table.coefficient is None and "coefficient" in model.own[0]:
        warnings.append(
            Doubt(
                f"wear.coefficient was left out and is taken as {ASSUMED_COEFFICIENT:g}; those of dry metals "
                "are 1e-6 to 1e-4, and depths are in proportion to it.",
                brief=f"wear.coefficient is taken as {ASSUMED_COEFFICIENT:g}, dry metals 1e-6 to 1e-4.",
            )
        )
    if model.films is not None:
        warnings.append(
            Doubt(
                "Wear: the load on asperities is that of steady films, each contact by itself, solved anew "
                "in every state that a step looks at. What the depth depends on is not told: no derivatives "
                "are taken through solved films.",
                brief="Wear: asperities carry what steady films leave; no derivatives.",
            )
        )
    if model.defect is not None:
        if "adsorption_heat" not in model.defect:
            warnings.append(
                Doubt(
                    "wear.adsorption_heat was left out and is taken as 49 kJ/mol: 12 kJ/mol less make a "
                    "hundred times the wear.",
                    brief="Adsorption heat taken as 49 kJ/mol; 12 less: 100 times the wear.",
                )
            )
        if model.bodies is None:
            warnings.append(
                Doubt(
                    "Wear: contacts are taken to be as warm as the oil: the conductivity or specific heat of "
                    "a material is not known, or the first friction law solves films.",
                    brief="Wear: contacts are taken to be as warm as the oil.",
                )
            )
    return warnings
