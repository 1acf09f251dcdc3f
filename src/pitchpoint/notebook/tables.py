"""Tables of results, and of what there is to choose from, as data frames."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pitchpoint import citations, units
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.main_figures import main_figures
from pitchpoint.cases.record import sources_of
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.case import Case
from pitchpoint.runs.catalogue import entries
from pitchpoint.runs.run import Outcome, manifests, uncomputed_manifests
from pitchpoint.views import show
from pitchpoint.views.inputs import input_words

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["cite", "frames_by_variant", "headline", "inputs", "models", "summary_frame"]

_FEW = 4


def models() -> "pd.DataFrame":
    """Laws, oils and materials that a case may name, with their ranges and sources.

    Example:
        >>> "xu_2007" in models().loc["friction"].index
        True
    """
    import pandas as pd

    return pd.DataFrame(entries()).set_index(["kind", "name"])


def cite(
    what: "str | Path | Case | Mapping[str, Any]", *, bibtex: bool = False
) -> "pd.Series[str]":
    """Sources behind a result or a case, by key.

    Args:
        what: a result, a folder of results, a `Case`, the name of a shipped case, or a file.
        bibtex: True for BibTeX entries.

    Example:
        >>> "tian_2024" in cite("tian2024")
        True
    """
    import pandas as pd

    found = {one["key"]: one["text"] for one in sources_of(_manifests(what))}
    entries_of = {key: citations.bibtex(key) for key in found} if bibtex else found
    return pd.Series(entries_of, name="source", dtype=object)


def _manifests(what: Any) -> list[Mapping[str, Any]]:
    if isinstance(what, Mapping) and all(isinstance(one, Outcome) for one in what.values()):
        return [one.manifest for one in what.values()]
    if isinstance(what, Case | Mapping):
        return [*uncomputed_manifests(what)]
    return [*manifests(str(what))]


def frames_by_variant(
    outcomes: Mapping[str, Outcome], frame: Callable[[Outcome], "pd.DataFrame"]
) -> "pd.DataFrame":
    """A frame of one variant, or those of several on top of each other under their names."""
    import pandas as pd

    frames = {name: frame(one) for name, one in outcomes.items()}
    if len(frames) == 1:
        return next(iter(frames.values()))
    return pd.concat(frames, names=["variant"])


def inputs(outcome: Outcome) -> "pd.DataFrame":
    """Inputs of one variant by key."""
    import pandas as pd

    rows = [
        {
            "key": f"{row['table']}.{row['key']}".removesuffix("."),
            "value": row["value"],
            "unit": _unit(row["kind"]),
            "shown": input_words(outcome, row["table"], row["key"]),
            **{name: row[name] for name in ("status", "where", "note")},
        }
        for row in outcome.manifest["inputs"]
    ]
    return pd.DataFrame(rows).set_index("key")


def _unit(kind: Any) -> str:
    """SI unit of the numbers of an input; none of a table of several kinds."""
    return units.si_unit(kind) if isinstance(kind, str) and kind else ""


def summary_frame(outcome: Outcome) -> "pd.DataFrame":
    """Main figures of one variant."""
    import pandas as pd

    rows = {name: row for name, row in _figures(outcome)}
    made = pd.DataFrame.from_dict(rows, orient="index")
    return made.rename_axis("quantity")


def _figures(outcome: Outcome) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and row of each main figure that is one number, or one under each friction law."""
    for analysis in ANALYSES.values():
        data = outcome.parts.get(analysis.name)
        for name in analysis.main if data is not None else ():
            if data is not None and name in data and name in VARIABLES:
                row = _row(outcome, data, name)
                if row:
                    yield name, row


def _row(outcome: Outcome, data: "xr.Dataset", name: str) -> dict[str, Any]:
    """A figure in the unit in which it is shown, under each law; empty where it is a curve."""
    variable, one = show.described(name, data), data[name]
    laws = [str(law["name"]) for law in outcome.manifest["laws"]]
    several = [str(law) for law in data["law"].values] if "law" in one.dims else []
    if one.dtype.kind not in "fi" or one.size != max(len(several), 1):
        return {}
    values = show.displayed(variable, np.ravel(one.values))
    alone = dict.fromkeys(laws, float(values[0]))
    under = dict(zip(several, values.tolist(), strict=True)) if several else alone
    return {"name": variable.long_name, "unit": show.display_unit(variable.display), **under}


def headline(outcome: Outcome) -> str:
    """The first main figure of an operating point under each law, and the number of warnings."""
    data, count = outcome.parts.get("operation"), len(outcome.manifest["warnings"])
    warned = f"; {count} warning{'s' * (count != 1)}"
    if data is None:
        return f"no operating point{warned}"
    name = main_figures(data)[0]
    each = [
        f"{show.quantity(name, float(value), of=data)} ({law})"
        for law, value in zip(data["law"].values[:_FEW], data[name].values[:_FEW, 0], strict=True)
    ]
    return f"{show.described(name, data).long_name} {', '.join(each)}{warned}"
