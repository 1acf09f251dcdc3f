"""Heat, modulus and friction of plastic gears in balance: teeth as warm as their own loss makes them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, Status
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.efficiency.summary import tooth_heat_figures
from pitchpoint.efficiency.tooth_temperature import ToothTemperature
from pitchpoint.gears.contact_lines import pitch_point

__all__ = ["ToothHeating", "WarmTeeth", "warm_teeth", "warm_teeth_program"]

TOLERANCE = 1e-11
"""Relative change of the temperatures of a pass at which they are in balance."""

MOST = 40
"""Largest number of passes; friction hardly depends on the modulus, and two to five are usual."""


# What is zero, as the loss of teeth without friction, would make a change of 0/0.
_TINY = 1e-300


class ToothHeating(eqx.Module):
    """What decides how warm the teeth get, beside the loss.

    Attributes:
        plastic: True for the gears that warm up; others stay at the temperature around them.
        known: temperatures of the table of moduli of each gear, at least two, ascending [K].
        moduli: Young's moduli there [Pa].
        teeth: numbers of teeth in magnitude.
        module: normal module [m].
        housing: thermal resistance over outer area of the housing [K/W]; zero for an open drive.
        duty: share of the time under load.
        mates: material of each gear's mate, "steel" or "plastic"; static.
        function: of the thermal model; static.

    Source: VDI 2736 Part 2 (2014), what its temperatures ask for.
    """

    plastic: Bool[Array, "2"]
    known: Float[Array, "2 point"]
    moduli: Float[Array, "2 point"]
    teeth: Float[Array, "2"]
    module: Float[Array, ""]
    housing: Float[Array, ""]
    duty: Float[Array, ""]
    mates: tuple[str, str] = eqx.field(static=True)
    function: Callable[..., ToothTemperature] = eqx.field(static=True)


class WarmTeeth(eqx.Module):
    """Teeth in balance with their loss.

    Attributes:
        mean_friction, loss_factor: of the warm teeth; P mu H_V is the heat.
        flank, root: temperatures of both gears [K].
        young: Young's moduli at the roots [Pa].
        status: of the fixed point; the residual is the last relative change of the temperatures.

    Source: VDI 2736 Part 2 (2014), see `warm_teeth`.
    """

    mean_friction: Float[Array, ""]
    loss_factor: Float[Array, ""]
    flank: Float[Array, "2"]
    root: Float[Array, "2"]
    young: Float[Array, "2"]
    status: Status


@program
def warm_teeth_program(
    design: Design, operation: Operation, models: Models, heated: ToothHeating
) -> WarmTeeth:
    """`warm_teeth` as a program that is kept."""
    return warm_teeth(design, operation, models, heated)


def warm_teeth(
    design: Design, operation: Operation, models: Models, heated: ToothHeating
) -> WarmTeeth:
    """Temperatures at which the loss of the teeth, with the modulus that they have there, is their heat.

    A pure function that can be traced and differentiated: passes from heat to modulus to heat are repeated
    until nothing changes, and the derivatives are those of the balance, not of the passes.

    Args:
        design: with gears of any modulus.
        operation: one operating point; its temperature is that around the gears.
        models: laws; friction and loss factor are those of the chosen one.
        heated: gears, housing and thermal model.

    Returns:
        Teeth in balance. The modulus stays that of the end of its table beyond it: the caller checks that
        the temperatures lie inside. NaN where friction locks the mesh.

    Source: VDI 2736 Part 2 (2014) for the temperatures, iterated as its modulus asks for.
    """
    loss, change, passes = _settled((design, operation, models, heated))
    temperatures = _temperatures(loss, design, operation, heated)
    locked = ~jnp.all(jnp.isfinite(loss))
    code = jnp.where(change <= TOLERANCE, int(Code.SOLVED), int(Code.NOT_CONVERGED))
    return WarmTeeth(
        mean_friction=loss[0],
        loss_factor=loss[1],
        flank=temperatures.flank,
        root=temperatures.root,
        young=_moduli(temperatures.root, heated),
        status=Status(jnp.where(locked, int(Code.LOCKED), code), change, passes),
    )


Given = tuple[Design, Operation, Models, ToothHeating]


def _loss(at: Float[Array, "2"], inputs: Given) -> Float[Array, "2"]:
    """Friction and loss factor of teeth that those of `at` have warmed."""
    design, operation, models, heated = inputs
    young = _moduli(_temperatures(at, design, operation, heated).root, heated)
    pinion, gear = (replace(solid, young=young[k]) for k, solid in enumerate(design.solids))
    losses = tooth_heat_figures(replace(design, solids=(pinion, gear)), operation, models)
    return jnp.stack([losses["mean_friction"], losses["loss_factor"]])


@eqx.filter_custom_jvp
def _settled(inputs: Given) -> tuple[Array, Array, Array]:
    """Friction and loss factor that make themselves, the last relative change, and the number of passes."""

    def unsettled(state: tuple[Array, Array, Array]) -> Array:
        _, change, passes = state
        return (change > TOLERANCE) & (passes < MOST)

    def step(state: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        before, _, passes = state
        after = _loss(before, inputs)
        change = jnp.max(jnp.abs(after - before) / jnp.maximum(jnp.abs(after), _TINY))
        return after, change, passes + 1

    begin = jnp.zeros(2), jnp.asarray(jnp.inf), jnp.asarray(0)
    settled: tuple[Array, Array, Array] = jax.lax.while_loop(unsettled, step, begin)
    return settled


def _by_balance(primals: tuple[Given], tangents: tuple[Any]) -> Any:
    """Derivatives of the balance x = f(x, a): (1 - df/dx) dx = df/da."""
    (primal,) = primals
    at, change, passes = _settled(primal)
    _, along = eqx.filter_jvp(lambda inputs: _loss(at, inputs), primals, tangents)
    (a, b), (c, d) = jnp.eye(2) - jax.jacfwd(lambda loss: _loss(loss, primal))(at)
    moved = jnp.stack([d * along[0] - b * along[1], a * along[1] - c * along[0]]) / (a * d - b * c)
    return (at, change, passes), (moved, jnp.zeros_like(change), None)


_settled.def_jvp(_by_balance)  # type: ignore[no-untyped-call]


def _temperatures(
    loss: Float[Array, "2"], design: Design, operation: Operation, heated: ToothHeating
) -> ToothTemperature:
    """Temperatures of flanks and roots of both gears for a loss [K]."""
    around = operation.temperature
    reference = pitch_point(design.mesh, design.driver)
    by_gear = [
        heated.function(
            ambient=around,
            power=operation.load * jnp.abs(design.loaded @ design.motion) * operation.speed,
            friction=loss[0],
            loss_factor=loss[1],
            face_width=reference.width,
            teeth=heated.teeth[gear],
            pitch_speed=reference.pitch_line_speed * operation.speed,
            normal_module=heated.module,
            mate=mate,
            housing_resistance=heated.housing,
            housing_area=jnp.ones(()),
            duty=heated.duty,
        )
        for gear, mate in enumerate(heated.mates)
    ]
    flank, root = (jnp.stack(parts) for parts in zip(*by_gear, strict=True))
    return ToothTemperature(
        jnp.where(heated.plastic, flank, around), jnp.where(heated.plastic, root, around)
    )


def _moduli(root: Float[Array, "2"], heated: ToothHeating) -> Float[Array, "2"]:
    """Young's moduli at the temperatures of the roots [Pa]."""
    return jnp.stack([jnp.interp(root[k], heated.known[k], heated.moduli[k]) for k in (0, 1)])
