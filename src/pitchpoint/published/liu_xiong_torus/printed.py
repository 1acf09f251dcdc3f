"""Formulas as Liu and Xiong print them, beside what their derivation asks for."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil, floor, sin

import numpy as np
from jaxtyping import Array, Float
from numpy.typing import ArrayLike, NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.ellipse import hamrock_brewe_1983, hertz_1881
from pitchpoint.contact.hertz import line_pressure
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import Design, Operation
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.pairs import largest_inclination
from pitchpoint.gears.torus.family import middle_pair
from pitchpoint.gears.torus.pair import TorusPair
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.lubrication.film_thickness import dowson_higginson_1959, hamrock_dowson_1977
from pitchpoint.materials.solids import Solid
from pitchpoint.published.liu_xiong_torus import steady
from pitchpoint.published.liu_xiong_torus.printed_figures import (
    CYCLE_COURSES,
    INSTANTS,
    LINES,
    TorusOil,
    cycle_places,
    motion_figures,
)
from pitchpoint.published.liu_xiong_torus.printed_motion import Piece, TorusDrive, torus_motion
from pitchpoint.published.liu_xiong_torus.publication import PAIRS
from pitchpoint.published.liu_xiong_torus.steady import TorusSprings
from pitchpoint.published.liu_xiong_torus.stiffness import library_stiffness, linear_interpolation
from pitchpoint.published.liu_xiong_torus.table import TorusFormulas
from pitchpoint.published.publication import Read, ReadingPoint

__all__ = ["hand_over_pieces", "pair_stiffness", "readings"]

Values = NDArray[np.float64]
Numbers = Sequence[float] | Values
Known = dict[str, Float[Arrays, "..."]]


_DEGREE = 4


_ROLLS = 157
"""Roll angles at which the stiffness of a pair is kept, some 0.1 deg apart."""

_INSIDE = 1e-9
"""Relative distance of these from the ends of the path."""

_SEMI_AXIS = 2e-3
"""Of the ellipse for which the reference calculation tells the largest tilt [m]."""


def pair_stiffness(*, roll: Numbers, stiffness: Numbers) -> Values:
    """Coefficients of powers 1 to 4 of the roll angle, by least squares.

    The polynomial is zero at the entry of a pair: with one that is not, the extremes of Table 4 miss by
    four times as much.

    Args:
        roll: angle of the pinion since the entry, shape (place) [rad].
        stiffness: of the pair there, shape (place) [N/m].

    Source: Liu and Xiong, text under Table 1; the zero at the entry is fitted.

    Example:
        >>> pair_stiffness(roll=[0.1, 0.2, 0.3, 0.4], stiffness=[1e8, 2e8, 3e8, 4e8]).round(-3)[0]
        np.float64(1000000000.0)
    """
    powers = np.asarray(roll)[:, None] ** np.arange(1, _DEGREE + 1)
    coefficients = np.linalg.lstsq(powers, np.asarray(stiffness), rcond=None)[0]
    return np.asarray(coefficients)


def hand_over_pieces(*, single: float, pitch: float, cycles: float) -> Piece:
    """What lies between neighbouring hand-overs from the start on.

    Args:
        single: part of the mesh cycle t_Cp/t_c at which the older pair leaves.
        pitch: that at which a pair passes the pitch point, t_p/t_c less whole cycles.
        cycles: mesh cycles in all.
    """
    cuts, count = np.unique([0.0, single, pitch, 1.0]), ceil(cycles)
    gone = np.repeat(np.arange(float(count)), cuts.size - 1)
    start, stop = (np.tile(part, count) for part in (cuts[:-1], cuts[1:]))
    stop = np.minimum(stop, cycles - gone)
    there = stop > start
    return Piece(
        gone=array(gone[there]),
        start=array(start[there]),
        stop=array(stop[there]),
        older=jnp.asarray((start < single)[there]),
    )


def readings(point: ReadingPoint) -> Read:
    """What the formulas give for a torus pair, under the names of result variables."""
    mesh, gears = point.design.mesh, point.gears
    if not isinstance(mesh, TorusPair) or not isinstance(gears, TorusGears):
        return {}
    at_pitch = jax.device_get(_contact(point.design, point.operation))
    return {
        **_durations(mesh, float(point.operation.speed)),
        **{name: float(value) for name, value in at_pitch.items()},
        **_quadratic(gears),
        **_literal(point, mesh),
        **_steady(point, mesh),
    }


def _durations(mesh: TorusPair, speed: float) -> dict[str, float]:
    """Key durations, eqs. 1 to 3, and what they rest on."""
    line: Known = jax.device_get(_line(mesh))
    (pinion_radius, gear_radius), pitch = line["base_radii"].tolist(), float(line["base_pitch"])
    return {
        "base_radius_pinion": pinion_radius,
        "base_radius_gear": gear_radius,
        "line_of_action": float(line["tangent"]),
        "single_contact_start": float(line["single"]),
        "pitch_point_passed": float(line["pitch"]),
        "contact_roll": float(line["ratio"]) * pitch / pinion_radius,
        "mesh_rate": speed * pinion_radius / pitch,
        **{name: float(line[name]) for name in ("transverse_radius", *_MISALIGNED)},
    }


_MISALIGNED = ("contact_place", "misalignment_approach")


@program
def _line(mesh: TorusPair) -> Known:
    """Places on the line of action, and where across the face the flanks touch."""
    line = mesh.line
    start, end = line.limits
    ratio = (end - start) / line.base_pitch
    return {
        "base_radii": line.base_radii,
        "tangent": line.tangent_length,
        "entry": start,
        "base_pitch": line.base_pitch,
        "ratio": ratio,
        "single": ratio - 1.0,
        "pitch": (line.pitch_position - start) / line.base_pitch,
        "transverse_radius": mesh.transverse_radius,
        "contact_place": mesh.place,
        "misalignment_approach": mesh.misalignment_approach,
    }


@program
def _contact(design: Design, operation: Operation) -> Known:
    """Contact and film of a pair that carries all at the pitch point, in points and along a line."""
    mesh = design.mesh
    assert isinstance(mesh, TorusPair)
    line = mesh.line
    place = line.pitch_position
    load, radius = operation.load / line.base_radii[1], place * (1.0 - place / line.tangent_length)
    points = {"load": load, "transverse_radius": mesh.transverse_radius}
    lines = {"line_load": load / mesh.face_width}
    both = {"radius": radius, "modulus": design.modulus}
    oil = {
        "entrainment": operation.speed * place,
        "viscosity": design.lubricant.viscosity(operation.temperature),
        "pressure_viscosity": design.lubricant.pressure_viscosity(operation.temperature),
    }
    films = (
        hamrock_dowson_1977(**points, **both, **oil),
        dowson_higginson_1959(**lines, **both, **oil),
    )
    exact, near = hertz_1881(**points, **both), hamrock_brewe_1983(**points, **both)
    return {
        "static_force": load,
        "tilt_limit": largest_inclination(mesh, exact.across),
        "tilt_limit_2_mm": largest_inclination(mesh, jnp.asarray(_SEMI_AXIS)),
        "ellipse_across": exact.across,
        "ellipse_along": exact.along,
        "ellipse_pressure": exact.pressure,
        "regressed_across": near.across,
        "regressed_along": near.along,
        "regressed_pressure": near.pressure,
        "line_pressure": line_pressure(**lines, **both),
        "printed_pressure": line_pressure(line_load=load, **both),
        "torus_pitch_film": films[0],
        "standard_pitch_film": films[1],
        "film_ratio": films[0] / films[1],
    }


def _quadratic(gears: TorusGears) -> dict[str, float]:
    """Where the contact goes if the inclination meets a parabola between the flanks, and what it costs."""
    pinion_radius, gear_radius = gears.torus_radius
    radius = 1.0 / (sin(gears.pressure_angle) * (1.0 / pinion_radius - 1.0 / gear_radius))
    return {
        "quadratic_place": -gears.inclination * radius,
        "quadratic_approach": gears.inclination**2 * radius / 2.0,
        "quadratic_tilt_limit": (min(gears.face_width) / 2.0 - _SEMI_AXIS) / radius,
    }


def _literal(point: ReadingPoint, mesh: TorusPair) -> Read:
    """The motion of both pairs by the equations as printed; nothing without their inputs."""
    formulas = point.formulas
    if not isinstance(formulas, TorusFormulas):
        return {}
    conditions: Known = jax.device_get(
        {**_conditions(point.design, point.operation), **_line(mesh)}
    )
    turn = _pieces(conditions, formulas)
    cycles = float(floor(formulas.mesh_cycles))
    oil = TorusOil(array(conditions["pressure_viscosity"]), array(cycles))
    reading: dict[str, float | Values] = {
        "start_cycles": np.linspace(0.0, formulas.mesh_cycles, INSTANTS),
        "start_orders": np.arange(1.0, LINES + 1.0) / cycles,
        "cycle_part": np.asarray(cycle_places()),
    }
    drives = {name: _drive(name, point, conditions) for name in PAIRS}
    for name, drive in drives.items():
        pair_figures = jax.device_get(motion_figures(drive, torus_motion(drive, turn), oil))
        _check_found(name, pair_figures)
        reading |= _named(name, pair_figures)
    power = float(point.operation.speed) * float(drives["torus"].input_torque)
    return {**reading, **_beside(reading, power), **_stiffness(point, conditions, drives)}


def _stiffness(point: ReadingPoint, conditions: Known, drives: Mapping[str, TorusDrive]) -> Read:
    """Stiffness of a pair of teeth over its path: of the library, as given, and as the motion has it."""
    formulas = point.formulas
    assert isinstance(formulas, TorusFormulas)
    path = np.linspace(_INSIDE, 1.0 - _INSIDE, _ROLLS) * float(conditions["ratio"])
    roll = path * _roll_of(conditions)
    curves: dict[str, Values] = {"stiffness_roll": roll}
    for name in PAIRS:
        rolls, springs = (
            np.asarray(getattr(formulas, f"{name}_{of}")) for of in ("roll", "stiffness")
        )
        if name != "torus":
            springs = formulas.standard_scale * springs
        library = library_stiffness(*_teeth(name, point), float(point.operation.load), path)
        curve = [0.0, *np.asarray(drives[name].coefficients)]
        by_source = {
            "given": linear_interpolation(roll, rolls, springs),
            "motion": np.polynomial.polynomial.polyval(roll, curve),
            **library,
        }
        curves |= {f"{name}_{source}_stiffness": values for source, values in by_source.items()}
    return curves


def _roll_of(line: Known) -> float:
    """Roll angle of the pinion for one base pitch [rad]."""
    return float(line["base_pitch"] / line["base_radii"][0])


def _teeth(name: str, point: ReadingPoint) -> tuple[Mesh, Array, tuple[Solid, Solid], Terms]:
    """Pair of gears, materials and terms by which its teeth yield."""
    design = point.design
    return _mesh(name, point), design.loaded, design.solids, point.models[0].compliance


def _mesh(name: str, point: ReadingPoint) -> Mesh:
    assert isinstance(point.gears, TorusGears)
    return point.design.mesh if name == "torus" else middle_pair(point.gears)


def _named(pair: str, figures: Mapping[str, Values | Array]) -> dict[str, float | Values]:
    """Numbers and courses of a pair."""
    return {
        f"{pair}_{key}": np.asarray(value) if np.ndim(value) else float(value)
        for key, value in figures.items()
    }


def _check_found(name: str, figures: Known) -> None:
    numbers = [value for key, value in figures.items() if key not in CYCLE_COURSES]
    if not all(np.all(np.isfinite(value)) for value in numbers):
        raise ConvergenceError(
            f"the motion of the {name} pair by the printed equations was not found: it grows without bound, "
            "or takes more steps than are allowed"
        )


def _beside(reading: Read, power: float) -> Read:
    """Torus pair over standard pair, and less it; of the power put in [W]."""
    sliding = np.subtract(reading["standard_friction_heat"], reading["torus_friction_heat"]) / power
    torus, standard = (reading[f"{name}_film_0"] + reading[f"{name}_film_1"] for name in PAIRS)
    return {
        "error_ratio": reading["torus_largest_error"] / reading["standard_largest_error"],
        "friction_ratio": reading["torus_sliding_friction"] / reading["standard_sliding_friction"],
        "printed_film_ratio": torus / standard,
        "torus_less_standard_sliding_efficiency": float(sliding),
        **{
            f"torus_less_standard_{figure}": reading[f"torus_{name}"] - reading[f"standard_{name}"]
            for figure, name in _LESS.items()
        },
    }


_LESS = {"friction": "sliding_friction", "efficiency": "printed_efficiency"}
"""What is told of the torus pair less the standard pair."""


def _steady(point: ReadingPoint, mesh: TorusPair) -> Read:
    """The motion of both pairs in steady state by the corrected equations, where it is asked for."""
    formulas = point.formulas
    if not isinstance(formulas, TorusFormulas) or formulas.steady_pinion is None:
        return {}
    conditions: Known = jax.device_get(
        {**_conditions(point.design, point.operation), **_line(mesh)}
    )
    reading: dict[str, float | Values] = {
        "steady_cycles": np.linspace(0.0, 1.0, steady.INSTANTS),
        "steady_orders": np.arange(1.0, steady.ORDERS + 1.0),
    }
    for name in PAIRS:
        springs = _springs(_drive(name, point, conditions), conditions, formulas)
        design = replace(point.design, mesh=_mesh(name, point))
        reading |= _named(name, steady.steady_figures(design, point.operation, springs))
    over = {name: reading[f"torus_{name}"] / reading[f"standard_{name}"] for name in _OVER}
    return {**reading, **{f"{name}_ratio": value for name, value in over.items()}}


_OVER = ("steady_friction", "steady_film")


def _springs(drive: TorusDrive, conditions: Known, formulas: TorusFormulas) -> TorusSprings:
    """Bodies and springs of the corrected equations; a place on the path is counted in base pitches."""
    roll = _roll_of(conditions)
    by_roll, powers = np.asarray(drive.coefficients), np.arange(1, _DEGREE + 1)
    coefficients, ratio = by_roll * roll**powers, float(conditions["ratio"])
    return TorusSprings(
        mass=drive.mass,
        inertia=drive.inertia,
        joint_mass=drive.joint_mass,
        coefficients=array(coefficients),
        mean=array(np.sum(coefficients * ratio ** (powers + 1) / (powers + 1))),
        bearing=drive.bearing,
        bearing_damping=drive.bearing_damping,
        mesh_damping=drive.mesh_damping,
        error=drive.error,
        held=formulas.steady_pinion == "held",
    )


def _pieces(line: Known, formulas: TorusFormulas) -> Piece:
    single, pitch = float(line["single"]), float(line["pitch"])
    if not 0.0 < single < 1.0:
        raise InputError(
            "the equations have one pair of teeth in turn with two; the contact ratio is "
            f"{single + 1.0:.4g}",
            key="formulas",
        )
    return hand_over_pieces(single=single, pitch=pitch % 1.0, cycles=formulas.mesh_cycles)


@program
def _conditions(design: Design, operation: Operation) -> Known:
    """Materials, oil and masses as the equations take them; both gears are solid discs."""
    mesh, oil, temperature = design.mesh, design.lubricant, operation.temperature
    assert isinstance(mesh, TorusPair)
    radii = jnp.stack([gear.reference_radius for gear in mesh.gears])
    mass = jnp.stack([solid.density for solid in design.solids]) * jnp.pi * radii**2 * mesh.widths
    return {
        "inertia": mass * radii**2 / 2.0,
        "mass": mass,
        "teeth": mesh.teeth[0],
        "face_width": mesh.face_width,
        "modulus": design.modulus,
        "viscosity": oil.viscosity(temperature),
        "pressure_viscosity": oil.pressure_viscosity(temperature),
    }


_OF_LINE = ("base_radii", "tangent", "entry", "base_pitch", "transverse_radius")
_OF_CONDITIONS = ("inertia", "mass", "teeth", "modulus", "viscosity", "face_width")


def _drive(name: str, point: ReadingPoint, conditions: Known) -> TorusDrive:
    formulas, operation = point.formulas, point.operation
    assert isinstance(formulas, TorusFormulas)
    numbers: dict[str, ArrayLike] = {
        "coefficients": _coefficients(name, point, conditions),
        "pointed": float(name == "torus"),
        "radius_factor": formulas.radius_factor,
        "bearing": formulas.bearing_stiffness,
        "bearing_damping": formulas.bearing_damping,
        "mesh_damping": formulas.mesh_damping,
        "error": formulas.error,
        "roughness": formulas.roughness,
        "speed": operation.speed,
        "torque": operation.load,
    }
    of_mesh = {key: conditions[key] for key in (*_OF_LINE, *_OF_CONDITIONS)}
    values = {key: jnp.asarray(value, float) for key, value in {**of_mesh, **numbers}.items()}
    return TorusDrive(**values, radii=formulas.radius)


def _coefficients(name: str, point: ReadingPoint, conditions: Known) -> Values:
    """Polynomial on which the motion runs, see `pair_stiffness`; InputError if it is negative somewhere.

    The library's stiffness is taken at the roll angles of Table 1 that lie on the path, as the table has it.
    """
    formulas = point.formulas
    assert isinstance(formulas, TorusFormulas)
    rolls, springs = (np.asarray(getattr(formulas, f"{name}_{of}")) for of in ("roll", "stiffness"))
    if formulas.stiffness == "library":
        rolls = np.asarray(formulas.torus_roll)
        path = rolls / _roll_of(conditions)
        there = path < float(conditions["ratio"])
        _check_places(int(there.sum()), conditions)
        rolls, load = rolls[there], float(point.operation.load)
        springs = library_stiffness(*_teeth(name, point), load, path[there])["secant"]
    elif name != "torus":
        rolls, springs = _filled(formulas, rolls, springs)
    coefficients = pair_stiffness(roll=rolls, stiffness=springs)
    key = "stiffness" if formulas.stiffness == "library" else f"{name}_stiffness"
    _check_stiffness(key, coefficients, conditions)
    return coefficients


def _check_places(there: int, line: Known) -> None:
    """InputError if fewer roll angles lie on the path than the polynomial has coefficients."""
    if there < _DEGREE:
        end = np.rad2deg(_roll_of(line) * float(line["ratio"]))
        raise InputError(
            f"{there} of these roll angles lie on the path of a pair, which ends at {end:.4g} deg; the "
            f"library's stiffness is taken at {_DEGREE} of them at least",
            key="formulas.torus_roll",
        )


def _check_stiffness(key: str, coefficients: Values, line: Known) -> None:
    """InputError if the polynomial is negative somewhere on the way of a pair."""
    end = float(line["ratio"] * line["base_pitch"] / line["base_radii"][0])
    roll = np.linspace(0.0, end, 201)[1:]
    values = np.polynomial.polynomial.polyval(roll, [0.0, *coefficients])
    if values.min() <= 0.0:
        raise InputError(
            f"the polynomial through these stiffnesses is {1e-6 * values.min():.4g} N/um at "
            f"{np.rad2deg(roll[values.argmin()]):.4g} deg; a pair of teeth needs a positive stiffness",
            key=f"formulas.{key}",
        )


def _filled(formulas: TorusFormulas, rolls: Values, springs: Values) -> tuple[Values, Values]:
    """Stiffness of the standard pair at the roll angles of the torus pair, by a polynomial of degree 4."""
    every = np.asarray(formulas.torus_roll)
    smooth = np.polynomial.Polynomial.fit(rolls, springs, _DEGREE)
    return every, formulas.standard_scale * smooth(every)
