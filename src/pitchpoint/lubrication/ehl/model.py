"""Choices by which films of the contacts of a mesh are solved, and the contacts that they make."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from jax.typing import ArrayLike

from pitchpoint.contact.asperities import ETA_BETA_SIGMA, SIGMA_OVER_BETA
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL, SMOOTH, THERMAL, USUAL_ASPERITIES
from pitchpoint.lubrication.ehl.line import FLOODED, LineContact
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.solve import NODES
from pitchpoint.lubrication.ehl.texture import BOUNDARY_FRICTION, Rough
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials.fluid import Fluid
from pitchpoint.materials.lubricants import Lubricant
from pitchpoint.materials.materials_registry import (
    USUAL_DENSITY,
    USUAL_SHEAR_STRESS,
    USUAL_VISCOSITY,
)

__all__ = ["FilmModel"]

COLDEST: Final = -100.0
"""Temperature [degC] below which no oil flows, and degC may have been given for kelvin."""


@dataclass(frozen=True, kw_only=True)
class FilmModel:
    """How films are solved.

    Attributes:
        nodes: across a contact.
        viscosity_law: name in `VISCOSITY`.
        density_law: name in `DENSITY`.
        shear_law: name in `SHEAR_STRESS`.
        shear_parameters: those of the shear law that differ from its defaults, by name [SI].
        viscosity_parameters: those of the law of viscosity, likewise.
        asperities: name in `ASPERITIES`, or `SMOOTH`.
        eta_beta_sigma: summits per area times their radius times Rq.
        sigma_over_beta: Rq over the radius of the summits.
        pattern: Peklenik's gamma of the roughness.
        boundary_friction: coefficient of friction of asperities that touch.
        inlet: distance from the middle of a contact at which oil begins [m].
        thermal: name in `THERMAL`.
        members: what of both bodies decides about the temperature of their surfaces; an isothermal film
            needs none.
    """

    nodes: int = NODES
    viscosity_law: str = USUAL_VISCOSITY
    density_law: str = USUAL_DENSITY
    shear_law: str = USUAL_SHEAR_STRESS
    shear_parameters: Mapping[str, float] = field(default_factory=dict)
    viscosity_parameters: Mapping[str, float] = field(default_factory=dict)
    asperities: str = USUAL_ASPERITIES
    eta_beta_sigma: float = ETA_BETA_SIGMA
    sigma_over_beta: float = SIGMA_OVER_BETA
    pattern: float = 1.0
    boundary_friction: float = BOUNDARY_FRICTION
    inlet: float = FLOODED
    thermal: str = ISOTHERMAL
    members: tuple[Conductor, Conductor] | None = None

    def contacts(
        self,
        *,
        line_load: ArrayLike,
        radius: ArrayLike,
        modulus: ArrayLike,
        speed_a: ArrayLike,
        speed_b: ArrayLike,
        oil: Lubricant,
        temperature: ArrayLike,
        roughness_rq: ArrayLike,
        inlet: ArrayLike | None = None,
        heights: tuple[HeightMap, ...] = (),
    ) -> LineContact:
        """Contacts `*b` to solve, of arrays that broadcast against each other.

        Args:
            line_load: normal load per length of contact line [N/m].
            radius: relative radius of curvature [m].
            modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.
            speed_a: surface speed of member 0 relative to the contact [m/s].
            speed_b: surface speed of member 1 relative to the contact [m/s].
            oil: between them.
            temperature: of the oil in the inlet [K].
            roughness_rq: composite Rq [m]; zero for smooth surfaces.
            inlet: distance from the middle of a contact at which oil begins [m]; that of the model by
                default.
            heights: profiles of the surfaces.

        Raises:
            InputError: there is no thermal effect of this name, or it lacks what `members` tells.
        """
        return LineContact(
            line_load=line_load,
            radius=radius,
            modulus=modulus,
            speed_a=speed_a,
            speed_b=speed_b,
            fluid=self.fluid(oil, temperature),
            texture=self.texture(roughness_rq, modulus),
            inlet=self.inlet if inlet is None else inlet,
            conduction=self.conduction(oil),
            heights=heights,
        )

    def fluid(self, oil: Lubricant, temperature: ArrayLike) -> Fluid:
        """The oil in a contact, by the laws of the model.

        Args:
            oil: between the bodies.
            temperature: in the inlet [K].

        Raises:
            InputError: the oil is not known at this temperature.
        """
        _check_temperature(oil, temperature)
        return Fluid.of(
            oil,
            temperature,
            viscosity_law=self.viscosity_law,
            density_law=self.density_law,
            shear_law=self.shear_law,
            shear_parameters=self.shear_parameters,
            viscosity_parameters=self.viscosity_parameters,
        )

    def texture(self, roughness_rq: ArrayLike, modulus: ArrayLike) -> Rough | None:
        """The surfaces by the asperities of the model; None for smooth ones.

        Args:
            roughness_rq: composite Rq [m]; zero for smooth surfaces.
            modulus: E' [Pa].

        Raises:
            InputError: a roughness that no surface has, or rough contacts beside smooth ones.
        """
        _check_roughness(roughness_rq)
        smooth = self.asperities == SMOOTH or not np.any(np.asarray(roughness_rq) > 0.0)
        return None if smooth else self._rough(roughness_rq, modulus)

    def conduction(self, oil: Lubricant) -> Conduction | None:
        """What conducts the heat of contacts; None of an isothermal film.

        Args:
            oil: between the bodies.

        Raises:
            InputError: there is no thermal effect of this name, or it lacks what `members` tells.
        """
        if THERMAL[self.thermal].name == ISOTHERMAL:
            return None
        if self.members is None:
            raise InputError(
                f'thermal = "{self.thermal}" needs the conductivity and the heat capacity of both members',
                key="thermal",
            )
        a, b = self.members
        return Conduction(a=a, b=b, oil_conductivity=oil.conductivity)

    def _rough(self, rq: ArrayLike, modulus: ArrayLike) -> Rough:
        return Rough(
            rq=rq,
            modulus=modulus,
            eta_beta_sigma=self.eta_beta_sigma,
            sigma_over_beta=self.sigma_over_beta,
            asperities=self.asperities,
            pattern=self.pattern,
            boundary_friction=self.boundary_friction,
        )


def _check_temperature(oil: Lubricant, temperature: ArrayLike) -> None:
    """InputError for an oil too cold or too warm."""
    warm = np.asarray(temperature)
    if not np.all(np.asarray(oil.in_range(warm))):
        low, high = (float(np.min(np.asarray(limit))) - 273.15 for limit in (oil.T_min, oil.T_max))
        worst = warm.reshape(-1)[np.argmax(np.abs(warm - 0.5 * (oil.T_min + oil.T_max)))] - 273.15
        kelvin = "; temperatures are in kelvin" if worst < COLDEST else ""
        raise InputError(
            f"an oil at {worst:.4g} degC, whose values are meant for {low:.4g} to {high:.4g} degC{kelvin}",
            key="temperature",
        )


def _check_roughness(roughness_rq: ArrayLike) -> None:
    """InputError for roughness that no surface has."""
    rq = np.asarray(roughness_rq)
    if np.any(rq < 0.0):
        raise InputError(f"a composite roughness Rq of {1e6 * rq.min():.4g} um", key="roughness_rq")
    if np.any(rq == 0.0) and np.any(rq > 0.0):
        raise InputError(
            "some contacts are rough and some smooth; solve each kind by itself", key="roughness_rq"
        )
