"""Choices of a case by which the films of its contacts are solved."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, Final

from pitchpoint.cases.schema import FilmTable
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import ISOTHERMAL
from pitchpoint.lubrication.ehl.line import FLOODED
from pitchpoint.lubrication.ehl.model import SMOOTH, FilmModel
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials.rheology import SHEAR_STRESS
from pitchpoint.materials.solids import SolidRecord

__all__ = ["CHOICE_NOTES", "film_choices", "film_model"]

CHOICE_NOTES: Final[Mapping[str, str]] = {
    "eta_beta_sigma": "summits per area times their radius times Rq: assumed, of textbooks",
    "sigma_over_beta": "Rq over the radius of summits: assumed, of textbooks",
    "pattern": "Peklenik's number of the roughness, 1 for one without a direction",
    "boundary_friction": "of asperities that touch: assumed, of the 0.08 to 0.15 of steel",
    "inlet": "where oil begins ahead of a contact: a module, about where flanks end",
}
"""What usual choices rest on, by key of `[film]`."""

_OF_ASPERITIES = ("eta_beta_sigma", "sigma_over_beta", "pattern", "boundary_friction")
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
    names = [one.name for one in fields(FilmModel) if one.name in FilmTable.model_fields]
    given = {name: getattr(table, name) for name in names}
    chosen = {name: value for name, value in given.items() if value is not None}
    if "nodes" in chosen:
        chosen["nodes"] = int(chosen["nodes"])
    if size is not None:
        chosen.setdefault("inlet", size)
    model = FilmModel(**chosen, shear_parameters=table.shear_parameters)
    return model if model.thermal == ISOTHERMAL else replace(model, members=_members(solids))


def film_choices(model: FilmModel) -> dict[str, Any]:
    """What decides about films and their friction, by key of `[film]`, in SI.

    Args:
        model: how films are solved.
    """
    laws = {name: getattr(model, name) for name in _LAWS}
    shear = {**SHEAR_STRESS[model.shear_law].parameters, **model.shear_parameters}
    rough = () if model.asperities == SMOOTH else _OF_ASPERITIES
    return {
        "nodes": float(model.nodes),
        **laws,
        **shear,
        "asperities": model.asperities,
        **{name: getattr(model, name) for name in rough},
        "inlet": model.inlet if model.inlet < FLOODED else "fully flooded",
        "thermal": model.thermal,
    }


def _members(solids: Sequence[SolidRecord]) -> tuple[Conductor, Conductor]:
    try:
        a, b = (Conductor.of(solid) for solid in solids)
    except InputError as error:
        raise InputError(error.message, key="film.thermal") from None
    return a, b
