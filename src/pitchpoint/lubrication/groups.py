"""Groups without units by which regressions of films and of what goes with them are written."""

from jaxtyping import Float

from pitchpoint.factored import Numbers

__all__ = ["line_groups"]

Each = Float[Numbers, "*#b"]


def line_groups(
    line_load: Each,
    entrainment: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    radius: Each,
    modulus: Each,
) -> tuple[Each, Each, Each]:
    """Load, speed and material parameters of a line contact, W = w/(E' R), U = eta0 u/(E' R), G = alpha E'.

    Args:
        line_load: w [N/m].
        entrainment: mean surface speed u [m/s].
        viscosity: eta0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        radius: R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    Source: Dowson and Higginson (1959).
    """
    return (
        line_load / (modulus * radius),
        viscosity * entrainment / (modulus * radius),
        pressure_viscosity * modulus,
    )
