"""Pairs of teeth on their way through the mesh, read from polynomials between events."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import equinox as eqx
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.core.programs import program
from pitchpoint.dynamics.maps import horner
from pitchpoint.efficiency.quasi_static import Design, Operation
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.period import edges, lobatto, nodes
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading.springs import springs
from pitchpoint.loading.tooth_compliance import Terms

__all__ = [
    "Passage",
    "PathStiffness",
    "on_springs",
    "passage",
    "polynomial",
    "sampled",
    "tabulated",
]

NODES = 14
"""Nodes of each segment: polynomials of a degree less."""

Lanes = Float[Array, "pair slice *b"]


class Passage(eqx.Module):
    """Contacts of a mesh and their stiffness over one period.

    Attributes:
        edges: phases between which everything is smooth [periods]; the last is the first plus one.
        contacts: with the gaps from which their springs push; every value as coefficients
            [power ... segment] of polynomials on [-1, 1].
        stiffness: of each slice along its normal likewise, zero out of contact [N/m].
    """

    edges: Float[Array, " edge"]
    contacts: Contacts
    stiffness: Float[Array, "power pair slice segment"]

    def at(self, phase: Float[Array, "*b"]) -> tuple[Contacts, Lanes]:
        """Contacts at any phase [periods], and the stiffness of each slice [N/m]."""
        place = self._place(phase)
        return self.within(self._holding(place), place)

    def segment(self, phase: Float[Array, "*b"]) -> Int[Array, "*b"]:
        """Number of the segment that holds a phase."""
        return self._holding(self._place(phase))

    def _place(self, phase: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """The same phase in the period that the edges bound."""
        return self.edges[0] + jnp.mod(phase - self.edges[0], 1.0)

    def _holding(self, place: Float[Array, "*b"]) -> Int[Array, "*b"]:
        """Number of the segment that holds a place in the period."""
        lengths = jnp.diff(self.edges)
        last_segment = jnp.max(jnp.where(lengths > 0.0, jnp.arange(lengths.shape[0]), 0))
        return jnp.clip(jnp.searchsorted(self.edges, place, side="right") - 1, 0, last_segment)

    def within(
        self, segment: Int[Array, "*b"], phase: Float[Array, "*b"]
    ) -> tuple[Contacts, Lanes]:
        """The same where the segment is known; phases at its ends are taken as inside it."""
        start, length = self.edges[:-1][segment], jnp.diff(self.edges)[segment]
        x = 2.0 * (phase - start) / jnp.where(length > 0.0, length, 1.0) - 1.0

        def read(values: Float[Array, "power ... segment"]) -> Array:
            return horner(values[..., segment], x)

        contacts, springs = jax.tree.map(read, (self.contacts, self.stiffness))
        return replace(contacts, active=contacts.active > 0.5), springs


class PathStiffness(eqx.Module):
    """Stiffness of one pair of teeth over its path, polynomials between places.

    Attributes:
        places: from the entry of the pair on; ends of the polynomials, in the unit of `Contacts.path`.
        coefficients: of powers of the way from the start of each.
    """

    places: Float[Array, " place"]
    coefficients: Float[Array, "power part"]

    def at(self, path: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Stiffness at a place [N/m]; beyond the ends the polynomials go on."""
        last_segment = self.coefficients.shape[1] - 1
        part = jnp.clip(jnp.searchsorted(self.places, path, side="right") - 1, 0, last_segment)
        return horner(self.coefficients[:, part], path - self.places[part])


def tabulated(
    place: ArrayLike | Sequence[float], stiffness: ArrayLike | Sequence[float]
) -> PathStiffness:
    """Stiffness of a pair from a table, straight between its places.

    Args:
        place: growing, in the unit of `Contacts.path` from the entry of a pair [base pitches].
        stiffness: of one pair [N/m].

    Raises:
        InputError: the places do not grow, or there are not as many of both.
    """
    at, values = np.asarray(place, float), np.asarray(stiffness, float)
    if at.ndim != 1 or at.shape != values.shape or at.size < 2 or not np.all(np.diff(at) > 0.0):
        raise InputError(
            "a table of stiffness has as many values as places, at least two, and the places grow"
        )
    return PathStiffness(
        jnp.asarray(at), jnp.asarray(np.stack([values[:-1], np.diff(values) / np.diff(at)]))
    )


def polynomial(coefficients: ArrayLike | Sequence[float]) -> PathStiffness:
    """Stiffness of a pair as a polynomial of its path, the lowest power first [N/m].

    Args:
        coefficients: of powers of `Contacts.path`, which is zero where a pair enters.
    """
    every = np.atleast_1d(np.asarray(coefficients, float))
    return PathStiffness(jnp.zeros(1), jnp.asarray(every[:, None]))


def passage(
    design: Design,
    operation: Operation,
    terms: Terms,
    stiffness: PathStiffness | float | None = None,
) -> Passage:
    """Contacts of a design and their stiffness, sampled once.

    Slices of a contact line share the stiffness of a pair by their length.

    Args:
        design: mesh and materials; its flanks are the same on all teeth.
        operation: the load at which teeth yield.
        terms: of the model by which they yield.
        stiffness: of a pair over its path, or the same everywhere [N/m]; by default that of the teeth.

    Raises:
        InputError: the stiffness is negative somewhere, or bodies without teeth have none.
    """
    mesh = design.mesh
    if stiffness is None and not has(mesh, tooth_sections):
        raise InputError("bodies without teeth need the stiffness of their contact")
    curve = polynomial(stiffness) if isinstance(stiffness, int | float) else stiffness
    sampled, lowest, place = _sampled(design, operation, terms, curve)
    if not float(lowest) >= 0.0:
        raise InputError(
            f"the stiffness of a pair of teeth is never negative, got {float(lowest):.3g} N/m at "
            f"{float(place):.3g} on its path from where it enters"
        )
    return sampled


def sampled(
    design: Design, operation: Operation, terms: Terms, curve: PathStiffness | None = None
) -> Passage:
    """The same without checks, for programs and derivatives of one's own.

    Args:
        design, operation, terms: as in `passage`.
        curve: stiffness of a pair; that of the teeth if None.
    """
    return _with_softest(design, operation, terms, curve)[0]


def on_springs(
    design: Design, contacts: Contacts, terms: Terms, load: Float[Array, ""]
) -> tuple[Contacts, Lanes]:
    """Contacts with gaps from which springs push, and the stiffness of these, see `Springs`.

    Args:
        design: mesh and materials.
        contacts: of the mesh.
        terms: of the model by which teeth yield.
        load: that the loaded coordinate carries [N m or N].

    Returns:
        Stiffness of each slice along its normal, zero out of contact [N/m].

    From the tangent of force over closing, see `Springs`.
    """
    tooth_springs = springs(design.mesh, design.loaded, contacts, design.solids, terms, load)
    return replace(contacts, gap=tooth_springs.gap), tooth_springs.stiffness


@program
def _sampled(
    design: Design, operation: Operation, terms: Terms, curve: PathStiffness | None
) -> tuple[Passage, Float[Array, ""], Float[Array, ""]]:
    return _with_softest(design, operation, terms, curve)


def _with_softest(
    design: Design, operation: Operation, terms: Terms, curve: PathStiffness | None
) -> tuple[Passage, Float[Array, ""], Float[Array, ""]]:
    """The passage, and the least stiffness with its place."""
    events = _breaks(design.mesh, curve)
    phase, _ = nodes(events, NODES)
    rigid = design.mesh.contacts(phase)
    if curve is None:
        contacts, stiffness = on_springs(design, rigid, terms, operation.load)
    else:
        contacts, stiffness = rigid, _along_path(rigid, curve)
    sampled = Passage(
        edges=edges(events),
        contacts=jax.tree.map(lambda values: _powers(jnp.asarray(values, float)), contacts),
        stiffness=_powers(stiffness),
    )
    softest = jnp.argmin(jnp.where(contacts.active, stiffness, jnp.inf))
    return sampled, stiffness.ravel()[softest], contacts.path.ravel()[softest]


def _breaks(mesh: Mesh, curve: PathStiffness | None) -> Float[Array, " event"]:
    """Events of the mesh, and phases at which a pair passes from one polynomial to the next."""
    places = jnp.zeros(0) if curve is None else curve.places[1:-1]
    return jnp.sort(jnp.concatenate([mesh.events(), jnp.mod(places, 1.0)]))


def _along_path(contacts: Contacts, curve: PathStiffness) -> Lanes:
    """Stiffness of a pair shared by its slices."""
    length = jnp.where(contacts.active, contacts.weight, 0.0)
    pair_length = jnp.sum(length, axis=1, keepdims=True)
    share = length / jnp.where(pair_length > 0.0, pair_length, 1.0)
    return curve.at(contacts.path) * share


def _powers(values: Float[Array, "... segment node"]) -> Float[Array, "power ... segment"]:
    """Coefficients of the polynomials through the nodes of each segment."""
    return jnp.moveaxis(values @ _to_powers(), -1, 0)


@cache
def _to_powers() -> np.ndarray:
    """Matrix from values at the nodes to coefficients on [-1, 1]."""
    return np.linalg.inv(np.vander(2.0 * lobatto(NODES)[0] - 1.0, increasing=True)).T
