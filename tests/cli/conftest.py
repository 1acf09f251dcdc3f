"""Commands in this process, one that ends as it likes and one that is refused; drives with a map."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from called import Told
from mapped_pair import locking_drive, moving_drive

from pitchpoint import cli
from pitchpoint.cases.built_drive import Ready
from pitchpoint.runs.run import Outcome


@pytest.fixture
def pitchpoint(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Callable[..., Told]:
    """Run a command in this process, so that programs are compiled once; reports are not written."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(cli, "_write_report", lambda outcomes, folder, **_: None)
    monkeypatch.setenv("COLUMNS", "200")

    def run(*arguments: object) -> Told:
        monkeypatch.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        out, err = capsys.readouterr()
        return Told(int(caught.value.code or 0), out, err)

    return run


@pytest.fixture
def refuse(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Callable[..., str]:
    """Run a command that must be refused; gives its one sentence."""
    monkeypatch.chdir(tmp_path)

    def run(
        *arguments: object, status: int = 2, about: object = None, several: bool = False
    ) -> str:
        monkeypatch.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        told = capsys.readouterr()
        assert caught.value.code == status, about
        assert told.out == "", about
        lines = told.err.splitlines(keepends=True)
        assert several or len(lines) == 1, about
        for line in lines:
            assert line.startswith("error: "), about
            assert len(line) < 700, about
        assert "Traceback" not in told.err, about
        return lines[0]

    return run


@pytest.fixture(scope="module")
def moving() -> tuple[Ready, Outcome]:
    return moving_drive()


@pytest.fixture(scope="module")
def locking() -> tuple[Ready, Outcome]:
    return locking_drive()
