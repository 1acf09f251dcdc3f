"""Studies of a case: points with changed values, and sweeps."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress, Several, Subject, Unasked
from pitchpoint.analyses.main_figures import by_law, json_figures
from pitchpoint.analyses.strength import ratings_of
from pitchpoint.analyses.summaries import (
    figures_beside_cycle,
    joined_points,
    single_meshes,
    summaries,
)
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.document import leaves
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.study_tables import Study, Sweep
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import Complaints, InputError, shorten
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import has
from pitchpoint.input.quantities import Pair, Quantity, SIValue, shown
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.publication_registry import PUBLICATIONS
from pitchpoint.registry import code_at
from pitchpoint.units import si_unit

if TYPE_CHECKING:
    from pitchpoint.dynamics.pair_vibration import Vibrating

__all__ = [
    "PREFIX",
    "STUDIES",
    "SWEPT",
    "demand_one",
    "is_study",
    "more_of",
    "refuse_film_sweep",
    "sweep_values",
]


PIECE = 256
"""Points of a sweep that are kept on disk together."""

PREFIX = "study_"
"""Names of parts that are studies begin with it."""

SWEPT = (
    "gears",
    "stages",
    "materials",
    "lubricant",
    "roughness",
    "operation",
    "strength",
    "film",
    "worn",
    "formulas",
)
"""Tables whose values may be swept; rival models stand side by side as a list in [models]."""


@dataclass(frozen=True)
class _Planned:
    """A study of a case: points with values of their own.

    Attributes:
        subject: the case.
        name, title: of the study.
        changes: of each point, by dotted key.
        swept: key of the axis; empty without one.
        told: attributes on the axis.
        where: key of the study, for messages.
    """

    subject: Subject
    name: str
    title: str
    changes: list[Mapping[str, Any]]
    swept: str
    told: Mapping[str, str]
    where: str

    @property
    def analysis(self) -> Analysis:
        """The study as a part of the result."""
        return Analysis(
            name=f"{PREFIX}{self.name}",
            title=self.title,
            compute=self.compute,
            pieces=lambda _: self.pieces,
            joined=lambda _, parts: joined_points(parts),
        )

    @property
    def pieces(self) -> list[Piece]:
        """Ranges of points."""
        count = len(self.changes)
        # Formulas that take inputs of their own solve motions and films.
        size = 1 if any(key.startswith("formulas.") for key in self.changes[0]) else PIECE
        return [{"first": n, "stop": min(n + size, count)} for n in range(0, count, size)]

    def compute(self, _: Ready, piece: Piece, progress: PieceProgress) -> xr.Dataset:
        """Figures of a range of points."""
        changes = self.changes[piece["first"] : piece["stop"]]
        points = self.points(changes)
        under = points[0].models
        extra = {**self._axis(changes), **more_of(points, len(under), changes[0])}
        data = summaries(points, under, extra, progress, title=self.title, several=True)
        if "out_of_range" in data:  # a warning says why
            data["extrapolated"] = data["out_of_range"] != ""
            data = data.drop_vars("out_of_range")
        data.attrs.update(self.told)
        if self.told.get("axis_kind"):
            units = si_unit(self.told["axis_kind"])
            data["axis"].attrs.update(units=units, long_name=self.swept)
        return data

    def _axis(self, changes: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        values = [_number(change[self.swept]) for change in changes if self.swept]
        return {"axis": (("point",), np.array(values))} if self.swept else {}

    def points(self, changes: Sequence[Mapping[str, Any]]) -> list[Ready]:
        """Cases with the changes of points.

        Raises:
            InputError: what is wrong with the first one that cannot be built, with study and value.
        """
        return [
            _point(case, change, self.where, self.swept)
            for case, change in zip(self.subject.variant.built_each(changes), changes, strict=True)
        ]

    def demand_ends(self) -> None:
        """InputError for what is wrong with the first point or the last."""
        self.points([*self.changes[:1], *self.changes[1:][-1:]])


def more_of(points: Sequence[Ready], laws: int, keys: Collection[str]) -> dict[str, Any]:
    """Figures of points beside those of their cycle: their strength, of gears as made, of their source.

    Args:
        points: designs of one case.
        laws: of friction.
        keys: of the case that the points change.
    """
    made_figures = code_at("pitchpoint.analyses.made_gears:made_figures")
    return {
        **figures_beside_cycle(points),
        **ratings_of(points, laws),
        **made_figures(points, laws, keys),
        **readings_of(points, laws),
    }


def readings_of(points: Sequence[Ready], laws: int) -> dict[str, Any]:
    """Variables [law, point] or [point, place] that belong to the source of a case; none for most."""
    source = points[0].case.source
    meshes = single_meshes(points)
    if source not in PUBLICATIONS or not meshes:
        return {}
    read, courses = PUBLICATIONS[source].read, PUBLICATIONS[source].courses
    readings = [read(_at(point)) for point in meshes]

    def variable(name: str) -> tuple[tuple[str, str], np.ndarray]:
        values = np.array([reading[name] for reading in readings])
        if name in courses:
            return ("point", courses[name]), values
        return ("law", "point"), np.array([values] * laws)

    return {name: variable(name) for name in readings[0]}


def _at(point: Built) -> ReadingPoint:
    """What the formulas of a publication are read at."""
    case = point.case
    vibrates = case.dynamics is not None and has(point.design.mesh, line_of_action)
    return ReadingPoint(
        gears=case.gears,
        design=point.design,
        operation=point.operation,
        formulas=case.formulas,
        models=tuple(point.models),
        vibrating=partial(_vibrating, point) if vibrates else None,
    )


def _vibrating(point: Built) -> "Vibrating":
    """Inertia, damping and profile error; the code is imported when formulas ask for them."""
    from pitchpoint.analyses.vibration import vibrating_of

    return vibrating_of(point)


def _planned(subject: Subject, name: str, study: Study, where: str) -> _Planned:
    title = study.title or name
    fixed = {key: value for key, value in leaves(study.change) if value != {}}
    if study.sweep is None:
        return _Planned(subject, name, title, [fixed], "", {}, where)
    variant, key = subject.variant, study.sweep.key
    where = where if where.startswith("--") else f"{where}.sweep"
    values, kind = sweep_values(study.sweep, where, variant.name, variant.document().tree)
    demand_one(variant, study.sweep, where)
    refuse_film_sweep(subject.built, variant, key, where)
    attributes = {
        "sweep_key": key,
        "axis_kind": kind.kind if kind else "",
        "axis_unit": kind.unit if kind else "",
    }
    changes: list[Mapping[str, Any]] = [{**fixed, key: value} for value in values]
    return _Planned(subject, name, title, changes, key, attributes, where)


def _studies(subject: Subject) -> Iterator[Analysis]:
    """All studies of a case; InputError for the ends of a sweep."""
    of_case, extra = subject.built.case.studies, subject.studies
    for name in of_case.keys() & extra.keys():
        sentence = "is a study of the case already"
        raise InputError(sentence, file=subject.variant.name, key=f"studies.{name}")
    every = [(name, study, f"studies.{name}") for name, study in of_case.items()]
    every += [(name, study, "--sweep") for name, study in extra.items()]
    wrong = Complaints()
    for named_study in every:
        planned = wrong.tried(_sound, subject, *named_study)
        if planned is not None:
            yield planned.analysis
    wrong.demand_none()


def _sound(subject: Subject, name: str, study: Study, where: str) -> _Planned:
    """A study whose first point and last can be built; InputError for another."""
    planned = _planned(subject, name, study, where)
    planned.demand_ends()
    return planned


def _unasked(built: Ready) -> str | None:
    return None if built.case.studies else Unasked("the case has no [studies]")


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    studies = {name.removeprefix(PREFIX): data for name, data in parts.items() if is_study(name)}
    return {"studies": {name: by_law(data, json_figures(data)) for name, data in studies.items()}}


def is_study(part: str) -> bool:
    """True for the name of a part that is a study."""
    return part.startswith(PREFIX)


def demand_one(variant: Variant, sweep: Sweep, where: str) -> None:
    """InputError if one number would be swept over two gears to which the case gives different ones."""
    value: Any = variant.document().tree
    for part in sweep.key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    several = isinstance(value, list | tuple) and len(set(map(str, value))) > 1
    if several and any(not isinstance(number, list | tuple) for number in sweep.values or (0,)):
        raise InputError(
            f"{sweep.key} has different values for gear 1 and gear 2, {shown(value)}, and one number would "
            f"set both; sweep {sweep.key}.1 or {sweep.key}.2",
            file=variant.name,
            key=where,
        )


def refuse_film_sweep(built: Ready, variant: Variant, key: str, where: str) -> None:
    """InputError if choices of films are swept of a case whose figures come from formulas."""
    if key.startswith("film.") and all(law.films is None for law in built.laws):
        raise InputError(
            f"{key} decides about the friction of solved films, and no law of the case is that of them; "
            'name "ehl_line" in models.friction',
            file=variant.name,
            key=where,
        )


def _point(
    built: Ready | InputError, changes: Mapping[str, Any], where: str, swept: str = ""
) -> Ready:
    """Case with the changes of a study; what is wrong with it is told with study and value."""
    if not isinstance(built, InputError):
        return built
    at = f"at {swept} = {_told(swept, changes[swept])}: " if swept else ""
    inside = f"{shorten(built.key, 160)}: " if built.key and built.key != swept else ""
    message = f"{at}{inside}{built.message}"
    raise InputError(message, file=built.file, key=where, value=changes.get(swept))


def _told(key: str, value: Any) -> str:
    quantity = quantity_at(key)
    return quantity.show(value) if quantity and isinstance(value, float) else shown(value)


def sweep_values(
    sweep: Sweep, where: str, name: str, tree: Mapping[str, Any]
) -> tuple[list[Any], Any]:
    """Values of a sweep, numbers in SI, and their kind.

    Args:
        sweep: as given.
        where, name: key and file, for messages.
        tree: plain values of the case.

    Raises:
        InputError: an unknown key, or a value that the key does not take.
    """
    try:
        quantity = quantity_at(sweep.key, tree)
        if sweep.key.partition(".")[0] not in SWEPT:
            raise InputError(f"cannot be swept; keys of {', '.join(SWEPT)} can")
        if sweep.values is not None:
            if quantity is None:
                return list(sweep.values), None
            return [_read(quantity, value) for value in sweep.values], quantity
        if quantity is None:
            raise InputError(
                "is no number; a study in the case file takes values in place of start and stop"
            )
        ends = quantity.read(sweep.start), quantity.read(sweep.stop)
        grid = np.linspace(*ends, int(sweep.count))
        return [SIValue(value) for value in (np.round(grid) if quantity.whole else grid)], quantity
    except InputError as error:
        raise error.at(file=name, key=f"{where}: {shorten(sweep.key)}") from None


def _read(quantity: Quantity, value: Any) -> Any:
    """Value in SI, or a list of two for the two gears."""
    if isinstance(value, list | tuple):
        return [SIValue(number) for number in Pair(quantity).read(value)]
    return SIValue(quantity.read(value))


def _number(value: Any) -> float:
    """Place on the axis of a sweep: the number itself, or that of gear 1."""
    number = value[0] if isinstance(value, list | tuple) and value else value
    return float(number) if isinstance(number, int | float) else np.nan


STUDIES = Several(
    name="studies",
    title="studies and sweeps",
    of="drive",
    lacks=_unasked,
    figures=_figures,
    each=_studies,
)
