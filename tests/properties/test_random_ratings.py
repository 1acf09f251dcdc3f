"""Any pair that the schema lets through has a finite rating, or one clear sentence."""

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import strategies as st
from properties.test_random_cases import between, cases, drawn, of, pair

from pitchpoint.analyses.strength import STRENGTH
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.cylindrical.din_3967 import FIELDS
from pitchpoint.input.kinds import LIFE
from pitchpoint.strength.strength_table import ENDURED, PEAK_TO_VALLEY
from pitchpoint.strength.treatments import TREATMENTS

SEED, EXAMPLES = 2, 60

LOADS = (
    "application_factor",
    "dynamic_factor",
    "face_load_factor",
    "transverse_load_factor",
    "root_face_load_factor",
    "root_transverse_load_factor",
    "profile_correction",
)


WHERE_ASKED = {"dynamic_factor_b", "dynamic_factor_c", "resonance_ratio", "face_misalignment"}
"""Of what a table names: method B, and the shaft of the pinion."""

OF_LIMITS = {
    *(f"{part}_{what}" for part in ("flank", "root") for what in ("endurance", "cycles", "safety")),
    *("contact_limit", "root_limit", "least_flank_safety", "least_root_safety"),
    *("lubricant_factor", "velocity_factor", "roughness_factor"),
}
"""What is not known without limits of the materials, or for plastics."""


def table() -> st.SearchStrategy[dict[str, Any]]:
    every: dict[str, st.SearchStrategy[Any]] = {
        **dict.fromkeys(LOADS, between(1.0, 2.0)),
        "accuracy_class": st.integers(3, 8),
        "life": of(LIFE, 1.0, 1e9),
        "sigma_hlim": pair(of(ENDURED, 1e7, 2e9)),
        "sigma_flim": pair(of(ENDURED, 1e7, 6e8)),
        "treatment": pair(st.sampled_from(list(TREATMENTS))),
        "work_hardening": pair(between(1.0, 1.2)),
        "mean_stress_factor": pair(between(0.7, 1.0)),
        "flank_roughness": pair(of(PEAK_TO_VALLEY, 1e-7, 2e-5)),
        "root_roughness": pair(of(PEAK_TO_VALLEY, 1e-7, 5e-5)),
    }
    return st.fixed_dictionaries({}, optional=every)


@st.composite
def rated(draw: st.DrawFn) -> dict[str, Any]:
    case = draw(cases())
    # What a rating does not ask, as it is usual: the gears and the table are what is drawn.
    case["lubricant"] = {"name": "pao-vg-460"}
    case["operation"]["temperature"] = "60 degC"
    case["models"]["load_sharing"] = "equal"
    gears = case["gears"]
    if draw(st.booleans()):
        gears["helix_angle"] = f"{draw(between(0.0, 35.0))!r} deg"
    if draw(st.integers(0, 3)) == 0:
        gears["teeth"] = [draw(st.integers(12, 40)), -draw(st.integers(50, 150))]
        gears["addendum"] = [1.0, 0.7]
    if draw(st.integers(0, 3)) == 0:
        gears["inspection"] = {"thickness_field": draw(st.sampled_from(FIELDS))}
    return case | {"strength": draw(table())}


def rating(case: dict[str, Any]) -> xr.Dataset | None:
    try:
        built = Variant(case, "random.toml", "default").built({})
        return STRENGTH.compute(built, {}, lambda _: None)
    except (InputError, ConvergenceError) as error:
        assert all(20 < len(str(one)) < 700 for one in error.every)
        return None


def check(data: xr.Dataset) -> None:
    """Finite where it is known, above zero, and consistent."""
    for name, values in data.data_vars.items():
        numbers = values.values.astype(float)
        assert not (numbers < 0.0).any(), name
        if name not in OF_LIMITS and name not in WHERE_ASKED:
            assert np.isfinite(numbers).all(), name
    known = data["flank_endurance"].notnull()
    assert (data["flank_safety"].notnull() == known).all()
    assert (data["root_safety"].notnull() == data["root_endurance"].notnull()).all()
    for part in ("flank", "root"):
        least, each = float(data[f"least_{part}_safety"]), data[f"{part}_safety"].values
        assert least == np.fmin.reduce(each) if np.isfinite(each).any() else not np.isfinite(least)
    assert (data["rated_dynamic_factor"] >= 1.0).all()
    assert (data["single_contact_factor"] >= 1.0).all()
    failing = (data["flank_safety"] < 1.0).sum() + (data["root_safety"] < 1.0).sum()
    told = [text for text in json.loads(data.attrs["warnings"]) if text.startswith("Fails: ")]
    assert len(told) == int(failing)


def explore(examples: int) -> None:
    """Draw cases, the same in every run, and hold each to its rating."""
    counts = {"rated": 0, "refused": 0}

    @drawn(rated(), examples, SEED)
    def draw(case: dict[str, Any]) -> None:
        found = rating(case)
        counts["refused" if found is None else "rated"] += 1
        if found is not None:
            check(found)

    draw()
    assert counts["rated"] > examples / 10  # most of the others have gears that cannot run


def test_random_ratings() -> None:
    explore(20)


@pytest.mark.whole
def test_more_random_ratings() -> None:
    explore(EXAMPLES)
