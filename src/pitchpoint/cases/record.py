"""What a run leaves beside its datasets: whose folder it is, and a manifest of each variant.

A manifest is a record: it holds the inputs to the last bit, so that its result can be computed again from it
alone. Folders travel between people: what these files hold is checked before it is believed or followed.
"""

import hashlib
import os
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    JsonValue,
    StringConstraints,
    ValidationError,
    model_validator,
)

from pitchpoint import units
from pitchpoint.cases.document import Tree, demand_shallow, set_key
from pitchpoint.cases.library import as_text, case_names, case_path
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.plain_files import content
from pitchpoint.core.programs import surroundings
from pitchpoint.errors import InputError, shorten
from pitchpoint.results.store import write_text
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.results.variable import End

__all__ = [
    "CASE",
    "MANIFEST",
    "OUTPUT",
    "RUN",
    "Manifest",
    "Record",
    "default_folder",
    "folder_record",
    "is_record",
    "is_result",
    "sources_of",
]

MANIFEST = "manifest.json"

CASE = "case.toml"
"""The case as it was run, beside the manifest of a variant."""

OUTPUT = "output"
"""Table of what decides how results are shown, and about no number of them."""

RUN = "run.json"
"""Case and variants of the last run into a folder."""

MAX_BYTES = 50_000_000
"""Largest manifest that is read; real ones have some ten kilobytes."""

# Of a variant or part, and of its folder or file: never a path that leads elsewhere.
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{1,200}$")]
Key = Annotated[str, StringConstraints(max_length=400)]


class _Kept(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid")

    @classmethod
    def read(cls, path: Path) -> Self:
        """Content of a file; InputError for whatever `write` did not write."""
        written = content(path, MAX_BYTES, "record")
        try:
            return cls.model_validate_json(written)
        except ValidationError as error:
            failure = error.errors(include_url=False, include_input=False)[0]
            if failure["type"] in ("missing", "model_type") and path.name not in (MANIFEST, RUN):
                message = "is JSON, and no record of a result; a case file is TOML (pitchpoint new)"
                raise InputError(message, file=str(path)) from None
            message = f"was not written by this version of pitchpoint: {failure['msg']}"
            key = shorten(".".join(map(str, failure["loc"])))
            raise InputError(message, file=str(path), key=key or None) from None


class Record(_Kept):
    """Whose folder it is.

    Attributes:
        case: name of the shipped case or of the file.
        file: way from the folder to the case file, so that both may move; empty for a shipped case.
        variants: of the last run.
        settings: that it was given, in words by dotted key.
    """

    case: str
    file: str = ""
    variants: list[Name]
    settings: dict[Key, str] = {}

    @classmethod
    def of(
        cls,
        case: str,
        name: str,
        folder: Path,
        variants: list[str],
        settings: Mapping[str, Any] | None = None,
    ) -> Self:
        """Record of a case, given by its name or file, that runs into a folder.

        A result that is run again in its own folder stays that of its case.
        """
        words = _in_words(settings or {})
        if is_result(case) and os.path.realpath(case) == os.path.realpath(folder):
            record = cls.read(folder / RUN)
            changed = {"variants": variants, "settings": {**record.settings, **words}}
            return record.model_copy(update=changed)
        return cls(case=name, file=_way(case, folder), variants=variants, settings=words)

    @property
    def mark(self) -> str:
        """What tells one case from another."""
        return self.file or self.case

    def write(self, folder: Path) -> None:
        """Mark the folder as that of this case."""
        write_text(folder / RUN, self.model_dump_json())

    def replaced_by(self, later: "Record | None") -> str:
        """How this run was set, in words, if a later one of its variants was set otherwise; else empty."""
        if later is None or later.settings == self.settings:
            return ""
        if not {*self.variants} & {*later.variants}:
            return ""
        options = " ".join(f"--set {key}={value}" for key, value in self.settings.items())
        return f"with {options}" if options else "without --set"

    def demand_own(self, folder: Path) -> None:
        """InputError if the folder holds results of another case."""
        theirs = folder_record(folder)
        if theirs is not None and theirs.mark != self.mark:
            raise InputError(
                f"holds results of another case, {shorten(theirs.mark)}; give another folder, or"
                " --overwrite (overwrite=True) to replace them",
                file=str(folder),
            )


def _in_words(settings: Mapping[str, Any]) -> dict[str, str]:
    """Settings as texts by dotted key, without those of how results are shown."""
    words = {as_text(key): as_text(str(value)) for key, value in settings.items()}
    return {key: text for key, text in words.items() if key.partition(".")[0] != OUTPUT}


def _known(kind: str) -> str:
    if kind and kind not in units.kinds():
        raise ValueError(f"there is no kind of quantity '{shorten(kind)}'")
    return kind


Kind = Annotated[str, AfterValidator(_known)]


class Input(_Kept):
    """A resolved input.

    Attributes:
        table, key: of the case file.
        value: SI numbers, texts, or lists of them or of tables.
        kind: of the numbers, of `units.kinds()`; by key where the value is a list of tables.
        status, where, note: how it was come by, its place in print, a remark.
        given: False for a default, and for what followed from others.
    """

    table: Key
    key: Key
    value: JsonValue
    kind: Kind | dict[str, Kind]
    status: str
    where: str
    note: str
    given: bool

    @property
    def entry(self) -> dict[str, Any]:
        """The value with its marks, as a case file has them."""
        marks = {"status": self.status, "where": self.where, "note": self.note}
        return {"value": _written(self.value, self.kind), **marks}


def _written(value: Any, kind: Any) -> Any:
    """Numbers with their SI unit: read back, they are the same to the last bit."""
    if isinstance(value, dict):
        kinds = kind if isinstance(kind, dict) else {}
        return {name: _written(item, kinds.get(name, "")) for name, item in value.items()}
    if isinstance(value, list):
        return [_written(item, kind) for item in value]
    unit = units.si_unit(kind) if isinstance(kind, str) and kind else ""
    return f"{value!r} {unit}" if unit and isinstance(value, float) else value


class LawRecord(_Kept):
    """A friction law in use."""

    name: str
    title: str
    note: str


class Model(LawRecord):
    """A model in use for one effect beside friction."""

    effect: str


class Source(_Kept):
    """A reference behind the result; `of` is what rests on it, empty in a record of an older build."""

    key: str
    text: str
    of: str = ""


class PrintedIssue(_Kept):
    """A misprint or a questionable point of the publication."""

    where: str
    issue: str
    verdict: str


class StageRecord(_Kept):
    """What is known of a mesh of a drive.

    Attributes:
        number: of the stage in the file; of a mesh of a planetary set, which come behind, its label.
        bodies: in words, where stages are meshes of a train; else empty.
        speed: of its driver [rad/s or m/s].
        load: that its loaded member carries without losses, of one copy [N m or N].
    """

    number: int | str
    bodies: str
    members: list[str]
    driver: str
    loaded: str
    motion: list[float]
    speed: float
    load: float
    period: float
    pitch: str
    against: str
    travels: list[End]


class TrainMeshRecord(_Kept):
    """A mesh of a set: its label among the stages, its bodies, where its axes sit, its numbers of teeth."""

    label: int | str
    bodies: list[str]
    carrier: str
    teeth: list[float]
    planet_gear: int


class TrainRecord(_Kept):
    """Meshes that turn together.

    Attributes:
        stage: number of the stage of a drive that they are; 0 of a case of them alone.
        speed: of the input [rad/s].
        rates: of the bodies for one of the input.
        ends: bodies that drive, take the load, are held.
        planets: bodies of which there are several.
        angles: at which they stand on their carrier [rad].
    """

    stage: int
    speed: float
    rates: dict[str, float]
    ends: list[str]
    planets: list[str]
    angles: list[float]
    meshes: list[TrainMeshRecord]


class Manifest(_Kept):
    """What a variant was computed from and with, and how far it got.

    Attributes:
        surroundings: versions of the packages that computed it, and of what else decides its last bits.
        own: name of a friction law of the user's own that took the place of those of the case, or empty.
        implausible: sentences on what cannot be, above every number.
        briefs: of these and of the warnings for a screen, see `Doubt`; none in a record of an older build.
        members: body of each coordinate.
        stages: the same of each mesh of a drive by itself, in the order of the power.
        trains: sets of meshes that turn together; none in a record of an older build.
        motion: nominal rate of each coordinate for one radian of the driver.
        period: driver angle after which the mesh repeats [rad].
        pitch: what a period is.
        against: why time runs against the phase of the mesh; empty where it does not.
        travels: which of driver and loaded member travel.
        lacks: by analysis why there is no such part, where the gears are the reason.
    """

    case: str
    variant: Name
    surroundings: dict[str, str]
    title: str
    summary: str
    source: str
    inputs: list[Input]
    targets: list[dict[str, JsonValue]]
    own: str
    implausible: list[str] = []
    warnings: list[str]
    briefs: list[str] = []
    laws: list[LawRecord]
    models: list[Model]
    designation: str = ""
    family: str
    driver: str
    loaded: str
    members: list[str]
    stages: list[StageRecord] = []
    trains: list[TrainRecord] = []
    motion: list[float]
    period: float
    pitch: str = "period"
    against: str = ""
    travels: list[End] = []
    lacks: dict[str, str] = {}
    averaging: str
    plastic: bool
    oil: str
    sources: list[Source]
    issues: list[PrintedIssue]
    rows: list[TargetRow]
    parts: list[Name]
    finished: bool

    @model_validator(mode="after")
    def _moving(self) -> Self:
        if len(self.motion) != len(self.members):
            raise ValueError("motion has not as many rates as there are members")
        for body in (self.driver, self.loaded):
            if body not in self.members:
                raise ValueError(f"'{shorten(body)}' is none of the members")
        if self.briefs and len(self.briefs) != len(self.implausible) + len(self.warnings):
            raise ValueError("briefs are not as many as what is implausible and warnings together")
        return self

    @property
    def doubts(self) -> dict[str, list[Doubt]]:
        """What is implausible, and warnings, with their briefs."""
        briefs = iter(self.briefs)
        return {
            kind: [Doubt(text, brief=next(briefs, "")) for text in getattr(self, kind)]
            for kind in ("implausible", "warnings")
        }

    @property
    def tree(self) -> Tree:
        """Tables of a case file that holds this variant alone.

        Raises:
            InputError: inputs that do not fit together.
        """
        tree: Tree = {key: getattr(self, key) for key in ("title", "summary", "source")}
        for row in self.inputs:
            if row.given:
                set_key(tree, f"{row.table}.{row.key}".removesuffix("."), row.entry)
        demand_shallow(tree, "")
        tree["issues"] = [issue.model_dump() for issue in self.issues]
        if self.targets:
            tree["targets"] = self.targets
        return {"variants": {self.variant: tree}}

    @property
    def warning(self) -> list[str]:
        """That numbers may differ, where something else computes now than did then."""
        here = surroundings()
        others = [name for name in here if self.surroundings.get(name) != here[name]]
        if not others:
            return []
        then, now = (_listed(environment, others) for environment in (self.surroundings, here))
        return [
            Doubt(
                f"The record was made with {then} and is computed with {now}: numbers may differ.",
                brief=f"The record was made with other {' and '.join(others)}: numbers may differ.",
            )
        ]


def _listed(surroundings: Mapping[str, str], names: list[str]) -> str:
    return ", ".join(f"{name} {shorten(surroundings.get(name, '')) or '-'}" for name in names)


def is_record(case: str) -> bool:
    """True if a case is given by the record of a result of it, a manifest."""
    return Path(case).suffix == Path(MANIFEST).suffix


def is_result(case: str) -> bool:
    """True if a case is given by the folder of a result of it."""
    return case not in case_names() and os.path.isfile(os.path.join(case, RUN))


def sources_of(manifests: Iterable[Mapping[str, Any]]) -> list[dict[str, str]]:
    """Sources of several manifests, each once, with all that rests on it."""
    uses: dict[tuple[str, str], dict[str, None]] = {}
    for source in (source for manifest in manifests for source in manifest["sources"]):
        named = uses.setdefault((source["key"], source["text"]), {})
        named.update(dict.fromkeys(filter(None, source.get("of", "").split(", "))))
    return [{"key": key, "text": text, "of": ", ".join(of)} for (key, text), of in uses.items()]


def folder_record(folder: Path) -> Record | None:
    """Whose folder it is; None if nobody's, or if its record cannot be read."""
    try:
        return Record.read(folder / RUN)
    except InputError:
        return None


def default_folder(case: str, root: Path, settings: Mapping[str, Any] | None = None) -> Path:
    """Folder of a case under another: named after the case, by more of its path where that is taken.

    A case finds its own folder again; `b/pair.toml` beside `a/pair.toml` goes to `b-pair`, and
    `pair.toml` with a setting to a folder that names it. A result is run again where it lies.

    Args:
        case: name of a shipped case, a file, or the folder of a result.
        root: folder of all results.
        settings: values by dotted key that replace those of the file.
    """
    if is_result(case) and not settings:
        return Path(case)
    words = _in_words(settings or {})
    parts = _parts(case)
    names_ = ["-".join(parts[-count:]) for count in range(1, len(parts) + 1)]
    folders = [root / f"{name}{_suffix(words)}" for name in names_]
    owners = {folder: folder_record(folder) for folder in folders}
    of_same = [place for place, of in owners.items() if of and _same(of, case, place, words)]
    free = [place for place, of in owners.items() if of is None]
    return [*of_same, *free, *folders][0]


def _parts(case: str) -> tuple[str, ...]:
    """Names from the root down whose last ones name the folder of a case."""
    path = Path(os.path.abspath(case_path(case)))
    if case in case_names() or is_result(case):
        return path.parent.parts[1:] if case in case_names() else path.parts[1:]
    if path.name == CASE and is_result(str(path.parent.parent)):
        return (*path.parent.parent.parts[1:-1], f"{path.parent.parent.name}-{path.parent.name}")
    return (*path.parent.parts[1:], path.stem)


def _same(record: Record, case: str, folder: Path, settings: Mapping[str, str]) -> bool:
    """True if a folder holds the results of a case with the same settings."""
    return record.mark == (_way(case, folder) or case) and record.settings == settings


def _suffix(settings: Mapping[str, str]) -> str:
    """End of the name of a folder that tells settings from any others."""
    if not settings:
        return ""
    words = ",".join(f"{key}={value}" for key, value in settings.items())
    plain = _STRANGE.sub("_", words)
    digest = hashlib.sha256(words.encode()).hexdigest()[:8]
    spaced = _STRANGE.sub("_", words.replace(" ", "_")) == words.replace(" ", "_")
    return f"+{plain}" if spaced and len(plain) <= _LONGEST else f"+{plain[:_LONGEST]}-{digest}"


_STRANGE = re.compile(r"[^A-Za-z0-9_.,=+-]+", re.ASCII)
_LONGEST = 80
"""Characters of the settings in the name of a folder."""


def _way(case: str, folder: Path) -> str:
    if case in case_names():
        return ""
    file = os.path.realpath(case_path(case))
    with suppress(ValueError):  # on another drive
        file = os.path.relpath(file, os.path.realpath(folder))
    return as_text(file)
