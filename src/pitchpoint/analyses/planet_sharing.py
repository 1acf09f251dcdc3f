"""How planets share a load: forces on their pins, the mesh load factor, its spread by tolerance."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.torsion import mesh_slopes
from pitchpoint.cases.built_drive import BuiltTrain
from pitchpoint.cases.drive_schema import TrainTable
from pitchpoint.core.doubts import GUESSED, Doubt
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.loading.planets import PinEquivalents, path_stiffness, planet_forces
from pitchpoint.results.store import dataset

__all__ = ["Sharing", "planet_shares", "sharing_of"]

PERCENTILES = (50.0, 90.0, 99.0)
SAMPLES = 4096
"""Sets of pins that are drawn: some forty of them lie beyond the 99th percentile."""


@dataclass(frozen=True)
class Sharing:
    """How the planets of a train share its load.

    Attributes:
        errors: of the pins along their circle [m].
        forces: on the pins along their circle [N].
        equal: force on each pin if they shared alike [N].
        stiffness: of the way over one planet [N/m].
        drawn: mesh load factors at `PERCENTILES` of sets by tolerance, in any position; none without one.
    """

    errors: Float[np.ndarray, " planet"]
    forces: Float[np.ndarray, " planet"]
    equal: float
    stiffness: float
    drawn: Float[np.ndarray, " percentile"] | None

    @property
    def factor(self) -> float:
        """Mesh load factor K_γ by the errors of the pins alone."""
        return float(self.forces.max() / self.equal)

    @property
    def rated_factor(self) -> float:
        """Mesh load factor that a rating takes: by tolerance that of nearly all sets."""
        return self.factor if self.drawn is None else float(self.drawn[-1])


@lru_cache(maxsize=4)
def planet_shares(built: BuiltTrain) -> Sharing:
    """How the planets of a train share the load of its operating point, see `sharing_of`.

    Args:
        built: the case, with pins out of place.
    """
    train, table, load = built.design, built.case.train, float(built.case.operation.load)
    assert table is not None
    count = round(table.planets)
    meshes = [k for k, mesh in enumerate(train.meshes) if mesh.carrier != HOUSING]
    total = built.pin_step * load
    pin = total / count
    torques = built.steps / np.array(built.copies) * load
    slopes = mesh_slopes(built)
    stiffness = path_stiffness(
        levers=[torques[k] / pin for k in meshes],
        stiffnesses=[slopes[k] for k in meshes],
        pin_stiffness=table.pin_stiffness or np.inf,
    )
    angles, floating = np.asarray(train.angles)[:count], bool(table.floating)
    errors = np.array(table.pin_errors or [0.0] * count)
    forces = planet_forces(total, stiffness, errors, angles, floating=floating)
    drawn = None
    if table.by_tolerance:
        placed = errors + _drawn_errors(built, table, angles)
        every = planet_forces(total, stiffness, placed, angles, floating=floating)
        drawn = np.percentile(every.max(axis=1) / pin, PERCENTILES)
    return Sharing(errors, forces, pin, stiffness, drawn)


def _drawn_errors(
    built: BuiltTrain, table: TrainTable, angles: Float[np.ndarray, " planet"]
) -> Float[np.ndarray, "sample planet"]:
    """Sets by tolerance, each in a position of its gears: deviations as places of pins on their circle [m].

    Pins lie anywhere in their circles and thicknesses in their field alike, gears are off their axes by half
    of their runout at any phase; both gears of stepped planets by themselves.
    """
    random = np.random.default_rng(0)
    size = (SAMPLES, angles.size)

    def phases(shape: tuple[int, ...]) -> np.ndarray:
        return np.asarray(random.uniform(0.0, 2.0 * np.pi, size=shape))

    far = (table.pin_tolerance or 0.0) / 2.0 * np.sqrt(random.uniform(size=size))
    along = phases(size)
    alike = _equivalents(built)
    if alike is None:
        return np.asarray(far * np.cos(along))
    drawn: np.ndarray = alike.of_planet(far, along + np.pi / 2.0)
    stepped = _planet_gears(built) > 1

    if field := table.thickness_tolerance:
        thickness, *stepped_thickness = random.uniform(
            -field / 2.0, field / 2.0, size=(1 + stepped, *size)
        )
        drawn += alike.of_thickness(thickness, *stepped_thickness)
    if table.planet_runout:
        off = table.planet_runout / 2.0
        drawn += alike.of_planet(off, phases(size), phases(size) if stepped else None)
    if table.central_runout:
        off, set_shape = table.central_runout / 2.0, (SAMPLES, 1)
        drawn += alike.of_sun(off, phases(set_shape), angles) + alike.of_ring(
            off, phases(set_shape), angles
        )
    return drawn


def _equivalents(built: BuiltTrain) -> PinEquivalents | None:
    """How deviations of teeth load planets between a sun and a ring; None for others."""
    trains: list[Any] = [
        train_mesh for train_mesh in built.design.meshes if train_mesh.carrier != HOUSING
    ]
    trains.sort(key=lambda train_mesh: bool(train_mesh.link.mesh.internal))
    meshes = [train_mesh.link.mesh for train_mesh in trains]
    if [bool(mesh.internal) for mesh in meshes] != [False, True]:
        return None
    sun, ring = (
        float(np.arccos(np.abs(np.sum(mesh.base_radii)) / float(mesh.centre_distance)))
        for mesh in meshes
    )
    normal, helix = float(meshes[0].pressure_angle), float(meshes[0].helix_angle)
    base_helix = float(np.arcsin(np.sin(helix) * np.cos(normal)))
    (planet,) = built.design.planets
    at_sun, at_ring = (
        float(np.abs(np.asarray(train_mesh.link.mesh.base_radii))[train_mesh.bodies.index(planet)])
        for train_mesh in trains
    )
    return PinEquivalents(sun, ring, normal, base_helix, float(at_ring / at_sun))


def sharing_of(built: BuiltTrain, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Dataset of the part, of a set whose pins are out of place.

    A set that is a stage shares the load that it has without losses behind it, as it is rated. From the
    equilibrium of springs that only push, see `planet_forces`: teeth at the load of the operating
    point in series with the pin, without friction, weight and centrifugal force.
    """
    sharing, table = planet_shares(built), built.case.train
    assert table is not None
    drawn = sharing.drawn
    return dataset(
        {
            "pin_error": (("planet",), sharing.errors),
            "pin_force": (("planet",), sharing.forces),
            "planet_share": (("planet",), sharing.forces / sharing.equal),
            "planet_load_factor": ((), sharing.factor),
            "planet_stiffness": ((), sharing.stiffness),
            **({} if drawn is None else {"drawn_planet_load_factor": (("percentile",), drawn)}),
        },
        {
            "planet": np.arange(1, sharing.errors.size + 1),
            **({} if drawn is None else {"percentile": [*PERCENTILES]}),
        },
        title="sharing of planets",
        warnings=[*_lifted(sharing.forces), *_between_suns(built)],
        floating=table.floating,
        rigid_pins=int(table.pin_stiffness is None),
    )


def _between_suns(built: BuiltTrain) -> list[Doubt]:
    """Planets that are not between a sun and a ring, on which errors along the radius act too."""
    if _equivalents(built) is not None:
        return []
    return [
        Doubt(
            "Errors of pins along the radius, runout and thickness of teeth are left out; planets that are "
            "not between a sun and a ring bear unlike by them too.",
            moves=GUESSED,
            about=("planet_load_factor",),
            brief="Only pins along their circle load these planets unlike here.",
        )
    ]


def _planet_gears(built: BuiltTrain) -> int:
    """Gears that a planet has."""
    members = [member for mesh in built.member_motions for member in mesh]
    return len({member.body for member in members if member.carrier != HOUSING})


def _lifted(forces: np.ndarray) -> list[Doubt]:
    """Planets that carry nothing."""
    free = [str(number) for number, force in enumerate(forces, 1) if force == 0.0]
    if not free:
        return []
    listed = f"planet {free[0]} carries" if len(free) == 1 else f"planets {', '.join(free)} carry"
    return [
        Doubt(
            f"By the errors of the pins {listed} nothing; the others carry the load alone.",
            about=("planet_load_factor",),
            brief=f"By the errors of its pins {listed} nothing.",
        )
    ]
