"""What a case may choose of contacts by name: ellipses by load, ends of lines, summits of roughness."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from inspect import signature
from typing import TYPE_CHECKING

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from pitchpoint.contact.ellipse import Ellipse
    from pitchpoint.contact.surface import Surface

__all__ = [
    "ELLIPTIC_CONTACT",
    "END_PROFILES",
    "SUMMITS",
    "USUAL_ELLIPSE",
    "USUAL_SUMMITS",
    "EllipticContact",
    "EndProfile",
    "SummitConstants",
]


@dataclass(frozen=True, eq=False)
class EllipticContact:
    """A named way to an elliptic contact.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: the contact from load, radius, transverse radius and modulus.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Ellipse]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""


USUAL_ELLIPSE = "hertz_1881"
"""Name of what is taken where nothing else is said."""


ELLIPTIC_CONTACT = Registry(
    "elliptic contact",
    EllipticContact(
        USUAL_ELLIPSE,
        "elliptic integrals, as Hertz has them",
        "pitchpoint.contact.ellipse:hertz_1881",
        ("johnson_1985", "carlson_1995"),
    ),
    EllipticContact(
        "hamrock_brewe_1983",
        "powers of the ratio of radii in the place of elliptic integrals",
        "pitchpoint.contact.ellipse:hamrock_brewe_1983",
        ("hamrock_brewe_1983",),
        "Pressure within 3 % of Hertz and approach within 5 % for ratios of radii from 0.01 to 100.",
    ),
)


@dataclass(frozen=True, eq=False)
class EndProfile:
    """A named shape of the ends of a contact line.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: surfaces from the width of the face and its own numbers.
        sources: keys of the bibliography.
    """

    name: str
    title: str
    function: Deferred[Callable[..., tuple[Surface, ...]]] = Deferred()
    sources: tuple[str, ...] = ()

    @property
    def parameters(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of its own numbers that have to be given, and of all that may be."""
        numbers = [
            parameter
            for parameter in signature(self.function).parameters.values()
            if parameter.name not in ("width", "modulus")
        ]
        needed = tuple(
            parameter.name for parameter in numbers if parameter.default is parameter.empty
        )
        return needed, tuple(parameter.name for parameter in numbers)

    def of_face(self, width: float, modulus: float) -> dict[str, float]:
        """What the function asks for beside its own numbers [m, Pa]: the modulus where a load decides."""
        of_face = {"width": width, "modulus": modulus}
        return {
            name: of_face[name] for name in signature(self.function).parameters if name in of_face
        }


END_PROFILES = Registry(
    "end profile",
    EndProfile("straight", "no relief", "pitchpoint.contact.end_profiles:straight"),
    EndProfile("crowned", "an arc over the whole face", "pitchpoint.contact.end_profiles:crowned"),
    EndProfile(
        "chamfered", "a flat bevel at both ends", "pitchpoint.contact.end_profiles:chamfered"
    ),
    EndProfile(
        "dub_off",
        "an arc at both ends, tangent to the face",
        "pitchpoint.contact.end_profiles:dub_off",
    ),
    EndProfile(
        "log_relieved",
        "a logarithm for an even pressure",
        "pitchpoint.contact.end_profiles:log_relieved",
        ("lundberg_1939",),
    ),
)
"""What contact lines may end with."""


@dataclass(frozen=True, eq=False)
class SummitConstants:
    """A named set of the constants of rough surfaces that decide how much asperities carry.

    Attributes:
        name, title: by which it is picked, and what it says.
        eta_beta_sigma: summits per area times their radius times Rq [1].
        sigma_over_beta: Rq over the radius of summits [1].
        sources: keys of the bibliography.
        note: what it rests on.
    """

    name: str
    title: str
    eta_beta_sigma: float
    sigma_over_beta: float
    sources: tuple[str, ...] = ()
    note: str = ""


USUAL_SUMMITS = "textbooks"
"""Name of what is taken where nothing else is said."""


SUMMITS = Registry(
    "set of constants of summits",
    SummitConstants(
        USUAL_SUMMITS,
        "constants of textbooks",
        0.05,
        0.01,
        ("greenwood_tripp_1970",),
        "Assumed: the upper ends of 0.03 to 0.05 and of 1e-4 to 1e-2.",
    ),
    SummitConstants(
        "masjedi_khonsari_2012",
        "constants that follow Masjedi and Khonsari's regression",
        0.18,
        0.01,
        ("greenwood_tripp_1970", "masjedi_khonsari_2012"),
        "Assumed: with them Greenwood and Tripp's pressure carries as the regression, another calculation, "
        "has it, within 1.4 where smooth surfaces would have a film of 0.02 to 0.7 Rq.",
    ),
)
"""Sets that stand for no measured surface: between them asperities become 13 times as stiff."""
