"""Strain wave teeth under load at any phases, in the programs of a mesh cycle, which all files share."""

import equinox as eqx
import numpy as np

from pitchpoint._jax import jnp
from pitchpoint.efficiency.quasi_static import Design, contacts_at, coupling
from pitchpoint.gears.nominal_motion import mesh_ends
from pitchpoint.loading.compliance import compliance
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.loading.wind_up import wound_up
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

NODES = 24
"""As many phases go through a program together as a cycle has nodes."""

STEEL = solids.find("steel").build()
OIL = lubricants.find("pao-vg-220").build()
WEBER = terms_of("beam_foundation_weber")


def design(mesh):
    return Design(mesh, (STEEL, STEEL), OIL, Roughness.from_composite_rq(0.4e-6))


def passing(mesh, phases):
    """Contacts and what couples them, in parts of so many phases; the last ones begin anew."""
    rows = np.resize(phases, (-(-len(phases) // NODES), NODES))
    parts = [contacts_at(mesh, jnp.asarray(row)) for row in rows]
    return [(part, coupling(mesh.body, design(mesh).solids, part)) for part in parts]


def wound(mesh, part, torque, terms=WEBER):
    """Equilibrium of a part at a torque."""
    return wound_up(mesh, mesh_ends(mesh)[1], (STEEL, STEEL), terms, jnp.asarray(torque), *part)


@eqx.filter_jit
def yielding(mesh, contacts, body, load, force):
    """How far tooth and body yield at each contact to the forces."""
    yields = compliance(mesh, mesh_ends(mesh)[1], contacts, (STEEL, STEEL), WEBER, load, body)
    each = force[:, 0]
    return (
        jnp.einsum("ij...,j...->i...", yields.body, each) + yields.of_teeth(contacts)[:, 0] * each
    )
