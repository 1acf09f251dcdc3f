"""Liu and Xiong: a torus-involute pair beside a standard pair, Tables 4 to 7 and section 4.

The paper leaves out most inputs of its motion; the case has a set that reproduces its tables. Rows of
the kind "reference" come from an independent calculation with that set. The corrected contact is compared
with closed forms of the same calculation.
"""

from functools import cache
from unittest.mock import Mock

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk
from torus_in_print import NAME, TREE, case, driven, points, read

from pitchpoint.analyses.comparison import compare
from pitchpoint.analyses.studies import readings_of
from pitchpoint.cases.document import leaves, resolve
from pitchpoint.citations import citation_text
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.film_thickness import dowson_higginson_1959, hamrock_dowson_1977
from pitchpoint.lubrication.friction_coefficient import xu_2007
from pitchpoint.lubrication.rolling_resistance import wu_cheng_1991
from pitchpoint.published.liu_xiong_torus import printed
from pitchpoint.published.publication_registry import PUBLICATIONS
from pitchpoint.results.target_rows import counts
from pitchpoint.runs.run import Outcome, compare_case
from pitchpoint.views.section import Page
from pitchpoint.views.section_registry import FORMULAS

FORMULAS_BESIDE = PUBLICATIONS[TREE["source"]].beside[0]
VARIANTS = ("as_published", "physical", "hertz", "standard")


@cache
def rows(variant):
    return compare_case(NAME, variant)[2]


def compared(study, variant="as_published", data=None, **changes):
    """Rows on the readings of a study, or on others in their place."""
    targets = [
        one for one in case(variant).targets if one.study == study and one.kind != "excluded"
    ]
    targets = [one for one in targets if one.variable != "mean_efficiency"]
    data = read(study, variant, **changes) if data is None else data
    return compare(targets, {f"study_{study}": data})


def missed(study, variant="as_published", data=None, **changes):
    """Rows on the readings of a study that miss though no cause is known."""
    found = compared(study, variant, data, **changes)
    return {row.quantity for row in found if row.verdict == "miss" and not row.expected_miss}


# ------------------------------------------------------------------ the comparison


@pytest.mark.whole
def test_rows_of_the_paper_are_counted_for_each_kind():
    assert {kind: dict(found) for kind, found in counts(rows("as_published")).items()} == {
        "predicted": {"miss": 22},
        "fitted": {"pass": 75, "miss": 23},
        "calibrated": {"pass": 3, "miss": 3},
        "definition": {"pass": 3},
        "trend": {"pass": 45},
        "reference": {"pass": 36},
    }


@pytest.mark.whole
def test_rows_miss_where_a_cause_is_known_and_nowhere_else():
    for variant in ("as_published", "hertz"):
        found = rows(variant)
        assert [row.quantity for row in found if row.expected_miss != (row.verdict == "miss")] == []
        assert all(len(row.reason) > 60 for row in found if row.verdict == "miss")


@pytest.mark.whole
def test_no_row_of_the_standard_pair_misses():
    assert {kind: dict(each) for kind, each in counts(rows("standard")).items()} == {
        "reference": {"pass": 12}
    }


@pytest.mark.whole
@pytest.mark.parametrize("study", ["light", "heavy", "tilted"])
def test_no_row_of_the_corrected_contact_misses(study):
    assert missed(study, "physical") == set()


@pytest.mark.whole
def test_rows_of_the_corrected_motion_miss_where_flanks_would_pull():
    """At 300 rad/s; all six conditions are a file of tests/long."""
    rows_of = {"study_steady_fast": read("steady_fast", "physical")}
    asked = [one for one in case("physical").targets if one.study == "steady_fast"]
    found = {row.quantity: row for row in compare(asked, rows_of)}
    missed_rows = [row for row in found.values() if row.verdict == "miss"]
    assert len(found) == 2 * 18
    assert [row.quantity for row in missed_rows] == [
        f"#5 {pair}, steady state, part of the time in which flanks pull"
        for pair in ("torus", "standard")
    ]
    assert all(len(row.reason) > 40 for row in missed_rows)
    left = [row.computed for told, row in found.items() if "not accounted for" in told]
    assert 0.0 < max(left) < 1e-9


def test_no_printed_number_is_forgotten():
    kinds = ("fitted", "predicted", "definition", "excluded")
    told = [one for one in case().targets if one.kind in kinds]
    tables = [one.where for one in told]
    assert {table: tables.count(table) for table in dict.fromkeys(tables)} == {
        "Table 1": 20,
        "Table 4": 24,
        "Table 5": 12 + 6,  # and what the torus pair has less the standard pair
        "Table 6": 12 + 6,
        "Table 7": 24 + 10,  # and ratios of its rows
        "section 4": 2,
        "section 4, Figure 9": 1,
        "section 5.1": 6,  # errors of the torus pair over those of the standard pair
    }


LOSSLESS = {
    **{f"{pair}_sliding_friction": 0.0 for pair in ("torus", "standard")},
    **{f"{pair}_printed_efficiency": 1.0 for pair in ("torus", "standard")},
    "torus_less_standard_friction": 0.0,
    "torus_less_standard_efficiency": 0.0,
    "torus_less_standard_sliding_efficiency": 0.0,
}


@pytest.mark.whole
@pytest.mark.parametrize(("study", "count"), [("light", 3 * 6 + 4), ("heavy", 3 * 6 + 4 + 6)])
def test_a_lossless_gear_misses_every_row_on_friction_and_efficiency(study, count):
    lossless = read(study)
    lossless = lossless.assign({name: 0.0 * lossless[name] + v for name, v in LOSSLESS.items()})
    aims = {one.quantity: one for one in case().targets if one.study == study}
    found = {
        row.quantity: row.verdict
        for row in compared(study, data=lossless)
        if aims[row.quantity].variable in LOSSLESS
    }
    assert len(found) == count
    assert set(found.values()) == {"miss"}


def test_a_torus_pair_that_is_a_standard_pair_misses_the_differences():
    """Friction and efficiency of the one put in the place of the other's."""
    same = read("heavy")
    same["torus_less_standard_friction"] = 0.0 * same["torus_less_standard_friction"]
    same["torus_sliding_friction"] = same["standard_sliding_friction"]
    told = missed("heavy", data=same)
    assert told >= {f"#{n}, sliding friction, torus pair below standard pair" for n in (2, 4, 6)}
    assert told >= {"#6, sliding friction, torus less standard pair"}
    assert told >= {f"#{n} torus, sliding friction" for n in (2, 6)}


@pytest.mark.whole
@pytest.mark.parametrize(
    ("change", "names"),
    [
        ({"formulas.bearing_stiffness": "2299.5 N/um"}, {"#6 torus, largest transmission error"}),
        ({"gears.torus_radius": ["35.35 mm", "55 mm"]}, {"#4 torus, least transmission error"}),
        ({"formulas.radius_factor": 1.7}, {"#2 torus, film of pair 0"}),
        ({"formulas.error": "11 um"}, {"#2 standard, largest transmission error"}),
    ],
    ids=["bearings 5 % stiffer", "torus radius 1 % larger", "effective radius", "error"],
)
def test_other_inputs_make_rows_miss(change, names):
    assert names <= missed("heavy", **change)


@pytest.mark.whole
def test_a_wider_torus_lets_the_ellipse_leave_the_face_earlier():
    found = missed("tilted", "physical", **{"gears.torus_radius": ["35.35 mm", "55 mm"]})
    assert "limit of tilt, semi-axis of 2 mm, parabola" in found


def test_another_torus_radius_misses_the_geometry():
    assert "relative radius across the profile R_y" in missed(
        "light", **{"gears.torus_radius": ["35 mm", "55.55 mm"]}
    )


# ------------------------------------------------------------------ radii that act

TORUS = {"gears.torus_radius": ["45 mm", "57 mm"], "gears.torus_offset": ["5 mm", "118.25 mm"]}
"""Another torus with the same profiles in the middle of the face: R_y is 625 in place of 281 mm."""
CONDITION_3 = {"operation.speed": "100 rad/s", "operation.torque": "49 N m"}
OF_RADII = ("torus_largest_error", "torus_sliding_friction", "torus_printed_efficiency")


def changed_by_the_torus(variant):
    """By which part numbers of the torus pair, then of the standard pair, change under another torus."""
    names = [*OF_RADII, *(name.replace("torus", "standard") for name in OF_RADII)]
    (first,), (other,) = (
        points("validation", variant, **{**given, **CONDITION_3}) for given in ({}, TORUS)
    )
    before, after = (readings_of([one], 1) for one in (first, other))
    return {name: float(after[name][1].item() / before[name][1].item() - 1.0) for name in names}


@pytest.mark.whole
def test_torus_radii_act_on_error_friction_and_efficiency():
    found = changed_by_the_torus("hertz")
    error, friction, efficiency = (found[name] for name in OF_RADII)
    assert -0.3 < error < -0.05  # a flatter ellipse is stiffer
    assert -0.3 < friction < -0.05  # and pressed less
    assert abs(efficiency) > 1e-5
    # The standard pair has no torus.
    assert max(abs(found[name.replace("torus", "standard")]) for name in OF_RADII) < 1e-8


def test_torus_radii_do_not_act_as_published():
    """R' = c rho_1 and Table 1 do not know them."""
    assert max(map(abs, changed_by_the_torus("as_published").values())) < 1e-8


def test_stiffness_of_an_ellipse_on_rigid_teeth_is_below_the_table():
    """Why no model of teeth with this contact has the values of Table 1."""
    (built,) = points("stiffness")
    given, line = case().formulas, built.design.mesh.line
    roll, table = np.array(given.torus_roll), np.array(given.torus_stiffness)
    path = roll * float(line.base_radii[0] / line.base_pitch)
    place = float(line.limits[0]) + roll * float(line.base_radii[0])
    alone = (path > float(line.contact_ratio) - 1.0) & (path < 1.0)
    load = 100.0 / float(line.base_radii[1]) / np.where(alone, 1.0, 2.0)
    # Hertz's approach: sqrt(delta) in closed form needs integrals, here those of scipy.
    radius = place * (1.0 - place / float(line.tangent_length))
    stiffness = np.array(
        [
            hertz_by_scipy(f, r, float(built.design.mesh.transverse_radius))
            for f, r in zip(load, radius, strict=True)
        ]
    )
    on_path = path < float(line.contact_ratio)
    assert on_path.sum() == 19
    assert (table > stiffness)[on_path].sum() == 18
    found = read("stiffness").isel(point=0)
    kept = np.interp(roll[on_path], found["stiffness_roll"], found["torus_secant_stiffness"])
    assert np.all(kept < stiffness[on_path])


def hertz_by_scipy(load, along, across):
    """Secant of an elliptic contact of steel by its elliptic integrals [N/m]."""
    modulus = 206e9 / 0.91  # E' = E/(1 - nu^2)

    def missing(ratio):
        m = 1.0 - ratio**-2
        whole, second = ellipk(m), ellipe(m)
        return (ratio**2 * second - whole) / (whole - second) - across / along

    ratio = brentq(missing, 1.0 + 1e-6, 100.0)
    m = 1.0 - ratio**-2
    combined = 1.0 / (1.0 / along + 1.0 / across)
    semi = np.cbrt(6.0 * ratio**2 * ellipe(m) * load * combined / (np.pi * modulus))
    return np.pi * semi * modulus / (3.0 * ellipk(m))


def test_slope_of_the_library_is_that_of_its_deflection():
    """dF/d delta by differences of delta = F/k(F) over the torque."""
    low, middle, high = (
        read("stiffness", **{"operation.torque": f"{torque} N m"}).isel(point=0)
        for torque in (99.9, 100.0, 100.1)
    )
    for pair in ("torus", "standard"):
        torque = np.array([[99.9], [100.1]])
        deflection = torque / np.stack([one[f"{pair}_secant_stiffness"] for one in (low, high)])
        slope = 0.2 / (deflection[1] - deflection[0])
        np.testing.assert_allclose(middle[f"{pair}_slope_stiffness"], slope, rtol=1e-5)
        assert np.all(middle[f"{pair}_slope_stiffness"] > middle[f"{pair}_secant_stiffness"])


@pytest.mark.whole
@pytest.mark.parametrize("convex", [30.0, 33.0, 34.0, 35.5, 37.0, 38.5, 40.0, 45.0, 54.0])
def test_a_convex_radius_with_its_offset_kept_is_known_or_refused_in_one_sentence(convex):
    change = {"gears.torus_radius": [f"{convex} mm", "55 mm"]}
    try:
        (built,) = points("validation", **change)
    except InputError as error:
        assert error.key in ("gears.torus_offset", "gears.addendum")
        assert "gear 1" in str(error)
        return
    assert 33.0 <= convex <= 38.5
    for name, (_, values) in readings_of([built], 1).items():
        if np.size(values) == 1:
            assert np.isfinite(values).all(), name


# ------------------------------------------------------------------ formulas


def test_formulas_have_the_values_of_the_reference_calculation():
    oil = {"viscosity": 0.015, "entrainment": 2.0, "radius": 0.01}
    film = {**oil, "pressure_viscosity": 2.2e-8, "modulus": 206e9 / 0.91}
    mu = xu_2007(pressure=1e9, slide_roll_ratio=0.3, roughness_rq=0.5e-6, **oil)
    assert mu == pytest.approx(0.029574, rel=1e-4)
    slender = 0.01 * 9.0 ** (np.pi / 2.0)
    points = hamrock_dowson_1977(load=1000.0, transverse_radius=slender, **film)
    assert 1e6 * points == pytest.approx(0.19573, rel=1e-4)
    literal = {"line_load": 1000.0 / 0.01, **film}
    assert 1e6 * dowson_higginson_1959(**literal) == pytest.approx(0.23670, rel=1e-4)
    assert wu_cheng_1991(**literal) == pytest.approx(32.6024, rel=1e-5)


def test_stiffness_of_the_torus_pair_has_the_values_of_the_reference_calculation():
    given = case().formulas
    found = printed.pair_stiffness(roll=given.torus_roll, stiffness=given.torus_stiffness)
    roll = np.deg2rad([0.0, 0.5, 1.0, 2.0, 4.0, 7.0, 9.0, 12.0, 15.59])
    values = 1e-6 * np.polynomial.polynomial.polyval(roll, [0.0, *found])
    expected = [0.0, 37.96, 69.16, 114.41, 155.76, 159.83, 156.8, 162.42, 143.02]
    np.testing.assert_allclose(values, expected, atol=0.006)


def test_gears_are_solid_discs():
    drive, _ = driven("heavy", 2, "torus")
    np.testing.assert_allclose(drive.mass, [0.925, 1.850], atol=5e-4)
    np.testing.assert_allclose(drive.inertia, [1.156e-3, 3.471e-3], atol=5e-7)
    assert float(drive.joint_mass) == pytest.approx(0.3492, abs=5e-5)


# ------------------------------------------------------------------ the file


@pytest.mark.parametrize("variant", VARIANTS)
def test_inputs_carry_their_marks(variant):
    document = resolve(dict(TREE), name=NAME, variant=variant)
    tables = ("gears", "materials", "lubricant", "roughness", "operation", "models", "formulas")
    values = {key for table in tables for key, _ in leaves({table: document.tree[table]})}
    assert values - document.provenance.keys() == {"gears.family"}
    assert "Xiong" in citation_text(TREE["source"])


def test_fitted_inputs_are_called_so():
    marks = resolve(dict(TREE), name=NAME, variant="as_published").provenance
    fitted = {key for key, mark in marks.items() if mark.status == "fitted"}
    assert fitted >= {
        *(f"formulas.{name}" for name in ("bearing_stiffness", "bearing_damping", "mesh_damping")),
        *(f"formulas.{name}" for name in ("mesh_cycles", "radius_factor", "roughness")),
        "formulas.standard_scale",
        "lubricant.viscosity_40",
        "lubricant.pressure_viscosity",
    }
    assert all(marks[key].note or marks[key].where.startswith("Table") for key in fitted)


def test_report_sets_torus_beside_standard():
    outcome = Mock(spec=Outcome)
    outcome.manifest = {"source": TREE["source"]}
    title = case().studies["heavy"].title
    outcome.parts = {
        name: read("heavy").assign_attrs(read("heavy").attrs, title=title)
        for name in ("study_heavy", "study_again")
    }
    page = Page({"as_published": outcome}, {})
    assert FORMULAS.lacking(page) is None
    note, panel, heading, table = FORMULAS.blocks(page)  # points that were seen are not shown again
    assert "takes the effective radius" in note.words
    assert heading.words == title
    assert [one.rpartition(", ")[2] for one in table.head[1:]] == [
        "torus pair",
        "standard pair",
    ] * 3
    rows = {
        row[0]: np.array([float(cell.replace("\u2212", "-")) for cell in row[1:]])
        for row in table.rows
    }
    published, hertz = (
        next(row for told, row in rows.items() if told.startswith(begin)).reshape(3, 2)
        for begin in ("mean least film, pair 0", "film at the pitch point, with the radii of Hertz")
    )
    assert np.all(published[:, 0] > published[:, 1])
    assert np.all(hertz[:, 0] < hertz[:, 1])
    shown = [one.title.rpartition(" (")[2] for one in panel.figures if "(" in one.title]
    assert [one.partition(" of the publication")[0] for one in shown] == [
        "Table 1",
        *(f"Figure {number}" for number in (5, 7, 8, 9, 10)),
        "Figures 11 to 13",
        *(f"Figures 14{a} to 16{a}" for a in "ab"),
        "Figures 17 to 20",
        *(f"Figures 21{a} to 23{a}" for a in "ab"),
    ]
    places = dict.fromkeys(one.rpartition(", ")[0] for one in table.head[1:])
    assert [one.label for one in panel.choices] == [f"{title}: {place}" for place in places]
    error, speed = (
        next(one for one in panel.figures if one.title.startswith(begin))
        for begin in ("Dynamic transmission error", "Speed of the gear")
    )
    for trace, key in zip(error.data, error.keys, strict=True):
        assert trace["name"] == key.label
        assert trace["x"][-1] == pytest.approx(case().formulas.mesh_cycles)
        assert max(trace["y"]) == pytest.approx(published_error(rows, key.label), abs=0.5)
    assert np.mean(speed.data[0]["y"]) == pytest.approx(10.0 * 40.0 / 49.0, rel=0.2)
    later = panel.choices[2].changes[error.name][0]
    assert later["x"][0][-1] == error.data[0]["x"][-1]  # each keeps the places that can be seen
    assert len(later["x"][0]) == len(later["y"][0])
    assert later["y"][0] != error.data[0]["y"]


def published_error(rows, column):
    """Largest transmission error of a pair at the first point of the table [um]."""
    told = next(row for name, row in rows.items() if name.startswith("largest dynamic"))
    return told[["torus pair", "standard pair"].index(column)]


def test_report_tells_what_became_of_solves():
    status = {"torus": Code.SEPARATES, "standard": Code.UNRESOLVED}
    every = {
        name: (("law", "point"), np.array([[np.nan]]))
        for pair in FORMULAS_BESIDE.rows.values()
        for name in pair
    }
    every |= {
        f"{pair}_steady_status": (("law", "point"), np.array([[float(code)]]))
        for pair, code in status.items()
    }
    outcome = outcome_of({"steady": xr.Dataset(every, attrs={"title": "one point"})})
    _, *told, _, table = FORMULAS.blocks(Page({"physical": outcome}, {}))
    assert {cell for row in table.rows for cell in row[1:]} == {"not found"}
    assert [one.words for one in told] == [
        f"Steady state, torus pair at one point: {Code.SEPARATES.sentence}.",
        f"Steady state, standard pair at one point: {Code.UNRESOLVED.sentence}.",
    ]


def outcome_of(studies):
    """Finished variant with the rows of these studies, all numbers their own."""
    outcome = Mock(spec=Outcome)
    outcome.manifest = {"source": TREE["source"]}
    outcome.parts = {f"study_{name}": data for name, data in studies.items()}
    return outcome


def test_report_shows_a_point_once_where_most_is_told_of_it():
    names = {name for pair in FORMULAS_BESIDE.rows.values() for name in pair}
    published = {name for name in names if "_steady_" not in name}

    def study(title, values, told):
        every = {name: (("law", "point"), np.array([values])) for name in told}
        every["axis"] = (("point",), np.array(values))
        return xr.Dataset(every, attrs={"title": title, "sweep_key": "operation.speed"})

    first = outcome_of({"light": study("light", [1.0, 2.0], published)})
    second = outcome_of(
        {
            "light": study("light", [1.0, 2.0], published),
            "slow": study("slow", [2.0, 1.0], names),
            "other": study("other", [2.0, 3.0], published),
        }
    )
    blocks = [*FORMULAS.blocks(Page({"as_published": first, "physical": second}, {}))]
    _, slow, first_table, folded = blocks
    other, second_table = folded.inside
    assert [slow.words, other.words] == ["slow", "other"]
    more, fewer = len(first_table.rows), len(second_table.rows)
    assert more == fewer + 11


def test_report_of_another_source_has_no_such_section():
    outcome = Mock(spec=Outcome)
    outcome.manifest, outcome.parts = {"source": "xu_2021"}, {}
    assert FORMULAS.lacking(Page({"as_published": outcome}, {})) == ""


def test_summary_says_what_the_thicker_film_follows_from():
    assert "follows from its effective radius alone" in case().summary
