"""Strength of cylindrical pairs: forces, flank pressure, root stress, safeties at the operating point."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from math import nan
from operator import itemgetter
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import jax
from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress, Unasked
from pitchpoint.analyses.lacking import no_pins
from pitchpoint.analyses.main_figures import RATING, numbers
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import BuiltTrain, Ready
from pitchpoint.core.doubts import Doubt, fails, in_stage
from pitchpoint.core.programs import program
from pitchpoint.efficiency.summary import groups_alike, joined_parts, of_stacks, stacks
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.rated_pair import bare_pair, ends_at_tips, rated_pair
from pitchpoint.results.by_stage import Label, alike_labels
from pitchpoint.results.store import dataset
from pitchpoint.strength.limits import STRESS_CORRECTION
from pitchpoint.strength.load_factors import MOST_RESONANCE
from pitchpoint.strength.rating import ROWS, ratings
from pitchpoint.strength.root import THINNEST_RIM, THINNEST_RING
from pitchpoint.strength.strength_table import MESH_LOAD

__all__ = ["STRENGTH", "mesh_load_of", "rated_rows", "rating_inputs", "ratings_of", "why_no_safety"]

_MAIN = (
    "tangential_force",
    "radial_force",
    "axial_force",
    "contact_stress",
    "flank_safety",
    "root_stress",
    "root_safety",
    *RATING,
)
_OF_GEARS = ("contact_stress", "root_stress", "flank_safety", "root_safety")
_SUBCRITICAL, _SUPERCRITICAL, _LEAST_OF_METHOD_B = 0.85, 1.5, 1.2
_SHARED = 2.0
_LEAST_NOTCH, _MOST_NOTCH = 1.0, 8.0
_DEEPEST = 2.5
_HELIX = np.radians(30.0) * (1.0 + 1e-12)  # 30 degrees of a file may be above by a bit

_PLASTIC = "the root of plastic gears by VDI 2736 Part 2, force at the tip"
_RING = (
    "The root of the ring is rated on its own fillet, an arc, where tangents make 60 degrees with the middle "
    "of the tooth; a pinion cutter leaves another one: cutter_teeth in [gears]."
)
_CUT = {
    "2019": "The root of the ring is rated on the fillet that its cutter generates, where tangents make 60 "
    "degrees with the middle of the tooth.",
    "2006": "The root of the ring is rated by the formulas of the edition of 2006 for a pinion cutter, which "
    "come near to the fillet that it generates.",
}
_METHOD_B = (
    "K_v by method B counts both gears as discs from their bores to the middle of their teeth, with nothing "
    "else on their shafts; that by method C stands beside it."
)
_SHAFT = (
    "K_Hβ by method C takes a pinion between two bearings on a steel shaft without modifications of its "
    "helix and deviations at the limits of the class."
)
_MISALIGNED = (
    "K_Hβ by method C takes a pinion between two bearings on a steel shaft without modifications of its "
    "helix, and for f_ma the misalignment of [gears], on the side to which the shaft bends."
)
_THINNED = (
    "Roots are those of the thinnest teeth that [gears.inspection] allows; all else is nominal."
)

_PARTS = {
    "flanks": ("flank_safety", "contact_stress", "contact_limit", "pit"),
    "roots": ("root_safety", "root_stress", "root_limit", "break"),
}

Numbers = Mapping[str, np.ndarray]


def _unrated(built: Ready) -> str | None:
    """Why there are no teeth to rate."""
    return None if _rated(built) else "ISO 6336 rates pairs of cylindrical gears, not these"


def _strength(built: Ready, _: Piece, __: PieceProgress) -> xr.Dataset:
    """The rating of a pair, or of those stages of a drive that are pairs of cylindrical gears."""
    rated, on_sharing = _with_sharing(built)
    pair_ratings = _ratings([mesh for _, mesh in rated])
    several = bool(built.numbers)
    values = pair_ratings[0]
    labels: dict[str, list[Any]] = {"gear": ["gear 1", "gear 2"]}
    if several:
        values = {
            name: np.stack([found[name] for found in pair_ratings]) for name in pair_ratings[0]
        }
        labels = {"stage": alike_labels([label for label, _ in rated]), **labels}
    dims = {name: tuple(labels)[: np.ndim(found)] for name, found in values.items()}
    extremes = _extremes(pair_ratings)

    def told(of: Callable[[Built, Numbers], Iterable[str]]) -> list[str]:
        pairs = zip(rated, pair_ratings, strict=True)
        every = [(label, text) for (label, mesh), rating in pairs for text in of(mesh, rating)]
        return [in_stage(label, text) if several else text for label, text in every]

    return dataset(
        {name: (dims[name], found) for name, found in values.items()}
        | {name: ((), found) for name, found in extremes.items()},
        labels,
        title="strength",
        method=_method([mesh for _, mesh in rated]),
        assumed=told(lambda mesh, _: _assumed(mesh)),
        withheld=told(lambda mesh, found: [*mesh.rated.withheld, *_bounds(mesh, found)]),
        remarks=[*told(lambda mesh, _: [*_remarks(mesh)]), *built.on_strength, *on_sharing],
        **_planets(built),
        warnings=told(lambda mesh, found: [*_failing(mesh, found), *_doubts(mesh, found)]),
    )


def _planets(built: Ready) -> dict[str, Any]:
    """Number of the planets that share a load, and their usual mesh load factor; of a lone train."""
    count = built.planets
    return {"planets": count, "usual_mesh_load_factor": MESH_LOAD.get(count, 1.0)} if count else {}


def _rated(built: Ready) -> list[tuple[Label, Built]]:
    """Meshes that are rated with their labels, in the order of the power."""
    meshes = zip(built.mesh_labels, built.meshes, strict=True)
    return [(label, mesh) for label, mesh in meshes if mesh.case.gears.rated]


def _with_sharing(built: Ready) -> tuple[list[tuple[Label, Built]], list[str]]:
    """Meshes that are rated, with K_γ by the pins of their planets where that is more, and sentences on it.

    A factor that the case gives stays. So does that of the standard where pins alone make less of it.
    """
    shared: dict[Built, Built] = {}
    remarks: list[str] = []
    for number, train in built.trains.items():
        by_pins, sentences = _shared(train)
        shared |= by_pins
        remarks += [in_stage(number, text) if number else text for text in sentences]
    return [(label, shared.get(mesh, mesh)) for label, mesh in _rated(built)], remarks


def _shared(built: BuiltTrain) -> tuple[dict[Built, Built], list[str]]:
    """Rated meshes of a set that take more by its pins, each with what it is then, and sentences on it."""
    from pitchpoint.analyses.planet_sharing import (  # few cases ask for it
        PERCENTILES,
        planet_shares,
    )

    lacks = no_pins(built)
    if lacks is not None:
        out_of_place = not isinstance(lacks, Unasked)
        return {}, [f"Pins out of place are not in K_γ: {lacks}."] * out_of_place
    sharing = planet_shares(built)
    factor = sharing.rated_factor
    by_pins = {
        mesh: _sharing_by(mesh, factor)
        for number, mesh in _rated(built)
        if _open_sharing(built, number)
    }
    within = "" if sharing.drawn is None else f" in {PERCENTILES[-1]:g} % of sets by tolerance"
    bears = (
        f"By the deviations of the set a planet bears up to {factor:.3g} of an equal share{within}"
    )
    if any(mesh is not before for before, mesh in by_pins.items()):
        return by_pins, [f"{bears}: K_γ is that."]
    return {}, [
        f"{bears}; K_γ stays that of the standard or of [strength], which stand for weight, friction and "
        "what else is not among them."
    ]


def _open_sharing(built: BuiltTrain, number: Label) -> bool:
    """True for a mesh of planets whose K_γ the case leaves open."""
    tables = built.case.strength, built.case.stages[str(number)].strength
    stated = any(table is not None and table.mesh_load_factor is not None for table in tables)
    return built.copies[built.numbers.index(number)] > 1 and not stated


def _sharing_by(built: Built, factor: float) -> Built:
    """A mesh under a mesh load factor, where that is more than what it has."""
    table = built.case.strength
    if table is None or factor <= (table.mesh_load_factor or 1.0):
        return built
    changed = table.model_copy(update={"mesh_load_factor": factor})
    return replace(built, case=built.case.model_copy(update={"strength": changed}))


def mesh_load_of(built: BuiltTrain) -> float:
    """Mesh load factor K_γ of a set: the largest one of its meshes, as they are rated.

    Args:
        built: the set.
    """
    tables = (mesh.case.strength for _, mesh in _with_sharing(built)[0])
    return max((table.mesh_load_factor or 1.0 for table in tables if table), default=1.0)


def rating_inputs(built: Ready) -> list[tuple[Label, tuple[Any, ...]]]:
    """Meshes of a drive that are rated with their labels, each as `rated` takes it.

    Args:
        built: the drive.
    """
    return [(label, _asked(mesh)) for label, mesh in _with_sharing(built)[0]]


def rated_rows(rows: Sequence[Any]) -> Numbers:
    """Ratings of many rows as `rated` takes them, of gears of one kind, by name along an axis in front.

    Args:
        rows: each a mesh and what is asked of it.
    """
    return of_stacks(
        (ratings(_bare(stack[0]), *stack[1:]), used) for stack, used in stacks(rows, ROWS)
    )


def _ratings(pairs: Sequence[Built]) -> list[Numbers]:
    """Ratings of pairs, together as far as their gears are of one kind."""
    rows = [_asked(pair) for pair in pairs]
    groups = groups_alike(rows)
    all_ratings = joined_parts([rated_rows([rows[k] for k in group]) for group in groups], groups)
    return [
        {name: values[row] for name, values in all_ratings.items()} for row in range(len(pairs))
    ]


def _asked(built: Built) -> tuple[Any, ...]:
    """A pair as `rated` takes it."""
    mesh, rating, table = built.design.mesh, built.rated, built.case.strength
    ends = np.full(2, nan) if ends_at_tips(mesh) else jax.device_get(_path_ends(mesh))
    life = None if table is None else table.life
    duty = rating.duty(built.operation, life, built.design.driver)
    return mesh, ends, duty, rating.factors, rating.strengths, rating.finish


@program
def _path_ends(mesh: Mesh) -> Float[Array, "2"]:
    return rated_pair(mesh).path_ends


def _bare(mesh: Mesh) -> Mesh:
    """Bare meshes, with an axis of pairs in front."""
    meshes: Mesh = jax.vmap(bare_pair)(mesh)
    return meshes


def _extremes(each: Sequence[Numbers]) -> dict[str, float]:
    """Largest stresses and least safeties of some ratings; NaN where no gear has that safety."""
    reduced = zip(RATING, _OF_GEARS, (np.fmax, np.fmax, np.fmin, np.fmin), strict=True)
    return {
        name: float(extreme.reduce(np.ravel([rating[of] for rating in each])))
        for name, of, extreme in reduced
    }


def ratings_of(points: Sequence[Ready], laws: int) -> dict[str, Any]:
    """Largest stresses and least safeties [law, point], the same under every friction law.

    None where teeth are not rated.
    """
    if STRENGTH.why_not(points[0]) is not None:
        return {}
    pairs = [[one for _, one in _with_sharing(point)[0]] for point in points]
    pair_ratings = iter(_ratings([one for point_pairs in pairs for one in point_pairs]))
    extremes = [_extremes([*islice(pair_ratings, len(point_pairs))]) for point_pairs in pairs]
    return {
        name: (("law", "point"), np.array([[one[name] for one in extremes]] * laws))
        for name in RATING
    }


def why_no_safety(built: Ready) -> str:
    """Why gears have no safeties, as a run tells it of the first of them; empty where all have them.

    Args:
        built: the case.
    """
    sentences = (text for _, mesh in _rated(built) for text in mesh.rated.withheld)
    why = next(sentences, "").removesuffix(".")
    return why[:1].lower() + why[1:]


def _method(pairs: Sequence[Built]) -> str:
    tables = [pair.rated.table for pair in pairs]
    editions = " and ".join(dict.fromkeys(table.edition for table in tables))
    methods = " and ".join(dict.fromkeys(table.dynamic_method for table in tables))
    face = "K_Hβ by method C where the shaft is given, " if any(t.shaft for t in tables) else ""
    plastic = any(used.plastic for pair in pairs for used in pair.solids)
    return (
        f"ISO 6336-2 and ISO 6336-3, edition of {editions}, method B; K_v by method {methods} of ISO 6336-1 "
        f"unless it is given, {face}the other load factors as given" + f"; {_PLASTIC}" * plastic
    )


def _assumed(built: Built) -> list[str]:
    """What a rating takes where the case leaves it open, as one sentence."""
    listed = "; ".join(built.rated.assumed)
    return [f"Assumed where [strength] says nothing: {listed}."] if listed else []


def _ring(built: Built) -> bool:
    return min(getattr(built.case.gears, "teeth", (0.0,))) < 0.0


def _remarks(built: Built) -> Iterator[str]:
    if built.case.gears.thickness_allowances is not None:
        yield _THINNED
    if _ring(built):
        cut = getattr(built.case.gears, "cutter_teeth", None) is not None
        yield _CUT[built.rated.table.edition] if cut else _RING
    if built.rated.table.dynamic_method == "B":
        yield _METHOD_B
    if built.rated.table.shaft is not None:
        yield _SHAFT if getattr(built.case.gears, "misalignment", None) is None else _MISALIGNED


def _failing(built: Built, found: Numbers) -> list[str]:
    """Which teeth do not bear their stress, the least safety first."""
    endless = built.case.strength is None or built.case.strength.life is None
    by_safety: list[tuple[float, str]] = []
    shared = float(built.rated.table.mesh_load_factor or 1.0)
    uneven = f", K_γ {shared:.3g}" if shared > max(MESH_LOAD.values()) else ""
    for at, gear in enumerate(("gear 1", "gear 2")):
        for part, (safety, stress, limit, how) in _PARTS.items():
            reached = float(found[safety][at])
            if reached < 1.0:
                when = "sooner or later" if endless else "within the life that is asked"
                if endless and part == "roots" and built.solids[at].plastic:
                    cycles = float(found["root_cycles"][at])
                    when = when if np.isnan(cycles) else f"within {cycles:g} load cycles"
                bears, has = (found[name][at] / 1e6 for name in (limit, stress))
                reaches = f"safety {reached:.3g}{uneven}"
                sentence = fails(
                    f"the {part} of {gear} have a stress of {has:.4g} MPa, of which {bears:.4g} MPa are "
                    f"permissible ({reaches}): they {how} {when}.",
                    f"{part} of {gear} {how} {when}, {reaches}.",
                )
                by_safety.append((reached, sentence))
    return [sentence for _, sentence in sorted(by_safety, key=itemgetter(0))]


def _doubts(built: Built, found: Numbers) -> Iterator[str]:
    """Where a rating lies outside what the standards cover."""
    resonance, ratio = (
        float(found["resonance_number"]),
        built.dimensions["transverse_contact_ratio"],
    )
    stated = built.case.strength is not None and built.case.strength.dynamic_factor is not None
    steel = not any(used.plastic for used in built.solids)
    by_b = built.rated.table.dynamic_method == "B"
    if by_b:
        yield from _doubts_of_method_b(found, ratio)
    if resonance > MOST_RESONANCE and steel and not stated and not by_b:
        yield Doubt(
            f"K_v by method C holds well below resonance, up to (v z_1/100) sqrt(u²/(1 + u²)) = "
            f"{MOST_RESONANCE:.2g} m/s, at which it stays; this pair is at {resonance:.3g} m/s: give "
            'dynamic_factor in [strength], or dynamic_method = "B".',
            brief=f"K_v ends at {MOST_RESONANCE:.2g} m/s, here {resonance:.3g} m/s: give dynamic_factor.",
        )
    for gear, notch in enumerate(found["notch_parameter"], 1):
        if not _LEAST_NOTCH <= notch < _MOST_NOTCH:
            yield Doubt(
                f"The notch parameter of gear {gear}, {notch:.3g}, is outside 1 to 8, for which Y_S was "
                "derived.",
                brief=f"Y_S of gear {gear}: notch parameter {notch:.3g} is outside 1 to 8.",
            )
    for gear, backup in enumerate(found["rim_backup"], 1):
        ring = _ring(built) and gear == 2
        least, of = (THINNEST_RING, "modules") if ring else (THINNEST_RIM, "tooth heights")
        if backup < least:
            yield Doubt(
                f"The rim of gear {gear} is {backup:.3g} {of} thick and Y_B is known down to {least:g}: its "
                "root stress is higher, and the rim itself may break.",
                brief=f"The rim of gear {gear} may break: {backup:.3g} {of} thick.",
            )
    if _SHARED < float(ratio) <= _DEEPEST and not getattr(built.case.gears, "helix_angle", 0.0):
        yield Doubt(
            "The flank stress leaves out the inner point of double contact; above a transverse contact ratio "
            "of 2 Z_B and Z_D are 1 here, and ISO 6336-2 has that point.",
            brief=f"Flank stress lacks the inner point at contact ratio {float(ratio):.3g}.",
        )
    if float(ratio) < 1.0:
        yield Doubt(
            f"The transverse contact ratio is {float(ratio):.3g}: ISO 6336 and VDI 2736 rate gears with one "
            "from 1 on, of which a pair always touches in every section; stresses here are extrapolations.",
            brief=f"Transverse contact ratio {float(ratio):.3g} < 1: stresses are extrapolations.",
        )
    if float(ratio) > _DEEPEST:
        yield Doubt(
            f"A transverse contact ratio of {float(ratio):.3g} is above the 2.5 that ISO 6336-2 covers.",
            brief=f"Contact ratio {float(ratio):.3g} is above the 2.5 of ISO 6336-2.",
        )
    if getattr(built.case.gears, "helix_angle", 0.0) > _HELIX:
        yield Doubt(
            "A helix angle above 30 degrees is beyond what ISO 6336-3 was confirmed for.",
            brief="Helix angle above the 30 degrees of ISO 6336-3.",
        )


def _bounds(built: Built, found: Numbers) -> Iterator[Doubt]:
    """What the tensile strength says of plastic roots whose endurance is not known."""
    rated = zip(built.solids, found["root_safety"], found["root_stress"], strict=True)
    for gear, (used, safety, stress) in enumerate(rated, 1):
        tensile = used.record.tensile_strength
        if used.plastic and tensile is not None and np.isnan(safety) and stress > 0.0:
            most = STRESS_CORRECTION * tensile.value
            yield Doubt(
                f"The root safety of gear {gear} is below {most / stress:.3g}: twice the tensile strength of "
                f"{used.record.name}, {most / 1e6:.4g} MPa, breaks it at once, and what it endures when "
                "it is warm and for many cycles is less.",
                brief=f"The root safety of gear {gear} is below {most / stress:.3g}.",
            )


def _doubts_of_method_b(found: Numbers, contact_ratio: float) -> Iterator[Doubt]:
    """Where K_v by method B lies outside what it covers."""
    ratio = float(found["resonance_ratio"])
    if _SUBCRITICAL < ratio < _SUPERCRITICAL:
        yield Doubt(
            f"The teeth mesh at {ratio:.3g} of the resonance of the pair: K_v by method B, "
            f"{float(found['rated_dynamic_factor']):.3g}, is uncertain from {_SUBCRITICAL:g} to "
            f"{_SUPERCRITICAL:g}, and such speeds are to be avoided.",
            brief=f"K_v is uncertain: teeth mesh at {ratio:.3g} of the resonance.",
        )
    if float(contact_ratio) < _LEAST_OF_METHOD_B:
        yield Doubt(
            f"K_v by method B holds from a transverse contact ratio of {_LEAST_OF_METHOD_B:g} on; that of "
            f"this pair is {float(contact_ratio):.3g}.",
            brief=f"K_v by method B at a transverse contact ratio of {float(contact_ratio):.3g}.",
        )


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("strength")
    if data is None:
        return {"strength": {}}
    return {"strength": {name: _nested(data[name].values) for name in _MAIN if name in data}}


def _nested(values: np.ndarray) -> Any:
    return [numbers(row) for row in values] if values.ndim > 1 else numbers(values)


STRENGTH = Analysis(
    name="strength",
    title="strength of the teeth",
    of="drive",
    lacks=_unrated,
    compute=_strength,
    main=_MAIN,
    figures=_figures,
)
