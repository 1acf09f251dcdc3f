"""Solver of contacts of finite length: its order, starts from other films, and what a process keeps."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.constants import pi

from pitchpoint.contact.end_profiles import crowned
from pitchpoint.core import programs
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch import newton
from pitchpoint.lubrication.ehl.patch import solve as solving
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.newton import _hopeless
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, solve_patch
from pitchpoint.lubrication.ehl.patch.transient import march_patches
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.materials.fluid import Fluid

MODULUS = 2.26e11
OIL = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_law="newtonian")


def line(speed: float = 1.0, radius: float = 0.01, more: float = 1.0) -> PatchContact:
    """A crowned line of 20 half-widths at 1 GPa, with so many times the load."""
    line_load = 2.0 * pi * (1e9 / MODULUS) ** 2 * MODULUS * radius
    length = 20.0 * np.sqrt(8.0 * line_load * radius / (pi * MODULUS))
    return finite_line(
        load=more * line_load * length,
        length=length,
        radius=radius,
        modulus=MODULUS,
        speed_a=speed,
        speed_b=speed,
        fluid=OIL,
        profile=crowned(width=length, radius=length**2 / (8.0 * 5e-6)),
    )


def ball(load: float = 30.0, speed: float = 2.0, ratio: float = 1.0) -> PatchContact:
    radius, given = 0.01, {"modulus": MODULUS, "fluid": OIL, "speed_a": speed, "speed_b": speed}
    return elliptic_contact(load=load, radius=radius, transverse_radius=ratio * radius, **given)


def on(contact: PatchContact, nodes: int, start: PatchFilms | None = None) -> PatchFilms:
    found = solve_patch(contact, nodes=nodes, cells=nodes - 1, start=start)
    assert found.solved, found.ended
    return found


@pytest.mark.whole
@pytest.mark.parametrize(
    ("contact", "earlier", "nodes"),
    [
        (line(1.3), line(), 65),
        (line(1.0, 0.012, 1.1), line(), 65),
        (line(1.0), line(), 33),
        (ball(40.0, 2.5, 1.2), ball(), 65),
    ],
    ids=["faster", "heavier and flatter", "from a coarser grid", "another ellipse"],
)
def test_a_start_from_another_film_finds_the_same_film_sooner(
    contact: PatchContact, earlier: PatchContact, nodes: int
):
    cold, warm = on(contact, 65), on(contact, 65, on(earlier, nodes))
    assert warm.ended.steps < cold.ended.steps
    assert np.allclose(warm.film.gap, cold.film.gap, rtol=1e-6)
    assert np.allclose(warm.film.pressure, cold.film.pressure, atol=1e-6 * cold.film.hertz_pressure)


@pytest.mark.whole
def test_films_that_were_not_solved_are_no_start():
    still = solve_patch(line(0.0), nodes=33, cells=32)
    assert on(line(), 33, still).ended.steps == on(line(), 33).ended.steps


@pytest.mark.whole
def test_a_start_that_leads_nowhere_is_left(monkeypatch: pytest.MonkeyPatch):
    cold, near = on(line(), 33), on(line(1.3), 33)

    def nowhere(*given):
        pressure, level = started(*given)
        return np.nan * pressure, level

    started = solving.warm_start
    monkeypatch.setattr(solving, "warm_start", nowhere)
    assert np.array_equal(on(line(), 33, near).film.gap, cold.film.gap)


@pytest.mark.whole
def test_symmetric_contacts_have_symmetric_films():
    for contact in (line(), ball()):
        film = on(contact, 65).film
        assert np.allclose(film.gap, film.gap[::-1], rtol=1e-7)
        assert np.allclose(film.pressure, film.pressure[::-1], atol=1e-6 * film.hertz_pressure)


@pytest.mark.whole
def test_the_tips_of_an_ellipse_hold_their_film():
    # Emptied ones, as by an arithmetic mean of the conductances across, have a tenth, and are no solution.
    oil = Fluid(viscosity=0.013, pressure_viscosity=2e-8)
    contact = elliptic_contact(
        load=165.0,
        radius=4.88e-3,
        transverse_radius=27.2e-3,
        modulus=MODULUS,
        fluid=oil,
        speed_a=0.0707,
        speed_b=0.0636,
    )
    coarse, fine = (on(contact, nodes).film for nodes in (65, 129))
    assert abs(float(fine.minimum_place[1])) > 0.8 * fine.half_width * 2.98
    least, finer = (float(one.minimum_film / one.central_film) for one in (coarse, fine))
    assert least == pytest.approx(finer, rel=0.3)
    assert finer > 0.25


@pytest.mark.whole
@pytest.mark.parametrize("made", [line, ball])
def test_rows_that_are_images_of_each_other_are_inverted_once(
    made: Callable[[], PatchContact], monkeypatch: pytest.MonkeyPatch
):
    half = on(made(), 33)
    monkeypatch.setattr(newton, "_even", lambda problem: False)
    every = on(made(), 33)
    assert every.ended.steps == half.ended.steps
    assert np.allclose(half.film.gap, every.film.gap, rtol=1e-6)


@pytest.mark.whole
def test_another_ellipse_needs_no_other_program():
    on(ball(), 33)
    kept = programs._LOADED["programs"]
    on(ball(35.0, 1.7, 1.4), 33)
    assert programs._LOADED["programs"] == kept


def test_attempts_that_do_not_fall_are_hopeless():
    assert _hopeless([1.0] * 20)
    assert not _hopeless([0.9**step for step in range(20)])
    assert not _hopeless([1.0] * 10)


@pytest.mark.whole
def test_thin_films_have_the_film_of_an_infinite_line():
    contact = line(0.012)
    found = on(contact, 129)
    assert -found.film.x[0] < 2.0 * found.film.half_width
    row = found.film.pressure.shape[0] // 2
    load = float(np.sum(found.film.pressure[row]) * (found.film.x[1] - found.film.x[0]))
    given = {"line_load": load, "radius": 0.01, "modulus": MODULUS, "fluid": OIL}
    infinite = solve_lines(LineContact(**given, speed_a=0.012, speed_b=0.012), nodes=513).film
    assert found.film.central_film == pytest.approx(float(infinite.central_film), rel=0.02)


@pytest.mark.whole
def test_a_thick_film_between_balls_leaks_as_that_of_rigid_ones():
    """Of rigid balls h = 128 (U/W)^2 (.131 atan(1/2) + 1.683)^2 (3/5)^2 R; its grid keeps a part away."""
    oil = Fluid(viscosity=0.05, pressure_viscosity=2e-8, shear_law="newtonian")
    given = {"load": 1.0, "radius": 0.01, "transverse_radius": 0.01, "modulus": MODULUS}
    found = solve_patch(
        elliptic_contact(**given, fluid=oil, speed_a=3.0, speed_b=3.0), nodes=33, cells=32
    )
    rigid = 128.0 * (0.05 * 3.0 * 0.01 * (0.131 * np.arctan(0.5) + 1.683) * 0.6) ** 2 * 0.01
    assert 0.75 * rigid < float(found.film.minimum_film) < rigid
    assert any("up to 20 % too thin" in told for told in found.warnings)


def test_oil_begins_ahead_of_a_contact():
    given = {"load": 30.0, "radius": 0.01, "transverse_radius": 0.01, "modulus": MODULUS}
    given |= {"fluid": OIL, "speed_a": 1.0, "speed_b": 1.0}
    with pytest.raises(InputError, match="a distance at which oil begins"):
        solve_patch(elliptic_contact(**given, inlet=-1e-3), nodes=33, cells=32)


def test_a_march_by_error_has_a_tolerance():
    with pytest.raises(InputError, match="it must be positive"):
        march_patches([ball(), ball()], [0.0, 1e-3], steps="by_error", tolerance=-1.0, nodes=33)
