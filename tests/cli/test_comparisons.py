"""The print against the computation, and pairs that no paper holds, from the command line."""

import tomllib
from collections.abc import Callable
from importlib import resources
from pathlib import Path

import bank
import numpy as np
import pytest
import xarray as xr
from called import TINY, Told

from pitchpoint.materials import lubricants
from pitchpoint.runs import run as running
from pitchpoint.runs.run import open_outcomes, uncomputed_manifests

EXAMPLES = Path(__file__).parents[2] / "examples"
COLUMNS = ["quantity", "where", "printed", "computed", "tolerance", "kind", "verdict", "reason"]
COLUMNS += ["expected_miss", "unit", "bound"]


# ---- the print against the computation


def published(tmp_path: Path, old: str = "", new: str = "") -> Path:
    text = (resources.files("pitchpoint.published") / "tian2024" / "case.toml").read_text("utf-8")
    assert old in text
    path = tmp_path / "copy.toml"
    path.write_text(text.replace(old, new, 1), "utf-8")
    return path


def test_compare(pitchpoint: Callable[..., Told], monkeypatch: pytest.MonkeyPatch) -> None:
    named = "tian2024", "as_published", bank.rows("tian2024")
    monkeypatch.setattr(running, "compare_case", lambda *_: named)
    told = pitchpoint("compare", "tian2024", "--json")
    assert told.status == 0
    assert set(told.json) == {"case", "variant", "rows"}
    assert (told.json["case"], told.json["variant"]) == ("tian2024", "as_published")
    for row in told.json["rows"]:
        assert [*row] == COLUMNS
        assert row["verdict"] in ("pass", "excluded") or row["expected_miss"]
        assert (row["computed"] is None) == (row["verdict"] == "excluded")
        assert row["reason"] or row["verdict"] == "pass"
    table = pitchpoint("compare", "tian2024")
    assert table.status == 0
    head, *lines = table.out.splitlines()
    assert head.split()[:7] == (
        ["quantity", "verdict", "printed", "computed", "deviation", "tolerance", "kind"]
    )
    row = next(line for line in lines if line.startswith("contact ratio"))
    assert row.split()[2:8] == ["pass", "1.611", "1.611", "+1.1e−4", "0.0005", "calibrated"]


def test_a_rougher_flank_is_noticed(pitchpoint: Callable[..., Told], tmp_path: Path) -> None:
    path = published(tmp_path, 'value = "0.8 um"', 'value = "0.808 um"')
    told = pitchpoint("compare", path, "--json")
    assert told.status == 1
    assert sum(row["verdict"] == "miss" for row in told.json["rows"]) >= 1


@pytest.mark.whole
def test_a_thicker_oil_is_noticed(pitchpoint: Callable[..., Told], tmp_path: Path) -> None:
    oil = lubricants.find("75W90-A")
    thicker = "".join(
        f'{key} = "{1.03 * nu.value!r} m2/s"\n'
        for key, nu in (("viscosity_40", oil.nu_1), ("viscosity_100", oil.nu_2))
    )
    told = pitchpoint("compare", published(tmp_path, "[lubricant]\n", f"[lubricant]\n{thicker}"))
    assert told.status == 1
    assert "miss" in told.out


def test_targets_that_name_what_is_not_there(
    pitchpoint: Callable[..., Told], tmp_path: Path
) -> None:
    target = (
        '\n[[targets]]\nquantity="q"\nwhere="w"\nkind="predicted"\nprinted=1.0\nstudy="smooth"\n'
    )
    path = tmp_path / "target.toml"
    for change, words in {
        'variable = "phase"': ("targets.0.variable", "phase"),
        "law = [5]": ("targets.0.law", "[5]", "2 friction laws"),
        "law = []": ("targets.0.law", "[]"),
        'reduce = "max_difference"': ("targets.0.law", "takes 2"),
        'unit = "N m"': ("targets.0.unit", "N m"),
        'at = "1 N m"': ("targets.0.at", "no axis of numbers"),
    }.items():
        known = "" if "variable" in change else 'variable = "mean_efficiency"\n'
        path.write_text(f"{TINY}{target}{known}{change}\n")
        told = pitchpoint("compare", path)
        assert told.status == 2, change
        for word in ("target.toml: ", *words):
            assert word in told.complaint


# ---- pairs that no paper holds

FEW = ("pair_12_120_undercut", "pair_23_61", "rack_and_pinion", "strain_wave", "two_stage")
"""Examples whose figures the quick part builds; the others are described in full by `whole`."""


def test_the_examples_are_short() -> None:
    assert len(list(EXAMPLES.glob("*.toml"))) >= 12
    for path in EXAMPLES.glob("*.toml"):
        assert len(path.read_text("utf-8").splitlines()) <= 28


@pytest.mark.parametrize(
    "path",
    [  # a structure of its own takes the compiler seconds
        pytest.param(path, marks=[pytest.mark.whole] * (path.stem not in FEW), id=path.stem)
        for path in sorted(EXAMPLES.glob("*.toml"))
    ],
)
def test_every_example_is_sound(path: Path) -> None:
    (manifest,) = uncomputed_manifests(str(path))
    told = " ".join(manifest["warnings"])
    undercut = ("pair_12_120_undercut", "pair_17_17", "planetary_industrial")
    assert ("undercut" in told) == (path.stem in undercut)


def contact_ratio(teeth: xr.Dataset, count: int | list[int]) -> float:
    """Closed form between the tip circles, module 2 mm at 20 deg, by the drawn radii."""
    z = np.array([count, count] if isinstance(count, int) else count)
    base = z * 0.002 * np.cos(np.radians(20.0)) / 2.0
    working = np.sqrt(float(teeth["centre_distance"]) ** 2 - base.sum() ** 2)
    path = np.sqrt(teeth["tip_radius"].values ** 2 - base**2).sum() - working
    return float(path / (2.0 * np.pi * base[0] / z[0]))


@pytest.mark.whole
@pytest.mark.parametrize(
    ("name", "warning"),
    [
        ("pair_23_61", ""),
        ("pair_23_61_high_contact_ratio", ""),
        ("pair_17_17", ""),
        ("pair_12_120", ""),
        ("pair_12_120_undercut", "The undercut of gear 1 loses"),
        ("wheel_drives", ""),
    ],
)
def test_pairs_that_no_paper_holds(
    name: str, warning: str, pitchpoint: Callable[..., Told], tmp_path: Path
) -> None:
    told = pitchpoint("run", EXAMPLES / f"{name}.toml", "-o", tmp_path / "out", "--json")
    assert told.status == 0, told.err
    operation = told.json["default"]["operation"]["iso_tr_14179_2"]
    assert 0.9 < operation["mean_efficiency"] < 1.0
    assert any(text.startswith(warning) for text in [*told.json["default"]["warnings"], ""])
    parts = open_outcomes(tmp_path / "out")["default"].parts
    found = float(parts["operation"]["contact_ratio"].values[0, 0])
    gears = tomllib.loads((EXAMPLES / f"{name}.toml").read_text("utf-8"))["gears"]
    between_tips = contact_ratio(parts["teeth"], gears["teeth"])
    if warning:
        assert 1.2 < found < between_tips - 0.2
    else:
        assert found == pytest.approx(between_tips, rel=1e-3)
    ratio = 1.0 if isinstance(gears["teeth"], int) else gears["teeth"][1] / gears["teeth"][0]
    expected = 50.0 * ratio if name == "wheel_drives" else 50.0 / ratio
    assert operation["mean_input_torque"] == pytest.approx(
        expected / operation["mean_efficiency"], rel=1e-9
    )
