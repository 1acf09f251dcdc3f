"""Roots of scalar equations, one at each of many states at once."""

from collections.abc import Callable

from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp

__all__ = ["TOLERANCE", "root"]

TOLERANCE = 1e-12
"""Largest residual at which the iteration stops; a last step follows."""

MOST = 40
"""Largest number of steps."""

Each = Float[Array, "*b"]


def root(
    function: Callable[[Each], Each], guess: Each, *, unrolled: int = 0
) -> tuple[Each, Int[Array, ""]]:
    """Root of an equation that each state solves for itself, and the steps it took.

    The iteration itself is not differentiated: the last step, from the root that was found, carries
    the derivatives with respect to everything that the function closes over. So the compiled
    program holds no callback and is kept between processes, which an implicit adjoint of a
    library's solver does not allow. Written-out steps are 1.4 times faster than a loop, because
    what does not depend on the unknown is computed once (`benchmarks/states.py`).

    Args:
        function: residual of order one at each state, smooth, elementwise.
        guess: start values.
        unrolled: number of third-order steps to write out; 0 iterates until all states have
            converged.

    Returns:
        Roots, and the number of steps; the caller checks the residual.
    """
    start = jax.lax.stop_gradient(guess)
    if unrolled:
        found, steps = start, jnp.asarray(unrolled)
        for _ in range(unrolled - 1):
            found = _halley(function, found)
    else:
        found, steps = _iterate(function, start)
    found = jax.lax.stop_gradient(found)
    value, slope = _tangent(function, found)
    return found - value / jax.lax.stop_gradient(slope), steps


def _iterate(function: Callable[[Each], Each], start: Each) -> tuple[Each, Int[Array, ""]]:
    def unfinished(carry: tuple[Each, Each, Array]) -> Array:
        _, residual, steps = carry
        return (steps < MOST) & jnp.any(jnp.abs(residual) > TOLERANCE)

    def step(carry: tuple[Each, Each, Array]) -> tuple[Each, Each, Array]:
        at, _, steps = carry
        value, slope = _tangent(function, at)
        return at - value / slope, value, steps + 1

    begin = (start, jnp.full_like(start, jnp.inf), jnp.asarray(0))
    found, _, steps = jax.lax.while_loop(unfinished, step, begin)
    return found, steps


def _tangent(function: Callable[[Each], Each], at: Each) -> tuple[Each, Each]:
    """Value and derivative at each state."""
    value, slope = jax.jvp(function, (at,), (jnp.ones_like(at),))
    return value, slope


def _halley(function: Callable[[Each], Each], at: Each) -> Each:
    """Step of third order: Newton's with the curvature."""
    (value, slope), (_, curve) = jax.jvp(
        lambda x: _tangent(function, x), (at,), (jnp.ones_like(at),)
    )
    return jnp.asarray(at - value * slope / (slope**2 - 0.5 * value * curve))
