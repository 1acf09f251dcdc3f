"""Friction as Tian et al. (2024) used it where that differs from the laws it is taken from."""

from functools import partial

from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.lubrication.friction_coefficient import xu_2007
from pitchpoint.lubrication.lubrication_registry import FrictionLaw

__all__ = [
    "METHOD_1",
    "METHOD_1_FACTOR_1",
    "METHOD_1_NOMINAL",
    "METHOD_2",
    "method_1",
    "method_2",
]

Each = Float[Numbers, "*#b"]


def method_1(
    *,
    line_load: Each,
    reference_sum_speed: Each,
    reference_radius: Each,
    viscosity: Each,
    roughness_ra: Each,
    factor: Each | float = 2.0,
) -> Each:
    """Eq. 12 with the load of each contact instead of that of the mesh, X_L = (F/b)^-0.0651.

    Args:
        line_load: of the contact [N/m].
        reference_sum_speed, reference_radius: at the pitch point [m/s], [m].
        viscosity: dynamic [Pa s].
        roughness_ra: [m].
        factor: on the product of speed and radius; 2 reproduces the paper's numbers, its origin
            is not known.
    """
    load = jnp.where(line_load > 0.0, line_load, 1.0) * 1e-3
    group = load / (factor * reference_sum_speed * reference_radius * 1e3)
    logs = (
        0.2 * jnp.log(group)
        - 0.05 * jnp.log(viscosity * 1e3)
        + 0.25 * jnp.log(jnp.maximum(roughness_ra, 1e-12) * 1e6)
        - 0.0651 * jnp.log(load)
    )
    return jnp.where(line_load > 0.0, 0.048 * jnp.exp(logs), 0.0)


def method_1_nominal(
    *,
    reference_line_load: Each,
    reference_sum_speed: Each,
    reference_radius: Each,
    viscosity: Each,
    roughness_ra: Each,
) -> Each:
    """Eq. 12 with the load of the whole mesh and no factor, as an average for a loss factor."""
    return method_1(
        line_load=reference_line_load,
        reference_sum_speed=reference_sum_speed,
        reference_radius=reference_radius,
        viscosity=viscosity,
        roughness_ra=roughness_ra,
        factor=1.0,
    )


def method_2(
    *,
    pressure: Each,
    slide_roll_ratio: Each,
    entrainment: Each,
    viscosity: Each,
    radius: Each,
    roughness_ra: Each,
) -> Each:
    """Eqs. 13 and 14 with the right exponents, and Ra where the law wants the composite Rq."""
    return xu_2007(
        pressure=pressure,
        slide_roll_ratio=slide_roll_ratio,
        entrainment=entrainment,
        viscosity=viscosity,
        radius=radius,
        roughness_rq=roughness_ra,
    )


_CASE_1 = {
    "reference_sum_speed": 2.90,
    "reference_radius": 6.156e-3,
    "viscosity": 0.050,
    "roughness_ra": 0.8e-6,
}

METHOD_1 = FrictionLaw(
    "tian2024.method_1",
    "Method I of Tian et al. (2024)",
    method_1,
    ("tian_2024",),
    ({"line_load": 117.3e3, **_CASE_1}, 0.0543983233897726 * 2**-0.2 * 117.3**-0.0651),
    local=True,
    note="A mean law used with local load and an unexplained factor 2; only to reproduce the paper.",
)

METHOD_1_FACTOR_1 = FrictionLaw(
    "tian2024.method_1_factor_1",
    "Method I of Tian et al. (2024) without the factor 2",
    partial(method_1, factor=1.0),
    ("tian_2024",),
    ({"line_load": 117.3e3, **_CASE_1}, 0.0543983233897726 * 117.3**-0.0651),
    local=True,
    note="Reproduces the value quoted from Diez-Ibarbia et al. in Table 3.",
)

METHOD_1_NOMINAL = FrictionLaw(
    "tian2024.method_1_nominal",
    "Method I of Tian et al. (2024) with nominal load",
    method_1_nominal,
    ("tian_2024",),
    ({"reference_line_load": 117.3e3, **_CASE_1}, 0.0543983233897726 * 117.3**-0.0651),
    local=False,
    note="With the loss factor H_V it reproduces the value quoted from Hohn in Table 3.",
)

METHOD_2 = FrictionLaw(
    "tian2024.method_2",
    "Method II of Tian et al. (2024)",
    method_2,
    ("tian_2024", "xu_2007"),
    (
        {
            "pressure": 1e9,
            "slide_roll_ratio": 0.3,
            "entrainment": 10.0,
            "viscosity": 0.010,
            "radius": 0.01,
            "roughness_ra": 0.5e-6,
        },
        0.0210243789171055,
    ),
    note="Xu et al. (2007) with the Ra of one flank in place of the composite Rq.",
    full_film=True,
)
