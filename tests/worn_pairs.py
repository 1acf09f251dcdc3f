"""Pairs and discs whose flanks wear."""

from functools import cache
from pathlib import Path

import numpy as np

from pitchpoint._jax import array, jax, jnp
from pitchpoint.cases.built import Built
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness
from pitchpoint.runs.run import load_case
from pitchpoint.wear.history import Cells, DriverTurn, Start, WearModel, unworn_start, wear_of_turn
from pitchpoint.wear.laws import archard_1953

K = 1e-16
OWN = {"coefficient": array(K * 2e9), "hardness": array(2e9)}
WEAR = WearModel(archard_1953, (OWN, OWN))
CELLS, PARTS = 32, 16
EXAMPLES = Path(__file__).parents[1] / "examples"


@cache
def pair(name: str = "from_stiffness") -> Built:
    """The pair of 23 and 61 teeth, or another."""
    return load_case(str(EXAMPLES / "pair_23_61.toml"), settings={"models.load_sharing": name})


def begun(built: Built, cells: int = CELLS) -> tuple[Start, Cells]:
    given = built.design, built.operation, built.models[0]
    return unworn_start(*given, parts=PARTS, count=cells)


def turn(
    built: Built, cells: int = CELLS, depth: np.ndarray | None = None
) -> tuple[DriverTurn, Cells]:
    """What a turn wears off flanks as new, or off worn ones."""
    start, grid = begun(built, cells)
    gone = jnp.zeros(grid.shape) if depth is None else array(depth)
    given = built.design, built.operation, built.models[0], WEAR
    return jax.device_get(wear_of_turn(*given, grid, start, gone)), grid


# ---- closed forms

LOAD, LENGTH, RADII = 2e3, 0.01, (0.02, 0.05)


def discs(ratio: float = 0.8) -> tuple[Design, Operation, Models]:
    """Two discs whose contact is the same at all times."""
    steel = solids.find("steel").build()
    design = Design(
        TwinDisc(array(RADII), array(LENGTH), array(ratio)),
        (steel, steel),
        lubricants.find("pao-vg-220").build(),
        Roughness.from_composite_rq(0.4e-6),
    )
    models = Models(
        friction=(),
        choice=array(0),
        parameters={},
        sharing=LOAD_SHARING["equal"],
        rolling=ROLLING_RESISTANCE["none"],
    )
    return design, Operation(array(LOAD), array(100.0), array(330.0)), models
