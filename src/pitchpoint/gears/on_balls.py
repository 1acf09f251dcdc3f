"""A body under teeth that lies on balls, which only push."""

import equinox as eqx
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays

__all__ = [
    "Body",
    "OnBalls",
    "ball_force",
    "ball_stiffness",
    "over_batch",
    "seated",
    "separation_on_balls",
]

SEATING_STEPS = 60
"""Newton steps of the balls that seat a body without load; usual are ten."""

SEATED = 1e-9
"""Change of an approach in the last step, over the largest one, up to which balls count as seated."""


class OnBalls(eqx.Module):
    """Compliance of a free body, and the balls that hold it.

    Displacements of lanes are along their normals, those of balls away from them; unit forces act along
    both. All are counted from the state without load on the teeth, in which the balls may press already.

    Attributes:
        lanes: displacement of lanes for forces on lanes [m/N].
        across: of lanes for forces of balls [m/N].
        balls: of balls for forces of balls [m/N].
        stiffness: force of a ball over its approach to the power 1.5 [N/m1.5].
        approach: of the balls without load; negative where one has play [m].
        shift: how much further apart the balls hold the flanks without load than gaps are counted [m].
        start: approach from which that under load is looked for, as one that is known for another load [m].
    """

    lanes: Float[Array, "lane lane *#b"]
    across: Float[Array, "lane ball *#b"]
    balls: Float[Array, "ball ball"]
    stiffness: Float[Array, ""]
    approach: Float[Array, " ball"]
    shift: Float[Array, "lane *#b"]
    start: Float[Array, "ball *#b"]


Body = Float[Array, "lane lane *#b"] | OnBalls
"""How a body couples lanes: by a matrix of its own, or held by balls."""


def separation_on_balls(
    gap: Float[Arrays, "pair slice *#b"], body: Body | None
) -> Float[Array, "pair slice *#b"]:
    """Separation of unloaded flanks on a body as its balls hold it [m].

    Args:
        gap: of flanks on the body in its nominal shape [m].
        body: that carries them.
    """
    if not isinstance(body, OnBalls):
        return jnp.asarray(gap)
    return gap + body.shift.reshape(*gap.shape[:2], *body.shift.shape[1:])


def over_batch(balls: Float[Array, " ball"], rank: int) -> Float[Array, "ball *#b"]:
    """Values of the balls with so many axes for a batch behind them."""
    return balls.reshape(-1, *(1 for _ in range(rank)))


def ball_force(stiffness: Float[Array, ""], approach: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Force of balls that only push [N].

    Args:
        stiffness: [N/m1.5].
        approach: of both races [m].

    Source: Palmgren (1959); the power is that of Hertz for points.
    """
    pressed = jnp.maximum(approach, 0.0)
    return stiffness * pressed * _root(pressed)


def ball_stiffness(stiffness: Float[Array, ""], approach: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Slope of `ball_force` over the approach [N/m]; arguments as there.

    From the derivative of Palmgren's law of `ball_force`.
    """
    return 1.5 * stiffness * _root(jnp.maximum(approach, 0.0))


def _root(pressed: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Square root without an infinite slope at zero."""
    touches = pressed > 0.0
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    return jnp.where(touches, jnp.sqrt(jnp.where(touches, pressed, 1.0)), 0.0)


def seated(
    balls: Float[Array, "ball ball"], stiffness: Float[Array, ""], push: Float[Array, " ball"]
) -> Float[Array, " ball"]:
    """Approach of balls that push a free body into a shape [m].

    Args:
        balls: displacement of the body at each ball for a unit force of another [m/N].
        stiffness: of the balls [N/m1.5].
        push: by which each ball stands beyond the body without forces; negative with play [m].

    From the balance approach = push - C force by Newton's steps; the last one carries derivatives. NaN
    where the balls do not settle.
    """

    def step(approach: Float[Array, " ball"]) -> Float[Array, " ball"]:
        slope = ball_stiffness(stiffness, approach)
        root = _root(slope)
        held = ball_force(stiffness, approach) - slope * approach
        matrix = jnp.eye(push.shape[0]) + root[:, None] * balls * root
        factors = jnp.linalg.cholesky(matrix), True
        free = push - balls @ held
        pressed = jax.scipy.linalg.cho_solve(factors, root * free)
        return free - balls @ (root * pressed)

    frozen = jax.lax.stop_gradient((balls, stiffness, push))
    start = jnp.maximum(frozen[2], 0.0)

    def settle(_: Int[Array, ""], approach: Float[Array, " ball"]) -> Float[Array, " ball"]:
        return jax.lax.stop_gradient(step(approach))

    before = jax.lax.fori_loop(0, SEATING_STEPS, settle, start)
    seated_approach = step(before)
    rests = jnp.max(jnp.abs(seated_approach - before)) <= SEATED * jnp.max(jnp.abs(seated_approach))
    return jnp.where(rests, seated_approach, jnp.nan)
