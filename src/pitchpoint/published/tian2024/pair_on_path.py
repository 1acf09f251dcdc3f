"""What Tian et al. (2024) draw over the path of contact of one pair of teeth: Figs. 4 to 7 and 12."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import total
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.tian2024.table import PairOnPath

__all__ = ["METHODS", "readings"]

METHODS = {
    "average": ("tian2024.method_1", "iso_tr_14179_2"),
    "varying": ("tian2024.method_2", "xu_2007"),
}
"""Methods I and II with the laws that stand for them: as the paper prints them, and as their authors did."""

_BESIDE = 1e-9
"""Distance in base pitches from where single contact begins or ends: shares jump there."""

Course = Float[np.ndarray, " place"]


def readings(point: ReadingPoint) -> dict[str, float | Course]:
    """Courses of a pair that begins its mesh at A, and the numbers that the paper tells of them.

    Args:
        point: with a friction law for each of `METHODS`, in any order; Table 3 takes Method I with the
            nominal load and without its factor beside both.

    Raises:
        InputError: the contact ratio does not lie between 1 and 2, or there are fewer laws.
    """
    assert isinstance(point.formulas, PairOnPath)
    mesh = point.design.mesh
    assert isinstance(mesh, InvolutePair)
    laws = {models.law.name: models for models in point.models}
    methods = {method: _law_of(method, laws) for method in METHODS}
    places = _places(mesh, int(point.formulas.places))
    conditions = point.design, point.operation, array(places)
    by_law = {name: jax.device_get(_along(*conditions, models)) for name, models in laws.items()}
    courses = {"pair_path": places, "pair_share": by_law[methods["average"]]["share"]}
    for method, law in methods.items():
        courses |= {f"pair_{name}_{method}": by_law[law][name] for name in _OF_METHODS}
    numbers = _at_ends(courses) | _statements(courses)
    table = _table_3(point, {law: course["efficiency"] for law, course in by_law.items()})
    return {**courses, **numbers, **table}


def _law_of(method: str, laws: Mapping[str, Models]) -> str:
    for law in METHODS[method]:
        if law in laws:
            return law
    raise InputError(
        f"the courses of a pair compare two friction laws; for the {method} coefficient "
        f"{' or '.join(METHODS[method])} is needed",
        key="models.friction",
    )


_OF_METHODS = ("force", "friction", "other_friction", "efficiency", "input_torque")


def _statements(courses: dict[str, Course]) -> dict[str, float]:
    """What the text says of Figs. 4 to 6, as numbers that are positive where it holds."""

    def of(name: str, *, single: bool) -> Course:
        quarters = np.reshape(courses[name], (4, -1))
        return (quarters[1:3] if single else quarters[[0, 3]]).ravel()

    share, *force = (of(name, single=False) for name in ("pair_share", *_of_methods("pair_force")))
    friction = [of(name, single=False) for name in _of_methods("pair_friction")]
    step = {
        f"efficiency_step_{method}": float(
            np.min(of(name, single=True)) - np.max(of(name, single=False))
        )
        for method, name in zip(METHODS, _of_methods("pair_efficiency"), strict=True)
    }
    return {
        "force_excess_average": float(np.min(force[0] - share)),
        "force_excess_varying": float(np.min(force[1] - force[0])),
        "friction_excess": float(np.min(friction[1] - friction[0])),
        **step,
    }


def _of_methods(name: str) -> tuple[str, ...]:
    return tuple(f"{name}_{method}" for method in METHODS)


def _places(mesh: InvolutePair, count: int) -> Course:
    """Places from A [base pitches], the ends of single contact from both sides."""
    zones = jax.device_get(_zones(mesh))
    if not 1.0 < zones[-1] < 2.0:
        sentence = f"{zones[-1]:.4g} is the contact ratio; these courses are those of ratios between 1 and 2"
        raise InputError(sentence, key="gears")
    if not zones[1] < zones[2] < zones[3]:
        sentence = "the pitch point lies in double contact; these courses have it in single contact"
        raise InputError(f"{sentence}, change the profile shifts", key="gears.profile_shift")
    return np.concatenate(
        [np.linspace(low + _BESIDE, high - _BESIDE, count) for low, high in pairwise(zones)]
    )


@program
def _zones(mesh: InvolutePair) -> Float[Array, "5"]:
    """Start of the path and of single contact, pitch point, ends of both [base pitches]."""
    line = mesh.line
    ratio = mesh.transverse_contact_ratio
    pitch = (line.pitch_position - line.limits[0]) / line.base_pitch
    return jnp.stack([jnp.zeros_like(ratio), ratio - 1.0, pitch, jnp.ones_like(ratio), ratio])


def _at_ends(courses: dict[str, Course]) -> dict[str, float]:
    """Shares and forces where mesh and single contact begin and end."""
    final, count = len(courses["pair_path"]) - 1, len(courses["pair_path"]) // 4
    places = {"entry": 0, "double": count - 1, "single": count, "exit": final}
    names = {"load_share_{}": "pair_share"}
    names |= {f"force_{{}}_{method}": f"pair_force_{method}" for method in METHODS}
    return {
        pattern.format(end): float(courses[name][place])
        for end, place in places.items()
        for pattern, name in names.items()
    }


@program
def _along(
    design: Design, operation: Operation, place: Float[Array, " place"], models: Models
) -> dict[str, Float[Array, " place"]]:
    """Courses of the pair under one friction law, and of the one that shares the load with it.

    Source: Tian et al. (2024), eqs. 1 to 3, 11, 16 and 18, the last over the force at the base circle.
    """
    mesh_state = state(design, operation, place, models)
    number = jnp.floor(place).astype(int)
    active, load = mesh_state.contacts.active[:, 0], mesh_state.balance.load[:, 0]
    lane = jnp.arange(load.shape[0])[:, None]

    def of_pair(values: Float[Array, "pair 1 place"]) -> Float[Array, " place"]:
        return jnp.take_along_axis(values[:, 0], number[None], axis=0)[0]

    others = active & (lane != number)
    friction = mesh_state.balance.friction
    other_friction = jnp.sum(jnp.where(others, friction[:, 0], 0.0), axis=0)
    return {
        "share": of_pair(mesh_state.balance.load) / total(mesh_state.balance.load),
        "force": of_pair(mesh_state.balance.load) / mesh_state.balance.frictionless,
        "friction": of_pair(friction),
        "other_friction": jnp.where(jnp.any(others, axis=0), other_friction, jnp.nan),
        "efficiency": mesh_state.efficiency,
        "input_torque": mesh_state.input_torque,
    }


_TABLE_3 = {
    "hohn": "tian2024.method_1_nominal",
    "diez_ibarbia": "tian2024.method_1_factor_1",
    "average": "tian2024.method_1",
    "varying": "tian2024.method_2",
}
"""Methods of Table 3 and their laws; the first one is a loss factor times a mean coefficient."""


def _table_3(point: ReadingPoint, efficiency: Mapping[str, Course]) -> dict[str, float | Course]:
    """Mean and instantaneous efficiency by the methods of Table 3; nothing without its four laws."""
    if not efficiency.keys() >= {*_TABLE_3.values()}:
        return {}
    operation = [(point.design, point.operation)]
    means = {models.law.name: summarise(operation, models) for models in point.models}
    nominal = means[_TABLE_3["hohn"]]
    hohn = 1.0 - float(nominal["mean_friction"][0] * nominal["loss_factor"][0])
    table: dict[str, float | Course] = {
        "table_3_hohn": hohn,
        "compared_hohn": np.full_like(efficiency[_TABLE_3["hohn"]], hohn),
    }
    for method, law in _TABLE_3.items():
        if method != "hohn":
            table[f"table_3_{method}"] = float(means[law]["mean_efficiency_path"][0])
            table[f"compared_{method}"] = efficiency[law]
    return table
