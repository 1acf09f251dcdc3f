"""What reaches the terminal: nothing that steers it, letters it does not know, progress, completion."""

import gc
import io
import json
import os
import runpy
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from sound import PAIR

import pitchpoint
from pitchpoint import cli

EVIL = "\x1b]0;owned\x07\x1b[2J\x1b]52;c;aGk=\x07\x9b31m :smile: Zahnräder"
NOTED = f'{{ value = "2 mm", where = {json.dumps(EVIL)}, note = "first\\nsecond {json.dumps(EVIL)[1:]} }}'
GEARS = PAIR.replace('"2 mm"', f"{NOTED}\nprofile_shift = [1.0, -0.4]")
CASE = f"""
title = {json.dumps(EVIL)}
{GEARS}
[[issues]]
where = {json.dumps(EVIL)}
issue = {json.dumps(EVIL)}
verdict = {json.dumps(EVIL)}
"""


@pytest.fixture
def told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> Callable[..., tuple[int, str, str]]:
    """Run a command; gives status, standard output and standard error."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        out, err = capsys.readouterr()
        return int(caught.value.code or 0), out, err

    return run


Run = Callable[..., tuple[int, str, str]]


def steering(text: str) -> set[str]:
    return {sign for sign in text if not sign.isprintable()} - {"\n"}


# ---- text from outside


@pytest.mark.parametrize("as_json", [[], ["--json"]])
def test_titles_and_remarks_do_not_steer(told: Run, tmp_path: Path, as_json: list[str]) -> None:
    (tmp_path / "evil.toml").write_text(CASE, "utf-8")
    status, out, err = told("show", "evil.toml", *as_json)
    assert (status, err) == (0, "")
    assert not steering(out)
    assert ":smile:" in out
    if as_json:
        assert json.loads(out)[0]["title"] == EVIL
    else:
        assert "\\x1b]0;owned\\x07\\x1b[2J" in out
        assert "first second" in out


def test_names_of_files_and_keys_do_not_steer(told: Run, tmp_path: Path) -> None:
    name = "\x1b]0;owned\x07.toml"
    (tmp_path / name).write_text(CASE.replace("[gears]", "[gears]\nmodul = 1"), "utf-8")
    for arguments in (
        ["show", name],
        ["show", "\x1b[2J"],
        ["show", "\x1b[2J.toml"],
        ["show", name, "--set", "\x1b[2J=3"],
        ["show", name, "--set", "gears.module=\x1b[2J"],
        ["show", name, "--variant", "\x1b[2J"],
        ["run", name, "--sweep", "\x1b[2J=1:2:3"],
        ["cite", "\x1b[2J"],
        ["\x1b[2J"],
        ["show", "--\x1b[2J"],
    ):
        status, out, err = told(*arguments)
        assert (status, out) == (2, ""), arguments
        assert not steering(err)
        assert "\\x1b" in err


def test_the_name_of_a_file_need_not_be_text(told: Run, tmp_path: Path) -> None:
    path = os.fsdecode(os.fsencode(tmp_path) + b"/p\xff.toml")
    Path(path).write_text(CASE, "utf-8")
    status, out, _ = told("show", path, "--json")
    assert (status, json.loads(out)[0]["case"]) == (0, "p\\xff.toml")


def test_a_terminal_that_knows_ascii_alone(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE, "utf-8")
    for arguments in (["show"], ["show", "--json"]):
        stdout = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
        monkeypatch.setattr(sys, "stdout", stdout)
        monkeypatch.setattr(sys, "argv", ["pitchpoint", *arguments, str(tmp_path / "case.toml")])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        assert caught.value.code == 0
        stdout.seek(0)
        assert "Zahnr\\" in stdout.read()


# ---- progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def parts() -> None:
    with cli._progress(None) as progress:
        progress.part("physical", f"mesh cycle {EVIL}", False)
        progress.points(3)
        progress.part("", "report", True)


def test_progress_is_a_line_for_each_part_where_nobody_watches(
    capsys: pytest.CaptureFixture[str],
) -> None:
    parts()
    first, second = capsys.readouterr().err.splitlines()
    assert first.startswith("physical mesh cycle \\x1b]0;owned")
    assert second == "report (on disk)"


def test_progress_on_a_terminal_moves_but_is_not_steered(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    parts()
    shown = terminal.getvalue()
    assert "\x1b[?25l" in shown  # rich's own: the cursor is hidden meanwhile
    assert "report" in shown
    assert not {"\x07", "\x9b"} & set(shown)
    assert "\x1b]" not in shown


def test_progress_counts_parts_and_tells_their_share(capsys: pytest.CaptureFixture[str]) -> None:
    with cli._progress(None) as progress:
        progress.expect(2)
        progress.expect(3)  # of a second design
        for title in ("teeth", "cycle", "map", "film", "joint", "report"):
            progress.part("", title, title == "cycle")
    told = capsys.readouterr().err.splitlines()
    assert told[0] == "teeth, part 1 of 5, 0 %"
    assert told[1] == "cycle (on disk), part 2 of 5, 20 %"
    assert told[4:] == ["joint, part 5 of 5, 80 %", "report"]


# ---- version, help, completion


def test_version(told: Run) -> None:
    assert told("--version") == (0, f"pitchpoint {pitchpoint.__version__}\n", "")


@pytest.mark.parametrize("command", [[], ["cases"], ["show"], ["run"], ["compare"], ["cite"]])
def test_short_help(told: Run, command: list[str]) -> None:
    status, out, err = told(*command, "-h")
    assert (status, err) == (0, "")
    assert "Usage: pitchpoint" in out
    assert told(*command, "--help")[1] == out


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("pitchpoint show ti", ["tian2024"]),
        ("pitchpoint show ./mi", ["./mine.toml"]),
        ("pitchpoint show tian2024 --variant ph", ["physical"]),
        ("pitchpoint show nothing --variant ph", []),
        ("pitchpoint run tian2024 --set operation.s", ["operation.speed="]),
        ("pitchpoint run tian2024 --sweep gears.tooth.co", ["gears.tooth.convex_radius="]),
    ],
)
def test_completion(
    line: str, offered: list[str], told: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "mine.toml").write_text(CASE, "utf-8")
    monkeypatch.setenv("_PITCHPOINT_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", line)
    monkeypatch.setenv("COMP_CWORD", str(line.count(" ")))
    _, out, _ = told()
    assert out.split()[: len(offered)] == offered
    assert bool(out.split()) == bool(offered)


def test_a_process_of_its_own_looks_for_garbage_once_its_parts_begin(monkeypatch):
    monkeypatch.setattr(cli, "main", lambda: None)
    frozen = gc.get_freeze_count()
    try:
        cli.command()
        assert not gc.isenabled()
        with cli._progress(None) as progress:
            progress.part("a", "cycle", False)
        assert gc.isenabled()
        assert gc.get_freeze_count() > frozen
    finally:
        gc.enable()
        cli._garbage_waits = False


def test_who_calls_the_command_line_keeps_the_garbage_collector_as_it_is():
    frozen = gc.get_freeze_count()
    with cli._progress(None) as progress:
        progress.part("a", "cycle", False)
    assert gc.isenabled()
    assert gc.get_freeze_count() <= frozen  # less where what was frozen before has died


def test_the_package_runs_as_a_module(monkeypatch):
    begun = []
    monkeypatch.setattr(cli, "command", lambda: begun.append("command"))
    runpy.run_module("pitchpoint", run_name="__main__")
    assert begun == ["command"]
