"""Finite contacts over time: against steady films, closed forms, conservation and the motion of waves."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import pytest

from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.layout import laid_out
from pitchpoint.lubrication.ehl.patch.patch_films import solve_patch
from pitchpoint.lubrication.ehl.patch.solve import solve
from pitchpoint.lubrication.ehl.patch.transient import PatchMoment, march_patches
from pitchpoint.materials.fluid import Fluid
from pitchpoint.results.film_datasets import march_dataset

MODULUS = 2.26e11
OIL = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="newtonian")
EYRING = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="ree_eyring_1955")
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


@pytest.mark.whole
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


@pytest.mark.whole
def test_plates_are_squeezed_together_as_reynolds_says():
    # h^3 = 12 eta V G/F, d(1/h^2)/dt = F/(6 eta G), with G the integral of the solution of Poisson's equation
    # on the rectangle: the series of a twisted bar (Timoshenko, Goodier, Theory of Elasticity, art. 109).
    moments, film, rate = squeezed(32)
    films = np.array([one.film.central_film for one in moments])
    times = np.array([one.time for one in moments])
    assert films[0] == pytest.approx(film, rel=5e-3)
    assert np.allclose(films, (1.0 / film**2 + rate * times) ** -0.5, rtol=1e-2)


@pytest.mark.whole
def test_steps_of_time_are_of_second_order():
    films = [float(squeezed(count)[0][-1].film.central_film) for count in (8, 16, 32)]
    order = np.log2((films[1] - films[0]) / (films[2] - films[1]))
    assert 1.7 < order < 2.4


@pytest.mark.whole
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
    found = solve(contact, *GRID.values(), None, layout)
    problem, state = found.problem, found.state
    return float(np.min(problem.gap(state.pressure, state.level)) * problem.flow.height)


@pytest.mark.whole
def test_slow_changes_find_the_steady_film_of_every_time():
    contacts, times = swelling(6, period=4000.0 * PASSING)
    last = marched(contacts, times)[-1]
    exact = steady_gap(contacts[-1], last)
    assert float(last.film.minimum_film) == pytest.approx(exact, rel=1e-3)
    contacts, times = swelling(6, period=2.0 * PASSING)
    last = marched(contacts, times)[-1]
    assert abs(float(last.film.minimum_film) / steady_gap(contacts[-1], last) - 1.0) > 0.02


@pytest.mark.whole
def test_steps_by_error_keep_to_it():
    contacts, times = swelling(2)
    given = [contacts[0], contacts[-1]], times[[0, -1]]
    ends = [marched(*given, steps="by_error", tolerance=one)[-1] for one in (1e-2, 1e-3, 1e-4)]
    counts = [one.time_steps for one in ends]
    films = [float(one.film.mean_film) for one in ends]
    assert counts[0] < counts[1] < counts[2]
    off = [abs(one / films[2] - 1.0) for one in films[:2]]
    assert off[0] < 1e-2
    assert off[1] < 1e-3


def test_a_march_goes_on_from_any_of_its_moments():
    contacts, times = swelling(4)
    whole = marched(contacts, times)
    rest = list(march_patches(contacts, times, after=whole[2], **GRID))
    assert [one.time for one in rest] == [one.time for one in whole[3:]]
    assert np.array_equal(rest[-1].film.gap, whole[-1].film.gap)


# ---- waves that pass


WAVES, AHEAD = 0.6, 0.5
"""Length of waves over the half-width, and speed of the surface that has them over the mean speed."""


@cache
def passing() -> tuple[np.ndarray, np.ndarray, float]:
    """Film in the middle of a line while waves pass: the part that changes with their frequency, over x."""
    given = {"load": 300.0, "length": 1e-3, "radius": 0.01, "modulus": MODULUS, "fluid": OIL}
    speeds = {"speed_a": AHEAD, "speed_b": 2.0 - AHEAD, "ends": "mirrored"}
    half_width = laid_out(finite_line(**given, **speeds), 32).half_width
    places = np.linspace(0.0, WAVES * half_width, 17)
    form = np.cos(2.0 * np.pi * np.linspace(0.0, 1.0, 17))
    heights = HeightMap(
        x=places,
        y=np.array([-1.0, 1.0]),
        heights=2e-8 * np.stack([form] * 2),
        member=0,
        periodic=True,
    )
    period, count = WAVES * half_width / AHEAD, 12
    times = np.arange(4 * count + 1) * period / count
    contact = finite_line(**given, **speeds, heights=heights)
    moments = marched([contact] * times.size, times, nodes=65, cells=32)
    rows = np.stack([one.film.gap[16] for one in moments[-count:]])
    turns = np.exp(2j * np.pi * times[-count:, None] / period)
    x = moments[0].film.x
    flat = np.abs(x) < 0.7 * half_width
    return x[flat], np.mean(rows * turns, axis=0)[flat], 2.0 * np.pi / period


def left_of(*speeds: float) -> float:
    """What waves of these speeds leave of the film that changes."""
    x, found, frequency = passing()
    waves = np.stack([np.exp(1j * frequency / one * x) for one in speeds], axis=1)
    amplitudes = np.linalg.lstsq(waves, found)[0]
    return float(np.linalg.norm(found - waves @ amplitudes) / np.linalg.norm(found))


@pytest.mark.whole
def test_what_waves_do_at_the_inlet_passes_with_the_mean_speed():
    # Where oil is so thick that pressure moves none of it, d(rho h)/dt + u d(rho h)/dx = 0: what waves do to
    # the film where oil comes in passes with the mean speed u, whatever surface they are on.
    assert left_of(AHEAD) > 0.8
    assert left_of(1.0) < 0.4
    speeds = np.linspace(0.4, 2.0, 161)
    best = speeds[np.argmin([left_of(one) for one in speeds])]
    assert best == pytest.approx(1.0, rel=0.1)


# ---- what is told and refused

PLACES = np.linspace(-1e-3, 1e-3, 21)
LEVEL = HeightMap(x=PLACES, y=PLACES, heights=np.zeros((21, 21)), member=0)


def test_a_dataset_has_every_field_at_every_time():
    contacts, times = swelling(4)
    data = march_dataset(marched(contacts, times))
    assert data["pressure"].dims == ("time", "y", "x")
    assert data["shear_force"].dims == ("time", "direction")
    assert np.array_equal(data["time"], times)
    assert data["time"].attrs["units"] == "s"
    bare = {name for name, one in data.variables.items() if "units" not in one.attrs}
    assert bare == {"direction", "end"}
    loads = data["pressure"].sum(("y", "x")) * np.diff(data["x"])[0] * np.diff(data["y"])[0]
    assert np.allclose(loads, [float(one.load) for one in contacts], rtol=1e-6)


@pytest.mark.whole
def test_a_march_ends_with_a_film_that_is_not_found():
    still = ball(speed=0.0)
    found = list(march_patches([still, still], [0.0, 1e-3], **GRID))
    assert [one.ended.code for one in found] == [Code.NO_FILM]
    assert np.isnan(found[0].film.central_film)


@pytest.mark.parametrize(
    ("contacts", "times", "more", "told"),
    [
        ([ball(), ball()], [0.0], {}, "2 contacts at times of the shape"),
        ([ball(), ball()], [0.0, 0.0], {}, "the times of a march have to rise"),
        ([ball(), ball(approach=1e-3)], [0.0, 1.0], {}, "approach each other as the load asks"),
        ([ball(), ball(speed=-1.0)], [0.0, 1.0], {}, "the entrainment turns round"),
        ([ball(), ball(across=(1.0, 0.0), load=-1.0)], [0.0, 1.0], {}, "a load of -1 N"),
        ([ball(), ball(fluid=EYRING)], [0.0, 1.0], {}, "contacts of a march are of one kind"),
        ([ball(heights=LEVEL)] * 2, [0.0, 1.0], {}, "a height map from 949 to 951 mm along x"),
        ([ball(), ball()], [0.0, 1.0], {"nodes": 40}, "40 nodes: their number is a power of two"),
        ([ball(), ball()], [0.0, 1.0], {"steps": "few"}, 'there are no steps "few"'),
    ],
)
def test_courses_that_there_are_not_are_refused(
    contacts: list[PatchContact], times: list[float], more: dict[str, Any], told: str
):
    with pytest.raises(InputError, match=told):
        march_patches(contacts, times, **{**GRID, **more})
