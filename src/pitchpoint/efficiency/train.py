"""Gear trains whose meshes turn together, planetary ones among them: meshes, bodies, what brakes them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import gcd, lcm, pi
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import array, demand_double, jax, jnp
from pitchpoint.core.brief import brief
from pitchpoint.core.factored import Numbers
from pitchpoint.drive.kinematics import HOUSING, Ends, Link
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.quasi_static import Design
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import nominal_period, phase_sense
from pitchpoint.gears.period import TOGETHER

__all__ = ["Roles", "Train", "TrainMesh", "gear_train", "presses_other_flanks"]

Copies = Float[Array, "copy node"]

PLACES = (1, 4, 8, 16, 24)
"""Places for planets: trains with as many or less have programs in common."""

MOST_PERIODS = 200
"""Periods of a mesh, in the period that a train repeats, up to which its repetition is looked for."""


class TrainMesh(eqx.Module):
    """One mesh at its place in a train; equal copies of it, as of planets, are one.

    Attributes:
        design: mesh, materials, oil, surfaces.
        phases: of the copies where the train starts, of the first one at places without any [periods].
        count: of the copies, which stand at the first places.
        carried: torque or force on the driven coordinate of the mesh for a unit load of the train, without
            friction, on all copies together.
        periods: of the mesh in one period of the train.
        bodies, carrier, planet_gear: see `Link`; static.
        most_periods: places for these; static.
    """

    design: Design
    phases: Float[Array, " copy"]
    count: Float[Array, ""]
    carried: Float[Array, ""]
    periods: Float[Array, ""]
    bodies: tuple[str, ...] = eqx.field(static=True)
    carrier: str = eqx.field(static=True)
    most_periods: int = eqx.field(static=True)
    planet_gear: int = eqx.field(static=True)

    @property
    def link(self) -> Link:
        """The mesh with the bodies that it joins."""
        return Link(self.design.mesh, self.bodies, self.carrier, self.planet_gear)

    @property
    def copies(self) -> int:
        """How many there are of the mesh."""
        return int(self.count)

    @property
    def places(self) -> int:
        """Places for copies, some without one: so few programs serve all numbers of planets."""
        return int(np.shape(self.phases)[0])

    @property
    def there(self) -> Bool[Array, " copy"]:
        """True at the places where a copy is."""
        return jnp.arange(self.places) < self.count

    def arms(self, values: Float[Array, "dof copy node"]) -> dict[str, Copies]:
        """Values for the coordinates of the mesh by body of the train; the carrier has minus their sum.

        Turning all bodies of a mesh with their carrier neither closes flanks nor slides them.
        """
        by_body = {body: values[number] for number, body in enumerate(self.bodies)}
        borne = -jnp.sum(values, axis=0)
        return {
            **by_body,
            self.carrier: borne + by_body[self.carrier] if self.carrier in by_body else borne,
        }


class Roles(eqx.Module):
    """What bodies of a train do, by their numbers: programs serve whatever is turned, loaded or held.

    Attributes:
        turned, loaded: among `Train.bodies`.
        balanced: those in equilibrium, among the same, the loaded one first and planets last.
        rows: the same among `Train.rows`, each planet by itself.
    """

    turned: Int[Array, ""]
    loaded: Int[Array, ""]
    balanced: Int[Array, " body"]
    rows: Int[Array, " row"]


class Train(eqx.Module):
    """Meshes that turn together, between bodies of which each may be in several.

    Attributes:
        meshes: in any order.
        rates: of the bodies for a unit speed of the one that is turned, from the housing.
        roles: of the bodies that follow, by number.
        turned: body that drives; static, empty within programs as `loaded` and `held` are.
        loaded: body that takes the power; static.
        drag: places beside the teeth where two bodies brake each other, at every planet where one of them is
            one; their `between` counts these two. A bearing bears what the teeth put on its body: that of a
            planet on its carrier all of it and the centrifugal force, one in the housing what does not cancel
            around it, several meshes side by side each by itself.
        angles: at which planets stand about the axis of their carrier, zero at places without one [rad].
        turns: times in a period that each planet comes to where another one was: what they do together
            repeats as often.
        onwards: how many planets further that other one is, after the first of these parts of the period.
        held: bodies that do not move, beside the housing; static.
        planets: bodies of which there are as many as copies of their meshes; static.
        braked: the two bodies of each place, of which the housing may be one; static.
        alike: False if planets stand so that none ever comes to where another one was; static.
        pull: mass of a planet times the radius on which it goes around, for the centrifugal force on its
            bearing [kg m].
    """

    meshes: tuple[TrainMesh, ...]
    rates: Mapping[str, Float[Array, ""]]
    drag: tuple[Drag, ...]
    angles: Float[Array, " planet"]
    turns: Float[Array, ""]
    onwards: Float[Array, ""]
    roles: Roles
    turned: str = eqx.field(static=True)
    loaded: str = eqx.field(static=True)
    held: tuple[str, ...] = eqx.field(static=True)
    planets: tuple[str, ...] = eqx.field(static=True)
    braked: tuple[tuple[str, str], ...] = eqx.field(static=True)
    alike: bool = eqx.field(static=True)
    pull: Float[Array, ""] = eqx.field(default_factory=lambda: array(0.0))

    def __repr__(self) -> str:
        return brief(self)

    @property
    def ratio(self) -> Float[Array, ""]:
        """Rate of the driving body over that of the loaded one."""
        return self.rates[self.turned] / self.rates[self.loaded]

    def motion(self, mesh: TrainMesh) -> Float[Array, " dof"]:
        """Rates of the coordinates of a mesh against their carrier for a unit speed of the train."""
        carrier = self.rates[mesh.carrier]
        return jnp.stack([self.rates[body] - carrier for body in mesh.bodies])

    def onward(self, mesh: TrainMesh) -> Float[Numbers, ""]:
        """Sense in which the phase of a mesh runs: one, or minus one."""
        return phase_sense(mesh.design.mesh, self.motion(mesh))

    @property
    def period(self) -> Float[Numbers, ""]:
        """Turn of the driving body in which all meshes come together again [rad]."""
        mesh = self.meshes[0]
        return mesh.periods * nominal_period(mesh.design.mesh, self.motion(mesh))

    @property
    def bodies(self) -> tuple[str, ...]:
        """All bodies but the housing."""
        return tuple(sorted({*self.rates} - {HOUSING}))

    def without_names(self) -> "Train":
        """The same train without the names of what is turned, loaded and held, which programs do not ask."""
        return replace(self, turned="", loaded="", held=())

    @property
    def free(self) -> tuple[str, ...]:
        """Bodies that nothing turns, loads or holds."""
        others = {HOUSING, self.turned, self.loaded, *self.held}
        return tuple(body for body in self.rates if body not in others)

    def driven_backwards(self, designs: Sequence[Design] = ()) -> "Train":
        """The same train with its output driving; the same flanks touch.

        Args:
            designs: of the meshes, driven backwards; by default as they are.
        """
        designs = designs or [mesh.design for mesh in self.meshes]
        links = [
            replace(mesh, design=design).link
            for design, mesh in zip(designs, self.meshes, strict=True)
        ]
        backwards = Ends({self.loaded: -float(self.rates[self.loaded])}, self.held, self.turned)
        phases = [np.asarray(mesh.phases)[: mesh.copies] for mesh in self.meshes]
        return gear_train(
            links,
            designs,
            backwards,
            planets=self.planets,
            phases=phases,
            angles=np.asarray(self.angles)[: max(mesh.copies for mesh in self.meshes)],
            drag=self.drag,
            braked=self.braked,
            pull=float(self.pull),
        )

    def rows(self) -> list[tuple[str, int]]:
        """All bodies, planets by the number of their place."""
        return _rows(self.bodies, self.meshes, self.planets)


def gear_train(
    links: Sequence[Link],
    designs: Sequence[Design],
    ends: Ends,
    *,
    planets: Sequence[str] = (),
    phases: Sequence[Float[np.ndarray, " _"]] = (),
    angles: Float[np.ndarray, " planet"] | None = None,
    drag: Sequence[Drag] = (),
    braked: Sequence[tuple[str, str]] = (),
    pull: float = 0.0,
) -> Train:
    """A train of meshes that turn together.

    Args:
        links: the meshes with the bodies that they join.
        designs: the same meshes with materials, oil and surfaces.
        ends: the one body that is turned, those that are held, and the one that is loaded.
        planets: bodies of which there are several, each with its meshes.
        phases: of the copies of each mesh, where the train starts [periods]; by default there is one of each,
            which starts at zero.
        angles: at which planets stand about the axis of their carrier [rad]; by default there is one.
        drag: places beside the teeth where power is lost, see `Train.drag`.
        braked: the two bodies of each, the housing among them.
        pull: mass of a planet times the radius on which it goes around [kg m].

    Raises:
        InputError: see `train_torques`; planets that are turned, loaded or held, a mesh that would press its
            other flanks, or has losses of its own, periods of meshes that hardly ever come together again.

    Source: Müller (1982) for rates and torques without friction, see `train_torques`.
    """
    demand_double()
    if len(ends.turned) != 1:
        raise InputError(f"{len(ends.turned)} bodies are turned; the state of a train asks for one")
    ((turned, rate),) = ends.turned.items()
    if {*planets} & {turned, ends.loaded, *ends.held}:
        raise InputError("planets are neither turned nor loaded nor held; their carrier may be")
    unit = replace(ends, turned={turned: float(np.sign(rate))})
    ideal = train_torques(links, unit, 1.0, [1.0] * len(links))
    meshes = []
    together = _periods(links, ideal.rates)
    room = _with_room(max(together))
    for link, design, starts, share, periods in zip(
        links,
        designs,
        phases or [np.zeros(1)] * len(links),
        ideal.shares,
        together,
        strict=True,
    ):
        torque = np.array([share[body] for body in link.bodies])
        _check_mesh(link, design, torque)
        meshes.append(
            TrainMesh(
                design,
                array(_padded(starts, starts[0])),
                array(float(len(starts))),
                array(abs(float(np.asarray(design.loaded) @ torque))),
                array(float(periods)),
                link.bodies,
                link.carrier,
                room,
                link.planet_gear,
            )
        )
    around = np.zeros(1) if angles is None else angles
    roles = _roles(ideal.rates, ends, turned, meshes, planets)
    exchange = _exchange(meshes, ideal.rates, around if drag else None)
    turns, onwards = exchange or (1, 0)
    return Train(
        tuple(meshes),
        {body: array(body_rate) for body, body_rate in ideal.rates.items()},
        tuple(drag),
        array(_padded(around, 0.0)),
        array(float(turns)),
        array(float(onwards)),
        roles,
        turned,
        ends.loaded,
        tuple(ends.held),
        tuple(planets),
        tuple(braked),
        exchange is not None,
        array(pull),
    )


def _rows(
    bodies: Sequence[str], meshes: Sequence[TrainMesh], planets: Sequence[str]
) -> list[tuple[str, int]]:
    """See `Train.rows`."""
    counts = {body: mesh.places for mesh in meshes for body in mesh.bodies}
    return [
        (body, number)
        for body in bodies
        for number in range(counts[body] if body in planets else 1)
    ]


def _roles(
    rates: Mapping[str, float],
    ends: Ends,
    turned: str,
    meshes: Sequence[TrainMesh],
    planets: Sequence[str],
) -> Roles:
    """What bodies do by their numbers."""
    bodies = sorted({*rates} - {HOUSING})
    free = [body for body in bodies if body not in {turned, ends.loaded, *ends.held}]
    balanced = [ends.loaded, *sorted(free, key=lambda body: body in planets)]
    rows = _rows(bodies, meshes, planets)
    return Roles(
        array(bodies.index(turned)),
        array(bodies.index(ends.loaded)),
        array([bodies.index(body) for body in balanced]),
        array([k for body in balanced for k, row in enumerate(rows) if row[0] == body]),
    )


def _with_room(periods: int) -> int:
    """Places for periods of each mesh: few numbers, which trains of other teeth have in common.

    From 4 on at most a quarter of them stays empty.

    Example:
        >>> [_with_room(count) for count in (1, 2, 7, 9, 10, 11, 17, 18, 35)]
        [1, 2, 7, 10, 10, 12, 20, 20, 40]
    """
    step = 1 << max(periods.bit_length() - 3, 0)
    return -(-periods // step) * step


def _padded(values: Float[np.ndarray, " copy"], rest: float) -> Float[np.ndarray, " place"]:
    """Values of planets with those of places that are without one."""
    places = min(size for size in PLACES if size >= len(values))
    return np.concatenate([values, np.full(places - len(values), rest)])


def _exchange(
    meshes: Sequence[TrainMesh],
    rates: Mapping[str, float],
    angles: Float[np.ndarray, " planet"] | None,
) -> tuple[int, int] | None:
    """How often in a period planets take each other's places, and which ones; None if they never do.

    Each planet is the first one at another time, by as much as the planet before it is. Meshes of one copy
    are then as they were.
    """
    count = max(mesh.copies for mesh in meshes)
    every = np.arange(float(count))
    if any(mesh.copies not in (1, count) for mesh in meshes):
        return None
    if angles is not None and not _together(angles * count / (2.0 * pi), every):
        return None

    starts = [np.broadcast_to(np.asarray(one.phases)[: one.copies], (count,)) for one in meshes]
    turned = [_onward_on_host(one, rates) * float(one.periods) for one in meshes]

    def fits(step: int) -> bool:
        ahead = every * step / count
        return all(
            _together(start, start[0] + periods * ahead)
            for start, periods in zip(starts, turned, strict=True)
        )

    step = next((step for step in range(count) if fits(step)), None)
    if step is None:
        return None
    several = gcd(step, count)
    turns = count // several
    return turns, pow(step // several, -1, turns)


def _together(first: Float[np.ndarray, " _"], second: Float[np.ndarray, " _"]) -> bool:
    """True if phases are the same but for whole periods."""
    if np.shape(first) != np.shape(second):
        return False
    apart = np.subtract(first, second)
    return bool(np.max(np.abs(apart - np.round(apart))) < TOGETHER)


def _onward_on_host(mesh: TrainMesh, rates: Mapping[str, float]) -> float:
    """See `Train.onward`; nothing is compiled for it."""
    against: Any = np.array([rates[body] - rates[mesh.carrier] for body in mesh.bodies])
    return float(phase_sense(jax.device_get(mesh.design.mesh), against))


def presses_other_flanks(mesh: Mesh, torque: Float[np.ndarray, " dof"]) -> bool:
    """True if torques from outside close the flanks of a mesh that do not touch.

    Args:
        mesh: any family.
        torque: on its coordinates [N m or N].
    """
    mesh = jax.device_get(mesh)
    return float(mesh.relation @ torque) < 0.0


def _check_mesh(link: Link, design: Design, torque: Float[np.ndarray, " dof"]) -> None:
    """Raise InputError unless a mesh can stand in a train, under these torques."""
    bodies = " and ".join(link.bodies)
    if presses_other_flanks(design.mesh, torque):
        raise InputError(
            f"the mesh of {bodies} presses its other flanks when the train is driven so; build it with "
            "them (right_flank)"
        )
    if design.drag:
        raise InputError(
            f"the mesh of {bodies} has losses beside its teeth; those of a train stand between its bodies"
        )


def _periods(links: Sequence[Link], rates: Mapping[str, float]) -> list[int]:
    """Periods of each mesh in which all come together again."""
    mesh_rates = []
    for link in links:
        against: Any = np.array([rates[body] - rates[link.carrier] for body in link.bodies])
        mesh_rates.append(1.0 / float(nominal_period(jax.device_get(link.mesh), against)))
    fastest = max(mesh_rates)
    parts = [Fraction(rate / fastest).limit_denominator(MOST_PERIODS) for rate in mesh_rates]
    periods = lcm(*(part.denominator for part in parts))
    if periods > MOST_PERIODS or not np.allclose(
        [*map(float, parts)], np.array(mesh_rates) / fastest, 1e-9
    ):
        raise InputError(
            f"the meshes of this train come together again after more than {MOST_PERIODS} periods; "
            "its state over all of them is not computed"
        )
    return [int(part * periods) for part in parts]
