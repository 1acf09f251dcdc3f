"""A strain wave gear from its table in a case file."""

from collections.abc import Sequence
from dataclasses import fields, replace
from math import inf, pi
from typing import Any

from pitchpoint.contact.surface import Surfaces
from pitchpoint.errors import InputError
from pitchpoint.gears.family import Family, Followed, Records, Solids, Turning, waves
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import MassInertia, combined_inertia, disc
from pitchpoint.gears.strain_wave.ball_bearing import Balls, ball_circle
from pitchpoint.gears.strain_wave.design import (
    InvoluteForm,
    build_strain_wave,
    check_rim,
    check_strain_wave,
)
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.in_series import Behind, part_dimensions
from pitchpoint.gears.strain_wave.proportions import PROPORTIONS
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS, DoubleArcForm
from pitchpoint.gears.strain_wave.table import (
    BallBearing,
    DoubleArcTooth,
    InvoluteGroove,
    InvoluteTooth,
    StrainWaveGears,
    Yielding,
)

__all__ = ["FAMILY"]

_KEYS = {
    "form": "tooth",
    "groove": "circular_spline",
    "shape": "wave_generator.weights",
    "deflection": "wave_generator.deflection",
    "force_angle": "wave_generator.force_angle",
    "flange_diameter": "yielding.flange_diameter",
    "bolt_circle": "yielding.bolt_circle",
    "shaft_diameter": "yielding.shaft_diameter",
    "balls": "wave_generator.bearing.balls",
    "ball_diameter": "wave_generator.bearing.ball_diameter",
    "play": "wave_generator.bearing.play",
    "outside_diameter": "yielding.outside_diameter",
}
"""Keys of the table by arguments of the builder that have other names."""


def _strain_wave(gears: StrainWaveGears, slices: int) -> tuple[Mesh, tuple[str, ...]]:
    wave, cup, groove = gears.wave_generator, gears.flexspline, gears.circular_spline
    try:
        drive = build_strain_wave(
            teeth=(int(gears.teeth[0]), int(gears.teeth[1])),
            module=gears.module,
            face_width=gears.face_width,
            form=_form(gears.tooth),
            shape=wave.weights or wave.shape,
            deflection=wave.deflection,
            force_angle=wave.force_angle,
            rim_thickness=cup.rim_thickness,
            wall_thickness=cup.wall_thickness,
            walls=cup.walls,
            cup_length=cup.cup_length,
            support_stiffness=inf if cup.support_stiffness is None else cup.support_stiffness,
            bearing=None if wave.bearing is None else _balls(wave.bearing),
            behind=None if gears.yielding is None else _behind(gears.yielding),
            clearance=gears.clearance,
            disengagement=gears.disengagement,
            tip_rounding=gears.tip_rounding,
            tip_relief=gears.tip_relief,
            relief_length=gears.relief_length,
            bottom_clearance=gears.bottom_clearance,
            edges_carry=gears.edges == "carry",
            backlash=gears.backlash,
            groove=_involute(groove) if isinstance(groove, InvoluteGroove) else None,
        )
    except InputError as error:
        key = error.key or ""
        raise error.at(key=_KEYS.get(key, key)) from None
    return drive, check_strain_wave(drive)


def _balls(table: BallBearing) -> Balls:
    return Balls(table.balls, table.ball_diameter, table.race_thickness, table.play)


def _behind(table: Yielding) -> Behind:
    return Behind(**{field.name: getattr(table, field.name) for field in fields(Behind)})


def _form(tooth: DoubleArcTooth | InvoluteTooth) -> DoubleArcForm | InvoluteForm:
    if isinstance(tooth, InvoluteTooth):
        return _involute(tooth)
    tooth_values = {field.name: getattr(tooth, field.name) for field in fields(DoubleArcForm)}
    chosen = {name: value for name, value in tooth_values.items() if value is not None}
    return replace(DOUBLE_ARCS[tooth.set or _USUAL_SET], **chosen)


_USUAL_SET = "liu"


def _involute(table: InvoluteTooth | InvoluteGroove) -> InvoluteForm:
    return InvoluteForm(
        **{field.name: getattr(table, field.name) for field in fields(InvoluteForm)}
    )


def _of_drive(gears: StrainWaveGears, drive: StrainWave) -> dict[str, Any]:
    form = _form(gears.tooth)
    return {
        **{f"tooth.{field.name}": getattr(form, field.name) for field in fields(form)},
        **_of_walls(gears, drive),
        **_of_parts(gears, drive),
    }


def _of_cup(drive: StrainWave, solids: Solids, records: Records) -> tuple[str, ...]:
    """Sentences on a rim by the material of the flexspline."""
    tensile = records[0].tensile_strength
    return check_rim(drive, float(solids[0].young), None if tensile is None else tensile.value)


_RIMS = {
    "two modules": (
        "two modules",
        "rim and wall follow from the module, so that another ratio of the same size has other walls",
    ),
} | dict.fromkeys(
    ("bending strain", "bending strain of plastic"),
    (
        "by the strain of its wave, at most in proportion to the size",
        "rim and wall follow from the wave, so that a lower ratio of the same size has thinner walls",
    ),
)
"""Rule of the rim's thickness, and how it changes with the ratio."""


def _of_walls(gears: StrainWaveGears, drive: StrainWave) -> dict[str, Followed]:
    """Rim and cup where the table leaves them open."""
    rim = drive.rim
    return {
        "flexspline.rim_thickness": Followed(
            rim.thickness, "assumed", *_RIMS[gears.flexspline.walls]
        ),
        "flexspline.wall_thickness": Followed(rim.wall_thickness, "assumed", "half of the rim"),
        "flexspline.cup_length": Followed(rim.cup_length, "assumed", "half of the pitch diameter"),
    }


def _of_parts(gears: StrainWaveGears, drive: StrainWave) -> dict[str, Followed]:
    """Dimensions of bearing and of what yields behind the teeth, where their tables leave them open."""
    diameter, bearing, behind = (
        gears.module * gears.teeth[0],
        gears.wave_generator.bearing,
        gears.yielding,
    )
    size_by_key: dict[str, float] = {}
    if bearing is not None:
        sizes = _balls(bearing).sizes(diameter)
        size_by_key |= {f"wave_generator.bearing.{key}": value for key, value in sizes.items()}
    if behind is not None:
        sizes = part_dimensions(_behind(behind), diameter, float(drive.rim.thickness))
        size_by_key |= {f"yielding.{key}": value for key, value in sizes.items()}
    return {
        key: Followed(value, "assumed", _rule(key, value / diameter))
        for key, value in size_by_key.items()
    }


def _rule(key: str, part: float) -> str:
    """How a dimension behind the teeth was come by, from its part of the pitch diameter."""
    name = key.rpartition(".")[2]
    if name == "bottom_thickness":
        return "as thick as the rim"
    return "a usual number" if name in ("balls", "bolts") else f"{part:.4g} of the pitch diameter"


def _deviations(gears: StrainWaveGears, drive: StrainWave) -> Surfaces:
    deviations = gears.deviations
    return waves(deviations.flexspline), waves(deviations.circular_spline)


def _bodies(
    gears: StrainWaveGears, drive: StrainWave, densities: Sequence[float]
) -> tuple[list[MassInertia], str]:
    """Wave generator, flexspline and circular spline of rings, tubes and discs."""
    pitch, width = gears.module * gears.teeth[0], gears.face_width
    rim, assumption = (
        drive.rim,
        (_IN_PARTS if gears.flexspline.rim_thickness else f"{_IN_PARTS} {_USUAL}"),
    )
    radius, thickness = float(rim.radius), float(rim.thickness)
    sizes = _sizes(gears, thickness)
    flexspline_density, spline_density = densities
    wall, length = float(rim.wall_thickness), float(rim.cup_length)
    within = radius - thickness / 2.0
    flexspline = [
        disc(density=flexspline_density, width=width, outer=pitch / 2.0, inner=within),
        disc(density=flexspline_density, width=length, outer=within + wall, inner=within),
        disc(density=flexspline_density, width=sizes["bottom_thickness"], outer=within, inner=0.0),
    ]
    outer, inner = sizes["outside_diameter"] / 2.0, gears.module * gears.teeth[1] / 2.0
    spline = disc(density=spline_density, width=width, outer=outer, inner=inner)
    wave = _wave_generator(gears, within, sizes["shaft_diameter"] / 2.0, flexspline_density)
    return [wave, combined_inertia(flexspline), spline], assumption


def _sizes(gears: StrainWaveGears, thickness: float) -> dict[str, float]:
    """Dimensions behind the teeth, by name [m], of a rim of that thickness."""
    pitch = gears.module * gears.teeth[0]
    sizes = PROPORTIONS.behind(pitch) | {"bottom_thickness": thickness}
    if gears.yielding is not None:
        sizes |= part_dimensions(_behind(gears.yielding), pitch, thickness)
    return sizes


def _envelope(gears: StrainWaveGears, drive: StrainWave) -> tuple[float, float]:
    """Outer diameter of the circular spline, and the length of the cup [m]."""
    sizes = _sizes(gears, float(drive.rim.thickness))
    return sizes["outside_diameter"], float(drive.rim.cup_length)


def _wave_generator(
    gears: StrainWaveGears, within: float, shaft: float, density: float
) -> MassInertia:
    """A plug with the inner race, balls that go round with half its speed about, an outer race that rests.

    Args:
        gears: table.
        within: radius inside the rim [m].
        shaft: radius of the shaft [m].
        density: of the plug [kg/m3].
    """
    pitch, width = gears.module * gears.teeth[0], gears.face_width
    table = gears.wave_generator.bearing
    balls = Balls() if table is None else _balls(table)
    sizes = balls.sizes(pitch)
    circle, ball = ball_circle(balls, pitch, 2.0 * within), sizes["ball_diameter"]
    mass, inertia = disc(density=density, width=width, outer=(circle - ball) / 2.0, inner=shaft)
    race, _ = disc(
        density=_STEEL, width=width, outer=within, inner=within - sizes["race_thickness"]
    )
    rolling = sizes["balls"] * _STEEL * pi / 6.0 * ball**3
    cage = (1.0 - ball / circle) / 2.0
    return mass + race + rolling, inertia + rolling * (cage * circle / 2.0) ** 2


_STEEL = 7830.0
"""Of balls and races [kg/m3], whatever the flexspline is made of."""

_IN_PARTS = (
    "The wave generator is a plug of the flexspline's material as wide as the teeth, with balls and outer "
    "race of steel; its moment of inertia is what its shaft feels, with the balls at their own speed and the "
    "outer race at rest. The flexspline is a toothed ring, a tube and a bottom, the circular spline a ring. "
    "Bosses, screws and couplings are not in it."
)
_USUAL = "Dimensions that the case leaves open are in usual proportion to the pitch diameter."


FAMILY = Family(
    _strain_wave,
    _of_drive,
    _deviations,
    Turning(
        "one turn of the wave generator",
        "wave generator against circular spline",
        "turn against the {}",
        "one turn of the wave generator against it",
        "In each turn of the wave generator one spline moves on against the other by the tooth "
        "difference, so that the errors of both add up differently in later turns; those of one "
        "spline alone, shown by order, stay as they are.",
    ),
    bodies=_bodies,
    envelope=_envelope,
    of_materials=_of_cup,
    drawing={
        "tooth": ("corner", "xy"),
        "space": ("space_corner", "xy"),
        "passing_angle": ("place",),
        "passing": ("place", "corner", "xy"),
        "wave_weights": ("wave",),
        "clearance_angle": ("angle",),
        "clearance": ("angle",),
    },
    coordinates={"gear": [1, 2], "xy": ["x", "y"]},
)
