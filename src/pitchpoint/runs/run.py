"""Running a case: every part is on disk, whole, as soon as it is computed, and is not computed twice."""

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import xarray as xr

from pitchpoint._jax import double_precision, jax
from pitchpoint.analyses.analysis import Piece, Unasked
from pitchpoint.analyses.analysis_registry import ANALYSES, DUTY
from pitchpoint.analyses.comparison import compare, demand_parts
from pitchpoint.analyses.plausibility import unlikely
from pitchpoint.analyses.strength import STRENGTH
from pitchpoint.analyses.studies import is_study
from pitchpoint.cases import resolved_inputs
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import BuiltTrain, Ready
from pitchpoint.cases.document import STAGES, Document
from pitchpoint.cases.handed_over import FILES, write_case_copy
from pitchpoint.cases.library import case_names
from pitchpoint.cases.loss_sets import set_sources
from pitchpoint.cases.record import CASE, MANIFEST, OUTPUT, RUN, Manifest, Record, is_record
from pitchpoint.cases.study_tables import Study
from pitchpoint.cases.validation import validate
from pitchpoint.cases.variant import Variant
from pitchpoint.citations import citation_text
from pitchpoint.core.doubts import as_doubt, concerns, doubts_of, ranked_doubts
from pitchpoint.core.programs import bound_programs, surroundings
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.efficiency.drag_tables import Loss
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS, BREAKAWAY, TOOTH_TEMPERATURE
from pitchpoint.errors import InputError, shorten
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import has
from pitchpoint.loading.loading_registry import LINE_STIFFNESS, LOAD_SHARING, TOOTH_COMPLIANCE
from pitchpoint.lubrication.conditions import law_arguments
from pitchpoint.lubrication.ehl.ehl_registry import ASPERITIES, ISOTHERMAL, SMOOTH, THERMAL
from pitchpoint.lubrication.lubrication_registry import (
    FILM_THICKNESS,
    INLET_HEATING,
    ROLLING_RESISTANCE,
    ChosenLaws,
    FrictionLaw,
)
from pitchpoint.materials.materials_registry import DENSITY, SHEAR_STRESS, VISCOSITY
from pitchpoint.published.publication_registry import publication_of
from pitchpoint.registry import letters, nearest
from pitchpoint.results.by_stage import Label
from pitchpoint.results.store import (
    fingerprint,
    load,
    make_folder,
    save,
    sole_writer,
    sweep,
    without_nan,
    write_text,
)
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.runs.case import Case, CaseLike, as_case, selected_variants
from pitchpoint.runs.jobs import Job, chosen_jobs, job_of, jobs, with_parts_read
from pitchpoint.runs.python_values import demand_arguments

if TYPE_CHECKING:
    from pitchpoint.lubrication.ehl.model import FilmModel

__all__ = [
    "FrictionChoice",
    "Outcome",
    "Progress",
    "mark_of",
    "open_outcomes",
    "pieces_of",
    "run_case",
    "run_piece",
    "run_variant",
    "with_user_law",
    "write_results",
]

FrictionChoice = Callable[..., Any] | Sequence[str | Callable[..., Any]]
"""A friction law of the user's own, or several laws, of one's own and by name."""


LONGEST_LIST = 400
"""Longest list of parts in a repr [characters]."""


class Progress:
    """What a caller may want to hear; this one is silent."""

    def expect(self, parts: int) -> None:
        """So many parts more are to come."""

    def part(self, variant: str, title: str, reused: bool) -> None:
        """A part begins, or is read from disk."""

    def points(self, done: int, doing: str = "") -> None:
        """Points of the part that are finished, and what is being done where they take long."""


class _Made:
    """The manifest of an outcome, given as it is or as what makes it when it is first asked for."""

    def __get__(self, entry: "Outcome | None", owner: type) -> dict[str, Any]:
        if entry is None:
            raise AttributeError("manifest")  # by this a dataclass knows that it has no default
        held = vars(entry)["manifest"]
        if callable(held):
            held = vars(entry)["manifest"] = held()
        manifest: dict[str, Any] = held
        return manifest

    def __set__(self, entry: "Outcome", given: dict[str, Any] | Callable[[], Any]) -> None:
        vars(entry)["manifest"] = given


@dataclass
class Outcome:
    """One variant of a case with its results.

    Attributes:
        manifest: title, inputs in SI, what is implausible, warnings, laws, sources, issues, printed against
            computed; or a function that makes it, called when it is first asked for.
        parts: datasets by name.
        doubts: sentences that were told of it, of which the manifest keeps those that are felt.
    """

    manifest: _Made = _Made()
    parts: dict[str, xr.Dataset] = field(default_factory=dict)
    doubts: list[str] = field(default_factory=list)

    def __repr__(self) -> str:
        summary = f"{len(self.manifest['warnings'])} warnings, {len(self.rows)} rows compared"
        title, listed = shorten(str(self.manifest["title"])), ", ".join(self.parts)
        return f"Outcome({title!r})\n  {summary}\n  parts {shorten(listed, LONGEST_LIST)}"

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "manifest": self.manifest}  # laws of the user's own cannot be pickled

    @property
    def rows(self) -> list[TargetRow]:
        """Printed against computed."""
        return [TargetRow(**row) for row in self.manifest["rows"]]

    def tell(self, sentences: Sequence[str]) -> None:
        """Add sentences to what is implausible, and to the warnings: as far as parts are there for them."""
        self.doubts += sentences
        there = {str(name) for part in self.parts.values() for name in part}
        by_kind = ranked_doubts(text for text in self.doubts if concerns(text, there))
        briefs = [as_doubt(text).brief for sentences in by_kind.values() for text in sentences]
        self.note(**by_kind, briefs=briefs)

    def note(self, **entries: Any) -> None:
        """Put entries into the manifest, which is not made for it."""
        held = vars(self)["manifest"]
        self.manifest = partial(_noted, held, entries) if callable(held) else held | entries


def _noted(make: Callable[[], dict[str, Any]], entries: Mapping[str, Any]) -> dict[str, Any]:
    return {**make(), **entries}


@double_precision()
def run_case(
    case: CaseLike,
    *,
    folder: str | Path | None = None,
    only: Sequence[str] = (),
    analyses: Sequence[str] | None = None,
    settings: Mapping[str, Any] | None = None,
    studies: Mapping[str, Study] | None = None,
    friction: FrictionChoice | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> dict[str, Outcome]:
    """Compute all parts of a case; arguments and errors are those of `pitchpoint.run`.

    Args:
        case: may be the folder of a result too, which repeats that result.

    Returns:
        Outcomes by variant, without tables and figures.
    """
    demand_arguments(
        folder=folder, analyses=analyses, studies=studies, friction=friction, overwrite=overwrite
    )
    source = case if isinstance(case, str) else as_case(case)
    laws, named = _chosen(friction)
    variants = selected_variants(source, only, {**(settings or {}), **named}, laws)
    work = {
        variant.variant: (variant, _jobs(variant, studies or {}, analyses)) for variant in variants
    }
    where = None if folder is None else Path(folder)
    watching = progress or Progress()
    watching.expect(sum(len(parts) for _, parts in work.values()))
    mine = None if where is None else _record(source, variants[0], where, [*work])
    with nullcontext() if mine is None or where is None else _own_folder(where, mine, overwrite):
        return {
            name: run_variant(
                *prepared,
                folder=None if where is None else where / name,
                studies=studies or {},
                progress=watching,
                whole=analyses is None,
            )
            for name, prepared in work.items()
        }


def _record(case: str | Case, first: Variant, folder: Path, variants: list[str]) -> Record:
    """Record of a case that runs into a folder."""
    origin = case if isinstance(case, str) else case.origin
    if not origin:
        return Record(case=first.label, variants=variants)
    return Record.of(origin, first.label, folder, variants, first.settings)


@contextmanager
def _own_folder(folder: Path, record: Record, overwrite: bool) -> Iterator[None]:
    """Folder of this case and no other, in which no other run writes meanwhile."""
    make_folder(folder)
    with sole_writer(folder) as alone:
        if not overwrite:
            record.demand_own(folder)
        of_variants = [folder / one for one in record.variants]
        for place in (folder, *of_variants, *(one / FILES for one in of_variants)) if alone else ():
            sweep(place)
        record.write(folder)
        yield


def run_variant(
    variant: Variant,
    work: Sequence[Job],
    *,
    folder: Path | None,
    studies: Mapping[str, Study],
    progress: Progress,
    whole: bool = True,
) -> Outcome:
    """Compute all parts of one variant; finished parts found in the folder are read.

    Where they are not the `whole` of the case, nobody asks why it lacks others.
    """
    built = work[0].built if work else variant.built({})
    rows = resolved_inputs.input_rows(built, variant.document(), studies)
    outcome = Outcome(partial(_manifest, variant, built, rows))
    if whole:
        outcome.note(lacks=_lacking(built))
    outcome.tell(_of_design(variant, built))
    if folder is not None:
        _hand_over(variant, outcome.manifest["title"], folder, studies)
    for job in work:
        mark = _mark(variant, built, rows, job.name)
        if beside := [*_beside(job, outcome.parts)]:
            mark = fingerprint(mark, beside)  # parts that there were not before count
        part = _part(job, variant, mark, folder, progress, outcome.parts)
        outcome.parts[job.name] = part
        if not is_study(job.name):
            outcome.tell([*doubts_of(part.attrs), *unlikely(built, outcome.parts)])
        _note(outcome, folder, finished=False)
    outcome.note(rows=[row.as_json() for row in _rows(built, variant, outcome.parts)])
    _note(outcome, folder, finished=True)
    if folder is not None:
        for left in _LEFT:
            _drop_pieces(folder, left)
    return outcome


_LEFT = ("study_*", "loss_map", "four_quadrants")
"""Parts of which pieces are dropped that were not asked for again."""


def mark_of(variant: Variant, part: str) -> str:
    """Digest of all that decides about a part of that name which no case asks for."""
    built = variant.built({})
    return _mark(variant, built, resolved_inputs.input_rows(built, variant.document()), part)


def _of_design(variant: Variant, built: Ready) -> list[str]:
    """What is doubtful before anything is computed."""
    return [*variant.warnings, *built.warnings, *built.heated]


def with_user_law(variant: Variant, friction: FrictionChoice) -> Variant:
    """The variant under friction laws of the user's own, with others by name."""
    laws, named = _chosen(friction)
    return replace(variant, own=laws, settings={**variant.settings, **named})


def _hand_over(variant: Variant, title: str, folder: Path, studies: Mapping[str, Study]) -> None:
    """Leave the case as it is run beside its results; none holds a friction law of the user's own."""
    if variant.own:
        (folder / CASE).unlink(missing_ok=True)
        return
    document = variant.document()
    if not _measured(variant):
        tree = {key: table for key, table in document.tree.items() if key != "targets"}
        document = replace(document, tree=tree)
    write_case_copy(document, folder, title=title, studies=studies)


_LARGEST_OF_OWN = 1.0
"""Friction coefficient beyond which a law of the user's own, for whatever materials, is doubted."""


def _chosen(friction: FrictionChoice | None) -> tuple[ChosenLaws, dict[str, Any]]:
    """Laws among which some are the user's own, and the setting that gives the case those by name."""
    choices = [friction] if callable(friction) else list(friction or ())
    laws = tuple(choice if isinstance(choice, str) else _own(choice) for choice in choices)
    named = [law for law in laws if isinstance(law, str)]
    own_names = [law.name for law in laws if isinstance(law, FrictionLaw)]
    meant = [*map(letters, own_names + named)]
    for name in own_names:
        if meant.count(letters(name)) > 1:
            message = (
                f"two laws are named {shorten(name)}, and results go by name; rename the function"
            )
            raise InputError(message, key="friction")
    return laws if own_names else (), {"models.friction": named} if named else {}


def _own(function: Callable[..., Any]) -> FrictionLaw:
    """A user's function as a law; InputError if it asks for what is no condition, or is not JAX."""
    wanted, _ = law_arguments(function)
    name = getattr(function, "__name__", "own")
    name = "own_law" if name == "<lambda>" else name
    _demand_traceable(function, wanted, name)
    return FrictionLaw(
        name, f"{name}, the user's own", function, (), ({}, 0.0), largest=_LARGEST_OF_OWN
    )


def _demand_traceable(function: Callable[..., Any], wanted: Sequence[str], name: str) -> None:
    """InputError for a law in NumPy or plain Python, which no program can be made of."""
    number = jax.ShapeDtypeStruct((), float)
    try:
        jax.eval_shape(lambda **given: function(**given), **dict.fromkeys(wanted, number))
    except (jax.errors.TracerArrayConversionError, jax.errors.ConcretizationTypeError):
        raise InputError(
            f"the friction law {shorten(name)} works on plain numbers; write it with jax.numpy in place of "
            "numpy and math, and jnp.where in place of if"
        ) from None


def open_outcomes(folder: str | Path) -> dict[str, Outcome]:
    """Outcomes of a folder that `run_case` wrote, by variant.

    Raises:
        InputError: the folder holds no result.
    """
    demand_arguments(folder=folder)
    where = Path(folder)
    if not os.path.isfile(where / RUN):  # be the name longer than any file's
        above = os.path.isfile(where.parent / RUN) and os.path.isdir(where)
        wanted = f"{where.parent}, the folder" if above else "a folder"
        message = f"holds no result of pitchpoint; give {wanted} that pitchpoint run wrote"
        raise InputError(message, file=str(folder))
    paths = {name: where / name / MANIFEST for name in Record.read(where / RUN).variants}
    opened = {name: _opened(path) for name, path in paths.items() if path.is_file()}
    if not opened:
        raise InputError("holds no part yet that a run has finished", file=str(folder))
    return opened


@double_precision()
def write_results(
    outcomes: Mapping[str, Outcome],
    cases: Mapping[str, Variant],
    folder: Path,
    *,
    studies: Mapping[str, Study] | None = None,
    overwrite: bool = False,
) -> None:
    """Write results as a run into a folder does.

    Args:
        outcomes: by variant.
        cases: of which they are, by variant.
        folder: where they go.
        studies: beside those of the cases.
        overwrite: True to replace the results of another case.

    Raises:
        InputError: the folder holds another case, or another run is writing there.
    """
    name = str(next(iter(outcomes.values())).manifest["case"])
    with _own_folder(folder, Record(case=name, variants=[*outcomes]), overwrite):
        for variant, outcome in outcomes.items():
            for part, data in outcome.parts.items():
                save(data, folder / variant / f"{part}.nc")
            title = outcome.manifest["title"]
            _hand_over(cases[variant], title, folder / variant, studies or {})
            _note(outcome, folder / variant, finished=bool(outcome.manifest["finished"]))


@double_precision()
def manifests(result: str) -> list[dict[str, Any]]:
    """Manifests of a result, one for each variant, or of a case that has not been computed.

    Args:
        result: folder that `run_case` wrote, manifest in it, name of a shipped case, or a file.

    Raises:
        InputError: it is none of these.
    """
    folder, shipped = Path(result), result in case_names()
    if is_record(result) and folder.is_file():
        return [Manifest.read(folder).model_dump()]
    if not shipped and not os.path.exists(folder):
        hint = nearest(result, dict.fromkeys(case_names()))
        raise InputError(f"is neither a result nor a case of pitchpoint{hint}", file=result)
    if folder.is_dir() and (not shipped or (folder / RUN).is_file()):
        return [outcome.manifest for outcome in open_outcomes(folder).values()]
    return uncomputed_manifests(result)


@double_precision()
def load_case(
    case: CaseLike, variant: str | None = None, settings: Mapping[str, Any] | None = None
) -> Ready:
    """A case ready for computations of one's own: its design, operating point and inputs.

    Args:
        case: name of a shipped case, a file, or the manifest of a result.
        variant: the first one by default.
        settings: values by dotted key that replace those of the file.

    Raises:
        InputError: anything wrong with the input.
    """
    demand_arguments(variant=variant)
    return selected_variants(case, [variant] if variant else [], settings)[0].built({})


@double_precision()
def uncomputed_manifests(
    case: CaseLike,
    only: Sequence[str] = (),
    *,
    settings: Mapping[str, Any] | None = None,
    studies: Mapping[str, Study] | None = None,
) -> list[dict[str, Any]]:
    """Manifests of a case that has not been computed: inputs, warnings, issues, sources.

    Raises:
        InputError: anything wrong with the input that shows before the computation.
    """
    demand_arguments(studies=studies)
    variants = selected_variants(case, only, settings)
    for variant in variants:
        _jobs(variant, studies or {})  # made, not computed: a wrong study shows now
    built = [(variant, variant.built({})) for variant in variants]
    return [
        _manifest(
            *prepared, resolved_inputs.input_rows(prepared[1], prepared[0].document(), studies)
        )
        | ranked_doubts(_of_design(*prepared))
        for prepared in built
    ]


@double_precision()
def forewarned(
    case: CaseLike, only: Sequence[str] = (), settings: Mapping[str, Any] | None = None
) -> dict[str, list[str]]:
    """What fails of a case by what costs little, the strength of its teeth, and what warns of its design.

    Raises:
        InputError: anything wrong with the input that shows before the computation.
    """
    sentences: list[str] = []
    for variant in selected_variants(case, only, settings):
        _jobs(variant, {})  # made, not computed: a wrong study shows now
        built = variant.built({})
        sentences += [*_of_design(variant, built), *_too_weak(built)]
    return ranked_doubts(sentences)


def _too_weak(built: Ready) -> list[str]:
    """What the teeth do not bear; sound gears say nothing."""
    if STRENGTH.why_not(built):
        return []
    part = STRENGTH.compute(built, {}, _silent)
    return ranked_doubts([*doubts_of(part.attrs), *unlikely(built, {"strength": part})])[
        "implausible"
    ]


def _silent(done: int, doing: str = "") -> None:
    """Progress of what takes no time."""


@double_precision()
def compare_case(
    case: str,
    variant: str | None = None,
    watch: Callable[[Path | None], AbstractContextManager[Progress]] | None = None,
) -> tuple[str, str, list[TargetRow]]:
    """Name, variant and rows of a case with targets: computed afresh, or those that a result of it holds.

    Raises:
        InputError: the case has no targets.
    """
    rows = _kept_rows(case, variant)
    if rows is not None:
        return rows
    variants = selected_variants(case, [variant] if variant else [])
    published = next(
        (option for option in variants if option.variant == "as_published"), variants[0]
    )
    return published.label, published.variant, rows_of(published, watch)


def _kept_rows(case: str, variant: str | None) -> tuple[str, str, list[TargetRow]] | None:
    """What a finished result of these programs says of a variant; None for anything else."""
    if not os.path.isfile(Path(case) / RUN):
        return None
    outcomes = open_outcomes(case)
    name = variant or ("as_published" if "as_published" in outcomes else next(iter(outcomes)))
    outcome = outcomes.get(name)
    if outcome is None or not outcome.rows or not outcome.manifest["finished"]:
        return None
    here = json.dumps(surroundings(), sort_keys=True)
    if json.dumps(outcome.manifest["surroundings"], sort_keys=True) != here:
        return None
    return str(outcome.manifest["case"]), name, outcome.rows


def rows_of(
    made: Variant, watch: Callable[[Path | None], AbstractContextManager[Progress]] | None = None
) -> list[TargetRow]:
    """Rows of a variant with targets: no more is computed than they read.

    Raises:
        InputError: the case has no targets.
    """
    built = made.built({})
    if not built.case.targets:
        message = "has no targets to compare with; give several designs, or a published case"
        raise InputError(message, file=made.name)
    needed = with_parts_read({target.reads for target in built.case.targets})
    work = jobs(made, {})
    demand_parts(built.case.targets, [job.name for job in work], made.name)
    parts: dict[str, xr.Dataset] = {}
    chosen = [job for job in work if job.name in needed]
    with (watch or _unwatched)(None) as progress:
        progress.expect(len(chosen))
        for job in chosen:
            parts[job.name] = _part(job, made, "", None, progress, parts)
    return compare(built.case.targets, parts, made.name)


@double_precision()
def run_piece(
    case: str, description: Piece, *, variant: str | None = None, last: xr.Dataset | None = None
) -> xr.Dataset | None:
    """One piece of a part, computed from its description alone, in whatever process.

    Args:
        case: name of a shipped case, a file, or the manifest of a result.
        description: of the piece, one of those of `pieces_of`.
        variant: the first one by default.
        last: of a march, the piece that was computed last; the one after it is computed.

    Returns:
        The piece; None at the end of a march.

    Raises:
        InputError: anything wrong with the input, or no such part.
        ConvergenceError: a balance that was not found.
    """
    ready = selected_variants(case, [variant] if variant else [])[0]
    job = job_of(ready, str(description.get("analysis", "")))
    with _told_of(ready):
        return job.compute(description) if last is None else job.onward(last)


@double_precision()
def pieces_of(case: str, *, variant: str | None = None) -> list[Piece]:
    """Descriptions of all pieces of a case, each less than 1 kB of plain data, see `run_piece`."""
    ready = selected_variants(case, [variant] if variant else [])[0]
    return [piece for job in jobs(ready, {}) for piece in job.pieces]


@contextmanager
def _unwatched(_: Path | None) -> Iterator[Progress]:
    yield Progress()


def _opened(path: Path) -> Outcome:
    record = Manifest.read(path)
    manifest = record.model_dump() | record.doubts
    publication_of(manifest["source"])  # whose variables the parts may hold
    parts = {name: load(path.parent / f"{name}.nc") for name in manifest["parts"]}
    return Outcome(manifest, parts)


def _mark(variant: Variant, built: Ready, rows: Sequence[resolved_inputs.Row], part: str) -> str:
    """Digest of the inputs of a part, out of their rows: the same for a case and for its record."""
    study = resolved_inputs.STUDIES
    rows = [row for row in rows if row["table"] != DUTY.name or part == DUTY.name]
    of_inputs = [
        [row["table"], row["key"], row["value"]]
        for row in rows
        if row["given"]
        and row["table"] != OUTPUT
        and (row["table"] != study or f"study_{row['key']}.".startswith(f"{part}."))
        and not _names_file(row)
    ]
    # What a function of the user's own gave is nobody else's result, nor that of its next version.
    nonce = uuid4().hex if any(isinstance(law, FrictionLaw) for law in variant.own) else ""
    source = built.case.source
    return fingerprint(surroundings(), source, of_inputs, part, nonce, *_digests(rows))


def _beside(job: Job, before: Mapping[str, xr.Dataset]) -> Iterator[str]:
    """Names of parts that a part has beside the one that it reads."""
    for name, part in before.items():
        if any(variable in part for variable in job.analysis.beside):
            yield name


def _names_file(row: Mapping[str, Any]) -> bool:
    """True for the name of a file: what it holds counts, see `_digests`, not where it lies."""
    *above, leaf = f"{row['table']}.{row['key']}".split(".")
    return leaf == "file" and bool({"film", "worn", "duty"} & {*above})


def _digests(rows: Sequence[resolved_inputs.Row]) -> list[str]:
    """Digests of files that a case names: what they hold is part of its inputs."""
    return [row["value"] for row in rows if row["key"].split(".")[-1] == "digest"]


def _part(
    job: Job,
    variant: Variant,
    mark: str,
    folder: Path | None,
    progress: Progress,
    before: Mapping[str, xr.Dataset],
) -> xr.Dataset:
    """A part, computed or read; `before` are parts that are there already."""
    labels = {"case": variant.label, "variant": variant.variant, "fingerprint": mark}
    path = None if folder is None else folder / f"{job.name}.nc"
    stored = None if variant.own else _found(path, mark)
    progress.part(variant.variant, job.title, stored is not None)
    if stored is not None:
        if folder is not None:
            _drop_pieces(folder, job.name)  # of a run that was killed while it removed them
        return stored
    bound_programs()  # those of the parts before
    named = [job.analysis.reads] if job.analysis.reads else []
    pieces = [before[name] for name in (*named, *_beside(job, before))]
    for piece in _pieces(job, variant, labels, folder, progress):
        pieces.append(piece)
        progress.points(sum(map(_points, pieces)))
    with _told_of(variant):
        data = job.joined(pieces)
    data.attrs.update(labels)
    _keep(data, path)
    if folder is not None:
        _drop_pieces(folder, job.name)
    return data


def _pieces(
    job: Job, variant: Variant, labels: Mapping[str, str], folder: Path | None, progress: Progress
) -> Iterator[xr.Dataset]:
    """Pieces of a part in order, those on disk read; a march goes on from its last one."""
    previous: xr.Dataset | None = None
    for number in count():
        path = None if folder is None else folder / f"{job.name}.{number:04d}.nc"
        piece = None if variant.own else _found(path, labels["fingerprint"])
        if piece is None:
            with _told_of(variant):
                piece = job.piece(number, previous, progress.points)
            if piece is None:
                return
            piece.attrs.update(labels)
            if job.several:
                _keep(piece, path)
        previous = piece
        yield piece


def _drop_pieces(folder: Path, part: str) -> None:
    for path in folder.glob(f"{part}.[0-9][0-9][0-9][0-9]*.nc"):
        path.unlink()


@contextmanager
def _told_of(variant: Variant) -> Iterator[None]:
    """What is wrong with a case is told with its name."""
    try:
        yield
    except InputError as error:
        raise error.at(file=error.file or variant.name) from None


def _points(piece: xr.Dataset) -> int:
    """Operating points of a piece."""
    dims = ("point", "torque", "speed", "temperature")
    return prod(size for name, size in piece.sizes.items() if name in dims)


def _found(path: Path | None, mark: str) -> xr.Dataset | None:
    """Dataset on disk if it is whole and of these very inputs."""
    if path is None:
        return None
    try:
        data = load(path)
    except InputError:
        return None  # none, not ours, or damaged: computed
    return data if data.attrs.get("fingerprint") == mark else None


def _keep(data: xr.Dataset, path: Path | None) -> None:
    if path is not None:
        save(data, path)


def _note(outcome: Outcome, folder: Path | None, *, finished: bool) -> None:
    outcome.note(parts=list(outcome.parts), finished=finished)
    if folder is not None:
        write_text(
            folder / MANIFEST,
            json.dumps(without_nan(outcome.manifest), indent=1, ensure_ascii=False),
        )


def _jobs(
    variant: Variant, studies: Mapping[str, Study], analyses: Sequence[str] | None = None
) -> list[Job]:
    """Parts of a variant, or those of some names; InputError if a target reads one that the case has not."""
    if analyses is not None:
        return chosen_jobs(variant, studies, analyses)
    prepared = jobs(variant, studies)
    if _measured(variant):
        targets = validate(variant.document()).targets
        demand_parts(targets, [job.name for job in prepared], variant.name)
    return prepared


def _measured(variant: Variant) -> bool:
    """True for the reading of the paper, and for a variant that brings targets of its own."""
    overlay = variant.tree.get("variants", {}).get(variant.variant, {})
    return variant.variant in ("as_published", "default") or "targets" in overlay


def _rows(built: Ready, variant: Variant, parts: Mapping[str, xr.Dataset]) -> list[TargetRow]:
    if not _measured(variant):
        return []
    targets = [
        target
        for target in built.case.targets
        if target.kind == "excluded" or target.reads in parts
    ]
    return compare(targets, parts, variant.name)


def _stages(built: Ready) -> list[dict[str, Any]]:
    """What is known of the stages of a drive; nothing of one mesh alone."""
    if len(built.meshes) < 2:
        return []
    bodies = built.stage_bodies or [""] * len(built.stages)
    stages = [
        _stage(number, SET if stage.trains else named, stage)
        for number, stage, named in zip(built.numbers, built.stages, bodies, strict=True)
    ]
    of_sets = [named for stage in built.stages for named in stage.stage_bodies]
    meshes = zip(built.mesh_labels, built.meshes, strict=True)
    labelled = [(label, mesh) for label, mesh in meshes if label not in built.numbers]
    return stages + [
        _stage(label, named, mesh) for (label, mesh), named in zip(labelled, of_sets, strict=True)
    ]


def _stage(label: Label, bodies: str, built: Built | BuiltTrain) -> dict[str, Any]:
    """Record of a stage, or of a mesh that is one of several in it."""
    point = built.case.operation
    return {
        "number": label,
        "bodies": bodies,
        "members": list(built.case.bodies),
        "driver": built.driver,
        "loaded": built.loaded,
        "motion": built.motion,
        "speed": point.speed,
        "load": point.load,
        "travels": sorted(built.travels),
        **built.period._asdict(),
    }


def _trains(built: Ready) -> list[dict[str, Any]]:
    """Sets of meshes that turn together: their bodies, how these move, and what meshes with what."""
    return [_train(number, train, built) for number, train in built.trains.items()]


def _train(number: int, train: BuiltTrain, built: Ready) -> dict[str, Any]:
    """Record of one of them; rates are for one of its input."""
    meshes = zip(built.mesh_labels, built.meshes, strict=True)
    labels = [
        label for label, mesh in meshes if any(mesh is placed_mesh for placed_mesh in train.meshes)
    ]
    design = train.design
    return {
        "stage": number,
        "speed": train.case.operation.speed,
        "rates": dict(zip(train.case.bodies, train.motion, strict=True)),
        "ends": [design.turned, design.loaded, *design.held],
        "planets": sorted(design.planets),
        "angles": design.angles.tolist()[: train.planets],
        "meshes": [
            {
                "label": label,
                "bodies": list(placed_mesh.bodies),
                "carrier": placed_mesh.carrier,
                "teeth": [abs(teeth) for _, teeth, _ in placed_mesh.link.gears],
                "planet_gear": placed_mesh.planet_gear,
            }
            for label, placed_mesh in zip(labels, design.meshes, strict=True)
        ],
    }


SET = "planetary set"
"""What a stage is whose meshes turn together."""


@double_precision()
def _manifest(
    variant: Variant, built: Ready, rows: Sequence[resolved_inputs.Row]
) -> dict[str, Any]:
    """Record of a variant before its parts; `rows` are those of `inputs.input_rows`."""
    case, document = built.case, variant.document()
    laws, others, meshes = built.laws, _models(built), built.meshes
    return {
        "case": variant.label,
        "variant": variant.variant,
        "surroundings": surroundings(),
        "title": case.title or variant.label,
        "summary": case.summary,
        "source": case.source,
        "inputs": [*rows, *resolved_inputs.following_rows(built)],
        "targets": [
            target.model_dump(mode="json", exclude_unset=True)
            for target in (case.targets if _measured(variant) else ())
        ],
        "own": ", ".join(law.name for law in variant.own if isinstance(law, FrictionLaw)),
        "implausible": [],
        "warnings": [],
        "briefs": [],
        "laws": [{"name": law.name, "title": law.title, "note": law.note} for law in laws],
        "models": [
            {"effect": effect, "name": law.name, "title": law.title, "note": law.note}
            for effect, law in others.items()
        ],
        "designation": " + ".join(dict.fromkeys(mesh.case.gears.designation for mesh in meshes)),
        "family": " + ".join(mesh.case.gears.family for mesh in meshes),
        "driver": built.driver,
        "loaded": built.loaded,
        "members": list(case.bodies),
        "stages": _stages(built),
        "trains": _trains(built),
        "motion": built.motion,
        **meshes[0].period._asdict(),
        "travels": sorted(built.travels),
        "lacks": {},
        "averaging": built.averaging,
        "plastic": any(used.plastic for mesh in meshes for used in mesh.solids),
        "oil": ", ".join(
            dict.fromkeys(mesh.lubricant.title or mesh.lubricant.name for mesh in meshes)
        ),
        "sources": _sources(built, others, document),
        "issues": [issue.model_dump() for issue in case.issues],
        "rows": [],
        "parts": [],
        "finished": False,
    }


def _sources(built: Ready, models: Mapping[str, Any], document: Document) -> list[dict[str, str]]:
    """References behind a case, each once, with what of the case rests on it."""
    meshes = built.meshes
    cited = [(built.case.source, "the case")] if built.case.source else []
    cited += [(key, f"friction {law.name}") for law in built.laws for key in law.sources]
    cited += [
        (key, f"{effect} {law.name}") for effect, law in models.items() for key in law.sources
    ]
    cited += [(key, "gears") for mesh in meshes for key in mesh.case.gears.sources]
    rated = [mesh for mesh in meshes if mesh.case.gears.rated]
    cited += [(key, "strength") for mesh in rated for key in mesh.rated.sources]
    cited += [(key, "losses") for table in _loss_tables(document) for key in set_sources(table)]
    solids = [used.record for mesh in meshes for used in mesh.solids]
    data = [("oil", mesh.lubricant.data()) for mesh in meshes]
    data += [("materials", solid.data()) for solid in solids]
    cited += [
        (datum.source, of) for of, values in data for datum in values.values() if datum.source
    ]
    uses: dict[str, dict[str, None]] = {}
    for key, of in cited:
        uses.setdefault(key, {})[of] = None
    return [
        {"key": key, "text": citation_text(key), "of": ", ".join(of)} for key, of in uses.items()
    ]


def _loss_tables(document: Document) -> list[Any]:
    """Tables of losses as the case file has them: its own and those of its stages."""
    stages = document.tree.get(STAGES, {})
    return [table.get("losses") for table in (document.tree, *stages.values())]


def _lacking(built: Ready) -> dict[str, str]:
    """By analysis why its part does not exist, those left out that a case file does not ask for."""
    reasons = {name: analysis.why_not(built) for name, analysis in ANALYSES.items()}
    return {name: why for name, why in reasons.items() if why and not isinstance(why, Unasked)}


def _models(built: Ready) -> dict[str, Any]:
    """Models that the case uses beside friction, by effect; with the stage where they differ."""
    of_meshes = [_of_mesh(mesh) for mesh in built.meshes]
    bearings = _bearings(built.case.losses)
    shared = {
        effect: law for effect, law in of_meshes[0].items() if _everywhere(effect, law, of_meshes)
    }
    for label, models in zip(built.mesh_labels, of_meshes, strict=True):
        apart = {effect: law for effect, law in models.items() if effect not in shared}
        shared |= {f"{effect}, stage {label}": law for effect, law in apart.items()}
    return {**shared, **bearings}


def _everywhere(effect: str, law: Any, each: Sequence[Mapping[str, Any]]) -> bool:
    return all(models.get(effect) is law for models in each)


def _bearings(losses: Mapping[str, Loss]) -> dict[str, Any]:
    """Models of bearings and of what holds them at rest, by name of their place."""
    moving = {
        name if name.endswith("bearing") else f"bearing {name}": BEARING_LOSS[loss.bearing]
        for name, loss in losses.items()
    }
    held = {f"breakaway {name}": BREAKAWAY[loss.breakaway] for name, loss in losses.items()}
    every: dict[str, Any] = {**moving, **held}
    return {
        effect.replace("_", " "): model for effect, model in every.items() if model.name != "none"
    }


def _of_mesh(built: Built) -> dict[str, Any]:
    """Models of one mesh, by effect."""
    case = built.case
    models: dict[str, Any] = {
        "load sharing": LOAD_SHARING[case.models.load_sharing],
        "rolling resistance": ROLLING_RESISTANCE[case.models.rolling_resistance],
        "film thickness": FILM_THICKNESS[case.models.film_thickness],
    }
    if built.asperities is not None:
        models["asperity load"] = built.asperities
    if case.models.inlet_heating != "none":
        models["inlet heating"] = INLET_HEATING[case.models.inlet_heating]
    if case.dynamics is not None or models["load sharing"].by_stiffness:
        models["tooth compliance"] = TOOTH_COMPLIANCE[case.models.tooth_compliance]
        if case.models.line_stiffness != "integrated":
            models["stiffness of contact lines"] = LINE_STIFFNESS[case.models.line_stiffness]
    if case.dynamics is not None and has(built.design.mesh, line_of_action):
        models["tooth contact"] = CONTACT_LAWS[case.models.tooth_contact]
    if built.film_model is not None:
        models |= _of_films(built.film_model)
    models |= _bearings(case.losses)
    if case.models.tooth_temperature != "isothermal":
        models["tooth temperature"] = TOOTH_TEMPERATURE[case.models.tooth_temperature]
    return models


def _of_films(model: "FilmModel") -> dict[str, Any]:
    """Models behind films that are solved, by effect."""
    models: dict[str, Any] = {
        "viscosity under pressure": VISCOSITY[model.viscosity_law],
        "density under pressure": DENSITY[model.density_law],
        "shear of the oil": SHEAR_STRESS[model.shear_law],
    }
    if model.thermal != ISOTHERMAL:
        models["heat of the film"] = THERMAL[model.thermal]
    if model.asperities != SMOOTH:
        models["asperities that touch"] = ASPERITIES[model.asperities]
    return models
