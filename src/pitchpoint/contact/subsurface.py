"""Stresses below a pressure on the surface of a half space, and what strains the material most."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import array, jnp
from pitchpoint.contact.half_space import HalfSpace
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import fast_program
from pitchpoint.errors import InputError

__all__ = ["Stresses", "below_row", "most_loaded_row", "stresses_below"]

Section = Float[Array, "depth x"]


class Stresses(eqx.Module):
    """Stresses in a section at right angles to the contact line, tension positive.

    Attributes:
        depth: below the surface, shape (depth,) [m].
        xx, yy, zz: normal stresses, z into the solid, shape (depth, x) [Pa].
        xy, yz, zx: shear stresses, shape (depth, x) [Pa].
    """

    depth: Float[Arrays, " depth"]
    xx: Section
    yy: Section
    zz: Section
    xy: Section
    yz: Section
    zx: Section

    def principal(self) -> Float[Array, "depth x 3"]:
        """Principal stresses, the smallest first, shape (depth, x, 3) [Pa]."""
        rows = (
            (self.xx, self.xy, self.zx),
            (self.xy, self.yy, self.yz),
            (self.zx, self.yz, self.zz),
        )
        tensor = jnp.stack([jnp.stack(row, axis=-1) for row in rows], axis=-2)
        return jnp.asarray(jnp.linalg.eigvalsh(tensor))

    def largest_shear(self) -> Section:
        """Half the difference of the outer principal stresses (Tresca), shape (depth, x) [Pa]."""
        principal = self.principal()
        return 0.5 * (principal[..., 2] - principal[..., 0])

    def von_mises(self) -> Section:
        """Stress that is equivalent by the energy of distortion, shape (depth, x) [Pa]."""
        normal = (self.xx - self.yy) ** 2 + (self.yy - self.zz) ** 2 + (self.zz - self.xx) ** 2
        shear = self.xy**2 + self.yz**2 + self.zx**2
        return jnp.sqrt(0.5 * normal + 3.0 * shear)


def most_loaded_row(pressure: NDArray[np.float64]) -> int:
    """Number of the row with the largest pressure."""
    return int(np.argmax(np.max(pressure, axis=1)))


def below_row(
    bodies: HalfSpace,
    pressure: NDArray[np.float64],
    depth: NDArray[np.float64],
    poisson: float,
    row: int | None = None,
) -> Stresses:
    """Stresses in one of the bodies below a row of its surface.

    Args:
        bodies: on their grid.
        pressure: on the cells, shape (y, x) [Pa].
        depth: below the surface, positive; meaningful from about a cell on, shape (depth,) [m].
        poisson: Poisson's ratio of the solid.
        row: number of the row; where there is none, that of the largest pressure.

    Raises:
        InputError: a pressure of another shape or that is not finite, depths that are not positive, another
            row or Poisson's ratio.

    Example: below a steel ball the shear is 0.31 p at 0.48 of the contact's radius.

        >>> import numpy as np
        >>> from pitchpoint.contact.half_space import half_space
        >>> bodies = half_space(np.linspace(-1.5, 1.5, 65), np.linspace(-1.5, 1.5, 66))
        >>> far = bodies.x**2 + bodies.y[:, None] ** 2
        >>> depth = np.linspace(0.3, 0.7, 41)
        >>> stresses = below_row(bodies, np.sqrt(np.maximum(1.0 - far, 0.0)), depth, 0.3)
        >>> shear = np.asarray(stresses.largest_shear())[:, 32]
        >>> round(float(shear.max()), 2), round(float(depth[shear.argmax()]), 2)
        (0.31, 0.48)

    Source: as `stresses_below`.
    """
    _check(bodies, pressure, depth, poisson)
    rows = len(bodies.y)
    row = most_loaded_row(pressure) if row is None else row
    if not 0 <= row < rows:
        raise InputError(f"there is no row {row}: the grid has {rows}, counted from 0", key="row")
    return _below(bodies, array(pressure), array(bodies.y[row]), array(depth), array(poisson))


def stresses_below(
    bodies: HalfSpace,
    pressure: Float[Arrays, "y x"],
    place: Float[Arrays, ""],
    depth: Float[Arrays, " depth"],
    poisson: Float[Arrays, ""],
) -> Stresses:
    """Stresses below the line y = `place`, as a part of programs: nothing is checked.

    Args:
        bodies: on their grid.
        pressure: on the cells, shape (y, x) [Pa].
        place: y of the section [m].
        depth: below the surface, positive, shape (depth,) [m].
        poisson: Poisson's ratio of the solid.

    The pressure is constant on every cell; mirrored ends leave it as it is. Source: Love (1929); Johnson,
    Contact Mechanics (1985), section 3.2.
    """
    nodes = pressure.shape[1]
    kernels = _of_cells(bodies, jnp.asarray(place), jnp.asarray(depth), jnp.asarray(poisson))
    period = 2 * nodes
    waves = jnp.einsum(
        "cdyk,yk->cdk",
        jnp.fft.rfft(kernels, n=period, axis=-1),
        jnp.fft.rfft(pressure, n=period, axis=-1),
    )
    stresses = jnp.fft.irfft(waves, n=period, axis=-1)[..., nodes - 1 : 2 * nodes - 1]
    return Stresses(depth, *stresses)


_below = fast_program(stresses_below)


def _of_cells(bodies: HalfSpace, place: Array, depth: Array, poisson: Array) -> Array:
    """Stresses by a pressure of one on cells of every row, shape (6, depth, y, 2 x - 1).

    The last axis is the distance along x in steps from that cell, from the lowest on.
    """
    nodes = len(bodies.x)
    spacing = (bodies.x[-1] - bodies.x[0]) / (nodes - 1)
    x = spacing * (jnp.arange(2 * nodes) - nodes + 0.5)
    y = place - jnp.asarray(bodies.edges)
    corners = _corners(x, y[:, None], depth[:, None, None], poisson)
    # From the far edge to the near one across, as y falls along the cells.
    rows = corners[..., :-1, :] - corners[..., 1:, :]
    return jnp.diff(rows, axis=-1) / (2.0 * jnp.pi)


def _corners(x: Array, y: Array, z: Array, poisson: Array) -> Array:
    """Primitive along x and y of the stresses below a point load of one, times 2 pi, shape (6, ...).

    Its differences at four corners are the stresses below a rectangle.
    """
    distance = jnp.sqrt(x**2 + y**2 + z**2)
    along, across, both = x**2 + z**2, y**2 + z**2, x * y
    sink = -jnp.arctan2(both, z * distance)
    bend_x, bend_y = -both / (along * distance), -both / (across * distance)
    slack = 1.0 - 2.0 * poisson
    spread_x = jnp.arctan2(both * (distance - z), x**2 * distance + z * y**2)
    spread_y = jnp.arctan2(both * (distance - z), y**2 * distance + z * x**2)
    stresses = (
        2.0 * poisson * sink - z * bend_x - slack * spread_x,
        2.0 * poisson * sink - z * bend_y - slack * spread_y,
        sink + z * (bend_x + bend_y),
        -slack * jnp.log(z + distance) - z / distance,
        z**2 * x / (across * distance),
        z**2 * y / (along * distance),
    )
    return jnp.stack(stresses)


def _check(
    bodies: HalfSpace, pressure: NDArray[np.float64], depth: NDArray[np.float64], poisson: float
) -> None:
    shape = len(bodies.y), len(bodies.x)
    if pressure.shape != shape or not np.all(np.isfinite(pressure)):
        raise InputError(
            f"stresses need a finite pressure on each of {shape} cells", key="pressure"
        )
    if depth.ndim != 1 or not np.all((depth > 0.0) & (depth < np.inf)):
        raise InputError("depths below the surface have to be positive", key="depth")
    if not 0.0 <= poisson <= 0.5:
        raise InputError(
            f"a Poisson's ratio of {poisson:.4g}: it lies from 0 to 0.5", key="poisson"
        )
