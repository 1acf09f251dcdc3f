"""A case file of gears from a ratio: teeth that assemble, a module that bears the torque if it is rated."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from math import ceil, isfinite, pi, radians, sin
from typing import Any

import numpy as np
import tomlkit
import xarray as xr

from pitchpoint import units
from pitchpoint._jax import double_precision
from pitchpoint.analyses.envelope import set_diameter
from pitchpoint.analyses.strength import ratings_of
from pitchpoint.cases.template import sample_tree, template
from pitchpoint.cases.trains import USUAL_BEARING
from pitchpoint.drive.assembly import clear_neighbours, fit_at_equal_angles
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.gears.gears_table import DISTANCE
from pitchpoint.gears.planetary import PLANETARY, PLANETS
from pitchpoint.input.kinds import LIFE, SPEED
from pitchpoint.input.quantities import Quantity
from pitchpoint.registry import letters
from pitchpoint.runs.run import load_case
from pitchpoint.sizing.three_k import three_k_sets, three_k_tables

__all__ = [
    "MODULES",
    "case_for_ratio",
    "in_planet_ring",
    "planetary_teeth",
    "stepped_gears",
    "stepped_teeth",
    "without_undercut",
]

Tree = dict[str, Any]
Making = Callable[[float], Tree]
"""Tables of a case with its gears for a module [mm]."""

THREE_K = "3K"
STRAIN_WAVE = "strain_wave"
FOR_RATIO = (STRAIN_WAVE, PLANETARY, THREE_K)

MODULES = (
    *(0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0),
    *(12.0, 16.0, 20.0, 25.0, 32.0),
)
"""Those of the first series of ISO 54, with finer ones of DIN 780 [mm]."""
SAFETIES = {"flank": 1.2, "root": 1.5}
MATERIAL = "case-hardened-mq"
WIDTH = {PLANETARY: 12.0, THREE_K: 10.0}
"""Face width [modules]."""

TEETH_OF_FLEXSPLINE = 60, 640
"""Flexsplines that usual proportions make, as catalogue drives have 60 to 320 teeth."""

SUNS, LARGEST_RING = range(12, 81), 240
LEAST_PLANET = 18
STRAIGHT = 1.1184
"""Depth of the straight flank of the usual rack below its datum, 1.25 - 0.2 (1 - sin 20 deg) [modules]."""
_NEAR = 0.005
"""Relative difference of ratios that counts as none against the size of a set."""
FEW_IN_RING, SHIFT_IN_RING = 30, 0.3
"""Teeth of planets below which they have a profile shift, and that: without one the tips of a ring meet few
teeth near their base circles, where pressures have no bound."""

MOST_TRIED = 40

SETS = Quantity("dimensionless", 1, 20, whole=True)
"""Sets that a file may have."""

ARRANGED = (
    ("sun", "carrier", "ring", lambda ratio: ratio - 1.0, lambda basic: 1.0 + basic),
    ("ring", "carrier", "sun", lambda ratio: 1.0 / (ratio - 1.0), lambda basic: 1.0 + 1.0 / basic),
    ("sun", "ring", "carrier", lambda ratio: -ratio, lambda basic: -basic),
)
"""Input, output and held body; teeth of ring over sun by the ratio, and the ratio by these."""


_LOBES = 2
"""Teeth by which the circular spline of a strain wave gear has more than its flexspline."""

_FLEXSPLINE = 60.0
"""Reference diameter of the flexspline of a common catalogue drive, the size 25 [mm]."""


def planetary_teeth(basic: float, planets: int) -> Iterator[tuple[int, int, int]]:
    """Teeth of sun, planet and ring that assemble, for a number of the ring over that of the sun.

    Args:
        basic: teeth of ring over teeth of sun.
        planets: at equal angles, whose tips are apart.

    Returns:
        All with suns of 12 to 80, planets from 18 and rings up to 240 teeth; nearest and smallest first.

    Example:
        >>> from itertools import islice
        >>> [*islice(planetary_teeth(4.0, 3), 2)]
        [(12, 18, 48), (18, 27, 72)]
    """

    def found() -> Iterator[tuple[int, int, int]]:
        for sun in SUNS:
            for ring in range(round(basic * sun) - 3, round(basic * sun) + 4):
                planet = (ring - sun) // 2
                clear = bool(clear_neighbours([(planet, sun)], planets))
                whole = (sun + ring) % planets == 0
                if whole and planet >= LEAST_PLANET and ring <= LARGEST_RING and clear:
                    yield sun, planet, ring

    def order(teeth: tuple[int, int, int]) -> tuple[int, int, int]:
        sun, _, ring = teeth
        return round(abs(ring / sun / basic - 1.0) / _NEAR), (ring - sun) % 2, ring

    return iter(sorted(found(), key=order))


@double_precision()
def case_for_ratio(
    family: str,
    ratio: float,
    *,
    torque: str | None = None,
    planets: int | None = None,
    count: int = 1,
    speed: str | None = None,
    life: str | None = None,
    diameter: str | None = None,
) -> str:
    """A case file of a set of this ratio, with a module that bears the torque.

    Args:
        family: "strain_wave", "planetary" or "3K".
        ratio: speed of the input over that of the output; of a 3K set and of a strain wave gear its size,
            which is met within 3 %, and to half a turn.
        torque: at the output, with its unit; the module is 1 mm and stays unsized without one. Not for strain
            wave gears, whose teeth no standard rates.
        planets: at equal angles, 3 unless given; of sets that have some.
        count: of sets at most, the nearest to the ratio and the smallest first, of 3K the one that loses
            least in its worse direction; of several each is a variant of the file, `set_1` on.
        speed: of the output, with its unit; the input runs at 3000 rpm without one.
        life: time under load, with its unit; the teeth are to endure without one.
        diameter: largest one around the gears, with its unit, as `size` counts it; of the sets that bear the
            torque those within it count.

    Raises:
        InputError: another family, no such teeth, more torque than gears of 32 mm module bear, or than gears
            within the diameter do.

    The module is the smallest with which the least safeties by ISO 6336 are at least `SAFETIES`, of gears of
    `MATERIAL` whose face width is `WIDTH`. A strain wave gear has the diameter of
    the size 25 of catalogues at every ratio.
    """
    named = next((one for one in FOR_RATIO if letters(one) == letters(family)), None)
    if named is None:
        template(family)  # says what a family is, where this is none
        told = f"{', '.join(FOR_RATIO[:-1])} and {FOR_RATIO[-1]}"
        raise InputError(f"is for {told}; leave it out for {family}", key="ratio")
    if not isfinite(ratio):
        raise InputError(f"{ratio} is no ratio, input over output", key="ratio")
    if named == STRAIN_WAVE:
        return _strain_wave(
            ratio,
            {"torque": torque, "planets": planets, "count": count if count != 1 else None}
            | {"speed": speed, "life": life, "diameter": diameter},
        )
    _check("count", lambda: SETS.read(count))
    planets = 3 if planets is None else planets
    _check("planets", lambda: PLANETS.read(planets))
    if torque is not None and _check("torque", lambda: units.parse(torque, "torque")) <= 0.0:
        raise InputError(f"{torque} was given; it is more than zero", key="torque")
    asked = {"speed": speed, "life": life, "diameter": diameter}
    if torque is None and (unsized := [key for key, text in asked.items() if text is not None]):
        raise InputError("goes with --torque, for which the gears are sized", key=unsized[0])
    limits = {
        key: _check(key, partial(read.read, asked[key]))
        for key, read in {"speed": SPEED, "life": LIFE, "diameter": DISTANCE}.items()
        if asked[key] is not None
    }
    tried = count if diameter is None else max(count, SETS_IN_DIAMETER)
    found = [
        *islice((_planetary if named == PLANETARY else _three_k)(ratio, planets, tried), tried)
    ]
    sized = [_with_rest(named, make, torque, _of_task(met, life, limits)) for make, met in found]
    if "diameter" in limits:
        fitting = _within(
            limits["diameter"],
            [set_diameter(load_case(sample_tree(named, tree))) for tree, _ in sized],
        )
        found, sized = ([found[k] for k in fitting[:count]], [sized[k] for k in fitting[:count]])
    each = [
        f"{_met(met, ratio)}. {borne}" for (_, met), (_, borne) in zip(found, sized, strict=True)
    ]
    if len(found) > 1:
        each = [f"set_{number}: {told}" for number, told in enumerate(each, 1)]
    told = _FACTORS if torque else "The module is not sized: --torque is what the output bears."
    text = template(named, sized[0][0], [*each, told])
    return text + _variants(named, [tree for tree, _ in sized]) if len(found) > 1 else text


_FIRST = {
    PLANETARY: "the nearest to the ratio and the smallest first",
    THREE_K: "the one that loses least in its worse direction first",
}
"""By what sets for a ratio are in order."""

_FACTORS = "Load factors but K_v and that of planets are 1: give those of your drive in [strength]."


SETS_IN_DIAMETER = 6
"""Sets for a ratio that are sized where a diameter is asked."""


def _of_task(met: float, life: str | None, limits: Mapping[str, float]) -> Tree:
    """Tables that say speed and life, for a set of a ratio."""
    tables: Tree = {} if life is None else {"strength": {"life": life}}
    if "speed" in limits:
        turns = limits["speed"] * abs(met) * 30.0 / pi
        tables["operation"] = {"speed": f"{turns:.6g} rpm"}
    return tables


def _within(most: float, diameters: Sequence[float]) -> list[int]:
    """Numbers of the sets that are no larger than a diameter [m], in their order."""
    fitting = [number for number, across in enumerate(diameters) if across <= most]
    if not fitting:
        raise InputError(
            f"{1e3 * most:.4g} mm is too small: of the sets for this torque the smallest is "
            f"{1e3 * min(diameters):.4g} mm around the gears; give more, or have pitchpoint size try other "
            "face widths",
            key="diameter",
        )
    return fitting


def _with_rest(named: str, make: Making, torque: str | None, of_task: Tree) -> tuple[Tree, str]:
    """Tables of a set, with the module that bears the torque if there is one, and a sentence on that."""

    def with_rest(module: float) -> Tree:
        if not torque:
            return make(module)
        loads = {"operation": {"torque": torque, **of_task.get("operation", {})}}
        return (
            make(module) | {"materials": {"gear_1": MATERIAL, "gear_2": MATERIAL}} | of_task | loads
        )

    gears = with_rest(1.0)["gears"]
    teeth = "/".join(map(str, [*gears["teeth"], *gears.get("second", {}).get("teeth", [])]))
    if torque is None:
        return with_rest(1.0), f"Teeth {teeth}."
    module, safeties = _sized(named, with_rest)
    borne = ", ".join(f"{part}s {value:.3g}" for part, value in safeties.items())
    asked = " and ".join(f"{least:g} ({part}s)" for part, least in SAFETIES.items())
    return with_rest(module), (
        f"Teeth {teeth}. Module {module:g} mm for {torque}: least safeties by ISO 6336 {borne}; "
        f"asked were {asked}."
    )


def _variants(family: str, sets: Sequence[Tree]) -> str:
    """Tables of variants with the gears of each set, and its losses as remarks, as [losses] are."""
    order = f"# Sets for this ratio, {_FIRST[family]}; each is computed."
    lines = ["", order, "[variants.set_1]"]
    for number, tree in enumerate(sets[1:], 2):
        lines += ["", *_of_variant(number, {"gears": tree["gears"]})]
        if "losses" in tree:
            losses = _of_variant(number, {"losses": tree["losses"]})
            lines += ["", *(f"# {line}" for line in losses)]
    return "\n".join(lines) + "\n"


def _of_variant(number: int, tables: Tree) -> list[str]:
    """Lines of what a set has beside those of the first one."""
    return tomlkit.dumps({"variants": {f"set_{number}": tables}}).strip().splitlines()


_IN_THE_FILE = {"torque": "operation.torque", "speed": "operation.speed"}
"""Keys of a case that say of a strain wave gear what options say of sets."""


def _strain_wave(ratio: float, others: Mapping[str, Any]) -> str:
    """A case file of a strain wave gear whose circular spline is held.

    Args:
        ratio: of the wave generator over the flexspline, of any sign: it turns against it.
        others: options that are for sets of planets.
    """
    for key, value in others.items():
        if value is not None:
            raise InputError(
                f"is for {' and '.join(FOR_RATIO[1:])}; a strain wave gear has no rating of its teeth, "
                f"give {_IN_THE_FILE[key]} in the file"
                if key in _IN_THE_FILE
                else f"is for {' and '.join(FOR_RATIO[1:])}; a strain wave gear has none",
                key=key,
            )
    flexspline = round(_LOBES * abs(ratio))
    if not TEETH_OF_FLEXSPLINE[0] <= flexspline <= TEETH_OF_FLEXSPLINE[1]:
        low, high = (teeth / _LOBES for teeth in TEETH_OF_FLEXSPLINE)
        raise InputError(
            f"{ratio:g} was given; a strain wave gear of two lobes has {low:g} to {high:g}",
            key="ratio",
        )
    module = _FLEXSPLINE / flexspline
    gears = {"teeth": [flexspline, flexspline + _LOBES], "module": f"{module:.4g} mm"}
    remark = (
        f"The size is that of a common drive of {_FLEXSPLINE:g} mm, for 67 N m; it is not sized."
    )
    return template(
        STRAIN_WAVE, {"gears": gears}, [f"{_met(-flexspline / _LOBES, ratio)}. {remark}"]
    )


def _met(met: float, ratio: float) -> str:
    """The ratio of a set in words; that of another sense than was asked says so."""
    against = ": its output turns against the input" if met * ratio < 0.0 else ""
    return f"Ratio {met:.6g}{against}"


def _check(key: str, read: Callable[[], float]) -> float:
    """What is read, or its error with the key."""
    try:
        return read()
    except InputError as error:
        raise error.at(key=key) from None


def _planetary(ratio: float, planets: int, count: int) -> Iterator[tuple[Making, float]]:
    """Tables of sets that can be made, each with its ratio, the nearest one first."""
    arranged = next((one for one, low, high in _reach(planets) if low <= ratio <= high), None)
    if 0.0 < abs(ratio) < 1.0:
        raise InputError(
            f"{ratio:g} is a step up; ask for {1.0 / ratio:.5g}, and exchange input and output in the file",
            key="ratio",
        )
    reach = [*_reach(planets)]
    if not reach:
        raise InputError(f"{planets} planets have no room on a carrier; take fewer", key="ratio")
    if arranged is not None:
        every = _simple_sets(arranged, ratio, planets)
    elif ratio > max(high for _, _, high in reach):
        every = _stepped_sets(ratio, planets)
    else:
        told = "; ".join(
            f"{one[0]} to {one[1]} {low:.3g} to {high:.3g}" for one, low, high in reach
        )
        raise InputError(
            f"{ratio:g} is no ratio of one planetary set with {planets} planets, which reaches, from "
            f"{told}, and from sun to carrier more with stepped planets",
            key="ratio",
        )
    made = 0
    for gears, bearing, met in islice(every, MOST_TRIED):

        def make(module: float, gears: Tree = gears, bearing: float = bearing) -> Tree:
            width = f"{WIDTH[PLANETARY] * module:g} mm"
            table = gears | {"module": f"{module:g} mm", "face_width": width}
            if "second" in gears:
                table["second"] = gears["second"] | {"face_width": width}
            return {
                "gears": table,
                "losses": {"pin": {"mean_diameter": f"{bearing * module:.3g} mm"}},
            }

        if _can_be_made(PLANETARY, make):
            made += 1
            yield make, met
    if not made:
        raise InputError(
            f"no teeth for a ratio of {ratio:g} with {planets} planets can be made; two sets in a row "
            "(pitchpoint docs stages) or a 3K (new 3K) have it",
            key="ratio",
        )


Set = tuple[Tree, float, float]
"""Table of gears without lengths, mean diameter of the bearing of a planet [modules], ratio."""


def _simple_sets(arranged: tuple[Any, ...], ratio: float, planets: int) -> Iterator[Set]:
    """Sets of planets of one gear, the nearest and smallest one first."""
    turned, loaded, held, basic, back = arranged
    ends = {} if held == "ring" else {"input": turned, "output": loaded, "held": held}
    for sun, planet, ring in planetary_teeth(basic(ratio), planets):
        # Of no shift as well: a variant takes what it leaves out from the first set.
        shifts = [without_undercut(sun), in_planet_ring(planet)]
        gears: Tree = {
            "teeth": [sun, planet, ring],
            "planets": planets,
            "profile_shift": shifts,
            **ends,
        }
        yield gears, USUAL_BEARING * planet, back(ring / sun)


def _stepped_sets(ratio: float, planets: int) -> Iterator[Set]:
    """Sets of stepped planets from sun to carrier, the nearest and smallest one first."""
    for gears, met in stepped_gears(ratio, planets):
        yield gears, USUAL_BEARING * gears["second"]["teeth"][0], met


def stepped_gears(ratio: float, planets: int) -> Iterator[tuple[Tree, float]]:
    """Tables of sets of stepped planets without lengths, each with its ratio; see `stepped_teeth`.

    Args:
        ratio: of the sun over the carrier, the ring is held.
        planets: at equal angles, whose tips are apart.

    Example:
        >>> from pitchpoint.sizing.for_ratio import stepped_gears
        >>> gears, met = next(stepped_gears(20.0, 3))
        >>> gears["teeth"], gears["second"]["teeth"], round(met, 3)
        ([13, 53], [18, 84], 20.026)
    """
    for sun, first, second, ring in stepped_teeth(ratio, planets):
        shift = without_undercut(sun)
        gears: Tree = {
            "teeth": [sun, first],
            "planets": planets,
            "profile_shift": [shift, 0.0 - shift],  # which leaves the centre distance as it is
            "second": {
                "teeth": [second, ring],
                "profile_shift": [in_planet_ring(second), FROM_CENTRE_DISTANCE],
            },
        }
        yield gears, 1.0 + first * ring / (sun * second)


def stepped_teeth(ratio: float, planets: int) -> Iterator[tuple[int, int, int, int]]:
    """Teeth of sun, both gears of the planets and ring that assemble, for a ratio of sun to carrier.

    Args:
        ratio: of the sun over the carrier, the ring is held.
        planets: at equal angles, whose tips are apart.

    Returns:
        All of one module with suns of 12 to 40, gears of planets from 18 and rings up to 240 teeth; nearest
        and smallest first.

    Example:
        >>> next(stepped_teeth(20.0, 3))
        (13, 53, 18, 84)
    """
    sun, first, second = np.ix_(range(12, 41), range(LEAST_PLANET, 121), range(LEAST_PLANET, 81))
    ring = sun + first + second
    met = 1.0 + first * ring / (sun * second)
    fits = (first > second) & (ring <= LARGEST_RING) & (np.abs(met / ratio - 1.0) < 0.03)
    fits &= fit_at_equal_angles([(first, sun), (second, -ring)], planets)
    fits &= clear_neighbours([(first, sun)], planets)
    found = [(sun.flat[i], first.flat[j], second.flat[k]) for i, j, k in np.argwhere(fits).tolist()]
    every = [(int(s), int(p), int(q), int(s + p + q)) for s, p, q in found]

    def order(teeth: tuple[int, int, int, int]) -> tuple[int, int]:
        s, p, q, r = teeth
        return round(abs((1.0 + p * r / (s * q)) / ratio - 1.0) / _NEAR), r + p

    return iter(sorted(every, key=order))


def without_undercut(teeth: float) -> float:
    """Least profile shift of two digits, not negative, with which a rack of 20 degrees does not undercut."""
    return max(ceil(100.0 * (STRAIGHT - 0.5 * teeth * sin(radians(20.0)) ** 2)) / 100.0, 0.0)


def in_planet_ring(teeth: int) -> float:
    """Profile shift of a planet that a ring meets well above its base circle."""
    return max(without_undercut(teeth), SHIFT_IN_RING * (teeth < FEW_IN_RING))


def _reach(planets: int) -> Iterator[tuple[tuple[Any, ...], float, float]]:
    """Arrangements of a set with the least and the largest ratio that they have teeth for."""
    most = sin(pi / planets) if planets > 2 else 1.0
    basics = 1.6, min(1.0 + 2.0 * most / (1.0 - most) if most < 1.0 else 12.0, 12.0)
    for one in ARRANGED if basics[0] < basics[1] else ():
        low, high = sorted(one[4](basic) for basic in basics)
        yield one, low, high


def _can_be_made(family: str, make: Making) -> bool:
    try:
        load_case(sample_tree(family, make(1.0)))
    except InputError:
        return False
    return True


def _three_k(ratio: float, planets: int, count: int) -> Iterator[tuple[Making, float]]:
    """Tables of the sets that lose least in their worse direction, each with its ratio."""
    if ratio <= 1.0:
        raise InputError(
            f"{ratio:g} was given; of a 3K set it is the size, from some 20 on", key="ratio"
        )
    try:
        sets = three_k_sets((0.97 * ratio, 1.03 * ratio), planets=planets, count=count)
    except InputError as error:
        raise InputError(
            f"{error.message}: pitchpoint.three_k_sets takes other limits", key=error.key or "ratio"
        ) from None
    for number in range(sets.sizes["set"]):
        chosen = sets.isel(set=number)

        def make(module: float, chosen: xr.Dataset = chosen) -> Tree:
            return three_k_tables(chosen, f"{module:g} mm", f"{WIDTH[THREE_K] * module:g} mm")

        yield make, float(chosen["ratio"])


def _sized(family: str, make: Making) -> tuple[float, dict[str, float]]:
    """The smallest module of the series that bears the load, with its least safeties."""

    def safeties(module: float) -> dict[str, float]:
        rated = ratings_of([load_case(sample_tree(family, make(module)))], 1)
        return {part: float(rated[f"least_{part}_safety"][1][0, 0]) for part in SAFETIES}

    # With the face width in modules stresses of roots go with the cube, of flanks with the power of 1.5.
    first = safeties(1.0)
    flank, root = (SAFETIES[part] / first[part] for part in SAFETIES)
    near = 0.9 * max(flank ** (2.0 / 3.0), root ** (1.0 / 3.0))
    for module in (one for one in MODULES if one >= near):
        reached = safeties(module)
        if all(reached[part] >= least for part, least in SAFETIES.items()):
            return module, reached
    raise InputError(
        f"gears of {MODULES[-1]:g} mm module do not bear it; give less, or a file of your own",
        key="torque",
    )
