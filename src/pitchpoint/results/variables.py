"""Name, symbol, unit and kind of every quantity that a result holds."""

from dataclasses import replace
from typing import Any

from pitchpoint import units
from pitchpoint.results.strength import EXTREMES, STRENGTH
from pitchpoint.results.variable import (
    End,
    Variable,
    angle,
    deviation,
    energy,
    force,
    length,
    percent,
    power,
    pressure,
    speed,
    stiffness,
    temperature_rise,
    torque,
    torsional_stiffness,
)

__all__ = ["SWEEP_AXIS", "VARIABLES", "places_of", "variable_of"]

SWEEP_AXIS = "axis"
"""Values of the key of a sweep, in a study that has one."""

VARIABLES: dict[str, Variable] = {
    **STRENGTH,
    **EXTREMES,
    "phase": Variable("phase of the mesh cycle", "φ", "1"),
    "weight": Variable("weight of the node in a mean over one period", "w", "1"),
    "driver_angle": angle("angle of the driving body", "φ_in"),
    "path": Variable("position on the path of contact from A, in base pitches", "x/p_b", "1"),
    "active": Variable("pair in contact", "", "1"),
    "input_torque": torque("input torque", "T_in"),
    "efficiency": percent("instantaneous efficiency", "η"),
    "loss": power("power loss", "P_loss"),
    "contact_force": Variable("normal force of the mesh", "F_n", "N", "N", "force"),
    "contact_force_ratio": Variable("contact force over that without friction", "β", "1"),
    "largest_contact_force_ratio": Variable(
        "largest contact force over that without friction", "β max", "1"
    ),
    "jamming_coefficient": Variable("friction coefficient at which the mesh locks", "μ lock", "1"),
    "largest_friction": Variable("largest friction coefficient of the contacts", "μ max", "1"),
    "turns": Variable("turns of films and forces", "n", "1"),
    "turns_change": Variable("change of the friction coefficient in the last turn", "Δμ/μ", "1"),
    "nearest_friction": Variable(
        "friction coefficient where the mesh is nearest to locking", "μ", "1"
    ),
    "nearest_jamming_coefficient": Variable(
        "friction coefficient at which the mesh locks there", "μ lock", "1"
    ),
    "contact_line_length": length("length of all contact lines together", "l"),
    "pitch_line_load": Variable(
        "tangential force at the base circle over the face width, F_bt/b",
        "F_bt/b",
        "N/m",
        "N/mm",
        "line load",
    ),
    "pitch_sum_speed": speed("sum of the surface speeds at the pitch point", "v_ΣC"),
    "pitch_radius": length("relative radius of curvature at the pitch point", "ρ_redC"),
    "circumferential_backlash": deviation("nominal backlash on the pitch circles", "j_wt"),
    "normal_backlash": deviation("nominal backlash along the normal", "j_bn"),
    "backlash_on_circle": deviation("backlash on the pitch circles by tolerances", "j_wt"),
    "backlash_along_normal": deviation("backlash along the normal by tolerances", "j_bn"),
    "backlash_angle": Variable(
        "turn of a gear in its backlash, the other one held", "j_θ", "rad", "arcmin", "angle"
    ),
    "normal_thickness": length("tooth thickness on the reference cylinder", "s_n"),
    "span_teeth": Variable("teeth under a span", "k", "1"),
    "span_measurement": length("span measurement", "W_k"),
    "span_diameter": length("diameter on which a span touches", "d_W"),
    "ball_diameter": length("diameter of the measuring balls", "D_M"),
    "over_balls": length("dimension over balls", "M_d"),
    "ball_contact_diameter": length("diameter on which the balls touch", "d_K"),
    "pin_error": Variable("way by which a pin is ahead along its circle", "e", "m", "um", "length"),
    "pin_force": force("force of a planet on its pin along the circle", "F_pin"),
    "body_thrust": force("axial force of the teeth on a body, one planet", "F_a"),
    "planet_tilting_moment": Variable(
        "moment of the axial forces that tilts a planet", "M_p", "N m", "N m", "torque"
    ),
    "planet_share": Variable("load of a planet over that of an equal share", "F/F_mean", "1"),
    "planet_load_factor": Variable("mesh load factor by the errors of the pins", "K_γ", "1"),
    "drawn_planet_load_factor": Variable("mesh load factor of sets by tolerance", "K_γ", "1"),
    "planet_stiffness": stiffness("stiffness of the way over one planet along its circle", "k_p"),
    "disc_mass": Variable("mass of a gear as a disc", "m", "kg", "kg", "mass"),
    "disc_inertia": Variable(
        "moment of inertia of a gear as a disc", "J", "kg m2", "kg cm2", "moment of inertia"
    ),
    "body_mass": Variable("mass of a body", "m", "kg", "kg", "mass"),
    "body_inertia": Variable(
        "moment of inertia of a body about its axis", "J", "kg m2", "kg cm2", "moment of inertia"
    ),
    "reflected_part": Variable(
        "moment of inertia of a body as it is felt at an end of the drive",
        "J_red,i",
        "kg m2",
        "kg cm2",
        "moment of inertia",
    ),
    "reflected_inertia": Variable(
        "moment of inertia of the drive as it is felt at its end",
        "J_red",
        "kg m2",
        "kg cm2",
        "moment of inertia",
    ),
    "drive_mass": Variable("mass of all bodies of the drive", "m", "kg", "kg", "mass"),
    "output_backlash": Variable(
        "turn of the output in the backlash of all stages, the input held",
        "j_θ",
        "rad",
        "arcmin",
        "angle",
    ),
    "bending_strain": Variable("largest strain by which the wave bends", "ε_b", "1"),
    "bending_amplitude": pressure("alternating bending stress of the flexspline", "σ_b"),
    "alternating_stress": pressure("alternating equivalent stress of the flexspline", "σ_a"),
    "mean_bending_stress": pressure("mean bending stress of the flexspline", "σ_b0"),
    "torsional_stress": pressure("shear stress of the flexspline by its torque", "τ"),
    "mean_stress": pressure("mean equivalent stress of the flexspline", "σ_m"),
    "goodman_safety": Variable("safety of the flexspline by the Goodman line", "S", "1"),
    "goodman_torque": torque("torque at which that safety is one", "T_S=1"),
    "flexspline_torque": torque("torque on the flexspline, without losses", "T_F"),
    "limit_torque": torque("torque of a maker, at this size", "T_limit"),
    "limit_margin": Variable("that torque over the one on the flexspline", "T_limit/T_F", "1"),
    "bearing_life": Variable(
        "life of the bearing by its rating, with 90 % unharmed", "L", "s", "h", "time"
    ),
    "operating_bearing_life": Variable(
        "life of the bearing at the operating point", "L", "s", "h", "time"
    ),
    "flank_tolerance": deviation("tolerance of the flanks by ISO 1328-1", "T"),
    "residual": Variable("relative residual of the torque balance", "", "1"),
    "load": Variable("normal force of the pair", "F", "N", "N", "force"),
    "load_share": Variable("share of the load", "λ", "1"),
    "friction": Variable("friction coefficient", "μ", "1"),
    "sliding_velocity": Variable("sliding velocity, signed", "v_s", "m/s", "m/s", "velocity"),
    "entrainment": Variable("entrainment velocity", "u", "m/s", "m/s", "velocity"),
    "slide_roll_ratio": Variable("slide-roll ratio", "SR", "1"),
    "pressure": pressure("largest Hertz pressure", "p_H"),
    "semi_axis_along": length("semi-axis of the contact in the rolling direction", "b"),
    "semi_axis_across": length("semi-axis of the contact across the rolling direction", "a"),
    "film_thickness": Variable("film thickness", "h", "m", "um", "length"),
    "lambda_ratio": Variable("film thickness over composite Rq", "Λ", "1"),
    "min_lambda_ratio": Variable("smallest film over composite Rq", "Λ min", "1"),
    "asperity_load_ratio": percent("part of the load on asperities", "L_a"),
    "central_film": Variable(
        "film in the middle of the contact, solved", "h_c", "m", "um", "length"
    ),
    "minimum_film": Variable("smallest film of the contact, solved", "h_min", "m", "um", "length"),
    "minimum_lambda": Variable("smallest film over composite Rq, solved", "Λ_min", "1"),
    "film_pressure": pressure("largest pressure of the film, solved", "p_max"),
    "asperity_share": percent("part of the load on asperities, solved", "L_a"),
    "mean_film": deviation("mean film of the contact, weighed by its dry pressure", "h_m"),
    "row_film": deviation("smallest film of the row in the middle of a line", "h_row"),
    "minimum_place": length("place of the smallest film, along and across", "x, y"),
    "largest_place": length("place of the largest pressure, along and across", "x, y"),
    "near_ends": pressure("largest pressure at a distance from the end of the line", "p_e"),
    "distance": Variable("distance from the end of the line, in half-widths", "s/b", "1"),
    "dry_pressure": pressure("largest pressure of the dry contact, but for its ends", "p_H"),
    "dry_half_width": length("half-width of the dry contact", "b"),
    "film_inlet": length("distance before the contact at which its oil begins", "x_in"),
    "film_defect": Variable("defect of the film, over the pressure of the dry contact", "", "1"),
    "line_central_film": deviation("film in the middle of a line without ends", "h_c"),
    "line_minimum_film": deviation("smallest film of a line without ends", "h_min"),
    "line_friction": Variable("friction coefficient of a line without ends", "μ_line", "1"),
    "line_loss": power("loss of a line without ends", "P_line"),
    "mean_line_friction": Variable(
        "mean friction coefficient by lines without ends", "μ_line", "1"
    ),
    "mean_line_loss": power("mean loss of the contacts by lines without ends", "P_line"),
    "kept_x": length("place along the contact", "x"),
    "kept_y": length("place across the contact", "y"),
    "field_pressure": pressure("pressure", "p"),
    "field_asperity_pressure": pressure("pressure that asperities carry", "p_a"),
    "field_dry_pressure": pressure("pressure without oil", "p_d"),
    "field_film": deviation("film", "h"),
    "field_rise": temperature_rise("mean temperature of the film above its inlet", "ΔT_film"),
    **{
        f"field_surface_rise_{body}": temperature_rise(
            f"temperature of the surface of body {body} above the inlet of the film", f"ΔT_{body}"
        )
        for body in (1, 2)
    },
    "field_heights": deviation("heights of both surfaces that the cells see", "z"),
    "coarse_central_film": deviation("film in the middle on a coarser grid", "h_c"),
    "coarse_minimum_film": deviation("smallest film on a coarser grid", "h_min"),
    "coarse_largest_pressure": pressure("largest pressure on a coarser grid", "p_max"),
    "coarse_near_ends": pressure("pressure near the ends on a coarser grid", "p_e"),
    "coarse_friction": Variable("friction coefficient on a coarser grid", "μ", "1"),
    "film_rise": temperature_rise(
        "largest temperature of the film above its inlet, solved", "ΔT_film"
    ),
    "flash_rise": temperature_rise("flash temperature of the warmer surface, solved", "ΔT_flash"),
    "film_friction": Variable("friction coefficient of the film, solved", "μ_EHL", "1"),
    "boundary_part": Variable("friction coefficient by asperities that touch, solved", "μ_b", "1"),
    "rolling_resistance": force("rolling resistance of each surface, solved", "F_roll"),
    "film_sliding_loss": power("sliding loss of the pair by its film", "P_s"),
    "film_rolling_loss": power("rolling loss of the pair by its film", "P_r"),
    "film_stiffness": stiffness("stiffness of the film", "k_film"),
    "film_damping": Variable(
        "squeeze damping of the film", "c_film", "N s/m", "N s/m", "viscous damping"
    ),
    "film_torsional_stiffness": torsional_stiffness(
        "torsional stiffness of the films alone", "K_film"
    ),
    "stiffness_without_films": torsional_stiffness(
        "slope of torque over wind-up without films", "K"
    ),
    "stiffness_with_films": torsional_stiffness(
        "slope of torque over wind-up, films in series", "K'"
    ),
    "film_status": Variable("status of the film", "", "1"),
    "film_by_law": Variable("film thickness by regression", "h", "m", "um", "length"),
    "film_loss": power("loss of the contacts by their films", "P_EHL"),
    "law_loss": power("loss of the contacts by the friction law", "P_law"),
    "profile_place": length("place across the contact", "x"),
    "profile_film": Variable("film across the contact", "h", "m", "um", "length"),
    "profile_pressure": pressure("pressure across the contact", "p"),
    "profile_asperity_pressure": pressure("pressure that asperities carry", "p_a"),
    "profile_half_width": length("half-width of the dry contact", "b"),
    "profile_rise": temperature_rise("mean temperature of the film above its inlet", "ΔT_film"),
    **{
        f"profile_surface_rise_{body}": temperature_rise(
            f"temperature of the surface of body {body} above the inlet of the film", f"ΔT_{body}"
        )
        for body in (1, 2)
    },
    "smallest_film": Variable("smallest film of the mesh cycle", "h_min", "m", "um", "length"),
    "smallest_central_film": deviation("smallest film in the middle of a contact", "h_c min"),
    "largest_end_pressure": pressure(
        "largest pressure half a half-width from an end of a line", "p_0.5b"
    ),
    "smallest_lambda": Variable("smallest film over composite Rq", "Λ_min", "1"),
    "largest_film_pressure": pressure("largest pressure of the films", "p_max"),
    "read_film": Variable(
        "film in the middle as read with the index at ambient pressure",
        "h_read",
        "m",
        "um",
        "length",
    ),
    "central_film_error": percent(
        "estimated error of the film in the middle by the grid", "Δh_c/h_c"
    ),
    "minimum_film_error": percent(
        "estimated error of the smallest film by the grid", "Δh_min/h_min"
    ),
    "largest_central_film_error": percent(
        "largest estimated error of films in the middle by the grid", "Δh_c/h_c max"
    ),
    "largest_minimum_film_error": percent(
        "largest estimated error of smallest films by the grid", "Δh_min/h_min max"
    ),
    "summits_share": percent("the same there, with every set of summits", "L_a"),
    "summits_friction": Variable("friction coefficient there, with every set of summits", "μ", "1"),
    "largest_asperity_share": percent("largest part of a contact's load on asperities", "L_a max"),
    "largest_film_rise": temperature_rise(
        "largest temperature of the films above their inlet", "ΔT_film max"
    ),
    "largest_flash_rise": temperature_rise(
        "largest flash temperature of the surfaces", "ΔT_flash max"
    ),
    "mean_film_friction": Variable("mean friction coefficient by the films", "μ_EHL mean", "1"),
    "mean_boundary_part": Variable("of it by asperities that touch", "μ_b mean", "1"),
    "mean_law_friction": Variable("mean friction coefficient by the law", "μ mean", "1"),
    "mean_film_sliding_loss": power("of it by sliding", "P_s EHL"),
    "mean_film_rolling_loss": power("of it by rolling", "P_r EHL"),
    "mean_film_loss": power("mean loss of the contacts by the films", "P_EHL mean"),
    "mean_law_loss": power("mean loss of the contacts by the friction law", "P_law mean"),
    "mean_law_rolling_loss": power("of it by rolling", "P_r"),
    "film_efficiency": percent("mean efficiency by the films", "η_EHL"),
    "law_efficiency": percent("mean efficiency by the friction law", "η"),
    "film_deviation": percent("film by regression less that solved, mean over contacts", "Δh/h"),
    "largest_film_deviation": percent("the same where it is largest", "Δh/h max"),
    "friction_deviation": percent("friction coefficient by law less that by films", "Δμ/μ"),
    "loss_deviation": percent("loss by law less that by films", "ΔP/P"),
    "steady_central_film": deviation("steady film in the middle of the contact", "h_c0"),
    "steady_minimum_film": deviation("smallest steady film of the contact", "h_min0"),
    "steady_film_pressure": pressure("largest pressure of the steady film", "p_max0"),
    "steady_smallest_film": deviation("smallest film if all were steady", "h_min0"),
    "steady_smallest_central_film": deviation(
        "smallest film in the middle of a contact if all were steady", "h_c0 min"
    ),
    "film_change": percent("film in the middle with squeeze less the steady one", "Δh_c/h_c"),
    "squeeze_change": percent(
        "film in the middle with squeeze less the steady one, where it is largest", "Δh_c/h_c"
    ),
    "cycles": Variable("turns of the driver", "N", "1"),
    "worn_depth": deviation("depth of wear", "h"),
    "depth_per_turn": Variable(
        "depth that a turn of the driver wears off", "dh/dN", "m", "nm", "length"
    ),
    "deepest_wear": deviation("largest depth of wear", "h max"),
    "fastest_wear": Variable(
        "largest depth that a turn wears off", "dh/dN max", "m", "nm", "length"
    ),
    "worn_volume": Variable("volume worn off a flank", "V", "m3", "mm3", "volume"),
    "deepest_place": length("arc length where the flank is deepest", "s"),
    "deepest_radius": length("radius where the flank is deepest", "r"),
    "profile_depth": deviation("depth of wear, by contacts and up to the ends of the path", "h"),
    "profile_radius": length("radius of the place on the flank", "r"),
    "wear_error": deviation("error of the largest depth by steps and grid", "Δh"),
    "wear_pressure": pressure("largest pressure of the mesh cycle", "p_H max"),
    "worn_tip_land": length("thickness of the teeth at their tips, normal section", "s_an"),
    "backlash_growth": deviation(
        "normal backlash that wear adds, largest of the mesh cycle", "Δj_n"
    ),
    "backlash_growth_error": deviation(
        "error of that backlash by steps, grid and slices", "Δ(Δj_n)"
    ),
    "flank_place": length("arc length on the flank", "s"),
    "across_place": length("place across the face from its middle", "y"),
    "flank_radius": length("radius of the place on the flank", "r"),
    "flank_half_thickness": length("half thickness of the new tooth, normal section", "x"),
    "flank_height": length("height on the tooth from the lowest place that touches", "z"),
    "flank_angle": angle("angle between flank and axis of the tooth", "α"),
    "final_cycles": Variable("turns of the driver at the end of the march", "N end", "1"),
    "final_cycles_error": Variable(
        "turns by which the final depth may come earlier or later", "ΔN end", "1"
    ),
    "final_depth": deviation("largest depth of wear at the end", "h end"),
    "pressure_change": percent(
        "largest pressure at the end over that at the start, less one", "Δp/p"
    ),
    "run_in_cycles": Variable("turns of the driver at which run-in ends", "N 1", "1"),
    "severe_cycles": Variable("turns of the driver at which severe wear begins", "N 2", "1"),
    "life_hours": Variable("time to the end of the march", "t end", "s", "h", "time"),
    "wear_steps": Variable("steps of the march", "", "1"),
    "loaded_moments": Variable("moments of the engagement", "n_t", "1"),
    "solved_moments": Variable("moments whose film was found", "n_ts", "1"),
    "time_steps": Variable("steps of time since the moment before", "", "1"),
    "newton_steps": Variable("steps of Newton's method since the moment before", "", "1"),
    "kept_moment": Variable("number of the moment whose fields are kept", "", "1"),
    "loaded_contacts": Variable("loaded contacts of the mesh cycle", "n", "1"),
    "solved_contacts": Variable("loaded contacts whose film was found", "n_s", "1"),
    "sliding_loss": power("sliding loss of the pair", "P_s"),
    "rolling_loss": power("rolling loss of the pair", "P_r"),
    "drag_loss": power("power loss beside the teeth", "P_drag"),
    "entered": Variable("base pitches since the pair entered", "ε_0", "1"),
    "line_length": length("length of the contact line", "l_c"),
    "pair_stiffness": stiffness("stiffness of the pair along the line of action", "k_i"),
    "mesh_stiffness": stiffness("stiffness of the mesh along the line of action", "k_t"),
    "mean_stiffness": stiffness("mean mesh stiffness", "k_m"),
    "stiffness_variation": percent("variation of the mesh stiffness over its mean", "Δk/k_m"),
    "standard_single_stiffness": stiffness("single stiffness by ISO 6336-1, c' b", "c' b"),
    "standard_stiffness": stiffness("mesh stiffness by ISO 6336-1, c_γα b", "c_γα b"),
    "transmission_error": deviation("dynamic transmission error", "δ"),
    "static_transmission_error": deviation("static transmission error", "δ_s"),
    "mean_transmission_error": deviation("mean transmission error", "δ mean"),
    "transmission_error_range": deviation("transmission error, peak to peak", "Δδ"),
    "static_transmission_error_range": deviation("static transmission error, peak to peak", "Δδ_s"),
    "transmission_error_rms": deviation(
        "transmission error, root mean square about its mean", "δ rms"
    ),
    "separated_share": percent("share of the period in which no pair carries", "t_0/T"),
    "mesh_dynamic_factor": Variable("force of all pairs over that without vibration", "F/F_0", "1"),
    "largest_mesh_dynamic_factor": Variable(
        "largest force of all pairs over that without vibration", "F/F_0 max", "1"
    ),
    "dynamic_factor": Variable("dynamic factor of the pair", "c_d", "1"),
    "largest_dynamic_factor": Variable("largest dynamic factor of a pair", "c_d max", "1"),
    "spectrum": deviation("amplitude of the transmission error", "|δ_n|"),
    "natural_frequency": Variable("natural frequency", "f_n", "1/s", "Hz", "frequency"),
    "mesh_frequency": Variable("mesh frequency", "f_z", "1/s", "Hz", "frequency"),
    "modal_damping_ratio": percent("damping ratio of the mode", "ξ"),
    "equivalent_mass": Variable("equivalent mass", "m_e", "kg", "g", "mass"),
    "turned": Variable("mesh cycles that the driver has turned", "φ", "1"),
    "time": Variable("time", "t", "s", "ms", "time"),
    "relative_speed": Variable("speed over the nominal one", "ω/ω_0", "1"),
    "body_speed": Variable("speed", "n", "rad/s", "rpm", "rotational speed"),
    "friction_force": force("friction force of the pair", "F_f"),
    "pair_loss": power("power loss of the pair", "P_loss"),
    "bearing_force": force("force on the bearings", "F_B"),
    "bearing_spectrum": force("amplitude of the force on the bearings", "|F_B,n|"),
    "largest_bearing_force": force("largest force on the bearings of a gear", "F_B max"),
    "largest_mesh_force": force("largest normal force of all pairs", "F_n max"),
    "smallest_mesh_force": force("smallest normal force of all pairs", "F_n min"),
    "quasi_static_efficiency": percent("mean efficiency without vibration", "η_0"),
    "efficiency_difference": percent("what vibration takes of the mean efficiency", "η_0 − η"),
    "mesh_damping": Variable(
        "damping along the line of action", "c", "N s/m", "N s/m", "viscous damping"
    ),
    "energy_closure": Variable("energy that is left over, of the largest part", "ΔE/E", "1"),
    "work_put_in": energy("work put in less that taken out by the load", "W_in"),
    "work_friction": energy("lost to sliding", "W_f"),
    "work_rolling": energy("lost to rolling resistance", "W_r"),
    "work_damping": energy("lost to damping", "W_c"),
    "work_mesh": energy("parametric work of the mesh", "W_k"),
    "work_error": energy("work of the profile error", "W_e"),
    "kinetic_energy": energy("kinetic energy", "T"),
    "joint_damping_ratio": Variable("damping ratio", "ξ", "1"),
    "reduced_inertia": Variable(
        "moment of inertia that vibrates, at the output",
        "J_r",
        "kg m2",
        "kg m2",
        "moment of inertia",
    ),
    "critical_order": Variable("order of the mesh frequency", "n", "1"),
    "half_power_width": Variable(
        "width of the peak at half power", "Δn_c", "rad/s", "rpm", "rotational speed"
    ),
    "wave_order": Variable("waves in a turn of the driver", "n", "1"),
    "wave_amplitude": Variable("amplitude of the error", "|Δφ_n|", "rad", "arcsec", "angle"),
    "critical_speed": Variable(
        "driver speed at which it meets the natural frequency",
        "n_c",
        "rad/s",
        "rpm",
        "rotational speed",
    ),
    "output_amplitude": Variable(
        "amplitude of the load's rotation", "|θ_L|", "rad", "arcsec", "angle"
    ),
    "output_speed_amplitude": Variable(
        "amplitude of the load's speed", "|ω_L|", "rad/s", "deg/s", "rotational speed"
    ),
    "torque_amplitude": torque("amplitude of the drive's torque", "|T|"),
    "flank_damping_ratio": Variable("damping ratio by friction of the flanks", "ξ_f", "1"),
    "course_speed": Variable("driver speed", "n", "rad/s", "rpm", "rotational speed"),
    "course_torque": torque("amplitude of the torque with the whole curve", "|T|"),
    "linear_torque": torque("amplitude of the torque by the tangent", "|T|"),
    "course_smallest_torque": torque("smallest torque of the drive there", "T min"),
    "course_status": Variable("status of the vibration with the whole curve", "", "1"),
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
    "module": length("normal module", "m_n"),
    "base_pitch": length("base pitch in the transverse section", "p_bt"),
    "tangent_length": length("length of the line of action between the base circles", "N1N2"),
    "reference_radius": length("reference radius", "r"),
    "base_radius": length("base radius", "r_b"),
    "working_radius": length("pitch radius in operation", "r_w"),
    "tip_radius": length("tip radius", "r_a"),
    "root_radius": length("root radius", "r_f"),
    "form_radius": length("radius at which the involute ends towards the root", "r_Ff"),
    "active_root_radius": length("radius of the active flank nearest to the root", "r_Nf"),
    "tip_thickness": length("tooth thickness on the tip circle", "s_a"),
    "face_width": length("face width in mesh", "b"),
    "centre_distance": length("centre distance", "a"),
    "mounting_distance": length(
        "distance from the pinion's axis to the rack's reference line", "a"
    ),
    "transverse_radius": length("relative radius of curvature across the profile", "R_y"),
    "contact_place": length(
        "place of the contacts across the face, from the middle of gear 1", "z"
    ),
    "contact_room": length("from the contacts to the nearest end of a face", "b_e"),
    "largest_inclination": Variable(
        "inclination of the axes at which the contact reaches an end of a face",
        "γ",
        "rad",
        "mrad",
        "angle",
    ),
    "misalignment_approach": deviation("approach of the flanks by misalignment", "δ_m"),
    "tip_alteration_1": Variable("tip alteration coefficient of gear 1", "k1", "1"),
    "tip_alteration_2": Variable("tip alteration coefficient of gear 2", "k2", "1"),
    "tip_thickness_1": length("tip thickness of gear 1, normal section", "s_an1"),
    "tip_thickness_2": length("tip thickness of gear 2, normal section", "s_an2"),
    "undercut_limit_1": Variable(
        "smallest profile shift of gear 1 without undercut", "x_min1", "1"
    ),
    "undercut_limit_2": Variable(
        "smallest profile shift of gear 2 without undercut", "x_min2", "1"
    ),
    "passing_angle": angle("angle from the long axis", "p"),
    "clearance_angle": angle("angle from the long axis", "p"),
    "rim_thickness": length("thickness of the flexspline's rim", "t"),
    "tip_height": length("radius at which the circular spline's teeth end", "r_a2"),
    "clearance": deviation("clearance along the normal", "g"),
    "wind_up": Variable("wind-up of the loaded member", "Δθ", "rad", "arcmin", "angle"),
    "wind_up_range": Variable(
        "change of the wind-up with the phase", "Δθ range", "rad", "arcmin", "angle"
    ),
    "turn_angle": angle("angle that is turned", "θ"),
    "kinematic_error": Variable("kinematic error", "Δφ", "rad", "arcsec", "angle"),
    "kinematic_error_spectrum": Variable(
        "amplitude of the kinematic error", "|Δφ_n|", "rad", "arcsec", "angle"
    ),
    "kinematic_error_range": Variable(
        "kinematic error, peak to peak", "Δφ range", "rad", "arcsec", "angle"
    ),
    "torsional_stiffness": torsional_stiffness("torsional stiffness", "K"),
    "tangent_torsional_stiffness": torsional_stiffness("slope of torque over wind-up", "dT/dΔθ"),
    "phase_mean_torsional_stiffness": torsional_stiffness(
        "mean over the phases of the slopes of torque over wind-up", "mean K(φ)"
    ),
    "edge_share": percent("part of the load on edges of the teeth", "F_e/F"),
    "wind_up_part": Variable("part of the wind-up", "Δθ", "rad", "arcmin", "angle"),
    "slope_stiffness": torsional_stiffness("torsional stiffness of a part of the curve", "K"),
    "slope_torque": torque("torque at which a part of the curve ends", "T"),
    "catalogue_lost_motion": Variable(
        "lost motion at ±4 % of the rated torque", "Δθ_4%", "rad", "arcmin", "angle"
    ),
    "hysteresis_loss": Variable(
        "hysteresis loss by friction of the teeth alone, the width of the loop without torque",
        "Δθ_h",
        "rad",
        "arcmin",
        "angle",
    ),
    "loaded_pairs": Variable("mean number of pairs that carry", "n", "1"),
    "zone_load": Variable("inward load on each end of the long axis", "F_r", "N", "N", "force"),
    "kinematic_play": Variable(
        "kinematic play of the loaded member between its flanks, without tolerances",
        "Δθ_0",
        "rad",
        "arcmin",
        "angle",
    ),
    "wind_up_by_balls": Variable(
        "wind-up at the operating point with the balls elsewhere less that as they stand",
        "Δθ_b",
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
    "mesh_torsional_stiffness": torsional_stiffness(
        "torsional stiffness over the mesh cycle", "K(φ)"
    ),
    "tooth_force": Variable("normal force of the tooth", "F", "N", "N", "force"),
    "loading_torque": torque("torque while the wind-up grows", "T"),
    "unloading_torque": torque("torque while the wind-up shrinks", "T"),
    "speed_ratio": Variable("driver speed over that of the loaded member", "i", "1"),
    "deflection": length("deflection of the flexspline on the long axis", "w_0"),
    "neutral_radius": length("radius of the flexspline's neutral line", "r_m"),
    "engagement_depth": length("depth by which the teeth reach into each other", "h_e"),
    "loss_factor": Variable("loss factor, equal sharing where all flanks touch", "H_V", "1"),
    "mean_loss": power("mean power loss", "P_loss"),
    "radial_reaction_1": force("mean radial load of the teeth on the bearings of gear 1", "F_r1"),
    "radial_reaction_2": force("mean radial load of the teeth on the bearings of gear 2", "F_r2"),
    "axial_reaction_1": force("mean axial load of the teeth on the bearings of gear 1", "F_a1"),
    "axial_reaction_2": force("mean axial load of the teeth on the bearings of gear 2", "F_a2"),
    "bearing_load": force("mean load on the bearing", "F_B"),
    "equivalent_bearing_load": force("load on the bearing that gives its life", "P"),
    "mean_drag_loss": power("mean power loss beside the teeth", "P_drag mean"),
    "latent_power": power("mean power that rolls through all meshes of sets", "P_roll"),
    "mean_efficiency": percent("mean efficiency", "η mean"),
    "min_efficiency": percent("smallest efficiency", "η min"),
    "max_efficiency": percent("largest efficiency", "η max"),
    "lowest_efficiency_in_range": percent("lowest efficiency by laws in their range", "η low"),
    "highest_efficiency_in_range": percent("highest efficiency by laws in their range", "η high"),
    "efficiency_fluctuation": percent("fluctuation of the efficiency", "Δη"),
    "mean_input_torque": torque("mean input torque", "T_in mean"),
    "min_input_torque": torque("smallest input torque", "T_in min"),
    "max_input_torque": torque("largest input torque", "T_in max"),
    "torque_ripple": torque("ripple of the input torque", "ΔT_in"),
    "no_load_torque": torque("mean input torque without load", "T_0"),
    "starting_torque": torque("input torque that starts the drive", "T_start"),
    "back_driving_torque": torque("output torque that starts the drive backwards", "T_back"),
    "least_starting_torque": torque("least input torque that may start the drive", "T_start min"),
    "largest_starting_torque": torque("input torque that surely starts the drive", "T_start max"),
    "least_back_driving_torque": torque(
        "least output torque that may start the drive backwards", "T_back min"
    ),
    "largest_back_driving_torque": torque(
        "output torque that surely starts the drive backwards", "T_back max"
    ),
    "meeting_error": percent(
        "most that few loads of a stage are off for all meetings of phases, over the mean loss", ""
    ),
    "stage": Variable("stage", "", "1"),
    "stage_loss": power("mean power loss of the stage and its shaft", "P_loss"),
    "stage_drag_loss": power("mean power loss beside the teeth of the stage", "P_drag"),
    "stage_efficiency": percent("mean efficiency of the stage", "η"),
    "stage_friction": Variable("mean friction coefficient of the stage", "μ", "1"),
    "stage_input_torque": torque("mean torque that drives the stage", "T_in"),
    "stage_speed": Variable("speed of the stage's driver", "n", "rad/s", "rpm", "rotational speed"),
    "stage_latent_power": power("mean power that rolls through the meshes of the stage", "P_roll"),
    "stage_wind_up": Variable("wind-up at the output by the stage", "Δθ", "rad", "arcmin", "angle"),
    "stage_torsional_stiffness": torsional_stiffness(
        "torsional stiffness of the stage, at the output", "K"
    ),
    "mean_friction": Variable("mean friction coefficient", "μ mean", "1"),
    "loss_factor_efficiency": percent("efficiency by loss factor, 1 - μ H_V", "1 - μ H_V"),
    "iterations": Variable("iterations of the torque balance", "", "1"),
    "locked": Variable("friction locks the mesh", "", "1"),
    "extrapolated": Variable("the friction law is out of its range", "", "1"),
    "torque": torque("output torque", "T_out"),
    "speed": Variable("driver speed", "n", "rad/s", "rpm", "rotational speed"),
    "output_torque": torque("output torque", "T_out"),
    "output_speed": Variable("output speed", "n_out", "rad/s", "rpm", "rotational speed"),
    "least_holding_torque": torque("input torque below which the load moves back", "T_hold min"),
    "largest_holding_torque": torque("input torque above which the load moves on", "T_hold max"),
    "least_holding_torque_low": torque(
        "input torque below which the load surely moves back", "T_hold min −"
    ),
    "least_holding_torque_high": torque(
        "input torque below which the load may move back", "T_hold min +"
    ),
    "largest_holding_torque_low": torque(
        "input torque above which the load may move on", "T_hold max −"
    ),
    "largest_holding_torque_high": torque(
        "input torque above which the load surely moves on", "T_hold max +"
    ),
    "moving_back_torque": torque(
        "input torque below which it moves back at every phase", "T_hold−"
    ),
    "moving_on_torque": torque("input torque above which it moves on at every phase", "T_hold+"),
    "self_locking": Variable("friction holds the load without the driver", "", "1"),
    "interpolation_error": percent("largest error of the loss half way between nodes, over it", ""),
    "mean_interpolation_error": percent(
        "mean error of the loss half way between nodes, over it", ""
    ),
    "light_load_error": percent("largest error of the loss below the least load of the map", ""),
    "creeping_error": percent("largest error of the loss at a tenth of the lowest speed", ""),
    "duration": Variable("duration of the cycle", "t", "s", "s", "time"),
    "input_speed": Variable("input speed", "n_in", "rad/s", "rpm", "rotational speed"),
    "motor_loss": power("power loss of the motor", "P_motor"),
    "output_energy": energy("energy that the output gives its load", "W_out"),
    "returned_energy": energy("energy that the load gives back to the output", "W_back"),
    "lost_energy": energy("energy lost in the drive", "W_loss"),
    "input_energy": energy("energy that the driver gives", "W_in"),
    "recovered_energy": energy("energy that comes back to the driver", "W_rec"),
    "rotor_energy": energy("energy left in the rotor at the end of the cycle", "W_rotor"),
    "motor_lost_energy": energy("energy lost in the motor", "W_motor"),
    "electrical_energy": energy("electrical energy taken", "W_el"),
    "electrical_recovered_energy": energy("electrical energy given back", "W_el rec"),
    "electrical_power": power("electrical power of the motor", "P_el"),
    "mean_electrical_power": power("mean electrical power", "P_el mean"),
    "peak_electrical_power": power("largest electrical power, either way", "P_el max"),
    "drive_efficiency": percent("energy out of the drive over energy into it", "η_W"),
    "actuator_efficiency": percent("energy out of the actuator over energy into it", "η_W el"),
    "map_torque": torque("output torque of the map", "T_out"),
    "map_speed": Variable("output speed of the map", "n_out", "rad/s", "rpm", "rotational speed"),
    "map_electrical_power": power("electrical power of the actuator", "P_el"),
    "map_actuator_efficiency": percent("efficiency of the actuator", "η_el"),
    "law_lost_energy": energy("energy lost in the drive by friction law", "W_loss"),
    "law_input_energy": energy("energy that the driver gives by friction law", "W_in"),
    "rms_output_torque": torque("root mean square of the output torque over time", "T_out rms"),
    "peak_output_torque": torque("largest output torque, either way", "T_out max"),
    "peak_output_speed": Variable(
        "largest output speed, either way", "n_out max", "rad/s", "rpm", "rotational speed"
    ),
    "mean_output_speed": Variable(
        "mean size of the output speed", "n_out mean", "rad/s", "rpm", "rotational speed"
    ),
    "mean_torque_of_balls": torque(
        "output torque of equal life of ball bearings, mean over revolutions", "T_m3"
    ),
    "mean_torque_of_rollers": torque(
        "output torque of equal life of roller bearings, mean over revolutions", "T_m10/3"
    ),
    "rms_input_torque": torque("root mean square of the input torque over time", "T_in rms"),
    "peak_input_torque": torque("largest input torque, either way", "T_in max"),
    "peak_input_power": power("largest power of the driver, either way", "P_in max"),
    "quadrant_time": Variable("time by quadrant", "t", "s", "s", "time"),
    "quadrant_output_energy": energy("energy of the output by quadrant", "W_out"),
    "quadrant_input_energy": energy("energy of the driver by quadrant", "W_in"),
    "quadrant_lost_energy": energy("energy lost in the drive by quadrant", "W_loss"),
    "system_life": Variable("life of all bearings together", "L", "s", "h", "time"),
    "wear_life": Variable("life until flanks are worn to their limit", "L_w", "s", "h", "time"),
    "cycle_wear": Variable("depth of wear of one cycle", "h_c", "m", "nm", "length"),
    "shortest_life": Variable("life of the part that fails first", "L_min", "s", "h", "time"),
    "flank_damage": Variable("damage of the working flank in one cycle", "D_H", "1"),
    "back_flank_damage": Variable("damage of the back flank in one cycle", "D_H", "1"),
    "root_damage": Variable("damage of the root in one cycle", "D_F", "1"),
    "flank_life": Variable("life of the working flank", "L_H", "s", "h", "time"),
    "back_flank_life": Variable("life of the back flank", "L_H", "s", "h", "time"),
    "root_life": Variable("life of the root", "L_F", "s", "h", "time"),
    "body_temperature": Variable("temperature of the body", "θ", "K", "degC", "temperature"),
    "temperature": Variable("oil temperature", "θ", "K", "degC", "temperature"),
}

_IN_TRAVEL: dict[End, dict[str, Variable]] = {
    "driver": {
        "input_torque": force("input force", "F_in"),
        "mean_input_torque": force("mean input force", "F_in mean"),
        "min_input_torque": force("smallest input force", "F_in min"),
        "max_input_torque": force("largest input force", "F_in max"),
        "torque_ripple": force("ripple of the input force", "ΔF_in"),
        "no_load_torque": force("mean input force without load", "F_0"),
        "starting_torque": force("input force that starts the drive", "F_start"),
        "least_starting_torque": force("least input force that may start the drive", "F_start min"),
        "largest_starting_torque": force("input force that surely starts the drive", "F_start max"),
        "least_holding_torque": force("input force below which the load moves back", "F_hold min"),
        "largest_holding_torque": force("input force above which the load moves on", "F_hold max"),
        "least_holding_torque_low": force(
            "input force below which the load surely moves back", "F_hold min −"
        ),
        "least_holding_torque_high": force(
            "input force below which the load may move back", "F_hold min +"
        ),
        "largest_holding_torque_low": force(
            "input force above which the load may move on", "F_hold max −"
        ),
        "largest_holding_torque_high": force(
            "input force above which the load surely moves on", "F_hold max +"
        ),
        "moving_back_torque": force(
            "input force below which it moves back at every phase", "F_back"
        ),
        "moving_on_torque": force("input force above which it moves on at every phase", "F_hold+"),
        "speed": speed("driver speed", "v"),
    },
    "loaded": {
        "torque": force("output force", "F_out"),
        "output_torque": force("output force", "F_out"),
        "map_torque": force("output force of the map", "F_out"),
        "map_speed": speed("output speed of the map", "v_out"),
        "output_speed": speed("output speed", "v_out"),
        "back_driving_torque": force("output force that starts the drive backwards", "F_back"),
        "least_back_driving_torque": force(
            "least output force that may start the drive backwards", "F_back min"
        ),
        "largest_back_driving_torque": force(
            "output force that surely starts the drive backwards", "F_back max"
        ),
        "loading_torque": force("force while the deflection grows", "F"),
        "unloading_torque": force("force while the deflection shrinks", "F"),
        "wind_up": deviation("deflection of the loaded member", "Δs"),
        "stage_wind_up": deviation("deflection at the output by the stage", "Δs"),
        "stage_torsional_stiffness": stiffness("stiffness of the stage, at the output", "K"),
        "wind_up_range": deviation("change of the deflection with the phase", "Δs range"),
        "torsional_stiffness": stiffness("stiffness at the output", "K"),
        "tangent_torsional_stiffness": stiffness("slope of force over deflection", "dF/dΔs"),
        "phase_mean_torsional_stiffness": stiffness(
            "mean over the phases of the slopes of force over deflection", "mean K(φ)"
        ),
        "mesh_torsional_stiffness": stiffness(
            "stiffness at the output over the mesh cycle", "K(φ)"
        ),
        "kinematic_play": deviation(
            "kinematic play of the loaded member, without tolerances", "Δs_0"
        ),
        "angular_transmission_error": deviation("travel of the loaded member under load", "s_e"),
        "angular_transmission_error_range": deviation(
            "static transmission error at the loaded member, peak to peak", "Δs_e"
        ),
        "kinematic_error": deviation("kinematic error", "Δs"),
        "kinematic_error_spectrum": deviation("amplitude of the kinematic error", "|Δs_n|"),
        "kinematic_error_range": deviation("kinematic error, peak to peak", "Δs range"),
    },
}
"""Quantities of a member that travels."""

VARIABLES.update(
    (name, replace(VARIABLES[name], end=end, travel=travel))
    for end, own in _IN_TRAVEL.items()
    for name, travel in own.items()
)


_OF_ENDS: dict[End, tuple[str, ...]] = {
    "driver": ("critical_speed", "half_power_width", "course_speed"),
    "loaded": (
        "wind_up_part",
        "wind_up_by_balls",
        "slope_torque",
        "slope_stiffness",
        "catalogue_lost_motion",
        "hysteresis_loss",
        "film_torsional_stiffness",
        "stiffness_without_films",
        "stiffness_with_films",
        "reduced_inertia",
        "wave_amplitude",
        "output_amplitude",
        "output_speed_amplitude",
        "torque_amplitude",
        "course_torque",
        "course_smallest_torque",
        "linear_torque",
    ),
}
"""Other quantities of the input and of the output, which no member that travels has."""

VARIABLES.update(
    (name, replace(VARIABLES[name], end=end)) for end, names in _OF_ENDS.items() for name in names
)


def places_of(dimension: str) -> str:
    """Name of the variable whose values are the places along a dimension of courses; empty for none."""
    name = dimension.removesuffix("_place")
    return name if name != dimension and name in VARIABLES else ""


def variable_of(data: Any, name: str) -> Variable:
    """The quantity of that name in a dataset, or none; of a member that travels where its unit says so.

    The axis of a sweep is what its key says.
    """
    if name == SWEEP_AXIS and "sweep_key" in data.attrs:
        key, kind, shown = (str(data.attrs[one]) for one in ("sweep_key", "axis_kind", "axis_unit"))
        unit = units.si_unit(kind) if kind else "1"
        return Variable(key, "", unit, shown, kind or "dimensionless")
    known = VARIABLES[name]
    if known.travel is None or name not in data:
        return known
    return known.travel if data[name].attrs.get("units") == known.travel.unit else known
