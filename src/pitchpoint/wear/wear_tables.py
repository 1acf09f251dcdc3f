"""The tables [wear] and [worn] of a case file."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, PrivateAttr

from pitchpoint.gears.planetary import PLANETS
from pitchpoint.input.kinds import HARDNESS, MOST_STAGES, Flag, Text
from pitchpoint.input.quantities import Pair, Quantity, named
from pitchpoint.input.tables import Table
from pitchpoint.wear.wear_registry import WEAR_LAWS

__all__ = ["WEAR_LAND", "WearTable", "WornTable"]


WEAR_TURNS = Quantity("dimensionless", 0.0, 1e15, open_low=True)
WORN_TURNS = Quantity("dimensionless", 0.0, 1e15)
WORN_STAGE = Quantity("dimensionless", 1, MOST_STAGES, whole=True)
WEAR_COEFFICIENT = Quantity("dimensionless", 0.0, 1.0)
WEAR_RATE = Quantity("specific wear rate", 0.0, 1e-6, "mm3/(N m)")
WEAR_DEPTH = Quantity("length", 1e-8, 0.1, "um")
WEAR_LAND = Quantity("length", 0.0, 0.1, "mm")
WEAR_CELLS = Quantity("dimensionless", 8, 400, whole=True)
WEAR_PHASES = Quantity("dimensionless", 4, 400, whole=True)
WEAR_ERROR = Quantity("dimensionless", 1e-8, 0.1)
WEAR_PRESSURE = Quantity("dimensionless", 1.0, 1000.0, open_low=True)
ADSORPTION_HEAT = Quantity("molar energy", 0.0, 1e6, "kJ/mol")
MOLECULE = Quantity("length", 1e-11, 1e-7, "nm")
VIBRATION = Quantity("time", 1e-15, 1e-6, "s")


class WearTable(Table):
    """Wear of the flanks at the operating point, over the life of the drive.

    `cycles` are turns of the driver, of the meshes of a train those of its input. A `profile` that is
    "updated" gives worn flanks back to load sharing, pressure and film; one that is "kept" goes on as with
    new ones. The load on asperities is that of `models.asperity_load`, the "formula", or that of the solved
    "film". The march ends before at a limit of the depth, of the largest pressure over that at the start,
    of the thickness that is left of a tooth at its tip, or of the normal backlash that wear adds, and where
    the pressure reaches the hardness of the softer flank. `severe_by` names what tells that wear is severe.
    `cells` lie along each flank, `phases` are those between two events of the mesh cycle, and `tolerance` is
    the error of a step over the largest depth. Without `sensitivities` those of the life to all inputs are
    told where they take seconds: not of teeth on a ring that share their load by its stiffness.
    """

    law: Annotated[str, BeforeValidator(named(WEAR_LAWS.keys, "wear law"))]
    """Law of the specific wear rate."""
    cycles: Annotated[float, WEAR_TURNS]
    """Turns of the driver over which flanks wear."""
    coefficient: Annotated[tuple[float, float], Pair(WEAR_COEFFICIENT)] | None = None
    """Wear coefficient K of Archard's law, of dry sliding; 1e-5 unless given."""
    engagements: Annotated[tuple[float, float], Pair(PLANETS)] | None = None
    """Mates that wear the flanks in use of each gear alike; of a train the planets on what they mesh with."""
    hardness: Annotated[tuple[float, float], Pair(HARDNESS)] | None = None
    """Hardness H of the flanks; that of the materials unless given."""
    rate: Annotated[tuple[float, float], Pair(WEAR_RATE)] | None = None
    """Specific wear rate k of the flanks, for a law that takes it by value."""
    adsorption_heat: Annotated[float, ADSORPTION_HEAT] | None = None
    """Heat of adsorption E_a of the oil on the flanks; 49 kJ/mol unless given."""
    molecule_diameter: Annotated[float, MOLECULE] | None = None
    """Diameter X of an adsorbed molecule; 0.3 nm unless given."""
    vibration_period: Annotated[float, VIBRATION] | None = None
    """Period t_0 of vibration of an adsorbed molecule; 3e-12 s unless given."""
    profile: Literal["updated", "kept"] = "updated"
    """Whether load sharing, pressure and film follow the worn flanks, or stay as new."""
    load_ratio: Literal["formula", "film"] = "formula"
    """Where the load on asperities is from: models.asperity_load, or solved films."""
    depth_limit: Annotated[float, WEAR_DEPTH] | None = None
    """Depth at which the march ends; 0.2 modules of teeth, at the latest, unless given."""
    pressure_limit: Annotated[float, WEAR_PRESSURE] | None = None
    """Largest pressure over that at the start at which the march ends; none unless given."""
    tip_land_limit: Annotated[float, WEAR_LAND] | None = None
    """Tip thickness that is left where the march ends; none unless given."""
    backlash_limit: Annotated[float, WEAR_DEPTH] | None = None
    """Normal backlash that wear adds until the march ends; none unless given."""
    severe_by: Literal["rate", "pressure"] = "rate"
    """What tells severe wear: half as much again as the least rate, or as the first pressure."""
    cells: Annotated[float, WEAR_CELLS] = 40.0
    """Cells along each flank."""
    phases: Annotated[float, WEAR_PHASES] = 24.0
    """Phases between two events of the mesh cycle."""
    tolerance: Annotated[float, WEAR_ERROR] = 3e-4
    """Error of a step over the largest depth."""
    sensitivities: Flag | None = None
    """Whether to tell what the life depends on; where it takes seconds unless given."""


class WornTable(Table):
    """Flanks that are worn, from a result with wear of the same gears.

    `cycles` of the driver, of a set of its input, are those up to which they are worn; all that the result
    has by default. Of a result of several meshes that of the same gears counts.
    """

    file: Text
    """File wear.nc of a result with wear of the same gears, beside the case file."""
    cycles: Annotated[float, WORN_TURNS] | None = None
    """Turns of the driver up to which flanks are worn; all that the file has unless given."""
    stage: Annotated[float, WORN_STAGE] | None = None
    """Number of the stage of that result, where several of its stages have such gears."""
    _of_driver: float = PrivateAttr(default=1.0)

    @property
    def of_driver(self) -> float:
        """Turns of the driver for one of those that `cycles` counts."""
        return self._of_driver

    def counted(self, of_driver: float) -> "WornTable":
        """The same with `cycles` of the input of a train, for one of which the driver makes so many."""
        copied = self.model_copy()
        copied._of_driver = of_driver
        return copied
