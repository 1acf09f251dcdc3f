"""Estimates of the error by the grid against twice as many nodes, of random smooth contacts.

    .venv/bin/python tests/long/errors_of_grids.py [number [patches [nodes [seed]]]]

Lines without ends are drawn as in `many_line_films.py`; ellipses and finite lines, half as many as `patches`
of each, as in `many_patch_films.py`, those with a load parameter M of 5 to 1000. Ends with an error unless
nine in ten films of each kind, in the middle and smallest ones, are off by less than was estimated, and half
by more than a third of that. Counts contacts without a film on one of the grids, and without an estimate.
Estimates over patches are chosen in view of ellipses of seeds 911 to 914, 931 to 933 and 1931 to 1933 and
finite lines of seeds 921 to 923 and 1941, M up to 100, those of lines without ends of seeds 31, 32, 501 to
504, 7001 to 7004 and 7301. Films up to M = 100, for which 65 nodes are usual, are printed once more by
themselves.
"""

import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from many_line_films import HIGH, LOW, MODULUS
from many_patch_films import drawn
from scipy.stats import qmc

import pitchpoint
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.doubts import WIDE
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import laid_out
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, solve_patch
from pitchpoint.lubrication.ehl.solve import HEAVY, Films, solve_lines
from pitchpoint.materials.fluid import Fluid

BELOW, ABOVE = 0.9, 0.5
"""Shares of films that are off by less than was estimated, and by more than a third of it."""

ALPHAS = (1e-8, 3e-8)

LOADS = (5.0, 1000.0)
"""Load parameters M of ellipses and finite lines, by the line load in their middle."""


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


def true_errors(coarse: Films | PatchFilms, fine: Films | PatchFilms) -> np.ndarray:
    """Of the film in the middle and the smallest one, against those on a finer grid."""
    names = "central_film", "minimum_film"
    return np.stack(
        [np.abs(getattr(fine.film, one) / getattr(coarse.film, one) - 1.0) for one in names]
    )


def patches(
    kind: int, count: int, nodes: int, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same of finite lines, kind 0, or ellipses, kind 1, and their load parameters."""
    estimated, true, loads, lost = [], [], [], 0
    for contact in _smooth(kind, count, seed):
        films = [_solved(contact, number) for number in (nodes, 2 * nodes - 1)]
        if any(one is None for one in films):
            lost += 1
            continue
        estimated.append([films[0].ended.grid, films[0].ended.grid_minimum])
        true.append(true_errors(*films))
        loads.append(_load(contact))
    told, off = np.array(estimated).T, np.array(true).T
    known = np.isfinite(told).all(axis=0) & np.isfinite(off).all(axis=0)
    print(
        f"{lost} of {count} without a film on one of the grids, {np.sum(~known)} without an estimate"
    )
    return told[:, known], off[:, known], np.array(loads)[known]


def _smooth(kind: int, count: int, seed: int) -> Iterator[PatchContact]:
    """So many contacts without asperities."""
    for k, one in enumerate(drawn(16 * count, seed)):
        contact = replace(one.contact, texture=None)
        if k % 2 != kind or 4.0 * one.pressure / MODULUS > WIDE:
            continue
        if LOADS[0] < _load(contact) < LOADS[1]:
            yield contact
            count -= 1
        if count == 0:
            return


def _load(contact: PatchContact) -> float:
    """Load parameter M of the line load in the middle."""
    layout = laid_out(contact, 64)
    line_load = 0.5 * np.pi * layout.hertz_pressure * layout.half_width / (MODULUS * layout.radius)
    speeds = 2.0 * float(contact.fluid.viscosity) * layout.speed / (MODULUS * layout.radius)
    return float(line_load / np.sqrt(speeds))


def _solved(contact: PatchContact, nodes: int) -> PatchFilms | None:
    try:
        films = solve_patch(contact, nodes=nodes, cells=nodes - 1)
    except InputError:
        return None
    return films if films.solved else None


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


def main(count: int = 60, more: int = 20, nodes: int = 65, seed: int = 21) -> int:
    """Print the table; 1 where estimates are too often wrong."""
    with pitchpoint.double_precision():
        right = [judged("lines without ends", *lines(count))] if count else []
        for kind, name in enumerate(("finite lines", "ellipses")) if more else ():
            told, off, loads = patches(kind, more // 2, nodes, seed)
            right.append(judged(name, told, off))
            light = loads <= HEAVY
            if light.any():
                judged(f"{name} up to M = {HEAVY:g}", told[:, light], off[:, light])
    return int(not all(right))


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:5])))
