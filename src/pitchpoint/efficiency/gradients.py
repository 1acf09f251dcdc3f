"""Derivatives of the main figures with respect to every continuous input, geometry included."""

import dataclasses

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import demand_double, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle, state
from pitchpoint.errors import ConvergenceError
from pitchpoint.gears.mesh_bodies import completed

__all__ = [
    "Inputs",
    "figure_gradient",
    "input_torque_gradient",
    "mean_loss_gradient",
    "ripple_gradient",
]

Inputs = tuple[Design, Operation]


def mean_loss_gradient(design: Design, operation: Operation, models: Models) -> Inputs:
    """Derivatives of the mean power loss [W].

    Args:
        design: mesh, materials, oil, surfaces.
        operation: one operating point.
        models: laws.

    Returns:
        A design and an operation that hold the derivative in place of each continuous value, in W
        over its SI unit; None in place of the others. Dimensions that follow from others (a centre
        distance without backlash, tip alterations that keep the clearance) are taken along: their
        own derivative is zero. The friction law is the one that acts in `models`.

    Raises:
        ConvergenceError: friction locks the mesh, there is no balance.

    By automatic differentiation of the cycle in reverse, no differences are taken.
    """
    demand_double()
    return _told(*_gradient((design, operation), "mean_loss", models))


def ripple_gradient(design: Design, operation: Operation, models: Models) -> Inputs:
    """Derivatives of the ripple of the input torque [N m], on this side of any event.

    The ripple is piecewise differentiable: where the extreme state moves from one segment of the
    cycle to another, the derivative jumps. Arguments and result as in `mean_loss_gradient`.
    """
    demand_double()
    return _told(*_gradient((design, operation), "ripple", models))


def input_torque_gradient(
    design: Design, operation: Operation, models: Models, phase: Float[Array, ""]
) -> Inputs:
    """Derivatives of the input torque [N m] at one phase.

    Arguments and result as in `mean_loss_gradient`. The torque jumps at entry and exit of a pair: on
    an event itself the derivative is that of one side.

    By automatic differentiation of the state in reverse.
    """
    demand_double()
    return _told(*_at_phase((design, operation), models, phase))


def figure_gradient(
    design: Design, operation: Operation, models: Models, figure: str
) -> tuple[float, Inputs]:
    """A figure of the mesh cycle and its derivatives.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: one operating point.
        models: laws.
        figure: "mean_loss", "mean_efficiency", "mean_input_torque" or "ripple", see `Cycle`.

    Returns:
        The figure in its SI unit, and derivatives as those of `mean_loss_gradient`.

    Raises:
        ConvergenceError: friction locks the mesh, there is no balance.

    By automatic differentiation of the cycle in reverse, no differences are taken.
    """
    value, derivatives = _gradient((design, operation), figure, models)
    return float(value), _told(value, derivatives)


def _told(value: Array, derivatives: Inputs) -> Inputs:
    """Derivatives, unless there is no balance to differentiate."""
    if not isinstance(value, jax.core.Tracer) and not bool(jnp.isfinite(value)):
        raise ConvergenceError("friction locks the mesh or no balance was found: no derivatives")
    return derivatives


def _completed(inputs: Inputs) -> Inputs:
    design, operation = inputs
    return dataclasses.replace(design, mesh=completed(design.mesh)), operation


@program
def _gradient(inputs: Inputs, figure: str, models: Models) -> tuple[Array, Inputs]:
    def value(inputs: Inputs) -> Array:
        result: Array = getattr(cycle(*_completed(inputs), models), figure)
        return result

    gradient: tuple[Array, Inputs] = eqx.filter_value_and_grad(value)(inputs)
    return gradient


@program
def _at_phase(inputs: Inputs, models: Models, phase: Float[Array, ""]) -> tuple[Array, Inputs]:
    def torque(inputs: Inputs) -> Array:
        return state(*_completed(inputs), phase, models).input_torque

    gradient: tuple[Array, Inputs] = eqx.filter_value_and_grad(torque)(inputs)
    return gradient
