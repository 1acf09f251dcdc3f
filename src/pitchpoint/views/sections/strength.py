"""Strength of the teeth: forces, stresses and safeties, with every factor by name."""

import json
from collections.abc import Hashable, Iterator, Mapping, Sequence
from itertools import chain
from math import inf

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import doubts_of, ranked_doubts, without_repeats
from pitchpoint.results.by_stage import as_label
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.inputs import input_words
from pitchpoint.views.point import member_names
from pitchpoint.views.screen import head, screen_value

__all__ = ["STRENGTH", "strength_rows"]

_FORCES = ("tangential_force", "radial_force", "axial_force")
_STRESSES = ("contact_stress", "flank_safety", "root_stress", "root_safety")

_LOAD = (
    "application_factor",
    "mesh_load_factor",
    "rated_dynamic_factor",
    "dynamic_factor_b",
    "dynamic_factor_c",
    "resonance_ratio",
    "face_misalignment",
    "face_load_factor",
    "transverse_load_factor",
    "root_face_load_factor",
    "root_transverse_load_factor",
)
_FLANK = (
    "zone_factor",
    "elasticity_factor",
    "contact_ratio_factor",
    "helix_factor",
    "nominal_contact_stress",
    "single_contact_factor",
    "contact_stress",
    "flank_endurance",
    "flank_cycles",
    "flank_life_factor",
    "lubricant_factor",
    "velocity_factor",
    "roughness_factor",
    "work_hardening_factor",
    "flank_size_factor",
    "contact_limit",
    "flank_safety",
)
_ROOT = (
    "root_chord",
    "bending_arm",
    "load_angle",
    "root_fillet_radius",
    "notch_parameter",
    "form_factor",
    "stress_correction_factor",
    "root_helix_factor",
    "rim_backup",
    "rim_factor",
    "root_contact_ratio_factor",
    "nominal_root_stress",
    "root_stress",
    "root_endurance",
    "root_cycles",
    "root_life_factor",
    "notch_sensitivity_factor",
    "surface_factor",
    "root_size_factor",
    "mean_stress_factor",
    "root_limit",
    "root_safety",
)


_WHERE_ASKED = ("dynamic_factor_b", "dynamic_factor_c", "resonance_ratio", "face_misalignment")
"""Rows that a rating has by methods that few cases ask for."""

_COUNTED = ("flank_cycles", "root_cycles")


def _pairs(outcome: Outcome) -> Iterator[tuple[str, xr.Dataset]]:
    """Ratings of each stage with its name and those of its gears; one without a name of a pair by itself."""
    data = outcome.parts["strength"]
    if "stage" not in data.dims:
        yield "", data
        return
    for at, stage in enumerate(data["stage"].values):
        names = member_names(outcome, as_label(str(stage)))
        gears = [names[str(gear)] for gear in data["gear"].values]
        yield f"stage {stage}", data.isel(stage=at).assign_coords(gear=gears)


def strength_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Forces, stresses and safeties of each gear."""
    return [
        ({"stage": name.removeprefix("stage ")} if name else {})
        | {"gear": str(gear)}
        | {head(variable, data): _cell(data, variable, at) for variable in (*_FORCES, *_STRESSES)}
        for name, data in _pairs(outcome)
        for at, gear in enumerate(data["gear"].values)
    ]


def _cell(data: xr.Dataset, name: str, gear: int) -> str:
    """Value of a gear, or of both; a dash where it is withheld, without load a safety without end."""
    values = data[name].values
    value = float(values[gear] if values.ndim else values)
    if value != value:
        return "–"
    if name in _COUNTED:
        return show.number_text(value)
    return "∞" if value == inf else screen_value(name, value, data)


def _told(data: xr.Dataset, name: str) -> list[str]:
    return [str(text) for text in without_repeats(json.loads(data.attrs[name]))]


def _doubts(data: xr.Dataset) -> dict[str, list[str]]:
    """What fails of a rating, and what is doubtful."""
    return ranked_doubts(doubts_of(data.attrs))


def _caveats(data: xr.Dataset) -> list[str]:
    """Method, and what stands beside the safeties."""
    return [
        f"{data.attrs['method']}.",
        *(text for name in ("withheld", "assumed", "remarks") for text in _told(data, name)),
    ]


def _table(title: str, names: tuple[str, ...], data: xr.Dataset) -> section.SectionTable:
    variables = [
        name
        for name in names
        if name not in _WHERE_ASKED or (name in data and data[name].notnull().any())
    ]
    rows = [(_words(name, data), *_values(name, data)) for name in variables]
    return section.SectionTable(
        [title, *(str(gear) for gear in data["gear"].values)], rows, compact=True
    )


def _words(name: str, data: xr.Dataset) -> str:
    variable = show.described(name, data)
    unit = show.unit_of(name, data)
    return f"{variable.long_name} {variable.symbol}{f' [{unit}]' if unit else ''}"


def _values(name: str, data: xr.Dataset) -> tuple[str, ...]:
    """Values of both gears, also where they share one."""
    return tuple(_cell(data, name, gear) for gear in range(2))


def _by_gear(rows: Sequence[Mapping[str, str]]) -> section.SectionTable:
    """Forces, stresses and safeties with a column for each gear, those of trains with their stage."""
    heads = [name for name in rows[0] if name not in ("stage", "gear")]
    columns = []
    for row in rows:
        stage = f", stage\u00a0{row['stage']}" if "stage" in row else ""
        columns.append([f"{row['gear']}{stage}", *(row[name] for name in heads)])
    return section.transposed_table(heads, columns)


def _blocks_of(_: int, outcome: Outcome) -> Iterator[section.Block]:
    strength = outcome.parts["strength"]
    yield _by_gear(strength_rows(outcome))
    for text in chain(*_doubts(strength).values()):
        yield section.Paragraph(text, "warning")
    for text in _caveats(strength):
        yield section.Paragraph(text, "note")
    for name, data in _pairs(outcome):
        tables = [
            _table(title, names, data)
            for title, names in (("Load factors", _LOAD), ("Flank", _FLANK), ("Root", _ROOT))
        ]
        yield section.Folded(f"Factors and limits behind them{f', {name}' if name else ''}", tables)


def _blocks(page: section.Page) -> Iterator[section.Block]:
    return section.blocks_by_variant(page, "strength", _blocks_of)


_ASKED, _UNASKED = 12.0, 40.0
"""Place of safeties among the key figures: behind the efficiency where a case has a table on strength."""


def _answer(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """The least safeties; where none is known, the largest stresses that are rated."""
    data = outcome.parts.get("strength")
    if data is None:
        return
    is_asked = any(
        row["status"] == "given" and row["table"].endswith("strength")
        for row in outcome.manifest["inputs"]
    )
    rank = _ASKED if is_asked else _UNASKED
    for order, where, part, stress, limit in (
        (rank, "flanks", "flank", "contact_stress", "hlim"),
        (rank + 1.0, "roots", "root", "root_stress", "flim"),
    ):
        safeties = data[f"{part}_safety"].where(np.isfinite(data[f"{part}_safety"]))
        if not safeties.isnull().all():
            at = safeties.argmin([*safeties.dims])
            least = safeties.isel(at)
            place, duty = f"at {_place(least, outcome)}", _duty(outcome, at, f"{part}_cycles")
            detail = "; ".join([place, *_doubted(outcome, least, stress), duty])
            value = show.number_text(float(least))
            yield section.KeyFigure(order, f"Safety of {where}", value, detail, f"{value} {place}")
        elif data[stress].notnull().any():
            largest = data[stress].argmax([*data[stress].dims])
            most = data[stress].isel(largest)
            value = show.quantity(stress, float(most), of=data)
            key = f"materials.gear_{int(largest['gear']) + 1}"
            place = f"at {_place(most, outcome)}"
            lacks = [f"no safety: {key} has no limits", f"largest {place}"]
            if "stage" in most.coords:
                lacks = [place, lacks[0]]  # other stages may not be rated
            cure = f"name one that has them, or give strength.sigma_{limit}"
            detail = "; ".join([*_doubted(outcome, most, stress), *lacks, cure])
            yield section.KeyFigure(order, f"Stress of {where}", value, detail)


def _doubted(outcome: Outcome, value: xr.DataArray, stress: str) -> list[str]:
    """What is doubtful of the stress in the stage of a value, briefly; nothing of one mesh alone."""
    if "stage" not in value.coords:
        return []
    begin = f"Stage {value['stage'].values}: "
    doubts = chain(*(doubts_of(part.attrs) for part in outcome.parts.values()))
    briefs = (brief.brief for brief in doubts if stress in brief.about)
    return [brief.removeprefix(begin).rstrip(".") for brief in briefs if brief.startswith(begin)]


def _duty(outcome: Outcome, place: Mapping[Hashable, xr.DataArray], cycles: str) -> str:
    """Life of a gear, with its load cycles where one is asked, and application factor of a safety."""
    data = outcome.parts["strength"]

    def there(name: str) -> float:
        values = data[name]
        return float(values.isel({dim: at for dim, at in place.items() if dim in values.dims}))

    count, factor = there(cycles), show.number_text(there("application_factor"))
    stage = str(data["stage"].values[int(place["stage"])]) if "stage" in place else ""
    time = (
        input_words(outcome, "stages", f"{stage.partition(' ')[0]}.strength.life") if stage else ""
    )
    time = time or input_words(outcome, "strength", "life")
    life = f"{show.number_text(count)} load cycles{f' ({time})' if time else ''}"
    if not np.isfinite(count):
        life = "to endure"
    elif not time and not outcome.manifest["plastic"]:
        life = "endless life"  # the count is where the line of steel turns level
    return f"{life}, application factor {factor}"


def _sums_up(outcome: Outcome) -> Iterator[section.SectionTable | section.Paragraph]:
    """Stresses and safeties of each gear, and what is assumed for them."""
    data = outcome.parts.get("strength")
    if data is None:
        return
    rows = [
        (
            ", ".join(filter(None, [str(pair["gear"].values[at]), stage])),
            *(_cell(pair, name, at) for name in _STRESSES),
        )
        for stage, pair in _pairs(outcome)
        for at in range(2)
    ]
    yield section.SectionTable(
        ["Strength", *(head(name, data) for name in _STRESSES)], rows, caption="Strength"
    )
    for text in _told(data, "assumed"):
        yield section.Paragraph(text)


def _place(value: xr.DataArray, outcome: Outcome) -> str:
    """Gear of a value, and its stage where there are several; the body that it is where these have names."""
    if "stage" not in value.coords:
        return str(value["gear"].values)
    stage = as_label(str(value["stage"].values))
    return f"{member_names(outcome, stage)[str(value['gear'].values)]} of stage {stage}"


def _screen(outcome: Outcome) -> Iterator[section.Printed]:
    data = outcome.parts.get("strength")
    if data is not None:
        line = " ".join([*_doubts(data)["warnings"], *_caveats(data)])  # what fails stands first
        yield section.Printed("Strength of the teeth", strength_rows(outcome), line)


STRENGTH = section.Section(
    name="strength",
    title="Strength of the teeth",
    short="Strength",
    order=140.0,
    parts=("strength",),
    blocks=_blocks,
    answer=_answer,
    screen=_screen,
    sums_up=_sums_up,
)
