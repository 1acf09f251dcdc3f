"""What the table [gears] of every family says, and values that several families take."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import nan, pi
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field
from pydantic.json_schema import JsonSchemaValue

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import Table

__all__ = [
    "ANGLE",
    "BORE",
    "COMMON_WIDTH",
    "DEVIATION",
    "DISTANCE",
    "FILLET",
    "HELIX",
    "MASS",
    "MODULE",
    "PHASE",
    "RACK",
    "SHIFT",
    "STIFFNESS",
    "WIDTH",
    "Deviation",
    "GearsTable",
    "Load",
    "Module",
    "PairDeviations",
    "SmallerOfTwo",
    "WavesAround",
    "check_waves",
]


@dataclass(frozen=True)
class Module(Quantity):
    """A module by its length, or by its diametral pitch P as "20 DP" or "20 1/in": 1 in/P."""

    def si(self, value: Any) -> float:
        """Module [m] of text of either kind, in its range or not."""
        number = _PITCH.fullmatch(value) if isinstance(value, str) else None
        if number is None or not float(number[1]):
            return super().si(value)
        return float(Decimal("0.0254") / Decimal(number[1]))

    @property
    def told(self) -> str:
        """Kind, range and units in words."""
        return f"{super().told}; or a diametral pitch as 20 DP"


_PITCH = re.compile(r"\s*(\d{1,9}(?:\.\d{1,9})?) ?(?:DP|1/in)\s*", re.ASCII)

MODULE = Module("length", 1e-5, 0.1, "mm")


@dataclass(frozen=True)
class SmallerOfTwo(Quantity):
    """A quantity that both gears have in common, also as a list of two, of which the smaller one counts."""

    def read(self, value: Any) -> float:
        """SI value of text or number, or of the smaller of two; InputError if it is not what is needed."""
        return (
            min(Pair(self).read(value)) if isinstance(value, list | tuple) else super().read(value)
        )

    @property
    def json_schema(self) -> JsonSchemaValue:
        """What editors know of the values."""
        single = super().json_schema
        return {"anyOf": [single, {"type": "array", "items": single, "minItems": 2, "maxItems": 2}]}

    @property
    def told(self) -> str:
        """Kind, range and units in words."""
        return f"{super().told}; one value for both gears, or a list of two"


WIDTH = Quantity("length", 1e-5, 10.0, "mm")
COMMON_WIDTH = SmallerOfTwo("length", 1e-5, 10.0, "mm")
ANGLE = Quantity("angle", 5 * pi / 180, 45 * pi / 180, "deg")
RACK = Quantity("dimensionless", 0.1, 4.0)
HELIX = Quantity("angle", 0.0, 60 * pi / 180, "deg")
SHIFT = Quantity("dimensionless", -2.0, 3.0)
FILLET = Quantity("dimensionless", 0.0, 1.0)
DISTANCE = Quantity("length", 1e-4, 100.0, "mm")
BORE = Quantity("length", 1e-5, 100.0, "mm")
STIFFNESS = Quantity("stiffness", 0.0, 1e13, "N/um", open_low=True)
MASS = Quantity("mass", 0.0, 1e6, "kg", open_low=True)
WAVES = Quantity("dimensionless", 1, 1_000, whole=True)
DEVIATION = Quantity("length", 0.0, 1e-2, "um")
PHASE = Quantity("angle", -4 * pi, 4 * pi, "deg")

Load = Literal["torque", "force"]


class GearsTable(Table):
    """The table of a family: its own keys, and what is usual for its gears.

    Attributes:
        members: body of each coordinate.
        load: what the loaded member takes.
        carries: that in words.
        transmits: False for a test rig.
        rated: True if standards rate the strength of their teeth, see `rated_pair`.
        friction, film_thickness, load_sharing: laws where none are given.
        meaningless: by key of the models why they say nothing about these gears.
        drivers: members that may drive, the usual one first.
        damping_ratio: of a vibration where none is given.
        explored: the key by which an explorer changes the gears, inside the table, and how far to either
            side of its value [SI].
        sources: keys of the bibliography for what is given.
    """

    members: ClassVar[tuple[str, ...]]
    load: ClassVar[Load] = "torque"
    carries: ClassVar[str] = "gears carry a torque"
    transmits: ClassVar[bool] = True
    rated: ClassVar[bool] = False
    friction: ClassVar[str] = "constant"
    film_thickness: ClassVar[str] = "dowson_higginson_1959"
    damping_ratio: ClassVar[float] = 0.1
    explored: ClassVar[tuple[str, float] | None] = None
    meaningless: ClassVar[Mapping[str, str]] = {}
    family: str

    @property
    def designation(self) -> str:
        """What the gears are, with their numbers of teeth: heads the report of a case without a title."""
        return self.family.replace("_", " ").capitalize()

    @property
    def tooth_numbers(self) -> tuple[float, ...]:
        """Numbers of teeth of both members in magnitude; empty where that says nothing."""
        return ()

    @property
    def normal_module(self) -> float:
        """Normal module [m]; not a number without teeth."""
        return nan

    @property
    def opposed(self) -> "GearsTable | None":
        """The same gears pressing their other flanks; None where that is no choice of the table."""
        return None

    @property
    def thickness_allowances(self) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Upper and lower allowances of the tooth thickness of both gears [m]; None where none are given."""
        return None

    @property
    def shafts(self) -> tuple[str, ...]:
        """Bodies that turn, beside which power may be lost."""
        return self.members

    @property
    def drivers(self) -> tuple[str, ...]:
        """Members that may drive, the usual one first."""
        return self.members

    def loaded_member(self, driver: str) -> str | None:
        """Member that is loaded while another one drives; None of a rig, see `mesh_ends`.

        Args:
            driver: its name.
        """
        others = [name for name in self.members if name != driver]
        return others[0] if len(others) == 1 else None

    @property
    def relative_torques(self) -> Mapping[str, float]:
        """Torques [N m] or forces [N] of the members without losses, up to a common factor."""
        return (
            dict(zip(self.members, self.tooth_numbers, strict=True)) if self.tooth_numbers else {}
        )

    @property
    def loss_scales(self) -> Mapping[str, float]:
        """Lengths [m] and ratios of the gears by name, with which named sets of losses scale."""
        return {}

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography for what is given."""
        return ()

    @property
    def load_sharing(self) -> str:
        """Load sharing where none is given."""
        return "equal"


class Deviation(Table):
    """A wave of a deviation along the normal of the flanks, so many times around the member."""

    order: Annotated[float, WAVES]
    """Waves around the member; 1 is an eccentricity."""
    amplitude: Annotated[float, DEVIATION]
    """Amplitude of the missing height along the normal of the flanks."""
    phase: Annotated[float, PHASE] = 0.0
    """Angle of the wave where the angle of the member is zero."""


WavesAround = Annotated[tuple[Deviation, ...], Field(max_length=200)]


class PairDeviations(Table):
    """How far flanks lie behind their places, as waves around each gear; they make the kinematic error."""

    gear_1: WavesAround = ()
    """Waves around gear 1, each with order, amplitude and phase; none unless given."""
    gear_2: WavesAround = ()
    """Waves around gear 2, each with order, amplitude and phase; none unless given."""

    @property
    def each(self) -> dict[str, tuple[Deviation, ...]]:
        """Waves by key of the gear."""
        return {"gear_1": self.gear_1, "gear_2": self.gear_2}

    def check(self, teeth: tuple[float, float], module: float) -> None:
        """InputError for waves that the teeth are too few to tell, or as high as the teeth.

        Args:
            teeth: of both gears, without sign.
            module: normal module [m].
        """
        for (key, waves), number in zip(self.each.items(), teeth, strict=True):
            check_waves(waves, key, number, module)


def check_waves(waves: tuple[Deviation, ...], key: str, teeth: float, module: float) -> None:
    """InputError for waves that the teeth are too few to tell, or as high as the teeth."""
    member = key.replace("_", " ") if key.startswith("gear") else f"the {key.replace('_', ' ')}"
    for position, wave in enumerate(waves):
        if wave.order > teeth / 2.0:
            raise InputError(
                f"{wave.order:.0f} waves around {member} look like fewer of them at its {teeth:.0f} "
                f"teeth; allowed are 1 to {teeth // 2.0:.0f}",
                key=f"deviations.{key}.{position}.order",
            )
    most = sum(wave.amplitude for wave in waves)
    if most > module / 2.0:
        raise InputError(
            f"the deviations of {member} add up to {DEVIATION.show(most)}; allowed is half a "
            f"module, {DEVIATION.show(module / 2.0)}",
            key=f"deviations.{key}",
        )
