"""A drive as a joint of a robot: what a simulator has to know of it, at its output, from a result alone."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from pitchpoint import units
from pitchpoint.analyses.analysis_registry import FOUR_QUADRANTS
from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.cases.built_drive import TRAIN_PERIOD
from pitchpoint.duty_cycle.history import demand_kelvins
from pitchpoint.efficiency.friction_fit import (
    FrictionFit,
    LawError,
    LossLaw,
    MapRange,
    fit_friction,
    law_errors,
    loss_nodes,
)
from pitchpoint.efficiency.loss_table import LossTable, Rest
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.registry import nearest
from pitchpoint.results.by_stage import of_stage, stages_of
from pitchpoint.runs.run import Outcome
from pitchpoint.units import degrees_celsius

__all__ = [
    "PARTS",
    "AngleWaves",
    "JointModel",
    "WindUpTable",
    "joint_model",
    "law_of",
    "map_of_output",
    "part_of_map",
    "si_quantity",
]

LEAST_WAVE = 0.01
"""Part of the largest wave of an error, and of the mean of friction, from which on one counts."""

PARTS: Mapping[str, str] = {
    "flank_torque": "flanks of the teeth",
    "root_torque": "roots of the teeth at a safety of 1",
    "flexspline_torque": "the flexspline for endless life",
    "ratcheting_torque": "ratcheting",
    "buckling_torque": "buckling of the flexspline",
    "static_bearing_torque": "bearings at a static safety of 1",
    "lasting_bearing_torque": "bearings for the life that [strength] asks for",
    "rated_bearing_torque": "the wave generator for its rated life",
}
"""What limits the torque of the output by the strength of a part, in words, by its name."""

MOST_WAVES = 32
"""Waves that are handed over, the largest ones."""

MOST_FRICTION_WAVES = 8
"""The same of friction, whose passing teeth ask simulators for short steps."""

LEAST_FRICTION_WAVE = 0.1
"""Part of the largest wave of friction from which on one counts."""

NODES_OF_A_WAVE = 4
"""Nodes of a mesh cycle for the shortest wave that is taken from it."""

TURN = 2.0 * np.pi


class WindUpTable(NamedTuple):
    """How far the output turns under torque with the driver held.

    Attributes:
        torque: of the output, ascending from zero [torque].
        wind_up: [torque] [rad or m].
        stiffness: slope of torque over wind-up [torque] [N m/rad or N/m].
        at_load: that slope at the load of operation [N m/rad or N/m].
        covers: what yields, in words.
        held: torque that friction of the teeth holds at rest beside that of the wind-up; zero where the
            result has no loop [torque].
    """

    torque: np.ndarray
    wind_up: np.ndarray
    stiffness: np.ndarray
    at_load: float
    covers: str
    held: np.ndarray


class AngleWaves(NamedTuple):
    """Sum over waves of amplitude cos(order angle + phase).

    Attributes:
        order: waves in one turn of the angle [wave].
        amplitude: [wave], in the unit of what they are waves of.
        phase: at the angle zero [wave] [rad].
        angle: of what, in words.
        turns: turns of that angle in one turn of the driver, without sign.
    """

    order: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray
    angle: str
    turns: float


@dataclass(frozen=True)
class JointModel:
    """What a simulator has to know of a drive; all at its output, from the record of a result.

    Attributes:
        title, case, variant, version, digest: where it comes from.
        driver, output: names of the members at the ends.
        ratio: speed of the driver over that of the output, with its sign [1, rad/m or m/rad].
        slides: True where the output travels instead of turning.
        table: loss torque over torque, speed and temperature, see `LossTable`.
        law: of friction, by name.
        load: torque of operation at the output [torque].
        speed: of operation at the output [speed].
        temperature: of operation [K]; the table has degC.
        inertia: of all bodies of the drive at the output, without the motor [kg m2 or kg].
        rotor_inertia: of the motor at the driver, which somebody gave [kg m2 or kg].
        wind_up: torque over wind-up.
        hysteresis: width of the loop of wind-up without torque, by friction of the teeth [rad or m].
        lost_motion: at 4 % of the rated torque either way, as in catalogues [rad or m].
        backlash: free travel of the output, the driver held; by case of the tolerances [rad or m].
        kinematic_error: waves of the output's position by deviations of the teeth [rad or m].
        transmission_error: of the teeth under the load of operation, peak to peak [rad or m].
        torque_ripple: of the driver at the operating point, peak to peak [torque of the driver].
        friction_waves: waves of friction over its mean at the operating point, over the rotation of the
            driver from the start of a mesh cycle [1].
        limits: largest torque and speed of the output in the map, by name, and the torques of it that its
            parts bear, see `PARTS` [torque].
        lacks: why an attribute is None, in a sentence, by its name.
        warnings: of the result.

    Example:
        >>> from pitchpoint.efficiency.loss_table import LossTable
        >>> from pitchpoint.runs.joint_model import JointModel
        >>> lost = {"law": (((1.0,), (1.0,)), ((0.5,), (0.5,)), ((1.0,), (1.0,)))}
        >>> table = LossTable((-10.0, 0.0, 10.0), (0.0, 4.0), (40.0,), lost, 0.02)
        >>> joint = JointModel.plain(table, ratio=-50.0, rotor_inertia=2e-5)
        >>> joint.driver_torque(10.0, 2.0), joint.loss_torque(10.0, 2.0)
        (0.22, 1.0)
        >>> round(joint.armature, 9), joint.wind_up is None
        (0.05, True)
    """

    title: str
    case: str
    variant: str
    version: str
    digest: str
    driver: str
    output: str
    ratio: float
    slides: bool
    table: LossTable
    law: str
    load: float
    speed: float
    temperature: float
    inertia: float | None
    rotor_inertia: float | None
    wind_up: WindUpTable | None
    hysteresis: float | None
    lost_motion: float | None
    backlash: Mapping[str, float] | None
    kinematic_error: AngleWaves | None
    transmission_error: float | None
    torque_ripple: float | None
    friction_waves: AngleWaves | None
    limits: Mapping[str, float]
    lacks: Mapping[str, str]
    warnings: tuple[str, ...] = ()

    @classmethod
    def plain(cls, table: LossTable, **known: Any) -> "JointModel":
        """A joint of a loss map and what else is known.

        Args:
            table: the map.
            known: attributes by name.
        """
        law = next(iter(table.loss_torques))
        texts = dict.fromkeys(("title", "case", "variant", "version", "digest"), "")
        ends = {"driver": "motor", "output": "output", "slides": False}
        point = {
            "load": table.torques[-1],
            "speed": table.speeds[-1],
            "temperature": table.temperatures[0] + 273.15,
        }
        maybe = dict.fromkeys(_MAYBE)
        limits = {"largest_torque": table.torques[-1], "largest_speed": table.speeds[-1]}
        lacks = {
            name: f"no {name.replace('_', ' ')} was given" for name in _MAYBE if name not in known
        }
        of_joint = {"ratio": 1.0 / table.speed_ratio, "table": table, "law": law, "limits": limits}
        values: dict[str, Any] = {**texts, **ends, **point, **maybe, **of_joint, "lacks": lacks}
        return cls(**(values | known))

    def __repr__(self) -> str:
        return f"JointModel({self.title!r})\n" + "\n".join(f"  {line}" for line in self.lines())

    @property
    def units(self) -> dict[str, str]:
        """Units of `torque` and `speed` of the output, `driver` torque, `travel` and `inertia`."""
        torque, speed, driver = self.table.units
        travel = "m" if self.slides else "rad"
        inertia = "kg" if self.slides else "kg m2"
        return {
            "torque": torque,
            "speed": speed,
            "driver": driver,
            "travel": travel,
            "inertia": inertia,
        }

    @property
    def armature(self) -> float:
        """Inertia of drive and rotor at the output; what is not known of it counts as zero [kg m2 or kg]."""
        return (self.inertia or 0.0) + (self.rotor_inertia or 0.0) * self.ratio**2

    @property
    def part_limits(self) -> dict[str, float]:
        """Torques of the output that parts bear, by name, those that the record has [torque]."""
        return {name: self.limits[name] for name in PARTS if name in self.limits}

    @property
    def torque_limit(self) -> float:
        """Least of the torques that parts bear, and of the end of the map [torque]."""
        return min(self.limits["largest_torque"], *self.part_limits.values(), math.inf)

    @property
    def play(self) -> float:
        """Backlash in the mean of its tolerances; none where it is not known [rad or m]."""
        backlash = self.backlash or {}
        return backlash.get("mean", backlash.get("nominal", 0.0))

    def loss_torque(self, torque: Any, speed: Any, temperature: Any = None) -> Any:
        """Torque of the output that is lost in motion.

        Args:
            torque: of the output on its load, of either sign.
            speed: of the output, of either sign, not zero.
            temperature: [K]; that of operation by default.

        Returns:
            Numbers or arrays; NaN where friction locks the drive, and at rest.
        """
        point = self._at(torque, speed, temperature)
        lost = point.loss / np.abs(np.where(np.asarray(speed) == 0.0, np.nan, speed))
        return lost.item() if lost.ndim == 0 else lost

    def driver_torque(self, torque: Any, speed: Any, temperature: Any = None) -> Any:
        """Torque of the driver in motion; arguments as in `loss_torque`."""
        input_torque = np.asarray(self._at(torque, speed, temperature).input_torque)
        return input_torque.item() if input_torque.ndim == 0 else input_torque

    def holding_band(self, torque: float = 0.0, temperature: float | None = None) -> Rest:
        """Torques of the driver between which the drive stands with a load; without one those that start it.

        Args:
            torque: of the output on its load.
            temperature: [K]; that of operation by default.
        """
        return self.table.at_rest(torque, float(self._degree(temperature)), self.law)

    def fit(
        self,
        *,
        temperature: float | None = None,
        within: MapRange | None = None,
        stribeck: bool = False,
    ) -> FrictionFit:
        """Constant, proportional and viscous friction nearest to the map, see `fit_friction`.

        Args:
            temperature: [K]; that of operation by default.
            within: part of the map that counts; all of it by default.
            stribeck: True for a part that falls with speed too.
        """
        at = self.temperature if temperature is None else temperature
        _demand_kelvins(at, *_ends(within))
        nodes = loss_nodes(self.table, self.law, within=within, temperature=at)
        return fit_friction(nodes.torque, nodes.speed, nodes.lost, stribeck=stribeck)

    def errors(self, law: LossLaw, within: MapRange | None = None) -> list[LawError]:
        """How far the torque of the driver by a law of loss is off the map, see `law_errors`.

        Args:
            law: lost torque over torque along the motion, speed and temperature [degC].
            within: part of the map that counts; all of it by default.
        """
        _demand_kelvins(*_ends(within))
        return law_errors(self.table, loss_nodes(self.table, self.law, within=within), law)

    def lines(self) -> list[str]:
        """What is known of it, a line each."""
        return [*_told(self)]

    def _degree(self, temperature: Any) -> Any:
        """Temperatures in degC, as the table has them."""
        warm = np.asarray(self.temperature if temperature is None else temperature, float)
        _demand_kelvins(warm.min(), warm.max())
        return degrees_celsius(warm)

    def _at(self, torque: Any, speed: Any, temperature: Any) -> Any:
        return self.table.at_many(torque, speed, self._degree(temperature), self.law)


def _demand_kelvins(*temperatures: float) -> None:
    for kelvins in temperatures:
        demand_kelvins(float(kelvins), "temperature", "an oil")


def _ends(within: MapRange | None) -> tuple[float, ...]:
    """Temperatures at which a part of a map ends; none of all of it."""
    return () if within is None else tuple(within.temperature)


_MAYBE = (
    "inertia",
    "rotor_inertia",
    "wind_up",
    "hysteresis",
    "lost_motion",
    "backlash",
    "kinematic_error",
    "transmission_error",
    "torque_ripple",
    "friction_waves",
)


def _told(joint: JointModel) -> Any:
    unit = joint.units
    yield f"{joint.driver} drives {joint.output}, ratio {joint.ratio:.6g}, friction {joint.law}"
    band = joint.holding_band()
    yield (
        f"map to {joint.limits['largest_torque']:.4g} {unit['torque']} and "
        f"{joint.limits['largest_speed']:.4g} {unit['speed']}, {joint.table.temperatures[0]:g} to "
        f"{joint.table.temperatures[-1]:g} degC; starts without load at {band.highest:.4g} {unit['driver']}"
    )
    yield from (
        f"limit by {PARTS[name]}: {torque:.4g} {unit['torque']} of the output"
        for name, torque in joint.part_limits.items()
    )
    yield f"armature {joint.armature:.4g} {unit['inertia']}"
    if joint.wind_up is not None:
        slope = f"{joint.wind_up.at_load:.4g} {unit['torque']}/{unit['travel']}"
        yield f"stiffness {slope} at the load of operation"
    if joint.friction_waves is not None:
        orders = ", ".join(f"{order:.4g}" for order in joint.friction_waves.order)
        share = float(np.hypot.reduce(joint.friction_waves.amplitude)) / math.sqrt(2.0)
        yield f"friction ripples by {100.0 * share:.3g} % (rms) at the load of operation, orders {orders}"
    yield from (f"{name}: {why}" for name, why in joint.lacks.items())


def joint_model(
    outcome: Outcome, *, law: str | None = None, rotor_inertia: Any = None
) -> JointModel:
    """The joint that a result describes; nothing is computed anew but its table.

    Args:
        outcome: with the loss map of the output.
        law: of friction, by name; the first one of the case by default.
        rotor_inertia: of the motor, about its own axis: "0.3 kg cm2", or a number [kg m2].

    Raises:
        InputError: the result has no such map, the map no such law, or the inertia is no such quantity.
    """
    data = map_of_output(outcome)
    table, record = table_of(data), outcome.manifest
    name = law_of(table, law)
    ratio, speed = _ratio(record), float(data["output_speed"].max())
    travels = [*map(str, record["travels"])]
    parts, lacks = _parts(outcome, name, ratio, float(data.attrs["load"]))
    rotor = si_quantity(rotor_inertia, "kg" if "driver" in travels else "kg m2", "rotor_inertia")
    if rotor is None:
        lacks["rotor_inertia"] = "that of the motor was not given (rotor_inertia)"
    return JointModel(
        title=str(record["title"]),
        case=str(record["case"]),
        variant=str(record["variant"]),
        version=str(data.attrs["version"]),
        digest=str(data.attrs["fingerprint"]),
        driver=str(record["driver"]),
        output=str(record["loaded"]),
        ratio=ratio,
        slides="loaded" in travels,
        table=table,
        law=name,
        load=float(data.attrs["load"]),
        speed=_operating_speed(record, speed, ratio),
        temperature=float(data.attrs["degree"]),
        rotor_inertia=rotor,
        limits={
            "largest_torque": table.torques[-1],
            "largest_speed": speed,
            **_part_limits(outcome, float(data.attrs["load"])),
        },
        lacks=lacks,
        warnings=tuple(map(str, record["warnings"])),
        **parts,
    )


def part_of_map(
    joint: JointModel,
    torque: str | None = None,
    speed: str | None = None,
    temperature: float | None = None,
) -> MapRange | None:
    """Part of a map that somebody names, at one temperature.

    Args:
        joint: of the map.
        torque, speed: least and largest amount at the output, "1 N m:20 N m".
        temperature: [K]; that of operation by default.

    Returns:
        None where neither is given.

    Raises:
        InputError: no two quantities in their order, or beyond the map.
    """
    if torque is None and speed is None:
        return None
    torques, speeds = (
        _between(text, unit, axis, key)
        for text, unit, axis, key in (
            (torque, joint.units["torque"], (0.0, joint.table.torques[-1]), "--torque-range"),
            (
                speed,
                joint.units["speed"],
                (joint.table.speeds[1], joint.table.speeds[-1]),
                "--speed-range",
            ),
        )
    )
    degree = joint.temperature if temperature is None else temperature
    return MapRange(torques, speeds, (degree, degree))


def _between(
    text: str | None, unit: str, axis: tuple[float, float], key: str
) -> tuple[float, float]:
    """The two ends of a range within an axis."""
    if text is None:
        return axis
    ends = [si_quantity(part.strip(), unit, key) or 0.0 for part in text.split(":")]
    if len(ends) != 2:
        raise InputError(
            f'{shown(text)} is no range; write "LEAST:LARGEST", each with its unit', key=key
        )
    if not ends[0] < ends[1]:
        turned = ":".join(part.strip() for part in reversed(text.split(":")))
        what = f"goes from high to low; write {shown(turned)}"
        if ends[0] == ends[1]:
            what = "begins where it ends; give two amounts, the least first"
        raise InputError(f"{shown(text)} {what}", key=key)
    if ends[1] <= axis[0]:
        raise InputError(
            f"{shown(text)} lies below the motion in the map, which begins at {axis[0]:.6g} {unit}",
            key=key,
        )
    if ends[1] > axis[1] * (1.0 + 1e-9):
        raise InputError(
            f"{shown(text)} goes beyond the map, which ends at {axis[1]:.6g} {unit}", key=key
        )
    return max(ends[0], axis[0]), min(ends[1], axis[1])


def si_quantity(value: Any, unit: str, key: str) -> float | None:
    """A quantity of somebody's in SI, not negative; None where there is none.

    Args:
        value: text with a unit, or a number in SI.
        unit: SI unit of what it has to be.
        key: at which it stands, for the sentence.

    Raises:
        InputError: it is no such quantity.

    Example:
        >>> si_quantity("0.3 kg cm2", "kg m2", "rotor_inertia")
        3e-05
    """
    if value is None:
        return None
    text = value if isinstance(value, str) else f"{value} {unit}"
    try:
        return Quantity(units.kind_of(unit), 0.0, math.inf, unit).read(text)
    except InputError as error:
        raise error.at(key=key) from None


def map_of_output(outcome: Outcome) -> xr.Dataset:
    """The loss map of the output; InputError, and how it is had, unless there is one."""
    name = FOUR_QUADRANTS.name
    if name in outcome.parts:
        return outcome.parts[name]
    why = outcome.manifest["lacks"].get(name)
    how = f"it is computed by: pitchpoint run {outcome.manifest['case']} --set loss_map.quadrants=4"
    message = f"the result has no {FOUR_QUADRANTS.title}"
    raise InputError(f"{message}: {why}" if why else f"{message}; {how}")


def law_of(table: LossTable, law: str | None) -> str:
    """A friction law of a map by name, the first one by default; InputError for another."""
    names = [*table.loss_torques]
    if law is None or law in names:
        return law or names[0]
    message = f"{shown(law)} is not a friction law of this result{nearest(law, names)}"
    raise InputError(message, key="law")


def _part_limits(outcome: Outcome, load: float) -> dict[str, float]:
    """Torques of the output at which a part is at its limit, from safeties and margins under the load.

    The stress of a flank goes by the root of the load and that of a root by the load; factors of the rating
    stay those of the load of operation, though they fall with more of it.
    """
    least: dict[str, float] = {}
    for part, name, scaled in _LIMITED:
        data = outcome.parts.get(part)
        if data is not None and name in data:
            least |= {key: _least(value) * load for key, value in scaled(data).items()}
    return {name: torque for name, torque in least.items() if 0.0 < torque < math.inf}


def _least(values: Any) -> float:
    """The least of what is known; infinite where nothing is."""
    finite = np.asarray(values)[np.isfinite(values)]
    return float(finite.min()) if finite.size else math.inf


def _margins(data: xr.Dataset) -> dict[str, Any]:
    """Margins of a strain wave gear against what the case gives, by name of the limit."""
    pairs = zip(data["against"].values, data["limit_margin"].values, strict=True)
    return {f"{against}_torque": margin for against, margin in pairs}


_LIMITED: tuple[tuple[str, str, Any], ...] = (
    ("strength", "flank_safety", lambda data: {"flank_torque": data["flank_safety"].values ** 2}),
    ("strength", "root_safety", lambda data: {"root_torque": data["root_safety"].values}),
    (
        "load_limits",
        "goodman_torque",
        lambda data: {
            "flexspline_torque": data["goodman_torque"].values / float(data["flexspline_torque"])
        },
    ),
    ("load_limits", "limit_margin", _margins),
    (
        "load_limits",
        "rated_life_torque",
        lambda data: {
            "rated_bearing_torque": data["rated_life_torque"].values
            / float(data["flexspline_torque"])
        },
    ),
    (
        "operation",
        "static_torque_margin",
        lambda data: {"static_bearing_torque": data["static_torque_margin"].values},
    ),
    (
        "operation",
        "life_torque_margin",
        lambda data: {"lasting_bearing_torque": data["life_torque_margin"].values},
    ),
)
"""Parts of a result, the variable in it, and its loads over that of operation by name of the limit."""


def _rates(record: Mapping[str, Any]) -> dict[str, float]:
    """Rate of each member for a unit of the driver."""
    return dict(zip(record["members"], map(float, record["motion"]), strict=True))


def _ratio(record: Mapping[str, Any]) -> float:
    """Speed of the driver over that of the output, with its sign."""
    rates = _rates(record)
    return rates[record["driver"]] / rates[record["loaded"]]


def _operating_speed(record: Mapping[str, Any], largest: float, ratio: float) -> float:
    """Of the output at the operating point; that of the map where the record has none."""
    operation = {
        row["key"]: row["value"] for row in record["inputs"] if row["table"] == "operation"
    }
    speed = operation.get("speed")
    return abs(float(speed) / ratio) if isinstance(speed, float | int) else largest


def _parts(
    outcome: Outcome, law: str, ratio: float, load: float
) -> tuple[dict[str, Any], dict[str, str]]:
    """What the record has beside the map, and why it has not what is None."""
    values: dict[str, Any] = {}
    lacks: dict[str, str] = {}
    reasons = outcome.manifest["lacks"]
    for name, (parts, read, usual) in _READERS.items():
        there = [outcome.parts[part] for part in parts if part in outcome.parts]
        value = next(
            (v for v in (read(reader, outcome, law, load) for reader in there) if v is not None),
            None,
        )
        values[name] = value
        if value is None:
            whys = (reasons[part] for part in parts if part in reasons)
            lacks[name] = usual if there else next(whys, usual)
    return values, lacks


def _inertia(data: xr.Dataset, outcome: Outcome, _: str, __: float) -> float | None:
    """Of all bodies at the output; of a drive whose output travels without its mass."""
    if "reflected_inertia" in data and "output" in data["end"].values:
        return _known(data["reflected_inertia"].sel(end="output"))
    record = outcome.manifest
    name = "body_inertia" if "body_inertia" in data else "disc_inertia"
    if name not in data or data[name].ndim != 1:
        return None
    rates = _rates(record)
    turning = [
        body for body in rates if not (body == record["loaded"] and "loaded" in record["travels"])
    ]
    inertias = dict(zip(rates, data[name].values, strict=False))
    sums = sum(
        inertias[body] * rates[body] ** 2 for body in turning if rates[body] and body in inertias
    )
    return _known(sums / rates[record["loaded"]] ** 2)


def _known(value: Any) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None


def _wind_up(data: xr.Dataset, _: Outcome, law: str, load: float) -> WindUpTable | None:
    torque, turned, slope = (
        data[name].values for name in ("torque", "wind_up", "tangent_torsional_stiffness")
    )
    finite = np.isfinite(torque) & np.isfinite(turned) & np.isfinite(slope)
    if finite.sum() < 2:
        return None
    torque, turned, slope, held = (
        curve[finite] for curve in (torque, turned, slope, _held(data, law, torque))
    )
    covers = str(data["torsional_stiffness"].attrs.get("covers", ""))
    return WindUpTable(torque, turned, slope, float(np.interp(load, torque, slope)), covers, held)


def _held(data: xr.Dataset, law: str, torque: np.ndarray) -> np.ndarray:
    """Half of the height of the loop of wind-up at each torque; zero where there is none."""
    if "loading_torque" not in data or law not in data["law"].values:
        return 0.0 * torque
    loading, unloading = (
        data[f"{way}_torque"].sel(law=law).values for way in ("loading", "unloading")
    )
    half: np.ndarray = np.nan_to_num(loading - unloading) / 2.0
    return half.clip(0.0)


def _friction_waves(_: xr.Dataset, outcome: Outcome, law: str, load: float) -> AngleWaves | None:
    """Waves of the torque of the driver over the torque that is lost, under the load of operation."""
    record, point = outcome.manifest, outcome.parts.get("operation")
    if point is None or "mean_input_torque" not in point:
        return None
    mean = float(point["mean_input_torque"].sel(law=law).values.ravel()[0])
    lost = mean - load / abs(_ratio(record))
    each = _torque_cycles(outcome, law)
    if not each or not lost > LEAST_WAVE**2 * mean:
        return None
    rows = np.concatenate([_harmonics(*one) for one in each])
    order, size = np.real(rows[:, 0]), np.abs(rows[:, 1]) * mean / lost
    largest = np.argsort(-size)[:MOST_FRICTION_WAVES]
    kept = largest[size[largest] >= max(LEAST_FRICTION_WAVE * size.max(), LEAST_WAVE)]
    if not kept.size:
        return None
    kept = kept[np.argsort(order[kept])]
    angle = f"angle of {record['driver']}"
    return AngleWaves(order[kept], size[kept], np.angle(rows[kept, 1]), angle, 1.0)


def _torque_cycles(
    outcome: Outcome, law: str
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, float]]:
    """Torque of a driver over the phase of a cycle, weights, and cycles in a turn of the driver of all.

    Of stages each one's own, of a set over the period of its meshes: their phases meet freely. None at all
    where that of one stage is not known.
    """
    record, parts = outcome.manifest, outcome.parts
    cycles = {name: parts[name] for name in ("train_period", "cycle") if name in parts}
    alone = record.get("averaging") == TRAIN_PERIOD
    stages = [stage for stage in record["stages"] if isinstance(stage["number"], int)]
    if alone or not stages:
        data = cycles.get("train_period" if alone else "cycle")
        return [] if data is None else [_torque_cycle(data, record, law)]
    of_stages = []
    for stage in stages:
        number, part = stage["number"], abs(float(stage["speed"]) / float(stages[0]["speed"]))
        data = next((of_stage(d, number) for d in cycles.values() if number in stages_of(d)), None)
        if data is None:
            return []
        torque, phase, weight, turns = _torque_cycle(data, stage, law)
        of_stages.append((torque, phase, weight, turns * part))
    return of_stages


def _torque_cycle(
    data: xr.Dataset, record: Mapping[str, Any], law: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """The same of one mesh or set: cycles in a turn of its own driver."""
    torque = data["input_torque"].sel(law=law).values
    period = abs(float(data.attrs.get("driver_period", record["period"])))
    phase = data["phase"].values if "phase" in data else data["driver_angle"].values / period
    return torque, phase, data["weight"].values, TURN / period


def _harmonics(
    torque: np.ndarray, phase: np.ndarray, weight: np.ndarray, turns: float
) -> np.ndarray:
    """Orders over the driver and amplitudes over the mean, with their phases, of what the nodes resolve."""
    count = np.arange(1, min(MOST_FRICTION_WAVES, torque.size // NODES_OF_A_WAVE) + 1)
    ripple = torque / (torque @ weight) - 1.0  # the nodes are those of a quadrature
    lines = 2.0 * np.exp(-1j * TURN * np.outer(count, phase)) @ (weight * ripple)
    return np.stack([count * turns + 0j, lines], axis=1)


def _of_law(name: str) -> Any:
    def read(data: xr.Dataset, _: Outcome, law: str, __: float) -> float | None:
        if name not in data:
            return None
        figure = data[name]
        return (
            _known(figure.sel(law=law).values.ravel()[0])
            if "law" in figure.dims
            else _known(figure)
        )

    return read


def _backlash(data: xr.Dataset, outcome: Outcome, _: str, __: float) -> dict[str, float] | None:
    """By case of the tolerances, or by the rigid teeth alone; nothing below rounding."""
    record = outcome.manifest
    if "output_backlash" in data:
        backlash = data["output_backlash"]
    elif "backlash_angle" in data and data["backlash_angle"].dims == ("gear", "case"):
        backlash = data["backlash_angle"].isel(gear=record["members"].index(record["loaded"]))
    elif "kinematic_play" in data:
        return {"nominal": max(float(data["kinematic_play"]), 0.0)}
    else:
        return None
    return {
        str(case): max(float(v), 0.0)
        for case, v in zip(backlash["case"].values, backlash.values, strict=True)
    }


def _kinematic_error(data: xr.Dataset, outcome: Outcome, _: str, __: float) -> AngleWaves | None:
    """Waves of the error under load, by both members together, over a turn."""
    if "curve" not in data.dims or data["kinematic_error"].ndim != 2:
        return None
    values = data["kinematic_error"].sel(curve="under load").values
    if not np.isfinite(values).all():
        return None
    lines = 2.0 * np.fft.rfft(values)[1 : values.size // 2] / values.size
    size = np.abs(lines)
    largest = np.argsort(-size)[:MOST_WAVES]
    strong = np.sort(largest[size[largest] >= LEAST_WAVE * size.max()])
    angle = str(data.attrs["turn_angle"])
    turns = _turns_of(angle, outcome.manifest)
    if turns is None:
        return None
    return AngleWaves(strong + 1, size[strong], np.angle(lines[strong]), angle, turns)


def _turns_of(angle: str, record: Mapping[str, Any]) -> float | None:
    """Turns of an angle in one turn of the driver: of one member, or of one against another."""
    rates, (name, _, reference) = (
        _rates(record),
        angle.removeprefix("angle of ").partition(" against "),
    )
    if name not in rates or (reference or name) not in rates or not rates[record["driver"]]:
        return None
    return abs((rates[name] - (rates[reference] if reference else 0.0)) / rates[record["driver"]])


def _transmission_error(data: xr.Dataset, _: Outcome, __: str, load: float) -> float | None:
    values = data["angular_transmission_error_range"].values
    return _known(np.interp(load, data["torque"].values, values))


_RIGID = 'the case does not ask how teeth yield; models.load_sharing = "from_stiffness" does'
_OF_CATALOGUES = "a strain wave gear in a file of its own has it, other drives do not"

_READERS: Mapping[str, tuple[tuple[str, ...], Any, str]] = {
    "inertia": (
        ("reflected", "bodies", "inspection"),
        _inertia,
        "that of a body of the drive is not known",
    ),
    "wind_up": (
        ("torsion",),
        _wind_up,
        _RIGID,
    ),
    "hysteresis": (("torsion",), _of_law("hysteresis_loss"), _OF_CATALOGUES),
    "lost_motion": (
        ("torsion",),
        _of_law("catalogue_lost_motion"),
        _OF_CATALOGUES,
    ),
    "backlash": (
        ("reflected", "inspection", "torsion"),
        _backlash,
        "no part of the result has the play of the teeth",
    ),
    "kinematic_error": (
        ("kinematic_error",),
        _kinematic_error,
        "a pair whose teeth have deviations has it, this case does not",
    ),
    "transmission_error": (
        ("torsion",),
        _transmission_error,
        _RIGID,
    ),
    "torque_ripple": (
        ("operation",),
        _of_law("torque_ripple"),
        "the result has no operating point",
    ),
    "friction_waves": (
        ("train_period", "cycle"),
        _friction_waves,
        "over a mesh cycle it changes by less than 1 %",
    ),
}
"""By attribute: the parts that may have it, how it is read, and what is told where none has."""
