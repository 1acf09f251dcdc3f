"""Arrangements that reach a ratio: how it is shared among stages, and which gears each of them may have."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from math import cos, radians
from typing import Any

import numpy as np

from pitchpoint.errors import InputError
from pitchpoint.gears.planetary import PLANETARY
from pitchpoint.sizing.for_ratio import (
    in_planet_ring,
    planetary_teeth,
    stepped_gears,
    without_undercut,
)
from pitchpoint.sizing.stage_forms import CENTRE_FIELD, FIELD, Form, formed
from pitchpoint.sizing.task_table import Task
from pitchpoint.sizing.three_k import three_k_sets, three_k_tables

__all__ = ["SET_RATIOS", "Arrangement", "arrangements", "reach_words", "shifted_pairs"]

Tree = dict[str, Any]

PINIONS = (13, 16, 20, 25, 31)
HELICES = (0.0, 15.0, 30.0)
SHIFT_SUMS = (0.0, 0.6)
PINION_SHIFT = 0.5
"""Profile shift of pinions at large ratios; (1 - 1/u) of it at a ratio u, more where undercut asks for it."""

TRIED_SHIFTS, TRIED_SUMS = (0.0, 0.15, 0.3, 0.45), (0.0, 0.4, 0.8, 1.2)
"""Profile shifts of pinions, and sums of both shifts, that are tried on pairs of the best designs."""

LEAST_TIP, LEAST_CONTACT_RATIO, MOST_SLIDING = 0.2, 1.2, 3.0
"""Limits of tips [modules], transverse contact ratio and specific sliding that these shifts keep."""

PAIR_RATIOS = 1.25, 8.0
SET_RATIOS = 2.8, 11.0
"""Ratios of a stage between which it is looked for: of pairs, and of planetary sets."""

STEP, STEPS = 1.22, range(-3, 4)
"""Factor between ratios of a stage that are tried, and how many on either side of equal ones."""

SUNS = (12, 15, 18, 22, 27, 34)
PLANETS = (3, 4, 5)
STEPPED, THREE_K = 6, 4
"""Sets of stepped planets, and 3K sets, that are tried for each number of planets."""

LEAST_THREE_K = 20.0

INSPECTION = {"inspection": {"thickness_field": FIELD, "centre_distance_field": CENTRE_FIELD}}


@dataclass(frozen=True)
class Arrangement:
    """A family, ratios of its stages from the input, and the gears that each of them may have.

    Attributes:
        family: its name.
        ratios: nominal ones.
        stages: for each stage, names of forms that it may have.
    """

    family: str
    ratios: tuple[float, ...]
    stages: tuple[tuple[Form, ...], ...]


def arrangements(task: Task, family: str) -> Iterator[Arrangement]:
    """Arrangements of a family that reach the ratio, with forms that can be made.

    Args:
        task: what is asked.
        family: of `SIZED_FAMILIES`, but those with strain wave gears.
    """
    many = {"one stage": 1, "two stages": 2, "three stages": 3}
    if family in many:
        for ratios in _shared(task.ratio, many[family], PAIR_RATIOS):
            pairs = tuple(_pairs(task, ratio) for ratio in ratios)
            yield Arrangement(family, ratios, pairs)
    elif family in ("planetary", "two planetary sets"):
        count = 1 if family == "planetary" else 2
        for ratios in _shared(task.ratio, count, SET_RATIOS):
            yield Arrangement(family, ratios, tuple(_sets(task, ratio) for ratio in ratios))
    else:
        forms = _stepped(task) if family == "stepped planets" else _three_k(task)
        yield Arrangement(family, (task.ratio,), (forms,))


def reach_words(task: Task, family: str) -> str:
    """Why a family has no arrangement of the ratio that is asked, without its stop."""
    of_pairs = {"one stage": 1, "two stages": 2, "three stages": 3}
    stages = of_pairs.get(family) or {"planetary": 1, "two planetary sets": 2}.get(family)
    low, high = PAIR_RATIOS if family in of_pairs else SET_RATIOS
    if stages and not low**stages <= task.ratio <= high**stages:
        return (
            f"reaches ratios of {low**stages:.3g} to {high**stages:.4g}, {task.ratio:.6g} is asked"
        )
    if family == "3K" and task.ratio < LEAST_THREE_K:
        return f"reaches ratios from {LEAST_THREE_K:g} on, {task.ratio:.6g} is asked"
    counted = "" if family in of_pairs or not task.planets else f" with {_listed(task)} planets"
    return (
        f"no teeth that can be made come within {100.0 * task.ratio_tolerance:.3g} % of that ratio"
        f"{counted}"
    )


def _shared(ratio: float, count: int, limits: tuple[float, float]) -> Iterator[tuple[float, ...]]:
    """Ratios of stages whose product is the whole, in equal steps around equal ones."""
    equal = ratio ** (1.0 / count)
    for powers in product(STEPS, repeat=count):
        ratios = tuple(equal * STEP**power for power in powers)
        if sum(powers) == 0 and all(limits[0] <= each <= limits[1] for each in ratios):
            yield ratios


@lru_cache(maxsize=256)
def _pairs(task: Task, ratio: float) -> tuple[Form, ...]:
    """Pairs near a ratio."""
    tables = []
    for pinion, helix, shifts in product(PINIONS, HELICES, SHIFT_SUMS):
        wheel = round(ratio * pinion)
        if abs(wheel / pinion / ratio - 1.0) <= task.ratio_tolerance:
            tables.append(_pair(pinion, wheel, helix, shifts))
    return _runnable(task, "pair", tables)


def _runnable(task: Task, kind: str, tables: Iterable[Tree]) -> tuple[Form, ...]:
    """Forms of tables of gears, as far as they can run."""
    forms = (formed(task, kind, table) for table in tables)
    return tuple(form for form in forms if form is not None)


def _pair(pinion: int, wheel: int, helix: float, shifts: float) -> Tree:
    """Table of a pair: shifts that leave no undercut, more on the pinion at large ratios."""
    skew = {"helix_angle": f"{helix:g} deg"} if helix else {}
    gears = {"teeth": [pinion, wheel], **skew, **INSPECTION}
    return _shifted(gears, helix, round(PINION_SHIFT * (1.0 - pinion / wheel), 2), shifts)


def _shifted(gears: Tree, helix: float, first: float, shifts: float) -> Tree:
    """Table of a pair with a shift of the pinion and a sum of both, or more where there would be undercut."""
    virtual = cos(radians(helix)) ** 3
    least = [without_undercut(teeth / virtual) for teeth in gears["teeth"]]
    first = max(least[0], first)
    second = max(least[1] if gears["teeth"][1] < LEAST_WHEEL else -1.0, round(shifts - first, 2))
    return gears | {"profile_shift": [first, second]}


@lru_cache(maxsize=1024)
def shifted_pairs(task: Task, pinion: int, wheel: int, helix: float) -> tuple[Form, ...]:
    """Pairs of the same teeth with other profile shifts, as far as tips and contact ratio allow them.

    Args:
        task: what is asked.
        pinion, wheel: numbers of teeth.
        helix: angle [deg].
    """
    gears = _pair(pinion, wheel, helix, 0.0)
    tables = [_shifted(gears, helix, *shifts) for shifts in product(TRIED_SHIFTS, TRIED_SUMS)]
    apart = {tuple(table["profile_shift"]): table for table in tables}
    return tuple(form for form in _runnable(task, "pair", apart.values()) if _is_sound(form))


def _is_sound(form: Form) -> bool:
    """True for a pair with thick tips, none of them shortened, a long path of contact and little sliding."""
    pair: Any = form.built.meshes[0].design.mesh  # a pair of cylindrical gears
    tips = min(float(gear.tip_thickness / pair.module) for gear in pair.gears)
    thick = tips >= LEAST_TIP and not any(pair.shortened)
    sliding = float(np.abs(np.diagonal(pair.specific_sliding(pair.limits))).max())
    long = float(pair.transverse_contact_ratio) >= LEAST_CONTACT_RATIO
    return thick and long and sliding <= MOST_SLIDING


LEAST_WHEEL = 30
"""Teeth from which a shift below zero leaves no undercut that counts."""


def _planets(task: Task, usual: Sequence[int]) -> list[int]:
    """Numbers of planets that are tried."""
    return [int(number) for number in task.planets or usual]


def _listed(task: Task) -> str:
    """Numbers of planets that are asked for, in words."""
    return " or ".join(f"{number:g}" for number in task.planets)


@lru_cache(maxsize=256)
def _sets(task: Task, ratio: float) -> tuple[Form, ...]:
    """Planetary sets near a ratio from sun to carrier, of a few suns for each number of planets."""
    tables = []
    for planets in _planets(task, PLANETS):
        near = [
            teeth
            for teeth in planetary_teeth(ratio - 1.0, planets)
            if abs((1.0 + teeth[2] / teeth[0]) / ratio - 1.0) <= task.ratio_tolerance
        ]
        for sun in SUNS:
            close = min(near, key=lambda teeth: abs(teeth[0] - sun), default=None)
            if close is None:
                continue
            near = [teeth for teeth in near if teeth[0] != close[0]]
            gears = {
                "family": PLANETARY,
                "teeth": [*close],
                "planets": planets,
                "profile_shift": [without_undercut(close[0]), in_planet_ring(close[1])],
                **INSPECTION,
            }
            tables.append(gears)
    return _runnable(task, "planetary", tables)


def _stepped(task: Task) -> tuple[Form, ...]:
    """Sets of stepped planets of the ratio."""
    tables = []
    for planets in _planets(task, PLANETS[:2]):
        near, suns = [], set()
        for gears, met in stepped_gears(task.ratio, planets):
            if abs(met / task.ratio - 1.0) > task.ratio_tolerance:
                continue
            if gears["teeth"][0] not in suns:
                suns.add(gears["teeth"][0])
                near.append(gears)
            if len(near) == STEPPED:
                break
        for gears in near:
            second = gears["second"] | INSPECTION
            tables.append(gears | {"family": PLANETARY, "second": second, **INSPECTION})
    return _runnable(task, "stepped", tables)


def _three_k(task: Task) -> tuple[Form, ...]:
    """3K sets of the ratio that lose least."""
    tables = []
    for planets in _planets(task, PLANETS[:2]) if task.ratio >= LEAST_THREE_K else ():
        try:
            sets = three_k_sets(task.reaches, planets=planets, count=THREE_K)
        except InputError:
            continue
        for number in range(sets.sizes["set"]):
            gears = three_k_tables(sets.isel(set=number), "1 mm", "1 mm")["gears"]
            del gears["module"], gears["face_width"]
            second = {key: value for key, value in gears["second"].items() if key != "face_width"}
            tables.append(gears | {"second": second | INSPECTION, **INSPECTION})
    return _runnable(task, "3K", tables)
