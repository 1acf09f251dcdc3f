"""Imports point one way, along the data flow; what `pitchpoint --help` touches is light."""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import pitchpoint

SOURCE = Path(pitchpoint.__file__).parent
FLOW = (
    {"core", "errors", "units", "citations", "registry", "_jax"},
    {"input"},
    {"materials"},
    {"contact"},
    {"gears"},
    {"drive"},
    {"loading"},
    {"lubrication"},
    {"efficiency"},
    {"strength"},
    {"wear"},
    {"dynamics"},
    {"results"},
    {"duty_cycle"},
    {"published"},
    {"cases"},
    {"analyses"},
    {"runs"},
    {"sizing"},
    {"views"},
    {"notebook"},
    {"exports"},
    {"cli"},
    {"__main__"},
)
RANK = {folder: rank for rank, folders in enumerate(FLOW) for folder in folders}
HEAVY = {"jax", "equinox", "optimistix", "lineax", "numpy", "scipy", "pandas", "xarray", "plotly"}
HEAVY |= {"diffrax", "h5netcdf", "h5py", "pint"}


def absolute(node: ast.ImportFrom, package: tuple[str, ...]) -> str:
    above = package[: len(package) - node.level + 1] if node.level else ()
    return ".".join([*above, *filter(None, [node.module])])


PLACE = re.compile(r"pitchpoint(\.\w+)+:\w+")
"""Code that a registry has loaded when it is chosen."""


def imported(tree: ast.AST, package: tuple[str, ...]) -> Iterator[str]:
    """Dotted name of all that is imported, in functions and for type checking too, or named by its place."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and PLACE.fullmatch(str(node.value)):
            yield str(node.value).partition(":")[0]
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{absolute(node, package)}.{alias.name}" for alias in node.names)


def edges(source: Path) -> Iterator[tuple[str, str, str]]:
    """(file, folder, folder it imports) for each import of our own outside the root module."""
    for file in sorted(source.rglob("*.py")):
        inner = file.relative_to(source).with_suffix("").parts
        if inner == ("__init__",):
            continue
        for name in imported(ast.parse(file.read_text("utf-8")), ("pitchpoint", *inner[:-1])):
            root, _, rest = name.partition(".")
            if root == "pitchpoint" and rest != "__version__":
                yield "/".join(inner), inner[0], rest.split(".")[0]


def backward(source: Path) -> list[str]:
    return [
        f"{file} imports pitchpoint.{target}"
        for file, folder, target in edges(source)
        if folder != target and not allowed(folder, target)
    ]


def allowed(folder: str, target: str) -> bool:
    if folder not in RANK or target not in RANK:
        return False  # a folder with no place in FLOW, or a public name taken through the root
    return RANK[target] < RANK[folder] or RANK[target] == RANK[folder] == 0


def test_imports_follow_the_data_flow() -> None:
    assert backward(SOURCE) == []


def test_every_room_has_a_place() -> None:
    files = SOURCE.rglob("*.py")
    folders = {file.relative_to(SOURCE).with_suffix("").parts[0] for file in files} - {"__init__"}
    assert folders <= RANK.keys()


@pytest.mark.parametrize(
    ("file", "line", "caught"),
    [
        ("gears/pair.py", "from pitchpoint.contact.hertz import line", False),
        ("gears/pair.py", "from ..errors import InputError", False),
        ("gears/pair.py", "from . import flank", False),
        ("gears/pair.py", "from pitchpoint import __version__", False),
        ("units.py", "from pitchpoint.errors import InputError", False),
        ("gears/pair.py", "import pitchpoint.loading.sharing", True),
        ("gears/registry.py", "PLACE = 'pitchpoint.loading.sharing:equal'", True),
        ("loading/loading_registry.py", "PLACE = 'pitchpoint.gears.involute:involute'", False),
        ("gears/pair.py", "def f():\n    from ..loading import sharing", True),
        ("gears/pair.py", "from pitchpoint import views", True),
        ("gears/pair.py", "from pitchpoint import SpurPair", True),
        ("gears/internal/ring.py", "from ...cases import load", True),
        ("attic/old.py", "from pitchpoint import errors", True),
    ],
)
def test_the_check_sees(tmp_path: Path, file: str, line: str, caught: bool) -> None:
    path = tmp_path / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(line, "utf-8")
    assert bool(backward(tmp_path)) is caught


HELP = """
import sys
from pitchpoint.cli import main
sys.argv = ["pitchpoint", "--help"]
try:
    main()
except SystemExit as stop:
    assert not stop.code, stop.code
"""


@pytest.mark.parametrize("code", ["import pitchpoint", HELP], ids=["import", "help"])
def test_nothing_heavy_is_loaded(code: str) -> None:
    report = f"\nimport sys; print('loaded:', *(sys.modules.keys() & {HEAVY!r}))"
    done = subprocess.run(
        [sys.executable, "-c", code + report], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1].strip() == "loaded:"


BLIND = (
    "contact",
    "loading",
    "lubrication",
    "wear",
    "efficiency",
    "strength",
    "dynamics",
    "cases",
    "analyses",
    "runs",
    "views",
    "notebook",
)
"""Folders whose files do not know the families; a publication reads its own gears."""


MESHES = re.compile(r"^class (\w+)\((?:Mesh|Rig|InvoluteMesh|InvolutePair)\)", re.MULTILINE)
FAMILIES = {
    name
    for file in (SOURCE / "gears").rglob("*.py")
    for name in MESHES.findall(file.read_text("utf-8"))
} - {"Rig", "InvoluteMesh", "InvolutePair"}
QUESTIONS = {"clearances", "has_wave", "has_path", "ring_loads", "Facts", "Wave"}


def asked(tree: ast.AST) -> set[str]:
    """Names and attributes that stand in a module."""
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    return names | {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}


def test_the_families_are_found() -> None:
    assert {"CylindricalPair", "StrainWave", "TwinDisc", "BallOnDisc", "RackAndPinion"} <= FAMILIES
    assert "TorusPair" in FAMILIES


@pytest.mark.parametrize("folder", BLIND)
def test_nothing_but_gears_asks_for_the_family(folder: str) -> None:
    """Neither its class nor a question that stands for it; `gears` answers what all families are asked."""
    for file in sorted((SOURCE / folder).rglob("*.py")):
        found = asked(ast.parse(file.read_text("utf-8")))
        assert not found & (FAMILIES | QUESTIONS), file.name


READ = {
    "shape": 34,
    "surfaces": 5,
    "body": 27,
    "other_flanks": 1,
    "spots": 3,
    "coordinates": 13,
    "contacts": 18,
    "events": 7,
    "contact_ratio": 7,
    "relation": 2,
    "passing": 0,
    "pitch": 0,
    "rigid_contacts": 0,
}
"""Members of a mesh, and how often rooms beside `gears` read each at most.

What one analysis asks of one kind of gears is no member of all; what a mesh does in a drive, such as who
turns it and how fast, is said by the drive.
"""


def test_a_mesh_has_few_members_that_are_abstract_or_final() -> None:
    tree = ast.parse((SOURCE / "gears" / "mesh.py").read_text("utf-8"))
    (mesh,) = (n for n in tree.body if isinstance(n, ast.ClassDef) and n.name == "Mesh")
    names = set()
    for node in mesh.body:
        if isinstance(node, ast.AnnAssign):
            names.add(ast.unparse(node.target))
            assert ast.unparse(node.annotation).startswith("eqx.Abstract"), ast.unparse(node)
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            names.add(node.name)
            marks = {ast.unparse(mark) for mark in node.decorator_list}
            assert marks & {"abc.abstractmethod", "final"}, node.name
    assert names == READ.keys()


def test_rooms_beside_gears_read_few_members_of_a_mesh() -> None:
    reads = dict.fromkeys(READ, 0)
    for file in sorted(SOURCE.rglob("*.py")):
        if file.relative_to(SOURCE).parts[0] == "gears":
            continue
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Attribute) and node.attr in READ:
                of = ast.unparse(node.value).split(".")[-1]
                reads[node.attr] += of in {"mesh", "pair", "own"}
    assert {name: count for name, count in reads.items() if count > READ[name]} == {}
    assert reads["relation"] > 0, "reads are counted"


def types_asked(tree: ast.AST) -> set[str]:
    """Names of the classes that `isinstance` asks for in a module, wherever the call breaks its lines."""
    return {
        name.id
        for call in ast.walk(tree)
        if isinstance(call, ast.Call) and ast.unparse(call.func) in ("isinstance", "issubclass")
        for name in ast.walk(call.args[1])
        if isinstance(name, ast.Name)
    }


BUILT = {"Built", "BuiltDrive", "BuiltTrain", "Ready"}


def test_what_is_built_answers_for_itself() -> None:
    """Be it one mesh, stages or a train: nothing asks which it is; nor for pairs, outside of gears."""
    for file in sorted(SOURCE.rglob("*.py")):
        inner = file.relative_to(SOURCE)
        pairs = set() if inner.parts[0] in ("gears", "published") else FAMILIES | {"InvolutePair"}
        found = types_asked(ast.parse(file.read_text("utf-8"))) & (BUILT | pairs)
        assert not found, f"{inner} asks for {found}"


def test_a_type_that_is_asked_for_is_seen() -> None:
    tree = ast.parse(
        "any(isinstance(one, int | BuiltTrain) and not isinstance(two, (Built,)) for one in x)"
    )
    assert types_asked(tree) == {"int", "BuiltTrain", "Built"}


def test_views_do_not_read_the_name_of_the_family() -> None:
    names = {"cylindrical", "strain_wave", "ball_on_disc", "rack_and_pinion", "torus"}
    for file in sorted((SOURCE / "views").rglob("*.py")):
        tree = ast.parse(file.read_text("utf-8"))
        texts = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
        keys = {
            ast.unparse(node.slice) for node in ast.walk(tree) if isinstance(node, ast.Subscript)
        }
        assert not texts & names, file.name
        assert "'family'" not in keys, file.name
