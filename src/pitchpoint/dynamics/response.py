"""The steady response of a mesh: motion, forces, transmission error, spectrum and status."""

from collections.abc import Sequence

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Complex, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.core.status import Code, Status
from pitchpoint.dynamics.dynamics_registry import ContactLaw
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.excitation import ExcitationCourse
from pitchpoint.dynamics.floquet import STABLE, multipliers

__all__ = ["Response", "response_from_states"]

UNRESOLVED = 1e-4
"""Highest Legendre coefficients of an element, relative to the largest displacement."""

Coordinates = Float[Array, "coordinate element node"]
Pairs = Float[Array, "pair element node"]


class Response(eqx.Module):
    """One steady period; not a number where none was found.

    The response holds every vibration that the equations have. Where the stiffness jumps, each
    hand-over sets off a vibration at the natural frequency at any speed, however low: only a stiffness
    without jumps has the static deflection as its limit.

    Attributes:
        course: the excitation at the nodes.
        displacement, velocity: of the coordinates [m or rad, and per second]; the displacement of a
            single coordinate along the line of action is the dynamic transmission error.
        static_displacement: in balance at each instant, without inertia and damping.
        stretch: compression of each pair: arm times displacement less profile error [m].
        force: of each pair along its normal [N].
        multipliers: Floquet multipliers of one period.
        status: what became of the search for it.

    Source: Atanasiu et al. (2011), eqs. 8 to 10, see its methods.
    """

    course: ExcitationCourse
    displacement: Coordinates
    velocity: Coordinates
    static_displacement: Coordinates
    stretch: Pairs
    force: Pairs
    multipliers: Complex[Array, " multiplier"]
    status: Status

    @property
    def transmission_error(self) -> Float[Array, "element node"]:
        """Dynamic transmission error, the first coordinate [m].

        Source: Atanasiu et al. (2011), eqs. 8 to 10, delta.
        """
        return self.displacement[0]

    @property
    def static_transmission_error(self) -> Float[Array, "element node"]:
        """Quasi-static transmission error, the first coordinate [m]."""
        return self.static_displacement[0]

    @property
    def separated(self) -> Bool[Array, ""]:
        """True where a pair within its zone of contact carries nothing, or pulls, at some phase."""
        return _separated(self.course, self.stretch)

    @property
    def separated_share(self) -> Float[Array, ""]:
        """Share of the period in which no pair touches, on either flank; counted at the nodes."""
        apart = jnp.where(jnp.all(self.force == 0.0, axis=0), 1.0, 0.0)
        return self.mean(jnp.where(jnp.isfinite(self.displacement[0]), apart, jnp.nan))

    def mean(self, values: Float[Array, "*b element node"]) -> Float[Array, "*b"]:
        """Mean over the period."""
        return self.course.mean(values)

    def rms(self, values: Float[Array, "*b element node"]) -> Float[Array, "*b"]:
        """Root mean square of the deviation from the mean; its derivative is NaN where it is zero."""
        mean = self.mean(values)[..., None, None]
        return jnp.sqrt(self.mean((values - mean) ** 2))

    def extremes(
        self, values: Float[Array, "*b element node"]
    ) -> tuple[Float[Array, "*b"], Float[Array, "*b"]]:
        """Smallest and largest value, between the nodes too; piecewise differentiable."""
        return self.course.grid.extremes(values)

    def peak_to_peak(self, values: Float[Array, "*b element node"]) -> Float[Array, "*b"]:
        """Largest less smallest value; piecewise differentiable."""
        low, high = self.extremes(values)
        return high - low

    def dynamic_factor(self, nominal: Float[Numbers, ""]) -> Pairs:
        """Force of each pair over the nominal force c_d = F/F_nominal.

        Args:
            nominal: force of a single pair that carries everything without vibration [N].

        The sum over the pairs of arm times c_d has the mean that balances the load: one, for a single
        coordinate along the line of action.

        Source: Atanasiu et al. (2011), shared dynamic loads, c_d.
        """
        return self.force / nominal

    def spectrum(
        self, values: Float[Array, "*b element node"], orders: Sequence[int] | np.ndarray
    ) -> Float[Array, "order *b"]:
        """Amplitude of each order of the mesh frequency; order zero is the magnitude of the mean.

        Args:
            values: any course over the period.
            orders: not negative, known when compiled.

        From the complex Fourier series: orders n and -n of a real course add up.
        """
        wanted = np.asarray(orders)
        parts = jnp.abs(self.course.grid.fourier(values, self.course.bounds, wanted))
        sides = jnp.where(wanted == 0, 1.0, 2.0)
        return parts * sides.reshape(-1, *(1 for _ in values.shape[:-2]))


def response_from_states(
    course: ExcitationCourse,
    equations: Equations,
    law: ContactLaw,
    backlash: Float[Array, ""],
    states: Float[Array, "state element node"],
    monodromy: Float[Array, "state state"],
    residual: Float[Array, ""],
    periodic: Bool[Array, ""],
    resolved: Bool[Array, ""] | bool = True,
    iterations: Int[Array, ""] | None = None,
) -> Response:
    """Response with forces and status from states without dimensions.

    Args:
        course, equations, law, backlash: that were solved.
        states: at the nodes.
        monodromy, residual: of one period.
        periodic: whether the period closes.
        resolved: whether the integration between the nodes is exact.
        iterations: of the search; one for a linear system.
    """
    size = equations.load.shape[0]
    solved = periodic & resolved & equations.finite & jnp.all(jnp.isfinite(states))

    def checked(values: Array) -> Array:
        return jnp.where(solved, values, jnp.nan)

    def physical(values: Coordinates) -> Coordinates:
        return checked(jnp.einsum("ab,ben->aen", equations.scale, values))

    displacement = physical(states[:size])
    stretch = jnp.einsum("apen,aen->pen", course.arm, displacement) - course.error
    force = checked(course.stiffness * law.function(stretch, backlash)[0])
    of_period = multipliers(jax.lax.stop_gradient(monodromy))
    checks = (
        (~equations.finite, Code.NOT_FINITE),
        (jnp.logical_not(resolved), Code.UNRESOLVED),
        (~solved, Code.NOT_PERIODIC),
        (jnp.max(jnp.abs(of_period)) > STABLE, Code.UNSTABLE),
        (_coarse(course, displacement), Code.UNRESOLVED),
        (_separated(course, stretch) & law.linear, Code.SEPARATES),
    )
    return Response(
        course=course,
        displacement=displacement,
        velocity=physical(states[size:]) * equations.frequency,
        static_displacement=physical(_static(equations)),
        stretch=stretch,
        force=force,
        multipliers=jnp.where(solved, of_period, jnp.nan),
        status=Status(
            code=jnp.select(
                [check for check, _ in checks],
                [jnp.asarray(int(code)) for _, code in checks],
                int(Code.SOLVED),
            ),
            residual=checked(residual),
            iterations=jnp.asarray(1) if iterations is None else iterations,
        ),
    )


def _separated(course: ExcitationCourse, stretch: Pairs) -> Bool[Array, ""]:
    carries = (course.stiffness > 0.0) & (course.length[:, None] > 0.0)
    return jnp.any(carries & (stretch < 0.0))


def _coarse(course: ExcitationCourse, displacement: Coordinates) -> Bool[Array, ""]:
    motion = jax.lax.stop_gradient(displacement)
    size = jnp.max(jnp.abs(motion), axis=(-2, -1))
    return jnp.any(course.grid.tail(motion) > UNRESOLVED * size)


def _static(equations: Equations) -> Coordinates:
    """Balance at each instant."""
    stiffness, load = equations.total_stiffness, equations.total_load
    if load.shape[0] == 1:
        return load / stiffness[0]
    solved = jnp.linalg.solve(
        jnp.moveaxis(stiffness, (0, 1), (-2, -1)), jnp.moveaxis(load, 0, -1)[..., None]
    )
    return jnp.moveaxis(solved[..., 0], -1, 0)
