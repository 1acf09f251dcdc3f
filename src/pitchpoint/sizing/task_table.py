"""What is asked of a drive before there are gears, the table [size] of a file: torque, ratio, speed, life."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import BeforeValidator, ValidationError

from pitchpoint.cases.document import read_tables, strip
from pitchpoint.cases.template import table_lines
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.gears_table import DISTANCE
from pitchpoint.input.kinds import LIFE, LOAD_FACTOR, LOADED, SPEED, TEMPERATURE
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.input.tables import Table, field_quantity
from pitchpoint.registry import enumerated, known_as, nearest, similar_names

__all__ = ["AIMS", "SIZED_FAMILIES", "TASK_TABLE", "Task", "read_task", "task_template"]

SizedFamily = Literal[
    "one stage",
    "two stages",
    "three stages",
    "planetary",
    "two planetary sets",
    "stepped planets",
    "3K",
    "strain wave",
    "planetary and strain wave",
]
Aim = Literal["mass", "loss", "diameter", "backlash"]

SIZED_FAMILIES: tuple[SizedFamily, ...] = get_args(SizedFamily)
"""Families and arrangements of drives that are tried."""

AIMS: tuple[Aim, ...] = get_args(Aim)
"""What may count of a design; of each less is better."""

TASK_TABLE = "size"
"""Name of the table of a task in its file."""

RATIO = Quantity("dimensionless", 1.2, 2000.0)
TOLERANCE = Quantity("dimensionless", 0.0, 0.2, open_low=True)
SAFETY = Quantity("dimensionless", 0.5, 10.0)
PLANETS = Quantity("dimensionless", 3, 7, whole=True)
SLENDER = Quantity("dimensionless", 0.2, 2.5)
MOST_STAGES = 3


def _listed(value: Any) -> list[Any]:
    """Values of a list, or of a text with commas."""
    if isinstance(value, str):
        return [part.strip() for part in value.split(",") if part.strip()]
    return list(value) if isinstance(value, Sequence) else [value]


def _distances(value: Any) -> list[Any]:
    values = _listed(value)
    if not 1 <= len(values) <= MOST_STAGES:
        raise InputError(
            f"{shown(value)} has {len(values)} values; give one for all stages, or one for each of up to "
            f"{MOST_STAGES} from the input"
        )
    return values


def _numbers(value: Any) -> list[Any]:
    """Whole numbers of a list or of a text with commas, each once and rising."""
    values = [
        float(part) if isinstance(part, str) and part.isdecimal() else part
        for part in _listed(value)
    ]
    return sorted({*values}) if all(isinstance(part, float | int) for part in values) else values


def _names(known: Sequence[str], what: str) -> Callable[[Any], tuple[str, ...]]:
    """Reads some names of a list, in its order."""

    def names_of(value: Any) -> tuple[str, ...]:
        named = []
        for name in _listed(value):
            meant = known_as(str(name), known)
            if meant is None:
                raise InputError(f"{shown(name)} is no {what}; known are {enumerated(known)}")
            named.append(meant)
        if not named:
            raise InputError(f"names none; known are {enumerated(known)}")
        return tuple(name for name in known if name in named)

    return names_of


def _steel(value: Any) -> str:
    """Name of a material whose teeth have limits of strength."""
    from pitchpoint.materials import solids  # only what is read computes

    record = solids.find(str(value))
    if record.sigma_hlim is None or record.sigma_flim is None:
        raise InputError(
            f"'{record.name}' has no strength of flanks and roots; take one that has, such as "
            "'case-hardened-mq'"
        )
    return record.name


def _oil(value: Any) -> str:
    from pitchpoint.materials import lubricants

    return lubricants.find(str(value)).name


class Task(Table):
    """What a drive has to do, and what it may take up; `pitchpoint size FILE` looks for drives that do it.

    The table is the only one of its file, which may have a title beside it. Options beside the file take the
    place of its values.
    """

    torque: Annotated[float, LOADED]
    """Torque at the output."""
    ratio: Annotated[float, RATIO]
    """Speed of the input over that of the output, of either sense."""
    speed: Annotated[float, SPEED]
    """Speed of the output."""
    life: Annotated[float, LIFE]
    """Time under load."""
    ratio_tolerance: Annotated[float, TOLERANCE] = 0.03
    """Part by which the ratio may differ."""
    diameter: Annotated[float, DISTANCE] | None = None
    """Largest diameter around the gears; any if left out."""
    length: Annotated[float, DISTANCE] | None = None
    """Largest length of the gears along their axes; any if left out."""
    centre_distances: Annotated[
        tuple[Annotated[float, DISTANCE], ...],
        BeforeValidator(_distances, json_schema_input_type=str | tuple[str, ...]),
    ] = ()
    """Largest centre distances of pairs, one or one for each stage from the input; any if left out."""
    families: Annotated[
        tuple[SizedFamily, ...],
        BeforeValidator(
            _names(SIZED_FAMILIES, "family that is sized"),
            json_schema_input_type=str | tuple[SizedFamily, ...],
        ),
    ] = SIZED_FAMILIES
    """Families and arrangements that are tried; all if left out."""
    planets: Annotated[
        tuple[Annotated[float, PLANETS], ...],
        BeforeValidator(_numbers, json_schema_input_type=str | float | tuple[float, ...]),
    ] = ()
    """Numbers of planets that sets may have; 3 to 5, of stepped and 3K sets 3 and 4, if left out."""
    material: Annotated[str, BeforeValidator(_steel)] = "case-hardened-mq"
    """Material of all gears but those of strain wave gears, one with limits of strength."""
    flank_safety: Annotated[float, SAFETY] = 1.2
    """Least safety of flanks by ISO 6336-2."""
    root_safety: Annotated[float, SAFETY] = 1.5
    """Least safety of roots by ISO 6336-3."""
    application_factor: Annotated[float, LOAD_FACTOR] = 1.0
    """Application factor K_A of that rating."""
    face_load_factor: Annotated[float, LOAD_FACTOR] = 1.0
    """Face load factor K_Hβ of that rating; K_Hα is 1."""
    slenderness: Annotated[float, SLENDER] = 1.2
    """Largest face width over the reference diameter of the pinion or sun."""
    aims: Annotated[
        tuple[Aim, ...],
        BeforeValidator(_names(AIMS, "aim"), json_schema_input_type=str | tuple[Aim, ...]),
    ] = AIMS
    """What counts of a design, of each the less the better; all if left out."""
    lubricant: Annotated[str, BeforeValidator(_oil)] = "pao-vg-150"
    """Oil by name."""
    temperature: Annotated[float, TEMPERATURE] = 333.15
    """Temperature of the oil."""

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
        try:
            return cls.model_validate(_stated(values))
        except ValidationError as error:
            wrong = Complaints()
            for fault in _faults(error.errors(include_url=False)):
                wrong.add(fault)
            raise wrong.error from None

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


def _stated(values: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value is not None}


SAMPLE = {"torque": "60 N m", "ratio": 60, "speed": "30 rpm", "life": "5000 h"}
"""What a task needs, to begin with."""


def _faults(details: Sequence[Any]) -> Iterator[InputError]:
    """What is wrong with the keys, out of complaints of pydantic; what is misspelt is not missing."""
    known = Task.model_fields
    unknown = [str(detail["loc"][0]) for detail in details if detail["type"] == "extra_forbidden"]
    for detail in details:
        key, cause = str(detail["loc"][0]), detail.get("ctx", {}).get("error")
        if isinstance(cause, InputError):
            yield cause.at(key=key)
        elif key in unknown:
            yield InputError(f"is not a known key{nearest(key, known)}", key=key)
        elif not any(key in similar_names(name, known) for name in unknown):
            quantity = field_quantity(known[key])
            allowed = "" if quantity is None else f"; {quantity.allowed}"
            yield InputError(f"is missing; write {json.dumps(SAMPLE[key])}{allowed}", key=key)


def read_task(path: Path | str, **options: Any) -> Task:
    """The task of a file, whose only table is [size].

    Args:
        path: of a TOML file.
        options: take the place of its values, by the names of the attributes; those that are None do not.

    Raises:
        InputError: all that is wrong, each with its file, its key and in one sentence.
    """
    path = Path(path)
    tree = strip(read_tables(path), {}, name=path.name)
    wrong = Complaints(path.name)
    if TASK_TABLE not in tree and {"gears", "stages", "variants"} & tree.keys():
        raise InputError(
            f"is a case, which has its gears: pitchpoint run {path}; a task is a table [{TASK_TABLE}], which "
            f"pitchpoint new {TASK_TABLE} writes",
            file=path.name,
        )
    unknown = tree.keys() - {"title", TASK_TABLE}
    for key in sorted(unknown):
        wrong.add(InputError(f"is no part of a task{nearest(key, ('title', TASK_TABLE))}", key=key))
    stated = tree.get(TASK_TABLE)
    values = {**stated, **_stated(options)} if isinstance(stated, dict) else {}
    if isinstance(stated, dict):
        wrong.under(TASK_TABLE).tried(Task.read, **values)
    elif stated is not None:
        wrong.add(
            InputError(
                f"{shown(stated)} was given where one table [{TASK_TABLE}] belongs", key=TASK_TABLE
            )
        )
    elif not any(similar_names(key, [TASK_TABLE]) for key in unknown):
        wrong.add(
            InputError(
                f"is missing: torque, ratio, speed and life stand in a table [{TASK_TABLE}], which "
                f"pitchpoint new {TASK_TABLE} writes",
                key=TASK_TABLE,
            )
        )
    wrong.demand_none()
    return Task.read(**values)


def task_template() -> str:
    """A file with a task to begin with, its optional keys as remarks with kind, range and usual value."""
    lines = [
        "# A task of Pitchpoint: pitchpoint size FILE -o front writes drives that do it as case files.",
        "# Keys behind a # are optional; what they say is the usual value, or an example of one.",
        'title = "My task"',
        *table_lines(Task, TASK_TABLE, SAMPLE, live=True),
    ]
    return "\n".join(lines) + "\n"
