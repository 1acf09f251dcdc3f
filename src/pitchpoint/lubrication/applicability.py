"""Which laws hold for the contacts of a mesh, by what they ask for."""

from math import inf

from pitchpoint import units
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.lubrication.conditions import UNITS, law_arguments, of_other_shape
from pitchpoint.lubrication.lubrication_registry import AsperityLoad, FilmThickness, FrictionLaw

__all__ = ["OF_PITCH_POINT", "Limited", "asks_for_pitch_point", "limits_words", "why_inapplicable"]

Limited = FrictionLaw | FilmThickness | AsperityLoad
"""Laws with ranges of conditions, outside of which they answer and results say so."""

OF_PITCH_POINT = frozenset(
    {
        "face_width",
        "pitch_line_speed",
        "reference_line_load",
        "reference_radius",
        "reference_sum_speed",
    }
)
"""Conditions that only a mesh with a pitch point has."""


def asks_for_pitch_point(law: FrictionLaw) -> bool:
    """True if a law asks for what only a mesh with a pitch point has.

    Example:
        >>> from pitchpoint.lubrication.lubrication_registry import LAWS
        >>> [law.name for law in LAWS if asks_for_pitch_point(law)]
        ['iso_tr_14179_2']
    """
    wanted, _ = law_arguments(law.function)
    return not OF_PITCH_POINT.isdisjoint(wanted)


def why_inapplicable(law: FrictionLaw, mesh: Mesh) -> str | None:
    """None if a law holds for the contacts of a mesh, else why not, in one sentence without its stop.

    Args:
        law: of friction.
        mesh: any family.
    """
    if reason := of_other_shape(law, mesh.shape):
        return reason
    if has(mesh, pitch_point) or not asks_for_pitch_point(law):
        return None
    return f"'{law.name}' is a law for a whole mesh, and these gears have no pitch point"


def limits_words(name: str, limits: tuple[float, float]) -> str:
    """Range of a condition that a law asks for, in words.

    Args:
        name: of the condition.
        limits: smallest and largest value [SI]; infinite where there is none.

    Example:
        >>> limits_words("viscosity", (1e-3, float("inf")))
        'at least 1 mPa s'
    """
    low, high = (_shown(name, value) for value in limits)
    if limits[1] == inf:
        return f"at least {low}"
    return f"at most {high}" if limits[0] == -inf else f"{low} to {high}"


_SHOWN = {"viscosity": ("mPa s", "dynamic viscosity"), "roughness_ra": ("um", "length")}


def _shown(name: str, value: float) -> str:
    unit, kind = _SHOWN.get(name, (UNITS[name], ""))
    return f"{units.convert(value, unit, kind) if kind else value:g} {unit}".removesuffix(" 1")
