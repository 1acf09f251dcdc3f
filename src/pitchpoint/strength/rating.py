"""Forces, stresses and safeties of one cylindrical pair, from its dimensions, duty, factors and materials."""

import dataclasses
from math import nan
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import program
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import nominal_motion
from pitchpoint.gears.rated_pair import RatedPair, rated_pair
from pitchpoint.loading import iso_6336_stiffness
from pitchpoint.materials.solids import Solid
from pitchpoint.strength import flank, limits, load_factors, root, vdi_2736
from pitchpoint.strength.forces import ToothForces, tooth_forces

__all__ = ["ROWS", "Duty", "Factors", "Finish", "Strengths", "rate", "rated", "ratings"]

ROWS = 64
"""Pairs that are rated together: one compiled program serves any number of them."""

_SHARPEST = 1e-3
"""Radius in modules of a ring's fillet without one: its notch lies beyond the standard, and is told."""

_SOUND = {
    "virtual_teeth": 90.0,
    "module": 1e-3,
    "pressure_angle": 0.35,
    "dedendum": 1.25,
    "tip_radius": 0.2,
    "generating_shift": 0.0,
}
"""A ring whose formulas have values and derivatives, in the place of gears for which they do not count."""

Both = Float[Arrays, "2"]
One = Float[Arrays, ""]
Rating = dict[str, Float[Array, "..."]]


class Duty(eqx.Module):
    """What a pair has to bear.

    Attributes:
        load: torque on the driven gear [N m].
        speed: of the driving gear [rad/s].
        cycles_flank, cycles_root: load cycles of both gears that their life factors count, without a life.
        driver: one for the gear that drives, zero for the other one.
        life: time under load, whose cycles count [s]; not a number where none is asked.
        engagements: of a tooth of each gear in one turn of it.
    """

    load: One
    speed: One
    cycles_flank: Both
    cycles_root: Both
    driver: Both
    life: One = eqx.field(default_factory=lambda: np.array(nan))
    engagements: Both = eqx.field(default_factory=lambda: np.ones(2))


class Factors(eqx.Module):
    """Factors on the load; one that is not a number follows from the others.

    Attributes:
        application: K_A.
        dynamic: K_v; follows by method B or C.
        face, transverse: K_Hbeta, which follows by method C; K_Halpha.
        root_face, root_transverse: K_Fbeta, follows from K_Hbeta; K_Falpha, follows as K_Halpha.
        spur, helical: K_1 of the class of the gears, for method C.
        accurate: 1 for class 4 or better, else 0.
        correction: f_ZCa of helical gears.
        before_2019: 1 for the edition of 2006, else 0.
        method_b: 1 for K_v by method B, else 0.
        deviations: f_pb and f_falpha, the larger of both gears, for method B; not numbers without it [m].
        relief: C_a for method B; not a number for classes from 6 on [m].
        shaft: l, s and d_sh of the pinion, see `pinion_misalignment`; not numbers without it [m].
        helix_slopes: f_Hbeta of both gears; not numbers without a shaft [m].
        misalignment: f_ma of the flanks; not a number where it is that of helix slopes [m].
        soft: 1 for through-hardened and normalised gears, which run in further.
        mesh_load: K_gamma.

    Source: ISO 6336-1:2006, factors on the load.
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
    before_2019: One = eqx.field(default_factory=lambda: np.zeros(()))
    method_b: One = eqx.field(default_factory=lambda: np.zeros(()))
    deviations: Both = eqx.field(default_factory=lambda: np.full(2, nan))
    relief: One = eqx.field(default_factory=lambda: np.array(nan))
    shaft: Float[Arrays, "3"] = eqx.field(default_factory=lambda: np.full(3, nan))
    helix_slopes: Both = eqx.field(default_factory=lambda: np.full(2, nan))
    misalignment: One = eqx.field(default_factory=lambda: np.array(nan))
    soft: Both = eqx.field(default_factory=lambda: np.zeros(2))
    mesh_load: One = eqx.field(default_factory=lambda: np.ones(()))

    @property
    def on_load(self) -> One:
        """K_A K_gamma, by which the line load counts for the other load factors."""
        return self.application * self.mesh_load


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
        mesh: of which there is a `rated_pair`, `bare_pair`.
        path_ends: of the pair as it runs, see `RatedPair`; not a number where those of the bare mesh are it.
        duty, factors, strengths, finish: as `rate` takes them.

    Source: ISO 6336-2:2019 and ISO 6336-3:2019, see `rate`.
    """
    pair = rated_pair(mesh)
    pair = dataclasses.replace(pair, path_ends=_or(path_ends, pair.path_ends))
    reference = jnp.abs(pair.reference_radii)
    force = duty.load / jnp.sum((1.0 - duty.driver) * reference)
    motion = nominal_motion(mesh, duty.driver, 1.0 - duty.driver)
    speed = duty.speed * jnp.abs(motion[0]) * reference[0]
    return rate(pair, force, speed, _counted(motion, duty), factors, strengths, finish)


def _counted(motion: Float[Array, "2"], duty: Duty) -> Duty:
    """The duty with the cycles of the life that is asked."""
    endless = jnp.isnan(duty.life)
    turns = jnp.abs(motion) * duty.speed * jnp.where(endless, 0.0, duty.life) / (2.0 * jnp.pi)
    counted = turns * duty.engagements
    flank, root = (
        jnp.where(endless, many, counted) for many in (duty.cycles_flank, duty.cycles_root)
    )
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
        Values by the names of `results.strength_variables.STRENGTH`, for the pair or for both gears [SI].

    Source: ISO 6336-2 and ISO 6336-3, editions of 2019 or 2006, methods B; ISO 6336-1:2006, dynamic factor by
    method B or C and face load factor by method C; VDI 2736 Part 2 for the roots of plastic gears.
    """
    forces = _forces(pair, force)
    k = _load_factors(pair, forces, speed, factors, strengths)
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


def _load_factors(
    pair: RatedPair, forces: ToothForces, speed: One, factors: Factors, strengths: Strengths
) -> Rating:
    dynamic, by_method = _dynamic(pair, forces, speed, factors, strengths)
    used = _or(factors.dynamic, by_method)
    misalignment, face = _across_the_face(pair, forces, speed, used, factors, strengths)
    face = _or(factors.face, face)
    root_face = load_factors.root_face_load_factor(
        flank=face, face_width=pair.face_width, height=jnp.max(_heights(pair))
    )
    return {
        **dynamic,
        "application_factor": factors.application,
        "mesh_load_factor": factors.mesh_load,
        "rated_dynamic_factor": used,
        "face_misalignment": misalignment,
        "face_load_factor": face,
        "transverse_load_factor": factors.transverse,
        "root_face_load_factor": _or(factors.root_face, root_face),
        "root_transverse_load_factor": _or(factors.root_transverse, factors.transverse),
    }


def _dynamic(
    pair: RatedPair, forces: ToothForces, speed: One, factors: Factors, strengths: Strengths
) -> tuple[Rating, One]:
    """K_v by both methods where B is asked for, the speeds against resonance of each, and K_v that counts."""
    teeth = jnp.sort(jnp.abs(pair.teeth))
    resonance = load_factors.resonance_number(
        speed=speed, teeth=teeth[0], ratio=teeth[1] / teeth[0]
    )
    line_load = factors.on_load * forces.reference / pair.face_width
    by_c = load_factors.dynamic_factor(
        resonance=resonance,
        line_load=line_load,
        overlap_ratio=pair.overlap_ratio,
        spur=factors.spur,
        helical=factors.helical,
    )
    single, total = _stiffness(pair, line_load, strengths)
    frequency = speed / jnp.abs(pair.reference_radii[0]) * jnp.abs(pair.teeth[0])
    ratio = frequency / jnp.sqrt(total / _reduced_mass(pair, strengths))
    pitch, profile = (
        one - _running_in(one, speed, factors, strengths) for one in _known(factors.deviations, 0.0)
    )
    by_b = load_factors.dynamic_factor_by_resonance(
        resonance_ratio=ratio,
        line_load=line_load,
        contact_ratio=pair.transverse_contact_ratio + pair.overlap_ratio,
        stiffness=single,
        pitch=pitch,
        profile=profile,
        relief=factors.relief,
    )
    asked = factors.method_b > 0.0
    both = {"resonance_ratio": ratio, "dynamic_factor_b": by_b, "dynamic_factor_c": by_c}
    shown = {name: jnp.where(asked, value, jnp.nan) for name, value in both.items()}
    return {"resonance_number": resonance, **shown}, jnp.where(asked, by_b, by_c)


def _stiffness(pair: RatedPair, line_load: One, strengths: Strengths) -> tuple[One, One]:
    """Stiffnesses c' and c_gamma_alpha of solid gears per width [N/m2]; a ring counts as a rack."""
    teeth = jnp.where(pair.teeth < 0.0, jnp.inf, _virtual(pair)[0])
    pinion_first = jnp.argsort(teeth)
    single = iso_6336_stiffness.single_stiffness(
        virtual_teeth=teeth[pinion_first],
        profile_shift=pair.profile_shift[pinion_first],
        helix_angle=pair.helix_angle,
        young=jnp.stack([one.young for one in strengths.solids]),
        rack=iso_6336_stiffness.rack_factor(
            dedendum=jnp.mean(pair.dedendum), pressure_angle=pair.pressure_angle
        ),
        blank=jnp.ones(()),
        specific_load=line_load,
    )
    total = iso_6336_stiffness.mesh_stiffness_alpha(
        single=single, contact_ratio=pair.transverse_contact_ratio
    )
    return single, total


def _reduced_mass(pair: RatedPair, strengths: Strengths) -> One:
    """Of both gears, as solid as they are; per width [kg/m]."""
    roots = jnp.abs(pair.root_radii)
    return load_factors.reduced_mass_per_width(
        mean_radii=(jnp.abs(pair.tip_radii) + roots) / 2.0,
        inner_radii=roots + jnp.where(pair.teeth < 0.0, 1.0, -1.0) * pair.rim_thickness,
        base_radii=pair.base_radii,
        density=jnp.stack([one.density for one in strengths.solids]),
    )


def _running_in(deviation: One, speed: One, factors: Factors, strengths: Strengths) -> One:
    """Mean of the allowances of both gears for one deviation."""
    both = load_factors.running_in(
        deviation=deviation, limit=strengths.flank, soft=factors.soft, speed=speed
    )
    return jnp.mean(both)


def _across_the_face(
    pair: RatedPair,
    forces: ToothForces,
    speed: One,
    dynamic: One,
    factors: Factors,
    strengths: Strengths,
) -> tuple[One, One]:
    """Misalignment F_betay and K_Hbeta by method C; not numbers where the shaft is not known."""
    outer = factors.on_load * forces.reference / pair.face_width
    line_load = outer * dynamic
    span, offset, diameter = _known(factors.shaft, 1.0)
    slopes = _known(factors.helix_slopes, 1e-6)
    bent = load_factors.pinion_misalignment(
        line_load=line_load,
        face_width=pair.face_width,
        diameter=2.0 * jnp.min(jnp.abs(pair.reference_radii)),
        span=span,
        offset=offset,
        shaft_diameter=diameter,
    )
    of_classes = jnp.sqrt(jnp.sum(slopes**2))
    made = jnp.abs(_or(factors.misalignment, of_classes))  # f_ma, on the side of the bending
    least = jnp.maximum(5e-12 * line_load, 0.5 * jnp.max(slopes))
    whole = jnp.maximum(1.33 * bent + made, least)
    left = whole - jnp.minimum(2.0 * _running_in(whole, speed, factors, strengths), whole)
    _, total = _stiffness(pair, outer, strengths)
    face = load_factors.face_load_factor(
        misalignment=left,
        stiffness=iso_6336_stiffness.mesh_stiffness_beta(alpha=total),
        line_load=line_load,
    )
    asked = ~jnp.isnan(factors.shaft[0])
    return jnp.where(asked, left, jnp.nan), face


def _known(values: Arrays, instead: float) -> Array:
    """Values with a number in the place of none: what nobody asks for has derivatives too."""
    return jnp.where(jnp.isnan(values), instead, jnp.asarray(values))


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
    load = k["application_factor"] * k["mesh_load_factor"] * k["rated_dynamic_factor"]
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
    shape, dimensions = _tooth_form(_cut(pair, finish), factors, strengths)
    shape |= _root_factors(pair, factors, strengths)
    nominal = root.nominal_root_stress(
        force=forces.reference,
        face_width=pair.face_width,
        module=pair.module,
        factors=_product(shape),
    )
    load = k["application_factor"] * k["mesh_load_factor"] * k["rated_dynamic_factor"]
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


def _tooth_form(pair: RatedPair, factors: Factors, strengths: Strengths) -> tuple[Rating, Rating]:
    """Y_F with f_eps and Y_S, or Y_Fa and Y_Sa of plastic gears, and the dimensions behind them."""
    teeth, ratio = _virtual(pair)
    section = _sections(pair, teeth, factors.before_2019)
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
    shape = {
        "form_factor": form
        * jnp.where(strengths.plastic | (factors.before_2019 > 0.0), 1.0, several),
        "stress_correction_factor": root.stress_correction_factor(section=section, load=load),
    }
    return shape, dimensions


def _sections(pair: RatedPair, teeth: Both, before_2019: One) -> root.RootSection:
    """Sections of both gears: as a rack cuts them, as measured where gear 2 is a ring.

    The edition of 2006 has formulas for a ring and its cutter.
    """
    tool = {
        "virtual_teeth": jnp.abs(teeth),
        "module": pair.module,
        "pressure_angle": pair.pressure_angle,
        "dedendum": pair.dedendum,
        "tip_radius": pair.fillet_radius,
        "generating_shift": pair.profile_shift,
    }
    cut = root.rack_section(**tool)
    is_ring = pair.teeth < 0.0
    earlier = is_ring & (before_2019 > 0.0) & ~jnp.isnan(pair.cutter[0])
    cutter_teeth, cutter_shift = _known(pair.cutter, 1.0)
    by_cutter = root.pinion_cut_section(
        **{name: jnp.where(earlier, value, _SOUND[name]) for name, value in tool.items()},
        cutter_teeth=cutter_teeth,
        cutter_shift=cutter_shift,
    )
    half, distance, radius = pair.ring_section
    ring = root.ring_section(
        half_chord=half,
        distance=distance,
        fillet_radius=jnp.maximum(radius, _SHARPEST * pair.module),
    )
    chosen: root.RootSection = jax.tree.map(
        lambda old, new, rack: jnp.where(earlier, old, jnp.where(is_ring, new, rack)),
        by_cutter,
        ring,
        cut,
    )
    return chosen


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
            plastic,
            vdi_2736.helix_factor(**skew),
            root.helix_factor(**skew, before_2019=factors.before_2019),
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
