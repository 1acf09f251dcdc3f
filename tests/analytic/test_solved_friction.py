"""Friction of solved films: in turns with the balance of forces, over loss maps, and what refuses it."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from sound import PAIR, WAVE

from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.caveats import why_outside
from pitchpoint.analyses.cycle import CYCLE
from pitchpoint.analyses.loss_map import LOSS_MAP
from pitchpoint.analyses.operation import BACK_DRIVING, OPERATION
from pitchpoint.analyses.running import RUNNING
from pitchpoint.analyses.solved_films import FILM
from pitchpoint.analyses.summaries import profiles, summaries
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.variant import Variant
from pitchpoint.core.status import Code
from pitchpoint.efficiency.film_map import FilmMap
from pitchpoint.efficiency.gradients import mean_loss_gradient
from pitchpoint.efficiency.in_turns import in_turns
from pitchpoint.efficiency.quasi_static import cycle, cycle_of
from pitchpoint.efficiency.rows import NODES, one_engagement
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.lubrication.conditions import evaluate
from pitchpoint.lubrication.ehl import traction
from pitchpoint.lubrication.ehl.ehl_registry import SMOOTH
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.lubrication.ehl.traction import EHL_LINE, FilmTraction
from pitchpoint.lubrication.lubrication_registry import ROLLING_RESISTANCE
from pitchpoint.materials import lubricants

COARSE = FilmModel(nodes=33)
"""Few nodes, whose films take a fifth of the time."""


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Every case solves its films on few nodes."""
    monkeypatch.setitem(FRICTION._entries, "ehl_line", replace(EHL_LINE, films=COARSE))


def variant(text=PAIR, *, friction="ehl_line", **changes):
    tree = tomllib.loads(text)
    tree = {key: {**tree.get(key, {}), **changes.get(key, {})} for key in {**tree, **changes}}
    tree["models"] = {**tree.get("models", {}), "friction": friction}
    return Variant(tree, "pair.toml", "default")


def built(*args, **kwargs):
    return variant(*args, **kwargs).built({})


@pytest.fixture(scope="module")
def spur():
    """The shortest pair with the cycle whose films agree with its forces."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(FRICTION._entries, "ehl_line", replace(EHL_LINE, films=COARSE))
        case = built()
    return case, *solved(case)


def solved(case):
    """What the turns found at the operating point, and the cycle that follows."""
    load, models = case.operation.load, case.models[0]
    known = case.engaged or one_engagement(case.design, load, models.without_friction, NODES)
    found = in_turns(case.design, case.operation, models, known)
    return found, cycle_of(case.design, case.operation, known, found.balance)


@pytest.mark.whole
def test_films_and_forces_agree_as_in_a_loop_of_ones_own(spur):
    case, found, own = spur
    assert Code(int(found.status.code)).ok
    assert float(found.status.residual) <= 1e-6
    assert 2 <= int(found.status.iterations) <= 6
    carries = np.asarray(own.state.contacts.active)
    coefficients, models = np.full(carries.shape, 0.05), case.models[0]
    rolling = np.zeros(carries.shape)
    program = jax.jit(lambda *held: cycle(case.design, case.operation, models.holding(*held)))
    for _ in range(6):
        at = (found := program(*map(jnp.asarray, (coefficients, rolling)))).state.conditions
        films = solve_lines(
            case.models[0].law.films.contacts(
                line_load=np.asarray(at.line_load)[carries],
                radius=np.asarray(at.radius)[carries],
                modulus=float(at.modulus),
                speed_a=np.asarray(at.speed_a)[carries],
                speed_b=np.asarray(at.speed_b)[carries],
                oil=case.design.lubricant,
                temperature=float(case.operation.temperature),
                roughness_rq=float(case.design.roughness.composite_rq),
            ),
            nodes=33,
        )
        drawn = np.abs(films.film.shear_force + films.film.boundary_force)
        coefficients[carries] = drawn / np.asarray(at.line_load)[carries]
        rolling[carries] = films.film.rolling
    assert coefficients.max() > 0.01
    assert rolling[carries].min() > 1.0
    held = np.asarray(own.state.balance.friction)
    np.testing.assert_allclose(held, coefficients * carries, rtol=3e-6, atol=1e-9)
    lost = 1.0 - float(own.mean_efficiency)
    assert lost == pytest.approx(1.0 - float(found.mean_efficiency), rel=1e-6)


@pytest.mark.whole
def test_without_load_there_is_no_film_to_solve(spur):
    case, found, _ = spur
    models = case.models[0]
    idle = case.operation.__class__(**{**vars(case.operation), "load": array(0.0)})
    known = one_engagement(case.design, case.operation.load, models.without_friction, NODES)
    at_rest = in_turns(case.design, idle, models, known)
    assert Code(int(at_rest.status.code)).ok
    assert int(at_rest.status.iterations) == 1
    assert np.all(np.asarray(at_rest.balance.load) == 0.0)
    assert np.any(np.asarray(found.balance.load) > 0.0)


@pytest.mark.whole
def test_the_energy_closes(spur):
    _, _, own = spur
    state = own.state
    lost = np.asarray(state.loss)
    assert lost.min() >= 0.0
    power = np.asarray(state.input_power - state.output_power)
    np.testing.assert_allclose(power, lost, rtol=1e-9, atol=1e-9 * float(state.output_power.max()))
    at = state.conditions
    drawn = state.balance.load * state.balance.friction * jnp.abs(at.speed_a - at.speed_b)
    rolled = state.balance.rolling * jnp.abs(at.speed_a + at.speed_b)
    assert 0.02 * np.sum(drawn) < np.sum(rolled) < np.sum(drawn)
    whole = np.asarray(drawn + rolled).sum(axis=(0, 1))
    np.testing.assert_allclose(whole, lost, rtol=1e-12, atol=1e-12 * lost.max())


@pytest.mark.whole
def test_rolling_is_that_of_the_films_unless_the_case_has_a_model_of_it(spur):
    _, _, by_film = spur
    case = built(models={"rolling_resistance": "wu_cheng_1991"})
    named = np.asarray(solved(case)[1].state.rolling_loss)
    at = by_film.state.conditions
    law = ROLLING_RESISTANCE["wu_cheng_1991"]
    weight = np.asarray(by_film.state.contacts.weight)
    expected = 2.0 * np.asarray(evaluate(law, at)) * weight * np.asarray(at.entrainment)
    carries = np.asarray(by_film.state.contacts.active)
    np.testing.assert_allclose(named[carries], expected[carries], rtol=1e-4)
    off = np.abs(np.asarray(by_film.state.rolling_loss)[carries] / named[carries] - 1.0)
    assert 0.01 < off.max() < 0.15


@pytest.mark.whole
@pytest.mark.parametrize("text", [PAIR, WAVE], ids=["spur", "strain wave"])
def test_loss_and_efficiency_are_those_of_the_films_over_the_cycle(text):
    case = built(text, film={"solver": "line", "nodes": 33})
    parts = [FILM.compute(case, piece, lambda _: None) for piece in FILM.pieces(case)]
    data = FILM.joined(case, parts)
    assert data["mean_film_rolling_loss"].item() > 0.02 * data["mean_film_loss"].item()
    assert data["mean_law_loss"].item() == pytest.approx(data["mean_film_loss"].item(), rel=1e-5)
    lost = [1.0 - data[name].item() for name in ("law_efficiency", "film_efficiency")]
    assert lost[0] == pytest.approx(lost[1], rel=1e-5)


def coefficients(model, thinner=1.0, sliding=0.5):
    oil = lubricants.find("pao-vg-100").build()
    oil = replace(oil, nu_1=oil.nu_1 * thinner, nu_2=oil.nu_2 * thinner)
    speed, one = np.array([4.0, 8.0]), np.ones(2)
    law = FilmTraction(model, oil, 353.15)
    return law(
        line_load=1e5 * one,
        radius=0.01 * one,
        modulus=226e9 * one,
        speed_a=speed + sliding,
        speed_b=speed - sliding,
        roughness_rq=0.4e-6 * one,
    )


@pytest.mark.whole
def test_smooth_flanks_in_a_thin_oil_have_hardly_any_friction():
    """Shear eta u/h falls with the viscosity, as the film falls with less than its first power."""
    smooth = replace(COARSE, asperities=SMOOTH, shear_law="newtonian", density_law="incompressible")
    usual, thin = (coefficients(smooth, part, 1e-3) for part in (1.0, 0.3))
    assert (thin < 0.7 * usual).all()
    assert (coefficients(smooth, sliding=0.0) < 1e-12).all()
    rough = coefficients(COARSE)
    assert (rough > coefficients(replace(COARSE, asperities=SMOOTH))).all()
    assert (rough < COARSE.boundary_friction).all()


@pytest.mark.whole
def test_films_of_all_turns_are_counted():
    one, counted = np.ones(2), []
    oil = lubricants.find("pao-vg-100").build()
    law = FilmTraction(COARSE, oil, 353.15, rolling=True, progress=counted.append)
    for _ in range(2):
        found = law(
            line_load=1e5 * one,
            radius=0.01 * one,
            modulus=226e9 * one,
            speed_a=np.array([4.0, -4.0]),
            speed_b=np.array([3.0, -3.0]),
            roughness_rq=0.4e-6 * one,
        )
    assert counted == [2, 4]
    np.testing.assert_allclose(found[:, 0], found[:, 1], rtol=1e-9)
    assert (found > 0.0).all()


def test_films_are_solved_by_the_choices_of_the_case():
    chosen = {"solver": "line", "nodes": 65, "boundary_friction": 0.08}
    (models,) = built(film=chosen).models
    assert models.law.films == FilmModel(nodes=65, boundary_friction=0.08, inlet=2e-3)
    assert models.film == built(friction="xu_2007").models[0].film  # for the range of laws


@pytest.mark.whole
def test_points_of_a_sweep_have_films_by_their_own_choices():
    film = {"solver": "line", "nodes": 33}
    points = [built(film={**film, "boundary_friction": one}) for one in (0.05, 0.1)]
    points.append(built(film={**film, "inlet": "0.12 mm"}))
    found = summaries(points, points[0].models, {}, title="sweep", several=True)
    swept, why = found["mean_loss"].values[0], found["out_of_range"].values[0]
    for point, marked in zip(points, why.tolist(), strict=True):
        (run,) = profiles(point, point.models)
        reasons = why_outside(point, point.models[0].law, run)
        assert len(marked.split("; ")) == len(reasons)  # one a few words, the other a sentence
        assert ("starved" in marked) == (point is points[2])
    assert "out of its range at 3 of 3 points" in found.attrs["warnings"]
    alone = [summarise([(one.design, one.operation)], one.models[0])["mean_loss"] for one in points]
    np.testing.assert_array_equal(swept, np.concatenate(alone))
    assert swept[1] > 1.05 * swept[0]
    assert swept[2] != pytest.approx(swept[1], rel=1e-3)


@pytest.mark.whole
def test_a_film_that_was_not_solved_gives_no_numbers(monkeypatch):
    def losing(contacts, **asked):
        films = solve_lines(contacts, **asked)
        codes = np.array(films.ended.code)
        codes[0] = Code.NOT_CONVERGED
        return replace(films, ended=replace(films.ended, code=codes))

    case = built(operation={"torque": "51 N m"})
    good = built(operation={"torque": "52 N m"})
    fine = summarise([(good.design, good.operation)], good.models[0])
    assert fine["turns_code"][0] == Code.SOLVED
    monkeypatch.setattr(traction, "solve_lines", losing)
    with pytest.raises(ConvergenceError, match="film of a contact that carries was not solved"):
        OPERATION.compute(case, {}, lambda _: None)
    with pytest.raises(
        ConvergenceError, match="film of 1 of 96 contacts that carry was not solved"
    ):
        CYCLE.compute(case, {}, lambda _: None)
    under = (good.models[0],)
    swept = summaries(
        [replace(case, models=under), replace(good, models=under)], under, {}, title="sweep"
    )
    assert np.isnan(swept["mean_efficiency"].values).tolist() == [[True, False]]
    assert np.isnan(swept["mean_loss"].values).tolist() == [[True, False]]
    assert "at 1 of 2 points the film of a contact" in swept.attrs["warnings"]
    assert json.loads(swept.attrs["solve"])["code"] == Code.NOT_CONVERGED


HELICAL = {"helix_angle": "15 deg"}


@pytest.mark.whole
@pytest.mark.parametrize("case", ["helical", "strain wave"])
def test_other_families_follow(case):
    one = built(WAVE) if case == "strain wave" else built(gears=HELICAL, models={"slices": 2})
    data = OPERATION.compute(one, {}, lambda _: None)
    assert 2 <= data["turns"].item() <= 8
    assert data["turns_change"].item() <= 1e-6
    assert 0.6 < data["mean_efficiency"].item() < 1.0
    assert 0.0 < data["mean_friction"].item() < COARSE.boundary_friction
    assert json.loads(data.attrs["solve"])["code"] == Code.SOLVED


@pytest.mark.whole
def test_back_driving_is_solved_too():
    forth = built(friction=["constant", "ehl_line"])
    data = OPERATION.compute(forth, {}, lambda _: None)
    back = BACK_DRIVING.compute(forth, {}, lambda _: None)
    assert data["law"].values.tolist() == ["constant", "ehl_line"]
    assert (data["turns"].values > 0).ravel().tolist() == [False, True]
    lost = 1.0 - np.stack([data["mean_efficiency"], back["mean_efficiency"]])[:, 1, 0]
    assert lost[0] == pytest.approx(lost[1], rel=0.05)


def test_a_map_between_levels_is_the_polynomial_through_them():
    axes = np.log([10.0, 40.0, 90.0]), np.log([5.0, 20.0]), np.array([300.0, 320.0, 360.0])

    def law(load, speed, degree):
        x, y, z = np.log(load), np.log(speed), degree / 300.0
        return 0.02 + 1e-3 * x * y - 2e-4 * x**2 * z**2 + 1e-3 * z * y

    grid = law(*np.meshgrid(*map(np.exp, axes[:2]), axes[2], indexing="ij"))
    films = FilmMap(axes, np.multiply.outer(grid, np.arange(1.0, 7.0).reshape(2, 1, 3)))
    speeds, degrees = np.array([6.0, 11.0]), np.array([310.0, 333.0, 350.0])
    (found,) = films.at(25.0, speeds, degrees)
    assert found.shape == (2, 1, 2, 3, 3)
    expected = law(25.0, *np.meshgrid(speeds, degrees, indexing="ij"))
    np.testing.assert_allclose(found[1, 0, :, :, 0], 4.0 * expected, rtol=1e-12)
    rolling = replace(films, rolling=2.0 * films.friction)
    (ends, twice) = rolling.at(0.0, np.array([1.0, 5.0]), np.array([300.0]))
    np.testing.assert_allclose(ends[0, 0, :, 0, 0], law(10.0, 5.0, 300.0), rtol=1e-12)
    np.testing.assert_allclose(twice, 2.0 * ends, rtol=1e-12)


@pytest.mark.whole
def test_a_loss_map_rests_on_films_at_few_points():
    asked = {"torque": "60 N m", "speed": "1800 rpm", "count": 6, "temperatures": ["60 degC"]}
    case = built(friction=["constant", "ehl_line"], loss_map=asked)
    assert LOSS_MAP.lacks(case) is None
    parts = [LOSS_MAP.compute(case, piece, lambda _: None) for piece in LOSS_MAP.pieces(case)]
    data = LOSS_MAP.joined(case, parts)
    loss = data["mean_loss"].sel(law="ehl_line").values[:, :, 0]
    assert (loss[:, 0] == 0.0).all() and (loss[0] == 0.0).all()
    assert (np.diff(loss[1:, 1:], axis=0) > 0.0).all()
    (told,) = (text for text in json.loads(data.attrs["warnings"]) if "half way" in text)
    assert "16 operating points for the 36 of the map" in told
    assert float(told.partition("up to ")[2].partition(" %")[0]) < 3.0
    point = case.operation
    there = replace(point, load=jnp.asarray(data["torque"].values[3]))
    there = replace(there, speed=jnp.asarray(data["speed"].values[4]))
    exact = summarise([(case.design, there)], case.models[1])["mean_loss"][0]
    assert loss[3, 4] == pytest.approx(exact, rel=0.02)


def test_what_takes_a_formula_says_so():
    case = built()
    with pytest.raises(InputError, match="takes a friction law that is a formula"):
        mean_loss_gradient(case.design, case.operation, case.models[0])
    assert "very many operating points, and 'ehl_line' solves" in LOSS_MAP.lacks(case)
    beside = {"seal": {"between": ["gear 1", "housing"], "seal_torque": "0.1 N m"}}
    assert "very many operating points" in RUNNING.lacks(built(losses=beside))
    assert "very many operating points" in LOSS_MAP.lacks(built(WAVE))
    with pytest.raises(
        InputError, match="loss_map: teeth with gaps share each load in another way"
    ):
        built(WAVE, loss_map={"count": 3})
    with pytest.raises(InputError, match="a motion follows from the first friction law of a case"):
        built(dynamics={"damping_ratio": 0.1, "motion": {}})
    with pytest.raises(
        InputError, match="the heat of the teeth follows from the first friction law"
    ):
        built(models={"tooth_temperature": "vdi_2736_2"}, materials={"gear_2": "POM-H"})


TORUS = {"family": "torus", "torus_radius": ["35 mm", "55 mm"], "face_width": ["15 mm", "20 mm"]}


def test_ellipses_are_refused_in_one_sentence():
    with pytest.raises(InputError, match="'ehl_line' holds for line contacts") as error:
        built(
            gears={**TORUS, "teeth": [40, 49], "module": "2.5 mm"},
            models={"film_thickness": "hamrock_dowson_1977"},
        )
    assert "\n" not in str(error.value)
