"""What the surfaces of a contact do to its film: room for oil, resistance to its flow, load on asperities."""

import abc
from typing import Final

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.asperities import (
    ETA_BETA_SIGMA,
    SIGMA_OVER_BETA,
    greenwood_tripp_stiffness,
    greenwood_williamson_1966,
    hu_1994,
)
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.ehl_registry import ASPERITIES, USUAL_ASPERITIES
from pitchpoint.lubrication.flow_factors import mean_gap, patir_cheng_1978
from pitchpoint.materials._leaves import float64_array

__all__ = ["Rough", "Smooth", "Texture"]

Each = Float[Numbers, "*#b"]


BOUNDARY_FRICTION: Final = 0.1
"""Usual coefficient of friction of steel asperities with oil between them: assumed, of 0.08 to 0.15."""


PATTERNS: Final = (1.0 / 9.0, 9.0)
"""Patterns of roughness of which flow factors are known."""

NARROW: Final = 1.0 / 3.0
"""Part of Rq about which the gap for flow under pressure goes over into one that stays positive."""


class Texture(eqx.Module):
    """Surfaces as seen across a gap between their mean planes, which may overlap."""

    @property
    @abc.abstractmethod
    def rq(self) -> Float[Arrays, "..."]:
        """Composite Rq of both surfaces [m]."""

    @property
    @abc.abstractmethod
    def boundary_friction(self) -> Float[Arrays, "..."]:
        """Coefficient of friction of asperities that touch [1]."""

    @abc.abstractmethod
    def pressure(self, gap: Each) -> Each:
        """Pressure that asperities carry [Pa]."""

    @abc.abstractmethod
    def room(self, gap: Each) -> Each:
        """Mean gap that is open to the oil, positive [m]."""

    @abc.abstractmethod
    def flow_factor(self, gap: Each) -> Each:
        """Flow along the pressure gradient over that between smooth surfaces with this room."""


class Smooth(Texture):
    """Smooth surfaces.

    Attributes:
        least: gap below which a trial counts as a smaller and smaller positive one [m]; no solution has it.
    """

    least: Float[Arrays, "..."]

    @property
    def rq(self) -> Float[Arrays, "..."]:
        """Composite Rq of both surfaces [m]."""
        return jnp.zeros_like(self.least)

    @property
    def boundary_friction(self) -> Float[Arrays, "..."]:
        """Coefficient of friction of asperities that touch [1]."""
        return jnp.zeros_like(self.least)

    def pressure(self, gap: Each) -> Each:
        """Pressure that asperities carry [Pa]."""
        return jnp.zeros_like(gap)

    def room(self, gap: Each) -> Each:
        """Mean gap that is open to the oil, positive [m]."""
        tight = jnp.minimum(gap / self.least, 1.0)
        return jnp.where(tight < 1.0, self.least * jnp.exp(tight - 1.0), gap)

    def flow_factor(self, gap: Each) -> Each:
        """Flow along the pressure gradient over that between smooth surfaces with this room."""
        return jnp.ones_like(gap)


def fitted_pressure(
    *, gap: Each, roughness_rq: Each, modulus: Each, eta_beta_sigma: Each, sigma_over_beta: Each
) -> Array:
    """Greenwood and Tripp's pressure with the usual fit of its integral [Pa].

    Source: Greenwood and Tripp (1970); fit of Hu et al. (1994).
    """
    stiff = greenwood_tripp_stiffness(modulus, eta_beta_sigma, sigma_over_beta)
    pressure: Array = stiff * hu_1994(ratio=gap / roughness_rq)
    return pressure


def one_rough_side(
    *, gap: Each, roughness_rq: Each, modulus: Each, eta_beta_sigma: Each, sigma_over_beta: Each
) -> Array:
    """Greenwood and Williamson's pressure with summits as high as the composite roughness [Pa].

    Source: Greenwood and Williamson (1966).
    """
    summit = roughness_rq / sigma_over_beta
    pressure: Array = greenwood_williamson_1966(
        gap=gap,
        deviation=roughness_rq,
        radius=summit,
        density=eta_beta_sigma / (summit * roughness_rq),
        modulus=modulus,
    )
    return pressure


class Rough(Texture):
    """Rough surfaces whose asperities are elastic.

    Args:
        rq: composite Rq of both surfaces, positive, shape (...) [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.
        eta_beta_sigma: summits per area times their radius times Rq, shape (...) [1].
        sigma_over_beta: Rq over the radius of the summits, shape (...) [1].
        asperities: name in `ASPERITIES`; static.
        pattern: Peklenik's gamma, length of asperities along the flow over that across it, 1/9 to 9; static.
        boundary_friction: coefficient of friction of asperities that touch, shape (...) [1].

    Surfaces draw along the mean room of Gaussian heights; under pressure oil flows as through the gap of the
    mean planes times the flow factor of Patir and Cheng (1978). Where that gap comes near Rq it goes over
    into one that stays positive, which is a choice and adds 6 % to the flow at half of Rq, .2 % at Rq. Flow
    that sliding carries in the valleys is left out: it is none where both sides are equally rough.

    Raises:
        InputError: there is no law of this name, or no flow factor of this pattern.
    """

    deviation: Float[Arrays, "..."]
    modulus: Float[Arrays, "..."]
    eta_beta_sigma: Float[Arrays, "..."]
    sigma_over_beta: Float[Arrays, "..."]
    friction: Float[Arrays, "..."]
    asperities: str = eqx.field(static=True)
    pattern: float = eqx.field(static=True)

    def __init__(
        self,
        *,
        rq: ArrayLike,
        modulus: ArrayLike,
        eta_beta_sigma: ArrayLike = ETA_BETA_SIGMA,
        sigma_over_beta: ArrayLike = SIGMA_OVER_BETA,
        asperities: str = USUAL_ASPERITIES,
        pattern: float = 1.0,
        boundary_friction: ArrayLike = BOUNDARY_FRICTION,
    ) -> None:
        self.deviation, self.modulus = float64_array(rq), float64_array(modulus)
        self.eta_beta_sigma = float64_array(eta_beta_sigma)
        self.sigma_over_beta = float64_array(sigma_over_beta)
        self.friction = float64_array(boundary_friction)
        self.asperities, self.pattern = ASPERITIES[asperities].name, float(pattern)
        if not PATTERNS[0] <= self.pattern <= PATTERNS[1]:
            raise InputError(
                f"a pattern of {pattern:.4g}: it must be between 1/9 and 9", key="pattern"
            )

    @property
    def rq(self) -> Float[Arrays, "..."]:
        """Composite Rq of both surfaces [m]."""
        return self.deviation

    @property
    def boundary_friction(self) -> Float[Arrays, "..."]:
        """Coefficient of friction of asperities that touch [1]."""
        return self.friction

    def pressure(self, gap: Each) -> Each:
        """Pressure that asperities carry [Pa]."""
        return ASPERITIES[self.asperities].function(
            gap=gap,
            roughness_rq=self.rq,
            modulus=self.modulus,
            eta_beta_sigma=self.eta_beta_sigma,
            sigma_over_beta=self.sigma_over_beta,
        )

    def room(self, gap: Each) -> Each:
        """Mean gap that is open to the oil, positive [m]."""
        # A trial may sink deep; what is left is far less than oil could flow through.
        return jnp.maximum(mean_gap(gap=gap, roughness_rq=self.rq), 1e-9 * self.rq)

    def flow_factor(self, gap: Each) -> Each:
        """Flow along the pressure gradient over that between smooth surfaces with this room."""
        factor = patir_cheng_1978(ratio=gap / self.rq, pattern=self.pattern)
        # The factor belongs to the cube of the gap itself, which is not positive where mean planes overlap.
        nominal = mean_gap(gap=gap, roughness_rq=self.rq * NARROW)
        return jnp.maximum(factor * (nominal / self.room(gap)) ** 3, 1e-9)
