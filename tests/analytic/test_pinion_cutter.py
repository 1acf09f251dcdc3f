"""Roots of rings by a pinion cutter: against the cutter rolled numerically, and as KISSsoft prints them."""

from math import pi, radians

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.optimize import brentq

from pitchpoint.gears.pinion_cutter import PinionCutting
from pitchpoint.strength.root import pinion_cut_section


def inv(angle: float) -> float:
    return float(np.tan(angle) - angle)


class Cutter:
    """A spur cutter in a ring, in modules: all from ISO 21771, with no word of where its corners cut."""

    def __init__(
        self, ring: int, teeth: int, shifts: tuple[float, float], depth: float, corner: float
    ) -> None:
        self.ring, self.teeth, self.corner = ring, teeth, corner
        angle = radians(20.0)
        slope = 2.0 * np.tan(angle)
        value = inv(angle) - slope * sum(shifts) / (ring - teeth)
        self.working = brentq(lambda a: inv(a) - value, 1e-6, 1.5)
        self.base = teeth / 2.0 * np.cos(angle)
        self.distance = (ring - teeth) / 2.0 * np.cos(angle) / np.cos(self.working)
        self.tip = ring / 2.0 + depth - shifts[0] - self.distance
        self.half = (pi / 2.0 + slope * shifts[1]) / teeth + inv(angle)

    @property
    def cutting(self) -> PinionCutting:
        return PinionCutting(
            base_radius=np.asarray(self.base),
            tip_radius=np.asarray(self.tip),
            rounding=np.asarray(self.corner),
            base_half_angle=np.asarray(self.half),
            working_pressure_angle=np.asarray(self.working),
            distance=np.asarray(self.distance),
            ratio=np.asarray(self.teeth / self.ring),
            half_pitch=np.asarray(pi / self.ring),
        )

    def outline(self) -> np.ndarray:
        """One tooth of the cutter as complex numbers, its middle along the real axis."""
        centre = np.sqrt((self.tip - self.corner) ** 2 - self.base**2)
        roll = np.linspace(0.0, centre + self.corner, 900)
        at = self.half - roll / self.base
        flank = (self.base + 1j * roll) * np.exp(1j * at)
        middle = (self.base + 1j * centre) * np.exp(1j * at[-1])
        turn = np.linspace(np.angle(middle), at[-1] + pi / 2.0, 900)
        side = np.concatenate([flank, middle + self.corner * np.exp(1j * turn[::-1])])
        land = self.tip * np.exp(1j * np.linspace(np.angle(middle), 0.0, 50))
        half = np.concatenate([side, land])
        return np.concatenate([half, half[::-1].conj()])

    def swept(self, angles: np.ndarray) -> np.ndarray:
        """Outermost radius that the rolling tooth reaches in the ring, at angles from the space's middle."""
        tooth, found = self.outline(), np.zeros(len(angles))
        for turn in np.linspace(-1.2, 1.2, 1601) * pi / self.teeth * 2.0:
            place = (self.distance + tooth * np.exp(1j * turn)) * np.exp(
                -1j * turn * self.teeth / self.ring
            )
            order = np.argsort(np.angle(place))
            reached = np.interp(
                angles, np.angle(place)[order], np.abs(place)[order], left=0.0, right=0.0
            )
            found = np.maximum(found, reached)
        return found


CUTTERS = (
    Cutter(93, 30, (0.1171, 0.0), 1.25, 0.30),
    Cutter(60, 20, (-0.2, 0.1), 1.25, 0.20),
    Cutter(120, 25, (0.3, -0.1), 1.2, 0.35),
)


@jax.jit
def _roots(cutting: PinionCutting) -> tuple[jax.Array, jax.Array, jax.Array]:
    fillet = cutting.fillet(jnp.linspace(0.0, 1.0, 41))
    return fillet, cutting.tangent(pi / 3.0), cutting.form_roll_length


@pytest.mark.parametrize("cutter", CUTTERS, ids=lambda one: f"{one.teeth} in {one.ring}")
def test_the_fillet_is_the_envelope_of_the_rolling_cutter(cutter: Cutter) -> None:
    (radius, from_tooth), section, _ = (np.asarray(one) for one in _roots(cutter.cutting))
    swept = cutter.swept(pi / cutter.ring - from_tooth)
    np.testing.assert_allclose(swept, radius, atol=2e-5)  # modules
    # Beside it the cutter reaches elsewhere: a fillet 0.02 modules off would be seen.
    assert np.abs(cutter.swept(pi / cutter.ring - from_tooth * 1.02) - radius).max() > 1e-3
    # Section: on the fillet, where its slope is 60 degrees, with the radius of the circle through it.
    x, y = radius * np.sin(from_tooth), radius * np.cos(from_tooth)
    slope = np.arctan2(-np.gradient(x), -np.gradient(y))
    order = np.argsort(slope)
    at = np.interp(pi / 3.0, slope[order], np.arange(41.0)[order])
    assert section[0] == pytest.approx(np.interp(at, np.arange(41.0), x), rel=1e-4)
    assert section[1] == pytest.approx(np.interp(at, np.arange(41.0), y), rel=1e-5)
    way = np.hypot(np.gradient(x), np.gradient(y)) / np.abs(np.gradient(slope))
    assert section[2] == pytest.approx(np.interp(at, np.arange(41.0), way), rel=2e-2)


def test_the_form_circle_is_that_of_kisssoft() -> None:
    """Planet and ring 36/-93 of module 21 mm by KISSsoft 03/2017: d_Ff 1987.879 mm of the ring."""
    base, roll = 93.0 / 2.0 * np.cos(radians(20.0)), float(_roots(CUTTERS[0].cutting)[2])
    form = 42.0 * np.hypot(base, roll)
    assert form == pytest.approx(1987.879, abs=2e-3)


def test_the_section_of_2006_is_that_of_kisssoft() -> None:
    """The same ring: s_Fn 56.76 mm, rho_F 8.78 mm, section on a diameter of 1998.168 mm."""
    section = jax.jit(pinion_cut_section)(
        virtual_teeth=93.0,
        module=21.0,
        pressure_angle=radians(20.0),
        dedendum=1.25,
        tip_radius=0.3,
        generating_shift=0.1171,
        cutter_teeth=30.0,
        cutter_shift=0.0,
    )
    assert float(section.chord) == pytest.approx(56.76, abs=5e-3)
    assert float(section.fillet_radius) == pytest.approx(8.78, abs=5e-3)
    across, along = float(section.chord) / 2.0, float(section.distance)
    assert 2.0 * np.hypot(across, along) == pytest.approx(1998.168, abs=1e-2)
