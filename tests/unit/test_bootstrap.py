"""The script that sets up a clone, with a Python in place of the true one that installs nothing."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PYTHON = """#!/bin/sh
case "$*" in "-m venv .venv") mkdir -p .venv/bin && cp "$0" .venv/bin/python ;; esac
"""


@pytest.mark.parametrize(
    ("arguments", "command"),
    [
        ([], "pitchpoint run tian2024"),
        (["dev"], "pytest -n 0 tests/unit"),
        (["docs"], "sphinx-build docs"),
    ],
)
def test_it_ends_with_what_to_run_next(tmp_path: Path, arguments: list[str], command: str) -> None:
    stub = tmp_path / "stub" / "python3"
    stub.parent.mkdir()
    stub.write_text(PYTHON, "utf-8")
    stub.chmod(0o755)
    clone = tmp_path / "clone"
    shutil.copytree(ROOT / "requirements", clone / "requirements")
    for name in ("bootstrap", "pyproject.toml"):
        shutil.copy(ROOT / name, clone)
    path = {**os.environ, "PATH": f"{stub.parent}:{os.environ['PATH']}"}
    for _ in range(2):
        done = subprocess.run(
            ["sh", "bootstrap", *arguments],
            cwd=clone,
            env=path,
            capture_output=True,
            text=True,
            check=True,
        )
        assert f"next: .venv/bin/{command}" in done.stderr.splitlines()[-1]
    assert "up to date" in done.stderr
