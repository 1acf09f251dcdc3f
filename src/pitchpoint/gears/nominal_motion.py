"""The steady motion of a mesh between the body that drives it and the one that takes the load."""

from collections.abc import Sequence
from functools import singledispatch
from typing import Any

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.coordinates import number_of
from pitchpoint.gears.mesh import Mesh, coordinates_of, has
from pitchpoint.gears.mesh_bodies import main_dimensions

__all__ = [
    "MOTORS",
    "mesh_ends",
    "mesh_numbers",
    "nominal_motion",
    "nominal_period",
    "phase_sense",
    "ratio_dimension",
    "tooth_size",
    "turned_rates",
    "usual_ends",
]

Rates = Float[Arrays, " dof"]
"""Of a mesh whose numbers are those of NumPy, as `jax.device_get` gives it, so are these, and nothing is
compiled for them."""

MOTORS = "bodies of a rig have motors of their own, and a load that drives none of them"
"""Why other ends are no choice there."""


@singledispatch
def usual_ends(mesh: Any) -> tuple[int, int]:
    """Numbers of the coordinates that drive and that are loaded where nobody says so.

    Args:
        mesh: any family; of most the first coordinate drives and the second one is loaded.
    """
    return 0, 1


@singledispatch
def turned_rates(mesh: Any, driver: Rates) -> Rates:
    """Rates of the coordinates that are turned from outside, zero of the others.

    Args:
        mesh: any family; that of most turns its driver alone.
        driver: one for the coordinate that drives.
    """
    rates: Rates = driver * _sign(mesh.relation @ driver)
    return rates


def _sign(value: Float[Numbers, ""]) -> Float[Numbers, ""]:
    return jnp.sign(value) if isinstance(value, Array) else np.sign(value)


def nominal_motion(mesh: Mesh, driver: Rates, loaded: Rates) -> Rates:
    """Rates of the coordinates for a unit rate of the driver, which presses the flanks.

    Args:
        mesh: any family.
        driver: one for the coordinate that drives, zero elsewhere.
        loaded: one for the coordinate whose load is prescribed, zero elsewhere; what is left stands still.

    From flanks that stay in touch: the relation of the mesh times the rates is zero.
    """
    turned, relation = turned_rates(mesh, driver), mesh.relation
    return turned - (relation @ turned) / (relation @ loaded) * loaded


def nominal_period(mesh: Mesh, motion: Rates) -> Float[Numbers, ""]:
    """Motion of the driver in one period [rad or m].

    Args:
        mesh: any family.
        motion: of its coordinates for a unit rate of the driver.

    From one engagement for every pitch that passes.
    """
    return mesh.pitch / abs(mesh.passing @ motion)


def phase_sense(mesh: Mesh, motion: Rates) -> Float[Numbers, ""]:
    """Sense in which the phase runs while the drive turns on: one, or minus one.

    Args:
        mesh: any family.
        motion: of its coordinates.
    """
    return _sign(mesh.passing @ motion)


def ratio_dimension(mesh: Mesh, driver: Rates, loaded: Rates) -> dict[str, Float[Array, ""]]:
    """Speed of the driver over that of the loaded member as a main dimension, where members may take turns.

    Nothing of pairs, whose ratio is that of their teeth, and of rigs.

    Args:
        mesh: any family.
        driver, loaded: see `nominal_motion`.
    """
    if len(coordinates_of(mesh)) < 3 or has(mesh, turned_rates):
        return {}
    motion = nominal_motion(mesh, driver, loaded)
    return {"speed_ratio": jnp.abs((driver @ motion) / (loaded @ motion))}


def mesh_ends(
    mesh: Mesh,
    driver: str | int | None = None,
    loaded: str | int | None = None,
    bodies: Sequence[str] = (),
) -> tuple[Float[Array, " dof"], Float[Array, " dof"]]:
    """One for the coordinate that drives, and one for the loaded one; zero elsewhere.

    Args:
        mesh: any family.
        driver, loaded: names of bodies, or numbers of their coordinates; by default those of `usual_ends`,
            and where the usual loaded one drives, the usual driver is loaded.
        bodies: names of all of them in order, where they are known already.

    Raises:
        InputError: there is no such body; one that drives and is loaded at once; bodies with motors of
            their own.

    Example:
        >>> from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
        >>> given = {"module": 1e-3, "pressure_angle": 0.349, "face_width": 1e-2}
        >>> pair = build_cylindrical_pair(teeth=(24, 30), **given)
        >>> [each.tolist() for each in mesh_ends(pair, driver="gear 2")]
        [[0.0, 1.0], [1.0, 0.0]]
    """
    names = tuple(bodies) or tuple(place.body for place in coordinates_of(mesh))
    usual = usual_ends(mesh)
    drives = usual[0] if driver is None else number_of(driver, names)
    takes = usual[0] if drives == usual[1] else usual[1]
    if loaded is not None:
        takes = number_of(loaded, names)
        if driver is None and takes == drives:
            drives = usual[1]
    if has(mesh, turned_rates) and (drives, takes) != usual:
        raise InputError(MOTORS)
    if drives == takes:
        raise InputError(f"the {names[drives]} cannot drive and be loaded at once")
    unit_vectors = np.eye(len(names))
    return array(unit_vectors[drives]), array(unit_vectors[takes])


def tooth_size(mesh: Mesh) -> float | None:
    """Module of the teeth [m], which is about the height that their flanks have; None without teeth."""
    module = jax.device_get(mesh_numbers(mesh, *mesh_ends(mesh))["dimensions"]).get("module")
    return None if module is None else float(module)


@program
def mesh_numbers(mesh: Mesh, driver: jax.Array, loaded: jax.Array) -> dict[str, dict[str, Any]]:
    """Dimensions and nominal motion, which every case asks for."""
    motion = nominal_motion(mesh, driver, loaded)
    nominal = {
        "motion": motion,
        "driver": driver,
        "loaded": loaded,
        "period": nominal_period(mesh, motion),
        "onward": phase_sense(mesh, motion),
        "events": mesh.events(),
        "pitch_line_speed": pitch_point(mesh, driver).pitch_line_speed
        if has(mesh, pitch_point)
        else jnp.zeros(()),
    }
    dimensions = main_dimensions(mesh) | ratio_dimension(mesh, driver, loaded)
    return {"dimensions": dimensions, "nominal": nominal}
