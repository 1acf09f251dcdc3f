"""The tables [formulas] of the case: what its wear takes beside gears, torque and speed."""

from typing import Annotated, Literal

from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import Table

__all__ = ["ConjugateWear", "FlankWear", "StatedContact"]

COEFFICIENT = Quantity("dimensionless", 0.0, 1.0, open_low=True)
HARDNESS = Quantity("pressure", 1e7, 1e11, "MPa")
CYCLES = Quantity("dimensionless", 1.0, 1e13)
POINTS = Quantity("dimensionless", 4, 400, whole=True)
LENGTH = Quantity("dimensionless", 0.1, 3.0)
DEPTH = Quantity("dimensionless", 0.0, 3.0, open_low=True)
HEAT = Quantity("molar energy", 0.0, 1e6, "kJ/mol")
SIZE = Quantity("length", 1e-11, 1e-8, "nm")
PERIOD = Quantity("time", 1e-15, 1e-9, "s")
FRICTION = Quantity("dimensionless", 0.0, 2.0)
CONDUCTIVITY = Quantity("thermal conductivity", 0.01, 1000.0, "W/m/K")
SPECIFIC_HEAT = Quantity("specific heat", 50.0, 5000.0, "J/kg/K")
LINE_LOAD = Quantity("line load", 1.0, 1e8, "N/m")
SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
TEMPERATURE = Quantity("temperature", 173.15, 573.15, "degC")
ROUGHNESS = Quantity("length", 1e-9, 1e-4, "um")
MODULUS = Quantity("pressure", 1e8, 1e12, "GPa")
VISCOSITY = Quantity("dynamic viscosity", 1e-5, 1e4, "mPa s")
PRESSURE_VISCOSITY = Quantity("pressure-viscosity coefficient", 1e-10, 1e-7, "1/GPa")
RADIUS = Quantity("length", 1e-6, 10.0, "mm")
RATE = Quantity("specific wear rate", 0.0, 1.0, "1/Pa", open_low=True)


class StatedContact(Table):
    """Contact for which the coefficient is stated; eqs. 9, 10 and 29 to 31 carry it to others."""

    line_load: Annotated[float, LINE_LOAD]
    """Load W' per face width."""
    speed: Annotated[float, SPEED]
    """Speed of the wave generator."""
    temperature: Annotated[float, TEMPERATURE]
    """Temperature of the oil."""
    roughness: Annotated[float, ROUGHNESS]
    """Composite roughness R_c."""
    modulus: Annotated[float, MODULUS]
    """Equivalent modulus E', 2/E' = sum of (1 - nu^2)/E."""
    viscosity: Annotated[float, VISCOSITY]
    """Viscosity of the oil."""
    pressure_viscosity: Annotated[float, PRESSURE_VISCOSITY]
    """Pressure-viscosity coefficient α of the oil."""
    hardness: Annotated[float, HARDNESS]
    """Hardness of the flank."""


class FlankWear(Table):
    """Wear of the flexspline's flank by the discrete model of eqs. 11 to 33."""

    form: Literal["wear"] = "wear"
    """Equations that take these inputs: the discrete model of flank wear by Zhao et al."""
    coefficient: Annotated[float, COEFFICIENT]
    """K ψ L_a / 100 of eq. 11 at the reference, held through all cycles."""
    reference: StatedContact
    """Contact for which the coefficient is stated."""
    coefficient_load: Literal["reference", "case"] = "reference"
    """Load in eqs. 9, 10 and 29: that of the reference whatever the torque, or that of the case."""
    equivalent_radius: Annotated[float, RADIUS]
    """Radius R' of eqs. 9 and 30."""
    hardness: Annotated[float, HARDNESS]
    """Hardness H of the flank."""
    cycles: Annotated[float, CYCLES]
    """Cycles after which depths are told."""
    points: Annotated[float, POINTS]
    """Points of the flank, one pitch step apart in the paper."""
    flank_length: Annotated[float, LENGTH]
    """Length of the flank over which the points lie, from the tip, in modules."""
    severe_depth: Annotated[float, DEPTH]
    """Depth at which wear is severe unless the tip land is gone before, in modules."""
    area: Literal["strip", "new strip", "cumulative"] = "strip"
    """Area under a point: its strip of the worn or of the new flank, or all from the tip on, eq. 26."""
    offset: Literal["mean", "none"] = "mean"
    """Offset of the mesh by the oval ring, eq. 28: the mean of both sides, or none."""
    adsorption_heat: Annotated[float, HEAT]
    """Heat of adsorption E_a of eq. 10."""
    molecule: Annotated[float, SIZE]
    """Diameter α_x of an adsorbed molecule."""
    vibration_period: Annotated[float, PERIOD]
    """Period t_0 of vibration of an adsorbed molecule."""
    friction: Annotated[float, FRICTION]
    """Friction coefficient of the heat that warms the contacts, T_s of eq. 10."""
    conductivity: Annotated[float, CONDUCTIVITY]
    """Thermal conductivity of the flank that the heat flows into."""
    specific_heat: Annotated[float, SPECIFIC_HEAT]
    """Specific heat of the flank that the heat flows into."""


class ConjugateWear(Table):
    """Wear of the flexspline's flank by the kinematics of its envelope, with loads by the closed cosine."""

    form: Literal["conjugate wear"] = "conjugate wear"
    """Equations that take these inputs: wear by the kinematics of the envelope."""
    rate: Annotated[float, RATE]
    """Specific wear rate k."""
    cycles: Annotated[float, CYCLES]
    """Cycles after which depths are told."""
