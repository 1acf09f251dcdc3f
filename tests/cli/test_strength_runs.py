"""Strength of pairs from their case files: balance with the reactions, what is said, what is refused."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rated_case import EXAMPLES, PAIR, RATED, SPEED, TORQUE, computed, strength_of

from pitchpoint.analyses.strength import STRENGTH as ANALYSIS
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.gears.families import sample_of
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import Outcome, open_outcomes, run_piece, uncomputed_manifests
from pitchpoint.views import show
from pitchpoint.views.report import report_page
from pitchpoint.views.sections.strength import STRENGTH, strength_rows


@pytest.mark.whole
def test_the_ring_of_a_planetary_set_has_the_root_that_its_cutter_leaves() -> None:
    """ISO 6336-3:2006 with z_0 = 25 and x_0 = 0 and 0.1, worked out apart from this program."""
    path = EXAMPLES / "planetary.toml"
    settings = {"strength.edition": "2006", "strength.dynamic_method": "B"}
    for shift, expected in ((0.0, 76.3249), (0.1, 73.5545)):
        settings |= {"gears.cutter_teeth": 25, "gears.cutter_profile_shift": shift}
        found = strength_of(path, settings)
        stress = found["nominal_root_stress"].values[1, 1]
        assert stress == pytest.approx(1e6 * expected, rel=1e-6)
    remarks = found.attrs["remarks"]
    assert "Stage 2: K_v by method B counts" in remarks and "with one planet and a ring" in remarks


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("strength")


@pytest.fixture(scope="module")
def outcome(folder: Path) -> Outcome:
    """A pair with a table, beside its operation, on disk."""
    setting = {"strength.transverse_load_factor": 1.1, "strength.life": "20000 h"}
    return computed(PAIR + RATED, folder / "default", "operation", "strength", **setting)


def test_forces_are_those_on_the_bearings(outcome: Outcome) -> None:
    rated, point = outcome.parts["strength"], outcome.parts["operation"]
    tangential, radial, axial = (
        rated[f"{name}_force"].values for name in ("tangential", "radial", "axial")
    )
    for gear in (1, 2):
        across = float(point[f"radial_reaction_{gear}"].values[0, 0])
        along = float(point[f"axial_reaction_{gear}"].values[0, 0])
        assert np.hypot(tangential, radial) == pytest.approx(across, rel=1e-10)
        assert abs(axial) == pytest.approx(abs(along), rel=1e-10)
    wheel = (
        61 / np.cos(np.radians(15.0)) * 1e-3
    )  # radius of the reference circle, the pitch circle too
    assert tangential == pytest.approx(TORQUE / wheel, rel=1e-12)


def test_the_record_repeats_the_rating(outcome: Outcome, folder: Path) -> None:
    again = run_piece(str(folder / "default" / "manifest.json"), {"analysis": "strength"})
    assert again is not None
    for name, variable in outcome.parts["strength"].data_vars.items():
        np.testing.assert_array_equal(again[name].values, variable.values, err_msg=str(name))
    rows = {f"{row['table']}.{row['key']}": row for row in outcome.manifest["inputs"]}
    assert rows["strength.treatment"]["value"] == ["case_hardened", "case_hardened"]
    assert rows["strength.life"]["value"] == 20000.0 * 3600.0
    assert rows["strength.transverse_load_factor"]["status"] == "set"
    keys = [source["key"] for source in outcome.manifest["sources"]]
    assert {"iso_6336_3_2019", "iacs_m56_2021", "iso_6336_5_2016"} <= set(keys)
    assert "vdi_2736_2_2014" not in keys


def test_what_is_assumed_stands_beside_the_safeties(outcome: Outcome, folder: Path) -> None:
    data = outcome.parts["strength"]
    (assumed,) = json.loads(data.attrs["assumed"])
    assert assumed.startswith("Assumed where [strength] says nothing: f_ZCa = 1.2")
    for given in ("K_A", "K_Hβ", "K_Hα", "K_v", "endless"):
        assert given not in assumed
    (printed,) = STRENGTH.screen(outcome)
    assert assumed in printed.line
    assert "method B" in printed.line
    (folder / "run.json").write_text(json.dumps({"case": "pair.toml", "variants": ["default"]}))
    page = report_page(open_outcomes(folder))
    assert "Strength of the teeth" in page
    assert "tooth form factor" in page


def test_the_first_screen_says_on_what_safeties_stand(outcome: Outcome) -> None:
    data = outcome.parts["strength"]
    flanks, roots = STRENGTH.answer(outcome)
    for figure, part in ((flanks, "flank"), (roots, "root")):
        at = int(np.argmin(data[f"{part}_safety"].values))
        safety, cycles = (
            show.number_text(float(data[f"{part}_{name}"][at])) for name in ("safety", "cycles")
        )
        assert figure.value == safety
        life = f"{cycles} load cycles (20000 h)"
        assert figure.detail == f"at gear {at + 1}; {life}, application factor 1.25"
    inputs = [row for row in outcome.manifest["inputs"] if row["key"] != "life"]
    endless = replace(outcome, manifest=outcome.manifest | {"inputs": inputs})
    (flanks, _) = STRENGTH.answer(endless)
    assert flanks.detail.endswith("; endless life, application factor 1.25")


def test_limits_without_a_material_that_has_them(tmp_path: Path) -> None:
    plain = PAIR.replace('gear_2 = "case-hardened-mq"', 'gear_2 = "steel"')
    outcome = computed(plain, None, "strength")
    first, second = strength_rows(outcome)
    safeties = [name for name in first if "safety" in name]
    assert len(safeties) == 2
    for name in safeties:
        assert float(first[name]) > 1.0
        assert second[name] == "–"
    assert all(row[name] != "–" for row in (first, second) for name in row if name not in safeties)
    (told,) = json.loads(outcome.parts["strength"].attrs["withheld"])
    assert told == (
        "No safety of gear 2 against pitting and breakage: 'steel' has no sigma_hlim and sigma_flim; name a "
        "material that has them, such as 'case-hardened-mq', or give them in [strength]."
    )
    kept = json.dumps(ANALYSIS.figures(outcome.parts))
    assert "NaN" not in kept


def test_a_table_of_limits_asks_for_the_treatment(tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    plain = PAIR.replace("case-hardened-mq", "steel") + '[strength]\nsigma_hlim = "1400 MPa"\n'
    path.write_text(plain)
    with pytest.raises(
        InputError, match=r"strength\.treatment: is missing: limits were given for gear 1"
    ):
        uncomputed_manifests(str(path))
    data = strength_of(path, {"strength.treatment": "case_hardened"})
    assert np.all(np.isfinite(data["flank_safety"]))
    assert np.all(np.isnan(data["root_safety"]))


@pytest.mark.parametrize("table", [RackAndPinionGears, TorusGears])
def test_gears_without_cylindrical_pairs_are_refused_with_a_sentence(table: Any) -> None:
    sample = str(sample_of(table))
    tree = tomllib.loads(Path(sample).read_text("utf-8"))
    built = Variant(tree, "sample.toml", "default").built({})
    assert ANALYSIS.lacks(built) == "ISO 6336 rates pairs of cylindrical gears, not these"
    with pytest.raises(
        InputError, match="strength: was given; ISO 6336 rates pairs of cylindrical"
    ):
        uncomputed_manifests(sample, settings={"strength.application_factor": 1.2})


def test_a_pinion_of_steel_and_a_wheel_of_plastic() -> None:
    path = EXAMPLES / "helical_few_teeth_plastic.toml"
    data = strength_of(path)
    assert "VDI 2736" in data.attrs["method"]
    assert np.all(np.isfinite(data["root_stress"]))
    doubts = json.loads(data.attrs["warnings"])
    assert any("contact ratio is 0.892: ISO 6336 and VDI 2736 rate" in text for text in doubts)
    told = json.loads(data.attrs["withheld"])
    assert any("'POM-H'" in text and "temperature and life" in text for text in told)
    limits = {
        "strength.sigma_hlim": ["1500 MPa", "40 MPa"],
        "strength.sigma_flim": ["500 MPa", "30 MPa"],
    }
    given = strength_of(path, {**limits, "strength.treatment": "case_hardened"})
    stress, safety = given["root_stress"].values, given["root_safety"].values
    assert safety[1] == pytest.approx(2.0 * 30e6 / stress[1], rel=1e-12)  # Y_St = 2
    assert json.loads(given.attrs["withheld"]) == []


def told(data: Any) -> list[str]:
    return [str(text) for text in json.loads(data.attrs["warnings"])]


@pytest.fixture(scope="module")
def pair_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("pair") / "pair.toml"
    path.write_text(PAIR + RATED)
    return path


def test_teeth_that_do_not_bear_their_stress_stand_first(pair_file: Path) -> None:
    fine = strength_of(pair_file, {"operation.torque": "200 N m"})
    assert told(fine) == []
    flanks = strength_of(pair_file, {"operation.torque": "500 N m", "strength.life": "9000 h"})
    first, second = told(flanks)
    stress, limit = flanks["contact_stress"].values / 1e6, flanks["contact_limit"].values / 1e6
    assert first == (
        f"Fails: the flanks of gear 1 have a stress of {stress[0]:.4g} MPa, of which {limit[0]:.4g} MPa are "
        f"permissible (safety {limit[0] / stress[0]:.3g}): they pit within the life that is asked."
    )
    assert second.startswith("Fails: the flanks of gear 2 have ")
    both = told(strength_of(pair_file, {"operation.torque": "9000 N m"}))
    assert {text.split(" have ")[0] for text in both} == {
        f"Fails: the {part} of gear {gear}" for gear in (1, 2) for part in ("flanks", "roots")
    }
    safeties = [float(text.split("(safety ")[1].split(")")[0]) for text in both]
    assert safeties == sorted(safeties)
    assert all(text.endswith("sooner or later.") for text in both)


def test_the_edition_is_chosen_by_name(pair_file: Path) -> None:
    """By hand: f_eps and the cube of the cosine in the root, the root of 1.2 by overlap in Z_B and Z_D."""
    newer = strength_of(pair_file)
    older = strength_of(pair_file, {"strength.edition": 2006})
    helix = np.radians(15.0)
    overlap = 20.0 * np.sin(helix) / (np.pi * 2.0)
    cosine = np.cos(np.arcsin(np.sin(helix) * np.cos(np.radians(20.0))))
    ratio = (newer["contact_ratio_factor"].values ** 2 - (1.0 - overlap) * 4.0 / 3.0) / 1.0
    # Z_eps^2 = (4 - e)/3 (1 - o) + o/e
    contact = np.roots([-(1.0 - overlap) / 3.0, -float(ratio), overlap]).max()
    share = np.sqrt(1.0 - overlap + overlap / (contact / cosine**2))
    np.testing.assert_allclose(newer["form_factor"] / older["form_factor"], share, rtol=1e-9)
    np.testing.assert_allclose(
        newer["root_helix_factor"] / older["root_helix_factor"], np.cos(helix) ** -3, rtol=1e-9
    )
    moved = newer["single_contact_factor"] - older["single_contact_factor"]
    np.testing.assert_allclose(moved, overlap * (np.sqrt(1.2) - 1.0), rtol=1e-9)
    assert "edition of 2006, method B" in older.attrs["method"]
    assert "f_ZCa" in newer.attrs["assumed"] and "f_ZCa" not in older.attrs["assumed"]


def test_the_pair_by_its_resonance_and_its_shaft(pair_file: Path) -> None:
    """K_v by method B and K_Hbeta by method C, all from the tolerances of class 6 by hand [um, N/mm]."""
    shaft = {"span": "120 mm", "offset": "20 mm", "diameter": "40 mm"}
    settings = {
        "strength.dynamic_method": "B",
        "strength.bearing_span": shaft["span"],
        "strength.pinion_offset": shaft["offset"],
        "strength.pinion_shaft_diameter": shaft["diameter"],
    }
    tree = tomllib.loads(pair_file.read_text("utf-8"))
    del tree["strength"]["face_load_factor"]
    variant = Variant(tree, "x.toml", "default", settings)
    (job,) = [job for job in jobs(variant, {}) if job.name == "strength"]
    data = job.compute(job.pieces[0])
    helix = np.radians(15.0)
    transverse = np.arctan(np.tan(np.radians(20.0)) / np.cos(helix))
    z_1, z_2 = (z / np.cos(helix) / np.cos(helix) ** 2 for z in (23.0, 61.0))
    base = np.cos(np.arcsin(np.sin(helix) * np.cos(np.radians(20.0)))) ** 2 / np.cos(helix) ** 2
    yielding = 0.04723 + 0.15551 / z_1 * base + 0.25791 / z_2 * base
    load = 1.25 * float(data["reference_force"]) / 20.0
    single = 0.8 * 0.975 * np.cos(helix) / yielding * (min(load, 100.0) / 100.0) ** 0.25
    pitch, profile = 8.5 * np.cos(transverse) * 0.925, 8.5 * 0.925  # run in by 0.075
    zone = np.cos(helix)  # beside it the contact ratios that the result has
    overlap = 20.0 * np.sin(helix) / (np.pi * 2.0)
    e = np.roots(
        [
            -(1.0 - overlap) / 3.0,
            (1.0 - overlap) * 4.0 / 3.0 - float(data["contact_ratio_factor"]) ** 2,
            overlap,
        ]
    ).max()
    total = e + overlap
    k = 0.32 * single * pitch / load + 0.57 / (total - 0.3) * single * profile / load
    k += 0.096 / (total - 1.56)
    by_b = 1.0 + float(data["resonance_ratio"]) * k
    assert float(data["dynamic_factor_b"]) == pytest.approx(by_b, rel=1e-6)
    assert float(data["rated_dynamic_factor"]) == float(data["dynamic_factor_b"])
    # Discs from the bore, 0.3 of the root circle, to halfway up the teeth; steel of 7,850 kg/m3.
    stiffness = single * (0.75 * e + 0.25) * 1e9
    roots = np.array([(z / np.cos(helix) - 2.5) * 1e-3 for z in (23.0, 61.0)])
    bases = np.array([23.0, 61.0]) / zone * 1e-3 * np.cos(transverse)
    masses = np.pi / 2.0 * 7850.0 * ((roots + 2.25e-3) ** 4 - (0.3 * roots) ** 4) / bases**2
    speed = SPEED * 23.0 / np.sqrt(stiffness / (masses.prod() / masses.sum()))
    assert float(data["resonance_ratio"]) == pytest.approx(speed, rel=1e-2)
    mean = load * by_b
    diameter = 46.0 / np.cos(helix)
    bent = 0.8 * 120.0 * 20.0 / diameter**2 * (diameter / 40.0) ** 4
    if diameter / 40.0 >= 1.15:
        bent *= 0.48 / 0.8
    shaft_part = 0.023 * mean * (abs(0.7 + bent) + 0.3) * (20.0 / diameter) ** 2
    whole = 1.33 * shaft_part + 8.5 * np.sqrt(2.0)
    assert float(data["face_misalignment"]) * 1e6 == pytest.approx(0.85 * whole, rel=1e-6)
    half = 0.85 * whole * 0.85 * stiffness * 1e-9 / (2.0 * mean)
    expected = 2.0 * np.sqrt(half) if half >= 1.0 else 1.0 + half
    assert float(data["face_load_factor"]) == pytest.approx(expected, rel=1e-6)
    assert "K_Hβ" not in data.attrs["assumed"]


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"strength.dynamic_factor": 1.2, "strength.dynamic_method": "B"}, "beside dynamic_factor"),
        ({"strength.edition": 2006, "strength.profile_correction": 1.1}, "has no f_ZCa"),
        ({"strength.edition": 1997}, "strength.edition"),
        ({"strength.bearing_span": "1 m"}, "without pinion_offset and pinion_shaft_diameter"),
        (
            {
                "strength.bearing_span": "100 mm",
                "strength.pinion_offset": "40 mm",
                "strength.pinion_shaft_diameter": "30 mm",
            },
            "face_load_factor",
        ),
        ({"strength.dynamic_method": "B", "materials.gear_2": "POM-H"}, "holds for steel"),
        ({"gears.cutter_teeth": 20}, "two external gears"),
        ({"gears.cutter_profile_shift": 0.1}, "without cutter_teeth"),
    ],
)
def test_what_cannot_be_rated_so_is_refused(
    pair_file: Path, settings: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        uncomputed_manifests(str(pair_file), settings=settings)


def test_the_tensile_strength_bounds_plastics_without_a_source() -> None:
    """PBT: 60 MPa, of which twice breaks at once; POM-H has its own strength and no bound."""
    plain = PAIR.replace('gear_2 = "case-hardened-mq"', 'gear_2 = "PBT"')
    data = computed(plain, None, "strength").parts["strength"]
    withheld = json.loads(data.attrs["withheld"])
    most = 120e6 / float(data["root_stress"][1])
    assert withheld[-1].startswith(
        f"The root safety of gear 2 is below {most:.3g}: twice the tensile"
    )
    known = computed(plain.replace("PBT", "POM-H"), None, "strength").parts["strength"]
    assert "tensile" not in known.attrs["withheld"]
    assert float(known["root_safety"][1]) < 2.0 * 70e6 / float(known["root_stress"][1])


def test_without_load_safeties_have_no_end() -> None:
    idle = computed(PAIR + RATED, None, "strength", **{"operation.torque": "0 N m"})
    rows = strength_rows(idle)
    assert {row[name] for row in rows for name in row if "safety" in name} == {"∞"}


def test_thin_rims_and_fast_pairs_are_told(pair_file: Path) -> None:
    thin = strength_of(pair_file, {"gears.bore_diameter": ["40 mm", "20 mm"]})
    (rim,) = told(thin)
    assert rim.startswith("The rim of gear 1 is 0.")
    assert thin["rim_factor"].values == pytest.approx([1.6 * np.log(2.242 / 0.5), 1.0])
    (fast,) = told(strength_of(pair_file, {"operation.speed": "20000 rpm"}))
    assert "give dynamic_factor" in fast
    numbers = [
        float(strength_of(pair_file, {"operation.speed": f"{rpm} rpm"})["rated_dynamic_factor"])
        for rpm in (1000, 4000, 7000, 50_000)
    ]
    assert numbers == sorted(numbers)  # the formula falls, below 1 in the end


def test_roots_are_those_of_the_thinnest_teeth(pair_file: Path) -> None:
    """By the field c26 of DIN 3967 for both gears, as a pair that is cut with x_E = x + A_sni/(2 m_n tan)."""
    thin = strength_of(pair_file, {"gears.inspection.thickness_field": "26c"})
    nominal = strength_of(pair_file)
    allowances = np.array([65.0 + 50.0, 115.0 + 80.0]) * 1e-6  # of 47.6 and 126.3 mm
    shifts = -allowances / (2.0 * 2e-3 * np.tan(np.radians(20.0)))
    same = strength_of(
        pair_file,
        {
            "gears.profile_shift": [float(one) for one in shifts],
            "gears.centre_distance": f"{84.0 / float(np.cos(np.radians(15.0)))!r} mm",
            "gears.tip_alteration": [float(-one) for one in shifts],
        },
    )
    for name in ("root_chord", "root_fillet_radius", "load_angle", "bending_arm"):
        np.testing.assert_allclose(thin[name], same[name], rtol=1e-9, err_msg=name)
    assert (thin["root_stress"] > 1.03 * nominal["root_stress"]).all()
    assert float(thin["nominal_contact_stress"]) == float(nominal["nominal_contact_stress"])
    assert "thinnest teeth" in json.loads(thin.attrs["remarks"])[0]


def test_stages_are_rated_each_by_itself() -> None:
    """The second stage of the drive, without losses, as a case of its own."""
    data = strength_of(EXAMPLES / "two_stage.toml")
    assert data["stage"].values.tolist() == [1, 2]
    assert data["root_stress"].dims == ("stage", "gear")
    alone = PAIR.replace("23, 61", "19, 70").replace(
        'helix_angle = "15 deg"', "profile_shift = [0.4, 0.0]"
    )
    alone = (
        alone.replace('"2 mm"', '"3 mm"')
        .replace('"20 mm"', '"30 mm"')
        .replace('"50 N m"', '"300 N m"')
    )
    one = computed(alone, None, "strength", **{"operation.speed": f"{1500.0 * 23 / 61} rpm"})
    for name in ("tangential_force", "contact_stress", "root_stress", "rated_dynamic_factor"):
        values = data[name].sel(stage=2).values
        np.testing.assert_allclose(values, one.parts["strength"][name].values, rtol=1e-10)
    told = json.loads(data.attrs["withheld"])
    assert [text.partition(":")[0] for text in told] == ["Stage 1"] * 2 + ["Stage 2"] * 2


def test_a_table_of_a_drive_is_for_those_stages_that_are_rated() -> None:
    path = EXAMPLES / "spur_and_strain_wave.toml"
    plain, twice = (
        strength_of(path, {"strength.application_factor": factor}) for factor in (1.0, 2.0)
    )
    assert plain["stage"].values.tolist() == [1]
    ratio = twice["root_stress"].values / plain["root_stress"].values
    assert ratio == pytest.approx(2.0, abs=0.2)  # K_v falls a little with the load
    with pytest.raises(InputError, match=r"stages\.2\.strength: was given"):
        strength_of(path, {"stages.2.strength.application_factor": 1.2})
