"""Checks of what cannot be, on numbers that are made up; whole runs are in `cli/test_plausibility.py`."""

import json
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from pitchpoint.analyses.caveats import OF_CYCLES, AtWork
from pitchpoint.analyses.plausibility import OF_CONTACTS, OF_RESULTS, implausible, unlikely
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.solids import BY_VALUE, SolidInUse
from pitchpoint.citations import citation_text
from pitchpoint.core.doubts import Checks
from pitchpoint.gears.pairs import largest_radius
from pitchpoint.lubrication.ehl.doubts import OF_LINE_FILMS, OF_LINE_INPUTS
from pitchpoint.lubrication.ehl.patch.patch_films import OF_PATCH_FILMS, OF_PATCHES
from pitchpoint.lubrication.lubrication_registry import BOUNDARY
from pitchpoint.materials import solids
from pitchpoint.materials.data import Datum

CONSTANT, ISO = FRICTION["constant"], FRICTION["iso_tr_14179_2"]


def in_use(name: str, temperature: float = 300.0, **changes: Any) -> SolidInUse:
    record = replace(solids.find(name), **changes)
    return SolidInUse(record, solids.find(name).build(), temperature)


STEEL, PLASTIC = in_use("steel"), in_use("PA66")


def cycle(**changes: Any) -> dict[str, np.ndarray]:
    """Two nodes of two pairs, of which the second one carries nothing at the second node."""
    lanes = {"load": 100.0, "friction": 0.04, "pressure": 1e9, "film_thickness": 1e-7}
    lanes |= {"radius": 1e-2, "entrainment": 3.0, "sliding_velocity": 1.0}
    lanes |= {"sliding_loss": 3.0, "rolling_loss": 1.0}
    run = {
        name: np.broadcast_to(changes.pop(name, value), (2, 2, 1)).astype(float)
        for name, value in lanes.items()
    }
    for name in ("load", "film_thickness", "sliding_loss", "rolling_loss"):
        run[name][1, 1] = 0.0
    return {**run, "weight": np.array([0.25, 0.75]), **changes}


class Cut(SimpleNamespace):
    """Gears whose conformal contacts are cut."""


largest_radius.register(Cut)(lambda mesh: mesh.largest_radius)


def at_work(*gears: SolidInUse, law: Any = CONSTANT, **changes: Any) -> AtWork:
    shape, rolling = changes.pop("shape", "line"), changes.pop("rolling", "none")
    largest, pitch = changes.pop("largest_radius", np.inf), changes.pop("pitch", 0.1)
    rough = changes.pop("ra", 0.4e-6)
    flanks = {f"ra_{gear}": rough for gear in (1, 2)} | {f"rq_{gear}": rough for gear in (1, 2)}
    built: Any = SimpleNamespace(
        solids=gears or (STEEL, STEEL),
        design=SimpleNamespace(
            mesh=Cut(shape=shape, largest_radius=largest),
            roughness=SimpleNamespace(**flanks),
        ),
        modulus=226e9,
        case=SimpleNamespace(
            models=SimpleNamespace(rolling_resistance=rolling),
            operation=SimpleNamespace(speed=100.0),
        ),
        nominal={"pitch_line_speed": pitch},
    )
    return AtWork(built, [law], [cycle(**changes)])


HALF = np.array([[[1e-2], [1.0]], [[1e-2], [1.0]]])
SOFT = in_use("rigid", hardness=Datum(value=1e9))


@pytest.mark.parametrize(
    ("at", "words"),
    [
        (at_work(pressure=3.1e9), "reaches 3.1 GPa; steel bears about 2.5 GPa"),
        (
            at_work(
                PLASTIC,
                in_use("rigid", title=BY_VALUE, young=Datum(value=206e9)),
                pressure=3.1e9,
            ),
            "rigid bears about 2.5 GPa",
        ),
        (at_work(SOFT, PLASTIC, pressure=1.3e9), "from 1.27 GPa on its mean is more than the"),
        (at_work(SOFT, SOFT, shape="ellipse", pressure=1.6e9), "from 1.5 GPa on its mean"),
        (at_work(in_use("rigid"), PLASTIC, pressure=12e9), "5.3 % of the reduced modulus"),
        (
            at_work(STEEL, in_use("PA66", 560.0, service_limit=None)),
            "gear 2 are at 286.9 degC; no plastic of the catalogue bears more than 260 degC",
        ),
        (at_work(film_thickness=2e-11), "down to 0.02 nm, under 100 % of the load"),
        (at_work(film_thickness=3e-5), "reaches 30 um, 0.3 % of the relative radius"),
        (at_work(ra=20e-6), "mean Ra of the flanks is 20 um"),
        (at_work(ra=1e-6, radius=1e-4), "Rq of the flanks, 1.41 um, is more than 1 % of their"),
        (at_work(friction=0.3), "coefficient is 0.3; steel in oil has at most about 0.2"),
        (at_work(PLASTIC, friction=0.5), "plastics have at most about 0.4 even without oil"),
        (at_work(pitch=2.6), "the pitch circles run at 260 m/s"),
        (at_work(entrainment=300.0), "the flanks run at 300 m/s"),
        (at_work(radius=HALF, largest_radius=1.0, sliding_loss=10.0 * HALF), "are conformal make"),
        (at_work(law=ISO, rolling="wu_cheng_1991"), "adds 25 % of the loss once more"),
    ],
)
def test_what_cannot_be_is_told(at: AtWork, words: str) -> None:
    (told,) = implausible(at)
    assert told.startswith("Fails: ")
    assert words in told


@pytest.mark.parametrize(
    "at",
    [
        at_work(),
        at_work(pressure=2.5e9),
        at_work(in_use("rigid"), PLASTIC, pressure=3.1e9),
        at_work(friction=BOUNDARY),
        at_work(PLASTIC, friction=0.3),
        at_work(law=ISO, friction=0.3),
        at_work(rolling="wu_cheng_1991"),
        at_work(radius=HALF, largest_radius=2.0, sliding_loss=10.0 * HALF),
        at_work(STEEL, in_use("PEEK", 520.0, service_limit=None)),
    ],
)
def test_what_can_be_is_not_told(at: AtWork) -> None:
    assert implausible(at) == []


@pytest.mark.parametrize(
    ("gear", "stress", "words"),
    [
        (STEEL, 73.8e9, "reaches 73.8 GPa; the strongest teeth of steel bear about 2.6 GPa"),
        (STEEL, 2.6e9, ""),
        (PLASTIC, 171e6, "from 170 MPa on, twice the tensile strength of PA66"),
        (PLASTIC, 169e6, ""),
        (in_use("PEEK", tensile_strength=None), 181e6, "it strains PEEK by more than 5 %"),
        (in_use("PEEK", tensile_strength=None), 179e6, ""),
    ],
)
def test_roots_that_break_at_once(gear: SolidInUse, stress: float, words: str) -> None:
    mesh = SimpleNamespace(
        solids=(STEEL, gear), case=SimpleNamespace(gears=SimpleNamespace(rated=True))
    )
    strength = xr.Dataset({"root_stress": (("gear",), [1e8, stress])})
    told = unlikely(SimpleNamespace(meshes=(mesh,)), {"strength": strength})  # type: ignore[arg-type]
    assert len(told) == bool(words)
    assert words in "".join(told)


def test_films_that_vanish_for_a_moment_are_sound() -> None:
    """Where surfaces come to rest and turn, under a small part of the load."""
    thin = np.array([[[1e-12], [1e-12]], [[1e-7], [1e-7]]])
    assert implausible(at_work(film_thickness=thin)) == []


def test_without_load_nothing_is_judged() -> None:
    at = at_work(pressure=9e9, film_thickness=np.nan)
    at.runs[0]["load"][:] = 0.0
    assert implausible(at) == []


def parts(
    efficiency: float = 0.98, outside: tuple[str, ...] = (), there: int = 1, edge: float = 0.0
) -> dict[str, xr.Dataset]:
    told = json.dumps(
        [{"law": law, "mean_efficiency": 0.5, "reasons": ["it is"]} for law in outside]
    )
    values = {"mean_efficiency": (("law", "point"), [[efficiency]])}
    return {
        "operation": xr.Dataset(values, {"law": ["xu_2007"]}),
        "laws": xr.Dataset(coords={"law": ["iso_tr_14179_2"][:there]}, attrs={"outside": told}),
        "torsion": xr.Dataset({"edge_share": (("torque",), [0.0, edge])}, {"torque": [0.0, 10.0]}),
    }


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (parts(1.01), "101 %: more power would come out than goes in"),
        (parts(-0.2), "-20 %: more power is lost than goes in"),
        (parts(outside=("xu_2007",), there=0), "extrapolations: xu_2007: it is."),
        (parts(edge=0.7), "edges of the teeth"),
    ],
)
def test_a_result_that_cannot_be_is_told(found: dict[str, xr.Dataset], words: str) -> None:
    built: Any = SimpleNamespace(case=SimpleNamespace(operation=SimpleNamespace(load=10.0)))
    (told,) = unlikely(built, found)
    assert words in told


def test_sound_results_and_those_that_are_not_there() -> None:
    built: Any = SimpleNamespace(case=SimpleNamespace(operation=SimpleNamespace(load=10.0)))
    for found in (
        {},
        parts(),
        parts(np.nan),
        parts(outside=("xu_2007",)),
        parts(there=0),
        parts(edge=0.4),
    ):
        assert unlikely(built, found) == []


FILMS = OF_LINE_INPUTS, OF_LINE_FILMS, OF_PATCHES, OF_PATCH_FILMS


@pytest.mark.parametrize(
    "checks", [OF_CONTACTS, OF_CYCLES, OF_RESULTS, *FILMS], ids=lambda checks: checks.place
)
def test_every_check_says_what_it_rests_on(checks: Checks[Any]) -> None:
    assert [*checks]
    for check in checks:
        assert check.criterion.endswith("."), check.asks
        assert all(map(citation_text, check.sources)), check.asks
