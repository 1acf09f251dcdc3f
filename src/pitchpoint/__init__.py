"""Pitchpoint: load, sliding, film, friction and efficiency where gear teeth touch.

Importing the package costs next to nothing: a public name is loaded when it is first asked for.
"""

import os
from importlib import import_module
from typing import Any

# The checks that diffrax makes of its arguments are calls from compiled code back to Python, and programs
# with such calls are never kept for a later process. Equinox reads this once, when it is imported.
os.environ.setdefault("EQX_ON_ERROR", "off")

__version__: str

# public name -> module that defines it
_LAZY: dict[str, str] = {
    "Case": "pitchpoint.runs.case",
    "Result": "pitchpoint.notebook.result",
    "run": "pitchpoint.notebook.result",
    "open_result": "pitchpoint.notebook.result",
    "study": "pitchpoint.runs.study",
    "sobol_indices": "pitchpoint.runs.sensitivity",
    "JointModel": "pitchpoint.runs.joint_model",
    "MapRange": "pitchpoint.efficiency.friction_fit",
    "fit_friction": "pitchpoint.efficiency.friction_fit",
    "size": "pitchpoint.sizing.sizing",
    "bench": "pitchpoint.runs.bench",
    "three_k_sets": "pitchpoint.sizing.three_k",
    "three_k_tables": "pitchpoint.sizing.three_k",
    "duty": "pitchpoint.notebook.duty_cycle",
    "Motor": "pitchpoint.duty_cycle.motor",
    "RatedLife": "pitchpoint.duty_cycle.life",
    "ThermalNetwork": "pitchpoint.duty_cycle.thermal_network",
    "Heating": "pitchpoint.duty_cycle.duty_dataset",
    "gradients": "pitchpoint.notebook.gradients",
    "optimise": "pitchpoint.runs.optimise",
    "Optimum": "pitchpoint.runs.optimise",
    "models": "pitchpoint.notebook.tables",
    "cite": "pitchpoint.notebook.tables",
    "load_case": "pitchpoint.runs.run",
    "write_report": "pitchpoint.views.report",
    "Study": "pitchpoint.cases.study_tables",
    "Sweep": "pitchpoint.cases.study_tables",
    "Contacts": "pitchpoint.contact.contacts",
    "BallOnDisc": "pitchpoint.gears.ball_on_disc.mesh",
    "TwinDisc": "pitchpoint.gears.rigs.twin_disc",
    "CylindricalPair": "pitchpoint.gears.cylindrical.pair",
    "build_cylindrical_pair": "pitchpoint.gears.cylindrical.design",
    "build_cylindrical_pairs": "pitchpoint.gears.cylindrical.design",
    "StrainWave": "pitchpoint.gears.strain_wave.drive",
    "build_strain_wave": "pitchpoint.gears.strain_wave.design",
    "build_strain_waves": "pitchpoint.gears.strain_wave.design",
    "Design": "pitchpoint.efficiency.quasi_static",
    "Operation": "pitchpoint.efficiency.quasi_static",
    "Models": "pitchpoint.efficiency.quasi_static",
    "cycle": "pitchpoint.efficiency.quasi_static",
    "state": "pitchpoint.efficiency.quasi_static",
    "state_grid": "pitchpoint.efficiency.grid",
    "mean_loss_gradient": "pitchpoint.efficiency.gradients",
    "input_torque_gradient": "pitchpoint.efficiency.gradients",
    "ripple_gradient": "pitchpoint.efficiency.gradients",
    "FrictionLaw": "pitchpoint.lubrication.lubrication_registry",
    "FilmModel": "pitchpoint.lubrication.ehl.model",
    "LineContact": "pitchpoint.lubrication.ehl.line",
    "Fluid": "pitchpoint.materials.fluid",
    "Rough": "pitchpoint.lubrication.ehl.texture",
    "Conduction": "pitchpoint.lubrication.ehl.conduction",
    "Conductor": "pitchpoint.lubrication.flash_temperature",
    "solve_lines": "pitchpoint.lubrication.ehl.solve",
    "finite_line": "pitchpoint.lubrication.ehl.patch.contact",
    "elliptic_contact": "pitchpoint.lubrication.ehl.patch.contact",
    "solve_patch": "pitchpoint.lubrication.ehl.patch.patch_films",
    "film_near": "pitchpoint.lubrication.ehl.patch.patch_films",
    "HeightMap": "pitchpoint.lubrication.ehl.patch.heights",
    "march_patches": "pitchpoint.lubrication.ehl.patch.transient",
    "march_dataset": "pitchpoint.results.film_datasets",
    "patch_dataset": "pitchpoint.results.film_datasets",
    "film_dataset": "pitchpoint.results.film_datasets",
    "films_of_dataset": "pitchpoint.results.film_datasets",
    "double_precision": "pitchpoint._jax",
    "PitchpointError": "pitchpoint.errors",
    "InputError": "pitchpoint.errors",
    "ConvergenceError": "pitchpoint.errors",
}

__all__ = sorted([*_LAZY, "__version__", "cases"])


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("pitchpoint")
    if name == "cases":  # the folder itself, which lists what ships when it is called
        return import_module("pitchpoint.cases")
    if name in _LAZY:
        return getattr(import_module(_LAZY[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
