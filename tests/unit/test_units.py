"""Quantities as users write them, and what they are told when one is wrong."""

import math
import os
import re
import subprocess
import sys
from itertools import product

import numpy as np
import pint
import pytest

from pitchpoint import units
from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import HELIX
from pitchpoint.input.kinds import HARDNESS
from pitchpoint.input.quantities import Quantity
from pitchpoint.units import UnitError, convert, kind_of, kinds, parse, si_unit, units_of

GOOD = [
    ("3 mm", "length", 0.003),
    ("0.8 um", "length", 0.8e-6),
    ("0.8µm", "length", 0.8e-6),
    ("1 in", "length", 0.0254),
    ("20 deg", "angle", math.radians(20.0)),
    ("20°", "angle", math.radians(20.0)),
    ("1500 rpm", "rotational speed", 50.0 * math.pi),
    ("1500 1/min", "rotational speed", 50.0 * math.pi),
    ("25 rev/s", "rotational speed", 50.0 * math.pi),
    ("7 rad/s", "rotational speed", 7.0),
    ("159 N m", "torque", 159.0),
    ("159 N*m", "torque", 159.0),
    ("159 N·m", "torque", 159.0),
    ("159Nm", "torque", 159.0),
    ("0.2 kN m", "torque", 200.0),
    ("1 lbf in", "torque", 4.4482216152605 * 0.0254),
    ("1 lbf ft", "torque", 4.4482216152605 * 0.3048),
    ("1 ft lbf", "torque", 4.4482216152605 * 0.3048),
    ("16 ozf in", "torque", 4.4482216152605 * 0.0254),
    ("600 kgf cm", "torque", 600.0 * 9.80665 * 0.01),
    ("2 kgf·m", "torque", 2.0 * 9.80665),
    ("90 N cm", "torque", 0.9),
    ("3 kgf", "force", 3.0 * 9.80665),
    ("5 rps", "rotational speed", 10.0 * math.pi),
    ("55 degC", "temperature", 328.15),
    ("55 °C", "temperature", 328.15),
    ("212 degF", "temperature", 373.15),
    ("0 K", "temperature", 0.0),
    ("9 degF", "temperature difference", 5.0),
    ("206 GPa", "pressure", 206e9),
    ("1 psi", "pressure", 4.4482216152605 / 0.0254**2),
    ("2 N/mm2", "pressure", 2e6),
    ("200 HV", "hardness", 200.0 * 9.80665e6),
    ("200HV", "hardness", 200.0 * 9.80665e6),
    ("200 HB", "hardness", 200.0 * 9.80665e6),
    ("200 HBW", "hardness", 200.0 * 9.80665e6),
    ("200 HBS", "hardness", 200.0 * 9.80665e6),
    ("1.96 GPa", "hardness", 1.96e9),
    ("1960 MPa", "hardness", 1.96e9),
    ("1960 N/mm2", "hardness", 1.96e9),
    ("1.03e-6 mm3/(N m)", "specific wear rate", 1.03e-15),
    ("1.03e-6 mm3/Nm", "specific wear rate", 1.03e-15),
    ("1.03e-15 m2/N", "specific wear rate", 1.03e-15),
    ("36.9 kJ/mol", "molar energy", 36.9e3),
    ("1e-3 Pa s", "dynamic viscosity", 1e-3),
    ("10.6 mPa*s", "dynamic viscosity", 10.6e-3),
    ("10 cP", "dynamic viscosity", 10e-3),
    ("98.8 mm2/s", "kinematic viscosity", 98.8e-6),
    ("98.8 mm^2/s", "kinematic viscosity", 98.8e-6),
    ("98.8 cSt", "kinematic viscosity", 98.8e-6),
    ("0.859 g/cm3", "density", 859.0),
    ("0.5 kg/(m3 K)", "density slope", 0.5),
    ("22 1/GPa", "pressure-viscosity coefficient", 22e-9),
    ("0.022 mm2/N", "pressure-viscosity coefficient", 22e-9),
    ("150 N/mm", "line load", 150e3),
    ("36 km/h", "velocity", 10.0),
    ("25 kW", "power", 25e3),
    ("2 h", "time", 7200.0),
    ("2 kHz", "frequency", 2000.0),
    ("30 %", "dimensionless", 0.3),
    ("-.5e1", "dimensionless", -5.0),
    (0.3, "dimensionless", 0.3),
    (np.float64(0.4), "dimensionless", 0.4),
]


@pytest.mark.parametrize(("text", "kind", "expected"), GOOD)
def test_parse_gives_si(text, kind, expected):
    assert parse(text, kind) == pytest.approx(expected, rel=1e-15, abs=0.0)


MESSAGES = [
    (
        "3 mmm",
        "length",
        '"3 mmm" is not a length; give a number with one of m, mm, um, nm, cm, in '
        '(did you mean "3 mm"?)',
    ),
    (
        "3 s",
        "length",
        '"3 s" is a time, but a length is needed; give a number with one of m, mm, um, nm, cm, in',
    ),
    (
        "3",
        "length",
        '"3" has no unit where a length is needed; write "3 mm" or use one of '
        "m, mm, um, nm, cm, in",
    ),
    (
        0.5,
        "pressure",
        '"0.5" has no unit where a pressure is needed; write "0.5 GPa" or use one of '
        "Pa, kPa, MPa, GPa, N/mm2, bar, psi, ksi",
    ),
    (
        200,
        "hardness",
        '"200" has no unit where a hardness is needed; write "200 HV" or use one of '
        "Pa, MPa, GPa, N/mm2, HV, HB",
    ),
    (
        "58 HRC",
        "hardness",
        '"58 HRC" is not a hardness; numbers of Rockwell and other scales are not converted; '
        "give a number with one of Pa, MPa, GPa, N/mm2, HV, HB",
    ),
    (
        "200 HV",
        "pressure",
        '"200 HV" is a hardness, but a pressure is needed; give a number with one of '
        "Pa, kPa, MPa, GPa, N/mm2, bar, psi, ksi",
    ),
    (
        "inf HV",
        "hardness",
        '"inf HV" does not start with a plain finite number; write a hardness like "200 HV"',
    ),
    (
        "3,5 mm",
        "length",
        '"3,5 mm" does not start with a plain finite number; write "3.5 mm"',
    ),
    (
        "nan mm",
        "length",
        '"nan mm" does not start with a plain finite number; write a length like "3 mm"',
    ),
    (
        "25 Hz",
        "rotational speed",
        '"25 Hz" is a frequency, but a rotational speed is needed; '
        "give a number with one of rad/s, rpm, rev/s, deg/s",
    ),
    (
        "0.3 mm",
        "dimensionless",
        '"0.3 mm" is a length, but a plain number is needed; give a number without a unit, or in %',
    ),
    ("-300 degC", "temperature", '"-300 degC" is below absolute zero'),
    ("1e999 mm", "length", '"1e999 mm" is too large'),
    ("1e308 kN", "force", '"1e308 kN" is too large'),
    (True, "length", '"True" is not a length; write "3 mm"'),
    (None, "length", '"None" is not a length; write "3 mm"'),
]


@pytest.mark.parametrize(("text", "kind", "message"), MESSAGES)
def test_message_of_a_bad_quantity(text, kind, message):
    with pytest.raises(UnitError) as caught:
        parse(text, kind)
    assert str(caught.value) == message


def suggested(text: str, kind: str) -> str | None:
    """Unit that is offered for a wrong one."""
    try:
        parse(text, kind)
    except UnitError as error:
        told = re.search(r'did you mean "3 (.+)"', str(error))
        return told[1] if told else None
    return None


@pytest.mark.parametrize(
    ("text", "kind", "unit"),
    [
        ("3 MPA", "pressure", "MPa"),
        ("3 RPM", "rotational speed", "rpm"),
        ("3 hv10", "hardness", "HV"),
        ("3 HRC", "hardness", None),
        ("3 Nms", "torque", "Nm"),
        ("3 in-lb", "torque", "in lbf"),
        ("3 kgcm", "torque", "kgf cm"),
        ("3 hPa", "pressure", None),
        ("3 kN cm", "torque", None),
        ("3 kNmm", "torque", None),
        ("3 kg/l", "density", None),
        ("3 mbar", "pressure", None),
    ],
)
def test_a_unit_that_is_offered_is_spelled_alike(text, kind, unit):
    assert suggested(text, kind) == unit


def test_no_unit_of_another_size_is_offered():
    """Every listed unit with another prefix: what is offered for it, if anything, is as large."""
    registry, wrong, tried = pint.UnitRegistry(), [], 0
    stem = re.compile(r"\b[kMGmunc]?(N|m|g|Pa|s|bar|Hz|W|in|ft|lbf|rad|deg|psi)(?![A-Za-z])")
    listed = [(kind, unit) for kind in kinds() for unit in units_of(kind)]
    for kind, unit in listed:
        for place, prefix in product(stem.finditer(unit), ("", *"kMGmuncdh")):
            text = f"{unit[: place.start()]}{prefix}{place[1]}{unit[place.end() :]}"
            tried += (kind, text) not in listed
            near = suggested(f"3 {text}", kind)
            if near and abs(registry.Quantity(text).m_as(near) - 1.0) > 0.01:
                wrong.append((text, near))
    assert not wrong
    assert tried > 300


def test_error_takes_a_location():
    with pytest.raises(InputError) as caught:
        parse("3 mmm", "length")
    located = caught.value.at(file="pair.toml", key="gears.module")
    assert str(located).startswith('pair.toml: gears.module: "3 mmm" is not a length; ')
    assert "mm" in located.allowed


@pytest.mark.parametrize(
    "text",
    ["10**10**10 m", "3 **mm", "1_0 mm", "٣ mm", "0x10 mm", "inf mm", "--3 mm", "3 mm mm", "3 MM"],
)
def test_what_python_or_pint_would_accept_is_refused(text):
    with pytest.raises(UnitError):
        parse(text, "length")


def test_control_characters_do_not_reach_the_message():
    with pytest.raises(UnitError) as caught:
        parse("3 mm\x1b[2J", "length")
    assert str(caught.value).isprintable()


def test_long_text_is_refused_without_being_repeated():
    with pytest.raises(UnitError) as caught:
        parse("3 " + "m" * 10**6, "length")
    assert len(str(caught.value)) < 100


@pytest.mark.parametrize("kind", kinds())
def test_every_unit_of_a_kind_converts_both_ways(kind):
    assert parse(f"2 {si_unit(kind)}", kind) == 2.0
    for unit in units_of(kind):
        assert convert(parse(f"2 {unit}", kind), unit, kind) == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("kind", kinds())
def test_every_example_in_a_message_is_valid(kind):
    with pytest.raises(UnitError) as caught:
        parse("abc", kind)
    parse(str(caught.value).rsplit(" like ", 1)[1].strip('"'), kind)


def test_convert_keeps_the_shape_of_arrays():
    shown = convert(np.array([[273.15, 328.15]]), "degC", "temperature")
    np.testing.assert_allclose(shown, [[0.0, 55.0]], atol=1e-12)


def test_convert_names_the_units_it_knows():
    with pytest.raises(
        UnitError, match='"s" is a unit of a time, not of a length; use one of m, mm'
    ):
        convert(1.0, "s", "length")


def test_scales_of_hardness():
    told = {"200 HV": "Vickers", "200 HBW": "Brinell", "2 GPa": "", 2e9: "", "58 HRC": ""}
    assert {text: units.hardness_scale(text) for text in told} == told


@pytest.mark.parametrize(
    "bad", ["0 HV", "-200 HB", "0 GPa", "nan HV", math.nan, math.inf, 200.0, True]
)
def test_a_hardness_that_is_none_is_refused_in_one_sentence(bad):
    with pytest.raises(InputError) as caught:
        HARDNESS.read(bad)
    told = str(caught.value)
    assert told.endswith("; allowed is 0.001 GPa to 100 GPa") and ". " not in told


def test_kind_of():
    assert (kind_of("N*m"), kind_of("mm^2/s"), kind_of("GPa"), kind_of("1/Pa"), kind_of("%")) == (
        "torque",
        "kinematic viscosity",
        "pressure",
        "pressure-viscosity coefficient",
        "dimensionless",
    )
    with pytest.raises(UnitError, match='"furlong" is not a known unit'):
        kind_of("furlong")


def test_unknown_kind_is_a_mistake_of_the_program_not_of_the_input():
    with pytest.raises(ValueError, match="no quantity kind 'colour'") as caught:
        parse("3 mm", "colour")
    assert not isinstance(caught.value, UnitError)


def test_pint_is_imported_only_for_factors_that_are_not_kept(tmp_path):
    script = (
        "import sys, pitchpoint.units as u; u.parse('3 m', 'length'); u.parse(1, 'dimensionless');"
        "assert 'pint' not in sys.modules; u.parse('3 mm', 'length'); print('pint' in sys.modules)"
    )
    kept = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}

    def run() -> str:
        done = [sys.executable, "-c", script]
        return subprocess.run(done, check=True, capture_output=True, text=True, env=kept).stdout

    assert [run(), run()] == ["True\n", "False\n"]
    (file,) = (tmp_path / "pitchpoint" / "units").iterdir()
    file.write_bytes(file.read_bytes().replace(b"0.001", b"0.002"))
    assert [run(), run()] == ["True\n", "False\n"]


def test_factors_that_are_kept_are_those_of_pint(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    units._every_factor.cache_clear()
    first = units._every_factor()
    units._every_factor.cache_clear()
    again = units._every_factor()
    units._every_factor.cache_clear()
    for kind, each in first.items():
        assert {unit: tuple(pair) for unit, pair in again[kind].items()} == each
    assert parse("3 mm", "length") == 0.003
    assert parse("20 degC", "temperature") == pytest.approx(293.15, rel=1e-15)


@pytest.mark.parametrize("kind", sorted({*units.kinds()} - {"temperature"}))
def test_what_is_offered_is_as_large_as_what_was_meant(kind: str) -> None:
    """Units as people write them, "kgfcm" and "lbf-in", are read or offered as they are meant."""
    for unit in units.units_of(kind):
        meant = units.parse(f"1 {unit}", kind)
        for written in {unit.replace(" ", sign) for sign in "-_"} | {unit.replace(" ", "")}:
            if "(" in unit:
                continue
            try:
                found = units.parse(f"1 {written}", kind)
            except units.UnitError as error:
                offered = re.search(r'did you mean "(.*?)"', str(error))
                found = meant if offered is None else units.parse(offered[1], kind)
            assert found == meant, written


def test_a_bound_in_another_unit_is_within_its_range():
    """60 deg converts to a bit more than 60 pi/180."""
    assert HELIX.read("60 deg") > HELIX.high
    for beyond in ("60.0000001 deg", "-1e-9 deg"):
        with pytest.raises(InputError, match="is out of range; allowed is 0 deg to 60 deg"):
            HELIX.read(beyond)
    with pytest.raises(InputError, match="is out of range; allowed is above 1 to 2"):
        Quantity("dimensionless", 1.0, 2.0, open_low=True).read(1.0)


@pytest.mark.parametrize(
    ("text", "kind", "advice"),
    [
        (
            "20,000 h",
            "time",
            'write "20000 h" or "20.000 h"',
        ),  # a comma between thousands, or before decimals
        ("1,75 mm", "length", 'write "1.75 mm"'),
        ("0,125 mm", "length", 'write "0.125 mm"'),
        ("78,5", "length", 'write "78.5 mm"'),
        ("1,500,000 mm", "length", 'write "1500000 mm"'),
        ("20000", "time", '"20000 h"'),
        ("20000 hours", "time", 'did you mean "20000 h"?'),
    ],
)
def test_commas_and_spelled_units_are_answered_with_what_may_be_meant(
    text: str, kind: str, advice: str
) -> None:
    with pytest.raises(UnitError, match=re.escape(advice)):
        parse(text, kind)
