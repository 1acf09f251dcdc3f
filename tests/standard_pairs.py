"""Pairs of the reference values, and their stiffness by ISO 6336-1."""

import numpy as np

from pitchpoint._jax import jnp
from pitchpoint.loading import iso_6336_stiffness as iso

ALPHA = np.deg2rad(20.0)


def number(value):
    return jnp.asarray(value, dtype=float)


PAIRS = {
    "GP1": (4, 51, 1.5e-3, 0.74, 0.05, 10.6387e-3, 84.3891e-3),
    "GP2": (4, 51, 1.5e-3, 0.85, -0.06, 10.7850e-3, 84.0591e-3),
    "GP3": (6, 77, 1.0e-3, 0.60, 0.29, 9.2849e-3, 84.4212e-3),
    "GP4": (6, 77, 1.0e-3, 0.85, 0.04, 9.5227e-3, 83.9212e-3),
}


# ------------------------------------------------------------------ the standard's estimate


def virtual(teeth, beta):
    helix = np.deg2rad(beta)
    base = np.arcsin(np.sin(helix) * np.cos(ALPHA))
    return np.array(teeth) / (np.cos(base) ** 2 * np.cos(helix))


def standard_stiffness(teeth, beta, shift, young, ratio=1.0, dedendum=1.25, blank=1.0, load=1e6):
    """c', c_gamma_alpha and c_gamma_beta [N/(mm um)]."""
    single = iso.single_stiffness(
        virtual_teeth=jnp.asarray(virtual(teeth, beta)),
        profile_shift=jnp.asarray(shift),
        helix_angle=number(np.deg2rad(beta)),
        young=jnp.asarray(young),
        rack=iso.rack_factor(dedendum=number(dedendum), pressure_angle=number(ALPHA)),
        blank=number(blank),
        specific_load=number(load),
    )
    alpha = iso.mesh_stiffness_alpha(single=single, contact_ratio=number(ratio))
    return [1e-9 * float(value) for value in (single, alpha, iso.mesh_stiffness_beta(alpha=alpha))]
