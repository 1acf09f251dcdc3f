"""Any case that the schema lets through ends in finite, sensible results or in one clear sentence."""

import dataclasses
import itertools
import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from sound import PAIR

from pitchpoint.analyses.operation import OPERATION
from pitchpoint.cases.built import Built
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.gears_table import WIDTH
from pitchpoint.input.kinds import SPEED, TEMPERATURE, TORQUE
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.material_tables import (
    ALPHA,
    DENSITY,
    FACTOR,
    MODULUS,
    POISSON,
    ROUGHNESS,
    SLOPE,
    VISCOSITY,
)
from pitchpoint.units import si_unit

LANES = 5  # one compiled program serves all contact ratios below it
EXAMPLES = 150
SEED = 1
"""Thousands are drawn by `pytest tests/long/many_random_cases.py`."""

# Each sharing and each rolling resistance, in as few compiled programs as that takes.
SHARINGS = [name for name, model in LOAD_SHARING.items() if model.flanks != "apart"]
OF_LINES = [name for name, one in ROLLING_RESISTANCE.items() if one.shape != "ellipse"]
PAIRED = list(zip(SHARINGS, itertools.cycle(OF_LINES)))

# Read before anything is drawn: checks of types look at random entries, which strategies must not.
OILS, BASE_OILS = list(lubricants.catalogue()), list(lubricants.base_oils())
SOLIDS = list(solids.catalogue())


def between(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


def of(quantity: Any, low: float | None = None, high: float | None = None) -> Any:
    """Text of a quantity, usual values most of the time and its whole range else."""
    usual = between(
        low if low is not None else quantity.low, high if high is not None else quantity.high
    )
    bound = quantity.low if quantity.low > 0.0 or not quantity.open_low else 1e-6
    number = st.one_of(usual, usual, usual, between(bound, quantity.high))
    return number.map(lambda value: f"{value!r} {si_unit(quantity.kind)}".strip())


def pair(values: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.one_of(values, st.tuples(values, values).map(list))


@st.composite
def gears(draw: st.DrawFn) -> dict[str, Any]:
    table = {
        "teeth": draw(pair(st.one_of(st.integers(5, 150), st.integers(17, 150)))),
        "module": draw(st.sampled_from(["0.05 mm", "0.5 mm", "2 mm", "10 mm", "100 mm"])),
        "face_width": draw(of(WIDTH, 0.005, 0.1)),
        "profile_shift": draw(pair(between(-0.3, 0.8))),
    }
    if draw(st.booleans()):
        table["addendum"] = draw(pair(between(0.7, 1.3)))
    if draw(st.integers(0, 3)) == 0:
        table["pressure_angle"] = f"{draw(between(14.5, 30.0))!r} deg"
    if draw(st.integers(0, 5)) == 0:
        table["tip_alteration"] = draw(pair(between(-0.3, 0.05)))
    if draw(st.integers(0, 5)) == 0:
        table["fillet_radius"] = draw(pair(between(0.0, 0.4)))
    if draw(st.integers(0, 5)) == 0:
        table["flank"] = "right"
    return table


@st.composite
def oils(draw: st.DrawFn) -> dict[str, Any]:
    if draw(st.booleans()):
        table: dict[str, Any] = {"name": draw(st.sampled_from(OILS))}
    else:
        thin = draw(between(2.0, 50.0))
        table = {
            "base": draw(st.sampled_from(BASE_OILS)),
            "viscosity_40": f"{thin * draw(between(1.05, 20.0))!r} mm2/s",
            "viscosity_100": f"{thin!r} mm2/s",
        }
    for key, values in {
        "density": of(DENSITY, 700.0, 1100.0),
        "density_slope": of(SLOPE, 0.3, 1.0),
        "pressure_viscosity": of(ALPHA, 5e-9, 5e-8),
        "lubricant_factor": of(FACTOR, 0.5, 1.5),
        "temperature_min": of(TEMPERATURE, 200.0, 290.0),
        "temperature_max": of(TEMPERATURE, 360.0, 600.0),
        "viscosity_100": of(VISCOSITY, 2e-6, 5e-5),
    }.items():
        if draw(st.integers(0, 9)) == 0:
            table[key] = draw(values)
    return table


def surfaces() -> st.SearchStrategy[dict[str, Any]]:
    height = of(ROUGHNESS, 0.0, 1.5e-6)
    return st.one_of(
        st.fixed_dictionaries({"ra": pair(height)}),
        st.fixed_dictionaries({"rq": pair(height)}),
        st.fixed_dictionaries({"composite_rq": height}),
    )


def materials() -> st.SearchStrategy[dict[str, Any]]:
    value = st.fixed_dictionaries(
        {"young": of(MODULUS, 1e9, 4e11), "poisson": between(POISSON.low, POISSON.high)}
    )
    either = st.one_of(st.sampled_from(SOLIDS), value)
    return st.fixed_dictionaries({}, optional={"gear_1": either, "gear_2": either})


@st.composite
def cases(draw: st.DrawFn) -> dict[str, Any]:
    sharing, rolling = draw(st.sampled_from(PAIRED))
    law = st.sampled_from(list(FRICTION))
    constant = st.fixed_dictionaries(
        {"name": st.just("constant"), "coefficient": between(0.0, 2.0)}
    )
    return {
        "source": "tian_2024",  # compiles the laws of that case in, so that they can be drawn
        "gears": draw(gears()),
        "materials": draw(materials()),
        "lubricant": draw(oils()),
        "roughness": draw(surfaces()),
        "operation": {
            "torque": draw(st.one_of(st.just("0 N m"), of(TORQUE, 0.0, 500.0))),
            "speed": draw(of(SPEED, 0.01, 2000.0)),
            "temperature": draw(of(TEMPERATURE, 290.0, 370.0)),
            "driver": draw(st.sampled_from(["gear 1", "gear 2"])),
        },
        "models": {
            "friction": draw(
                st.one_of(law, constant, st.lists(law, min_size=1, max_size=3, unique=True))
            ),
            "load_sharing": sharing,
            "rolling_resistance": rolling,
            "averaging": draw(st.sampled_from(["base_pitch", "path"])),
        },
    }


def computed(case: dict[str, Any]) -> tuple[Built, xr.Dataset]:
    built = Variant(case, "random.toml", "default").built({})
    if built.design.mesh.lanes < LANES:
        mesh = dataclasses.replace(built.design.mesh, lanes=LANES)
        built = dataclasses.replace(built, design=dataclasses.replace(built.design, mesh=mesh))
    return built, OPERATION.compute(built, {}, lambda _: None)


def check(data: xr.Dataset, transmits: bool) -> None:
    """Finite, in the range that physics allows, and consistent."""
    of_efficiency = ("efficiency", "efficiency_fluctuation")
    for name, values in data.data_vars.items():
        # Infinite where friction pushes on, and where surfaces are smooth or carry nothing.
        if "jamming" in str(name) or name == "min_lambda_ratio":
            assert (values > 0.0).all(), name
        elif transmits or not str(name).endswith(of_efficiency):
            assert np.isfinite(values.values.astype(float)).all(), name
    assert (data["mean_loss"] >= 0.0).all()
    assert (data["torque_ripple"] >= 0.0).all()
    assert (data["mean_friction"] >= 0.0).all()
    assert (data["contact_ratio"] >= 1.0).all()
    if transmits:
        assert (data["min_efficiency"] > 0.0).all()
        assert (data["mean_efficiency"] <= 1.0 + 1e-9).all()
        # Extremes are read off a polynomial between the nodes.
        assert (data["max_efficiency"] <= 1.0 + 1e-6).all()
        assert (data["min_efficiency"] <= data["mean_efficiency"] + 1e-6).all()
        assert (data["mean_efficiency"] <= data["max_efficiency"] + 1e-6).all()
    else:
        assert np.isnan(data["mean_efficiency"].values).all()


def answer(case: dict[str, Any]) -> str:
    """How a case ends: results, "input" or "convergence"."""
    try:
        built, data = computed(case)
    except (InputError, ConvergenceError) as error:
        for one in error.every:
            assert 20 < len(str(one)) < 700
            assert str(one).isprintable()
            if isinstance(one, InputError):
                assert one.file == "random.toml"
                assert one.key
                assert one.key.partition(".")[0] in case
        return "convergence" if isinstance(error, ConvergenceError) else "input"
    assert not (data["locked"]).any()
    operation = built.case.operation
    check(data, operation.torque * operation.speed > 1e-300)  # below it powers round to zero
    return "results"


def drawn(
    strategy: st.SearchStrategy[dict[str, Any]], examples: int, number: int
) -> Callable[[Callable[[dict[str, Any]], None]], Callable[[], None]]:
    """Decorator of what is held to so many cases: the same draws whatever becomes of the code."""
    chosen = settings(
        max_examples=examples,
        deadline=None,
        database=None,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )
    return lambda holds: seed(number)(chosen(given(strategy)(holds)))


def explore(examples: int) -> dict[str, int]:
    """Draw cases, the same in every run, and hold each to its answer: how many ended how."""
    counts = {"results": 0, "input": 0, "convergence": 0}

    @drawn(cases(), examples, SEED)
    def draw(case: dict[str, Any]) -> None:
        counts[answer(case)] += 1

    draw()
    return counts


def test_random_cases() -> None:
    counts = explore(15)
    assert counts["results"] > 0
    assert counts["input"] > 0


@pytest.mark.whole
def test_more_random_cases() -> None:
    counts = explore(EXAMPLES)
    assert counts["results"] > EXAMPLES / 4  # most of the others have gears that cannot run
    assert counts["input"] > 0


SOUND = tomllib.loads(PAIR) | {
    "source": "tian_2024",
    "models": {"load_sharing": "equal"},
}


@pytest.mark.parametrize(
    ("table", "change", "expected"),
    [
        ("operation", {"torque": "0 N m"}, "results"),
        ("operation", {"torque": "1e-12 N m"}, "results"),
        ("operation", {"torque": "1e8 N m"}, "results"),
        ("operation", {"speed": "1e-9 rpm"}, "convergence"),
        ("operation", {"speed": "900000 rpm"}, "results"),
        ("gears", {"teeth": [10_000, 10_000]}, "results"),
        ("roughness", {"ra": "0 um"}, "results"),
        ("roughness", {"ra": "100 um"}, "results"),
        ("models", {"friction": {"name": "constant", "coefficient": 2.0}}, "any"),
        ("materials", {"gear_1": {"young": "0.001 GPa", "poisson": 0.5}}, "any"),
    ],
    ids=lambda given: str(given)[:40],
)
def test_the_ends_of_the_ranges(table: str, change: dict[str, Any], expected: str) -> None:
    case = {**SOUND, table: {**SOUND.get(table, {}), **change}}
    found = answer(case)
    assert found == expected or expected == "any"
