"""Forces, stresses and safeties of one cylindrical pair, from its dimensions, duty, factors and materials."""

import dataclasses
from math import nan
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Arrays
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.rated_pair import RatedPair
from pitchpoint.materials.solids import Solid
from pitchpoint.programs import program
from pitchpoint.strength import flank, limits, load_factors, root, vdi_2736
from pitchpoint.strength.forces import ToothForces, tooth_forces

__all__ = ["ROWS", "Duty", "Factors", "Finish", "Strengths", "rate", "rated", "ratings"]

ROWS = 64
"""Pairs that are rated together: one compiled program serves any number of them."""

_SHARPEST = 1e-3
"""Radius in modules of a ring's fillet without one: its notch lies beyond the standard, and is told."""

Both = Float[Arrays, "2"]
One = Float[Arrays, ""]
Rating = dict[str, Float[Array, "..."]]


class Duty(eqx.Module):
    """What a pair has to bear.

    Attributes:
        load: torque on the driven gear [N m].
        speed: of the driving gear [rad/s].
        cycles_flank, cycles_root: load cycles of both gears that their life factors count, without a life.
        life: time under load, whose cycles count [s]; not a number where none is asked.
    """

    load: One
    speed: One
    cycles_flank: Both
    cycles_root: Both
    life: One = eqx.field(default_factory=lambda: np.array(nan))


class Factors(eqx.Module):
    """Factors on the load; one that is not a number follows from the others.

    Attributes:
        application: K_A.
        dynamic: K_v; follows by method C.
        face, transverse: K_Hbeta, K_Halpha.
        root_face, root_transverse: K_Fbeta, follows from K_Hbeta; K_Falpha, follows as K_Halpha.
        spur, helical: K_1 of the class of the gears, for method C.
        accurate: 1 for class 4 or better, else 0.
        correction: f_ZCa of helical gears.
    """

    application: One
    dynamic: One
    face: One
    transverse: One
    root_face: One
    root_transverse: One
    spur: One
    helical: One
    accurate: One
    correction: One


class Strengths(eqx.Module):
    """Materials of both gears, and what they bear.

    Attributes:
        solids: elastic constants.
        flank, root: sigma_Hlim and sigma_Flim [Pa]; not a number where they are not known.
        constants: of their treatments.
        plastic: True for a gear that is rated by VDI 2736.
        work_hardening: Z_W.
        mean_stress: factor on sigma_Flim of teeth that are loaded both ways.
        over_cycles: sigma_Flim of plastics that is not given, s_0 + s_N/N^r and at most s_1: s_0, s_N [Pa],
            r, s_1 [Pa]; not a number where it is not known.
    """

    solids: tuple[Solid, Solid]
    flank: Both
    root: Both
    constants: limits.Constants
    plastic: Bool[Arrays, "2"]
    work_hardening: Both
    mean_stress: Both
    over_cycles: Float[Arrays, "4 2"]


class Finish(eqx.Module):
    """How the teeth are finished, and the oil.

    Attributes:
        thickness: allowance of the normal tooth thickness of both gears, 0 for nominal teeth [m].
        flank: mean Rz of both flanks [m].
        root: Rz of the root fillets of both gears [m].
        viscosity: nu_40 of the oil [m2/s].
    """

    thickness: Both
    flank: One
    root: Both
    viscosity: One


@program
def ratings(*rows: Any) -> Rating:
    """The ratings of some meshes, see `rated`.

    Args:
        rows: what `rated` takes, each with an axis of pairs in front.
    """
    found: Rating = eqx.filter_vmap(rated)(*rows)
    return found


def rated(
    mesh: Mesh,
    path_ends: Both,
    duty: Duty,
    factors: Factors,
    strengths: Strengths,
    finish: Finish,
) -> Rating:
    """The rating of a mesh, see `rate`.

    Args:
        mesh: with a `rated_pair`, bare.
        path_ends: of the pair as it runs, see `RatedPair`; not a number where those of the bare mesh are it.
        duty, factors, strengths, finish: as `rate` takes them.
    """
    pair = mesh.rated_pair
    pair = dataclasses.replace(pair, path_ends=_or(path_ends, pair.path_ends))
    reference = jnp.abs(pair.reference_radii)
    force = duty.load / jnp.sum(mesh.loaded * reference)
    speed = duty.speed * jnp.abs(mesh.motion[0]) * reference[0]
    return rate(pair, force, speed, _counted(mesh, duty), factors, strengths, finish)


def _counted(mesh: Mesh, duty: Duty) -> Duty:
    """The duty with the cycles of the life that is asked."""
    endless = jnp.isnan(duty.life)
    turns = jnp.abs(mesh.motion) * duty.speed * jnp.where(endless, 0.0, duty.life) / (2.0 * jnp.pi)
    flank, root = (jnp.where(endless, one, turns) for one in (duty.cycles_flank, duty.cycles_root))
    return dataclasses.replace(duty, cycles_flank=flank, cycles_root=root)


def rate(
    pair: RatedPair,
    force: One,
    speed: One,
    duty: Duty,
    factors: Factors,
    strengths: Strengths,
    finish: Finish,
) -> Rating:
    """Forces, stresses, limits and safeties of a pair.

    Pure: it can be traced, vectorised and differentiated; `jax.vmap` rates a batch.

    Args:
        pair: dimensions.
        force: F_t tangential to the reference circles [N].
        speed: v at the reference circles [m/s].
        duty: cycles count.
        factors: on the load.
        strengths: of the materials.
        finish: of the surfaces.

    Returns:
        Values by the names of `results.strength.STRENGTH`, for the pair or for both gears [SI].

    Source: ISO 6336-2:2019 and ISO 6336-3:2019, methods B, dynamic factor by method C; VDI 2736 Part 2 for
    the roots of plastic gears.
    """
    forces = _forces(pair, force)
    k = _load_factors(pair, forces, speed, factors)
    found = {**_told(forces), **k}
    found |= _flank(pair, forces, speed, k, factors, strengths, finish, duty)
    return found | _root(pair, forces, k, factors, strengths, finish, duty)


def _forces(pair: RatedPair, force: One) -> ToothForces:
    return tooth_forces(
        reference=force,
        radius_ratio=jnp.abs(pair.reference_radii[0] / pair.working_radii[0]),
        transverse_pressure_angle=pair.transverse_pressure_angle,
        working_pressure_angle=pair.working_pressure_angle,
        helix_angle=pair.helix_angle,
        base_helix_angle=pair.base_helix_angle,
    )


def _told(forces: ToothForces) -> Rating:
    return {
        "reference_force": forces.reference,
        "tangential_force": forces.tangential,
        "radial_force": forces.radial,
        "axial_force": forces.axial,
        "normal_force": forces.normal,
    }


def _load_factors(pair: RatedPair, forces: ToothForces, speed: One, factors: Factors) -> Rating:
    teeth = jnp.sort(jnp.abs(pair.teeth))
    resonance = load_factors.resonance_number(
        speed=speed, teeth=teeth[0], ratio=teeth[1] / teeth[0]
    )
    dynamic = load_factors.dynamic_factor(
        resonance=resonance,
        line_load=factors.application * forces.reference / pair.face_width,
        overlap_ratio=pair.overlap_ratio,
        spur=factors.spur,
        helical=factors.helical,
    )
    root_face = load_factors.root_face_load_factor(
        flank=factors.face, face_width=pair.face_width, height=jnp.max(_heights(pair))
    )
    return {
        "resonance_number": resonance,
        "application_factor": factors.application,
        "rated_dynamic_factor": _or(factors.dynamic, dynamic),
        "face_load_factor": factors.face,
        "transverse_load_factor": factors.transverse,
        "root_face_load_factor": _or(factors.root_face, root_face),
        "root_transverse_load_factor": _or(factors.root_transverse, factors.transverse),
    }


def _or(given: Arrays, following: Arrays) -> Arrays:
    return jnp.where(jnp.isnan(given), following, given)


def _heights(pair: RatedPair) -> Both:
    return jnp.abs(pair.tip_radii - pair.root_radii)


def _flank(
    pair: RatedPair,
    forces: ToothForces,
    speed: One,
    k: Rating,
    factors: Factors,
    strengths: Strengths,
    finish: Finish,
    duty: Duty,
) -> Rating:
    found = _nominal_contact(pair, forces, strengths)
    found["single_contact_factor"] = single = _single_contact(pair, factors, strengths)
    load = k["application_factor"] * k["rated_dynamic_factor"]
    load *= k["face_load_factor"] * k["transverse_load_factor"]
    stress = single * found["nominal_contact_stress"] * jnp.sqrt(load)
    limiting = _flank_factors(pair, speed, strengths, finish, duty)
    limit = strengths.flank * _product(limiting)
    return {
        **found,
        **limiting,
        "flank_endurance": strengths.flank,
        "flank_cycles": jnp.where(strengths.plastic, jnp.nan, duty.cycles_flank),
        "contact_stress": stress,
        "contact_limit": limit,
        "flank_safety": limit / stress,
    }


def _product(factors: Rating) -> Both:
    return jnp.prod(jnp.stack([jnp.broadcast_to(one, 2) for one in factors.values()]), axis=0)


def _nominal_contact(pair: RatedPair, forces: ToothForces, strengths: Strengths) -> Rating:
    first, second = strengths.solids
    parts = {
        "zone_factor": flank.zone_factor(
            base_helix_angle=pair.base_helix_angle,
            transverse_pressure_angle=pair.transverse_pressure_angle,
            working_pressure_angle=pair.working_pressure_angle,
        ),
        "elasticity_factor": flank.elasticity_factor(
            young_1=first.young,
            poisson_1=first.poisson,
            young_2=second.young,
            poisson_2=second.poisson,
        ),
        "contact_ratio_factor": flank.contact_ratio_factor(
            transverse_contact_ratio=pair.transverse_contact_ratio,
            overlap_ratio=pair.overlap_ratio,
        ),
        "helix_factor": flank.helix_factor(helix_angle=pair.helix_angle),
    }
    zone, elasticity, contact_ratio, helix = parts.values()
    stress = flank.nominal_contact_stress(
        zone=zone,
        elasticity=elasticity,
        contact_ratio=contact_ratio,
        helix=helix,
        force=forces.reference,
        diameter=2.0 * pair.reference_radii[0],
        face_width=pair.face_width,
        ratio=pair.teeth[1] / pair.teeth[0],
    )
    shown = {"elasticity_factor": elasticity / 1e3}  # sqrt(N/mm2), which has no name in SI
    return {**parts, **shown, "nominal_contact_stress": stress}


def _single_contact(pair: RatedPair, factors: Factors, strengths: Strengths) -> Both:
    """Z_B and Z_D; 1 for a ring and for plastic gears, whose pressure is that of the pitch point."""
    found = flank.single_contact_factor(
        own_end=pair.end_slopes,
        own_teeth=pair.teeth,
        other_end=pair.end_slopes[::-1],
        other_teeth=pair.teeth[::-1],
        working_pressure_angle=pair.working_pressure_angle,
        transverse_contact_ratio=pair.transverse_contact_ratio,
        overlap_ratio=pair.overlap_ratio,
        correction=factors.correction,
    )
    return jnp.where((pair.teeth < 0.0) | strengths.plastic, 1.0, found)


def _flank_factors(
    pair: RatedPair, speed: One, strengths: Strengths, finish: Finish, duty: Duty
) -> Rating:
    metal = ~strengths.plastic
    softer = jnp.nanmin(jnp.where(metal, strengths.flank, jnp.nan))
    rolling = pair.base_radii * jnp.tan(pair.working_pressure_angle)
    level, few, many = strengths.constants.flank
    first, slope, least = strengths.constants.flank_size
    share = limits.endurance_share(cycles=duty.cycles_flank, few=few, many=many)
    found = {
        "lubricant_factor": flank.lubricant_factor(viscosity=finish.viscosity, limit=softer),
        "velocity_factor": flank.velocity_factor(speed=speed, limit=softer),
        "roughness_factor": flank.roughness_factor(
            roughness=finish.flank, radius=jnp.prod(rolling) / jnp.sum(rolling), limit=softer
        ),
        "flank_size_factor": flank.size_factor(module=pair.module, a=first, b=slope, least=least),
    }
    found = {
        name: limits.at_life(endurance=one, static=1.0, share=share) for name, one in found.items()
    }
    life = limits.life_factor(cycles=duty.cycles_flank, level=level, few=few, many=many)
    found |= {"flank_life_factor": life, "work_hardening_factor": strengths.work_hardening}
    return {name: jnp.where(metal, one, 1.0) for name, one in found.items()}


def _root(
    pair: RatedPair,
    forces: ToothForces,
    k: Rating,
    factors: Factors,
    strengths: Strengths,
    finish: Finish,
    duty: Duty,
) -> Rating:
    shape, dimensions = _tooth_form(_cut(pair, finish), strengths)
    shape |= _root_factors(pair, factors, strengths)
    nominal = root.nominal_root_stress(
        force=forces.reference,
        face_width=pair.face_width,
        module=pair.module,
        factors=_product(shape),
    )
    load = k["application_factor"] * k["rated_dynamic_factor"]
    load *= k["root_face_load_factor"] * k["root_transverse_load_factor"]
    stress = nominal * load
    notch = dimensions["notch_parameter"], shape["stress_correction_factor"]
    limiting = _root_limit_factors(pair, notch, strengths, finish, duty)
    endurance, counted = _root_endurance(strengths, duty)
    limit = endurance * limits.STRESS_CORRECTION * _product(limiting)
    return {
        **dimensions,
        **shape,
        **limiting,
        "rim_backup": _backup(pair),
        "root_endurance": endurance,
        "root_cycles": jnp.where(counted, duty.cycles_root, jnp.nan),
        "nominal_root_stress": nominal,
        "root_stress": stress,
        "root_limit": limit,
        "root_safety": limit / stress,
    }


def _root_endurance(strengths: Strengths, duty: Duty) -> tuple[Both, Bool[Arrays, "2"]]:
    """sigma_Flim, of plastics by their cycles unless it is given; where cycles count."""
    endless, of_cycles, power, most = strengths.over_cycles
    curve = jnp.clip(endless + of_cycles / duty.cycles_root**power, 0.0, most)
    by_cycles = jnp.isnan(strengths.root) & strengths.plastic & ~jnp.isnan(curve)
    return jnp.where(by_cycles, curve, strengths.root), ~strengths.plastic | by_cycles


def _cut(pair: RatedPair, finish: Finish) -> RatedPair:
    """The pair with the shifts x_E with which its teeth are cut, x + A_sn/(2 m_n tan(alpha_n)).

    The teeth of a ring are thinner at their root by the allowance itself, on the fillet that they have.
    """
    thinner = finish.thickness / (2.0 * pair.module * jnp.tan(pair.pressure_angle))
    half = pair.ring_section[0] + jnp.where(pair.teeth[1] < 0.0, 0.5 * finish.thickness[1], 0.0)
    return dataclasses.replace(
        pair,
        profile_shift=pair.profile_shift + thinner,
        ring_section=pair.ring_section.at[0].set(half),
    )


def _virtual(pair: RatedPair) -> tuple[Both, One]:
    """Numbers of teeth and contact ratio of the virtual gears in the normal section."""
    slope = jnp.cos(pair.base_helix_angle) ** 2
    teeth = pair.teeth / (slope * jnp.cos(pair.helix_angle))
    return teeth, pair.transverse_contact_ratio / slope


def _tooth_form(pair: RatedPair, strengths: Strengths) -> tuple[Rating, Rating]:
    """Y_F with f_eps and Y_S, or Y_Fa and Y_Sa of plastic gears, and the dimensions behind them."""
    teeth, ratio = _virtual(pair)
    section = _sections(pair, teeth)
    end = jnp.where(strengths.plastic, pair.tip_radii, pair.end_radii)
    load = root.load_point(
        virtual_teeth=teeth,
        module=pair.module,
        pressure_angle=pair.pressure_angle,
        profile_shift=pair.profile_shift,
        end_height=end - pair.reference_radii,
        base_pitches=jnp.where(strengths.plastic, 0.0, ratio - 1.0),
    )
    form = root.form_factor(
        section=section, load=load, module=pair.module, pressure_angle=pair.pressure_angle
    )
    several = root.load_distribution_factor(
        virtual_contact_ratio=ratio, overlap_ratio=pair.overlap_ratio
    )
    dimensions = {
        "root_chord": section.chord,
        "bending_arm": root.bending_arm(section, load),
        "load_angle": load.angle,
        "root_fillet_radius": section.fillet_radius,
        "notch_parameter": root.notch_parameter(section),
    }
    factors = {
        "form_factor": form * jnp.where(strengths.plastic, 1.0, several),
        "stress_correction_factor": root.stress_correction_factor(section=section, load=load),
    }
    return factors, dimensions


def _sections(pair: RatedPair, teeth: Both) -> root.RootSection:
    """Sections of both gears: as a rack cuts them, as measured where gear 2 is a ring."""
    cut = root.rack_section(
        virtual_teeth=jnp.abs(teeth),
        module=pair.module,
        pressure_angle=pair.pressure_angle,
        dedendum=pair.dedendum,
        tip_radius=pair.fillet_radius,
        generating_shift=pair.profile_shift,
    )
    half, distance, radius = pair.ring_section
    ring = root.ring_section(
        half_chord=half,
        distance=distance,
        fillet_radius=jnp.maximum(radius, _SHARPEST * pair.module),
    )
    is_ring = pair.teeth < 0.0
    return root.RootSection(
        jnp.where(is_ring, ring.chord, cut.chord),
        jnp.where(is_ring, ring.distance, cut.distance),
        jnp.where(is_ring, ring.fillet_radius, cut.fillet_radius),
    )


def _root_factors(pair: RatedPair, factors: Factors, strengths: Strengths) -> Rating:
    """Y_beta, Y_B, Y_DT; Y_eps in the place of the last of plastic gears, whose force is at the tip."""
    _, ratio = _virtual(pair)
    skew = {"helix_angle": pair.helix_angle, "overlap_ratio": pair.overlap_ratio}
    backup = _backup(pair)
    rim = jnp.where(
        pair.teeth < 0.0, root.ring_rim_factor(backup=backup), root.rim_factor(backup=backup)
    )
    deep = root.deep_tooth_factor(virtual_contact_ratio=ratio, accurate=factors.accurate)
    several = vdi_2736.contact_ratio_factor(virtual_contact_ratio=ratio)
    plastic = strengths.plastic
    return {
        "root_helix_factor": jnp.where(
            plastic, vdi_2736.helix_factor(**skew), root.helix_factor(**skew)
        ),
        "rim_factor": jnp.where(plastic, 1.0, rim),
        "root_contact_ratio_factor": jnp.where(plastic, several, deep),
    }


def _backup(pair: RatedPair) -> Both:
    """Rim thickness over tooth height, of a ring over the module."""
    return pair.rim_thickness / jnp.where(pair.teeth < 0.0, pair.module, _heights(pair))


def _root_limit_factors(
    pair: RatedPair,
    notch: tuple[Both, Both],
    strengths: Strengths,
    finish: Finish,
    duty: Duty,
) -> Rating:
    """Factors at the number of cycles, from q_s and Y_S of both gears."""
    own, metal = strengths.constants, ~strengths.plastic
    level, few, many = own.root
    a, b, n, smooth = own.surface
    first, slope, least = own.root_size
    share = limits.endurance_share(cycles=duty.cycles_root, few=few, many=many)
    parameter, correction = notch
    notched = limits.notch_sensitivity_factor(notch=parameter, slip_layer=own.slip_layer)
    static = limits.static_notch_sensitivity_factor(
        stress_correction=correction, slope=own.static_notch
    )
    surface = limits.surface_factor(roughness=finish.root, a=a, b=b, n=n, smooth=smooth)
    size = limits.size_factor(module=pair.module, a=first, b=slope, least=least)
    found = {
        "root_life_factor": limits.life_factor(
            cycles=duty.cycles_root, level=level, few=few, many=many
        ),
        "notch_sensitivity_factor": limits.at_life(endurance=notched, static=static, share=share),
        "surface_factor": limits.at_life(endurance=surface, static=1.0, share=share),
        "root_size_factor": limits.at_life(endurance=size, static=1.0, share=share),
    }
    found = {name: jnp.where(metal, one, 1.0) for name, one in found.items()}
    return {**found, "mean_stress_factor": strengths.mean_stress}
