"""Lives that a result has at its operating point, as those of parts whose load goes with the output's."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from pitchpoint.duty_cycle.history import LoadHistory
from pitchpoint.duty_cycle.life import BALL, RatedLife
from pitchpoint.results.by_stage import of_stage, stages_of
from pitchpoint.wear.wear_registry import WEAR_LAWS

__all__ = ["READ", "RecordedLives", "WornFlanks", "recorded_lives"]

BEARING_LIFE, MARCHED = "bearing_life", "life_hours"

READ = (BEARING_LIFE, MARCHED)
"""Variables by which parts of a result with lives are known."""

_AT_A_LIMIT = frozenset({"depth", "module", "tip land", "backlash"})
"""Ends of a march of wear at which the flanks have had their life: those that go with the depth."""

_WITHOUT_LIFE = {
    "pressure": "wear to a pressure",
    "hardness": "wear to a pressure",
    "lost": "wear that is not solved",
    "outgrown": "wear that is not solved",
}
"""Keys of `WITHOUT_LIFE` by other ends; those that are not here come before a limit."""

_PROPORTIONAL = 1.0
"""Exponent of the life of flanks over their load where the specific rate is the same at any load."""


class WornFlanks(NamedTuple):
    """Flanks that wear at one specific rate: as deep as the load times the way.

    Attributes:
        march: turns of the output, at the load of the march, until it ended; None at a limit from the start.
        depth: largest one there [m].
        limited: True where it ended at a limit, so that its end is that of the life.

    Source: Archard (1953): depth is in proportion to load and way.
    """

    march: RatedLife | None
    depth: float
    limited: bool

    def until_as_deep(self, history: LoadHistory) -> float:
        """Time until a load history, over and over, has worn one of both sides of the teeth as deep [s].

        Args:
            history: of the output, whose sign says which side bears.
        """
        march = self.march
        if march is None:
            return 0.0
        sides = (np.maximum(sign * history.torque, 0.0) for sign in (1.0, -1.0))
        return min(march.life(history._replace(torque=side)) for side in sides)


class RecordedLives(NamedTuple):
    """What the parts of a result say of lives.

    Attributes:
        bearings: with their rated lives, by name.
        worn: flanks by name.
        left_out: keys of `WITHOUT_LIFE` on wear that has no life.
    """

    bearings: dict[str, RatedLife]
    worn: dict[str, WornFlanks]
    left_out: tuple[str, ...]


def recorded_lives(parts: Iterable[xr.Dataset], torque: float, speed: float) -> RecordedLives:
    """Lives of bearings, of wave generators and of worn flanks in the parts of a result.

    Args:
        parts: any; those without `bearing_life` or a march of wear say nothing, and neither does the duty
            cycle of the result itself, whose lives are those over its own loads.
        torque: of the output at the operating point [N m or N].
        speed: of the output there [rad/s or m/s].

    Loads of all parts are taken to grow with that of the output, their speeds with its speed.
    """
    bearings: dict[str, RatedLife] = {}
    worn: dict[str, WornFlanks] = {}
    left_out: dict[str, None] = {}
    for stage, data in _of_stages(parts) if torque > 0.0 and speed > 0.0 else ():
        for name, life, exponent in _bearings(data):
            bearings[name + stage] = RatedLife(torque, _turns(life, speed), exponent)
        if MARCHED in data:
            why = _without_life(data)
            ended = np.inf if data.attrs["end"] == "no wear" else float(data[MARCHED])
            march = RatedLife(torque, _turns(ended, speed), _PROPORTIONAL) if ended > 0.0 else None
            if why != "wear at other loads" and (march or not why):
                depth = float(data["final_depth"])
                worn[f"wear of flanks{stage}"] = WornFlanks(march, depth, not why)
            left_out |= {why: None} if why else {}
    return RecordedLives(bearings, worn, tuple(left_out) if left_out or worn else ("wear",))


def _turns(seconds: float, speed: float) -> float:
    """Turns of the output in a time."""
    return seconds * speed / (2.0 * np.pi)


def _of_stages(parts: Iterable[xr.Dataset]) -> Iterator[tuple[str, xr.Dataset]]:
    """Parts with lives, those of drives stage by stage, with the stage in words."""
    for data in parts:
        if "shortest_life" in data:  # a duty cycle
            continue
        labels = stages_of(data) if any(name in data for name in READ) else ()
        yield from ((f", stage {label}", of_stage(data, label)) for label in labels)
        if not labels:
            yield "", data


def _bearings(data: xr.Dataset) -> Iterator[tuple[str, float, float]]:
    """Name, life at the operating point [s] and exponent of each bearing but those with a rated load.

    These, over `place`, are rated under each load for itself, see `RatedBearing`.
    """
    if BEARING_LIFE not in data or "place" in data[BEARING_LIFE].dims:
        return
    lives = data.get("operating_bearing_life", data[BEARING_LIFE])
    noun, exponent = data.attrs.get("bearing", "bearing"), float(data.attrs.get("exponent", BALL))
    for place in np.ndindex(lives.shape):
        labels = [str(lives[dim].values[at]) for dim, at in zip(lives.dims, place, strict=True)]
        life = float(lives.values[place])
        if life > 0.0:
            yield " ".join([str(noun), *labels]), life, exponent


def _without_life(data: xr.Dataset) -> str:
    """Why a march of wear gives no life under other loads, a key of `WITHOUT_LIFE`; empty where it does."""
    law = WEAR_LAWS.get(str(data.attrs["law"]))
    if law is None or not law.proportional:
        return "wear at other loads"
    end = str(data.attrs["end"])
    return "" if end in {*_AT_A_LIMIT, "no wear"} else _WITHOUT_LIFE.get(end, "wear to a limit")
