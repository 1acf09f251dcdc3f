"""What counts for a kept program: the code that its modules reach, not their texts."""

import ast
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import pitchpoint
from pitchpoint.core.reach import Sources

SOURCE = Path(pitchpoint.__file__).parent
VIEW = "views/picture.py"
LAW = "lubrication/friction_coefficient.py"
DATA = "materials/catalogue/lubricants.toml"
Changed = Callable[[str, str, str], set[str]]


def name_of(path: Path, root: Path) -> str:
    """Dotted name of the module in a file of the package."""
    inner = path.relative_to(root).with_suffix("").parts
    return ".".join(["pitchpoint", *inner]).removesuffix(".__init__")


def imports(path: Path) -> Iterator[str]:
    """Names that a file imports or has in strings, and what they could be parts of; inside functions too."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "a relative import is not seen"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
            yield str(node.module)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value.partition(":")[0]


FILES = {name_of(path, SOURCE): path for path in SOURCE.rglob("*.py")}
PROGRAMS = {
    name
    for name, path in FILES.items()
    if "pitchpoint.core.programs import" in path.read_text("utf-8")
}
"""Modules with programs."""
IMPORTS = {name: FILES.keys() & {*imports(path)} - {"pitchpoint"} for name, path in FILES.items()}


def importers(target: str) -> set[str]:
    """Modules with programs that import another one, themselves or by what they import."""
    found, more = set[str](), {target}
    while more:
        found |= more
        more = {name for name, targets in IMPORTS.items() if targets & found} - found
    return found & PROGRAMS


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package, whose files may be changed."""
    copy = tmp_path_factory.mktemp("copy") / "pitchpoint"
    return shutil.copytree(SOURCE, copy, ignore=shutil.ignore_patterns("__pycache__"))


def digests(package: Path) -> dict[str, str]:
    """Digest of what each module with programs reaches, as it is now."""
    sources = Sources(package, package.parent / "kept")
    return {name: sources.digest_of_reach([name]) for name in PROGRAMS}


@pytest.fixture(scope="module")
def before(package: Path) -> dict[str, str]:
    return digests(package)


@pytest.fixture
def changed(package: Path, before: dict[str, str]) -> Iterator[Changed]:
    """Modules with programs that reach something else once a pattern in a file is replaced, for one test."""
    texts: dict[Path, str] = {}

    def replaced(file: str, pattern: str, text: str) -> set[str]:
        path = package / file
        texts.setdefault(path, path.read_text("utf-8"))
        written, count = re.subn(pattern, text, path.read_text("utf-8"), count=1)
        assert count == 1
        path.write_text(written, encoding="utf-8")
        after = digests(package)
        return {name for name in after if after[name] != before[name]}

    yield replaced
    for path, text in texts.items():
        path.write_text(text, encoding="utf-8")


def test_every_import_is_reached():
    sources = Sources(SOURCE)
    for name, path in FILES.items():
        if name != "pitchpoint":
            file = path.relative_to(SOURCE).as_posix()
            reached = {name_of(SOURCE / other, SOURCE) for other in sources.reach(file)}
            assert reached >= IMPORTS[name], name


def test_no_module_is_named_by_parts():
    """But for those of families, which are built before a program is asked for."""
    by_parts = [path for path in FILES.values() if 'import_module(f"' in path.read_text("utf-8")]
    assert by_parts == [SOURCE / "gears/families.py"]


@pytest.mark.parametrize("file", [VIEW, LAW])
def test_texts_do_not_count(changed: Changed, package: Path, file: str):
    whole = Sources(package).digest
    assert not changed(file, '"""', '"""Said otherwise. ')
    assert not changed(file, r'(?<=\.\n)    """\n', '\n    More.\n    """\n    # A comment.\n')
    assert not changed(file, r"\Z", '\n# The end.\n"""Nothing is told."""\n')
    assert Sources(package).digest != whole


def test_a_law_counts_for_what_reaches_it(changed: Changed):
    other = changed(LAW, r"0\.048", "0.049")
    assert other == importers("pitchpoint.lubrication.friction_coefficient")
    assert {"pitchpoint.efficiency.summary", "pitchpoint.wear.history"} < other
    assert not {"pitchpoint.strength.rating", "pitchpoint.contact.dry_contact"} & other
    assert not any(name.startswith("pitchpoint.gears.cylindrical") for name in other)


def test_data_count_for_what_reads_them(changed: Changed):
    other = changed(DATA, r"value = ", "value = 1")
    assert other >= importers("pitchpoint.materials.lubricants")
    assert "pitchpoint.contact.dry_contact" not in other


def test_sources_of_laws_do_not_count(changed: Changed):
    assert not changed("references.toml", r"\Z", "\n# One more book.\n")


@pytest.mark.parametrize("named", ['"{}"', '("law", "{}")', 'dict(law=["{}:march"])'])
def test_a_module_that_is_named_in_full_is_reached(changed: Changed, package: Path, named: str):
    history = named.format("pitchpoint.wear.history")
    other = changed("contact/dry_contact.py", r"\Z", f"\nNAMED = {history}\n")
    assert "pitchpoint.contact.dry_contact" in other
    assert "wear/history.py" in Sources(package).reach("contact/dry_contact.py")


def test_the_package_itself_names_what_a_user_asks_for(package: Path):
    reached = Sources(package).reach("units.py")
    assert "__init__.py" in reached
    assert not any(file.startswith(("views", "runs", "gears")) for file in reached)


def test_packages_around_a_module_count(changed: Changed):
    assert "pitchpoint.strength.rating" in changed("strength/__init__.py", r"\Z", "\nMORE = 1\n")


def test_what_was_found_is_kept(package: Path, before: dict[str, str], monkeypatch):
    def never(*_: object) -> None:
        raise AssertionError

    assert digests(package) == before
    monkeypatch.setattr(Sources, "_read", never)
    assert digests(package) == before


def test_what_was_kept_is_found_anew_where_it_is_damaged(package: Path, before: dict[str, str]):
    for path in (package.parent / "kept").iterdir():
        path.write_bytes(path.read_bytes()[:-7])
    assert digests(package) == before


def test_modules_of_others_reach_nothing(package: Path):
    sources = Sources(package)
    assert sources.digest_of_reach(["numpy", "json"]) == sources.digest_of_reach([])
