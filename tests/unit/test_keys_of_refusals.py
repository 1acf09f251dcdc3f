"""What refuses gears names the key of the case file at which they can be changed."""

import ast
import inspect
from collections.abc import Iterator
from types import ModuleType

import pytest

from pitchpoint.cases import oils
from pitchpoint.cases.keys import quantity_at
from pitchpoint.gears.cylindrical import checks
from pitchpoint.gears.cylindrical import design as cylindrical_design
from pitchpoint.gears.cylindrical import family as cylindrical
from pitchpoint.gears.rack_and_pinion import checks as rack_checks
from pitchpoint.gears.rack_and_pinion import family as rack
from pitchpoint.gears.strain_wave import design
from pitchpoint.gears.strain_wave import family as strain_wave

MODULES = (
    checks,
    cylindrical_design,
    cylindrical,
    rack_checks,
    rack,
    design,
    strain_wave,
)
MEMBER = "driver"  # a case checks it before it builds: operation.driver


def keys_told(module: ModuleType) -> Iterator[str]:
    """Every key that a refusal of a module may name.

    First words of `_refuse`, `key=` of an error, or the second of three that a check yields.
    """
    for node in ast.walk(ast.parse(inspect.getsource(module))):
        told = node.value if isinstance(node, ast.Yield) else None
        if isinstance(told, ast.Tuple) and len(told.elts) == 3:
            yield from words(told.elts[1])
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            given = {keyword.arg: keyword.value for keyword in node.keywords}
            if node.func.id == "_refuse":
                yield from words(node.args[0])
            elif node.func.id == "InputError" and "key" in given:
                yield from words(given["key"])


def words(node: ast.expr) -> Iterator[str]:
    """Values of an expression that names one key or another."""
    if isinstance(node, ast.IfExp):
        yield from (*words(node.body), *words(node.orelse))
    elif isinstance(node, ast.Constant):
        yield node.value


TOLD = sorted({(module.__name__, key) for module in MODULES for key in keys_told(module)})


def test_the_checks_are_found() -> None:
    found = {key for _, key in TOLD}
    assert {"addendum", "face_width", "clearance", "form", "force_angle", "bore_diameter"} <= found
    assert {module for module, _ in TOLD} >= {checks.__name__, design.__name__}


@pytest.mark.parametrize(("module", "key"), TOLD)
def test_every_key_is_one_of_the_schema(module: str, key: str) -> None:
    if key != MEMBER:
        quantity_at(f"gears.{strain_wave._KEYS.get(key, key)}")


@pytest.mark.parametrize("key", sorted(set(oils._OIL_KEYS.values())))
def test_every_key_of_an_oil_is_one_of_the_schema(key: str) -> None:
    assert quantity_at(f"lubricant.{key}") is not None
