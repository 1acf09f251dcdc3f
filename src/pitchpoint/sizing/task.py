"""What is asked of a drive before there are gears: torque, ratio, speed, life, and what it may take up."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Self

from pitchpoint.cases.schema import LIFE, LOAD_FACTOR, LOADED, SPEED, TEMPERATURE
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.table import DISTANCE
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.materials import lubricants, solids
from pitchpoint.registry import enumerated, known_as

__all__ = ["AIMS", "SIZED_FAMILIES", "Task"]

SIZED_FAMILIES = (
    "one stage",
    "two stages",
    "three stages",
    "planetary",
    "two planetary sets",
    "stepped planets",
    "3K",
    "strain wave",
)
"""Families and arrangements of drives that are tried."""

AIMS = ("mass", "loss", "diameter", "backlash")
"""What may count of a design; of each less is better."""

RATIO = Quantity("dimensionless", 1.2, 2000.0)
TOLERANCE = Quantity("dimensionless", 0.0, 0.2, open_low=True)
SAFETY = Quantity("dimensionless", 0.5, 10.0)
SLENDER = Quantity("dimensionless", 0.2, 2.5)
MOST_STAGES = 3


@dataclass(frozen=True, kw_only=True)
class Task:
    """What a drive has to do, and what it may take up.

    Attributes:
        torque: at the output [N m].
        ratio: speed of the input over that of the output, of either sense.
        speed: of the output [rad/s].
        life: time under load [s].
        ratio_tolerance: part by which the ratio may differ.
        diameter, length: largest ones of the gears [m]; None for any.
        centre_distances: largest ones of the stages from the input, or one for all [m]; empty for any.
        families: of `SIZED_FAMILIES`.
        material: of all gears but those of strain wave gears.
        flank_safety, root_safety: least ones by ISO 6336.
        application_factor, face_load_factor: K_A and K_Hbeta of that rating.
        slenderness: largest face width over the reference diameter of the pinion or sun.
        aims: of `AIMS`, what counts.
        lubricant: by name.
        temperature: of the oil [K].
    """

    torque: float
    ratio: float
    speed: float
    life: float
    ratio_tolerance: float = 0.03
    diameter: float | None = None
    length: float | None = None
    centre_distances: tuple[float, ...] = ()
    families: tuple[str, ...] = SIZED_FAMILIES
    material: str = "case-hardened-mq"
    flank_safety: float = 1.2
    root_safety: float = 1.5
    application_factor: float = 1.0
    face_load_factor: float = 1.0
    slenderness: float = 1.2
    aims: tuple[str, ...] = AIMS
    lubricant: str = "pao-vg-150"
    temperature: float = 333.15

    @classmethod
    def read(cls, **values: Any) -> Self:
        """A task from texts with units and numbers, those that are None left out.

        Args:
            values: by the names of the attributes.

        Raises:
            InputError: all that is wrong, each with its key and in one sentence.

        Example:
            >>> task = Task.read(torque="60 N m", ratio=60, speed="30 rpm", life="5000 h")
            >>> task.life
            18000000.0
        """
        wrong = Complaints()
        known: dict[str, Any] = {}
        for key, value in values.items():
            if value is not None:
                known[key] = wrong.tried(_read, key, value)
        wrong.demand_none()
        return cls(**known)

    @property
    def reaches(self) -> tuple[float, float]:
        """The least and the largest ratio that will do."""
        return self.ratio * (1.0 - self.ratio_tolerance), self.ratio * (1.0 + self.ratio_tolerance)

    def most_distance(self, stage: int, stages: int) -> float:
        """Largest centre distance of a stage, counted from zero at the input [m].

        Zero where several are given and not for so many stages: such a drive is none of those asked for.
        """
        given = self.centre_distances
        if not given:
            return float("inf")
        return given[0] if len(given) == 1 else given[stage] if len(given) == stages else 0.0


def _read(key: str, value: Any) -> Any:
    try:
        return _READ[key](value)
    except InputError as error:
        raise error.at(key=key) from None


def _listed(value: Any) -> list[Any]:
    """Values of a list, or of a text with commas."""
    if isinstance(value, str):
        return [part.strip() for part in value.split(",") if part.strip()]
    return list(value) if isinstance(value, Sequence) else [value]


def _distances(value: Any) -> tuple[float, ...]:
    values = _listed(value)
    if not 1 <= len(values) <= MOST_STAGES:
        raise InputError(
            f"{shown(value)} has {len(values)} values; give one for all stages, or one for each of up to "
            f"{MOST_STAGES} from the input"
        )
    return tuple(map(DISTANCE.read, values))


def _names(known: Sequence[str], what: str) -> Callable[[Any], tuple[str, ...]]:
    """Reads some names of a list, in its order."""

    def read(value: Any) -> tuple[str, ...]:
        named = []
        for name in _listed(value):
            meant = known_as(str(name), known)
            if meant is None:
                raise InputError(f"{shown(name)} is no {what}; known are {enumerated(known)}")
            named.append(meant)
        if not named:
            raise InputError(f"names none; known are {enumerated(known)}")
        return tuple(name for name in known if name in named)

    return read


def _steel(value: Any) -> str:
    """Name of a material whose teeth have limits of strength."""
    record = solids.find(str(value))
    if record.sigma_hlim is None or record.sigma_flim is None:
        raise InputError(
            f"'{record.name}' has no strength of flanks and roots; take one that has, such as "
            "'case-hardened-mq'"
        )
    return record.name


def _oil(value: Any) -> str:
    return lubricants.find(str(value)).name


_READ: dict[str, Callable[[Any], Any]] = {
    "torque": LOADED.read,
    "ratio": RATIO.read,
    "speed": SPEED.read,
    "life": LIFE.read,
    "ratio_tolerance": TOLERANCE.read,
    "diameter": DISTANCE.read,
    "length": DISTANCE.read,
    "centre_distances": _distances,
    "families": _names(SIZED_FAMILIES, "family that is sized"),
    "material": _steel,
    "flank_safety": SAFETY.read,
    "root_safety": SAFETY.read,
    "application_factor": LOAD_FACTOR.read,
    "face_load_factor": LOAD_FACTOR.read,
    "slenderness": SLENDER.read,
    "aims": _names(AIMS, "aim"),
    "lubricant": _oil,
    "temperature": TEMPERATURE.read,
}
