"""A result of a pair that vibrates made by hand."""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
import numpy as np
import xarray as xr
from records import entries

from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.family import FAMILY
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.mesh_bodies import drawing
from pitchpoint.gears.pairs import way_of_pairs
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Outcome

FOUND, UNSTABLE = "a steady state was found, and disturbances of it die out", "it <b>grows</b>"
BESIDE = "A contact ratio of 0.9 is below the 1.2 for which ISO 6336-1 gives its estimate"


def pair_of(**changes: Any) -> CylindricalPair:
    return build_cylindrical_pair(
        **{"module": 0.0015, "pressure_angle": np.deg2rad(20.0), "face_width": 0.016, **changes}
    )


drawing_of = eqx.filter_jit(drawing)


def teeth_of(pair: CylindricalPair) -> xr.Dataset:
    numbers = {name: np.asarray(value) for name, value in drawing_of(pair).items()}
    dims = FAMILY.drawing
    teeth = dataset(
        {name: (dims.get(name, ("gear",)[: v.ndim]), v) for name, v in numbers.items()},
        dict(FAMILY.coordinates),
        title="teeth",
    )
    teeth["points"].attrs.update(way_of_pairs(pair).attributes(["gear 1", "gear 2"]))
    return teeth


def stiffness() -> xr.Dataset:
    phase = np.linspace(0.0, 1.0, 41)
    each = np.stack([2e6 + 1e6 * phase, np.where(phase < 0.5, 3e6, 0.0)])
    return dataset(
        {
            "phase": (("node",), phase),
            "entered": (("pair", "node"), np.stack([phase, phase + 1.0])),
            "pair_stiffness": (("pair", "node"), each),
            "line_length": (("pair", "node"), (each > 0.0) * 0.016),
            "mesh_stiffness": (("node",), each.sum(axis=0)),
            "mean_stiffness": ((), 3.977e6),
            "stiffness_variation": ((), 0.1614),
            "standard_stiffness": ((), 3.04e6),
        },
        {},
        title="mesh stiffness",
        warnings=[BESIDE],
        model="beam",
    )


def vibration(codes: tuple[int, int] = (0, 0)) -> xr.Dataset:
    phase = np.linspace(0.0, 1.0, 41)
    error = np.stack([30e-6 + 2e-6 * np.sin(2.0 * np.pi * phase)] * 2) * [[1.0], [1.4]]
    one = ("torque",)
    figures = {
        "mean_transmission_error": [30e-6, 42e-6],
        "transmission_error_range": [4e-6, 5.6e-6],
        "static_transmission_error_range": [3e-6, 4.2e-6],
        "largest_dynamic_factor": [0.9, 0.9],
        "natural_frequency": [6700.0, 6800.0],
        "mesh_frequency": [120.0, 120.0],
        "equivalent_mass": [2.2e-3, 2.2e-3],
        "vibration_status": list(codes),
    }
    factor = np.broadcast_to([phase, 1.0 - phase], (2, 2, 41))
    return dataset(
        {
            "phase": (("node",), phase),
            "transmission_error": (("torque", "node"), error),
            "static_transmission_error": (("torque", "node"), 0.9 * error),
            "dynamic_factor": (("torque", "pair", "node"), factor),
            "spectrum": (("torque", "order"), np.outer([1.0, 1.4], 1e-6 / np.arange(1.0, 42.0))),
            **{name: (one, values) for name, values in figures.items()},
        },
        {"torque": [3.825, 5.355], "order": np.arange(41)},
        title="vibration",
        warnings=[],
        status=[(FOUND, UNSTABLE)[bool(code)] for code in codes],
        contact="teeth never part",
    )


def resonance() -> xr.Dataset:
    speed = np.linspace(200.0, 8000.0, 12)
    values = np.broadcast_to(np.linspace(1e-6, 9e-6, 12), (2, 2, 12)).copy()
    codes = np.zeros((2, 2, 12), dtype=int)
    values[1, 1, 6:8], codes[1, 1, 4:6] = 20e-6, 1
    dims = ("direction", "torque", "speed")
    return dataset(
        {
            "transmission_error_range": (dims, values),
            "largest_dynamic_factor": (dims, np.ones((2, 2, 12))),
            "vibration_status": (dims, codes),
        },
        {"direction": ["rising", "falling"], "torque": [3.825, 5.355], "speed": speed},
        title="vibration against speed",
        warnings=[],
        sentences=[FOUND, UNSTABLE],
    )


def outcome(parts: Mapping[str, xr.Dataset], driver: str = "gear 1") -> Outcome:
    given = {
        "operation.driver": driver,
        "operation.torque": 5.355,
        "operation.speed": 60.0 * np.pi,
        "operation.temperature": 296.15,
        "gears.flank": "left",
        "gears.module": 0.0015,
        "gears.least_tip_thickness": 0.25,
        "dynamics.damping_ratio": 0.16,
    }
    empty: dict[str, Any] = {"laws": [], "sources": [], "issues": [], "rows": []}
    manifest = {
        "case": "by hand",
        "surroundings": {},
        "variant": "default",
        "title": "by hand",
        "summary": "",
        "oil": "oil",
        "averaging": "base_pitch",
        "finished": True,
        "implausible": [],
        "warnings": ["of the design", BESIDE],
        "inputs": entries(given),
        "driver": driver,
        "loaded": "gear 1" if driver == "gear 2" else "gear 2",
        "members": ["gear 1", "gear 2"],
        "motion": [1.0, -4.0 / 51.0],
        "period": np.pi / 2.0,  # four teeth
        "travels": [],
        "pitch": "base pitch",
        "against": "gear 2 drives" if driver == "gear 2" else "",
        "models": [{"effect": "load sharing", "name": "equal", "title": "equal", "note": ""}],
        **empty,
    }
    return Outcome(manifest, dict(parts))
