"""Checks of a design in gear words: what cannot run is an error, what should not a warning."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, NoReturn

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.involute import InvoluteGear, inverse_involute, involute

if TYPE_CHECKING:
    from pitchpoint.gears.cylindrical import CylindricalPair

__all__ = ["check_cylindrical"]

_THIN_TIP = 0.2  # modules
_SMALL_CLEARANCE = 0.1  # modules
_LARGEST_CONTACT_RATIO = 9.0
_GIVEN = ("module", "profile_shift", "addendum", "dedendum", "fillet_radius")
# Drawings round the centre distance; an overlap this small is no fault [modules].
_ROUNDED_DISTANCE = 1e-4
# The usual fillet radius 0.38 is rounded up from 0.25/(1 - sin 20 deg) [modules].
_ROUNDED_FILLET = 1e-3


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Gear:
    """Plain numbers of one gear: diameters and lengths [m], those of the rack in modules."""

    number: int
    undercut: bool
    tip_diameter: float
    root_diameter: float
    base_diameter: float
    form_diameter: float
    pointed_diameter: float
    tip_thickness: float
    profile_shift: float
    undercut_limit: float
    addendum: float
    dedendum: float
    fillet_radius: float
    deepest_dedendum: float
    largest_fillet_radius: float
    clearance: float
    form_length: float
    lowest_contact: float

    @property
    def name(self) -> str:
        return f"gear {self.number}"

    @property
    def mate(self) -> str:
        return f"gear {3 - self.number}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Pair:
    """Plain numbers of the pair: lengths [m]; the zero-backlash distance is NaN if none exists."""

    module: float
    base_pitch: float
    centre_distance: float
    zero_backlash: float
    base_sum: float
    shift_sum: float
    lowest_shift_sum: float
    contact_ratio: float


def check_cylindrical(pair: CylindricalPair) -> list[str]:
    """Warnings for a design that runs but should not be made so; an error for one that cannot run.

    Args:
        pair: two external spur gears.

    Returns:
        One sentence for each warning: undercut, a tip thinner than 0.2 modules, a tip clearance
        below 0.1 modules. Empty for a sound pair.

    Raises:
        InputError: the flanks overlap or never meet, a tip is pointed, a tip runs into the mate's
            root or fillet, the tool is impossible, or the contact ratio is not from 1 to 9. Its
            key is the entry of the gears table to change.

    Validity: the fillet of an undercut gear is not checked against the tip of its mate. Backlash is
    not limited.

    Source: geometry of ISO 21771:2007; tool tip of ISO 53:1998.
    """
    whole, gears = _measure(pair)
    _check_finite(whole, gears, only=_GIVEN)
    _check_distance(whole)
    for gear in gears:
        _check_tool(gear)
        _check_circles(gear)
    for gear in gears:
        _check_meeting(whole, gear)
    _check_contact_ratio(whole, gears)
    _check_finite(whole, gears)  # whatever the checks above did not think of
    return [text for gear in gears for text in _warnings(whole, gear)]


def _measure(pair: CylindricalPair) -> tuple[_Pair, list[_Gear]]:
    lanes = 2  # of no account here: one program for all
    numbers = jax.device_get(_measures(dataclasses.replace(pair, lanes=lanes)))
    whole, *gears = [{key: float(x) for key, x in part.items()} for part in numbers]
    return _Pair(**whole), [
        _Gear(number=i + 1, undercut=pair.undercut[i], **gear) for i, gear in enumerate(gears)
    ]


@eqx.filter_jit
def _measures(pair: CylindricalPair) -> list[dict[str, Float[Array, ""]]]:
    """Measures of the pair and of each gear, under the names of their plain classes."""
    gears = pair.gears
    return [
        _pair_measures(pair),
        _gear_measures(gears[0]) | _meeting_measures(pair, gears[0], gears[1]),
        _gear_measures(gears[1]) | _meeting_measures(pair, gears[1], gears[0]),
    ]


def _pair_measures(pair: CylindricalPair) -> dict[str, Float[Array, ""]]:
    angle = pair.pressure_angle
    return {
        "module": pair.module,
        "base_pitch": pair.base_pitch,
        "centre_distance": pair.centre_distance,
        "zero_backlash": pair.zero_backlash_centre_distance,
        "base_sum": jnp.sum(pair.base_radii),
        "shift_sum": jnp.sum(pair.profile_shift),
        "lowest_shift_sum": -involute(angle) * jnp.sum(pair.teeth) / (2.0 * jnp.tan(angle)),
        "contact_ratio": pair.contact_ratio,
    }


def _gear_measures(gear: InvoluteGear) -> dict[str, Float[Array, ""]]:
    angle = gear.pressure_angle
    # Half the tool's tip land if its corners were sharp [modules].
    land = jnp.pi / 4.0 - gear.dedendum * jnp.tan(angle)
    return {
        "tip_diameter": 2.0 * gear.tip_radius,
        "root_diameter": 2.0 * gear.root_radius,
        "base_diameter": 2.0 * gear.base_radius,
        "form_diameter": 2.0 * jnp.hypot(gear.base_radius, gear.form_roll_length),
        "pointed_diameter": 2.0 * _pointed_radius(gear),
        "tip_thickness": gear.tip_thickness / gear.module,
        "profile_shift": gear.profile_shift,
        "undercut_limit": gear.undercut_limit,
        "addendum": gear.addendum,
        "dedendum": gear.dedendum,
        "fillet_radius": gear.fillet_radius,
        "deepest_dedendum": jnp.pi / 4.0 / jnp.tan(angle),
        "largest_fillet_radius": land * jnp.cos(angle) / (1.0 - jnp.sin(angle)),
        "form_length": gear.form_roll_length,
    }


def _meeting_measures(
    pair: CylindricalPair, gear: InvoluteGear, mate: InvoluteGear
) -> dict[str, Float[Array, ""]]:
    """Tip clearance, and where on the line of action the mate's tip circle ends the contact."""
    distance = pair.centre_distance - gear.tip_radius - mate.root_radius
    reach = jnp.sqrt(mate.tip_radius**2 - mate.base_radius**2)
    return {"clearance": distance / pair.module, "lowest_contact": pair.tangent_length - reach}


def _pointed_radius(gear: InvoluteGear) -> Float[Array, ""]:
    """Radius at which the flanks of a tooth cross [m]; the base radius if they do so within it."""
    value = gear.half_thickness_angle(gear.base_radius)
    crossing = inverse_involute(jnp.where(value > 0.0, value, 1.0))
    return gear.base_radius / jnp.where(value > 0.0, jnp.cos(crossing), 1.0)


def _check_distance(pair: _Pair) -> None:
    if math.isnan(pair.zero_backlash):
        _check_shift_sum(pair)
    if pair.centre_distance <= pair.base_sum:
        _refuse(
            "centre_distance",
            pair.centre_distance,
            f"the centre distance {_mm(pair.centre_distance)} of gear 1 and gear 2 must be larger "
            f"than the sum of their base radii, {_mm(pair.base_sum)}; there is no working pressure "
            "angle",
        )
    overlap = pair.zero_backlash - pair.centre_distance
    if overlap > _ROUNDED_DISTANCE * pair.module:
        _refuse(
            "centre_distance",
            pair.centre_distance,
            f"the flanks of gear 1 and gear 2 overlap at the centre distance "
            f"{_mm(pair.centre_distance)}; these teeth need at least {_mm(pair.zero_backlash)}, "
            "which is without backlash",
        )


def _check_shift_sum(pair: _Pair) -> None:
    told = f"the profile shifts of gear 1 and gear 2 sum to {pair.shift_sum:.4g}"
    if pair.shift_sum > 0.0:
        _refuse(
            "profile_shift",
            pair.shift_sum,
            f"{told}; the working pressure angle would be above 65 degrees",
        )
    if math.isnan(pair.centre_distance) and pair.shift_sum <= pair.lowest_shift_sum:
        _refuse(
            "profile_shift",
            pair.shift_sum,
            f"{told}, which must be above {pair.lowest_shift_sum:.4g}: below it the teeth have "
            "backlash at any centre distance",
        )


def _check_tool(gear: _Gear) -> None:
    if gear.dedendum <= gear.fillet_radius:
        _refuse(
            "dedendum",
            gear.dedendum,
            f"the dedendum of {gear.name} is {gear.dedendum:.4g} modules and must be larger than "
            f"its fillet radius, {gear.fillet_radius:.4g} modules",
        )
    if gear.dedendum >= gear.deepest_dedendum:
        _refuse(
            "dedendum",
            gear.dedendum,
            f"the rack that cuts {gear.name} has no tip left at the dedendum {gear.dedendum:.4g} "
            f"modules; it may be {gear.deepest_dedendum:.4g} modules at most",
        )
    if gear.fillet_radius > gear.largest_fillet_radius * (1.0 + 1e-9):
        _refuse(
            "fillet_radius",
            gear.fillet_radius,
            f"the fillet radius of {gear.name} is {gear.fillet_radius:.4g} modules, but the tip of "
            f"its rack has room for {gear.largest_fillet_radius:.4g} modules at most",
        )


def _check_circles(gear: _Gear) -> None:
    tip = f"the tip circle of {gear.name} ({_mm(gear.tip_diameter)})"
    if gear.root_diameter <= 0.0:
        _refuse(
            "dedendum",
            gear.dedendum,
            f"the root circle of {gear.name} has the diameter {_mm(gear.root_diameter)}; it must "
            "be positive",
        )
    for name, diameter in (("root", gear.root_diameter), ("base", gear.base_diameter)):
        if gear.tip_diameter <= diameter:
            _refuse(
                "addendum",
                gear.addendum,
                f"{tip} lies inside its {name} circle ({_mm(diameter)}); it must be larger",
            )
    if gear.tip_thickness < 0.0:
        _refuse(
            "addendum",
            gear.addendum,
            f"{tip} lies beyond the point of the teeth, where the flanks cross; it may be "
            f"{_mm(gear.pointed_diameter)} at most",
        )
    if gear.form_diameter >= gear.tip_diameter:
        _refuse(
            "profile_shift",
            gear.profile_shift,
            f"no involute is left on {gear.name}: its form circle ({_mm(gear.form_diameter)}) must "
            f"lie inside its tip circle ({_mm(gear.tip_diameter)})",
        )


def _check_meeting(pair: _Pair, gear: _Gear) -> None:
    if gear.clearance < 0.0:
        _refuse(
            "dedendum",
            gear.clearance,
            f"the tip of {gear.name} runs into the root of {gear.mate}: the tip clearance is "
            f"{gear.clearance:.4g} modules and must be positive",
        )
    missing = gear.form_length - gear.lowest_contact
    if not gear.undercut and missing > _ROUNDED_FILLET * pair.module:
        _refuse(
            "addendum",
            gear.lowest_contact,
            f"the tip of {gear.mate} meets the fillet of {gear.name}: on the line of action, "
            f"counted from the base circle of {gear.name}, it reaches down to "
            f"{_mm(gear.lowest_contact)}, but the involute begins at {_mm(gear.form_length)}; a "
            f"shorter addendum of {gear.mate} or a larger dedendum of {gear.name} parts them",
        )


def _check_contact_ratio(pair: _Pair, gears: list[_Gear]) -> None:
    told = f"the contact ratio of gear 1 and gear 2 is {pair.contact_ratio:.4g}"
    if pair.contact_ratio < 1.0:
        lost = sum(_lost_ratio(pair, gear) for gear in gears)
        undercut = f"; undercut takes {lost:.3g} away" if lost > 0.0 else ""
        _refuse(
            "profile_shift" if pair.contact_ratio + lost >= 1.0 else "addendum",
            pair.contact_ratio,
            f"{told} and must be at least 1{undercut}; longer addenda, more teeth, a smaller "
            "pressure angle or a smaller centre distance raise it",
        )
    if pair.contact_ratio >= _LARGEST_CONTACT_RATIO:
        _refuse(
            "addendum",
            pair.contact_ratio,
            f"{told} and must be below {_LARGEST_CONTACT_RATIO:g}; shorter addenda lower it",
        )


def _check_finite(pair: _Pair, gears: list[_Gear], only: tuple[str, ...] = ()) -> None:
    named = [*((gear.name, vars(gear)) for gear in gears), ("the pair", vars(pair))]
    for name, numbers in named:
        for key in only or numbers:
            value = numbers.get(key, 0.0)
            if key != "zero_backlash" and not math.isfinite(value):
                what = key.replace("_", " ")
                message = f"the {what} of {name} is {value} and must be a finite number"
                raise InputError(message, key="gears", value=value)


def _warnings(pair: _Pair, gear: _Gear) -> list[str]:
    found = []
    if gear.tip_thickness < _THIN_TIP:
        found.append(
            f"The teeth of {gear.name} are {gear.tip_thickness:.3g} modules thick at the tip; "
            f"at least {_THIN_TIP:g} modules are usual."
        )
    if gear.undercut:
        found.append(_undercut_warning(pair, gear))
    if gear.clearance < _SMALL_CLEARANCE:
        found.append(
            f"The tip of {gear.name} clears the root of {gear.mate} by {gear.clearance:.3g} "
            f"modules; at least {_SMALL_CLEARANCE:g} modules are usual."
        )
    return found


def _undercut_warning(pair: _Pair, gear: _Gear) -> str:
    lost = _lost_ratio(pair, gear)
    cost = (
        f"the path of contact ends at its form circle ({_mm(gear.form_diameter)}), which takes "
        f"{lost:.2g} of the contact ratio between the tip circles"
        if lost > 0.0
        else f"its form circle ({_mm(gear.form_diameter)}) lies below the path of contact, so that "
        "no contact ratio is lost"
    )
    return (
        f"The flanks of {gear.name} are undercut: its profile shift {gear.profile_shift:.4g} is "
        f"below the limit {gear.undercut_limit:.4g}; {cost}."
    )


def _lost_ratio(pair: _Pair, gear: _Gear) -> float:
    """Contact ratio between the mate's tip circle and the form circle of an undercut gear."""
    missing = gear.form_length - gear.lowest_contact
    return max(missing, 0.0) / pair.base_pitch if gear.undercut else 0.0


def _refuse(entry: str, value: float, message: str) -> NoReturn:
    raise InputError(message, key=f"gears.{entry}", value=value)


def _mm(length: float) -> str:
    # Enough digits to take the number back as input.
    return f"{1e3 * length:.8g} mm"
