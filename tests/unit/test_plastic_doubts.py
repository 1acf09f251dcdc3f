"""What is left out of teeth of plastic is told: friction fitted on steel, and the growth of warm teeth."""

from dataclasses import replace
from math import pi, radians

import pytest

from pitchpoint.cases.solids import EXPANSION, ROOM, SolidInUse, fitted_on_steel, grown
from pitchpoint.core.doubts import as_doubt
from pitchpoint.gears.cylindrical.drawing_dimensions import Toothing
from pitchpoint.materials import solids

STEEL = SolidInUse(solids.find("steel"), solids.find("steel").build(), 350.0)
PLASTIC = SolidInUse(solids.find("POM-H"), solids.find("POM-H").build(), 330.0)
ANGLE, MODULE = radians(20.0), 1e-3


def play(teeth: tuple[int, int], growths: tuple[float, float]) -> float:
    """Circumferential backlash of gears that grew evenly, at the distance without backlash before [m]."""
    free = 0.0
    for z, growth in zip(teeth, growths, strict=True):
        radius = 0.5 * MODULE * abs(z)
        gear = Toothing(z, MODULE * (1.0 + growth), ANGLE, 0.0, 0.0)
        free += 2.0 * radius * (pi / (2.0 * abs(z)) - gear.half_thickness_angle(radius))
    return free


@pytest.mark.parametrize("teeth", [(17, 51), (40, 40), (17, 200)])
@pytest.mark.parametrize("used", [(STEEL, PLASTIC), (PLASTIC, PLASTIC)])
def test_growth_takes_the_backlash_of_larger_teeth(
    teeth: tuple[int, int], used: tuple[SolidInUse, SolidInUse]
) -> None:
    growths = tuple(EXPANSION * (one.temperature - ROOM) if one.plastic else 0.0 for one in used)
    (told,) = grown(used, teeth, ANGLE, 0.5 * MODULE * sum(teeth))
    taken = float(str(told).partition("some ")[2].split()[0])
    assert taken == pytest.approx(-1e6 * play(teeth, growths), rel=0.06)  # two digits, first order


def test_what_grows_little_says_nothing() -> None:
    cool = replace(PLASTIC, temperature=ROOM + 1.0)
    assert not grown((STEEL, cool), (17, 51), ANGLE, 34e-3)
    assert not grown((STEEL, STEEL), (17, 51), ANGLE, 34e-3)


def test_a_ring_of_plastic_grows_away() -> None:
    assert not grown((STEEL, PLASTIC), (20, -80), ANGLE, 30e-3)


def test_laws_of_steel_are_told_of_plastic() -> None:
    told = as_doubt(fitted_on_steel(["xu_2007"], [2]))
    assert "gear 2 is plastic" in told and told.about == ("mean_efficiency",)
