"""Figures of films over a mesh cycle, whatever solved them: losses, efficiency, deviations, words."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.caveats import cold_warning, conformal_warning
from pitchpoint.analyses.film_contacts import film_laws_for_shape, film_model_of, film_table
from pitchpoint.analyses.film_series import series_figures
from pitchpoint.cases.built import Built
from pitchpoint.cases.film_choices import SUMMIT_CONSTANTS
from pitchpoint.contact.contact_registry import SUMMITS
from pitchpoint.core.doubts import REMARKED, Doubt, doubts_of, in_percent, reworded
from pitchpoint.core.status import Code, solve_summary, withheld
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL, SMOOTH
from pitchpoint.results.store import dataset

__all__ = ["cycle_films"]

States = Mapping[str, np.ndarray]
Again = Callable[[tuple[int, ...], float], tuple[float, float]]
"""Load on asperities and friction of the contact of a lane with another eta_beta_sigma."""

Lanes = Mapping[str, tuple[tuple[str, ...], np.ndarray]]

COUNTS = 0.05
"""Part of a contact's load on asperities from which on it is told what that rests on."""

SPREADS = 0.1 * COUNTS
"""The same from which on it may be that much with another set of summits, which are up to 24 times apart."""

APART = 2.0
"""Loads on asperities over one another from which on it is told that two sets of summits differ."""

LOWER = 0.05
"""Part by which the largest pressure is below Hertz's from which on it is told."""

UNEVEN = 0.3
"""Rq R/b2 from which on rough flanks lower the largest pressure by 5 % or more at low speed."""

_MASKED = ("pressure", "friction", "film_by_law")


def cycle_films(
    built: Built,
    states: States,
    parts: Sequence[xr.Dataset],
    lanes: tuple[str, ...],
    more: Lanes,
    again: Again,
    **attributes: Any,
) -> xr.Dataset:
    """Films of the cycle, with those by film laws and friction by the laws of the case beside them.

    Args:
        built: the case.
        states: what its contacts carry and how they move.
        parts: films by pieces, on points that are the phases.
        lanes: names of the axes of a contact.
        more: what else the dataset holds.
        again: solves the contact of a lane with another set of summits.
        attributes: of the dataset.
    """
    films = xr.concat(parts, "point", combine_attrs="drop").rename(point="phase")
    loaded, codes = states["loaded"], films["film_status"].values
    solved = {
        str(name): (tuple(map(str, variable.dims)), variable.values)
        for name, variable in films.items()
    }
    figures = _figures(built, states, {name: values for name, (_, values) in solved.items()})
    outcomes = codes[loaded] if loaded.any() else np.array([int(Code.UNLOADED)])
    laws = film_laws_for_shape(built.design.mesh.shape)
    spread = _by_summits(built, films, again)
    steps = np.array([int(part.attrs["iterations"]) for part in parts])
    data = dataset(
        {
            **solved,
            **_beside(states, lanes),
            **_figure_dims(figures),
            **{name: (("summits",), values) for name, values in spread.items()},
            "weight": (("phase",), states["weight"]),
            **more,
        },
        {
            "phase": ("phase", states["phase"]),
            "law": built.law_names,
            "film_law": [law.name for law in laws],
            **({"summits": list(SUMMITS)} if spread else {}),
        },
        travels=built.travels,
        warnings=[
            *_lost(codes[loaded]),
            *_of_pieces(parts),
            *_about(built, states, films),
            *_of_summits(spread),
        ],
        solve=solve_summary(outcomes, _residuals(parts, outcomes), steps),
        film_titles=[law.title for law in laws],
        film_places=[law.place for law in laws],
        choices=_choices(built),
        other_rolling=_other_rolling(built),
        assumed=_assumed(built, figures),
        below_hertz=_below_hertz(built, states, figures),
        pitch=str(built.way["pitch"]),
        **attributes,
    )
    data["path"].attrs.update(built.way)
    return data


def _figure_dims(
    figures: Mapping[str, np.ndarray],
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Figures with their dimensions: of all laws of film or friction, of the phases, or none."""
    axes = {
        "film_deviation": ("film_law",),
        "largest_film_deviation": ("film_law",),
        "film_loss": ("phase",),
        "law_loss": ("law", "phase"),
    }
    return {
        name: (axes.get(name, ("law",)[: np.ndim(figure)]), np.asarray(figure))
        for name, figure in figures.items()
    }


def _beside(
    states: States, lanes: tuple[str, ...]
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Conditions at the contacts, and what film laws and friction laws say there."""
    loaded = states["loaded"]
    values = {name: np.where(loaded, states[name], np.nan) for name in _MASKED}
    axes = {"friction": ("law",), "film_by_law": ("film_law",)}
    conditions = {name: states[name] for name in ("load", "radius", "path")}
    conditions |= {
        "entrainment": np.abs(states["speed_a"] + states["speed_b"]) / 2.0,
        "sliding_velocity": states["speed_a"] - states["speed_b"],
        "active": states["active"],
    }
    every = {**conditions, **values}
    return {name: ((*axes.get(name, ()), *lanes), array) for name, array in every.items()}


def _figures(
    built: Built, states: States, found: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Figures of the cycle; what needs all loaded contacts is withheld if one of them is missing."""
    loaded, weight = states["loaded"], states["weight"]
    solved = loaded & (found["film_status"] == Code.SOLVED)
    complete = np.where(np.array_equal(solved, loaded) and loaded.any(), 1.0, np.nan)
    load = np.where(loaded, states["load"], 0.0)

    def mean(values: np.ndarray) -> np.ndarray:
        """Mean over the cycle of sums over the contacts that carry."""
        sums = np.sum(np.where(loaded, np.nan_to_num(values), 0.0), axis=(-2, -1))
        return np.asarray(sums @ weight)

    total = mean(load) if loaded.any() else np.nan
    law_load = states["load_by_law"]
    sliding, rolling = (
        mean(found[f"film_{kind}_loss"]) * complete for kind in ("sliding", "rolling")
    )
    by_law = states["sliding_loss"] + states["rolling_loss"]
    figures = {
        **_extremes(found),
        "mean_film_friction": mean(load * found["film_friction"]) / total * complete,
        "mean_boundary_part": mean(load * found["boundary_part"]) / total * complete,
        "mean_law_friction": mean(law_load * states["friction"]) / mean(law_load)
        if loaded.any()
        else law_load[:, 0, 0, 0] * np.nan,
        "mean_film_sliding_loss": sliding,
        "mean_film_rolling_loss": rolling,
        "mean_film_loss": sliding + rolling,
        "mean_law_loss": mean(by_law),
        "mean_law_rolling_loss": mean(states["rolling_loss"]),
        "film_loss": _course(found, loaded, solved),
        "law_loss": np.sum(np.where(loaded, by_law, 0.0), axis=(-2, -1)),
        "loaded_contacts": np.sum(loaded),
        "solved_contacts": np.sum(solved),
        **_deviations(built, states["film_by_law"], found, solved),
    }
    figures |= _efficiencies(states, figures)
    return (
        figures | series_figures(built, states, found) if film_table(built).in_series else figures
    )


def _extremes(found: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Smallest and largest values of the films that were found."""
    low = {"smallest_film": "minimum_film", "smallest_lambda": "minimum_lambda"}
    high = {
        "largest_film_pressure": "film_pressure",
        "largest_asperity_share": "asperity_share",
        "largest_central_film_error": "central_film_error",
        "largest_minimum_film_error": "minimum_film_error",
        "largest_film_rise": "film_rise",
        "largest_flash_rise": "flash_rise",
    }
    high = {name: variable for name, variable in high.items() if variable in found}

    def end(name: str, reduce: Any) -> Any:
        some = found[name][~np.isnan(found[name])]
        return reduce(some) if some.size else np.nan

    return {name: end(variable, np.min) for name, variable in low.items()} | {
        name: end(variable, np.max) for name, variable in high.items()
    }


def _course(found: Mapping[str, np.ndarray], loaded: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Loss by the films over the cycle; withheld at phases where a loaded contact is missing."""
    lost = found["film_sliding_loss"] + found["film_rolling_loss"]
    course = np.sum(np.where(known, np.nan_to_num(lost), 0.0), axis=(-2, -1))
    missing = np.any(loaded & ~known, axis=(-2, -1))
    return np.where(missing, np.nan, course)


def _deviations(
    built: Built, by_law: np.ndarray, found: Mapping[str, np.ndarray], known: np.ndarray
) -> dict[str, np.ndarray]:
    """Films by law over those solved at the same place less one: mean, and where it is largest.

    Laws of lines know no ends: their smallest film is that of a row in the middle. Where mean planes
    overlap there is no film to compare with.
    """
    least = "row_film" if "row_film" in found else "minimum_film"
    solved = {"minimum": found[least], "central": found["central_film"]}
    apart = {place: known & (film > 0.0) for place, film in solved.items()}
    deviations = [
        law_film[apart[law.place]] / solved[law.place][apart[law.place]] - 1.0
        for law, law_film in zip(film_laws_for_shape(built.design.mesh.shape), by_law, strict=True)
    ]
    largest = [
        deviation[np.argmax(np.abs(deviation))] if deviation.size else np.nan
        for deviation in deviations
    ]
    return {
        "film_deviation": np.array(
            [deviation.mean() if deviation.size else np.nan for deviation in deviations]
        ),
        "largest_film_deviation": np.array(largest),
    }


def _efficiencies(states: States, figures: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Efficiency by films and by law with the losses beside the teeth, and how far the laws are off."""
    weight = states["weight"]
    out, drag = states["output_power"] @ weight, states["drag_loss"] @ weight
    film, law = figures["mean_film_loss"], figures["mean_law_loss"]
    with np.errstate(divide="ignore", invalid="ignore"):
        return {
            "film_efficiency": np.where(out > 0.0, out / (out + drag + film), np.nan),
            "law_efficiency": np.where(out > 0.0, out / (out + drag + law), np.nan),
            "friction_deviation": figures["mean_law_friction"] / figures["mean_film_friction"]
            - 1.0,
            "loss_deviation": law / film - 1.0,
        }


# ---- words


def _lost(codes: np.ndarray) -> list[Doubt]:
    """Loaded contacts whose film was not found, by what became of them."""
    return withheld(
        codes[codes != Code.SOLVED],
        lambda count, why: (
            f"Films: {count} of {codes.size} loaded contacts have no film ({why}); the loss and efficiency "
            "by films are withheld.",
            f"No film in {count} of {codes.size} contacts: loss withheld.",
        ),
    )


def _of_pieces(parts: Sequence[xr.Dataset]) -> list[str]:
    """Warnings of all pieces: of a kind the worst one, and where it is."""
    ends = np.cumsum([0, *(part.sizes["point"] for part in parts)])
    kinds: dict[str, list[tuple[Doubt, str]]] = {}
    for k, part in enumerate(parts):
        where = f", phases {ends[k] + 1} to {ends[k + 1]} of {ends[-1]}" if len(parts) > 1 else ""
        for doubt in doubts_of(part.attrs):
            kinds.setdefault(doubt.kind, []).append((doubt, where))
    return [_worst(doubts) for doubts in kinds.values()]


def _worst(told: Sequence[tuple[Doubt, str]]) -> Doubt:
    """The worst one of warnings of one kind, with their places."""
    doubt, where = max(told, key=lambda one: one[0].extent)
    others = ", and less at others" if len(told) > 1 else ""
    return reworded(doubt, f"Films{where}{others}: {{}}.".format, "Films: {}.".format)


def _about(built: Built, states: States, found: xr.Dataset) -> list[str]:
    """What the films leave out."""
    run = {"load": np.where(states["loaded"], states["load"], 0.0), "radius": states["radius"]}
    isothermal = film_model_of(built).thermal == ISOTHERMAL
    cold = [cold_warning(built, _moving(states, found))] if isothermal else []
    return [
        *cold,
        *(reworded(text, "Films: {}".format) for text in conformal_warning(built.design.mesh, run)),
    ]


def _moving(states: States, found: xr.Dataset) -> dict[str, np.ndarray]:
    """Contacts that carry, as a mesh cycle tells them, with what the films say.

    Sliding is its mean by the traction, so that friction, load and it give the sliding power.
    """
    drawn = found["film_friction"].values * states["load"]
    lost, central = found["film_sliding_loss"].values, found["central_film"].values
    every = {
        "pressure": states["pressure"],
        "radius": states["radius"],
        "entrainment": 0.5 * (states["speed_a"] + states["speed_b"]),
        "sliding_velocity": lost / np.where(drawn > 0.0, drawn, 1.0),
        "friction": found["film_friction"].values,
        "film_thickness": np.where(np.isnan(central), found["minimum_film"].values, central),
    }
    solved = np.isfinite(every["friction"])
    return {name: values[solved] for name, values in every.items()}


def _other_rolling(built: Built) -> str:
    """Why a law that solves films has another loss than its films; empty where it has not."""
    solved = [models.law.title for models in built.models if models.law.films is not None]
    model = built.models[0].rolling
    if not solved or model.name == "none":
        return ""
    return (
        f"{solved[0]}: the case takes rolling resistance from {model.title}; that of the films, which stands "
        "beside it here, is their own."
    )


def _assumed(built: Built, figures: Mapping[str, np.ndarray]) -> str:
    """What of the films rests on assumed asperities; empty where they carry little or were given."""
    names = [name for name in SUMMIT_CONSTANTS if getattr(film_table(built), name) is None]
    if not names or not figures["largest_asperity_share"] > COUNTS:
        return ""
    part = 100.0 * figures["mean_boundary_part"] / figures["mean_film_friction"]
    friction = f", and {part:.0f} % of the friction, rest" if np.isfinite(part) else " rests"
    values = " and ".join(f"{name} {getattr(film_model_of(built), name):g}" for name in names)
    return f"the load on asperities{friction} on assumed {values}"


def _by_summits(built: Built, found: xr.Dataset, again: Again) -> dict[str, np.ndarray]:
    """Load on asperities and friction with every set of summits, where asperities carry most.

    Nothing where they carry next to nothing, or where the constant by which the sets differ was given.
    """
    share = np.nan_to_num(found["asperity_share"].values)
    if film_table(built).eta_beta_sigma is not None or not share.max(initial=0.0) > SPREADS:
        return {}
    lane = tuple(int(k) for k in np.unravel_index(np.argmax(share), share.shape))
    chosen, solved = (
        film_table(built).set_of_summits.name,
        (share[lane], found["film_friction"].values[lane]),
    )
    shares_and_frictions = [
        solved if summits.name == chosen else again(lane, summits.eta_beta_sigma)
        for summits in SUMMITS.values()
    ]
    shares, frictions = np.array(shares_and_frictions, float).T
    return {"summits_share": shares, "summits_friction": frictions}


def _of_summits(spread: Mapping[str, np.ndarray]) -> Iterator[Doubt]:
    """That sets of summits differ, where that counts."""
    if not spread:
        return
    shares, frictions = spread["summits_share"], spread["summits_friction"]
    if not (np.max(shares) > COUNTS and np.max(shares) > APART * np.min(shares)):
        return
    texts = (
        f"{in_percent(share)} of the load and friction is {friction:.2g} with the {summits.title}"
        for summits, share, friction in zip(SUMMITS.values(), shares, frictions, strict=True)
    )
    yield Doubt(
        f"Films: where asperities carry most, they carry {', and '.join(texts)}; both sets are assumed, and "
        "friction and wear lie between them unless `eta_beta_sigma` is that of the measured surfaces.",
        moves=max(REMARKED, 1.0 - np.min(frictions) / np.max(frictions)),
        brief=f"Films: friction is {np.min(frictions):.2g} to {np.max(frictions):.2g} by assumed summits.",
    )


def _below_hertz(built: Built, states: States, figures: Mapping[str, np.ndarray]) -> str:
    """Why rough flanks have a largest pressure below that of the dry contact; empty if they have not."""
    smooth = film_model_of(built).asperities == SMOOTH
    if smooth or film_table(built).over_patch or not states["loaded"].any():
        return ""  # pressures of patches stand beside those of their own dry contacts
    most = np.argmax(np.where(states["loaded"], states["pressure"], 0.0))
    pressure, radius = (states[name].reshape(-1)[most] for name in ("pressure", "radius"))
    # b = 4 p R/E' of a dry line contact.
    half_width = 4.0 * pressure * radius / built.modulus
    ratio = float(built.design.roughness.composite_rq) * radius / half_width**2
    lacks = 1.0 - figures["largest_film_pressure"] / pressure
    if not (lacks > LOWER and ratio > UNEVEN):
        return ""
    return (
        f"The largest pressure is {100.0 * lacks:.0f} % below Hertz's: rough flanks spread the load beyond "
        f"the dry contact, where Rq R/b² is {ratio:.2g}."
    )


def _choices(built: Built) -> dict[str, Any]:
    """The choices behind the films, by name."""
    model = film_model_of(built)
    return {
        "nodes": model.nodes,
        "viscosity_law": model.viscosity_law,
        "density_law": model.density_law,
        "shear_law": model.shear_law,
        "asperities": model.asperities,
        "boundary_friction": model.boundary_friction,
        "inlet": model.inlet,
        "thermal": model.thermal,
    }


def _residuals(parts: Sequence[xr.Dataset], codes: np.ndarray) -> np.ndarray:
    largest = max(float(part.attrs["residual"]) for part in parts)
    return np.full(codes.shape, largest)
