"""Films at the points A and B of the zone over speed and oil temperature, and of its teeth, eqs. 7 to 16."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from pitchpoint._jax import jax
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.lubrication.ehl.fields import STANDS_OUT
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.patch.contact import finite_line
from pitchpoint.lubrication.ehl.patch.fields import PatchFilm
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, solve_patch
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.materials.fluid import Fluid
from pitchpoint.published.publication import Read, ReadingPoint
from pitchpoint.published.xu2021.printed import (
    TEMPERATURE_0,
    oil_of,
    pressure_viscosity,
    printed_viscosity,
    viscosity,
)
from pitchpoint.published.xu2021.readings import modulus_of
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.published.xu2021.zone import MeshingZone, zone_of

__all__ = ["POINTS", "ToothFilms", "films_at", "load_over_film_step"]

Course = Float[np.ndarray, " place"]

POINTS = ("a", "b")
"""Of the meshing zone: at the root of the conjugate tooth, and at its tip."""

_PLACES = np.linspace(-0.49, 0.49, 99)
"""Along the face over its width, and as far as the middles of the last cells."""

_CUT = np.linspace(-2.5, 1.4, 118)
"""Across the contact, in half-widths."""

_MAP = np.linspace(-2.5, 1.4, 66), np.linspace(-0.49, 0.49, 50)
"""Across the contact in half-widths, and along the face over its width, of the maps."""

_SLOW = 2.0 * np.pi / 60.0 * 100.0
"""Speed below which asperities carry more than 80 % by section 3.2 [rad/s]."""

_UNDER = 0.01
"""Part of the largest pressure from which on eq. 16 counts a node: the paper names no bound, and its own
grid has a pressure above none at nearly every node of the inlet."""


@dataclass(frozen=True)
class ToothFilms:
    """Contacts of the teeth of a case, at any angle, speed and temperature.

    Attributes:
        given: table of the case.
        zone: of the case, at its operating speed.
        oil: arguments of `printed.viscosity`.
        rq: composite roughness [m].
        modulus: E of eq. 11 [Pa].
        face_width: [m].
    """

    given: ZoneFilms
    zone: MeshingZone
    oil: dict[str, float]
    rq: float
    modulus: float
    face_width: float

    @classmethod
    def of(cls, point: ReadingPoint) -> "ToothFilms":
        """Those of a case with its table."""
        table, gears, design = point.formulas, point.gears, point.design
        assert isinstance(table, ZoneFilms)
        assert isinstance(gears, StrainWaveGears)
        return cls(
            table,
            zone_of(point),
            oil_of(design.lubricant),
            float(design.roughness.composite_rq),
            modulus_of(design),
            gears.face_width,
        )

    def entrainment(self, angle: Course) -> Course:
        """Entrainment at the operating speed: eq. 3 times the calibrated factor [m/s]."""
        logs = np.log(np.asarray(self.given.entrainment_factor))
        return np.asarray(
            self.zone.speed(angle) * np.exp(np.interp(angle, self.given.angles, logs))
        )

    def fluid(self, temperature: float | Course) -> Fluid:
        """By eq. 12 with the -1 inside the bracket: warmer oil is less viscous, and less so by pressure.

        Args:
            temperature: of the oil, one or one for each contact [K].
        """
        return Fluid(
            viscosity=viscosity(temperature=temperature, **self.oil),
            pressure_viscosity=pressure_viscosity(temperature=temperature, **self.oil),
            temperature=temperature,
            shear_law="newtonian",
        )

    @property
    def texture(self) -> Rough:
        """Of both flanks, with elastic summits."""
        return Rough(
            rq=self.rq,
            modulus=self.modulus,
            eta_beta_sigma=self.given.eta_beta_sigma,
            sigma_over_beta=self.given.sigma_over_beta,
        )

    def patch(
        self,
        angle: float,
        speed: float,
        temperature: float,
        nodes: float,
        start: PatchFilms | None = None,
    ) -> PatchFilms:
        """Film of a tooth on its whole contact line.

        Args:
            angle: of the tooth from the long axis [rad].
            speed: of the wave generator [rad/s].
            temperature: of the oil [K].
            nodes: of the grid along the motion.
            start: film of a like contact, on any grid.

        Raises:
            InputError: eqs. 1 to 5 give no contact there.
        """
        at = self._touching(np.array([angle]))
        # Of a Newtonian oil whose flanks roll only, films hang on speed times viscosity.
        rolling = float(self._rolling(at, speed)[0])
        contact = finite_line(
            load=float(self.zone.load(at)[0]),
            length=self.face_width,
            radius=float(self.zone.radius(at)[0]),
            speed_a=rolling,
            speed_b=rolling,
            modulus=self.modulus,
            fluid=self.fluid(temperature),
            texture=self.texture,
        )
        return solve_patch(contact, nodes=int(nodes), cells=int(nodes) - 1, start=start)

    def lines(self, angle: Course, speed: Course, temperature: Course, more: float = 0.0) -> Films:
        """Films of teeth on lines without ends, which take a hundredth of the time.

        Args:
            angle: of each tooth from the long axis [rad].
            speed: of the wave generator at each [rad/s].
            temperature: of the oil at each [K].
            more: part by which each carries more.

        Raises:
            InputError: eqs. 1 to 5 give no contact at one.
        """
        at = self._touching(angle)
        rolling = self._rolling(at, speed)
        return solve_lines(
            LineContact(
                line_load=(1.0 + more) * self.zone.load(at) / self.face_width,
                radius=self.zone.radius(at),
                modulus=self.modulus,
                speed_a=rolling,
                speed_b=rolling,
                fluid=self.fluid(temperature),
                texture=self.texture,
            )
        )

    @property
    def misprint(self) -> float:
        """Viscosity by eq. 12 as printed over that by the corrected form, the same at any pressure."""
        at = {"temperature": TEMPERATURE_0, **self.oil}
        return float(printed_viscosity(**at) / viscosity(**at))

    def lines_and_stiffness(
        self, angle: Course, speed: Course, temperature: Course
    ) -> tuple[Films, Course]:
        """Films of `lines`, with their stiffness by eqs. 15 and 16 [N/m]."""
        films = self.lines(angle, speed, temperature)
        heavier = self.lines(angle, speed, temperature, more=self.given.load_step)
        step = self.given.load_step * self.zone.load(angle)
        return films, load_over_film_step(films, heavier, step)

    def _rolling(self, angle: Course, speed: float | Course) -> Course:
        return np.asarray(self.entrainment(angle) * speed / self.zone.wave_speed)

    def _touching(self, angle: Course) -> Course:
        """The angles, each of which has a contact."""
        if not np.all(there := self.zone.touches(angle)):
            beyond = np.rad2deg(angle[~there][0])
            raise InputError(
                f"at {beyond:.4g} degrees from the long axis eqs. 1 to 5 give no contact: relative radius, "
                "entrainment and load have to be positive",
                key="formulas.angles",
            )
        return angle


def load_over_film_step(films: Films, more: Films, step: Course) -> Course:
    """k_oil of eq. 15, the load step over the fall of the mean film of eq. 16, shape (contact,) [N/m].

    The mean runs over as many even nodes as the films have, from where the pressure begins in the inlet to
    where it ends, and over the same ones under more load.

    Args:
        films: of lines.
        more: of the same lines under more load.
        step: of the load [N].
    """
    stiffness = []
    for k in range(len(step)):
        x, pressure = films.film.x[k], films.film.pressure[k]
        (under,) = np.nonzero(pressure > _UNDER * np.max(pressure))
        if not under.size:  # not solved
            stiffness.append(np.nan)
            continue
        nodes = np.linspace(x[under[0]], x[under[-1]], x.size)
        before = np.mean(np.interp(nodes, x, films.film.gap[k]))
        after = np.mean(np.interp(nodes, more.film.x[k], more.film.gap[k]))
        stiffness.append(step[k] / (before - after))
    return np.array(stiffness)


def films_at(point: ReadingPoint) -> Read:
    """Films that the table of a case asks for, and what the paper tells of them."""
    teeth = ToothFilms.of(point)
    speed, temperature = float(point.operation.speed), float(point.operation.temperature)
    if teeth.given.solves == "zone":
        return _of_teeth(teeth, speed, temperature)
    reading: dict[str, Any] = {
        "film_speed": np.asarray(teeth.given.speeds),
        "film_temperature": np.asarray(teeth.given.temperatures),
        "film_place": _PLACES,
        "film_cut": _CUT,
        "film_map_x": _MAP[0],
        "film_map_y": _MAP[1],
    }
    for angle, name in zip(teeth.given.angles, POINTS, strict=True):
        point_films = _of_point(teeth, angle, speed, temperature)
        reading |= {f"{key}_{name}": value for key, value in point_films.items()}
    return reading


# ---- points A and B


def _of_point(teeth: ToothFilms, angle: float, speed: float, temperature: float) -> Read:
    speeds, temperatures = (
        np.asarray(values) for values in (teeth.given.speeds, teeth.given.temperatures)
    )
    cold = _Chain(teeth, angle)
    by_speed = [cold.film(wave_speed, temperature) for wave_speed in speeds]
    coarse = cold.film(speed, temperature)
    rated = teeth.patch(angle, speed, temperature, teeth.given.nodes, coarse)
    # From the oil that is nearest to that of the rated film on, either way.
    order = np.argsort(np.abs(temperatures - temperature))
    warm = _Chain(teeth, angle, cold.last)
    by_oil = {k: warm.film(speed, temperatures[k]) for k in order}
    by_temperature = [by_oil[k] for k in range(temperatures.size)]
    codes = [film.ended.code for film in (*by_speed, coarse, rated, *by_temperature)]
    at_speeds, at_temperatures = _course(teeth, by_speed), _course(teeth, by_temperature)
    lines = {
        "": (speeds, np.full(speeds.shape, temperature)),
        "warm_": (np.full(temperatures.shape, speed), temperatures),
    }
    printed = {}
    for key, (fast, hot) in lines.items():
        films, stiffness = teeth.lines_and_stiffness(np.full(fast.shape, angle), fast, hot)
        printed[f"{key}printed_film_stiffness"] = stiffness
        codes += [Code(int(code)) for code in films.ended.code]
    ratio, warm_ratio = at_speeds["film_ratio"], at_temperatures["film_ratio"]
    of_one = float(np.exp(_place_of_one(np.log(speeds), ratio)))
    return {
        "films_status": float(next((code for code in codes if not code.ok), Code.SOLVED)),
        "point_radius": float(teeth.zone.radius(np.array([angle]))[0]),
        "point_load": float(teeth.zone.load(np.array([angle]))[0]),
        "point_entrainment": float(teeth.entrainment(np.array([angle]))[0]),
        **at_speeds,
        **{f"warm_{key}": value for key, value in at_temperatures.items()},
        **printed,
        "speed_of_one": of_one,
        # Films hang on speed times viscosity.
        "misprinted_speed_of_one": of_one / teeth.misprint,
        "temperature_of_one": _place_of_one(temperatures, warm_ratio),
        "late_film_gain": _late_gain(speeds, ratio),
        "late_share_gain": _late_gain(speeds, at_speeds["asperity_share"]),
        "slow_share": float(np.interp(_SLOW, speeds, at_speeds["asperity_share"])),
        **{f"rated_{key}": float(course[0]) for key, course in _course(teeth, [rated]).items()},
        "coarse_film_ratio": float(_course(teeth, [coarse])["film_ratio"][0]),
        **_fields(rated, teeth.face_width),
    }


class _Chain:
    """Films of a point, each found from the one before and none twice."""

    def __init__(self, teeth: ToothFilms, angle: float, film: PatchFilms | None = None) -> None:
        self.teeth, self.angle, self.last = teeth, angle, film
        self.known: dict[tuple[float, float], PatchFilms] = {}

    def film(self, speed: float, temperature: float) -> PatchFilms:
        """Film at a speed [rad/s] and a temperature [K]."""
        key = round(float(speed), 9), round(float(temperature), 9)
        if key not in self.known:
            nodes = self.teeth.given.course_nodes
            self.known[key] = self.teeth.patch(self.angle, *key, nodes, start=self.last)
        self.last = self.known[key]
        return self.last


def _course(teeth: ToothFilms, films: list[PatchFilms]) -> dict[str, Course]:
    return {
        "film_ratio": np.array([float(film.film.mean_film) for film in films]) / teeth.rq,
        "asperity_share": np.array([float(film.film.asperity_share) for film in films]),
        "film_stiffness": np.array([float(film.film.stiffness) for film in films]),
    }


def _place_of_one(places: Course, ratio: Course) -> float:
    """Place at which the mean film is as thick as the roughness, the first one; NaN where it is at none."""
    over = np.log(ratio)
    (crosses,) = np.nonzero(np.signbit(over[1:]) != np.signbit(over[:-1]))
    if not crosses.size or not np.all(np.isfinite(over)):
        return float("nan")
    ends = slice(crosses[0], crosses[0] + 2)
    order = np.argsort(over[ends])
    return float(np.interp(0.0, over[ends][order], places[ends][order]))


def _late_gain(speeds: Course, values: Course) -> float:
    """Change by a turn in the last step of the speed over that in the step before; NaN of two speeds."""
    slopes = np.diff(values) / np.diff(speeds)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(slopes[-1] / slopes[-2]) if slopes.size > 1 else float("nan")


def _fields(films: PatchFilms, face_width: float) -> Read:
    """Pressure and film over the contact, along the face and across, and near the ends over the middle."""
    film = jax.tree.map(np.asarray, films.film)
    middle = film.pressure.shape[0] // 2
    ridge, gap = np.max(film.pressure, axis=1), _in_the_middle(film.x, film.gap)
    along, across = _PLACES * face_width, _CUT * float(film.half_width)
    near = float(np.mean(film.near_ends[:, 0]))
    beside = 0.5 * face_width - 0.25 * float(film.half_width)
    thin = float(np.interp(beside, film.y, gap))
    grid = _MAP[0] * float(film.half_width), _MAP[1] * face_width
    return {
        "half_width": float(film.half_width),
        "map_pressure": _on(film.x, film.y, film.pressure, *grid).ravel(),
        "map_film": _on(film.x, film.y, film.gap, *grid).ravel(),
        "ridge_pressure": np.interp(along, film.y, ridge),
        "ridge_film": np.interp(along, film.y, gap),
        "cut_pressure": np.interp(across, film.x, film.pressure[middle]),
        "cut_film": np.interp(across, film.x, film.gap[middle]),
        "end_pressure": near / float(ridge[middle]),
        "end_film": thin / float(gap[middle]),
        **_across(film, middle),
    }


def _across(film: PatchFilm, middle: int) -> Read:
    """What section 3.1 tells of pressure and film across the contact, in the middle of the face."""
    pressure, gap = np.asarray(film.pressure[middle]), np.asarray(film.gap[middle])
    half = float(film.half_width)
    before, inner, after = np.interp([-half, 0.0, half], film.x, gap)
    flat = np.interp(np.linspace(-0.5, 0.5, 51) * half, film.x, gap)
    solved = 1.0 if np.all(np.isfinite(pressure)) else float("nan")
    return {
        "peak_place": solved * float(film.x[np.argmax(pressure)]) / half,
        "pressure_peaks": solved * _peaks(pressure),
        "entry_film": float(before / after),
        "film_spread": float(np.ptp(flat) / inner),
    }


def _peaks(pressure: Float[np.ndarray, " x"]) -> int:
    """Maxima of a course that stand out by `STANDS_OUT` of the largest one on both sides."""
    step = STANDS_OUT * float(pressure.max())
    count, turn, rising = 0, float(pressure[0]), True
    for value in map(float, pressure):
        if (value >= turn) == rising:
            turn = value
        elif abs(value - turn) > step:
            count, turn, rising = count + rising, value, not rising
    return count


def _on(
    x: Float[np.ndarray, " x"],
    y: Float[np.ndarray, " y"],
    field: Float[np.ndarray, "y x"],
    to_x: Float[np.ndarray, " to_x"],
    to_y: Float[np.ndarray, " to_y"],
) -> Float[np.ndarray, "to_y to_x"]:
    """Values of a field at other places."""
    rows = np.array([np.interp(to_x, x, row) for row in field])
    return np.array([np.interp(to_y, y, column) for column in rows.T]).T


def _in_the_middle(
    x: Float[np.ndarray, " x"], field: Float[np.ndarray, "y x"]
) -> Float[np.ndarray, " y"]:
    """Values of every row at x = 0."""
    return np.array([np.interp(0.0, x, row) for row in field])


# ---- teeth of the zone


def _of_teeth(teeth: ToothFilms, speed: float, temperature: float) -> Read:
    """Films of all teeth from that on the long axis on, those on its other side being alike."""
    zone = teeth.zone
    angle = zone.tooth_angles
    there = zone.touches(angle)
    if there.sum() < 2:
        reason = f"eq. 2 gives contact to {there.sum()} teeth of the zone, and their films take two at least"
        raise InputError(f"{reason}; change the map of the mesh point", key="formulas.map_distance")
    fast, hot = (np.full(int(there.sum()), value) for value in (speed, temperature))
    films, printed = teeth.lines_and_stiffness(angle[there], fast, hot)
    codes = [Code(int(code)) for code in films.ended.code]

    def every(values: Any) -> Course:
        by_tooth = np.full(angle.shape, np.nan)
        by_tooth[there] = values
        return by_tooth

    line = films.film
    mean = float(np.mean(printed))
    stiffness = np.asarray(line.stiffness) * teeth.face_width
    courses = {
        "tooth_angle": angle,
        "tooth_entrainment": every(teeth.entrainment(angle)[there]),
        "tooth_film_ratio": every(np.asarray(line.mean_film) / teeth.rq),
        "tooth_asperity_share": every(line.asperity_share),
        "tooth_film_stiffness": every(stiffness),
        "tooth_printed_stiffness": every(printed),
    }
    return {
        **courses,
        "teeth_status": float(next((code for code in codes if not code.ok), Code.SOLVED)),
        "teeth_of_zone": 2.0 * angle.size - 1.0,
        "teeth_with_films": float(there.sum()),
        "mean_tooth_film_ratio": float(np.mean(courses["tooth_film_ratio"][there])),
        "mean_tooth_asperity_share": float(np.mean(courses["tooth_asperity_share"][there])),
        "mean_tooth_film_stiffness": float(np.mean(stiffness)),
        "mean_tooth_printed_stiffness": mean,
        "thick_film_stiffness": float(printed[np.argmax(line.mean_film)]) / mean,
        "high_pressure_stiffness": float(printed[np.argmax(line.largest_pressure)]) / mean,
        "tooth_printed_stiffness_step": float(np.max(np.abs(np.diff(printed)))),
    }
