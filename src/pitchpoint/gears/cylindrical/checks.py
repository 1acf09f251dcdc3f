"""Checks of a design in gear words: what cannot run is an error, what should not a warning."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from math import nan
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.doubts import LEFT_OUT, REMARKED, Doubt
from pitchpoint.core.programs import program
from pitchpoint.core.roots import find_root
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.contact_lines import LARGEST_CONTACT_RATIO
from pitchpoint.gears.design_groups import Faults, Number, over_designs, padded
from pitchpoint.gears.involute import InvoluteGear, inverse_involute, involute

if TYPE_CHECKING:
    from pitchpoint.gears.cylindrical.pair import CylindricalPair

__all__ = [
    "Remedy",
    "UnsoundPairError",
    "cannot_run",
    "check_cylindrical",
    "check_cylindrical_pairs",
    "runs_well",
]

_THIN_TIP = 0.2  # modules
_SMALL_CLEARANCE = 0.1  # modules
# Usual practice asks for 1.1 to 1.2: deviations and deflections take a part of it.
_FAIR_RATIO = 1.1
_GIVEN = ("module", "profile_shift", "addendum", "dedendum", "fillet_radius")
# Profile shifts and distances are printed with three decimals: a smaller overlap is no fault [modules].
_ROUNDED_DISTANCE = 1e-3
# Below this nobody is told of it [modules].
_TOLD_DISTANCE = 1e-4
# Points on the path of a tip corner: its curvature between two of them is of no account.
_SAMPLES = 400
# A tip that enters a fillet no deeper is told of and runs [modules].
_DEEPEST_IN_FILLET = 5e-3
# The usual fillet radius 0.38 is rounded up from 0.25/(1 - sin 20 deg): that is no overlap [modules].
_TOLD_IN_FILLET = 1e-4


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Gear:
    """Numbers of one gear, plain or traced: positive diameters and lengths [m], those of the rack in modules.

    A shaped one is a ring with a pinion cutter.

    Lengths on the line of action are counted from the gear's own base circle.
    """

    number: int
    undercut: bool
    internal: bool
    helical: bool
    shaped: bool
    tip_diameter: Number
    root_diameter: Number
    base_diameter: Number
    form_diameter: Number
    pointed_diameter: Number
    tip_thickness: Number
    profile_shift: Number
    undercut_limit: Number
    addendum: Number
    dedendum: Number
    fillet_radius: Number
    deepest_dedendum: Number
    largest_fillet_radius: Number
    clearance: Number
    form_length: Number
    mate_reach: Number
    missing: Number
    fillet_overlap: Number

    @property
    def modules(self) -> str:
        return _unit(self.helical)

    @property
    def name(self) -> str:
        return f"gear {self.number}"

    @property
    def mate(self) -> str:
        return f"gear {3 - self.number}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Pair:
    """Numbers of the pair, plain or traced: lengths [m]; the zero-backlash distance is NaN if none exists.

    The base sum is that of signed radii, without its sign; the needed sum of profile shifts that of the
    centre distance; the gaps are those of a ring [modules]; the least backlash is that by allowances of the
    tooth thickness, NaN without any; teeth that are thinned for a backlash have it at every
    distance. The cutter of a ring reaches from the end of its involute to the tip of the ring, along the line
    of action; its gaps are those between its tips and the ring's [modules].
    """

    internal: bool
    helical: bool
    module: Number
    base_pitch: Number
    centre_distance: Number
    zero_backlash: Number
    thinned: Number
    base_sum: Number
    shift_sum: Number
    limit_shift_sum: Number
    transverse_ratio: Number
    contact_ratio: Number
    pinion_teeth: Number
    wheel_teeth: Number
    needed_shift_sum: Number
    tip_gap: Number = 0.0
    radial_gap: Number = 0.0
    least_backlash: Number = nan
    cutter_teeth: Number = 0.0
    cutter_shift_sum: Number = 0.0
    cutter_limit_sum: Number = 1.0
    cutter_reach: Number = 0.0
    cutter_tip_gap: Number = 0.0
    cutter_radial_gap: Number = 0.0

    @property
    def modules(self) -> str:
        return _unit(self.helical)


def _unit(helical: bool) -> str:
    return "normal modules" if helical else "modules"


class Remedy(NamedTuple):
    """What to change of a pair that cannot run.

    Attributes:
        key: of the gears table.
        sense: 1.0 for larger values, -1.0 for smaller ones, 0.0 for the one that follows from the rest.
        members: numbers of the gears whose value it is, from 0; none of what both have in common.
    """

    key: str
    sense: float
    members: tuple[int, ...] = ()


class UnsoundPairError(InputError):
    """Gears that cannot run, with what may mend them.

    Attributes:
        remedies: the better one first; how large a change is needed is left open.
    """

    remedies: tuple[Remedy, ...] = ()


def check_cylindrical(pair: CylindricalPair, *, least_backlash: float = nan) -> list[str]:
    """Warnings for a design that runs but should not be made so; an error for one that cannot run.

    Args:
        pair: two external gears, or a pinion and a ring; spur or helical.
        least_backlash: by allowances of the tooth thickness, along the normal [m]; where they leave some, the
            nominal flanks may overlap.

    Returns:
        One sentence for each warning: undercut, a tip thinner than 0.2 modules, a tip clearance
        below 0.1 modules, a tip that enters a fillet by up to 0.005 modules, a transverse contact ratio
        below 1, flanks that overlap by what is rounded or by less than their allowances, a pinion that does
        not go into its ring radially in every position. Empty for a sound pair.

    Raises:
        UnsoundPairError: the flanks overlap or never meet, a tip is pointed, a tip runs into the mate's
            root, fillet or (in a ring) tip, tool or fillet are impossible, or the contact ratio is
            not from 1 to 24. Its key is the entry of the gears table to change. What is wrong with
            each gear by itself is told of both.

    Validity: backlash is not limited.

    Source: geometry of ISO 21771:2007; tool tip of ISO 53:1998.
    """
    pair_measures, gears = _measure(pair)
    return _told(dataclasses.replace(pair_measures, least_backlash=least_backlash), gears)


def runs_well(pair: CylindricalPair, *, least_backlash: float = nan) -> bool:
    """True for a pair that runs with a contact ratio above 1.1, its tips clear of roots and fillets.

    Args:
        pair, least_backlash: see `check_cylindrical`.
    """
    pair_measures, gears = _measure(pair)
    try:
        _told(dataclasses.replace(pair_measures, least_backlash=least_backlash), gears)
    except InputError:  # of one gear, or of each of both
        return False
    clear = all(
        gear.fillet_overlap <= _TOLD_IN_FILLET and not _small_clearance(gear) for gear in gears
    )
    return clear and bool(pair_measures.contact_ratio >= _FAIR_RATIO)


def check_cylindrical_pairs(
    group: CylindricalPair, least_backlash: Sequence[float]
) -> list[list[str] | InputError]:
    """The same for each of some pairs, with the error in the place of warnings.

    Args:
        group: with an axis of designs in front, of one static structure.
        least_backlash: of each design, see `check_cylindrical`.
    """
    alike = over_designs(_plain, group, 1)
    count = len(group.module)
    numbers = jax.device_get(_measures_of_many(padded(alike, count)))
    columns = [{key: values.tolist() for key, values in part.items()} for part in numbers]
    return [
        _told_or_error(
            group, [{key: values[row] for key, values in part.items()} for part in columns], least
        )
        for row, least in enumerate(least_backlash)
    ]


def _told_or_error(
    pair: CylindricalPair, numbers: Sequence[Mapping[str, Number]], least: float
) -> list[str] | InputError:
    pair_measures, gears = _records(pair, numbers)
    try:
        return _told(dataclasses.replace(pair_measures, least_backlash=least), gears)
    except InputError as error:
        return error


def _told(whole: _Pair, gears: list[_Gear]) -> list[str]:
    for beside in _in_turn(whole, gears):
        wrong = Complaints()
        for faults in beside:
            wrong.tried(_refuse_first, faults)
        wrong.demand_none()
    warnings: list[str] = [text for gear in gears for text in _warnings(whole, gear)]
    return warnings + _pair_warnings(whole)


def cannot_run(pair: CylindricalPair) -> Bool[Array, ""]:
    """True for a pair that `check_cylindrical` refuses; can be traced and vectorised.

    Args:
        pair: with the dimensions that follow.
    """
    every = chain.from_iterable(chain.from_iterable(_in_turn(*_named(pair))))
    return jnp.any(jnp.stack([jnp.asarray(fails) for fails, _ in every]))


def _in_turn(whole: _Pair, gears: list[_Gear]) -> Iterator[list[Faults]]:
    """Whether a design has each fault, and what refuses one that has it.

    What has nothing to do with each other stands beside each other; all that comes later rests on it.
    """
    yield [_check_finite(whole, gears, only=_GIVEN)]
    yield [chain(_check_teeth(whole), _check_distance(whole))]
    yield [_check_gear(gear) for gear in gears]
    yield [chain.from_iterable(_check_meeting(whole, gear) for gear in gears)]
    yield [chain(_check_contact_ratio(whole, gears), _check_tips(whole), _check_cutter(whole))]
    yield [_check_finite(whole, gears)]  # whatever the checks above did not think of


def _check_gear(gear: _Gear) -> Faults:
    yield from (_check_ring_root(gear) if gear.internal else _check_tool(gear))
    yield from _check_circles(gear)


def _refuse_first(faults: Faults) -> None:
    """InputError for the first fault that a design has."""
    for fails, refuse in faults:
        if fails:
            refuse()


def _measure(pair: CylindricalPair) -> tuple[_Pair, list[_Gear]]:
    numbers = jax.device_get(_measures(_plain(pair)))
    return _records(pair, [{key: float(x) for key, x in part.items()} for part in numbers])


def _plain(pair: CylindricalPair) -> CylindricalPair:
    """Without what is of no account here: few programs."""
    return dataclasses.replace(pair, lanes=2, slices=1)


def _named(pair: CylindricalPair) -> tuple[_Pair, list[_Gear]]:
    """Measures in a trace."""
    return _records(pair, _measures(pair))


def _records(
    pair: CylindricalPair, numbers: Sequence[Mapping[str, Number]]
) -> tuple[_Pair, list[_Gear]]:
    of_pair, *gears = numbers
    return _Pair(internal=pair.internal, helical=pair.helical, **of_pair), [
        _Gear(
            number=i + 1,
            undercut=pair.undercut[i],
            internal=pair.internal and i == 1,
            helical=pair.helical,
            shaped=pair.internal and i == 1 and pair.cutter_teeth is not None,
            **gear,
        )
        for i, gear in enumerate(gears)
    ]


@program
def _measures(pair: CylindricalPair) -> list[dict[str, Float[Array, ""]]]:
    """Measures of the pair and of each gear, under the names of their plain classes."""
    pinion, wheel = pair.gears
    return [
        _pair_measures(pair)
        | (_ring_gaps(pair) if pair.internal else {})
        | _cutter_measures(pair, wheel),
        _gear_measures(pinion) | _meeting_measures(pair, pinion, wheel),
        _gear_measures(wheel) | _meeting_measures(pair, wheel, pinion),
    ]


@program
def _measures_of_many(group: CylindricalPair) -> list[dict[str, Float[Array, " design"]]]:
    return over_designs(_measures, group, 1)


def _pair_measures(pair: CylindricalPair) -> dict[str, Float[Array, ""]]:
    transverse = involute(pair.transverse_pressure_angle)
    per_angle = jnp.sum(pair.teeth) / (2.0 * jnp.tan(pair.pressure_angle))
    return {
        "module": pair.module,
        "base_pitch": pair.base_pitch,
        "centre_distance": pair.centre_distance,
        "zero_backlash": pair.zero_backlash_centre_distance,
        "thinned": jnp.any(pair.infeed != 0.0).astype(float),
        "base_sum": jnp.abs(jnp.sum(pair.base_radii)),
        "shift_sum": jnp.sum(pair.profile_shift),
        "limit_shift_sum": -transverse * per_angle,
        "needed_shift_sum": (involute(pair.working_pressure_angle) - transverse) * per_angle,
        "transverse_ratio": pair.transverse_contact_ratio,
        "contact_ratio": pair.contact_ratio,
        "pinion_teeth": pair.teeth[0],
        "wheel_teeth": jnp.abs(pair.teeth[1]),
    }


def _gear_measures(gear: InvoluteGear) -> dict[str, Float[Array, ""]]:
    deepest, largest = _room_at_ring_root(gear) if gear.internal else _room_at_tool_tip(gear)
    return {
        "tip_diameter": 2.0 * gear.side * gear.tip_radius,
        "root_diameter": 2.0 * gear.side * gear.root_radius,
        "base_diameter": 2.0 * gear.side * gear.base_radius,
        "form_diameter": 2.0 * jnp.hypot(gear.base_radius, gear.form_roll_length),
        "pointed_diameter": 2.0 * _pointed_radius(gear),
        "tip_thickness": gear.tip_thickness / gear.module,
        "profile_shift": gear.profile_shift,
        "undercut_limit": gear.undercut_limit,
        "addendum": gear.addendum,
        "dedendum": gear.dedendum,
        "fillet_radius": gear.fillet_radius,
        "deepest_dedendum": deepest,
        "largest_fillet_radius": largest,
        "form_length": gear.form_roll_length,
    }


def _room_at_tool_tip(gear: InvoluteGear) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Dedendum at which the rack's flanks cross, and radius that rounds its whole tip [modules]."""
    angle = gear.pressure_angle
    land = jnp.pi / 4.0 - gear.dedendum * jnp.tan(angle)
    return jnp.pi / 4.0 / jnp.tan(angle), land * jnp.cos(angle) / (1.0 - jnp.sin(angle))


def _room_at_ring_root(gear: InvoluteGear) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Dedendum at which the flanks of a ring's space cross, and radius that rounds its whole root.

    Both in modules. The flanks cross where the tooth fills the pitch.
    """
    base = jnp.abs(gear.base_radius)
    value = gear.pitch_half_angle - gear.half_thickness_angle(base)
    reference = jnp.abs(gear.reference_radius)
    crossing = base / jnp.cos(inverse_involute(jnp.where(value > 0.0, value, 1.0)))
    deepest = (crossing - reference) / gear.module + gear.profile_shift

    cutting = gear.cutting

    def filled(rounding: Float[Array, ""]) -> Float[Array, ""]:
        rounded = (
            dataclasses.replace(gear, fillet_radius=rounding)
            if cutting is None
            else dataclasses.replace(cutting, rounding=rounding * gear.module)
        )
        return -rounded.root_land_angle / gear.pitch_half_angle

    most = (jnp.abs(gear.root_radius) - base) / gear.module
    if cutting is not None:
        most = (cutting.tip_radius - cutting.base_radius) / gear.module
    largest = find_root(filled, jnp.minimum(0.1, most / 2.0), most)[0]
    return deepest, largest


def _meeting_measures(
    pair: CylindricalPair, gear: InvoluteGear, mate: InvoluteGear
) -> dict[str, Float[Array, ""]]:
    """Tip clearance, and where on the line of action the mate's tip circle ends the contact."""
    distance = -pair.centre_distance if pair.internal else pair.centre_distance
    clearance = distance - gear.tip_radius - mate.root_radius
    reach = gear.side * (pair.tangent_length - mate.side * mate.tip_roll_length)
    return {
        "clearance": clearance / pair.module,
        "mate_reach": reach,
        "missing": gear.side * (gear.form_roll_length - reach),
        "fillet_overlap": _fillet_overlap(pair, gear, mate, reach) / pair.module,
    }


def _fillet_overlap(
    pair: CylindricalPair, gear: InvoluteGear, mate: InvoluteGear, reach: Float[Array, ""]
) -> Float[Array, ""]:
    """Depth to which the mate's tip corner enters the fillet of a gear [m]; none if it stays out.

    Positions are complex numbers: the gear's centre is the origin, the line of centres the real axis.
    """
    direction = jnp.exp(-1j * pair.working_pressure_angle)
    centre = mate.side * pair.centre_distance
    base = jnp.abs(gear.base_radius)
    start = (base + 1j * reach) * direction - centre
    mate_angle = jnp.linspace(0.0, 2.0, _SAMPLES) * jnp.angle(start / (-mate.side * gear.side))
    corner = centre + start * jnp.exp(-1j * mate_angle)
    turned = mate_angle * mate.side * jnp.abs(mate.teeth) / gear.teeth
    # Where the involute through the corner would begin on the base circle.
    origin = turned + reach / base - pair.working_pressure_angle
    radius = jnp.abs(corner)
    fillet, half = gear._fillet(jnp.linspace(0.0, 1.0, _SAMPLES))
    inside = jnp.interp(gear.side * radius, gear.side * fillet, half) - (
        gear.half_thickness_angle(base) + gear.side * jnp.angle(corner * jnp.exp(-1j * origin))
    )
    return jnp.max(jnp.where(gear.side * (fillet[-1] - radius) > 0.0, inside * radius, 0.0))


def _ring_gaps(pair: CylindricalPair) -> dict[str, Float[Array, ""]]:
    """Gaps between the corners of both tips where their circles cross, and on the way out radially."""
    pinion, ring = (jnp.abs(radius) for radius in pair.tip_radii)
    distance, scale = pair.centre_distance, ring / pair.module
    difference = ring**2 - pinion**2
    at_pinion = _arccos((difference - distance**2) / (2.0 * pinion * distance))
    at_ring = _arccos((difference + distance**2) / (2.0 * ring * distance))
    return {
        "tip_gap": scale * (_ring_corner(pair, at_pinion) - at_ring),
        "radial_gap": _radial_gap(pair) / pair.module,
    }


def _cutter_measures(pair: CylindricalPair, ring: InvoluteGear) -> dict[str, Float[Array, ""]]:
    """What a ring and its cutter have to do with each other; nothing without one."""
    cutting = ring.cutting
    if cutting is None or pair.cutter_teeth is None or pair.cutter_shift is None:
        return {}
    teeth, shift = jnp.asarray(pair.cutter_teeth), jnp.asarray(pair.cutter_shift)
    per_angle = (jnp.abs(ring.teeth) - teeth) / (2.0 * jnp.tan(ring.pressure_angle))
    reference = teeth / jnp.abs(ring.teeth) * jnp.abs(ring.reference_radius)
    high = (cutting.tip_radius - reference) / ring.module - shift
    beyond = cutting.distance * jnp.sin(cutting.working_pressure_angle)
    in_place = dataclasses.replace(
        pair,
        teeth=jnp.stack([teeth, ring.teeth]),
        profile_shift=jnp.stack([shift, ring.profile_shift]),
        addendum=jnp.stack([high, ring.addendum]),
        tip_alteration=jnp.stack([jnp.zeros(()), ring.tip_alteration]),
        infeed=jnp.zeros(2),
        centre_distance=cutting.distance,
    )
    gaps = _ring_gaps(in_place)
    return {
        "cutter_teeth": teeth,
        "cutter_shift_sum": ring.profile_shift + shift,
        "cutter_limit_sum": involute(ring.transverse_pressure_angle) * per_angle,
        "cutter_reach": (ring.tip_roll_length - beyond) / ring.module,
        **{f"cutter_{name}": gap for name, gap in gaps.items()},
    }


def _ring_corner(pair: CylindricalPair, pinion_corner: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Angle of a ring's tip corner for the angle of the pinion's tip corner, flanks touching [rad].

    Both are counted from the line of centres, about their own gear.
    """
    pinion, ring = involute(_arccos(jnp.abs(pair.base_radii / pair.tip_radii)))
    working = involute(pair.working_pressure_angle)
    turned = pinion_corner + pinion - working
    return jnp.asarray(turned * pair.teeth[0] / jnp.abs(pair.teeth[1]) + working - ring)


def _radial_gap(pair: CylindricalPair) -> Float[Array, ""]:
    """Least distance by which a pinion's tip corner, moved out radially, passes that of the ring [m]."""
    corner = jnp.linspace(0.0, jnp.pi / 2.0, _SAMPLES)
    mate = _ring_corner(pair, corner)
    pinion, ring = (jnp.abs(radius) for radius in pair.tip_radii)
    still_to_pass = pinion * jnp.cos(corner) + pair.centre_distance > ring * jnp.cos(mate)
    apart = ring * jnp.sin(mate) - pinion * jnp.sin(corner)
    return jnp.min(jnp.where(still_to_pass, apart, pinion))


def _arccos(cosine: Float[Array, "*b"]) -> Float[Array, "*b"]:
    return jnp.arccos(jnp.clip(cosine, -1.0, 1.0))


def _pointed_radius(gear: InvoluteGear) -> Float[Array, ""]:
    """Radius at which the flanks of a tooth cross [m]; the base radius if they do so within it."""
    base = jnp.abs(gear.base_radius)
    value = gear.side * gear.half_thickness_angle(base)
    crossing = inverse_involute(jnp.where(value > 0.0, value, 1.0))
    return base / jnp.where(value > 0.0, jnp.cos(crossing), 1.0)


def _check_teeth(pair: _Pair) -> Faults:
    yield (
        pair.internal & (pair.pinion_teeth >= pair.wheel_teeth),
        lambda: _refuse(
            "teeth",
            pair.wheel_teeth,
            f"the ring, gear 2, has {pair.wheel_teeth:g} teeth and must have more than gear 1, "
            f"which has {pair.pinion_teeth:g}",
        ),
    )


def _check_distance(pair: _Pair) -> Faults:
    yield from _check_shift_sum(pair)
    yield (
        pair.cutter_shift_sum >= pair.cutter_limit_sum,
        lambda: _refuse(
            "cutter_teeth",
            pair.cutter_teeth,
            f"the profile shifts of gear 2 and its cutter sum to {pair.cutter_shift_sum:.4g}; with "
            f"{pair.cutter_teeth:g} teeth of the cutter the sum must be below {pair.cutter_limit_sum:.4g}: "
            "above it their flanks fit at no distance between their axes",
        ),
    )
    yield (
        pair.centre_distance <= pair.base_sum,
        lambda: _refuse(
            "centre_distance",
            pair.centre_distance,
            f"the centre distance {_mm(pair.centre_distance)} of gear 1 and gear 2 must be larger "
            f"than the {'difference' if pair.internal else 'sum'} of their base radii, "
            f"{_mm(pair.base_sum)}; there is no working pressure angle",
        ),
    )
    yield (
        (_flank_overlap(pair) > _ROUNDED_DISTANCE * pair.module)
        & ((pair.least_backlash < 0.0) | _unknown(pair.least_backlash)),
        lambda: _refuse(
            "centre_distance",
            pair.centre_distance,
            _overlapping(pair),
            Remedy("profile_shift", 0.0),
            Remedy("centre_distance", 0.0),
        ),
    )


def _flank_overlap(pair: _Pair) -> Number:
    """By how much the centre distance would have to change for flanks without backlash [m]."""
    overlap = (pair.zero_backlash - pair.centre_distance) * (1.0 - pair.thinned)
    return -overlap if pair.internal else overlap


def _overlapping(pair: _Pair) -> str:
    allowed = "allow at most" if pair.internal else "need at least"
    has_allowances = not _unknown(pair.least_backlash)
    by_allowances = (
        f", and their allowances leave {1e6 * pair.least_backlash:.3g} um" if has_allowances else ""
    )
    needed = round(float(pair.needed_shift_sum), 9) + 0.0  # zero but for rounding is zero
    return (
        f"the flanks of gear 1 and gear 2 overlap at the centre distance {_mm(pair.centre_distance)}; these "
        f"teeth {allowed} {_mm(pair.zero_backlash)}, which is without backlash{by_allowances}; this distance "
        f"asks for profile shifts that sum to {needed:.4g} instead of {pair.shift_sum:.4g}"
    )


def _check_shift_sum(pair: _Pair) -> Faults:
    none = _unknown(pair.zero_backlash)

    def refused(end: str) -> NoReturn:
        sentence = f"the profile shifts of gear 1 and gear 2 sum to {pair.shift_sum:.4g}"
        _refuse("profile_shift", pair.shift_sum, f"{sentence}{end}")

    yield (
        none & pair.internal & (pair.shift_sum >= pair.limit_shift_sum),
        lambda: refused(
            f", which must be below {pair.limit_shift_sum:.4g}: above it the flanks overlap "
            "at any centre distance"
        ),
    )
    yield (
        none & ((-pair.shift_sum if pair.internal else pair.shift_sum) > 0.0),
        lambda: refused("; the working pressure angle would be above 65 degrees"),
    )
    yield (
        none & _unknown(pair.centre_distance) & (pair.shift_sum <= pair.limit_shift_sum),
        lambda: refused(
            f", which must be above {pair.limit_shift_sum:.4g}: below it the teeth have "
            "backlash at any centre distance"
        ),
    )


def _check_tool(gear: _Gear) -> Faults:
    yield (
        gear.dedendum <= gear.fillet_radius,
        lambda: _refuse(
            "dedendum",
            gear.dedendum,
            f"the dedendum of {gear.name} is {gear.dedendum:.4g} {gear.modules} and must be larger "
            f"than its fillet radius, {gear.fillet_radius:.4g} {gear.modules}",
        ),
    )
    yield (
        gear.dedendum >= gear.deepest_dedendum,
        lambda: _refuse(
            "dedendum",
            gear.dedendum,
            f"the rack that cuts {gear.name} has no tip left at the dedendum {gear.dedendum:.4g} "
            f"{gear.modules}; it may be {gear.deepest_dedendum:.4g} {gear.modules} at most",
            Remedy("dedendum", -1.0, (gear.number - 1,)),
        ),
    )
    yield from _check_fillet_radius(gear, "the tip of its rack has")


def _check_ring_root(gear: _Gear) -> Faults:
    yield (
        gear.root_diameter <= gear.base_diameter,
        lambda: _refuse(
            "dedendum",
            gear.dedendum,
            f"the root circle of {gear.name} ({_mm(gear.root_diameter)}) lies inside its base "
            f"circle ({_mm(gear.base_diameter)}); it must be larger",
        ),
    )
    yield (
        gear.dedendum >= gear.deepest_dedendum,
        lambda: _refuse(
            "dedendum",
            gear.dedendum,
            f"the flanks of {gear.name} cross in the space between its teeth at the dedendum "
            f"{gear.dedendum:.4g} {gear.modules}; it may be {gear.deepest_dedendum:.4g} "
            f"{gear.modules} at most",
        ),
    )
    where = "the tip of its cutter has" if gear.shaped else "the root of its spaces has"
    yield from _check_fillet_radius(gear, where)


def _check_fillet_radius(gear: _Gear, where: str) -> Faults:
    yield (
        gear.fillet_radius > gear.largest_fillet_radius * (1.0 + 1e-9),
        lambda: _refuse(
            "fillet_radius",
            gear.fillet_radius,
            f"the fillet radius of {gear.name} is {gear.fillet_radius:.4g} {gear.modules}, but "
            f"{where} room for {gear.largest_fillet_radius:.4g} {gear.modules} at most",
            Remedy("fillet_radius", -1.0, (gear.number - 1,)),
        ),
    )


def _check_circles(gear: _Gear) -> Faults:
    yield (
        gear.root_diameter <= 0.0,
        lambda: _refuse(
            "dedendum",
            gear.dedendum,
            f"the root circle of {gear.name} has the diameter {_mm(gear.root_diameter)}; it must "
            "be positive",
        ),
    )
    yield from (_check_ring_tip(gear) if gear.internal else _check_tip(gear))
    yield (
        gear.tip_thickness < 0.0,
        lambda: _refuse(
            "addendum",
            gear.addendum,
            f"{_tip_circle(gear)} lies beyond the point of the teeth, where the flanks cross; it "
            f"may be {_mm(gear.pointed_diameter)} at {'least' if gear.internal else 'most'}; without a "
            "tip_alteration, least_tip_thickness shortens it",
            Remedy("least_tip_thickness", 1.0),
            Remedy("profile_shift", 1.0 if gear.internal else -1.0, (gear.number - 1,)),
            Remedy("addendum", -1.0, (gear.number - 1,)),
        ),
    )
    left = gear.tip_diameter - gear.form_diameter
    yield (
        (-left if gear.internal else left) <= 0.0,
        lambda: _refuse(
            "profile_shift",
            gear.profile_shift,
            f"no involute is left on {gear.name}: its form circle ({_mm(gear.form_diameter)}) must "
            f"lie {'outside' if gear.internal else 'inside'} its tip circle "
            f"({_mm(gear.tip_diameter)})",
            Remedy("profile_shift", -1.0 if gear.internal else 1.0, (gear.number - 1,)),
        ),
    )


def _check_tip(gear: _Gear) -> Faults:
    def inside(name: str, diameter: Number) -> NoReturn:
        _refuse(
            "addendum",
            gear.addendum,
            f"{_tip_circle(gear)} lies inside its {name} circle ({_mm(diameter)}); it must be larger",
        )

    root, base = gear.root_diameter, gear.base_diameter
    yield gear.tip_diameter <= root, lambda: inside("root", root)
    yield gear.tip_diameter <= base, lambda: inside("base", base)


def _check_ring_tip(gear: _Gear) -> Faults:
    yield (
        gear.tip_diameter >= gear.root_diameter,
        lambda: _refuse(
            "addendum",
            gear.addendum,
            f"{_tip_circle(gear)} lies outside its root circle ({_mm(gear.root_diameter)}); that "
            "of a ring must be smaller",
        ),
    )
    yield (
        gear.tip_diameter <= gear.base_diameter,
        lambda: _refuse(
            "addendum",
            gear.addendum,
            f"{_tip_circle(gear)} lies inside its base circle ({_mm(gear.base_diameter)}), where "
            "there is no involute; it must be larger",
            Remedy("addendum", -1.0, (gear.number - 1,)),
            Remedy("pressure_angle", 1.0),
        ),
    )


def _tip_circle(gear: _Gear) -> str:
    return f"the tip circle of {gear.name} ({_mm(abs(float(gear.tip_diameter)))})"


def _check_meeting(pair: _Pair, gear: _Gear) -> Faults:
    yield (
        gear.clearance < 0.0,
        lambda: _refuse(
            "dedendum",
            gear.clearance,
            f"the tip of {gear.name} runs into the root of {gear.mate}: the tip clearance is "
            f"{gear.clearance:.4g} {gear.modules} and must be positive",
            Remedy("dedendum", 1.0, (2 - gear.number,)),
            Remedy("dedendum", 1.0, (0, 1)),
            Remedy("addendum", -1.0, (gear.number - 1,)),
        ),
    )
    yield (
        gear.fillet_overlap > _DEEPEST_IN_FILLET,
        lambda: _refuse(
            "addendum",
            gear.fillet_overlap,
            f"the tip of {gear.mate} runs into the {_fillet(gear)} of {gear.name}: they overlap by "
            f"{gear.fillet_overlap:.3g} {gear.modules}; a shorter addendum of {gear.mate} or a "
            f"{'larger profile shift' if gear.undercut else 'smaller fillet radius'} of {gear.name} "
            "parts them",
            Remedy("addendum", -1.0, (2 - gear.number,)),
            Remedy("fillet_radius", -1.0, (gear.number - 1,)),
            Remedy("profile_shift", 1.0, (gear.number - 1,)),
            Remedy("pressure_angle", 1.0),
        ),
    )
    yield (
        (not (gear.undercut or gear.internal)) & (gear.mate_reach <= 0.0),
        lambda: _refuse(
            "addendum",
            gear.mate_reach,
            f"the tip of {gear.mate} reaches {_mm(-gear.mate_reach)} beyond the point in which the line of "
            f"action touches the base circle of {gear.name}; a shorter addendum of {gear.mate} keeps within",
            Remedy("addendum", -1.0, (2 - gear.number,)),
        ),
    )


def _fillet(gear: _Gear) -> str:
    return "undercut fillet" if gear.undercut else "fillet"


def _check_contact_ratio(pair: _Pair, gears: list[_Gear]) -> Faults:
    def low(name: str, value: Number, least: float) -> NoReturn:
        _refuse_contact_ratio(pair, gears, name, float(value), least)

    yield (
        pair.helical & (pair.transverse_ratio <= 0.0),
        lambda: low("transverse contact ratio", pair.transverse_ratio, 0.0),
    )
    name = "total contact ratio" if pair.helical else "contact ratio"
    yield pair.contact_ratio < 1.0, lambda: low(name, pair.contact_ratio, 1.0)
    yield (
        pair.contact_ratio >= LARGEST_CONTACT_RATIO,
        lambda: _refuse(
            "face_width" if pair.contact_ratio > 2.0 * pair.transverse_ratio else "addendum",
            pair.contact_ratio,
            f"the contact ratio of gear 1 and gear 2 is {pair.contact_ratio:.4g} and must be below "
            f"{LARGEST_CONTACT_RATIO:g}; shorter addenda "
            f"{'or a narrower face lower' if pair.helical else 'lower'} it",
        ),
    )


def _refuse_contact_ratio(
    pair: _Pair, gears: list[_Gear], name: str, value: float, least: float
) -> NoReturn:
    lost = sum(_lost_ratio(pair, gear) for gear in gears)
    cut = [gear for gear in gears if _lost_ratio(pair, gear) > 0.0]
    cut.sort(key=lambda gear: -_lost_ratio(pair, gear))
    _refuse(
        "profile_shift" if value + lost >= least else "addendum",
        value,
        f"the {name} of gear 1 and gear 2 is {value:.4g} and must be "
        f"{f'at least {least:g}' if least else 'positive'}; "
        + (_against_undercut(cut, lost) if cut else _longer_path(pair, wider=least > 0.0)),
        *_raising(cut),
    )


def _against_undercut(cut: list[_Gear], lost: float) -> str:
    names = " or ".join(gear.name for gear in cut)
    return (
        f"undercut takes {lost:.3g} away; a larger profile shift of {names}, a larger pressure angle or more "
        "teeth take less"
    )


def _longer_path(pair: _Pair, *, wider: bool) -> str:
    face = "a wider face, " if pair.helical and wider else ""
    change = "larger" if pair.internal else "smaller"
    return (
        f"{face}longer addenda, more teeth, a smaller pressure angle or a {change} centre distance "
        "raise it"
    )


def _raising(cut: list[_Gear]) -> tuple[Remedy, ...]:
    """What raises a contact ratio."""
    if cut:
        numbers = [(gear.number - 1,) for gear in cut]
        shifts = [Remedy("profile_shift", 1.0, which) for which in (*numbers, (0, 1))]
        return *shifts[: 1 + len(cut)], Remedy("pressure_angle", 1.0)
    follows = Remedy("profile_shift", 0.0), Remedy("centre_distance", 0.0)
    return *follows, Remedy("addendum", 1.0, (0, 1))


def _check_tips(pair: _Pair) -> Faults:
    yield (
        pair.internal & (pair.tip_gap < 0.0),
        lambda: _refuse(
            "addendum",
            pair.tip_gap,
            f"the tips of gear 1 and gear 2 run into each other where their tip circles cross: "
            f"they overlap by {-pair.tip_gap:.3g} {pair.modules}; shorter addenda, fewer teeth of "
            "gear 1 or more teeth of gear 2 part them",
            Remedy("addendum", -1.0, (0, 1)),
            Remedy("profile_shift", -1.0, (1,)),
        ),
    )


def _check_cutter(pair: _Pair) -> Faults:
    yield (
        pair.cutter_reach < 0.0,
        lambda: _refuse(
            "cutter_teeth",
            pair.cutter_teeth,
            f"the tips of gear 2 reach {-pair.cutter_reach:.3g} {pair.modules} beyond the end of the "
            f"involute of its cutter with {pair.cutter_teeth:g} teeth, which takes them off; a cutter with "
            "more teeth or a shorter addendum of gear 2 leaves them",
            Remedy("addendum", -1.0, (1,)),
        ),
    )
    yield (
        pair.cutter_tip_gap < 0.0,
        lambda: _refuse(
            "cutter_teeth",
            pair.cutter_teeth,
            f"the cutter of gear 2 with {pair.cutter_teeth:g} teeth takes off the tips of gear 2 where their "
            f"tip circles cross: they overlap by {-pair.cutter_tip_gap:.3g} {pair.modules}; a cutter with "
            "fewer teeth or a shorter addendum of gear 2 leaves them",
            Remedy("addendum", -1.0, (1,)),
        ),
    )


def _check_finite(pair: _Pair, gears: list[_Gear], only: tuple[str, ...] = ()) -> Faults:
    named = [*((gear.name, vars(gear)) for gear in gears), ("the pair", vars(pair))]
    for name, numbers in named:
        for key in only or numbers:
            value = numbers.get(key, 0.0)
            if key not in ("zero_backlash", "least_backlash"):
                yield value - value != 0.0, partial(_refuse_endless, name, key, value)


def _refuse_endless(name: str, key: str, value: Number) -> NoReturn:
    message = f"the {key.replace('_', ' ')} of {name} is {value} and must be a finite number"
    raise InputError(message, value=value)


def _unknown(value: Number) -> Any:
    """True for no number, of plain ones and of traced ones."""
    return value != value


def _warnings(pair: _Pair, gear: _Gear) -> list[Doubt]:
    doubts = []
    if gear.tip_thickness < _THIN_TIP:
        doubts.append(
            Doubt(
                f"The teeth of {gear.name} are {gear.tip_thickness:.3g} {gear.modules} thick at the "
                f"tip; at least {_THIN_TIP:g} {gear.modules} are usual.",
                moves=REMARKED,
                brief=f"Thin tips of {gear.name}: {gear.tip_thickness:.3g} {gear.modules}.",
            )
        )
    if gear.undercut:
        doubts.append(_undercut_warning(pair, gear))
    if _small_clearance(gear):
        doubts.append(
            Doubt(
                f"The tip of {gear.name} clears the root of {gear.mate} by {gear.clearance:.3g} "
                f"{gear.modules}; at least {_SMALL_CLEARANCE:g} {gear.modules} are usual.",
                moves=REMARKED,
                brief=f"Small clearance under the tip of {gear.name}: {gear.clearance:.3g} {gear.modules}.",
            )
        )
    if gear.fillet_overlap > _TOLD_IN_FILLET:
        doubts.append(_fillet_warning(pair, gear))
    return doubts


def _fillet_warning(pair: _Pair, gear: _Gear) -> Doubt:
    beyond = max(float(gear.missing), 0.0) / float(pair.base_pitch * pair.contact_ratio)
    return Doubt(
        f"The tip of {gear.mate} enters the {_fillet(gear)} of {gear.name} by "
        f"{gear.fillet_overlap:.2g} {gear.modules}, which these figures leave out; a smaller fillet "
        f"radius of {gear.name} or a shorter addendum of {gear.mate} keeps it out.",
        moves=max(beyond, REMARKED),
        brief=f"Tip in the fillet of {gear.name}: {gear.fillet_overlap:.2g} {gear.modules}, left out.",
    )


def _small_clearance(gear: _Gear) -> bool:
    return bool(gear.clearance < _SMALL_CLEARANCE * (1.0 - 1e-9))


def _pair_warnings(pair: _Pair) -> list[Doubt]:
    doubts = []
    if pair.transverse_ratio < 1.0:
        overlap = pair.contact_ratio - pair.transverse_ratio
        doubts.append(
            Doubt(
                f"The transverse contact ratio of gear 1 and gear 2 is {pair.transverse_ratio:.3g}; "
                f"it is the overlap ratio, {overlap:.3g}, that keeps the teeth in contact.",
                moves=REMARKED,
                brief=f"Transverse contact ratio {pair.transverse_ratio:.3g}: the overlap keeps contact.",
            )
        )
    if _flank_overlap(pair) > _TOLD_DISTANCE * pair.module:
        doubts.append(_overlap_warning(pair))
    if pair.internal and pair.radial_gap < 0.0:
        doubts.append(
            Doubt(
                "Gear 1 must be put into gear 2 along its axis: moved in radially, the tips overlap by "
                f"up to {-pair.radial_gap:.3g} {pair.modules}.",
                moves=REMARKED,
                brief=f"Gear 1 goes in axially; radially tips overlap {-pair.radial_gap:.3g} "
                f"{pair.modules}.",
            )
        )
    if pair.cutter_radial_gap < 0.0:
        doubts.append(
            Doubt(
                f"The cutter of gear 2 with {pair.cutter_teeth:g} teeth takes off its tips while it is fed "
                f"in radially: they overlap by up to {-pair.cutter_radial_gap:.3g} {pair.modules}, which "
                "these figures leave out; a cutter with fewer teeth leaves them.",
                moves=REMARKED,
                brief=f"The cutter takes {-pair.cutter_radial_gap:.3g} {pair.modules} off tips of gear 2.",
            )
        )
    return doubts


def _overlap_warning(pair: _Pair) -> Doubt:
    overlap = float(_flank_overlap(pair))
    rounded = overlap <= _ROUNDED_DISTANCE * pair.module
    taken = (
        "taken for what is rounded"
        if rounded
        else f"and their allowances leave a backlash of {1e6 * pair.least_backlash:.3g} um"
    )
    return Doubt(
        "The nominal flanks of gear 1 and gear 2 overlap: the centre distance without backlash is "
        f"{_mm(pair.zero_backlash)}, {1e6 * overlap:.3g} um away, {taken}; figures are those of nominal "
        "teeth, whose backlash is negative.",
        moves=REMARKED if rounded else LEFT_OUT,
        brief=f"Nominal flanks overlap: the distance lacks {1e6 * overlap:.3g} um for no backlash.",
    )


def _undercut_warning(pair: _Pair, gear: _Gear) -> Doubt:
    lost = _lost_ratio(pair, gear)
    circle = f"its form circle ({1e3 * gear.form_diameter:.6g} mm)"
    loses, ends = (
        (f"loses {lost:.2g} of its contact ratio", f"the path of contact ends at {circle}")
        if lost > 0.0
        else ("loses no contact ratio", f"{circle} lies below the path of contact")
    )
    thinned = "with teeth thinned for the backlash " if pair.thinned else ""
    return Doubt(
        f"The undercut of {gear.name} {loses}; {thinned}its profile shift {gear.profile_shift:.4g} is below "
        f"the limit {gear.undercut_limit:.4g}, and {ends}.",
        moves=max(lost / float(pair.contact_ratio), REMARKED),
        brief=f"The undercut of {gear.name} {loses}."
        if lost > 0.0
        else f"{gear.name.capitalize()} is undercut: no contact ratio lost, a thinner root.",
    )


def _lost_ratio(pair: _Pair, gear: _Gear) -> float:
    """Contact ratio between the mate's tip circle and the form circle of an undercut gear."""
    return float(max(gear.missing, 0.0) / pair.base_pitch) if gear.undercut else 0.0


def _refuse(entry: str, value: Number, message: str, *remedies: Remedy) -> NoReturn:
    error = UnsoundPairError(message, key=entry, value=value)
    error.remedies = remedies
    raise error


def _mm(length: Number) -> str:
    # Enough digits to take the number back as input.
    return f"{1e3 * length:.8g} mm"
