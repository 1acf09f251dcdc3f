"""The bearing of a wave generator: balls between a rigid inner race and a thin outer one."""

from dataclasses import dataclass, replace
from math import pi, sqrt
from typing import NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.on_balls import OnBalls, ball_force, over_batch, seated
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing, RingLoads
from pitchpoint.gears.strain_wave.proportions import PROPORTIONS
from pitchpoint.gears.strain_wave.ring_compliance import RingParts, of_modes, ring_modes
from pitchpoint.gears.strain_wave.wave_generator import NeutralLine
from pitchpoint.materials.solids import Solid

__all__ = [
    "Balls",
    "ThinRaceBearing",
    "ball_bearing",
    "ball_circle",
    "ball_stiffness_palmgren_1959",
    "on_balls",
    "parts_on_balls",
]

STEEL = {"young": 206e9, "poisson": 0.3}
"""Of the races, whatever the flexspline is made of."""


@dataclass(frozen=True)
class Balls:
    """Bearing of a wave generator as a designer gives it; see the table `bearing`.

    Values that are None follow from `PROPORTIONS`.

    Attributes:
        number: of balls.
        diameter: of one ball [m].
        race_thickness: of the outer race [m].
        play: radial one between ball and races; negative of balls that push the ring beyond its wave,
            which is its shape on balls without play [m].
    """

    number: float | None = None
    diameter: float | None = None
    race_thickness: float | None = None
    play: float = 0.0

    def sizes(self, pitch_diameter: float) -> dict[str, float]:
        """Dimensions as given or usual, by their keys in the table [m]; of balls their number.

        Args:
            pitch_diameter: of the flexspline [m].
        """
        chosen_sizes = (self.number, self.diameter, self.race_thickness)
        usual = PROPORTIONS.bearing(pitch_diameter).items()
        return {
            key: part if chosen is None else chosen
            for (key, part), chosen in zip(usual, chosen_sizes, strict=True)
        }


class ThinRaceBearing(eqx.Module):
    """Balls under a thin ring.

    Attributes:
        angle: of each ball from the long axis [rad].
        stiffness: of a ball between both races [N/m1.5].
        play: see `Balls` [m].
        bending, stretching: of the outer race, E/(1 - nu^2) I and E A [N m2, N].

    Source: Palmgren (1959) for the balls, see `ball_stiffness_palmgren_1959`; the race bends like
    a wide strip.
    """

    angle: Float[Array, " ball"]
    stiffness: Float[Array, ""]
    play: Float[Array, ""]
    bending: Float[Array, ""]
    stretching: Float[Array, ""]

    @property
    def elsewhere(self) -> "ThinRaceBearing":
        """The same with the balls as far from where they stand as they come.

        Every half of their pitch the ends of the long axis change places if their number is odd, so that a
        quarter is farthest then; else it is half of it.
        """
        number = self.angle.shape[0]
        turned = (0.5 if number % 2 else 1.0) * pi / number
        return replace(self, angle=self.angle + turned)

    def race(self, radius: Float[Array, ""], waves: int) -> Float[Array, " wave"]:
        """Stiffness of the outer race against each number of waves, for one metre around [N/m2].

        It lies on the ring and slides in it, so that it bends with it and stretches by itself.

        From the energy of a free ring whose tangential displacement makes it least.
        """
        square = jnp.arange(waves + 1.0) ** 2
        stretch, bend = self.stretching / radius**2, self.bending / radius**4
        of_waves = stretch * bend * (square - 1.0) ** 2 / (stretch + bend)
        return jnp.where(square == 0.0, stretch, of_waves)


def ball_stiffness_palmgren_1959(diameter: float) -> float:
    """Stiffness of a steel ball between two grooved steel races, force over approach^1.5 [N/m1.5].

    Args:
        diameter: of the ball [m].

    Source: Palmgren (1959): the races approach by 4.36e-4 mm (Q/N)^(2/3) (D/mm)^(-1/3).

    Example:
        >>> stiffness = ball_stiffness_palmgren_1959(6.35e-3)
        >>> round(1e6 * (65.0 / stiffness) ** (2 / 3), 2)
        3.81
    """
    return sqrt(diameter / 4.36e-8**3)


def ball_circle(balls: Balls, diameter: float, bore: float) -> float:
    """Diameter of the circle on which the balls stand before the wave bends it [m].

    Args:
        balls: what is given of the bearing.
        diameter: pitch diameter of the flexspline [m].
        bore: of its rim, in which the outer race lies [m].

    Example:
        >>> from pitchpoint.gears.strain_wave.ball_bearing import Balls
        >>> round(ball_circle(Balls(), 60e-3, 58.4e-3) / 60e-3, 3)
        0.87
    """
    sizes = balls.sizes(diameter)
    return bore - 2.0 * sizes["race_thickness"] - sizes["ball_diameter"]


def ball_bearing(balls: Balls, diameter: float, bore: float, width: float) -> ThinRaceBearing:
    """The bearing of a drive.

    Args:
        balls, diameter, bore: as in `ball_circle`.
        width: of its toothed ring, and of the race under it [m].
    """
    sizes = balls.sizes(diameter)
    number, ball, race = int(sizes["balls"]), sizes["ball_diameter"], sizes["race_thickness"]
    circle = ball_circle(balls, diameter, bore)
    if not (circle > 0.0 and number * ball < pi * circle):
        raise InputError(
            f"{number} balls of {1e3 * ball:.4g} mm under a race of {1e3 * race:.4g} mm do not fit into a "
            f"flexspline with a bore of {1e3 * bore:.5g} mm; fewer or smaller ones do",
            key="balls" if balls.number is not None else "ball_diameter",
        )
    young, poisson = STEEL["young"], STEEL["poisson"]
    return ThinRaceBearing(
        angle=array(2.0 * pi * np.arange(number) / number),
        stiffness=array(ball_stiffness_palmgren_1959(ball)),
        play=array(balls.play),
        bending=array(young / (1.0 - poisson**2) * width * race**3 / 12.0),
        stretching=array(young * width * race),
    )


class _Modes(NamedTuple):
    """Work of unit forces on the modes of the free ring, see `ring_modes`: of lanes, and of balls."""

    lanes: Float[Array, "lane mode *b"]
    balls: Float[Array, "ball mode"]


def _modes(bearing: ThinRaceBearing, ring: FlexibleRing, solid: Solid, loads: RingLoads) -> _Modes:
    nothing, outward = jnp.zeros_like(bearing.angle), jnp.ones_like(bearing.angle)
    pushes = RingLoads(*(x[:, None] for x in (bearing.angle, nothing, outward, nothing)))
    return _Modes(
        ring_modes(ring, solid, loads, bearing.race), ring_modes(ring, solid, pushes, bearing.race)
    )


def on_balls(
    bearing: ThinRaceBearing, ring: FlexibleRing, line: NeutralLine, solid: Solid, loads: RingLoads
) -> OnBalls:
    """How teeth and balls move each other through the ring and the outer race.

    Args:
        bearing: of the wave generator.
        ring: toothed rim and cup; what is said of its support does not count.
        line: the wave into which the wave generator pushes it.
        solid: material of the ring.
        loads: where and how a unit force at each contact acts.

    The balls stand where they would hold the ring in its wave if they and the play did not give way;
    where the ring would have to be pulled, they let it go. The gaps of the teeth are counted from the ring
    on balls without play: what those with play bear less lets the ring, and so the teeth, sit back.

    From the compliance of a free ring, see `ring_modes`, and the law of the balls, see `ball_force`.
    """
    modes = _modes(bearing, ring, solid, loads)
    balls, free = modes.balls @ modes.balls.T, modes.lanes.shape[2:]
    across = jnp.einsum("im...,jm->ij...", modes.lanes, modes.balls)
    approach, nominal = (_seated(bearing, balls, line, x) for x in (bearing.play, jnp.zeros(())))
    extra_force = ball_force(bearing.stiffness, approach) - ball_force(bearing.stiffness, nominal)
    return OnBalls(
        lanes=jnp.einsum("im...,jm...->ij...", modes.lanes, modes.lanes),
        across=across,
        balls=balls,
        stiffness=bearing.stiffness,
        approach=approach,
        shift=jnp.einsum("ij...,j->i...", across, extra_force),
        start=jnp.broadcast_to(over_batch(approach, len(free)), (*approach.shape, *free)),
    )


def _seated(
    bearing: ThinRaceBearing,
    balls: Float[Array, "ball ball"],
    line: NeutralLine,
    play: Float[Array, ""],
) -> Float[Array, " ball"]:
    """Approach of balls with a play without load on the teeth [m]."""
    return seated(balls, bearing.stiffness, line.radial(bearing.angle) - play)


def parts_on_balls(
    bearing: ThinRaceBearing,
    ring: FlexibleRing,
    line: NeutralLine,
    solid: Solid,
    loads: RingLoads,
    force: Float[Array, "pair slice *b"],
    balls: Float[Array, "ball *b"],
) -> RingParts:
    """How much of the compliance of the ring on its balls each part brings.

    Args:
        bearing, ring, line, solid, loads: as in `on_balls`.
        force: normal force of each slice [N].
        balls: approach of each ball at this load [m].

    From the work of what the balls bear beyond the state without load.
    """
    modes = _modes(bearing, ring, solid, loads)
    coupled = modes.balls @ modes.balls.T
    before = ball_force(bearing.stiffness, _seated(bearing, coupled, line, bearing.play))
    extra_force = ball_force(bearing.stiffness, balls) - over_batch(before, balls.ndim - 1)
    of_balls = jnp.einsum("im,i...->m...", modes.balls, extra_force)
    flat = force.reshape(-1, *force.shape[2:])
    amplitude = jnp.einsum("im...,i...->m...", modes.lanes, flat) + of_balls
    wall, rim = of_modes(amplitude)
    return RingParts(wall, rim, -jnp.sum(amplitude * of_balls, axis=0))
