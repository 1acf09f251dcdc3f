"""Case files to begin with: they are sound as they are, and so is every key that stands in a remark."""

import re
import sys
import tomllib
from pathlib import Path

import pytest

from pitchpoint import cli
from pitchpoint.cases.document import read, resolve
from pitchpoint.cases.schema import Case, DriveCase, keys, quantity_at, validate
from pitchpoint.cases.template import FAMILIES, template
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.runs.check import check

HEAD = re.compile(r"(?:# )?\[([a-z_.0-9]+)\](?:  #.*)?")
KEY = re.compile(r"# ([a-z_0-9]+ = .*)")


def remarks(text: str) -> dict[str, object]:
    """Values of optional keys by dotted key."""
    found, table = {}, ""
    for line in text.partition("# [variants.")[0].splitlines():
        if head := HEAD.fullmatch(line):
            table = head[1]
        elif key := KEY.fullmatch(line):
            ((name, value),) = tomllib.loads(key[1]).items()
            found[f"{table}.{name}"] = value
    return found


@pytest.mark.parametrize("family", FAMILIES)
def test_it_is_sound_as_it_is(family: str, tmp_path: Path) -> None:
    path = tmp_path / f"{family}.toml"
    path.write_text(template(family))
    if family == "helical":  # the samples of the families are computed elsewhere, this one is not
        assert check(str(path)) == []
    case = validate(resolve(read(path), name=path.name, variant="default"))
    assert case.title == f"My {family.replace('_', ' ')}"


@pytest.mark.parametrize("family", FAMILIES)
def test_every_remark_is_a_key_with_a_value_that_it_may_have(family: str) -> None:
    text = template(family)
    tree = tomllib.loads(text)
    for key, value in remarks(text).items():
        quantity = quantity_at(key, tree if "stages" not in tree else None)
        for one in value if isinstance(value, list) else [value]:
            if quantity is not None and one != FROM_CENTRE_DISTANCE:
                quantity.read(one)


@pytest.mark.parametrize("family", ["spur", "two_stages", "planetary"])
def test_every_key_stands_in_it(family: str) -> None:
    text = template(family)
    model = Case if family == "spur" else DriveCase
    apart = ("targets", "issues", "formulas", "studies", "title", "summary", "source", "stages")
    apart += ("train",) + ("gears",) * (family == "two_stages")
    told = remarks(text)
    for key in keys(model):
        table, _, name = key.partition(".")
        if table in apart or (table == "gears" and name not in ("module", "helix_angle")):
            continue
        if re.search(r"(gear_[12]|both|friction|speeds|start_up|profile_error)\.", key):
            continue  # tables by name or in lists, which stand in braces
        assert key in told or f"[{key}]" in text or f"{name.rpartition('.')[2]} = " in text, key


@pytest.mark.parametrize("family", FAMILIES)
def test_what_a_key_is_stands_behind_it(family: str) -> None:
    text = template(family)
    assert re.search(
        r'^temperature = ".*"  # Temperature of the oil and around the gears; allowed', text, re.M
    )
    # Sent to a file where the screen has an old encoding, these would make it no UTF-8.
    assert not re.search("[\x80-\xff]", text)


def test_helical_gears_are_helical() -> None:
    assert tomllib.loads(template("helical"))["gears"]["helix_angle"] == "15 deg"
    assert "helix_angle" not in tomllib.loads(template("spur"))["gears"]


def test_names_as_people_write_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert template("Strain wave") == template("strain_wave")
    with pytest.raises(InputError, match="did you mean torus"):
        template("torsu")
    path = tmp_path / "mine.toml"
    for status in (0, 2):
        monkeypatch.setattr(sys, "argv", ["pitchpoint", "new", "spur", "-o", str(path)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        assert caught.value.code == status
    assert path.read_text("utf-8") == template("spur")
    assert "is there already" in capsys.readouterr().err


def test_a_strain_wave_gear_comes_with_all_that_loses_and_yields() -> None:
    text = template("strain_wave")
    tree = tomllib.loads(text)
    assert tree["losses"] == {"set": "strain_wave_component"}
    assert tree["gears"]["wave_generator"]["bearing"] == tree["gears"]["yielding"] == {}
    case = validate(resolve(tree, name="new", variant="default"))
    assert {"wave_generator_bearing"} <= case.losses.keys()
    assert "losses" not in tomllib.loads(template("spur"))


def test_a_dash_stands_for_the_screen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "new", "spur", "-o", "-"])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert capsys.readouterr().out == template("spur")
    assert not [*tmp_path.iterdir()]
