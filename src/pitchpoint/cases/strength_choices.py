"""What a case says of the strength of its gears: load factors, limits of the materials, what is assumed."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan, cos, inf, nan, tan
from typing import Any, Self

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import array
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import SolidInUse
from pitchpoint.efficiency.quasi_static import Operation
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.iso_1328 import FlankTolerances, flank_tolerances
from pitchpoint.input.remembered import remembering
from pitchpoint.materials.lubricants import LubricantRecord
from pitchpoint.materials.surfaces import Roughness
from pitchpoint.strength.flank import NO_MODIFICATION
from pitchpoint.strength.limits import Constants
from pitchpoint.strength.load_factors import CLASSES, running_in_relief
from pitchpoint.strength.rating import Duty, Factors, Finish, Strengths
from pitchpoint.strength.strength_table import MESH_LOAD, UNRATED, StrengthTable
from pitchpoint.strength.treatments import PLASTIC, PLASTIC_CYCLES, TREATMENTS, Treatment

__all__ = ["Rated", "check_strength", "of_planets", "rated_case"]

_EDITIONS = {
    "2006": ("iso_6336_2_2006", "iso_6336_3_2006"),
    "2019": ("iso_6336_2_2019", "iso_6336_3_2019"),
}
_ASSUMED_CLASS = 7
_ROOT_ROUGHNESS = 10e-6  # Rz of the test gears [m]
_RZ_PER_RA = 6.0  # ISO 6336-2:2006, 12.3; IACS UR M56, 2.10 c

Used = tuple[SolidInUse, SolidInUse]

BOTH_WAYS = 0.7
"""Mean stress factor Y_M of teeth that bear the same load both ways, ISO 6336-3."""


@dataclass(frozen=True)
class Rated:
    """A case as its rating takes it.

    Attributes:
        factors, strengths, finish: arrays.
        endured: load cycles of flanks and roots from which on both materials endure.
        table: on strength.
        used: materials of both gears, as they are used.
        grade: what is to be said of the class of the gears for K_v; empty where nothing is.
        helical: True for helical gears.
    """

    factors: Factors
    strengths: Strengths
    endured: tuple[Array, Array]
    finish: Finish
    table: StrengthTable
    used: Used
    grade: str
    helical: bool

    @property
    def assumed(self) -> tuple[str, ...]:
        """What was not given, in the words of a list."""
        assumptions = _assumed(self.table, self.grade, _plastic(self.used), helical=self.helical)
        return *assumptions, *_cycles(self.table, self.used)

    @property
    def withheld(self) -> tuple[str, ...]:
        """Sentences on gears whose safeties are not known."""
        return tuple(_withheld(self.strengths, self.used))

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography."""
        plastic = any(_plastic(self.used))
        curves = (curve.record.root_strength for curve in self.used)
        printed = [curve.origin.source for curve in curves if curve is not None]
        by_part_1 = self.table.dynamic_method == "B" or self.table.shaft is not None
        return (
            *_EDITIONS[self.table.edition],
            "iacs_m56_2021",
            *("iso_6336_1_2006",) * by_part_1,
            *("iec_61400_4_2012",) * (self.table.mesh_load_factor in MESH_LOAD.values()),
            *("vdi_2736_2_2014",) * plastic,
            *dict.fromkeys(printed),
        )

    def duty(self, point: Operation, life: float | None, driver: Array) -> Duty:
        """What the pair has to bear.

        Args:
            point: torque on the driven gear, speed of the driving gear.
            life: time under load [s]; None if the teeth are to endure.
            driver: one for the gear that drives.
        """
        flank, root = self.endured
        time, engagements = nan if life is None else life, self.table.engagements or (1.0, 1.0)
        conditions = point.load, point.speed, flank, root, driver
        return Duty(*conditions, array(time), array(engagements))


def check_strength(case: CaseFile, used: Used) -> None:
    """InputError for a table that these gears have no use for, or a limit or method that does not suit them.

    Args:
        case: whole.
        used: materials of both.
    """
    if case.strength is None:
        return
    if not case.gears.rated:
        raise InputError(UNRATED, key="strength")
    _check_method(case.strength, _plastic(used))
    _treatments(case.strength, used)


def rated_case(case: CaseFile, used: Used, oil: LubricantRecord, roughness: Roughness) -> Rated:
    """A case as its rating takes it.

    Args:
        case: whole.
        used: materials of both gears, as they are used.
        oil: of the case.
        roughness: of the flanks.
    """
    table = case.strength or _USUAL
    plastic = _plastic(used)
    grade, of_grade = _class(table, case)
    mean_ra = (float(roughness.ra_1) + float(roughness.ra_2)) / 2.0
    return Rated(
        _factors(table, _Toothing.of(case, table, grade), used),
        *_strengths(table, used, plastic),
        _finish(table, oil.nu_1.value, mean_ra, _thinning(case)),
        table,
        used,
        of_grade,
        _helical(case),
    )


_USUAL = StrengthTable()


def of_planets(
    table: StrengthTable | None,
    planets: int,
    meets: tuple[bool, bool],
    both_ways: tuple[bool, bool],
) -> StrengthTable:
    """The table of a mesh with what planets add, where the case leaves it open.

    Args:
        table: of the case.
        planets: that share the load of the mesh.
        meets: for both gears, whether it meets every planet in a turn.
        both_ways: for both gears, whether its teeth are loaded both ways, by two mates.
    """
    table = table or _USUAL
    usual = {
        "mesh_load_factor": MESH_LOAD.get(planets, 1.0),
        "engagements": tuple(float(planets) if every else 1.0 for every in meets),
        "mean_stress_factor": tuple(BOTH_WAYS if both else 1.0 for both in both_ways),
    }
    return table.model_copy(
        update={key: value for key, value in usual.items() if getattr(table, key) is None}
    )


def _plastic(used: Used) -> tuple[bool, bool]:
    return used[0].plastic, used[1].plastic


def _helical(case: CaseFile) -> bool:
    return bool(getattr(case.gears, "helix_angle", 0.0))


def _class(table: StrengthTable, case: CaseFile) -> tuple[int, str]:
    """Class of the gears by ISO 1328-1, as K_v takes it, and what is to be said of it."""
    drawn = _class_of_gears(case.gears)
    if table.accuracy_class is not None:
        return int(table.accuracy_class), ""
    if drawn is None:
        return _ASSUMED_CLASS, f"accuracy class {_ASSUMED_CLASS} of ISO 1328-1 for K_v"
    worse = int(max(drawn))
    taken = min(max(worse, min(CLASSES)), max(CLASSES))
    return (
        taken,
        ""
        if taken == worse
        else f"K_v of accuracy class {taken} for gears of class {worse}"
        + ", which have more" * (taken < worse),
    )


def _class_of_gears(gears: Any) -> tuple[float, float] | None:
    """Classes of both gears by ISO 1328-1: those that are drawn, else those of the drawing; None without."""
    for table in (getattr(gears, "deviations", None), getattr(gears, "inspection", None)):
        iso_class: tuple[float, float] | None = getattr(table, "iso_class", None)
        if iso_class is not None:
            return iso_class
    return None


@dataclass(frozen=True)
class _Toothing:
    """What load factors ask of gears beside the rated pair.

    Attributes:
        grade: class for K_v by method C.
        classes: of both gears by ISO 1328-1.
        diameters: of both reference circles [m].
        module, face_width, tip_relief: [m]; the smaller relief, NaN without one.
        pressure_angle: in the transverse section [rad].
        misalignment: of the flanks over the face; NaN where helix slopes make it [m].
    """

    grade: int
    classes: tuple[float, float]
    diameters: tuple[float, float]
    module: float
    face_width: float
    tip_relief: float
    pressure_angle: float
    misalignment: float

    @classmethod
    def of(cls, case: CaseFile, table: StrengthTable, grade: int) -> Self:
        """The toothing of a case.

        Args:
            case: of a rated pair.
            table: on its strength.
            grade: class for K_v by method C.
        """
        gears: Any = case.gears
        cosine = cos(gears.helix_angle)
        diameter_1, diameter_2 = (abs(teeth) * gears.module / cosine for teeth in gears.teeth)
        relief = None if gears.modifications is None else gears.modifications.tip_relief
        drawn = _class_of_gears(gears)
        return cls(
            grade,
            drawn if drawn is not None and table.accuracy_class is None else (grade, grade),
            (diameter_1, diameter_2),
            gears.module,
            gears.face_width,
            nan if relief is None else min(relief),
            atan(tan(gears.pressure_angle) / cosine),
            nan if gears.misalignment is None else gears.misalignment,
        )

    @property
    def tolerances(self) -> list[FlankTolerances]:
        """Of both gears."""
        return [
            flank_tolerances(
                tolerance_class=int(grade),
                diameter=diameter,
                module=self.module,
                face_width=self.face_width,
            )
            for grade, diameter in zip(self.classes, self.diameters, strict=True)
        ]


_FINEST_WITHOUT_RELIEF = 6
"""Class from which on relief moves K_v by method B no more."""


def _check_method(table: StrengthTable, plastic: tuple[bool, bool]) -> None:
    if table.dynamic_method == "B" and any(plastic):
        raise InputError(
            "B was given for gears of plastic; it holds for steel, and K_v of plastics is 1 unless a "
            "dynamic_factor is given; leave it out",
            key="strength.dynamic_method",
        )


def _by_method_b(table: StrengthTable, toothing: _Toothing, used: Used) -> dict[str, Array]:
    """Deviations and relief for K_v by method B; nothing for other methods."""
    if table.dynamic_method != "B":
        return {}
    gear_1, gear_2 = toothing.tolerances
    pitch = max(gear_1.single_pitch, gear_2.single_pitch) * cos(toothing.pressure_angle)
    profile = max(gear_1.profile_form, gear_2.profile_form)
    relief = nan
    if max(toothing.classes) < _FINEST_WITHOUT_RELIEF:
        run_in = running_in_relief(_limits(table.sigma_hlim, "sigma_hlim", used))
        relief = run_in if np.isnan(toothing.tip_relief) else toothing.tip_relief
    return {
        "method_b": array(1.0),
        "deviations": array((pitch, profile)),
        "relief": array(relief),
    }


def _of_shaft(table: StrengthTable, toothing: _Toothing) -> dict[str, Array]:
    """What K_Hbeta by method C takes; nothing where it is not asked."""
    if table.shaft is None:
        return {}
    slopes = [tolerance.helix_slope for tolerance in toothing.tolerances]
    return {
        "shaft": array(table.shaft),
        "helix_slopes": array(slopes),
        "misalignment": array(toothing.misalignment),
    }


@remembering
def _factors(table: StrengthTable, toothing: _Toothing, used: Used) -> Factors:
    spur, helical = CLASSES[toothing.grade]
    dynamic = 1.0 if any(_plastic(used)) else nan
    earlier = table.edition == "2006"
    return Factors(
        application=_given(table.application_factor, 1.0),
        mesh_load=_given(table.mesh_load_factor, 1.0),
        dynamic=_given(table.dynamic_factor, dynamic),
        face=_given(table.face_load_factor, 1.0 if table.shaft is None else nan),
        transverse=_given(table.transverse_load_factor, 1.0),
        root_face=_given(table.root_face_load_factor, nan),
        root_transverse=_given(table.root_transverse_load_factor, nan),
        spur=array(spur),
        helical=array(helical),
        accurate=array(float(toothing.grade <= 4)),
        correction=_given(table.profile_correction, 1.0 if earlier else NO_MODIFICATION),
        before_2019=array(float(earlier)),
        soft=array([float(treatment in _SOFT) for treatment in _treatment_names(table, used)]),
        **_by_method_b(table, toothing, used),
        **_of_shaft(table, toothing),
    )


_SOFT = ("normalised", "through_hardened")


def _treatment_names(table: StrengthTable, used: Used) -> tuple[str, str]:
    treatment_1, treatment_2 = _treatments(table, used)
    return treatment_1.name, treatment_2.name


def _given(value: float | None, usual: float) -> Array:
    return array(usual if value is None else value)


@remembering
def _strengths(
    table: StrengthTable, used: Used, plastic: tuple[bool, bool]
) -> tuple[Strengths, tuple[Array, Array]]:
    """What both gears bear, and from how many cycles on they endure."""
    treatment_1, treatment_2 = _treatments(table, used)
    strengths = Strengths(
        solids=(used[0].solid, used[1].solid),
        flank=array(_limits(table.sigma_hlim, "sigma_hlim", used)),
        root=array(_limits(table.sigma_flim, "sigma_flim", used)),
        constants=Constants.of(treatment_1, treatment_2),
        plastic=array(plastic),
        work_hardening=array(table.work_hardening or (1.0, 1.0)),
        mean_stress=array(table.mean_stress_factor or (1.0, 1.0)),
        over_cycles=array(np.array([_over_cycles(one) for one in used]).T),
    )
    endured = [
        [getattr(one, part).many for one in (treatment_1, treatment_2)]
        for part in ("flank", "root")
    ]
    return strengths, (array(endured[0]), array(endured[1]))


def _over_cycles(used: SolidInUse) -> tuple[float, ...]:
    """Root strength at the temperature of the teeth, see `Strengths`."""
    curve, tensile = used.record.root_strength, used.record.tensile_strength
    if curve is None or not used.plastic:
        return (nan,) * 4
    return *curve.at(used.temperature), inf if tensile is None else tensile.value


def _limits(given: tuple[float, float] | None, name: str, used: Used) -> list[float]:
    """Limits of both gears, by value or of their materials; not a number where they are not known."""
    if given is not None:
        return [*given]
    data = (getattr(solid.record, name) for solid in used)
    return [nan if datum is None else datum.value for datum in data]


def _treatments(table: StrengthTable, used: Used) -> tuple[Treatment, Treatment]:
    """Treatments of both gears.

    Raises:
        InputError: limits by value of a steel whose treatment is not known.
    """
    treatment_1, treatment_2 = (
        _treatment(table, solid, gear) for gear, solid in enumerate(used, 1)
    )
    return treatment_1, treatment_2


def _treatment(table: StrengthTable, used: SolidInUse, gear: int) -> Treatment:
    if used.plastic:
        return PLASTIC
    name = used.record.treatment if table.treatment is None else table.treatment[gear - 1]
    if name:
        return TREATMENTS[name]
    if table.sigma_hlim is not None or table.sigma_flim is not None:
        raise InputError(
            f"is missing: limits were given for gear {gear}, and factors between test gears and these depend "
            f"on the heat treatment; known are {', '.join(TREATMENTS)}",
            key="strength.treatment",
        )
    return TREATMENTS["case_hardened"]  # without limits its factors lead to no safety


def _thinning(case: CaseFile) -> tuple[float, float] | None:
    """Allowances of the thinnest teeth of both gears [m]; None where the case gives none."""
    allowed = case.gears.thickness_allowances
    return None if allowed is None else allowed[1]


@remembering
def _finish(
    table: StrengthTable,
    viscosity: float,
    mean_ra: float,
    thinning: tuple[float, float] | None,
) -> Finish:
    usual = _RZ_PER_RA * mean_ra
    flank = usual if table.flank_roughness is None else sum(table.flank_roughness) / 2.0
    return Finish(
        thickness=array(thinning or (0.0, 0.0)),
        flank=array(max(flank, 1e-7)),  # a perfectly smooth flank has no roughness factor
        root=array(table.root_roughness or (_ROOT_ROUGHNESS, _ROOT_ROUGHNESS)),
        viscosity=array(viscosity),
    )


def _assumed(
    table: StrengthTable, of_grade: str, plastic: tuple[bool, bool], *, helical: bool
) -> Iterator[str]:
    """What the case leaves open and a rating takes, for a list."""
    if table.application_factor is None:
        yield "K_A = 1"
    if table.dynamic_factor is None and any(plastic):
        yield "K_v = 1"
    elif table.dynamic_factor is None and of_grade:
        yield of_grade
    if table.face_load_factor is None and table.shaft is None:
        yield "K_Hβ = 1"
    if table.transverse_load_factor is None:
        yield "K_Hα = 1"
    if helical and table.profile_correction is None and table.edition != "2006":
        yield "f_ZCa = 1.2 (no profile modification that suits the load)"
    if table.mean_stress_factor is None:
        yield "teeth loaded in one direction"
    if all(plastic):
        return
    if table.life is None:
        yield "endless life (Z_NT = Y_NT = 1)"
    if table.work_hardening is None:
        yield "Z_W = 1"
    if table.flank_roughness is None:
        yield "Rz = 6 Ra at the flanks"
    if table.root_roughness is None:
        yield "Rz = 10 µm at the roots"


def _cycles(table: StrengthTable, used: Used) -> Iterator[str]:
    """Load cycles of plastic roots where no life is asked."""
    if table.life is None and table.sigma_flim is None and any(map(_by_cycles, used)):
        yield f"{PLASTIC_CYCLES:g} load cycles at the roots of plastic"


def _by_cycles(used: SolidInUse) -> bool:
    return used.plastic and used.record.root_strength is not None


def _withheld(strengths: Strengths, used: Used) -> Iterator[str]:
    """Why a gear has no safeties."""
    limits = zip(np.asarray(strengths.flank), np.asarray(strengths.root), used, strict=True)
    for gear, (flank, root, solid) in enumerate(limits, 1):
        limit_values = {"sigma_hlim": flank, "sigma_flim": root}
        missing = [name for name, value in limit_values.items() if np.isnan(value)]
        if _by_cycles(solid) and "sigma_flim" in missing:
            missing.remove("sigma_flim")
        if missing:
            yield _missing(gear, missing, solid)


def _missing(gear: int, names: list[str], used: SolidInUse) -> str:
    against = " and ".join(_AGAINST[name] for name in names)
    instead = _OF_PLASTICS if used.plastic else _OF_STEELS
    return (
        f"No safety of gear {gear} against {against}: '{used.record.name}' has no {' and '.join(names)}; "
        f"{instead}."
    )


_AGAINST = {"sigma_hlim": "pitting", "sigma_flim": "breakage"}
_OF_STEELS = "name a material that has them, such as 'case-hardened-mq', or give them in [strength]"
_OF_PLASTICS = "give those of its temperature and life in [strength]"
