"""The pages on the code itself name what is there."""

import re
from importlib import import_module

from documentation import ROOT
from test_layers import RANK

INSIDE = ROOT / "docs" / "inside"


def test_places_of_usual_changes_are_there() -> None:
    text = (INSIDE / "architecture.md").read_text("utf-8")
    named = re.findall(r"`(\w+/[\w./]+)`", text)
    paths = [path if re.match("src/|tests/", path) else f"src/pitchpoint/{path}" for path in named]
    assert len(paths) > 30
    assert [path for path in paths if not (ROOT / path).exists()] == []
    titles = re.findall(r"\| \"(.+)\" \|", text)
    steps = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    assert titles
    assert [title for title in titles if f"## {title}\n" not in steps] == []


def test_every_folder_is_in_the_picture() -> None:
    (picture,) = re.findall(
        r"```text\n(.+?)```", (INSIDE / "architecture.md").read_text("utf-8"), re.DOTALL
    )
    folders = {path.parent.name for path in (ROOT / "src" / "pitchpoint").glob("*/__init__.py")}
    drawn = re.findall(r"(\w+)/", picture)
    assert {*drawn} == folders
    assert [RANK[folder] for folder in drawn] == sorted(RANK[folder] for folder in drawn)


def test_words_name_what_is_in_the_code() -> None:
    rows = re.findall(
        r"^\| ([^|]+) \| [^|]+ \| `([\w.]+):(\w+)` \|$",
        (INSIDE / "glossary.md").read_text("utf-8"),
        re.MULTILINE,
    )
    words = [word for word, _, _ in rows]
    assert len(words) >= 40
    assert words == sorted({*words})
    missing = [
        name for _, module, name in rows if not hasattr(import_module(f"pitchpoint.{module}"), name)
    ]
    assert missing == []
