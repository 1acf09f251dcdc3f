"""What a strain wave gear bears, by named estimates: stress of its flexspline, margins, bearing life."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.cases.built import Built
from pitchpoint.core.doubts import fails
from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.gears.strain_wave.strength_estimates import (
    bearing_life,
    curvature_change,
    face_stress,
    flexspline_torque,
    goodman_safety,
    of_other_size,
    rated_life_torque,
    torque_by_goodman,
    tube_shear,
    von_mises,
)
from pitchpoint.gears.strain_wave.table import LoadLimits, StrainWaveGears
from pitchpoint.results.store import dataset

__all__ = ["load_limits_of", "load_limits_part"]

PLACES = ("rim under the teeth", "wall of the cup, at its open end")
AGAINST = ("ratcheting", "buckling")

ESTIMATE = (
    "An estimate: a thin smooth ring bent to its wave, E t/2 times the change of its curvature, and a thin "
    "tube under the torque of the operating point without losses, which is {}. Left out are the teeth, "
    "which stiffen the rim and notch it, the cone to which the wave bends the cup, its bottom, and tooth "
    "forces that bend the rim: peaks are higher."
)


def load_limits_of(built: Built, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Dataset of the part."""
    return load_limits_part(built)


def load_limits_part(built: Built) -> xr.Dataset:
    """Stresses of the flexspline, and margins that follow from what a case gives.

    Args:
        built: a case of a strain wave gear.
    """
    gears, mesh = built.case.gears, _mesh(built)
    assert isinstance(gears, StrainWaveGears)
    limits, loaded = gears.limits, built.case.operation.load
    torque = flexspline_torque(loaded, built.loaded, gears.tooth_numbers)
    stresses = _stresses(built, limits, torque)
    against = _against(limits, torque, mesh.pitch_diameter)
    life = _life(built, limits, torque)
    there = None if life is None else _life(built, _at_operation(limits), torque)
    return dataset(
        {
            **{name: (("place",), value) for name, value in stresses.items()},
            **{name: (("against",), value) for name, value in against.items()},
            "flexspline_torque": ((), torque),
            **({} if life is None else {"bearing_life": ((), life)}),
            **({} if there == life else {"operating_bearing_life": ((), there)}),
            **({} if there is None else {"rated_life_torque": ((), _lasting(built, limits))}),
        },
        {"place": [*PLACES], **({"against": [*AGAINST]} if against else {})},
        title="load limits",
        bearing="wave generator",
        warnings=[*_failing(stresses, against)],
        note=ESTIMATE.format(_SENSES[limits.torque]),
        concentrations=[limits.bending_concentration, limits.shear_concentration],
        scaled=int(limits.catalogue_diameter is not None),
    )


_SENSES = {"steady": "steady", "reversing": "reversed at its full height"}


def _mesh(built: Built) -> Any:
    return built.design.mesh


def _stresses(built: Built, limits: LoadLimits, torque: float) -> dict[str, np.ndarray]:
    """Strain, stresses and what follows from strengths that are given, at each of `PLACES`."""
    mesh, young = _mesh(built), float(built.solids[0].solid.young)
    radius = float(mesh.rim.radius)
    thickness = np.array([float(mesh.rim.thickness), float(mesh.rim.wall_thickness)])
    bent = curvature_change(
        np.linspace(0.0, np.pi, 721),
        radius=float(mesh.line.radius),
        deflection=float(mesh.line.deflection),
        weights=np.asarray(mesh.line.weights),
    )
    swing, middle = np.ptp(bent) / 2.0, (bent.max() + bent.min()) / 2.0
    notched = limits.bending_concentration * young
    amplitude = face_stress(young=notched, thickness=thickness, curvature=swing)
    bending = face_stress(young=notched, thickness=thickness, curvature=middle)
    per_torque = limits.shear_concentration * tube_shear(
        torque=1.0, radius=radius, thickness=thickness
    )
    reversing = limits.torque == "reversing"
    swinging, steady = (torque, 0.0) if reversing else (0.0, torque)
    alternating = von_mises(normal=amplitude, shear=swinging * per_torque)
    mean = von_mises(normal=bending, shear=steady * per_torque)
    stresses = {
        "bending_strain": thickness / 2.0 * np.abs(bent).max(),
        "bending_amplitude": amplitude,
        "alternating_stress": alternating,
        "mean_bending_stress": bending,
        "torsional_stress": torque * per_torque,
        "mean_stress": mean,
    }
    if limits.endurance_limit is None or limits.tensile_strength is None:
        return stresses
    strengths = {
        "endurance_limit": limits.endurance_limit,
        "tensile_strength": limits.tensile_strength,
    }
    return stresses | {
        "goodman_safety": goodman_safety(alternating=alternating, mean=mean, **strengths),
        "goodman_torque": torque_by_goodman(
            alternating=amplitude,
            mean_bending=bending,
            shear_per_torque=per_torque,
            **strengths,
            reversing=reversing,
        ),
    }


def _against(limits: LoadLimits, torque: float, diameter: float) -> dict[str, np.ndarray]:
    """Torques of a maker at this size over the one on the flexspline, for each of `AGAINST`."""
    limit_torques = (limits.ratcheting_torque, limits.buckling_torque)
    if limit_torques == (None, None):
        return {}
    catalogue_size = limits.catalogue_diameter or diameter
    torques = np.array(
        [
            np.nan if limit is None else of_other_size(limit, size=diameter, known=catalogue_size)
            for limit in limit_torques
        ]
    )
    with np.errstate(divide="ignore"):
        return {"limit_torque": torques, "limit_margin": np.divide(torques, torque)}


def _turning(built: Built) -> float:
    """Speed of the wave generator against the circular spline [rad/s]."""
    motion = built.nominal["motion"]
    turns = abs(float(motion[0] - motion[MEMBERS.index("circular spline")]))
    return float(built.case.operation.speed) * turns


def _lasting(built: Built, limits: LoadLimits) -> float:
    """Torque of the flexspline at which the bearing has its rated life at the speed of operation [N m]."""
    assert limits.rated_torque is not None and limits.rated_speed is not None
    return rated_life_torque(
        rated_torque=limits.rated_torque, rated_speed=limits.rated_speed, speed=_turning(built)
    )


def _life(built: Built, limits: LoadLimits, torque: float) -> float | None:
    """Life of the wave generator's bearing [s]; None where no rating is given."""
    if limits.rated_life is None or limits.rated_torque is None or limits.rated_speed is None:
        return None
    return bearing_life(
        rated_life=limits.rated_life,
        rated_torque=limits.rated_torque,
        rated_speed=limits.rated_speed,
        torque=limits.average_torque or torque,
        speed=limits.average_speed or _turning(built),
    )


def _at_operation(limits: LoadLimits) -> LoadLimits:
    """The same with torque and speed of the operating point as averages."""
    return limits.model_copy(update={"average_torque": None, "average_speed": None})


def _failing(stresses: dict[str, np.ndarray], against: dict[str, np.ndarray]) -> Iterator[str]:
    """What does not hold, in words."""
    safety = stresses.get("goodman_safety")
    if safety is not None and safety.min() < 1.0:
        yield fails(
            f"the flexspline breaks sooner or later by the estimate of its stress: at the "
            f"{PLACES[int(safety.argmin())]} its safety for endless life is {safety.min():.2f}.",
            f"the flexspline breaks sooner or later, safety {safety.min():.2f}.",
        )
    for name, margin in zip(AGAINST, against.get("limit_margin", ()), strict=False):
        if margin < 1.0:
            yield fails(f"the torque on the flexspline is {1.0 / margin:.2f} times that of {name}.")
