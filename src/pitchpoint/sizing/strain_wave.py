"""Strain wave gears in the sizes of catalogues, by a maker's rating and the life of their bearing."""

from dataclasses import dataclass
from typing import Any

from pitchpoint import units
from pitchpoint.gears.strain_wave.proportions import PROPORTIONS
from pitchpoint.gears.strain_wave.strength_estimates import bearing_life, of_other_size
from pitchpoint.sizing.stage_forms import running_tables
from pitchpoint.sizing.task_table import Task

__all__ = [
    "LOSSES_OF_STRAIN_WAVES",
    "RATIOS",
    "SIZES",
    "StrainWaveSize",
    "strain_wave_case",
    "strain_wave_sizes",
    "why_no_size",
]

Tree = dict[str, Any]

SIZES = {
    8: 8500.0,
    11: 8500.0,
    14: 8500.0,
    17: 7300.0,
    20: 6500.0,
    25: 5600.0,
    32: 4800.0,
    40: 4000.0,
    45: 3800.0,
    50: 3500.0,
    58: 3000.0,
    65: 2800.0,
    80: 2300.0,
    90: 2000.0,
    100: 1800.0,
}
"""Sizes of catalogues, and the largest input speed of each with grease [rpm]; the pitch diameter is 2.4 mm
times the size. Speeds are those of the rating tables of Harmonic Drive's series CSF and HFUC, as recalled:
the tables were not at hand."""

PER_SIZE = 2.4e-3
RATED_DIAMETER, RATED_TORQUE = 60e-3, 67.0
RATED_SPEED, RATED_LIFE = 2000.0, 7000.0
"""Rating of the size 25 at a ratio of 100: pitch diameter [m], torque [N m], speed [rpm], life [h]."""

FULL_RATIO = 100.0
"""Ratio from which on that torque is taken; below it goes with the ratio, a rule on the safe side."""

RATIOS = 30.0, 320.0
WIDTH = 1.0 / 6.0
"""Face width over pitch diameter."""

KEPT = 3

LOSSES_OF_STRAIN_WAVES = "strain_wave_component"
"""Set of losses of their cases."""

TURN = units.parse("1 rpm", "rotational speed")
"""A turn a minute [rad/s]."""


@dataclass(frozen=True)
class StrainWaveSize:
    """A strain wave gear of a catalogue's size.

    Attributes:
        teeth: of flexspline and circular spline.
        diameter: pitch diameter [m].
        rated: torque [N m].
        most_speed: largest one of the wave generator with grease [rad/s].
    """

    teeth: tuple[int, int]
    diameter: float
    rated: float
    most_speed: float

    @property
    def ratio(self) -> float:
        """Speed of the wave generator over that of the flexspline, without its sense."""
        return self.teeth[0] / 2.0

    @property
    def outside(self) -> float:
        """Outer diameter of the circular spline by usual proportions [m]."""
        return float(PROPORTIONS.behind(self.diameter)["outside_diameter"])

    @property
    def length(self) -> float:
        """Length of the cup by usual proportions [m], as cases take it that do not give one."""
        return PROPORTIONS.cup * self.diameter

    @property
    def gears(self) -> Tree:
        """Table of a case file."""
        return {
            "family": "strain_wave",
            "teeth": [*self.teeth],
            "module": f"{1e3 * self.diameter / self.teeth[0]:.6g} mm",
            "face_width": f"{1e3 * WIDTH * self.diameter:.4g} mm",
            "tooth": {"set": "liu"},
            "wave_generator": {"bearing": {}},
            "yielding": {},
            "limits": {
                "rated_torque": f"{self.rated:.4g} N m",
                "rated_speed": f"{RATED_SPEED:g} rpm",
                "rated_life": f"{RATED_LIFE:g} h",
            },
        }


def strain_wave_sizes(task: Task, ratio: float) -> list[StrainWaveSize]:
    """The smallest sizes that bear the torque of a task for its life, and turn as fast with grease.

    Args:
        task: torque, output speed, life and the tolerance of the ratio count.
        ratio: of the gear.

    Source: torque by the cube of the size, life by Harmonic Drive AG, Engineering Data CSD-2A (2014), eq.
    20.2, see `bearing_life`; largest input speeds as recalled from catalogues, see `SIZES`.

    Example:
        >>> from pitchpoint.sizing.task_table import Task
        >>> task = Task.read(torque="60 N m", ratio=100, speed="20 rpm", life="5000 h")
        >>> [round(1e3 * size.diameter, 1) for size in strain_wave_sizes(task, 100.0)]
        [60.0, 76.8, 96.0]
    """
    if not RATIOS[0] <= ratio <= RATIOS[1] or not _near(task, ratio):
        return []
    enduring = _enduring(task, ratio)
    return [size for size in enduring if _input_speed(task, size) <= size.most_speed][:KEPT]


def why_no_size(task: Task, ratio: float) -> str:
    """Why no size does what a task asks, without its stop."""
    low, high = RATIOS
    if not low <= ratio <= high:
        return f"reaches ratios of {low:g} to {high:g}, {ratio:.6g} is asked"
    if not _near(task, ratio):
        return f"a ratio of {_every(ratio)[0].ratio:.6g} is the nearest one"
    if enduring := _enduring(task, ratio):
        speeds = enduring[0].most_speed, _input_speed(task, enduring[0])
        most, asked = (units.convert(speed, "rpm", "rotational speed") for speed in speeds)
        return (
            f"the smallest of a catalogue's sizes that bears it turns at up to {most:.6g} rpm at its input, "
            f"{asked:.6g} rpm are asked"
        )
    largest = _every(ratio)[-1]
    part = (_life(task, largest) / task.life) ** (1.0 / 3.0)  # it goes with the cube of the torque
    most = min(largest.rated, part * task.torque)
    return (
        f"the largest of a catalogue's sizes bears {most:.4g} N m for that life, {task.torque:.6g} N m are "
        "asked"
    )


def _near(task: Task, ratio: float) -> bool:
    """True where whole teeth come as near to a ratio as is asked."""
    return abs(_every(ratio)[0].ratio / ratio - 1.0) <= task.ratio_tolerance


def _enduring(task: Task, ratio: float) -> list[StrainWaveSize]:
    """Sizes that bear the torque for the life, the smallest one first."""
    sizes = [size for size in _every(ratio) if size.rated >= task.torque]
    return [size for size in sizes if _life(task, size) >= task.life]


def _input_speed(task: Task, size: StrainWaveSize) -> float:
    return task.speed * size.ratio


def _every(ratio: float) -> list[StrainWaveSize]:
    """All sizes at a ratio, the smallest one first."""
    teeth = round(2.0 * ratio)
    sizes = []
    for size, speed in SIZES.items():
        diameter = PER_SIZE * size
        rated = of_other_size(RATED_TORQUE, size=diameter, known=RATED_DIAMETER)
        rated *= min(ratio / FULL_RATIO, 1.0)
        sizes.append(StrainWaveSize((teeth, teeth + 2), diameter, rated, speed * TURN))
    return sizes


def _life(task: Task, size: StrainWaveSize) -> float:
    """Life of the bearing of the wave generator under a task [s]."""
    return bearing_life(
        rated_life=3600.0 * RATED_LIFE,
        rated_torque=size.rated,
        rated_speed=RATED_SPEED * TURN,
        torque=task.torque,
        speed=task.speed * (size.ratio + 1.0),
    )


def strain_wave_case(task: Task, size: StrainWaveSize, speed: float) -> Tree:
    """Tables of a case of a strain wave gear, with the bearing and grease of the component.

    Args:
        task: torque, oil and temperature count.
        size: of the gear.
        speed: of the wave generator [rad/s].
    """
    return {
        "gears": size.gears,
        "losses": {"set": LOSSES_OF_STRAIN_WAVES},
        **running_tables(task, task.torque, speed),
        "models": {"friction": {"name": "constant", "coefficient": 0.08}},
    }
