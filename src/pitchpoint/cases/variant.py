"""A case file in one variant, which can be built again with changed values."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from pitchpoint.cases.build import check_alone
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.document import Document, resolve
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.keys import usual_at
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.stages import as_spelt, ready
from pitchpoint.cases.validation import validate, with_meshes
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.families import build_together
from pitchpoint.lubrication.lubrication_registry import ChosenLaws

__all__ = [
    "Variant",
]


P = ParamSpec("P")
T = TypeVar("T")

_TOLD = ("targets", "issues", "studies", "study", "optimise")


@dataclass(frozen=True)
class Variant:
    """A case file in one variant, with the means to build it again with changed values.

    Attributes:
        tree: tables of the file.
        name: of the file or of the shipped case, for messages.
        variant: one of those in the file.
        settings: values by dotted key that replace those of the file.
        own: friction laws in place of those of the case, if any is the user's own.
        recorded: name of the case whose record the file is; empty where it is the case itself.
        warnings: about the record.
        folder: of the case file, where files that settings name are looked for.
    """

    tree: Mapping[str, Any]
    name: str
    variant: str
    settings: Mapping[str, Any] = field(default_factory=dict)
    own: ChosenLaws = ()
    recorded: str = ""
    warnings: tuple[str, ...] = ()
    folder: Path | None = None

    @property
    def label(self) -> str:
        """Name of the case in its results."""
        return self.recorded or self.name

    def document(self, **changes: Any) -> Document:
        """Plain values with further settings."""
        return resolve(
            dict(self.tree),
            name=self.name,
            variant=self.variant,
            settings={**self.settings, **changes},
            folder=self.folder,
            usual=usual_at,
        )

    @cached_property
    def computed(self) -> "Variant":
        """The tables that a point is computed from, without targets and studies: a sweep reads them often."""
        return replace(self, tree=_without(self.tree))

    def built(self, changes: Mapping[str, Any]) -> Ready:
        """Case with some values changed."""
        return ready(*self._read(changes), self.own, advised=not changes)

    def built_each(self, changes: Sequence[Mapping[str, Any]]) -> list[Ready | InputError]:
        """Cases with some values changed, or what is wrong with them; their gears are built together."""
        read = [_or_error(self._read, change) for change in changes]
        build_together(
            (case.gears, int(case.models.slices))
            for case, _ in (loaded for loaded in read if not isinstance(loaded, InputError))
            if isinstance(case, CaseFile)
        )
        return [
            loaded if isinstance(loaded, InputError) else _or_error(self._ready, *loaded)
            for loaded in read
        ]

    def _read(self, changes: Mapping[str, Any]) -> tuple[CaseFile | DriveCase, Document]:
        """Case with some values changed, and the document that it is from."""
        document = (self.computed if changes else self).document(**changes)
        try:
            spelt_out = with_meshes(document)
            return validate(spelt_out), spelt_out
        except InputError as error:
            wrong = Complaints(document.name)
            wrong.add(as_spelt(error, document))
            if not changes:
                check_alone(document, wrong)
            raise wrong.error from None

    def _ready(self, case: CaseFile | DriveCase, document: Document) -> Ready:
        return ready(case, document, self.own, advised=False)


def _or_error(make: Callable[P, T], *given: P.args, **named: P.kwargs) -> T | InputError:
    try:
        return make(*given, **named)
    except InputError as error:
        return error


def _without(tree: Mapping[str, Any]) -> dict[str, Any]:
    plain = {key: value for key, value in tree.items() if key not in _TOLD}
    overlays = plain.get("variants", {})
    if isinstance(overlays, dict):
        plain["variants"] = {
            name: {key: value for key, value in overlay.items() if key not in _TOLD}
            if isinstance(overlay, dict)
            else overlay
            for name, overlay in overlays.items()
        }
    return plain
