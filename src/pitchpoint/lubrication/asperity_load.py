"""Part of the load that asperities carry beside the film, by published regressions."""

from collections.abc import Mapping

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.lubrication.groups import line_groups

__all__ = ["masjedi_khonsari_2012", "masjedi_khonsari_2012_regression", "none"]

Each = Float[Numbers, "*#b"]

_LEAST = 1e-30  # below any group of a contact, with logarithms that are finite


def none() -> Each:
    """No load on asperities, as if the flanks were smooth [1]."""
    return jnp.asarray(0.0)


def masjedi_khonsari_2012(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
    roughness_rq: Each,
    hardness: Each,
) -> Each:
    """Part of the load of a rough line contact that asperities carry, 0 to 1 [1].

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed u [m/s].
        viscosity: eta0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.
        roughness_rq: sigma, composite Rq [m].
        hardness: Vickers hardness of the softer flank [Pa].

    In per cent 0.005 W^-0.408 U^-0.088 G^0.103 ln(1 + 4470 s^6.015 V^1.168 W^0.485 U^-3.741 G^-2.898), with
    s = sigma/R, V = hardness/E' and W, U, G as film laws have them. The regression gives more than 100 per
    cent far outside its range, and is cut there; at standstill asperities carry all.
    Source: Masjedi and Khonsari (2012), as Zhao et al. (2022) print it in equation 9.

    Example:
        >>> share = masjedi_khonsari_2012(
        ...     line_load=1e5, entrainment=0.5, viscosity=0.05, pressure_viscosity=2e-8, radius=0.01,
        ...     modulus=226.4e9, roughness_rq=0.5e-6, hardness=7e9,
        ... )
        >>> round(float(share), 4)
        0.6488
    """
    share = masjedi_khonsari_2012_regression(
        line_load=line_load,
        entrainment=entrainment,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
        radius=radius,
        modulus=modulus,
        roughness_rq=roughness_rq,
        hardness=hardness,
    )
    return jnp.where(share > 1.0, 1.0, share)


def masjedi_khonsari_2012_regression(
    *,
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
    roughness_rq: Each,
    hardness: Each,
) -> Each:
    """What the regression behind `masjedi_khonsari_2012` gives [1]; above 1 it is outside its range.

    Arguments are those of `masjedi_khonsari_2012`.

    Source: Masjedi and Khonsari (2012), as Zhao et al. (2022) print it in equation 9.
    """
    film = line_groups(line_load, entrainment, viscosity, pressure_viscosity, radius, modulus)
    surface = {"s": roughness_rq / radius, "V": hardness / modulus}
    groups = dict(zip("WUG", film, strict=True)) | surface
    logs = {name: _log(value) for name, value in groups.items()}
    inner = jnp.log(4470.0) + _sum(logs, s=6.015, V=1.168, W=0.485, U=-3.741, G=-2.898)
    outer = jnp.log(0.005e-2) + _sum(logs, W=-0.408, U=-0.088, G=0.103)
    share = jnp.exp(outer) * jax.nn.softplus(inner)
    acts = (groups["W"] > 0.0) & (groups["s"] > 0.0)
    return jnp.where(acts, share, 0.0)


def _log(value: Each) -> Array:
    return jnp.log(jnp.where(jnp.asarray(value) < _LEAST, _LEAST, value))


def _sum(logs: Mapping[str, Array], **powers: float) -> Array:
    return jnp.asarray(sum(power * logs[name] for name, power in powers.items()))
