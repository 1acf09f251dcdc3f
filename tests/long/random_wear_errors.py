"""Errors that are told of the wear of random gears, against finer cells, phases and slices.

    .venv/bin/python tests/long/random_wear_errors.py [number [seed [cells [phases]]]]
    .venv/bin/python tests/long/random_wear_errors.py torus | strain_wave [number [seed [cells [phases]]]]

Spur and helical pairs in turn, two with the profile updated and two with it kept; each is worn on the grid of
a case file, or the one that is given, and again with twice as many cells, phases and slices of helical lines
and a tenth of the tolerance, to the same turns. The examples of the other families likewise with random
dimensions and loads, against four times as many cells and phases. Prints the largest depth of both members,
how far it is off and how far it was told to be. Ends with an error where fewer than nine in ten of a kind are
off by less.
"""

import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.errors import InputError
from pitchpoint.runs.run import run_case

BELOW = 0.9
TURNS = 1e7
TOLERANCE = 3e-4
SLICES = 12
EXAMPLES = Path(__file__).parents[2] / "examples"
CASE = """
[lubricant]
name = "pao-vg-220"
[roughness]
ra = "0.5 um"
[operation]
speed = "300 rpm"
temperature = "80 degC"
[models]
friction = { name = "constant", coefficient = 0.05 }
[wear]
law = "archard_1953"
hardness = "700 HV"
sensitivities = false
"""


def drawn(seed: int) -> Iterator[dict[str, Any]]:
    """Settings of random pairs without end, among them some that cannot be made."""
    random = np.random.default_rng(seed)
    number = 0
    while True:
        pinion = int(random.integers(15, 41))
        module = float(random.choice([1.0, 1.5, 2.0, 3.0, 4.0]))
        width = module * random.uniform(6.0, 12.0)
        stress = np.exp(random.uniform(*np.log([0.3, 4.0])))  # F_t/(b d_1) [MPa]
        shifts = random.uniform(0.0 if pinion < 22 else -0.1, 0.5), random.uniform(-0.3, 0.3)
        updated = number % 4 < 2
        settings: dict[str, Any] = {
            "gears.teeth": [pinion, int(pinion * random.uniform(1.0, 4.0))],
            "gears.module": f"{module} mm",
            "gears.face_width": f"{width} mm",
            "gears.profile_shift": list(map(float, shifts)),
            "operation.torque": f"{5e-4 * stress * width * (pinion * module) ** 2} N m",
            "models.load_sharing": "from_stiffness" if updated or number % 8 < 4 else "equal",
            "wear.coefficient": float(np.exp(random.uniform(*np.log([1e-8, 5e-7])))),
            "wear.profile": "updated" if updated else "kept",
        }
        if number % 2:
            settings["gears.helix_angle"] = f"{random.uniform(8.0, 25.0)} deg"
        number += 1
        yield settings


def of_example(name: str, seed: int) -> Iterator[dict[str, Any]]:
    """Settings of an example with random dimensions and loads without end."""
    random = np.random.default_rng(seed)
    number = 0
    while True:
        own = {
            "torus": {
                "gears.teeth": [
                    teeth := int(random.integers(25, 45)),
                    teeth + int(random.integers(0, 40)),
                ],
                "gears.torus_radius": [f"{random.uniform(25.0, 40.0)} mm", "60 mm"],
                "gears.inclination": f"{random.uniform(0.0, 6.0)} mrad",
                "operation.torque": f"{np.exp(random.uniform(*np.log([20.0, 150.0])))} N m",
            },
            "strain_wave": {
                "gears.module": f"{random.uniform(0.25, 0.4)} mm",
                "gears.face_width": f"{random.uniform(8.0, 14.0)} mm",
                "operation.torque": f"{np.exp(random.uniform(*np.log([10.0, 80.0])))} N m",
            },
        }[name]
        if name == "torus":
            own["gears.centre_distance"] = f"{1.25 * sum(own['gears.teeth']) + 0.15} mm"
        yield {
            **own,
            "models.load_sharing": "from_stiffness",
            "wear.law": "archard_1953",
            "wear.hardness": "700 HV",
            "wear.sensitivities": False,
            "wear.coefficient": float(np.exp(random.uniform(*np.log([1e-8, 2e-7])))),
            "wear.profile": "updated" if number % 2 else "kept",
        }
        number += 1


def worn(
    kind: str, settings: Mapping[str, Any], turns: float, cells: int, phases: int, finer: int
) -> xr.Dataset:
    """The course of wear on a grid that is so many times finer."""
    grid = {"wear.cells": finer * cells, "wear.phases": finer * phases}
    if kind == "helical":
        grid["models.slices"] = finer * SLICES
    march = {"wear.cycles": turns, "wear.tolerance": TOLERANCE if finer == 1 else TOLERANCE / 10.0}
    with tempfile.TemporaryDirectory() as folder:
        case = EXAMPLES / f"{kind}.toml"
        if not case.exists():
            case = Path(folder) / "wear.toml"
            case.write_text(CASE, "utf-8")
        (outcome,) = run_case(
            str(case), settings={**settings, **grid, **march}, analyses=["wear"]
        ).values()
    return outcome.parts["wear"]


def compared(
    kind: str, settings: Mapping[str, Any], cells: int, phases: int
) -> tuple[np.ndarray, ...]:
    """Largest depths of both members, how far they are told to be off, and how far they are [m]."""
    finer = 2 if kind in ("spur", "helical") else 4
    coarse = worn(kind, settings, TURNS, cells, phases, 1)
    fine = worn(kind, settings, float(coarse["final_cycles"]), cells, phases, finer)
    turns = float(fine["final_cycles"])
    if turns < coarse["final_cycles"]:
        coarse = worn(kind, settings, turns, cells, phases, 1)
    depth, told = coarse["deepest_wear"].values[-1], coarse["wear_error"].values[-1]
    return depth, told, np.abs(fine["deepest_wear"].values[-1] - depth)


def main(*kinds: str, count: int = 20, seed: int = 6, cells: int = 40, phases: int = 24) -> int:
    """Print the table; 1 where errors are too often larger than told."""
    below: dict[str, list[bool]] = {kind: [] for kind in kinds or ("spur", "helical")}
    for settings in of_example(kinds[0], seed) if kinds else drawn(seed):
        if sum(map(len, below.values())) >= 2 * count:
            break
        kind = kinds[0] if kinds else "helical" if "gears.helix_angle" in settings else "spur"
        name = f"{kind} {settings.get('gears.teeth', '')}, {settings['wear.profile']}"
        try:
            depth, told, off = compared(kind, settings, cells, phases)
        except InputError as error:
            print(f"{name}: {error.message[:70]}", flush=True)
            continue
        below[kind].extend(map(bool, off < told))
        rows = (
            f"{1e6 * h:.3g} um told {t / h:.1e} off {o / h:.1e}"
            for h, t, o in zip(depth, told, off, strict=True)
        )
        print(f"{name}: {'; '.join(rows)}", flush=True)
    for kind, less in below.items():
        print(f"{kind}: {sum(less)} of {len(less)} off by less than told")
    return int(any(np.mean(less) < BELOW for less in below.values() if less))


if __name__ == "__main__":
    names = [argument for argument in sys.argv[1:] if not argument.isdigit()]
    numbers = map(int, filter(str.isdigit, sys.argv[1:]))
    sys.exit(main(*names, **dict(zip(("count", "seed", "cells", "phases"), numbers, strict=False))))
