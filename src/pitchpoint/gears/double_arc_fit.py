"""Seven-parameter search for a double-arc tooth whose teeth touch along much of the wave."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import radians

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.errors import ConvergenceError
from pitchpoint.gears.flexspline_tooth import DoubleArcFlank
from pitchpoint.gears.groove import swept
from pitchpoint.gears.strain_wave import nearest_points
from pitchpoint.gears.strain_wave_design import DOUBLE_ARCS, DoubleArcForm
from pitchpoint.gears.tooth_motion import ToothMotion
from pitchpoint.gears.wave_generator import TERMS, NeutralLine

__all__ = ["DoubleArcFit", "Merit", "fit_double_arc", "merit_of"]

SEARCHED = (
    "convex_radius",
    "convex_offset",
    "convex_shift",
    "concave_radius",
    "concave_offset",
    "concave_shift",
)
"""Dimensions of the tooth that are searched; the seventh is the deflection."""

TANGENT_ANGLES = (radians(8.0), radians(18.0))
"""Flank angles of the common tangent that are allowed [rad]."""

LEAST_LAND = 0.3
"""Tip land that is kept, in modules."""

TOUCHING = 1e-3
"""Clearance up to which a pair counts as touching, in modules."""

_STEPS = 64
_BINS = 32
_SPREAD_WEIGHT = 10.0
_BARRED = 100.0


@dataclass(frozen=True)
class Merit:
    """What a tooth is worth.

    Attributes:
        flank_share: part of the flank that touches inside the zone, with a positive relative curvature.
        touching_share: part of the zone in which pairs touch.
        spread: largest clearance inside the zone, in modules.
        objective: what the search makes small: spread, less both shares.
    """

    flank_share: float
    touching_share: float
    spread: float
    objective: float


@dataclass(frozen=True)
class DoubleArcFit:
    """A tooth that a search found.

    Attributes:
        form: of the tooth, in modules.
        deflection: w0 over module (z2 - z1)/2.
        merit, start: of this tooth and of the one from which the bounds were taken.
        evaluations: of the objective.
        message: of the optimiser.
    """

    form: DoubleArcForm
    deflection: float
    merit: Merit
    start: Merit
    evaluations: int
    message: str


def fit_double_arc(
    *,
    teeth: tuple[int, int],
    rim: float = 2.0,
    start: DoubleArcForm = DOUBLE_ARCS["liu"],
    freedom: float = 0.25,
    zone: float = radians(36.0),
    clearance: float = 0.25,
    tip_rounding: float = 0.1,
    generations: int = 30,
    population: int = 8,
    seed: int = 1,
    progress: Callable[[int, float], None] | None = None,
) -> DoubleArcFit:
    """Double-arc tooth and deflection whose pairs touch along the wave, by differential evolution.

    A part of the flank counts as used where it touches the circular spline that it sweeps, with a
    positive relative curvature, at some angle of the zone. Barred are arcs without a common
    tangent or out of order, tangents outside 8 to 18 degrees, and tips thinner than 0.3 modules.

    Args:
        teeth: of flexspline and circular spline.
        rim: thickness of the rim, in modules.
        start: tooth in the middle of the bounds.
        freedom: half the width of the bounds, relative.
        zone: angle from the long axis up to which pairs should touch [rad].
        clearance: at the root, in modules.
        tip_rounding: in modules.
        generations, population, seed: of the optimiser (`scipy.optimize.differential_evolution`).
        progress: told the number of teeth tried and the best objective after each generation.

    Raises:
        ConvergenceError: no tooth inside the bounds is allowed.

    Source: design variables and bounds as Zhao et al. (2022) and Liu et al. (2025) describe them; they
    searched with a particle swarm.
    """
    from scipy.optimize import differential_evolution

    middle = np.array([*(getattr(start, name) for name in SEARCHED), 1.0])
    low, high = middle * (1.0 - freedom), middle * (1.0 + freedom)
    low[-1], high[-1] = max(low[-1], 0.9), min(high[-1], 1.15)
    evaluate = partial(
        _objectives,
        teeth=jnp.asarray(teeth, dtype=float),
        fixed=jnp.asarray([rim, start.addendum, start.dedendum, clearance, tip_rounding, zone]),
    )
    tried: list[float] = []

    def objective(columns: np.ndarray) -> np.ndarray:
        candidates = np.atleast_2d(columns.T)
        found = [float(evaluate(jnp.asarray(one))[0]) for one in candidates]
        tried.extend(found)
        return np.array(found)

    def told(best: object, convergence: float = 0.0) -> None:
        if progress is not None:
            progress(len(tried), min(tried))

    found = differential_evolution(
        objective,
        list(zip(low, high, strict=True)),
        x0=middle,
        maxiter=generations,
        popsize=population,
        rng=seed,
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=told,
    )
    if found.fun >= _BARRED:
        raise ConvergenceError(
            "no double-arc tooth inside the bounds has a common tangent and a tip land"
        )
    form = replace(start, **dict(zip(SEARCHED, map(float, found.x[:-1]), strict=True)))
    return DoubleArcFit(
        form=form,
        deflection=float(found.x[-1]),
        merit=_merit(evaluate(jnp.asarray(found.x))),
        start=_merit(evaluate(jnp.asarray(middle))),
        evaluations=len(tried),
        message=str(found.message),
    )


def _merit(values: tuple[Array, ...]) -> Merit:
    objective, flank, touching, spread = (float(value) for value in values)
    return Merit(flank, touching, spread, objective)


def merit_of(
    form: DoubleArcForm,
    deflection: float = 1.0,
    *,
    teeth: tuple[int, int],
    rim: float = 2.0,
    zone: float = radians(36.0),
    clearance: float = 0.25,
    tip_rounding: float = 0.1,
) -> Merit:
    """What a double-arc tooth is worth; arguments as in `fit_double_arc`."""
    values = jnp.asarray([*(getattr(form, name) for name in SEARCHED), deflection])
    fixed = jnp.asarray([rim, form.addendum, form.dedendum, clearance, tip_rounding, zone])
    return _merit(_objectives(values, teeth=jnp.asarray(teeth, dtype=float), fixed=fixed))


@eqx.filter_jit
def _objectives(
    values: Float[Array, "7"], *, teeth: Float[Array, "2"], fixed: Float[Array, "6"]
) -> tuple[Array, Array, Array, Array]:
    """Objective and its parts for a tooth of module one."""
    rim, addendum, dedendum, clearance, rounding, zone = fixed
    form = dict(zip(SEARCHED, values[:-1], strict=True))
    flank = DoubleArcFlank(
        pitch=jnp.asarray(jnp.pi),
        pitch_height=rim / 2.0 + dedendum,
        addendum=addendum,
        dedendum=dedendum,
        tip_rounding=rounding,
        **form,
    )
    barred = _barred(flank)
    usual = DOUBLE_ARCS["liu"]
    safe = replace(flank, **{k: jnp.where(barred, getattr(usual, k), v) for k, v in form.items()})
    radius = teeth[0] / 2.0 - dedendum - rim / 2.0
    deflection = values[-1] * (teeth[1] - teeth[0]) / 2.0
    line = NeutralLine(radius, deflection, jnp.eye(TERMS)[0])
    motion = ToothMotion(safe.prepared(), line, 1.0 - teeth[0] / teeth[1])
    groove = swept(motion, radius + deflection + rim / 2.0 + clearance, rounding)
    angle = jnp.linspace(0.0, 1.0, _STEPS) * zone
    found = nearest_points(motion, groove, angle)
    touches = (found.clearance < TOUCHING) & (found.at.curvature + found.mate > 0.0) & ~found.held
    bins = jnp.floor(found.along / safe.length * _BINS).astype(int)
    used = jnp.zeros(_BINS).at[bins].max(touches.astype(float))
    flank_share, touching_share = jnp.mean(used), jnp.mean(touches)
    spread = jnp.max(found.clearance)
    objective = _SPREAD_WEIGHT * spread - flank_share - touching_share
    return jnp.where(barred, _BARRED, objective), flank_share, touching_share, spread


def _barred(flank: DoubleArcFlank) -> Array:
    angle, lengths = flank.tangent_angle, jnp.stack(flank.lengths)
    allowed = (angle > TANGENT_ANGLES[0]) & (angle < TANGENT_ANGLES[1])
    allowed &= flank.tip_land > LEAST_LAND
    return ~(allowed & jnp.all(lengths > 0.0))
