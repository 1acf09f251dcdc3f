"""From a task to designs: what a task may be, fronts, losses of teeth, sizes of catalogues, refusals."""

import errno
import re
import sys
import tomllib

import numpy as np
import pytest
import tomlkit
from jsonschema import Draft202012Validator

from pitchpoint import cli
from pitchpoint.cases.json_schema import table_schema
from pitchpoint.errors import InputError
from pitchpoint.results import store
from pitchpoint.sizing.arrangements import arrangements, reach_words, shifted_pairs
from pitchpoint.sizing.front import CHUNK, non_dominated, representatives
from pitchpoint.sizing.sizing import SizedDrive, Sizing, size
from pitchpoint.sizing.stage_forms import tooth_loss
from pitchpoint.sizing.strain_wave import strain_wave_sizes, why_no_size
from pitchpoint.sizing.task_table import SIZED_FAMILIES, TASK_TABLE, Task, read_task, task_template
from pitchpoint.views.sizing_screen import doubts_of_sizing

TASK = {"torque": "60 N m", "ratio": 60, "speed": "30 rpm", "life": "5000 h"}


def test_a_task_is_read_in_si_and_families_keep_their_order():
    task = Task.read(**TASK, families="3K, two stages", diameter="120 mm", length=None)
    assert task.torque == 60.0 and task.speed == pytest.approx(np.pi) and task.life == 1.8e7
    assert task.families == ("two stages", "3K") and task.diameter == 0.12 and task.length is None
    assert Task.read(**TASK).families == SIZED_FAMILIES


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("ratio", 1, "1 is out of range; allowed is 1.2 to 2000"),
        ("ratio", float("nan"), '"nan" does not start with a plain finite number'),
        ("ratio", -60, "-60 is out of range"),
        ("torque", "60 mm", "is a length, but a torque is needed"),
        ("torque", "nan N m", "does not start with a plain finite number"),
        ("torque", "0 N m", "allowed is above 0 N m"),
        ("speed", "30", "has no unit where a rotational speed is needed"),
        ("life", "5000 rpm", "is a rotational speed, but a time is needed"),
        ("application_factor", 0.9, "0.9 is out of range; allowed is 1 to 10"),
        ("families", "cycloid", "is no family that is sized; known are one stage"),
        ("families", "", "names none"),
        ("aims", "price", "is no aim; known are mass, loss, diameter and backlash"),
        ("material", "PA66", "has no strength of flanks and roots"),
        ("centre_distances", "1 mm, 2 mm, 3 mm, 4 mm", "has 4 values; give one for all stages"),
    ],
)
def test_what_is_wrong_with_a_task_is_one_sentence_with_its_key(key, value, told):
    with pytest.raises(InputError, match=re.escape(told)) as caught:
        Task.read(**(TASK | {key: value}))
    assert str(caught.value).startswith(f"{key}: ") and "\n" not in str(caught.value)


def test_all_that_is_wrong_with_a_task_is_told_at_once():
    with pytest.raises(InputError) as caught:
        size("60 mm", 1.0, "30", "5000 h")
    assert [line.partition(":")[0] for line in str(caught.value).splitlines()] == [
        "torque",
        "ratio",
        "speed",
    ]


EVERY = {
    "ratio_tolerance": 0.02,
    "diameter": "120 mm",
    "length": "90 mm",
    "centre_distances": ["40 mm", "60 mm"],
    "families": ["3K", "two stages"],
    "planets": [3, 5],
    "material": "case-hardened-mq",
    "flank_safety": 1.1,
    "root_safety": 1.4,
    "application_factor": 1.25,
    "face_load_factor": 1.3,
    "slenderness": 1.0,
    "aims": ["mass", "loss"],
    "lubricant": "mineral-vg-220",
    "temperature": "70 degC",
}
"""Keys of a task that may be left out, each with another value than the usual one where there is one."""


def written(folder, tables):
    path = folder / "task.toml"
    path.write_text(tomlkit.dumps(tables), "utf-8")
    return path


def test_a_file_asks_for_what_options_ask_for_and_options_win(tmp_path):
    assert {*TASK, *EVERY} == {*Task.model_fields}
    path = written(tmp_path, {"title": "joint", "size": TASK | EVERY})
    assert read_task(path) == Task.read(**TASK, **EVERY) != Task.read(**TASK)
    options = {"torque": "80 N m", "families": "planetary", "diameter": None}
    changed = TASK | EVERY | {"torque": "80 N m", "families": "planetary"}
    assert read_task(path, **options) == Task.read(**changed)
    marked = TASK | {"life": {"value": "5000 h", "status": "assumed", "note": "of the arm"}}
    assert read_task(written(tmp_path, {"size": marked})) == Task.read(**TASK)


def test_a_file_of_a_task_sizes_what_its_options_size(tmp_path, monkeypatch, capsys):
    sentence = "no drive does this: planetary: reaches ratios of 2.8 to 11, 70 is asked"
    path = written(tmp_path, {"size": TASK | {"families": "planetary"}})
    with pytest.raises(InputError, match=f"^{sentence}$"):
        size(path, 70)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "size", str(path), "--ratio", "70:1"])
    with pytest.raises(SystemExit):
        cli.main()
    assert capsys.readouterr().err == f"error: {sentence}\n"


@pytest.mark.parametrize(
    ("tables", "told"),
    [
        (
            {"size": {"torqe": "60 N m", "ratio": 1, "speed": "30 rpm"}, "output": {}},
            [
                "output: is no part of a task; known are title, size",
                'size.life: is missing; write "5000 h"; allowed is above 0 h to 1.11111e+06 h',
                "size.ratio: 1 is out of range; allowed is 1.2 to 2000",
                "size.torqe: is not a known key; did you mean torque?",
            ],
        ),
        ({"sizes": TASK}, ["sizes: is no part of a task; did you mean size?"]),
        ({"size": 3}, ["size: 3 was given where one table [size] belongs"]),
        (
            {"title": "joint"},
            [
                "size: is missing: torque, ratio, speed and life stand in a table [size], which pitchpoint "
                "new size writes"
            ],
        ),
    ],
)
def test_what_is_wrong_with_the_file_of_a_task_is_told_at_once_with_its_keys(
    tmp_path, tables, told
):
    with pytest.raises(InputError) as caught:
        read_task(written(tmp_path, tables))
    assert sorted(str(caught.value).splitlines()) == [f"task.toml: {line}" for line in told]


def test_a_case_is_no_task_and_is_told_as_such(tmp_path):
    path = written(tmp_path, {"gears": {"teeth": [20, 30]}})
    with pytest.raises(InputError) as caught:
        read_task(path)
    assert str(caught.value) == (
        f"task.toml: is a case, which has its gears: pitchpoint run {path}; a task is a table [size], which "
        "pitchpoint new size writes"
    )


def test_a_new_task_reads_with_all_its_remarks_and_editors_take_it(tmp_path):
    validator = Draft202012Validator(table_schema("task", TASK_TABLE, Task))
    text = task_template()
    every = re.sub(r"^# (\w+ = )", r"\1", text, flags=re.MULTILINE)
    for lines in (text, every):
        (tmp_path / "new.toml").write_text(lines, "utf-8")
        assert [*validator.iter_errors(tomllib.loads(lines))] == []
    assert {*tomllib.loads(every)[TASK_TABLE]} == {*Task.model_fields}
    sizes = dict.fromkeys(("diameter", "length", "centre_distances"), "3 mm")
    small = Task.read(**TASK, **sizes, planets=3)
    assert read_task(tmp_path / "new.toml") == small  # what has no usual value has an example
    for wrong in ({**TASK, "families": ["cycloid"]}, {**TASK, "ratio": 1}, {"torque": "60 N m"}):
        assert [*validator.iter_errors({"size": wrong})]


def test_a_front_is_that_of_every_pair_compared():
    costs = np.random.default_rng(3).integers(0, 12, (3 * CHUNK // 2, 3)).astype(float)
    better = (costs[None] <= costs[:, None]).all(axis=2) & (costs[None] < costs[:, None]).any(
        axis=2
    )
    expected = ~better.any(axis=1)
    seen = set()
    for number in np.flatnonzero(expected):  # of designs that are alike the first one stays
        expected[number] = tuple(costs[number]) not in seen
        seen.add(tuple(costs[number]))
    assert np.array_equal(non_dominated(costs), expected)
    assert non_dominated(np.zeros((0, 2))).shape == (0,)


def test_a_few_stand_for_many_with_the_best_by_each_aim():
    costs = np.random.default_rng(1).normal(size=(50, 3))
    few = representatives(costs, 7)
    assert 5 <= len(few) <= 7 and np.all(np.diff(costs[few, 0]) > 0.0)
    assert costs[few[-1], 0] == costs[:, 0].max()
    assert {*costs.argmin(axis=0)} <= {*few}
    assert len(representatives(costs, 80)) == 50
    assert len(representatives(costs[:0], 7)) == 0


def test_each_stage_has_the_centre_distance_that_is_given_for_it():
    task = Task.read(**TASK, centre_distances="40 mm, 60 mm")
    assert [task.most_distance(stage, 2) for stage in range(2)] == [0.04, 0.06]
    assert task.most_distance(0, 3) == 0.0  # of two stages, not of three
    for_all = Task.read(**TASK, centre_distances="50 mm")
    assert [for_all.most_distance(stage, 3) for stage in range(3)] == [0.05] * 3
    assert Task.read(**TASK).most_distance(2, 3) == np.inf


def test_the_best_of_a_front_are_those_with_the_least_and_the_one_that_lacks_little_of_both():
    rest = dict.fromkeys(("ratio", "diameter", "length", "backlash", "stiffness", "inertia"), 1.0)
    rest |= {"flank_safety": 2.0, "root_safety": 2.0}
    costs = {"light": (1.0, 0.09), "middle": (2.0, 0.02), "lossless": (9.0, 0.01)}
    designs = {
        name: SizedDrive(name=name, family="3K", tree={}, mass=mass, loss=loss, **rest)
        for name, (mass, loss) in costs.items()
    }
    task = Task.read(**TASK, aims="mass, loss")
    best = Sizing(task, designs, tuple(designs), {"3K": 3}, {}).best
    assert best == {"mass": "light", "loss": "lossless", "balanced": "middle"}


@pytest.mark.parametrize(("temperature", "beyond"), [("60 degC", True), ("20 degC", False)])
def test_losses_of_strain_wave_gears_beyond_their_set_are_told(temperature, beyond):
    """The data of the set end at 40 degC, and a sizing begins with 60 degC."""
    numbers = dict.fromkeys(OF_DESIGN, 1.0)
    design = SizedDrive(name="a", family="strain wave", tree={}, **numbers)
    task = Task.read(**TASK, temperature=temperature)
    every = " ".join(doubts_of_sizing(Sizing(task, {"a": design}, ("a",), {}, {})))
    told = "fitted from -10 °C to 40 °C: extrapolated to 60 °C."
    assert (told in every) == beyond == ("extrapolated" in every)


OF_DESIGN = (
    "ratio",
    "mass",
    "loss",
    "diameter",
    "length",
    "backlash",
    "stiffness",
    "inertia",
    "flank_safety",
    "root_safety",
)


def test_losses_of_helical_teeth_are_the_mean_over_lines_that_fill_the_path():
    teeth, friction = np.array([23.0, 61.0]), 0.04
    parts = np.array([0.9, 0.6])  # beyond the pitch point, and before it, in base pitches
    path = np.linspace(-parts[1], parts[0], 20_001)
    sliding = 2.0 * np.pi * np.abs(path) * (1.0 / teeth).sum()  # over the speed of the base circles
    lost = friction * np.trapezoid(sliding, path) / parts.sum()
    found = tooth_loss(teeth[None], parts[None], np.array([friction]), np.array([1.2]), np.ones(1))
    assert found[0] == pytest.approx(lost, rel=1e-6)


def test_strain_wave_gears_bear_the_torque_for_the_life_that_is_asked():
    task = Task.read(**TASK)
    sizes = strain_wave_sizes(task, 60.0)
    assert [one.ratio for one in sizes] == [60.0] * 3
    assert all(one.rated >= task.torque for one in sizes)
    shortly = strain_wave_sizes(Task.read(**(TASK | {"life": "1 h"})), 60.0)
    assert (
        shortly[0].rated >= task.torque > 0.5 * shortly[0].rated
    )  # the life does not ask for more
    longer = strain_wave_sizes(Task.read(**(TASK | {"life": "100000 h"})), 60.0)
    assert longer[0].diameter > sizes[0].diameter
    assert strain_wave_sizes(task, 20.0) == []
    assert why_no_size(task, 20.0) == "reaches ratios of 30 to 320, 20 is asked"
    heavy = Task.read(**(TASK | {"torque": "1e5 N m"}))
    assert re.fullmatch(
        r"the largest of a catalogue's sizes bears \d+ N m for that life, 100000 N m are asked",
        why_no_size(heavy, 60.0),
    )


def test_strain_wave_gears_turn_no_faster_than_a_catalogue_allows():
    fast = Task.read(**(TASK | {"torque": "5 N m", "speed": "300 rpm"}))
    assert strain_wave_sizes(fast, 100.0) == []
    assert why_no_size(fast, 100.0) == (
        "the smallest of a catalogue's sizes that bears it turns at up to 8500 rpm at its input, 30000 rpm "
        "are asked"
    )
    slower = Task.read(**(TASK | {"torque": "5 N m", "speed": "60 rpm"}))
    sizes = strain_wave_sizes(slower, 100.0)
    assert sizes and all(60.0 * 100.0 * np.pi / 30.0 <= size.most_speed for size in sizes)
    between = strain_wave_sizes(Task.read(**(TASK | {"torque": "5 N m", "speed": "82 rpm"})), 100.0)
    assert 0 < len(between) < len(sizes)  # larger ones bear it too, and turn slower


def test_ratios_of_strain_wave_gears_are_as_near_as_is_asked():
    near = Task.read(**(TASK | {"ratio": 100.3, "ratio_tolerance": 0.0003}))
    assert strain_wave_sizes(near, 100.3) == []
    assert why_no_size(near, 100.3) == "a ratio of 100.5 is the nearest one"
    for ratio, tolerance in ((100.5, 0.0003), (100.3, 0.0021)):
        within = Task.read(**(TASK | {"ratio": ratio, "ratio_tolerance": tolerance}))
        assert strain_wave_sizes(within, ratio)[0].ratio == 100.5


@pytest.mark.parametrize("limit", [{"length": "20 mm"}, {"diameter": "80 mm"}])
def test_a_strain_wave_gear_is_within_the_length_and_the_diameter_that_are_asked(limit):
    told = "has a diameter of 81 mm and a cup of 30 mm length, more than is allowed"
    with pytest.raises(InputError, match=told):
        size(**(TASK | {"ratio": 100}), families="strain wave", **limit)


def test_an_oil_outside_of_its_range_is_told_as_such():
    with pytest.raises(
        InputError, match=r"^temperature: 300 degC is outside the range of pao-vg-150; allowed"
    ):
        size(**TASK, families="two stages", temperature="300 degC")


def test_cases_of_a_front_are_written_all_or_none(tmp_path, monkeypatch):
    numbers = dict.fromkeys(
        ("ratio", "mass", "loss", "diameter", "length", "backlash", "stiffness", "inertia"), 1.0
    )
    numbers |= {"flank_safety": 2.0, "root_safety": 2.0}
    designs = {name: SizedDrive(name=name, family="3K", tree={}, **numbers) for name in ("a", "b")}
    sizing = Sizing(Task.read(**TASK), designs, ("a", "b"), {"3K": 2}, {})
    whole = store._renamed

    def full(path, content, *, lasting):
        if path.name == "b.toml":
            raise OSError(errno.ENOSPC, "No space left on device")
        whole(path, content, lasting=lasting)

    with monkeypatch.context() as patched:
        patched.setattr(store, "_renamed", full)
        with pytest.raises(OSError, match="No space left on device"):
            sizing.write(tmp_path / "front")
    assert [*(tmp_path / "front").iterdir()] == []
    assert [path.name for path in sizing.write(tmp_path / "front")] == ["a.toml", "b.toml"]
    assert {*(tmp_path / "front").iterdir()} == {
        tmp_path / "front" / name for name in ("a.toml", "b.toml")
    }


def test_why_a_family_does_not_reach_a_ratio_is_told_with_how_far_it_goes():
    task = Task.read(**TASK)
    assert reach_words(task, "one stage") == "reaches ratios of 1.25 to 8, 60 is asked"
    assert reach_words(task, "planetary") == "reaches ratios of 2.8 to 11, 60 is asked"
    both = "planetary and strain wave"
    with pytest.raises(InputError, match=f"{both}: reaches ratios of 84 to 3520, 60 is asked"):
        size(**TASK, families=both)
    told = "no teeth that can be made come within 3 % of that ratio"
    assert reach_words(task, "stepped planets") == told
    with pytest.raises(InputError) as caught:
        size(**TASK, families="one stage, planetary")
    assert str(caught.value) == (
        "no drive does this: one stage: reaches ratios of 1.25 to 8, 60 is asked; planetary: reaches ratios "
        "of 2.8 to 11, 60 is asked"
    )


def test_sets_have_as_many_planets_as_are_asked_for():
    task = Task.read(**TASK | {"ratio": 6.0}, families="planetary", planets="6, 4")
    assert task.planets == (4.0, 6.0)
    (arranged,) = arrangements(task, "planetary")
    assert {form.gears["planets"] for form in arranged.stages[0]} == {4}  # six have no room
    told = "no teeth that can be made come within 3 % of that ratio with 7 planets"
    crowded = Task.read(**TASK | {"ratio": 9.3}, families="planetary", planets=7)
    assert reach_words(crowded, "planetary") == told


def test_profile_shifts_that_are_tried_keep_the_limits_of_teeth():
    """Few teeth and no helix, by the formulas of a rack and of the involute."""
    task, (first, second) = Task.read(**TASK), (13, 50)
    shifts = [form.gears["profile_shift"] for form in shifted_pairs(task, first, second, 0.0)]
    sums = np.array(shifts).sum(axis=1)
    assert len(shifts) >= 4 and np.ptp(sums) > 0.7
    for form, x in zip(shifted_pairs(task, first, second, 0.0), shifts, strict=True):
        assert 1.0 - x[0] <= 0.5 * first * np.sin(np.radians(20.0)) ** 2 + 1e-9  # no undercut
        pair = form.built.meshes[0].design.mesh
        start, end = (float(position) for position in pair.limits)
        length = float(pair.tangent_length)
        at_roots = np.array(
            [(length - start) / start, end / (length - end) * (second / first) ** 2]
        )
        sliding = at_roots * first / second - 1.0
        assert sliding.max() <= 3.0 and float(pair.transverse_contact_ratio) >= 1.2
        assert min(float(gear.tip_thickness / pair.module) for gear in pair.gears) >= 0.2
    assert [0.36, -0.36] not in shifts  # the pinion would slide by more than four


@pytest.mark.parametrize("held", ["report.html", "3_stages_01.toml"])
def test_a_folder_that_holds_a_sizing_is_refused_before_the_search(
    held, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("pitchpoint.sizing.sizing.sized_for", lambda task: pytest.fail("searched"))
    (tmp_path / held).write_text("", "utf-8")
    options = [word for key, value in TASK.items() for word in (f"--{key}", str(value))]
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "size", *options, "-o", str(tmp_path)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith(f"{held}: is there already; name another folder\n")
