"""Vibration of a gear pair along its line of action: from a design to transmission error and forces."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.excitation import Excitation
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.response import Response
from pitchpoint.dynamics.steady_state import separating_steady_state, steady_state
from pitchpoint.dynamics.system import System, modal_damping, reduced_mass
from pitchpoint.efficiency.quasi_static import Design, Operation
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.loading.mesh_stiffness import MeshStiffness, mesh_stiffness
from pitchpoint.loading.tooth_compliance import Terms

__all__ = [
    "Vibrating",
    "excitation",
    "excited",
    "frequency_ratio",
    "nominal_force",
    "steady",
    "system",
    "transmission_figures",
]


# Of the mean stiffness of a pair six nodes leave an error of 4e-9, twelve rounding.
_NODES = 12


class Vibrating(eqx.Module):
    """What a pair has beside its design when it vibrates.

    Attributes:
        inertia: of each body about its axis [kg m2].
        damping_ratio: of the mean system.
        error: amplitude of each order of the composite profile error, the same for all pairs [m].
        error_phase: of each order at phase zero of the mesh [rad].
        backlash: free motion along the normal before back flanks meet, where teeth may part; infinite
            if they never do [m].
        orders: static, orders of the mesh frequency.
    """

    inertia: Float[Array, " dof"]
    damping_ratio: Float[Array, ""]
    error: Float[Array, " order"]
    error_phase: Float[Array, " order"]
    orders: tuple[int, ...] = eqx.field(static=True)
    backlash: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.asarray(jnp.inf))


def excitation(stiffness: MeshStiffness, vibrating: Vibrating) -> Excitation:
    """Pairs of teeth as springs on one coordinate, the transmission error along the line of action.

    Args:
        stiffness: of the mesh over one period.
        vibrating: with the profile error.

    Source: Atanasiu et al. (2011), eq. 11, with the profile error as a sum of orders.
    """
    orders = jnp.asarray(vibrating.orders, dtype=float).reshape(-1, 1, 1)
    angle = 2.0 * jnp.pi * orders * stiffness.phase + vibrating.error_phase[:, None, None]
    error = jnp.sum(vibrating.error[:, None, None] * jnp.cos(angle), axis=0)
    return Excitation(
        edges=stiffness.edges,
        stiffness=stiffness.single,
        arm=stiffness.arm[None],
        # Along the line of action the error is as given; along the normal it is smaller.
        error=stiffness.error + stiffness.arm * error,
    )


def system(
    design: Design, vibrating: Vibrating, mean_stiffness: Float[Array, ""], operation: Operation
) -> System:
    """Mass, damping and load along the line of action at one operating point.

    Args:
        design: of a family with a line of action.
        vibrating: inertia and damping ratio.
        mean_stiffness: of the mesh along the line of action [N/m].
        operation: load and speed.

    Source: Atanasiu et al. (2011), eqs. 10, 12 and 13, the last with the indices in their places.
    """
    action = line_of_action(design.mesh)
    mass = reduced_mass(vibrating.inertia, action).reshape(1, 1)
    return System(
        mass=mass,
        damping=modal_damping(mass, mean_stiffness.reshape(1, 1), vibrating.damping_ratio),
        load=(operation.load / jnp.abs(action @ design.loaded)).reshape(1),
        period=design.period / operation.speed,
    )


def frequency_ratio(stiffness: MeshStiffness, moved: System) -> Float[Array, ""]:
    """Natural frequency with the mean stiffness over the mesh frequency.

    From omega = sqrt(k_m/m_e) of one mass on a spring.
    """
    natural = jnp.sqrt(stiffness.mean / moved.mass[0, 0])
    return natural * moved.period / (2.0 * jnp.pi)


def excited(
    design: Design, operation: Operation, terms: Terms, vibrating: Vibrating
) -> tuple[MeshStiffness, System, Excitation]:
    """Stiffness of the mesh, and the system that it excites, at one operating point.

    Args:
        design: mesh and materials.
        operation: one operating point.
        terms: of the model of tooth compliance.
        vibrating: inertia, damping, profile error.
    """
    # A segment between events may be a whole period long, and each order has to be resolved in it.
    count = _NODES + 4 * max(vibrating.orders, default=0)
    stiffness = mesh_stiffness(
        design.mesh, design.loaded, design.solids, terms, operation.load, count
    )
    moved = system(design, vibrating, stiffness.mean, operation)
    return stiffness, moved, excitation(stiffness, vibrating)


def steady(
    moved: System,
    driven: Excitation,
    grid: PeriodGrid,
    *,
    separating: bool = False,
    backlash: Float[Array, ""] | float = jnp.inf,
) -> Response:
    """Steady vibration of a system.

    Compiled for itself it serves every gear family, tooth model and material.

    Args:
        moved: mass, damping, load, period.
        driven: stiffness, arms, errors.
        grid: static, see `PeriodGrid.resolving`.
        separating: static; True if teeth may part.
        backlash: free motion along the normal before back flanks meet [m].
    """
    if separating:
        return separating_steady_state(moved, driven, grid, backlash=backlash)
    return steady_state(moved, driven, grid)


def transmission_figures(
    stiffness: MeshStiffness, moved: System, found: Response
) -> dict[str, Array]:
    """Figures of stiffness and vibration at one operating point.

    Args:
        stiffness, moved: what `excited` returns.
        found: the steady vibration.

    Returns:
        By name, lengths in m, stiffness in N/m, forces over that of a single pair that carries
        everything.
    """
    total = stiffness.total
    dynamic, static = found.transmission_error, found.static_transmission_error
    factors = found.dynamic_factor(nominal_force(stiffness, moved))
    mesh_factor = jnp.sum(factors, axis=0)
    # Together, so that the polynomials between the nodes are compiled once.
    low, high = found.extremes(
        jnp.concatenate([dynamic[None], static[None], mesh_factor[None], factors])
    )
    spread = high - low
    return {
        "mean_stiffness": stiffness.mean,
        "stiffness_variation": (jnp.max(total) - jnp.min(total)) / stiffness.mean,
        "mean_transmission_error": found.mean(dynamic),
        "transmission_error_range": spread[0],
        "static_transmission_error_range": spread[1],
        "transmission_error_rms": found.rms(dynamic),
        "separated_share": found.separated_share,
        "largest_mesh_dynamic_factor": high[2],
        "largest_dynamic_factor": jnp.max(high[3:]),
        "natural_frequency": jnp.sqrt(stiffness.mean / moved.mass[0, 0]) / (2.0 * jnp.pi),
        "mesh_frequency": 1.0 / moved.period,
        "equivalent_mass": moved.mass[0, 0],
        "largest_multiplier": jnp.max(jnp.abs(found.multipliers)),
        "vibration_status": jax.lax.stop_gradient(found.status.code),
    }


def nominal_force(stiffness: MeshStiffness, moved: System) -> Float[Array, ""]:
    """Normal force of a single pair that carries the load without vibration [N].

    From the balance of the load by one pair, where its arm is largest.
    """
    return moved.load[0] / jnp.max(jnp.abs(stiffness.arm))
