"""Compliance of a thin ring under tooth forces, by Fourier series around it."""

from collections.abc import Callable
from typing import NamedTuple

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing, RingLoads
from pitchpoint.materials.solids import Solid

__all__ = ["WAVES", "RingParts", "of_modes", "ring_compliance", "ring_modes", "ring_parts"]

WAVES = 100
"""Largest number of waves around the ring. What is shorter than a tooth pitch belongs to the tooth's
foundation: with 100 teeth the series ends there."""

Lane = Float[Array, "lane *b"]
Modes = Float[Array, "lane mode *b"]


class _Stiffness(eqx.Module):
    """Stiffness of the ring against each number of waves, for one metre of its circumference [N/m2].

    With w = A cos(n phi) and v = B sin(n phi) the energy is a quadratic form in A and B; it is held
    as that of B alone, what A brings beyond B, and their coupling.

    Attributes:
        tangential: against B while w is held at zero.
        radial: against A while v is free; infinite on a rigid wave generator.
        coupling: ratio by which v follows w.
    """

    tangential: Float[Array, " wave"]
    yielding: Float[Array, " wave"]
    coupling: Float[Array, " wave"]


def ring_compliance(
    ring: FlexibleRing, solid: Solid, loads: RingLoads, waves: int = WAVES
) -> Float[Array, "lane lane *b"]:
    """Displacement at each contact along its normal for a unit normal force at another one [m/N].

    Energy int (EA eps^2 + EI chi^2 + k_w w^2 + k_v v^2) r dphi / 2 of a ring with extensible neutral
    line, radial and tangential displacement w and v, strain eps = (v' + w)/r and curvature
    chi = (w'' - v')/r^2, in Fourier series around the ring. k_w is the support by the wave
    generator's bearing; k_v = G t_c/L_c that of the cup, a tube in shear held at its flange, whose
    uniform part is the torsion 2 pi r^3 G t_c/L_c of a thin tube. A force at height h above the
    neutral line moves with v + h psi, psi = (v - w')/r.

    The rim bends like a wide strip, EI = E/(1 - nu^2) b t^3/12, and stretches like a narrow one,
    EA = E b t.

    Args:
        ring: the toothed rim and its cup.
        solid: its material; `young` and `poisson` without axes.
        loads: where and how a unit force at each contact acts; pairs and slices make up the lanes.
        waves: largest number of waves around the ring, static.

    Returns:
        Symmetric positive semidefinite matrix. Right under a force the sum converges like one over
        `waves`: with 100 it lacks half a percent on a rigid support and up to a tenth on one of
        1e10 N/m2, where the moment of the force bends the rim.

    Validity: thin ring, small displacements added to those by which the wave generator shaped it;
    the support is taken to hold in both directions; no warping of the cup and no bending along it.

    From the least of that energy, one number of waves after the other.
    """
    support = ring.support_stiffness
    modes = _modes(ring, loads, _stiffness(ring, solid, waves, support, _cup(ring, solid)))
    return jnp.einsum("im...,jm...->ij...", modes, modes)


Race = Callable[[Float[Array, ""], int], Float[Array, " wave"]]


def ring_modes(
    ring: FlexibleRing, solid: Solid, loads: RingLoads, race: Race, waves: int = WAVES
) -> Modes:
    """Work of a unit force at each lane on each mode of a ring without support, over its root stiffness.

    Products of two of them, summed over the modes, are displacements along one force for the other [m/N].
    Two and more waves pass into the cup without stretching its wall: each generator stays straight, turns
    about the bottom and shifts along the axis. Its bending and twist hold the ring against them, while its
    shear holds against torsion and sideways motion, as in `ring_compliance`.

    Args:
        ring, solid, loads, waves: as in `ring_compliance`.
        race: stiffness that a race under the ring adds against each number of waves, for one metre of
            the circumference, from its radius and `waves` [N/m2].

    Validity: the bottom lets the wall shift along the axis.

    Source: Love (1927), section 321, for shells that do not stretch.
    """
    number = jnp.arange(waves + 1.0)
    shear = jnp.where(number < 2.0, _cup(ring, solid), 0.0)
    support = race(ring.radius, waves) + _wall(ring, solid, number)
    return _modes(ring, loads, _stiffness(ring, solid, waves, support, shear))


class RingParts(NamedTuple):
    """Work of forces on their displacements by a ring, by what yields [N m].

    Attributes:
        wall: torsion of the cup.
        rim: all else that the ring does, and the wall with it.
        support: the bearing inside, while it is of one stiffness all around.
    """

    wall: Float[Array, "*b"]
    rim: Float[Array, "*b"]
    support: Float[Array, "*b"]


def ring_parts(
    ring: FlexibleRing,
    solid: Solid,
    loads: RingLoads,
    force: Float[Array, "pair slice *b"],
    waves: int = WAVES,
) -> RingParts:
    """How much of the compliance of a ring each of its parts brings.

    Args:
        ring, solid, loads, waves: as in `ring_compliance`.
        force: normal force of each slice [N].

    From the energies of a mode that yields by itself and by its support.
    """
    stiffness = _stiffness(ring, solid, waves, ring.support_stiffness, _cup(ring, solid))
    modes = _modes(ring, loads, stiffness)
    amplitude = jnp.einsum("im...,i...->m...", modes, force.reshape(-1, *force.shape[2:]))
    wall, rim = of_modes(amplitude)
    rigid = jnp.isinf(ring.support_stiffness)
    held = jnp.where(rigid, 0.0, ring.support_stiffness) * stiffness.yielding
    _, cosine, _, sine = amplitude.reshape(4, waves + 1, *amplitude.shape[1:]) ** 2
    support = jnp.einsum("n,n...->...", held, cosine + sine)
    return RingParts(wall, rim - support, support)


def of_modes(amplitude: Float[Array, "mode *b"]) -> tuple[Float[Array, "*b"], Float[Array, "*b"]]:
    """Work in the torsion of the wall, and in all other modes [N m].

    Args:
        amplitude: work of the forces on each mode over its root stiffness, see `ring_modes`.
    """
    work = amplitude**2
    uniform = work.reshape(4, -1, *work.shape[1:])[2, 0]
    return uniform, jnp.sum(work, axis=0) - uniform


def _cup(ring: FlexibleRing, solid: Solid) -> Float[Array, ""]:
    """Stiffness of the wall in shear, for one metre around [N/m2]."""
    shear = solid.young / (2.0 + 2.0 * solid.poisson)
    return shear * ring.wall_thickness / ring.cup_length


def _wall(ring: FlexibleRing, solid: Solid, number: Float[Array, " wave"]) -> Float[Array, " wave"]:
    """Stiffness of a wall that bends and twists without stretching, against w, for one metre [N/m2]."""
    plate = solid.plane_strain_modulus * ring.wall_thickness**3 / 12.0
    bends = ring.cup_length / 3.0 * (number**2 - 1.0) ** 2 / ring.radius**4
    slope = number - 1.0 / jnp.maximum(number, 1.0)
    twists = 2.0 * (1.0 - solid.poisson) * slope**2 / (ring.radius**2 * ring.cup_length)
    return jnp.where(number < 2.0, 0.0, plate * (bends + twists))


def _stiffness(
    ring: FlexibleRing,
    solid: Solid,
    waves: int,
    support: Float[Array, "#wave"] | Float[Array, ""],
    cup: Float[Array, "#wave"] | Float[Array, ""],
) -> _Stiffness:
    number = jnp.arange(waves + 1.0)
    square = number**2
    area = ring.width * ring.thickness
    stretch = solid.young * area / ring.radius**2
    bend = solid.plane_strain_modulus * area * ring.thickness**2 / 12.0 / ring.radius**4
    tangential = square * (stretch + bend) + cup
    # The determinant of the form over `tangential`, written so that nothing cancels.
    alone = stretch * bend * square * (square - 1.0) ** 2 + cup * (stretch + bend * square**2)
    rigid = jnp.isinf(support)
    support = jnp.where(rigid, 0.0, support)  # no infinite numbers in derivatives
    return _Stiffness(
        tangential=tangential,
        yielding=jnp.where(rigid, 0.0, 1.0) / (alone / tangential + support),
        coupling=number * (stretch + bend * square) / tangential,
    )


def _modes(ring: FlexibleRing, loads: RingLoads, stiffness: _Stiffness) -> Modes:
    """Work of a unit force at each lane on each mode, over the root of the mode's stiffness."""
    angle, along, outward, height = (
        part.reshape(-1, 1, *part.shape[2:])
        for part in jnp.broadcast_arrays(loads.angle, loads.tangential, loads.radial, loads.height)
    )
    rank = angle.ndim

    def of_wave(values: Float[Array, " wave"]) -> Float[Array, "1 wave *b"]:
        return values.reshape(1, -1, *(1 for _ in range(rank - 2)))

    number = of_wave(jnp.arange(stiffness.yielding.shape[0] + 0.0))
    length = ring.radius * jnp.where(number == 0.0, 2.0 * jnp.pi, jnp.pi)
    cosine, sine = jnp.cos(number * angle), jnp.sin(number * angle)
    lever = height / ring.radius
    push = along * (1.0 + lever)
    tilt = number * along * lever
    parts = []
    # w = A cos, v = B sin and w = A sin, v = -B cos have the same energy.
    for radial, tangential in (
        (outward * cosine + tilt * sine, push * sine),
        (outward * sine - tilt * cosine, -push * cosine),
    ):
        beyond = radial - of_wave(stiffness.coupling) * tangential
        parts.append(tangential / jnp.sqrt(length * of_wave(stiffness.tangential)))
        yields = of_wave(stiffness.yielding) > 0.0
        share = jnp.where(yields, of_wave(stiffness.yielding), 1.0) / length
        parts.append(jnp.where(yields, beyond * jnp.sqrt(share), 0.0))
    return jnp.concatenate(parts, axis=1)
