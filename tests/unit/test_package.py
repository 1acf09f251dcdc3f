"""What is shipped: version, type marker, data files, locked requirements."""

import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import pitchpoint
from pitchpoint.core import pages

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
LOCKS = {path.stem: path.read_text("utf-8") for path in (ROOT / "requirements").glob("*.lock")}


def pins(lock: str) -> dict[str, str]:
    return dict(re.findall(r"^([a-z0-9-]+)==([^ ]+)", LOCKS[lock], re.MULTILINE))


def test_version_is_the_same_everywhere() -> None:
    version = PROJECT["project"]["version"]
    assert pitchpoint.__version__ == version
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text("utf-8")
    assert version in (ROOT / "CHANGELOG.md").read_text("utf-8")


def test_every_public_name_loads() -> None:
    assert all(getattr(pitchpoint, name) is not None for name in dir(pitchpoint))
    with pytest.raises(AttributeError, match="no attribute 'pitch_point'"):
        _ = pitchpoint.pitch_point


def test_every_error_can_be_caught_by_one_public_name() -> None:
    for name in ("InputError", "ConvergenceError"):
        assert issubclass(getattr(pitchpoint, name), pitchpoint.PitchpointError)


def test_wheel_holds_every_source_file(tmp_path: Path) -> None:
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True, timeout=120)
    [wheel] = tmp_path.glob("*.whl")
    shipped = set(zipfile.ZipFile(wheel).namelist())
    files = [path for path in (ROOT / "src" / "pitchpoint").rglob("*") if path.is_file()]
    wanted = {str(path.relative_to(ROOT / "src")) for path in files if path.suffix != ".pyc"}
    assert "pitchpoint/py.typed" in shipped
    assert wanted <= shipped
    read = {name for name in shipped if name.startswith("pitchpoint/docs/")}
    assert read == {f"pitchpoint/docs/{name}.md" for name in pages.page_names()}


def test_locks_name_no_address() -> None:
    assert not [name for name, text in LOCKS.items() if "://" in text]


def test_locks_agree() -> None:
    assert pins("run").items() <= pins("dev").items()
    docs = pins("docs")
    assert pins("run").items() <= docs.items()
    both = pins("dev").keys() & docs.keys()  # one environment holds both
    assert {name: docs[name] for name in both} == {name: pins("dev")[name] for name in both}


def test_the_oldest_packages_that_are_allowed_are_those_tested() -> None:
    """`.ci/elsewhere` tests with the lowest lock."""
    for asked in map(Requirement, PROJECT["project"]["dependencies"]):
        (floor,) = (str(one).removeprefix(">=") for one in asked.specifier)
        pinned = rf"^{asked.name}=={re.escape(floor)}(\.0)* "
        assert re.search(pinned, LOCKS["lowest"], re.MULTILINE), asked


def test_locks_hold_what_the_project_asks_for() -> None:
    groups = PROJECT["dependency-groups"]
    wanted = {
        "run": PROJECT["project"]["dependencies"] + groups["build"],
        "dev": groups["dev"],
        "docs": groups["docs"],
    }
    for lock, lines in wanted.items():
        for asked in map(Requirement, lines):
            assert pins(lock)[asked.name] in asked.specifier, asked
