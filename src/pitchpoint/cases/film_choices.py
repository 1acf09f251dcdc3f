"""Choices of a case by which the films of its contacts are solved."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, Final

from pitchpoint.contact.contact_registry import END_PROFILES
from pitchpoint.contact.surface import Surface
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL, SMOOTH
from pitchpoint.lubrication.ehl.film_tables import OF_VISCOSITY, FilmTable
from pitchpoint.lubrication.ehl.line import FLOODED
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials.materials_registry import SHEAR_STRESS, VISCOSITY
from pitchpoint.materials.solids import SolidRecord

__all__ = [
    "CHOICE_NOTES",
    "PATCH_NODES",
    "SUMMIT_CONSTANTS",
    "USUAL_ENDS",
    "course_grid",
    "course_moments",
    "end_surfaces",
    "film_choices",
    "film_model",
    "patch_grid",
]

PATCH_NODES: Final = 65
"""Usual nodes along a patch up to a load parameter M of 100, with one cell less across: grids with twice as
many take about five times as long."""

CHOICE_NOTES: Final[Mapping[str, str]] = {
    "eta_beta_sigma": "summits per area times their radius times Rq, of the set: assumed",
    "sigma_over_beta": "Rq over the radius of summits, of the set: assumed",
    "pattern": "Peklenik's number of the roughness, 1 for one without a direction",
    "boundary_friction": "of asperities that touch: assumed, of the 0.08 to 0.15 of steel",
    "ends": "bodies go on beyond the contact line; mirrored where both end with it",
    "inlet": "where oil begins ahead of a contact: a module, about where flanks end",
}
"""What usual choices rest on, by key of `[film]`."""

USUAL_ENDS: Final = "half_space"
"""Bodies on beyond the ends of a contact line, unless asked otherwise."""

USUAL_TIME: Final = "steady"
"""Films that take no notice of those before them, unless asked otherwise."""

MOMENTS: Final = 40
"""Usual number of moments of an engagement at most: all phases of most pairs."""

MOST_ALONG: Final = 257
"""Largest number of nodes along the grid of an engagement."""

FEWEST_ACROSS: Final = 32
"""Smallest number of cells across it."""

SUMMIT_CONSTANTS: Final = ("eta_beta_sigma", "sigma_over_beta")
"""Keys of `[film]`, and attributes of a set, that decide how much asperities carry."""

_OF_ASPERITIES = (*SUMMIT_CONSTANTS, "pattern", "boundary_friction")
_LAWS = ("viscosity_law", "density_law", "shear_law")


def film_model(table: FilmTable, solids: Sequence[SolidRecord], size: float | None) -> FilmModel:
    """What a table `[film]` says, the rest as `FilmModel` has it.

    Args:
        table: as validated.
        solids: of both members, whose surfaces warm where the film is not isothermal.
        size: of the teeth [m], which is where oil begins unless the table says otherwise: there is no flank
            further ahead; None where bodies have no teeth.

    Raises:
        InputError: the conductivity or specific heat of a member is not known, and asked for.
    """
    names = [field.name for field in fields(FilmModel) if field.name in FilmTable.model_fields]
    stated = {name: getattr(table, name) for name in names}
    chosen = {name: value for name, value in stated.items() if value is not None}
    if "nodes" in chosen:
        chosen["nodes"] = int(chosen["nodes"])
    if table.over_patch:  # lines beside it have their own nodes
        chosen.pop("nodes", None)
    if size is not None:
        chosen.setdefault("inlet", size)
    for name in SUMMIT_CONSTANTS:
        chosen.setdefault(name, getattr(table.set_of_summits, name))
    model = FilmModel(
        **chosen,
        shear_parameters=table.shear_parameters,
        viscosity_parameters=table.viscosity_parameters,
    )
    return model if model.thermal == ISOTHERMAL else replace(model, members=_members(solids))


def patch_grid(table: FilmTable, usual: int = PATCH_NODES) -> tuple[int, int]:
    """Nodes along the patch of a contact, and cells across it.

    Args:
        table: as validated.
        usual: nodes unless it names them.
    """
    nodes = int(table.nodes or usual)
    return nodes, int(table.cells or nodes - 1)


def course_grid(table: FilmTable) -> tuple[int, int]:
    """Nodes along the one grid of all contacts of an engagement, and cells across it.

    It reaches as far as the longest inlet of any of them, and has twice as many nodes along as grids of
    single contacts, and half as many cells across.

    Args:
        table: as validated.
    """
    nodes, cells = patch_grid(table)
    return min(2 * nodes - 1, max(nodes, MOST_ALONG)), max(cells // 2, FEWEST_ACROSS)


def course_moments(table: FilmTable) -> int:
    """Moments of an engagement at most.

    Args:
        table: as validated.
    """
    return int(table.moments or MOMENTS)


def end_surfaces(table: FilmTable, width: float, modulus: float) -> tuple[Surface, ...]:
    """Surfaces that are missing at the ends of a contact line.

    Args:
        table: as validated.
        width: of the face [m].
        modulus: E' [Pa].

    Raises:
        InputError: ends that do not fit on the face.
    """
    if table.end_profile is None:
        return ()
    profile = END_PROFILES[table.end_profile]
    try:
        return profile.function(**profile.of_face(width, modulus), **table.profile_parameters)
    except InputError as error:
        raise InputError(error.message, key=f"film.end_{error.key}") from None


def film_choices(model: FilmModel, table: FilmTable | None = None) -> dict[str, Any]:
    """What decides about films and their friction, by key of `[film]`, in SI.

    Args:
        model: how films are solved.
        table: of the case; None where a law asks for films.
    """
    laws = {name: getattr(model, name) for name in _LAWS}
    shear = {**SHEAR_STRESS[model.shear_law].parameters, **model.shear_parameters}
    usual = VISCOSITY[model.viscosity_law].parameters
    viscosity = {name: usual[name] for name in OF_VISCOSITY if name in usual}
    rough = () if model.asperities == SMOOTH else _OF_ASPERITIES
    return {
        **_grid_choices(model, table),
        **laws,
        **viscosity,
        **model.viscosity_parameters,
        **shear,
        "asperities": model.asperities,
        **{name: getattr(model, name) for name in rough},
        "inlet": model.inlet if model.inlet < FLOODED else "fully flooded",
        "thermal": model.thermal,
    }


def _grid_choices(model: FilmModel, table: FilmTable | None) -> dict[str, Any]:
    if table is None:
        return {"nodes": float(model.nodes)}
    if not table.over_patch:
        return {}
    grid = {}
    if table.nodes is not None:  # those that are left open follow from the contacts
        grid = dict(zip(("nodes", "cells"), map(float, patch_grid(table)), strict=True))
    ends = {"ends": table.ends or USUAL_ENDS} if table.solver == "finite_line" else {}
    course = {"moments": float(course_moments(table))} if table.squeezes else {}
    time = table.time or USUAL_TIME
    return {**grid, "time": time, **course, **ends}


def _members(solids: Sequence[SolidRecord]) -> tuple[Conductor, Conductor]:
    try:
        a, b = (Conductor.of(solid) for solid in solids)
    except InputError as error:
        raise InputError(error.message, key="film.thermal") from None
    return a, b
