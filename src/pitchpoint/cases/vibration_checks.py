"""What a case says of its vibration that its gears do not take, or lack."""

import numpy as np

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.document import Document
from pitchpoint.cases.models import solved_first
from pitchpoint.cases.schema import CaseFile
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import program
from pitchpoint.dynamics.vibration_tables import Dynamics
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.mesh_bodies import plain_inertia

__all__ = []


def check_vibration(case: CaseFile, mesh: Mesh, wrong: Complaints) -> None:
    """Complains of a vibration that these gears do not have, or whose table lacks what it takes.

    Args:
        case: with a table on it.
        mesh: of its gears.
        wrong: that has been found already.
    """
    assert case.dynamics is not None
    if has(mesh, line_of_action):
        wrong.tried(_check_masses, case, mesh)
        wrong.tried(_check_motion, case, mesh)
    else:
        wrong.tried(_check_joint, case, case.dynamics)


def _check_masses(case: CaseFile, mesh: Mesh) -> None:
    """InputError for a vibration if a body that travels has no mass, or a moment of inertia."""
    travelling = [name for name in case.gears.members if name not in case.gears.shafts]
    if not travelling:
        return
    assert case.dynamics is not None
    if case.dynamics.inertia is not None:
        raise InputError(
            f"the {travelling[0]} travels and has no moment of inertia; give gears.mass, the other body "
            "counts as a plain disc",
            key="dynamics.inertia",
        )
    if not np.isfinite(np.asarray(_inertia(mesh))).all():
        raise InputError(
            f"is missing; a vibration asks for the mass of the {travelling[0]} and of all that moves with it",
            key="gears.mass",
        )


def _check_motion(case: CaseFile, mesh: Mesh) -> None:
    """InputError for gears whose motion with friction cannot be computed."""
    assert case.dynamics is not None
    motion = case.dynamics.motion
    if motion is None:
        return
    if reason := solved_first(case):
        raise InputError(f"a motion {reason}", key="models.friction")
    if mesh.body.couples:
        raise InputError(
            "motion with friction takes each pair of teeth as a spring of its own, and the rim of these "
            "gears couples them; leave this table out",
            key="dynamics.motion",
        )
    travelling = [name for name in case.gears.members if name not in case.gears.shafts]
    if travelling and motion.bearing_stiffness is not None:
        raise InputError(
            f"was given, and the {travelling[0]} travels; bearings that yield are those of gears that turn",
            key="dynamics.motion.bearing_stiffness",
        )
    if case.operation.load == 0.0:
        reason = (
            f"0 was given; a motion asks for a {case.gears.load} above 0, which presses the teeth"
        )
        raise InputError(reason, key=f"operation.{case.gears.load}")
    ratio = float(mesh.contact_ratio) if motion.pair_path else 0.0
    if motion.pair_path and motion.pair_path[-1] < ratio - 1e-6:
        raise InputError(
            f"ends at {motion.pair_path[-1]:g}; the path of a pair is {ratio:.6g} base pitches long",
            key="dynamics.motion.pair_path",
        )
    if motion.mesh_damping == 0.0 and not any(motion.bearing_damping or ()):
        raise InputError(
            "0 N s/m leaves nothing that damps the vibration, so that it never becomes steady",
            key="dynamics.motion.mesh_damping",
        )


def _check_joint(case: CaseFile, asked: Dynamics) -> None:
    """InputError for what the torsional vibration of a joint does not take, or lacks."""
    if not case.gears.transmits:
        raise InputError(
            "vibration is computed along a line of action, which these gears do not have; leave this "
            "table out",
            key="dynamics",
        )
    strange = [key for key in _ALONG_ACTION if getattr(asked, key) != _usual(key)]
    if strange:
        raise InputError(
            "was given; it is for vibration along a line of action, which these gears do not have, and a "
            f"joint takes {', '.join(_OF_JOINT)}",
            key=f"dynamics.{strange[0]}",
        )
    if asked.inertia is None:
        ends = f"the motor at the {case.operation.driver} and the load at the output"
        raise InputError(
            f"is missing; a joint vibrates between two moments of inertia, a list of those of {ends}",
            key="dynamics.inertia",
        )


def inertia_of_both(document: Document) -> list[str]:
    """That one moment of inertia counts for motor and load alike; nothing where each has its own."""
    if isinstance(document.tree["dynamics"].get("inertia"), list):
        return []
    warning = (
        "The motor and the load have the same moment of inertia, since dynamics.inertia was given as one "
        "value; a list has that of the motor, then that of the load."
    )
    return [Doubt(warning, brief="Motor and load have the one inertia that was given.")]


_ALONG_ACTION = ("profile_error", "backlash", "torques", "forces", "motion")
_OF_JOINT = ("inertia", "damping_ratio", "speeds")


def _usual(key: str) -> object:
    """Value of a key of [dynamics] where none is given."""
    return Dynamics.model_fields[key].default


@program
def _inertia(mesh: Mesh) -> jax.Array:
    return plain_inertia(mesh, jnp.ones(2))
