"""Seven-parameter search for a double-arc tooth whose teeth touch along much of the wave."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi, radians

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.strain_wave.design import LEAST_LAND, RIDGE, SWEPT_ACCURACY, build_strain_wave
from pitchpoint.gears.strain_wave.drive import StrainWave, nearest_points
from pitchpoint.gears.strain_wave.flexspline_tooth import DoubleArcFlank
from pitchpoint.gears.strain_wave.groove import Groove, SplineTips, swept, tip_with_land
from pitchpoint.gears.strain_wave.strain_wave_registry import ARCS, DOUBLE_ARCS, DoubleArcForm
from pitchpoint.gears.strain_wave.tooth_motion import ToothMotion
from pitchpoint.gears.strain_wave.wave_generator import TERMS, NeutralLine

__all__ = ["DoubleArcFit", "Merit", "fit_double_arc", "merit_of"]

TANGENT_ANGLES = (radians(8.0), radians(18.0))
"""Flank angles of the common tangent that are allowed [rad]."""

DEFLECTIONS = (0.9, 1.15)
"""Deflections that are searched, over module (z2 - z1)/2."""

TOUCHING = 1e-3
"""Clearance up to which a pair counts as touching, in modules."""

# Angles of the zone, and parts of the flank that a touching angle marks as used: by these two the shares are
# counted, in steps of 1/64 and 1/32. The search is for a tooth, not for more digits of its merit.
_STEPS = 64
_BINS = 32
# A tenth of a module of clearance counts as much as a whole share: both are of order one for teeth that run.
_SPREAD_WEIGHT = 10.0
# Above what the objective of any tooth can be: its spread is less than the depth of a few modules.
_BARRED = 100.0

Four = tuple[Array, Array, Array, Array]


@dataclass(frozen=True)
class Merit:
    """What a tooth is worth.

    Attributes:
        flank_share: part of the flank that touches inside the zone, with a positive relative curvature.
        touching_share: part of the zone in which pairs touch.
        spread: largest clearance inside the zone of teeth that reach into their spaces, in modules.
        objective: what the search makes small: ten times the spread, less both shares; 100 for a
            tooth that is not allowed, whose other figures are zero.
    """

    flank_share: float
    touching_share: float
    spread: float
    objective: float

    @property
    def allowed(self) -> bool:
        """False for a tooth that breaks one of the conditions of `fit_double_arc`."""
        return self.objective < _BARRED


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
    positive relative curvature, at some angle of the zone. Barred are arcs without a common tangent or
    out of order, tangents outside 8 to 18 degrees, tips thinner than 0.3 modules, teeth that do not
    come free at the short axis, teeth that leave nothing of the circular spline's, and interference.
    The tooth told is the best one that makes a drive: `build_strain_wave` takes it.

    Args:
        teeth: of flexspline and circular spline.
        rim: thickness of the rim, in modules.
        start: tooth in the middle of the bounds; addendum and dedendum stay as they are.
        freedom: half the width of the bounds, relative; that of the deflection ends at 0.9 and 1.15.
        zone: angle from the long axis up to which pairs should touch [rad].
        clearance: at the root, in modules.
        tip_rounding: in modules.
        generations, population, seed: of the optimiser (`scipy.optimize.differential_evolution`);
            each generation tries seven times the population.
        progress: told the number of teeth tried and the best objective after each generation.

    Raises:
        InputError: bounds without a width, or teeth and clearance with which no tooth makes a drive.
        ConvergenceError: no tooth that was tried is allowed and makes a drive.

    Validity: wave of the shape `cosine`.

    Example: a short search; the default one tries 1700 teeth, in about a minute.

        >>> from pitchpoint.gears.strain_wave.design import build_strain_wave
        >>> found = fit_double_arc(teeth=(100, 102), freedom=0.05, generations=1, population=1)
        >>> found.merit.objective < found.start.objective
        True
        >>> drive = build_strain_wave(
        ...     teeth=(100, 102),
        ...     module=0.5e-3,
        ...     face_width=0.01,
        ...     form=found.form,
        ...     deflection=found.deflection,
        ...     walls="two modules",
        ... )

    Source: design variables and bounds as Zhao et al. (2022) and Liu et al. (2025) describe them; they
    searched with a particle swarm.
    """
    from scipy.optimize import differential_evolution

    seat = _Seat(teeth, rim, zone, clearance, tip_rounding)
    middle = np.array([*(getattr(start, name) for name in ARCS), 1.0])
    bounds = _bounds(middle, freedom)
    _check_given(seat, start)
    tried: list[float] = []

    def objective(columns: np.ndarray) -> np.ndarray:
        objectives = [
            seat.merit(*_tooth(start, column)).objective for column in np.atleast_2d(columns.T)
        ]
        tried.extend(objectives)
        return np.array(objectives)

    def told(best: object, convergence: float = 0.0) -> None:
        if progress is not None:
            progress(len(tried), min(tried))

    evolution = differential_evolution(
        objective,
        bounds,
        x0=middle,
        maxiter=generations,
        popsize=population,
        rng=seed,
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=told,
    )
    ranked = evolution.population[np.argsort(evolution.population_energies, kind="stable")]
    form, deflection = _first_drive(seat, [_tooth(start, candidate) for candidate in ranked])
    return DoubleArcFit(
        form=form,
        deflection=deflection,
        merit=seat.merit(form, deflection),
        start=seat.merit(*_tooth(start, middle)),
        evaluations=len(tried),
        message=str(evolution.message),
    )


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
    return _Seat(teeth, rim, zone, clearance, tip_rounding).merit(form, deflection)


@dataclass(frozen=True)
class _Seat:
    """What is given beside the tooth, in modules: see `fit_double_arc`."""

    teeth: tuple[int, int]
    rim: float
    zone: float
    clearance: float
    tip_rounding: float

    def merit(self, form: DoubleArcForm, deflection: float) -> Merit:
        """What a tooth is worth here."""
        values = [*(getattr(form, name) for name in ARCS), deflection]
        fixed = [form.addendum, form.dedendum, self.rim, self.zone, self.clearance]
        figures = _objectives(
            jnp.asarray(values),
            teeth=jnp.asarray(self.teeth, dtype=float),
            fixed=jnp.asarray([*fixed, self.tip_rounding]),
        )
        return Merit(*map(float, figures))

    def build(self, form: DoubleArcForm, deflection: float) -> StrainWave:
        """Drive with that tooth; of what size does not matter.

        Raises:
            InputError: the tooth makes no drive.
        """
        return build_strain_wave(
            teeth=self.teeth,
            module=1e-3,
            face_width=0.01,
            form=form,
            deflection=deflection,
            rim_thickness=1e-3 * self.rim,
            clearance=self.clearance,
            tip_rounding=self.tip_rounding,
        )


def _tooth(start: DoubleArcForm, values: np.ndarray) -> tuple[DoubleArcForm, float]:
    """Tooth and deflection with the values that are searched."""
    dimensions = dict(zip(ARCS, map(float, values), strict=False))
    return replace(start, **dimensions), float(values[-1])


def _bounds(middle: np.ndarray, freedom: float) -> list[tuple[float, float]]:
    """Least and largest value of each dimension."""
    if not 0.0 < freedom < 1.0:
        raise InputError(
            f"the bounds are {freedom:g} of the start wide to both sides; use more than 0 and less than 1",
            key="freedom",
        )
    if not middle.all():
        name = ARCS[int(np.argmin(np.abs(middle)))]
        raise InputError(
            f"{name} of the start is zero, and bounds relative to it have no width; give a small value",
            key="start",
        )
    ends = np.sort(middle * np.array([[1.0 - freedom], [1.0 + freedom]]), axis=0)
    ends[:, -1] = np.clip(ends[:, -1], *DEFLECTIONS)
    return [(float(low), float(high)) for low, high in ends.T]


def _check_given(seat: _Seat, start: DoubleArcForm) -> None:
    """Raise what is wrong whatever the tooth is; the start itself need not make a drive."""
    try:
        seat.build(start, 1.0)
    except InputError as error:
        if error.key in ("teeth", "clearance"):
            raise


def _first_drive(
    seat: _Seat, ranked: list[tuple[DoubleArcForm, float]]
) -> tuple[DoubleArcForm, float]:
    """The first of some teeth that makes a drive."""
    allowed = [tooth for tooth in ranked if seat.merit(*tooth).allowed]
    if not allowed:
        raise ConvergenceError(
            "no double-arc tooth that was tried inside the bounds has a common tangent of 8 to 18 degrees "
            "and a tip land of 0.3 modules, and passes its spaces freely"
        )
    for tooth in allowed:
        try:
            seat.build(*tooth)
        except InputError as error:
            refusal = error
        else:
            return tooth
    raise ConvergenceError(f"no tooth that was found makes a drive; of the last one, {refusal}")


@program
def _objectives(
    values: Float[Array, "7"], *, teeth: Float[Array, "2"], fixed: Float[Array, "6"]
) -> Four:
    """Shares, spread and objective of a tooth of module one, see `Merit`."""
    addendum, dedendum, rim, zone, clearance, rounding = fixed
    form, deflection = dict(zip(ARCS, values[:-1], strict=True)), values[-1]
    flank = DoubleArcFlank(
        pitch=jnp.asarray(jnp.pi),
        pitch_height=rim / 2.0 + dedendum,
        addendum=addendum,
        dedendum=dedendum,
        tip_rounding=rounding,
        tip_relief=jnp.zeros(()),
        relief_length=jnp.zeros(()),
        **form,
    )
    travel = deflection * (teeth[1] - teeth[0])
    free = (addendum + dedendum - clearance <= travel) & (deflection < addendum + dedendum)
    neutral = teeth[0] / 2.0 - dedendum - rim / 2.0
    line = NeutralLine(neutral, travel / 2.0, jnp.eye(TERMS)[0])
    low = neutral + travel / 2.0 + rim / 2.0 + clearance

    def worth() -> Four:
        motion = ToothMotion(flank.prepared(), line, 1.0 - teeth[0] / teeth[1])
        groove, left = _with_land(motion, low, rounding, 2.0 * pi / teeth[1])
        *figures, least = _figures(motion, groove, zone)
        return _told(*figures, allowed=left & (least > -SWEPT_ACCURACY))

    none = jnp.zeros(())
    barred = _told(none, none, none, allowed=jnp.zeros((), bool))
    scored: Four = jax.lax.cond(free & _in_order(flank), worth, lambda: barred)
    return scored


def _told(flank_share: Array, touching_share: Array, spread: Array, *, allowed: Array) -> Four:
    """The figures with the objective; without them where the tooth is not allowed."""
    objective = _SPREAD_WEIGHT * spread - flank_share - touching_share
    flank_share, touching_share, spread = (
        jnp.where(allowed, figure, 0.0) for figure in (flank_share, touching_share, spread)
    )
    return flank_share, touching_share, spread, jnp.where(allowed, objective, _BARRED)


def _figures(motion: ToothMotion, groove: Groove, zone: Array) -> Four:
    """Shares of flank and zone that touch, largest and least clearance of teeth that reach in."""
    length = motion.flank.length
    angle = jnp.linspace(0.0, 1.0, _STEPS) * zone
    nearest = nearest_points(motion, groove, angle)
    reaches = jnp.real(motion.place(length, angle)) > groove.low
    gap = jnp.where(reaches, nearest.clearance, 0.0)
    rolls = (nearest.at.curvature + nearest.mate > 0.0) & ~nearest.held
    touches = reaches & (gap < TOUCHING) & rolls
    bins = jnp.floor(nearest.along / length * _BINS).astype(int)
    used = jnp.zeros(_BINS).at[bins].max(touches * 1.0)
    return jnp.mean(used), jnp.mean(touches * 1.0), jnp.max(gap), jnp.min(gap)


def _in_order(flank: DoubleArcFlank) -> Array:
    """True where arcs, tangent and tip of a tooth are as they should be."""
    angle, lengths = flank.tangent_angle, jnp.stack(flank.lengths)
    allowed = (angle > TANGENT_ANGLES[0]) & (angle < TANGENT_ANGLES[1])
    allowed &= flank.tip_land > jnp.maximum(LEAST_LAND, 2.0 * flank.tip_rounding)
    relief = len(flank.lengths) - 2  # which these have not
    return allowed & jnp.all(jnp.delete(lengths, relief) > 0.0)


def _with_land(motion: ToothMotion, low: Array, edge: Array, pitch: Array) -> tuple[Groove, Array]:
    """Groove whose teeth between keep a tip land, and whether anything is left of them."""
    none = jnp.zeros(())
    tips = SplineTips(edge, none, none, none, jnp.asarray(RIDGE))

    def cut(low: Array, _: None) -> tuple[Array, tuple[Groove, Array]]:
        groove = swept(motion, low, tips)
        raised = tip_with_land(groove, pitch, LEAST_LAND, edge)
        left = jnp.isfinite(raised)
        return jnp.where(left, raised, low), (groove, left)

    _, (grooves, left) = jax.lax.scan(cut, low, None, length=2)
    return jax.tree.map(lambda leaf: leaf[-1], grooves), left[0]
