"""The case file of a pair that is rated."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import sound

from pitchpoint.cases.variant import Variant
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import Outcome, Progress, run_piece, run_variant

EXAMPLES = Path(__file__).parents[1] / "examples"
SPEED, TORQUE = 1500.0 * np.pi / 30.0, 50.0
HELICAL = sound.PAIR.replace("[lubricant]", 'helix_angle = "15 deg"\n[lubricant]')
PAIR = (
    HELICAL.replace("75W90-A", "pao-vg-150")
    + """
[materials]
gear_1 = "case-hardened-mq"
gear_2 = "case-hardened-mq"
[models]
friction = "frictionless"
"""
)
RATED = """
[strength]
application_factor = 1.25
face_load_factor = 1.3
accuracy_class = 6
treatment = ["case_hardened", "case_hardened"]
"""


def computed(text: str, folder: Path | None, *names: str, **settings: Any) -> Outcome:
    """What `pitchpoint run` computes and keeps, of some parts only."""
    variant = Variant(tomllib.loads(text), "pair.toml", "default", settings)
    work = [job for job in jobs(variant, {}) if job.name in names]
    return run_variant(variant, work, folder=folder, studies={}, progress=Progress())


def strength_of(case: Path | str, settings: Mapping[str, Any] | None = None) -> Any:
    """The rating of a file by itself."""
    if settings:
        tree = tomllib.loads(Path(case).read_text("utf-8"))
        variant = Variant(tree, "x.toml", "default", dict(settings))
        (job,) = [job for job in jobs(variant, {}) if job.name == "strength"]
        return job.compute(job.pieces[0])
    return run_piece(str(case), {"analysis": "strength"})
