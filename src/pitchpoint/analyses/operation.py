"""The operating point, the friction laws of the library there, and the drive backwards."""

import json
from collections.abc import Iterator, Mapping, Sequence
from math import sqrt
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress
from pitchpoint.analyses.caveats import AtWork, why_outside
from pitchpoint.analyses.lacking import untransmitted
from pitchpoint.analyses.main_figures import (
    CONTACT,
    MAIN,
    REACTIONS,
    TEMPERATURES,
    by_law,
    of_operation,
    out_of_range,
)
from pitchpoint.analyses.plausibility import implausible
from pitchpoint.analyses.summaries import figures_beside_cycle, profiles, summaries
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.core.doubts import FELT, GUESSED, Doubt, doubts_of, in_percent, in_stage, stored
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.results.store import dataset, describe_variables, without_nan
from pitchpoint.results.variables import VARIABLES

__all__ = [
    "BACK_DRIVING",
    "LAWS_THERE",
    "OPERATION",
]

DIFFERS = 1.5
"""Mean friction by two laws in their range, over one another, from which on it is told."""


def _operation(built: Ready, _: Piece, __: PieceProgress) -> xr.Dataset:
    data = summaries([built], built.models, figures_beside_cycle([built]), title="operating point")
    if built.rates_bearings:
        from pitchpoint.analyses import bearing_life  # few cases ask for it

        borne = data["bearing_load"].values[:, 0]
        lives, loads = bearing_life.bearing_lives(built, borne)
        of_bearings = {"bearing_life": lives, "equivalent_bearing_load": loads}
        of_bearings |= bearing_life.bearing_limits(built, borne)
        rated = {
            name: (("law", "point", "place"), array[:, None]) for name, array in of_bearings.items()
        }
        data = data.assign(dataset(rated, {}, title="lives").data_vars)
    beyond = *_implausible(built), *_rated_below(built, data)
    data.attrs.update(stored([*doubts_of(data.attrs), *beyond]))
    return data


def _rated_below(built: Ready, data: xr.Dataset) -> list[str]:
    """Stages that carry more than what they are rated for, since those behind them lose power."""
    names = ("stage_input_torque", "stage_efficiency")
    if names[0] not in data:
        return []
    laws = range(data.sizes["law"])
    under_laws = [built.carried_by_meshes({n: data[n].values[k, 0] for n in names}) for k in laws]
    carried = np.fmax.reduce(under_laws).tolist()  # under the law that asks for most
    return [
        in_stage(number, doubt)
        for number, stage, torque in zip(built.numbers, built.stages, carried, strict=True)
        if not stage.trains
        for mesh in stage.meshes
        if mesh.case.gears.rated
        for doubt in _above(mesh, torque)
    ]


def _above(mesh: Built, torque: float) -> Iterator[Doubt]:
    """How much stresses of a mesh are higher under this torque than under its own load."""
    rated = mesh.case.operation.load
    excess = torque / rated - 1.0 if rated > 0.0 else 0.0
    if excess > FELT:
        roots, flanks = (f"{in_percent(part)}" for part in (excess, sqrt(1.0 + excess) - 1.0))
        under, over = (mesh.carried.show(float(f"{load:.4g}")) for load in (rated, torque))
        yield Doubt(
            f"stresses and safeties are those for {under}, without the losses behind it; it carries {over}, "
            f"under which stresses of roots are {roots} higher and those of flanks {flanks}.",
            moves=excess,
            about=("root_stress", "contact_stress"),
            brief=f"later losses add {flanks} (roots {roots}).",
        )


def _implausible(built: Ready) -> list[str]:
    """What cannot be in the stages of a drive; of one mesh its cycle tells it."""
    return [
        in_stage(label, text)
        for k, (label, mesh) in enumerate(zip(built.mesh_labels, built.meshes, strict=True))
        if label
        for text in _of_mesh(mesh, [models.of_meshes[k] for models in built.models])
    ]


def _of_mesh(mesh: Built, under: Sequence[Models]) -> Sequence[str]:
    return implausible(AtWork(mesh, [models.law for models in under], profiles(mesh, under)))


def _laws(built: Ready, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Every law of the library in its range at the operating point: how far they themselves disagree.

    The attribute `outside` lists the others and the laws of the case that are out of theirs, each with
    its efficiency there and the reasons; `friction_apart` has the least and the largest mean friction by
    these laws and by solved films, where they differ by more than `DIFFERS`.
    """
    every = built.applicable
    others = built.under([law for law in every if law not in built.laws])
    under = {models.law: models for models in (*others, *built.models)}
    considered = [under[law] for law in dict.fromkeys([*every, *built.laws])]
    title = "friction laws that apply"
    data = summaries([built], considered, {}, title=title, may_lock=True)
    reasons = _why_outside(built, considered)
    outside = [
        {
            "law": str(data["law"].values[k]),
            "mean_efficiency": float(data["mean_efficiency"].values[k, 0]),
            "reasons": why,
        }
        for k, why in enumerate(reasons)
        if why
    ]
    within = [k for k, why in enumerate(reasons) if not why]
    holding = [k for k in within if considered[k].law in every]
    solved = [k for k in within if considered[k].law.films is not None]
    drawn = data["mean_friction"].isel(law=[*holding, *solved], point=0)
    names = map(str, drawn["law"].values)
    ends = friction_apart(dict(zip(names, drawn.values.tolist(), strict=True)))
    doubts = [*doubts_of(data.attrs), *(_of_solved(ends) if solved and ends else [])]
    attributes = {"outside": json.dumps(without_nan(outside)), "friction_apart": json.dumps(ends)}
    return data.isel(law=holding).assign_attrs(**attributes, **stored(doubts))


def friction_apart(friction: Mapping[str, float]) -> list[tuple[str, float]]:
    """Names and coefficients of the laws with the least and the largest friction; none where they agree.

    Args:
        friction: mean coefficient by law; laws without friction or without a number do not count.

    Example:
        >>> friction_apart({"xu_2007": 0.06, "ehl_line": 0.02, "frictionless": 0.0, "constant": 0.05})
        [('ehl_line', 0.02), ('xu_2007', 0.06)]
        >>> friction_apart({"xu_2007": 0.06, "iso_tr_14179_2": 0.05})
        []
    """
    ranked = sorted((value, name) for name, value in friction.items() if value > 0.0)
    if not ranked or ranked[-1][0] <= DIFFERS * ranked[0][0]:
        return []
    return [(name, value) for value, name in (ranked[0], ranked[-1])]


def _of_solved(ends: Sequence[tuple[str, float]]) -> list[Doubt]:
    """That solved films and formulas differ, with both numbers."""
    (low, least), (high, most) = ends
    return [
        Doubt(
            f"Friction laws in their range differ by a factor of {most / least:.2g}: the mean coefficient is "
            f"{least:.3g} by {low} and {most:.3g} by {high}. That of solved films hangs on the viscosity of "
            "the oil under pressure, which was measured of few oils.",
            "friction laws",
            most / least,
            moves=GUESSED,
            brief=f"Mean friction {least:.3g} by {low}, {most:.3g} by {high}.",
        )
    ]


def _untried(built: Ready) -> str | None:
    """Why no other friction law is tried."""
    if all(built.mesh_own_friction):
        return "every stage has a friction law of its own, in whose place no other is tried"
    return None


def _why_outside(built: Ready, under: Sequence[Any]) -> list[list[str]]:
    """Why each of some laws does not hold; in a drive the stages where it acts, with their numbers."""
    reasons_by_law: list[list[str]] = [[] for _ in under]
    meshes = zip(built.mesh_own_friction, built.mesh_labels, built.meshes, strict=True)
    for k, (own_friction, label, mesh) in enumerate(meshes):
        if own_friction:
            continue
        acting, place = (
            [models.of_meshes[k] for models in under],
            f"in stage {label} " * bool(label),
        )
        for reasons, models, run in zip(
            reasons_by_law, acting, profiles(mesh, acting), strict=True
        ):
            reasons += [place + reason for reason in why_outside(mesh, models.law, run)]
    return reasons_by_law


def _back_driving(built: Ready, _: Piece, __: PieceProgress) -> xr.Dataset:
    """The loaded member drives at its own speed and carries the same power to the former driver."""
    back = built.backwards
    data = summaries([back], back.models, {}, title="back-driving", may_lock=True)
    for name in ("mean_input_torque", "max_input_torque", "min_input_torque", "torque_ripple"):
        if name in data:
            data[name].attrs["note"] = "of the member that the case loads, which drives here"
    acting, limit = (data[f"nearest_{name}"] for name in ("friction", "jamming_coefficient"))
    margin = np.divide(
        limit.values, acting.values, out=np.full(limit.shape, np.inf), where=acting.values > 0.0
    )
    data[_MARGIN] = limit.dims, margin
    describe_variables(data, {_MARGIN: VARIABLES[_MARGIN]})
    return data


_MARGIN = "self_locking_margin"


def _law_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    laws = parts.get("laws")
    if laws is None:
        return {"friction_laws": {}, "friction_laws_out_of_range": []}
    return {
        "friction_laws": by_law(laws, ("mean_efficiency",)),
        "friction_laws_out_of_range": out_of_range(laws),
    }


def _backward_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Figures by law with the loaded member driving; none where nothing is transmitted."""
    data = parts.get("back_driving")
    names = ("mean_efficiency", "locked", "jamming_coefficient", _MARGIN)
    return {"back_driving": {} if data is None else by_law(data, names)}


OPERATION = Analysis(
    name="operation",
    title="operating point",
    of="drive",
    compute=_operation,
    main=(*MAIN, *CONTACT, *REACTIONS, "bearing_load", "bearing_life", *TEMPERATURES),
    figures=of_operation,
)
LAWS_THERE = Analysis(
    name="laws",
    title="spread of the friction laws",
    of="drive",
    lacks=_untried,
    compute=_laws,
    figures=_law_figures,
)
BACK_DRIVING = Analysis(
    name="back_driving",
    title="back-driving",
    of="drive",
    lacks=untransmitted,
    compute=_back_driving,
    figures=_backward_figures,
)
