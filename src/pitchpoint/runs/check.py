"""Checking a case: everything that is wrong with it, or what warns before it is computed."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pitchpoint.cases.document import variants
from pitchpoint.cases.library import find
from pitchpoint.cases.record import is_record, is_result
from pitchpoint.errors import CollectedInputError, InputError
from pitchpoint.runs.run import describe, foretold

__all__ = ["check"]


def check(
    case: str, only: Sequence[str] = (), settings: Mapping[str, Any] | None = None
) -> list[str]:
    """What fails and what warns of a case before it is computed, the former first.

    Args:
        case: name of a shipped case, a file, or a result.
        only: variants to check; all by default.
        settings: values by dotted key that replace those of the file.

    Raises:
        InputError: what is wrong in any of the variants, each thing once; a `CollectedInputError` of
            several.
    """
    failing: list[str] = []
    warnings: list[str] = []
    wrong: dict[str, InputError] = {}
    for name in only or [*_variants(case)]:
        try:
            chosen = [name] if name else ()
            told = describe(case, chosen, settings=settings)[0]
            failing += told["implausible"] + foretold(case, chosen, settings=settings)
            warnings += told["warnings"]
        except CollectedInputError as error:
            wrong.update((str(one), one) for one in error.errors)
        except InputError as error:
            wrong[str(error)] = error
    if wrong:
        every = list(wrong.values())
        raise every[0] if len(every) == 1 else CollectedInputError(every)
    return list(dict.fromkeys(failing + warnings))


def _variants(case: str) -> Iterator[str]:
    """Variants of a case; an empty name for those of a result, which are checked together."""
    yield from ("",) if is_result(case) or is_record(case) else variants(find(case)[1])
