"""Films of contacts of finite length, with what became of the solve and what to be wary of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.subsurface import Stresses, below_row
from pitchpoint.core.doubts import GUESSED, WITHHELD, Checks, Doubt
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.doubts import (
    WIDE,
    extrapolated,
    of_conduction,
    of_heat,
    of_volume,
    starved,
)
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.fields import (
    FIELDS,
    STRESSES,
    VECTORS,
    ElasticResponse,
    PatchFilm,
    patch_film,
)
from pitchpoint.lubrication.ehl.patch.grid_error import grid_errors, of_patches
from pitchpoint.lubrication.ehl.patch.heat import (
    TEMPERATURES,
    PatchTemperatures,
    check_heat,
    contact_heat,
    patch_heat_defect,
    rests_somewhere,
    warmed_patch,
)
from pitchpoint.lubrication.ehl.patch.layout import Layout, PatchProblem, leaks, problem_on
from pitchpoint.lubrication.ehl.patch.newton import ENOUGH, Progress
from pitchpoint.lubrication.ehl.patch.response import (
    polished_patch,
    polished_solution,
    polished_warm,
)
from pitchpoint.lubrication.ehl.patch.roughness import check_maps, check_standing, unseen
from pitchpoint.lubrication.ehl.patch.solve import Earlier, dry_bodies, shown_film, solve
from pitchpoint.lubrication.ehl.strips import WARM_ENOUGH
from pitchpoint.lubrication.ehl.texture import Rough

__all__ = [
    "CELLS",
    "ENDS",
    "NODES",
    "OF_PATCHES",
    "OF_PATCH_FILMS",
    "PatchEnded",
    "PatchFilms",
    "SolvedPatch",
    "Turned",
    "check_patch_contact",
    "code_before_solve",
    "film_as_given",
    "film_near",
    "film_with_doubts",
    "oriented_contact",
    "solve_patch",
    "turned_contact",
]

NODES: Final = 129
"""Usual number of nodes along x: films in the middle come within .5 % of those on finer grids."""

CELLS: Final = 128
"""Usual number of cells across."""

LOST: Final = (Code.NOT_CONVERGED, Code.UNRESOLVED)
"""Codes of films that are looked for once more, with bounds on faces where a film begins or ends."""

THICK: Final = 3.0
"""Length of a contact with its film over that without from which on it is told."""

ENDS: Final = "ends"
"""Kind of the warning on lines that end sharply."""

DROPS: Final = 0.5
"""Part of Hertz's pressure from which a line falls to nothing within two cells where it ends sharply."""


@dataclass(frozen=True)
class PatchEnded:
    """How a solve ended.

    Attributes:
        code: of `Code`.
        reynolds: largest defect of the balance of a cell, in units of the dry contact's pressure.
        load: defect of the load over it.
        steps: of Newton's method, on all grids and in both tries.
        temperature: defect of the temperature of the film over its largest rise; None of isothermal films.
        turns: between pressure and temperature, on all grids; None of isothermal films.
        grid: estimate of the error of the film in the middle that the grid makes, over that film, from the
            film on a grid with half as many cells either way; NaN where there is none.
        grid_minimum: the same of the smallest film, from how the gap opens beside it too.
    """

    code: Code
    reynolds: float
    load: float
    steps: int
    temperature: float | None = None
    turns: int | None = None
    grid: float = np.nan
    grid_minimum: float = np.nan


@dataclass(frozen=True)
class PatchFilms:
    """Film of one contact with what became of it.

    Attributes:
        film: fields and what follows from them, NumPy arrays; NaN where the contact was not solved.
        ended: how the solve ended.
        layout: where the grid lies, and its units.
        pressure: solution in those units, for `film_near`, shape (y, x).
        level: of the surfaces in those units.
        held: dry pressure in those units, which films are weighed by, shape (y, x).
        response: of the bodies, in those units.
        turned: how the grid lies.
        warnings: what to be wary of, in sentences.
        rise: of the temperature of the film, as the grid lies, shape (y, x) [K]; None of isothermal films.
    """

    film: PatchFilm
    ended: PatchEnded
    layout: Layout
    pressure: NDArray[np.float64]
    level: float
    held: NDArray[np.float64]
    response: ElasticResponse
    turned: Turned
    warnings: tuple[Doubt, ...]
    rise: NDArray[np.float64] | None = None

    @property
    def solved(self) -> bool:
        """Whether the contact was solved."""
        return self.ended.code == Code.SOLVED

    def stresses(self, depth: NDArray[np.float64], poisson: float) -> Stresses:
        """Stresses by the pressure below the most loaded section along the entrainment.

        Args:
            depth: below the surface, positive; meaningful from about a cell on, shape (depth,) [m].
            poisson: Poisson's ratio of the solid.

        Raises:
            InputError: films that were not solved, depths that are not positive, another Poisson's ratio.
        """
        if not self.solved:
            raise InputError("films that were not solved have no stresses", key="films")
        (rows, nodes), layout = self.pressure.shape, self.layout
        bodies = layout.bodies(nodes, rows, rows, "half_space")
        stresses = below_row(bodies, self.pressure, np.asarray(depth) / layout.length, poisson)
        scaled: Stresses = jax.tree.map(lambda stress: stress * layout.pressure, stresses)
        return replace(scaled, depth=array(depth))


@dataclass(frozen=True)
class Turned:
    """How a grid lies, whose x follows the stronger entrainment.

    Attributes:
        swapped: whether x of the grid is y of the contact.
        along, across: whether x, y of the grid run against those of the contact.
    """

    swapped: bool = False
    along: bool = False
    across: bool = False


def solve_patch(
    contact: PatchContact,
    *,
    nodes: int = NODES,
    cells: int = CELLS,
    progress: Progress | None = None,
    start: PatchFilms | None = None,
) -> PatchFilms:
    """Pressure and film over the patch of a contact of finite length, from coarse to fine grids.

    A contact that is not solved, as a slow line with nearly sharp ends, is tried once more, with bounds on
    what flows where a film begins or ends within a cell.

    Args:
        contact: one, from `finite_line` or `elliptic_contact`.
        nodes: along x, one more than a power of two.
        cells: across, a power of two.
        progress: told the number of steps on a grid and the residual, after each of them.
        start: film of a contact that is like this one, on any grid, such as at another speed: a solution is
            looked for from there first, and is the same to the tolerance.

    Raises:
        InputError: values that no contact has, numbers of nodes or cells that no grid has, a line that is
            entrained along its length or in two senses, height maps that move or do not cover it, conduction
            between surfaces that move along both axes.
    """
    check_patch_contact(contact)
    check_standing(contact)
    lies, laid = turned_contact(contact)
    check_heat(laid)
    films = _solved(laid, lies, (nodes, cells), progress, start, bounded=False)
    if films.ended.code not in LOST:
        return films
    with_bounds = _solved(laid, lies, (nodes, cells), progress, start, bounded=True)
    chosen = with_bounds if with_bounds.solved else films
    return replace(
        chosen, ended=replace(chosen.ended, steps=films.ended.steps + with_bounds.ended.steps)
    )


def _solved(
    contact: PatchContact,
    lies: Turned,
    grid: tuple[int, int],
    progress: Progress | None,
    start: PatchFilms | None,
    *,
    bounded: bool,
) -> PatchFilms:
    """Films of a contact as its grid lies; without bounds none starts from films that have them."""
    code = code_before_solve(contact)
    alike = start if start is not None and start.layout.bounded <= bounded else None
    layout, problem, state, turns = solve(
        contact, *grid, progress, earlier=_earlier(alike), bounded=bounded
    )
    held, approach, by_load = dry_bodies(problem)
    end = _settled(problem, array(state.pressure), array(state.level))
    pressure: Any = np.asarray(end.pressure)
    response = ElasticResponse(array(approach), array(by_load), end.by_load, end.by_approach)
    ended = PatchEnded(code, float(end.rest), float(abs(end.load)), state.steps)
    if code == Code.SOLVED and ended.reynolds < ENOUGH:
        errors = grid_errors(contact, layout, problem, pressure, end.level, held)
        ended = replace(ended, grid=errors[0], grid_minimum=errors[1])
    heats = contact_heat(contact)
    if heats is not None:
        off = float(_defect(heats, problem, end.pressure, end.level))
        ended = replace(ended, temperature=off, turns=turns)
    judged = film_with_doubts(
        contact, layout, problem, pressure, float(end.level), held, response, ended
    )
    fields = film_as_given(judged.film, lies), judged.ended, layout, pressure, float(end.level)
    rise = None if heats is None else np.asarray(problem.flow.temperature_rise)
    return PatchFilms(*fields, held, response, lies, judged.warnings, rise)


class Told(NamedTuple):
    """Film of a solution as the grid lies, with what became of it."""

    film: PatchFilm
    ended: PatchEnded
    warnings: tuple[Doubt, ...]


def film_with_doubts(
    own: PatchContact,
    layout: Layout,
    problem: PatchProblem,
    pressure: NDArray[np.float64],
    level: float,
    held: NDArray[np.float64],
    response: ElasticResponse,
    ended: PatchEnded,
) -> Told:
    """Film of a solution, NaN where it is none, and what to be wary of; arguments as in `patch_film`.

    Args:
        own: the contact, entrained along x of the grid.
        ended: how the solve ended, with the code that was known before it.
    """
    # Plain numbers would be constants of the program, which would be made anew for each contact; maps are
    # in the problem, and would make it anew for each number of them.
    lies_at, plain = jax.tree.map(array, layout), replace(own, heights=())
    solution = plain, lies_at, problem, array(pressure), array(level), array(held), response
    film = jax.tree.map(np.asarray, _film(*solution))
    warm = ended.temperature is None or ended.temperature < WARM_ENOUGH
    balanced = ended.reynolds < ENOUGH and ended.load < ENOUGH and np.all(np.isfinite(held))
    code = ended.code
    if code == Code.SOLVED and not (balanced and warm):
        code = Code.NOT_CONVERGED
    # Smooth surfaces touch on a grid that is too coarse for their film.
    if code == Code.SOLVED and own.texture is None and np.any(film.asperity_pressure > 0.0):
        code = Code.UNRESOLVED
    if code != Code.SOLVED:
        film = jax.tree.map(lambda leaf: np.full_like(leaf, np.nan), film)
    least = shown_film(problem) * float(problem.flow.height)
    ended = replace(ended, code=code)
    patch = SolvedPatch(own, layout, film, ended, least)
    told = [*OF_PATCHES.of(patch), *(OF_PATCH_FILMS.of(patch) if code == Code.SOLVED else ())]
    return Told(film, ended, tuple(told))


def film_near(contact: PatchContact, films: PatchFilms) -> PatchFilm:
    """Film of a contact as a function that can be differentiated, at the contact that was solved.

    Args:
        contact: that of the films, or traced in its place.
        films: solved.

    Returns:
        The same film, with the derivatives of the solution (implicit function theorem, with heat of pressure
        and temperature together), first ones; every cell stays full of oil, or not, as it is. The grid stays
        where it is, and what belongs to it: there are no derivatives by the length of a line, nor of
        `half_width`, `hertz_pressure`, `separation`, `stiffness` and `damping`.

    Raises:
        InputError: the films were not solved, or without the temperatures that are asked for.
    """
    if not films.solved:
        raise InputError("films that were not solved have no derivatives", key="films")
    swapped = oriented_contact(contact, films.turned)
    rows, nodes = films.pressure.shape
    problem = problem_on(swapped, films.layout, nodes, rows, rows)
    solution, heats = (array(films.pressure), array(films.level)), contact_heat(swapped)
    if heats is None:
        pressure, level = polished_patch(problem, *solution)
    else:
        warm = warmed_patch(problem, array(_rise_of(films)))
        problem, pressure, level = polished_warm(heats, warm, *solution)
    fields = swapped, films.layout, problem, pressure, level, array(films.held), films.response
    return film_as_given(patch_film(*fields), films.turned)


def _rise_of(films: PatchFilms) -> NDArray[np.float64]:
    """Rise of the temperature as the grid lies."""
    if films.rise is None:
        raise InputError(
            "the films were solved without heat, and the contact has `conduction`: solve them with it",
            key="films",
        )
    return films.rise


def _earlier(films: PatchFilms | None) -> Earlier | None:
    """What a start takes from films; nothing from those that were not solved."""
    if films is None or not films.solved:
        return None
    film = float(films.film.mean_film) / films.layout.film
    return Earlier(films.layout, films.pressure - films.held, film, films.rise)


# They run once for a solution: it is quicker to compile them quickly.
_settled, _film, _defect = (
    program(polished_solution),
    program(patch_film),
    program(patch_heat_defect),
)


# ---- how a contact lies


def turned_contact(contact: PatchContact) -> tuple[Turned, PatchContact]:
    """The contact with its stronger entrainment along positive x, and how it was turned for that."""
    along = float(np.mean(np.asarray(contact.speed_a + contact.speed_b)))
    across = float(contact.across_a + contact.across_b)
    swapped = abs(across) > abs(along)
    main, minor = (across, along) if swapped else (along, across)
    lies = Turned(swapped, main < 0.0, minor < 0.0)
    return lies, oriented_contact(contact, lies)


def oriented_contact(contact: PatchContact, lies: Turned) -> PatchContact:
    """The contact as its grid lies."""
    swapped = _swapped(contact) if lies.swapped else contact
    along, across = (-1.0 if backward else 1.0 for backward in (lies.along, lies.across))
    return replace(
        swapped,
        speed_a=along * swapped.speed_a,
        speed_b=along * swapped.speed_b,
        across_a=across * swapped.across_a,
        across_b=across * swapped.across_b,
        heights=tuple(
            height_map.turned(lies.swapped, lies.along, lies.across)
            for height_map in contact.heights
        ),
    )


def _swapped(contact: PatchContact) -> PatchContact:
    """An ellipse with x and y exchanged."""
    unit = jnp.ones(1)
    return replace(
        contact,
        radius=unit / contact.bend,
        bend=1.0 / contact.radius[0],
        speed_a=contact.across_a * unit,
        speed_b=contact.across_b * unit,
        across_a=contact.speed_a[0],
        across_b=contact.speed_b[0],
    )


def film_as_given(film: PatchFilm, lies: Turned) -> PatchFilm:
    """The film as the contact was given."""
    rows, nodes = (
        slice(None, None, -1 if backward else None) for backward in (lies.across, lies.along)
    )
    sign = np.array([-1.0 if backward else 1.0 for backward in (lies.along, lies.across)])
    fields = {name: getattr(film, name)[rows, nodes] for name in FIELDS}
    fields |= {name: sign[k] * fields[name] for pair in STRESSES for k, name in enumerate(pair)}
    fields |= {name: sign * getattr(film, name) for name in VECTORS}
    fields |= {"x": sign[0] * film.x[nodes], "y": sign[1] * film.y[rows]}
    if lies.swapped:
        fields |= {name: fields[name].T for name in FIELDS}
        fields |= {name: fields[name][::-1] for name in VECTORS}
        fields |= {"x": fields["y"], "y": fields["x"]}
        for x_name, y_name in STRESSES:
            fields |= {x_name: fields[y_name], y_name: fields[x_name]}
    if film.heat is not None:
        fields["heat"] = _heat_back(film.heat, lies)
    return replace(film, **fields)


def _heat_back(heat: PatchTemperatures, lies: Turned) -> PatchTemperatures:
    """Temperatures as the contact was given."""
    rows, nodes = (
        slice(None, None, -1 if backward else None) for backward in (lies.across, lies.along)
    )
    fields = {name: getattr(heat, name)[rows, nodes] for name in TEMPERATURES}
    return replace(
        heat, **{name: field.T if lies.swapped else field for name, field in fields.items()}
    )


# ---- what is wrong with an input, and what is doubtful about a result


def code_before_solve(contact: PatchContact) -> Code:
    """What can be said of a contact before it is solved."""
    still = not np.any(np.asarray(contact.speed_a + contact.speed_b))
    if still and contact.texture is None and float(contact.approach) <= 0.0:
        return Code.NO_FILM
    return Code.NO_STEADY_HEAT if rests_somewhere(contact) else Code.SOLVED


def check_patch_contact(contact: PatchContact) -> None:
    """InputError for values that no contact has."""
    _check_shapes(contact)
    check_maps(contact)
    positive = {
        "load": (contact.load, "a load", "N"),
        "modulus": (contact.modulus, "a modulus E'", "Pa"),
        "inlet": (contact.inlet, "a distance at which oil begins", "m"),
        "radius": (contact.radius, "a relative radius of curvature", "m"),
        "viscosity": (contact.fluid.viscosity, "a viscosity", "Pa s"),
        "pressure_viscosity": (
            contact.fluid.pressure_viscosity,
            "a pressure-viscosity coefficient",
            "1/Pa",
        ),
    }
    if contact.length is None:
        positive["transverse_radius"] = (1.0 / contact.bend, "a transverse radius", "m")
    else:
        positive["length"] = (contact.length, "a length of the contact line", "m")
    if contact.texture is not None:
        positive["rq"] = (contact.texture.rq, "a composite roughness Rq", "m")
    if contact.conduction is not None:
        for key, (value, what, scale, unit) in of_conduction(contact.conduction).items():
            positive[key] = (value * scale, what, unit)
    for key, (value, what, unit) in positive.items():
        low = float(np.min(np.asarray(value)))
        # Written so that NaN fails.
        if not 0.0 < low < np.inf:
            raise InputError(f"{what} of {low:.4g} {unit}: it must be positive and finite", key=key)
    for leaf in jax.tree.leaves(contact):
        if not np.all(np.isfinite(np.asarray(leaf))):
            raise InputError("a value of the contact is not a finite number")
    _check_senses(contact)


def _check_shapes(contact: PatchContact) -> None:
    """InputError for arrays where one number belongs, and for places that do not rise."""
    single = {"load": contact.load, "modulus": contact.modulus, "approach": contact.approach}
    single |= {"across": contact.across_a + contact.across_b, "inlet": contact.inlet}
    if contact.length is not None:
        single["length"] = contact.length
    else:
        single["transverse_radius"] = contact.bend
    if contact.conduction is not None:
        single |= {key: entry[0] for key, entry in of_conduction(contact.conduction).items()}
    for key, value in single.items():
        if np.ndim(value):
            raise InputError(
                f"one contact has one {key}, not an array of shape {np.shape(value)}", key=key
            )
    for key in ("radius", "speed_a", "speed_b"):
        if contact.length is None and np.shape(getattr(contact, key)) != (1,):
            word = key.replace("_", " ")
            raise InputError(f"an ellipse has one {word} along x, not an array", key=key)
    places = np.asarray(contact.places)
    if places.ndim != 1 or not np.all(np.diff(places) > 0.0):
        raise InputError("places along the line have to rise", key="places")
    if isinstance(contact.texture, Rough) and contact.texture.pattern != 1.0:
        raise InputError(
            f"a pattern of roughness of {contact.texture.pattern:.4g}: over a patch oil flows both ways, and "
            "only the pattern 1 is the same for both",
            key="pattern",
        )


def _check_senses(contact: PatchContact) -> None:
    speeds = np.asarray(contact.speed_a + contact.speed_b)
    if contact.length is not None and float(contact.across_a + contact.across_b) != 0.0:
        raise InputError(
            "a line is entrained across it; along its length it has no solver", key="across"
        )
    if np.any(speeds > 0.0) and np.any(speeds < 0.0):
        raise InputError(
            "the surfaces draw oil in from one side at some places along the line and from the other at "
            "others; take these as contacts of their own",
            key="speed_a",
        )


@dataclass(frozen=True)
class SolvedPatch:
    """Film over a patch as checks look at it.

    Attributes:
        contact: along x of the grid.
        layout: of the grid.
        film: NaN where none was found.
        ended: how the solve ended.
        least: gap that opens beside the contact within a cell [m].
    """

    contact: PatchContact
    layout: Layout
    film: PatchFilm
    ended: PatchEnded
    least: float


OF_PATCHES = Checks[SolvedPatch]("a patch, with a film or without")
OF_PATCH_FILMS = Checks[SolvedPatch]("a film over a patch")


@OF_PATCHES.add()
def _of_half_space(patch: SolvedPatch) -> Iterator[Doubt]:
    """Contacts too wide for half spaces.

    A half-width of more than `WIDE` of the relative radius.
    """
    half_width, radius = patch.layout.half_width, float(np.min(np.asarray(patch.contact.radius)))
    if half_width > WIDE * radius:
        yield Doubt(
            f"the contact is {2e3 * half_width:.3g} mm wide, and the relative radius is {1e3 * radius:.3g} "
            "mm: the bodies are no half spaces, as the deformation takes them",
            "wide",
            half_width / radius,
            brief=f"contact {2e3 * half_width:.3g} mm wide, relative radius {1e3 * radius:.3g} mm",
        )


@OF_PATCHES.add()
def _of_unsolved(patch: SolvedPatch) -> Iterator[Doubt]:
    """Why there is no film.

    Each way in which a solve ended but the one with a solution, see `Code`.
    """
    if patch.ended.code != Code.SOLVED:
        sentence = f"the film was not found: {patch.ended.code.sentence}"
        yield Doubt(sentence, moves=WITHHELD, brief="the film of a contact was not found")


@OF_PATCH_FILMS.add()
def _of_room(patch: SolvedPatch) -> Iterator[Doubt]:
    """Oil that begins nearer than it would take to flood the contact, and thick films that leak.

    The flooded inlet of the layout, a film that lengthens the contact more than `THICK` times, and an inlet
    shorter than grids of patches have it.
    """
    contact, layout = patch.contact, patch.layout
    begins, wanted = -layout.inlet, float(contact.inlet)
    if begins < layout.flooded * (1.0 - 1e-9):
        yield starved(begins / layout.half_width, layout.flooded / layout.half_width)
    longer = layout.length / layout.half_width
    if longer > THICK and leaks(contact, layout):
        yield Doubt(
            f"the film lengthens the contact {longer:.3g} times: in the room of its grid it comes out up to "
            "20 % too thin",
            "thick",
            longer,
            moves=0.2,
            brief=f"the film lengthens the contact {longer:.3g} times: up to 20 % too thin",
        )
    if wanted < begins * (1.0 - 1e-9):
        yield Doubt(
            f"oil is to begin {1e3 * wanted:.3g} mm before the middle of a contact, and a patch has it from "
            f"{1e3 * begins:.3g} mm on at the nearest: the film comes out too thick",
            "inlet of a patch",
            begins / wanted,
            brief=f"oil begins at {1e3 * begins:.3g}, not {1e3 * wanted:.3g} mm: film too thick",
        )


@OF_PATCH_FILMS.add()
def _of_oil(patch: SolvedPatch) -> Iterator[Doubt]:
    """Laws of the oil under pressure that rest on assumed constants or end below this one.

    Oils of the catalogue without measured constants say so; each law has its range, see `Fluid.outside`.
    """
    yield from of_volume(patch.contact.fluid)
    yield from extrapolated(patch.contact.fluid, np.asarray(patch.film.hertz_pressure))


@OF_PATCH_FILMS.add()
def _of_grid(patch: SolvedPatch) -> Iterator[Doubt]:
    """Films that are thin for their grid.

    A gap that opens by more than the film within a cell, and errors of more than `COARSE`.
    """
    film, least, ended = patch.film, patch.least, patch.ended
    if 0.0 < film.mean_film < least:
        yield Doubt(
            f"the grid is coarse for a film of {1e9 * film.mean_film:.3g} nm: beside the contact the gap "
            f"opens by {1e9 * least:.3g} nm within a cell; take more nodes",
            "opening",
            least / float(film.mean_film),
            brief=f"coarse grid for a film of {1e9 * film.mean_film:.3g} nm: take more nodes",
        )
    rows, nodes = film.pressure.shape
    errors = np.array([[ended.grid], [ended.grid_minimum]])
    yield from of_patches(errors, (nodes, rows), line=patch.contact.length is not None)


@OF_PATCH_FILMS.add()
def _of_end(patch: SolvedPatch) -> Iterator[Doubt]:
    """That the smallest film lies where the grid does not show how the end of a line drops.

    Two rows within a cell of it over which the dry pressure drops by `DROPS` of the largest.
    """
    contact, film = patch.contact, patch.film
    held, lowest = np.max(film.dry_pressure, axis=1), np.argmin(np.min(film.gap, axis=1))
    rows = np.flatnonzero(held > 0.0)
    near = [two for two in (rows[:2], rows[-2:]) if np.min(np.abs(two - lowest)) < 2]
    if contact.length is None or not any(
        max(held[two]) > DROPS * film.hertz_pressure for two in near
    ):
        return
    yield Doubt(
        "the contact line drops to its end within two cells: the smallest film, "
        f"{1e9 * film.minimum_film:.3g} nm, lies there and is a number of the grid, which twice as many "
        "nodes move by tens of percent; rely on films away from the end, or give it a longer relief",
        "sharp end",
        -float(film.minimum_film),
        moves=GUESSED,
        brief="smallest film lies at a sharp end: a number of the grid",
    )


@OF_PATCH_FILMS.add()
def _of_bounds(patch: SolvedPatch) -> Iterator[Doubt]:
    """Films that were found with bounds on what flows.

    Of a ball that has films with bounds and without both were solved.
    """
    if patch.layout.bounded:
        yield Doubt(
            "the film was found with bounds on what flows where it begins or ends within a cell, and without "
            "them not: of a ball that has both films they moved rolling by 16 %; more nodes may do without",
            "bounded",
            1.0,
            brief="film found with bounds at its ends: take more nodes",
        )


@OF_PATCH_FILMS.add()
def _of_warm_film(patch: SolvedPatch) -> Iterator[Doubt]:
    """Temperatures that come out too high, see `of_heat`.

    Peclet numbers below `LEAST_PECLET`, and oils whose viscosity has no slope.
    """
    contact, heat = patch.contact, patch.film.heat
    if heat is not None:
        peclet = np.array([[heat.peclet_a], [heat.peclet_b]])
        slowest = [[np.min(np.abs(speed))] for speed in (contact.speed_a, contact.speed_b)]
        half_width = np.array([patch.layout.half_width])
        yield from of_heat(contact.fluid, peclet, np.array(slowest), half_width)


@OF_PATCH_FILMS.add()
def _of_heights(patch: SolvedPatch) -> Iterator[Doubt]:
    """What the grid does not show of height maps, see `unseen`.

    Less than `SHOWN` of the Rq of a map, or heights larger than what the load flattens.
    """
    rows, nodes = patch.film.pressure.shape
    return unseen(patch.contact, patch.layout, nodes, rows)


@OF_PATCH_FILMS.add()
def _of_sharp_end(patch: SolvedPatch) -> Iterator[Doubt]:
    """Pressure at the ends of a line that the grid decides on.

    A first or last row with more than the Hertz pressure.
    """
    film = patch.film
    if patch.contact.length is not None and np.max(film.pressure[[0, -1]]) > film.hertz_pressure:
        yield Doubt(
            "the contact line ends sharply: the pressure of the first and the last row is a number of the "
            "grid; `near_ends` has it at distances from the ends",
            ENDS,
            1.0,
            brief="the contact line ends sharply: see near_ends for its pressure",
        )
