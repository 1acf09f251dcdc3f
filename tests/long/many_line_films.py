"""Films of 400 random line contacts, smooth to mixed: how many are solved, and why the rest are not.

    .venv/bin/python tests/long/many_line_films.py [number]

Drawn by a seeded Latin hypercube over the logarithms of Hertz's pressure, mean speed, radius and viscosity,
and of the film of a regression over the roughness. Contacts of which a half space says little (wide against
their radius) are counted apart. Ends with an error if fewer than 99 of 100 are solved.
"""

import sys
from collections import Counter

import numpy as np
from scipy.stats import qmc

from pitchpoint.core.status import Code
from pitchpoint.lubrication.ehl.doubts import WIDE
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.film_thickness import moes_1992
from pitchpoint.materials.fluid import Fluid

LOW = (0.1e9, 0.01, 1e-3, 5e-3, 0.2)
HIGH = (1.8e9, 20.0, 1.0, 0.5, 6.0)
MODULUS, ALPHA, SEED = 2.26e11, 2e-8, 13


def main(count: int) -> int:
    """Print the table; 1 where fewer than 99 of 100 are solved."""
    unit = qmc.LatinHypercube(len(LOW), seed=SEED).random(count)
    drawn = np.exp(np.log(LOW) + unit * (np.log(HIGH) - np.log(LOW)))
    pressure, speed, radius, viscosity, ratio = drawn.T
    load = 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * radius
    given = {"line_load": load, "radius": radius, "modulus": np.full(count, MODULUS)}
    film = moes_1992(
        **given, entrainment=speed, viscosity=viscosity, pressure_viscosity=np.full(count, ALPHA)
    )
    rough = Rough(rq=np.asarray(film) / ratio, modulus=MODULUS)
    fluid = Fluid(viscosity=viscosity, pressure_viscosity=np.full(count, ALPHA))
    found = solve_lines(
        LineContact(**given, speed_a=speed, speed_b=speed, fluid=fluid, texture=rough)
    )
    half_space = np.asarray(4.0 * pressure / MODULUS) < WIDE
    for name, which in (("half spaces", half_space), ("wider contacts", ~half_space)):
        codes = Counter(Code(int(code)).sentence for code in found.ended.code[which])
        print(f"{name}: {int(which.sum())}")
        for sentence, number in codes.most_common():
            print(f"    {number:4d}  {sentence}")
    share, steps = found.film.asperity_share[found.solved], found.ended.iterations[found.solved]
    print(
        f"load on asperities: {share.min():.1e} to {share.max():.3f}, median {np.median(share):.3f}"
    )
    print(f"steps on both grids: median {np.median(steps):.0f}, most {steps.max()}")
    print(
        f"largest defect: Reynolds {found.ended.reynolds[found.solved].max():.1e}, "
        f"load {found.ended.load[found.solved].max():.1e}"
    )
    solved = found.solved[half_space].mean()
    print(f"solved: {100.0 * solved:.2f} % of half spaces")
    return int(solved < 0.99)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 400))
