"""The loss map of the output as files that need nothing else: a module of Python and a header of C."""

import ast
import math
import re
from collections.abc import Iterable, Sequence
from importlib.resources import files
from pathlib import Path
from textwrap import wrap
from typing import Any

from pitchpoint.analyses.analysis_registry import FOUR_QUADRANTS
from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.analyses.main_figures import error_words
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError
from pitchpoint.results.store import write_text
from pitchpoint.runs.joint_model import map_of_output
from pitchpoint.runs.run import Outcome

__all__ = [
    "SIGNS",
    "comment_text",
    "demand_small_table",
    "evaluator",
    "header",
    "map_code",
    "module",
    "module_head",
    "source_after_statements",
]

MOST = 500_000
"""Losses that go into a file."""

SIGNS = (
    "Torque and speed are those of the output, positive the same way; the torque is that of the output on "
    "its load. Where both have one sign the driver drives (quadrants I and III), where they differ the load "
    "drives (II and IV). The torque of the driver is positive where it acts along a positive speed of the "
    "output. Power balances: torque times speed of the driver = torque times speed of the output + loss."
)
BETWEEN = (
    "Every third torque beyond the least, every third speed and temperature of the table is as computed. "
    "Values between follow powers of "
    "load and speed and exponentials of the temperature, by monotone cubics of logarithms; so do those down "
    "to an eighth of the least load. The torque that is lost is linear between the values of the table over "
    "torque, temperature and the logarithm of the speed. Below the lowest speed that is not zero it stays as "
    "it is there, while laws of friction may rise on towards rest without bound; what holds the drive at "
    "rest and starts it is that of at_rest, from which friction falls to that of motion at once. Torque of "
    "the driver and efficiency follow from the balance of power."
)
BEYOND = (
    "Beyond the table the torque that is lost is that of the nearest point in it, and outside is true. Where "
    "friction locks the drive against its output, or does so at a node beside, locked is true and the rest "
    "is NaN. The efficiency is NaN too where no power comes out, as where both ends put power in."
)
AT_REST = (
    "At rest no power is lost, and the torque of the driver may have any value of a band: at has NaN for it "
    "at a speed of zero, where a simulation has to ask at_rest. That gives for "
    "a load the torque below which it moves back and that above which it is moved on, in the mean over the "
    "phases of the teeth, with what holds bearings and seals at rest. By the spread of that, lowest_low to "
    "highest_high is the widest band, and from lowest_high to highest_low the drive surely holds. Where the "
    "band has zero in it the drive holds the load without its driver."
)


def evaluator(outcome: Outcome, folder: Path) -> list[Path]:
    """Write module and header into a folder.

    Raises:
        InputError: the result has no such map, or too large a one.
    """
    try:
        data = map_of_output(outcome)
    except InputError as error:
        raise error.at(key="--evaluator") from None
    try:
        table = table_of(data)
        texts = {"loss_table.py": module(outcome, table), "loss_table.h": header(outcome, table)}
    except (
        AttributeError,
        LookupError,
        TypeError,
        ValueError,
    ):  # of another version, or another's hand
        sentence = (
            f"the {FOUR_QUADRANTS.title} is not as this version writes it; run the case again"
        )
        raise InputError(sentence, key="--evaluator") from None
    demand_small_table(table, "--evaluator")
    for name, text in texts.items():
        write_text(folder / name, text)
    return [folder / name for name in texts]


def demand_small_table(table: LossTable, key: str) -> None:
    """InputError at a key unless a table fits into a file of source."""
    axes = table.loss_torques, table.torques, table.speeds, table.temperatures
    points = math.prod(map(len, axes))
    if points > MOST:
        raise InputError(
            f"the table of the {FOUR_QUADRANTS.title} has {points} values, and {MOST} is the most for "
            "a file of source; take a lower loss_map.count",
            key=key,
        )


def module(outcome: Outcome, table: LossTable) -> str:
    """The map as a module of Python without dependencies.

    Args:
        outcome: with the map.
        table: made of it.
    """
    usage = [
        "    python loss_table.py --torque 5 --speed -3 --temperature 40",
        "    from loss_table import at",
        "    at(5.0, -3.0, 40.0).input_torque",
        "    at_many([5.0, 6.0], [-3.0, 2.0], [40.0, 40.0]).input_torque  # with NumPy",
        "    at_rest(5.0, 40.0).highest",
    ]
    needs = "Python 3.10 or later; nothing else is needed but for arrays."
    head = module_head([*_told(outcome, table), "\n".join(usage), needs])
    names = ["ABOUT", "TABLE", "Point", "Rest", "at", "at_many", "at_rest"]
    return (
        f"{head}{map_code(outcome, table, names)}\n"
        'if __name__ == "__main__":\n    raise SystemExit(main(TABLE, __doc__))\n'
    )


def module_head(paragraphs: Iterable[str]) -> str:
    """Docstring of a module that is exported; those that are indented are lines as they stand."""
    wrapped = (
        paragraph if paragraph.startswith(" ") else "\n".join(wrap(paragraph, 100))
        for paragraph in paragraphs
    )
    return '"""' + "\n\n".join(wrapped) + '\n"""\n'


def map_code(outcome: Outcome, table: LossTable, names: Sequence[str]) -> str:
    """Code of a module that holds the map, without its docstring.

    Args:
        outcome: with the map.
        table: made of it.
        names: that the module is for.
    """
    source = files("pitchpoint.efficiency").joinpath("loss_table.py").read_text("utf-8")
    code = source_after_statements(source, 1)
    public = "".join(f'"{name}", ' for name in names).removesuffix(", ")
    code = re.sub(r"^__all__ = .*$", f"__all__ = [{public}]", code, count=1, flags=re.M)
    about = ", ".join(f"{key!a}: {text!a}" for key, text in _origin(outcome).items())
    fields = "".join(f"    {key}={_literal(field)},\n" for key, field in table._asdict().items())
    return (
        f"{code}\n\n"
        f"ABOUT = {{{about}}}\n"
        f'"""Where the table comes from."""\n\n'
        f"TABLE = LossTable(\n{fields})\n"
        "at, at_many, at_rest = TABLE.at, TABLE.at_many, TABLE.at_rest\n"
    )


def source_after_statements(source: str, count: int) -> str:
    """Source behind so many of its first statements."""
    end_line = ast.parse(source).body[count - 1].end_lineno
    return "".join(source.splitlines(keepends=True)[end_line:])


def header(outcome: Outcome, table: LossTable) -> str:
    """The map as a header of C99 that allocates nothing.

    Args:
        outcome: with the map.
        table: made of it.
    """
    code = files("pitchpoint.exports").joinpath("loss_table.h").read_text("utf-8")
    shape = len(table.loss_torques), len(table.torques), len(table.speeds), len(table.temperatures)
    names = ("LAWS", "TORQUES", "SPEEDS", "TEMPERATURES")
    usage = (
        "struct loss_table_point here = loss_table_at(5.0, -3.0, 40.0, 0); the last number is that of the "
        'friction law, by name loss_table_law("..."). loss_table_at_many takes arrays, loss_table_at_rest '
        "gives the torques that hold a load. C99 with math.h and string.h."
    )
    head = "\n *\n * ".join(
        "\n * ".join(wrap(text, 100)) for text in (*_told(outcome, table), usage)
    )
    sizes = "".join(f"#define LOSS_TABLE_{n} {k}\n" for n, k in zip(names, shape, strict=True))
    driver = comment_text(table.units[-1])
    usual = {
        law: [[column[0] for column in values]] * 2 for law, values in table.loss_torques.items()
    }
    arrays = {
        "torques[LOSS_TABLE_TORQUES]": table.torques,
        "speeds[LOSS_TABLE_SPEEDS]": table.speeds,
        "temperatures[LOSS_TABLE_TEMPERATURES]": table.temperatures,
        "loss_torques[LOSS_TABLE_LAWS][LOSS_TABLE_TORQUES][LOSS_TABLE_SPEEDS][LOSS_TABLE_TEMPERATURES]": [
            *table.loss_torques.values()
        ],
        "rest_bounds[LOSS_TABLE_LAWS][2][LOSS_TABLE_TORQUES][LOSS_TABLE_TEMPERATURES]": [
            *(table.rest_bounds or usual).values()
        ],
    }
    texts = {**_origin(outcome), "law_names[LOSS_TABLE_LAWS]": [*table.loss_torques]}
    return (
        f"/* {head}\n */\n#ifndef LOSS_TABLE_H\n#define LOSS_TABLE_H\n\n"
        f"#include <math.h>\n#include <string.h>\n\n{sizes}"
        f"#define LOSS_TABLE_SPEED_RATIO {table.speed_ratio!r}\n\n"
        "struct loss_table_point {\n"
        f"    double loss;         /* W */\n    double efficiency;\n"
        f"    double input_torque; /* {driver} */\n    int locked, outside;\n}};\n"
        "struct loss_table_rest {\n"
        f"    double lowest, highest; /* {driver} */\n    int locked, outside;\n"
        "    double lowest_low, lowest_high, highest_low, highest_high;\n};\n\n"
        + "".join(f"static const char *const loss_table_{n} = {_c(v)};\n" for n, v in texts.items())
        + "".join(f"static const double loss_table_{n} = {_c(v)};\n" for n, v in arrays.items())
        + f"\n{code}"
    )


def _told(outcome: Outcome, table: LossTable) -> Iterable[str]:
    """What stands at the head of a file, made of signs that end no comment."""
    return map(comment_text, _head(outcome, table))


def _head(outcome: Outcome, table: LossTable) -> Iterable[str]:
    data = outcome.parts[FOUR_QUADRANTS.name]
    torque, speed, driver = table.units

    def in_units(name: str, value: float) -> str:
        return f"{value:.4g} {data[name].attrs['units']}"

    yield "Loss of a drive and torque of its driver at any torque and speed of its output."
    yield SIGNS
    yield f"Units: torque {torque}, speed {speed}, torque of the driver {driver}, temperature degC, loss W."
    yield BETWEEN
    yield (
        "Error of the loss against direct computation, by friction law: "
        + "; ".join(error_words(data, law, in_units) for law in range(len(table.loss_torques)))
        + ". More values of loss_map.count and loss_map.temperatures bring it down, a lower "
        "loss_map.lowest_speed that of slow motion."
    )
    yield BEYOND
    yield AT_REST
    yield str(data.attrs["note"])
    yield from (f"Doubtful: {text}" for text in outcome.manifest["warnings"])
    yield f"Made by Pitchpoint {data.attrs['version']}."


def _origin(outcome: Outcome) -> dict[str, str]:
    """Case, variant and title as given, digest of the inputs, version."""
    data = outcome.parts[FOUR_QUADRANTS.name]
    return {
        "case": str(outcome.manifest["case"]),
        "variant": str(outcome.manifest["variant"]),
        "title": str(outcome.manifest["title"]),
        "digest": str(data.attrs["fingerprint"]),
        "version": str(data.attrs["version"]),
    }


def _literal(value: Any) -> str:
    """A value of the table as Python has it, without names beside `float`."""
    if isinstance(value, dict):
        return (
            "{" + ", ".join(f"{key!a}: {_literal(element)}" for key, element in value.items()) + "}"
        )
    if isinstance(value, Sequence) and not isinstance(value, str):
        return "(" + "".join(f"{_literal(element)},{_apart(value)}" for element in value) + ")"
    if isinstance(value, float) and not math.isfinite(value):
        return {"nan": "math.nan", "inf": "math.inf"}.get(str(value), "-math.inf")
    return ascii(value)


def _c(value: Any) -> str:
    """A value of the table as C has it; bytes of a text that are no plain letters as octal numbers."""
    if isinstance(value, str):
        plain = {
            *b" !#$%&'()+,-./:;<=>@[]^_`{|}~",
            *range(48, 58),
            *range(65, 91),
            *range(97, 123),
        }
        return '"' + "".join(chr(b) if b in plain else f"\\{b:03o}" for b in value.encode()) + '"'
    if isinstance(value, Sequence):
        return "{" + f",{_apart(value)}".join(map(_c, value)) + "}"
    number = repr(float(value))
    return {"nan": "NAN", "inf": "INFINITY", "-inf": "-INFINITY"}.get(number, number)


def _apart(values: Sequence[Any]) -> str:
    """What stands between values: rows of a table have lines of their own."""
    rows = bool(values) and isinstance(values[0], Sequence) and not isinstance(values[0], str)
    return "\n    " if rows else " "


def comment_text(text: str) -> str:
    """Text for a comment of C and of Python, whoever wrote it: nothing in it ends or continues a line."""
    return re.sub(r"[^A-Za-z0-9 _+.,;:()%/=<>'^-]", "_", text)
