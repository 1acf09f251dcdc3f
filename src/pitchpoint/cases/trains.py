"""From a case of meshes that turn together, as a planetary set, to their flanks, loads and phases."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from pitchpoint._jax import jax
from pitchpoint.cases.built import Built
from pitchpoint.cases.document import STAGES
from pitchpoint.cases.drive_schema import DriveCase, TrainTable
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import BY_VALUE
from pitchpoint.cases.strength_choices import of_planets
from pitchpoint.core.doubts import GUESSED, REMARKED, Doubt
from pitchpoint.drive.assembly import (
    check_neighbours,
    equal_angles,
    nearest_places,
    places_around,
    planet_phases,
)
from pitchpoint.drive.kinematics import HOUSING, Ends, Link, body_rates
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency.drag import drags
from pitchpoint.efficiency.operation_tables import Operating
from pitchpoint.efficiency.train import Train, gear_train, presses_other_flanks
from pitchpoint.errors import RUNS_WITH, InputError
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import disc
from pitchpoint.materials.material_tables import SolidValues
from pitchpoint.materials.solids import SolidRecord
from pitchpoint.strength.strength_table import MESH_LOAD, StrengthTable
from pitchpoint.wear.wear_tables import WearTable

__all__ = ["USUAL_BEARING", "about_trains", "rates_of", "train_of", "turning_together"]


def _links(case: DriveCase, train: TrainTable, meshes: Sequence[Mesh]) -> list[Link]:
    """Meshes with their bodies; the axes of those of planets sit on the carrier."""
    return [
        Link(
            mesh,
            stage.bodies,
            train.carrier if train.planet in stage.bodies else HOUSING,
            round(stage.planet_gear),
        )
        for mesh, stage in zip(meshes, case.stages.values(), strict=True)
    ]


def _ends(case: DriveCase, train: TrainTable) -> Ends:
    return Ends({train.input: case.operation.speed or 1.0}, train.held, train.output)


def rates_of(case: DriveCase, meshes: Sequence[Mesh]) -> dict[str, float]:
    """Rates of the bodies of a train for its speed, or for one where that is zero.

    Args:
        case: of the train.
        meshes: of it.

    Raises:
        InputError: see `body_rates`.
    """
    assert case.train is not None
    try:
        return body_rates(_links(case, case.train, meshes), _ends(case, case.train))
    except InputError as error:
        raise error.at(key=error.key or "train") from None


def turning_together(
    case: DriveCase, alone: Sequence[CaseFile], meshes: Sequence[Mesh]
) -> tuple[list[CaseFile], list[Operating]]:
    """Meshes of a train with the flanks that they press, and the operating point of one copy of each.

    Args:
        case: of the train.
        alone: each of its meshes as a case.
        meshes: of these.

    Raises:
        InputError: see `train_torques`; flanks that were given are not those that touch.

    From torques without losses.
    """
    train = case.train
    assert train is not None
    try:
        links = _links(case, train, meshes)
        balanced = train_torques(links, _ends(case, train), 1.0, [1.0] * len(links))
    except InputError as error:
        raise error.at(key=error.key or "train") from None
    meshings = Counter(gear for link in links for gear in link.gears)
    turned, points = [], []
    for number, (stage, link, torques) in enumerate(
        zip(alone, links, balanced.shares, strict=True), 1
    ):
        torque = np.array([torques[body] for body in link.bodies])
        rates = np.array(
            [balanced.rates[body] - balanced.rates[link.carrier] for body in link.bodies]
        )
        driver = link.bodies.index(balanced.driving[number - 1])
        if presses_other_flanks(link.mesh, torque):
            stage = _on_other_flanks(stage, number)
        copies = train.planets if train.planet in link.bodies else 1.0
        carried = abs(torque[1 - driver]) / copies * case.operation.load
        changes = {
            stage.gears.load: float(carried),
            "speed": float(abs(rates[driver])),
            "driver": stage.gears.members[driver],
        }
        points.append(stage.operation.model_copy(update=changes))
        per_turn = float(abs(rates[driver] / balanced.rates[train.input]))
        shared = {
            "strength": _strength(stage, link, meshings, train),
            "wear": _wear(stage.wear, link, train, per_turn),
            "worn": stage.worn and stage.worn.counted(per_turn),
        }
        turned.append(stage.model_copy(update=shared))
    return turned, points


def _strength(
    one: CaseFile, link: Link, meshings: Mapping[tuple[str, float, int], int], train: TrainTable
) -> StrengthTable:
    """What the strength of a mesh depends on, with the planets that share its load."""
    on_planets = train.planet in link.bodies
    return of_planets(
        one.strength,
        round(train.planets) if on_planets else 1,
        meets=_both(body != train.planet for body in link.bodies),
        both_ways=_both(meshings[gear] > 1 for gear in link.gears),
    )


def _wear(
    table: WearTable | None, link: Link, train: TrainTable, per_turn: float
) -> WearTable | None:
    """The wear of a mesh over turns of its own driver against the carrier, by all planets that it meets.

    Args:
        table: over turns of the input.
        link: of the mesh.
        train: of the case.
        per_turn: turns of the driver of the mesh for one of the input.
    """
    if table is None:
        return None
    planets = train.planets if train.planet in link.bodies else 1.0
    mates = tuple(1.0 if body == train.planet else planets for body in link.bodies)
    changes = {"cycles": table.cycles * per_turn, "engagements": table.engagements or mates}
    return table.model_copy(update=changes)


def _both(values: Iterable[bool]) -> tuple[bool, bool]:
    gear_1, gear_2 = values
    return gear_1, gear_2


def _on_other_flanks(one: CaseFile, number: int) -> CaseFile:
    """A mesh pressing its other flanks, where they are open."""
    if one.gears.opposed is None or "flank" in one.gears.model_fields_set:
        raise InputError(
            "these flanks do not touch when the train is driven so; leave flank out, or take the others",
            key=f"{STAGES}.{number}.gears.flank",
        )
    return one.model_copy(update={"gears": one.gears.opposed})


def train_of(case: DriveCase, built: Sequence[Built]) -> Train:
    """The train of a case.

    Args:
        case: of the train.
        built: its meshes.

    Raises:
        InputError: planets that do not fit in at equal angles; see `gear_train`.
    """
    train = case.train
    assert train is not None
    designs = [one.design for one in built]
    links = _links(case, train, [one.mesh for one in designs])
    _check_planets(case, built)
    _check_bearings(case, built)
    on_planets = [link for link in links if link.carrier != HOUSING]
    angles = _angles(on_planets, train)
    phases = iter(_fitted(on_planets, train, angles))
    phases_of_links = [np.zeros(1) if link.carrier == HOUSING else next(phases) for link in links]
    braked = [loss.between for loss in case.losses.values()]
    try:
        return gear_train(
            links,
            designs,
            _ends(case, train),
            planets=(train.planet,),
            phases=phases_of_links,
            angles=angles,
            drag=[
                replace(drags({name: loss}, loss.between, ())[0], seat=None)
                for name, loss in case.losses.items()
            ],
            braked=braked,
            pull=_pull(case, built),
        )
    except InputError as error:
        raise error.at(key=error.key or "train") from None


def _pull(case: DriveCase, built: Sequence[Built]) -> float:
    """Mass of a planet times the radius on which it goes around [kg m].

    Its gears are discs as wide as their mesh, from bore to reference circle; of one in two meshes the
    heavier one.
    """
    masses: dict[tuple[str, float, int], float] = {}
    radius = 0.0
    for mesh, link, member in _of_planets(case, built):
        gear, radius = link.gears[member], float(mesh.dimensions["centre_distance"])
        masses[gear] = max(masses.get(gear, 0.0), _mass(mesh, member))
    return radius * sum(masses.values())


def _of_planets(case: DriveCase, built: Sequence[Built]) -> Iterator[tuple[Built, Link, int]]:
    """Meshes of a train in which planets are, with the number of the planet in each."""
    train = case.train
    assert train is not None
    links = _links(case, train, [stage.design.mesh for stage in built])
    for stage, link in zip(built, links, strict=True):
        if train.planet in link.bodies:
            yield stage, link, link.bodies.index(train.planet)


def _mass(built: Built, member: int) -> float:
    """Mass of a planet in one of its meshes as a disc [kg]."""
    mesh: Any = built.design.mesh
    return disc(
        density=float(built.design.solids[member].density),
        width=float(mesh.face_width),
        outer=_reference_radius(mesh, member),
        inner=_root_radius(mesh, member) / float(mesh.rim_ratio[member]),
    )[0]


def _reference_radius(mesh: Any, member: int) -> float:
    """Of an external gear [m]."""
    turned = float(mesh.module) / np.cos(float(mesh.helix_angle))
    return abs(float(np.asarray(mesh.teeth)[member])) * float(turned) / 2.0


def _root_radius(mesh: Any, member: int) -> float:
    """Of an external gear [m]."""
    held = jax.device_get(mesh)
    cut = float(held.dedendum[member] - held.profile_shift[member] - held.infeed[member])
    return _reference_radius(mesh, member) - float(mesh.module) * cut


USUAL_BEARING = 0.4
"""Mean diameter of the bearing of a planet over its reference diameter, of which advice is given."""


def _check_bearings(case: DriveCase, built: Sequence[Built]) -> None:
    """InputError for bearings whose rolling bodies would lie in the teeth of the planet that they bear."""
    train = case.train
    assert train is not None
    planets = [(one.design.mesh, member) for one, _, member in _of_planets(case, built)]
    root = 2.0 * min((_root_radius(*one) for one in planets), default=np.inf)
    for name, loss in case.losses.items():
        across = loss.mean_diameter or 0.0
        if {*loss.between} != {train.planet, train.carrier} or across < root:
            continue
        usual = 2e3 * USUAL_BEARING * min(_reference_radius(*one) for one in planets)
        change = {f"losses.{name}.mean_diameter": f"{usual:.3g} mm"}
        error = InputError(
            f"rolling bodies on a circle of {1e3 * across:.4g} mm do not fit into planets whose roots lie on "
            f'{1e3 * root:.4g} mm{RUNS_WITH}mean_diameter = "{usual:.3g} mm"',
            key=f"losses.{name}.mean_diameter",
        )
        error.cures = (change,)
        raise error


_OF_A_GEAR = ("profile_shift", "addendum", "dedendum", "fillet_radius", "infeed")
"""What a gear has in every mesh in which it is, beside its material and roughness."""

CLOSES = 1e-6
"""Relative difference of the centre distances of one planet, that of printed ones."""


def _check_planets(case: DriveCase, built: Sequence[Built]) -> None:
    """InputError where planets are not the same gears in all meshes, or have two centre distances."""
    train = case.train
    assert train is not None
    links = _links(case, train, [built_stage.design.mesh for built_stage in built])
    teeth_of: dict[tuple[str, float, int], tuple[str, dict[str, Any]]] = {}
    distance: tuple[str, float] | None = None
    for (number, stage), built_stage, link in zip(case.stages.items(), built, links, strict=True):
        if train.planet not in stage.bodies:
            continue
        mesh: Any = built_stage.design.mesh
        member = stage.bodies.index(train.planet)
        apart = float(mesh.centre_distance)
        reference = distance = distance or (number, apart)
        if abs(apart / reference[1] - 1.0) > CLOSES:
            raise InputError(
                f"the centre distance is {1e3 * apart:.7g} mm, and {1e3 * reference[1]:.7g} mm in stage "
                f"{reference[0]}; all meshes of a planet have the same: give it as centre_distance, with "
                f'profile_shift = "{FROM_CENTRE_DISTANCE}" for the other gear',
                key=f"{STAGES}.{number}.gears.centre_distance",
            )
        teeth = abs(float(np.asarray(mesh.teeth)[member]))
        gear = _of_gear(built_stage, member)
        before, earlier = teeth_of.setdefault(link.gears[member], (number, gear))
        different = next((key for key, value in gear.items() if value != earlier[key]), None)
        if different is not None:
            advice = _IN_SETS if case.gears else _IN_MESHES
            raise InputError(
                f"{different} of the planet with {teeth:.0f} teeth is {gear[different]} here and "
                f"{earlier[different]} in stage {before}; it is one gear{advice}",
                key=f"{STAGES}.{number}.gears",
            )


_IN_MESHES = "; a second one with as many teeth has planet_gear = 2 in its stage"
_IN_SETS = (
    ". Of a set gear 1 is sun and planet, gear 2 planet and ring: give both the same; materials may be "
    "those of sun, planet and ring"
)


def _of_gear(built: Built, member: int) -> dict[str, Any]:
    """What a gear is, by words, of one member of a mesh."""
    mesh: Any = built.design.mesh
    rough = built.design.roughness
    numbers = {
        name.replace("_", " "): float(np.asarray(getattr(mesh, name))[member])
        for name in _OF_A_GEAR
    }
    rq = (rough.rq_1, rough.rq_2)[member]
    return {
        "material": _material(built.solids[member].record),
        "roughness Rq": f"{1e6 * float(rq):.6g} µm",
        "module": f"{1e3 * float(mesh.module):.6g} mm",
        "helix angle": f"{np.degrees(float(mesh.helix_angle)):.6g} deg",
        **{name: f"{round(value, 9) + 0.0:.6g}" for name, value in numbers.items()},
    }


def _material(record: SolidRecord) -> str:
    """A material by its name, or by its values where it has none of its own."""
    if record.title != BY_VALUE:
        return record.name
    values = {name: getattr(record, name) for name in SolidValues.model_fields}
    return ", ".join(
        f"{name.replace('_', ' ')} {value.value:.6g}"
        for name, value in values.items()
        if value is not None
    )


_WORN = Doubt(
    "One flank of the planets wears in two meshes: its depth is the sum of both, and wear, life and backlash "
    "of either mesh are those of one alone.",
    moves=GUESSED,
    about=("deepest_wear",),
    brief="A flank of the planets wears in two meshes; each is told by itself.",
)
_WARMED = Doubt(
    "Teeth are as warm as the loss of one of their meshes makes them; planets and sun have more of them.",
    moves=GUESSED,
    brief="Teeth are warmed by one mesh alone.",
)

_UNBRAKED = Doubt(
    "The efficiency is without the bearings of the planets: no loss stands between a planet and its carrier.",
    moves=GUESSED,
    about=("mean_efficiency",),
    brief="The efficiency is without planet bearings.",
)

_MANY = Doubt(
    f"Stresses are those of planets that share alike: no mesh load factor K_γ is known for more than "
    f"{max(MESH_LOAD)} planets, for which it is {MESH_LOAD[max(MESH_LOAD)]}; give strength.mesh_load_factor.",
    moves=GUESSED,
    about=("root_stress", "contact_stress"),
    brief=f"K_γ of more than {max(MESH_LOAD)} planets is unknown: taken as 1.",
)

MOST_FITTED = 8
"""Planets up to which it is told how many fit in."""

PLAY = 0.01
"""Part of a step between places that fit by which an angle in a file may be off, as rounded ones are."""


def _angles(links: Sequence[Link], train: TrainTable) -> np.ndarray:
    """Angles of the planets [rad]: as the case has them but for rounding, or equal ones."""
    if not train.planet_angles:
        return equal_angles(round(train.planets))
    stated = np.array(train.planet_angles)
    places = places_around([_teeth_of(link, train) for link in links])
    nearest = nearest_places(stated, places)
    rounded = np.abs(nearest - stated) * places < 2.0 * np.pi * PLAY
    return np.where(rounded, nearest, stated)


def _teeth_of(link: Link, train: TrainTable) -> tuple[int, int]:
    """Teeth of a planet and of its mate, negative for a ring."""
    mesh: Any = link.mesh
    planet = link.bodies.index(train.planet)
    return round(float(mesh.teeth[planet])), round(float(mesh.teeth[1 - planet]))


def _fitted(links: Sequence[Link], train: TrainTable, angles: np.ndarray) -> list[np.ndarray]:
    """Phases of the meshes of planets that stand at these angles.

    Raises:
        InputError: they do not fit in; of equal angles with the numbers of planets that do.
    """

    def phases(angles: np.ndarray) -> list[np.ndarray]:
        mesh_phases = planet_phases(links, (train.planet,), angles)
        check_neighbours(links, (train.planet,), angles)
        return mesh_phases

    try:
        return phases(angles)
    except InputError as error:
        if train.planet_angles:
            raise error.at(key="train.planet_angles") from None
        every = range(1, MOST_FITTED + 1)
        fitting = [count for count in every if _fits(phases, equal_angles(count))]
        counts = f"of 1 to {MOST_FITTED} planets fit {', '.join(map(str, fitting))}"
        misfit = error.followed_by(counts if fitting else "")
        raise misfit.at(key="train.planets") from None


def _fits(phases: Callable[[np.ndarray], list[np.ndarray]], angles: np.ndarray) -> bool:
    try:
        phases(angles)
    except InputError:
        return False
    return True


def _worn_twice(case: DriveCase, built: Sequence[Built]) -> bool:
    """True where one flank of the planets is pressed in two meshes."""
    pressed = Counter(
        (link.gears[member], getattr(stage.case.gears, "flank", ""))
        for stage, link, member in _of_planets(case, built)
    )
    return any(count > 1 for count in pressed.values())


SIDEWAYS = 1e-6
"""Part of the forces of planets that does not cancel below which it is that of rounding."""


def _sideways(train: TrainTable) -> list[Doubt]:
    """Planets at angles at which their forces do not cancel around sun, ring and carrier."""
    turns = np.exp(1j * np.array(train.planet_angles or equal_angles(round(train.planets))))
    part = float(np.abs(turns.mean()))
    if part < SIDEWAYS or turns.size == 1:
        return []
    return [
        Doubt(
            f"At these angles {part:.2g} of the forces of the planets do not cancel: they press sun, rings "
            "and carrier sideways. A load factor K_γ of the standard is for equal angles.",
            moves=REMARKED,
            about=("contact_stress", "root_stress"),
            brief=f"Planets at unequal angles: {part:.2g} of their forces press sideways.",
        )
    ]


def about_trains(case: DriveCase, built: Sequence[Built]) -> tuple[str, ...]:
    """Sentences on what is not in the results of a train.

    Args:
        case: of the train.
        built: its meshes.
    """
    train = case.train
    assert train is not None
    losses = [loss for loss in case.losses.values() if loss.bearing != "none"]
    borne = [{*loss.between} for loss in losses]
    out_of_place = bool(train.pin_errors) or train.by_tolerance
    alone = case.strength is None or case.strength.mesh_load_factor is None
    worn = any(stage.wear is not None for stage in case.stages.values()) and _worn_twice(
        case, built
    )
    warmed = any(stage.warming is not None for stage in built)
    return (
        *[_WORN] * worn,
        *[_WARMED] * warmed,
        *_sideways(train),
        *[_UNBRAKED] * ({train.planet, train.carrier} not in borne),
        *[_MANY] * (train.planets > max(MESH_LOAD) and alone and not out_of_place),
    )
