"""Files that are no case file: one sentence each that says what to write."""

import pytest

from pitchpoint.cases.document import read_tables
from pitchpoint.cases.library import find_case
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.units import parse

FILES = {
    "Latin-1": ('title = "für"'.encode("latin-1"), 'line 1 has a byte that is "ü" in Latin-1'),
    "UTF-16": ("[gears]".encode("utf-16"), "is UTF-16 text; save it as UTF-8"),
    "a picture": (b"\x89PNG\r\n\x1a\n\x00\x00", "is not text, so it is no case file"),
    "YAML": (b"gears:\n  teeth: [20, 40]\n", "looks like YAML; a case file is TOML"),
    "YAML with a head": (b"# x\n\n---\ngears:\n  module: 2 mm\n", "looks like YAML"),
    "JSON": (b'{"gears": {"teeth": [20, 40]}}', "looks like JSON; a case file is TOML"),
    "CSV": (b"teeth;module\n20;2\n", "looks like a table of values, CSV say; a case file"),
    "numbers": (b"1.0,2.0\n3.0,4.0\n", "looks like a table of values"),
    "XML": (b'<?xml version="1.0"?>\n<rexs/>', "looks like XML or HTML; a case file is TOML"),
    "quotes below a remark with a comma": (
        "# module, and so on\nmodule = “2 mm”".encode(),
        "line 2 has the quotation mark “",
    ),
    "CSV below a remark": (b"# heights, in um\n\n1;2\n", "looks like a table of values"),
    "quotes": ("module = “2 mm”".encode(), "line 1 has the quotation mark “; write straight"),
    "one of them": ("name = ‘pao’".encode(), 'ones, name = "pao"'),
    "a comma": (
        b"[gears]\naddendum = 1,25\n",
        "line 2 has a comma before decimals, 1,25; write 1.25",
    ),
    "thousands": (
        b"[strength]\nlife = 20,000\n",
        "line 2 has a comma in a number, 20,000; write 20000 or 20.000",
    ),
    "a bare unit": (b"module = 2.5 mm  # m", 'unit outside of quotation marks; write "2.5 mm"'),
    "a path of Windows": (
        b'[wear]\nprofile = "C:\\Users\\me\\rough.csv"\n',
        "line 2 has a backslash between quotation marks; write profile = 'C:\\Users\\me\\rough.csv', or /",
    ),
    "null": (b"[gears]\nteeth = null\n", "line 2 has no value for teeth; leave the line out"),
    "True of Python": (b"locating = True\n", "line 1 has True; write locating = true"),
    "a bare word": (
        b"friction = xu_2007\n",
        'outside of quotation marks; write friction = "xu_2007"',
    ),
    "a semicolon": (b'module = "2 mm";\n', 'line 1 has ; behind a value; write module = "2 mm"'),
    "a remark of C": (b'module = "2 mm" // m_n\n', 'write module = "2 mm"  # m_n'),
    "a key of two words": (b'face width = "2 mm"\n', "has a space inside a key; write face_width"),
    "a colon": (b'[gears]\nmodule: "2 mm"', 'line 2 has a colon; write module = "2 mm"'),
    "spaces": (b"# a\nteeth = [20 -50];\n", "line 2 has a list without commas; write [20, -50]"),
    "an open table": (b"[gears", "line 1 opens a table that it does not close; write [gears]"),
    "an open list of tables": (b"# a, b\n\n[[stages]\n", "does not close; write [[stages]]"),
    "a table twice": (
        b"# Spur pair, both gears of steel.\n# And more; so far.\n[gears]\nteeth = 20\n[gears]\n",
        "line 5 has a table that was there before, [gears]; write it once",
    ),
    "another": (
        b"[gears]\nteeth =",
        "line 2 has no value for teeth; leave the line out, or give one",
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_file_of_another_kind(name, tmp_path):
    content, words = FILES[name]
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        read_tables(path)
    assert words in str(error.value) and str(error.value).startswith("bad.toml: ")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["pare.toml", "Pair.toml", "pair.tml", "pair", "pair.toml.txt"])
def test_a_file_beside_the_one_that_is_missing(name, tmp_path):
    (tmp_path / "pair.toml").touch()
    (tmp_path / "robot.toml").touch()
    with pytest.raises(InputError, match=r"; did you mean pair\.toml\?$"):
        find_case(str(tmp_path / name))
    (tmp_path / "nowhere.toml").symlink_to(tmp_path / "gone.toml")
    for missing in ("gone.toml", "nowhere.toml"):
        with pytest.raises(InputError, match=r"no such case file$"):
            find_case(str(tmp_path / missing))


QUANTITIES = {
    ("50 C", "temperature"): "50 degC",
    ("120 F", "temperature"): "120 degF",
    ("1500 min-1", "rotational speed"): "1500 rpm",
    ("1500 min⁻¹", "rotational speed"): "1500 rpm",
    ("1500 U/min", "rotational speed"): "1500 rpm",
    ("0.4 micron", "length"): "0.4 um",
    ('2 "', "length"): "2 in",
    ("2,5 mm", "length"): "2.5 mm",
    ("“2.5 mm”", "length"): "2.5 mm",
    ("10 ft-lb", "torque"): "10 lbf ft",
    ("20 N-m", "torque"): "20 N m",
}


@pytest.mark.parametrize(("text", "kind"), QUANTITIES)
def test_the_quantity_that_is_meant(text, kind):
    meant = QUANTITIES[text, kind]
    with pytest.raises(InputError) as error:
        parse(text, kind)
    assert f'did you mean "{meant}"?' in str(error.value) or f'write "{meant}"' in str(error.value)
    parse(meant, kind)


def test_no_neighbour_of_another_size():
    for text, kind in (("20 grad", "angle"), ("1 500 rpm", "rotational speed"), ("5 PS", "power")):
        with pytest.raises(InputError) as error:
            parse(text, kind)
        assert "did you mean" not in str(error.value)


def test_a_list_whose_commas_stand_before_decimals():
    shifts = Pair(Quantity("dimensionless", -2.0, 3.0))
    with pytest.raises(
        InputError, match=r"of two \(decimals stand after a point: \[0\.3, -1\.2\]\)"
    ):
        shifts.read([0, 3, -1, 2])
    with pytest.raises(InputError, match=r"or a list of two; allowed"):
        shifts.read([0.0, 3, 1, 2])
