"""What an optimiser is asked, the table [optimise] of a case file."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, text
from pitchpoint.input.tables import Table

__all__ = ["STARTS", "OptimiseTable"]

Words = Annotated[str, BeforeValidator(text)]
STARTS = Quantity("dimensionless", 1, 4096, whole=True)


class OptimiseTable(Table):
    """Keys to vary until one result is least or largest, for the command `optimise`; `run` leaves it out.

    `vary` has of each key the ends between which it may lie, "10 mm:30 mm", or a list of values of which each
    is tried. Results have the names that they have in a study or a run: mean_loss, least_root_safety.
    """

    vary: dict[str, Any] = Field(
        default_factory=dict, examples=[{"gears.profile_shift.1": "0:0.6"}]
    )
    """Ends or list of values by dotted key."""
    minimise: Words = ""
    """Result that is to be as small as can be; this or maximise."""
    maximise: Words = ""
    """Result that is to be as large as can be."""
    subject_to: tuple[Words, ...] = ()
    """What is kept, each a result, >=, <= or =, and a value, "root_safety >= 1.5"; nothing unless given."""
    law: Words = ""
    """Friction law under which results are meant; the first one unless given."""
    starts: Annotated[float, STARTS] | None = None
    """Evenly spread designs to begin with; 16 for each key with two ends, 256 at most, unless given."""
    folder: Words = ""
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
        return dict(_by_dotted_key(self.vary))


def _by_dotted_key(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping) and value and not {"start", "stop", "values"} & value.keys():
            yield from _by_dotted_key(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value
