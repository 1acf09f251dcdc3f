"""What lies under the teeth of a strain wave gear: rim and cup, bearing inside, circular spline."""

import dataclasses
from typing import ClassVar

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.core.factored import Arrays
from pitchpoint.core.roots import hypot
from pitchpoint.gears.gear_body import GearBody
from pitchpoint.gears.on_balls import Body
from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.gears.strain_wave.ball_bearing import ThinRaceBearing, on_balls, parts_on_balls
from pitchpoint.gears.strain_wave.flexible_ring import FlexibleRing, RingLoads
from pitchpoint.gears.strain_wave.flexspline_tooth import FlexsplineFlank
from pitchpoint.gears.strain_wave.in_series import InSeries
from pitchpoint.gears.strain_wave.ring_compliance import ring_compliance, ring_parts
from pitchpoint.gears.strain_wave.wave_generator import NeutralLine
from pitchpoint.materials.solids import Solid

__all__ = ["StrainWaveBody", "end_of_wave", "left_behind"]

Lanes = Float[Array, "pair slice *b"]
Each = Float[Array, "*b"]


class StrainWaveBody(GearBody):
    """The flexspline on its wave generator, and the circular spline around both.

    Attributes:
        flank: of the flexspline teeth.
        line: neutral line of the flexspline as the wave generator deforms it.
        rim: rim, cup and support of the flexspline.
        bearing: balls that take the place of that support; None without.
        series: what yields behind them.
        teeth: numbers of both splines z1, z2.
    """

    couples: ClassVar[bool] = True
    inner_bearing: ClassVar[frozenset[str]] = frozenset(MEMBERS[:2])

    flank: FlexsplineFlank
    line: NeutralLine
    rim: FlexibleRing
    bearing: ThinRaceBearing | None
    series: InSeries
    teeth: Float[Array, "2"]

    @property
    def yielding(self) -> tuple[str, str]:
        """Teeth and the ring that carries them, and what the case lets yield behind them."""
        behind = dict(zip(InSeries.parts, np.asarray(self.series.compliance) > 0.0, strict=True))
        behind[InSeries.parts[0]] |= float(self.series.bottom) > 0.0
        behind[InSeries.parts[3]] |= self.series.ring is not None
        held = self.bearing is not None or not np.isinf(self.rim.support_stiffness)
        every = {"bearing of the wave generator": held, **behind}
        inside = [name for name, yields in every.items() if yields]
        outside = [name for name, yields in every.items() if not yields]
        if self.bearing is None and held:
            outside.append("clearance of the bearing")
        return (
            ", ".join(["teeth, ring and cup wall of the flexspline", *inside]),
            ", ".join([*outside, "housing and shafts outside"]),
        )

    def in_series(
        self, solids: tuple[Solid, Solid], loaded: Float[Arrays, "3"]
    ) -> dict[str, Float[Array, ""]]:
        """Bottom of the cup, flange, shaft of the wave generator, circular spline given by value."""
        return self.series.by_part(solids[0], left_behind(self.teeth), loaded)

    def compliance(self, contacts: Contacts, solids: tuple[Solid, Solid]) -> Body:
        """The flexspline's rim couples all its teeth, and so does a circular spline that yields."""
        loads, outer = self.ring_loads(contacts), self.series.ring
        around: Float[Array, "lane lane *b"] | float = 0.0
        if outer is not None:
            around = ring_compliance(outer, solids[1], self._on_circular_spline(contacts, outer))
        if self.bearing is None:
            return ring_compliance(self.rim, solids[0], loads) + around
        held = on_balls(self.bearing, self.rim, self.line, solids[0], loads)
        return dataclasses.replace(held, lanes=held.lanes + around)

    def parts(
        self,
        contacts: Contacts,
        solids: tuple[Solid, Solid],
        force: Lanes,
        balls: Float[Array, "ball *b"] | None,
    ) -> dict[str, Each]:
        """Rim, wall of the cup and bearing of the wave generator; the circular spline where it yields."""
        loads, outer, bearing = self.ring_loads(contacts), self.series.ring, self.bearing
        if balls is None or bearing is None:
            parts = ring_parts(self.rim, solids[0], loads, force)
        else:
            parts = parts_on_balls(bearing, self.rim, self.line, solids[0], loads, force, balls)
        by_part = {
            "rim of the flexspline": parts.rim,
            "wall of the cup": parts.wall,
            "bearing of the wave generator": parts.support,
        }
        if outer is None:
            return by_part
        around = self._on_circular_spline(contacts, outer)
        wall, rim, _ = ring_parts(outer, solids[1], around, force)
        return by_part | {InSeries.parts[3]: wall + rim}

    def inner_load(self, contacts: Contacts) -> Float[Array, "2 pair slice *b"]:
        """Radial load on the wave generator's bearing: teeth press the ring onto it in both zones.

        A zone is told by the end of the long axis at which its pairs lie, so that any of them may be missing.
        """
        pressed, second = -self.ring_loads(contacts).radial, contacts.point[0] < 0.0
        return jnp.stack([jnp.where(second, 0.0, pressed), jnp.where(second, pressed, 0.0)])

    @property
    def elsewhere(self) -> "StrainWaveBody | None":
        """With the balls of the wave generator as far from where they stand as they come."""
        if self.bearing is None:
            return None
        return dataclasses.replace(self, bearing=self.bearing.elsewhere)

    def ring_loads(self, contacts: Contacts) -> RingLoads:
        """How unit forces at the contacts act on the flexspline's rim."""
        slope = self.flank.angle(contacts.flank[0])
        return RingLoads(
            angle=2.0 * jnp.pi * contacts.path + end_of_wave(contacts),
            tangential=-jnp.cos(slope),
            radial=-jnp.sin(slope),
            height=jnp.real(self.flank.place(contacts.flank[0])),
        )

    def _on_circular_spline(self, contacts: Contacts, ring: FlexibleRing) -> RingLoads:
        """How unit forces at the contacts act on the circular spline: against those on the flexspline."""
        loads = self.ring_loads(contacts)
        return RingLoads(
            angle=loads.angle,
            tangential=-loads.tangential,
            radial=-loads.radial,
            height=hypot(contacts.point[0], contacts.point[1]) - ring.radius,
        )


def left_behind(teeth: Float[Arrays, "2"]) -> Float[Array, "3"]:
    """Teeth that are left behind in a turn of each member: factors of the rates, whose sum is zero.

    From Willis' relation of both splines, seen from the wave generator.
    """
    z1, z2 = teeth
    return jnp.stack([z2 - z1, z1, -z2])


def end_of_wave(contacts: Contacts) -> Float[Array, "pair 1 *b"]:
    """Angle of the end of the long axis at which each pair lies: half of them at one, half at the other."""
    pairs = contacts.path.shape[0]
    second = jnp.arange(pairs).reshape(-1, *(1 for _ in contacts.path.shape[1:])) >= pairs // 2
    return jnp.pi * second
