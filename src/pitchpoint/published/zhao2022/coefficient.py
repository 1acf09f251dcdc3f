"""Wear coefficient in mixed lubrication, eqs. 9, 10 and 29 to 31, relative to a reference contact.

The paper gives no number by which the coefficient could be computed: the regression of eq. 29 changes by a
factor of 43 over usual oils. So K ψ L_a / 100 is stated for one contact, and the equations carry it to
others: eq. 29 its K, eq. 10 its ψ, eq. 9 its L_a. Dry flanks have the K of the reference whatever the oil.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos

import numpy as np

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.lubrication.asperity_load import masjedi_khonsari_2012_regression
from pitchpoint.lubrication.flash_temperature import Conductor, shared_flash
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.zhao2022.printed import HALF_ZONE
from pitchpoint.published.zhao2022.table import FlankWear, StatedContact
from pitchpoint.wear.film_defect import fractional_film_defect
from pitchpoint.wear.laws import janakiraman_2013

__all__ = ["MixedLubrication", "mixed_lubrication"]


@dataclass(frozen=True)
class MixedLubrication:
    """Coefficients of a contact.

    Attributes:
        coefficient: K ψ L_a / 100 of the contact [1].
        reference: the same of the reference [1].
        dry: K of dry flanks, which knows of no oil [1].
        readings: these and what moved them, by the names of result variables.
    """

    coefficient: float
    reference: float
    dry: float
    readings: Mapping[str, float]


def mixed_lubrication(
    point: ReadingPoint, *, tip_angle: float, tip_force: float
) -> MixedLubrication:
    """Coefficients of the tip of new flanks, for a case with its table.

    Args:
        point: torque, speed, oil, solids and roughness of the case.
        tip_angle: flank angle at the first point [rad].
        tip_force: tangential force of a tooth there [N].
    """
    table, gears, mesh = point.formulas, point.gears, point.design.mesh
    assert isinstance(table, FlankWear)
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(mesh, StrainWave)
    oil, temperature = point.design.lubricant, point.operation.temperature
    held, reference = table.coefficient_load == "reference", table.reference
    case = {
        "line_load": reference.line_load if held else tip_force / gears.face_width,
        "speed": float(point.operation.speed),
        "temperature": float(temperature),
        "roughness": float(point.design.roughness.composite_rq),
        "modulus": float(point.design.modulus),
        "viscosity": float(oil.viscosity(temperature)),
        "pressure_viscosity": float(oil.pressure_viscosity(temperature)),
        "hardness": table.hardness,
    }
    both = {
        field: array(np.array([getattr(reference, field), case[field]]))
        for field in StatedContact.model_fields
    }
    # A strip of one pitch, whatever the number of points: the step that the paper takes.
    length = table.flank_length * gears.module
    strip = length * 2.0 * np.pi / gears.teeth[0] / HALF_ZONE
    wave, flexspline, _ = np.asarray(point.design.motion)
    passing = abs(float(flexspline - wave)) * length / HALF_ZONE
    capacity = float(point.design.solids[0].density) * table.specific_heat
    values = _laws(
        both,
        {
            "radius": array(table.equivalent_radius),
            "passing": array(passing),
            "strip": array(strip),
            "friction_per_area": array(table.friction / strip / cos(tip_angle)),
            "adsorption_heat": array(table.adsorption_heat),
            "molecule_diameter": array(table.molecule),
            "vibration_period": array(table.vibration_period),
        },
        Conductor(conductivity=table.conductivity, heat_capacity=capacity),
    )
    laws = {name: np.asarray(value) for name, value in values.items()}
    share = np.minimum(laws["asperity_regression"], 1.0)
    ratios = {
        name: float(pair[1] / pair[0])
        for name, pair in (*laws.items(), ("share", share))
        if name != "flash"
    }
    moved = ratios["regression"] * ratios["defect"] * ratios["share"]
    dry = table.coefficient / float(laws["defect"][0] * share[0])
    beyond = laws["asperity_regression"][1] > 1.0
    return MixedLubrication(
        coefficient=table.coefficient * moved,
        reference=table.coefficient,
        dry=dry,
        readings={
            "dry_coefficient": dry,
            "wear_regression_ratio": ratios["regression"],
            "adsorbed_film_defect": float(laws["defect"][1]),
            "film_defect_ratio": ratios["defect"],
            "tip_asperity_share": float(share[1]),
            "asperity_share_ratio": ratios["share"],
            "asperity_regression": float(laws["asperity_regression"][1]),
            "asperity_regression_status": float(Code.HELD if beyond else Code.SOLVED),
            "tip_flash": float(laws["flash"][1]),
        },
    )


@program
def _laws(
    contact: Mapping[str, jax.Array], of_case: Mapping[str, jax.Array], flank: Conductor
) -> dict[str, jax.Array]:
    """Eqs. 9, 10 and 29 at the reference and at the case, shape (2) each.

    One flank passes the strip at the speed of sliding and takes all the heat, the other stays under it; the
    limit of fast surfaces makes it warmer than it is. Entrainment is half the sliding.
    """
    sliding = of_case["passing"] * contact["speed"]
    flash = shared_flash(
        heat=of_case["friction_per_area"] * contact["line_load"] * sliding,
        half_width=of_case["strip"] / 2.0,
        speed_a=sliding,
        speed_b=jnp.zeros_like(sliding),
        bodies=(flank, flank),
    )
    oil = {name: contact[name] for name in ("modulus", "pressure_viscosity")}
    return {
        "flash": flash,
        "defect": fractional_film_defect(
            sliding=sliding,
            temperature=contact["temperature"] + flash,
            adsorption_heat=of_case["adsorption_heat"],
            molecule_diameter=of_case["molecule_diameter"],
            vibration_period=of_case["vibration_period"],
        ),
        "asperity_regression": masjedi_khonsari_2012_regression(
            line_load=contact["line_load"],
            entrainment=sliding / 2.0,
            viscosity=contact["viscosity"],
            radius=of_case["radius"],
            roughness_rq=contact["roughness"],
            hardness=contact["hardness"],
            **oil,
        ),
        "regression": janakiraman_2013(
            line_load=contact["line_load"],
            radius=of_case["radius"],
            ra_1=contact["roughness"],
            ra_2=jnp.zeros_like(contact["roughness"]),
            **oil,
        ),
    }
