"""Losses beside the teeth: bearings, seals and lubricant that brake one body against another."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.efficiency.drag_tables import Loss, bearings_of
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS, BREAKAWAY, DragModel
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.input.remembered import remembering
from pitchpoint.loading.reactions import Bearing, InnerBearing
from pitchpoint.materials._leaves import float64_array

__all__ = ["Drag", "at_rest", "bearing_loads", "drags", "held_by", "resistance"]

Lanes = Float[Arrays, "pair slice *#b"]
Each = Float[Numbers, "*#b"]

ROUNDING = 1e-13
"""Relative rate, over the rates of the bodies, up to which two bodies turn together."""


def _as_arrays(values: Mapping[str, Any]) -> dict[str, Float[Array, ""]]:
    return {name: float64_array(value) for name, value in values.items()}


def _check_factors(model: DragModel, factors: Mapping[str, Any]) -> None:
    if set(factors) != set(model.factors):
        wanted = ", ".join(model.factors) or "no factors"
        raise InputError(f"'{model.name}' asks for {wanted}, got {[*factors]}")


class Drag(eqx.Module):
    """One place beside the teeth where a body is braked against another or against the housing.

    The torques are those between the two bodies, whatever turns faster. They add up.

    Attributes:
        between: difference of rotations over which it acts, as factors of the coordinates: (1, -1, 0)
            is body 0 against body 1, (1, 0, 0) body 0 against the housing.
        bearing: model of a rolling bearing there; static.
        mean_diameter: of the bearing, or of the lip of a seal [m].
        factors: of the bearing model by name; for Palmgren's `f0` and `f1`.
        preload: load on the bearing without load on the teeth, as from a wave generator that keeps a
            ring deformed [N].
        seat: where the bearing sits, which says how the teeth load it; None where they do not.
        seal_torque: of sliding seals, the same at every speed [N m].
        churning_torque: of the lubricant that is displaced, at `churning_speed` [N m].
        churning_speed: relative speed at which that is its torque [rad/s].
        churning_exponent: of the speed in it, positive.
        breakaway_torque: that holds the bodies at rest, above what the others give there [N m]; acts
            in starting torques alone.
        breakaway: model of such a torque, which adds to it; static.
        breakaway_factors: of that model by name.
        resting: True if the bodies are about to move: bearing at speed zero, breakaway torque, no
            churning; static.

    Source: ISO/TR 14179-2:2001, losses of bearings, seals and churning add up.
    """

    between: Float[Array, " dof"] = eqx.field(converter=float64_array)
    bearing: DragModel = eqx.field(static=True, default=BEARING_LOSS["none"])
    mean_diameter: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    factors: Mapping[str, Float[Array, ""]] = eqx.field(converter=_as_arrays, default_factory=dict)
    preload: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    seat: Bearing | InnerBearing | None = None
    seal_torque: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    churning_torque: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    churning_speed: Float[Array, ""] = eqx.field(converter=float64_array, default=1.0)
    churning_exponent: Float[Array, ""] = eqx.field(converter=float64_array, default=1.0)
    breakaway_torque: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    breakaway: DragModel = eqx.field(static=True, default=BREAKAWAY["none"])
    breakaway_factors: Mapping[str, Float[Array, ""]] = eqx.field(
        converter=_as_arrays, default_factory=dict
    )
    resting: bool = eqx.field(static=True, default=False)

    def __check_init__(self) -> None:
        """Refuse factors that a model does not have, and demand those that it has."""
        _check_factors(self.bearing, self.factors)
        _check_factors(self.breakaway, self.breakaway_factors)

    @property
    def holds(self) -> bool:
        """True if more than friction in motion holds the bodies at rest."""
        return bool(self.breakaway.factors) or float(self.breakaway_torque) > 0.0

    def held_times(self, factor: float) -> "Drag":
        """The same place with what holds it at rest times a factor."""
        scaled = {
            name: value if name == "preload" else value * factor
            for name, value in self.breakaway_factors.items()
        }
        return replace(
            self, breakaway_torque=self.breakaway_torque * factor, breakaway_factors=scaled
        )

    def torque(self, *, speed: Each, load: Each, kinematic_viscosity: Each) -> Each:
        """Torque between the bodies, in the common shape of the arguments [N m]; not negative.

        Args:
            speed: relative one, not negative [rad/s].
            load: on the bearing, preload included [N].
            kinematic_viscosity: of the lubricant [m2/s].
        """
        bearing = self.bearing.function(
            speed=0.0 * speed if self.resting else speed,
            load=load,
            kinematic_viscosity=kinematic_viscosity,
            mean_diameter=self.mean_diameter,
            **self.factors,
        )
        load_free = self._held(kinematic_viscosity) if self.resting else self._churning(speed)
        every = map(jnp.shape, (speed, load, kinematic_viscosity))
        return jnp.broadcast_to(
            bearing + self.seal_torque + load_free, jnp.broadcast_shapes(*every)
        )

    def _held(self, viscosity: Each) -> Each:
        of_law = self.breakaway.function(
            mean_diameter=self.mean_diameter,
            kinematic_viscosity=viscosity,
            **self.breakaway_factors,
        )
        return self.breakaway_torque + of_law

    def _churning(self, speed: Each) -> Each:
        moves = speed > 0.0
        relative = jnp.where(moves, speed / self.churning_speed, 1.0)
        power = jnp.exp(self.churning_exponent * jnp.log(relative))
        return jnp.where(moves, self.churning_torque * power, 0.0)


def at_rest(drags: Sequence[Drag]) -> tuple[Drag, ...]:
    """The same places with bodies about to move, as for a starting torque."""
    return tuple(replace(drag, resting=True) for drag in drags)


def resistance(
    drags: Sequence[Drag],
    mesh: Mesh,
    contacts: Contacts,
    *,
    motion: Float[Array, " dof"],
    speed: Each,
    kinematic_viscosity: Each,
) -> Callable[[Lanes], Float[Array, "dof *#b"]]:
    """External torques that overcome the losses beside the teeth, from the loads on the teeth.

    Args:
        drags: places where they arise, at least one.
        mesh: any family.
        contacts: of the mesh.
        motion: rates of its coordinates for a unit speed of the driver.
        speed: of the driver [rad/s].
        kinematic_viscosity: of the lubricant [m2/s].

    Returns:
        Function of the normal force of each slice [N] that gives the torque on every coordinate [N m];
        its power at the rates of the mesh is the power lost, never negative.

    From virtual work: a torque between two bodies acts on the difference of their rotations.
    """

    def torques(load: Lanes) -> Float[Array, "dof *#b"]:
        pressed = bearing_loads(drags, mesh, contacts, load)
        every = [
            _on_bodies(drag, motion, speed, held, kinematic_viscosity)
            for drag, held in zip(drags, pressed, strict=True)
        ]
        return jnp.stack([sum(torque[k] for torque in every) for k in range(motion.shape[0])])

    return torques


def bearing_loads(drags: Sequence[Drag], mesh: Mesh, contacts: Contacts, load: Lanes) -> list[Each]:
    """Load on the bearing of each place, preload included [N].

    Args:
        drags: places.
        mesh: any family.
        contacts: of the mesh.
        load: normal force of each slice [N].

    From the balance of the bodies under the forces of their teeth, see `Bearing`.
    """
    return [
        drag.preload if drag.seat is None else drag.preload + drag.seat.load(mesh, contacts, load)
        for drag in drags
    ]


def _on_bodies(
    drag: Drag, motion: Float[Array, " dof"], speed: Each, load: Each, viscosity: Each
) -> list[Each]:
    """External torque on each coordinate that overcomes the drag at one place."""
    rate = drag.between @ motion
    turns = jnp.abs(rate) > ROUNDING * (jnp.abs(drag.between) @ jnp.abs(motion))
    torque = drag.torque(speed=jnp.abs(rate) * speed, load=load, kinematic_viscosity=viscosity)
    sense = jnp.where(turns, jnp.sign(rate), 0.0)
    return [factor * sense * torque for factor in drag.between]


@remembering
def drags(
    losses: Mapping[str, Loss], bodies: Sequence[str], inner: Collection[frozenset[str]]
) -> tuple[Drag, ...]:
    """Places beside the teeth where power is lost.

    Args:
        losses: by name.
        bodies: of each coordinate, by name.
        inner: pairs of bodies with a bearing between them on which a wave of teeth presses.
    """
    return tuple(_drag(loss, losses, bodies, inner) for loss in losses.values())


def held_by(drags: Sequence[Drag], losses: Mapping[str, Loss], way: float) -> tuple[Drag, ...]:
    """Places with what holds bodies at rest at one end of its spread.

    Args:
        drags: the places.
        losses: of which they are, in the same order.
        way: 1 for the upper end, -1 for the lower one.
    """
    pairs = zip(drags, losses.values(), strict=True)
    return tuple(drag.held_times(loss.breakaway_spread**way) for drag, loss in pairs)


def _drag(
    loss: Loss,
    losses: Mapping[str, Loss],
    bodies: Sequence[str],
    inner: Collection[frozenset[str]],
) -> Drag:
    between = np.zeros(len(bodies))
    for body, side in zip(loss.between, (1.0, -1.0), strict=True):
        if body in bodies:
            between[bodies.index(body)] = side
    bearing = BEARING_LOSS[loss.bearing]
    return Drag(
        between=array(between),
        bearing=bearing,
        mean_diameter=array(loss.mean_diameter or 0.0),
        factors={name: array(value) for name, value in loss.factors.items()},
        preload=array(loss.preload),
        seat=InnerBearing() if _inside(loss, inner) else _seat(loss, losses, bodies),
        seal_torque=array(loss.seal_torque),
        churning_torque=array(loss.churning_torque),
        churning_speed=array(loss.churning_speed or 1.0),
        churning_exponent=array(loss.churning_exponent),
        breakaway_torque=array(loss.breakaway_torque),
        breakaway=BREAKAWAY[loss.breakaway],
        breakaway_factors={name: array(value) for name, value in loss.breakaway_factors.items()},
    )


def _inside(loss: Loss, inner: Collection[frozenset[str]]) -> bool:
    """True for the bearing inside a drive on which a wave of teeth presses."""
    return loss.bearing != "none" and frozenset(loss.between) in inner


def _seat(loss: Loss, losses: Mapping[str, Loss], bodies: Sequence[str]) -> Bearing | None:
    """Where a bearing sits; None for a place without one, or between bodies that nothing holds apart."""
    if loss.bearing == "none" or "housing" not in loss.between:
        return None
    body = next(name for name in loss.between if name != "housing")
    coordinate = bodies.index(body)
    bearing, *others = bearings_of(losses, body).values()
    if not others:
        return Bearing(coordinate)
    opposite = others[0] if loss is bearing else bearing
    assert loss.position is not None and opposite.position is not None
    thrust = _locates(loss, opposite, usual=loss is bearing)
    return Bearing(coordinate, array(loss.position), array(opposite.position), thrust)


def _locates(loss: Loss, other: Loss, *, usual: bool) -> bool:
    """True if a bearing takes the thrust: as either of the two says, else the first one."""
    if loss.locating is not None:
        return loss.locating
    return usual if other.locating is None else not other.locating
