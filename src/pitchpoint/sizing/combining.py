"""Sizes of the stages of an arrangement under the load that each of them has, and drives of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod

import numpy as np
from jaxtyping import Float, Int

from pitchpoint.sizing.arrangements import Arrangement, arrangements, reach_words, shifted_pairs
from pitchpoint.sizing.for_ratio import MODULES
from pitchpoint.sizing.front import non_dominated, representatives
from pitchpoint.sizing.stage_forms import Form, Forms, Sized
from pitchpoint.sizing.task_table import Task

__all__ = ["Drives", "NoDriveError", "drives_of", "exactly_loaded", "with_tried_shifts"]

KEPT = {1: 400, 2: 14, 3: 8}
"""Sizes of a stage that are kept for each of its loads, by how many stages there are."""

SERIES = np.array([1e-3 * module for module in MODULES if 0.3 <= module <= 20.0])

LARGE = 1.6
"""Safeties over those asked from which on, in flanks and roots at their least width, gears are too large."""

Load = tuple[int, float, float]
"""Number of a stage, torque at its output [N m] and speed of its input [rad/s]."""


@dataclass(frozen=True, eq=False)
class Drives:
    """Drives of one family; arrays over them.

    Attributes:
        forms: of which their stages are.
        form, module, width: of each stage, shape (drive, stage).
        ratio, mass, loss, diameter, length: as those of `Sized`, of the whole.
        flank, root: least safeties.
        tried: how many gears with a module and a load were rated.
    """

    forms: Forms
    form: Int[np.ndarray, "drive stage"]
    module: Float[np.ndarray, "drive stage"]
    width: Float[np.ndarray, "drive stage"]
    ratio: Float[np.ndarray, " drive"]
    mass: Float[np.ndarray, " drive"]
    loss: Float[np.ndarray, " drive"]
    diameter: Float[np.ndarray, " drive"]
    length: Float[np.ndarray, " drive"]
    flank: Float[np.ndarray, " drive"]
    root: Float[np.ndarray, " drive"]
    tried: int

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, chosen: np.ndarray) -> "Drives":
        arrays = {
            name: value[chosen]
            for name, value in vars(self).items()
            if isinstance(value, np.ndarray)
        }
        return Drives(forms=self.forms, tried=self.tried, **arrays)

    @property
    def costs(self) -> Float[np.ndarray, "drive aim"]:
        """Mass, loss and diameter, less of which is better."""
        return np.stack([self.mass, self.loss, self.diameter], axis=1)

    def few(self, count: int) -> "Drives":
        """At most so many of those that no other one beats: the best by each cost, others evenly by mass."""
        front = self[non_dominated(self.costs)]
        return front[representatives(front.costs, count)]

    @property
    def of_pairs(self) -> bool:
        """True for stages that are all spur or helical pairs."""
        return all(form.kind == "pair" for form in self.forms.forms)

    def in_place_of(self, coarse: "Drives") -> "Drives":
        """For each of the coarse drives the one that betters all its costs by the most, and the best by each.

        Args:
            coarse: drives that these were varied from.
        """
        front = self[non_dominated(self.costs)]
        parts = np.max(front.costs[None] / coarse.costs[:, None], axis=2)
        chosen = np.union1d(parts.argmin(axis=1), front.costs.argmin(axis=0))
        return front[chosen[np.argsort(front.mass[chosen], kind="stable")]]


class NoDriveError(Exception):
    """No drive of a family does what is asked.

    Args:
        words: what stands against it and by how much, without its stop.
    """

    def __init__(self, words: str) -> None:
        super().__init__(words)
        self.words = words


def drives_of(task: Task, family: str) -> Drives:
    """Drives of a family of stages that bear the load, whatever their size.

    Args:
        task: what is asked.
        family: of `SIZED_FAMILIES`, but those with strain wave gears.

    Raises:
        NoDriveError: there are none.
    """
    every = [one for one in arrangements(task, family) if all(one.stages)]
    if not every:
        raise NoDriveError(reach_words(task, family))
    listed = list(dict.fromkeys(form for one in every for stage in one.stages for form in stage))
    forms, number = Forms(task, listed), {form: k for k, form in enumerate(listed)}
    loads: dict[Load, tuple[Form, ...]] = {}
    for one in every:
        for load, stage in zip(_loads(task, one), one.stages, strict=True):
            loads[load] = stage
    options, least, tried = _options(task, forms, number, loads, len(every[0].stages))
    parts = [_combined(forms, [options[load] for load in _loads(task, one)]) for one in every]
    arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    drives = Drives(forms=forms, tried=tried, **arrays)
    if not len(drives):
        raise NoDriveError(
            _apart(task, [[least[load] for load in _loads(task, one)] for one in every])
        )
    off = np.abs(drives.ratio / task.ratio - 1.0)
    if not (off <= task.ratio_tolerance).any():
        near = float(drives.ratio[off.argmin()])
        raise NoDriveError(f"a ratio of {near:.6g} is the nearest one")
    return drives[off <= task.ratio_tolerance]


def exactly_loaded(task: Task, drives: Drives) -> Drives:
    """The same teeth and modules with the widths that their own ratios ask for; those that bear the load.

    Args:
        task: what is asked.
        drives: of one family.
    """
    ratios = drives.forms.ratio[drives.form]
    below = np.cumprod(ratios[:, ::-1], axis=1)[
        :, ::-1
    ]  # of the input of each stage over the output
    each, bears = [], np.ones(len(drives), bool)
    for stage in range(ratios.shape[1]):
        load = task.torque * ratios[:, stage] / below[:, stage]
        values = drives.form[:, stage], drives.module[:, stage], load, task.speed * below[:, stage]
        sizes, enough = drives.forms.sized(*values)
        each.append(sizes)
        bears &= enough
    return Drives(forms=drives.forms, tried=drives.tried, **_totals(drives.forms, each))[bears]


def with_tried_shifts(task: Task, drives: Drives) -> Drives:
    """Drives of the same teeth and modules with each profile shift that is tried, and the least widths.

    Args:
        task: what is asked.
        drives: of pairs, which bear the load.
    """
    listed = drives.forms.forms
    kept = [listed[k] for k in np.unique(drives.form).tolist()]
    teeth = dict.fromkeys(_teeth(form) for form in kept)
    forms = Forms(task, [*kept, *(form for each in teeth for form in shifted_pairs(task, *each))])
    of_teeth: dict[Teeth, list[int]] = {each: [] for each in teeth}
    for number, form in enumerate(forms.forms):
        of_teeth[_teeth(form)].append(number)
    # Drives that differ in nothing but their shifts are one here, stages under the same load too.
    apart = dict.fromkeys(
        tuple(zip((_teeth(listed[k]) for k in row), modules, strict=True))
        for row, modules in zip(drives.form.tolist(), drives.module.tolist(), strict=True)
    )
    stages = {one: _exact_stages(task, one) for one in apart}
    rows = {stage: len(of_teeth[stage[1]]) for of_one in stages.values() for stage in of_one}
    numbers = np.concatenate([of_teeth[stage[1]] for stage in rows])
    module, torque, speed = np.repeat([stage[2:] for stage in rows], [*rows.values()], axis=0).T
    sizes, bears = forms.sized(numbers, module, torque, speed)
    options, end = {}, 0
    for stage, count in rows.items():
        of_stage = np.arange(end, end + count)
        most = task.most_distance(stage[0], drives.form.shape[1])
        some = sizes[of_stage[bears[of_stage] & (sizes.distance[of_stage] <= most)]]
        options[stage] = some[non_dominated(np.stack([some.mass, some.loss, some.diameter], 1))]
        end += count
    parts = [_combined(forms, [options[stage] for stage in of_one]) for of_one in stages.values()]
    arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return Drives(forms=forms, tried=drives.tried + len(numbers), **arrays)


Teeth = tuple[int, int, float]
"""Of pinion and wheel, and helix angle [deg]."""


def _teeth(form: Form) -> Teeth:
    pinion, wheel = form.gears["teeth"]
    return pinion, wheel, float(form.gears.get("helix_angle", "0").split()[0])


def _exact_stages(
    task: Task, pairs: Sequence[tuple[Teeth, float]]
) -> list[tuple[int, Teeth, float, float, float]]:
    """Number, teeth, module, torque at the output and speed of the input of stages, from the input."""
    ratios = [teeth[1] / teeth[0] for teeth, _ in pairs]
    return [
        (k, *pairs[k], task.torque / prod(ratios[k + 1 :]), task.speed * prod(ratios[k:]))
        for k in range(len(pairs))
    ]


def _loads(task: Task, arrangement: Arrangement) -> list[Load]:
    """What each stage bears, losses left out, as every case counts it."""
    ratios = arrangement.ratios
    return [
        (
            stage,
            round(task.torque / prod(ratios[stage + 1 :]), 9),
            round(task.speed * prod(ratios[stage:]), 9),
        )
        for stage in range(len(ratios))
    ]


def _options(
    task: Task,
    forms: Forms,
    number: dict[Form, int],
    loads: dict[Load, tuple[Form, ...]],
    stages: int,
) -> tuple[dict[Load, Sized], dict[Load, float], int]:
    """Sizes by load that no other one beats, the least centre distance that bears it; how many were rated."""
    rows = [
        (place, number[form], module, torque, speed)
        for place, ((_, torque, speed), stage) in enumerate(loads.items())
        for form in stage
        for module in SERIES
    ]
    of_load, form, module, torque, speed = (np.array(column) for column in zip(*rows, strict=True))
    sizes, bears = forms.sized(form, module, torque, speed)
    of_pairs = np.array([one.kind == "pair" for one in forms.forms])[form]
    # Gears that are far too large lose a little less than sound ones.
    sound = (
        (module == SERIES[0])
        | (sizes.flank <= LARGE * task.flank_safety)
        | (sizes.root <= LARGE * task.root_safety)
    )
    options, least = {}, {}
    for place, load in enumerate(loads):
        most = task.most_distance(load[0], stages)
        least[load] = float(sizes.distance[(of_load == place) & bears & sound].min(initial=np.inf))
        some = sizes[(of_load == place) & bears & sound & (~of_pairs | (sizes.distance <= most))]
        costs = np.stack([some.mass, some.loss, some.diameter], 1)
        front = non_dominated(costs)
        options[load] = some[front][representatives(costs[front], KEPT[stages])]
    for stage in range(stages):
        if not any(len(options[load]) for load in loads if load[0] == stage):
            of_stage = np.isin(of_load, [k for k, load in enumerate(loads) if load[0] == stage])
            raise NoDriveError(_unborne(task, sizes[of_stage], bears[of_stage], stage, stages))
    return options, least, len(rows)


def _unborne(task: Task, sizes: Sized, bears: np.ndarray, stage: int, stages: int) -> str:
    """Why no size of a stage does it."""
    where = f"stage {stage + 1}" if stages > 1 else "it"
    if len(task.centre_distances) not in (0, 1, stages):
        return (
            f"it has {stages} stages, and {len(task.centre_distances)} centre distances are given"
        )
    if not bears.any():
        part = np.fmin(sizes.flank / task.flank_safety, sizes.root / task.root_safety).max()
        return (
            f"gears of up to {1e3 * SERIES[-1]:g} mm module have {100.0 * part:.3g} % of the safeties "
            f"asked in {where}"
        )
    least, most = sizes.distance[bears].min(), task.most_distance(stage, stages)
    return (
        f"{where} needs a centre distance of {1e3 * least:.4g} mm, {1e3 * most:.4g} mm are allowed"
    )


def _apart(task: Task, least: Sequence[Sequence[float]]) -> str:
    """Why no sharing of the ratio has sizes for all its stages, though each stage has some in one of them.

    Args:
        task: what is asked.
        least: centre distances of the stages by sharing [m]; infinite where no size bears the load.
    """
    distances = np.array(least)
    most = np.array([task.most_distance(k, distances.shape[1]) for k in range(distances.shape[1])])
    over = (distances / most).max(axis=1)
    if not np.isfinite(over).any() or not np.isfinite(most).all():
        return (
            "no sharing of the ratio among its stages has gears that bear the load in all of them"
        )
    near = distances[over.argmin()]
    needed, allowed = (
        " and ".join(f"{1e3 * value:.4g}" for value in part) for part in (near, most)
    )
    return f"its stages need centre distances of {needed} mm together, {allowed} mm are allowed"


def _combined(forms: Forms, stages: Sequence[Sized]) -> dict[str, np.ndarray]:
    """Every size of a stage with every one of the others."""
    grids = np.meshgrid(*(np.arange(len(stage)) for stage in stages), indexing="ij")
    return _totals(forms, [stage[grid.ravel()] for stage, grid in zip(stages, grids, strict=True)])


def _totals(forms: Forms, each: Sequence[Sized]) -> dict[str, np.ndarray]:
    """Figures of drives from those of their stages, from the input."""
    columns = {
        name: np.stack([getattr(one, name) for one in each], axis=1)
        for name in ("form", "module", "width")
    }
    return {
        **columns,
        "ratio": np.prod([forms.ratio[one.form] for one in each], axis=0),
        "mass": np.sum([one.mass for one in each], axis=0),
        "loss": 1.0 - np.prod([1.0 - one.loss for one in each], axis=0),
        "diameter": _around(forms, each),
        "length": np.sum([one.length for one in each], axis=0),
        "flank": np.min([one.flank for one in each], axis=0),
        "root": np.min([one.root for one in each], axis=0),
    }


def _around(forms: Forms, stages: Sequence[Sized]) -> np.ndarray:
    """Diameter around all gears; lines of centres of pairs turn back at each shaft, sets share an axis."""
    if any(form.kind != "pair" for form in forms.forms):
        return np.asarray(np.max([one.diameter for one in stages], axis=0))
    tips = np.array([forms.tips(k) for k in range(len(forms.forms))])
    place, low, high = np.zeros(len(stages[0])), np.inf, -np.inf
    for number, one in enumerate(stages):
        after = place + (1.0 if number % 2 == 0 else -1.0) * one.distance
        for shaft, gear in ((place, 0), (after, 1)):
            radius = tips[one.form, gear] * one.module
            low, high = np.minimum(low, shaft - radius), np.maximum(high, shaft + radius)
        place = after
    return np.asarray(high - low)
