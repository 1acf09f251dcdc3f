"""Pairs that are rated, each program traced once."""

from dataclasses import replace
from functools import cache
from math import nan, pi, radians
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from pitchpoint.efficiency.summary import of_stacks, stacks
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.rated_pair import bare_pair
from pitchpoint.materials.solids import Solid
from pitchpoint.strength.limits import Constants
from pitchpoint.strength.load_factors import CLASSES
from pitchpoint.strength.rating import ROWS, Duty, Factors, Finish, Strengths, ratings
from pitchpoint.strength.treatments import PLASTIC, TREATMENTS

Found = dict[str, np.ndarray]
CASE = TREATMENTS["case_hardened"]
STEEL = Solid(young=210e9, poisson=0.3, density=7850.0)


def numbers(*values: float) -> jax.Array:
    return jnp.asarray(np.array(values if len(values) > 1 else values[0], float))


@cache
def base_pair() -> CylindricalPair:
    """A pair whose dimensions the others replace: no program for each."""
    pair = build_cylindrical_pair(
        teeth=(20, 30),
        module=1e-3,
        pressure_angle=radians(20.0),
        face_width=0.01,
        centre_distance=25e-3,
        tip_alteration=(0.0, 0.0),
    )
    return bare_pair(pair)


def with_circles(
    base: CylindricalPair, *, teeth: tuple[int, int], module: float, tips: Any, **values: Any
) -> CylindricalPair:
    """A pair with tip diameters by value [m], cut with the profile shifts that it has."""
    helix = values.get("helix_angle", 0.0)
    shifts = np.array(values.pop("profile_shift"), float)
    reference = np.array(teeth) * module / np.cos(helix)
    alteration = (np.array(tips) - reference) / 2.0 / module - 1.0 - shifts
    return replace(
        base,
        teeth=numbers(*teeth),
        module=numbers(module),
        profile_shift=jnp.asarray(shifts),
        tip_alteration=jnp.asarray(alteration),
        **{name: jnp.asarray(np.array(value, float)) for name, value in values.items()},
    )


def strengths(**changed: Any) -> Strengths:
    """Two case-hardened steel gears unless told otherwise."""
    plastic = changed.pop("plastic", (False, False))
    treatments = [PLASTIC if one else CASE for one in plastic]
    usual = {
        "solids": (STEEL, STEEL),
        "flank": numbers(1510e6, 1510e6),
        "root": numbers(475e6, 475e6),
        "work_hardening": numbers(1.0, 1.0),
        "mean_stress": numbers(1.0, 1.0),
        "over_cycles": jnp.full((4, 2), nan),
    }
    constants = Constants.of(treatments[0], treatments[1])
    return Strengths(constants=constants, plastic=jnp.asarray(plastic), **usual | changed)


def factors(**changed: float) -> Factors:
    usual = dict.fromkeys(("application", "dynamic", "face", "transverse"), 1.0)
    usual |= {"root_face": nan, "root_transverse": nan, "accurate": 0.0, "correction": 1.2}
    usual |= dict(zip(("spur", "helical"), CLASSES[6], strict=True))
    return Factors(**{name: numbers(value) for name, value in (usual | changed).items()})


def duty(load: float, rpm: float, flank: float = 5e7, root: float = 3e6) -> Duty:
    speed = rpm * pi / 30.0
    cycles = numbers(flank, flank), numbers(root, root)
    return Duty(numbers(load), numbers(speed), *cycles, driver=numbers(1.0, 0.0))


FINISH = Finish(numbers(0.0, 0.0), numbers(1.8e-6), numbers(20e-6, 20e-6), numbers(90.02e-6))


def rating(
    pair: CylindricalPair,
    asked: Duty,
    loads: Factors,
    of: Strengths,
    finish: Finish = FINISH,
    ends: Any = (nan, nan),
) -> Found:
    one = [(pair, jnp.asarray(np.array(ends)), asked, loads, of, finish)]
    found = of_stacks((ratings(*rows), used) for rows, used in stacks(one, ROWS))
    return {name: values[0] for name, values in found.items()}


# ---- printed by other programs


@cache
def fzg_ratings() -> Found:
    """FZG test gears type C, by STplus 11.1F after ISO 6336:2019; cut with the shifts x_E."""
    pair = with_circles(
        base_pair(),
        teeth=(16, 24),
        module=4.5e-3,
        tips=(82.45e-3, 118.35e-3),
        profile_shift=(0.1559, 0.1454),
        centre_distance=91.5e-3,
        face_width=14e-3,
        dedendum=(1.39, 1.39),
        fillet_radius=(0.25, 0.25),
    )
    loads = factors(dynamic=1.03, face=1.32)
    return rating(pair, duty(195.0, 1500.0), loads, strengths())


def kst_e(base: CylindricalPair) -> CylindricalPair:
    """A pair of steel and plastic with long tip clearances, cut by two tools; common face width."""
    return with_circles(
        base,
        teeth=(51, 52),
        module=1e-3,
        tips=(52.894e-3, 53.788e-3),
        profile_shift=(-0.2030, 0.0117),
        centre_distance=52e-3,
        face_width=15e-3,
        dedendum=(1.1, 1.25),
        fillet_radius=(0.2, 0.2),
    )


# Reports of KISSsoft 03/2017 by ISO 6336:2006 method B for the gears of a 5 MW wind turbine stand in
# gfsReboucas/Drivetrain, @NREL_5MW/stage_01.rtf and stage_03.rtf.
def kisssoft(**changed: Any) -> Strengths:
    """Case-hardened steel of quality MQ."""
    steel = Solid(young=206e9, poisson=0.3, density=7830.0)
    usual = {"flank": numbers(1500e6, 1500e6), "root": numbers(430e6, 430e6)}
    return strengths(solids=(steel, steel), **usual | changed)
