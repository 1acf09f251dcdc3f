"""What cannot be: checks of computed numbers, whose sentences stand above every number of a result.

A check asks whether steel, plastic, oil or the formulas themselves bear what was computed. What it finds is
marked so. An analysis may mark warnings of its own by `fails`: they go to the same place.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf, pi
from typing import Any, Final

import numpy as np
import xarray as xr

from pitchpoint.analyses.caveats import AtWork, conformal, rolling_share
from pitchpoint.analyses.main_figures import laws_hold, why_not
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.solids import SolidInUse
from pitchpoint.contact.contacts import Shape
from pitchpoint.core.doubts import Checks, Doubt, in_percent
from pitchpoint.input.quantities import Quantity
from pitchpoint.lubrication.lubrication_registry import BOUNDARY, ROLLING_RESISTANCE
from pitchpoint.materials import solids
from pitchpoint.materials.solids import celsius
from pitchpoint.strength.limits import STRESS_CORRECTION

__all__ = ["OF_CONTACTS", "OF_RESULTS", "ResultParts", "implausible", "unlikely"]

GPA, MPA = (Quantity("pressure", 0.0, 1e15, unit) for unit in ("GPa", "MPa"))
LENGTH = Quantity("length", 0.0, 1e3, "um")

MEAN_PRESSURE: Final[Mapping[Shape, float]] = {"line": pi / 4.0, "ellipse": 2.0 / 3.0}
"""Mean pressure of a Hertz contact over its largest."""

SMALL_STRAIN = 0.05
"""Largest Hertz pressure over the reduced modulus that small strains allow, see `contact_strain`."""

STRONGEST_ROOT = 2.6e9
"""Root stress that the strongest case-hardened teeth bear once, 2.5 Y_ST sigma_Flim of quality ME [Pa]."""

ATOM = 0.3e-9
"""Distance of atoms in a solid, roughly; molecules of oil are thicker [m]."""

DRY_PLASTIC = 0.4
"""Friction coefficient that plastics reach without any oil."""

FASTEST = 250.0
"""Speed of pitch circles that the fastest turbo gears reach [m/s]."""

ROUGHEST = 12.5e-6
"""Mean Ra of flanks as rough as no cutter leaves them [m]."""

COARSEST = 0.01
"""Composite Rq over the relative radius beyond which roughness is as large as the flanks."""

THICKEST = 2e-3
"""Film over the relative radius beyond which nothing is left of a film thinner than all else."""

MOST = 0.5
"""Part of load or loss from which on a place decides about the whole."""


@dataclass(frozen=True)
class ResultParts:
    """Parts of a result, as far as they are there."""

    built: Ready
    parts: Mapping[str, xr.Dataset]


OF_CONTACTS = Checks[AtWork]("the contacts of a mesh", fails=True)
OF_RESULTS = Checks[ResultParts]("the main figures of a result", fails=True)


def implausible(at: AtWork) -> list[Doubt]:
    """What cannot be in the contacts of a mesh, in sentences that are marked so."""
    return OF_CONTACTS.of(at) if at.loaded else []


def unlikely(built: Ready, parts: Mapping[str, xr.Dataset]) -> list[Doubt]:
    """What cannot be in the figures of a result, in sentences that are marked so."""
    return OF_RESULTS.of(ResultParts(built, parts))


# ---- of the contacts of a mesh


@OF_CONTACTS.add("iso_6336_5_2016", "johnson_1985")
def hertz_pressure(at: AtWork) -> str | None:
    """A pressure that the weaker of both materials does not bear even once.

    The contact limit of the catalogue, where there is one. A mean pressure above the hardness, the force over
    the area of an indentation, indents by definition.
    """
    largest, shape = at.largest("pressure"), at.built.design.mesh.shape
    weakest = min(
        (limit for used in at.built.solids for limit in _bears(used, shape)), default=None
    )
    if weakest is None or largest <= weakest[0]:
        return None
    limit, why, bears = weakest
    brief = f"the Hertz pressure reaches {_pressure(largest)}, {bears} {_pressure(limit)}"
    return Doubt(f"the Hertz pressure reaches {_pressure(largest)}; {why}", brief=brief)


def _bears(used: SolidInUse, shape: Shape) -> Iterator[tuple[float, str, str]]:
    """Largest Hertz pressures of a material, what happens there, and words before them in a brief."""
    name, hardness = used.record.name, used.record.hardness
    if (limit := used.bears) is not None:
        phrase = f"{name} bears about {_pressure(limit.value)}, and that a few times only"
        yield limit.value, phrase, "the material bears"
    if hardness is not None:
        most = hardness.value / MEAN_PRESSURE[shape]
        phrase = f"from {_pressure(most)} on its mean is more than the hardness of {name}"
        why = f"{phrase}, {_pressure(hardness.value)}, by which it is indented"
        yield most, why, "by hardness borne"


@OF_CONTACTS.add("johnson_1985")
def contact_strain(at: AtWork) -> str | None:
    """A pressure beside which the modulus is small, of materials whose limit nobody knows.

    At 0.05 of the reduced modulus a line of contact is 0.2 of the relative radius wide to each side: half
    spaces and small strains are at their end. The number is assumed; plastics yield before.
    """
    largest, modulus = at.largest("pressure"), at.built.modulus
    if largest <= SMALL_STRAIN * modulus or hertz_pressure(at):
        return None
    return Doubt(
        f"the Hertz pressure reaches {_pressure(largest)}, {in_percent(largest / modulus)} of "
        "the reduced modulus; elastic contacts with strains as small as the formulas ask for end at "
        f"{100.0 * SMALL_STRAIN:g} %",
        brief=f"Hertz pressure {in_percent(largest / modulus)} of the modulus: strains are large",
    )


@OF_CONTACTS.add()
def plastic_temperature(at: AtWork) -> str | None:
    """A plastic given by value, of which no limit is known, hotter than any of the catalogue bears.

    The highest service limit of all plastics of the catalogue. Those of the catalogue have their own, which
    building a case checks.
    """
    name, limit = _toughest()
    for gear, used in enumerate(at.built.solids, 1):
        unknown = used.plastic and used.record.service_limit is None
        if unknown and used.hottest > limit:
            return Doubt(
                f"the teeth of gear {gear} are at {celsius(used.hottest)}; no plastic of the catalogue bears "
                f"more than {celsius(limit)} for long, which {name} does",
                brief=f"gear {gear} is at {celsius(used.hottest)}; plastics end at {celsius(limit)}",
            )
    return None


def _toughest() -> tuple[str, float]:
    """The plastic of the catalogue that bears the highest temperature for long, and that temperature [K]."""
    limits = {name: solid.service_limit for name, solid in solids.catalogue().items()}
    limited = {name: limit.value for name, limit in limits.items() if limit is not None}
    return max(limited.items(), key=lambda item: item[1])


@OF_CONTACTS.add()
def flank_speed(at: AtWork) -> str | None:
    """Gears faster than any that run.

    250 m/s, which the fastest turbo gears reach. The number is assumed.
    """
    surfaces = max(
        float(np.max(np.abs(run["entrainment"]) + 0.5 * np.abs(run["sliding_velocity"])))
        for run in at.runs
    )
    pitch = float(at.built.nominal["pitch_line_speed"]) * at.built.case.operation.speed
    if max(pitch, surfaces) <= FASTEST:
        return None
    what = "pitch circles" if pitch >= surfaces else "flanks"
    return Doubt(
        f"the {what} run at {max(pitch, surfaces):.3g} m/s; the fastest gears reach about {FASTEST:g} m/s",
        brief=f"{what} at {max(pitch, surfaces):.3g} m/s, fastest gears {FASTEST:g} m/s",
    )


@OF_CONTACTS.add()
def film_of_atoms(at: AtWork) -> str | None:
    """Films thinner than an atom where most of the load is.

    0.3 nm, under more than half of the load: where surfaces come to rest for a moment, every film law gives
    nothing. The number is assumed.
    """
    thin = [_part(_carried(run), run["film_thickness"] < ATOM) for run in at.runs]
    if max(thin) <= MOST:
        return None
    thinnest = min(float(run["film_thickness"][run["load"] > 0.0].min()) for run in at.runs)
    thickness = f"{1e9 * thinnest:.2g} nm" if 1e12 * thinnest >= 1.0 else "less than 0.001 nm"
    return Doubt(
        f"the film is down to {thickness}, under {100.0 * max(thin):.3g} % of the load "
        f"thinner than an atom, {1e9 * ATOM:g} nm: flanks touch, and film, Λ and what follows "
        "from them say nothing",
        brief=f"film down to {thickness}, less than an atom: flanks touch",
    )


@OF_CONTACTS.add()
def thick_film(at: AtWork) -> str | None:
    """Films that are no longer thin beside the bodies that they part.

    A film of 0.2 % of the relative radius; sound gears have at most 0.04 %. The number is assumed.
    """
    ratio = max(float(np.nanmax(_over(run["film_thickness"], run["radius"]))) for run in at.runs)
    if ratio <= THICKEST:
        return None
    thickest = max(float(np.nanmax(run["film_thickness"])) for run in at.runs)
    return Doubt(
        f"the film reaches {_shown(LENGTH, thickest)}, {in_percent(ratio)} of the relative radius of the "
        f"flanks; laws of thin films end before {100.0 * THICKEST:g} %",
        brief=f"film of {_shown(LENGTH, thickest)}, {in_percent(ratio)} of the radius: not thin",
    )


@OF_CONTACTS.add()
def roughness(at: AtWork) -> str | None:
    """Flanks rougher than any cutter leaves them, or than their own size allows.

    A mean Ra of 12.5 um, or under more than half of the load a composite Rq of 1 % of the relative radius.
    The numbers are assumed.
    """
    flanks, run = at.built.design.roughness, at.runs[0]
    ra = 0.5 * (float(flanks.ra_1) + float(flanks.ra_2))
    rq = float(np.hypot(flanks.rq_1, flanks.rq_2))
    if ra > ROUGHEST:
        return Doubt(
            f"the mean Ra of the flanks is {_shown(LENGTH, ra)}; roughly cut flanks have at most about "
            f"{LENGTH.show(ROUGHEST)}",
            brief=f"Ra is {_shown(LENGTH, ra)}, rough flanks have {LENGTH.show(ROUGHEST)}",
        )
    coarse = rq > COARSEST * run["radius"]
    if _part(_carried(run), coarse) <= MOST:
        return None
    return Doubt(
        f"the composite Rq of the flanks, {_shown(LENGTH, rq)}, is more than {100.0 * COARSEST:g} % of their "
        "relative radius under most of the load: that is their shape, no roughness",
        brief=f"Rq {_shown(LENGTH, rq)} is over {100.0 * COARSEST:g} % of the radius: no roughness",
    )


@OF_CONTACTS.add()
def friction(at: AtWork) -> str | None:
    """A coefficient, given or of a law that knows no limit, that no lubricated contact has.

    0.2 for steel in oil, 0.4 with a plastic, for coefficients that are given and laws without a limit; others
    are out of their range there. The numbers are assumed.
    """
    most = DRY_PLASTIC if at.plastic else BOUNDARY
    mean = {
        law.title: float(np.sum(_carried(run) * run["friction"]))
        for law, run in zip(at.laws, at.runs, strict=True)
        if law.largest == inf
    }
    title, largest = max(mean.items(), key=lambda item: item[1], default=("", 0.0))
    if largest <= most * (1.0 + 1e-9):
        return None
    limit_words = "plastics have at most about {:g} even without oil" if at.plastic else _STEEL
    sentence = (
        f"{title}: the mean friction coefficient is {largest:.3g}; {limit_words.format(most)}"
    )
    return Doubt(sentence, brief=f"mean friction {largest:.3g}; allowed about {most:g}")


_STEEL = "steel in oil has at most about {:g}"


@OF_CONTACTS.add()
def conformal_loss(at: AtWork) -> str | None:
    """Conformal contacts, whose pressure and film say little, that make most of the loss.

    More than half of the loss in the teeth from contacts whose relative radius is cut.
    """
    parts = [_part(_lost(run), conformal(at.built.design.mesh, run)) for run in at.runs]
    if max(parts) <= MOST:
        return None
    return Doubt(
        f"contacts whose flanks are conformal make {100.0 * max(parts):.3g} % of the loss in the teeth, and "
        "the formulas of pressure and film do not hold there",
        brief=f"{100.0 * max(parts):.3g} % of the loss is in conformal contacts, without formulas",
    )


@OF_CONTACTS.add()
def rolling_twice(at: AtWork) -> str | None:
    """A law of whole losses beside a rolling resistance.

    A friction law that was fitted to whole losses of gears, beside a rolling resistance.
    """
    rolling = ROLLING_RESISTANCE[at.built.case.models.rolling_resistance]
    of_whole_losses = [(law, run) for law, run in zip(at.laws, at.runs, strict=True) if law.whole]
    if not of_whole_losses or not rolling.sources:
        return None
    law, run = of_whole_losses[0]
    return Doubt(
        f"rolling is counted twice: {law.title} was fitted to whole losses of gears, those of rolling among "
        f"them, and '{rolling.name}' adds {rolling_share(run):.2g} % of the loss once more",
        brief=f"rolling is counted twice, {rolling_share(run):.2g} % of the loss",
    )


# ---- of the figures of a result


@OF_RESULTS.add()
def efficiency(result: ResultParts) -> str | None:
    """More power that comes out than goes in, or none that does.

    Not below zero, not above one: energy is conserved.
    """
    if "operation" not in result.parts:
        return None
    values = result.parts["operation"]["mean_efficiency"].values[:, 0]
    beyond = values[(values > 1.0 + 1e-9) | (values < 0.0)]
    if not beyond.size:
        return None
    return (
        f"the mean efficiency is {100.0 * beyond[0]:.4g} %: more power would come out than goes in"
        if beyond[0] > 1.0
        else f"the mean efficiency is {100.0 * beyond[0]:.4g} %: more power is lost than goes in"
    )


@OF_RESULTS.add()
def friction_laws(result: ResultParts) -> str | None:
    """No law, of the case or of the library, that holds at the operating point.

    None of the case and of the library is in its range at the operating point.
    """
    laws = result.parts.get("laws")
    if laws is None or laws.sizes["law"] or any(laws_hold(result.parts)):
        return None
    names = result.parts["operation"]["law"].values
    reasons = {str(law): why_not(result.parts)[str(law)] for law in names}
    sentences = "; ".join(f"{law}: {' and '.join(why)}" for law, why in reasons.items())
    return Doubt(
        f"no friction law holds at the operating point, efficiency and loss are extrapolations: {sentences}",
        brief="no friction law holds here: efficiency and loss are guesses",
    )


@OF_RESULTS.add("iso_6336_5_2016", "vdi_2736_2_2014")
def root_stress(result: ResultParts) -> str | None:
    """A stress at a root that its material does not bear even once.

    Steel: the static strength 2.5 Y_ST sigma_Flim of case-hardened teeth of quality ME, 2.6 GPa. Plastics:
    Y_St = 2 times the tensile strength, at which the whole section yields; where that is not known, 0.05 of
    the modulus, which is assumed.
    """
    strength = result.parts.get("strength")
    if strength is None:
        return None
    built = result.built
    rated = [used for mesh in built.meshes if mesh.case.gears.rated for used in mesh.solids]
    stresses = np.ravel(strength["root_stress"].values)
    over = [
        (float(stress) / limit, float(stress), limit, why, place % 2 + 1)
        for place, (stress, used) in enumerate(zip(stresses, rated, strict=True))
        for limit, why in [_root_bears(used)]
        if stress > limit
    ]
    if not over:
        return None
    _, stress, limit, why, gear = max(over)
    return Doubt(
        f"the root stress of gear {gear} reaches {_pressure(stress)}; {why}",
        brief=f"root stress of gear {gear} is {_pressure(stress)}, borne {_pressure(limit)}",
    )


@OF_RESULTS.add()
def edge_load(result: ResultParts) -> str | None:
    """Edges of teeth that carry most of the load.

    More than half of the load at the operating point, where teeth are watched for it.
    """
    torsion = result.parts.get("torsion")
    if torsion is None or "edge_share" not in torsion:
        return None
    at = result.built.case.operation.load
    share = float(np.interp(at, torsion["torque"], torsion["edge_share"]))
    if not share > MOST:
        return None
    return Doubt(
        f"edges of the teeth (ends of flanks and roundings of tips) carry {100.0 * share:.3g} % of the "
        "load, and the formulas of contact do not hold there",
        brief=f"edges of the teeth carry {100.0 * share:.3g} % of the load",
    )


def _root_bears(used: SolidInUse) -> tuple[float, str]:
    """Largest root stress of a material, once, and why."""
    name, tensile = used.record.name, used.record.tensile_strength
    if not used.plastic:
        return (
            STRONGEST_ROOT,
            f"the strongest teeth of steel bear about {_pressure(STRONGEST_ROOT)}",
        )
    if tensile is None:
        limit = SMALL_STRAIN * float(used.solid.young)
        return limit, f"from {_pressure(limit)} on it strains {name} by more than 5 %"
    limit = STRESS_CORRECTION * tensile.value
    return limit, (
        f"from {_pressure(limit)} on, twice the tensile strength of {name}, its whole section breaks at once"
    )


# ---- what they share


def _shown(kind: Quantity, value: float) -> str:
    return kind.show(float(f"{value:.3g}"))


def _pressure(value: float) -> str:
    return _shown(GPA if value >= 1e9 else MPA, value)


def _carried(run: Mapping[str, Any]) -> np.ndarray:
    """Part of the load over the mesh cycle that each contact carries [node, pair, slice]."""
    return _whole(run["load"] * np.reshape(run["weight"], (-1, 1, 1)))


def _lost(run: Mapping[str, Any]) -> np.ndarray:
    """Part of the loss over the mesh cycle that each contact makes [node, pair, slice]."""
    loss = run["sliding_loss"] + run["rolling_loss"]
    return _whole(loss * np.reshape(run["weight"], (-1, 1, 1)))


def _whole(values: np.ndarray) -> np.ndarray:
    """Values over their sum; zero where that is nothing."""
    return _over(values, np.broadcast_to(values.sum(), values.shape))


def _part(values: np.ndarray, where: np.ndarray) -> float:
    return float(np.sum(values, where=where))


def _over(values: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Quotients; zero where there is nothing to divide by."""
    quotients: np.ndarray = np.divide(values, by, out=np.zeros_like(values), where=by > 0.0)
    return quotients
