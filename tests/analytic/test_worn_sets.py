"""Worn flanks of planetary sets and of stages, taken up from a result of several meshes."""

from typing import Any

import jax
import numpy as np
import pytest

from pitchpoint.analyses.analysis import Subject
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.worn import gears_digest
from pitchpoint.errors import InputError
from pitchpoint.results.by_stage import by_stage
from pitchpoint.results.store import dataset, save
from pitchpoint.runs.run import load_case, uncomputed_manifests

TABLES = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "models": {
        "friction": {"name": "constant", "coefficient": 0.05},
        "load_sharing": "from_stiffness",
    },
    "operation": {"torque": "40 N m", "speed": "3000 rpm", "temperature": "60 degC"},
}
PAIR = {"teeth": [23, 61], "module": "1 mm", "face_width": "12 mm"}
SET = {"family": "planetary", "teeth": [24, 30, 84], "module": "1 mm", "face_width": "12 mm"}
TURNS = {"sun": 1 - 24 / 108, "planet": 84 / 30 * 24 / 108}
"""Of the driver of each mesh against the carrier for one of the sun, the carrier being loaded."""

BODIES = {"sun": "sun and planet", "planet": "planet and ring"}


def worn_by(mesh: Any, turns: float, deepest: float) -> Any:
    """A result with wear of a mesh that is deepest in the middle of its path, and linear in time."""
    cells = np.sin(np.linspace(0.0, np.pi, 9)[:-1])[:, None]
    depth = np.stack([np.zeros((2, 8, 1)), deepest * np.stack([cells, 0.5 * cells])])
    names = ("step", "member", "cell", "strip")
    return dataset(
        {
            "worn_depth": (names, depth),
            "deepest_wear": (names[:2], depth.max(axis=(2, 3))),
            "wear_error": (names[:2], 0.01 * depth.max(axis=(2, 3))),
            "cycles": (names[:1], np.array([0.0, turns])),
            "conforming": (names[:1], np.array([False, False])),
            "flank_ends": (("member", "side"), np.array([[0.5e-3, 3e-3], [2e-3, 6e-3]])),
            "across_ends": (("side",), np.array([-0.01, 0.01])),
            "contact_span": (("axis",), np.array([1e-4, 0.02])),
        },
        {},
        title="wear",
        gears=gears_digest(mesh.case.gears),
        driver=mesh.driver,
    )


def of_file(gears: Any, **more: Any) -> Any:
    return load_case({"gears": gears, **TABLES, **more})


def in_row(*stages: Any, **more: Any) -> Any:
    tables = [stage if "gears" in stage else {"gears": stage} for stage in stages]
    return {"stages": tables, **TABLES, **more}


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A result with a million turns of the sun of a set, as the third stage of a drive."""
    path = tmp_path_factory.mktemp("worn") / "wear.nc"
    pairs = {
        1: worn_by(of_file(PAIR).meshes[0], 1e6, 1e-6),
        2: worn_by(of_file(PAIR).meshes[0], 1e6, 3e-6),
    }
    meshes = zip(TURNS.items(), of_file(SET).meshes, strict=True)
    of_set = {
        f"3 ({BODIES[driver]})": worn_by(mesh, 1e6 * turns, depth)
        for ((driver, turns), mesh), depth in zip(meshes, (2e-6, 4e-6), strict=True)
    }
    save(by_stage({**{str(number): data for number, data in pairs.items()}, **of_set}), path)
    return str(path)


def surfaces(built: Any) -> list[np.ndarray]:
    return [np.asarray(leaf, float) for leaf in jax.tree.leaves(built.design.mesh)]


def test_a_set_in_a_row_has_the_worn_flanks_of_the_set_alone(kept: str) -> None:
    """Those of the mesh in which each gear is, after so many turns of the input of the set."""
    new = of_file(SET)
    half, all_of_it = (
        of_file(SET, worn={"file": kept, **cycles}) for cycles in ({"cycles": 5e5}, {})
    )
    row = load_case(in_row(PAIR, {"gears": SET, "worn": {"file": kept, "cycles": 5e5}}))
    for mesh, alone, worn_out, unworn, depth in zip(
        row.stages[1].meshes, half.meshes, all_of_it.meshes, new.meshes, (2e-6, 4e-6), strict=True
    ):
        for in_a_row, by_itself in zip(surfaces(mesh), surfaces(alone), strict=True):
            np.testing.assert_allclose(in_a_row, by_itself, rtol=1e-12, atol=1e-20)
        flanks, deeper = (
            [on_member[-1] for on_member in built.design.mesh.surfaces]
            for built in (alone, worn_out)
        )
        assert len(surfaces(alone)) > len(surfaces(unworn))
        for surface, deep in zip(flanks, deeper, strict=True):
            np.testing.assert_allclose(deep.depth, 2.0 * surface.depth, rtol=1e-9)
        assert np.max(flanks[0].depth) == pytest.approx(0.5 * depth, rel=0.05)
        told = [text for text in row.warnings if text.startswith("Stage 2 (")]
        assert any(f"{float(1e6 * depth / 2):.3g} and" in text for text in told)
    assert not any("worn" in text for text in row.stages[0].warnings)


@pytest.mark.whole
def test_efficiency_and_stiffness_of_a_worn_set_in_a_row_are_those_of_the_set_alone(
    kept: str,
) -> None:
    """At the load and the speed that it has behind a pair; new flanks give others."""
    worn = {"file": kept}
    row = load_case(in_row(PAIR, {"gears": SET, "worn": worn}))
    behind = {**TABLES["operation"], "speed": f"{3000 * 23 / 61!r} rpm"}
    alone, new = (of_file(SET, operation=behind, **more) for more in ({"worn": worn}, {}))
    figures = [
        {name: values[0] for name, values in of_points.items()}
        for of_points in (
            built.figures_of([(built.design, built.operation)], built.models[0])
            for built in (row, alone, new)
        )
    ]
    efficiency = [of_drive["stage_efficiency"] for of_drive in figures]
    assert efficiency[0][1] == pytest.approx(figures[1]["mean_efficiency"], rel=1e-12)
    assert abs(figures[2]["mean_efficiency"] / figures[1]["mean_efficiency"] - 1.0) > 1e-6
    springs = [
        float(torsion(built)["torsional_stiffness"].max())
        for built in (load_case(in_row({"gears": SET, "worn": worn}, operation=behind)), alone, new)
    ]
    assert springs[0] == pytest.approx(springs[1], rel=1e-9)
    assert abs(springs[2] / springs[1] - 1.0) > 1e-6


def torsion(built: Any) -> Any:
    """Wind-up of a drive."""
    (part,) = ANALYSES["torsion"].parts(Subject(None, built))
    pieces = [part.compute(built, piece, lambda *_: None) for piece in part.pieces(built)]
    return part.joined(built, pieces)


def test_of_stages_with_equal_gears_one_is_named(kept: str) -> None:
    first, second = (of_file(PAIR, worn={"file": kept, "stage": number}) for number in (1, 2))
    depths = [float(np.max(one.design.mesh.surfaces[0][-1].depth)) for one in (first, second)]
    assert depths[1] == pytest.approx(3.0 * depths[0], rel=1e-9)
    with pytest.raises(InputError, match=r"worn.stage: is missing, .* stage 1 and 2; give 1 or 2$"):
        of_file(PAIR, worn={"file": kept})
    with pytest.raises(InputError, match=r"4 was given, and .* in stage 1 and 2; give 1 or 2$"):
        of_file(PAIR, worn={"file": kept, "stage": 4})


@pytest.mark.parametrize(
    ("tree", "key", "told"),
    [
        (
            {"gears": SET, "worn": {"cycles": 1.2e6}},
            "worn.cycles",
            r"1.2e\+06 is beyond the 1e\+06 turns",
        ),
        (
            {"gears": SET, "worn": {"stage": 2}},
            "worn.stage",
            r"2 was given, and .* in stage 3; leave it out",
        ),
        (
            {"gears": {**SET, "module": "1.1 mm"}, "worn": {}},
            "worn.file",
            "the wear of other gears",
        ),
        (in_row(PAIR, SET, worn={}), "worn", "under its ..stages"),
        (
            in_row(PAIR, {"gears": SET, "worn": {"cycles": 2e6}}),
            "stages.2.worn.cycles",
            "give at most so many",
        ),
    ],
)
def test_wrong_worn_sets_are_told_with_their_key(kept: str, tree: Any, key: str, told: str) -> None:
    stages = [
        {**stage, "worn": {"file": kept, **stage["worn"]}} if "worn" in stage else stage
        for stage in tree.get("stages", [])
    ]
    whole = {"worn": {"file": kept, **tree["worn"]}} if "worn" in tree else {}
    with pytest.raises(InputError, match=told) as caught:
        load_case({**TABLES, **tree, **whole, **({"stages": stages} if stages else {})})
    assert caught.value.key == key


def test_a_record_tells_the_worn_flanks_of_a_stage_by_what_the_file_holds(kept: str) -> None:
    (manifest,) = uncomputed_manifests(in_row(PAIR, {"gears": SET, "worn": {"file": kept}}))
    told = {row["key"]: row["value"] for row in manifest["inputs"] if ".worn." in row["key"]}
    assert told["2.worn.file"] == kept
    assert len(told["2.worn.digest"]) == 64
