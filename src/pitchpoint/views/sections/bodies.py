"""Masses and moments of inertia of the bodies of a mesh."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show

__all__ = ["INERTIA", "bodies_blocks", "bodies_facts", "bodies_printed"]

INERTIA = "dynamics.inertia", "gears.bore_diameter"
"""Keys of a case that ask for moments of inertia."""

_TITLES = {"body_mass": "mass m", "body_inertia": "moment of inertia J"}


def bodies_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "bodies", _of_variant)


def _of_variant(_: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["bodies"]
    yield section.SectionTable(_heads(), _rows(data), compact=True)
    yield section.Paragraph(data.attrs["note"], "note")


def bodies_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Inertia at the ends, which a joint is driven with, and of the members."""
    data = outcome.parts["bodies"]
    inertias = [
        (str(member), show.quantity("body_inertia", float(value)))
        for member, value in zip(data["member"].values, data["body_inertia"].values, strict=True)
        if np.isfinite(value)
    ]
    members = [f"{member} {inertia}" for member, inertia in inertias]
    if "reflected_inertia" in data:
        at_input, at_output = (
            show.quantity("reflected_inertia", float(value))
            for value in data["reflected_inertia"].values
        )
        detail = "; ".join([f"{at_output} at the output", *members])
        yield section.KeyFigure(75.0, "Inertia at the input", at_input, detail, asked_by=INERTIA)
    elif inertias:
        (member, inertia), *_ = inertias
        yield section.KeyFigure(
            75.0, "Inertia", inertia, "; ".join([member, *members[1:]]), asked_by=INERTIA
        )


def bodies_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    data = outcome.parts["bodies"]
    yield section.Printed(rows=[dict(zip(_heads(), row, strict=True)) for row in _rows(data)])


def _heads() -> list[str]:
    return ["body", *(f"{title} [{show.unit_of(name)}]" for name, title in _TITLES.items())]


def _rows(data: xr.Dataset) -> list[tuple[str, ...]]:
    values = zip(*(data[name].values for name in _TITLES), strict=True)
    return [
        (str(member), *(_cell(name, float(v)) for name, v in zip(_TITLES, of_member, strict=True)))
        for member, of_member in zip(data["member"].values, values, strict=True)
    ]


def _cell(name: str, value: float) -> str:
    return show.quantity(name, value, with_unit=False) if np.isfinite(value) else "–"
