"""Quasi-static balance: contact force and torques under friction that depends on the force."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import lineax as lx
import optimistix as optx
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts

__all__ = ["Balance", "balance"]

Lanes = Float[Array, "*b pair slice"]
TOLERANCE = 1e-11


class Balance(eqx.Module):
    """Forces in equilibrium.

    Attributes:
        force: sum of the normal forces [N].
        frictionless: the same without friction [N].
        load: normal force of each slice [N].
        friction: friction coefficient of each slice.
        rolling: rolling resistance of each slice, on each of its surfaces [N].
        torque: external torque or force on each coordinate [N m or N].
        residual: relative error of the balance.
        iterations: of the solver, common to the states that were solved together.
        locked: True where friction alone holds the load: no force moves it.
    """

    force: Float[Array, "*b"]
    frictionless: Float[Array, "*b"]
    load: Lanes
    friction: Lanes
    rolling: Lanes
    torque: Float[Array, "*b dof"]
    residual: Float[Array, "*b"]
    iterations: Int[Array, ""]
    locked: Bool[Array, "*b"]


def balance(
    contacts: Contacts,
    share: Lanes,
    *,
    motion: Float[Array, " dof"],
    loaded: Float[Array, " dof"],
    load: Float[Array, "*b"],
    friction: Callable[[Lanes], Lanes],
    rolling: Callable[[Lanes], Lanes] | None = None,
) -> Balance:
    """Contact force that carries a prescribed load against friction, and the torques it takes.

    With contact force F, share s, friction coefficient mu and arms n, t of closing and sliding, every
    coordinate carries Q = sum of F s (n + mu sign t); mu depends on F s, so F is the root of a scalar
    equation at each state, solved by Newton in F over the force without friction.

    Args:
        contacts: of the mesh.
        share: of the load on each slice, summing to one.
        motion: rates of the coordinates; only their signs and ratios matter.
        loaded: one for the coordinate whose load is prescribed.
        load: torque or force there, not negative [N m or N].
        friction: coefficient from the normal force of each slice [N].
        rolling: resistance on each surface [N] from the normal force of each slice; none by default.

    Source: Tian et al. (2024), eqs. 1, 2, 16, for any number of contacts and coordinates.
    """
    side = jnp.sign(contacts.normal @ loaded)
    normal = share * jnp.abs(contacts.normal @ loaded)
    slip = side * (contacts.slip_arm @ loaded) * jnp.sign(contacts.slip_arm @ motion)
    roll = side * (contacts.roll_arm @ loaded) * jnp.sign(contacts.roll_arm @ motion)
    arm = jnp.sum(normal, axis=(-2, -1))
    frictionless = load / arm
    safe_load = jnp.where(load > 0.0, load, 1.0)

    def laws(ratio: Float[Array, "*b"]) -> tuple[Lanes, Lanes, Lanes]:
        """Load, friction coefficient and rolling resistance of each slice at F = ratio F0."""
        force = share * (ratio * frictionless)[..., None, None]
        coefficient = jnp.where(contacts.active, friction(force), 0.0)
        resistance = rolling(force) if rolling is not None else jnp.zeros_like(force)
        return force, coefficient, jnp.where(contacts.active & (force > 0.0), resistance, 0.0)

    def leverage(coefficient: Lanes) -> Float[Array, "*b"]:
        return 1.0 + jnp.sum(share * coefficient * slip, axis=(-2, -1)) / arm

    def unbalance(ratio: Float[Array, "*b"], args: None) -> Float[Array, "*b"]:
        _, coefficient, resistance = laws(ratio)
        rolled = jnp.sum(resistance * roll, axis=(-2, -1)) / safe_load
        return ratio * leverage(coefficient) + rolled - 1.0

    solver: optx.Newton[Any, Any, Any] = optx.Newton(
        rtol=TOLERANCE, atol=TOLERANCE, linear_solver=lx.Diagonal(), norm=optx.max_norm
    )
    solution: optx.Solution[Any, Any] = optx.root_find(
        unbalance,
        solver,
        jnp.ones(jnp.broadcast_shapes(frictionless.shape, share.shape[:-2])),
        tags=frozenset({lx.diagonal_tag}),
        adjoint=optx.ImplicitAdjoint(linear_solver=lx.Diagonal()),
        max_steps=30,
        throw=False,
    )
    force, coefficient, resistance = laws(solution.value)
    sign = jnp.sign(contacts.slip_arm @ motion)
    turn = jnp.sign(contacts.roll_arm @ motion)
    torque = (
        force[..., None] * (contacts.normal + (coefficient * sign)[..., None] * contacts.slip_arm)
        + (resistance * turn)[..., None] * contacts.roll_arm
    )
    total = jnp.sum(torque, axis=(-3, -2))
    return Balance(
        force=solution.value * frictionless,
        frictionless=frictionless,
        load=force,
        friction=coefficient,
        rolling=resistance,
        torque=total,
        residual=jnp.abs(jnp.abs(total @ loaded) - load) / safe_load,
        iterations=jnp.asarray(solution.stats["num_steps"]),
        locked=leverage(coefficient) <= 0.0,
    )
