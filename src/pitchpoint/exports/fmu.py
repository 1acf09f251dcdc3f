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
from pitchpoint.exports.evaluator import demand_room, header
from pitchpoint.exports.simulators import HandedOver, Simulated, heading, lost_lines, xml_comment
from pitchpoint.results.store import write_bytes

__all__ = ["write_fmu"]

BESIDE = (
    "The unit is the loss map itself: nothing of it is lost. It has no state: inertia, stiffness, play, "
    "ripple and kinematic error are not in it."
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
    "1": "",
}


class _Variable(NamedTuple):
    """A variable of the unit, whose place is its value reference."""

    name: str
    words: str
    unit: str = ""
    start: float | None = None


def write_fmu(given: Simulated, folder: Path) -> HandedOver:
    """Write the unit: description, sources with CMake, documentation, and a binary if a compiler is there.

    Args:
        given: the joint.
        folder: of the file.

    Raises:
        InputError: the map is too large for a file of source.
    """
    demand_room(given.joint.table, "--fmu")
    lost = lost_lines(given, given.loss_of_map, BESIDE)
    sources = _sources(given)
    binaries = _binary(given, sources)
    if not binaries:
        lost = [*lost, "No compiler of C (cc) made a binary: the unit has sources alone."]
    texts = {
        "modelDescription.xml": _description(given),
        "documentation/index.html": _page(given, lost),
        **{f"sources/{name}": text for name, text in sources.items()},
    }
    content = {name: text.encode("utf-8") for name, text in texts.items()} | binaries
    path = folder / f"{given.name}.fmu"
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


def _guid(given: Simulated) -> str:
    joint = given.joint
    told = repr((joint.digest, joint.law, joint.version, given.temperature, joint.table))
    return "{" + str(UUID(bytes=sha256(told.encode()).digest()[:16])) + "}"


def _sources(given: Simulated) -> dict[str, str]:
    joint = given.joint
    law = [*joint.table.loss_torques].index(joint.law)
    return {
        "joint_fmu.c": files("pitchpoint.exports").joinpath("joint_fmu.c").read_text("utf-8"),
        "joint_of.h": (
            f'#define JOINT_LAW {law}\n#define JOINT_GUID "{_guid(given)}"\n'
            f"#define JOINT_TEMPERATURE {float(given.temperature)!r}\n"
        ),
        "loss_table.h": header(given.outcome, joint.table),
        "CMakeLists.txt": _CMAKE.format(name=given.name),
    }


def _binary(given: Simulated, sources: dict[str, str]) -> dict[str, bytes]:
    """Library for this machine by its place in the archive; nothing without a compiler."""
    place = _platform()
    compiler = shutil.which(os.environ.get("CC", "cc")) or shutil.which("gcc")
    if compiler is None or place is None:
        return {}
    folder, ending = place
    with tempfile.TemporaryDirectory() as made:
        for name, text in sources.items():
            (Path(made) / name).write_text(text, "utf-8")
        library = f"{given.name}.{ending}"
        command = [compiler, *FLAGS, "joint_fmu.c", "-o", library, "-lm"]
        done = subprocess.run(command, cwd=made, capture_output=True, check=False, timeout=120)
        if done.returncode:
            return {}
        return {f"binaries/{folder}/{library}": (Path(made) / library).read_bytes()}


def _platform() -> tuple[str, str] | None:
    """Folder of FMI 2.0 for this machine and ending of a library; None of one that it does not know."""
    if sys.platform.startswith("linux") and platform.machine() in ("x86_64", "AMD64"):
        return "linux64", "so"
    return ("darwin64", "dylib") if sys.platform == "darwin" else None


def _variables(given: Simulated) -> list[_Variable]:
    unit = given.joint.units
    torque, speed, driver = unit["torque"], unit["speed"], unit["driver"]
    return [
        _Variable("torque", "of the output on its load", torque, 0.0),
        _Variable("speed", "of the output", speed, 0.0),
        _Variable("temperature", "of the oil", "degC", given.temperature),
        _Variable("loss", "power lost; 0 where friction locks the drive", "W"),
        _Variable("efficiency", "power out over power in; 0 where no power comes out", "1"),
        _Variable(
            "input_torque",
            "of the driver; at rest the middle of the band that holds, 0 where friction locks the drive",
            driver,
        ),
        _Variable("lowest", "torque of the driver that holds, -1e30 without an end", driver),
        _Variable("highest", "torque of the driver that holds, 1e30 without an end", driver),
        _Variable("locked", "friction locks the drive against its output"),
        _Variable("outside", "beyond the map, whose nearest point it is then"),
    ]


def _description(given: Simulated) -> str:
    variables = _variables(given)
    used = dict.fromkeys(one.unit for one in variables if one.unit)
    units = "".join(
        f"    <Unit name={quoteattr(unit)}><BaseUnit {_UNITS[unit]}/></Unit>\n".replace(" />", "/>")
        for unit in used
    )
    outputs = "".join(
        f'      <Unknown index="{number}" dependencies="1 2 3"/>\n'
        for number, one in enumerate(variables, 1)
        if one.start is None
    )
    name, joint = given.name, given.joint
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f"{xml_comment(heading(given, 'Loss map of a drive for co-simulation, FMI 2.0.'))}"
        f'<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{_guid(given)}" '
        f'description={quoteattr(visible(joint.title))} generationTool="Pitchpoint {joint.version}" '
        'variableNamingConvention="flat">\n'
        f'  <CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="true" '
        'canGetAndSetFMUstate="true" canSerializeFMUstate="true">\n'
        '    <SourceFiles>\n      <File name="joint_fmu.c"/>\n    </SourceFiles>\n  </CoSimulation>\n'
        f"  <UnitDefinitions>\n{units}  </UnitDefinitions>\n  <ModelVariables>\n"
        f"{''.join(map(_variable, range(len(variables)), variables))}  </ModelVariables>\n"
        f"  <ModelStructure>\n    <Outputs>\n{outputs}    </Outputs>\n"
        f"    <InitialUnknowns>\n{outputs}    </InitialUnknowns>\n"
        "  </ModelStructure>\n</fmiModelDescription>\n"
    )


def _variable(number: int, one: _Variable) -> str:
    takes = one.start is not None
    kind = "Real" if one.unit else "Boolean"
    unit = f" unit={quoteattr(one.unit)}" if one.unit else ""
    start = f' start="{one.start!r}"' if takes else ""
    causality = "input" if takes else "output"
    calculated = "" if takes else ' initial="calculated"'
    discrete = ' variability="discrete"' if kind == "Boolean" else ""
    return (
        f'    <ScalarVariable name="{one.name}" valueReference="{number}" causality="{causality}"'
        f"{discrete}{calculated} description={quoteattr(one.words)}><{kind}{unit}{start}/></ScalarVariable>\n"
    )


def _page(given: Simulated, lost: list[str]) -> str:
    words = "".join(
        f"<p>{escape(one)}</p>\n" for one in heading(given, "Loss map for co-simulation.")
    )
    rows = "".join(
        f"<li><b>{one.name}</b> [{escape(one.unit or 'true or false')}]: {escape(one.words)}</li>\n"
        for one in _variables(given)
    )
    table = escape("\n".join(lost))
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{given.name}</title></head>\n'
        f"<body>\n<h1>{escape(given.joint.title)}</h1>\n{words}<ul>\n{rows}</ul>\n<pre>{table}</pre>\n"
        "<p>Inputs that are not a number are refused. Another platform: cmake in the folder sources, and put "
        "the library into binaries.</p>\n</body></html>\n"
    )
