"""The march of wear for many drives in one call: each goes its own steps, all in one program."""

import dataclasses

import diffrax
import equinox as eqx
import optimistix
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import fast_program
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.errors import InputError
from pitchpoint.wear.history import Cells, DriverTurn, Start, reached_ends, travelled, turn_alone
from pitchpoint.wear.march import FIRST
from pitchpoint.wear.wear_gradients import Inputs

__all__ = ["AT_ONCE", "Marches", "worn_together"]

AT_ONCE = 16
"""Drives in one step of the loop over many: what they need stays in the cache."""

MOST_STEPS = 4096
"""Steps after which a march is given up."""

_DEEPEST = 1.0  # m: finite, for the search of the place where a depth is reached


class Marches(eqx.Module):
    """Flanks of many drives at the end of their marches.

    Attributes:
        turns: of the driver; fewer than asked for where a depth is reached before.
        depth: worn off every cell and place, see `Cells` [m].
        cells: of each drive.
        pressure: largest one there, and with flanks as new [Pa].
        steps: of each march.
        found: False where a march was given up: its values are those that it came to.
    """

    turns: Float[Array, "*drive"]
    depth: Float[Array, "*drive 2 cell strip"]
    cells: Cells
    pressure: Float[Array, "*drive 2"]
    steps: Int[Array, "*drive"]
    found: Bool[Array, "*drive"]


def worn_together(
    inputs: Inputs,
    models: Models,
    cells: Cells,
    parts: int,
    turns: Float[Array, " drive"],
    depth: Float[Array, " drive"],
    tolerance: Float[Array, ""],
) -> Marches:
    """Flanks of many drives after so many turns, or at a depth if that comes first.

    The march is that of `march.wear_step`: the same method, the same measure of its error.

    Args:
        inputs: designs, operating points and how material goes, each array with an axis of drives in front.
        models: sharing of the load, and friction where it warms the contacts; common to all.
        cells: of one of the drives: as many lie on the flanks of all.
        parts: phases in each stretch between events.
        turns: of the driver.
        depth: on either member [m].
        tolerance: error of a step, over the largest depth.

    Raises:
        InputError: films are asked for the load on asperities.

    Source: Bogacki and Shampine (1989), by diffrax.
    """
    if inputs[2].films is not None:
        raise InputError(
            "many drives wear together by a formula of the load on asperities, not by films"
        )
    return _together(inputs, models, cells, parts, turns, depth, tolerance)


@fast_program
def _together(
    inputs: Inputs,
    models: Models,
    cells: Cells,
    parts: int,
    turns: Array,
    depth: Array,
    tolerance: Array,
) -> Marches:
    def one(given: tuple[Inputs, Array, Array]) -> Marches:
        return _worn(*given, models, cells, parts, tolerance)

    found: Marches = jax.lax.map(one, (inputs, turns, depth), batch_size=AT_ONCE)
    return found


def _worn(
    inputs: Inputs,
    turns: Array,
    limit: Array,
    models: Models,
    cells: Cells,
    parts: int,
    tolerance: Array,
) -> Marches:
    """Flanks of one drive."""
    design, operation, wear = inputs
    start = Start.of(design, models, parts)
    share = models.share(design, start.contacts, operation.load, start.body, start.teeth)
    flank, across, span = reached_ends(*travelled(design, operation, models, start.engaged(share)))
    own = dataclasses.replace(cells, flank=flank, across=across, span=span)
    start = start.on(own)

    def turn(depth: Array) -> DriverTurn:
        return turn_alone(design, operation, models, wear, own, start, depth)

    none = jnp.zeros(cells.shape)
    new = turn(none)
    first = jnp.max(new.depth)

    def reaches(t: Array, y: Array, args: None, **_: object) -> Array:
        return jnp.max(y[:, cells.deepest]) - jnp.minimum(limit, _DEEPEST)

    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda _, depth, __: turn(depth).depth),
        diffrax.Bosh3(),
        jnp.zeros(()),
        turns,
        jnp.minimum(FIRST / jnp.where(first > 0.0, first, 1.0), turns),
        none,
        stepsize_controller=_OfDeepest(rtol=tolerance, atol=tolerance, norm=_root_mean_square),
        event=diffrax.Event(reaches, optimistix.Newton(rtol=1e-10, atol=1e-15)),
        saveat=diffrax.SaveAt(t1=True),
        max_steps=MOST_STEPS,
        throw=False,
        adjoint=diffrax.ForwardMode(),
    )
    ended = diffrax.is_successful(found.result) | diffrax.is_event(found.result)
    depth = found.ys[0]
    last = turn(depth)
    return Marches(
        turns=found.ts[0],
        depth=depth,
        cells=own,
        pressure=jnp.stack([last.pressure, new.pressure]),
        steps=found.stats["num_accepted_steps"],
        found=ended & ~last.lost,
    )


class _OfDeepest(diffrax.PIDController):
    """Steps whose error is judged beside the depth of each cell and the largest one."""

    def adapt_step_size(self, t0, t1, y0, y1_candidate, *args):  # type: ignore[no-untyped-def]
        """As its parent, with an absolute tolerance that grows with the depth."""
        deepest = jnp.maximum(jnp.max(y0), FIRST)
        own = diffrax.PIDController(rtol=self.rtol, atol=self.atol * deepest, norm=self.norm)
        return own.adapt_step_size(t0, t1, y0, y1_candidate, *args)


def _root_mean_square(values: Array) -> Array:
    return jnp.sqrt(jnp.mean(values**2))
