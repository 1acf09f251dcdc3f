"""What a drive of several meshes is at its ends: backlash at the output, masses, reflected inertia."""

from collections.abc import Iterator, Mapping
from math import isfinite
from typing import NamedTuple

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, PieceProgress, has_key, silent
from pitchpoint.analyses.bodies import bodies_of
from pitchpoint.analyses.inspection import CASES, inspection_part
from pitchpoint.cases.built import MemberMotion
from pitchpoint.cases.built_drive import BuiltDrive
from pitchpoint.core.doubts import Doubt
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.results.store import dataset

__all__ = ["reflected_of"]

Inspections = Mapping[int, xr.Dataset]


class _Moving(NamedTuple):
    """A body of a drive, all its copies together.

    Attributes:
        name: of it, with how many there are.
        mass: [kg].
        inertia: about its axis [kg m2]; not a number where it travels.
        energy: twice that of its motion, for a radian of the input in a second [J].
    """

    name: str
    mass: float
    inertia: float
    energy: float


def reflected_of(built: BuiltDrive, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Dataset of the part.

    From the kinetic energy of all bodies, J_red = Σ J (ω/ω_end)²; the backlash of a stage counts at the
    output by the ratio between them, with the input held.

    Args:
        built: the case.
    """
    numbers = built.mesh_numbers
    inspected = {
        place: inspection_part(mesh)
        for place, mesh in enumerate(built.meshes)
        if has_key(mesh, "inspection")
    }
    bodies = _bodies(built, inspected)
    ends = {"input": 1.0} | ({} if built.travels else {"output": built.output_rate})
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
        carriers=[*_carriers(built)],
        without_backlash=[*{n: 0 for k, n in enumerate(numbers) if k not in inspected}],
        without_tolerances=[
            *{numbers[k]: 0 for k, data in inspected.items() if data.sizes["case"] == 1}
        ],
    )


def _bodies(built: BuiltDrive, inspected: Inspections) -> list[_Moving]:
    """Bodies of a drive, each gear once; cylindrical ones are the discs of their inspection.

    Of a gear that is as wide as another mesh of it asks, the heavier disc counts.
    """
    heaviest: dict[str, _Moving] = {}
    meshes = zip(built.meshes, built.member_motions, strict=True)
    for place, (mesh, members) in enumerate(meshes):
        kind = "disc" if place in inspected else "body"
        data = inspected[place] if place in inspected else bodies_of(mesh, {}, silent)
        values = (data[f"{kind}_{what}"].values.tolist() for what in ("mass", "inertia"))
        for member, coordinate, mass, inertia in zip(members, mesh.bodies, *values, strict=True):
            body = _moving(member, mass, inertia, turns=coordinate.turns)
            heaviest_yet = heaviest.setdefault(member.body, body)
            if body.mass > heaviest_yet.mass:
                heaviest[member.body] = body
    return [*heaviest.values()]


def _moving(member: MemberMotion, mass: float, inertia: float, *, turns: bool) -> _Moving:
    """A member with its mass, from the energy about its axis and that of its axis about the carrier's."""
    of_axis = (inertia if turns else mass) * member.rate**2 if member.rate else 0.0
    of_orbit = mass * member.orbit**2 if member.orbit else 0.0
    count = member.copies
    name = member.body if count == 1 else f"{count} × {member.body}"
    return _Moving(name, count * mass, count * inertia, count * (of_axis + of_orbit))


def _carriers(built: BuiltDrive) -> Iterator[str]:
    """Carriers, of which no mass is known."""
    carriers = (member.carrier for members in built.member_motions for member in members)
    yield from (name for name in dict.fromkeys(carriers) if name != HOUSING)


def _backlash(
    built: BuiltDrive, inspected: Inspections
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Turn of the output in the backlash of all meshes; nothing where that of one is not by its teeth.

    From virtual work: the torque that the driven member of a mesh carries for a unit at the output, without
    losses, is also how far a turn of it alone turns the output. Planets share it and play alike.
    """
    if len(inspected) < len(built.meshes):
        return {}
    of_loaded = [
        inspected[place]["backlash_angle"].values[int(mesh.nominal["loaded"].argmax())]
        for place, mesh in enumerate(built.meshes)
    ]
    turns = [
        step * np.resize(angles, len(CASES))
        for step, angles in zip(built.steps, of_loaded, strict=True)
    ]
    return {"output_backlash": (("case",), np.sum(turns, axis=0))}


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
