"""Examples in docstrings print what they say to a reader who imports nothing but what they import."""

import ast
import doctest
from importlib import import_module
from pathlib import Path

import equinox as eqx
import pytest

import pitchpoint

ROOT = Path(pitchpoint.__file__).parent
DOCUMENTED = ast.ClassDef | ast.FunctionDef


def _read(path):
    """Module, the public name that stands in it, and each docstring below it that holds an example."""
    module = ".".join(path.relative_to(ROOT.parent).with_suffix("").parts)
    source = path.read_text(encoding="utf-8")
    for top in ast.parse(source).body if ">>> " in source else ():
        for node in ast.walk(top):
            text = ast.get_docstring(node) if isinstance(node, DOCUMENTED) else None
            if text and ">>> " in text:
                yield pytest.param(module, top.name, text, id=f"{module}.{top.name}:{node.name}")


EXAMPLES = [example for path in sorted(ROOT.rglob("*.py")) for example in _read(path)]


def _complaints(text, known):
    test = doctest.DocTestParser().get_doctest(text, known, "example", None, 0)
    told = []
    doctest.DocTestRunner(verbose=False).run(test, out=told.append)
    return "".join(told)


COMPILED = {
    "pitchpoint.contact.asperities": ["gaussian_moment"],
    "pitchpoint.contact.ellipse": ["hertz_1881", "largest_shear"],
    "pitchpoint.loading.equilibrium": ["equilibrium"],
    "pitchpoint.lubrication.flow_factors": ["mean_gap"],
}
"""Functions of many operations, each of them a program of its own where nobody compiles them together."""


@pytest.mark.parametrize(("module", "name", "text"), EXAMPLES)
def test_examples_print_what_they_say(module, name, text, monkeypatch):
    room = import_module(module)
    for function in COMPILED.get(module, ()):
        monkeypatch.setattr(room, function, eqx.filter_jit(getattr(room, function)))
    assert _complaints(text, {name: getattr(room, name)}) == ""


def test_every_example_is_run():
    written = sum(path.read_text(encoding="utf-8").count(">>> ") for path in ROOT.rglob("*.py"))
    assert sum(example.values[2].count(">>> ") for example in EXAMPLES) == written


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        (">>> known()\n1\n", ""),
        (">>> known()\n2\n", "Got:\n    1"),
        (">>> elsewhere\n3\n", "name 'elsewhere' is not defined"),
    ],
)
def test_a_wrong_example_and_a_missing_import_are_told(text, complaint):
    told = _complaints(text, {"known": lambda: 1})
    assert complaint in told
    assert bool(told) == bool(complaint)
