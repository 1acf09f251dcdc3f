"""How planets share a load where their pins are out of place."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.section import (
    Block,
    KeyFigure,
    Page,
    Paragraph,
    Printed,
    Table,
    by_variant,
    of_meshes,
)

__all__ = ["sharing_blocks", "sharing_facts", "sharing_printed"]


def sharing_blocks(page: Page) -> Iterator[Block]:
    """Blocks of the section."""
    yield from by_variant(page, "planet_sharing", _of_variant)


def _of_variant(_: int, outcome: Outcome) -> Iterator[Block]:
    data = outcome.parts["planet_sharing"]
    yield Table(_HEADS, _rows(data), compact=True)
    if "drawn_planet_load_factor" in data:
        yield Table(["of sets by tolerance", "K_γ at most"], _drawn(data), compact=True)
    yield Paragraph(_assumed(data), "note")


def _assumed(data: xr.Dataset) -> str:
    floating = data.attrs["floating"]
    pins = "pins are rigid" if data.attrs["rigid_pins"] else "pins and teeth yield"
    moves = f"the {floating} moves sideways freely" if floating else "no body moves sideways"
    stiffness = show.quantity("planet_stiffness", float(data["planet_stiffness"]))
    return (
        f"Springs that only push, {stiffness} over one planet: {pins}, {moves}; without friction, weight and "
        "centrifugal force. By tolerance pins lie anywhere in their circles and thicknesses in their "
        "field alike, and runout counts in any position. The rating of teeth "
        "takes the larger of this factor and that of the standard, unless [strength] gives one."
    )


_HEADS = [
    "planet",
    f"pin ahead [{show.unit_of('pin_error')}]",
    f"force on the pin [{show.unit_of('pin_force')}]",
    "over an equal share",
]


def _rows(data: xr.Dataset) -> list[tuple[str, ...]]:
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


def sharing_facts(outcome: Outcome) -> Iterator[KeyFigure]:
    """The mesh load factor where no rating takes it: by tolerance about errors given, or by these alone."""
    rated = outcome.parts.get("strength")
    for label, mesh in of_meshes(outcome, "planet_sharing"):
        yield from _fact(mesh.parts["planet_sharing"], rated, f", {label}" if label else "")


def _fact(data: xr.Dataset, rated: xr.Dataset | None, of_stage: str) -> Iterator[KeyFigure]:
    worst = data.get("drawn_planet_load_factor", data["planet_load_factor"]).max()
    if rated is not None and np.isclose(rated["mesh_load_factor"], worst).any():
        return
    if "drawn_planet_load_factor" in data:
        level, factor = _drawn(data)[-1]
        detail = f"at most in {level} of sets"
    else:
        factor = show.quantity("planet_load_factor", float(data["planet_load_factor"]))
        detail = "by the errors of the pins"
    name = "Load on a planet" if rated is None else "Load by deviations"
    yield KeyFigure(57.0, f"{name}{of_stage}", f"K_γ {factor}", detail)


def sharing_printed(outcome: Outcome) -> Iterator[Printed]:
    """What the screen shows."""
    data = outcome.parts["planet_sharing"]
    yield Printed(rows=[dict(zip(_HEADS, row, strict=True)) for row in _rows(data)])
    if "drawn_planet_load_factor" in data:
        factors = ", ".join(f"{level} of sets K_γ up to {factor}" for level, factor in _drawn(data))
        yield Printed(line=f"By tolerance: {factors}.")
    yield Printed(line=_assumed(data))
