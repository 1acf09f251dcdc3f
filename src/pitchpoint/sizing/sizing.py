"""From torque, ratio, speed and life to a front of designs, each of which is a case file that runs."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import tomlkit
import xarray as xr

from pitchpoint._jax import double_precision
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.analysis_registry import REFLECTED
from pitchpoint.analyses.bodies import bodies_of
from pitchpoint.analyses.strength import ratings_of
from pitchpoint.analyses.summaries import summaries
from pitchpoint.analyses.torsion import stiffness_at_load
from pitchpoint.cases.built_drive import Ready
from pitchpoint.core.doubts import GUESSED
from pitchpoint.errors import InputError
from pitchpoint.registry import enumerated
from pitchpoint.results.store import make_folder, write_text
from pitchpoint.runs.run import load_case
from pitchpoint.sizing.arrangements import SET_RATIOS
from pitchpoint.sizing.combining import (
    Drives,
    NoDriveError,
    drives_of,
    exactly_loaded,
    with_tried_shifts,
)
from pitchpoint.sizing.front import non_dominated, representatives
from pitchpoint.sizing.stage_forms import case_of, gears_as_discs
from pitchpoint.sizing.strain_wave import (
    RATIOS,
    SIZES,
    StrainWaveSize,
    strain_wave_case,
    strain_wave_sizes,
    why_no_size,
)
from pitchpoint.sizing.task_table import Task, read_task

__all__ = ["SizedDrive", "Sizing", "families_by_reason", "size", "sized_for"]

Tree = dict[str, Any]

OF_EACH = 24
"""Designs of a family that are worked out; of pairs up to three more, see `Drives.in_place_of`."""


@dataclass(frozen=True, kw_only=True)
class SizedDrive:
    """A design of a drive, with what its case file computes.

    Attributes:
        name: of its file.
        family: of `SIZED_FAMILIES`.
        tree: tables of its case.
        ratio: speed of the input over that of the output, without its sense.
        mass: of the gears as discs, a strain wave gear with its bodies [kg].
        loss: part of the power that is lost, of strain wave gears with their bearing and grease.
        diameter, length: of the gears [m].
        backlash: mean one at the output, by the fields of thickness and centre distance [rad].
        stiffness: at the output under the torque of the task, the input held, of teeth and, of strain wave
            gears, of what is behind them [N m/rad].
        inertia: at the input [kg m2].
        flank_safety, root_safety: least ones; not numbers of strain wave gears.
    """

    name: str
    family: str
    tree: Tree = field(repr=False)
    ratio: float
    mass: float
    loss: float
    diameter: float
    length: float
    backlash: float
    stiffness: float
    inertia: float
    flank_safety: float
    root_safety: float

    @property
    def loss_range(self) -> tuple[float, float]:
        """Loss as friction laws disagree far from what they were fitted to."""
        return self.loss * (1.0 - GUESSED), self.loss * (1.0 + GUESSED)

    @property
    def case(self) -> str:
        """Text of a case file."""
        figures = (
            f"{self.family}, ratio {self.ratio:.5g}: {self.mass:.4g} kg, loss {100.0 * self.loss:.3g} %, "
            f"diameter {1e3 * self.diameter:.4g} mm"
        )
        return f"# {figures}; as sized.\n{tomlkit.dumps({'title': figures} | self.tree)}"


@dataclass(frozen=True, eq=False)
class Sizing:
    """Designs that do what is asked.

    Attributes:
        task: what is asked.
        designs: all that were worked out, by family.
        front: names of those that no other one beats in what counts.
        tried: numbers of gears that were rated with a module and a load, by family.
        without: why families have no design, by family.
    """

    task: Task
    designs: Mapping[str, SizedDrive]
    front: tuple[str, ...]
    tried: Mapping[str, int]
    without: Mapping[str, str]

    @property
    def best(self) -> dict[str, str]:
        """Names of the designs of the front that are best by each aim, and of a balanced one.

        The balanced one has the least sum of the squares of what it lacks of the best of each aim, over the
        median of the front.
        """
        costs = np.array([_costs(self.designs[name], self.task.aims) for name in self.front])
        best = {aim: self.front[int(costs[:, k].argmin())] for k, aim in enumerate(self.task.aims)}
        scale = np.maximum(np.median(costs, axis=0) - costs.min(axis=0), 1e-300)
        lacks = np.sum(((costs - costs.min(axis=0)) / scale) ** 2, axis=1)
        return best | {"balanced": self.front[int(lacks.argmin())]}

    @property
    def table(self) -> xr.Dataset:
        """Figures of all designs over `design`, and whether they are on the front."""
        rows = [*self.designs.values()]
        units = {
            "ratio": "1",
            "mass": "kg",
            "loss": "1",
            "diameter": "m",
            "length": "m",
            "backlash": "rad",
            "stiffness": "N m/rad",
            "inertia": "kg m2",
            "flank_safety": "1",
            "root_safety": "1",
        }
        columns = {
            name: ("design", [getattr(row, name) for row in rows], {"units": unit})
            for name, unit in units.items()
        }
        names = [*self.designs]
        return xr.Dataset(
            {
                "family": ("design", [row.family for row in rows]),
                "on_front": ("design", [name in self.front for name in names]),
                **columns,
            },
            coords={"design": names},
        )

    @staticmethod
    def demand_unused(folder: Path) -> None:
        """InputError for a folder that holds a report or designs of a sizing, before any is searched."""
        for path in (folder / "report.html", *sorted(folder.glob("*_[0-9][0-9].toml"))):
            if path.exists():
                raise InputError("is there already; name another folder", file=str(path))

    def write(self, folder: Path | str) -> list[Path]:
        """Write each design of the front as a case file, all of them or none.

        Args:
            folder: made if it is not there.

        Raises:
            InputError: files of these names are there.
            OSError: the disk is full, say.
        """
        place = Path(folder)
        make_folder(place)
        paths = [place / f"{name}.toml" for name in self.front]
        for path in paths:
            if path.exists():
                raise InputError("is there already; name another folder", file=str(path))
        with TemporaryDirectory(prefix=".front-", dir=place) as beside:
            for path, name in zip(paths, self.front, strict=True):
                write_text(Path(beside) / path.name, self.designs[name].case)
            for path in paths:
                (Path(beside) / path.name).rename(path)
        return paths


def size(
    torque: str | Path | None = None,
    ratio: float | None = None,
    speed: str | None = None,
    life: str | None = None,
    *,
    ratio_tolerance: float | None = None,
    diameter: str | None = None,
    length: str | None = None,
    centre_distances: str | Sequence[str] | None = None,
    families: str | Sequence[str] | None = None,
    material: str | None = None,
    flank_safety: float | None = None,
    root_safety: float | None = None,
    application_factor: float | None = None,
    face_load_factor: float | None = None,
    slenderness: float | None = None,
    aims: str | Sequence[str] | None = None,
    lubricant: str | None = None,
    temperature: str | None = None,
) -> Sizing:
    """Designs of drives for a torque, a ratio, a speed and a life, and the front of those that none beats.

    Args:
        torque: at the output, with its unit; or a file with a task, "task.toml", whose values what is given
            beside it takes the place of.
        ratio: speed of the input over that of the output, of either sense.
        speed: of the output.
        life: time under load.
        ratio_tolerance: part by which the ratio may differ, 0.03 unless given.
        diameter, length: largest ones of the gears.
        centre_distances: largest ones of pairs, one, or one for each stage from the input.
        families: those that are tried, all of `SIZED_FAMILIES` unless given.
        planets: numbers of them that sets may have, "3, 4"; 3 to 5, of stepped and 3K sets 3 and 4, unless
            given.
        material: of all gears, "case-hardened-mq" unless given.
        flank_safety, root_safety: least ones, 1.2 and 1.5 unless given.
        application_factor, face_load_factor: K_A and K_Hbeta by which teeth are rated, 1 unless given.
        slenderness: largest face width over the diameter of the pinion or sun, 1.2 unless given.
        aims: what counts, some of mass, loss, diameter and backlash, all unless given.
        lubricant: "pao-vg-150" unless given.
        temperature: of the oil, "60 degC" unless given.

    Returns:
        All designs that were worked out, each a case that opens and runs.

    Raises:
        InputError: a value that is wrong; no design does it, with what stands against it and by how much.

    Validity: spur and helical teeth, planetary, stepped and 3K sets are rated by ISO 6336-2 and -3 with K_A
    and K_Hbeta as given, K_Halpha = 1 and K_v by method C, planets with their mesh load factor; losses are
    those of teeth by ISO/TR 14179-2. Shafts, bearings, seals, oil that is churned, housings and carriers
    are in nothing. Strain wave gears have the proportions and the rating of a catalogue, and no rated
    teeth. Profile shifts of pairs and widths go in steps: `optimise` on the case of a design goes between
    them.

    Example:
        >>> from pitchpoint.sizing.sizing import size
        >>> size("60 N m", 60.0, "30 rpm", "5000 h", families="planetary")
        Traceback (most recent call last):
            ...
        pitchpoint.errors.InputError: no drive does this: planetary: reaches ratios of 2.8 to 11, 60 is asked
    """
    options = dict(locals())
    if isinstance(torque, Path) or str(torque).endswith(".toml"):
        return sized_for(read_task(options.pop("torque"), **options))
    return sized_for(Task.read(**options))


@double_precision()
def sized_for(task: Task) -> Sizing:
    """Designs of drives for a task, as `size` has them.

    Args:
        task: what is asked.
    """
    _demand_oil(task)
    designs: list[SizedDrive] = []
    tried: dict[str, int] = {}
    without: dict[str, str] = {}
    for family in task.families:
        try:
            made, tried[family] = _MAKERS.get(family, _of_stages)(task, family)
            designs += made
        except NoDriveError as error:
            without[family] = error.words
    if not designs:
        raise _infeasible(without)
    front = non_dominated(np.array([_costs(design, task.aims) for design in designs]))
    names = tuple(design.name for design, on in zip(designs, front, strict=True) if on)
    return Sizing(task, {design.name: design for design in designs}, names, tried, without)


def _demand_oil(task: Task) -> None:
    """InputError where cases of the task are refused whatever their teeth, before gears are blamed for it."""
    pair = {"teeth": [20, 40], "module": "1 mm", "face_width": "10 mm"}
    try:
        load_case(case_of(task, [pair], task.torque, task.speed))
    except InputError as error:
        raise InputError(error.message, key=(error.key or "").rpartition(".")[2]) from None


def _costs(design: SizedDrive, aims: Sequence[str]) -> list[float]:
    return [float(getattr(design, aim)) for aim in aims]


def _infeasible(without: Mapping[str, str]) -> InputError:
    """What stands against every family, each with how much it misses."""
    told = "; ".join(f"{names}: {words}" for words, names in families_by_reason(without).items())
    return InputError(f"no drive does this: {told}")


def families_by_reason(without: Mapping[str, str]) -> dict[str, str]:
    """Families without a design, listed in words, by what stands against them.

    Args:
        without: reasons by family.

    Example:
        >>> from pitchpoint.sizing.sizing import families_by_reason
        >>> families_by_reason({"planetary": "too large", "3K": "too slow", "one stage": "too large"})
        {'too large': 'planetary and one stage', 'too slow': '3K'}
    """
    families: dict[str, list[str]] = {}
    for family, words in without.items():
        families.setdefault(words, []).append(family)
    return {words: enumerated(names) for words, names in families.items()}


def _of_stages(task: Task, family: str) -> tuple[list[SizedDrive], int]:
    """Designs of a family of stages, and how many gears were rated for them."""
    drives = drives_of(task, family)
    few = exactly_loaded(task, _within(task, drives).few(OF_EACH))
    few = _within(task, few) if len(few) else few
    if len(few) and few.of_pairs:
        few = _within(task, with_tried_shifts(task, few)).in_place_of(few)
    cases = {number: _opened(task, few, number) for number in range(len(few))}
    open_ones = {number: case for number, case in cases.items() if case is not None}
    if not open_ones:
        raise NoDriveError("no teeth that bear the load run with the backlash of their fields")
    made = [
        _designed(family, _name(family, place), few, number, *case)
        for place, (number, case) in enumerate(open_ones.items())
    ]
    return made, few.tried


FILES = {
    "one stage": "1_stage",
    "two stages": "2_stages",
    "three stages": "3_stages",
    "planetary": "planetary",
    "two planetary sets": "2_sets",
    "stepped planets": "stepped",
    "3K": "3K",
    "strain wave": "strain_wave",
    "planetary and strain wave": "set_and_wave",
}
"""What names of designs begin with, by family."""


def _name(family: str, number: int) -> str:
    return f"{FILES[family]}_{number + 1:02d}"


def _within(task: Task, drives: Drives) -> Drives:
    """Those in the envelope; NoDriveError where there are none."""
    sizes = {"diameter": drives.diameter, "length": drives.length}
    small = np.ones(len(drives), bool)
    for key, values in sizes.items():
        most = getattr(task, key)
        if most is not None and not (small & (values <= most)).any():
            least = float(values[small].min(initial=np.inf))
            beside = " in that diameter" if key == "length" and task.diameter else ""
            words = f"the least {key} of gears{beside} is {1e3 * least:.4g} mm"
            raise NoDriveError(f"{words}, {1e3 * most:.4g} mm are allowed")
        small &= values <= (np.inf if most is None else most)
    return drives[small]


def _opened(task: Task, drives: Drives, number: int) -> tuple[Tree, Ready] | None:
    """The case of a drive and what it opens as; None where it is refused, as its teeth are too thin."""
    forms = [drives.forms.forms[k] for k in drives.form[number]]
    sizes = zip(forms, drives.module[number], drives.width[number], strict=True)
    tables = [form.table(module, width) for form, module, width in sizes]
    tree = case_of(task, tables, task.torque, task.speed * float(drives.ratio[number]))
    try:
        return tree, load_case(tree)
    except InputError:
        return None


def _designed(
    family: str, name: str, drives: Drives, number: int, tree: Tree, built: Ready
) -> SizedDrive:
    """A drive with the figures of its case.

    Args:
        family, name: of it.
        drives, number: which one it is.
        tree, built: its case, and what that opens as.
    """
    rated = ratings_of([built], 1)
    mass, inertia, backlash = gears_as_discs(built)
    return SizedDrive(
        name=name,
        family=family,
        tree=tree,
        ratio=abs(1.0 / built.output_rate),
        mass=mass,
        loss=float(drives.loss[number]),
        diameter=float(drives.diameter[number]),
        length=float(drives.length[number]),
        backlash=backlash,
        stiffness=stiffness_at_load(built),
        inertia=inertia,
        flank_safety=float(rated["least_flank_safety"][1][0, 0]),
        root_safety=float(rated["least_root_safety"][1][0, 0]),
    )


def _strain_waves(task: Task, family: str) -> tuple[list[SizedDrive], int]:
    """Designs of strain wave gears."""
    sizes = strain_wave_sizes(task, task.ratio)
    if not sizes:
        raise NoDriveError(why_no_size(task, task.ratio))
    small = [one for one in sizes if _fits(task, one)]
    if not small:
        raise NoDriveError(
            f"the smallest one has a diameter of {1e3 * sizes[0].outside:.4g} mm and a cup of "
            f"{1e3 * sizes[0].length:.3g} mm length, more than is allowed"
        )
    made = _waves_designed(task, family, small)
    return made, len(SIZES)


def _fits(task: Task, gear: StrainWaveSize) -> bool:
    limits = ((task.diameter, gear.outside), (task.length, gear.length))
    return all(most is None or value <= most for most, value in limits)


def _waves_designed(task: Task, family: str, sizes: Sequence[StrainWaveSize]) -> list[SizedDrive]:
    """Strain wave gears with the losses of their case, which no closed form has."""
    trees = [strain_wave_case(task, one, task.speed * one.ratio) for one in sizes]
    built = [load_case(tree) for tree in trees]
    data = summaries(built, built[0].models, {}, title=family, several=True)
    made = []
    for number, (gear, tree, one) in enumerate(zip(sizes, trees, built, strict=True)):
        bodies = bodies_of(one.meshes[0], {}, silent)
        made.append(
            SizedDrive(
                name=_name(family, number),
                family=family,
                tree=tree,
                ratio=gear.ratio,
                mass=float(bodies["body_mass"].sum()),
                loss=1.0 - float(data["mean_efficiency"][0, number]),
                diameter=gear.outside,
                length=gear.length,
                backlash=0.0,
                stiffness=stiffness_at_load(one),
                inertia=float(bodies["reflected_inertia"].sel(end="input")),
                flank_safety=nan,
                root_safety=nan,
            )
        )
    return made


FIRST_RATIOS = 3.0, 4.0, 5.5, 7.5, 10.0
"""Ratios of a planetary set before a strain wave gear that are tried, about."""

SETS_BEFORE, WITH_SETS = 4, 12
"""Planetary sets before a strain wave gear that are tried, and designs of both that are worked out."""


@dataclass(frozen=True, eq=False)
class _SetBefore:
    """A planetary set before a strain wave gear.

    Attributes:
        task: of the set.
        drives, number: sets, and which of them it is.
        gear, design: the strain wave gear, and it alone.
    """

    task: Task
    drives: Drives
    number: int
    gear: StrainWaveSize
    design: SizedDrive

    @property
    def costs(self) -> list[float]:
        """Mass [kg], part of the power that is lost, and diameter [m]."""
        loss = float(self.drives.loss[self.number])
        return [
            float(self.drives.mass[self.number]) + self.design.mass,
            1.0 - (1.0 - loss) * (1.0 - self.design.loss),
            max(float(self.drives.diameter[self.number]), self.design.diameter),
        ]

    @property
    def length(self) -> float:
        """Of the gears behind each other [m]."""
        return float(self.drives.length[self.number]) + self.design.length

    def tree(self, task: Task, set_case: Tree) -> Tree:
        """Tables of the case of both.

        Args:
            task: of the whole.
            set_case: tables of the case of the set.
        """
        speed = task.speed * self.gear.ratio * float(self.drives.ratio[self.number])
        wave = strain_wave_case(task, self.gear, speed)
        of_wave = {key: wave[key] for key in ("gears", "losses", "models")}
        steel = {"gear_1": "steel", "gear_2": "steel"}  # as of a strain wave gear alone
        tables = {key: table for key, table in set_case.items() if key != "gears"}
        return {
            "stages": [{"gears": set_case["gears"]}, {**of_wave, "materials": steel}],
            **tables,
            "operation": wave["operation"],
        }


def _sets_before_strain_waves(task: Task, family: str) -> tuple[list[SizedDrive], int]:
    """Designs of a planetary set that drives a strain wave gear."""
    low, high = (most * of_set for most, of_set in zip(RATIOS, SET_RATIOS, strict=True))
    if not low <= task.ratio <= high:
        raise NoDriveError(f"reaches ratios of {low:.3g} to {high:.4g}, {task.ratio:.6g} is asked")
    both, tried = _with_sets(task, family)
    costs = np.array([one.costs for one in both])
    front = np.flatnonzero(non_dominated(costs))
    made: list[SizedDrive] = []
    for number in front[representatives(costs[front], WITH_SETS)]:
        opened = _opened(both[number].task, both[number].drives, both[number].number)
        if opened is not None:
            name = _name(family, len(made))
            made.append(_designed_with_set(task, family, name, both[number], *opened))
    if not made:
        raise NoDriveError("no teeth that bear the load run with the backlash of their fields")
    return made, tried


def _with_sets(task: Task, family: str) -> tuple[list[_SetBefore], int]:
    """Sets before strain wave gears that do a task, and how many gears were rated; NoDriveError for none."""
    both, tried, words = [], 0, ""
    for first in FIRST_RATIOS:
        ratio = round(2.0 * task.ratio / first) / 2.0
        if not RATIOS[0] <= ratio <= RATIOS[1]:
            continue
        gears = [gear for gear in strain_wave_sizes(task, ratio) if _fits(task, gear)]
        if not gears:
            words = why_no_size(task, ratio) if not task.diameter and not task.length else words
            continue
        values = {
            "torque": task.torque / ratio,
            "ratio": task.ratio / ratio,
            "speed": task.speed * ratio,
        }
        before = task.model_copy(update=values)
        try:
            drives = _within(before, drives_of(before, "planetary")).few(SETS_BEFORE)
        except NoDriveError as error:
            words = f"the planetary set: {error.words}"
            continue
        tried, drives = tried + drives.tried, exactly_loaded(before, drives)
        both += [
            _SetBefore(before, drives, number, gear, design)
            for gear, design in zip(gears, _waves_designed(task, family, gears), strict=True)
            for number in range(len(drives))
        ]
    longest = np.inf if task.length is None else task.length
    widest = np.inf if task.diameter is None else task.diameter
    small = [one for one in both if one.length <= longest and one.costs[2] <= widest]
    if not small:
        raise NoDriveError(words or "no set and strain wave gear fit into that diameter and length")
    return small, tried


def _designed_with_set(
    task: Task, family: str, name: str, both: _SetBefore, set_case: Tree, built_set: Ready
) -> SizedDrive:
    """A planetary set before a strain wave gear with the figures of its case.

    Args:
        task: of the whole.
        family, name: of the design.
        both: the set and the gear.
        set_case, built_set: case of the set, and what that opens as.
    """
    tree = both.tree(task, set_case)
    built = load_case(tree)
    rated = ratings_of([built], 1)
    bodies = REFLECTED.compute(built, {}, silent)
    _, loss, diameter = both.costs
    return SizedDrive(
        name=name,
        family=family,
        tree=tree,
        ratio=abs(1.0 / built.output_rate),
        mass=float(bodies["drive_mass"]),
        loss=loss,
        diameter=diameter,
        length=both.length,
        backlash=gears_as_discs(built_set)[2] / both.gear.ratio,
        stiffness=stiffness_at_load(built),
        inertia=float(bodies["reflected_inertia"].sel(end="input")),
        flank_safety=float(rated["least_flank_safety"][1][0, 0]),
        root_safety=float(rated["least_root_safety"][1][0, 0]),
    )


_MAKERS: dict[str, Callable[[Task, str], tuple[list[SizedDrive], int]]] = {
    "strain wave": _strain_waves,
    "planetary and strain wave": _sets_before_strain_waves,
}
