"""Film between spur teeth from the beginning of their contact to its end, and the steady film in the middle.

    .venv/bin/python tests/long/film_of_a_tooth.py [nodes [rq in um]]

A crowned pair of 20 teeth each, module 4 mm, whose load doubles where one pair carries alone. Ends with an
error if a film is not found, or if the film under a load that stays is not the steady one.
"""

import sys
import time

import numpy as np

from pitchpoint.contact.end_profiles import crowned
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, finite_line
from pitchpoint.lubrication.ehl.patch.patch_films import solve_patch
from pitchpoint.lubrication.ehl.patch.transient import PatchMoment, march_patches
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.materials.fluid import Fluid

MODULE, TEETH, WIDTH, ANGLE = 4e-3, 20, 10e-3, np.radians(20.0)
FORCE, SPEED, MODULUS, COUNT = 2000.0, 100.0, 2.26e11, 41
ALONE, CHANGE = (0.3, 0.7), 0.06
OIL = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="ree_eyring_1955")


def tooth(rq: float) -> tuple[list[PatchContact], np.ndarray]:
    """Contacts along the line of action, and their times [s]."""
    part = np.linspace(0.0, 1.0, COUNT)
    base = 0.5 * MODULE * TEETH * np.cos(ANGLE)
    place = (part - 0.5) * 1.5 * np.pi * MODULE * np.cos(ANGLE)
    middle = base * np.tan(ANGLE)
    alone = np.clip(np.minimum(part - ALONE[0], ALONE[1] - part) / CHANGE, 0.0, 1.0)
    ends = np.clip(np.minimum(part, 1.0 - part) / 0.1, 0.3, 1.0)
    given = {"length": WIDTH, "modulus": MODULUS, "fluid": OIL}
    given["profile"] = crowned(width=WIDTH, radius=4.0)
    if rq:
        given["texture"] = Rough(rq=rq, modulus=MODULUS)
    contacts = [
        finite_line(
            load=load, radius=a * b / (a + b), speed_a=SPEED * a, speed_b=SPEED * b, **given
        )
        for load, a, b in zip(
            FORCE * 0.5 * (1.0 + alone) * ends, middle + place, middle - place, strict=True
        )
    ]
    return contacts, (place - place[0]) / (SPEED * base)


def told(moment: PatchMoment, spent: float) -> str:
    """One line on a moment."""
    film = moment.film
    return (
        f"{1e3 * moment.time:7.3f} ms  {1e-9 * film.hertz_pressure:5.2f} GPa  "
        f"h_c {1e9 * film.central_film:5.0f}  h_min {1e9 * film.minimum_film:5.0f} nm  "
        f"asperities {100.0 * film.asperity_share:4.1f} %  {moment.ended.steps:3d} steps in "
        f"{moment.time_steps}  {spent:5.2f} s"
    )


def main(nodes: int, rq: float) -> int:
    """March, and compare the film in the middle of the way with the steady one."""
    contacts, times = tooth(rq)
    grid = {"nodes": nodes, "cells": nodes - 1}
    moments: list[PatchMoment] = []
    begin = time.perf_counter()
    for moment in march_patches(contacts, times, **grid):
        now = time.perf_counter()
        print(told(moment, now - begin))
        moments.append(moment)
        begin = now
    if len(moments) < COUNT or not moments[-1].solved:
        print("a film was not found")
        return 1
    steady = solve_patch(contacts[COUNT // 2], **grid).film
    off = float(moments[COUNT // 2].film.central_film / steady.central_film) - 1.0
    print(f"film in the middle of the way over the steady one, less one: {100.0 * off:.2f} %")
    return int(abs(off) > 0.03)


if __name__ == "__main__":
    given = [float(one) for one in sys.argv[1:]] + [65.0, 0.0][len(sys.argv) - 1 :]
    sys.exit(main(int(given[0]), 1e-6 * given[1]))
