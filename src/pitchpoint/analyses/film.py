"""Films of the contacts of a mesh solved over its cycle, beside film laws and friction laws."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array

from pitchpoint._jax import jax, jnp
from pitchpoint.analyses.analysis import Piece, Progress
from pitchpoint.analyses.caveats import cold_warning, conformal_warning
from pitchpoint.cases.build import Built, tooth_size
from pitchpoint.cases.schema import FilmTable
from pitchpoint.contact.contacts import Contacts
from pitchpoint.efficiency.in_turns import balance_under
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    cycle_nodes,
    cycle_of,
)
from pitchpoint.efficiency.rows import one_engagement
from pitchpoint.efficiency.summary import engaged
from pitchpoint.loading.balance import Balance
from pitchpoint.lubrication.conditions import Conditions, evaluate, shape_of
from pitchpoint.lubrication.ehl.conduction import ISOTHERMAL
from pitchpoint.lubrication.ehl.doubts import extent_of, kind_of
from pitchpoint.lubrication.ehl.fields import LineFilm
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.lubrication.film_thickness import FILM_THICKNESS, FilmThickness
from pitchpoint.programs import program
from pitchpoint.results.store import dataset
from pitchpoint.status import Code
from pitchpoint.status import told as told_of

__all__ = ["film_part", "joined", "pieces"]

Done = Callable[[int, int], None]
"""Told the number of contacts that are done, and that of all."""

TOGETHER = 6
"""Phases of a piece, so that little is lost when a run is stopped."""

LEAST = 1e-6
"""Load per length over the largest one of the cycle below which a contact counts as unloaded."""

ALIKE = 11
"""Digits to which contacts are alike and solved once: those of both ends of a wave, say."""

SHOWN_ALIKE = 6
"""Digits to which pairs carry alike and one of them is shown."""

SHOWN = 4
"""Pairs whose profiles are kept: those that carry most."""

_LANES = ("phase", "pair", "slice")
_OF_PIECE = ("point", "pair", "slice")
_OF_PROFILE = ("point", "shown", "node")
_MASKED = ("pressure", "friction", "film_by_law")
_PROFILES = {
    "profile_place": "x",
    "profile_film": "gap",
    "profile_pressure": "pressure",
    "profile_asperity_pressure": "asperity_pressure",
}
_WARM_PROFILES = {
    "profile_rise": "film",
    "profile_surface_rise_1": "surface_a",
    "profile_surface_rise_2": "surface_b",
}
"""Profiles of films that are solved with their heat, which are along the same places."""


def _asked(built: Built) -> FilmTable:
    assert built.case.film is not None
    return built.case.film


def _laws() -> list[FilmThickness]:
    """Film laws that hold for line contacts."""
    return [law for law in FILM_THICKNESS.values() if shape_of(law) == "line"]


# ---- contacts of the cycle


@lru_cache(maxsize=2)
def _states(built: Built) -> dict[str, np.ndarray]:
    """What the contacts of a cycle carry and how they move, [phase, pair, slice].

    Forces are those of the first friction law; what a law says, with an axis for all laws in front, stands
    under its own forces.
    """
    known = _known(built)
    each = [_under(built, known, models) for models in built.models]
    pairs, cycle = each[0]
    pairs |= {name: np.stack([one[name] for one, _ in each]) for name in _OF_LAW}
    loaded = pairs["active"] & (pairs["line_load"] > LEAST * pairs["line_load"].max())
    return {**pairs, **cycle, "loaded": loaded}


_OF_LAW = ("friction", "sliding_loss", "rolling_loss", "load_by_law")


def _known(built: Built) -> Engagement:
    """Contacts and shares over the cycle."""
    given, nodes = (built.design, built.operation), _nodes(built)
    known = engaged(*given, built.models[0], nodes)
    alone = built.models[0].without_friction
    return known or one_engagement(built.design, built.operation.load, alone, nodes)


def _under(
    built: Built, known: Engagement, models: Models
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Contacts and cycle in balance under one friction law."""
    given = built.design, built.operation
    found, _ = balance_under(*given, known, models)
    lanes, cycle = jax.device_get(_computed(*given, replace(known, body=None), found))
    return {name: _in_pairs(built, values) for name, values in lanes.items()}, cycle


def _nodes(built: Built) -> int:
    """Nodes in each segment between events, so that there are as many phases as asked for."""
    sharing = built.models[0].sharing
    shape = jax.eval_shape(lambda mesh: cycle_nodes(mesh, sharing, 3)[0], built.design.mesh)
    segments = int(shape.size) // 3
    return max(3, -(-int(_asked(built).phases) // segments))


@program
def _computed(
    design: Design, operation: Operation, known: Engagement, found: Balance
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Values at the contacts [..., pair, slice, node], and those of the whole mesh [node]."""
    cycle = cycle_of(design, operation, known, found)
    state, at, contacts = cycle.state, cycle.state.conditions, cycle.state.contacts
    lanes = {
        "active": contacts.active,
        "path": contacts.path,
        "weight_of_line": contacts.weight,
        "radius": contacts.radius,
        **_of_load(at, contacts),
        "load_by_law": state.balance.load,
        "friction": state.balance.friction,
        "sliding_loss": state.sliding_loss,
        "rolling_loss": state.rolling_loss,
        "film_by_law": jnp.stack([evaluate(law, at) for law in _laws()]),
    }
    shape = contacts.active.shape
    whole = {"drag_loss": state.drag_loss, "output_power": state.output_power}
    courses = {name: jnp.broadcast_to(v, cycle.phase.shape) for name, v in whole.items()}
    courses |= {"phase": cycle.phase, "weight": cycle.weight}
    return {name: _spread(values, shape) for name, values in lanes.items()}, courses


def _of_load(at: Conditions, contacts: Contacts) -> dict[str, Array]:
    """What a contact carries and how its surfaces move; nothing where a pair is not in contact."""
    values = {
        "load": at.load,
        "line_load": at.line_load,
        "pressure": at.pressure,
        "speed_a": at.speed_a,
        "speed_b": at.speed_b,
    }
    return {name: jnp.where(contacts.active, one, 0.0) for name, one in values.items()}


def _spread(values: Array, shape: tuple[int, ...]) -> Array:
    return jnp.broadcast_to(values, (*values.shape[: values.ndim - 3], *shape))


def _in_pairs(built: Built, values: np.ndarray) -> np.ndarray:
    """Values [..., pair, slice, node] as [..., node, pair, slice] of the pairs that the mesh holds."""
    ordered = np.moveaxis(np.asarray(values), -1, -3)
    return built.design.mesh.in_pairs(ordered, ordered.ndim - 2)


# ---- pieces


def pieces(built: Built) -> Iterator[Piece]:
    """Ranges of phases."""
    every = _states(built)["phase"].size
    for first in range(0, every, TOGETHER):
        yield {"first": first, "count": min(TOGETHER, every - first)}


def film_part(built: Built, piece: Piece, progress: Progress) -> xr.Dataset:
    """Films of all contacts at some phases."""
    states = _states(built)
    taken = slice(piece["first"], piece["first"] + piece["count"])
    some = {name: states[name][taken] for name in (*_GIVEN, "loaded", "load", "weight_of_line")}
    first, count = piece["first"], piece["count"]
    done = lambda part, every: progress(first + count * part // every)  # noqa: E731
    films, codes, back = _solved(built, some, done)
    values = _values(films.film, some, back)
    rq = float(built.design.roughness.composite_rq)
    values["minimum_lambda"] = (
        values["minimum_film"] / rq if rq > 0.0 else values["minimum_film"] * np.inf
    )
    profiles = _kept(films.film, states, some, back)
    return dataset(
        {
            **{name: (_OF_PIECE, one) for name, one in values.items()},
            "film_status": (_OF_PIECE, codes),
            **{name: (_OF_PROFILE[: one.ndim], one) for name, one in profiles.items()},
        },
        {},
        warnings=list(films.warnings),
        doubts=[[kind_of(text), extent_of(text)] for text in films.warnings],
        residual=_largest(films.ended.reynolds, films.solved),
        iterations=int(np.max(films.ended.iterations, initial=0)),
    )


def _largest(values: Any, solved: np.ndarray) -> float:
    return float(np.max(np.asarray(values)[solved], initial=0.0))


_GIVEN = ("line_load", "radius", "speed_a", "speed_b")
"""What tells one contact of a mesh from another."""


def _solved(
    built: Built, some: Mapping[str, np.ndarray], done: Done
) -> tuple[Films, np.ndarray, np.ndarray]:
    """Films of the contacts that differ, codes [phase, pair, slice], and which film belongs to each lane."""
    loaded = some["loaded"]
    every = np.stack([some[name][loaded] for name in _GIVEN], axis=-1)
    if not every.size:
        every = np.array([[0.0, 1.0, 0.0, 0.0]])
    scale = np.max(np.abs(every), axis=0)
    rounded = np.round(every / np.where(scale > 0.0, scale, 1.0), ALIKE)
    _, where, inverse = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    films = _films(built, every[where], done)
    back = np.full(loaded.shape, -1)
    back[loaded] = inverse.reshape(-1)[: loaded.sum()]
    codes = np.where(back < 0, int(Code.UNLOADED), np.asarray(films.ended.code)[back])
    return films, codes, back


def _model(built: Built) -> FilmModel:
    assert built.film_model is not None
    return built.film_model


def _films(built: Built, given: np.ndarray, done: Done) -> Films:
    model, design = _model(built), built.design
    contacts = model.contacts(
        **dict(zip(_GIVEN, given.T, strict=True)),
        modulus=float(design.modulus),
        oil=design.lubricant,
        temperature=float(built.operation.temperature),
        roughness_rq=float(design.roughness.composite_rq),
    )
    size = tooth_size(design.mesh)
    return solve_lines(contacts, nodes=model.nodes, size=size, progress=done)


def _values(
    film: LineFilm, some: Mapping[str, np.ndarray], back: np.ndarray
) -> dict[str, np.ndarray]:
    """What follows from the films, for every lane; not a number where there is none."""

    def lane(values: Any) -> np.ndarray:
        return np.where(back < 0, np.nan, np.asarray(values)[back])

    sliding = some["speed_b"] - some["speed_a"]
    rolling = lane(film.rolling) * some["weight_of_line"]
    drawn = lane(film.shear_force + film.boundary_force)
    load = np.where(back < 0, np.nan, some["line_load"])
    return {
        "central_film": lane(film.central_film),
        "minimum_film": lane(film.minimum_film),
        "film_pressure": lane(film.largest_pressure),
        "asperity_share": lane(film.asperity_share),
        "film_rise": lane(0.0 * film.rolling if film.heat is None else film.heat.largest_film),
        "film_friction": lane(film.friction),
        "flash_rise": lane(_flash(film)),
        "boundary_part": np.abs(lane(film.boundary_force)) / load,
        "rolling_resistance": rolling,
        "film_sliding_loss": drawn * sliding * some["weight_of_line"],
        "film_rolling_loss": rolling * (some["speed_a"] + some["speed_b"]),
    }


def _flash(film: LineFilm) -> np.ndarray:
    """Flash temperature of the warmer surface [K]; none of isothermal films."""
    heat = film.heat
    if heat is None:
        return 0.0 * np.asarray(film.rolling)
    warmer: np.ndarray = np.maximum(np.asarray(heat.largest_a), np.asarray(heat.largest_b))
    return warmer


def _kept(
    film: LineFilm,
    states: Mapping[str, np.ndarray],
    some: Mapping[str, np.ndarray],
    back: np.ndarray,
) -> dict[str, np.ndarray]:
    """Profiles [phase, shown pair, node] and half-width of the slice of each pair that carries most."""
    pairs = _shown(states)
    highest = np.argmax(some["load"][:, pairs], axis=-1)[..., None]
    which = np.take_along_axis(back[:, pairs], highest, axis=-1)
    found = {name: getattr(film, own) for name, own in _PROFILES.items()}
    if film.heat is not None:
        found |= {name: getattr(film.heat, own) for name, own in _WARM_PROFILES.items()}
    kept = {
        name: np.where(which < 0, np.nan, np.asarray(one)[which[..., 0]])
        for name, one in found.items()
    }
    width = np.where(which < 0, np.nan, np.asarray(film.half_width)[which])
    return {**kept, "profile_half_width": width[..., 0]}


def _shown(states: Mapping[str, np.ndarray]) -> np.ndarray:
    """Numbers of the pairs that carry most over the cycle, in order; of pairs that are alike the first."""
    load = states["load"].sum(axis=-1)
    carried = load.T @ states["weight"]
    rounded = np.round(load.T / np.max(load, initial=LEAST), SHOWN_ALIKE)
    _, first = np.unique(rounded, axis=0, return_index=True)
    most = first[np.argsort(-carried[first], kind="stable")[:SHOWN]]
    return np.sort(most)


# ---- the whole


def joined(built: Built, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Films of the cycle, with those by film laws and friction by the laws of the case beside them."""
    states = _states(built)
    found = xr.concat(parts, "point", combine_attrs="drop").rename(point="phase")
    loaded, codes = states["loaded"], found["film_status"].values
    lanes = {
        str(name): (tuple(map(str, one.dims)), one.values) for name, one in found.data_vars.items()
    }
    figures = _figures(states, {str(n): one.values for n, one in found.items()})
    told = codes[loaded] if loaded.any() else np.array([int(Code.UNLOADED)])
    data = dataset(
        {
            **lanes,
            **_beside(states),
            **_figure_dims(figures),
            "weight": (("phase",), states["weight"]),
            "shown_pair": (("shown",), _shown(states)),
        },
        {
            "phase": ("phase", states["phase"]),
            "law": built.law_names,
            "film_law": [law.name for law in _laws()],
        },
        title="films",
        travels=built.travels,
        warnings=[*_lost(codes[loaded]), *_of_pieces(parts), *_about(built, states, found)],
        solve=told_of(told, _residuals(parts, told), _iterations(parts)),
        film_titles=[law.title for law in _laws()],
        film_places=[law.place for law in _laws()],
        choices=_choices(built),
        other_rolling=_other_rolling(built),
        pitch=str(built.way["pitch"]),
    )
    data["path"].attrs.update(built.way)
    return data


def _figure_dims(
    figures: Mapping[str, np.ndarray],
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Figures with their dimensions: of all laws of film or friction, of the phases, or none."""
    axes = {
        "film_deviation": ("film_law",),
        "largest_film_deviation": ("film_law",),
        "film_loss": ("phase",),
        "law_loss": ("law", "phase"),
    }
    return {
        name: (axes.get(name, ("law",)[: np.ndim(one)]), np.asarray(one))
        for name, one in figures.items()
    }


def _beside(states: Mapping[str, np.ndarray]) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Conditions at the contacts, and what film laws and friction laws say there."""
    loaded = states["loaded"]
    values = {name: np.where(loaded, states[name], np.nan) for name in _MASKED}
    axes = {"friction": ("law",), "film_by_law": ("film_law",)}
    given = {name: states[name] for name in ("load", "radius", "path")}
    given |= {
        "entrainment": np.abs(states["speed_a"] + states["speed_b"]) / 2.0,
        "sliding_velocity": states["speed_a"] - states["speed_b"],
        "active": states["active"],
    }
    every = {**given, **values}
    return {name: ((*axes.get(name, ()), *_LANES), one) for name, one in every.items()}


def _figures(
    states: Mapping[str, np.ndarray], found: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Figures of the cycle; what needs all loaded contacts is withheld if one of them is missing."""
    loaded, weight = states["loaded"], states["weight"]
    known = loaded & (found["film_status"] == Code.SOLVED)
    whole = np.where(np.array_equal(known, loaded) and loaded.any(), 1.0, np.nan)
    load = np.where(loaded, states["load"], 0.0)

    def mean(values: np.ndarray) -> np.ndarray:
        """Mean over the cycle of sums over the contacts that carry."""
        sums = np.sum(np.where(loaded, np.nan_to_num(values), 0.0), axis=(-2, -1))
        return np.asarray(sums @ weight)

    total = mean(load) if loaded.any() else np.nan
    own = states["load_by_law"]
    sliding, rolling = (mean(found[f"film_{kind}_loss"]) * whole for kind in ("sliding", "rolling"))
    by_law = states["sliding_loss"] + states["rolling_loss"]
    figures = {
        **_extremes(found),
        "mean_film_friction": mean(load * found["film_friction"]) / total * whole,
        "mean_boundary_part": mean(load * found["boundary_part"]) / total * whole,
        "mean_law_friction": mean(own * states["friction"]) / mean(own)
        if loaded.any()
        else own[:, 0, 0, 0] * np.nan,
        "mean_film_sliding_loss": sliding,
        "mean_film_rolling_loss": rolling,
        "mean_film_loss": sliding + rolling,
        "mean_law_loss": mean(by_law),
        "film_loss": _course(found, loaded, known),
        "law_loss": np.sum(np.where(loaded, by_law, 0.0), axis=(-2, -1)),
        "loaded_contacts": np.sum(loaded),
        "solved_contacts": np.sum(known),
        **_deviations(states["film_by_law"], found, known),
    }
    return figures | _efficiencies(states, figures)


def _extremes(found: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Smallest and largest values of the films that were found."""
    low = {"smallest_film": "minimum_film", "smallest_lambda": "minimum_lambda"}
    high = {
        "largest_film_pressure": "film_pressure",
        "largest_asperity_share": "asperity_share",
        "largest_film_rise": "film_rise",
        "largest_flash_rise": "flash_rise",
    }

    def end(name: str, reduce: Any) -> Any:
        some = found[name][~np.isnan(found[name])]
        return reduce(some) if some.size else np.nan

    return {name: end(own, np.min) for name, own in low.items()} | {
        name: end(own, np.max) for name, own in high.items()
    }


def _course(found: Mapping[str, np.ndarray], loaded: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Loss by the films over the cycle; withheld at phases where a loaded contact is missing."""
    lost = found["film_sliding_loss"] + found["film_rolling_loss"]
    course = np.sum(np.where(known, np.nan_to_num(lost), 0.0), axis=(-2, -1))
    missing = np.any(loaded & ~known, axis=(-2, -1))
    return np.where(missing, np.nan, course)


def _deviations(
    by_law: np.ndarray, found: Mapping[str, np.ndarray], known: np.ndarray
) -> dict[str, np.ndarray]:
    """Films by law over those solved at the same place less one: mean, and where it is largest.

    Where mean planes overlap there is no film to compare with.
    """
    solved = {"minimum": found["minimum_film"], "central": found["central_film"]}
    apart = {place: known & (film > 0.0) for place, film in solved.items()}
    each = [
        law_film[apart[law.place]] / solved[law.place][apart[law.place]] - 1.0
        for law, law_film in zip(_laws(), by_law, strict=True)
    ]
    largest = [one[np.argmax(np.abs(one))] if one.size else np.nan for one in each]
    return {
        "film_deviation": np.array([one.mean() if one.size else np.nan for one in each]),
        "largest_film_deviation": np.array(largest),
    }


def _efficiencies(
    states: Mapping[str, np.ndarray], figures: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Efficiency by films and by law with the losses beside the teeth, and how far the laws are off."""
    weight = states["weight"]
    out, drag = states["output_power"] @ weight, states["drag_loss"] @ weight
    film, law = figures["mean_film_loss"], figures["mean_law_loss"]
    with np.errstate(divide="ignore", invalid="ignore"):
        return {
            "film_efficiency": np.where(out > 0.0, out / (out + drag + film), np.nan),
            "law_efficiency": np.where(out > 0.0, out / (out + drag + law), np.nan),
            "friction_deviation": figures["mean_law_friction"] / figures["mean_film_friction"]
            - 1.0,
            "loss_deviation": law / film - 1.0,
        }


# ---- words


def _lost(codes: np.ndarray) -> Iterator[str]:
    """Loaded contacts whose film was not found, by what became of them."""
    for code in sorted({*codes.tolist()} - {int(Code.SOLVED)}):
        yield (
            f"Films: {int(np.sum(codes == code))} of {codes.size} loaded contacts have no film "
            f"({Code(code).sentence}); the loss and efficiency by films are withheld."
        )


def _of_pieces(parts: Sequence[xr.Dataset]) -> list[str]:
    """Warnings of all pieces: of a kind the worst one, and where it is."""
    ends = np.cumsum([0, *(part.sizes["point"] for part in parts)])
    kinds: dict[str, list[tuple[float, str, str]]] = {}
    for k, part in enumerate(parts):
        where = f"phases {ends[k] + 1} to {ends[k + 1]} of {ends[-1]}"
        told = zip(*(json.loads(part.attrs[name]) for name in ("doubts", "warnings")), strict=True)
        for (kind, extent), text in told:
            kinds.setdefault(kind, []).append((extent, where, text))
    return [_worst(told) for told in kinds.values()]


def _worst(told: Sequence[tuple[float, str, str]]) -> str:
    """The worst one of warnings of one kind, of extent, place and words."""
    _, where, text = max(told, key=lambda one: one[0])
    others = ", and less at others" if len(told) > 1 else ""
    return f"Films, {where}{others}: {text}."


def _about(built: Built, states: Mapping[str, np.ndarray], found: xr.Dataset) -> list[str]:
    """What the films leave out."""
    run = {"load": np.where(states["loaded"], states["load"], 0.0), "radius": states["radius"]}
    cold = [cold_warning(built, _moving(states, found))] if _is_cold(built) else []
    return [*cold, *(f"Films: {text}" for text in conformal_warning(built.design.mesh, run))]


def _is_cold(built: Built) -> bool:
    return _model(built).thermal == ISOTHERMAL


def _moving(states: Mapping[str, np.ndarray], found: xr.Dataset) -> dict[str, np.ndarray]:
    """Contacts that carry, as a mesh cycle tells them, with what the films say."""
    every = {
        "pressure": states["pressure"],
        "radius": states["radius"],
        "entrainment": 0.5 * (states["speed_a"] + states["speed_b"]),
        "sliding_velocity": states["speed_a"] - states["speed_b"],
        "friction": found["film_friction"].values,
        "film_thickness": found["central_film"].values,
    }
    solved = np.isfinite(every["friction"])
    return {name: values[solved] for name, values in every.items()}


def _other_rolling(built: Built) -> str:
    """Why a law that solves films has another loss than its films; empty where it has not."""
    solved = [one.law.title for one in built.models if one.law.films is not None]
    model = built.models[0].rolling
    if not solved or model.name == "none":
        return ""
    return (
        f"{solved[0]}: the case takes rolling resistance from {model.title}; that of the films, which stands "
        "beside it here, is their own."
    )


def _choices(built: Built) -> dict[str, Any]:
    """The choices behind the films, by name."""
    model = _model(built)
    return {
        "nodes": model.nodes,
        "viscosity_law": model.viscosity_law,
        "density_law": model.density_law,
        "shear_law": model.shear_law,
        "asperities": model.asperities,
        "boundary_friction": model.boundary_friction,
        "inlet": model.inlet,
        "thermal": model.thermal,
    }


def _residuals(parts: Sequence[xr.Dataset], codes: np.ndarray) -> np.ndarray:
    largest = max(float(part.attrs["residual"]) for part in parts)
    return np.full(codes.shape, largest)


def _iterations(parts: Sequence[xr.Dataset]) -> np.ndarray:
    return np.array([int(part.attrs["iterations"]) for part in parts])
