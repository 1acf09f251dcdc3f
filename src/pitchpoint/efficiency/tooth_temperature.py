"""Temperature of plastic gear teeth in steady running, and the modulus that belongs to it."""

from typing import NamedTuple

from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.errors import InputError
from pitchpoint.materials.solids import SolidRecord, celsius, heat_failure

__all__ = [
    "ModulusInUse",
    "ToothTemperature",
    "isothermal",
    "modulus_at",
    "vdi_2736_2",
]

Each = Float[Numbers, "*#b"]

_NEAR = 10.0  # K; the modulus of a plastic hardly changes within

_FLANK_AND_ROOT = {"steel": (6300.0, 895.0), "plastic": (9000.0, 2148.0)}
"""k_theta of flank and root by the material of the mating gear [K (m/s)^0.75 mm^1.75 / W]."""


class ToothTemperature(NamedTuple):
    """Temperatures of a tooth.

    Args:
        flank: at the flank, shape (...) [K].
        root: at the root, shape (...) [K].

    Source: VDI 2736 Part 2 (2014), temperatures of flank and root.
    """

    flank: Each
    root: Each


class ModulusInUse(NamedTuple):
    """Young's modulus of a gear at its temperature.

    Args:
        young: Young's modulus, shape (...) [Pa].
        status: how it was come by, in words.
    """

    young: Each
    status: str


def isothermal(*, ambient: Each) -> ToothTemperature:
    """Teeth at the temperature of their surroundings, `ambient` [K]."""
    temperature = jnp.asarray(ambient, dtype=jnp.float64)
    return ToothTemperature(temperature, temperature)


def vdi_2736_2(
    *,
    ambient: Each,
    power: Each,
    friction: Each,
    loss_factor: Each,
    face_width: Each,
    teeth: Each,
    pitch_speed: Each,
    normal_module: Each,
    mate: str = "steel",
    housing_resistance: Each | None = None,
    housing_area: Each | None = None,
    duty: Each | float = 1.0,
) -> ToothTemperature:
    """Flank and root temperature of a plastic gear in steady running [K].

    theta = theta_0 + P mu H_V (k_theta / (b z (v m_n)^0.75) + R / A) ED^0.64, with k_theta of
    flank and root 6300 and 895 against steel, 9000 and 2148 against plastic; in the fit b and m_n
    are in mm, v in m/s, P in W.

    Args:
        ambient: theta_0, temperature around the gears, shape (...) [K].
        power: P, transmitted, shape (...) [W].
        friction: mu, mean coefficient of friction, shape (...) [1].
        loss_factor: H_V, shape (...) [1]; P mu H_V is the heat.
        face_width: b, common to both gears, shape (...) [m].
        teeth: z of the gear whose temperature is asked for, shape (...) [1].
        pitch_speed: v, speed of the pitch line, shape (...) [m/s]; at 0 the teeth stay at the
            temperature of the housing.
        normal_module: m_n, shape (...) [m].
        mate: material of the mating gear, "steel" or "plastic".
        housing_resistance: R, resistance of the housing to the passage of heat, shape (...)
            [K m2/W]: 0 open, 0.015 to 0.045 half open, 0.06 closed.
        housing_area: A, outer surface of the housing, shape (...) [m2]; both or neither, neither
            is an open drive.
        duty: ED, share of the time for which the drive runs under load, 0 to 1, shape (...) [1].

    Returns:
        Flank and root temperature, broadcast shape of the arguments [K].

    Raises:
        InputError: `mate` is not a known material, or only one of R and A is given.

    Validity:
        Plastic gears without filler, dry or greased; the range of the fit is not stated in what
        was at hand. One coefficient serves for all plastics: the conductivity does not enter.
        The heat of hysteresis is not counted on its own.

    Source:
        VDI 2736 Part 2 (2014), equation 9, as two public programs have it (Fernandes 2022, without
        ED; tkuhn39 2026). Both take the pinion's number of teeth for either gear. The gear's own
        is taken here: with a pinion of 4 teeth the other reading gives a rise of 900 K at 79 W.

    Example:
        >>> wheel = vdi_2736_2(ambient=293.15, power=79.2, friction=0.2, loss_factor=0.53,
        ...     face_width=16e-3, teeth=51, pitch_speed=0.602, normal_module=1.5e-3)
        >>> round(float(wheel.flank) - 293.15)
        70
    """
    width, module = 1e3 * jnp.asarray(face_width), 1e3 * jnp.asarray(normal_module)
    flank, root = _coefficients(mate)
    passage = _power(jnp.asarray(pitch_speed) * module, -0.75) / (width * teeth)
    housing = _housing(housing_resistance, housing_area)
    heat = jnp.asarray(power) * friction * loss_factor * _power(jnp.asarray(duty), 0.64)
    return ToothTemperature(
        ambient + heat * (flank * passage + housing), ambient + heat * (root * passage + housing)
    )


def _coefficients(mate: str) -> tuple[float, float]:
    if mate not in _FLANK_AND_ROOT:
        raise InputError(
            f'"{mate}" is not the material of a mating gear; it is steel or plastic',
            allowed=_FLANK_AND_ROOT,
        )
    return _FLANK_AND_ROOT[mate]


def _power(base: Each, exponent: float) -> Each:
    """Power of a positive number; 0 where the base is 0, with a finite gradient."""
    positive = base > 0.0
    return jnp.where(positive, jnp.exp(exponent * jnp.log(jnp.where(positive, base, 1.0))), 0.0)


def _housing(resistance: Each | None, area: Each | None) -> Each:
    if resistance is None and area is None:
        return jnp.asarray(0.0)
    if resistance is None or area is None:
        raise InputError("a housing needs both its thermal resistance and its outer area")
    return jnp.asarray(resistance) / area


def modulus_at(record: SolidRecord, temperature: float) -> ModulusInUse:
    """Young's modulus of a gear at its temperature, and how it was come by.

    The modulus changes deflection, load sharing, pressure and film, and with them the loss that heats the
    tooth: `warm_teeth` finds both in balance.

    Args:
        record: material of the gear.
        temperature: of its teeth [K].

    Returns:
        Modulus [Pa] and its status in words.

    Raises:
        InputError: the temperature is outside the material's table of moduli.

    Example:
        >>> from pitchpoint.materials import solids
        >>> modulus_at(solids.find("POM-H"), 333.15).status
        'POM-H: its modulus is known from -40 degC to 100 degC, interpolated at 60 degC (values assumed)'
    """
    young = record.build(temperature).young
    if not record.young_at:
        remark = f"the same value is used at {celsius(temperature)}{_softer(record, temperature)}"
    else:
        statuses = dict.fromkeys(point.young.status for point in record.young_at)
        remark = f"interpolated at {celsius(temperature)} (values {' and '.join(statuses)})"
    return ModulusInUse(young, f"{record.name}: {record.modulus_known}, {remark}")


def _softer(record: SolidRecord, temperature: float) -> str:
    """Consequence of a modulus that was found well below the temperature."""
    if fails := heat_failure(record, temperature):
        return f"; {fails}"
    measured = record.young_temperature
    if measured is None or temperature < measured.value + _NEAR:
        return ""
    return ", where the true one is lower: stiffness comes out too high, transmission error too low"
