"""How much of what touches is bare: defects of the film of molecules that a lubricant leaves on a flank."""

from jaxtyping import Array, Float
from scipy.constants import gas_constant

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers, product_array

__all__ = ["fractional_film_defect"]

Each = Float[Numbers, "*#b"]

_ALL = 50.0  # 1 - exp(-50) is 1 in double precision


def fractional_film_defect(
    *,
    sliding: Each,
    temperature: Each,
    adsorption_heat: Each | float = 49e3,
    molecule_diameter: Each | float = 3e-10,
    vibration_period: Each | float = 3e-12,
) -> Float[Array, "..."]:
    """Part of the sites of a surface that its adsorbed molecules leave bare, 0 to 1.

    psi = 1 - exp(-t_x/t_r): t_x = X/u_s is the time in which the mate passes a molecule, and
    t_r = t_0 exp(E_a/(R_g T_s)) that for which the molecule stays. At rest all have left, psi is 1; fast
    sliding finds them all in place.

    Args:
        sliding: u_s, speed of sliding without sign, shape (...) [m/s].
        temperature: T_s of the surface where it touches, bulk and flash, shape (...) [K].
        adsorption_heat: E_a, heat of adsorption of the lubricant, shape (...) [J/mol].
        molecule_diameter: X, of an adsorbed molecule, shape (...) [m].
        vibration_period: t_0, of an adsorbed molecule, shape (...) [s].

    Returns:
        psi, broadcast shape of the arguments [1]; its gradient is finite (zero) at rest.

    Validity:
        A molecule that has left is not replaced, and oxides and additives that react are left out. The three
        defaults are recalled, unconfirmed, of mineral oils on steel. E_a decides: between 37 and 49 kJ/mol
        psi changes by a factor of a hundred.

    Source:
        Zhao et al. (2022), equation 10, who have it from Masjedi and Khonsari (2015); Stolarski (1990)
        defines psi, t_x and t_r. It is usually named after Kingsbury (1958), which could not be confirmed.

    Example:
        >>> bare = fractional_film_defect(sliding=0.07, temperature=313.0, adsorption_heat=36.9e3)
        >>> f"{float(bare):.2e}"
        '9.93e-04'
    """
    speed = product_array(sliding)
    leaving = jnp.asarray(
        molecule_diameter
        / vibration_period
        * jnp.exp(-adsorption_heat / (gas_constant * jnp.asarray(temperature)))
    )
    gone = _ALL * speed <= leaving
    stay = jnp.where(gone, _ALL, leaving / jnp.where(gone, 1.0, speed))
    return -jnp.expm1(-stay)
