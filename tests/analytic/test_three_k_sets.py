"""3K sets for a ratio: closed forms against printed designs, geometry against pairs that are built."""

from math import radians

import jax
import numpy as np
import pytest

import pitchpoint as pp
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.sizing import three_k

FEW = {"sun": (12, 13), "planet": (45, 60), "count": 5}


@pytest.fixture(scope="module")
def sets():
    return three_k.three_k_sets((90.0, 110.0), **FEW)


@pytest.mark.parametrize(
    ("teeth", "there", "back"),
    [
        ((64, 48, 160, 28, 140), 0.9047, 0.8967),
        ((60, 50, 160, 30, 140), 0.9037, 0.8957),
        ((70, 45, 160, 30, 145), 0.8823, 0.8692),
        ((72, 42, 156, 30, 144), 0.8603, 0.8410),
        ((66, 45, 156, 33, 144), 0.8588, 0.8394),
    ],
)
def test_public_designs_without_shift(teeth, there, back):
    """Five built designs with a coefficient of 0.3, whose own project prints .905 .904 .882 .861 .859."""
    sun, planet, held, second, output = (np.array([float(number)]) for number in teeth)
    none, distance = np.zeros(1), (sun + planet) / 2.0
    pairs = (planet, sun), (planet, -held), (second, -output)
    meshes = [three_k._Mesh(*pair, none, distance).efficiency(0.3) for pair in pairs]
    found = three_k.three_k_efficiencies(np.array([teeth], float), np.stack(meshes, axis=-1))
    assert np.ravel(found) == pytest.approx([there, back], abs=2e-4)


def test_the_other_sense_of_turning_and_locking():
    teeth = np.array([[12.0, 41.0, 94.0, 45.0, 98.0], [18.0, 36.0, 90.0, 34.0, 88.0]])
    there, back = three_k.three_k_efficiencies(teeth[0], np.array([0.98, 0.99, 0.99]))
    assert [there, back] == pytest.approx([0.7053064446, 0.5975316733], abs=1e-10)
    locks = np.sqrt(90.0 * 34.0 / (36.0 * 88.0))
    for more in (-1e-6, 1e-6):
        etas = np.array([0.99, locks + more, locks + more])
        _, back = three_k.three_k_efficiencies(teeth[1], etas)
        assert (back > 0.0) == (more > 0.0)
        assert back < 1e-3


def test_a_program_in_single_precision_has_the_same(sets):
    with jax.enable_x64(False):
        alike = three_k.three_k_sets((90.0, 110.0), **FEW)
    assert alike.equals(sets)


def test_what_is_found_is_what_was_asked_for(sets):
    sun, planet, held, second, output = sets["teeth"].values.T
    ratio = (1.0 + held / sun) / (1.0 - held * second / (planet * output))
    assert sets["ratio"].values == pytest.approx(ratio, rel=1e-14)
    assert np.all((np.abs(ratio) >= 90.0) & (np.abs(ratio) <= 110.0))
    worse = np.minimum(sets["efficiency"], sets["back_driving_efficiency"]).values
    assert np.all(np.diff(worse) <= 0.0)
    assert worse.min() > 0.9
    assert sets["contact_ratio"].min() >= 1.1


def test_pairs_that_are_built_have_its_geometry(sets):
    chosen = sets.isel(set=0)
    z, x = chosen["teeth"].values, chosen["profile_shift"].values
    tip = float(chosen["tip_alteration"])
    for mesh, (one, other, sign, tips) in enumerate(
        ((0, 1, 1, (tip, tip)), (1, 2, -1, (tip, 0.0)), (3, 4, -1, (0.0, 0.0)))
    ):
        pair = build_cylindrical_pair(
            teeth=(int(z[one]), sign * int(z[other])),
            module=1e-3,
            pressure_angle=radians(20.0),
            face_width=1e-2,
            profile_shift=(x[one], x[other]),
            tip_alteration=tips,
        )
        assert abs(float(pair.centre_distance)) == pytest.approx(
            1e-3 * chosen["centre_distance"].item(), rel=1e-9
        )
        assert float(pair.contact_ratio) == pytest.approx(
            chosen["contact_ratio"].values[mesh], rel=1e-9
        )


def mean_of_pair(teeth, shifts, tips, friction=0.1):
    """Mean efficiency of a pair that is built, by its radii."""
    pair = build_cylindrical_pair(
        teeth=teeth,
        module=1.0,
        pressure_angle=radians(20.0),
        face_width=1.0,
        profile_shift=shifts,
        tip_alteration=tips,
    )
    z, tip = np.array(teeth, float), np.abs(np.asarray(pair.tip_radii))
    base = np.abs(np.asarray(pair.base_radii))
    working = np.tan(
        np.arccos(
            abs(base.sum() if teeth[1] > 0 else base[1] - base[0])
            / abs(float(pair.centre_distance))
        )
    )
    parts = z / (2.0 * np.pi) * (np.sqrt((tip / base) ** 2 - 1.0) - working)
    return three_k.mesh_efficiency((z[:1], z[1:]), (parts[:1], parts[1:]), friction).item()


def built_at(z, distance, first, second):
    """Both efficiencies of pairs as built at a centre distance, with these shifts of the planet's gears."""

    def mate(planet, other, shift):
        working = np.arccos(abs(planet + other) * np.cos(radians(20.0)) / (2.0 * distance))
        angles = np.array([working, radians(20.0)])
        opened = -np.diff(np.tan(angles) - angles).item()
        return (planet + other) * opened / (2.0 * np.tan(radians(20.0))) - shift

    sun, ring = mate(z[1], z[0], first), mate(z[1], -z[2], first)
    tip = distance - (z[0] + z[1]) / 2.0 - sun - first
    meshes = [
        mean_of_pair((z[0], z[1]), (sun, first), (tip, tip)),
        mean_of_pair((z[1], -z[2]), (first, ring), (tip, 0.0)),
        mean_of_pair((z[3], -z[4]), (second, mate(z[3], -z[4], second)), (0.0, 0.0)),
    ]
    return np.array(three_k.three_k_efficiencies(np.array(z, float), np.array(meshes)))


def test_derivatives_are_those_of_pairs_with_other_centre_distances_and_shifts(sets):
    """Each is moved on pairs as built, with the shift of the planet in the output ring beside its best."""
    chosen = sets.isel(set=0)
    z, x = chosen["teeth"].values.tolist(), chosen["profile_shift"].values
    place = np.array([chosen["centre_distance"].item(), x[1], x[3] - 0.3])
    steps = 1e-3 * np.eye(3)
    slopes = [(built_at(z, *(place + h)) - built_at(z, *(place - h))) / 2e-3 for h in steps]
    none = np.full(1, np.nan)
    shifts = np.array([[np.nan, place[1], np.nan, place[2], np.nan]])
    point = three_k._Points(none, place[:1], shifts, none, none, none, none)
    found = three_k._slopes(np.array([z], float), point, 0.1)[:, 0]
    assert found == pytest.approx(np.transpose(slopes), rel=1e-3)
    assert np.abs(slopes).min() > 1e-3
    # At the best one the derivative vanishes by the shift that goes with every other, if none is in the way.
    at_best = chosen[["efficiency_slope", "back_driving_slope"]].isel(variable=2)
    assert max(abs(float(one)) for one in at_best.data_vars.values()) < 2e-4


@pytest.mark.whole
def test_contacts_say_the_same_of_the_best_one(sets):
    """Closed forms of mean losses lie within 2 % of the loss of what all contacts give."""
    chosen = sets.isel(set=0)
    case = pp.Case(
        lubricant={"name": "pao-vg-150"},
        roughness={"ra": "0.4 um"},
        operation={"torque": "20 N m", "speed": "3000 rpm", "temperature": "60 degC"},
        models={"friction": {"name": "constant", "coefficient": 0.1}},
        **three_k.three_k_tables(chosen, "0.5 mm", "8 mm"),
    )
    result = pp.run(case, analyses=["operation", "back_driving"])
    for part, name in (("operation", "efficiency"), ("back_driving", "back_driving_efficiency")):
        lost = 1.0 - float(result.dataset(part)["mean_efficiency"].item())
        assert lost == pytest.approx(1.0 - chosen[name].item(), rel=0.02)
        assert lost < 0.15


@pytest.mark.whole
def test_no_set_of_a_coarse_random_search_is_better():
    """Random teeth and shifts that can be made lose at least what the best ones lose."""
    best = three_k.three_k_sets((90.0, 110.0), count=1)["back_driving_efficiency"].item()
    task = three_k._Task((90.0, 110.0), 3, 0.1, 1.1, (12, 60), (15, 60), 150)
    every, random = np.concatenate([*three_k._teeth(task)]).astype(float), np.random.default_rng(7)
    teeth = every[random.integers(len(every), size=200_000)]
    ranges = (np.radians([16.0, 28.0]), (-0.4, 1.2), (-0.4, 1.2))
    points = [random.uniform(*ends, size=(len(teeth), 1)) for ends in ranges]
    assert three_k._best(teeth, points, task).worse.max() < best


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"ratio": (110.0, 90.0)},
            "ratio: 110 to 90 was given; allowed are 1 to 100000, the smaller first",
        ),
        ({"planets": 0}, "planets: 0 was given; allowed are 1 to 24"),
        ({"friction": -0.1}, "friction: -0.1 was given; allowed are 0 to 0.5"),
        ({"largest_ring": 40}, "no 3K set of a ratio from 90 to 110 with suns of 12 to 13"),
        ({"friction": 0.5, "planet": (15, 18)}, "can be driven back; allow more teeth"),
    ],
)
def test_what_cannot_be_is_one_sentence(changes, words):
    with pytest.raises(InputError, match=words):
        three_k.three_k_sets(**{"ratio": (90.0, 110.0), **FEW, **changes})


def test_tables_of_several_sets_are_refused(sets):
    with pytest.raises(InputError, match="one set is needed"):
        three_k.three_k_tables(sets, "1 mm", "8 mm")
    with pytest.raises(InputError, match="has no unit"):
        three_k.three_k_tables(sets.isel(set=0), "1", "8 mm")
