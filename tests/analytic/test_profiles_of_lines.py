"""Films of line contacts between surfaces with a profile: waves under pressure in closed form, refusals."""

import dataclasses

import numpy as np
import pytest

from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.profiles import check_profiles
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.materials.fluid import Fluid

MODULUS, RADIUS, PRESSURE, SPEED = 2.26e11, 0.02, 0.6e9, 0.9
VISCOSITY, ALPHA = 0.02, 1.5e-8
OIL = Fluid(viscosity=VISCOSITY, pressure_viscosity=ALPHA, shear_law="newtonian")
HALF_WIDTH = 4.0 * RADIUS * PRESSURE / MODULUS
WAVE = 0.5 * HALF_WIDTH
NUMBER = 2.0 * np.pi / WAVE
HEIGHT = 2e-9


def line(heights: tuple[HeightMap, ...] = (), sense: float = 1.0) -> LineContact:
    return LineContact(
        line_load=2.0 * np.pi * (PRESSURE / MODULUS) ** 2 * MODULUS * RADIUS,
        radius=RADIUS,
        modulus=MODULUS,
        speed_a=sense * 1.1 * SPEED,
        speed_b=sense * 0.9 * SPEED,
        fluid=OIL,
        heights=heights,
    )


def waves(
    height: float = HEIGHT, shift: float = 0.0, length: float = WAVE, reach: float = 18.0
) -> HeightMap:
    x = np.linspace(-reach, reach, 2305) * HALF_WIDTH
    heights = height * np.cos(2.0 * np.pi * x / length - shift)
    return HeightMap(x=x, y=np.array([-1.0, 1.0]), heights=np.tile(heights, (2, 1)))


@pytest.fixture(scope="module")
def even() -> Films:
    return solve_lines(line())


@pytest.fixture(scope="module")
def wavy() -> Films:
    return solve_lines(line((waves(),)))


def rippled(wavy: Films, even: Films, name: str) -> complex:
    """What waves add to a field in the inner half of the contact, over their height, of exp(i k x)."""
    x = np.asarray(even.film.x)
    inside = np.abs(x) < 0.5 * HALF_WIDTH
    x, weight = x[inside], np.sqrt(np.gradient(x))[inside, None]
    added = (np.asarray(getattr(wavy.film, name)) - getattr(even.film, name))[inside] / HEIGHT
    shapes = np.stack([np.cos(NUMBER * x), np.sin(NUMBER * x), np.ones_like(x), x / HALF_WIDTH], 1)
    along, beside, *_ = np.linalg.lstsq(shapes * weight, added * weight[:, 0])[0]
    return complex(along, -beside)


def test_waves_are_pressed_flat_as_far_as_oil_yields(wavy: Films, even: Films) -> None:
    """Small waves at rest under uniform pressure, film and viscosity.

    Half spaces yield by 4 p/(E' k); what the oil of a cell gains by density and gap, flow by pressure takes
    away: i k u (p h dln(rho)/dp + dh) + h^3/(12 eta) k^2 p = 0.
    """
    film = float(even.film.central_film)
    yields = 4.0 / (MODULUS * NUMBER)
    thinner = (
        film * 0.6e-9 / ((1.0 + 1.7e-9 * PRESSURE) * (1.0 + 2.3e-9 * PRESSURE))
    )  # Dowson, Higginson
    thick = np.log(VISCOSITY) + 9.67  # Roelands
    viscosity = VISCOSITY * np.exp(
        thick * ((1.0 + PRESSURE / 1.96e8) ** (ALPHA * 1.96e8 / thick) - 1.0)
    )
    passes = film**3 * NUMBER / (12.0 * viscosity * SPEED)
    pressure = 1.0 / (yields + thinner - 1j * passes)
    assert even.solved and wavy.solved
    assert abs(rippled(wavy, even, "pressure") - pressure) < 0.03 * abs(pressure)
    left = -1.0 + yields * pressure
    assert abs(rippled(wavy, even, "gap") - left) < 0.015 and abs(left) < 0.08


def test_twice_the_height_is_twice_the_ripple(wavy: Films, even: Films) -> None:
    higher = solve_lines(line((waves(2.0 * HEIGHT),)))
    for name in ("pressure", "gap"):
        once, twice = rippled(wavy, even, name), rippled(higher, even, name)
        assert abs(twice - 2.0 * once) < 0.01 * abs(once)


def test_a_profile_lies_where_it_is_whichever_way_surfaces_run() -> None:
    ahead = solve_lines(line((waves(shift=0.7),)))
    back = solve_lines(line((waves(shift=-0.7),), sense=-1.0))
    for name in ("pressure", "gap"):
        one, other = getattr(ahead.film, name), getattr(back.film, name)
        np.testing.assert_allclose(one, other[::-1], rtol=1e-6, atol=1e-6 * np.ptp(one))


def test_waves_finer_than_the_grid_are_refused_with_nodes_that_show_them() -> None:
    fine = line((waves(length=0.1 * HALF_WIDTH),))
    with pytest.raises(InputError, match=r"take \d+ nodes") as caught:
        solve_lines(fine, nodes=65)
    assert "65 nodes show Rq" in caught.value.message and caught.value.key == "heights"
    check_profiles(fine, int(caught.value.message.split()[-2]))
    with pytest.raises(InputError, match="no grid up to 1025 nodes"):
        check_profiles(line((waves(length=0.006 * HALF_WIDTH, reach=1.2),)), 65)


def test_heights_that_are_no_profile_at_rest_are_refused() -> None:
    flat = waves()
    moving = dataclasses.replace(flat, member=0)
    uneven = dataclasses.replace(flat, heights=np.asarray(flat.heights) * np.array([[1.0], [2.0]]))
    short = dataclasses.replace(flat, x=0.01 * np.asarray(flat.x))
    for one, words in ((moving, "move with"), (uneven, "along the line"), (short, "cover")):
        with pytest.raises(InputError, match=words):
            solve_lines(line((one,)))


def test_a_case_gives_lines_profiles_along_the_speeds_alone() -> None:
    given = {"file": "a.csv", "step_along": "1 um"}
    assert FilmTable.model_validate({"solver": "line", "heights": {"both": given}}).heights
    with pytest.raises(ValueError, match="profiles along the surface speeds"):
        FilmTable.model_validate(
            {"solver": "line", "heights": {"both": given | {"direction": "across"}}}
        )
