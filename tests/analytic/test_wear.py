"""Wear of flanks: closed forms, volumes against the work of friction, VDI 2736, the march, worn surfaces."""

from dataclasses import replace
from functools import cache
from typing import Any

import equinox as eqx
import numpy as np
import pytest
from vdi_2736_wear import mean_wear_depth
from worn_pairs import (
    CELLS,
    EXAMPLES,
    LENGTH,
    LOAD,
    OWN,
    PARTS,
    RADII,
    WEAR,
    K,
    begun,
    discs,
    pair,
    turn,
)
from worn_together import worn_together

from pitchpoint._jax import array, jax, jnp
from pitchpoint.cases.built import Built
from pitchpoint.contact.contacts import total
from pitchpoint.efficiency.quasi_static import cycle
from pitchpoint.lubrication.conditions import Conditions
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.runs.run import load_case
from pitchpoint.sizing.three_k import mesh_efficiency
from pitchpoint.wear import film_share
from pitchpoint.wear.history import Cells, DriverTurn, WearModel, unworn_start, wear_of_turn
from pitchpoint.wear.march import Limit, Rate, Reached, unworn_flanks, wear_step
from pitchpoint.wear.wear_gradients import march_sensitivities


@cache
def of_pair(name: str = "from_stiffness", cells: int = CELLS) -> tuple[DriverTurn, Cells]:
    return turn(pair(name), cells)


def test_flanks_of_a_gear_are_worn_by_each_of_its_mates():
    """Three planets wear a sun three times as fast as one; each of them as before."""
    built = pair()
    start, grid = begun(built)
    three = replace(WEAR, mates=array([3.0, 1.0]))
    given = built.design, built.operation, built.models[0], three
    found = jax.device_get(wear_of_turn(*given, grid, start, jnp.zeros(grid.shape)))
    alone = of_pair()[0]
    for got, want in ((found.depth, alone.depth), (found.volume, alone.volume)):
        assert got[0] == pytest.approx(3.0 * want[0], rel=1e-14)
        assert np.array_equal(got[1], want[1])
    assert found.depth[0].max() > 0.0


def test_discs_wear_by_their_line_load_and_sliding_over_rolling():
    given, ratio = discs(), 0.8
    start, cells = unworn_start(*given, parts=PARTS, count=CELLS)

    def rate(depth: np.ndarray) -> Rate:
        return Rate.of(wear_of_turn(*given, WEAR, cells, start, array(depth)))

    reached = marched(rate, (2, CELLS, 1), 1e9)
    # Disc 1 turns by the ratio of speeds and radii while disc 0 turns once.
    sliding = 1.0 - ratio
    each = np.array([sliding, sliding / ratio * ratio * RADII[0] / RADII[1]])
    expected = 1e9 * K * LOAD / LENGTH * each
    assert reached.depth.max(axis=(1, 2)) == pytest.approx(expected, rel=1e-10)
    assert reached.depth.min(axis=(1, 2)) == pytest.approx(expected, rel=1e-10)


@pytest.mark.whole
def test_many_discs_together_wear_as_each_of_them():
    given, cells = discs(), unworn_start(*discs(), parts=PARTS, count=CELLS)[1]
    loads, turns = np.array([1.0, 2.0, 0.5]) * LOAD, np.array([1e9, 1e6, 1e9])
    limit = np.array([np.inf, np.inf, 1e-5])

    def many(leaf: Any) -> Any:
        return jnp.broadcast_to(leaf, (3, *jnp.shape(leaf))) if eqx.is_array(leaf) else leaf

    inputs = jax.tree.map(many, (*given[:2], WEAR))
    inputs = eqx.tree_at(lambda one: one[1].load, inputs, array(loads))
    limits = array(turns), array(limit), array(1e-3)
    found = jax.device_get(worn_together(inputs, given[2], cells, PARTS, *limits))
    assert np.all(found.found)
    assert found.turns[:2] == pytest.approx(turns[:2])
    expected = K * loads / LENGTH * 0.2 * found.turns
    assert found.depth[:, 0].max(axis=(1, 2)) == pytest.approx(expected, rel=1e-10, abs=0.0)
    assert found.depth[2].max() == pytest.approx(1e-5, rel=1e-6, abs=0.0)


def marched(
    rate: Any, shape: tuple[int, int, int], turns: float, tolerance: float = 1e-3
) -> Reached:
    state = unworn_flanks(rate, shape)
    start = state.rate.pressure
    while not state.end:
        state = wear_step(state, rate, Limit(turns), start=start, tolerance=tolerance)
    assert state.end == "turns"
    assert state.turns == turns
    return state


def test_volume_is_that_of_the_work_of_friction():
    """By Archard's law volume is K/H times force times sliding, as the loss is by its coefficient."""
    found, cells = of_pair("equal")
    of_cells = np.asarray(cells.volumes(array(found.depth)))
    assert of_cells == pytest.approx(found.volume, rel=1e-12)
    assert np.all(found.depth >= 0.0)
    built = pair("equal")
    slight = jnp.full((1, 1, 1), 1e-6)
    cycle_of = jax.device_get(_sliding(built, slight))
    per_turn = float(cycle_of) / 1e-6 * 2.0 * np.pi / float(built.operation.speed)
    teeth = np.array([23.0, 61.0])
    assert found.volume * teeth == pytest.approx([K * per_turn] * 2, rel=1e-3)


def _sliding(built: Built, coefficient: jax.Array) -> jax.Array:
    """Mean loss by sliding under a friction coefficient."""
    models = built.models[0].without_friction.holding(coefficient)

    @jax.jit
    def loss() -> jax.Array:
        found = cycle(built.design, built.operation, models)
        return found.mean(total(found.state.sliding_loss))

    return loss()


@pytest.mark.parametrize("count", [CELLS // 2, CELLS])
def test_the_deepest_places_are_the_ends_of_the_path_whatever_the_cells(count: int):
    """Half of the load times sliding over rolling at A and E, from base and tip circles alone."""
    found, cells = of_pair("equal", count)
    built = pair("equal")
    mesh, teeth = built.design.mesh, np.array([23.0, 61.0])
    base, tips = np.asarray(mesh.base_radii), np.asarray(mesh.tip_radii)
    far = np.sqrt(tips**2 - base**2)[::-1]
    near = np.sqrt(float(mesh.centre_distance) ** 2 - base.sum() ** 2) - far
    half = float(built.operation.load) / base[1] / float(mesh.face_width) / 2.0
    # Gear 1 drives: a turn of it turns gear 2 by 23 of its 61 teeth.
    turns = np.array([1.0, 23.0 / 61.0])
    expected = K * half * turns * (far / near * teeth / teeth[::-1] - 1.0)
    assert found.depth.max(axis=(1, 2)) == pytest.approx(expected, rel=1e-3)
    assert np.all(found.depth[:, : cells.count].max(axis=(1, 2)) < 0.97 * expected)
    halves = np.repeat(found.depth[:, :count:2] + found.depth[:, 1:count:2], 2, axis=1) / 2.0
    merged = cells.merged(found.depth)
    assert merged[:, :count] == pytest.approx(halves, rel=1e-12)
    assert np.array_equal(merged[:, count:], found.depth[:, count:])


def test_the_mean_depth_is_that_of_the_guideline_for_plastics():
    found, _ = of_pair("equal")
    built = pair("equal")
    mesh = built.design.mesh
    line, (_, tips) = mesh.line, jax.device_get((built.design.period, mesh.line.limits))
    pitch, place = float(line.base_pitch), float(line.pitch_position)
    parts = np.array([place - tips[0], tips[1] - place])
    z1, z2 = (abs(float(z)) for z in mesh.teeth)
    recess, approach = parts[1] / pitch, parts[0] / pitch
    teeth, parts = (np.array(z1), np.array(z2)), (np.array(recess), np.array(approach))
    factor = 1.0 - mesh_efficiency(teeth, parts, 1.0)
    torque = float(built.operation.load) * z1 / z2
    ends = np.asarray(mesh.active_flanks)[0]
    length = abs(ends[1] ** 2 - ends[0] ** 2) / (2.0 * float(mesh.base_radii[0]))
    expected = mean_wear_depth(
        torque=torque,
        turns=1.0,
        loss_factor=factor,
        rate=K,
        face_width=float(mesh.face_width),
        teeth=z1,
        flank_length=length,
    )
    mean = found.volume[0] / (float(mesh.face_width) * length)
    assert mean == pytest.approx(float(expected), rel=2e-3)


def test_nothing_wears_where_the_flanks_roll():
    """At the pitch point: what its cell loses is half as much in cells of half the length."""
    least = []
    for count in (CELLS // 2, CELLS, 2 * CELLS):
        found, cells = of_pair("equal", count)
        mesh = pair("equal").design.mesh
        roll = float(mesh.line.pitch_position)
        place = roll**2 / (2.0 * float(mesh.base_radii[0]))
        edges = np.linspace(*np.asarray(cells.flank)[0], count + 1)
        at = int(np.searchsorted(edges, place)) - 1
        of_cells = found.depth[0, :count, 0]
        least.append(of_cells[at - 1 : at + 2].mean() / of_cells.max())
        inner = of_cells[2:-2]
        assert abs(int(np.argmin(inner)) + 2 - at) <= 1
    assert least[1] / least[0] == pytest.approx(0.5, abs=0.12)
    assert least[2] / least[1] == pytest.approx(0.5, abs=0.12)


# ---- the march


def rate_of(built: Built, cells: int = CELLS) -> tuple[Any, tuple[int, int, int]]:
    start, grid = begun(built, cells)
    given = built.design, built.operation, built.models[0], WEAR, grid, start

    def rate(depth: np.ndarray) -> Rate:
        return Rate.of(wear_of_turn(*given, array(depth)))

    return rate, grid.shape


@pytest.mark.whole
def test_shorter_steps_change_the_depth_within_the_stated_error():
    rate, shape = rate_of(pair())
    coarse = marched(rate, shape, 3e6, tolerance=1e-2)
    fine = marched(rate, shape, 3e6, tolerance=1e-4)
    apart = np.abs(coarse.depth - fine.depth).max(axis=(1, 2))
    assert np.all(apart <= coarse.error)
    assert np.all(coarse.error < 0.1 * coarse.deepest)
    assert np.all(np.diff([coarse.deepest.max(), fine.deepest.max()]) < 0.02 * fine.deepest.max())


def test_worn_flanks_hand_the_load_to_those_that_are_less_worn():
    """Double contact takes load off the deepest places: they wear more slowly, and volume stays."""
    rate, shape = rate_of(pair())
    new, worn = rate(np.zeros(shape)), marched(rate, shape, 3e6)
    deepest = np.unravel_index(np.argmax(worn.depth), shape)
    assert worn.rate.depth[deepest] < 0.9 * new.depth[deepest]
    volumes = [one.depth.sum(axis=(1, 2)) for one in (new, worn.rate)]
    assert volumes[1] == pytest.approx(volumes[0], rel=0.3)


@pytest.mark.whole
def test_the_number_of_steps_does_not_grow_with_the_cycles():
    given = discs()
    start, cells = unworn_start(*given, parts=PARTS, count=CELLS)

    def steps(coefficient: float, turns: float) -> int:
        asked: list[int] = []
        slow = replace(WEAR, own=(dict(OWN, coefficient=array(coefficient)),) * 2)

        def rate(depth: np.ndarray) -> Rate:
            asked.append(1)
            found = wear_of_turn(*given, slow, cells, start, array(depth))
            return Rate(
                np.asarray(found.depth), float(found.pressure), False, False, bool(found.lost)
            )

        marched(rate, (2, CELLS, 1), turns)
        return len(asked)

    assert steps(1e-4, 1e4) == steps(1e-10, 1e10) < 40


def test_without_wear_nothing_changes():
    rate, shape = rate_of(pair())
    state = unworn_flanks(lambda depth: replace(rate(depth), depth=np.zeros(shape)), shape)
    assert state.end == "no wear"
    assert not state.depth.any()


def at_depth(built: Built, wear: WearModel, depth: float) -> list[Reached]:
    """The steps of a march to a depth, short ones."""
    start, grid = begun(built)
    given = built.design, built.operation, built.models[0], wear, grid, start

    def rate(depth: np.ndarray) -> Rate:
        return Rate.of(wear_of_turn(*given, array(depth)))

    states = [unworn_flanks(rate, grid.shape)]
    limit, first = Limit(1e12, depth=depth), states[0].rate.pressure
    while not states[-1].end:
        states.append(wear_step(states[-1], rate, limit, start=first, tolerance=1e-5))
    assert states[-1].end == "depth"
    return states


def more(wear: WearModel, name: str, part: float) -> WearModel:
    first, second = wear.own
    return replace(wear, own=({**first, name: first[name] * (1.0 + part)}, second))


@pytest.mark.whole
def test_sensitivities_of_the_life_are_those_of_differences():
    """Two humps that relieve each other as they deepen, against whole marches of changed inputs."""
    built, depth, step = pair(), 3e-6, 5e-3
    states = at_depth(built, WEAR, depth)
    inputs, (_, cells) = (built.design, built.operation, WEAR), begun(built)
    turns, worn = (np.stack([getattr(one, name) for one in states]) for name in ("turns", "depth"))
    found = march_sensitivities(inputs, built.models[0], cells, PARTS, turns, worn)

    def changed(name: str, part: float) -> tuple[Built, WearModel]:
        operation, solids = built.operation, built.design.solids
        if name == "load":
            return replace(
                built, operation=replace(operation, load=operation.load * (1.0 + part))
            ), WEAR
        if name == "module":
            settings = {
                "gears.module": f"{1e3 * float(built.design.mesh.module) * (1.0 + part)!r} mm"
            }
            given = {"models.load_sharing": "from_stiffness", **settings}
            return load_case(str(EXAMPLES / "pair_23_61.toml"), settings=given), WEAR
        if name == "Young's modulus 2":
            other = replace(solids[1], young=solids[1].young * (1.0 + part))
            return replace(built, design=replace(built.design, solids=(solids[0], other))), WEAR
        return built, more(WEAR, name.removesuffix(" 1"), part)

    for name in ("load", "module", "Young's modulus 2", "coefficient 1"):
        lives = [at_depth(*changed(name, way * step), depth)[-1].turns for way in (1.0, -1.0)]
        slope = np.log(lives[0] / lives[1]) / np.log((1.0 + step) / (1.0 - step))
        assert found[name].life == pytest.approx(slope, rel=1e-3, abs=1e-5), name
    assert found["speed"].life == pytest.approx(0.0, abs=1e-9)
    assert not {"centre distance", "tip alteration 1"} & {*found}  # they follow from the others


@pytest.mark.whole
def test_flanks_that_count_as_new_wear_by_their_first_rate():
    """At a rate that stays, the depth changes as the rate does, and the life the other way."""
    built, (_, cells) = pair(), begun(pair())
    first = np.asarray(turn(built)[0].depth)
    turns, worn = np.array([0.0, 1e7]), first * np.array([0.0, 1e7])[:, None, None, None]
    given = (built.design, built.operation, WEAR), built.models[0], cells, PARTS, turns, worn
    for name, one in march_sensitivities(*given, updated=False).items():
        assert one.depth == pytest.approx(one.rate, abs=1e-12), name
        assert one.life == pytest.approx(-one.rate, abs=1e-12), name


@pytest.mark.whole
def test_sensitivities_of_discs_are_the_powers_of_archard():
    given = discs()
    start, cells = unworn_start(*given, parts=PARTS, count=CELLS)
    first = np.asarray(wear_of_turn(*given, WEAR, cells, start, jnp.zeros((2, CELLS, 1))).depth)
    turns, worn = np.array([0.0, 1e8, 3e8]), first * np.array([0.0, 1e8, 3e8])[:, None, None, None]
    found = march_sensitivities((*given[:2], WEAR), given[2], cells, PARTS, turns, worn)
    of_sliding = -0.8 / (1.0 - 0.8)
    powers = {"load": 1.0, "length": -1.0, "speed": 0.0, "speed ratio": of_sliding}
    for name, power in powers.items():
        assert found[name] == pytest.approx((power, power, -power), abs=1e-9), name


def test_the_march_ends_where_a_measure_of_the_teeth_does():
    shape = (2, 4, 1)
    depth = np.array([2e-12, 1e-12])[:, None, None] * np.ones(shape)
    rate, play = Rate(depth, 1e9, False, False, False), 3e-6
    state = unworn_flanks(lambda _: rate, shape)
    limit = Limit(1e9, teeth=(("backlash", lambda one: one[:, 0, 0].sum() - play),))
    while not state.end:
        state = wear_step(state, lambda _: rate, limit, start=1e9, tolerance=1e-3)
    assert state.end == "backlash"
    assert state.turns == pytest.approx(1e6, rel=1e-3)
    assert state.depth.sum(axis=0)[0, 0] == pytest.approx(play, rel=1e-3)


def test_the_march_ends_where_the_pressure_reaches_the_hardness():
    shape = (2, 4, 1)

    def rate(depth):
        pressure = 1e9 + 1e14 * float(np.max(depth))
        return Rate(1e-12 * np.ones(shape), pressure, False, False, False)

    state, limit = unworn_flanks(rate, shape), Limit(1e9, hardness=1.96e9)
    while not state.end:
        state = wear_step(state, rate, limit, start=1e9, tolerance=1e-3)
    assert state.end == "hardness"
    assert state.rate.pressure == pytest.approx(1.96e9, rel=1e-3)
    assert state.turns == pytest.approx(0.96e9 / 1e14 / 1e-12, rel=1e-3)


# ---- the load on asperities


def by_share(*, coefficient: Any, hardness: Any, asperity_share: Any) -> Any:
    return coefficient / hardness * asperity_share


FILMS = WearModel(by_share, (OWN, OWN), films=FilmModel(nodes=33))


@pytest.mark.whole
def test_films_tell_the_load_on_asperities(monkeypatch):
    built = pair("equal")
    given, seen = (built.design, built.operation, built.models[0]), []
    start, cells = begun(built)
    own = film_share.asperity_share

    def told(model: FilmModel, at: Conditions, *oil: Any) -> np.ndarray:
        seen.append((at, own(model, at, *oil)))
        return seen[-1][1]

    monkeypatch.setattr("pitchpoint.wear.history.asperity_share", told)
    none = jnp.zeros(cells.shape)
    found = wear_of_turn(*given, FILMS, cells, start, none)
    ((at, share),) = seen
    load = np.asarray(at.load)
    assert not share[load == 0.0].any()
    assert np.all((share[load > 0.0] > 0.0) & (share[load > 0.0] < 1.0))
    # Each as if it were alone.
    lane = np.unravel_index(np.argmax(share), share.shape)
    names = ("line_load", "radius", "speed_a", "speed_b", "modulus", "roughness_rq")
    values = {name: np.broadcast_to(getattr(at, name), load.shape)[lane] for name in names}
    oil = {"oil": built.design.lubricant, "temperature": built.operation.temperature}
    alone = film_share.solve_lines(FILMS.films.contacts(**values, **oil), nodes=33)
    assert float(alone.film.asperity_share) == pytest.approx(share[lane], rel=1e-6)
    dry, _ = of_pair("equal")
    low, high = share[load > 0.0].min(), share.max()
    assert np.all((found.volume > low * dry.volume) & (found.volume < high * dry.volume))
    assert not bool(found.lost)


@pytest.mark.whole
def test_a_film_that_is_not_solved_is_never_a_result(monkeypatch):
    own = film_share.solve_lines

    def but_one(*given: Any, **options: Any) -> Any:
        films = own(*given, **options)
        films.ended.code[3] = 1
        assert not films.solved[3]
        return films

    monkeypatch.setattr(film_share, "solve_lines", but_one)
    built = pair("equal")
    start, cells = begun(built)
    none = jnp.zeros(cells.shape)
    given = built.design, built.operation, built.models[0], FILMS
    assert bool(wear_of_turn(*given, cells, start, none).lost)
