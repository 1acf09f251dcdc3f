"""The folder of a study: case files that somebody wrote stay as they are."""

import sys
import tomllib
from pathlib import Path

import pytest
import sound
from many_designs import KEYS, quick_study

import pitchpoint as pp
from pitchpoint import cli

OVER = {KEYS[0]: ["20 N m", "40 N m"], KEYS[1]: ["900 rpm"], KEYS[2]: ["20 mm"]}


def _ended(*given: str) -> int:
    with pytest.MonkeyPatch.context() as patched, pytest.raises(SystemExit) as ended:
        patched.setattr(sys, "argv", ["pitchpoint", "study", *given])
        cli.main()
    return int(ended.value.code or 0)


def test_a_study_replaces_no_case_that_somebody_wrote(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    quick_study(monkeypatch, "grid", over=OVER)  # from here on designs take no time
    pair = pp.Case(tomllib.loads(sound.PAIR)).to_toml(tmp_path / "pair.toml")
    keys = "\n".join(f"over.{key} = {values}" for key, values in OVER.items())
    text = f'# mine\n{pair}\n[study]\nfolder = "."\n{keys}\n'
    user = tmp_path / "e" / "case.toml"
    user.parent.mkdir()
    user.write_text(text, "utf-8")
    over = [word for key, values in OVER.items() for word in ("--over", f"{key}={values}")]
    elsewhere = (str(tmp_path / "pair.toml"), *over, "-o", str(user.parent))
    for given in ((str(user), "-o", str(user.parent)), (str(user),), elsewhere):
        assert _ended(*given) == 2
        assert "holds a case.toml that the study would replace" in capsys.readouterr().err
        assert [path.name for path in user.parent.iterdir()] == ["case.toml"]
        assert user.read_text("utf-8") == text
    for _ in range(2):  # what a study wrote, a study replaces
        assert _ended(str(user), "-o", str(tmp_path / "out")) == 0
    written = tmp_path / "out" / "case.toml"
    assert _ended(str(written), *over, "-o", str(tmp_path / "out")) == 2
    assert "holds a case.toml that the study would replace" in capsys.readouterr().err
