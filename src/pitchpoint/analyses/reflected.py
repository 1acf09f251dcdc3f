"""What a drive of several meshes is at its ends: backlash at the output, masses, reflected inertia."""

from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, Progress, has_key, silent
from pitchpoint.analyses.bodies import bodies_of
from pitchpoint.analyses.inspection import CASES, inspection_part
from pitchpoint.cases.build import Built
from pitchpoint.cases.built_drive import BuiltDrive
from pitchpoint.doubts import Doubt
from pitchpoint.results.store import dataset

__all__ = ["reflected_of"]

Inspections = Mapping[int, xr.Dataset]


class _Moving(NamedTuple):
    """A body of a stage.

    Attributes:
        name: with its stage.
        mass: [kg].
        inertia: about its axis [kg m2]; not a number where it travels.
        energy: twice that of its motion, for a radian of the input in a second [J].
    """

    name: str
    mass: float
    inertia: float
    energy: float


def reflected_of(built: BuiltDrive, _: Piece, __: Progress) -> xr.Dataset:
    """Dataset of the part.

    From the kinetic energy of all bodies, J_red = Σ J (ω/ω_end)²; the backlash of a stage counts at the
    output by the ratio between them, with the input held.

    Args:
        built: the case.
    """
    numbered = dict(zip(built.numbers, built.meshes, strict=True))
    inspected = {
        n: inspection_part(mesh) for n, mesh in numbered.items() if has_key(mesh, "inspection")
    }
    bodies = [
        body
        for (number, mesh), entering in zip(numbered.items(), built.motion[:-1], strict=True)
        for body in _bodies(number, mesh, entering, inspected)
    ]
    ends = {"input": built.motion[0]} | ({} if built.travels else {"output": built.motion[-1]})
    parts = np.array([[body.energy / rate**2 for body in bodies] for rate in ends.values()])
    backlash = {} if built.travels else _backlash(built, inspected)
    return dataset(
        {
            "body_mass": (("body",), [body.mass for body in bodies]),
            "body_inertia": (("body",), [body.inertia for body in bodies]),
            "reflected_part": (("end", "body"), parts),
            "reflected_inertia": (("end",), parts.sum(axis=1)),
            "drive_mass": ((), sum(body.mass for body in bodies)),
            **backlash,
        },
        {
            "body": [body.name for body in bodies],
            "end": [*ends],
            **({"case": [*CASES]} if backlash else {}),
        },
        title="reflected",
        warnings=_unknown(bodies),
        without_backlash=[n for n in numbered if n not in inspected],
        without_tolerances=[n for n, data in inspected.items() if data.sizes["case"] == 1],
    )


def _bodies(number: int, mesh: Built, entering: float, inspected: Inspections) -> list[_Moving]:
    """Bodies of a stage whose driver moves so fast; cylindrical gears are the discs of their inspection."""
    kind = "disc" if number in inspected else "body"
    data = inspected[number] if number in inspected else bodies_of(mesh, {}, silent)
    motion, driver = mesh.nominal["motion"], mesh.nominal["driver"]
    every = zip(
        mesh.bodies,
        data[f"{kind}_mass"].values.tolist(),
        data[f"{kind}_inertia"].values.tolist(),
        (motion * entering / (driver @ motion)).tolist(),
        strict=True,
    )
    return [
        _Moving(
            f"stage {number}: {body.body}",
            mass,
            inertia,
            (inertia if body.turns else mass) * rate**2 if rate else 0.0,
        )
        for body, mass, inertia, rate in every
    ]


def _backlash(
    built: BuiltDrive, inspected: Inspections
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Turn of the output in the backlash of all stages; nothing where that of one is not by its teeth."""
    if len(inspected) < len(built.meshes):
        return {}
    steps = np.abs(built.motion[-1] / np.array(built.motion[1:]))
    of_loaded = [
        inspected[number]["backlash_angle"].values[int(mesh.nominal["loaded"].argmax())]
        for number, mesh in zip(built.numbers, built.meshes, strict=True)
    ]
    each = [
        step * np.resize(angles, len(CASES)) for step, angles in zip(steps, of_loaded, strict=True)
    ]
    return {"output_backlash": (("case",), np.sum(each, axis=0))}


def _unknown(bodies: list[_Moving]) -> list[str]:
    """Bodies whose mass or inertia nobody gave."""
    names = [body.name for body in bodies if not (isfinite(body.mass) and isfinite(body.energy))]
    if not names:
        return []
    return [
        Doubt(
            f"Reflected inertia: that of {', '.join(names)} is not known, nor is that of the drive.",
            about=("reflected_inertia", "drive_mass"),
            brief=f"Inertia unknown: {names[0]} and so the drive's.",
        )
    ]
