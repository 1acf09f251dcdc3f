"""Part of the load that asperities carry beside a film, from solved films of line contacts."""

import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.lubrication.conditions import Conditions
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.materials.lubricants import Lubricant

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
    conditions, carries = jax.device_get(_asked(at))
    loaded = carries & (conditions["line_load"] > LEAST * np.max(conditions["line_load"] * carries))
    shares = np.zeros(loaded.shape)
    if loaded.any():
        of_films = {
            name: np.broadcast_to(values, loaded.shape)[loaded]
            for name, values in conditions.items()
        }
        # Zones of engagement repeat each other but for rounding: each film is solved once.
        rounded = [np.array([f"{x:.9e}" for x in values]) for values in of_films.values()]
        _, distinct, film_of_contact = np.unique(
            np.stack(rounded, axis=1), axis=0, return_index=True, return_inverse=True
        )
        once = {name: values[distinct] for name, values in of_films.items()}
        contacts = model.contacts(**once, oil=oil, temperature=temperature)
        films = solve_lines(contacts, nodes=model.nodes, profiles=False)
        share = np.where(films.solved, np.asarray(films.film.asperity_share), np.nan)
        shares[loaded] = share[film_of_contact.ravel()]
    return shares


@program
def _asked(at: Conditions) -> tuple[dict[str, Array], Array]:
    """What films ask of contacts, and which of these carry."""
    return {name: jnp.asarray(getattr(at, name)) for name in _ASKED}, at.contacts.active & (
        at.load > 0.0
    )
