"""Units of results by choice: what may be chosen, for which quantities, and where it holds."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from pitchpoint import units
from pitchpoint.errors import InputError
from pitchpoint.results.chosen_units import choosable, shown_in, unit_choice, unit_in_use
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import VARIABLES
from pitchpoint.views import show
from pitchpoint.views.figures import display, short_axis
from pitchpoint.views.screen import head, screen_value

WRONG = [
    ("angel=arcmin", '"angel" is no kind of quantity with units; did you mean angle'),
    ("speed=rpm", "known are rotational speed"),
    (
        "stiffness=N m/arcmin",
        "is a unit of a torsional stiffness, not of a stiffness; use one of N/m",
    ),
    ("count=%", "no kind of quantity with units; known are length, angle"),
    ("angle=arcmn", '"arcmn" is not a unit of an angle; use one of rad, deg'),
    ("angle=arcmn", '(did you mean "arcmin"?)'),
    ("torque=arcmin", '"arcmin" is a unit of an angle, not of a torque; use one of N m, kN m'),
    ("torque=N cm, Torque=N m", "the unit of torque was given twice"),
    ("arcmin", '"arcmin" is not KIND=UNIT, for example angle=arcmin'),
    ("angle=arcmin,", "is not KIND=UNIT"),
    ({"angle": 3}, "3 was given where a unit of angle belongs"),
    (3, "3 was given where units by kind of quantity belong"),
]


@pytest.mark.parametrize(("given", "words"), WRONG)
def test_a_wrong_choice_gets_a_sentence_with_neighbours(given: Any, words: str) -> None:
    with pytest.raises(InputError) as caught:
        unit_choice(given)
    assert words in str(caught.value)


def test_kinds_and_units_are_found_however_they_are_spelled() -> None:
    text = "Torsional_Stiffness = N*m/arcmin, small-angle=urad,power=mW"
    assert unit_choice(text) == {
        "torsional stiffness": "N m/arcmin",
        "small angle": "urad",
        "power": "mW",
    }
    assert unit_choice({}) == {}


def test_every_unit_of_every_kind_can_be_chosen() -> None:
    for kind in choosable():
        for unit in units.units_of(kind.removeprefix("small ")):
            assert unit_choice({kind: unit}) == {kind: unit}


def test_every_variable_is_shown_in_a_unit_of_its_kind() -> None:
    for known in VARIABLES.values():
        for one in filter(None, (known, known.travel)):
            assert units.spelled(one.usual, one.kind) == one.usual


def test_a_unit_is_for_quantities_of_its_size() -> None:
    error, whole = VARIABLES["kinematic_error"], VARIABLES["turn_angle"]
    with shown_in(unit_choice("angle=arcmin")):
        assert (error.display, whole.display) == ("arcmin", "deg")
    with shown_in(unit_choice("angle=rad")):
        assert (error.display, whole.display) == ("arcsec", "rad")
    with shown_in(unit_choice("angle=arcmin, small angle=deg")):
        assert (error.display, whole.display) == ("deg", "deg")
    with shown_in(unit_choice("length=in")):
        assert VARIABLES["film_thickness"].display == "um"
        assert VARIABLES["centre_distance"].display == "in"


def test_numbers_and_their_units_change_together() -> None:
    stiffness = 88.4e3
    assert show.quantity("torsional_stiffness", stiffness) == "88.4 kN m/rad"
    with shown_in({"torsional stiffness": "N m/arcmin", "temperature": "K"}):
        assert show.quantity("torsional_stiffness", stiffness) == "25.71 N m/arcmin"
        assert (head("torsional_stiffness"), screen_value("torsional_stiffness", stiffness)) == (
            "torsional stiffness [N m/arcmin]",
            "25.71",
        )
        assert short_axis("torsional_stiffness") == "K [N m/arcmin]"
        assert display("torsional_stiffness", stiffness) == pytest.approx(stiffness * np.pi / 10800)
        assert show.quantity("temperature", 273.15) == "273.1 K"


def test_small_values_in_large_units_are_not_taken_for_rounding() -> None:
    """1e-10 m is a tenth of a nanometre; what is left of zero stays zero in every unit."""
    with shown_in({"small length": "m"}):
        assert screen_value("depth_per_turn", 1e-10) == "1e−10"
        assert screen_value("film_thickness", 1e-17) == "0"
    with shown_in({"small length": "nm"}):
        assert screen_value("film_thickness", 1e-17) == "0"


def test_a_choice_holds_within_its_block_and_thread_alone() -> None:
    with shown_in({"torque": "N cm"}):
        with ThreadPoolExecutor(1) as other:
            assert other.submit(unit_in_use, "torque", "N m").result() == "N m"
        with shown_in({}):
            assert unit_in_use("torque", "N m") == "N m"
        assert unit_in_use("torque", "N m") == "N cm"
        with pytest.raises(ZeroDivisionError), shown_in({"torque": "N mm"}):
            raise ZeroDivisionError
        assert unit_in_use("torque", "N m") == "N cm"
    assert unit_in_use("torque", "N m") == "N m"


@pytest.mark.parametrize(
    ("unit", "shown", "kind"),
    [
        ("v_s", "m/s", "velocity"),  # the symbol
        ("m/s", "v_s", "velocity"),
        ("mm", "mm", "length"),
        ("mm", "", "dimensionless"),
        ("W", "kW", "dimensionless"),
    ],
)
def test_a_variable_has_the_unit_of_its_kind(unit, shown, kind):
    with pytest.raises(
        ValueError, match=f"sliding: a quantity of kind '{kind}' has no unit '{unit}'"
    ):
        Variable(long_name="sliding", symbol="v_s", unit=unit, shown=shown, kind=kind)


def test_names_of_a_variable_are_not_taken_by_their_order():
    with pytest.raises(TypeError, match="positional"):
        Variable("sliding velocity", "v_s", "m/s")
