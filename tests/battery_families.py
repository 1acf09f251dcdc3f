"""Every gear family as the battery takes it, with one program for each question."""

import dataclasses
from collections.abc import Callable, Mapping

import equinox as eqx
import numpy as np
from flank_curves import Ball, Curves, Discs, Involutes, RackFlanks, TorusFlanks

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import total
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state
from pitchpoint.gears.ball_on_disc.mesh import BallOnDisc
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.families import built_gears
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.gears.strain_wave.design import build_strain_wave
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.sharing import sharing_applies
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
LAW = {law.name: law for law in LAWS}
LOCAL = ("constant", "xu_2007")
WHOLE_MESH = (*LOCAL, "iso_tr_14179_2")
SHARING = ("zhao_2022_cosine", "sanchez_2017", "equal")
"""Prescribed shares, the narrower laws first."""
FORCE = 600.0
"""Normal force of all contacts together where nothing else is said [N]."""


def spur(teeth, module=3e-3, **options):
    return build_cylindrical_pair(
        teeth=teeth, module=module, pressure_angle=np.deg2rad(20.0), face_width=0.02, **options
    )


def helical(teeth, helix, module=3e-3, **options):
    return spur(teeth, module, helix_angle=np.deg2rad(helix), slices=6, **options)


def strain_wave(teeth=(200, 202), form=DOUBLE_ARCS["flat"], **options):
    return build_strain_wave(
        teeth=teeth, module=0.3e-3, face_width=0.01, rim_thickness=0.7e-3, form=form, **options
    )


RING = {"fillet_radius": (0.38, 0.2), "profile_shift": (0.3, 0.2)}


def rack(teeth=20, **values):
    table = {"family": "rack_and_pinion", "teeth": teeth, "module": "3 mm", "face_width": "25 mm"}
    gears = RackAndPinionGears.model_validate(table | values)
    return built_gears(gears, 6)[0]


TORUS = {
    "family": "torus",
    "teeth": [40, 49],
    "module": "2.5 mm",
    "face_width": ["15 mm", "20 mm"],
    "torus_radius": ["35 mm", "55 mm"],
}


def torus(**values):
    return built_gears(TorusGears.model_validate(TORUS | values), 6)[0]


@dataclasses.dataclass(frozen=True)
class Family:
    """How its mesh is made, and its flanks as curves; None where another file has them as positions.

    By number, the coordinates that drive and are loaded; the usual ones by default.
    """

    mesh: Callable[[], Mesh]
    curves: Callable[[Mesh], Curves] | None
    driver: int | None = None
    loaded: int | None = None


def discs(*values):
    return Family(lambda: TwinDisc(*map(jnp.asarray, values)), Discs)


def ball(*values):
    return Family(lambda: BallOnDisc(*map(jnp.asarray, values)), Ball)


def pair(made, *args, driver=None, **options):
    return Family(lambda: made(*args, **options), Involutes, driver)


def travel(*args, driver=None, **options):
    return Family(lambda: rack(*args, **options), RackFlanks, driver)


def tori(driver=None, **options):
    return Family(lambda: torus(**options), TorusFlanks, driver)


def wave(*args, driver=0, loaded=1, **options):
    return Family(lambda: strain_wave(*args, **options), None, driver, loaded)


FAMILIES: Mapping[str, Family] = {
    "twin disc": discs([0.02, 0.035], 0.008, 0.8),
    "twin disc, faster follower": discs([0.03, 0.02], 0.01, 1.3),
    "ball on disc": ball([0.0095, 0.0095], 0.04, 0.35),
    "barrel on disc, faster barrel": ball([0.01, 0.03], 0.035, -0.2),
    "18/36": pair(spur, (18, 36)),
    "18/36, right flank": pair(spur, (18, 36), right_flank=True),
    "18/36, wheel drives": pair(spur, (18, 36), driver=1),
    "18/36, wheel drives, right flank": pair(spur, (18, 36), driver=1, right_flank=True),
    "36/18, speed-increasing": pair(spur, (36, 18)),
    "23/61, shifted": pair(spur, (23, 61), 2e-3, profile_shift=(0.4, -0.2)),
    "23/61, high teeth": pair(spur, (23, 61), 2e-3, profile_shift=(0.4, -0.2), addendum=(1.4, 1.4)),
    "17/17": pair(spur, (17, 17)),
    "12/120": pair(spur, (12, 120), 1e-3, profile_shift=(0.5, 0.0)),
    "20/60, pitch point in double contact": pair(spur, (20, 60), profile_shift=(0.8, -0.8)),
    "helical 20/30": pair(helical, (20, 30), 15.0),
    # Its tips count as given, so that it is alike for the compiler.
    "helical 4/51, eps_alpha below one": Family(
        lambda: dataclasses.replace(
            helical((4, 51), 20.0, 1.5e-3, profile_shift=(0.74, 0.05), least_tip=0.25),
            shortened=(False, False),
        ),
        Involutes,
    ),
    "helical 20/30, narrow, wheel drives, right flank": pair(
        helical, (20, 30), 8.0, driver=1, right_flank=True
    ),
    "ring 20/-60": pair(spur, (20, -60), **RING),
    "ring 20/-60, wheel drives": pair(spur, (20, -60), driver=1, **RING),
    "helical ring 18/-71, right flank": pair(
        helical, (18, -71), 25.0, 1e-3, right_flank=True, **RING
    ),
    "rack": travel(),
    "rack drives, right flank, backlash": travel(
        18, driver=1, profile_shift=0.1, flank="right", mounting_distance="27.5 mm"
    ),
    "helical rack": travel(helix_angle="19.5 deg"),
    "torus": tori(),
    "torus, wheel drives, right flank, concave gear 1": tori(
        driver=1,
        flank="right",
        torus_radius=["60 mm", "40 mm"],
        torus_offset=["110 mm", "21.25 mm"],
    ),
    # Alike for the compiler; involute teeth and odd numbers are in test_strain_wave.py.
    "strain wave 200/202": wave(),
    "strain wave 200/202, flexspline fixed": wave(form=DOUBLE_ARCS["liu"], loaded=2),
    "strain wave 200/202, wave generator fixed": wave(driver=1, loaded=2),
    "strain wave 200/202, back-driving": wave(driver=1, loaded=0),
    "strain wave 200/204": wave((200, 204)),
}


@eqx.filter_jit
def contacts_of(mesh, phase):
    return mesh.contacts(phase)


@eqx.filter_jit
def properties(design):
    mesh = design.mesh
    return {
        "events": mesh.events(),
        "motion": design.motion,
        "driver": design.driver,
        "loaded": design.loaded,
        "period": design.period,
        "onward": design.onward,
        "axes": jnp.stack([one.axis for one in mesh.coordinates]),
        "contact_ratio": mesh.contact_ratio,
    }


def state_at(design, operation, phase, models):
    found = state(design, operation, phase, models)
    return found, {
        "torque": found.balance.torque,
        "force": found.balance.force,
        "loss": found.loss,
        "input_power": found.input_power,
        "output_power": found.output_power,
        "residual": found.balance.residual,
        "locked": found.balance.locked,
        "iterations": found.balance.iterations,
        "rolling_loss": total(found.rolling_loss),
        "sliding_losses": found.sliding_loss,
    }


@eqx.filter_jit
def rolling_state(design, operation, phase, models):
    return state_at(design, operation, phase, models)[1]


def floats(tree):
    return eqx.filter(tree, eqx.is_inexact_array)


@eqx.filter_jit
def gradient_of_state(design, operation, phase, models):
    """Sums over all lanes of contacts and state, their derivatives, and the states."""

    def whole(both):
        found, told = state_at(both[0], both[1], phase, models)
        at = found.conditions
        kept = (found.balance.torque, found.balance.load, found.balance.friction)
        lanes = (at.pressure, at.slide_roll_ratio, at.entrainment, at.sliding, at.radius)
        lost = (found.sliding_loss, found.rolling_loss)
        sums = [jnp.sum(leaf) for leaf in (*kept, *lanes, *lost)]
        return sum(sums + [jnp.sum(leaf) for leaf in jax.tree.leaves(floats(found.contacts))]), told

    (value, told), gradient = eqx.filter_value_and_grad(whole, has_aux=True)((design, operation))
    return value, gradient, told


def models_for(mesh, law="constant", rolling="none"):
    names = laws_for(mesh)
    return Models(
        friction=tuple(LAW[name] for name in names),
        choice=jnp.asarray(names.index(law)),
        parameters={"constant": {"coefficient": jnp.asarray(0.07)}},
        sharing=LOAD_SHARING[sharing_for(mesh)],
        rolling=ROLLING_RESISTANCE[rolling],
    )


def laws_for(mesh):
    return WHOLE_MESH if has(mesh, pitch_point) and mesh.shape == "line" else LOCAL


def sharing_for(mesh):
    return next(name for name in SHARING if sharing_applies(LOAD_SHARING[name], mesh))


def operation_for(design, load=None):
    load = usual_load(design) if load is None else load
    speed = 150.0 / max(1.0, float(jnp.max(jnp.abs(design.motion))))  # of the fastest member
    return Operation(*map(jnp.asarray, (load, speed, 330.0)))


def usual_load(design):
    """Load whose normal forces are alike in all families."""
    at = jax.device_get(contacts_of(design.mesh, jnp.asarray(INSIDE)))
    arm = np.abs(np.tensordot(np.asarray(design.loaded), at.normal, axes=1))
    return FORCE * float(arm[at.active].max())


def design_for(made):
    mesh = made.mesh()
    design = Design(
        mesh,
        (STEEL, STEEL),
        lubricants.find("pao-vg-220").build(),
        Roughness.from_composite_rq(0.4e-6),
    )
    return design if made.driver is None else design.driven_by(made.driver, made.loaded)


INSIDE = (np.arange(26) + 0.4) / 26.0
"""As many phases everywhere, so that one program serves."""


def differentiated(design, everywhere, law="xu_2007", load=None):
    """Sums, gradient and states of one law on the grid and on the events themselves."""
    given = (design, operation_for(design, load), everywhere)
    return jax.device_get(gradient_of_state(*given, models_for(design.mesh, law)))
