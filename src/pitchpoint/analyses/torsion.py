"""Wind-up of a drive under load, as a dataset of a case."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.caveats import proportions_counted, proportions_words
from pitchpoint.analyses.main_figures import WIND_UP, by_torque, numbers
from pitchpoint.analyses.three_slopes import PARTS, as_in_catalogues, torques_of_catalogues
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.contact.contacts import Contacts, contact_velocity
from pitchpoint.core.doubts import Doubt, in_percent, in_stage
from pitchpoint.core.programs import program
from pitchpoint.core.status import locked_or_lost, solve_summary
from pitchpoint.efficiency.drag import at_rest, bearing_loads
from pitchpoint.efficiency.quasi_static import Design, Engagement, coupling, engagement
from pitchpoint.efficiency.summary import summarise
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.on_balls import Body, OnBalls, separation_on_balls
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.loading.equilibrium import touching_approach
from pitchpoint.loading.wind_up import body_parts, hysteresis, wound_up
from pitchpoint.results.store import dataset

__all__ = [
    "engaged_at",
    "kinematic_play",
    "onset_friction",
    "stiffness_at_load",
    "torsion_figures",
    "torsion_of",
    "torsion_part",
    "wound_ups",
]

TORQUES = 25
MUCH = 0.03
"""Part of the load on edges from which on a sentence says so."""

SHOWN = 3
"""Every so many phases the load on every tooth is kept."""

_OTHER_STIFFNESS = ("tangent_torsional_stiffness", "phase_mean_torsional_stiffness")


def torsion_part(built: Ready) -> xr.Dataset:
    """Wind-up, stiffness and load on every pair for torques up to twice that of the operating point."""
    torques = _torques(built)
    return _of_drive(built, torques) if built.numbers else _of_mesh(built.meshes[0], torques)


def _torques(built: Ready) -> np.ndarray:
    """Torques at the output up to twice that of the operating point."""
    return np.linspace(0.0, 2.0 * built.case.operation.load or 1.0, TORQUES)


def _of_drive(built: Ready, torques: np.ndarray) -> xr.Dataset:
    """Wind-up and stiffness at the output: stages are springs one behind the other.

    Each adds its rotation times the ratio between it and the output, and carries the load times the
    same ratio. Pins of planets that yield are springs behind the teeth of their set. Of the phases the worst
    meeting counts.
    """
    steps, copies = built.steps, np.array(built.copies)
    torsions, numbers = _of_meshes(built, torques), np.array(built.mesh_numbers)
    together = [numbers == number for number in built.numbers]

    def at_output(name: str) -> np.ndarray:
        return np.stack(
            [step * torsion[name] for step, torsion in zip(steps, torsions, strict=True)], -1
        )

    slopes = np.stack([torsion["tangent_torsional_stiffness"] for torsion in torsions], -1)
    slopes *= copies / steps**2
    turned, pins = at_output("wind_up"), built.pin_compliances
    of_stages = np.array([pins.get(number, 0.0) for number in built.numbers])
    yielded = _summed(1.0 / slopes, together) + of_stages
    stage_turned = _summed(turned, together) + of_stages * torques[:, None]
    # Those of a set in a file of its own are of none of its meshes alone.
    slope = 1.0 / (yielded.sum(axis=-1) + pins.get(0, 0.0))
    turned = stage_turned.sum(axis=-1) + pins.get(0, 0.0) * torques
    yields, rigid = _yielding(built)
    parts = _parts_of_meshes(built, steps, torsions) | {
        f"stage {number}: {PINS}" if number else PINS: compliance * torques
        for number, compliance in pins.items()
        if compliance
    }
    assumed = proportions_words(built.meshes)
    data = dataset(
        {
            "wind_up": (("torque",), turned),
            "stage_wind_up": (("torque", "stage"), stage_turned),
            "torsional_stiffness": (("torque",), _secant(torques, turned, slope)),
            "tangent_torsional_stiffness": (("torque",), slope),
            "stage_torsional_stiffness": (
                ("torque", "stage"),
                _secant(torques[:, None], stage_turned, 1.0 / yielded),
            ),
            "angular_transmission_error_range": (
                ("torque",),
                at_output("angular_transmission_error_range").sum(axis=-1),
            ),
            "kinematic_play": ((), at_output("kinematic_play").sum()),
            **(
                {"wind_up_part": (("part", "torque"), np.stack([*parts.values()]))} if parts else {}
            ),
        },
        {
            "torque": ("torque", torques),
            "stage": [*built.numbers],
            **({"part": [*parts]} if parts else {}),
        },
        title="torsion",
        travels=built.travels,
        warnings=[
            *_lost(built, turned, torques),
            *_on_edges_of_meshes(built, torques, torsions),
        ],
        note=f"{'; '.join(yields)} yield; {'; '.join(rigid)} are not in it{assumed}",
        brief=f"{'; '.join(rigid)} are not in it{proportions_counted(built.meshes)}",
        left_out=_left_out(built, any(torsion["parts"] for torsion in torsions)),
        solve=solve_summary(locked_or_lost(False, np.isnan(turned))),
    )
    data["torsional_stiffness"].attrs.update(_covered("; ".join(yields), assumed))
    return data


_SLOPELESS = (
    "Slopes K1 to K3, lost motion and hysteresis loss as in catalogues are those of one mesh: the strain "
    "wave gear in a file of its own has them."
)

_IDLE_PINS = (
    "pin_stiffness does not count: the carrier is free, and the meshes of a planet hold each other in "
    "balance along the circle of its pin."
)


def _left_out(built: Ready, slopeless: bool) -> str:
    """Sentences on what catalogues have and a drive has not, and on pins that bear nothing."""
    tables = [(train.case.train, train.pin_step) for train in built.trains.values()]
    idle = any(table and table.pin_stiffness and not step for table, step in tables)
    return " ".join([*[_SLOPELESS] * slopeless, *[_IDLE_PINS] * idle])


def _of_meshes(built: Ready, torques: np.ndarray) -> list[dict[str, Any]]:
    """What winds up in one copy of each mesh under torques at the output, without friction."""
    unloaded = np.zeros(len(built.models))
    stepped_meshes = zip(built.meshes, built.steps, built.copies, strict=True)
    return [
        _torsion(mesh, torques * step / count, unloaded) for mesh, step, count in stepped_meshes
    ]


def stiffness_at_load(built: Ready) -> float:
    """Torque at the output over its turn with the input held, at the load of the operating point [N m/rad].

    As `torsion_part` has it there; not a number where there is no load or no equilibrium.

    Args:
        built: the case, whether or not it asks how its teeth yield.
    """
    load = built.case.operation.load
    torsions = _of_meshes(built, np.array([load]))
    turned = sum(
        step * torsion["wind_up"][0] for step, torsion in zip(built.steps, torsions, strict=True)
    )
    turned += sum(built.pin_compliances.values()) * load
    return float(load / turned) if turned > 0.0 else float("nan")


def mesh_slopes(built: Ready) -> np.ndarray:
    """Torque over turn of the driven member of one copy of each mesh, the slope at its load [N m/rad]."""
    torques, load = _torques(built), built.case.operation.load
    slopes = (torsion["tangent_torsional_stiffness"] for torsion in _of_meshes(built, torques))
    return np.array([np.interp(load, torques, slope) for slope in slopes])


def _parts_of_meshes(
    built: Ready, steps: np.ndarray, each: list[dict[str, Any]]
) -> dict[str, np.ndarray]:
    """Parts of the wind-up at the output by stage and name [rad].

    Nothing where no body couples teeth and no pins of planets yield.
    """
    if not (any(torsion["parts"] for torsion in each) or any(built.pin_compliances.values())):
        return {}
    parts: dict[str, np.ndarray] = {}
    for label, step, torsion in zip(_part_labels(built), steps, each, strict=True):
        for name, values in (torsion["parts"] or {"teeth": torsion["wind_up"]}).items():
            part = f"{label}: {name}"
            parts[part] = parts.get(part, 0.0) + step * values
    return parts


def _part_labels(built: Ready) -> list[str]:
    """What each mesh is called among parts of the wind-up: its stage, in a set by itself its bodies."""
    if 0 in built.trains:
        return [*built.stage_bodies]
    return [f"stage {number}" for number in built.mesh_numbers]


def _summed(values: np.ndarray, together: Sequence[np.ndarray]) -> np.ndarray:
    """Sums over the meshes of each stage [torque stage]."""
    return np.stack([values[:, of_stage].sum(axis=-1) for of_stage in together], -1)


PINS = "pins of the planets"


def _yielding(built: Ready) -> tuple[dict[str, None], dict[str, None]]:
    """What yields in meshes and sets, and what is left out, in words."""
    told_parts = (mesh.design.mesh.body.yielding for mesh in built.meshes)
    yields, rigid = (dict.fromkeys(words) for words in zip(*told_parts, strict=True))
    # Those of a free carrier bear nothing along their circle.
    bearing = {number: train for number, train in built.trains.items() if train.pin_step}
    for number, train in reversed(bearing.items()):
        pins = f"pins of stage {number}" if number else PINS
        if train.pin_compliance:
            yields[pins] = None
        else:
            behind, *others = rigid
            rigid = dict.fromkeys((f"{pins}, {behind}", *others))
    return yields, rigid


def _on_edges_of_meshes(built: Ready, torques: np.ndarray, each: list[dict[str, Any]]) -> list[str]:
    return [
        in_stage(number, sentence)
        for number, torsion in zip(built.mesh_numbers, each, strict=True)
        for sentence in _on_edges(built, torques, _edges(torsion))
    ]


def _covered(yields: str, assumed: str) -> dict[str, str]:
    """Attributes on what a stiffness is of: what yields, and what of it is assumed if anything is."""
    return {"covers": yields} | ({"assumed": assumed} if assumed else {})


def _of_mesh(built: Built, torques: np.ndarray) -> xr.Dataset:
    friction, rated = onset_friction(built), built.case.operation.load
    limits = getattr(built.case.gears, "slopes", None)
    told_of = built.design.mesh.body.couples and rated > 0.0 and _reduces(built)
    catalogue_torques = torques_of_catalogues(rated, limits) if told_of else torques[:0]
    every = np.union1d(torques, catalogue_torques)
    at = np.isin(every, torques)
    torsion = _torsion(built, every, friction)
    dims = {
        "path": ("phase", "pair"),
        "kinematic_play": (),
        "wind_up_by_balls": (),
        "angular_transmission_error": ("torque", "phase"),
        "mesh_torsional_stiffness": ("torque", "phase"),
        "tooth_force": ("torque", "phase", "pair"),
        "zone_load": ("torque", "zone"),
        "loading_torque": ("law", "torque"),
        "unloading_torque": ("law", "torque"),
    }
    phase, solve = torsion.pop("phase"), torsion.pop("solve")
    parts = torsion.pop("parts")
    data = {name: (dims.get(name, ("torque",)), values) for name, values in torsion.items()}
    if told_of:
        held, play = torsion["loading_torque"] - every, float(torsion["kinematic_play"])
        data |= as_in_catalogues(every, torsion["wind_up"], held, play, rated, limits)
        data["wind_up_part"] = (("part", "torque"), np.stack([*parts.values()]))
    yields, rigid = built.design.mesh.body.yielding
    assumed = proportions_words([built])
    at_rated = float(np.interp(rated, every, torsion["wind_up"]))
    at_all_torques = dataset(
        {**data, "mean_friction": (("law",), friction)},
        {
            "law": built.law_names,
            "torque": ("torque", every),
            "phase": ("phase", phase),
            **({"slope": [*PARTS], "part": [*parts]} if told_of else {}),
        },
        title="torsion",
        travels=built.travels,
        warnings=[
            *_lost(built, torsion["wind_up"][at], torques),
            *_on_edges(built, torques, _edges(torsion)[at]),
            *_loopless(built, friction),
            *(_pressed(float(torsion["kinematic_play"])) if _on_balls(built) else []),
        ],
        note=f"{yields} yield; {rigid} are not in it{assumed}{_of_balls(torsion, at_rated)}",
        brief=f"{rigid} are not in it{proportions_counted([built])}",
        solve=solve,
    )
    at_all_torques["torsional_stiffness"].attrs.update(_covered(yields, assumed))
    at_all_torques["path"].attrs.update(built.way)
    return at_all_torques.isel(torque=at)


def _reduces(built: Built) -> bool:
    """True if the loaded member is the slower one, of which catalogues tell slopes and lost motion."""
    driver, loaded = (
        abs(built.nominal[end] @ built.nominal["motion"]) for end in ("driver", "loaded")
    )
    return bool(driver > loaded)


def _edges(found: Mapping[str, np.ndarray]) -> np.ndarray:
    """Part of the load on edges; none of teeth that nobody watches for them."""
    return found.get("edge_share", np.zeros(found["wind_up"].shape))


def _lost(built: Ready, wind_up: np.ndarray, torques: np.ndarray) -> list[str]:
    """Torques at which teeth, ring and cup found no equilibrium."""
    lost = torques[np.isnan(wind_up)]
    if not lost.size:
        return []
    between = " to ".join(
        dict.fromkeys(built.carried.show(torque) for torque in (lost[0], lost[-1]))
    )
    return [
        Doubt(
            f"Wind-up: no equilibrium was found at {lost.size} of {torques.size} torques ({between}); they "
            "are left out.",
            brief=f"Wind-up: none found at {lost.size} of {torques.size} torques.",
        )
    ]


def _on_edges(built: Ready, torques: np.ndarray, share: np.ndarray) -> list[str]:
    """Torques of the loaded member at which edges carry more than a little."""
    heavy = share > MUCH
    if not heavy.any():
        return []
    most = int(np.nanargmax(share))
    return [
        Doubt(
            f"Edges of the teeth (ends of flanks and roundings of tips) carry up to "
            f"{in_percent(share[most])} of the load, that part at {built.carried.show(torques[most])}: "
            f"more than {100.0 * MUCH:g} % from {built.carried.show(torques[heavy][0])} on. Loss, stiffness "
            "and pressure then hang on how those edges are made.",
            brief=f"Edges of the teeth carry up to {in_percent(share[most])} of the load.",
        )
    ]


def _on_balls(built: Ready) -> bool:
    """True if balls hold the body under the teeth of a mesh."""
    return any(mesh.design.mesh.body.elsewhere is not None for mesh in built.meshes)


def _pressed(play: float) -> list[str]:
    """Teeth that balls without load push into both flanks of their spaces."""
    if not play < 0.0:
        return []
    return [
        Doubt(
            "Without load the balls of the wave generator press the teeth onto both flanks of their spaces, "
            f"by {60.0 * np.degrees(-play):.2g} arcmin at the loaded member: the wind-up counts one flank.",
            brief=f"Balls press teeth onto both flanks by {60.0 * np.degrees(-play):.2g} arcmin.",
        )
    ]


def _of_balls(found: Mapping[str, Any], wind_up: float) -> str:
    """How much the places of the balls change the wind-up at the operating point, in words."""
    if "wind_up_by_balls" not in found or not wind_up > 0.0:
        return ""
    part = 100.0 * float(found["wind_up_by_balls"]) / wind_up
    return (
        "; a ball stands on the long axis, and with the balls half way to the next such place the "
        f"wind-up at the operating point is {abs(part):.2g} % {'larger' if part > 0.0 else 'smaller'}"
    )


def _loopless(built: Built, friction: np.ndarray) -> list[str]:
    """Why a loop of torque over wind-up has no width, or is not there."""
    if built.case.operation.load == 0.0:
        return [
            Doubt(
                "Wind-up: nothing is carried at the operating point, so the coefficient of friction is taken "
                "as zero and the loop has no width.",
                brief="Wind-up: without load friction counts as zero, no loop.",
            )
        ]
    return [
        Doubt(
            f"Wind-up: {models.law.title}: friction locks the drive at the operating point; there is "
            "no torque loop.",
            brief=f"Wind-up: {models.law.name} locks the drive: no torque loop.",
        )
        for models, value in zip(built.models, friction, strict=True)
        if np.isnan(value)
    ]


def onset_friction(built: Built) -> np.ndarray:
    """Coefficient at the operating point by each law, as for sliding that begins anew."""
    point = [(built.design, built.operation)]
    runs = [summarise(point, models) for models in built.models]
    return np.array([run["mean_friction"][0] for run in runs])


def _torsion(built: Built, torques: np.ndarray, friction: np.ndarray) -> dict[str, Any]:
    """Wind-up at every torque, and the load on every tooth there."""
    design, engaged = built.design, engaged_at(built)
    at_torques, body = wound_ups(built, engaged, torques)
    wind_ups: Any = jax.tree.map(lambda *values: np.stack(values), *at_torques)
    loop: Any = hysteresis(
        wind_ups, friction[:, None, None], _at_rest(built, engaged.contacts, at_torques)
    )
    phase, weight, path = map(np.asarray, (engaged.phase, engaged.weight, engaged.contacts.path))
    approach, lost = wind_ups.wind_up + wind_ups.touch, np.isnan(wind_ups.wind_up)
    turned = wind_ups.wind_up @ weight
    return {
        "phase": phase[::SHOWN],
        "solve": solve_summary(locked_or_lost(False, lost), wind_ups.residual, wind_ups.iterations),
        "kinematic_play": np.asarray(
            kinematic_play(design.mesh, design.loaded, engaged.contacts, engaged.phase, body)
        )
        @ weight,
        "angular_transmission_error": approach[:, ::SHOWN],
        "angular_transmission_error_range": np.ptp(approach, axis=-1),
        "mesh_torsional_stiffness": wind_ups.stiffness[:, ::SHOWN],
        "wind_up": turned,
        "wind_up_range": np.ptp(wind_ups.wind_up, axis=-1),
        **_stiffness(torques, turned, wind_ups.stiffness, weight),
        "loaded_pairs": wind_ups.loaded_pairs @ weight,
        **_zone_load(wind_ups.inner_load @ weight),
        **_edge_share(design.mesh, wind_ups, weight),
        **_of_pairs(design.mesh, path, wind_ups.force),
        "loading_torque": loop.loading @ weight,
        "unloading_torque": loop.unloading @ weight,
        "parts": _parts(design, engaged.contacts, wind_ups, weight),
        **_by_balls(
            built, engaged.contacts, weight, np.interp(built.case.operation.load, torques, turned)
        ),
    }


def _stiffness(
    torques: np.ndarray, turned: np.ndarray, slopes: np.ndarray, weight: np.ndarray
) -> dict[str, np.ndarray]:
    """Torque over mean wind-up, the slope of that curve, and the mean of the slopes over the phases [torque].

    Phases follow each other under one torque, so that compliances are averaged: the mean of the slopes is
    above the slope of the mean.
    """
    slope = 1.0 / ((1.0 / slopes) @ weight)
    return {
        "torsional_stiffness": _secant(torques, turned, slope),
        "tangent_torsional_stiffness": slope,
        "phase_mean_torsional_stiffness": slopes @ weight,
    }


def _secant(torques: np.ndarray, turned: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Torque over wind-up; its limit, the slope, without any."""
    return np.where(turned > 0.0, torques / np.where(turned > 0.0, turned, 1.0), slope)


def engaged_at(built: Built) -> Engagement:
    """Contacts at the operating point, with what was found of them there."""
    if built.engaged is not None:
        return built.engaged
    return engagement(built.design, built.operation.load, built.models[0])


def wound_ups(
    built: Built, known: Engagement, torques: np.ndarray
) -> tuple[list[Any], Body | None]:
    """Wind-up at rising torques, plain numbers, and the body of the teeth at the last one.

    Args:
        built: the case.
        known: contacts at the operating point.
        torques: of the loaded member [N m].
    """
    design = built.design
    mesh, solids, body = design.mesh, design.solids, known.body
    if body is None:
        body = coupling(mesh.body, solids, known.contacts)
    inputs = mesh, design.loaded, solids, built.terms
    at_torques: list[Any] = []
    for torque in torques:
        if at_torques and isinstance(
            body, OnBalls
        ):  # balls stand near where they stood for the torque before
            body = replace(body, start=array(at_torques[-1].balls))
        at = wound_up(*inputs, torque, known.contacts, body)
        at_torques.append(jax.device_get(at))
    return at_torques, body


def _edge_share(mesh: Mesh, found: Any, weight: np.ndarray) -> dict[str, np.ndarray]:
    """Part of the load on edges at each torque, of meshes that watch for them; none of no load."""
    if not mesh.body.couples:
        return {}
    total = found.force.sum(axis=(1, 2)) @ weight
    return {"edge_share": (found.edge_load @ weight) / np.where(total != 0.0, total, 1.0)}


def _by_balls(
    built: Built, contacts: Contacts, weight: np.ndarray, as_they_stand: float
) -> dict[str, np.ndarray]:
    """Wind-up at the operating point with the balls elsewhere less that as they stand; none without balls."""
    design = built.design
    mesh, solids = design.mesh, design.solids
    elsewhere = mesh.body.elsewhere
    if elsewhere is None:
        return {}
    inputs = mesh, design.loaded, solids, built.terms, array(built.case.operation.load)
    wound = wound_up(*inputs, contacts, coupling(elsewhere, solids, contacts))
    return {"wind_up_by_balls": np.asarray(wound.wind_up) @ weight - as_they_stand}


def _of_pairs(mesh: Mesh, path: np.ndarray, force: np.ndarray) -> dict[str, np.ndarray]:
    """Way of every pair [phase, pair] and the force on it [torque, phase, pair]."""
    pair_path, loads = in_pairs(mesh, path, 0, like_first=True), in_pairs(mesh, force, 1)
    return {
        "path": pair_path.mean(axis=1)[:, ::SHOWN].T,
        "tooth_force": np.moveaxis(loads.sum(axis=2), 1, 2)[:, ::SHOWN],
    }


def _parts(
    design: Design, contacts: Contacts, found: Any, weight: np.ndarray
) -> dict[str, np.ndarray]:
    """Parts of the wind-up over the torques, by name; those that yield [rad]."""
    if not design.mesh.body.couples:
        return {}
    under = jax.device_get(body_parts(design.mesh, design.loaded, design.solids, contacts, found))
    teeth = {"teeth": found.of_teeth, "gaps between the teeth": found.of_gaps}
    every = {name: values @ weight for name, values in (teeth | under).items()}
    return {name: values for name, values in every.items() if values.any()}


def _at_rest(built: Built, contacts: Contacts, each: list[Any]) -> np.ndarray | float:
    """Torque by which bearings and seals hold the loaded member while the others are held [N m]."""
    design = built.design
    if not design.drag:
        return 0.0
    warm = built.operation.temperature
    torques = [_drag_at_rest(design, contacts, wound.force, warm) for wound in each]
    return np.stack(jax.device_get(torques))


@program
def _drag_at_rest(
    design: Design,
    contacts: Contacts,
    force: Float[Array, "pair slice node"],
    temperature: Float[Array, ""],
) -> Float[Array, " node"]:
    viscosity = design.lubricant.kinematic_viscosity(temperature)
    drags, loaded = at_rest(design.drag), design.loaded
    total = jnp.zeros(force.shape[2:])
    for drag, load in zip(drags, bearing_loads(drags, design.mesh, contacts, force), strict=True):
        torque = drag.torque(speed=jnp.zeros(()), load=load, kinematic_viscosity=viscosity)
        total += jnp.abs(drag.between @ loaded) * torque
    return total


def _zone_load(loads: np.ndarray) -> dict[str, np.ndarray]:
    """Load on the bearing inside the drive at each torque; nothing where there is none."""
    return {"zone_load": loads} if loads.shape[1] else {}


@program
def kinematic_play(
    mesh: Mesh,
    loaded: Float[Array, " dof"],
    contacts: Contacts,
    phase: Float[Array, " node"],
    body: Body | None,
) -> Array:
    """Rotation of the loaded member between first touch of its flanks on either side [rad]."""
    other_flanks = mesh.other_flanks
    both = contacts, contacts if other_flanks is mesh else other_flanks.contacts(phase)
    return sum(
        (
            touching_approach(
                separation_on_balls(at.gap, body),
                jnp.abs(contact_velocity(at.normal, loaded)),
                at.active,
            )
            for at in both
        ),
        jnp.zeros(()),
    )


def torsion_of(built: Ready, _: Piece, __: PieceProgress) -> xr.Dataset:
    """Dataset of the part."""
    return torsion_part(built)


def torsion_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Wind-up over torque, and the play of the loaded member between its flanks [rad]."""
    data = parts.get("torsion")
    if data is None:
        return {"torsion": {}, "kinematic_play": None}
    attributes = data["torsional_stiffness"].attrs
    of = {"stiffness_of": attributes.get("covers", "") + attributes.get("assumed", "")}
    return {
        "torsion": by_torque(data, (*WIND_UP, *_OTHER_STIFFNESS)) | of | _slopes(data),
        "kinematic_play": float(data["kinematic_play"]),
    }


def _slopes(data: xr.Dataset) -> dict[str, Any]:
    """Stiffness, lost motion and hysteresis loss as in catalogues, and the parts of the wind-up."""
    names = ("slope_torque", "slope_stiffness", "catalogue_lost_motion", "hysteresis_loss")
    if names[0] not in data:
        return {}
    parts = zip(data["part"].values, data["wind_up_part"].values, strict=True)
    return {name: numbers(data[name].values) for name in names} | {
        "wind_up_part": {str(part): numbers(values) for part, values in parts}
    }
