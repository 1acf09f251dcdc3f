"""Wind-up of a drive whose teeth come to mesh under load, as a dataset of a case."""

from dataclasses import replace

import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.build import Built, laws_of
from pitchpoint.cases.schema import TORQUE
from pitchpoint.efficiency.quasi_static import Engagement, Models, engagement
from pitchpoint.efficiency.summary import summarise
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.loading.torsion import hysteresis, torsion
from pitchpoint.materials.solids import Solid
from pitchpoint.programs import program
from pitchpoint.results.store import dataset

__all__ = ["torsion_part"]

TORQUES = 25
SHOWN = 3
"""Every so many phases the load on every tooth is kept."""


def torsion_part(built: Built) -> xr.Dataset:
    """Wind-up, stiffness and load on every pair for torques up to twice that of the operating point."""
    models, chosen = laws_of(built)
    torques = np.linspace(0.0, 2.0 * built.case.operation.torque or 1.0, TORQUES)
    friction = _mean_friction(built, models, chosen)
    known = engagement(built.design, built.operation.load, models)
    found = jax.device_get(
        _torsion(
            built.design.mesh,
            built.design.solids,
            models.compliance,
            known,
            jnp.asarray(torques),
            jnp.asarray(friction),
        )
    )
    dims = {
        "tooth_angle": ("phase", "pair"),
        "tooth_force": ("torque", "phase", "pair"),
        "zone_load": ("torque", "zone"),
        "loading_torque": ("law", "torque"),
        "unloading_torque": ("law", "torque"),
    }
    data = {name: (dims.get(name, ("torque",)), values) for name, values in found.items()}
    yields, rigid = _yielding(built.design.mesh)
    part = dataset(
        {**data, "mean_friction": (("law",), friction)},
        {
            "law": [models.friction[law].name for law in chosen],
            "torque": ("torque", torques),
            "phase": ("phase", np.asarray(known.phase[::SHOWN])),
        },
        title="torsion",
        warnings=[*_lost(found["wind_up"], torques), *_loopless(built, friction)],
        note=f"{yields} yield; {rigid} are not in it",
    )
    part["torsional_stiffness"].attrs.update(covers=yields)
    return part


def _yielding(mesh: Mesh) -> tuple[str, str]:
    """What yields, and what is left out, in words."""
    if mesh.ring is None or np.isinf(mesh.ring.support_stiffness):
        return "teeth, ring and cup of the flexspline", "bearings, shafts, flange and joints"
    return (
        "teeth, ring and cup of the flexspline and the bearing inside it",
        "the clearance of that bearing, shafts, flange and joints",
    )


def _lost(wind_up: np.ndarray, torques: np.ndarray) -> list[str]:
    """Torques at which teeth, ring and cup found no equilibrium."""
    lost = torques[np.isnan(wind_up)]
    if not lost.size:
        return []
    between = " to ".join(dict.fromkeys(TORQUE.show(torque) for torque in (lost[0], lost[-1])))
    return [
        f"Wind-up: no equilibrium was found at {lost.size} of {torques.size} torques ({between}); they are "
        "left out."
    ]


def _loopless(built: Built, friction: np.ndarray) -> list[str]:
    """Why a loop of torque over wind-up has no width, or is not there."""
    models, chosen = laws_of(built)
    if built.case.operation.torque == 0.0:
        return [
            "Wind-up: nothing is carried at the operating point, so the coefficient of friction is taken "
            "as zero and the torque loop has no width."
        ]
    return [
        f"Wind-up: {models.friction[law].title}: friction locks the drive at the operating point; there is "
        "no torque loop."
        for law, value in zip(chosen, friction, strict=True)
        if np.isnan(value)
    ]


def _mean_friction(built: Built, models: Models, laws: tuple[int, ...]) -> np.ndarray:
    """Coefficient at the operating point by each law, as for sliding that begins anew."""
    point = [(built.design, built.operation)]
    runs = [summarise(point, replace(models, choice=jnp.asarray(law))) for law in laws]
    return np.array([run["mean_friction"][0] for run in runs])


@program
def _torsion(
    mesh: Mesh,
    solids: tuple[Solid, Solid],
    terms: Terms,
    known: Engagement,
    torques: Float[Array, " torque"],
    friction: Float[Array, " law"],
) -> dict[str, Array]:
    contacts, _ = known.of_rank(2)
    found = torsion(mesh, solids, terms, torques[:, None], known.phase[None], contacts)
    loop = hysteresis(found, friction[:, None, None])

    def mean(values: Array) -> Array:
        return values @ known.weight

    return {
        "wind_up": mean(found.wind_up),
        "wind_up_range": jnp.ptp(found.wind_up, axis=-1),
        "torsional_stiffness": mean(found.stiffness),
        "loaded_pairs": mean(found.loaded_pairs),
        "zone_load": mean(found.radial_load).T,
        "tooth_angle": 2.0 * jnp.pi * known.contacts.path[:, 0, ::SHOWN].T,
        "tooth_force": jnp.moveaxis(jnp.sum(found.force, axis=1), 0, -1)[:, ::SHOWN],
        "loading_torque": mean(loop.loading),
        "unloading_torque": mean(loop.unloading),
    }
