"""Whose folder it is, and folders that somebody else has filled."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from pitchpoint.cases import run as running
from pitchpoint.cases.library import as_text, find
from pitchpoint.cases.record import MANIFEST, RUN, Record, default_folder, owner
from pitchpoint.cases.run import manifests, open_result
from pitchpoint.errors import InputError
from pitchpoint.results.store import dataset, save, write_text

LAW = {"name": "constant", "title": "constant", "note": ""}
ROW = {"quantity": "q", "where": "Table 1", "printed": 1.0, "computed": None, "unit": "W"}
ROW |= {"tolerance": 0.1, "kind": "predicted", "verdict": "excluded", "reason": "", "bound": ""}
GOOD: dict[str, Any] = {
    "case": "pair.toml",
    "variant": "default",
    "variants": ["default"],
    "title": "A pair",
    "summary": "",
    "settings": {"operation.torque": "77 N m"},
    "inputs": [dict.fromkeys(("table", "key", "value", "status", "where", "note"), "")],
    "warnings": ["dry"],
    "laws": [LAW],
    "models": [{**LAW, "effect": "load sharing"}],
    "family": "cylindrical",
    "driver": "gear 1",
    "loaded": "gear 2",
    "averaging": "path",
    "plastic": False,
    "oil": "an oil",
    "sources": [{"key": "xu_2007", "text": "Xu"}],
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
        open_result(path)
    (line,) = str(caught.value).splitlines()
    assert len(line) < 400
    return line


def test_a_result_is_opened(folder: Path) -> None:
    (outcome,) = open_result(folder).values()
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
        *((key, value) for key in GOOD for value in (None, 3, {"a": [1]}, [[["deep"]]])),
        ("parts", ["../../other/default/teeth"]),
        ("parts", ["/etc/passwd"]),
        ("parts", [".."]),
        ("variants", ["../other"]),
        ("variant", "a/b"),
        ("finished", "yes"),
        ("settings", {"a": 1}),
        ("inputs", [{"table": "gears"}]),
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
    assert "has more than 50 MB" in told(folder)


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
    with running._own_folder(folder, case, as_text(Path(case).name), ["default"], overwrite):
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
    assert owner(out) == Record(case="pair.toml", file="../b/pair.toml", variants=["default"])


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
    assert owner(Path("out")) is not None


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
    assert find(case)[0] == "\\xfe.toml"
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
    assert place.name == "cases-tian2024"
    run_into(place, "tian2024")
    assert default_folder("tian2024", Path("results")) == place


def test_no_case_has_no_folder() -> None:
    with pytest.raises(InputError, match="did you mean tian2024"):
        default_folder("tian2042", Path("results"))
    assert default_folder("x" * 5000 + ".toml", Path("results"))  # is refused when it is read


# ---- sources without a run


def test_sources_of_a_case_or_of_its_result(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "describe", lambda case: [{"described": case}])
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
