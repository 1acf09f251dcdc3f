"""Name, symbol and unit of what a rating of the strength of gears holds."""

from typing import Final

from pitchpoint.results.variable import (
    angle,
    dimensionless,
    force,
    length,
    pressure,
    speed,
)

__all__ = ["EXTREMES", "STRENGTH"]


STRENGTH: Final = {
    "reference_force": force("tangential force at the reference circles", "F_t"),
    "tangential_force": force("tangential force at the pitch circles in operation", "F_tw"),
    "radial_force": force("radial force of the teeth", "F_r"),
    "axial_force": force("axial force of the teeth", "F_a"),
    "normal_force": force("normal force of the teeth", "F_n"),
    "resonance_number": speed("speed against resonance, (v z_1/100) sqrt(u^2/(1 + u^2))", "N*"),
    "resonance_ratio": dimensionless("tooth frequency over that of the mesh, by method B", "N"),
    "dynamic_factor_b": dimensionless("dynamic factor by method B", "K_v-B"),
    "dynamic_factor_c": dimensionless("dynamic factor by method C", "K_v-C"),
    "application_factor": dimensionless("application factor", "K_A"),
    "mesh_load_factor": dimensionless("mesh load factor", "K_γ"),
    "rated_dynamic_factor": dimensionless("dynamic factor", "K_v"),
    "face_misalignment": length("misalignment over the face after running in", "F_βy"),
    "face_load_factor": dimensionless("face load factor of the flank", "K_Hβ"),
    "transverse_load_factor": dimensionless("transverse load factor of the flank", "K_Hα"),
    "root_face_load_factor": dimensionless("face load factor of the root", "K_Fβ"),
    "root_transverse_load_factor": dimensionless("transverse load factor of the root", "K_Fα"),
    "zone_factor": dimensionless("zone factor", "Z_H"),
    "elasticity_factor": dimensionless("elasticity factor in √(N/mm²)", "Z_E"),
    "contact_ratio_factor": dimensionless("contact ratio factor of the flank", "Z_ε"),
    "helix_factor": dimensionless("helix angle factor of the flank", "Z_β"),
    "single_contact_factor": dimensionless("single pair contact factor", "Z_B, Z_D"),
    "nominal_contact_stress": pressure("nominal contact stress at the pitch point", "σ_H0"),
    "contact_stress": pressure("contact stress", "σ_H"),
    "flank_endurance": pressure("contact stress that test gears endure", "σ_Hlim"),
    "flank_cycles": dimensionless("load cycles of the flank", "N_L"),
    "flank_life_factor": dimensionless("life factor of the flank", "Z_NT"),
    "lubricant_factor": dimensionless("lubricant factor", "Z_L"),
    "velocity_factor": dimensionless("velocity factor", "Z_v"),
    "roughness_factor": dimensionless("roughness factor", "Z_R"),
    "work_hardening_factor": dimensionless("work hardening factor", "Z_W"),
    "flank_size_factor": dimensionless("size factor of the flank", "Z_X"),
    "contact_limit": pressure("permissible contact stress with safety 1", "σ_HP"),
    "flank_safety": dimensionless("flank safety", "S_H"),
    "form_factor": dimensionless("tooth form factor", "Y_F"),
    "stress_correction_factor": dimensionless("stress correction factor", "Y_S"),
    "root_helix_factor": dimensionless("helix angle factor of the root", "Y_β"),
    "rim_backup": dimensionless(
        "thickness of the rim over the height of the teeth, of a ring over the module",
        "s_R/h",
    ),
    "rim_factor": dimensionless("rim thickness factor", "Y_B"),
    "root_contact_ratio_factor": dimensionless(
        "deep tooth factor, contact ratio factor of plastic gears", "Y_DT, Y_ε"
    ),
    "root_chord": length("chord of the root at the critical section", "s_Fn"),
    "bending_arm": length("arm of the force above that section", "h_F"),
    "load_angle": angle("angle of the force to the perpendicular of the tooth", "α_Fn"),
    "root_fillet_radius": length("radius of the root fillet there", "ρ_F"),
    "notch_parameter": dimensionless("notch parameter", "q_s"),
    "nominal_root_stress": pressure("nominal root stress", "σ_F0"),
    "root_stress": pressure("root stress", "σ_F"),
    "root_endurance": pressure("nominal root stress that test gears endure", "σ_Flim"),
    "root_cycles": dimensionless("load cycles of the root", "N_L"),
    "root_life_factor": dimensionless("life factor of the root", "Y_NT"),
    "notch_sensitivity_factor": dimensionless("relative notch sensitivity factor", "Y_δrelT"),
    "surface_factor": dimensionless("relative surface factor", "Y_RrelT"),
    "root_size_factor": dimensionless("size factor of the root", "Y_X"),
    "mean_stress_factor": dimensionless("factor of load in both directions", "Y_M"),
    "root_limit": pressure("permissible root stress with safety 1, Y_ST = 2 in it", "σ_FP"),
    "root_safety": dimensionless("root safety", "S_F"),
}
"""Variables of a rating."""

EXTREMES: Final = {
    "largest_contact_stress": pressure("largest contact stress of the flanks", "σ_H max"),
    "largest_root_stress": pressure("largest root stress of the teeth", "σ_F max"),
    "least_flank_safety": dimensionless("least flank safety of those that are known", "S_H min"),
    "least_root_safety": dimensionless("least root safety of those that are known", "S_F min"),
}
"""Variables of some ratings together."""
