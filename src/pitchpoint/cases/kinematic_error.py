"""Kinematic error of a drive by deviations of its teeth, as a dataset of a case."""

from collections.abc import Callable, Iterator

import equinox as eqx
import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.build import Built
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Surfaces
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.compliance import Compliance, compliance
from pitchpoint.loading.kinematic_error import KinematicError, added_gap, kinematic_error
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid
from pitchpoint.programs import program
from pitchpoint.results.store import dataset

__all__ = ["kinematic_error_part"]

PHASES = 2
"""States in each tooth period: four for every wave where a member has as many as it can have."""

TEETH = 32
"""Tooth periods solved together; one compiled program serves any number of them."""

CURVES = ("geometry", "elastic mean", "under load")
SPLINES = ("flexspline", "circular spline")

Over = Callable[[Surfaces, int], np.ndarray]
"""Errors [curve, state] by deviations of both over so many tooth periods."""


class _Period(eqx.Module):
    """One tooth period, which every tooth repeats: its contacts and how they yield at the load."""

    contacts: Contacts
    yields: Compliance
    loaded: Float[Array, " dof"]


def kinematic_error_part(
    built: Built, deviations: Surfaces, progress: Callable[[int], None]
) -> xr.Dataset:
    """Rotation of the loaded member by deviations over one turn of the wave, at the operating torque.

    The turn is that of the wave generator against the circular spline. Orders are those of one
    spline alone, over one turn against it.

    Args:
        built: the case.
        deviations: of flexspline and circular spline.
        progress: told the number of states that are done, after each group of teeth.
    """
    design, gears = built.design, built.case.gears
    assert hasattr(gears, "teeth")
    load = jnp.full((1, 1), built.case.operation.load)
    period = _period(design.mesh, design.solids, built.terms, load)
    teeth = np.asarray(gears.teeth)
    solved: list[np.ndarray] = []

    def over(own: Surfaces, count: int) -> np.ndarray:
        done, found = sum(one.shape[1] for one in solved), []
        for piece in _pieces(design.mesh, period, own, count):
            found.append(piece)
            progress(done + min(len(found) * TEETH, count) * PHASES)
        solved.append(np.concatenate(found, axis=1)[:, : count * PHASES])
        return solved[-1]

    alone = [_alone(over, deviations, spline, teeth) for spline in (0, 1)]
    together = _together(over, deviations, alone, teeth)
    order = np.arange(PHASES * int(teeth.min()) // 2 + 1)
    under_load = np.concatenate([one[-1] for one in solved])
    lost = int(np.isnan(under_load).sum())
    told = [f"Kinematic error: no equilibrium was found in {lost} of {under_load.size} states."]
    return dataset(
        {
            "wave_angle": (("state",), np.arange(together.shape[1]) * _step(teeth)),
            "kinematic_error": (("curve", "state"), together),
            "kinematic_error_spectrum": (
                ("curve", "spline", "order"),
                np.stack([_amplitudes(one, order.size) for one in alone], axis=1),
            ),
            "kinematic_error_range": (
                ("curve", "cause"),
                np.stack([np.ptp(one, axis=1) for one in (*alone, together)], axis=1),
            ),
        },
        {
            "curve": [*CURVES],
            "spline": [*SPLINES],
            "cause": [*SPLINES, "both"],
            "order": ("order", order),
        },
        title="kinematic error",
        warnings=told if lost else [],
    )


def _step(teeth: np.ndarray) -> float:
    """Turn of the wave generator against the circular spline between two states [rad]."""
    return float(2.0 * np.pi / (teeth[1] * PHASES))


def _alone(over: Over, deviations: Surfaces, spline: int, teeth: np.ndarray) -> np.ndarray:
    """Errors [curve, state] with deviations of one spline alone over one turn against it."""
    count = int(teeth[spline])
    if not deviations[spline]:
        return np.zeros((len(CURVES), count * PHASES))
    own = (deviations[0], ()) if spline == 0 else ((), deviations[1])
    return over(own, count)


def _together(
    over: Over, deviations: Surfaces, alone: list[np.ndarray], teeth: np.ndarray
) -> np.ndarray:
    """Errors [curve, state] with both over one turn against the circular spline."""
    count = int(teeth[1])
    given = [bool(one) for one in deviations]
    if all(given):
        return over(deviations, count)
    own = alone[given.index(True)]
    return np.take(own, np.arange(count * PHASES), axis=1, mode="wrap")


def _pieces(mesh: Mesh, period: _Period, deviations: Surfaces, count: int) -> Iterator[np.ndarray]:
    for start in range(0, count, TEETH):
        # A wave generator that turns on meets teeth of growing angle, and phases fall.
        phase = -(start + np.arange(TEETH)[:, None] + np.arange(PHASES) / PHASES)
        added = _added(mesh, period, deviations, jnp.asarray(phase))
        found = jax.device_get(_errors(period, added))
        each = (found.geometric, found.elastic_mean, found.under_load)
        yield np.stack([values.ravel() for values in each])


def _amplitudes(errors: np.ndarray, orders: int) -> np.ndarray:
    """Amplitudes [curve, order] of errors over one turn; that of order zero is the mean."""
    lines = 2.0 * np.abs(np.fft.rfft(errors, axis=1)) / errors.shape[1]
    lines[:, 0] /= 2.0
    return np.asarray(lines[:, :orders])


@program
def _period(mesh: Mesh, solids: tuple[Solid, Solid], terms: Terms, load: Array) -> _Period:
    contacts = mesh.contacts(-jnp.arange(PHASES)[None] / PHASES)
    yields = compliance(mesh, contacts, solids, terms, load)
    return _Period(contacts, yields, mesh.loaded)


@program
def _added(
    mesh: Mesh, period: _Period, deviations: Surfaces, phase: Float[Array, "tooth phase"]
) -> Float[Array, "pair slice tooth phase"]:
    return added_gap(deviations, mesh.spots(period.contacts, phase))


@program
def _errors(period: _Period, added: Float[Array, "pair slice tooth phase"]) -> KinematicError:
    return kinematic_error(period.contacts, period.yields, period.loaded, added)
