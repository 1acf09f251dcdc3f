"""Part of the load that asperities carry beside a film, from solved films of line contacts."""

import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.conditions import Conditions
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.materials.lubricants import Lubricant
from pitchpoint.programs import program

__all__ = ["LEAST", "asperity_share"]

LEAST = 1e-6
"""Line load over the largest one from which on a contact has a film; below it wears nothing."""

_ASKED = ("line_load", "radius", "modulus", "speed_a", "speed_b", "roughness_rq")


def asperity_share(
    model: FilmModel, at: Conditions, oil: Lubricant, temperature: Float[Array, ""]
) -> NDArray[np.float64]:
    """Part of the load of each line contact that asperities carry, by its film [pair, slice, node].

    All contacts are solved together, each from the same start: a state has the same films to the last bit
    however it was reached.

    Args:
        model: how films are solved.
        at: conditions at the contacts.
        oil: between the flanks.
        temperature: of the oil in the inlet [K].

    Returns:
        Zero where nothing is carried; not a number where a film was not solved.

    Raises:
        InputError: the oil is not known at this temperature.
    """
    asked, carries = jax.device_get(_asked(at))
    loaded = carries & (asked["line_load"] > LEAST * np.max(asked["line_load"] * carries))
    found = np.zeros(loaded.shape)
    if loaded.any():
        given = {name: np.broadcast_to(one, loaded.shape)[loaded] for name, one in asked.items()}
        # Zones of engagement repeat each other but for rounding: each film is solved once.
        rounded = [np.array([f"{x:.9e}" for x in one]) for one in given.values()]
        _, first, same = np.unique(
            np.stack(rounded, axis=1), axis=0, return_index=True, return_inverse=True
        )
        once = {name: one[first] for name, one in given.items()}
        contacts = model.contacts(**once, oil=oil, temperature=temperature)
        films = solve_lines(contacts, nodes=model.nodes, profiles=False)
        share = np.where(films.solved, np.asarray(films.film.asperity_share), np.nan)
        found[loaded] = share[same.ravel()]
    return found


@program
def _asked(at: Conditions) -> tuple[dict[str, Array], Array]:
    """What films ask of contacts, and which of these carry."""
    return {name: jnp.asarray(getattr(at, name)) for name in _ASKED}, at.contacts.active & (
        at.load > 0.0
    )
