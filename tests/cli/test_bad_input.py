"""Gears that cannot run, and files that are wrong as a whole, get one clear sentence."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from called import written
from sound import PAIR

# ---- files that are wrong as a whole

GEAR_WORDS = {
    "pointed tooth": (
        ("gears", {"profile_shift": [1.5, 0.0], "teeth": [12, 61]}),
        "gears.addendum: the tip circle of gear 1",
        "where the flanks cross; it may be",
    ),
    "contact ratio below one": (
        ("gears", {"addendum": 0.4}),
        "gears.addendum: the contact ratio of gear 1 and gear 2 is 0.7",
        "must be at least 1",
    ),
    "interference": (
        ("gears", {"teeth": [40, 120], "addendum": [1.5, 1.0], "dedendum": 1.2}),
        "gears.dedendum: the tip of gear 1 runs into the root of gear 2",
        "must be positive",
    ),
    "interference with the fillet": (
        ("gears", {"teeth": [40, 120], "addendum": [1.0, 1.5], "dedendum": 1.2}),
        "gears.addendum: the tip of gear 2 runs into the fillet of gear 1",
        "parts them; it runs with addendum = [1, ",
    ),
    "overlapping flanks": (
        ("gears", {"centre_distance": "83 mm"}),
        "gears.centre_distance: the flanks of gear 1 and gear 2 overlap",
        "at least 84 mm",
    ),
    "too cold": (
        ("operation", {"temperature": "-40 degC"}),
        "operation.temperature: -40 degC is outside the range of 75W90-A",
        "degC to 120 degC",
    ),
    "loss map too hot": (
        ("loss_map", {"temperatures": ["60 degC", "130 degC"]}),
        "loss_map.temperatures: 130 degC is outside the range of 75W90-A",
        "degC to 120 degC",
    ),
    "sharing of helical teeth": (
        ("gears", {"helix_angle": "15 deg"}),
        "models.load_sharing: 'sanchez_2017' holds for spur gears, and these are helical",
        "choose one of equal, from_stiffness",
    ),
    "a bore larger than the root": (
        ("gears", {"bore_diameter": ["10 mm", "300 mm"]}),
        "gears.bore_diameter: the bore diameter of gear 2 is 300 mm; it must be smaller than its root",
    ),
    "a ring smaller than its pinion": (
        ("gears", {"teeth": [23, -20]}),
        "gears.teeth: the ring, gear 2, has 20 teeth and must have more than gear 1, which has 23",
    ),
    "a ring of few teeth": (("gears", {"teeth": [23, -4]}), "gears.teeth: gear 2 was given -4"),
    "sharing beyond two": (
        ("gears", {"addendum": 1.4, "profile_shift": [0.4, -0.2]}),
        "models.load_sharing: 'sanchez_2017' holds for contact ratios between 1 and 2, this pair has 2",
        "equal, from_stiffness, single",
    ),
}


@pytest.mark.parametrize("name", GEAR_WORDS)
def test_gears_that_cannot_run(name: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    (table, change), *words = GEAR_WORDS[name]
    tree = {**tomllib.loads(PAIR), "models": {"load_sharing": "sanchez_2017"}}
    tree[table] = {**tree.get(table, {}), **change}
    told = refuse("show", written(tree, tmp_path))
    assert told.startswith(f"error: bad.toml: {words[0]}")
    for word in words:
        assert word in told


def deep(levels: int) -> bytes:
    return f"a{'.a' * levels} = 1".encode()


FILES = {
    "not TOML": (b"[gears\nteeth = 3", "is not a TOML file: line 1", "write [gears]"),
    "two of a kind": (b"a = 1\na = 2", "is not a TOML file: ", "line 2", "a = 2; write it once"),
    "binary": (b"\x00\x01\x02", "is not a TOML file", "line 1"),
    "not UTF-8": ("title = 'é'".encode("latin-1"), "is not UTF-8 text", "Latin-1"),
    "empty": (b"", "gears: is missing", "gears, lubricant, roughness, operation"),
    "only a remark": (b"# nothing", "gears: is missing", "gears, lubricant, roughness, operation"),
    "deep tables": (deep(50_000), "is nested more than 16 levels", "most allowed"),
    "deep tables in a line": (b"a = {" + deep(50_000) + b"}", "is nested more than 16", "allowed"),
    "many keys": (b"".join(b"k%d = 1\n" % i for i in range(90_000)), "k0: is not a known key", "g"),
    "a misspelt table": (b"[gaers]\nteeth = 20", "gaers: is not a known table", "mean gears?"),
    "deep lists": (b"a = " + b"[" * 50_000, "is nested more than 16 levels", "most allowed"),
    "closed lists": (b"a = " + b"[" * 40 + b"]" * 40, "is nested more than", "16 levels"),
    "too many digits": (b"a = " + b"9" * 5000, "is not a TOML file", "digit"),
    "many hexadecimal digits": (b"title = 0x" + b"f" * 9000, "title: a whole number", "text"),
    "control characters": (b'"a\\nb\\u001b[1m" = 1', "a\\nb\\x1b[1m", "known key"),
    "many losses": (
        PAIR.encode()
        + b"".join(b"[losses.a%d]\nbetween = ['gear 1', 'housing']\n" % i for i in range(400)),
        "losses: 400 were given; allowed are at most 20",
    ),
    "many studies": (
        PAIR.encode() + b"".join(b"[studies.a%d]\n" % i for i in range(20_000)),
        "studies: 20000 were given; allowed are at most 200",
    ),
    "many variants": (
        b"".join(b"[variants.a%d]\n" % i for i in range(5000)),
        "variants: 5000 were given; allowed are at most 50",
    ),
    "a long key of a change": (
        PAIR.encode() + b"[studies.a.change.gears.module]\n" + b"k" * 100_000 + b" = 1",
        "studies.a: gears.module.kkk",
        '...: "module" is a value, not a table',
    ),
    "a long title": (
        b"title = '" + b"k" * 100_000 + b"'",
        "title: has 100000 characters; allowed are at most 2000",
    ),
    "a remark that is none": (
        b"[gears]\nmodule = { value = 1, note = [2] }",
        "gears.module: ",
        "[2]",
    ),
    "a long remark": (
        b"[gears]\nmodule = { value = 1, where = '" + b"k" * 9000 + b"' }",
        "gears.module: has 9000 characters",
    ),
    "a long key": (b"k" * 100_000 + b" = 1", "kkk...: is not a known key", "gears"),
    "a long text": (b"gears = '" + b"k" * 100_000 + b"'", "gears: ", "where a table belongs"),
}


@pytest.mark.parametrize("name", FILES)
def test_files_that_are_no_case(name: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    content, *words = FILES[name]
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    told = refuse("show", path, several=True)
    assert told.startswith("error: bad.toml: ")
    for word in words:
        assert word in told


def test_a_byte_order_mark_does_no_harm(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_bytes(b"\xef\xbb\xbf[gears]\nteeth = -1")
    assert "gears.teeth: gear 1 was given -1 teeth; allowed are 2 or more" in (
        refuse("show", path, several=True)
    )


def test_a_file_of_a_gigabyte(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    with path.open("wb") as file:
        file.truncate(10**9)
    assert "bad.toml: has 1000 MB; a case file has at most 1 MB" in refuse("run", path)


@pytest.mark.parametrize("command", ["show", "run", "compare"])
def test_no_such_file(command: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    assert "gone.toml: there is no such case file" in refuse(command, tmp_path / "gone.toml")
    assert "is a folder" in refuse(command, tmp_path)
    assert "'tian2042' is neither a shipped case nor a file" in (
        told := refuse(command, "tian2042")
    )
    assert "did you mean tian2024?" in told
    assert "variants" in refuse(command, "tian2024", "--variant", "as_publisht")
    assert refuse(command, "x" * 5000)
    assert refuse(command, f"{'x' * 5000}.toml")
    for endless in ("/dev/null", "/dev/zero"):
        assert "is a pipe or a device; give a case file" in refuse(command, endless)


def test_a_case_without_targets(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = written(tomllib.loads(PAIR), tmp_path)
    assert "bad.toml: has no targets to compare with" in refuse("compare", path)


@pytest.mark.parametrize("name", ["missing", "empty", "other", "broken"])
def test_nothing_to_cite(name: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    folder = tmp_path / name
    if name != "missing":
        (folder / "default").mkdir(parents=True)
    if name in ("other", "broken"):
        text = '{"parts": 3}' if name == "other" else '{"parts": ['
        (folder / "default" / "manifest.json").write_text(text)
    told = refuse("cite", folder)
    assert name in told
    assert "pitchpoint" in told
