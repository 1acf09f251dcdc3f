"""A drive as a unit of FMI 2.0 for co-simulation: its loss map in C, with a binary where a compiler is."""

import io
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from hashlib import sha256
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple
from uuid import UUID
from xml.sax.saxutils import quoteattr

from pitchpoint.errors import visible
from pitchpoint.exports.evaluator import demand_small_table, header
from pitchpoint.exports.simulators import HandedOver, Simulated, heading, nothing_lost, xml_comment
from pitchpoint.results.store import write_bytes

__all__ = ["SimulationUnit", "UnitVariable", "write_fmu", "write_unit"]

BESIDE = (
    "The unit has no state: inertia, stiffness, play, ripple and kinematic error are not in it."
)

FLAGS = ("-std=c99", "-O2", "-shared", "-fPIC", "-fvisibility=hidden", "-ffp-contract=off")

_CMAKE = """cmake_minimum_required(VERSION 3.10)
project({name} C)
set(CMAKE_C_STANDARD 99)
add_library({name} SHARED joint_fmu.c)
set_target_properties({name} PROPERTIES PREFIX "")
if(UNIX)
  target_link_libraries({name} m)
endif()
"""

_UNITS = {
    "N m": 'kg="1" m="2" s="-2"',
    "N": 'kg="1" m="1" s="-2"',
    "rad/s": 'rad="1" s="-1"',
    "m/s": 'm="1" s="-1"',
    "W": 'kg="1" m="2" s="-3"',
    "degC": 'K="1" offset="273.15"',
    "rad": 'rad="1"',
    "m": 'm="1"',
    "kg m2": 'kg="1" m="2"',
    "kg": 'kg="1"',
    "N m s/rad": 'kg="1" m="2" s="-1" rad="-1"',
    "N s/m": 'kg="1" s="-1"',
    "1": "",
}


class UnitVariable(NamedTuple):
    """A variable of a unit, whose place is its value reference.

    Attributes:
        name, words: of it.
        unit: of a number; none of what is true or false.
        start: of what is set from outside; None of an output.
        parameter: True for what is set before the start, "tunable" for what is set at any time.
    """

    name: str
    words: str
    unit: str = ""
    start: float | None = None
    parameter: bool | str = False


class SimulationUnit(NamedTuple):
    """What makes a unit beside its joint.

    Attributes:
        name: of model, library and file.
        what: it is, in a sentence.
        variables: in the order of their numbers in C.
        model: file of C with its equations.
        numbers: lines of C with the numbers that it asks for.
        notes: paragraphs of its page.
    """

    name: str
    what: str
    variables: list[UnitVariable]
    model: str
    numbers: str = ""
    notes: tuple[str, ...] = ()


def write_fmu(given: Simulated, folder: Path) -> HandedOver:
    """Write the loss map as a unit.

    Args:
        given: the joint.
        folder: of the file.

    Raises:
        InputError: the map is too large for a file of source.
    """
    what = "Loss map of a drive for co-simulation, FMI 2.0."
    unit = SimulationUnit(given.name, what, _variables(given), "joint_map.h")
    return write_unit(given, folder, unit, "--fmu", BESIDE)


def write_unit(
    given: Simulated, folder: Path, unit: SimulationUnit, key: str, beside: str
) -> HandedOver:
    """Write a unit: description, sources with CMake, documentation, and a binary if a compiler is there.

    Args:
        given: the joint, whose map the unit has.
        folder: of the file.
        unit: what makes it.
        key: option that asks for it.
        beside: what else it leaves out, in a sentence.

    Raises:
        InputError: the map is too large for a file of source.
    """
    demand_small_table(given.joint.table, key)
    lost = nothing_lost(beside)
    sources = _sources(given, unit)
    binaries = _binary(unit, sources)
    if not binaries:
        lost = [*lost, "No compiler of C (cc) made a binary: the unit has sources alone."]
    texts = {
        "modelDescription.xml": _description(given, unit, lost),
        "documentation/index.html": _page(given, unit, lost),
        **{f"sources/{name}": text for name, text in sources.items()},
    }
    content = {name: text.encode("utf-8") for name, text in texts.items()} | binaries
    path = folder / f"{unit.name}.fmu"
    write_bytes(path, _zipped(content))
    return HandedOver([path], lost)


def _zipped(content: dict[str, bytes]) -> bytes:
    """An archive that is the same for the same content."""
    image = io.BytesIO()
    with zipfile.ZipFile(image, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, held in content.items():
            archive.writestr(
                zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), held, zipfile.ZIP_DEFLATED
            )
    return image.getvalue()


def _guid(given: Simulated, unit: SimulationUnit) -> str:
    joint = given.joint
    identity = repr(
        (
            joint.digest,
            joint.law,
            joint.version,
            given.temperature,
            joint.table,
            unit.name,
            unit.numbers,
        )
    )
    return "{" + str(UUID(bytes=sha256(identity.encode()).digest()[:16])) + "}"


def _sources(given: Simulated, unit: SimulationUnit) -> dict[str, str]:
    joint = given.joint
    law = [*joint.table.loss_torques].index(joint.law)
    code = files("pitchpoint.exports")
    return {
        **{
            file_name: code.joinpath(file_name).read_text("utf-8")
            for file_name in ("joint_fmu.c", unit.model)
        },
        "joint_of.h": (
            f'#define JOINT_LAW {law}\n#define JOINT_GUID "{_guid(given, unit)}"\n'
            f"#define JOINT_TEMPERATURE {float(given.temperature)!r}\n{unit.numbers}"
        ),
        "loss_table.h": header(given.outcome, joint.table),
        "CMakeLists.txt": _CMAKE.format(name=unit.name),
    }


def _binary(unit: SimulationUnit, sources: dict[str, str]) -> dict[str, bytes]:
    """Library for this machine by its place in the archive; nothing without a compiler."""
    place = _platform()
    compiler = shutil.which(os.environ.get("CC", "cc")) or shutil.which("gcc")
    if compiler is None or place is None:
        return {}
    folder, ending = place
    with tempfile.TemporaryDirectory() as build:
        for name, text in sources.items():
            (Path(build) / name).write_text(text, "utf-8")
        library = f"{unit.name}.{ending}"
        command = [compiler, *FLAGS, "joint_fmu.c", "-o", library, "-lm"]
        done = subprocess.run(command, cwd=build, capture_output=True, check=False, timeout=120)
        if done.returncode:
            return {}
        return {f"binaries/{folder}/{library}": (Path(build) / library).read_bytes()}


def _platform() -> tuple[str, str] | None:
    """Folder of FMI 2.0 for this machine and ending of a library; None of one that it does not know."""
    if sys.platform.startswith("linux") and platform.machine() in ("x86_64", "AMD64"):
        return "linux64", "so"
    return ("darwin64", "dylib") if sys.platform == "darwin" else None


def _variables(given: Simulated) -> list[UnitVariable]:
    unit = given.joint.units
    torque, speed, driver = unit["torque"], unit["speed"], unit["driver"]
    return [
        UnitVariable("torque", "of the output on its load", torque, 0.0),
        UnitVariable("speed", "of the output", speed, 0.0),
        UnitVariable("temperature", "of the oil", "degC", given.temperature),
        UnitVariable("loss", "power lost; 0 where friction locks the drive", "W"),
        UnitVariable("efficiency", "power out over power in; 0 where no power comes out", "1"),
        UnitVariable(
            "input_torque",
            "of the driver; at rest the middle of the band that holds, 0 where friction locks the drive",
            driver,
        ),
        UnitVariable("lowest", "torque of the driver that holds, -1e30 without an end", driver),
        UnitVariable("highest", "torque of the driver that holds, 1e30 without an end", driver),
        UnitVariable("locked", "friction locks the drive against its output"),
        UnitVariable("outside", "beyond the map, whose nearest point it is then"),
    ]


def _description(given: Simulated, unit: SimulationUnit, lost: list[str]) -> str:
    used = dict.fromkeys(variable.unit for variable in unit.variables if variable.unit)
    units = "".join(
        f"    <Unit name={quoteattr(name)}><BaseUnit {_UNITS[name]}/></Unit>\n".replace(" />", "/>")
        for name in used
    )
    takes = [
        n
        for n, variable in enumerate(unit.variables, 1)
        if variable.start is not None and not variable.parameter
    ]
    outputs = "".join(
        f'      <Unknown index="{number}"{{}}/>\n'
        for number, variable in enumerate(unit.variables, 1)
        if variable.start is None
    )
    depends = f' dependencies="{" ".join(map(str, takes))}"'
    at_once = outputs.replace("{}", depends)
    from_all = outputs.replace(
        "{}", "" if any(variable.parameter for variable in unit.variables) else depends
    )
    name, title = unit.name, quoteattr(visible(given.joint.title))
    tool = quoteattr(visible(f"Pitchpoint {given.joint.version}"))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f"{xml_comment([*heading(given, unit.what), chr(10).join(lost)])}"
        f'<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{_guid(given, unit)}" '
        f"description={title} generationTool={tool} "
        'variableNamingConvention="flat">\n'
        f'  <CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="true" '
        'canGetAndSetFMUstate="true" canSerializeFMUstate="true">\n'
        '    <SourceFiles>\n      <File name="joint_fmu.c"/>\n    </SourceFiles>\n  </CoSimulation>\n'
        f"  <UnitDefinitions>\n{units}  </UnitDefinitions>\n  <ModelVariables>\n"
        f"{''.join(map(_variable, range(len(unit.variables)), unit.variables))}  </ModelVariables>\n"
        f"  <ModelStructure>\n    <Outputs>\n{at_once}    </Outputs>\n"
        f"    <InitialUnknowns>\n{from_all}    </InitialUnknowns>\n"
        "  </ModelStructure>\n</fmiModelDescription>\n"
    )


def _variable(number: int, one: UnitVariable) -> str:
    kind = "Real" if one.unit else "Boolean"
    unit = f" unit={quoteattr(one.unit)}" if one.unit else ""
    start = "" if one.start is None else f' start="{one.start!r}"'
    if one.start is None:
        role = "output" if kind == "Real" else 'output" variability="discrete'
        role += '" initial="calculated'
    elif one.parameter:
        role = f'parameter" variability="{"tunable" if one.parameter == "tunable" else "fixed"}'
    else:
        role = "input"
    return (
        f'    <ScalarVariable name="{one.name}" valueReference="{number}" causality="{role}" '
        f"description={quoteattr(one.words)}><{kind}{unit}{start}/></ScalarVariable>\n"
    )


def _page(given: Simulated, unit: SimulationUnit, lost: list[str]) -> str:
    words = "".join(f"<p>{escape(one)}</p>\n" for one in (*heading(given, unit.what), *unit.notes))
    rows = "".join(
        f"<li><b>{one.name}</b> [{escape(one.unit or 'true or false')}]: {escape(one.words)}</li>\n"
        for one in unit.variables
    )
    table = escape("\n".join(lost))
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{unit.name}</title></head>\n'
        f"<body>\n<h1>{escape(given.joint.title)}</h1>\n{words}<ul>\n{rows}</ul>\n<pre>{table}</pre>\n"
        "<p>Inputs that are not a number are refused. Another platform: cmake in the folder sources, and put "
        "the library into binaries.</p>\n</body></html>\n"
    )
