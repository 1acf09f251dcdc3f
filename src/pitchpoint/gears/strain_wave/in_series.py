"""What yields behind the teeth of a strain wave gear, one part after the other: cup bottom, joint, shaft."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.errors import InputError
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing
from pitchpoint.gears.strain_wave.proportions import DIMENSIONS, PROPORTIONS
from pitchpoint.materials.solids import Solid

__all__ = [
    "Behind",
    "Cup",
    "InSeries",
    "bolts_in_shear",
    "disc_in_torsion",
    "in_series",
    "part_dimensions",
    "shaft_in_torsion",
]

STEEL_SHEAR_MODULUS = 79.3e9
"""Of bolts and shafts, whatever the splines are made of [Pa]."""


def disc_in_torsion(thickness: float, inner: float, outer: float) -> float:
    """Twist of an annular disc between its edges, times the shear modulus, for a unit torque [1/m3].

    Args:
        thickness, inner, outer: of the disc, and its radii [m].

    From the shear stress T/(2 pi r^2 t) in the plane of the disc, integrated over the radius.

    Example:
        >>> round(disc_in_torsion(1e-3, 0.01, 0.02) * 1e-4, 4)
        59.6831
    """
    return (inner**-2 - outer**-2) / (4.0 * pi * thickness)


def bolts_in_shear(number: float, diameter: float, circle: float) -> float:
    """Torsional stiffness of a joint whose bolts yield in shear [N m/rad].

    Args:
        number: of bolts.
        diameter: of one bolt, and its length in shear [m].
        circle: diameter on which they stand [m].

    From the shear G A/l of each bolt at half the diameter of the circle. The friction that keeps faces
    together makes a joint stiffer, its own faces make it softer: an estimate.

    Example:
        >>> round(bolts_in_shear(8, 5e-3, 0.03) / 1e3)
        561
    """
    bolt_stiffness = STEEL_SHEAR_MODULUS * pi * diameter / 4.0
    return number * bolt_stiffness * (circle / 2.0) ** 2


def shaft_in_torsion(diameter: float, length: float) -> float:
    """Torsional stiffness of a solid steel shaft [N m/rad].

    Args:
        diameter, length: [m].

    Source: Timoshenko and Goodier (1970), torsion of circular shafts.

    Example:
        >>> round(shaft_in_torsion(0.01, 0.02))
        3893
    """
    return STEEL_SHEAR_MODULUS * pi * diameter**4 / 32.0 / length


class InSeries(eqx.Module):
    """Parts that carry the whole torque of their member, one behind the other.

    Attributes:
        bottom: twist of the cup's bottom times its shear modulus, see `disc_in_torsion` [1/m3].
        compliance: of the parts whose stiffness was given or does not follow from the flexspline's
            material, in the order of `parts` [rad/(N m)]; zero of rigid ones.
        parts: their names; static.
        ring: of the circular spline, which the teeth bend and stretch; None where it is rigid.

    From springs in a row, whose compliances add up.
    """

    bottom: Float[Array, ""]
    compliance: Float[Array, " part"]
    ring: FlexibleRing | None

    parts: ClassVar = (
        "bottom of the cup",
        "flange joint",
        "wave generator's shaft",
        "circular spline",
    )
    members: ClassVar = (1, 1, 0, 2)

    @classmethod
    def rigid(cls) -> "InSeries":
        """Nothing yields behind the teeth, rim and wall."""
        return cls(array(0.0), array([0.0] * len(cls.parts)), None)

    def by_part(
        self, flexspline: Solid, law: Float[Array, "3"], loaded: Float[Arrays, "3"]
    ) -> dict[str, Float[Array, ""]]:
        """Rotation of the loaded member for a unit torque on it, by part [rad/(N m)]; none of rigid ones.

        Args:
            flexspline: its material.
            law: factors to which the torques of the members are in proportion.
            loaded: one for the loaded member.

        By virtual work a part of another member counts with the square of that member's torque: the shaft
        of a wave generator that is held divides by the square of the ratio.
        """
        shear = flexspline.young / (2.0 + 2.0 * flexspline.poisson)
        compliances = self.compliance.at[0].add(self.bottom / shear)
        torque = law[jnp.array(self.members)] / (law @ loaded)
        return dict(zip(self.parts, compliances * torque**2, strict=True))


@dataclass(frozen=True)
class Behind:
    """What yields behind teeth, rim and wall, as a designer gives it; see the table `yielding`.

    Lengths in m, stiffness in N m/rad. Values that are None follow from `PROPORTIONS`; the bottom, which
    carries the torque of the wall on half the radius, is as thick as the rim. A stiffness takes the place
    of a model.
    """

    cup_bottom: str = "disc"
    cup_bottom_stiffness: float | None = None
    bottom_thickness: float | None = None
    flange_diameter: float | None = None
    flange: str = "bolts"
    flange_stiffness: float | None = None
    bolts: float | None = None
    bolt_diameter: float | None = None
    bolt_circle: float | None = None
    wave_generator: str = "shaft"
    wave_generator_stiffness: float | None = None
    shaft_diameter: float | None = None
    shaft_length: float | None = None
    circular_spline: str = "ring"
    circular_spline_stiffness: float | None = None
    outside_diameter: float | None = None


@dataclass(frozen=True)
class Cup:
    """Dimensions of a drive on which those of the parts behind the teeth depend [m].

    Attributes:
        diameter: pitch diameter of the flexspline.
        radius: of its neutral line, at which the bottom ends.
        rim: thickness of the rim.
        root: radius of the circular spline's root circle.
        width: of the circular spline.
    """

    diameter: float
    radius: float
    rim: float
    root: float
    width: float


def in_series(behind: Behind, cup: Cup) -> InSeries:
    """The parts behind the teeth.

    Args:
        behind: what is given of them.
        cup: of the drive.

    Raises:
        InputError: a flange as wide as the cup, a circular spline without a body; the key is the name.
    """
    stiffnesses = (getattr(behind, f"{part}_stiffness") for part in DIMENSIONS)
    modelled = {part: _modelled(behind, part) for part in DIMENSIONS}
    sizes = part_dimensions(behind, cup.diameter, cup.rim)
    values = [0.0 if stiffness is None else 1.0 / stiffness for stiffness in stiffnesses]
    if modelled["flange"]:
        values[1] = 1.0 / _joint(sizes, cup)
    if modelled["wave_generator"]:
        values[2] = 1.0 / _shaft(sizes, cup)
    return InSeries(
        bottom=array(_bottom(sizes, cup) if modelled["cup_bottom"] else 0.0),
        compliance=array(values),
        ring=_ring(sizes, cup) if modelled["circular_spline"] else None,
    )


def part_dimensions(behind: Behind, diameter: float, rim: float) -> dict[str, float]:
    """Dimensions of the parts that a model describes, as given or usual, by name [m]; of bolts their number.

    Args:
        behind: what is given of them.
        diameter: pitch diameter of the flexspline [m].
        rim: thickness of its rim [m].
    """
    usual = PROPORTIONS.behind(diameter) | {"bottom_thickness": rim}
    names = (
        name
        for part, part_names in DIMENSIONS.items()
        if _modelled(behind, part)
        for name in part_names
    )
    chosen = {name: getattr(behind, name) for name in names}
    return {name: usual[name] if value is None else value for name, value in chosen.items()}


def _modelled(behind: Behind, part: str) -> bool:
    return getattr(behind, f"{part}_stiffness") is None and getattr(behind, part) != "rigid"


def _bottom(sizes: Mapping[str, float], cup: Cup) -> float:
    flange = sizes["flange_diameter"]
    if flange >= 2.0 * cup.radius:
        raise InputError(
            f"the flange has a diameter of {1e3 * flange:.5g} mm and leaves no bottom of the cup, which has "
            f"one of {2e3 * cup.radius:.5g} mm",
            key="flange_diameter",
        )
    return disc_in_torsion(sizes["bottom_thickness"], flange / 2.0, cup.radius)


def _joint(sizes: Mapping[str, float], cup: Cup) -> float:
    circle = sizes["bolt_circle"]
    _demand_inside("bolt_circle", "bolts stand on a circle", circle, cup)
    return bolts_in_shear(sizes["bolts"], sizes["bolt_diameter"], circle)


def _shaft(sizes: Mapping[str, float], cup: Cup) -> float:
    diameter = sizes["shaft_diameter"]
    _demand_inside("shaft_diameter", "the wave generator's shaft has a diameter", diameter, cup)
    return shaft_in_torsion(diameter, sizes["shaft_length"])


def _demand_inside(key: str, what: str, diameter: float, cup: Cup) -> None:
    """InputError if a part of the cup is wider than the cup."""
    if diameter >= 2.0 * cup.radius:
        raise InputError(
            f"{what} of {1e3 * diameter:.5g} mm, and the cup has one of {2e3 * cup.radius:.5g} mm",
            key=key,
        )


def _ring(sizes: Mapping[str, float], cup: Cup) -> FlexibleRing:
    """The circular spline from its roots outwards, free to bend, held against turning at its outside.

    The shear of its face between both radii, as of a disc, stands for the wall of a cup.
    """
    outside = sizes["outside_diameter"] / 2.0
    if outside <= cup.root:
        raise InputError(
            f"the circular spline has an outside diameter of {2e3 * outside:.5g} mm, and its roots lie on "
            f"one of {2e3 * cup.root:.5g} mm",
            key="outside_diameter",
        )
    middle = (outside + cup.root) / 2.0
    twist = disc_in_torsion(cup.width, cup.root, outside)
    return FlexibleRing(
        radius=array(middle),
        thickness=array(outside - cup.root),
        width=array(cup.width),
        wall_thickness=array(1.0),
        cup_length=array(2.0 * pi * middle**3 * twist),
        support_stiffness=array(0.0),
    )
