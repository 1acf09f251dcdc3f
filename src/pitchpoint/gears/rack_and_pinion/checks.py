"""Checks of a rack and pinion in gear words: what cannot run is an error, what should not a warning."""

from collections.abc import Iterator
from types import SimpleNamespace

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import LARGEST_CONTACT_RATIO
from pitchpoint.gears.rack_and_pinion.mesh import RackAndPinion

__all__ = ["check_rack_and_pinion"]

# In modules, as of pairs, see `cylindrical.checks`.
_THIN_TIP = 0.2
_SMALL_CLEARANCE = 0.1
# The usual fillet radius 0.38 is rounded up from 0.25/(1 - sin 20 deg) [modules].
_ROUNDED_FILLET = 1e-3
# Drawings round the mounting distance; an overlap this small is no fault [modules].
_ROUNDED_DISTANCE = 1e-4

_FAR = 0.05
"""Modules beyond the distance without backlash from which on that is why teeth lose contact."""

Refusal = tuple[bool, str, str]


def check_rack_and_pinion(mesh: RackAndPinion) -> list[str]:
    """Warnings for a design that runs but should not be made so; an error for one that cannot run.

    Args:
        mesh: rack and pinion.

    Returns:
        One sentence for each warning: undercut, a tip of the pinion thinner than 0.2 modules, a tip clearance
        below 0.1 modules, a transverse contact ratio below 1.

    Raises:
        InputError: the flanks overlap, a tip is pointed, a tip runs into the other's root or fillet, a
            fillet does not fit, or the contact ratio is not from 1 to 24. Its key is that of the gears
            table to change.

    Source: geometry of ISO 21771:2007; tooth of the rack of ISO 53:1998.
    """
    measures = SimpleNamespace(
        **{key: float(v) for key, v in jax.device_get(_measures(mesh)).items()}
    )
    for bad, key, sentence in (*_teeth(measures), *_meeting(measures)):
        if bad:
            raise InputError(sentence, key=key)
    return [*_warnings(measures)]


@program
def _measures(mesh: RackAndPinion) -> dict[str, Float[Array, ""]]:
    """Lengths in normal modules, counted from the reference line of the rack towards the pinion."""
    pinion, rack, line = mesh.pinion, mesh.rack, mesh.line
    module, straight = pinion.module, _straight(mesh)
    return {
        "play": (mesh.distance - mesh.zero_backlash_distance) / module,
        "distance": mesh.distance,
        "nearest": mesh.zero_backlash_distance,
        "root_radius": pinion.root_radius / module,
        "tip_thickness": pinion.tip_thickness / module,
        "shift": pinion.profile_shift,
        "limit": pinion.undercut_limit,
        "dedendum_1": pinion.dedendum,
        "fillet_1": pinion.fillet_radius,
        "land_1": pinion.root_land_angle,
        "involute_1": (pinion.tip_roll_length - pinion.form_roll_length) / module,
        "tip_2": rack.half_thickness(rack.tip) / module,
        "space_2": jnp.pi / 2.0 - rack.root_half_thickness / module,
        "fillet_2": rack.fillet_radius,
        "dedendum_2": rack.dedendum,
        "clearance_1": (mesh.distance - rack.root - pinion.tip_radius) / module,
        "clearance_2": (mesh.distance - rack.tip - pinion.root_radius) / module,
        "missing_1": (straight - (mesh.distance - rack.tip)) / module,
        "missing_2": (_reach(mesh) - (mesh.distance - rack.form)) / module,
        "transverse_ratio": line.transverse_contact_ratio,
        "contact_ratio": line.contact_ratio,
    }


def _straight(mesh: RackAndPinion) -> Float[Array, ""]:
    """Distance from the pinion's axis at which the straight flank of the rack that cuts it ends [m]."""
    pinion = mesh.pinion
    rounding = pinion.fillet_radius * (1.0 - jnp.sin(pinion.pressure_angle))
    return mesh.zero_backlash_distance - (pinion.dedendum - rounding) * pinion.module


def _reach(mesh: RackAndPinion) -> Float[Array, ""]:
    """Distance from the pinion's axis at which the path of contact ends on its tip circle [m]."""
    line = mesh.line
    return line.base_radius * jnp.cos(line.angle) + line.limits[1] * jnp.sin(line.angle)


def _teeth(at: SimpleNamespace) -> Iterator[Refusal]:
    yield (
        at.dedendum_1 <= at.fillet_1 or at.dedendum_2 <= at.fillet_2,
        "dedendum",
        f"the dedendum of pinion and rack, {at.dedendum_1:.4g} and {at.dedendum_2:.4g} modules, must be "
        f"larger than the fillet radius, {at.fillet_1:.4g} and {at.fillet_2:.4g} modules",
    )
    yield (
        at.root_radius <= 0.0,
        "dedendum",
        f"the root circle of the pinion has the diameter {2.0 * at.root_radius:.4g} modules; it must be "
        "positive",
    )
    yield (
        not at.land_1 > -1e-9 and at.fillet_1 == 0.0,
        "dedendum",
        f"the rack that cuts the pinion has no tip left at the dedendum {at.dedendum_1:.4g} modules; a "
        "smaller dedendum or pressure angle leaves one",
    )
    yield (
        not at.land_1 > -1e-9,
        "fillet_radius",
        f"the fillet radius of the pinion is {at.fillet_1:.4g} modules, but the tip of the rack that cuts it "
        "has no room for that",
    )
    yield (
        at.space_2 < -_ROUNDED_FILLET,
        "fillet_radius",
        f"the fillet radius of the rack is {at.fillet_2:.4g} modules, and two of them do not fit into a "
        "space between its teeth",
    )
    yield (
        at.tip_thickness < 0.0,
        "profile_shift",
        "the tip circle of the pinion lies beyond the point of its teeth, where the flanks cross; a smaller "
        "profile shift or addendum leaves a tip",
    )
    yield (
        at.tip_2 <= 0.0,
        "addendum",
        "the tips of the rack lie beyond the point of its teeth, where the flanks cross; allowed is an "
        "addendum that leaves a tip",
    )
    yield (
        not at.involute_1 > 0.0,
        "profile_shift",
        "no involute is left on the pinion between its form circle and its tip circle",
    )


def _meeting(at: SimpleNamespace) -> Iterator[Refusal]:
    yield (
        at.play < -_ROUNDED_DISTANCE,
        "mounting_distance",
        f"the flanks overlap at the mounting distance {1e3 * at.distance:.6g} mm; without backlash it is "
        f"{1e3 * at.nearest:.6g} mm, r + x m",
    )
    yield (
        at.play > _FAR and not at.contact_ratio >= 1.0,
        "mounting_distance",
        f"the teeth reach too little into each other at the mounting distance {1e3 * at.distance:.6g} mm; "
        f"without backlash it is {1e3 * at.nearest:.6g} mm, r + x m",
    )
    for number, member, mate in ((1, "pinion", "rack"), (2, "rack", "pinion")):
        yield (
            getattr(at, f"clearance_{number}") < 0.0,
            "dedendum",
            f"the tip of the {member} runs into the root of the {mate}: the tip clearance is "
            f"{getattr(at, f'clearance_{number}'):.4g} modules and must be positive",
        )
        missing = getattr(at, f"missing_{number}")
        yield (
            missing > _ROUNDED_FILLET,
            "addendum",
            f"the tip of the {mate} meets the fillet of the {member}, {missing:.3g} modules beyond its "
            f"flank; a shorter addendum of the {mate} or a larger dedendum of the {member} parts them",
        )
    yield (
        not 1.0 <= at.contact_ratio < LARGEST_CONTACT_RATIO,
        "addendum",
        f"the contact ratio of pinion and rack is {at.contact_ratio:.3g}; allowed are 1 to "
        f"{LARGEST_CONTACT_RATIO:g}, and longer addenda or more teeth raise it",
    )


def _warnings(at: SimpleNamespace) -> Iterator[str]:
    if at.tip_thickness < _THIN_TIP:
        yield Doubt(
            f"The teeth of the pinion are {at.tip_thickness:.3g} modules thick at the tip; at least "
            f"{_THIN_TIP:g} modules are usual.",
            brief=f"Thin tips of the pinion: {at.tip_thickness:.3g} modules.",
        )
    if at.shift < at.limit:
        yield Doubt(
            f"The flanks of the pinion are undercut; its profile shift {at.shift:.4g} is below the limit "
            f"{at.limit:.4g}.",
            brief=f"Undercut pinion: profile shift {at.shift:.4g}, limit {at.limit:.4g}.",
        )
    for name, clearance in (("pinion", at.clearance_1), ("rack", at.clearance_2)):
        if clearance < _SMALL_CLEARANCE * (1.0 - 1e-9):
            yield Doubt(
                f"The tip of the {name} clears the other's root by {clearance:.3g} modules; at least "
                f"{_SMALL_CLEARANCE:g} modules are usual.",
                brief=f"Small clearance under the tip of the {name}: {clearance:.3g} modules.",
            )
    if at.transverse_ratio < 1.0:
        yield Doubt(
            f"The transverse contact ratio of pinion and rack is {at.transverse_ratio:.3g}; it is the "
            "overlap ratio that keeps the teeth in contact.",
            brief=f"Transverse contact ratio {at.transverse_ratio:.3g}: the overlap keeps contact.",
        )
