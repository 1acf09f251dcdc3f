"""Whatever the text, it is read exactly or refused politely, and soon."""

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from pitchpoint.units import UnitError, convert, kinds, parse, si_unit, units_of

PAIRS = [(kind, unit) for kind in kinds() for unit in units_of(kind)]


@pytest.fixture(scope="module", autouse=True)
def loaded_factors():
    """Load every factor first, so that deadlines time the reading alone."""
    for kind, unit in PAIRS:
        convert(1.0, unit, kind)


@given(pair=st.sampled_from(PAIRS), value=st.floats(1e-9, 1e9))
def test_display_undoes_parse(pair, value):
    kind, unit = pair
    back = convert(parse(f"{value!r} {unit}", kind), unit, kind)
    offset = 460.0 if kind == "temperature" else 0.0  # 0 degC is far from 0 K
    assert back == pytest.approx(value, rel=1e-14, abs=1e-14 * offset)


@given(pair=st.sampled_from(PAIRS), value=st.floats(1e-6, 1e6))
def test_parse_undoes_display(pair, value):
    kind, unit = pair
    offset = 460.0 if kind == "temperature" else 0.0
    again = parse(f"{convert(value, unit, kind)!r} {unit}", kind)
    assert again == pytest.approx(value, rel=1e-14, abs=1e-12 * offset)


@given(kind=st.sampled_from(kinds()), value=st.floats(0.0, 1e300))
def test_si_comes_back_to_the_last_bit(kind, value):
    assert parse(f"{value!r} {si_unit(kind)}", kind) == value


@given(pair=st.sampled_from(PAIRS), value=st.floats(1e-6, 1e6))
def test_spaces_do_not_matter(pair, value):
    kind, unit = pair
    assert parse(f"  {value!r}   {unit} ", kind) == parse(f"{value!r} {unit}", kind)


junk = st.one_of(
    st.text(max_size=200),
    st.text(alphabet="0123456789+-.eE*^/()_, mskgNPadegCrp%°µ²", max_size=80),
    st.floats(),
    st.integers(),
    st.booleans(),
    st.none(),
    st.lists(st.text(max_size=3), max_size=3),
)


@settings(deadline=200, max_examples=500)
@given(text=junk, kind=st.sampled_from(kinds()))
@example(text="9" * 64, kind="length")
@example(text="1e" + "9" * 60 + " mm", kind="length")
@example(text="(" * 64, kind="density slope")
@example(text="1 " + "m**" * 20, kind="length")
@example(text="0 mm/" + "/ " * 28, kind="length")
@example(text=10**6000, kind="dimensionless")
@example(text="\ud800", kind="length")
def test_junk_gives_a_finite_number_or_a_unit_error(text, kind):
    try:
        value = parse(text, kind)
    except UnitError as error:
        assert len(str(error)) < 400
        assert str(error).isprintable()
    else:
        assert abs(value) < float("inf")
