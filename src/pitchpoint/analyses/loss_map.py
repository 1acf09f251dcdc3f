"""The loss map of a case: mean loss and efficiency over torque, speed and temperature."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress
from pitchpoint.analyses.lacking import untransmitted, without_films
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.core.doubts import Doubt, doubts_of, in_percent
from pitchpoint.core.programs import fast_program, program
from pitchpoint.core.status import locked_or_lost, solve_summary
from pitchpoint.efficiency.film_map import FilmMap, film_map
from pitchpoint.efficiency.in_turns import in_turns
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    cycle,
    cycle_nodes,
    cycle_of,
)
from pitchpoint.efficiency.rows import NODES, one_engagement
from pitchpoint.efficiency.summary import at_points, engaged
from pitchpoint.errors import ConvergenceError
from pitchpoint.loading.balance import Balance
from pitchpoint.loading.loading_registry import LoadSharing
from pitchpoint.lubrication.lubrication_registry import FrictionLaw
from pitchpoint.results.store import dataset

__all__ = [
    "LOSS_MAP",
    "Map",
    "at_torque",
    "film_interpolation_sentence",
    "map_axes",
    "maps",
    "pieces",
]

STATES = 1 << 20
"""Contacts (pairs, slices, nodes of the cycle, operating points) that are computed together at most."""

MANY = 100
"""Points of each torque from which on a program that takes longer to compile saves time."""


def pieces(built: Ready) -> list[Piece]:
    """One for each torque; its share of the load serves all speeds and temperatures."""
    return [{"torque": float(torque)} for torque in map_axes(built)[0]]


@lru_cache(maxsize=1)
def _start(built: Built) -> tuple[Engagement | None, int]:
    """What all torques have in common: contacts, where they are known beforehand, and how many there are."""
    models = built.models[0]
    engagement = engaged(built.design, built.operation, models, NODES)
    length = (
        _line_length(built.design, models.sharing)
        if engagement is None
        else engagement.contacts.weight
    )
    return engagement, int(np.prod(length.shape))


def map_axes(built: Ready) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Torques [N m] or forces [N], speeds [rad/s] and temperatures [K]."""
    loss_map, point = built.case.loss_map, built.case.operation
    count = int(loss_map.count) if loss_map else 9
    torque = (loss_map and (loss_map.torque or loss_map.force)) or 1.5 * point.load or 1.0
    speed = (loss_map and loss_map.speed) or 1.5 * point.speed
    around = point.temperature + np.array([-20.0, 0.0, 20.0])
    degrees = np.unique(np.clip(around, *built.temperatures))
    if loss_map and loss_map.temperatures:
        degrees = np.unique(loss_map.temperatures)
    loads = int(loss_map.torque_count or loss_map.force_count or count) if loss_map else count
    speeds = int(loss_map.speed_count or count) if loss_map else count
    return np.linspace(0.0, torque, loads), np.linspace(0.0, speed, speeds), degrees


def _joined(built: Ready, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The whole map, with what there is to say about it."""
    data = xr.concat(parts, "torque", combine_attrs="override")
    locked = data["locked"].values & (data["torque"].values > 0.0)[:, None, None]
    moving = (data["torque"] > 0.0) & (data["speed"] > 0.0)
    lost = np.isnan(data["mean_efficiency"].where(moving, 1.0).values) & ~locked
    warnings = [
        f"{law.title}: {what} at {where[k].sum()} of {where[k].size} points."
        for what, where in (("friction locks the mesh", locked), ("no balance was found", lost))
        for k, law in enumerate(built.laws)
        if where[k].any()
    ]
    warnings += [*dict.fromkeys(text for part in parts for text in doubts_of(part.attrs))]
    loss_map = dataset(
        {name: (_DIMS, data[name].values) for name in _NAMES},
        {name: (name, data[name].values) for name in _DIMS},
        title="loss map",
        travels=built.travels,
        warnings=warnings,
        solve=solve_summary(locked_or_lost(locked, lost)),
        note="efficiency is undefined (NaN) at zero torque and at zero speed; no power is transmitted",
    )
    loss_map["mean_efficiency"].attrs.update(built.covers)
    return loss_map


def at_torque(built: Ready, piece: Piece, progress: PieceProgress) -> xr.Dataset:
    """The map at one torque."""
    torque, (speeds, degrees) = float(piece["torque"]), map_axes(built)[1:]
    runs = []
    for count, of_law in enumerate(maps(built, torque, speeds, degrees), 1):
        runs.append(of_law)
        progress(count * speeds.size * degrees.size)
    fields = [np.stack(of_laws)[:, None] for of_laws in zip(*runs, strict=True)]
    return dataset(
        {name: (_DIMS, values) for name, values in zip(_NAMES, fields, strict=True)},
        {
            "law": built.law_names,
            "torque": ("torque", [torque]),
            "speed": ("speed", speeds),
            "temperature": ("temperature", degrees),
        },
        warnings=film_interpolation_sentence(built),
    )


def film_interpolation_sentence(built: Ready) -> list[str]:
    """How near the friction of films comes that is interpolated over the map."""
    laws = [law for law in built.laws if law.films is not None]
    return [_solved_films(mesh, law)[1] for law in laws for mesh in built.meshes]


Map = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Loss, efficiency and whether friction locks the mesh, each [speed, temperature]."""


def maps(built: Ready, torque: float, speeds: np.ndarray, degrees: np.ndarray) -> Iterator[Map]:
    """The map at one torque under each friction law; at rest nothing is lost, whatever the laws say.

    Args:
        built: the case.
        torque: that the output carries [N m or N].
        speeds: of the driver [rad/s or m/s].
        degrees: temperatures of the oil [K].
    """
    moving = np.where(speeds > 0.0, speeds, 1.0)
    if built.numbers:
        by_law = _of_drive(built, torque, moving, degrees)
    else:
        by_law = _of_mesh(built.meshes[0], torque, moving, degrees)
    turns = (speeds > 0.0)[:, None]
    for loss, efficiency, locked in by_law:
        yield np.where(turns, loss, 0.0), np.where(turns, efficiency, np.nan), locked


def _of_mesh(built: Built, torque: float, speeds: np.ndarray, degrees: np.ndarray) -> Iterator[Map]:
    point = replace(built.operation, load=array(torque))
    like, lanes = _start(built)
    engagement = engaged(built.design, point, built.models[0], NODES, like)
    engagement = engagement and engagement.loaded()
    together = max(1, min(speeds.size, STATES // (lanes * degrees.size)))
    for models in built.models:
        if models.law.films is None:
            yield _map(built.design, torque, speeds, degrees, models, engagement, together)
        else:
            yield _of_films(built, torque, speeds, degrees, models)


def _of_films(
    built: Built, torque: float, speeds: np.ndarray, degrees: np.ndarray, models: Models
) -> Map:
    """The map at one torque with the friction of films that were solved at few points of the whole map."""
    films, _ = _solved_films(built, models.law)
    engagement, load = _known(built, torque), array(torque)
    if films is None:
        nothing = np.full((speeds.size, degrees.size), np.nan)
        return nothing, nothing, np.zeros(nothing.shape, bool)
    parts = []
    for speed in speeds:
        there = films.at(torque, np.array([speed]), degrees)
        held = models.holding(*map(array, there))
        figures = _figures(built.design, load, array(speed[None]), array(degrees), held, engagement)
        parts.append(jax.device_get(figures))
    loss, efficiency, locked = (np.concatenate(by_speed) for by_speed in zip(*parts, strict=True))
    return loss, efficiency, locked


def _known(built: Built, torque: float) -> Engagement:
    alone = built.models[0].without_friction
    return one_engagement(built.design, array(torque), alone, NODES)


@lru_cache(maxsize=4)
def _solved_films(built: Built, law: FrictionLaw) -> tuple[FilmMap | None, str]:
    """Friction of films over the map, and what there is to say about it."""
    models = next(one for one in built.models if one.law is law)
    engagement_under = lru_cache(lambda load: _known(built, load))
    axes = map_axes(built)
    try:
        films = film_map(built.design, models, *axes, engagement_under)
        errors = [_off(built, models, films, point) for point in films.between]
    except ConvergenceError as error:
        sentence = f"{law.title}: {error}; its part of the map is withheld."
        return None, Doubt(sentence, brief=f"{law.name}: its part of the map is withheld.")
    points, solved = int(np.prod([one.size for one in axes])), films.friction[..., 0, 0, 0].size
    return films, Doubt(
        f"{law.title}: films were solved at {solved} operating points for the {points} of the map, and "
        f"their friction follows a polynomial in between; at {len(errors)} points half way between these the "
        f"mean loss in the teeth is off by up to {in_percent(max(errors))} of that of films solved there.",
        brief=f"Loss map between solved films is off by up to {in_percent(max(errors))}.",
    )


def _off(built: Built, models: Models, films: FilmMap, point: tuple[float, float, float]) -> float:
    """Relative error of the mean loss in the teeth with interpolated friction at a point."""
    load, speed, degree = point
    engagement, design = _known(built, load), replace(built.design, drag=())
    operation = Operation(*map(array, point))
    solved = in_turns(design, operation, models, engagement)
    if solved.lost:
        raise ConvergenceError(solved.lost)
    there = films.at(load, np.array([speed]), np.array([degree]))
    held = models.holding(*(array(condition[:, :, 0, 0]) for condition in there))
    loss = _loss(design, operation, held, engagement)
    return abs(float(loss / _loss_of(design, operation, engagement, solved.balance)) - 1.0)


@program
def _loss(design: Design, operation: Operation, models: Models, known: Engagement) -> Array:
    return cycle(design, operation, models, engaged=known).mean_loss


@program
def _loss_of(design: Design, operation: Operation, known: Engagement, found: Balance) -> Array:
    return cycle_of(design, operation, known, found).mean_loss


def _of_drive(built: Any, torque: float, speeds: np.ndarray, degrees: np.ndarray) -> Iterator[Map]:
    """The same for a drive, by the program of its operating points."""
    points = [
        (built.design, Operation(array(torque), array(speed), array(degree)))
        for speed in speeds
        for degree in degrees
    ]
    for models in built.models:
        figures = built.figures_of(points, models)
        loss, efficiency, locked = (figures[n].reshape(speeds.size, degrees.size) for n in _NAMES)
        yield loss, efficiency, locked


_DIMS = ("law", "torque", "speed", "temperature")
_NAMES = ("mean_loss", "mean_efficiency", "locked")


def _map(
    design: Design,
    torque: float,
    speeds: np.ndarray,
    degrees: np.ndarray,
    models: Models,
    known: Engagement | None,
    together: int,
) -> Map:
    few = speeds.size * degrees.size < MANY
    if few and known is None:
        loss, efficiency, locked = _by_point(design, torque, speeds, degrees, models)
    else:
        compute = partial(_figures if few else _figures_of_many, design, array(torque))
        parts = []
        for start in range(0, speeds.size, together):
            part = speeds[start : start + together]
            filled = np.concatenate([part, np.full(together - part.size, part[-1])])
            figures = compute(array(filled), array(degrees), models, known)
            parts.append([np.asarray(figure)[: part.size] for figure in jax.device_get(figures)])
        loss, efficiency, locked = (np.concatenate(figure) for figure in zip(*parts, strict=True))
    return loss, efficiency, locked


def _by_point(
    design: Design, torque: float, speeds: np.ndarray, degrees: np.ndarray, models: Models
) -> list[np.ndarray]:
    """Loss, efficiency and locking by the program of operating points, which other parts ask for anyway."""
    speed, degree = (values.ravel() for values in np.meshgrid(speeds, degrees, indexing="ij"))
    points = Operation(*map(array, (np.full(speed.size, torque), speed, degree)))
    figures = at_points(design, points, models)
    return [figures[name].reshape(speeds.size, degrees.size) for name in _NAMES]


@program
def _line_length(design: Design, sharing: LoadSharing) -> Array:
    phase, _ = cycle_nodes(design.mesh, sharing, NODES)
    return design.mesh.contacts(phase).weight


@program
def _figures(
    design: Design,
    torque: Float[Array, ""],
    speeds: Float[Array, " speed"],
    degrees: Float[Array, " temperature"],
    models: Models,
    known: Engagement | None,
) -> tuple[Array, Array, Array]:
    speed, degree = jnp.meshgrid(speeds, degrees, indexing="ij")
    points = Operation(jnp.full(speed.shape, torque), speed, degree)
    run = cycle(design, points, models, NODES, known)
    return run.mean_loss, run.mean_efficiency, run.locked


_figures_of_many = fast_program(_figures.function)


LOSS_MAP = Analysis(
    name="loss_map",
    title="loss map",
    of="drive",
    lacks=lambda built: untransmitted(built) or without_films(built),
    compute=at_torque,
    pieces=pieces,
    joined=_joined,
)
