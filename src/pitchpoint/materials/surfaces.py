"""Roughness of the two flanks of a contact."""

from __future__ import annotations

import math

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.input.remembered import remembering
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.material_tables import RoughnessTable

__all__ = ["RQ_PER_RA", "Roughness", "composite_rq", "mean_ra", "roughness_of"]

RQ_PER_RA = math.sqrt(math.pi / 2.0)
"""Rq/Ra of Gaussian heights: the mean of |z| is sigma sqrt(2/pi). The textbook 1.25 rounds it."""


def mean_ra(*, ra_1: ArrayLike, ra_2: ArrayLike) -> Float[Array, "..."]:
    """Return the arithmetic mean (Ra1 + Ra2)/2, the roughness of ISO/TR 14179-2.

    Args:
        ra_1: mean deviation of the first flank, shape (...) [m].
        ra_2: mean deviation of the second flank, shape (...) [m].

    Returns:
        The mean, shape (...) [m].
    """
    return 0.5 * (jnp.asarray(ra_1) + jnp.asarray(ra_2))


def composite_rq(*, rq_1: ArrayLike, rq_2: ArrayLike) -> Float[Array, "..."]:
    """Return the composite height sqrt(Rq1^2 + Rq2^2) of two independent surfaces.

    Args:
        rq_1: root-mean-square deviation of the first flank, shape (...) [m].
        rq_2: root-mean-square deviation of the second flank, shape (...) [m].

    Returns:
        The root-mean-square deviation of the gap, shape (...) [m]; its gradient is finite (zero)
        where both flanks are smooth.

    From the variances of independent heights, which add up.
    """
    squares = jnp.asarray(rq_1) ** 2 + jnp.asarray(rq_2) ** 2
    rough = squares > 0.0
    return jnp.where(rough, jnp.sqrt(jnp.where(rough, squares, 1.0)), 0.0)


class Roughness(eqx.Module):
    """Roughness of both flanks: Ra and Rq side by side, since laws differ in which they use.

    Build it with `from_ra`, `from_rq` or `from_composite_rq` when only one of them is known: they
    take the heights as Gaussian, Rq = sqrt(pi/2) Ra = 1.2533 Ra. A ground or run-in flank is not
    exactly Gaussian, so give both where both were measured.

    Args:
        ra_1: mean deviation of the first flank, shape (...) [m].
        ra_2: mean deviation of the second flank, shape (...) [m].
        rq_1: root-mean-square deviation of the first flank, shape (...) [m].
        rq_2: root-mean-square deviation of the second flank, shape (...) [m].

    From the mean deviation of Gaussian heights.
    """

    ra_1: Float[Array, "..."]
    ra_2: Float[Array, "..."]
    rq_1: Float[Array, "..."]
    rq_2: Float[Array, "..."]

    def __init__(
        self, *, ra_1: ArrayLike, ra_2: ArrayLike, rq_1: ArrayLike, rq_2: ArrayLike
    ) -> None:
        self.ra_1, self.ra_2 = float64_array(ra_1), float64_array(ra_2)
        self.rq_1, self.rq_2 = float64_array(rq_1), float64_array(rq_2)

    @classmethod
    def from_ra(cls, ra_1: ArrayLike, ra_2: ArrayLike | None = None) -> Roughness:
        """Build from Ra [m] of one flank, taken for both, or of each.

        From heights that are Gaussian, see `RQ_PER_RA`.

        Example:
            >>> from pitchpoint.materials.surfaces import Roughness
            >>> round(float(Roughness.from_ra(0.8e-6).composite_rq) * 1e6, 4)
            1.418
        """
        second = ra_1 if ra_2 is None else ra_2
        return cls(ra_1=ra_1, ra_2=second, rq_1=RQ_PER_RA * ra_1, rq_2=RQ_PER_RA * second)

    @classmethod
    def from_rq(cls, rq_1: ArrayLike, rq_2: ArrayLike | None = None) -> Roughness:
        """Build from Rq [m] of one flank, taken for both, or of each.

        From heights that are Gaussian, see `RQ_PER_RA`.
        """
        rq_of_flank = float64_array(rq_1)
        rq_of_mate = rq_of_flank if rq_2 is None else float64_array(rq_2)
        return cls(
            ra_1=rq_of_flank / RQ_PER_RA,
            ra_2=rq_of_mate / RQ_PER_RA,
            rq_1=rq_of_flank,
            rq_2=rq_of_mate,
        )

    @classmethod
    def from_composite_rq(cls, rq: ArrayLike) -> Roughness:
        """Build from the composite Rq [m] of the pair, shared equally by the two flanks."""
        return cls.from_rq(float64_array(rq) / math.sqrt(2.0))

    @property
    def mean_ra(self) -> Float[Array, "..."]:
        """The mean of Ra over the two flanks, shape (...) [m]."""
        return mean_ra(ra_1=self.ra_1, ra_2=self.ra_2)

    @property
    def composite_rq(self) -> Float[Array, "..."]:
        """The composite Rq of the pair, shape (...) [m]."""
        return composite_rq(rq_1=self.rq_1, rq_2=self.rq_2)


@remembering
def roughness_of(surface: RoughnessTable) -> Roughness:
    """Roughness of both flanks that a case has; what it leaves open follows for Gaussian heights."""
    if surface.ra is not None and surface.rq is not None:
        (ra_1, ra_2), (rq_1, rq_2) = surface.ra, surface.rq
        return Roughness(ra_1=ra_1, ra_2=ra_2, rq_1=rq_1, rq_2=rq_2)
    if surface.ra is not None:
        return Roughness.from_ra(*surface.ra)
    if surface.rq is not None:
        return Roughness.from_rq(*surface.rq)
    assert surface.composite_rq is not None
    return Roughness.from_composite_rq(surface.composite_rq)
