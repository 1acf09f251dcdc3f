"""Films of a slow line with nearly sharp ends and of 60 random crowned lines, all smooth and flooded.

How many are solved.

    .venv/bin/python tests/long/random_finite_lines.py [number [nodes [seed [from]]]]

Drawn by a seeded Latin hypercube: length over half-width evenly from 10 to 54, and over their logarithms
Hertz's pressure, mean speed, radius, viscosity and what the crown lacks at the ends, from .1 b^2/R, which
leaves sharp ends, to 10 b^2/R. Prints each line, from one of them on where that is given, with steps, seconds
of the processor, defects of flow and load, and how many were solved. Ends with an error where fewer than 95
of 100 are.
"""

import sys
import time
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from pitchpoint import double_precision
from pitchpoint.contact.end_profiles import crowned
from pitchpoint.contact.hertz import line_half_width
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, finite_line
from pitchpoint.lubrication.ehl.patch.patch_films import solve_patch
from pitchpoint.materials.fluid import Fluid

LENGTHS = (10.0, 54.0)
SLOW = (0.46e9, 0.027, 0.088, 0.025, 0.3, 26.0)
"""The line that comes before the random ones, as arguments of `crowned_line`."""

LOW = (0.3e9, 0.01, 3e-3, 5e-3, 0.1)
HIGH = (1.5e9, 3.0, 0.2, 0.2, 10.0)
MODULUS, ALPHA = 2.26e11, 2e-8
ASKED = 0.95


class Drawn(NamedTuple):
    """A line, and what it is called."""

    name: str
    contact: PatchContact


def crowned_line(
    pressure: float, speed: float, radius: float, viscosity: float, crown: float, lengths: float
) -> Drawn:
    """A line of so many half-widths, whose crown lacks so many b^2/R at its ends."""
    line_load = 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * radius
    half_width = float(line_half_width(line_load=line_load, radius=radius, modulus=MODULUS))
    length = lengths * half_width
    drop = crown * half_width**2 / radius
    contact = finite_line(
        load=line_load * length,
        length=length,
        radius=radius,
        modulus=MODULUS,
        speed_a=1.05 * speed,
        speed_b=0.95 * speed,
        fluid=Fluid(viscosity=viscosity, pressure_viscosity=ALPHA),
        profile=crowned(width=length, radius=length**2 / (8.0 * drop)),
    )
    name = (
        f"{1e-9 * pressure:.2f} GPa, {speed:.2g} m/s, R {1e3 * radius:.3g} mm, {1e3 * viscosity:.3g} mPa s, "
        f"L/b {lengths:.3g}, crown {crown:.2g} b^2/R"
    )
    return Drawn(name, contact)


def drawn(count: int, seed: int) -> Iterator[Drawn]:
    """The slow line, then random ones."""
    unit = qmc.LatinHypercube(len(LOW) + 1, seed=seed).random(count)
    lengths = LENGTHS[0] + unit[:, 0] * np.ptp(LENGTHS)
    values = np.exp(np.log(LOW) + unit[:, 1:] * np.diff(np.log([LOW, HIGH]), axis=0))
    with double_precision():
        yield crowned_line(*SLOW)
        for row, length in zip(values, lengths, strict=True):
            yield crowned_line(*map(float, row), float(length))


def main(count: int = 60, nodes: int = 65, seed: int = 34, begin: int = 0) -> int:
    """Print the table; 1 where fewer than 95 of 100 are solved."""
    solved = []
    for number, line in list(enumerate(drawn(count, seed)))[begin:]:
        begun = time.process_time()
        with double_precision():
            ended = solve_patch(line.contact, nodes=nodes, cells=nodes - 1).ended
        seconds = time.process_time() - begun
        solved.append(ended.code.name == "SOLVED")
        print(
            f"{number:3d} {line.name}: {ended.code.name}, {ended.steps} steps, {seconds:.1f} s, "
            f"defects {ended.reynolds:.0e} {ended.load:.0e}",
            flush=True,
        )
    print(f"solved: {sum(solved)} of {len(solved)}")
    return int(np.mean(solved) < ASKED)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:5])))
