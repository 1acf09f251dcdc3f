"""What is wrong with an input of line contacts, and what is doubtful about a result, in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, log, log2
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import jax
from pitchpoint.core.doubts import GUESSED, WITHHELD, Checks, Doubt, in_percent
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.ehl_registry import COARSE, MOST_LINE_NODES
from pitchpoint.lubrication.ehl.fields import LineFilm
from pitchpoint.lubrication.ehl.line import FLOODED, LineContact
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.flash_temperature import LEAST_PECLET
from pitchpoint.lubrication.groups import load_parameter
from pitchpoint.materials.fluid import Fluid
from pitchpoint.materials.materials_registry import SHEAR_STRESS

__all__ = [
    "GRID",
    "OF_LINE_FILMS",
    "OF_LINE_INPUTS",
    "UNKNOWN_GRID",
    "UNSOLVED",
    "SolvedLines",
    "check_line_contact",
    "extrapolated",
    "flooded_inlet",
    "line_film_warnings",
    "of_conduction",
    "of_grid",
    "of_heat",
    "of_volume",
    "starved",
]

LARGE: Final = 100.0
"""Relative radius [m] above which millimetres may have been meant."""

SOFT: Final = 1e6
"""Modulus E' [Pa] below which MPa or GPa may have been meant."""

STIFF: Final = 20.0
"""Viscosity [Pa s] above which mPa s may have been meant."""

THICKENS: Final = 1e-6
"""Pressure-viscosity coefficient [1/Pa] above which 1/GPa may have been meant."""

WEAK: Final = 1e4
"""Eyring stress [Pa] below which MPa may have been meant."""

THICK: Final = 20e-6
"""Film [m] above which a value may be in another unit: bodies with a radius of 5 m have 4 to 12 um."""

FREE: Final = ("limiting_fall", "expansion", "modulus_slope", "paluch_share")
"""Parameters of an oil that may be zero."""

NEWTONIAN: Final = "newtonian"
"""Name of the shear law without a limit."""

SHEARED: Final = 0.1
"""Shear stress over pressure that oils hardly exceed: their limiting stress is .05 to .1 of it."""

WIDE: Final = 0.1
"""Half-width over radius, or over the size of a tooth, from which on bodies are no half spaces any more."""

FALLS: Final = 0.35
"""Part of an error by the grid that twice as many nodes leave of lines without ends. They converge with
second order, smallest films less evenly: of the 106 estimates above 3 % on 65 and 129 nodes of the contacts
that `tests/long/errors_of_grids.py` draws by seeds 21 and 22, half fall to less than 0.28. Nodes that are
named by it were too few for 2 of them and more than were needed for 33; by 0.5 for none and for 50."""

GRID: Final = "grid"
"""Kind of the sentence on films that the grid makes wrong."""

UNKNOWN_GRID: Final = "unknown grid"
"""Kind of the sentence on films of which it is not known how wrong the grid makes them."""

UNSOLVED: Final = "unsolved"
"""Kind of the sentence on contacts that have no film."""


def check_line_contact(contact: LineContact) -> None:
    """InputError for values that no contact has."""
    fluid, texture = contact.fluid, contact.texture
    positive = {
        "radius": (contact.radius, "a relative radius of curvature", 1.0, "m"),
        "modulus": (contact.modulus, "a modulus E'", 1e-9, "GPa"),
        "viscosity": (fluid.viscosity, "a viscosity", 1e3, "mPa s"),
        "pressure_viscosity": (
            fluid.pressure_viscosity,
            "a pressure-viscosity coefficient",
            1e9,
            "1/GPa",
        ),
        "inlet": (contact.inlet, "a distance at which oil begins", 1e3, "mm"),
    }
    for name, value in {**fluid.shear_parameters, **fluid.pressure_parameters}.items():
        if name not in FREE:
            positive[name] = (value, f"a parameter {name} of the oil", 1.0, "in SI units")
    if texture is not None:
        positive["rq"] = (texture.rq, "a composite roughness Rq", 1e6, "um")
    if isinstance(texture, Rough):
        positive["eta_beta_sigma"] = (texture.eta_beta_sigma, "an eta_beta_sigma", 1.0, "")
        positive["sigma_over_beta"] = (texture.sigma_over_beta, "a sigma_over_beta", 1.0, "")
        if np.min(np.asarray(texture.friction)) < 0.0:
            raise InputError(
                f"a boundary friction of {np.min(np.asarray(texture.friction)):.4g}: it must not be negative",
                key="boundary_friction",
            )
    if contact.conduction is not None:
        positive |= of_conduction(contact.conduction)
    for key, (value, what, scale, unit) in positive.items():
        low = np.min(np.asarray(value))
        if not low > 0.0 and not np.isnan(low):
            amount = f"{low * scale:.4g} {unit}".strip()
            raise InputError(f"{what} of {amount}: it must be positive", key=key)


def of_conduction(given: Conduction) -> dict[str, tuple[Any, str, float, str]]:
    """What of conduction has to be positive: value, what it is, scale and unit, by its key."""
    of_oil = given.oil_conductivity, "a conductivity of the oil", 1.0, "W/m/K"
    positive: dict[str, tuple[Any, str, float, str]] = {"oil_conductivity": of_oil}
    for member, body in enumerate((given.a, given.b)):
        conducts = body.conductivity, f"a conductivity of member {member}", 1.0, "W/m/K"
        stores = body.heat_capacity, f"a heat capacity of member {member}", 1e-6, "J/cm3/K"
        positive |= {f"conductivity_{member}": conducts, f"heat_capacity_{member}": stores}
    return positive


@dataclass(frozen=True)
class SolvedLines:
    """Films of lines as checks look at them.

    Attributes:
        contact: contacts `b`.
        film: theirs.
        code: of `Code`, what became of each, shape (b,).
        grid_error: estimates of film in the middle and smallest film of each, shape (2, b).
        nodes: of their grid.
        size: of the teeth, such as the module [m]; None where bodies have none.
    """

    contact: LineContact
    film: LineFilm
    code: NDArray[np.int_]
    grid_error: NDArray[np.float64]
    nodes: int
    size: float | None

    @cached_property
    def half_width(self) -> NDArray[np.float64]:
        """Of the dry contacts [m]."""
        return np.asarray(self.film.half_width)


OF_LINE_INPUTS = Checks[SolvedLines]("lines, with a film or without")
OF_LINE_FILMS = Checks[SolvedLines]("films of lines")


def line_film_warnings(lines: SolvedLines) -> list[Doubt]:
    """What to be wary of about films."""
    told, solved = OF_LINE_INPUTS.of(lines), lines.code == Code.SOLVED
    if not solved.any():
        return told
    contact, film = jax.tree.map(lambda leaf: leaf[solved], (lines.contact, lines.film))
    parts = {"contact": contact, "film": film, "grid_error": lines.grid_error[:, solved]}
    return [*told, *OF_LINE_FILMS.of(replace(lines, **parts))]


@OF_LINE_INPUTS.add()
def _of_unsolved(lines: SolvedLines) -> Iterator[Doubt]:
    """How many contacts have no film, and why.

    Each way in which a solve ended but the one with a solution, see `Code`.
    """
    every, code = lines.code.size, lines.code[lines.code != Code.SOLVED]
    kinds = [(Code(int(number)).sentence, np.sum(code == number)) for number in np.unique(code)]
    why = (reason if len(kinds) == 1 else f"{reason} ({count})" for reason, count in kinds)
    if code.size:
        sentence = f"{code.size} of {every} contacts were not solved: {'; '.join(why)}"
        brief = f"{code.size} of {every} contacts were not solved"
        yield Doubt(sentence, UNSOLVED, code.size, moves=WITHHELD, brief=brief)


@OF_LINE_INPUTS.add()
def _of_units(lines: SolvedLines) -> Iterator[Doubt]:
    """Values that hint at another unit than the one that they are taken in.

    Beyond `LARGE`, `SOFT`, `STIFF`, `THICKENS` and `WEAK` no gears and oils are found.
    """
    contact = lines.contact
    radius, modulus, viscosity = (
        np.asarray(quantity)
        for quantity in (contact.radius, contact.modulus, contact.fluid.viscosity)
    )
    if radius.max() > LARGE:
        yield Doubt(
            f"a relative radius of {radius.max():.4g} m: nearly flat, if it was not meant in millimetres",
            "radius",
            radius.max(),
            brief=f"radius of {radius.max():.4g} m, nearly flat: meant in mm?",
        )
    if modulus.min() < SOFT:
        yield Doubt(
            f"a modulus E' of {modulus.min():.4g} Pa: softer than rubber, if it was not meant in MPa or GPa",
            "modulus",
            -modulus.min(),
            brief=f"modulus E' of {modulus.min():.4g} Pa: meant in MPa or GPa?",
        )
    if viscosity.max() > STIFF:
        yield Doubt(
            f"a viscosity of {viscosity.max():.4g} Pa s: no oil is so thick, if it was not meant in mPa s",
            "viscosity",
            viscosity.max(),
            brief=f"viscosity of {viscosity.max():.4g} Pa s: meant in mPa s?",
        )
    yield from _of_units_of_oil(contact.fluid)


@OF_LINE_INPUTS.add()
def _of_oil(lines: SolvedLines) -> Iterator[Doubt]:
    """That viscosity or density under pressure rest on assumed constants.

    Oils of the catalogue without measured ones say so themselves.
    """
    return of_volume(lines.contact.fluid)


@OF_LINE_FILMS.add()
def _of_thick(lines: SolvedLines) -> Iterator[Doubt]:
    """Films that hint at a value in another unit.

    Those thicker than `THICK`, which bodies as large as those of ships do not reach.
    """
    film = np.asarray(lines.film.central_film)
    if film.max() > THICK:
        yield Doubt(
            f"a film of {1e6 * film.max():.3g} um is far thicker than those of gears, 0.01 to 5 um: check "
            "the units of radius [m], viscosity [Pa s] and line load [N/m]",
            "thick",
            film.max(),
            brief=f"a film of {1e6 * film.max():.3g} um is too thick for gears: check units",
        )


@OF_LINE_FILMS.add()
def _of_pressure(lines: SolvedLines) -> Iterator[Doubt]:
    """Laws of the oil that end below the pressure.

    The range of each law of viscosity and density, see `Fluid.outside`.
    """
    return extrapolated(lines.contact.fluid, np.asarray(lines.film.hertz_pressure))


@OF_LINE_FILMS.add()
def _of_half_space(lines: SolvedLines) -> Iterator[Doubt]:
    """Contacts too wide for half spaces.

    A half-width of more than `WIDE` of the relative radius, or of the size of a tooth.
    """
    radius, half_width, size = np.asarray(lines.contact.radius), lines.half_width, lines.size
    sizes = {"the relative radius": radius}
    if size is not None:
        sizes["the size of a tooth"] = np.full_like(radius, size)
    for name, length in sizes.items():
        worst = np.argmax(half_width / length)
        if half_width[worst] > WIDE * length[worst]:
            yield Doubt(
                f"the contact is {2e3 * half_width[worst]:.3g} mm wide, and {name} is "
                f"{1e3 * length[worst]:.3g} mm: the bodies are no half spaces, as the deformation takes them",
                f"wide against {name}",
                half_width[worst] / length[worst],
                brief=f"contact {2e3 * half_width[worst]:.3g} mm wide, {name} "
                f"{1e3 * length[worst]:.3g} mm",
            )


@OF_LINE_FILMS.add()
def _of_inlet(lines: SolvedLines) -> Iterator[Doubt]:
    """Oil that begins nearer than it would take to flood the contact.

    The inlet beyond which more oil no longer changes the film, see `flooded_inlet`.
    """
    inlet, needed = np.asarray(lines.contact.inlet) / lines.half_width, flooded_inlet(lines.contact)
    worst = np.argmin(inlet / needed)
    if inlet[worst] < needed[worst] * (1.0 - 1e-9):
        yield starved(inlet[worst], needed[worst])


@OF_LINE_FILMS.add()
def _of_long_inlet(lines: SolvedLines) -> Iterator[Doubt]:
    """Inlets that nothing limits but a radius, over which a gap is no parabola any more.

    A flooded inlet, see `flooded_inlet`, longer than the relative radius.
    """
    contact, film = lines.contact, lines.film
    radius, endless = np.asarray(contact.radius), np.asarray(contact.inlet) >= FLOODED
    flooded = np.where(endless, flooded_inlet(contact) * np.asarray(film.half_width), 0.0)
    worst = np.argmax(flooded / radius)
    if flooded[worst] > radius[worst]:
        yield Doubt(
            f"a flooded film draws oil from {1e3 * flooded[worst]:.3g} mm before the contact on, more than "
            f"its relative radius of {1e3 * radius[worst]:.3g} mm: give the `inlet` at which oil begins",
            "long inlet",
            flooded[worst] / radius[worst],
            brief=f"a flooded film draws oil from {1e3 * flooded[worst]:.3g} mm on: give its inlet",
        )


@OF_LINE_FILMS.add()
def _of_coarse_grid(lines: SolvedLines) -> Iterator[Doubt]:
    """Errors of films by their grid, see `of_grid`.

    More than `COARSE`, estimated by the same film on half as many nodes.
    """
    return of_grid(*lines.grid_error, grid=(lines.nodes,))


@OF_LINE_FILMS.add()
def _of_shear(lines: SolvedLines) -> Iterator[Doubt]:
    """Stress that no oil bears: a Newtonian one has no limit.

    A mean shear stress of more than `SHEARED` of the mean pressure.
    """
    contact, film = lines.contact, lines.film
    *others, final = (f"'{name}'" for name in SHEAR_STRESS if name != NEWTONIAN)
    drawn, width = np.abs(film.shear_force), 2e6 * film.half_width
    worst = np.argmax(drawn / contact.line_load)
    stress, pressure = drawn[worst] / width[worst], contact.line_load[worst] / width[worst]
    if contact.fluid.shear_law == NEWTONIAN and stress > SHEARED * pressure:
        yield Doubt(
            f"a Newtonian oil is sheared by {stress:.3g} MPa in the mean at a mean pressure of "
            f"{pressure:.3g} MPa, more than oils bear: a `shear_law` that lowers it is "
            f"{', '.join(others)} or {final}",
            "shear",
            stress / pressure,
            brief=f"a Newtonian oil sheared by {stress:.3g} MPa: more than oils bear",
        )


@OF_LINE_FILMS.add()
def _of_roughness(lines: SolvedLines) -> Iterator[Doubt]:
    """Roughness that is large against the contact.

    An Rq of more than `WIDE` of the half-width.
    """
    if lines.contact.texture is None:
        return
    rough, half_width = np.asarray(lines.contact.texture.rq), lines.half_width
    worst = np.argmax(rough / half_width)
    if rough[worst] > WIDE * half_width[worst]:
        yield Doubt(
            f"a roughness Rq of {1e6 * rough[worst]:.3g} um is large against a contact that is "
            f"{2e6 * half_width[worst]:.3g} um wide: few asperities carry it, and their mean says little",
            "roughness",
            rough[worst] / half_width[worst],
            brief=f"Rq {1e6 * rough[worst]:.3g} um in a contact {2e6 * half_width[worst]:.3g} um wide",
        )


@OF_LINE_FILMS.add()
def _of_warm_film(lines: SolvedLines) -> Iterator[Doubt]:
    """Temperatures that come out too high, see `of_heat`.

    Peclet numbers below `LEAST_PECLET`, and oils whose viscosity has no slope.
    """
    contact, film = lines.contact, lines.film
    if film.heat is not None:
        peclet = np.stack([film.heat.peclet_a, film.heat.peclet_b])
        speed = np.stack([contact.speed_a, contact.speed_b])
        yield from of_heat(contact.fluid, peclet, speed, lines.half_width)


def _of_units_of_oil(oil: Fluid) -> Iterator[Doubt]:
    """The same of what pressure and shear do to an oil."""
    alpha = np.max(np.asarray(oil.pressure_viscosity))
    if alpha > THICKENS:
        yield Doubt(
            f"a pressure-viscosity coefficient of {alpha:.4g} 1/Pa: no oil thickens so much, if it was not "
            "meant in 1/GPa",
            "pressure_viscosity",
            alpha,
            brief=f"pressure-viscosity {alpha:.4g} 1/Pa: meant in 1/GPa?",
        )
    stress = np.min(np.asarray(oil.shear_parameters.get("eyring_stress", WEAK)))
    if stress < WEAK:
        yield Doubt(
            f"an Eyring stress of {stress:.4g} Pa: no oil is so weak, if it was not meant in MPa",
            "eyring_stress",
            -stress,
            brief=f"Eyring stress of {stress:.4g} Pa: meant in MPa?",
        )


def extrapolated(fluid: Fluid, pressure: NDArray[np.float64]) -> Iterator[Doubt]:
    """That the laws of an oil end below the largest of some pressures [Pa]."""
    warning, largest = fluid.outside(pressure), float(np.max(pressure))
    if warning is not None:
        sentence = f"{warning}: films and traction there are extrapolated"
        brief = f"laws of the oil extrapolated to {1e-9 * largest:.3g} GPa"
        yield Doubt(sentence, "pressure", largest, moves=GUESSED, brief=brief)


def of_volume(fluid: Fluid) -> Iterator[Doubt]:
    """That viscosity or density under pressure rest on assumed constants."""
    if fluid.assumed is not None:
        brief = "constants of this oil under pressure are assumed"
        yield Doubt(fluid.assumed, "volume of the oil", moves=GUESSED, brief=brief)


def of_heat(
    fluid: Fluid,
    peclet: NDArray[np.float64],
    speed: NDArray[np.float64],
    half_width: NDArray[np.float64],
) -> Iterator[Doubt]:
    """What to be wary of about temperatures.

    Args:
        fluid: the oil.
        peclet: Peclet numbers of both surfaces, shape (2, b).
        speed: of both [m/s].
        half_width: of the contacts, shape (b,) [m].
    """
    yield from _of_thinning(fluid)
    yield from _of_strips(peclet, speed, half_width)


def _of_strips(
    peclet: NDArray[np.float64], speed: NDArray[np.float64], half_width: NDArray[np.float64]
) -> Iterator[Doubt]:
    member, worst = np.unravel_index(np.argmin(peclet), peclet.shape)
    if peclet[member, worst] < LEAST_PECLET:
        yield Doubt(
            f"a surface passes a contact {2e3 * half_width[worst]:.3g} mm wide at "
            f"{abs(speed[member, worst]):.3g} m/s, a Peclet number of {peclet[member, worst]:.3g}: below "
            f"{LEAST_PECLET:g} heat spreads along the surface too, which comes out too warm, and one that "
            "stands still is taken to take none",
            "strips",
            -peclet[member, worst],
            brief=f"Peclet number {peclet[member, worst]:.3g}: a surface comes out too warm",
        )


def _of_thinning(fluid: Fluid) -> Iterator[Doubt]:
    if np.min(np.asarray(fluid.viscosity_slope)) <= 0.0:
        yield Doubt(
            "the temperature of the film is solved for with an oil that does not thin as it warms: its "
            "`viscosity_slope` is 0 1/K",
            "thinning",
            1.0,
            brief="the oil does not thin as it warms: viscosity_slope is 0",
        )


def of_grid(
    central: NDArray[np.float64],
    minimum: NDArray[np.float64],
    *,
    grid: tuple[int, ...],
    most: int = MOST_LINE_NODES,
    falls: float = FALLS,
) -> Iterator[Doubt]:
    """That a grid is coarse for films, or that nobody knows whether it is.

    Args:
        central: estimated errors of films in the middle, over them, NaN where unknown, shape (b,).
        minimum: the same of smallest films.
        grid: number of nodes, and that of cells across where there are any.
        most: nodes that a grid may have.
        falls: part of an error that twice as many nodes leave.
    """
    worst = np.fmax(central, minimum)
    coarse, unknown = worst > COARSE, np.isnan(minimum)
    if coarse.any():
        off = float(np.nanmax(worst))
        remedy, brief = _finer(off, grid, most, falls)
        yield Doubt(
            f"the grid is coarse for the films of {coarse.sum()} of {coarse.size} contacts: in the middle "
            f"they may be off by {in_percent(np.fmax.reduce(central, initial=0.0))}, smallest ones by "
            f"{in_percent(np.fmax.reduce(minimum, initial=0.0))}; {remedy}",
            GRID,
            off,
            moves=off,
            brief=f"coarse grid: films off by up to {in_percent(off)}, {brief}",
        )
    if unknown.any():
        yield Doubt(
            f"how far off the grid makes the films of {unknown.sum()} of {unknown.size} contacts is not "
            "known: none of a coarser grid stand beside them; compare them with those on more nodes",
            UNKNOWN_GRID,
            unknown.mean(),
            moves=GUESSED,
            brief=f"error by the grid not known of {unknown.sum()} of {unknown.size} films",
        )


def _finer(off: float, grid: tuple[int, ...], most: int, falls: float) -> tuple[str, str]:
    """What to do about films that are off by so much, and the same in few words."""
    nodes, *cells = grid
    possible = int(log2((most - 1) / max(nodes - 1, *cells, 1)))
    doubled = min(ceil(log(off / COARSE) / log(1.0 / falls)), possible)
    if not possible:
        which = "cells" if cells and cells[0] > nodes - 1 else "nodes"
        return f"{most - (which == 'cells')} {which} are the most", "no finer one"
    enough = f"{2**doubled * (nodes - 1) + 1} nodes"
    finer_grid = enough + "".join(f" and {2**doubled * number} cells" for number in cells)
    left = off * falls**doubled
    if left <= COARSE:
        return f"{finer_grid} should bring that below {100.0 * COARSE:g} %", f"take {enough}"
    return f"{finer_grid}, the most, leave some {in_percent(left)}", f"take {enough}"


def starved(given: float, needed: float) -> Doubt:
    """That oil begins nearer to a contact than it would take to flood it.

    Args:
        given: distance from the middle of the contact at which it begins [half-widths].
        needed: that from which on a fully flooded one draws it [half-widths].
    """
    return Doubt(
        f"oil begins {given:.3g} half-widths before the middle of a contact, and a fully flooded one draws "
        f"it from {needed:.3g} on: the contact is starved",
        "inlet",
        needed / given,
        brief=f"starved: oil begins at {given:.3g} half-widths, flooded at {needed:.3g}",
    )


def flooded_inlet(contact: LineContact) -> NDArray[np.float64]:
    """Length of inlet beyond which oil no longer changes the film by half a hundredth [half-widths].

    3 + 25/M, of the load parameter M = w/(E' R) (2 eta0 u/(E' R))^(-1/2): contacts with thick films draw oil
    from further away. Films are up to 0.4 % below those of an endless inlet then, rolling resistance 2 to
    11 %: of contacts solved at M of 0.1 to 100 and Moes' L of 2 to 15.
    """
    oil = contact.fluid
    properties = oil.viscosity, contact.radius, contact.modulus
    return 3.0 + 25.0 / load_parameter(contact.line_load, contact.entrainment, *properties)
