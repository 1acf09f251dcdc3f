"""Temperatures of 100 random line contacts that slide: how many are solved, in how many turns, how warm.

    .venv/bin/python tests/long/many_warm_films.py [number]

Drawn as those of `many_line_films.py`, with slide-roll ratios of 0.01 to 2.5 and an oil that thins; steel on
steel. Beside them the same contacts isothermally: what has no film there has none with heat either. Ends with
an error if fewer than 99 of 100 of those that are solved isothermally are solved.
"""

import dataclasses
import sys

import numpy as np
from many_line_films import ALPHA, HIGH, LOW, MODULUS, SEED
from scipy.stats import qmc

from pitchpoint.core.status import Code
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.film_thickness import moes_1992
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials import solids
from pitchpoint.materials.fluid import Fluid

LEAST, MOST = (*LOW, 0.01), (*HIGH, 2.5)


def drawn(count: int) -> LineContact:
    """Contacts that slide."""
    unit = qmc.LatinHypercube(len(LEAST), seed=SEED).random(count)
    every = np.exp(np.log(LEAST) + unit * (np.log(MOST) - np.log(LEAST)))
    pressure, speed, radius, viscosity, ratio, slide = every.T
    load = 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * radius
    given = {"line_load": load, "radius": radius, "modulus": np.full(count, MODULUS)}
    oil = {"viscosity": viscosity, "pressure_viscosity": np.full(count, ALPHA)}
    film = np.asarray(moes_1992(**given, **oil, entrainment=speed))
    steel = Conductor.of(solids.find("steel"))
    return LineContact(
        **given,
        speed_a=speed * (1.0 + slide / 2.0),
        speed_b=speed * (1.0 - slide / 2.0),
        fluid=Fluid(**oil, viscosity_slope=0.04, shear_law="ree_eyring_1955"),
        texture=Rough(rq=film / ratio, modulus=MODULUS),
        conduction=Conduction(a=steel, b=steel, oil_conductivity=0.14),
    )


def main(count: int) -> int:
    """Print the table; 1 where too few are solved."""
    contact = drawn(count)
    warm = solve_lines(contact)
    cold = solve_lines(dataclasses.replace(contact, conduction=None))
    for code in np.unique(warm.ended.code):
        print(f"{int(np.sum(warm.ended.code == code)):6d}  {Code(int(code)).sentence}")
    both = warm.solved & cold.solved
    turns, rise = warm.ended.turns[both], warm.film.heat.largest_film[both]
    thinner = (warm.film.central_film / cold.film.central_film)[both]
    weaker = np.abs(warm.film.shear_force / cold.film.shear_force)[both]
    print(f"turns: median {np.median(turns):.0f}, most {turns.max()}")
    print(f"largest defect of a temperature: {warm.ended.temperature[both].max():.1e} of its rise")
    print(f"largest rise: median {np.median(rise):.3g} K, most {rise.max():.3g} K")
    print(f"film over the isothermal one: {thinner.min():.3f} to {thinner.max():.3f}")
    print(f"shear of the oil over the isothermal one: {weaker.min():.3f} to {weaker.max():.3f}")
    share = both.sum() / cold.solved.sum()
    print(f"solved: {100.0 * share:.2f} % of the {cold.solved.sum()} that are solved isothermally")
    return int(share < 0.99)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 100))
