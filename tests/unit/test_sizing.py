"""From a task to designs: what a task may be, fronts, losses of teeth, sizes of catalogues, refusals."""

import errno
import re

import numpy as np
import pytest

from pitchpoint.errors import InputError
from pitchpoint.results import store
from pitchpoint.sizing.arrangements import reach_words
from pitchpoint.sizing.front import CHUNK, non_dominated, representatives
from pitchpoint.sizing.sizing import SizedDrive, Sizing, size
from pitchpoint.sizing.stage_forms import tooth_loss
from pitchpoint.sizing.strain_wave import strain_wave_sizes, why_no_size
from pitchpoint.sizing.task import SIZED_FAMILIES, Task

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


def test_ratios_of_strain_wave_gears_are_as_near_as_is_asked():
    near = Task.read(**(TASK | {"ratio": 100.3, "ratio_tolerance": 0.0003}))
    assert strain_wave_sizes(near, 100.3) == []
    assert why_no_size(near, 100.3) == "a ratio of 100.5 is the nearest one"
    assert strain_wave_sizes(
        Task.read(**(TASK | {"ratio": 100.5, "ratio_tolerance": 0.0003})), 100.5
    )


def test_the_cup_of_a_strain_wave_gear_is_within_the_length_that_is_asked():
    with pytest.raises(InputError, match="and a cup of 30 mm length, more than is allowed"):
        size(**(TASK | {"ratio": 100}), families="strain wave", length="20 mm")


def test_an_oil_outside_of_its_range_is_told_as_such():
    with pytest.raises(
        InputError, match=r"^temperature: 300 degC is outside the range of pao-vg-150; allowed"
    ):
        size(**TASK, families="two stages", temperature="300 degC")


def test_cases_of_a_front_are_written_all_or_none(tmp_path, monkeypatch):
    numbers = dict.fromkeys(
        ("ratio", "mass", "loss", "diameter", "length", "backlash", "inertia"), 1.0
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
    told = "no teeth that can be made come within 3 % of that ratio"
    assert reach_words(task, "stepped planets") == told
    with pytest.raises(InputError) as caught:
        size(**TASK, families="one stage, planetary")
    assert str(caught.value) == (
        "no drive does this: one stage: reaches ratios of 1.25 to 8, 60 is asked; planetary: reaches ratios "
        "of 2.8 to 11, 60 is asked"
    )
