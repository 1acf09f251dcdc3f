"""What a case may choose by name of solved films: heat, and asperities that touch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Integral
from typing import TYPE_CHECKING, Final

from pitchpoint.errors import InputError
from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array

__all__ = [
    "ASPERITIES",
    "COARSE",
    "FEWEST",
    "ISOTHERMAL",
    "MOST_LINE_NODES",
    "MOST_PATCH_NODES",
    "SMOOTH",
    "THERMAL",
    "USUAL_ASPERITIES",
    "AsperityLaw",
    "ThermalEffect",
    "coarser_count",
]

COARSE: Final = 0.03
"""Error by the grid from which on it is told."""

MOST_LINE_NODES: Final = 1025
"""Largest number of nodes across a line."""

MOST_PATCH_NODES: Final = 257
"""Largest number of nodes along a patch, whose memory grows with their square times that of the cells."""

ISOTHERMAL: Final = "isothermal"
"""Name of no heat: the film is as warm as its inlet everywhere."""


@dataclass(frozen=True, eq=False)
class ThermalEffect:
    """A named thermal effect of the film.

    Attributes:
        name: by which it is chosen.
        title: name to show.
        sources: keys of the bibliography.
        note: what it takes for granted.
    """

    name: str
    title: str
    sources: tuple[str, ...]
    note: str


THERMAL = Registry(
    "thermal effect of a film",
    ThermalEffect(
        ISOTHERMAL,
        "isothermal film",
        (),
        "The film is as warm as its inlet: traction of a contact that slides much comes out too high.",
    ),
    ThermalEffect(
        "mean_film",
        "mean temperature of the film, flash temperature of both surfaces",
        ("jaeger_1942", "johnson_1985"),
        "Steady; viscosity, density and shear stress are those at the mean temperature across the film. The "
        "flowing oil takes no heat along, compression makes none. Peclet numbers of both surfaces are above "
        "about 5; a slower surface conducts heat along itself too.",
    ),
)


SMOOTH = "none"
"""Name of no asperities: the surfaces count as smooth, whatever their roughness."""

USUAL_ASPERITIES: Final = "greenwood_tripp_1970"


@dataclass(frozen=True, eq=False)
class AsperityLaw:
    """A named law of the pressure that asperities carry, f(gap, Rq, E', constants) in SI."""

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""


ASPERITIES = Registry(
    "law of asperity pressure",
    AsperityLaw(
        "greenwood_tripp_1970",
        "Greenwood-Tripp",
        "pitchpoint.contact.asperities:greenwood_tripp_1970",
        ("greenwood_tripp_1970",),
    ),
    AsperityLaw(
        "hu_1994",
        "Greenwood-Tripp with the fit of its integral by Hu",
        "pitchpoint.lubrication.ehl.texture:fitted_pressure",
        ("greenwood_tripp_1970", "hu_1994"),
    ),
    AsperityLaw(
        "greenwood_williamson_1966",
        "Greenwood-Williamson",
        "pitchpoint.lubrication.ehl.texture:one_rough_side",
        ("greenwood_williamson_1966",),
    ),
)


FEWEST: Final = 33
"""Nodes of the coarsest grid."""


def coarser_count(nodes: int) -> int | None:
    """Nodes of the next coarser grid, None for the coarsest.

    Raises:
        InputError: not a number of nodes that a grid may have.
    """
    is_integer = isinstance(nodes, Integral)
    if not is_integer or nodes < FEWEST or (nodes - 1) & (nodes - 2):
        raise InputError(
            f"{nodes} nodes across a contact; their number is one more than a power of two, "
            f"{FEWEST}, 65, 129, 257, ..."
        )
    return None if nodes == FEWEST else nodes // 2 + 1
