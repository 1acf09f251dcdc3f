"""What the formulas of a publication give, side by side as it compares them."""

from collections.abc import Iterator

import xarray as xr

from pitchpoint.analyses.studies import is_study
from pitchpoint.cases.schema import quantity_at
from pitchpoint.published.publication import Beside
from pitchpoint.published.registry import PUBLICATIONS
from pitchpoint.views import show
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Section, Table

__all__ = ["FORMULAS"]


def _beside(page: Page) -> Beside | None:
    source = page.first.get("source", "")
    return PUBLICATIONS[source].beside if source in PUBLICATIONS else None


def _studies(page: Page, beside: Beside) -> list[xr.Dataset]:
    """Studies that hold the readings, once where variants agree, without those whose points are seen."""
    asked = [name for names in beside.rows.values() for name in names]
    seen: set[tuple[float, ...]] = set()
    found = []
    for one in page.outcomes.values():
        for part, data in one.parts.items():
            if not is_study(part) or any(name not in data for name in asked):
                continue
            numbers = {*zip(*(data[name].values[0].tolist() for name in asked), strict=True)}
            if numbers - seen:
                found.append(data)
            seen |= numbers
    return found


def _blocks(page: Page) -> Iterator[Block]:
    beside = _beside(page)
    assert beside is not None
    yield Paragraph(beside.note, "note")
    for data in _studies(page, beside):
        yield Heading(str(data.attrs["title"]))
        yield _table(data, beside)


def _table(data: xr.Dataset, beside: Beside) -> Table:
    columns = [
        ", ".join(filter(None, (place, told))) for place in _places(data) for told in beside.columns
    ]
    return Table(
        ["Quantity", *columns],
        [(_titled(told, names[0]), *_cells(data, names)) for told, names in beside.rows.items()],
    )


def _titled(told: str, name: str) -> str:
    unit = show.unit_of(name)
    return f"{told} [{unit}]" if unit else told


def _cells(data: xr.Dataset, names: tuple[str, ...]) -> Iterator[str]:
    for point in range(data.sizes["point"]):
        for name in names:
            yield show.quantity(name, float(data[name].values[0, point]), with_unit=False)


def _places(data: xr.Dataset) -> list[str]:
    """Places on the axis of a study in words; one without words where there is none."""
    if "axis" not in data:
        return [""]
    quantity = quantity_at(data.attrs["sweep_key"])
    return [
        quantity.show(float(value)) if quantity is not None else f"{value:.6g}"
        for value in data["axis"].values
    ]


def _lacks(page: Page) -> str | None:
    beside = _beside(page)
    return "" if beside is None or not _studies(page, beside) else None


FORMULAS = Section(
    name="formulas",
    title="Formulas of the publication",
    short="Formulas",
    order=610.0,
    lacks=_lacks,
    blocks=_blocks,
)
