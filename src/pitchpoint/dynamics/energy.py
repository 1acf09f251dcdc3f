"""Energy that goes through a mesh: in one steady period, and in a transient."""

from typing import TYPE_CHECKING

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays

if TYPE_CHECKING:
    from pitchpoint.dynamics.response import Response
    from pitchpoint.dynamics.system import System

__all__ = ["Account", "Energies", "relative_closure", "vibration_energies"]

Pairs = Float[Array, "pair element node"]
Each = Float[Array, ""]
Times = Float[Arrays, " time"]


class Energies(eqx.Module):
    """Work in one steady period, positive into the vibration [J].

    Attributes:
        load: of the nominal load, zero for a periodic motion.
        damping: of the damping, not positive.
        mesh: parametric work: the drive stiffens and softens springs that are compressed.
        error: of the profile errors.
        arm: of contacts whose arms change.
    """

    load: Each
    damping: Each
    mesh: Each
    error: Each
    arm: Each

    @property
    def sum(self) -> Each:
        """What is left; zero in a steady state."""
        return self.load + self.damping + self.mesh + self.error + self.arm

    @property
    def closure(self) -> Each:
        """What is left, relative to the largest part; zero where nothing moves."""
        parts = jnp.stack([self.load, self.damping, self.mesh, self.error, self.arm])
        return relative_closure(self.sum, parts)


def relative_closure(left: Array | np.ndarray, parts: Array | np.ndarray) -> Each:
    """Most that is left of a balance, relative to its largest part; NaN where any of them is none.

    Args:
        left: what is left, at one or several times [J].
        parts: of the balance [J].
    """
    largest = jnp.max(jnp.abs(parts))
    ratio = jnp.max(jnp.abs(left)) / jnp.where(largest > 0.0, largest, 1.0)
    # The compiler may take NaN out of a maximum, and leave minus infinity.
    return jnp.where(jnp.all(jnp.isfinite(parts)), ratio, jnp.nan)


class Account(eqx.Module):
    """Energy in a transient: what is there at each time, and what went through since its start [J].

    Attributes:
        kinetic: of all bodies.
        contacts: elastic energy of the contacts.
        bearings: elastic energy of the bearings.
        put_in: by the external torques, those that hold prescribed speeds among them.
        error: put in by the error that moves the flanks apart.
        friction: lost to sliding in the contacts.
        rolling: lost to rolling resistance.
        damping: lost to damping of contacts, mesh and bearings.
        drag: lost to resistance and viscous torques of the bodies.
        pressed: what bodies and error did on the springs of the contacts.

    From work and energy: what is put in is spent or stored.
    """

    kinetic: Times
    contacts: Times
    bearings: Times
    put_in: Times
    error: Times
    friction: Times
    rolling: Times
    damping: Times
    drag: Times
    pressed: Times

    @property
    def mesh(self) -> Times:
        """Parametric work: what phase adds to the springs beside what bodies and error do on them.

        Springs that stiffen or enter pressed bring energy in, those that soften or leave take it out.
        """
        return self.contacts - self.contacts[0] - self.pressed

    @property
    def sum(self) -> Times:
        """What is left; zero where the equations of motion are solved."""
        stored = self.kinetic + self.bearings
        spent = self.friction + self.rolling + self.damping + self.drag + self.pressed
        return self.put_in + self.error - spent - (stored - stored[0])

    @property
    def closure(self) -> Each:
        """Most that is ever left, relative to the largest part; zero where nothing moves."""
        return relative_closure(self.sum, jnp.stack(jax.tree.leaves(self)))


def vibration_energies(system: "System", response: "Response") -> Energies:
    """Work of everything that acts on the vibration in one period.

    The elastic energy of a pair is k d^2/2 with the stretch d, so its spring takes up F d' from the
    motion and k' d^2/2 from the drive, and at each hand-over the jump of k d^2/2. Holds for teeth that
    never part.

    Args:
        system: mass, damping, load, period.
        response: of `steady_state`.

    From work and energy over one period: d(k d^2/2)/dt = F d' + k' d^2/2.
    """
    course, grid = response.course, response.course.grid

    def along(values: Pairs) -> Each:
        return jnp.sum(grid.integral(values))

    speed, stretch, force = response.velocity, response.stretch, response.force
    lost = jnp.einsum("aen,ab,ben->en", speed, system.damping, speed)
    stiffness, error = course.stiffness, course.error
    moved = jnp.einsum("apen,aen->pen", grid.derivative(course.arm), response.displacement)
    before, after = _sides(stretch)
    mean_square = (before**2 + after**2) / 2.0
    mean_stiffness = sum(_sides(stiffness)) / 2.0
    of_jump = _jump(stiffness) * mean_square / 2.0
    of_gap = mean_stiffness * (after**2 - before**2) / 2.0
    return Energies(
        load=jnp.sum(course.mean(jnp.einsum("a,aen->en", system.load, speed))) * system.period,
        damping=-course.mean(lost) * system.period,
        mesh=along(grid.derivative(stiffness) * stretch**2 / 2.0) + jnp.sum(of_jump),
        error=jnp.sum(of_gap) - along(force * grid.derivative(error)),
        arm=along(force * moved),
    )


def _sides(values: Pairs) -> tuple[Float[Array, "pair element"], Float[Array, "pair element"]]:
    """Values before and after the start of each element, around the period."""
    return jnp.roll(values[..., -1], 1, axis=-1), values[..., 0]


def _jump(values: Pairs) -> Float[Array, "pair element"]:
    before, after = _sides(values)
    return after - before
