"""Films of line contacts: errors by the grid, what is doubtful, starts, bad input."""

import copy
import dataclasses
import pickle
import re

import numpy as np
import pytest
from line_contacts import MODULUS, OIL, contact, of_moes

from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.doubts import of_grid
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.solve import LEAST_FALL, OF_HALF, OPENS, THINNEST, solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.film_thickness import moes_1992
from pitchpoint.materials.fluid import Fluid

EYRING = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, shear_parameters={"eyring_stress": 5.0})


# ---- statuses, warnings, bad input


@pytest.mark.whole
def test_a_film_that_is_too_thin_for_the_grid_is_told():
    """An oil that pressure does not thicken leaves a film far thinner than the inlet is long."""
    found = solve_lines(of_moes(np.array([20.0, 1000.0]), 1e-3), nodes=65)
    codes = [Code(int(code)) for code in found.ended.code]
    assert codes[0] == Code.SOLVED and codes[1] in (Code.UNRESOLVED, Code.NOT_CONVERGED)
    thin = solve_lines(of_moes(np.array([100.0]), 1e-3), nodes=65)
    exact = solve_lines(of_moes(np.array([100.0]), 1e-3), nodes=513)
    off = abs(thin.film.central_film / exact.film.central_film - 1.0)
    # What is estimated is more than the error, and up to three times as much.
    assert (thin.ended.grid > off).all() and (thin.ended.grid < 3.0 * off).all()
    assert "the grid is coarse for the films of 1 of 1 contacts" in thin.warnings[-1]


def of_grids(coarsest, coarse, fine):
    """Errors that films on three grids foretell of the last, of those in the middle and of smallest ones."""
    films = np.array(
        [
            [one.film.central_film, one.film.minimum_film, one.film.mean_film]
            for one in (coarsest, coarse, fine)
        ]
    )
    earlier, last = np.abs(np.diff(films, axis=0))
    change = np.max([last[:2], last[[2, 2]], LEAST_FALL * earlier[:2]], axis=0)
    change *= OF_HALF[:, None]
    gap, (which, node) = (
        fine.film.gap,
        (np.arange(len(fine.film.gap)), np.argmin(fine.film.gap, axis=1)),
    )
    opening = 0.5 * (gap[which, node - 1] + gap[which, node + 1]) - gap[which, node]
    change[1] = np.maximum(change[1], OPENS * opening)
    return change / np.abs(films[2, :2])


ERRORS = {"central_film": "grid", "minimum_film": "grid_minimum"}


def assert_estimates(usual, fine, names=tuple(ERRORS)):
    """Nine in ten films are off by less than is estimated, half by more than a third of it."""
    both = usual.solved & fine.solved
    assert both.mean() > 0.9
    for name in names:
        off = np.abs(getattr(fine.film, name) / getattr(usual.film, name) - 1.0)[both]
        estimated = getattr(usual.ended, ERRORS[name])[both]
        assert (off < estimated).mean() >= 0.9 and (off > estimated / 3.0).mean() >= 0.5


def test_errors_by_the_grid_are_told_from_grids_with_half_as_many_nodes():
    case = contact(np.array([0.3, 0.9, 1.0]) * 1e9, np.array([0.1, 0.3, 3.0]))
    coarsest, coarse, fine = (solve_lines(case, nodes=n) for n in (33, 65, 129))
    central, minimum = of_grids(coarsest, coarse, fine)
    np.testing.assert_allclose(fine.ended.grid, central, rtol=1e-5)
    np.testing.assert_allclose(fine.ended.grid_minimum, minimum, rtol=1e-5)
    (told,) = (one for one in coarse.warnings if one.kind == "grid")
    off = coarse.ended.grid_minimum
    assert f"films of {np.sum(off > 0.03)} of 3 contacts" in told
    assert off.max() > 0.03 and f"smallest ones by {100.0 * off.max():.2g} %" in told
    assert not any(one.kind == "grid" for one in fine.warnings)
    assert fine.ended.grid_minimum.max() < 0.03
    assert np.isnan(coarsest.ended.grid_minimum).all()
    (told,) = (one for one in coarsest.warnings if one.kind == "unknown grid")
    assert "films of 3 of 3 contacts is not known" in told


def drawn(count, seed):
    """Random contacts, and their films by a regression."""
    low, high = (0.1e9, 0.01, 1e-3, 5e-3, 1e-8), (1.8e9, 20.0, 1.0, 0.5, 3e-8)
    unit = np.random.default_rng(seed).uniform(np.log(low), np.log(high), (count, len(low)))
    pressure, speed, radius, viscosity, alpha = np.exp(unit).T
    oil = Fluid(**OIL | {"viscosity": viscosity, "pressure_viscosity": alpha})
    case = contact(pressure, speed, radius, fluid=oil)
    film = moes_1992(
        line_load=case.line_load,
        entrainment=speed,
        viscosity=viscosity,
        pressure_viscosity=alpha,
        radius=radius,
        modulus=np.full(count, MODULUS),
    )
    return case, np.asarray(film)


@pytest.mark.whole
def test_random_films_are_off_by_less_than_is_told_and_half_by_more_than_a_third_of_it():
    """With 65 nodes, where one coarser grid is the only one, the gap beside the smallest films tells."""
    case, _ = drawn(60, 7306)
    coarse, usual, fine = (solve_lines(case, nodes=n, profiles=False) for n in (65, 129, 257))
    assert_estimates(usual, fine)
    assert_estimates(coarse, usual, ("minimum_film",))


@pytest.mark.whole
def test_errors_of_rough_films_are_those_of_mean_planes():
    """The oil has more room than mean planes leave it, and less of it comes and goes with them."""
    case, film = drawn(60, 32)
    ratio = np.exp(np.random.default_rng(33).uniform(np.log(0.3), np.log(6.0), 60))
    case = dataclasses.replace(case, texture=Rough(rq=film / ratio, modulus=MODULUS))
    coarsest, coarse, usual, fine = (
        solve_lines(case, nodes=n, profiles=n == 129) for n in (33, 65, 129, 257)
    )
    both = coarsest.solved & coarse.solved & (usual.film.film_ratio > THINNEST)
    assert both.mean() > 0.8 and (usual.film.film_ratio < 1.0).mean() > 0.1
    estimated = np.array([usual.ended.grid, usual.ended.grid_minimum])
    foretold = of_grids(coarsest, coarse, usual)
    np.testing.assert_allclose(estimated[:, both], foretold[:, both], rtol=1e-5)
    assert_estimates(usual, fine)


def test_nodes_that_are_named_bring_films_within_what_is_borne():
    case = contact(np.array([0.3, 0.9, 1.0]) * 1e9, np.array([0.1, 0.3, 3.0]))
    (told,) = (one for one in solve_lines(case, nodes=65).warnings if one.kind == "grid")
    (nodes,) = re.findall(r"(\d+) nodes should bring that below 3 %", told)
    assert told.brief.endswith(f"take {nodes} nodes") and int(nodes) > 65
    assert not any(one.kind == "grid" for one in solve_lines(case, nodes=int(nodes)).warnings)


@pytest.mark.parametrize(
    ("off", "grid", "falls", "words"),
    [
        (0.05, (65,), 0.5, "; 129 nodes should bring that below 3 %"),
        (0.1, (65,), 0.5, "; 257 nodes should bring that below 3 %"),
        (0.1, (65,), 0.25, "; 129 nodes should bring that below 3 %"),
        (0.3, (65,), 0.5, "; 257 nodes, the most, leave some 7.5 %"),
        (0.05, (257,), 0.5, "; 257 nodes are the most"),
        (0.07, (65, 64), 0.6, "; 257 nodes and 256 cells should bring that below 3 %"),
        (0.07, (65, 128), 0.6, "; 129 nodes and 256 cells, the most, leave some 4.2 %"),
    ],
)
def test_errors_by_the_grid_name_the_nodes_that_bring_them_down(off, grid, falls, words):
    (told,) = of_grid(
        np.array([0.01, off]),
        np.array([0.02, np.nextafter(off, 0.0)]),
        grid=grid,
        most=257,
        falls=falls,
    )
    assert told.endswith(words)


def test_nodes_of_lines_are_named_by_how_their_films_converge():
    """Twice as many nodes leave about a third of an error, as of second order and a little more."""
    (told,) = of_grid(np.array([0.0234]), np.array([0.0751]), grid=(129,))
    assert "; 257 nodes should bring that below 3 %" in told and told.brief.endswith("257 nodes")


def test_films_without_a_coarser_grid_beside_them_are_told():
    coarse, unknown = of_grid(
        np.array([0.04, np.nan]), np.array([0.05, np.nan]), grid=(129,), most=257
    )
    assert coarse.kind == "grid" and "films of 1 of 2 contacts" in coarse
    assert unknown.startswith(
        "how far off the grid makes the films of 1 of 2 contacts is not known"
    )
    assert [*of_grid(np.array([np.nan]), np.array([0.01]), grid=(129,), most=257)] == []


def test_what_has_no_film_says_so_and_shows_no_numbers():
    case = contact(
        line_load=np.array([1e5, 0.0, np.nan, 1e5]), speed=np.array([0.0, 1.0, 1.0, 1.0])
    )
    found = solve_lines(case)
    codes = [Code(int(code)) for code in found.ended.code]
    assert codes == [Code.NO_FILM, Code.UNLOADED, Code.NO_NUMBER, Code.SOLVED]
    assert found.warnings[0].startswith("3 of 4 contacts were not solved: smooth surfaces that")
    assert "no load presses the bodies together (1)" in found.warnings[0]
    nothing = solve_lines(contact(line_load=np.zeros(2)))
    assert nothing.warnings == (
        "2 of 2 contacts were not solved: no load presses the bodies together",
    )
    assert np.isnan(found.film.central_film[:3]).all() and found.film.central_film[3] > 0.0
    assert np.isnan(found.film.pressure[:3]).all()


@pytest.mark.whole
def test_surfaces_that_roll_against_each_other_lie_on_their_asperities():
    rough = Rough(rq=0.4e-6, modulus=MODULUS, boundary_friction=0.12)
    case = contact(
        0.6e9, texture=rough, speed_a=np.array([0.5, 0.0]), speed_b=np.array([-0.5, 0.0])
    )
    found = solve_lines(case)
    np.testing.assert_allclose(found.film.asperity_share, 1.0, rtol=1e-7)
    np.testing.assert_allclose(
        found.film.boundary_force, [-0.12 * float(case.line_load), 0.0], rtol=1e-7
    )


@pytest.mark.whole
def test_a_solution_is_a_start_for_its_neighbours():
    first = solve_lines(contact([0.6e9, 0.8e9]))
    onward = solve_lines(contact([0.62e9, 0.83e9]), start=first)
    afresh = solve_lines(contact([0.62e9, 0.83e9]))
    np.testing.assert_allclose(onward.film.central_film, afresh.film.central_film, rtol=1e-8)
    np.testing.assert_allclose(onward.ended.grid, afresh.ended.grid, rtol=1e-6)
    assert (onward.ended.iterations < afresh.ended.iterations).all()
    with pytest.raises(InputError, match="films of 2 contacts on 129 nodes are no start for 1"):
        solve_lines(contact(0.6e9), start=first)


@pytest.mark.whole
@pytest.mark.parametrize(("given", "wanted"), [(33, 129), (129, 33)])
def test_films_on_other_grids_and_running_the_other_way_are_a_start(given, wanted):
    first = solve_lines(contact([0.6e9, 0.8e9], [1.0, -1.0]), nodes=given)
    case = contact([0.62e9, 0.83e9], [1.0, -1.0])
    onward, afresh = solve_lines(case, nodes=wanted, start=first), solve_lines(case, nodes=wanted)
    np.testing.assert_allclose(onward.film.central_film, afresh.film.central_film, rtol=1e-8)
    assert (onward.ended.iterations < afresh.ended.iterations).all()


@pytest.mark.whole
def test_doubtful_contacts_are_told_with_numbers():
    told = solve_lines(contact([1.6e9])).warnings
    assert [text for text in told if not text.startswith("the grid is coarse")] == [
        "a pressure of 1.6 GPa is outside the range of 'roelands_1966', up to 1 GPa: films and traction "
        "there are extrapolated"
    ]
    wide = solve_lines(contact(0.3e9, 0.1, 1.0), size=0.5e-3).warnings
    assert "mm wide, and the size of a tooth is 0.5 mm: the bodies are no half spaces" in " ".join(
        wide
    )
    rough = solve_lines(contact(0.3e9, texture=Rough(rq=20e-6, modulus=MODULUS))).warnings
    assert rough[-1].startswith("a roughness Rq of 20 um is large against a contact")
    sheared = solve_lines(contact(0.9e9, slide=0.2)).warnings
    (stress,) = [text for text in sheared if "`shear_law`" in text]
    assert stress.endswith(
        "more than oils bear: a `shear_law` that lowers it is 'ree_eyring_1955', 'bair_winer_1979' or "
        "'carreau_1972'"
    )
    assert "MPa in the mean at a mean pressure of 707 MPa" in stress


def test_films_that_draw_oil_from_further_away_than_their_radius_are_told():
    thick = contact(line_load=2e3, speed=20.0, radius=0.02)
    told = solve_lines(thick).warnings
    assert told[-1].startswith("a flooded film draws oil from ")
    assert told[-1].endswith("its relative radius of 20 mm: give the `inlet` at which oil begins")
    given = solve_lines(dataclasses.replace(thick, inlet=0.02)).warnings
    assert not any("flooded film draws" in text for text in given)


@pytest.mark.whole
@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"radius": 250.0}, "a relative radius of 250 m: nearly flat, if it was not meant in mill"),
        ({"modulus": 226.0}, "a modulus E' of 226 Pa: softer than rubber, if it was not meant in"),
        ({"fluid": Fluid(viscosity=40.0, pressure_viscosity=2e-8)}, "a viscosity of 40 Pa s: no"),
        (
            {"fluid": Fluid(viscosity=0.04, pressure_viscosity=22.0)},
            "a pressure-viscosity coefficie",
        ),
        (
            {"fluid": EYRING},
            "an Eyring stress of 5 Pa: no oil is so weak, if it was not meant in MPa",
        ),
        (
            {"radius": 10.0},
            "a film of 20.3 um is far thicker than those of gears, 0.01 to 5 um: check",
        ),
        ({"line_load": 200.0, "speed_a": 4.0, "speed_b": 4.0}, "a film of 39.1 um is far thicker"),
    ],
)
def test_values_that_hint_at_another_unit_are_told(given, sentence):
    case = {"line_load": 1e5, "speed_a": 1.0, "speed_b": 1.0, "radius": 0.01} | given
    found = solve_lines(LineContact(**({"modulus": MODULUS, "fluid": Fluid(**OIL)} | case)))
    assert any(text.startswith(sentence) for text in found.warnings)


def test_a_conformal_contact_of_metres_is_not_taken_for_one_of_millimetres():
    assert solve_lines(contact(0.1e9, np.array([1.0, 5.0]), 5.0)).warnings == ()


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_films_with_warnings_are_copied(copied):
    films = solve_lines(contact(1.6e9))
    again = copied(films)
    assert again.warnings == films.warnings
    extents = [[(one.kind, one.extent) for one in each.warnings] for each in (again, films)]
    assert extents[0] == extents[1] and {"pressure", "grid"} == {kind for kind, _ in extents[0]}


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"radius": np.array([0.01, 0.0])}, "a relative radius of curvature of 0 m: it must"),
        ({"modulus": -2e11}, "a modulus E' of -200 GPa: it must be positive"),
        ({"fluid": Fluid(viscosity=0.0, pressure_viscosity=2e-8)}, "a viscosity of 0 mPa s"),
        ({"texture": Rough(rq=0.0, modulus=MODULUS)}, "a composite roughness Rq of 0 um"),
        (
            {"texture": Rough(rq=1e-7, modulus=MODULUS, boundary_friction=-0.1)},
            "a boundary friction of -0.1",
        ),
        ({"inlet": 0.0}, "a distance at which oil begins of 0 mm: it must be positive"),
        ({"radius": np.ones(2), "speed_a": np.ones(3)}, "do not fit each other: shapes"),
        ({"radius": np.ones(0)}, "there are no contacts to solve"),
    ],
)
def test_bad_input_is_one_sentence(given, sentence):
    case = {"line_load": 1e5, "speed_a": 1.0, "speed_b": 1.0, "radius": 0.01} | given
    with pytest.raises(InputError, match=sentence):
        solve_lines(LineContact(**({"modulus": MODULUS, "fluid": Fluid(**OIL)} | case)))


@pytest.mark.whole
def test_the_grid_is_judged_by_a_part_of_the_roughness_where_mean_planes_meet():
    soft = Rough(rq=0.4e-6, modulus=MODULUS)
    thin, exact = (
        solve_lines(contact(0.9e9, np.array([0.02, 0.05]), texture=soft), nodes=n)
        for n in (129, 257)
    )
    assert (np.abs(thin.film.gap).min(axis=-1) < 0.1e-6).all()
    off = np.abs(thin.film.central_film - exact.film.central_film) / (THINNEST * soft.rq)
    assert (off < thin.ended.grid).all() and (thin.ended.grid < 0.1).all()


@pytest.mark.parametrize("nodes", [2, 17, 128, 130])
def test_nodes_are_one_more_than_a_power_of_two(nodes):
    with pytest.raises(InputError, match=f"{nodes} nodes across a contact; their number is one"):
        solve_lines(contact(), nodes=nodes)


def test_progress_is_told_and_profiles_can_be_left_out():
    seen = []
    case = contact(np.linspace(0.3e9, 0.9e9, 70))
    found = solve_lines(case, nodes=33, profiles=False, progress=lambda *done: seen.append(done))
    assert seen == [(64, 70), (70, 70)]
    assert found.film.pressure.shape == (70, 0) and found.solved.all()
