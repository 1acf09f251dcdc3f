"""Random planetary sets, stepped and 3K ones among them, and sets in a row: computed, or a sentence.

    .venv/bin/python tests/long/random_trains.py [number [seed [from]]]

Teeth, planets, shifts, modules, helix, parts of sun, carrier and rings, load, friction: drawn by a seed, most
of them so that planets assemble, some without any sense. What is computed gives as much power as goes in less
the sum of all losses, and its torques are those by Willis with the efficiencies of its meshes, both to 1e-9;
what is refused is so by one sentence for each thing that is wrong. Prints every fault, with the table that
makes it, and a table of outcomes. Ends with an error where there is a fault.
"""

import re
import sys
import time
import traceback
from collections import Counter
from itertools import permutations
from math import gcd, pi, sin
from typing import Any

import numpy as np

from pitchpoint import double_precision
from pitchpoint.analyses.summaries import summaries
from pitchpoint.cases.built_drive import BuiltTrain, Ready
from pitchpoint.drive.kinematics import Ends
from pitchpoint.drive.torques import train_torques
from pitchpoint.errors import PitchpointError
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.runs.run import load_case

AGREES = 1e-9
KINDS = ("simple", "stepped", "3K", "in a row")
HOW_OFTEN = (0.4, 0.25, 0.25, 0.1)

STEPS = ((2, 1), (1, 2), (3, 2), (2, 3), (1, 1))
"""Ratios of the teeth of both gears of a planet: each pair has programs of its own to be compiled."""

PLANETS = (2, 3, 3, 4, 5)
TRIES = 2000
NO_SENSE = 0.1
"""Part of the sets that are drawn without regard to what goes."""

NOT_A_SENTENCE = re.compile(r"\n|\bnan\b|\binf\b|\bNone\b|Array\(|Traceback|object at")

Tree = dict[str, Any]


class FaultError(Exception):
    """A result that contradicts itself."""


def draw(random: np.random.Generator) -> tuple[str, Tree]:
    """A kind of train, and its case."""
    kind = str(random.choice(KINDS, p=HOW_OFTEN))
    tree: Tree = {
        "lubricant": {"name": "pao-vg-150"},
        "roughness": {"ra": "0.4 um"},
        "operation": {
            "torque": f"{10 ** random.uniform(-1.0, 2.5):.4g} N m",
            "speed": f"{10 ** random.uniform(1.0, 4.0):.4g} rpm",
            "temperature": "60 degC",
        },
        "models": {"friction": {"name": "constant", "coefficient": _friction(random)}},
    }
    if kind != "in a row":
        return kind, tree | {"gears": _set(kind, random)}
    sets = [_set(str(random.choice(KINDS[:-1])), random) for _ in range(random.integers(2, 4))]
    return kind, tree | {"stages": [{"gears": gears} for gears in sets]}


def _friction(random: np.random.Generator) -> float:
    return 0.0 if random.random() < 0.05 else round(float(10 ** random.uniform(-2.0, -0.7)), 4)


def _set(kind: str, random: np.random.Generator) -> Tree:
    """Table of gears of a set."""
    bodies = ["sun", "carrier", "ring"] if kind != "3K" else ["sun", "ring", "second ring"]
    if random.random() < NO_SENSE:
        return _without_sense(kind, bodies, random)
    planets = int(random.choice(PLANETS))
    teeth = _teeth(kind, planets, random)
    for _ in range(TRIES):
        if random.random() < 0.01 or _assembles(kind, planets, teeth):
            break
        teeth = _teeth(kind, planets, random)
    sun, planet, ring, second, second_ring = teeth
    module = float(random.choice([0.5, 1.0, 2.0]))
    shifts = random.uniform(-0.1, 0.4, 3).round(3).tolist()
    table: Tree = {
        "family": "planetary",
        "teeth": [sun, planet] if kind == "stepped" else [sun, planet, ring],
        "planets": planets,
        "module": f"{module} mm",
        "face_width": f"{random.uniform(5.0, 20.0) * module:.3g} mm",
        "helix_angle": f"{random.choice([0, 0, 0, 0, 0, 0, 0, 15])} deg",
        "profile_shift": shifts[:2],
        "fillet_radius": [0.3, 0.2, 0.1],
        **_parts(kind, bodies, planets + second, random),
    }
    if kind != "simple":
        width = f"{random.uniform(5.0, 20.0) * module:.3g} mm"
        shift = [shifts[2], FROM_CENTRE_DISTANCE]
        table["second"] = {
            "teeth": [second, second_ring],
            "face_width": width,
            "profile_shift": shift,
        }
        if random.random() < 0.3:
            of = (sun + planet) / (second_ring - second)
            table["second"]["module"] = f"{module * of:.3g} mm"
    return table


def _teeth(kind: str, planets: int, random: np.random.Generator) -> tuple[int, int, int, int, int]:
    """Sun, planet, ring, and second gear of the planets and its ring, in a simple ratio of the planets."""
    sun, planet = map(int, random.integers(14, 50, 2))
    several, of = STEPS[random.integers(len(STEPS))]
    planet = planet if kind == "simple" else of * -(-planet // of)
    second = planet // of * several
    more = random.integers(0, 3, 2).tolist()
    return sun, planet, sun + 2 * planet + more[0], second, sun + planet + second + more[1]


def _assembles(kind: str, planets: int, teeth: tuple[int, int, int, int, int]) -> bool:
    """True if planets stand at equal angles beside each other."""
    sun, planet, ring, second, second_ring = teeth
    step = planets * gcd(planet, second)
    of_two = {
        "simple": (sun + ring) % planets,
        "stepped": (sun * second + second_ring * planet) % step,
        "3K": (sun + ring) % planets + (second_ring * planet - ring * second) % step,
    }
    room = (sun + planet) * sin(pi / planets) > (
        planet if kind == "simple" else max(planet, second)
    ) + 3.0
    return room and not of_two[kind]


def _parts(kind: str, bodies: list[str], number: int, random: np.random.Generator) -> Tree:
    """Who is turned, loaded and held; often as usual, else of sets with second gears by their number.

    Every choice has programs of its own.
    """
    if random.random() < 0.4:
        return {} if kind != "3K" else {"output": "second ring"}
    order = random.permutation(3) if kind == "simple" else [*permutations(range(3))][number % 6]
    turned = [bodies[place] for place in order]
    return dict(zip(("input", "output", "held"), turned, strict=True))


def _without_sense(kind: str, bodies: list[str], random: np.random.Generator) -> Tree:
    """Numbers and names as they come."""
    several = 2 if kind == "stepped" else 3
    table: Tree = {
        "family": "planetary",
        "teeth": random.integers(-3, 200, several).tolist(),
        "planets": int(random.integers(0, 12)),
        "module": f"{10 ** random.uniform(-2.0, 1.5):.3g} mm",
        "face_width": f"{10 ** random.uniform(-1.0, 2.0):.3g} mm",
        "pressure_angle": f"{random.uniform(5.0, 40.0):.3g} deg",
        "helix_angle": f"{random.uniform(-50.0, 50.0):.3g} deg",
        "profile_shift": random.uniform(-2.0, 2.0, random.integers(2, 4)).round(3).tolist(),
        "addendum": round(float(random.uniform(0.3, 1.6)), 3),
        **{name: str(random.choice(bodies)) for name in ("input", "output", "held")},
    }
    if kind != "simple":
        width = {"face_width": f"{10 ** random.uniform(0.0, 2.0):.3g} mm"}
        table["second"] = {"teeth": random.integers(-3, 200, 2).tolist(), **width}
    return table


def outcome(tree: Tree) -> str:
    """What comes of a case, in a word or two.

    Raises:
        FaultError: a result that contradicts itself, or an error that is no sentence.
    """
    try:
        built = load_case(tree)
    except PitchpointError as error:
        _check_sentences(error)
        return "refused: " + _about(error)
    try:
        _check(built)
    except PitchpointError as error:
        _check_sentences(error)
        return "no balance: " + " ".join(str(error).split()[:4])
    return "computed"


def _about(error: PitchpointError) -> str:
    key = getattr(error, "key", None) or "all of it"
    return re.sub(r"^stages\.\d\.", "", str(key))


def _check_sentences(error: PitchpointError) -> None:
    for one in getattr(error, "every", (error,)):
        if NOT_A_SENTENCE.search(str(one)) or not 15 < len(str(one)) < 700:
            raise FaultError(f"no sentence: {one}")


def _check(built: Ready) -> None:
    """FaultError unless power goes somewhere and torques are those of Willis."""
    data = summaries([built], built.models, {}, title="random trains").isel(law=0, point=0)
    point = built.case.operation
    given = point.load * point.speed * built.output_rate
    taken = float(data["mean_input_torque"]) * point.speed
    lost, efficiency = float(data["mean_loss"]), float(data["mean_efficiency"])
    if not np.isclose(taken, given + lost, rtol=AGREES, atol=0.0):
        raise FaultError(f"{taken:.12g} W go in, {given:.12g} W out and {lost:.12g} W are lost")
    if not np.isclose(float(data["stage_loss"].sum()), lost, rtol=AGREES, atol=AGREES * given):
        raise FaultError(f"meshes lose {data['stage_loss'].values} W, together {lost:.12g} W")
    if not 0.0 < efficiency <= 1.0 + 1e-12:
        raise FaultError(f"the efficiency is {efficiency:.12g}")
    if not np.isclose(efficiency, given / taken, rtol=AGREES):
        raise FaultError(f"the efficiency is {efficiency:.12g}, by powers {given / taken:.12g}")
    if isinstance(built, BuiltTrain):
        _check_willis(built, data["stage_efficiency"].values, taken / point.speed)


def _check_willis(built: BuiltTrain, efficiencies: np.ndarray, torque: float) -> None:
    """FaultError unless the torque is that by Willis' relations with these efficiencies of the meshes."""
    train = built.design
    ends = Ends({train.turned: float(train.rates[train.turned])}, train.held, train.loaded)
    links = [one.link for one in train.meshes]
    each = np.minimum(efficiencies, 1.0)
    found = train_torques(links, ends, float(built.case.operation.load), each)
    if not np.isclose(abs(found.torques[train.turned]), torque, rtol=AGREES):
        raise FaultError(
            f"the torque is {torque:.12g} N m, by Willis {found.torques[train.turned]:.12g} N m with {each}"
        )


def main(count: int = 1000, seed: int = 36, begin: int = 0) -> int:
    """Print faults and the table; 1 where there is a fault."""
    begun, faults = time.process_time(), 0
    outcomes: Counter[tuple[str, str]] = Counter()
    slowest: list[tuple[float, int]] = []
    for number in range(begin, count):
        kind, tree = draw(np.random.default_rng([seed, number]))
        at = time.process_time()
        with double_precision():
            try:
                what = outcome(tree)
            except Exception as fault:
                faults, what = faults + 1, "FAULT"
                print(f"{number} {kind}: {fault!r}\n    {tree}", flush=True)
                if not isinstance(fault, FaultError):
                    traceback.print_exc(limit=-9, file=sys.stdout)
        outcomes[kind, what] += 1
        slowest.append((time.process_time() - at, number))
    for (kind, what), times in sorted(outcomes.items(), key=lambda one: (one[0][0], -one[1])):
        print(f"{kind:9s} {times:5d} {what}")
    computed = sum(times for (_, what), times in outcomes.items() if what == "computed")
    print(
        f"{computed} of {count - begin} computed, {faults} faults, {time.process_time() - begun:.0f} s"
    )
    print("slowest [s, number]:", [(round(s, 1), n) for s, n in sorted(slowest)[-5:]])
    return int(faults > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:4])))
