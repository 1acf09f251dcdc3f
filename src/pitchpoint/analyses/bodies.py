"""Masses and moments of inertia of the bodies of a mesh."""

import xarray as xr

from pitchpoint.analyses.analysis import Piece, Progress
from pitchpoint.cases.build import Built
from pitchpoint.results.store import dataset

__all__ = ["bodies_of"]


def bodies_of(built: Built, _: Piece, __: Progress) -> xr.Dataset:
    """Mass and moment of inertia of each member."""
    make = built.family.bodies
    assert make is not None
    densities = [float(solid.density) for solid in built.design.solids]
    made, told = make(built.case.gears, built.design.mesh, densities)
    masses, inertias = zip(*made, strict=True)
    data = {"body_mass": (("member",), masses), "body_inertia": (("member",), inertias)}
    return dataset(data, {"member": list(built.case.bodies)}, title="bodies", note=told)
