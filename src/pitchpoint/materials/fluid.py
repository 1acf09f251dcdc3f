"""An oil in a contact: its values at the inlet with the laws that carry them to pressure and heat."""

from __future__ import annotations

from collections.abc import Mapping

import equinox as eqx
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint.core.factored import Numbers
from pitchpoint.errors import InputError, shorten
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.lubricants import Lubricant
from pitchpoint.materials.materials_registry import (
    DENSITY,
    SHEAR_STRESS,
    USUAL_DENSITY,
    USUAL_SHEAR_STRESS,
    USUAL_VISCOSITY,
    VISCOSITY,
    RheologyLaw,
)
from pitchpoint.materials.rheology import roelands_index
from pitchpoint.registry import nearest

__all__ = ["Fluid"]

Each = Float[Numbers, "*#b"]


class Fluid(eqx.Module):
    """An oil at one temperature, or at one for each contact, ready for a solver of films.

    Args:
        viscosity: eta0 at ambient pressure and `temperature`, shape (...) [Pa s].
        pressure_viscosity: alpha there, shape (...) [1/Pa].
        viscosity_slope: -d ln eta0/dT there, shape (...) [1/K].
        temperature: of the oil in the inlet, shape (...) [K].
        density: at ambient pressure and `temperature`, shape (...) [kg/m3].
        viscosity_law: name in `VISCOSITY`; static.
        density_law: name in `DENSITY`; static.
        shear_law: name in `SHEAR_STRESS`; static.
        shear_parameters: those of the shear law that differ from its defaults, by name [SI].
        pressure_parameters: likewise of the laws of viscosity and density.

    Raises:
        InputError: there is no law of a name, or no parameter of one; the message has the nearest ones.

    Example:
        >>> oil = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8)
        >>> float(oil.viscosity_at(0.0)), round(float(oil.density_ratio(1e9)), 3)
        (0.04, 1.222)
    """

    viscosity: Float[Array, "..."]
    pressure_viscosity: Float[Array, "..."]
    viscosity_slope: Float[Array, "..."]
    temperature: Float[Array, "..."]
    density: Float[Array, "..."]
    shear_parameters: dict[str, Float[Array, "..."]]
    pressure_parameters: dict[str, Float[Array, "..."]]
    viscosity_law: str = eqx.field(static=True)
    density_law: str = eqx.field(static=True)
    shear_law: str = eqx.field(static=True)

    def __init__(
        self,
        *,
        viscosity: ArrayLike,
        pressure_viscosity: ArrayLike,
        viscosity_slope: ArrayLike = 0.0,
        temperature: ArrayLike = 313.15,
        density: ArrayLike = 870.0,
        viscosity_law: str = USUAL_VISCOSITY,
        density_law: str = USUAL_DENSITY,
        shear_law: str = USUAL_SHEAR_STRESS,
        shear_parameters: Mapping[str, ArrayLike] | None = None,
        pressure_parameters: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        self.viscosity, self.density = float64_array(viscosity), float64_array(density)
        self.pressure_viscosity = float64_array(pressure_viscosity)
        self.viscosity_slope = float64_array(viscosity_slope)
        self.temperature = float64_array(temperature)
        self.viscosity_law = VISCOSITY[viscosity_law].name
        self.density_law = DENSITY[density_law].name
        self.shear_law = SHEAR_STRESS[shear_law].name
        self.shear_parameters = _own(shear_parameters or {}, SHEAR_STRESS[shear_law])
        self.pressure_parameters = _own(pressure_parameters or {}, *self._under_pressure)

    @classmethod
    def of(
        cls,
        oil: Lubricant,
        temperature: ArrayLike,
        *,
        viscosity_law: str = USUAL_VISCOSITY,
        density_law: str = USUAL_DENSITY,
        shear_law: str = USUAL_SHEAR_STRESS,
        shear_parameters: Mapping[str, ArrayLike] | None = None,
        viscosity_parameters: Mapping[str, ArrayLike] | None = None,
    ) -> Fluid:
        """An oil of the catalogue, or one by value, at a temperature.

        Args:
            oil: ready for a computation.
            temperature: of the inlet, shape (...) [K].
            viscosity_law: name in `VISCOSITY`.
            density_law: name in `DENSITY`.
            shear_law: name in `SHEAR_STRESS`.
            shear_parameters: those of the shear law that differ from its defaults, by name [SI].
            viscosity_parameters: those of the law of viscosity, likewise, before what is known of the oil.
        """
        return cls(
            viscosity=oil.viscosity(temperature),
            pressure_viscosity=oil.pressure_viscosity(temperature),
            viscosity_slope=oil.viscosity_slope(temperature),
            temperature=temperature,
            density=oil.density(temperature),
            viscosity_law=viscosity_law,
            density_law=density_law,
            shear_law=shear_law,
            shear_parameters=shear_parameters,
            pressure_parameters={
                **_volume(oil, temperature, viscosity_law, density_law),
                **(viscosity_parameters or {}),
            },
        )

    @property
    def _under_pressure(self) -> tuple[RheologyLaw, RheologyLaw]:
        """Laws of viscosity and density."""
        return VISCOSITY[self.viscosity_law], DENSITY[self.density_law]

    def viscosity_at(self, pressure: Each, temperature_rise: Each | float = 0.0) -> Each:
        """Viscosity under pressure [Pa s].

        Args:
            pressure: above ambient [Pa].
            temperature_rise: above `temperature` [K].
        """
        law, _ = self._under_pressure
        return law.function(
            pressure=pressure,
            temperature_rise=temperature_rise,
            viscosity=self.viscosity,
            pressure_viscosity=self.pressure_viscosity,
            temperature=self.temperature,
            viscosity_slope=self.viscosity_slope,
            **_known_to(law, self.pressure_parameters),
        )

    def density_ratio(self, pressure: Each, temperature_rise: Each | float = 0.0) -> Each:
        """Density over that at ambient pressure and `temperature` [1].

        Args:
            pressure: above ambient [Pa].
            temperature_rise: above `temperature` [K].
        """
        _, law = self._under_pressure
        return law.function(
            pressure=pressure,
            temperature_rise=temperature_rise,
            **_known_to(law, self.pressure_parameters),
        )

    def shear_stress(
        self, shear_rate: Each, pressure: Each, temperature_rise: Each | float = 0.0
    ) -> Each:
        """Shear stress, with the sign of the shear rate [Pa].

        Args:
            shear_rate: [1/s].
            pressure: above ambient [Pa].
            temperature_rise: above `temperature` [K].
        """
        return SHEAR_STRESS[self.shear_law].function(
            viscosity=self.viscosity_at(pressure, temperature_rise),
            shear_rate=shear_rate,
            pressure=pressure,
            temperature_rise=temperature_rise,
            **self.shear_parameters,
        )

    @property
    def index(self) -> Each:
        """Pressure-viscosity index Z of Roelands, shape (...) [1]."""
        return roelands_index(viscosity=self.viscosity, pressure_viscosity=self.pressure_viscosity)

    @property
    def assumed(self) -> str | None:
        """None unless a law rests on what is not known of this oil, else that, without its stop.

        Example:
            >>> Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, density_law="tait_1888").assumed
            "the volume of this oil is not known: 'tait_1888' takes constants between those of a few others"
        """
        oil_constants = {*self.pressure_parameters}
        lacking: dict[tuple[str, str], list[str]] = {}
        for law in self._under_pressure:
            if law.parameters.keys() - oil_constants:
                lacking.setdefault(law.unknown, []).append(f"'{law.name}'")
        sentences = [
            f"{what}: {' and '.join(names)} {'takes' if len(names) == 1 else 'take'} {taken}"
            for (what, taken), names in lacking.items()
        ]
        return "; ".join(sentences) or None

    def outside(self, pressure: ArrayLike) -> str | None:
        """None if the laws hold up to a pressure, else why not, in one sentence without its stop.

        Args:
            pressure: largest of each contact, shape (...) [Pa]; values and no tracers.

        Example:
            >>> Fluid(viscosity=0.04, pressure_viscosity=2.2e-8).outside(1.6e9)
            "a pressure of 1.6 GPa is outside the range of 'roelands_1966', up to 1 GPa"
        """
        values = {"pressure": pressure, "index": np.asarray(self.index)}
        sentences = (law.outside(**values) for law in self._under_pressure)
        return next((sentence for sentence in sentences if sentence is not None), None)


def _own(given: Mapping[str, ArrayLike], *laws: RheologyLaw) -> dict[str, Float[Array, "..."]]:
    """Parameters of laws as arrays."""
    law_parameters = [*dict.fromkeys(name for law in laws for name in law.parameters)]
    for name in given.keys() - {*law_parameters}:
        what = " or ".join(f"'{law.name}'" for law in laws)
        raise InputError(
            f"'{shorten(name)}' is no parameter of {what}{nearest(name, law_parameters)}"
        )
    return {name: float64_array(value) for name, value in given.items()}


def _known_to(law: RheologyLaw, values: Mapping[str, Array]) -> dict[str, Array]:
    """Those of some parameters that a law has."""
    return {name: values[name] for name in law.parameters if name in values}


def _volume(
    oil: Lubricant, temperature: ArrayLike, viscosity_law: str, density_law: str
) -> dict[str, Array]:
    """Free volume and equation of state of an oil at a temperature, as far as laws ask for them."""
    if oil.free_volume is None:
        return {}
    volume_constants = oil.free_volume.parameters(temperature)
    laws = VISCOSITY[viscosity_law], DENSITY[density_law]
    return {
        name: constant
        for law in laws
        for name, constant in _known_to(law, volume_constants).items()
    }
