"""Quasi-static balance: contact force and torques under friction that depends on the force."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.core.factored import Arrays, Numbers, factored_product
from pitchpoint.core.roots import find_root, quotient, third_order_step
from pitchpoint.core.status import Code, Status

__all__ = ["Balance", "first_guess", "force_balance", "tooth_load"]

Lanes = Float[Numbers, "pair slice *#b"]
Each = Float[Arrays, "*#b"]
Drag = Callable[[Lanes], Float[Array, "dof *#b"]]
Friction = Callable[[Lanes], Lanes]
Torques = list[Each]
Terms = tuple[Lanes, Lanes, Torques, Torques]

LARGEST_RATIO = 1e4
"""Contact force over that without sliding friction up to which a balance is looked for.

A constant coefficient of friction comes within 1e-4 of the one that locks the mesh; nearer to it the
force is the small difference of large torques, and rounding would decide.
"""

_ALMOST = 0.999
"""Part of the largest force beyond which a root counts as none."""

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

    Source: Tian et al. (2024), eqs. 1, 2 and 16, see `force_balance`.
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
    def status(self) -> Status:
        """What became of the search for the contact force."""
        taken = jnp.isinf(self.residual) & ~self.locked
        lost = ~(self.residual <= UNSOLVED)
        code = jnp.where(lost, int(Code.NOT_CONVERGED), int(Code.SOLVED))
        code = jnp.where(taken, int(Code.TAKEN_ALONG), code)
        code = jnp.where(self.locked, int(Code.LOCKED), code)
        return Status(code, self.residual, self.iterations)

    @property
    def largest_friction(self) -> Float[Array, "*b"]:
        """Largest friction coefficient of the contacts."""
        return jnp.max(self.friction, axis=(0, 1))


class _Equation:
    """Equation of balance of given states for the contact force over that without friction.

    Arguments are those of `force_balance`.
    """

    def __init__(
        self,
        contacts: Contacts,
        share: Lanes,
        *,
        motion: Float[Array, " dof"],
        loaded: Float[Array, " dof"],
        load: Each,
        friction: Friction,
        rolling: Friction | None = None,
        drag: Drag | None = None,
    ) -> None:
        self.contacts, self.share, self.loaded, self.load = contacts, share, loaded, load
        self.friction, self.rolling, self.drag = friction, rolling, drag
        closing = contact_velocity(contacts.normal, loaded)
        rolling_speed = contact_velocity(contacts.roll_arm, motion)
        self.sense = _sign(contact_velocity(contacts.slip_arm, motion), jnp.abs(rolling_speed))
        self.turn = jnp.sign(rolling_speed)
        self.arm = total(share * jnp.abs(closing))
        self.side = jnp.sign(total(share * closing))
        self.friction_arms = share * self.sense * contacts.slip_arm
        self.carried = tooth_load(contacts, loaded=loaded, load=load, drag=drag)
        self.frictionless = self.carried / self.arm
        self.safe_load = jnp.where(self.carried > 0.0, self.carried, 1.0)
        self.carrying = contacts.active & (share > 0.0)
        self.safe_share = jnp.where(self.carrying, share, 1.0)

    def laws(self, ratio: Each) -> tuple[Lanes, Lanes]:
        """Friction coefficient and rolling resistance of each slice at F = ratio F0."""
        force = ratio * self.frictionless
        # Laws never see a load of zero, where their slopes may be infinite.
        safe = jnp.where(force > 0.0, force, self.safe_load / self.arm)
        lanes = self.carrying & (self.carried > 0.0)
        load = factored_product(self.safe_share, safe)
        coefficient = jnp.where(lanes, self.friction(load), 0.0)
        if self.rolling is None:
            return coefficient, jnp.zeros_like(coefficient)
        return coefficient, jnp.where(lanes, self.rolling(load), 0.0)

    def pressed(self, ratio: Each) -> Each:
        """What the drag on the driven coordinate adds to its load as the teeth are pressed, over it."""
        taken = self.load - self.carried  # by the drag without any force on the teeth
        force = self.share * (ratio * self.frictionless)
        return (taken - _relief(self.contacts, self.loaded, self.drag, force)) / self.safe_load

    def torques(self, coefficient: Lanes, resistance: Lanes) -> tuple[Torques, Torques]:
        """Torques on the coordinates: of friction for a unit of force, and of the rolling resistance."""
        friction = [total(coefficient * arm) for arm in self.friction_arms]
        rolling = [total(resistance * (self.turn * arm)) for arm in self.contacts.roll_arm]
        return friction, rolling

    def unbalance(self, ratio: Each) -> Each:
        """What is carried too much, over the load."""
        return self.terms(ratio)[0]

    def terms(self, ratio: Each) -> tuple[Each, Terms]:
        """What is carried too much, over the load, and what friction and rolling add to the torques."""
        coefficient, resistance = self.laws(ratio)
        friction, rolling = self.torques(coefficient, resistance)
        value = ratio * (1.0 + self.side * _along(friction, self.loaded) / self.arm) - 1.0
        if self.rolling is not None:
            value = value + self.side * _along(rolling, self.loaded) / self.safe_load
        if self.drag is not None:
            value = value - self.pressed(ratio)
        return value, (coefficient, resistance, friction, rolling)

    def last_step(self, ratio: Each) -> tuple[Each, Terms, Each]:
        """Newton's step from near the root; laws go along their tangent, which leaves its square."""
        ratio = _apart(ratio)
        found, change = _apart(jax.jvp(self.terms, (ratio,), (jnp.ones_like(ratio),)))
        step = -quotient(found[0], jax.lax.stop_gradient(change[0]))
        terms: Terms = jax.tree.map(lambda a, b: a + b * step, found[1], change[1])
        return ratio + step, terms, step**2

    def start(self) -> Each:
        """Ratio to start from."""
        shape = jnp.broadcast_shapes(self.frictionless.shape, self.share.shape[2:])
        ones = jnp.ones(shape, self.frictionless.dtype)
        if self.rolling is None:
            return ones
        # Under a light load rolling is most of the force.
        _, rolling = self.torques(*self.laws(ones))
        return jnp.maximum(ones, ones - self.side * _along(rolling, self.loaded) / self.safe_load)


def first_guess(contacts: Contacts, share: Lanes, **given: Any) -> Each:
    """Contact force over that without friction after one step of third order; arguments of `force_balance`.

    In single precision it takes half the time, and is near enough for one step in double precision.

    From Halley's step, see `core.roots.third_order_step`.
    """
    equation = _Equation(contacts, share, **given)
    return third_order_step(equation.unbalance, equation.start())


def force_balance(
    contacts: Contacts,
    share: Lanes,
    *,
    motion: Float[Array, " dof"],
    loaded: Float[Array, " dof"],
    load: Each,
    friction: Friction,
    rolling: Friction | None = None,
    drag: Drag | None = None,
    guess: Each | None = None,
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
        guess: contact force over that without friction, where it is known nearly: one step from there
            instead of as many as it takes, whose square counts among the residual.

    Source: Tian et al. (2024), eqs. 1, 2, 16, for any number of contacts and coordinates.
    """
    equation = _Equation(
        contacts,
        share,
        motion=motion,
        loaded=loaded,
        load=load,
        friction=friction,
        rolling=rolling,
        drag=drag,
    )
    start = equation.start()
    most = LARGEST_RATIO * jax.lax.stop_gradient(start)
    left: Each | float = 0.0
    if guess is None:
        ratio, iterations = find_root(equation.unbalance, start, most)
        # A state without a root ends at the bracket, where laws would be asked for an absurd load.
        _, terms = equation.terms(jnp.where(ratio > _ALMOST * most, start, ratio))
    else:
        ratio, terms, left = equation.last_step(jax.lax.stop_gradient(guess))
        # The guess was one step, this is the other.
        iterations = jnp.asarray(2)
    lost = ratio > _ALMOST * most
    coefficient, resistance, by_friction, by_rolling = terms
    pushed = jnp.where(lost, start, ratio) * equation.frictionless
    force = share * pushed
    torque = jnp.stack(
        [
            pushed * (total(share * normal) + friction) + rolling
            for normal, friction, rolling in zip(
                contacts.normal, by_friction, by_rolling, strict=True
            )
        ]
    )
    grip = 1.0 + equation.side * _along(by_friction, loaded) / equation.arm
    beside = jnp.zeros_like(torque)
    if drag is not None:
        beside = jnp.broadcast_to(drag(force), torque.shape)
        torque = torque + beside
        grip = grip - equation.pressed(ratio) / jnp.where(ratio == 0.0, 1.0, ratio)
    residual = jnp.abs(jnp.abs(contact_velocity(torque, loaded)) - load) / equation.safe_load
    residual = jnp.where(equation.carried < 0.0, jnp.inf, residual + left)
    if guess is not None:
        ratio, torque, residual, grip = _apart((ratio, torque, residual, grip))
    locked = (ratio > _ALMOST * most) | (grip <= 0.0)
    slip = contact_velocity(equation.friction_arms, loaded)
    hold = -equation.side * total(slip) / equation.arm
    # The inner choice keeps the slope finite where the outer one leaves the quotient out: else it is NaN.
    jamming = jnp.where(hold > 0.0, 1.0 / jnp.where(hold > 0.0, hold, 1.0), jnp.inf)
    solved = (residual <= UNSOLVED) & (ratio > 0.0) & (equation.carried >= 0.0) & ~locked
    return Balance(
        force=_where(solved, ratio * equation.frictionless),
        frictionless=equation.frictionless,
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
        drag: external torque on every coordinate from the normal force of each slice, see `force_balance`.

    Returns:
        Torque or force [N m or N]; negative where the drag takes the coordinate along with more than
        its load.

    From the balance of the driven coordinate while no contact is loaded.
    """
    if drag is None:
        return load
    return load - _relief(contacts, loaded, drag, jnp.zeros_like(contacts.weight))


def _relief(
    contacts: Contacts, loaded: Float[Array, " dof"], drag: Drag | None, force: Lanes
) -> Each:
    """External torque that overcomes the drag on the driven coordinate, counted as its load is."""
    assert drag is not None
    closing = jnp.where(contacts.active, contact_velocity(contacts.normal, loaded), 0.0)
    return jnp.sign(total(closing)) * contact_velocity(drag(force), loaded)


def _along(torques: Torques, rates: Float[Array, " dof"]) -> Each:
    return sum(
        (rate * one for rate, one in zip(rates[1:], torques[1:], strict=True)),
        rates[0] * torques[0],
    )


def _apart(values: Any) -> Any:
    """The values as they are, in a way that keeps what follows from being fused with what made them.

    The compiler fuses cheap and expensive operations alike into every loop that asks for their result,
    and computes them again in each; its own barriers it removes before it fuses. A condition that is
    always true, which it cannot know, is one that stays (a sixth of the time of `benchmarks/states.py`).
    """
    always = jax.tree.leaves(values)[0].ravel()[0] != -jnp.inf
    return jax.lax.cond(always, lambda x: x, lambda x: jax.tree.map(jnp.negative, x), values)


def _where(solved: Bool[Array, "*b"], values: Float[Array, "..."]) -> Float[Array, "..."]:
    """Values where there is a balance, NaN elsewhere."""
    return jnp.where(solved, values, jnp.nan)


def _sign(value: Lanes, scale: Lanes) -> Lanes:
    """Sign of a velocity, zero where it is rounding against `scale`: pure rolling has no direction."""
    return jnp.where(jnp.abs(value) > 1e-13 * scale, jnp.sign(value), 0.0)
