"""Periodic motion of teeth that part: Newton shooting, and marching where it leads nowhere."""

from collections.abc import Callable

import equinox as eqx
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.dynamics_registry import ContactLaw
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.floquet import STABLE, multipliers
from pitchpoint.dynamics.integration import Pieces, travel

__all__ = ["PERIODS", "Shot", "search", "shoot"]

CLOSED = 1e-8
"""Largest distance of the end of a period from its start, of states of order one."""

NEWTON_STEPS = 12
"""Steps before the search marches instead."""

PERIODS = 400
"""Largest number of periods that a search marches."""

_UNSTABLE = 2.0
"""Multiplier of a period whose derivative is not known, so that Newton's method has the last word."""

RETRY = 64
"""Periods after which Newton's method is tried again however far the march is from periodic."""


class Shot(eqx.Module):
    """Where a search stands.

    Attributes:
        start: state from which the next period begins.
        origin: state that motion has truly reached, to which failed steps return.
        newton: True while Newton's method is at work, otherwise the motion marches.
        tries: Newton's steps since it was taken up.
        marched: periods so far.
        near: residual at which a march hands over to Newton's method.
        states: at the nodes of the last period.
        monodromy: derivative of its end with respect to its start.
        residual: distance of its end from its start.
        found, lost: how the search ended.
    """

    start: Float[Array, " state"]
    origin: Float[Array, " state"]
    newton: Bool[Array, ""]
    tries: Int[Array, ""]
    marched: Int[Array, ""]
    near: Float[Array, ""]
    states: Float[Array, "interval state"]
    monodromy: Float[Array, "state state"]
    residual: Float[Array, ""]
    found: Bool[Array, ""]
    lost: Bool[Array, ""]

    @property
    def end(self) -> Float[Array, " state"]:
        """State after the last period."""
        return self.states[-1]

    def nodes(self, elements: int) -> Float[Array, "state element node"]:
        """States of the last period at the nodes of all elements."""
        inner = self.states.reshape(elements, -1, self.states.shape[-1])
        begin = jnp.concatenate([self.start[None], inner[:-1, -1]])[:, None]
        return jnp.moveaxis(jnp.concatenate([begin, inner], axis=1), -1, 0)


Period = Callable[
    [Float[Array, " state"]],
    tuple[Float[Array, "interval state"], Float[Array, "state state"], Bool[Array, ""]],
]


def shoot(
    equations: Equations,
    pieces: Pieces,
    law: ContactLaw,
    backlash: Float[Array, ""],
    start: Float[Array, " state"],
) -> Shot:
    """Periodic motion reached from a state, see `search`.

    Args:
        equations, pieces: of the motion.
        law: force between the teeth.
        backlash: free motion in units of stretch.
        start: displacement and velocity without dimensions.

    Source: as `search`.
    """

    def period(state: Float[Array, " state"]) -> tuple[Array, Array, Array]:
        return travel(equations, pieces, law, backlash, state)

    return search(period, start, pieces.half.shape[0])


def search(
    period: Period,
    start: Float[Array, " state"],
    intervals: int,
    marched: Callable[[Float[Array, " state"]], tuple[Array, Bool[Array, ""]]] | None = None,
) -> Shot:
    """Periodic motion reached from a state.

    Newton's method looks for a stable periodic motion near the state. If its residual stops falling,
    or what it finds is unstable, the motion marches period by period, as the machine would, until it
    is nearly periodic, and Newton's method finishes. So a branch is followed as long as it is stable.

    Args:
        period: from a state to those after each interval of a period, the derivative of the last one, and
            whether they were found.
        start: without dimensions.
        intervals: of the period whose states are kept.
        marched: the same as `period` without the derivative, for periods that march; `period` by default.

    Source: Nayfeh and Balachandran (1995), chapter 6, shooting.
    """

    def without_slope(state: Float[Array, " state"]) -> tuple[Array, Array, Bool[Array, ""]]:
        assert marched is not None
        states, fine = marched(state)
        return states, _UNSTABLE * jnp.eye(state.shape[0]), fine

    def once(shot: Shot) -> Shot:
        if marched is None:
            states, monodromy, fine = period(shot.start)
        else:
            states, monodromy, fine = jax.lax.cond(shot.newton, period, without_slope, shot.start)
        size = 1.0 + jnp.max(jnp.abs(shot.start))
        residual = jnp.max(jnp.abs(states[-1] - shot.start)) / size
        values = (states, monodromy, residual)
        travelled = eqx.tree_at(lambda s: (s.states, s.monodromy, s.residual), shot, values)
        return _decide(travelled, shot.residual, fine & jnp.all(jnp.isfinite(monodromy)))

    def unfinished(shot: Shot) -> Bool[Array, ""]:
        return ~(shot.found | shot.lost)

    return jax.lax.while_loop(unfinished, once, _begin(start, intervals))


def _begin(start: Float[Array, " state"], intervals: int) -> Shot:
    size, no = start.shape[0], jnp.asarray(False)
    return Shot(
        start=start,
        origin=start,
        newton=jnp.asarray(True),
        tries=jnp.asarray(0),
        marched=jnp.asarray(0),
        near=jnp.asarray(1e-3),
        states=jnp.zeros((intervals, size)),
        monodromy=jnp.zeros((size, size)),
        residual=jnp.asarray(jnp.inf),
        found=no,
        lost=no,
    )


def _decide(shot: Shot, before: Float[Array, ""], fine: Bool[Array, ""]) -> Shot:
    """The shot with its verdict and the start of its next period."""
    stable = jnp.max(jnp.abs(multipliers(shot.monodromy))) <= STABLE
    closed = shot.residual < CLOSED
    # Near a solution Newton's step does far better than half: less means that it is not near one.
    falls = (shot.tries == 0) | (shot.residual < before / 2.0)
    goes_on = fine & falls & ~closed & (shot.tries < NEWTON_STEPS)
    solved = fine & closed & stable
    lost = ~solved & ~shot.newton & (~fine | (shot.marched >= PERIODS))
    eye = jnp.eye(shot.start.shape[0])
    corrected = shot.start + jnp.linalg.solve(eye - shot.monodromy, shot.end - shot.start)
    takes_up = (shot.residual < shot.near) | (shot.marched % RETRY == RETRY - 1)

    # Each time it takes up Newton's method the march has to come nearer before the next try: from as far
    # it would fail again.
    newton = jnp.where(shot.newton, goes_on, takes_up)
    origin = jnp.where(shot.newton, shot.origin, shot.end)
    start = jnp.where(newton & shot.newton, corrected, origin)
    return Shot(
        start=jnp.where(solved, shot.start, start),
        origin=origin,
        newton=newton,
        tries=jnp.where(newton & shot.newton, shot.tries + 1, 0),
        marched=shot.marched + ~shot.newton,
        near=jnp.where(~shot.newton & takes_up, shot.near / 10.0, shot.near),
        states=shot.states,
        monodromy=shot.monodromy,
        residual=shot.residual,
        found=solved,
        lost=lost,
    )
