"""Finite contacts over time: against steady films, closed forms, conservation and the motion of waves."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import equinox as eqx
import numpy as np
import pytest

from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.films import solve_patch
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.layout import laid_out
from pitchpoint.lubrication.ehl.patch.solve import solve
from pitchpoint.lubrication.ehl.patch.transient import PatchMoment, march_patches
from pitchpoint.materials.fluid import Fluid
from pitchpoint.results.films import march_dataset
from pitchpoint.status import Code

MODULUS = 2.26e11
OIL = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="newtonian")
GRID = {"nodes": 33, "cells": 32}
PASSING = 1.1e-4
"""Time in which surfaces of 1 m/s pass half of the contact [s]."""


def ball(load: float = 30.0, speed: float = 1.0, **more: Any) -> PatchContact:
    given = {"load": load, "radius": 0.01, "transverse_radius": 0.02, "modulus": MODULUS}
    speeds = {"speed_a": 0.95 * speed, "speed_b": 1.05 * speed}
    return elliptic_contact(**{**given, **speeds, "fluid": OIL, **more})


def marched(contacts: Sequence[PatchContact], times: Any, **more: Any) -> list[PatchMoment]:
    found = list(march_patches(contacts, times, **{**GRID, **more}))
    assert all(one.solved for one in found), found[-1].ended
    assert len(found) == len(contacts)
    return found


def swelling(count: int, period: float = 8.0 * PASSING) -> tuple[list[PatchContact], np.ndarray]:
    """A load that rises smoothly from 25 to 35 N in half a period, without a kink at its start."""
    times = np.linspace(0.0, 0.5 * period, count + 1)
    loads = 30.0 - 5.0 * np.cos(2.0 * np.pi * times / period)
    return [ball(float(load)) for load in loads], times


def test_what_does_not_change_stays_steady():
    steady = solve_patch(ball(), **GRID).film
    last = marched([ball()] * 4, PASSING * np.arange(4.0))[-1].film
    for name in ("gap", "pressure"):
        one, other = getattr(last, name), getattr(steady, name)
        assert np.allclose(one, other, rtol=0.0, atol=1e-6 * other.max())
    assert last.minimum_film == pytest.approx(float(steady.minimum_film), rel=1e-6)


# ---- plates that are pressed together

FLAT, ETA, LOAD, APPROACH = 1e3, 0.04, 100.0, 1e-3
"""Radius of all but flat plates [m], their oil [Pa s], load [N] and approach at first [m/s]."""


def plates(approach: float) -> PatchContact:
    oil = Fluid(viscosity=ETA, pressure_viscosity=1e-12, shear_law="newtonian")
    given = {"load": LOAD, "radius": FLAT, "transverse_radius": FLAT, "modulus": 1e13, "fluid": oil}
    return elliptic_contact(**given, speed_a=0.0, speed_b=0.0, approach=approach)


@cache
def squeezed(steps: int) -> tuple[list[PatchMoment], float, float]:
    """Plates over the time in which they would close, with their film at first and what squeezes it."""
    layout = laid_out(plates(APPROACH), 32)
    # Cells at the first and the last node are without pressure.
    long, wide = layout.outlet - layout.inlet, layout.last - layout.first
    odd = np.arange(1, 60, 2)
    rows = np.sum(np.tanh(0.5 * odd * np.pi * long / wide) / odd**5)
    bulge = wide**3 * long / 12.0 * (1.0 - 192.0 * wide / np.pi**5 / long * rows)
    film = (12.0 * ETA * APPROACH * bulge / LOAD) ** (1.0 / 3.0)
    contacts = [plates(APPROACH), *[plates(0.0)] * steps]
    times = np.linspace(0.0, film / APPROACH, steps + 1)
    return marched(contacts, times), film, LOAD / (6.0 * ETA * bulge)


def test_plates_are_squeezed_together_as_reynolds_says():
    # h^3 = 12 eta V G/F, d(1/h^2)/dt = F/(6 eta G), with G the integral of the solution of Poisson's equation
    # on the rectangle: the series of a twisted bar (Timoshenko, Goodier, Theory of Elasticity, art. 109).
    moments, film, rate = squeezed(32)
    films = np.array([one.film.central_film for one in moments])
    times = np.array([one.time for one in moments])
    assert films[0] == pytest.approx(film, rel=5e-3)
    assert np.allclose(films, (1.0 / film**2 + rate * times) ** -0.5, rtol=1e-2)


def test_steps_of_time_are_of_second_order():
    films = [float(squeezed(count)[0][-1].film.central_film) for count in (8, 16, 32)]
    order = np.log2((films[1] - films[0]) / (films[2] - films[1]))
    assert 1.7 < order < 2.4


def test_what_leaves_the_film_flows_out_of_it():
    one, other = squeezed(32)[0][-2:]
    film, before = other.film, one.film
    x, y, gap, pressure = (np.asarray(each) for each in (film.x, film.y, film.gap, film.pressure))
    step, width = x[1] - x[0], y[1] - y[0]
    ease = gap**3 / (12.0 * ETA)
    falls = np.abs(np.diff(pressure, axis=1))[:, [0, -1]] / step * width
    ends = np.sum(0.5 * (ease[:, [0, -2]] + ease[:, [1, -1]]) * falls)
    sides = np.sum((ease * pressure)[[0, -1], 1:-1] / (0.5 * width) * step)
    # From the film of two steps ago too, as the scheme takes its slope.
    third = np.asarray(squeezed(32)[0][-3].film.gap)
    slope = (1.5 * gap - 2.0 * np.asarray(before.gap) + 0.5 * third) / (other.time - one.time)
    lost = -np.sum(slope[:, 1:-1]) * step * width
    assert lost == pytest.approx(ends + sides, rel=2e-3)


# ---- contacts that roll


def steady_gap(contact: PatchContact, like: PatchMoment) -> float:
    """Smallest gap [m] of the steady film on the grid of a march."""
    layout = like.course.layout
    _, problem, state = solve(contact, *GRID.values(), None, layout)
    return float(np.min(problem.gap(state.pressure, state.level)) * problem.flow.height)


def test_slow_changes_find_the_steady_film_of_every_time():
    contacts, times = swelling(6, period=4000.0 * PASSING)
    last = marched(contacts, times)[-1]
    exact = steady_gap(contacts[-1], last)
    assert float(last.film.minimum_film) == pytest.approx(exact, rel=1e-3)
    contacts, times = swelling(6, period=2.0 * PASSING)
    last = marched(contacts, times)[-1]
    assert abs(float(last.film.minimum_film) / steady_gap(contacts[-1], last) - 1.0) > 0.02


def test_steps_by_error_keep_to_it():
    contacts, times = swelling(2)
    contacts, times = [contacts[0], contacts[-1]], times[[0, -1]]
    fine = [
        eqx.tree_at(lambda one: one.load, contacts[0], np.asarray(load))
        for load in np.linspace(25.0, 35.0, 65)
    ]
    exact = marched(fine, np.linspace(*times, 65))[-1].film
    films = [marched(contacts, times, steps="by_error", tolerance=one)[-1] for one in (1e-2, 1e-3)]
    assert films[0].time_steps < films[1].time_steps
    off = [abs(float(one.film.mean_film / exact.mean_film) - 1.0) for one in films]
    assert off[0] < 1e-2
    assert off[1] < 2e-3


def test_a_march_goes_on_from_any_of_its_moments():
    contacts, times = swelling(4)
    whole = marched(contacts, times)
    rest = list(march_patches(contacts, times, after=whole[2], **GRID))
    assert [one.time for one in rest] == [one.time for one in whole[3:]]
    assert np.array_equal(rest[-1].film.gap, whole[-1].film.gap)


def test_a_step_in_speed_passes_with_the_mean_speed():
    """Oil that a higher speed draws in is in the middle after half of the contact has passed, not before."""
    slow, fast = ball(speed=1.0), ball(speed=1.6)
    times = np.array([0.0, 0.01, 0.35, 0.7, 1.05, 1.4, 1.75, 2.1]) * PASSING
    films = [one.film for one in marched([slow, *[fast] * 7], times, nodes=65, cells=32)]
    row = films[0].gap.shape[0] // 2
    gain = np.array([one.gap[row] - films[0].gap[row] for one in films])
    steady = solve_patch(fast, nodes=65, cells=32).film.gap
    # Where half of the gain is there: it moves along with the mean speed.
    inside = np.abs(films[0].x) < 0.6 * films[0].half_width
    x, whole = films[0].x[inside], 0.5 * (steady[row] - films[0].gap[row])[inside]
    fronts = [x[one[inside] > whole][-1] if np.any(one[inside] > whole) else x[0] for one in gain]
    speeds = np.diff(fronts) / np.diff(times)
    moving = (np.array(fronts[:-1]) > x[0]) & (np.array(fronts[1:]) < x[-1])
    assert np.any(moving)
    assert np.mean(speeds[moving]) == pytest.approx(1.6, rel=0.25)
