"""Tables of a case file on computations beside its own: studies, and printed numbers to compare with."""

from collections.abc import Iterable, Iterator, Mapping
from math import inf
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from pitchpoint import units
from pitchpoint.cases.document import at_most
from pitchpoint.errors import InputError
from pitchpoint.input.kinds import Text
from pitchpoint.input.quantities import Quantity, named, shown, text
from pitchpoint.input.tables import Table
from pitchpoint.published.publication_registry import PUBLICATIONS
from pitchpoint.results.reductions import REDUCTIONS
from pitchpoint.results.variables import VARIABLES

__all__ = [
    "COUNT",
    "DESIGNS",
    "STARTS",
    "Issue",
    "Issues",
    "OptimiseTable",
    "Studies",
    "Study",
    "StudyTable",
    "Sweep",
    "Target",
    "Targets",
    "Unit",
    "one_value",
]


COUNT = Quantity("dimensionless", 1, 100_000, whole=True)
DESIGNS = Quantity("dimensionless", 1, 10_000_000, whole=True)
STARTS = Quantity("dimensionless", 1, 4096, whole=True)
DESIGN_SEED = Quantity("dimensionless", 0, 1_000_000, whole=True)
WORKERS = Quantity("dimensionless", 1, 1000, whole=True)
ANY = Quantity("dimensionless", -inf, inf)
TIMES = Quantity("dimensionless", 0.0, 1000.0, open_low=True)
NOT_NEGATIVE = Quantity("dimensionless", 0.0, inf)
POSITION = Quantity("dimensionless", 0, 11, whole=True)
Unit = Annotated[str, BeforeValidator(lambda value: _unit(value))]


def _unit(value: Any) -> str:
    if text(value) != "1":
        units.kind_of(value)
    return str(value)


def _places(value: Any) -> tuple[Any, ...]:
    several = value if isinstance(value, list | tuple) else [value]
    for place in several:
        if isinstance(place, bool) or not isinstance(place, str | int | float):
            raise InputError(f"{shown(place)} was given where a place of the axis belongs")
    if not 1 <= len(several) <= 12:
        raise InputError(f"{len(several)} places were given; allowed are 1 to 12")
    return tuple(several)


def _variables() -> list[str]:
    return list(
        dict.fromkeys(name for variables in (VARIABLES, *_published()) for name in variables)
    )


def _published() -> Iterator[Iterable[str]]:
    return (publication.variables for publication in PUBLICATIONS.values())


def one_value(start: Any, stop: Any) -> str:
    """Why a sweep of a single value has no two ends."""
    return f"1 value cannot be both {shown(start)} and {shown(stop)}; write 2 or more"


class Sweep(Table):
    """Values of one key: from start to stop in equal steps, or a list."""

    key: Text
    """Dotted key whose value is swept, as gears.profile_shift.1."""
    start: Any = None
    """First value; with stop in place of values."""
    stop: Any = None
    """Last value; with start in place of values."""
    count: Annotated[float, COUNT] = 19.0
    """Number of values from start to stop, equally apart."""
    values: tuple[Any, ...] | None = None
    """List of values in place of start and stop."""

    @model_validator(mode="after")
    def _complete(self) -> "Sweep":
        if (self.values is None) == (self.start is None or self.stop is None):
            raise InputError("a sweep needs either start and stop, or values")
        if self.values is not None and not 1 <= len(self.values) <= COUNT.high:
            raise InputError(f"{len(self.values)} values were given; {COUNT.allowed}", key="values")
        if self.values is None and self.count < 2 and self.start != self.stop:
            raise InputError(one_value(self.start, self.stop), key="count")
        return self


class Study(Table):
    """One computation of the case: its operating point with changes, swept or not."""

    title: Text = ""
    """Title on screen and in the report; the name of the study unless given."""
    change: dict[str, Any] = Field(default_factory=dict)
    """What differs from the case, by its tables and keys; nothing unless given."""
    sweep: Sweep | None = None
    """Values over which one key is swept; one point unless given."""


class StudyTable(Table):
    """Many designs of the case, which the command `study` computes; `run` leaves them out.

    `over` has the values of each key: a list, or { start = ..., stop = ..., count = ... } in equal steps;
    where designs are drawn two ends, or { start = ..., stop = ..., distribution = "normal" }, whose ends are
    three standard deviations from its middle. `tolerances` draws what the inspection tables of a pair or of
    stages in a row allow: tooth thicknesses, the centre distance, by a class of ISO 1328-1 the misalignment
    by helix slopes, and what part of their limits pitch and profiles of each gear reach.
    """

    over: dict[str, Any] = Field(
        default_factory=dict, examples=[{"operation.torque": ["20 N m", "90 N m"]}]
    )
    """Values by dotted key; may be left out with tolerances."""
    how: Literal["grid", "zip", "latin_hypercube", "sobol", "saltelli"] | None = None
    """How designs are laid out, by saltelli for Sobol' indices; grid, with tolerances sobol, unless given."""
    n: Annotated[float, DESIGNS] | None = None
    """Designs to draw; of sobol, and of each of both samples of saltelli, a power of two."""
    seed: Annotated[float, DESIGN_SEED] = 0.0
    """Number from which designs are drawn; the same one draws the same designs."""
    tolerances: Literal["uniform", "normal"] | None = None
    """Distribution of tolerances between their limits; gears are the nominal ones unless given."""
    folder: Text = ""
    """Folder of the files, from that of the case file on; results/CASE/study unless given."""
    piece: Annotated[float, DESIGNS] | None = None
    """Designs that are computed and kept together; 4096 unless given."""
    workers: Annotated[float, WORKERS] | None = None
    """Processes of this machine that compute; the one of the command unless given."""
    scheduler: Text = ""
    """Address of a scheduler of dask.distributed whose workers compute, in place of workers."""

    @model_validator(mode="after")
    def _of_something(self) -> "StudyTable":
        if not self.over and self.tolerances is None:
            raise InputError(
                'a study needs the values of one key at least, "operation.torque" = ["20 N m", "90 N m"], or '
                "tolerances",
                key="over",
            )
        if self.workers is not None and self.scheduler:
            raise InputError(
                "goes with workers of this machine; give it or a scheduler", key="workers"
            )
        return self

    @property
    def by_key(self) -> dict[str, Any]:
        """Values by dotted key, also of keys that were written as tables within tables."""
        return dict(_values_by_key(self.over))


class OptimiseTable(Table):
    """Keys to vary until one result is least or largest, for the command `optimise`; `run` leaves it out.

    `vary` has of each key the ends between which it may lie, "10 mm:30 mm", or a list of values of which each
    is tried. Results have the names that they have in a study or a run: mean_loss, least_root_safety.
    """

    vary: dict[str, Any] = Field(
        default_factory=dict, examples=[{"gears.profile_shift.1": "0:0.6"}]
    )
    """Ends or list of values by dotted key."""
    minimise: Text = ""
    """Result that is to be as small as can be; this or maximise."""
    maximise: Text = ""
    """Result that is to be as large as can be."""
    subject_to: tuple[Text, ...] = ()
    """What is kept, each a result, >=, <= or =, and a value, "root_safety >= 1.5"; nothing unless given."""
    law: Text = ""
    """Friction law under which results are meant; the first one unless given."""
    starts: Annotated[float, STARTS] | None = None
    """Evenly spread designs to begin with; 16 for each key with two ends, 256 at most, unless given."""
    folder: Text = ""
    """Folder of the files, from that of the case file on; results/CASE/optimum unless given."""

    @model_validator(mode="after")
    def _one_aim(self) -> "OptimiseTable":
        if not self.vary:
            told = 'an optimiser needs a key to vary, "gears.profile_shift.1" = "0:0.6"'
            raise InputError(told, key="vary")
        if bool(self.minimise) == bool(self.maximise):
            told = 'one result is the aim, minimise = "mean_loss" or maximise = "mean_efficiency"'
            raise InputError(told, key="minimise")
        return self

    @property
    def by_key(self) -> dict[str, Any]:
        """What varies by dotted key, also of keys that were written as tables within tables."""
        return dict(_values_by_key(self.vary))


def _values_by_key(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping) and value and not {"start", "stop", "values"} & value.keys():
            yield from _values_by_key(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


class Target(Table):
    """A printed number and how it is computed from a study, or from another part of the result.

    `at` names one place of the axis of that part or several; values there are interpolated between
    those that were computed, and `reduce` makes one number of them. `slope` is the change of the
    variable over that of the axis from the first place to the last, `inverse_slope` its inverse:
    with the wind-up of the part `torsion`, which runs over torque, the stiffness between two torques.
    A number to be exceeded or not reached, `expect`, is `times` the printed one.
    """

    quantity: Text
    """What the number is, in words."""
    where: Text
    """Place of the number in its source."""
    kind: Literal[
        "predicted", "fitted", "calibrated", "trend", "definition", "reference", "excluded"
    ]
    """What agreement with the number would show, and whether it is left out."""
    printed: Annotated[float, ANY]
    """The printed number, in its unit."""
    unit: Unit = "1"
    """Unit of the printed number; 1 for none."""
    tolerance: Annotated[float, NOT_NEGATIVE] = 0.0
    """Largest deviation that passes, in the unit of the number."""
    expect: Literal["within", "above", "below"] = "within"
    """Whether the number is to be met within the tolerance, exceeded or not reached."""
    times: Annotated[float, TIMES] = 1.0
    """Factor on the printed number of a bound."""
    study: Text = ""
    """Study that is read; this or a part."""
    part: Text = ""
    """Part of the result that is read; this or a study."""
    variable: Annotated[str, BeforeValidator(named(_variables, "quantity", VARIABLES))] = ""
    """Result variable that is read."""
    at: Annotated[tuple[Any, ...], BeforeValidator(_places)] = ()
    """Places on the axis that are read, one or a list; all that were computed unless given."""
    reduce: Annotated[str, BeforeValidator(named(REDUCTIONS.keys, "reduction"))] = "value"
    """How one number is made of the values at these places."""
    law: tuple[Annotated[float, POSITION], ...] = (0.0,)
    """Positions of the friction laws that are read, from 0."""
    less: Annotated[float, ANY] = 0.0
    """Number that is taken off the computed one before both are compared, in the unit of the print."""
    reason: Text = ""
    """Why the number deviates, or is left out."""
    missed: Text = ""
    """Why the number is known to be missed; a number that is met all the same fails the comparison."""

    @property
    def reads(self) -> str:
        """Name of the part that it reads."""
        return self.part or f"study_{self.study}"

    @model_validator(mode="after")
    def _one(self) -> "Target":
        if self.study and self.part:
            raise InputError(
                "study and part were both given; a target reads one of them", key="part"
            )
        if self.missed and self.kind == "excluded":
            raise InputError("a number that is left out is not missed; give a reason", key="missed")
        if self.missed and self.reason:
            raise InputError(
                "reason and missed were both given; a known miss has one", key="reason"
            )
        if self.times != 1.0 and self.expect == "within":
            raise InputError('belongs to a bound, expect = "above" or "below"', key="times")
        return self


class Issue(Table):
    """A misprint or a questionable point of the publication."""

    where: Text
    """Place in the publication."""
    issue: Text
    """What is wrong or questionable there."""
    verdict: Text
    """What is taken in its place, or what follows."""


Studies = Annotated[dict[str, Study], BeforeValidator(at_most(200))]
Targets = Annotated[tuple[Target, ...], Field(max_length=2000)]
Issues = Annotated[tuple[Issue, ...], Field(max_length=500)]
