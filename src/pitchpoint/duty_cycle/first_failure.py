"""Which part of a drive fails first over a duty cycle."""

import json
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

__all__ = ["WITHOUT_LIFE", "FirstFailure", "first_failure", "part_lives"]

_TEETH = {"flank": "flank_life", "back flank": "back_flank_life", "root": "root_life"}
"""Parts of a tooth with the variable of their life."""


WITHOUT_LIFE = {
    "teeth": "No life of teeth: not asked for, not rated by ISO 6336, or none moves under load.",
    "other teeth": "Some teeth have no life here: ISO 6336 rates cylindrical gears of steel, VDI 2736 the "
    "roots of plastics whose strength over cycles is known, and some materials have no strength.",
    "bearings": "No bearing or wave generator has a rated life: none was given, and no part of the result "
    "has it.",
    "heat": "No body was given with a largest temperature, so that none gets too hot.",
    "wear": "Wear has no life here: the result has no march of wear, for which [wear] asks.",
    "wear at other loads": "Wear has no life here: the rate of its law hangs on film or pressure, so that at "
    "other loads flanks wear otherwise than in proportion.",
    "wear to a limit": "Wear has no life here: its march ended before a limit of depth, tip land or "
    "backlash; more wear.cycles reach it.",
    "wear to a pressure": "Wear has no life here: its march ended at a limit of pressure, which at other "
    "loads is reached at another depth.",
    "wear that is not solved": "Wear has no life here: its march ended where loads of the worn flanks were "
    "not found, or their contacts outgrew Hertz's theory.",
}
"""Why parts have no life, by what they are."""


class FirstFailure(NamedTuple):
    """The part with the shortest life.

    Attributes:
        part: its name; empty where all endure, and where no life is known.
        life: of it; 0 where a body is too hot, infinite where all endure, NaN where none is known [s].
        compared: number of parts whose lives are known.
        left_out: keys of `WITHOUT_LIFE`, of what has no life here.
    """

    part: str
    life: float
    compared: int
    left_out: tuple[str, ...]


def first_failure(data: xr.Dataset, limits: Mapping[str, float] | None = None) -> FirstFailure:
    """The part with the shortest life among bodies too hot, bearings, and flanks and roots of the teeth.

    Args:
        data: with `bearing_life` over `bearing`, `wear_life` over `worn`, lives of teeth over `mesh` and
            `gear` with their names as attribute `members`, `body_temperature` over `time` and `body`; any of
            them may be missing. An attribute `unrated` above 0 tells that teeth of other meshes have no life,
            `unworn` why wear has none, `runaway` a body that gets ever hotter.
        limits: largest temperatures of bodies by name [K]; one that gets hotter fails at once.

    Example:
        >>> import xarray as xr
        >>> lives = {"bearing_life": ("bearing", [2e7, 1e7])}
        >>> first_failure(xr.Dataset(lives, {"bearing": ["input", "output"]}))[:3]
        ('bearing output', 10000000.0, 2)
    """
    lives = [*_of_bodies(data, limits or {}), *part_lives(data)]
    rated = [(name, life) for name, life in lives if not np.isnan(life)]
    unknown = len(rated) < len(lives) or bool(data.attrs.get("unrated"))
    left_out = tuple(_left_out(data, limits or {}, unknown))
    if not rated:
        return FirstFailure("", float("nan"), 0, left_out)
    part, life = min(rated, key=lambda item: item[1])
    return FirstFailure("" if np.isinf(life) else part, life, len(rated), left_out)


def part_lives(data: xr.Dataset) -> list[tuple[str, float]]:
    """Names of bearings, teeth and worn flanks with their lives [s], NaN where one is not known.

    Args:
        data: as `first_failure` has it.
    """
    return [*_of_bearings(data), *_of_teeth(data), *_of_wear(data)]


def _of_bodies(data: xr.Dataset, limits: Mapping[str, float]) -> Iterator[tuple[str, float]]:
    if runaway := str(data.attrs.get("runaway", "")):
        yield f"heat of {runaway}", 0.0
    for body, limit in limits.items() if "body_temperature" in data else ():
        hottest = float(data["body_temperature"].sel(body=body).max())
        yield f"heat of {body}", 0.0 if hottest > limit else float("inf")


def _of_bearings(data: xr.Dataset) -> Iterator[tuple[str, float]]:
    if "bearing_life" in data:
        for name, life in zip(
            data["bearing"].values.tolist(), data["bearing_life"].values.tolist(), strict=True
        ):
            bare = "bearing" in name or "generator" in name
            yield (name if bare else f"bearing {name}"), life


def _of_wear(data: xr.Dataset) -> Iterator[tuple[str, float]]:
    if "wear_life" in data:
        yield from zip(data["worn"].values.tolist(), data["wear_life"].values.tolist(), strict=True)


def _of_teeth(data: xr.Dataset) -> Iterator[tuple[str, float]]:
    there = {part: variable for part, variable in _TEETH.items() if variable in data}
    for at, place in _places(data) if there else ():
        lives = {part: float(data[variable].values[at]) for part, variable in there.items()}
        flanks = {part for part in lives if part.endswith("flank")}
        # The flank without load would endure for ever.
        if any(np.isnan(lives[part]) for part in flanks):
            lives |= dict.fromkeys(flanks, np.nan)
        yield from ((f"{part} of {place}", life) for part, life in lives.items())


def _places(data: xr.Dataset) -> Iterator[tuple[tuple[int, int], str]]:
    """Indices of meshes and gears with their names."""
    every = [
        (row, column) for row in range(data.sizes["mesh"]) for column in range(data.sizes["gear"])
    ]
    yield from zip(every, json.loads(data.attrs["members"]), strict=True)


def _left_out(data: xr.Dataset, limits: Mapping[str, float], unknown: bool) -> Iterator[str]:
    """What is not among the lives."""
    if not any(name in data for name in _TEETH.values()):
        yield "teeth"
    elif unknown:
        yield "other teeth"
    if "bearing_life" not in data:
        yield "bearings"
    if ("body_temperature" not in data or not limits) and not data.attrs.get("runaway"):
        yield "heat"
    yield from json.loads(data.attrs.get("unworn", '["wear"]'))
