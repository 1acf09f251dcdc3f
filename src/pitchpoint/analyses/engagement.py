"""The engagement of one pair: its contact from where it begins to carry to where it ends, over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from pitchpoint.analyses.film_contacts import film_table, patch_grid_of
from pitchpoint.analyses.whole_contacts import SPAN, Wholes, one_contact, whole_contacts
from pitchpoint.cases.built import Built
from pitchpoint.cases.film_choices import course_grid, course_moments
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import Layout, laid_out
from pitchpoint.lubrication.ehl.patch.plan import placed_contacts, surface_travel
from pitchpoint.lubrication.ehl.patch.roughness import check_maps, check_maps_on

__all__ = ["PairCourse", "check_course", "check_heights", "course_of"]

KEY = "film.time"
"""Of the case file, which asks for an engagement."""

LIGHT = 0.1
"""Load over the largest one of the engagement below which a contact is too narrow for the grid of all."""

SHOWN = 1.5
"""Nodes over the half-width of a contact that the grid of the engagement has to have."""

MOST_STEPS = 1000
"""Steps of a height map that pass the contact: a film takes about a step of time for each."""

FEWEST = 2
"""Moments that make an engagement."""

APART = 1e-6
"""Periods between moments that are told apart: both sides of an event are one."""


@dataclass(frozen=True, eq=False)
class PairCourse:
    """The contact of one pair at moments of its engagement.

    Attributes:
        times: from the first moment on, rising, shape (moment,) [s].
        places: phase, pair and line in the mesh cycle that each moment is taken from, shape (moment, 3).
        contacts: one at each moment.
        told: what is left out of the engagement, in sentences.
    """

    times: np.ndarray
    places: np.ndarray
    contacts: tuple[PatchContact, ...]
    told: tuple[str, ...]

    def values(self, lanes: np.ndarray) -> np.ndarray:
        """Values of contacts [phase, pair, line] at the moments [moment]."""
        at_moments: np.ndarray = lanes[tuple(self.places.T)]
        return at_moments


def check_course(built: Built) -> None:
    """InputError if the films of an engagement are asked for and cannot be had."""
    course, cells = course_of(built), course_grid(film_table(built))[1]
    if film_table(built).heights is None:
        return
    _check_travel(course)
    for contact in placed_contacts(course.contacts, course.times):
        _check_maps(contact, cells)


def check_heights(built: Built) -> None:
    """InputError for height maps that do not fit the contact that carries most."""
    if film_table(built).heights is None:
        return
    contacts = whole_contacts(built)
    loads = np.where(contacts.states["loaded"], contacts.states["load"], 0.0)
    if loads.any():
        at = np.unravel_index(np.argmax(loads), loads.shape)
        _check_maps(one_contact(built, contacts.numbers[at]), patch_grid_of(built)[1])


def _check_travel(course: PairCourse) -> None:
    """InputError for height maps that take too many steps of time to pass."""
    for height_map in course.contacts[0].heights:
        if height_map.member is None:
            continue
        distance = abs(
            float(surface_travel(course.contacts, course.times)[-1, height_map.member, 0])
        )
        step = float(np.min(np.diff(np.asarray(height_map.x))))
        if distance > MOST_STEPS * step:
            raise InputError(
                f"{1e3 * distance:.4g} mm of the surface pass the contact in its engagement, in steps of "
                f"{1e6 * step:.4g} um, and films follow at most {MOST_STEPS} of them; take a coarser map, or "
                "one of both surfaces, which stays where it is",
                key="film.heights",
            )


def _check_maps(contact: PatchContact, cells: int) -> None:
    try:
        check_maps(contact)
        check_maps_on(contact, laid_out(contact, cells), cells)
    except InputError as error:
        raise InputError(error.message, key="film.heights") from None


@lru_cache(maxsize=2)
def course_of(built: Built) -> PairCourse:
    """The engagement of the pair of a case.

    Pairs are alike but for where they are, and what one does now another does a period later: states of all
    pairs over the mesh cycle are those of one pair over its engagement. Of zones that are alike the first
    one counts, and of several lines of a pair that which carries most.

    Raises:
        InputError: nothing is loaded, contact lines that move across the face all the time, no contacts that
            one grid shows.
    """
    contacts = whole_contacts(built)
    if not np.any(contacts.states["loaded"]):
        raise InputError("nothing is loaded, and no film is squeezed; leave it out", key=KEY)
    places, entered = _in_order(built, contacts)
    load = _values(contacts, "load", places)
    most = int(np.argmax(load))
    heavy, long = load >= LIGHT * load[most], _stays(contacts, places, most)
    stretch = _around(heavy & long, most)
    if stretch.stop - stretch.start < FEWEST:
        raise InputError(
            "the contact line of these gears grows, shrinks or moves across the face all the time, and a "
            "film is squeezed on lines that stay as they are; leave it out",
            key=KEY,
        )
    notes = [
        text for text, taken in zip((_LIGHT, _SHORT), (heavy, long), strict=True) if not taken.all()
    ]
    some = stretch.start + _thinned(stretch, most, course_moments(film_table(built)))
    return _taken(built, contacts, entered, places, some, notes)


_LIGHT = (
    f"moments with less than {100.0 * LIGHT:.0f} % of the largest load are left out, where the contact is "
    "narrow for a grid that holds all"
)
_SHORT = (
    "moments are left out at which the contact line is shorter than where it carries most, or lies elsewhere "
    "across: a film is squeezed on lines that stay on the face as they are"
)


def _values(given: Wholes, name: str, places: np.ndarray) -> np.ndarray:
    at_places: np.ndarray = given.states[name][tuple(places.T)]
    return at_places


def _stays(given: Wholes, places: np.ndarray, most: int) -> np.ndarray:
    """True for moments at which the contact lies across the face as that does which carries most."""
    lengths, across = (_values(given, name, places) for name in ("weight_of_line", "across"))
    off = np.maximum(np.abs(lengths - lengths[most]), np.abs(across - across[most]))
    in_place: np.ndarray = off <= SPAN * lengths[most]
    return in_place


def _period(built: Built) -> float:
    """Time of a period of the mesh [s]."""
    return float(built.nominal["period"]) / float(built.operation.speed)


def _in_order(built: Built, given: Wholes) -> tuple[np.ndarray, np.ndarray]:
    """Loaded contacts of one pair as they follow each other, and the periods that the pair has moved.

    Pairs are numbered as they stand in the mesh, a period apart, and phases count on from pair to pair.
    """
    states = given.states
    zones = int(built.way["zones"])
    pairs = states["load"].shape[1] // zones
    line = int(np.argmax(np.max(states["load"][:, :pairs], axis=(0, 1))))
    phase, pair = np.nonzero(states["loaded"][:, :pairs, line])
    entered = np.mod(states["phase"][phase], 1.0) + pair
    order = np.argsort(float(built.nominal["onward"]) * entered, kind="stable")
    ahead = np.abs(entered[order] - entered[order][0])
    several = np.append(True, np.diff(ahead) > APART)
    places = np.stack([phase, pair, np.full(phase.shape, line)], axis=-1)[order]
    return places[several], ahead[several]


def _around(taken: np.ndarray, middle: int) -> slice:
    """The run of moments that are taken, without a gap, around one of them."""
    gone = np.flatnonzero(~taken)
    before, behind = gone[gone < middle], gone[gone > middle]
    return slice(int(np.max(before, initial=-1)) + 1, int(np.min(behind, initial=taken.size)))


def _thinned(kept: slice, heaviest: int, most: int) -> np.ndarray:
    """So many moments of a run, from its first one on, with the one that carries most among them."""
    size = kept.stop - kept.start
    moments = np.linspace(0, size - 1, min(size, most)).round().astype(int)
    moments[np.argmin(np.abs(moments - (heaviest - kept.start)))] = heaviest - kept.start
    return np.unique(moments)


def _taken(
    built: Built,
    given: Wholes,
    entered: np.ndarray,
    every: np.ndarray,
    some: np.ndarray,
    told: list[str],
) -> PairCourse:
    """Moments whose contacts one grid shows, as many as follow each other with the one that carries most.

    Args:
        built: the case.
        given: contacts of its mesh cycle.
        entered: periods that the pair has moved at each loaded moment, shape (moment,).
        every: phase, pair and line of these, shape (moment, 3).
        some: which of them are looked at.
        told: what is left out already.
    """
    nodes, cells = course_grid(film_table(built))
    places = every[some]
    contacts = [one_contact(built, given.numbers[at], moving=True) for at in map(tuple, places)]
    layouts: list[Layout | None] = []
    for contact in contacts:
        try:
            layouts.append(laid_out(contact, cells))
        except InputError as error:
            layouts.append(None)
            told.append(f"a contact ends the engagement that no grid takes: {error.message}")
    stretch = _shown(layouts, nodes, int(np.argmax(_values(given, "load", places))))
    if stretch.stop - stretch.start < FEWEST:
        raise InputError(
            "contacts of this pair differ so much that no grid shows the one that carries most together with "
            "one before or behind it; take more nodes, or leave it out",
            key=KEY,
        )
    if stretch.stop - stretch.start < len(layouts) and None not in layouts:
        told.append(_NARROW)
    at = entered[some][stretch]
    if told:
        begin, end = (100.0 * float(at[k] / entered[-1]) for k in (0, -1))
        told.insert(0, f"the pair is followed from {begin:.0f} to {end:.0f} % of its engagement")
    fields = (at - at[0]) * _period(built), places[stretch], tuple(contacts[stretch])
    return PairCourse(*fields, tuple(dict.fromkeys(told)))


_NARROW = (
    "moments are left out whose contacts are too narrow or too wide for one grid with the others: it shows "
    f"all half-widths with {SHOWN:g} nodes at least"
)


def _shown(layouts: Sequence[Layout | None], nodes: int, heaviest: int) -> slice:
    """The longest run of contacts around the one that carries most, all of which one grid shows."""
    best = slice(0, 0)
    for start in range(heaviest + 1):
        begin, end, narrow = np.inf, -np.inf, np.inf
        for number, layout in enumerate(layouts[start:], start):
            if layout is None:
                break
            begin, end = min(begin, layout.inlet), max(end, layout.outlet)
            narrow = min(narrow, layout.half_width)
            if narrow / (end - begin) * (nodes - 1) < SHOWN:
                break
            if number >= heaviest and number + 1 - start > best.stop - best.start:
                best = slice(start, number + 1)
    return best
