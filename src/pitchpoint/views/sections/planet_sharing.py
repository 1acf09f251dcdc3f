"""How planets share a load where their pins are out of place."""

from collections.abc import Iterator
from math import nan

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.strength.strength_table import MESH_LOAD
from pitchpoint.views import section, show

__all__ = ["sharing_blocks", "sharing_facts", "sharing_printed"]


def sharing_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "planet_sharing", _of_variant)


def _of_variant(_: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["planet_sharing"]
    if rows := _rows(data):
        yield section.SectionTable(_HEADS, rows, compact=True)
    if "drawn_planet_load_factor" in data:
        yield section.SectionTable(
            ["of sets sampled by tolerance", "K_γ at most"], _drawn(data), compact=True
        )
    yield section.Paragraph(_assumed(data), "note")


def _assumed(data: xr.Dataset) -> str:
    floating = data.attrs["floating"]
    pins = "pins are rigid" if data.attrs["rigid_pins"] else "pins and teeth yield"
    moves = f"the {floating} moves sideways freely" if floating else "no body moves sideways"
    stiffness = show.quantity("planet_stiffness", float(data["planet_stiffness"]))
    force = show.quantity("pin_force", float(data["pin_force"].mean()))
    return (
        f"An equal share is {force} on each pin along its circle. Springs that only push, {stiffness} over "
        f"one planet: {pins}, {moves}; without friction, weight and centrifugal force. By tolerance pins lie "
        "anywhere in their circles and thicknesses in their field alike, and runout counts in any position. "
        "The rating of teeth takes the larger of this factor and that of the standard, unless [strength] "
        "gives one."
    )


_HEADS = [
    "planet",
    f"pin ahead [{show.unit_of('pin_error')}]",
    f"force on the pin [{show.unit_of('pin_force')}]",
    "over an equal share",
]


def _rows(data: xr.Dataset) -> list[tuple[str, ...]]:
    """Rows of the planets; none where no pin is out of place but by tolerance, and all bear alike."""
    if "drawn_planet_load_factor" in data and not data["pin_error"].any():
        return []
    names = ("pin_error", "pin_force", "planet_share")
    return [
        (
            str(number),
            *(show.quantity(name, float(data[name].values[k]), with_unit=False) for name in names),
        )
        for k, number in enumerate(data["planet"].values)
    ]


def _drawn(data: xr.Dataset) -> list[tuple[str, ...]]:
    values = data["drawn_planet_load_factor"]
    return [
        (f"{level:g} %", show.quantity("planet_load_factor", float(value)))
        for level, value in zip(values["percentile"].values, values.values, strict=True)
    ]


def sharing_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """The mesh load factor by which planets are rated; where none are, that by the deviations of each set."""
    if "strength" in outcome.parts:
        yield from _rated(outcome)
        return
    for label, mesh in section.of_meshes(outcome, "planet_sharing"):
        if "planet_sharing" in mesh.parts:
            data, of_stage = mesh.parts["planet_sharing"], f", {label}" if label else ""
            factor = show.quantity("planet_load_factor", _most_by_deviations(data))
            name = f"Load on a planet{of_stage}"
            yield section.KeyFigure(42.0, name, f"K_γ {factor}", _by_deviations(data))


def _rated(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Mesh load factor by which the planets of sets are rated, the largest one, and whence it is."""
    data = outcome.parts["strength"]
    sharing = {label: mesh.parts for label, mesh in section.of_meshes(outcome, "planet_sharing")}
    factors: dict[str, tuple[float, str]] = {}
    trains = [train for train in outcome.manifest.get("trains", ()) if len(train["angles"]) > 1]
    for train in trains:
        stage = f"stage {train['stage']}" if train["stage"] else ""
        labels = {str(mesh["label"]) for mesh in train["meshes"]}
        rated = [name for name in data["stage"].values if str(name) in labels]
        if rated:
            factor = float(data["mesh_load_factor"].sel(stage=rated).max())
            of_set = sharing.get(stage, {}).get("planet_sharing")
            factors[stage] = factor, _whence(factor, len(train["angles"]), of_set)
    if factors:
        stage, (factor, whence) = max(factors.items(), key=lambda item: item[1][0])
        detail = f"{stage}; {whence}" if len(trains) > 1 else whence
        yield section.KeyFigure(
            42.0, "Load on a planet", f"K_γ {show.number_text(factor, 3)}", detail
        )


def _whence(factor: float, planets: int, sharing: xr.Dataset | None) -> str:
    """By what a mesh load factor is, in words."""
    usual, by_deviations = MESH_LOAD.get(planets, 1.0), nan
    if sharing is not None:
        by_deviations = _most_by_deviations(sharing)
        if np.isclose(factor, by_deviations):
            return f"{_by_deviations(sharing)}; over an equal share of {planets} planets"
    if factor != usual:
        return f"by [strength]; over an equal share of {planets} planets"
    known = "assumed by IEC 61400-4" if planets in MESH_LOAD else f"assumed for {planets} planets"
    least = f"; deviations alone: {show.number_text(by_deviations, 3)}"
    return f"{known}{least if np.isfinite(by_deviations) else ''}; over an equal share"


def _most_by_deviations(data: xr.Dataset) -> float:
    """Largest mesh load factor by the deviations of a set: by tolerance that of nearly all sets."""
    return float(data.get("drawn_planet_load_factor", data["planet_load_factor"]).max())


def _by_deviations(data: xr.Dataset) -> str:
    """By what that factor is, in words."""
    if "drawn_planet_load_factor" not in data:
        return "by pin_errors"
    level, _ = _drawn(data)[-1]
    return f"at most that in {level} of sampled sets"


def sharing_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    data = outcome.parts["planet_sharing"]
    yield section.Printed(rows=[dict(zip(_HEADS, row, strict=True)) for row in _rows(data)])
    if "drawn_planet_load_factor" in data:
        factors = ", ".join(f"{level} of them K_γ up to {factor}" for level, factor in _drawn(data))
        yield section.Printed(line=f"Of sets sampled by tolerance {factors}.")
    yield section.Printed(line=_assumed(data))
