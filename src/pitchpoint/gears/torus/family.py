"""A torus-involute pair from its table in a case file."""

from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp
from pitchpoint.contact.surface import Surfaces
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.checks import check_cylindrical
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair, with_bores
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.family import Family, waves
from pitchpoint.gears.involute import usual_depths
from pitchpoint.gears.layers import LAYERS, labels
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import MassInertia, disc
from pitchpoint.gears.torus import MEMBERS
from pitchpoint.gears.torus.pair import TorusPair
from pitchpoint.gears.torus.table import TorusGears

__all__ = ["FAMILY", "middle_pair", "torus_pair"]

# What rounding leaves of no backlash [m].
_ROUNDED_BACKLASH = 1e-9


def _build(gears: TorusGears, slices: int) -> tuple[Mesh, tuple[str, ...]]:
    middle = middle_pair(gears)
    warnings = [*check_cylindrical(middle)]
    pair = torus_pair(gears, middle)
    _check_place(gears, pair)
    warnings += _jammed(pair)
    warnings += [text for text in _at_the_ends(gears, pair, middle) if text not in warnings]
    return pair, tuple(warnings)


def torus_pair(gears: TorusGears, middle: CylindricalPair) -> TorusPair:
    """The pair of a table.

    Args:
        gears: the table.
        middle: its transverse section in the middle of the face.
    """
    middle_values = {field.name: getattr(middle, field.name) for field in fields(InvolutePair)}
    radii = [
        -radius if concave else radius
        for radius, concave in zip(gears.torus_radius, gears.concave, strict=True)
    ]
    pair = TorusPair(
        **middle_values,
        torus_radii=array(radii),
        widths=array(gears.face_width),
        middle_shift=middle.profile_shift,
        axial_offset=array(gears.axial_offset),
        inclination=array(gears.inclination),
    )
    return _completed(pair)


@program
def _completed(pair: TorusPair) -> TorusPair:
    return pair.completed()


def middle_pair(gears: TorusGears) -> CylindricalPair:
    """The spur pair that the gears are in the middle of their faces.

    Args:
        gears: the table.
    """
    depth, fillet = _depths(gears)
    pair = build_cylindrical_pair(
        teeth=(int(gears.teeth[0]), int(gears.teeth[1])),
        module=gears.module,
        pressure_angle=gears.pressure_angle,
        face_width=min(gears.face_width),
        profile_shift=gears.middle_shift,
        addendum=gears.addendum,
        dedendum=depth,
        fillet_radius=fillet,
        centre_distance=gears.centre_distance,
        right_flank=gears.flank == "right",
    )
    return with_bores(pair, gears.bore_diameter)


def _depths(gears: TorusGears) -> tuple[tuple[float, float], tuple[float, float]]:
    sizes = gears.addendum, gears.dedendum, gears.fillet_radius
    return usual_depths(*sizes, gears.pressure_angle)


def _check_place(gears: TorusGears, pair: TorusPair) -> None:
    """InputError where misalignment moves the contact off the faces."""
    if float(pair.contact_room) > 0.0:
        return
    mate, place = pair.faces[1], pair.place
    by_offset = abs(float(mate.slope(place) - mate.slope(place - pair.axial_offset)))
    key = "inclination" if abs(gears.inclination) > by_offset else "axial_offset"
    raise InputError(
        f"misalignment moves the contact off the faces, {1e3 * gears.face_width[0]:.4g} and "
        f"{1e3 * gears.face_width[1]:.4g} mm wide; a smaller misalignment or torus radii that differ "
        "more keep it on them",
        key=key,
    )


def _jammed(pair: TorusPair) -> list[str]:
    """A warning where misalignment takes more than the backlash."""
    backlash = float(_backlash(pair))
    if backlash > -_ROUNDED_BACKLASH or not float(pair.misalignment_approach):
        return []
    return [
        f"Misalignment takes {-1e6 * backlash:.3g} um more than the backlash along the normal that the pair "
        "has: both flanks of the teeth press, and these figures leave the other ones out; a larger centre "
        "distance parts them."
    ]


@program
def _backlash(pair: TorusPair) -> Float[Array, ""]:
    return pair.normal_backlash


def _at_the_ends(gears: TorusGears, pair: TorusPair, middle: CylindricalPair) -> Iterator[str]:
    """Warnings for the teeth at the ends of the common face; InputError where they cannot be made."""
    _check_tips(gears, pair, middle)
    ends = array(min(gears.face_width) / 2.0)
    added_shift = jnp.stack([face.shift(ends) for face in pair.faces]) / pair.module
    end = replace(middle, profile_shift=middle.profile_shift + added_shift)
    try:
        warnings = check_cylindrical(end)
    except InputError as error:
        raise InputError(f"at the ends of the face, {error.message}", key="face_width") from None
    for text in warnings:
        yield f"At the ends of the face: {text}"


def _check_tips(gears: TorusGears, pair: TorusPair, middle: CylindricalPair) -> None:
    """InputError where the teeth of a gear are pointed at the ends of its own face."""
    for number, (gear, face, width) in enumerate(
        zip(middle.gears, pair.faces, gears.face_width, strict=True), 1
    ):
        shift = gear.profile_shift + face.shift(array(width / 2.0)) / gear.module
        if float(replace(gear, profile_shift=shift).tip_thickness) < 0.0:
            raise InputError(
                f"the teeth of gear {number} are pointed at the ends of its face of {1e3 * width:.4g} mm, "
                f"where its profile shift is {float(shift):.3g}; a narrower face or a larger torus radius "
                "leaves tips",
                key="face_width",
            )


def _following(gears: TorusGears, pair: TorusPair) -> dict[str, Any]:
    """Values that the table leaves open."""
    depth, fillet = _depths(gears)
    reference = jnp.stack([gear.reference_radius for gear in pair.gears])
    return {
        "dedendum": depth,
        "fillet_radius": fillet,
        "centre_distance": pair.centre_distance,
        "profile_shift": pair.middle_shift,
        "torus_offset": reference + pair.middle_shift * pair.module - pair.torus_radii,
    }


def _deviations(gears: TorusGears, pair: TorusPair) -> Surfaces:
    deviations = gears.deviations
    return (
        (waves(deviations.gear_1), waves(deviations.gear_2)) if deviations is not None else ((), ())
    )


def _bodies(
    gears: TorusGears, pair: TorusPair, densities: Sequence[float]
) -> tuple[list[MassInertia], str]:
    """Discs as wide as the face of each gear, as a vibration takes them."""
    discs, shifts, depths = [], np.asarray(pair.middle_shift), np.asarray(pair.dedendum)
    for number, (teeth, width) in enumerate(zip(gears.teeth, gears.face_width, strict=True)):
        outer = teeth * gears.module / 2.0
        root = outer - gears.module * float(depths[number] - shifts[number])
        inner = root / float(np.asarray(pair.rim_ratio)[number])
        discs.append(disc(density=densities[number], width=width, outer=outer, inner=inner))
    return discs, "Discs as wide as the face of each gear, from the bore to the reference circle."


FAMILY = Family(
    _build,
    _following,
    _deviations,
    bodies=_bodies,
    drawing={**LAYERS, "points": ("point",)},
    coordinates=labels(MEMBERS, ("N1", "N2")),
)
