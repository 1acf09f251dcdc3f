"""Torsional stiffness of spur pairs by a second road: from the rack that cuts teeth to the wind-up."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from pitchpoint.analyses.torsion import torsion_part
from pitchpoint.cases.variant import Variant

YOUNG, POISSON, ALPHA, RIM_RATIO = 206e9, 0.3, np.deg2rad(20.0), 1.0 / 0.3
SAINSOT = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)


def involute(angle: Any) -> Any:
    return np.tan(angle) - angle


@dataclass
class Tooth:
    """Half of a tooth as a rack with corners of 0.38 modules cuts it, in polygons; lengths in metres."""

    teeth: int
    module: float
    shift: float
    tip: float

    def __post_init__(self) -> None:
        pitch = self.teeth * self.module / 2.0
        self.base = pitch * np.cos(ALPHA)
        corner = 0.38 * self.module
        low = pitch + (self.shift - 1.25) * self.module + corner  # height of the corner's centre
        aside = np.pi * self.module / 4.0 - (pitch + self.shift * self.module - low) * np.tan(ALPHA)
        aside -= corner / np.cos(ALPHA)
        slant = np.linspace(np.pi / 2.0, ALPHA, 2001)  # of the normal, which passes the pitch point
        rolled = (pitch - low) / np.tan(slant) - aside
        x, y = rolled + aside + corner * np.cos(slant), low - corner * np.sin(slant)
        half = np.pi / self.teeth - np.arctan2(x, y) + rolled / pitch
        self.root_radius, self.root_half_angle = np.hypot(x, y)[0], half[0]
        fillet = np.hypot(x, y) * np.array([np.sin(half), np.cos(half)])
        start = np.sqrt(max(np.hypot(x, y)[-1] ** 2 - self.base**2, 0.0))
        self.roll = np.linspace(start, np.sqrt(self.tip**2 - self.base**2), 2001)
        pressure = np.arctan2(self.roll, self.base)
        half = (np.pi / 2.0 + 2.0 * self.shift * np.tan(ALPHA)) / self.teeth
        half = half + involute(ALPHA) - involute(pressure)
        flank = np.hypot(self.base, self.roll) * np.array([np.sin(half), np.cos(half)])
        self.flank, self.angle = flank, pressure - half
        self.x, self.y = np.concatenate([fillet, flank[:, 1:]], axis=1)

    def yields(self, roll: float) -> tuple[float, float]:
        """Compliance of beam and body times E and width, and depth from the flank to the axis [m]."""
        thick, high, angle = (np.interp(roll, self.roll, one) for one in (*self.flank, self.angle))
        below = self.y < high
        x, y = np.append(self.x[below], thick), np.append(self.y[below], high)
        cosine, sine = np.cos(angle), np.sin(angle)
        moment = (high - y) * cosine - thick * sine
        direct = 2.4 * (1.0 + POISSON) * cosine**2 + sine**2
        beam = np.trapezoid(12.0 * moment**2 / (2.0 * x) ** 3 + direct / (2.0 * x), y)
        angle_at_root, hub = self.root_half_angle, RIM_RATIO
        terms = [angle_at_root**-2, hub**2, hub / angle_at_root, 1.0 / angle_at_root, hub, 1.0]
        bending, coupling, sinking, shear = SAINSOT @ np.array(terms)
        arm = (high - thick * np.tan(angle) - self.y[0]) / (2.0 * angle_at_root * self.root_radius)
        body = bending * arm**2 + coupling * arm + sinking * (1.0 + shear * np.tan(angle) ** 2)
        return float(beam + cosine**2 * body), float(thick / cosine)


def by_the_second_road(pair: tuple[Tooth, Tooth], width: float, torque: float) -> np.ndarray:
    """Torque over mean wind-up, slope of that curve, mean of the slopes over the phases [N m/rad]."""
    first, second = pair
    shift, teeth = first.shift + second.shift, first.teeth + second.teeth
    wanted = involute(ALPHA) + 2.0 * shift / teeth * np.tan(ALPHA)
    length = (first.base + second.base) * np.tan(brentq(lambda a: involute(a) - wanted, 0.05, 1.0))
    start, end = length - second.roll[-1], first.roll[-1]
    path = np.linspace(start, end, 201)
    each = np.array([[*first.yields(s), *second.yields(length - s)] for s in path])
    solid = (1.0 - POISSON**2) / YOUNG

    def deflection(place: float, load: float) -> float:
        """Of both teeth, and of their contact by Weber and Banaschek's logarithm."""
        bent, depth, other, deep = (np.interp(place, path, column) for column in each.T)
        half = np.sqrt(8.0 / np.pi * load * place * (length - place) / length * solid)
        pressed = np.log(4.0 * depth * deep / half**2) - POISSON / (1.0 - POISSON)
        return float(load * ((bent + other) / YOUNG + 2.0 / np.pi * solid * pressed))

    step, line_load = np.pi * first.module * np.cos(ALPHA), torque / second.base / width
    loads = np.array([0.999, 1.0, 1.001]) * line_load
    # Gauss's phases on either side of the one at which a pair leaves, beyond which another carries alone.
    unit, part = np.polynomial.legendre.leggauss(8)
    leaves = (end - start) / step % 1.0
    phases = np.concatenate(
        [(1.0 + unit) / 2.0 * leaves, 1.0 - (1.0 + unit) / 2.0 * (1.0 - leaves)]
    )
    weight = np.concatenate([part * leaves, part * (1.0 - leaves)]) / 2.0
    turned = np.empty((phases.size, loads.size))
    for k, phase in enumerate(phases):
        places = [s for s in start + (phase + np.arange(3)) * step if s <= end]
        for j, load in enumerate(loads):

            def left(approach: float) -> float:
                carried = (
                    brentq(lambda w: deflection(s, w) - approach, 1e-6, 50.0 * line_load)  # noqa: B023
                    for s in places  # noqa: B023
                )
                return sum(carried) - load  # noqa: B023

            most = max(deflection(s, 1.01 * line_load) for s in places)
            turned[k, j] = brentq(left, 1e-7, most, rtol=1e-12) / second.base
    change, mean = 2e-3 * torque, weight @ turned
    slopes = change / (turned[:, 2] - turned[:, 0])
    return np.array([torque / mean[1], change / (mean[2] - mean[0]), weight @ slopes])


@pytest.mark.whole
@pytest.mark.parametrize(
    ("teeth", "module", "shifts", "width", "torque", "printed"),
    [
        ((23, 61), 2e-3, (0.4, -0.2), 18e-3, 60.0, (806.9e3, 829.4e3, 897.7e3)),
        ((31, 40), 3e-3, (0.1, 0.2), 25e-3, 300.0, None),
    ],
)
def test_torque_over_wind_up_and_both_slopes(
    teeth: tuple[int, int],
    module: float,
    shifts: tuple[float, float],
    width: float,
    torque: float,
    printed: tuple[float, ...] | None,
) -> None:
    """The first is the pair of the README; static wind-up follows the first of the three names."""
    gears = {"teeth": [*teeth], "module": f"{module} m", "face_width": f"{width} m"}
    gears |= {"profile_shift": [*shifts]}
    tree = {
        "gears": gears,
        "lubricant": {"name": "pao-vg-150"},
        "roughness": {"ra": "0.4 um"},
        "operation": {"torque": f"{torque} N m", "speed": "1200 rpm", "temperature": "50 degC"},
        "models": {"load_sharing": "from_stiffness"},
    }
    built = Variant(tree, "pair.toml", "default").built({})
    data = torsion_part(built).sel(torque=torque)
    names = ("torsional_stiffness", "tangent_torsional_stiffness", "phase_mean_torsional_stiffness")
    found = np.array([float(data[name]) for name in names])
    tips = [float(gear.tip_radius) for gear in built.design.mesh.gears]
    each = zip(teeth, shifts, tips, strict=True)
    first, second = (Tooth(count, module, shift, tip) for count, shift, tip in each)
    np.testing.assert_allclose(found, by_the_second_road((first, second), width, torque), rtol=2e-3)
    assert found[0] == pytest.approx(torque / float(data["wind_up"]), rel=1e-12)
    if printed is not None:
        np.testing.assert_allclose(found, printed, rtol=2e-3)
