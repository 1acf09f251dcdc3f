"""Fit of the losses of strain wave drives that stand in `cases/loss_sets.toml`.

    .venv/bin/python benchmarks/fit_strain_wave_losses.py

The parts of f0 and f1 that grow with the deflection are fitted to the 44 efficiencies of the case `csd25`
(ratio 100), which names the set; its two rows at ratio 160 follow. Sixth powers of the deviations are
least, so that no value is left far off. The fit is made anew for other parts that are assumed, friction
of the teeth, f0 and f1 of a round bearing: where all follow the 44 values alike, those cannot tell the
parts. Last breakaway_dry is fitted to starting and back-driving torque of two drives, in their logarithms.
To be run after the loss of the teeth has changed; the constants go into the file by hand.
"""

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import bench
import equinox as eqx
import jax
import numpy as np
from scipy.optimize import least_squares

from pitchpoint._jax import jnp
from pitchpoint.cases.built import Built
from pitchpoint.cases.library import find_case
from pitchpoint.cases.loss_sets import loss_sets
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.quasi_static import Engagement, Operation, cycle, engagement
from pitchpoint.efficiency.running_torque import torques_at_rest
from pitchpoint.efficiency.summary import engaged
from pitchpoint.input.quantities import SIValue
from pitchpoint.runs.run import load_case

jax.config.update("jax_enable_x64", True)

SET, PLACE = "strain_wave_component", "wave_generator_bearing"
RATIO_160 = "ratio_160"
STARTING = {(17, 100): (0.034, 3.3), (25, 50): (0.15, 9.0)}
"""Size and ratio of two drives; torque that starts them, and that back-drives them [N m]."""


@dataclass(frozen=True)
class Rows:
    """Efficiencies of a catalogue for one drive.

    Attributes:
        built: the drive.
        known: its contacts and shares at the rated torque.
        points: operating points.
        printed: efficiencies [%].
    """

    built: Built
    known: Engagement
    points: Operation
    printed: np.ndarray

    def computed(self, f0: float, f1: float, friction: float) -> np.ndarray:
        """Efficiencies with other constants [%]."""
        design, models = self.built.design, self.built.models[0]
        factors = {"f0": jnp.asarray(f0), "f1": jnp.asarray(f1)}
        design = replace(design, drag=(replace(design.drag[0], factors=factors),))
        models = replace(models, parameters={"constant": {"coefficient": jnp.asarray(friction)}})
        found: np.ndarray = _efficiency(design, self.points, models, self.known)
        return 100.0 * np.asarray(found)

    @property
    def deflection(self) -> float:
        """Deflection over the pitch diameter, with which parts of f0 and f1 grow."""
        return self.built.case.gears.loss_scales["deflection over pitch diameter"]


@eqx.filter_jit
def _efficiency(design: Any, points: Operation, models: Any, known: Engagement) -> Any:
    return cycle(design, points, models, engaged=known).mean_efficiency


def rows(tree: Mapping[str, Any], study: Callable[[str], bool], changes: Mapping[str, Any]) -> Rows:
    """Rows of the case that read some of its studies, with the changes of these to the gears."""
    built = load_case("csd25", settings=dict(changes))
    every = [one for one in tree["targets"] if study(one["study"]) and one["at"] != ""]
    speed = [tree["studies"][one["study"]]["change"].get("operation.speed") for one in every]
    rate = [built.case.operation.speed if v is None else _value(v) * np.pi / 30 for v in speed]
    degree = [_value(one["at"]) + 273.15 for one in every]
    load = built.operation.load
    points = Operation(jnp.full(len(every), load), jnp.asarray(rate), jnp.asarray(degree))
    known = engagement(built.design, load, built.models[0], 8)
    return Rows(built, known, points, np.array([float(one["printed"]) for one in every]))


def _value(text: str) -> float:
    return float(text.split()[0])


@dataclass(frozen=True)
class Assumed:
    """What the efficiencies of one ratio cannot tell: friction of the teeth, f0 and f1 of a round bearing."""

    friction: float
    f0: float
    f1: float

    def computed(self, drive: Rows, grown: np.ndarray) -> np.ndarray:
        """Efficiencies of a drive with parts of f0 and f1 that grow with the deflection [%]."""
        f0, f1 = np.array([self.f0, self.f1]) + grown * drive.deflection
        return drive.computed(f0, f1, self.friction)


def fitted(rated: Rows, other: Rows, assumed: Assumed) -> float:
    """Largest deviation [%]; constants, deviations and rows at the other ratio are printed as a line."""

    def away(constants: np.ndarray) -> np.ndarray:
        return assumed.computed(rated, constants) - rated.printed

    found = least_squares(lambda c: away(c) ** 3, [200.0, 0.2], x_scale=[100.0, 0.1]).x
    missed, there = np.abs(away(found)), assumed.computed(other, found)
    given = (assumed.friction, assumed.f0, assumed.f1, *found, missed.mean(), missed.max())
    line = "{:8.3f} {:6.2f} {:8.5f} {:8.2f} {:8.4f} {:8.3f} {:8.3f}".format(*given)
    pairs = zip(there, there - other.printed, strict=True)
    print(line + "".join(f" {value:8.2f} ({miss:+.2f})" for value, miss in pairs))
    return float(missed.max())


def drive(size: float, ratio: int, dry: float) -> Built:
    """A drive of a size, pitch diameter in tenths of an inch, with the oil of the case."""
    case = find_case("csd25")[1]
    gears = {
        "family": "strain_wave",
        "teeth": [2 * ratio, 2 * ratio + 2],
        "module": SIValue(2.54e-3 * size / (2 * ratio)),
        "face_width": SIValue(0.4e-3 * size),
    }
    losses = {"set": SET, PLACE: {"breakaway_dry": SIValue(dry)}}
    tree = {key: case[key] for key in ("lubricant", "roughness", "models")}
    tree |= {"gears": gears, "losses": losses}
    tree["operation"] = {"torque": "10 N m", "speed": "1 rpm", "temperature": "25 degC"}
    return Variant(tree, "drive", "default").built({})


def starting(built: Built) -> float:
    """Torque that starts a drive without load [N m]."""
    idle, models = replace(built.operation, load=jnp.asarray(0.0)), built.models[0]
    known = engaged(built.design, idle, models)
    return float(torques_at_rest(built.design, idle, models, known)[1])


def both_ways(dry: float) -> np.ndarray:
    """Starting and back-driving torque of each drive over what is printed."""
    found = []
    for (size, ratio), printed in STARTING.items():
        built = drive(size, ratio, dry)
        found.append(
            [
                starting(one) / value
                for one, value in zip((built, built.backwards), printed, strict=True)
            ]
        )
    return np.array(found)


def main() -> None:
    """Print constants, deviations, and what they cannot tell."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--small", action="store_true", help="the fit alone, as CI has it")
    parser.add_argument("--friction", type=float, default=0.1, help="of the teeth")
    place = loss_sets()[SET].places[PLACE]
    parser.add_argument("--f0", type=float, default=place["f0"][0].value, help="of a round bearing")
    parser.add_argument("--f1", type=float, default=place["f1"][0].value, help="of a round bearing")
    asked = parser.parse_args()
    tree = find_case("csd25")[1]
    study = tree["studies"][RATIO_160]["change"]
    rated = rows(tree, lambda name: name.startswith("rpm"), {})
    other = rows(tree, RATIO_160.__eq__, {k: v for k, v in study.items() if k.startswith("gears")})
    print(
        "friction  f0      f1     f0 grows f1 grows   mean      max  -10 and 40 degC at ratio 160"
    )
    largest = fitted(rated, other, Assumed(asked.friction, asked.f0, asked.f1))
    if not asked.small:
        as_others_assume(rated, other)
        breakaway(place["breakaway_dry"][0].value)
    bench.last_line(largest_deviation=largest)


def as_others_assume(rated: Rows, other: Rows) -> None:
    """Print the fit with other parts that are assumed."""
    print("\nother parts assumed:")
    for friction, f0, f1 in product((0.05, 0.15), (1.0, 2.0, 2.6), (0.0, 0.0003, 0.0009)):
        fitted(rated, other, Assumed(friction, f0, f1))


def breakaway(start: float) -> None:
    """Print the fit of what is lost without load at rest."""
    found = least_squares(lambda dry: np.log(both_ways(float(dry[0]))).ravel(), [start])
    dry = float(found.x[0])
    print(f"\nbreakaway_dry {dry:.2f} N/m; computed over printed, starting and back-driving:")
    for (size, ratio), (first, second) in zip(STARTING, both_ways(dry), strict=True):
        forth, back = STARTING[size, ratio]
        over = second * back / (first * forth * ratio)
        print(
            f"size {size}, ratio {ratio}: {first:.3f}, {second:.3f}; back / (ratio x start) {over:.3f}"
        )


if __name__ == "__main__":
    main()
