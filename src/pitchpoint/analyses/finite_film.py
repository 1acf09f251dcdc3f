"""Films over the whole patch of the contacts of a mesh, solved over its cycle, beside those of lines."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import array
from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.film import (
    GRID_ERRORS,
    OF_LINES,
    films_of_lines,
    over_rough,
    values_of_lines,
)
from pitchpoint.analyses.film_contacts import (
    contact_states,
    distinct_contacts,
    film_model_of,
    film_table,
    patch_grid_of,
)
from pitchpoint.analyses.film_cycle import cycle_films
from pitchpoint.analyses.whole_contacts import Wholes, in_the_middle, one_contact, whole_contacts
from pitchpoint.cases.built import Built
from pitchpoint.core.doubts import WITHHELD, Doubt, in_percent
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.gears.nominal_motion import tooth_size
from pitchpoint.lubrication.ehl.doubts import GRID, UNKNOWN_GRID
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL
from pitchpoint.lubrication.ehl.line import FLOODED
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.patch.fields import END_DISTANCES, PatchFilm
from pitchpoint.lubrication.ehl.patch.grid_error import of_patches
from pitchpoint.lubrication.ehl.patch.heat import PatchTemperatures
from pitchpoint.lubrication.ehl.patch.layout import FEWEST
from pitchpoint.lubrication.ehl.patch.patch_films import ENDS, PatchFilms, solve_patch
from pitchpoint.materials.rheology import lorentz_lorenz_1880
from pitchpoint.results.store import dataset

__all__ = ["FIELDS", "film_part", "joined", "pieces"]

TOGETHER = 2
"""Phases of a piece, so that little is lost when a run is stopped."""

KINDS = ("carries most", "thinnest film")
"""Contacts whose fields are kept."""

_LANES = ("phase", "pair", "line")
_OF_PIECE = ("point", "pair", "line")
_MORE = {
    "minimum_place": ("direction",),
    "largest_place": ("direction",),
    "near_ends": ("end", "distance"),
}
"""Axes of values of a contact that are no single numbers."""

FIELDS = {
    "field_pressure": "pressure",
    "field_asperity_pressure": "asperity_pressure",
    "field_dry_pressure": "dry_pressure",
    "field_film": "gap",
    "field_heights": "heights",
}
"""Fields that are kept of a contact, and what they are of a film over a patch."""

_WARM_FIELDS = {
    "field_rise": "film",
    "field_surface_rise_1": "surface_a",
    "field_surface_rise_2": "surface_b",
}
"""Fields of films that are solved with their heat."""

_KEPT = {
    **dict.fromkeys((*FIELDS, *_WARM_FIELDS), ("kept", "y", "x")),
    "kept_x": ("kept", "x"),
    "kept_y": ("kept", "y"),
    "kept_at": ("kept", "axis"),
}
"""Axes of what is kept of contacts."""

_COARSE = {
    **{name: name for name in ("central_film", "minimum_film", "largest_pressure", "near_ends")},
    "friction": "friction_magnitude",
}
"""What is solved once more on a coarser grid."""


@dataclass(frozen=True)
class Refused:
    """A contact that no solver takes.

    Attributes:
        why: in words.
    """

    why: str


def pieces(built: Built) -> Iterator[Piece]:
    """Ranges of phases."""
    every = whole_contacts(built).states["phase"].size
    for start in range(0, every, TOGETHER):
        yield {"first": start, "count": min(TOGETHER, every - start)}


def film_part(built: Built, piece: Piece, progress: PieceProgress) -> xr.Dataset:
    """Films of all contacts at some phases."""
    start, count = piece["first"], piece["count"]
    taken, contacts = slice(start, start + count), whole_contacts(built)
    loaded, load = (contacts.states[name][taken] for name in ("loaded", "load"))

    def done(part: int, every: int, doing: str = "") -> None:
        progress(start + count * part // every, doing)

    films, back = _solved(built, contacts.numbers[taken][loaded], contacts.scale, done)
    lanes = np.full(loaded.shape, -1)
    lanes[loaded] = back
    values = _values(built, films, lanes)
    lines = _as_lines(built, contacts, taken, values["film_inlet"])
    ended = [one.ended for one in films if isinstance(one, PatchFilms)]
    solved = [one for one in films if isinstance(one, PatchFilms) and one.solved]
    errors = np.array([[one.ended.grid, one.ended.grid_minimum] for one in solved]).reshape(-1, 2).T
    line = built.design.mesh.shape == "line"
    return dataset(
        {
            **{name: ((*_OF_PIECE, *_MORE.get(name, ())), one) for name, one in values.items()},
            **{name: (_OF_PIECE, one) for name, one in lines.items()},
            **_kept(built, films, lanes, values, load),
        },
        {},
        warnings=[*_told(films), *of_patches(errors, patch_grid_of(built), line=line)],
        residual=max((one.ended.reynolds for one in solved), default=0.0),
        iterations=max((one.steps for one in ended), default=0),
    )


def _told(films: Sequence[PatchFilms | Refused]) -> list[Doubt]:
    """Warnings of contacts that were solved, and why others were refused, each once.

    What the last row of a line is has its place beside the pressures near the ends, and errors by the grid
    are told of all of them together.
    """
    texts: dict[Doubt, None] = {}
    for film in films:
        if isinstance(film, Refused):
            sentence = f"a contact was not taken: {film.why}"
            texts[Doubt(sentence, moves=WITHHELD, brief="a contact was not taken")] = None
        elif film.solved:
            texts |= dict.fromkeys(
                doubt for doubt in film.warnings if doubt.kind not in (ENDS, GRID, UNKNOWN_GRID)
            )
    return [*texts]


def _solved(
    built: Built, numbers: np.ndarray, scale: np.ndarray, done: Any
) -> tuple[list[PatchFilms | Refused], np.ndarray]:
    """Films of the contacts that differ, and which of them belongs to each contact."""
    if not len(numbers):
        return [], np.zeros(0, int)
    where, back = distinct_contacts(numbers, scale)
    films: list[PatchFilms | Refused] = []
    for k, conditions in enumerate(numbers[where]):
        before = next((film for film in films[::-1] if isinstance(film, PatchFilms)), None)
        told = f"contact {k + 1} of {len(where)}"

        def step(number: int, residual: float, k: int = k, told: str = told) -> None:
            done(k, len(where), f"{told}, Newton step {number}, residual {residual:.0e}")

        films.append(_one(built, conditions, patch_grid_of(built), step, before))
        done(k + 1, len(where))
    return films, back


def _one(
    built: Built,
    numbers: np.ndarray,
    grid: tuple[int, int],
    told: Any = None,
    start: PatchFilms | None = None,
    model: FilmModel | None = None,
) -> PatchFilms | Refused:
    nodes, cells = grid
    try:
        contact = one_contact(built, numbers, model=model)
        return solve_patch(contact, nodes=nodes, cells=cells, progress=told, start=start)
    except InputError as error:
        return Refused(error.message)


# ---- values of the contacts


def _values(
    built: Built, films: Sequence[PatchFilms | Refused], lanes: np.ndarray
) -> dict[str, np.ndarray]:
    """What follows from the films, for every lane; not a number where there is none."""
    line = built.design.mesh.shape == "line"
    film_values = [_of_film(film, line) if isinstance(film, PatchFilms) else {} for film in films]
    codes = [int(_code(film)) for film in films]
    defects = [film.ended.reynolds if isinstance(film, PatchFilms) else np.nan for film in films]

    def lane(values: list[Any], shape: tuple[int, ...] = ()) -> np.ndarray:
        every = np.full((len(values) + 1, *shape), np.nan)
        for k, of_film in enumerate(values):
            every[k] = of_film
        at_lanes: np.ndarray = every[lanes]
        return at_lanes

    quantities = {
        name: lane([film.get(name, np.nan) for film in film_values], shape)
        for name, shape in _SHAPES.items()
        if line or name not in _ROWS
    }
    if film_table(built).refractive_index is not None:
        middle = [
            _in_the_middle(film.film) if isinstance(film, PatchFilms) else np.nan for film in films
        ]
        pressure, rise = np.moveaxis(lane(middle, (2,)), -1, 0)
        quantities["read_film"] = quantities["central_film"] * _read_over_true(
            built, pressure, rise
        )
    status = np.array([*codes, int(Code.UNLOADED)])[lanes]
    quantities["minimum_lambda"] = over_rough(built, quantities["minimum_film"])
    return quantities | {"film_status": status, "film_defect": lane(defects)}


def _in_the_middle(film: PatchFilm) -> np.ndarray:
    """Pressure [Pa] and rise of the temperature [K] in the middle of an ellipse."""

    def middle(field: Any) -> float:
        rows = [np.interp(0.0, film.x, row) for row in np.asarray(field)]
        return float(np.interp(0.0, film.y, rows))

    return np.array([middle(film.pressure), 0.0 if film.heat is None else middle(film.heat.film)])


def _read_over_true(built: Built, pressure: np.ndarray, rise: np.ndarray) -> np.ndarray:
    """Film that interferometry reads with the index at ambient pressure and the inlet, over the true one."""
    index = np.asarray(film_table(built).refractive_index)
    oil = film_model_of(built).fluid(built.design.lubricant, float(built.operation.temperature))
    denser = oil.density_ratio(array(pressure), array(rise))
    compressed = lorentz_lorenz_1880(refractive_index=array(index), density_ratio=denser)
    read: np.ndarray = np.asarray(compressed) / index
    return read


def _code(one: PatchFilms | Refused) -> Code:
    return one.ended.code if isinstance(one, PatchFilms) else Code.NOT_CONVERGED


_NAMES = {
    "central_film": "central_film",
    "minimum_film": "minimum_film",
    "mean_film": "mean_film",
    "film_pressure": "largest_pressure",
    "dry_pressure": "hertz_pressure",
    "dry_half_width": "half_width",
    "asperity_share": "asperity_share",
    "film_friction": "friction_magnitude",
    "boundary_part": "boundary_magnitude",
    "film_sliding_loss": "sliding_power",
    "film_rolling_loss": "pumping_power",
    "film_stiffness": "stiffness",
    "film_damping": "damping",
    "minimum_place": "minimum_place",
    "largest_place": "largest_place",
    "near_ends": "near_ends",
}
"""Values of contacts, and what they are of a film over a patch.

Friction is that of magnitudes, as friction laws and lines have it: sliding of a helical line changes its
sense at the pitch line, and the force of the whole contact says little about heat and loss.
"""

_OWN = ("rolling_resistance", "film_inlet", "film_rise", "flash_rise", *GRID_ERRORS)
"""Values of contacts that are made of several."""

_SHAPES: dict[str, tuple[int, ...]] = {
    **dict.fromkeys([*_NAMES, *_OWN], ()),
    "minimum_place": (2,),
    "largest_place": (2,),
    "near_ends": (2, END_DISTANCES.size),
    "row_film": (),
}
_ROWS = ("row_film",)
"""Values that lines alone have."""


def _of_film(films: PatchFilms, line: bool) -> dict[str, Any]:
    film = films.film
    fields = {name: np.asarray(getattr(film, attribute)) for name, attribute in _NAMES.items()}
    return fields | {
        "rolling_resistance": np.hypot(*film.rolling),
        "film_inlet": -films.layout.inlet,
        **dict(zip(GRID_ERRORS, (films.ended.grid, films.ended.grid_minimum), strict=True)),
        **_rises(film.heat),
        **({"row_film": _of_middle_row(film)} if line else {}),
    }


def _rises(heat: PatchTemperatures | None) -> dict[str, float]:
    """Largest rises of the film and of the warmer surface [K]; none of isothermal films."""
    if heat is None:
        return {"film_rise": 0.0, "flash_rise": 0.0}
    flash = max(float(heat.largest_a), float(heat.largest_b))
    return {"film_rise": float(heat.largest_film), "flash_rise": flash}


def _of_middle_row(film: PatchFilm) -> float:
    """Smallest film of the row of cells in the middle of a line [m]; none where the grid ends before."""
    y = np.asarray(film.y)
    row = int(np.argmin(np.abs(y)))
    there = y[0] <= 0.0 <= y[-1]
    return float(np.min(np.asarray(film.gap)[row])) if there else np.nan


def _as_lines(
    built: Built, given: Wholes, taken: slice, inlet: np.ndarray
) -> dict[str, np.ndarray]:
    """The same contacts, with the same inlets, by the solver of lines without ends; nothing of ellipses."""
    if built.design.mesh.shape != "line":
        return {}
    slices = contact_states(built)
    some = {name: slices[name][taken] for name in OF_LINES}
    begins = np.broadcast_to(inlet[..., None], given.grouped(some["load"]).shape)
    flooded = np.where(np.isnan(begins), FLOODED, begins)
    some["inlet"] = flooded.reshape(some["load"].shape)
    films, _, back = films_of_lines(built, some)
    every = values_of_lines(films.film, some, back)
    parts = {name: given.grouped(every[name]) for name in _OF_LINE}
    load, loaded = given.grouped(some["load"]), given.grouped(some["loaded"])

    def total(values: np.ndarray) -> np.ndarray:
        sums = np.sum(np.where(loaded, values, 0.0), axis=-1)
        return np.where(np.any(loaded, axis=-1), sums, np.nan)

    loss = parts["film_sliding_loss"] + parts["film_rolling_loss"]
    least = np.min(np.where(loaded, parts["minimum_film"], np.inf), axis=-1)
    return {
        "line_central_film": in_the_middle(given.middles[taken], parts["central_film"]),
        "line_minimum_film": np.where(np.isinf(least), np.nan, least),
        "line_friction": total(parts["film_friction"] * load) / total(load),
        "line_loss": total(loss),
    }


_OF_LINE = (
    "central_film",
    "minimum_film",
    "film_friction",
    "film_sliding_loss",
    "film_rolling_loss",
)


# ---- fields


def _kept(
    built: Built,
    films: Sequence[PatchFilms | Refused],
    lanes: np.ndarray,
    values: Mapping[str, np.ndarray],
    load: np.ndarray,
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Fields of the contact that carries most and of that with the thinnest film, and where they are."""
    nodes, cells = patch_grid_of(built)
    film = values["minimum_film"]
    solved = np.isfinite(film)
    places = {"kept_x": nodes, "kept_y": cells}
    names = _kept_fields(built)
    empty = {
        **{name: np.full((len(KINDS), cells, nodes), np.nan) for name in names},
        **{name: np.full((len(KINDS), size), np.nan) for name, size in places.items()},
    }
    at = np.full((len(KINDS), lanes.ndim), -1)
    if solved.any():
        ranks = np.where(solved, load, -np.inf), np.where(solved, -film, -np.inf)
        for k, rank in enumerate(ranks):
            at[k] = np.unravel_index(np.argmax(rank), rank.shape)
            patch_films = films[lanes[tuple(at[k])]]
            assert isinstance(patch_films, PatchFilms)
            solved_film, heat = patch_films.film, patch_films.film.heat
            for name, attribute in (*FIELDS.items(), ("kept_x", "x"), ("kept_y", "y")):
                empty[name][k] = getattr(solved_film, attribute)
            for name, attribute in _WARM_FIELDS.items() if heat is not None else ():
                empty[name][k] = getattr(heat, attribute)
    return {name: (_KEPT[name], field) for name, field in (empty | {"kept_at": at}).items()}


def _kept_fields(built: Built) -> tuple[str, ...]:
    """Names of the fields that are kept."""
    cold = film_model_of(built).thermal == ISOTHERMAL
    return (*FIELDS,) if cold else (*FIELDS, *_WARM_FIELDS)


def _fields(
    built: Built, parts: Sequence[xr.Dataset], whole_film: Mapping[str, np.ndarray]
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Fields of the two contacts of the whole cycle, and the same on a coarser grid."""
    load = whole_contacts(built).states["load"]
    film = whole_film["minimum_film"]
    firsts = np.cumsum([0, *(part.sizes["point"] for part in parts)])
    fields: dict[str, list[np.ndarray]] = {}
    for k, best in enumerate((load, -film)):
        ranks = []
        for start, part in zip(firsts, parts, strict=False):
            phase, pair, line = part["kept_at"].values[k]
            ranks.append(best[start + phase, pair, line] if phase >= 0 else -np.inf)
        chosen = int(np.argmax(ranks))
        at = parts[chosen]["kept_at"].values[k].copy()
        at[0] += firsts[chosen] if at[0] >= 0 else 0
        for name in (*_kept_fields(built), "kept_x", "kept_y"):
            fields.setdefault(name, []).append(parts[chosen][name].values[k])
        fields.setdefault("kept_at", []).append(at)
    return {name: (_KEPT[name], np.stack(of_contacts)) for name, of_contacts in fields.items()}


def _coarse(built: Built, at: np.ndarray) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Values of the kept contacts on the next coarser grid; not a number without one."""
    nodes, cells = patch_grid_of(built)
    dims = {"near_ends": ("kept", "end", "distance")}
    shapes = {"near_ends": (2, END_DISTANCES.size)}
    coarse = {name: np.full((len(at), *shapes.get(name, ())), np.nan) for name in _COARSE}
    films: dict[tuple[int, ...], PatchFilms | Refused] = {}
    for k, place in enumerate(map(tuple, at)):
        if min(nodes, cells + 1) <= FEWEST or place[0] < 0:
            continue
        if place not in films:
            numbers = whole_contacts(built).numbers[place]
            films[place] = _one(built, numbers, (nodes // 2 + 1, cells // 2))
        film = films[place]
        if isinstance(film, PatchFilms):
            for name, attribute in _COARSE.items():
                coarse[name][k] = getattr(film.film, attribute)
    return {
        f"coarse_{name}": (dims.get(name, ("kept",)), values) for name, values in coarse.items()
    }


# ---- the whole


def joined(built: Built, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Films of the cycle, with those of lines, and of film laws and friction laws, beside them."""
    contacts = whole_contacts(built)
    names = [name for name, variable in parts[0].items() if "point" not in variable.dims]
    lanes = [part.drop_vars(names) for part in parts]
    values = {
        name: np.concatenate([part[name].values for part in parts])
        for name in (*_FOR_FIGURES, *_BY_LINES)
        if name in parts[0]
    }
    fields = _fields(built, parts, values)
    coarse = _coarse(built, fields["kept_at"][1])
    added_variables = {
        **fields,
        **coarse,
        **_line_figures(contacts.states, values),
        **_finite_figures(values),
        "line_length": (_LANES, contacts.states["weight_of_line"]),
        "direction": (("direction",), np.array(["x", "y"])),
        "end": (("end",), np.array(["first", "last"])),
        "distance": (("distance",), END_DISTANCES),
        "kept": (("kept",), np.array(KINDS)),
    }
    table = film_table(built)
    nodes, cells = patch_grid_of(built)

    def again(lane: tuple[int, ...], eta_beta_sigma: float) -> tuple[float, float]:
        model = replace(film_model_of(built), eta_beta_sigma=eta_beta_sigma)
        film = _one(built, contacts.numbers[lane], (nodes, cells), model=model)
        if isinstance(film, Refused):
            return np.nan, np.nan
        return float(film.film.asperity_share), float(film.film.friction_magnitude)

    data = cycle_films(
        built,
        contacts.states,
        lanes,
        _LANES,
        added_variables,
        again,
        title="films of finite contacts",
        solver=table.solver,
        grid=json.dumps([nodes, cells]),
        ends=table.ends or "",
        end_profile=table.end_profile or "",
        sharp=_sharp(contacts.states, values),
        leaning=_leaning(values),
        interferometry=_interferometry(built, values),
    )
    return data.set_coords(["direction", "end", "distance", "kept"])


_BY_LINES = ("line_friction", "line_loss")
_FOR_FIGURES = (
    "minimum_film",
    "central_film",
    "near_ends",
    "film_pressure",
    "largest_place",
    "dry_half_width",
    "read_film",
)

NEAR = 1
"""Number of the distance from an end whose pressure is shown first: half a half-width."""

SHARP = 0.25
"""Half-widths from an end within which a largest pressure is that of the end."""


def _finite_figures(
    values: Mapping[str, np.ndarray],
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Smallest film in the middle of a contact, and largest pressure near an end of a line."""
    near, central = values["near_ends"][..., NEAR], values["central_film"]
    figures = {"smallest_central_film": ((), np.min(central[np.isfinite(central)], initial=np.inf))}
    if np.isfinite(near).any():
        figures["largest_end_pressure"] = ((), np.nanmax(near))
    return {
        name: (dims, np.where(np.isinf(figure), np.nan, figure))
        for name, (dims, figure) in figures.items()
    }


def _interferometry(built: Built, values: Mapping[str, np.ndarray]) -> str:
    """How films of bodies without teeth, on which rigs read them, are read, in words."""
    if built.design.mesh.shape == "line" or tooth_size(built.design.mesh) is not None:
        return ""
    words = (
        "Interferometry that reads films with the index of the oil at ambient pressure finds them too thick, "
        "as compressed oil is denser"
    )
    if "read_film" not in values:
        return f"{words}: give the `refractive_index` to have them as they are read."
    read, index = (
        np.nanmax(values["read_film"] / values["central_film"]) - 1.0,
        film_table(built).refractive_index,
    )
    if abs(read) < 1e-9:
        return f"{words}; the oil of this case is incompressible, and is read as it is."
    return f"{words}: by {in_percent(read)} in the middle with an index of {index:g} there."


def _leaning(values: Mapping[str, np.ndarray]) -> str:
    """That lines have no film in their middle, as nothing touches there, in words; empty where all have."""
    with_film = np.isfinite(values["minimum_film"])
    off = with_film & ~np.isfinite(values["central_film"])
    if not off.any():
        return ""
    return (
        f"{off.sum()} of {with_film.sum()} contact lines touch at one end only: they have no film in their "
        "middle, and film laws, which stand for the middle, are not compared with them."
    )


def _sharp(states: Mapping[str, np.ndarray], values: Mapping[str, np.ndarray]) -> str:
    """What the largest pressure is where lines end sharply, in words; empty where none does."""
    touches = np.isfinite(values["near_ends"][..., 0]).any(axis=-1)
    pressure = np.where(touches, values["film_pressure"], np.nan)
    if np.isnan(pressure).all():
        return ""
    at = np.unravel_index(np.nanargmax(pressure), pressure.shape)
    end = 0.5 * states["weight_of_line"][at] - np.abs(values["largest_place"][at][1])
    if end > SHARP * values["dry_half_width"][at]:
        return ""
    return (
        f"The lines end sharply: the largest pressure, {1e-6 * pressure[at]:.0f} MPa, is that of the last "
        "row and a number of the grid, and so is the smallest film where it lies there. Compare those at a "
        "distance from the end, or give the flanks an end relief or end_profile."
    )


def _line_figures(
    states: Mapping[str, np.ndarray], values: Mapping[str, np.ndarray]
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Mean friction and loss by films of lines without ends, withheld where one of them is missing."""
    if "line_loss" not in values:
        return {}
    loaded, weight = states["loaded"], states["weight"]
    load = np.where(loaded, states["load"], 0.0)

    def mean(each: np.ndarray) -> np.ndarray:
        return np.asarray(np.sum(np.where(loaded, each, 0.0), axis=(-2, -1)) @ weight)

    with np.errstate(divide="ignore", invalid="ignore"):
        friction = mean(load * values["line_friction"]) / mean(load)
    whole_loss = mean(values["line_loss"]) if loaded.any() else np.array(np.nan)
    return {"mean_line_friction": ((), friction), "mean_line_loss": ((), whole_loss)}
