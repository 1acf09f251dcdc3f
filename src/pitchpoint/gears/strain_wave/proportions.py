"""Usual dimensions of strain wave gears over their pitch diameter."""

from dataclasses import dataclass

__all__ = ["DIMENSIONS", "PROPORTIONS", "Proportions", "rim_by_strain"]

DIMENSIONS = {
    "cup_bottom": ("bottom_thickness", "flange_diameter"),
    "flange": ("bolts", "bolt_diameter", "bolt_circle"),
    "wave_generator": ("shaft_diameter", "shaft_length"),
    "circular_spline": ("outside_diameter",),
}
"""Dimensions that the model of each part behind the teeth asks for."""


@dataclass(frozen=True)
class Proportions:
    """Dimensions over the pitch diameter of the flexspline, so that stiffness goes with the cube of the size.

    All are assumed and none is confirmed: the outside as recalled from catalogues, the others as usual for
    such parts, whose makers publish nothing of what lies inside. They are the one place at which an assumed
    dimension of these parts is set.

    Attributes:
        cup: length of the cup, from the teeth to its flange.
        flange: diameter of the flange, at which the bottom of the cup begins.
        bolts: number of bolts of the flange.
        bolt_circle, bolt: diameters of the circle and of one bolt.
        shaft, shaft_length: diameter of the wave generator's shaft, and its length up to the input.
        outside: outer diameter of the circular spline.
        ball, balls: diameter of the balls of the wave generator's bearing, and their number.
        race: thickness of the outer race that bends with the ring.
        rim: largest thickness of the flexspline's rim, of steel.
        strain: largest one by which the wave bends that rim; chosen so that drives of 50 and 30 are softer
            than those of 100 about as catalogues say.
        plastic_rim, plastic_strain: the same of plastic, as printed and moulded cups are.
    """

    cup: float = 0.5
    flange: float = 0.5
    bolts: int = 8
    bolt_circle: float = 0.4
    bolt: float = 0.06
    shaft: float = 0.17
    shaft_length: float = 0.4
    outside: float = 1.35
    ball: float = 0.078
    balls: int = 23
    race: float = 0.0125
    rim: float = 0.01
    strain: float = 3.75e-4
    plastic_rim: float = 0.02
    plastic_strain: float = 2e-3

    def behind(self, diameter: float) -> dict[str, float]:
        """Usual dimensions of the parts behind the teeth, by name [m]; of bolts their number.

        Args:
            diameter: pitch diameter of the flexspline [m].
        """
        return {
            "flange_diameter": self.flange * diameter,
            "bolts": self.bolts,
            "bolt_circle": self.bolt_circle * diameter,
            "bolt_diameter": self.bolt * diameter,
            "shaft_diameter": self.shaft * diameter,
            "shaft_length": self.shaft_length * diameter,
            "outside_diameter": self.outside * diameter,
        }

    def bearing(self, diameter: float) -> dict[str, float]:
        """Usual dimensions of the wave generator's bearing, by name [m]; of balls their number.

        Args:
            diameter: pitch diameter of the flexspline [m].
        """
        return {
            "balls": self.balls,
            "ball_diameter": self.ball * diameter,
            "race_thickness": self.race * diameter,
        }


PROPORTIONS = Proportions()


def rim_by_strain(diameter: float, deflection: float, *, plastic: bool = False) -> float:
    """Thickness of a rim that its wave bends no further than usual [m].

    Args:
        diameter: pitch diameter of the flexspline [m].
        deflection: of the ring on the long axis [m].
        plastic: True for cups of plastic, False for those of steel.

    From the curvature 3 w0/r^2 by which a wave of two lobes bends a ring that keeps its length: the strain
    at its faces is 6 w0 t/d^2. A derived rule; what makers take is not published.

    Example:
        >>> [round(1e3 * rim_by_strain(0.06, 0.06 / (2 * ratio)), 3) for ratio in (30, 50, 100)]
        [0.225, 0.375, 0.6]
    """
    most, strain = (
        (PROPORTIONS.plastic_rim, PROPORTIONS.plastic_strain)
        if plastic
        else (PROPORTIONS.rim, PROPORTIONS.strain)
    )
    return min(most * diameter, strain * diameter**2 / (6.0 * deflection))
