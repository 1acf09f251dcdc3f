"""Checking a case: everything that is wrong with it, or what warns before it is computed."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from pitchpoint.cases.document import variants
from pitchpoint.cases.library import find_case
from pitchpoint.cases.record import is_record, is_result
from pitchpoint.core.doubts import Doubt, as_doubt, of_designs
from pitchpoint.errors import CollectedInputError, InputError
from pitchpoint.runs.case import Case
from pitchpoint.runs.optimise import demand_optimiser
from pitchpoint.runs.run import forewarned
from pitchpoint.runs.study import demand_study

__all__ = ["check_case"]


def check_case(
    case: str, only: Sequence[str] = (), settings: Mapping[str, Any] | None = None
) -> list[str]:
    """What fails and what warns of a case before it is computed, the former first.

    What is so of some variants alone has their names.

    Args:
        case: name of a shipped case, a file, or a result.
        only: variants to check; all by default.
        settings: values by dotted key that replace those of the file.

    Raises:
        InputError: what is wrong in any of the variants, each thing once; a `CollectedInputError` of
            several.
    """
    sentences_of: dict[str, dict[Doubt, list[str]]] = {"implausible": {}, "warnings": {}}
    wrong: dict[str, dict[str, InputError]] = {}
    checked = only or [*_variants(case)]
    for name in checked:
        try:
            for kind, sentences in forewarned(case, [name] if name else (), settings).items():
                for text in map(as_doubt, sentences):
                    sentences_of[kind].setdefault(text, []).append(name)
            if name:
                one_variant = Case(case, variant=name).set(settings or {})
                demand_study(one_variant)
                demand_optimiser(one_variant)
        except InputError as error:
            every = error.errors if isinstance(error, CollectedInputError) else (error,)
            for fault in every:
                wrong.setdefault(str(fault), {})[name] = fault
    if wrong:
        located = [*_located(wrong.values(), checked)]
        raise located[0] if len(located) == 1 else CollectedInputError(located)
    return [
        text if len(names) == len(checked) else of_designs(text, " and ".join(names))
        for of_kind in sentences_of.values()
        for text, names in of_kind.items()
    ]


def _located(
    wrong: Iterable[Mapping[str, InputError]], checked: Sequence[str]
) -> Iterator[InputError]:
    """What is wrong, as `FILE@VARIANT` where only some variants of a file have it."""
    for by_variant in wrong:
        error = next(iter(by_variant.values()))
        alone = error.file and len(by_variant) < len(checked)
        yield error.at(file=f"{error.file}@{' and @'.join(by_variant)}") if alone else error


def _variants(case: str) -> Iterator[str]:
    """Variants of a case; an empty name for those of a result, which are checked together."""
    yield from ("",) if is_result(case) or is_record(case) else variants(find_case(case)[1])
