"""Gears of every family from their table in a case file; nothing downstream asks for the family."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from math import ceil, cos, inf, pi, sin, tan
from typing import Any

import numpy as np

from pitchpoint._jax import array, jnp
from pitchpoint.cases.gear_tables import (
    BallOnDiscRig,
    CylindricalGears,
    Deviation,
    DoubleArcTooth,
    InvoluteGroove,
    InvoluteTooth,
    StrainWaveGears,
)
from pitchpoint.contact.surface import Surfaces, Waves
from pitchpoint.errors import InputError
from pitchpoint.gears.ball_on_disc.mesh import BallOnDisc
from pitchpoint.gears.cylindrical.checks import check_cylindrical
from pitchpoint.gears.cylindrical.modified import (
    Modifications,
    class_deviations,
    class_warnings,
    modified,
)
from pitchpoint.gears.cylindrical.pair import CylindricalPair, build_cylindrical_pair
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.strain_wave.design import (
    DOUBLE_ARCS,
    DoubleArcForm,
    InvoluteForm,
    build_strain_wave,
    check_strain_wave,
)
from pitchpoint.gears.strain_wave.drive import StrainWave

__all__ = ["FAMILIES", "Family", "built_gears"]

_AVAILABLE_FILLET = 0.38
USUAL_TIP = 0.25
"""Tip thickness of helical teeth that is kept where none is given, in normal modules."""
_RING_FILLET = 0.2  # fits the narrow spaces of most rings


@dataclass(frozen=True)
class Turning:
    """Words of the turns over which deviations make a kinematic error.

    Attributes:
        whole: the turn over which both members are shown together; {} is the member with the most teeth.
        angle: what turns there.
        own: the turn of one member, {}, over which orders are counted.
        alone: that turn where the member was named before.
        note: how the errors of both members add up.
    """

    whole: str = "one turn of {}"
    angle: str = "angle of {}"
    own: str = "turn of {}"
    alone: str = "one turn of it"
    note: str = (
        "Other teeth meet in each turn of a gear, so that the errors of both add up differently in later "
        "turns; those of one gear alone, shown by order, stay as they are."
    )


@dataclass(frozen=True)
class Family:
    """What a case asks of a family beside what every mesh answers.

    Attributes:
        sample: file of a case with every table that analyses ask for, in `cases/samples`.
        build: mesh and warnings from the table, the name of the driver and the number of slices.
        following: values that the table leaves open, as the mesh has them, by key inside the table.
        deviations: of the teeth around both members, from the table and the mesh.
        turning: words of a turn around which they repeat themselves.
        drawing: dimensions of the arrays of a drawing.
        coordinates: labels along those dimensions.
    """

    sample: str
    build: Callable[[Any, str, int], tuple[Mesh, tuple[str, ...]]]
    following: Callable[[Any, Any], dict[str, Any]]
    deviations: Callable[[Any, Any], Surfaces] = lambda gears, mesh: ((), ())
    turning: Turning = Turning()
    drawing: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    coordinates: Mapping[str, Any] = field(default_factory=dict)


@lru_cache(maxsize=256)
def built_gears(
    gears: CylindricalGears | StrainWaveGears | BallOnDiscRig, driver: str, slices: int
) -> tuple[Mesh, tuple[str, ...]]:
    """Mesh and its warnings; a sweep that leaves the gears alone builds them once.

    Raises:
        InputError: gears that cannot run, with the key inside their table.
    """
    return FAMILIES[type(gears)].build(gears, driver, slices)


def _cylindrical(gears: CylindricalGears, driver: str, slices: int) -> tuple[Mesh, tuple[str, ...]]:
    pair = _pair(gears, driver=2 if driver == "gear 2" else 1, slices=slices)
    told = (*check_cylindrical(pair), *_shortened(pair, gears), *_beyond_iso_1328(pair, gears))
    return _with_flanks(pair, gears, slices), told


def _with_flanks(pair: CylindricalPair, gears: CylindricalGears, slices: int) -> CylindricalPair:
    """The pair with the modifications of its flanks; deviations of the lead need slices too."""
    given = _modifications(gears)
    if given is not None:
        return modified(pair, given, slices)
    by_class = gears.deviations is not None and gears.deviations.iso_class is not None
    return replace(pair, slices=slices) if by_class else pair


def _modifications(gears: CylindricalGears) -> Modifications | None:
    table, slope = gears.modifications, gears.misalignment
    if table is None or not table.amounts:
        return None if slope is None else Modifications(misalignment=slope)
    given = {key: getattr(table, key) for key in type(table).model_fields if key != "relief_shape"}
    power = 2 if table.relief_shape == "parabolic" else 1
    return Modifications(**given, relief_power=power, misalignment=slope)


def _beyond_iso_1328(pair: CylindricalPair, gears: CylindricalGears) -> tuple[str, ...]:
    asked = gears.deviations
    return class_warnings(pair) if asked is not None and asked.iso_class is not None else ()


def _gear_deviations(gears: CylindricalGears, pair: CylindricalPair) -> Surfaces:
    asked = gears.deviations
    if asked is None:
        return (), ()
    first, second = _waves(asked.gear_1), _waves(asked.gear_2)
    if asked.iso_class is None:
        return first, second
    drawn = class_deviations(pair, asked.iso_class, int(asked.seed))
    return (*first, *drawn[0]), (*second, *drawn[1])


def _least_tip(gears: CylindricalGears) -> float:
    """Tip thickness that is kept, in modules: helical teeth are few more often, and then pointed."""
    if gears.least_tip_thickness is not None:
        return gears.least_tip_thickness
    return USUAL_TIP if gears.helix_angle > 0.0 else 0.0


def _shortened(pair: CylindricalPair, gears: CylindricalGears) -> list[str]:
    """What was taken off tips that nobody asked to shorten."""
    if gears.least_tip_thickness is not None:
        return []
    kept = float(pair.clearance_keeping_tip_alteration) if any(pair.shortened) else 0.0
    return [
        f"The tip of gear {number} would be thinner than {USUAL_TIP:g} modules and is shortened by "
        f"{kept - float(pair.tip_alteration[number - 1]):.3g} modules; least_tip_thickness sets the limit."
        for number, short in enumerate(pair.shortened, 1)
        if short
    ]


def _pair(gears: CylindricalGears, driver: int, slices: int) -> CylindricalPair:
    dedendum = gears.dedendum or (gears.addendum[0] + 0.25, gears.addendum[1] + 0.25)
    fillet = gears.fillet_radius or tuple(
        _RING_FILLET
        if teeth < 0
        else min(_AVAILABLE_FILLET, _largest_fillet(depth, gears.pressure_angle))
        for teeth, depth in zip(gears.teeth, dedendum, strict=True)
    )
    pair = build_cylindrical_pair(
        teeth=(int(gears.teeth[0]), int(gears.teeth[1])),
        module=gears.module,
        pressure_angle=gears.pressure_angle,
        helix_angle=gears.helix_angle,
        face_width=gears.face_width,
        profile_shift=gears.profile_shift,
        addendum=gears.addendum,
        dedendum=dedendum,
        fillet_radius=(fillet[0], fillet[1]),
        tip_alteration=gears.tip_alteration,
        least_tip=_least_tip(gears),
        centre_distance=gears.centre_distance,
        driver=driver,
        right_flank=gears.flank == "right",
        slices=slices,
    )
    if gears.bore_diameter is None:
        return pair
    return replace(pair, rim_ratio=jnp.asarray(_rim_ratios(pair, gears.bore_diameter)))


def _rim_ratios(pair: CylindricalPair, bores: tuple[float, float]) -> list[float]:
    """Root over bore radius of each gear; of a ring its outer radius over the root radius."""
    found = []
    for number, (gear, bore) in enumerate(zip(pair.gears, bores, strict=True), 1):
        root = 2.0 * abs(float(gear.root_radius))
        ratio = bore / root if gear.internal else root / bore
        if ratio <= 1.0:
            side = "larger" if gear.internal else "smaller"
            raise InputError(
                f"the bore diameter of gear {number} is {1e3 * bore:.6g} mm; it must be {side} than "
                f"its root circle, {1e3 * root:.6g} mm",
                key="bore_diameter",
            )
        found.append(ratio)
    return found


def _largest_fillet(dedendum: float, angle: float) -> float:
    """Corner rounding of the rack that leaves no flat on its tip, in modules (ISO 53)."""
    return max((pi / 4 - dedendum * tan(angle)) * cos(angle) / (1.0 - sin(angle)), 0.0)


_FOLLOWING = {
    "dedendum": "dedendum",
    "fillet_radius": "fillet_radius",
    "tip_alteration": "tip_alteration",
    "centre_distance": "centre_distance",
    "least_tip_thickness": "least_tip",
}


def _of_pair(gears: CylindricalGears, pair: CylindricalPair) -> dict[str, Any]:
    found = {key: getattr(pair, name) for key, name in _FOLLOWING.items()}
    given = _modifications(gears)
    if given is not None:
        lengths = given.completed(pair)
        found |= {f"modifications.{key}": getattr(lengths, key) for key in _LENGTHS}
    return found


_LENGTHS = ("tip_relief_length", "root_relief_length", "end_relief_length")


_KEYS = {
    "form": "tooth",
    "groove": "circular_spline",
    "shape": "wave_generator.weights",
    "deflection": "wave_generator.deflection",
    "force_angle": "wave_generator.force_angle",
}
"""Keys of the table by arguments of the builder that have other names."""


def _strain_wave(gears: StrainWaveGears, driver: str, slices: int) -> tuple[Mesh, tuple[str, ...]]:
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
            cup_length=cup.cup_length,
            support_stiffness=inf if cup.support_stiffness is None else cup.support_stiffness,
            clearance=gears.clearance,
            tip_rounding=gears.tip_rounding,
            backlash=gears.backlash,
            fixed=gears.fixed,
            driver=driver,
            groove=_involute(groove) if isinstance(groove, InvoluteGroove) else None,
        )
    except InputError as error:
        key = error.key or ""
        raise error.at(key=_KEYS.get(key, key)) from None
    return drive, check_strain_wave(drive)


def _form(tooth: DoubleArcTooth | InvoluteTooth) -> DoubleArcForm | InvoluteForm:
    if isinstance(tooth, InvoluteTooth):
        return _involute(tooth)
    own = {one.name: getattr(tooth, one.name) for one in fields(DoubleArcForm)}
    given = {name: value for name, value in own.items() if value is not None}
    return replace(DOUBLE_ARCS[tooth.set or _USUAL_SET], **given)


_USUAL_SET = "liu"


def _involute(table: InvoluteTooth | InvoluteGroove) -> InvoluteForm:
    return InvoluteForm(**{one.name: getattr(table, one.name) for one in fields(InvoluteForm)})


def _of_drive(gears: StrainWaveGears, drive: StrainWave) -> dict[str, Any]:
    form, rim = _form(gears.tooth), drive.rim
    return {
        **{f"tooth.{one.name}": getattr(form, one.name) for one in fields(form)},
        "flexspline.rim_thickness": rim.thickness,
        "flexspline.wall_thickness": rim.wall_thickness,
        "flexspline.cup_length": rim.cup_length,
    }


def _deviations(gears: StrainWaveGears, drive: StrainWave) -> Surfaces:
    given = gears.deviations
    return _waves(given.flexspline), _waves(given.circular_spline)


WAVES = 4
"""Waves of a member come in multiples of it, the last ones without height: few programs serve all."""


def _waves(given: tuple[Deviation, ...]) -> tuple[Waves, ...]:
    if not given:
        return ()
    rows = np.zeros((len(fields(Waves)), ceil(len(given) / WAVES) * WAVES))
    for row, one in zip(rows, fields(Waves), strict=True):
        row[: len(given)] = [getattr(wave, one.name) for wave in given]
    return (Waves(*map(jnp.asarray, rows)),)


def _ball_on_disc(rig: BallOnDiscRig, driver: str, slices: int) -> tuple[Mesh, tuple[str, ...]]:
    across = rig.transverse_radius or rig.ball_radius
    mesh = BallOnDisc(
        radius=array([rig.ball_radius, across]),
        track_radius=array(rig.track_radius),
        slide_roll_ratio=array(rig.slide_roll_ratio),
    )
    return mesh, (NARROW,) if across < rig.ball_radius else ()


NARROW = (
    "The contact is narrower across the track than along it, and laws of the film on ellipses were fitted "
    "to round and wider ones."
)


def _of_ball(rig: BallOnDiscRig, mesh: BallOnDisc) -> dict[str, Any]:
    return {"transverse_radius": mesh.radius[1]}


FAMILIES: dict[type, Family] = {
    CylindricalGears: Family(
        "cylindrical.toml",
        _cylindrical,
        _of_pair,
        _gear_deviations,
        drawing={"outline": ("gear", "corner", "xy"), "points": ("point",)},
        coordinates={"gear": [1, 2], "xy": ["x", "y"], "point": list("ABCDE")},
    ),
    StrainWaveGears: Family(
        "strain_wave.toml",
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
    ),
    BallOnDiscRig: Family("ball_on_disc.toml", _ball_on_disc, _of_ball),
}
"""Families by the class of their table."""
