"""Strain wave gears from the dimensions that a designer gives, and the checks that go with them."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from inspect import signature
from itertools import groupby
from math import ceil, floor, inf, isclose, pi, radians
from typing import Any, NoReturn

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.doubts import Doubt, fails, in_percent
from pitchpoint.core.programs import fast_program, program
from pitchpoint.core.status import Code, Status
from pitchpoint.errors import InputError
from pitchpoint.gears.design_groups import Designs, Faults, Group, Number, check_counts
from pitchpoint.gears.strain_wave.ball_bearing import Balls, ball_bearing
from pitchpoint.gears.strain_wave.drive import WINDOW, StrainWave, Survey, lanes_for_pairs, survey
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing
from pitchpoint.gears.strain_wave.flexspline_tooth import (
    DoubleArcFlank,
    FlexsplineFlank,
    InvoluteFlank,
)
from pitchpoint.gears.strain_wave.groove import (
    NEWTON_STEPS,
    NODES,
    Groove,
    SplineTips,
    involute_groove,
    swept,
    tip_with_land,
)
from pitchpoint.gears.strain_wave.in_series import Behind, Cup, InSeries, in_series
from pitchpoint.gears.strain_wave.proportions import PROPORTIONS, rim_by_strain
from pitchpoint.gears.strain_wave.strain_wave_registry import (
    DOUBLE_ARCS,
    WAVE_SHAPES,
    DoubleArcForm,
)
from pitchpoint.gears.strain_wave.strength_estimates import curvature_change
from pitchpoint.gears.strain_wave.tooth_motion import ToothMotion
from pitchpoint.gears.strain_wave.wave_generator import TERMS, NeutralLine

__all__ = [
    "InvoluteForm",
    "build_strain_wave",
    "build_strain_waves",
    "check_rim",
    "check_strain_wave",
    "designed_strain_wave",
    "double_arc_flank",
]

LEAST_LAND = 0.3
"""Tip land that the circular spline's teeth keep, in modules: their tips are cut back as far as it takes."""

RIDGE = 1.0
"""Radius in modules of ridges between parts of a swept flank: no cutter leaves an edge."""

INTERFERENCE = 1e-4
"""Overlap of rigid flanks that counts as interference, in modules."""

SWEPT_ACCURACY = 1e-3
"""Overlap in a groove that the flexspline itself sweeps, which is an error of the table, in modules."""

SOFT = 20e9
"""Young's modulus below which a flexspline is of plastic, and proportions of steel cups say nothing [Pa]."""
BORNE = 5e-3
"""Strain that plastics bear for short lives at least; assumed, as printed drives are designed."""
STEEL_BEARS = 2e-3
"""Strain that steel bears in alternating bending for any number of turns: 0.45 of a tensile strength of
900 MPa over its modulus, a usual rule for smooth bars; assumed."""
OF_STRENGTH = 0.25
"""Part of their tensile strength that plastics bear in alternating bending; assumed, 0.2 to 0.3 are usual."""
FAR_FROM_USUAL = 4.0
"""Thickness of the rim over the usual one, or the other way round, from which on a sentence says so."""

_FARTHEST = 0.1  # clearance in modules beyond which no load closes a gap
_NEAR = 1e-2  # clearance in modules that a moderate load closes
_FEWEST = 30
_SLACK = 1e-6


@dataclass(frozen=True)
class InvoluteForm:
    """An involute tooth by the basic rack that cuts it, in modules."""

    profile_shift: float
    addendum: float = 1.0
    dedendum: float = 1.35
    pressure_angle: float = radians(20.0)


def build_strain_wave(
    *,
    teeth: tuple[int, int],
    module: float,
    face_width: float,
    form: DoubleArcForm | InvoluteForm = DOUBLE_ARCS["liu"],
    shape: str | tuple[float, ...] = "cosine",
    deflection: float = 1.0,
    force_angle: float = radians(30.0),
    rim_thickness: float | None = None,
    wall_thickness: float | None = None,
    walls: str = "bending strain",
    cup_length: float | None = None,
    support_stiffness: float = inf,
    bearing: Balls | None = None,
    behind: Behind | None = None,
    clearance: float = 0.25,
    disengagement: float = radians(50.0),
    tip_rounding: float = 0.1,
    tip_relief: float = 0.005,
    relief_length: float = 0.1,
    bottom_clearance: float = 0.15,
    edges_carry: bool = False,
    backlash: float = 0.0,
    groove: InvoluteForm | None = None,
) -> StrainWave:
    """Strain wave gear with a wave generator of two lobes.

    Args:
        teeth: of flexspline and circular spline; their difference is even.
        module: [m].
        face_width: of the teeth [m].
        form: of the flexspline's teeth.
        shape: of the wave generator by name, or amplitudes of cos 2p, cos 4p, ... of the radial
            displacement, of which only their ratios count.
        deflection: w0 over module (z2 - z1)/2, the deflection with which the pitch circles touch.
        force_angle: between the long axis and the forces of the shape `four_forces` [rad].
        rim_thickness: of the flexspline under its teeth [m]; by `walls` if it is left out.
        wall_thickness: of the cup [m]; half the rim by default.
        walls: "two modules", "bending strain" or "bending strain of plastic", see `rim_by_strain`.
        cup_length: from the teeth to the flange [m]; half the pitch diameter by default.
        support_stiffness: of the wave generator's bearing, see `FlexibleRing` [N/m2].
        bearing: balls of the wave generator, which take the place of that support.
        behind: what yields behind teeth, rim and wall; nothing by default.
        clearance: between the tip of the circular spline's teeth and the root of the flexspline on
            the long axis, in modules.
        disengagement: from the long axis at which teeth leave their spaces, at the latest: the tips of the
            circular spline end there if the clearance does not end them before [rad].
        tip_rounding: radius of the edges of all tips, in modules.
        tip_relief: by which the tips of both splines lie below the flank where their rounding begins, in
            modules.
        relief_length: along the flank up to there, in modules.
        bottom_clearance: between the flexspline's tips and the bottom of the spaces on the long axis, in
            modules.
        edges_carry: True if the rounding of the flexspline's tips may carry; it sweeps in any case.
        backlash: play on the circumference beyond the groove that just lets the teeth through [m].
        groove: an involute circular spline; by default the flank that the flexspline's teeth sweep.

    Raises:
        InputError: dimensions that give no drive; the key is the name of the argument.
    """
    built = _built(_planned(**locals()), _ALONE)
    return built(lanes_for_pairs(built.held))


def build_strain_waves(**values: Any) -> Designs[StrainWave]:
    """Many strain wave gears in one call, each as `build_strain_wave` builds it.

    Args:
        values: the arguments of `build_strain_wave`, each as there, common to all designs, or a list with
            one for each design (an array of numbers counts as a list).

    Returns:
        Drives in groups with one form of teeth, with an even or an odd number of them on the flexspline,
        swept or given grooves; a group holds as many pairs of teeth as its widest zone asks for. The status
        of each design has the overlap of its rigid flanks, over the module, as residual.

    Raises:
        InputError: lists for different numbers of designs.

    Example:
        >>> import numpy as np
        >>> designs = build_strain_waves(
        ...     teeth=(100, 102), module=0.5e-3, face_width=0.01, deflection=np.array([0.98, 1.0, 3.0])
        ... )
        >>> designs.good.tolist()
        [True, True, False]
        >>> designs.sentence(2)[:48]
        'deflection: the wave generator deflects the flex'
    """
    bound = signature(build_strain_wave).bind(**values)
    bound.apply_defaults()
    built: dict[int, _Built] = {}
    refused: dict[int, InputError] = {}
    rows = _listed(bound.arguments)
    for number, row in enumerate(rows):
        try:
            built[number] = _built(_planned(**row), _TOGETHER)
        except InputError as error:
            refused[number] = error
    kinds = groupby(sorted(built, key=lambda number: built[number].kind), lambda n: built[n].kind)
    groups = tuple(_group(built, list(numbers)) for _, numbers in kinds)
    residual = [built[n].overlap if n in built else inf for n in range(len(rows))]
    code = [Code.SOLVED if n in built else Code.NO_DESIGN for n in range(len(rows))]
    status = Status(array(code, int), array(residual), array(NEWTON_STEPS))
    return Designs(groups, status, check_strain_wave, refused)


def designed_strain_wave(drive: StrainWave) -> tuple[StrainWave, Status]:
    """The drive with all that follows from its dimensions, and whether it can run.

    A pure function that can be traced, vectorised and differentiated: `jax.vmap` makes it that of a batch.

    Args:
        drive: with its dimensions and its static structure, see `StrainWave.completed` for what stays.

    Returns:
        The drive, and the status: the residual is the overlap of rigid flanks over the module.
    """
    drive = drive.completed()
    at = _touching(drive.surveyed, drive.module)
    faults = _faults(at, drive.module, drive.backlash, conjugate=drive.conjugate)
    fails = jnp.any(jnp.stack([jnp.asarray(fails) for fails, _ in faults]))
    code = jnp.where(fails, int(Code.NO_DESIGN), int(Code.SOLVED))
    residual = jnp.maximum(-at.least, 0.0) / drive.module
    return drive, Status(code, residual, jnp.asarray(NEWTON_STEPS))


@dataclass(frozen=True)
class _Plan:
    """What is known of a drive before its groove.

    Attributes:
        parts: of the mesh, by name; those that are arrays.
        travel: how its teeth move.
        cutter: the same of teeth without relief, which sweep the groove.
        low: height of the tips as meant [m].
        mate: form of the circular spline; None where its flanks are swept.
        splines: numbers of teeth.
        module, backlash: [m].
    """

    parts: dict[str, Any]
    travel: ToothMotion
    cutter: ToothMotion
    low: float
    mate: InvoluteForm | None
    splines: tuple[int, int]
    module: float
    backlash: float

    @property
    def tips(self) -> SplineTips:
        """How tips are made."""
        tips: SplineTips = self.parts["tips"]
        return tips

    @property
    def edge(self) -> float:
        """Radius of the edges [m]."""
        return float(self.tips.rounding)

    @property
    def mate_angle(self) -> Array:
        """Angle of one pitch of the circular spline [rad]."""
        return array(2.0 * pi / self.splines[1])


@dataclass(frozen=True)
class _Built:
    """A drive but for the places of its pairs.

    Attributes:
        parts: of the mesh, by name.
        held: pairs in each of both zones.
        overlap: of rigid flanks, over the module.
    """

    parts: dict[str, Any]
    held: int
    overlap: float

    @property
    def kind(self) -> tuple[str, bool, bool, bool, int]:
        """Static structure that drives of a group have in common."""
        flank, rigid = type(self.parts["flank"]).__name__, self.parts["series"].ring is None
        bearing = self.parts["bearing"]
        balls = 0 if bearing is None else bearing.angle.shape[0]
        return flank, self.parts["conjugate"], self.parts["odd"], rigid, balls

    def __call__(self, lanes: int) -> StrainWave:
        """The drive with so many places in each zone."""
        return StrainWave(**self.parts, held=array(float(self.held)), lanes=lanes)


class _Contact(eqx.Module):
    """Where rigid teeth are nearest to each other.

    Attributes:
        least: clearance there; infinite where no tooth engages [m].
        angle: from the long axis [rad].
        rolls: True if flanks touch near there with a positive relative curvature.
    """

    least: Number
    angle: Number
    rolls: bool | Bool[Array, ""]


def _touching(found: Survey, module: Float[Array, ""]) -> _Contact:
    clearance = jnp.nan_to_num(found.clearance, nan=jnp.inf)
    least = jnp.argmin(clearance)
    near = clearance < clearance[least] + _NEAR * module
    return _Contact(clearance[least], found.angle[least], jnp.any(near & found.rolls))


def _swept(
    cutter: ToothMotion,
    low: Float[Array, ""],
    tips: SplineTips,
    mate_angle: Float[Array, ""],
    land: Float[Array, ""],
) -> tuple[Groove, Float[Array, ""], Float[Array, ""]]:
    """Groove, height at which the teeth between keep a tip land, and the land that they have [m]."""
    groove = swept(cutter, low, tips)
    return (
        groove,
        tip_with_land(groove, mate_angle, land, tips.rounding),
        groove.land(mate_angle)[0],
    )


def _surveyed(
    travel: ToothMotion,
    groove: Groove,
    backlash: Float[Array, ""],
    module: Float[Array, ""],
    tooth_angle: Float[Array, ""],
    edges_carry: bool,
    conjugate: bool,
) -> tuple[Survey, _Contact]:
    """Clearances along the wave, and where the least one is.

    Edges count there on given flanks, since they may not reach into each other either; swept ones let
    them through.
    """
    drive_values = travel, groove, backlash, module, tooth_angle
    surveyed = survey(*drive_values, edges_carry)
    plain = edges_carry or conjugate
    return surveyed, _touching(surveyed if plain else survey(*drive_values, True), module)


@dataclass(frozen=True)
class _Programs:
    """Programs of the steps that take long, for one drive."""

    sweep: Callable[..., tuple[Groove, Array, Array]]
    survey: Callable[..., tuple[Survey, _Contact]]


_ALONE = _Programs(program(_swept), program(_surveyed))
_TOGETHER = _Programs(fast_program(_swept), fast_program(_surveyed))
"""For many drives, which repay what the compiler takes; one after the other, as each fills the cache."""


def _planned(
    *,
    teeth: tuple[int, int],
    module: float,
    face_width: float,
    form: DoubleArcForm | InvoluteForm,
    shape: str | tuple[float, ...],
    deflection: float,
    force_angle: float,
    rim_thickness: float | None,
    wall_thickness: float | None,
    walls: str,
    cup_length: float | None,
    support_stiffness: float,
    bearing: Balls | None,
    behind: Behind | None,
    clearance: float,
    disengagement: float,
    tip_rounding: float,
    tip_relief: float,
    relief_length: float,
    bottom_clearance: float,
    edges_carry: bool,
    backlash: float,
    groove: InvoluteForm | None,
) -> _Plan:
    """What follows without the groove; arguments as in `build_strain_wave`."""
    z1, z2 = _checked_teeth(teeth)
    w0 = deflection * module * (z2 - z1) / 2.0
    rim = _rim(walls, module, z1, w0) if rim_thickness is None else rim_thickness
    sizes = (tip_rounding, tip_relief, relief_length, bottom_clearance, RIDGE)
    tips = SplineTips(*(array(size * module) for size in sizes))
    flank = _flank(form, z1, module, rim, tips)
    dedendum = (
        form.dedendum if isinstance(form, DoubleArcForm) else form.dedendum - form.profile_shift
    )
    neutral = module * (z1 / 2.0 - dedendum) - rim / 2.0
    _check_depth(form, deflection, clearance)
    if groove is not None:
        _check_free(form, deflection, clearance, z2 - z1)
        _check_as_given(tip_relief, relief_length, bottom_clearance)
    if bearing is not None and bearing.play >= w0:
        raise InputError(
            f"a play of {1e3 * bearing.play:.4g} mm of the wave generator's balls leaves nothing of the "
            f"deflection of {1e3 * w0:.4g} mm; allowed is less",
            key="play",
        )
    weights = _weights(shape, force_angle, w0 / neutral)
    line = NeutralLine(array(neutral), array(w0), array(weights))
    wall = rim / 2.0 if wall_thickness is None else wall_thickness
    bottom = bottom_clearance * module
    root = neutral + rim / 2.0 + module * (form.addendum + form.dedendum) + w0 + bottom
    cup, bore = Cup(module * z1, neutral, rim, root, face_width), 2.0 * neutral - rim
    parts = {
        "teeth": array([z1, z2], float),
        "module": array(module),
        "face_width": array(face_width),
        "flank": flank,
        "line": line,
        "rim": FlexibleRing(
            radius=array(neutral),
            thickness=array(rim),
            width=array(face_width),
            wall_thickness=array(wall),
            cup_length=array(PROPORTIONS.cup * module * z1 if cup_length is None else cup_length),
            support_stiffness=array(support_stiffness),
        ),
        "bearing": None
        if bearing is None
        else ball_bearing(bearing, module * z1, bore, face_width),
        "series": InSeries.rigid() if behind is None else in_series(behind, cup),
        "tips": tips,
        "edges_carry": edges_carry,
        "backlash": array(backlash),
        "conjugate": groove is None,
        "odd": z1 % 2 == 1,
    }
    lag = array(1.0 - z1 / z2)
    travel, cutter = (
        ToothMotion(_prepared(tooth_flank), line, lag) for tooth_flank in (flank, flank.unrelieved)
    )
    low = neutral + w0 + rim / 2.0 + clearance * module
    if groove is None:
        low = max(low, float(_tip_height(cutter, array(disengagement))))
    return _Plan(parts, travel, cutter, low, groove, (z1, z2), module, backlash)


def _rim(walls: str, module: float, teeth: int, deflection: float) -> float:
    """Thickness of a rim by a rule [m]."""
    if walls == "two modules":
        return 2.0 * module
    return rim_by_strain(module * teeth, deflection, plastic=walls == "bending strain of plastic")


def _built(plan: _Plan, programs: _Programs) -> _Built:
    """The drive with its groove and its survey.

    Raises:
        InputError: it cannot run.
    """
    if plan.mate is None:
        low, groove, land = _cut(plan, programs)
    else:
        low, groove, land = _given(plan, plan.mate)
    _check_play(plan, land)
    numbers = map(array, (plan.backlash, plan.module, 2.0 * pi / plan.splines[0]))
    edges: bool = plan.parts["edges_carry"]
    surveyed, touching = programs.survey(plan.travel, groove, *numbers, edges, plan.mate is None)
    at = _plain(touching)
    for broken, refuse in _faults(at, plan.module, plan.backlash, conjugate=plan.mate is None):
        if broken:
            refuse()
    parts = plan.parts | {"groove": groove, "tip_height": array(low), "surveyed": surveyed}
    overlap = max(-float(at.least), 0.0) / plan.module
    return _Built(parts, _held(plan.splines[0], surveyed, plan.module), overlap)


def _plain(at: _Contact) -> _Contact:
    """The same as plain numbers."""
    contact = jax.device_get(at)
    return _Contact(float(contact.least), float(contact.angle), bool(contact.rolls))


def _group(found: dict[int, _Built], numbers: list[int]) -> Group[StrainWave]:
    """Drives of one structure, with places for the pairs of the widest zone."""
    lanes = lanes_for_pairs(max(found[number].held for number in numbers))
    drives = [found[number](lanes) for number in numbers]
    return Group(jax.tree.map(lambda *leaves: np.stack(leaves), *drives), np.array(numbers))


def _listed(given: dict[str, Any]) -> list[dict[str, Any]]:
    """Arguments of each design.

    Raises:
        InputError: lists for different numbers of designs.
    """
    several = {key: value for key, value in given.items() if _is_several(key, value)}
    check_counts({key: len(value) for key, value in several.items()})
    count = max(map(len, several.values()), default=1)
    return [
        {key: _one_of(value[n]) if key in several else value for key, value in given.items()}
        for n in range(count)
    ]


def _is_several(key: str, value: Any) -> bool:
    """True for a list of values; pairs of teeth and amplitudes of a wave are tuples themselves."""
    if isinstance(value, tuple) and key in ("teeth", "shape"):
        return not np.isscalar(value[0])
    return isinstance(value, list | tuple | np.ndarray | jax.Array) and np.ndim(value) > 0


def _one_of(value: Any) -> Any:
    """A value of a list as the builder takes it."""
    return value.tolist() if isinstance(value, np.generic | np.ndarray | jax.Array) else value


def check_strain_wave(mesh: StrainWave) -> tuple[str, ...]:
    """Sentences on what is unusual about a drive that can run."""
    sentences = []
    intended, widest, land = map(float, jax.device_get(_extent(mesh)))
    cut = (float(mesh.tip_height) - intended) / float(mesh.module)
    if mesh.conjugate and cut > 0.6 and land < 1.1 * LEAST_LAND * float(mesh.module):
        sentences.append(
            f"The tips of the circular spline are cut back to {cut:.2g} modules above the flexspline's root "
            "on the long axis: the flexspline's tips pass there and would leave less than "
            f"{LEAST_LAND:g} modules of tip land."
        )
    overlap = -float(np.nanmin(np.asarray(mesh.surveyed.clearance)))
    if overlap > INTERFERENCE * float(mesh.module):
        sentences.append(
            f"Flexspline and circular spline overlap by {1e6 * overlap:.2g} um where the swept flank is "
            "known no better; the clearance there counts as zero."
        )
    if lost := int(mesh.groove.unsolved):
        sentences.append(
            f"The circular spline's flank could not be found at {lost} of {NODES} heights: curvature, "
            "pressure and film there say nothing."
        )
    if widest > 0.1 * float(mesh.line.radius):
        sentences.append(
            "The deflection is above a tenth of the radius; the ring theory here is linear."
        )
    return tuple(sentences)


def check_rim(mesh: StrainWave, young: float, tensile: float | None = None) -> tuple[str, ...]:
    """Sentences on a rim that is far from usual for its material, or that its wave strains too far.

    Args:
        mesh: of the drive.
        young: Young's modulus of the flexspline [Pa].
        tensile: strength of a plastic [Pa], if known.
    """
    thickness, line, plastic = float(mesh.rim.thickness), mesh.line, young < SOFT
    bent = curvature_change(
        np.linspace(0.0, pi, 721),
        radius=float(mesh.rim.radius),
        deflection=float(line.deflection),
        weights=np.asarray(line.weights),
    )
    per_thickness = np.abs(bent).max() / 2.0
    usual, of_steel = (
        rim_by_strain(mesh.pitch_diameter, float(line.deflection), plastic=soft)
        for soft in (plastic, False)
    )
    sentences = []
    as_of_steel = plastic and isclose(thickness, of_steel)  # what a table that leaves it open has
    if as_of_steel or not 1.0 / FAR_FROM_USUAL < thickness / usual < FAR_FROM_USUAL:
        sentences.append(_unusual_rim(thickness, usual, plastic))
    if per_thickness * thickness > (borne := _borne(young, tensile)[0]):
        sentences.append(
            _strained_rim(per_thickness * thickness, borne / per_thickness, young, tensile)
        )
    return tuple(sentences)


def _unusual_rim(thickness: float, usual: float, plastic: bool) -> Doubt:
    """Sentence on a rim that is far from usual."""
    cup, walls = (
        ("plastic", "bending strain of plastic") if plastic else ("steel", "bending strain")
    )
    return Doubt(
        f"The rim of the flexspline is {1e3 * thickness:.3g} mm thick; usual for cups of {cup} of its size "
        f'and its wave are {1e3 * usual:.3g} mm, which walls = "{walls}" takes.',
        brief=f"The flexspline's rim is {1e3 * thickness:.3g} mm, usual are {1e3 * usual:.3g} mm.",
    )


def _borne(young: float, tensile: float | None) -> tuple[float, str]:
    """Strain that the material of a flexspline bears, and that in words."""
    if young >= SOFT:
        return (
            STEEL_BEARS,
            "metals are taken to bear {:.2g} % in alternating bending, as steel does",
        )
    if tensile is None:
        return BORNE, "plastics are taken to bear {:.2g} % for short lives"
    quarter = f"a quarter of its tensile strength of {tensile / 1e6:.3g} MPa"
    return OF_STRENGTH * tensile / young, f"this plastic is taken to bear {{:.2g}} %, {quarter}"


def _strained_rim(strain: float, within: float, young: float, tensile: float | None) -> Doubt:
    """Sentence on a rim whose wave strains it further than its material bears."""
    borne, words = _borne(young, tensile)
    sentence = (
        f"he wave strains the rim of the flexspline by {in_percent(strain)}, in Hooke's law "
        f"{strain * young / 1e6:.3g} MPa; {words.format(100.0 * borne)}: {1e3 * within:.3g} mm of rim have "
        "that."
    )
    brief = f"he rim is strained by {in_percent(strain)}, {in_percent(borne)} is borne."
    if tensile is not None and strain * young > tensile:
        return fails(f"t{sentence}", f"t{brief}")
    return Doubt(f"T{sentence}", brief=f"T{brief}")


@program
def _extent(mesh: StrainWave) -> tuple[Array, Array, Array]:
    """Height of the flexspline's root on the long axis, displacement on the short one, land of the mate [m].

    The land is that without the relief of its edges.
    """
    line = mesh.line
    root = line.radius + line.deflection + mesh.flank.root_height
    land = mesh.groove.land(2.0 * jnp.pi / mesh.teeth[1])[0] + 2.0 * mesh.tips.rounding
    return root, jnp.abs(line.radial(jnp.asarray(pi / 2))), land


def double_arc_flank(
    form: DoubleArcForm,
    *,
    module: float,
    rim_thickness: float,
    tip_rounding: float = 0.1,
    tip_relief: float = 0.0,
    relief_length: float = 0.0,
) -> DoubleArcFlank:
    """Flank of a double-arc tooth.

    Args:
        form: in modules.
        module: [m].
        rim_thickness: under the teeth [m].
        tip_rounding, tip_relief, relief_length: in modules.

    Raises:
        InputError: arcs without a common tangent, or in the wrong order.
    """
    tip_sizes = (array(v * module) for v in (tip_rounding, tip_relief, relief_length, 0.0, RIDGE))
    return _double_arc(form, module, rim_thickness, SplineTips(*tip_sizes))


def _double_arc(
    form: DoubleArcForm, module: float, rim_thickness: float, tips: SplineTips
) -> DoubleArcFlank:
    values = {field.name: array(module * getattr(form, field.name)) for field in fields(form)}
    flank = DoubleArcFlank(
        pitch=array(pi * module),
        pitch_height=array(rim_thickness / 2.0 + form.dedendum * module),
        tip_rounding=tips.rounding,
        tip_relief=tips.relief,
        relief_length=tips.relief_length,
        **values,
    )
    arcs = jax.device_get(_arcs(flank))
    if not np.isfinite(arcs["tangent"]):
        apart, radii = arcs["apart"] / module, form.convex_radius + form.concave_radius
        raise InputError(
            "the arcs of the double-arc tooth have no common tangent: their centres are "
            f"{apart:.4g} modules apart, less than the sum of their radii, {radii:.4g}",
            key="form",
        )
    names = ("concave arc", "tangent", "convex arc", "relief", "rounding of the tip")
    convex, _, rounded = (float(length) / module for length in arcs["lengths"][2:])
    _check_relief(convex, rounded, tips, module)
    for name, length in zip(names, arcs["lengths"], strict=True):
        if not (length > 0.0 or (name == "relief" and length == 0.0)):
            raise InputError(
                f"the double-arc tooth leaves no room for its {name}; between root and tip concave arc, "
                "tangent, convex arc and rounding must follow each other",
                key="form",
            )
    _check_land(float(arcs["land"]), module, tips)
    return flank


def _check_relief(flank: float, rounding: float, tips: SplineTips, module: float) -> None:
    """InputError if the relief of a tip takes more of its flank or its rounding than there is, in modules."""
    amount, length = float(tips.relief) / module, float(tips.relief_length) / module
    if amount > 0.0 and length == 0.0:
        raise InputError(
            f"a tip relief of {amount:.4g} modules needs a length along the flank; 0 was given",
            key="relief_length",
        )
    if length > 0.0 and not flank > 0.0:
        raise InputError(
            f"a relief of {length:.4g} modules is longer than the flank at the tip of the flexspline's "
            f"teeth, {flank + length:.4g} modules",
            key="relief_length",
        )
    if amount > 0.0 and not rounding > 0.0:
        raise InputError(
            f"a tip relief of {amount:.4g} modules over {length:.4g} turns the flexspline's flank so far "
            "that nothing of the rounding is left; less of it, or a longer one, leaves room",
            key="tip_relief",
        )


@program
def _arcs(flank: DoubleArcFlank) -> dict[str, jnp.ndarray]:
    return {
        "tangent": flank.tangent_length,
        "apart": jnp.abs(flank.concave_centre - flank.convex_centre),
        "lengths": jnp.stack(flank.lengths),
        "land": flank.tip_land,
    }


def _flank(
    form: DoubleArcForm | InvoluteForm, teeth: int, module: float, rim: float, tips: SplineTips
) -> FlexsplineFlank:
    if isinstance(form, DoubleArcForm):
        return _double_arc(form, module, rim, tips)
    flank = _involute(form, teeth, module, rim, tips)
    rolled, _, rounded = map(float, flank.lengths)
    _check_relief(rolled / module, rounded / module, tips, module)
    _check_land(float(flank.tip_land), module, tips)
    base = float(flank.base_radius / flank.root_radius)
    if base >= 1.0:
        raise InputError(
            "the root circle of the flexspline lies inside its base circle; more teeth or a larger profile "
            "shift keeps the flank an involute",
            key="form",
        )
    return flank


def _involute(
    form: InvoluteForm, teeth: int, module: float, rim: float, tips: SplineTips | None
) -> InvoluteFlank:
    tip_sizes = (tips.rounding, tips.relief, tips.relief_length) if tips else (0.0, 0.0, 0.0)
    root = module * (teeth / 2.0 + form.profile_shift - form.dedendum)
    return InvoluteFlank(
        *map(
            jnp.asarray,
            (
                float(teeth),
                module,
                form.pressure_angle,
                form.profile_shift,
                form.addendum,
                form.dedendum,
                root - rim / 2.0,
                *tip_sizes,
            ),
        )
    )


def _check_land(land: float, module: float, tips: SplineTips) -> None:
    rounding = float(tips.rounding) / module
    least = 2.0 * rounding * module
    if not land > least:
        raise InputError(
            f"the flexspline's teeth are pointed: their tip land is {land / module:.3g} modules, and rounded "
            f"edges need more than {2.0 * rounding:.3g}",
            key="form",
        )


def _checked_teeth(teeth: tuple[int, int]) -> tuple[int, int]:
    z1, z2 = teeth
    if z1 < _FEWEST or z2 - z1 < 2 or (z2 - z1) % 2:
        raise InputError(
            f"{z1} and {z2} teeth were given; a flexspline has {_FEWEST} or more, and the circular spline "
            "2, 4, 6, ... more than it",
            key="teeth",
        )
    return z1, z2


def _check_depth(form: DoubleArcForm | InvoluteForm, deflection: float, clearance: float) -> None:
    """The teeth must reach the mate on the long axis."""
    depth = form.addendum + form.dedendum
    if deflection >= depth:
        raise InputError(
            f"the wave generator deflects the flexspline by {deflection:.3g} modules for each pair of "
            f"teeth of difference, more than its teeth are deep, {depth:.3g} modules",
            key="deflection",
        )
    if not clearance < depth:
        raise InputError(
            f"the clearance of {clearance:.3g} modules is not less than the depth of the teeth, {depth:.3g}",
            key="clearance",
        )


def _check_free(
    form: DoubleArcForm | InvoluteForm, deflection: float, clearance: float, difference: int
) -> None:
    """The teeth must come free of given ones at the short axis; tips of swept ones are cut for that."""
    depth = form.addendum + form.dedendum
    least = depth - deflection * difference
    if clearance < least - _SLACK:
        raise InputError(
            f"with a clearance of {clearance:.4g} modules the teeth do not come free at the short axis: they "
            f"reach {depth - clearance:.4g} modules into each other, and twice the deflection is "
            f"{deflection * difference:.4g} modules; a clearance of {least:.4g} or a larger deflection "
            "frees them",
            key="clearance",
        )


def _check_as_given(*sizes: float) -> None:
    """How tips and bottoms are made is said of swept splines; a given one is as it is given."""
    usual = signature(build_strain_wave).parameters
    for name, size in zip(("tip_relief", "relief_length", "bottom_clearance"), sizes, strict=True):
        if size != usual[name].default:
            raise InputError(
                f"{size:.4g} modules were given, which would not shape a given circular spline; leave it "
                "out, or leave the flanks of the circular spline to the flexspline's sweep",
                key=name,
            )


def _weights(shape: str | tuple[float, ...], angle: float, relative: float) -> np.ndarray:
    """Amplitudes over the deflection, of a wave with its crests on the long axis and nowhere else."""
    if isinstance(shape, str):
        weights = WAVE_SHAPES[shape].harmonics(angle, relative)
    elif 1 <= len(shape) <= TERMS:
        weights = np.pad(np.asarray(shape, dtype=float), (0, TERMS - len(shape)))
    else:
        raise InputError(
            f"{len(shape)} amplitudes of the wave were given; allowed are 1 to {TERMS}", key="shape"
        )
    places = np.linspace(0.0, pi / 2.0, 91)
    radial = np.cos(2.0 * np.arange(1, TERMS + 1) * places[:, None]) @ weights
    if not (
        np.isfinite(radial).all() and radial[0] > 0.0 and radial[0] >= radial.max() * (1 - 1e-9)
    ):
        raise InputError(
            "the flexspline would not be pushed out most on the long axis; "
            + (
                f"forces {np.degrees(angle):.3g} degrees beside it are too far away"
                if shape == "four_forces"
                else "the amplitudes of the wave must have their sum as its largest value"
            ),
            key="force_angle" if shape == "four_forces" else "shape",
        )
    return np.asarray(weights / weights.sum())


def _held(z1: int, found: Survey, module: float) -> int:
    """Pairs held at each end of the long axis."""
    pitch = 2.0 * pi / z1
    return int(floor(_last(found, module) / pitch) - ceil(WINDOW[0] / pitch))


def _last(found: Survey, module: float) -> float:
    """Angle up to which pairs are held: the short axis where teeth are near each other that far."""
    near = np.asarray(found.left) < _NEAR * module
    return pi / 2.0 if near[np.asarray(found.angle) > WINDOW[1]].any() else WINDOW[1]


@program
def _prepared(flank: FlexsplineFlank) -> FlexsplineFlank:
    return flank.prepared()


@program
def _tip_height(motion: ToothMotion, angle: Float[Array, ""]) -> Float[Array, ""]:
    """Height of the tip of a tooth at an angle from the long axis [m]."""
    return jnp.real(motion.place(motion.flank.length, angle))


_given_groove = program(involute_groove)
_lands = program(Groove.land)


def _cut(plan: _Plan, programs: _Programs) -> tuple[float, Groove, float]:
    """Height of tips that keep a land, the groove whose teeth between keep it, and the land [m]."""
    numbers = plan.tips, plan.mate_angle, array(LEAST_LAND * plan.module)
    groove, raised, land = programs.sweep(plan.cutter, array(plan.low), *numbers)
    tips = float(raised)
    if tips == plan.low:
        return tips, groove, float(land)
    if not np.isfinite(tips):
        raise InputError(
            "the flexspline's teeth leave nothing of the circular spline's: they are too thick or come "
            "free too late",
            key="form",
        )
    groove, _, land = programs.sweep(plan.cutter, raised, *numbers)
    return tips, groove, float(land)


def _given(plan: _Plan, form: InvoluteForm) -> tuple[float, Groove, float]:
    """Height of the tips, groove and land of an involute circular spline [m]."""
    z2, module, travel = plan.splines[1], plan.module, plan.cutter
    flank = _involute(form, z2, module, 0.0, None)
    high = jnp.real(travel.place(travel.flank.length, jnp.zeros(())))
    root = module * (z2 / 2.0 + form.profile_shift + form.dedendum)
    if float(high) > root:
        raise InputError(
            f"the flexspline's tips reach a radius of {1e3 * float(high):.5g} mm on the long axis, and "
            f"the root circle of the circular spline has {1e3 * root:.5g} mm",
            key="groove",
        )
    tip = max(plan.low, module * (z2 / 2.0 + form.profile_shift - form.addendum))
    groove = _given_groove(flank, array(tip), high)
    return plan.low, groove, float(_lands(groove, plan.mate_angle)[0])


def _check_play(plan: _Plan, without: float) -> None:
    """Play is taken off the circular spline's teeth; something must be left of their tips."""
    land = without + 2.0 * plan.edge
    if plan.backlash >= land:
        raise InputError(
            f"a play of {1e6 * plan.backlash:.6g} um leaves nothing of the circular spline's tips, which are "
            f"{1e6 * land:.3g} um wide without it",
            key="backlash",
        )


def _faults(at: _Contact, module: Number, backlash: Number, *, conjugate: bool) -> Faults:
    """Rigid teeth must touch, without overlap, and somewhere with a positive relative curvature."""
    where = "form" if conjugate else "groove"

    def refuse(text: str) -> NoReturn:
        raise InputError(text, key=where)

    yield (
        at.least < -(SWEPT_ACCURACY if conjugate else INTERFERENCE) * module,
        lambda: refuse(
            f"flexspline and circular spline interfere: {-1e6 * at.least:.3g} um of overlap "
            f"{np.degrees(at.angle):.3g} degrees from the long axis"
        ),
    )
    yield (
        at.least == inf,
        lambda: refuse(
            "no tooth of the flexspline engages: nowhere along the wave do its teeth reach those of the "
            "circular spline"
        ),
    )
    beyond = at.least - backlash / 2.0  # each flank has half of the play
    yield (
        beyond >= _FARTHEST * module,
        lambda: refuse(
            "no tooth of the flexspline engages: the least clearance is "
            f"{1e6 * beyond:.3g} um beyond the backlash, and a tenth of "
            "the module is the most that load can close"
        ),
    )
    yield (
        at.rolls == 0,
        lambda: refuse(
            "the relative curvature is nowhere positive where the flanks touch: the teeth meet at "
            "edges alone"
        ),
    )
