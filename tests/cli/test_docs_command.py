"""`pitchpoint docs`: pages read and searched without the site."""

import io
import json
import re
import sys

import pytest
import typer
from documentation import PAGES

from pitchpoint import cli
from pitchpoint.core import pages


def printed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *said: str) -> str:
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "docs", *said])
    with pytest.raises(SystemExit):
        cli.main()
    told = capsys.readouterr()
    return told.out + told.err


def test_pages_can_be_read_without_the_site(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    listed = json.loads(printed(monkeypatch, capsys, "--json"))
    apart = {"README.md", "index.md"}
    assert {f"{one['page']}.md" for one in listed} > PAGES.keys() - apart
    assert {"page": "guide/sizing", "title": "Sizing a drive"} in listed
    for name in ("guide/sizing", "sizing.md", "Guide/Sizing"):
        assert printed(monkeypatch, capsys, name) == PAGES["guide/sizing.md"]
    assert printed(monkeypatch, capsys, "gallery/paper").startswith("# A published model")
    assert "did you mean guide/sizing" in printed(monkeypatch, capsys, "guide/sizin")


@pytest.mark.parametrize(
    ("words", "where"),
    [
        ("wear", ["guide/wear", "theory/wear", "reference/keys_wear"]),
        ("Film Ratio", ["guide/python", "publications/xu2021"]),
        ("backlash_limit", ["reference/keys_wear"]),
        ("xu_2007", ["reference/models"]),
        ("min_lambda_ratio", ["reference/variables"]),
        ("MuJoCo", ["guide/simulators"]),
        ("URDF", ["guide/simulators"]),
        ("Modelica", ["guide/simulators"]),
        ("FMI", ["guide/simulators"]),
        ("Simulink", ["guide/simulators"]),
        ("armature", ["guide/simulators"]),
        ("frictionloss", ["guide/simulators"]),
    ],
)
def test_words_are_searched(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: str,
    where: list[str],
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = printed(monkeypatch, capsys, *words.split()).splitlines()
    assert 1 <= len(lines) <= pages.MOST and all(len(line) <= 80 for line in lines)
    assert {*where} <= {line.split()[0] for line in lines}
    found = json.loads(printed(monkeypatch, capsys, *words.split(), "--json"))
    assert [one["page"] for one in found] == [line.split()[0] for line in lines]


def test_what_is_nowhere_is_no_page(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "'zzzzq' is no page of the documentation, nor is it on one" in printed(
        monkeypatch, capsys, "zzzzq"
    )


def test_words_that_no_line_has_together_are_looked_for_in_pages(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = printed(monkeypatch, capsys, "published", "case", "law").splitlines()
    assert any(line.startswith("guide/targets ") for line in lines)


def test_words_that_no_page_has_together_name_the_word_that_is_missing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    first, *lines = printed(monkeypatch, capsys, "backlash", "zzzzq", "tolerances").splitlines()
    assert first == "No page has all of these words. Without zzzzq:"
    assert any(line.startswith("guide/sizing ") for line in lines) and len(lines) <= pages.MOST
    found = json.loads(printed(monkeypatch, capsys, "backlash", "zzzzq", "tolerances", "--json"))
    assert {one["without"] for one in found} == {"zzzzq"}
    assert "nor is it on one" in printed(monkeypatch, capsys, "zzzzq", "qzzzz")


def test_a_page_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(screen, "isatty", lambda: True)
    monkeypatch.setattr(sys, "stdout", screen)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "docs", "guide/limits"])
    with pytest.raises(SystemExit):
        cli.main()
    assert "What it computes, and what it does not" in screen.getvalue()
    assert "# What it computes" not in screen.getvalue()


def test_the_table_of_commands_is_whole() -> None:
    table = PAGES["guide/commands.md"].partition("CASE is")[0]
    listed = {
        words.split()[0]: words for words in re.findall(r"^\| `(.+?)` \|", table, re.MULTILINE)
    }
    made = typer.main.get_command(cli.app).commands
    assert listed.keys() == made.keys()
    for name, words in listed.items():
        known = {option for one in made[name].params for option in one.opts}
        assert set(re.findall(r"(--?[a-z]+)", words)) <= known
