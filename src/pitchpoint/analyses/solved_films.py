"""Films of the contacts; the solver is imported when a case asks for it."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, Unasked
from pitchpoint.analyses.main_figures import numbers
from pitchpoint.cases.built import Built
from pitchpoint.contact.contacts import TOUCH
from pitchpoint.registry import code_at

__all__ = ["FILM", "FILM_SQUEEZE", "FINITE_FILM", "OVERLAP", "film_notes"]

OVERLAP = "Films below zero: the mean planes of the rough flanks overlap."

_MAIN = (
    "smallest_film",
    "smallest_lambda",
    "largest_film_pressure",
    "largest_asperity_share",
    "largest_film_rise",
    "largest_flash_rise",
    "mean_film_friction",
    "mean_boundary_part",
    "mean_film_loss",
    "film_efficiency",
    "loaded_contacts",
    "solved_contacts",
    "largest_central_film_error",
    "largest_minimum_film_error",
)
_BY_LINES = ("mean_line_friction", "mean_line_loss")
_OF_FINITE = ("smallest_central_film", "largest_end_pressure")
_IN_SERIES = ("film_torsional_stiffness", "stiffness_without_films", "stiffness_with_films")
_SQUEEZE_MAIN = (
    "smallest_film",
    "steady_smallest_film",
    "smallest_central_film",
    "steady_smallest_central_film",
    "squeeze_change",
    "loaded_moments",
    "solved_moments",
)
_BY_LAW = (
    "mean_law_friction",
    "mean_law_loss",
    "law_efficiency",
    "friction_deviation",
    "loss_deviation",
)
_BY_FILM_LAW = ("film_deviation", "largest_film_deviation")


def _dry(built: Built) -> str | None:
    """Why a case has no films of lines: it asks for finite contacts or none, or has ellipses."""
    film, shape = built.case.film, built.design.mesh.shape
    if film is not None and film.over_patch:
        return Unasked("[film] asks for contacts of finite length")
    if shape != "line":
        touch = f"these gears touch {TOUCH[shape]}"
        return f'{touch}; solver = "elliptic" in [film] gives films of finite contacts'
    return Unasked("the case has no [film]") if film is None else None


def _endless(built: Built) -> str | None:
    """Why a case has no films of finite contacts: nobody asks for them."""
    if built.case.film is None:
        return Unasked("the case has no [film]")
    return None if built.case.film.over_patch else Unasked("[film] asks for lines without ends")


def _steady(built: Built) -> str | None:
    """Why a case has no film with squeeze: nobody asks for it."""
    reason = _endless(built)
    if reason is not None:
        return reason
    assert built.case.film is not None
    return None if built.case.film.squeezes else Unasked("[film] asks for steady films")


def _line_pieces(built: Built) -> Iterable[Piece]:
    code_at("pitchpoint.analyses.film_series:check_series")(built)
    pieces: Iterable[Piece] = code_at("pitchpoint.analyses.film:pieces")(built)
    return pieces


def _finite_pieces(built: Built) -> Iterable[Piece]:
    code_at("pitchpoint.analyses.film_series:check_series")(built)
    _check_contacts(built)
    pieces: Iterable[Piece] = code_at("pitchpoint.analyses.finite_film:pieces")(built)
    return pieces


def _check_contacts(built: Built) -> None:
    """InputError for height maps that do not fit, and for an engagement that cannot be followed."""
    code_at("pitchpoint.analyses.engagement:check_heights")(built)
    if _steady(built) is None:
        code_at("pitchpoint.analyses.engagement:check_course")(built)


def _squeeze_pieces(built: Built) -> Iterable[Piece]:
    _check_contacts(built)
    pieces: Iterable[Piece] = code_at("pitchpoint.analyses.film_squeeze:pieces")(built)
    return pieces


def _squeeze_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("film_squeeze")
    if data is None:
        return {"film_squeeze": {}}
    every = {name: numbers(data[name].values) for name in _SQUEEZE_MAIN}
    return {"film_squeeze": {**every, "notes": film_notes(data)}}


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    return {"film": _figures_of(parts.get("film"), _MAIN)}


def _finite_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    data = parts.get("finite_film")
    beside = [name for name in (*_BY_LINES, *_OF_FINITE) if data is not None and name in data]
    return {"finite_film": _figures_of(data, (*_MAIN, *beside))}


def _figures_of(data: xr.Dataset | None, names: Sequence[str]) -> dict[str, Any]:
    """Figures of films, with those by laws beside them."""
    if data is None:
        return {}
    in_series = [name for name in _IN_SERIES if name in data]
    every: dict[str, Any] = {
        name: numbers(_finite(data[name].values)) for name in (*names, *in_series)
    }
    every["friction_laws"] = _each(data, "law", _BY_LAW)
    every["film_laws"] = _each(data, "film_law", _BY_FILM_LAW)
    return {**every, "notes": film_notes(data)}


def film_notes(data: xr.Dataset) -> list[str]:
    """Sentences without which figures of films mislead.

    Args:
        data: with the smallest film.
    """
    return [OVERLAP] if float(data["smallest_film"]) < 0.0 else []


def _finite(values: np.ndarray) -> np.ndarray:
    """Values without those that are infinite: a film over no roughness."""
    return np.where(np.isfinite(values), values, np.nan)


def _each(data: xr.Dataset, axis: str, names: Sequence[str]) -> dict[str, Any]:
    """Figures by law."""
    return {
        str(law): {name: numbers(data[name].values[k]) for name in names}
        for k, law in enumerate(data[axis].values)
    }


FILM = Analysis(
    name="film",
    title="films",
    of="mesh",
    under_load=True,
    lacks=_dry,
    compute="pitchpoint.analyses.film:film_part",
    pieces=_line_pieces,
    joined="pitchpoint.analyses.film:joined",
    main=_MAIN,
    figures=_figures,
)

FINITE_FILM = Analysis(
    name="finite_film",
    title="films of finite contacts",
    of="mesh",
    under_load=True,
    lacks=_endless,
    compute="pitchpoint.analyses.finite_film:film_part",
    pieces=_finite_pieces,
    joined="pitchpoint.analyses.finite_film:joined",
    main=_MAIN,
    figures=_finite_figures,
)

FILM_SQUEEZE = Analysis(
    name="film_squeeze",
    title="squeeze of films over the engagement",
    of="mesh",
    under_load=True,
    lacks=_steady,
    compute="pitchpoint.analyses.film_squeeze:squeeze_part",
    pieces=_squeeze_pieces,
    joined="pitchpoint.analyses.film_squeeze:joined",
    onward="pitchpoint.analyses.film_squeeze:further",
    main=_SQUEEZE_MAIN,
    figures=_squeeze_figures,
)
