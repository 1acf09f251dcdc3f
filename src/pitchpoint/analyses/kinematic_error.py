"""Kinematic error of a drive by deviations of its teeth, as a dataset of a case."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any
from weakref import WeakKeyDictionary

import equinox as eqx
import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.main_figures import error_ranges, numbers
from pitchpoint.cases.built import Built
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Surfaces
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import looping_program, program
from pitchpoint.core.status import locked_or_lost, solve_summary
from pitchpoint.gears.family import Turning
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import nominal_motion, phase_sense
from pitchpoint.loading.compliance import Compliance, compliance
from pitchpoint.loading.mesh_kinematic_error import KinematicError, added_gap, kinematic_error
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid
from pitchpoint.results.store import dataset

__all__ = ["deviation_error", "error_figures", "error_of", "kinematic_error_part"]

PHASES = 2
"""States in each tooth period of bodies that couple many teeth: four for every wave of the highest order."""

FEW_PAIRS = 8
"""The same where a few pairs hand over to each other."""

TEETH = 32
"""Tooth periods solved together; one compiled program serves any number of them."""

CURVES = ("geometry", "elastic mean", "under load")

Over = Callable[[Surfaces, int], np.ndarray]
"""Errors [curve, state] by deviations of both over so many tooth periods."""


class _Period(eqx.Module):
    """One tooth period, which every tooth repeats: its contacts and how they yield at the load."""

    contacts: Contacts
    yields: Compliance
    sense: Float[Array, ""]


def kinematic_error_part(
    built: Built, deviations: Surfaces, progress: Callable[[int], None]
) -> xr.Dataset:
    """Rotation of the loaded member by deviations at the operating torque.

    Those of both members count over one turn of the member with the most teeth, which is that of a wave
    generator against its circular spline. Orders are those of one member alone, over one turn of it.

    Args:
        built: the case.
        deviations: of both members.
        progress: told the number of states that are done, after each group of teeth.
    """
    design, gears = built.design, built.case.gears
    load = array(np.full((1, 1), built.case.operation.load))
    phases = PHASES if design.mesh.body.couples else FEW_PAIRS
    period = _period(
        design.mesh, (design.driver, design.loaded), design.solids, built.terms, load, phases
    )
    teeth = np.asarray(gears.tooth_numbers)
    solved: list[np.ndarray] = []

    def over(own: Surfaces, count: int) -> np.ndarray:
        done, pieces = sum(errors.shape[1] for errors in solved), []
        for piece in _pieces(design.mesh, period, own, count):
            pieces.append(piece)
            progress(done + min(len(pieces) * TEETH, count) * phases)
        solved.append(np.concatenate(pieces, axis=1)[:, : count * phases])
        return solved[-1]

    states = teeth.astype(int) * phases
    alone = [_alone(over, deviations, member, int(teeth[member]), phases) for member in (0, 1)]
    most = int(np.argmax(teeth))
    together = _together(over, deviations, alone, int(teeth[most]), phases)
    order = np.arange(int(teeth.min()) + 1)
    under_load = np.concatenate([one[-1] for one in solved])
    lost = int(np.isnan(under_load).sum())
    doubts = [
        Doubt(
            f"Kinematic error: no equilibrium was found in {lost} of {under_load.size} states.",
            brief=f"Kinematic error: none found in {lost} of {under_load.size} states.",
        )
    ]
    members = [one.body for one in built.bodies if one.member is not None]
    error_course = dataset(
        {
            "turn_angle": (("state",), np.arange(states[most]) * 2.0 * np.pi / states[most]),
            "kinematic_error": (("curve", "state"), together),
            "kinematic_error_spectrum": (
                ("curve", "member", "order"),
                np.stack([_amplitudes(one, order.size) for one in alone], axis=1),
            ),
            "kinematic_error_range": (
                ("curve", "cause"),
                np.stack([np.ptp(one, axis=1) for one in (*alone, together)], axis=1),
            ),
        },
        {
            "curve": [*CURVES],
            "member": members,
            "cause": [*members, "both"],
            "order": ("order", order),
        },
        title="kinematic error",
        travels=built.travels,
        warnings=doubts if lost else [],
        solve=solve_summary(locked_or_lost(False, np.isnan(under_load))),
        **_turns(built.family.turning, members[most]),
    )
    error_course["turn_angle"].attrs.update(long_name=error_course.attrs["turn_angle"])
    return error_course


def _turns(turning: Turning, most: str) -> dict[str, str]:
    """Words of the turns, see `Turning`; `own_turn` keeps its place for the member."""
    return {
        "turn": turning.whole.format(most),
        "turn_angle": turning.angle.format(most),
        "own_turn": turning.own,
        "turn_alone": turning.alone,
        "note": turning.note,
    }


def _alone(over: Over, deviations: Surfaces, member: int, teeth: int, phases: int) -> np.ndarray:
    """Errors [curve, state] with deviations of one member alone over one turn of it."""
    if not deviations[member]:
        return np.zeros((len(CURVES), teeth * phases))
    surfaces = (deviations[0], ()) if member == 0 else ((), deviations[1])
    return over(surfaces, teeth)


def _together(
    over: Over, deviations: Surfaces, alone: list[np.ndarray], teeth: int, phases: int
) -> np.ndarray:
    """Errors [curve, state] with both over one turn of the member with the most teeth."""
    deviating = [bool(surfaces) for surfaces in deviations]
    if all(deviating):
        return over(deviations, teeth)
    curves = alone[deviating.index(True)]
    return np.take(curves, np.arange(teeth * phases), axis=1, mode="wrap")


def _pieces(mesh: Mesh, period: _Period, deviations: Surfaces, count: int) -> Iterator[np.ndarray]:
    phases = period.contacts.path.shape[-1]
    for start in range(0, count, TEETH):
        turned = start + np.arange(TEETH)[:, None] + np.arange(phases) / phases
        added = _added(mesh, period, deviations, array(turned))
        errors = jax.device_get(_errors(period, added))
        curves = (errors.geometric, errors.elastic_mean, errors.under_load)
        yield np.stack([values.ravel() for values in curves])


def _amplitudes(errors: np.ndarray, orders: int) -> np.ndarray:
    """Amplitudes [curve, order] of errors over one turn; that of order zero is the mean."""
    lines = 2.0 * np.abs(np.fft.rfft(errors, axis=1)) / errors.shape[1]
    lines[:, 0] /= 2.0
    return np.asarray(lines[:, :orders])


@program
def _period(
    mesh: Mesh,
    ends: tuple[Array, Array],
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Array,
    phases: int,
) -> _Period:
    sense, loaded = phase_sense(mesh, nominal_motion(mesh, *ends)), ends[1]
    contacts = mesh.contacts(sense * jnp.arange(phases)[None] / phases)
    yields = compliance(mesh, loaded, contacts, solids, terms, load)
    return _Period(contacts, yields, sense)


@program
def _added(
    mesh: Mesh, period: _Period, deviations: Surfaces, turned: Float[Array, "tooth phase"]
) -> Float[Array, "pair slice tooth phase"]:
    return added_gap(deviations, mesh.spots(period.contacts, period.sense * turned))


@looping_program
def _errors(period: _Period, added: Float[Array, "pair slice tooth phase"]) -> KinematicError:
    return kinematic_error(period.contacts, period.yields, added)


_FOUND: WeakKeyDictionary[Built, xr.Dataset] = WeakKeyDictionary()


def deviation_error(built: Built, progress: PieceProgress) -> xr.Dataset:
    """Kinematic error by the deviations of a case, computed once for all that ask.

    Args:
        built: the case.
        progress: as in `kinematic_error_part`.
    """
    if built not in _FOUND:
        _FOUND[built] = kinematic_error_part(built, built.deviations, progress)
    return _FOUND[built]


def error_of(built: Built, _: Piece, progress: PieceProgress) -> xr.Dataset:
    """Dataset of the part."""
    return deviation_error(built, progress)


def error_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Entries of `--json`."""
    rows = error_ranges(parts.get("kinematic_error"))
    ranges = {curve: dict(zip(c, numbers(v), strict=True)) for curve, c, v in rows}
    return {"kinematic_error_range": ranges}
