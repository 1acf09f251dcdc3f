"""Contacts of a mesh as wholes: slices of a contact line joined, with their relief as bent teeth leave it."""

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.film_contacts import (
    LEAST,
    by_pairs,
    contact_states,
    cycle_engagement,
    film_model_of,
    film_table,
)
from pitchpoint.cases.built import Built
from pitchpoint.cases.film_choices import USUAL_ENDS, end_surfaces
from pitchpoint.cases.height_maps import height_maps
from pitchpoint.contact.surface import Spot, Surface, Surfaces, missing
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import Design, Engagement
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import has
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading.tooth_compliance import Terms, bending
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line

__all__ = ["Wholes", "in_the_middle", "one_contact", "whole_contacts"]

PLACES = np.linspace(0.0, 1.0, 65)
"""Places along a contact line at which it is described, in parts of its length."""

SPAN = 1e-6
"""Part by which contact lines that span a face may differ in length."""

_SUMS = ("load", "sliding_loss", "rolling_loss", "load_by_law")
_PICKED = ("pressure", "radius", "path", "speed_a", "speed_b")


@dataclass(frozen=True, eq=False)
class Wholes:
    """Contacts of a cycle as wholes; a lane is [phase, pair, line].

    Attributes:
        states: what the contacts of a cycle carry and how they move, by lanes, as those of slices.
        numbers: what tells one contact from another, [..., number].
        scale: of these numbers.
        joined: whether the slices of a pair are parts of one line.
        middles: of the parts of each line, over its length, [phase, pair, line, part].
        profile: surfaces missing at the ends of every line.
    """

    states: dict[str, np.ndarray]
    numbers: np.ndarray
    scale: np.ndarray
    joined: bool
    middles: np.ndarray
    profile: tuple[Surface, ...]

    def grouped(self, values: np.ndarray) -> np.ndarray:
        """Values [..., phase, pair, slice] as [..., phase, pair, line, part]."""
        return _grouped(values, self.joined)


def _grouped(values: np.ndarray, joined: bool) -> np.ndarray:
    return values[..., None, :] if joined else values[..., :, None]


@lru_cache(maxsize=2)
def whole_contacts(built: Built) -> Wholes:
    """Whole contacts of the cycle of a case.

    Slices of a pair at several places across the face are parts of one line; a family that gives a pair
    several lines has them at one place.

    Raises:
        InputError: a profile of the ends of contact lines that come and go, or that does not fit.
    """
    cycle_states, shapes = contact_states(built), _shaped(built)
    joined = bool(np.any(np.ptp(shapes["width"], axis=-1) > 0.0))
    parts = {
        name: _grouped(values, joined)
        for name, values in {**cycle_states, **shapes}.items()
        if values.ndim > 2
    }
    middles = _middles(parts)
    contacts = _summed(cycle_states, parts, middles)
    if built.design.mesh.shape == "ellipse":
        numbers = np.stack(
            [contacts["load"], *(parts[name][..., 0] for name in _OF_ELLIPSE)], axis=-1
        )
        scale = _scale(numbers, [1] * numbers.shape[-1])
        return Wholes(contacts, numbers, scale, joined, middles, ())
    courses = _courses(built, parts, middles)
    numbers = np.concatenate(
        [contacts["load"][..., None], contacts["weight_of_line"][..., None], *courses], axis=-1
    )
    scale = _scale(numbers, [1, 1, *(len(PLACES) for _ in courses)])
    return Wholes(contacts, numbers, scale, joined, middles, _profile(built, contacts))


_OF_ELLIPSE = ("radius", "transverse_radius", "speed_a", "speed_b")


def _scale(numbers: np.ndarray, sizes: list[int]) -> np.ndarray:
    """Largest values of blocks of numbers, for each number."""
    ends = np.cumsum([0, *sizes])
    largest = [np.max(np.abs(numbers[..., a:b])) for a, b in pairwise(ends)]
    return np.repeat(largest, sizes)


def _middles(parts: dict[str, np.ndarray]) -> np.ndarray:
    weight = np.where(parts["active"], parts["weight_of_line"], 0.0)
    length = np.sum(weight, axis=-1, keepdims=True)
    middles: np.ndarray = (np.cumsum(weight, axis=-1) - 0.5 * weight) / np.where(
        length > 0.0, length, 1.0
    )
    return middles


def in_the_middle(middles: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Values [..., phase, pair, line, part] in the middle of each line.

    Args:
        middles: of the parts of each line, over its length.
        parts: values.
    """
    several = parts.reshape(-1, *middles.shape)
    centred = np.asarray(_placed(array(middles), array(several)))[..., len(PLACES) // 2]
    return centred.reshape(parts.shape[:-1])


def _summed(
    given: dict[str, np.ndarray], parts: dict[str, np.ndarray], middles: np.ndarray
) -> dict[str, np.ndarray]:
    """Values of whole contacts: sums over their slices, or those of the slice with the highest load.

    Film laws stand for the middle of a line.
    """
    active = parts["active"]
    most = np.argmax(parts["line_load"], axis=-1)[..., None]

    def at_most(values: np.ndarray) -> np.ndarray:
        where = np.broadcast_to(most, (*values.shape[:-1], 1))
        return np.take_along_axis(values, where, axis=-1)[..., 0]

    contacts = {name: values for name, values in given.items() if values.ndim < 3}
    contacts |= {name: np.sum(parts[name], axis=-1) for name in _SUMS}
    contacts |= {name: at_most(parts[name]) for name in _PICKED}
    length = np.sum(np.where(active, parts["weight_of_line"], 0.0), axis=-1)
    carried = np.where(contacts["load_by_law"] > 0.0, contacts["load_by_law"], 1.0)
    across = np.sum(np.where(active, parts["weight_of_line"] * parts["width"], 0.0), axis=-1)
    rubbed = np.sum(parts["friction"] * parts["load_by_law"], axis=-1)
    return contacts | {
        "active": np.any(active, axis=-1),
        # Lines that just come or go have next to no length, whatever they carry for it.
        "loaded": np.any(parts["loaded"], axis=-1)
        & (contacts["load"] > LEAST * contacts["load"].max()),
        "weight_of_line": length,
        "across": across / np.where(length > 0.0, length, 1.0),
        "line_load": contacts["load"] / np.where(length > 0.0, length, 1.0),
        "film_by_law": in_the_middle(middles, parts["film_by_law"]),
        "friction": np.where(contacts["load_by_law"] > 0.0, rubbed / carried, np.nan),
    }


def one_contact(
    built: Built, numbers: np.ndarray, *, moving: bool = False, model: FilmModel | None = None
) -> PatchContact:
    """A contact to solve.

    Args:
        built: the case.
        numbers: that tell it from others, as in `Wholes.numbers`.
        moving: whether height maps move along with their surfaces.
        model: how films are solved; that of the case by default.
    """
    design, model = built.design, model or film_model_of(built)
    rq = float(design.roughness.composite_rq)
    modulus = float(design.modulus)
    common: dict[str, Any] = {
        "modulus": modulus,
        "inlet": model.inlet,
        "fluid": model.fluid(design.lubricant, float(built.operation.temperature)),
        "texture": model.texture(rq, modulus),
        "conduction": model.conduction(design.lubricant),
        "heights": height_maps(film_table(built), moving=moving),
    }
    if design.mesh.shape == "ellipse":
        load, radius, transverse, speed_a, speed_b = numbers
        return elliptic_contact(
            load=load,
            radius=radius,
            transverse_radius=transverse,
            speed_a=speed_a,
            speed_b=speed_b,
            **common,
        )
    load, length = numbers[:2]
    radius, speed_a, speed_b, relief = numbers[2:].reshape(4, -1)
    return finite_line(
        load=load,
        length=length,
        radius=radius,
        speed_a=speed_a,
        speed_b=speed_b,
        places=length * (PLACES - 0.5),
        relief=relief,
        profile=whole_contacts(built).profile,
        ends=film_table(built).ends or USUAL_ENDS,
        **common,
    )


def _profile(built: Built, found: dict[str, np.ndarray]) -> tuple[Surface, ...]:
    """Surfaces at the ends of contact lines that all span the face."""
    lengths = found["weight_of_line"][found["loaded"]]
    if film_table(built).end_profile is None or not lengths.size:
        return ()
    if np.ptp(lengths) > SPAN * lengths.max():
        raise InputError(
            "was given; it is for contact lines that span the face, and those of these gears come and go; "
            "leave it out",
            key="film.end_profile",
        )
    return end_surfaces(film_table(built), float(lengths.max()), built.modulus)


# ---- along the lines


def _courses(built: Built, parts: dict[str, np.ndarray], middles: np.ndarray) -> list[np.ndarray]:
    """Radius, speeds and relief of every line at its places, [phase, pair, line, place]."""
    loaded_gap = parts["gap"] + parts["bends"] * parts["line_load"]
    names = ("radius", "speed_a", "speed_b")
    values = np.stack([*(parts[name] for name in names), loaded_gap])
    radius, speed_a, speed_b, relief = np.asarray(_placed(array(middles), array(values)))
    if any(built.design.mesh.surfaces):
        relief = relief + _missing_there(built, middles, parts)
    return [radius, speed_a, speed_b, relief - np.min(relief, axis=-1, keepdims=True)]


@program
def _placed(
    middles: Float[Arrays, "phase pair line part"], values: Float[Arrays, "k phase pair line part"]
) -> Float[Array, "k phase pair line place"]:
    """Values at the places of each line from those in the middles of its parts; straight on at its ends."""
    places = jnp.asarray(PLACES)
    if values.shape[-1] == 1:
        return jnp.broadcast_to(values, (*values.shape[:-1], places.size))

    def placed(at: Array, one: Array) -> Array:
        inside = jnp.interp(places, at, one)
        low = one[0] + _slope(at[:2], one[:2]) * (places - at[0])
        high = one[-1] + _slope(at[-2:], one[-2:]) * (places - at[-1])
        return jnp.where(places < at[0], low, jnp.where(places > at[-1], high, inside))

    lanes = jnp.broadcast_to(middles, values.shape).reshape(-1, values.shape[-1])
    at_places = jax.vmap(placed)(lanes, values.reshape(lanes.shape))
    return at_places.reshape(*values.shape[:-1], places.size)


def _slope(at: Array, values: Array) -> Array:
    apart = at[1] - at[0]
    return (values[1] - values[0]) / jnp.where(apart > 0.0, apart, 1.0)


def _missing_there(built: Built, middles: np.ndarray, parts: dict[str, np.ndarray]) -> np.ndarray:
    """Height that surfaces of both members miss at the places of each line."""
    spots = []
    for member in range(2):
        spot_arrays = {name: parts[f"{name}_{member}"] for name in _SPOT}
        every = np.asarray(_placed(array(middles), array(np.stack([*spot_arrays.values()]))))
        places = dict(zip(spot_arrays, every, strict=True))
        places["tooth"] = np.round(places["tooth"]).astype(int)
        spots.append(Spot(**places))
    return np.asarray(_missing(built.design.mesh.surfaces, (spots[0], spots[1])))


def _missing_of(surfaces: Surfaces, spots: tuple[Spot, Spot]) -> Array:
    """Height that surfaces of both members miss."""
    height_a, height_b = (
        missing(surface, spot) for surface, spot in zip(surfaces, spots, strict=True)
    )
    return height_a + height_b


_missing = program(_missing_of)


_SPOT = ("flank", "across", "angle", "tooth", "leaning")


def _shaped(built: Built) -> dict[str, np.ndarray]:
    """Where slices lie across the face, their gap but for surfaces, and what bends, [phase, pair, slice]."""
    models = built.models[0]
    terms = models.compliance if models.sharing.by_stiffness else None
    engagement = replace(cycle_engagement(built), body=None)
    lanes = jax.device_get(_shapes(built.design, engagement, terms))
    return {name: by_pairs(built, values) for name, values in lanes.items()}


@program
def _shapes(design: Design, engagement: Engagement, terms: Terms | None) -> dict[str, Array]:
    mesh, contacts = design.mesh, engagement.contacts
    lanes = contacts.active.shape
    gap, shapes = contacts.gap, {"width": contacts.width}
    if contacts.shape == "ellipse":
        shapes["transverse_radius"] = 1.0 / contacts.relative_curvature[1]
    if any(mesh.surfaces):
        spots = mesh.spots(contacts, engagement.phase)
        gap = gap - _missing_of(mesh.surfaces, spots)
        for member, spot in enumerate(spots):
            shapes |= {f"{name}_{member}": 1.0 * getattr(spot, name) for name in _SPOT}
    # Shares by stiffness know how far teeth bend; others take them as rigid.
    shapes |= {"gap": gap, "bends": jnp.zeros(lanes)}
    if terms is not None and has(mesh, tooth_sections) and lanes[1] > 1:
        shapes["bends"] = bending(contacts, tooth_sections(mesh), design.solids, terms)
    return {name: jnp.broadcast_to(lane_values, lanes) for name, lane_values in shapes.items()}
