"""Whose folder it is, and folders that somebody else has filled."""

import json
import os
from pathlib import Path
from typing import Any

import pytest
from records import entries
from sound import PAIR

from pitchpoint.cases.library import as_text, find_case
from pitchpoint.cases.record import MANIFEST, RUN, Record, default_folder, folder_record
from pitchpoint.errors import InputError
from pitchpoint.results.store import dataset, save, without_nan, write_text
from pitchpoint.runs import run as running
from pitchpoint.runs.case import selected_variants
from pitchpoint.runs.run import manifests, open_outcomes, uncomputed_manifests
from pitchpoint.views.inputs import printed_input_rows, set_for_run

LAW = {"name": "constant", "title": "constant", "note": ""}
ROW = {"quantity": "q", "where": "Table 1", "printed": 1.0, "computed": None, "unit": "W"}
ROW |= {"tolerance": 0.1, "kind": "predicted", "verdict": "excluded", "reason": "", "bound": ""}
ROW |= {"expected_miss": False}
GOOD: dict[str, Any] = {
    "case": "pair.toml",
    "variant": "default",
    "surroundings": {"pitchpoint": "0.1.0"},
    "title": "A pair",
    "summary": "",
    "source": "",
    "inputs": entries({"operation.torque": 77.0}),
    "targets": [],
    "own": "",
    "implausible": [],
    "warnings": ["dry"],
    "briefs": ["dry: no film"],
    "laws": [LAW],
    "models": [{**LAW, "effect": "load sharing"}],
    "designation": "Spur pair 17/29",
    "family": "cylindrical",
    "driver": "gear 1",
    "loaded": "gear 2",
    "members": ["gear 1", "gear 2"],
    "motion": [1.0, -0.5],
    "period": 0.1,
    "pitch": "base pitch",
    "stages": [],
    "trains": [],
    "against": "",
    "travels": [],
    "lacks": {},
    "averaging": "path",
    "plastic": False,
    "oil": "an oil",
    "sources": [{"key": "xu_2007", "text": "Xu", "of": "friction xu_2007"}],
    "issues": [{"where": "eq. 3", "issue": "sign", "verdict": "misprint"}],
    "rows": [ROW],
    "parts": ["teeth"],
    "finished": True,
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A result of a pair."""
    place = tmp_path / "results" / "pair"
    write_text(
        place / RUN, '{"case": "pair.toml", "file": "../../pair.toml", "variants": ["default"]}'
    )
    write_text(place / "default" / MANIFEST, json.dumps(GOOD))
    save(dataset({"mean_loss": ((), 1.0)}, {}), place / "default" / "teeth.nc")
    return place


def told(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        open_outcomes(path)
    (line,) = str(caught.value).splitlines()
    assert len(line) < 400
    return line


def test_a_result_is_opened(folder: Path) -> None:
    (outcome,) = open_outcomes(folder).values()
    assert outcome.manifest == GOOD
    assert outcome.rows[0].as_json() == ROW
    assert float(outcome.parts["teeth"]["mean_loss"]) == 1.0


def nested(depth: int) -> str:
    return "[" * depth + "]" * depth


# ---- what a stranger may have written


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\0" * 4096,
        "3",
        "[]",
        "null",
        nested(100_000),
        '{"case": "a", "variants": ' + nested(500) + "}",
        '{"case": "a", "variants": null}',
        '{"case": "a", "variants": "default"}',
        '{"case": "a", "variants": {"default": 1}}',
        '{"case": "a", "variants": [["default"]]}',
        '{"case": "a", "variants": [1]}',
        '{"case": 1, "variants": []}',
        '{"variants": ["default"]}',
        '{"case": "a", "variants": ["default"], "more": 1}',
        '{"case": "a", "variants": ["' + "x" * 10_000 + '"]}',
        *(
            json.dumps({"case": "a", "variants": [name]})
            for name in ("../other", "/etc", "..", ".", "", "a/b", "a\\b", "C:", "a\n", "a\0", "é")
        ),
    ],
    ids=lambda text: repr(text[:40]),
)
def test_a_strangers_record_is_refused(folder: Path, text: str) -> None:
    (folder / RUN).write_text(text)
    assert told(folder).startswith(f"{folder / RUN}: ")


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *(
            (key, value)
            for key in GOOD
            for value in (None, 3, {"a": [1]}, [[["deep"]]])
            if (key, value) != ("period", 3)
        ),
        ("parts", ["../../other/default/teeth"]),
        ("parts", ["/etc/passwd"]),
        ("parts", [".."]),
        ("variant", "a/b"),
        ("finished", "yes"),
        ("surroundings", {"a": 1}),
        ("inputs", [{"table": "gears"}]),
        ("inputs", [{**GOOD["inputs"][0], "kind": "weight"}]),
        ("inputs", [{**GOOD["inputs"][0], "key": "a" * 401}]),
        ("laws", [{**LAW, "name": 1}]),
        ("sources", [{"key": "a"}]),
        ("rows", [{**ROW, "printed": "much"}]),
        ("rows", [{"quantity": "q"}]),
        ("more", 1),
    ],
    ids=str,
)
def test_a_strangers_manifest_is_refused(folder: Path, key: str, value: Any) -> None:
    (folder / "default" / MANIFEST).write_text(json.dumps({**GOOD, key: value}))
    line = told(folder)
    assert line.startswith(f"{folder / 'default' / MANIFEST}: {key}")
    with pytest.raises(InputError):
        manifests(str(folder))


@pytest.mark.parametrize("text", ["", nested(100_000), '{"parts": ["teeth"]}', "\udcff"])
def test_a_manifest_that_is_none(folder: Path, text: str) -> None:
    (folder / "default" / MANIFEST).write_text(text, errors="surrogateescape")
    assert "was not written by this version of pitchpoint" in told(folder)


def test_a_run_that_was_killed_at_once(folder: Path) -> None:
    (folder / "default" / MANIFEST).unlink()
    assert told(folder) == f"{folder}: holds no part yet that a run has finished"


def test_a_huge_record_is_not_read(folder: Path) -> None:
    with (folder / RUN).open("wb") as file:
        file.truncate(10**12)
    assert "a record has at most 50 MB" in told(folder)


def test_a_damaged_part_is_told_of(folder: Path) -> None:
    path = folder / "default" / "teeth.nc"
    path.write_bytes(path.read_bytes()[:-50])
    assert told(folder).startswith(f"{path}: is damaged")
    path.unlink()
    assert told(folder) == f"{path}: there is no such file"


# ---- whose folder


@pytest.fixture
def pairs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("a/pair.toml", "b/pair.toml", "pair.toml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    return tmp_path


def run_into(folder: Path, case: str, overwrite: bool = False) -> None:
    record = Record.of(case, as_text(Path(case).name), folder, ["default"])
    with running._own_folder(folder, record, overwrite):
        pass


def test_another_case_is_refused_unless_told(pairs: Path) -> None:
    out = Path("out")
    run_into(out, "a/pair.toml")
    before = (out / RUN).read_bytes()
    run_into(out, "a/../a/pair.toml")
    for other in ("b/pair.toml", "tian2024"):
        with pytest.raises(InputError) as caught:
            run_into(out, other)
        assert str(caught.value) == (
            "out: holds results of another case, ../a/pair.toml; give another folder, or"
            " --overwrite (overwrite=True) to replace them"
        )
    assert (out / RUN).read_bytes() == before
    run_into(out, "b/pair.toml", overwrite=True)
    assert folder_record(out) == Record(
        case="pair.toml", file="../b/pair.toml", variants=["default"]
    )


def test_case_and_results_may_move_together(pairs: Path) -> None:
    run_into(Path("a/out"), "a/pair.toml")
    Path("a").rename("moved")
    run_into(Path("moved/out"), "moved/pair.toml")
    with pytest.raises(InputError, match="another case"):
        run_into(Path("moved/out"), "b/pair.toml")


def test_a_link_is_the_case_it_leads_to(pairs: Path) -> None:
    Path("link.toml").symlink_to("a/pair.toml")
    run_into(Path("out"), "link.toml")
    run_into(Path("out"), "a/pair.toml")


def test_a_record_that_cannot_be_read_blocks_nothing(pairs: Path) -> None:
    run_into(Path("out"), "a/pair.toml")
    Path("out", RUN).write_bytes(bytes(40))
    run_into(Path("out"), "a/pair.toml")
    assert folder_record(Path("out")) is not None


def test_cases_of_one_name_have_folders_of_their_own(pairs: Path) -> None:
    root = Path("results")

    def folder_of(case: str) -> str:
        place = default_folder(case, root)
        run_into(place, case)
        return place.name

    cases = ("a/pair.toml", "b/pair.toml", "tian2024", "pair.toml")
    made = [folder_of(case) for case in cases]
    assert made == ["pair", "b-pair", "tian2024", f"{pairs.name}-pair"]
    assert [folder_of(case) for case in reversed(cases)] == made[::-1]
    assert [folder_of(str(pairs / "b" / "pair.toml"))] == ["b-pair"]


def test_names_that_are_no_text(pairs: Path) -> None:
    case = os.fsdecode(b"\xff/\xfe.toml")
    Path(case).parent.mkdir()
    Path(case).write_text("")
    assert find_case(case)[0] == "\\xfe.toml"
    out = Path(os.fsdecode(b"out\xfd"))
    run_into(out, case)
    run_into(out, case)
    assert default_folder(case, out.parent).name == os.fsdecode(b"\xfe")
    with pytest.raises(InputError, match="another case"):
        run_into(out, "pair.toml")


def test_a_file_named_like_a_shipped_case(pairs: Path) -> None:
    Path("tian2024.toml").write_text("")
    run_into(Path("results/tian2024"), "tian2024.toml")
    place = default_folder("tian2024", Path("results"))
    assert place.name == "published-tian2024"
    run_into(place, "tian2024")
    assert default_folder("tian2024", Path("results")) == place


def test_no_case_has_no_folder() -> None:
    with pytest.raises(InputError, match="did you mean tian2024"):
        default_folder("tian2042", Path("results"))
    assert default_folder("x" * 5000 + ".toml", Path("results"))  # is refused when it is read


# ---- sources without a run


def test_sources_of_a_case_or_of_its_result(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "uncomputed_manifests", lambda case: [{"described": case}])
    monkeypatch.chdir(folder.parents[1])
    Path("pair.toml").write_text("")
    assert manifests("results/pair") == [GOOD]
    assert manifests("pair.toml") == [{"described": "pair.toml"}]
    assert manifests("tian2024") == [{"described": "tian2024"}]
    Path("tian2024").mkdir()
    assert manifests("tian2024") == [{"described": "tian2024"}]
    folder.rename("xu2021")  # a folder that holds a result is meant before a case of its name
    assert manifests("xu2021") == [GOOD]
    for other, words in {
        "tian2042": "did you mean tian2024?",
        "results": "holds no result",
    }.items():
        with pytest.raises(InputError, match=words):
            manifests(other)


def test_a_record_has_its_own_sources(folder: Path) -> None:
    assert manifests(str(folder / "default" / MANIFEST)) == [GOOD]


# ---- what a record holds, and a case from it

ODD = f"""{PAIR}
[materials]
gear_2 = {{ value = {{ young = "3 GPa", poisson = 0.35 }}, status = "assumed", note = "a guess" }}
[dynamics]
[loss_map]
temperatures = ["40 degC", "61.7 degC"]
[studies.point]
[studies.other.change]
gears = {{ helix_angle = "7 deg" }}
models = {{ friction = {{ name = "constant", coefficient = "4 %" }} }}
[studies.several]
title = "Several"
sweep = {{ key = "gears.profile_shift", values = [[0.1, 0.2], [0.3, 0.1]] }}
[studies.warm.sweep]
key = "operation.temperature"
start = {{ value = "50 degF", status = "fitted" }}
stop = "60 degC"
"""
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def odd(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Record of a case in which much is odd."""
    path = tmp_path_factory.mktemp("odd") / "odd.toml"
    path.write_text(ODD)
    changes = {"operation.speed": "1234.5678 rpm", "gears.profile_shift.1": 0.37}
    (manifest,) = uncomputed_manifests(str(path), settings=changes)
    return manifest


def kept(manifest: dict[str, Any], folder: Path) -> str:
    path = folder / "kept.json"
    path.write_text(json.dumps(without_nan(manifest)))
    return str(path)


def row_of(manifest: dict[str, Any], path: str) -> dict[str, Any]:
    (row,) = (one for one in manifest["inputs"] if f"{one['table']}.{one['key']}" == path)
    return row


def test_numbers_are_recorded_in_si_with_their_kind(odd: dict[str, Any]) -> None:
    speed = row_of(odd, "operation.speed")
    assert speed["value"] == pytest.approx(1234.5678 * 2.0 * 3.141592653589793 / 60.0, rel=1e-15)
    assert (speed["kind"], speed["status"], speed["given"]) == ("rotational speed", "set", True)
    assert row_of(odd, "gears.profile_shift")["value"] == [0.37, 0.0]
    assert row_of(odd, "gears.profile_shift")["status"] == "set"
    assert row_of(odd, "loss_map.temperatures")["value"] == [313.15, 334.85]
    assert row_of(odd, "materials.gear_2.young")["note"] == "a guess"
    assert row_of(odd, "studies.other.change.models.friction.coefficient")["value"] == 0.04
    assert row_of(odd, "studies.several.sweep.values")["value"] == [[0.1, 0.2], [0.3, 0.1]]
    start = row_of(odd, "studies.warm.sweep.start")
    assert (start["value"], start["kind"], start["status"]) == (283.15, "temperature", "fitted")
    followed = row_of(odd, "gears.centre_distance")
    assert (followed["status"], followed["given"]) == ("derived", False)


def test_views_make_words_of_it(odd: dict[str, Any]) -> None:
    shown = {(row["table"], row["key"]): row["value"] for row in printed_input_rows(odd)}
    assert shown["operation", "speed"] == "1234.57 rpm"
    assert shown["gears", "profile_shift"] == "0.37 / 0"
    assert shown["materials", "gear_2.young"] == "3 GPa"
    assert ("loss_map", "temperatures") not in shown
    assert ("dynamics", "") not in shown
    told = set_for_run(odd)
    assert told == {"gears.profile_shift": "0.37 / 0", "operation.speed": "1234.57 rpm"}


def test_a_number_of_another_kind_is_shown_as_what_it_is() -> None:
    (row,) = entries({"gears.module": 3.0})
    ((shown,), (lost,)) = (
        printed_input_rows({"inputs": [{**row, **change}]})
        for change in ({"kind": "torque"}, {"value": None})
    )
    assert (shown["value"], lost["value"]) == ("3 N m", "undefined")


def test_a_case_is_made_again_from_its_record(odd: dict[str, Any], tmp_path: Path) -> None:
    (again,) = uncomputed_manifests(kept(odd, tmp_path))
    assert again == odd


@pytest.mark.parametrize(
    "case",
    [
        "tian2024",
        "zhao2022",
        pytest.param("liu_xiong_torus", marks=pytest.mark.whole),
        EXAMPLES / "strain_wave.toml",
        EXAMPLES / "helical_resonance.toml",
        EXAMPLES / "spur_modified.toml",
        EXAMPLES / "ball_on_disc.toml",
    ],
    ids=str,
)
def test_cases_are_made_again_from_their_records(case: str | Path, tmp_path: Path) -> None:
    for manifest in uncomputed_manifests(str(case)):
        (again,) = uncomputed_manifests(kept(manifest, tmp_path))
        assert again == manifest


def test_other_surroundings_are_told(odd: dict[str, Any], tmp_path: Path) -> None:
    there = {**odd["surroundings"], "jax": "0.1", "code": "0" * 16}
    (again,) = uncomputed_manifests(kept({**odd, "surroundings": there}, tmp_path))
    here = odd["surroundings"]
    told = (
        f"The record was made with jax 0.1, code {'0' * 16} and is computed with jax {here['jax']}, "
        f"code {here['code']}: numbers may differ."
    )
    assert told in again["warnings"]
    assert [one for one in again["warnings"] if one != told] == odd["warnings"]


def test_a_law_of_the_users_own_is_asked_for_again(odd: dict[str, Any], tmp_path: Path) -> None:
    path = kept({**odd, "own": "my_law"}, tmp_path)
    with pytest.raises(
        InputError, match="'my_law', a friction law of the user's own, which no record"
    ):
        uncomputed_manifests(path)
    law = running._own(lambda *, pressure: pressure)
    (variant,) = selected_variants(str(path), own=law)
    assert variant.own is law
    with pytest.raises(InputError, match="this case has no variants"):
        uncomputed_manifests(kept(odd, tmp_path), ["physical"])


MODULE = "gears.module"


@pytest.mark.parametrize(
    ("path", "change", "words"),
    [
        (MODULE, {"value": -0.002}, '"-0.002 m" is out of range; allowed is 0.01 mm to 100 mm'),
        (MODULE, {"value": float("nan")}, "does not start with a plain finite number"),
        (MODULE, {"value": 10**50}, "is too large"),
        (MODULE, {"value": 3}, '"3" has no unit'),
        (MODULE, {"value": [0.1, 0.1, 0.1]}, "was given where one value belongs"),
        (MODULE, {"value": {"a": 0.1}}, "was given where one value belongs"),
        (MODULE, {"kind": "torque"}, "is a torque, but a length is needed"),
        (MODULE, {"kind": {"a": "length"}}, "has no unit"),
        (MODULE, {"key": "modul"}, "is not a known key; did you mean module?"),
        (MODULE, {"key": "teeth.1"}, '"teeth" is a value, not a table'),
        (MODULE, {"table": "geers"}, "did you mean gears?"),
        (MODULE, {"table": "", "key": ""}, "is not a known"),
        (MODULE, {"key": ".".join("a" * 99)}, "nested more than 16 levels"),
        (MODULE, {"status": "sure"}, "is not a status"),
        (MODULE, {"note": "x" * 3000}, "has 3000 characters"),
        (MODULE, {"given": False}, "is missing"),
        ("lubricant.name", {"value": "olive"}, "is not a known lubricant"),
        ("studies.warm.sweep.start", {"value": 1e4}, "is out of range"),
        ("studies.warm.sweep.key", {"value": "operation.speed"}, "rotational speed is needed"),
    ],
    ids=lambda value: str(value)[:40],
)
def test_a_record_that_was_changed(
    odd: dict[str, Any], tmp_path: Path, path: str, change: dict[str, Any], words: str
) -> None:
    changed = json.loads(json.dumps({**odd, "targets": [], "own": ""}))
    row_of(changed, path).update(change)
    (file := tmp_path / "kept.json").write_text(json.dumps(changed))
    with pytest.raises(InputError) as caught:
        uncomputed_manifests(str(file))
    line, *_ = str(caught.value).splitlines()  # what is missing elsewhere for it stands behind
    assert "kept.json: " in line
    assert words in line
    assert len(line) < 600


def test_a_driver_that_does_not_move(odd: dict[str, Any], tmp_path: Path) -> None:
    for change, words in (
        ({"driver": "gear 3"}, "'gear 3' is none of the members"),
        ({"motion": [1.0]}, "motion has not as many rates as there are members"),
    ):
        with pytest.raises(InputError, match=words):
            uncomputed_manifests(kept({**odd, **change}, tmp_path))


def test_the_lubricant_factor_of_a_mineral_oil_stands_among_what_is_fitted(tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    path.write_text(PAIR.replace("75W90-A", "mineral-vg-150"))
    rows = printed_input_rows(uncomputed_manifests(str(path))[0])
    (row,) = (one for one in rows if "X_L" in one["key"])
    assert row["status"] == "fitted" and row["value"].startswith("0.846")
    assert "friction by iso_tr_14179_2 alone" in row["note"] and row["where"] == "fernandes_2022"
