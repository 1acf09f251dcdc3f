"""Strain wave gear: wave generator, flexspline and circular spline, and the many contacts between them."""

import dataclasses
from typing import Any, ClassVar, Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int, Shaped

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, Shape, contact_velocity
from pitchpoint.contact.surface import Spot, Surfaces, other_side
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.core.roots import find_root, hypot
from pitchpoint.gears.coordinates import AXIAL, Coordinate
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import completed, drawing, independent, main_dimensions
from pitchpoint.gears.pairs import (
    WAVE,
    flanks_in_turn,
    in_pairs,
    largest_radius,
    of_pairs,
    on_edge,
    touching,
    way_of_pairs,
)
from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.gears.strain_wave.ball_bearing import ThinRaceBearing
from pitchpoint.gears.strain_wave.body import StrainWaveBody, end_of_wave, left_behind
from pitchpoint.gears.strain_wave.contact_width import curvature_in_contact
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing
from pitchpoint.gears.strain_wave.flexspline_tooth import FlexsplineFlank, unit_circle_place
from pitchpoint.gears.strain_wave.groove import Groove, SplineTips, swept
from pitchpoint.gears.strain_wave.in_series import InSeries
from pitchpoint.gears.strain_wave.tooth_motion import PassingPoint, ToothMotion
from pitchpoint.gears.strain_wave.wave_generator import NeutralLine
from pitchpoint.gears.tooth_section import RING_RIM, ToothSection, chebyshev_nodes, tooth_sections

__all__ = [
    "WINDOW",
    "StrainWave",
    "Survey",
    "Touching",
    "lanes_for_pairs",
    "nearest_points",
    "places",
    "survey",
]

WINDOW = (np.deg2rad(-30.0), np.deg2rad(50.0))
"""Angles from the long axis between which pairs are held; others are far from touching.

Where teeth are as near as that beyond, as deep ones with little deflection are, they are held up to
the short axis.
"""

PLACES = (25, 45, 56)
"""Places for pairs in a zone, so that drives of up to 112, 202 and 252 teeth share programs.

More come in multiples of the first. Both zones of 56, with their second places, stay below 128 rows, from
which on a factorisation may wait for other threads, see `_jax`.
"""

TRIES = (29, 14)
"""Places on a flank and on its rounding at which the clearance is looked at before its least is found."""

_DEEP = np.deg2rad(4.5)
"""Angle from the long axis up to which a pair may touch at two places."""

_FLATTEST = (
    2000.0  # modules: with a larger radius a contact under load is wider than the flank high
)
# What is at an end but for rounding is at it.
_SLACK = 1e-9
_AROUND = np.deg2rad(6.0)
_BEYOND = np.linspace(WINDOW[1], np.pi / 2.0, 161)
_ALONG = np.concatenate([np.linspace(*WINDOW, 541), np.linspace(-_AROUND, _AROUND, 961), _BEYOND])
_ALONG = np.unique(np.round(_ALONG, 12))  # no two that differ by rounding alone
_LIGHT = 1e-3  # clearance in modules below which a pair counts as touching

Lanes = Float[Array, "pair slice *b"]
Each = Float[Array, "*b"]


class Touching(eqx.Module):
    """Nearest points of a flexspline flank and its groove.

    Attributes:
        along: arc length on the flexspline's flank [m].
        at: place and motion of that point.
        clearance: along the normal [m].
        mate: curvature of the circular spline's flank there [1/m].
        held: True where the nearest point is an end of the flank and does not roll.
        share: part of the face that counts here, one where a tooth touches at one place alone.
    """

    along: Each
    at: PassingPoint
    clearance: Each
    mate: Each
    held: Bool[Array, "*b"]
    share: Each


class Survey(eqx.Module):
    """Rigid teeth along the wave.

    Attributes:
        angle: from the long axis [rad].
        clearance: along the normal; NaN where teeth do not reach into each other [m].
        left: clearance once the splines are turned up to the first touch; infinite where teeth do not
            reach into each other [m].
        rolls: True where flanks touch with a positive relative curvature, no end of a flank.
        pairs: that touch, mean number.
        reversal: angle at which sliding changes its sense [rad].
    """

    angle: Float[Array, " angle"]
    clearance: Float[Array, " angle"]
    left: Float[Array, " angle"]
    rolls: Bool[Array, " angle"]
    pairs: Float[Array, ""]
    reversal: Float[Array, ""]


class StrainWave(Mesh):
    """A flexspline in a circular spline. Coordinates: rotations in the order of `members.STRAIN_WAVE`.

    The wave generator has two lobes. The flanks that face in the sense of positive rotation carry,
    so torques on flexspline and wave generator are positive. Any member may be fixed, any other one
    drives, in the sense that presses the flanks together. Phase 0 to 1 moves the teeth by one pitch
    along the wave. The first half of the pairs lies at one end of the long axis, the second at the
    other.

    Attributes:
        teeth: numbers of teeth of flexspline and circular spline z1, z2.
        module: [m].
        face_width: [m].
        flank: of the flexspline teeth.
        line: neutral line of the flexspline as the wave generator deforms it.
        groove: space of the circular spline.
        rim: rim, cup and support of the flexspline.
        bearing: balls that take the place of that support; None without.
        series: what yields behind them.
        tip_height: radius at which the circular spline's teeth end [m].
        tips: how the tips of both splines are made.
        backlash: play between the flanks beyond the groove that just lets the teeth through, on
            the circumference [m]. It opens all gaps alike, so losses have one derivative by it on
            both sides, at no play too.
        held: pairs in each of both zones.
        surveyed: rigid teeth along the wave, as they follow from all these.
        edges_carry: True if the rounding of the flexspline's tips may carry; static.
        conjugate: True if the groove follows from the flexspline and its motion; static.
        odd: True if the flexspline has an odd number of teeth: zones are half a pitch apart; static.
        lanes: places for pairs in each of both zones, see `lanes_for_pairs`; those beyond `held` stay empty;
            static.
        surfaces: how the flanks of flexspline and circular spline differ from their design.
    """

    shape: ClassVar[Shape] = "line"

    teeth: Float[Array, "2"]
    module: Float[Array, ""]
    face_width: Float[Array, ""]
    flank: FlexsplineFlank
    line: NeutralLine
    groove: Groove
    rim: FlexibleRing
    bearing: ThinRaceBearing | None
    series: InSeries
    tip_height: Float[Array, ""]
    tips: SplineTips
    backlash: Float[Array, ""]
    held: Float[Array, ""]
    surveyed: Survey
    edges_carry: bool = eqx.field(static=True)
    conjugate: bool = eqx.field(static=True)
    odd: bool = eqx.field(static=True)
    lanes: int = eqx.field(static=True)
    surfaces: Surfaces = ((), ())

    def completed(self) -> Self:
        """The drive with its groove as it follows from flank and motion, and what follows from both.

        The tips of the circular spline stay where they are, and so does the number of pairs that are
        held: a change of the deflection changes the clearance of the tips, which `build_strain_wave`
        would keep.
        """
        drive = self
        if self.conjugate:
            groove = swept(self.cutter_motion, self.tip_height, self.tips)
            drive = dataclasses.replace(self, groove=groove)
        drive_values = drive.backlash, drive.module, drive.tooth_angle, drive.edges_carry
        surveyed = survey(drive.tooth_motion, drive.groove, *drive_values)
        return dataclasses.replace(drive, surveyed=surveyed)

    @property
    def pairs(self) -> Float[Array, ""]:
        """Mean number of pairs that touch without load."""
        return self.surveyed.pairs

    @property
    def reversal(self) -> Float[Array, ""]:
        """Angle from the long axis at which the sliding of a tooth changes its sense [rad]."""
        return self.surveyed.reversal

    @property
    def tooth_motion(self) -> ToothMotion:
        """How a flexspline tooth passes the space that it meets."""
        return self._motion_of(self.flank)

    @property
    def cutter_motion(self) -> ToothMotion:
        """The same of a tooth without relief, which sweeps the groove."""
        return self._motion_of(self.flank.unrelieved)

    def _motion_of(self, flank: FlexsplineFlank) -> ToothMotion:
        return ToothMotion(flank.prepared(), self.line, 1.0 - self.teeth[0] / self.teeth[1])

    @property
    def tooth_angle(self) -> Float[Numbers, ""]:
        """Angle of one pitch of the flexspline [rad]."""
        return 2.0 * jnp.pi / self.teeth[0]

    @property
    def relation(self) -> Float[Array, "3"]:
        """Teeth that are left behind in a turn of the wave: z2 q_C = z1 q_F + (z2 - z1) q_W."""
        return left_behind(self.teeth)

    @property
    def pitch(self) -> Float[Numbers, ""]:
        """Angle by which the wave moves on by one tooth of the flexspline [rad]."""
        return self.tooth_angle

    @property
    def passing(self) -> Float[Array, "3"]:
        """A wave that runs ahead of the flexspline meets teeth of growing angle, and phases fall."""
        return jnp.array([-1.0, 1.0, 0.0])

    def events(self) -> Float[Array, " event"]:
        """Phases at which the sliding of a tooth changes its sense; pairs enter and leave without load."""
        phase = jnp.mod(self.reversal / self.tooth_angle, 1.0)
        return jnp.sort(jnp.mod(jnp.stack([phase, phase + 0.5]), 1.0)) if self.odd else phase[None]

    @property
    def contact_ratio(self) -> Float[Array, ""]:
        """Mean number of pairs that touch without load, to a thousandth of the module."""
        return self.pairs

    def overlaps(self, angle: Float[Array, "*b"]) -> Bool[Array, "*b"]:
        """True where what may carry of a tooth reaches into the circular spline's teeth."""
        return _overlaps(self.tooth_motion, self.groove, angle, self.edges_carry)

    @property
    def pitch_diameter(self) -> float:
        """Reference diameter of the flexspline, of plain numbers, for which nothing is compiled [m]."""
        return float(self.module) * float(np.asarray(self.teeth)[0])

    @property
    def _zone(self) -> np.ndarray:
        """End of the long axis at which each place lies."""
        return np.repeat([0, 1], self.lanes + seconds_for(self.lanes))

    @property
    def _second(self) -> np.ndarray:
        """True for places that hold the second valley of a pair that has one."""
        return np.tile(np.arange(self.lanes + seconds_for(self.lanes)) >= self.lanes, 2)

    @property
    def _number(self) -> Float[Array, " place"]:
        """Number of the pair at each place, counted from the first one that is held in its zone."""
        return jnp.asarray(_numbers(self.teeth, self.lanes, jnp))

    @property
    def _start(self) -> Float[Array, ""]:
        """Teeth from the long axis to the first pair that is held."""
        return jnp.ceil(WINDOW[0] / self.tooth_angle)

    def nearest(self, angle: Float[Array, "*b"]) -> Touching:
        """Nearest points of the flank and its groove for teeth at angles from the long axis [rad]."""
        return nearest_points(
            self.tooth_motion, self.groove, angle, self.backlash, edges_carry=self.edges_carry
        )

    def angles(self, phase: Float[Array, "*b"]) -> Lanes:
        """Angle of each tooth from the end of the long axis that is nearest [rad]."""
        phase = jnp.asarray(phase)
        zone, number = (_as_lanes(by_lane, phase) for by_lane in (self._zone, self._number))
        moved = jnp.mod(phase + zone * self.teeth[0] / 2.0, 1.0)
        return (self._start + number + moved) * self.tooth_angle

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of the pairs of both zones; one period is one pitch of the flexspline."""
        raw = self.raw_contacts(phase)
        # Teeth that carry only because others yield do not close on the nominal motion. In a steady
        # state no energy goes into the travelling pattern of strains, so that part does no work.
        motion = self._passing_over
        inner = motion - jnp.mean(motion)
        elastic = contact_velocity(raw.normal, motion) / (inner @ inner)
        return dataclasses.replace(
            raw, normal=raw.normal - jnp.stack([elastic * rate for rate in inner])
        )

    @property
    def _passing_over(self) -> Float[Array, "3"]:
        """Rates while the wave passes over a circular spline that is held."""
        wave, flexspline, _ = self.relation
        return jnp.stack([jnp.ones(()), -wave / flexspline, jnp.zeros(())])

    def raw_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts with the arms of rigid teeth: before the elastic part is taken out of the normal arms."""
        tooth_angles = self.angles(phase)
        holds = _as_lanes(self._number, jnp.asarray(phase)) < self.held
        active = self.overlaps(tooth_angles) & holds
        angle = jnp.where(active, tooth_angles, 0.0)
        motion = self.tooth_motion
        second = _as_lanes(self._second, jnp.asarray(phase))
        touching = nearest_points(
            motion, self.groove, angle, second=second, edges_carry=self.edges_carry
        )
        active &= touching.share > 0.0
        at, none = touching.at, jnp.zeros_like(angle)
        # Flanks that overlap do so by the error of the groove's table. The play comes on top of
        # that: cut off together, its derivative would be the sign of rounding where flanks touch.
        play = self.backlash / 2.0 * jnp.cos(at.direction)
        sum_curvature = jnp.maximum(at.curvature + touching.mate, 1.0 / largest_radius(self))
        roll = (at.turning - touching.mate * at.sliding) / sum_curvature
        roll = jnp.where(touching.held, 0.0, roll)
        velocity = jnp.stack([-at.shift, at.shift + at.whole, -at.whole])
        local = unit_circle_place(-at.direction) * velocity
        flank_speed = jnp.stack([roll, -roll, none])
        mate = sum_curvature - at.curvature
        flat = self.module, largest_radius(self)
        # The space that a tooth meets lies at its angle around the circular spline.
        zone = _as_lanes(self._zone, jnp.asarray(phase))
        turned = unit_circle_place(tooth_angles * self.teeth[0] / self.teeth[1] + jnp.pi * zone)
        return Contacts(
            active=active,
            path=tooth_angles / (2.0 * jnp.pi),
            width=none,
            weight=self.face_width * jnp.where(active, touching.share, 1.0),
            curvature=jnp.stack([jnp.stack([at.curvature, none]), jnp.stack([mate, none])]),
            surface=jnp.stack([flank_speed, flank_speed - jnp.real(local)]),
            normal=jnp.imag(local),
            gap=jnp.maximum(touching.clearance, 0.0) + play,
            flank=jnp.stack([touching.along, self.groove.depth(jnp.real(at.place))]),
            point=_vector(turned * at.place),
            direction=_vector(1j * turned * unit_circle_place(at.direction)),
            tangent=_vector(turned * unit_circle_place(at.direction)),
            felt=curvature_in_contact(motion, self.groove, touching.along, angle, *flat),
            shape="line",
        )

    @property
    def body(self) -> StrainWaveBody:
        """Rim and cup of the flexspline, what holds them, what yields behind them, circular spline."""
        return StrainWaveBody(
            flank=self.flank,
            line=self.line,
            rim=self.rim,
            bearing=self.bearing,
            series=self.series,
            teeth=self.teeth,
        )

    @property
    def other_flanks(self) -> Self:
        """The same drive but for what the flanks that carry alone have."""
        of_flexspline, of_spline = (other_side(of_member) for of_member in self.surfaces)
        return dataclasses.replace(self, surfaces=(of_flexspline, of_spline))

    def spots(self, contacts: Contacts, phase: Float[Arrays, "..."]) -> tuple[Spot, Spot]:
        """Angles are those of the teeth, which stand as they are while they touch.

        A tooth that lies behind its place moves along the circumference; the normals of roundings at root
        and tip lean to the radius.
        """
        around = places(contacts, phase, self.teeth)
        across = jnp.where(contacts.active, jnp.abs(self.body.ring_loads(contacts).tangential), 0.0)
        leaning = across / jnp.max(across)
        flexspline_spot, spline_spot = (
            Spot(
                flank=contacts.flank[member],
                across=contacts.width,
                angle=around[member],
                tooth=jnp.mod(jnp.round(around[member] / (2.0 * jnp.pi / z)), z).astype(int),
                leaning=leaning,
            )
            for member, z in enumerate(self.teeth)
        )
        return flexspline_spot, spline_spot

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The three bodies on their common axis, x along the long axis of the wave generator."""
        flanks, rigid = (None, 0, 1), (True, False, True)
        centre, axis = jnp.zeros(3), jnp.asarray(AXIAL)
        return tuple(
            Coordinate(name, centre, axis, member, rigid=stiff)
            for name, member, stiff in zip(MEMBERS, flanks, rigid, strict=True)
        )

    @property
    def _flexspline_section(self) -> ToothSection:
        flank, ends = self.flank, jnp.stack([1e-6, 1.0]) * jnp.sqrt(self.flank.length)
        along, rate = _stations(ends)
        place = flank.place(along)
        half, height = jnp.imag(place), jnp.real(place)
        return _section(half, height, jnp.cos(flank.angle(along)) * rate, flank.angle(along), ends)

    @property
    def _circular_section(self) -> ToothSection:
        groove = self.groove
        deepest = groove.depth(groove.low)
        ends = jnp.stack([1e-6, 1.0]) * jnp.sqrt(deepest)
        depth, rate = _stations(ends)
        heights = groove.made
        depths = groove.depth(heights)
        radius = jnp.interp(depth, depths[::-1], heights[::-1])
        width, slope = groove.width_and_slope(radius)
        half = jnp.pi / self.teeth[1] * radius - width - self.backlash / 2.0
        return _section(
            half, heights[-1] - radius, rate / hypot(1.0, slope), -jnp.arctan(slope), ends
        )

    @property
    def _outline(self) -> Array:
        """Flexspline tooth from root to root over its tip."""
        flank = self.flank.place(jnp.linspace(0.0, 1.0, 81) * self.flank.length)
        return jnp.concatenate([jnp.conj(flank), flank[::-1]])


def _vector(place: Array) -> Float[Array, "3 pair slice *b"]:
    """Vector of a place in the plane across the axis."""
    return jnp.stack([jnp.real(place), jnp.imag(place), jnp.zeros(place.shape)])


def seconds_for(lanes: int) -> int:
    """Places for pairs near the long axis that touch at two places, in a zone with so many pairs."""
    return 1 + lanes // 9


def lanes_for_pairs(held: int) -> int:
    """Places for so many pairs in a zone: one of a few sizes."""
    several = -(-held // PLACES[0]) * PLACES[0]
    return next((size for size in PLACES if held <= size), several)


def survey(
    motion: ToothMotion,
    groove: Groove,
    backlash: Float[Array, ""],
    module: Float[Array, ""],
    tooth_angle: Float[Array, ""],
    edges_carry: bool = False,
) -> Survey:
    """Clearances along the wave, and what follows from them for the whole drive.

    Args:
        motion: of the flexspline teeth.
        groove: of the circular spline.
        backlash: play on the circumference beyond the groove [m].
        module: [m].
        tooth_angle: of one pitch of the flexspline [rad].
        edges_carry: True if the rounding of the flexspline's tips may carry, static.
    """
    angle = jnp.asarray(_ALONG)
    touching = nearest_points(motion, groove, angle, backlash, edges_carry=edges_carry)
    overlaps = _overlaps(motion, groove, angle, edges_carry)
    upright = jnp.abs(jnp.imag(unit_circle_place(-touching.at.direction) * touching.at.whole))
    part = upright / jnp.abs(touching.at.whole)
    reaches = overlaps & (part > 0.0)
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    play = jnp.min(jnp.where(reaches, touching.clearance / jnp.where(reaches, part, 1.0), jnp.inf))
    left = jnp.where(reaches, touching.clearance - part * play, jnp.inf)
    return Survey(
        angle=angle,
        clearance=jnp.where(overlaps, touching.clearance, jnp.nan),
        left=left,
        rolls=~touching.held & (touching.at.curvature + touching.mate > 0.0),
        pairs=2.0 * jnp.trapezoid((left < _LIGHT * module) * 1.0, angle) / tooth_angle,
        reversal=_reversal(angle, touching.at.sliding, overlaps),
    )


def _overlaps(
    motion: ToothMotion, groove: Groove, angle: Float[Array, "*b"], edges_carry: bool
) -> Bool[Array, "*b"]:
    """True where what may carry of a flank reaches into the circular spline's teeth."""
    flank = motion.flank
    end = flank.place(flank.length) if edges_carry else flank.rounding_start
    return jnp.asarray(jnp.real(motion.carried(end, angle)) > groove.low)


def _as_lanes(each: Array | np.ndarray, phase: Float[Array, "*b"]) -> Shaped[Arrays, "pair 1 ..."]:
    """Values of the pairs, broadcast over slices and phases."""
    return jnp.reshape(each, (-1, *(1 for _ in range(phase.ndim + 1))))


def places(
    contacts: Contacts, phase: Float[Arrays, "*#b"], teeth: Float[Array, "2"]
) -> Float[Array, "member pair slice *b"]:
    """Angles around flexspline and circular spline at which their teeth touch [rad].

    Over one turn of the wave generator against the circular spline the phase moves by as many
    periods as that has teeth.

    Args:
        contacts: of a strain-wave gear, `path` the angle from the long axis [turns]; the first half
            of the pairs lies at one end of it, the second at the other.
        phase: at which they were taken, counted on beyond one period [periods].
        teeth: of flexspline and circular spline.
    """
    since_start, end = 2.0 * jnp.pi * (contacts.path - phase / teeth[0]), end_of_wave(contacts)
    return jnp.stack([since_start + end, since_start * (teeth[0] / teeth[1]) + end])


def nearest_points(
    motion: ToothMotion,
    groove: Groove,
    angle: Float[Array, "*b"],
    backlash: Float[Array, ""] | float = 0.0,
    *,
    second: Bool[Arrays, "*#b"] | bool = False,
    edges_carry: bool = False,
) -> Touching:
    """Nearest points of flexspline flanks and their grooves.

    The play along the circumference is least there, so the flanks have a common normal unless an end
    of the flank is nearest. Near the long axis the play has two valleys, one at the root and one at the tip
    of a tooth, which both may carry.

    Args:
        motion: of the flexspline teeth.
        groove: of the circular spline.
        angle: of the teeth from the long axis [rad].
        backlash: play on the circumference beyond the groove [m].
        second: True for the second one of two valleys.
        edges_carry: True if the rounding of the tips counts as part of the flank, static.
    """
    flank, angle = motion.flank, jnp.asarray(angle)
    stations = flank.stations(TRIES[0], TRIES[1] * edges_carry)
    nearest, share = _valley(motion, groove, angle, stations, second)
    last_station, end = stations.shape[0] - 1, jax.lax.stop_gradient(stations[-1])
    # The bounds move with the flank, and so does a point that is held at one.
    foot, axis = motion.foot(angle)
    turned = unit_circle_place(axis)
    before, after = (stations[k] for k in (jnp.maximum(nearest - 1, 0), nearest))
    # What lies below the tip of the mate meets nothing.
    below, above = (jnp.real(foot + turned * flank.place(along)) for along in (before, after))
    out = (groove.low - below) / jnp.where(above > below, above - below, jnp.inf)
    begin = before + jnp.clip(out, 0.0, 1.0) * (after - before)

    def slope_at(along: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Growth of the play along the flank."""
        _, slope = groove.width_and_slope(jnp.real(foot + turned * flank.place(along)))
        direction = axis - flank.angle(along)
        return slope * jnp.cos(direction) - jnp.sin(direction)

    # Where the play grows from the station before, a ridge lies on the way, and the valley beyond the next.
    ridge = (slope_at(begin) > 0.0) & (out <= 0.0) & (nearest > 0) & (nearest < last_station)
    begin = jnp.where(ridge, after, begin)
    most = stations[jnp.minimum(nearest + 1, last_station)] - begin

    def growth(beyond: Float[Array, "*b"]) -> Float[Array, "*b"]:
        return slope_at(begin + beyond)

    # At an end of the flank the play may still fall: then the end is nearest. Where the tip of the mate is
    # nearest it grows from there on, and teeth apart have no nearest point: none waits for those.
    grows = growth(jnp.zeros_like(most)) > 0.0
    apart = ~_overlaps(motion, groove, angle, edges_carry)
    ends = jnp.where((nearest == 0) | grows, 0.0, most)
    inwards = jnp.where(nearest == 0, -1.0, 1.0) * growth(ends)
    bounded = (((nearest == 0) | (nearest == last_station)) & (inwards < 0.0)) | grows | apart

    def widening(beyond: Float[Array, "*b"]) -> Float[Array, "*b"]:
        return jnp.where(bounded, (beyond - ends) / most, growth(beyond))

    guess = jnp.where(bounded, ends, most / 2.0)
    beyond, _ = find_root(widening, guess, jax.lax.stop_gradient(most) * (1.0 + _SLACK))
    nearest_along = begin + jnp.clip(beyond, 0.0, most)
    at = motion.at(nearest_along, angle)
    width, _ = groove.width_and_slope(jnp.real(at.place))
    play = width + backlash / 2.0 - jnp.imag(at.place)
    return Touching(
        along=nearest_along,
        at=at,
        clearance=play * jnp.cos(at.direction),
        mate=groove.curvature_at(jnp.real(at.place)),
        held=(nearest_along <= 0.0) | (nearest_along >= end * (1.0 - 1e-12)),
        share=share,
    )


def _valley(
    motion: ToothMotion,
    groove: Groove,
    angle: Float[Array, "*b"],
    stations: Float[Array, " station"],
    second: Bool[Arrays, "*#b"] | bool,
) -> tuple[Int[Array, "*b"], Float[Array, "*b"]]:
    """Station in the valley of the play that is asked for, and the part of the face that counts there.

    Two contacts of a tooth bend it together, so they share its face: in the ratio of how far the play rises
    from each to the ridge between them. One that appears, or goes over into the other, thus does so
    without load.
    """
    frozen, space, where, along = jax.lax.stop_gradient((motion, groove, angle, stations))
    height, across = frozen.passed(along, where)
    width, _ = space.width_and_slope(height)
    play = jnp.where(height < space.low, jnp.inf, width - across)
    beside = jnp.pad(play, ((1, 1), *((0, 0) for _ in where.shape)), constant_values=jnp.inf)
    low = jnp.isfinite(play) & (play < beside[:-2]) & (play <= beside[2:])
    number = jnp.arange(along.shape[0]).reshape(-1, *(1 for _ in where.shape))
    lowest = jnp.argmin(jnp.where(low, play, jnp.inf), axis=0)
    others = low & (number != lowest)
    second_lowest = jnp.argmin(jnp.where(others, play, jnp.inf), axis=0)
    two = jnp.any(others, axis=0)
    ends = jnp.minimum(lowest, second_lowest), jnp.maximum(lowest, second_lowest)
    between = (number >= ends[0]) & (number <= ends[1])
    ridge = jnp.argmax(jnp.where(between, play, -jnp.inf), axis=0)

    def play_at(station: Int[Array, "*b"]) -> Float[Array, "*b"]:
        place = motion.place(stations[station], angle)
        return groove.width_and_slope(jnp.real(place))[0] - jnp.imag(place)

    top = play_at(ridge)
    rises = [jnp.where(two, top - play_at(station), 1.0) for station in (lowest, second_lowest)]
    part = jnp.where(two, rises[1] / (rises[0] + rises[1]), 0.0)
    # The place nearer to the root is the first one.
    later = jnp.where(two, jnp.where(lowest < second_lowest, second, ~jnp.asarray(second)), second)
    return jnp.where(later, second_lowest, lowest), jnp.where(later, part, 1.0 - part)


def _reversal(
    angle: Float[Array, " angle"], sliding: Float[Array, " angle"], overlaps: Bool[Array, " angle"]
) -> Float[Array, ""]:
    """Angle at which teeth stop their inward motion, so that sliding turns negative [rad].

    Of several the one nearest to the long axis; that axis itself where there is none.
    """
    turns = overlaps[:-1] & overlaps[1:] & (sliding[:-1] >= 0.0) & (sliding[1:] < 0.0)
    before = jnp.argmin(jnp.where(turns, jnp.abs(angle[:-1]), jnp.inf))
    sliding_before, sliding_after = sliding[before], sliding[before + 1]
    part = sliding_before / jnp.where(turns[before], sliding_before - sliding_after, 1.0)
    at = angle[before] + part * (angle[before + 1] - angle[before])
    return jnp.where(jnp.any(turns), at, 0.0)


def _numbers(teeth: Any, lanes: int, module: Any) -> Any:
    """Numbers of the pairs at the places, by the functions of JAX or of NumPy, which compiles nothing."""
    angle = 2.0 * np.pi / teeth[0]
    second = module.ceil(-_DEEP / angle) - module.ceil(WINDOW[0] / angle)
    deep = np.arange(seconds_for(lanes)) + second
    return module.tile(module.concatenate([np.arange(lanes), deep]), 2)


def _points(places: Array) -> Float[Array, "... 2"]:
    return jnp.stack([jnp.imag(places), jnp.real(places)], axis=-1)


def _stations(ends: Float[Array, "2"]) -> tuple[Float[Array, " node"], Float[Array, " node"]]:
    """Arc lengths at the nodes of a tooth section, and their derivative with respect to the node's place."""
    place = jnp.asarray(chebyshev_nodes())
    low, high = ends[0], ends[1]
    reach = (high + low + place * (high - low)) / 2.0
    return reach**2, reach * (high - low)


def _section(
    half: Array, height: Array, slope: Array, angle: Array, ends: Float[Array, "2"]
) -> ToothSection:
    """A tooth on a ring; its fillet is left out."""
    return ToothSection(
        fillet=jnp.stack([half[:1], height[:1]]),
        step=jnp.zeros(1),
        flank=jnp.stack([half, height]),
        slope=slope,
        load_angle=angle,
        reach=ends,
        root_radius=jnp.ones(()),
        root_half_angle=jnp.ones(()),
        rim_ratio=jnp.ones(()),
        stiff=RING_RIM,
    )


@main_dimensions.register
def _main_dimensions(drive: StrainWave) -> dict[str, Float[Array, "..."]]:
    """Deflection, radii and the depth to which the teeth reach into each other."""
    return {
        "module": drive.module,
        "deflection": drive.line.deflection,
        "neutral_radius": drive.line.radius,
        "engagement_depth": drive.groove.high - drive.groove.low,
    }


@drawing.register
def _drawing(drive: StrainWave) -> dict[str, Float[Array, "..."]]:
    """Outlines of tooth and space, the deformed neutral line, the tooth on its way; lengths in m.

    Points are (across, outwards): of the tooth from its axis and the neutral line, of the space from
    its middle and the common axis.
    """
    tooth = drive._outline
    angle = jnp.deg2rad(jnp.linspace(-90.0, 90.0, 37))
    foot, axis = drive.tooth_motion.foot(angle)
    placed = foot[:, None] + unit_circle_place(axis[:, None]) * tooth
    width, heights = drive.groove.half_width + drive.backlash / 2.0, drive.groove.made
    space = jnp.concatenate([heights - 1j * width, (heights + 1j * width)[::-1]])
    return {
        "teeth": drive.teeth,
        "tooth": _points(tooth),
        "space": _points(space),
        "passing_angle": angle,
        "passing": _points(placed),
        "neutral_radius": drive.line.radius,
        "deflection": drive.line.deflection,
        "wave_weights": drive.line.weights,
        "rim_thickness": drive.rim.thickness,
        "tip_height": drive.tip_height,
        "clearance_angle": drive.surveyed.angle,
        "clearance": drive.surveyed.clearance,
    }


@largest_radius.register
def _largest_radius(drive: StrainWave) -> Float[Array, ""]:
    """Flatter contacts would be wider under load than the flank is high."""
    return _FLATTEST * drive.module


@in_pairs.register
def _in_pairs(
    drive: StrainWave, values: np.ndarray, axis: int, *, like_first: bool = False
) -> np.ndarray:
    """Values by pairs that are held, of two places the one nearer to the root first."""
    number, zone = _numbers(np.asarray(drive.teeth), drive.lanes, np).astype(int), drive._zone
    (root_pairs,) = np.nonzero(~drive._second & (number < float(drive.held)))
    matches = (
        (zone == zone[root_pairs, None]) & (number == number[root_pairs, None]) & drive._second
    )
    tip_pairs = np.where(matches.any(axis=1), matches.argmax(axis=1), -1)
    root_values, beside = np.take(values, root_pairs, axis), np.take(values, tip_pairs, axis)
    lone = (tip_pairs < 0).reshape(-1, *(1 for _ in range(values.ndim - axis - 1)))
    empty = root_values if like_first else np.zeros_like(root_values)
    return np.concatenate([root_values, np.where(lone, empty, beside)], axis=axis + 1)


@on_edge.register
def _on_edge(drive: StrainWave, contacts: Contacts) -> Bool[Array, "pair slice *b"]:
    """True at the end of a flexspline flank, or on the rounding of either tip."""
    groove, ends = drive.groove, drive.flank.plain * (1.0 - _SLACK)
    rounded = groove.depth(drive.tip_height + drive.tips.rounding)
    return (contacts.flank[0] >= ends) | (contacts.flank[1] > rounded)


@of_pairs.register
def _of_pairs(drive: StrainWave, places: Float[Arrays, "place *#b"]) -> Float[Array, "pair *#b"]:
    """Sums over both places at which a pair may touch."""
    pair = (jnp.asarray(drive._zone) * drive.lanes + drive._number).astype(int)
    empty = jnp.zeros((2 * drive.lanes, *places.shape[1:]))
    return empty.at[pair].add(places, mode="drop")


@tooth_sections.register
def _tooth_sections(drive: StrainWave) -> tuple[ToothSection, ToothSection]:
    """Teeth of both splines; the bodies under them are rings."""
    return drive._flexspline_section, drive._circular_section


completed.register(StrainWave, StrainWave.completed)
independent.register(StrainWave, lambda _: ("face_width",))
way_of_pairs.register(StrainWave, lambda _: WAVE)
touching.register(StrainWave, lambda _: False)  # most teeth of a zone have a clearance
flanks_in_turn.register(StrainWave, lambda drive: drive.teeth)
