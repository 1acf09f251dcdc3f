"""What a command loads: nothing that computes where nothing is computed, and of many families its own."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from pitchpoint.registry import Deferred, Registry

EXAMPLES = Path(__file__).parents[2] / "examples"

LOADED = """
import sys
from pitchpoint.cli import main
sys.argv = ["pitchpoint", *sys.argv[1:]]
try:
    main()
except SystemExit as stop:
    assert not stop.code, stop.code
print("loaded:", *sys.modules, file=sys.stderr)
"""


def loaded(*command: str) -> set[str]:
    """Modules that a process of its own has at the end of a command."""
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *command],
        env={**os.environ, "JAX_PLATFORMS": "cpu"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return set(done.stderr.rpartition("loaded:")[2].split())


@pytest.mark.parametrize(
    "command",
    [
        ["--help"],
        ["--version"],
        ["cases"],
        ["new", "helical"],
        ["new", "two_stages"],
        ["new", "size"],
        ["schema"],
    ],
    ids="_".join,
)
def test_what_only_tells_loads_nothing_that_computes(command: list[str]) -> None:
    heavy = {"jax", "jaxlib", "equinox", "scipy", "pandas", "xarray", "h5py", "plotly", "diffrax"}
    assert not loaded(*command) & heavy


@pytest.fixture(scope="module")
def of_a_pair(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    folder = tmp_path_factory.mktemp("pair") / "result"
    return loaded("run", str(EXAMPLES / "pair_23_61.toml"), "-o", str(folder))


OTHERS = re.compile(
    r"pitchpoint\.("
    r"gears\.(strain_wave|torus|rack_and_pinion|ball_on_disc|rigs)\.(?!table$|\w+_registry$|proportions$)"
    r"|published\.\w+\.(?!table$)"
    r"|lubrication\.ehl\.(?!ehl_registry$|film_tables$|patch$|patch\.heights$)"
    r"|wear\.(?!wear_(registry|stages|tables)$)"
    r"|dynamics\.(?!dynamics_registry$|vibration_tables$)"
    r"|analyses\.(joint|torsion|motion|vibration|four_quadrants|kinematic_error|load_limits|film_\w+)$"
    r")"
)
"""What other gears, other papers, and tables that a pair does not have are computed with."""

MOST = 243
"""Modules of the package in a run of a spur pair, beside those that hold tables of case files; the folder
`core` is one of them.
"""


def test_a_pair_loads_nothing_of_what_it_does_not_ask_for(of_a_pair: set[str]) -> None:
    assert not [name for name in sorted(of_a_pair) if OTHERS.match(name)]


def test_a_pair_loads_no_solver_of_differential_equations(of_a_pair: set[str]) -> None:
    never = {"diffrax", "optimistix", "lineax", "openpyxl", "plotly.graph_objects"}
    never |= {f"scipy.{name}" for name in ("integrate", "optimize", "interpolate", "stats", "io")}
    assert not of_a_pair & never


def test_a_pair_loads_half_of_the_package(of_a_pair: set[str]) -> None:
    tables = re.compile(r".*[._]tables?$")
    loading = [
        name for name in of_a_pair if name.startswith("pitchpoint.") and not tables.fullmatch(name)
    ]
    assert len(loading) <= MOST, len(loading)


class Law:
    """Stands for an entry of a registry."""

    function: Deferred[object] = Deferred()

    def __init__(self, name: str, function: object) -> None:
        self.name, self.function = name, function  # type: ignore[assignment]


def test_code_is_loaded_when_it_is_chosen_and_not_before() -> None:
    sys.modules.pop("colorsys", None)
    known = Registry("law", Law("direct", len), Law("later", "colorsys:rgb_to_hsv"))
    assert known["direct"].function is len
    assert list(known) == ["direct", "later"] and "colorsys" not in sys.modules
    function = known["later"].function
    assert function is sys.modules["colorsys"].rgb_to_hsv is known["later"].function


def test_an_entry_may_be_known_by_its_name_and_place_alone() -> None:
    sys.modules.pop("colorsys", None)
    known = Registry("law", Law("direct", len), places={"later": "pitchpoint.cases.laws:FRICTION"})
    assert "later" in known and [*known] == ["direct", "later"]
    assert known["later"] is sys.modules["pitchpoint.cases.laws"].FRICTION
