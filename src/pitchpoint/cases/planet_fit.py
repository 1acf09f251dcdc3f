"""What to change of planets that do not fit in: the nearest numbers of teeth that do, or their angles."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Int

from pitchpoint.cases.drive_schema import DriveCase, TrainTable
from pitchpoint.drive.assembly import (
    clear_neighbours,
    equal_angles,
    fit_at_equal_angles,
    nearest_places,
    places_around,
)
from pitchpoint.errors import Cure, InputError
from pitchpoint.gears.cylindrical.cures import change_words

__all__ = ["with_fitting"]

Attempt = Callable[[Cure], float]
"""Ratio of the train after a change; InputError where it cannot run."""

MOST_OFF = {3: 5, 4: 4, 5: 3}
"""Teeth by which numbers may differ from those of the case, by how many there are."""

MOST_TRIED = 8

OF_TOOTH, OF_DISTANCE = 0.003, 0.05
"""What a tooth more, and a module more of distance between two meshes of a planet, count beside the ratio."""


def with_fitting(error: InputError, case: DriveCase, ratio: float, attempt: Attempt) -> InputError:
    """An error of planets that do not fit in, with what does, which was tried.

    Args:
        error: of the numbers of teeth, or of given angles.
        case: of the train.
        ratio: of the train.
        attempt: what a change makes of the case.
    """
    assert case.train is not None
    changes, cures = [], []
    angled = bool(case.train.planet_angles)
    fitting = None if angled else _first(_nearest_teeth(case, ratio), attempt)
    if fitting is not None:
        teeth, reached = fitting
        cures.append(teeth)
        changes.append(f"{change_words(teeth)} (ratio {reached:.6g}, here {ratio:.6g})")
    if angles := _nearest_angles(case, attempt):
        cures.append(angles)
        changes.append(change_words(angles))
    longer = error.followed_by(f"it runs with {', or with '.join(changes)}" if changes else "")
    longer.cures = tuple(cures)
    return longer


def _first(changes: Iterator[Cure], attempt: Attempt) -> tuple[Cure, float] | None:
    """The first change after which the case runs, and the ratio that it then has."""
    for _, change in zip(range(MOST_TRIED), changes, strict=False):
        try:
            return change, attempt(change)
        except InputError:
            continue
    return None


def _nearest_angles(case: DriveCase, attempt: Attempt) -> Cure | None:
    """Angles at which the planets fit in, nearest to those of the case."""
    train = case.train
    assert train is not None
    planet_gears = _PlanetGears.of(case)
    places = places_around([*planet_gears.meshes(planet_gears.teeth.tolist())])
    stated = (
        np.array(train.planet_angles) if train.planet_angles else equal_angles(round(train.planets))
    )
    if places < stated.size:
        return None
    degrees = np.degrees(nearest_places(stated, places))
    table = "train" if case.gears is None else "gears"
    angles = {
        f"{table}.planet_angles": [f"{round(angle, 6):.9g} deg" for angle in degrees.tolist()]
    }
    return angles if _first(iter([angles]), attempt) else None


@dataclass(frozen=True)
class _PlanetGears:
    """Gears of planets and their mates, each once.

    Attributes:
        bodies: of which each gear is.
        teeth: of each gear, negative for rings.
        modules: of each mesh [m].
        pairs: planet's gear and mate in each mesh, as numbers of gears.
        keys: where the file has the teeth of each gear: dotted key and place in the list.
    """

    bodies: tuple[str, ...]
    teeth: Int[np.ndarray, " gear"]
    modules: tuple[float, ...]
    pairs: tuple[tuple[int, int], ...]
    keys: tuple[tuple[tuple[str, int], ...], ...]

    @classmethod
    def of(cls, case: DriveCase) -> "_PlanetGears":
        """Of a case with a train."""
        train = case.train
        assert train is not None
        places: dict[tuple[str, float, int], list[tuple[str, int]]] = {}
        teeth: dict[tuple[str, float, int], int] = {}
        pairs, modules = [], []
        for number, stage in case.stages.items():
            if train.planet not in stage.bodies:
                continue
            table: Any = stage.gears
            gear = round(stage.planet_gear)
            both = [(body, abs(z), gear) for body, z in zip(stage.bodies, table.teeth, strict=True)]
            for place, (key, z) in enumerate(zip(both, table.teeth, strict=True)):
                teeth[key] = round(z)
                places.setdefault(key, []).append((f"stages.{number}.gears.teeth", place))
            if stage.bodies[0] != train.planet:
                both.reverse()
            pairs.append((both[0], both[1]))
            modules.append(float(table.module))
        order = [*teeth]
        return cls(
            tuple(key[0] for key in order),
            np.array([*teeth.values()]),
            tuple(modules),
            tuple((order.index(planet), order.index(mate)) for planet, mate in pairs),
            tuple(tuple(places[key]) for key in order),
        )

    def meshes(self, teeth: Any) -> Iterator[tuple[Any, Any]]:
        """Teeth of planet and mate in each mesh, of a list or of arrays for each gear."""
        return ((teeth[planet], teeth[mate]) for planet, mate in self.pairs)

    def ratios(self, teeth: Int[np.ndarray, "gear case"], train: TrainTable) -> np.ndarray | None:
        """Ratios of input to output, by Willis; None where these are not about the planets."""
        against = {
            train.carrier: np.zeros(teeth.shape[1])
        }  # rates for one of the planet, against it
        for (_, mate), (planet, central) in zip(self.pairs, self.meshes(teeth), strict=True):
            against[self.bodies[mate]] = -planet / central
        ends = [train.input, train.output, *train.held]
        if len(ends) != 3 or not against.keys() >= {*ends}:
            return None
        turned, loaded, held = (against[body] for body in ends)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray((turned - held) / (loaded - held))


def _nearest_teeth(case: DriveCase, ratio: float) -> Iterator[Cure]:
    """Numbers of teeth with which equal angles go, those first that are nearest in ratio and size."""
    train = case.train
    assert train is not None
    gears = _PlanetGears.of(case)
    count = gears.teeth.size
    most = MOST_OFF.get(count, 0)
    off = np.indices((2 * most + 1,) * count).reshape(count, -1) - most
    teeth = gears.teeth[:, None] + off
    meshes = [*gears.meshes(teeth)]
    distances = np.array(
        [np.abs(p + m) * module for (p, m), module in zip(meshes, gears.modules, strict=True)]
    )
    apart = (distances - distances[0]) / gears.modules[0] / 2.0
    now = apart[:, np.flatnonzero((off == 0).all(axis=0))]
    farther = np.maximum(np.abs(apart) - np.abs(now), 0.0)
    cost = OF_TOOTH * np.abs(off).sum(axis=0) + OF_DISTANCE * farther.sum(axis=0)
    if (ratios := gears.ratios(teeth, train)) is not None:
        with np.errstate(divide="ignore", invalid="ignore"):
            cost = cost + np.abs(np.log(ratios / ratio))
    fine = _fits(meshes, round(train.planets)) & np.isfinite(cost)
    for number in np.flatnonzero(fine)[np.argsort(cost[fine], kind="stable")]:
        yield _written(case, gears, teeth[:, number])


def _fits(meshes: Sequence[tuple[np.ndarray, np.ndarray]], planets: int) -> np.ndarray:
    """True where planets fit in at equal angles, and beside each other, with rings around them."""
    fits: np.ndarray = fit_at_equal_angles(meshes, planets) & clear_neighbours(meshes, planets)
    for planet, mate in meshes:
        fits &= (planet >= 5) & (np.where(mate < 0, -mate - planet, mate) >= 5)
    return fits


def _written(case: DriveCase, gears: _PlanetGears, teeth: Int[np.ndarray, " gear"]) -> Cure:
    """The keys of a file with these numbers of teeth."""
    listed: Cure = {}
    for number, places in zip(teeth.tolist(), gears.keys, strict=True):
        for key, place in places:
            listed.setdefault(key, [0, 0])[place] = int(number)
    if case.gears is None:
        return listed
    teeth_of_first, *others = listed.values()
    if case.gears.stepped:
        second = [others[0][0], -others[0][1]]
        return {"gears.teeth": teeth_of_first, "gears.second.teeth": second}
    change: Cure = {"gears.teeth": [*teeth_of_first, -others[0][1]]}
    if len(others) > 1:
        change["gears.second.teeth"] = [others[1][0], -others[1][1]]
    return change
