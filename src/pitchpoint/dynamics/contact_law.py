"""Force between two teeth from their stretch: the named models of contact and separation."""

from collections.abc import Callable
from dataclasses import dataclass

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.registry import Registry

__all__ = ["CONTACT_LAWS", "ContactLaw", "linear", "separating"]

Each = Float[Array, "*b"]


@dataclass(frozen=True)
class ContactLaw:
    """One way in which teeth push on each other.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: force over stiffness, and its derivative, from stretch and backlash.
        linear: True where one solution of a linear system is the answer.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    function: Callable[[Each, Float[Array, ""]], tuple[Each, Each]]
    linear: bool = False
    sources: tuple[str, ...] = ()
    note: str = ""


def linear(stretch: Each, backlash: Float[Array, ""]) -> tuple[Each, Each]:
    """Teeth never part: the force follows the stretch, pulling where it is negative.

    Args:
        stretch: arm times coordinates less profile error, positive where flanks press [m].
        backlash: not used, common to all laws.

    Source: Atanasiu et al. (2011), eq. 11.
    """
    return stretch, jnp.ones_like(stretch)


def separating(stretch: Each, backlash: Float[Array, ""]) -> tuple[Each, Each]:
    """Teeth part where the stretch is negative, and meet their back flanks beyond the backlash.

    Args:
        stretch: arm times coordinates less profile error, positive where flanks press [m].
        backlash: free motion along the normal before the back flanks touch [m]; infinite if never.

    Source: Kahraman and Singh (1990), a spring with a clearance, counted from the front flank.
    """
    behind = -stretch - backlash
    back = jnp.where(behind > 0.0, jnp.where(jnp.isfinite(behind), behind, 0.0), 0.0)
    touching = (stretch > 0.0) | (behind > 0.0)
    return jnp.maximum(stretch, 0.0) - back, jnp.where(touching, 1.0, 0.0)


CONTACT_LAWS = Registry(
    "contact law",
    ContactLaw("linear", "teeth never part", linear, linear=True),
    ContactLaw(
        "separating", "teeth may part, and meet their back flanks beyond the backlash", separating
    ),
)
