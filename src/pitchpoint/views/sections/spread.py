"""How far the friction laws that apply disagree."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from pitchpoint.analyses.main_figures import out_of_range
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import law_title, laws

__all__ = ["spread", "spread_sentence"]

_SHOWN = ("mean_efficiency", "mean_loss", "mean_friction")


def spread(outcome: Outcome) -> dict[str, Any] | None:
    """How far the friction laws that apply disagree; None where that is not known."""
    data = outcome.parts.get("laws")
    if data is None:
        return None
    outside = [
        (
            law_title(outcome, str(excluded["law"])),
            _efficiency(excluded),
            "; ".join(excluded["reasons"]),
        )
        for excluded in json.loads(data.attrs.get("outside", "[]"))
    ]
    if not data.sizes["law"]:
        text = "none of the library is in its range"
        return {"text": text, "rows": [], "points": "", "outside": outside} if outside else None
    locked = data["locked"].values[:, 0].astype(bool)
    values = data["mean_efficiency"].values[:, 0]
    computed = values[np.isfinite(values) & ~locked]
    computed = np.append(computed, _chosen(outcome)) if computed.size else computed
    rows = [
        (law_title(outcome, law), *(_cell(data, name, k) for name in _SHOWN))
        for k, law in enumerate(laws(data))
    ]
    if not computed.size:
        text = "all lock the mesh" if locked.all() else "undefined, no power"
        return {"text": text, "rows": rows, "points": "", "outside": outside}
    ends = [*dict.fromkeys(show.number_text(100 * end) for end in (computed.min(), computed.max()))]
    text = f"{' to '.join(ends)} %"
    if locked.any():
        names = [law_title(outcome, law) for law, so in zip(laws(data), locked, strict=True) if so]
        text += f"; locked by {', '.join(names)}"
    if outcome.manifest.get("plastic"):
        text += ", by laws for steel on steel; none was fitted to plastic teeth"
    points = show.number_text(100 * np.ptp(computed)) if len(ends) > 1 else ""
    return {"text": text, "rows": rows, "points": points, "outside": outside}


def _efficiency(entry: Mapping[str, Any]) -> str:
    value = entry["mean_efficiency"]
    return show.quantity("mean_efficiency", np.nan if value is None else float(value))


def _chosen(outcome: Outcome) -> np.ndarray:
    """Efficiencies by the laws of the case, those in their range under which the mesh moves."""
    data = outcome.parts["operation"]
    values = data["mean_efficiency"].values[:, 0]
    outside = json.loads(outcome.parts["laws"].attrs.get("outside", "[]"))
    inside = ~np.isin(laws(data), [entry["law"] for entry in outside])
    return np.asarray(
        values[np.isfinite(values) & inside & ~data["locked"].values[:, 0].astype(bool)]
    )


def _cell(data: Any, name: str, law: int) -> str:
    if name == "mean_efficiency" and bool(data["locked"].values[law, 0]):
        return "locks the mesh"
    return show.quantity(name, float(data[name].values[law, 0]))


def spread_sentence(outcome: Outcome) -> str:
    """How far the friction laws that apply disagree about the mean efficiency, and which do not apply."""
    if why := outcome.manifest["lacks"].get("laws"):
        return f"{why[0].upper()}{why[1:]}."
    return " ".join([_within(outcome), *_frictions(outcome), *_apart(outcome)])


def _frictions(outcome: Outcome) -> Iterator[str]:
    """Mean friction by the laws that differ most, where they do by much."""
    ends = json.loads(outcome.parts["laws"].attrs.get("friction_apart", "[]"))
    if ends:
        (low, least), (high, most) = ends
        yield (
            f"Mean friction is {show.quantity('mean_friction', least)} ({low}) to "
            f"{show.quantity('mean_friction', most)} ({high}), {show.number_text(most / least)} "
            "times as much."
        )


def _within(outcome: Outcome) -> str:
    data = outcome.parts["laws"]
    values = data["mean_efficiency"].values[:, 0]
    if np.isnan(values).any():
        return "No power is transmitted: the efficiency is undefined."
    if not len(values):
        return "No fitted friction law of the library is in its range here."
    if len(values) == 1:
        only = str(data["law"].values[0])
        return f"One fitted friction law of the library applies, {only}; it gives {_percent(values[0])}."
    low, high = int(values.argmin()), int(values.argmax())
    names = [str(name) for name in data["law"].values]
    span = f"{_percent(values[low])} ({names[low]}) to {_percent(values[high])} ({names[high]})"
    if outcome.manifest.get("plastic"):
        return (
            "No friction law of the library was fitted to plastic teeth; those for steel on steel would "
            f"give {span}."
        )
    return (
        f"The friction laws that apply give {span}: the model counts for "
        f"{show.points(values[high] - values[low])}."
    )


def _percent(efficiency: float) -> str:
    return show.quantity("mean_efficiency", efficiency)


def _apart(outcome: Outcome) -> Iterator[str]:
    """A sentence for each law that is out of its range."""
    for outside in out_of_range(outcome.parts["laws"]):
        value = outside["mean_efficiency"]
        gives = "" if value is None else f" (it would give {_percent(value)})"
        yield f"Out of its range is {outside['law']}{gives}: {'; '.join(outside['reasons'])}."
