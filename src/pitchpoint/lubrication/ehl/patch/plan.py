"""Contacts of finite length over time, and the grid that holds them all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import array, jax
from pitchpoint.core.factored import Arrays
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import (
    Layout,
    PatchProblem,
    ladder,
    laid_out,
    problem_on,
)
from pitchpoint.lubrication.ehl.patch.patch_films import (
    Turned,
    check_patch_contact,
    oriented_contact,
    turned_contact,
)
from pitchpoint.lubrication.ehl.patch.roughness import check_maps_on

__all__ = ["Plan", "all_lie", "check_times", "placed_contacts", "surface_travel"]


def check_times(contacts: Sequence[PatchContact], times: NDArray[np.float64]) -> None:
    """InputError for contacts and times that make no march."""
    if times.shape != (len(contacts),) or not len(contacts):
        raise InputError(
            f"{len(contacts)} contacts at times of the shape {times.shape}: every contact has its time",
            key="times",
        )
    if not np.all(np.isfinite(times)) or not np.all(np.diff(times) > 0.0):
        raise InputError("the times of a march have to rise", key="times")
    for contact in contacts:
        check_patch_contact(contact)
    if any(_kind(contact) != _kind(contacts[0]) for contact in contacts):
        raise InputError(
            "the contacts of a march are of one kind: the same ends, oil laws, textures and height maps, "
            "with arrays of the same shapes",
            key="contacts",
        )
    if any(contact.conduction is not None for contact in contacts):
        raise InputError(
            "films over time are isothermal, temperatures those of steady films: leave `conduction` out",
            key="conduction",
        )
    if any(float(contact.approach) for contact in contacts[1:]):
        raise InputError(
            "the bodies of a march approach each other as the load asks: only the first film takes a speed "
            "of approach",
            key="approach",
        )


def _kind(contact: PatchContact) -> tuple[Any, ...]:
    leaves, structure = jax.tree.flatten(contact)
    return structure, [np.shape(leaf) for leaf in leaves]


def all_lie(contacts: Sequence[PatchContact]) -> Turned:
    """How the grid of all contacts lies."""
    orientations = [turned_contact(contact)[0] for contact in contacts if _moves(contact)]
    lies = orientations[0] if orientations else Turned()
    if any(orientation != lies for orientation in orientations):
        raise InputError(
            "the entrainment turns round or to another axis during the march; march each part alone",
            key="speed_a",
        )
    return lies


def _moves(contact: PatchContact) -> bool:
    speeds = contact.speed_a + contact.speed_b, contact.across_a + contact.across_b
    return any(bool(np.any(np.asarray(speed))) for speed in speeds)


class Plan:
    """Contacts at any time, as their grid lies, and that grid.

    Attributes:
        times: at which they are given [s].
        lies: how the grid lies.
        grid: numbers of nodes and cells.
        contacts: at these times.
        passed: ways of both surfaces along and across until then, shape (time, 2, 2) [m].
        own: where the grid of each of them alone would lie.
        layout: where the common one lies.
    """

    def __init__(
        self,
        contacts: Sequence[PatchContact],
        times: NDArray[np.float64],
        lies: Turned,
        nodes: int,
        cells: int,
        layout: Layout | None = None,
    ) -> None:
        self.times, self.lies, self.grid = times, lies, (nodes, cells)
        self.contacts = [oriented_contact(contact, lies) for contact in contacts]
        self.passed = surface_travel(self.contacts, times)
        self.own = [laid_out(contact, cells) for contact in self.contacts]
        self.layout = layout or _common(self.own)

    def check(self) -> None:
        """InputError for numbers that no grid has, and for maps that leave the contact on the way."""
        ladder(*self.grid)
        for number, time in enumerate(self.times):
            check_maps_on(self.contact(time), self.layout_of(number), self.grid[1])

    def layout_of(self, number: int) -> Layout:
        """The common grid and its units, with the film and the dry contact of one time."""
        layout = self.own[number]
        changes = {"film": layout.film, "half_width": layout.half_width}
        return self.layout._replace(**changes, hertz_pressure=layout.hertz_pressure)

    def contact(self, time: float) -> PatchContact:
        """The contact at a time, with its maps where they are, and no approach but that of the film."""
        number = int(np.clip(np.searchsorted(self.times, time) - 1, 0, len(self.times) - 2))
        if len(self.times) == 1:
            return self._placed(self.contacts[0], np.zeros((2, 2)))
        step = self.times[number + 1] - self.times[number]
        part = (time - self.times[number]) / step
        before, after = self.contacts[number : number + 2]
        between: PatchContact = jax.tree.map(lambda a, b: _between(a, b, part), before, after)
        speeds = _speeds(before), _speeds(after)
        distances = part * speeds[0] + 0.5 * part**2 * (speeds[1] - speeds[0])
        return self._placed(between, self.passed[number] + step * distances)

    def _placed(self, contact: PatchContact, distances: NDArray[np.float64]) -> PatchContact:
        return replace(_moved(contact, distances), approach=array(0.0))

    def problem(self, time: float) -> PatchProblem:
        """The contact at a time, in units of the common grid."""
        nodes, cells = self.grid
        return problem_on(self.contact(time), self.layout, nodes, cells, cells)


def placed_contacts(
    contacts: Sequence[PatchContact], times: NDArray[np.float64]
) -> list[PatchContact]:
    """Contacts of a march with their height maps where their surfaces have taken them until then."""
    if not contacts[0].heights:
        return list(contacts)
    ways = surface_travel(contacts, times)
    return [_moved(contact, distances) for contact, distances in zip(contacts, ways, strict=True)]


def _moved(contact: PatchContact, distances: NDArray[np.float64]) -> PatchContact:
    """A contact whose surfaces have passed by some ways along and across, shape (2, 2) [m]."""
    maps = tuple(
        height_map.standing()
        if height_map.member is None
        else height_map.standing(*distances[height_map.member])
        for height_map in contact.heights
    )
    return replace(contact, heights=maps)


def _between(before: Float[Arrays, "..."], after: Float[Arrays, "..."], part: float) -> Array:
    return array((1.0 - part) * np.asarray(before) + part * np.asarray(after))


def _speeds(contact: PatchContact) -> NDArray[np.float64]:
    """Surface speeds of both members along and across, shape (2, 2) [m/s]."""
    along = [float(np.mean(speed)) for speed in (contact.speed_a, contact.speed_b)]
    return np.array([along, [float(contact.across_a), float(contact.across_b)]]).T


def surface_travel(
    contacts: Sequence[PatchContact], times: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Ways of both surfaces along and across at every time, shape (time, 2, 2) [m]."""
    speeds = np.stack([_speeds(contact) for contact in contacts])
    ways = 0.5 * (speeds[1:] + speeds[:-1]) * np.diff(times)[:, None, None]
    return np.concatenate((np.zeros((1, 2, 2)), np.cumsum(ways, axis=0)))


def _common(layouts: Sequence[Layout]) -> Layout:
    """A grid that holds all contacts, in units of the largest."""
    largest = max(layouts, key=lambda layout: layout.length)
    lows = {
        name: min(getattr(layout, name) for layout in layouts)
        for name in ("inlet", "first", "film")
    }
    highs = {
        name: max(getattr(layout, name) for layout in layouts)
        for name in ("outlet", "last", "speed", "flooded")
    }
    return largest._replace(**lows, **highs)
