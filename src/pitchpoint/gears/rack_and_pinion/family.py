"""A rack and pinion from its table in a case file."""

from collections.abc import Sequence
from dataclasses import replace
from math import cos, nan
from typing import Any

from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import lanes_for_contact_ratio
from pitchpoint.gears.family import Family
from pitchpoint.gears.involute import InvoluteGear, usual_depths
from pitchpoint.gears.layers import LAYERS, labels
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import MassInertia, disc
from pitchpoint.gears.rack_and_pinion import MEMBERS
from pitchpoint.gears.rack_and_pinion.checks import check_rack_and_pinion
from pitchpoint.gears.rack_and_pinion.mesh import RackAndPinion
from pitchpoint.gears.rack_and_pinion.rack import Rack
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears

__all__ = ["FAMILY"]

RIM_RATIO = 1.0 / 0.3
"""Root radius over bore radius of the pinion where no bore is given."""


def _build(gears: RackAndPinionGears, slices: int) -> tuple[Mesh, tuple[str, ...]]:
    mesh, limit, ratio = _complete(_mesh(gears, slices))
    if gears.profile_shift < float(limit):
        pinion = replace(mesh.pinion, undercut=True)
        mesh, _, ratio = _complete(replace(mesh, pinion=pinion))
    warnings = check_rack_and_pinion(mesh)
    mesh = replace(mesh, lanes=lanes_for_contact_ratio(float(ratio), helical=mesh.helical))
    return _bored(mesh, gears.bore_diameter), tuple(warnings)


def _mesh(gears: RackAndPinionGears, slices: int) -> RackAndPinion:
    """The mesh; a distance that follows from the pinion is NaN."""
    helical = gears.helix_angle > 0.0
    common = {"module": array(gears.module), "pressure_angle": array(gears.pressure_angle)}
    pinion, rack = _racks(gears)
    return RackAndPinion(
        pinion=InvoluteGear(
            teeth=array(gears.teeth),
            helix_angle=array(gears.helix_angle),
            profile_shift=array(gears.profile_shift),
            tip_alteration=array(0.0),
            undercut=False,
            crossing=array(gears.pressure_angle),
            internal=False,
            **common,
            **pinion,
        ),
        rack=Rack(**common, **rack),
        face_width=array(gears.face_width),
        distance=array(gears.mounting_distance or nan),
        rim_ratio=array(RIM_RATIO),
        moved_mass=array(gears.mass or nan),
        right_flank=array(gears.flank == "right"),
        helical=helical,
        lanes=2,
        slices=slices if helical else 1,
    )


def _racks(gears: RackAndPinionGears) -> list[dict[str, jax.Array]]:
    """Addendum, dedendum and rounding of the rack that cuts the pinion, and of the rack itself."""
    depths = _depths(gears)
    names = ("addendum", "dedendum", "fillet_radius")
    return [
        dict(zip(names, map(array, sizes), strict=True))
        for sizes in zip(gears.addendum, *depths, strict=True)
    ]


def _depths(gears: RackAndPinionGears) -> tuple[tuple[float, float], tuple[float, float]]:
    sizes = gears.addendum, gears.dedendum, gears.fillet_radius
    return usual_depths(*sizes, gears.pressure_angle)


@program
def _complete(
    mesh: RackAndPinion,
) -> tuple[RackAndPinion, Float[Array, ""], Float[Array, ""]]:
    """The mesh with the distance and the undercut that follow, undercut limit, contact ratio."""
    pinion = mesh.pinion
    if pinion.undercut:
        pinion = replace(pinion, crossing=pinion.crossing_angle())
    set_distance = mesh.distance
    distance = jnp.where(jnp.isnan(set_distance), mesh.zero_backlash_distance, set_distance)
    completed_mesh = replace(mesh, pinion=pinion, distance=distance)
    return completed_mesh, pinion.undercut_limit, completed_mesh.contact_ratio


def _bored(mesh: RackAndPinion, bore: float | None) -> RackAndPinion:
    """The mesh with the bore of its pinion; InputError for one that leaves no body."""
    root = 2.0 * float(mesh.pinion.root_radius)
    if bore is None:
        return mesh
    if bore >= root:
        raise InputError(
            f"the bore diameter of the pinion is {1e3 * bore:.6g} mm; it must be smaller than its root "
            f"circle, {1e3 * root:.6g} mm",
            key="bore_diameter",
        )
    return replace(mesh, rim_ratio=array(root / bore))


def _following(gears: RackAndPinionGears, mesh: RackAndPinion) -> dict[str, Any]:
    """Values that the table leaves open."""
    depth, fillet = _depths(gears)
    return {"dedendum": depth, "fillet_radius": fillet, "mounting_distance": mesh.distance}


def _bodies(
    gears: RackAndPinionGears, mesh: RackAndPinion, densities: Sequence[float]
) -> tuple[list[MassInertia], str]:
    """The pinion as a disc, as a vibration takes it, and what the rack moves as the case gives it."""
    pinion, moved = mesh.pinion, nan if gears.mass is None else gears.mass
    outer = gears.teeth * gears.module / (2.0 * cos(gears.helix_angle))
    root = outer - gears.module * (float(pinion.dedendum) - gears.profile_shift)
    inner = root / float(mesh.rim_ratio)
    pinion_disc = disc(density=densities[0], width=gears.face_width, outer=outer, inner=inner)
    assumption = (
        "The pinion is a disc from its bore to its reference circle; the mass of the rack and of all that "
        "moves with it is gears.mass."
    )
    return [pinion_disc, (moved, nan)], assumption


FAMILY = Family(
    _build,
    _following,
    bodies=_bodies,
    drawing={**LAYERS, "points": ("point",)},
    coordinates=labels(MEMBERS, ("N1",)),
)
