"""Roots of scalar equations, one at each of many states at once, and of sums of squares."""

from collections.abc import Callable

from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays

__all__ = ["TOLERANCE", "find_root", "hypot", "quotient", "third_order_step"]

TOLERANCE = 1e-12
"""Largest residual at which the iteration stops; a last step follows."""

NEAR = 1e-2
"""Residual below which a state is near a root; others stay where the iteration left them."""

MOST = 60
"""Largest number of steps: enough for bisection alone."""

Each = Float[Arrays, "*#b"]
Carry = tuple[Each, Each, Each, Each, Array]


def hypot(x: Each | float, y: Each) -> Each:
    """Length of a vector by its components, of any one unit.

    The derivative of `jnp.hypot` asks by an equality which component is the larger, and is lost
    where a compiler computes the two sides of it with different rounding.
    """
    return jnp.sqrt(x**2 + y**2)


def find_root(
    function: Callable[[Each], Each],
    guess: Each,
    most: Each | float,
) -> tuple[Each, Int[Array, ""]]:
    """Root of an equation that each state solves for itself, and the steps it took.

    Newton's steps are kept in a bracket that begins as (0, most), with bisection where they leave
    it; without a root there the result ends at `most`. The iteration itself is not differentiated:
    the last step, from the root that was found, carries the first derivatives with respect to
    everything that the function closes over (no second ones). So the compiled program holds no
    callback and is kept between processes, which an implicit adjoint of a library's solver does not
    allow.

    Args:
        function: residual of order one at each state, negative at zero, elementwise.
        guess: start values.
        most: largest root that counts.

    Returns:
        Roots, and the number of steps; the caller checks the residual.
    """
    found, steps = _iterate(function, jnp.minimum(jax.lax.stop_gradient(guess), most), most)
    found = jax.lax.stop_gradient(found)
    value, slope = _tangent(function, found)
    # The derivative of the slope would be multiplied by a residual that is zero; a constant saves it.
    step = quotient(value, jax.lax.stop_gradient(slope))
    return found - jnp.where(jnp.abs(value) < NEAR, step, 0.0), steps


def _iterate(
    function: Callable[[Each], Each], start: Each, most: Each | float
) -> tuple[Each, Int[Array, ""]]:
    def unfinished(carry: Carry) -> Array:
        _, low, high, residual, steps = carry
        # A bracket down to rounding holds no better root, however large the residual that rounding leaves.
        open_ = (jnp.abs(residual) > TOLERANCE) & (high - low > 1e-15 * high)
        return (steps < MOST) & jnp.any(open_)

    def step(carry: Carry) -> Carry:
        at, low, high, _, steps = carry
        value, slope = _tangent(function, at)
        low, high = jnp.where(value < 0.0, at, low), jnp.where(value < 0.0, high, at)
        # Newton squares the error where laws are smooth; the bracket saves it where they are steep or bend.
        newton = at - quotient(value, slope)
        inside = (newton > low) & (newton < high)
        further = jnp.where(inside, newton, (low + high) / 2.0)
        # A state that is found stays as it is, whatever others of the batch still need.
        done = jnp.abs(value) <= TOLERANCE
        return jnp.where(done, at, further), low, high, value, steps + 1

    low, high = jnp.zeros_like(start), jnp.full_like(start, most)
    begin = (start, low, high, jnp.full_like(start, jnp.inf), jnp.asarray(0))
    found, _, _, _, steps = jax.lax.while_loop(unfinished, step, begin)
    return found, steps


def _tangent(function: Callable[[Each], Each], at: Each) -> tuple[Each, Each]:
    """Value and derivative at each state."""
    value, slope = jax.jvp(function, (at,), (jnp.ones_like(at),))
    return value, slope


def third_order_step(function: Callable[[Each], Each], at: Each) -> Each:
    """One step towards the root of each state: Newton's with the curvature (Halley's)."""
    (value, slope), (_, curve) = jax.jvp(
        lambda x: _tangent(function, x), (at,), (jnp.ones_like(at),)
    )
    return at - quotient(value * slope, slope**2 - 0.5 * value * curve)


def quotient(over: Each, under: Each) -> Each:
    """Quotient, zero where the divisor is."""
    return jnp.where(under == 0.0, 0.0, over / jnp.where(under == 0.0, 1.0, under))
