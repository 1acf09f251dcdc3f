"""How large a change of a gears table is that has its gears run: found by trying, so that it does."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from math import ceil, nan, pi
from typing import Any

from pitchpoint.errors import RUNS_WITH, Cure, InputError
from pitchpoint.gears.cylindrical.checks import Remedy
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE, LEAST_TIP, CylindricalGears
from pitchpoint.gears.gears_table import ANGLE, DISTANCE, FILLET, RACK, SHIFT
from pitchpoint.input.quantities import Quantity

__all__ = ["change_words", "cures", "error_with_cures"]

MOST_CURES = 2

Attempt = Callable[[CylindricalGears], CylindricalPair | None]


@dataclass(frozen=True)
class _Steps:
    """How values of a key are tried.

    Attributes:
        quantity: whose range they keep to.
        fine: step of what is proposed, in the unit in which it is written.
        coarse: fine steps between the first tries.
        most: coarse steps at most.
        unit: value of that unit in SI.
        name: of that unit; numbers without one have none.
    """

    quantity: Quantity
    fine: float
    coarse: int
    most: int
    unit: float = 1.0
    name: str = ""

    def written(self, value: Any) -> Any:
        """A value or one for each gear, as a case file has it."""
        if isinstance(value, tuple):
            return [self.written(number) for number in value]
        number = round(value / self.unit, 9)
        return f"{number:.10g} {self.name}" if self.name else number


_STEPS = {
    "addendum": _Steps(RACK, 0.001, 50, 20),
    "dedendum": _Steps(RACK, 0.01, 5, 20),
    "fillet_radius": _Steps(FILLET, 0.01, 5, 8),
    "profile_shift": _Steps(SHIFT, 0.01, 5, 30),
    "pressure_angle": _Steps(ANGLE, 0.5, 2, 15, pi / 180.0, "deg"),
    "least_tip_thickness": _Steps(LEAST_TIP, 0.05, 2, 6),
    "centre_distance": _Steps(DISTANCE, 0.01, 10, 40, 1e-3, "mm"),
}

_ADDENDA, _RING_ADDENDA = ((1.0, 1.0), (1.0, 0.8), (0.8, 0.8)), ((1.0, 0.8), (0.8, 0.6))
_SHIFTS = ((0.0, 0.0), (0.3, 0.3), (0.5, 0.5), (0.4, -0.4))
_RING_SHIFTS = ((0.0, 0.0), (0.3, -0.3), (0.4, -0.4), (0.0, -0.5), (0.0, -1.0))
"""Usual values of two external gears and of a ring, which are tried together."""


def cures(
    gears: CylindricalGears, remedies: Sequence[Remedy], open_values: Cure, attempt: Attempt
) -> tuple[Cure, ...]:
    """Changes of different keys after which gears run, each the least of its kind; two at most.

    Where a change of one gear is not enough the same of both is tried, and where no key alone is
    enough, usual values of several.

    Args:
        gears: that cannot run.
        remedies: kinds of changes, the better one first.
        open_values: SI values of keys that the table leaves open.
        attempt: the pair of a table; None where it does not run well.
    """

    def cure(remedy: Remedy) -> Cure | None:
        if not remedy.sense:
            return _following(gears, remedy.key, attempt)

        def changed(count: int) -> Cure | None:
            return _changed(gears, remedy, open_values, count, attempt)

        steps = _STEPS[remedy.key]
        coarse = range(steps.coarse, steps.coarse * steps.most + 1, steps.coarse)
        high = next((count for count in coarse if changed(count) is not None), None)
        return None if high is None else changed(_least(changed, high - steps.coarse, high))

    change_by_key: dict[str, Cure] = {}
    of_both = (remedy._replace(members=(0, 1)) for remedy in remedies if len(remedy.members) == 1)
    for remedy in dict.fromkeys((*remedies, *of_both)):
        if len(change_by_key) < MOST_CURES and remedy.key not in change_by_key:
            change = cure(remedy)
            change_by_key |= {} if change is None else {remedy.key: change}
    if not change_by_key and (several := _of_several_keys(gears, attempt)):
        return (several,)
    return tuple(change_by_key.values())


def _of_several_keys(gears: CylindricalGears, attempt: Attempt) -> Cure | None:
    """Usual values of as few keys as it takes, with the centre distance that follows where there was one."""
    ring = gears.teeth[1] < 0
    depths: list[Cure] = [{}]
    for pinion_addendum, wheel_addendum in _RING_ADDENDA if ring else _ADDENDA:
        usual = {
            "dedendum": (wheel_addendum + 0.25, pinion_addendum + 0.25),
            "fillet_radius": (0.2, 0.1 if ring else 0.2),
        }
        depths_to_change = {key: usual[key] for key in usual if getattr(gears, key) is not None}
        depths.append({"addendum": (pinion_addendum, wheel_addendum), **depths_to_change})
    shifts = [{}, *({"profile_shift": both} for both in (_RING_SHIFTS if ring else _SHIFTS))]
    angles = [{}, {"pressure_angle": 25.0 * pi / 180.0}]
    tips = [{}, {"least_tip_thickness": 0.1}]
    every = ({**a, **b, **c, **d} for a, b, c, d in product(depths, shifts, angles, tips))
    for changes in sorted(every, key=len):
        changed = gears.model_copy(update=changes)
        written = {key: _STEPS[key].written(changes[key]) for key in changes}
        if gears.centre_distance is None:
            if attempt(changed) is not None:
                return written
        elif both := _at_its_distance(changed, changed.profile_shift, attempt):
            return {**written, "centre_distance": both["centre_distance"]}
    return None


def _least(changed: Callable[[int], Cure | None], low: int, high: int) -> int:
    """Fewest steps between those that are too few and those that are enough."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if changed(middle) is not None else (middle, high)
    return high


def _changed(
    gears: CylindricalGears, remedy: Remedy, open_values: Cure, count: int, attempt: Attempt
) -> Cure | None:
    """The change by some fine steps; None where the gears do not run with it."""
    key, steps = remedy.key, _STEPS[remedy.key]
    start = getattr(gears, key)
    start = open_values.get(key) if start is None else start
    if start is None:
        return None
    step = remedy.sense * steps.fine * steps.unit

    def moved(value: float) -> float:
        """From the next round value on."""
        return (ceil(value / step - 1e-9) + count) * step

    if remedy.members:
        value: Any = tuple(
            moved(number) if member in remedy.members else number
            for member, number in enumerate(start)
        )
    else:
        value = moved(start)
    if not all(steps.quantity.low <= number <= steps.quantity.high for number in _numbers(value)):
        return None
    if key == "profile_shift" and gears.centre_distance is not None:
        return _at_its_distance(gears, value, attempt)
    runs = attempt(gears.model_copy(update={key: value})) is not None
    return {key: steps.written(value)} if runs else None


def _following(gears: CylindricalGears, key: str, attempt: Attempt) -> Cure | None:
    """Profile shifts or centre distance as they follow from each other."""
    if gears.centre_distance is None:
        return None
    if key == "centre_distance":
        both = _at_its_distance(gears, gears.profile_shift, attempt)
        return None if both is None else {key: both[key]}
    try:
        shifts = gears.shifts_from_distance((nan, nan))
    except InputError:
        return None
    runs = attempt(gears.model_copy(update={key: shifts})) is not None
    return {key: FROM_CENTRE_DISTANCE} if runs else None


def _numbers(value: Any) -> tuple[float, ...]:
    return value if isinstance(value, tuple) else (value,)


def _at_its_distance(
    gears: CylindricalGears, shifts: tuple[float, float], attempt: Attempt
) -> Cure | None:
    """Profile shifts with the centre distance that they ask for, a little backlash at most."""
    pair = attempt(gears.model_copy(update={"profile_shift": shifts, "centre_distance": None}))
    if pair is None:
        return None
    side = -1.0 if pair.internal else 1.0
    distance = 1e-5 * side * ceil(side * float(pair.centre_distance) * 1e5 - 1e-6)
    both = {"profile_shift": shifts, "centre_distance": distance}
    if attempt(gears.model_copy(update=both)) is None:
        return None
    return {key: _STEPS[key].written(value) for key, value in both.items()}


def error_with_cures(message: str, changes: Sequence[Cure]) -> str:
    """A refusal with the changes that mend it.

    Example:
        >>> error_with_cures("too short", [{"addendum": [1.0, 0.872]}, {"pressure_angle": "25 deg"}])
        'too short; it runs with addendum = [1, 0.872], or with pressure_angle = "25 deg"'
    """
    return RUNS_WITH.join(filter(None, (message, ", or with ".join(map(change_words, changes)))))


def change_words(change: Cure) -> str:
    """A change as lines of a case file have it.

    Example:
        >>> change_words({"teeth": [24, 30], "planet_angles": ["0 deg", "120 deg"]})
        'teeth = [24, 30] and planet_angles = ["0 deg", "120 deg"]'
    """
    return " and ".join(f"{key} = {_shown(value)}" for key, value in change.items())


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_shown, value))}]"
    return f'"{value}"' if isinstance(value, str) else f"{value:.6g}"
