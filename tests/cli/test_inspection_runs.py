"""Inspection of a cylindrical pair as a case asks for it: dataset, section, screen, refusals."""

import json
from pathlib import Path

import numpy as np
import pytest
from sound import PAIR

from pitchpoint._jax import array
from pitchpoint.analyses.inspection import inspection_part
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.din_3967 import thickness_allowances
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views.section import Page, Paragraph, SectionTable
from pitchpoint.views.sections.inspection import INSPECTION as SECTION

EXAMPLES = Path(__file__).parents[2] / "examples"
TABLE = """[gears.inspection]
upper_thickness_allowance = ["-40 um", "-50 um"]
lower_thickness_allowance = ["-70 um", "-90 um"]
centre_distance_field = "js7"
ball_diameter = ["3.5 mm", "0.5 mm"]
iso_class = [6, 7]
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    def of(table: str, case: str = PAIR):
        path = tmp_path_factory.mktemp("inspection") / "pair.toml"
        path.write_text(case + table, "utf-8")
        return load_case(str(path))

    return of


@pytest.fixture(scope="module")
def plain(built):
    return built("")


@pytest.fixture(scope="module")
def asked(built):
    return built(TABLE)


@pytest.fixture(scope="module")
def data(asked):
    return inspection_part(asked)


def test_nominal_gears_stay_as_they_are(plain, asked, data) -> None:
    assert [float(plain.dimensions[name]) for name in ("centre_distance", "normal_backlash")] == [
        float(asked.dimensions[name]) for name in ("centre_distance", "normal_backlash")
    ]
    bare = inspection_part(plain)
    assert bare["case"].values.tolist() == ["nominal"]
    assert "flank_tolerance" not in bare
    for part in (bare, data):
        found = part["backlash_along_normal"].sel(case="nominal")
        assert float(found) == pytest.approx(float(plain.dimensions["normal_backlash"]), abs=1e-14)
    assert float(bare["span_measurement"].sel(gear="gear 1", limit="nominal")) == pytest.approx(
        float(data["span_measurement"].sel(gear="gear 1", limit="nominal"))
    )


def test_limits_of_backlash_are_those_of_thickness_and_distance(data) -> None:
    # js7 of 84 mm is half of 35 um; 2 tan(20 deg) of it on the pitch circles, as allowances are
    least, mean, most = data["backlash_on_circle"].values[1:]
    assert mean == pytest.approx(125e-6, rel=1e-3)
    assert (most - least) / 2.0 == pytest.approx(35e-6 + 2 * np.tan(np.pi / 9) * 17.5e-6, rel=2e-3)
    first = data["backlash_angle"].sel(gear="gear 1").values[1:]
    np.testing.assert_allclose(first * 23e-3, [least, mean, most], rtol=1e-3)


@pytest.mark.parametrize(
    ("diameter", "upper", "lower"),
    [
        (0.341183, -130.0, -190.0),
        (0.855, -175.0, -255.0),
        (0.765, -175.0, -255.0),
        (2.520, -430.0, -590.0),
    ],
)
def test_allowances_as_kisssoft_prints_them(diameter: float, upper: float, lower: float) -> None:
    """cd25 of four gears in @NREL_5MW/stage_01.rtf and stage_03.rtf of gfsReboucas/Drivetrain."""
    found = thickness_allowances(field="cd25", diameter=diameter)
    assert [1e6 * one for one in found] == pytest.approx([upper, lower])


def test_a_field_of_din_3967_goes_by_the_reference_circle(built) -> None:
    """46 mm and 122 mm, the numbers first as on drawings, or letters in capitals."""
    data = inspection_part(built('[gears.inspection]\nthickness_field = ["25cd", "C 24"]\n'))
    thickness = data["normal_thickness"].values
    allowances = 1e6 * (thickness[:, 1:] - thickness[:, :1])
    np.testing.assert_allclose(allowances, [[-54.0, -84.0], [-85.0, -110.0]], rtol=1e-9)
    assert data.sizes["case"] == 4


def test_discs_are_those_of_a_vibration(plain) -> None:
    found = inspection_part(plain)["disc_inertia"].values
    density = array([float(solid.density) for solid in plain.design.solids])
    np.testing.assert_allclose(
        found, np.asarray(plain_inertia(plain.design.mesh, density)), rtol=1e-12
    )


def test_balls_that_fall_in_are_told_and_not_measured(data) -> None:
    assert np.isnan(data["over_balls"].sel(gear="gear 2").values).all()
    assert data["over_balls"].sel(gear="gear 1").notnull().all()
    assert json.loads(data.attrs["unmeasured"]) == [
        "gear 2: balls of 0.5 mm do not touch its involutes."
    ]


def test_the_report_and_the_screen_show_it(asked, data) -> None:
    outcome = Outcome({}, {"inspection": data})
    blocks = [*SECTION.blocks(Page({"default": outcome}, {}))]
    tables = {one.head[0]: one for one in blocks if isinstance(one, SectionTable)}
    assert [*tables] == ["backlash", "dimension", "tolerance by ISO 1328-1"]
    rows = {row[0]: row[1:] for one in tables.values() for row in one.rows}
    assert rows["measuring balls D_M [mm]"] == ("3.500", "0.500")
    assert rows["over balls, in a ring between them, M_d, thickest teeth [mm]"][1] == "–"
    assert {"single pitch f_pT [µm]", "profile form f_fαT [µm]"} <= {*rows}
    assert tables["tolerance by ISO 1328-1"].head[1:] == ["gear 1, class 6", "gear 2, class 7"]
    words = " ".join(str(one.words) for one in blocks if isinstance(one, Paragraph))
    assert "come on top" in words
    assert "0.5 mm do not touch" in words
    (backlash,) = SECTION.answer(outcome)
    assert backlash.name == "Backlash by tolerances"
    assert " to " in backlash.value and backlash.detail.endswith("arcmin at gear 2")
    (printed,) = SECTION.screen(outcome)
    assert [row["inspection"] for row in printed.rows] == ["gear 1", "gear 2"]
    assert " to " in printed.rows[0]["span measurement [mm]"]


def test_the_screen_keeps_silent_where_nobody_asked(plain) -> None:
    outcome = Outcome({}, {"inspection": inspection_part(plain)})
    assert [*SECTION.screen(outcome)] == []
    (backlash,) = SECTION.answer(outcome)
    assert backlash.detail.startswith("nominal, ")


def test_balls_stand_out_of_deep_spaces() -> None:
    """Tall tips hide a ball that touches in the middle of the flank; a larger one is taken."""
    data = inspection_part(load_case(str(EXAMPLES / "pair_23_61_high_contact_ratio.toml")))
    assert json.loads(data.attrs["unmeasured"]) == []
    assert data["over_balls"].notnull().all()


def test_teeth_that_can_jam_are_told(built) -> None:
    table = """[gears.inspection]
    upper_thickness_allowance = "0 um"
    lower_thickness_allowance = "-20 um"
    centre_distance_deviation = "30 um"
    """
    (told,) = json.loads(inspection_part(built(table)).attrs["warnings"])
    assert told.startswith("The least backlash by tolerances is -")
    assert "jam" in told


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ('upper_thickness_allowance = "-40 um"', "given without lower_thickness_allowance"),
        (
            'upper_thickness_allowance = "-40 um"\nlower_thickness_allowance = "-20 um"',
            "of gear 1 is above its upper allowance",
        ),
        ('centre_distance_field = "h7"', "known symmetrical tolerance field"),
        ('thickness_field = "cd35"', "not a known tolerance field of the tooth thickness"),
        ('thickness_field = ["cd25"]', "has 1 value; give one for both gears"),
        (
            'thickness_field = "cd25"\nupper_thickness_allowance = "-40 um"\n'
            'lower_thickness_allowance = "-60 um"',
            "were both given; give one",
        ),
        (
            'centre_distance_field = "js7"\ncentre_distance_deviation = "10 um"',
            "were both given; give one",
        ),
        (
            'upper_thickness_allowance = "0 um"\nlower_thickness_allowance = "-2 mm"',
            "more than a tooth allows",
        ),
    ],
)
def test_bad_tables_are_refused(built, table, told) -> None:
    with pytest.raises(InputError, match=told) as caught:
        built(f"[gears.inspection]\n{table}\n")
    assert "inspection" in str(caught.value)


def test_a_distance_without_a_field_is_refused(built) -> None:
    large = PAIR.replace('"2 mm"', '"20 mm"')
    with pytest.raises(InputError, match="840 mm is longer than 500 mm"):
        built('[gears.inspection]\ncentre_distance_field = "js7"\n', large)
