"""Steps of derivatives by numbers that are small in SI or zero, and arguments that are of another kind."""

import math
import tomllib
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import pytest
import sound

import pitchpoint as pp
from pitchpoint.notebook.differences import CaseNumber, continuous

PAIR = pp.Case(tomllib.loads(sound.PAIR))


@pytest.mark.whole
@pytest.mark.parametrize(
    ("key", "value", "power"),
    [("lubricant.pressure_viscosity", "2e-8 1/Pa", 0.6), ("roughness.ra", "0.08 um", -1.0)],
)
def test_numbers_that_are_small_in_si_have_derivatives(key: str, value: str, power: float) -> None:
    """By powers: films of Dowson and Higginson go as the coefficient to 0.6, lambda as 1 over Ra of both."""
    table = pp.gradients(PAIR.set({key: value}), "min_lambda_ratio", [key])
    slopes = table.derivative * table.value / table.attrs["value"]
    assert slopes.sum() == pytest.approx(power, rel=1e-4)


@pytest.mark.parametrize(
    ("key", "value", "step"),
    [
        ("lubricant.pressure_viscosity", 2e-8, 2e-12),
        ("roughness.ra.1", 0.0, 1e-10),
        ("gears.profile_shift.1", -1e-17, 1e-4),
        ("gears.helix_angle", 0.0, 1e-4 * math.pi / 180.0),
        ("operation.temperature", 300.0, 0.03),
    ],
)
def test_a_step_is_relative_and_of_the_unit_for_zero(key: str, value: float, step: float) -> None:
    quantity = continuous(key)
    assert quantity is not None
    assert CaseNumber(key, value, quantity, Mock()).step == pytest.approx(step, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: pp.gradients(PAIR, of=5), "of: 5 was given where the name of a figure"),
        (lambda: pp.gradients(PAIR, of=["mean_loss"]), "of: the list "),
        (lambda: pp.gradients(PAIR, by=5), "by: 5 was given where a key or a list of keys"),
        (lambda: pp.gradients(PAIR, law=3), "law: 3 was given where the name of a friction law"),
        (lambda: pp.write_report(5, "x.html"), "5 was given; a report is of what `run`"),
        (lambda: pp.write_report({}, "x.html"), "the table {  } was given; a report is of what"),
        (lambda: pp.write_report({}, 5), "path: 5 was given where the name of a file"),
    ],
)
def test_arguments_of_another_kind_are_refused_in_a_sentence(
    call: Callable[[], Any], words: str
) -> None:
    with pytest.raises(pp.InputError) as caught:
        call()
    assert str(caught.value).startswith(words)
