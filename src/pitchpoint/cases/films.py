"""Choices of a case by which the films of its contacts are solved."""

from collections.abc import Sequence
from dataclasses import fields, replace

from pitchpoint.cases.schema import FilmTable
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import ISOTHERMAL
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.flash_temperature import Conductor
from pitchpoint.materials.solids import SolidRecord

__all__ = ["film_model"]


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


def _members(solids: Sequence[SolidRecord]) -> tuple[Conductor, Conductor]:
    try:
        a, b = (Conductor.of(solid) for solid in solids)
    except InputError as error:
        raise InputError(error.message, key="film.thermal") from None
    return a, b
