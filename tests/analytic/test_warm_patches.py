"""Temperatures of films over a patch: against lines, closed forms, balances of heat and energy, limits."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.constants import pi

from pitchpoint._jax import jax, jnp
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.fields import patch_film
from pitchpoint.lubrication.ehl.patch.heat import TEMPERATURES, contact_heat, warmed_patch
from pitchpoint.lubrication.ehl.patch.layout import problem_on
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, film_near, solve_patch
from pitchpoint.lubrication.ehl.patch.response import polished_warm
from pitchpoint.lubrication.ehl.patch.transient import march_patches
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.lubrication.ehl.strips import WARM_ENOUGH
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials import solids
from pitchpoint.materials.fluid import Fluid
from pitchpoint.results.film_datasets import patch_dataset

MODULUS = 2.26e11
STEEL = Conductor.of(solids.find("steel"))
OIL_CONDUCTS = 0.14
HEAT = Conduction(a=STEEL, b=STEEL, oil_conductivity=OIL_CONDUCTS)
OIL = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8, "shear_law": "ree_eyring_1955"}
FLUID = Fluid(**OIL, viscosity_slope=0.04)
ROUGH = Rough(rq=0.4e-6, modulus=MODULUS)
RADIUS = 0.01
COARSE = {"nodes": 33, "cells": 32}


def speeds(speed: float, slide: float) -> dict[str, float]:
    return {"speed_a": speed * (1.0 + 0.5 * slide), "speed_b": speed * (1.0 - 0.5 * slide)}


def ball(speed: float = 4.0, slide: float = 0.4, ratio: float = 2.0, **more: Any) -> PatchContact:
    given = {"load": 50.0, "radius": RADIUS, "transverse_radius": ratio * RADIUS}
    given |= {"modulus": MODULUS, "fluid": FLUID, "conduction": HEAT, "texture": ROUGH}
    return elliptic_contact(**{**given, **speeds(speed, slide), **more})


def line_load(pressure: float = 0.8e9) -> float:
    return 2.0 * pi * (pressure / MODULUS) ** 2 * MODULUS * RADIUS


def solved(contact: PatchContact, **grid: Any) -> PatchFilms:
    found = solve_patch(contact, **(COARSE | grid))
    assert found.solved, found.ended
    return found


@cache
def sliding() -> PatchFilms:
    return solved(ball())


@pytest.mark.whole
def test_the_middle_of_a_long_line_is_one_without_ends() -> None:
    """In the middle of one that is pressed alike along its length, as bodies end with it at free faces."""
    common = {"radius": RADIUS, "modulus": MODULUS, "fluid": FLUID, "conduction": HEAT}
    common |= speeds(1.0, 0.6)
    contact = finite_line(load=line_load() * 5e-3, length=5e-3, ends="mirrored", **common)
    found = solved(contact, nodes=129)
    film, endless = found.film, solve_lines(LineContact(line_load=line_load(), **common)).film
    assert film.central_film == pytest.approx(float(endless.central_film), rel=0.01)
    assert film.friction == pytest.approx(float(endless.friction), rel=0.01)
    for name in ("power_a", "power_b"):
        power = 5e-3 * float(getattr(endless.heat, name))
        assert getattr(film.heat, name) == pytest.approx(power, rel=0.015)
    # Ahead of the spike, which few nodes show, and away from the ends, where oil leaks.
    near = 0.55 * float(endless.half_width) * np.linspace(-1.0, 1.0, 23)
    for name in ("film", "surface_a", "surface_b"):
        row, beside = getattr(film.heat, name)[16], getattr(endless.heat, name)
        expected = np.interp(near, endless.x, beside)
        found_there = np.interp(near, film.x, row)
        np.testing.assert_allclose(found_there, expected, rtol=0.012)
        assert found_there.max() == pytest.approx(expected.max(), rel=0.01)


@pytest.mark.whole
def test_all_heat_that_is_made_goes_into_the_surfaces() -> None:
    film, ended = sliding().film, sliding().ended
    assert film.asperity_share > 0.004
    heat = film.heat
    into = heat.power_a + heat.power_b
    assert into == pytest.approx(float(film.sliding_power + film.pumping_power), rel=1e-8)
    assert heat.flux_a + heat.flux_b == pytest.approx(heat.heat, rel=1e-8)
    rolled = 2.0 * film.rolling[0] * 4.0
    done = film.sliding_power + rolled + heat.expansion_power
    assert into == pytest.approx(float(done), rel=1e-8)
    assert abs(heat.expansion_power) < 0.05 * into
    assert ended.temperature < WARM_ENOUGH and ended.reynolds < 1e-8
    assert 2 <= ended.turns < 40


@pytest.mark.whole
def test_surfaces_and_film_are_as_warm_as_their_heat_makes_them() -> None:
    """Summed up anew in SI along the motion of the surfaces in one row, and across the film."""
    film, (rows, nodes) = sliding().film, sliding().film.pressure.shape
    heat, row = film.heat, rows // 2 + 3
    x, step = film.x, film.x[1] - film.x[0]
    conducts = OIL_CONDUCTS / film.film
    apart = heat.surface_b - heat.surface_a
    assert heat.flux_a == pytest.approx(0.5 * heat.heat + conducts * apart, rel=1e-6)
    own = ball()
    rubbed = 0.1 * film.asperity_pressure * float(own.speed_a[0] - own.speed_b[0])
    in_film = heat.heat - rubbed
    mean = 0.5 * (heat.surface_a + heat.surface_b) + in_film / (12.0 * conducts)
    assert heat.film == pytest.approx(mean, abs=1e-5 * float(heat.largest_film))
    for flux, rise, speed in (
        (heat.flux_a, heat.surface_a, own.speed_a[0]),
        (heat.flux_b, heat.surface_b, own.speed_b[0]),
    ):
        # Cells of even heat: the integral of 1/sqrt(distance) over each of them.
        ends = np.sqrt(np.maximum(x[:, None] - (x - 0.5 * step), 0.0))
        starts = np.sqrt(np.maximum(x[:, None] - (x + 0.5 * step), 0.0))
        expected = 2.0 * (ends - starts) @ flux[row] / np.sqrt(pi * float(speed))
        assert rise[row] == pytest.approx(expected / float(STEEL.effusivity), rel=1e-9)
    assert nodes == x.size


@pytest.mark.whole
def test_symmetric_contacts_are_symmetric_and_turn_round_with_their_speeds() -> None:
    heat = sliding().film.heat
    back = solved(ball(speed=-4.0)).film.heat
    for name in TEMPERATURES:
        field = getattr(heat, name)
        close = {"rtol": 0.0, "atol": 1e-6 * float(np.max(field))}
        np.testing.assert_allclose(field, field[::-1], **close)
        np.testing.assert_allclose(getattr(back, name), field[:, ::-1], **close)


@pytest.mark.whole
def test_entrainment_along_the_other_axis_turns_the_temperatures() -> None:
    along = sliding().film
    still = {"speed_a": 0.0, "speed_b": 0.0, "across": tuple(speeds(4.0, 0.4).values())}
    other = ball(radius=2.0 * RADIUS, transverse_radius=RADIUS, **still)
    across = solved(other).film
    for name in TEMPERATURES:
        field = getattr(along.heat, name)
        np.testing.assert_allclose(getattr(across.heat, name), field.T, rtol=1e-6, atol=1e-9)
    assert across.heat.power_b == pytest.approx(float(along.heat.power_b), rel=1e-8)


@pytest.mark.whole
def test_rises_are_half_of_those_in_what_conducts_twice_as_well() -> None:
    """Of an oil that temperature does not thin, whose film is nearly that without heat."""
    dull = {"fluid": Fluid(**OIL, viscosity_slope=0.0), "slide": 0.02}
    better = Conductor(
        conductivity=2.0 * STEEL.conductivity, heat_capacity=2.0 * STEEL.heat_capacity
    )
    twice = Conduction(a=better, b=better, oil_conductivity=2.0 * OIL_CONDUCTS)
    once, half = (solved(ball(conduction=one, **dull)) for one in (HEAT, twice))
    largest = float(once.film.heat.largest_film)
    close = {"rtol": 0.0, "atol": 0.005 * largest}
    np.testing.assert_allclose(half.film.heat.film, 0.5 * once.film.heat.film, **close)
    assert half.film.heat.largest_a == pytest.approx(
        0.5 * float(once.film.heat.largest_a), rel=0.01
    )
    cold = solved(ball(conduction=None, **dull)).film
    # Its density falls by 0.07 % for each kelvin.
    assert once.film.central_film == pytest.approx(float(cold.central_film), rel=1e-3 * largest)
    assert cold.heat is None
    assert any("does not thin as it warms" in told for told in once.warnings)


@pytest.mark.whole
def test_without_sliding_there_is_little_heat_and_the_film_is_isothermal() -> None:
    given = {"speed": 0.6, "slide": 0.0}
    warm, cold = (solved(ball(**given, conduction=one)).film for one in (HEAT, None))
    assert warm.heat.largest_film < 0.5
    assert warm.central_film == pytest.approx(float(cold.central_film), rel=0.01)
    assert warm.shear_force[0] == 0.0


@pytest.mark.whole
def test_warm_films_are_thinner_and_rub_less() -> None:
    cold = solved(ball(conduction=None)).film
    warm = sliding().film
    assert warm.heat.largest_film > 20.0
    assert warm.friction < 0.9 * cold.friction
    assert 0.7 * cold.central_film < warm.central_film < cold.central_film


@pytest.mark.whole
def test_a_film_is_the_same_from_one_that_is_like_it() -> None:
    near = solved(ball(speed=5.0))
    found = solved(ball(), start=near)
    np.testing.assert_allclose(found.film.heat.film, sliding().film.heat.film, atol=1e-4)
    assert found.film.central_film == pytest.approx(float(sliding().film.central_film), rel=1e-6)
    assert found.ended.steps < sliding().ended.steps


def changed(by: Any) -> PatchContact:
    """The contact with another load, speed, viscosity, thinning and conduction, by parts of these."""
    load, speed, viscosity, slope, conducts = (1.0 + by[k] for k in range(5))
    own = ball()
    fluid = replace(
        FLUID,
        viscosity=FLUID.viscosity * viscosity,
        viscosity_slope=FLUID.viscosity_slope * slope,
    )
    moves = {"speed_a": own.speed_a * speed, "speed_b": own.speed_b * speed}
    heat = Conduction(a=STEEL, b=STEEL, oil_conductivity=OIL_CONDUCTS * conducts)
    return replace(own, load=own.load * load, fluid=fluid, conduction=heat, **moves)


def figures(film: Any) -> Any:
    forces = film.mean_film, film.shear_force[0], film.rolling[0]
    return jnp.stack([*forces, film.heat.largest_film, film.heat.largest_b, film.heat.power_a])


@pytest.mark.whole
def test_derivatives_of_films_are_those_of_differences() -> None:
    found = sliding()
    near = jax.jit(lambda by: figures(film_near(changed(by), found)))
    exact = np.asarray(jax.jit(jax.jacfwd(near))(jnp.zeros(5)))
    at = jax.jit(lambda by: figures(again(by)))
    step = 1e-4 * np.eye(5)
    differences = np.array([(at(one) - at(-one)) / 2e-4 for one in step]).T
    scale = np.abs(differences).max(axis=1)[:, None]
    np.testing.assert_allclose(exact / scale, differences / scale, atol=1e-5)
    np.testing.assert_allclose(near(np.zeros(5)), figures(found.film), rtol=1e-7)


def again(by: Any) -> Any:
    """Film of a contact nearby on the same grid, by steps from the solution until they stay."""
    found, contact = sliding(), changed(by)
    heats, (rows, nodes) = contact_heat(contact), found.pressure.shape
    cold, rise = problem_on(contact, found.layout, nodes, rows, rows), jnp.asarray(found.rise)
    solution = warmed_patch(cold, rise), jnp.asarray(found.pressure), jnp.asarray(found.level)
    problem, pressure, level = jax.lax.fori_loop(
        0, 4, lambda _, one: polished_warm(heats, *one), solution
    )
    lies = found.layout, problem, pressure, level, jnp.asarray(found.held), found.response
    return patch_film(contact, *lies)


@pytest.mark.whole
def test_films_that_were_solved_without_heat_have_no_derivatives_with_it() -> None:
    cold = replace(sliding(), rise=None)
    with pytest.raises(InputError, match="were solved without heat, and the contact has") as caught:
        film_near(ball(), cold)
    assert caught.value.key == "films"


@pytest.mark.whole
def test_datasets_have_temperatures_with_units() -> None:
    data = patch_dataset(sliding())
    np.testing.assert_array_equal(data["heat_film"], sliding().film.heat.film)
    assert data["heat_film"].dims == ("y", "x") and data["heat_film"].attrs["units"] == "K"
    assert data["heat_power_a"].attrs["units"] == "W" and data["heat_power_a"].dims == ()
    assert "heat_film" not in patch_dataset(
        replace(sliding(), film=replace(sliding().film, heat=None))
    )


@pytest.mark.whole
def test_what_has_no_steady_heat_says_so_and_shows_no_numbers() -> None:
    found = solve_patch(ball(speed=0.0, approach=1e-3), **COARSE)
    assert found.ended.code == Code.NO_STEADY_HEAT
    assert np.isnan(found.film.heat.film).all() and np.isnan(found.film.central_film)


def test_what_is_not_solved_with_heat_is_told_in_one_sentence() -> None:
    with pytest.raises(InputError, match="along both heat passes it obliquely") as caught:
        solve_patch(ball(across=(1.0, 1.0)), **COARSE)
    assert caught.value.key == "across"
    with pytest.raises(InputError, match="films over time are isothermal") as caught:
        next(iter(march_patches([ball(), ball()], [0.0, 1e-4], **COARSE)))
    assert caught.value.key == "conduction"
    poor = Conductor(conductivity=-1.0, heat_capacity=3.6e6)
    wrong = Conduction(a=STEEL, b=poor, oil_conductivity=OIL_CONDUCTS)
    with pytest.raises(InputError, match="a conductivity of member 1 of -1 W/m/K") as caught:
        solve_patch(ball(conduction=wrong), **COARSE)
    assert caught.value.key == "conductivity_1"
    several = Conduction(a=STEEL, b=STEEL, oil_conductivity=np.array([0.14, 0.15]))
    with pytest.raises(InputError, match="one contact has one oil_conductivity, not an array"):
        solve_patch(ball(conduction=several), **COARSE)
