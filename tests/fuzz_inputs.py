"""Hostile case files, records, command lines and values of Python: each is shown or refused in a sentence.

Run beside the suite: `python tests/fuzz_inputs.py --seconds 300 --seed 1`. A seed repeats its files.
Prints how they ended; whatever ends in a traceback, in lines that are no sentences or in signs that steer a
terminal is kept in a folder with its command line, and the exit status is then 1.
"""

import argparse
import contextlib
import copy
import datetime
import io
import json
import math
import random
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import jax
import numpy as np

from pitchpoint import Case, cli, study
from pitchpoint.cases.document import read_tables
from pitchpoint.cases.keys import keys
from pitchpoint.cases.library import case_names, case_path
from pitchpoint.cases.wishes import WISHES
from pitchpoint.errors import InputError
from pitchpoint.results.store import without_nan
from pitchpoint.runs.run import uncomputed_manifests

ROOT = Path(__file__).parents[1]
SEEDS = [read_tables(path) for path in sorted(ROOT.glob("examples/*.toml"))]
SEEDS += [read_tables(case_path(name)) for name in case_names()]
RECORDED = ("pair_23_61", "helical_resonance", "strain_wave", "two_stage", "planetary")
KEYS = [
    *keys(),
    "losses.a.bearing",
    "losses.a.between",
    "studies.a.sweep",
    "studies.a.change.gears",
    "variants",
    "variants.a",
    "variants.a.value",
    *(f"film.heights.both.{key}" for key in ("file", "direction", "step_along")),
    "worn.file",
    *(f"{table}.{name}" for table in WISHES for wish in WISHES[table] for name in wish.names),
    "gears.diametral_pitch",
]

OTHERS = ("broken", "of another kind", "command line", "name", "python")
"""Kinds of files, commands and values of Python beside those whose values are changed."""

RECORDS = 0.25
"""Part of the files that are records of results."""

NUMBERS = (
    10**400,
    0,
    -0.0,
    1,
    -1,
    2,
    3.5,
    1e-300,
    1e308,
    -1e308,
    math.inf,
    -math.inf,
    math.nan,
    10**30,
)
UNITS = (
    "mm",
    "m",
    "deg",
    "N m",
    "kgf cm",
    "rpm",
    "degC",
    "GPa",
    "um",
    "mm2/s",
    "1/GPa",
    "kg",
    "%",
    "",
    *("C", "F", "min-1", "min⁻¹", "DP", "1/in", "ft-lb", "micron", "grad", "kW", "m/s"),
)
SIGNS = (
    "\x1b[2J",
    "\x1b]0;x\x07",
    "\x9b31m",
    "\u202e",
    "\x00",
    "[red]",
    "é",
    "😀",
    "\\",
    '"',
    "\n",
    ".",
    ",",
    "“",
    "’",
)
TEXTS = (
    "=cmd|' /C calc'!A0",
    "x; =1+1",
    '"""\nimport os\n"""',
    "*/ x /*",
    "1e400",
    "-1e400 mm",
    "/dev/zero",
    "/dev/stdin",
    "/proc/self/mem",
    ".",
    "_",
    "~",
    "/",
)
"""What would run, has no end or no letter elsewhere."""

COMMANDS = ("new", "docs", "models", "cite", "open", "show", "check", "export")
"""Commands that take a name."""

LONG = ("k" * 100_000, "." * 5000, "a.b" * 2000, "9" * 4000, "[" * 3000, " " * 3000)


class Hostile:
    """Random values and changes, repeatable by their seed."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def value(self, depth: int = 0) -> Any:
        pick = self.random.choice
        kinds = [self.number, self.quantity, self.text, lambda: pick((True, False))]
        if depth < 3:
            kinds += [
                lambda: [self.value(depth + 1) for _ in range(self.random.randrange(4))],
                lambda: {self.text()[:40]: self.value(depth + 1) for _ in range(2)},
                lambda: {"value": self.value(depth + 1), "status": self.text()},
            ]
        return pick([*kinds, lambda: datetime.date(2024, 1, 31), lambda: pick(case_names())])()

    def number(self) -> float | int:
        own = self.random.uniform(-3, 3) * 10 ** self.random.uniform(-6, 6)
        return self.random.choice((*NUMBERS, own, round(own)))

    def quantity(self) -> str:
        text = f"{self.number()} {self.random.choice(UNITS)}"
        return self.random.choice((text, text, text.replace(".", ","), f"“{text}”"))

    def text(self) -> str:
        signs = "".join(self.random.choices(SIGNS, k=self.random.randrange(1, 4)))
        return self.random.choice(
            (
                *(signs, "x", "", "gear 1", "steel", "equal"),
                self.random.choice(LONG),
                self.random.choice(TEXTS),
            )
        )

    def scaled(self, value: Any) -> Any:
        """About the value that was given: still plausible, or nearly so."""
        factor = self.random.choice((0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 100.0, -1.0, 0.0))
        if isinstance(value, bool):
            return not value
        if isinstance(value, int):
            return round(factor * value)
        if isinstance(value, float):
            return factor * value
        if isinstance(value, list):
            return [self.scaled(one) for one in value]
        if isinstance(value, dict):
            return {**value, "value": self.scaled(value["value"])} if "value" in value else value
        number, _, unit = str(value).partition(" ")
        with contextlib.suppress(ValueError):
            return f"{factor * float(number):.8g} {unit}"
        return value

    def unusual(self, tree: dict[str, Any]) -> dict[str, Any]:
        """Copy with the size of one to three values changed."""
        tree = copy.deepcopy(tree)
        for _ in range(self.random.randrange(1, 4)):
            table, key = self.random.choice([*places(tree)])
            table[key] = self.scaled(table[key])
        return tree

    def changed(self, tree: dict[str, Any]) -> dict[str, Any]:
        """Copy with one to four places changed, removed, renamed or added."""
        tree = copy.deepcopy(tree)
        for _ in range(self.random.choice((1, 1, 2, 4))):
            table, key = self.random.choice([*places(tree)])
            match self.random.randrange(8):
                case 0:
                    table[key] = self.value()
                case 1 if isinstance(table, dict):
                    table[self.text()] = table.pop(key)
                case 2:
                    del table[key]
                case 3:
                    put(tree, self.random.choice(KEYS), self.value())
                case 4:
                    table[key] = [copy.deepcopy(table[key])] * self.random.choice((0, 2, 300))
                case _:
                    table[key] = self.scaled(table[key])
        return tree

    def arguments(self) -> list[str]:
        """Options of a command line."""
        key = self.random.choice((*KEYS, self.text(), f"{self.random.choice(KEYS)}.{self.text()}"))
        options = (
            ["--set", f"{key}={self.text()}"],
            ["--set", f"{key}={toml(self.value())}"],
            ["--set", f"{key}={self.quantity()}"],
            ["--variant", self.text()],
            ["--json"],
            [],
        )
        chosen = [one for _ in range(2) for one in self.random.choice(options)]
        return [one.replace("\x00", "") for one in chosen]

    def of_python(self) -> Any:
        """A value that Python may hand over, of another kind than tables of a case file hold."""
        itself: dict[str, Any] = {}
        itself["a"] = [itself]
        deep: Any = self.value()
        for _ in range(self.random.choice((1, 20, 5000))):
            deep = self.random.choice(([deep], {"a": deep}, (deep, deep)))
        kinds = (Fraction(1, 3), Decimal("1.5"), 1j, b"1", {1, 2}, len, object(), "\udc80")
        arrays = (np.array([1j]), np.array([object()]), np.float32(3.0), np.zeros((2, 2, 2)))
        return self.random.choice((*kinds, *arrays, {(1, 2): 3}, itself, deep, self.value()))

    def broken(self, content: bytes) -> bytes:
        """The file with some of its bytes changed, doubled or cut off."""
        content = bytearray(content)
        for _ in range(self.random.randrange(1, 6)):
            place = self.random.randrange(len(content) + 1)
            content[place : place + self.random.randrange(3)] = self.random.randbytes(
                self.random.randrange(3)
            )
        return bytes(content[: self.random.choice((len(content), len(content) // 2))])

    def of_another_kind(self, content: bytes) -> bytes:
        """The file as another program, editor or format would have it."""
        text = content.decode()
        made = (
            text.replace('"', self.random.choice("“”„’«")),
            text.replace(".", ","),
            text.replace(" = ", self.random.choice((": ", ";", "\t", ","))),
            text.replace('"', ""),
            f"{{{text}}}",
            f"{self.random.choice(('<?xml?>', '- ', '---', 'a,b', '#'))}\n{text}",
        )
        coding = self.random.choice(("utf-8", "utf-16", "latin-1", "cp1252", "utf-32"))
        return self.random.choice(made).encode(coding, "replace")


def places(node: Any) -> Iterator[tuple[Any, Any]]:
    """Every table or list and key in it."""
    for key in list(node) if isinstance(node, dict) else range(len(node)):
        yield node, key
        if isinstance(node[key], dict | list):
            yield from places(node[key])


def put(tree: dict[str, Any], key: str, value: Any) -> None:
    *above, last = key.split(".")
    for part in above:
        if not isinstance(tree.get(part), dict):
            tree[part] = {}
        tree = tree[part]
    tree[last] = value


def toml(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(k)} = {toml(v)}' for k, v in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml, value))}]"
    return json.dumps(value) if isinstance(value, str | bool) else str(value)


def ended(arguments: list[str]) -> str:
    """How a command ended; raises AssertionError, or whatever ends it in a traceback."""
    out, err = io.StringIO(), io.StringIO()
    sys.argv = ["pitchpoint", *arguments]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            cli.main()
    except SystemExit as done:
        status = int(done.code or 0)
    told = out.getvalue() + err.getvalue()
    steering = {sign for sign in told if not sign.isprintable()} - {"\n"}
    assert not steering, f"steers the terminal: {steering}"
    if status == 0:
        return "shown"
    assert status == 2, f"exit status {status}"
    assert out.getvalue() == "", "refused after it was shown"
    lines = err.getvalue().splitlines()
    assert lines and all(line.startswith("error: ") for line in lines), "not a sentence a line"
    assert all(len(line) < 1000 for line in lines), "a long sentence"
    return "refused"


def handed_over(value: Any, key: str) -> str:
    """How a value of Python ended at one of the doors; raises whatever is no sentence."""
    pair = SEEDS[0]
    doors = (
        lambda: Case({**pair, key.partition(".")[0]: value}),
        lambda: Case(value),
        lambda: Case(pair).set({key: value}),
        lambda: Case(pair).set(value),
        lambda: uncomputed_manifests(Case(pair), settings={key: value}),
        lambda: study(pair, {key: [value, value]}, how="zip", n=value, seed=value),
    )
    refused = 0
    for door in doors:
        try:
            door()
        except InputError as error:
            refused += 1
            assert all(len(line) < 1000 for line in str(error).splitlines()), "a long sentence"
    return "refused" if refused else "shown"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=300.0, help="of processor time")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path(tempfile.mkdtemp(prefix="hostile-")))
    given = parser.parse_args()
    given.keep.mkdir(parents=True, exist_ok=True)
    counts, slow = Counter[str](), (0.0, -1)
    records = [
        uncomputed_manifests(str(ROOT / "examples" / f"{name}.toml"))[0] for name in RECORDED
    ]
    start = time.process_time()
    while time.process_time() - start < given.seconds:
        seed = given.seed + counts.total()
        hostile, began = Hostile(seed), time.process_time()
        is_record = hostile.random.random() < RECORDS
        tree = hostile.random.choice(records if is_record else SEEDS)
        kind = hostile.random.choice(("unusual", "unusual", "changed", *OTHERS))
        changed = {"unusual": hostile.unusual, "changed": hostile.changed}.get(kind, dict)(tree)
        path = given.keep / f"case.{'json' if is_record else 'toml'}"
        if is_record:
            content = json.dumps(without_nan(changed), default=str).encode()
        else:
            content = "".join(f"{json.dumps(k)} = {toml(v)}\n" for k, v in changed.items()).encode()
        spoilt = {"broken": hostile.broken, "of another kind": hostile.of_another_kind}
        path.write_bytes(spoilt.get(kind, bytes)(content))
        arguments = ["show", str(path), *(hostile.arguments() if kind == "command line" else [])]
        if kind == "name":
            command, name = hostile.random.choice(COMMANDS), hostile.text().replace("\0", "")
            arguments = [command, name, *["--csv"] * (command == "export")]
        key = hostile.random.choice(KEYS)
        try:
            counts[
                handed_over(hostile.of_python(), key) if kind == "python" else ended(arguments)
            ] += 1
        except Exception as error:
            name = f"{type(error).__name__}: {str(error)[:80]!a}"
            counts[name] += 1
            (given.keep / f"{seed}{path.suffix}").write_bytes(path.read_bytes())
            told = json.dumps(arguments) + "\n" + traceback.format_exc()
            (given.keep / f"{seed}.txt").write_text(told, "utf-8", "backslashreplace")
        slow = max(slow, (time.process_time() - began, seed))
        if counts.total() % 300 == 0:
            jax.clear_caches()  # programs of ever other tooth numbers exhaust the memory maps
    for name, count in counts.most_common():
        print(f"{count:7d}  {name}")
    print(f"slowest {slow[0]:.1f} s, seed {slow[1]}; seeds from {given.seed}; kept in {given.keep}")
    return int(counts.total() != counts["shown"] + counts["refused"])


if __name__ == "__main__":
    raise SystemExit(main())
