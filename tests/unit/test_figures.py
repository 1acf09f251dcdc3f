"""Numbers for figures: the shape of a ripple is kept, rounding is not shown, axes of constant values."""

import numpy as np
import pytest
import xarray as xr

from pitchpoint.results.rounding import difference
from pitchpoint.views.campbell import campbell
from pitchpoint.views.figures import (
    PALETTE,
    Choice,
    Figure,
    Key,
    Menu,
    Panel,
    continued,
    layout,
    rounded,
)


def drawn(y: list[float], **axis: object) -> dict[str, object]:
    trace = {"type": "scatter", "x": list(range(len(y))), "y": rounded(y)}
    found: dict[str, object] = Figure("f", "", [trace], layout("x", "y", yaxis=dict(axis))).layout
    return dict(found["yaxis"])  # type: ignore[call-overload]


def test_a_ripple_far_below_its_mean_is_no_staircase() -> None:
    ripple = 1e-6 * np.sin(np.linspace(0.0, 6.0, 500))
    values = 79.5 * (1.0 + ripple)
    found = np.array(rounded(values))
    assert np.max(np.abs(found - values)) < 1e-4 * np.ptp(values)
    assert np.unique(found).size > 450


def test_small_values_beside_large_ones_keep_their_digits() -> None:
    assert rounded([123456.789, 0.00123456789]) == [123460.0, 0.0012346]
    assert rounded([[1.0, 2.0], [np.nan, 1.0 / 3.0]]) == [[1.0, 2.0], [None, 0.33333]]


def test_rounding_is_shown_as_zero_or_as_one_value() -> None:
    assert rounded([1.0, 3e-17, -2e-14]) == [1.0, 0.0, 0.0]
    assert len(set(rounded(1.0 + 1e-16 * np.arange(-3.0, 4.0)))) == 1
    assert rounded([0.0, np.nan]) == [0.0, None]


def test_a_difference_that_rounding_has_left_is_zero() -> None:
    high, low = np.array([79.5 + 2e-14, 79.5 + 1e-9, 1.0, np.nan]), np.array([79.5, 79.5, 1.0, 0.0])
    found = difference(high, low)
    assert found[0] == found[2] == 0.0
    np.testing.assert_allclose(found[1], 1e-9, rtol=1e-4)
    assert np.isnan(found[3])


def test_axes_of_constant_and_of_zero_values() -> None:
    low, high = drawn([0.05, 0.05])["range"]  # type: ignore[misc]
    assert 0.04 < low < 0.05 < high < 0.06
    assert drawn([0.0, 0.0], rangemode="tozero")["range"] == [0.0, 1.0]
    assert drawn([4.0, 4.0], rangemode="nonnegative")["range"] == [0.0, 5.0]
    assert drawn([0.0, 0.0])["range"] == [-1.0, 1.0]
    assert "range" not in drawn([1.0, 1.1])
    assert "range" not in drawn([2.0, 2.0], type="log")
    assert drawn([2.0], range=[0.0, 9.0])["range"] == [0.0, 9.0]


def test_a_small_jump_is_not_drawn_as_a_line() -> None:
    x = np.array([0.0, 0.5, 0.5, 1.0])
    _, y = continued(x, 79.5 + 1e-6 * np.array([0.0, 1.0, 2.0, 3.0]))
    assert np.isnan(y).sum() == 1


def test_gaps_stay_when_points_are_left_out() -> None:
    x = np.linspace(0.0, 1.0, 1001)
    there, y = continued(x, np.where((x > 0.4) & (x < 0.403), np.nan, x), most=50)
    assert 50 < there.size < 60
    (gap,) = np.flatnonzero(np.isnan(y[:-1]) & np.isfinite(y[1:])) + 1
    assert there[gap] == pytest.approx(0.403)
    assert there[np.isnan(y)].min() == pytest.approx(0.401)


def test_a_level_line_says_so_beneath() -> None:
    level, sloped = ([{"x": [0.0, 1.0], "y": rounded(y)}] for y in ([0.05, 0.05 + 1e-17], [0, 1]))
    assert Figure("f", "", level, layout("x", "y"), "As given.").remarks == (
        "As given. The same throughout, but for rounding."
    )
    assert Figure("f", "", sloped, layout("x", "y"), "As given.").remarks == "As given."


def test_indices_of_symbols_are_set_low_on_axes() -> None:
    assert layout("x", "T_in [N m]")["yaxis"]["title"]["text"] == "T<sub>in</sub> [N m]"
    assert layout("gears, face_width", "Δθ_x")["xaxis"]["title"]["text"] == "gears, face_width"


def test_two_menus_count_through_all_choices() -> None:
    labels = [Menu("law", "ab"), Menu("at", "123")]
    choices = [Choice(f"{law}{at}", {}) for law in "ab" for at in "123"]
    panel = Panel("", [], choices=choices, menus=labels, at=4)
    selects = [(step, at) for _, step, at in panel.selects]
    assert selects == [(3, 1), (1, 1)]
    assert choices[sum(step * at for step, at in selects)].label == "b2"


def test_words_at_ends_of_lines_of_a_campbell_diagram_leave_each_other_room() -> None:
    data = xr.Dataset({"speed": ("speed", np.linspace(0.0, 600.0, 5))})
    orders = [(Key(str(order), PALETTE[0]), float(order)) for order in (1, 2, 3, 4, 100)]

    def words(most: float) -> list[str]:
        figure = campbell("it", data, orders, [], most, marked=True)
        assert len(figure.data) == len(orders)
        return [str(mark["text"]) for mark in figure.layout["annotations"]]

    assert words(18000.0) == ["1", "4", "100"]
    assert words(900.0) == ["1", "2", "3", "4", "100"]


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ([0.0, 1e8], "power"),
        ([0.002648, 0.00267], "power"),
        ([0.0, 6.4e-5], "power"),
        ([0.31155, 0.31255], "none"),
        ([0.0, 0.0035], "none"),
        ([0.0, 20000.0], "none"),
    ],
)
def test_numbers_of_many_digits_along_an_axis_have_a_power_of_ten(
    values: list[float], told: str
) -> None:
    line = {"type": "scatter", "x": [0.0, 1.0], "y": values}
    assert Figure("one", "One", [line], layout("x", "y")).layout["yaxis"]["exponentformat"] == told
