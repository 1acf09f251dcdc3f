"""One bench for drives of any family: what each answers for its task, in one table and on the same axes."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, nan
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float

from pitchpoint._jax import double_precision
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.envelope import gear_envelope
from pitchpoint.analyses.main_figures import efficiency_coverage
from pitchpoint.analyses.plausibility import unlikely
from pitchpoint.analyses.summaries import summaries
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.variant import Variant
from pitchpoint.core.doubts import as_doubt, doubts_of, ranked_doubts
from pitchpoint.errors import ConvergenceError, InputError, visible
from pitchpoint.input.quantities import shown
from pitchpoint.registry import enumerated
from pitchpoint.results.variable import (
    Variable,
    angle,
    dimensionless,
    length,
    mass,
    moment_of_inertia,
    percent,
    rotational_speed,
    torque,
    torsional_stiffness,
)
from pitchpoint.runs.case import Case, CaseLike, selected_variants
from pitchpoint.runs.compared_designs import design_names, resolved_reference
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import Progress
from pitchpoint.units import convert

__all__ = ["BENCHED", "LOADS", "SPEEDS", "Bench", "BenchedDrive", "bench"]

LOADS = (0.1, 0.25, 0.5, 0.75, 1.0, 1.25)
"""Parts of the load of the operating point at which efficiencies are taken, at its speed."""

SPEEDS = (0.1, 0.25, 0.5, 1.0, 1.25)
"""Parts of the speed of the operating point at which they are taken, under its load."""

PARTS = (
    "inspection",
    "bodies",
    "reflected",
    "operation",
    "torsion",
    "kinematic_error",
    "running",
    "back_driving",
)
"""Parts of a result that the table reads."""

NO_PLAY = 1e-9
"""Backlash that is rounding [rad]."""

YIELDING = {"models.load_sharing": "from_stiffness"}
"""What asks how teeth yield, where a case does not: its stiffness is that of the same case with this key."""

BENCHED: Mapping[str, Variable] = {
    "ratio": dimensionless("ratio, speed of the input over that of the output", "i"),
    "drive_mass": mass("mass of the gears", "m"),
    "outer_diameter": length("diameter around the gears", "D"),
    "gear_length": length("length of the gears", "L"),
    "output_torque": torque("torque at the output", "T_2"),
    "input_speed": rotational_speed("speed of the input", "n_1"),
    "efficiency": percent("efficiency", "η"),
    "efficiency_quarter": percent("efficiency at 25 % of the load", "η_25"),
    "efficiency_tenth": percent("efficiency at 10 % of the load", "η_10"),
    "back_efficiency": percent("efficiency backwards", "η_b"),
    "back_efficiency_quarter": percent("efficiency backwards at 25 % of the load", "η_b25"),
    "back_efficiency_tenth": percent("efficiency backwards at 10 % of the load", "η_b10"),
    "no_load_torque": torque("input torque without load", "T_0"),
    "starting_torque": torque("input torque that starts it", "T_s"),
    "back_driving_torque": torque("output torque that drives it backwards", "T_b"),
    "torsional_stiffness": torsional_stiffness("torsional stiffness at the output", "K"),
    "backlash": angle("backlash at the output", "j_φ", "arcmin"),
    "lost_motion": angle("lost motion at 4 % of the torque", "Δφ", "arcmin"),
    "input_inertia": moment_of_inertia("inertia at the input", "J_1"),
    "torque_ripple": torque("ripple of the input torque, peak to peak", "ΔT_1"),
    "transmission_error": angle("transmission error at the output, peak to peak", "TE", "arcsec"),
    "kinematic_error": angle("kinematic error at the output, peak to peak", "KE", "arcsec"),
}
"""Figures of the table, in its order."""

Read = Callable[["_AtPoint"], float]


class _LacksError(Exception):
    """Why a drive has no such figure."""


@dataclass(frozen=True)
class _Curve:
    """Efficiencies at `LOADS`, then at `SPEEDS`, and by place why some could not be computed."""

    values: Float[np.ndarray, " point"]
    refused: Mapping[int, str]


@dataclass(frozen=True, eq=False)
class BenchedDrive:
    """What one drive answers.

    Attributes:
        name: among the others.
        title: of its case.
        family: its stages from the input, in words.
        law: friction law, the first one of the case.
        scope: what the efficiency is of, in words.
        figures: by name of `BENCHED` [SI]; those that it has.
        lacks: why it has none, in a sentence, by name.
        remarks: sentences on what it has.
        efficiency, back_efficiency: at `LOADS`, forwards and backwards; not numbers where it locks.
        efficiency_over_speed, back_efficiency_over_speed: at `SPEEDS`.
    """

    name: str
    title: str
    family: str
    law: str
    scope: str
    figures: Mapping[str, float]
    lacks: Mapping[str, str]
    remarks: tuple[str, ...]
    efficiency: Float[np.ndarray, " load"]
    back_efficiency: Float[np.ndarray, " load"]
    efficiency_over_speed: Float[np.ndarray, " speed"]
    back_efficiency_over_speed: Float[np.ndarray, " speed"]


_CURVES = (
    "efficiency",
    "back_efficiency",
    "efficiency_over_speed",
    "back_efficiency_over_speed",
)


@dataclass(frozen=True)
class Bench:
    """Drives beside each other.

    Attributes:
        drives: in the order in which they were named.
    """

    drives: tuple[BenchedDrive, ...]

    @property
    def table(self) -> xr.Dataset:
        """Figures [drive] with efficiencies over load and speed [SI]; not numbers where a drive has none."""
        columns: dict[str, Any] = {
            name: (
                "drive",
                [drive.figures.get(name, nan) for drive in self.drives],
                {"long_name": variable.long_name, "units": variable.unit},
            )
            for name, variable in BENCHED.items()
        }
        over = {"efficiency": "load", "efficiency_over_speed": "speed"}
        for name in _CURVES:
            axis = over[name.removeprefix("back_")]
            rows = np.array([getattr(drive, name) for drive in self.drives])
            title = f"{name}_over_load" if axis == "load" else name
            columns[title] = (("drive", axis), rows, {"units": "1"})
        return xr.Dataset(
            {"family": ("drive", [drive.family for drive in self.drives]), **columns},
            coords={
                "drive": [drive.name for drive in self.drives],
                "load": ("load", [*LOADS], {"long_name": "part of the load"}),
                "speed": ("speed", [*SPEEDS], {"long_name": "part of the speed"}),
            },
        )

    def as_json(self) -> list[dict[str, Any]]:
        """A record of each drive: figures in SI, why it lacks others, its curves."""
        return [
            {
                "drive": drive.name,
                "title": drive.title,
                "family": drive.family,
                "friction": drive.law,
                "efficiency_of": drive.scope,
                "figures": dict(drive.figures),
                "lacks": dict(drive.lacks),
                "remarks": [*drive.remarks],
                "load": [*LOADS],
                "speed": [*SPEEDS],
                **{name: getattr(drive, name).tolist() for name in _CURVES},
            }
            for drive in self.drives
        ]


@double_precision()
def bench(
    cases: CaseLike | Sequence[CaseLike],
    *,
    names: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Bench:
    """Drives of any families beside each other: what each answers at its operating point.

    Args:
        cases: one or a list, each the name of a shipped case, a file, a folder of results, a `Case` or
            tables; of several variants the first one, or "file.toml@variant".
        names: of the drives on the bench, one for each; those of the cases unless given.
        progress: told about each drive.

    Returns:
        A row for each: ratio, mass, room, efficiency forwards and backwards, torques without load and from
        rest, stiffness, backlash, lost motion, inertia and ripple, each as `run` of that case has it.

    Raises:
        InputError: anything wrong with a case; a drive that is named twice, or that transmits no torque.

    Validity: as that of the parts of the result; figures stand under the first friction law of each case.
    Stiffness of a case that does not ask how its teeth yield is that with load_sharing = "from_stiffness".

    Example:
        >>> from pitchpoint.runs.bench import bench
        >>> bench([])
        Traceback (most recent call last):
            ...
        pitchpoint.errors.InputError: no drive was named; name cases, files or folders of results
    """
    demand_arguments(names=names)
    if isinstance(cases, str | Path | Case | Mapping):
        listed: list[CaseLike] = [cases]
    elif isinstance(cases, Iterable):
        listed = [*cases]
    else:
        raise InputError(
            f"{shown(cases)} was given; a bench takes a case or a list of cases, each a file, the name of a "
            "shipped case, or a dictionary of tables"
        )
    if not listed:
        raise InputError("no drive was named; name cases, files or folders of results")
    if names is not None and len(names) != len(listed):
        raise InputError(f"{len(names)} were given for {len(listed)} cases", key="names")
    named = _named(listed, names)
    watching = progress or Progress()
    watching.expect(len(named))
    opened = {name: variant.built({}) for name, variant in named.items()}
    for name, built in opened.items():
        _demand_reducer(name, built)  # before any is computed
    drives = []
    for name, variant in named.items():
        watching.part(name, "bench", False)
        drives.append(_benched(name, variant, opened[name]))
    return Bench(tuple(drives))


def _named(cases: Sequence[CaseLike], names: Sequence[str] | None) -> dict[str, Variant]:
    """The first variant of each case, or that which is named, by the names given or by short ones."""
    variants: list[Variant] = []
    labels: list[str] = []
    for case in cases:
        reference = resolved_reference(str(case)) if isinstance(case, str | Path) else None
        source = case if reference is None else reference.case
        only = [reference.variant] if reference and reference.variant else []
        variants.append(selected_variants(source, only)[0])
        labels.append(variants[-1].label if reference is None else str(case))
    labels = labels if names is None else [*names]
    for label in labels:
        if labels.count(label) > 1:
            raise InputError(
                f"{shown(visible(label))} was named twice; name each drive once",
                key=None if names is None else "names",
            )
    short = design_names(labels) if names is None else dict(zip(labels, labels, strict=True))
    return {short[label]: variant for label, variant in zip(labels, variants, strict=True)}


@dataclass(frozen=True)
class _AtPoint:
    """A drive while its figures are read.

    Attributes:
        built: the case.
        parts: of its result that the table reads.
        failed: what went wrong with others, by name.
        forwards, backwards: its efficiencies.
    """

    built: Ready
    parts: Mapping[str, xr.Dataset]
    failed: Mapping[str, str]
    forwards: _Curve
    backwards: _Curve

    def part(self, name: str) -> xr.Dataset:
        """A part of the result; why it is not there, as an error."""
        if name in self.parts:
            return self.parts[name]
        why = self.failed.get(name) or ANALYSES[name].why_not(self.built)
        raise _LacksError(why or "it was not computed")

    def under_first_law(self, part: str, name: str) -> float:
        """A figure of the operating point."""
        return _number(self.part(part)[name].values.ravel()[0])

    def in_motion(self, name: str) -> float:
        """A torque without load, at the speed and temperature of the operating point."""
        point, data = self.built.case.operation, self.part("running")
        there = {axis: getattr(point, axis) for axis in ("speed", "temperature")}
        array = data[name].isel(law=0)
        return _number(array.sel({dim: there[str(dim)] for dim in array.dims}, method="nearest"))

    def at_load(self, name: str) -> float:
        """A figure of the wind-up under the load of the operating point."""
        data = self.part("torsion")
        load = self.built.case.operation.load
        return _number(np.interp(load, data["torque"], data[name]), "no equilibrium was found")


def _number(value: Any, why: str = "friction holds the drive") -> float:
    """A number; why it is none, as an error."""
    if not isfinite(value):
        raise _LacksError(why)
    return float(value)


def _benched(name: str, variant: Variant, built: Ready) -> BenchedDrive:
    parts, failed = _computed(variant, PARTS)
    remarks = _doubtful(built, parts)
    if "torsion" not in parts and "torsion" not in failed:
        yielding = replace(variant, settings={**variant.settings, **YIELDING})
        by_teeth, of_torsion = _computed(yielding, ["torsion"])
        parts, failed = parts | by_teeth, failed | of_torsion
        remarks += ['the stiffness is that with load_sharing = "from_stiffness"'] * bool(by_teeth)
    forwards, backwards = _efficiencies(variant, built)
    at_point = _AtPoint(built, parts, failed, forwards, backwards)
    figures: dict[str, float] = {}
    lacks: dict[str, str] = {}
    for figure, read in _READ.items():
        try:
            figures[figure] = read(at_point)
        except _LacksError as why:
            lacks[figure] = str(why)
    remarks += [*_remarks(parts, figures), *_gaps(forwards, backwards)]
    return BenchedDrive(
        name,
        str(variant.document().tree.get("title", name)),
        _family(built),
        built.law_names[0],
        _scope(parts),
        figures,
        lacks,
        tuple(map(str, remarks)),
        forwards.values[: len(LOADS)],
        backwards.values[: len(LOADS)],
        forwards.values[len(LOADS) :],
        backwards.values[len(LOADS) :],
    )


def _doubtful(built: Ready, parts: Mapping[str, xr.Dataset]) -> list[str]:
    """What cannot be, in whole, and what else the first screen of a run would call doubtful, in brief."""
    of_point = doubts_of(parts["operation"].attrs) if "operation" in parts else []
    ranked = ranked_doubts([*unlikely(built, parts), *built.warnings, *of_point])
    briefs = (as_doubt(text).brief for text in ranked["warnings"])
    return [*ranked["implausible"], *(brief.rstrip(".") for brief in briefs)]


def _demand_reducer(name: str, built: Ready) -> None:
    """InputError for what has no ratio, no load or no output that turns."""
    if not built.transmits:
        why = "is a test rig, which transmits nothing"
    elif built.travels:
        why = "has an end that travels"
    elif not built.case.operation.load > 0.0:
        why = "carries nothing at its operating point"
    else:
        return
    raise InputError(f"{why}; a bench is for drives that turn and carry a torque", file=name)


def _computed(
    variant: Variant, names: Sequence[str]
) -> tuple[dict[str, xr.Dataset], dict[str, str]]:
    """Parts of a case, and what went wrong with those that found no balance, by name."""
    parts: dict[str, xr.Dataset] = {}
    failed: dict[str, str] = {}
    for job in jobs(variant, {}, names):
        try:
            parts[job.name] = job.joined([job.compute(piece) for piece in job.pieces])
        except ConvergenceError as error:
            failed[job.name] = str(error)
    return parts, failed


def _efficiencies(variant: Variant, built: Ready) -> tuple["_Curve", "_Curve"]:
    """Efficiencies forwards and backwards.

    Each point is the case with that torque or speed, as a sweep has it.
    """
    point = built.case.operation
    speed = convert(point.speed, "rpm", "rotational speed")
    changes = [
        *({"operation.torque": f"{part * point.load!r} N m"} for part in LOADS),
        *({"operation.speed": f"{part * speed:.15g} rpm"} for part in SPEEDS),
    ]
    points = variant.built_each(changes)
    return _along(points), _along([_turned(one) for one in points])


def _turned(point: Ready | InputError) -> Ready | InputError:
    """The same point driven from its output; what is wrong with it."""
    try:
        return point if isinstance(point, InputError) else point.backwards
    except InputError as error:
        return error


def _along(points: Sequence[Ready | InputError]) -> "_Curve":
    """Efficiencies of points under the first law, not numbers where friction locks; why others are none."""
    refused = {k: str(one) for k, one in enumerate(points) if isinstance(one, InputError)}
    there = {k: one for k, one in enumerate(points) if not isinstance(one, InputError)}
    values = np.full(len(points), nan)
    if not there:
        return _Curve(values, refused)
    ready = [*there.values()]
    try:
        data = summaries(ready, ready[0].models[:1], {}, title="bench", may_lock=True)
    except ConvergenceError as error:
        if len(points) == 1:
            return _Curve(values, {0: str(error)})
        alone = [_along([one]) for one in points]
        lacking = {k: one.refused[0] for k, one in enumerate(alone) if one.refused}
        return _Curve(np.concatenate([one.values for one in alone]), lacking)
    values[[*there]] = data["mean_efficiency"].values[0]
    return _Curve(values, refused)


def _family(built: Ready) -> str:
    """Families of the stages from the input, in words."""
    stages = (built,) if 0 in built.trains or not built.stages else built.stages
    return " + ".join(_family_of(stage) for stage in stages)


def _family_of(stage: Any) -> str:
    if not stage.trains:
        return str(stage.case.gears.family).replace("_", " ")
    design = stage.design
    second = any(place.planet_gear > 1 for place in design.meshes)
    if any(place.carrier in design.free for place in design.meshes):
        return "3K"
    return "stepped planets" if second else "planetary"


def _ratio(at: _AtPoint) -> float:
    return 1.0 / float(at.built.output_rate)


def _room(dimension: str) -> Read:
    def read(at: _AtPoint) -> float:
        room = gear_envelope(at.built)
        if room is None:
            raise _LacksError("the circles around its gears are not known")
        return float(getattr(room, dimension))

    return read


def _mass(at: _AtPoint) -> float:
    unknown = "the mass of one of its bodies is not known"
    if at.built.numbers:
        return _number(at.part("reflected")["drive_mass"], unknown)
    if "bodies" in at.parts:
        return _number(at.part("bodies")["body_mass"].sum(skipna=False), unknown)
    return _number(at.part("inspection")["disc_mass"].sum(skipna=False), unknown)


def _inertia(at: _AtPoint) -> float:
    unknown = "the inertia of one of its bodies is not known"
    part = "reflected" if at.built.numbers else "bodies"
    if at.built.numbers or "bodies" in at.parts:
        data = at.part(part)
        if "reflected_inertia" not in data:
            raise _LacksError(unknown)
        return _number(data["reflected_inertia"].sel(end="input"), unknown)
    discs = at.part("inspection")["disc_inertia"].values
    rates = np.asarray(at.built.motion) / at.built.motion[0]
    return _number(np.sum(discs * rates**2), unknown)


def _backlash(at: _AtPoint) -> float:
    """The mean one by tolerances, else that of the nominal teeth; of others the play of their flanks."""
    for part, name in (("reflected", "output_backlash"), ("inspection", "backlash_angle")):
        data = at.parts.get(part)
        if data is not None and name in data and (part == "reflected" or not at.built.numbers):
            values = data[name]
            case = "mean" if "mean" in values["case"].values else values["case"].values[0]
            play = values.sel(case=case)
            return _number(play if play.ndim == 0 else play.isel(gear=_loaded(at.built)))
    return max(float(at.part("torsion")["kinematic_play"]), 0.0)


def _loaded(built: Any) -> int:
    """Number of the member that a mesh loads."""
    return int(np.argmax(np.asarray(built.nominal["loaded"])))


def _remarks(parts: Mapping[str, xr.Dataset], figures: Mapping[str, float]) -> Iterator[str]:
    """What is to be known of figures that are there."""
    if "backlash" in figures and not _by_tolerances(parts):
        none = abs(figures["backlash"]) < NO_PLAY
        yield "the backlash is nominal" + ": no allowance is given" * none
    running = parts.get("running")
    if running is not None and any(
        "starting_torque" in doubt.about for doubt in doubts_of(running.attrs)
    ):
        yield "the torques from rest are lower bounds: no breakaway is given"


def _gaps(forwards: _Curve, backwards: _Curve) -> Iterator[str]:
    """Points of the curves that could not be computed, with the first reason of each axis."""
    refused = {**backwards.refused, **forwards.refused}
    for first, axis, parts in ((0, "load", LOADS), (len(LOADS), "speed", SPEEDS)):
        places = [k for k in range(first, first + len(parts)) if k in refused]
        if places:
            percents = enumerated([f"{100.0 * parts[k - first]:g}" for k in places])
            yield f"without an efficiency at {percents} % of the {axis}: {refused[places[0]]}"


def _by_tolerances(parts: Mapping[str, xr.Dataset]) -> bool:
    """True where a tolerance makes the backlash differ, or it is the play of a strain wave gear."""
    plays = [
        parts[part][name]
        for part, name in (("reflected", "output_backlash"), ("inspection", "backlash_angle"))
        if part in parts and name in parts[part]
    ]
    return not plays or bool((plays[0].max("case") > plays[0].min("case")).any())


def _scope(parts: Mapping[str, xr.Dataset]) -> str:
    """What the efficiency is of, in words."""
    data = parts.get("operation")
    if data is None:
        return ""
    of = efficiency_coverage(data).partition(":")[0] or "whole drive"
    lacks = data["mean_efficiency"].attrs.get("lacks")
    return f"{of}, without the {lacks}" if lacks else of


def _lost_motion(at: _AtPoint) -> float:
    data = at.part("torsion")
    if "catalogue_lost_motion" not in data:
        raise _LacksError("lost motion as in catalogues is told of a strain wave gear by itself")
    return _number(data["catalogue_lost_motion"].values.ravel()[0])


def _kinematic_error(at: _AtPoint) -> float:
    data = at.part("kinematic_error")
    if at.built.numbers:
        raise _LacksError("errors of several meshes are told by stage")
    return _number(data["kinematic_error_range"].values.ravel()[0])


def _of_curve(curve: str, part: float) -> Read:
    """An efficiency at a part of the load."""

    def read(at: _AtPoint) -> float:
        place, along = LOADS.index(part), getattr(at, curve)
        why = along.refused.get(place, "friction holds the drive, or no balance was found")
        return _number(along.values[place], why)

    return read


_READ: Mapping[str, Read] = {
    "ratio": _ratio,
    "drive_mass": _mass,
    "outer_diameter": _room("diameter"),
    "gear_length": _room("length"),
    "output_torque": lambda at: float(at.built.case.operation.load),
    "input_speed": lambda at: float(at.built.case.operation.speed),
    "efficiency": lambda at: at.under_first_law("operation", "mean_efficiency"),
    "efficiency_quarter": _of_curve("forwards", 0.25),
    "efficiency_tenth": _of_curve("forwards", 0.1),
    "back_efficiency": lambda at: at.under_first_law("back_driving", "mean_efficiency"),
    "back_efficiency_quarter": _of_curve("backwards", 0.25),
    "back_efficiency_tenth": _of_curve("backwards", 0.1),
    "no_load_torque": lambda at: at.in_motion("no_load_torque"),
    "starting_torque": lambda at: at.in_motion("starting_torque"),
    "back_driving_torque": lambda at: at.in_motion("back_driving_torque"),
    "torsional_stiffness": lambda at: at.at_load("torsional_stiffness"),
    "backlash": _backlash,
    "lost_motion": _lost_motion,
    "input_inertia": _inertia,
    "torque_ripple": lambda at: at.under_first_law("operation", "torque_ripple"),
    "transmission_error": lambda at: at.at_load("angular_transmission_error_range"),
    "kinematic_error": _kinematic_error,
}
"""How each figure of `BENCHED` is read."""
