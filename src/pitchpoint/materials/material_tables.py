"""The tables [materials], [lubricant] and [roughness] of a case file."""

from collections.abc import Iterable
from typing import Annotated

from pydantic import BeforeValidator, model_validator

from pitchpoint.errors import InputError
from pitchpoint.input.kinds import HARDNESS, TEMPERATURE, Text
from pitchpoint.input.quantities import Pair, Quantity, named
from pitchpoint.input.tables import Table
from pitchpoint.materials.data import base_names, oil_names, solid_names

__all__ = [
    "OF_SET",
    "DriveMaterials",
    "Materials",
    "Oil",
    "RoughnessTable",
    "SolidValues",
    "of_set",
]


MODULUS = Quantity("pressure", 1e6, 1e13, "GPa")
SOLID_CONDUCTIVITY = Quantity("thermal conductivity", 0.01, 1000.0, "W/m/K")
SPECIFIC_HEAT = Quantity("specific heat", 50.0, 5000.0, "J/kg/K")
POISSON = Quantity("dimensionless", 0.0, 0.5)
DENSITY = Quantity("density", 100.0, 30_000.0, "kg/m3")
SLOPE = Quantity("density slope", 0.0, 5.0, "kg/m3/K")
VISCOSITY = Quantity("kinematic viscosity", 2e-6, 0.1, "mm2/s")
COLD_VISCOSITY = Quantity("kinematic viscosity", 2e-6, 10.0, "mm2/s")
ALPHA = Quantity("pressure-viscosity coefficient", 1e-10, 1e-6, "1/GPa")
FACTOR = Quantity("dimensionless", 0.0, 10.0, open_low=True)
CONDUCTIVITY = Quantity("thermal conductivity", 0.01, 10.0, "W/m/K")
ROUGHNESS = Quantity("length", 0.0, 1e-4, "um")


class SolidValues(Table):
    """A material by value.

    Laws that ask for the hardness of its flanks, or for what conducts the heat of a contact, say so.
    """

    young: Annotated[float, MODULUS]
    """Young's modulus E."""
    poisson: Annotated[float, POISSON]
    """Poisson's ratio ν."""
    density: Annotated[float, DENSITY] = 7830.0
    """Density."""
    hardness: Annotated[float, HARDNESS] | None = None
    """Indentation hardness, as 200 HV, 200 HB or a pressure; for laws that ask for it."""
    conductivity: Annotated[float, SOLID_CONDUCTIVITY] | None = None
    """Thermal conductivity, for the heat of contacts; not known unless given."""
    specific_heat: Annotated[float, SPECIFIC_HEAT] | None = None
    """Specific heat, for the heat of contacts; not known unless given."""


SolidName = Annotated[str, BeforeValidator(named(solid_names, "material"))]


class Materials(Table):
    """Materials of both gears, by name or by value.

    Gear 1 of a strain wave gear is the flexspline, that of a ball on disc the disc.
    """

    gear_1: SolidValues | SolidName = "steel"
    """Material of gear 1, by name or by value."""
    gear_2: SolidValues | SolidName = "steel"
    """Material of gear 2, by name or by value."""


class DriveMaterials(Materials):
    """Materials of gears 1 and 2 of meshes, or of the gears of planetary sets, by name or by value.

    Where a set has one of its own, those that are left out are steel, and gear_1 and gear_2 are not its.
    """

    sun: SolidValues | SolidName | None = None
    """Material of the sun of a planetary set; as gears 1 and 2 unless a gear of the set has its own."""
    planet: SolidValues | SolidName | None = None
    """Material of the planets, of all their gears; see sun."""
    ring: SolidValues | SolidName | None = None
    """Material of the ring; see sun."""
    second_ring: SolidValues | SolidName | None = None
    """Material of the second ring of a 3K set; see sun."""

    @property
    def of_set(self) -> set[str]:
        """Keys that were given of gears of planetary sets."""
        return of_set(self.model_fields_set)


OF_SET = ("sun", "planet", "ring", "second_ring")
"""Keys of [materials] for gears of planetary sets."""


def of_set(keys: Iterable[str]) -> set[str]:
    """Keys of [materials] that are of gears of planetary sets."""
    return {*keys} & {*OF_SET}


class Oil(Table):
    """An oil of the catalogue, by value, or a catalogue oil with some values of one's own.

    With a thickener or a consistency (NLGI number) it is a grease, and the values are those of its base oil.
    With its viscosity at -40 degC it goes down to there, and between -40 and 40 degC its viscosity follows
    the line through that one and the one at 40 degC: it changes at 25 degC too.
    """

    name: Annotated[str, BeforeValidator(named(oil_names, "lubricant"))] | None = None
    """Oil of the catalogue; values beside it take the place of its own."""
    base: Annotated[str, BeforeValidator(named(base_names, "class of base oil"))] | None = None
    """Class of base oil, for what an oil by value leaves open; needed without a name."""
    viscosity_40: Annotated[float, VISCOSITY] | None = None
    """Kinematic viscosity at 40 degC; that of the named oil unless given, needed without one."""
    viscosity_100: Annotated[float, VISCOSITY] | None = None
    """Kinematic viscosity at 100 degC; that of the named oil unless given, needed without one."""
    viscosity_minus_40: Annotated[float, COLD_VISCOSITY] | None = None
    """Kinematic viscosity at -40 degC, down to which the oil then goes."""
    density: Annotated[float, DENSITY] | None = None
    """Density at 15 degC; that of the named oil, or usual for the base, unless given."""
    density_slope: Annotated[float, SLOPE] | None = None
    """Fall of the density per kelvin; that of the named oil, or usual for the base, unless given."""
    pressure_viscosity: Annotated[float, ALPHA] | None = None
    """Pressure-viscosity coefficient α_p at all temperatures; of oil or base unless given."""
    lubricant_factor: Annotated[float, FACTOR] | None = None
    """Lubricant factor X_L of mean friction laws; of the named oil or the base unless given."""
    conductivity: Annotated[float, CONDUCTIVITY] | None = None
    """Thermal conductivity of the oil; 0.14 W/m/K unless given."""
    temperature_min: Annotated[float, TEMPERATURE] | None = None
    """Lowest temperature of use; that of the named oil, by value 0 degC, unless given."""
    temperature_max: Annotated[float, TEMPERATURE] | None = None
    """Highest temperature of use; that of the named oil, by value 120 degC, unless given."""
    thickener: Text = ""
    """Thickener of a grease, in words; the other values are those of its base oil."""
    consistency: Text = ""
    """Consistency of a grease, its NLGI number as text."""

    @model_validator(mode="after")
    def _known(self) -> "Oil":
        if self.name is None and (self.viscosity_40 is None or self.viscosity_100 is None):
            raise InputError(
                "an oil needs a name of the catalogue, or viscosity_40 and viscosity_100 by value"
            )
        if self.name is None and self.base is None:
            raise InputError(
                f"an oil by value needs its base, one of {', '.join(base_names())}, for density, "
                "pressure-viscosity coefficient and lubricant factor where they are not given"
            )
        return self


class RoughnessTable(Table):
    """Roughness: Ra, Rq or both of one flank (taken for both) or of each, or the composite Rq.

    With both, each law takes its own; with one, the other follows for Gaussian heights.
    """

    ra: Annotated[tuple[float, float], Pair(ROUGHNESS)] | None = None
    """Arithmetic mean roughness Ra of the flanks; by rq, for Gaussian heights, unless given."""
    rq: Annotated[tuple[float, float], Pair(ROUGHNESS)] | None = None
    """Root mean square roughness Rq of the flanks; by ra, for Gaussian heights, unless given."""
    composite_rq: Annotated[float, ROUGHNESS] | None = None
    """Composite Rq of both flanks, sqrt(Rq1^2 + Rq2^2), in place of ra and rq."""

    @model_validator(mode="after")
    def _enough(self) -> "RoughnessTable":
        stated = [name for name in ("ra", "rq", "composite_rq") if getattr(self, name) is not None]
        if not stated or ("composite_rq" in stated and len(stated) > 1):
            raise InputError(
                f"{' and '.join(stated) or 'no roughness'} "
                f"{'were' if len(stated) > 1 else 'was'} given; give ra, rq or both (one flank or a list of "
                "two), or composite_rq alone"
            )
        for number, (ra, rq) in enumerate(zip(self.ra or (), self.rq or (), strict=False), 1):
            if rq < ra:
                raise InputError(
                    f"Rq of gear {number}, {ROUGHNESS.show(rq)}, is below its Ra, {ROUGHNESS.show(ra)}; "
                    "the root of the mean square is at least the mean",
                    key="rq",
                )
        return self
