"""Choices of a case by which the films of its contacts are solved."""

from dataclasses import fields

from pitchpoint.cases.schema import FilmTable
from pitchpoint.lubrication.ehl.model import FilmModel

__all__ = ["film_model"]


def film_model(table: FilmTable) -> FilmModel:
    """What a table `[film]` says, the rest as `FilmModel` has it.

    Args:
        table: as validated.
    """
    names = [one.name for one in fields(FilmModel) if one.name in FilmTable.model_fields]
    given = {name: getattr(table, name) for name in names}
    chosen = {name: value for name, value in given.items() if value is not None}
    if "nodes" in chosen:
        chosen["nodes"] = int(chosen["nodes"])
    return FilmModel(**chosen, shear_parameters=table.shear_parameters)
