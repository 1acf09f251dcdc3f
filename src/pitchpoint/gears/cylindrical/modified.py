"""Modifications and deviations of the flanks of a cylindrical pair, from what a drawing says of them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos
from typing import Any

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp
from pitchpoint.contact.deviations import ToothDeviations
from pitchpoint.contact.modifications import Crowning, EndRelief, LeadSlope, Relief
from pitchpoint.contact.surface import FlankEnds, Surface, Surfaces
from pitchpoint.core.doubts import GUESSED, Doubt
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances, gear_at_its_limits, out_of_scope
from pitchpoint.gears.cylindrical.pair import CylindricalPair

__all__ = ["FEWEST_SLICES", "Modifications", "class_deviations", "class_warnings", "modified"]

FEWEST_SLICES = 4
"""Slices that surfaces which change across the face need at least."""

Two = tuple[float, float]


@dataclass(frozen=True)
class Modifications:
    """Modifications of both gears along the normal of their flanks, SI; None for what neither has.

    Attributes:
        tip_relief, root_relief: C_αa at the tip circle and C_αf at the start of the active profile [m].
        tip_relief_length, root_relief_length: roll lengths from there [m]. None: up to where one pair less
            is in contact, the fraction of the contact ratio in base pitches.
        relief_power: of all reliefs, 1 for linear ones, 2 for parabolic ones.
        crowning: C_β at the ends of the face [m].
        end_relief: C_βI = C_βII at the ends of the face [m].
        end_relief_length: of each along the face [m]. None: a module, at most a tenth of the face.
        misalignment: f_Σβ over the face; positive where flanks part at its end z > 0 [m].

    Source: ISO 21771:2007, relief of tip, root and ends, and crowning.
    """

    tip_relief: Two | None = None
    tip_relief_length: Two | None = None
    root_relief: Two | None = None
    root_relief_length: Two | None = None
    relief_power: int = 1
    crowning: Two | None = None
    end_relief: Two | None = None
    end_relief_length: Two | None = None
    misalignment: float | None = None

    @property
    def along_lead(self) -> bool:
        """True if something changes across the face."""
        return any(
            amount is not None for amount in (self.crowning, self.end_relief, self.misalignment)
        )

    def completed(self, pair: CylindricalPair) -> "Modifications":
        """The same with lengths that were left open.

        Args:
            pair: of which the flanks are.
        """
        overlap, end = (float(value) for value in _usual_lengths(pair))
        usual = {"tip_relief": overlap, "root_relief": overlap, "end_relief": end}
        lengths: dict[str, Any] = {
            f"{name}_length": (length, length)
            for name, length in usual.items()
            if getattr(self, name) is not None and getattr(self, f"{name}_length") is None
        }
        return replace(self, **lengths)


def modified(pair: CylindricalPair, given: Modifications, slices: int) -> CylindricalPair:
    """A pair whose flanks have modifications; those of the lead with slices across the face.

    What is given is there even if its amount is zero, so that a sweep keeps one program.

    Args:
        pair: of involute flanks.
        given: modifications of both gears.
        slices: across the face, where something changes across it; even.

    Raises:
        InputError: a relief longer than the flank or the face, or too few slices; with its key.
    """
    given = given.completed(pair)
    flanks = np.asarray(_active_flanks(pair))
    for key in ("tip_relief", "root_relief"):
        _check_lengths(key, given, flanks)
    _check_face(given, float(pair.face_width))
    if given.along_lead and slices < FEWEST_SLICES:
        raise InputError(
            f"changes across the face, and {slices} slices do not show that; set models.slices to "
            f"{FEWEST_SLICES} or more",
            key=_first_along_lead(given),
        )
    pinion_surfaces, wheel_surfaces = (_of_gear(pair, given, flanks, member) for member in (0, 1))
    across = given.along_lead and not pair.helical
    return replace(
        pair, surfaces=(pinion_surfaces, wheel_surfaces), slices=slices if across else pair.slices
    )


def _of_gear(
    pair: CylindricalPair, given: Modifications, flanks: np.ndarray, member: int
) -> tuple[Surface, ...]:
    """Surfaces of one gear in a fixed order, so that the same keys make the same program."""
    surfaces: list[Surface] = [*_reliefs(pair, given, flanks, member)]
    width = pair.face_width
    if given.crowning is not None:
        surfaces.append(Crowning(array(given.crowning[member]), width))
    if given.end_relief is not None and given.end_relief_length is not None:
        amount, length = given.end_relief[member], given.end_relief_length[member]
        surfaces.append(EndRelief(array(amount), array(length), width, given.relief_power))
    if given.misalignment is not None and member == 0:
        surfaces.append(LeadSlope(array(given.misalignment), width))
    return tuple(surfaces)


def _reliefs(
    pair: CylindricalPair, given: Modifications, flanks: np.ndarray, member: int
) -> Iterator[Relief]:
    root, tip = (array(float(end)) for end in flanks[member])
    arcs = array(2.0 * abs(float(pair.base_radii[member])))
    flank = FlankEnds(root, tip, arcs, pair.face_width)
    for amounts, lengths, at_tip in (
        (given.tip_relief, given.tip_relief_length, True),
        (given.root_relief, given.root_relief_length, False),
    ):
        if amounts is not None and lengths is not None:
            amount, length = array(amounts[member]), array(lengths[member])
            yield Relief.over(amount, length, flank, given.relief_power, at_tip)


def _check_lengths(key: str, given: Modifications, flanks: np.ndarray) -> None:
    lengths = getattr(given, f"{key}_length")
    if getattr(given, key) is None or lengths is None:
        return
    for number, (length, (root, tip)) in enumerate(zip(lengths, flanks, strict=True), 1):
        flank_length = abs(tip - root)
        if not 0.0 < length <= flank_length * (1.0 + 1e-9):
            raise InputError(
                f"the {key.replace('_', ' ')} of gear {number} is {1e3 * length:.4g} mm long; its active "
                f"flank has a roll length of {1e3 * flank_length:.4g} mm, which it may take at most",
                key=f"modifications.{key}_length",
            )


def _check_face(given: Modifications, width: float) -> None:
    for number, length in enumerate(given.end_relief_length or (), 1):
        if length > width / 2.0:
            raise InputError(
                f"the end relief of gear {number} takes {1e3 * length:.4g} mm at each end; allowed is half "
                f"the face width, {1e3 * width / 2.0:.4g} mm",
                key="modifications.end_relief_length",
            )


def _first_along_lead(given: Modifications) -> str:
    if given.crowning is not None:
        return "modifications.crowning"
    return "modifications.end_relief" if given.end_relief is not None else "misalignment"


@program
def _active_flanks(pair: CylindricalPair) -> Float[Array, "2 2"]:
    return pair.active_flanks


@program
def _usual_lengths(pair: CylindricalPair) -> tuple[Float[Array, ""], Float[Array, ""]]:
    ratio = pair.transverse_contact_ratio
    end = jnp.minimum(0.1 * pair.face_width, pair.module)
    return (ratio - jnp.floor(ratio)) * pair.base_pitch, end


def class_deviations(
    pair: CylindricalPair,
    classes: Two,
    seed: int,
    *,
    shares: Two = (1.0, 1.0),
    helix: bool = True,
) -> Surfaces:
    """Flanks of two gears at the limits of their classes, drawn at random.

    Deviations of the standard lie along the reference circle and along the transverse line of action;
    surfaces count along the normal.

    Args:
        pair: of which the flanks are.
        classes: of ISO 1328-1, of each gear.
        seed: the same one gives the same gears.
        shares: of these limits that each gear reaches.
        helix: False for teeth without helix slopes of their own.
    """
    flanks = np.asarray(_active_flanks(pair))
    normal = float(jnp.cos(pair.base_helix_angle))
    upright = normal * float(jnp.cos(pair.transverse_pressure_angle))
    by_gear = []
    for member, (size, teeth) in enumerate(_sizes(pair)):
        limits = flank_tolerances(tolerance_class=int(classes[member]), **size)
        errors = gear_at_its_limits(limits, teeth, (seed, member))
        root, tip = flanks[member] ** 2 / (2.0 * abs(float(pair.base_radii[member])))
        share = shares[member]
        across, along = upright * share, normal * share
        deviations = ToothDeviations(
            pitch=array(across * errors.pitch),
            profile_slope=array(along * errors.profile_slope),
            lead_slope=array(along * helix * errors.helix_slope),
            profile_form=array(along * errors.profile_form),
            lead_form=array(along * errors.helix_form),
            root=array(root),
            tip=array(tip),
            width=pair.face_width,
        )
        by_gear.append(deviations)
    return (by_gear[0],), (by_gear[1],)


def class_warnings(pair: CylindricalPair) -> tuple[str, ...]:
    """Where the gears lie outside the ranges of ISO 1328-1."""
    helix = float(pair.helix_angle)
    reasons = [
        ", ".join(out_of_scope(teeth=teeth, helix_angle=helix, **size))
        for size, teeth in _sizes(pair)
    ]
    return tuple(
        Doubt(
            f"ISO 1328-1 does not hold for gear {number}: {outside}.",
            moves=GUESSED,
            brief=f"Deviations of gear {number} lie outside ISO 1328-1.",
        )
        for number, outside in enumerate(reasons, 1)
        if outside
    )


def _sizes(pair: CylindricalPair) -> list[tuple[dict[str, float], int]]:
    """Reference diameter, module and face width [m] that the standard asks for, and number of teeth."""
    module, width, helix = (float(v) for v in (pair.module, pair.face_width, pair.helix_angle))
    return [
        ({"diameter": z * module / cos(helix), "module": module, "face_width": width}, z)
        for z in (round(abs(float(teeth))) for teeth in pair.teeth)
    ]
