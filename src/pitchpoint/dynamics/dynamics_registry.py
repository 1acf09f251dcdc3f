"""What a case may choose by name of teeth in motion: whether they part."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array, Float

__all__ = ["CONTACT_LAWS", "ContactLaw"]


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
    function: Deferred[
        Callable[
            [Float[Array, "*b"], Float[Array, ""]], tuple[Float[Array, "*b"], Float[Array, "*b"]]
        ]
    ] = Deferred()
    linear: bool = False
    sources: tuple[str, ...] = ()
    note: str = ""


CONTACT_LAWS = Registry(
    "contact law",
    ContactLaw(
        "linear", "teeth never part", "pitchpoint.dynamics.contact_law:linear_contact", linear=True
    ),
    ContactLaw(
        "separating",
        "teeth may part, and meet their back flanks beyond the backlash",
        "pitchpoint.dynamics.contact_law:separating_contact",
    ),
)
