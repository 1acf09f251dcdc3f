"""What the figures and the page need to know about a result beside its datasets."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.runs.run import Outcome
from pitchpoint.views.inputs import given, number

__all__ = [
    "Facts",
    "OperatingPoint",
    "Periodic",
    "Wave",
    "facts",
    "has_path",
    "has_wave",
    "operating_point",
    "same_geometry",
    "timed",
    "wave",
]


@dataclass(frozen=True)
class OperatingPoint:
    """Where a variant is run.

    Attributes:
        torque: of the loaded member [N m], or force on one that travels [N].
        speed: of the driver [rad/s].
        temperature: of the oil [K].
    """

    torque: float
    speed: float
    temperature: float


@dataclass(frozen=True)
class Periodic(OperatingPoint):
    """Operating point of a mesh whose state repeats.

    Attributes:
        period_angle: driver angle after which it does: of one base pitch, or in which a wave moves on by one
            tooth [rad].
    """

    period_angle: float

    @property
    def period(self) -> float:
        """Time after which the mesh repeats [s]."""
        return self.period_angle / self.speed


@dataclass(frozen=True)
class Facts(Periodic):
    """Operating point and gears of one variant.

    Attributes:
        driver: 1 or 2.
        right_flank: True if the right flanks touch.
        teeth: of both gears; negative for a ring.
        points: by letter, positions on the path from A in base pitches, in order.
        transverse_ratio, overlap_ratio: transverse contact ratio and overlap ratio.
    """

    driver: int
    right_flank: bool
    teeth: tuple[int, int]
    points: dict[str, float]
    transverse_ratio: float
    overlap_ratio: float

    @property
    def contact_ratio(self) -> float:
        """Total contact ratio: base pitches from the entry of a pair to its exit."""
        return self.transverse_ratio + self.overlap_ratio

    @property
    def helical(self) -> bool:
        """True if contact lines cross the face at an angle."""
        return self.overlap_ratio > 0.0

    @property
    def internal(self) -> bool:
        """True if gear 2 is a ring."""
        return self.teeth[1] < 0

    @property
    def backwards(self) -> bool:
        """True if a pair runs from E to A: the wheel drives the same flanks."""
        return self.driver == 2


@dataclass(frozen=True)
class Wave(Periodic):
    """Operating point and bodies of a drive whose teeth are carried by a wave.

    Attributes:
        teeth: of flexspline and circular spline.
        rates: of wave generator, flexspline and circular spline for a radian of the driver.
        driver, loaded, fixed: names of the members.
    """

    teeth: tuple[int, int]
    rates: tuple[float, float, float]
    driver: str
    loaded: str
    fixed: str

    @property
    def backwards(self) -> bool:
        """True if teeth move against the sense of rotation along the wave."""
        return self.rates[1] < self.rates[0]


def has_path(outcome: Outcome) -> bool:
    """True if the teeth are drawn on a path of contact with its points."""
    return "points" in outcome.parts.get("teeth", ())


def has_wave(outcome: Outcome) -> bool:
    """True if the teeth are drawn on a neutral line that a wave deforms."""
    return "wave_weights" in outcome.parts.get("teeth", ())


def operating_point(outcome: Outcome) -> OperatingPoint:
    """Where a result was run, whatever its gears."""
    return OperatingPoint(**_point(outcome))


def timed(outcome: Outcome) -> Facts | Wave:
    """Facts of a result whose teeth are there, with the period of its mesh."""
    return wave(outcome) if has_wave(outcome) else facts(outcome)


def wave(outcome: Outcome) -> Wave:
    """Facts of a result whose teeth are carried by a wave."""
    z1, z2 = (round(float(z)) for z in outcome.parts["teeth"]["teeth"].values)
    driver, loaded = (str(outcome.manifest[key]) for key in ("driver", "loaded"))
    motion = dict(zip(outcome.manifest["members"], outcome.manifest["motion"], strict=True))
    generator, first, second = (float(motion.get(name, 0.0)) for name in MEMBERS)
    return Wave(
        **_period(outcome),
        teeth=(z1, z2),
        rates=(generator, first, second),
        driver=driver,
        loaded=loaded,
        fixed=next(name for name in MEMBERS if name not in (driver, loaded)),
    )


def facts(outcome: Outcome) -> Facts:
    """Facts of a result whose teeth are there, on a path of contact."""
    teeth = outcome.parts["teeth"]
    places = (teeth["points"].values - teeth["points"].values[0]) / float(teeth["base_pitch"])
    named = sorted(zip(places.tolist(), teeth["point"].values.tolist(), strict=True))
    ratio = float(teeth["transverse_contact_ratio"])
    inside = {str(name): place for place, name in named if -1e-9 <= place <= ratio + 1e-9}
    return Facts(
        **_period(outcome),
        driver=2 if outcome.manifest["driver"] == "gear 2" else 1,
        right_flank=given(outcome, "gears", "flank") == "right",
        teeth=(round(float(teeth["teeth"][0])), round(float(teeth["teeth"][1]))),
        points=inside,
        transverse_ratio=ratio,
        overlap_ratio=float(teeth["overlap_ratio"]),
    )


def same_geometry(first: Outcome, second: Outcome) -> bool:
    """True if both variants have the same teeth and drive the same flanks the same way."""
    one, two = first.parts["teeth"], second.parts["teeth"]
    keys = (("operation", "driver"), ("gears", "flank"), ("gears", "fixed"))
    return (
        one.sizes == two.sizes
        and set(one.data_vars) == set(two.data_vars)
        and all(
            np.array_equal(one[name].values, two[name].values, equal_nan=True)
            for name in one.data_vars
        )
        and all(given(first, *key) == given(second, *key) for key in keys)
    )


def _point(outcome: Outcome) -> dict[str, float]:
    load = "torque" if given(outcome, "operation", "torque") is not None else "force"
    names = {"torque": load, "speed": "speed", "temperature": "temperature"}
    return {name: number(outcome, "operation", key) for name, key in names.items()}


def _period(outcome: Outcome) -> dict[str, Any]:
    return {**_point(outcome), "period_angle": float(outcome.manifest["period"])}
