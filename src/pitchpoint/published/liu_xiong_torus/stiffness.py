"""Stiffness of a pair of teeth over its path as the library has it, beside Table 1 and its polynomial."""

import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import program
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.compliance import slice_stiffness
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid

__all__ = ["library_stiffness", "linear_interpolation"]

Values = NDArray[np.float64]


def library_stiffness(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: float,
    path: Values,
) -> dict[str, Values]:
    """Secant and slope of the normal force of a pair over its deflection.

    Bending of both teeth, the bodies under them and the contact; two pairs in mesh carry half the load each,
    as the library's stiffness has it.

    Args:
        mesh: either pair of gears.
        loaded: one for the gear that carries the load.
        solids: material of each gear.
        terms: of the model of tooth compliance.
        load: on the gear [N m].
        path: places from the entry of the pair on, shape (place) [base pitches].

    Returns:
        `secant` k = F_n/delta, as eq. 4 of the paper has it, and `slope` dF_n/d delta under the load, each of
        shape (place) [N/m].
    """
    phase, gone = np.modf(path)
    secant, slope = jax.device_get(
        _of_pairs(mesh, loaded, solids, terms, array(load), array(phase))
    )
    at = np.arange(path.size)
    pair = gone.astype(int)
    return {"secant": secant[pair, at], "slope": slope[pair, at]}


@program
def _of_pairs(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, ""],
    phase: Float[Array, " place"],
) -> tuple[Float[Array, "pair place"], Float[Array, "pair place"]]:
    contacts = mesh.contacts(phase)

    def whole(load: Float[Array, ""]) -> Float[Array, "pair place"]:
        stiffness = slice_stiffness(mesh, loaded, contacts, solids, terms, load) * contacts.weight
        return jnp.sum(jnp.where(contacts.active, stiffness, 0.0), axis=1)

    # delta = F/k(F), with F in proportion to the load: d delta/dF = (1 - F k'/k)/k.
    secant, change = jax.jvp(whole, (load,), (load,))
    return secant, secant / (1.0 - change / jnp.where(secant > 0.0, secant, 1.0))


def linear_interpolation(roll: Values, places: Values, values: Values) -> Values:
    """Values of a table, straight between its places and unknown beyond them."""
    return np.asarray(np.interp(roll, places, values, left=np.nan, right=np.nan))
