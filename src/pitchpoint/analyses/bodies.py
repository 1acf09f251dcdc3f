"""Masses and moments of inertia of the bodies of a mesh."""

from math import isfinite
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.cases.built import Built
from pitchpoint.results.store import dataset

__all__ = ["bodies_of"]


def bodies_of(built: Built, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Mass and moment of inertia of each member, and of all at the ends: J_red = Σ J (ω/ω_end)².

    The latter of gears that turn at both ends, where the inertia of all that turn is known.
    """
    make = built.family.bodies
    assert make is not None
    densities = [float(solid.density) for solid in built.design.solids]
    members, note = make(built.case.gears, built.design.mesh, densities)
    masses, inertias = zip(*members, strict=True)
    data: dict[str, Any] = {
        "body_mass": (("member",), masses),
        "body_inertia": (("member",), inertias),
    }
    rates = np.asarray(built.nominal["motion"])
    energy = np.sum(np.asarray(inertias) * rates**2, where=rates != 0.0)
    if built.travels or not isfinite(energy):
        return dataset(data, {"member": list(built.case.bodies)}, title="bodies", note=note)
    ends = {"input": energy, "output": energy / built.output_rate**2}
    data["reflected_inertia"] = (("end",), [*ends.values()])
    coordinates = {"member": list(built.case.bodies), "end": [*ends]}
    return dataset(data, coordinates, title="bodies", note=note)
