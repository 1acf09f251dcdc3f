"""What a case may choose by name of wear: laws of the specific wear rate."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array

    from pitchpoint.contact.contacts import Shape

__all__ = ["WEAR_LAWS", "WearLaw"]


@dataclass(frozen=True, eq=False)
class WearLaw:
    """A named wear law; `function` gives the specific wear rate of one member [1/Pa].

    It holds for contacts of one `shape`, or of any (None). `ranges` are of its arguments in SI; empty where
    no source states any. The rate of a law that is `proportional` is the same at any load, speed and
    temperature, so that depth grows with the load times the way.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""
    shape: Shape | None = None
    proportional: bool = False
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def rivals(self) -> "list[WearLaw]":
        """Laws of the library."""
        return list(WEAR_LAWS.values())


WEAR_LAWS = Registry(
    "wear law",
    WearLaw(
        "archard_1953",
        "Archard, dry",
        "pitchpoint.wear.laws:archard_1953",
        ("archard_1953", "zhao_2022"),
        "The coefficient is of the pair of materials; recalled values of dry metals are 1e-6 to 1e-4.",
        proportional=True,
    ),
    WearLaw(
        "masjedi_khonsari_2015",
        "Masjedi-Khonsari, mixed lubrication",
        "pitchpoint.wear.laws:masjedi_khonsari_2015",
        ("masjedi_khonsari_2015", "zhao_2022"),
        "Archard's dry coefficient on the part of the load that asperities carry, where the adsorbed film "
        "has defects. The heat of adsorption decides about orders of magnitude.",
    ),
    WearLaw(
        "janakiraman_2013",
        "Janakiraman, lubricated steel rollers",
        "pitchpoint.wear.laws:janakiraman_2013",
        ("janakiraman_2013", "zhao_2022"),
        "Contains hardness and lubrication. The range of its tests is not printed in what was at hand, so "
        "that nothing can say where it is left; between pressure-viscosity coefficients of 25 and 15 1/GPa "
        "it changes by a factor of 43.",
        "line",
    ),
    WearLaw(
        "vdi_2736",
        "specific wear rate by value, VDI 2736",
        "pitchpoint.wear.laws:vdi_2736",
        ("vdi_2736_2_2014", "tkuhn39_2026"),
        "Of plastics; the guideline has it with the mean depth over the flank.",
        proportional=True,
    ),
)
