"""What a case may choose by name beside its teeth, and of their temperature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array

    from pitchpoint.efficiency.tooth_temperature import ToothTemperature

__all__ = ["BEARING_LOSS", "BREAKAWAY", "TOOTH_TEMPERATURE", "DragModel", "ThermalModel"]


@dataclass(frozen=True, eq=False)
class DragModel:
    """A named model of a torque between two bodies, in motion or at rest.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: torque [N m], not negative, from the keywords that all models of its registry take and
            from the factors of the model.
        factors: names of the further keywords, which the case gives for each place.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    factors: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    note: str = ""


BEARING_LOSS = Registry(
    "bearing loss model",
    DragModel("none", "bearings without friction", "pitchpoint.efficiency.bearing_loss:none"),
    DragModel(
        "palmgren_1959",
        "torque of the lubricant with (viscosity times speed)^(2/3), torque in proportion to the load",
        "pitchpoint.efficiency.bearing_loss:palmgren_1959",
        ("f0", "f1"),
        ("palmgren_1959",),
        "Rolling bearings without contact seals; f0 and f1 are those of the bearing's maker.",
    ),
)
"""Models of the friction torque of a rolling bearing: keywords `speed` [rad/s], `load` [N],
`kinematic_viscosity` [m2/s], `mean_diameter` [m] and the factors, which a maker's catalogue gives."""


BREAKAWAY = Registry(
    "breakaway model",
    DragModel(
        "none", "nothing beyond the friction in motion", "pitchpoint.efficiency.breakaway:none"
    ),
    DragModel(
        "dry_and_viscous",
        "square of the diameter times a dry part, with the preload, and one with viscosity^(2/3)",
        "pitchpoint.efficiency.breakaway:dry_and_viscous",
        ("dry", "viscous", "preload"),
        (),
        "No published law: growth with the size as starting torques of catalogues show it, the power of "
        "the viscosity as in Palmgren's law. The cold stiffening of a grease is left out.",
    ),
)
"""Models of the torque at which bodies begin to turn against each other: keywords `mean_diameter` [m],
`kinematic_viscosity` [m2/s] and the factors of the model."""


@dataclass(frozen=True, eq=False)
class ThermalModel:
    """A named model of tooth temperature; `function` gives flank and root in K."""

    name: str
    title: str
    function: Deferred[Callable[..., ToothTemperature]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""


TOOTH_TEMPERATURE = Registry(
    "thermal model",
    ThermalModel(
        "isothermal",
        "teeth at the temperature of their surroundings",
        "pitchpoint.efficiency.tooth_temperature:isothermal",
    ),
    ThermalModel(
        "vdi_2736_2",
        "flank and root temperature of a plastic gear",
        "pitchpoint.efficiency.tooth_temperature:vdi_2736_2",
        ("vdi_2736_2_2014", "fernandes_2022", "tkuhn39_2026"),
        "Plastic gears against steel or plastic in steady running; the guideline was not at hand, "
        "z is the gear's own number of teeth.",
    ),
)
