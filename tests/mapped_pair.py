"""Pairs with their loss maps of the output."""

import sys
import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest
import sound
import xarray as xr

from pitchpoint import cli
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.analysis_registry import FOUR_QUADRANTS
from pitchpoint.analyses.running import RUNNING
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.variant import Variant
from pitchpoint.runs.run import Outcome, uncomputed_manifests

TITLE = '"""*/ #\' \\ ??/ {title}\u2028 % \U0001f600'
GEARS = sound.PAIR.replace("[23, 61]", "[12, 120]\nprofile_shift = [0.5, 0.0]")
PAIR = f"""
{GEARS}
[loss_map]
count = 4
temperatures = ["40 degC", "60 degC"]
quadrants = 4
"""
MOVING = """
[models]
friction = ["xu_2007", "frictionless"]
[losses]
motor = { between = ["gear 1", "housing"], seal_torque = "0.1 N m" }
[losses.seal]
between = ["gear 2", "housing"]
seal_torque = "2 N m"
breakaway_torque = "1 N m"
breakaway_spread = 2.0
"""
LOCKING = """
[models]
friction = { name = "constant", coefficient = 1.8 }
"""
TOLERANCE = 1e-13


def variant(text: str) -> Variant:
    return Variant({**tomllib.loads(text), "title": TITLE}, "pair.toml", "default")


def outcome(text: str, *others: Any) -> tuple[Ready, Outcome]:
    made = variant(text)
    built = made.built({})
    parts = {}
    for analysis in (FOUR_QUADRANTS, *others):
        pieces = [analysis.compute(built, piece, silent) for piece in analysis.pieces(built)]
        parts[analysis.name] = analysis.joined(built, pieces)
        parts[analysis.name].attrs["fingerprint"] = "0123456789abcdef"
    (manifest,) = uncomputed_manifests(made.tree)
    return built, Outcome(manifest | {"lacks": {}, "parts": [*parts], "finished": True}, parts)


@cache
def moving_drive() -> tuple[Ready, Outcome]:
    return outcome(PAIR + MOVING, RUNNING)


@cache
def locking_drive() -> tuple[Ready, Outcome]:
    return outcome(PAIR + LOCKING)


def command(*arguments: object) -> int:
    with pytest.MonkeyPatch.context() as changed, pytest.raises(SystemExit) as caught:
        changed.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        cli.main()
    return int(caught.value.code or 0)


def whole(data: xr.Dataset) -> dict[str, np.ndarray]:
    """Values over law, torque, speed and temperature."""
    dims = ("law", "output_torque", "output_speed", "temperature")
    names = ("mean_loss", "mean_efficiency", "mean_input_torque", "locked")
    return {name: data[name].transpose(*dims).values for name in names}
