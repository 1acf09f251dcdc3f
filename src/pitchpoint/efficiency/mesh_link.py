"""One mesh as a link of a drive, and what its shafts and their bearings put on it."""

from dataclasses import replace
from typing import Any, ClassVar

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.drag import Drag, bearing_loads
from pitchpoint.efficiency.drive import (
    DriveLink,
    LinkPlace,
    UnderLoad,
    bearings_feel_link_behind,
    overcome_losses,
)
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    State,
    cycle_nodes,
    state,
)
from pitchpoint.efficiency.running_torque import torques_at_rest
from pitchpoint.gears.mesh import Mesh, coordinates_of
from pitchpoint.gears.nominal_motion import nominal_motion
from pitchpoint.gears.pairs import touching
from pitchpoint.loading.loading_registry import LoadSharing
from pitchpoint.loading.reactions import Bearing

__all__ = ["MeshLink"]

OF_A_MEETING = 680.0
"""Memory for each meeting of phases where few contacts take less [B], as the compiler tells."""

OF_A_LANE = {True: 17.0, False: 34.0}
"""Memory for each contact at a meeting [B]: of rigid flanks that all touch, and of others."""


class MeshLink(DriveLink):
    """One mesh at its place in a drive.

    Attributes:
        design: mesh, materials, oil, surfaces, and what brakes its bodies against each other.
        shafts: one for each coordinate of the mesh; static.
        turn: angle about the shafts of the frame of the mesh against that of the drive [rad].
        place: of the middle of the face along the shafts [m].
    """

    design: Design
    shafts: tuple[int, ...] = eqx.field(static=True)
    turn: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))
    place: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))

    presses_bearings: ClassVar[bool] = True

    @property
    def bodies(self) -> int:
        """See `DriveLink`."""
        return len(coordinates_of(self.design.mesh))

    @property
    def ends(self) -> tuple[int, int]:
        """See `DriveLink`."""
        ends = self.design.driver, self.design.loaded
        driver, loaded = (self.shafts[int(np.argmax(np.asarray(on)))] for on in ends)
        return driver, loaded

    @property
    def step(self) -> Float[Array, ""]:
        """See `DriveLink`."""
        return jnp.abs(self.design.loaded @ self.design.motion)

    @property
    def touching(self) -> bool:
        """See `DriveLink`."""
        return touching(self.design.mesh)

    def senses(self, before: float) -> tuple[float, float]:
        """See `DriveLink`."""
        mesh, *ends = jax.device_get((self.design.mesh, self.design.driver, self.design.loaded))
        motion = nominal_motion(mesh, *ends)
        sense_in, sense_out = (float(np.sign(motion @ end)) for end in ends)
        return sense_in, sense_out

    def driven_backwards(self) -> "MeshLink":
        """See `DriveLink`."""
        return replace(self, design=self.design.backwards)

    def under_load(
        self,
        place: LinkPlace,
        point: Operation,
        models: Models,
        nodes: int,
        known: Engagement | None,
    ) -> UnderLoad:
        """See `DriveLink`."""
        mesh = self.design.mesh
        if known is None:
            phase, weight = cycle_nodes(mesh, models.sharing, nodes)
        else:
            phase, weight = known.phase, known.weight
        drag = self._braked(place)
        mesh_state = state(replace(self.design, drag=drag), point, phase, models, engaged=known)
        loads = bearing_loads(drag, mesh, mesh_state.contacts, mesh_state.balance.load)
        return UnderLoad(mesh_state, tuple(loads), weight, nodes)

    def at_rest(self, place: LinkPlace, point: Operation, models: Models) -> tuple[Array, Array]:
        """See `DriveLink`."""
        return torques_at_rest(replace(self.design, drag=self._braked(place)), point, models)

    def memory(self, models: Models, nodes: int) -> tuple[float, int]:
        """See `DriveLink`."""
        lanes, phases = eqx.filter_eval_shape(_sizes, self.design.mesh, models.sharing, nodes)
        per_phase = max(OF_A_MEETING, OF_A_LANE[self.touching] * lanes.size)
        return phases.size * per_phase, phases.size

    def locking(self, state: State) -> None:
        """See `DriveLink`."""
        return None

    def _braked(self, place: LinkPlace) -> tuple[Drag, ...]:
        """Losses of the drive that it overcomes, in its coordinates, then its own."""
        drags = []
        for number in overcome_losses(place.drive, place.number):
            drag = place.drive.drag[number]
            seat = drag.seat
            if isinstance(seat, Bearing):
                beside = (
                    self._beside(seat, place)
                    if bearings_feel_link_behind(*place[:2], number)
                    else None
                )
                seat = replace(self._seated(seat), beside=beside)
            between = jnp.stack([drag.between[shaft] for shaft in self.shafts])
            drags.append(replace(drag, between=between, seat=seat))
        return (*drags, *self.design.drag)

    def _seated(self, seat: Bearing) -> Bearing:
        """A bearing of the drive as the mesh sees it."""
        partner = None if seat.other is None else seat.other - self.place
        coordinate = self.shafts.index(seat.coordinate)
        return replace(seat, coordinate=coordinate, place=seat.place - self.place, other=partner)

    def _beside(self, seat: Bearing, place: LinkPlace) -> Float[Array, "3 *#b"] | None:
        """Load on a bearing by the link behind, in the frame of this one [N]."""
        if place.meetings is None:
            return None
        after: Any = place.drive.links[place.number + 1]
        state = place.behind
        borne = after._seated(seat).borne(after.design.mesh, state.contacts, state.balance.load)
        x, y, z = place.meetings.following(borne)
        angle = after.turn - self.turn
        cosine, sine = jnp.cos(angle), jnp.sin(angle)
        return jnp.stack([cosine * x - sine * y, sine * x + cosine * y, z])[..., None]


def _sizes(mesh: Mesh, sharing: LoadSharing, nodes: int) -> tuple[Array, Array]:
    """Contacts at one phase, and phases of the period, of which the shapes count."""
    return mesh.contacts(jnp.zeros(())).weight, cycle_nodes(mesh, sharing, nodes)[0]
