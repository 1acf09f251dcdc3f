"""Rolling resistance of lubricated contacts: the pressure of the inlet film works against both surfaces."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Shape
from pitchpoint.factored import Arrays, Numbers
from pitchpoint.registry import Registry

__all__ = ["ROLLING_RESISTANCE", "RollingResistance", "none", "wu_cheng_1991"]

Each = Float[Numbers, "*#b"]


@dataclass(frozen=True, eq=False)
class RollingResistance:
    """A named model of rolling resistance; `function` gives N per metre of contact line and surface.

    It holds for contacts of one `shape`, or of any (None).
    """

    name: str
    title: str
    function: Callable[..., Array]
    sources: tuple[str, ...] = ()
    note: str = ""
    shape: Shape | None = None

    @property
    def rivals(self) -> "Iterable[RollingResistance]":
        """Models of the library."""
        return ROLLING_RESISTANCE.values()


def none() -> Each:
    """No rolling resistance [N/m]."""
    return jnp.asarray(0.0)


def wu_cheng_1991(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> Each:
    """Rolling resistance on each surface per length of a fully flooded line contact [N/m].

    F_r = 4.318 (G U)^0.658 W^0.0126 R / alpha, isothermal; U with the mean surface speed.

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed [m/s].
        viscosity: at the inlet [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    Valid where the film is thick and the contact not starved; a converged EHL solution differs by
    -5 to +22 % for Hertz pressures of 0.5 to 1.5 GPa. Source: Goksem and Hargreaves (1978), in the
    form used by Wu and Cheng (1991).

    Example:
        >>> resistance = wu_cheng_1991(
        ...     line_load=1e5, entrainment=5.0, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9,
        ... )
        >>> round(float(resistance))
        136
    """
    material = pressure_viscosity * modulus
    speed = viscosity * entrainment / (modulus * radius)
    load = line_load / (modulus * radius)
    positive = (speed > 0.0) & (load > 0.0)
    exponent = 0.658 * _log(material * speed, positive) + 0.0126 * _log(load, positive)
    return jnp.where(positive, 4.318 * jnp.exp(exponent) * radius / pressure_viscosity, 0.0)


def _log(value: Each, positive: Bool[Arrays, "*#b"] | bool) -> Each:
    return jnp.log(jnp.where(positive, value, 1.0))


ROLLING_RESISTANCE = Registry(
    "rolling resistance",
    RollingResistance("none", "no rolling resistance", none),
    RollingResistance(
        "wu_cheng_1991",
        "isothermal rolling resistance of a line contact",
        wu_cheng_1991,
        ("goksem_hargreaves_1978", "wu_cheng_1991"),
        "Fully flooded line contacts; force per length and surface, it brakes both.",
        "line",
    ),
)
