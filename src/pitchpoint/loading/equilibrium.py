"""Equilibrium of contacts that only push: which of them carry a load, and how far the loaded body moves."""

from typing import NamedTuple

import equinox as eqx
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.core.status import Code, Status
from pitchpoint.gears.on_balls import Body, OnBalls, ball_force, ball_stiffness, over_batch

__all__ = ["Equilibrium", "equilibrium", "touching_approach"]

Lanes = Float[Arrays, "pair slice *#b"]
Each = Float[Arrays, "*#b"]
Rows = Float[Array, "*b lane"]

MOST = 200
"""Largest number of active sets that are tried; usual are two to six."""

FULL_EXCHANGES = 3
"""Exchanges of all wrong lanes that may leave as many of them, before it goes step by step."""

FEASIBLE = 1e-12
"""Share of the load (or of its deflection) that counts as zero."""

UNSOLVED = 1e-10
"""Residual above which forces are NaN."""

FAR = 1e6
"""Approach, over elastic deflection and clearance, at which a body that nothing holds is looked at."""

PASSES = 40
"""Largest number of steps in which balls find their approach; usual are three to eight."""

SETTLED = 1e-9
"""Change of an approach, over the largest one, at which it counts as found; one more step squares that."""

LIGHTEST = 1e-8
"""Least elastic deflection over the largest clearance: what lighter loads do is its limit."""


class Equilibrium(eqx.Module):
    """Equilibrium of pairs that only push.

    Attributes:
        force: normal force of each slice [N].
        share: part of the sum of all forces; without load the limit for a vanishing one.
        approach: rotation (or displacement) of the loaded coordinate from where `gap` was measured
            [rad or m].
        stiffness: load over approach for a small change of the load, while the same pairs carry
            [N m/rad or N/m].
        loaded: True where a slice carries.
        residual: largest violation of the equilibrium, over the load or its deflection.
        iterations: active sets that were tried, common to the states that were solved together.
        balls: approach of the balls under the body; None where none hold it [m].

    From the balance of the load, with no force on open contacts and no gap on loaded ones.
    """

    force: Lanes
    share: Lanes
    approach: Each
    stiffness: Each
    loaded: Bool[Array, "pair slice *b"]
    residual: Each
    iterations: Int[Array, ""]
    balls: Float[Array, "ball *b"] | None = None

    @property
    def status(self) -> Status:
        """What became of the search for the contacts that carry."""
        lost = jnp.where(jnp.isinf(self.residual), int(Code.NO_CONTACT), int(Code.NOT_CONVERGED))
        code = jnp.where(self.residual <= UNSOLVED, int(Code.SOLVED), lost)
        return Status(code, self.residual, self.iterations)


class _Problem(NamedTuple):
    """C f + g - a d >= 0, f >= 0, f (C f + g - a d) = 0, sum of a f = load; all of order one.

    C is the matrix, or `own` on its diagonal where nothing couples the lanes.
    """

    own: Rows
    matrix: Float[Array, "*b lane lane"] | None
    gap: Rows
    arm: Rows
    active: Bool[Array, "*b lane"]
    load: Each

    def moved(self, force: Rows) -> Rows:
        """Displacements C f."""
        if self.matrix is None:
            return self.own * force
        return jnp.squeeze(self.matrix @ force[..., None], axis=-1)


class _Solution(NamedTuple):
    force: Rows
    approach: Each
    stiffness: Each
    slack: Rows


class _ContactScale(NamedTuple):
    """What turns numbers of order one into quantities: force [N], compliance [m/N], arm, approach."""

    force: Each
    compliance: Each
    arm: Each
    touch: Each


def equilibrium(
    teeth: Float[Arrays, "..."],
    body: Body | Float[Arrays, "lane lane *#b"] | None,
    *,
    gap: Lanes,
    arm: Lanes,
    active: Bool[Arrays, "pair slice *#b"],
    load: Each,
    start: Bool[Array, "pair slice *b"] | None = None,
) -> Equilibrium:
    """Forces of the contacts of any mesh that share a load.

    Forces f >= 0 and one approach d: C f + gap - arm d is zero where a lane carries and not negative
    elsewhere, and the sum of arm f is the load. Without a body that couples them lanes come to carry one
    after the other as the load grows, so the set follows from their order. Else the set of loaded lanes
    is found by exchanging all wrong ones at once; where that does not lead to fewer of them, by steps that
    each lessen the energy, of which there are finitely many for a positive definite C. The last solution
    on that set carries the first derivatives. They jump where a pair comes to carry.

    Args:
        teeth: displacement of each lane (pair and slice) along its normal for a unit force on it [m/N].
        body: what is added to that for a unit force on another lane, lanes flattened [m/N]; symmetric
            positive semidefinite, held by balls or not; None where nothing couples them.
        gap: separation of the unloaded flanks; any sign, only differences over `arm` matter to the
            forces [m].
        arm: closing for a unit of approach, positive; lanes with none never carry [m or 1].
        active: lanes that may carry.
        load: not negative [N m or N].
        start: lanes that may be those that carry, to be tried first; not with balls.

    Returns:
        Forces and approach, broadcast over all batch axes; NaN where no equilibrium was found. A
        load of zero gives the first pair that touches.

    Source: Júdice and Pires (1994) for the exchanges; Nocedal and Wright (2006), algorithm 16.3, for the
    steps.

    Example:
        >>> import equinox as eqx
        >>> import jax.numpy as jnp
        >>> springs, gaps = jnp.full((2, 1), 1e-8), jnp.asarray([[0.0], [1e-6]])
        >>> all_touch = {"arm": jnp.ones((2, 1)), "active": jnp.ones((2, 1), bool)}
        >>> compiled = eqx.filter_jit(equilibrium)
        >>> found = compiled(springs, None, gap=gaps, load=jnp.asarray(300.0), **all_touch)
        >>> [round(float(force)) for force in found.force[:, 0]]
        [200, 100]
    """
    if isinstance(body, OnBalls):
        return _on_balls(teeth, body, gap, arm, active, load)
    problem, scale = _normalised(teeth, body, gap, arm, active, load)
    # Which lanes carry stays as it is under small changes of inputs: only what they carry has derivatives.
    loaded, iterations = _loaded(jax.lax.stop_gradient(problem), start)
    found = _solve(problem, loaded)
    residual = jax.lax.stop_gradient(_residual(problem, loaded, found))
    solved = (residual <= UNSOLVED) & (load >= 0.0)

    def lanes(rows: Array) -> Array:
        return jnp.moveaxis(rows, -1, 0).reshape(*gap.shape[:2], *rows.shape[:-1])

    force = jnp.where(loaded, found.force, 0.0)
    moved = scale.compliance * scale.force * found.approach / scale.arm
    return Equilibrium(
        force=_where(solved, lanes(force) * scale.force),
        share=_where(solved, lanes(force / jnp.sum(force, axis=-1, keepdims=True))),
        approach=_where(solved, scale.touch + moved),
        stiffness=_where(solved, found.stiffness * scale.arm**2 / scale.compliance),
        loaded=lanes(loaded),
        residual=residual,
        iterations=iterations,
    )


class _Held(NamedTuple):
    """A body whose balls are springs for small changes of their approach.

    Attributes:
        lanes: compliance of the lanes [m/N].
        shift: displacement of the lanes by what the springs push without load on them [m].
        across, free: how the balls move with the forces of the lanes, and without [m/N, m].
    """

    lanes: Float[Array, "*b lane lane"]
    shift: Rows
    across: Float[Array, "*b ball lane"]
    free: Float[Array, "*b ball"]


def _held(body: OnBalls, approach: Float[Array, "*b ball"]) -> _Held:
    """The body on springs that are tangent to the balls at an approach."""
    lanes, across = (jnp.moveaxis(x, (0, 1), (-2, -1)) for x in (body.lanes, body.across))
    slope = ball_stiffness(body.stiffness, approach)
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    root = jnp.sqrt(jnp.where(slope > 0.0, slope, 1.0)) * (slope > 0.0)
    pushed = ball_force(body.stiffness, approach) - ball_force(body.stiffness, body.approach)
    pushed += slope * (body.approach - approach)
    matrix = jnp.eye(root.shape[-1]) + root[..., :, None] * body.balls * root[..., None, :]
    inverse = root[..., :, None] * jnp.linalg.inv(matrix) * root[..., None, :]
    # Forces of the balls follow their approach: pushed - inverse (across^T f + balls pushed).
    coupled = across @ inverse
    bent = jnp.einsum("ij,...j->...i", body.balls, pushed)
    resting = pushed - jnp.einsum("...ij,...j->...i", inverse, bent)
    left = jnp.eye(root.shape[-1]) - body.balls @ inverse
    return _Held(
        lanes=lanes - coupled @ jnp.swapaxes(across, -1, -2),
        shift=jnp.einsum("...ij,...j->...i", across, resting),
        across=left @ jnp.swapaxes(across, -1, -2),
        free=body.approach - jnp.einsum("ij,...j->...i", body.balls, resting),
    )


def _on_balls(
    teeth: Float[Arrays, "..."],
    body: OnBalls,
    gap: Lanes,
    arm: Lanes,
    active: Bool[Arrays, "pair slice *#b"],
    load: Each,
) -> Equilibrium:
    """Equilibrium with balls that only push: Newton's steps in their approach, each one an equilibrium."""
    each = (teeth.shape[2:], body.lanes.shape[2:], gap.shape[2:], arm.shape[2:], load.shape)
    batch = jnp.broadcast_shapes(*each)

    def on_springs(
        body: OnBalls, approach: Array, loaded: Array, *given: Array
    ) -> tuple[Equilibrium, Array]:
        own, gaps, arms, may, carried = given
        held = _held(body, approach)
        shift = jnp.moveaxis(held.shift, -1, 0).reshape(*gaps.shape[:2], *batch)
        matrix = jnp.moveaxis(held.lanes, (-2, -1), (0, 1))
        lanes = {"gap": gaps + shift, "arm": arms, "active": may}
        found = equilibrium(own, matrix, **lanes, load=carried, start=loaded)
        force = jnp.moveaxis(found.force.reshape(-1, *batch), 0, -1)
        moved = held.free - jnp.einsum("...ij,...j->...i", held.across, force)
        return found, moved

    given = teeth, gap, arm, active, load
    fixed = jax.lax.stop_gradient((body, *given))

    def again(at: _Settling) -> _Settling:
        found, approach = on_springs(fixed[0], at.approach, at.loaded, *fixed[1:])
        change = jnp.max(jnp.abs(approach - at.approach), axis=-1)
        size = jnp.max(jnp.abs(approach), axis=-1)
        moves, sets = change > SETTLED * size, at.sets + found.iterations
        return _Settling(approach, found.loaded, moves, at.steps + 1, sets)

    start = jnp.where(
        jnp.isfinite(body.start), body.start, over_batch(body.approach, body.start.ndim - 1)
    )
    start = jax.lax.stop_gradient(jnp.moveaxis(start, 0, -1))
    start = jnp.broadcast_to(start, (*batch, body.start.shape[0]))
    none = jnp.zeros((*gap.shape[:2], *batch), bool)
    begin = _Settling(start, none, jnp.ones(batch, bool), jnp.asarray(0), jnp.asarray(0))
    settled = jax.lax.while_loop(lambda at: (at.steps < PASSES) & jnp.any(at.open), again, begin)
    # One more step from what was found has all derivatives; through the loop each step would be kept.
    frozen = jax.lax.stop_gradient(settled.approach)
    found, approach = on_springs(body, frozen, settled.loaded, *given)
    done = ~settled.open & jnp.all(jnp.isfinite(frozen), axis=-1)
    # Balls that went on moving are no equilibrium: one, the whole of their approach, is far from solved.
    return Equilibrium(
        force=_where(done, found.force),
        share=_where(done, found.share),
        approach=_where(done, found.approach),
        stiffness=_where(done, found.stiffness),
        loaded=found.loaded,
        residual=jnp.where(done, found.residual, 1.0),
        iterations=settled.sets + found.iterations,
        balls=_where(done, jnp.moveaxis(approach, -1, 0)),
    )


class _Settling(NamedTuple):
    """State of the search for the approach of the balls.

    Attributes:
        approach: of each ball [m].
        loaded: lanes that carried in the last step.
        open: True where it still changes.
        steps, sets: that were taken, and active sets that were tried on the way.
    """

    approach: Float[Array, "*b ball"]
    loaded: Bool[Array, "pair slice *b"]
    open: Bool[Array, "*b"]
    steps: Int[Array, ""]
    sets: Int[Array, ""]


def touching_approach(gap: Lanes, arm: Lanes, active: Bool[Array, "pair slice *#b"]) -> Each:
    """Approach at which the first of rigid contacts touches [rad or m]; arguments as in `equilibrium`.

    From the gap of each contact, which closes by its arm times the approach.
    """
    touches = active & (arm > 0.0)
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    each = jnp.where(touches, gap / jnp.where(touches, arm, 1.0), jnp.inf)
    flat = each.reshape(-1, *each.shape[2:])
    # By its number: the derivative of a least value may be 0/0, see `_solve`.
    return jnp.take_along_axis(flat, jnp.argmin(flat, axis=0)[None], axis=0)[0]


def _where(solved: Bool[Array, "*b"], values: Float[Array, "..."]) -> Float[Array, "..."]:
    return jnp.where(solved, values, jnp.nan)


def _normalised(
    teeth: Float[Arrays, "..."],
    body: Float[Arrays, "lane lane *#b"] | None,
    gap: Lanes,
    arm: Lanes,
    active: Bool[Arrays, "pair slice *#b"],
    load: Each,
) -> tuple[_Problem, _ContactScale]:
    """The problem counted from first touch, with mean compliance, arm and load of one.

    Scales are constants to a derivative: the solution does not depend on them.
    """
    coupled = () if body is None else body.shape[2:]
    each = (teeth.shape[2:], gap.shape[2:], arm.shape[2:], load.shape)
    batch = jnp.broadcast_shapes(coupled, *each)

    def rows(lanes: Arrays) -> Array:
        flat = jnp.moveaxis(lanes.reshape(-1, *lanes.shape[2:]), 0, -1)
        return jnp.broadcast_to(flat, (*batch, flat.shape[-1]))

    may = rows(active) & (rows(arm) > 0.0)
    matrix, own = None, rows(teeth)
    if body is not None:
        matrix = jnp.moveaxis(body, (0, 1), (-2, -1)) + jnp.eye(own.shape[-1]) * own[..., None]
        own = jnp.diagonal(matrix, axis1=-2, axis2=-1)
    arms, gaps = jnp.where(may, rows(arm), 0.0), rows(gap)
    constant = jax.lax.stop_gradient
    # A quotient that is not wanted needs a divisor too: its infinite slope would make NaN of a zero.
    safe_arms = jnp.where(may, arms, 1.0)
    approach = gaps / safe_arms
    touch = constant(jnp.min(jnp.where(may, approach, jnp.inf), axis=-1))
    touch = jnp.where(jnp.isfinite(touch), touch, 0.0)
    # By differences of the approach the first pair to touch is left with none at all, whatever rounds.
    gaps = jnp.where(may, arms * (approach - touch[..., None]), 0.0)
    mean_arm = constant(_mean(arms, may))
    mean_compliance = constant(_mean(own, may))
    force = jnp.broadcast_to(load, batch) / mean_arm
    small = LIGHTEST * constant(jnp.max(gaps, axis=-1))
    least = small / mean_compliance
    light = (force < least) | (force <= 0.0)
    reference = jnp.where(light, jnp.where(least > 0.0, least, 1.0), constant(force))
    # Of flanks that touch all along, rounding says which gap is the least: what closes first has none.
    first = gaps <= small[..., None]
    gaps = jnp.where(light[..., None] & first, 0.0, gaps)
    may &= first | ~light[..., None]
    problem = _Problem(
        own=jnp.where(may, own / mean_compliance[..., None], 1.0),
        matrix=None if matrix is None else _masked(matrix / mean_compliance[..., None, None], may),
        gap=gaps / (mean_compliance * reference)[..., None],
        arm=arms / mean_arm[..., None],
        active=may,
        # Over its own constant value the load is one; it stands here to carry the derivative.
        load=jnp.where(light, 1.0, force / reference),
    )
    scale = jnp.where(light, force, reference)
    return problem, _ContactScale(scale, mean_compliance, mean_arm, touch)


def _mean(values: Rows, over: Bool[Array, "*b lane"]) -> Each:
    """Mean over some lanes, one where there is none."""
    count = jnp.sum(over, axis=-1)
    mean = jnp.sum(jnp.where(over, values, 0.0), axis=-1) / jnp.maximum(count, 1)
    return jnp.where(count > 0, mean, 1.0)


def _masked(
    matrix: Float[Array, "*b lane lane"], keep: Bool[Array, "*b lane"]
) -> Float[Array, "*b lane lane"]:
    """Rows and columns of some lanes, those of the unit matrix for the others."""
    both = keep[..., :, None] & keep[..., None, :]
    return jnp.where(both, matrix, jnp.eye(matrix.shape[-1]))


class _LaneSearch(NamedTuple):
    """State of the search for the loaded lanes.

    Attributes:
        loaded: set of lanes to try next.
        force: not negative, of the whole load; only a search that goes step by step needs it.
        open: True where the last set was wrong.
        fewest: least number of wrong lanes so far.
        patience: exchanges of all wrong lanes that are left; negative in a search step by step.
        steps: sets that were tried.
    """

    loaded: Bool[Array, "*b lane"]
    force: Rows
    open: Bool[Array, "*b"]
    fewest: Int[Array, "*b"]
    patience: Int[Array, "*b"]
    steps: Int[Array, ""]


def _loaded(
    problem: _Problem, first: Bool[Array, "pair slice *b"] | None
) -> tuple[Bool[Array, "*b lane"], Int[Array, ""]]:
    """Lanes that carry, and the number of sets that were tried."""
    # Active sets and no general solver of quadratic programs: most sets are those of contacts that stand
    # alone, give or take a few; what is found is exact, and so are derivatives with the set as it is.
    start = _as_if_alone(problem)
    if first is not None:
        flat = jnp.moveaxis(first.reshape(-1, *first.shape[2:]), 0, -1)
        start = jnp.where(jnp.any(flat, axis=-1, keepdims=True), flat & problem.active, start)
    if problem.matrix is None:
        return start, jnp.asarray(1)
    batch, lanes = start.shape[:-1], start.shape[-1]
    begin = _LaneSearch(
        loaded=start,
        force=jnp.zeros(start.shape),
        open=jnp.ones(batch, bool),
        fewest=jnp.full(batch, lanes + 1),
        patience=jnp.full(batch, FULL_EXCHANGES),
        steps=jnp.asarray(0),
    )
    search = jax.lax.while_loop(
        lambda at: (at.steps < MOST) & jnp.any(at.open), lambda at: _try(problem, at), begin
    )
    # A lane that carries nothing may be in the set by rounding.
    return search.loaded & (_solve(problem, search.loaded).force > 0.0), search.steps


def _try(problem: _Problem, at: _LaneSearch) -> _LaneSearch:
    """Exchange all wrong lanes while that leaves fewer of them, else one lane at a time."""
    found = _solve(problem, at.loaded)
    pulls = at.loaded & (found.force < -FEASIBLE)
    overlaps = problem.active & ~at.loaded & (found.slack < -FEASIBLE)
    count = jnp.sum(pulls | overlaps, axis=-1)
    careful = at.patience < 0
    patience = jnp.where(count < at.fewest, FULL_EXCHANGES, at.patience - 1)
    patience = jnp.where(careful, -1, patience)
    # Steps that lessen the energy need forces to start from that push and carry the load.
    first = _feasible(problem, found)
    descent, force = _descend(at, found, pulls, overlaps)
    loaded = jnp.where((patience < 0)[..., None], first > 0.0, at.loaded ^ (pulls | overlaps))
    return _LaneSearch(
        loaded=jnp.where(careful[..., None], descent, loaded),
        force=jnp.where(careful[..., None], force, first),
        open=count > 0,
        fewest=jnp.minimum(count, at.fewest),
        patience=patience,
        steps=at.steps + 1,
    )


def _feasible(problem: _Problem, found: _Solution) -> Rows:
    """Forces that push and carry the load, from some of which pull."""
    pushing = jnp.maximum(found.force, 0.0)
    carried = jnp.sum(problem.arm * pushing, axis=-1)
    return pushing * (problem.load / jnp.where(carried > 0.0, carried, 1.0))[..., None]


def _descend(
    at: _LaneSearch,
    found: _Solution,
    pulls: Bool[Array, "*b lane"],
    overlaps: Bool[Array, "*b lane"],
) -> tuple[Bool[Array, "*b lane"], Rows]:
    """A step that lessens the energy: drop the lane whose force ends first, else add the worst one."""
    drop = jnp.where(pulls, at.force - found.force, 1.0)
    until = jnp.where(pulls, at.force / drop, jnp.inf)
    part = jnp.minimum(jnp.min(until, axis=-1, keepdims=True), 1.0)
    force = at.force + part * (jnp.where(at.loaded, found.force, 0.0) - at.force)
    ends = pulls & _only(jnp.argmin(until, axis=-1), pulls)
    worst = jnp.argmin(jnp.where(overlaps, found.slack, jnp.inf), axis=-1)
    begins = overlaps & _only(worst, overlaps) & ~jnp.any(pulls, axis=-1, keepdims=True)
    return (at.loaded & ~ends) | begins, jnp.where(ends, 0.0, jnp.maximum(force, 0.0))


def _only(lane: Int[Array, "*b"], like: Bool[Array, "*b lane"]) -> Bool[Array, "*b lane"]:
    return lane[..., None] == jnp.arange(like.shape[-1])


def _as_if_alone(problem: _Problem) -> Bool[Array, "*b lane"]:
    """Lanes that would carry if none moved another: they touch one after the other."""
    first = problem.gap / jnp.where(problem.active, problem.arm, 1.0)
    stiffness = jnp.where(problem.active, problem.arm**2 / problem.own, 0.0)
    # A lane touches if the others carry less than the load by then. To sort them takes five times as long.
    carried = jnp.zeros_like(first)
    for lane in range(first.shape[-1]):
        closed = jnp.maximum(first - first[..., lane, None], 0.0)
        carried = carried + stiffness[..., lane, None] * closed
    return problem.active & (carried < problem.load[..., None])


def _solve(problem: _Problem, loaded: Bool[Array, "*b lane"]) -> _Solution:
    """Forces on these lanes and the approach, as if all of them could pull."""
    # Forces are linear in the approach, so that the load alone decides on it: one factorisation serves
    # both parts, and the approach never has to be looked for.
    sides = jnp.stack([problem.arm, problem.gap], axis=-1) * loaded[..., None]
    solved = _divided(problem, loaded, sides)
    stiffness = jnp.sum(sides[..., 0] * solved[..., 0], axis=-1)
    carries = stiffness > 0.0
    carried = problem.load + jnp.sum(sides[..., 0] * solved[..., 1], axis=-1)
    # With no lane at all the loaded body moves until every one is wrong. The derivative of a largest value
    # asks by an equality which one it is: 0/0 where a compiler rounds its two sides differently.
    far = FAR * (1.0 + jax.lax.stop_gradient(jnp.max(problem.gap, axis=-1)))
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    approach = jnp.where(carries, carried / jnp.where(carries, stiffness, 1.0), far)
    force = solved[..., 0] * approach[..., None] - solved[..., 1]
    slack = problem.moved(force) + problem.gap - problem.arm * approach[..., None]
    return _Solution(force, approach, stiffness, slack)


def _divided(
    problem: _Problem, loaded: Bool[Array, "*b lane"], by: Float[Array, "*b lane side"]
) -> Float[Array, "*b lane side"]:
    """Solution of C x = b on the loaded lanes; two last steps from it carry two orders of derivatives.

    Factors are not differentiated: that would solve for a whole matrix. The systems are taken one
    after the other, each from its factors to its last step: batches of them wait for threads of the pool
    that they run on (`_jax`), and factors put aside for all of them are copied more than they are used.
    """
    if problem.matrix is None:
        return by / problem.own[..., None]

    def alone(system: tuple[Array, Array]) -> Array:
        own, sides = system
        factors = jnp.linalg.cholesky(jax.lax.stop_gradient(own)), True
        found: Array = jax.scipy.linalg.cho_solve(factors, jax.lax.stop_gradient(sides))
        for _ in range(2):
            found = found + jax.scipy.linalg.cho_solve(factors, sides - own @ found)
        return found

    matrix = _masked(problem.matrix, loaded)
    matrix = jnp.broadcast_to(matrix, (*by.shape[:-2], *matrix.shape[-2:]))
    flat = matrix.reshape(-1, *matrix.shape[-2:]), by.reshape(-1, *by.shape[-2:])
    return jnp.reshape(jax.lax.map(alone, flat), by.shape)


def _residual(problem: _Problem, loaded: Bool[Array, "*b lane"], found: _Solution) -> Each:
    free = problem.active & ~loaded
    # Loaded lanes must close their gap, free ones only not overlap.
    overlap = jnp.where(loaded, jnp.abs(found.slack), jnp.where(free, -found.slack, 0.0))
    pull = jnp.where(loaded, -found.force, 0.0)
    carried = jnp.sum(problem.arm * found.force, axis=-1)
    violation = jnp.maximum(jnp.max(overlap, axis=-1), jnp.max(pull, axis=-1))
    worst = jnp.maximum(violation, jnp.abs(carried - problem.load))
    return jnp.where(jnp.any(loaded, axis=-1), jnp.maximum(worst, 0.0), jnp.inf)
