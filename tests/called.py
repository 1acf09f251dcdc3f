"""Case files that commands are called with, and what a call left behind."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sound

TINY = (
    f'title = "A [bold]pair[/bold] of <b>gears</b>"\n{sound.PAIR}'
    + """
[models]
friction = ["xu_2007", "frictionless"]
[loss_map]
count = 3
[studies.speed]
sweep = { key = "operation.speed", start = "500 rpm", stop = "1500 rpm", count = 3 }
[studies.smooth.change.roughness]
ra = "0.2 um"
"""
)


@dataclass(frozen=True)
class Told:
    status: int
    out: str
    err: str

    @property
    def json(self) -> object:
        return json.loads(self.out)

    @property
    def complaint(self) -> str:
        """Last line on standard error, after those on progress, which complain of nothing."""
        *progress, last = self.err.splitlines()
        assert not [line for line in progress if line.startswith(("error", "Traceback", " "))]
        return last


def toml(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(k)} = {toml(v)}' for k, v in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml, value))}]"
    if isinstance(value, str | bool):
        return json.dumps(value)
    return str(value)


def written(tree: dict[str, Any], folder: Path) -> Path:
    path = folder / "bad.toml"
    path.write_text("".join(f"{json.dumps(k)} = {toml(v)}\n" for k, v in tree.items()), "utf-8")
    return path
