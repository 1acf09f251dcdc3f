"""Quasi-static balance: contact force and torques under friction that depends on the force."""

from collections.abc import Callable

import equinox as eqx
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, along, total
from pitchpoint.roots import root

__all__ = ["Balance", "balance", "tooth_load"]

Lanes = Float[Array, "pair slice *b"]
Each = Float[Array, "*b"]
Drag = Callable[[Lanes], Float[Array, "dof *b"]]

LARGEST_RATIO = 1e4
"""Contact force over that without sliding friction up to which a balance is looked for.

A constant coefficient of friction comes within 1e-4 of the one that locks the mesh; nearer to it the
force is the small difference of large torques, and rounding would decide.
"""

UNSOLVED = 1e-8
"""Relative residual above which a state is no balance and its forces are NaN."""


class Balance(eqx.Module):
    """Forces in equilibrium.

    Attributes:
        force: sum of the normal forces [N].
        frictionless: the same without friction on the teeth [N]; what it carries is `tooth_load`.
        load: normal force of each slice [N].
        friction: friction coefficient of each slice.
        rolling: rolling resistance of each slice, on each of its surfaces [N].
        torque: external torque or force on each coordinate [N m or N].
        drag: part of it that overcomes the losses beside the teeth.
        residual: relative error of the balance; infinite where losses beside the teeth drive the loaded
            coordinate with more than its load, so that other flanks would touch.
        iterations: of the solver, common to the states that were solved together.
        locked: True where friction holds the load: no force up to `LARGEST_RATIO` times the
            frictionless one moves it. Forces and torques are NaN there, and where the drag takes the
            driven coordinate along with more than its load, for which other flanks would have to touch;
            the friction coefficients there are those under the frictionless force.
        jamming: coefficient of friction, the same at all contacts, from which on the mesh is locked:
            normal arm over -sum(share times sliding arm), at which the leverage of the contact force
            vanishes; infinite where friction pushes on.
    """

    force: Float[Array, "*b"]
    frictionless: Float[Array, "*b"]
    load: Lanes
    friction: Lanes
    rolling: Lanes
    torque: Float[Array, "dof *b"]
    drag: Float[Array, "dof *b"]
    residual: Float[Array, "*b"]
    iterations: Int[Array, ""]
    locked: Bool[Array, "*b"]
    jamming: Float[Array, "*b"]

    @property
    def largest_friction(self) -> Float[Array, "*b"]:
        """Largest friction coefficient of the contacts."""
        return jnp.max(self.friction, axis=(0, 1))


def balance(
    contacts: Contacts,
    share: Lanes,
    *,
    motion: Float[Array, " dof"],
    loaded: Float[Array, " dof"],
    load: Float[Array, "*b"],
    friction: Callable[[Lanes], Lanes],
    rolling: Callable[[Lanes], Lanes] | None = None,
    drag: Drag | None = None,
    unrolled: int = 0,
) -> Balance:
    """Contact force that carries a prescribed load against friction, and the torques it takes.

    With contact force F, share s, friction coefficient mu and arms n, t of closing and sliding, every
    coordinate carries Q = sum of F s (n + mu sign t) + D; mu and the drag D of what lies beside the
    teeth depend on F s, so F is the root of a scalar equation at each state, solved by Newton in F
    over the force without friction. With drag the teeth are pressed without external load too.

    Args:
        contacts: of the mesh.
        share: of the load on each slice, summing to one.
        motion: rates of the coordinates; only their signs and ratios matter.
        loaded: one for the coordinate whose load is prescribed.
        load: torque or force there, not negative [N m or N].
        friction: coefficient from the normal force of each slice [N].
        rolling: resistance on each surface [N] from the normal force of each slice; none by default.
        drag: external torque on every coordinate that overcomes the losses beside the teeth [N m or N],
            from the normal force of each slice [N]; none by default.
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
    carried = tooth_load(contacts, loaded=loaded, load=load, drag=drag)
    frictionless = carried / arm
    safe_load = jnp.where(carried > 0.0, carried, 1.0)
    # Laws never see a load of zero, where their slopes may be infinite.
    loaded_lanes = contacts.active & (share > 0.0) & (carried > 0.0)

    def laws(ratio: Float[Array, "*b"]) -> tuple[Lanes, Lanes, Lanes]:
        """Load, friction coefficient and rolling resistance of each slice at F = ratio F0."""
        force = share * (ratio * frictionless)
        safe = jnp.where(loaded_lanes & (force > 0.0), force, safe_load / arm)
        coefficient = jnp.where(loaded_lanes, friction(safe), 0.0)
        resistance = rolling(safe) if rolling is not None else jnp.zeros_like(force)
        return force, coefficient, jnp.where(loaded_lanes, resistance, 0.0)

    def leverage(coefficient: Lanes) -> Float[Array, "*b"]:
        return 1.0 + total(share * coefficient * slip) / arm

    def pressed(force: Lanes) -> Each:
        """What the drag on the driven coordinate adds to its load as the teeth are pressed, over it."""
        taken = load - carried  # by the drag without any force on the teeth
        return (taken - _relief(contacts, loaded, drag, force)) / safe_load

    def unbalance(ratio: Each) -> Each:
        force, coefficient, resistance = laws(ratio)
        rolled = total(resistance * roll) / safe_load
        value = ratio * leverage(coefficient) + rolled - 1.0
        return value if drag is None else value - pressed(force)

    start = jnp.ones(jnp.broadcast_shapes(frictionless.shape, share.shape[2:]))
    if rolling is not None:  # under a light load it is most of the force
        start = jnp.maximum(start, start - total(laws(start)[2] * roll) / safe_load)
    most = LARGEST_RATIO * jax.lax.stop_gradient(start)
    ratio, iterations = root(unbalance, start, most, unrolled=unrolled)
    lost = ratio > 0.999 * most
    force, coefficient, resistance = laws(jnp.where(lost, start, ratio))
    torque = jnp.stack(
        [
            total(
                force * (contacts.normal[k] + coefficient * sense * contacts.slip_arm[k])
                + resistance * turn * contacts.roll_arm[k]
            )
            for k in range(motion.shape[0])
        ]
    )
    grip, beside = leverage(coefficient), jnp.zeros_like(torque)
    if drag is not None:
        beside = jnp.broadcast_to(drag(force), torque.shape)
        torque = torque + beside
        grip = grip - pressed(force) / jnp.where(ratio == 0.0, 1.0, ratio)
    residual = jnp.abs(jnp.abs(along(torque, loaded)) - load) / safe_load
    residual = jnp.where(carried < 0.0, jnp.inf, residual)
    locked = lost | (grip <= 0.0)
    hold = -total(share * slip) / arm
    jamming = jnp.where(hold > 0.0, 1.0 / jnp.where(hold > 0.0, hold, 1.0), jnp.inf)
    solved = (residual <= UNSOLVED) & (ratio > 0.0) & (carried >= 0.0) & ~locked
    return Balance(
        force=_where(solved, ratio * frictionless),
        frictionless=frictionless,
        load=_where(solved, force),
        friction=coefficient,
        rolling=resistance,
        torque=_where(solved, torque),
        drag=_where(solved, beside),
        residual=residual,
        iterations=iterations,
        locked=locked,
        jamming=jnp.broadcast_to(jamming, residual.shape),
    )


def tooth_load(
    contacts: Contacts, *, loaded: Float[Array, " dof"], load: Each, drag: Drag | None = None
) -> Each:
    """What teeth carry at the driven coordinate: its load and the drag there without force on the teeth.

    Args:
        contacts: of the mesh; the active ones press the driven coordinate the same way.
        loaded: one for the driven coordinate.
        load: torque or force there, not negative [N m or N].
        drag: external torque on every coordinate from the normal force of each slice, see `balance`.

    Returns:
        Torque or force [N m or N]; negative where the drag takes the coordinate along with more than
        its load.
    """
    if drag is None:
        return load
    return load - _relief(contacts, loaded, drag, jnp.zeros_like(contacts.weight))


def _relief(
    contacts: Contacts, loaded: Float[Array, " dof"], drag: Drag | None, force: Lanes
) -> Each:
    """External torque that overcomes the drag on the driven coordinate, counted as its load is."""
    assert drag is not None
    closing = jnp.where(contacts.active, along(contacts.normal, loaded), 0.0)
    return jnp.sign(total(closing)) * along(drag(force), loaded)


def _where(solved: Bool[Array, "*b"], values: Float[Array, "..."]) -> Float[Array, "..."]:
    """Values where there is a balance, NaN elsewhere."""
    return jnp.where(solved, values, jnp.nan)


def _sign(value: Lanes, scale: Lanes) -> Lanes:
    """Sign of a velocity, zero where it is rounding against `scale`: pure rolling has no direction."""
    return jnp.where(jnp.abs(value) > 1e-13 * scale, jnp.sign(value), 0.0)
