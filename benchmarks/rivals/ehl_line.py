"""Line contacts with an oil film, solved one after another in NumPy: Newton's method, dense.

Steady Reynolds equation, elastic half spaces and load together, in units of Hertz's half-width and pressure:
unknown are the pressure at every node and the distance of the surfaces, cavitation is an active set
(pressure at or above zero). Viscosity by Roelands, density by Dowson and Higginson. Third-order upwind for
the flow that the surfaces drag; the conductance of the film between two nodes is the geometric mean ahead of
the middle and the arithmetic one behind it.

`solve` is the rival, as a careful user writes it: kernel and grid are made once for all cases, derivatives
are written out, band matrices are arrays of diagonals that multiply the kernel row by row, and LAPACK does
the rest. The first guess is Hertz's pressure, steps are limited to .3 of the largest one, and a defect of the
flow is measured by the pressure that mends it at its node.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv

Array = NDArray[np.float64]

P_ROELANDS, LN_ETA = 1.96e8, 9.67
INLET, OUTLET = -4.0, 1.5


class Case(NamedTuple):
    """A contact, SI: load per length, mean surface speed, radius, E', eta_0, alpha."""

    line_load: float
    speed: float
    radius: float
    modulus: float
    viscosity: float
    pressure_viscosity: float


class Solution(NamedTuple):
    """Pressure [Hertz's] and film [b^2/R] at the nodes [b], steps, and the largest residual."""

    x: Array
    pressure: Array
    film: Array
    steps: int
    residual: float


@lru_cache(maxsize=4)
def grid(nodes: int) -> tuple[Array, Array]:
    """Nodes and the kernel of deflection: pressure constant around each node."""
    x = np.linspace(INLET, OUTLET, nodes)
    half = 0.5 * (x[1] - x[0])
    far, near = x[:, None] - x + half, x[:, None] - x - half
    kernel = -(far * np.log(np.abs(far)) - near * np.log(np.abs(near)) - (far - near)) / math.pi
    return x, kernel


def solve(case: Case, nodes: int, *, tolerance: float = 1e-9, most: int = 80) -> Solution:
    """One case."""
    x, kernel = grid(nodes)
    step = x[1] - x[0]
    load = case.line_load / (case.modulus * case.radius)
    half_width = case.radius * math.sqrt(8.0 * load / math.pi)
    hertz = case.modulus * math.sqrt(load / (2.0 * math.pi))
    drag = 12.0 * case.viscosity * case.speed * case.radius**2 / (half_width**3 * hertz)
    thick = math.log(case.viscosity) + LN_ETA
    power = case.pressure_viscosity * P_ROELANDS / thick

    ahead = 0.5 * (x[1:] + x[:-1]) < 0.0
    pressure = np.sqrt(np.clip(1.0 - x**2, 0.0, None))
    guess = 3.06 * (case.pressure_viscosity * case.modulus) ** 0.56
    guess *= (case.viscosity * case.speed / (case.modulus * case.radius)) ** 0.69 * load**-0.1
    level = guess * (case.radius / half_width) ** 2 - (kernel @ pressure)[np.argmin(np.abs(x))]
    least = 0.1 * guess * (case.radius / half_width) ** 2  # keeps a trial film positive
    inner = np.arange(1, nodes - 1)
    matrix = np.zeros((nodes + 1, nodes + 1), order="F")
    total = math.pi / 2.0
    steps = 0
    while steps < most:
        steps += 1
        film = level + 0.5 * x**2 + kernel @ pressure
        film = np.where(film < least, least * np.exp(np.minimum(film / least, 1.0) - 1.0), film)
        safe = np.clip(pressure, 0.0, None) * hertz
        bent = 1.0 + safe / P_ROELANDS
        viscous = np.exp(thick * (bent**power - 1.0))
        viscous_slope = thick * power * bent ** (power - 1.0) * hertz / P_ROELANDS
        dense = 1.0 + 0.6e-9 * safe / (1.0 + 1.7e-9 * safe)
        dense_slope = 0.6e-9 * hertz / (1.0 + 1.7e-9 * safe) ** 2
        yields = dense * film**3 / (viscous * drag)
        by_pressure = yields * (dense_slope / dense - viscous_slope)
        by_film = 3.0 * yields / film

        one, other = yields[:-1], yields[1:]
        mean = np.where(ahead, np.sqrt(np.abs(one * other)), 0.5 * (one + other))
        share_one = np.where(ahead, 0.5 * mean / one, 0.5)
        share_other = np.where(ahead, 0.5 * mean / other, 0.5)
        slope = np.diff(pressure) / step
        flow = mean * slope
        mass = dense * film
        padded = np.concatenate(([mass[0]], mass))  # one node more ahead of the inlet
        carried = (2.0 * padded[2:] + 5.0 * padded[1:-1] - padded[:-2]) / 6.0
        rest = (np.diff(flow) - np.diff(carried)) / step
        stiff = (
            1.0 + (mean[1:] + mean[:-1]) / step**2
        )  # turns a defect of flow into one of pressure
        full = pressure[1:-1] > -rest / stiff
        defect = np.where(full, -rest / stiff, pressure[1:-1])
        miss = step * pressure.sum() - total

        # derivatives of the flow through each face to pressure and film at the nodes beside it
        p_one = share_one * by_pressure[:-1] * slope - mean / step
        p_other = share_other * by_pressure[1:] * slope + mean / step
        h_one, h_other = share_one * by_film[:-1] * slope, share_other * by_film[1:] * slope
        bands_p = np.zeros((4, nodes - 2))  # nodes i - 2, i - 1, i, i + 1
        bands_h = np.zeros((4, nodes - 2))
        for bands, low, high, of_mass in (
            (bands_p, p_one, p_other, dense_slope * film),
            (bands_h, h_one, h_other, dense),
        ):
            before = np.concatenate(([of_mass[0]], of_mass[:-3]))
            bands[0] = -before / 6.0
            bands[1] = -low[:-1] + of_mass[:-2]
            bands[2] = low[1:] - high[:-1] - 0.5 * of_mass[1:-1]
            bands[3] = high[1:] - of_mass[2:] / 3.0
            bands *= full / (-step * stiff)
        matrix[:] = 0.0
        rows = matrix[: nodes - 2]
        block = sum(bands_h[k][:, None] * kernel[np.maximum(inner - 2 + k, 0)] for k in range(4))
        rows[:, 1 : nodes - 1] = block[:, 1:-1]
        rows[:, nodes] = bands_h.sum(axis=0)
        for k in range(4):
            column = inner - 2 + k
            kept = (column > 0) & (column < nodes - 1)
            rows[inner[kept] - 1, column[kept]] += bands_p[k][kept]
        rows[inner - 1, inner] += ~full
        matrix[nodes - 2, 1 : nodes - 1] = step
        matrix[nodes - 1, 0] = matrix[nodes, nodes - 1] = 1.0  # the ends have no pressure
        right = np.concatenate((-defect, [-miss], [0.0, 0.0]))
        found = dgesv(matrix, right)[2]
        change, lift = found[:nodes], found[nodes]
        residual = max(np.abs(defect).max(), abs(miss))
        if residual < tolerance:
            break
        limit = min(1.0, 0.3 / np.abs(change).max())
        pressure = pressure + limit * change
        level += limit * lift
    return Solution(x, pressure, film, steps, float(residual))
