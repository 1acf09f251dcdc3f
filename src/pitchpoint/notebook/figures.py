"""The figures of the report as figures of plotly, by section."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest
from pitchpoint.runs.run import Outcome
from pitchpoint.views.figures import Figure, Panel, curves
from pitchpoint.views.section import Page, panels
from pitchpoint.views.section_registry import in_order

if TYPE_CHECKING:
    import plotly.graph_objects as go

__all__ = ["Plots", "SectionPlots"]

_SHOWN = 8
"""Figures of a section that its repr names."""


class Plots:
    """Figures by section.

    `plot.cycle()` is the first one of a section, `plot.cycle.friction()` another; `dir(plot)` lists
    the sections, `dir(plot.cycle)` the figures of one.
    """

    def __init__(self, outcomes: Mapping[str, Outcome]) -> None:
        self._sections = {name: SectionPlots(name, each) for name, each in _sections(outcomes)}

    def __getattr__(self, name: str) -> "SectionPlots":
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._sections:
            raise AttributeError(f"the report has no figures of {shown(name)}{self._near(name)}")
        return self._sections[name]

    def __dir__(self) -> list[str]:
        return [*self._sections]

    def __repr__(self) -> str:
        every = ", ".join(f"{name} ({len(dir(one))})" for name, one in self._sections.items())
        return f"Plots of {every or 'no section: no part that was computed has figures'}"

    def _near(self, name: str) -> str:
        return nearest(name, self._sections)


class SectionPlots:
    """Figures of one section of the report.

    Args:
        section: its name.
        found: panel of each figure by its name in the page, with the figure.
    """

    def __init__(self, section: str, found: Mapping[str, tuple[Panel, Figure]]) -> None:
        self._found = {name.removeprefix(f"{section}_"): each for name, each in found.items()}

    def __call__(self, name: str | None = None) -> "go.Figure":
        """The figure of that name, the first one by default.

        Raises:
            InputError: there is none.
        """
        chosen = next(iter(self._found)) if name is None else name
        if chosen not in self._found:
            near = nearest(chosen, self._found)
            raise InputError(f"there is no figure {shown(chosen)}{near}")
        return _drawn(*self._found[chosen])

    def __getattr__(self, name: str) -> "Callable[[], go.Figure]":
        if name.startswith("_") or name not in self._found:
            raise AttributeError(f"there is no figure {shown(name)}")
        return lambda: self(name)

    def __dir__(self) -> list[str]:
        return [*self._found]

    def __repr__(self) -> str:
        lines = [f"{name}: {figure.title}" for name, (_, figure) in self._found.items()]
        more = [f"{len(lines) - _SHOWN} more"] * (len(lines) > _SHOWN)
        return "\n  ".join(["Figures", *lines[:_SHOWN], *more])


def _sections(
    outcomes: Mapping[str, Outcome],
) -> Iterator[tuple[str, dict[str, tuple[Panel, Figure]]]]:
    """Sections of the report that have figures, with those that show something."""
    bare = Page(outcomes, curves(outcomes))
    page = replace(bare, sections=[one for one in in_order() if one.lacking(bare) is None])
    for section in page.sections:
        found = {
            figure.name: (panel, figure)
            for panel in panels(section.shows(page))
            for figure in panel.figures
            if figure.drawn
        }
        if found:
            yield section.name, found


_ABOVE = {"x": 0.0, "xanchor": "left", "y": 1.0, "yanchor": "bottom", "pad": {"b": 12}}
"""Place of a menu between title and curves."""


def _drawn(panel: Panel, figure: Figure) -> "go.Figure":
    """A figure of plotly with its title, legend and menu."""
    import plotly.graph_objects as go

    named = {trace.get("name") for trace in figure.data} - {None, ""}
    menu = _menu(panel, figure.name)
    layout = {
        **figure.layout,
        "title": {"text": figure.title, "font": {"size": 14}, "y": 1.0, "pad": {"t": 16}},
        "showlegend": len(named) > 1,
        "margin": {**figure.layout.get("margin", {}), "t": 104 if "updatemenus" in menu else 64},
        **menu,
    }
    return go.Figure(data=figure.data, layout=layout)


def _menu(panel: Panel, name: str) -> dict[str, Any]:
    """Menu or slider of a panel for one of its figures."""
    steps = [
        {"label": choice.label, "method": "update", "args": choice.changes[name]}
        for choice in panel.choices
        if name in choice.changes
    ]
    if not steps:
        return {}
    if panel.slides:
        return {"sliders": [{"active": panel.at, "steps": steps}]}
    return {"updatemenus": [{"active": panel.at, "buttons": steps, **_ABOVE}]}
