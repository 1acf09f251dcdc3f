"""A page whose cells run as a notebook, with its title and first sentence, and a figure as a thumbnail."""

import base64
import json
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

__all__ = ["figure_of", "head", "notebook", "thumbnail"]


def notebook(page: str) -> str:
    """A page as a notebook without results; links to other pages are words there."""
    parts = re.split(
        r"^```\{code-cell\} ipython3\n(.*?)^```$", _body(page), flags=re.DOTALL | re.MULTILINE
    )
    kinds = ("markdown", "code")
    cells = [_cell(n, kinds[n % 2], text.strip()) for n, text in enumerate(parts) if text.strip()]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    book = {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(book, indent=1, ensure_ascii=False) + "\n"


def _body(page: str) -> str:
    return re.sub(r"\A---\n.*?\n---\n", "", page, flags=re.DOTALL)


def _cell(number: int, kind: str, text: str) -> dict[str, Any]:
    cell = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": text}
    if kind == "code":
        return cell | {"execution_count": None, "outputs": []}
    return cell | {"source": re.sub(r"\[([^\]]*)\]\(([^)]+)\.md[^)]*\)", _words, text)}


def _words(link: re.Match[str]) -> str:
    """What stands for a link: its words, or the name of the page."""
    return link[1] or "the page " + link[2].removeprefix("../")


def head(page: str) -> tuple[str, str]:
    """Title of a page and its first sentence."""
    _, title, rest = re.split(r"^# (.+)\n", page, maxsplit=1, flags=re.MULTILINE)
    words = " ".join(rest.strip().partition("\n\n")[0].split())
    return title, re.split(r"(?<=[.?]) ", words)[0].rstrip(":").replace("`", "")


def figure_of(page: str) -> dict[str, Any]:
    """Data and layout of a figure from the HTML that plotly writes of it."""
    decoder, at = json.JSONDecoder(), page.index("Plotly.newPlot(") + len("Plotly.newPlot(")
    found = []
    for _ in ("its place", "data", "layout"):
        value, at = decoder.raw_decode(page, at + len(re.match(r"[\s,]*", page[at:])[0]))
        found.append(value)
    return {"data": found[1], "layout": found[2]}


WIDTH, HEIGHT, MARGIN = 280.0, 150.0, 12.0
"""Of a thumbnail."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#B07C00", "#56B4E9", "#5A5A5A")
FEWEST, MOST = 2, 40
"""Points of a curve that is drawn, and cells of a map along either axis."""


def thumbnail(figure: dict[str, Any]) -> str:
    """Curves, or the map, of a figure without its words, as SVG."""
    drawn = [each for each in figure["data"] if each.get("visible") in (None, True)]
    maps = [each for each in drawn if each.get("type") in ("contour", "heatmap")]
    axes = figure.get("layout", {})
    inside = _cells(maps[0]) if maps else _curves(drawn, axes)
    box = f"0 0 {WIDTH:.0f} {HEIGHT:.0f}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}">'
    return f'{head}<rect width="100%" height="100%" fill="#fff"/>{"".join(inside)}</svg>\n'


def _curves(traces: list[dict[str, Any]], layout: dict[str, Any]) -> Iterator[str]:
    lines = [(each, *_places(each, layout)) for each in traces if "y" in each]
    lines = [line for line in lines if np.isfinite(line[1] + line[2]).sum() >= FEWEST]
    if not lines:
        return
    width, height = _range(line[1] for line in lines), _range(line[2] for line in lines)
    for number, (trace, x, y) in enumerate(lines):
        known = trace.get("line", {}).get("color") or trace.get("marker", {}).get("color")
        colour = known if isinstance(known, str) else COLOURS[number % len(COLOURS)]
        across = MARGIN + (x - width[0]) / (width[1] - width[0]) * (WIDTH - 2.0 * MARGIN)
        down = HEIGHT - MARGIN - (y - height[0]) / (height[1] - height[0]) * (HEIGHT - 2.0 * MARGIN)
        for piece in _pieces(across, down):
            points = " ".join(f"{a:.1f},{b:.1f}" for a, b in piece)
            yield f'<polyline fill="none" stroke="{colour}" stroke-width="2" points="{points}"/>'


def _places(trace: dict[str, Any], layout: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Points of a curve, by their logarithm where an axis is one."""
    y = _numbers(trace["y"])
    x = _numbers(trace["x"]) if "x" in trace else np.arange(y.size, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.log10(x) if layout.get("xaxis", {}).get("type") == "log" else x
        y = np.log10(y) if layout.get("yaxis", {}).get("type") == "log" else y
    return x, y


def _range(values: Any) -> tuple[float, float]:
    every = np.concatenate(list(values))
    low, high = every[np.isfinite(every)].min(), every[np.isfinite(every)].max()
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _pieces(x: np.ndarray, y: np.ndarray) -> Iterator[np.ndarray]:
    """A curve between its gaps."""
    points = np.stack([x, y], axis=-1)
    gaps = np.flatnonzero(~np.isfinite(points).all(axis=-1))
    for piece in np.split(points, gaps):
        sound = piece[np.isfinite(piece).all(axis=-1)]
        if len(sound) >= FEWEST:
            yield sound[:: max(1, len(sound) // 120)]


def _cells(trace: dict[str, Any]) -> Iterator[str]:
    """A map by cells from dark to bright."""
    values = _numbers(trace["z"])
    values = values[:: -(-values.shape[0] // MOST), :: -(-values.shape[1] // MOST)]
    low, high = _range([values.ravel()])
    rows, columns = values.shape
    wide, tall = WIDTH / columns, HEIGHT / rows
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            part = (value - low) / (high - low)
            colour = f"rgb({60 + 180 * part:.0f},{30 + 180 * part:.0f},{120 + 40 * part:.0f})"
            x, y = column * wide, HEIGHT - (row + 1) * tall
            size = f'width="{wide + 0.5:.1f}" height="{tall + 0.5:.1f}"'
            yield f'<rect x="{x:.1f}" y="{y:.1f}" {size} fill="{colour}"/>'


def _numbers(values: Any) -> np.ndarray:
    """Numbers of a figure, as a list or as plotly packs them."""
    if not isinstance(values, dict):
        return np.asarray(values, dtype=float)
    packed = np.frombuffer(base64.b64decode(values["bdata"]), dtype=values["dtype"])
    shape = [int(each) for each in str(values.get("shape", packed.size)).split(",")]
    return packed.astype(float).reshape(shape)
