"""Deflection of two elastic half spaces by the pressure on the cells of a rectangular grid."""

from math import isqrt
from typing import Any, Final, TypeAlias

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float
from numpy.typing import NDArray

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.errors import InputError

__all__ = ["ENDS", "HalfSpace", "graded_edges", "half_space"]

ENDS: Final[dict[str, float]] = {"half_space": 0.0, "mirrored": 1.0}
"""Share of the pressure that acts once more, mirrored at both end faces: nothing where the bodies go on
beyond the contact, all of it where both end with it."""

UNEVEN: Final = 1e-9
"""Largest difference of spacings of a uniform grid, over the spacing."""

LARGEST_FACTOR: Final = 11
"""Largest prime factor of a length for which transforms have a way of their own: with 514 = 2 x 257 they
take five times as long as with 528."""

EVEN: Final = 1e-14
"""Largest difference of symmetric edges from their images, over their length."""

_Cells: TypeAlias = NDArray[np.float64]


class HalfSpace(eqx.Module):
    """Two half spaces on a grid, and what pressure that is constant on each cell deflects.

    Lengths are in any unit that is the same for all of them; [m] stands for it below. Fields have the
    shape (y, x).

    Attributes:
        x: of the cells' middles, in uniform steps, shape (x,) [m].
        edges: of the cells across x, shape (y + 1,) [m].
        spectrum: deflection times E' by a pressure of one on a row of cells, at another row, by wave along
            x, shape (1, wave, y, y): the loaded row comes first; real, as the deflection is even in x. Edges
            that are symmetric about their middle need half the numbers: sums and differences of both sides
            do not mix, shape (2, wave, half, half) [m].
        own: the same of every row on itself, shape (y, wave) [m].
        rows: deflection times E' at a row by a pressure of one on the cell of the same row that lies 0, 1, 2,
            ... steps of x away, shape (y, x) [m].

    Source: Love (1929), pressure that is even over a rectangle.
    """

    x: Float[Arrays, " x"]
    edges: Float[Arrays, " edge"]
    spectrum: Float[Arrays, "part wave half half"]
    own: Float[Arrays, "y wave"]
    rows: Float[Arrays, "y x"]

    @property
    def y(self) -> Float[Arrays, " y"]:
        """Middles of the cells, shape (y,) [m]."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def areas(self) -> Float[Arrays, " y"]:
        """Area of a cell of each row, shape (y,) [m^2]."""
        return (self.edges[1:] - self.edges[:-1]) * (self.x[-1] - self.x[0]) / (len(self.x) - 1)

    def load(self, pressure: Float[Arrays, "y x"]) -> Float[Array, ""]:
        """Normal load of a pressure [N]."""
        return jnp.asarray(self.areas) @ jnp.sum(pressure, axis=1)

    def deflection(self, pressure: Float[Arrays, "y x"], modulus: Numbers) -> Float[Array, "y x"]:
        """Normal deflection of both bodies together in the middle of every cell, shape (y, x) [m].

        Args:
            pressure: on the cells, shape (y, x) [Pa].
            modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members.

        u = 2/(pi E') int p/r dA. Source: Johnson, Contact Mechanics (1985), eqs. 3.22 and 3.25 (Love 1929).
        """
        nodes, period = pressure.shape[1], 2 * (self.own.shape[1] - 1)
        waves = jnp.fft.rfft(pressure, n=period, axis=1).T
        # Both parts at once, as rows: so every matrix is read once and in the order in which it lies.
        loads = self._apart(jnp.stack([waves.real, waves.imag], axis=1))
        deflected = self._together(jnp.einsum("pkcj,pkji->pkci", loads, self.spectrum))
        back = jnp.fft.irfft((deflected[:, 0] + 1j * deflected[:, 1]).T, n=period, axis=1)
        return back[:, :nodes] / modulus

    def _apart(self, field: Float[Array, "wave 2 y"]) -> Float[Array, "part wave 2 half"]:
        """Sums and differences of rows that are images of each other, where the edges are symmetric."""
        if self.spectrum.shape[0] == 1:
            return field[None]
        half = self.spectrum.shape[-1]
        side, image = field[..., :half], field[..., ::-1][..., :half]
        return jnp.stack([side + image, side - image])

    def _together(self, field: Float[Array, "part wave 2 half"]) -> Float[Array, "wave 2 y"]:
        """All rows from those parts."""
        if self.spectrum.shape[0] == 1:
            return field[0]
        images = len(self.edges) - 1 - field.shape[-1]
        side, image = field[0] + field[1], field[0] - field[1]
        return jnp.concatenate([side, image[..., :images][..., ::-1]], axis=-1)

    def lines(self) -> Float[Arrays, "y x x"]:
        """Deflection times E' in a row by a pressure of one on each of its own cells, shape (y, x, x) [m]."""
        steps = np.arange(self.rows.shape[1])
        return self.rows[:, np.abs(steps[:, None] - steps)]


def half_space(
    x: NDArray[np.float64], edges: NDArray[np.float64], ends: str = "half_space"
) -> HalfSpace:
    """Two half spaces on a grid.

    Args:
        x: of the cells' middles, in uniform steps, shape (x,) [m].
        edges: of the cells across x, of any widths, shape (y + 1,) [m].
        ends: "half_space" where both bodies go on beyond the first and the last edge; "mirrored" where both
            end there with free faces: the pressure mirrored at each face takes the shear stress, not the
            normal one, from that face, and the pressure of flush ends falls.

    Raises:
        InputError: x not in uniform steps, edges that do not rise, fewer than three cells either way, other
            ends.

    Example: the deflection in the middle of a square of 1 mm under 1 MPa, and 5 mm beside it.

        >>> import numpy as np
        >>> from pitchpoint.contact.half_space import half_space
        >>> x = np.linspace(-5e-3, 5e-3, 11)
        >>> bodies = half_space(x, np.linspace(-5.5e-3, 5.5e-3, 12))
        >>> pressure = np.zeros((11, 11))
        >>> pressure[5, 5] = 1e6
        >>> deflection = bodies.deflection(pressure, 226.4e9)
        >>> round(float(deflection[5, 5]) * 1e9, 3), round(float(deflection[5, 10]) * 1e9, 3)
        (9.913, 0.563)

    Source: Love (1929), pressure that is even over a rectangle.
    """
    _check(x, edges, ends)
    middles = 0.5 * (edges[1:] + edges[:-1])
    even = np.allclose(edges + edges[::-1], edges[0] + edges[-1], 0.0, EVEN * np.ptp(edges))
    targets = middles[: (len(middles) + 1) // 2] if even else middles
    away = (np.arange(_period(len(x)) // 2 + 1) + 0.5) * (x[-1] - x[0]) / (len(x) - 1)
    cells = _deflections(away, targets, edges)
    if share := ENDS[ends]:
        cells += share * sum(
            _mirrored(away, targets, edges, face) for face in (edges[0], edges[-1])
        )
    rows = np.diagonal(cells, axis1=1, axis2=2)
    rows = np.concatenate((rows, rows[:, : len(middles) - len(targets)][:, ::-1]), axis=1)
    parts = np.stack([_spectrum(part) for part in _parts(cells)])
    row_spectrum, near = (
        np.ascontiguousarray(kernel.T) for kernel in (_spectrum(rows), rows[: len(x)])
    )
    fields: Any = x, edges, parts, row_spectrum, near
    return HalfSpace(*fields)


def graded_edges(length: float, cells: int, end: float) -> NDArray[np.float64]:
    """Edges of cells that grow from both ends of a line to its middle by one ratio, shape (cells + 1,) [m].

    Args:
        length: of the line, whose middle is at zero [m].
        cells: an even number of them.
        end: width of the first and of the last one [m], less than that of uniform ones.

    Raises:
        InputError: an odd number of cells, or end cells that leave nothing to grow.

    Example:
        >>> graded_edges(14.0, 6, 1.0).round(9).tolist()
        [-7.0, -6.0, -4.0, 0.0, 4.0, 6.0, 7.0]
    """
    half = cells // 2
    if cells % 2 or half < 2 or not 0.0 < end < length / cells * (1.0 - UNEVEN):
        raise InputError(
            f"{cells} cells on a line {length:.4g} m long with end cells of {end:.4g} m: take an even number "
            "of at least 4, and end cells narrower than those of a uniform grid"
        )
    ratio = _ratio(half, 0.5 * length / end)
    inwards = end * np.concatenate(([0.0], np.cumsum(ratio ** np.arange(half))))
    outwards = 0.5 * length - inwards[:-1]
    return np.concatenate((-outwards, [0.0], outwards[::-1]))


def _ratio(terms: int, total: float) -> float:
    """Ratio of a geometric series that begins with one and has that sum."""
    low, high = 1.0, float(total ** (1.0 / (terms - 1)))
    for _ in range(200):
        middle = 0.5 * (low + high)
        less = np.sum(middle ** np.arange(terms)) < total
        low, high = (middle, high) if less else (low, middle)
    return high


def _period(nodes: int) -> int:
    """Length of a cyclic convolution in which nothing comes round: even, and quick to transform."""
    length = 2 * nodes
    while max(_factors(length)) > LARGEST_FACTOR:
        length += 2
    return length


def _factors(number: int) -> list[int]:
    """Prime factors of a number above one."""
    for factor in range(2, isqrt(number) + 1):
        if number % factor == 0:
            return [factor, *_factors(number // factor)]
    return [number]


def _deflections(away: _Cells, targets: _Cells, loaded: _Cells) -> NDArray[np.float64]:
    """Deflection times E' by cells 0, 1, ... steps of x away, shape (step, cell, y).

    Args:
        away: 0.5, 1.5, ... steps of x.
        targets: places y where it is asked for.
        loaded: edges of the loaded cells.
    """
    distance = targets - loaded[:, None]
    corner = _corner(away[:, None, None], distance)
    strip = corner[:, :-1] - corner[:, 1:]
    return 2.0 / np.pi * np.concatenate((2.0 * strip[:1], np.diff(strip, axis=0)))


def _corner(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integral of 1/r over the rectangle between the point and (x, y), x positive; odd in y."""
    across = np.abs(y)
    distance = np.sqrt(x**2 + across**2)
    beside = np.where(across == 0.0, 1.0, across)
    one_way = x * np.log((across + distance) / x) + across * np.log((x + distance) / beside)
    integral: NDArray[np.float64] = np.sign(y) * one_way
    return integral


def _mirrored(
    away: _Cells, targets: _Cells, edges: _Cells, face: np.float64
) -> NDArray[np.float64]:
    """Deflection times E' by the cells mirrored at a face, in their own order."""
    return _deflections(away, targets, (2.0 * face - edges)[::-1])[:, ::-1]


def _parts(cells: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """What sums and differences of images deflect, where it is asked for on one side alone; else all."""
    loaded, half = cells.shape[1:]
    if loaded == half:
        return [cells]
    side, image = cells[:, :half], cells[:, ::-1][:, :half]
    total = 0.5 * (side + image)
    if loaded % 2:
        total[:, -1] *= 0.5  # the middle row is its own image, and twice in a sum
    return [total, 0.5 * (side - image)]


def _spectrum(cells: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cosine transform of the even, periodic continuation along the first axis."""
    steps = len(cells) - 1
    number = np.arange(steps + 1)
    weight = np.where((number == 0) | (number == steps), 1.0, 2.0)
    cosine = np.cos(np.pi * (np.outer(number, number) % (2 * steps)) / steps) * weight
    spectrum: NDArray[np.float64] = (cosine @ cells.reshape(steps + 1, -1)).reshape(cells.shape)
    return spectrum


def _check(x: NDArray[np.float64], edges: NDArray[np.float64], ends: str) -> None:
    if ends not in ENDS:
        raise InputError(f'there are no ends "{ends}"', key="ends", allowed=ENDS)
    if x.ndim != 1 or edges.ndim != 1 or len(x) < 3 or len(edges) < 4:
        raise InputError(
            "a grid needs at least three cells each way, along x and between the edges"
        )
    steps, widths = np.diff(x), np.diff(edges)
    # Written so that NaN fails.
    if not (steps[0] > 0.0 and np.all(np.abs(steps - steps.mean()) < UNEVEN * steps.mean())):
        raise InputError("the places x of a grid have to rise in uniform steps", key="x")
    if not np.all(widths > 0.0):
        raise InputError("the edges of the cells of a grid have to rise", key="edges")
