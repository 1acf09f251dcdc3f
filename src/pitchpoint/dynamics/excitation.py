"""What excites a mesh: stiffness, arm and profile error of every pair over one mesh period."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.gears.period import lobatto
from pitchpoint.materials._leaves import float64_array

__all__ = ["ErrorOrders", "Excitation", "ExcitationCourse"]

Pairs = Float[Array, "pair element node"]


class Excitation(eqx.Module):
    """Pairs of teeth as springs that come and go, one period of the mesh.

    Attributes:
        edges: phases [periods] between which everything is smooth; the last is the first plus one.
            Segments without length do no harm.
        stiffness: of each pair along its normal, zero out of contact [N/m]; at Gauss-Lobatto nodes of
            each segment, whose ends lie just inside it.
        arm: closing of each contact along its normal per unit of each coordinate [1 or m/rad].
        error: composite profile error, separation of the unloaded flanks [m].
    """

    edges: Float[Array, " edge"]
    stiffness: Float[Array, "pair segment node"]
    arm: Float[Array, "coordinate pair segment node"]
    error: Float[Array, "pair segment node"]

    def on(self, grid: PeriodGrid) -> "ExcitationCourse":
        """The same at the nodes of a grid.

        From the Legendre series through the nodes of each segment.
        """
        bounds = grid.bounds(self.edges)
        start, length = self.edges[:-1], jnp.diff(self.edges)
        middle = (bounds[1:] + bounds[:-1]) / 2.0
        last_segment = jnp.max(jnp.where(length > 0.0, jnp.arange(length.shape[0]), 0))
        segment = jnp.clip(jnp.searchsorted(self.edges, middle, side="right") - 1, 0, last_segment)
        phase = bounds[:-1, None] + jnp.diff(bounds)[:, None] * grid.place
        span = length[segment][:, None]
        place = (phase - start[segment][:, None]) / jnp.where(span > 0.0, span, 1.0)
        basis = _legendre(jnp.clip(place, 0.0, 1.0), self.stiffness.shape[-1])

        def read(values: Float[Array, "*b segment node"]) -> Float[Array, "*b element place"]:
            modes = values @ _modes(values.shape[-1])
            return jnp.einsum("...em,epm->...ep", modes[..., segment, :], basis)

        return ExcitationCourse(
            bounds, phase, read(self.stiffness), read(self.arm), read(self.error), grid
        )


class ErrorOrders(eqx.Module):
    """An error as a sum of orders: sum of A cos(2 pi order phase + angle).

    Of a mesh the phase is that of the mesh and an error parts the flanks, of a joint the phase counts turns
    of the driver and the output lags.

    Attributes:
        amplitude: of each order [m or rad].
        order: in a unit of the phase, whole or not.
        angle: of each order at phase zero [rad].
    """

    amplitude: Float[Array, " order"] = eqx.field(converter=float64_array)
    order: Float[Array, " order"] = eqx.field(converter=float64_array)
    angle: Float[Array, " order"] = eqx.field(converter=float64_array)

    def at(self, phase: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Error at a phase, counted on beyond one [m or rad]."""
        return jnp.sum(self.amplitude * jnp.cos(self._angles(phase)), axis=-1)

    def slope(self, phase: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Its derivative by the phase [m or rad]."""
        slopes = -2.0 * jnp.pi * self.order * self.amplitude * jnp.sin(self._angles(phase))
        return jnp.sum(slopes, axis=-1)

    def _angles(self, phase: Float[Array, "*b"]) -> Float[Array, "*b order"]:
        return 2.0 * jnp.pi * self.order * phase[..., None] + self.angle


class ExcitationCourse(eqx.Module):
    """An excitation at the nodes of a grid.

    Attributes:
        bounds: phases between the elements [periods].
        phase: of the nodes [periods].
        stiffness, arm, error: as in `Excitation`.
        grid: static.
    """

    bounds: Float[Array, " bound"]
    phase: Float[Array, "element node"]
    stiffness: Pairs
    arm: Float[Array, "coordinate pair element node"]
    error: Pairs
    grid: PeriodGrid = eqx.field(static=True)

    @property
    def length(self) -> Float[Array, " element"]:
        """Length of each element [periods]."""
        return jnp.diff(self.bounds)

    def mean(self, values: Float[Array, "*b element node"]) -> Float[Array, "*b"]:
        """Mean over the period."""
        return jnp.sum(self.grid.integral(values) * self.length, axis=-1)


def _modes(count: int) -> np.ndarray:
    """Matrix from values at the nodes of a segment to Legendre coefficients."""
    vandermonde = np.polynomial.legendre.legvander(2.0 * lobatto(count)[0] - 1.0, count - 1)
    return np.linalg.inv(vandermonde).T


def _legendre(place: Float[Array, "*b"], count: int) -> Float[Array, "*b mode"]:
    """Legendre polynomials at places of [0, 1]."""
    x = 2.0 * place - 1.0

    def further(
        pair: tuple[Array, Array], degree: Float[Array, ""]
    ) -> tuple[tuple[Array, Array], Array]:
        before, current = pair
        following = ((2.0 * degree + 1.0) * x * current - degree * before) / (degree + 1.0)
        return (current, following), current

    _, rows = jax.lax.scan(further, (jnp.ones_like(x), x), jnp.arange(1.0, count))
    return jnp.moveaxis(jnp.concatenate([jnp.ones_like(x)[None], rows]), 0, -1)
