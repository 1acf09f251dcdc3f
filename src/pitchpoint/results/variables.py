"""Name, symbol, unit and kind of every quantity that a result holds."""

from dataclasses import replace
from typing import Any

from pitchpoint import units
from pitchpoint.results.strength_variables import EXTREMES, STRENGTH
from pitchpoint.results.variable import (
    End,
    Variable,
    angle,
    deviation,
    dimensionless,
    energy,
    force,
    frequency,
    length,
    mass,
    moment_of_inertia,
    percent,
    power,
    pressure,
    rotational_speed,
    speed,
    stiffness,
    temperature,
    temperature_rise,
    time,
    torque,
    torsional_stiffness,
)

__all__ = ["SWEEP_AXIS", "VARIABLES", "places_of", "variable_of"]

SWEEP_AXIS = "axis"
"""Values of the key of a sweep, in a study that has one."""

VARIABLES: dict[str, Variable] = {
    **STRENGTH,
    **EXTREMES,
    "phase": dimensionless("phase of the mesh cycle", "φ"),
    "weight": dimensionless("weight of the node in a mean over one period", "w"),
    "driver_angle": angle("angle of the driving body", "φ_in"),
    "path": dimensionless("position on the path of contact from A, in base pitches", "x/p_b"),
    "active": dimensionless("pair in contact"),
    "input_torque": torque("input torque", "T_in"),
    "efficiency": percent("instantaneous efficiency", "η"),
    "loss": power("power loss", "P_loss"),
    "contact_force": force("normal force of the mesh", "F_n"),
    "contact_force_ratio": dimensionless("contact force over that without friction", "β"),
    "largest_contact_force_ratio": dimensionless(
        "largest contact force over that without friction", "β max"
    ),
    "jamming_coefficient": dimensionless("friction coefficient at which the mesh locks", "μ lock"),
    "largest_friction": dimensionless("largest friction coefficient of the contacts", "μ max"),
    "turns": dimensionless("turns of films and forces", "n"),
    "turns_change": dimensionless("change of the friction coefficient in the last turn", "Δμ/μ"),
    "nearest_friction": dimensionless(
        "friction coefficient where the mesh is nearest to locking", "μ"
    ),
    "nearest_jamming_coefficient": dimensionless(
        "friction coefficient at which the mesh locks there", "μ lock"
    ),
    "self_locking_margin": dimensionless(
        "friction that locks the drive over that which acts", "μ lock/μ"
    ),
    "contact_line_length": length("length of all contact lines together", "l"),
    "pitch_line_load": Variable(
        long_name="tangential force at the base circle over the face width, F_bt/b",
        symbol="F_bt/b",
        unit="N/m",
        shown="N/mm",
        kind="line load",
    ),
    "pitch_sum_speed": speed("sum of the surface speeds at the pitch point", "v_ΣC"),
    "pitch_radius": length("relative radius of curvature at the pitch point", "ρ_redC"),
    "circumferential_backlash": deviation("nominal backlash on the pitch circles", "j_wt"),
    "normal_backlash": deviation("nominal backlash along the normal", "j_bn"),
    "backlash_on_circle": deviation("backlash on the pitch circles by tolerances", "j_wt"),
    "backlash_along_normal": deviation("backlash along the normal by tolerances", "j_bn"),
    "backlash_angle": angle(
        "turn of a gear in its backlash, the other one held", "j_θ", shown="arcmin"
    ),
    "normal_thickness": length("tooth thickness on the reference cylinder", "s_n"),
    "span_teeth": dimensionless("teeth under a span", "k"),
    "span_measurement": length("span measurement", "W_k"),
    "span_diameter": length("diameter on which a span touches", "d_W"),
    "ball_diameter": length("diameter of the measuring balls", "D_M"),
    "over_balls": length("dimension over balls", "M_d"),
    "ball_contact_diameter": length("diameter on which the balls touch", "d_K"),
    "pin_error": length("way by which a pin is ahead along its circle", "e", shown="um"),
    "pin_force": force("force of a planet on its pin along the circle", "F_pin"),
    "outside_torque": torque("mean torque from outside on a body", "T_ext"),
    "body_thrust": force("axial force of the teeth on a body, one planet", "F_a"),
    "planet_tilting_moment": torque("moment of the axial forces that tilts a planet", "M_p"),
    "planet_share": dimensionless("load of a planet over that of an equal share", "F/F_mean"),
    "planet_load_factor": dimensionless("mesh load factor by the errors of the pins", "K_γ"),
    "drawn_planet_load_factor": dimensionless("mesh load factor of sets by tolerance", "K_γ"),
    "planet_stiffness": stiffness("stiffness of the way over one planet along its circle", "k_p"),
    "disc_mass": mass("mass of a gear as a disc", "m"),
    "disc_inertia": moment_of_inertia("moment of inertia of a gear as a disc", "J"),
    "body_mass": mass("mass of a body", "m"),
    "body_inertia": moment_of_inertia("moment of inertia of a body about its axis", "J"),
    "reflected_part": moment_of_inertia(
        "moment of inertia of a body as it is felt at an end of the drive", "J_red,i"
    ),
    "reflected_inertia": moment_of_inertia(
        "moment of inertia of the drive as it is felt at its end", "J_red"
    ),
    "drive_mass": mass("mass of all bodies of the drive", "m"),
    "output_backlash": angle(
        "turn of the output in the backlash of all stages, the input held", "j_θ", shown="arcmin"
    ),
    "bending_strain": dimensionless("largest strain by which the wave bends", "ε_b"),
    "bending_amplitude": pressure("alternating bending stress of the flexspline", "σ_b"),
    "alternating_stress": pressure("alternating equivalent stress of the flexspline", "σ_a"),
    "mean_bending_stress": pressure("mean bending stress of the flexspline", "σ_b0"),
    "torsional_stress": pressure("shear stress of the flexspline by its torque", "τ"),
    "mean_stress": pressure("mean equivalent stress of the flexspline", "σ_m"),
    "goodman_safety": dimensionless("safety of the flexspline by the Goodman line", "S"),
    "goodman_torque": torque("torque at which that safety is one", "T_S=1"),
    "flexspline_torque": torque("torque on the flexspline, without losses", "T_F"),
    "limit_torque": torque("torque of a maker, at this size", "T_limit"),
    "limit_margin": dimensionless("that torque over the one on the flexspline", "T_limit/T_F"),
    "rated_life_torque": torque("torque for the rated life of the bearing at this speed", "T_L"),
    "bearing_life": time("life of the bearing by its rating, with 90 % unharmed", "L", shown="h"),
    "operating_bearing_life": time("life of the bearing at the operating point", "L", shown="h"),
    "flank_tolerance": deviation("tolerance of the flanks by ISO 1328-1", "T"),
    "residual": dimensionless("relative residual of the torque balance"),
    "load": force("normal force of the pair", "F"),
    "load_share": dimensionless("share of the load", "λ"),
    "friction": dimensionless("friction coefficient", "μ"),
    "sliding_velocity": speed("sliding velocity, signed", "v_s"),
    "entrainment": speed("entrainment velocity", "u"),
    "slide_roll_ratio": dimensionless("slide-roll ratio", "SR"),
    "pressure": pressure("largest Hertz pressure", "p_H"),
    "semi_axis_along": length("semi-axis of the contact in the rolling direction", "b"),
    "semi_axis_across": length("semi-axis of the contact across the rolling direction", "a"),
    "film_thickness": length("film thickness", "h", shown="um"),
    "lambda_ratio": dimensionless("film thickness over composite Rq", "Λ"),
    "min_lambda_ratio": dimensionless("smallest film over composite Rq", "Λ min"),
    "asperity_load_ratio": percent("part of the load on asperities", "L_a"),
    "central_film": length("film in the middle of the contact, solved", "h_c", shown="um"),
    "minimum_film": length("smallest film of the contact, solved", "h_min", shown="um"),
    "minimum_lambda": dimensionless("smallest film over composite Rq, solved", "Λ_min"),
    "film_pressure": pressure("largest pressure of the film, solved", "p_max"),
    "asperity_share": percent("part of the load on asperities, solved", "L_a"),
    "mean_film": deviation("mean film of the contact, weighed by its dry pressure", "h_m"),
    "row_film": deviation("smallest film of the row in the middle of a line", "h_row"),
    "minimum_place": length("place of the smallest film, along and across", "x, y"),
    "largest_place": length("place of the largest pressure, along and across", "x, y"),
    "near_ends": pressure("largest pressure at a distance from the end of the line", "p_e"),
    "distance": dimensionless("distance from the end of the line, in half-widths", "s/b"),
    "dry_pressure": pressure("largest pressure of the dry contact, but for its ends", "p_H"),
    "dry_half_width": length("half-width of the dry contact", "b"),
    "film_inlet": length("distance before the contact at which its oil begins", "x_in"),
    "film_defect": dimensionless("defect of the film, over the pressure of the dry contact"),
    "line_central_film": deviation("film in the middle of a line without ends", "h_c"),
    "line_minimum_film": deviation("smallest film of a line without ends", "h_min"),
    "line_friction": dimensionless("friction coefficient of a line without ends", "μ_line"),
    "line_loss": power("loss of a line without ends", "P_line"),
    "mean_line_friction": dimensionless(
        "mean friction coefficient by lines without ends", "μ_line"
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
    "coarse_friction": dimensionless("friction coefficient on a coarser grid", "μ"),
    "film_rise": temperature_rise(
        "largest temperature of the film above its inlet, solved", "ΔT_film"
    ),
    "flash_rise": temperature_rise("flash temperature of the warmer surface, solved", "ΔT_flash"),
    "film_friction": dimensionless("friction coefficient of the film, solved", "μ_EHL"),
    "boundary_part": dimensionless("friction coefficient by asperities that touch, solved", "μ_b"),
    "rolling_resistance": force("rolling resistance of each surface, solved", "F_roll"),
    "film_sliding_loss": power("sliding loss of the pair by its film", "P_s"),
    "film_rolling_loss": power("rolling loss of the pair by its film", "P_r"),
    "film_stiffness": stiffness("stiffness of the film", "k_film"),
    "film_damping": Variable(
        long_name="squeeze damping of the film",
        symbol="c_film",
        unit="N s/m",
        shown="N s/m",
        kind="viscous damping",
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
    "film_status": dimensionless("status of the film"),
    "film_by_law": length("film thickness by regression", "h", shown="um"),
    "film_loss": power("loss of the contacts by their films", "P_EHL"),
    "law_loss": power("loss of the contacts by the friction law", "P_law"),
    "profile_place": length("place across the contact", "x"),
    "profile_film": length("film across the contact", "h", shown="um"),
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
    "smallest_film": length("smallest film of the mesh cycle", "h_min", shown="um"),
    "smallest_central_film": deviation("smallest film in the middle of a contact", "h_c min"),
    "largest_end_pressure": pressure(
        "largest pressure half a half-width from an end of a line", "p_0.5b"
    ),
    "smallest_lambda": dimensionless("smallest film over composite Rq", "Λ_min"),
    "largest_film_pressure": pressure("largest pressure of the films", "p_max"),
    "read_film": length(
        "film in the middle as read with the index at ambient pressure", "h_read", shown="um"
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
    "summits_friction": dimensionless("friction coefficient there, with every set of summits", "μ"),
    "largest_asperity_share": percent("largest part of a contact's load on asperities", "L_a max"),
    "largest_film_rise": temperature_rise(
        "largest temperature of the films above their inlet", "ΔT_film max"
    ),
    "largest_flash_rise": temperature_rise(
        "largest flash temperature of the surfaces", "ΔT_flash max"
    ),
    "mean_film_friction": dimensionless("mean friction coefficient by the films", "μ_EHL mean"),
    "mean_boundary_part": dimensionless("of it by asperities that touch", "μ_b mean"),
    "mean_law_friction": dimensionless("mean friction coefficient by the law", "μ mean"),
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
    "cycles": dimensionless("turns of the driver", "N"),
    "worn_depth": deviation("depth of wear", "h"),
    "depth_per_turn": length("depth that a turn of the driver wears off", "dh/dN", shown="nm"),
    "deepest_wear": deviation("largest depth of wear", "h max"),
    "fastest_wear": length("largest depth that a turn wears off", "dh/dN max", shown="nm"),
    "worn_volume": Variable(
        long_name="volume worn off a flank", symbol="V", unit="m3", shown="mm3", kind="volume"
    ),
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
    "final_cycles": dimensionless("turns of the driver at the end of the march", "N end"),
    "final_cycles_error": dimensionless(
        "turns by which the final depth may come earlier or later", "ΔN end"
    ),
    "final_depth": deviation("largest depth of wear at the end", "h end"),
    "pressure_change": percent(
        "largest pressure at the end over that at the start, less one", "Δp/p"
    ),
    "run_in_cycles": dimensionless("turns of the driver at which run-in ends", "N 1"),
    "severe_cycles": dimensionless("turns of the driver at which severe wear begins", "N 2"),
    "life_hours": time("time to the end of the march", "t end", shown="h"),
    "wear_steps": dimensionless("steps of the march"),
    "loaded_moments": dimensionless("moments of the engagement", "n_t"),
    "solved_moments": dimensionless("moments whose film was found", "n_ts"),
    "time_steps": dimensionless("steps of time since the moment before"),
    "newton_steps": dimensionless("steps of Newton's method since the moment before"),
    "kept_moment": dimensionless("number of the moment whose fields are kept"),
    "loaded_contacts": dimensionless("loaded contacts of the mesh cycle", "n"),
    "solved_contacts": dimensionless("loaded contacts whose film was found", "n_s"),
    "sliding_loss": power("sliding loss of the pair", "P_s"),
    "rolling_loss": power("rolling loss of the pair", "P_r"),
    "drag_loss": power("power loss beside the teeth", "P_drag"),
    "entered": dimensionless("base pitches since the pair entered", "ε_0"),
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
    "mesh_dynamic_factor": dimensionless("force of all pairs over that without vibration", "F/F_0"),
    "largest_mesh_dynamic_factor": dimensionless(
        "largest force of all pairs over that without vibration", "F/F_0 max"
    ),
    "dynamic_factor": dimensionless("dynamic factor of the pair", "c_d"),
    "largest_dynamic_factor": dimensionless("largest dynamic factor of a pair", "c_d max"),
    "spectrum": deviation("amplitude of the transmission error", "|δ_n|"),
    "natural_frequency": frequency("natural frequency", "f_n"),
    "mesh_frequency": frequency("mesh frequency", "f_z"),
    "modal_damping_ratio": percent("damping ratio of the mode", "ξ"),
    "equivalent_mass": mass("equivalent mass", "m_e", shown="g"),
    "turned": dimensionless("mesh cycles that the driver has turned", "φ"),
    "time": time("time", "t", shown="ms"),
    "relative_speed": dimensionless("speed over the nominal one", "ω/ω_0"),
    "body_speed": rotational_speed("speed", "n"),
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
        long_name="damping along the line of action",
        symbol="c",
        unit="N s/m",
        shown="N s/m",
        kind="viscous damping",
    ),
    "energy_closure": dimensionless("energy that is left over, of the largest part", "ΔE/E"),
    "work_put_in": energy("work put in less that taken out by the load", "W_in"),
    "work_friction": energy("lost to sliding", "W_f"),
    "work_rolling": energy("lost to rolling resistance", "W_r"),
    "work_damping": energy("lost to damping", "W_c"),
    "work_mesh": energy("parametric work of the mesh", "W_k"),
    "work_error": energy("work of the profile error", "W_e"),
    "kinetic_energy": energy("kinetic energy", "T"),
    "joint_damping_ratio": dimensionless("damping ratio", "ξ"),
    "reduced_inertia": moment_of_inertia(
        "moment of inertia that vibrates, at the output", "J_r", shown="kg m2"
    ),
    "critical_order": dimensionless("order of the mesh frequency", "n"),
    "half_power_width": rotational_speed("width of the peak at half power", "Δn_c"),
    "wave_order": dimensionless("waves in a turn of the driver", "n"),
    "wave_amplitude": angle("amplitude of the error", "|Δφ_n|", shown="arcsec"),
    "critical_speed": rotational_speed(
        "driver speed at which it meets the natural frequency", "n_c"
    ),
    "output_amplitude": angle("amplitude of the load's rotation", "|θ_L|", shown="arcsec"),
    "output_speed_amplitude": rotational_speed(
        "amplitude of the load's speed", "|ω_L|", shown="deg/s"
    ),
    "torque_amplitude": torque("amplitude of the drive's torque", "|T|"),
    "flank_damping_ratio": dimensionless("damping ratio by friction of the flanks", "ξ_f"),
    "course_speed": rotational_speed("driver speed", "n"),
    "course_torque": torque("amplitude of the torque with the whole curve", "|T|"),
    "linear_torque": torque("amplitude of the torque by the tangent", "|T|"),
    "course_smallest_torque": torque("smallest torque of the drive there", "T min"),
    "course_status": dimensionless("status of the vibration with the whole curve"),
    "largest_multiplier": dimensionless("largest Floquet multiplier", "|Λ|"),
    "vibration_status": dimensionless("status of the vibration"),
    "radius": length("relative radius of curvature", "R"),
    "contact_ratio": dimensionless("total contact ratio", "ε_γ"),
    "transverse_contact_ratio": dimensionless("transverse contact ratio", "ε_α"),
    "overlap_ratio": dimensionless("overlap ratio", "ε_β"),
    "flank_temperature_1": temperature("flank temperature of gear 1", "θ_flank1"),
    "root_temperature_1": temperature("tooth root temperature of gear 1", "θ_root1"),
    "young_1": pressure("Young's modulus of gear 1", "E1", shown="GPa"),
    "flank_temperature_2": temperature("flank temperature of gear 2", "θ_flank2"),
    "root_temperature_2": temperature("tooth root temperature of gear 2", "θ_root2"),
    "young_2": pressure("Young's modulus of gear 2", "E2", shown="GPa"),
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
    "largest_inclination": angle(
        "inclination of the axes at which the contact reaches an end of a face", "γ", shown="mrad"
    ),
    "misalignment_approach": deviation("approach of the flanks by misalignment", "δ_m"),
    "tip_alteration_1": dimensionless("tip alteration coefficient of gear 1", "k1"),
    "tip_alteration_2": dimensionless("tip alteration coefficient of gear 2", "k2"),
    "tip_thickness_1": length("tip thickness of gear 1, normal section", "s_an1"),
    "tip_thickness_2": length("tip thickness of gear 2, normal section", "s_an2"),
    "undercut_limit_1": dimensionless(
        "smallest profile shift of gear 1 without undercut", "x_min1"
    ),
    "undercut_limit_2": dimensionless(
        "smallest profile shift of gear 2 without undercut", "x_min2"
    ),
    "passing_angle": angle("angle from the long axis", "p"),
    "clearance_angle": angle("angle from the long axis", "p"),
    "rim_thickness": length("thickness of the flexspline's rim", "t"),
    "tip_height": length("radius at which the circular spline's teeth end", "r_a2"),
    "clearance": deviation("clearance along the normal", "g"),
    "wind_up": angle("wind-up of the loaded member", "Δθ", shown="arcmin"),
    "wind_up_range": angle("change of the wind-up with the phase", "Δθ range", shown="arcmin"),
    "turn_angle": angle("angle that is turned", "θ"),
    "kinematic_error": angle("kinematic error", "Δφ", shown="arcsec"),
    "kinematic_error_spectrum": angle("amplitude of the kinematic error", "|Δφ_n|", shown="arcsec"),
    "kinematic_error_range": angle("kinematic error, peak to peak", "Δφ range", shown="arcsec"),
    "torsional_stiffness": torsional_stiffness("torsional stiffness", "K"),
    "tangent_torsional_stiffness": torsional_stiffness("slope of torque over wind-up", "dT/dΔθ"),
    "phase_mean_torsional_stiffness": torsional_stiffness(
        "mean over the phases of the slopes of torque over wind-up", "mean K(φ)"
    ),
    "edge_share": percent("part of the load on edges of the teeth", "F_e/F"),
    "wind_up_part": angle("part of the wind-up", "Δθ", shown="arcmin"),
    "slope_stiffness": torsional_stiffness("torsional stiffness of a part of the curve", "K"),
    "slope_torque": torque("torque at which a part of the curve ends", "T"),
    "catalogue_lost_motion": angle(
        "lost motion at ±4 % of the rated torque", "Δθ_4%", shown="arcmin"
    ),
    "hysteresis_loss": angle(
        "hysteresis loss by friction of the teeth alone, the width of the loop without torque",
        "Δθ_h",
        shown="arcmin",
    ),
    "loaded_pairs": dimensionless("mean number of pairs that carry", "n"),
    "zone_load": force("inward load on each end of the long axis", "F_r"),
    "kinematic_play": angle(
        "kinematic play of the loaded member between its flanks, without tolerances",
        "Δθ_0",
        shown="arcmin",
    ),
    "wind_up_by_balls": angle(
        "wind-up at the operating point with the balls elsewhere less that as they stand",
        "Δθ_b",
        shown="arcmin",
    ),
    "angular_transmission_error": angle(
        "rotation of the loaded member under load", "θ_e", shown="arcmin"
    ),
    "angular_transmission_error_range": angle(
        "static transmission error at the loaded member, peak to peak", "Δθ_e", shown="arcsec"
    ),
    "mesh_torsional_stiffness": torsional_stiffness(
        "torsional stiffness over the mesh cycle", "K(φ)"
    ),
    "tooth_force": force("normal force of the tooth", "F"),
    "loading_torque": torque("torque while the wind-up grows", "T"),
    "unloading_torque": torque("torque while the wind-up shrinks", "T"),
    "speed_ratio": dimensionless("driver speed over that of the loaded member", "i"),
    "deflection": length("deflection of the flexspline on the long axis", "w_0"),
    "neutral_radius": length("radius of the flexspline's neutral line", "r_m"),
    "engagement_depth": length("depth by which the teeth reach into each other", "h_e"),
    "loss_factor": dimensionless("loss factor, equal sharing where all flanks touch", "H_V"),
    "mean_loss": power("mean power loss", "P_loss"),
    "radial_reaction_1": force("mean radial load of the teeth on the bearings of gear 1", "F_r1"),
    "radial_reaction_2": force("mean radial load of the teeth on the bearings of gear 2", "F_r2"),
    "axial_reaction_1": force("mean axial load of the teeth on the bearings of gear 1", "F_a1"),
    "axial_reaction_2": force("mean axial load of the teeth on the bearings of gear 2", "F_a2"),
    "bearing_load": force("mean load on the bearing", "F_B"),
    "equivalent_bearing_load": force("load on the bearing that gives its life", "P"),
    "static_bearing_safety": dimensionless("static safety of the bearing", "S_0"),
    "static_torque_margin": dimensionless(
        "load of the drive at a static safety of the bearing of 1, over that of operation", ""
    ),
    "life_torque_margin": dimensionless(
        "load of the drive at which the bearing has the life that is asked, over that of operation",
        "",
    ),
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
    "stage": dimensionless("stage"),
    "stage_loss": power("mean power loss of the stage and its shaft", "P_loss"),
    "stage_drag_loss": power("mean power loss beside the teeth of the stage", "P_drag"),
    "stage_efficiency": percent("mean efficiency of the stage", "η"),
    "stage_friction": dimensionless("mean friction coefficient of the stage", "μ"),
    "stage_input_torque": torque("mean torque that drives the stage", "T_in"),
    "stage_speed": rotational_speed("speed of the stage's driver", "n"),
    "stage_latent_power": power("mean power that rolls through the meshes of the stage", "P_roll"),
    "stage_wind_up": angle("wind-up at the output by the stage", "Δθ", shown="arcmin"),
    "stage_torsional_stiffness": torsional_stiffness(
        "torsional stiffness of the stage, at the output", "K"
    ),
    "mean_friction": dimensionless("mean friction coefficient", "μ mean"),
    "loss_factor_efficiency": percent("efficiency by loss factor, 1 - μ H_V", "1 - μ H_V"),
    "iterations": dimensionless("iterations of the torque balance"),
    "locked": dimensionless("friction locks the mesh"),
    "extrapolated": dimensionless("the friction law is out of its range"),
    "torque": torque("output torque", "T_out"),
    "speed": rotational_speed("driver speed", "n"),
    "output_torque": torque("output torque", "T_out"),
    "output_speed": rotational_speed("output speed", "n_out"),
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
    "self_locking": dimensionless("friction holds the load without the driver"),
    "interpolation_error": percent("largest error of the loss half way between nodes, over it", ""),
    "mean_interpolation_error": percent(
        "mean error of the loss half way between nodes, over it", ""
    ),
    "light_load_error": percent("largest error of the loss below the least load of the map", ""),
    "creeping_error": percent("largest error of the loss at a tenth of the lowest speed", ""),
    "duration": time("duration of the cycle", "t"),
    "input_speed": rotational_speed("input speed", "n_in"),
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
    "map_speed": rotational_speed("output speed of the map", "n_out"),
    "map_electrical_power": power("electrical power of the actuator", "P_el"),
    "map_actuator_efficiency": percent("efficiency of the actuator", "η_el"),
    "law_lost_energy": energy("energy lost in the drive by friction law", "W_loss"),
    "law_input_energy": energy("energy that the driver gives by friction law", "W_in"),
    "rms_output_torque": torque("root mean square of the output torque over time", "T_out rms"),
    "peak_output_torque": torque("largest output torque, either way", "T_out max"),
    "peak_output_speed": rotational_speed("largest output speed, either way", "n_out max"),
    "mean_output_speed": rotational_speed("mean size of the output speed", "n_out mean"),
    "mean_torque_of_balls": torque(
        "output torque of equal life of ball bearings, mean over revolutions", "T_m3"
    ),
    "mean_torque_of_rollers": torque(
        "output torque of equal life of roller bearings, mean over revolutions", "T_m10/3"
    ),
    "rms_input_torque": torque("root mean square of the input torque over time", "T_in rms"),
    "peak_input_torque": torque("largest input torque, either way", "T_in max"),
    "peak_input_power": power("largest power of the driver, either way", "P_in max"),
    "quadrant_time": time("time by quadrant", "t"),
    "quadrant_output_energy": energy("energy of the output by quadrant", "W_out"),
    "quadrant_input_energy": energy("energy of the driver by quadrant", "W_in"),
    "quadrant_lost_energy": energy("energy lost in the drive by quadrant", "W_loss"),
    "system_life": time("life of all bearings together", "L", shown="h"),
    "wear_life": time("life until flanks are worn to their limit", "L_w", shown="h"),
    "cycle_wear": length("depth of wear of one cycle", "h_c", shown="nm"),
    "shortest_life": time("life of the part that fails first", "L_min", shown="h"),
    "flank_damage": dimensionless("damage of the working flank in one cycle", "D_H"),
    "back_flank_damage": dimensionless("damage of the back flank in one cycle", "D_H"),
    "root_damage": dimensionless("damage of the root in one cycle", "D_F"),
    "flank_life": time("life of the working flank", "L_H", shown="h"),
    "back_flank_life": time("life of the back flank", "L_H", shown="h"),
    "root_life": time("life of the root", "L_F", shown="h"),
    "body_temperature": temperature("temperature of the body", "θ"),
    "temperature": temperature("oil temperature", "θ"),
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
        key, kind, shown = (
            str(data.attrs[attribute]) for attribute in ("sweep_key", "axis_kind", "axis_unit")
        )
        unit = units.si_unit(kind) if kind else "1"
        return Variable(
            long_name=key, symbol="", unit=unit, shown=shown, kind=kind or "dimensionless"
        )
    quantity = VARIABLES[name]
    if quantity.travel is None or name not in data:
        return quantity
    return quantity.travel if data[name].attrs.get("units") == quantity.travel.unit else quantity
