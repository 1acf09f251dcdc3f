"""The equations of motion without dimensions, on coordinates of unit mass."""

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.excitation import ExcitationCourse
from pitchpoint.dynamics.system import System

__all__ = ["Equations", "equations"]


class Equations(eqx.Module):
    """z'' + C z' + sum over pairs of arm k law(arm z - e) = f, time in 1/frequency.

    Attributes:
        damping, load: of the coordinates.
        stiffness, arm, error: of the pairs at the nodes.
        frequency: unit of inverse time [rad/s].
        scale: coordinates q per z [m or rad].
        unit: length along the contacts per unit of stretch, times root of mass.
        finite: False where an input was not; the equations are then those of a body at rest.

    Source: Atanasiu et al. (2011), eqs. 10 and 11, for any number of coordinates and pairs.
    """

    damping: Float[Array, "coordinate coordinate"]
    load: Float[Array, " coordinate"]
    stiffness: Float[Array, "pair element node"]
    arm: Float[Array, "coordinate pair element node"]
    error: Float[Array, "pair element node"]
    frequency: Float[Array, ""]
    scale: Float[Array, "coordinate coordinate"]
    unit: Float[Array, ""]
    finite: Bool[Array, ""]

    @property
    def total_stiffness(self) -> Float[Array, "coordinate coordinate element node"]:
        """Sum over the pairs of arm, stiffness and arm.

        From virtual work: a spring counts with the product of its arms.
        """
        return jnp.einsum("apen,pen,bpen->aben", self.arm, self.stiffness, self.arm)

    @property
    def total_load(self) -> Float[Array, "coordinate element node"]:
        """Load and what the profile errors add to it.

        Source: Atanasiu et al. (2011), eqs. 10 and 11: what the error adds stands on the side of the
        load.
        """
        of_error = jnp.einsum("apen,pen->aen", self.arm, self.stiffness * self.error)
        return self.load[:, None, None] + of_error

    def steps(
        self, course: ExcitationCourse, period: Float[Array, ""]
    ) -> Float[Array, "element interval"]:
        """Half the duration between neighbouring nodes."""
        between = jnp.diff(course.grid.place) / 2.0
        duration = jnp.where(self.finite, self.frequency * period, 0.0)
        return duration * course.length[:, None] * between


def equations(system: System, course: ExcitationCourse) -> Equations:
    """Equations on coordinates of unit mass, scaled by the mean stiffness and the load.

    From M q'' + C q' + K q = f with q = scale z, where M = L L^T and scale is L^-T times a length.
    """
    finite = _all_finite((system, course))
    factor, eye = jnp.linalg.cholesky(system.mass), jnp.eye(system.load.shape[0])
    root = jax.scipy.linalg.solve_triangular(factor, eye, lower=True)
    arm = jnp.einsum("ab,bpen->apen", root, course.arm)
    load = root @ system.load
    stiffness = jnp.einsum("apen,pen,apen->en", arm, course.stiffness, arm)
    # Units are free, so they are constants: results in SI have the same derivatives without theirs.
    square = _positive(jax.lax.stop_gradient(course.mean(stiffness)))
    from_error = jnp.einsum("apen,pen->aen", arm, course.stiffness * course.error)
    largest = jnp.sum(load**2) + jnp.max(jnp.sum(from_error**2, axis=0))
    unit = jnp.sqrt(_positive(jax.lax.stop_gradient(largest))) / square
    frequency = jnp.sqrt(square)

    def checked(values: Array) -> Array:
        return jnp.where(finite, values, 0.0)

    return Equations(
        damping=checked(root @ system.damping @ root.T / frequency),
        load=checked(load / (unit * square)),
        stiffness=checked(course.stiffness / square),
        arm=checked(arm),
        error=checked(course.error / unit),
        frequency=checked(frequency),
        scale=checked(root.T * unit),
        unit=checked(unit),
        finite=finite,
    )


def _positive(value: Float[Array, ""]) -> Float[Array, ""]:
    return jnp.where(value > 0.0, value, 1.0)


def _all_finite(inputs: object) -> Bool[Array, ""]:
    leaves = jax.tree.leaves(inputs)
    return jnp.all(jnp.stack([jnp.all(jnp.isfinite(leaf)) for leaf in leaves]))
