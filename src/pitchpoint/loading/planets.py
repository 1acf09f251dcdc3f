"""Forces of planets that share a load by springs which only push: pins out of place, a floating body."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos
from typing import Any

import numpy as np
from jaxtyping import Float

from pitchpoint.errors import ConvergenceError

__all__ = ["PinEquivalents", "path_stiffness", "planet_forces"]

Numbers = Any
"""Numbers or arrays that broadcast."""

# Bounds, not choices: of 4000 random sets of three to eight planets, floating or not, none took more than
# eight steps; sixty halvings are the digits of a number.
MOST_STEPS, HALVINGS = 200, 60
SOFT = 1e-8
"""Spring of a body that no planet holds, over that of a planet: its steps are long, and halved as needed."""
NEAR = 1e-10
"""Unbalance over the load at which the search ends."""


def path_stiffness(
    *, levers: Sequence[float], stiffnesses: Sequence[float], pin_stiffness: float = np.inf
) -> float:
    """Stiffness of the way of the load over one planet, as its pin feels it along its circle [N/m].

    Args:
        levers: load of each mesh of the planet over the force on its pin: a normal force [1], or the torque
            of its driven gear [m].
        stiffnesses: of each mesh under such a load, the other gear held: [N/m], or [N m/rad].
        pin_stiffness: of the pin and its bearing along the circle [N/m].

    Example:
        Sun and ring alike at a working pressure angle of 24.6 degrees, on pins of 1e8 N/m:

        >>> from math import cos, radians
        >>> lever = 1.0 / (2.0 * cos(radians(24.6)))
        >>> stiffness = path_stiffness(
        ...     levers=(lever, lever), stiffnesses=(5e8, 5e8), pin_stiffness=1e8
        ... )
        >>> f"{stiffness:.4g}"
        '8.921e+07'

    From virtual work, springs in a row: 1/k = Σ lever²/k_mesh + 1/k_pin.
    """
    compliance = sum(
        lever**2 / stiffness for lever, stiffness in zip(levers, stiffnesses, strict=True)
    )
    return float(1.0 / (compliance + 1.0 / pin_stiffness))


@dataclass(frozen=True)
class PinEquivalents:
    """Deviations of the teeth of a set, each as the way by which a pin ahead loads its planet alike.

    A pin that is ahead by e opens the meshes of its planet by e cos α_s and e cos α_r along the transverse
    normals, and the planet turns until both carry. What opens one of them alone counts by its force for a
    unit on the pin, r/(r cos α_s + cos α_r) with the sun and 1/(r cos α_s + cos α_r) with the ring.

    Attributes:
        sun, ring: transverse working pressure angles of both meshes [rad].
        pressure_angle: normal pressure angle [rad].
        base_helix: helix angle on the base cylinders [rad].
        step: base radius r of the gear of the planets in the ring over that of their gear at the sun.

    Source: closings of the meshes after Lin and Parker (1999), with the planet's turn eliminated.

    Example:
        A planet with teeth thicker by 10 micrometres bears as if its pin were behind by half of that:

        >>> from math import radians
        >>> alike = PinEquivalents(radians(20.0), radians(20.0), radians(20.0))
        >>> f"{alike.of_thickness(10e-6):.3g}"
        '-5e-06'
    """

    sun: float
    ring: float
    pressure_angle: float
    base_helix: float = 0.0
    step: float = 1.0

    @property
    def _at_sun(self) -> float:
        """Normal force between sun and planet for a unit on the pin along its circle."""
        return self.step * self._at_ring

    @property
    def _at_ring(self) -> float:
        """Normal force between planet and ring for a unit on the pin along its circle."""
        return 1.0 / (self.step * cos(self.sun) + cos(self.ring))

    def of_thickness(self, thicker: Numbers, second: Numbers = None) -> Numbers:
        """Of a planet whose teeth are thicker on the normal reference circle [m].

        Both flanks are ahead by half of it, along the normal by cos α_n of that.

        Args:
            thicker: of the gear in mesh with the sun.
            second: of the gear in the ring; it is the same one unless given.
        """
        both = self._at_sun * thicker + self._at_ring * (thicker if second is None else second)
        return -0.5 * both * cos(self.pressure_angle) / cos(self.base_helix)

    def of_planet(self, offset: Numbers, phase: Numbers, second: Numbers = None) -> Numbers:
        """Of the teeth of a planet, off its pin by the offset [m] at the phase from outwards [rad].

        Args:
            offset: of either gear.
            phase: of the gear in mesh with the sun.
            second: phase of the gear in the ring; it is the same one unless given.
        """
        behind = phase if second is None else second
        at_sun = self._at_sun * np.sin(phase + self.sun)
        return offset * (at_sun + self._at_ring * np.sin(behind - self.ring))

    def of_sun(self, offset: Numbers, phase: Numbers, angles: Numbers) -> Numbers:
        """Of a sun, off the axis by the offset [m] at the phase, for planets at the angles [rad]."""
        return -offset * np.sin(phase - angles + self.sun) * self._at_sun

    def of_ring(self, offset: Numbers, phase: Numbers, angles: Numbers) -> Numbers:
        """Of a ring, see `of_sun`."""
        return -offset * np.sin(phase - angles - self.ring) * self._at_ring


def planet_forces(
    total: float,
    stiffness: float,
    errors: Float[np.ndarray, "*b planet"],
    angles: Float[np.ndarray, " planet"],
    *,
    floating: bool = False,
) -> Float[np.ndarray, "*b planet"]:
    """Force on the pin of each planet along its circle, at least zero [N].

    Args:
        total: of all planets: torque of the carrier over the radius of the pins [N].
        stiffness: of the way over one planet, see `path_stiffness` [N/m].
        errors: of the places of the pins along their circle, positive where a pin is ahead in the sense in
            which the sun pushes the planets, so that it takes less [m].
        angles: of the planets about the axis of the carrier [rad].
        floating: True if one of sun, ring and carrier is free to move sideways, without weight and friction.

    Raises:
        ConvergenceError: no equilibrium was found.

    From the least of the elastic energy, convex in the turn and the shift of the body that floats, by
    Newton's method with a search along its step: a planet whose gap is open carries nothing. Held against the
    closed form F/N - k e', e' the error less its mean and, floating, less its first harmonic.
    """
    errors = np.asarray(errors, dtype=float)
    arms = np.ones((angles.size, 1))
    if floating:
        arms = np.column_stack([arms, np.cos(angles), np.sin(angles)])
    asked = np.zeros(arms.shape[1])
    asked[0] = total
    # In units of an equal share: then energies and steps are near one.
    gaps = errors.reshape(-1, angles.size) * stiffness / (total / angles.size)
    share = asked / (total / angles.size)

    def forces(place: np.ndarray) -> np.ndarray:
        return np.asarray(np.maximum(place @ arms.T - gaps, 0.0))

    place = np.zeros((gaps.shape[0], share.size))
    place[:, 0] = 1.0 + gaps.mean(axis=1)
    for _ in range(MOST_STEPS):
        pushed = forces(place)
        left = pushed @ arms - share
        unbalanced = np.max(np.abs(left), axis=1) > NEAR * angles.size
        if not unbalanced.any():
            shared: np.ndarray = np.reshape(pushed, errors.shape) * (total / angles.size)
            return shared
        active = (pushed > 0.0).astype(float)
        curvature = np.einsum("pi,bp,pj->bij", arms, active, arms)
        # Few planets that push leave the body free to shift: it does until it meets others.
        step = -np.linalg.solve(curvature + SOFT * np.eye(share.size), left[..., None])[..., 0]
        # Energy is convex: where it would rise again its least along the step is found by halving.
        least, most = np.zeros(len(gaps)), np.ones(len(gaps))
        part = most
        for _ in range(HALVINGS):
            rise = np.einsum("bi,bi->b", forces(place + part[:, None] * step) @ arms - share, step)
            too_far = rise > NEAR * np.abs(np.einsum("bi,bi->b", left, step))
            most, least = np.where(too_far, part, most), np.where(too_far, least, part)
            if (least == most).all():
                break
            part = np.where(least == 1.0, 1.0, (least + most) / 2.0)
        place = place + np.where(unbalanced, least, 0.0)[:, None] * step
    raise ConvergenceError("the planets of this set were not brought into equilibrium")
