"""The table [dynamics] of a case file: vibration along the line of action, motion with friction, a joint."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated

from pydantic import Field, model_validator

from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import DEVIATION, MASS, PHASE, STIFFNESS, Deviation
from pitchpoint.input.kinds import LOADED, MAP_SPEED, PRESSED, RATIO, SPEED, TORQUE, Flag
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import Table, is_stated

__all__ = ["Dynamics", "MotionTable", "ProfileError", "Speeds", "StartUp"]


INERTIA = Quantity("moment of inertia", 0.0, 1e9, "kg m2", open_low=True)
ORDER = Quantity("dimensionless", 0, 40, whole=True)
DAMPING = Quantity("viscous damping", 0.0, 1e9, "N s/m")
DURATION = Quantity("time", 0.0, 1e4, "s", open_low=True)
RISE = Quantity("time", 0.0, 1e4, "s")
CYCLES = Quantity("dimensionless", 1, 8, whole=True)
INSTANTS = Quantity("dimensionless", 2, 20_000, whole=True)
ON_PATH = Quantity("dimensionless", 0.0, 40.0)


class ProfileError(Deviation):
    """One order of the composite profile error, repeated with every mesh period; order 0 is constant."""

    order: Annotated[float, ORDER]
    """Order of the mesh frequency; 0 is a constant error."""
    amplitude: Annotated[float, DEVIATION]
    """Amplitude along the line of action; a positive error parts the flanks."""
    phase: Annotated[float, PHASE] = 0.0
    """Angle of the wave at the beginning of the mesh cycle."""


class Speeds(Table):
    """Driver speeds through which resonances are looked for, upwards and downwards."""

    start: Annotated[float, SPEED]
    """Lowest speed of the driver."""
    stop: Annotated[float, SPEED]
    """Highest speed of the driver."""
    count: Annotated[float, Quantity("dimensionless", 2, 2000, whole=True)] = 60.0
    """Number of speeds, equally apart."""

    @model_validator(mode="after")
    def _rising(self) -> "Speeds":
        if self.start >= self.stop:
            raise InputError(
                f"speeds run from {SPEED.show(self.start)} to {SPEED.show(self.stop)}; stop must be "
                "the larger"
            )
        return self


class StartUp(Table):
    """A start from rest, or from a speed: the load comes up over the rise, and a torque drives.

    The torque is constant, or that of the motor of the same table.
    """

    duration: Annotated[float, DURATION]
    """Time over which the motion is followed."""
    torque: Annotated[float, TORQUE] | None = None
    """Constant torque that drives; needed unless a motor or a prescribed speed does."""
    rise: Annotated[float, RISE] = 0.0
    """Time over which the load comes up; 0 has it there at once."""
    speed: Annotated[float, MAP_SPEED] = 0.0
    """Speed of the driver at the start; 0 is rest."""
    count: Annotated[float, INSTANTS] = 2001.0
    """Number of instants that are kept, equally apart."""

    @model_validator(mode="after")
    def _inside(self) -> "StartUp":
        if self.rise >= self.duration:
            message = f"{RISE.show(self.rise)} was given; it is shorter than the duration"
            raise InputError(f"{message}, {DURATION.show(self.duration)}", key="rise")
        return self


class MotionTable(Table):
    """Motion with the friction of the teeth in it, of two gears that turn and shift on their bearings.

    It takes inertia, damping ratio, profile error, backlash and speeds from the table around it.
    """

    bearing_stiffness: Annotated[tuple[float, float], Pair(STIFFNESS)] | None = None
    """Stiffness of the bearings of each gear, along and across the line of action; else rigid."""
    bearing_damping: Annotated[tuple[float, float], Pair(DAMPING)] | None = None
    """Damping of the bearings of each gear; by damping_ratio and mass unless given."""
    mass: Annotated[tuple[float, float], Pair(MASS)] | None = None
    """Mass of each gear; needed with bearing_stiffness."""
    mesh_damping: Annotated[float, DAMPING] | None = None
    """Damping along the line of action; by damping_ratio and mean stiffness unless given."""
    pair_path: Annotated[tuple[Annotated[float, ON_PATH], ...], Field(max_length=400)] = ()
    """Places of a table of pair stiffness, in base pitches, growing from 0 at the entry of a pair."""
    pair_stiffness: Annotated[tuple[Annotated[float, STIFFNESS], ...], Field(max_length=400)] = ()
    """Stiffness of a pair at these places; that of the tooth compliance unless given."""
    prescribed_speed: Flag = False
    """Whether the speed of the driver is held; else it has its inertia and a torque."""
    stall_torque: Annotated[float, LOADED] | None = None
    """Torque of a motor at rest, which falls to 0 at no_load_speed; no motor unless given."""
    no_load_speed: Annotated[float, SPEED] | None = None
    """Speed at which the motor has no torque; needed with stall_torque."""
    cycles: Annotated[float, CYCLES] = 1.0
    """Mesh cycles after which the steady motion repeats."""
    start_up: StartUp | None = None
    """Asks for the motion from a start in time."""

    @model_validator(mode="after")
    def _complete(self) -> "MotionTable":
        for key, needed, why in _TOGETHER:
            if is_stated(self, key) and not is_stated(self, needed):
                raise InputError(f"is missing; {why}", key=needed)
        if self.prescribed_speed and self.stall_torque is not None:
            message = (
                "was given; a driver of prescribed speed needs no motor, leave one of them out"
            )
            raise InputError(message, key="stall_torque")
        if len(self.pair_path) != len(self.pair_stiffness):
            message = (
                f"{len(self.pair_stiffness)} values are given for {len(self.pair_path)} places"
            )
            raise InputError(f"{message} of pair_path; give as many", key="pair_stiffness")
        _check_path(self.pair_path)
        self._check_start()
        return self

    def _check_start(self) -> None:
        start = self.start_up
        if start is None:
            return
        motor = self.stall_torque is not None
        if motor and start.torque is not None:
            message = "was given; the motor of stall_torque drives, leave one of them out"
            raise InputError(message, key="start_up.torque")
        if not motor and start.torque is None and not self.prescribed_speed:
            message = "is missing; a start asks for a torque that drives, or for the motor of stall_torque"
            raise InputError(message, key="start_up.torque")
        if self.prescribed_speed and start.torque is not None:
            message = (
                "was given; a driver of prescribed speed needs no torque, leave one of them out"
            )
            raise InputError(message, key="start_up.torque")
        if self.prescribed_speed and start.speed == 0.0:
            message = (
                "is missing; a driver of prescribed speed keeps the speed with which it starts"
            )
            raise InputError(message, key="start_up.speed")


_TOGETHER = (
    ("bearing_stiffness", "mass", "gears that shift on their bearings ask for their masses"),
    ("bearing_damping", "bearing_stiffness", "it belongs to bearing_damping"),
    ("mass", "bearing_stiffness", "masses move only on bearings that yield"),
    ("stall_torque", "no_load_speed", "a motor has a torque at rest and a speed without load"),
    ("no_load_speed", "stall_torque", "a motor has a torque at rest and a speed without load"),
    ("pair_path", "pair_stiffness", "a table of stiffness has places and values"),
    ("pair_stiffness", "pair_path", "a table of stiffness has places and values"),
)
"""Keys that ask for others, and why."""


def _check_path(places: Sequence[float]) -> None:
    """InputError unless the places of a table of stiffness grow from the entry of a pair on."""
    if not places:
        return
    if len(places) < 2 or places[0] != 0.0 or any(b <= a for a, b in pairwise(places)):
        stated = f"{', '.join(f'{place:g}' for place in places)} was given"
        raise InputError(
            f"{stated}; places of a pair grow from 0, where it enters, in base pitches, at least two of them",
            key="pair_path",
        )


class Dynamics(Table):
    """Vibration of a pair along its line of action, or of a joint about the axis of its drive."""

    damping_ratio: Annotated[float, RATIO] = 0.1
    """Damping ratio ξ; 0.03 of strain wave gears unless given."""
    inertia: Annotated[tuple[float, float], Pair(INERTIA)] | None = None
    """Moments of inertia of both gears, discs unless given; of a joint motor and load, needed."""
    profile_error: Annotated[tuple[ProfileError, ...], Field(max_length=41)] = ()
    """Orders of the composite profile error of the pair; none unless given."""
    backlash: Annotated[float, DEVIATION] | None = None
    """Free way along the line of action before back flanks meet; endless unless given."""
    torques: Annotated[tuple[Annotated[float, LOADED], ...], Field(max_length=50)] = ()
    """Torques of the vibration; that of the operating point unless given."""
    forces: Annotated[tuple[Annotated[float, PRESSED], ...], Field(max_length=50)] = ()
    """Forces of the vibration of a rack; that of the operating point unless given."""
    speeds: Speeds | None = None
    """Speeds of the driver beside the operating one; none, of a joint its own choice, unless given."""
    motion: MotionTable | None = None
    """Asks for the motion with the friction of the teeth in it; may be empty."""
