"""What a strain wave gear bears: stress of the flexspline, margins by a maker's torques, bearing life."""

import json
from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.screen import head, screen_value

__all__ = ["limit_rows", "limits_blocks", "limits_facts", "limits_printed", "stress_rows"]

_STRESSES = {
    "bending_strain": "largest strain by the wave ε_b",
    "bending_amplitude": "alternating bending stress σ_b",
    "mean_bending_stress": "mean bending stress σ_b0",
    "torsional_stress": "shear stress by the torque τ",
    "alternating_stress": "alternating equivalent stress σ_a, √(σ_b² + 3 τ²) with a torque that reverses",
    "mean_stress": "mean equivalent stress σ_m, √(σ_b0² + 3 τ²) with one that is steady",
    "goodman_safety": "safety, 1/(σ_a/S_e + σ_m/S_u)",
    "goodman_torque": "torque at which it is one",
}

_WITHOUT = (
    "No safety: endurance_limit and tensile_strength of the flexspline in [gears.limits] would give one by "
    "the modified Goodman line."
)

Row = tuple[str, ...]


def stress_rows(data: xr.Dataset) -> list[Row]:
    """Names of strain, stresses and safety, each with its values at both places."""
    return [
        (_titled(title, name), *(_cell(name, float(v)) for v in data[name].values))
        for name, title in _STRESSES.items()
        if name in data
    ]


def limit_rows(data: xr.Dataset) -> list[Row]:
    """Torques of a maker, each at this size and over that on the flexspline."""
    if "limit_torque" not in data:
        return []
    pairs = zip(data["limit_torque"].values, data["limit_margin"].values, strict=True)
    return [
        (str(name), _cell("limit_torque", float(limit)), _cell("limit_margin", float(margin)))
        for name, (limit, margin) in zip(data["against"].values, pairs, strict=True)
        if np.isfinite(limit)
    ]


def _titled(title: str, name: str) -> str:
    unit = show.unit_of(name)
    return f"{title} [{unit}]" if unit else title


def _cell(name: str, value: float) -> str:
    return show.quantity(name, value, with_unit=False) if np.isfinite(value) else "–"


def _concentrated(data: xr.Dataset) -> str:
    """What stands in the stresses beside those of a smooth ring."""
    bending, shear = (f"{value:g}" for value in json.loads(data.attrs["concentrations"]))
    if (bending, shear) == ("1", "1"):
        return "Stresses hold no concentration, which notches of the teeth and fillets make."
    return (
        f"Stresses are {bending} times (bending) and {shear} times (shear) those of a smooth part."
    )


def _limits_note(data: xr.Dataset) -> str:
    torques = limit_rows(data)
    sentence = "Ratcheting and buckling are not computed"
    return f"{sentence}: their torques are {_origin(data)}." if torques else f"{sentence}."


def _origin(data: xr.Dataset) -> str:
    """Where torques of a maker are from."""
    by_size = ", by the cube of the pitch diameters" if data.attrs["scaled"] else ""
    return f"as the case gives them{by_size}"


def _life(data: xr.Dataset) -> str:
    life = show.quantity("bearing_life", float(data["bearing_life"]))
    return f"Life of the wave generator's bearing: {life}, by the rating of the case, L (T_r/T)³ n_r/n."


def limits_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "load_limits", _of_variant)


def _of_variant(_: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["load_limits"]
    torque = show.quantity("flexspline_torque", float(data["flexspline_torque"]))
    yield section.Paragraph(f"Torque on the flexspline: {torque}. {data.attrs['note']}")
    places = [str(name) for name in data["place"].values]
    yield section.SectionTable(["flexspline", *places], stress_rows(data), compact=True)
    notes = [_concentrated(data), *([] if "goodman_safety" in data else [_WITHOUT])]
    yield section.Paragraph(" ".join(notes), "note")
    torques = limit_rows(data)
    if torques:
        unit = show.unit_of("limit_torque")
        yield section.SectionTable(["against", f"torque [{unit}]", "margin"], torques, compact=True)
    yield section.Paragraph(_limits_note(data), "note")
    if "bearing_life" in data:
        yield section.Paragraph(_life(data))


def limits_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """What follows from strengths and ratings that the case gives."""
    data = outcome.parts.get("load_limits")
    if data is None:
        return
    if "goodman_safety" in data:
        safety = show.number_text(float(data["goodman_safety"].min()))
        yield section.KeyFigure(
            40.0,
            "Flexspline safety",
            safety,
            "for endless life; an estimate of a smooth ring and tube",
        )
    for name, _, margin in limit_rows(data):
        yield section.KeyFigure(
            41.0, f"Against {name}", f"{margin} times", "the torque, which the case gives"
        )
    if "bearing_life" in data:
        life = show.quantity("bearing_life", float(data["bearing_life"]))
        yield section.KeyFigure(
            42.0, "Life of the bearing", life, "of the wave generator, by the rating of the case"
        )


def limits_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    data = outcome.parts.get("load_limits")
    if data is None:
        return
    names = ("alternating_stress", "torsional_stress", "mean_stress", "goodman_safety")
    rows = [
        {"flexspline, smooth ring and tube": str(place)}
        | {
            head(name): screen_value(name, float(data[name].values[k]))
            for name in names
            if name in data
        }
        for k, place in enumerate(data["place"].values)
    ]
    yield section.Printed(rows=rows, line=" ".join(_on_screen(data)))


def _on_screen(data: xr.Dataset) -> Iterator[str]:
    """Margins and life in a line, each with where it is from."""
    torque = show.quantity("flexspline_torque", float(data["flexspline_torque"]))
    yield f"Estimate, at {torque} on the flexspline, without teeth. {_concentrated(data)}"
    for name, limit, margin in limit_rows(data):
        yield f"Against {name} {margin}, by {limit} {show.unit_of('limit_torque')} {_origin(data)}."
    if "bearing_life" in data:
        yield _life(data)
