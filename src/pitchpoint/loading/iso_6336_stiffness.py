"""Stiffness of a pair of gears as ISO 6336-1 estimates it, method B: one number, no course over the path."""

import math
from dataclasses import replace
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.doubts import REMARKED, Doubt, in_percent
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import program
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.rated_pair import StandardPair, standard_pair
from pitchpoint.materials.solids import Solid

__all__ = [
    "STEEL_MODULUS",
    "blank_factor",
    "estimate",
    "mesh_stiffness_alpha",
    "mesh_stiffness_beta",
    "pair_compliance",
    "rack_factor",
    "range_warnings",
    "single_stiffness",
]

STEEL_MODULUS = 206e9
"""Young's modulus of the steel gears from which the estimate was derived [Pa]."""

# ISO 6336-1: C_M of method B, and the specific load [N/m] below which stiffness falls with its fourth root.
_CORRECTION = 0.8
_FULL_LOAD = 1e5
# The slope of that root has no bound at zero.
_LEAST_LOAD = 1.0
_FEWEST_TEETH = 18.9
_RANGES = (
    ("contact ratio of {:.4g} is below the 1.2", 1.2, float("inf"), "contact ratio"),
    ("helix angle of {:.4g} deg is above the 30 deg", 0.0, 30.0, "helix angle"),
    ("sum of profile shifts of {:.4g} is outside the -0.5 to 2", -0.5, 2.0, "sum of shifts"),
)


def pair_compliance(
    *, virtual_teeth: Float[Array, "2"], profile_shift: Float[Array, "2"]
) -> Float[Array, ""]:
    """Least compliance q' of a pair of steel teeth, per width [m2/N].

    Args:
        virtual_teeth: z_n1, z_n2 of the normal section, pinion first.
        profile_shift: x_1, x_2, with x_1 >= x_2 and a sum between -0.5 and 2.

    Source: ISO 6336-1:2006, series for q' in mm um/N (rack with a dedendum of 1.2 modules).
    """
    return jnp.asarray(1e-9 * _yielding(virtual_teeth, profile_shift))


def _yielding(virtual_teeth: Any, profile_shift: Any) -> Any:
    """Q' in mm um/N, see `pair_compliance`."""
    (first, second), (x_1, x_2) = virtual_teeth, profile_shift
    constant = 0.04723 - 0.00635 * x_1 - 0.00193 * x_2
    pinion = (0.15551 - 0.11654 * x_1) / first
    wheel = (0.25791 - 0.24188 * x_2) / second
    return constant + pinion + wheel + 0.00529 * x_1**2 + 0.00182 * x_2**2


def rack_factor(
    *, dedendum: Float[Array, "*b"], pressure_angle: Float[Array, "*b"]
) -> Float[Array, "*b"]:
    """Basic rack factor C_B; of two different racks the mean counts.

    Args:
        dedendum: of the basic rack in normal modules.
        pressure_angle: normal pressure angle of the rack [rad].

    Source: ISO 6336-1:2006, C_B = (1 + 0.5 (1.2 - h_fP/m_n)) (1 - 0.02 (20 deg - alpha)).
    """
    return (1.0 + 0.5 * (1.2 - dedendum)) * (1.0 - 0.02 * (20.0 - jnp.rad2deg(pressure_angle)))


def blank_factor(
    *, web_ratio: Float[Array, "*b"], rim_thickness_ratio: Float[Array, "*b"]
) -> Float[Array, "*b"]:
    """Gear blank factor C_R of a gear with rim and web; 1 for a solid one.

    Args:
        web_ratio: thickness of the web over face width, counted as 0.2 to 1.2.
        rim_thickness_ratio: thickness of the rim over normal module, counted as at least 1.

    Source: ISO 6336-1:2006, C_R = 1 + ln(b_s/b)/(5 exp(s_R/(5 m_n))).
    """
    web = jnp.clip(web_ratio, 0.2, 1.2)
    rim = jnp.maximum(rim_thickness_ratio, 1.0)
    return 1.0 + jnp.log(web) / (5.0 * jnp.exp(rim / 5.0))


def single_stiffness(
    *,
    virtual_teeth: Float[Array, "2"],
    profile_shift: Float[Array, "2"],
    helix_angle: Float[Array, ""],
    young: Float[Array, "2"],
    rack: Float[Array, ""],
    blank: Float[Array, ""],
    specific_load: Float[Array, ""],
) -> Float[Array, ""]:
    """Largest stiffness c' of one pair of teeth, per width and in the transverse section [N/m2].

    Args:
        virtual_teeth, profile_shift: see `pair_compliance`.
        helix_angle: beta on the reference cylinder [rad].
        young: Young's moduli; both members count with 2 E_1 E_2/(E_1 + E_2) [Pa].
        rack: C_B, see `rack_factor`.
        blank: C_R, see `blank_factor`.
        specific_load: K_A F_t/b [N/m]; below 100 N/mm the stiffness falls with its fourth root.

    Returns:
        c'; multiply by 1e-9 for N/(mm um).

    Source: ISO 6336-1:2006, method B.
    """
    theory = 1.0 / pair_compliance(virtual_teeth=virtual_teeth, profile_shift=profile_shift)
    material = 2.0 * young[0] * young[1] / (young[0] + young[1]) / STEEL_MODULUS
    load = jnp.clip(specific_load / _FULL_LOAD, _LEAST_LOAD / _FULL_LOAD, 1.0) ** 0.25
    return _CORRECTION * rack * blank * jnp.cos(helix_angle) * material * load * theory


def mesh_stiffness_alpha(
    *, single: Float[Array, "*b"], contact_ratio: Float[Array, "*b"]
) -> Float[Array, "*b"]:
    """Mean stiffness c_gamma_alpha of a mesh, per width [N/m2].

    Args:
        single: c' of one pair [N/m2].
        contact_ratio: transverse contact ratio eps_alpha; below 1.2 up to 10 % too stiff.

    Source: ISO 6336-1:2006, c_gamma_alpha = c' (0.75 eps_alpha + 0.25).
    """
    return single * (0.75 * contact_ratio + 0.25)


def mesh_stiffness_beta(*, alpha: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Stiffness c_gamma_beta for the load across the face [N/m2], 0.85 c_gamma_alpha.

    Args:
        alpha: c_gamma_alpha [N/m2].

    Source: ISO 6336-1:2006.
    """
    return 0.85 * alpha


def estimate(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    load: Float[Array, ""],
) -> tuple[dict[str, float], tuple[str, ...]]:
    """Stiffness of a pair of solid gears by the standard, and where it lies outside what that covers.

    Args:
        mesh: any family; none but external cylindrical pairs have an estimate.
        loaded: one for the coordinate that carries the load, zero elsewhere.
        solids: materials.
        load: that the loaded coordinate carries [N m].

    Returns:
        c' and c_gamma_alpha over the whole face width [N/m] under their names, and sentences.

    Source: ISO 6336-1:2006, method B.
    """
    if eqx.filter_eval_shape(standard_pair, mesh) is None:
        return {}, ()
    found, single, total = jax.device_get(_estimate(mesh, loaded, solids, load))
    warnings = range_warnings(
        virtual_teeth=(float(found.virtual_teeth[0]), float(found.virtual_teeth[1])),
        profile_shift=(float(found.profile_shift[0]), float(found.profile_shift[1])),
        helix_angle=float(found.helix_angle),
        contact_ratio=float(found.transverse_contact_ratio),
    )
    return {
        "standard_single_stiffness": float(single),
        "standard_stiffness": float(total),
    }, warnings


@program
def _estimate(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    load: Float[Array, ""],
) -> tuple[StandardPair, Float[Array, ""], Float[Array, ""]]:
    pair = standard_pair(mesh)
    assert pair is not None
    pinion_first = jnp.argsort(pair.virtual_teeth)
    pair = replace(
        pair,
        virtual_teeth=pair.virtual_teeth[pinion_first],
        profile_shift=pair.profile_shift[pinion_first],
    )
    single = single_stiffness(
        virtual_teeth=pair.virtual_teeth,
        profile_shift=pair.profile_shift,
        helix_angle=pair.helix_angle,
        young=jnp.stack([solid.young for solid in solids]),
        rack=rack_factor(dedendum=jnp.mean(pair.dedendum), pressure_angle=pair.pressure_angle),
        blank=jnp.asarray(1.0),
        specific_load=load / jnp.sum(loaded * pair.reference_radii) / pair.face_width,
    )
    total = mesh_stiffness_alpha(single=single, contact_ratio=pair.transverse_contact_ratio)
    return pair, single * pair.face_width, total * pair.face_width


def range_warnings(
    *,
    virtual_teeth: tuple[float, float],
    profile_shift: tuple[float, float],
    helix_angle: float,
    contact_ratio: float,
    internal: bool = False,
) -> tuple[str, ...]:
    """Sentences on where a pair lies outside what the estimate covers; none if it does not.

    Args:
        virtual_teeth, profile_shift: see `pair_compliance`.
        helix_angle: beta [rad].
        contact_ratio: transverse contact ratio eps_alpha.
        internal: True if the wheel is a ring.

    Source: ISO 6336-1:2006, method B, what it says of its range.
    """
    # Without the last bits, which the conversion of units makes.
    values = [
        round(value, 9) for value in (contact_ratio, math.degrees(helix_angle), sum(profile_shift))
    ]
    found = [
        Doubt(
            f"a {text.format(value)} for which ISO 6336-1 gives its estimate of the stiffness",
            moves=REMARKED,
            brief=f"ISO 6336-1 has no stiffness for a {name} of {value:.4g}",
        )
        for (text, low, high, name), value in zip(_RANGES, values, strict=True)
        if not low <= value <= high
    ]
    if profile_shift[0] < profile_shift[1]:
        found.append(
            Doubt("ISO 6336-1 gives its estimate of the stiffness for x1 >= x2", moves=REMARKED)
        )
    if min(virtual_teeth) < _FEWEST_TEETH:
        few = _yielding(virtual_teeth, profile_shift)
        fewest = _yielding([max(z, _FEWEST_TEETH) for z in virtual_teeth], profile_shift)
        found.append(
            Doubt(
                f"{min(virtual_teeth):.3g} virtual teeth are fewer than the {_FEWEST_TEETH} down to which "
                "the estimate of ISO 6336-1 was compared with published results; its compliance differs by "
                f"{in_percent(abs(few / fewest - 1.0))} from that at the limit",
                moves=min(abs(few / fewest - 1.0), REMARKED),  # of what stands beside the answer
                brief=f"{min(virtual_teeth):.3g} virtual teeth: ISO 6336-1 ends at {_FEWEST_TEETH}",
            )
        )
    if internal:
        found.append(
            Doubt(
                "the estimate of ISO 6336-1 is written here for external gears only", moves=REMARKED
            )
        )
    return tuple(found)
