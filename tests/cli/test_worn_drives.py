"""A worn pair is a pair: what wear does to its flanks, and what its analyses say of it afterwards.

Torus pairs and strain wave gears take minutes: `tests/long/worn_drives.py`.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from pitchpoint._jax import array
from pitchpoint.analyses import wear_course
from pitchpoint.analyses.along_action import STIFFNESS
from pitchpoint.analyses.analysis_registry import ANALYSES, TORSION
from pitchpoint.analyses.wear import WEAR
from pitchpoint.contact.worn import FLATTEST, Worn
from pitchpoint.efficiency.quasi_static import contacts_at
from pitchpoint.results.store import load, save
from pitchpoint.runs.run import load_case, run_case

MODELS = {
    "models.load_sharing": "from_stiffness",
    "models.friction": {"name": "constant", "coefficient": 0.05},
}
DRY = {
    "wear.law": "archard_1953",
    "wear.cycles": 1e7,
    "wear.coefficient": 2e-7,
    "wear.hardness": "700 HV",
    "wear.cells": 16,
    "wear.phases": 8,
}
GUIDELINE = {
    "wear.law": "vdi_2736",
    "wear.cycles": 1e6,
    "wear.rate": ["0 1/Pa", "1e-6 mm3/(N m)"],
    "wear.cells": 16,
    "wear.phases": 8,
}
COSINE = np.cos(np.radians(20.0))


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    few = {one.name: one for one in (WEAR, TORSION, STIFFNESS)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", few)
        # Another file holds derivatives against differences.
        patch.setattr(wear_course, "march_sensitivities", lambda *_, **__: {})
        yield


def parts(settings: Mapping[str, Any], folder: Path | None = None) -> dict[str, xr.Dataset]:
    """Datasets of the pair of tian2024."""
    found = run_case("tian2024", folder=folder, only=["physical"], settings=MODELS | settings)
    return found["physical"].parts


def worn(folder: Path, **settings: Any) -> dict[str, xr.Dataset]:
    """The same with the flanks that a result has worn."""
    (kept,) = folder.rglob("wear.nc")
    return parts({"worn.file": str(kept), **settings})


def play(found: dict[str, xr.Dataset]) -> float:
    """Backlash at the loaded member [rad]."""
    return float(found["torsion"]["kinematic_play"])


def swing(found: dict[str, xr.Dataset]) -> float:
    """Transmission error of the loaded pair, peak to peak [m]."""
    return float(np.ptp(found["stiffness"]["static_transmission_error"].values))


@pytest.fixture(scope="module")
def new() -> dict[str, xr.Dataset]:
    """The pair of tian2024 with flanks as new."""
    return parts({})


@pytest.fixture(scope="module")
def spur(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the same pair is worn by ten million turns."""
    folder = tmp_path_factory.mktemp("spur")
    parts(DRY, folder)
    return folder


@pytest.mark.whole
def test_a_spur_pair_wears_in_two_humps_around_its_pitch_point(spur: Path) -> None:
    data = load(spur / "physical" / "wear.nc")
    depths, radii = data["worn_depth"].values[-1, :, :, 0], data["flank_radius"].values
    for depth, radius, pitch in zip(depths, radii, (27e-3, 54e-3), strict=True):
        least = int(np.argmin(depth))
        assert abs(radius[least] - pitch) < np.abs(np.diff(radius)).max()
        below, above = depth[:least].max(), depth[least + 1 :].max()
        # Of a cell the mean is kept, in which flanks slide on both sides of the pitch point.
        assert depth[least] < 0.3 * min(below, above)
        assert below > above  # where the mate slides far over a short way
    volumes = data["worn_volume"].values[-1]
    assert volumes[0] / volumes[1] == pytest.approx(36.0 / 18.0, rel=1e-6)


@pytest.mark.whole
def test_steps_that_a_killed_run_did_not_remove_go_with_the_next(spur: Path) -> None:
    left = spur / "physical" / "wear.0003.nc"
    left.write_bytes(b"")
    parts(DRY, spur)
    assert not left.exists()


@pytest.mark.whole
def test_stiffness_error_and_backlash_of_a_worn_spur_pair(
    spur: Path, new: dict[str, xr.Dataset]
) -> None:
    data = load(spur / "physical" / "wear.nc")
    # One turn takes off less than a picometre.
    unworn, half, whole = (worn(spur, **{"worn.cycles": turns}) for turns in (1.0, 5e6, 1e7))
    for name in ("mesh_stiffness", "static_transmission_error"):
        same = unworn["stiffness"][name].values, new["stiffness"][name].values
        assert same[0] == pytest.approx(same[1], rel=1e-6)
    assert abs(swing(whole) / swing(new) - 1.0) > 0.05
    deepest = data["deepest_wear"].values[-1].sum()
    opened = (play(whole) - play(new)) * 54e-3 * COSINE
    assert 0.0 < (play(half) - play(new)) * 54e-3 * COSINE < opened < deepest


@pytest.mark.whole
def test_flanks_worn_alike_all_over_turn_the_pair_and_leave_its_stiffness(
    spur: Path, new: dict[str, xr.Dataset], tmp_path: Path
) -> None:
    data, depth = load(spur / "physical" / "wear.nc"), np.array([7e-6, 3e-6])
    data["worn_depth"].values[:] = depth[:, None, None]
    save(data, tmp_path / "wear.nc")
    found = worn(tmp_path)
    for name in ("mesh_stiffness", "pair_stiffness"):
        values = found["stiffness"][name].values
        assert values == pytest.approx(new["stiffness"][name].values, rel=1e-9)
    errors = [one["stiffness"]["static_transmission_error"].values for one in (new, found)]
    assert errors[1] - errors[0] == pytest.approx(depth.sum(), rel=1e-9)
    # Along the base tangent: the driven gear turns on by the depths over its base radius.
    turned = depth.sum() / (54e-3 * COSINE)
    assert play(found) - play(new) == pytest.approx(turned, rel=1e-9)
    angles = [one["torsion"]["angular_transmission_error"].values for one in (new, found)]
    assert angles[1] - angles[0] == pytest.approx(turned, rel=1e-9)
    windings = [one["torsion"]["wind_up"].values for one in (new, found)]
    assert windings[1] == pytest.approx(windings[0], rel=1e-9)


@pytest.mark.whole
def test_steel_wears_polyamide_and_not_itself(tmp_path: Path) -> None:
    plastic = {"materials.gear_2": "PA66", "operation.torque": "10 N m"}
    data = parts(plastic | GUIDELINE, tmp_path)["wear"]
    depth = data["worn_depth"].values[-1]
    assert not depth[0].any()
    assert depth[1].min() > 0.0
    before, found = parts(plastic), worn(tmp_path, **plastic)
    assert abs(swing(found) / swing(before) - 1.0) > 0.05
    opened = (play(found) - play(before)) * 54e-3 * COSINE
    assert depth[1].min() < opened < depth[1].max()


def test_flanks_that_conform_keep_a_part_of_their_curvature() -> None:
    mesh = load_case("tian2024", variant="physical").design.mesh
    flank, across = array([0.0, 7e-3]), array([-20e-3, 20e-3])
    rough = np.random.default_rng(1).uniform(0.0, 20e-6, (40, 1))
    one = Worn(array(rough), flank, across, array([1e-4, 0.04]))
    uneven = replace(mesh, surfaces=((one,), (one,)))
    phase = np.linspace(0.0, 0.9, 10)
    found, new = contacts_at(uneven, phase), contacts_at(mesh, phase)
    ratio = np.asarray(new.radius / found.radius)[np.asarray(new.active)]
    assert ratio.min() == pytest.approx(FLATTEST, rel=1e-9)
    assert ratio.max() > 1.5
