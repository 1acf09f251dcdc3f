"""The table [gears] of a case file, one class for each family of gears and test rigs."""

from collections.abc import Mapping
from math import pi
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Field, Tag, model_validator

from pitchpoint.errors import InputError
from pitchpoint.gears import ball_on_disc, cylindrical, strain_wave
from pitchpoint.input.quantities import Pair, Quantity, named
from pitchpoint.input.tables import Table, by

__all__ = ["BallOnDiscRig", "CylindricalGears", "Gears", "StrainWaveGears"]

TEETH = Quantity("dimensionless", -10_000, 10_000, whole=True)
MODULE = Quantity("length", 1e-5, 0.1, "mm")
WIDTH = Quantity("length", 1e-5, 10.0, "mm")
DISTANCE = Quantity("length", 1e-4, 100.0, "mm")
HELIX = Quantity("angle", 0.0, 60 * pi / 180, "deg")
ANGLE = Quantity("angle", 5 * pi / 180, 45 * pi / 180, "deg")
SHIFT = Quantity("dimensionless", -2.0, 3.0)
RACK = Quantity("dimensionless", 0.1, 4.0)
FILLET = Quantity("dimensionless", 0.0, 1.0)
TIP = Quantity("dimensionless", -2.0, 2.0)
LEAST_TIP = Quantity("dimensionless", 0.0, 1.5)
BORE = Quantity("length", 1e-5, 100.0, "mm")

SPLINE_TEETH = Quantity("dimensionless", 30, 2_000, whole=True)
SPLINE_SHIFT = Quantity("dimensionless", -5.0, 10.0)
ARC = Quantity("dimensionless", 0.1, 20.0)
OFFSET = Quantity("dimensionless", -10.0, 20.0)
DEFLECTION = Quantity("dimensionless", 0.1, 3.0)
FORCE_ANGLE = Quantity("angle", 0.0, 60 * pi / 180, "deg")
AMPLITUDE = Quantity("dimensionless", -10.0, 10.0)
BOTTOM = Quantity("dimensionless", 0.0, 2.0)
ROUNDING = Quantity("dimensionless", 0.01, 0.5)
PLAY = Quantity("length", 0.0, 1e-3, "um")
THICKNESS = Quantity("length", 1e-5, 0.1, "mm")
SUPPORT = Quantity("pressure", 1e6, 1e16, "N/mm2")
WAVES = Quantity("dimensionless", 1, 1_000, whole=True)
DEVIATION = Quantity("length", 0.0, 1e-2, "um")
PHASE = Quantity("angle", -4 * pi, 4 * pi, "deg")

RELIEF = Quantity("length", 0.0, 1e-2, "um")
RELIEF_LENGTH = Quantity("length", 0.0, 1.0, "mm", open_low=True)
MISALIGNMENT = Quantity("length", -1e-2, 1e-2, "um")
TOLERANCE_CLASS = Quantity("dimensionless", 1, 11, whole=True)
SEED = Quantity("dimensionless", 0, 1_000_000, whole=True)
BALL = Quantity("length", 1e-4, 1.0, "mm")
TRACK = Quantity("length", 1e-3, 10.0, "mm")
SLIDE_ROLL = Quantity("dimensionless", -1.9, 2.0)

Load = Literal["torque", "force"]

FEWEST_TEETH = 2
FEWEST_RING_TEETH = 10


def _teeth(value: tuple[float, float]) -> tuple[float, float]:
    first, second = value
    if first < FEWEST_TEETH:
        raise InputError(
            f"gear 1 was given {first:.0f} teeth; allowed are {FEWEST_TEETH} or more, and only gear 2 "
            "may be a ring, with its number of teeth negative"
        )
    if -FEWEST_RING_TEETH < second < FEWEST_TEETH:
        raise InputError(
            f"gear 2 was given {second:.0f} teeth; allowed are {FEWEST_TEETH} or more, or for a ring "
            f"with internal teeth -{FEWEST_RING_TEETH} or less"
        )
    return value


class Deviation(Table):
    """A wave of a deviation along the normal of the flanks, so many times around the member."""

    order: Annotated[float, WAVES]
    amplitude: Annotated[float, DEVIATION]
    phase: Annotated[float, PHASE] = 0.0


WavesAround = Annotated[tuple[Deviation, ...], Field(max_length=200)]

_LENGTHS = ("tip_relief", "root_relief", "end_relief")


class FlankModifications(Table):
    """Modifications that all teeth of a gear have, along the normal; one value for both gears or two.

    Lengths of tip and root relief are roll lengths, from the tip circle and from the start of the active
    profile; without them a relief ends where one pair less is in contact. That of an end relief is along
    the face, by default a module and at most a tenth of the face.
    """

    tip_relief: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    tip_relief_length: Annotated[tuple[float, float], Pair(RELIEF_LENGTH)] | None = None
    root_relief: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    root_relief_length: Annotated[tuple[float, float], Pair(RELIEF_LENGTH)] | None = None
    relief_shape: Literal["linear", "parabolic"] = "linear"
    crowning: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    end_relief: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    end_relief_length: Annotated[tuple[float, float], Pair(RELIEF_LENGTH)] | None = None

    @property
    def amounts(self) -> dict[str, tuple[float, float]]:
        """Amounts that are given, by key."""
        given = {key: getattr(self, key) for key in (*_LENGTHS, "crowning")}
        return {key: value for key, value in given.items() if value is not None}

    @model_validator(mode="after")
    def _together(self) -> "FlankModifications":
        for key in _LENGTHS:
            if getattr(self, f"{key}_length") is not None and getattr(self, key) is None:
                raise InputError(
                    f"was given without {key}, to which it belongs", key=f"{key}_length"
                )
        return self


class GearDeviations(Table):
    """How far flanks lie behind their places, differently from tooth to tooth.

    As waves around each gear, and as gears at the limits of a class of ISO 1328-1 that a seed draws at
    random. They make the kinematic error; loads, losses and stiffness are those of teeth without them.
    """

    gear_1: WavesAround = ()
    gear_2: WavesAround = ()
    iso_class: Annotated[tuple[float, float], Pair(TOLERANCE_CLASS)] | None = None
    seed: Annotated[float, SEED] = 1.0

    @property
    def each(self) -> dict[str, tuple[Deviation, ...]]:
        """Waves by key of the gear."""
        return {"gear_1": self.gear_1, "gear_2": self.gear_2}


class CylindricalGears(Table):
    """A pair of involute gears on parallel axes, spur or helical; gear 2 may be a ring.

    A misalignment counts over the face, positive where the flanks part at the end that a contact line
    reaches last.
    """

    members: ClassVar[tuple[str, ...]] = cylindrical.MEMBERS
    load: ClassVar[Load] = "torque"
    friction: ClassVar[str] = "iso_tr_14179_2"
    film_thickness: ClassVar[str] = "dowson_higginson_1959"
    meaningless: ClassVar[Mapping[str, str]] = {}

    family: Literal["cylindrical"] = "cylindrical"
    teeth: Annotated[tuple[float, float], Pair(TEETH), AfterValidator(_teeth)]
    module: Annotated[float, MODULE]
    face_width: Annotated[float, WIDTH]
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    helix_angle: Annotated[float, HELIX] = 0.0
    profile_shift: Annotated[tuple[float, float], Pair(SHIFT)] = (0.0, 0.0)
    addendum: Annotated[tuple[float, float], Pair(RACK)] = (1.0, 1.0)
    dedendum: Annotated[tuple[float, float], Pair(RACK)] | None = None
    fillet_radius: Annotated[tuple[float, float], Pair(FILLET)] | None = None
    tip_alteration: Annotated[tuple[float, float], Pair(TIP)] | None = None
    least_tip_thickness: Annotated[float, LEAST_TIP] | None = None
    centre_distance: Annotated[float, DISTANCE] | None = None
    bore_diameter: Annotated[tuple[float, float], Pair(BORE)] | None = None
    flank: Literal["left", "right"] = "left"
    misalignment: Annotated[float, MISALIGNMENT] | None = None
    modifications: FlankModifications | None = None
    deviations: GearDeviations | None = None

    @property
    def drivers(self) -> tuple[str, ...]:
        """Members that may drive, the usual one first."""
        return self.members

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography for what is given."""
        modified = self.modifications is not None or self.misalignment is not None
        by_class = self.deviations is not None and self.deviations.iso_class is not None
        return ("iso_21771_2007",) * modified + ("iso_1328_1_2013",) * by_class

    @property
    def load_sharing(self) -> str:
        """Flanks with modifications share the load as they yield."""
        modified = self.modifications is not None and self.modifications.amounts
        return "from_stiffness" if modified or self.misalignment is not None else "equal"

    @model_validator(mode="after")
    def _smaller_than_teeth(self) -> "CylindricalGears":
        amounts = self.modifications.amounts if self.modifications is not None else {}
        given = {f"modifications.{key}": max(pair) for key, pair in amounts.items()}
        given["misalignment"] = abs(self.misalignment or 0.0)
        for key, most in given.items():
            if most > self.module / 2.0:
                raise InputError(
                    f"{RELIEF.show(most)} is more than a tooth allows; allowed is half a module, "
                    f"{RELIEF.show(self.module / 2.0)}",
                    key=key,
                )
        waves = self.deviations.each if self.deviations is not None else {}
        for (key, each), teeth in zip(waves.items(), self.teeth, strict=False):
            _check_waves(each, key, abs(teeth), self.module)
        return self

    @model_validator(mode="after")
    def _one_tip(self) -> "CylindricalGears":
        if self.tip_alteration is not None and self.least_tip_thickness:
            raise InputError(
                "tip_alteration and least_tip_thickness were both given; a tip alteration by value is "
                "kept as it is",
                key="least_tip_thickness",
            )
        return self


def _double_arcs() -> list[str]:
    from pitchpoint.gears.strain_wave.design import DOUBLE_ARCS

    return list(DOUBLE_ARCS)


def _wave_shapes() -> list[str]:
    from pitchpoint.gears.strain_wave.wave_generator import WAVE_SHAPES

    return list(WAVE_SHAPES)


_ARCS = (
    "convex_radius",
    "convex_offset",
    "convex_shift",
    "concave_radius",
    "concave_offset",
    "concave_shift",
)


class DoubleArcTooth(Table):
    """A flexspline tooth of two arcs and their tangent: a named set, by value, or a set with own values.

    Lengths are in modules.
    """

    form: Literal["double arc"] = "double arc"
    set: Annotated[str, BeforeValidator(named(_double_arcs, "double-arc tooth"))] | None = None
    convex_radius: Annotated[float, ARC] | None = None
    convex_offset: Annotated[float, OFFSET] | None = None
    convex_shift: Annotated[float, OFFSET] | None = None
    concave_radius: Annotated[float, ARC] | None = None
    concave_offset: Annotated[float, OFFSET] | None = None
    concave_shift: Annotated[float, OFFSET] | None = None
    addendum: Annotated[float, RACK] | None = None
    dedendum: Annotated[float, RACK] | None = None

    @model_validator(mode="after")
    def _whole(self) -> "DoubleArcTooth":
        missing = [name for name in _ARCS if getattr(self, name) is None]
        if self.set is None and 0 < len(missing) < len(_ARCS):
            raise InputError(
                f"a double-arc tooth by value needs {', '.join(missing)} too; or name the set that gives "
                f"what is left out, one of {', '.join(_double_arcs())}",
            )
        return self


class InvoluteTooth(Table):
    """An involute flexspline tooth by the basic rack that cuts it, in modules."""

    form: Literal["involute"] = "involute"
    profile_shift: Annotated[float, SPLINE_SHIFT]
    addendum: Annotated[float, RACK] = 1.0
    dedendum: Annotated[float, RACK] = 1.35
    pressure_angle: Annotated[float, ANGLE] = pi / 9


class ConjugateGroove(Table):
    """A circular spline whose flanks are those that the flexspline's teeth sweep."""

    form: Literal["conjugate"] = "conjugate"


class InvoluteGroove(Table):
    """A circular spline with involute teeth, in modules."""

    form: Literal["involute"] = "involute"
    profile_shift: Annotated[float, SPLINE_SHIFT]
    addendum: Annotated[float, RACK] = 1.0
    dedendum: Annotated[float, RACK] = 1.35
    pressure_angle: Annotated[float, ANGLE] = pi / 9


class WaveGenerator(Table):
    """How the flexspline is deformed: a shape by name, or amplitudes of cos 2p, cos 4p, ...

    The deflection is the radial displacement on the long axis over half the module times the tooth
    difference.
    """

    shape: Annotated[str, BeforeValidator(named(_wave_shapes, "wave shape"))] = "cosine"
    weights: tuple[Annotated[float, AMPLITUDE], ...] = ()
    deflection: Annotated[float, DEFLECTION] = 1.0
    force_angle: Annotated[float, FORCE_ANGLE] = pi / 6

    @model_validator(mode="after")
    def _one(self) -> "WaveGenerator":
        if self.weights and "shape" in self.model_fields_set:
            raise InputError("shape and weights were both given; give one of them", key="weights")
        return self


class Flexspline(Table):
    """Rim and cup of the flexspline, and the bearing that holds it round.

    By default the rim is two modules thick, the wall of the cup half of that, the cup half a pitch
    diameter long, and the bearing rigid.
    """

    rim_thickness: Annotated[float, THICKNESS] | None = None
    wall_thickness: Annotated[float, THICKNESS] | None = None
    cup_length: Annotated[float, BORE] | None = None
    support_stiffness: Annotated[float, SUPPORT] | None = None


class SplineDeviations(Table):
    """How far the flanks of both splines lie behind their places, as waves around them.

    They make the kinematic error; loads, losses and stiffness are those of teeth without deviations.
    """

    flexspline: WavesAround = ()
    circular_spline: WavesAround = ()

    @property
    def each(self) -> dict[str, tuple[Deviation, ...]]:
        """Waves by key of the spline."""
        return {"flexspline": self.flexspline, "circular_spline": self.circular_spline}


Tooth = Annotated[
    Annotated[DoubleArcTooth, Tag("double arc")] | Annotated[InvoluteTooth, Tag("involute")],
    Field(discriminator=by("form", DoubleArcTooth, InvoluteTooth)),
]
CircularSpline = Annotated[
    Annotated[ConjugateGroove, Tag("conjugate")] | Annotated[InvoluteGroove, Tag("involute")],
    Field(discriminator=by("form", ConjugateGroove, InvoluteGroove)),
]


class StrainWaveGears(Table):
    """A strain wave gear with two lobes: wave generator, flexspline and circular spline.

    Clearance and rounding of the tips are in modules. Gear 1 is the flexspline, gear 2 the circular
    spline, in this table and in that of the materials.
    """

    members: ClassVar[tuple[str, ...]] = strain_wave.MEMBERS
    load: ClassVar[Load] = "torque"
    sources: ClassVar[tuple[str, ...]] = ()
    friction: ClassVar[str] = "constant"
    load_sharing: ClassVar[str] = "from_stiffness"
    film_thickness: ClassVar[str] = "dowson_higginson_1959"
    meaningless: ClassVar[Mapping[str, str]] = {
        "slices": "contacts of strain-wave teeth are not divided into slices",
        "averaging": "the path of one pair does not stand for strain-wave teeth, many of which touch at "
        "once",
    }

    family: Literal["strain_wave"] = "strain_wave"
    teeth: Annotated[tuple[float, float], Pair(SPLINE_TEETH)]
    module: Annotated[float, MODULE]
    face_width: Annotated[float, WIDTH]
    fixed: Literal["wave generator", "flexspline", "circular spline"] = "circular spline"
    clearance: Annotated[float, BOTTOM] = 0.25
    tip_rounding: Annotated[float, ROUNDING] = 0.1
    backlash: Annotated[float, PLAY] = 0.0
    tooth: Tooth = DoubleArcTooth(set="liu")
    wave_generator: WaveGenerator = WaveGenerator()
    flexspline: Flexspline = Flexspline()
    circular_spline: CircularSpline = ConjugateGroove()
    deviations: SplineDeviations = SplineDeviations()

    @property
    def drivers(self) -> tuple[str, ...]:
        """Members that may drive, the usual one first."""
        return tuple(name for name in self.members if name != self.fixed)

    @model_validator(mode="after")
    def _small_and_few(self) -> "StrainWaveGears":
        for (key, waves), teeth in zip(self.deviations.each.items(), self.teeth, strict=True):
            _check_waves(waves, key, teeth, self.module)
        return self


def _check_waves(waves: tuple[Deviation, ...], key: str, teeth: float, module: float) -> None:
    """InputError for waves that the teeth are too few to tell, or as high as the teeth."""
    member = key.replace("_", " ") if key.startswith("gear") else f"the {key.replace('_', ' ')}"
    for position, wave in enumerate(waves):
        if wave.order > teeth / 2.0:
            raise InputError(
                f"{wave.order:.0f} waves around {member} look like fewer of them at its {teeth:.0f} "
                f"teeth; allowed are 1 to {teeth // 2.0:.0f}",
                key=f"deviations.{key}.{position}.order",
            )
    most = sum(wave.amplitude for wave in waves)
    if most > module / 2.0:
        raise InputError(
            f"the deviations of {member} add up to {DEVIATION.show(most)}; allowed is half a "
            f"module, {DEVIATION.show(module / 2.0)}",
            key=f"deviations.{key}",
        )


class BallOnDiscRig(Table):
    """A test rig: a ball, or a barrel of two radii, pressed on the flat face of a disc; both are driven.

    Gear 1 is the disc, gear 2 the ball, in the tables of materials and roughness. The slide-roll ratio
    is positive where the disc is the faster one, 2 with the ball at rest.
    """

    members: ClassVar[tuple[str, ...]] = ball_on_disc.MEMBERS
    load: ClassVar[Load] = "force"
    sources: ClassVar[tuple[str, ...]] = ()
    drivers: ClassVar[tuple[str, ...]] = ("disc",)
    friction: ClassVar[str] = "constant"
    load_sharing: ClassVar[str] = "equal"
    film_thickness: ClassVar[str] = "hamrock_dowson_1977"
    meaningless: ClassVar[Mapping[str, str]] = {
        "slices": "the contact of a ball is not divided into slices",
        "averaging": "the contact of a ball does not travel along a path",
    }

    family: Literal["ball_on_disc"] = "ball_on_disc"
    ball_radius: Annotated[float, BALL]
    transverse_radius: Annotated[float, BALL] | None = None
    track_radius: Annotated[float, TRACK]
    slide_roll_ratio: Annotated[float, SLIDE_ROLL] = 0.0


Gears = Annotated[
    Annotated[CylindricalGears, Tag("cylindrical")]
    | Annotated[StrainWaveGears, Tag("strain_wave")]
    | Annotated[BallOnDiscRig, Tag("ball_on_disc")],
    Field(discriminator=by("family", CylindricalGears, StrainWaveGears, BallOnDiscRig)),
]
