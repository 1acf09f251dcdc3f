"""Estimates of the error by the grid against twice as many nodes, of random smooth lines.

    .venv/bin/python tests/long/errors_of_grids.py [number]

Drawn as in `many_line_films.py`. Ends with an error unless nine in ten films, in the middle and smallest
ones, are off by less than was estimated, and half by more than a third of that.
"""

import sys

import numpy as np
from many_line_films import HIGH, LOW, MODULUS
from scipy.stats import qmc

import pitchpoint
from pitchpoint.lubrication.ehl.doubts import WIDE
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.materials.fluid import Fluid

BELOW, ABOVE = 0.9, 0.5
"""Shares of films that are off by less than was estimated, and by more than a third of it."""

ALPHAS = (1e-8, 3e-8)


def lines(count: int, nodes: int = 129, seed: int = 21) -> tuple[np.ndarray, np.ndarray]:
    """Estimated errors and true ones, of films in the middle and smallest ones, shape (2, contact)."""
    low, high = (*LOW[:4], ALPHAS[0]), (*HIGH[:4], ALPHAS[1])
    unit = qmc.LatinHypercube(len(low), seed=seed).random(count)
    pressure, speed, radius, viscosity, alpha = np.exp(
        np.log(low) + unit * np.diff(np.log([low, high]), axis=0)
    ).T
    case = LineContact(
        line_load=2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * radius,
        radius=radius,
        modulus=np.full(count, MODULUS),
        speed_a=speed,
        speed_b=speed,
        fluid=Fluid(viscosity=viscosity, pressure_viscosity=alpha),
    )
    coarse, fine = (solve_lines(case, nodes=n, profiles=False) for n in (nodes, 2 * nodes - 1))
    both = coarse.solved & fine.solved & (4.0 * pressure / MODULUS < WIDE)
    estimated = np.stack([coarse.ended.grid, coarse.ended.grid_minimum])
    return estimated[:, both], true_errors(coarse, fine)[:, both]


def true_errors(coarse: Films, fine: Films) -> np.ndarray:
    """Of the film in the middle and the smallest one, against those on a finer grid."""
    names = "central_film", "minimum_film"
    return np.stack(
        [np.abs(getattr(fine.film, one) / getattr(coarse.film, one) - 1.0) for one in names]
    )


def judged(name: str, estimated: np.ndarray, true: np.ndarray) -> bool:
    """Whether estimates are right often enough; prints how often."""
    below, above = np.mean(true < estimated, axis=1), np.mean(true > estimated / 3.0, axis=1)
    for place, less, more, off in zip(
        ("in the middle", "smallest"), below, above, true, strict=True
    ):
        print(
            f"{name}, {place}: {off.size} films, off by {100.0 * np.median(off):.2f} % in the median and "
            f"{100.0 * off.max():.1f} % at most; {100.0 * less:.0f} % by less than estimated, "
            f"{100.0 * more:.0f} % by more than a third of that"
        )
    return bool((below >= BELOW).all() and (above >= ABOVE).all())


def main(count: int = 60) -> int:
    """Print the table; 1 where estimates are too often wrong."""
    with pitchpoint.double_precision():
        return int(not judged("lines", *lines(count)))


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:2])))
