"""The table [gears] of a strain wave gear."""

from collections.abc import Mapping
from math import pi
from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field, Tag, model_validator

from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import (
    ANGLE,
    BORE,
    MODULE,
    RACK,
    WIDTH,
    Deviation,
    GearsTable,
    WavesAround,
    check_waves,
)
from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.gears.strain_wave.proportions import DIMENSIONS
from pitchpoint.gears.strain_wave.strain_wave_registry import ARCS, DOUBLE_ARCS, WAVE_SHAPES
from pitchpoint.input.quantities import Pair, Quantity, named
from pitchpoint.input.tables import Table, table_by_key

__all__ = ["DoubleArcTooth", "InvoluteGroove", "InvoluteTooth", "LoadLimits", "StrainWaveGears"]

SPLINE_TEETH = Quantity("dimensionless", 30, 2_000, whole=True)
SPLINE_SHIFT = Quantity("dimensionless", -5.0, 10.0)
ARC = Quantity("dimensionless", 0.1, 20.0)
OFFSET = Quantity("dimensionless", -10.0, 20.0)
DEFLECTION = Quantity("dimensionless", 0.1, 3.0)
FORCE_ANGLE = Quantity("angle", 0.0, 60 * pi / 180, "deg")
AMPLITUDE = Quantity("dimensionless", -10.0, 10.0)
BOTTOM = Quantity("dimensionless", 0.0, 2.0)
ROUNDING = Quantity("dimensionless", 0.01, 0.5)
LEAVING = Quantity("angle", 20 * pi / 180, 80 * pi / 180, "deg")
RELIEF = Quantity("dimensionless", 0.0, 0.2)
RELIEF_LENGTH = Quantity("dimensionless", 0.0, 1.0)
PLAY = Quantity("length", 0.0, 1e-3, "um")
EITHER_PLAY = Quantity("length", -1e-4, 1e-3, "um")
BALLS = Quantity("dimensionless", 6, 60, whole=True)
THICKNESS = Quantity("length", 1e-5, 0.1, "mm")
SUPPORT = Quantity("pressure", 1e6, 1e16, "N/mm2")
TWIST = Quantity("torsional stiffness", 1e-3, 1e12, "kN m/rad")
SLOPE = Quantity("torque", 0.0, 1e8, "N m", open_low=True)
SEVERAL = Quantity("dimensionless", 3, 60, whole=True)
CONCENTRATION = Quantity("dimensionless", 1.0, 10.0)
STRENGTH = Quantity("pressure", 1e6, 1e10, "MPa")
LIMIT = Quantity("torque", 0.0, 1e8, "N m", open_low=True)
TURNING = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
LIFE = Quantity("time", 0.0, 1e12, "h", open_low=True)


class DoubleArcTooth(Table):
    """A flexspline tooth of two arcs and their tangent: a named set, by value, or a set with own values.

    Lengths are in modules.
    """

    form: Literal["double arc"] = "double arc"
    """Form of the flexspline's teeth: two arcs and their tangent."""
    set: Annotated[str, BeforeValidator(named(DOUBLE_ARCS.keys, "double-arc tooth"))] | None = None
    """Named set of dimensions, for those that are not given; liu unless given."""
    convex_radius: Annotated[float, ARC] | None = None
    """Radius ρ_a of the convex arc at the tip, in modules; that of the set unless given."""
    convex_offset: Annotated[float, OFFSET] | None = None
    """Centre of the convex arc beyond the axis of the tooth l_a, in modules; else of the set."""
    convex_shift: Annotated[float, OFFSET] | None = None
    """Centre of the convex arc below the pitch line e_a, in modules; else of the set."""
    concave_radius: Annotated[float, ARC] | None = None
    """Radius ρ_f of the concave arc at the root, in modules; that of the set unless given."""
    concave_offset: Annotated[float, OFFSET] | None = None
    """Centre of the concave arc beyond mid-space l_f, in modules; else of the set."""
    concave_shift: Annotated[float, OFFSET] | None = None
    """Centre of the concave arc above the pitch line e_f, in modules; else of the set."""
    addendum: Annotated[float, RACK] | None = None
    """Addendum above the pitch line, in modules; 0.55 unless given."""
    dedendum: Annotated[float, RACK] | None = None
    """Dedendum below the pitch line, in modules; 0.75 unless given."""

    @model_validator(mode="after")
    def _whole(self) -> "DoubleArcTooth":
        missing = [name for name in ARCS if getattr(self, name) is None]
        if self.set is None and 0 < len(missing) < len(ARCS):
            raise InputError(
                f"a double-arc tooth by value needs {', '.join(missing)} too; or name the set that gives "
                f"what is left out, one of {', '.join(DOUBLE_ARCS)}",
            )
        return self


class InvoluteTooth(Table):
    """An involute flexspline tooth by the basic rack that cuts it, in modules."""

    form: Literal["involute"] = "involute"
    """Form of the flexspline's teeth: involutes."""
    profile_shift: Annotated[float, SPLINE_SHIFT]
    """Profile shift coefficient x1 of the flexspline."""
    addendum: Annotated[float, RACK] = 1.0
    """Addendum of the basic rack, in modules."""
    dedendum: Annotated[float, RACK] = 1.35
    """Dedendum of the basic rack, in modules."""
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    """Pressure angle α of the basic rack."""


class ConjugateGroove(Table):
    """A circular spline whose flanks are those that the flexspline's teeth sweep."""

    form: Literal["conjugate"] = "conjugate"
    """Form of the circular spline: the flanks that the flexspline's teeth sweep."""


class InvoluteGroove(Table):
    """A circular spline with involute teeth, in modules."""

    form: Literal["involute"] = "involute"
    """Form of the circular spline: involutes."""
    profile_shift: Annotated[float, SPLINE_SHIFT]
    """Profile shift coefficient x2 of the circular spline."""
    addendum: Annotated[float, RACK] = 1.0
    """Addendum of the basic rack, in modules."""
    dedendum: Annotated[float, RACK] = 1.35
    """Dedendum of the basic rack, in modules."""
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    """Pressure angle α of the basic rack."""


class BallBearing(Table):
    """Balls of the wave generator under a thin outer race, which only push; both rings of steel.

    What is not given is in proportion to the pitch diameter, see `proportions.PROPORTIONS`. The play is the
    radial one between ball and races where the ring has its wave; a negative one presses.
    """

    balls: Annotated[float, BALLS] | None = None
    """Number of balls; 23 unless given, assumed."""
    ball_diameter: Annotated[float, BORE] | None = None
    """Diameter of a ball; 0.078 pitch diameters unless given, assumed."""
    race_thickness: Annotated[float, THICKNESS] | None = None
    """Thickness of the outer race; 0.0125 pitch diameters unless given, assumed."""
    play: Annotated[float, EITHER_PLAY] = 0.0
    """Radial play between ball and races where the ring has its wave; negative is a preload."""


class WaveGenerator(Table):
    """How the flexspline is deformed: a shape by name, or amplitudes of cos 2p, cos 4p, ...

    The deflection is the radial displacement on the long axis over half the module times the tooth
    difference.
    """

    shape: Annotated[str, BeforeValidator(named(WAVE_SHAPES.keys, "wave shape"))] = "cosine"
    """Shape into which the flexspline is bent, by name."""
    weights: tuple[Annotated[float, AMPLITUDE], ...] = ()
    """Amplitudes of cos 2p, cos 4p, ... in place of a shape; only their ratios count."""
    deflection: Annotated[float, DEFLECTION] = 1.0
    """Deflection w0 on the long axis, over half the module times the tooth difference."""
    force_angle: Annotated[float, FORCE_ANGLE] = pi / 6
    """Angle between the long axis and the forces of the shape four_forces."""
    bearing: BallBearing | None = None
    """Balls between wave generator and flexspline; without this table the ring is held all round."""

    @model_validator(mode="after")
    def _one(self) -> "WaveGenerator":
        if self.weights and "shape" in self.model_fields_set:
            raise InputError("shape and weights were both given; give one of them", key="weights")
        return self


class Flexspline(Table):
    """Rim and cup of the flexspline, and the bearing that holds it round.

    By default the rim is as thick as its bending into the wave allows cups of steel, of whatever material
    this one is, see `proportions.rim_by_strain`; the wall of the cup is half of that, the cup half a pitch
    diameter long, and the bearing rigid. A rim of two modules, as in a published drive of ratio 100, is too
    stiff for low ratios.
    """

    walls: Literal["two modules", "bending strain", "bending strain of plastic"] = "bending strain"
    """What a rim thickness that is not given follows from."""
    rim_thickness: Annotated[float, THICKNESS] | None = None
    """Thickness of the rim under the teeth; by walls unless given, assumed."""
    wall_thickness: Annotated[float, THICKNESS] | None = None
    """Thickness of the wall of the cup; half of the rim unless given, assumed."""
    cup_length: Annotated[float, BORE] | None = None
    """From the teeth to the flange; half of the pitch diameter unless given, assumed."""
    support_stiffness: Annotated[float, SUPPORT] | None = None
    """Radial stiffness of the bearing per length of circumference of the ring; rigid unless given."""


class Yielding(Table):
    """What yields behind teeth, rim and wall of the cup, each by a model, by value, or not at all.

    Without this table all of it is rigid. Dimensions that are not given are in proportion to the pitch
    diameter, see `proportions.PROPORTIONS`; the bottom of the cup is as thick as the rim.
    """

    cup_bottom: Literal["disc", "rigid"] = "disc"
    """How the bottom of the cup yields: as a disc in torsion, or not at all."""
    cup_bottom_stiffness: Annotated[float, TWIST] | None = None
    """Torsional stiffness of the bottom of the cup, in place of its model."""
    bottom_thickness: Annotated[float, THICKNESS] | None = None
    """Thickness of the bottom of the cup; that of the rim unless given."""
    flange_diameter: Annotated[float, BORE] | None = None
    """Diameter at which the bottom of the cup begins; 0.5 pitch diameters unless given."""
    flange: Literal["bolts", "rigid"] = "bolts"
    """How the flange joint yields: by the shear of its bolts, or not at all."""
    flange_stiffness: Annotated[float, TWIST] | None = None
    """Torsional stiffness of the flange joint, in place of its model."""
    bolts: Annotated[float, SEVERAL] | None = None
    """Number of bolts of the flange; 8 unless given."""
    bolt_diameter: Annotated[float, BORE] | None = None
    """Diameter of a bolt; 0.06 pitch diameters unless given."""
    bolt_circle: Annotated[float, BORE] | None = None
    """Diameter of the circle of bolts; 0.4 pitch diameters unless given."""
    wave_generator: Literal["shaft", "rigid"] = "shaft"
    """How the wave generator yields: by the torsion of its shaft, or not at all."""
    wave_generator_stiffness: Annotated[float, TWIST] | None = None
    """Torsional stiffness of the wave generator's shaft, in place of its model."""
    shaft_diameter: Annotated[float, BORE] | None = None
    """Diameter of that shaft; 0.17 pitch diameters unless given."""
    shaft_length: Annotated[float, BORE] | None = None
    """Length of that shaft up to the input; 0.4 pitch diameters unless given."""
    circular_spline: Literal["ring", "rigid"] = "ring"
    """How the circular spline yields: as a ring under its teeth, or not at all."""
    circular_spline_stiffness: Annotated[float, TWIST] | None = None
    """Torsional stiffness of the circular spline, in place of its model."""
    outside_diameter: Annotated[float, BORE] | None = None
    """Outer diameter of the circular spline; 1.35 pitch diameters unless given."""

    @model_validator(mode="after")
    def _one_each(self) -> "Yielding":
        """A part has one model, and no dimension that its model does not ask for."""
        for part, dimensions in DIMENSIONS.items():
            value = f"{part}_stiffness"
            if getattr(self, value) is not None and part in self.model_fields_set:
                raise InputError(f"{part} and {value} were both given; give one", key=value)
            modelled = getattr(self, value) is None and getattr(self, part) != "rigid"
            for key in dimensions:
                if getattr(self, key) is not None and not modelled:
                    excluding = part if getattr(self, value) is None else value
                    raise InputError(
                        f"{key} was given, but {excluding} leaves out what it is a dimension of",
                        key=key,
                    )
        return self


_FATIGUE = ("endurance_limit", "tensile_strength")
_RATED = ("rated_torque", "rated_speed", "rated_life")


class LoadLimits(Table):
    """What the flexspline and the bearing of the wave generator bear, as material and maker say.

    The endurance limit is that of the finished flexspline under fully reversed bending. Torques against
    ratcheting and buckling are a maker's; where they are those of a drive of another size, its pitch diameter
    stands beside them, and they go with the cube of the size. With a torque that reverses the shear of the
    flexspline alternates. The life of the bearing goes from its rated life; average torque and speed are
    those of the operating point where they are left out.
    """

    bending_concentration: Annotated[float, CONCENTRATION] = 1.0
    """Stress concentration of bending over that of a smooth ring."""
    shear_concentration: Annotated[float, CONCENTRATION] = 1.0
    """Stress concentration of shear over that of a smooth tube."""
    torque: Literal["steady", "reversing"] = "steady"
    """Whether the torque is steady, or reverses at its full height so that its shear alternates."""
    endurance_limit: Annotated[float, STRENGTH] | None = None
    """Endurance limit of the finished flexspline under fully reversed bending; none unless given."""
    tensile_strength: Annotated[float, STRENGTH] | None = None
    """Tensile strength of the flexspline; needed with the endurance limit."""
    ratcheting_torque: Annotated[float, LIMIT] | None = None
    """Torque at which teeth ratchet, as the maker has it; no margin unless given."""
    buckling_torque: Annotated[float, LIMIT] | None = None
    """Torque at which the flexspline buckles, as the maker has it; no margin unless given."""
    catalogue_diameter: Annotated[float, BORE] | None = None
    """Pitch diameter of the drive to which both torques belong; that of this one unless given."""
    rated_torque: Annotated[float, LIMIT] | None = None
    """Rated torque of the bearing's life; needed with rated_life."""
    rated_speed: Annotated[float, TURNING] | None = None
    """Rated speed of the bearing's life; needed with rated_life."""
    rated_life: Annotated[float, LIFE] | None = None
    """Life of the wave generator's bearing at rated torque and speed; no life unless given."""
    average_torque: Annotated[float, LIMIT] | None = None
    """Cubic mean torque on the flexspline; that of the operating point unless given."""
    average_speed: Annotated[float, TURNING] | None = None
    """Mean speed of the wave generator; that of the operating point unless given."""

    @model_validator(mode="after")
    def _together(self) -> "LoadLimits":
        for group in (_FATIGUE, _RATED):
            missing = [key for key in group if getattr(self, key) is None]
            if 0 < len(missing) < len(group):
                present = next(key for key in group if key not in missing)
                raise InputError(f"was given without {' and '.join(missing)}", key=present)
        alone = {
            "average_torque": self.rated_life,
            "average_speed": self.rated_life,
            "catalogue_diameter": self.ratcheting_torque or self.buckling_torque,
        }
        for key, companion in alone.items():
            if getattr(self, key) is not None and companion is None:
                what = "a torque of a catalogue" if key == "catalogue_diameter" else "a rated life"
                raise InputError(f"was given without {what}, to which it belongs", key=key)
        return self


class SplineDeviations(Table):
    """How far the flanks of both splines lie behind their places, as waves around them.

    They make the kinematic error; loads, losses and stiffness are those of teeth without deviations.
    """

    flexspline: WavesAround = ()
    """Waves around the flexspline, each with order, amplitude and phase; none unless given."""
    circular_spline: WavesAround = ()
    """Waves around the circular spline, each with order, amplitude, phase; none unless given."""

    @property
    def each(self) -> dict[str, tuple[Deviation, ...]]:
        """Waves by key of the spline."""
        return {"flexspline": self.flexspline, "circular_spline": self.circular_spline}


Tooth = Annotated[
    Annotated[DoubleArcTooth, Tag("double arc")] | Annotated[InvoluteTooth, Tag("involute")],
    Field(discriminator=table_by_key("form", DoubleArcTooth, InvoluteTooth)),
]
CircularSpline = Annotated[
    Annotated[ConjugateGroove, Tag("conjugate")] | Annotated[InvoluteGroove, Tag("involute")],
    Field(discriminator=table_by_key("form", ConjugateGroove, InvoluteGroove)),
]


class StrainWaveGears(GearsTable):
    """A strain wave gear with two lobes: wave generator, flexspline and circular spline.

    Clearances, rounding and relief of the tips are in modules. The tips of a circular spline whose flanks
    are swept end where the clearance or the angle of disengagement ends them, whatever is shorter. Edges
    sweep the groove in any case; whether they carry says `edges`. `slopes` are the torques T1 and T2 at
    which the first two slopes of the wind-up end, as makers give them. Gear 1 is the flexspline, gear 2
    the circular spline, in this table and in that of the materials.
    """

    members: ClassVar[tuple[str, ...]] = MEMBERS
    damping_ratio: ClassVar[float] = 0.03
    explored: ClassVar[tuple[str, float]] = ("wave_generator.deflection", 0.1)
    meaningless: ClassVar[Mapping[str, str]] = {
        "slices": "contacts of strain-wave teeth are not divided into slices",
        "averaging": "the path of one pair does not stand for strain-wave teeth, many of which touch at "
        "once",
    }

    family: Literal["strain_wave"] = "strain_wave"
    """Family of these gears: a strain wave gear with two lobes."""
    teeth: Annotated[tuple[float, float], Pair(SPLINE_TEETH)]
    """Numbers of teeth z1, z2 of flexspline and circular spline; their difference is even."""
    module: Annotated[float, MODULE]
    """Module m."""
    face_width: Annotated[float, WIDTH]
    """Face width of the teeth b."""
    fixed: Literal["wave generator", "flexspline", "circular spline"] = "circular spline"
    """Member that does not turn."""
    clearance: Annotated[float, BOTTOM] = 0.25
    """From the circular spline's tips to the flexspline's roots on the long axis, in modules."""
    disengagement: Annotated[float, LEAVING] = 50 * pi / 180
    """Angle from the long axis at which teeth leave their spaces at the latest."""
    tip_rounding: Annotated[float, ROUNDING] = 0.1
    """Radius of the edges of all tips, in modules."""
    tip_relief: Annotated[float, RELIEF] = 0.005
    """Relief of the tips of both splines where their rounding begins, in modules."""
    relief_length: Annotated[float, RELIEF_LENGTH] = 0.1
    """Length of this relief along the flank, in modules."""
    bottom_clearance: Annotated[float, BOTTOM] = 0.15
    """From the flexspline's tips to the bottom of the spaces on the long axis, in modules."""
    edges: Literal["clear", "carry"] = "clear"
    """Whether the rounded edges of the flexspline's tips may carry."""
    backlash: Annotated[float, PLAY] = 0.0
    """Circumferential play beyond the groove that just lets the teeth through."""
    tooth: Tooth = DoubleArcTooth(set="liu")
    """Tooth of the flexspline; the double-arc tooth liu unless given."""
    wave_generator: WaveGenerator = WaveGenerator()
    """How the wave generator bends the flexspline; a cosine with deflection 1 unless given."""
    flexspline: Flexspline = Flexspline()
    """Rim and cup of the flexspline."""
    yielding: Yielding | None = None
    """What yields behind teeth, rim and wall of the cup; nothing unless given."""
    slopes: tuple[Annotated[float, SLOPE], Annotated[float, SLOPE]] | None = None
    """Torques T1, T2 at which the slopes K1, K2 end; 20 and 70 % of the operating torque unless given."""
    circular_spline: CircularSpline = ConjugateGroove()
    """Flanks of the circular spline; those that the flexspline's teeth sweep unless given."""
    deviations: SplineDeviations = SplineDeviations()
    """Deviations of the flanks around both splines, for the kinematic error; none unless given."""
    limits: LoadLimits = LoadLimits()
    """What flexspline and bearing bear, for load limits."""

    @property
    def designation(self) -> str:
        """With the teeth of flexspline and circular spline."""
        flexspline_teeth, spline_teeth = self.tooth_numbers
        return f"Strain wave gear {flexspline_teeth:g}/{spline_teeth:g}"

    @property
    def tooth_numbers(self) -> tuple[float, float]:
        """Of both members, in magnitude."""
        flexspline_teeth, spline_teeth = self.teeth
        return flexspline_teeth, abs(spline_teeth)

    @property
    def normal_module(self) -> float:
        """Normal module [m]."""
        return self.module

    @property
    def relative_torques(self) -> dict[str, float]:
        """That of the wave generator is the difference of those of both splines."""
        flexspline_teeth, spline_teeth = self.tooth_numbers
        return dict(
            zip(
                self.members,
                (spline_teeth - flexspline_teeth, flexspline_teeth, spline_teeth),
                strict=True,
            )
        )

    @property
    def loss_scales(self) -> dict[str, float]:
        """Pitch diameter of the flexspline [m], its square, and the deflection on the long axis over it."""
        flexspline_teeth, spline_teeth = self.tooth_numbers
        deflection = self.wave_generator.deflection * (spline_teeth - flexspline_teeth) / 2.0
        return {
            "pitch diameter": self.module * flexspline_teeth,
            "square of the pitch diameter": (self.module * flexspline_teeth) ** 2,
            "deflection over pitch diameter": deflection / flexspline_teeth,
        }

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography for what is given."""
        return ("harmonic_drive_2014",) * (self.limits.rated_life is not None)

    @property
    def drivers(self) -> tuple[str, ...]:
        """Members that may drive, the usual one first."""
        return tuple(name for name in self.members if name != self.fixed)

    def loaded_member(self, driver: str) -> str:
        """The one that neither drives nor is fixed."""
        return next(name for name in self.members if name not in {driver, self.fixed})

    @property
    def load_sharing(self) -> str:
        """Most pairs carry only once others yield."""
        return "from_stiffness"

    @model_validator(mode="after")
    def _small_and_few(self) -> "StrainWaveGears":
        for (key, waves), teeth in zip(self.deviations.each.items(), self.teeth, strict=True):
            check_waves(waves, key, teeth, self.module)
        if self.slopes and not self.slopes[0] < self.slopes[1]:
            raise InputError(
                f"the slopes end at {' and '.join(map(SLOPE.show, self.slopes))}; write T1 and T2, the "
                "larger last",
                key="slopes",
            )
        if self.wave_generator.bearing and self.flexspline.support_stiffness is not None:
            raise InputError(
                "support_stiffness and a bearing of the wave generator were both given; give one",
                key="flexspline.support_stiffness",
            )
        if (
            self.flexspline.rim_thickness is not None
            and "walls" in self.flexspline.model_fields_set
        ):
            raise InputError(
                "walls says how thick the rim is, and rim_thickness was given too; give one",
                key="flexspline.walls",
            )
        return self
