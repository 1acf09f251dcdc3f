"""Modes of a mesh and its bodies about the mean of a mesh cycle: stiffness, frequencies, damping."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.moving_bodies import bearing_damping, bearing_stiffness, on_all_coordinates
from pitchpoint.dynamics.right_hand_side import MovingMesh, contact_forces
from pitchpoint.gears.period import nodes

__all__ = ["Modes", "along_action", "mean_stiffness", "modes"]

# As of `passage`: of the mean stiffness of a pair six nodes leave an error of 4e-9, twelve rounding.
NODES = 14

RIGID = 1e-6
"""Natural frequency over the highest one below which a mode turns as a whole."""

Matrix = Float[Array, "coordinate coordinate"]


def mean_stiffness(moving: MovingMesh) -> Matrix:
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
    of_mesh, springs = jax.vmap(moving.passage.at)(phase.ravel())
    contacts = jax.vmap(
        lambda at_node: on_all_coordinates(at_node, mesh.coordinates, moving.bodies)
    )(of_mesh)
    normal, weighted = contacts.normal, springs * weight.ravel()[:, None, None]
    pushed = jnp.einsum("tps,taps,tbps->ab", weighted, normal, normal)
    return pushed + bearing_stiffness(moving.bodies)


def along_action(whole: Matrix, line: Float[Array, " dof"]) -> Float[Array, ""]:
    """Stiffness along a line of action that springs on the coordinates of the mesh amount to [N/m].

    Args:
        whole: of `mean_stiffness`.
        line: closing for a unit of each coordinate of the mesh.

    From k a a^T, the stiffness of a spring k on coordinates with arms a.
    """
    of_mesh = whole[: line.shape[0], : line.shape[0]]
    return line @ of_mesh @ line / jnp.sum(line**2) ** 2


class Modes(eqx.Module):
    """Modes without friction, in the order of their frequencies.

    Attributes:
        frequency: without damping; zero for what turns as a whole [Hz].
        damping: damping ratio of each mode by itself; zero for what turns as a whole.
        share: of the elastic energy of a mode, in the teeth first, then in the bearings of every
            translation.
    """

    frequency: Float[Array, " coordinate"]
    damping: Float[Array, " coordinate"]
    share: Float[Array, "coordinate place"]


def modes(moving: MovingMesh) -> Modes:
    """Modes of mesh and bodies about the mean of a mesh cycle.

    Args:
        moving: mesh and bodies, with a passage; what a prescribed speed holds does not vibrate.

    From the eigenvectors of M^-1/2 K M^-1/2, and C and the parts of K in them.
    """
    springs, bearings = mean_stiffness(moving), bearing_stiffness(moving.bodies)
    root = jnp.where(jnp.isinf(moving.mass), 0.0, 1.0 / jnp.sqrt(moving.mass))
    square, vectors = jnp.linalg.eigh(root[:, None] * springs * root)
    turning = jnp.sqrt(jnp.maximum(square, 0.0))
    vibrates = turning > RIGID * turning[-1]
    shape, some = root[:, None] * vectors, jnp.where(vibrates, turning, 1.0)
    held = shape * (bearings @ shape)
    teeth = jnp.sum(shape * ((springs - bearings) @ shape), axis=0)
    damped = jnp.sum(shape * (_damping(moving, springs) @ shape), axis=0)
    translations = held[len(moving.bodies) :]
    share = jnp.concatenate([teeth[None], translations]) / some**2
    return Modes(
        frequency=jnp.where(vibrates, turning, 0.0) / (2.0 * jnp.pi),
        damping=jnp.where(vibrates, damped / (2.0 * some), 0.0),
        share=jnp.where(vibrates, share, 0.0).T,
    )


def _damping(moving: MovingMesh, springs: Matrix) -> Matrix:
    """Of the bearings, of the contacts in proportion to their stiffness, and along the line of action."""
    still = jnp.zeros(moving.mass.shape[0])
    line = contact_forces(moving, still, still).line
    of_contacts = moving.relaxation * (springs - bearing_stiffness(moving.bodies))
    return (
        bearing_damping(moving.bodies) + of_contacts + moving.mesh_damping * jnp.outer(line, line)
    )
