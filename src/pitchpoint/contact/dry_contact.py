"""Dry contact of two elastic half spaces: pressure from a given gap, and load or approach."""

from typing import Final, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.half_space import HalfSpace
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import fast_program
from pitchpoint.core.status import Code, Status
from pitchpoint.errors import InputError

__all__ = ["DryContact", "dry_contact", "near_ends", "pressed", "pressed_by"]

Field = Float[Arrays, "y x"]

TOLERANCE: Final = 1e-10
"""Gap under pressure, or overlap beside it, over the approach, at which an iteration ends."""

ENOUGH: Final = 1e-8
"""The same of a solution from which rounding keeps the iteration."""

MOST: Final = 400
"""Iterations after which a solve is given up."""

JOINING: Final = 0.01
"""Pressure with which a cell joins the contact, over what would take away its overlap if it stood alone. With
much more, many that join at once never settle: rough surfaces on long cells."""

FEWEST: Final = 8
"""Cells across the contact below which no grid resolves it."""


class DryContact(eqx.Module):
    """Bodies pressed together; NaN where no solution was found.

    Attributes:
        pressure: on the cells, shape (y, x) [Pa].
        gap: between the deformed surfaces, zero under pressure, shape (y, x) [m].
        approach: of points of the two bodies far from the contact, from where gaps of zero touch [m].
        load: normal one [N].
        status: its residual is the largest gap under pressure, or overlap beside it, over the approach.
    """

    pressure: Float[Array, "y x"]
    gap: Float[Array, "y x"]
    approach: Float[Array, ""]
    load: Float[Array, ""]
    status: Status


class _Pressed(eqx.Module):
    """Two bodies on their grid, with what presses them.

    Attributes:
        bodies: half spaces.
        gap: without load, shape (y, x) [m].
        modulus: E' [Pa].
        load: normal one [N]; None where the approach is given.
        approach: of the bodies [m]; None where the load is given.
    """

    bodies: HalfSpace
    gap: Field
    modulus: Float[Arrays, ""]
    load: Float[Arrays, ""] | None
    approach: Float[Arrays, ""] | None

    def deflection(self, pressure: Field) -> Array:
        return self.bodies.deflection(pressure, self.modulus)

    def sum(self, field: Field) -> Array:
        """Integral over the grid."""
        return self.bodies.load(field)

    def scale(self, pressure: Field) -> Array:
        """By how much a pressure has to grow to carry the load, where that is given."""
        return jnp.ones(()) if self.load is None else self.load / self.sum(pressure)

    def level(self, raised: Field, held: Bool[Array, "y x"]) -> Array:
        """Approach for which the mean gap under the pressure is zero, or the given one."""
        if self.approach is not None:
            return jnp.asarray(self.approach)
        return self.sum(jnp.where(held, raised, 0.0)) / self.sum(held.astype(float))

    def towards(self, defect: Field, held: Bool[Array, "y x"]) -> Array:
        """Change of the pressure that takes away most of a gap under it, and carries no load of its own."""
        change = _kept(self._sharpened(_kept(defect, held)), held)
        if self.load is None:
            return change
        even = _kept(self._sharpened(held.astype(float)), held)
        return change - even * (self.sum(change) / self.sum(even))

    def _sharpened(self, defect: Array) -> Array:
        """Pressure that would deflect by as much if every row stood alone and had no end."""
        row_spectrum = self.bodies.own
        period = 2 * (row_spectrum.shape[1] - 1)
        waves = jnp.fft.rfft(defect, n=period, axis=1) / row_spectrum
        return jnp.fft.irfft(waves, n=period, axis=1)[:, : defect.shape[1]] * self.modulus

    @property
    def soft(self) -> Array:
        """Deflection of a cell by a pressure of one on itself [m/Pa]."""
        return jnp.asarray(self.bodies.rows)[:, :1] / self.modulus


class _DryIterate(NamedTuple):
    """Where an iteration stands.

    Attributes:
        pressure, deflection: shape (y, x).
        level: approach.
        defect: gap of the deformed surfaces, shape (y, x).
        direction: of the last change of the pressure, shape (y, x).
        before: defect under the pressure before that change, shape (y, x).
        power: of that defect against its change.
        fresh: whether cells joined the contact, and the direction starts anew.
        residual: largest gap under pressure, or overlap beside it, over the approach.
        steps: so far.
    """

    pressure: Float[Array, "y x"]
    deflection: Float[Array, "y x"]
    level: Float[Array, ""]
    defect: Float[Array, "y x"]
    direction: Float[Array, "y x"]
    before: Float[Array, "y x"]
    power: Float[Array, ""]
    fresh: Bool[Array, ""]
    residual: Float[Array, ""]
    steps: Int[Array, ""]


def pressed(
    bodies: HalfSpace,
    gap: Field,
    modulus: Float[Arrays, ""],
    load: Float[Arrays, ""],
    most: int = MOST,
) -> DryContact:
    """Bodies under a given load, as a part of programs: nothing is checked.

    Args:
        bodies: half spaces on their grid.
        gap: between the surfaces without load, shape (y, x) [m].
        modulus: E' [Pa].
        load: normal one [N], positive.
        most: iterations after which a solve is given up.

    Conjugate gradients on the cells under pressure, which change as they go, preconditioned by every row for
    itself. Source: Polonsky and Keer (1999).
    """
    return _solved(_Pressed(bodies, gap, modulus, load, None), most)


def pressed_by(
    bodies: HalfSpace,
    gap: Field,
    modulus: Float[Arrays, ""],
    approach: Float[Arrays, ""],
    most: int = MOST,
) -> DryContact:
    """Bodies that approach each other by a given length [m], else as `pressed`.

    Source: Polonsky and Keer (1999), as `pressed`, with the approach in place of the load.
    """
    return _solved(_Pressed(bodies, gap, modulus, None, approach), most)


def _solved(pair: _Pressed, most: int) -> DryContact:
    def unfinished(at: _DryIterate) -> Array:
        return (at.residual > TOLERANCE) & (at.steps < most)

    state = jax.lax.while_loop(unfinished, lambda at: _step(pair, at), _start(pair))
    end = _at(pair, state, state.pressure, pair.deflection(state.pressure))
    converged = end.residual < ENOUGH
    code = jnp.where(converged, Code.SOLVED, Code.NOT_CONVERGED)
    numbers = end.pressure, end.defect, end.level, pair.sum(end.pressure)
    pressure, gap, level, load = (jnp.where(converged, number, jnp.nan) for number in numbers)
    return DryContact(pressure, gap, level, load, Status(code, end.residual, end.steps))


def _start(pair: _Pressed) -> _DryIterate:
    """The load spread evenly, or every row as soft as it is alone."""
    shape, zero = pair.gap.shape, jnp.zeros(pair.gap.shape)
    if pair.approach is None:
        pressure = jnp.broadcast_to(pair.scale(jnp.ones(shape)), shape)
    else:
        alone = jnp.asarray(pair.bodies.own)[:, :1] / pair.modulus
        pressure = jnp.maximum(pair.approach - pair.gap, 0.0) / alone
    blank = jnp.zeros(()), jnp.zeros((), int)
    state = _DryIterate(
        pressure, zero, blank[0], zero, zero, zero, jnp.ones(()), jnp.array(True), *blank
    )
    return _at(pair, state, pressure, pair.deflection(pressure))


def _at(pair: _Pressed, state: _DryIterate, pressure: Array, deflection: Array) -> _DryIterate:
    """The state with another pressure."""
    held = pressure > 0.0
    raised = pair.gap + deflection
    level = pair.level(raised, held)
    defect = raised - level
    off = jnp.max(jnp.where(held, jnp.abs(defect), -defect))
    return state._replace(
        pressure=pressure,
        deflection=deflection,
        level=level,
        defect=defect,
        residual=off / (level - jnp.min(pair.gap)),
    )


def _step(pair: _Pressed, state: _DryIterate) -> _DryIterate:
    """One step along a conjugate direction, and cells that leave the contact or join it."""
    held = state.pressure > 0.0
    defect = _kept(state.defect, held)
    change = pair.towards(state.defect, held)
    power = pair.sum(defect * change)
    turn = (power - pair.sum(state.before * change)) / state.power
    direction = _kept(change + jnp.where(state.fresh, 0.0, turn) * state.direction, held)
    yields = pair.deflection(direction)
    length = pair.sum(defect * direction) / pair.sum(yields * direction)
    free = state.pressure - length * direction
    joins = ~held & (state.defect < 0.0)
    pressure = jnp.where(joins, -JOINING * state.defect / pair.soft, jnp.maximum(free, 0.0))
    fresh = jnp.any(joins)
    deflection = jax.lax.cond(
        fresh | jnp.any(free < 0.0),
        lambda: pair.deflection(pressure),
        lambda: state.deflection - length * yields,
    )
    state = state._replace(
        direction=direction, before=defect, power=power, fresh=fresh, steps=state.steps + 1
    )
    scale = pair.scale(pressure)
    return _at(pair, state, pressure * scale, deflection * scale)


def _kept(field: Array, held: Array) -> Array:
    return jnp.where(held, field, 0.0)


_by_load, _by_approach = fast_program(pressed), fast_program(pressed_by)


def dry_contact(
    bodies: HalfSpace,
    gap: NDArray[np.float64],
    modulus: float,
    *,
    load: float | None = None,
    approach: float | None = None,
    to_ends: bool = False,
) -> DryContact:
    """Pressure between two elastic bodies without a lubricant.

    Args:
        bodies: half spaces on their grid.
        gap: between the surfaces where they just touch, or from any other zero, shape (y, x) [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members.
        load: normal one [N].
        approach: of the bodies [m], in the place of the load.
        to_ends: whether the contact may reach the first and the last row, as that of a roller does which ends
            there. The pressure of the last row then is a number of the grid: half spaces have no largest
            pressure at an edge; `near_ends` gives it at distances.

    Returns:
        The bodies under load; numbers are NaN where the status says that no solution was found.

    Raises:
        InputError: a gap of another shape or that is not finite, no load, bodies that do not touch, a contact
            that the grid cuts or does not resolve.

    Source: Polonsky and Keer (1999).

    Example: a steel ball of 20 mm on a disc.

        >>> import numpy as np
        >>> from pitchpoint.contact.gaps import elliptic_gap
        >>> from pitchpoint.contact.half_space import half_space
        >>> bodies = half_space(np.linspace(-2e-4, 2e-4, 65), np.linspace(-2e-4, 2e-4, 65))
        >>> gap = elliptic_gap(bodies, 0.01, 0.01)
        >>> contact = dry_contact(bodies, gap, 226.4e9, load=30.0)
        >>> round(float(contact.pressure.max()) / 1e6), round(float(contact.approach) * 1e6, 2)
        (906, 1.58)
    """
    _check(bodies, gap, modulus, load, approach)
    arguments = array(gap), array(modulus)
    if load is not None:
        contact = _by_load(bodies, *arguments, array(load))
    else:
        contact = _by_approach(
            bodies, *arguments, array(approach if approach is not None else np.nan)
        )
    _check_grid(np.asarray(contact.pressure) > 0.0, to_ends)
    return contact


def near_ends(
    bodies: HalfSpace, pressure: NDArray[np.float64], distances: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Largest pressure across a contact line at distances from both of its ends, shape (2, distance) [Pa].

    Args:
        bodies: on their grid, whose first and last edges are the ends.
        pressure: on the cells, shape (y, x) [Pa].
        distances: from the ends [m]; NaN comes out of those nearer than the middle of the last cell.
    """
    ridge, edges = np.max(pressure, axis=1), np.asarray(bodies.edges)
    inwards = np.asarray(bodies.y) - edges[0], (edges[-1] - np.asarray(bodies.y))[::-1]
    ends = zip(inwards, (ridge, ridge[::-1]), strict=True)
    return np.stack([np.interp(distances, at, profile, left=np.nan) for at, profile in ends])


def _check(
    bodies: HalfSpace,
    gap: NDArray[np.float64],
    modulus: float,
    load: float | None,
    approach: float | None,
) -> None:
    shape = len(bodies.y), len(bodies.x)
    if gap.shape != shape:
        raise InputError(f"a gap of shape {gap.shape} on a grid of {shape} cells", key="gap")
    if not np.all(np.isfinite(gap)):
        raise InputError("a gap is not a finite number", key="gap")
    if (load is None) == (approach is None):
        raise InputError("either the load or the approach of the bodies has to be given")
    for key, what, value in (("modulus", "a modulus E'", modulus), ("load", "a load", load)):
        if value is not None and not 0.0 < value < np.inf:
            raise InputError(f"{what} of {value:.4g}: it must be positive", key=key)
    least = float(np.min(gap))
    if approach is not None and not least < approach < np.inf:
        raise InputError(
            f"bodies that are {least:.4g} m apart do not touch at an approach of {approach:.4g} m",
            key="approach",
        )


def _check_grid(held: NDArray[np.bool_], to_ends: bool) -> None:
    """InputError for a contact that its grid cuts or does not resolve."""
    if np.any(held[:, [0, -1]]) or (not to_ends and np.any(held[[0, -1]])):
        raise InputError(
            "the grid cuts the contact: there is pressure at its border; take a larger one"
        )
    if not np.any(held):
        return
    cells = [int(np.ptp(np.flatnonzero(np.any(held, axis=axis)))) + 1 for axis in (0, 1)]
    if min(cells) < FEWEST:
        raise InputError(
            f"the contact covers {cells[0]} cells along x and {cells[1]} across; "
            f"the grid needs at least {FEWEST} each way"
        )
