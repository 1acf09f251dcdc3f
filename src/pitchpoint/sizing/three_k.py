"""3K (Wolfrom) sets for a ratio: teeth and profile shifts that lose least in both directions.

A sun drives planets of two gears each. The first one meshes with the sun and a ring that is held, the second
one with the ring of the output; no carrier takes a torque. The two ring meshes decide whether such a set can
be driven back, and their losses hang on where the path of contact lies about the pitch point: on the shifts.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from math import cos, pi, radians, sin, tan
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float, Int

from pitchpoint import units
from pitchpoint._jax import double_precision
from pitchpoint.drive.assembly import ROOM_BETWEEN_PLANETS
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pairs
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.gears.gears_table import SHIFT
from pitchpoint.gears.planetary import PLANETARY

__all__ = ["mesh_efficiency", "three_k_efficiencies", "three_k_sets", "three_k_tables"]

GEARS = ("sun", "planet of the held ring", "held ring", "planet of the output", "output ring")
VARIABLES = (
    "centre distance",
    "shift of the planet of the held ring",
    "shift of the planet of the output",
)
"""By which the others of a set follow without backlash, and by which it has derivatives."""

MESHES = ("sun and planet", "planet and held ring", "planet and output ring")

_ALPHA = radians(20.0)
_INVOLUTE = tan(_ALPHA) - _ALPHA
_DEDENDUM, _SUN_FILLET, _FILLET = 1.25, 0.38, 0.2

_PAIRS = (
    ((0, 1), 1, (_SUN_FILLET, _FILLET)),
    ((1, 2), -1, (_FILLET, _FILLET)),
    ((3, 4), -1, (_FILLET, _FILLET)),
)
"""Of each mesh its gears, the sign of the second number of teeth, and fillets [modules]."""

_THIN_TIP = 0.2

_ROOM = 1.02
"""Room at the root of a ring over its fillet: flanks are taken as straight there, and are not."""

_OFF_NOMINAL = 3
"""Teeth by which a ring may differ from what goes without profile shift."""

_ANGLES = np.radians(np.linspace(16.0, 28.0, 13))
_SHIFTS = np.linspace(-0.4, 1.2, 17)
_ZOOMS, _NEARER = 4, 3.0
"""How often the best point is looked for between its neighbours, and by how much closer each time."""

_STEP = 1e-4
"""Of centre distance and shifts for derivatives, whose error goes with its square [modules]."""

_SPARE = 8
"""Sets that are refined and checked for each one that is asked for: some teeth cannot be made."""

Values = Float[np.ndarray, "*#b"]
Numbers = np.ndarray | np.number[Any] | int


def mesh_efficiency(
    teeth: tuple[Values, Values], parts: tuple[Values, Values], friction: float | Values
) -> Values:
    """Mean efficiency of a mesh by Coulomb friction, seen from the carrier of its axes.

    Args:
        teeth: z1, z2, negative for a ring.
        parts: of the transverse contact ratio on either side of the pitch point, which may be negative.
        friction: coefficient, one or of each mesh.

    Validity: one or two pairs in contact that share the load as one, small losses: with a coefficient of 0.1
    it is low by some 2 % of the loss.

    Source: Ohlendorf (1958), as in Niemann and Winter; VDI 2736 Part 2 (2014), equation 8, for spur gears.

    Example:
        >>> import numpy as np
        >>> teeth, parts = (np.array(24.0), np.array(30.0)), (np.array(0.8), np.array(0.8))
        >>> round(float(mesh_efficiency(teeth, parts, 0.05)), 5)
        0.99199
    """
    first, second = parts
    slope = 1.0 / teeth[0] + 1.0 / teeth[1]
    lost = friction * pi * slope * (1.0 - first - second + first**2 + second**2)
    return np.asarray(1.0 - lost)


def three_k_efficiencies(
    teeth: Float[np.ndarray, "*#b 5"], meshes: Float[np.ndarray, "*#b 3"]
) -> tuple[Values, Values]:
    """Efficiencies of a 3K set from sun to output ring, and driven back from there.

    Args:
        teeth: numbers of sun, planet and held ring, planet and output ring, all positive.
        meshes: efficiencies of the sun's mesh, of that with the held and of that with the output ring.

    Returns:
        Both; zero where friction locks the set.

    Source: equilibrium of all bodies, see `drive.torques.train_torques`, solved by hand for both signs of
    the ratio.

    Example:
        >>> import numpy as np
        >>> teeth = np.array([18.0, 36.0, 90.0, 34.0, 88.0])
        >>> there, back = three_k_efficiencies(teeth, np.array([0.99, 0.995, 0.995]))
        >>> round(float(there), 10), round(float(back), 10)
        (0.7699379528, 0.7056033545)
    """
    sun, held, output = np.moveaxis(meshes, -1, 0)
    i1, i2 = _basic_ratios(*np.moveaxis(teeth, -1, 0))
    with np.errstate(invalid="ignore", divide="ignore"):
        there = np.where(
            i2 < 1.0,
            (1.0 + sun * held * i1) * (1.0 - i2) / ((1.0 + i1) * (1.0 - held * output * i2)),
            (held + sun * i1) * (i2 - 1.0) / ((1.0 + i1) * (i2 / output - held)),
        )
        back = np.where(
            i2 < 1.0,
            (1.0 + i1) * sun * (held * output - i2) / (output * (sun * held + i1) * (1.0 - i2)),
            (1.0 + i1) * sun * (held * output * i2 - 1.0) / ((sun + held * i1) * (i2 - 1.0)),
        )
    return np.asarray(there), np.asarray(np.maximum(back, 0.0))


@double_precision()
def three_k_sets(
    ratio: tuple[float, float],
    *,
    planets: int = 3,
    friction: float = 0.1,
    contact_ratio: float = 1.1,
    sun: tuple[int, int] = (12, 60),
    planet: tuple[int, int] = (15, 60),
    largest_ring: int = 150,
    count: int = 20,
) -> xr.Dataset:
    """3K sets whose ratio lies between two, those first that lose least in their worse direction.

    All numbers of teeth are tried, and for each of them the centre distance and the shifts of the two planet
    gears; those of sun and rings follow without backlash. The best ones are built as every pair is.

    Args:
        ratio: smallest and largest size of the ratio of sun to output ring, of either sense.
        planets: at equal angles.
        friction: coefficient in all meshes.
        contact_ratio: smallest one of all meshes.
        sun, planet: smallest and largest number of their teeth.
        largest_ring: most teeth of a ring.
        count: of sets, at most.

    Returns:
        Over `set`: `ratio` (negative where the output turns against the sun), `efficiency` and
        `back_driving_efficiency`, their derivatives `efficiency_slope` and `back_driving_slope`
        [set, variable] by centre distance and both shifts of planets in modules, where sun and rings follow
        without backlash, `teeth` and `profile_shift` [set, gear], `contact_ratio` [set, mesh],
        `tip_alteration` of sun and first planet, and `centre_distance` [modules]; the attribute `compared`
        says of how many sets they are the best. `three_k_tables` makes them tables of a case.

    Raises:
        InputError: values out of their range; no numbers of teeth of such a ratio that assemble; none of
            them with teeth that can be made.

    Validity: spur gears of one module, 20 deg, addendum 1, dedendum 1.25; see `mesh_efficiency`. Bearings,
    seals and oil are left out: `run` has them.

    Example:
        >>> sets = three_k_sets((90.0, 110.0), sun=(12, 13), planet=(45, 60), count=3)
        >>> bool(sets["back_driving_efficiency"].min() > 0.9)
        True
    """
    task = _Task(ratio, planets, friction, contact_ratio, sun, planet, largest_ring)
    every = np.concatenate([np.zeros((0, 5)), *_teeth(task)])
    if not len(every):
        raise InputError(
            f"no 3K set of a ratio from {ratio[0]:g} to {ratio[1]:g} with suns of {sun[0]} to {sun[1]} and "
            f"planets of {planet[0]} to {planet[1]} teeth and rings of at most {largest_ring} goes with "
            f"{planets} planets at equal angles; allow more teeth"
        )
    grid = [np.broadcast_to(one, (len(every), one.size)) for one in (_ANGLES, _SHIFTS, _SHIFTS)]
    best = _best(every, grid, task)
    chosen = np.argsort(-best.worse)[: _SPARE * count]
    teeth, best = every[chosen], best[chosen]
    steps = [float(values[1] - values[0]) for values in (_ANGLES, _SHIFTS, _SHIFTS)]
    for zoom in range(1, _ZOOMS + 1):
        near = np.arange(-2.0, 3.0) / _NEARER**zoom
        centres = best.angle, best.shifts[:, 1], best.shifts[:, 3]
        grid = [at[:, None] + step * near for at, step in zip(centres, steps, strict=True)]
        best = _best(teeth, grid, task)
    nominal = teeth[:, :2].sum(axis=1) / 2.0 * cos(_ALPHA)
    rounded = [
        np.arccos(nominal / np.round(best.distance, 3)),
        np.round(best.shifts[:, 1], 3),
        np.round(best.shifts[:, 3], 3),
    ]
    best = _best(teeth, [values[:, None] for values in rounded], task)
    made = np.flatnonzero((best.worse > 0.0) & _can_be_made(teeth, best))
    order = made[np.argsort(-best.worse[made])][:count]
    if not order.size:
        raise InputError(
            f"of {len(every)} numbers of teeth for a ratio from {ratio[0]:g} to {ratio[1]:g} none has teeth "
            f"that can be made with a contact ratio of {contact_ratio:g} and can be driven back; allow more "
            "teeth, or a smaller contact ratio"
        )
    return _dataset(teeth[order], best[order], len(every), task)


def three_k_tables(chosen: xr.Dataset, module: str, face_width: str) -> dict[str, Any]:
    """Table of gears of a case for one set, whose rings follow from the centre distance of sun and planet.

    Args:
        chosen: one of `three_k_sets`, as `sets.isel(set=0)`.
        module, face_width: of all gears, with their units.

    Raises:
        InputError: several sets; text that is no length.

    Example:
        >>> from pitchpoint.sizing.three_k import three_k_sets
        >>> sets = three_k_sets((90.0, 110.0), sun=(12, 13), planet=(45, 60), count=1)
        >>> gears = three_k_tables(sets.isel(set=0), "0.5 mm", "8 mm")["gears"]
        >>> gears["teeth"], gears["second"]["teeth"]
        ([12, 60, 132], [47, 119])
    """
    if "set" in chosen.dims:
        raise InputError("one set is needed; choose it as sets.isel(set=0)", key="chosen")
    z = [int(number) for number in chosen["teeth"].values]
    x = [round(float(shift), 6) for shift in chosen["profile_shift"].values]
    shortened = round(float(chosen["tip_alteration"]), 6)
    for length in (module, face_width):
        units.parse(length, "length")
    second = {
        "teeth": z[3:],
        "face_width": face_width,
        "profile_shift": [x[3], FROM_CENTRE_DISTANCE],
        "tip_alteration": 0.0,
    }
    return {
        "gears": {
            "family": PLANETARY,
            "teeth": z[:3],
            "planets": int(chosen.attrs["planets"]),
            "module": module,
            "face_width": face_width,
            "profile_shift": x[:2],
            "tip_alteration": [shortened, shortened, 0.0],
            "fillet_radius": [_SUN_FILLET, _FILLET, _FILLET],
            "dedendum": _DEDENDUM,
            "second": second,
        }
    }


@dataclass(frozen=True)
class _Task:
    """What is asked of a set, see `three_k_sets`."""

    ratio: tuple[float, float]
    planets: int
    friction: float
    contact_ratio: float
    sun: tuple[int, int]
    planet: tuple[int, int]
    largest_ring: int

    def __post_init__(self) -> None:
        for name, low, high in (("ratio", 1.0, 1e5), ("sun", 5, 500), ("planet", 5, 500)):
            first, last = getattr(self, name)
            if not low <= first <= last <= high:
                raise InputError(
                    f"{first:g} to {last:g} was given; allowed are {low:g} to {high:g}, the smaller first",
                    key=name,
                )
        for name, low, high in (
            ("planets", 1, 24),
            ("friction", 0.0, 0.5),
            ("contact_ratio", 1.0, 2.5),
            ("largest_ring", 20, 1000),
        ):
            if not low <= getattr(self, name) <= high:
                raise InputError(
                    f"{getattr(self, name):g} was given; allowed are {low:g} to {high:g}", key=name
                )


def _teeth(task: _Task) -> Iterator[Int[np.ndarray, "set 5"]]:
    """Numbers of teeth of such a ratio that assemble at equal angles, with rings about as large as needed."""
    second = np.arange(task.planet[0], task.planet[1] + 1)
    off = np.arange(-_OFF_NOMINAL, _OFF_NOMINAL + 1)
    planet, held_off, output, output_off = np.ix_(second, off, second, off)
    for sun in range(task.sun[0], task.sun[1] + 1):
        held_ring = sun + 2 * planet + held_off
        output_ring = held_ring - planet + output + output_off
        i1, i2 = _basic_ratios(sun, planet, held_ring, output, output_ring)
        with np.errstate(divide="ignore"):
            size = np.abs((1.0 + i1) / (1.0 - i2))
        step = task.planets * np.gcd(planet, output)
        fits = (size >= task.ratio[0]) & (size <= task.ratio[1])
        fits &= (sun + held_ring) % task.planets == 0
        fits &= (output_ring * planet - held_ring * output) % step == 0
        fits &= np.maximum(held_ring, output_ring) <= task.largest_ring
        gears = (np.array(sun), planet, held_ring, output, output_ring)
        yield np.stack([np.broadcast_to(z, fits.shape)[fits] for z in gears], axis=1)


def _basic_ratios(
    sun: Numbers, planet: Numbers, held: Numbers, second: Numbers, output: Numbers
) -> tuple[Values, Values]:
    """Ratio of sun to held ring, and of output to held ring, as the carrier sees them; both positive."""
    return np.asarray(held / sun), np.asarray(held * second / (planet * output))


@dataclass(frozen=True)
class _Points:
    """Centre distance and shifts of sets, and what they give; all arrays [set ...].

    Attributes:
        angle: working angle of sun and planet [rad].
        distance: centre distance [modules].
        shifts: [set gear].
        tip: alteration of sun and first planet that keeps their tip clearance, negative [modules].
        ratios: contact ratios [set mesh].
        there, back: efficiencies, not numbers where teeth cannot be made so.
    """

    angle: np.ndarray
    distance: np.ndarray
    shifts: np.ndarray
    tip: np.ndarray
    ratios: np.ndarray
    there: np.ndarray
    back: np.ndarray

    def __getitem__(self, chosen: Any) -> "_Points":
        return _Points(*(getattr(self, one.name)[chosen] for one in fields(self)))

    @property
    def worse(self) -> np.ndarray:
        """The smaller of both efficiencies; below zero where teeth cannot be made so."""
        return _worse(self.there, self.back)


def _worse(there: np.ndarray, back: np.ndarray) -> np.ndarray:
    return np.asarray(np.nan_to_num(np.minimum(there, back), nan=-1.0))


def _best(teeth: np.ndarray, grid: Sequence[np.ndarray], task: _Task) -> _Points:
    """The best point of each set on a grid of angles, and shifts of both planet gears, each [set point].

    The second planet gear meshes with the output ring alone: its best shift goes with every other one.
    """
    angles, first, second = grid
    found: _Points | None = None
    z = [column[:, None] for column in teeth.T]
    for angle in angles.T[:, :, None]:
        nominal = (z[0] + z[1]) / 2.0
        distance = nominal * cos(_ALPHA) / np.cos(angle)
        outer, held, last = _three_meshes(z, distance, first, second)
        room = (
            2.0 * distance * sin(pi / task.planets) - ROOM_BETWEEN_PLANETS
            if task.planets > 1
            else np.inf
        )
        fine = outer.runs(task) & held.runs(task) & (2.0 * outer.tips[0] < room)
        with_output = np.where(
            last.runs(task) & (2.0 * last.tips[0] < room), last.efficiency(task.friction), np.nan
        )
        row = np.arange(len(teeth))
        of_second = np.argmax(np.nan_to_num(with_output, nan=-1.0), axis=1)
        meshes = np.stack(
            np.broadcast_arrays(
                outer.efficiency(task.friction),
                held.efficiency(task.friction),
                with_output[row, of_second][:, None],
            ),
            axis=-1,
        )
        there, back = three_k_efficiencies(teeth[:, None], meshes)
        worse = np.where(fine, _worse(there, back), -1.0)
        of_first = np.argmax(worse, axis=1)
        at, beside = (row, of_first), (row, of_second)
        shifts = [
            outer.mate_shift[at],
            first[at],
            held.mate_shift[at],
            second[beside],
            last.mate_shift[beside],
        ]
        unfit = np.where(worse[at] < 0.0, np.nan, 0.0)
        point = _Points(
            angle[:, 0],
            distance[:, 0],
            np.stack(shifts, axis=1),
            outer.tip[:, 0],
            np.stack([outer.ratio[at], held.ratio[at], last.ratio[beside]], axis=1),
            there[at] + unfit,
            back[at] + unfit,
        )
        found = point if found is None else _better(found, point)
    assert found is not None
    return found


def _better(one: _Points, other: _Points) -> _Points:
    """For each set the better one of two points."""
    takes = other.worse > one.worse

    def chosen(first: np.ndarray, second: np.ndarray) -> np.ndarray:
        return np.where(takes.reshape(-1, *[1] * (first.ndim - 1)), second, first)

    return _Points(
        *(chosen(getattr(one, each.name), getattr(other, each.name)) for each in fields(_Points))
    )


def _three_meshes(
    z: Sequence[Values], distance: Values, first: Values, second: Values
) -> "tuple[_Mesh, _Mesh, _Mesh]":
    """Meshes of sun, held ring and output ring, by the shifts of the planet gears in the latter two."""
    outer = _Mesh(z[1], z[0], first, distance, tip=None)
    held = _Mesh(z[1], -z[2], first, distance, outer.tip)
    return outer, held, _Mesh(z[3], -z[4], second, distance)


def _slopes(teeth: np.ndarray, points: _Points, friction: float) -> np.ndarray:
    """Derivatives of both efficiencies [way set variable] by `VARIABLES`, from central differences."""
    centre = np.stack([points.distance, points.shifts[:, 1], points.shifts[:, 3]])
    steps = _STEP * np.concatenate([np.eye(3), -np.eye(3)])
    moved = centre + steps[:, :, None]
    meshes = _three_meshes([*teeth.T], moved[:, 0], moved[:, 1], moved[:, 2])
    each = np.stack([one.efficiency(friction) for one in meshes], axis=-1)
    ways = np.stack(three_k_efficiencies(teeth, each))
    return np.asarray(np.moveaxis(ways[:, :3] - ways[:, 3:], 1, 2) / (2.0 * _STEP))


class _Mesh:
    """A planet gear with the sun or a ring, without backlash; lengths in modules, arrays [set point].

    Args:
        planet, mate: teeth, of a ring negative.
        shift: of the planet gear.
        distance: centre distance, positive.
        tip: tip alteration of the planet gear and of a sun; None for the one that keeps their clearance.
    """

    def __init__(
        self,
        planet: Values,
        mate: Values,
        shift: Values,
        distance: Values,
        tip: Values | float | None = 0.0,
    ) -> None:
        self.teeth, self.shift = (planet, mate), shift
        total = planet + mate
        cosine = np.abs(total) * cos(_ALPHA) / (2.0 * distance)
        self._angle = np.arccos(np.where(cosine < 1.0, cosine, np.nan))
        shift_sum = total * (np.tan(self._angle) - self._angle - _INVOLUTE) / (2.0 * tan(_ALPHA))
        self._line = distance * np.sin(self._angle)
        self.mate_shift = shift_sum - shift
        keeping = np.sign(total) * distance - total / 2.0 - shift_sum
        self.tip = np.asarray(keeping if tip is None else tip)
        mate_tip = self.tip * (mate > 0.0)
        self.tips = tuple(
            np.abs(teeth / 2.0 + 1.0 + own + altered)
            for teeth, own, altered in (
                (planet, shift, self.tip),
                (mate, self.mate_shift, mate_tip),
            )
        )
        self._reach = tuple(
            np.sqrt(np.maximum(tip**2 - (teeth / 2.0 * cos(_ALPHA)) ** 2, 0.0))
            for tip, teeth in zip(self.tips, self.teeth, strict=True)
        )
        self._parts = tuple(
            teeth / (2.0 * pi) * (reach / (np.abs(teeth) / 2.0 * cos(_ALPHA)) - np.tan(self._angle))
            for reach, teeth in zip(self._reach, self.teeth, strict=True)
        )

    @property
    def ratio(self) -> Values:
        """Contact ratio."""
        return np.asarray(self._parts[0] + self._parts[1])

    def efficiency(self, friction: float) -> Values:
        """See `mesh_efficiency`."""
        return mesh_efficiency(self.teeth, (self._parts[0], self._parts[1]), friction)

    def runs(self, task: _Task) -> np.ndarray:
        """True where teeth are neither undercut nor thin at their tips, and meet on their involutes alone."""
        (planet, mate), (reach, mate_reach) = self.teeth, self._reach
        runs = (self.ratio >= task.contact_ratio) & _tooth_is_sound(
            planet, self.shift, self.tips[0], _FILLET
        )
        if np.all(mate > 0.0):
            runs &= _tooth_is_sound(mate, self.mate_shift, self.tips[1], _SUN_FILLET)
            runs &= self._line - mate_reach >= _form_length(planet, self.shift, _FILLET)
            runs &= self._line - reach >= _form_length(mate, self.mate_shift, _SUN_FILLET)
        else:
            runs &= self.tips[1] > np.abs(mate) / 2.0 * cos(_ALPHA)
            runs &= self.mate_shift >= SHIFT.low
            runs &= _room_at_ring_root(-mate, -self.mate_shift) >= _ROOM * _FILLET
            runs &= mate_reach - self._line >= _form_length(planet, self.shift, _FILLET)
            runs &= self._line + reach <= -_form_length(mate, self.mate_shift, _FILLET)
        return np.asarray(runs)


def _form_length(teeth: Values, shift: Values, fillet: float) -> Values:
    """Where the involute of a tooth begins on the line of action, cut by a rack; of a ring negative."""
    straight = _DEDENDUM - fillet * (1.0 - sin(_ALPHA))
    return np.asarray(teeth / 2.0 * sin(_ALPHA) - (straight - shift) / sin(_ALPHA))


def _room_at_ring_root(teeth: Values, shift: Values) -> Values:
    """Largest fillet radius at the root of a ring, whose shift is that of a planet that fills it."""
    root = teeth / 2.0 + _DEDENDUM + shift
    at_root, width = _angle_and_thickness(teeth, shift, root)
    return np.asarray(width / 2.0 / np.tan(pi / 4.0 - at_root / 2.0))


def _angle_and_thickness(teeth: Values, shift: Values, radius: Values) -> tuple[Values, Values]:
    """Pressure angle and thickness of external teeth at a radius."""
    angle = np.arccos(np.clip(teeth / 2.0 * cos(_ALPHA) / radius, -1.0, 1.0))
    half = (pi / 2.0 + 2.0 * shift * tan(_ALPHA)) / teeth + _INVOLUTE - (np.tan(angle) - angle)
    return angle, 2.0 * radius * half


def _tooth_is_sound(teeth: Values, shift: Values, tip: Values, fillet: float) -> np.ndarray:
    """True for external teeth without undercut whose tips are not thin."""
    _, thickness = _angle_and_thickness(teeth, shift, tip)
    return np.asarray((thickness >= _THIN_TIP) & (_form_length(teeth, shift, fillet) >= 0.0))


def _can_be_made(teeth: np.ndarray, points: _Points) -> np.ndarray:
    """True for sets of which every mesh passes the checks of a pair."""
    made = np.ones(len(teeth), bool)
    for (first, second), sign, fillets in _PAIRS:
        made &= build_cylindrical_pairs(
            teeth=np.stack([teeth[:, first], sign * teeth[:, second]], axis=1),
            module=1.0,
            pressure_angle=_ALPHA,
            face_width=1.0,
            profile_shift=points.shifts[:, [first, second]],
            dedendum=(_DEDENDUM, _DEDENDUM),
            fillet_radius=fillets,
            tip_alteration=np.stack([points.tip * (gear < 2) for gear in (first, second)], axis=1),
            centre_distance=points.distance,
        ).good
    return made


def _dataset(teeth: np.ndarray, points: _Points, compared: int, task: _Task) -> xr.Dataset:
    i1, i2 = _basic_ratios(*teeth.T)
    each, of_gear, of_mesh = ("set",), ("set", "gear"), ("set", "mesh")
    of_variable, (by_there, by_back) = ("set", "variable"), _slopes(teeth, points, task.friction)
    columns: dict[str, tuple[tuple[str, ...], Any, str]] = {
        "ratio": (each, (1.0 + i1) / (1.0 - i2), "ratio of sun to output ring"),
        "efficiency": (each, points.there, "mean efficiency from sun to output ring"),
        "back_driving_efficiency": (each, points.back, "mean efficiency, driven back"),
        "efficiency_slope": (of_variable, by_there, "derivative of efficiency, in modules"),
        "back_driving_slope": (of_variable, by_back, "derivative of it driven back, in modules"),
        "teeth": (of_gear, teeth.astype(int), "number of teeth"),
        "profile_shift": (of_gear, points.shifts, "profile shift coefficient"),
        "contact_ratio": (of_mesh, points.ratios, "transverse contact ratio"),
        "tip_alteration": (
            each,
            points.tip,
            "tip alteration coefficient of sun and its planet gear",
        ),
        "centre_distance": (each, points.distance, "centre distance over module"),
    }
    return xr.Dataset(
        {
            name: (dims, values, {"units": "1", "long_name": words})
            for name, (dims, values, words) in columns.items()
        },
        coords={"gear": [*GEARS], "mesh": [*MESHES], "variable": [*VARIABLES]},
        attrs={"planets": task.planets, "friction": task.friction, "compared": compared},
    )
