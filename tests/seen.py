"""What a person would see to be wrong on a page: cut, empty or overlapping, on screen and on paper."""

import re
from pathlib import Path

from browser import Browser

__all__ = [
    "ALL",
    "HIGHEST",
    "LARGEST",
    "PAPER",
    "faults_on_paper",
    "faults_on_screen",
    "faults_shown",
    "pages",
    "whole",
]

ALL = "document.documentElement.dataset.drawn === 'all'"
LARGEST = 2_500_000
"""Bytes of a report."""

HIGHEST = 20_000
"""Pixels of a report 1280 px wide, with nothing unfolded."""

PAPER = 688, 1013
"""Pixels of a page of A4 within its margins."""

_FAULTS = Path(__file__).with_suffix(".js").read_text("utf-8").rstrip()


def faults_on_screen(page: Browser, path: Path, width: int, scheme: str) -> list[str]:
    """Opens a report in a window, waits for all figures; what is wrong with what is shown."""
    page.open(path, width, prefers_color_scheme=scheme)
    page.wait(ALL, 240.0)
    faults = [*faults_shown(page, width), *page.console]
    if width >= 1000 and (height := whole(page)) >= HIGHEST:
        faults.append(f"{height} px high")
    if (size := path.stat().st_size) >= LARGEST:
        faults.append(f"{size} bytes")
    return faults


def faults_shown(page: Browser, width: int, height: int = 0) -> list[str]:
    """What is wrong with a page as it is now, in a window so wide, or on paper that is as high as told."""
    return [str(fault) for fault in page.run(f"{_FAULTS}([{width}, {height}])")]


def faults_on_paper(page: Browser) -> list[str]:
    """What is wrong with a report that is open once it is printed; it is left as it was."""
    width, height = PAPER
    window = page.run("[innerWidth, innerHeight]")
    _, media = page.window or (0, {})
    features = [{"name": name.replace("_", "-"), "value": value} for name, value in media.items()]
    page.run("dispatchEvent(new Event('beforeprint'))")
    _size(page, width, height)
    page.call("Emulation.setEmulatedMedia", media="print", features=features)
    page.run("new Promise(done => setTimeout(done, 500))")
    faults = [f"on paper: {one}" for one in faults_shown(page, width, height)]
    page.call("Emulation.setEmulatedMedia", media="", features=features)
    _size(page, *window)
    page.run("dispatchEvent(new Event('afterprint'))")
    page.run("document.documentElement.dataset.alone = ''")
    if (count := pages(page.printed())) != 1:
        faults.append(f"the page that sums up takes {count} pages")
    return faults


def _size(page: Browser, width: int, height: int) -> None:
    size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    page.call("Emulation.setDeviceMetricsOverride", **size)


def whole(page: Browser) -> int:
    """Height of the page in pixels."""
    return int(page.run("document.documentElement.scrollHeight"))


def pages(pdf: bytes) -> int:
    """Number of pages of a PDF as Chromium writes them."""
    return len(re.findall(rb"/Type\s*/Page\b(?!s)", pdf))
