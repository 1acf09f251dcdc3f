"""Grids over the patch of a contact, and the contact on one of them in units of its own."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Final, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.dry_contact import pressed
from pitchpoint.contact.ellipse import Ellipse, hertz_1881
from pitchpoint.contact.half_space import HalfSpace, graded_edges, half_space
from pitchpoint.contact.hertz import line_half_width, line_pressure
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import fast_program, program
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.line import LEAST, SLOWEST
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.heights import HeightMap, lowered
from pitchpoint.lubrication.ehl.reynolds import Flow
from pitchpoint.lubrication.ehl.texture import Smooth
from pitchpoint.lubrication.film_thickness import moes_1992

__all__ = [
    "FEWEST",
    "NEARBY",
    "Ends",
    "Layout",
    "PatchProblem",
    "dry_extents",
    "ladder",
    "laid_out",
    "leaks",
    "lowered_on",
    "problem_on",
    "without_oil",
]

Field = Float[Arrays, "y x"]
Ends = tuple[float, float]

FEWEST: Final = 33
"""Nodes along x of the coarsest grid; across it there is one cell less."""

THIN: Final = 0.006
"""Film and Rq over the square of the half-width and the curvature up to which a grid ends nearby."""

END_CELL: Final = 0.1
"""Width of the cells at the ends of a line, in half-widths, unless uniform ones are narrower."""

SPREAD: Final = 4.0
"""Square of what a film adds to the length of a contact, over radius and film."""

TRIAL: Final = (65, 64)
"""Grid of the dry contact that tells where a line carries."""

ROOM: Final = 3.0
"""Half-widths of the mean load on both sides of that grid, at first."""

HEAVY: Final = 0.9
"""Part of the rows whose load is below the one that the units are taken from."""

BY_SPEED: Final = 0.7
"""Power of the speed with which films grow."""

MOST_TRIALS: Final = 10
"""Grids on which it is looked for."""

FEWEST_ROWS: Final = 16
"""Rows that have to carry on the last of them."""


class Borders(NamedTuple):
    """How far a grid reaches from the middle of a contact.

    Attributes:
        inlet: ahead of it [half-widths].
        outlet: behind it [half-widths].
        beside: on both sides of an ellipse [its semi-axis across].
    """

    inlet: float
    outlet: float = 1.5
    beside: float = 1.6


ROOM_THICK: Final = 9.0
"""Reach ahead and to the sides of films that are thick against what bodies yield [lengths with the film]."""

NEARBY: Final = Borders(1.5, 1.2, 1.2)
"""Borders for thin films: the gap there is more than ten of them, and cells are smaller."""


WHOLE: Final = 0.98
"""Part of a line from which on it carries over all of its length."""


APART: Final = 4.0
"""Gap over the film where bodies touch from which on a film hardly carries."""


class Layout(NamedTuple):
    """Where the grid of a contact lies, and its units.

    Attributes:
        inlet: beginning of the grid along x [m].
        outlet: end of it [m].
        first, last: its ends across [m].
        end: width of the first and the last cell of a line that ends there [m]; None for uniform cells.
        length: half-width of the contact along x, with what a thick film adds to it; unit of length [m].
        pressure: largest one of the dry contact, but for edges, and less for thick films; unit of
            pressures [Pa].
        film: guess of it in the middle [m].
        half_width: of the dry contact along x, of the rows that carry most [m].
        hertz_pressure: largest one of it, but for edges [Pa].
        radius: relative radius along x that units are made of [m].
        speed: unit of speed [m/s].
        flooded: distance ahead of the middle from which on oil floods the contact [m].
        steep: one where conductances across are limited, as for thin films at tips; else zero.
        bounded: one where flow is bounded at faces where a film begins or ends within a cell, as of slow
            lines with nearly sharp ends; else zero.
    """

    inlet: float
    outlet: float
    first: float
    last: float
    end: float | None
    length: float
    pressure: float
    film: float
    half_width: float
    hertz_pressure: float
    radius: float
    speed: float
    flooded: float
    steep: float = 0.0
    bounded: float = 0.0

    def bodies(self, nodes: int, cells: int, finest: int, ends: str) -> HalfSpace:
        """Half spaces on a grid of so many nodes along and cells across, in units of length.

        The edges are every one, every second, ... of those of the finest grid.
        """
        x = np.linspace(self.inlet, self.outlet, nodes) / self.length
        edges = self._edges(finest)[:: finest // cells] / self.length
        return _bodies(tuple(x), tuple(edges), ends)

    def places(self, nodes: int, cells: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Places along in units of length, and middles of the cells across over the width of the grid."""
        edges = (self._edges(cells) - self.first) / (self.last - self.first)
        along = np.linspace(self.inlet, self.outlet, nodes) / self.length
        return along, 0.5 * (edges[1:] + edges[:-1])

    def _edges(self, cells: int) -> NDArray[np.float64]:
        if self.end is None:
            return np.linspace(self.first, self.last, cells + 1)
        length = self.last - self.first
        return 0.5 * (self.first + self.last) + graded_edges(length, cells, self.end)


@lru_cache(maxsize=8)
def _bodies(x: tuple[float, ...], edges: tuple[float, ...], ends: str) -> HalfSpace:
    return half_space(np.array(x), np.array(edges), ends)


def laid_out(contact: PatchContact, cells: int, film: float | None = None) -> Layout:
    """Where the grid of a contact lies.

    Args:
        contact: one, of values.
        cells: across it.
        film: in the middle, where it is known better than by a law of long lines [m]; the grid then has the
            room that a film takes which is thick against what the bodies yield.

    Raises:
        InputError: a line whose contact is wider than any grid, or that carries nowhere.
    """
    if contact.length is None:
        return _of_ellipse(contact, film)
    return _of_line(contact, cells, film)


def _of_ellipse(contact: PatchContact, known_film: float | None) -> Layout:
    radius, across = float(contact.radius[0]), 1.0 / float(contact.bend)
    ellipse = _ellipse(contact)
    half_width, side = float(ellipse.along), float(ellipse.across)
    pressure = float(ellipse.pressure)
    film, borders = _film_and_borders(contact, radius, half_width, pressure, known_film)
    longer, wider = _longer(contact, radius, film, half_width), _longer(contact, across, film, side)
    length, reach = half_width * longer, side * wider
    flooded = _reach(borders.inlet, _thick(longer, known_film)) * length
    ends = -min(flooded, _begins(contact, length)), borders.outlet * length
    # Oil that comes in obliquely needs an inlet beside the contact too.
    beside = _reach(borders.beside, _thick(wider, known_film))
    before = max(beside, borders.inlet * _oblique(contact)) * reach
    units = length, pressure / (longer * wider), film, half_width, pressure
    unit = _unit_of_speed(contact, radius, length)
    return Layout(*ends, -before, beside * reach, None, *units, radius, unit, flooded)


# Its elliptic integrals are loops, which would be made anew for each contact.
_hertz = program(hertz_1881)


def _ellipse(contact: PatchContact) -> Ellipse:
    """The dry contact of two smooth bodies."""
    radius, across = array(contact.radius[0]), array(1.0 / contact.bend)
    return _hertz(
        load=contact.load, radius=radius, transverse_radius=across, modulus=contact.modulus
    )


def leaks(contact: PatchContact, layout: Layout) -> bool:
    """Whether the bodies part to the sides, so that a thick film leaks: of ellipses and of crowned lines."""
    if contact.length is None:
        return True
    _, apart = _beside(contact)
    return bool(np.mean(apart > APART * layout.film) > 0.5)


def dry_extents(contact: PatchContact, layout: Layout) -> tuple[Ends, Ends]:
    """From where to where smooth bodies touch without oil along and across, a line in all rows [m]."""
    along = -layout.half_width, layout.half_width
    if contact.length is not None:
        return along, (layout.first, layout.last)
    side = float(_ellipse(contact).across)
    return along, (-side, side)


def _oblique(contact: PatchContact) -> float:
    """Part of the entrainment that runs across."""
    entrainment = float(np.max(entrainment_of(contact)))
    across = 0.5 * float(contact.across_a + contact.across_b)
    return abs(across) / entrainment if entrainment > 0.0 else 0.0


def _of_line(contact: PatchContact, cells: int, known_film: float | None) -> Layout:
    half_width, pressure, (low, high) = _carrying(contact)
    radius, face = float(np.mean(contact.radius)), float(contact.length)  # type: ignore[arg-type]
    film, borders = _film_and_borders(contact, radius, half_width, pressure, known_film)
    longer = _longer(contact, radius, film, half_width)
    length = half_width * longer
    # A line that is crowned, say, leaks to the sides as an ellipse does.
    thick = _thick(longer, known_film) if high - low < WHOLE * face else 0.0
    if thick > 0.0:
        low, high = _wetted(contact, low, high, film * thick)
    flooded = _reach(borders.inlet, thick) * length
    ends = -min(flooded, _begins(contact, length)), borders.outlet * length
    beyond = (borders.beside - 1.0) * 0.5 * (high - low) + (longer - 1.0) * half_width
    if contact.ends == "half_space":
        low_end, high_end = max(low - beyond, -0.5 * face), min(high + beyond, 0.5 * face)
    else:  # free faces are where the bodies end, whatever touches
        low_end, high_end = -0.5 * face, 0.5 * face
    reaches = low_end == -0.5 * face or high_end == 0.5 * face
    end = END_CELL * length
    fine = not reaches or end >= (high_end - low_end) / cells * (1.0 - 1e-6)
    cell = None if fine else end
    units = length, pressure / longer, film, half_width, pressure
    unit = _unit_of_speed(contact, radius, length)
    return Layout(*ends, low_end, high_end, cell, *units, radius, unit, flooded)


def _begins(contact: PatchContact, length: float) -> float:
    """Distance ahead of the middle at which oil begins; no grid begins within a contact."""
    return max(float(contact.inlet), NEARBY.inlet * length)


def _unit_of_speed(contact: PatchContact, radius: float, length: float) -> float:
    fast = max(float(np.max(entrainment_of(contact))), SLOWEST)
    return fast + abs(float(contact.approach)) * radius / length


def _longer(contact: PatchContact, radius: float, film: float, half_width: float) -> float:
    """Length over which a contact carries, over that of the dry one: thick films and asperities add to it."""
    return float(np.sqrt(1.0 + radius * SPREAD * (film + _roughness(contact)) / half_width**2))


def _roughness(contact: PatchContact) -> float:
    return 0.0 if contact.texture is None else float(contact.texture.rq)


def _thick(longer: float, known_film: float | None) -> float:
    """From zero, for films that hardly lengthen a contact, to one, for those that make all of its length.

    Zero for films that are guessed: laws of long lines do not tell how thick those are that leak.
    """
    return 0.0 if known_film is None else float((1.0 - longer**-2) ** 8)


def _reach(border: float, thick: float) -> float:
    """How far a grid reaches, over the length of a contact with its film."""
    return border + (ROOM_THICK - border) * thick


def _wetted(contact: PatchContact, low: float, high: float, film: float) -> tuple[float, float]:
    """From where to where a line carries with a film: where bodies part slowly a thick one reaches far."""
    y, apart = _beside(contact)
    near = y[apart <= ROOM_THICK**2 * film]
    return min(low, float(near[0])), max(high, float(near[-1]))


def _beside(contact: PatchContact) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places along a line, and by how much more the bodies lie apart there than where they touch [m]."""
    y = np.linspace(-0.5, 0.5, 257) * float(contact.length)  # type: ignore[arg-type]
    apart = np.asarray(contact.gap(array([0.0]), array(y)))[:, 0]
    return y, apart - np.min(apart)


def _film_and_borders(
    contact: PatchContact,
    radius: float,
    half_width: float,
    pressure: float,
    known_film: float | None,
) -> tuple[float, Borders]:
    """Film in the middle, guessed unless known [m], and a grid whose inlet floods it."""
    line_load = 0.5 * np.pi * pressure * half_width
    speed = max(float(np.max(np.abs(entrainment_of(contact)))), SLOWEST)
    oil, modulus = contact.fluid, float(contact.modulus)
    guess = moes_1992(
        line_load=array(line_load),
        entrainment=array(speed),
        viscosity=oil.viscosity,
        pressure_viscosity=oil.pressure_viscosity,
        radius=array(radius),
        modulus=contact.modulus,
    )
    film = float(guess) if known_film is None else known_film
    speeds = 2.0 * float(oil.viscosity) * speed / (modulus * radius)
    load = line_load / (modulus * radius) / np.sqrt(speeds)
    if (film + _roughness(contact)) * radius < THIN * half_width**2:
        return film, NEARBY
    inlet = np.select([load > 30.0, load > 10.0, load > 5.0], [3.0, 4.0, 5.0], 6.0)
    return film, Borders(float(inlet))


def entrainment_of(contact: PatchContact) -> NDArray[np.float64]:
    """Mean surface speed at every place, of both directions together [m/s]."""
    along = 0.5 * np.asarray(contact.speed_a + contact.speed_b)
    across = 0.5 * float(contact.across_a + contact.across_b)
    return np.hypot(along, across)


def _carrying(contact: PatchContact) -> tuple[float, float, tuple[float, float]]:
    """Half-width and pressure of a dry line, but for its edges, and from where to where it carries."""
    length, radius = float(contact.length), float(np.mean(contact.radius))  # type: ignore[arg-type]
    half_width, _ = _of_line_load(contact, float(contact.load) / length, radius)
    nodes, cells = TRIAL
    reach, low, high = ROOM * half_width, -0.5 * length, 0.5 * length
    for _ in range(MOST_TRIALS):
        x, edges = np.linspace(-reach, reach, nodes), np.linspace(low, high, cells + 1)
        bodies = half_space(x, edges)
        dry = _trial(contact, bodies)
        held = np.flatnonzero(np.any(dry > 0.0, axis=1))
        if np.any(dry[:, [0, -1]] > 0.0):
            reach *= 2.0
        elif held.size < FEWEST_ROWS and (held[0] > 0 or held[-1] < cells - 1):
            low, high = edges[max(held[0] - 2, 0)], edges[min(held[-1] + 3, cells)]
        else:
            return _of_dry(contact, bodies, dry, radius)
    raise InputError(
        f"no grid shows where a line of {1e3 * length:.4g} mm carries {float(contact.load):.4g} N: look at "
        "its relief and its radius",
        key="relief",
    )


def _trial(contact: PatchContact, bodies: HalfSpace) -> NDArray[np.float64]:
    """Dry pressure on a grid."""
    gap = contact.gap(array(np.asarray(bodies.x)), array(np.asarray(bodies.y)))
    if not np.all(np.isfinite(np.asarray(gap))):
        raise InputError(
            "the gap of the line is not a finite number everywhere: a profile may be narrower than the line",
            key="profile",
        )
    dry = without_oil(bodies, gap, contact.modulus, contact.load)
    if int(dry.status.code) != Code.SOLVED:
        raise InputError(
            f"the dry contact of the line was not found with {float(contact.load):.4g} N: look at its relief",
            key="relief",
        )
    return np.asarray(dry.pressure)


def _of_dry(
    contact: PatchContact, bodies: HalfSpace, dry: NDArray[np.float64], radius: float
) -> tuple[float, float, tuple[float, float]]:
    held = np.flatnonzero(np.any(dry > 0.0, axis=1))
    spacing = float(bodies.x[1] - bodies.x[0])
    # Next to an edge a row carries more, and its pressure is a number of the grid.
    line_load = float(np.quantile(np.sum(dry[held], axis=1), HEAVY)) * spacing
    edges = np.asarray(bodies.edges)
    ends = float(edges[held[0]]), float(edges[held[-1] + 1])
    return *_of_line_load(contact, line_load, radius), ends


def _of_line_load(contact: PatchContact, line_load: float, radius: float) -> tuple[float, float]:
    """Half-width [m] and largest pressure [Pa] of an infinite line."""
    line = {"line_load": array(line_load), "radius": array(radius), "modulus": contact.modulus}
    return float(line_half_width(**line)), float(line_pressure(**line))


without_oil = fast_program(pressed)
"""Dry contact of a given load: of trials, starts and weights, one program a grid."""


def ladder(nodes: int, cells: int) -> tuple[tuple[int, int], ...]:
    """Grids from a coarse one to that of so many nodes and cells.

    Raises:
        InputError: numbers that no grid has.
    """
    for what, number, odd in (("nodes", nodes, 1), ("cells", cells, 0)):
        even = number - odd if isinstance(number, int | np.integer) else 0
        if even < FEWEST - 1 or even & (even - 1):
            raise InputError(
                f"{number} {what}: their number is a power of two from {FEWEST - 1} on"
                + (" and one more" if what == "nodes" else ""),
                key=what,
            )
    grids = [(nodes, cells)]
    while min(grids[0]) > FEWEST:
        grids.insert(0, (grids[0][0] // 2 + 1, grids[0][1] // 2))
    return tuple(grids)


_lowered = program(lowered)


def lowered_on(maps: tuple[HeightMap, ...], layout: Layout, bodies: HalfSpace) -> Array:
    """By how much less maps make the gap in each cell of a grid, shape (y, x) [m]."""
    x, edges = (layout.length * np.asarray(places) for places in (bodies.x, bodies.edges))
    return _lowered(maps, array(x), array(edges))


class Coated(Smooth):
    """Smooth surfaces that carry load where a trial lets them touch, so that it finds back.

    A solution in which they carry any is that of a grid too coarse for the film.

    Attributes:
        stiff: pressure at a gap of zero, which grows in proportion from none at the least gap [Pa].
    """

    stiff: Float[Arrays, "..."]

    def pressure(self, gap: Float[Arrays, "..."]) -> Float[Arrays, "..."]:
        """Pressure that surfaces carry which touch [Pa]."""
        return self.stiff * jnp.maximum(1.0 - gap / self.least, 0.0)


class PatchProblem(eqx.Module):
    """One contact on a grid, in units of its own length, pressure and speed.

    Attributes:
        flow: of the oil.
        bodies: half spaces on their grid.
        apart: gap where the bodies just touch, shape (y, x).
        along: entrainment along x over the unit of speed, shape (y,).
        across: the same along y.
        yielding: deflection by a pressure of one on bodies with E' of one.
        load: over pressure and square of the length.
        film: guess of it, for a start.
        speed: unit of speed [m/s].
        length: unit of length [m].
        pace: one over the time, in units of length and speed, in which the mass under a cell went from the
            one before to what it is; zero for a steady film.
        before: mass under each cell from which it went, shape (y, x).
        steep: one where conductances across are limited by the smaller one of two rows; else zero.
        bounded: whether faces where a film begins or ends within a cell are bounded. Static: other contacts
            have their programs without it.
    """

    flow: Flow
    bodies: HalfSpace
    apart: Float[Arrays, "y x"]
    along: Float[Arrays, " y"]
    across: Float[Arrays, ""]
    yielding: Float[Arrays, ""]
    load: Float[Arrays, ""]
    film: Float[Arrays, ""]
    speed: Float[Arrays, ""]
    length: Float[Arrays, ""]
    pace: Float[Arrays, ""]
    before: Float[Arrays, "y x"]
    steep: Float[Arrays, ""]
    bounded: bool = eqx.field(static=True)

    def gap(self, pressure: Field, level: Array) -> Array:
        """Gap of the mean planes in every cell, shape (y, x)."""
        return level + self.apart + self.bodies.deflection(pressure, 1.0 / self.yielding)

    def thicker(self, factor: float) -> PatchProblem:
        """The same contact at a speed at which its film is so many times as thick."""
        changed = self.flow.resistance * factor ** (1.0 / BY_SPEED), self.film * factor
        thick: PatchProblem = eqx.tree_at(
            lambda tree: (tree.flow.resistance, tree.film), self, tuple(map(array, changed))
        )
        return thick

    def mean(self, field: Field, where: Field) -> Array:
        """Mean of a field over some cells."""
        return self.bodies.load(field * where) / self.bodies.load(where)


def problem_on(
    contact: PatchContact, layout: Layout, nodes: int, cells: int, finest: int
) -> PatchProblem:
    """A contact on one grid of a ladder; what the layout gives counts as constant for derivatives."""
    length, pressure = layout.length, layout.pressure
    bodies = layout.bodies(nodes, cells, finest, contact.ends)
    x, y = (length * np.asarray(places) for places in (bodies.x, bodies.y))
    radius, unit = layout.radius, layout.speed
    height, film = length**2 / radius, layout.film
    apart = contact.gap(array(x), array(y))
    if contact.heights:
        apart -= lowered_on(contact.heights, layout, bodies)
    entrainment = contact.entrainment(array(y))
    across = 0.5 * (contact.across_a + contact.across_b)
    fluid: Any = contact.fluid
    flow = Flow(
        fluid,
        contact.texture or Coated(array(LEAST * film), array(pressure)),
        array(pressure),
        array(height),
        12.0 * fluid.viscosity * unit * radius**2 / (length**3 * pressure),
        jnp.ones(()),
        contact.approach * radius / (length * unit),
        array(np.zeros(() if contact.conduction is None else (cells, nodes))),
    )
    fields: Any = (
        flow,
        jax.tree.map(array, bodies),
        apart / height,
        entrainment / unit,
        across / unit,
        pressure * length / (height * contact.modulus),
        contact.load / (pressure * length**2),
        array(film / height),
        array(unit),
        array(length),
        array(0.0),
        array(np.zeros((cells, nodes))),
        array(layout.steep),
        bool(layout.bounded),
    )
    return PatchProblem(*fields)
