"""Modes of a mesh and its bodies about the mean of a mesh cycle: stiffness and natural frequencies."""

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.bodies import on_all_coordinates, stiffness
from pitchpoint.dynamics.right_hand_side import Moving
from pitchpoint.gears.period import nodes

__all__ = ["along_action", "mean_stiffness", "natural_frequencies"]

NODES = 14

RIGID = 1e-6
"""Natural frequency over the highest one below which a mode turns as a whole."""

Matrix = Float[Array, "coordinate coordinate"]


def mean_stiffness(moving: Moving) -> Matrix:
    """Stiffness of mesh and bearings on all coordinates, in the mean over a mesh cycle.

    Args:
        moving: mesh and bodies, with a passage.

    Returns:
        mean of sum k n n^T over the contacts, and K of the bearings [N/m, N or N m].

    From the elastic energy of springs that are all in contact.
    """
    assert moving.passage is not None
    mesh = moving.design.mesh
    phase, weight = nodes(mesh.events(), NODES)
    own, springs = jax.vmap(moving.passage.at)(phase.ravel())
    contacts = jax.vmap(lambda one: on_all_coordinates(one, mesh.coordinates, moving.bodies))(own)
    normal, weighted = contacts.normal, springs * weight.ravel()[:, None, None]
    pushed = jnp.einsum("tps,taps,tbps->ab", weighted, normal, normal)
    return pushed + stiffness(moving.bodies)


def along_action(whole: Matrix, line: Float[Array, " dof"]) -> Float[Array, ""]:
    """Stiffness along a line of action that springs on the coordinates of the mesh amount to [N/m].

    Args:
        whole: of `mean_stiffness`.
        line: closing for a unit of each coordinate of the mesh.

    From k a a^T, the stiffness of a spring k on coordinates with arms a.
    """
    own = whole[: line.shape[0], : line.shape[0]]
    return line @ own @ line / jnp.sum(line**2) ** 2


def natural_frequencies(moving: Moving, whole: Matrix) -> Float[Array, " coordinate"]:
    """Natural frequencies without damping, rising; zero for what turns as a whole [Hz].

    Args:
        moving: mesh and bodies; what a prescribed speed holds does not vibrate.
        whole: of `mean_stiffness`.

    From the eigenvalues of M^-1/2 K M^-1/2.
    """
    root = jnp.where(jnp.isinf(moving.mass), 0.0, 1.0 / jnp.sqrt(moving.mass))
    square = jnp.linalg.eigvalsh(root[:, None] * whole * root)
    frequency = jnp.sqrt(jnp.maximum(square, 0.0)) / (2.0 * jnp.pi)
    return jnp.where(frequency > RIGID * frequency[-1], frequency, 0.0)
