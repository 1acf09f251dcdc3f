"""What a publication brings to the cases that name it as their source."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from pitchpoint.registry import code_at
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import VARIABLES

if TYPE_CHECKING:
    from pitchpoint.dynamics.pair_vibration import Vibrating
    from pitchpoint.efficiency.quasi_static import Design, Models, Operation
    from pitchpoint.input.tables import Table

__all__ = ["Beside", "Curves", "Maps", "Publication", "Read", "Reading", "ReadingPoint"]


@dataclass(frozen=True)
class ReadingPoint:
    """What formulas are read at.

    Attributes:
        gears: as the case gives them.
        design: as it is built.
        operation: one operating point.
        formulas: inputs of the formulas beside all that, where the publication has a table of them.
        models: of the case, under each of its friction laws.
        vibrating: gives its inertia, damping and profile error, where it vibrates along its line of action.
    """

    gears: Table
    design: Design
    operation: Operation
    formulas: Table | None = None
    models: tuple[Models, ...] = ()
    vibrating: Callable[[], Vibrating] | None = None


Read = Mapping[str, "float | Float[np.ndarray, ' place']"]
"""Numbers and courses by name."""

Reading = Callable[[ReadingPoint], Read]
"""What its formulas give at a point."""


@dataclass(frozen=True)
class Curves:
    """Courses that the report draws over each other.

    Attributes:
        title: of the figure.
        along: variable of the places that all of them run over.
        names: variables of the courses, in the order of the columns.
        columns: what they are in words, where they are not those of the table beside them.
        decades: drawn on a logarithmic axis.
        shows: figure of the publication that it shows, as "Figure 9"; empty for none.
        at: point at which the publication draws it, in words; empty where that is the first one shown.
        studies: names of those whose points it is drawn for, among families; all where none is named.
    """

    title: str
    along: str
    names: tuple[str, ...]
    columns: tuple[str, ...] = ()
    decades: bool = False
    shows: str = ""
    at: str = ""
    studies: tuple[str, ...] = ()


@dataclass(frozen=True)
class Maps:
    """A field over two axes that the report draws in colours.

    Attributes:
        title: of the figure.
        axes: variables of the places along x and along y.
        name: variable of the values, row by row of y as one course.
        shows: figure of the publication that it shows; empty for none.
        at: as of `Curves`.
    """

    title: str
    axes: tuple[str, str]
    name: str
    shows: str = ""
    at: str = ""


@dataclass(frozen=True)
class Beside:
    """Readings that the report sets beside each other, at every point of a study.

    Attributes:
        columns: what stands beside each other, in words.
        rows: by words for the quantity, the variable of each column; of one kind and unit.
        note: what they are, and what to see in them.
        calibrated: which constants were set for numbers that they then meet; shown in a box of its own.
        curves: drawn under the numbers.
        families: of one course each, drawn for all points of a sweep over each other.
        over_studies: of one course each, drawn for all studies of one point over each other.
        maps: of the first study with them, at its first point.
        solves: by words for a solve, the variable of each column that holds its `status.Code`.
    """

    columns: tuple[str, ...]
    rows: Mapping[str, tuple[str, ...]]
    note: str
    calibrated: str = ""
    curves: tuple[Curves, ...] = ()
    families: tuple[Curves, ...] = ()
    over_studies: tuple[Curves, ...] = ()
    maps: tuple[Maps, ...] = ()
    solves: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Publication:
    """Formulas that only the cases of a publication need.

    Attributes:
        name: key of its bibliography entry, which a case gives as its `source`.
        readings: each gives values by the name of their variable; as places, loaded when they are read.
        variables: of the readings.
        beside: those that the report sets beside each other; none for most.
        courses: dimension of each reading that is a course, by name.
        answers: readings that it is about, for the answer at the top.
        sections: of the report that show what the publication is about; a reader opens the others. All
            are open where none is named.
        stiffness: on which stiffness of the teeth its formulas run, told beside that of the library; empty
            where they run on that or on none.
    """

    name: str
    readings: tuple[Reading | str, ...] = ()
    variables: Mapping[str, Variable] = field(default_factory=dict)
    beside: tuple[Beside, ...] = ()
    courses: Mapping[str, str] = field(default_factory=dict)
    answers: tuple[str, ...] = ()
    sections: tuple[str, ...] = ()
    stiffness: str = ""

    def __post_init__(self) -> None:
        if taken := [
            key
            for key, variable in self.variables.items()
            if VARIABLES.get(key, variable) != variable
        ]:
            raise ValueError(
                f"{self.name} calls others by names that are taken: {', '.join(taken)}"
            )
        VARIABLES.update(self.variables)

    def read(self, point: ReadingPoint) -> Read:
        """Values of all readings at a point."""
        functions = (
            code_at(source) if isinstance(source, str) else source for source in self.readings
        )
        parts = [reading(point) for reading in functions]
        return {name: value for part in parts for name, value in part.items()}
