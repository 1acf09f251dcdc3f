"""Name, symbol, unit and kind of every quantity that a result holds."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Any, Literal

__all__ = ["VARIABLES", "End", "Variable", "variable_of"]

End = Literal["driver", "loaded"]
"""One of the two members whose motion a drive passes on."""


@dataclass(frozen=True)
class Variable:
    """A quantity of a result: long name, symbol, SI unit, and unit and kind for display.

    Attributes:
        end: whose motion it counts in, None where it has nothing to do with one.
        travel: the quantity where that member travels.
    """

    long_name: str
    symbol: str
    unit: str
    shown: str = ""
    kind: str = "dimensionless"
    end: End | None = None
    travel: "Variable | None" = None

    @property
    def display(self) -> str:
        """Unit in which tables and figures show it."""
        return self.shown or self.unit

    def where(self, travels: Collection[End]) -> "Variable":
        """The quantity in a drive some of whose members travel."""
        return self.travel if self.travel is not None and self.end in travels else self


def _percent(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "1", "%")


def _torque(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "N m", "N m", "torque")


def _stiffness(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "N/m", "N/um", "stiffness")


def _deviation(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "m", "um", "length")


def _length(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "m", "mm", "length")


def _power(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "W", "W", "power")


def _force(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "N", "N", "force")


def _angle(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "rad", "deg", "angle")


def _speed(long_name: str, symbol: str) -> Variable:
    return Variable(long_name, symbol, "m/s", "m/s", "velocity")


VARIABLES: dict[str, Variable] = {
    "phase": Variable("phase of the mesh cycle", "φ", "1"),
    "weight": Variable("weight of the node in a mean over one period", "w", "1"),
    "path": Variable("position on the path of contact from A, in base pitches", "x/p_b", "1"),
    "active": Variable("pair in contact", "", "1"),
    "input_torque": _torque("input torque", "T_in"),
    "efficiency": _percent("instantaneous efficiency", "η"),
    "loss": _power("power loss", "P_loss"),
    "contact_force": Variable("normal force of the mesh", "F_n", "N", "N", "force"),
    "contact_force_ratio": Variable("contact force over that without friction", "β", "1"),
    "largest_contact_force_ratio": Variable(
        "largest contact force over that without friction", "β max", "1"
    ),
    "jamming_coefficient": Variable("friction coefficient at which the mesh locks", "μ lock", "1"),
    "largest_friction": Variable("largest friction coefficient of the contacts", "μ max", "1"),
    "nearest_friction": Variable(
        "friction coefficient where the mesh is nearest to locking", "μ", "1"
    ),
    "nearest_jamming_coefficient": Variable(
        "friction coefficient at which the mesh locks there", "μ lock", "1"
    ),
    "contact_line_length": _length("length of all contact lines together", "l"),
    "pitch_line_load": Variable(
        "tangential force at the base circle over the face width, F_bt/b",
        "F_bt/b",
        "N/m",
        "N/mm",
        "line load",
    ),
    "pitch_sum_speed": _speed("sum of the surface speeds at the pitch point", "v_ΣC"),
    "pitch_radius": _length("relative radius of curvature at the pitch point", "ρ_redC"),
    "circumferential_backlash": _deviation("backlash on the pitch circles", "j_wt"),
    "normal_backlash": _deviation("backlash along the normal", "j_bn"),
    "residual": Variable("relative residual of the torque balance", "", "1"),
    "load": Variable("normal force of the pair", "F", "N", "N", "force"),
    "load_share": Variable("share of the load", "λ", "1"),
    "friction": Variable("friction coefficient", "μ", "1"),
    "sliding_velocity": Variable("sliding velocity, signed", "v_s", "m/s", "m/s", "velocity"),
    "entrainment": Variable("entrainment velocity", "u", "m/s", "m/s", "velocity"),
    "slide_roll_ratio": Variable("slide-roll ratio", "SR", "1"),
    "pressure": Variable("largest Hertz pressure", "p_H", "Pa", "MPa", "pressure"),
    "film_thickness": Variable("film thickness", "h", "m", "um", "length"),
    "lambda_ratio": Variable("film thickness over composite Rq", "Λ", "1"),
    "sliding_loss": _power("sliding loss of the pair", "P_s"),
    "rolling_loss": _power("rolling loss of the pair", "P_r"),
    "drag_loss": _power("power loss beside the teeth", "P_drag"),
    "entered": Variable("base pitches since the pair entered", "ε_0", "1"),
    "line_length": _length("length of the contact line", "l_c"),
    "pair_stiffness": _stiffness("stiffness of the pair along the line of action", "k_i"),
    "mesh_stiffness": _stiffness("stiffness of the mesh along the line of action", "k_t"),
    "mean_stiffness": _stiffness("mean mesh stiffness", "k_m"),
    "stiffness_variation": _percent("variation of the mesh stiffness over its mean", "Δk/k_m"),
    "standard_single_stiffness": _stiffness("single stiffness by ISO 6336-1, c' b", "c' b"),
    "standard_stiffness": _stiffness("mesh stiffness by ISO 6336-1, c_γα b", "c_γα b"),
    "transmission_error": _deviation("dynamic transmission error", "δ"),
    "static_transmission_error": _deviation("static transmission error", "δ_s"),
    "mean_transmission_error": _deviation("mean transmission error", "δ mean"),
    "transmission_error_range": _deviation("transmission error, peak to peak", "Δδ"),
    "static_transmission_error_range": _deviation(
        "static transmission error, peak to peak", "Δδ_s"
    ),
    "transmission_error_rms": _deviation(
        "transmission error, root mean square about its mean", "δ rms"
    ),
    "separated_share": _percent("share of the period in which no pair carries", "t_0/T"),
    "mesh_dynamic_factor": Variable("force of all pairs over that without vibration", "F/F_0", "1"),
    "largest_mesh_dynamic_factor": Variable(
        "largest force of all pairs over that without vibration", "F/F_0 max", "1"
    ),
    "dynamic_factor": Variable("dynamic factor of the pair", "c_d", "1"),
    "largest_dynamic_factor": Variable("largest dynamic factor of a pair", "c_d max", "1"),
    "spectrum": _deviation("amplitude of the transmission error", "|δ_n|"),
    "natural_frequency": Variable("natural frequency", "f_n", "1/s", "Hz", "frequency"),
    "printed_undercut_limit_1": Variable(
        "smallest profile shift of gear 1, formula as printed", "x_min1", "1"
    ),
    "printed_equivalent_mass": Variable(
        "equivalent mass, formula as printed", "m_e", "kg", "g", "mass"
    ),
    "largest_tangential_load": Variable(
        "largest tangential load per face width and length of the ring",
        "q_t",
        "Pa",
        "MPa",
        "pressure",
    ),
    "largest_tooth_force": Variable("largest tooth force", "F_0", "N", "N", "force"),
    "one_zone_tooth_force": Variable(
        "largest tooth force if one zone carried all", "F_0", "N", "N", "force"
    ),
    "printed_largest_tooth_force": Variable(
        "largest tooth force, formula as printed", "F_0", "N", "N", "force"
    ),
    "printed_least_tooth_force": Variable(
        "least tooth force, formula as printed", "F_min", "N", "N", "force"
    ),
    "recovered_torque": _torque("torque that the tooth forces carry", "T"),
    "printed_recovered_torque": _torque(
        "torque that the tooth forces carry, formula as printed", "T"
    ),
    "tangent_angle": _angle("flank angle of the common tangent", "θ_B"),
    "tip_land": _length("thickness of the flexspline's tooth at its tip", "s_a"),
    "flank_length": _length("arc length of the flexspline's flank", "s"),
    "printed_sliding_distance": _length("sliding distance at the tip, formula as printed", "s_k"),
    "printed_closure_residual": _length("gap of the common tangent, formula as printed", "Δy"),
    "tooth_offset": _angle("turn of the outermost tooth by the oval ring", "u"),
    "largest_tooth_offset": _angle("largest turn of a tooth by the oval ring", "u"),
    "involute_tip_radius": _length("tip radius of the flexspline", "r_a"),
    "involute_root_radius": _length("root radius of the flexspline", "r_f"),
    "involute_pitch_thickness": _length("tooth thickness on the reference circle", "s"),
    "tooth_ratio": Variable("teeth of the flexspline over tooth difference", "i", "1"),
    "base_radius_flexspline": _length("base radius of the flexspline", "r_b1"),
    "base_radius_circular_spline": _length("base radius of the circular spline", "r_b2"),
    "printed_radius_root": Variable(
        "relative radius on the long axis, formula as printed", "R", "m", "m", "length"
    ),
    "printed_radius_10": Variable(
        "relative radius at 10 degrees, formula as printed", "R", "m", "m", "length"
    ),
    "printed_radius_end": Variable(
        "relative radius at the end of the zone, formula as printed", "R", "m", "m", "length"
    ),
    "conformal_angle": _angle("angle at which the printed radii of curvature agree", "φ"),
    "least_opposed_speed": _speed("least mesh point speed, tangential parts opposed", "u"),
    "largest_opposed_speed": _speed("largest mesh point speed, tangential parts opposed", "u"),
    "least_added_speed": _speed("least mesh point speed, tangential parts added", "u"),
    "largest_added_speed": _speed("largest mesh point speed, tangential parts added", "u"),
    "phase_rate": Variable("speed of the wave over the teeth over that of the driver", "φ'/ω", "1"),
    "deep_angle_first": _angle("least angle of the deep conjugate branch", "p"),
    "deep_angle_last": _angle("largest angle of the deep conjugate branch", "p"),
    "deep_radius_root": Variable(
        "relative radius on the deep branch at the root", "R", "m", "m", "length"
    ),
    "deep_radius_tip": Variable(
        "relative radius on the deep branch at the tip", "R", "m", "m", "length"
    ),
    "deep_entrainment_root": _speed("entrainment on the deep branch at the root", "u"),
    "deep_entrainment_tip": _speed("entrainment on the deep branch at the tip", "u"),
    "outer_angle_first": _angle("least angle of the outer conjugate branch", "p"),
    "outer_angle_last": _angle("largest angle of the outer conjugate branch", "p"),
    "outer_radius_least": _length("least relative radius on the outer branch, with its sign", "R"),
    "outer_radius_largest": _length(
        "largest relative radius on the outer branch, with its sign", "R"
    ),
    "outer_clearance_least": _deviation("least clearance on the outer branch", "g"),
    "clearance_between": _deviation("largest clearance between pairs that touch", "g"),
    "viscosity": Variable(
        "viscosity without pressure by Roelands' law", "η", "Pa s", "mPa s", "dynamic viscosity"
    ),
    "printed_viscosity": Variable(
        "viscosity without pressure, formula as printed", "η", "Pa s", "mPa s", "dynamic viscosity"
    ),
    "effective_modulus": Variable("equivalent modulus", "E'", "Pa", "GPa", "pressure"),
    "composite_roughness": _deviation("composite Rq", "σ"),
    "mesh_frequency": Variable("mesh frequency", "f_z", "1/s", "Hz", "frequency"),
    "equivalent_mass": Variable("equivalent mass", "m_e", "kg", "g", "mass"),
    "largest_multiplier": Variable("largest Floquet multiplier", "|Λ|", "1"),
    "vibration_status": Variable("status of the vibration", "", "1"),
    "radius": Variable("relative radius of curvature", "R", "m", "mm", "length"),
    "contact_ratio": Variable("total contact ratio", "ε_γ", "1"),
    "transverse_contact_ratio": Variable("transverse contact ratio", "ε_α", "1"),
    "overlap_ratio": Variable("overlap ratio", "ε_β", "1"),
    "flank_temperature_1": Variable(
        "flank temperature of gear 1", "θ_flank1", "K", "degC", "temperature"
    ),
    "root_temperature_1": Variable(
        "tooth root temperature of gear 1", "θ_root1", "K", "degC", "temperature"
    ),
    "young_1": Variable("Young's modulus of gear 1", "E1", "Pa", "GPa", "pressure"),
    "flank_temperature_2": Variable(
        "flank temperature of gear 2", "θ_flank2", "K", "degC", "temperature"
    ),
    "root_temperature_2": Variable(
        "tooth root temperature of gear 2", "θ_root2", "K", "degC", "temperature"
    ),
    "young_2": Variable("Young's modulus of gear 2", "E2", "Pa", "GPa", "pressure"),
    "module": _length("normal module", "m_n"),
    "centre_distance": _length("centre distance", "a"),
    "mounting_distance": _length(
        "distance from the pinion's axis to the rack's reference line", "a"
    ),
    "tip_alteration_1": Variable("tip alteration coefficient of gear 1", "k1", "1"),
    "tip_alteration_2": Variable("tip alteration coefficient of gear 2", "k2", "1"),
    "tip_thickness_1": _length("tip thickness of gear 1, normal section", "s_an1"),
    "tip_thickness_2": _length("tip thickness of gear 2, normal section", "s_an2"),
    "undercut_limit_1": Variable(
        "smallest profile shift of gear 1 without undercut", "x_min1", "1"
    ),
    "undercut_limit_2": Variable(
        "smallest profile shift of gear 2 without undercut", "x_min2", "1"
    ),
    "passing_angle": _angle("angle from the long axis", "p"),
    "clearance_angle": _angle("angle from the long axis", "p"),
    "rim_thickness": _length("thickness of the flexspline's rim", "t"),
    "tip_height": _length("radius at which the circular spline's teeth end", "r_a2"),
    "clearance": _deviation("clearance along the normal", "g"),
    "wind_up": Variable("wind-up of the loaded member", "Δθ", "rad", "arcmin", "angle"),
    "wind_up_range": Variable(
        "change of the wind-up with the phase", "Δθ range", "rad", "arcmin", "angle"
    ),
    "turn_angle": _angle("angle that is turned", "θ"),
    "kinematic_error": Variable("kinematic error", "Δφ", "rad", "arcsec", "angle"),
    "kinematic_error_spectrum": Variable(
        "amplitude of the kinematic error", "|Δφ_n|", "rad", "arcsec", "angle"
    ),
    "kinematic_error_range": Variable(
        "kinematic error, peak to peak", "Δφ range", "rad", "arcsec", "angle"
    ),
    "torsional_stiffness": Variable(
        "torsional stiffness", "K", "N m/rad", "kN m/rad", "torsional stiffness"
    ),
    "loaded_pairs": Variable("mean number of pairs that carry", "n", "1"),
    "zone_load": Variable("inward load on each end of the long axis", "F_r", "N", "N", "force"),
    "lost_motion": Variable(
        "play of the loaded member between its flanks without load",
        "Δθ_0",
        "rad",
        "arcmin",
        "angle",
    ),
    "angular_transmission_error": Variable(
        "rotation of the loaded member under load", "θ_e", "rad", "arcmin", "angle"
    ),
    "angular_transmission_error_range": Variable(
        "static transmission error at the loaded member, peak to peak",
        "Δθ_e",
        "rad",
        "arcsec",
        "angle",
    ),
    "mesh_torsional_stiffness": Variable(
        "torsional stiffness over the mesh cycle",
        "K(φ)",
        "N m/rad",
        "kN m/rad",
        "torsional stiffness",
    ),
    "tooth_force": Variable("normal force of the tooth", "F", "N", "N", "force"),
    "loading_torque": _torque("torque while the wind-up grows", "T"),
    "unloading_torque": _torque("torque while the wind-up shrinks", "T"),
    "speed_ratio": Variable("driver speed over that of the loaded member", "i", "1"),
    "deflection": _length("deflection of the flexspline on the long axis", "w_0"),
    "neutral_radius": _length("radius of the flexspline's neutral line", "r_m"),
    "engagement_depth": _length("depth by which the teeth reach into each other", "h_e"),
    "loss_factor": Variable("loss factor, equal sharing where all flanks touch", "H_V", "1"),
    "mean_loss": _power("mean power loss", "P_loss"),
    "radial_reaction_1": _force("mean radial load of the teeth on the bearings of gear 1", "F_r1"),
    "radial_reaction_2": _force("mean radial load of the teeth on the bearings of gear 2", "F_r2"),
    "axial_reaction_1": _force("mean axial load of the teeth on the bearings of gear 1", "F_a1"),
    "axial_reaction_2": _force("mean axial load of the teeth on the bearings of gear 2", "F_a2"),
    "bearing_load": _force("mean load on the bearing", "F_B"),
    "mean_drag_loss": _power("mean power loss beside the teeth", "P_drag mean"),
    "mean_efficiency": _percent("mean efficiency", "η mean"),
    "min_efficiency": _percent("smallest efficiency", "η min"),
    "max_efficiency": _percent("largest efficiency", "η max"),
    "efficiency_fluctuation": _percent("fluctuation of the efficiency", "Δη"),
    "mean_input_torque": _torque("mean input torque", "T_in mean"),
    "min_input_torque": _torque("smallest input torque", "T_in min"),
    "max_input_torque": _torque("largest input torque", "T_in max"),
    "torque_ripple": _torque("ripple of the input torque", "ΔT_in"),
    "no_load_torque": _torque("mean input torque without load", "T_0"),
    "starting_torque": _torque("input torque that starts the drive", "T_start"),
    "back_driving_torque": _torque("output torque that starts the drive backwards", "T_back"),
    "mean_friction": Variable("mean friction coefficient", "μ mean", "1"),
    "loss_factor_efficiency": _percent("efficiency by loss factor, 1 - μ H_V", "1 - μ H_V"),
    "iterations": Variable("iterations of the torque balance", "", "1"),
    "locked": Variable("friction locks the mesh", "", "1"),
    "torque": _torque("output torque", "T_out"),
    "speed": Variable("driver speed", "n", "rad/s", "rpm", "rotational speed"),
    "temperature": Variable("oil temperature", "θ", "K", "degC", "temperature"),
}

_IN_TRAVEL: dict[End, dict[str, Variable]] = {
    "driver": {
        "input_torque": _force("input force", "F_in"),
        "mean_input_torque": _force("mean input force", "F_in mean"),
        "min_input_torque": _force("smallest input force", "F_in min"),
        "max_input_torque": _force("largest input force", "F_in max"),
        "torque_ripple": _force("ripple of the input force", "ΔF_in"),
        "no_load_torque": _force("mean input force without load", "F_0"),
        "starting_torque": _force("input force that starts the drive", "F_start"),
        "speed": _speed("driver speed", "v"),
    },
    "loaded": {
        "torque": _force("output force", "F_out"),
        "back_driving_torque": _force("output force that starts the drive backwards", "F_back"),
        "loading_torque": _force("force while the deflection grows", "F"),
        "unloading_torque": _force("force while the deflection shrinks", "F"),
        "wind_up": _deviation("deflection of the loaded member", "Δs"),
        "wind_up_range": _deviation("change of the deflection with the phase", "Δs range"),
        "torsional_stiffness": _stiffness("stiffness at the output", "K"),
        "mesh_torsional_stiffness": _stiffness(
            "stiffness at the output over the mesh cycle", "K(φ)"
        ),
        "lost_motion": _deviation("play of the loaded member without load", "Δs_0"),
        "angular_transmission_error": _deviation("travel of the loaded member under load", "s_e"),
        "angular_transmission_error_range": _deviation(
            "static transmission error at the loaded member, peak to peak", "Δs_e"
        ),
        "kinematic_error": _deviation("kinematic error", "Δs"),
        "kinematic_error_spectrum": _deviation("amplitude of the kinematic error", "|Δs_n|"),
        "kinematic_error_range": _deviation("kinematic error, peak to peak", "Δs range"),
    },
}
"""Quantities of a member that travels."""

VARIABLES.update(
    (name, replace(VARIABLES[name], end=end, travel=travel))
    for end, own in _IN_TRAVEL.items()
    for name, travel in own.items()
)


def variable_of(data: Any, name: str) -> Variable:
    """The quantity of that name in a dataset, or none; of a member that travels where its unit says so."""
    known = VARIABLES[name]
    if known.travel is None or name not in data:
        return known
    return known.travel if data[name].attrs.get("units") == known.travel.unit else known
