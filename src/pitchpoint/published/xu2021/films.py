"""Films of the meshing zone at its points A and B over speed and oil temperature, eqs. 7 to 16."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import jax
from pitchpoint.efficiency.quasi_static import Design
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.lubrication.ehl.patch.contact import finite_line
from pitchpoint.lubrication.ehl.patch.films import PatchFilms, solve_patch
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.materials.fluid import Fluid
from pitchpoint.published.publication import Point, Read
from pitchpoint.published.xu2021.printed import (
    OIL,
    effective_modulus,
    printed_viscosity,
    roelands_exponents,
    viscosity,
)
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.status import Code

__all__ = ["POINTS", "films_at"]

Array = NDArray[np.float64]

POINTS = ("a", "b")
"""Of the meshing zone: at the root of the conjugate tooth, and at its tip."""

_PLACES = np.linspace(-0.49, 0.49, 99)
"""Along the face over its width, and as far as the middles of the last cells."""

_CUT = np.linspace(-2.5, 1.4, 118)
"""Across the contact, in half-widths."""

_SLOW = 2.0 * np.pi / 60.0 * 100.0
"""Speed below which asperities carry more than 80 % by section 3.2 [rad/s]."""

_MEDIUM = 2.0 * np.pi / 60.0 * 500.0
"""Speed from which on stiffness is compared: below it asperities carry much of the load [rad/s]."""


@dataclass(frozen=True)
class _Zone:
    """What all contacts of one point of the zone have in common.

    Attributes:
        given: table of the case.
        design: gears with their oil and roughness.
        speed: of the wave generator at the operating point [rad/s].
        temperature: of the oil [K].
        place: 0 at A, 1 at B.
        face_width: [m].
    """

    given: ZoneFilms
    design: Design
    speed: float
    temperature: float
    place: int
    face_width: float

    def film(
        self, speed: float, start: PatchFilms | None = None, thicker: float = 1.0
    ) -> PatchFilms:
        """Film at a speed of the wave generator, from one at another; of an oil so many times as viscous."""
        rolling = self.given.entrainment[self.place] * speed / self.speed
        nodes = int(self.given.nodes)
        contact = finite_line(
            load=self.given.load,
            length=self.face_width,
            radius=self.given.radius[self.place],
            modulus=self.modulus,
            # Of a Newtonian oil whose flanks roll only, films hang on speed times viscosity.
            speed_a=rolling * thicker,
            speed_b=rolling * thicker,
            fluid=self.oil,
            texture=Rough(
                rq=float(self.design.roughness.composite_rq),
                modulus=self.modulus,
                eta_beta_sigma=self.given.eta_beta_sigma,
                sigma_over_beta=self.given.sigma_over_beta,
            ),
        )
        return solve_patch(contact, nodes=nodes, cells=nodes - 1, start=start)

    @property
    def modulus(self) -> float:
        young, poisson = (
            tuple(float(getattr(solid, name)) for solid in self.design.solids)
            for name in ("young", "poisson")
        )
        return effective_modulus(young=(young[0], young[1]), poisson=(poisson[0], poisson[1]))

    @property
    def oil(self) -> Fluid:
        """By eq. 12 with the -1 inside the bracket: warmer oil is less viscous, and less so by pressure."""
        exponents = roelands_exponents(**OIL)
        warmth = (self.temperature - 138.0) / (OIL["temperature_0"] - 138.0)
        return Fluid(
            viscosity=float(viscosity(temperature=self.temperature, **OIL)),
            pressure_viscosity=OIL["alpha"] * warmth ** -exponents[1],
            temperature=self.temperature,
            shear_law="newtonian",
        )


def films_at(point: Point) -> Read:
    """Films at both points over the speeds, and what the paper tells of them, for a case with its table."""
    given = point.formulas
    gears, operation = point.gears, point.operation
    assert isinstance(given, ZoneFilms)
    assert isinstance(gears, StrainWaveGears)
    speed, temperature = float(operation.speed), float(operation.temperature)
    found: dict[str, Any] = {"film_speed": np.asarray(given.speeds), "film_place": _PLACES}
    for place, name in enumerate(POINTS):
        zone = _Zone(given, point.design, speed, temperature, place, gears.face_width)
        found |= {f"{key}_{name}": value for key, value in _of_zone(zone).items()}
    return found | {"film_cut": _CUT}


def _of_zone(zone: _Zone) -> dict[str, Any]:
    films: list[PatchFilms] = []
    for speed in zone.given.speeds:
        films.append(zone.film(speed, films[-1] if films else None))
    rated = zone.film(zone.speed, films[-1])
    rq = float(zone.design.roughness.composite_rq)
    ratio = np.array([float(one.film.mean_film) for one in films]) / rq
    share = np.array([float(one.film.asperity_share) for one in films])
    stiffness = np.array([float(one.film.stiffness) for one in films])
    speeds = np.asarray(zone.given.speeds)
    codes = [one.ended.code for one in (*films, rated)]
    return {
        "films_status": float(next((one for one in codes if not one.ok), Code.SOLVED)),
        "film_ratio": ratio,
        "asperity_share": share,
        "film_stiffness": stiffness,
        "speed_of_one": _speed_of_one(speeds, ratio),
        "slow_share": float(np.interp(_SLOW, speeds, share)),
        "film_ratio_rise": float(np.min(np.diff(ratio))),
        "asperity_share_rise": float(np.max(np.diff(share))),
        "film_stiffness_ratio": float(stiffness[-1] / np.interp(_MEDIUM, speeds, stiffness)),
        "rated_film_ratio": float(rated.film.mean_film) / rq,
        "rated_asperity_share": float(rated.film.asperity_share),
        "rated_film_stiffness": float(rated.film.stiffness),
        "misprinted_film_ratio": _misprinted(zone) / rq,
        **_ends(rated, zone.face_width),
    }


def _speed_of_one(speeds: Array, ratio: Array) -> float:
    """Speed at which the mean film is as thick as the roughness; NaN where it is at none of them."""
    if not (ratio[0] <= 1.0 <= ratio[-1]):
        return float("nan")
    return float(np.exp(np.interp(0.0, np.log(ratio), np.log(speeds))))


def _misprinted(zone: _Zone) -> float:
    """Mean film of the oil by eq. 12 as printed, which is as much more viscous at any pressure [m]."""
    at = {"temperature": zone.temperature, **OIL}
    return float(
        zone.film(
            zone.speed, thicker=float(printed_viscosity(**at) / viscosity(**at))
        ).film.mean_film
    )


def _ends(films: PatchFilms, face_width: float) -> dict[str, Any]:
    """Pressure and film along the face and across the contact, and near the ends over those in the middle."""
    film = jax.tree.map(np.asarray, films.film)
    middle = film.pressure.shape[0] // 2
    ridge, gap = np.max(film.pressure, axis=1), _in_the_middle(film.x, film.gap)
    along, across = _PLACES * face_width, _CUT * float(film.half_width)
    near = float(np.mean(film.near_ends[:, 0]))
    beside = 0.5 * face_width - 0.25 * float(film.half_width)
    thin = float(np.interp(beside, film.y, gap))
    return {
        "ridge_pressure": np.interp(along, film.y, ridge),
        "ridge_film": np.interp(along, film.y, gap),
        "cut_pressure": np.interp(across, film.x, film.pressure[middle]),
        "cut_film": np.interp(across, film.x, film.gap[middle]),
        "end_pressure": near / float(ridge[middle]),
        "end_film": thin / float(gap[middle]),
    }


def _in_the_middle(x: Array, field: Array) -> Array:
    """Values of every row at x = 0."""
    return np.array([np.interp(0.0, x, row) for row in field])
