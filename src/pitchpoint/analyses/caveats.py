"""What is said about a mesh cycle, and what is refused: a locked mesh, say."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import exp, inf
from typing import Any

import numpy as np

from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.laws import FRICTION
from pitchpoint.core.doubts import GUESSED, WITHHELD, Checks, Doubt, fails, in_percent, reworded
from pitchpoint.core.status import Code
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.pairs import largest_radius, touching
from pitchpoint.input.kinds import SPEED, TEMPERATURE
from pitchpoint.input.quantities import Quantity
from pitchpoint.lubrication.applicability import Limited, limits_words
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL
from pitchpoint.lubrication.flash_temperature import Conductor, shared_flash
from pitchpoint.lubrication.lubrication_registry import (
    BOUNDARY,
    ROLLING_RESISTANCE,
    USUAL_BOUNDARY,
    FrictionLaw,
)

__all__ = [
    "OF_CYCLES",
    "AtWork",
    "beyond_face",
    "boundary_warning",
    "cold_warning",
    "conformal",
    "conformal_warning",
    "demand_agreement",
    "demand_convergence",
    "demand_motion",
    "face_warning",
    "faces_warning",
    "films_lost",
    "friction_beyond",
    "jamming_words",
    "law_sentences",
    "proportions_counted",
    "proportions_words",
    "range_left",
    "rolling_share",
    "room_warning",
    "why_not_at",
    "why_outside",
]


TOLERANCE = 1e-10
"""Largest relative residual of the torque balance that counts as converged."""

NEARLY_JAMMED = 1e-3
"""Distance from the coefficient that locks the mesh, relative, at which it is said to be reached."""

LENGTH = Quantity("length", 0.0, 1e3, "mm")

LEAST_FACE = 3.0
"""Mean number of slices of a contact line below which it is nearly a point, not a line."""


@dataclass(frozen=True)
class AtWork:
    """Contacts of one mesh over its cycle.

    Attributes:
        built: the mesh.
        laws: of friction.
        runs: state under each of them, see `profile`.
    """

    built: Built
    laws: Sequence[FrictionLaw]
    runs: Sequence[Mapping[str, Any]]

    @cached_property
    def loaded(self) -> bool:
        """True if a contact carries."""
        return bool(np.any(self.runs[0]["load"] > 0.0))

    def largest(self, name: str) -> float:
        """Largest value of a quantity under all laws."""
        return max(float(np.max(np.abs(run[name]))) for run in self.runs)

    @property
    def under(self) -> Iterator[tuple[FrictionLaw, Mapping[str, Any]]]:
        """Each law with the state under it."""
        return zip(self.laws, self.runs, strict=True)

    @property
    def plastic(self) -> bool:
        """True if a gear is of plastic."""
        return any(used.plastic for used in self.built.solids)


OF_CYCLES = Checks[AtWork]("the mesh cycle")


def demand_convergence(residual: np.ndarray, points: Sequence[Ready], laws: Sequence[str]) -> None:
    """ConvergenceError if a balance [law, point] was not found: no numbers are returned."""
    failed = ~(residual <= TOLERANCE)
    if failed.any():
        law, point = divmod(int(np.argmax(failed)), residual.shape[1])
        if np.isposinf(residual[law, point]):
            raise ConvergenceError(
                "losses beside the teeth drive the loaded member with more than its load "
                f"{_where(points[min(point, len(points) - 1)])}: other flanks would touch"
            )
        raise ConvergenceError(
            f"the torque balance did not converge (relative residual {residual[law, point]:.2g}, "
            f"allowed {TOLERANCE:g}) with {laws[law]} {_where(points[min(point, len(points) - 1)])}"
        )


def demand_agreement(code: np.ndarray, points: Sequence[Ready], laws: Sequence[str]) -> None:
    """ConvergenceError if films and forces [law, point] found no agreement: no numbers are returned."""
    lost = films_lost(code)
    if lost.any():
        law, point = divmod(int(np.argmax(lost)), code.shape[1])
        sentence = Code(int(code[law, point])).sentence
        raise ConvergenceError(f"{sentence}, with {laws[law]} {_where(points[point])}")


def films_lost(code: np.ndarray) -> np.ndarray:
    """True where the turns of films and forces ended without a result."""
    lost: np.ndarray = (code != Code.SOLVED) & (code != Code.LOCKED)
    return lost


def demand_motion(
    locked: np.ndarray,
    acting: np.ndarray,
    limit: np.ndarray,
    points: Sequence[Ready],
    laws: Sequence[str],
) -> None:
    """ConvergenceError if friction locks the mesh [law, point]: there is no balance to find."""
    if locked.any():
        law, point = divmod(int(np.argmax(locked)), locked.shape[1])
        raise ConvergenceError(
            f"friction locks the mesh with {laws[law]} {_where(points[min(point, len(points) - 1)])}: "
            f"{jamming_words(float(acting[law, point]), float(limit[law, point]))}; no force carries the load"
            f"{_far_outside(laws[law], float(acting[law, point]))}"
        )


def _far_outside(name: str, acting: float) -> str:
    """That a law is out of its range where it locks a mesh, as the end of a sentence; empty where it is not.

    Example:
        >>> _far_outside("constant", 0.9)
        ''
        >>> _far_outside("xu_2007", 0.9)[:60]
        "; steel in oil has at most about 0.2: 'xu_2007' is far out o"
    """
    largest = FRICTION[name].largest if name in FRICTION else inf
    if acting <= largest:
        return ""
    return (
        f"; steel in oil has at most about {largest:g}: '{name}' is far out of its range here, without it in "
        "models.friction the other laws are computed"
    )


def jamming_words(acting: float, limit: float) -> str:
    """Why friction locks a mesh, in words.

    Args:
        acting: friction coefficient, under the force without friction.
        limit: from which on the mesh locks.

    Example:
        >>> jamming_words(0.312, 0.29)
        'friction 0.312 reaches the 0.29 at which this mesh locks'
        >>> jamming_words(0.25, 0.29)
        'friction 0.25 grows with the force, and at 0.29 this mesh locks'
    """
    if acting < limit * (1.0 - NEARLY_JAMMED):
        return f"friction {acting:.3g} grows with the force, and at {limit:.3g} this mesh locks"
    return f"friction {acting:.3g} reaches the {limit:.3g} at which this mesh locks"


def _where(built: Ready) -> str:
    point = built.case.operation
    return ", ".join(
        f"{name} {kind.show(value)}"
        for name, kind, value in (
            (f"at {built.carried.kind}", built.carried, point.load),
            ("speed", SPEED, point.speed),
            ("temperature", TEMPERATURE, point.temperature),
        )
    )


def conformal(mesh: Mesh, run: Mapping[str, Any]) -> np.ndarray:
    """True for loaded contacts whose flanks have the same curvature nearly: their relative radius is cut."""
    flat = np.asarray(run["radius"]) > float(largest_radius(mesh)) * (1.0 - 1e-9)
    alike: np.ndarray = (np.asarray(run["load"]) > 0.0) & flat
    return alike


def conformal_warning(mesh: Mesh, run: Mapping[str, Any]) -> list[str]:
    """Contacts whose flanks have the same curvature nearly, where the formulas of contact do not hold."""
    loaded, flat = np.asarray(run["load"]) > 0.0, conformal(mesh, run)
    if not flat.any():
        return []
    return [
        Doubt(
            f"{flat.sum()} of {loaded.sum()} loaded contacts of the mesh cycle are conformal: their relative "
            f"radius is cut at {float(largest_radius(mesh)):.3g} m, and pressure and film there say little.",
            moves=flat.sum() / loaded.sum(),
            brief=f"{flat.sum()} of {loaded.sum()} contacts conformal: film says little.",
        )
    ]


def faces_warning(points: Sequence[Built], carrying: np.ndarray, slices: np.ndarray) -> list[str]:
    """Points of a study whose contact lines get load along a part only; `face_warning` has one point.

    Args:
        points: of the study.
        carrying: slices that carry of a contact line that does, the mean [law, point]; NaN where none.
        slices: of a contact line [point].
    """
    if len(points) == 1:
        return []
    gaps = np.array([not touching(point.design.mesh) for point in points])
    fewest = np.where(np.isnan(carrying) | ~gaps, np.inf, carrying).min(axis=0)
    nearly = (fewest < LEAST_FACE) & (slices > 1)
    partly = (fewest < slices * (1.0 - 1e-9)) & ~nearly
    doubts: list[str] = []
    if nearly.any():
        doubts.append(
            Doubt(
                f"At {nearly.sum()} of {len(points)} points fewer than {LEAST_FACE:g} slices of a contact "
                "line get load in the mean, nearly a point in place of a line: their figures say little. "
                "Less crowning, end relief or misalignment, a higher load or more slices leave a line of "
                "contact.",
                moves=WITHHELD,
                brief=f"At {nearly.sum()} of {len(points)} points a line is nearly a point.",
            )
        )
    if partly.any():
        most = 1.0 - (fewest[partly] / slices[partly]).min()
        doubts.append(
            Doubt(
                f"At {partly.sum()} of {len(points)} points a part of the contact lines that carry, up to "
                f"{in_percent(most)}, gets no load; flanks do not touch there.",
                moves=most,
                brief=f"Up to {in_percent(most)} of the contact lines carry nothing at some points.",
            )
        )
    return doubts


def beyond_face(run: Mapping[str, Any]) -> np.ndarray:
    """True at nodes where an elliptic contact is longer than the face has room for [node]."""
    if "contact_room" not in run:
        return np.zeros(np.shape(run["weight"]), bool)
    longest = np.asarray(run["semi_axis_across"]).max(axis=(1, 2))
    beyond: np.ndarray = longest > np.asarray(run["contact_room"])
    return beyond


def _length(value: float) -> str:
    return LENGTH.show(float(f"{value:.3g}"))


def proportions_words(points: Sequence[Built]) -> str:
    """What the stiffness of gears rests on that is assumed, as the end of a sentence; empty if nothing is.

    Args:
        points: one, or the stages of a drive.
    """
    names = _proportions(points)
    if not names:
        return ""
    varies = dict.fromkeys(
        assumption.varies
        for built in points
        for assumption in built.assumed.values()
        if assumption.varies
    )
    return "; ".join([f"; assumed proportions: {', '.join(names)}", *varies])


def proportions_counted(points: Sequence[Built]) -> str:
    """In short on how many assumed dimensions the stiffness of gears rests; empty if on none.

    Args:
        points: one, or the stages of a drive.
    """
    count = len(_proportions(points))
    if not count:
        return ""
    phrase = "1 dimension of its parts is" if count == 1 else f"{count} dimensions of its parts are"
    return f"; {phrase} assumed, see the inputs"


def _proportions(points: Sequence[Built]) -> list[str]:
    """Names of the proportions that are assumed."""
    keys = (key for built in points for key in built.assumed)
    return [*dict.fromkeys(key.rpartition(".")[2].replace("_", " ") for key in keys)]


def cold_warning(built: Built, run: Mapping[str, np.ndarray]) -> str:
    """That films are isothermal, and how warm they would become where that is much.

    Args:
        built: with materials and oil.
        run: pressure, radius, entrainment, sliding velocity, film thickness and friction of contacts.
    """
    warmest = float(np.nanmax(_rise(built, run), initial=0.0))
    if warmest == 0.0:
        return Doubt(f"{COLD}; {INLET}.", brief=f"{COLD}: as warm as the oil in their inlet.")
    felt = 1.0 - exp(-THINS * warmest)
    brief = f"{COLD}; friction would warm them by some {warmest:.2g} K."
    sentence = f"{COLD}, and friction would warm them by up to about {warmest:.2g} K; {INLET}"
    if warmest < WARM:
        return Doubt(f"{sentence}.", moves=felt, brief=brief)
    squeezes = built.case.film is not None and built.case.film.squeezes
    advice = 'thermal = "mean_film" in [film] takes the heat along' + (
        ", of steady films alone: leave time out for that" if squeezes else ""
    )
    return Doubt(
        f"{sentence}, so that friction comes out too high and the film too thick; {advice}.",
        moves=felt,
        brief=brief,
    )


COLD, INLET = (
    "The films are isothermal",
    "the oil in a contact is taken as warm as that in its inlet",
)

THINS = 0.03
"""Part of a film that a kelvin takes: viscosity loses 4 to 5 %, and films go with its 0.7th power."""

WARM = 10.0
"""Rise of temperature from which on it is told that isothermal films leave it out [K]."""


def _rise(built: Built, run: Mapping[str, np.ndarray]) -> np.ndarray:
    """Estimate of the rise of films above their inlet [K], zero where what conducts heat is not known.

    Flash temperature of both surfaces by the heat of friction, evenly over the dry contact, and the mean over
    the film above it, q h/(12 k).
    """
    try:
        a, b = (Conductor.of(used.record) for used in built.solids)
    except InputError:
        return np.zeros(1)
    entrainment, sliding = (np.abs(run[name]) for name in ("entrainment", "sliding_velocity"))
    heat = np.pi / 4.0 * run["pressure"] * run["friction"] * sliding
    # Half-width 4 p R/E' of a dry line contact.
    half_width = 4.0 * run["pressure"] * run["radius"] / built.modulus
    speeds = entrainment + 0.5 * sliding, np.abs(entrainment - 0.5 * sliding)
    flash = shared_flash(
        heat=heat, half_width=half_width, speed_a=speeds[0], speed_b=speeds[1], bodies=(a, b)
    )
    within = np.maximum(run["film_thickness"], 0.0) / (
        12.0 * float(built.design.lubricant.conductivity)
    )
    return np.where(heat > 0.0, np.asarray(flash) + heat * within, 0.0)


def law_sentences(law: Limited, reasons: Sequence[str]) -> list[str]:
    """Sentences on a law."""
    return [reworded(reason, lambda text: f"{law.name}: {text}.") for reason in reasons]


def why_outside(built: Built, law: FrictionLaw, run: Mapping[str, np.ndarray]) -> list[str]:
    """Why a law does not hold at an operating point, in words; empty where it does."""
    reasons: list[str] = [
        *range_left(law, run, "friction"),
        *map(str, run.get("outside films", ())),
    ]
    if run["locked"].any():
        largest = f"{run['friction'].max():.2g}"
        locks = f"its friction coefficient, {largest}, locks the mesh"
        reasons.append(Doubt(locks, moves=WITHHELD, brief=f"friction of {largest} locks the mesh"))
    loaded = run["load"] > 0.0
    if not loaded.any():
        return reasons
    lowest = float(run["friction"].min(where=loaded, initial=np.inf))
    highest = float(run["friction"].max(where=loaded, initial=0.0))
    thinnest = float(run["lambda_ratio"].min(where=loaded, initial=np.inf))
    reasons += friction_beyond(law, lowest, highest, thinnest)
    rolling = ROLLING_RESISTANCE[built.case.models.rolling_resistance]
    if law.whole and rolling.sources:
        share = rolling_share(run)
        reasons.append(
            Doubt(
                "its coefficient was fitted to whole losses of gears, those of rolling among them; with "
                f"'{rolling.name}' beside it rolling counts twice, here with {share:.2g} % of the loss",
                moves=share / 100.0,
                brief=f"rolling counts twice, {share:.2g} % of the loss",
            )
        )
    return reasons


def friction_beyond(
    law: FrictionLaw, lowest: float, highest: float, thinnest: float
) -> list[Doubt]:
    """Why the friction of a law is none that it describes, in words; empty where it is.

    Args:
        law: of friction.
        lowest, highest: coefficients over the contacts that carry.
        thinnest: film of these over the composite roughness Rq.
    """
    reasons: list[Doubt] = []
    if lowest < 0.0:
        drives = f"its friction coefficient falls to {lowest:.2g}: such friction drives the gears"
        brief = f"friction falls to {lowest:.2g} and drives the gears"
        reasons.append(Doubt(drives, moves=WITHHELD, brief=brief))
    if law.full_film and thinnest < 1.0:
        reasons.append(
            Doubt(
                f"its friction up to {highest:.2g} is an extrapolation; the film is down to {thinnest:.2g} "
                "of the composite roughness Rq, and the law describes contacts with a full film",
                moves=GUESSED,
                brief=f"friction extrapolated, film down to {thinnest:.2g} Rq",
            )
        )
    elif highest > law.largest:
        reasons.append(
            Doubt(
                f"its friction up to {highest:.2g} is an extrapolation; steel in oil has at most about "
                f"{BOUNDARY:g}",
                moves=highest / law.largest - 1.0,
                brief=f"friction {highest:.2g}, steel in oil has {BOUNDARY:g}",
            )
        )
    return reasons


def range_left(law: Limited, run: Mapping[str, np.ndarray], gives: str) -> list[Doubt]:
    """Which conditions leave the range of a law that `gives` a film, say, in words."""
    outside = {name: run[f"outside {law.name} {name}"] for name in law.ranges}
    return [
        Doubt(
            f"its {gives} is an extrapolation {_how_long(where, run['weight'])}; the "
            f"{name.replace('_', ' ')} leaves the range of the law, {limits_words(name, law.ranges[name])}",
            moves=GUESSED * float(np.sum(where * run["weight"])),
            brief=f"{name.removesuffix('_parameter').replace('_', ' ')} out of range "
            f"{_part_of(where, run['weight'])}",
        )
        for name, where in outside.items()
        if np.any(where)
    ]


def why_not_at(built: Built, law: FrictionLaw, extremes: Mapping[str, float]) -> list[str]:
    """Why a law does not hold at one of many points, in words; empty where it does, see `why_outside`.

    Args:
        built: the point.
        law: of friction.
        extremes: "lowest_" and "highest_" of friction, film ratio and conditions by which laws are limited,
            over the contacts that carry.
    """
    reasons: list[str] = [
        f"{name.replace('_', ' ')} leaves the range of the law, {limits_words(name, limits)}"
        for name, limits in law.ranges.items()
        if extremes[f"lowest_{name}"] < limits[0] or extremes[f"highest_{name}"] > limits[1]
    ]
    ends = (
        extremes[name] for name in ("lowest_friction", "highest_friction", "lowest_lambda_ratio")
    )
    reasons += [doubt.brief for doubt in friction_beyond(law, *ends)]
    if law.whole and ROLLING_RESISTANCE[built.case.models.rolling_resistance].sources:
        reasons.append("rolling counts twice")
    return reasons


def _how_long(outside: np.ndarray, weight: np.ndarray) -> str:
    share = _part_of(outside, weight)
    return share if share == "throughout" else f"in {share.replace('a cycle', 'the mesh cycle')}"


def _part_of(outside: np.ndarray, weight: np.ndarray) -> str:
    share = float(np.sum(outside * weight))
    return "throughout" if share > 1.0 - 1e-9 else f"{in_percent(share)} of a cycle"


def rolling_share(run: Mapping[str, np.ndarray]) -> float:
    """Part of the loss in the teeth that rolling takes [%]."""
    rolling, sliding = (
        float(np.sum(np.sum(run[name], axis=(1, 2)) * run["weight"]))
        for name in ("rolling_loss", "sliding_loss")
    )
    return 100.0 * rolling / (rolling + sliding)


# ---- what is asked of a mesh cycle, in the order in which it is told


@OF_CYCLES.add()
def laws_left(at: AtWork) -> Iterator[str]:
    """Friction laws that do not hold; doubts about films of the first one stand with a table of them.

    What each law in its registry says that it holds for, see `why_outside`.
    """
    for law, run in at.under:
        beside = at.built.case.film is not None and law is at.laws[0]
        films = set(map(str, run["outside films"])) if beside else ()
        yield from law_sentences(
            law, [why for why in why_outside(at.built, law, run) if why not in films]
        )


@OF_CYCLES.add("olver_spikes_2004")
def boundary_warning(at: AtWork) -> list[str]:
    """That a law leaves out friction of asperities, where these carry most of the load over the whole cycle.

    Asperities carry 1/(1 + lambda)^2 of the load, with the friction of steel in oil under boundary
    lubrication. Laws of full films say that they are out of their range; one that was fitted to gears knows
    none, and its coefficient may be far below this share.
    """
    return [text for law, run in at.under for text in _rougher(at.built, law, run)]


def _rougher(built: Built, law: FrictionLaw, run: Mapping[str, np.ndarray]) -> list[str]:
    """The same of one law."""
    loaded = run["load"] > 0.0
    of_steel = law.largest == BOUNDARY and not any(used.plastic for used in built.solids)
    if law.full_film or not (of_steel and loaded.any()):
        return []
    carried = (1.0 + np.maximum(run["lambda_ratio"], 0.0)) ** -2.0
    if np.min(carried, where=loaded, initial=1.0) < 0.5:
        return []
    loss = run["sliding_loss"] * run["weight"][:, None, None]
    ratio = np.divide(
        USUAL_BOUNDARY * carried, run["friction"], where=loss > 0.0, out=np.ones_like(loss)
    )
    times = (
        float(np.sum(loss * np.maximum(ratio, 1.0)) / np.sum(loss)) if np.any(loss > 0.0) else 1.0
    )
    thinnest = float(np.min(run["lambda_ratio"], where=loaded, initial=np.inf))
    doubt = Doubt(
        f"the film is down to {thinnest:.2g} of the composite roughness Rq, and asperities carry most of the "
        f"load; with boundary friction of steel in oil, about {USUAL_BOUNDARY:g}, the loss is up to "
        f"{times:.2g} times as large",
        "boundary",
        times,
        moves=times - 1.0,
        brief=f"loss up to {times:.2g} times, film down to {thinnest:.2g} Rq",
    )
    return law_sentences(law, [doubt]) if times > 1.0 else []


@OF_CYCLES.add()
def cold_law(at: AtWork) -> list[str]:
    """What isothermal films of a friction law leave out; a table of films says it of its own.

    A rise by friction from `WARM` on, of which each kelvin takes `THINS` of the film.
    """
    if at.built.case.film is not None:
        return []
    solved = [(law.films, run) for law, run in at.under if law.films is not None]
    return [cold_warning(at.built, run) for films, run in solved if films.thermal == ISOTHERMAL]


@OF_CYCLES.add()
def film_left(at: AtWork) -> list[str]:
    """Conditions that leave the range of the film law, which answers there too.

    The range of the law in its registry.
    """
    film = at.built.film
    return law_sentences(film, range_left(film, at.runs[0], "film"))


@OF_CYCLES.add()
def asperity_warning(at: AtWork) -> list[str]:
    """Conditions that leave the range of the law of the load on asperities, and where it is cut.

    The range of the law in its registry; asperities carry no more than the whole load.
    """
    law, run = at.built.asperities, at.runs[0]
    if law is None:
        return []
    reasons: list[str] = [*range_left(law, run, "asperity load")]
    cut = np.any(run["asperity_load_ratio"] >= 1.0, axis=(1, 2))
    if cut.any():
        reasons.append(
            Doubt(
                f"its asperity load is cut at 100 % {_how_long(cut, run['weight'])}; the law gives more",
                moves=GUESSED * float(np.sum(cut * run["weight"])),
                brief=f"all load on asperities {_part_of(cut, run['weight'])}",
            )
        )
    return law_sentences(law, reasons)


@OF_CYCLES.add()
def conformal_cycle(at: AtWork) -> list[str]:
    """Contacts whose flanks have the same curvature nearly, see `conformal_warning`.

    Relative radii that are cut at the largest one of the mesh.
    """
    return conformal_warning(at.built.design.mesh, at.runs[0])


@OF_CYCLES.add()
def face_warning(at: AtWork) -> list[str]:
    """Part of the contact lines that gets no load; refused where hardly any of them gets some.

    Slices that carry of a line that does, in the mean; at least `LEAST_FACE` of them make a line.
    """
    built, run = at.built, at.runs[0]
    mesh, active = built.design.mesh, np.asarray(run["active"])
    carries = np.asarray(run["load"]) > 0.0
    pairs, slices = carries.any(axis=2), active.shape[2]
    if touching(mesh) or slices == 1 or not pairs.any():
        return []
    lines = np.sum(pairs.sum(axis=1) * run["weight"])
    mean = float(np.sum(carries.sum(axis=(1, 2)) * run["weight"]) / lines)
    load = built.carried.show(built.case.operation.load)
    if mean < LEAST_FACE:
        raise InputError(
            f"at {load} only {mean:.2g} of {slices} slices of a contact line get load in the mean, nearly a "
            "point in place of a line; less crowning, end relief or misalignment, a higher load or more "
            "slices leave a line of contact",
            key="gears",
        )
    if mean > slices * (1.0 - 1e-9):
        return []
    idle = 1.0 - mean / slices
    return [
        Doubt(
            f"Of the contact lines that carry, {in_percent(idle)} get no load at {load}; flanks do not "
            "touch there.",
            moves=idle,
            brief=f"{in_percent(idle)} of the contact lines carry nothing at {load}.",
        )
    ]


@OF_CYCLES.add()
def room_warning(at: AtWork) -> list[str]:
    """Elliptic contacts that are longer than the face has room for.

    The half-axis across the face, over the distance of the nearest end of a face.
    """
    run = at.runs[0]
    if not beyond_face(run).any():
        return []
    longest, room = (float(np.max(run[name])) for name in ("semi_axis_across", "contact_room"))
    return [
        fails(
            f"the contact reaches {_length(longest)} to each side across the face, and the nearest end of a "
            f"face is {_length(room)} away: its pressure, approach and film are those of an ellipse that has "
            "room.",
            f"the contact needs {_length(longest)} of a face that leaves {_length(room)}.",
        )
    ]
