"""What a case may choose by name of an oil under pressure: rival laws of viscosity, density, shear stress."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array

__all__ = [
    "DENSITY",
    "LEAST_PRESSURE",
    "SHEAR_STRESS",
    "USUAL_DENSITY",
    "USUAL_SHEAR_STRESS",
    "USUAL_VISCOSITY",
    "VISCOSITY",
    "RheologyLaw",
]

USUAL_VISCOSITY: Final = "roelands_1966"
USUAL_DENSITY: Final = "dowson_higginson_1966"
USUAL_SHEAR_STRESS: Final = "ree_eyring_1955"
"""Shear law unless another is chosen: a Newtonian oil draws far too much in contacts under pressure."""

LEAST_PRESSURE: Final = -5e7
"""Pressure below which nothing changes any more [Pa]: no oil bears such tension, its film breaks."""


@dataclass(frozen=True, eq=False)
class RheologyLaw:
    """A named law of the oil under pressure.

    Attributes:
        name: by which it is chosen.
        title: name to show.
        function: the law; keyword-only, SI in and out.
        sources: keys of the bibliography.
        check: arguments in SI, and the value worked out by hand.
        range: where it holds, as a sentence.
        ranges: limits of quantities in SI, where a range is known; `index` is that of `roelands_index`.
        unknown: what of an oil its own parameters are, where a catalogue does not have them, and what they
            are taken as.
        note: what else is to be known.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    check: tuple[dict[str, float], float] | None = None
    range: str = ""
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    unknown: tuple[str, str] = (
        "the volume of this oil is not known",
        "constants between those of a few others",
    )
    note: str = ""

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters of its own with their usual values [SI]."""
        every = inspect.signature(self.function).parameters.values()
        return {
            parameter.name: parameter.default
            for parameter in every
            if parameter.default is not parameter.empty
        }

    def outside(self, **values: ArrayLike) -> str | None:
        """None if the law holds for these values, else why not, in one sentence without its stop.

        Args:
            values: by the names of `ranges` [SI], values and no tracers; others are passed over.

        Example:
            >>> from pitchpoint.materials.materials_registry import VISCOSITY
            >>> VISCOSITY["roelands_1966"].outside(pressure=1.6e9)
            "a pressure of 1.6 GPa is outside the range of 'roelands_1966', up to 1 GPa"
            >>> VISCOSITY["roelands_1966"].outside(pressure=0.8e9) is None
            True
        """
        for name in filter(values.__contains__, self.ranges):
            low, high = self.ranges[name]
            asked_values = np.asarray(values[name], dtype=float)
            some = 1e-3 * (high - low)  # what three digits would not show
            beyond = asked_values[~((asked_values >= low - some) & (asked_values <= high + some))]
            if beyond.size:
                return self._told(name, float(beyond[np.argmax(abs(beyond))]))
        return None

    def _told(self, name: str, value: float) -> str:
        low, high = (_words(name, limit) for limit in self.ranges[name])
        limits = f"up to {high}" if name == "pressure" else f"{low} to {high}"
        what = _NAMES[name]
        return f"{what} of {_words(name, value)} is outside the range of '{self.name}', {limits}"


_NAMES: Final = {"pressure": "a pressure", "index": "a pressure-viscosity index Z"}


def _words(name: str, value: float) -> str:
    return f"{value * 1e-9:.3g} GPa" if name == "pressure" else f"{value:.3g}"


_OIL: Final[dict[str, Any]] = {
    "viscosity": 0.04,
    "pressure_viscosity": 2.2e-8,
    "temperature": 313.15,
    "viscosity_slope": 0.04,
}


_SHEARED: Final[dict[str, Any]] = {
    "viscosity": 100.0,
    "shear_rate": 1e6,
    "pressure": 1e9,
    "temperature_rise": 10.0,
}

_NO_CURVE: Final = "No measured traction curve was found in numbers to hold it against."
_OF_SQUALANE: Final = (
    f"{_NO_CURVE} By traction of squalane on four test rigs Neupert and Bartel (2023) found Ree-Eyring "
    "nearer, which Bair (2023) contests."
)


VISCOSITY = Registry(
    "law of viscosity under pressure",
    RheologyLaw(
        "roelands_1966",
        "Roelands",
        "pitchpoint.materials.rheology:roelands_1966",
        ("roelands_1966", "houpert_1985"),
        ({**_OIL, "pressure": 0.5e9, "temperature_rise": 20.0}, 40.90895584153685),
        "Mineral and most synthetic oils up to about 1 GPa, with an index Z between 0 and 1; beyond that it "
        "is an extrapolation.",
        {"pressure": (LEAST_PRESSURE, 1e9), "index": (0.0, 1.0)},
    ),
    RheologyLaw(
        "barus_1893",
        "Barus",
        "pitchpoint.materials.rheology:barus_1893",
        ("barus_1893", "stachowiak_batchelor_2014"),
        ({**_OIL, "pressure": 0.1e9, "temperature_rise": 5.0}, 0.295562243957226),
        "Low pressures; beyond 0.5 GPa the viscosity is much too high.",
        {"pressure": (LEAST_PRESSURE, 0.5e9)},
    ),
    RheologyLaw(
        "doolittle_1951",
        "Doolittle, free volume with Tait's equation of state",
        "pitchpoint.materials.rheology:doolittle_1951",
        ("doolittle_1951", "bair_2019"),
        ({**_OIL, "pressure": 0.5e9, "temperature_rise": 20.0}, 19.450903310783378),
        "Oils whose free volume is in the catalogue, up to about 1 GPa; of every other oil occupied volume "
        "and equation of state are assumed, and so is its viscosity in the middle of a contact.",
        {"pressure": (LEAST_PRESSURE, 1e9)},
        note=_NO_CURVE,
    ),
    RheologyLaw(
        "bair_2015",
        "Bair, hybrid of McEwen and Paluch",
        "pitchpoint.materials.rheology:bair_2015",
        ("bair_2015", "mcewen_1952", "bair_2019", "encyclopedia_of_tribology_2013"),
        ({**_OIL, "pressure": 0.5e9, "temperature_rise": 20.0}, 56.62480971447568),
        "Oils whose three constants are known at the temperature of the inlet, up to about 1 GPa; no set of "
        "constants is in the catalogue, and those of one gear oil at 60 degC are assumed unless given.",
        {"pressure": (LEAST_PRESSURE, 1e9)},
        unknown=(
            "how the viscosity of this oil rises under pressure is not known",
            "constants of one gear oil at 60 degC",
        ),
        note=_NO_CURVE,
    ),
)
"""Laws f(*, pressure, temperature_rise, viscosity, pressure_viscosity, temperature, viscosity_slope)."""


DENSITY = Registry(
    "law of density under pressure",
    RheologyLaw(
        "dowson_higginson_1966",
        "Dowson-Higginson",
        "pitchpoint.materials.rheology:dowson_higginson_1966",
        ("dowson_higginson_1966", "xu_2021"),
        ({"pressure": 1e9, "temperature_rise": 10.0}, 1.0 + 0.6 / 2.7 - 0.007),
        "A mineral oil, used for every oil; the density rises by 35 % at most. No range of the fit was "
        "found.",
    ),
    RheologyLaw(
        "incompressible",
        "incompressible",
        "pitchpoint.materials.rheology:incompressible",
        (),
        ({"pressure": 1e9, "temperature_rise": 10.0}, 1.0),
        "Films come out too thick at high pressure.",
    ),
    RheologyLaw(
        "tait_1888",
        "Tait",
        "pitchpoint.materials.rheology:tait_1888",
        ("tait_1888", "bair_2019"),
        ({"pressure": 1e9, "temperature_rise": 10.0}, 1.2405533994211617),
        "Oils whose free volume is in the catalogue; of every other oil its four constants are assumed.",
    ),
)
"""Laws f(*, pressure, temperature_rise) with own parameters, density over that at ambient pressure."""


SHEAR_STRESS = Registry(
    "law of shear stress",
    RheologyLaw(
        "newtonian",
        "Newtonian",
        "pitchpoint.materials.rheology:newtonian",
        (),
        ({"viscosity": 10.0, "shear_rate": -1e5, "pressure": 1e9, "temperature_rise": 0.0}, -1e6),
        "Small shear stresses; in a sliding contact under pressure far too high.",
    ),
    RheologyLaw(
        "ree_eyring_1955",
        "Ree-Eyring",
        "pitchpoint.materials.rheology:ree_eyring_1955",
        ("ree_eyring_1955", "johnson_tevaarwerk_1977"),
        (_SHEARED, 18447519.34494453),
        "Thinning up to the stress at which an oil yields; its parameter belongs to one oil at one mean "
        "pressure and temperature.",
    ),
    RheologyLaw(
        "bair_winer_1979",
        "Bair-Winer, limiting shear stress",
        "pitchpoint.materials.rheology:bair_winer_1979",
        ("bair_winer_1979",),
        (_SHEARED, 57779314.22479116),
        "Oils near their limiting shear stress, which belongs to one oil and temperature.",
    ),
    RheologyLaw(
        "carreau_1972",
        "Carreau, cut at the limiting shear stress",
        "pitchpoint.materials.rheology:carreau_1972",
        ("carreau_1972", "bair_2019", "habchi_2018", "neupert_bartel_2023", "bair_2023"),
        (_SHEARED, 23132370.485288832),
        "Oils from their first thinning up to the limiting shear stress; its parameters belong to one oil "
        "and are assumed unless given.",
        note=_OF_SQUALANE,
    ),
)
"""Laws f(*, viscosity, shear_rate, pressure, temperature_rise) with own parameters; stress with the sign of
the shear rate."""
