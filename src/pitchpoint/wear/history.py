"""What one turn of the drive wears off the flanks: pressure and sliding of contacts that travel over them."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Spot, Surfaces
from pitchpoint.contact.worn import Worn, WornAt, averaged, with_worn
from pitchpoint.core.factored import Arrays, product_array
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import (
    Coupling,
    Design,
    Engagement,
    Models,
    Operation,
    shares_at,
    state,
)
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.pairs import flanks_in_turn
from pitchpoint.gears.period import edges
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading.tooth_compliance import TeethAt, teeth_at
from pitchpoint.lubrication.conditions import UNITS, Conditions, evaluate
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.flash_temperature import Conductor, shared_flash
from pitchpoint.lubrication.lubrication_registry import AsperityLoad
from pitchpoint.materials.lubricants import Lubricant
from pitchpoint.wear.film_defect import fractional_film_defect
from pitchpoint.wear.film_share import asperity_share

__all__ = [
    "ROOM",
    "Cells",
    "DriverTurn",
    "Start",
    "WearModel",
    "cells_on",
    "midpoints",
    "reached_ends",
    "slice_extents",
    "travelled",
    "turn_alone",
    "unworn_start",
    "wear_of",
    "wear_of_turn",
    "worn_contacts",
]

STRIPS_OF_ELLIPSE = 32
"""Strips across the face where contacts are ellipses."""

ROOM = 2.5
"""Half-width of the strips of ellipses together, over the largest semi-axis of flanks as new."""

_SHORT = 1e-3  # of a cell: shorter ways count as that long

_SLICED = 6  # slices of a line from which on half of them show how its load falls to an end

# Of the three midpoints beside an end, in what a parabola and a straight line have there.
_PARABOLA, _STRAIGHT = (15.0 / 8.0, -10.0 / 8.0, 3.0 / 8.0), (1.5, -0.5, 0.0)

Two = Float[Array, "2"]
Each = Float[Arrays, "*#b"]
Lanes = Float[Arrays, "pair slice *#b"]
Depths = Float[Array, "2 cell strip"]  # of the cells, and behind them of places


class Cells(eqx.Module):
    """Even grids on the flanks of both members, and places on them.

    The mean over a cell says little of a depth that is largest at its edge, as at the ends of the path of
    contact. Where each place of a flank is passed once in an engagement, depths are held at places too:
    first under all contacts, whose gaps they open, then where pairs of teeth are at both ends of each
    stretch between events, on lines of several slices at the ends of the line in place of its outer slices.
    Curvatures and volumes are those of the cells.

    Attributes:
        flank: arc lengths at which they begin and end, of each member [m].
        across: places across the face at which they begin and end [m].
        span: mean half-widths of the contacts along the flank and across it, with flanks as new [m].
        count: along the flank; static.
        strips: across the face; static.
        places: of each strip; static, none where contacts may pass a place more than once.
        nearest: weights of the three contacts beside an end, in what is at this end.
    """

    flank: Float[Array, "2 2"]
    across: Two
    span: Two
    count: int = eqx.field(static=True)
    strips: int = eqx.field(static=True)
    places: int = eqx.field(static=True, default=0)
    nearest: Float[Array, "3"] | None = None

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape of depths: those of the cells, and behind them those of the places."""
        return 2, self.count + self.places, self.strips

    @property
    def deepest(self) -> slice:
        """Depths among which the largest is: places, where there are any.

        Strips of cells lie fixed while slices of contact lines move over them, which heaps in some of them
        what is worn beside them.
        """
        return slice(self.count if self.places else 0, None)

    @property
    def coarser(self) -> Self:
        """The same with places by straight lines, for an estimate of their error."""
        return self if self.nearest is None else replace(self, nearest=array(_STRAIGHT))

    def merged(self, depth: Float[np.ndarray, "2 cell strip"]) -> Float[np.ndarray, "2 cell strip"]:
        """Depths with each two neighbouring cells as deep as both on average."""
        halves = self.count - self.count % 2
        mean = (depth[:, :halves:2] + depth[:, 1:halves:2]) / 2.0
        return np.concatenate([np.repeat(mean, 2, axis=1), depth[:, halves:]], axis=1)

    @property
    def lengths(self) -> Two:
        """Length of a cell along the flank, of each member [m]."""
        return (self.flank[:, 1] - self.flank[:, 0]) / self.count

    @property
    def width(self) -> Float[Array, ""]:
        """Width of a strip [m]."""
        return (self.across[1] - self.across[0]) / self.strips

    @property
    def middles(self) -> tuple[Float[Array, "2 cell"], Float[Array, " strip"]]:
        """Arc lengths of each member and places across the face in the middle of the cells [m]."""
        part = (jnp.arange(self.count) + 0.5) / self.count
        aside = (jnp.arange(self.strips) + 0.5) / self.strips
        start, end = self.flank[:, :1], self.flank[:, 1:]
        return start + (end - start) * part, self.across[0] + (
            self.across[1] - self.across[0]
        ) * aside

    def volumes(self, depth: Depths) -> Two:
        """Volume that is gone from a flank of each member [m3]."""
        return jnp.sum(depth[:, : self.count], axis=(1, 2)) * self.lengths * self.width

    def surfaces(self, depth: Depths) -> tuple[Worn, Worn]:
        """Both members' flanks with so much gone."""
        worn_flank, worn_mate = (
            Worn(depth[k, : self.count], self.flank[k], self.across, self.span) for k in range(2)
        )
        return worn_flank, worn_mate

    def worn(self, mesh: Mesh, depth: Depths) -> Mesh:
        """The same mesh with flanks, beside the surfaces that they have, of which so much is gone."""
        on_flank, on_mate = zip(mesh.surfaces, self.surfaces(depth), strict=True)
        family_mesh: Any = mesh  # surfaces are a field of every family, a property of `Mesh`
        changed: Mesh = replace(
            family_mesh,
            surfaces=((*on_flank[0], on_flank[1]), (*on_mate[0], on_mate[1])),
        )
        return changed


class WearModel(eqx.Module):
    """How material goes where flanks rub.

    Attributes:
        law: specific wear rate [m3/(N m)] by arguments that are conditions, see `UNITS`, the member's own, or
            `asperity_share` and `film_defect`; static.
        own: arguments of the law that belong to a member, for each of them.
        asperities: law of the load on asperities, for laws that ask for its share; static.
        defect: parameters of the fractional film defect, for laws that ask for it.
        bodies: what conducts the heat of friction behind both flanks; None where contacts stay as warm as the
            oil.
        films: how films are solved whose asperities carry the share, in place of the law; static.
        share: part of the load on asperities at each contact, once its film is solved; not a number where it
            was not.
        mates: by which the flanks of each member are worn alike, of which the mesh has one; one unless given.
    """

    law: Callable[..., Array] = eqx.field(static=True)
    own: tuple[Mapping[str, Float[Array, ""]], Mapping[str, Float[Array, ""]]]
    asperities: AsperityLoad | None = eqx.field(static=True, default=None)
    defect: Mapping[str, Float[Array, ""]] | None = None
    bodies: tuple[Conductor, Conductor] | None = None
    films: FilmModel | None = eqx.field(static=True, default=None)
    share: Lanes | None = None
    mates: Two = eqx.field(default_factory=lambda: array([1.0, 1.0]))

    def solved(self, at: Conditions, oil: Lubricant, temperature: Each) -> "WearModel":
        """The same with the load on asperities that films at these contacts have, if they are asked for.

        Args:
            at: conditions at the contacts.
            oil: between the flanks.
            temperature: of the oil [K].
        """
        if self.films is None:
            return self
        share = asperity_share(self.films, at, oil, temperature)
        return replace(self, films=None, share=array(share))

    def rates(self, at: Conditions, temperature: Each, friction: Lanes) -> tuple[Lanes, Lanes]:
        """Specific wear rate of each member at every contact [m3/(N m)].

        Args:
            at: conditions at the contacts.
            temperature: of the oil [K].
            friction: coefficient of each contact.
        """
        wanted = inspect.signature(self.law).parameters
        if "hardness" in wanted:
            softer = jnp.minimum(*(constants["hardness"] for constants in self.own))
            at = replace(at, hardness=jnp.asarray(softer))
        arguments = {name: getattr(at, name) for name in wanted if name in UNITS}
        if "asperity_share" in wanted and self.share is not None:
            arguments["asperity_share"] = self.share
        elif "asperity_share" in wanted and self.asperities is not None:
            arguments["asperity_share"] = evaluate(self.asperities, at)
        if "film_defect" in wanted and self.defect is not None:
            warm = temperature + self._flash(at, friction)
            of_defect = {"sliding": product_array(at.sliding), "temperature": warm}
            arguments["film_defect"] = fractional_film_defect(**of_defect, **self.defect)
        flank_rate, mate_rate = (
            jnp.broadcast_to(self.law(**{**arguments, **constants}), at.load.shape)
            for constants in self.own
        )
        return flank_rate, mate_rate

    def _flash(self, at: Conditions, friction: Lanes) -> Lanes:
        """Largest rise of the temperature of both flanks in the contact [K]; see `shared_flash`."""
        if self.bodies is None:
            return jnp.zeros_like(at.load)
        if at.shape == "line":
            half, area = at.half_width, 2.0 * at.half_width * at.contacts.weight
        else:
            half, area = at.semi_axis_along, jnp.pi * at.semi_axis_along * at.semi_axis_across
        power = friction * at.load * product_array(at.sliding)
        speeds = product_array(at.speed_a), product_array(at.speed_b)
        rubs = (at.load > 0.0) & (jnp.abs(speeds[0]) + jnp.abs(speeds[1]) > 0.0)
        rise = shared_flash(
            heat=jnp.where(rubs, power, 0.0) / jnp.where(rubs, area, 1.0),
            half_width=jnp.where(rubs, half, 1.0),
            speed_a=jnp.where(rubs, speeds[0], 1.0),
            speed_b=jnp.where(rubs, speeds[1], 1.0),
            bodies=self.bodies,
        )
        return jnp.where(rubs, rise, 0.0)


class DriverTurn(eqx.Module):
    """What one turn of the driver does to a flank of each member.

    Attributes:
        depth: worn off every cell and place [m].
        volume: worn off a flank of each member, from force and sliding alone [m3].
        pressure: largest one [Pa].
        conforming: True where a loaded contact is flatter than it is taken for.
        outgrown: True where an ellipse reaches beyond the cells across the face, or a line contact is too
            wide for half spaces, see `averaged`.
        lost: True where the equilibrium of the contacts was not found, or a film.

    Source: Archard (1953); Andersson (1975), single-point observation: each point of a flank slides against
    the mate as long as the contact takes to pass it.
    """

    depth: Depths
    volume: Two
    pressure: Float[Array, ""]
    conforming: Bool[Array, ""]
    outgrown: Bool[Array, ""]
    lost: Bool[Array, ""]


def midpoints(
    events: Float[Array, " event"], count: int
) -> tuple[Float[Array, " node"], Float[Array, " node"]]:
    """Phases in the middle of equal parts of each stretch between events, and the length of these parts.

    Args:
        events: of a mesh.
        count: parts of each stretch.
    """
    ends = edges(events)
    start, length = ends[:-1, None], jnp.diff(ends)[:, None]
    part = (np.arange(count) + 0.5) / count
    return (start + length * part).ravel(), jnp.repeat(length[:, 0] / count, count)


class Start(eqx.Module):
    """What stays as it was with flanks as new.

    Attributes:
        phase: at which contacts are looked at [periods].
        weight: part of the period that each stands for.
        contacts: of flanks as new.
        spots: where they lie on both members.
        body: compliance of what is under the teeth; None where it does not couple them.
        teeth: where the contacts lie on them; None where the sharing of the load does not ask how they yield.
        parts: phases in each stretch between events; static.
        places: arc lengths of the places on both flanks, see `Cells`, not a number where nothing touches [m];
            None where there are none.
        gap: of flanks as new at these places, likewise [m].
        felt: worn flanks at these spots, for many states of them; None where each is looked at anew.
    """

    phase: Float[Array, " node"]
    weight: Float[Array, " node"]
    contacts: Contacts
    spots: tuple[Spot, Spot]
    body: Coupling | None
    teeth: TeethAt | None
    parts: int = eqx.field(static=True)
    places: Depths | None = None
    gap: Float[Array, "place strip"] | None = None
    felt: tuple[WornAt, WornAt] | None = None

    @classmethod
    def of(cls, design: Design, models: Models, parts: int) -> Self:
        """That of a design.

        Args:
            design: with flanks as new.
            models: sharing of the load.
            parts: phases in each stretch between events.
        """
        mesh, body, teeth = design.mesh, None, None
        phase, weight = midpoints(mesh.events(), parts)
        contacts = mesh.contacts(phase)
        if models.sharing.by_stiffness:
            tooth_inputs = tooth_sections(mesh), design.solids, models.compliance
            teeth = teeth_at(contacts, *tooth_inputs)
            body = mesh.body.compliance(contacts, design.solids) if mesh.body.couples else None
        spots, places, gap = mesh.spots(contacts, phase), None, None
        if has(mesh, line_of_action) and contacts.shape == "line":  # an ellipse covers many strips
            lengths = jnp.stack(
                [
                    jnp.broadcast_to(length, contacts.active.shape)
                    for length in (*contacts.flank, contacts.gap)
                ]
            )
            touching = jnp.where(contacts.active, lengths, jnp.nan)
            held = _at_places(touching, jnp.array(_PARABOLA), parts)
            places, gap = held[:2], held[2]
        return cls(phase, weight, contacts, spots, body, teeth, parts, places, gap)

    def on(self, cells: Cells) -> Self:
        """The same for many states of flanks, where the wear is the same across the face.

        Args:
            cells: on both flanks.
        """
        if cells.strips > 1 or cells.count < 4:
            return self
        flank, mate = cells.surfaces(jnp.zeros((2, cells.count, 1)))
        felt = WornAt.of(flank, self.spots[0]), WornAt.of(mate, self.spots[1])
        return replace(self, felt=felt)

    def worn(self, cells: Cells, depth: Depths) -> Surfaces:
        """What wear has added to both members.

        Args:
            cells: on both flanks.
            depth: worn off so far [m].
        """
        if self.felt is None:
            flank, mate = cells.surfaces(depth)
            return (flank,), (mate,)
        on_flank, on_mate = (
            felt.at(depth[k, : cells.count, 0]) for k, felt in enumerate(self.felt)
        )
        return (on_flank,), (on_mate,)

    def engaged(self, share: Lanes, contacts: Contacts | None = None) -> Engagement:
        """Contacts over the period, as new or as they are worn, and what they carry.

        Args:
            share: of the load on each slice.
            contacts: as they are worn.
        """
        felt = self.contacts if contacts is None else contacts
        return Engagement(self.phase, self.weight, felt, share, None, self.parts)


def unworn_start(
    design: Design, operation: Operation, models: Models, *, parts: int, count: int
) -> tuple[Start, Cells]:
    """What stays of a design with flanks as new, and cells on its flanks.

    Args:
        design: with flanks as new.
        operation: one operating point.
        models: sharing of the load.
        parts: phases in each stretch between events.
        count: of cells along each flank.

    Raises:
        InputError: a contact stands still on a flank.
    """
    start = _begun(design, models.without_friction, parts)
    share = shares_at(design, start.contacts, operation.load, models, start.body)
    at, ways = travelled(design, operation, models.without_friction, start.engaged(share))
    cells = cells_on(at, ways, count)
    if start.places is None:
        return start, cells
    return start, replace(cells, places=start.places.shape[1], nearest=array(_PARABOLA))


@program
def _begun(design: Design, models: Models, parts: int) -> Start:
    return Start.of(design, models, parts)


@program
def travelled(
    design: Design, operation: Operation, models: Models, known: Engagement
) -> tuple[Conditions, Float[Array, "2 pair slice node"]]:
    """Conditions at the contacts without friction, and the ways over both flanks for which each stands [m].

    Args:
        design: mesh and materials.
        operation: one operating point.
        models: any.
        known: contacts of a period and what they carry.

    From the speeds of both surfaces over the contact, and the time that it takes.
    """
    smooth = models.holding(jnp.zeros((1, 1, 1)))
    at = state(design, operation, known.phase, smooth, engaged=known).conditions
    lasts = known.weight * design.period / at.speed
    speeds = [jnp.broadcast_to(product_array(v), at.load.shape) for v in (at.speed_a, at.speed_b)]
    return at, jnp.abs(jnp.stack(speeds)) * lasts


def cells_on(at: Conditions, ways: Float[Array, "2 pair slice node"], count: int) -> Cells:
    """Cells over all that touches of both flanks.

    Args:
        at: conditions at the contacts of a whole period under load.
        ways: ways over both flanks for which each contact stands [m].
        count: of cells along each flank.

    Raises:
        InputError: a contact stands still on a flank.
    """
    flank, across, span = jax.device_get(reached_ends(at, ways))
    if not np.all(np.diff(flank) > 0.0):
        raise InputError(
            "one flank stands still under its contact and has no depth per turn; it is for flanks that roll"
        )
    strips = STRIPS_OF_ELLIPSE
    if at.shape == "line":
        lanes = at.contacts.active.shape
        width = np.broadcast_to(at.contacts.width, lanes)[np.asarray(at.contacts.active)]
        strips = lanes[1] if np.ptp(width) else 1
    return Cells(array(flank), array(across), array(span), count, strips)


@program
def reached_ends(
    at: Conditions, ways: Float[Array, "2 pair slice node"]
) -> tuple[Float[Array, "2 2"], Two, Two]:
    """Ends of both flanks and of the face that contacts reach, and the span of contacts [m].

    Args:
        at: conditions at the contacts of a whole period under load.
        ways: ways over both flanks for which each contact stands [m].
    """
    contacts, active = at.contacts, at.contacts.active
    line = at.shape == "line"
    reach = 0.5 * slice_extents(contacts) if line else ROOM * jnp.max(at.semi_axis_across)

    def ends(places: Lanes, half: Each) -> Two:
        low = jnp.min(jnp.where(active, places - half, jnp.inf))
        return jnp.stack([low, jnp.max(jnp.where(active, places + half, -jnp.inf))])

    flanks = [
        ends(places_on_flank, 0.5 * path)
        for places_on_flank, path in zip(contacts.flank, ways, strict=True)
    ]
    across = ends(contacts.width, reach)
    carried = jnp.where(active, at.load, 0.0)

    def mean(half: Each) -> Array:
        return jnp.sum(carried * jnp.where(carried > 0.0, half, 0.0)) / jnp.sum(carried)

    # What lies across a line does not bend it.
    half = at.half_width if line else at.semi_axis_along
    aside = across[1] - across[0] if line else mean(at.semi_axis_across)
    return jnp.stack(flanks), across, jnp.stack([mean(half), aside])


def slice_extents(contacts: Contacts) -> Lanes:
    """How far each slice of a contact line reaches across the face [m].

    Args:
        contacts: along lines.

    From the direction of the line, at right angles to normal and tangent.
    """
    normal, tangent = contacts.direction, contacts.tangent
    axial: Lanes = jnp.abs(normal[0] * tangent[1] - normal[1] * tangent[0])
    return contacts.weight * axial


def wear_of_turn(
    design: Design,
    operation: Operation,
    models: Models,
    wear: WearModel,
    cells: Cells,
    start: Start,
    depth: Depths,
) -> DriverTurn:
    """What one turn of the driver wears off flanks that have lost so much already.

    Args:
        design: with flanks as new.
        operation: one operating point.
        models: sharing of the load, and friction where it warms the contacts.
        wear: how material goes.
        cells: on both flanks.
        start: of the design.
        depth: worn off so far [m].

    Source: Archard (1953): depth is the specific rate times pressure times way.
    """
    if not design.mesh.body.couples and wear.films is None:
        return _turn_alone(design, operation, models, wear, cells, start, depth)
    contacts, flat = worn_contacts(cells, start, depth)
    worn = replace(design, mesh=cells.worn(design.mesh, depth))
    share = shares_at(worn, contacts, operation.load, models, start.body)
    engagement = start.engaged(share, contacts if contacts.shape == "ellipse" else None)
    engagement = engagement.loaded() if design.mesh.body.couples else engagement
    engagement, wide = felt_over_width(design, operation, models, cells, engagement, depth)
    if wear.films is not None:
        at, _ = travelled(design, operation, models, engagement)
        wear = wear.solved(at, design.lubricant, operation.temperature)
    turn = wear_of(design, operation, models, wear, cells, engagement)
    conforming = np.any(np.asarray(flat) & (np.asarray(share) > 0.0))
    outgrown = turn.outgrown | np.any(np.asarray(wide))
    return replace(turn, conforming=array(conforming), outgrown=array(outgrown))


def turn_alone(
    design: Design,
    operation: Operation,
    models: Models,
    wear: WearModel,
    cells: Cells,
    start: Start,
    depth: Depths,
) -> DriverTurn:
    """`wear_of_turn`, all traced together: for meshes with few contacts, and for many drives.

    Arguments as there.
    """
    contacts, flat = worn_contacts(cells, start, depth)
    worn = replace(design, mesh=cells.worn(design.mesh, depth))
    share = models.share(worn, contacts, operation.load, start.body, start.teeth)
    engagement = start.engaged(share, contacts if contacts.shape == "ellipse" else None)
    engagement, wide = felt_over_width(design, operation, models, cells, engagement, depth)
    turn = wear_of(design, operation, models, wear, cells, engagement)
    outgrown = turn.outgrown | jnp.any(wide)
    return replace(turn, conforming=jnp.any(flat & (share > 0.0)), outgrown=outgrown)


_turn_alone = program(turn_alone)


@program
def worn_contacts(
    cells: Cells, start: Start, depth: Depths
) -> tuple[Contacts, Bool[Array, "pair slice node"]]:
    """Contacts of worn flanks, and where they would have become flatter than they are taken for.

    Args:
        cells: on both flanks.
        start: with flanks as new.
        depth: worn off so far [m].
    """
    contacts, flat = with_worn(start.contacts, start.worn(cells, depth), start.spots)
    if cells.places:
        gone = _under(contacts, depth[:, cells.count :])
        contacts = replace(contacts, gap=start.contacts.gap + gone)
    return contacts, flat


@program
def felt_over_width(
    design: Design,
    operation: Operation,
    models: Models,
    cells: Cells,
    known: Engagement,
    depth: Depths,
) -> tuple[Engagement, Bool[Array, "pair slice node"]]:
    """Loaded line contacts with the curvature of worn flanks over their width, and where they conform.

    Args:
        design: with flanks as new.
        operation: one operating point.
        models: any.
        cells: on both flanks.
        known: contacts of a period, lines of flanks as new, and what they carry.
        depth: worn off so far [m].

    Ellipses stay as they are.
    """
    contacts, lanes = known.contacts, known.share.shape
    if contacts.shape == "ellipse":
        return known, jnp.zeros(lanes, bool)
    at, _ = travelled(design, operation, models, known)
    felt, wide = averaged(contacts, cells.surfaces(depth), at.line_load, at.modulus)
    return replace(known, contacts=felt), wide


@program
def wear_of(
    design: Design,
    operation: Operation,
    models: Models,
    wear: WearModel,
    cells: Cells,
    known: Engagement,
) -> DriverTurn:
    """What contacts that are known wear off in one turn of the driver.

    Args:
        design: mesh and materials.
        operation: one operating point.
        models: friction, where it warms the contacts.
        wear: how material goes.
        cells: on both flanks.
        known: contacts of a period and what they carry.

    Source: Archard (1953): depth is the specific rate times pressure times way.
    """
    period = design.period
    at, ways = travelled(design, operation, models, known)
    contacts = at.contacts
    carries = contacts.active & (at.load > 0.0)
    friction = jnp.zeros_like(at.load) if wear.bodies is None else models.coefficient(at)
    rates = wear.rates(at, operation.temperature, friction)
    # Per turn of the driver, and of each flank: engagements of a period go round among all flanks.
    periods = 2.0 * jnp.pi / period
    lasts = known.weight * period / at.speed
    slid = jnp.where(carries, at.load * product_array(at.sliding), 0.0) * lasts
    turns = wear.mates * periods / flanks_in_turn(design.mesh)
    gone = jnp.stack([turns[k] * rate * slid for k, rate in enumerate(rates)])
    along = jnp.stack([_spread(at, path, known.weight) for path in ways])
    depths = _laid(cells, at, along, gone)
    if cells.nearest is not None:
        # In a period, all that wears a flank at a contact is its force times sliding over the way there.
        rubbed = jnp.stack([turns[k] * rate for k, rate in enumerate(rates)]) * jnp.where(
            carries, at.line_load, 0.0
        )
        slid_over = product_array(at.sliding) * period / at.speed
        passed, held = ways / known.weight, along - ways
        values = jnp.stack([rubbed, slid_over + jnp.zeros_like(rubbed), passed, held])
        places = _of_places(_at_places(values, cells.nearest, known.nodes))
        depths = jnp.concatenate([depths, places], axis=1)
    return DriverTurn(
        depth=depths,
        volume=jnp.sum(gone, axis=(1, 2, 3)),
        pressure=jnp.max(jnp.where(carries, at.pressure, 0.0)),
        conforming=jnp.zeros((), bool),
        outgrown=jnp.any(carries & _beyond(cells, at)),
        lost=~(jnp.all(jnp.isfinite(at.load)) & jnp.all(jnp.isfinite(depths))),
    )


def _beyond(cells: Cells, at: Conditions) -> Bool[Array, "pair slice *b"]:
    """True for ellipses that reach beyond the cells across the face."""
    if at.shape == "line":
        return jnp.zeros(at.load.shape, bool)
    low, high = cells.across
    width, half = at.contacts.width, at.semi_axis_across
    return jnp.broadcast_to((width - half < low) | (width + half > high), at.load.shape)


def _spread(at: Conditions, way: Lanes, weight: Float[Array, " node"]) -> Lanes:
    """Length of flank over which a contact wears while it stands for others [m].

    A place that a contact passes slides under all of it, whatever its width. One under which a contact stays
    shares its wear with all that the contact covers.

    Args:
        at: conditions at the contacts.
        way: over the flank for which each contact stands [m].
        weight: part of the period for which each contact stands.
    """
    half = at.half_width if at.shape == "line" else at.semi_axis_along
    covers = 2.0 * jnp.where(at.load > 0.0, half, 0.0)
    moves = way / weight  # in one period at this speed
    still = covers**2 + moves**2
    stays = covers**2 / jnp.where(still > 0.0, still, 1.0)
    return way + covers * stays


def _laid(
    cells: Cells,
    at: Conditions,
    ways: Float[Array, "2 pair slice node"],
    gone: Float[Array, "2 pair slice node"],
) -> Depths:
    """Depth of each cell from volumes that contacts leave on their ways over both flanks [m].

    Each is spread evenly along the way, and across as far as the contact reaches. What lies before the edges
    of the cells is added up over all contacts, and differences of that are what lies in them.
    """
    contacts = at.contacts
    flank = jnp.broadcast_to(contacts.flank, gone.shape)
    reaches = _reaches(cells, at, jnp.any(gone > 0.0, axis=0))
    if at.shape == "line":
        extent = slice_extents(contacts)
        # A line that leans sweeps a strip of the face faster than it moves at right angles to itself.
        ways = ways * contacts.weight / extent
        if cells.strips > 1:
            ways = ways + jnp.abs(jnp.asarray(jnp.gradient(flank, axis=2)))
    inner = jnp.arange(1, cells.count) / cells.count

    def of(member: tuple[Array, ...]) -> Float[Array, "cell strip"]:
        ends, length, place, path, volume = member
        per_path = 1.0 / jnp.maximum(path, _SHORT * length)
        edge = ends[0] + (ends[1] - ends[0]) * inner
        along = jnp.clip(edge * per_path[..., None] + (0.5 - place * per_path)[..., None], 0.0, 1.0)
        before = jnp.einsum("...,...c,...s->sc", volume, along, reaches)
        total = jnp.einsum("...,...s->s", volume, reaches)[:, None]
        passed = jnp.concatenate([jnp.zeros_like(total), before, total], axis=1)
        volumes = jnp.diff(passed, axis=1).T
        return jnp.where(volumes < 0.0, 0.0, volumes) / (length * cells.width)

    # By a loop over the members: fused with what made them, ways would be computed again for every cell.
    depths: Depths = jax.lax.map(of, (cells.flank, cells.lengths, flank, ways, gone))
    return depths


def _at_places(
    values: Float[Array, "*b pair slice node"], nearest: Float[Array, "3"], parts: int
) -> Float[Array, "*b place slice"]:
    """Values of contacts, and behind them those at the ends of stretches, each slice a strip; see `Cells`."""
    apart = values.reshape(*values.shape[:-1], -1, parts)
    ends = jnp.stack([apart[..., :3] @ nearest, apart[..., :-4:-1] @ nearest], axis=-1)
    if ends.shape[-3] >= _SLICED:
        at_start, at_end = (
            jnp.einsum("k,...kse->...se", nearest, side)
            for side in (ends[..., :3, :, :], ends[..., :-4:-1, :, :])
        )
        ends = ends.at[..., 0, :, :].set(at_start).at[..., -1, :, :].set(at_end)
    rows = [jnp.moveaxis(lanes, -2, -1) for lanes in (values, ends.reshape(*ends.shape[:-2], -1))]
    return jnp.concatenate(
        [lanes.reshape(*lanes.shape[:-3], -1, lanes.shape[-1]) for lanes in rows], axis=-2
    )


def _of_places(values: Float[Array, "4 2 place strip"]) -> Depths:
    """Depth per turn from line load times rate, sliding, and the way past a place or over what is covered."""
    rubbed, slid, passed, held = jnp.maximum(values, 0.0)
    path = passed + held
    return jnp.asarray(rubbed * slid / jnp.where(path > 0.0, path, 1.0))


def _under(contacts: Contacts, places: Float[Array, "2 place strip"]) -> Lanes:
    """What is gone from both flanks under each contact [m]."""
    pairs, slices, nodes = contacts.active.shape
    gone = jnp.sum(places[:, : pairs * nodes], axis=0).reshape(pairs, nodes, slices)
    return jnp.asarray(jnp.moveaxis(gone, 1, 2))


def _reaches(
    cells: Cells, at: Conditions, wears: Bool[Array, "pair slice node"]
) -> Float[Array, "pair slice node strip"]:
    """Part of what each contact leaves that lies on each strip across the face."""
    contacts, lanes = at.contacts, wears.shape
    start, end = cells.across
    edges_across = start + (end - start) * jnp.arange(1, cells.strips) / cells.strips
    width = jnp.broadcast_to(contacts.width, lanes)[..., None]
    if at.shape == "line":
        across = jnp.clip(
            (edges_across - width) / slice_extents(contacts)[..., None] + 0.5, 0.0, 1.0
        )
    else:
        semi = jnp.broadcast_to(at.semi_axis_across, lanes)
        semi = jnp.where(wears, semi, 1.0)[..., None]
        place = jnp.clip((edges_across - width) / semi, -1.0, 1.0)
        across = 0.5 + 0.25 * (3.0 * place - place**3)
    return _parts(jnp.broadcast_to(across, (*lanes, cells.strips - 1)))


def _parts(passed: Float[Array, "*b edge"]) -> Float[Array, "*b cell"]:
    """Parts of a whole in each cell, from what lies before each inner edge; the end cells take the rest."""
    ends = (*passed.shape[:-1], 1)
    return jnp.diff(jnp.concatenate([jnp.zeros(ends), passed, jnp.ones(ends)], axis=-1), axis=-1)
