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
    """Studies that hold readings, without those whose points all stand in one with as much to tell."""
    found = [
        data
        for one in page.outcomes.values()
        for part, data in one.parts.items()
        if is_study(part) and _rows(data, beside)
    ]
    kept: list[int] = []
    seen: list[_Told] = []
    for place in sorted(range(len(found)), key=lambda one: -len(_rows(found[one], beside))):
        points = _points(found[place], beside)
        if not all(any(point <= other for other in seen) for point in points):
            kept.append(place)
            seen += points
    return [found[place] for place in sorted(kept)]


_Told = frozenset[tuple[str, float]]


def _rows(data: xr.Dataset, beside: Beside) -> dict[str, tuple[str, ...]]:
    """Rows of which a study has all readings."""
    return {
        told: names for told, names in beside.rows.items() if all(name in data for name in names)
    }


def _points(data: xr.Dataset, beside: Beside) -> list[_Told]:
    """What is told of each point, by name of the reading."""
    every = [name for names in _rows(data, beside).values() for name in names]
    columns = {name: data[name].values[0].tolist() for name in every}
    return [
        frozenset((name, values[point]) for name, values in columns.items())
        for point in range(data.sizes["point"])
    ]


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
        [
            (_titled(told, names[0]), *_cells(data, names))
            for told, names in _rows(data, beside).items()
        ],
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
