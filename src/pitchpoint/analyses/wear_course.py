"""Wear of the flanks over the life of a drive: the march, a step a piece, and the whole course."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import count
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from pitchpoint._jax import array
from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.cases.built import Built
from pitchpoint.cases.wear_choices import limit_of, wear_constant_doubts, wear_model
from pitchpoint.cases.worn import gears_digest
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.worn import BRIDGED, WIDEST
from pitchpoint.core.doubts import Doubt, in_percent
from pitchpoint.core.status import Code, solve_summary
from pitchpoint.efficiency.quasi_static import contacts_at, shares_at
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.input.kinds import HARDNESS
from pitchpoint.lubrication.ehl.ehl_registry import coarser_count
from pitchpoint.results.store import dataset
from pitchpoint.wear.history import (
    ROOM,
    Cells,
    Start,
    WearModel,
    travelled,
    unworn_start,
    wear_of_turn,
)
from pitchpoint.wear.march import FIRST, End, Limit, Rate, Reached, unworn_flanks, wear_step
from pitchpoint.wear.wear_gradients import march_sensitivities
from pitchpoint.wear.wear_stages import run_in_end, severe_start
from pitchpoint.wear.wear_tables import WEAR_LAND, WearTable
from pitchpoint.wear.worn_teeth import TipThickness, backlash_growth, half_teeth, tips_of

__all__ = ["further", "joined", "wear_part", "wear_table"]

TOLD = 0.03
"""Error of the largest depth, over it, from which on a sentence tells it."""

SLICED = 0.06
"""Error of the depth on helical lines, over it, times their slices: above that of random pairs."""

SAFETY = 1.25
"""Factor on what half the grid changes, for the error of cells: Roache's, for an order that is known."""

OF_HALF_NODES = 0.55
"""Error of rates by the grid of solved films, over what half as many nodes change of them."""

HOLDS = 0.2
"""Depth over the module up to which flanks wear along normals that stay where they are."""


def wear_table(built: Built) -> WearTable:
    """The table of the case that asks for wear."""
    assert built.case.wear is not None
    return built.case.wear


class _Course(NamedTuple):
    """What all steps of a march share."""

    start: Start
    cells: Cells
    model: WearModel
    tips: TipThickness | None


@lru_cache(maxsize=2)
def _course(built: Built) -> _Course:
    table, design = wear_table(built), built.design
    roughness = float(design.roughness.ra_1), float(design.roughness.ra_2)
    model = wear_model(built.case, built.solids, roughness, built.film_model)
    parts, every = int(table.phases), int(table.cells)
    try:
        start, cells = unworn_start(
            design, built.operation, built.models[0], parts=parts, count=every
        )
    except InputError as error:
        raise InputError(error.message, key="wear") from None
    tips = tips_of(design.mesh, cells, start) if has(design.mesh, tooth_sections) else None
    return _Course(start, cells, model, tips)


def _rate(built: Built, depth: np.ndarray, *, coarser: bool = False) -> Rate:
    """What a turn does to flanks that have lost so much; those of a kept profile count as new.

    On a coarser grid each two cells are as deep as both on average.
    """
    start, cells, model, _ = _course(built)
    seen = depth if wear_table(built).profile == "updated" else np.zeros_like(depth)
    if coarser:
        cells, seen = cells.coarser, cells.merged(seen)
    inputs = built.design, built.operation, built.models[0], model, cells, start
    return Rate.of(wear_of_turn(*inputs, array(seen)))


def wear_part(built: Built, _: Piece, progress: PieceProgress) -> xr.Dataset:
    """Flanks as new."""
    progress(0, "flanks as new")
    _check_tips(built)
    cells = _course(built).cells
    return _piece(unworn_flanks(lambda depth: _rate(built, depth), cells.shape), None)


def _check_tips(built: Built) -> None:
    """InputError for tips that are as narrow as new as they may become."""
    least, tips = wear_table(built).tip_land_limit, _course(built).tips
    if least is None or tips is None or np.all(tips.width > least):
        return
    narrow = int(np.argmin(tips.width))
    raise InputError(
        f"{WEAR_LAND.show(least)} was given, and teeth of {_bodies(built)[narrow]} are "
        f"{WEAR_LAND.show(float(tips.width[narrow]))} thick as new where flanks touch last; allowed is less",
        key="wear.tip_land_limit",
    )


def _bodies(built: Built) -> list[str]:
    """Names of the bodies whose flanks touch."""
    return [
        next(body.body for body in built.bodies if body.member == member) for member in range(2)
    ]


def _limit(built: Built) -> Limit:
    """Where the march of a case ends."""
    table, tips = wear_table(built), _course(built).tips
    teeth: list[tuple[End, Callable[[np.ndarray], float]]] = []
    if (least := table.tip_land_limit) is not None and tips is not None:
        teeth.append(("tip land", lambda depth: least - float(tips.left(depth).min())))
    if (most := table.backlash_limit) is not None:
        teeth.append(("backlash", lambda depth: _play(built, depth) - most))
    limit = limit_of(table, _deepest(built))
    rows = _course(built).cells.deepest
    return replace(limit, deepest=rows, hardness=_hardness(built), teeth=tuple(teeth))


def _hardness(built: Built) -> float:
    """That of the softer flank [Pa]; infinite where neither is known."""
    hardnesses = wear_table(built).hardness or tuple(
        float(solid.hardness) for solid in built.design.solids
    )
    return float(np.nanmin([*hardnesses, np.inf]))


def _play(built: Built, depth: np.ndarray, *, pitch_line: bool = False) -> float:
    """Normal backlash that wear has added, see `backlash_growth` [m]."""
    course = _course(built)
    return backlash_growth(
        built.design.mesh, course.cells, course.start, depth, pitch_line=pitch_line
    )


def further(built: Built, last: xr.Dataset, progress: PieceProgress) -> xr.Dataset | None:
    """Flanks one step after those of the last piece; None at the end."""
    before = _reached(last)
    if before.end:
        return None
    limit = _limit(built)
    states = count(1)

    def rate(depth: np.ndarray) -> Rate:
        deepest = 1e6 * float(before.depth.max())
        progress(
            0,
            f"{before.turns:.3g} of {limit.turns:.3g} turns, {deepest:.3g} um deep, state {next(states)} "
            "of the next step",
        )
        return _rate(built, depth)

    reached = wear_step(
        before,
        rate,
        limit,
        start=float(last.attrs["first_pressure"]),
        tolerance=wear_table(built).tolerance,
        coarser=lambda depth: _rate(built, depth, coarser=True),
    )
    return _piece(reached, float(last.attrs["first_pressure"]))


def _piece(reached: Reached, start: float | None) -> xr.Dataset:
    """A step of the march as a dataset of one step."""
    cells = ("step", "member", "cell", "strip")
    values = {
        "cycles": (("step",), reached.turns),
        "worn_depth": (cells, reached.depth),
        "depth_per_turn": (cells, reached.rate.depth),
        "wear_error": (("step", "member"), reached.error),
        "wear_pressure": (("step",), reached.rate.pressure),
        "conforming": (("step",), reached.rate.conforming),
        "outgrown": (("step",), reached.rate.outgrown),
        "next_step": (("step",), reached.step),
    }
    return dataset(
        {name: (dims, np.asarray(numbers)[None]) for name, (dims, numbers) in values.items()},
        {},
        end=reached.end,
        lost=int(reached.rate.lost),
        first_pressure=reached.rate.pressure if start is None else start,
    )


def _reached(piece: xr.Dataset) -> Reached:
    """The state that a piece holds, to the last bit."""
    variables = {name: piece[name].values[0] for name in piece.data_vars}
    end: End = piece.attrs["end"]
    rate = Rate(
        depth=variables["depth_per_turn"],
        pressure=float(variables["wear_pressure"]),
        conforming=bool(variables["conforming"]),
        outgrown=bool(variables["outgrown"]),
        lost=bool(piece.attrs["lost"]),
    )
    return Reached(
        turns=float(variables["cycles"]),
        depth=variables["worn_depth"],
        rate=rate,
        error=variables["wear_error"],
        step=float(variables["next_step"]),
        end=end,
    )


# ---- the whole


def joined(built: Built, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The course of wear over the cycles."""
    course, end = _course(built), str(parts[-1].attrs["end"])
    if end == "lost" and len(parts) > 1:
        parts = parts[:-1]  # the state before, from which no step was found
    names = [str(name) for name in parts[0].data_vars if name != "next_step"]
    values = {name: np.concatenate([part[name].values for part in parts]) for name in names}
    flank, across = (np.asarray(numbers) for numbers in course.cells.middles)
    dims = {name: tuple(map(str, parts[0][name].dims)) for name in names}
    depth, per_turn = values["worn_depth"], values["depth_per_turn"]
    rows = course.cells.deepest
    deepest, fastest = (numbers[:, :, rows].max(axis=(2, 3)) for numbers in (depth, per_turn))
    if end == "depth" and deepest[-1].max() >= (1.0 - 1e-9) * _deepest(built):
        end = "module"
    merged = np.stack([course.cells.merged(numbers) for numbers in depth])
    of_cells = np.abs(deepest - merged[:, :, rows].max(axis=(2, 3)))
    values["wear_error"] += np.maximum(of_cells, _of_grid(built) * deepest)
    values["wear_error"] += (_of_slices(course.start) + _of_films(built, depth)) * deepest
    volumes = [np.asarray(course.cells.volumes(array(numbers))) for numbers in depth]
    sensitivities = _sensitivities(built, values)
    inner = course.cells.count
    values |= {"worn_depth": depth[:, :, :inner], "depth_per_turn": per_turn[:, :, :inner]}
    added = {
        "deepest_wear": (("step", "member"), deepest),
        "fastest_wear": (("step", "member"), fastest),
        "worn_volume": (("step", "member"), np.stack(volumes)),
        "flank_place": (("member", "cell"), flank),
        "flank_radius": (("member", "cell"), _radii(built, flank)),
        "across_place": (("strip",), across),
        "flank_ends": (("member", "side"), np.asarray(course.cells.flank)),
        "across_ends": (("side",), np.asarray(course.cells.across)),
        "contact_span": (("axis",), np.asarray(course.cells.span)),
        **_where(built, depth),
    }
    figures, teeth = (
        _figures(built, values, deepest, fastest),
        _of_teeth(built, depth, values["wear_error"]),
    )
    codes = np.full(len(parts), int(Code.SOLVED))
    if end == "lost":
        codes[-1] = int(Code.NOT_CONVERGED)
    return dataset(
        {
            **{name: (dims[name], numbers) for name, numbers in values.items()},
            **added,
            **teeth,
            **{name: ((), numbers) for name, numbers in figures.items()},
        },
        {},
        title="wear",
        law=wear_table(built).law,
        gears=gears_digest(built.case.gears),
        profile=wear_table(built).profile,
        load_ratio=wear_table(built).load_ratio,
        severe_by=wear_table(built).severe_by,
        end=end,
        members=_bodies(built),
        driver=built.driver,
        tolerance=wear_table(built).tolerance,
        sensitivities=sensitivities,
        warnings=[*_warnings(built, values, deepest, end), *_of_play(built, teeth)],
        solve=solve_summary(codes, values["wear_error"].max(axis=1), np.arange(codes.size)),
    )


def _of_slices(start: Start) -> float:
    """What slices of lines are taken to be off by, over the depth: none on lines of one."""
    slices = start.contacts.active.shape[1]
    return SLICED / slices if start.places is not None and slices > 1 else 0.0


def _of_grid(built: Built) -> float:
    """What the grid is taken to leave of the largest depths, over them: from half as many cells and phases.

    That of the member where it is more, as new, with a factor of safety; none where depths are held at
    places, whose errors are told step by step. Source: Roache (1994), for convergence of the first order.
    """
    course, table = _course(built), wear_table(built)
    if course.cells.places:
        return 0.0
    design, operation, models = built.design, built.operation, built.models[0]
    parts, every = max(int(table.phases) // 2, 1), max(int(table.cells) // 2, 1)
    grids = (
        (course.start, course.cells),
        unworn_start(design, operation, models, parts=parts, count=every),
    )
    fine, coarse = (
        np.asarray(
            wear_of_turn(
                design, operation, models, course.model, cells, start, array(np.zeros(cells.shape))
            ).depth
        ).max(axis=(1, 2))
        for start, cells in grids
    )
    worn = fine > 0.0
    apart = np.abs(coarse - fine)[worn] / fine[worn]
    return SAFETY * float(np.max(np.nan_to_num(apart, nan=1.0), initial=0.0))


def _of_films(built: Built, depth: np.ndarray) -> float:
    """What the grid of solved films leaves of the largest depths, over them; zero where none are solved.

    Rates are off by a part of their change from half as many nodes; on the fewest, by all of their change to
    twice as many. That of the member where it is more, with flanks as new or, where their profile follows, as
    they end up.
    """
    course, design, operation = _course(built), built.design, built.operation
    if course.model.films is None:
        return 0.0
    half = coarser_count(course.model.films.nodes)
    nodes, part = (half, OF_HALF_NODES) if half else (2 * course.model.films.nodes - 1, 1.0)
    models = course.model, replace(course.model, films=replace(course.model.films, nodes=nodes))
    ends = [np.zeros_like(depth[-1])] + [depth[-1]] * (wear_table(built).profile == "updated")
    rates = np.array(
        [
            wear_of_turn(
                design,
                operation,
                built.models[0],
                model,
                course.cells,
                course.start,
                array(end_depth),
            ).depth
            for model in models
            for end_depth in ends
        ]
    )
    usual, varied = rates[:, :, course.cells.deepest].max(axis=(2, 3)).reshape(2, -1)
    worn = usual != 0.0  # also what was not found
    apart = np.abs(varied - usual)[worn] / usual[worn]
    return float(part * np.max(np.nan_to_num(apart, nan=1.0), initial=0.0))


def _widest(built: Built) -> float:
    """Largest half-width of contacts of flanks as new, over the radius of the sharper flank."""
    design, operation, models, start = (
        built.design,
        built.operation,
        built.models[0],
        _course(built).start,
    )
    share = shares_at(design, start.contacts, operation.load, models, start.body)
    at, _ = travelled(design, operation, models, start.engaged(share))
    sharper = np.asarray(at.contacts.curvature[:, 0]).max(axis=0)
    return float(np.max(np.where(at.load > 0.0, at.half_width * sharper, 0.0)))


def _where(built: Built, depth: np.ndarray) -> dict[str, Any]:
    """Where each member is deepest in each step, and the largest depths along flanks with places."""
    start, cells = _course(built).start, _course(built).cells
    middles = np.asarray(cells.middles[0])
    flank = np.broadcast_to(middles[..., None], (2, cells.count, cells.strips))
    if start.places is not None:
        flank = np.asarray(start.places)
    depth = depth[:, :, cells.deepest]
    most = depth.reshape(len(depth), 2, -1).argmax(axis=2)
    deepest = flank.reshape(2, -1)[np.arange(2), most]
    radii = _radii(built, deepest.T).T
    turns = not np.isnan(radii).all()
    places = {
        "deepest_radius" if turns else "deepest_place": (
            ("step", "member"),
            np.where(depth.any(axis=(2, 3)), radii if turns else deepest, np.nan),
        )
    }
    if start.places is None:
        return places
    if cells.strips > 1:
        return places | _largest_in_cells(built, flank, depth)
    order = _along_flank(flank[..., 0])[:, : int(np.isfinite(flank[0]).sum())]
    return places | {
        "profile_radius": (
            ("member", "place"),
            _radii(built, np.take_along_axis(flank[..., 0], order, axis=1)),
        ),
        "profile_depth": (
            ("step", "member", "place"),
            np.take_along_axis(depth[..., 0], order[None], axis=2),
        ),
    }


def _along_flank(places: np.ndarray) -> np.ndarray:
    """Order of places along both flanks; where two stretches meet, in the sense of the path of contact."""
    met = np.round(places / np.nanmax(places), 9)
    sense = np.sign(places[:, 1] - places[:, 0])[:, None] * np.arange(places.shape[1])
    return np.lexsort((sense, met), axis=1)


def _largest_in_cells(built: Built, flank: np.ndarray, depth: np.ndarray) -> dict[str, Any]:
    """The largest depth of places across the face, by the cell along the flank in which they lie."""
    cells = _course(built).cells
    ends, middles = np.asarray(cells.flank)[..., None, None], np.asarray(cells.middles[0])
    part = np.nan_to_num((flank - ends[:, 0]) / (ends[:, 1] - ends[:, 0]))
    cell = np.clip((cells.count * part).astype(int), 0, cells.count - 1)
    largest = np.zeros((len(depth), 2, cells.count))
    for step, member in np.ndindex(len(depth), 2):
        np.maximum.at(largest[step, member], cell[member], depth[step, member])
    return {
        "profile_radius": (("member", "place"), _radii(built, middles)),
        "profile_depth": (("step", "member", "place"), largest),
    }


def _of_teeth(built: Built, depth: np.ndarray, error: np.ndarray) -> dict[str, Any]:
    """Where the cells lie on the teeth and what wear leaves of them in each step, where there are any.

    The backlash is taken to be off by as much as the largest depths of both flanks, and by what helical lines
    have less of it that touch first where they cross their pitch line.
    """
    tips = _course(built).tips
    if tips is None:
        return {}
    new = half_teeth(built.design.mesh, _course(built).cells)
    grown, least = (
        np.array([_play(built, step_depth, pitch_line=crossed) for step_depth in depth])
        for crossed in (False, True)
    )
    return {
        "flank_half_thickness": (("member", "cell"), new.half),
        "flank_height": (("member", "cell"), new.height),
        "flank_angle": (("member", "cell"), new.angle),
        "worn_tip_land": (
            ("step", "member"),
            np.stack([tips.left(step_depth) for step_depth in depth]),
        ),
        "backlash_growth": (("step",), grown),
        "backlash_growth_error": (("step",), error.sum(axis=1) + grown - least),
    }


def _figures(
    built: Built, values: Mapping[str, np.ndarray], deepest: np.ndarray, fastest: np.ndarray
) -> dict[str, Any]:
    """What of the course is asked for first."""
    cycles, pressure = values["cycles"], values["wear_pressure"]
    speed = float(built.operation.speed)
    most = int(np.argmax(deepest[-1]))
    course = fastest[:, most]
    moves = bool(np.all(course > 0.0))
    by = wear_table(built).severe_by
    severity = course if by == "rate" else pressure
    return {
        "final_cycles": cycles[-1],
        "final_depth": deepest[-1].max(),
        "final_cycles_error": values["wear_error"][-1, most]
        / (course[-1] if course[-1] > 0.0 else np.nan),
        "life_hours": cycles[-1] * 2.0 * np.pi / speed,
        "pressure_change": pressure[-1] / pressure[0] - 1.0 if pressure[0] > 0.0 else np.nan,
        "run_in_cycles": run_in_end(cycles, course) if moves else np.nan,
        "severe_cycles": severe_start(cycles, severity, by) if moves else np.nan,
        "wear_steps": cycles.size - 1,
    }


def _sensitivities(built: Built, values: Mapping[str, np.ndarray]) -> dict[str, Any]:
    """Relative changes of rate, depth and life with those of inputs, along the steps of the march."""
    course, models = _course(built), built.models[0]
    if not _sensitive(built):
        return {}
    inputs = built.design, built.operation, course.model
    choices = models, course.cells, int(wear_table(built).phases)
    steps = values["cycles"], values["worn_depth"]
    updated = wear_table(built).profile == "updated"
    sensitivities = march_sensitivities(inputs, *choices, *steps, updated=updated)
    return {name: derivatives._asdict() for name, derivatives in sensitivities.items()}


def _sensitive(built: Built) -> bool:
    """True if derivatives are taken: never through solved films, on coupled teeth if they are asked for."""
    wanted = wear_table(built).sensitivities
    if wanted is None:
        wanted = not (built.design.mesh.body.couples and built.models[0].sharing.by_stiffness)
    return wanted and not _films(built)


def _films(built: Built) -> bool:
    """True if the load on asperities comes from solved films."""
    return _course(built).model.films is not None


def _warnings(
    built: Built, values: Mapping[str, np.ndarray], deepest: np.ndarray, end: str
) -> list[str]:
    doubts = wear_constant_doubts(built.case, _course(built).model)
    error = float(np.max(values["wear_error"][-1] / np.maximum(deepest[-1].max(), FIRST)))
    films = _course(built).model.films
    finer = "" if films is None else f"more film.nodes (of {films.nodes}), "
    if error > TOLD:
        doubts.append(
            Doubt(
                f"Wear: the largest depth may be {in_percent(error)} off by the grid on the flanks"
                f"{'' if films is None else ', that of the films'} and the "
                f"steps of the march; more wear.cells (of {int(wear_table(built).cells)}) and "
                "wear.phases (of "
                f"{int(wear_table(built).phases)}), {finer}and a smaller wear.tolerance, tell.",
                "wear grid",
                error,
                moves=error,
                about=("deepest_wear", "final_depth", "final_cycles", "life_hours"),
                brief=f"Wear: the depth may be {in_percent(error)} off by grid and steps.",
            )
        )
    if end == "lost":
        doubts.append(
            Doubt(
                f"Wear: {_lost(built)} of flanks that are worn so far were not found, and the march ends "
                "there.",
                brief=f"Wear: the march ends where {_lost(built)} were not found.",
            )
        )
    if end == "no wear":
        doubts.append(
            Doubt(
                "Wear: nothing slides under load, or the law wears nothing off: depths stay zero.",
                brief="Wear: nothing slides under load, or nothing wears off: depths are 0.",
            )
        )
    if wear_table(built).sensitivities is None and not _sensitive(built) and not _films(built):
        doubts.append(
            Doubt(
                "Wear: what the life depends on is not told; its derivatives take minutes for teeth that a "
                "ring couples. Ask for them by wear.sensitivities = true.",
                brief="Wear: what the life depends on is not told: wear.sensitivities.",
            )
        )
    line = built.design.mesh.shape == "line"
    if np.any(values["conforming"]) and not line:
        turns = float(values["cycles"][int(np.argmax(values["conforming"]))])
        doubts.append(
            Doubt(
                f"Wear: from {turns:.3g} turns on worn flanks conform; their contacts are taken to keep a "
                "tenth of the relative curvature they had, and pressures there are a guess.",
                brief=f"Wear: from {turns:.3g} turns on flanks conform: pressures are a guess.",
            )
        )
    if end == "module":
        doubts.append(
            Doubt(
                f"Wear: the march ends at {HOLDS:g} modules, beyond which flanks no longer touch where they "
                "did as new.",
                brief=f"Wear: the march ends at a depth of {HOLDS:g} modules.",
            )
        )
    if np.isinf(_hardness(built)):
        doubts.append(
            Doubt(
                "Wear: the hardness of neither flank is known, so that nothing ends the march where a "
                "surface would yield; give wear.hardness, or that of the materials.",
                brief="Wear: hardness is not known: nothing ends the march at yield.",
            )
        )
    if end == "hardness":
        doubts.append(
            Doubt(
                f"Wear: the march ends where the largest pressure on worn flanks reaches the hardness of the "
                f"softer one, {HARDNESS.show(_hardness(built))}: beyond it the surface yields, which no law "
                "of wear here knows of.",
                brief=f"Wear: ends where pressure reaches the hardness, {HARDNESS.show(_hardness(built))}.",
            )
        )
    cells = _course(built).cells
    longest, span = float(np.max(np.asarray(cells.lengths))), float(cells.span[0])
    if line and span < BRIDGED * longest:
        doubts.append(
            Doubt(
                f"Wear: pressures on worn flanks depend on wear.cells; contacts reach {1e6 * span:.2g} um to "
                f"each side on average, less than {BRIDGED:g} cells of {1e6 * longest:.3g} um, over which "
                "curvatures are averaged.",
                brief=f"Wear: contacts span {span / longest:.2g} cells, {BRIDGED:g} are asked: wear.cells.",
            )
        )
    if line and (widest := _widest(built)) > WIDEST:
        doubts.append(
            Doubt(
                f"Wear: contacts of flanks as new are up to {widest:.2g} of the radius of the sharper flank "
                f"wide to each side, and both are half spaces up to {WIDEST:g}: pressures there are a guess, "
                "and these contacts are taken to grow no wider by wear.",
                brief=f"Wear: contacts as new are {widest:.2g} flank radii wide: a guess.",
            )
        )
    if end == "outgrown" and line:
        doubts.append(
            Doubt(
                f"Wear: the march ends where a contact would grow wider to each side than {WIDEST:g} of the "
                "radius of the sharper flank as new, or than a flank is long: worn flanks conform there, and "
                "pressures of half spaces end.",
                brief="Wear: the march ends where worn flanks conform.",
            )
        )
    elif end == "outgrown":
        doubts.append(
            Doubt(
                f"Wear: the march ends where contacts have grown to {ROOM:g} times the width that they had: "
                "they conform, and Hertz's theory ends.",
                brief=f"Wear: the march ends at {ROOM:g} times the width of contacts as new.",
            )
        )
    return doubts


def _of_play(built: Built, teeth: Mapping[str, Any]) -> list[str]:
    """How far the backlash that wear adds may be off, where that is more than is silent."""
    if not teeth:
        return []
    grown, error = (float(teeth[f"backlash_growth{end}"][1][-1]) for end in ("", "_error"))
    if error <= TOLD * grown or error <= FIRST:
        return []
    off = min(error / grown, 1.0) if grown > 0.0 else 1.0
    slices = _course(built).start.contacts.active.shape[1]
    why, keys = "the grid on the flanks and the steps of the march", "wear.cells and wear.phases"
    if slices > 1:
        why += f", and by the {slices} slices of lines that do not wear at their pitch line"
        keys += f", and more models.slices (of {slices})"
    return [
        Doubt(
            f"Wear: the backlash that it adds may be {100.0 * off:.3g} % off by {why}; more {keys}, tell.",
            moves=off,
            about=("backlash_growth",),
            brief=f"Wear: the backlash it adds may be {100.0 * off:.3g} % off.",
        )
    ]


def _lost(built: Built) -> str:
    """What may not be found of worn flanks, in words."""
    return "the loads" if wear_table(built).load_ratio == "formula" else "the loads, or films,"


def _deepest(built: Built) -> float:
    """Depth up to which contacts stay on the normals of flanks as new [m]; infinite without a module."""
    module = built.dimensions.get("module")
    return np.inf if module is None else HOLDS * float(np.max(module))


def _radii(built: Built, flank: np.ndarray) -> np.ndarray:
    """Radius of places of each flank about the axis of its member; not a number where it travels."""
    mesh = built.design.mesh
    contacts: Contacts = contacts_at(mesh, _course(built).start.phase)
    radii = np.full(flank.shape, np.nan)
    for body in mesh.coordinates:
        if body.member is not None and body.turns:
            radii[body.member] = _radius(mesh, body, contacts, flank[body.member])
    return radii


def _radius(mesh: Mesh, body: Coordinate, contacts: Contacts, flank: np.ndarray) -> np.ndarray:
    active = np.asarray(contacts.active)
    point = np.asarray(contacts.point)[:, active]
    centre, axis = np.asarray(body.place), np.asarray(body.axis)
    away = np.linalg.norm(np.cross((point - centre[:, None]).T, axis), axis=1)
    along = np.broadcast_to(contacts.flank[body.member], active.shape)[active]
    # Of an involute the square of the radius grows with the arc length.
    if has(mesh, line_of_action):
        straight = np.polynomial.Polynomial.fit(along, away**2, 1)
        return np.asarray(np.sqrt(straight(flank)))
    order = np.argsort(along)
    return np.asarray(np.interp(flank, along[order], away[order]))
