"""A torus-involute pair from its case file: its contacts, what is told of them, and refusals."""

import json
import tomllib
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
import xarray as xr

from pitchpoint.analyses.analysis import Unasked
from pitchpoint.analyses.analysis_registry import TORSION
from pitchpoint.analyses.cycle import CYCLE
from pitchpoint.cases.variant import Variant
from pitchpoint.contact.ellipse import hamrock_brewe_1983
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.gears.families import sample_of
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.runs.run import Outcome
from pitchpoint.views.sections.answer import teeth_rows

SAMPLE = tomllib.loads(Path(sample_of(TorusGears)).read_text("utf-8"))
EXAMPLE = Path(__file__).parents[2] / "examples" / "torus.toml"


def cycle(tree: dict[str, Any], **changes: dict[str, Any]) -> xr.Dataset:
    """The mesh cycle of the sample, or of a case with its tables changed."""
    given = {
        key: {**tree.get(key, {}), **changes.get(key, {})}
        for key in {**tree, **changes}
        if key != "title"
    }
    built = Variant(given, "torus.toml", "default").built({})
    return CYCLE.compute(built, None, lambda _: None)


@pytest.mark.whole
def test_contacts_are_ellipses_of_their_load() -> None:
    data = cycle(SAMPLE, models={"elliptic_contact": "hamrock_brewe_1983"})
    load, radius = (data[name].values[0, :, 0, 0] for name in ("load", "radius"))
    carries = load > 0.0
    found = hamrock_brewe_1983(
        load=load[carries],
        radius=radius[carries],
        transverse_radius=0.28141617,
        modulus=206e9 / 0.91,
    )
    for name, values in (("pressure", found.pressure), ("semi_axis_across", found.across)):
        np.testing.assert_allclose(data[name].values[0, carries, 0, 0], values, rtol=1e-6)
    assert json.loads(data.attrs["solve"])["code"] == Code.SOLVED


@pytest.mark.whole
def test_an_ellipse_longer_than_its_room_is_told_with_both_lengths() -> None:
    data = cycle(
        SAMPLE,
        gears={"inclination": "17 mrad", "centre_distance": "111.5 mm"},
        operation={"torque": "245 N m"},
    )
    longest = float(data["semi_axis_across"].max())
    assert float(data["contact_room"][0, 0]) < longest
    (told,) = (
        text
        for text in json.loads(data.attrs["warnings"])
        if "to each side across the face" in text
    )
    assert f"{1e3 * longest:.3g} mm" in told
    assert f"{1e3 * float(data['contact_room'][0, 0]):.3g} mm" in told
    assert json.loads(data.attrs["solve"])["code"] == Code.BEYOND_FACE
    assert float(data["largest_inclination"].min()) < 17e-3


@pytest.mark.whole
def test_the_inclination_is_largest_where_the_contact_reaches_the_end() -> None:
    """Near (b/2 - a)/R_y: 19 mrad for a semi-axis of 2 mm on a face of 15 mm."""
    data = cycle(SAMPLE)
    longest = data["semi_axis_across"].values[0].max(axis=(1, 2))
    place = 7.5e-3 - longest
    arcs = place / np.sqrt(35e-3**2 - place**2) - place / np.sqrt(55e-3**2 - place**2)
    expected = np.sin(np.radians(20.0)) * arcs
    np.testing.assert_allclose(data["largest_inclination"].values[0], expected, rtol=1e-12)
    np.testing.assert_allclose(expected, place / 0.28141617, rtol=0.04)


@pytest.mark.parametrize(
    ("tree", "models", "told"),
    [
        (SAMPLE, {"film_thickness": "dowson_higginson_1959"}, "holds for line contacts"),
        (SAMPLE, {"rolling_resistance": "wu_cheng_1991"}, "holds for line contacts"),
        (SAMPLE, {"load_sharing": "sanchez_2017"}, "holds for line contacts"),
        (SAMPLE, {"friction": "iso_tr_14179_2"}, "touch in an ellipse"),
    ],
)
def test_laws_of_lines_are_refused(tree: dict[str, Any], models: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        cycle(tree, models=models)


def test_an_elliptic_contact_is_no_choice_for_lines() -> None:
    spur = {
        **SAMPLE,
        "gears": {"teeth": [18, 36], "module": "3 mm", "face_width": "20 mm"},
        "models": {"elliptic_contact": "hamrock_brewe_1983"},
    }
    with pytest.raises(InputError, match="these gears touch along lines") as error:
        cycle(spur)
    assert error.value.key == "models.elliptic_contact"


@pytest.mark.whole
def test_the_answer_says_how_large_the_ellipse_is_and_what_tilt_it_bears() -> None:
    data = cycle(SAMPLE)
    outcome = Mock(spec=Outcome)
    outcome.parts = {"operation": data, "cycle": data}
    (row,) = teeth_rows(outcome)
    longest = 1e3 * float(data["semi_axis_across"].max())
    assert row["semi-axes of the contact, across and along"].startswith(f"{longest:.2f}"[:3])
    assert row["room to the end of the face"].endswith("mm")
    assert "rad" in row["largest inclination"]


def test_another_sharing_says_that_wind_up_is_left_out() -> None:
    tree = {**SAMPLE, "models": {"load_sharing": "equal"}}
    given = {key: value for key, value in tree.items() if key not in ("title", "dynamics")}
    given["gears"] = {key: value for key, value in tree["gears"].items() if key != "deviations"}
    built = Variant(given, "torus.toml", "default").built({})
    told = TORSION.why_not(built)
    assert not isinstance(told, Unasked)
    assert told == (
        'load_sharing = "equal" leaves out how teeth yield; "from_stiffness", the usual one of these gears, '
        "tells how far they wind up"
    )


def test_the_shipped_example_is_short() -> None:
    assert len(EXAMPLE.read_text("utf-8").splitlines()) <= 20
