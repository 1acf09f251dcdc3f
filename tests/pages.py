"""What the script of a page reads."""

import base64
import gzip
import itertools
import json
import re
from typing import Any

__all__ = ["decoded", "opened", "payload", "unpacked"]


def unpacked(page: str, name: str) -> Any:
    """Content that a page holds compressed."""
    (held,) = re.findall(rf'<script type="text/plain" id="{name}">(.*?)</script>', page)
    return json.loads(decoded(held))


def decoded(held: str) -> bytes:
    """What a page holds in five characters for four bytes."""
    return gzip.decompress(base64.b85decode(held.translate(str.maketrans(".:,", "<>&"))))


def opened(page: str) -> str:
    """A report with the text of its figures behind it."""
    return page + json.dumps(payload(page), ensure_ascii=False)


def payload(page: str) -> dict[str, Any]:
    """Figures and menus of a report, as its script has them."""
    content = unpacked(page, "figures")
    lists = [_numbers(*steps) for steps in content.pop("lists")]

    def placed(part: Any) -> Any:
        if isinstance(part, list):
            return [placed(value) for value in part]
        if isinstance(part, dict):
            return lists[part["list"]] if "list" in part else {k: placed(part[k]) for k in part}
        return part

    return dict(placed(content))


def _numbers(decimals: int, *steps: int | None) -> list[float | None]:
    """Numbers by the steps from one to the next."""
    sums = iter(itertools.accumulate(step for step in steps if step is not None))
    return [None if step is None else next(sums) / 10**decimals for step in steps]
