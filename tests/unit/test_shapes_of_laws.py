"""Laws hold for one shape of contact, and say so where they are asked about another."""

import equinox as eqx
import numpy as np
import pytest
from bare_contacts import conditions

from pitchpoint._jax import array, jax
from pitchpoint.cases.laws import FRICTION
from pitchpoint.contact.ellipse import hertz_1881
from pitchpoint.errors import InputError
from pitchpoint.lubrication.conditions import evaluate, law_arguments, shape_of
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS, ROLLING_RESISTANCE

LAWS = (*FRICTION.values(), *FILM_THICKNESS.values(), *ROLLING_RESISTANCE.values())
LINES = {"line_load", "half_width", "reference_line_load"}
ELLIPSES = {"load", "transverse_radius"}


def test_what_a_law_states_fits_what_it_asks_for():
    for law in LAWS:
        asked = set(law_arguments(law.function)[0])
        assert shape_of(law) != "line" or not asked & ELLIPSES, law.name
        assert shape_of(law) != "ellipse" or not asked & LINES, law.name
        assert shape_of(law) is not None or not asked & (LINES | ELLIPSES), law.name


def test_shapes_of_the_library():
    assert {law.name: shape_of(law) for law in LAWS if not law.name.startswith("tian")} == {
        "constant": None,
        "frictionless": None,
        "iso_tr_14179_2": "line",
        "xu_2007": None,
        "ehl_line": "line",
        "dowson_higginson_1959": "line",
        "dowson_1968": "line",
        "dowson_toyoda_1979": "line",
        "pan_hamrock_1989": "line",
        "pan_hamrock_1989_central": "line",
        "moes_1992": "line",
        "hamrock_dowson_1977": "ellipse",
        "hamrock_dowson_1977_central": "ellipse",
        "none": None,
        "wu_cheng_1991": "line",
        "wu_cheng_1991_strips": "ellipse",
    }


@pytest.mark.parametrize(
    ("law", "shape", "told"),
    [
        (
            FILM_THICKNESS["dowson_higginson_1959"],
            "ellipse",
            "'dowson_higginson_1959' holds for line contacts, and these touch in an ellipse; choose one "
            "of hamrock_dowson_1977, hamrock_dowson_1977_central",
        ),
        (
            FILM_THICKNESS["hamrock_dowson_1977"],
            "line",
            "'hamrock_dowson_1977' holds for elliptic contacts, and these touch along lines; choose one "
            "of dowson_higginson_1959, dowson_1968, dowson_toyoda_1979, pan_hamrock_1989, "
            "pan_hamrock_1989_central, moes_1992",
        ),
        (
            FILM_THICKNESS["dowson_higginson_1959"].function,
            "ellipse",
            "'dowson_higginson_1959' holds for line contacts, and these touch in an ellipse",
        ),
        (
            FRICTION["iso_tr_14179_2"],
            "ellipse",
            "'iso_tr_14179_2' holds for line contacts, and these touch in an ellipse; choose one of "
            "constant, frictionless, xu_2007",
        ),
        (
            ROLLING_RESISTANCE["wu_cheng_1991"],
            "ellipse",
            "'wu_cheng_1991' holds for line contacts, and these touch in an ellipse; choose one of none, "
            "wu_cheng_1991_strips",
        ),
    ],
    ids=["film of a line", "film of an ellipse", "function alone", "friction", "rolling"],
)
def test_a_law_of_another_shape_is_refused(law, shape, told):
    with pytest.raises(InputError) as error:
        evaluate(law, conditions(shape))
    assert str(error.value) == told


def test_a_law_of_ones_own_that_asks_for_the_load_of_an_ellipse_is_refused_on_a_line():
    def my_law(*, load):
        return 0.01 * load

    with pytest.raises(
        InputError, match="'my_law' holds for elliptic contacts, and these touch along"
    ):
        evaluate(my_law, conditions("line"))
    assert float(evaluate(my_law, conditions("ellipse"))[0, 0]) == pytest.approx(0.5, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "shape", "told"),
    [
        (
            "line_load",
            "ellipse",
            "line contacts have a load per length, and these touch in an ellipse",
        ),
        ("half_width", "ellipse", "line contacts have a half-width, and these touch in an ellipse"),
        (
            "transverse_radius",
            "line",
            "elliptic contacts have a radius across the rolling direction, and these touch along lines",
        ),
    ],
)
def test_what_a_contact_does_not_have_is_no_number(name, shape, told):
    with pytest.raises(InputError) as error:
        getattr(conditions(shape), name)
    assert str(error.value) == told


def test_pressure_takes_the_form_of_the_shape():
    pressure = eqx.filter_jit(lambda at: at.pressure[0, 0])
    line, ellipse = (float(pressure(conditions(shape))) for shape in ("line", "ellipse"))
    assert line == pytest.approx(np.sqrt(50.0 * 226e9 / (2.0 * np.pi * 9.525e-3)), rel=1e-14)
    of_circle = np.cbrt(6.0 * 50.0 * (226e9 / 2.0) ** 2 / (np.pi**3 * 9.525e-3**2))
    assert ellipse == pytest.approx(of_circle, rel=1e-14)
    given = {"load": 50.0, "radius": 9.525e-3, "transverse_radius": 9.525e-3, "modulus": 226e9}
    alone = jax.jit(lambda given: hertz_1881(**given).pressure)(
        {k: array(v) for k, v in given.items()}
    )
    assert ellipse == pytest.approx(float(alone), rel=1e-15)


def test_a_refusal_comes_out_of_a_compiled_program_too():
    law = FILM_THICKNESS["dowson_higginson_1959"]
    with pytest.raises(InputError, match="holds for line contacts"):
        eqx.filter_eval_shape(lambda at: evaluate(law, at), conditions("ellipse"))
    assert eqx.filter_eval_shape(lambda at: evaluate(law, at), conditions("line")).shape == (1, 1)
