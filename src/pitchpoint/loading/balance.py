"""Quasi-static balance: contact force and torques under friction that depends on the force."""

from collections.abc import Callable

import equinox as eqx
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, along, total
from pitchpoint.roots import root

__all__ = ["Balance", "balance"]

Lanes = Float[Array, "pair slice *b"]

LARGEST_RATIO = 20.0
"""Contact force over that without sliding friction beyond which the mesh counts as locked."""

UNSOLVED = 1e-8
"""Relative residual above which a state is no balance and its forces are NaN."""


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
        locked: True where friction holds the load: no force up to `LARGEST_RATIO` times the
            frictionless one moves it. Forces and torques are NaN there.
    """

    force: Float[Array, "*b"]
    frictionless: Float[Array, "*b"]
    load: Lanes
    friction: Lanes
    rolling: Lanes
    torque: Float[Array, "dof *b"]
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
    unrolled: int = 0,
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
        unrolled: fixed number of steps instead of as many as it takes, see `root`.

    Source: Tian et al. (2024), eqs. 1, 2, 16, for any number of contacts and coordinates.
    """
    closing = along(contacts.normal, loaded)
    side = jnp.sign(closing)
    rolling_speed = along(contacts.roll_arm, motion)
    sense = _sign(along(contacts.slip_arm, motion), jnp.abs(rolling_speed))
    turn = jnp.sign(rolling_speed)
    normal = share * jnp.abs(closing)
    slip = side * along(contacts.slip_arm, loaded) * sense
    roll = side * along(contacts.roll_arm, loaded) * turn
    arm = total(normal)
    frictionless = load / arm
    safe_load = jnp.where(load > 0.0, load, 1.0)
    # Laws never see a load of zero, where their slopes may be infinite.
    loaded_lanes = contacts.active & (share > 0.0) & (load > 0.0)

    def laws(ratio: Float[Array, "*b"]) -> tuple[Lanes, Lanes, Lanes]:
        """Load, friction coefficient and rolling resistance of each slice at F = ratio F0."""
        force = share * (ratio * frictionless)
        safe = jnp.where(loaded_lanes & (force > 0.0), force, safe_load / arm)
        coefficient = jnp.where(loaded_lanes, friction(safe), 0.0)
        resistance = rolling(safe) if rolling is not None else jnp.zeros_like(force)
        return force, coefficient, jnp.where(loaded_lanes, resistance, 0.0)

    def leverage(coefficient: Lanes) -> Float[Array, "*b"]:
        return 1.0 + total(share * coefficient * slip) / arm

    def unbalance(ratio: Float[Array, "*b"]) -> Float[Array, "*b"]:
        _, coefficient, resistance = laws(ratio)
        rolled = total(resistance * roll) / safe_load
        return ratio * leverage(coefficient) + rolled - 1.0

    start = jnp.ones(jnp.broadcast_shapes(frictionless.shape, share.shape[2:]))
    if rolling is not None:  # under a light load it is most of the force
        start = jnp.maximum(start, start - total(laws(start)[2] * roll) / safe_load)
    most = LARGEST_RATIO * jax.lax.stop_gradient(start)
    ratio, iterations = root(unbalance, start, most, unrolled=unrolled)
    force, coefficient, resistance = laws(ratio)
    torque = jnp.stack(
        [
            total(
                force * (contacts.normal[k] + coefficient * sense * contacts.slip_arm[k])
                + resistance * turn * contacts.roll_arm[k]
            )
            for k in range(motion.shape[0])
        ]
    )
    residual = jnp.abs(jnp.abs(along(torque, loaded)) - load) / safe_load
    locked = (ratio > 0.999 * most) | (leverage(coefficient) <= 0.0)
    solved = (residual <= UNSOLVED) & (ratio > 0.0) & ~locked
    return Balance(
        force=_where(solved, ratio * frictionless),
        frictionless=frictionless,
        load=_where(solved, force),
        friction=coefficient,
        rolling=resistance,
        torque=_where(solved, torque),
        residual=residual,
        iterations=iterations,
        locked=locked,
    )


def _where(solved: Bool[Array, "*b"], values: Float[Array, "..."]) -> Float[Array, "..."]:
    """Values where there is a balance, NaN elsewhere."""
    return jnp.where(solved, values, jnp.nan)


def _sign(value: Lanes, scale: Lanes) -> Lanes:
    """Sign of a velocity, zero where it is rounding against `scale`: pure rolling has no direction."""
    return jnp.where(jnp.abs(value) > 1e-13 * scale, jnp.sign(value), 0.0)
