"""The meshing zone by eqs. 1 to 6: relative radius, entrainment and load of a tooth at any angle."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from pitchpoint.errors import InputError
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.flexspline_tooth import InvoluteFlank
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.published.publication import ReadingPoint
from pitchpoint.published.xu2021.printed import (
    MAP_SPAN,
    ZONE_END,
    curvature_radii,
    largest_force,
    loaded_count,
    mapped_radius,
    mesh_point_speed,
    printed_count,
    relative_radius,
)
from pitchpoint.published.xu2021.table import ZoneFilms

__all__ = ["MeshingZone", "zone_of"]

Places = Float[np.ndarray, " place"]

_USUAL_MAP: tuple[tuple[float, ...], tuple[float, ...]] = (0.0, ZONE_END), (-MAP_SPAN, MAP_SPAN)


@dataclass(frozen=True)
class MeshingZone:
    """What eqs. 1 to 6 take of a case.

    Attributes:
        teeth: z1, z2.
        module: [m].
        base_radius: r_b1, r_b2 [m].
        deflection: w0 of w = w0 cos 2 angle [m].
        wave_speed: of the wave generator [rad/s].
        torque: of the output [N m].
        map_angle: angles at which the mesh point is given [rad].
        map_distance: R1 there less the pitch radius [modules].
        sense: 1 if carried and elastic tangential velocity add, -1 if they are opposed.
        closed: whether the load closes the torque, in place of eq. 6 as printed.
    """

    teeth: tuple[float, float]
    module: float
    base_radius: tuple[float, float]
    deflection: float
    wave_speed: float
    torque: float
    map_angle: tuple[float, ...]
    map_distance: tuple[float, ...]
    sense: int = 1
    closed: bool = False

    @property
    def tooth_angles(self) -> Places:
        """Angles of the teeth from that on the long axis to the last that eq. 5 loads [rad]."""
        angle = 2.0 * np.pi / self.teeth[1]
        return np.asarray(angle * np.arange(loaded_count(teeth=self.teeth[1]) + 1))

    @property
    def largest_load(self) -> float:
        """F0 of eq. 6 as printed or closed [N]."""
        return self.closed_load if self.closed else self.printed_load

    @property
    def printed_load(self) -> float:
        """F0 of eq. 6 as printed: N = [z/10] and one zone [N]."""
        return self._force(count=printed_count(teeth=self.teeth[1]))

    @property
    def closed_load(self) -> float:
        """F0 of the teeth of both zones that eq. 5 loads, which closes the torque [N]."""
        return self._force(count=loaded_count(teeth=self.teeth[1]), zones=2)

    @property
    def one_zone_load(self) -> float:
        """F0 if one zone of such teeth carried all [N]."""
        return self._force(count=loaded_count(teeth=self.teeth[1]))

    def _force(self, count: int, zones: int = 1) -> float:
        z2 = self.teeth[1]
        return largest_force(
            torque=self.torque, base_radius=self.base_radius[1], teeth=z2, count=count, zones=zones
        )

    def load(self, angle: Places) -> Places:
        """Load of a tooth, eq. 5; negative beyond the zone [N]."""
        return np.asarray(self.largest_load * np.cos(4.0 * angle))

    def distance(self, angle: Places) -> Places:
        """R1 of the map [m]."""
        return mapped_radius(
            angle=angle,
            map_angle=self.map_angle,
            map_distance=self.map_distance,
            pitch_radius=0.5 * self.module * self.teeth[0],
            module=self.module,
        )

    def curvature_radii(self, angle: Places) -> tuple[Places, Places]:
        """R_k1 and R_k2, eq. 1 [m]; NaN where the mesh point lies within a base circle."""
        return curvature_radii(
            distance=self.distance(angle),
            radial=self.deflection * np.cos(2.0 * angle),
            base_radius=self.base_radius,
        )

    def radius(self, angle: Places) -> Places:
        """Relative radius, eq. 2; negative where the flexspline's is the larger one [m]."""
        on_flexspline, on_circular = self.curvature_radii(angle)
        return relative_radius(first=on_flexspline, second=on_circular)

    def speed(self, angle: Places, sense: int | None = None) -> Places:
        """Velocity along the flank that is taken for entrainment, eq. 3 [m/s].

        Args:
            angle: from the long axis [rad].
            sense: in place of that of the zone.
        """
        return mesh_point_speed(
            angle=angle,
            distance=self.distance(angle),
            base_radius=self.base_radius[0],
            deflection=self.deflection,
            teeth=self.teeth,
            wave_speed=self.wave_speed,
            sense=self.sense if sense is None else sense,
        )

    def touches(self, angle: Places) -> Bool[np.ndarray, " place"]:
        """Whether eqs. 1 to 5 give a contact: relative radius, entrainment and load are positive."""
        with np.errstate(invalid="ignore"):
            rolling = (self.radius(angle) > 0.0) & (self.speed(angle) > 0.0)
        return np.asarray(rolling & (self.load(angle) > 0.0))


def zone_of(point: ReadingPoint) -> MeshingZone:
    """The zone of a case, with the map of its table, or the usual one without a table.

    Raises:
        InputError: teeth without base circles.
    """
    gears, mesh, formulas = point.gears, point.design.mesh, point.formulas
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(mesh, StrainWave)
    if not isinstance(mesh.flank, InvoluteFlank):
        raise InputError(
            "eqs. 1 to 3 take teeth with base circles, which are involute ones",
            key="gears.tooth.form",
        )
    flexspline_base = float(mesh.flank.base_radius)
    table = formulas if isinstance(formulas, ZoneFilms) else None
    map_angle, map_distance = (table.map_angle, table.map_distance) if table else _USUAL_MAP
    return MeshingZone(
        teeth=gears.teeth,
        module=gears.module,
        base_radius=(flexspline_base, flexspline_base * gears.teeth[1] / gears.teeth[0]),
        deflection=float(mesh.line.deflection),
        wave_speed=float(point.operation.speed),
        torque=float(point.operation.load),
        map_angle=map_angle,
        map_distance=map_distance,
        sense=-1 if table and table.tangential == "opposed" else 1,
        closed=table is not None and table.load == "closed",
    )
