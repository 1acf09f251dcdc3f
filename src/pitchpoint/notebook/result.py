"""What `run` gives at a Python prompt: outcomes by variant, with tables, datasets and figures of them."""

import html
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from pitchpoint._jax import double_precision
from pitchpoint.cases.record import MANIFEST
from pitchpoint.cases.study_tables import Study
from pitchpoint.errors import InputError, shorten
from pitchpoint.input.quantities import shown
from pitchpoint.notebook import tables
from pitchpoint.notebook.figures import Plots
from pitchpoint.notebook.gradients import gradients
from pitchpoint.registry import nearest
from pitchpoint.results.chosen_units import Choice, UnitsByKind, shown_in, unit_choice
from pitchpoint.results.labelled import Units, attributes, demand_units, labelled
from pitchpoint.runs import run as runs
from pitchpoint.runs.case import Case, CaseLike, case_value
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import Outcome, Progress
from pitchpoint.views.inputs import recorded_units
from pitchpoint.views.report import write_report
from pitchpoint.views.show import number_text

if TYPE_CHECKING:
    import pandas as pd

    from pitchpoint.runs.joint_model import JointModel

__all__ = ["Result", "open_result", "run"]

_LONGEST_TITLE = 70


class Result(Mapping[str, Outcome]):
    """Outcomes of a case by variant.

    Args:
        outcomes: by variant, at least one.
        origins: by variant what gives its case again.
        friction: laws of the user's own under which they were computed, see `run`.
        studies: beside those of the case.

    Tables and datasets are those of all variants, or of the one that is asked for, by default the first.
    """

    def __init__(
        self,
        outcomes: Mapping[str, Outcome],
        origins: Mapping[str, Callable[[], Case]],
        friction: runs.FrictionChoice | None = None,
        studies: Mapping[str, Study] | None = None,
    ) -> None:
        self._outcomes, self._origins, self._friction = dict(outcomes), origins, friction
        self._studies = studies

    @cached_property
    def _units(self) -> Choice:
        return recorded_units(self._outcomes)  # of the record, which is made when it is asked for

    def __getitem__(self, name: str) -> Any:
        """Outcome of a variant, else the dataset of a part, as `dataset` gives it.

        Raises:
            KeyError: neither.
        """
        if name in self._outcomes:
            return self._outcomes[name]
        try:
            return self.dataset(name)
        except InputError as error:
            raise KeyError(str(error)) from None

    def __getattr__(self, part: str) -> xr.Dataset:
        """Dataset of a part: `result.cycle` is `result.dataset("cycle")`."""
        if part.startswith("_"):
            raise AttributeError(part)
        try:
            return self.dataset(part)
        except InputError as error:
            raise AttributeError(str(error)) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.parts]

    def __contains__(self, variant: object) -> bool:
        return variant in self._outcomes

    def __iter__(self) -> Iterator[str]:
        return iter(self._outcomes)

    def __len__(self) -> int:
        return len(self._outcomes)

    def __repr__(self) -> str:
        with shown_in(self._units):
            lines = [f"{name}: {tables.headline(one)}" for name, one in self.items()]
        return "\n  ".join([f"Result({self.title!r})", *lines, f"parts {', '.join(self.parts)}"])

    def _repr_html_(self) -> str:
        from pandas import option_context

        told = "".join(f"<li>{html.escape(text)}</li>" for text in self.warnings)
        with option_context("display.max_colwidth", None):
            table = self.summary().to_html(na_rep="undefined", border=0, float_format=number_text)
        parts = html.escape(", ".join(self.parts))
        title = f"<strong>{html.escape(self.title)}</strong>"
        return f"<div>{title}{table}<ul>{told}</ul><small>parts: {parts}</small></div>"

    @property
    def title(self) -> str:
        """Of the case."""
        return shorten(str(next(iter(self.values())).manifest["title"]), _LONGEST_TITLE)

    @property
    def parts(self) -> list[str]:
        """Names of the datasets that there are."""
        return [*dict.fromkeys(name for one in self.values() for name in one.parts)]

    @property
    def warnings(self) -> list[str]:
        """Sentences that belong to the results, of all variants."""
        return [*dict.fromkeys(text for one in self.values() for text in one.manifest["warnings"])]

    @property
    def inputs(self) -> "pd.DataFrame":
        """Every input by key: value in SI with its unit, as shown, status, place in print, remark."""
        with shown_in(self._units):
            return tables.frames_by_variant(self, tables.inputs)

    @property
    def plot(self) -> Plots:
        """Figures of the report, by section: `result.plot.cycle()`; `dir(result.plot)` lists them."""
        return self.plot_in(self._units)

    @double_precision()
    def plot_in(self, units: UnitsByKind) -> Plots:
        """The same figures in units by kind of quantity: `result.plot_in("angle=arcmin").torsion()`."""
        with shown_in(unit_choice(units)):
            return Plots(self)

    def summary(self, units: UnitsByKind | None = None) -> "pd.DataFrame":
        """Main figures in the units in which they are shown, a column for each friction law.

        Args:
            units: by kind of quantity, {"angle": "arcmin", "torsional stiffness": "N m/arcmin"}, or the same
                as text, "angle=arcmin"; those of the case by default.
        """
        with shown_in(self._units if units is None else unit_choice(units)):
            return tables.frames_by_variant(self, tables.summary_frame)

    def dataset(self, part: str, *, units: Units = "si", variant: str | None = None) -> xr.Dataset:
        """A part of the result: every dimension with a coordinate, NaN where no teeth touch.

        Args:
            part: one of `parts`; `outcome.parts` has it as it was computed and kept.
            units: "si", those in which values are "shown", or some by kind of quantity, as in `summary`,
                and the others as shown.
            variant: the first one by default.

        Raises:
            InputError: there is no such part, and why.
        """
        demand_units(units)
        with shown_in(self._units):
            return labelled(self._part(part, variant), units)

    def attributes(self, part: str, *, variant: str | None = None) -> dict[str, Any]:
        """Attributes of a part as data: how it was solved, warnings, what it was computed with.

        Attributes of a NetCDF file are texts, numbers and lists of them, as those of `dataset`; nested ones,
        which a file holds as JSON, are dictionaries here.
        """
        return attributes(self._part(part, variant))

    def to_dataframe(
        self, part: str, *, units: Units = "si", variant: str | None = None
    ) -> "pd.DataFrame":
        """A part of the result as a table, a column for each variable; arguments as in `dataset`.

        The units stand in `attrs["units"]`, by column.
        """
        data = self.dataset(part, units=units, variant=variant)
        frame = data.to_dataframe()
        every = {str(name): str(one.attrs.get("units", "")) for name, one in data.variables.items()}
        frame.attrs["units"] = every
        return frame

    def joint_model(
        self, *, law: str | None = None, rotor_inertia: Any = None, variant: str | None = None
    ) -> "JointModel":
        """The drive as a joint of a robot, for simulators, see `JointModel`.

        It rests on the loss map of the output, which `loss_map.quadrants = 4` asks for. `result.joint` is
        something else, the torsional vibration of a case that asks for it.

        Args:
            law: of friction, by name; the first one by default.
            rotor_inertia: of the motor about its own axis, "0.3 kg cm2" or a number [kg m2].
            variant: the first one by default.

        Raises:
            InputError: there is no such map, law or variant.
        """
        from pitchpoint.runs.joint_model import joint_model

        outcome = self.outcome(variant)
        return joint_model(outcome, law=law, rotor_inertia=rotor_inertia)

    def gradients(
        self,
        of: str = "mean_loss",
        by: str | Sequence[str] = (),
        *,
        law: str | None = None,
        variant: str | None = None,
    ) -> "pd.DataFrame":
        """Derivatives of a main figure by the keys of the case file, see `gradients`."""
        return gradients(self.case(variant), of, by, law=law, friction=self._friction)

    def case(self, variant: str | None = None) -> Case:
        """The case of a variant, of the first one by default; KeyError where there is no such variant."""
        return self._origins[variant or next(iter(self))]()

    def write_report(self, path: str | Path, *, units: UnitsByKind | None = None) -> None:
        """Write the report, one HTML file; `units` as in `summary`."""
        write_report(self, path, units=units)

    def save(self, folder: str | Path, *, overwrite: bool = False) -> None:
        """Write the datasets, the case and the record as a run into the folder does.

        Args:
            folder: of the results.
            overwrite: True to replace those of another case.
        """
        cases = {name: case().held[0] for name, case in self._origins.items()}
        if self._friction is not None:
            cases = {name: runs.with_user_law(one, self._friction) for name, one in cases.items()}
        runs.write_results(self, cases, Path(folder), studies=self._studies, overwrite=overwrite)

    def outcome(self, variant: str | None = None) -> Outcome:
        """That of a variant, of the first one by default.

        Raises:
            InputError: there is no such variant.
        """
        name = variant or next(iter(self))
        if name not in self:
            raise InputError(f"{shown(name)} is not a variant of this result{nearest(name, self)}")
        return self._outcomes[name]

    def _part(self, part: str, variant: str | None) -> xr.Dataset:
        outcome = self.outcome(variant)
        if part not in outcome.parts:
            why = outcome.manifest.get("lacks", {}).get(part, "")
            told = f": {why}" if why else nearest(part, outcome.parts)
            raise InputError(f"the result has no part {shown(part)}{told}")
        return outcome.parts[part]


def run(
    case: CaseLike,
    *,
    folder: str | Path | None = None,
    only: Sequence[str] = (),
    analyses: Sequence[str] | None = None,
    settings: Mapping[str, Any] | None = None,
    studies: Mapping[str, Study] | None = None,
    friction: runs.FrictionChoice | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Result:
    """Compute all parts of a case.

    Args:
        case: a `Case`, the name of a shipped case, a file, the manifest of a result, which repeats that
            result, or tables as a case file has them.
        folder: where parts and manifests go; nothing is written without one.
        only: variants to run; all by default.
        analyses: names of the parts to compute, `["operation", "cycle"]`; all that the case has by default.
        settings: values by dotted key that replace those of the case, SI numbers or texts with a unit.
        studies: further studies, as `--sweep` makes them.
        friction: a law of one's own in place of those of the case: a function of JAX arrays whose
            keyword arguments are conditions at a contact, see `pitchpoint.lubrication.conditions`; or
            several laws in a list, of one's own and by name, `[my_law, "xu_2007"]`.
        overwrite: True to replace the results of another case in the folder.
        progress: told about parts and points.

    Returns:
        Outcomes by variant, with tables, datasets and figures of them.

    Raises:
        InputError: anything wrong with the input; the folder holds another case, or another run is
            writing there.
        ConvergenceError: a balance that was not found; what was finished is on disk.
        OSError: the disk is full, say; what was finished is on disk.
    """
    demand_arguments(settings=settings)
    given = {key: case_value(key, value) for key, value in (settings or {}).items()}
    outcomes = runs.run_case(
        case,
        folder=folder,
        only=only,
        analyses=analyses,
        settings=given,
        studies=studies,
        friction=friction,
        overwrite=overwrite,
        progress=progress,
    )
    origins = {one: partial(_case, case, one, given) for one in outcomes}
    return Result(outcomes, origins, friction, studies)


def open_result(folder: str | Path) -> Result:
    """Results of a folder that `run` wrote.

    Raises:
        InputError: the folder holds no result.
    """
    outcomes = runs.open_outcomes(folder)
    records = {one: Path(folder) / one / MANIFEST for one in outcomes}
    return Result(outcomes, {one: partial(_case, path, one, {}) for one, path in records.items()})


def _case(case: CaseLike, variant: str, settings: Mapping[str, Any]) -> Case:
    return Case(case, variant=variant).set(settings)
