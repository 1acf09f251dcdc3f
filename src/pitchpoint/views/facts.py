"""What the figures and the page need to know about a result beside its datasets."""

from dataclasses import dataclass
from math import pi

import numpy as np

from pitchpoint import units
from pitchpoint.cases.run import Outcome

__all__ = ["Facts", "facts", "given", "same_geometry"]


@dataclass(frozen=True)
class Facts:
    """Operating point and gears of one variant.

    Attributes:
        driver: 1 or 2.
        right_flank: True if the right flanks touch.
        torque, speed, temperature: of the operating point [N m, rad/s, K].
        teeth: of both gears; negative for a ring.
        points: by letter, positions on the path from A in base pitches, in order.
        transverse_ratio, overlap_ratio: transverse contact ratio and overlap ratio.
    """

    driver: int
    right_flank: bool
    torque: float
    speed: float
    temperature: float
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
    def period_angle(self) -> float:
        """Driver angle of one base pitch [rad]."""
        return 2.0 * pi / abs(self.teeth[self.driver - 1])

    @property
    def period(self) -> float:
        """Time of one base pitch [s]."""
        return self.period_angle / self.speed

    @property
    def backwards(self) -> bool:
        """True if a pair runs from E to A: the wheel drives the same flanks."""
        return self.driver == 2


def given(outcome: Outcome, table: str, key: str) -> str:
    """Value of an input as shown; empty if there is none."""
    rows = outcome.manifest["inputs"]
    return next((r["value"] for r in rows if r["table"] == table and r["key"] == key), "")


def facts(outcome: Outcome) -> Facts:
    """Facts of a result whose teeth are there."""
    teeth = outcome.parts["teeth"]
    places = (teeth["points"].values - teeth["points"].values[0]) / float(teeth["base_pitch"])
    named = sorted(zip(places.tolist(), teeth["point"].values.tolist(), strict=True))
    ratio = float(teeth["transverse_contact_ratio"])
    inside = {str(name): place for place, name in named if -1e-9 <= place <= ratio + 1e-9}
    return Facts(
        driver=2 if given(outcome, "operation", "driver") == "gear 2" else 1,
        right_flank=given(outcome, "gears", "flank") == "right",
        torque=_read(outcome, "torque", "torque"),
        speed=_read(outcome, "speed", "rotational speed"),
        temperature=_read(outcome, "temperature", "temperature"),
        teeth=(round(float(teeth["teeth"][0])), round(float(teeth["teeth"][1]))),
        points=inside,
        transverse_ratio=ratio,
        overlap_ratio=float(teeth["overlap_ratio"]),
    )


def same_geometry(first: Outcome, second: Outcome) -> bool:
    """True if both variants have the same teeth and drive the same flanks the same way."""
    one, two = first.parts["teeth"], second.parts["teeth"]
    keys = (("operation", "driver"), ("gears", "flank"))
    return (
        one.sizes == two.sizes
        and all(np.array_equal(one[name].values, two[name].values) for name in one.data_vars)
        and all(given(first, *key) == given(second, *key) for key in keys)
    )


def _read(outcome: Outcome, key: str, kind: str) -> float:
    return units.parse(given(outcome, "operation", key), kind)
